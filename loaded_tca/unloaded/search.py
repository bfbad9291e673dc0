"""Where the flanks touch first: a coarse scan names the basins, the reduced solver climbs each, the best one wins.

A relief start (the start of a linear relief) splits a flank into smooth pieces. An ascent stays on its piece, with the
smooth continuation of that piece; if it is held by a relief start, the piece beyond is climbed from there, and so on
from piece to piece. A contact that rests on a relief start is thus found like one that rests on an edge.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.errors import ConvergenceError
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.plain import plain
from loaded_tca.unloaded.ease_off import EaseOff
from loaded_tca.unloaded.reduced import Maxima, climb
from loaded_tca.unloaded.scan import Scan, Starts, inside_pinion, moved_along_arcs, on_arcs, region_corners, scan_pinion

POSITIONS_AT_ONCE = 1024
"""Positions searched together: some 0.2 GB."""
ROUNDS = 5
"""Times that a contact is checked, and points that it missed are climbed from."""
CERTIFICATE = 1e-13
"""How far, relative to r_b2, a scanned point may rise above the maximum found: rounding."""
PIERCED = 1e-9
"""Depth over the module at which a point of the wheel's flank lies inside the pinion: rounding is 1e-13."""
NUDGE = 0.05
"""Step away from a saddle, as a fraction of the flank."""
CLOSE = (1e-4, 1e-3, 1e-2)
"""Steps away from a corner along its edges, as a fraction of the flank."""
SAME = 1e-3
"""Distance of the ends of two ascents, over the module, within which one start on an arc is enough."""
OFF_EDGE = 0.01
"""Distance by which such a step may leave the region, relative to it, since edges are bent."""


@dataclass(frozen=True, eq=False)
class FirstTouch:
    """The highest point of the ease-off at each position.

    Attributes
    ----------
    rho, z : (n,) array [mm]
        On the pinion flank; arbitrary where nothing touches.
    value : (n,) array [mm]
        Ease-off.
    multipliers : (n, edges) array
        Slope against each edge or relief start that holds the point.
    beyond : (n, relief starts) bool array
        The smooth piece it belongs to.
    iterations : (n,) int array
        Steps of the winning ascent.
    in_contact : (n,) bool array
        False where the two flanks share no region at all.
    """

    rho: Array
    z: Array
    value: Array
    multipliers: Array
    beyond: Mask
    iterations: Array
    in_contact: Array


def first_touch(pair: GearPair, phi1: Array) -> FirstTouch:
    """Global maximum of the ease-off at each pinion angle (n,) [rad].

    Raises
    ------
    ConvergenceError
        If a position has a common region but no ascent reached the height of the scan.
    """
    starts = range(0, max(len(phi1), 1), POSITIONS_AT_ONCE)
    parts = [_first_touch(pair, phi1[start : start + POSITIONS_AT_ONCE]) for start in starts]
    return FirstTouch(*(np.concatenate([getattr(part, one.name) for part in parts]) for one in fields(FirstTouch)))


def touch_near(pair: GearPair, phi1: Array, rho: Array, z: Array) -> FirstTouch:
    """Maximum of the ease-off at each pinion angle (n,) [rad] that is climbed to from a place on the pinion (n,) [mm].

    It is the first touch where that of an angle nearby is the place. Not in contact where no ascent arrives.
    """
    return _best(phi1, _ascend(pair, phi1, np.arange(len(phi1)), rho, z))


