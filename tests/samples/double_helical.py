"""A double helical pair of few cells whose flanks alone give way, analysed once for all tests."""

import warnings
from pathlib import Path

from loaded_tca import AccuracyWarning, analyse, read_scene
from loaded_tca.double_helical import analyse_double_helical
from tests.samples.shared import made_once

SCENE = Path(__file__).parents[2] / "examples" / "scenes" / "double_helical.toml"
FEW = {
    "analysis.compliance": "contact",
    "analysis.cells": [8, 16],
    "analysis.free_edges": False,
    "analysis.positions": 2,
    "pair.apex_offset_mm": 0.0,
    "pair.helix_angle_deg": 15.0,
}
SLOPE = {"pinion.half_b": {"modifications": {"helix_slope_um": 8.0}}}


def equal_halves():
    """Both halves alike, nothing displaced."""
    return read_scene(SCENE).with_changes({**FEW, "pinion.half_b": None})


def unlike_halves():
    """Half b with a helix slope on the pinion, and without its crowning and relief."""
    return read_scene(SCENE).with_changes({**FEW, **SLOPE})


@made_once
def analysed():
    """Result of the unlike halves, and the sentences of the warnings that the analysis gave."""
    with warnings.catch_warnings(record=True) as given:
        warnings.simplefilter("always", AccuracyWarning)
        result = analyse_double_helical(unlike_halves())
    return result, [str(one.message) for one in given]


@made_once
def half_over_a_pitch():
    """Mesh cycle of one of two equal halves at five positions under 400, 800 and 1200 N m."""
    scene = equal_halves().with_changes({"analysis.positions": 5, "analysis.cells": [8, 8]})
    with warnings.catch_warnings(action="ignore"):  # contacts reach edges
        return analyse(scene.half_scenes(0.0, 2 * [[400.0, 800.0, 1200.0]])[0])
