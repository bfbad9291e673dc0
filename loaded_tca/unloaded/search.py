"""Where the flanks touch first: a coarse scan names the basins, the reduced solver climbs each, the best one wins.

A crease (the start of a linear relief) splits a flank into smooth pieces. An ascent stays on its piece, with the smooth
continuation of that piece; if it is held by a crease, the piece beyond is climbed from there, and so on from piece to
piece. A contact that rests on a crease is thus found like one that rests on a border.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from scipy.ndimage import maximum_filter

from loaded_tca.errors import ConvergenceError
from loaded_tca.flanks.jet import Array
from loaded_tca.pair import GearPair
from loaded_tca.unloaded.ease_off import EaseOff
from loaded_tca.unloaded.reduced import FEASIBLE, Maxima, climb

SCAN = (17, 17)
"""Points of the scan along the profile and along the face; none of them may be higher than the contact found."""
BLOCKS = (2, 3)
"""Blocks of the scan, each of which sends its best point up its hill: several basins are found by this."""
BETWEEN = 2.0
"""Spacings of the scan by which every point may miss the common region if there is one between them."""
BORDER_SCAN = (9, 65)
"""Points along the sides and along the tip and root of the wheel's flank that must not lie inside the pinion."""
PIERCED = 1e-9
"""Depth over the module at which a border of the wheel's flank lies inside the pinion: rounding is 1e-13."""
POSITIONS_AT_ONCE = 1024
"""Positions searched together: some 0.1 GB."""
CERTIFICATE = 1e-13
"""How far, relative to r_b2, a scanned point may rise above the maximum found: rounding."""


@dataclass(frozen=True, eq=False)
class FirstTouch:
    """The highest point of the ease-off at each position.

    Attributes
    ----------
    rho, z : (n,) array [mm]
        On the pinion flank; arbitrary where nothing touches.
    value : (n,) array [mm]
        Ease-off.
    multipliers : (n, borders) array
        Slope against each border or crease that holds the point.
    beyond : (n, creases) bool array
        The smooth piece it belongs to.
    iterations : (n,) int array
        Steps of the winning ascent.
    touches : (n,) bool array
        False where the two flanks share no region at all.
    """

    rho: Array
    z: Array
    value: Array
    multipliers: Array
    beyond: Array
    iterations: Array
    touches: Array


def first_touch(pair: GearPair, phi1: Array) -> FirstTouch:
    """Global maximum of the ease-off at each pinion angle (n,) [rad].

    Raises
    ------
    ConvergenceError
        If a position has a common region but no ascent reached the height of the scan.
    """
    blocks = [phi1[start : start + POSITIONS_AT_ONCE] for start in range(0, max(len(phi1), 1), POSITIONS_AT_ONCE)]
    return _joined([_first_touch(pair, block) for block in blocks])


def _joined(parts: list[FirstTouch]) -> FirstTouch:
    if len(parts) == 1:
        return parts[0]
    names = [field.name for field in fields(FirstTouch)]
    return FirstTouch(**{name: np.concatenate([getattr(part, name) for part in parts]) for name in names})


def _first_touch(pair: GearPair, phi1: Array) -> FirstTouch:
    owner, rho, z, scanned = _starts(pair, phi1)
    found = _ascend(pair, phi1, owner, rho, z)
    result = _best(pair, phi1, found, scanned)
    pierced, rho, z = _pierced(pair, phi1, result)
    if pierced.size:
        found = found.joined(_ascend(pair, phi1, pierced, rho, z))
        result = _best(pair, phi1, found, scanned)
    return result


@dataclass(frozen=True, eq=False)
class _Ascents:
    """Ascents with the position each belongs to and the smooth piece it stayed on."""

    owner: Array
    beyond: Array
    peaks: Maxima

    def joined(self, other: _Ascents) -> _Ascents:
        owner, beyond = (np.concatenate([getattr(self, n), getattr(other, n)]) for n in ("owner", "beyond"))
        return _Ascents(owner, beyond, self.peaks.joined(other.peaks))


def _ascend(pair: GearPair, phi1: Array, owner: Array, rho: Array, z: Array) -> _Ascents:
    """Climb from the starts, and on across every crease that holds an ascent."""
    beyond = EaseOff(pair).sides(phi1[owner], rho, z)
    found = latest = _Ascents(owner, beyond, _climb(pair, phi1[owner], rho, z, beyond))
    columns, last = _crease_columns(pair), np.full(len(owner), -1)
    for _ in columns:
        row, last = _crossings(latest.peaks.multipliers[:, columns], last)
        across = latest.beyond[row]
        across[np.arange(len(row)), last] ^= True
        owner, start = latest.owner[row], (latest.peaks.rho[row], latest.peaks.z[row])
        latest = _Ascents(owner, across, _climb(pair, phi1[owner], *start, across))
        found = found.joined(latest)
    return found


def _climb(pair: GearPair, phi1: Array, rho: Array, z: Array, beyond: Array) -> Maxima:
    return climb(EaseOff(pair, beyond if beyond.shape[1] else None), phi1, rho, z)


def _crossings(multipliers: Array, last: Array) -> tuple[Array, Array]:
    """Rows of ascents that are held by a crease other than the last one they crossed, and that crease."""
    held = (multipliers > 0.0) & (np.arange(multipliers.shape[1]) != last[:, None])
    row, crease = np.nonzero(held)
    return row, crease


