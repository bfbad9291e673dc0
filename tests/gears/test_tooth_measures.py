"""Tooth thickness by allowance, span and balls: planes and balls laid against the flanks, and what the rack leaves."""

from dataclasses import replace
from itertools import product
from math import atan2, cos, hypot, pi, radians, sin, sqrt, tan

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.optimize import minimize_scalar

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.gears import CylindricalGear, CylindricalMesh, RingGear
from loaded_tca.gears.tooth_measures import allowance_of_balls, allowance_of_pins, allowance_of_span
from tests.refusals import refused_calls

ROUNDING = 1e-10  # of involutes that are inverted, and of lengths of 100 mm of which an allowance of 0.1 mm is left


def gear(teeth=25, helix=0.0, **given):
    return CylindricalGear(teeth, 2.0, 40.0, helix_angle=helix, **given)


def thickness(one):
    """Where the flanks of a tooth cross the reference cylinder: normal thickness, without the rack's formula."""
    return one.tooth_thickness_at(one.reference_radius) * cos(one.helix_angle)


@pytest.mark.parametrize("helix", [0.0, 0.3, -0.3])
@pytest.mark.parametrize("shift", [0.0, 0.4])
def test_teeth_are_thinner_by_the_allowance_and_their_roots_deeper(helix, shift):
    nominal = gear(helix=helix, profile_shift=shift)
    thin = replace(nominal, thickness_allowance=-0.08)
    assert_allclose(thickness(nominal) - thickness(thin), 0.08, rtol=ROUNDING)
    assert_allclose(nominal.root_radius - thin.root_radius, 0.04 / tan(radians(20.0)), rtol=ROUNDING)
    assert thin.tip_radius == nominal.tip_radius
    assert thin.form_radius < nominal.form_radius


def test_gear_with_an_allowance_is_cut_as_one_with_the_generating_shift():
    """All but the tip, which keeps the diameter of the nominal gear."""
    thin = gear(profile_shift=0.2, thickness_allowance=-0.1)
    other = gear(profile_shift=thin.generating_profile_shift, tip_diameter=2.0 * thin.tip_radius)
    assert_allclose(thin.root_fillet(9), other.root_fillet(9), rtol=ROUNDING)
    assert_allclose(thin.root_fillet_tangent(9), other.root_fillet_tangent(9), rtol=ROUNDING, atol=ROUNDING)
    assert_allclose(thin.tooth_thickness_at(26.0), other.tooth_thickness_at(26.0), rtol=ROUNDING)
    assert_allclose(thin.form_radius, other.form_radius, rtol=ROUNDING)


def test_no_allowance_changes_no_digit():
    with_zero = gear(profile_shift=0.3, thickness_allowance=0.0, tip_alteration_coefficient=0.0)
    assert with_zero == gear(profile_shift=0.3)
    assert with_zero.generating_profile_shift == 0.3


@pytest.mark.parametrize("teeth", [20, 21, 40])
@pytest.mark.parametrize("shift", [-0.1, 0.0, 0.35])
def test_span_of_spur_teeth_is_the_distance_of_planes_that_touch_them(teeth, shift):
    """The widest extent of k teeth across the middle of them, over the flanks as points."""
    one = gear(teeth, profile_shift=shift, thickness_allowance=-0.05)
    count = one.span_teeth
    radius = np.linspace(one.form_radius, one.tip_radius, 200001)
    half = 0.5 * np.array([one.tooth_thickness_at(each) for each in radius[::1000]]) / radius[::1000]
    angle = np.interp(radius, radius[::1000], half) + pi / teeth * (count - 1)
    assert_allclose(one.span_measurement(), 2.0 * (radius * np.sin(angle)).max(), rtol=1e-6)  # chords of the table


