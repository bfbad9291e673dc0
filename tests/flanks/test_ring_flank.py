"""The flank of a ring: the surface of an external involute from its other side, tip inside, root outside."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.flanks import FlankModifications, InvoluteFlank
from loaded_tca.flanks.base import EDGE_NAMES, outward_normal
from loaded_tca.flanks.cylindrical import RingFlank
from tests.samples.internal_pairs import ring_pair

BASE, WORKING, RADII, WIDTH = 84.6, 90.0, (93.0, 87.6), 25.0
ROUNDING = 1e-12  # rad or mm, of some dozen operations on angles below one and lengths of 100 mm

sides = st.sampled_from([1, -1])
helices = st.floats(-0.5, 0.5)
radii = st.floats(RADII[1], RADII[0])
places = st.floats(-15.0, 15.0)


def flank(side=1, helix=0.0):
    return RingFlank(BASE, helix, side, WORKING, RADII, WIDTH)


@given(radii, places, sides, helices)
def test_surface_is_that_of_the_external_involute_of_the_other_side(rho, z, side, helix):
    ring = flank(side, helix).theta(np.array(rho), np.array(z))
    other = InvoluteFlank(BASE, helix, -side, WORKING, RADII[::-1], WIDTH).theta(np.array(rho), np.array(z))
    for name in ("value", "rho", "z", "rho_rho"):
        assert_allclose(getattr(ring, name), getattr(other, name), rtol=ROUNDING, atol=ROUNDING)


@given(radii, places, sides, helices)
def test_normals_point_out_of_the_material_against_those_of_the_external_tooth(rho, z, side, helix):
    place = np.array(rho), np.array(z)
    other = InvoluteFlank(BASE, helix, -side, WORKING, RADII[::-1], WIDTH)
    assert_allclose(outward_normal(flank(side, helix), *place), -outward_normal(other, *place), atol=ROUNDING)
    assert outward_normal(flank(side, helix), *place)[0] < 0.0  # towards the axis


def test_edges_and_coordinates_rise_from_root_to_tip_and_from_the_lower_to_the_upper_end():
    one = flank()
    rho, z = one.grid(5, 7)
    assert_allclose(rho[[0, -1], 0], RADII)
    tip, root, lower, upper = (np.broadcast_to(jet.value, rho.shape) for jet in one.edges(rho, z))
    assert EDGE_NAMES == ("tip", "root", "lower side", "upper side")
    for distance, at in ((tip, np.s_[-1]), (root, np.s_[0]), (lower, np.s_[:, 0]), (upper, np.s_[:, -1])):
        assert_allclose(distance[at], 0.0, atol=ROUNDING)
    assert (np.diff(one.profile_coordinate(rho, z).value, axis=0) > 0.0).all()
    assert (np.diff(one.lengthwise_coordinate(rho, z).value, axis=1) > 0.0).all()
    assert_allclose(one.profile_coordinate(rho, z).value, -np.sqrt(rho**2 - BASE**2), rtol=ROUNDING)


def test_pictures_have_the_tip_on_top_and_the_axis_of_the_pinion():
    x, y = flank().frame.to_picture(np.array([RADII[0], RADII[1]]), np.array([3.0, 3.0]))
    assert y[1] > y[0]
    assert_allclose(x, -3.0)
    assert flank().frame.profile_span((93.0, 0.0), (87.6, 0.0)) == "diameter 186.00 to 175.20 mm"


@pytest.mark.parametrize("radii", [(87.0, 93.0), (93.0, 84.0)])
def test_radii_in_the_wrong_order_are_refused(radii):
    with pytest.raises(InputError, match=r"base 84\.6 <= tip"):
        RingFlank(BASE, 0.0, 1, WORKING, radii, WIDTH)


def removed(modifications, rho, fixed_z):
    """Material that modifications take off a ring, at places in the axes of the pinion [mm]."""
    pair = ring_pair(wheel=modifications)
    gear = pair.wheel
    z = -np.asarray(fixed_z, dtype=float)
    change = gear.flank.theta(np.asarray(rho), z).value - gear.nominal_flank.theta(np.asarray(rho), z).value
    return -gear.flank.side * change / gear.nominal_flank.gradient_norm(rho, z).value


@pytest.mark.parametrize(
    "start",
    [
        {"tip_relief_start": 180.0},
        {"tip_relief_start_length": math.sqrt(90.0**2 - (90.0 * math.cos(math.radians(20))) ** 2)},
    ],
)
def test_tip_relief_grows_towards_the_smaller_diameter(start):
    relief = FlankModifications(tip_relief=0.02, **start)
    assert_allclose(removed(relief, [92.0, 90.5, 87.6], [0.0, 0.0, 0.0]), [0.0, 0.0, 0.02], atol=ROUNDING)


def test_tip_relief_starts_at_a_roll_angle():
    roll = math.tan(math.radians(20))  # of the reference circle
    relief = FlankModifications(tip_relief=0.02, tip_relief_start_roll=roll)
    assert_allclose(removed(relief, [90.1, 87.6], [0.0, 0.0]), [0.0, 0.02], atol=ROUNDING)


def test_root_relief_grows_towards_the_larger_diameter():
    pair = ring_pair()
    start = pair.wheel.geometry.active.start_radius
    relief = FlankModifications(root_relief=0.02, root_relief_start=180.0)
    assert_allclose(removed(relief, [87.6, 89.5, start], [0.0, 0.0, 0.0]), [0.0, 0.0, 0.02], atol=ROUNDING)


def test_ends_of_the_face_are_those_of_the_pinion():
    relief = FlankModifications(end_relief_lower=0.02, end_relief_lower_length=5.0)
    assert_allclose(removed(relief, [90.0] * 3, [-12.5, 0.0, 12.5]), [0.02, 0.0, 0.0], atol=ROUNDING)
    slope = FlankModifications(helix_slope=0.01)
    assert_allclose(removed(slope, [90.0] * 3, [-12.5, 0.0, 12.5]), [0.0, 0.005, 0.01], atol=ROUNDING)


def test_twist_is_the_slope_at_the_tip_less_that_at_the_root():
    """Over the active profile, as on every flank; nothing on the lines through the middle."""
    pair = ring_pair()
    start = pair.wheel.geometry.active.start_radius
    corners = removed(FlankModifications(twist=0.01), [87.6, 87.6, start, start], [-12.5, 12.5, -12.5, 12.5])
    assert_allclose(corners, [-0.0025, 0.0025, 0.0025, -0.0025], atol=ROUNDING)


def test_relief_that_starts_off_the_profile_is_refused():
    with pytest.raises(
        InputError, match=r"wheel.modifications.tip_relief_start .*: 170 mm is not between 175.2 and 18"
    ):
        ring_pair(wheel=FlankModifications(tip_relief=0.02, tip_relief_start=170.0))
