"""A function of (rho, z) with its first and second derivatives, and the few rules to combine them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from loaded_tca.arrays import Array

SMALLEST_DISTANCE = 1e-3
"""Cone distances are kept above this fraction of R_m: at the apex there is no flank."""


@dataclass(frozen=True)
class Jet:
    """Value, gradient and Hessian of a function of (rho, z); arrays that broadcast against each other.

    Plain floats stand for constants, and a derivative that is the number zero costs nothing.
    """

    value: Any
    rho: Any = 0.0
    z: Any = 0.0
    rho_rho: Any = 0.0
    rho_z: Any = 0.0
    z_z: Any = 0.0

    @property
    def is_constant(self) -> bool:
        """Whether all derivatives are the number zero."""
        parts = self.rho, self.z, self.rho_rho, self.rho_z, self.z_z
        return all(type(part) is float and part == 0.0 for part in parts)

    def __add__(self, other: Jet) -> Jet:
        return Jet(
            self.value + other.value,
            _sum(self.rho, other.rho),
            _sum(self.z, other.z),
            _sum(self.rho_rho, other.rho_rho),
            _sum(self.rho_z, other.rho_z),
            _sum(self.z_z, other.z_z),
        )

    def __mul__(self, factor: Any) -> Jet:
        """Multiply by a number, or by an array that does not depend on (rho, z)."""
        return Jet(
            self.value * factor,
            _product(self.rho, factor),
            _product(self.z, factor),
            _product(self.rho_rho, factor),
            _product(self.rho_z, factor),
            _product(self.z_z, factor),
        )

    __rmul__ = __mul__

    def times(self, other: Jet) -> Jet:
        """Product of two functions (Leibniz)."""
        if other.is_constant:
            return self * other.value
        f, g = self, other
        mixed = _sum(_product(f.rho, g.z), _product(f.z, g.rho))
        return Jet(
            f.value * g.value,
            _sum(_product(f.rho, g.value), _product(g.rho, f.value)),
            _sum(_product(f.z, g.value), _product(g.z, f.value)),
            _sum(2.0 * _product(f.rho, g.rho), _sum(_product(f.rho_rho, g.value), _product(g.rho_rho, f.value))),
            _sum(mixed, _sum(_product(f.rho_z, g.value), _product(g.rho_z, f.value))),
            _sum(2.0 * _product(f.z, g.z), _sum(_product(f.z_z, g.value), _product(g.z_z, f.value))),
        )

    def compose(self, value: Any, first: Any, second: Any) -> Jet:
        """f(self), given f, f' and f'' at ``self.value`` (chain rule)."""
        bend_rho, bend_z = _product(self.rho, second), _product(self.z, second)
        return Jet(
            value,
            _product(self.rho, first),
            _product(self.z, first),
            _sum(_product(bend_rho, self.rho), _product(self.rho_rho, first)),
            _sum(_product(bend_rho, self.z), _product(self.rho_z, first)),
            _sum(_product(bend_z, self.z), _product(self.z_z, first)),
        )

    def shifted_scaled(self, origin: float, length: float) -> Jet:
        """(self - origin)/length."""
        return Jet(self.value - origin, self.rho, self.z, self.rho_rho, self.rho_z, self.z_z) * (1.0 / length)


def _product(part: Any, factor: Any) -> Any:
    if (type(part) is float and part == 0.0) or (type(factor) is float and factor == 0.0):
        return 0.0
    return part * factor


def _sum(part: Any, other: Any) -> Any:
    if type(part) is float and part == 0.0:
        return other
    if type(other) is float and other == 0.0:
        return part
    return part + other


def weighted_sum(jets: Sequence[Jet], weights: Array) -> Jet:
    """Sum of ``jets[k] * weights[..., k]``; at least one jet."""
    total = jets[0] * weights[..., 0]
    for k, jet in enumerate(jets[1:], 1):
        total = total + jet * weights[..., k]
    return total


def cone_distance(rho: Array, z: Array, mean: float) -> Jet:
    """R = hypot(rho, z) [mm], kept above 1e-3 of the mean cone distance.

    Examples
    --------
    >>> round(float(cone_distance(3.0, 4.0, 5.0).rho), 1)
    0.6
    """
    value = np.maximum(np.sqrt(rho * rho + z * z), SMALLEST_DISTANCE * mean)
    sine, cosine = rho / value, z / value
    along_sine, along_cosine = sine / value, cosine / value
    return Jet(value, sine, cosine, cosine * along_cosine, -cosine * along_sine, sine * along_sine)


def cone_angle(rho: Array, z: Array) -> Jet:
    """U = atan2(rho, z) [rad].

    Examples
    --------
    >>> round(float(cone_angle(1.0, 1.0).value / np.pi), 2)
    0.25
    """
    square = rho * rho + z * z
    slope_rho, slope_z = z / square, -rho / square
    twice = 2.0 * slope_rho * slope_z
    mixed = (slope_z - slope_rho) * (slope_z + slope_rho)
    return Jet(np.arctan2(rho, z), slope_rho, slope_z, twice, mixed, -twice)
