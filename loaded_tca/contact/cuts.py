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

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.contact.convolution import Window
from loaded_tca.contact.love import influence_coefficients
from loaded_tca.contact.slices import merged

CROWDING = 0.94
"""kappa: the approach of a strip that ends anywhere in a cell lies on the line through those that end at its borders,
within 0.02 % on 16 and 32 cells (with 1: 0.09 %)."""


def merged_cover(cover: Array, merge: tuple[int, int]) -> Array:
    """Parts of the cells that have material where so many cells along each axis are one."""
    for axis in (0, 1):
        if merge[axis] == 2:
            cover = merged(cover, axis)
    return cover


def is_cut(cover: Array) -> Mask:
    """Cells that have some material, but not over the whole of them."""
    return np.asarray((cover > 0.0) & (cover < 1.0))


def limits(cap: float, cover: Array) -> Array:
    """Largest pressure of every cell (nx, ny) where its material carries the cap at most."""
    return np.where(cover > 0.0, cover, 1.0) * cap


@dataclass(frozen=True, eq=False)
class CutCells:
    """Cells (n,) of a grid that edges cut, and their displacement on top of that of half-spaces.

    Attributes
    ----------
    shape : (int, int)
        Of the grid.
    row, column : (n,) array of int
    crowding : (n, n) array
        Displacement under a unit pressure on each, in the units of the influence coefficients.
    """

    shape: tuple[int, int]
    row: Indices
    column: Indices
    crowding: Array

    @classmethod
    def of(cls, cover: Array, aspect: float) -> CutCells:
        """Those of a grid with the parts ``cover`` (nx, ny), and cells of an aspect dy/dx."""
        row, column = np.nonzero(is_cut(cover))
        own, inverse = _in_one_slice(cover.shape[0], aspect), 1.0 / cover[row, column]
        crowding = CROWDING * (np.minimum(inverse[:, None], inverse) - 1.0)
        crowding *= own[np.abs(row[:, None] - row)] * (column[:, None] == column)
        return cls((cover.shape[0], cover.shape[1]), row, column, crowding)

    def operator(self, window: Window | None, dtype: str) -> Callable[[Array, Array], None] | None:
        """What adds the displacement under a pressure on a window to that of the grid; None if it holds no cut cell."""
        to = under = self.row * self.shape[1] + self.column  # one index is twice as quick as two
        crowding = self.crowding
        if window is not None:
            (rows, columns), (row, column) = window, (self.row, self.column)
            inside = (row >= rows.start) & (row < rows.stop) & (column >= columns.start) & (column < columns.stop)
            under = (row[inside] - rows.start) * (columns.stop - columns.start) + column[inside] - columns.start
            crowding = crowding[:, inside]
        if not crowding.size:
            return None
        matrix = crowding.astype(dtype)

        def add(pressure: Array, out: Array) -> None:
            out.flat[to] += matrix @ pressure.take(under).astype(dtype, copy=False)

        return add


@lru_cache(maxsize=64)
def _in_one_slice(cells: int, aspect: float) -> Array:
    """Influence coefficients (cells,) of the cells of one slice: those of a grid solved again under another load."""
    return influence_coefficients((cells, 1), aspect)[:, 0]
