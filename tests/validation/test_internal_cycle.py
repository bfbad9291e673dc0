"""Finite elements beside which the mesh cycle of a pinion in a ring stands: curves, contact, their kept numbers."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.gears import CylindricalGear, RingGear
from validation.loaded.plane_pair import (
    LINE_LOADS,
    POSITIONS,
    STEPS,
    PlanePair,
    angles,
    balanced,
    flank_curve,
    read,
    reliefs,
    scene_of,
)
from validation.loaded.plane_teeth import flank_angle, half_outline

# Nodes of a coarse flank are 0.04 mm apart under a contact of 0.4 mm; tip corners are not compared.
OF_COARSE = 0.01


def test_balance_is_that_of_springs():
    """Three springs in a row, one out of reach: the others carry by their gaps."""
    force, approach = balanced(np.eye(3), np.array([0.0, 0.01, 5.0]), 1.0)
    assert_allclose(force, [0.505, 0.495, 0.0])
    assert approach == pytest.approx(0.505)


@pytest.mark.parametrize("gear", [CylindricalGear(25, 3.0, 10.0), RingGear(-60, 3.0, 10.0)])
def test_outline_has_the_thickness_of_the_gear(gear):
    radius = np.array([gear.reference_radius])
    assert_allclose(
        2.0 * flank_angle(gear, radius) * radius, gear.tooth_thickness_at(gear.reference_radius), rtol=1e-12
    )  # an involute is undone: none seen
    outline = half_outline(gear, 0.1)
    assert outline[0, 1] == 0.0
    assert outline[-1] == pytest.approx([gear.root_radius, math.pi / gear.tooth_count])


def test_flank_has_the_curvature_of_its_roll_length():
    gear = CylindricalGear(25, 3.0, 10.0)
    along, off = flank_curve(gear, 12.0, np.array([11.9, 12.0, 12.1]))
    assert_allclose(off, -(along**2) / 24.0, atol=2e-5)


@pytest.mark.thorough
def test_coarse_elements_have_nearly_the_kept_transmission_error():
    pair = PlanePair(scene_of("unmodified"), 2.0 * STEPS[0])
    for load in LINE_LOADS:
        cycle = read()["unmodified", load]
        assert len(cycle) == POSITIONS
        for n in (0, 3, 4, 5):
            place = pair.position(angles()[n], load, reliefs("unmodified"))
            assert place.transmission_error == pytest.approx(cycle[n]["transmission_error_um"], rel=OF_COARSE)
            assert sum(place.shares) == pytest.approx(1.0)
