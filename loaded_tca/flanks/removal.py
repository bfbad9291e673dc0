"""Material removed from a flank along its normal: shapes over a coordinate, their sum, and the flank without it.

Shapes f(t) come with their two derivatives; t is 0 where a modification begins and 1 where it has its amount.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Any, Literal

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array
from loaded_tca.flanks.base import DerivedFlank, Flank, Jet, unmodified

Shape = Callable[[Any], tuple[Any, Any, Any]]
"""t -> (f, f', f'')."""


LOGARITHMIC_STEEPNESS = 0.99
"""k of the logarithmic crowning C ln(1 - k t^2)/ln(1 - k)."""


def linear(t: Any) -> tuple[Any, Any, Any]:
    """f = t."""
    return t, 1.0, 0.0


def parabola(t: Any) -> tuple[Any, Any, Any]:
    """f = t^2."""
    return t**2, 2.0 * t, 2.0


def one_sided_parabola(t: Any) -> tuple[Any, Any, Any]:
    """f = t^2 for t > 0, else 0."""
    positive = np.maximum(t, 0.0)
    return positive**2, 2.0 * positive, 2.0 * (t > 0.0)


@dataclass(frozen=True)
class CircularArc:
    """f = (R - sqrt(R^2 - y^2))/C with y = half_width t and R = half_width^2/(2 C) + C/2; C = amount > 0."""

    amount: float
    half_width: float

    def __call__(self, t: Any) -> tuple[Any, Any, Any]:
        """f, f', f'' at t."""
        radius = self.half_width**2 / (2.0 * self.amount) + 0.5 * self.amount
        y = self.half_width * t
        root = np.sqrt(np.maximum(radius**2 - y**2, (1e-3 * radius) ** 2))
        value, slope = y**2 / (radius + root), self.half_width * y / root
        return value / self.amount, slope / self.amount, (self.half_width * radius) ** 2 / root**3 / self.amount


def logarithmic(t: Any) -> tuple[Any, Any, Any]:
    """f = ln(1 - k t^2)/ln(1 - k) for |t| <= 1, continued as its own parabola beyond."""
    k, scale = LOGARITHMIC_STEEPNESS, np.log1p(-LOGARITHMIC_STEEPNESS)
    inner = np.clip(t, -1.0, 1.0)
    rest, over = 1.0 - k * inner**2, t - inner
    slope, bend = -2.0 * k * inner / rest, -2.0 * k * (1.0 + k * inner**2) / rest**2
    value = np.log1p(-k * inner**2) + slope * over + 0.5 * bend * over**2
    return value / scale, (slope + bend * over) / scale, bend / scale


@dataclass(frozen=True)
class Term:
    """amount * shape((coordinate - origin)/length); ``shape`` None is the ramp max(t, 0), which has a relief start."""

    direction: Literal["profile", "lengthwise"]
    amount: float
    origin: float
    length: float
    shape: Shape | None

    def coordinate(self, flank: Flank, rho: Array, z: Array) -> Jet:
        """T = (coordinate - origin)/length with its derivatives."""
        along = flank.profile_coordinate if self.direction == "profile" else flank.lengthwise_coordinate
        return along(rho, z).shifted_scaled(self.origin, self.length)

    def removal(self, flank: Flank, rho: Array, z: Array, beyond: Any) -> Jet:
        """Material removed [mm]; ``beyond`` picks the branch of a ramp (None: where the point lies)."""
        t = self.coordinate(flank, rho, z)
        if self.shape is not None:
            return t.compose(*(self.amount * part for part in self.shape(t.value)))
        on = (t.value > 0.0) if beyond is None else beyond
        return t * (self.amount * np.where(on, 1.0, 0.0))


@dataclass(frozen=True)
class Polynomial:
    """a1 + a2 x + a3 y + a4 x y + a5 x^2 + a6 y^2, with x lengthwise and y along the profile, both from the middle.

    Parameters
    ----------
    coefficients : 6 floats [mm, 1, 1, 1/mm, 1/mm, 1/mm]
        a1 to a6.
    origin : float
        Profile coordinate of the middle, y = 0.
    unit : float [mm]
        Length of one unit of the profile coordinate.
    """

    coefficients: tuple[float, ...]
    origin: float
    unit: float

    def removal(self, flank: Flank, rho: Array, z: Array, beyond: Any) -> Jet:  # noqa: ARG002 (it has no relief start)
        """Material removed [mm]."""
        constant, along, up, twist, along_along, up_up = self.coefficients
        x = flank.lengthwise_coordinate(rho, z)
        y = flank.profile_coordinate(rho, z).shifted_scaled(self.origin, 1.0 / self.unit)
        lengthwise = x.compose(
            constant + x.value * (along + x.value * along_along), along + 2.0 * along_along * x.value, 2.0 * along_along
        )
        profile = y.compose(y.value * (up + y.value * up_up), up + 2.0 * up_up * y.value, 2.0 * up_up)
        return lengthwise + profile + x.times(y) * twist


@checked
class ModifiedFlank(DerivedFlank):
    """A flank with material removed along its normal: Theta - s delta |grad F|.

    Parameters
    ----------
    nominal : Flank
        The unmodified flank, whose region, coordinates and |grad F| are kept.
    terms : tuple of Term and Polynomial
        Modifications, added up.
    """

    def __init__(self, nominal: Flank, terms: tuple[Term | Polynomial, ...]) -> None:
        super().__init__(nominal)
        self.terms = terms
        self._ramps = tuple(term for term in terms if isinstance(term, Term) and term.shape is None)

    def removal(self, rho: Array, z: Array, beyond: Any = None) -> Jet:
        """Material removed [mm] by all modifications together."""
        removed = []
        for term in self.terms:
            branch = beyond[..., self._ramps.index(term)] if beyond is not None and term in self._ramps else None
            removed.append(term.removal(self.nominal, rho, z, branch))
        return reduce(Jet.__add__, removed) if removed else Jet(np.zeros(np.broadcast(rho, z).shape))

    def theta(self, rho: Array, z: Array, beyond: Any = None) -> Jet:
        """Theta of the modified flank."""
        turned = self.nominal.gradient_norm(rho, z) * -float(self.side)
        return self.nominal.theta(rho, z) + self.removal(rho, z, beyond).times(turned)

    def without_ramps(self, dropped: Sequence[bool]) -> ModifiedFlank:
        """The flank as it is before the starts of some of its linear reliefs, everywhere."""
        ramps = [term for term, drop in zip(self._ramps, dropped, strict=True) if drop]
        return ModifiedFlank(self.nominal, tuple(term for term in self.terms if term not in ramps))

    def relief_starts(self, rho: Array, z: Array) -> tuple[Jet, ...]:
        """Starts of the linear reliefs, in millimetres of roll length beyond them."""
        return tuple(term.coordinate(self.nominal, rho, z) * abs(term.length) for term in self._ramps)


def removal_change(below: Flank, above: Flank, rho: Array, z: Array) -> Array:
    """Material that ``above`` removes more than ``below`` [mm], two flanks that differ in their modifications alone.

    Only terms that differ are computed, so that a small difference of two values is exact to rounding.

    Parameters
    ----------
    below, above : Flank
    rho, z : (...) array [mm]

    Returns
    -------
    (...) array [mm]
    """
    less, more = (flank.terms if isinstance(flank, ModifiedFlank) else () for flank in (below, above))
    total = np.zeros(np.broadcast(rho, z).shape)
    for sign, own, other in ((1.0, more, less), (-1.0, less, more)):
        for term in own:
            if term not in other:
                total += sign * term.removal(unmodified(below), rho, z, None).value
    return total
