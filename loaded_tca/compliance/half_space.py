"""Displacements inside a half-plane and a half-space under a normal force on the surface."""

from __future__ import annotations

import math

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.material import Material


def depth_displacement(depth: Array, distance: Array, material: Material) -> Array:
    r"""Displacement along the force at a depth below the surface of a half-space, per force [mm/N].

    .. math:: u = \frac{1 + \nu}{2\pi E} \left(\frac{t^2}{R^3} + \frac{2(1 - \nu)}{R}\right),\qquad R^2 = t^2 + s^2

    Parameters
    ----------
    depth : (...) array [mm]
        t, positive.
    distance : (...) array [mm]
        s, from the force, along the surface.
    material : Material

    References
    ----------
    Johnson 1985, Contact Mechanics, eq. 3.18 (Boussinesq).

    Examples
    --------
    >>> steel = Material(206000.0, 0.3)
    >>> float(depth_displacement(np.array(1e-9), np.array(2.0), steel))  # at the surface: (1 - nu^2)/(pi E s)
    7.030...e-07
    """
    square = depth * depth + distance * distance
    nu = material.poisson_ratio
    scale = (1.0 + nu) / (2.0 * math.pi * material.youngs_modulus)
    return np.asarray(scale * (depth * depth / square + 2.0 * (1.0 - nu)) / np.sqrt(square))


def depth_displacement_slope(depth: float, square: Array, material: Material) -> Array:
    """Derivative of :func:`depth_displacement` by the square of the distance [1/(N mm)], at squares [mm^2]."""
    from_force, nu = depth * depth + square, material.poisson_ratio
    scale = (1.0 + nu) / (2.0 * math.pi * material.youngs_modulus)
    return np.asarray(-scale * (1.5 * depth * depth / from_force + (1.0 - nu)) / (from_force * np.sqrt(from_force)))


def line_force(points: Array, material: Material) -> tuple[Array, Array]:
    r"""Displacement and stress in a half-plane under a line force on its surface, strain being plane.

    .. math::
        \sigma_r = -\frac{2 \cos\theta}{\pi r},\qquad
        u_r = -\frac{2(1 - \nu^2)}{\pi E} \cos\theta \ln r - \frac{(1 - 2\nu)(1 + \nu)}{\pi E} \theta \sin\theta

    and :math:`u_\theta` accordingly. The solution goes on beyond the surface, with a cut along the ray outwards.

    Parameters
    ----------
    points : (..., 2) array [mm]
        From the force: along it (into the half-plane) and across it, turned to the left.
    material : Material

    Returns
    -------
    displacement : (..., 2) array [mm per N/mm]
        But for a rigid displacement.
    stress : (..., 2, 2) array [MPa per N/mm]

    References
    ----------
    Johnson 1985, Contact Mechanics, eqs. 2.15 and 2.19 (Flamant).
    """
    nu, modulus = material.poisson_ratio, math.pi * material.youngs_modulus
    radius, angle = np.hypot(points[..., 0], points[..., 1]), np.arctan2(points[..., 1], points[..., 0])
    cosine, sine, logarithm = np.cos(angle), np.sin(angle), np.log(radius)
    plane, twist = 2.0 * (1.0 - nu**2) / modulus, (1.0 - 2.0 * nu) * (1.0 + nu) / modulus
    radial = -plane * cosine * logarithm - twist * angle * sine
    hoop = plane * sine * logarithm + 2.0 * nu * (1.0 + nu) / modulus * sine + twist * (sine - angle * cosine)
    along, across = np.stack([cosine, sine], axis=-1), np.stack([-sine, cosine], axis=-1)
    tension = -2.0 * cosine / (math.pi * radius)
    stress = tension[..., None, None] * along[..., :, None] * along[..., None, :]
    return radial[..., None] * along + hoop[..., None] * across, stress
