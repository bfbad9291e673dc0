"""The contact path: where one tooth pair touches over the rotation, and the unloaded transmission error.

Where the unloaded contact point of a tooth pair comes into its flanks and leaves them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, Generic, TypeVar, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

import loaded_tca.warning_kinds as kinds
from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, Indices, Mask, finite_row
from loaded_tca.errors import GeometryError, InputError, give_accuracy_warning
from loaded_tca.flanks.base import EDGE_NAMES, outward_normal
from loaded_tca.pairs.gear_pair import GearPair, cylindrical_basis
from loaded_tca.plain import plain
from loaded_tca.unloaded.ease_off import EaseOff, Station
from loaded_tca.unloaded.line import Lines, find_lines
from loaded_tca.unloaded.reduced import FEASIBLE
from loaded_tca.unloaded.scan import past_tangents
from loaded_tca.unloaded.search import FirstTouch, first_touch, spread, touch_near

POSITIONS = 21
"""Positions over a pitch if none are asked for."""
EDGE_SLOPE = 1e-9
"""Slope of the ease-off against an edge above which the contact is held by it: far above rounding (1e-13), far
below any slope that an engineer's modification or mounting error gives."""
ON_ARC = 1e-7
"""Length past the beginning of an arc, over the module, from which a contact lies on it: a place is known closer."""

Number = TypeVar("Number")
Whole = TypeVar("Whole")
Truth = TypeVar("Truth")


@dataclass(frozen=True, eq=False)
class _Contact(Generic[Number, Whole, Truth]):
    """Fields of one position, and of a row of them; the shapes are told by :class:`ContactPath`."""

    pinion_angle: Number
    wheel_angle: Number
    transmission_error: Number
    point: Array
    normal: Array
    pinion_radius: Number
    pinion_axial: Number
    wheel_radius: Number
    wheel_axial: Number
    pinion_lever: Number
    wheel_lever: Number
    in_contact: Truth
    on_edge: Truth
    on_relief_start: Truth
    on_line: Truth
    line_ends: Array
    edges: Mask
    iterations: Whole
    residual: Number


@dataclass(frozen=True, eq=False)
class ContactPoint(_Contact[float, int, bool]):
    """Unloaded contact of one tooth pair at one position; the fields of ``ContactPath`` without their first axis."""


@dataclass(frozen=True, eq=False, repr=False)
class ContactPath(_Contact[Array, Indices, Mask]):
    """Unloaded contact of one tooth pair over the pinion angles, n positions.

    Rows where no point of the tooth pair can touch are NaN, with ``in_contact`` False.

    Attributes
    ----------
    pinion_angle, wheel_angle : (n,) array [rad]
        phi1 and phi2, positive in the sense of motion.
    transmission_error : (n,) array [rad]
        phi2 - (z1/z2) phi1; negative where the wheel stays behind.
    point : (n, 3) array [mm]
        In the fixed frame; the middle of the line for a line contact.
    normal : (n, 3) array
        Unit, out of the pinion; on an edge, of the flank that does not end there.
    pinion_radius, pinion_axial, wheel_radius, wheel_axial : (n,) array [mm]
        (rho, z) of the point on each flank.
    pinion_lever, wheel_lever : (n,) array [mm]
        Torque of a unit normal force about each axis.
    in_contact, on_edge, on_relief_start, on_line : (n,) bool array
        Whether the pair is in contact; whether the point lies on a tip, root or side edge, or on the arc of a rounded
        one; on the start of a linear relief; whether the contact is a line.
    line_ends : (n, 2, 3) array [mm]
        Ends of the line, on the edges as if they were sharp; NaN for a point contact.
    edges : (n, 8) bool array
        The edges that hold the point, or on whose arcs it lies: ``EDGE_NAMES`` of the pinion, then of the wheel.
    iterations : (n,) int array
        Newton steps of the ascent that found it.
    residual : (n,) array
        Sine of the angle between the two normals; on an edge, of its part along the edge.
    """

    def __len__(self) -> int:
        return len(self.pinion_angle)

    def __iter__(self) -> Iterator[ContactPoint]:
        """Position by position."""
        return map(ContactPoint, *(getattr(self, field.name) for field in fields(self)))

    @overload
    def __getitem__(self, position: int | np.integer) -> ContactPoint: ...

    @overload
    def __getitem__(self, position: slice | Sequence[int] | Sequence[bool] | NDArray[Any]) -> ContactPath: ...

    def __getitem__(self, position: Any) -> ContactPoint | ContactPath:
        """One position of the path by its number; a part of the path by a slice, a mask or several numbers.

        Raises
        ------
        InputError
            If the index has more than one dimension.
        IndexError
            If a position does not exist, a mask is not as long as the path, or the index is of no such kind.
        """
        rows = np.arange(len(self))[position]
        if rows.ndim > 1:
            raise InputError(f"position: {position!r} is not one position, a slice, a mask or a row of positions")
        part = {field.name: getattr(self, field.name)[rows] for field in fields(self)}
        return ContactPath(**part) if rows.ndim else ContactPoint(**part)

    def __repr__(self) -> str:
        edge = int(self.on_edge.sum())
        return f"ContactPath({len(self)} positions, {int(self.in_contact.sum())} touch, {edge} on an edge)"


