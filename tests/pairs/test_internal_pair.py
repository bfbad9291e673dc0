"""A pinion and a ring in space: conjugate flanks, mirrors, mounting errors, and an independent tracing."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.optimize import root

from loaded_tca import trace_contact
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks import FlankModifications
from loaded_tca.pairs import Mounting
from loaded_tca.unloaded import trace_teeth
from tests.samples.internal_pairs import internal_mesh, ring_pair

CONJUGATE = 1e-15  # rad; 1e-9 um on the base circle of 85 mm are 1.2e-14 rad: 2e-16 seen
CROWNED = FlankModifications(lead_crowning=0.006, profile_crowning=0.008)
ERRORS = Mounting(in_plane=2e-4, out_of_plane=-3e-4, centre_distance_error=0.05, axial_offset=0.3)


@pytest.mark.parametrize("driving", ["pinion", "wheel"])
@pytest.mark.parametrize("sense", ["positive", "negative"])
@pytest.mark.parametrize("helix_deg", [0.0, 15.0])
def test_unmodified_pair_has_no_transmission_error(driving, sense, helix_deg):
    path = trace_teeth(ring_pair(driving=driving, sense=sense, helix_deg=helix_deg))
    assert np.abs(path.transmission_error).max() < CONJUGATE


@pytest.mark.thorough
@settings(max_examples=20)
@given(st.integers(18, 40), st.integers(12, 60), st.floats(0.0, 25.0), st.floats(0.0, 0.4), st.floats(-0.1, 0.1))
def test_random_internal_pairs_are_conjugate(pinion, more, helix, first, second):
    pair = ring_pair(teeth=(pinion, pinion + more + 8), helix_deg=helix, shifts=(first, second))
    assert np.abs(trace_teeth(pair).transmission_error).max() < 1e-14  # rad, of smaller base circles, too


def test_centre_distance_error_leaves_an_unmodified_pair_conjugate():
    for error in (0.1, -0.1):
        path = trace_teeth(ring_pair(mounting=Mounting(centre_distance_error=error)))
        assert np.ptp(path.transmission_error) < CONJUGATE


def test_positive_centre_distance_error_moves_teeth_apart():
    """The ring lags by the backlash that the error makes: its flank is met later."""
    apart = trace_teeth(ring_pair(mounting=Mounting(centre_distance_error=0.1))).transmission_error
    nearer = trace_teeth(ring_pair(mounting=Mounting(centre_distance_error=-0.1))).transmission_error
    assert apart.max() < 0.0 < nearer.min()


def test_positive_in_plane_error_opens_the_teeth_at_the_upper_end():
    pair = ring_pair(CROWNED, mounting=Mounting(in_plane=1e-3))
    assert trace_contact(pair, [0.0]).pinion_axial[0] < -1.0  # contact goes to the lower end


def test_positive_out_of_plane_error_closes_the_driving_flank_at_the_upper_end():
    pair = ring_pair(CROWNED, mounting=Mounting(out_of_plane=1e-4))
    assert trace_contact(pair, [0.0]).pinion_axial[0] > 1.0


@pytest.mark.parametrize("helix_deg", [0.0, 15.0])
def test_crowned_and_misaligned_pair_is_traced_as_by_five_equations(helix_deg):
    """Points and normals of both surfaces, written in the classical frame of the ring, solved by Newton."""
    pair = ring_pair(CROWNED, CROWNED, mounting=ERRORS, helix_deg=helix_deg)
    mesh = internal_mesh(helix_deg=helix_deg)
    path = trace_contact(pair, np.linspace(-0.02, 0.06, 5))  # inside the flanks
    assert path.in_contact.all()
    for n, angle in enumerate(path.pinion_angle):
        guess = [
            path.pinion_radius[n],
            path.pinion_axial[n],
            path.wheel_radius[n],
            -path.wheel_axial[n],
            angle * 25 / 60,
        ]
        solution = root(_five_equations, np.add(guess, [0.01, 0.02, -0.01, 0.02, 1e-5]), (mesh, angle), tol=1e-14)
        assert np.abs(solution.fun).max() < 1e-11  # mm, and parts of unit vectors: the equations hold
        error = (solution.x[4] - angle * 25 / 60) * mesh.ring.base_radius
        # mm; asked for are 1e-9
        assert_allclose(path.transmission_error[n] * mesh.ring.base_radius, error, rtol=0, atol=1e-10)
        assert_allclose(path.pinion_radius[n], solution.x[0], rtol=0, atol=1e-6)  # places along a flat contact


def _five_equations(unknowns, mesh, pinion_angle):
    """Difference of the points [mm] and of two parts of the normals of crowned flanks in the fixed frame."""
    radius, z, ring_radius, ring_z, ring_angle = unknowns
    pinion, ring = mesh.pinion, mesh.ring
    of_pinion = _surface(pinion, -1.0, mesh.pinion_working_radius, mesh.pinion_active_profile)
    of_ring = _surface(ring, 1.0, mesh.wheel_working_radius, mesh.wheel_active_profile)
    first, first_normal = _at(of_pinion, radius, z, pinion_angle)
    second, second_normal = _at(of_ring, ring_radius, ring_z, ring_angle)
    gamma, delta = ERRORS.in_plane, ERRORS.out_of_plane
    about_x = [[1, 0, 0], [0, math.cos(delta), -math.sin(delta)], [0, math.sin(delta), math.cos(delta)]]
    about_y = [[math.cos(gamma), 0, math.sin(gamma)], [0, 1, 0], [-math.sin(gamma), 0, math.cos(gamma)]]
    turn = np.array(about_y) @ np.array(about_x)
    shift = [ERRORS.centre_distance_error - mesh.working_centre_distance, 0.0, ERRORS.axial_offset]
    second, second_normal = turn @ second + shift, turn @ second_normal
    cross = np.cross(first_normal, second_normal)
    return [*(first - second), cross[0], cross[2]]


def _surface(gear, sign, working, profile):
    """Azimuth of a flank of an involute gear whose axis is +z, crowned; of the ring against its classical z axis."""
    base, helix = gear.base_radius, gear.base_helix_angle
    start, end = profile.start_roll_length, profile.end_roll_length

    def involute(radius):
        angle = np.arccos(base / radius)
        return np.tan(angle) - angle

    def azimuth(radius, z):
        roll = np.sqrt(radius**2 - base**2)
        crowned = 0.006 * (z / 12.5) ** 2 + 0.008 * ((roll - 0.5 * (start + end)) / (0.5 * (end - start))) ** 2
        # the pinion's flank leads its tooth in the sense of rotation, that of the ring is pushed ahead
        return (
            -(involute(radius) - involute(working))
            + z * math.tan(helix) / base
            + sign * crowned / (base * math.cos(helix))
        )

    return azimuth


def _at(azimuth, radius, z, turn):
    """Point and normal of a surface theta = azimuth(radius, z) + turn."""
    step = 1e-30
    theta = azimuth(radius, z) + turn
    slope = azimuth(radius + 1j * step, z).imag / step
    along = azimuth(radius, z + 1j * step).imag / step
    cosine, sine = math.cos(theta), math.sin(theta)
    gradient = np.array([-slope, 1.0 / radius, -along])
    normal = np.array(
        [gradient[0] * cosine - gradient[1] * sine, gradient[0] * sine + gradient[1] * cosine, gradient[2]]
    )
    return np.array([radius * cosine, radius * sine, z]), normal / np.linalg.norm(normal)


def test_driving_ring_and_other_sense_are_mirror_images():
    errors = Mounting(out_of_plane=2e-4)
    mirrored = Mounting(out_of_plane=-2e-4)
    there = trace_teeth(ring_pair(CROWNED, mounting=errors)).transmission_error
    driven = trace_teeth(ring_pair(CROWNED, mounting=mirrored, driving="wheel")).transmission_error
    backwards = trace_teeth(ring_pair(CROWNED, mounting=mirrored, sense="negative")).transmission_error
    assert_allclose(np.ptp(driven), np.ptp(there), rtol=1e-9)
    assert_allclose(backwards, there, rtol=0, atol=1e-12)  # rad, of some 1e-5


def test_misalignment_by_either_gear_of_the_ring_is_the_end_of_the_pinion():
    """A helix slope of the ring and one of the pinion meet the same end of the face."""
    of_pinion = ring_pair(FlankModifications(lead_crowning=0.005, helix_slope=0.01))
    of_ring = ring_pair(FlankModifications(lead_crowning=0.005), FlankModifications(helix_slope=0.01))
    places = [trace_contact(pair, [0.0]).pinion_axial[0] for pair in (of_pinion, of_ring)]
    assert_allclose(places[0], places[1], rtol=1e-6)
    assert places[0] < 0.0


def test_faces_apart_and_unknown_words_are_refused():
    with pytest.raises(GeometryError, match="no common flank"):
        ring_pair(mounting=Mounting(axial_offset=25.0))
    with pytest.raises(InputError, match="driving: 'ring'"):
        ring_pair(driving="ring")
    with pytest.raises(GeometryError, match=r"wheel: its teeth wind|pinion: its teeth wind"):
        ring_pair(width=2000.0, helix_deg=25.0)
