r"""How contact points and their levers move with keys of the scene.

With both flanks' growth along the normal, ds, and the wheel turned back into contact, the gap grows by dh. A contact
point moves by s [mm] in the tangent plane to where the gap is least, and the normal there is that of the flank that
goes on there, the pinion's if both do:

.. math:: s = -B^{-1} \nabla dh, \qquad dn = (\nabla n) s - \nabla ds,

B the relative curvature. On an edge at the distance D it stays on the edge, against which the gap falls by lambda:

.. math:: (B - \lambda \nabla^2 D) s - \nabla D\,d\lambda = -\nabla dh, \qquad
          \nabla D \cdot s = -dD, \qquad \nabla h = \lambda \nabla D,

and in a corner on both. The start of a linear relief holds it likewise; h is then the gap without that relief, which
goes on smoothly beyond its start. The levers (r x n).e follow.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from loaded_tca.arrays import GEARS, Array, Mask
from loaded_tca.edges.places import arcs_of, lengths_past_tangents
from loaded_tca.flanks.removal import ModifiedFlank
from loaded_tca.flanks.rounding import sharp
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.separation.normal_gap import NormalGap
from loaded_tca.separation.pair_change import Distance, PairChange, Places, edge_distance, grown, rises, start_distance
from loaded_tca.separation.sample import Separation
from loaded_tca.unloaded import ContactPoint
from loaded_tca.unloaded.curvature import relative_curvatures

BESIDE = 1e-3
"""Distance of the points beside the contact point that slopes are taken of, over the module."""
BESIDE_ON_ARC = 1e-4
"""The same on the arc of a rounded edge, over the smallest radius. Slopes are wrong by the square of this, over the
curvature of the arc, which is up to 1e5 times that of the contact along it."""
SAME_NORMAL = 1e-9
"""Difference of two unit normals that is none."""
ON_LINE = 1e-6
"""Distance, over the module, at which a contact point lies on an edge or a relief start."""
BESIDE_START = 1e-3
"""Distance of a relief start, over the module, from a contact point on it in pairs that differ in a key."""
TURNS = 3
LEVEL = 1e-9
"""Curvature along an edge, over that across the contact, that is none: a line has no place along itself."""


@dataclass(frozen=True, eq=False)
class PointChanges:
    """Derivatives at contact points.

    Attributes
    ----------
    steepness : (contacts,) array [1/mm]
        Of the wheel's flank.
    held : (contacts,) bool array
        Whether an edge or a relief start holds the point.
    gaps : (keys, contacts) array [mm per unit of the key]
        Growth of the gap there, and of that to which an edge moves, with the gears held at their angles: what turning
        back into contact closes.
    levers : (2, keys, contacts) array [mm per unit of the key]
        Growth of the levers about the axes of pinion and wheel.
    shifts : (keys, contacts, 2) array [mm per unit of the key]
        By which the points move along x and y of their grids.
    tilts : (keys, contacts, 2) array [rad per unit of the key]
        Growth of the normal along x and y.
    lifts : (keys, contacts) array [mm per unit of the key]
        Motion of the points along the normal, out of the pinion.
    across : (keys, contacts) array [mm per unit of the key]
        Motion along x with which a point that is free stays where it is across the contact, or what holds it does.
    """

    steepness: Array
    held: Mask
    gaps: Array
    levers: Array
    shifts: Array
    tilts: Array
    lifts: Array
    across: Array

    @property
    def turns(self) -> Array:
        """Turn of the wheel back into contact (keys, contacts) [rad per unit of the key], against the normal force."""
        return np.asarray(self.gaps * np.abs(self.steepness))


class _Stencil:
    """Contact points and four places around each, along the principal directions of the relative curvature."""

    def __init__(self, pair: GearPair, contacts: Sequence[ContactPoint], changes: Sequence[PairChange]) -> None:
        self.pair, self.contacts, self.changes = pair, contacts, changes
        if contacts[0].on_relief_start:  # then it is the only one
            pair = _without_ramps(pair, contacts[0])
            changes = [
                replace(one, below=_without_ramps(one.below, contacts[0]), above=_without_ramps(one.above, contacts[0]))
                for one in changes
            ]
        self.curvatures, self.beside = relative_curvatures(pair, contacts), BESIDE * pair.module
        if _beside_arcs(pair, contacts[:1]).any():  # then all are
            self.beside = BESIDE_ON_ARC * min(arc.radius for _, arc in arcs_of(pair).values())
        self.axes = np.array([one.axes for one in self.curvatures])
        parts = [0.0, -1.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0, 1.0]
        x, y = (self.beside * np.tile(part, (len(contacts), 1)) for part in parts)
        self.points = NormalGap(pair, contacts, self.axes).flank_points(x, y)
        self.planes = np.stack([self.axes, self.axes @ pair.wheel_axes.T])
        self.grown = grown(pair, changes, *self.points)
        self.rising = np.stack(
            [rises(one, plane[:, None, :2]) for one, plane in zip(self.points, self.planes, strict=True)]
        )  # (2, contacts, 5, 2)

    def slope(self, values: Array, axis: int = -1) -> Array:
        """Derivatives by x and y, in the place of the five points."""
        low, high = (values.take([first, first + 2], axis=axis) for first in (1, 2))
        return np.asarray((high - low) / (2.0 * self.beside))

    @property
    def lever_parts(self) -> Array:
        """Levers of the wheel's flank over that at the contact point (contacts, 5)."""
        steep = self.points[1].steepness
        return np.asarray(steep[:, :1] / steep)

    def places(self, contact: int, turned: Array) -> Places:
        """The places around one contact point, the wheel turned back by ``turned`` (keys,)."""
        grown_there = self.grown[:, :, contact].copy()
        grown_there[1] -= turned[:, None] * self.lever_parts[contact]
        planes = np.repeat(self.planes[:, contact, None], 5, axis=1)
        points = self.points[0].at(contact), self.points[1].at(contact)
        heights, tilts = np.zeros((2, 5)), np.zeros((len(turned), 5, 2))
        motions = np.repeat(np.eye(2)[None], 5, axis=0)
        return Places(points, planes, grown_there, heights, tilts, self.rising[:, contact], motions)