@checked
def trace_contact(pair: GearPair, pinion_angles: ArrayLike | None = None, *, warn: bool = True) -> ContactPath:
    """Unloaded contact of one tooth pair at each pinion angle.

    Parameters
    ----------
    pair : GearPair
    pinion_angles : (n,) array [rad], optional
        phi1; default: 21 positions over one pitch about phi1 = 0, both ends included.
    warn : bool
        Whether to give an AccuracyWarning where the contact lies on the root edge of a flank.

    Returns
    -------
    ContactPath

    Raises
    ------
    InputError
        If an angle is not finite or the array not one-dimensional.
    GeometryError
        If the flanks share no region at any position.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> gears = [CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)]
    >>> path = trace_contact(cylindrical_pair(CylindricalMesh(*gears)), [0.0])
    >>> [round(float(x), 6) for x in (*path.pinion_radius, *path.wheel_radius)]
    [51.0, 85.5]
    """
    phi1 = default_angles(pair) if pinion_angles is None else finite_row("pinion_angles", pinion_angles)
    touch = first_touch(pair, phi1)
    if not touch.in_contact.any():
        raise GeometryError(
            f"no common flank: at none of the {len(phi1)} pinion angles between {plain(phi1.min(), 6)} and "
            f"{plain(phi1.max(), 6)} rad do the two flanks cover a common region; check the tips of the teeth and how "
            "the gears are mounted"
        )
    path = _path(pair, phi1, touch)
    if warn:
        warn_of_fillets(pair, path, "contact")
    return path


def trace_near(pair: GearPair, contacts: Sequence[ContactPoint], pinion_angles: Sequence[float]) -> ContactPath:
    """Contacts (n,) at pinion angles [rad] next to those of contacts that are known; NaN where they are not found.

    Each is climbed to from the known one, so that it stays on its part of the flanks, and takes a fraction of the time
    of :func:`trace_contact`.
    """
    places = np.array([(one.pinion_radius, one.pinion_axial) for one in contacts])
    phi1 = np.array(pinion_angles)
    return _path(pair, phi1, touch_near(pair, phi1, *places.T))


def angles_through(pair: GearPair, near: Array, points: Array) -> Array:
    """Angles (2, m) of pinion and wheel [rad] at which points (m, 3) [mm] of the fixed frame lie on both their flanks.

    They are the next ones to the angles ``near`` (2, m), those of a contact.
    """
    in_wheel, origins = pair.wheel_axes.T, points[:, None] - pair.wheel_origin  # a product for each point
    views = (pair.pinion.flank, points, pair.sense), (pair.wheel.flank, (origins @ in_wheel)[:, 0], -pair.sense)
    turned = [
        sense * (np.arctan2(place[:, 1], place[:, 0]) - flank.theta(np.hypot(*place[:, :2].T), place[:, 2]).value)
        for flank, place, sense in views
    ]
    beside = np.array(turned) - near
    return np.asarray(near + (beside - 2.0 * math.pi * np.round(beside / (2.0 * math.pi))))


