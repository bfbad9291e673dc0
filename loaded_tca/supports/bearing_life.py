r"""Basic dynamic load ratings of rolling bearings after ISO 281, and lives by the forces of their elements.

A life is the basic reference rating life of ISO/TS 16281: the number of revolutions, in millions, that nine of ten
bearings reach, by the forces of all elements instead of an equivalent load. Inner rings turn under loads that stand.

References
----------
ISO 281:2007, 5.1 and 7.1; ISO/TR 1281-1:2008 (factor f_c by its equation instead of its table); ISO/TS 16281:2008,
equations 18-29 (balls) and 47-65 (rollers).
"""

from __future__ import annotations

import math

import numpy as np

from loaded_tca.arrays import Array

STEEL_OF_BALLS, STEEL_OF_ROLLERS = 1.3, 1.1
"""Factor b_m of today's steels: radial balls; cylindrical and tapered rollers, of which some have 1.15."""
LAMBDA_OF_BALLS, LAMBDA_NY_OF_ROLLERS = 0.95, 0.83
LARGE_BALL = 25.4
"""Diameter from which the rating grows with a lower power [mm]."""
TABLE_GROOVE, WIDEST_OUTER_GROOVE = 0.52, 0.53
"""Radius of both grooves over the diameter of a ball of which the table of ISO 281 is, and the outer one up to which it
holds."""


def _grooves(inner: float, outer: float) -> float:
    """What the grooves do to both rings, to the power 0.41."""
    return float((inner / outer * (2.0 * outer - 1.0) / (2.0 * inner - 1.0)) ** 0.41)


def ball_factor(gamma: float, inner_groove: float, outer_groove: float) -> float:
    """Factor f_c of radial ball bearings.

    Parameters
    ----------
    gamma : float
        Diameter of a ball times the cosine of the contact angle, over the pitch diameter.
    inner_groove, outer_groove : float
        Radii over the diameter of a ball; closer ones than 0.52 count as 0.52, an outer one up to 0.53 too.

    Examples
    --------
    >>> round(ball_factor(0.1, 0.52, 0.53), 1)
    55.5
    """
    inner = max(inner_groove, TABLE_GROOVE)
    outer = outer_groove if outer_groove > WIDEST_OUTER_GROOVE else TABLE_GROOVE
    of_rings = 1.04 * ((1.0 - gamma) / (1.0 + gamma)) ** 1.72 * _grooves(inner, outer)
    shape = gamma**0.3 * (1.0 - gamma) ** 1.39 / (1.0 + gamma) ** (1.0 / 3.0)
    close = (2.0 * inner / (2.0 * inner - 1.0)) ** 0.41
    return float(0.41 * 98.0665 * LAMBDA_OF_BALLS * close * shape * (1.0 + of_rings ** (10.0 / 3.0)) ** -0.3)


def roller_factor(gamma: float) -> float:
    """Factor f_c of radial roller bearings.

    Examples
    --------
    >>> round(roller_factor(0.2), 1)
    88.7
    """
    of_rings = 1.04 * ((1.0 - gamma) / (1.0 + gamma)) ** (143.0 / 108.0)
    shape = gamma ** (2.0 / 9.0) * (1.0 - gamma) ** (29.0 / 27.0) / (1.0 + gamma) ** 0.25
    return float(207.9 * LAMBDA_NY_OF_ROLLERS * shape * (1.0 + of_rings**4.5) ** (-2.0 / 9.0))


def ball_rating(
    balls: int, diameter: float, pitch_diameter: float, contact_angle: float, inner_groove: float, outer_groove: float
) -> float:
    """Basic dynamic radial load rating [N] of a row of balls.

    Parameters
    ----------
    balls : int
    diameter, pitch_diameter : float [mm]
    contact_angle : float [rad]
    inner_groove, outer_groove : float
        Radii over the diameter of a ball.

    Examples
    --------
    A deep groove ball bearing 6208; catalogues have 29 to 32.5 kN:

    >>> round(ball_rating(9, 12.0, 60.0, 0.0, 0.52, 0.53), -2)
    29500.0
    """
    factor = ball_factor(diameter * math.cos(contact_angle) / pitch_diameter, inner_groove, outer_groove)
    of_size = diameter**1.8 if diameter <= LARGE_BALL else 3.647 * diameter**1.4
    return STEEL_OF_BALLS * factor * math.cos(contact_angle) ** 0.7 * float(balls) ** (2.0 / 3.0) * of_size


