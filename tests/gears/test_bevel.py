"""Cones, cone distances, active profiles of bevel gears; what is refused."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.gears import BevelGear, BevelMesh, bevel_mesh
from loaded_tca.gears.bevel import pitch_angles
from tests.refusals import refusals, refused_calls

ROUNDING = 1e-12  # of some dozen operations
PRINTED = 6e-5  # deg: four decimals


def gear(**changes):
    return BevelGear(**({"teeth": 20, "outer_module": 4.0, "face_width": 20.0, "pitch_angle": 0.6} | changes))


@given(st.integers(5, 80), st.integers(5, 80), st.floats(0.3, 2.8))
def test_pitch_cones_roll_on_each_other(first, second, shaft_angle):
    pinion, wheel = pitch_angles((first, second), shaft_angle)
    assert_allclose(pinion + wheel, shaft_angle, rtol=ROUNDING)
    assert_allclose(math.sin(pinion) * second, math.sin(wheel) * first, rtol=ROUNDING)


def test_cones_of_the_straight_pair_39_32():
    """Corrected cones of the pair 39/32: pitch, base and face angles to the printed digits."""
    mesh = bevel_mesh((39, 32), outer_module=5.0, face_width=20.0)
    found = [(g.pitch_angle, g.base_angle, g.tip_angle, g.root_cone_angle) for g in (mesh.pinion, mesh.wheel)]
    expected = [[50.6307, 46.5897, 52.901, 47.794], [39.3693, 36.5884, 41.640, 36.532]]
    for row, printed in zip(found, expected, strict=True):
        assert_allclose([math.degrees(a) for a in row[:2]], printed[:2], atol=PRINTED)
        assert_allclose([math.degrees(a) for a in row[2:]], printed[2:], atol=6e-4)


def test_cone_distances_of_a_pair():
    pinion = bevel_mesh((20, 40), outer_module=4.0, face_width=20.0).pinion
    outer = 40.0 / math.sin(math.atan(0.5))
    found = pinion.outer_cone_distance, pinion.mean_cone_distance, pinion.inner_cone_distance
    assert_allclose(found, [outer, outer - 10.0, outer - 20.0], rtol=ROUNDING)
    assert_allclose(pinion.mean_normal_module, 4.0 * (outer - 10.0) / outer, rtol=ROUNDING)


def test_angles_given_replace_the_standard_ones():
    assert (gear(face_angle=0.65).tip_angle, gear(root_angle=0.57).root_cone_angle) == (0.65, 0.57)


def test_form_cone_is_never_below_the_base_cone():
    slim = gear(teeth=12)
    assert slim.root_cone_angle < slim.base_angle == slim.form_angle
    assert gear(teeth=60).form_angle == gear(teeth=60).root_cone_angle


@given(st.floats(0.0, 1.5))
def test_unwound_arc_and_cone_angle_are_inverse(arc):
    one = gear()
    assert_allclose(one.unwound_arc(one.cone_angle_at_arc(arc)), arc, atol=1e-7)  # square root at the base cone


@given(st.floats(0.01, 3.1))
def test_diameter_and_cone_angle_are_inverse_beyond_ninety_degrees_too(angle):
    one = gear()
    assert_allclose(one.cone_angle_at_diameter(one.diameter_at(angle)), angle, atol=1e-7)  # flat at 90 deg


def test_thickness_falls_towards_the_tip_from_half_a_pitch_on_the_pitch_cone():
    one = gear()
    assert_allclose(one.half_thickness_angle_at(one.pitch_angle), math.pi / 40.0, rtol=ROUNDING)
    assert 0.0 < one.half_thickness_angle_at(one.tip_angle) < math.pi / 40.0


def test_active_profile_starts_where_the_tip_of_the_mate_ends():
    mesh = bevel_mesh((30, 45), outer_module=4.0, face_width=20.0)
    arc = mesh.pinion.unwound_arc(mesh.active_cones[0][0]) + mesh.wheel.unwound_arc(mesh.wheel.tip_angle)
    whole = sum(g.unwound_arc(g.pitch_angle) for g in (mesh.pinion, mesh.wheel))
    assert_allclose(arc, whole, rtol=ROUNDING)
    assert mesh.active_cones[0][1] == mesh.pinion.tip_angle


def test_overlap_ratio_of_a_spiral_pair():
    mesh = bevel_mesh((20, 40), outer_module=4.0, face_width=20.0, spiral_angle=math.radians(35.0))
    outer, inner = mesh.pinion.outer_cone_distance, mesh.pinion.inner_cone_distance
    turn = math.tan(math.radians(35.0)) / math.sin(mesh.pinion.pitch_angle) * math.log(outer / inner)
    assert_allclose(mesh.overlap_ratio, turn / (2.0 * math.pi / 20), rtol=ROUNDING)


@pytest.mark.parametrize("teeth", [8, 17, 40])
def test_smallest_profile_shift_of_a_slender_cone_is_that_of_a_spur_gear(teeth):
    """Pitch angle towards zero: 1.1 - z sin^2(alpha)/2."""
    slender = gear(teeth=teeth, pitch_angle=1e-3)
    assert_allclose(slender.smallest_profile_shift, 1.1 - 0.5 * teeth * math.sin(math.radians(20)) ** 2, rtol=1e-5)


def test_undercut_ends_at_the_smallest_profile_shift():
    few = gear(teeth=8)
    assert few.is_undercut
    assert not gear(teeth=8, profile_shift=few.smallest_profile_shift + 1e-9).is_undercut


@pytest.mark.parametrize("pitch_angle", [math.pi / 2, 1.8])
def test_tool_of_a_crown_gear_may_be_as_deep_as_the_pressure_angle(pitch_angle):
    crown = gear(pitch_angle=pitch_angle)
    depth = (1.1 - crown.smallest_profile_shift) * crown.outer_module
    assert_allclose(depth, math.tan(crown.pressure_angle) * crown.outer_cone_distance, rtol=ROUNDING)


def test_fillet_interference_tells_a_tip_below_the_form_cone():
    assert bevel_mesh((39, 32), 5.0, 20.0).fillet_interference == (False, False)
    assert bevel_mesh((14, 39), 5.0, 20.0).fillet_interference == (True, False)
    assert bevel_mesh((39, 14), 5.0, 20.0).fillet_interference == (False, True)


def test_fillet_interference_ends_where_the_tip_of_the_mate_reaches_the_form_cone():
    mesh = bevel_mesh((14, 39), 5.0, 20.0)
    pinion, wheel = mesh.pinion, mesh.wheel
    whole = sum(one.unwound_arc(one.pitch_angle) for one in (pinion, wheel))
    longest = wheel.cone_angle_at_arc(whole - pinion.unwound_arc(pinion.form_angle))
    for step, interferes in ((-1e-9, False), (1e-9, True)):
        changed = BevelMesh(pinion, replace(wheel, face_angle=longest + step))
        assert changed.fillet_interference == (interferes, False)


test_values_out_of_range_are_refused = refusals(
    lambda changes: gear(**changes),
    ({"teeth": 2}, "teeth: 2 is not a whole number from 3 on"),
    ({"outer_module": 0.0}, "outer_module: 0.0 is not positive"),
    ({"face_width": 0.0039}, "face_width: 0.0039 mm is below 0.001 outer_module, 0.004 mm"),
    ({"face_width": math.inf}, "face_width: inf is not positive and finite"),
    ({"pitch_angle": 3.2}, "pitch_angle: 3.2 rad is not between"),
    ({"pressure_angle": 0.9}, "pressure_angle: 0.9 rad is not between"),
    ({"spiral_angle": 1.1}, "spiral_angle: 1.1 rad is not within"),
    ({"profile_shift": math.nan}, "profile_shift: nan is not finite"),
    ({"root_angle": 0.61}, "root cone, 34.9504 deg, is not below the pitch cone, 34.3775 deg"),
    ({"face_angle": 0.59}, "face cone, 33.8045 deg, is not above the pitch cone"),
)


test_teeth_that_cannot_exist_are_refused = refusals(
    lambda changes: gear(**changes),
    ({"face_width": 80.0}, "face_width 80 mm reaches the apex: no face width is left at the toe"),
    (
        {"teeth": 3, "profile_shift": -1.5, "face_angle": 0.65, "face_width": 4.0},
        "the root cone, .* deg, reaches the axis",
    ),
    ({"face_angle": 0.9}, "cannot be reached: pointed tooth"),
    ({"face_angle": 2.7}, "beyond the end of the spherical involute"),
    error=GeometryError,
)


def test_gears_that_do_not_fit_are_refused_with_every_reason():
    good = bevel_mesh((20, 40), outer_module=4.0, face_width=20.0, spiral_angle=0.5)
    other = replace(good.wheel, outer_module=5.0, face_width=21.0, pressure_angle=0.4, spiral_angle=0.5)
    with pytest.raises(InputError) as caught:
        BevelMesh(good.pinion, other)
    keys = [problem.split(":")[0] for problem in caught.value.problems]
    assert keys == ["outer_module", "face_width", "pressure_angle", "spiral_angle", "pitch_angle"]


test_bevel_refuses = refused_calls(
    (lambda: gear().cone_angle_at_diameter(1000.0), r"a diameter of 1000 mm is not between 0 and"),
    (
        lambda shaft_angle: bevel_mesh((20, 40), 4.0, 20.0, shaft_angle=shaft_angle),
        r"shaft_angle: .* rad is not between",
        [0.0, 3.2],
    ),
    (lambda: gear(teeth=0, outer_module=-1.0, name="pinion"), ("^pinion: teeth:", "^pinion: outer_module:")),
    (lambda: BevelMesh(*(2 * [gear(pitch_angle=1.6)])), r"the shaft angle, 183.3465 deg, is not below 180 deg"),
)