def _first_touch(pair: GearPair, phi1: Array) -> FirstTouch:
    """First touch of sharp edges; where that lies on the arc of a rounded one, of flanks with their arcs.

    Rounding only takes material off: what touches first with sharp edges, and lies on no arc, still does.
    """
    scan = scan_pinion(pair.sharp, phi1)
    climbs = _ascend(pair.sharp, phi1, *scan.hills())
    if pair.sharp is pair:
        return _certified(pair, phi1, scan, climbs)[0]
    touch = _best(phi1, climbs)
    rest = np.flatnonzero(~_touches_arc(pair, phi1, touch))
    if rest.size:  # where an arc is reached it is certified with the arcs, below
        part, more = _certified(pair.sharp, phi1[rest], scan.only(rest), _renumbered(climbs, rest, len(phi1)))
        touch, climbs = _merged(touch, rest, part), climbs + [one._replace(owner=rest[one.owner]) for one in more]
    rows = np.flatnonzero(_touches_arc(pair, phi1, touch))
    if not rows.size:
        return touch
    starts = _onto_arcs(pair, phi1[rows], _renumbered(climbs, rows, len(phi1)))
    return _merged(touch, rows, _certified(pair, phi1[rows], scan_pinion(pair, phi1[rows]), starts)[0])


def _touches_arc(pair: GearPair, phi1: Array, touch: FirstTouch) -> Mask:
    """Positions (n,) at which the first touch of sharp edges lies where arcs have taken material off."""
    result, rows = np.zeros(len(phi1), dtype=bool), np.flatnonzero(touch.in_contact)
    field = EaseOff(pair, touch.beyond[rows])
    result[rows] = on_arcs(field, phi1[rows], touch.rho[rows], touch.z[rows]).any(axis=-1)
    return result


def _renumbered(climbs: list[_Ascents], rows: Indices, count: int) -> list[_Ascents]:
    """The ascents of some of ``count`` positions, which are numbered anew."""
    number = np.full(count, -1)
    number[rows] = np.arange(rows.size)
    kept = [(ascents, np.flatnonzero(number[ascents.owner] >= 0)) for ascents in climbs]
    return [_Ascents(number[one.owner[at]], one.beyond[at], one.peaks.only(at)) for one, at in kept]


def _merged(touch: FirstTouch, rows: Indices, part: FirstTouch) -> FirstTouch:
    """First touches of which those at some positions are others."""
    merged = {one.name: getattr(touch, one.name).copy() for one in fields(FirstTouch)}
    for name, values in merged.items():
        values[rows] = getattr(part, name)
    return FirstTouch(**merged)


def _onto_arcs(pair: GearPair, phi1: Array, climbs: list[_Ascents]) -> list[_Ascents]:
    """Ascents over flanks with rounded edges from those over sharp ones.

    Ends on no arc stay what they are. From those on arcs that are higher the arcs are climbed.
    """
    on_flank, ends = [], []
    for ascents in climbs:
        at = np.flatnonzero(ascents.peaks.converged)
        owner, beyond, ended = ascents.owner[at], ascents.beyond[at], ascents.peaks.only(at)
        on = on_arcs(EaseOff(pair, beyond), phi1[owner], ended.rho, ended.z)
        on = np.asarray(on.any(axis=-1))
        on_flank.append(_Ascents(owner[~on], beyond[~on], ended.only(~on)))
        ends.append((owner[on], beyond[on], ended.only(on)))
    level = np.full(len(phi1), -np.inf)
    for ascents in on_flank:
        np.maximum.at(level, ascents.owner, ascents.peaks.value)
    starts = []
    for owner, beyond, ended in ends:
        place = np.column_stack([owner, np.stack([ended.rho, ended.z], axis=-1) / (SAME * pair.module), beyond])
        _, first = np.unique(place.round(), axis=0, return_index=True)
        first = first[ended.value[first] > level[owner[first]]]
        own, sides, ended = owner[first], beyond[first], ended.only(first)
        angle = phi1[own]
        rho, z = moved_along_arcs(EaseOff(pair, sides), angle, ended.rho, ended.z, ended.multipliers)
        starts.append((own, rho, z))
    return on_flank + _ascend(pair, phi1, *(np.concatenate(part) for part in zip(*starts, strict=True)))


