"""The spherical involute against the arc that unwinds from its base cone, and against differences."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.flanks import InvoluteFlank, SphericalInvoluteFlank
from loaded_tca.flanks.base import EDGE_NAMES, outward_normal
from loaded_tca.flanks.bevel import spherical_involute, unwound_arc
from loaded_tca.gears.bevel import CutterCircle
from tests.refusals import refused_calls

PITCH, PRESSURE, DISTANCES = math.radians(50.0), math.radians(20.0), (60.0, 80.0)
BASE = math.asin(math.sin(PITCH) * math.cos(PRESSURE))
CONES = (math.radians(47.0), math.radians(53.0))
ROUNDING = 1e-13  # of unit vectors: 2e-16 seen
OF_ANGLES = 1e-12  # rad; a dozen functions of angles of order one: 4e-16 seen, 7e-15 in coordinates of 50 mm
STEP = 1e-4  # mm
DIFFERENCE = 1e-8  # step^2 times a third derivative (Q^-3), and rounding over the step

sides = st.sampled_from([1, -1])
spirals = st.floats(-0.7, 0.7)
angles = st.floats(CONES[0], CONES[1])
distances = st.floats(*DISTANCES)


def flank(side=1, spiral=0.0, cones=CONES):
    return SphericalInvoluteFlank(PITCH, PRESSURE, spiral, side, cones, DISTANCES)


def place(angle, distance):
    return np.array(distance * math.sin(angle)), np.array(distance * math.cos(angle))


def differences(function, rho, z):
    """Gradient and Hessian of a function that returns jets, from its values and slopes beside the point."""
    ahead, behind = function(rho + STEP, z), function(rho - STEP, z)
    above, below = function(rho, z + STEP), function(rho, z - STEP)
    first = [(a.value - b.value) / (2.0 * STEP) for a, b in ((ahead, behind), (above, below))]
    second = [(a - b) / (2.0 * STEP) for a, b in ((ahead.rho, behind.rho), (above.rho, below.rho), (above.z, below.z))]
    return [float(value) for value in (*first, *second)]


@given(angles, distances, sides, spirals)
def test_derivatives_of_theta_agree_with_differences(angle, distance, side, spiral):
    jet = flank(side, spiral).theta(*place(angle, distance))
    found = [jet.rho, jet.z, jet.rho_rho, jet.rho_z, jet.z_z]
    assert_allclose(found, differences(flank(side, spiral).theta, *place(angle, distance)), rtol=0, atol=DIFFERENCE)


@given(angles, distances, spirals)
def test_derivatives_of_coordinates_edges_and_gradient_norm_agree_with_differences(angle, distance, spiral):
    one, where = flank(1, spiral), place(angle, distance)
    functions = [one.profile_coordinate, one.lengthwise_coordinate, one.gradient_norm]
    functions += [lambda rho, z, k=k: one.edges(rho, z)[k] for k in range(len(EDGE_NAMES))]
    for function in functions:
        jet = function(*where)
        parts = np.broadcast_arrays(jet.rho, jet.z, jet.rho_rho, jet.rho_z, jet.z_z)
        if not isinstance(jet.rho, float):
            assert_allclose(parts, differences(function, *where), rtol=0, atol=1e-7)
        else:
            assert_allclose(parts[:2], [math.copysign(abs(jet.rho), jet.rho), jet.z])
            rho, z = where
            rise = (function(rho + STEP, z).value - function(rho - STEP, z).value) / (2.0 * STEP)
            assert_allclose(jet.rho, rise, atol=1e-9)


@given(st.floats(0.05, 2.5), distances, sides)
def test_flank_holds_the_points_of_the_great_circle_that_unwinds(arc, distance, side):
    """Unwound by the arc w, the tangent point has run along w/sin(delta_b) of the base circle."""
    run = arc / math.sin(BASE)
    tangent_point = np.array([math.sin(BASE), 0.0, math.cos(BASE)])
    along = np.array([0.0, -1.0, 0.0])
    x, y, z = math.cos(arc) * tangent_point + math.sin(arc) * along
    angle, turned = math.acos(z), math.atan2(y, x) + run
    found = spherical_involute(np.array(angle), BASE)
    assert_allclose(found, turned, rtol=0, atol=OF_ANGLES)
    # cosines near one are inverted, at arcs down to 0.05: 3e-14 seen
    assert_allclose(unwound_arc(np.array(angle), BASE), arc, rtol=1e-10)
    theta = flank(side).theta(*place(angle, distance)).value
    pitch = spherical_involute(np.array(PITCH), BASE)
    assert_allclose(theta, side * (pitch - turned), rtol=0, atol=OF_ANGLES)


@given(sides, spirals)
def test_theta_is_zero_on_the_pitch_cone_at_the_mean_cone_distance(side, spiral):
    assert_allclose(flank(side, spiral).theta(*place(PITCH, 70.0)).value, 0.0, atol=1e-15)  # an angle less itself


@given(angles, distances, sides, spirals)
def test_gradient_norm_is_that_of_theta(angle, distance, side, spiral):
    one, (rho, z) = flank(side, spiral), place(angle, distance)
    jet = one.theta(rho, z)
    spherical = math.hypot(1.0 / rho, jet.rho, jet.z)
    # also below: slopes near the base cone have a root of a difference
    if spiral == 0.0:
        assert_allclose(one.gradient_norm(rho, z).value, spherical, rtol=1e-10)
    closed = math.sqrt(1.0 / math.sin(BASE) ** 2 + (math.tan(spiral) / math.sin(PITCH)) ** 2) / distance
    assert_allclose([spherical, one.gradient_norm(rho, z).value], closed, rtol=1e-10)


@given(distances, spirals)
def test_spiral_crosses_the_generators_of_the_pitch_cone_under_the_spiral_angle(distance, spiral):
    rho, z = place(PITCH, distance)
    jet = flank(1, spiral).theta(rho, z)
    along = jet.rho * math.sin(PITCH) + jet.z * math.cos(PITCH)
    assert_allclose(rho * along, math.tan(spiral), rtol=0, atol=OF_ANGLES)


@given(angles, distances, sides, spirals)
def test_normal_is_unit_and_leaves_the_material_on_the_side_of_the_flank(angle, distance, side, spiral):
    normal = outward_normal(flank(side, spiral), *place(angle, distance))
    assert_allclose(np.linalg.norm(normal), 1.0, rtol=ROUNDING)
    assert side * normal[1] > 0.0


def test_flat_cone_tends_to_the_involute_of_the_plane():
    """Near the axis the sphere is flat: u R is a radius, u_b R the base radius."""
    small = 1e-3
    cones = (0.96 * small, 1.1 * small)
    narrow = SphericalInvoluteFlank(small, PRESSURE, 0.0, 1, cones, (999.0, 1001.0))
    flat = InvoluteFlank(math.cos(PRESSURE), 0.0, 1, 1.0, (0.96, 1.1), 2.0)
    rho = np.linspace(0.96, 1.1, 7)
    z = np.sqrt(1000.0**2 - rho**2)
    assert_allclose(narrow.theta(rho, z).value, flat.theta(rho, z).value, rtol=0, atol=1e-6)  # u^2


def test_profile_stays_smooth_where_the_cone_becomes_a_disc():
    """A wheel beyond 90 deg (shaft angle 120 deg, ratio 3) has an involute like any other."""
    pitch = math.radians(100.9)
    crown = SphericalInvoluteFlank(pitch, PRESSURE, 0.0, 1, (math.radians(88.0), math.radians(104.0)), DISTANCES)
    angle = np.linspace(math.radians(88.0), math.radians(92.0), 9)
    theta = crown.theta(70.0 * np.sin(angle), 70.0 * np.cos(angle)).value
    assert (np.diff(theta) < 0.0).all()
    assert_allclose(np.diff(theta, 3), 0.0, atol=1e-5)


@pytest.mark.parametrize("depth", [0.0, 1e-12, 1e-3])
def test_theta_is_finite_at_and_below_the_base_cone(depth):
    jet = flank(cones=(BASE, CONES[1])).theta(*place(BASE - depth, 70.0))
    assert np.isfinite([jet.value, jet.rho, jet.z, jet.rho_rho, jet.rho_z, jet.z_z]).all()


def test_apex_is_no_flank_but_does_no_harm():
    assert np.isfinite(flank(1, 0.5).theta(np.array(1e-9), np.array(1e-9)).value)


def test_grid_covers_the_region_from_edge_to_edge():
    one = flank()
    rho, z = one.grid(9, 5)
    assert one.inside(rho, z, tolerance=1e-12).all()
    on_edge = [np.abs(edge.value).min() for edge in one.edges(rho, z)]
    assert_allclose(on_edge, 0.0, atol=OF_ANGLES)
    assert_allclose(np.diff(one.profile_coordinate(rho, z).value, 2, axis=0), 0.0, atol=OF_ANGLES)
    assert_allclose(np.diff(one.lengthwise_coordinate(rho, z).value, 2, axis=1), 0.0, atol=OF_ANGLES)
    assert_allclose(one.extent, (np.ptp(rho), np.ptp(z)))


def test_edges_are_distances_in_millimetres():
    one, (rho, z) = flank(), place(PITCH, 70.0)
    expected = [70.0 * math.sin(CONES[1] - PITCH), 70.0 * math.sin(PITCH - CONES[0]), 10.0, 10.0]
    assert_allclose([edge.value for edge in one.edges(rho, z)], expected, rtol=OF_ANGLES)


test_cones_out_of_order_are_refused = refused_calls(
    (lambda: flank(cones=(0.5, 0.9)), r"base .* <= root"),
    (lambda: flank(cones=(0.9, 0.85)), "< face"),
    (lambda: flank(cones=(0.9, 3.0)), "cone_angles"),
    (
        lambda: SphericalInvoluteFlank(PITCH, PRESSURE, 0.0, 1, CONES, (80.0, 60.0)),
        r"cone_distances: 0 < toe 80.0 < heel 60.0 mm",
    ),
)


MEAN = 72.0
CIRCLE = CutterCircle(MEAN, math.radians(30.0), 90.0)


def circular(side, spiral=math.radians(30.0)):
    """Teeth along the circle of a cutter, through 30 deg at 72 mm, off the middle of the face."""
    return SphericalInvoluteFlank(PITCH, PRESSURE, spiral, side, CONES, DISTANCES, zero_distance=MEAN, circle=CIRCLE)


@given(angles, distances, sides, st.sampled_from([-1.0, 1.0]))
def test_derivatives_along_a_circle_agree_with_differences(angle, distance, side, hand):
    one, where = circular(side, hand * math.radians(30.0)), place(angle, distance)
    for function, allowed in ((one.theta, DIFFERENCE), (one.gradient_norm, 1e-7)):
        jet = function(*where)
        found = [jet.rho, jet.z, jet.rho_rho, jet.rho_z, jet.z_z]
        assert_allclose(found, differences(function, *where), rtol=0, atol=allowed)
    theta, size = one.theta(*where), one.gradient_norm(*where).value
    assert_allclose(size, np.sqrt(1.0 / where[0] ** 2 + theta.rho**2 + theta.z**2), rtol=1e-9)


@given(distances)
def test_spiral_angle_along_a_circle_is_that_of_the_standard(distance):
    """Formula 193: sin(beta) = (2 R_m r sin(beta_m) - R_m^2 + R^2)/(2 R r), on the pitch cone."""
    theta = circular(1).theta(*place(PITCH, distance))
    along = distance * math.sin(PITCH) * (theta.rho * math.sin(PITCH) + theta.z * math.cos(PITCH))
    sine = (2.0 * MEAN * 90.0 * 0.5 - MEAN**2 + distance**2) / (2.0 * distance * 90.0)
    assert_allclose(math.sin(math.atan(along)), sine, rtol=1e-9)
    assert_allclose(circular(1).theta(*place(PITCH, MEAN)).value, 0.0, atol=OF_ANGLES)
