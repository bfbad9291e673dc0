"""Edges in a pressure map: cells beside the end of a flank or on the arc of a rounded edge."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import binary_dilation

from loaded_tca.arrays import Mask
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.pressure_map import PressureMap
from loaded_tca.unloaded.scan import arcs_at, edge_distances


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


def place_on_material(pair: GearPair, one: PressureMap, cell: tuple[int, int]) -> tuple[float, float]:
    """Middle of a cell from the contact point [mm]; where that lies beyond an edge, the edge beside it.

    That is where the way from the middle of the nearest cell with material leaves both flanks; their distances to the
    edges are straight over the width of a cell.
    """
    across, along = cell
    middle, there = np.array([one.x[across], one.y[along]]), np.argwhere(np.isfinite(one.gap))
    if np.isfinite(one.gap[cell]) or not there.size:
        return float(middle[0]), float(middle[1])
    inner = np.stack([one.x[there[:, 0]], one.y[there[:, 1]]], axis=-1)
    ends = np.stack([inner[np.hypot(*(inner - middle).T).argmin()], middle])
    within, beyond = edge_distances(pair, one.origin + ends @ one.axes[:2])
    crossed = (beyond < 0.0) & (within >= 0.0)
    part = float(np.min(within[crossed] / (within - beyond)[crossed], initial=1.0))
    x, y = (ends[0] + part * (ends[1] - ends[0])).tolist()
    return x, y
