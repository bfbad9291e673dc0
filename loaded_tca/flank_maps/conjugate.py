r"""The conjugate of the mating flank: what it sweeps out of the other gear when both turn at the constant ratio.

Let both gears turn at the constant ratio z1/z2 and take a point P of the pinion's flank. At the angle phi1 it asks the
wheel for a lead e(P; phi1), the field of :mod:`loaded_tca.unloaded.ease_off`; over the whole passage for no more than

.. math:: E(P) = \max_{\varphi_1} e(P;\,\varphi_1).

A wheel that leads by E(P) touches P once and never passes through it: P lies on the conjugate of the wheel's flank.
Along the circle of P the lead depends on Theta of the pinion in one way only, as an angle added to phi1. So the pinion
departs from that conjugate by exactly (E_0 - E)/(r_b2 z1/z2) as an angle of its Theta, whatever the departure. The
maximum is where the normal obeys the law of gearing.

References
----------
Litvin & Fuentes 2004, Gear Geometry and Applied Theory, chapter 6 (conjugated surfaces).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
import scipy

from loaded_tca.arrays import GEARS, Array, Indices, Mask
from loaded_tca.arrays import GearName as GearName
from loaded_tca.errors import GeometryError
from loaded_tca.flanks.base import Flank
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.roots import find_roots
from loaded_tca.unloaded.ease_off import EaseOff

SAMPLES = 16
"""Angles per pitch at which the lead of a point is sampled."""
PASSAGE_ANGLES = 4
"""Angles per pitch at which the way of the teeth through the mating gear is looked for."""
PASSAGE = (5, 9)
"""Points of a flank along the profile and along the face that tell it."""
SLACK = (0.5, 0.1)
"""How far [modules] the mating gear's flank is continued beyond its tip and below its form circle; near the base circle
(there is no flank below it) not far."""
SIDE_SLACK = 0.5
"""How far [face widths] it is continued beyond its ends."""
ANGLE_ACCURACY = 1e-10
"""Accuracy of the angle of contact [rad]: the lead is then right to rounding, on a relief start to 1e-12 mm."""
BLOCK = 4096
"""Points that are looked at together: memory stays small on any grid."""
FINENESS = (129, 65)
"""Points along the profile and lengthwise between which places are interpolated; what is computed there is computed at
the very place that is returned."""
ROOM_SCAN = (33, 33)
"""Shares along the profile and lengthwise at which the mating gear is looked for."""
EDGE_ACCURACY = 1e-9
"""Accuracy of an edge, as a share of the flank."""
ROUNDING = 1e-5
"""Distance beyond an edge [modules] that still counts as on the flank: places are interpolated so closely."""
NOWHERE = -1.0
"""Room [modules] where there is no contact at all: beyond any edge."""
WHEEL_EDGES = slice(4, 8)
"""Columns of the edges of the wheel's flank."""
Edge = Callable[[Array, Indices], Array]
"""Room [modules] at shares along a line, of the lines named by the second argument."""


@dataclass(frozen=True, eq=False)
class ConjugateContact:
    """Where points of the pinion's flank would touch a mating gear that turns at the constant ratio.

    Attributes
    ----------
    angle : (...) array [rad]
        phi1 at which the point asks for the largest lead; NaN where it does so nowhere on the mating gear or near it.
    lead : (...) array [mm]
        E, as a length at r_b2; NaN likewise.
    mating_radius, mating_axial : (...) array [mm]
        The point on the wheel's flank.
    profile_room, lengthwise_room : (...) array [mm]
        Distance to the nearer one of the wheel's tip and root edges, and of its ends; negative beyond them; NaN
        likewise.
    """

    angle: Array
    lead: Array
    mating_radius: Array
    mating_axial: Array
    profile_room: Array
    lengthwise_room: Array

    @property
    def exists(self) -> Mask:
        """Whether there is such a contact."""
        return np.isfinite(self.lead)


def problems_of_map(gear: Any, grid: Any, fewest: int) -> list[str]:
    """What is wrong with the gear and the grid that a map of a flank is asked for."""
    problems = [] if gear in GEARS else [f"gear: {gear!r} is not 'pinion' or 'wheel'"]
    counts = list(grid) if isinstance(grid, Sequence | np.ndarray) else []
    if len(counts) != 2 or not all(isinstance(n, int | np.integer) and n >= fewest for n in counts):
        problems.append(f"grid: {grid!r} are not two whole numbers >= {fewest}")
    return problems