def _certified(pair: GearPair, phi1: Array, scan: Scan, climbs: list[_Ascents]) -> tuple[FirstTouch, list[_Ascents]]:
    """The highest of the ascents and of more, from whatever the scan and the wheel's flank see above it."""
    result, rows = _best(phi1, climbs), np.arange(len(phi1))
    close = _beside_corners(pair, phi1, result)
    if close[0].size:
        climbs += _ascend(pair, phi1, *close)
        result = _best(phi1, climbs)
    corners, corner_height = region_corners(pair, phi1, scan)
    for _ in range(ROUNDS):
        level = np.full(len(phi1), np.inf)
        level[rows] = result.value[rows] + PIERCED * pair.module
        above = corner_height > level[corners[0]]
        parts = (
            *_missed(pair, phi1, scan, result, rows),
            [part[above] for part in corners],
            _beside_saddles(pair, phi1, result, rows[result.in_contact[rows]]),
        )
        owner, rho, z = (np.concatenate(part) for part in zip(*parts, strict=True))
        if not owner.size:
            return result, climbs
        climbs += _ascend(pair, phi1, owner, rho, z)
        result, rows = _best(phi1, climbs), np.unique(owner)
    missed = np.concatenate([owner for owner, *_ in _missed(pair, phi1, scan, result, rows)])
    if missed.size:
        angle = phi1[missed.min()]
        message = f"unloaded contact: no ascent reached the height of the scan at pinion angle {plain(angle, 6)} rad"
        raise ConvergenceError(message, result)
    return result, climbs


def _missed(pair: GearPair, phi1: Array, scan: Scan, touch: FirstTouch, rows: Indices) -> tuple[Starts, Starts]:
    """Scanned points that are higher than the contacts found, and points of the wheel inside the pinion."""
    higher = scan.higher(rows, touch.value[rows] + CERTIFICATE * pair.base_radii[1])
    rows = rows[touch.in_contact[rows]]
    pierced, *place = inside_pinion(pair, phi1[rows], touch.value[rows], PIERCED * pair.module)
    return higher, (rows[pierced], place[0], place[1])


def _beside_saddles(pair: GearPair, phi1: Array, touch: FirstTouch, rows: Indices) -> Starts:
    """Starts on either side of contacts from which the ease-off rises both ways by its second derivatives."""
    field = EaseOff(pair, touch.beyond[rows])
    held, scale = touch.multipliers[rows], np.asarray(pair.pinion.flank.extent)
    station = field.station(phi1[rows], touch.rho[rows], touch.z[rows])
    bend = (field.hessian(station) + field.edge_hessian(station, held)) * np.outer(scale, scale)
    values, vectors = np.linalg.eigh(bend)
    _, slopes = field.edges(station)
    edge = slopes[np.arange(len(rows)), held.argmax(axis=1)] * scale
    along = np.stack([-edge[:, 1], edge[:, 0]], axis=-1)
    along /= np.maximum(np.linalg.norm(along, axis=-1, keepdims=True), 1e-300)
    count = (held > 0.0).sum(axis=1)
    way = np.where(count[:, None] == 1, along, vectors[:, :, 1])
    rise = np.where(count == 1, np.einsum("ni,nij,nj->n", along, bend, along), values[:, 1]) * (count < 2)
    saddle = np.flatnonzero(0.5 * NUDGE**2 * rise > PIERCED * pair.module)
    owner = np.repeat(rows[saddle], 2)
    step = (NUDGE * way[saddle] * scale)[:, None, :] * np.array([1.0, -1.0])[:, None]
    return owner, touch.rho[owner] + step[..., 0].ravel(), touch.z[owner] + step[..., 1].ravel()


