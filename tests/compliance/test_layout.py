import numpy as np
import pytest

from loaded_tca.compliance import MeshDensity
from loaded_tca.compliance.layout import RingLayout
from loaded_tca.errors import InputError


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


def test_a_tooth_outside_the_model_is_refused():
    with pytest.raises(InputError, match="3 is not one of the 3 teeth"):
        RingLayout(25, MeshDensity()).sector(3)


def test_density_tells_every_problem():
    with pytest.raises(InputError) as error:
        MeshDensity(through=0, flank=2.5, neighbours=-1)
    assert [problem.split(":")[0] for problem in error.value.problems] == ["through", "flank", "neighbours"]


def test_an_odd_number_of_elements_through_the_tooth_is_refused():
    with pytest.raises(InputError, match="through: 3 is not even"):
        MeshDensity(through=3)