def require_contact(contact: ContactPoint) -> None:
    """Refuse what is not one position of a path (InputError), or a tooth pair that is apart there (GeometryError)."""
    if not isinstance(contact, ContactPoint):
        raise InputError(f"contact: {contact!r:.60} is not one position of a path; take path[i]")
    if not contact.in_contact:
        raise GeometryError(
            f"no common flank: the tooth pair is not in contact at pinion angle {contact.pinion_angle} rad"
        )


def warn_of_fillets(pair: GearPair, path: ContactPath, what: str) -> None:
    """Warn, for the caller's caller, where ``what`` lies on the root edge of a flank."""
    root = EDGE_NAMES.index("root")
    held = (path.edges[:, root], path.edges[:, len(EDGE_NAMES) + root])
    flanks = [flank for flank, rows in zip((pair.pinion.flank, pair.wheel.flank), held, strict=True) if rows.any()]
    if flanks:
        count = int((held[0] | held[1]).sum())
        where = " or a ".join(dict.fromkeys(flank.frame.edges[root] for flank in flanks))
        held_there = f"at {count} of {len(path)} positions the {what} lies on a {where}"
        sentence = kinds.FILLET.sentence(what=f"{held_there}, where the flank ends and the fillet begins")
        give_accuracy_warning(sentence)


def default_angles(pair: GearPair) -> Array:
    """Pinion angles [rad] of 21 positions over one pitch about phi1 = 0, both ends included."""
    return np.linspace(-0.5 * pair.pitch, 0.5 * pair.pitch, POSITIONS)


def _path(pair: GearPair, phi1: Array, touch: FirstTouch) -> ContactPath:
    """Contact path of first touches; lines are represented by their middles."""
    rows = np.flatnonzero(touch.in_contact)
    angle, rho, z = phi1[rows], touch.rho[rows].copy(), touch.z[rows].copy()
    field = EaseOff(pair, touch.beyond[rows])
    multipliers = np.where(touch.multipliers[rows] > EDGE_SLOPE, touch.multipliers[rows], 0.0)
    rounded = past_tangents(field.station(angle, rho, z)) > ON_ARC * pair.module
    lines = _lines(field, angle, rho, z, multipliers, np.asarray(rounded.any(axis=-1)))
    rho[lines.flat], z[lines.flat] = lines.rho, lines.z
    line_ends = np.full((len(rows), 2, 3), np.nan)
    line_ends[lines.rows] = lines.ends
    station = field.station(angle, rho, z)
    relief_start = field.edge_is_relief_start()
    error = pair.driving * field.value(station, angle) / pair.base_radii[1]
    known = _contact(pair, field, station, multipliers > 0.0, rounded)
    known |= {
        "wheel_angle": error + pair.ratio * angle,
        "transmission_error": error,
        "pinion_radius": rho,
        "pinion_axial": z,
        "on_relief_start": (multipliers[:, relief_start] > 0.0).any(axis=-1),
        "on_line": np.isin(np.arange(len(rows)), lines.rows),
        "line_ends": line_ends,
        "in_contact": np.ones(len(rows), dtype=bool),
        "iterations": touch.iterations[rows],
    }
    return ContactPath(pinion_angle=phi1, **{name: spread(part, rows, len(phi1)) for name, part in known.items()})


def _lines(field: EaseOff, phi1: Array, rho: Array, z: Array, multipliers: Array, rounded: Mask) -> Lines:
    """Lines among the first touches (n,); those that lie on no arc are as long as with sharp edges."""
    parts = []
    for edges, there in ((EaseOff(field.pair.sharp, field.beyond), ~rounded), (field, rounded)):
        rows = np.flatnonzero(there)
        if rows.size:
            lines = find_lines(edges.restricted(rows), phi1[rows], rho[rows], z[rows], multipliers[rows])
            parts.append(replace(lines, rows=rows[lines.rows], flat=rows[lines.flat]))
    return Lines(*(np.concatenate([getattr(part, one.name) for part in parts]) for one in fields(Lines)))


