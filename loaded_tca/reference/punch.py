"""Rigid punches on an elastic half-space: profiles C r^n, flat ends, flat strips with rounded ends."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from loaded_tca.arguments import checked
from loaded_tca.errors import require, require_positive

# F/(E* L delta) of a flat square punch of side L: pi times the electrostatic capacity of the unit square, 0.36679,
# since a charged plate and a flat punch obey the same equations. Grids of Love's cells, extrapolated, agree to 1e-5.
SQUARE_PUNCH = 1.1523


@dataclass(frozen=True)
class PunchContact:
    """Contact of a rigid punch.

    Parameters
    ----------
    load : float [N]
        Normal load.
    radius : float [mm]
        Contact radius.
    approach : float [mm]
        Depth of the punch below the undeformed surface.
    """

    load: float
    radius: float
    approach: float


@checked
def power_law(radius: float, coefficient: float, exponent: float, contact_modulus: float) -> PunchContact:
    r"""Punch of the profile C r^n, pressed in until it touches within a radius a.

    .. math::
        \delta = C a^n \sqrt\pi\, \Gamma(1 + n/2)/\Gamma((1 + n)/2),\qquad F = 2 E^* a \delta\, n/(n + 1)

    n = 1 is a cone, n = 2 a sphere (C = 1/(2R)), large n tends to a flat end.

    Parameters
    ----------
    radius : float [mm]
        Contact radius a.
    coefficient : float [mm^(1-n)]
        C, positive.
    exponent : float
        n, positive.
    contact_modulus : float [MPa]
        E*.

    Returns
    -------
    PunchContact
        ``load`` [N], ``radius`` [mm], ``approach`` [mm].

    Raises
    ------
    InputError
        If an argument is not positive and finite.

    References
    ----------
    Sneddon 1965, Int. J. Eng. Sci. 3, 47-57.

    Examples
    --------
    >>> cone = power_law(1.0, 0.01, 1.0, 115e3)
    >>> round(cone.load / (0.01 * 115e3), 6), round(cone.approach / 0.01, 6)
    (1.570796, 1.570796)
    """
    require_positive(radius=radius, coefficient=coefficient, exponent=exponent, contact_modulus=contact_modulus)
    ratio = math.exp(math.lgamma(1.0 + exponent / 2.0) - math.lgamma((1.0 + exponent) / 2.0))
    approach = coefficient * radius**exponent * math.sqrt(math.pi) * ratio
    load = 2.0 * contact_modulus * radius * approach * exponent / (exponent + 1.0)
    return PunchContact(load, radius, approach)


@checked
def flat_circular(load: float, radius: float, contact_modulus: float) -> PunchContact:
    r"""Flat-ended cylinder: :math:`\delta = F/(2 a E^*)`.

    Parameters
    ----------
    load : float [N]
        Normal load, positive.
    radius : float [mm]
        Radius a of the flat end.
    contact_modulus : float [MPa]
        E*.

    Returns
    -------
    PunchContact
        ``load`` [N], ``radius`` [mm], ``approach`` [mm].

    Raises
    ------
    InputError
        If an argument is not positive and finite.

    References
    ----------
    Sneddon 1965, Int. J. Eng. Sci. 3, 47-57; Johnson 1985, Contact Mechanics, section 3.4.
    """
    require_positive(load=load, radius=radius, contact_modulus=contact_modulus)
    return PunchContact(load, radius, load / (2.0 * radius * contact_modulus))


@checked
@dataclass(frozen=True)
class RoundedPunch:
    r"""Flat punch with rounded ends on an elastic half-plane.

    .. math::
        P = \frac{E^* b^2}{4 R} (\pi - 2 \varphi_0 - \sin 2 \varphi_0), \qquad \sin\varphi_0 = \frac{a}{b}

    Parameters
    ----------
    half_width : float [mm]
        a, of the flat part; 0 is Hertz's cylinder.
    radius : float [mm]
        R, of the rounded ends.
    contact_half_width : float [mm]
        b, of the contact, above a.
    contact_modulus : float [MPa]
        E*.

    Raises
    ------
    InputError
        If an argument is out of range.

    References
    ----------
    Ciavarella, Hills & Monno 1998, Proc. Inst. Mech. Eng. C 212, 319-328.

    Examples
    --------
    >>> punch = RoundedPunch(0.1, 0.2, 0.11, 113187.0)
    >>> round(punch.line_load, 2), round(float(punch.pressure(0.0)), 1)
    (174.53, 524.2)
    """

    half_width: float
    radius: float
    contact_half_width: float
    contact_modulus: float

    def __post_init__(self) -> None:
        require(
            (0.0 <= self.half_width < math.inf, f"half_width: {self.half_width} mm is negative or not finite"),
            (
                self.half_width < self.contact_half_width < math.inf,
                f"contact_half_width: {self.contact_half_width} mm is not finite and above half_width",
            ),
        )
        require_positive(radius=self.radius, contact_modulus=self.contact_modulus)

    @property
    def line_load(self) -> float:
        """P, force per length [N/mm]."""
        return self.contact_modulus * self.contact_half_width**2 * self._opening / (4.0 * self.radius)

    @property
    def _angle(self) -> float:
        return math.asin(self.half_width / self.contact_half_width)

    @property
    def _opening(self) -> float:
        return math.pi - 2.0 * self._angle - math.sin(2.0 * self._angle)

    def gap(self, x: ArrayLike) -> NDArray[np.float64]:
        """Gap before loading at places from the middle [mm], the ends rounded as parabolas."""
        beyond = np.maximum(np.abs(np.asarray(x, dtype=float)) - self.half_width, 0.0)
        return np.asarray(beyond**2 / (2.0 * self.radius))

    def pressure(self, x: ArrayLike) -> NDArray[np.float64]:
        """Pressure at places from the middle [MPa]; zero outside the contact."""
        place = np.asarray(x, dtype=float) / self.contact_half_width
        inside, start = np.abs(place) < 1.0, self._angle
        angle = np.arcsin(np.where(inside, np.abs(place), 0.0))
        # Where the rounding begins two logarithms are infinite, and their sum is not.
        apart = np.maximum(np.abs(angle - start), 1e-12)
        angle = np.where(angle < start, start - apart, start + apart)
        far, near = np.sin(angle + start), np.sin(apart)
        logarithms = np.sin(angle) * np.log(far / near)
        logarithms += math.sin(start) * np.log(np.tan(0.5 * (angle + start)) * np.tan(0.5 * apart))
        shape = ((math.pi - 2.0 * start) * np.cos(angle) + logarithms) / self._opening
        return np.asarray(np.where(inside, 2.0 * self.line_load / (math.pi * self.contact_half_width) * shape, 0.0))

    def peak(self) -> tuple[float, float]:
        """Place of the largest pressure from the middle [mm], and its value [MPa]."""
        from scipy.optimize import minimize_scalar

        ends = (self.half_width, self.contact_half_width) if self.half_width > 0.0 else (0.0, 0.0)
        if ends[1] == 0.0:
            return 0.0, float(self.pressure(0.0))
        optimum = minimize_scalar(
            lambda x: -float(self.pressure(x)), bounds=ends, method="bounded", options={"xatol": 1e-9}
        )
        return float(optimum.x), -float(optimum.fun)
