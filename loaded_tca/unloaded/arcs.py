"""Points of the pinion flank beside rounded edges: which arcs they lie on, and where on these a contact is likely."""

from __future__ import annotations

import numpy as np

from loaded_tca.arrays import Array, Mask
from loaded_tca.flanks.base import EDGE_NAMES
from loaded_tca.flanks.rounding import RoundedFlank
from loaded_tca.unloaded.ease_off import EaseOff, Station

ALIKE = 1e-3
"""Sine of the angle between two edges below which a point that both hold is moved across one of them only."""


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
    slopes, held = field.edges(station)[1][:, edge], multipliers[:, edge]
    inwards = np.zeros(held.shape)
    for first, flank, own_rho, own_z in _both(station):
        if isinstance(flank, RoundedFlank):
            columns = slice(first, first + len(EDGE_NAMES))
            inwards[:, columns] = flank.ways_onto_arcs(own_rho, own_z, held[:, columns])
    slopes = np.where(inwards[..., None] > 0.0, slopes, 0.0)
    step = (np.linalg.pinv(slopes, rcond=ALIKE) @ inwards[..., None])[..., 0]
    return rho + step[:, 0], z + step[:, 1]


def _both(station: Station) -> tuple[tuple[int, object, Array, Array], ...]:
    """First column of the edges, flank and place on it, of both gears."""
    pair = station.pair
    return (
        (0, pair.pinion.flank, station.rho, station.z),
        (len(EDGE_NAMES), pair.wheel.flank, station.wheel_rho, station.wheel_z),
    )
