"""Contour of a contact area: rays from the contact point, and where the gap or the end of a flank stops each."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arrays import Array
from loaded_tca.flank_maps.rotary_gap import cartesian, flank_gap
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.unloaded.path import ContactPoint

SCAN = 65
"""Points of a ray at which its first crossing of the contour is looked for."""
BISECTIONS = 40
SECTOR = 1e-6
"""Part of the area that may hide between two rays."""
MOST_HALVINGS = 40
JUMP, EDGE_POINTS = 0.01, 15
"""Lengths of neighbouring rays that differ by more than this part run along an edge, which then has so many points."""


@dataclass(frozen=True, eq=False)
class Contour:
    """Ends of rays (m,): angle, share of the ray, place on the pinion, place in the tangent plane, what ends them."""

    turn: Array
    share: Array
    rho: Array
    z: Array
    x: Array
    y: Array
    edge: NDArray[np.int_]

    def __getitem__(self, rows: Any) -> Contour:
        return Contour(*(getattr(self, field.name)[rows] for field in fields(self)))

    def rolled(self) -> Contour:
        """The ends of the next rays."""
        return self[np.arange(1, len(self.turn) + 1) % len(self.turn)]

    def with_inserted(self, others: Contour, before: NDArray[np.int_]) -> Contour:
        """These ends and others, each before the row given."""
        pairs = ((getattr(self, field.name), getattr(others, field.name)) for field in fields(self))
        return Contour(*(np.insert(own, before, other) for own, other in pairs))

    @property
    def area(self) -> float:
        """Enclosed area in the tangent plane [mm^2]."""
        return abs(float(_sectors(self, self.rolled()).sum()))


@dataclass(frozen=True, eq=False)
class RaySearch:
    """Rays from a contact point in (rho, z), and where the gap reaches the compound on each.

    ``drawn`` (2, 2): the semi-axes of the ellipse that the rays fill, along the directions ``plane`` (2, 3), as steps
    of (rho, z); ``size``: their product [mm^2].
    """

    pair: GearPair
    contact: ContactPoint
    plane: Array
    drawn: Array
    size: float
    compound: float

    @property
    def angles(self) -> tuple[Array, Array]:
        """phi1 and phi2 of the contact."""
        return np.asarray(self.contact.pinion_angle), np.asarray(self.contact.wheel_angle)

    def in_space(self, rho: Array, z: Array) -> Array:
        """Points (m, 3) of the pinion flank in the fixed frame."""
        azimuth = self.pair.pinion.flank.theta(rho, z).value + self.pair.sense * self.contact.pinion_angle
        return cartesian(rho, azimuth, z)

    def contour(self, rays: int) -> Contour:
        """Ends of rays at even angles, and of those between them that the area needs."""
        ends = self._ends(np.arange(rays + 1) * (2.0 * math.pi / rays))
        low = np.arange(rays)
        for _ in range(MOST_HALVINGS):
            first, last = ends[low], ends[low + 1]
            allowed = SECTOR * abs(_sectors(ends[:-1], ends[1:]).sum())
            middle = self._ends(0.5 * (first.turn + last.turn))
            hidden = np.abs(_sectors(first, middle) + _sectors(middle, last) - _sectors(first, last))
            corner = self._largest_sector(first, last) * (first.edge != last.edge)
            rows = np.flatnonzero(np.maximum(hidden, corner) > allowed)
            if not rows.size:
                break
            ends = ends.with_inserted(middle[rows], low[rows] + 1)
            low = low[rows] + np.arange(len(rows))
            low = np.concatenate([low, low + 1])
            low.sort()
        return self._with_edges(ends[:-1])

    def _with_edges(self, ends: Contour) -> Contour:
        """More points where a ray runs along the edge that ends its neighbour: the edge may be curved in space."""
        following = ends.rolled()
        longer = np.maximum(ends.share, following.share)
        jumps = (ends.edge != following.edge) & (np.abs(ends.share - following.share) > JUMP * longer)
        rows = np.repeat(np.flatnonzero(jumps), EDGE_POINTS)
        part = np.tile(np.arange(1, EDGE_POINTS + 1) / (EDGE_POINTS + 1), int(jumps.sum()))
        first, last = ends[rows], following[rows]
        share, rho, z = (
            start + part * (end - start)
            for start, end in ((first.share, last.share), (first.rho, last.rho), (first.z, last.z))
        )
        edge = np.maximum(first.edge, last.edge)
        return ends.with_inserted(Contour(first.turn, share, rho, z, *self._in_plane(rho, z), edge), rows + 1)

    def _largest_sector(self, first: Contour, last: Contour) -> Array:
        """Area (m,) between two rays if both were as long as the longer one [mm^2]."""
        return 0.5 * self.size * np.maximum(first.share, last.share) ** 2 * (last.turn - first.turn)

    def _ends(self, turn: Array) -> Contour:
        """Where rays (m,) end."""
        rays = np.stack([np.cos(turn), np.sin(turn)], axis=-1) @ self.drawn
        low, high = self._first_crossings(rays)
        rho, z = self._place(rays, low)
        return Contour(turn, low, rho, z, *self._in_plane(rho, z), self._edge(*self._place(rays, high)))

    def _in_plane(self, rho: Array, z: Array) -> tuple[Array, Array]:
        """Points (m,) of the pinion flank in the tangent plane, from the contact point [mm]."""
        x, y = self.plane @ (self.in_space(rho, z) - self.contact.point).T
        return x, y

    def _place(self, rays: Array, share: Array) -> tuple[Array, Array]:
        """(rho, z) at shares (m,) or (m, k) of the rays (m, 2)."""
        rho, z = (rays[:, k].reshape(-1, *(1,) * (share.ndim - 1)) for k in (0, 1))
        return self.contact.pinion_radius + share * rho, self.contact.pinion_axial + share * z

    def _first_crossings(self, rays: Array) -> tuple[Array, Array]:
        """Shares (m,) of the rays just inside the area and just outside; rays too short are made longer."""
        low, high, rows = np.zeros(len(rays)), np.ones(len(rays)), np.arange(len(rays))
        start, stop = 0.0, 1.0
        while rows.size:
            scan = np.linspace(start, stop, SCAN)
            inside = self._inside(rays[rows], np.broadcast_to(scan, (len(rows), SCAN)))
            inside[:, 0] = True
            last = np.where(inside.all(axis=1), SCAN, inside.argmin(axis=1)) - 1
            low[rows], high[rows] = scan[last], scan[np.minimum(last + 1, SCAN - 1)]
            rows, start, stop = rows[last == SCAN - 1], stop, 2.0 * stop
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + high)
            within = self._inside(rays, middle)
            low, high = np.where(within, middle, low), np.where(within, high, middle)
        return low, high

    def _inside(self, rays: Array, share: Array) -> NDArray[np.bool_]:
        """Whether both flanks are there and the gap is below the compound."""
        rho, z = self._place(rays, share)
        gap, _, _ = flank_gap(self.pair, "pinion", self.angles, (rho, z))
        return np.asarray(self.pair.pinion.flank.inside(rho, z) & (gap <= self.compound))

    def _edge(self, rho: Array, z: Array) -> NDArray[np.int_]:
        """Which edge each point (m,) lies beyond, counted from 1, the pinion's first; 0: none."""
        _, radius, axial = flank_gap(self.pair, "pinion", self.angles, (rho, z))
        jets = [*self.pair.pinion.flank.edges(rho, z), *self.pair.wheel.flank.edges(radius, axial)]
        distance = np.stack(np.broadcast_arrays(*(jet.value for jet in jets)))
        return np.where(distance.min(axis=0) < 0.0, 1 + distance.argmin(axis=0), 0)


def _sectors(first: Contour, last: Contour) -> Array:
    """Areas (m,) between neighbouring rays: triangles, and sectors of an ellipse where the compound ends both rays."""
    turn = np.remainder(last.turn - first.turn, 2.0 * math.pi)
    bow = np.where((first.edge == 0) & (last.edge == 0), 1.0 / np.sinc(turn / math.pi), 1.0)
    return 0.5 * bow * (first.x * last.y - last.x * first.y)
