r"""What a bearing does against the motion of its shaft; linear bearings; where a shaft comes to rest on rolling ones.

It rests in the motion of the least potential energy,

.. math:: \Pi(q) = \tfrac12 q^T K q - f^T q + \sum_b V_b(q_b)

Both parts are convex. Newton's steps are halved until the energy decreases, since bearings whose elements are all apart
have no stiffness: these begin as joints, and keep a small part of that stiffness in the tangent, not in the forces.

References
----------
Nocedal and Wright 2006, Numerical Optimization, chapter 3 (Newton's method with backtracking).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
import scipy

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, Indices, keep_copies
from loaded_tca.errors import InputError


@dataclass(frozen=True, eq=False)
class Reaction:
    """What a bearing does against a motion of its inner ring.

    Attributes
    ----------
    energy : float [N mm]
    force : (6,) array [N, N mm]
        On the bearing.
    tangent : (6, 6) array [N, N mm over mm, rad]
        Symmetric, never negative.
    whole : (6,) array [N, N mm]
        What the parts of the force are without their signs: those of pressed bearings are large and cancel, and so
        much is their rounding.
    """

    energy: float
    force: Array
    tangent: Array
    whole: Array


class AnyBearing(Protocol):
    """A bearing of a shaft: where it is, and what it holds."""

    @property
    def at(self) -> float:
        """Its place on the axis [mm]."""

    @property
    def joint(self) -> Array:
        """Stiffness (6, 6) [N, N mm over mm, rad] of what it holds, whatever its load."""

    @property
    def takes(self) -> tuple[int, ...]:
        """Senses along z of the thrusts of the shaft that it takes: +1, -1."""

    def reaction(self, motion: Array) -> Reaction:
        """What it does against a motion (6,) of its inner ring [mm, rad]."""


@checked
@dataclass(frozen=True, eq=False)
class Bearing:
    """A linear bearing: its place on the axis [mm], and its stiffness (6, 6) [N, N mm over mm, rad], symmetric."""

    at: float
    stiffness: Array

    def __post_init__(self) -> None:
        keep_copies(self)

    @property
    def joint(self) -> Array:
        """Stiffness of what it holds."""
        return self.stiffness

    @property
    def takes(self) -> tuple[int, ...]:
        """Senses along z of the thrusts that it takes: both or none."""
        return (1, -1) if self.stiffness[2, 2] > 0.0 else ()

    def reaction(self, motion: Array) -> Reaction:
        """What it does against a motion (6,)."""
        force = self.stiffness @ motion
        whole = np.abs(self.stiffness) @ np.abs(motion)
        return Reaction(0.5 * float(motion @ force), np.asarray(force), self.stiffness, whole)


LOOSE = 1e-7
"""Part of the stiffness of a joint that a rolling bearing has at least: none of its elements may be loaded."""
IN_BALANCE = 1e-10
"""Forces that are left over, over those on the shaft, where Newton's method ends."""
ROUNDING = 4.0 * float(np.finfo(float).eps)
"""Of forces in the shaft and of elements of bearings."""
MOST_STEPS, SHORTEST = 100, 2.0**-60
"""Steps of Newton's method; part of one that is none."""
SUFFICIENT = 1e-4
"""Part of the decrease that the slope promises."""


class Seat(NamedTuple):
    """A bearing, and its motions among those of all nodes."""

    bearing: AnyBearing
    motions: slice

    def stiffness(self, reaction: Reaction) -> Array:
        """Stiffness (6, 6) of its tangent, and of what it has without any load."""
        if isinstance(self.bearing, Bearing):
            return reaction.tangent
        return np.asarray(reaction.tangent + LOOSE * self.bearing.joint)


def solved(stiffness: Array, loads: Array, free: Indices) -> Array:
    """Motions under loads, over all nodes; those that are not ``free`` (indices) are zero.

    Motions are scaled to a stiffness of one each: mm stand beside rad, soft ones beside stiff ones.
    """
    roots = np.sqrt(stiffness.diagonal()[free])
    motions = np.zeros(loads.shape)
    rows = loads[free].reshape(len(free), -1) / roots[:, None]
    scaled = stiffness[np.ix_(free, free)] / np.outer(roots, roots)
    motions[free] = (scipy.linalg.solve(scaled, rows, assume_a="pos") / roots[:, None]).reshape(motions[free].shape)
    return motions


