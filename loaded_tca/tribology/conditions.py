"""A lubricant, and what a call of tribology takes: arguments, and what the scene of the result has in their place."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import wraps
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, real
from loaded_tca.errors import InputError, require
from loaded_tca.plain import Sentence, plain
from loaded_tca.reference.iso6336_20 import LOAD_STAGES
from loaded_tca.reference.iso6336_22 import SUPPLY_FACTORS
from loaded_tca.scene import Scene
from loaded_tca.scene.sections import LubricantSection

KELVIN = 273.0
"""Of 0 C, as the standard counts."""
AT_38 = 38.0
"""Temperature of the pressure-viscosity coefficient [C]."""

LEAST_PART = 0.1
"""Of the pressure-viscosity coefficient at 38 C, and of the density at 15 C, at high temperatures: the formula of the
coefficient has it at 400 C, and none at 510 C; that of the density at 1160 C, and none at 1290 C."""

FACTORS = ("application_factor", "dynamic_factor")
RANGES: dict[str, tuple[tuple[float, float], str]] = {
    "bulk_temperature_C": ((-50.0, 500.0), "C"),
    "permissible_film_ratio": ((1e-9, 100.0), ""),
    "scuffing_load_stage": (LOAD_STAGES, ""),
    **dict.fromkeys(FACTORS, ((1.0, 100.0), "")),
}
"""Numbers that a call may give instead of the scene: their ranges, and their units in words."""


@dataclass(frozen=True)
class Base:
    """What the kind of a base oil sets.

    Attributes
    ----------
    scale, exponent : float
        Pressure-viscosity coefficient at 38 C: scale eta_38^exponent [mm2/N], with eta_38 in Pa s.
    lubricant_factor : float
        X_L of coefficients of friction.
    """

    scale: float
    exponent: float
    lubricant_factor: float


BASES = {
    "mineral": Base(2.657e-2, 0.1348, 1.0),
    "polyalphaolefin": Base(1.466e-2, 0.0507, 0.8),
    "polyglycol": Base(1.392e-2, 0.1572, 0.7),
    "water-soluble polyglycol": Base(1.392e-2, 0.1572, 0.6),
    "ester": Base(1.879e-2, 0.1335, 0.8),
}
"""ISO/TR 15144-1:2014, (9) to (11), and its X_L. Of esters the standard has none: 7.382 nu^0.1335 1/GPa of Gold and
others 1995 with a density of 0.915, as public code has it, and the X_L of polyalphaolefins."""


OF_CALL = ("friction", "bulk_temperature_C", "scuffing_load_stage", "permissible_film_ratio", "supply")
"""Keys of ``[lubricant]`` in scenes that are of the pair, or of what it is judged by: arguments of the call."""

AnyOil = TypeVar("AnyOil")


def _of_oil_alone(oil: type[AnyOil]) -> type[AnyOil]:
    """Have a class say where the keys of ``OF_CALL`` belong."""
    init: Callable[..., None] = oil.__init__

    @wraps(init)
    def checked(self: AnyOil, **given: Any) -> None:
        place = "belongs to the pair, not to the oil; allowed in the call, as tribology({}=...), or in the scene"
        require(*((name not in OF_CALL, f"{name}: {place.format(name)}") for name in given))
        init(self, **given)

    any_class: Any = oil  # type checkers take no other __init__ of a class
    any_class.__init__ = checked
    return oil


@checked
@_of_oil_alone
@dataclass(frozen=True, kw_only=True)
class Lubricant:
    r"""A lubricating oil.

    How it comes to the gears (``supply``), the coefficient of friction and what the pair is judged by are no properties
    of the oil but arguments of :meth:`loaded_tca.MeshCycle.tribology`, though scenes have them in ``[lubricant]``, too.

    .. math::
        \lg \lg(\nu + 0.7) = A - B \lg T, \qquad
        \rho(\theta) = \rho_{15}\left(1 - 0.7\, \frac{\theta + 273 - 289}{\rho_{15}}\right), \qquad
        \alpha(\theta) = \alpha_{38} \left(1 + 516 \left(\frac{1}{\theta + 273} - \frac{1}{311}\right)\right)

    Parameters
    ----------
    viscosity_40, viscosity_100 : float [mm2/s]
        Kinematic, at 40 and 100 C; above 1, the first one larger.
    density_15 : float [kg/m3]
        At 15 C, from 600 to 1400.
    base : str
        Of ``BASES``: "mineral", "polyalphaolefin", "polyglycol", "water-soluble polyglycol", "ester".
    oil_temperature : float [C]
        Of the oil that comes to the mesh, from -50 to 200.
    pressure_viscosity_38 : float [mm2/N], optional
        At 38 C, where it is known; default: by the base.
    lubricant_factor : float, optional
        X_L of coefficients of friction, from 0.1 to 3; default: by the base.

    Raises
    ------
    InputError
        With every value outside its range, and for arguments of the call.

    References
    ----------
    ISO/TR 15144-1:2014, (8) to (11), (16) to (20).

    Examples
    --------
    An oil of the report that the formulas were checked against, printed as 30.09 mPa s and 0.02162 mm2/N:

    >>> oil = Lubricant(viscosity_40=220.0, viscosity_100=19.0, density_15=890.0, oil_temperature=80.0)
    >>> round(float(oil.viscosity(80.0)), 2), round(float(oil.pressure_viscosity(38.0)), 5)
    (30.09, 0.02162)
    """

    viscosity_40: float
    viscosity_100: float
    density_15: float = 890.0
    base: str = "mineral"
    oil_temperature: float
    pressure_viscosity_38: float | None = None
    lubricant_factor: float | None = None

    def __post_init__(self) -> None:
        cold, hot, oil = real(self.viscosity_40), real(self.viscosity_100), self.oil_temperature
        alpha, factor = self.pressure_viscosity_38, self.lubricant_factor
        require(
            (1.0 < cold <= 1e5, f"viscosity_40: {self.viscosity_40} mm2/s; allowed a number above 1, up to 100000"),
            (1.0 < hot < cold, f"viscosity_100: {self.viscosity_100} mm2/s; allowed above 1, below viscosity_40"),
            (
                600.0 <= real(self.density_15) <= 1400.0,
                f"density_15: {self.density_15} kg/m3; allowed a number from 600 to 1400",
            ),
            (
                isinstance(self.base, str) and self.base in BASES,
                f"base: {self.base!r:.60}; allowed {' or '.join(map(repr, BASES))}",
            ),
            (-50.0 <= real(oil) <= 200.0, f"oil_temperature: {oil} C; allowed a number from -50 to 200"),
            (
                alpha is None or 0.0 < real(alpha) <= 1.0,
                f"pressure_viscosity_38: {alpha} mm2/N; allowed a number above 0, up to 1",
            ),
            (
                factor is None or 0.1 <= real(factor) <= 3.0,
                f"lubricant_factor: {factor}; allowed a number from 0.1 to 3",
            ),
        )

    @property
    def friction_factor(self) -> float:
        """X_L: the given one, or that of the base."""
        given = self.lubricant_factor
        return BASES[self.base].lubricant_factor if given is None else given

    def kinematic_viscosity(self, temperature: ArrayLike) -> Array:
        """Kinematic viscosity [mm2/s] at temperatures [C]."""
        loglogs = [math.log10(math.log10(nu + 0.7)) for nu in (self.viscosity_40, self.viscosity_100)]
        logs = [math.log10(at + KELVIN) for at in (40.0, 100.0)]
        slope = (loglogs[0] - loglogs[1]) / (logs[1] - logs[0])
        absolute = np.maximum(np.asarray(temperature, dtype=float) + KELVIN, 1.0)
        return np.asarray(10.0**10.0 ** (loglogs[0] - slope * (np.log10(absolute) - logs[0])) - 0.7)

    def density(self, temperature: ArrayLike) -> Array:
        """Density [kg/m3] at temperatures [C]."""
        dense = self.density_15 - 0.7 * (np.asarray(temperature) + KELVIN - 289.0)
        return np.asarray(np.maximum(dense, LEAST_PART * self.density_15))

    def viscosity(self, temperature: ArrayLike) -> Array:
        """Dynamic viscosity [mPa s] at temperatures [C]."""
        return np.asarray(1e-3 * self.kinematic_viscosity(temperature) * self.density(temperature))

    def pressure_viscosity(self, temperature: ArrayLike) -> Array:
        """Pressure-viscosity coefficient [mm2/N] at temperatures [C]."""
        at_38 = self.pressure_viscosity_38
        if at_38 is None:
            base = BASES[self.base]
            at_38 = base.scale * (1e-3 * float(self.viscosity(AT_38))) ** base.exponent
        inverse = 1.0 / (np.asarray(temperature, dtype=float) + KELVIN) - 1.0 / (AT_38 + KELVIN)
        return np.asarray(at_38 * np.maximum(1.0 + 516.0 * inverse, LEAST_PART))


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

    def in_words(self, speed: int) -> str:
        """Speed, oil and friction in words."""
        oil, rpm = self.lubricant, self.speeds[speed]
        friction = self.friction if isinstance(self.friction, str) else plain(self.friction, 6) if self.friction else ""
        parts = [
            "no speed" if math.isnan(rpm) else f"pinion at {plain(rpm, 6)} rpm",
            "no oil"
            if oil is None
            else f"{oil.base} oil of {plain(oil.viscosity_40, 6)} mm2/s at 40 C, supplied at "
            f"{plain(oil.oil_temperature, 6)} C",
            "no roughness" if self.roughness is None else Sentence().format("Ra {:g} and {:g} um", *self.roughness),
            f"friction: {'mean of ' if friction == MEAN else ''}{friction}" if friction else "no friction",
            f"K_A {plain(self.application_factor, 6)}, K_v {plain(self.dynamic_factor, 6)}",
        ]
        return ", ".join(parts)


def conditions_of(
    scene: Scene,
    *,
    cylindrical: bool,
    pinion_speed_rpm: ArrayLike | None,
    lubricant: Lubricant | None,
    roughness_um: Sequence[float | None] | None,
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
    values, problems = _within_ranges(
        scene,
        bulk_temperature_C=bulk_temperature_C,
        permissible_film_ratio=permissible_film_ratio,
        scuffing_load_stage=scuffing_load_stage,
        application_factor=application_factor,
        dynamic_factor=dynamic_factor,
    )
    speeds, several = _speeds(speed, problems)
    roughness = _roughness(roughness, problems)
    friction = _friction(friction, oil, cylindrical, problems)
    if lubricant is not None and not isinstance(lubricant, Lubricant):
        problems.append(f"lubricant: {lubricant!r:.60}; allowed a loaded_tca.tribology.Lubricant")
    supply_factor = _supply_factor(supply if supply is not None else oil.supply if oil else "dip", problems)
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
        supply_factor=supply_factor,
    )


def _within_ranges(scene: Scene, **given: float | None) -> tuple[dict[str, Any], list[str]]:
    """Arguments, those not given from the scene, and a problem for each that is outside its range."""
    values = {name: _of_scene(scene, name) if argument is None else argument for name, argument in given.items()}
    problems = [
        f"{name}: {values[name]!r:.60}{f' {unit}' if unit else ''}; allowed a number from {plain(low, 6)} to "
        f"{plain(high, 6)}"
        for name, ((low, high), unit) in RANGES.items()
        if values[name] is not None and not low <= real(values[name]) <= high
    ]
    return values, problems


def _of_scene(scene: Scene, name: str) -> float | None:
    """A number of the lubricant or of the operation; without an operation its factors are one."""
    if name in FACTORS:
        return getattr(scene.operation, name) if scene.operation else 1.0
    return getattr(scene.lubricant, name) if scene.lubricant else None


def lubricant_of(section: LubricantSection) -> Lubricant | None:
    """The oil of a scene; None where the section has no more of it than ratings take."""
    if section.viscosity_100_mm2_s is None or section.oil_temperature_C is None:
        return None
    return Lubricant(
        viscosity_40=section.viscosity_40_mm2_s,
        viscosity_100=section.viscosity_100_mm2_s,
        density_15=section.density_15_kg_m3,
        base=section.base,
        oil_temperature=section.oil_temperature_C,
        pressure_viscosity_38=section.pressure_viscosity_38_mm2_N,
        lubricant_factor=section.lubricant_factor,
    )


def _supply_factor(supply: str, problems: list[str]) -> float:
    """X_S of ISO/TS 6336-20 of how the oil comes to the mesh."""
    if isinstance(supply, str) and supply in SUPPLY_FACTORS:
        return SUPPLY_FACTORS[supply]
    problems.append(f"supply: {supply!r:.60}; allowed {' or '.join(map(repr, SUPPLY_FACTORS))}")
    return math.nan


def _speeds(speed: Any, problems: list[str]) -> tuple[Array, bool]:
    """Speeds (s,), and whether several may have been given."""
    if speed is None:
        return np.array([math.nan]), False
    wrong = f"pinion_speed_rpm: {speed!r:.60}; allowed a number above 0, up to {plain(FASTEST, 6)}, or a row of them"
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
                f'friction: "{MEAN}" is for cylindrical gears only; allowed "{LOCAL}", "{XU_KAHRAMAN}" or a number, '
                "with bulk_temperature_C"
            )
        return friction
    if not 0.0 <= real(friction) <= 1.0:
        names = ", ".join(f'"{name}"' for name in FRICTIONS)
        problems.append(f"friction: {friction!r:.60}; allowed {names}, or a number from 0 to 1")
        return None
    return float(friction)