def _beside_corners(pair: GearPair, phi1: Array, touch: FirstTouch) -> Starts:
    """Points on the two edges that meet in a contact, close to it, that are higher.

    Towards a base cone a modification falls like the root of the distance, so that the corner itself may be a maximum.
    """
    rows = np.flatnonzero(touch.in_contact & ((touch.multipliers > 0.0).sum(axis=1) > 1))
    field = EaseOff(pair, touch.beyond[rows])
    scale = np.asarray(pair.pinion.flank.extent)
    station = field.station(phi1[rows], touch.rho[rows], touch.z[rows])
    two = np.argsort(touch.multipliers[rows], axis=1)[:, -2:]
    slopes = np.take_along_axis(field.edges(station)[1] * scale, two[..., None], axis=1)
    along = np.stack([-slopes[..., 1], slopes[..., 0]], axis=-1)
    along /= np.maximum(np.linalg.norm(along, axis=-1, keepdims=True), 1e-300)
    along *= np.sign((along * slopes[:, ::-1]).sum(axis=-1, keepdims=True))
    step = (along[:, :, None, :] * np.array(CLOSE)[:, None] * scale).reshape(-1, 2)
    row = np.repeat(np.arange(len(rows)), 2 * len(CLOSE))
    rho, z = touch.rho[rows[row]] + step[:, 0], touch.z[rows[row]] + step[:, 1]
    value, edges = field.restricted(row).heights(phi1[rows[row]], rho, z)
    inside = edges.min(axis=-1) >= -OFF_EDGE * np.linalg.norm(step, axis=-1)
    higher = inside & (value > touch.value[rows[row]] + PIERCED * pair.module)
    return rows[row[higher]], rho[higher], z[higher]


class _Ascents(NamedTuple):
    """Ascents with the position each belongs to and the smooth piece it stayed on."""

    owner: Indices
    beyond: Mask
    peaks: Maxima


def _ascend(pair: GearPair, phi1: Array, owner: Indices, rho: Array, z: Array) -> list[_Ascents]:
    """Climb from the starts, and on across every relief start that holds an ascent."""
    beyond = EaseOff(pair).sides(phi1[owner], rho, z)
    columns = np.flatnonzero(EaseOff(pair, beyond).edge_is_relief_start())
    climbs, last = [], np.full(len(owner), -1)
    for _ in range(len(columns) + 1):
        peaks = climb(EaseOff(pair, beyond), phi1[owner], rho, z)
        climbs.append(_Ascents(owner, beyond, peaks))
        row, last = _crossings(peaks.multipliers[:, columns], last)
        if not row.size:
            break
        owner, beyond, rho, z = owner[row], beyond[row], peaks.rho[row], peaks.z[row]
        beyond[np.arange(len(row)), last] ^= True
    return climbs


def _crossings(multipliers: Array, last: Indices) -> tuple[Indices, Indices]:
    """Rows of ascents that are held by a relief start other than the last one they crossed, and that relief start."""
    held = (multipliers > 0.0) & (np.arange(multipliers.shape[1]) != last[:, None])
    row, relief_start = np.nonzero(held)
    return row, relief_start


def _best(phi1: Array, climbs: list[_Ascents]) -> FirstTouch:
    """The highest converged ascent of each position."""
    owner = np.concatenate([ascents.owner for ascents in climbs])

    def every(name: str) -> Array:
        return np.concatenate([getattr(ascents.peaks, name) for ascents in climbs])

    height = np.where(every("converged"), every("value"), -np.inf)
    best = np.full(len(phi1), -np.inf)
    np.maximum.at(best, owner, height)
    winners = np.flatnonzero((height == best[owner]) & np.isfinite(height))
    rows, first = np.unique(owner[winners], return_index=True)
    winner = winners[first]
    parts = {name: spread(every(name)[winner], rows, len(phi1)) for name in ("rho", "z", "multipliers", "iterations")}
    beyond = spread(np.concatenate([ascents.beyond for ascents in climbs])[winner], rows, len(phi1))
    return FirstTouch(**parts, value=best, beyond=beyond, in_contact=np.isfinite(best))


def spread(part: NDArray[Any], rows: Indices, count: int) -> NDArray[Any]:
    """Rows of an array of ``count`` rows; the others NaN, False or zero."""
    full = np.full((count, *part.shape[1:]), np.nan if part.dtype.kind == "f" else 0, dtype=part.dtype)
    full[rows] = part
    return full