def exchanged(pair: GearPair) -> GearPair:
    """The same two gears with the wheel in the place of the pinion: its axis is +z of the fixed frame.

    What is computed on the flank of the pinion is had on the flank of the wheel so. Both angles keep their sense of
    motion; each gear still touches with the same flank.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> gears = [CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)]
    >>> exchanged(cylindrical_pair(CylindricalMesh(*gears)))
    GearPair(57/34, module 3 mm, face 25 mm)
    """
    return replace(
        pair,
        pinion=pair.wheel,
        wheel=pair.pinion,
        teeth=pair.teeth[::-1],
        wheel_origin=-pair.wheel_axes @ pair.wheel_origin,
        wheel_axes=pair.wheel_axes.T,
        sense=-pair.sense,
        driving=-pair.driving,
        base_radii=pair.base_radii[::-1],
    )


def conjugate_contact(pair: GearPair, rho: Array, z: Array) -> ConjugateContact:
    """Contact of points of the pinion's flank with a wheel that turns at the constant ratio.

    The wheel's flank is continued beyond its edges a little, where ``profile_room`` or ``lengthwise_room`` is
    negative. Of several maxima of the lead (a wavy flank) the highest counts.

    Parameters
    ----------
    pair : GearPair
    rho, z : (...) array [mm]
        Points of the pinion's flank.

    Returns
    -------
    ConjugateContact

    Raises
    ------
    GeometryError
        If no point of the pinion's flank comes near the wheel's.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> gears = [CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)]
    >>> contact = conjugate_contact(cylindrical_pair(CylindricalMesh(*gears)), np.array([51.0, 53.0]), np.zeros(2))
    >>> bool(np.abs(contact.lead).max() < 1e-12), contact.mating_radius.round(3).tolist()
    (True, [85.5, 83.867])
    """
    field, azimuth = EaseOff(pair), _azimuths(pair)
    shape = np.broadcast_shapes(np.shape(rho), np.shape(z))
    places = [np.broadcast_to(part, shape).ravel() for part in (rho, z)]
    blocks = range(0, places[0].size, BLOCK)
    parts = [_highest(field, azimuth, *(part[first : first + BLOCK] for part in places)) for first in blocks]
    joined = (np.concatenate([getattr(part, one.name) for part in parts]) for one in fields(ConjugateContact))
    return ConjugateContact(*(part.reshape(shape) for part in joined))


def _highest(field: EaseOff, azimuth: Array, rho: Array, z: Array) -> ConjugateContact:
    """Contact of points (n,), from samples at the azimuths (s,)."""
    pair, step = field.pair, azimuth[1] - azimuth[0]
    sampled = pair.sense * (azimuth[:, None] - pair.pinion.flank.theta(rho, z).value)
    lead, edges = field.heights(sampled, rho, z)
    lead = np.where(_near(pair, edges), lead, -np.inf)
    best = (lead.argmax(axis=0), np.arange(len(rho)))
    first = sampled[best]

    def slope(angle: Array, rows: Indices) -> Array:
        """de/d phi1 [mm/rad] at points that stay where they are on the pinion."""
        station = field.station(angle, rho[rows], z[rows])
        x, y, _ = station.point.T
        swept = np.stack([-y, x, np.zeros_like(x)], axis=-1)
        radial, around, axial = np.einsum("nij,nj->in", station.wheel_basis, swept)
        rate = station.wheel.rho * radial - around / station.wheel_rho + station.wheel.z * axial
        return pair.driving * pair.base_radii[1] * (rate - pair.ratio)

    every = np.arange(len(rho))
    rises = slope(first, every) > 0.0
    brackets = np.stack([np.where(rises, first, first - step), np.where(rises, first + step, first)])
    values = np.stack([slope(end, every) for end in brackets])
    angle = find_roots(slope, brackets, values, ANGLE_ACCURACY)
    touches = np.isfinite(lead[best]) & (values[0] >= 0.0) & (values[1] <= 0.0)
    station = field.station(angle, rho, z)
    value, distances = field.heights(angle, rho, z)
    rooms = distances[:, WHEEL_EDGES].reshape(-1, 2, 2).min(axis=-1).T
    known = (angle, value, station.wheel_rho, station.wheel_z, *rooms)
    return ConjugateContact(*(np.where(touches, part, np.nan) for part in known))


def _near(pair: GearPair, edges: Array) -> Mask:
    """Whether the wheel has a flank at the points, continued beyond its edges a little."""
    side = SIDE_SLACK * pair.face_width
    slack = np.array([SLACK[0] * pair.module, SLACK[1] * pair.module, side, side])
    return np.asarray((edges[..., WHEEL_EDGES] >= -slack).all(axis=-1))