@pytest.mark.parametrize("teeth", [20, 21])
def test_balls_touch_the_flanks_of_spur_teeth(teeth):
    """Least distance of the flank from the centre of a ball, found point by point, is its radius."""
    one, size = gear(teeth, profile_shift=0.1, thickness_allowance=-0.06), 3.6
    across = one.ball_measurement(size) - size
    centre = 0.5 * across / (1.0 if teeth % 2 == 0 else cos(0.5 * pi / teeth))

    def distance(radius):
        space = pi / teeth - 0.5 * one.tooth_thickness_at(radius) / radius
        return hypot(radius * cos(space) - centre, radius * sin(space))

    least = minimize_scalar(distance, bounds=(one.form_radius, one.tip_radius), method="bounded")
    assert_allclose(least.fun, 0.5 * size, rtol=1e-7)


def test_balls_of_helical_teeth_touch_the_screw_of_their_flanks():
    """Least distance in space of the ball's centre from the flank, a screw surface with the lead of the helix."""
    one, size = gear(24, radians(20.0), thickness_allowance=-0.06), 3.6
    centre = 0.5 * (one.ball_measurement(size) - size)
    lead = tan(one.helix_angle) / one.reference_radius

    def distance(radius, height):
        angle = pi / 24 - 0.5 * one.tooth_thickness_at(radius) / radius + lead * height
        return sqrt((radius * cos(angle) - centre) ** 2 + (radius * sin(angle)) ** 2 + height**2)

    def over_heights(radius):
        return minimize_scalar(lambda height: distance(radius, height), bounds=(-4.0, 4.0), method="bounded").fun

    least = minimize_scalar(over_heights, bounds=(one.form_radius, one.tip_radius), method="bounded")
    assert_allclose(least.fun, 0.5 * size, rtol=1e-7)


@pytest.mark.parametrize("teeth", [24, 25])
def test_pins_of_helical_teeth_touch_the_screw_of_their_flanks(teeth):
    """Least distance of the flank, a screw surface, from the axis of a pin along the helix at its middle."""
    one, size = gear(teeth, radians(20.0), thickness_allowance=-0.06), 3.6
    centre = 0.5 * (one.pin_measurement(size) - size)
    lead = tan(one.helix_angle) / one.reference_radius
    slope = centre * lead  # tangent of the helix angle there
    along = np.array([0.0, slope, 1.0]) / hypot(slope, 1.0)

    def distance(radius, height):
        angle = pi / teeth - 0.5 * one.tooth_thickness_at(radius) / radius + lead * height
        to_point = np.array([radius * cos(angle) - centre, radius * sin(angle), height])
        return float(np.linalg.norm(np.cross(to_point, along)))

    def over_heights(radius):
        return minimize_scalar(lambda height: distance(radius, height), bounds=(-4.0, 4.0), method="bounded").fun

    least = minimize_scalar(over_heights, bounds=(one.form_radius, one.tip_radius), method="bounded")
    assert_allclose(least.fun, 0.5 * size, rtol=1e-7)


