"""Forces of tooth pairs whose approaches are powers of their forces, under one common rotation."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from loaded_tca.errors import ConvergenceError
from loaded_tca.flanks.jet import Array

EXPONENTS = (0.3, 2.0)
"""Range of the exponent of an approach over the force; above 1: at a cap on the pressure."""
POINT_EXPONENT = 2.0 / 3.0
TELLING = 1e-4
"""Relative difference of two loads from which an exponent follows."""
MOST_SWEEPS = 500
MOST_STEPS = 200
"""Of a rotation that grows threefold, until its torque is more than asked for."""
SWEEP_TOLERANCE = 1e-13


@dataclass(frozen=True)
class PowerLaw:
    """Approach of a contact near a load: approach (F/load)^exponent.

    Parameters
    ----------
    load : float [N]
    approach : float [mm]
        Under that load; both positive.
    exponent : float
        2/3 for a point contact, nearly 1 for a line.

    Examples
    --------
    >>> law = PowerLaw(1000.0, 0.004)
    >>> round(law.approach_under(8000.0), 9), round(law.force_at(0.016), 6)
    (0.016, 8000.0)
    """

    load: float
    approach: float
    exponent: float = POINT_EXPONENT

    def approach_under(self, force: float) -> float:
        """Approach [mm] under a force >= 0 [N]."""
        return self.approach * (force / self.load) ** self.exponent

    def force_at(self, approach: float) -> float:
        """Force [N] at an approach [mm]; none where that is not positive."""
        return self.load * (approach / self.approach) ** (1.0 / self.exponent) if approach > 0.0 else 0.0

    def through(self, load: float, approach: float) -> PowerLaw:
        """Return the law through a further press, its exponent that between the two."""
        exponent, ratio = self.exponent, load / self.load
        if abs(ratio - 1.0) > TELLING:
            exponent = float(np.clip(math.log(approach / self.approach) / math.log(ratio), *EXPONENTS))
        return PowerLaw(load, approach, exponent)


def balance(laws: Sequence[PowerLaw], lags: Array, levers: Array, torque: float, compliance: Array) -> Array:
    """Forces of tooth pairs whose contact laws are known.

    Parameters
    ----------
    laws : sequence of PowerLaw, (k,)
    lags : (k,) array [rad]
        Rotations at which the pairs touch.
    levers : (2, k) array [mm]
        Of the normal forces about the axes of pinion and wheel.
    torque : float [N mm]
        Of the pinion, positive.
    compliance : (k, k) array [mm/N]
        Deflection of pair i under a unit force on pair j.

    Returns
    -------
    (k,) array [N]
        Zero where a pair is apart. They balance the torque to rounding.

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

    def missing(rotation: float) -> float:
        return float(levers[0] @ _forces(laws, levers[1] * (rotation - lags), compliance)) - torque

    low, high = float(lags.min()), float(lags.min()) + laws[0].approach / float(levers[1, 0])
    for _ in range(MOST_STEPS):
        if missing(high) >= 0.0:
            break
        low, high = high, high + 2.0 * (high - low)
    else:
        raise ConvergenceError(f"load sharing: no rotation gives a torque of {torque:.6g} N mm", last=high)
    rotation = brentq(missing, low, high, xtol=SWEEP_TOLERANCE * high, rtol=SWEEP_TOLERANCE)
    forces = _forces(laws, levers[1] * (rotation - lags), compliance)
    return forces * (torque / (levers[0] @ forces))


def _forces(laws: Sequence[PowerLaw], closing: Array, compliance: Array) -> Array:
    """Forces (k,) [N] under the closings of the pairs [mm]; one after the other until they agree.

    They minimise the complementary energy, which is convex: minimising over one force after the other converges.
    """
    forces = np.zeros(len(laws))
    for _ in range(MOST_SWEEPS):
        before = forces.copy()
        for index, law in enumerate(laws):
            own = float(compliance[index, index])
            left = float(closing[index] - compliance[index] @ forces + own * forces[index])
            forces[index] = _force_of_one(law, left, own)
        if np.abs(forces - before).max() <= SWEEP_TOLERANCE * forces.max():
            return forces
        if not compliance.any():
            return forces
    raise ConvergenceError(f"load sharing: forces of the tooth pairs not found in {MOST_SWEEPS} sweeps", last=forces)


def _force_of_one(law: PowerLaw, closing: float, compliance: float) -> float:
    """Force [N] of a contact and a spring in series under a closing [mm]."""
    if compliance == 0.0 or closing <= 0.0:
        return law.force_at(closing)

    def excess(force: float) -> float:
        return law.approach_under(force) + compliance * force - closing

    highest = min(law.force_at(closing), closing / compliance)
    if excess(highest) <= 0.0:  # one of the two yields less than rounding of the other
        return highest
    return float(brentq(excess, 0.0, highest, xtol=SWEEP_TOLERANCE * highest, rtol=SWEEP_TOLERANCE))
