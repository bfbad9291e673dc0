"""Points beside the edges of both flanks: how far from them, on which arcs, and where on these a contact is likely."""

from __future__ import annotations

import numpy as np

from loaded_tca.arrays import Array, Mask
from loaded_tca.flanks.base import EDGE_NAMES
from loaded_tca.flanks.rounding import RoundedFlank
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.unloaded.ease_off import EaseOff, Station

ALIKE = 0.7
"""Cosine of the angle between two edges above which a point on both arcs is moved across one of them only."""

FLATTEST = 0.1
"""Ratio of singular values below which two edges that are left count as one."""


def edge_distances(pair: GearPair, points: Array) -> Array:
    """Distances (..., 8) [mm] of points (..., 3) of the fixed frame to the edges of both flanks, negative beyond."""
    radius, _, axial = pair.to_wheel(points)
    pinion = pair.pinion.flank.edges(np.hypot(points[..., 0], points[..., 1]), points[..., 2])
    edges = [*pinion, *pair.wheel.flank.edges(radius, axial)]
    return np.stack([np.broadcast_to(edge.value, points.shape[:-1]) for edge in edges], axis=-1)


def relief_start_distances(pair: GearPair, points: Array) -> Array:
    """Distances (..., n) [mm] of points (..., 3) of the fixed frame to the relief starts of both flanks, beyond > 0."""
    radius, _, axial = pair.to_wheel(points)
    pinion = pair.pinion.flank.relief_starts(np.hypot(points[..., 0], points[..., 1]), points[..., 2])
    values = [jet.value for jet in (*pinion, *pair.wheel.flank.relief_starts(radius, axial))]
    return np.stack(np.broadcast_arrays(*values, axial)[:-1], axis=-1) if values else np.zeros((*axial.shape, 0))


def past_tangents(station: Station) -> Array:
    """Lengths (n, 8) [mm] from where the arcs of all edges begin, the pinion's first; -inf at sharp edges."""
    return lengths_past_tangents(station.pair, (station.rho, station.z), (station.wheel_rho, station.wheel_z))


def arcs_at(pair: GearPair, points: Array) -> Mask:
    """Edges (..., 8) on whose arcs points (..., 3) of the fixed frame [mm] lie, seen along the edges' surfaces."""
    radius, _, axial = pair.to_wheel(points)
    pinion = np.hypot(points[..., 0], points[..., 1]), points[..., 2]
    return np.asarray(lengths_past_tangents(pair, pinion, (radius, axial)) > 0.0)


def lengths_past_tangents(pair: GearPair, *places: tuple[Array, ...]) -> Array:
    """The same (..., 8) [mm] of places (rho, z) [mm] of pinion and wheel, seen along the edges' surfaces."""
    found: list[Array] = []
    for gear, (rho, z) in zip((pair.pinion, pair.wheel), places, strict=True):
        flank, none = gear.flank, [np.full(rho.shape, -np.inf)] * len(EDGE_NAMES)
        found += flank.past_tangents(rho, z) if isinstance(flank, RoundedFlank) else none
    return np.stack(found, axis=-1)


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
    places = (station.rho, station.z), (station.wheel_rho, station.wheel_z)
    for number, (gear, place) in enumerate(zip((field.pair.pinion, field.pair.wheel), places, strict=True)):
        if isinstance(gear.flank, RoundedFlank):
            columns = slice(number * len(EDGE_NAMES), (number + 1) * len(EDGE_NAMES))
            inwards[:, columns] = gear.flank.ways_onto_arcs(*place, held[:, columns])
    # of arcs that follow each other the one that asks for the longest way decides: there the others have not begun
    inwards[inwards < np.where(alike, inwards[:, None], 0.0).max(axis=-1)] = 0.0
    slopes = np.where(inwards[..., None] > 0.0, slopes, 0.0)
    step = (np.linalg.pinv(slopes, rcond=FLATTEST) @ inwards[..., None])[..., 0]
    return rho + step[:, 0], z + step[:, 1]
