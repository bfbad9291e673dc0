"""Cells of a contact on the arcs of rounded edges, which are seen along its normal."""

from __future__ import annotations

import numpy as np

from loaded_tca.arrays import Mask
from loaded_tca.edges.places import on_arcs
from loaded_tca.flanks.base import EDGE_NAMES
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.separation.flank_places import CellGrid, FlankPlaces, border_of


def cells_on_arcs(pair: GearPair, grid: CellGrid, cells: Mask) -> Mask:
    """Edges (nx, ny, 8) on whose arcs some cells (nx, ny) of the grid of a contact lie; none of its other cells."""
    edges = np.zeros((*cells.shape, 2 * len(EDGE_NAMES)), dtype=bool)
    if cells.any():
        edges[cells] = on_arcs(pair, *FlankPlaces(pair, grid).of(cells))
    return edges


def arcs_beside(pair: GearPair, grid: CellGrid, pressed: Mask) -> Mask:
    """Edges (nx, ny, 8) on whose arcs the outermost cells (nx, ny) under pressure lie, and the cells beside them.

    None of the cells within: a contact that lies on an arc has its outermost cells there.
    """
    return cells_on_arcs(pair, grid, np.zeros_like(pressed) if pair.sharp is pair else border_of(pressed))
