import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError
from loaded_tca.flank_maps.ease_off_map import ease_off_map
from loaded_tca.flanks import FlankModifications, fitted
from loaded_tca.flanks.rounding import EdgeRounding
from loaded_tca.gears import CylindricalGear, CylindricalMesh, bevel_mesh
from loaded_tca.pairs.bevel import BevelMounting, bevel_pair
from loaded_tca.pairs.cylindrical import Mounting, cylindrical_pair
from tests.refusals import refused_calls
from tests.samples.gear_pairs import cylindrical_mesh, gear_pair

ROUNDING = 1e-11
"""mm: far below the 1e-9 mm that a conjugate pair may show; a difference of leads times a lever of tens of mm."""
BOTH = ["pinion", "wheel"]
NONE = FlankModifications()
MANY = FlankModifications(
    lead_crowning=0.010,
    profile_crowning=0.006,
    tip_relief=0.020,
    tip_relief_start=105.0,
    tip_relief_form="linear",
    helix_slope=-0.008,
    twist=0.012,
    polynomial=(0.0, 1e-4, 2e-4, 1e-5, 2e-5, 1e-4),
)
CYLINDRICAL = [
    pytest.param(lambda **k: gear_pair(**k), id="spur"),
    pytest.param(lambda **k: gear_pair(helix_deg=20.0, **k), id="helical"),
]
BEVEL = [
    pytest.param(lambda **k: bevel(0.0, **k), id="straight bevel"),
    pytest.param(lambda **k: bevel(35.0, **k), id="spiral bevel"),
]


def bevel(spiral_deg, pinion=NONE, wheel=NONE, mounting=None, **changes):
    mesh = bevel_mesh((20, 31), outer_module=4.0, face_width=22.0, spiral_angle=math.radians(spiral_deg))
    return bevel_pair(mesh, modifications=(pinion, wheel), mounting=mounting or BevelMounting(), **changes)


def own_removal(pair, gear, found):
    """Modification of a flank at the points of its map, zero at its highest point [mm]."""
    flank = pair.pinion.flank if gear == "pinion" else pair.wheel.flank
    off = flank.removal(found.radius, found.axial).value
    return off - off.min()


@pytest.mark.quick_cases(every=5)
@pytest.mark.parametrize("sense", ["positive", "negative"])
@pytest.mark.parametrize("driving", BOTH)
@pytest.mark.parametrize("gear", BOTH)
@pytest.mark.parametrize("make", CYLINDRICAL + BEVEL)
def test_ease_off_of_conjugate_flanks_is_zero(make, gear, driving, sense):
    found = ease_off_map(make(driving=driving, sense=sense), gear, (9, 9))
    assert_allclose(found.ease_off, 0.0, atol=ROUNDING)
    assert found.covered.all()


@pytest.mark.parametrize("driving", BOTH)
@pytest.mark.parametrize("gear", BOTH)
@pytest.mark.parametrize("make", CYLINDRICAL)
def test_ease_off_is_the_modification_against_an_unmodified_mate(make, gear, driving):
    """Exactly, not to first order: reliefs with a relief start, twist and polynomial too."""
    changes = MANY if gear == "pinion" else FlankModifications(lead_crowning=0.02, profile_slope=0.005, twist=-0.01)
    pair = make(**{gear: changes, "driving": driving})
    found = ease_off_map(pair, gear, (11, 9))
    assert_allclose(found.ease_off, own_removal(pair, gear, found), rtol=0, atol=ROUNDING)


@pytest.mark.parametrize("gear", BOTH)
@pytest.mark.parametrize("make", BEVEL)
def test_ease_off_of_a_bevel_gear_is_its_modification(make, gear):
    pair = make(**{gear: FlankModifications(lead_crowning=0.015, profile_crowning=0.006, twist=0.02)})
    found = ease_off_map(pair, gear, (11, 9))
    assert_allclose(found.ease_off, own_removal(pair, gear, found), rtol=0, atol=ROUNDING)


