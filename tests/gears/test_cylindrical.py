from dataclasses import replace
from itertools import pairwise
from math import acos, atan, cos, degrees, hypot, inf, nan, pi, radians, sin, sqrt, tan

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError, InputError, LoadedTCAError
from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.gears.involute import inverse_involute, involute
from tests.refusals import refusals, refused_calls

ROUNDING = 1e-12  # a few dozen floating point operations
FITTED = 1e-10  # brentq stops at 2e-12 rad of the rack's normal


def gear(teeth=30, **changes):
    return CylindricalGear(**{"teeth": teeth, "normal_module": 2.0, "face_width": 20.0, **changes})


def mesh(pinion_teeth=30, wheel_teeth=47, x1=0.0, x2=0.0, centre_distance=None, helix_angle=0.0, **changes):
    pinion = gear(pinion_teeth, name="pinion", profile_shift=x1, helix_angle=helix_angle, **changes)
    wheel = gear(wheel_teeth, name="wheel", profile_shift=x2, helix_angle=-helix_angle, **changes)
    return CylindricalMesh(pinion, wheel, centre_distance)


def fzg_c14(centre_distance=91.5):
    pinion = CylindricalGear(16, 4.5, 14.0, profile_shift=0.1817, name="pinion")
    wheel = CylindricalGear(24, 4.5, 14.0, profile_shift=0.1715, name="wheel")
    return CylindricalMesh(pinion, wheel, centre_distance)


@st.composite
def ordinary_meshes(draw):
    """Pairs that exist: moderate shifts, no undercut below 25 teeth."""
    first, second = draw(st.integers(25, 120)), draw(st.integers(25, 120))
    x1, x2 = draw(st.floats(-0.3, 0.5)), draw(st.floats(-0.3, 0.5))
    return mesh(first, second, x1, x2, helix_angle=draw(st.floats(-0.6, 0.6)))


# Involute


@given(st.floats(1e-4, 1.5))
def test_inverse_involute_undoes_the_involute(angle):
    # inv(alpha) = alpha^3/3 + ... loses three digits of alpha per digit of smallness: eps/alpha^2
    # tan(angle) - angle leaves angle^3/3, known to eps/angle^2: 1.4e-16/angle^2 seen
    assert_allclose(inverse_involute(involute(angle)), angle, rtol=2e-15 + 2e-15 / angle**2)


def test_inverse_involute_ends_at_its_limits():
    assert inverse_involute(0.0) == 0.0
    assert_allclose(inverse_involute(1e6), atan(1e6 + pi / 2.0), rtol=ROUNDING)
    assert_allclose(inverse_involute(3e-30), (9e-30) ** (1 / 3), rtol=1e-9)


# One gear


def test_spur_gear_sizes_follow_from_teeth_and_module():
    spur = gear(30)
    assert_allclose(
        [spur.reference_radius, spur.base_radius, spur.tip_radius, spur.root_radius, spur.base_pitch],
        [30.0, 30.0 * cos(radians(20)), 32.0, 27.5, 2.0 * pi * cos(radians(20))],
        rtol=ROUNDING,
    )
    # atol: mm, a difference of equal numbers
    assert_allclose([spur.tooth_thickness, spur.tip_alteration], [pi, 0.0], rtol=ROUNDING, atol=1e-14)


def test_helical_gear_sizes_are_those_of_the_transverse_section():
    helical = gear(30, helix_angle=radians(-25))
    assert_allclose(helical.transverse_module, 2.0 / cos(radians(25)), rtol=ROUNDING)
    assert_allclose(
        tan(helical.base_helix_angle),
        tan(radians(-25)) * cos(helical.transverse_pressure_angle),
        rtol=ROUNDING,
    )
    assert_allclose(helical.base_radius, helical.teeth * helical.base_pitch / (2.0 * pi), rtol=ROUNDING)


def test_tip_alteration_is_what_the_tip_diameter_lacks():
    # diameters of 60 mm are subtracted: 6e-16 seen
    assert_allclose(gear(30, profile_shift=0.2, tip_diameter=64.5).tip_alteration, -0.15, rtol=1e-10)


