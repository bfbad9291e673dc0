"""Which edges of the two flanks a loaded contact reaches: the tips, the roots, the face ends."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation

from loaded_tca.flanks.base import EDGE_NAMES
from loaded_tca.results.edge_cell import arc_cells
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.unloaded.scan import edge_distances

NAMES = tuple(f"{gear} {edge}" for gear in ("pinion", "wheel") for edge in EDGE_NAMES)
"""Edges in the order of ``ContactPath.edges``."""


def reached_edges(result: MeshCycle) -> NDArray[np.bool_]:
    """Edges that each contact of a result reaches.

    Parameters
    ----------
    result : MeshCycle

    Returns
    -------
    (m, n, pairs, 8) array of bool
        Over torques, positions, pairs, and ``NAMES``: those that hold the unloaded contact point of a pair under load,
        and those beyond which, or on whose arcs, the cells beside its pressure lie.
    """
    pair = result.gear_pair
    held = np.stack([path.edges for path in result.paths], axis=1)
    reached = held & (result.normal_force > 0.0)[..., None]
    for t, n, k in np.argwhere(result.on_edge):
        one = result.maps[t][n][k]
        if one is None:
            continue
        row, column = np.nonzero(binary_dilation(one.pressure > 0.0) & np.isinf(one.gap))
        points = one.origin + one.x[row, None] * one.axes[0] + one.y[column, None] * one.axes[1]
        reached[t, n, k] |= (edge_distances(pair, points) < 0.0).any(axis=0)
        if pair.sharp is not pair:
            reached[t, n, k] |= arc_cells(pair, one)[one.pressure > 0.0].any(axis=0)
    return reached
