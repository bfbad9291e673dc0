"""Damage of a planetary stage under a load spectrum, against a sum made by hand of its single meshes.

The second stage of the NREL 5 MW gearbox as in ``rating.stages`` (three planets, through-hardened ring), with pins that
are displaced by 0.02, 0 and 0 mm, so that K_gamma falls with the torque. Four torques of the sun from a quarter of
that of the report to the whole are solved, in shares of a life of 20 years.

By hand: each mesh is rated as a pair under its even share of each torque alone, with K_A K_gamma in the place of K_A,
at the speed against the carrier; its lives, the Palmgren-Miner sum of their shares, times three for the teeth of sun
and ring, which meet three planets in a turn; of planets the worse one of both meshes. R of planets is -1.2, annex B of
ISO 6336-3:2006, since both meshes have one width. Sums differ by torques that went through N m, whose rounding the
exponents of S-N curves multiply: 1e-6.

Then 500 bins between these torques: a dozen torques are solved, and the sum by them against that of all 31 torques of
the bins. The allowed difference is the error that the rating tells.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import noted_accuracy_warnings
from loaded_tca.stages import Stage, StageResult, analyse_stage, parse_stage
from validation.rating.stages import SCENE, STAGES, STRENGTH
from validation.table import Row

CASE = "NREL 5 MW, stage 2, spectrum"
SHARES = {40e3: 0.5, 80e3: 0.3, 120e3: 0.15, 162e3: 0.05}
"""Torque of the sun [N m] -> part of the life."""
CHANGES: Mapping[str, Any] = {
    "stage.pin_tangential_um": [20.0, 0.0, 0.0],
    "rating.mesh_load_factor": "analysis",
    "rating.required_flank_safety": 1.4,
    "rating.required_root_safety": 2.6,
    "load.sun_torque_Nm": None,
}
ROUNDING = 1e-6
BINS, TORQUES = 500, 31


def rows() -> list[Row]:
    """Compare the sums of all gears."""
    with noted_accuracy_warnings(given=False):  # contacts reach edges, on which no row depends
        return [*_by_hand(_stage(SHARES)), *_many_bins()]


def short_rows() -> list[Row]:
    """Those by hand alone."""
    with noted_accuracy_warnings(given=False):
        return _by_hand(_stage(SHARES))


def _stage(shares: Mapping[float, float]) -> Stage:
    cases = [{"sun_torque_Nm": torque, "share": share} for torque, share in shares.items()]
    base = parse_stage(SCENE.format(strength=STRENGTH, **STAGES["NREL 5 MW, stage 2"]))
    return base.with_changes({**CHANGES, "load.case": cases})


def _by_hand(stage: Stage) -> list[Row]:
    """Miner sums of the stage against those of its meshes as pairs."""
    result = analyse_stage(stage)
    sums = result.rating().dataset["miner_sum"]
    planets, (sun, planet, ring) = len(stage.stage.angles), stage.teeth
    assert stage.operation is not None
    relative = stage.operation.sun_speed_rpm * ring / (sun + ring)
    at_sun = _of_mesh(result, "sun_mesh", relative, 1.0)
    at_ring = _of_mesh(result, "ring_mesh", relative * sun / planet, planet / sun)
    expected = {"sun": planets * at_sun[0], "planet": np.maximum(at_sun[1], at_ring[0]), "ring": planets * at_ring[1]}
    return [
        Row(
            CASE,
            "sum by hand",
            f"{gear}: damage, {mode}",
            float(values[n]),
            float(sums.sel(gear=gear, mode=mode)),
            ROUNDING,
        )
        for gear, values in expected.items()
        for n, mode in enumerate(("flank", "root"))
        if values[n] > 0.0
    ]


def _of_mesh(result: StageResult, name: str, speed: float, radii: float) -> Array:
    """Damage (gear, mode) of both gears of a mesh that carries its even shares as a pair."""
    stage, cycle = result.stage, getattr(result, name)
    gears = ("sun", "planet") if name == "sun_mesh" else ("planet", "ring")
    strengths = [
        replace(getattr(stage, gear).strength, root_stress_ratio=-1.2 if gear == "planet" else 0.0) for gear in gears
    ]
    assert stage.operation is not None
    assert stage.rating is not None
    total = np.zeros((2, 2))
    for (torque, share), factor in zip(SHARES.items(), result.mesh_load_factor.tolist(), strict=True):
        even = torque * radii / len(stage.stage.angles)
        place = int(np.abs(cycle.torque - 1e3 * even).argmin())
        wanted = {key: getattr(stage.rating, key) for key in ("required_flank_safety", "required_root_safety")}
        changes = {
            "pinion.strength": strengths[0],
            "wheel.strength": strengths[1],
            "operation": {
                "pinion_speed_rpm": speed,
                "application_factor": stage.operation.application_factor * factor,
            },
            "lubricant": stage.lubricant,
            "rating": {
                **wanted,
                "life_hours": stage.rating.life_hours,
                "dynamic_factor": "given",
                "transverse_load_factor": 1.0,
            },
        }
        rating = replace(cycle, scene=cycle.scene.with_changes(changes)).rating()
        total += share * stage.rating.life_hours / rating.dataset["life_hours"].values[place][:, :2]
    return total


def _many_bins() -> list[Row]:
    """A dozen torques solved against all of them."""
    torques = np.linspace(min(SHARES), max(SHARES), TORQUES)[np.arange(BINS) % TORQUES]
    hours = np.exp(-torques / 40e3)
    cases = [
        {"sun_torque_Nm": torque, "hours": time} for torque, time in zip(torques.tolist(), hours.tolist(), strict=True)
    ]
    stage = _stage(SHARES).with_changes({"load.case": cases})
    dozen = analyse_stage(stage).rating()
    every = tuple(sorted(set(torques.tolist())))
    whole = analyse_stage(stage.with_changes({"analysis.torques_Nm": every})).rating()
    compared = []
    for place, gear in enumerate(dozen.MEMBERS):
        for n, mode in enumerate(dozen.modes[:2]):
            expected, obtained = float(whole.miner_sum[place, n]), float(dozen.miner_sum[place, n])
            told = float(dozen.interpolation_error[place, n])
            if expected > 0.0:
                label = f"{gear}: damage of {BINS} bins, {mode}, within what is told"
                compared.append(Row(CASE, "every bin solved", label, expected, obtained, told))
    return compared