def test_root_diameter_stays_where_the_teeth_get_thinner():
    """d_f = d - 2 m_n (h_fP - x_E) by hand: 60 - 4 (1.3 - 0.05), and x_E = 0.05 - 0.1/(4 tan 20) of thinner teeth."""
    rooted = gear(30, profile_shift=0.05, root_diameter=55.0)
    assert_allclose(rooted.dedendum_coefficient, 1.3, rtol=ROUNDING)
    assert rooted == gear(30, profile_shift=0.05, root_diameter=55.0, dedendum_coefficient=1.1)
    thinner = replace(rooted, thickness_allowance=-0.1)
    assert_allclose([thinner.root_radius, thinner.form_radius], [27.5, by_hand(-0.1).form_radius], rtol=ROUNDING)
    assert_allclose(rooted.form_radius, by_hand(0.0).form_radius, rtol=ROUNDING)


def by_hand(allowance):
    shift = 0.05 + allowance / (4.0 * tan(radians(20.0)))
    return gear(30, profile_shift=0.05, thickness_allowance=allowance, dedendum_coefficient=1.25 + shift)


@given(st.integers(12, 200), st.floats(-0.2, 0.6), st.floats(-0.5, 0.5))
def test_tooth_thickness_at_reference_and_base_circle(teeth, shift, helix):
    any_gear = gear(teeth, profile_shift=shift, helix_angle=helix)
    assert_allclose(any_gear.tooth_thickness_at(any_gear.reference_radius), any_gear.tooth_thickness, rtol=ROUNDING)
    half_angle = any_gear.tooth_thickness_at(any_gear.base_radius) / (2.0 * any_gear.base_radius)
    assert_allclose(half_angle, any_gear.half_thickness_angle_at_base, rtol=ROUNDING)


def test_tooth_thickness_vanishes_at_the_pointed_radius():
    spur = gear(20, profile_shift=0.5)
    assert spur.pointed_radius > spur.tip_radius
    assert_allclose(spur.tooth_thickness_at(spur.pointed_radius), 0.0, atol=1e-13)  # mm; of 50 mm: 9e-15 seen


@given(st.floats(0.0, 40.0))
def test_radius_and_roll_length_are_inverse(roll_length):
    spur = gear()
    # sqrt(r^2 - r_b^2) loses digits near the base circle: eps r_b^2/a^2
    assert_allclose(spur.roll_length(spur.radius_at_roll_length(roll_length)), roll_length, rtol=ROUNDING, atol=1e-6)


def test_roll_length_starts_at_the_base_circle():
    spur = gear()
    assert spur.roll_length(spur.base_radius) == 0.0
    with pytest.raises(InputError, match=r"gear: radius 28 mm lies inside the base circle, radius 28\.1908 mm"):
        spur.roll_length(28.0)


# Rack, fillet, undercut


def test_form_circle_is_cut_by_the_end_of_the_straight_flank():
    spur = gear(30)
    depth = 2.0 * (1.25 - 0.38 * (1.0 - sin(radians(20))))
    assert_allclose(spur.rack_form_depth, depth, rtol=ROUNDING)
    # the rack's point on the line of action through the pitch point, depth below the pitch line
    assert_allclose(spur.form_radius, hypot(30.0 - depth, depth / tan(radians(20))), rtol=ROUNDING)


def test_rack_tip_radius_is_at_most_the_full_rounding():
    wide = gear(40, pressure_angle=radians(25))
    full = (pi / 4.0 - 1.25 * tan(radians(25))) * cos(radians(25)) / (1.0 - sin(radians(25)))
    assert_allclose(wide.rack_tip_radius, 2.0 * full, rtol=ROUNDING)
    assert gear(40).rack_tip_radius == 2.0 * 0.38


@pytest.mark.parametrize("helix_angle", [0.0, 0.5])
@pytest.mark.parametrize("teeth", [10, 17, 40])
def test_fillet_joins_root_circle_and_involute(teeth, helix_angle):
    any_gear = gear(teeth, helix_angle=helix_angle, profile_shift=0.1)
    radius, half_angle = any_gear.root_fillet(200)
    assert_allclose([radius[0], radius[-1]], [any_gear.form_radius, any_gear.root_radius], rtol=ROUNDING)
    at_form = any_gear.tooth_thickness_at(any_gear.form_radius) / (2.0 * any_gear.form_radius)
    assert_allclose(half_angle[0], at_form, rtol=FITTED)
    assert np.all(np.diff(radius) < 0.0)


