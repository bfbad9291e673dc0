"""Hertz of line contacts: the force spread evenly over the loaded length."""

import warnings
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import AccuracyWarning, analyse, read_scene
from tests.samples.results import SCENES

MODULUS = 206000.0 / (2.0 * (1.0 - 0.3**2))  # both of steel


OF_WAY = 3e-5
"""A third of what the way changes: that of a pair alone is the one by its first law, a fifth too long here."""


@cache
def unmodified(helix_deg=0.0, positions=9):
    changes = {
        "analysis.positions": positions,
        "analysis.accuracy": None,
        "analysis.cells": (32, 32),
        "analysis.load_sharing": True,
        "analysis.compliance": "contact",
        "analysis.free_edges": False,
        "pair.helix_angle_deg": helix_deg,
        "pair.centre_distance_mm": None,
    }
    scene = read_scene(SCENES / "fzg_c14.toml").with_changes(changes)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # lines end at the faces
        return analyse(scene)


def test_line_of_a_spur_pair_has_the_pressure_of_its_involutes():
    """Near the pitch point: 1/rho1 + 1/rho2 of the roll lengths, force over 14 mm of face.

    Load turns the wheel back, and the middle of that way is traced: the contact lies half of it before the pitch point.
    """
    cycle = unmodified(positions=3)
    path = cycle.scene.mesh().path_of_contact
    turned = cycle.unloaded_transmission_error[1] - cycle.transmission_error[0, 1]
    place = path.C - 0.5 * turned * cycle.wheel_base_radius
    curvature = 1.0 / place + 1.0 / (path.T2 - place)
    column = cycle.pair.tolist().index(0)
    force = cycle.normal_force[0, 1, column]
    expected = np.sqrt(force / 14.0 * MODULUS * curvature / np.pi)
    assert_allclose(cycle.hertz_pressure[0, 1, column], expected, rtol=OF_WAY)
    assert_allclose(2.0 * cycle.hertz_semi_major[0, 1, column], 14.0, rtol=1e-6)
    assert_allclose(cycle.hertz_semi_minor[0, 1, column], 2.0 * expected / (MODULUS * curvature), rtol=OF_WAY)


@pytest.mark.parametrize("helix_deg", [0.0, 10.0])
def test_every_line_within_the_flanks_has_a_pressure_after_hertz(helix_deg):
    cycle = unmodified(helix_deg)
    line = np.stack([path.on_line & ~path.on_edge for path in cycle.paths], axis=-1)
    loaded = cycle.normal_force[0] > 0.0
    known = np.isfinite(cycle.hertz_pressure[0])
    assert (line & loaded).sum() > 9
    assert not (known & ~line).any()
    far = np.stack([path.pinion_radius for path in cycle.paths], axis=-1)
    tips = cycle.scene.mesh().pinion.tip_radius
    assert known[line & loaded & (far < tips - 1.0) & (far > 35.0)].all()
    middle = cycle.central_pressure[0][known]
    assert_allclose(cycle.hertz_pressure[0][known], middle, rtol=0.15)  # ends draw load from the middle


def test_line_on_a_tip_has_no_pressure_after_hertz():
    cycle = unmodified()
    on_edge = np.stack([path.on_edge for path in cycle.paths], axis=-1) & (cycle.normal_force[0] > 0.0)
    assert on_edge.any()
    assert np.isnan(cycle.hertz_pressure[0][on_edge]).all()


@pytest.mark.thorough
def test_lines_without_load_have_no_pressure_after_hertz():
    scene = read_scene(SCENES / "fzg_c14.toml").with_changes(
        {"analysis.positions": 1, "analysis.cells": (16, 16), "load.pinion_torque_Nm": 0.0}
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        assert np.isnan(analyse(scene).hertz_pressure).all()
