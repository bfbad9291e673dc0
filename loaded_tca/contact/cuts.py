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

from typing import Any

import numpy as np
from scipy.sparse import csr_array

from loaded_tca.arrays import Array
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


def limits(cap: float, cover: Array) -> Array:
    """Largest pressure of every cell (nx, ny) where its material carries the cap at most."""
    return np.where(cover > 0.0, cover, 1.0) * cap


class CutCells:
    """Displacement of cut cells on top of that of half-spaces under their pressures.

    Parameters
    ----------
    cover : (nx, ny) array
        Part of every cell that has material, from 0 to 1.
    aspect : float
        dy/dx of a cell.
    window : Window or None
        Cells that carry the pressure; None: all.
    dtype : str
        Of the products.
    """

    def __init__(self, cover: Array, aspect: float, window: Window | None, dtype: str) -> None:
        row, column = np.nonzero((cover > 0.0) & (cover < 1.0))
        order = np.argsort(column, kind="stable")
        row, column = row[order], column[order]
        own, inverse = influence_coefficients((cover.shape[0], 1), aspect)[:, 0], 1.0 / cover[row, column]
        one, other = np.nonzero(column[:, None] == column)
        value = own[np.abs(row[one] - row[other])] * (np.minimum(inverse[one], inverse[other]) - 1.0)
        matrix: Any = csr_array((CROWDING * value, (one, other)), shape=2 * row.shape)
        self._at = self._under = row, column
        if window is not None:
            rows, columns = window
            inside = (row >= rows.start) & (row < rows.stop) & (column >= columns.start) & (column < columns.stop)
            matrix = matrix[:, np.flatnonzero(inside)]
            self._under = row[inside] - rows.start, column[inside] - columns.start
        self._matrix = matrix.astype(dtype)

    def add(self, pressure: Array, out: Array) -> None:
        """Add the displacement of the cut cells under a pressure on the window to ``out``."""
        out[self._at] += self._matrix @ pressure[self._under].astype(self._matrix.dtype, copy=False)