def _crease_columns(pair: GearPair) -> Array:
    """Columns of the multipliers that belong to creases, the pinion's first."""
    field = EaseOff(pair)
    return np.flatnonzero(EaseOff(pair, np.zeros((1, field.creases), dtype=bool)).border_is_crease())


def _starts(pair: GearPair, phi1: Array) -> tuple[Array, Array, Array, Array]:
    """Hills of the scan: position and place (rho, z) [mm] of each, and the best feasible height of every position."""
    rho, z = pair.pinion.grid(*SCAN)
    shape, field = (len(phi1), *SCAN), EaseOff(pair)
    full = [np.broadcast_to(part, shape) for part in (rho, z)]
    value, borders = field.heights(np.broadcast_to(phi1[:, None, None], shape), *full)
    lack = np.maximum(0.0, -borders).sum(axis=-1)
    feasible = lack <= FEASIBLE
    score = np.where(feasible, value, np.minimum(value.min() - 1.0, -1.0) * (1.0 + lack))
    owner, i, j = np.nonzero(_hills(score) & _within_reach(pair, borders)[:, None, None])
    return owner, rho[i, j], z[i, j], np.where(feasible, value, -np.inf).max(axis=(1, 2))


def _within_reach(pair: GearPair, borders: Array) -> Array:
    """Whether a common region may lie between the points of the scan (n,): borders are no farther than their spacing.

    The distances to the borders change by about a millimetre per millimetre along the flank.
    """
    height, width = pair.pinion.extent
    spacing = np.hypot(height / (SCAN[0] - 1), width / (SCAN[1] - 1))
    return borders.min(axis=-1).max(axis=(1, 2)) >= -BETWEEN * spacing


def _hills(score: Array) -> Array:
    """The best point of each block of the scan, if no neighbour is higher: (n, *SCAN) bool.

    A ridge across the grid shows many such points; the blocks keep them few.
    """
    hills = np.zeros(score.shape, dtype=bool)
    rows = np.arange(len(score))
    for profile in np.array_split(np.arange(SCAN[0]), BLOCKS[0]):
        for lengthwise in np.array_split(np.arange(SCAN[1]), BLOCKS[1]):
            block = score[:, profile[0] : profile[-1] + 1, lengthwise[0] : lengthwise[-1] + 1]
            best = block.reshape(len(score), -1).argmax(axis=1)
            hills[rows, profile[best // len(lengthwise)], lengthwise[best % len(lengthwise)]] = True
    return hills & (score >= maximum_filter(score, size=(1, 3, 3), mode="nearest"))


def _pierced(pair: GearPair, phi1: Array, touch: FirstTouch) -> tuple[Array, Array, Array]:
    """Positions at which a border of the wheel's flank lies inside the pinion, and where: (rho, z) there [mm].

    The scan sees the whole of the pinion's flank; of the wheel's only its borders can hide from it.
    """
    rho, z = (_border(part) for part in pair.wheel.grid(*BORDER_SCAN))
    wheel_angle = pair.driving * touch.value / pair.base_radii[1] + pair.ratio * phi1
    theta = pair.wheel.theta(rho, z).value - pair.sense * wheel_angle[:, None]
    own = np.stack([rho * np.cos(theta), rho * np.sin(theta), np.broadcast_to(z, theta.shape)], axis=-1)
    x, y, axial = np.moveaxis(own @ pair.wheel_axes + pair.wheel_origin, -1, 0)
    radius = np.hypot(x, y)
    ahead = phi1[:, None] - pair.sense * (np.arctan2(y, x) - pair.pinion.theta(radius, axial).value)
    depth = pair.driving * pair.base_radii[0] * (np.remainder(ahead + np.pi, 2.0 * np.pi) - np.pi)
    depth = np.where(pair.pinion.inside(radius, axial), depth, -np.inf)
    rows = np.flatnonzero((depth.max(axis=1) > PIERCED * pair.module) & touch.touches)
    deepest = depth[rows].argmax(axis=1)
    return rows, radius[rows, deepest], axial[rows, deepest]


def _border(grid: Array) -> Array:
    """The outermost points of a grid, one after the other."""
    return np.concatenate([grid[0], grid[-1], grid[1:-1, 0], grid[1:-1, -1]])


def _best(pair: GearPair, phi1: Array, found: _Ascents, scanned: Array) -> FirstTouch:
    """The highest converged ascent of each position, certified against the scan."""
    owner, beyond, peaks = found.owner, found.beyond, found.peaks
    height = np.where(peaks.converged, peaks.value, -np.inf)
    best = np.full(len(phi1), -np.inf)
    np.maximum.at(best, owner, height)
    winners = np.flatnonzero((height == best[owner]) & np.isfinite(height))
    rows, first = np.unique(owner[winners], return_index=True)
    winner = winners[first]

    def spread(part: Array) -> Array:
        full = np.zeros((len(phi1), *part.shape[1:]), dtype=part.dtype)
        full[rows] = part[winner]
        return full

    result = FirstTouch(
        rho=spread(peaks.rho),
        z=spread(peaks.z),
        value=spread(peaks.value),
        multipliers=spread(peaks.multipliers),
        beyond=spread(beyond),
        iterations=spread(peaks.iterations),
        touches=np.isfinite(best),
    )
    short = np.isfinite(scanned) & (best < scanned - CERTIFICATE * pair.base_radii[1])
    if short.any():
        row = int(np.flatnonzero(short)[0])
        message = f"unloaded contact: no ascent reached the height of the scan at pinion angle {phi1[row]:.6g} rad"
        raise ConvergenceError(message, result)
    return result
