"""Edges that the contacts of a result reach, and sentences on what its largest pressures rest on."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation

from loaded_tca.arrays import GEARS
from loaded_tca.flanks.base import EDGE_NAMES
from loaded_tca.results.numbers import CycleNumbers
from loaded_tca.results.pressure_map import arc_cells
from loaded_tca.results.support_growth import standing
from loaded_tca.unloaded.scan import edge_distances

NAMES = tuple(f"{gear} {edge}" for gear in GEARS for edge in EDGE_NAMES)
"""Edges in the order of ``ContactPath.edges``."""


def reached_edges(result: CycleNumbers) -> NDArray[np.bool_]:
    """Edges that each contact of a result reaches.

    Parameters
    ----------
    result : CycleNumbers

    Returns
    -------
    (m, n, pairs, 8) array of bool
        Over torques, positions, pairs, and ``NAMES``: those that hold the unloaded contact point of a pair under load,
        and those beyond which, or on whose arcs, the cells beside its pressure lie.
    """
    reached = np.zeros((*result.load_share.shape, len(NAMES)), dtype=bool)
    loaded = np.argwhere((result.normal_force > 0.0) | (result.on_edge > 0.0))
    for t, n, k in loaded.tolist():
        reached[t, n, k] = edges_of_contact(result, t, n, k)
    return reached


def edges_of_contact(result: CycleNumbers, torque: int, position: int, column: int) -> NDArray[np.bool_]:
    """Edges (8,) that one contact of a result reaches, given by its indices; see :func:`reached_edges`."""
    result, torque = standing(result, torque)
    pair, path = result.gear_pair, result.paths[column]
    reached = path.edges[position] & bool(result.normal_force[torque, position, column] > 0.0)
    one = result.maps[torque][position][column]
    if one is None or not result.on_edge[torque, position, column]:
        return np.asarray(reached)
    row, across = np.nonzero(binary_dilation(one.pressure > 0.0) & np.isinf(one.gap))
    points = one.origin + one.x[row, None] * one.axes[0] + one.y[across, None] * one.axes[1]
    reached = reached | (edge_distances(pair, points) < 0.0).any(axis=0)
    if pair.sharp is not pair:
        reached = reached | arc_cells(pair, one)[one.pressure > 0.0].any(axis=0)
    return np.asarray(reached)


LEAST_SHARE, SMALL_SHARE = 1e-3, 0.1
"""Shares of the torque from which an edge pressure is a finding, and below which a peak at an edge is one."""


def findings_of(result: CycleNumbers) -> tuple[str, ...]:
    """Sentences on what the largest pressures under each torque rest on; see ``MeshCycle.findings``."""
    by_torque = ((_edge_finding(result, t), _peak_finding(result, t)) for t in range(len(result.torque)))
    return tuple(sentence for sentences in by_torque for sentence in sentences if sentence)


def _edge_finding(result: CycleNumbers, torque: int) -> str:
    """The largest pressure at an edge of pairs that carry a thousandth of the torque: where, and what would remove it.

    An edge carries no load where the flank lacks as much there as the pair deflects: its contact deformation and the
    deflection of its teeth along the normal.
    """
    pressures = np.where(result.load_share[torque] >= LEAST_SHARE, result.edge_pressure[torque], math.nan)
    if not np.isfinite(pressures).any():
        return ""
    n, k = (int(index) for index in np.unravel_index(int(np.nanargmax(pressures)), pressures.shape))
    at = torque, n, k
    edges = [name for name, one in zip(NAMES, edges_of_contact(result, *at), strict=True) if one]
    error, cap = float(result.edge_pressure_error[at]), float(result.max_pressure)
    accuracy = "mesh-dependent: theory has an infinite one at a sharp edge"
    if result.edge_is_rounded[at]:
        known = f"by columns, with an estimated error of {error:.1%}"
        accuracy = (
            known if math.isfinite(error) else "without a limit: a sharp edge or a relief start meets the rounding"
        )
    elastic = "elastic" if math.isnan(cap) else f"with the cap of {cap:.6g} MPa"
    remedies = [
        f"{relief} on the {' or '.join(dict.fromkeys(name.split()[0] for name in edges if where in name))}"
        for relief, where in (("end relief", "side"), ("tip relief", "tip"))
        if any(where in name for name in edges)
    ]
    deflection = 1e3 * float(np.nansum([result.contact_deformation[at], result.tooth_deflection[at]]))
    amount = f"{deflection:.2g} um, by which the pair deflects"
    if result.paths[k].edges[n].any():
        amount = f"more than {amount}, since it touches there without load, too"
    remedy = f"{' or '.join(remedies) or 'a relief'} of {amount}, takes the load off it"
    return (
        f"edge pressure {result.edge_pressure[at]:.4g} MPa at {1e-3 * result.torque[torque]:g} N m on "
        f"{' + '.join(edges)} (pinion diameter {2.0 * result.edge_radius[at]:.4g} mm, axial "
        f"{result.edge_axial[at]:.4g} mm), where the pair carries {100.0 * result.load_share[at]:.3g} % of the torque; "
        f"{elastic}, {accuracy}; {remedy}"
    )


def _peak_finding(result: CycleNumbers, torque: int) -> str:
    """A peak pressure of slices at an edge in a pair that carries little, beside that of pairs that carry more."""
    place = result.peak_contact(torque)
    if place is None or not result.on_edge[torque][place] or result.load_share[torque][place] >= SMALL_SHARE:
        return ""
    others = np.where(result.load_share[torque] >= SMALL_SHARE, result.peak_pressure[torque], math.nan)
    beside = f"; of pairs that carry a tenth and more it is {np.nanmax(others):.4g} MPa" if (others > 0.0).any() else ""
    return (
        f"the peak pressure {result.peak_pressure[torque][place]:.4g} MPa at {1e-3 * result.torque[torque]:g} N m is "
        f"that of slices at an edge, in a pair that carries {100.0 * result.load_share[torque][place]:.3g} % of the "
        f"torque{beside}"
    )
