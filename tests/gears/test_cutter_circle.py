"""The circle of a cutter on the crown gear: its angle and its slope against plane geometry, derivatives, reach."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.gears.bevel import CutterCircle

ROUNDING = 1e-12  # of a few functions and products
CIRCLE = CutterCircle(81.273, math.radians(35.0), 114.3)
DISTANCES = np.array([68.6, 75.0, 81.273, 88.0, 93.9])
STEP = 1e-4


def test_points_of_the_curve_lie_on_one_circle():
    """Three of them give its radius, the rest lie on it."""
    points = DISTANCES * np.exp(1j * CIRCLE.turn(DISTANCES))
    a, b, c = points[[0, 2, 4]]
    area = 0.5 * abs(((b - a) * (c - a).conjugate()).imag)
    radius = abs(b - a) * abs(c - b) * abs(a - c) / (4.0 * area)
    assert_allclose(radius, 114.3, rtol=1e-9)
    # the centre, from the ray of R_m: r cos(beta) across, R_m - r sin(beta) along
    centre = 81.273 - 114.3 * math.sin(math.radians(35.0)) + 1j * 114.3 * math.cos(math.radians(35.0))
    assert_allclose(abs(points - centre), 114.3, rtol=ROUNDING)


def test_turn_is_zero_at_the_mean_point_and_grows_with_the_spiral_angle():
    assert CIRCLE.turn(81.273) == 0.0
    slope = (CIRCLE.turn(DISTANCES + STEP) - CIRCLE.turn(DISTANCES - STEP)) / (2.0 * STEP)
    assert_allclose(slope * DISTANCES, CIRCLE.tangent(DISTANCES)[0], rtol=1e-8)
    assert_allclose(CIRCLE.sine(81.273)[0], math.sin(math.radians(35.0)), rtol=ROUNDING)


@pytest.mark.parametrize("name", ["sine", "tangent"])
def test_derivatives_agree_with_differences(name):
    function = getattr(CIRCLE, name)
    value, slope, bend = function(DISTANCES)
    before, after = function(DISTANCES - STEP), function(DISTANCES + STEP)
    assert_allclose(slope, (after[0] - before[0]) / (2.0 * STEP), rtol=1e-7)
    assert_allclose(bend, (after[1] - before[1]) / (2.0 * STEP), rtol=1e-6)
    assert np.all(np.isfinite(value))


def test_a_large_circle_is_a_straight_line():
    """R sin(beta) grows as R_m sin(beta_m) does then: the foot of the apex on the line stays."""
    line = CutterCircle(81.273, math.radians(35.0), 1e9)
    distances = np.array([70.0, 90.0])
    assert_allclose(distances * line.sine(distances)[0], 81.273 * math.sin(math.radians(35.0)), rtol=1e-6)


def test_circle_that_does_not_reach_over_the_face_is_refused():
    with pytest.raises(GeometryError, match=r"gear: cutter_radius 40 mm: its circle does not cross the cone distance"):
        CutterCircle(81.273, math.radians(35.0), 40.0).check("gear", (60.0, 110.0))
    with pytest.raises(InputError, match=r"cutter_radius: 0\.0 mm is not positive"):
        CutterCircle(81.273, 0.5, 0.0)
