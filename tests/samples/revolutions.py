"""A turn of the wheel of a helical pair whose flanks alone give way, on few cells, analysed once for all tests."""

import warnings
from pathlib import Path

import numpy as np

from loaded_tca import analyse_revolution, read_scene
from tests.samples.shared import made_once

SCENE = Path(__file__).parents[2] / "examples" / "scenes" / "mesh_cycle_helical.toml"
TEETH = 17, 24
FIRST = 3, 7
"""Teeth of pinion and wheel at the pitch point at the first position."""
INDEX_um = np.random.default_rng(2).normal(0.0, 3.0, 24).tolist()
"""Index deviations of the wheel's teeth."""
CHANGES = {
    "pinion.teeth": TEETH[0],
    "wheel.teeth": TEETH[1],
    "wheel.pitch.index_um": INDEX_um,
    "analysis.torques_Nm": [20.0, 60.0],
    "analysis.cells": [16, 24],
    "analysis.accuracy": None,
    "analysis.compliance": "contact",
    "analysis.free_edges": False,
    "revolution.pitches": "wheel",
    "revolution.positions_per_pitch": 4,
    "revolution.first_pair": FIRST,
}


@made_once
def small_turn():
    """Its result."""
    with warnings.catch_warnings(action="ignore"):  # of few cells
        return analyse_revolution(read_scene(SCENE).with_changes(CHANGES))
