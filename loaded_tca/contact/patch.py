"""Peak, area and semi-axes of a contact, finer than its cells: all from the square of the pressure.

Across a smooth edge the pressure grows as the root of the distance to it; its square is smooth there, and under
an ellipse it is a quadratic.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# The fit is that of a quadratic if it leaves this part of the squared peak unexplained (root mean square);
# a peak of another shape is taken from its cell.
GOOD_FIT = 2e-3
# Twice as many cells as the quadratic has coefficients.
FEWEST = 12
# Rows and columns that enter the fit at most: more change its result by less than the solver's tolerance does.
SAMPLES = 48


def peak_pressure(pressure: Array) -> float:
    """Largest pressure: the top of a quadratic through p^2 over p > p_max/2, or the largest cell where none fits."""
    largest = float(pressure.max())
    square, x, y = _upper_part(pressure / largest)
    if square.size < FEWEST:
        return largest
    terms = np.stack((np.ones_like(x), x, y, 0.5 * x * x, x * y, 0.5 * y * y))
    products = terms @ terms.T
    if np.linalg.matrix_rank(products) < 6:
        return largest
    fitted = np.linalg.solve(products, terms @ square)
    misfit = float(np.sqrt(np.mean((fitted @ terms - square) ** 2)))
    hessian = np.array([[fitted[3], fitted[4]], [fitted[4], fitted[5]]])
    if misfit > GOOD_FIT or np.linalg.eigvalsh(hessian)[1] >= 0.0:
        return largest
    top = -np.linalg.solve(hessian, fitted[1:3])
    if np.abs(top).max() > 1.0:
        return largest
    return largest * float(np.sqrt(fitted[0] + 0.5 * fitted[1:3] @ top))


def _upper_part(pressure: Array) -> tuple[Array, Array, Array]:
    """Square of the pressures above a half, and their places, both axes scaled to -1 ... 1; thinned if many."""
    high = pressure > 0.5
    rows, columns = np.flatnonzero(high.any(axis=1)), np.flatnonzero(high.any(axis=0))
    rows, columns = (index[:: -(-index.size // SAMPLES)] for index in (rows, columns))
    part = pressure[np.ix_(rows, columns)]
    chosen = part > 0.5
    x, y = np.broadcast_arrays(_centred(rows)[:, None], _centred(columns)[None, :])
    return part[chosen] ** 2, x[chosen], y[chosen]


def _centred(index: NDArray[np.intp]) -> Array:
    """Positions scaled to -1 ... 1."""
    low, high = int(index[0]), int(index[-1])
    return np.asarray((2.0 * index - (low + high)) / max(1, high - low), dtype=np.float64)