def _azimuths(pair: GearPair) -> Array:
    """Even azimuths of the pinion (s,) [rad] between which its points pass through the wheel's teeth."""
    half = math.ceil(0.5 * math.pi / pair.pitch * PASSAGE_ANGLES)
    coarse = np.arange(-half, half + 1) * (pair.pitch / PASSAGE_ANGLES)
    rho, z = (part.ravel() for part in pair.pinion.flank.grid(*PASSAGE))
    angle = pair.sense * (coarse[:, None] - pair.pinion.flank.theta(rho, z).value)
    rows = np.flatnonzero(_near(pair, EaseOff(pair).heights(angle, rho, z)[1]).any(axis=-1))
    if not rows.size:
        raise GeometryError(
            "no common flank: the pinion's flank comes nowhere near the wheel's; check the tips of the teeth "
            "and how the gears are mounted"
        )
    low, high = coarse[rows[0]] - pair.pitch / PASSAGE_ANGLES, coarse[rows[-1]] + pair.pitch / PASSAGE_ANGLES
    return np.linspace(low, high, math.ceil((high - low) / pair.pitch * SAMPLES) + 1)


def mated_grid(pair: GearPair, profile: int, lengthwise: int) -> tuple[Array, Array]:
    """Even grid over the part of the pinion's flank that the wheel reaches at the constant ratio.

    Lengthwise it ends with the narrower gear, as found in the middle of the reached profile; along the profile each
    line ends where the mating gear's tip or form circle does, or the own ones.

    Parameters
    ----------
    pair : GearPair
    profile, lengthwise : int
        Points from the foot to the tip, and from the toe (z < 0) to the heel.

    Returns
    -------
    rho, z : (profile, lengthwise) array [mm]

    Raises
    ------
    GeometryError
        If the mating gear reaches no part of the flank.
    """
    u, v = (np.linspace(0.0, 1.0, count) for count in ROOM_SCAN)
    _, room = _rooms(pair, *np.meshgrid(u, v, indexing="ij"))
    row = int((room >= -ROUNDING).sum(axis=1).argmax())
    first, last = _ends(v, room[row][:, None], lambda at, _: _rooms(pair, np.full_like(at, u[row]), at)[1])
    v = np.linspace(first[0], last[0], lengthwise)
    room, _ = _rooms(pair, *np.meshgrid(u, v, indexing="ij"))
    low, high = _ends(u, room, lambda at, lines: _rooms(pair, at, v[lines])[0])
    share = np.linspace(0.0, 1.0, profile)[:, None]
    return _places(pair.pinion.flank, low + share * (high - low), v)


def _rooms(pair: GearPair, u: Array, v: Array) -> tuple[Array, Array]:
    """Room [modules] along the profile, and to the nearest edge of all, at shares (...) of the pinion's flank."""
    contact = conjugate_contact(pair, *_places(pair.pinion.flank, u, v))
    rooms = np.stack([contact.profile_room, contact.lengthwise_room])
    along, side = np.where(contact.exists, rooms / pair.module, NOWHERE)
    return along, np.minimum(along, side)


def _places(flank: Flank, u: Array, v: Array) -> tuple[Array, Array]:
    """(rho, z) at shares of the flank along the profile and lengthwise."""
    at = [part * (count - 1.0) for part, count in zip(np.broadcast_arrays(u, v), FINENESS, strict=True)]
    rho, z = (scipy.ndimage.map_coordinates(part, at, order=1, mode="nearest") for part in flank.grid(*FINENESS))
    return rho, z


def _ends(shares: Array, room: Array, edge: Edge) -> tuple[Array, Array]:
    """First and last share (m,) of each line at which there is room, from samples (shares, m)."""
    on = room >= -ROUNDING
    if not on.any(axis=0).all():
        raise GeometryError(
            "no common flank: at the constant ratio the mating gear does not reach the whole length of the flank, "
            "or none of it; check the tips of the teeth and how the gears are mounted"
        )
    lines, count = np.arange(room.shape[1]), len(shares)
    first, last = on.argmax(axis=0), count - 1 - on[::-1].argmax(axis=0)
    ends = []
    for inside, outside in ((first, np.maximum(first - 1, 0)), (last, np.minimum(last + 1, count - 1))):
        brackets = np.stack([shares[outside], shares[inside]])
        values = np.stack([room[outside, lines], room[inside, lines]])
        ends.append(find_roots(edge, brackets, values, EDGE_ACCURACY))
    return ends[0], ends[1]
