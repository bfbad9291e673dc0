r"""B-splines of one variable: those that are not zero at given places, knots through points, derivatives.

What SciPy has in ``scipy.interpolate``, for distinct inner knots; importing that takes longer than a scene's overview.

References
----------
de Boor 2001, A Practical Guide to Splines: chapter X, eqs. 12 to 16 (derivatives), and the programme BSPLVB.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arrays import Array


def not_a_knot(places: Array, degree: int) -> Array:
    """Knots (n + degree + 1,) of splines through values at increasing places (n,), more than the odd degree.

    Examples
    --------
    >>> not_a_knot(np.arange(6.0), 3).tolist()
    [0.0, 0.0, 0.0, 0.0, 2.0, 3.0, 5.0, 5.0, 5.0, 5.0]
    """
    skipped = (degree + 1) // 2
    ends = (np.full(degree + 1, end) for end in (places[0], places[-1]))
    return np.concatenate([next(ends), places[skipped : len(places) - skipped], next(ends)])


def basis(knots: Array, degree: int, at: Array) -> tuple[NDArray[np.int_], Array]:
    """Number (n,) of the first B-spline that is not zero at places (n,), and the values (n, degree + 1) from it on.

    At an inner knot those of the piece above it; beyond the ends the polynomials of the outermost pieces.

    Examples
    --------
    >>> first, values = basis(np.array([0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0]), 2, np.array([0.5, 1.5]))
    >>> first.tolist(), values.tolist()
    ([0, 1], [[0.25, 0.625, 0.125], [0.125, 0.625, 0.25]])
    """
    cell = np.clip(np.searchsorted(knots, at, side="right") - 1, degree, len(knots) - degree - 2)
    values = np.ones((degree + 1, len(at)))
    for order in range(1, degree + 1):
        carried = np.zeros(len(at))
        for part in range(order):
            above, below = knots[cell + part + 1] - at, at - knots[cell + part + 1 - order]
            share = values[part] / (above + below)
            values[part] = carried + above * share
            carried = below * share
        values[order] = carried
    return cell - degree, values.T


def design_matrix(knots: Array, degree: int, at: Array) -> Array:
    """Values (n, coefficients) of all B-splines at places (n,)."""
    first, values = basis(knots, degree, at)
    matrix = np.zeros((len(at), len(knots) - degree - 1))
    matrix[np.arange(len(at))[:, None], first[:, None] + np.arange(degree + 1)] = values
    return matrix


def derivative(knots: Array, coefficients: Array, degree: int) -> tuple[Array, Array]:
    """Knots and coefficients (n - 1, ...) of the derivative, of a degree less, of a spline of coefficients (n, ...)."""
    length = knots[degree + 1 : -1] - knots[1 : -degree - 1]
    return knots[1:-1], np.diff(coefficients, axis=0) * (degree / length).reshape(-1, *[1] * (coefficients.ndim - 1))
