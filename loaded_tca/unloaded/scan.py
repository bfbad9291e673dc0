"""Points of both flanks that see what an ascent may have missed: where to start, and which contacts to search again.

The pinion's flank is seen by a grid and by dense points on its edges, which tell heights of the ease-off, and where its
edges leave the wheel's flank, in the corners of the common region; the wheel's by its own grid and edges, which must
not lie inside the pinion once the wheel stands where the contact found puts it. Beside the edges points know how far
from them they are, on which arcs of a rounding, and where on these a contact is likely.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.edges.places import lengths_past_tangents
from loaded_tca.flanks.base import EDGE_NAMES, Flank
from loaded_tca.flanks.rounding import RoundedFlank
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.unloaded.ease_off import EaseOff, Station
from loaded_tca.unloaded.reduced import ROOM

ALIKE = 0.7
"""Cosine of the angle between two edges above which a point on both arcs is moved across one of them only."""

FLATTEST = 0.1
"""Ratio of singular values below which two edges that are left count as one."""


def past_tangents(station: Station) -> Array:
    """Lengths (n, 8) [mm] from where the arcs of all edges begin, the pinion's first; -inf at sharp edges."""
    return lengths_past_tangents(station.pair, (station.rho, station.z), (station.wheel_rho, station.wheel_z))


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


GRID = (17, 17)
"""Points of the scan along the profile and along the face."""
EDGE = 33
"""Points along each edge of the pinion's flank."""
WHEEL_GRID, WHEEL_EDGE = (9, 17), 65
"""The same of the wheel's flank, whose edges the pinion's grid does not see: a contact on them may be short."""
WHEEL_EDGES = slice(4, 8)
"""Columns of the edges of the wheel's flank."""
AT_ONCE = 16
"""Positions looked at together."""
CORNER_STEPS = 4
"""Steps of false position from a spacing of edge points to a corner: its square, three times over."""
ON_EDGE = 1e-8
"""Distance [mm] within which points lie on an edge: those of grids over fitted flanks are off by up to 4e-9."""
LEVEL = 1e-11
"""Difference of heights [mm] that is rounding: on a level ridge one start is enough."""
BETWEEN = 2.0
"""Spacings of the scan by which every point may miss the common region if there is one between them."""

Starts = tuple[Indices, Array, Array]
"""Position each start belongs to, and its place (rho, z) on the pinion flank [mm]."""


@dataclass(frozen=True, eq=False)
class Scan:
    """The ease-off at points of the pinion flank, the grid first, then the edges.

    Attributes
    ----------
    rho, z : (k,) array [mm]
    height : (n, k) array [mm]
        Ease-off at each of n positions; -inf outside the common region.
    score : (n, *GRID) array
        The same on the grid; outside, lower than any height, and the lower the farther.
    reach : (n,) bool array
        Whether a common region may lie between the points of the scan.
    """

    rho: Array
    z: Array
    height: Array
    score: Array
    reach: Mask

    def only(self, rows: Indices) -> Scan:
        """The scan at some of the positions."""
        return replace(self, height=self.height[rows], score=self.score[rows], reach=self.reach[rows])

    def hills(self) -> Starts:
        """Starts, one or more for each basin: the summits of the ridges along the face and along the profile."""
        inside = np.isfinite(self.height[:, : GRID[0] * GRID[1]]).reshape(self.score.shape)
        turned = _summits(np.swapaxes(self.score, 1, 2), np.swapaxes(inside, 1, 2))
        hills = _summits(self.score, inside) | np.swapaxes(turned, 1, 2)
        hills &= self.reach[:, None, None]
        owner, point = np.nonzero(hills.reshape(len(hills), GRID[0] * GRID[1]))
        return owner, self.rho[point], self.z[point]

    def higher(self, rows: Indices, value: Array) -> Starts:
        """The highest point of each of some positions, where it is higher than ``value`` (rows,) [mm]."""
        height = self.height[rows]
        best = height.argmax(axis=1)
        above = np.flatnonzero(height[np.arange(len(rows)), best] > value)
        return rows[above], self.rho[best[above]], self.z[best[above]]


def region_corners(pair: GearPair, phi1: Array, scan: Scan) -> tuple[Starts, Array]:
    """Corners of the common regions, and their ease-off [mm]: where the pinion's edges cross those of the wheel.

    They lie between neighbouring points of an edge of which one is in the common region, the other is not, and are
    placed to about 1e-9 of that spacing.
    """
    field, numbers = EaseOff(pair), np.arange(2 * EDGE)
    # points of the scan along each of the four edges, (4, EDGE)
    chains = np.concatenate([numbers.reshape(EDGE, 2).T, 2 * EDGE + numbers.reshape(2, EDGE)]) + GRID[0] * GRID[1]
    inside = np.isfinite(scan.height)[:, chains]
    owner, edge, place = np.nonzero(inside[..., 1:] != inside[..., :-1])
    first, last = chains[edge, place], chains[edge, place + 1]
    angle = phi1[owner]

    def look(share: Array) -> tuple[Array, Array, Array, Array]:
        rho, z = (part[first] + share * (part[last] - part[first]) for part in (scan.rho, scan.z))
        value, edges = field.heights(angle, rho, z)
        return rho, z, value, edges[:, WHEEL_EDGES].min(axis=-1)

    ends = np.stack([np.zeros(len(owner)), np.ones(len(owner))])
    room = np.stack([look(end)[3] for end in ends])
    for _ in range(CORNER_STEPS):
        fall = room[0] - room[1]
        share = ends[0] + (ends[1] - ends[0]) * np.clip(room[0] / np.where(fall == 0.0, 1.0, fall), 0.0, 1.0)
        rho, z, value, here = look(share)
        side = (np.sign(here) != np.sign(room[0])).astype(int)
        ends[side, np.arange(len(owner))], room[side, np.arange(len(owner))] = share, here
    return (owner, rho, z), value


