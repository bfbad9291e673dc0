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

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from loaded_tca.arrays import Array, Indices
from loaded_tca.errors import GeometryError
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.pairs.tooth_deviations import ToothDeviations, eccentric_separation, transverse_line_of_action
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

    def __len__(self) -> int:
        return len(self.pinion_angle)

    def pairs_at(self, position: int) -> Iterator[tuple[int, ContactPoint, float]]:
        """Number, contact and initial separation [rad] of the tooth pairs within reach at a position."""
        for column in np.flatnonzero(np.isfinite(self.initial_separation[position])):
            point = self._points[self.contact[position, column]]
            yield int(self.pairs[column]), point, float(max(self.initial_separation[position, column], 0.0))

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
    spread = sum(float(np.ptp(one.index)) for one in deviations) / pair.module
    low, high = reach(pair, REACH + spread)
    shift = float(np.abs(deviations[0].index).max()) / pair.base_radii[0]
    last = pair.pitch * (1.0 - 1.0 / per_pitch)
    pairs = np.sort(teeth_between(0.0, last, (low - shift, high + shift), pair.pitch))
    turn = np.arange(pitches * per_pitch) // per_pitch
    phase = np.arange(pitches * per_pitch) % per_pitch
    number = turn[:, None] + pairs
    pinion_tooth, wheel_tooth = ((number + first) % z for first, z in zip(first_teeth, pair.teeth, strict=True))
    of_pinion = deviations[0].index[pinion_tooth]
    own, contact = _different(pair.pitch * phase / per_pitch, pairs, pair, of_pinion)
    within = (own >= low) & (own <= high)
    if not within.any():
        raise GeometryError("no common flank: none of the tooth pairs comes into reach")
    path = trace_contact(pair, own[within], warn=False)
    known, contact = within[contact], (np.cumsum(within) - 1)[contact]
    height = np.where(path.in_contact, pair.driving * path.transmission_error * pair.base_radii[1], -np.inf)
    angle = pair.pitch * (turn + phase / per_pitch)
    turned = tuple(
        ratio * angle + 2.0 * np.pi * first / z
        for ratio, first, z in zip((1.0, pair.ratio), first_teeth, pair.teeth, strict=True)
    )
    index = of_pinion + deviations[1].index[wheel_tooth]
    heights = np.where(known, height[np.where(known, contact, 0)], -np.inf) - index
    top = heights.max(axis=1)
    if (apart := np.isinf(top)).any():
        raise GeometryError(
            f"no tooth pair touches at {int(apart.sum())} of {len(angle)} positions, first at pinion angle "
            f"{angle[apart][0]:.6g} rad"
        )
    separation = np.where(heights >= top[:, None] - REACH * pair.module, top[:, None] - heights, np.nan)
    used = np.isfinite(separation).any(axis=0)
    common = _eccentric(pair, deviations, (turned[0], turned[1]))
    return RevolutionPath(
        pair=pair,
        pinion_angle=angle,
        pairs=pairs[used],
        pinion_tooth=pinion_tooth[:, used],
        wheel_tooth=wheel_tooth[:, used],
        transmission_error=pair.driving * (top - common) / pair.base_radii[1],
        initial_separation=separation[:, used] / pair.base_radii[1],
        contacts=path,
        contact=contact[:, used],
    )


def _different(begin: Array, pairs: Indices, pair: GearPair, of_pinion: Array) -> tuple[Array, Indices]:
    """Own pinion angles that differ, ascending, and which of them each pair (n, m) has."""
    own = begin[:, None] - pair.pitch * pairs - pair.driving * of_pinion / pair.base_radii[0]
    angles, place = np.unique(own, return_inverse=True)
    return angles, place.reshape(own.shape)


def _eccentric(
    pair: GearPair, deviations: tuple[ToothDeviations, ToothDeviations], turned: tuple[Array, Array]
) -> Array:
    """Separation (n,) [mm] of all pairs by eccentricity, zero without."""
    if not any(one.eccentricity for one in deviations):
        return np.zeros(len(turned[0]))
    contact = trace_contact(pair, [0.0], warn=False)[0]
    direction = transverse_line_of_action(pair, contact.normal, contact.wheel_lever)
    return eccentric_separation(pair, deviations, turned, direction)