def test_ends_of_a_crowned_face_lack_the_crowning():
    found = ease_off_map(gear_pair(FlankModifications(lead_crowning=0.010)))
    assert_allclose(found.corners, 0.010, rtol=1e-9)
    assert_allclose(found.second_order.lengthwise_crowning, 0.010, rtol=1e-9)
    assert_allclose(found.second_order.profile_crowning, 0.0, atol=ROUNDING)


def test_corners_are_those_of_a_twisted_flank():
    """Twist S: S/2 at one diagonal above the other, foot and tip in the rows, z < 0 and z > 0 in the columns."""
    found = ease_off_map(gear_pair(FlankModifications(twist=0.020)))
    assert_allclose(found.corners, [[0.010, 0.0], [0.0, 0.010]], atol=1e-9)
    assert_allclose(found.second_order.twist, 0.020, rtol=1e-6)


@pytest.mark.parametrize("make", CYLINDRICAL + BEVEL)
def test_second_order_of_a_polynomial_is_its_coefficients(make):
    amounts = (0.0, 1e-4, 2e-4, -3e-5, 4e-5, 3e-4)
    numbers = ease_off_map(make(pinion=FlankModifications(polynomial=amounts))).second_order
    assert_allclose(numbers.polynomial, amounts, atol=1e-7)  # 0.1 nm: places are interpolated
    assert numbers.residual < 1e-8


def fit_of_sum(size, gear="pinion"):
    """How far the ease-off of two modified gears is from the sum of their modifications, amounts times ``size``."""
    own = FlankModifications(lead_crowning=0.02 * size, profile_crowning=0.01 * size)
    mating = FlankModifications(lead_crowning=0.01 * size, profile_crowning=0.02 * size, twist=0.02 * size)
    pair = gear_pair(own, mating, helix_deg=15.0)
    found = ease_off_map(pair, gear, (11, 11))
    here = (found.radius, found.axial), (found.mating_radius, found.mating_axial)
    places = here if gear == "pinion" else here[::-1]
    total = pair.pinion.flank.removal(*places[0]).value + pair.wheel.flank.removal(*places[1]).value
    difference = found.ease_off - total
    return float(np.ptp(difference))


@pytest.mark.parametrize("gear", BOTH)
def test_modifications_of_both_gears_add_up_to_first_order(gear):
    """What is left is of second order: a quarter for half the amounts."""
    left = [fit_of_sum(size, gear) for size in (1.0, 0.5, 0.25)]
    assert left[0] < 0.02 * 0.06  # of all that is off
    assert_allclose(np.divide(left[:-1], left[1:]), 4.0, rtol=0.1)


@pytest.mark.quick_cases(every=3)
@pytest.mark.parametrize("gear", BOTH)
@pytest.mark.parametrize(("driving", "side"), [("pinion", 1.0), ("wheel", -1.0)])
@pytest.mark.parametrize("error", ["in_plane", "out_of_plane"])
def test_axis_error_of_a_spur_pair_turns_the_flank_lengthwise(error, driving, side, gear):
    """delta cos(alpha) - gamma sin(alpha) on the flank s = +1; the contact goes where less is off, to z > 0."""
    angle = math.radians(20.0)
    first_order = {"in_plane": math.sin(angle), "out_of_plane": -side * math.cos(angle)}[error]
    pair = gear_pair(driving=driving, mounting=Mounting(**{error: 1e-4}))
    numbers = ease_off_map(pair, gear).second_order
    assert_allclose(numbers.spiral_angle, 1e-4 * first_order, rtol=1e-3)
    assert abs(numbers.pressure_angle) < 1e-7
    assert numbers.residual < 1e-8


@pytest.mark.parametrize("error", [{"centre_distance_error": 0.3}, {"axial_offset": 2.0}])
def test_involutes_stay_conjugate_at_another_distance(error):
    found = ease_off_map(gear_pair(helix_deg=15.0, mounting=Mounting(**error)))
    assert_allclose(found.ease_off, 0.0, atol=ROUNDING)


