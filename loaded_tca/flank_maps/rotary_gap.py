r"""The gap between two flanks, to first order, at points of one of them.

Gears that stand at phi1 and phi2 are apart by an angle about one axis at every point of a flank: what the mating gear
would have to turn to touch it there. Times the lever of the mating gear's normal about its axis this is the gap, to
first order,

.. math:: g = \Delta\varphi\,|n \cdot (w \times r)| = \Delta\varphi/|\nabla F|, \qquad F = \theta - \Theta(\rho, z),

since the normal is the direction of grad F, whose azimuthal part is 1/rho. No tangent plane, no curvature and no
fitted section is needed.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.pairs.gear_pair import GearPair

Gear = Literal["pinion", "wheel"]


def flank_gap(
    pair: GearPair, gear: Gear, angles: tuple[Array, Array], place: tuple[Array, Array]
) -> tuple[Array, Array, Array]:
    """Gap at points of one flank, to first order, and the same points on the mating gear.

    Parameters
    ----------
    pair : GearPair
    gear : {"pinion", "wheel"}
        The gear whose flank the points lie on.
    angles : two arrays [rad]
        phi1 and phi2 at which the gears stand; they broadcast against the points.
    place : two arrays [mm]
        rho and z of the points.

    Returns
    -------
    gap : array [mm]
        Negative where the flanks penetrate; +inf beyond the edges of the mating gear.
    radius, axial : array [mm]
        Of the points in the mating gear's frame.
    """
    (phi1, phi2), (rho, z) = angles, place
    if gear == "pinion":
        point, mating = cartesian(rho, pair.pinion.flank.theta(rho, z).value + pair.sense * phi1, z), pair.wheel.flank
        radius, theta, axial = pair.to_wheel(point)
        jet = mating.theta(radius, axial)
        lag = pair.driving * (phi2 - pair.sense * (jet.value - theta))
    else:
        point, mating = cartesian(rho, pair.wheel.flank.theta(rho, z).value - pair.sense * phi2, z), pair.pinion.flank
        x, y, axial = np.moveaxis(point @ pair.wheel_axes + pair.wheel_origin, -1, 0)
        radius, theta = np.hypot(x, y), np.arctan2(y, x)
        jet = mating.theta(radius, axial)
        lag = pair.driving * (pair.sense * (theta - jet.value) - phi1)
    lever = 1.0 / np.sqrt(jet.rho**2 + 1.0 / radius**2 + jet.z**2)
    return np.where(mating.inside(radius, axial), lag * lever, np.inf), radius, axial


def cartesian(rho: Array, theta: Array, z: Array) -> Array:
    """Points (..., 3) at cylindrical coordinates."""
    return np.stack(np.broadcast_arrays(rho * np.cos(theta), rho * np.sin(theta), z), axis=-1)