def test_fillet_is_tangent_to_the_involute_without_undercut():
    spur = gear(30)
    radius, half_angle = spur.root_fillet(20001)
    fillet = (half_angle[1] - half_angle[0]) / (radius[1] - radius[0])
    involute_slope = -spur.roll_length(spur.form_radius) / spur.base_radius / spur.form_radius
    assert_allclose(fillet, involute_slope, rtol=2e-3)  # one-sided difference


@pytest.mark.parametrize("helix_angle", [0.0, 0.45])
@pytest.mark.parametrize("teeth", [9, 13, 30])
def test_fillet_is_the_envelope_of_the_rolling_rack(teeth, helix_angle):
    """Roll the rounded rack, point by point, and keep the thinnest tooth: the same fillet and form circle."""
    any_gear = gear(teeth, helix_angle=helix_angle)
    slope = np.linspace(any_gear.pressure_angle, 0.5 * pi, 400)[:, None]
    rounding, r = any_gear.rack_tip_radius, any_gear.reference_radius
    centre = pi / 4.0 * 2.0 - any_gear.rack_form_depth * tan(radians(20)) - rounding * cos(radians(20))
    x = (centre + rounding * np.cos(slope)) / cos(helix_angle)
    y = r - (2.0 * 1.25 - rounding) - rounding * np.sin(slope)
    turn = np.linspace(-0.9, 0.9, 3601)
    radius = np.hypot(x + r * turn, y)
    half_angle = pi / teeth - (np.arctan2(x + r * turn, y) - turn)
    fillet_radius, fillet_angle = any_gear.root_fillet(2000)
    gap = half_angle - np.interp(radius, fillet_radius[::-1], fillet_angle[::-1])
    edges = np.linspace(any_gear.root_radius + 0.01, any_gear.form_radius, 11)
    for below, above in pairwise(edges):
        inside = (below < radius) & (radius < above)
        # rad; the rolled points miss the envelope by the square of their step, 5e-4 rad
        assert_allclose(gap[inside].min(), 0.0, atol=3e-6)


def test_undercut_form_circle_lies_between_base_circle_and_the_lost_involute():
    for teeth in range(7, 17):
        cut = gear(teeth)
        assert cut.is_undercut
        assert cut.base_radius < cut.form_radius < cut.radius_at_roll_length(cut.rack_form_roll_length)


def test_seventeen_teeth_are_undercut_by_a_hair():
    spur = gear(17)
    assert spur.is_undercut
    assert spur.form_radius - spur.base_radius < 2e-5
    assert not gear(18).is_undercut


@pytest.mark.parametrize(("teeth", "helix_angle"), [(9, 0.0), (12, 0.0), (14, 0.4), (17, 0.0)])
def test_form_radius_is_continuous_where_the_undercut_begins(teeth, helix_angle):
    limit = gear(teeth, helix_angle=helix_angle).smallest_profile_shift
    shifts = limit + np.linspace(-1e-3, 1e-3, 40)
    gears = [gear(teeth, helix_angle=helix_angle, profile_shift=shift) for shift in shifts]
    above_base = [g.form_radius - g.base_radius for g in gears]
    # a_Ff = 2 mm dx/sin(alpha_t) and r_Ff - r_b = a^2/(2 r_b), to zero from both sides
    assert max(above_base) < (2e-3 / sin(radians(20))) ** 2 / (2.0 * gears[0].base_radius)
    assert min(above_base) >= 0.0
    assert [g.is_undercut for g in gears] == [shift < limit for shift in shifts]


def test_undercut_is_greater_with_less_profile_shift():
    radii = [gear(12, profile_shift=shift).form_radius for shift in (0.28, 0.2, 0.1, 0.0, -0.1)]
    assert radii == sorted(radii)


