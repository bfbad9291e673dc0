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

from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.contact.convolution import Window
from loaded_tca.contact.love import influence_coefficients
from loaded_tca.contact.slices import merged

CROWDING = 0.94
"""kappa: the approach of a strip that ends anywhere in a cell lies on the line through those that end at its borders,
within 0.02 % on 16 and 32 cells (with 1: 0.09 %)."""


def merged_cover(cover: Array, merge: tuple[int, int]) -> Array:
    """Parts of the cells that have material where so many cells along the last two axes are one."""
    for axis in (-2, -1):
        if merge[axis] == 2:
            cover = merged(cover, axis)
    return cover


def is_cut(cover: Array) -> Mask:
    """Cells that have some material, but not over the whole of them."""
    return np.asarray((cover > 0.0) & (cover < 1.0))


def limits(cap: float | Array, cover: Array) -> Array:
    """Largest pressure of every cell where its material carries the cap at most; caps and covers may be stacked."""
    return np.where(cover > 0.0, cover, 1.0) * cap


@dataclass(frozen=True, eq=False)
class CutCells:
    """Displacement of the cells that edges cut, on top of that of half-spaces, for a stack of problems.

    Attributes
    ----------
    size, loaded : int
        Cells of a grid, and of the window under pressure.
    cell : (n,) array of int
        Cut cells, counted through the stack problem by problem.
    start : (n,) array of int
        Where the cells under pressure begin that displace each of them.
    under : (pairs,) array of int
        These, counted through the windows of the stack.
    crowding : (pairs,) array
        Displacement under a unit pressure on them, in the units of the influence coefficients.
    """

    size: int
    loaded: int
    cell: Indices
    start: Indices
    under: Indices
    crowding: Array

    @classmethod
    def of(cls, cover: Array, aspects: Array, window: Window | None = None, dtype: str = "float64") -> CutCells | None:
        """Those of grids with the parts ``cover`` (count, nx, ny), under pressure on a window; None if there are none.

        ``aspects`` (count,) are dy/dx.
        """
        nx, ny = cover.shape[1:]
        problem, column, row = np.nonzero(is_cut(cover).transpose(0, 2, 1))
        # Cells of one slice stand together: every cell is paired with all of its slice.
        _, slice_start, place, members = np.unique(
            problem * ny + column, return_index=True, return_inverse=True, return_counts=True
        )
        partners = members[place]
        one = np.repeat(np.arange(row.size), partners)
        other = np.arange(one.size) + np.repeat(slice_start[place] - (np.cumsum(partners) - partners), partners)
        rows, columns = (slice(0, nx), slice(0, ny)) if window is None else window
        inside = (row[other] >= rows.start) & (row[other] < rows.stop)
        inside &= (column[other] >= columns.start) & (column[other] < columns.stop)
        one, other = one[inside], other[inside]
        if not one.size:
            return None
        width, height = columns.stop - columns.start, rows.stop - rows.start
        inverse, own = 1.0 / cover[problem, row, column], influence_coefficients((nx, 1), aspects)[:, :, 0]
        crowding = CROWDING * (np.minimum(inverse[one], inverse[other]) - 1.0)
        crowding *= own[problem[one], np.abs(row[one] - row[other])]
        under = (problem * height + row - rows.start) * width + column - columns.start
        start = np.flatnonzero(np.diff(one, prepend=-1))
        cell = ((problem * nx + row) * ny + column)[one[start]]
        return cls(nx * ny, height * width, cell, start, under[other], crowding.astype(dtype))

    def add(self, pressure: Array, out: Array) -> None:
        """Add the displacement under a pressure (count, ...) on the windows to that of the grids."""
        moved = np.add.reduceat(self.crowding * pressure.ravel()[self.under], self.start)
        out.reshape(-1)[self.cell] += moved.astype(out.dtype, copy=False)

    def select(self, rows: Indices) -> CutCells | None:
        """Those of some problems of the stack, in ascending order."""
        problem, pairs = self.cell // self.size, np.diff(self.start, append=self.under.size)
        chosen = np.isin(problem, rows)
        if not chosen.any():
            return None
        paired = np.repeat(chosen, pairs)
        problem = problem[chosen]
        shift = np.searchsorted(rows, problem) - problem
        return replace(
            self,
            cell=self.cell[chosen] + shift * self.size,
            start=np.cumsum(pairs[chosen]) - pairs[chosen],
            under=self.under[paired] + np.repeat(shift, pairs[chosen]) * self.loaded,
            crowding=self.crowding[paired],
        )
