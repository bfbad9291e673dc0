"""The standard prints formulas and no tables: the numbers compared with were worked out by hand from eqs. 5 to 12."""

from dataclasses import astuple, fields
from itertools import pairwise
from math import cos, inf, nan, radians

import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.reference.iso1328 import FlankTolerances, flank_tolerances
from tests.refusals import refused_calls

ROUNDING = 1e-12  # a dozen floating point operations

# z, m_n, b, class, beta: f_pT, F_pT, f_HaT, f_faT, F_aT, f_HbT, f_fbT, F_bT
BY_HAND = [
    # d 120: class 5 has 6.32, 20.365, 5.32, 6.65, 8.516, 6.4647, 7.2315, 9.7; times 1.41421
    ((40, 3.0, 30.0, 6, 0.0), (9.0, 29.0, 7.5, 9.5, 12.0, 9.0, 10.0, 14.0)),
    # d 100, square roots without remainder: 5.9, 19.1, 4.9, 6.1, 7.8243, 6.25, 6.95, 9.347
    ((50, 2.0, 25.0, 5, 0.0), (6.0, 19.0, 4.9, 6.0, 8.0, 6.5, 7.0, 9.5)),
    # the same two classes on: twice as much, before it is rounded
    ((50, 2.0, 25.0, 7, 0.0), (12.0, 38.0, 10.0, 12.0, 16.0, 13.0, 14.0, 19.0)),
    # the same at the finest class: a quarter
    ((50, 2.0, 25.0, 1, 0.0), (1.5, 4.8, 1.2, 1.5, 2.0, 1.6, 1.7, 2.3)),
    # a large gear, d 900: 9.9, 37.3, 8.9, 10.5, 13.765, 9.0, 10.6, 13.906; times 2.82843
    ((90, 10.0, 100.0, 8, 0.0), (28.0, 106.0, 25.0, 30.0, 39.0, 25.0, 30.0, 39.0)),
    # cos(beta) 0.8: d 250, roots 15.8114 and 8
    ((50, 4.0, 64.0, 5, 0.6435011087932844), (7.0, 24.0, 6.0, 7.0, 9.5, 7.5, 8.5, 12.0)),
]


@pytest.mark.parametrize(("gear", "expected"), BY_HAND)
def test_tolerances_are_those_worked_out_by_hand(gear, expected):
    assert astuple(flank_tolerances(*gear)) == expected


def test_each_class_is_sqrt_2_times_the_finer_one_before_rounding():
    values = [astuple(flank_tolerances(31, 4.0, 40.0, cls, 0.2, rounded=False)) for cls in range(1, 12)]
    for fine, coarse in pairwise(values):
        assert_allclose(coarse, [2.0**0.5 * value for value in fine], rtol=ROUNDING)


def test_totals_have_the_squares_of_slope_and_form_before_rounding():
    gear = flank_tolerances(23, 2.5, 18.0, 9, rounded=False)
    assert_allclose(gear.total_profile**2, gear.profile_slope**2 + gear.profile_form**2, rtol=ROUNDING)
    assert_allclose(gear.total_helix**2, gear.helix_slope**2 + gear.helix_form**2, rtol=ROUNDING)


def test_hand_of_the_helix_does_not_matter():
    assert flank_tolerances(20, 2.0, 20.0, 6, 0.3) == flank_tolerances(20, 2.0, 20.0, 6, -0.3)


@given(st.integers(5, 200), st.floats(1.0, 20.0), st.floats(4.0, 1200.0), st.integers(1, 11), st.floats(-0.78, 0.78))
def test_rounding_is_at_most_half_of_its_step(teeth, module, width, cls, helix):
    exact, drawn = (astuple(flank_tolerances(teeth, module, width, cls, helix, each)) for each in (False, True))
    for value, shown in zip(exact, drawn, strict=True):
        step = 1.0 if value > 10.0 else 0.5 if value >= 5.0 else 0.1
        assert abs(value - shown) <= 0.5 * step * (1.0 + ROUNDING) + 1e-12
        assert_allclose(shown / step, round(shown / step), rtol=ROUNDING)


@given(st.integers(5, 200), st.floats(1.0, 20.0), st.floats(5.0, 600.0), st.integers(1, 11))
def test_larger_gears_have_no_smaller_tolerances(teeth, module, width, cls):
    small, large = (
        flank_tolerances(z, m, b, cls) for z, m, b in ((teeth, module, width), (teeth + 9, 1.2 * module, 2.0 * width))
    )
    assert all(getattr(small, each.name) <= getattr(large, each.name) for each in fields(FlankTolerances))


def test_ranges_of_the_standard_include_their_ends():
    flank_tolerances(5, 1.0, 4.0, 1)
    flank_tolerances(214, 70.0, 1200.0, 11)
    flank_tolerances(20, 2.0, 20.0, 6, radians(45.0))


test_iso1328_refuses = refused_calls(
    (lambda cls: flank_tolerances(40, 3.0, 30.0, cls), "^tolerance_class: .* is not one of 1 to 11", [0, 12, 5.5, nan]),
    (lambda teeth: flank_tolerances(teeth, 3.0, 30.0, 6), "^teeth: .* 5 to 1000", [4, 1001]),
    (lambda module: flank_tolerances(40, module, 30.0, 6), "^normal_module: .* 0.5 to 70 mm", [0.49, 71.0]),
    (lambda module: flank_tolerances(40, module, 30.0, 6), "^normal_module: .* positive", [0.0, -1.0, nan, inf]),
    (lambda width: flank_tolerances(40, 3.0, width, 6), "^face_width: .* 4 to 1200 mm", [3.9, 1201.0, nan]),
    (lambda: flank_tolerances(5, 0.5, 4.0, 6), "^reference diameter: 2.5 mm, .* 5 to 15000 mm"),
    (lambda: flank_tolerances(300, 60.0, 400.0, 6), "^reference diameter: 18000 mm"),
    (lambda: flank_tolerances(40, 3.0, 30.0, 6, radians(46.0)), "^helix_angle: 46 deg, .* up to 45 deg"),
    (lambda angle: flank_tolerances(40, 3.0, 30.0, 6, angle), "^helix_angle: .* -90 and 90 deg", [1.6, nan]),
    (lambda: flank_tolerances(4, 3.0, 3.0, 6), ("^teeth:", "^face_width:")),
)


def test_reference_diameter_is_that_of_helical_teeth():
    """0.001 d is all that the helix moves of f_pT."""
    spur, helical = (flank_tolerances(100, 8.0, 80.0, 5, angle, rounded=False) for angle in (0.0, radians(30.0)))
    assert_allclose(helical.single_pitch - spur.single_pitch, 0.8 * (1.0 / cos(radians(30.0)) - 1.0), rtol=1e-9)