def test_sharp_cornered_rack_undercuts_more_than_a_rounded_one():
    sharp, rounded = (gear(10, root_radius_coefficient=radius) for radius in (0.0, 0.38))
    assert sharp.form_radius > rounded.form_radius
    cornered = gear(18, dedendum_coefficient=1.0, root_radius_coefficient=0.0)
    assert_allclose(cornered.smallest_profile_shift, 1.0 - 9.0 * sin(radians(20)) ** 2, rtol=ROUNDING)


# Gears that cannot be


@given(
    teeth=st.integers(-1, 60),
    normal_module=st.floats(0.01, 50.0),
    pressure_angle=st.floats(-0.1, 1.0),
    helix_angle=st.floats(-1.2, 1.2),
    profile_shift=st.floats(-3.0, 3.0),
    dedendum_coefficient=st.floats(0.0, 3.0),
    root_radius_coefficient=st.floats(-0.1, 1.0),
)
def test_any_input_makes_a_sound_gear_or_a_clear_error(**sizes):
    try:
        made = CylindricalGear(face_width=10.0, **sizes)
    except LoadedTCAError:
        return
    assert made.base_radius <= made.form_radius < made.tip_radius
    assert made.tooth_thickness_at(made.tip_radius) > 0.0
    radius, half_angle = made.root_fillet(20)
    assert np.isfinite(half_angle).all()
    assert_allclose(radius[-1], made.root_radius, rtol=ROUNDING)
    # not closer: the form circle is the base circle where rounding hides a slight undercut
    assert_allclose(radius[0], made.form_radius, rtol=1e-9)


test_gear_refuses_an_impossible_value = refusals(
    lambda changes: gear(**changes),
    ({"teeth": 2}, "gear: teeth: 2 is not a whole number from 3 on"),
    ({"teeth": 20.5}, "gear: teeth: 20.5 is not a whole number"),
    ({"teeth": nan}, "gear: teeth: nan is not a whole number"),
    ({"normal_module": 0.0}, "gear: normal_module: 0.0 is not positive and finite"),
    ({"face_width": 5e-324}, "gear: face_width: 5e-324 mm is below 0.001 normal_module, 0.002 mm"),
    ({"face_width": "wide"}, "gear: face_width: wide is not positive and finite"),
    ({"pressure_angle": None}, "gear: pressure_angle: nan rad is not between"),
    ({"helix_angle": "left"}, "gear: helix_angle: nan rad is not within"),
    ({"face_width": -1.0}, "gear: face_width: -1.0 is not positive and finite"),
    ({"tip_diameter": inf}, "gear: tip_diameter: inf is not positive and finite"),
    ({"bore_diameter": nan}, "gear: bore_diameter: nan is neither 0"),
    ({"bore_diameter": 55.0}, "gear: bore_diameter: 55 mm is not below the root diameter 55 mm"),
    ({"root_diameter": -50.0}, "gear: root_diameter: -50.0 is not positive"),
    ({"root_diameter": 51.0}, "gear: root_diameter: 51 mm asks for dedendum_coefficient = 2.25, which is beyond"),
    ({"root_diameter": 60.4}, "gear: root_diameter: 60.4 mm asks for dedendum_coefficient = -0.1, which is not pos"),
    ({"dedendum_coefficient": 0.0}, "gear: dedendum_coefficient: 0.0 is not positive"),
    ({"dedendum_coefficient": 2.2}, "gear: dedendum_coefficient: 2.2 is beyond the point of the rack's tooth"),
    ({"root_radius_coefficient": -0.1}, "gear: root_radius_coefficient: -0.1 is negative"),
    ({"pressure_angle": 20.0}, r"gear: pressure_angle: 20 rad is not between 0.0175 and 0.785 rad \(1 to 45 deg\)"),
    ({"helix_angle": -15.0}, r"gear: helix_angle: -15 rad is not within 1.047 rad \(60 deg\)"),
    ({"profile_shift": nan}, "gear: profile_shift: nan is not finite"),
    ({"profile_shift": -14.0}, "gear: profile_shift: -14 makes the root diameter -1 mm"),
    (
        {"teeth": 1, "normal_module": -1.0, "helix_angle": nan, "name": "wheel"},
        ("^wheel: teeth:", "^wheel: normal_module:", "^wheel: helix_angle:"),
    ),
)


