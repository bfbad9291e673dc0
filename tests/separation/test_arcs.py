"""Arcs of rounded edges in the plane of a contact: they lie where they open the gap of its flanks."""

from types import SimpleNamespace

import numpy as np
import pytest

from loaded_tca.edges.places import arcs_at
from loaded_tca.flanks import FlankModifications
from loaded_tca.flanks.rounding import EdgeRounding
from loaded_tca.gears import bevel_mesh
from loaded_tca.pairs.bevel import bevel_pair
from loaded_tca.separation.arcs import arcs_beside, cells_on_arcs
from loaded_tca.separation.normal_gap import NormalGap
from loaded_tca.unloaded import relative_curvature, trace_contact
from tests.samples.gear_pairs import NONE

OPENS = 1e-9  # mm, above the rounding of gaps; an arc of 0.1 mm has opened by as much 14 nm past its beginning


@pytest.fixture(scope="module")
def at_tip():
    """A spiral bevel pair, a grid 8 to 16 mm from its contact point, cells with material, and those on a tip's arc."""
    crowned = FlankModifications(lead_crowning=0.007, profile_crowning=0.005)
    sharp = bevel_pair(bevel_mesh((20, 40), 4.0, 20.0, spiral_angle=0.6), modifications=(crowned, NONE))
    pair = sharp.rounded(EdgeRounding(tip=0.1), EdgeRounding(tip=0.1))
    contact = trace_contact(pair, [0.1], warn=False)[0]
    axes, x, y = relative_curvature(pair, contact).axes, np.linspace(-0.6, 0.6, 41), np.linspace(8.0, 16.0, 33)
    rounded, of_sharp = (
        NormalGap(one, contact, axes).surfaces(x[None, :, None], y[None, None]) for one in (pair, sharp)
    )
    material = (rounded[1:, 0] > 0.0).all(axis=0)
    grid = SimpleNamespace(x=x, y=y, origin=contact.point, axes=axes)
    return pair, grid, material, material & (rounded[0, 0] - of_sharp[0, 0] > OPENS)


def test_cells_on_arcs_are_those_whose_gap_the_arc_opens(at_tip):
    pair, grid, material, opened = at_tip
    assert opened.sum() > 20
    assert np.array_equal(cells_on_arcs(pair, grid, material).any(axis=-1), opened)
    points = grid.origin + grid.x[:, None, None] * grid.axes[0] + grid.y[:, None] * grid.axes[1]
    assert not arcs_at(pair, points)[opened].any(), "along the edge's surface the arc is seen elsewhere"


def test_outermost_cells_of_a_contact_tell_whether_it_lies_on_an_arc(at_tip):
    pair, grid, material, opened = at_tip
    reached = []
    for middle in np.linspace(8.0, 14.0, 7):
        pressed = material & ((grid.x[:, None] / 0.5) ** 2 + ((grid.y - middle) / 1.5) ** 2 < 1.0)
        beside = arcs_beside(pair, grid, pressed).any(axis=-1)
        assert not (beside & material & ~opened).any()
        assert (beside & pressed).any() == (opened & pressed).any()
        reached.append(bool((opened & pressed).any()))
    assert {*reached} == {False, True}
