r"""Unloaded contact over whole revolutions, each tooth at its own place.

Pair 0 of a pitch is the one that comes to the pitch point when the pitch begins, pair +1 the one after it. Tooth pair
k stands apart by the index deviations of its two teeth and by the eccentricity of both gears, e_k along the transverse
line of action: its curve of the transmission error is that of identical teeth, lower by this,

.. math:: \mathrm{TE}_k(\varphi_1) = \mathrm{TE}_0(\varphi_1 - k\,2\pi/z_1 - s\,i_k/r_{b1}) - s\,e_k/r_{b2},

with i_k the index deviation of its pinion tooth, which has turned back by i_k/r_b1 (s = +1 where the pinion drives, -1
where the wheel does), and no tooth passes through its mate: the gears stand at the envelope of these curves. That is
exact for teeth that are turned about the axis of their gear; eccentricity counts to first order. The contacts of one
pitch serve all pitches, but for pinion teeth with index deviations, which have their own.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np

from loaded_tca.arrays import Array, Indices
from loaded_tca.errors import GeometryError
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.pairs.tooth_deviations import (
    ToothDeviations,
    ToothFlanks,
    eccentric_separation,
    transverse_normal,
)
from loaded_tca.plain import plain
from loaded_tca.unloaded.path import ContactPath, ContactPoint, trace_contact
from loaded_tca.unloaded.tooth_cycle import REACH, reach, teeth_between


@dataclass(frozen=True, eq=False)
class RevolutionPath:
    """Unloaded contact of all teeth over the positions of a revolution.

    Attributes
    ----------
    pair : GearPair
    pinion_angle : (n,) array [rad]
        phi1, from 0 on; at 0 the first tooth pair is nominally at the pitch point.
    pairs : (m,) int array
        Tooth pairs as each pitch counts them, ascending: 0 is at the pitch point where the pitch begins.
    pinion_tooth, wheel_tooth : (n, m) int array
        Teeth of each pair, from 0.
    transmission_error : (n,) array [rad]
        Rigid: the envelope.
    initial_separation : (n, m) array [rad]
        How far each pair is from touching; NaN where it is out of reach.
    contacts : ContactPath
        Different contacts, in the angles of their own teeth.
    contact : (n, m) int array
        Which of them each pair has at each position.
    gears : tuple of GearPair or None
        Of each contact, where its teeth have flanks of their own; None: ``pair``.
    """

    pair: GearPair
    pinion_angle: Array
    pairs: Indices
    pinion_tooth: Indices
    wheel_tooth: Indices
    transmission_error: Array
    initial_separation: Array
    contacts: ContactPath
    contact: Indices
    gears: tuple[GearPair | None, ...]

    def __len__(self) -> int:
        return len(self.pinion_angle)

    def pairs_at(self, position: int) -> Iterator[tuple[int, ContactPoint, float, GearPair | None]]:
        """Number, contact, initial separation [rad] and own gears of the tooth pairs within reach at a position."""
        for column in np.flatnonzero(np.isfinite(self.initial_separation[position])):
            place, separation = self.contact[position, column], float(self.initial_separation[position, column])
            yield int(self.pairs[column]), self._points[place], max(separation, 0.0), self.gears[place]

    @cached_property
    def _points(self) -> list[ContactPoint]:
        """The contacts one by one, the same objects wherever a pair has them."""
        return [self.contacts[k] for k in range(len(self.contacts))]


def trace_revolution(
    pair: GearPair,
    deviations: tuple[ToothDeviations, ToothDeviations],
    pitches: int,
    per_pitch: int,
    first_teeth: tuple[int, int] = (0, 0),
    flanks: ToothFlanks | None = None,
) -> RevolutionPath:
    """Unloaded contact of all teeth over whole pitches.

    Parameters
    ----------
    pair : GearPair
    deviations : (ToothDeviations, ToothDeviations)
        Of pinion and wheel.
    pitches, per_pitch : int
        How many pitches follow each other, and positions in each: n = pitches per_pitch.
    first_teeth : (int, int)
        Teeth of pinion and wheel that are at the pitch point at the first position.
    flanks : ToothFlanks, optional
        Where they differ tooth by tooth; default: all are those of the pair.

    Raises
    ------
    GeometryError
        If at some position none of the teeth touches.

    Examples
    --------
    A wheel of which tooth 2 is set back by 10 um: where two pairs are in contact, the other one leads.

    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> gears = [CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (20, 30)]
    >>> index = np.where(np.arange(30) == 2, 0.010, 0.0)
    >>> deviations = ToothDeviations(np.zeros(20)), ToothDeviations(index)
    >>> path = trace_revolution(cylindrical_pair(CylindricalMesh(*gears)), deviations, pitches=5, per_pitch=2)
    >>> error = 1e3 * path.transmission_error * path.pair.base_radii[1]
    >>> [round(float(value), 6) + 0.0 for value in error]
    [0.0, 0.0, 0.0, 0.0, -10.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    """
    alike = ToothFlanks((np.zeros(pair.teeth[0], dtype=int), np.zeros(pair.teeth[1], dtype=int)), {})
    kinds_of, gears = (flanks or alike).kinds, {(0, 0): pair, **(flanks or alike).gears}
    spread = sum(float(np.ptp(one.index)) for one in deviations) / pair.module
    windows = [reach(one, REACH * min(len(gears), 2) + spread) for one in gears.values()]
    low, high = min(window[0] for window in windows), max(window[1] for window in windows)
    shift = float(np.abs(deviations[0].index).max()) / pair.base_radii[0]
    last = pair.pitch * (1.0 - 1.0 / per_pitch)
    pairs = np.sort(teeth_between(0.0, last, (low - shift, high + shift), pair.pitch))
    turn, rest = np.divmod(np.arange(pitches * per_pitch), per_pitch)
    phase = rest / per_pitch
    teeth = [(turn[:, None] + pairs + first) % count for first, count in zip(first_teeth, pair.teeth, strict=True)]
    of_pinion = deviations[0].index[teeth[0]]
    own = (pair.pitch * phase)[:, None] - pair.pitch * pairs - pair.driving * of_pinion / pair.base_radii[0]
    kinds = np.stack([of_tooth[tooth] for of_tooth, tooth in zip(kinds_of, teeth, strict=True)], axis=-1)
    path, contact, own_gears = _traced(gears, own, kinds, (low, high))
    known = contact >= 0
    height = np.where(path.in_contact, pair.driving * path.transmission_error * pair.base_radii[1], -np.inf)
    angle = pair.pitch * (turn + phase)
    turned = [
        ratio * angle + 2.0 * np.pi * first / count
        for ratio, first, count in zip((1.0, pair.ratio), first_teeth, pair.teeth, strict=True)
    ]
    common, own_part = _eccentric(pair, deviations, (turned[0], turned[1]), path, contact)
    apart_by = of_pinion + deviations[1].index[teeth[1]] + own_part
    heights = np.where(known & np.isfinite(height[contact]), height[contact] - apart_by, -np.inf)
    top = heights.max(axis=1)
    if (apart := np.isinf(top)).any():
        raise GeometryError(
            f"no tooth pair touches at {int(apart.sum())} of {len(angle)} positions, first at pinion angle "
            f"{plain(angle[apart][0], 6)} rad"
        )
    separation = np.where(heights >= top[:, None] - REACH * pair.module, top[:, None] - heights, np.nan)
    used = np.isfinite(separation).any(axis=0)
    return RevolutionPath(
        pair=pair,
        pinion_angle=angle,
        pairs=pairs[used],
        pinion_tooth=teeth[0][:, used],
        wheel_tooth=teeth[1][:, used],
        transmission_error=pair.driving * (top - common) / pair.base_radii[1],
        initial_separation=separation[:, used] / pair.base_radii[1],
        contacts=path,
        contact=contact[:, used],
        gears=own_gears,
    )


def _traced(
    gears: Mapping[tuple[int, int], GearPair], own: Array, kinds: Indices, window: tuple[float, float]
) -> tuple[ContactPath, Indices, tuple[GearPair | None, ...]]:
    """Different contacts of pairings of kinds (n, m, 2) at own pinion angles (n, m), each once.

    Returns the contacts, which of them each pair has (-1: out of the window), and their own gears, None of the common.
    """
    within = (own >= window[0]) & (own <= window[1])
    parts: list[ContactPath] = []
    contact = np.full(own.shape, -1)
    owners: list[GearPair | None] = []
    for kind, pair in gears.items():
        rows = within & (kinds == kind).all(axis=-1)
        if not rows.any():
            continue
        angles, place = np.unique(own[rows], return_inverse=True)
        contact[rows] = len(owners) + place
        owners += [None if kind == (0, 0) else pair] * len(angles)
        parts.append(_contacts(pair, angles))
    if not parts:
        raise GeometryError("no common flank: none of the tooth pairs comes into reach")
    joined = {one.name: np.concatenate([getattr(part, one.name) for part in parts]) for one in fields(ContactPath)}
    return ContactPath(**joined), contact, tuple(owners)


def _contacts(pair: GearPair, angles: Array) -> ContactPath:
    """Contacts at own pinion angles, and at 0: those of some teeth alone may all be apart."""
    return trace_contact(pair, np.append(angles, 0.0), warn=False)[: len(angles)]


def _eccentric(
    pair: GearPair,
    deviations: tuple[ToothDeviations, ToothDeviations],
    turned: tuple[Array, Array],
    path: ContactPath,
    contact: Indices,
) -> tuple[Array, Array]:
    """Separation [mm] by eccentricity: of all pairs in common (n,), and of each on top of it (n, 1) or (n, m)."""
    none = np.zeros(len(contact))
    if not any(one.eccentricity for one in deviations):
        return none, none[:, None]
    normal = transverse_normal(pair)
    if normal is not None:
        return eccentric_separation(pair, deviations, turned, normal), none[:, None]
    directions = path.normal * (pair.base_radii[1] / path.wheel_lever)[:, None]
    angles = turned[0][:, None], turned[1][:, None]
    return none, eccentric_separation(pair, deviations, angles, directions[contact])
