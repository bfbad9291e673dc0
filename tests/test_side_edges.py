"""Free edges of a contact from the sides of both gears: where they lie, and what they do to the pressure."""

import dataclasses
import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from pairs import gear_pair

from loaded_tca import sample_separation, trace_contact
from loaded_tca.bevel_pair import bevel_pair
from loaded_tca.contact.edges import quarter_space_factor
from loaded_tca.errors import InputError
from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import CylindricalGear, CylindricalMesh, bevel_mesh
from loaded_tca.loaded_contact import GridChoice, press
from loaded_tca.pair import cylindrical_pair
from loaded_tca.side_edges import side_edges

LOAD = 2700.0


def edges_of(pair, load=LOAD, cells=(16, 16)):
    contact = trace_contact(pair, [0.0])[0]
    separation = sample_separation(pair, contact, cells=cells, load=load)
    return side_edges(pair, contact, separation), separation


def test_sides_of_equal_faces_are_one_edge_at_either_end():
    edges, separation = edges_of(gear_pair(width=12.0))
    middle = 0.5 * separation.gap.shape[1] * separation.spacing[1]
    assert [edge.axis for edge in edges] == [1, 1]
    assert {edge.material for edge in edges} == {"below", "above"}
    for edge in edges:
        assert_allclose(abs(edge.position - middle), 6.0, atol=1e-9)
        assert_allclose(edge.factor, quarter_space_factor(0.3))


def test_side_of_one_gear_alone_counts_with_its_share_of_the_compliance():
    gears = [CylindricalGear(z, 3.0, width) for z, width in ((34, 12.0), (57, 15.0))]
    edges, _ = edges_of(cylindrical_pair(CylindricalMesh(*gears)))
    near = [edge for edge in edges if edge.factor > 0.0]
    assert_allclose([edge.factor for edge in near], 0.5 * quarter_space_factor(0.3))
    assert len(near) == 4  # the pinion's two, and the wheel's two 1.5 mm farther out


def test_sides_out_of_reach_of_the_contact_are_left_out():
    edges, _ = edges_of(gear_pair(FlankModifications(lead_crowning=0.2), width=60.0), load=10.0)
    assert edges == ()


@pytest.mark.parametrize("helix_deg", [0.0, 15.0, -15.0])
def test_edges_lie_where_the_material_of_the_grid_ends(helix_deg):
    pair = gear_pair(width=8.0, helix_deg=helix_deg)
    edges, separation = edges_of(pair, cells=(16, 64))
    there = np.flatnonzero(np.isfinite(separation.gap[separation.gap.shape[0] // 2]))
    step = separation.spacing[1]
    ends = sorted(edge.position for edge in edges)
    assert_allclose(ends, [there[0] * step, (there[-1] + 1) * step], atol=1.01 * step)


def test_sides_that_yield_take_the_spike_off_the_ends_of_a_line_contact():
    """Both gears end together: theory has no spike there, but a pressure that falls towards the side."""
    pair = gear_pair(width=8.0)
    contact = trace_contact(pair, [0.0])[0]
    grid = GridChoice(cells=(16, 64))
    stiff, yielding = (press(pair, contact, LOAD, dataclasses.replace(grid, free_edges=on)) for on in (False, True))
    ends = []
    for loaded in (stiff, yielding):
        line = loaded.solution.pressure.max(axis=0)
        line = line[line > 0.0]
        ends.append(max(line[0], line[-1]) / line[len(line) // 2])
    assert ends[0] > 1.05  # a half-space that ends: a spike that grows with the grid
    assert ends[1] < 1.0
    assert yielding.solution.approach > stiff.solution.approach
    assert_allclose(yielding.solution.load, LOAD, rtol=1e-9)


def test_contact_away_from_the_sides_does_not_feel_them():
    pair = gear_pair(FlankModifications(lead_crowning=0.2), width=60.0)
    contact = trace_contact(pair, [0.0])[0]
    plain, free = (press(pair, contact, 10.0, GridChoice(cells=(16, 16), free_edges=on)) for on in (False, True))
    assert_allclose(free.solution.pressure, plain.solution.pressure, rtol=0, atol=0)


def test_toe_and_heel_of_a_straight_bevel_pair_are_edges():
    pair = bevel_pair(bevel_mesh((39, 32), outer_module=2.5, face_width=14.0))
    edges, separation = edges_of(pair, load=1500.0)
    middle = 0.5 * separation.gap.shape[1] * separation.spacing[1]
    assert_allclose(sorted(edge.position - middle for edge in edges), [-7.0, 7.0], atol=0.02)


def test_oblique_side_is_refused_by_name():
    pair = gear_pair(width=8.0)
    contact = trace_contact(pair, [0.0])[0]
    separation = sample_separation(pair, contact, cells=(16, 16), load=LOAD)
    turn = math.radians(45.0)
    rotation = np.array([[math.cos(turn), math.sin(turn), 0.0], [-math.sin(turn), math.cos(turn), 0.0], [0, 0, 1.0]])
    turned = dataclasses.replace(separation, axes=rotation @ separation.axes)
    with pytest.raises(InputError, match=r"free_edges: .* degrees off the axes"):
        side_edges(pair, contact, turned)
