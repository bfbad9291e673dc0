"""Basic machine settings from the blank: the published pair, the geometry behind the closed forms, blade groups."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.flanks import GeneratedFlank
from loaded_tca.gears import BevelBlank
from loaded_tca.gears.basic_settings import cutter_number, duplex_spread_blade, point_width, spread_blade

ROUNDING = 1e-12  # of some dozen sines and products
PRINTED = 5e-10  # half a unit of the last printed digit, nine after the point


def published():
    return BevelBlank(
        (19, 62),
        4.169,
        36.83,
        shaft_angle=math.radians(95.0),
        spiral_angle=math.radians(35.0),
        cutter_radius=95.25,
        profile_shift=0.05,
        thickness_modification=0.0649,
        outer_normal_backlash=0.1,
    )


def blank(teeth=(20, 30), **changes):
    usual = {"face_width": 20.0, "spiral_angle": math.radians(35.0), "cutter_radius": 80.0, "allow_undercut": True}
    return BevelBlank(teeth, 5.0, **(usual | changes))


any_blank = st.builds(
    blank,
    st.tuples(st.integers(15, 30), st.integers(30, 60)),
    spiral_angle=st.floats(0.0, 0.7),
    shaft_angle=st.floats(1.0, 1.9),
    cutter_radius=st.floats(150.0, 300.0),
    taper=st.sampled_from(["standard", "uniform", "duplex"]),
)


@pytest.mark.parametrize(
    ("member", "radial", "cradle_angle", "root_angle", "ratio_of_roll"),
    [
        (0, 97.959402908, 52.796746783, 15.640967271, 3.339685915),
        (1, 97.953678147, 52.801158062, 75.663828096, 1.023367029),
    ],
)
def test_basic_settings_are_the_published_ones_to_every_printed_digit(
    member, radial, cradle_angle, root_angle, ratio_of_roll
):
    machine = spread_blade(published())[member].machine
    assert_allclose(machine.radial, radial, rtol=0, atol=PRINTED)
    assert_allclose(math.degrees(machine.cradle_angle), cradle_angle, rtol=0, atol=PRINTED)
    assert_allclose(math.degrees(machine.root_angle), root_angle, rtol=0, atol=PRINTED)
    assert_allclose(machine.ratio_of_roll, ratio_of_roll, rtol=0, atol=PRINTED)


def test_root_line_lies_where_the_published_machine_centre_to_back_puts_it():
    machine = spread_blade(published())[0].machine
    assert_allclose(machine.sliding_base / math.sin(machine.root_angle), -0.001306, rtol=0, atol=5e-7)


@given(any_blank)
def test_blade_tips_touch_the_root_line_all_along_the_face(pair):
    """Root cone line, seen on the machine: its height above the plane of the blade tips is zero at toe and heel."""
    for gear, settings in zip((pair.pinion, pair.wheel), spread_blade(pair), strict=True):
        machine = settings.machine
        for diameter, axial in zip(gear.root_diameters, gear.pitch_diameters, strict=True):
            rho = 0.5 * diameter
            z = rho / math.tan(gear.root_angle) - gear.root_apex
            height = -rho * math.cos(machine.root_angle) + z * math.sin(machine.root_angle) + machine.sliding_base
            assert_allclose(height, 0.0, rtol=0, atol=1e-10 * axial)


@given(any_blank)
def test_cutter_passes_through_the_mean_point_under_the_spiral_angle(pair):
    """The circle r_c0 about (S_r, q) holds (R_m cos theta_f, 0) and crosses the root line there under beta_m."""
    for gear, settings in zip((pair.pinion, pair.wheel), spread_blade(pair), strict=True):
        machine = settings.machine
        x = gear.cone_distances[1] * math.cos(gear.dedendum_angle) - machine.radial * math.cos(machine.cradle_angle)
        y = -machine.radial * math.sin(machine.cradle_angle)
        assert_allclose(math.hypot(x, y), pair.cutter_radius, rtol=ROUNDING)
        assert_allclose(math.atan2(x, -y), pair.spiral_angle, rtol=ROUNDING, atol=ROUNDING)


@given(any_blank)
def test_gear_rolls_on_its_pitch_cone_without_sliding(pair):
    """The axis of the motion of blank against cradle is inclined to the root plane by the dedendum angle."""
    for gear, settings in zip((pair.pinion, pair.wheel), spread_blade(pair), strict=True):
        machine = settings.machine
        axis = math.cos(machine.root_angle), 1.0 / machine.ratio_of_roll - math.sin(machine.root_angle)
        assert_allclose(math.atan2(axis[1], axis[0]), gear.dedendum_angle, rtol=0, atol=ROUNDING)


def test_untapered_tooth_needs_no_blade_group_and_rolls_by_its_pitch_angle():
    pair = blank(taper="uniform")
    assert cutter_number(pair) == 0.0
    for gear, settings in zip((pair.pinion, pair.wheel), duplex_spread_blade(pair), strict=True):
        assert_allclose(settings.machine.ratio_of_roll, 1.0 / math.sin(gear.pitch_angle), rtol=ROUNDING)
        assert settings.cutter.number == 0.0
    assert_allclose(*(settings.machine.radial for settings in spread_blade(pair)), rtol=ROUNDING)


def test_cutter_number_of_duplex_paper_is_its_blade_group():
    """Its printed root angles and the spiral angle 35 deg that they belong to give the printed group 11."""
    pitch = math.degrees(math.atan2(20, 30)), math.degrees(math.atan2(30, 20))
    angles = math.radians(pitch[0] - 31.09059), math.radians(pitch[1] - 52.51677)
    number = cutter_number(blank(wheel_angles=angles))
    assert_allclose(number, 11.0, rtol=0, atol=0.01)


def test_duplex_blades_are_turned_by_ten_minutes_a_number():
    settings = duplex_spread_blade(blank(), number=11)[1]
    minutes = [60.0 * math.degrees(settings.cutter.blade(flank).blade_angle) for flank in ("concave", "convex")]
    assert_allclose(minutes, [18 * 60 + 10, 21 * 60 + 50], rtol=ROUNDING)


def test_duplex_number_is_rounded_to_a_half():
    pair = blank()
    number = duplex_spread_blade(pair)[0].cutter.number
    assert number == duplex_spread_blade(pair)[1].cutter.number
    assert abs(number - cutter_number(pair)) <= 0.25
    assert 2.0 * number == round(2.0 * number)


def test_spread_blades_have_the_pressure_angle_and_stand_apart_by_the_slot():
    pair = blank(profile_shift=0.1)
    for gear, settings in zip((pair.pinion, pair.wheel), spread_blade(pair, edge_radius=0.4), strict=True):
        outside, inside = (settings.cutter.blade(flank) for flank in ("concave", "convex"))
        assert outside.blade_angle == inside.blade_angle == gear.pressure_angle
        assert outside.edge_radius == inside.edge_radius == 0.4
        # radii of some 100 mm are subtracted: 6e-15 seen
        assert_allclose(outside.point_radius - inside.point_radius, point_width(gear), rtol=1e-10)
        assert_allclose(outside.point_radius + inside.point_radius, 2.0 * pair.cutter_radius, rtol=ROUNDING)


@pytest.mark.parametrize("cutter_radius", [50.0, 60.0, 80.0])
@pytest.mark.parametrize("flank", ["concave", "convex"])
def test_duplex_settings_of_a_duplex_blank_match_on_both_flanks(cutter_radius, flank):
    """Spiral angles by the taper; pressure angles but for the rounding of the number, a quarter of 10' on each gear."""
    gears = duplex_spread_blade(blank(cutter_radius=cutter_radius, taper="duplex"), edge_radius=0.5)
    side = gears[0].side(flank)
    pinion, wheel = (GeneratedFlank(gear, gear.flank_name(side)).angles for gear in gears)
    assert_allclose(abs(pinion.spiral), abs(wheel.spiral), rtol=0, atol=math.radians(0.01))
    assert_allclose(pinion.pressure, wheel.pressure, rtol=0, atol=math.radians(5.1 / 60.0))


