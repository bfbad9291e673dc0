"""Studies that are analysed in a moment, and figures that need no analysis."""

from dataclasses import replace
from functools import cache
from pathlib import Path

from loaded_tca.scene import read_scene
from loaded_tca.studies import Study

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


def unlike_variants():
    """A study whose rows are as unlike as can be: analysed without and with warnings, refused by scene and geometry."""
    scene = helical().with_changes({"analysis.load_sharing": True})
    rows = [(2.0, 34, 40.0), (6.0, 34, 40.0), (6.0, 34, 400.0), (-1.0, 34, 40.0), (6.0, 4, 40.0), (8.0, 33, 60.0)]
    keys = ("pinion.modifications.lead_crowning_um", "pinion.teeth", "load.pinion_torque_Nm")
    return Study(scene, table=dict(zip(keys, zip(*rows, strict=True), strict=True)))


def in_folder(folder, *values):
    """Variants of the crowning of a scene that tells its figures where the study is."""
    scene = replace(helical(), title=str(folder))
    return Study(scene, {"pinion.modifications.lead_crowning_um": [float(value) for value in values]})
