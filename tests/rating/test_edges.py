"""Local safeties of flanks whose contacts reach edges: rounded edges are left out as sharp ones are."""

import warnings

import numpy as np
from numpy.testing import assert_allclose

from loaded_tca.analysis import analyse
from loaded_tca.errors import AccuracyWarning
from loaded_tca.rating import flank_safeties
from loaded_tca.scene import read_scene
from loaded_tca.tribology.contact_slices import contact_slices
from tests.samples.rating import RATED
from tests.samples.results import FLANKS_ALONE, SCENES

UNDER = {"analysis.torques_Nm": None, "load.pinion_torque_Nm": 300.0, "analysis.load_sharing": True}
FEW = {"analysis.positions": 9, "analysis.accuracy": None, "analysis.cells": (8, 12)}


def rated(rounding):
    """The spur pair without reliefs, so that tips dig in, with a radius of both tips [mm]."""
    flanks = {f"{gear}.modifications": None for gear in ("pinion", "wheel")}
    tips = {f"{gear}.tip_rounding_mm": rounding for gear in ("pinion", "wheel")}
    scene = read_scene(SCENES / "mesh_cycle_spur.toml")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # contacts reach edges
        return analyse(scene.with_changes(FLANKS_ALONE | RATED | UNDER | FEW | flanks | tips)).rating()


def test_rounded_tips_have_the_local_safety_of_sharp_ones():
    sharp, rounded = rated(None), rated(0.3)
    slices = contact_slices(rounded.result)
    assert np.nanmax(slices.elastic_pressure(slices.curvatures())) > 3.0 * rounded.local_flank_stress[0], "on the arcs"
    # the roundings take little of the load shares, and nothing of the flank where one pair carries the torque
    assert_allclose(rounded.local_flank_safety, sharp.local_flank_safety, rtol=0.02)
    assert_allclose(rounded.local_flank_stress[0], np.nanmax(rounded.result.peak_pressure), rtol=1e-3)  # on even slices
    assert_allclose(flank_safeties(rounded, 0).safety.min(axis=1), rounded.local_flank_safety[0], rtol=1e-9)
