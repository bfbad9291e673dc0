"""Endurances of sun, planets and ring, of both meshes: which flank and which fillet of a planet decide.

A flank of a planet meets the sun, the other one the ring. Each fillet is drawn by the mesh on its flank, in reversed
load cases by the other mesh, and pressed by that on the other flank, which Y_M counts.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
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
    """

    endurances: OfGears
    at_ring: dict[str, Mask]

    @classmethod
    def of(cls, of_sun: Rating, of_ring: Rating, cases: Cases) -> StageGears:
        """Of the ratings of both meshes under the same load cases."""
        endurances, at_ring = {}, {}
        for mode, (sun, at_sun) in of_sun.endurances.items():
            by_ring, ring = of_ring.endurances[mode]
            at_ring[mode] = _decides_at_ring(mode, at_sun, by_ring, cases)
            endurances[mode] = (sun, _joined(at_sun, by_ring, at_ring[mode]), ring)
        return cls(endurances, at_ring)

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


def _decides_at_ring(mode: str, at_sun: Endurance, at_ring: Endurance, cases: Cases) -> Mask:
    """In which load cases (c,) planets have the endurance of their mesh with the ring.

    Load cases that stand for themselves have the shorter life each. Of a spectrum one flank, or one fillet, decides:
    that with the smaller safety under all bins.
    """
    if not cases.is_spectrum:
        return np.asarray(at_ring.lives() < at_sun.lives())
    drawn_by_ring = cases.reversed if mode in ROOTS else np.zeros(len(cases.torque), dtype=bool)
    safeties = [_joined(at_sun, at_ring, by_ring).safety() for by_ring in (drawn_by_ring, ~drawn_by_ring)]
    return ~drawn_by_ring if safeties[1] < safeties[0] else drawn_by_ring


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
