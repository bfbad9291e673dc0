"""Both sides of the teeth, where flanks end: near the base circle, at tip corners, beside an undercut."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca import trace_contact
from loaded_tca.flanks import FlankModifications
from loaded_tca.flanks.base import EDGE_NAMES
from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.pairs.cylindrical import Mounting, cylindrical_pair
from tests.samples.gear_pairs import NONE, cylindrical_mesh

CROWNED = FlankModifications(lead_crowning=0.005)
SAME_ANGLE = 1e-13  # rad; contacts at the base circle, whose radius is near its smallest: 5e-15 seen
SAME_PLACE = 1e-6  # mm; the flat direction of a maximum is known to the root of rounding
NEAR_BASE = 1e-7  # mm; at a roll length of 1 um the radius is 2e-8 mm above the base circle
SAME_NORMAL = 1e-4  # 2e-8 mm beside a contact at the base circle, where the profile bends most
TILT = 1e-4  # rad

helices = pytest.mark.parametrize("helix_deg", [0.0, 15.0, -15.0])
drives = pytest.mark.parametrize("driving", ["pinion", "wheel"])
senses = pytest.mark.parametrize("sense", ["positive", "negative"])


def mesh_reaching_down_to(roll_length, helix_deg, teeth, shift=None):
    """Pair whose wheel's tip takes the pinion's flank from a roll length on [mm]; no shift: no undercut by a hair."""
    helix = math.radians(helix_deg)
    pinion = CylindricalGear(teeth[0], 3.0, 25.0, helix_angle=helix, name="pinion")
    pinion = replace(pinion, profile_shift=pinion.smallest_profile_shift if shift is None else shift)
    wheel = CylindricalGear(teeth[1], 3.0, 25.0, helix_angle=-helix, name="wheel")
    if shift is None:
        assert pinion.form_radius == pinion.base_radius
    mesh = CylindricalMesh(pinion, replace(wheel, tip_diameter=2.0 * wheel.reference_radius))
    action = mesh.working_centre_distance * math.sin(mesh.working_pressure_angle)
    tip = math.hypot(wheel.base_radius, action - roll_length)
    return CylindricalMesh(pinion, replace(wheel, tip_diameter=2.0 * tip), mesh.working_centre_distance)


def angle_at(mesh, roll_length, driving="pinion"):
    """phi1 at which aligned flanks touch at a roll length of the pinion: earlier below the pitch point if it drives."""
    at_pitch_point = mesh.pinion.roll_length(mesh.pinion_working_radius)
    sign = 1.0 if driving == "pinion" else -1.0
    return sign * (np.asarray(roll_length) - at_pitch_point) / mesh.pinion.base_radius


def tip_corners(helix_deg):
    mesh = cylindrical_mesh(helix_deg=helix_deg)
    return mesh, np.array([-1.0, -0.9, 0.9, 1.1]) * (math.tau / 34), ("tip",)


def base_circle(helix_deg):
    mesh = mesh_reaching_down_to(1e-3, helix_deg, (17, 40))
    return mesh, angle_at(mesh, [2e-3, 0.05, 0.5]), ()


def undercut(helix_deg):
    mesh = mesh_reaching_down_to(3.0, helix_deg, (13, 22), 0.0)
    assert mesh.pinion.is_undercut
    assert mesh.pinion.form_radius > 1.0001 * mesh.pinion.base_radius
    return mesh, angle_at(mesh, [1.5, 3.1, 4.0]), ("tip",)


CASES = {"tip corners": tip_corners, "base circle": base_circle, "undercut pinion": undercut}
cases = pytest.mark.parametrize("case", CASES)


def edges_met(path):
    return {EDGE_NAMES[k % 4] for k in np.flatnonzero(path.edges.any(axis=0))}


# Near the base circle


@helices
@drives
@senses
def test_pair_touches_properly_down_to_a_form_circle_on_the_base_circle(helix_deg, driving, sense):
    """Aligned involutes, crowned along the face: at mid-face, without error, where the line of action says."""
    mesh = mesh_reaching_down_to(1e-5, helix_deg, (17, 40))
    rolls = np.array([1e-4, 1e-3, 0.01, 0.1, 1.0])
    pair = cylindrical_pair(mesh, modifications=(CROWNED, NONE), driving=driving, sense=sense)
    path = trace_contact(pair, angle_at(mesh, rolls, driving))
    assert path.in_contact.all()
    assert not path.on_edge.any()
    assert_allclose(path.transmission_error, 0.0, atol=SAME_ANGLE)
    assert_allclose(path.pinion_radius, np.hypot(mesh.pinion.base_radius, rolls), atol=NEAR_BASE)
    action = mesh.working_centre_distance * math.sin(mesh.working_pressure_angle)
    assert_allclose(path.wheel_radius, np.hypot(mesh.wheel.base_radius, action - rolls), atol=NEAR_BASE)
    assert_allclose(path.pinion_axial, 0.0, atol=SAME_PLACE)
    assert path.residual[rolls >= 0.01].max() < 1e-9


@drives
@senses
def test_wheel_tip_takes_over_before_the_base_circle(driving, sense):
    """Where aligned flanks would touch below the base circle, there is no involute: the tip of the wheel runs on."""
    mesh = mesh_reaching_down_to(0.05, 0.0, (17, 40))
    pair = cylindrical_pair(mesh, modifications=(CROWNED, NONE), driving=driving, sense=sense)
    path = trace_contact(pair, angle_at(mesh, [-0.05, -0.2], driving))
    assert path.edges[:, 4 + EDGE_NAMES.index("tip")].all()
    assert (pair.driving * path.transmission_error < 0.0).all()
    assert (path.pinion_radius >= mesh.pinion.base_radius).all()


# Mirrors


@pytest.mark.quick_cases(every=5)
@cases
@helices
@drives
def test_negative_sense_is_the_mirror_image_at_the_ends_of_the_flanks(case, helix_deg, driving):
    """In the x, z plane: hands, out-of-plane error and y change their signs, all else stays."""
    mesh, angles, edges = CASES[case](helix_deg)
    angles = angles if driving == "pinion" else -angles
    hands = CylindricalMesh(
        *(replace(gear, helix_angle=-gear.helix_angle) for gear in (mesh.pinion, mesh.wheel)), mesh.centre_distance
    )
    mods = (CROWNED, NONE)
    one = cylindrical_pair(mesh, modifications=mods, mounting=Mounting(TILT, TILT), driving=driving)
    other = cylindrical_pair(
        hands, modifications=mods, mounting=Mounting(TILT, -TILT), driving=driving, sense="negative"
    )
    first, second = trace_contact(one, angles), trace_contact(other, angles)
    assert set(edges) <= edges_met(first)
    assert_allclose(second.transmission_error, first.transmission_error, atol=SAME_ANGLE)
    assert_allclose(second.point, first.point * [1.0, -1.0, 1.0], atol=SAME_PLACE)
    assert_allclose(second.normal, first.normal * [1.0, -1.0, 1.0], atol=SAME_PLACE)
    assert_array_equal(second.edges, first.edges)
    for name in ("pinion_radius", "pinion_axial", "wheel_radius", "wheel_axial", "pinion_lever", "wheel_lever"):
        assert_allclose(getattr(second, name), getattr(first, name), atol=SAME_PLACE, err_msg=name)


@cases
@helices
def test_turning_back_with_the_wheel_driving_passes_through_the_same_contacts_at_the_ends(case, helix_deg):
    mesh, angles, _ = CASES[case](helix_deg)
    pair = cylindrical_pair(mesh, modifications=(CROWNED, NONE), mounting=Mounting(TILT, TILT))
    back = replace(pair, sense=-pair.sense, driving=-pair.driving)
    forth, reverse = trace_contact(pair, angles), trace_contact(back, -angles)
    assert_allclose(reverse.transmission_error, -forth.transmission_error, atol=SAME_ANGLE)
    assert_allclose(reverse.point, forth.point, atol=SAME_PLACE)
    assert_array_equal(reverse.edges, forth.edges)


@pytest.mark.quick_cases(every=5)
@cases
@helices
@drives
def test_exchanging_the_gears_exchanges_contacts_at_the_ends(case, helix_deg, driving):
    """Seen from the wheel: the frame is turned half round about z and moved to its axis, the sense is the other one."""
    mesh, angles, _ = CASES[case](helix_deg)
    angles = angles if driving == "pinion" else -angles
    pair = cylindrical_pair(mesh, modifications=(CROWNED, NONE), driving=driving)
    other = cylindrical_pair(
        CylindricalMesh(mesh.wheel, mesh.pinion, mesh.centre_distance),
        modifications=(NONE, CROWNED),
        driving="wheel" if driving == "pinion" else "pinion",
        sense="negative",
    )
    path = trace_contact(pair, angles)
    back = trace_contact(other, path.wheel_angle)
    assert_allclose(back.wheel_angle, path.pinion_angle, atol=10.0 * SAME_ANGLE)
    distance = [mesh.working_centre_distance, 0.0, 0.0]
    assert_allclose(back.point, distance + path.point * [-1.0, -1.0, 1.0], atol=SAME_PLACE)
    assert_allclose(back.normal, path.normal * [1.0, 1.0, -1.0], atol=SAME_NORMAL)
    assert_array_equal(back.edges, np.roll(path.edges, 4, axis=1))
    assert_allclose(back.pinion_lever, path.wheel_lever, rtol=SAME_NORMAL)
