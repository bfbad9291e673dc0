"""Forces of tooth pairs whose contact deformations are powers of their forces, under one common rotation."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import ConvergenceError

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


def balance(laws: Sequence[PowerLaw], separations: Array, levers: Array, torque: float, compliance: Array) -> Array:
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
        raise ConvergenceError(f"load sharing: no rotation gives a torque of {torque:.6g} N mm", last=levers)
    separations = separations - separations.min()
    forces, change = np.full(len(laws), torque / float(levers[0].sum())), math.inf
    for _ in range(MOST_STEPS):
        target = _newton_step(laws, separations, levers, torque, compliance, forces)
        before, change = change, float(np.abs(target - forces).max() / target.max())
        forces = target
        if change <= STEP_TOLERANCE or before <= change <= STALLED:
            return forces * (torque / (levers[0] @ forces))
    raise ConvergenceError(f"load sharing: forces of the tooth pairs not found in {MOST_STEPS} steps", last=forces)


def _newton_step(
    laws: Sequence[PowerLaw], separations: Array, levers: Array, torque: float, compliance: Array, forces: Array
) -> Array:
    """Forces (k,) after one step for the pairs under load, and those that come under load or part.

    No force falls below a tenth at once. The deformation grows without end over a force that vanishes (or not at all),
    so that a pair parts once its force is little and the rotation that the heaviest pair asks for, less the coupling,
    does not close it: that of the step counts on forces below zero.
    """
    loaded = np.flatnonzero(forces).tolist()
    carried, lever, wheel_lever = forces[loaded], levers[0, loaded], levers[1, loaded]
    tangent = compliance[loaded][:, loaded]
    pressed = np.array([laws[n].deformation_under(forces[n]) for n in loaded])
    missing = -pressed - tangent @ carried - wheel_lever * separations[loaded]
    tangent.flat[:: len(loaded) + 1] += np.array([laws[n].exponent for n in loaded]) * pressed / carried
    by_rotation, by_rest = np.linalg.solve(tangent, np.array([wheel_lever, missing]).T).T
    rotation = (torque - lever @ (carried + by_rest)) / (lever @ by_rotation)
    target = forces.copy()
    wanted = carried + rotation * by_rotation + by_rest
    target[loaded] = np.minimum(np.maximum(wanted, LARGEST_FALL * carried), torque / lever)
    displaced, heaviest = compliance @ target, int(target.argmax())
    deflected = laws[heaviest].deformation_under(target[heaviest]) + displaced[heaviest]
    asked = separations[heaviest] + deflected / levers[1, heaviest]
    by_others = displaced - compliance.diagonal() * target
    closed = levers[1] * (asked - separations) > by_others
    target[(target < LITTLE * target.max()) & ~closed] = 0.0
    deflection = levers[1] * (rotation - separations) - by_others
    for n in np.flatnonzero((forces == 0.0) & (deflection > 0.0)).tolist():
        target[n] = min(laws[n].force_at(deflection[n]), target.max())
    return target
