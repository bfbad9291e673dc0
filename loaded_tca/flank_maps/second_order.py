r"""A field on a flank by its second-order coefficients: the numbers that engineers call it by.

.. math:: f = a_1 + a_2 x + a_3 y + a_4 x y + a_5 x^2 + a_6 y^2

by least squares, x lengthwise and y along the profile, both from the middle: the polynomial of
:class:`loaded_tca.flanks.FlankModifications`, read the other way round.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.structured_grid import flank_coordinates


@dataclass(frozen=True)
class SecondOrder:
    """Second-order coefficients of material removed from a part of a flank.

    Attributes
    ----------
    polynomial : 6 floats [mm, 1, 1, 1/mm, 1/mm, 1/mm]
        a1 to a6, as ``FlankModifications(polynomial=...)`` takes them.
    origin : (float, float) [mm]
        Lengthwise and profile coordinate of the middle, x = y = 0.
    size : (float, float) [mm]
        Length and height of the part in these coordinates, in its middle.
    arcs : (float, float)
        Millimetres on the surface, in the middle, for one of x and one of y.
    residual : float [mm]
        Root of the mean square that the polynomial misses.
    """

    polynomial: tuple[float, ...]
    origin: tuple[float, float]
    size: tuple[float, float]
    arcs: tuple[float, float]
    residual: float

    @property
    def spiral_angle(self) -> float:
        """Angle [rad] by which the flank is turned lengthwise; positive: material off towards the heel (z > 0)."""
        return math.atan(self.polynomial[1] / self.arcs[0])

    @property
    def pressure_angle(self) -> float:
        """Angle [rad] by which the flank is turned along the profile; positive: material off towards the tip."""
        return math.atan(self.polynomial[2] / self.arcs[1])

    @property
    def lengthwise_slope(self) -> float:
        """C_H_beta, the rise over the length [mm]."""
        return self.polynomial[1] * self.size[0]

    @property
    def profile_slope(self) -> float:
        """C_H_alpha, the rise over the height [mm]."""
        return self.polynomial[2] * self.size[1]

    @property
    def twist(self) -> float:
        """S, the lengthwise slope at the tip less that at the foot [mm]."""
        return self.polynomial[3] * self.size[0] * self.size[1]

    @property
    def lengthwise_crowning(self) -> float:
        """C_beta, at both ends of the length [mm]."""
        return self.polynomial[4] * (0.5 * self.size[0]) ** 2

    @property
    def profile_crowning(self) -> float:
        """C_alpha, at both ends of the height [mm]."""
        return self.polynomial[5] * (0.5 * self.size[1]) ** 2

    def __repr__(self) -> str:
        angles = [60.0 * math.degrees(angle) for angle in (self.spiral_angle, self.pressure_angle)]
        lengths = [1e3 * length for length in (self.lengthwise_crowning, self.profile_crowning, self.twist)]
        spiral, pressure, beta, alpha, twist = (f"{round(value, 4) + 0.0:.3g}" for value in (*angles, *lengths))
        return (
            f"SecondOrder(spiral angle {spiral} arcmin, pressure angle {pressure} arcmin, "
            f"crownings {beta} um and {alpha} um, twist {twist} um)"
        )


def second_order(flank: Flank, rho: Array, z: Array, removed: Array) -> SecondOrder:
    """Second-order coefficients of material removed at a grid of points of a flank.

    Parameters
    ----------
    flank : Flank
    rho, z, removed : (profile, lengthwise) array [mm]
        The grid, evenly spaced, and the material removed; at least three each way.

    Returns
    -------
    SecondOrder

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> gears = [CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)]
    >>> flank = cylindrical_pair(CylindricalMesh(*gears)).pinion.flank
    >>> rho, z = flank.grid(9, 9)
    >>> second_order(flank, rho, z, 0.010 * (z / 12.5) ** 2)
    SecondOrder(spiral angle 0 arcmin, pressure angle 0 arcmin, crownings 10 um and 0 um, twist 0 um)
    """
    x, y = flank_lengths(flank, rho, z)
    length, height = x[:, -1] - x[:, 0], y[-1] - y[0]
    origin = (float((x[:, 0] + 0.5 * length).mean()), float((y[0] + 0.5 * height).mean()))
    size = (float(length.mean()), float(height.mean()))
    u, v = ((part - middle) / (0.5 * whole) for part, middle, whole in zip((x, y), origin, size, strict=True))
    terms = np.stack([np.ones_like(u), u, v, u * v, u**2, v**2], axis=-1).reshape(-1, 6)
    scaled = np.linalg.lstsq(terms, removed.ravel())[0]
    missed = removed.ravel() - terms @ scaled
    half = 0.5 * np.array(size)
    lengths = np.array([1.0, half[0], half[1], half[0] * half[1], half[0] ** 2, half[1] ** 2])
    middle_rho, middle_z = (part[central(u.shape)].mean() for part in (rho, z))
    theta, along = flank.theta(middle_rho, middle_z), flank.lengthwise_coordinate(middle_rho, middle_z)
    up = flank.profile_coordinate(middle_rho, middle_z) * flank.profile_unit
    steps = np.linalg.inv(np.array([[along.rho, along.z], [up.rho, up.z]], dtype=float))
    tangents = np.array([[1.0, middle_rho * theta.rho, 0.0], [0.0, middle_rho * theta.z, 1.0]], dtype=float)
    arcs = np.linalg.norm(steps.T @ tangents, axis=-1).tolist()
    return SecondOrder(
        polynomial=tuple((scaled / lengths).tolist()),
        origin=origin,
        size=size,
        arcs=(arcs[0], arcs[1]),
        residual=float(np.sqrt((missed**2).mean())),
    )


def flank_lengths(flank: Flank, rho: Array, z: Array) -> tuple[Array, Array]:
    """Lengthwise and profile coordinate (...) of points of a flank, both in mm."""
    profile, lengthwise = flank_coordinates(flank, rho, z)
    return lengthwise, profile * flank.profile_unit


def central(shape: tuple[int, ...]) -> tuple[slice, ...]:
    """The middle of a grid: along each axis its central point, or the central two."""
    return tuple(slice((count - 1) // 2, count // 2 + 1) for count in shape)