def _contact(pair: GearPair, field: EaseOff, station: Station, held: Mask, rounded: Mask) -> dict[str, Any]:
    """Normals, levers, edges and residual of the points.

    ``held`` tells the edges and relief starts they rest on, ``rounded`` the edges on whose arcs they lie.
    """
    pinion_basis = cylindrical_basis(np.arctan2(station.point[:, 1], station.point[:, 0]))
    out_of_pinion, out_of_wheel = (
        np.einsum("nk,nkj->nj", outward_normal(flank, rho, z), basis)
        for flank, rho, z, basis in (
            (pair.pinion.flank, station.rho, station.z, pinion_basis),
            (pair.wheel.flank, station.wheel_rho, station.wheel_z, station.wheel_basis),
        )
    )
    edges = held[:, ~field.edge_is_relief_start()] | rounded
    pinion_kinks, wheel_kinks = (
        _kinks(field, station, held, gear) + on.any(axis=-1) for gear, on in enumerate(np.split(rounded, 2, axis=1))
    )
    use_wheel = pinion_kinks > wheel_kinks
    normal = np.where(use_wheel[:, None], -out_of_wheel, out_of_pinion)
    arm = station.point - pair.wheel_origin
    return {
        "point": station.point,
        "normal": normal,
        "wheel_radius": station.wheel_rho,
        "wheel_axial": station.wheel_z,
        "pinion_lever": np.abs(np.cross(station.point, normal)[:, 2]),
        "wheel_lever": np.abs(np.cross(arm, normal) @ pair.wheel_axes[2]),
        "edges": edges,
        "on_edge": edges.any(axis=-1),
        "residual": _residual(field, station, (out_of_pinion, out_of_wheel), held),
    }


def _kinks(field: EaseOff, station: Station, held: Mask, member: int) -> Array:
    """Weight of what leaves the normal of one gear open at the contact: an end of its flank 1, its relief start 2.

    Where both flanks end, as at faces of one width, the one that has no relief start there is smooth along the edge.
    """
    own, relief_start = field.edge_owner() == member, field.edge_is_relief_start()
    distances, _ = field.edges(station)
    near = distances <= FEASIBLE * field.pair.pinion.flank.extent[0]
    on_edge = held[:, ~relief_start].any(axis=-1) & (near & own & ~relief_start).any(axis=-1)
    ends = on_edge | (held & own & ~relief_start).any(axis=-1)
    return np.asarray(ends + 2 * (held & own & relief_start).any(axis=-1))


def _residual(field: EaseOff, station: Station, normals: tuple[Array, Array], held: Mask) -> Array:
    """Sine of the angle between the normals; along the edge if one edge holds the point; zero in a corner."""
    residual = np.linalg.norm(np.cross(*normals), axis=-1)
    residual[held.sum(axis=-1) > 1] = 0.0
    for edge, own in enumerate(field.edge_owner()):
        rows = np.flatnonzero((held.sum(axis=-1) == 1) & held[:, edge])
        if rows.size:
            along = np.cross(normals[own][rows], field.edge_normal(station, edge)[rows])
            along /= np.linalg.norm(along, axis=-1, keepdims=True)
            residual[rows] = np.abs((along * normals[1 - own][rows]).sum(axis=-1))
    return residual


ROUNDS, FINENESS = 4, 13
"""Rounds in which an end of the path of contact is found, and angles of each: to 5e-5 of the span."""
FARTHEST, NEAR = 4.0, 7
"""Pitches before and after the pitch point up to which the ends are looked for, and angles of the first round that lie
within half of that: flanks far from contact take the longest, and are looked at where no end is nearer."""