def test_gear_refuses_a_pointed_tooth_and_says_where():
    with pytest.raises(GeometryError, match=r"pinion: the tip circle, diameter 28.0000 mm.* pointed tooth") as refused:
        gear(10, profile_shift=1.0, name="pinion")
    meets = float(str(refused.value).split("meet at diameter ")[1].split(" mm")[0])
    lower = gear(10, profile_shift=1.0, tip_diameter=meets - 1e-3)
    assert 0.0 < lower.tooth_thickness_at(lower.tip_radius) < 4e-3


# Two gears


def test_fzg_c14_geometry_as_published():
    pair = fzg_c14()
    path = pair.path_of_contact
    assert_allclose([path.T1T2, path.AB, path.AC, path.AD, path.AE], [34.93, 6.14, 9.68, 13.28, 19.43], atol=0.005)
    assert_allclose([pair.pinion.tip_radius, pair.wheel.tip_radius], [41.318, 59.272], atol=5e-4)
    assert_allclose(pair.transverse_contact_ratio, 1.46, atol=0.005)
    assert_allclose(pair.normal_force(200e3), 5912.1, atol=0.05)


def test_iso_tr_6336_30_example_1_as_published():
    pinion = CylindricalGear(17, 8.0, 100.0, helix_angle=radians(15.8), profile_shift=0.145)
    wheel = CylindricalGear(103, 8.0, 100.0, helix_angle=-radians(15.8))
    pair = CylindricalMesh(pinion, wheel, centre_distance=500.0)
    assert_allclose([2 * pinion.tip_radius, 2 * wheel.tip_radius], [159.66, 872.35], atol=0.005)
    assert_allclose(degrees(pair.working_pressure_angle), 21.066100, atol=5e-7)
    assert_allclose(pair.overlap_ratio, 1.083369, atol=5e-7)
    rounded = CylindricalMesh(replace(pinion, tip_diameter=159.66), replace(wheel, tip_diameter=872.35), 500.0)
    assert_allclose(rounded.transverse_contact_ratio, 1.549090, atol=5e-7)


def test_ross_contact_ratio_as_published():
    assert_allclose(mesh(62, 62).transverse_contact_ratio, 1.78978, atol=5e-6)


def test_crowned_spur_and_helical_pair_34_57():
    spur = mesh(34, 57, normal_module=3.0, face_width=25.0)
    assert_allclose(spur.normal_force(130e3), 2712.6, atol=0.05)
    helical = mesh(34, 57, normal_module=3.0, face_width=25.0, helix_angle=radians(15))
    assert_allclose(helical.working_centre_distance, 141.315, atol=5e-4)
    transverse = helical.normal_force(130e3) * cos(helical.pinion.base_helix_angle)
    assert_allclose(helical.base_tangential_force(130e3), transverse, rtol=ROUNDING)


@given(ordinary_meshes())
def test_swapping_the_gears_mirrors_the_path_of_contact(pair):
    path = pair.path_of_contact
    other = CylindricalMesh(pair.wheel, pair.pinion, pair.working_centre_distance)
    mirrored = other.path_of_contact
    assert_allclose(
        [mirrored.A, mirrored.B, mirrored.C, mirrored.D, mirrored.E],
        [path.T2 - point for point in (path.E, path.D, path.C, path.B, path.A)],
        rtol=0,
        atol=1e-10,  # mm; lengths of some 100 mm are subtracted: 7e-15 seen
    )
    assert_allclose(other.transverse_contact_ratio, pair.transverse_contact_ratio, rtol=ROUNDING)
    assert_allclose(other.backlash, 0.0, atol=1e-11)  # mm; tooth thicknesses of some mm cancel
    assert pair.wheel_active_profile.start_roll_length == pytest.approx(other.pinion_active_profile.start_roll_length)


@given(ordinary_meshes())
def test_profile_shift_and_centre_distance_are_inverse(pair):
    given_distance = CylindricalMesh(pair.pinion, pair.wheel, pair.working_centre_distance)
    shifts = pair.pinion.profile_shift + pair.wheel.profile_shift
    # an involute is inverted: 2e-14 seen
    assert_allclose(given_distance.profile_shift_sum_without_backlash, shifts, rtol=0, atol=1e-11)