def point_changes(
    pair: GearPair,
    contacts: Sequence[ContactPoint],
    separations: Sequence[Separation],
    changes: Sequence[PairChange],
) -> PointChanges:
    """Derivatives at contact points to keys of the scene.

    Parameters
    ----------
    pair : GearPair
    contacts : sequence of ContactPoint
        Whose pinions are held at their angles.
    separations : sequence of Separation
        The grid of each.
    changes : sequence of PairChange
    """
    on_start, on_arc = np.array([bool(one.on_relief_start) for one in contacts]), _beside_arcs(pair, contacts)
    groups = [np.flatnonzero(~on_start & (on_arc == arc)) for arc in (False, True)]
    groups += [*np.flatnonzero(on_start)[:, None]]
    groups = [group for group in groups if group.size]
    parts = [
        _alike(pair, [contacts[i] for i in group.tolist()], [separations[i] for i in group.tolist()], changes)
        for group in groups
    ]
    order = np.argsort(np.concatenate(groups))
    axes = {"steepness": 0, "held": 0, "levers": 2}
    return PointChanges(
        **{
            one.name: np.concatenate([getattr(part, one.name) for part in parts], axis=axes.get(one.name, 1)).take(
                order, axis=axes.get(one.name, 1)
            )
            for one in fields(PointChanges)
        }
    )


def _beside_arcs(pair: GearPair, contacts: Sequence[ContactPoint]) -> Mask:
    """Whether contact points (n,) lie on the arcs of rounded edges, or nearer than places beside them elsewhere."""
    if pair.sharp is pair:
        return np.zeros(len(contacts), dtype=bool)
    pinion, wheel = (
        (
            np.array([getattr(one, f"{name}_radius") for one in contacts]),
            np.array([getattr(one, f"{name}_axial") for one in contacts]),
        )
        for name in GEARS
    )
    return np.asarray((lengths_past_tangents(pair, pinion, wheel) > -BESIDE * pair.module).any(axis=-1))


