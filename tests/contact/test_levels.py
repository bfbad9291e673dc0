"""Coarser gaps, prolonged pressures, and windows."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.contact import levels

ROUNDING = 1e-14
"""Of means of a few cells, and of the square of a root: 6e-16 was seen."""


def cubic(shape, width=1.0):
    x, y = ((np.arange(n) + 0.5) * width for n in shape)
    return 0.3 * (x[:, None] - 4.0) ** 3 + x[:, None] * y + 0.1 * y**2


def test_coarse_gap_samples_a_cubic_exactly_inside():
    fine, coarse = cubic((20, 24)), cubic((10, 12), width=2.0)
    merged = levels.coarsen(fine, (2, 2))
    assert_allclose(merged[1:-1, 1:-1], coarse[1:-1, 1:-1], rtol=1e-12)  # terms to 1e3: 3e-16 of them seen


def test_coarse_gap_of_a_plane_is_the_plane_up_to_the_border():
    fine = np.add.outer(np.arange(9.0), 2.0 * np.arange(6.0))
    merged = levels.coarsen(fine, (2, 2))
    assert_allclose(merged[:4], np.add.outer(0.5 + 2.0 * np.arange(4), 1.0 + 4.0 * np.arange(3)), rtol=ROUNDING)
    assert_allclose(merged[4], 8.0 + 1.0 + 4.0 * np.arange(3), rtol=ROUNDING)  # the odd last row is its own block


def test_only_one_axis_may_be_merged():
    fine = np.arange(12.0).reshape(2, 6)
    assert_allclose(levels.coarsen(fine, (1, 2)).shape, (2, 3))
    assert levels.coarsening((15, 100)) == (1, 2)
    assert levels.coarsening((31, 31)) == (1, 1)


def test_block_without_material_is_infinite_and_no_other():
    fine = np.ones((8, 8))
    fine[:3, :3] = np.inf
    merged = levels.coarsen(fine, (2, 2))
    assert np.isinf(merged[0, 0])
    assert np.isfinite(merged).sum() == 15
    assert_allclose(merged[np.isfinite(merged)], 1.0, rtol=ROUNDING)


@pytest.mark.parametrize("n", [8, 16, 32])
def test_prolonged_ellipse_is_the_ellipse_to_second_order(n):
    def ellipse(cells):
        x = (np.arange(cells) + 0.5) * 2.4 / cells - 1.2
        return np.sqrt(np.maximum(0.0, 1.0 - x[:, None] ** 2 - x**2))

    prolonged = levels.prolong(ellipse(n), (2 * n, 2 * n), (2, 2))
    squares = prolonged**2 - ellipse(2 * n) ** 2
    # linear interpolation of a quadratic: 3/32 of the second difference along each axis, continued at the edge
    assert np.abs(squares).max() < 6.0 * (2.4 / n) ** 2
    assert_allclose(prolonged.sum(), ellipse(2 * n).sum(), rtol=3.0 / n)


def test_prolonged_ellipse_is_exact_away_from_its_edge():
    """Its square is a quadratic, and so is the interpolation where three cells in a row are in contact."""
    place = (np.arange(32) + 0.5) * 2.4 / 32 - 1.2
    fine = 1.0 - place[:, None] ** 2 - 0.5 * place**2
    place = (np.arange(16) + 0.5) * 2.4 / 16 - 1.2
    coarse = 1.0 - place[:, None] ** 2 - 0.5 * place**2
    prolonged = levels.prolong(np.sqrt(np.maximum(coarse, 0.0)), (32, 32), (2, 2))
    inner = np.zeros((32, 32), dtype=bool)
    inner[8:24, 8:24] = True
    assert_allclose(prolonged[inner] ** 2, fine[inner], rtol=ROUNDING)


def test_pressure_beyond_the_edge_stays_zero():
    pressure = np.zeros((8, 8))
    pressure[3:5, 3:5] = 1.0
    prolonged = levels.prolong(pressure, (16, 16), (2, 2))
    assert not prolonged[:4].any()
    assert not prolonged[12:].any()


def test_prolonged_zero_is_zero_and_odd_shapes_fit():
    assert not levels.prolong(np.zeros((5, 4)), (9, 8), (2, 2)).any()
    assert levels.prolong(np.ones((5, 4)), (9, 4), (2, 1)).shape == (9, 4)


@pytest.mark.parametrize("corner", [(0, 0), (30, 90), (17, 41), (60, 119)])
def test_window_holds_the_cells_and_a_margin(corner):
    cells = np.zeros((64, 120), dtype=bool)
    cells[corner] = True
    rows, columns = levels.window_around(cells)
    assert cells[rows, columns].any()
    for span, place, size in ((rows, corner[0], 64), (columns, corner[1], 120)):
        assert span.start <= max(0, place - levels.MARGIN_CELLS)
        assert span.stop >= min(size, place + 1 + levels.MARGIN_CELLS)
        assert 0 <= span.start < span.stop <= size


@pytest.mark.parametrize("ratio", [0.8, 0.95, 1.0, 1.1])
def test_pressure_under_another_load_is_that_of_hertz(ratio):
    """p^2 = p0^2 (1 - r^2/a^2) with p0/a the same under every load."""
    x = np.linspace(-1.2, 1.2, 64)
    square = 1.0 - (x[:, None] ** 2 + (x / 0.9) ** 2)
    pressure = np.sqrt(np.maximum(square, 0.0))
    expected = np.sqrt(np.maximum(square + ratio ** (2.0 / 3.0) - 1.0, 0.0))
    found = levels.under_other_load(pressure, ratio)
    assert_allclose(found.sum(), ratio * pressure.sum(), rtol=1e-2)
    assert np.abs(found - expected).sum() < 0.1 * abs(ratio - 1.0) * pressure.sum() + 1e-3 * pressure.sum()


@pytest.mark.parametrize("merge", [(2, 2), (1, 2), (2, 1)])
def test_grids_in_parts_are_those_in_one(monkeypatch, merge):
    values = np.random.default_rng(2).random((61, 23)) * (np.hypot(*np.mgrid[-30:31, -11:12]) < 20.0)
    shape = merge[0] * 61 - merge[0] + 1, merge[1] * 23
    whole = levels.prolong(values, shape, merge), levels.coarsen(values, merge, 0.8)
    monkeypatch.setattr(levels, "PART_CELLS", 1)
    assert (levels.prolong(values, shape, merge) == whole[0]).all()
    assert (levels.coarsen(values, merge, 0.8) == whole[1]).all()
    assert (levels.coarsen(np.where(values <= 0.8, values, np.inf), merge) == whole[1]).all()
