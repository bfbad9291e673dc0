"""A pinion inside a ring: working circles, path of contact, the three interferences against brute force."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError
from loaded_tca.gears import CylindricalGear, InternalMesh, RingGear
from loaded_tca.gears.internal_mesh import internal_interferences
from tests.refusals import refused_calls
from tests.samples.internal_pairs import internal_mesh

ROUNDING = 1e-11  # of involutes that are inverted, and of lengths of 100 mm that are subtracted


def spur(teeth, height=1.0, distance=None):
    """Pair of module 3 without profile shift, both addenda of a height in modules."""
    pinion = CylindricalGear(teeth[0], 3.0, 25.0, tip_diameter=3.0 * teeth[0] + 6.0 * height)
    ring = RingGear(-teeth[1], 3.0, 25.0, tip_diameter=3.0 * teeth[1] - 6.0 * height)
    return InternalMesh(pinion, ring, distance)


def test_pair_without_shifts_works_at_the_reference_circles():
    mesh = spur((25, 60))
    assert_allclose(mesh.working_centre_distance, 52.5)
    assert_allclose(mesh.working_pressure_angle, math.radians(20), rtol=ROUNDING)
    assert_allclose([mesh.pinion_working_radius, mesh.wheel_working_radius], [37.5, 90.0])
    assert_allclose(mesh.backlash, 0.0, atol=ROUNDING)
    assert_allclose(mesh.gear_ratio, 2.4)


@given(st.floats(-0.3, 0.5), st.floats(-0.3, 0.2), st.floats(0.0, 0.4))
def test_centre_distance_without_backlash_and_the_sum_of_shifts_belong_together(first, second, helix):
    mesh = internal_mesh(shifts=(first, second), helix_deg=math.degrees(helix))
    assert_allclose(mesh.profile_shift_sum_without_backlash, first + second, atol=1e-9)
    assert_allclose(mesh.backlash, 0.0, atol=1e-9)
    assert mesh.backlash_at(mesh.working_centre_distance - 0.1) > 0.0  # a ring nearer to its pinion's axis has room


def test_points_of_the_path_lie_on_both_gears():
    """A on the tip circle of the ring, E on that of the pinion, seen from the axis of each."""
    mesh = internal_mesh(shifts=(0.2, 0.1))
    path, angle, distance = mesh.path_of_contact, mesh.working_pressure_angle, mesh.working_centre_distance
    tangent = np.array([math.cos(-angle), math.sin(-angle)]) * mesh.pinion.base_radius
    along = np.array([math.sin(angle), math.cos(angle)])
    start, end, pitch = (tangent + length * along for length in (path.A, path.E, path.C))
    assert_allclose(np.hypot(start[0] + distance, start[1]), mesh.ring.tip_radius, rtol=ROUNDING)
    assert_allclose(np.hypot(*end), mesh.pinion.tip_radius, rtol=ROUNDING)
    assert_allclose(pitch, [mesh.pinion_working_radius, 0.0], atol=1e-9)
    assert_allclose(path.T2, -distance * math.sin(angle), rtol=ROUNDING)
    assert_allclose(mesh.transverse_contact_ratio, (path.E - path.A) / mesh.pinion.base_pitch)
    assert path.A < path.B < path.D < path.E  # between B and D one pair alone touches
    assert_allclose([path.E - path.B, path.D - path.A], mesh.pinion.base_pitch)  # as another one begins or ends


def test_active_profile_of_the_ring_starts_at_the_larger_diameter():
    profile = internal_mesh().wheel_active_profile
    assert profile.start_radius > profile.end_radius
    assert profile.start_roll_length > profile.end_roll_length


@pytest.mark.parametrize(("height", "clear"), [(1.0, False), (0.7, True)])
def test_overlap_of_the_tips_is_that_of_brute_force(height, clear):
    """Teeth 30/38 turned until the pinion's tip corner crosses the ring's tip circle: the ring's must be ahead."""
    mesh = spur((30, 38), height)
    pinion, ring = mesh.pinion, mesh.ring
    turns = np.linspace(0.05, 1.2, 11501)
    first = turns - _lag(pinion.base_radius, pinion.tip_radius, mesh.pinion_working_radius)
    second = turns * 30 / 38 - _lag(ring.base_radius, ring.tip_radius, mesh.wheel_working_radius)
    x, y = pinion.tip_radius * np.cos(first) + mesh.working_centre_distance, pinion.tip_radius * np.sin(first)
    crossing = np.abs(np.hypot(x, y) - ring.tip_radius).argmin()
    ahead = ring.tip_radius * (second - np.arctan2(y, x))[crossing]
    assert_allclose(ahead, mesh.overlap_clearance, atol=0.005)  # mm; a step turns the pinion by 0.005 mm
    assert (mesh.overlap_clearance > 0.0) is clear