def _without_ramps(pair: GearPair, contact: ContactPoint) -> GearPair:
    """The pair without the linear reliefs on whose starts a contact point lies."""
    places = (contact.pinion_radius, contact.pinion_axial), (contact.wheel_radius, contact.wheel_axial)
    gears = []
    for gear, (rho, z) in zip((pair.pinion, pair.wheel), places, strict=True):
        flank, limit = sharp(gear.flank), BESIDE_START * pair.module
        near = [abs(float(start.value)) < limit for start in flank.relief_starts(np.asarray(rho), np.asarray(z))]
        smooth = flank.without_ramps(near) if any(near) and isinstance(flank, ModifiedFlank) else None
        gears.append(gear if smooth is None else replace(gear, flank=smooth))
    return replace(pair, pinion=gears[0], wheel=gears[1])


def _alike(
    pair: GearPair,
    contacts: Sequence[ContactPoint],
    separations: Sequence[Separation],
    changes: Sequence[PairChange],
) -> PointChanges:
    """Derivatives at contact points alike: on arcs or not, on no relief start; or at one that does."""
    stencil = _Stencil(pair, contacts, changes)
    held = np.array([bool(one.on_edge or one.on_relief_start) for one in contacts])
    gaps = (stencil.grown[1] - stencil.grown[0])[..., 0]
    shifts = _free_shifts(stencil, gaps)
    for contact in np.flatnonzero(held).tolist():
        gaps[:, contact], shifts[:, contact] = _held_shifts(stencil, contact, gaps[:, contact])
    turned, steepness = _turned_normals(stencil, gaps, shifts), stencil.points[1].steepness[:, 0]
    levers = _levers(stencil, shifts, turned)
    lifts = stencil.grown[0, ..., 0] + (shifts * stencil.rising[0, :, 0]).sum(axis=-1)
    planes = np.array([one.axes[:2] for one in separations])
    tilts, to_grid = np.einsum("cai,kci->kca", planes, turned), planes @ stencil.axes[:, :2].mT
    shifts = np.einsum("cap,kcp->kca", to_grid, shifts)
    across = shifts[..., 0].copy()
    for contact in np.flatnonzero(held).tolist():
        across[:, contact] = _across(stencil, contact, gaps[:, contact], to_grid[contact])
    return PointChanges(steepness, held, gaps, levers, shifts, tilts, lifts, across)


def _free_shifts(stencil: _Stencil, gaps: Array) -> Array:
    """Motions (keys, contacts, 2) of points that nothing holds, along the principal directions."""
    bends = np.array([(one.across, one.along) for one in stencil.curvatures])
    bent = bends > 0.0
    bent[:, 1] &= [not one.on_line for one in stencil.contacts]
    left = stencil.grown[1] - stencil.grown[0] - gaps[..., None] * stencil.lever_parts
    return np.where(bent, -stencil.slope(left) / np.where(bent, bends, 1.0), 0.0)


def _held_shifts(stencil: _Stencil, contact: int, gaps: Array) -> tuple[Array, Array]:
    """Growth of the gap (keys,) at a point that edges hold, and its motions (keys, 2) along them and with them."""
    rising = stencil.rising[1, contact] - stencil.rising[0, contact]  # (5, 2)
    slope, bend = rising[0], stencil.slope(rising, axis=0)
    lines = _lines_through(stencil, contact)
    slopes = [stencil.places(contact, gaps).slopes_of(stencil.pair, *line) for line in lines]  # (5, 2) each
    normals = np.array([own[0] for own in slopes]).reshape(-1, 2)
    against = np.linalg.lstsq(normals.T, slope, rcond=None)[0]
    bend = bend - sum(part * stencil.slope(own, axis=0) for part, own in zip(against, slopes, strict=True))
    bend, across = 0.5 * (bend + bend.T), np.linalg.pinv(normals)  # (2, lines)
    along = np.eye(2) - across @ normals
    stiff = along @ bend @ along
    opened = gaps
    for _ in range(TURNS):  # an edge of the wheel moves with the turn that closes the gap, by next to nothing
        places = stencil.places(contact, opened)
        rates = np.array([places.growth(stencil.pair, *line, stencil.changes) for line in lines]).reshape(
            len(lines), gaps.size, 5
        )
        left = stencil.slope(places.grown[1] - places.grown[0] - np.tensordot(against, rates, 1))  # (keys, 2)
        shifts = -rates[..., 0].T @ across.T
        if (
            np.linalg.matrix_rank(along, tol=0.5)
            and np.trace(stiff) > LEVEL * np.abs(bend).max()
            and not stencil.contacts[contact].on_line
        ):
            shifts = shifts - (left + shifts @ bend) @ along @ np.linalg.pinv(stiff, rcond=LEVEL)
        opened = gaps + shifts @ slope
    return opened, shifts


