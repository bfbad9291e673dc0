"""Hypoid pairs: placement, mounting errors, base radii, offset zero, what is refused."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.errors import GeometryError
from loaded_tca.gears import HypoidCones
from loaded_tca.pairs import MeanContact, local_synthesis, mean_contact
from loaded_tca.pairs.bevel import BevelMounting, face_milled_pair
from loaded_tca.unloaded import trace_contact
from tests.refusals import refused_calls
from tests.samples.face_milled import matched_pinion, published_wheel
from tests.samples.hypoid import annex_f3_cones, hypoid_gears, hypoid_pair

RIGHT = 0.5 * math.pi
ROUNDING = 1e-12  # mm, rad or parts of a unit vector; lengths of 100 mm, some dozen operations


def frame_of(hand):
    return annex_f3_cones().cones.frame(hand)


def test_wheel_stands_on_the_frame_of_its_pitch_cones():
    pair, frame = hypoid_pair(), frame_of(-1)
    assert_allclose(pair.wheel_origin, frame.origin, rtol=0, atol=ROUNDING)
    assert_allclose(pair.wheel_axes, frame.axes, rtol=0, atol=ROUNDING)


def test_axes_have_the_offset_and_cross_at_right_angles():
    pair = hypoid_pair()
    normal = np.cross([0.0, 0.0, 1.0], pair.wheel_axes[2])
    assert_allclose(np.linalg.norm(normal), 1.0)
    assert_allclose(pair.wheel_origin @ normal, 15.0)  # left-hand pinion: the wheel's axis on the side of +y


def test_base_radii_have_the_ratio_of_the_teeth_as_levers_have():
    pair = hypoid_pair()
    assert_allclose(pair.base_radii[0] / pair.base_radii[1], 13 / 42, rtol=ROUNDING)
    contact = trace_contact(pair, [0.0])[0]
    assert_allclose(contact.pinion_lever / contact.wheel_lever, 13 / 42, rtol=1e-7)
    # ISO 23509, F.3: d_m1/2 and the normal through P of spiral 49.998, pressure 17.747 deg
    lever = 26.6920 * math.cos(math.radians(49.998)) * math.cos(math.radians(17.747))
    assert_allclose(contact.pinion_lever, lever, rtol=1e-4)


def test_module_is_the_mean_normal_one_of_the_blank():
    assert_allclose(hypoid_pair().module, 2.640, atol=1e-3)


def test_mirrored_pair_has_the_same_transmission_error():
    angles = np.array([-0.1, 0.0, 0.1])
    left, right = (trace_contact(hypoid_pair(hand), angles) for hand in ("left", "right"))
    assert_allclose(left.transmission_error, right.transmission_error, rtol=0, atol=ROUNDING)
    assert_allclose(left.point, right.point * [1.0, -1.0, 1.0], atol=1e-9)


ERRORS = {"offset": 0.03, "pinion_axial": 0.05, "wheel_axial": -0.04, "shaft_angle_error": 3e-4}


@pytest.mark.parametrize(("name", "size"), ERRORS.items())
def test_mounting_errors_move_the_wheel_about_the_common_normal(name, size):
    frame = frame_of(-1)
    nominal, moved = hypoid_pair(), hypoid_pair(mounting=BevelMounting(**{name: size}))
    pinion_point, wheel_point = frame.crossing_points
    shift = moved.wheel_origin - nominal.wheel_origin
    if name != "shaft_angle_error":
        way = {"offset": frame.common_normal, "pinion_axial": [0.0, 0.0, -1.0], "wheel_axial": frame.axes[2]}[name]
        assert_allclose(shift, size * np.array(way), rtol=0, atol=ROUNDING)
        assert_array_equal(moved.wheel_axes, nominal.wheel_axes)
        return
    assert_allclose(moved.wheel_axes[2, 2], math.cos(RIGHT + size), rtol=0, atol=ROUNDING)
    assert_allclose(moved.wheel_axes[2] @ frame.common_normal, 0.0, atol=ROUNDING)
    # the crossing point of the wheel's axis stays
    along = (wheel_point - moved.wheel_origin) @ moved.wheel_axes[2]
    assert_allclose(moved.wheel_origin + along * moved.wheel_axes[2], wheel_point, rtol=0, atol=ROUNDING)
    assert pinion_point[2] != 0.0


def test_offset_error_is_a_larger_offset_of_a_left_hand_pinion():
    """E of the housing and the offset of the same gears in it: one displacement of the wheel's axis."""
    moved = hypoid_pair(mounting=BevelMounting(offset=0.02))
    normal = np.cross([0.0, 0.0, 1.0], moved.wheel_axes[2])
    assert_allclose(moved.wheel_origin @ normal, 15.02)


