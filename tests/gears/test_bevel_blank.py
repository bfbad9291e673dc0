"""Blanks of bevel gear pairs: cones, tapers, apexes, thicknesses; what is refused."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError
from loaded_tca.gears import BevelBlank, bevel_mesh
from loaded_tca.gears.blank_factors import crown_gear_factors
from tests.refusals import refusals, refused_calls

ROUNDING = 1e-11  # of some dozen operations, one after another
TAPERS = ["standard", "uniform", "duplex", "modified"]


def blank(**changes):
    usual = {
        "teeth": (19, 62),
        "outer_module": 4.169,
        "face_width": 36.83,
        "shaft_angle": math.radians(95.0),
        "spiral_angle": math.radians(35.0),
        "cutter_radius": 95.25,
        "profile_shift": 0.05,
    }
    return BevelBlank(**(usual | changes))


def line_in_axial_plane(gear, axis, across, cone):
    """A point and the unit direction of a face or root cone in the plane of the two axes."""
    angle, apex = (gear.face_angle, gear.face_apex) if cone == "face" else (gear.root_angle, gear.root_apex)
    return -apex * axis, math.cos(angle) * axis + math.sin(angle) * across


def cones_in_axial_plane(pair):
    """(pinion line, wheel line) for (face, root) and (root, face), with the axes from the crossing point."""
    axis = np.array([math.sin(pair.shaft_angle), math.cos(pair.shaft_angle)])
    wheel = axis, np.array([-axis[1], axis[0]])
    pinion = np.array([0.0, 1.0]), np.array([1.0, 0.0])
    for own, other in (("face", "root"), ("root", "face")):
        yield (
            line_in_axial_plane(pair.pinion, *pinion, own),
            line_in_axial_plane(pair.wheel, *wheel, other),
        )


@given(st.integers(12, 40), st.integers(12, 70), st.floats(0.5, 2.2), st.sampled_from(TAPERS))
def test_face_cones_are_parallel_to_the_root_cones_of_the_mating_gear(first, second, shaft_angle, taper):
    pair = blank(
        teeth=(first, second),
        shaft_angle=shaft_angle,
        face_width=5.0,
        taper=taper,
        profile_shift=0.0,
        cutter_radius=500.0,
        allow_undercut=True,
    )
    assert_allclose(pair.pinion.face_angle + pair.wheel.root_angle, shaft_angle, rtol=ROUNDING)
    assert_allclose(pair.wheel.face_angle + pair.pinion.root_angle, shaft_angle, rtol=ROUNDING)


@pytest.mark.parametrize("taper", TAPERS)
def test_clearance_between_tip_and_root_is_the_same_along_the_face(taper):
    pair = blank(taper=taper)
    for (own, along), (other, parallel) in cones_in_axial_plane(pair):
        assert_allclose(abs(along @ parallel), 1.0, rtol=ROUNDING)
        gap = np.linalg.norm((own - other) - ((own - other) @ parallel) * parallel)
        assert_allclose(gap, pair.clearance, rtol=1e-9)


@pytest.mark.parametrize("taper", TAPERS)
def test_apexes_of_the_cones_agree_with_the_depths_at_mid_face(taper):
    """Wheel exactly; pinion to c (1 - cos theta), below 2e-3 clearances here."""
    pair = blank(taper=taper)
    for gear, allowed in ((pair.wheel, 1e-12), (pair.pinion, 2e-3 * pair.clearance)):  # mm; of lengths of 100 mm
        for angle, apex, height in (
            (gear.face_angle, gear.face_apex, gear.mean_addendum),
            (gear.root_angle, gear.root_apex, -gear.mean_dedendum),
        ):
            sine, cosine = math.sin(gear.pitch_angle), math.cos(gear.pitch_angle)
            mean = pair.mean_cone_distance
            axial, radius = mean * cosine - height * sine, mean * sine + height * cosine
            off_cone = radius * math.cos(angle) - (axial + apex) * math.sin(angle)
            assert_allclose(off_cone, 0.0, atol=allowed)


def test_root_cones_of_standard_taper_pass_through_the_pitch_apex():
    pair = blank(taper="standard")
    assert_allclose(pair.wheel.root_apex, 0.0, atol=1e-12)  # mm; of 100 mm: 1e-15 seen
    assert_allclose(math.tan(pair.pinion.dedendum_angle), pair.pinion.mean_dedendum / pair.mean_cone_distance)


def test_depth_of_uniform_taper_is_the_same_along_the_face():
    pair = blank(taper="uniform")
    for gear in (pair.pinion, pair.wheel):
        assert gear.face_angle == gear.pitch_angle == gear.root_angle
        assert gear.addenda.tolist() == [gear.mean_addendum] * 3
        assert gear.dedenda.tolist() == [gear.mean_dedendum] * 3


def slot_growth(pair):
    """Growth of both slots together from toe to heel."""
    toe, _, heel = np.add(pair.pinion.slot_widths, pair.wheel.slot_widths)
    return heel - toe


def test_slots_of_duplex_taper_have_one_width_of_the_tool():
    """Many teeth, so that angle and tangent agree; a narrow face, as the taper fits the middle."""
    pair = blank(teeth=(50, 160), face_width=10.0, taper="duplex", cutter_radius=600.0)
    even = replace(pair, taper="uniform")
    assert abs(slot_growth(pair)) < 2e-3 * slot_growth(even)


def test_share_of_the_duplex_taper_is_the_addendum_of_the_mating_gear():
    pair = blank(taper="duplex", profile_shift=0.3)
    first, second = pair.dedendum_angles
    assert_allclose(first + second, pair.constant_slot_taper, rtol=ROUNDING)
    assert_allclose(first / second, pair.wheel.mean_addendum / pair.pinion.mean_addendum, rtol=ROUNDING)


def test_modified_taper_is_at_most_1_3_times_the_standard_one():
    flat, steep = blank(cutter_radius=95.25), blank(cutter_radius=2000.0)
    assert sum(steep.dedendum_angles) < steep.constant_slot_taper
    assert_allclose(sum(replace(steep, taper="modified").dedendum_angles), 1.3 * sum(steep.dedendum_angles))
    assert_allclose(sum(replace(flat, taper="modified").dedendum_angles), flat.constant_slot_taper)


def test_wheel_angles_given_replace_those_of_the_taper():
    pair = blank(wheel_angles=(0.03, 0.05), taper="duplex", cutter_radius=None)
    assert (pair.wheel.addendum_angle, pair.wheel.dedendum_angle) == (0.03, 0.05)
    assert (pair.pinion.dedendum_angle, pair.pinion.addendum_angle) == (0.03, 0.05)


@pytest.mark.parametrize("place", [0, 1, 2])
def test_spiral_angle_is_that_of_the_cutter_circle(place):
    """Circle of the cutter in the plane of the crown gear: its tangent against the ray from the apex."""
    pair = blank()
    mean, radius, spiral = pair.mean_cone_distance, pair.cutter_radius, pair.spiral_angle
    centre = np.array([mean - radius * math.sin(spiral), radius * math.cos(spiral)])
    distance, machine = pair.cone_distances[place], np.linalg.norm(centre)
    turn = math.acos((distance**2 + machine**2 - radius**2) / (2.0 * distance * machine))
    direction = math.atan2(centre[1], centre[0]) - turn
    ray = np.array([math.cos(direction), math.sin(direction)])
    spoke = distance * ray - centre
    tangent = np.array([-spoke[1], spoke[0]]) / radius
    assert_allclose(math.acos(abs(ray @ tangent)), pair.pinion.spiral_angles[place], rtol=1e-9)


def test_spiral_angle_without_a_cutter_is_the_same_along_the_face():
    assert_allclose(blank(cutter_radius=None).pinion.spiral_angles, math.radians(35.0), rtol=ROUNDING)


def test_teeth_without_backlash_fill_the_normal_pitch():
    pair = blank(thickness_modification=0.06, profile_shift=0.2)
    both = np.add(pair.pinion.normal_thicknesses, pair.wheel.normal_thicknesses)
    assert_allclose(both, pair.pinion.normal_pitches, rtol=ROUNDING)
    assert_allclose(pair.pinion.normal_pitches, pair.wheel.normal_pitches, rtol=ROUNDING)


def test_backlash_is_the_gap_left_at_the_heel_normal_to_the_flanks():
    pair = blank(thickness_modification=0.06, outer_normal_backlash=0.1)
    gap = pair.pinion.normal_pitches[2] - pair.pinion.normal_thicknesses[2] - pair.wheel.normal_thicknesses[2]
    assert_allclose(gap * math.cos(pair.pressure_angle), 0.1, rtol=1e-9)


def test_thickness_modification_moves_thickness_from_wheel_to_pinion():
    plain, changed = blank(), blank(thickness_modification=0.04)
    moved = 2.0 * 0.04 * plain.mean_normal_module
    assert_allclose(changed.pinion.mean_normal_thickness - plain.pinion.mean_normal_thickness, moved, rtol=1e-9)
    assert_allclose(plain.wheel.mean_normal_thickness - changed.wheel.mean_normal_thickness, moved, rtol=1e-9)


def test_cone_distances_and_modules_are_those_of_the_bevel_mesh():
    pair = blank(cutter_radius=None)
    gear = bevel_mesh((19, 62), 4.169, 36.83, shaft_angle=pair.shaft_angle, spiral_angle=pair.spiral_angle).pinion
    assert_allclose(
        pair.cone_distances,
        (gear.inner_cone_distance, gear.mean_cone_distance, gear.outer_cone_distance),
        rtol=ROUNDING,
    )
    assert_allclose(pair.mean_normal_module, gear.mean_normal_module, rtol=ROUNDING)


@given(st.floats(0.1, 50.0))
def test_lengths_scale_with_the_module(factor):
    one = blank()
    other = blank(outer_module=4.169 * factor, face_width=36.83 * factor, cutter_radius=95.25 * factor)
    for name in ("addenda", "dedenda", "tip_diameters", "crown_to_crossing", "tip_thicknesses", "slot_widths"):
        assert_allclose(getattr(other.pinion, name), factor * np.array(getattr(one.pinion, name)), rtol=1e-9)
    assert_allclose(other.pinion.smallest_profile_shift, one.pinion.smallest_profile_shift, rtol=1e-9)


def test_depths_add_up_to_the_whole_depth():
    pair = blank(profile_shift=0.3)
    for gear in (pair.pinion, pair.wheel):
        assert_allclose(gear.mean_addendum + gear.mean_dedendum, pair.whole_depth, rtol=ROUNDING)
    assert_allclose(pair.pinion.mean_addendum + pair.wheel.mean_addendum, pair.working_depth, rtol=ROUNDING)
    assert_allclose(pair.working_depth + pair.clearance, pair.whole_depth, rtol=ROUNDING)


def test_crown_gear_factors_give_the_depths_that_they_are_defined_by():
    pair = blank(**crown_gear_factors(0.3, depth=1.9, clearance=0.15, thickness=0.1))
    assert_allclose(pair.wheel.mean_addendum, 0.3 * pair.working_depth, rtol=ROUNDING)
    assert_allclose(pair.working_depth, 1.9 * pair.mean_normal_module, rtol=ROUNDING)
    assert_allclose(pair.clearance, 0.15 * pair.working_depth, rtol=ROUNDING)
    assert_allclose(pair.thickness_modification, 0.05, rtol=ROUNDING)


def test_wheel_diameter_given_is_the_outer_pitch_diameter():
    pair = BevelBlank.from_wheel_diameter((14, 39), 176.893, 25.4, profile_shift=0.5)
    assert_allclose(pair.wheel.pitch_diameters[2], 176.893, rtol=ROUNDING)


test_values_out_of_range_are_refused = refusals(
    lambda changes: blank(**changes),
    ({"teeth": (2, 62)}, "teeth: 2 is not a whole number from 3 on"),
    ({"teeth": (19, math.nan)}, "teeth: nan is not a whole number"),
    ({"outer_module": -1.0}, "outer_module: -1.0 is not positive and finite"),
    ({"face_width": math.inf}, "face_width: inf is not positive and finite"),
    ({"cutter_radius": 0.0}, "cutter_radius: 0.0 is not positive and finite"),
    ({"shaft_angle": 3.2}, r"shaft_angle: 3.2 rad is not between 0 and 3.142 rad \(180 deg\)"),
    ({"pressure_angle": 0.0}, "pressure_angle: 0 rad is not between"),
    ({"spiral_angle": -0.1}, "spiral_angle: -0.1 rad is not from 0 to below"),
    ({"profile_shift": math.nan}, "profile_shift: nan is not finite"),
    ({"thickness_modification": math.inf}, "thickness_modification: inf is not finite"),
    ({"outer_normal_backlash": -0.1}, "outer_normal_backlash: -0.1 mm is negative"),
    ({"wheel_angles": (0.9, 0.1)}, r"wheel_angles: \(0.9, 0.1\) rad are not within 0.785 rad"),
    ({"dedendum_factor": 0.9}, "dedendum_factor: 0.9 is not above addendum_factor 1.0"),
    ({"taper": "double"}, "taper: 'double' is not one of standard, uniform, duplex, modified"),
    ({"taper": "duplex", "cutter_radius": None}, "cutter_radius: None mm; a duplex taper needs at least"),
    ({"taper": "modified", "cutter_radius": 60.0}, r"needs at least R_m sin\(beta_m\) = 65.3409 mm"),
)


test_bevel_blank_refuses = refused_calls(
    (lambda: BevelBlank.from_wheel_diameter((14, 0), 176.893, 25.4), "teeth: 0 is not a whole number from 3 on"),
    (
        lambda: blank(teeth=(2, 2.5), outer_module=0.0, spiral_angle=2.0),
        ("^teeth:", "^teeth:", "^outer_module:", "^spiral_angle:"),
    ),
)


test_blanks_that_cannot_exist_are_refused_with_the_place = refusals(
    lambda changes: blank(**changes),
    ({"face_width": 140.0}, "face_width 140 mm reaches the apex: no face is left at the toe"),
    ({"cutter_radius": 33.0}, "does not cross the cone distance 132.3333 mm at the heel"),
    ({"wheel_angles": (0.31, 0.1)}, "pinion: root angle -0.3470 deg and face angle .* must lie between 0 and 180"),
    ({"profile_shift": 1.2}, "pinion: no dedendum is left .* at the mean point|wheel: no addendum is left"),
    ({"wheel_angles": (0.02, 0.25)}, r"pinion: no addendum is left \(-1.61.. mm\) at the toe"),
    ({"wheel_angles": (0.25, 0.02)}, r"pinion: no dedendum is left \(-1.1... mm\) at the toe"),
    ({"thickness_modification": -0.5}, r"pinion: pointed tooth: no tip is left \(-.* mm\) at the heel"),
    ({"thickness_modification": 0.6}, r"pinion: the slot closes above its root: no width is left \(-.* mm\)"),
    (
        {"teeth": (6, 62)},
        "pinion: undercut with a profile shift x_hm of 0.0500; with these cones the least is 0.[0-9]{4}",
    ),
    error=GeometryError,
)


def test_undercut_is_accepted_on_demand():
    pair = blank(teeth=(6, 62), allow_undercut=True)
    assert pair.pinion.is_undercut
    assert not pair.wheel.is_undercut


def test_profile_shift_named_by_the_refusal_is_enough():
    """Without taper; with one the limit moves a little with the shift, through the cones."""
    refused = blank(teeth=(11, 62), face_width=10.0, spiral_angle=0.0, taper="uniform", allow_undercut=True)
    needed = refused.pinion.smallest_profile_shift
    assert refused.pinion.is_undercut
    assert not replace(refused, profile_shift=needed + 1e-9, allow_undercut=False).pinion.is_undercut


def test_least_profile_shift_of_straight_teeth_is_that_of_their_virtual_gear_at_the_toe():
    """ISO 23509: a blade 1.1 times as deep as the addendum stays above the foot of the line of action there."""
    pair = blank(
        teeth=(11, 62), face_width=10.0, spiral_angle=0.0, cutter_radius=None, taper="uniform", allow_undercut=True
    )
    radius = pair.pinion.cone_distances[0] * math.tan(pair.pitch_angles[0])
    room = radius * math.sin(pair.pressure_angle) ** 2 / pair.mean_normal_module
    assert_allclose(pair.pinion.smallest_profile_shift, 1.1 * pair.addendum_factor - room, rtol=1e-9)
