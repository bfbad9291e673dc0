"""Where a pressure map has its edge pressure: beside the end of a flank, or on the arc of a rounded edge."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import binary_dilation

from loaded_tca.arrays import Array, Mask
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.pressure_map import PressureMap
from loaded_tca.unloaded.arcs import arcs_at


def arc_cells(pair: GearPair, one: PressureMap) -> Mask:
    """Cells (nx, ny, 8) of a map on the arc of each edge of both flanks, the cells beside them with them."""
    return np.asarray(binary_dilation(arcs_at(pair, one.points), np.ones((3, 3, 1), dtype=bool)))


def edge_cell(pair: GearPair, one: PressureMap) -> tuple[tuple[int, int], bool]:
    """Indices of the cell with the largest pressure at an edge, and whether that edge is rounded.

    Of a map without pressure the first such cell.
    """
    if pair.sharp is pair:
        return one.edge_cell, False
    rounded: Mask = np.asarray(arc_cells(pair, one).any(axis=-1))
    beside: Array = np.where(rounded | one.beside_end, one.pressure, -1.0)
    across, along = np.unravel_index(int(beside.argmax()), beside.shape)
    return (int(across), int(along)), bool(rounded[across, along])
