"""A solved pair with what a rating takes, that tests of the call and of the command share."""

from dataclasses import replace

from tests.samples.root_stress import result

HARD = {"material": "18CrNiMo7-6", "flank_Rz_um": 4.8, "root_Rz_um": 20.0}
RATED = {
    "pinion.strength": HARD,
    "wheel.strength": HARD,
    "operation": {"pinion_speed_rpm": 1500.0},
    "lubricant": {"viscosity_40_mm2_s": 220.0, "viscosity_100_mm2_s": 19.0, "oil_temperature_C": 70.0},
    "rating": {
        "required_flank_safety": 1.0,
        "required_root_safety": 1.4,
        "life_hours": 20000.0,
        "dynamic_factor": "given",
        "transverse_load_factor": 1.0,
    },
}


def solved(**changes):
    """The spur pair under 100 and 200 N m with a rating, of whose keys some are changed."""
    whole = result()
    return replace(whole, scene=whole.scene.with_changes(RATED).with_changes(changes))
