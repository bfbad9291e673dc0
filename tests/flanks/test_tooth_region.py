"""Region between form line and face cone: edges, coordinates and curves over the cone distance."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.flanks.base import Jet
from loaded_tca.flanks.bevel import DistanceCurve, ToothRegion, chebyshev_nodes, face_cone_angles

DISTANCES, PITCH, FACE_CONE = (95.0, 132.0), math.radians(17.4), (math.radians(19.3), -2.2)
STEP = 1e-4  # mm
ROUNDING = 1e-11  # relative, or mm: coordinates of 100 mm, searched to rounding
OF_ANGLES = 1e-14  # rad; of angles of order one, beside rtol: none seen


class Bare(ToothRegion):
    """A region without a surface."""

    def theta(self, rho, z, beyond=None):  # noqa: ARG002 (it has no relief start)
        return Jet(0.0 * rho * z)

    def gradient_norm(self, rho, z):
        return Jet(1.0 + 0.0 * rho * z)


def form_angles(distance):
    return math.radians(16.3) + 2e-3 * np.cos(distance / 40.0)


def region():
    return Bare(1, PITCH, DISTANCES, FACE_CONE, form_angles(chebyshev_nodes(DISTANCES, 11)))


def test_chebyshev_nodes_rise_from_end_to_end():
    nodes = chebyshev_nodes(DISTANCES, 9)
    assert (nodes[0], nodes[-1]) == DISTANCES
    assert (np.diff(nodes) > 0.0).all()
    assert_allclose(nodes + nodes[::-1], sum(DISTANCES))


def test_curve_is_resolved_by_few_nodes():
    curve = DistanceCurve(DISTANCES, form_angles(chebyshev_nodes(DISTANCES, 11)))
    distance = np.linspace(*DISTANCES, 101)
    assert_allclose(curve.at(distance), form_angles(distance), atol=OF_ANGLES)


@pytest.mark.parametrize("end", DISTANCES)
def test_curve_goes_on_beyond_its_ends_twice_differentiably(end):
    curve = DistanceCurve(DISTANCES, form_angles(chebyshev_nodes(DISTANCES, 11)))
    below, above = (curve(Jet(np.array(end + shift), rho=1.0)) for shift in (-1e-7, 1e-7))
    assert_allclose(above.value - below.value, 2e-7 * above.rho, atol=OF_ANGLES)
    # also below: 2e-7 mm times the next derivative, of 1e-6 per mm
    assert_allclose(above.rho, below.rho, rtol=0, atol=1e-11)
    assert_allclose(above.rho_rho, below.rho_rho, rtol=0, atol=1e-11)


def test_face_cone_stands_off_by_its_apex():
    """A point of the cone at its angle from its own apex lies at u_a(R) from the origin."""
    tip, apex = FACE_CONE
    along = np.array([80.0, 120.0])
    rho, z = along * math.sin(tip), along * math.cos(tip) - apex
    assert_allclose(face_cone_angles(FACE_CONE, np.hypot(rho, z)), np.arctan2(rho, z), rtol=OF_ANGLES)


def test_grid_ends_on_the_edges():
    flank = region()
    tip, root, toe, heel = (edge.value for edge in flank.edges(*flank.grid(7, 9)))
    for ends in (tip[-1], root[0], toe[:, 0], heel[:, -1]):
        assert_allclose(ends, 0.0, atol=ROUNDING * DISTANCES[1])
    assert all((edge[1:-1, 1:-1] > 0.1).all() for edge in (tip, root, toe, heel))


def test_profile_coordinate_runs_from_the_form_line_to_the_tip():
    flank = region()
    height = flank.profile_coordinate(*flank.grid(5, 9)).value
    assert_allclose(height, np.linspace(0.0, flank.mean_height, 5)[:, None] + np.zeros(9), atol=ROUNDING)
    tip, foot = flank.mean_cone_angles
    assert_allclose(flank.mean_height, flank.mean_cone_distance * (tip - foot))


@pytest.mark.thorough
@given(st.floats(0.25, 0.36), st.floats(90.0, 140.0))
def test_derivatives_of_coordinates_and_edges_are_those_of_their_values(angle, distance):
    flank, rho, z = region(), np.array(distance * math.sin(angle)), np.array(distance * math.cos(angle))

    def jets(at_rho, at_z):
        return [
            flank.profile_coordinate(at_rho, at_z),
            flank.lengthwise_coordinate(at_rho, at_z),
            *flank.edges(at_rho, at_z),
        ]

    here = jets(rho, z)
    for shift, slope, bends in (((STEP, 0.0), "rho", "rho_rho rho_z"), ((0.0, STEP), "z", "rho_z z_z")):
        ahead, behind = (jets(rho + sign * shift[0], z + sign * shift[1]) for sign in (1.0, -1.0))
        for jet, after, before in zip(here, ahead, behind, strict=True):
            assert_allclose((after.value - before.value) / (2.0 * STEP), getattr(jet, slope), atol=1e-7)
            for part, bend in zip(("rho", "z"), bends.split(), strict=True):
                change = (getattr(after, part) - getattr(before, part)) / (2.0 * STEP)
                assert_allclose(change, getattr(jet, bend), atol=3e-5)  # the third derivative jumps at toe and heel
