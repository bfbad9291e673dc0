r"""The flank that is conjugate to a generated one: what it sweeps out of the other gear, to second order at a place.

With the azimuth :math:`\Phi(\varrho, \alpha, z)` by which a point of space lies off the wheel's flank, in coordinates
of the pinion, and the ratio u = z1/z2, a point of the pinion is in contact where :math:`\Phi_\alpha = -u`, and the
envelope has there

.. math:: \Theta_i = \frac{\Phi_i}{u}, \qquad
          \Theta_{ij} = \frac{1}{u}\left(\Phi_{ij} - \frac{\Phi_{i\alpha} \Phi_{j\alpha}}{\Phi_{\alpha\alpha}}\right).

References
----------
Litvin & Fuentes 2004, Gear Geometry and Applied Theory, section 6.4 (envelopes); here by the azimuth of a point.
"""

from __future__ import annotations

from math import cos, hypot, sin

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import GeometryError
from loaded_tca.flanks.face_milled import GeneratedFlank
from loaded_tca.gears.hypoid import OffsetFrame

MOST_STEPS = 50
RESOLVED = 1e-14
"""Steps of Newton's method, and the one that ends it [rad]."""


def conjugate_flank(
    wheel: GeneratedFlank, frame: OffsetFrame, ratio: float, rho: float, z: float
) -> tuple[Array, Array]:
    """Slopes and second derivatives of the flank that is conjugate to the wheel's, in the frame of the pinion.

    Parameters
    ----------
    wheel : GeneratedFlank
    frame : OffsetFrame
        Of the wheel, without errors.
    ratio : float
        z1/z2.
    rho, z : float [mm]
        Place on the pinion.

    Returns
    -------
    (2,) array [rad/mm], (3,) array [rad/mm^2]
        By (rho, z), and by (rho rho, rho z, z z).

    Raises
    ------
    GeometryError
        If no turn brings the wheel into contact there.
    """
    azimuth = 0.0
    for _ in range(MOST_STEPS):
        slopes, bends = _off_the_wheel(wheel, frame, rho, azimuth, z)
        step = -(slopes[1] + ratio) / bends[1, 1]
        azimuth += step
        if abs(step) < RESOLVED:
            break
    else:
        raise GeometryError(f"{wheel.owner}: it is in contact nowhere at rho = {rho:.6g}, z = {z:.6g} mm of the pinion")
    envelope = (bends - np.outer(bends[1], bends[1]) / bends[1, 1]) / ratio
    return slopes[[0, 2]] / ratio, np.array([envelope[0, 0], envelope[0, 2], envelope[2, 2]])


def _off_the_wheel(
    wheel: GeneratedFlank, frame: OffsetFrame, rho: float, azimuth: float, z: float
) -> tuple[Array, Array]:
    """Gradient (3,) and second derivatives (3, 3) of Phi by (rho, alpha, z) of the pinion."""
    radial = np.array([cos(azimuth), sin(azimuth), 0.0])
    around, axial = np.array([-radial[1], radial[0], 0.0]), np.array([0.0, 0.0, 1.0])
    x, y, height = frame.axes @ (rho * radial + z * axial - frame.origin)
    radius = hypot(x, y)
    out, turned = np.array([x, y, 0.0]) / radius, np.array([-y, x, 0.0]) / radius
    theta = wheel.theta(np.array([radius]), np.array([height]))
    by_rho, by_z, (rho_rho, rho_z, z_z) = theta.rho[0], theta.z[0], (part[0] for part in theta.bends)
    gradient = turned / radius - by_rho * out - by_z * axial
    bends = np.outer(out, turned) * (-1.0 / radius**2) - rho_z * np.outer(out, axial)
    bends = bends + bends.T
    bends -= rho_rho * np.outer(out, out) + z_z * np.outer(axial, axial) + by_rho / radius * np.outer(turned, turned)
    gradient, bends = frame.axes.T @ gradient, frame.axes.T @ bends @ frame.axes
    ways = np.array([radial, rho * around, axial])
    curved = ways @ bends @ ways.T
    curved[0, 1] += around @ gradient
    curved[1, 0] += around @ gradient
    curved[1, 1] -= rho * radial @ gradient
    return ways @ gradient, curved