def test_offset_zero_is_the_pair_of_axes_that_meet_to_the_bit():
    gears = matched_pinion(), published_wheel()
    mounting = BevelMounting(0.01, -0.02, 0.03, 1e-4)
    plain, zero = (face_milled_pair(*gears, mounting=mounting, **options) for options in ({}, {"offset": 0.0}))
    assert_array_equal(plain.wheel_origin, zero.wheel_origin)
    assert_array_equal(plain.wheel_axes, zero.wheel_axes)
    assert (plain.base_radii, plain.module, plain.face_width) == (zero.base_radii, zero.module, zero.face_width)
    angles = np.array([-0.1, 0.1])
    assert_array_equal(*(trace_contact(pair, angles).transmission_error for pair in (plain, zero)))


def test_small_offset_tends_to_axes_that_meet():
    """The placement of cones that close on less and less offset is that of axes that meet."""
    gears = matched_pinion(), published_wheel()
    shaft = sum(gear.blank.pitch_angle for gear in gears)
    frames = BevelMounting(0.01, -0.02, 0.03, 1e-4).place(shaft)
    cones = [gear.blank.pitch_angle for gear in gears], gears[0].blank.mean_cone_distance
    near = HypoidCones.closing((cones[0][0], cones[0][1]), (cones[1], cones[1]), 1e-7, shaft)
    origin, axes = BevelMounting(0.01, -0.02, 0.03, 1e-4).place_with_offset(near.frame(1))
    assert_allclose(origin, frames[0], atol=1e-5)
    assert_allclose(axes, frames[1], atol=1e-7)


PLACE = (frame_of(-1).origin, frame_of(-1).axes)


@pytest.mark.parametrize("flank", ["concave", "convex"])
def test_motion_curve_at_the_mean_point_is_that_of_the_traced_contact(flank):
    """The parabola of second derivatives of both flanks, in the frame of the offset, beside transmission errors."""
    fall = mean_contact(*hypoid_gears(), flank, PLACE).motion_fall
    pair, part = hypoid_pair(pinion_flank=flank, exact=True), 0.01
    before, top, after = trace_contact(pair, np.array([-part, 0.0, part]) * pair.pitch).transmission_error
    # the coast side touches a few hundredths of a millimetre beside P
    tolerance = 1e-4 if flank == "concave" else 0.05
    assert_allclose((2.0 * top - before - after) / (8.0 * part**2), fall, rtol=tolerance)


@pytest.mark.thorough
def test_local_synthesis_goes_on_from_a_synthesised_pinion():
    pinion, wheel = hypoid_gears()
    aim = MeanContact(math.radians(12.0 / 3600.0), math.radians(120.0), 8.0)
    found = mean_contact(local_synthesis(pinion, wheel, aim, place=PLACE), wheel, "concave", PLACE)
    assert_allclose(found.motion_fall, aim.motion_fall, rtol=1e-6)
    assert_allclose([found.path_angle, found.contact_length], [aim.path_angle, aim.contact_length], rtol=1e-6)


test_hypoid_pair_refuses = refused_calls(
    (
        lambda: face_milled_pair(*hypoid_gears(), offset=-15.0),
        r"^offset: -15 mm; the flanks have spiral angles of 50 and 38\.61 deg at P; with a negative offset the "
        "pinion has the smaller spiral angle: change the sign",
    ),
    (
        lambda: face_milled_pair(*hypoid_gears(), offset=14.0),
        r"^pitch_angle: the axes close on an offset of 14 mm and a shaft angle of 1\.5708 rad",
    ),
    (lambda: face_milled_pair(*hypoid_gears(), offset=200.0), "^offset: 200 mm is too large for these pitch cones"),
    (
        lambda: face_milled_pair(hypoid_gears()[0], replace(hypoid_gears()[1], teeth=43), offset=15.0),
        "half the normal modules there, .* differ by more than 1%: the flanks do not roll on each other",
        GeometryError,
    ),
    (
        lambda: face_milled_pair(
            hypoid_gears()[0],
            replace(hypoid_gears()[1], blank=replace(hypoid_gears()[1].blank, hand="left")),
            offset=15.0,
        ),
        "^hand: pinion and wheel are both left-hand",
    ),
)