def scan_pinion(pair: GearPair, phi1: Array) -> Scan:
    """Scan of the pinion flank at each pinion angle (n,) [rad]."""
    rho, z = _points(pair.pinion.flank, GRID, EDGE)
    field, count, allowed = EaseOff(pair), GRID[0] * GRID[1], ROOM * pair.pinion.flank.extent[0]

    def look(block: Array) -> tuple[Array, Array, Array]:
        full = [np.broadcast_to(part, (len(block), len(rho))) for part in (rho, z)]
        value, edges = field.heights(np.broadcast_to(block[:, None], full[0].shape), *full)
        lack = np.maximum(0.0, -edges).sum(axis=-1)
        return value, lack, edges[:, :count].min(axis=-1).max(axis=1)

    value, lack, room = _in_blocks(look, phi1)
    height = np.where(lack <= allowed, value, -np.inf)
    outside = min(float(value.min(initial=0.0)) - 1.0, -1.0) * (1.0 + lack[:, :count])
    score = np.where(lack[:, :count] <= allowed, value[:, :count], outside)
    # distances to the edges change by about a millimetre per millimetre
    spacing = math.hypot(
        *(length / (number - 1) for length, number in zip(pair.pinion.flank.extent, GRID, strict=True))
    )
    return Scan(rho, z, height, score.reshape(len(phi1), *GRID), room >= -BETWEEN * spacing)


def inside_pinion(pair: GearPair, phi1: Array, value: Array, depth: float) -> Starts:
    """Positions at which a point of the wheel's flank lies deeper than ``depth`` [mm] inside the pinion, and where.

    Parameters
    ----------
    pair : GearPair
    phi1, value : (n,) array [rad, mm]
        Pinion angles, and the ease-off that tells where the wheel stands.
    depth : float [mm]
    """
    rho, z = _points(pair.wheel.flank, WHEEL_GRID, WHEEL_EDGE)
    there = pair.wheel.flank.inside(rho, z, ON_EDGE)  # off the arc of one edge a point may have left another one
    rho, z = rho[there], z[there]
    own_theta = pair.wheel.flank.theta(rho, z).value
    wheel_angle = pair.driving * value / pair.base_radii[1] + pair.ratio * phi1

    def look(angle: Array, wheel_angle: Array) -> tuple[Array, Array, Array]:
        theta = own_theta - pair.sense * wheel_angle[:, None]
        own = np.stack([rho * np.cos(theta), rho * np.sin(theta), np.broadcast_to(z, theta.shape)])
        x, y, axial = np.tensordot(pair.wheel_axes.T, own, axes=1) + pair.wheel_origin[:, None, None]
        radius = np.hypot(x, y)
        ahead = angle[:, None] - pair.sense * (np.arctan2(y, x) - pair.pinion.flank.theta(radius, axial).value)
        lead = pair.driving * pair.base_radii[0] * (np.remainder(ahead + np.pi, 2.0 * np.pi) - np.pi)
        lead = np.where(pair.pinion.flank.inside(radius, axial), lead, -np.inf)
        rows, deepest = np.arange(len(angle)), lead.argmax(axis=1)
        return lead[rows, deepest], radius[rows, deepest], axial[rows, deepest]

    lead, radius, axial = _in_blocks(look, phi1, wheel_angle)
    rows = np.flatnonzero(lead > depth)
    return rows, radius[rows], axial[rows]


def _in_blocks(look: Callable[..., tuple[Array, ...]], *columns: Array) -> list[Array]:
    """Results of ``look`` for a few positions at a time, which stay in the processor's cache."""
    starts = range(0, max(len(columns[0]), 1), AT_ONCE)
    parts = [look(*(column[start : start + AT_ONCE] for column in columns)) for start in starts]
    return [np.concatenate(part) for part in zip(*parts, strict=True)]


def _summits(score: Array, inside: Mask) -> Mask:
    """Summits along the last axis (n, i, j) of the ridge that the highest points across it make.

    A ridge seen on a grid is a chain of false summits; the parabola through three points across it tells its height.
    """
    rows, columns = np.ogrid[: len(score), : score.shape[2]]
    across = score.argmax(axis=1)
    inner = np.clip(across, 1, score.shape[1] - 2)
    below, top, above = (score[rows, inner + k, columns] for k in (-1, 0, 1))
    known = (across == inner) & inside[rows, inner - 1, columns] & inside[rows, inner + 1, columns]
    bend = np.where(known, np.maximum(2.0 * top - below - above, 1e-300), 1.0)
    ridge = score[rows, across, columns] + np.where(known, (above - below) ** 2 / (8.0 * bend), 0.0)
    step, edge = np.diff(ridge, axis=1), np.ones((len(score), 1), dtype=bool)
    risen, falls = np.hstack([edge, step >= -LEVEL]), np.hstack([step < -LEVEL, edge])
    summits = np.zeros(score.shape, dtype=bool)
    summits[rows, across, columns] = risen & falls
    return summits


def _points(flank: Flank, shape: tuple[int, int], edge: int) -> tuple[Array, Array]:
    """(rho, z) of a grid over the flank and of dense points on its four edges, or where their arcs begin [mm]."""
    grids = (flank.grid(*shape), flank.grid(edge, 2), flank.grid(2, edge))
    rho, z = (np.concatenate([grid[k].ravel() for grid in grids]) for k in (0, 1))
    return flank.off_arcs(rho, z) if isinstance(flank, RoundedFlank) else (rho, z)
