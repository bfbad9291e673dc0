"""A scene that is analysed in a moment, and figures that need no analysis."""

from functools import cache
from pathlib import Path

from loaded_tca.scene import read_scene

HELICAL = Path(__file__).parents[2] / "examples" / "scenes" / "helical.toml"
QUICK = {
    "analysis.positions": 3,
    "analysis.cells": [16, 16],
    "analysis.load_sharing": False,
    "analysis.compliance": "contact",
    "analysis.free_edges": False,
    "load.pinion_torque_Nm": 40.0,
}


@cache
def helical():
    return read_scene(HELICAL).with_changes(QUICK)


def crowning(scene):
    """One number of a scene, which costs nothing."""
    return {"crowning_um": scene.pinion.modifications.lead_crowning_um}
