"""Small results with load sharing that the tests of tribology share, and an oil."""

import warnings
from functools import cache

from loaded_tca.analysis import analyse
from loaded_tca.errors import AccuracyWarning
from loaded_tca.scene import read_scene
from loaded_tca.tribology import Lubricant
from loaded_tca.tribology.call import tribology_of
from tests.samples.results import FLANKS_ALONE, SCENES

OIL = Lubricant(viscosity_40=220.0, viscosity_100=19.0, density_15=890.0, oil_temperature=80.0)
"""Mineral oil of the published stage that the closed forms were checked against."""
ROUGHNESS = (0.6, 0.5)
WITHOUT_MEAN = {"friction": "local", "bulk_temperature_C": 90.0}
"""What bevel gears need in the place of the means of cylindrical ones."""
FAMILIES = ("mesh_cycle_spur", "mesh_cycle_helical", "planet_ring", "mesh_cycle_bevel", "face_milled_19x62_matched")


@cache
def shared(name, positions=9, torque=None, **changes):
    """Analysis of an example scene under its largest torque [N m] or another one, flanks alone, load shared."""
    scene = read_scene(SCENES / f"{name}.toml")
    wanted = {
        **FLANKS_ALONE,
        "analysis.load_sharing": True,
        "analysis.positions": positions,
        "analysis.accuracy": 0.03,
        "analysis.torques_Nm": [1e-3 * scene.torques[-1] if torque is None else torque],
        **{key.replace("__", "."): value for key, value in changes.items()},
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        return analyse(scene.with_changes(wanted))


def known(result, **given):
    """Tribology of a result with everything that its family needs, without warnings."""
    means = {} if result.scene.path_points else WITHOUT_MEAN
    usual = {"pinion_speed_rpm": 1500.0, "lubricant": OIL, "roughness_um": ROUGHNESS, **means}
    return tribology_of(result, **{**usual, **given}, warn=False)
