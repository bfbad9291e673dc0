"""Edges and arcs of both flanks at points of the fixed frame: the order of the edges, distances, where arcs begin."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.edges.places import (
    LEAST_ARC,
    arcs_at,
    arcs_of,
    dilated,
    edge_distances,
    has_relief_starts,
    relief_start_distances,
)
from loaded_tca.flanks import FlankModifications
from loaded_tca.flanks.rounding import EdgeRounding
from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.pairs.cylindrical import cylindrical_pair
from tests.samples.gear_pairs import NONE, gear_pair

PINION_TIP, WHEEL_TIP = 54.0, 88.5  # mm, radii of 34 and 57 teeth of 3 mm
WIDTH, RADIUS = 25.0, 0.2
EXACT = 1e-9  # mm, some thousand times the rounding of 100 mm


def between_the_axes(pair, radius, z):
    """Points on the line of centres, so far from the pinion's axis, at places along it."""
    across = pair.wheel_origin / np.linalg.norm(pair.wheel_origin)
    return radius * across + np.asarray(z)[..., None] * (0.0, 0.0, 1.0)


def test_distances_to_edges_are_those_to_tip_circles_and_face_ends_pinion_first():
    pair = gear_pair()
    distances = edge_distances(pair, *pair.on_flanks(between_the_axes(pair, 50.0, [[3.0, 0.0]])))
    assert distances.shape == (1, 2, 8)
    sides = [0.5 * WIDTH + 3.0, 0.5 * WIDTH - 3.0]
    assert_allclose(distances[0, 0, [0, 2, 3]], [PINION_TIP - 50.0, *sides], atol=EXACT)
    in_wheel = np.linalg.norm(pair.wheel_origin) - 50.0
    assert_allclose(distances[0, 0, [4, 6, 7]], [WHEEL_TIP - in_wheel, *sides], atol=EXACT)


def test_arcs_have_the_numbers_of_their_edges_and_begin_a_radius_before_the_end_of_a_face():
    pair = gear_pair().rounded(EdgeRounding(tip=0.3), EdgeRounding(side=RADIUS))
    arcs = arcs_of(pair)
    assert {edge: arc.radius for edge, (_, arc) in arcs.items()} == {0: 0.3, 6: RADIUS, 7: RADIUS}
    assert arcs[0][0] is pair.pinion
    assert arcs[6][0] is arcs[7][0] is pair.wheel
    end = 0.5 * WIDTH - RADIUS
    on = arcs_at(pair, between_the_axes(pair, 50.0, [-end - 0.01, -end + 0.01, end - 0.01, end + 0.01]))
    assert [np.flatnonzero(row).tolist() for row in on] == [[6], [], [], [7]]


@pytest.mark.parametrize("cut", [0.0, 0.5, 2.0])
def test_arc_that_begins_where_a_sharp_edge_has_ended_the_contact_is_none(cut):
    """A wider pinion with rounded ends; ``cut``: what of its arcs lies before the wheel's ends, over the least part."""
    beyond = RADIUS * (1.0 - cut * LEAST_ARC)
    gears = [CylindricalGear(z, 3.0, WIDTH + 2.0 * wider) for z, wider in ((34, beyond), (57, 0.0))]
    pair = cylindrical_pair(CylindricalMesh(*gears)).rounded(EdgeRounding(side=RADIUS), EdgeRounding())
    end = 0.5 * WIDTH
    inside, past = arcs_at(pair, between_the_axes(pair, 50.0, [end - 1e-4, end + 0.5 * RADIUS]))
    assert np.flatnonzero(inside).tolist() == ([3] if cut else []), "on the flank an arc is one, however short"
    assert np.flatnonzero(past).tolist() == ([3] if cut > 1.0 else [])


@pytest.mark.parametrize("gear", [0, 1])
def test_relief_starts_of_either_gear_are_told(gear):
    start = 2.0 * (PINION_TIP, WHEEL_TIP)[gear] - 2.0
    relief = FlankModifications(tip_relief=0.02, tip_relief_start=start, tip_relief_form="linear")
    pair = gear_pair(*((relief, NONE) if gear == 0 else (NONE, relief)))
    assert has_relief_starts(pair)
    beyond = relief_start_distances(pair, *pair.on_flanks(between_the_axes(pair, PINION_TIP - 0.5, [0.0])))
    assert (beyond > 0.0).tolist() == [[gear == 0]]  # 0.5 mm below one tip is far below the other
    assert not has_relief_starts(gear_pair())
    assert relief_start_distances(gear_pair(), *pair.on_flanks(between_the_axes(pair, 50.0, [0.0]))).shape == (1, 0)


def test_cells_beside_an_edge_stay_with_that_edge():
    cells = np.zeros((5, 6, 2), dtype=bool)
    cells[1, 2, 0] = True
    assert np.argwhere(dilated(cells)[..., 0]).tolist() == [[i, j] for i in range(3) for j in range(1, 4)]
    assert not dilated(cells)[..., 1].any()
    assert dilated(cells[..., 0], 2).sum() == 4 * 5
