"""Two gears in space: where the mounting errors put the wheel, the sides that touch, and what is refused."""

import contextlib
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca import trace_contact
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.material import Material
from loaded_tca.pairs.cylindrical import Mounting, cylindrical_pair
from loaded_tca.pairs.gear_pair import cylindrical_basis
from tests.refusals import refused_calls
from tests.samples.gear_pairs import cylindrical_mesh, gear_pair

ROUNDING = 1e-12  # of products of rotations and a few factors: 4e-16 seen
DISTANCE = 136.5  # mm, the pair 34/57 of module 3

angles = st.floats(-0.05, 0.05)
errors = st.floats(-3.0, 3.0)
mountings = st.builds(Mounting, angles, angles, errors, errors)
points = st.tuples(st.floats(20.0, 160.0), st.floats(-50.0, 50.0), st.floats(-30.0, 30.0))


def axis_point(mounting, z=10.0):
    """Where a point of the wheel's axis, z above its mid-face, goes."""
    origin, axes = mounting.place_parallel(DISTANCE)
    return origin + z * axes[2]


def test_wheel_frame_without_errors_faces_the_pinion():
    origin, axes = Mounting().place_parallel(DISTANCE)
    assert_allclose(origin, [DISTANCE, 0.0, 0.0])
    assert_allclose(axes, np.diag([-1.0, -1.0, 1.0]))


@given(mountings)
def test_wheel_axes_stay_orthonormal_and_right_handed(mounting):
    _, axes = mounting.place_parallel(DISTANCE)
    assert_allclose(axes @ axes.T, np.eye(3), atol=ROUNDING)
    assert_allclose(np.linalg.det(axes), 1.0, rtol=ROUNDING)


def test_positive_in_plane_error_takes_the_wheel_axis_away_from_the_pinion_at_positive_z():
    gamma = 0.01
    expected = [DISTANCE + 10.0 * math.sin(gamma), 0.0, 10.0 * math.cos(gamma)]
    assert_allclose(axis_point(Mounting(in_plane=gamma)), expected, rtol=ROUNDING)


def test_positive_out_of_plane_error_takes_the_wheel_axis_towards_negative_y_at_positive_z():
    delta = 0.01
    expected = [DISTANCE, -10.0 * math.sin(delta), 10.0 * math.cos(delta)]
    assert_allclose(axis_point(Mounting(out_of_plane=delta)), expected, rtol=ROUNDING)


def test_both_angular_errors_are_a_turn_about_x_and_then_about_y_of_the_fixed_frame():
    gamma, delta = 0.3, 0.2  # large, to see the order
    _, axes = Mounting(gamma, delta).place_parallel(DISTANCE)
    about_x = [0.0, -math.sin(delta), math.cos(delta)]
    turned = [
        math.cos(gamma) * about_x[0] + math.sin(gamma) * about_x[2],
        about_x[1],
        -math.sin(gamma) * about_x[0] + math.cos(gamma) * about_x[2],
    ]
    assert_allclose(axes[2], turned, rtol=ROUNDING)


def test_angular_errors_leave_the_mid_face_point_of_the_wheel_where_it_is():
    assert_allclose(axis_point(Mounting(0.01, 0.02), z=0.0), [DISTANCE, 0.0, 0.0])


def test_centre_distance_error_moves_the_wheel_apart_and_axial_offset_towards_positive_z():
    mounting = Mounting(centre_distance_error=0.5, axial_offset=2.0)
    assert_allclose(axis_point(mounting, z=0.0), [DISTANCE + 0.5, 0.0, 2.0])


@given(mountings, points)
def test_wheel_coordinates_give_the_point_back(mounting, point):
    pair = gear_pair(mounting=mounting)
    rho, theta, z = pair.to_wheel(np.array(point))
    radial, _, axial = pair.wheel_basis(theta)
    assert_allclose(pair.wheel_origin + rho * radial + z * axial, point, rtol=0, atol=1e-10)  # mm: 2e-14 seen


@given(mountings, points)
def test_wheel_basis_is_the_gradient_of_the_wheel_coordinates(mounting, point):
    pair, step = gear_pair(mounting=mounting), 1e-4
    rho, theta, _ = pair.to_wheel(np.array(point))
    basis = pair.wheel_basis(theta)
    for k, direction in enumerate(np.eye(3)):
        ahead, behind = (pair.to_wheel(np.array(point) + sign * step * direction) for sign in (1, -1))
        change = [(after - before) / (2.0 * step) for after, before in zip(ahead, behind, strict=True)]
        change[1] = math.remainder(ahead[1] - behind[1], math.tau) / (2.0 * step) * rho
        assert_allclose(change, basis[:, k], atol=1e-7)  # step^2/rho^2 and rounding/step


