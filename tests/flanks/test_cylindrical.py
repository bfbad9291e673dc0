"""The involute helicoid against its parametric definition and against differences of an independent formula."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.errors import InputError
from loaded_tca.flanks import InvoluteFlank
from loaded_tca.flanks.base import EDGE_NAMES, outward_normal

BASE, WORKING, RADII, WIDTH = 47.9, 51.0, (48.5, 54.0), 25.0
ROUNDING = 1e-12  # of closed forms: 2e-16 seen
NEAR_BASE = 1e-11  # a root of a difference of squares, down to 1e-3 of these: 3e-15 seen
OF_ANGLES = 1e-14  # rad; of some 0.1 rad, an involute and a lead: 1e-16 seen
COMPLEX_STEP = 1e-30  # the derivative carries no cancellation
SECOND_DIFFERENCE = 2e-8  # central differences of the exact slope with a step of 1e-4 mm near the base circle

sides = st.sampled_from([1, -1])
helices = st.floats(-0.5, 0.5)
radii = st.floats(*RADII)
places = st.floats(-0.6 * WIDTH, 0.6 * WIDTH)


def flank(side=1, helix=0.0, form=RADII[0]):
    return InvoluteFlank(BASE, helix, side, WORKING, (form, RADII[1]), WIDTH)


def involute(radius):
    """inv(alpha) with cos(alpha) = r_b/radius, for complex radii too."""
    angle = np.arccos(BASE / (radius + 0j))
    return np.tan(angle) - angle


def theta(radius, z, side, helix):
    return side * (involute(WORKING) - involute(radius)) + z * math.tan(helix) / BASE


def slope(radius, side):
    return theta(radius + 1j * COMPLEX_STEP, 0.0, side, 0.0).imag / COMPLEX_STEP


@given(radii, places, sides, helices)
def test_theta_and_its_derivatives_agree_with_the_involute_function(rho, z, side, helix):
    jet = flank(side, helix).theta(np.array(rho), np.array(z))
    assert_allclose(jet.value, theta(rho, z, side, helix).real, rtol=0, atol=OF_ANGLES)
    assert_allclose(jet.rho, slope(rho, side), rtol=NEAR_BASE)
    assert_allclose(jet.z, math.tan(helix) / BASE, rtol=ROUNDING)
    step = 1e-4
    bend = (slope(rho + step, side) - slope(rho - step, side)) / (2.0 * step)
    assert_allclose(jet.rho_rho, bend, rtol=0, atol=SECOND_DIFFERENCE)
    assert jet.rho_z == jet.z_z == 0.0


@given(st.floats(0.2, 0.52), places, sides, helices)
def test_flank_holds_the_points_of_the_unwound_thread(roll, z, side, helix):
    """x = r_b (cos t + t sin t), y = r_b (sin t - t cos t), turned and twisted: ISO 21771, 5.3."""
    x, y = BASE * (math.cos(roll) + roll * math.sin(roll)), BASE * (math.sin(roll) - roll * math.cos(roll))
    turned = side * (involute(WORKING).real - math.atan2(y, x)) + z * math.tan(helix) / BASE
    found = flank(side, helix).theta(np.array(math.hypot(x, y)), np.array(z)).value
    assert_allclose(found, turned, rtol=0, atol=OF_ANGLES)


@pytest.mark.parametrize("side", [1, -1])
def test_theta_is_zero_at_the_working_radius_of_the_middle_section(side):
    assert_allclose(flank(side, 0.3).theta(np.array(WORKING), np.array(0.0)).value, 0.0, atol=OF_ANGLES)


@given(radii, places, helices)
def test_theta_of_the_other_side_is_the_mirror_image_of_the_other_hand(rho, z, helix):
    rho, z = np.array(rho), np.array(z)
    # the same operations with the signs turned, to the bit
    assert_array_equal(flank(-1, helix).theta(rho, z).value, -flank(1, -helix).theta(rho, z).value)


@given(radii, places, st.floats(0.01, 0.5), sides)
def test_theta_grows_with_z_on_a_right_hand_gear(rho, z, helix, side):
    lower, upper = flank(side, helix).theta(np.array(rho), np.array([z, z + 1.0])).value
    assert upper > lower


@given(radii, places, sides, helices)
def test_normal_is_tangent_to_the_base_cylinder_and_leaves_the_material(rho, z, side, helix):
    """Its lever about the axis is r_b cos(beta_b), its axial part sin(beta_b), everywhere."""
    across, around, axial = outward_normal(flank(side, helix), np.array(rho), np.array(z))
    assert_allclose(around * rho, side * BASE * math.cos(helix), rtol=ROUNDING)
    assert_allclose(axial, -side * math.sin(helix), rtol=1e-10, atol=OF_ANGLES)  # atol: a spur gear, whose sine is none
    assert across > 0.0, "the flank of an external tooth faces outwards"


@given(radii, places, sides, helices)
def test_gradient_norm_turns_a_distance_along_the_normal_into_an_angle(rho, z, side, helix):
    one = flank(side, helix)
    jet = one.theta(np.array(rho), np.array(z))
    assert_allclose(
        one.gradient_norm(np.array(rho), np.array(z)).value, math.hypot(1.0 / rho, jet.rho, jet.z), rtol=ROUNDING
    )


@given(radii, places)
def test_roll_length_and_its_derivatives_agree_with_pythagoras(rho, z):
    jet = flank().profile_coordinate(np.array(rho), np.array(z))
    root = np.sqrt((rho + 1j * COMPLEX_STEP) ** 2 - BASE**2)
    assert_allclose([jet.value, jet.rho], [root.real, root.imag / COMPLEX_STEP], rtol=NEAR_BASE)
    assert_allclose(jet.value * jet.rho_rho + jet.rho**2, 1.0, rtol=1e-9)  # (a^2)'' = 2


def test_edges_vanish_where_the_flank_ends_and_are_positive_inside():
    one = flank()
    inner, half = np.array(51.0), 0.5 * WIDTH
    on_edge = {
        "tip": (RADII[1], 0.0),
        "root": (RADII[0], 0.0),
        "lower side": (inner, -half),
        "upper side": (inner, half),
    }
    for k, name in enumerate(EDGE_NAMES):
        values = [float(jet.value) for jet in one.edges(*map(np.array, on_edge[name]))]
        assert values[k] == 0.0
        assert all(value > 0.0 for j, value in enumerate(values) if j != k)


def test_edge_derivatives_agree_with_differences():
    one, step = flank(), 1e-3
    here, up, along = (one.edges(np.array(50.0 + dr), np.array(3.0 + dz)) for dr, dz in ((0, 0), (step, 0), (0, step)))
    for middle, higher, further in zip(here, up, along, strict=True):
        differences = [(higher.value - middle.value) / step, (further.value - middle.value) / step]
        # distances of some 10 mm are linear: their rounding over the step, 2e-12 seen
        assert_allclose([middle.rho, middle.z], differences, rtol=0, atol=1e-10)


def test_grid_spans_the_region_edges_included():
    rho, z = flank().grid(5, 7)
    assert rho.shape == z.shape == (5, 7)
    assert_allclose([rho.min(), rho.max(), z.min(), z.max()], [*RADII, -0.5 * WIDTH, 0.5 * WIDTH])
    assert flank().inside(rho, z).all()


def test_room_is_the_distance_to_the_nearest_edge():
    rho, z = np.array([50.0, 53.0, 49.0, 51.0, 56.0]), np.array([0.0, 0.0, 2.0, -12.0, 13.0])
    assert_allclose(flank().room(rho, z), [1.5, 1.0, 0.5, 0.5, -2.0], rtol=ROUNDING)


def test_inside_counts_the_edges_and_a_tolerance():
    one = flank()
    rho = np.array([RADII[1], RADII[1] + 1e-6, RADII[1] + 1e-6])
    z = np.zeros(3)
    assert one.inside(rho, z).tolist() == [True, False, False]
    assert one.inside(rho, z, tolerance=2e-6).all()


def test_theta_is_finite_down_to_the_base_circle_and_below():
    one = flank(form=BASE)
    jet = one.theta(np.array([BASE, BASE - 1.0]), np.zeros(2))
    assert np.isfinite([jet.value, jet.rho, jet.rho_rho]).all()


@pytest.mark.parametrize("limits", [(47.0, 54.0), (54.0, 54.0), (55.0, 54.0), (math.nan, 54.0)])
def test_radii_out_of_order_are_refused(limits):
    with pytest.raises(InputError, match=r"radii: base 47.9 <= form .* < tip .* mm does not hold"):
        InvoluteFlank(BASE, 0.0, 1, WORKING, limits, WIDTH)