def test_map_over_the_narrower_gear():
    gears = [CylindricalGear(z, 3.0, width) for z, width in ((34, 30.0), (57, 20.0))]
    pair = cylindrical_pair(CylindricalMesh(*gears), modifications=(FlankModifications(lead_crowning=0.009), NONE))
    found = ease_off_map(pair)
    assert_allclose(found.lengthwise[:, [0, -1]], np.broadcast_to([-10.0, 10.0], (31, 2)), atol=1e-6)
    assert_allclose(found.corners, 0.004, rtol=1e-6)  # 9 um at 15 mm are 4 um at 10 mm


def test_offset_of_a_spiral_pair_tilts_the_map_with_the_error():
    angles = [
        ease_off_map(bevel(35.0, mounting=BevelMounting(offset=offset))).second_order.spiral_angle
        for offset in (-0.01, 0.01, 0.02)
    ]
    assert_allclose(angles[0], -angles[1], rtol=0.02)  # to first order
    assert_allclose(angles[2], 2.0 * angles[1], rtol=0.02)
    assert abs(angles[1]) > 1e-5


def test_slivers_beside_slanted_edges_are_marked():
    found = ease_off_map(gear_pair(mounting=Mounting(out_of_plane=2e-3)))
    assert 0.95 < found.covered.mean() < 1.0
    assert found.covered[1:-1, 1:-1].all()
    assert np.isfinite(found.ease_off).all()


def test_fitted_flank_has_the_ease_off_of_its_equations():
    pair = gear_pair(FlankModifications(lead_crowning=0.010, profile_crowning=0.005))
    spline = fitted(pair.pinion.flank)
    other = pair.with_flanks(pinion=spline)
    exact, found = (ease_off_map(one, grid=(9, 9)).ease_off for one in (pair, other))
    assert_allclose(found, exact, atol=4.0 * spline.check_error.largest + ROUNDING)


def test_points_of_the_map_and_of_the_mate_are_on_their_flanks():
    pair = gear_pair(MANY, helix_deg=15.0)
    found = ease_off_map(pair)
    assert pair.pinion.flank.inside(found.radius, found.axial, 1e-6).all()
    assert pair.wheel.flank.inside(found.mating_radius, found.mating_axial, 1e-4).all()
    # the modified foot is a little beyond the nominal one
    active = cylindrical_mesh(helix_deg=15.0).pinion_active_profile
    assert_allclose(found.profile[[0, -1], 0], (active.start_roll_length, active.end_roll_length), atol=0.1)


def test_shown_by_gear_and_size():
    shown = repr(ease_off_map(gear_pair(FlankModifications(lead_crowning=0.010)), "wheel", (5, 7)))
    assert shown == "EaseOffMap(wheel, 5 x 7 points, up to 10 um)"


test_ease_off_map_refuses = refused_calls(
    (lambda: ease_off_map(gear_pair(), "rack", (2, 9)), ("^gear:", "^grid:")),
    (lambda grid: ease_off_map(gear_pair(), grid=grid), "grid", [(9,), 9, (9.0, 9), (9, 2), None]),
)


@pytest.mark.thorough
def test_mounting_errors_that_leave_a_hole_in_the_map_are_refused():
    """Half a module: the tip of the wheel reaches below the base cone of the pinion, where no flank is left."""
    mesh = bevel_mesh((17, 17), outer_module=1.0, face_width=4.8, spiral_angle=math.radians(35.0))
    crowned = (FlankModifications(lead_crowning=0.010, profile_crowning=0.004), NONE)
    pair = bevel_pair(mesh, modifications=crowned, mounting=BevelMounting(offset=0.05, pinion_axial=-0.5))
    with pytest.raises(GeometryError, match=r"no ease-off: at \d+ of 1271 points, first at .* pitch cone"):
        ease_off_map(pair, "wheel")


def test_rounded_edges_are_no_part_of_the_ease_off():
    """They are tenths of a millimetre deep, modifications hundredths."""
    pair = gear_pair(FlankModifications(lead_crowning=0.01))
    sharp, rounded = (ease_off_map(one) for one in (pair, pair.rounded(EdgeRounding(0.2, 0.2), EdgeRounding(0.2, 0.2))))
    np.testing.assert_array_equal(rounded.corners, sharp.corners)  # exact: the same flanks, without their rounding
