"""Relative curvature from the ease-off against the two flanks' own curvatures, and against closed forms."""

import gc
import math
import weakref

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.optimize import root

from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import bevel_mesh
from loaded_tca.pairs.bevel import BevelMounting, bevel_pair
from loaded_tca.pairs.cylindrical import Mounting
from loaded_tca.pairs.gear_pair import cylindrical_basis
from loaded_tca.unloaded import heelwards, relative_curvature, trace_contact
from loaded_tca.unloaded.ease_off import EaseOff
from tests.samples.gear_pairs import cylindrical_mesh, gear_pair, pairs, sam_paper

RELATIVE = 1e-9  # two chains of some hundred operations each, cancelling by a factor of up to 1e4
CLOSED_FORM = 1e-9
DIFFERENCE = 0.02  # mm
DIFFERENCES = 2e-5  # of the largest curvature, of order DIFFERENCE^2


def shape_operator(flank, rho, z, turn, axes):
    """Curvature tensor (2, 2) of a flank in the directions axes[0], axes[1] [1/mm], positive where it is convex.

    From the first and second fundamental form of the parametrisation (rho, z), with the normal axes[2]; ``turn`` is
    the azimuth of the point in the frame in which ``axes`` are given.
    """
    jet = flank.theta(np.array(rho), np.array(z))
    radial, around, axial = cylindrical_basis(np.array(turn))
    tangents = np.stack([radial + rho * jet.rho * around, axial + rho * jet.z * around])
    normal = axes[2]
    second = np.empty((2, 2))
    second[0, 0] = normal @ ((2.0 * jet.rho + rho * jet.rho_rho) * around - rho * jet.rho**2 * radial)
    second[0, 1] = second[1, 0] = normal @ ((jet.z + rho * jet.rho_z) * around - rho * jet.rho * jet.z * radial)
    second[1, 1] = normal @ (rho * jet.z_z * around - rho * jet.z**2 * radial)
    to_plane = np.linalg.inv(tangents @ axes[:2].T)
    return -to_plane @ second @ to_plane.T


def tensor_of_both_flanks(pair, contact, axes):
    pinion_azimuth = math.atan2(contact.point[1], contact.point[0])
    pinion = shape_operator(pair.pinion.flank, contact.pinion_radius, contact.pinion_axial, pinion_azimuth, axes)
    _, wheel_azimuth, _ = pair.to_wheel(contact.point)
    in_wheel = axes @ pair.wheel_axes.T
    in_wheel[2] *= -1.0  # the outward normal of the wheel
    wheel = shape_operator(pair.wheel.flank, contact.wheel_radius, contact.wheel_axial, float(wheel_azimuth), in_wheel)
    return pinion + wheel


@pytest.mark.thorough
@given(pairs(), st.floats(-0.5, 0.5))
@settings(max_examples=40)
def test_relative_curvature_is_the_sum_of_the_curvatures_of_both_flanks(pair, turn):
    path = trace_contact(pair, [turn * pair.pitch])
    contact = path[0]
    assume(not (contact.on_edge or contact.on_relief_start))  # there the normals differ
    found = relative_curvature(pair, contact)
    tensor = tensor_of_both_flanks(pair, contact, found.axes)
    scale = abs(tensor).max()
    assert_allclose(tensor, np.diag([found.across, found.along]), rtol=0, atol=RELATIVE * scale)


def gap_tensor(pair, contact, axes):
    """Second derivatives (2, 2) of the gap in the tangent plane [1/mm], by central differences of the ease-off alone.

    The points of the pinion above a cross of nine places in the plane are found by Newton's method with differences.
    """
    field, start = EaseOff(pair), np.array([contact.pinion_radius, contact.pinion_axial])
    flank = pair.pinion.flank

    def place(where):
        rho, z = where
        azimuth = float(flank.theta(np.array(rho), np.array(z)).value) + pair.sense * contact.pinion_angle
        point = np.array([rho * math.cos(azimuth), rho * math.sin(azimuth), z])
        return axes[:2] @ (point - contact.point)

    def height(x, y):
        rho, z = root(lambda where: place(where) - (x, y), start, tol=1e-13).x
        return float(field.heights(*(np.array([value]) for value in (contact.pinion_angle, rho, z)))[0][0])

    middle = height(0.0, 0.0)
    diagonal = [(height(x, y) + height(-x, -y) - 2.0 * middle) / DIFFERENCE**2 for x, y in DIFFERENCE * np.eye(2)]
    corners = [i * j * height(i * DIFFERENCE, j * DIFFERENCE) for i in (-1, 1) for j in (-1, 1)]
    cross = sum(corners) / (4.0 * DIFFERENCE**2)
    lever = contact.wheel_lever / pair.base_radii[1]
    return -lever * np.array([[diagonal[0], cross], [cross, diagonal[1]]])


CROWNED = FlankModifications(lead_crowning=0.02)
ON_EDGES = {  # pair, part of a pitch, edge that holds the contact
    "tip of the pinion": (gear_pair(CROWNED, helix_deg=25.0), 0.8, 0),
    "tip of the wheel": (gear_pair(CROWNED, helix_deg=25.0), -0.8, 4),
    "face end": (gear_pair(helix_deg=30.0, mounting=Mounting(out_of_plane=0.01)), 0.0, 3),
    "heel": (bevel_pair(bevel_mesh((20, 40), 4.0, 20.0, spiral_angle=0.6), mounting=BevelMounting(offset=0.3)), 0.1, 3),
}


