"""Arcs of rounded edges in the plane of a contact: where they begin, seen along its normal.

Flanks leave that plane by up to some tenths of a millimetre, together: the surface in which an edge lies is seldom
normal to the plane, and crosses it elsewhere than the flank. Seen along that surface, an arc near the end of a long
contact is as far off as it is wide.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from loaded_tca.arrays import Array, Mask
from loaded_tca.edges.places import dilated, lengths_past_tangents
from loaded_tca.flanks.base import EDGE_NAMES
from loaded_tca.pairs.gear_pair import ContactGrid, GearPair
from loaded_tca.separation.normal_gap import NormalGap
from loaded_tca.unloaded.path import angles_through


class CellGrid(ContactGrid, Protocol):
    """Where the cells of a contact lie; a separation and a pressure map are such grids."""

    @property
    def x(self) -> Array:
        """Middles of the cells across the contact (nx,) [mm], from the contact point."""


class ArcsOfContact:
    """Where arcs begin on the flanks of a contact, in the plane of its grid.

    Parameters
    ----------
    pair : GearPair
    grid : CellGrid
        Its origin lies on both flanks.
    """

    def __init__(self, pair: GearPair, grid: CellGrid) -> None:
        point = grid.origin[None]
        angles = angles_through(pair, np.zeros((2, 1)), point)
        self.pair, self.flanks = pair, NormalGap.at_angles(pair.sharp, point, angles, grid.axes[None])

    def lengths(self, x: Array, y: Array) -> Array:
        """Lengths (..., 8) [mm] past the beginnings of the arcs, of the points of sharp flanks at places."""
        places = self.flanks.places(*(part[None] for part in np.broadcast_arrays(x, y)))
        return lengths_past_tangents(self.pair, *places)[0]


def cells_on_arcs(pair: GearPair, grid: CellGrid, cells: Mask) -> Mask:
    """Edges (nx, ny, 8) on whose arcs some cells (nx, ny) of the grid of a contact lie; none of its other cells."""
    on_arcs = np.zeros((*cells.shape, 2 * len(EDGE_NAMES)), dtype=bool)
    if pair.sharp is not pair and cells.any():
        across, along = np.nonzero(cells)
        on_arcs[cells] = ArcsOfContact(pair, grid).lengths(grid.x[across], grid.y[along]) > 0.0
    return on_arcs


def arcs_beside(pair: GearPair, grid: CellGrid, pressed: Mask) -> Mask:
    """Edges (nx, ny, 8) on whose arcs the outermost cells (nx, ny) under pressure lie, and the cells beside them.

    None of the cells within: a contact that lies on an arc has its outermost cells there.
    """
    outermost = dilated(np.pad(~pressed, 1, constant_values=True))[1:-1, 1:-1]
    return cells_on_arcs(pair, grid, dilated(pressed) & outermost)