@given(ordinary_meshes(), st.floats(1e-3, 1.0))
def test_backlash_grows_with_the_centre_distance(pair, further):
    apart = CylindricalMesh(pair.pinion, pair.wheel, pair.working_centre_distance + 0.1 * further)
    # dj/da = 2 tan(alpha_wt) to first order, more at second order
    assert apart.backlash > 2.0 * 0.1 * further * tan(pair.working_pressure_angle) * 0.99


@given(ordinary_meshes())
def test_contact_ratio_is_that_of_the_textbook(pair):
    assume(not pair.pinion_active_profile.fillet_interference and not pair.wheel_active_profile.fillet_interference)
    r1, r2, b1, b2 = (
        pair.pinion.tip_radius,
        pair.wheel.tip_radius,
        pair.pinion.base_radius,
        pair.wheel.base_radius,
    )
    line = pair.working_centre_distance * sin(acos((b1 + b2) / pair.working_centre_distance))
    expected = (sqrt(r1**2 - b1**2) + sqrt(r2**2 - b2**2) - line) / pair.pinion.base_pitch
    assert_allclose(pair.transverse_contact_ratio, expected, rtol=1e-9)
    assert pair.total_contact_ratio == pair.transverse_contact_ratio + pair.overlap_ratio


@given(ordinary_meshes(), st.floats(0.1, 10.0))
def test_lengths_scale_with_the_module(pair, factor):
    first, second = (
        replace(one, normal_module=factor * one.normal_module, face_width=factor * one.face_width)
        for one in (pair.pinion, pair.wheel)
    )
    scaled = CylindricalMesh(first, second)
    # also below: an involute is inverted, and lengths are subtracted, 1e-14 seen
    assert_allclose(scaled.path_of_contact.AE, factor * pair.path_of_contact.AE, rtol=1e-10)
    assert_allclose(scaled.pinion.form_radius, factor * pair.pinion.form_radius, rtol=FITTED)
    assert_allclose(scaled.total_contact_ratio, pair.total_contact_ratio, rtol=1e-10)


@given(ordinary_meshes())
def test_path_of_contact_agrees_with_the_active_profiles(pair):
    path, pinion, wheel = pair.path_of_contact, pair.pinion_active_profile, pair.wheel_active_profile
    assert pinion.start_roll_length == path.A
    # atol: mm, lengths of some 30 mm are subtracted
    assert_allclose(path.T2 - path.E, wheel.start_roll_length, rtol=ROUNDING, atol=1e-12)
    assert pinion.start_radius >= pair.pinion.form_radius * (1.0 - ROUNDING)
    assert pinion.end_radius == pair.pinion.tip_radius
    assert pinion.end_roll_length >= path.E * (1.0 - ROUNDING)
    assert 0.0 <= path.A < path.C < path.E <= path.T1T2
    assert_allclose(path.AD, pair.pinion.base_pitch, rtol=ROUNDING)
    assert_allclose(path.E - path.B, pair.pinion.base_pitch, rtol=ROUNDING)


def test_pitch_point_lies_on_both_working_circles():
    pair = mesh(20, 37, 0.3, 0.1)
    at_pitch = pair.pinion.radius_at_roll_length(pair.path_of_contact.C)
    assert_allclose(at_pitch, pair.pinion_working_radius, rtol=ROUNDING)
    assert_allclose(pair.pinion_working_radius + pair.wheel_working_radius, pair.working_centre_distance, rtol=ROUNDING)
    assert_allclose(pair.wheel_working_radius / pair.pinion_working_radius, pair.gear_ratio, rtol=ROUNDING)


def test_zero_shift_meshes_at_the_reference_circles():
    pair = mesh(30, 47)
    assert_allclose(pair.working_centre_distance, 77.0, rtol=ROUNDING)
    assert_allclose(pair.working_pressure_angle, radians(20), rtol=ROUNDING)


def test_spur_pair_is_the_limit_of_a_small_helix_angle():
    spur, nearly = mesh(20, 37, 0.2), mesh(20, 37, 0.2, helix_angle=1e-6)
    assert_allclose(nearly.path_of_contact.AE, spur.path_of_contact.AE, rtol=1e-9)
    assert spur.overlap_ratio == 0.0
    assert_allclose(nearly.overlap_ratio, 1e-6 * 20.0 / (2.0 * pi), rtol=1e-9)


