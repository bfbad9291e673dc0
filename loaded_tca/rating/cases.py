"""The load cases of a rating: each torque of a result for itself, or the bins of a load spectrum together."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array, Mask
from loaded_tca.errors import InputError
from loaded_tca.plain import plain
from loaded_tca.reference.iso6336_3_strength import mean_stress_sensitivities
from loaded_tca.scene import Scene

LEAST_PART = 1e-3
"""Of the largest torque: factors of bins below, idle ones among them, are those under this part of it."""


@dataclass(frozen=True, eq=False)
class Cases:
    """Load cases (c,) and how long each of them lasts.

    Attributes
    ----------
    torque : (c,) array [N mm]
        On the pinion, at least 0.
    speed : (c,) array [rpm]
        Of the pinion.
    hours : (c,) array [h]
        In the life that is required: of torques that stand for themselves the whole of it.
    reversed : (c,) array of bool
        Whether the other flanks carry the torque.
    life_hours : float [h]
        The life that is required.
    is_spectrum : bool
        Whether the damage of all adds up.
    repeated : float
        How often the hours of the bins follow each other in that life; 1 of shares.
    """

    torque: Array
    speed: Array
    hours: Array
    reversed: Mask
    life_hours: float
    is_spectrum: bool = False
    repeated: float = 1.0

    @property
    def factor_torque(self) -> Array:
        """Torques (c,) that load factors are found at [N mm]: of bins from a part of the largest on."""
        return np.maximum(self.torque, LEAST_PART * self.torque.max()) if self.is_spectrum else self.torque

    def between(self, solved: Array) -> Mask:
        """Which cases (c,) have a torque that is none of those solved [N mm]; idle ones ask for none."""
        return np.asarray((self.torque > 0.0) & ~np.isin(self.factor_torque, solved))

    def alone(self, torques: Array) -> Cases:
        """Torques (t,) [N mm] that stand each for itself in the same life, at the largest speed."""
        ones = np.ones(len(torques))
        return Cases(torques, self.speed.max() * ones, self.life_hours * ones, ones < 0.0, self.life_hours)


def cases_of(scene: Scene, torques: Array) -> Cases:
    """Load cases of a scene with a rating: its spectrum, or else the torques (t,) [N mm] of a result."""
    rating, operation, bins = scene.rating, scene.operation, scene.load.case
    assert rating is not None  # asked for before
    speed = None if operation is None else operation.pinion_speed_rpm
    if bins is None:
        assert rating.life_hours is not None  # by the rules of the scene
        hours, ones = rating.life_hours, np.ones(len(torques))
        assert speed is not None
        return Cases(torques, speed * ones, hours * ones, ones < 0.0, hours)
    speeds = [speed if case.pinion_speed_rpm is None else case.pinion_speed_rpm for case in bins]
    parts = np.array([case.share if case.hours is None else case.hours for case in bins], dtype=float)
    together = scene.load.hours
    life = together if rating.life_hours is None else rating.life_hours
    assert life is not None  # by the rules of the scene
    return Cases(
        1e3 * np.array([case.pinion_torque_Nm for case in bins]),
        np.array(speeds, dtype=float),
        life * parts / parts.sum(),
        np.array([case.reversed for case in bins]),
        life,
        is_spectrum=True,
        repeated=1.0 if together is None else life / together,
    )


def problems_of_cases(scene: Scene, largest: float) -> Iterator[str]:
    """What is missing in a scene to rate its load cases; ``largest`` is the largest torque solved [N mm]."""
    bins = scene.load.case
    without = [place for place, case in enumerate(bins or ()) if case.pinion_speed_rpm is None]
    if scene.operation is None and (bins is None or without):
        where = f"; bin {without[0]} has none of its own" if without else ""
        yield f"operation: missing; strength, cycles and K_v depend on pinion_speed_rpm{where}"
    for name, gear in (("pinion", scene.pinion), ("wheel", scene.wheel)):
        if gear.strength is None or not any(case.reversed for case in bins or ()):
            continue
        try:
            mean_stress_sensitivities(gear.strength.kind_of_material)
        except InputError:
            kind = gear.strength.kind_of_material
            yield f"load.case: reversed bins; the standard has no Y_M of kind {kind!r} ({name}.strength)"
    highest = max((case.pinion_torque_Nm for case in bins or ()), default=0.0)
    if 1e3 * highest > largest * (1.0 + 1e-9):
        yield (
            f"load.case: a bin has {plain(highest, 6)} N m; allowed up to {plain(1e-3 * largest, 6)}, the "
            "largest that was solved"
        )