def balanced(stiffness: Array, load: Array, free: Indices, seats: Sequence[Seat]) -> tuple[Array, list[Reaction]]:
    """Motion of the least energy under a load, and what the bearings do there.

    Parameters
    ----------
    stiffness : (n, n) array [N, N mm over mm, rad]
        Without bearings.
    load : (n,) array [N, N mm]
    free : (m,) array of int
        Motions that are not given as zero.
    seats : sequence of Seat

    Returns
    -------
    motion : (n,) array [mm, rad]
    reactions : list of Reaction

    Raises
    ------
    InputError
        If there is none: the bearings do not hold the shaft under this load.
    """
    whole = _Whole(stiffness, load, free, seats)
    now = whole.at(solved(whole.joints, load, free))
    for _ in range(MOST_STEPS):
        if whole.size(now.rest) <= max(IN_BALANCE * whole.carried(now), whole.rounding(now)):
            return now.motion, now.reactions
        now = whole.after_a_step(now)
    raise InputError(
        "bearings: no balance of the shaft on its rolling bearings; a bearing with a contact angle under a radial load "
        "needs another bearing that takes its thrust"
    )


class _State(NamedTuple):
    """Energy at a motion, forces that are left over, and what the bearings do."""

    motion: Array
    energy: float
    rest: Array
    reactions: list[Reaction]


class _Whole:
    """A shaft with its bearings under a load."""

    def __init__(self, stiffness: Array, load: Array, free: Indices, seats: Sequence[Seat]) -> None:
        self.stiffness, self.load, self.free, self.seats = stiffness, load, free, seats
        self.joints = self._with_bearings([seat.bearing.joint for seat in seats])
        self.roots = np.sqrt(self.joints.diagonal()[free])

    def _with_bearings(self, of_bearings: Sequence[Array]) -> Array:
        whole = self.stiffness.copy()
        for seat, own in zip(self.seats, of_bearings, strict=True):
            whole[seat.motions, seat.motions] += own
        return whole

    def size(self, forces: Array) -> float:
        """The largest of forces [N^0.5 mm^0.5], each by the stiffness of its motion."""
        return float(np.abs(forces[self.free] / self.roots).max())

    def carried(self, state: _State) -> float:
        """The largest force on the shaft, of the load and of the bearings."""
        forces = np.abs(self.load)
        for seat, reaction in zip(self.seats, state.reactions, strict=True):
            forces[seat.motions] = np.maximum(forces[seat.motions], np.abs(reaction.force))
        return self.size(forces)

    def rounding(self, state: _State) -> float:
        """Rounding of the forces in the shaft and in its bearings.

        The shaft is stiff: ways through clearances make more of it than small loads. Elements of pressed bearings
        carry much where the shaft carries nothing.
        """
        inner = np.abs(self.stiffness) @ np.abs(state.motion)
        for seat, reaction in zip(self.seats, state.reactions, strict=True):
            inner[seat.motions] += reaction.whole
        return ROUNDING * self.size(inner)

    def at(self, motion: Array) -> _State:
        reactions = [seat.bearing.reaction(motion[seat.motions]) for seat in self.seats]
        inner = self.stiffness @ motion
        rest = self.load - inner
        for seat, reaction in zip(self.seats, reactions, strict=True):
            rest[seat.motions] -= reaction.force
        energy = float(motion @ (0.5 * inner - self.load)) + sum(one.energy for one in reactions)
        return _State(motion, energy, rest, reactions)

    def after_a_step(self, now: _State) -> _State:
        """The state after a step of Newton's method, halved until the energy decreases or the forces halve."""
        tangents = [seat.stiffness(reaction) for seat, reaction in zip(self.seats, now.reactions, strict=True)]
        step, share = solved(self._with_bearings(tangents), now.rest, self.free), 1.0
        slope, half = float(now.rest @ step), 0.5 * self.size(now.rest)
        after = self.at(now.motion + step)
        while after.energy > now.energy - SUFFICIENT * share * slope and self.size(after.rest) >= half:
            share *= 0.5
            if share < SHORTEST:
                break
            after = self.at(now.motion + share * step)
        return after