def test_the_other_hand_changes_nothing_but_signs():
    right, left = mesh(20, 37, 0.3, helix_angle=0.3), mesh(20, 37, 0.3, helix_angle=-0.3)
    assert right.path_of_contact == left.path_of_contact
    assert right.overlap_ratio == left.overlap_ratio
    assert right.pinion.base_helix_angle == -left.pinion.base_helix_angle
    assert right.pinion.form_radius == left.pinion.form_radius


def test_common_face_width_is_the_smaller_one():
    pair = CylindricalMesh(gear(30, face_width=22.0, helix_angle=0.2), gear(30, helix_angle=-0.2))
    assert pair.common_face_width == 20.0
    assert_allclose(pair.overlap_ratio, 20.0 * sin(0.2) / (2.0 * pi), rtol=ROUNDING)


def test_overlapping_teeth_are_not_refused():
    assert mesh(30, 47, 0.2, 0.2, centre_distance=77.0).backlash < 0.0


def test_mate_tip_below_the_form_circle_shortens_the_path():
    normal = mesh(20, 100)
    long = replace(normal.wheel, tip_diameter=2.0 * normal.wheel.tip_radius + 0.8)
    pair = CylindricalMesh(normal.pinion, long, normal.working_centre_distance)
    profile = pair.pinion_active_profile
    assert profile.fillet_interference
    assert not normal.pinion_active_profile.fillet_interference
    assert_allclose(profile.start_radius, pair.pinion.form_radius, rtol=ROUNDING)
    assert profile.start_roll_length == pair.path_of_contact.A


# Pairs that cannot be


def test_mesh_refuses_gears_that_do_not_fit_and_tells_all():
    first = gear(30, helix_angle=0.2, name="pinion")
    second = gear(40, helix_angle=0.2, normal_module=3.0, pressure_angle=radians(25), name="wheel")
    with pytest.raises(InputError) as refused:
        CylindricalMesh(first, second, centre_distance=-1.0)
    assert refused.value.problems == (
        "normal_module: 2.0 and 3.0 mm must be equal",
        "pressure_angle: 20 and 25 deg must be equal",
        "helix_angle: 11.4592 and 11.4592 deg must be opposite hands of one angle",
        "centre_distance: -1.0 mm is not positive and finite",
    )


test_cylindrical_refuses = refused_calls(
    (inverse_involute, "has no angle between 0 and 90 deg", InputError, [-1e-9, inf, nan]),
    (
        lambda: gear(60, profile_shift=-4.0, tip_diameter=124.0),
        r"no thickness is left at the base circle.*increase profile_shift",
    ),
    (lambda: gear(tip_diameter=55.0), r"tip circle, diameter 55.0000 mm, lies inside the base circle"),
    (lambda: gear(tip_diameter=56.6), r"tip circle, diameter 56.6000 mm, lies inside the form circle"),
    (
        lambda: mesh(30, 47, centre_distance=70.0),
        r"centre_distance: 70 mm is not above 72.3563 mm, the sum of the base radii",
    ),
    (lambda: mesh(40, 41, -0.9, -0.9), r"for the sum -1.8 no centre distance is without backlash; give a"),
    (lambda: mesh(30, 47, centre_distance=82.0), r"pinion and wheel: no common flank at centre distance 82 mm"),
    error=GeometryError,
)


@pytest.mark.parametrize("wheel_teeth", [17, 40, 300, 10000])
def test_mesh_accepts_seventeen_teeth_with_every_wheel(wheel_teeth):
    pair = mesh(17, wheel_teeth)
    assert pair.pinion.is_undercut
    assert pair.transverse_contact_ratio > 1.5


def test_mesh_accepts_an_undercut_below_the_active_flank():
    short = gear(15, name="wheel", tip_diameter=33.0)
    pair = CylindricalMesh(gear(14, name="pinion"), short)
    assert pair.pinion.is_undercut
    assert pair.pinion_active_profile.start_radius > pair.pinion.form_radius
    assert not pair.pinion_active_profile.fillet_interference