@pytest.mark.parametrize("flank", ["concave", "convex"])
def test_spread_blade_pressure_angles_miss_by_the_tilt_of_the_root_planes(flank):
    """(theta_f1 + theta_f2) sin(beta_m), to first order in the tilt: what the blade group takes away."""
    pair = blank(taper="duplex")
    gears = spread_blade(pair)
    side = gears[0].side(flank)
    pinion, wheel = (GeneratedFlank(gear, gear.flank_name(side)).angles for gear in gears)
    expected = sum(pair.dedendum_angles) * math.sin(pair.spiral_angle)
    assert_allclose(abs(pinion.pressure - wheel.pressure), expected, rtol=0.03)


def test_settings_grow_with_the_gear():
    small, large = (
        BevelBlank((20, 30), 5.0 * k, 20.0 * k, spiral_angle=0.6, cutter_radius=80.0 * k) for k in (1.0, 3.0)
    )
    for one, other in zip(spread_blade(small), spread_blade(large), strict=True):
        assert_allclose(other.machine.radial, 3.0 * one.machine.radial, rtol=ROUNDING)
        assert_allclose(other.machine.cradle_angle, one.machine.cradle_angle, rtol=ROUNDING)
        assert_allclose(other.machine.ratio_of_roll, one.machine.ratio_of_roll, rtol=ROUNDING)


def test_hands_are_opposite_and_change_nothing_else():
    left, right = spread_blade(blank()), spread_blade(blank(), pinion_hand="right")
    assert [settings.blank.hand for settings in (*left, *right)] == ["left", "right", "right", "left"]
    for one, other in zip(left, right, strict=True):
        assert one.machine == other.machine
        assert one.cutter == other.cutter
        assert replace(one.blank, hand="right") == replace(other.blank, hand="right")


def test_missing_cutter_and_unknown_hand_are_told_together():
    with pytest.raises(InputError) as caught:
        spread_blade(blank(cutter_radius=None), pinion_hand="both")
    assert [problem.split(":")[0] for problem in caught.value.problems] == ["cutter_radius", "pinion_hand"]
