"""Direct solution of stiffness equations by nested dissection.

The elements are halved again and again; inside each half all that no other element touches is eliminated, densely, so
that nearly all the work is products of matrices. It is the multifrontal method, with the halves found from the whole
coordinates of the logical mesh; a general sparse factorisation takes several times as long on gear bodies.

References
----------
George 1973, Nested dissection of a regular finite element mesh, SIAM J. Numer. Anal. 10, 345-363; Duff, Reid 1983, The
multifrontal solution of indefinite sparse symmetric linear equations, ACM Trans. Math. Softw. 9, 302-325.
"""

from __future__ import annotations

from contextlib import AbstractContextManager
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cholesky, solve_triangular
from threadpoolctl import threadpool_limits

from loaded_tca.errors import GeometryError
from loaded_tca.flanks.jet import Array

Indices = NDArray[np.int_]
LEAF = 8
"""Elements that are not halved any more."""


@dataclass(frozen=True, eq=False)
class _Front:
    """What one elimination leaves: unknowns eliminated and unknowns beside them, L11 and L21 of the Cholesky factor."""

    inside: Indices
    beside: Indices
    factor: Array
    coupling: Array


@dataclass(frozen=True, eq=False)
class Factorisation:
    """Cholesky factor of a stiffness matrix."""

    fronts: tuple[_Front, ...]
    size: int

    def solve(self, loads: Array) -> Array:
        """Displacements (size, m) under loads (size, m); zero where they are prescribed."""
        found = loads.copy()
        with _one_thread():
            self._down(found)
            self._up(found)
        return found

    def _down(self, found: Array) -> None:
        """Forward substitution, in place."""
        for front in self.fronts:
            part = solve_triangular(front.factor, found[front.inside], lower=True, check_finite=False)
            found[front.inside] = part
            found[front.beside] -= front.coupling @ part

    def _up(self, found: Array) -> None:
        """Backward substitution, in place."""
        held = np.ones(self.size, dtype=bool)
        for front in self.fronts[::-1]:
            held[front.inside] = False
            part = found[front.inside] - front.coupling.T @ found[front.beside]
            found[front.inside] = solve_triangular(front.factor, part, lower=True, trans=1, check_finite=False)
        found[held] = 0.0


def factorise(matrices: Array, dofs: Indices, places: Indices, free: NDArray[np.bool_]) -> Factorisation:
    """Factorise the sum of element matrices.

    Parameters
    ----------
    matrices : (n, k, k) array
        Symmetric, positive semidefinite.
    dofs : (n, k) int array
        Unknowns of each element.
    places : (n, d) int array
        Where each element lies, in coordinates along which to halve.
    free : (size,) bool array
        Unknowns that are not held at zero.

    Raises
    ------
    GeometryError
        If the matrix is not positive definite: the body is not held.
    """
    touching = np.bincount(dofs.ravel(), minlength=len(free))
    work = _Elimination(matrices, dofs, places, free, touching, [])
    with _one_thread():
        work.eliminate(np.arange(len(dofs)))
    return Factorisation(tuple(work.fronts), len(free))


@dataclass(frozen=True, eq=False)
class _Elimination:
    """The elimination while it goes on."""

    matrices: Array
    dofs: Indices
    places: Indices
    free: NDArray[np.bool_]
    touching: Indices
    fronts: list[_Front]

    def eliminate(self, elements: Indices) -> tuple[Indices, Array]:
        """Eliminate what lies inside some elements; return the unknowns at their border and what is left for them."""
        parts = (
            [self._free_part(element) for element in elements]
            if len(elements) <= LEAF
            else [self.eliminate(half) for half in self._halves(elements)]
        )
        unknowns = np.unique(np.concatenate([part[0] for part in parts]))
        inner = self._is_inner(unknowns, elements)
        order = np.concatenate([unknowns[inner], unknowns[~inner]])
        matrix = _summed(order, parts, len(self.free))
        count = int(inner.sum())
        if not count:
            return order, matrix
        try:
            factor = cholesky(matrix[:count, :count], lower=True, check_finite=False)
        except np.linalg.LinAlgError:
            raise GeometryError("the gear body is not held, or its mesh is damaged: no positive stiffness") from None
        coupling = solve_triangular(factor, matrix[:count, count:], lower=True, check_finite=False).T
        self.fronts.append(_Front(order[:count], order[count:], factor, coupling))
        return order[count:], matrix[count:, count:] - coupling @ coupling.T

    def _free_part(self, element: int) -> tuple[Indices, Array]:
        """Unknowns of an element that are not held, and its matrix for them."""
        dofs = self.dofs[element]
        free = self.free[dofs]
        return dofs[free], self.matrices[element][np.ix_(free, free)]

    def _halves(self, elements: Indices) -> tuple[Indices, Indices]:
        """Both halves, cut across the direction with most elements."""
        places = self.places[elements]
        along = places[:, int(np.ptp(places, axis=0).argmax())]
        levels = np.unique(along)
        cut = levels[int(np.abs(np.searchsorted(np.sort(along), levels[1:]) - 0.5 * len(along)).argmin()) + 1]
        return elements[along < cut], elements[along >= cut]

    def _is_inner(self, unknowns: Indices, elements: Indices) -> NDArray[np.bool_]:
        """Whether no other element touches an unknown."""
        here = np.bincount(self.dofs[elements].ravel(), minlength=len(self.free))
        return np.asarray(here[unknowns] == self.touching[unknowns])


def _summed(order: Indices, parts: list[tuple[Indices, Array]], size: int) -> Array:
    """Dense sum of matrices in the order of the unknowns ``order``."""
    place = np.empty(size, dtype=int)
    place[order] = np.arange(len(order))
    total = np.zeros((len(order), len(order)))
    for unknowns, matrix in parts:
        rows = place[unknowns]
        total[rows[:, None], rows] += matrix
    return total


def _one_thread() -> AbstractContextManager[object]:
    """One thread for linear algebra: the fronts are small, and threads waiting for each other cost many times more."""
    limits: AbstractContextManager[object] = threadpool_limits(1, user_api="blas")
    return limits
