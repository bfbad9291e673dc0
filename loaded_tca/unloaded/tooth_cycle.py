r"""The way of one tooth pair through the mesh, which all others repeat a pitch later.

Whatever many teeth do follows from the height h(x) of one of them [mm]: the ease-off of its first touch at the own
pinion angle x. Pair k has h(phi1 - k pitch) and the envelope is

.. math:: H(\varphi_1) = \max_k h(\varphi_1 - k\,2\pi/z_1) .

The height is sampled at 32 angles per pitch, at the same places for each tooth; what lies between is found by root
finding, so that no result depends on the positions that a user asks for.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.errors import GeometryError
from loaded_tca.flanks.base import EDGE_NAMES
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.roots import find_roots
from loaded_tca.unloaded.ease_off import EaseOff
from loaded_tca.unloaded.path import ContactPoint, trace_contact
from loaded_tca.unloaded.search import first_touch

REACH = 0.05
"""Initial separation, as a length at r_b2 over the module, beyond which a tooth pair counts as apart: no load that
gears bear closes it."""
COINCIDE = 1e-13
"""Difference of transmission errors [rad] that is rounding: the pair nearer to its pitch point then leads."""
SAMPLES = 32
"""Angles per pitch at which the height is sampled."""
SCANS = 8
"""Angles per pitch at which the reach is looked for."""
SCAN = (9, 17)
"""Points of a flank along the profile and along the face that tell the reach."""
NUDGE = 1e-5
"""Half the way over which a slope is taken [rad]: rounding 1e-14/NUDGE, truncation NUDGE^2."""
LEVEL = 1e-11
"""Change of the transmission error between two samples [rad] that is rounding of the slope, no summit."""
CLOSE = 1e-11
"""Accuracy of a transfer point [rad]."""
EDGE = 1e-8
"""Accuracy of the angle at which a tooth pair begins or ceases to touch [rad]."""
SUMMIT = 1e-6
"""Accuracy of the angle of a summit [rad]: a round one is then right to rounding, a crest to 1e-5 of its
height. Closer to a crest where two edges meet the ascents may fail."""
NEARER = 1e-6
"""Part of a pitch by which the later pair counts as farther, so that no two are equally far from their pitch points."""

SECTIONS, SECTION_PASSES = 16, 4
"""The end of a surface contact is found by cutting a pitch into 16 parts, four times over."""
ENDS = 4
"""The tips and roots of both gears come first in the order of ``_edges_held``, before the sides."""


@dataclass(frozen=True, eq=False)
class ToothCycle:
    """Height of one tooth pair over its own pinion angle, wherever it is within reach of the leading one.

    Attributes
    ----------
    pair : GearPair
    first : int
        The samples lie at the own pinion angles (first, first + 1, ...) times ``step``.
    height : (w,) array [mm]
        Ease-off of the first touch; -inf without a common region.
    slope : (w,) array [mm/rad]
        Its derivative.
    """

    pair: GearPair
    first: int
    height: Array
    slope: Array

    @property
    def step(self) -> float:
        """Between two samples [rad]."""
        return self.pair.pitch / SAMPLES

    @cached_property
    def own(self) -> Array:
        """Own pinion angles of the samples [rad]."""
        return self.step * (self.first + np.arange(len(self.height), dtype=float))

    def heights(self, angle: Array, teeth: Indices) -> Array:
        """Heights (m, n) [mm] of the tooth pairs (m,) at pinion angles (n,); -inf out of reach."""
        own = angle - teeth[:, None] * self.pair.pitch
        heights_of = np.full(own.shape, -np.inf)
        rows = (own >= self.own[0]) & (own <= self.own[-1])
        heights_of[rows] = first_touch(self.pair, own[rows]).value
        return heights_of

    def sampled(self, index: Indices, teeth: Indices) -> Array:
        """The same heights at the pinion angles index * step, from the samples."""
        place = index - teeth[:, None] * SAMPLES - self.first
        inside = (place >= 0) & (place < len(self.height))
        return np.where(inside, self.height[np.where(inside, place, 0)], -np.inf)

    @cached_property
    def extrema(self) -> Array:
        """Own pinion angles at which the height is level, from above or below [rad]."""
        rounding = LEVEL * self.pair.base_radii[1] / self.step
        ends = np.stack([self.slope[:-1], self.slope[1:]])
        turn = (ends[0] * ends[1] < 0.0) & (np.abs(ends).max(axis=0) > rounding)
        rows = np.flatnonzero(turn & np.isfinite(self.height[:-1] + self.height[1:]))
        brackets = np.stack([self.own[rows], self.own[rows + 1]])
        return find_roots(lambda own, _: height_and_slope(self.pair, own)[1], brackets, ends[:, rows], SUMMIT)

    def peaks(self, low: float, high: float, teeth: Indices) -> Array:
        """Envelope [mm] of the tooth pairs (m,) wherever one of them is level between two pinion angles."""
        angle = (self.extrema + teeth[:, None] * self.pair.pitch).ravel()
        top = self.heights(angle[(angle > low) & (angle < high)], teeth).max(axis=0)
        return top[np.isfinite(top)]

    def share_in_contact(self, separation: float) -> float:
        """Pitches over which the initial separation of a tooth pair from the best other one is no larger [mm]."""
        count, most = len(self.height) // SAMPLES + 1, 2.0 * REACH * self.pair.module
        teeth = np.concatenate([[0], np.arange(-count, 0), np.arange(1, count + 1)])

        def excess(heights: Array) -> Array:
            """Separation less what is allowed, kept within bounds; out of reach it is too much."""
            own, best = np.maximum(heights[0], -self._far), np.maximum(heights[1:].max(axis=0), -self._far)
            return np.where(own > -self._far, np.clip(best - own, -most, most), most) - separation

        index = self.first + np.arange(-1, len(self.height) + 1)
        sample = excess(self.sampled(index, teeth))
        rows = np.flatnonzero(np.diff(sample <= 0.0))
        rows = np.stack([rows, rows + 1])
        near = self.step * index[rows].astype(float)
        roots = find_roots(lambda own, _: excess(self.heights(own, teeth)), near, sample[rows], EDGE)
        return float((roots[1::2] - roots[::2]).sum()) / self.pair.pitch

    def changes(self, low: float, high: float, teeth: Indices) -> tuple[Array, Indices]:
        """Pinion angles (n,) between two others at which the lead changes, and the pairs before and after (2, n)."""
        index = np.arange(math.floor(low / self.step) + 1, math.ceil(high / self.step))
        ends = self.heights(np.array([low, high]), teeth)
        heights = np.concatenate([ends[:, :1], self.sampled(index, teeth), ends[:, 1:]], axis=1)
        angle = np.concatenate([[low], index * self.step, [high]])
        lead = teeth[leading(self.pair, heights, angle, teeth)]
        rows = np.flatnonzero(np.diff(lead))
        old_new, brackets = np.stack([lead[rows], lead[rows + 1]]), np.stack([angle[rows], angle[rows + 1]])

        def difference(at: Array, which: Indices) -> Array:
            own = (at - old_new[:, which] * self.pair.pitch).ravel()
            before, after = np.maximum(first_touch(self.pair, own).value, -self._far).reshape(2, -1)
            return before - after

        every = np.arange(len(rows))
        values = np.stack([difference(side, every) for side in brackets])
        roots = find_roots(difference, brackets, values, CLOSE)
        tie = np.abs(values).max(axis=0) <= COINCIDE * self.pair.base_radii[1]
        roots[tie] = np.clip(0.5 * old_new.sum(axis=0) * self.pair.pitch, *brackets)[tie]
        return roots, old_new

    @property
    def _far(self) -> float:
        """Stands for the depth of a tooth pair without a common region [mm]."""
        return 1e3 * self.pair.module


def tooth_cycle(pair: GearPair) -> ToothCycle:
    """Height of one tooth pair wherever it is within reach of the leading one.

    Raises
    ------
    GeometryError
        If the flanks of no tooth pair share a region.
    """
    low, high = (angle / pair.pitch * SAMPLES for angle in reach(pair))
    index = np.arange(math.floor(low), math.ceil(high) + 1)
    return ToothCycle(pair, int(index[0]), *height_and_slope(pair, index.astype(float) * (pair.pitch / SAMPLES)))


def reach(pair: GearPair, farthest: float = REACH) -> tuple[float, float]:
    """Own pinion angles [rad] between which a tooth pair can be within reach of the leading one, and a step more.

    A coarse scan of the flank is enough: it misses the height of the first touch by far less than the reach.

    Parameters
    ----------
    pair : GearPair
    farthest : float
        Initial separation up to which a pair is within reach, as a length at r_b2 over the module.

    Raises
    ------
    GeometryError
        If the flanks of no tooth pair share a region.
    """
    step, first, last = pair.pitch / SCANS, -2, 2
    height, common = _scan(pair, range(first, last + 1))
    while True:
        best = height.max(axis=0)
        near = (np.isfinite(height) if np.isfinite(best).any() else common) & (height >= best - farthest * pair.module)
        if not near[[0, -1]].any():
            break
        first, last = first - 1, last + 1
        parts = zip((height, common), _scan(pair, (first, last)), strict=True)
        height, common = (np.concatenate([more[:1], known, more[1:]]) for known, more in parts)
    if not near.any():
        raise GeometryError(
            "no common flank: the flanks of no tooth pair cover a common region; check the tips of the "
            "teeth and how the gears are mounted"
        )
    within = step * (first * SCANS + np.flatnonzero(near))
    return float(within[0]) - step, float(within[-1]) + step


def pitches_within_reach(pair: GearPair) -> int:
    """How many pitches two tooth pairs are apart at the most that are within reach at the same place of a pitch.

    Whatever positions are asked for. The reach lies between its ends in one piece, of which the scan knows each to a
    step: so many pitches fit into it, or the last one just does not.

    Raises
    ------
    GeometryError
        If the flanks of no tooth pair share a region.
    """
    low, high = reach(pair)
    step, most = pair.pitch / SAMPLES, math.floor((high - low) / pair.pitch)
    first, last = math.ceil(low / step), math.floor(high / step) - most * SAMPLES
    if last - first > 2 * SAMPLES // SCANS:  # beyond what the scan does not know
        return most
    own = step * (np.arange(first, last + 1) + SAMPLES * np.arange(most + 1)[:, None]).astype(float)
    heights = first_touch(pair, own.ravel()).value.reshape(own.shape)
    near = np.isfinite(heights) & (heights >= heights.max(axis=0) - REACH * pair.module)
    return most if (near[0] & near[-1]).any() else max(most - 1, 0)


def _scan(pair: GearPair, pitches: Sequence[int]) -> tuple[Array, Array]:
    """Highest point of a coarse grid over some pitches [mm], -inf if none is common; whether one nearly is.

    Both are (pitches, SCANS); nearly means within two spacings of the grid.
    """
    pair = pair.sharp  # the arcs of rounded edges are far smaller than the reach
    flank, own = pair.pinion.flank, pair.pitch * np.add.outer(pitches, np.arange(SCANS) / SCANS)
    value, edges = EaseOff(pair).heights(*np.broadcast_arrays(own[..., None, None], *flank.grid(*SCAN)))
    inside = edges.min(axis=-1)
    height = np.where(inside >= 0.0, value, -np.inf).max(axis=(-2, -1))
    spacing = math.hypot(flank.extent[0] / (SCAN[0] - 1), flank.extent[1] / (SCAN[1] - 1))
    return height, inside.max(axis=(-2, -1)) >= -2.0 * spacing


def teeth_between(low: float, high: float, window: tuple[float, float], pitch: float) -> Indices:
    """Tooth pairs whose own angle comes into the window between two pinion angles, in the order 0, +1, -1, ..."""
    first, last = math.ceil((low - window[1]) / pitch), math.floor((high - window[0]) / pitch)
    return np.array(sorted(range(first, last + 1), key=lambda k: (abs(k), -k)), dtype=int)


def leading(pair: GearPair, heights: Array, phi1: Array, teeth: Indices) -> Indices:
    """Row of the leading pair (n,) for heights (m, n) [mm]; of equals, the one nearer to its pitch point."""
    distance = np.abs(phi1 / pair.pitch - teeth[:, None]) + NEARER * teeth[:, None]
    tie = heights >= heights.max(axis=0) - COINCIDE * pair.base_radii[1]
    return np.asarray(np.where(tie, distance, np.inf).argmin(axis=0))


def height_and_slope(pair: GearPair, own: Array) -> tuple[Array, Array]:
    r"""Height h (n,) [mm] of the first touch and dh/d own [mm/rad]; -inf and zero without a common region.

    The point of contact moves, but to first order only what changes at a fixed point counts: with the multipliers
    :math:`\lambda_b` of the edges c_b that hold it, :math:`h' = \partial e/\partial\varphi_1 + \sum_b \lambda_b\,
    \partial c_b/\partial\varphi_1`.
    """
    touch, slope = first_touch(pair, own), np.zeros(len(own))
    rows = np.flatnonzero(touch.in_contact)
    if rows.size:
        field = EaseOff(pair, touch.beyond[rows])
        (after, on), (before, back) = (
            field.heights(own[rows] + way * NUDGE, touch.rho[rows], touch.z[rows]) for way in (1.0, -1.0)
        )
        slope[rows] = (after - before + (touch.multipliers[rows] * (on - back)).sum(axis=-1)) / (2.0 * NUDGE)
    return touch.value, slope


@dataclass(frozen=True, eq=False)
class Transfer:
    """Where one tooth pair hands over to another.

    Attributes
    ----------
    pinion_angle : float [rad]
    transmission_error : float [rad]
    pairs : (int, int)
        The leading pair before and after.
    contacts : (ContactPoint, ContactPoint)
        Of the two pairs, each in its own angles.
    """

    pinion_angle: float
    transmission_error: float
    pairs: tuple[int, int]
    contacts: tuple[ContactPoint, ContactPoint]

    @property
    def is_continuous(self) -> bool:
        """Whether the curves cross inside both their ranges.

        Neither contact rests on a tip or a root, where the path of contact has come to its end. Flanks that touch
        along their sides all the way (misaligned, without lead crowning) have curves of their own, which may cross; a
        side that only one of the two contacts rests on is an end like a tip.
        """
        first, second = self._edges
        return not first[:ENDS].any() and bool((first == second).all())

    def jump(self, pair: GearPair) -> float:
        """Change of the transmission error over the edge contact [rad]; NaN if none but that within a pitch."""
        if self.is_continuous:
            return 0.0
        common = self._edges[0] & self._edges[1]
        common[:ENDS] = False
        before, after = (_end_of(pair, one, common, way) for one, way in zip(self.contacts, (-1.0, 1.0), strict=True))
        return after - before

    @property
    def _edges(self) -> tuple[Mask, Mask]:
        first, second = (_edges_held(contact.edges) for contact in self.contacts)
        return first, second


def find_transfers(cycle: ToothCycle, low: float, high: float, teeth: Indices) -> tuple[Transfer, ...]:
    """Transfers among tooth pairs between two pinion angles, in their order."""
    angles, pairs = cycle.changes(low, high, teeth)
    if not len(angles):
        return ()
    path = trace_contact(cycle.pair, (angles - pairs * cycle.pair.pitch).ravel(), warn=False)
    return tuple(
        Transfer(
            float(angle), float(path.transmission_error[k]), (int(old), int(new)), (path[k], path[k + len(angles)])
        )
        for k, (angle, old, new) in enumerate(zip(angles, *pairs, strict=True))
    )


def _edges_held(edges: Mask) -> Mask:
    """Tips and roots of both gears, then the sides of either: where two faces end together, their edges alternate."""
    pinion, wheel = edges[..., : len(EDGE_NAMES)], edges[..., len(EDGE_NAMES) :]
    return np.concatenate([pinion[..., :2], wheel[..., :2], pinion[..., 2:] | wheel[..., 2:]], axis=-1)


def _end_of(pair: GearPair, contact: ContactPoint, edges: Mask, way: float) -> float:
    """Transmission error where a contact rests on ``edges`` alone again, going one way; NaN if not within a pitch."""
    start, length = contact.pinion_angle, way * pair.pitch
    for _ in range(SECTION_PASSES):
        path = trace_contact(pair, start + length * np.linspace(0.0, 1.0, SECTIONS + 1), warn=False)
        free = path.in_contact & (_edges_held(path.edges) == edges).all(axis=-1)
        if not free.any():
            return math.nan
        first = int(free.argmax())
        if first == 0:
            break
        start, length = float(path.pinion_angle[first - 1]), length / SECTIONS
    return float(path.transmission_error[first])
