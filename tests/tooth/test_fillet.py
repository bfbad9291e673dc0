import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.tooth import ArcFillet, RackFillet
from loaded_tca.tooth.fillet import profile_of
from tests.samples.teeth import CROWNED, MESHES, NONE, RELIEVED, flanks_of, form_of

TANGENT = 1e-9
"""Angle between tangents that counts as none [rad]."""
SMOOTH = [name for name in MESHES if name != "undercut"]


def drawn(name, modifications=NONE, fillet_radius=None, count=33, side=0, member=0):
    """Profile, radii of the root circles and fillets of a gear."""
    form = form_of(MESHES[name], member, fillet_radius)
    flank = flanks_of(MESHES[name], member, modifications)[side]
    profile = profile_of(flank, form.sections, form.half_thickness_angle, (17, 5))
    root = form.root_radius(profile.coordinate)
    return profile, root, form.fillet.curve(profile, root, count)


def angle_between(first, second):
    return np.abs(np.arctan2(first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0], (first * second).sum(-1)))


@pytest.mark.parametrize("modifications", [NONE, CROWNED, RELIEVED], ids=["unmodified", "crowned", "relieved"])
@pytest.mark.parametrize("name", SMOOTH)
@pytest.mark.parametrize("side", [0, 1])
def test_fillet_is_tangent_to_flank_and_root(name, modifications, side):
    profile, root, curve = drawn(name, modifications, side=side)
    point, tangent = profile.point_and_tangent(curve.start)
    assert_allclose(curve.points[0], point, atol=1e-12)  # mm; beside rtol
    assert angle_between(curve.tangents[0], tangent).max() < TANGENT
    end = curve.points[-1]
    assert_allclose(np.linalg.norm(end, axis=-1), root, rtol=1e-13)  # the root of three squares: 3e-16 seen
    around = np.stack([-end[:, 1], end[:, 0]], axis=-1)
    assert angle_between(curve.tangents[-1], around).max() < TANGENT


@pytest.mark.parametrize("name", MESHES)
def test_tangents_are_those_of_the_points(name):
    """Central differences over uneven steps, of second order: four times closer on half the steps, exact on arcs."""
    errors = []
    for count in (65, 129):
        _, _, curve = drawn(name, CROWNED, count=count)
        before, after = np.diff(curve.points, axis=0)[:-1], np.diff(curve.points, axis=0)[1:]
        lengths = [np.linalg.norm(step, axis=-1, keepdims=True) for step in (before, after)]
        slope = before / lengths[0] * lengths[1] + after / lengths[1] * lengths[0]
        errors.append(angle_between(slope, curve.tangents[1:-1])[2:-2].mean())
    assert errors[1] < max(0.35 * errors[0], 1e-12)  # exact on arcs but for rounding: 8e-14 seen
    assert errors[1] < 1e-3


def test_undercut_leaves_a_corner():
    profile, _, curve = drawn("undercut")
    _, tangent = profile.point_and_tangent(curve.start)
    assert angle_between(curve.tangents[0], tangent).min() > math.radians(5.0)


@pytest.mark.parametrize("name", ["straight bevel", "spiral bevel", "spur"])
def test_arc_has_one_radius_on_its_section(name):
    """On the sphere all points of the arc have one angular distance from its centre; in the plane one distance."""
    wanted = 0.2 if name == "spiral bevel" else 0.5
    form = form_of(MESHES[name], fillet_radius=wanted)
    profile, _, curve = drawn(name, fillet_radius=wanted, count=40)
    middle = len(profile.coordinate) // 2
    on_arc = curve.points[-12:, middle]
    rho, z = form.sections.point(np.linalg.norm(on_arc, axis=-1), profile.coordinate[middle])
    azimuth = np.arctan2(on_arc[:, 1], on_arc[:, 0])
    points = np.stack([rho * np.cos(azimuth), rho * np.sin(azimuth), z], axis=-1)
    first = points[0]  # the circle through three points of space
    a, b = points[6] - first, points[-1] - first
    across = np.cross(a, b)
    centre = first + ((b @ b) * np.cross(across, a) + (a @ a) * np.cross(b, across)) / (2.0 * across @ across)
    flat = np.linalg.norm(points - centre, axis=1)
    assert_allclose(flat, flat[0], rtol=1e-9)
    on_sphere = form.fillet.coordinate is not None
    expected = profile.coordinate[middle] * math.sin(wanted / profile.coordinate[middle]) if on_sphere else wanted
    assert_allclose(flat[0], expected, rtol=1e-9)


