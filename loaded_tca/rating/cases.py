"""The load cases of a rating: each torque of a result for itself, or the bins of a load spectrum together."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arrays import Array, Mask
from loaded_tca.errors import InputError
from loaded_tca.plain import apart
from loaded_tca.reference.iso6336_3_strength import mean_stress_sensitivities
from loaded_tca.scene.load import ROUNDED

if TYPE_CHECKING:
    from loaded_tca.scene import Scene
    from loaded_tca.scene.load import AnyLoad
    from loaded_tca.scene.rating import StrengthSection
    from loaded_tca.scene.section import Section

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
    elsewhere : (c,) array of bool, or None
        Which cases load flanks that are not those of the result; None: those that are reversed.
    """

    torque: Array
    speed: Array
    hours: Array
    reversed: Mask
    life_hours: float
    is_spectrum: bool = False
    repeated: float = 1.0
    elsewhere: Mask | None = None

    @property
    def press_on_back(self) -> Array:
        """Largest torque on the other flanks of the teeth over that of each case (c,), up to 1: it presses its fillets.

        ISO 6336-3, annex B, has the smaller load of both flanks over the larger one in the stress ratio. It follows
        from torques alone, whether the flanks of one side are rated or those of both; 0 where no case loads the others.
        """
        tops = [self.torque[side].max(initial=0.0) for side in (self.reversed, ~self.reversed)]
        others = np.where(self.reversed, tops[1], tops[0])
        part = np.divide(others, self.torque, out=np.ones(len(self.torque)), where=self.torque > others)
        return np.where(others > 0.0, part, 0.0)

    @property
    def on_other_flanks(self) -> Mask:
        """Which cases (c,) load flanks that are not those of the result."""
        return self.reversed if self.elsewhere is None else self.elsewhere

    @property
    def factor_torque(self) -> Array:
        """Torques (c,) that load factors are found at [N mm]: of bins and without load from a part of the largest."""
        least = LEAST_PART * self.torque.max()
        return np.where(self.torque > 0.0, np.maximum(self.torque, least if self.is_spectrum else 0.0), least)

    def between(self, solved: Array) -> Mask:
        """Which cases (c,) have a torque that is none of those solved [N mm]; idle ones ask for none."""
        return np.asarray((self.torque > 0.0) & ~np.isin(self.factor_torque, solved))

    def alone(self, torques: Array) -> Cases:
        """Torques (t,) [N mm] that stand each for itself in the same life, at the largest speed."""
        ones = np.ones(len(torques))
        return Cases(torques, self.speed.max() * ones, self.life_hours * ones, ones < 0.0, self.life_hours)


def cases_of(scene: Scene, torques: Array) -> Cases:
    """Load cases of a scene with a rating: its spectrum, or else the torques (t,) [N mm] of a result."""
    assert scene.rating is not None  # asked for before
    speed = None if scene.operation is None else scene.operation.pinion_speed_rpm
    return load_cases(scene.load, scene.rating.life_hours, speed, torques)


def load_cases(load: AnyLoad, life_hours: float | None, speed: float | None, torques: Array) -> Cases:
    """Load cases of a pair or a stage, without problems: its spectrum, or else the torques (t,) [N mm] of a result.

    Parameters
    ----------
    load : AnyLoad
    life_hours : float, optional [h]
        That is required; None: the hours of all bins.
    speed : float, optional [rpm]
        Of bins without one, and of torques.
    torques : (t,) array [N mm]
    """
    bins, together = load.case, load.hours
    life = together if life_hours is None else life_hours
    assert life is not None  # by the rules of scenes and stages
    if bins is None:
        ones = np.ones(len(torques))
        assert speed is not None
        return Cases(torques, speed * ones, life * ones, ones < 0.0, life)
    speeds = [speed if case.speed_rpm is None else case.speed_rpm for case in bins]
    parts = np.array([case.share if case.hours is None else case.hours for case in bins], dtype=float)
    return Cases(
        1e3 * np.array([case.torque_Nm for case in bins]),
        np.array(speeds, dtype=float),
        life * parts / parts.sum(),
        np.array([case.reversed for case in bins]),
        life,
        is_spectrum=True,
        repeated=1.0 if together is None else life / together,
    )


def problems_of_cases(
    load: AnyLoad, operation: Section | None, strengths: Mapping[str, StrengthSection | None], largest: float
) -> Iterator[str]:
    """What is missing to rate load cases of a pair or a stage.

    Parameters
    ----------
    load : AnyLoad
    operation : Section, optional
        [operation], which has the speed of bins without one.
    strengths : mapping
        Names of sections -> those of gears whose Y_M follows from a stress ratio; None: missing, as is told elsewhere.
    largest : float [N mm]
        The largest torque solved.
    """
    bins = load.case
    without = [place for place, case in enumerate(bins or ()) if case.speed_rpm is None]
    if operation is None and (bins is None or without):
        where = f", and bin {without[0]} has no speed of its own" if without else ""
        yield f"operation: missing; strength, cycles and K_v depend on {load.CASE.MEMBER}_speed_rpm{where}"
    for name, strength in strengths.items():
        if strength is None or not any(case.reversed for case in bins or ()):
            continue
        try:
            mean_stress_sensitivities(strength.kind_of_material)
        except InputError:
            kind = strength.kind_of_material
            yield f"load.case: reversed bins; the standard has no Y_M of kind {kind!r} ({name})"
    highest = load.largest_Nm
    if 1e3 * highest > largest * (1.0 + ROUNDED):
        found, most = apart([highest, 1e-3 * largest])
        yield f"load.case: a bin has {found} N m; allowed up to {most}, the largest analysed torque"
