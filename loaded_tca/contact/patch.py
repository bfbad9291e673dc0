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


def peak_pressure(pressure: Array) -> float:
    """Largest pressure: the top of a quadratic through p^2 over p > p_max/2, or the largest cell where none fits."""
    largest = float(pressure.max())
    rows, columns = np.nonzero(pressure > 0.5 * largest)
    if rows.size < FEWEST:
        return largest
    x, y = _centred(rows), _centred(columns)
    square = (pressure[rows, columns] / largest) ** 2
    terms = np.column_stack((np.ones_like(x), x, y, 0.5 * x * x, x * y, 0.5 * y * y))
    fitted, _, rank, _ = np.linalg.lstsq(terms, square, rcond=None)
    misfit = float(np.sqrt(np.mean((terms @ fitted - square) ** 2)))
    hessian = np.array([[fitted[3], fitted[4]], [fitted[4], fitted[5]]])
    if rank < 6 or misfit > GOOD_FIT or np.linalg.eigvalsh(hessian)[1] >= 0.0:
        return largest
    top = -np.linalg.solve(hessian, fitted[1:3])
    if np.abs(top).max() > 1.0:
        return largest
    return largest * float(np.sqrt(fitted[0] + 0.5 * fitted[1:3] @ top))


def _centred(index: NDArray[np.intp]) -> Array:
    """Positions scaled to -1 ... 1."""
    low, high = int(index.min()), int(index.max())
    return np.asarray((2.0 * index - (low + high)) / max(1, high - low), dtype=np.float64)