def contact_span(pair: GearPair) -> tuple[ContactPoint | None, ContactPoint | None]:
    """Ends of the contact of a tooth pair within its flanks, modifications and mounting errors included.

    Parameters
    ----------
    pair : GearPair

    Returns
    -------
    at_root, at_tip : ContactPoint or None
        Where the contact point comes to an edge of a flank, towards root and tip of the pinion; None if it comes to
        none within four pitches, or lies on one at the pitch point already. If the pinion drives, contact begins
        towards its root.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> mesh = CylindricalMesh(*(CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)))
    >>> pair = cylindrical_pair(mesh)
    >>> at_root, at_tip = contact_span(pair)
    >>> pitches = float(at_tip.pinion_angle - at_root.pinion_angle) / pair.pitch
    >>> round(pitches, 2), round(mesh.transverse_contact_ratio, 2)
    (1.73, 1.73)
    """
    farthest = FARTHEST * pair.driving * pair.pitch
    brackets = {"root": (0.0, -farthest), "tip": (0.0, farthest)}
    last: dict[str, ContactPoint | None] = dict.fromkeys(brackets)
    for number in range(ROUNDS):
        rows = [np.linspace(*bracket, FINENESS) for bracket in brackets.values()]
        try:
            contacts = _up_to_the_ends(pair, rows, FINENESS if number else NEAR)
        except GeometryError:  # nothing is in contact
            break
        for end, row, inside in zip(tuple(brackets), rows, contacts, strict=True):
            if 0 < len(inside) < FINENESS:
                brackets[end], last[end] = (row[len(inside) - 1], row[len(inside)]), inside[-1]
            else:  # all the way, or nowhere: no end
                del brackets[end], last[end]
        if not brackets:
            break
    return last.get("root"), last.get("tip")


def _up_to_the_ends(pair: GearPair, rows: Sequence[Array], near: int) -> list[list[ContactPoint]]:
    """Contacts at rows of pinion angles, each up to the last one before an edge; some rows may have none.

    Of rows that meet no edge at their first ``near`` angles the others are looked at, too.
    """
    inside = _up_to_edges(pair, [row[:near] for row in rows])
    further = [number for number, contacts in enumerate(inside) if near == len(contacts) < len(rows[number])]
    if further:  # from the last contact on: where no angle has one, none can be traced
        beyond = _up_to_edges(pair, [rows[number][near - 1 :] for number in further])
        for number, contacts in zip(further, beyond, strict=True):
            inside[number] += contacts[1:]
    return inside


def _up_to_edges(pair: GearPair, rows: Sequence[Array]) -> list[list[ContactPoint]]:
    """Contacts at rows of pinion angles, each up to the last one before an edge."""
    path, end, inside = trace_contact(pair, np.concatenate(rows), warn=False), 0, []
    for row in rows:
        part, end = path[end : end + len(row)], end + len(row)
        outside = np.append(part.on_edge | ~part.in_contact, True)
        inside.append([part[place] for place in range(int(np.argmax(outside)))])
    return inside


def path_letters(at_root: float, at_tip: float, pitch: float) -> dict[str, float]:
    """Points A, B, D and E of a path of contact, as angles or as lengths on it.

    Parameters
    ----------
    at_root, at_tip : float
        Its ends A and E towards root and tip of the pinion; NaN: not known.
    pitch : float
        In the same unit, negative where the first is larger than the second.

    Returns
    -------
    dict
        Without what is not known, and with B and D only where one pair alone is in contact between them.

    Examples
    --------
    >>> path_letters(0.0, 1.6, 1.0)
    {'A': 0.0, 'B': 0.6000000000000001, 'D': 1.0, 'E': 1.6}
    """
    points = {"A": at_root, "B": at_tip - pitch, "D": at_root + pitch, "E": at_tip}
    alone = 1.0 < (at_tip - at_root) / pitch < 2.0
    return {name: place for name, place in points.items() if math.isfinite(place) and (alone or name in "AE")}


def roll_lengths_of_flanks(
    pair: GearPair, at_root: ContactPoint | None, at_tip: ContactPoint | None
) -> dict[str, float]:
    """Points A, B, D and E of the path of contact of the flanks of a cylindrical pair, as roll lengths of the pinion.

    Parameters
    ----------
    pair : GearPair
    at_root, at_tip : ContactPoint or None
        Its ends, as :func:`contact_span` finds them.

    Returns
    -------
    dict [mm]
        As of :func:`path_letters`.
    """
    coordinate = pair.pinion.flank.profile_coordinate
    begin, end = (
        math.nan if one is None else float(coordinate(np.array(one.pinion_radius), np.array(one.pinion_axial)).value)
        for one in (at_root, at_tip)
    )
    return path_letters(begin, end, pair.pitch * pair.base_radii[0])
