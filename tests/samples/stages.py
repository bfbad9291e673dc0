"""A planetary stage on few cells, analysed once for all tests."""

import warnings
from pathlib import Path

from loaded_tca.errors import AccuracyWarning
from loaded_tca.stages import analyse_stage, read_stage
from tests.samples.shared import made_once

STAGE = Path(__file__).parents[2] / "examples" / "stages" / "helical_automotive.toml"
FEW = {
    "analysis.compliance": "contact",
    "analysis.free_edges": False,
    "analysis.cells": [8, 10],
    "analysis.positions": 5,
    "analysis.torques_Nm": [300.0],
}


def stage_of_few_cells():
    return read_stage(STAGE).with_changes(FEW)


@made_once
def analysed():
    """Its result, and the sentences of the warnings that the analysis gave."""
    with warnings.catch_warnings(record=True) as given:
        warnings.simplefilter("always", AccuracyWarning)
        result = analyse_stage(stage_of_few_cells())
    return result, [str(one.message) for one in given]
