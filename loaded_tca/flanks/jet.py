"""A function of (rho, z) with its first and second derivatives, and the few rules to combine them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from loaded_tca.arrays import Array

SMALLEST_DISTANCE = 1e-3
"""Cone distances are kept above this fraction of R_m: at the apex there is no flank."""

Bends = Sequence[Any]
"""Second derivatives by rho rho, rho z and z z."""
FLAT = (0.0, 0.0, 0.0)


class Jet:
    """Value, gradient and Hessian of a function of (rho, z); arrays that broadcast against each other.

    Plain floats stand for constants, and a derivative that is the number zero costs nothing. Never changed once made.

    Parameters
    ----------
    value, rho, z : array or float
        The function and its first derivatives.
    bends : three arrays or floats, or a function that returns them
        Second derivatives by rho rho, rho z, z z. The function is called when the first of them is asked for: Newton's
        method along a normal does without.
    """

    __slots__ = ("_bends", "rho", "value", "z")

    def __init__(self, value: Any, rho: Any = 0.0, z: Any = 0.0, bends: Bends | Callable[[], Bends] = FLAT) -> None:
        self.value, self.rho, self.z, self._bends = value, rho, z, bends

    @property
    def bends(self) -> Bends:
        """Second derivatives by rho rho, rho z, z z."""
        if callable(self._bends):
            self._bends = self._bends()
        return self._bends

    rho_rho = property(lambda self: self.bends[0], doc="Second derivative by rho.")
    rho_z = property(lambda self: self.bends[1], doc="Mixed derivative.")
    z_z = property(lambda self: self.bends[2], doc="Second derivative by z.")

    def __add__(self, other: Jet) -> Jet:
        slopes = _sum(self.rho, other.rho), _sum(self.z, other.z)
        return Jet(self.value + other.value, *slopes, lambda: [*map(_sum, self.bends, other.bends)])

    def __mul__(self, factor: Any) -> Jet:
        """Multiply by a number, or by an array that does not depend on (rho, z)."""
        slopes = _product(self.rho, factor), _product(self.z, factor)
        return Jet(self.value * factor, *slopes, lambda: [_product(part, factor) for part in self.bends])

    __rmul__ = __mul__

    def times(self, other: Jet) -> Jet:
        """Product of two functions (Leibniz)."""
        f, g = self, other

        def bends() -> Bends:
            mixed = _sum(_product(f.rho, g.z), _product(f.z, g.rho))
            slopes = 2.0 * _product(f.rho, g.rho), mixed, 2.0 * _product(f.z, g.z)
            bent = (_sum(_product(p, g.value), _product(q, f.value)) for p, q in zip(f.bends, g.bends, strict=True))
            return [*map(_sum, slopes, bent)]

        return Jet(
            f.value * g.value,
            _sum(_product(f.rho, g.value), _product(g.rho, f.value)),
            _sum(_product(f.z, g.value), _product(g.z, f.value)),
            bends,
        )

    def compose(self, value: Any, first: Any, second: Any) -> Jet:
        """f(self), given f, f' and f'' at ``self.value`` (chain rule); f'' may be a function that returns it."""

        def bends() -> Bends:
            bend = second() if callable(second) else second
            (rho_rho, rho_z, z_z), bend_rho, bend_z = self.bends, _product(self.rho, bend), _product(self.z, bend)
            return (
                _sum(_product(bend_rho, self.rho), _product(rho_rho, first)),
                _sum(_product(bend_rho, self.z), _product(rho_z, first)),
                _sum(_product(bend_z, self.z), _product(z_z, first)),
            )

        return Jet(value, _product(self.rho, first), _product(self.z, first), bends)

    def shifted_scaled(self, origin: float, length: float) -> Jet:
        """(self - origin)/length."""
        return (self + Jet(-origin)) * (1.0 / length)


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

    Its first derivatives are sine and cosine of the cone angle.

    Examples
    --------
    >>> round(float(cone_distance(3.0, 4.0, 5.0).rho), 1)
    0.6
    """
    value = np.maximum(np.sqrt(rho * rho + z * z), SMALLEST_DISTANCE * mean)
    sine, cosine = rho / value, z / value

    def bends() -> Bends:
        along_sine, along_cosine = sine / value, cosine / value
        return cosine * along_cosine, -cosine * along_sine, sine * along_sine

    return Jet(value, sine, cosine, bends)


def of_cone_angle(rho: Array, z: Array, value: Any, first: Any, second: Any) -> Jet:
    """f(u) of the cone angle u = atan2(rho, z), given f, f' and f'' there; f'' may be a function that returns it."""
    square = rho * rho + z * z
    slope_rho, slope_z = z / square, -rho / square

    def bends() -> Bends:
        twice = 2.0 * slope_rho * slope_z
        return twice, (slope_z - slope_rho) * (slope_z + slope_rho), -twice

    return Jet(None, slope_rho, slope_z, bends).compose(value, first, second)


def cone_angle(rho: Array, z: Array) -> Jet:
    """U = atan2(rho, z) [rad].

    Examples
    --------
    >>> round(float(cone_angle(1.0, 1.0).value / np.pi), 2)
    0.25
    """
    return of_cone_angle(rho, z, np.arctan2(rho, z), 1.0, 0.0)
