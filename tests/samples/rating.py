"""Solved pairs with what a rating takes, that tests of the call and of the command share."""

import warnings
from dataclasses import replace

from loaded_tca.analysis import analyse
from loaded_tca.errors import AccuracyWarning
from loaded_tca.scene import read_scene
from tests.samples.results import FLANKS_ALONE, SCENES
from tests.samples.root_stress import result
from tests.samples.shared import made_once

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


SAMPLE_1 = {"sigma_H_lim_MPa": 1500.0, "sigma_F_lim_MPa": 480.0, "flank_Rz_um": 8.0, "root_Rz_um": 16.0}
OF_SAMPLE_1 = {
    "pinion.strength": {"material": "18CrNiMo7-6"} | SAMPLE_1,
    "wheel.strength": {"material": "18CrNiMo7-6"} | SAMPLE_1,
    "operation": {"pinion_speed_rpm": 1200.0, "application_factor": 1.1},
    "lubricant": {"viscosity_40_mm2_s": 150.0, "viscosity_100_mm2_s": 15.0, "oil_temperature_C": 70.0},
    "rating": {
        "required_flank_safety": 1.0,
        "required_root_safety": 1.3,
        "life_hours": 1000.0,
        "tolerance_class": 8,
        "face_load_factor": 1.65,
    },
}
"""Operation of sample 1 of ISO/TR 10300-30."""


@made_once
def bevel_result():
    """The spiral bevel pair of that sample under 150 and 300 N m, of half-spaces on a coarse grid."""
    changes = {**FLANKS_ALONE, "analysis.positions": 5, "analysis.accuracy": None, "analysis.cells": (8, 12)}
    scene = read_scene(SCENES / "spiral_bevel_blank.toml")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # contacts reach edges
        return analyse(scene.with_changes(changes | {"analysis.torques_Nm": (150.0, 300.0)}))


def bevel_solved(**changes):
    """That result with a rating, of whose keys some are changed."""
    whole = bevel_result()
    return replace(whole, scene=whole.scene.with_changes(OF_SAMPLE_1).with_changes(changes))
