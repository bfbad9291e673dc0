"""Relief starts and edges in the plane of a contact: they lie where reliefs open the gap, and where the flanks end."""

from types import SimpleNamespace

import numpy as np
import pytest

from loaded_tca.edges.places import edge_distances, relief_start_distances
from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import bevel_mesh
from loaded_tca.pairs.bevel import bevel_pair
from loaded_tca.separation.flank_places import FlankPlaces, border_of, past_relief_starts
from loaded_tca.separation.normal_gap import NormalGap
from loaded_tca.unloaded import relative_curvature, trace_contact
from tests.samples.gear_pairs import NONE

OPENS = 1e-9  # mm, above the rounding of gaps; a relief of 20 um over 5 mm has opened by as much 0.3 um past its start
CROWNED = {"lead_crowning": 0.007, "profile_crowning": 0.005}
RELIEF = {"tip_relief": 0.02, "tip_relief_start_length": 15.0, "tip_relief_form": "linear"}


MESH = bevel_mesh((20, 40), 4.0, 20.0, spiral_angle=0.6)


@pytest.fixture(scope="module")
def beside_start():
    """A spiral bevel pair, a grid 4 to 14 mm from its contact point, cells with material, and those a relief opens."""
    pair, bare = (bevel_pair(MESH, modifications=(FlankModifications(**CROWNED | more), NONE)) for more in (RELIEF, {}))
    contact = trace_contact(pair, [0.0], warn=False)[0]
    axes, x, y = relative_curvature(pair, contact).axes, np.linspace(-1.5, 1.5, 41), np.linspace(4.0, 14.0, 33)
    both = (NormalGap(one, contact, axes) for one in (pair, bare))
    gap, without = (one.surfaces(x[None, :, None], y[None, None])[:, 0] for one in both)
    material = (gap[1:] > 0.0).all(axis=0)
    grid = SimpleNamespace(x=x, y=y, origin=contact.point, axes=axes)
    return pair, grid, material, material & (gap[0] - without[0] > OPENS)


def points_of(grid):
    """Points (nx, ny, 3) of the tangent plane."""
    return grid.origin + grid.x[:, None, None] * grid.axes[0] + grid.y[:, None] * grid.axes[1]


def test_reliefs_open_the_gap_in_the_cells_past_their_start(beside_start):
    pair, grid, material, opened = beside_start
    past = past_relief_starts(pair, grid, material)
    assert past.shape == (1, *material.shape)
    assert 100 < opened.sum() < material.sum() - 100
    assert np.array_equal(past[0] > 0.0, opened)
    assert np.array_equal(past[0] <= 0.0, material & ~opened)
    in_plane = relief_start_distances(pair, *pair.on_flanks(points_of(grid)))[..., 0]
    assert not np.array_equal(material & (in_plane > 0.0), opened), "points of the plane lie on other places"


def test_border_of_a_contact_tells_whether_a_start_runs_through_it(beside_start):
    pair, grid, material, opened = beside_start
    crossed = []
    for middle in np.linspace(-1.5, 1.5, 9):
        pressed = material & (((grid.x[:, None] - middle) / 0.5) ** 2 + ((grid.y - 7.0) / 2.0) ** 2 < 1.0)
        past = past_relief_starts(pair, grid, border_of(pressed))[0]
        sides = past[pressed & border_of(pressed)] > 0.0
        assert (sides.any() and not sides.all()) == (0 < opened[pressed].sum() < pressed.sum())
        crossed.append(bool(sides.any() and not sides.all()))
    assert {*crossed} == {False, True}


def test_flanks_without_linear_reliefs_have_no_starts(beside_start):
    pair, grid, material, _ = beside_start
    bare = bevel_pair(MESH, modifications=(FlankModifications(**CROWNED), NONE))
    assert past_relief_starts(bare, grid, material).shape == (0, *material.shape)
    assert past_relief_starts(pair, grid, np.zeros_like(material)).shape == (0, *material.shape)


def test_cells_without_material_are_those_beyond_an_edge(beside_start):
    """The gap ends where the normal meets no flank, and at no point of the plane that looks so along the edge."""
    pair, grid, material, _ = beside_start
    distances = edge_distances(pair, *FlankPlaces(pair, grid).at(grid.x[:, None], grid.y))
    assert np.array_equal((distances > 0.0).all(axis=-1), material)
    in_plane = edge_distances(pair, *pair.on_flanks(points_of(grid)))
    assert not np.array_equal((in_plane > 0.0).all(axis=-1), material)
