"""Places on both flanks under the cells of a contact, seen along its normal: what lies there, as edges and reliefs do.

Flanks leave the tangent plane by up to some tenths of a millimetre near the ends of long contacts, together. The
surface in which an edge lies, and that of a relief start, is seldom normal to the plane, and crosses it elsewhere than
the flank: a point of the plane has the radius and the axial coordinate of another place of the flank.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from loaded_tca.arrays import Array, Mask
from loaded_tca.edges.places import dilated, relief_start_distances
from loaded_tca.pairs.gear_pair import ContactGrid, GearPair
from loaded_tca.separation.normal_gap import NormalGap
from loaded_tca.unloaded.path import angles_through


class CellGrid(ContactGrid, Protocol):
    """Where the cells of a contact lie; a separation and a pressure map are such grids."""

    @property
    def x(self) -> Array:
        """Middles of the cells across the contact (nx,) [mm], from the contact point."""


class FlankPlaces:
    """Places on the sharp flanks of a contact under points of the plane of its grid.

    Parameters
    ----------
    pair : GearPair
    grid : CellGrid
        Its origin lies on both flanks.
    """

    def __init__(self, pair: GearPair, grid: CellGrid) -> None:
        point = grid.origin[None]
        angles = angles_through(pair, np.zeros((2, 1)), point)
        self.grid, self.flanks = grid, NormalGap.at_angles(pair.sharp, point, angles, grid.axes[None])

    def at(self, x: Array, y: Array) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        """(rho, z) [mm] on pinion and wheel, at points that broadcast."""
        of_pinion, of_wheel = self.flanks.places(*(part[None] for part in np.broadcast_arrays(x, y)))
        return (of_pinion[0][0], of_pinion[1][0]), (of_wheel[0][0], of_wheel[1][0])

    def of(self, cells: Mask) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        """(rho, z) (n,) [mm] on pinion and wheel, of some cells (nx, ny) of the grid."""
        across, along = np.nonzero(cells)
        return self.at(self.grid.x[across], self.grid.y[along])


def border_of(pressed: Mask) -> Mask:
    """The outermost cells (nx, ny) under pressure, and the cells beside them; none of the cells within."""
    outermost = dilated(np.pad(~pressed, 1, constant_values=True))[1:-1, 1:-1]
    return dilated(pressed) & outermost


def past_relief_starts(pair: GearPair, grid: CellGrid, cells: Mask) -> Array:
    """Distances (n, nx, ny) [mm] past the relief starts of both flanks, of some cells (nx, ny); NaN in the others.

    Empty where no flank has a linear relief, and without cells.
    """
    if not cells.any():
        return np.empty((0, *cells.shape))
    past = relief_start_distances(pair, *FlankPlaces(pair, grid).of(cells))
    distances = np.full((past.shape[-1], *cells.shape), np.nan)
    distances[:, cells] = past.T
    return distances
