"""Where gears stand under loads of their supports: moved as rigid bodies, and what is left of their motions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.compliance.model import SumOfParts
from loaded_tca.errors import GeometryError
from loaded_tca.loaded.loaded_contact import LoadedContact
from loaded_tca.loaded.tooth_contact import Coupling
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.plain import plain
from loaded_tca.supports import SupportCompliance
from loaded_tca.unloaded import ContactPoint, trace_contact
from loaded_tca.unloaded.tooth_cycle import pitches_within_reach

Loads = tuple[Array, Array]
"""Of the stations of pinion and wheel, (6 m,) each [N, N mm], in the axes of each gear's own frame."""


def no_loads(supports: SupportCompliance) -> Loads:
    """Of the stations of both gears."""
    pinion, wheel = (np.zeros(len(support.compliance)) for support in supports.supports)
    return pinion, wheel


def standing_under(supports: SupportCompliance, loads: Loads) -> SupportCompliance:
    """Supports at rest in their pair moved as rigid bodies by what loads of the stations move."""
    motions = supports.bodies(loads)
    return supports.moved(motions) if any(one.any() for one in motions) else supports


def moved_bending(bending: SumOfParts, near: SupportCompliance, loads: Loads) -> tuple[SumOfParts, Coupling | None]:
    """Bending of the pair moved by loads of its supports, which are linear ``near`` these, and what opens its gaps.

    Beside the motions by the forces: those of other loads on the shafts, less those that moved the pair. None opens the
    gaps of a pair on rigid supports.
    """
    there = standing_under(near, loads)
    displacement = None if near.is_rigid else partial(there.gap_by_motion, motions=given_motions(near, loads))
    return bending.on_supports(there).mounted(there.pair), displacement


def moved_by(supports: SupportCompliance, loads: Loads) -> GearPair:
    """The pair of supports, at rest, moved as rigid bodies by what loads of the stations move."""
    return standing_under(supports, loads).pair


def at_rest(pair: GearPair, supports: SupportCompliance | None) -> GearPair:
    """The pair without load: as other loads alone move it on its supports, if it has some."""
    return pair if supports is None else moved_by(supports, no_loads(supports))


def moved_too_far(error: GeometryError, torque: float) -> GeometryError:
    """The error of a moved pair, with the torque [N mm] that moves it."""
    return GeometryError(f"{error}; under {plain(1e-3 * torque, 6)} N m the supports let the gears move too far")


def pitches_apart(pair: GearPair, supports: SupportCompliance | None, torques: Sequence[float]) -> int:
    """How many pitches tooth pairs within reach are apart, at rest and moved by each pinion torque [N mm].

    The force of a torque acts where the flanks touch first without load.

    Parameters
    ----------
    pair : GearPair
        Of the scene.
    supports : SupportCompliance or None
        In that pair; None: the gears are rigid.
    torques : sequence of float [N mm]

    Raises
    ------
    GeometryError
        If the moved flanks are not in contact.
    """
    resting = at_rest(pair, supports)
    apart = pitches_within_reach(resting)
    if supports is None:
        return apart
    for torque in sorted(set(torques) - {0.0}, reverse=True):  # what the largest one asks for is told first
        try:
            loads = loads_at_first_contact(supports, resting, torque)
            apart = max(apart, pitches_within_reach(moved_by(supports.linear_near(loads), loads)))
        except GeometryError as error:
            raise moved_too_far(error, torque) from None
    return apart


def loads_at_first_contact(supports: SupportCompliance, at_rest: GearPair, torque: float) -> Loads:
    """Loads of the stations if the force of a pinion torque [N mm] acts where the pair at rest touches at phi1 = 0."""
    contact = trace_contact(at_rest, [0.0], warn=False)[0]
    if not contact.in_contact:
        return no_loads(supports)
    unit = standing_under(supports, no_loads(supports)).mounted(at_rest).loads(_OnePoint(contact))
    pinion, wheel = (torque / contact.pinion_lever * load[0] for load in unit)
    return pinion, wheel


@dataclass(frozen=True, eq=False)
class _OnePoint:
    """A contact of one slice at a contact point."""

    contact: ContactPoint

    @property
    def y(self) -> Array:
        return np.zeros(1)

    @property
    def force_line(self) -> Array:
        return np.zeros(1)

    @property
    def origin(self) -> Array:
        return np.asarray(self.contact.point)

    @property
    def axes(self) -> Array:
        return np.stack([np.zeros(3), np.zeros(3), self.contact.normal])


def given_motions(supports: SupportCompliance, loads: Loads) -> list[Array]:
    """Motions (6 m,) of the stations beside those by the forces, in the pair moved by loads: d = a . this."""
    motions = []
    for support, motion in zip(supports.supports, supports.bodies(loads), strict=True):
        body = support.with_middle(motion)
        motions.append(-body if support.motion is None else support.motion - body)
    return motions


def loads_at(supports: SupportCompliance, contacts: Sequence[Sequence[LoadedContact | None]]) -> tuple[Array, Array]:
    """The same of contacts by position."""
    at_positions: list[tuple[Array, Array]] = []
    for at in contacts:
        there = [one for one in at if one is not None]
        pinion, wheel = (np.full(len(support.compliance), 0.0 if there else math.nan) for support in supports.supports)
        for one in there:
            on_pinion, on_wheel = supports.loads(one.separation)
            pinion, wheel = pinion + one.slice_force @ on_pinion, wheel + one.slice_force @ on_wheel
        at_positions.append((pinion, wheel))
    pinions, wheels = zip(*at_positions, strict=True)
    return np.stack(pinions), np.stack(wheels)
