r"""Stresses below a pressure map: Love's rectangles, summed by transforms.

Every cell is a rectangle under uniform pressure, whose stresses are known in closed form; a depth is the convolution of
the pressures with those of one cell. The box of the transforms is doubled and the rest of it zero, so that no
pressure meets the image of another: the sum is exact for the pressures of the cells, at every depth, and there is no
period to choose.

References
----------
Love 1929, Phil. Trans. R. Soc. A 228, 377-420; Johnson 1985, Contact Mechanics, sections 3.2 and 3.6; Liu & Wang 2002,
J. Tribol. 124, 36-45 (the same by transforms).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy
from numpy.typing import ArrayLike

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array
from loaded_tca.contact import checks
from loaded_tca.contact.checks import memory_problem
from loaded_tca.contact.solution import ContactSolution
from loaded_tca.plain import plain

Kernel = Callable[[Array, Array, float, float], Array]

# Below this depth, in semi-minor axes, the greatest shear of every Hertz contact has been passed.
DEEPEST = 3.0
SQRT3 = math.sqrt(3.0)


@dataclass(frozen=True, eq=False)
class SubsurfaceStress:
    """Stresses of a half-space below a pressure map; tension positive.

    Parameters
    ----------
    depths : (nz,) array [mm]
        Distances below the surface.
    spacing : (float, float) [mm]
        Width of a cell; stresses are those below the centres of the cells.
    poisson_ratio : float
        Of the body looked at.
    sigma_x, sigma_y, sigma_z : (nz, nx, ny) array [MPa]
        Normal stresses along the two axes of the grid and along the normal.
    tau_xy, tau_xz, tau_yz : (nz, nx, ny) array [MPa]
        Shear stresses; z points into the body.
    """

    depths: Array
    spacing: tuple[float, float]
    poisson_ratio: float
    sigma_x: Array
    sigma_y: Array
    sigma_z: Array
    tau_xy: Array
    tau_xz: Array
    tau_yz: Array

    def __repr__(self) -> str:
        cells = "x".join(str(n) for n in self.sigma_z.shape)
        depth = self.depths[self.max_shear_at[0]]
        return (
            f"SubsurfaceStress({cells} points, greatest shear {plain(self.max_shear.max(), 6)} MPa at "
            f"{plain(depth)} mm)"
        )

    @cached_property
    def von_mises(self) -> Array:
        """Equivalent stress after von Mises, (nz, nx, ny) array [MPa]."""
        return np.asarray(SQRT3 * np.sqrt(self._second_invariant))

    @cached_property
    def max_shear(self) -> Array:
        r"""Greatest shear stress, half the difference of the outer principal stresses, (nz, nx, ny) array [MPa].

        .. math:: \tau_{max} = \sqrt{J_2} \sin(\theta + \pi/3),\qquad
            \cos 3 \theta = \frac{3 \sqrt 3}{2} \frac{J_3}{J_2^{3/2}},\quad 0 \le \theta \le \pi/3
        """
        second, mean = self._second_invariant, (self.sigma_x + self.sigma_y + self.sigma_z) / 3.0
        x, y, z = self.sigma_x - mean, self.sigma_y - mean, self.sigma_z - mean
        third = x * (y * z - self.tau_yz**2) - self.tau_xy * (self.tau_xy * z - self.tau_yz * self.tau_xz)
        third += self.tau_xz * (self.tau_xy * self.tau_yz - y * self.tau_xz)
        cubed = second * np.sqrt(second)
        ratio = np.divide(1.5 * SQRT3 * third, cubed, out=np.zeros_like(cubed), where=cubed > 0.0)
        angle = np.arccos(np.clip(ratio, -1.0, 1.0)) / 3.0
        return np.asarray(np.sqrt(second) * np.sin(angle + math.pi / 3.0))

    @property
    def max_shear_at(self) -> tuple[int, int, int]:
        """Indices (depth, x, y) of the largest value of ``max_shear``."""
        return _place_of_largest(self.max_shear)

    @property
    def von_mises_at(self) -> tuple[int, int, int]:
        """Indices (depth, x, y) of the largest value of ``von_mises``."""
        return _place_of_largest(self.von_mises)

    @cached_property
    def _second_invariant(self) -> Array:
        """J2 of the stress deviator."""
        normal = (self.sigma_x - self.sigma_y) ** 2 + (self.sigma_y - self.sigma_z) ** 2
        normal += (self.sigma_z - self.sigma_x) ** 2
        return np.asarray(normal / 6.0 + self.tau_xy**2 + self.tau_xz**2 + self.tau_yz**2)


@checked
def subsurface_stress(
    pressure: ArrayLike, spacing: tuple[float, float], depths: ArrayLike, poisson_ratio: float = 0.3
) -> SubsurfaceStress:
    r"""Stresses of an elastic half-space below the cells of a pressure map, without friction.

    With the potentials of a loaded surface, :math:`\chi = \iint p \ln(R + z)` and :math:`V = \iint p / R`,

    .. math::
        2\pi\sigma_x = 2\nu V_z - z V_{xx} - (1 - 2\nu)\chi_{xx},\quad 2\pi\sigma_z = V_z - z V_{zz},\quad
        2\pi\tau_{xy} = -z V_{xy} - (1 - 2\nu)\chi_{xy},\quad 2\pi\tau_{xz} = -z V_{xz}

    and the same with y in place of x. Exact for pressures that are uniform on a cell; only those within about a cell of
    the surface feel that the true pressure is not.

    Parameters
    ----------
    pressure : (nx, ny) array_like [MPa]
        Pressure on the cells, such as ``solution.pressure``; positive in compression, none outside the grid.
    spacing : (float, float) [mm]
        Width of a cell.
    depths : (nz,) array_like [mm]
        Distances below the surface, not negative, in any order; see :func:`depths_below`.
    poisson_ratio : float
        Of the body looked at, between 0 and 0.5.

    Returns
    -------
    SubsurfaceStress
        The six stresses on (nz, nx, ny) points; from them ``von_mises``, ``max_shear`` and where they are greatest.

    Raises
    ------
    InputError
        With every problem of the arguments.

    References
    ----------
    Love 1929, Phil. Trans. R. Soc. A 228, 377-420.

    Examples
    --------
    Hertz, circle of radius 1 mm, 1000 MPa: greatest shear 310 MPa at 0.48 mm (Johnson 1985, section 4.2).

    >>> import numpy as np
    >>> x = (np.arange(41) - 20) * 0.06
    >>> pressure = 1000.0 * np.sqrt(np.maximum(0.0, 1.0 - x[:, None] ** 2 - x**2))
    >>> below = subsurface_stress(pressure, (0.06, 0.06), np.linspace(0.0, 1.5, 26), poisson_ratio=0.3)
    >>> depth = below.depths[below.max_shear_at[0]]
    >>> bool(abs(below.max_shear.max() - 310.0) < 2.0), round(float(depth), 2)
    (True, 0.48)
    """
    pressure, depths = np.asarray(pressure, dtype=np.float64), np.asarray(depths, dtype=np.float64)
    checks.raise_if(_problems(pressure, spacing, depths, poisson_ratio))
    dx, dy = float(spacing[0]), float(spacing[1])
    box = (
        scipy.fft.next_fast_len(2 * pressure.shape[0], real=True),
        scipy.fft.next_fast_len(2 * pressure.shape[1], real=True),
    )
    spectrum = scipy.fft.rfft2(pressure, s=box)
    stresses = np.empty((len(_KERNELS), len(depths), *pressure.shape))
    for level, depth in enumerate(depths):
        x, y = ((np.arange(n + 1) - 0.5) * width for n, width in zip(pressure.shape, (dx, dy), strict=True))
        for component, (kernel, parity) in enumerate(_KERNELS):
            corners = kernel(x[:, None], y[None, :], float(depth), poisson_ratio)
            cells = np.diff(np.diff(corners, axis=0), axis=1) / (2.0 * math.pi)
            product = scipy.fft.rfft2(_wrapped(cells, parity, box)) * spectrum
            stresses[component, level] = scipy.fft.irfft2(product, s=box)[: pressure.shape[0], : pressure.shape[1]]
    return SubsurfaceStress(depths, (dx, dy), poisson_ratio, *stresses)


@checked
def depths_below(solution: ContactSolution, count: int = 31) -> Array:
    """Depths from the surface to three semi-minor axes of a contact, closer near the surface.

    Parameters
    ----------
    solution : ContactSolution
        With a load: something has to be in contact.
    count : int
        Number of depths, at least 2.

    Returns
    -------
    (count,) array [mm]
        The first is 0; the steps grow linearly.

    Raises
    ------
    InputError
        If nothing is in contact, or for less than two depths.
    """
    problems = [] if count >= 2 else [f"count: {count} is less than 2"]
    if not solution.in_contact.any():
        problems.append("solution: no cell is in contact, so that depths have no half width to count in")
    checks.raise_if(problems)
    return graded_depths(solution.semi_axes[0], count)


def graded_depths(half_width: float, count: int) -> Array:
    """Depths (count,) from the surface to three half widths of a contact [mm], their steps growing linearly.

    Examples
    --------
    >>> graded_depths(0.1, 4).round(3)
    array([0.   , 0.067, 0.167, 0.3  ])
    """
    fraction = np.linspace(0.0, 1.0, count)
    return np.asarray(DEEPEST * half_width * 0.5 * (fraction + fraction**2))


def _problems(pressure: Array, spacing: tuple[float, float], depths: Array, poisson_ratio: float) -> list[str]:
    """Everything wrong with the arguments."""
    if pressure.ndim != 2 or 0 in pressure.shape:
        return [f"pressure: an array of shape {pressure.shape} is not a grid of cells (nx, ny)"]
    if depths.ndim != 1 or not depths.size:
        return [f"depths: an array of shape {depths.shape} is not a list of depths (nz,)"]
    if (memory := memory_problem((*pressure.shape, max(1, depths.size // 4)))) is not None:
        return [f"pressure, depths: {memory}"]
    problems = checks.check_spacing(spacing)
    if not np.isfinite(pressure).all():
        problems.append(f"pressure: {int((~np.isfinite(pressure)).sum())} cells are not finite")
    if not (np.isfinite(depths) & (depths >= 0.0)).all():
        problems.append("depths: hold negative or infinite values or NaN")
    if not 0.0 <= poisson_ratio <= 0.5:
        problems.append(f"poisson_ratio: {poisson_ratio} is not between 0 and 0.5")
    return problems


def _wrapped(quadrant: Array, parity: tuple[int, int], box: tuple[int, int]) -> Array:
    """A kernel known for distances not negative, placed in a periodic box by its parity along each axis."""
    rows, columns = quadrant.shape
    whole = np.zeros(box)
    whole[:rows, :columns] = quadrant
    whole[box[0] - rows + 1 :, :columns] = parity[0] * quadrant[:0:-1]
    whole[:, box[1] - columns + 1 :] = parity[1] * whole[:, columns - 1 : 0 : -1]
    return whole


def _place_of_largest(values: Array) -> tuple[int, int, int]:
    level, row, column = (int(index) for index in np.unravel_index(int(np.argmax(values)), values.shape))
    return level, row, column


def _root(x: Array, y: Array, z: float) -> Array:
    return np.asarray(np.sqrt(x * x + y * y + z * z))


def _sigma_x(x: Array, y: Array, z: float, nu: float) -> Array:
    """Integral of 2 pi sigma_x over a quarter-plane that ends at (x, y); its differences are those of a cell."""
    r = _root(x, y, z)
    potential = -2.0 * nu * np.arctan2(x * y, z * r) + z * x * y / ((x * x + z * z) * r)
    return np.asarray(potential - (1.0 - 2.0 * nu) * np.arctan2(x * y * (r - z), x * x * r + z * y * y))


def _sigma_z(x: Array, y: Array, z: float, _: float) -> Array:
    """Integral of 2 pi sigma_z; it does not depend on Poisson's ratio."""
    r = _root(x, y, z)
    inverse = 1.0 / (x * x + z * z) + 1.0 / (y * y + z * z)
    return np.asarray(-np.arctan2(x * y, z * r) - z * x * y * inverse / r)


def _tau_xy(x: Array, y: Array, z: float, nu: float) -> Array:
    """Integral of 2 pi tau_xy."""
    r = _root(x, y, z)
    return np.asarray(-z / r - (1.0 - 2.0 * nu) * np.log(r + z))


def _tau_xz(x: Array, y: Array, z: float, _: float) -> Array:
    """Integral of 2 pi tau_xz."""
    return np.asarray(z * z * y / ((x * x + z * z) * _root(x, y, z)))


_KERNELS: tuple[tuple[Kernel, tuple[int, int]], ...] = (
    (_sigma_x, (1, 1)),
    (lambda x, y, z, nu: _sigma_x(y, x, z, nu), (1, 1)),
    (_sigma_z, (1, 1)),
    (_tau_xy, (-1, -1)),
    (_tau_xz, (-1, 1)),
    (lambda x, y, z, nu: _tau_xz(y, x, z, nu), (1, -1)),
)
