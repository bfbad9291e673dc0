"""What a call of tribology takes: arguments, and what the scene of the result has in their place."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from loaded_tca.arrays import Array, real
from loaded_tca.errors import InputError
from loaded_tca.reference.iso6336_20 import LOAD_STAGES
from loaded_tca.reference.iso6336_22 import SUPPLY_FACTORS
from loaded_tca.scene import Scene
from loaded_tca.scene.lubrication import LubricantSection
from loaded_tca.tribology.lubricant import Lubricant

MEAN, LOCAL, XU_KAHRAMAN = "ISO/TS 6336-22", "local", "Xu-Kahraman"
FRICTIONS = (MEAN, LOCAL, XU_KAHRAMAN)
"""Names of coefficients of friction; a number is one, too. Scenes call the first one "mean"."""
FASTEST = 1e6
"""Speed of the pinion up to which it is taken [1/min], as in scenes."""


@dataclass(frozen=True, kw_only=True)
class Conditions:
    """How a pair runs.

    Attributes
    ----------
    speeds : (s,) array [1/min]
        Of the pinion; NaN alone where none is given.
    several : bool
        Whether a list was given.
    lubricant : Lubricant or None
    roughness : (float, float) [um] or None
        Ra of pinion and wheel.
    application_factor, dynamic_factor : float
        K_A, K_v.
    friction : str, float or None
        One of ``FRICTIONS``, or a number; None where bevel gears have none.
    bulk_temperature : float [C] or None
    load_stage : float or None
    permissible_film_ratio : float or None
    supply_factor : float
        X_S.
    """

    speeds: Array
    several: bool
    lubricant: Lubricant | None
    roughness: tuple[float, float] | None
    application_factor: float
    dynamic_factor: float
    friction: str | float | None
    bulk_temperature: float | None
    load_stage: float | None
    permissible_film_ratio: float | None
    supply_factor: float

    @property
    def dynamic(self) -> float:
        """K_A K_v."""
        return self.application_factor * self.dynamic_factor

    @property
    def mean_roughness(self) -> float:
        """Ra, the mean of both gears [um]; NaN where it is not given."""
        return math.nan if self.roughness is None else 0.5 * sum(self.roughness)


def conditions_of(
    scene: Scene,
    *,
    cylindrical: bool,
    pinion_speed_rpm: ArrayLike | None,
    lubricant: Lubricant | None,
    roughness_um: Sequence[float] | None,
    application_factor: float | None,
    dynamic_factor: float | None,
    friction: str | float | None,
    bulk_temperature_C: float | None,
    scuffing_load_stage: float | None,
    permissible_film_ratio: float | None,
    supply: str | None = None,
) -> Conditions:
    """Arguments, those not given from the scene.

    Raises
    ------
    InputError
        With every value outside its range.
    """
    oil, operation = scene.lubricant, scene.operation
    if lubricant is None and oil is not None:
        lubricant = lubricant_of(oil)
    speed = operation.pinion_speed_rpm if pinion_speed_rpm is None and operation else pinion_speed_rpm
    gears = scene.pinion.roughness_Ra_um, scene.wheel.roughness_Ra_um
    roughness: Any = gears if roughness_um is None else roughness_um
    given: dict[str, tuple[Any, Any, tuple[float, float], str]] = {
        "bulk_temperature_C": (bulk_temperature_C, oil and oil.bulk_temperature_C, (-50.0, 500.0), "C"),
        "permissible_film_ratio": (permissible_film_ratio, oil and oil.permissible_film_ratio, (1e-9, 100.0), ""),
        "scuffing_load_stage": (scuffing_load_stage, oil and oil.scuffing_load_stage, LOAD_STAGES, ""),
        "application_factor": (application_factor, operation.application_factor if operation else 1.0, (1, 100), ""),
        "dynamic_factor": (dynamic_factor, operation.dynamic_factor if operation else 1.0, (1, 100), ""),
    }
    values = {name: of_scene if argument is None else argument for name, (argument, of_scene, _, _) in given.items()}
    problems = [
        f"{name}: {values[name]!r:.60}{f' {unit}' if unit else ''}; allowed a number from {low:g} to {high:g}"
        for name, (_, _, (low, high), unit) in given.items()
        if values[name] is not None and not low <= real(values[name]) <= high
    ]
    speeds, several = _speeds(speed, problems)
    roughness = _roughness(roughness, problems)
    friction = _friction(friction, oil, cylindrical, problems)
    if lubricant is not None and not isinstance(lubricant, Lubricant):
        problems.append(f"lubricant: {lubricant!r:.60}; allowed a loaded_tca.tribology.Lubricant")
    supply = supply if supply is not None else oil.supply if oil else "dip"
    if supply not in SUPPLY_FACTORS:
        problems.append(f"supply: {supply!r:.60}; allowed {' or '.join(map(repr, SUPPLY_FACTORS))}")
    if problems:
        raise InputError(problems)
    return Conditions(
        speeds=speeds,
        several=several,
        lubricant=lubricant,
        roughness=roughness,
        application_factor=float(values["application_factor"]),
        dynamic_factor=float(values["dynamic_factor"]),
        friction=friction,
        bulk_temperature=values["bulk_temperature_C"],
        load_stage=values["scuffing_load_stage"],
        permissible_film_ratio=values["permissible_film_ratio"],
        supply_factor=SUPPLY_FACTORS[supply],
    )


def lubricant_of(section: LubricantSection) -> Lubricant:
    """The oil of a scene."""
    return Lubricant(
        viscosity_40=section.viscosity_40_mm2_s,
        viscosity_100=section.viscosity_100_mm2_s,
        density_15=section.density_15_kg_m3,
        base=section.base,
        oil_temperature=section.oil_temperature_C,
        pressure_viscosity_38=section.pressure_viscosity_38_mm2_N,
        lubricant_factor=section.lubricant_factor,
    )


def _speeds(speed: Any, problems: list[str]) -> tuple[Array, bool]:
    """Speeds (s,), and whether several may have been given."""
    if speed is None:
        return np.array([math.nan]), False
    wrong = f"pinion_speed_rpm: {speed!r:.60}; allowed a number above 0, up to {FASTEST:g}, or a row of them"
    try:
        given = np.asarray(speed)
        speeds = given.astype(float)
    except (TypeError, ValueError):
        problems.append(wrong)
        return np.array([math.nan]), False
    beyond = not ((speeds > 0.0) & (speeds <= FASTEST)).all()
    if speeds.ndim > 1 or not speeds.size or beyond or given.dtype.kind not in "iuf":
        problems.append(wrong)
    return speeds.reshape(-1), speeds.ndim > 0


def _roughness(given: Any, problems: list[str]) -> tuple[float, float] | None:
    """Ra of both gears; None unless both are given."""
    try:
        both = tuple(given)
    except TypeError:
        both = ()
    if len(both) != 2:
        problems.append(f"roughness_um: {given!r:.60}; allowed two numbers, Ra of pinion and wheel")
        return None
    if None in both:
        return None
    if not all(0.0 < real(one) <= 10.0 for one in both):
        problems.append(f"roughness_um: {given!r:.60}; allowed two numbers above 0, up to 10 um")
        return None
    return float(both[0]), float(both[1])


def _friction(
    given: str | float | None, oil: LubricantSection | None, cylindrical: bool, problems: list[str]
) -> str | float | None:
    """The coefficient of friction to take."""
    friction = oil.friction if given is None and oil is not None else given
    friction = MEAN if isinstance(friction, str) and friction == "mean" else friction
    if friction is None:
        return MEAN if cylindrical else None
    if isinstance(friction, str) and friction in FRICTIONS:
        if friction == MEAN and not cylindrical:
            problems.append(
                f'friction: "{MEAN}" is the mean of cylindrical gears; allowed "{LOCAL}", "{XU_KAHRAMAN}" or a number, '
                "with bulk_temperature_C"
            )
        return friction
    if not 0.0 <= real(friction) <= 1.0:
        names = ", ".join(f'"{name}"' for name in FRICTIONS)
        problems.append(f"friction: {friction!r:.60}; allowed {names}, or a number from 0 to 1")
        return None
    return float(friction)
