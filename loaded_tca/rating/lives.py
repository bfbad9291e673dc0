"""Damage and lives of load cases after ISO 6336-6: each for itself, or those of a spectrum together."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import inf, nan

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.rating.cases import Cases
from loaded_tca.reference.iso6336_6 import SNCurve, damages, equivalent_torque, spectrum_safety

FLANK, ROOT, LOCAL_FLANK, LOCAL_ROOT = MODES = "flank", "root", "local_flank", "local_root"
"""Kinds of failure: after the standard, and by the largest local stress."""
ROOTS = ROOT, LOCAL_ROOT
COAST = {FLANK: "coast_flank", LOCAL_FLANK: "local_coast_flank"}
"""The same of the flanks of the coast side, where its result is rated, too."""


@dataclass(frozen=True, eq=False)
class Endurance:
    """Stresses of one kind of failure of one gear, and the curve that they are held against.

    Attributes
    ----------
    curve : SNCurve
        Stresses (knee,), or (knee, c) where they differ from case to case.
    stress : (c,) array [MPa]
        Under each load case; 0 where it does not load this place, NaN where the standard has none.
    cycles : (c,) array
        Load cycles of each case in the life that is required.
    required : float
        Safety on stress.
    power : float
        Of the torque, that the stress grows with: 1/2 of flanks, 1 of roots.
    """

    curve: SNCurve
    stress: Array
    cycles: Array
    required: float
    power: float

    @property
    def is_rated(self) -> bool:
        """Whether all stresses are known."""
        return bool(np.isfinite(self.stress).all())

    def damage(self) -> Array:
        """Damage of each case in its load cycles (c,), at the required safety; NaN where the stress is not known."""
        known = np.isfinite(self.stress)
        found = damages(self.curve, np.where(known, self.required * self.stress, 0.0), self.cycles)
        return np.where(known, found, nan)

    def lives(self) -> Array:
        """Load cycles that the stress of each case is borne for (c,), at the required safety."""
        known = np.isfinite(self.stress)
        return np.where(known, self.curve.life(np.where(known, self.required * self.stress, 0.0)), nan)

    def over_static(self) -> Array:
        """Stress of each case (c,) over the static strength; 0 where the stress is not known."""
        return np.nan_to_num(self.stress, nan=0.0) / self.curve.stresses[0]

    def safety(self) -> float:
        """Safety on stress of all cases together, at which their damage is 1."""
        if not self.is_rated:
            return nan
        if not (self.cycles > 0.0).any():
            return inf
        return spectrum_safety(self.curve, self.stress, self.cycles)

    def equivalent_torque(self, torques: Array) -> float:
        """Torque of the same damage over the load cycles that load this place [N mm], by the steepest line."""
        loading = (self.stress > 0.0) & (self.cycles > 0.0)
        if not self.is_rated or not loading.any():
            return nan
        line = np.broadcast_to(self.curve.exponents[0], torques.shape)[torques.argmax()]
        return equivalent_torque(torques[loading], self.cycles[loading], float(self.power * line))

    def stress_at(self, curve: SNCurve) -> Array:
        """Stress of each case (c,) at the required safety, over another curve as over its own at its load cycles."""
        return self.required * self.stress * curve.strength(self.cycles) / self.curve.strength(self.cycles)

    @property
    def has_one_curve(self) -> bool:
        """Whether the strength is the same in all cases."""
        levels = self.curve.stresses.reshape(len(self.curve.cycles), -1)
        return bool((levels == levels[:, :1]).all())

    def worst_curve(self) -> SNCurve:
        """Curve of the case that does the largest damage, with a level for each knee."""
        levels = self.curve.stresses
        if levels.ndim == 1:
            return self.curve
        return replace(self.curve, stresses=levels[:, int(np.nan_to_num(self.damage()).argmax())])


Endurances = Mapping[str, tuple[Endurance, Endurance]]
"""Of pinion and wheel, by the kind of failure."""
OfGears = Mapping[str, tuple[Endurance, ...]]
"""Of all gears, by the kind of failure."""


def lives_of(cases: Cases, endurances: OfGears, cycles_per_hour: Array) -> dict[str, Array]:
    """``damage`` (c, gear, mode), ``life_hours`` and, of a spectrum, what all cases do together (gear, mode).

    Parameters
    ----------
    cases : Cases
    endurances : mapping
    cycles_per_hour : (c, gear) array
    """
    damage = damages_of(endurances)
    if not cases.is_spectrum:
        lives = _by_mode(endurances, lambda each: each.lives())
        return {"damage": damage, "life_hours": lives / cycles_per_hour[..., None]}
    total = damage.sum(axis=0)
    with np.errstate(divide="ignore"):
        life = cases.life_hours / total
    return {
        "damage": damage,
        "life_hours": life,
        "miner_sum": total,
        "spectrum_safety": _by_mode(endurances, lambda each: np.asarray(each.safety())),
        "equivalent_torque": _by_mode(endurances, lambda each: np.asarray(each.equivalent_torque(cases.torque))),
    }


def damages_of(endurances: OfGears) -> Array:
    """Damage (c, gear, mode) of each case."""
    return _by_mode(endurances, lambda each: each.damage())


def _by_mode(endurances: OfGears, number: Callable[[Endurance], Array]) -> Array:
    """Numbers (..., gear, mode) of all kinds of failure of all gears."""
    rows = [[number(each) for each in of_gear] for of_gear in zip(*endurances.values(), strict=True)]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))