def _lag(base, tip, working):
    """How far the tip corner of a flank stands behind its point on the working circle."""
    angles = np.arccos(base / np.array([tip, working]))
    return float(np.diff(angles - np.tan(angles))[0])


def test_tip_circles_that_do_not_cross_are_free():
    assert spur((20, 80), 0.1).overlap_clearance > 0.0


@pytest.mark.parametrize(("teeth", "possible"), [((25, 60), True), ((60, 70), False)])
def test_radial_assembly(teeth, possible):
    """A difference of ten teeth needs assembly along the axis, although the running mesh is free."""
    mesh = spur(teeth, 0.8)
    assert (mesh.radial_assembly_clearance >= 0.0) is possible
    assert mesh.overlap_clearance > 0.0


@pytest.mark.parametrize(("turn", "clear"), [(0.0, False), (0.5, True)])
def test_radial_assembly_of_a_pinion_that_fits_in_one_of_two_places(turn, clear):
    """Points of all flanks of 20 teeth, in the spaces of 32: with a space towards the ring alone they stay within."""
    mesh = spur((20, 32), 0.8)
    pinion, ring = mesh.pinion, mesh.ring
    radius = np.linspace(pinion.form_radius, pinion.tip_radius, 40)
    half = np.array([0.5 * pinion.tooth_thickness_at(one) / one for one in radius])
    angle = 2.0 * np.pi / 20 * (np.arange(20)[:, None] + turn) + half
    pitch, worst = 2.0 * np.pi / 32, math.inf
    for distance in np.linspace(0.0, mesh.working_centre_distance, 120):
        x, y = distance + radius * np.cos(angle), radius * np.sin(angle)
        reach, place = np.hypot(x, y), np.arctan2(y, x) / pitch - turn
        within = (reach > ring.tip_radius) & (reach < ring.form_radius)
        beside = pitch * (place - np.round(place))[within]
        room = [ring.space_angle_at(one) for one in reach[within]]
        worst = min(worst, np.min(reach[within] * (room - np.abs(beside)), initial=math.inf))
    assert bool(worst > -1e-9) is clear  # in mesh the flanks touch
    assert mesh.radial_assembly_clearance >= 0.0