@pytest.mark.parametrize(("teeth", "helix"), [(24, 0.0), (25, 0.0), (24, 0.35), (25, 0.35)])
def test_measure_over_pins_is_the_widest_of_parallel_planes_about_them(teeth, helix):
    """Pins lie anywhere along the helices of two spaces, the heights of which are tried one by one."""
    one, size = gear(teeth, helix), 3.6
    balls_apart = one.ball_measurement(size) - size
    centre = 0.5 * balls_apart / (1.0 if teeth % 2 == 0 else cos(0.5 * pi / teeth))
    heights = np.linspace(-0.5 * one.face_width, 0.5 * one.face_width, 2001)
    turns = np.tan(helix) / one.reference_radius * heights
    widest = 0.0
    for space, upper in product((teeth // 2, teeth - teeth // 2), (turns[0], 0.0, turns[-1])):
        opposite = 2.0 * pi * space / teeth + turns - upper
        widest = max(widest, float((2.0 * centre * np.abs(np.sin(0.5 * opposite))).max()))
    assert_allclose(one.pin_measurement(size), widest + size, rtol=1e-6)  # the steps of the heights


def test_pins_over_47_helical_teeth_measure_more_than_balls():
    """DIN 3960: M_dK = d_K cos(90 deg/z) + D_M, M_dR = d_K + D_M; so 8.6637 and 8.6684 in at 6 NDP, x_E 0.0879."""
    inch = 25.4
    one = CylindricalGear(
        47, inch / 6.0, 1.65 * inch, helix_angle=radians(18.0), profile_shift=0.0879, tip_diameter=8.603 * inch
    )
    digits = 0.00005 * inch
    assert_allclose(one.ball_measurement(0.288 * inch), 8.6637 * inch, atol=digits)
    assert_allclose(one.pin_measurement(0.288 * inch), 8.6684 * inch, atol=digits)


@given(st.integers(12, 120), st.floats(-0.5, 0.5), st.floats(0.0, 0.6), st.floats(-0.2, 0.02), st.floats(1.65, 1.9))
def test_span_and_balls_give_back_the_allowance(teeth, helix, shift, allowance, size):
    try:
        one = CylindricalGear(teeth, 2.0, 400.0, helix_angle=helix, profile_shift=shift, thickness_allowance=allowance)
        span, balls = one.span_measurement(), one.ball_measurement(2.0 * size)
    except (InputError, GeometryError):
        assume(False)
    nominal = replace(one, thickness_allowance=0.0)
    assert_allclose(allowance_of_span(nominal, span, one.span_teeth), allowance, rtol=0, atol=ROUNDING)
    assert_allclose(allowance_of_balls(nominal, balls, 2.0 * size), allowance, atol=1e-9)
    assert_allclose(allowance_of_balls(one, balls, 2.0 * size), allowance, atol=1e-9)
    if helix == 0.0 or teeth % 2 == 0 or abs(sin(helix)) > 0.01:  # opposite pins are on this face
        pins = one.pin_measurement(2.0 * size)
        assert pins >= balls
        assert_allclose(allowance_of_pins(one, pins, 2.0 * size), allowance, atol=1e-9)


@pytest.mark.parametrize(("teeth", "helix", "shift"), [(12, 0.0, 0.3), (17, 0.2, 0.0), (60, 0.35, 0.5), (200, 0.0, 0)])
def test_usual_span_touches_nearest_to_the_middle_of_the_flank(teeth, helix, shift):
    one = CylindricalGear(teeth, 2.0, 400.0, helix_angle=helix, profile_shift=shift)
    middle = one.reference_radius + 2.0 * shift

    def off(count):
        return abs(hypot(one.base_radius, 0.5 * one.span_measurement(count) * cos(one.base_helix_angle)) - middle)

    usual = off(one.span_teeth)
    for count in (one.span_teeth - 1, one.span_teeth + 1):
        try:
            assert off(count) >= usual
        except InputError:
            continue


def test_a_tooth_more_adds_a_normal_base_pitch_to_the_span():
    one = gear(40, 0.25)
    pitch = 2.0 * pi * cos(radians(20.0))
    assert_allclose(one.span_measurement(6) - one.span_measurement(5), pitch, rtol=ROUNDING)


@pytest.mark.parametrize("helix", [0.0, 0.3])
def test_backlash_is_what_the_allowances_take(helix):
    """At the reference circles of pairs without profile shift: both normal allowances, in the transverse section."""
    first = gear(21, helix, thickness_allowance=-0.05)
    second = gear(34, -helix, thickness_allowance=-0.07)
    mesh = CylindricalMesh(first, second)
    assert_allclose(mesh.working_centre_distance, first.reference_radius + second.reference_radius, rtol=ROUNDING)
    assert_allclose(mesh.backlash, 0.12 / cos(helix), rtol=1e-9)
    assert_allclose(mesh.normal_backlash, 0.12 * cos(radians(20.0)), rtol=1e-9)


def test_tip_alteration_moves_the_tip_alone():
    usual, short = gear(profile_shift=0.2), gear(profile_shift=0.2, tip_alteration_coefficient=-0.1)
    assert_allclose(usual.tip_radius - short.tip_radius, 0.2, rtol=ROUNDING)
    assert_allclose(short.tip_alteration, -0.2, rtol=ROUNDING)
    assert short.root_radius == usual.root_radius


def test_undercut_counts_with_the_generating_shift():
    safe = gear(17, profile_shift=0.03)
    assert not safe.is_undercut
    thin = replace(safe, thickness_allowance=-0.2)
    assert thin.is_undercut
    enough = replace(thin, profile_shift=thin.smallest_profile_shift + 1e-9)
    assert not enough.is_undercut
    assert atan2(enough.rack_form_roll_length, 1.0) >= 0.0


SHALLOW = gear(dedendum_coefficient=1.0, root_radius_coefficient=0.0, profile_shift=0.3)
"""Spaces so shallow that a ball can lie on their ground."""

test_tooth_measures_refuse = refused_calls(
    (lambda value: gear(thickness_allowance=value), "^gear: thickness_allowance: .* not within 1 mm", [-1.1, 1.1]),
    (lambda value: gear(thickness_allowance=value), "^gear: thickness_allowance: .* finite", [float("nan")]),
    (
        lambda: gear(tip_alteration_coefficient=-0.1, tip_diameter=53.0),
        "^gear: tip_alteration_coefficient: -0.1 beside a tip_diameter of 53.0 mm; give one of them",
    ),
    (lambda count: gear().span_measurement(count), "^gear: span_teeth: .* whole number from 1 to 24", [0, 25, 2.5]),
    (lambda count: gear().span_measurement(count), "span over . teeth touches no flank: .* reach from", [1, 6]),
    (
        lambda: CylindricalGear(40, 2.0, 8.0, helix_angle=0.4).span_measurement(),
        "^gear: span_teeth: a span over 6 teeth needs a face width above 12.4",
    ),
    (lambda: gear().ball_measurement(0.0), "^gear: ball_diameter: 0.0 mm is not positive"),
    (lambda size: gear().ball_measurement(size), "a ball of .* falls between the flanks", [0.5, 2.0]),
    (lambda: gear().ball_measurement(2.4), "a ball of 2.4 mm does not stand out of the tips"),
    (lambda size: gear().ball_measurement(size), "a ball of .* touches no flank: .* 47.2946 to 54 mm", [7.0, 20.0]),
    (lambda: SHALLOW.ball_measurement(2.4), ("rests on the root", "does not stand out")),
    (
        lambda: allowance_of_span(gear(), 15.46, 4),
        "span_measurement: 15.46 mm over 4 teeth makes the teeth 6.28.* thinner",
    ),
    (lambda: allowance_of_balls(gear(), 70.0, 3.5), r"^gear: ball_measurement: 70 mm .* mm thicker"),
    (lambda: allowance_of_balls(gear(), 49.0, 3.5), "puts the balls inside the base circle, diameter 46.98"),
    (lambda: allowance_of_balls(gear(), 49.0, -1.0), "^gear: ball_diameter: -1.0 mm"),
    (lambda: gear().pin_measurement(20.0), "^gear: pin_diameter: a pin of 20 mm touches no flank"),
    (lambda: gear().pin_measurement(0.5), "^gear: pin_diameter: a pin of 0.5 mm falls between the flanks"),
    (lambda: allowance_of_pins(gear(), 70.0, 3.5), "^gear: pin_measurement: 70 mm over pins of 3.5 mm makes the teeth"),
    (lambda: allowance_of_pins(gear(), 49.0, 3.5), "^gear: pin_measurement: .* puts the pins inside the base circle"),
    (
        lambda: gear(helix=0.05).pin_measurement(3.6),
        "^gear: pin_measurement: .* half an axial pitch apart along the face, 62.86 mm, and the face width is 40 mm",
    ),
    (
        lambda: RingGear(-60, 3.0, 20.0, helix_angle=0.2).pin_measurement(5.0),
        "pin_measurement: pins between the helical teeth of a ring, which are hollow, touch at their ends",
    ),
)
