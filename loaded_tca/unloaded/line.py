"""Line contact: where the ridge of the ease-off is flat from edge to edge, its ends and its middle.

The solver knows no lines: on a flat ridge it stops somewhere. Here the ridge (the points where the ease-off is
stationary across the soft direction, or the edge that the contact rests on) is followed to the edges by a Newton
iteration on two equations, *on the ridge* and *on edge k*; if the ease-off does not fall towards either end, the
contact is a line. A flat stretch that ends before the edges (end relief alone) is no line, but it is no point
either: its middle stands for it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.unloaded.ease_off import EaseOff
from loaded_tca.unloaded.reduced import FEASIBLE, solve_pairs

FLATNESS = 1e-9
"""Fall of the ease-off towards the edges, relative to the module, below which a contact is called a line."""
WORTH_FOLLOWING = 1e-6
"""Predicted fall over the flank, relative to the module, above which the ridge need not be followed."""
NEARBY = 2e-5
"""Step, as a fraction of the face width, that tells whether the contact lies at the end of a flat stretch."""
RIDGE_STEPS = 40
LONGEST_STRIDE = 0.1
"""Longest step along a ridge, as a fraction of the flank: a longer one leaves a ridge as bent as that of a spiral bevel
gear, beyond whose flank there may be no involute to come back from."""
ASTRAY = 0.3
"""Distance outside the edges, as a fraction of the flank, at which a ridge is followed no further."""
SETTLED = 1e-11
"""Step, as a fraction of the flank, after which the next would be rounding."""
ROUNDING = 2e-15
"""Fall of the ease-off, relative to r_b2, that is rounding."""
BISECTIONS = 14
"""Halvings that find the end of a flat stretch: to a micrometre on a face of 20 mm."""


@dataclass(frozen=True, eq=False)
class Lines:
    """Which contacts are lines, and where.

    Attributes
    ----------
    rows : (m,) int array
        Positions whose contact is a line.
    flat : (k,) int array
        Positions whose contact is a line or lies on a flat stretch that ends before the edges (end relief alone).
    rho, z : (k,) array [mm]
        Middle of each flat stretch on the pinion flank.
    ends : (m, 2, 3) array [mm]
        Its ends in the fixed frame, the one at the smaller z first.
    """

    rows: Indices
    flat: Indices
    rho: Array
    z: Array
    ends: Array


def find_lines(field: EaseOff, phi1: Array, rho: Array, z: Array, multipliers: Array) -> Lines:
    """Lines among the first touches (n,); ``multipliers`` (n, edges) tell the edges they rest on."""
    along, fall = _soft_direction(field, phi1, rho, z, multipliers)
    step = NEARBY * field.pair.pinion.flank.extent[1] * along
    for beside in (step, -step):  # at the start of an end relief the curvature jumps
        other, lower = _soft_direction(field, phi1, rho + beside[:, 0], z + beside[:, 1], multipliers)
        flat = (lower < fall) & (lower <= WORTH_FOLLOWING * field.pair.module)
        along, fall = np.where(flat[:, None], other, along), np.where(flat, lower, fall)
    corner = (multipliers > 0.0).sum(axis=-1) > 1
    rows = np.flatnonzero((fall <= WORTH_FOLLOWING * field.pair.module) & ~corner)
    if not rows.size:
        return Lines(rows, rows, rho[rows], z[rows], np.empty((0, 2, 3)))
    ridge = _Ridge(
        field.restricted(rows), phi1[rows], np.stack([rho, z], axis=-1)[rows], along[rows], multipliers[rows]
    )
    first, second, on_ridge = ridge.ends()
    limit = FLATNESS * field.pair.module
    keep = on_ridge & (ridge.fall(first) <= limit) & (ridge.fall(second) <= limit)
    if (on_ridge & ~keep).any():
        first, second = (np.where(keep[:, None], end, ridge.flat_part(end)) for end in (first, second))
    points = np.stack([ridge.field.station(ridge.phi1, *end.T).point for end in (first, second)], axis=1)
    points = np.take_along_axis(points, np.argsort(points[..., 2:], axis=1), axis=1)
    x, y, z_middle = points.mean(axis=1).T
    middle = ridge.nearest(np.stack([np.hypot(x, y), z_middle], axis=-1))[on_ridge]
    return Lines(rows[keep], rows[on_ridge], middle[:, 0], middle[:, 1], points[keep])


def _soft_direction(field: EaseOff, phi1: Array, rho: Array, z: Array, multipliers: Array) -> tuple[Array, Array]:
    """Direction of least curvature in (rho, z), (n, 2), and the fall [mm] it promises over half the flank."""
    station = field.station(phi1, rho, z)
    bend = field.hessian(station) + field.edge_hessian(station, multipliers)
    scale = np.array(field.pair.pinion.flank.extent)
    values, vectors = np.linalg.eigh(bend * np.outer(scale, scale))
    rows, soft = np.arange(len(rho)), np.argmin(np.abs(values), axis=-1)
    along = vectors[rows, :, soft] * scale
    held = np.flatnonzero((multipliers > 0.0).any(axis=-1))
    _, slopes = field.edges(station)
    edge = slopes[held, multipliers[held].argmax(axis=-1)]
    along[held] = np.stack([-edge[:, 1], edge[:, 0]], axis=-1) * scale[1]
    fall = np.abs(np.einsum("ni,nij,nj->n", along, bend, along)) / 8.0
    return along / np.linalg.norm(along, axis=-1, keepdims=True), fall


@dataclass(frozen=True, eq=False)
class _Ridge:
    """Ridges (m,) through given points, each with its direction and the edge it is bound to, if any."""

    field: EaseOff
    phi1: Array
    start: Array
    along: Array
    multipliers: Array

    def fall(self, points: Array) -> Array:
        """How far the ease-off falls from the start to the points [mm]."""
        heights = [self.field.heights(self.phi1, *where.T)[0] for where in (self.start, points)]
        return heights[0] - heights[1]

    def ends(self) -> tuple[Array, Array, Mask]:
        """Where the ridge leaves the region on either side, (m, 2) each, and whether both ends were found."""
        count, edges = len(self.phi1), len(self.field.edge_owner())
        every = self._only(np.repeat(np.arange(count), edges))
        crossings, met = every._follow(every.start, np.tile(np.arange(edges), count))
        crossings, met = crossings.reshape(count, edges, 2), met.reshape(count, edges)
        travel = ((crossings - self.start[:, None]) * self.along[:, None]).sum(axis=-1)
        rows = np.arange(count)
        first = np.argmin(np.where(met, travel, np.inf), axis=1)
        second = np.argmax(np.where(met, travel, -np.inf), axis=1)
        length = travel[rows, second] - travel[rows, first]
        on_ridge = (met.sum(axis=1) > 1) & (length > FEASIBLE * self.field.pair.pinion.flank.extent[1])
        return crossings[rows, first], crossings[rows, second], on_ridge

    def flat_part(self, end: Array) -> Array:
        """The farthest point of the ridge towards an end, (m, 2), to which the ease-off falls by rounding only."""
        low, high = self.start, end
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + high)
            level = self.fall(self.nearest(middle)) <= ROUNDING * self.field.pair.base_radii[1]
            low, high = np.where(level[:, None], middle, low), np.where(level[:, None], high, middle)
        return self.nearest(low)

    def nearest(self, points: Array) -> Array:
        """Points of the ridge beside the given ones, moved across the ridge only."""
        return self._follow(points, np.full(len(self.phi1), -1))[0]

    def _follow(self, points: Array, edge: Array) -> tuple[Array, Array]:
        """Newton iteration for a point on the ridge and on an edge (-1: on the normal through ``points``)."""
        flank = self.field.pair.pinion.flank
        x, extent, corners = points.copy(), np.asarray(flank.extent), np.stack(flank.grid(2, 2))
        lowest = corners.min(axis=(1, 2)) - 0.5 * extent * [0.2, 1.0]
        highest = corners.max(axis=(1, 2)) + 0.5 * extent
        residual, rows = np.zeros(len(x)), np.arange(len(x))
        for _ in range(RIDGE_STEPS):
            residual[rows], step, room = self._only(rows)._newton(x[rows], points[rows], edge[rows])
            stride = np.abs(step / extent).max(axis=-1)
            step *= np.minimum(1.0, LONGEST_STRIDE / np.maximum(stride, 1e-300))[:, None]
            x[rows] = np.clip(x[rows] + step, lowest, highest)
            rows = rows[(stride > SETTLED) & (room >= -ASTRAY * extent.max())]
            if not rows.size:
                break
        _, distances = self.field.heights(self.phi1, *x.T)
        inside = distances.min(axis=-1, initial=np.inf) >= -FEASIBLE * extent[1]
        return x, inside & (residual <= FEASIBLE * extent[1])

    def _only(self, rows: Indices) -> _Ridge:
        """Some of the ridges, or some of them often."""
        parts = (part[rows] for part in (self.phi1, self.start, self.along, self.multipliers))
        return _Ridge(self.field.restricted(rows), *parts)

    def _newton(self, x: Array, points: Array, edge: Array) -> tuple[Array, Array, Array]:
        """Residual [mm] of the target equation, the step of the two equations together, the room to the edges."""
        station = self.field.station(self.phi1, *x.T)
        distances, slopes = self.field.edges(station)
        across = np.stack([-self.along[:, 1], self.along[:, 0]], axis=-1)
        value = (across * self.field.gradient(station)).sum(axis=-1)
        row = np.einsum("ni,nij->nj", across, self.field.hessian(station))
        held, rows = np.asarray((self.multipliers > 0.0).any(axis=-1)), np.arange(len(x))
        bound = self.multipliers.argmax(axis=-1) if self.multipliers.size else rows
        value = np.where(held, distances[rows, bound], value)
        row = np.where(held[:, None], slopes[rows, bound], row)
        free = edge < 0
        target = np.where(free, ((x - points) * self.along).sum(axis=-1), distances[rows, edge])
        target_row = np.where(free[:, None], self.along, slopes[rows, edge])
        return np.abs(target), -solve_pairs(row, target_row, value, target)[0], distances.min(axis=-1)
