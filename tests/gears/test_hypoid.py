"""Pitch cones of hypoid pairs: printed numbers, closed axes, limits without an offset, what is refused."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.errors import GeometryError
from loaded_tca.gears import HypoidCones, pitch_cones_by_method_1
from loaded_tca.gears.bevel import pitch_angles
from loaded_tca.gears.hypoid import _above_root
from loaded_tca.gears.pitch_cones import limit_curvature, limit_pressure_angle
from tests.refusals import refused_calls

RIGHT = 0.5 * math.pi
CLOSED = 1e-12  # relative: a few roundings
OF_UNIT_VECTORS = 1e-12  # of some dozen products of parts up to one


def deg(*angles):
    return tuple(math.radians(angle) for angle in angles)


def annex_f3(**changes):
    """The second pair of annex F of ISO 23509:2016."""
    values = {
        "teeth": (13, 42),
        "offset": 15.0,
        "wheel_diameter": 170.0,
        "face_width": 30.0,
        "pinion_spiral_angle": math.radians(50.0),
        "cutter_radius": 63.5,
    }
    return pitch_cones_by_method_1(**(values | changes))


def annex_d():
    """The first hypoid pair of AGMA 929-B22, annex D."""
    return HypoidCones.closing(deg(16.8693, 72.3185), (127.826, 123.105), 38.1, RIGHT)


# printed to five digits behind the point; R_m and delta, which they are computed from, to fewer
@pytest.mark.parametrize(
    ("name", "printed"),
    [
        ("axial_offset_angle", math.radians(17.16989)),
        ("offset_angle", math.radians(17.96767)),
        ("offset_in_pitch_plane", 37.97546),
    ],
)
def test_offset_angles_of_annex_d_are_the_printed_ones(name, printed):
    digit = 1.5e-5 if name == "offset_in_pitch_plane" else math.radians(1.5e-5)
    assert_allclose(getattr(annex_d(), name), printed, atol=digit)


def test_radii_of_annex_d_are_the_printed_ones():
    assert_allclose(np.multiply(annex_d().radii, 2.0), [74.18752, 234.57894], atol=2e-5)


# the standard ends its iteration where rho_lim is within 1 % of r_c0, here it ends with the last digits: 0.003 %
@pytest.mark.parametrize(
    ("obtained", "printed", "tolerance"),
    [
        (lambda found: np.degrees(found.cones.pitch_angles), (21.288, 68.324), 1.5e-3),
        (lambda found: found.cones.mean_cone_distances, (73.519, 76.337), 3e-3),
        (lambda found: np.degrees(found.spiral_angles), (49.998, 38.609), 1.5e-3),
        (lambda found: np.multiply(found.cones.radii, 2.0), (53.383, 141.877), 1.5e-3),
        (lambda found: found.cones.crossing_distances, (69.727, 26.621), 1.5e-3),
        (lambda found: found.cones.apexes, (-1.225, 1.576), 3e-3),
        (lambda found: math.degrees(found.cones.axial_offset_angle), 10.603, 1.5e-3),
        (lambda found: math.degrees(found.cones.offset_angle), 11.390, 1.5e-3),
        (lambda found: found.cones.offset_in_pitch_plane, 15.075, 1.5e-3),
        (lambda found: found.face_width_factor, 0.504, 1.5e-3),
        (lambda found: math.degrees(limit_pressure_angle(found.cones, found.spiral_angles)), -2.253, 1.5e-3),
    ],
)
def test_method_1_gives_the_numbers_of_annex_f3(obtained, printed, tolerance):
    assert_allclose(obtained(annex_f3()), printed, atol=tolerance)


def test_method_1_finds_the_cones_of_annex_d_within_its_1_percent():
    found = annex_f3(
        teeth=(11, 45),
        offset=38.1,
        wheel_diameter=273.57539,
        face_width=40.64,
        pinion_spiral_angle=math.radians(30.4101 + 17.96767),
        cutter_radius=114.3,
    ).cones
    assert_allclose(np.degrees(found.pitch_angles), [16.8693, 72.3185], atol=0.01)
    assert_allclose(found.mean_cone_distances, [127.826, 123.105], rtol=4e-3)


@pytest.mark.parametrize(
    ("offset", "shaft_angle"), [(-10.0, 90.0), (5.0, 75.0), (15.0, 90.0), (15.0, 75.0), (15.0, 105.0)]
)
def test_cones_of_method_1_close_and_roll_with_the_cutter_as_limit(offset, shaft_angle):
    shaft = math.radians(shaft_angle)
    found = annex_f3(offset=offset, shaft_angle=shaft, pinion_spiral_angle=math.radians(40.0))
    cones = found.cones
    assert_allclose([cones.offset, cones.shaft_angle], [offset, shaft], rtol=CLOSED)
    assert_allclose(limit_curvature(cones, found.spiral_angles), 1.0 / 63.5, rtol=1e-9)  # brentq
    rolls = [r * math.cos(b) / z for r, b, z in zip(cones.radii, found.spiral_angles, (13, 42), strict=True)]
    assert_allclose(rolls[0], rolls[1], rtol=CLOSED)
    assert_allclose(cones.rolling_spiral_angles((13, 42)), found.spiral_angles, rtol=1e-9)


cones = st.builds(
    HypoidCones,
    st.tuples(st.floats(0.1, 0.8), st.floats(0.6, 1.4)),
    st.tuples(st.floats(40.0, 200.0), st.floats(40.0, 200.0)),
    st.floats(-0.6, 0.6).filter(lambda zeta: abs(zeta) > 1e-3),
)


@given(cones, st.sampled_from([1, -1]))
def test_pitch_cones_touch_in_the_pitch_plane_at_p(pair, hand):
    frame = pair.frame(hand)
    assert_allclose(frame.axes @ frame.axes.T, np.eye(3), rtol=0, atol=OF_UNIT_VECTORS)
    assert_allclose(np.linalg.det(frame.axes), 1.0)
    (first, second), (own, other) = pair.pitch_angles, pair.mean_cone_distances
    point = own * np.array([math.sin(first), 0.0, math.cos(first)])
    on_wheel = frame.axes @ (point - frame.origin)
    assert_allclose(on_wheel, [other * math.sin(second), 0.0, other * math.cos(second)], atol=1e-11 * other)
    normal = np.array([math.cos(first), 0.0, -math.sin(first)])
    assert_allclose(-(frame.axes @ normal), [math.cos(second), 0.0, -math.sin(second)], atol=OF_UNIT_VECTORS)
    # a tooth of the pinion's hand and one of the wheel's lie on each other there
    spiral = 0.3
    around = np.array([0.0, 1.0, 0.0])
    tooth = math.cos(spiral + pair.offset_angle) * point / own + hand * math.sin(spiral + pair.offset_angle) * around
    on_cone = np.array([math.sin(second), 0.0, math.cos(second)])
    mating = math.cos(spiral) * on_cone - hand * math.sin(spiral) * around
    assert_allclose(frame.axes @ tooth, mating, atol=OF_UNIT_VECTORS)


@given(cones)
def test_common_normal_stands_across_both_axes_at_the_offset(pair):
    frame = pair.frame(1)
    assert_allclose(frame.axes[2] @ frame.common_normal, 0.0, atol=OF_UNIT_VECTORS)
    assert frame.common_normal[2] == 0.0
    pinion, wheel = frame.crossing_points
    assert_allclose(wheel - pinion, -pair.offset * frame.common_normal, atol=1e-9)
    assert_allclose(pinion[:2], 0.0)
    assert_allclose(np.cross(wheel - frame.origin, frame.axes[2]), 0.0, atol=1e-9)
    # formulas 129 to 131 of ISO 23509
    (first, second), turn = pair.pitch_angles, pair.shaft_angle - RIGHT
    diameters, zeta = np.multiply(pair.radii, 2.0), pair.axial_offset_angle
    reach = diameters[1] + diameters[0] * math.cos(second) / math.cos(first)
    wheel_way = 0.5 * diameters[0] * math.sin(second) / math.cos(first) - 0.5 * math.cos(zeta) * math.tan(turn) * reach
    pinion_way = 0.5 * diameters[1] * math.cos(zeta) * math.cos(turn) - wheel_way * math.sin(turn)
    assert_allclose(pair.crossing_distances, [pinion_way, wheel_way], rtol=1e-8, atol=1e-8)


@given(cones)
def test_closing_finds_the_cones_that_offset_and_shaft_angle_came_from(pair):
    angles = pair.pitch_angles[0] + 1e-4, pair.pitch_angles[1]
    found = HypoidCones.closing(angles, pair.mean_cone_distances, pair.offset, pair.shaft_angle)
    assert_allclose(found.pitch_angles, pair.pitch_angles, rtol=1e-7)
    assert_allclose(found.offset_angle, pair.offset_angle, rtol=1e-6)


def test_without_an_offset_the_frame_is_that_of_axes_that_meet():
    angles = pitch_angles((13, 42), math.radians(80.0))
    frame = HypoidCones(angles, (75.0, 75.0), 0.0).frame(1)
    sine, cosine = math.sin(math.radians(80.0)), math.cos(math.radians(80.0))
    expected = [[-cosine, 0.0, sine], [0.0, -1.0, 0.0], [sine, 0.0, cosine]]
    assert_allclose(frame.axes, expected, rtol=0, atol=OF_UNIT_VECTORS)
    assert_allclose(frame.origin, 0.0, atol=75.0 * OF_UNIT_VECTORS)
    assert_allclose(frame.common_normal, [0.0, 1.0, 0.0], rtol=0, atol=OF_UNIT_VECTORS)


def test_opposite_hands_are_mirror_images():
    right, left = (annex_d().frame(hand) for hand in (1, -1))
    mirror = np.array([1.0, -1.0, 1.0])
    # the same operations with the signs turned, to the bit
    assert_array_equal(left.origin, right.origin * mirror)
    assert_array_equal(left.axes[[0, 2]], right.axes[[0, 2]] * mirror)


test_cones_refuse = refused_calls(
    (lambda: replace(annex_d(), pitch_angles=(0.3, 4.0)), "wheel_pitch_angle: 4 rad is not between 0 and 3.142"),
    (lambda: replace(annex_d(), mean_cone_distances=(0.0, 1.0)), "mean_cone_distances: 0.0 mm is not positive"),
    (lambda: replace(annex_d(), offset_angle=1.6), "offset_angle: 1.6 rad is not within 1.571 rad"),
    (
        lambda: HypoidCones.closing(deg(16.8693, 72.3185), (127.826, 123.105), 150.0, RIGHT),
        "offset: 150 mm is too large for these pitch cones; allowed below 1",
    ),
    (
        lambda: HypoidCones.closing(deg(16.8693, 120.0), (127.826, 123.105), 38.1, RIGHT),
        "pitch_angles: with a wheel of 2.0944 rad no pinion closes on an offset of 38.1 mm",
    ),
    (
        lambda: HypoidCones.closing(deg(100.0, 72.3185), (127.826, 123.105), 38.1, RIGHT),
        "pitch_angles: no pinion of 1.74533 rad stands beside a wheel of 1.2622 rad",
    ),
    (lambda: annex_f3(offset=0.0), "offset: 0.0 mm; without an offset cones follow from the teeth"),
    (lambda: annex_f3(offset=90.0), "offset: 90 mm is too large for a wheel of 170 mm; allowed below"),
    (lambda: annex_f3(face_width=-1.0, cutter_radius=math.inf), ("^face_width: -1", "^cutter_radius: inf")),
    (lambda: annex_f3(pinion_spiral_angle=1.2), "pinion_spiral_angle: 1.2 rad is not within"),
    (lambda: annex_f3(cutter_radius=8.0), "no pitch cones of method 1", GeometryError),
)


def test_points_above_a_root_cone_are_as_far_as_the_parabola_through_them():
    """A row whose distance from the cone is least, 0.3 mm, between two of its points."""
    blank = SimpleNamespace(root_angle=math.radians(70.0), root_apex=1.5, cone_distances=(20.0, 40.0))
    place = np.linspace(-1.0, 1.0, 9)
    along, height = 30.0 + 2.0 * place, 0.3 + 0.5 * (place - 0.07) ** 2
    sine, cosine = math.sin(blank.root_angle), math.cos(blank.root_angle)
    rho, z = along * sine + height * cosine, along * cosine - height * sine - blank.root_apex
    assert_allclose(_above_root(np.stack([rho, 0.0 * rho, z], axis=-1)[None], blank), 0.3, rtol=1e-9)
