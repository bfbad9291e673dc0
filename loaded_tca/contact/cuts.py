r"""Cells that an edge of the material cuts: their part of the area, their compliance.

The unknown of a cut cell is the mean pressure over the whole cell, so that the convolution stays as it is. On a cut
cell itself the force stands closer together: of two cells of one slice that have the parts c_i and c_j of their area
as material

.. math:: K_{ij} \to K_{ij} \left(1 + \kappa \left[\min(1/c_i, 1/c_j) - 1\right]\right)

as it is for cells that are long along the contact and end at the same place. A cell without material carries nothing,
a whole one what it carries anyway, and in between the force grows with the part. The matrix stays positive definite:
min(1/c_i, 1/c_j) is, and so is its product with K, element by element.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from loaded_tca.arrays import Array, Indices
from loaded_tca.contact.convolution import ALL, Rows
from loaded_tca.contact.love import influence_coefficients

CROWDING = 0.94
"""kappa: the approach of a strip that ends anywhere in a cell lies on the line through those that end at its borders,
within 0.02 % on 16 and 32 cells (with 1: 0.09 %)."""


def limits(cap: float | Array, cover: Array) -> Array:
    """Largest pressure of every cell where its material carries the cap at most; caps and covers may be stacked."""
    return np.where(cover > 0.0, cover, 1.0) * cap


@dataclass(frozen=True, eq=False)
class CutCells:
    """Displacement of the cells that edges cut, on top of that of half-spaces, for a stack of problems.

    Attributes
    ----------
    shape : (int, int, int)
        Of the stack.
    cell : (n,) array of int
        Cut cells, counted through the stack problem by problem.
    start : (n,) array of int
        Where the cells begin that displace each of them, all of its slice that are cut.
    under : (pairs,) array of int
        These, counted as ``cell`` is.
    crowding : (pairs,) array
        Displacement under a unit pressure on them, in the units of the influence coefficients.
    """

    shape: tuple[int, ...]
    cell: Indices
    start: Indices
    under: Indices
    crowding: Array

    @classmethod
    def of(cls, cover: Array, aspects: Array) -> CutCells | None:
        """Those of grids with the parts ``cover`` (count, nx, ny) and the aspects dy/dx (count,); None if none is."""
        problem, column, row = np.nonzero(((cover > 0.0) & (cover < 1.0)).transpose(0, 2, 1))
        if not row.size:
            return None
        (_, nx, ny), slices = cover.shape, problem * cover.shape[2] + column
        one, other, start = _partners(slices)
        cell, inverse = (problem * nx + row) * ny + column, 1.0 / cover[problem, row, column]
        crowding = CROWDING * (np.minimum(inverse[one], inverse[other]) - 1.0)
        crowding *= influence_coefficients((nx, 1), aspects)[problem[one], np.abs(row[one] - row[other]), 0]
        return cls(cover.shape, cell, start, cell[other], crowding)

    def in_precision(self, dtype: str) -> CutCells:
        """The same in a precision."""
        return replace(self, crowding=self.crowding.astype(dtype, copy=False))

    def add(self, pressure: Array, out: Array, rows: Rows = ALL) -> None:
        """Add the displacement under pressures on some of the problems to that of their grids."""
        if len(pressure) < self.shape[0]:
            pressures = np.zeros(self.shape, dtype=pressure.dtype)
            pressures[rows] = pressure
            pressure = pressures
        moved = np.zeros(self.shape, dtype=out.dtype)
        moved.reshape(-1)[self.cell] = np.add.reduceat(self.crowding * pressure.reshape(-1)[self.under], self.start)
        out += moved[rows]


def crowding_growth(cover: Array, growth: Array, pressure: Array, aspect: float) -> Array:
    r"""Growth of the displacement of the cells that edges cut under pressures as they are, as the edges move.

    That of min(1/c_i, 1/c_j) is -dc/c^2 of the cell with the larger part of material. Multiplied with the forces, it is
    the energy that a moving edge releases.

    Parameters
    ----------
    cover : (nx, ny) array
    growth : (keys, nx, ny) array
        dc, zero in cells in which no edge runs.
    pressure : (nx, ny) array
    aspect : float
        dy/dx.

    Returns
    -------
    (keys, nx, ny) array
        In cell widths dx times the pressure over E*.

    Examples
    --------
    >>> cover, growth, pressure = np.array([[1.0], [0.5]]), np.array([[[0.0], [0.1]]]), np.array([[7.0], [3.0]])
    >>> crowding_growth(cover, growth, pressure, 1.0).round(4)[0, :, 0]  # -0.94 * 1.1222 * 3 * 0.1/0.5^2
    array([ 0.    , -1.2658])
    """
    displaced = np.zeros(growth.shape)
    column, row = np.nonzero(((cover > 0.0) & ((cover < 1.0) | growth.any(axis=0))).T)
    if not row.size:
        return displaced
    one, other, start = _partners(column)
    parts, grown = cover[row, column], growth[:, row, column]
    by_part = -grown / parts**2
    of_one = np.where(parts[one] == parts[other], 0.5, parts[one] > parts[other])
    change = of_one * by_part[:, one] + (1.0 - of_one) * by_part[:, other]
    change *= CROWDING * influence_coefficients((len(cover), 1), aspect)[np.abs(row[one] - row[other]), 0]
    displaced[:, row, column] = np.add.reduceat(change * pressure[row, column][other], start, axis=1)
    return displaced


def _partners(slices: Indices) -> tuple[Indices, Indices, Indices]:
    """Pairs of cells of one slice (pairs,) and where they begin for each cell (n,), of cells slice after slice."""
    first = np.searchsorted(slices, slices)
    count = np.searchsorted(slices, slices, side="right") - first
    start = np.cumsum(count) - count
    one = np.repeat(np.arange(slices.size), count)
    return one, np.arange(one.size) + np.repeat(first - start, count), start
