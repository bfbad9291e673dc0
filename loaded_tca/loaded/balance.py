"""Forces of tooth pairs whose contact deformations are powers of their forces, under one common rotation."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from operator import sub
from typing import NamedTuple

import numpy as np
import scipy

from loaded_tca.arrays import Array
from loaded_tca.errors import ConvergenceError
from loaded_tca.plain import plain

EXPONENTS = (0.05, 3.0)
"""Range of the exponent of a contact deformation over the force; above 1: at a cap on the pressure; far below 2/3: in a
corner of a flank, where cells with little material touch before those that carry."""
POINT_EXPONENT = 2.0 / 3.0
TELLING = 0.05
"""Relative difference of two loads from which an exponent follows: whole cells hide it where they are closer, ..."""
SURPRISE = 1e-3
"""... but for a deformation that misses the law by more than this part, as at a cap on the pressure."""
SAME_LOAD = 1e-4
MOST_STEPS = 200
"""Newton steps before giving up; five to ten are the rule."""
STEP_TOLERANCE = 1e-12
"""Change of the forces, over the largest, that is none."""
LARGEST_FALL = 0.1
STALLED = 1e-8
"""Change below which steps that do not shrink are rounding: initial separations may be large against deformations."""
LITTLE = 1e-3
"""Force of a pair over the largest, below which it parts at once where it is not closed; it may come back."""


@dataclass(frozen=True)
class PowerLaw:
    """Contact deformation near a load: deformation (F/load)^exponent.

    Parameters
    ----------
    load : float [N]
    deformation : float [mm]
        Under that load; both positive.
    exponent : float
        2/3 for a point contact, nearly 1 for a line.

    Examples
    --------
    >>> law = PowerLaw(1000.0, 0.004)
    >>> round(law.deformation_under(8000.0), 9), round(law.force_at(0.016), 6)
    (0.016, 8000.0)
    """

    load: float
    deformation: float
    exponent: float = POINT_EXPONENT

    def deformation_under(self, force: float) -> float:
        """Contact deformation [mm] under a force >= 0 [N]."""
        return self.deformation * (force / self.load) ** self.exponent

    def force_at(self, deformation: float) -> float:
        """Force [N] at a contact deformation [mm]; none where that is not positive."""
        return self.load * (deformation / self.deformation) ** (1.0 / self.exponent) if deformation > 0.0 else 0.0

    def through(self, load: float, deformation: float) -> PowerLaw:
        """Return the law through a further solution, its exponent that between the two."""
        exponent, ratio = self.exponent, load / self.load
        surprise = abs(deformation / self.deformation_under(load) - 1.0)
        if abs(ratio - 1.0) > TELLING or (surprise > SURPRISE and abs(ratio - 1.0) > SAME_LOAD):
            exponent = float(np.clip(math.log(deformation / self.deformation) / math.log(ratio), *EXPONENTS))
        return PowerLaw(load, deformation, exponent)


def balance(
    laws: Sequence[PowerLaw],
    separations: Array,
    levers: Array,
    torque: float,
    compliance: Array,
    start: Array | None = None,
) -> Array:
    """Forces of tooth pairs whose contact laws are known.

    Parameters
    ----------
    laws : sequence of PowerLaw, (k,)
    separations : (k,) array [rad]
        Initial separations, as rotations of the wheel.
    levers : (2, k) array [mm]
        Of the normal forces about the axes of pinion and wheel.
    torque : float [N mm]
        Of the pinion, positive.
    compliance : (k, k) array [mm/N]
        Deflection of pair i under a unit force on pair j.
    start : (k,) array, optional [N]
        Forces near the wanted ones, some of them not zero; default: all alike.

    Returns
    -------
    (k,) array [N]
        Zero where a pair is not in contact. They balance the torque to rounding.

    Raises
    ------
    ConvergenceError
        If no rotation balances the torque, as with levers that are not positive.

    Examples
    --------
    >>> laws, levers = [PowerLaw(1000.0, 0.004)] * 2, np.full((2, 2), 50.0)
    >>> balance(laws, np.array([0.0, 0.0]), levers, 1e5, np.zeros((2, 2))).round(6)
    array([1000., 1000.])
    >>> balance(laws, np.array([0.0, 1.0]), levers, 1e5, np.zeros((2, 2))).round(6)
    array([2000.,    0.])
    """
    if not (levers > 0.0).all():
        raise ConvergenceError(f"load sharing: no rotation gives a torque of {plain(torque, 6)} N mm", last=levers)
    lever, turning = levers.tolist()
    apart = (turning * (separations - separations.min())).tolist()
    pairs = [_Pair(*parts) for parts in zip(laws, apart, lever, turning, strict=True)]
    between = compliance - np.diag(compliance.diagonal())
    forces, change = [torque / sum(lever)] * len(pairs) if start is None else start.tolist(), math.inf
    for _ in range(MOST_STEPS):
        target = _newton_step(pairs, torque, forces, compliance, between)
        before, change = change, max(map(abs, map(sub, target, forces))) / max(target)
        forces = target
        if change <= STEP_TOLERANCE or before <= change <= STALLED:
            found = np.array(forces)
            return np.asarray(found * (torque / (levers[0] @ found)))
    raise ConvergenceError(f"load sharing: forces of the tooth pairs not found in {MOST_STEPS} steps", last=forces)


class _Pair(NamedTuple):
    """What the balance knows of a tooth pair: numbers, in which a few pairs take less time than in arrays."""

    law: PowerLaw
    separation: float  # along its line of action [mm]
    lever: float
    wheel_lever: float


def _newton_step(
    pairs: Sequence[_Pair], torque: float, forces: Sequence[float], compliance: Array, between: Array
) -> list[float]:
    """Forces (k,) after one step for the pairs under load, and those that come under load or part.

    ``between``: the compliance (k, k) [mm/N] without that of the pairs themselves.

    No force falls below a tenth at once. The deformation grows without end over a force that vanishes (or not at all),
    so that a pair parts once its force is little and the rotation that the heaviest pair asks for, less the coupling,
    does not close it: that of the step counts on forces below zero.
    """
    loaded = [n for n, force in enumerate(forces) if force > 0.0]
    tangent, bent = compliance[loaded][:, loaded], (compliance @ forces).tolist()
    sides = []
    for row, n in enumerate(loaded):
        pair, force = pairs[n], forces[n]
        pressed = pair.law.deformation_under(force)
        sides.append((pair.wheel_lever, -pressed - bent[n] - pair.separation))
        tangent[row, row] += pair.law.exponent * pressed / force
    _, _, moved, singular = scipy.linalg.lapack.dgesv(tangent, sides)  # a fourth of the time that NumPy takes
    if singular:
        raise ConvergenceError(
            "load sharing: forces of the tooth pairs are not determined by one rotation", last=forces
        )
    solved, carried, rate = moved.tolist(), 0.0, 0.0
    for n, (turned, rest) in zip(loaded, solved, strict=True):
        carried += pairs[n].lever * (forces[n] + rest)
        rate += pairs[n].lever * turned
    target, rotation = [*forces], (torque - carried) / rate
    for n, (turned, rest) in zip(loaded, solved, strict=True):
        wanted = forces[n] + rotation * turned + rest
        target[n] = min(max(wanted, LARGEST_FALL * forces[n]), torque / pairs[n].lever)
    most = max(target)
    by_others = (between @ target).tolist()
    heaviest = target.index(most)
    pair, own = pairs[heaviest], float(compliance[heaviest, heaviest])
    asked = pair.separation + pair.law.deformation_under(most) + own * most + by_others[heaviest]
    asked /= pair.wheel_lever
    for n, pair in enumerate(pairs):
        if target[n] < LITTLE * most and pair.wheel_lever * asked - pair.separation <= by_others[n]:
            target[n] = 0.0
    for n, pair in enumerate(pairs):
        if forces[n] == 0.0 and (closed := pair.wheel_lever * rotation - pair.separation - by_others[n]) > 0.0:
            target[n] = min(pair.law.force_at(closed), max(target))
    return target
