"""Endurances of sun, planets and ring, of both meshes: which flank and which fillet of a planet decide.

A flank of a planet meets the sun, the other one the ring. Each fillet is drawn by the mesh on its flank, in reversed
load cases by the other mesh, and pressed by that on the other flank, which Y_M counts.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import nan
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arrays import Array, Mask
from loaded_tca.rating.lives import LOCAL_ROOT, ROOT, Endurance, OfGears

if TYPE_CHECKING:
    from loaded_tca.rating import Rating
    from loaded_tca.rating.cases import Cases

ROOTS = ROOT, LOCAL_ROOT


@dataclass(frozen=True, eq=False)
class StageGears:
    """What damage of the three gears of a stage follows from.

    Attributes
    ----------
    endurances : mapping
        Of sun, planet and ring, by the kind of failure; of planets that of the flank or fillet that decides.
    at_ring : dict of str to (c,) array of bool
        In which load cases the mesh with the ring gives that of planets.
    planet_safety : (mode,) array
        Under all bins of a spectrum, the smaller one of both flanks or fillets of planets; NaN without a spectrum.
    """

    endurances: OfGears
    at_ring: dict[str, Mask]
    planet_safety: Array

    @classmethod
    def of(cls, of_sun: Rating, of_ring: Rating, cases: Cases) -> StageGears:
        """Of the ratings of both meshes under the same load cases."""
        endurances, at_ring, safeties = {}, {}, []
        for mode, (sun, at_sun) in of_sun.endurances.items():
            by_ring, ring = of_ring.endurances[mode]
            if cases.is_spectrum:
                drawn = cases.reversed if mode in ROOTS else np.zeros(len(cases.torque), dtype=bool)
                at_ring[mode], safety = _worse(at_sun, by_ring, drawn)
            else:
                at_ring[mode], safety = np.asarray(by_ring.lives() < at_sun.lives()), nan
            endurances[mode] = (sun, _joined(at_sun, by_ring, at_ring[mode]), ring)
            safeties.append(safety)
        return cls(endurances, at_ring, np.array(safeties))

    def interpolation_errors(self, of_sun: Rating, of_ring: Rating) -> Array:
        """By which part the damage of all bins (gear, mode) may be wrong, of what both meshes tell.

        Where a fillet of planets is drawn by both, the errors of all their bins add up.
        """
        errors = np.concatenate([of_sun.interpolation_error, of_ring.interpolation_error[1:]])
        for n, (mode, at_ring) in enumerate(self.at_ring.items()):
            if at_ring.all():
                errors[1, n] = of_ring.interpolation_error[0, n]
            elif at_ring.any():
                damage = float(self.endurances[mode][1].damage().sum())
                both = _absolute(of_sun, 1, n) + _absolute(of_ring, 0, n)
                errors[1, n] = 0.0 if np.isinf(damage) else both / (damage or 1.0)
        return errors


def _absolute(rating: Rating, gear: int, mode: int) -> float:
    """By how much the damage of all bins of a gear may be wrong; 0 where it is without end."""
    error, damage = float(rating.interpolation_error[gear, mode]), float(rating.miner_sum[gear, mode])
    return 0.0 if np.isinf(damage) else error * (damage or 1.0)


def _worse(at_sun: Endurance, at_ring: Endurance, drawn_by_ring: Mask) -> tuple[Mask, float]:
    """Which bins (c,) of a spectrum the mesh with the ring has of the flank or fillet with the larger damage.

    ``drawn_by_ring`` are those of the one that the sun meets; the other one has the rest. And the smaller safety of
    both, which need not be that of the larger damage where curves have different slopes.
    """
    sides = drawn_by_ring, ~drawn_by_ring
    both = [_joined(at_sun, at_ring, by_ring) for by_ring in sides]
    damages, safeties = [float(one.damage().sum()) for one in both], [one.safety() for one in both]
    second = damages[1] > damages[0] or (damages[1] == damages[0] and safeties[1] < safeties[0])
    return sides[int(second)], float(np.min(safeties))


def _joined(first: Endurance, second: Endurance, of_second: Mask) -> Endurance:
    """Endurance of a gear of one material that has load cases (c,) of two meshes."""
    levels = [
        np.broadcast_to(curve.stresses.reshape(len(curve.cycles), -1), (len(curve.cycles), len(of_second)))
        for curve in (first.curve, second.curve)
    ]
    return replace(
        first,
        curve=replace(first.curve, stresses=np.where(of_second, levels[1], levels[0])),
        stress=np.where(of_second, second.stress, first.stress),
    )
