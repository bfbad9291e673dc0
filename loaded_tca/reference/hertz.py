"""Hertz contact of elastic half-spaces: point contact of any ellipticity, and line contact."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

import loaded_tca.roots as roots
from loaded_tca.arguments import checked
from loaded_tca.errors import InputError, require_positive

# The greatest shear below a line contact lies where z/sqrt(a^2 + z^2) is the golden section.
_GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0


@checked
@dataclass(frozen=True)
class PointContact:
    """Elliptical Hertz contact; x runs across it (along the minor axis), y along it.

    Parameters
    ----------
    load : float [N]
        Normal load.
    contact_modulus : float [MPa]
        E*.
    semi_major, semi_minor : float [mm]
        Semi-axes of the contact ellipse.
    max_pressure : float [MPa]
        Pressure in the middle.
    approach : float [mm]
        Approach of points far from the contact.
    """

    load: float
    contact_modulus: float
    semi_major: float
    semi_minor: float
    max_pressure: float
    approach: float

    @property
    def ratio(self) -> float:
        """Semi-major over semi-minor axis, at least 1."""
        return self.semi_major / self.semi_minor

    @property
    def area(self) -> float:
        """Contact area [mm^2]."""
        return math.pi * self.semi_major * self.semi_minor

    @property
    def mean_pressure(self) -> float:
        """Load over contact area [MPa]."""
        return self.load / self.area

    @property
    def stiffness(self) -> float:
        """Tangent stiffness dF/d(approach) [N/mm]: the approach grows with the load to the power 2/3."""
        return 1.5 * self.load / self.approach

    def pressure(self, x: ArrayLike, y: ArrayLike) -> NDArray[np.float64]:
        """Pressure [MPa] at x across and y along the ellipse [mm], zero outside it."""
        across = np.asarray(x, dtype=np.float64) / self.semi_minor
        along = np.asarray(y, dtype=np.float64) / self.semi_major
        return self.max_pressure * np.sqrt(np.maximum(0.0, 1.0 - across**2 - along**2))

    def axis_stresses(self, depth: float, poisson_ratio: float = 0.3) -> tuple[float, float, float]:
        r"""Principal stresses on the axis below the middle of the contact.

        .. math::
            \sigma_x = \tfrac12 a b p_0 [2 (1-\nu) z I_x - 2 \nu z I_z - (1-2\nu) J_x],\qquad
            \sigma_z = -p_0 / \sqrt{(1 + z^2/a^2)(1 + z^2/b^2)}

        with I and J the integrals of 1/((b^2+w) D) and sqrt(w)/((b^2+w) D) over w from z^2 to infinity,
        D = sqrt((a^2+w)(b^2+w) w); they follow from Love's potentials and hold for equal axes too.

        Parameters
        ----------
        depth : float [mm]
            Distance z below the surface, positive.
        poisson_ratio : float
            Of the body looked at.

        Returns
        -------
        (float, float, float) [MPa]
            Across, along and normal to the surface; tension positive.

        References
        ----------
        Love 1929, Phil. Trans. R. Soc. A 228, 377-420 (potentials of a loaded half-space).
        """
        minor, major, normal = self.semi_minor**2 + depth**2, self.semi_major**2 + depth**2, depth**2
        integral_z = float(scipy.special.elliprd(minor, major, normal))
        scale = 0.5 * self.semi_major * self.semi_minor * self.max_pressure
        shape = math.sqrt(minor / major)

        def lateral(own: float, other: float, root: float) -> float:
            integral = float(scipy.special.elliprd(other, normal, own))
            bending = 4.0 / 3.0 * depth * ((1.0 - poisson_ratio) * integral - poisson_ratio * integral_z)
            return scale * (bending - (1.0 - 2.0 * poisson_ratio) * 2.0 / (own * (1.0 + root)))

        vertical = -self.max_pressure * self.semi_major * self.semi_minor / math.sqrt(minor * major)
        return lateral(minor, major, 1.0 / shape), lateral(major, minor, shape), vertical

    def subsurface_shear(self, poisson_ratio: float = 0.3) -> tuple[float, float]:
        """Greatest shear stress on the axis [MPa] and its depth [mm]."""

        def opposite(log_depth: float) -> float:
            stresses = self.axis_stresses(self.semi_minor * math.exp(log_depth), poisson_ratio)
            return 0.5 * (min(stresses) - max(stresses)) / self.max_pressure

        optimum = scipy.optimize.minimize_scalar(
            opposite, bounds=(-3.0, 1.0), method="bounded", options={"xatol": 1e-9}
        )
        return -float(optimum.fun) * self.max_pressure, self.semi_minor * math.exp(float(optimum.x))


@checked
@dataclass(frozen=True)
class LineContact:
    """Hertz contact of parallel cylinders.

    Parameters
    ----------
    line_load : float [N/mm]
        Load per length.
    contact_modulus : float [MPa]
        E*.
    half_width : float [mm]
        Half the width of the contact strip.
    max_pressure : float [MPa]
        Pressure in the middle of the strip.
    """

    line_load: float
    contact_modulus: float
    half_width: float
    max_pressure: float

    @property
    def mean_pressure(self) -> float:
        """Line load over width [MPa]."""
        return self.line_load / (2.0 * self.half_width)

    def pressure(self, x: ArrayLike) -> NDArray[np.float64]:
        """Pressure [MPa] at the distance x [mm] from the middle of the strip, zero outside it."""
        across = np.asarray(x, dtype=np.float64) / self.half_width
        return self.max_pressure * np.sqrt(np.maximum(0.0, 1.0 - across**2))

    def subsurface_shear(self) -> tuple[float, float]:
        r"""Greatest shear stress on the axis [MPa] and its depth [mm]: 0.300 p_0 at 0.786 a.

        .. math:: \tau = p_0 (z/a) (1 - z/\sqrt{a^2 + z^2})

        is greatest where 1 - 2 c + c^3 = 0, c = z/sqrt(a^2 + z^2): at the golden section c = (sqrt 5 - 1)/2.
        """
        return self.max_pressure * _GOLDEN**2.5, self.half_width * math.sqrt(_GOLDEN)


@checked
def point_contact(load: float, curvatures: tuple[float, float], contact_modulus: float) -> PointContact:
    r"""Elliptical Hertz contact of two elastic half-spaces.

    With q = b/a and Carlson's symmetric integrals

    .. math::
        \frac{k_b}{k_a} = \frac{R_D(0, 1, q^2)}{R_D(0, q^2, 1)},\quad
        a^3 = \frac{F R_D(0, q^2, 1)}{\pi E^* k_a},\quad
        p_0 = \frac{3 F}{2 \pi a b},\quad
        \delta = \frac{3 F R_F(0, q^2, 1)}{2 \pi E^* a}

    where k_a is the smaller curvature (along the major axis) and k_b the larger one. No form of these cancels,
    neither for equal curvatures nor for a slender ellipse.

    Parameters
    ----------
    load : float [N]
        Normal load, positive in compression.
    curvatures : (float, float) [1/mm]
        Principal relative curvatures in either order, both positive.
    contact_modulus : float [MPa]
        E*, 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2.

    Returns
    -------
    PointContact
        ``semi_major``, ``semi_minor`` [mm], ``max_pressure`` [MPa], ``approach`` [mm].

    Raises
    ------
    InputError
        If load, a curvature or the modulus is not positive and finite.

    References
    ----------
    Johnson 1985, Contact Mechanics, section 4.2; Carlson 1995, Numer. Algorithms 10, 13-26 (R_F, R_D).

    Examples
    --------
    >>> round(point_contact(100.0, (0.1, 0.1), 113187.0).max_pressure, 1)
    1353.4
    """
    small, large = sorted(float(k) for k in curvatures)
    require_positive(load=load, curvature_1=small, curvature_2=large, contact_modulus=contact_modulus)
    q = _axis_ratio(large / small)
    semi_major = (load * float(scipy.special.elliprd(0.0, q * q, 1.0)) / (math.pi * contact_modulus * small)) ** (
        1.0 / 3.0
    )
    approach = 1.5 * load * float(scipy.special.elliprf(0.0, q * q, 1.0)) / (math.pi * contact_modulus * semi_major)
    max_pressure = 1.5 * load / (math.pi * semi_major * semi_major * q)
    return PointContact(load, contact_modulus, semi_major, q * semi_major, max_pressure, approach)


@checked
def point_contact_gap(
    radii: tuple[float, float], size: tuple[float, float], cells: tuple[int, int]
) -> tuple[NDArray[np.float64], tuple[float, float]]:
    """Gap of two surfaces that touch in the middle of a grid, as :func:`loaded_tca.solve_contact` takes it.

    Parameters
    ----------
    radii : (float, float) [mm]
        Relative principal radii along the two axes, 1/R = 1/R1 + 1/R2; infinite: straight.
    size : (float, float) [mm]
        Lengths of the grid; it needs some room around the contact, 1.3 times its axes for instance.
    cells : (int, int)

    Returns
    -------
    gap : (nx, ny) array [mm]
        x^2/(2 Rx) + y^2/(2 Ry) in the middles of the cells.
    spacing : (float, float) [mm]
        Lengths of a cell.

    Raises
    ------
    InputError
        If a radius or length is not positive, or there is no cell along an axis.

    Examples
    --------
    Hertz beside the solver:

    >>> from loaded_tca import solve_contact
    >>> point = point_contact(100.0, (1 / 10.0, 1 / 40.0), 115385.0)
    >>> size = 2.6 * point.semi_minor, 2.6 * point.semi_major
    >>> gap, spacing = point_contact_gap((10.0, 40.0), size, (64, 64))
    >>> solution = solve_contact(gap, spacing, 115385.0, load=100.0)
    >>> round(solution.peak_pressure / point.max_pressure, 3), round(solution.approach / point.approach, 3)
    (1.0, 1.0)
    """
    problems = [f"cells: found {count!r}; allowed whole numbers from 1 on" for count in cells if not count >= 1]
    if problems:
        raise InputError(problems)
    straight = [math.isinf(radius) and radius > 0.0 for radius in radii]
    require_positive(
        **{f"radii[{k}]": radius for k, radius in enumerate(radii) if not straight[k]},
        **{f"size[{k}]": length for k, length in enumerate(size)},
    )
    spacing = size[0] / cells[0], size[1] / cells[1]
    x, y = ((np.arange(count) - 0.5 * (count - 1)) * step for count, step in zip(cells, spacing, strict=True))
    return x[:, None] ** 2 / (2.0 * radii[0]) + y**2 / (2.0 * radii[1]), spacing


@checked
def line_contact(line_load: float, curvature: float, contact_modulus: float) -> LineContact:
    r"""Hertz contact of parallel cylinders.

    .. math:: a^2 = \frac{4 F'}{\pi E^* k},\qquad p_0 = \frac{2 F'}{\pi a}

    Parameters
    ----------
    line_load : float [N/mm]
        Load per length F', positive in compression.
    curvature : float [1/mm]
        Relative curvature k across the line, positive.
    contact_modulus : float [MPa]
        E*.

    Returns
    -------
    LineContact
        ``half_width`` [mm], ``max_pressure`` [MPa].

    Raises
    ------
    InputError
        If an argument is not positive and finite.

    References
    ----------
    Johnson 1985, Contact Mechanics, section 4.2(c).

    Examples
    --------
    Roller of 20 mm diameter and length on a plate, 40 kN, steel of 210 GPa:

    >>> round(line_contact(2000.0, 0.1, 210000.0 / (2 * 0.91)).max_pressure, 2)
    2710.28
    """
    require_positive(line_load=line_load, curvature=curvature, contact_modulus=contact_modulus)
    half_width = math.sqrt(4.0 * line_load / (math.pi * contact_modulus * curvature))
    return LineContact(line_load, contact_modulus, half_width, 2.0 * line_load / (math.pi * half_width))


@lru_cache(maxsize=4096)  # a contact asks again under every load
def _axis_ratio(curvature_ratio: float) -> float:
    """Return b/a for a ratio of curvatures of at least 1."""
    logarithm = math.log(curvature_ratio)

    def excess(log_q: float) -> float:
        q2 = math.exp(2.0 * log_q)
        return (
            math.log(float(scipy.special.elliprd(0.0, 1.0, q2)) / float(scipy.special.elliprd(0.0, q2, 1.0)))
            - logarithm
        )

    # The ratio of curvatures is never below a/b, so -log(ratio) bounds log(b/a) from below.
    lower = -logarithm - 1e-6
    return math.exp(roots.find_root(excess, lower, 0.0)) if logarithm > 0.0 else 1.0
