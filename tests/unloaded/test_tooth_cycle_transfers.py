"""What makes a transfer continuous: surface contact on both sides of it, or the same side edge."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import trace_contact
from loaded_tca.flanks import FlankModifications
from loaded_tca.flanks.base import EDGE_NAMES
from loaded_tca.pairs.cylindrical import Mounting
from loaded_tca.unloaded.teeth import trace_teeth
from tests.samples.gear_pairs import gear_pair

LEAD = FlankModifications(lead_crowning=0.02)
BOTH = FlankModifications(lead_crowning=0.02, profile_crowning=0.01)
TILTED = Mounting(out_of_plane=1e-3)


def held(*names):
    """Edges that hold a contact, "pinion tip" for example."""
    every = [f"{gear} {edge}" for gear in ("pinion", "wheel") for edge in EDGE_NAMES]
    return np.array([name in names for name in every])


@pytest.fixture(scope="module")
def smooth():
    (transfer,) = trace_teeth(gear_pair(BOTH, mounting=TILTED)).transfers
    return transfer


@pytest.mark.parametrize(
    ("before", "after", "continuous"),
    [
        ((), (), True),
        (("pinion tip",), (), False),
        ((), ("wheel tip",), False),
        (("pinion tip",), ("wheel tip",), False),
        (("pinion tip",), ("pinion tip",), False),
        (("wheel tip",), ("wheel tip",), False),
        (("pinion root",), ("pinion root",), False),
        (("pinion upper side",), ("pinion upper side",), True),
        (("pinion upper side",), ("wheel upper side",), True),
        (("pinion upper side",), ("wheel lower side",), False),
        (("pinion upper side",), (), False),
        (("pinion upper side", "pinion tip"), ("pinion upper side",), False),
    ],
)
def test_transfer_is_continuous_by_the_edges_that_hold_its_contacts(smooth, before, after, continuous):
    contacts = [replace(c, edges=held(*names)) for c, names in zip(smooth.contacts, (before, after), strict=True)]
    assert replace(smooth, contacts=tuple(contacts)).is_continuous is continuous


@pytest.mark.quick_cases("pinion")
@pytest.mark.parametrize("driving", ["pinion", "wheel"])
def test_short_teeth_hand_over_from_tip_to_tip(driving):
    """The path of contact is shorter than a pitch; the tips carry the rest, so that one pair always touches."""
    pair = gear_pair(LEAD, teeth=(30, 30), tip_diameter=91.5, driving=driving)
    mesh = trace_teeth(pair)
    (transfer,) = mesh.transfers
    assert all(contact.edges[[0, 4]].any() for contact in transfer.contacts)
    assert not transfer.is_continuous
    assert not mesh.is_continuous
    assert_allclose(mesh.jumps, 0.0, atol=1e-8)  # conjugate flanks on both sides of the dip that the tips make
    assert mesh.peak_to_peak > 1e-5
    assert mesh.contact_ratio(0.0) == pytest.approx(1.0, abs=1e-6)


def test_flanks_that_touch_along_their_sides_hand_over_continuously():
    """Misaligned, crowned along the profile only: curves of side contact cross without a step, in slope only."""
    pair = gear_pair(FlankModifications(profile_crowning=0.02), mounting=TILTED)
    mesh = trace_teeth(pair)
    (transfer,) = mesh.transfers
    assert all(contact.on_edge and not contact.edges[[0, 1, 4, 5]].any() for contact in transfer.contacts)
    assert mesh.is_continuous
    assert mesh.jumps.tolist() == [0.0]


@pytest.mark.thorough
def test_continuity_belongs_to_the_pair_whatever_the_positions_and_teeth():
    for pinion, continuous in ((LEAD, False), (BOTH, True)):
        pair = gear_pair(pinion, mounting=TILTED, helix_deg=15.0)
        meshes = [trace_teeth(pair, angles) for angles in ([0.0], [-0.01, 0.01], pair.pitch * np.linspace(0, 2, 7))]
        meshes.append(trace_teeth(pair, [0.0], teeth=[0]))
        assert [mesh.is_continuous for mesh in meshes] == [continuous] * 4


@pytest.mark.thorough
def test_jump_is_the_step_between_the_ends_of_surface_contact():
    pair = gear_pair(LEAD, mounting=TILTED, helix_deg=15.0)
    mesh = trace_teeth(pair)
    (transfer,), (jump,) = mesh.transfers, mesh.jumps
    around = [np.linspace(0.0, way, 1001) * 0.5 * pair.pitch for way in (-1.0, 1.0)]
    ends = []
    for contact, way in zip(transfer.contacts, around, strict=True):
        path = trace_contact(pair, contact.pinion_angle + way)
        ends.append(path.transmission_error[(~path.on_edge).argmax()])
    assert_allclose(jump, ends[1] - ends[0], rtol=2e-3)  # a position or two


@pytest.mark.thorough
@pytest.mark.filterwarnings("ignore:fillet interference")
def test_jump_is_nan_where_no_surface_contact_is_within_a_pitch():
    sloped = FlankModifications(lead_crowning=0.02, profile_slope=1.0)
    mesh = trace_teeth(gear_pair(sloped))
    assert not mesh.is_continuous
    assert np.isnan(mesh.jumps).all()
