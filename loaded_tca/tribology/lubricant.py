"""A lubricant: its viscosity, density and pressure-viscosity over the temperature."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from loaded_tca.arrays import Array, real
from loaded_tca.errors import require

KELVIN = 273.0
"""Of 0 C, as the standard counts."""
AT_38 = 38.0
"""Temperature of the pressure-viscosity coefficient [C]."""

LEAST_PART = 0.1
"""Of the pressure-viscosity coefficient at 38 C, and of the density at 15 C, at high temperatures: the formula of the
coefficient has it at 400 C, and none at 510 C; that of the density at 1160 C, and none at 1290 C."""


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


@dataclass(frozen=True, kw_only=True)
class Lubricant:
    r"""A lubricating oil.

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
        With every value outside its range.

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
