"""Edges, arcs and relief starts of both flanks of a pair, seen from places on them.

The edges of a pair are counted as in ``EDGE_NAMES``, those of the pinion first (0 to 3), then those of the wheel (4 to
7). A distance to an edge is positive on the flank. Where an edge is rounded, an arc begins before it: lengths past its
beginning are positive on the arc.

Places are (rho, z) [mm] on the pinion and on the wheel: those under the cells of a contact are in
``separation/flank_places.py``; of points on the flanks, ``pair.on_flanks(points)``.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from loaded_tca.arrays import Array, Mask
from loaded_tca.flanks.base import EDGE_NAMES
from loaded_tca.flanks.rounding import Arc, RoundedFlank
from loaded_tca.pairs.gear import Gear
from loaded_tca.pairs.gear_pair import GearPair

LEAST_ARC = 0.06
"""Part of the radius of an arc before a sharp edge that counts as none: there the gap opens by 0.0018 of the radius,
0.4 um of 0.2 mm, which a loaded contact closes."""


def edge_distances(pair: GearPair, *places: tuple[Array, Array]) -> Array:
    """Distances (..., 8) [mm] of places on pinion and wheel to the edges of both flanks, negative beyond."""
    return _distances(pair, places, "edges")


def relief_start_distances(pair: GearPair, *places: tuple[Array, Array]) -> Array:
    """Distances (..., n) [mm] of places on pinion and wheel to the relief starts of both flanks, beyond > 0."""
    return _distances(pair, places, "relief_starts")


def _distances(
    pair: GearPair, places: tuple[tuple[Array, Array], ...], lines: Literal["edges", "relief_starts"]
) -> Array:
    """Distances (..., n) [mm] of places to lines of both flanks."""
    gears = zip((pair.pinion, pair.wheel), places, strict=True)
    jets = [jet for gear, place in gears for jet in getattr(gear.flank, lines)(*place)]
    shape = places[0][0].shape
    return np.stack([np.broadcast_to(jet.value, shape) for jet in jets], axis=-1) if jets else np.zeros((*shape, 0))


def has_relief_starts(pair: GearPair) -> bool:
    """Whether any flank has a linear relief."""
    nowhere = np.zeros(0)
    return bool(pair.pinion.flank.relief_starts(nowhere, nowhere) or pair.wheel.flank.relief_starts(nowhere, nowhere))


def arcs_of(pair: GearPair) -> dict[int, tuple[Gear, Arc]]:
    """Arcs of the rounded edges of both flanks, and their gears, by the numbers of the edges."""
    return {
        first + arc.edge: (gear, arc)
        for first, gear in ((0, pair.pinion), (len(EDGE_NAMES), pair.wheel))
        if isinstance(gear.flank, RoundedFlank)
        for arc in gear.flank.arcs
    }


def lengths_past_tangents(pair: GearPair, *places: tuple[Array, Array]) -> Array:
    """Lengths (..., 8) [mm] from where the arcs of all edges begin; -inf at sharp edges.

    Of places (rho, z) [mm] of pinion and wheel, along the flank towards the edge, seen along the edge's surface.
    """
    lengths: list[Array] = []
    for gear, (rho, z) in zip((pair.pinion, pair.wheel), places, strict=True):
        flank, none = gear.flank, [np.full(rho.shape, -np.inf)] * len(EDGE_NAMES)
        lengths += flank.past_tangents(rho, z) if isinstance(flank, RoundedFlank) else none
    return np.stack(lengths, axis=-1)


def on_arcs(pair: GearPair, *places: tuple[Array, Array]) -> Mask:
    """Edges (..., 8) on whose arcs places of pinion and wheel lie, on the flanks or beyond them.

    Beyond a sharp edge an arc counts where it begins before this edge, by ``LEAST_ARC`` of its radius: a sharp edge
    that cuts an arc sooner is what the contact ends at.
    """
    lengths, beyond = lengths_past_tangents(pair, *places), -edge_distances(pair, *places)
    arcs, least = arcs_of(pair), np.zeros(beyond.shape[-1])
    for edge, (_, arc) in arcs.items():
        least[edge] = LEAST_ARC * arc.radius
    past_sharp = np.delete(beyond, [*arcs], axis=-1).max(axis=-1)[..., None]
    return np.asarray((lengths > 0.0) & ((past_sharp < 0.0) | (lengths > past_sharp + least)))


def arcs_at(pair: GearPair, points: Array) -> Mask:
    """Edges (..., 8) on whose arcs points (..., 3) of the fixed frame [mm] lie, seen along the edges' surfaces."""
    return on_arcs(pair, *pair.on_flanks(points))


def dilated(cells: Mask | np.bool, steps: int = 1) -> Mask:
    """Some cells (nx, ny, ...) of a grid, and those so many steps away from one of them."""
    wider = np.array(cells, dtype=bool)
    for axis in steps * (0, 1):
        lines = wider.swapaxes(0, axis)
        before = lines.copy()
        lines[1:] |= before[:-1]
        lines[:-1] |= before[1:]
    return wider
