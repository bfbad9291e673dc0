"""Cells of a pressure map at edges: beside the end of a flank, or on the arc of a rounded edge."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import binary_dilation

from loaded_tca.arrays import Mask
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.pressure_map import PressureMap
from loaded_tca.unloaded.arcs import arcs_at


def arc_cells(pair: GearPair, one: PressureMap) -> Mask:
    """Cells (nx, ny, 8) of a map on the arc of each edge of both flanks, the cells beside them with them."""
    return np.asarray(binary_dilation(arcs_at(pair, one.points), np.ones((3, 3, 1), dtype=bool)))


def sharp_edge_cell(pair: GearPair, one: PressureMap) -> tuple[int, int]:
    """Indices of the cell with the largest pressure of those beside the end of the material, but not beside an arc."""
    if pair.sharp is pair:
        return one.edge_cell
    sharp = one.beside_end & ~arc_cells(pair, one).any(axis=-1)
    across, along = np.unravel_index(int(np.where(sharp, one.pressure, -1.0).argmax()), sharp.shape)
    return int(across), int(along)