def roller_rating(rollers: int, diameter: float, pitch_diameter: float, contact_angle: float, length: float) -> float:
    """Basic dynamic radial load rating [N] of a row of rollers.

    Parameters
    ----------
    rollers : int
    diameter, pitch_diameter, length : float [mm]
    contact_angle : float [rad]

    Examples
    --------
    >>> round(roller_rating(14, 10.0, 60.0, 0.0, 12.0), -2)
    57800.0
    """
    factor = roller_factor(diameter * math.cos(contact_angle) / pitch_diameter)
    along = (length * math.cos(contact_angle)) ** (7.0 / 9.0)
    return STEEL_OF_ROLLERS * factor * along * float(rollers) ** 0.75 * diameter ** (29.0 / 27.0)


def _mean(forces: Array, exponent: float) -> Array:
    """Mean of the forces of all elements, over the first axis, of a power of them."""
    return np.asarray((forces**exponent).mean(axis=0) ** (1.0 / exponent))


def ball_life(
    forces: Array, rating: float, gamma: float, contact_angle: float, inner_groove: float, outer_groove: float
) -> float:
    """Basic reference rating life of a row of balls [million revolutions]; inf without load.

    Parameters
    ----------
    forces : (n,) array [N]
        Of the balls.
    rating : float [N]
        Basic dynamic radial load rating.
    gamma : float
        Diameter of a ball times the cosine of the contact angle, over the pitch diameter.
    contact_angle : float [rad]
    inner_groove, outer_groove : float
        Radii over the diameter of a ball.
    """
    if not forces.max() > 0.0:
        return math.inf
    of_rings = (1.044 * ((1.0 - gamma) / (1.0 + gamma)) ** 1.72 * _grooves(inner_groove, outer_groove)) ** (10.0 / 3.0)
    of_ball = rating / (len(forces) * math.cos(contact_angle) ** 0.7)
    inner = of_ball / 0.407 * (1.0 + of_rings) ** 0.3
    outer = of_ball / 0.389 * (1.0 + 1.0 / of_rings) ** 0.3
    used = (_mean(forces, 3.0) / inner) ** (10.0 / 3.0) + (_mean(forces, 10.0 / 3.0) / outer) ** (10.0 / 3.0)
    return float(used**-0.9)


def roller_life(forces: Array, rating: float, gamma: float, contact_angle: float) -> float:
    """Basic reference rating life of a row of rollers [million revolutions]; inf without load.

    Parameters
    ----------
    forces : (n, slices) array [N]
        Along the rollers; those at their ends count more for the stress there (ISO/TS 16281, equation 60).
    rating : float [N]
        Basic dynamic radial load rating.
    gamma : float
        Diameter of a roller times the cosine of the contact angle, over the pitch diameter.
    contact_angle : float [rad]
    """
    if not forces.max() > 0.0:
        return math.inf
    rollers, slices = forces.shape
    of_rings = (1.038 * ((1.0 - gamma) / (1.0 + gamma)) ** (143.0 / 108.0)) ** 4.5
    of_slice = rating / (LAMBDA_NY_OF_ROLLERS * rollers * math.cos(contact_angle)) * slices ** (-7.0 / 9.0)
    inner = of_slice / 0.378 * (1.0 + of_rings) ** (2.0 / 9.0)
    outer = of_slice / 0.364 * (1.0 + 1.0 / of_rings) ** (2.0 / 9.0)
    from_middle = np.abs(2.0 * np.arange(1, slices + 1) - slices - 1) / (2.0 * slices - 2.0)
    edges = 1.0 - 0.01 / np.log(1.985 * np.maximum(from_middle, 1e-9))
    used = (edges * _mean(forces, 4.0) / inner) ** 4.5 + (edges * _mean(forces, 4.5) / outer) ** 4.5
    return float(used.sum() ** (-8.0 / 9.0))
