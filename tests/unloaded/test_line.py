"""Line contact: labelled, from edge to edge, its middle the contact point."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import trace_contact
from loaded_tca.flanks import FlankModifications
from loaded_tca.flanks.base import EDGE_NAMES
from loaded_tca.pairs.cylindrical import Mounting
from tests.samples.gear_pairs import cylindrical_mesh, gear_pair

ON_EDGE = 1e-7  # mm; twelve Newton steps end there
FLATNESS = 1e-9  # of the module: where a line ends and a point begins

helices = pytest.mark.parametrize("helix_deg", [0.0, 15.0, -25.0])
drives = pytest.mark.parametrize("driving", ["pinion", "wheel"])


def edge_distances(pair, point):
    """Smallest distance of a point in space to the edges of either flank [mm]."""
    rho, z = np.array(math.hypot(point[0], point[1])), np.array(point[2])
    wheel_rho, _, wheel_z = pair.to_wheel(point)
    jets = (*pair.pinion.flank.edges(rho, z), *pair.wheel.flank.edges(wheel_rho, wheel_z))
    return np.array([float(jet.value) for jet in jets])


@pytest.mark.quick_cases(every=5)
@helices
@drives
@pytest.mark.parametrize("offset", [0.0, 2.0, -3.0])
def test_line_of_an_unmodified_pair_ends_on_edges_and_has_the_point_in_its_middle(helix_deg, driving, offset):
    pair = gear_pair(mounting=Mounting(axial_offset=offset), helix_deg=helix_deg, driving=driving)
    path = trace_contact(pair, np.linspace(-0.45, 0.45, 7) * pair.pitch)
    assert path.on_line.all()
    assert not path.on_edge.any()
    assert not path.on_relief_start.any()
    assert_allclose(path.line_ends.mean(axis=1), path.point, atol=1e-9)  # the line of an involute helicoid is straight
    assert (np.diff(path.line_ends[..., 2], axis=1) > 0.1).all(), "from the lower end to the upper one"
    for row in range(len(path)):
        for end in path.line_ends[row]:
            distances = edge_distances(pair, end)
            assert distances.min() > -ON_EDGE
            assert abs(distances).min() < ON_EDGE


def test_line_of_a_spur_pair_is_as_long_as_the_common_face():
    pair = gear_pair(mounting=Mounting(axial_offset=2.0))
    path = trace_contact(pair, [0.0])
    assert_allclose(path.line_ends[0], [[51.0, 0.0, -10.5], [51.0, 0.0, 12.5]], atol=ON_EDGE)


def test_line_of_a_helical_pair_crosses_the_plane_of_action_at_the_base_helix_angle():
    mesh, pair = cylindrical_mesh(helix_deg=15.0), gear_pair(helix_deg=15.0)
    first, last = trace_contact(pair, [0.0]).line_ends[0]
    direction = (last - first) / np.linalg.norm(last - first)
    assert_allclose(direction[2], math.cos(mesh.pinion.base_helix_angle), rtol=1e-9)
    alpha = mesh.working_pressure_angle
    assert_allclose(direction @ [math.cos(alpha), -math.sin(alpha), 0.0], 0.0, atol=1e-9)


@pytest.mark.parametrize("turn", [0.9, -0.9])
def test_line_on_a_tip_edge_is_an_edge_contact_and_a_line(turn):
    pair = gear_pair()
    path = trace_contact(pair, [turn * pair.pitch])
    assert path.on_line.all()
    assert path.on_edge.all()
    tip = EDGE_NAMES.index("tip") + (0 if turn > 0 else 4)
    assert np.flatnonzero(path.edges[0]).tolist() == [tip]
    assert_allclose(path.line_ends[0, :, 2], [-12.5, 12.5], atol=ON_EDGE)
    assert_allclose(path.point[0, 2], 0.0, atol=ON_EDGE)


@helices
def test_profile_modification_alone_leaves_a_line_on_a_spur_pair_only(helix_deg):
    path = trace_contact(gear_pair(FlankModifications(profile_crowning=0.01), helix_deg=helix_deg), [0.0])
    assert path.on_line.all() == (helix_deg == 0.0)


@helices
@pytest.mark.parametrize("share", [0.5, 2.0])
def test_contact_is_a_line_below_the_flatness_and_a_point_above(helix_deg, share):
    """The gap along the line grows to the crowning at the end of the face."""
    crowned = FlankModifications(lead_crowning=share * FLATNESS * 3.0)
    path = trace_contact(gear_pair(crowned, helix_deg=helix_deg), [0.0])
    assert path.on_line.all() == (share < 1.0)


def test_point_contact_has_no_line_ends():
    path = trace_contact(gear_pair(FlankModifications(lead_crowning=0.005)), [0.0])
    assert not path.on_line.any()
    assert np.isnan(path.line_ends).all()
    # and neither has a contact on the end of a misaligned face
    path = trace_contact(gear_pair(mounting=Mounting(out_of_plane=0.001)), [0.0])
    assert path.on_edge.all()
    assert not path.on_line.any()


@pytest.mark.quick_cases(every=3)
@helices
@pytest.mark.parametrize("length", [4.0, 8.0])
def test_contact_on_a_flat_stretch_between_end_reliefs_is_its_middle(helix_deg, length):
    """No line, since it ends before the edges; wherever the ascent ended, its middle stands for it."""
    relief = FlankModifications(end_relief=0.02, end_relief_length=length)
    path = trace_contact(gear_pair(relief, helix_deg=helix_deg), np.linspace(-0.05, 0.05, 9))
    assert not path.on_line.any()
    assert not path.on_edge.any()
    assert_allclose(path.pinion_axial, 0.0, atol=0.01)  # the parabolas leave the level within 2 um
    assert_allclose(path.transmission_error, 0.0, atol=1e-14)  # rad; angles of order 0.1: 1e-16 seen
