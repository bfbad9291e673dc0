"""Cone angle and cone distance, the coordinates of a bevel flank as seen from its apex, over (rho, z)."""

from __future__ import annotations

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.flanks.jet import Jet

SMALLEST_DISTANCE = 1e-3
"""Cone distances are kept above this fraction of R_m: at the apex there is no flank."""


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
