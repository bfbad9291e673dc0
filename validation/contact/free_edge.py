"""The free edge: one image of the pressure against Hetenyi's solution of the quarter-space.

Mirrored pressures on two half-spaces at right angles leave no shear on each other's plane, and their normal stresses N
there are cancelled by more pressure: p_top - N N p_top = p. The side's own pressure moves no point of the top, since it
is mirrored in it. Both planes carry the same graded cells; the direction along the edge is done by transforms. The
normal stresses are written out here once more, apart from ``loaded_tca.contact.subsurface``.

Sources: Hetenyi 1960, J. Appl. Mech. 27, 289-296; Keer, Lee & Mura 1983, Int. J. Solids Struct. 19, 337-352.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, rfft

from loaded_tca.contact import quarter_space_factor
from validation.table import Row

Array = NDArray[np.float64]

POISSON_RATIO = 0.3
SOURCE = "quarter-space, Hetenyi 1960"
STEP, FARTHEST, GROWTH = 0.1, 20.0, 1.25
EVEN_CELLS, CELLS_ALONG = 26, 96


@dataclass(frozen=True)
class QuarterSpace:
    """Coefficients of a loaded quarter-space y >= 0, z >= 0, periodic along its edge; (n, n, nx) arrays.

    ``own`` and ``image`` are displacements (times E*) by pressure on a cell and on its image, ``across`` the
    compression of one plane by mirrored unit pressure on a cell of the other.
    """

    x: Array
    y: Array
    own: Array
    image: Array
    across: Array

    def exact(self) -> Array:
        """Exact coefficients (n, n, nx) of displacements (times E*) by pressure on cells of the top."""
        across, mirrored = (np.moveaxis(rfft(part), -1, 0) for part in (self.across, self.own + self.image))
        whole = mirrored @ np.linalg.inv(np.eye(len(self.y)) - across @ across)
        return np.asarray(irfft(np.moveaxis(whole, 0, -1), len(self.x)))

    def displacement(self, pressure: Array) -> Array:
        """Exact displacement (times E*) of the top by a pressure (n, nx) on it."""
        across = np.moveaxis(rfft(self.across), -1, 0)
        load = rfft(pressure).T[..., None]
        whole = np.linalg.solve(np.eye(len(self.y)) - across @ across, load)[..., 0]
        pressure = irfft(whole.T, len(self.x))
        return convolved(self.own, pressure) + convolved(self.image, pressure)


def graded() -> Array:
    """Bounds of cells that are even beside the edge and grow away from it."""
    bounds = [STEP * k for k in range(EVEN_CELLS + 1)]
    while bounds[-1] < FARTHEST:
        bounds.append(bounds[-1] + GROWTH * (bounds[-1] - bounds[-2]))
    return np.array(bounds)


def quarter_space(poisson_ratio: float, edges: Array, step: float = STEP) -> QuarterSpace:
    """Coefficients for cells with these bounds off the edge, and so long along it."""
    y = 0.5 * (edges[1:] + edges[:-1])
    k = np.arange(CELLS_ALONG)
    distance = np.minimum(k, CELLS_ALONG - k) * step
    near, far = distance - 0.5 * step, distance + 0.5 * step

    def love(sign: float) -> Array:
        v = y[:, None, None] - sign * edges[:, None]
        return np.asarray(-sign * np.diff(_displacement(far, v) - _displacement(near, v), axis=1) / np.pi)

    depth = y[:, None, None]
    stress = _side_stress(far, edges[:, None], depth, poisson_ratio)
    stress -= _side_stress(near, edges[:, None], depth, poisson_ratio)
    x = (k - CELLS_ALONG // 2) * step
    return QuarterSpace(x, y, love(1.0), love(-1.0), np.asarray(-np.diff(stress, axis=1) / np.pi))


def convolved(coefficients: Array, pressure: Array) -> Array:
    """Coefficients (n, n, nx) on a pressure (n, nx), periodic along the edge."""
    spectra = np.moveaxis(rfft(coefficients), -1, 0) @ rfft(pressure).T[..., None]
    return np.asarray(irfft(spectra[..., 0].T, pressure.shape[-1]))


def _displacement(x: Array, y: Array) -> Array:
    return np.asarray(x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y)))


def _side_stress(x: Array, y: Array, z: Array, nu: float) -> Array:
    """Love's 2 pi sigma_y of a quarter-plane of unit pressure; x along the edge, y across it, z down the side."""
    r = np.sqrt(x * x + y * y + z * z)
    normal = z * x * y / ((y * y + z * z) * r) - 2.0 * nu * np.arctan2(x * y, z * r)
    return np.asarray(normal - (1.0 - 2.0 * nu) * np.arctan(x * y * (r - z) / (y * y * r + z * x * x)))


def loads(space: QuarterSpace) -> dict[str, Array]:
    """Hertz circles of radius 1 cut by the edge, touching it, and half a radius off it; a strip that ends at it."""
    even = space.y[:, None] < EVEN_CELLS * STEP
    found = {
        f"circle centred {offset:g} a inside": even
        * np.sqrt(np.maximum(0.0, 1.0 - (space.y[:, None] - offset) ** 2 - space.x**2))
        for offset in (0.0, 1.0, 1.5)
    }
    found["strip 0.8 x 2.6 up to the edge"] = even * np.sqrt(np.maximum(0.0, 1.0 - (space.x / 0.4) ** 2))
    return found


def rows() -> list[Row]:
    """Displacement weighted with the pressure, over that of a half-space: with the factor, without, with no mirror."""
    table = []
    space, factor = quarter_space(POISSON_RATIO, graded()), quarter_space_factor(POISSON_RATIO)
    for name, pressure in loads(space).items():
        own, image = convolved(space.own, pressure), convolved(space.image, pressure)
        half_space = float((own * pressure).sum())
        exact = float((space.displacement(pressure) * pressure).sum()) / half_space
        mirror = float((image * pressure).sum()) / half_space
        case = f"free edge, {name}"
        table += [
            Row(case, SOURCE, f"displacement, factor {factor:.3f}", exact, 1.0 + factor * mirror, 2e-2),
            Row(case, SOURCE, "displacement, plain mirror", exact, 1.0 + mirror, None),
            Row(case, SOURCE, "displacement, half-space", exact, 1.0, None),
        ]
    return table