def test_cylindrical_basis_is_orthonormal_for_any_shape_of_angles():
    basis = cylindrical_basis(np.linspace(-4.0, 4.0, 6).reshape(2, 3))
    assert basis.shape == (2, 3, 3, 3)
    assert_allclose(basis @ np.swapaxes(basis, -1, -2), np.broadcast_to(np.eye(3), basis.shape), atol=ROUNDING)


@pytest.mark.parametrize(
    ("driving", "sense", "side"),
    [("pinion", "positive", 1), ("wheel", "positive", -1), ("pinion", "negative", -1), ("wheel", "negative", 1)],
)
def test_touching_flanks_are_those_that_push(driving, sense, side):
    pair = gear_pair(driving=driving, sense=sense)
    assert pair.pinion.flank.side == pair.wheel.flank.side == side


def test_pair_knows_its_ratio_pitch_and_sizes():
    pair = gear_pair(helix_deg=15.0)
    mesh = cylindrical_mesh(helix_deg=15.0)
    assert_allclose([pair.ratio, pair.pitch], [34 / 57, 2.0 * math.pi / 34])
    assert_allclose(pair.base_radii, [mesh.pinion.base_radius, mesh.wheel.base_radius])
    assert (pair.module, pair.face_width) == (3.0, 25.0)


def test_pair_has_the_materials_and_the_lower_cap_of_the_two():
    mesh = cylindrical_mesh()
    steel, bronze = Material(max_pressure=4000.0), Material(110000.0, 0.34, max_pressure=900.0)
    pair = cylindrical_pair(mesh, materials=(steel, bronze))
    expected = 1.0 / (0.91 / 206000.0 + (1.0 - 0.34**2) / 110000.0)
    assert_allclose(pair.contact_modulus, expected, rtol=ROUNDING)
    assert pair.max_pressure == 900.0
    assert cylindrical_pair(mesh, materials=(steel, Material())).max_pressure == 4000.0
    assert cylindrical_pair(mesh).max_pressure is None


@pytest.mark.parametrize("deg", [45.0, -45.1, 90.0, 180.0, -360.0])
@pytest.mark.parametrize("name", ["in_plane", "out_of_plane"])
def test_angular_error_that_turns_the_wheel_away_is_refused(name, deg):
    with pytest.raises(InputError, match=rf"^{name}: .* {deg:g} deg, is not between -45 and 45 deg: the axes are"):
        Mounting(**{name: math.radians(deg)})
    with pytest.raises(InputError) as caught:
        Mounting(math.pi, -math.pi)
    assert len(caught.value.problems) == 2


@given(st.floats(-44.9, 44.9), st.floats(-44.9, 44.9))
@settings(max_examples=10)
def test_angular_errors_within_the_bounds_give_a_path_or_say_that_nothing_touches(gamma_deg, delta_deg):
    pair = gear_pair(mounting=Mounting(math.radians(gamma_deg), math.radians(delta_deg)))
    with contextlib.suppress(GeometryError):
        assert trace_contact(pair, [0.0], warn=False).in_contact.all()


test_gear_pair_refuses = refused_calls(
    (lambda: gear_pair(driving="motor"), "driving: 'motor' is not 'pinion' or 'wheel'"),
    (lambda: gear_pair(sense="left"), "sense: 'left' is not 'positive' or 'negative'"),
    (lambda value: Mounting(axial_offset=value), r"axial_offset: .* mm is not finite", [None, "x", [0.1], 1j]),
    (
        lambda: Mounting(in_plane=math.nan, axial_offset=math.inf),
        ("^in_plane: nan rad is not finite$", "^axial_offset: inf mm is not finite$"),
    ),
    (
        lambda: gear_pair(teeth=(14, 62), module=1.0, helix_deg=20.0, width=300.0),
        r"pinion: its teeth wind .* times around the gear .* 300 mm",
        GeometryError,
    ),
)


@pytest.mark.parametrize("offset", [24.998, 25.0, -25.0, 25.002])
def test_faces_with_next_to_nothing_in_common_are_refused(offset):
    told = (
        rf"^axial_offset: {offset:g} mm leaves no common flank: .* at least 0.003 mm, 0.001 normal modules, are needed"
    )
    with pytest.raises(GeometryError, match=told):
        gear_pair(mounting=Mounting(axial_offset=offset))


@pytest.mark.parametrize("offset", [24.996, -24.996])
def test_faces_with_a_little_in_common_touch_there(offset):
    contact = trace_contact(gear_pair(mounting=Mounting(axial_offset=offset)), [0.0])[0]
    assert abs(contact.pinion_axial - 0.5 * offset) < 0.003