def _across(stencil: _Stencil, contact: int, opened: Array, to_grid: Array) -> Array:
    """Motion (keys,) along x of the grid with which an edge or relief start that runs along the contact stays there."""
    places = stencil.places(contact, opened)
    for line in _lines_through(stencil, contact):
        normal = to_grid @ places.slopes_of(stencil.pair, *line)[0]
        if abs(normal[0]) > 0.5 * np.linalg.norm(normal):
            return np.asarray(-places.growth(stencil.pair, *line, stencil.changes)[:, 0] / normal[0])
    return np.zeros(opened.shape)


def _lines_through(stencil: _Stencil, contact: int) -> list[tuple[int, Distance]]:
    """Edges that hold a contact point, and relief starts it lies on: the gear of each, and the distance to it."""
    one, lines = stencil.contacts[contact], []
    limit = ON_LINE * stencil.pair.module
    for gear, points in enumerate(stencil.points):
        there = points.at((contact, slice(0, 1)))
        flank = (stencil.pair.pinion, stencil.pair.wheel)[gear].flank
        for number, jet in enumerate(flank.edges(there.rho, there.z)):
            if abs(float(np.ravel(jet.value)[0])) < limit:
                lines.append((gear, edge_distance(gear, number)))
        if one.on_relief_start:
            for number, jet in enumerate(flank.relief_starts(there.rho, there.z)):
                if abs(float(np.ravel(jet.value)[0])) < limit:
                    lines.append((gear, start_distance(gear, number)))
    return lines


def _turned_normals(stencil: _Stencil, gaps: Array, shifts: Array) -> Array:
    """Growth of the normals (keys, contacts, 3): of the flank that goes on at the point."""
    grown_there = stencil.grown.copy()
    grown_there[1] -= gaps[..., None] * stencil.lever_parts
    normals = [
        one.gradient / np.linalg.norm(one.gradient, axis=-1, keepdims=True) * np.sign(one.steepness)[..., None]
        for one in stencil.points
    ]
    normals[1] = normals[1] @ stencil.pair.wheel_axes
    out = np.array([one.normal for one in stencil.contacts])
    off = [np.linalg.norm(normal[:, 0] - out, axis=-1) for normal in normals]
    of_wheel = (off[1] < off[0] - SAME_NORMAL)[:, None, None]
    turning = np.where(of_wheel[..., 0], *(stencil.slope(grown_there[gear]) for gear in (1, 0)))  # (keys, contacts, 2)
    bending = np.where(of_wheel, *(stencil.slope(normals[gear], axis=1) for gear in (1, 0)))  # (contacts, 2, 3)
    by_motion = np.einsum("kcp,cpi->kci", shifts, bending)
    return np.asarray(by_motion - np.einsum("kcp,cpi->kci", turning, stencil.axes[:, :2]))


def _levers(stencil: _Stencil, shifts: Array, turned: Array) -> Array:
    """Growth of the levers (2, keys, contacts)."""
    pair, contacts = stencil.pair, stencil.contacts
    point, out = (np.array([getattr(one, name) for one in contacts]) for name in ("point", "normal"))
    moved = np.einsum("kcp,cpi->kci", shifts, stencil.axes[:, :2])
    levers = np.zeros((2, *shifts.shape[:2]))
    axes = (np.zeros(3), np.array([0.0, 0.0, 1.0])), (pair.wheel_origin, pair.wheel_axes[2])
    for gear, (origin, axis) in enumerate(axes):
        arm = point - origin
        levers[gear] = (np.cross(moved, out) + np.cross(arm, turned)) @ axis
        for key, change in enumerate(stencil.changes if gear == 1 else ()):
            shifted, tilted = change.moved_wheel
            levers[gear, key] += np.cross(arm, out) @ tilted[2] - np.cross(shifted, out) @ axis
        levers[gear] *= np.sign(np.cross(arm, out) @ axis)
    return levers
