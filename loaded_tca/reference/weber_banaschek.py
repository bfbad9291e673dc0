"""Deflection of one tooth in closed form: a cantilever of the tooth's shape on an elastic half-plane.

All values are per line load, mm per N/mm, strain being plane; deflections are counted along the force. Neither the rim
nor the bore is known here: a gear on a shaft is softer.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arguments import checked
from loaded_tca.errors import InputError, require
from loaded_tca.material import Material
from loaded_tca.plain import plain

SHEAR_FACTOR = 1.2
"""Shear energy of a rectangular section over that of even shear."""


@dataclass(frozen=True)
class ToothDeflection:
    """Deflection per line load [mm per N/mm].

    Attributes
    ----------
    bending : float
        Bending, shear and compression of the tooth.
    foundation : float
        Tilt and shift of its root in the body.
    """

    bending: float
    foundation: float

    @property
    def total(self) -> float:
        """Both together, where the force cuts the middle of the tooth."""
        return self.bending + self.foundation


@checked
def tooth_deflection(
    height: NDArray[np.float64],
    thickness: NDArray[np.float64],
    load_height: float,
    load_angle: float,
    material: Material = Material(),
) -> ToothDeflection:
    r"""Deflection of a tooth, where the line of the force cuts its middle.

    .. math::
        \frac{\delta_Z E b}{F} &= (1 - \nu^2) \cos^2\alpha' \left[12 \int_0^{y_p} \frac{(y_p - y)^2}{s^3}\,dy
        + \left(\frac{2.4}{1 - \nu} + \tan^2\alpha'\right) \int_0^{y_p} \frac{dy}{s}\right] \\
        \frac{\delta_K E b}{F} &= (1 - \nu^2) \cos^2\alpha' \left[\frac{18}{\pi} \frac{y_p^2}{s_f^2}
        + \frac{2 (1 - 2\nu)}{1 - \nu} \frac{y_p}{s_f}
        + \frac{4.8}{\pi} \left(1 + \frac{1 - \nu}{2.4} \tan^2\alpha'\right)\right]

    Parameters
    ----------
    height : (n,) array [mm]
        y along the middle of the tooth, increasing from 0 at the root section.
    thickness : (n,) array [mm]
        s(y) of the tooth, positive; the first one is s_f.
    load_height : float [mm]
        y_p, where the line of the force cuts the middle.
    load_angle : float [rad]
        alpha', between the force and the normal to the middle.
    material : Material

    Raises
    ------
    InputError
        If heights do not increase from 0 beyond the load, a thickness is not positive, or the angle not below 90 deg.

    References
    ----------
    Weber, Banaschek 1953, Formänderung und Profilrücknahme bei gerad- und schrägverzahnten Rädern, Vieweg.

    Examples
    --------
    A long prism bends as Euler's cantilever does, with the modulus of plane strain:

    >>> beam = tooth_deflection(np.array([0.0, 100.0]), np.array([1.0, 1.0]), 100.0, 0.0)
    >>> round(beam.bending / (4.0 * 100.0**3 * (1 - 0.3**2) / 206000.0), 3)
    1.0
    """
    y, s = np.asarray(height, dtype=float), np.asarray(thickness, dtype=float)
    increases = y.shape == s.shape and y.ndim == 1 and len(y) > 1 and y[0] == 0.0 and bool((np.diff(y) > 0.0).all())
    end = float(y[-1]) if increases else math.inf
    require(
        (increases, "height: increasing heights from 0 on are needed, as many as there are thicknesses"),
        (0.0 < load_height <= end, f"load_height: {plain(load_height, 6)} mm is not between 0 and {plain(end, 6)} mm"),
        (bool((np.isfinite(s) & (s > 0.0)).all()), "thickness: not all are positive and finite"),
        (abs(load_angle) < 0.5 * math.pi, f"load_angle: {plain(load_angle, 6)} rad is not below 90 deg"),
    )
    nu, root = material.poisson_ratio, float(s[0])
    scale = math.cos(load_angle) ** 2 / material.plane_strain_modulus
    steep = math.tan(load_angle) ** 2
    places, weights = _gauss(y[y < load_height], load_height)
    across = np.interp(places, y, s)
    lever = float(weights @ ((load_height - places) ** 2 / across**3))
    slenderness = float(weights @ (1.0 / across))
    bending = 12.0 * lever + (2.0 * SHEAR_FACTOR / (1.0 - nu) + steep) * slenderness
    ratio = load_height / root
    shift = 4.0 * SHEAR_FACTOR / math.pi * (1.0 + (1.0 - nu) / (2.0 * SHEAR_FACTOR) * steep)
    foundation = 18.0 / math.pi * ratio**2 + 2.0 * (1.0 - 2.0 * nu) / (1.0 - nu) * ratio + shift
    return ToothDeflection(scale * bending, scale * foundation)


@checked
def flank_flattening(half_width: float, depth: float, material: Material = Material()) -> float:
    r"""Approach of a flank's surface to the middle of its tooth, per line load, under Hertz's pressure.

    .. math:: \frac{\delta_H E b}{F} = \frac{1 - \nu^2}{\pi} \left(2 \ln\frac{2 t}{a} - \frac{\nu}{1 - \nu}\right)

    Parameters
    ----------
    half_width : float [mm]
        a of the line contact.
    depth : float [mm]
        t from the flank to the middle of the tooth, along the normal.
    material : Material

    Raises
    ------
    InputError
        If a length is not positive, or the contact as wide as the tooth is deep.

    References
    ----------
    Weber, Banaschek 1953; Johnson 1985, Contact Mechanics, eq. 5.57.

    Examples
    --------
    >>> round(1e6 * flank_flattening(0.2, 3.0), 2)  # um per N/um of line load
    8.96
    """
    if not 0.0 < half_width < depth < math.inf:
        raise InputError(f"half_width: {plain(half_width, 6)} mm is not between 0 and the depth, {plain(depth, 6)} mm")
    nu = material.poisson_ratio
    return (2.0 * math.log(2.0 * depth / half_width) - nu / (1.0 - nu)) / (math.pi * material.plane_strain_modulus)


@checked
def ring_torsion(inner_radius: float, outer_radius: float, material: Material = Material()) -> float:
    r"""Rotation of a ring's outside against its rigid inside, per torque and width [rad per N].

    .. math:: \frac{\varphi\,b}{T} = \frac{1}{4 \pi G} \left(\frac{1}{r_i^2} - \frac{1}{r_o^2}\right)

    Times the square of the base radius it is the displacement along the line of action per line load.

    Parameters
    ----------
    inner_radius, outer_radius : float [mm]
    material : Material

    Raises
    ------
    InputError
        If the radii are not positive and in this order.

    References
    ----------
    Timoshenko, Goodier 1970, Theory of Elasticity, 3rd ed., art. 43 (shear stress :math:`T/(2 \pi r^2)`).

    Examples
    --------
    >>> round(1e9 * ring_torsion(20.0, 35.0), 4)
    1.691
    """
    if not 0.0 < inner_radius <= outer_radius < math.inf:
        raise InputError(
            f"inner_radius: {plain(inner_radius, 6)} mm is not between 0 and {plain(outer_radius, 6)} mm, the outer one"
        )
    shear_modulus = 0.5 * material.youngs_modulus / (1.0 + material.poisson_ratio)
    return (inner_radius**-2 - outer_radius**-2) / (4.0 * math.pi * shear_modulus)


def _gauss(heights: NDArray[np.float64], end: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Places and weights of a Gauss rule on each piece between heights, up to ``end``."""
    ends = np.append(heights, end)
    local, share = np.polynomial.legendre.leggauss(4)
    half = 0.5 * np.diff(ends)[:, None]
    middle = 0.5 * (ends[1:] + ends[:-1])[:, None]
    return (middle + half * local).ravel(), (half * share).ravel()