def _shadow(mesh, turn, points=61):
    """Least room, along the ring's tip circle, of flanks of module 3 that move parallel to x beside those of the ring.

    A point of the pinion keeps its y; it must stay below all that a flank of the ring has at smaller x.
    """
    (one, other), (tip, ring_tip) = (mesh.pinion.teeth, mesh.ring.tooth_count), _tips(mesh)

    def half_angle(teeth, radius):  # of a tooth of the pinion, and of a space of the ring
        at, there = math.radians(20.0), np.arccos(np.minimum(1.5 * teeth * math.cos(math.radians(20.0)) / radius, 1.0))
        return 0.5 * math.pi / teeth + math.tan(at) - at - np.tan(there) + there

    radius = np.linspace(1.5 * one * math.cos(math.radians(20.0)), tip, points)
    ring_radius = np.linspace(ring_tip, mesh.ring.form_radius, points)
    least = 0.0  # flanks touch in mesh
    for tooth in turn + np.arange(-one // 4, one // 4 + 1):
        for side in (1.0, -1.0):
            angle = 2.0 * math.pi * tooth / one + side * half_angle(one, radius)
            ring_angle = 2.0 * math.pi * tooth / other + side * half_angle(other, ring_radius)
            x, y = radius * np.cos(angle) + 1.5 * (other - one), side * radius * np.sin(angle)
            ring_x, ring_y = ring_radius * np.cos(ring_angle), side * ring_radius * np.sin(ring_angle)
            room = np.where((ring_x <= x[:, None]) & (y > 0.0)[:, None], ring_y - y[:, None], np.inf)
            least = min(least, (room / np.sqrt(1.0 - (y / ring_tip) ** 2)[:, None]).min())
    return least


@pytest.mark.parametrize("teeth", [(30, 45), (30, 46), (40, 56), (30, 47)])
def test_radial_assembly_has_the_room_of_the_ring_s_shadow_and_at_worst_that_of_trimming_interference(teeth):
    """Elements of Metric Gear Technology, 5-9 and 5-10: negative by 4e-5 to 2.2e-3 rad for the first three."""
    mesh = spur(teeth)
    (one, other), ratio = teeth, teeth[0] / teeth[1]
    cosines = [1.5 * z * math.cos(math.radians(20.0)) / r for z, r in zip(teeth, _tips(mesh), strict=True)]
    first = math.asin(math.sqrt((1.0 - (cosines[0] / cosines[1]) ** 2) / (1.0 - ratio**2)))
    second = math.asin(math.sqrt(((cosines[1] / cosines[0]) ** 2 - 1.0) / (ratio**-2 - 1.0)))
    inverse = [math.tan(math.acos(c)) - math.acos(c) - (math.tan(math.radians(20)) - math.radians(20)) for c in cosines]
    equation = first + inverse[0] - other / one * (second + inverse[1])
    tooth, space, worst = mesh.radial_assembly_clearances
    assert_allclose(worst, min(0.0, equation * ratio * mesh.ring.tip_radius), atol=1e-9)
    rooms = [_shadow(mesh, turn) for turn in np.linspace(0.0, 1.0, 20, endpoint=False)]
    # steps of a twentieth pitch miss the worst turn: 0.1 um seen
    assert_allclose([rooms[0], rooms[10], min(rooms)], [tooth, space, worst], atol=3e-4)
    assert max(rooms) <= mesh.radial_assembly_clearance + 3e-4
    assert (mesh.radial_assembly_clearance == 0.0) is (teeth != (30, 45))


def _tips(mesh):
    return mesh.pinion.tip_radius, mesh.ring.tip_radius


def test_helical_overlap_ratio_counts_the_common_face():
    mesh = internal_mesh(helix_deg=15.0)
    expected = 25.0 * math.sin(math.radians(15)) / (3.0 * math.pi)
    assert_allclose(mesh.overlap_ratio, expected)
    assert_allclose(mesh.total_contact_ratio, mesh.transverse_contact_ratio + expected)
    moved = replace(mesh, axial_offset=-5.0)  # 20 of 25 mm are left
    assert_allclose(moved.overlap_ratio, 0.8 * expected)


def test_forces_are_those_of_the_base_circle():
    mesh = internal_mesh(helix_deg=15.0)
    assert_allclose(mesh.base_tangential_force(1e5), 1e5 / mesh.pinion.base_radius)
    assert_allclose(mesh.normal_force(1e5) * math.cos(mesh.pinion.base_helix_angle), mesh.base_tangential_force(1e5))


def pair(pinion=25, ring=-60, distance=None, helix=0.0, **more):
    gear = CylindricalGear(pinion, 3.0, 25.0, helix_angle=helix, name="pinion")
    return InternalMesh(gear, RingGear(ring, 3.0, 25.0, **more), distance)


test_gears_that_do_not_fit_are_refused = refused_calls(
    (lambda: pair(pinion=60), "teeth: 60 of the pinion is not below 60"),
    (lambda: pair(helix=0.2, helix_angle=-0.2), "helix_angle: 11.4592 and -11.4592 deg must be equal"),
    (lambda: pair(pressure_angle=0.4), "pressure_angle: 20 and 22.9183 deg must be equal"),
    (lambda: pair(distance=-52.5), "centre_distance: -52.5 mm is not positive"),
)

test_meshes_that_cannot_be_are_refused = refused_calls(
    (lambda: pair(distance=49.0), "centre_distance: 49 mm is not above 49.3"),
    (
        lambda: internal_mesh(teeth=(25, 40), shifts=(0.2, 0.3)),
        "0.2 of the pinion and 0.3 of the ring, together 0.5, leave no centre distance",
    ),
    (lambda: pair(tip_diameter=170.2), "involute interference: the tip of the ring"),
    (lambda: internal_interferences(spur((30, 38)), "here"), "overlap interference: .* by 0.0424 mm"),
    error=GeometryError,
)
