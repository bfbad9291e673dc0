import numpy as np
import pytest

from loaded_tca.compliance import MeshDensity
from loaded_tca.compliance.layout import RingLayout
from tests.refusals import refusals, refused_calls


def test_elements_close_to_a_ring():
    layout = RingLayout(9, MeshDensity(neighbours=2))
    columns, _ = layout.shape
    lowest = layout.elements[layout.elements[:, 1] == 0][:, 0]
    np.testing.assert_array_equal(lowest, np.arange(0, columns, 2))


def test_neighbours_do_not_meet_behind_the_gear():
    layout = RingLayout(5, MeshDensity(neighbours=4))
    assert layout.neighbours == 2
    assert sorted(sector.number for sector in layout.sectors) == [-2, -1, 0, 1, 2]


def test_columns_are_turned_with_their_pitch():
    layout = RingLayout(9, MeshDensity(neighbours=2))
    for sector in layout.sectors:
        own = layout.turns[sector.first : sector.first + 2 * sector.columns]
        np.testing.assert_allclose(own, 2.0 * np.pi / 9 * sector.number)
    assert len(layout.turns) == layout.shape[0]


def test_blocks_are_the_teeth_and_the_bare_rim():
    layout = RingLayout(9, MeshDensity(neighbours=1))
    starts = layout.elements[:, 0][np.append(0, np.flatnonzero(np.diff(layout.blocks)) + 1)]
    assert starts.tolist() == [
        layout.sector(0).first,
        layout.sector(1).first,
        layout.sectors[2].first,
        layout.sector(-1).first,
    ]
    assert layout.blocks.tolist() == sorted(layout.blocks)


@pytest.mark.parametrize("layers", [1, 2, 5, 6])
def test_bricks_fill_every_layer(layers):
    layout = RingLayout(9, MeshDensity(neighbours=1, lengthwise=layers))
    lowest, spans, blocks = layout.bricks
    columns = {tuple(place): 0 for place in layout.elements}
    for place, span in zip(lowest, spans, strict=True):
        columns[tuple(place[:2])] += span
    assert set(columns.values()) == {layers}
    assert (spans[blocks == 0] == 1).all()
    assert (spans[blocks > 0] == 1).sum() == (layers % 2) * (layout.blocks > 0).sum()


test_layout_refuses = refused_calls(
    (lambda: RingLayout(25, MeshDensity()).sector(3), "3 is not one of the 3 teeth"),
    (lambda: MeshDensity(through=0, flank=2.5, neighbours=-1), ("^through:", "^flank:", "^neighbours:")),
    (lambda: MeshDensity(through=3), "through: 3 is not even"),
)


test_gradings_out_of_range_are_refused = refusals(
    lambda change: MeshDensity(**change),
    ({"grading": 0.9}, "grading: 0.9 is not between 1 and 10"),
    ({"grading": np.nan}, "grading: nan is not between 1 and 10"),
    ({"skin": -0.1}, "skin: -0.1 is not between 0 and 0.1"),
    ({"skin": 0.2}, "skin: 0.2 is not between 0 and 0.1"),
    ({"thin_ends": True, "lengthwise": 9}, "lengthwise: 9 is not an even number from 6 on"),
    ({"thin_ends": True, "lengthwise": 4}, "lengthwise: 4 is not an even number from 6 on"),
)


def test_outermost_layers_of_thin_ends_are_half_as_thick():
    assert MeshDensity(lengthwise=3).planes.tolist() == [0, 2, 4, 6, 8, 10, 12]
    thickness = np.diff(MeshDensity(lengthwise=8, thin_ends=True).planes[::2])
    assert thickness.tolist() == [2, 2, 4, 4, 4, 4, 2, 2]


@pytest.mark.parametrize("side", [1, -1])
def test_elements_of_a_foot_follow_each_other_to_the_middle_of_the_space(side):
    layout = RingLayout(9, MeshDensity(through=4, fillet=3, land=2, neighbours=1))
    lowest, ends = layout.foot(side)
    corners = lowest[:, None] + 2 * ends
    np.testing.assert_array_equal(corners[1:, 0], corners[:-1, 1])
    first, columns = layout.sector(0).first, 2 * layout.sector(0).columns
    assert corners[-1, 1].tolist() == [first + (columns if side > 0 else 0), layout.base_row]
    assert corners[0, 0, 1] == layout.base_row + 6
    present = {tuple(place) for place in layout.elements.tolist()}
    assert all(tuple(place) in present for place in lowest.tolist())
