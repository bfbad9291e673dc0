"""Points of the pinion flank beside rounded edges: which arcs they lie on, and where on these a contact is likely."""

from __future__ import annotations

import numpy as np

from loaded_tca.arrays import Array, Mask
from loaded_tca.flanks.base import EDGE_NAMES
from loaded_tca.flanks.rounding import RoundedFlank
from loaded_tca.unloaded.ease_off import EaseOff, Station

ALIKE = 0.7
"""Cosine of the angle between two edges above which a point on both arcs is moved across one of them only."""

FLATTEST = 0.1
"""Ratio of singular values below which two edges that are left count as one."""


def past_tangents(station: Station) -> Array:
    """Lengths (n, 8) [mm] from where the arcs of all edges begin, the pinion's first; -inf at sharp edges."""
    lengths = np.full((*station.rho.shape, 2 * len(EDGE_NAMES)), -np.inf)
    for first, flank, rho, z in _both(station):
        if isinstance(flank, RoundedFlank):
            lengths[..., first : first + len(EDGE_NAMES)] = np.stack(flank.past_tangents(rho, z), axis=-1)
    return lengths


def on_arcs(field: EaseOff, phi1: Array, rho: Array, z: Array) -> Mask:
    """Which edges (n, 8) are rounded with arcs that points (n,) of the pinion flank lie on."""
    return np.asarray(past_tangents(field.station(phi1, rho, z)) > 0.0)


def moved_along_arcs(field: EaseOff, phi1: Array, rho: Array, z: Array, multipliers: Array) -> tuple[Array, Array]:
    """Points (n,) on sharp edges, moved to where the arcs have turned as far as the ease-off slopes there.

    Parameters
    ----------
    field : EaseOff
    phi1, rho, z : (n,) array [rad, mm, mm]
    multipliers : (n, edges) array
        Slopes of the ease-off against the edges that hold the points, as sharp ones.
    """
    station = field.station(phi1, rho, z)
    edge = ~field.edge_is_relief_start()
    slopes = field.edges(station)[1][:, edge]
    units = slopes / np.linalg.norm(slopes, axis=-1, keepdims=True)
    alike = units @ units.mT > ALIKE
    held, inwards = (alike @ multipliers[:, edge, None])[..., 0], np.zeros(slopes.shape[:2])
    for first, flank, own_rho, own_z in _both(station):
        if isinstance(flank, RoundedFlank):
            columns = slice(first, first + len(EDGE_NAMES))
            inwards[:, columns] = flank.ways_onto_arcs(own_rho, own_z, held[:, columns])
    # of arcs that follow each other the one that asks for the longest way decides: there the others have not begun
    inwards[inwards < np.where(alike, inwards[:, None], 0.0).max(axis=-1)] = 0.0
    slopes = np.where(inwards[..., None] > 0.0, slopes, 0.0)
    step = (np.linalg.pinv(slopes, rcond=FLATTEST) @ inwards[..., None])[..., 0]
    return rho + step[:, 0], z + step[:, 1]


def _both(station: Station) -> tuple[tuple[int, object, Array, Array], ...]:
    """First column of the edges, flank and place on it, of both gears."""
    pair = station.pair
    return (
        (0, pair.pinion.flank, station.rho, station.z),
        (len(EDGE_NAMES), pair.wheel.flank, station.wheel_rho, station.wheel_z),
    )
