"""Blades: straight and hollow edges, the rounding at the tip, the number of the blade group."""

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.gears import Blade, Cutter
from tests.refusals import refused_calls

ANGLE = math.radians(20.0)
HEIGHTS = np.linspace(0.0, 9.0, 10)

angles = st.floats(-0.4, 0.6)
radii = st.floats(50.0, 5000.0)


def test_straight_edge_recedes_with_the_tangent_of_its_angle():
    value, slope, bend = Blade(95.0, ANGLE).widening(HEIGHTS)
    assert_allclose(value, HEIGHTS * math.tan(ANGLE), atol=1e-15)  # atol: at no height
    assert_allclose(slope, math.tan(ANGLE))
    assert_allclose(bend, 0.0)


@given(angles, radii)
def test_hollow_edge_is_a_circular_arc_that_starts_with_the_blade_angle(angle, radius):
    value, slope, _ = Blade(95.0, angle, blade_radius=radius).widening(HEIGHTS)
    centre = radius * math.cos(angle), -radius * math.sin(angle)
    # the root of two squares: 2e-16 seen
    assert_allclose(np.hypot(value - centre[0], HEIGHTS - centre[1]), radius, rtol=1e-13)
    assert_allclose(slope[0], math.tan(angle))
    assert (np.diff(slope) > 0.0).all()  # the centre lies on the side of the workpiece


@given(angles, st.floats(0.0, 9.0))
def test_hollow_edge_tends_to_the_straight_one_as_its_radius_grows(angle, height):
    straight = Blade(95.0, angle).widening(height)[0]
    gaps = [Blade(95.0, angle, blade_radius=radius).widening(height)[0] - straight for radius in (1e4, 1e5)]
    assert_allclose(gaps[0], 10.0 * gaps[1], rtol=2e-3, atol=1e-9)


@given(angles, st.floats(10.0, 5000.0), st.floats(-5.0, 60.0))
def test_edge_derivatives_are_those_of_its_values(angle, radius, height):
    blade, step = Blade(95.0, angle, blade_radius=radius), 1e-4
    below, above = (blade.widening(height + shift) for shift in (-step, step))
    _, slope, bend = blade.widening(height)
    assert_allclose((above[0] - below[0]) / (2.0 * step), slope, rtol=1e-5, atol=1e-7)
    ends = sorted([float(below[2]), float(above[2])])
    assert ends[0] - 1e-9 <= bend <= ends[1] + 1e-9


@given(angles, radii, st.floats(0.1, 2.0))
def test_rounded_tip_touches_the_edge_at_the_form_height(angle, radius, edge):
    """The centre of the rounding lies an edge radius above the tip plane and as far from the edge, along its normal."""
    blade = Blade(95.0, angle, blade_radius=radius, edge_radius=edge)
    _, slope, _ = blade.widening(blade.form_height)
    # a few operations: 3e-16 seen
    assert_allclose(blade.form_height + edge * slope / math.hypot(1.0, slope), edge, rtol=1e-12)


def test_form_height_of_a_straight_blade():
    assert_allclose(Blade(95.0, ANGLE, edge_radius=0.5).form_height, 0.5 * (1.0 - math.sin(ANGLE)))
    assert Blade(95.0, ANGLE).form_height == 0.0


def test_number_of_the_blade_group_corrects_both_angles_by_ten_minutes_each():
    cutter = Cutter(Blade(44.45, ANGLE), Blade(44.45, ANGLE), number=11)
    outside, inside = (cutter.blade(flank).blade_angle for flank in ("concave", "convex"))
    assert_allclose(math.degrees(outside), 18.0 + 10.0 / 60.0)
    assert_allclose(math.degrees(inside), 21.0 + 50.0 / 60.0)


test_cutter_refuses = refused_calls(
    (
        lambda: Blade(0.0, 2.0, blade_radius=-1.0, edge_radius=-0.1),
        ("^point_radius:", "^blade_angle:", "^blade_radius:", "^edge_radius:"),
    ),
    (Cutter, "a blade is needed for at least one flank"),
    (lambda: Cutter(Blade(44.0, ANGLE), number=math.nan), "number: nan is not finite"),
    (lambda: Cutter(convex=Blade(44.0, ANGLE), number=400), "blade_angle"),
    (lambda: Cutter(Blade(44.0, ANGLE)).blade("convex"), r"cutter\.convex: missing"),
)
