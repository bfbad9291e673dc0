"""Analyses with root stress on coarse meshes, that tests of results, tables and pictures share."""

import math
import warnings
from contextlib import contextmanager
from dataclasses import replace
from unittest.mock import patch

from loaded_tca.analysis import analyse, roots_of
from loaded_tca.compliance.root_stress import DENSITY
from loaded_tca.errors import AccuracyWarning
from loaded_tca.scene import read_scene
from tests.samples.results import SCENES
from tests.samples.shared import made_once

COARSE = replace(DENSITY, through=4, flank=3, fillet=3, land=3, rim=4, lengthwise=6, thin_ends=True)
"""Largest stresses are 3 % off, which is of no account for what tests ask."""
FEW = {
    "analysis.root_stress": True,
    "analysis.positions": 5,
    "analysis.accuracy": None,
    "analysis.cells": (16, 24),
    "analysis.torques_Nm": (100.0, 200.0),
    "analysis.compliance": "contact",
    "analysis.free_edges": False,
}
WIDTHS = {"pinion.face_width_mm": 20.0, "wheel.face_width_mm": 18.0}
"""Of cylindrical gears."""


def scene(name="mesh_cycle_spur", **changes):
    widths = {} if name.endswith("bevel") else WIDTHS
    return read_scene(SCENES / f"{name}.toml").with_changes(FEW | widths | changes)


@contextmanager
def coarsely():
    """A context in which models of root stress are coarse, and nobody minds."""
    density = patch("loaded_tca.compliance.root_stress.stress_density", lambda _: COARSE)
    with density, patch("loaded_tca.analysis.THICKEST_LAYER", math.inf):
        yield


def analysed(scene, progress=None):
    with coarsely(), warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # contacts reach edges
        return analyse(scene, progress)


@made_once
def result(name="mesh_cycle_spur", **changes):
    return analysed(scene(name, **changes))


@made_once
def models(name="mesh_cycle_spur"):
    """Of pinion and wheel of :func:`result`."""
    with coarsely():
        return roots_of(scene(name), scene(name).pair())