@pytest.mark.parametrize(("pair", "turn", "edge"), ON_EDGES.values(), ids=ON_EDGES)
def test_curvature_at_an_edge_contact_is_that_of_the_gap_over_the_tangent_plane(pair, turn, edge):
    """There the ease-off has a slope, so that the curvature of the coordinates themselves enters."""
    contact = trace_contact(pair, [turn * pair.pitch], warn=False)[0]
    assert np.flatnonzero(contact.edges).tolist() == [edge]
    found = relative_curvature(pair, contact)
    expected, atol = gap_tensor(pair, contact, found.axes), DIFFERENCES * found.across
    assert_allclose(np.diag([found.across, found.along]), expected, rtol=0, atol=atol)


@pytest.mark.parametrize("helix_deg", [0.0, 15.0])
def test_curvature_across_a_line_contact_is_that_of_two_involutes(helix_deg):
    """1/rho = cos(beta_b) (1/a1 + 1/a2) with the roll lengths a = r_b tan(alpha_wt): ISO 6336-2; along it nothing."""
    pair, mesh = gear_pair(helix_deg=helix_deg), cylindrical_mesh(helix_deg=helix_deg)
    found = relative_curvature(pair, trace_contact(pair, [0.0])[0])
    lengths = [radius * math.tan(mesh.working_pressure_angle) for radius in pair.base_radii]
    expected = math.cos(mesh.pinion.base_helix_angle) * sum(1.0 / length for length in lengths)
    assert_allclose(found.across, expected, rtol=CLOSED_FORM)
    assert_allclose(found.along, 0.0, atol=1e-15)  # 1/mm, of curvatures of 0.1: 2e-19 seen


@pytest.mark.parametrize(("helix_deg", "radius"), [(0.0, 10.9259), (15.0, 12.0224)])
def test_equivalent_radius_of_the_sam_paper_pairs_is_the_published_one(helix_deg, radius):
    pair = sam_paper(helix_deg)
    found = relative_curvature(pair, trace_contact(pair, [0.0])[0])
    # the crowning turns the axes by 1e-3; printed to 4 decimals
    assert_allclose(1.0 / found.across, radius, atol=6e-5 + (2e-4 if helix_deg else 0.0))


def test_crowning_over_the_face_width_curves_a_spur_flank_along_its_contact_line():
    amount = 0.005
    pair = gear_pair(FlankModifications(lead_crowning=amount))
    found = relative_curvature(pair, trace_contact(pair, [0.0])[0])
    assert_allclose(found.along, 8.0 * amount / 25.0**2, rtol=1e-6)  # second order: slope of the crowning is zero there


@pytest.mark.thorough
@given(pairs(), st.floats(-0.5, 0.5))
@settings(max_examples=12)
def test_axes_are_right_handed_with_the_normal_out_of_the_pinion_and_the_second_towards_positive_z(pair, turn):
    contact = trace_contact(pair, [turn * pair.pitch])[0]
    axes = relative_curvature(pair, contact).axes
    assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)  # also below: products of three unit vectors, 4e-16 seen
    assert_allclose(np.linalg.det(axes), 1.0, rtol=1e-12)
    assert_allclose(axes[2], contact.normal)
    assert axes[1, 2] >= 0.0


@pytest.mark.parametrize("teeth", [(20, 40), (40, 20), (80, 20)])
@pytest.mark.parametrize("spiral_deg", [0.0, 35.0, -35.0])
def test_second_axis_of_a_bevel_contact_leads_to_the_heel_also_on_a_flat_gear(teeth, spiral_deg):
    mesh = bevel_mesh(teeth, 4.0, 20.0, spiral_angle=math.radians(spiral_deg))
    crowned = FlankModifications(lead_crowning=0.02, profile_crowning=0.01)
    pair = bevel_pair(mesh, modifications=(crowned, FlankModifications()))
    for contact in map(trace_contact(pair, np.linspace(-0.4, 0.4, 5) * pair.pitch).__getitem__, range(5)):
        axes = relative_curvature(pair, contact).axes
        assert np.linalg.norm(contact.point + 0.1 * axes[1]) > np.linalg.norm(contact.point)
        # of a unit vector, beside rtol
        assert_allclose(heelwards(pair, contact), contact.point / np.linalg.norm(contact.point), atol=1e-12)


def test_heelwards_is_the_axis_of_a_cylindrical_pinion():
    pair = sam_paper(15.0)
    assert_allclose(heelwards(pair, trace_contact(pair, [0.1])[0]), [0.0, 0.0, 1.0], atol=0)


@pytest.mark.thorough
def test_curvature_is_kept_for_as_long_as_its_contact_point():
    pair, other = sam_paper(), sam_paper(15.0)
    contact = trace_contact(pair, [0.1])[0]
    found = relative_curvature(pair, contact)
    assert relative_curvature(pair, contact) is found
    assert relative_curvature(other, contact).axes[1, 0] != found.axes[1, 0]  # of the pair that is asked about
    assert_allclose(relative_curvature(pair, contact).across, found.across, rtol=0)
    kept = weakref.ref(relative_curvature(pair, contact))
    del contact
    gc.collect()
    assert kept() is None


def test_axes_of_the_curvature_cannot_be_changed():
    pair = sam_paper()
    with pytest.raises(ValueError, match="read-only"):
        relative_curvature(pair, trace_contact(pair, [0.1])[0]).axes[0] = 0.0