def test_small_arc_below_the_base_cone_is_reached_by_a_straight_piece():
    """An arc far smaller than the depth below the base cone: the fillet starts where the flank ends."""
    profile, _, small = drawn("spiral bevel", fillet_radius=0.02)
    height = profile.radius[-1] - profile.radius[0]
    assert_allclose(small.start, profile.radius[0] + 0.01 * height, rtol=1e-12)  # the same sum
    turned = angle_between(small.tangents[0], small.tangents[8])
    assert turned.max() < 1e-12  # rad; none seen


def test_rack_fillet_touches_the_rolling_rack():
    """Rolling with the gear, the rounding of the rack's tip comes to each point of the fillet, and no nearer."""
    gear = MESHES["spur"].pinion
    _, _, curve = drawn("spur", count=21)
    points = curve.points[:, 0]
    turn = np.linspace(-0.6, 0.6, 400001)
    depth = gear.rack_form_depth - gear.normal_module * gear.profile_shift
    depth -= gear.rack_tip_radius * math.sin(gear.pressure_angle)
    beside = math.pi / 4.0 * gear.normal_module - gear.rack_form_depth * math.tan(gear.pressure_angle)
    beside -= gear.rack_tip_radius * math.cos(gear.pressure_angle)
    across = math.pi / gear.teeth  # the middle of the space lies at half a pitch
    for x, y in points:
        radius, angle = math.hypot(x, y), across - math.atan2(y, x)
        along, above = radius * np.sin(angle + turn), radius * np.cos(angle + turn)
        distance = np.hypot(along - beside - gear.reference_radius * turn, above - gear.reference_radius + depth)
        assert_allclose(distance.min(), gear.rack_tip_radius, atol=1e-9)  # parabola between two angles


def test_fillet_of_a_modified_flank_turns_with_its_root_edge():
    """Lead crowning moves the whole section: the fillet of the rack keeps its form."""
    _, _, plain = drawn("spur")
    _, _, crowned = drawn("spur", type(CROWNED)(lead_crowning=0.05))
    shapes = [np.linalg.norm(curve.points - curve.points[:1], axis=-1) for curve in (plain, crowned)]
    assert_allclose(shapes[1], shapes[0], atol=1e-12)  # mm; beside rtol
    turn = [np.arctan2(curve.points[0, :, 1], curve.points[0, :, 0]) for curve in (plain, crowned)]
    gear = MESHES["spur"].pinion
    assert_allclose((turn[0] - turn[1])[[0, -1]], 0.05 / gear.base_radius, rtol=1e-9)
    assert_allclose((turn[0] - turn[1])[2], 0.0, atol=1e-15)  # along the axis nothing turns


@pytest.mark.parametrize("radius", [0.0, -1.0, math.inf, math.nan])
def test_arc_without_a_length_is_refused(radius):
    with pytest.raises(InputError, match=r"fillet_radius: .* is not positive and finite"):
        ArcFillet(radius)


def test_arc_beyond_the_tip_is_refused():
    with pytest.raises(GeometryError, match="reaches the tip"):
        drawn("spur", fillet_radius=40.0)


def test_cylindrical_gears_get_the_fillet_of_their_rack_unless_an_arc_is_asked_for():
    mesh = MESHES["spur"]
    assert form_of(mesh, 1).fillet == RackFillet(mesh.wheel)
    assert form_of(mesh, 1, 0.7).fillet == ArcFillet(0.7)
