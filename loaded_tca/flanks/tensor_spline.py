r"""Tensor B-splines: fitted to values on a structured grid, evaluated with first and second derivatives.

.. math:: S(u, v) = \sum_{ij} c_{ij}\, N_i(u)\, N_j(v)

For evaluation the spline is kept as one polynomial per cell of its breaks, found once; a point then costs one look-up
and two nested Horner schemes for the value and all five derivatives. Beyond its rectangle a spline goes on as the
second-order Taylor polynomial of its edge in each direction: twice continuously differentiable, and tame.

References
----------
de Boor 2001, A Practical Guide to Splines, chapters IX (piecewise polynomials), XIV (least squares) and XVII (tensor
products); Bjoerck 1996, Numerical Methods for Least Squares Problems, section 7.4 (conjugate gradients).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from loaded_tca.arrays import Array, Indices
from loaded_tca.bsplines import basis, derivative, design_matrix, not_a_knot
from loaded_tca.flanks.base import Bends, Jet

POINTS_AT_ONCE = 4096
"""Points evaluated together: their coefficients take 1.2 MB."""
MOST_ROUNDS = 2
MOST_ITERATIONS = 300
"""Rounds of refinement, and steps of each, of a fit to points off the grid lines; points on them take one step."""
SETTLED = 1e-12
"""What is left of a residual, or of its slope over it, at which a round ends: rounding is 1e-15."""


class SplineDerivatives(NamedTuple):
    """Value and derivatives of S(u, v), arrays of one shape."""

    value: Array
    u: Array
    v: Array
    u_u: Array
    u_v: Array
    v_v: Array

    def compose(self, u: Jet, v: Jet) -> Jet:
        """S(u(rho, z), v(rho, z)), with these the derivatives of S there (chain rule)."""

        def bends() -> Bends:
            across = [_sum((self.u_u, part_u), (self.u_v, part_v)) for part_u, part_v in ((u.rho, v.rho), (u.z, v.z))]
            along = [_sum((self.u_v, part_u), (self.v_v, part_v)) for part_u, part_v in ((u.rho, v.rho), (u.z, v.z))]
            return (
                _sum((across[0], u.rho), (along[0], v.rho), (self.u, u.rho_rho), (self.v, v.rho_rho)),
                _sum((across[0], u.z), (along[0], v.z), (self.u, u.rho_z), (self.v, v.rho_z)),
                _sum((across[1], u.z), (along[1], v.z), (self.u, u.z_z), (self.v, v.z_z)),
            )

        slopes = _sum((self.u, u.rho), (self.v, v.rho)), _sum((self.u, u.z), (self.v, v.z))
        return Jet(self.value, *slopes, bends)


def _sum(*products: tuple[Any, Any]) -> Any:
    """Sum of products; a factor that is the number zero costs nothing."""
    total: Any = 0.0
    for first, second in products:
        if (np.ndim(first) or first) and (np.ndim(second) or second):
            total = total + first * second
    return total


class TensorSpline:
    """A tensor B-spline, ready to be evaluated.

    Parameters
    ----------
    knots : ((k,) array, (l,) array)
        In u and v, each with degree + 1 equal knots at both ends.
    coefficients : (k - degree - 1, l - degree - 1) array
    degrees : (int, int)
        At least 2: the second derivative has to exist.
    """

    def __init__(self, knots: tuple[Array, Array], coefficients: Array, degrees: tuple[int, int]) -> None:
        self.knots, self.coefficients, self.degrees = knots, coefficients, degrees
        by_u, breaks_u = _pieces(knots[0], coefficients, degrees[0])
        by_v, breaks_v = _pieces(knots[1], np.moveaxis(by_u, 2, 0), degrees[1])
        self._breaks = (breaks_u, breaks_v)
        self._origins = tuple(np.concatenate([breaks[:1], breaks]) for breaks in self._breaks)
        # (degree + 1 of v, degree + 1 of u, cells): a run of memory for each power, as Horner's scheme reads it
        powers_v, cells_v, powers_u, cells_u = by_v.shape
        self._cells_v = cells_v
        self._table = np.ascontiguousarray(by_v.transpose(0, 2, 3, 1)).reshape(powers_v, powers_u, cells_u * cells_v)

    @property
    def domain(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """The rectangle ((u_0, u_1), (v_0, v_1)) beyond which the spline is continued."""
        first, second = ((float(breaks[0]), float(breaks[-1])) for breaks in self._breaks)
        return first, second

    def __call__(self, u: Array, v: Array) -> SplineDerivatives:
        """Value and derivatives at (u, v), arrays that broadcast against each other."""
        u, v = np.broadcast_arrays(u, v)
        flat_u, flat_v = u.ravel(), v.ravel()
        parts = np.empty((len(SplineDerivatives._fields), flat_u.size))
        for start in range(0, flat_u.size, POINTS_AT_ONCE):
            block = slice(start, start + POINTS_AT_ONCE)
            cell_u = np.searchsorted(self._breaks[0], flat_u[block], side="right")
            cell_v = np.searchsorted(self._breaks[1], flat_v[block], side="right")
            x, y = flat_u[block] - self._origins[0][cell_u], flat_v[block] - self._origins[1][cell_v]
            rows = polynomial(np.take(self._table, cell_u * self._cells_v + cell_v, axis=2), y, 2)
            out = parts[:, block]
            out[0], out[1], out[3] = polynomial(rows[0], x, 2)
            out[2], out[4] = polynomial(rows[1], x, 1)
            (out[5],) = polynomial(rows[2], x, 0)
        return SplineDerivatives(*parts.reshape(len(parts), *u.shape))

    def shifted(self, amount: float) -> TensorSpline:
        """The same spline with a constant added: the basis functions sum to one."""
        return TensorSpline(self.knots, self.coefficients + amount, self.degrees)


def polynomial(coefficients: Sequence[Any] | Array, x: Array, derivatives: int) -> list[Array]:
    """Sum of coefficients[k] x^k and its derivatives up to the second, by synthetic division.

    The last coefficient has the shape of x, and is overwritten.
    """
    parts = [coefficients[-1]]
    for coefficient in coefficients[-2::-1]:
        if len(parts) <= derivatives:
            parts.append(np.zeros_like(parts[0]))
        for order in range(len(parts) - 1, 0, -1):
            parts[order] *= x
            parts[order] += parts[order - 1]
        parts[0] *= x
        parts[0] += coefficient
    if derivatives == 2:
        parts[2] *= 2.0
    return parts


def _pieces(knots: Array, coefficients: Array, degree: int) -> tuple[Array, Array]:
    """Local coefficients (powers upwards, pieces, ...) along the first axis, and the breaks between the pieces.

    The first and the last piece are the continuations, of degree two, about the first and the last break.
    """
    breaks, local = knots[degree : len(knots) - degree], []
    for order in range(degree + 1):
        values = design_matrix(knots, degree - order, breaks)
        local.append(np.tensordot(values, coefficients, 1) / math.factorial(order))
        if order < degree:
            knots, coefficients = derivative(knots, coefficients, degree - order)
    table = np.stack(local)
    before, after = table[:, :1].copy(), table[:, -1:].copy()
    before[3:] = after[3:] = 0.0
    return np.concatenate([before, table[:, :-1], after], axis=1), breaks


def fit(
    u: Array, v: Array, values: Array, degrees: tuple[int, int], coefficients: tuple[int, int] | None = None
) -> TensorSpline:
    """Tensor B-spline of least squares through values on a structured grid; points need not lie on its lines exactly.

    The knots follow the means of the lines (not-a-knot). Where all points lie on lines of constant u and v the
    problem separates; the factors of the separated problem precondition the real one, so that a fit takes one step on
    lines and a few beside them.

    Parameters
    ----------
    u, v : (n, m) array
        u grows along the first axis, v along the second.
    values : (n, m) array
    degrees : (int, int)
        In u and v; below the numbers of coefficients.
    coefficients : (int, int), optional
        Numbers of coefficients, at most (n, m). Default: as many as points, and the spline passes through them.

    Returns
    -------
    TensorSpline

    Examples
    --------
    >>> u, v = np.meshgrid(np.linspace(0.0, 1.0, 7), np.linspace(0.0, 2.0, 9), indexing="ij")
    >>> spline = fit(u, v, u**2 * v, (3, 3))
    >>> jet = spline(np.array(0.3), np.array(1.7))
    >>> [round(float(part), 9) for part in (jet.value, jet.u_u, jet.u_v)]
    [0.153, 3.4, 0.6]
    """
    counts = u.shape if coefficients is None else coefficients
    first, second = (
        _Direction.along(lines, at, count, degree)
        for lines, at, count, degree in zip((u, v.T), (u, v), counts, degrees, strict=True)
    )
    return TensorSpline((first.knots, second.knots), _least_squares(first, second, values.ravel()), degrees)


@dataclass(frozen=True, eq=False)
class _Direction:
    """Knots of one direction, its basis at every point, and 1/R of its problem on the lines.

    The basis is the number (points,) of the first B-spline, and the values (points, degree + 1) of those from it on.
    """

    knots: Array
    basis: tuple[Indices, Array]
    inverse: Array

    @classmethod
    def along(cls, lines: Array, at: Array, count: int, degree: int) -> _Direction:
        """For coordinates ``at`` (n, m), which are nearly the same along each of their ``lines``.

        The not-a-knot knots of ``count`` coefficients are spread as the means of the lines are, but for the first and
        the last, which reach to the outermost points.
        """
        positions = lines.mean(axis=1)
        positions[0], positions[-1] = lines.min(), lines.max()
        places = np.interp(np.linspace(0.0, len(positions) - 1.0, count), np.arange(len(positions)), positions)
        knots = not_a_knot(places, degree)
        triangle = np.linalg.qr(design_matrix(knots, degree, positions), mode="r")
        return cls(knots, basis(knots, degree, at.ravel()), np.linalg.inv(triangle))


def _least_squares(first: _Direction, second: _Direction, values: Array) -> Array:
    """Coefficients (k, l) whose rows are basis_u x basis_v, by conjugate gradients preconditioned by R_u x R_v."""
    shape = (len(first.inverse), len(second.inverse))
    places, weights = _row_products(first.basis, second.basis, shape[1])

    def relaxed(raw: Array) -> Array:
        return first.inverse @ raw @ second.inverse.T

    def spline(coefficients: Array) -> Array:
        return np.einsum("nk,nk->n", weights, coefficients.ravel()[places])

    def slope(residual: Array) -> Array:
        """Derivative of half the sum of squares by the raw coefficients."""
        parts = np.bincount(places.ravel(), (weights * residual[:, None]).ravel(), math.prod(shape))
        return first.inverse.T @ parts.reshape(shape) @ second.inverse

    coefficients, rest = np.zeros(shape), values
    for _ in range(MOST_ROUNDS):
        raw, residual, least = np.zeros(shape), rest, SETTLED * float(np.linalg.norm(rest))
        down = way = slope(residual)
        for _ in range(MOST_ITERATIONS):
            square, across = float((down * down).sum()), spline(relaxed(way))
            length = float(np.linalg.norm(residual))
            if length <= least or square <= (SETTLED * length) ** 2:
                break
            share = square / float(across @ across)
            raw, residual = raw + share * way, residual - share * across
            down = slope(residual)
            way = down + float((down * down).sum()) / square * way
        coefficients = coefficients + relaxed(raw)
        rest = values - spline(coefficients)
    return coefficients


def _row_products(first: tuple[Indices, Array], second: tuple[Indices, Array], columns: int) -> tuple[Indices, Array]:
    """Kronecker products of the rows of two bases: places (points, m) of their entries, and the entries."""
    (from_u, in_u), (from_v, in_v) = first, second
    along, across = np.arange(in_u.shape[1])[:, None], np.arange(in_v.shape[1])
    places = (from_u[:, None, None] + along) * columns + from_v[:, None, None] + across
    return places.reshape(len(places), -1), (in_u[:, :, None] * in_v[:, None, :]).reshape(len(places), -1)
