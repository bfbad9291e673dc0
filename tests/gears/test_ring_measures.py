"""Rings measured from inside: balls and anvils laid against their flanks, and what an allowance leaves of them."""

from dataclasses import replace
from math import cos, hypot, pi, radians, sin, sqrt, tan

import pytest
from numpy.testing import assert_allclose
from scipy.optimize import minimize_scalar

from loaded_tca.gears import CylindricalGear, InternalMesh, PinionCutter, RingGear
from loaded_tca.gears.tooth_measures import allowance_of_balls, allowance_of_span
from tests.refusals import refused_calls

ROUNDING = 1e-10  # of involutes that are inverted, and of lengths of 100 mm of which an allowance of 0.1 mm is left


def ring(teeth=60, helix=0.0, **given):
    return RingGear(-teeth, 3.0, 25.0, helix_angle=helix, **given)


@pytest.mark.parametrize(("teeth", "helix"), [(60, 0.0), (61, 0.0), (60, 0.35), (61, -0.35)])
def test_balls_touch_the_flanks_of_a_ring(teeth, helix):
    """Least distance in space of the ball's centre from the flank, a screw surface, is its radius."""
    one, size = ring(teeth, helix, profile_shift=0.1, thickness_allowance=-0.08), 5.3
    across = one.ball_measurement(size) + size
    centre = 0.5 * across / (1.0 if teeth % 2 == 0 else cos(0.5 * pi / teeth))
    lead = tan(helix) / one.reference_radius

    def distance(radius, height):
        angle = one.space_angle_at(radius) + lead * height
        return sqrt((radius * cos(angle) - centre) ** 2 + (radius * sin(angle)) ** 2 + height**2)

    def over_heights(radius):
        return minimize_scalar(lambda height: distance(radius, height), bounds=(-4.0, 4.0), method="bounded").fun

    least = minimize_scalar(over_heights, bounds=(one.tip_radius, one.form_radius), method="bounded")
    assert_allclose(least.fun, 0.5 * size, rtol=1e-7)  # of a minimum found to 1e-8 of its place


@pytest.mark.parametrize(("teeth", "shift"), [(60, 0.0), (61, 0.25), (93, 0.12)])
def test_span_of_a_ring_is_the_way_between_flanks_along_a_tangent_to_the_base_circle(teeth, shift):
    """The flank k spaces on, mirrored, meets the line where the flank does: both are its normals."""
    one = ring(teeth, profile_shift=shift, thickness_allowance=-0.05)
    half = 0.5 * one.span_measurement()
    radius = hypot(one.base_radius, half)
    angle = one.space_angle_at(radius) + pi / teeth * (one.span_teeth - 1)
    assert_allclose(radius * sin(angle), half, rtol=ROUNDING)
    assert_allclose(radius * cos(angle), one.base_radius, rtol=ROUNDING)


def test_usual_span_of_a_ring_touches_nearest_to_the_middle_of_the_flank():
    one = ring(93, profile_shift=0.12)
    middle = one.reference_radius - 0.12 * 3.0

    def off(count):
        return abs(hypot(one.base_radius, 0.5 * one.span_measurement(count)) - middle)

    assert off(one.span_teeth) < min(off(one.span_teeth - 1), off(one.span_teeth + 1))


@pytest.mark.parametrize("helix", [0.0, 0.3])
def test_measures_of_a_ring_give_back_the_allowance(helix):
    one = ring(helix=helix, profile_shift=0.2, thickness_allowance=-0.07)
    nominal = replace(one, thickness_allowance=0.0)
    balls = one.ball_measurement(5.1)
    assert balls > nominal.ball_measurement(5.1)  # spaces of thinner teeth are wider
    for gear in (nominal, one):
        assert_allclose(allowance_of_balls(gear, balls, 5.1), -0.07, atol=1e-9)
    if not helix:
        assert_allclose(allowance_of_span(nominal, one.span_measurement(), one.span_teeth), -0.07, atol=ROUNDING)


