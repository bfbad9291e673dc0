"""A function of (rho, z) with its first and second derivatives, and the few rules to combine them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from numpy.typing import NDArray

Array = NDArray[Any]


@dataclass(frozen=True)
class Jet:
    """Value, gradient and Hessian of a function of (rho, z); arrays that broadcast against each other.

    Plain floats stand for constants, so that a derivative that vanishes costs nothing.
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
        parts = (self.rho, self.z, self.rho_rho, self.rho_z, self.z_z)
        return all(isinstance(part, float) and part == 0.0 for part in parts)

    def __add__(self, other: Jet) -> Jet:
        return Jet(
            self.value + other.value,
            self.rho + other.rho,
            self.z + other.z,
            self.rho_rho + other.rho_rho,
            self.rho_z + other.rho_z,
            self.z_z + other.z_z,
        )

    def __mul__(self, factor: Any) -> Jet:
        """Multiply by a number, or by an array that does not depend on (rho, z)."""
        return Jet(
            self.value * factor,
            self.rho * factor,
            self.z * factor,
            self.rho_rho * factor,
            self.rho_z * factor,
            self.z_z * factor,
        )

    __rmul__ = __mul__

    def times(self, other: Jet) -> Jet:
        """Product of two functions (Leibniz)."""
        if other.is_constant:
            return self * other.value
        return Jet(
            self.value * other.value,
            self.rho * other.value + self.value * other.rho,
            self.z * other.value + self.value * other.z,
            self.rho_rho * other.value + 2.0 * self.rho * other.rho + self.value * other.rho_rho,
            self.rho_z * other.value + self.rho * other.z + self.z * other.rho + self.value * other.rho_z,
            self.z_z * other.value + 2.0 * self.z * other.z + self.value * other.z_z,
        )

    def compose(self, value: Any, first: Any, second: Any) -> Jet:
        """f(self), given f, f' and f'' at ``self.value`` (chain rule)."""
        return Jet(
            value,
            first * self.rho,
            first * self.z,
            second * self.rho**2 + first * self.rho_rho,
            second * self.rho * self.z + first * self.rho_z,
            second * self.z**2 + first * self.z_z,
        )

    def shifted_scaled(self, origin: float, length: float) -> Jet:
        """(self - origin)/length."""
        scaled = self * (1.0 / length)
        return replace(scaled, value=scaled.value - origin / length)


def weighted_sum(jets: Sequence[Jet], weights: Array) -> Jet:
    """Sum of ``jets[k] * weights[..., k]``; at least one jet."""
    total = jets[0] * weights[..., 0]
    for k, jet in enumerate(jets[1:], 1):
        total = total + jet * weights[..., k]
    return total
