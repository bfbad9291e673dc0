"""Damage under a load spectrum: a dozen torques solved and the bins between interpolated, against every bin solved.

The stage of an electric drive (``loaded/ev_stage.toml``: helical 23/71, short tip reliefs, misaligned), whose contact
reaches the ends of the face from 195 N m on, so that K_Hbeta has a kink there. 500 bins of 40 torques, 5 to 250 N m,
with falling hours and any speeds: those of 5 N m that come near resonance have K_v up to 7, and do 9 % of the damage
by local stresses. Solved pressures scatter by 0.1 to 0.4 % from torque to torque. The allowed difference of the damage
is the error that the rating tells. One bin at the knee and two bins by hand are in ``tests/rating/test_spectrum.py``.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np

from loaded_tca import analyse, read_scene
from loaded_tca.errors import noted_accuracy_warnings
from loaded_tca.scene import Scene
from validation.table import Row

SCENE = Path(__file__).parents[1] / "loaded" / "ev_stage.toml"
CASE, SOURCE = "EV stage, 500 bins", "every bin solved"
STEEL = {"material": "18CrNiMo7-6", "flank_Rz_um": 4.8, "root_Rz_um": 20.0}
RATED = {
    "pinion.strength": STEEL,
    "wheel.strength": STEEL,
    "operation": {"pinion_speed_rpm": 6000.0},
    "lubricant": {"viscosity_40_mm2_s": 32.0, "viscosity_100_mm2_s": 6.0, "oil_temperature_C": 80.0},
    # safeties with which the standard and the local rating have damage of both gears
    "rating": {
        "required_flank_safety": 1.2,
        "required_root_safety": 2.0,
        "life_hours": 5000.0,
        "tolerance_class": 6,
        "long_life_factor": 0.85,
    },
    "analysis.positions": 5,
    "analysis.cells": (16, 32),
}
SHORT = {"analysis.compliance": "contact", "analysis.cells": (8, 16)}
LOCAL = {"rating.required_flank_safety": 0.62}
"""Local pressures at a sharp edge are far above those of the standard."""
BINS, TORQUES = 500, 40


def scene() -> Scene:
    """The stage with its spectrum."""
    chance = np.random.default_rng(60)
    places = np.arange(BINS) % TORQUES
    torques, speeds = np.linspace(5.0, 250.0, TORQUES)[places], chance.uniform(1000.0, 9000.0, BINS)
    cases = [
        {"pinion_torque_Nm": torque, "hours": float(np.exp(-torque / 40.0)), "pinion_speed_rpm": speed}
        for torque, speed in zip(torques.tolist(), speeds.tolist(), strict=True)
    ]
    return read_scene(SCENE).with_changes(RATED | {"load.case": cases})


def rows() -> list[Row]:
    """Compare the damage of both gears and kinds of failure."""
    return _compared(scene())


def short_rows() -> list[Row]:
    """The same of flanks alone, without the bending of teeth, on coarse grids."""
    return _compared(scene().with_changes(SHORT))


def _compared(asked: Scene) -> list[Row]:
    every = tuple(sorted({case.pinion_torque_Nm for case in asked.load.case or ()}))
    with noted_accuracy_warnings(given=False):  # contacts reach edges
        dozen = analyse(asked)
        whole = analyse(asked.with_changes({"analysis.torques_Nm": every}))
        compared = []
        for changes, modes in (({}, ("flank",)), (LOCAL, ("local_flank",))):
            few, all_bins = (replace(one, scene=one.scene.with_changes(changes)).rating() for one in (dozen, whole))
            for mode in modes:
                for gear in ("pinion", "wheel"):
                    expected, obtained, told = (
                        float(one.dataset[name].sel(gear=gear, mode=mode))
                        for one, name in ((all_bins, "miner_sum"), (few, "miner_sum"), (few, "interpolation_error"))
                    )
                    compared.append(
                        Row(CASE, SOURCE, f"{gear}: damage, {mode}, within what is told", expected, obtained, told)
                    )
    return compared