def test_measure_between_balls_tends_to_that_of_a_rack():
    """A ball between straight flanks: its centre stands off the reference line by what its space leaves."""
    angle, size = radians(20.0), 5.1
    of_rack = (0.25 * pi * 3.0 - 0.5 * size / cos(angle)) / tan(angle)
    off = [
        0.5 * (ring(teeth).ball_measurement(size) + size) - ring(teeth).reference_radius - of_rack
        for teeth in (1000, 10000)
    ]
    assert abs(off[1]) < 1e-3
    assert_allclose(off[0] / off[1], 10.0, rtol=1e-2)  # of the order 1/z


@pytest.mark.parametrize("helix", [0.0, 0.3])
def test_backlash_of_a_pair_with_a_ring_is_what_the_allowances_take(helix):
    pinion = CylindricalGear(25, 3.0, 25.0, helix_angle=helix, thickness_allowance=-0.05)
    mesh = InternalMesh(pinion, ring(helix=helix, thickness_allowance=-0.07))
    assert_allclose(mesh.working_centre_distance, 17.5 * 3.0 / cos(helix), rtol=ROUNDING)
    assert_allclose(mesh.backlash, 0.12 / cos(helix), rtol=1e-9)
    assert_allclose(mesh.normal_backlash, 0.12 * cos(radians(20.0)), rtol=1e-9)


@pytest.mark.parametrize("cutter", [None, PinionCutter(25)])
def test_ring_with_an_allowance_is_cut_as_one_with_the_generating_shift(cutter):
    """All but the tip, which keeps the diameter of the nominal ring."""
    thin = ring(profile_shift=0.2, thickness_allowance=-0.1, cutter=cutter)
    tip, root = 2.0 * thin.tip_radius, 2.0 * thin.root_radius
    shift = thin.generating_profile_shift
    other = ring(profile_shift=shift, tip_diameter=tip, root_diameter=root, cutter=cutter)
    assert_allclose(thin.root_fillet(5), other.root_fillet(5), rtol=ROUNDING)
    assert_allclose(thin.form_radius, other.form_radius, rtol=ROUNDING)
    assert ring(profile_shift=0.2, thickness_allowance=0.0).generating_profile_shift == 0.2


def test_allowance_moves_the_root_of_a_ring_as_the_rack_or_its_cutter_does():
    """The cutter keeps its tip circle: its axis moves with the sum of the shifts, by less than the rack's line."""
    nominal, thin = ring(profile_shift=0.2), ring(profile_shift=0.2, thickness_allowance=-0.1)
    assert_allclose(thin.root_radius - nominal.root_radius, 0.05 / tan(radians(20.0)), rtol=1e-9)
    cut = [replace(gear, cutter=PinionCutter(25)) for gear in (nominal, thin)]
    pair = [
        InternalMesh(CylindricalGear(25, 3.0, 25.0), replace(nominal, profile_shift=shift, cutter=None))
        for shift in (0.2, thin.generating_profile_shift)
    ]
    moved = pair[1].working_centre_distance - pair[0].working_centre_distance
    assert_allclose(cut[1].root_radius - cut[0].root_radius, moved, rtol=1e-9)


test_measures_of_rings_refuse = refused_calls(
    (lambda: ring(thickness_allowance=-1.6), "^ring: thickness_allowance: -1.6 mm is not within 1.5 mm"),
    (
        lambda: ring(helix=0.3).span_measurement(7),
        "^ring: span_measurement: no span touches the helical teeth",
    ),
    (lambda: ring().span_measurement(60), "^ring: span_teeth: 60 is not a whole number from 1 to 59"),
    (lambda: ring().span_measurement(12), "^ring: span_teeth: a span over 12 teeth touches no flank"),
    (lambda: ring().ball_measurement(9.0), "^ring: ball_diameter: a ball of 9 mm does not go between the flanks"),
    (lambda: ring().ball_measurement(6.9), "^ring: ball_diameter: a ball of 6.9 mm touches no flank"),
    (lambda: ring().ball_measurement(3.0), "^ring: ball_diameter: a ball of 3 mm"),
    (
        lambda: allowance_of_balls(ring(), 190.0, 5.1),
        "^ring: ball_measurement: 190 mm between balls of 5.1 mm makes the teeth .* thinner than nominal",
    ),
)
