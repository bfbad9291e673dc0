"""Direct solution of stiffness equations by nested dissection.

The elements are halved again and again; inside each half all that no other element touches is eliminated, densely, so
that nearly all the work is products of matrices. It is the multifrontal method, with the halves found from the whole
coordinates of the logical mesh; a general sparse factorisation takes several times as long on gear bodies. Parts that
are put together from the same elements in the same way, as the pitches of a rim are, are eliminated once.

References
----------
George 1973, Nested dissection of a regular finite element mesh, SIAM J. Numer. Anal. 10, 345-363; Duff, Reid 1983, The
multifrontal solution of indefinite sparse symmetric linear equations, ACM Trans. Math. Softw. 9, 302-325.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cholesky, solve_triangular
from scipy.sparse import csr_array

from loaded_tca.arrays import Array, Indices
from loaded_tca.errors import GeometryError
from loaded_tca.threads import one_blas_thread

Flags = NDArray[np.bool_]
LEAF = 8
"""Elements that are not halved any more."""


@dataclass(frozen=True, eq=False)
class _Front:
    """What one elimination leaves: unknowns eliminated and unknowns beside them, L11 and L21 of the Cholesky factor."""

    inside: Indices
    beside: Indices
    factor: Array
    coupling: Array

    def renumbered(self, number: Indices) -> _Front:
        """The same front with the unknown i called ``number[i]``."""
        return _Front(number[self.inside], number[self.beside], self.factor, self.coupling)


@dataclass(frozen=True, eq=False)
class Factorisation:
    """Cholesky factor of a stiffness matrix, front by front in the order of elimination."""

    fronts: tuple[_Front, ...]
    size: int

    def solve(self, loads: Array) -> Array:
        """Displacements (size, m) under loads (size, m); zero where they are prescribed."""
        found = np.zeros_like(loads)
        free = np.zeros(self.size, dtype=bool)
        for front in self.fronts:
            free[front.inside] = True
        found[free] = loads[free]
        _substitute(self.fronts, self.fronts, found)
        return found

    def flexibility(self, loads: csr_array, readings: csr_array) -> Array:
        """Values (p, m) of readings (p, size) of the displacements under loads (m, size), neither on a held unknown.

        Only fronts between a load or a reading and the end of the elimination are passed.
        """
        below, above = self._reached(loads), self._reached(readings)
        active = np.flatnonzero(below | above)
        place = np.full(self.size, -1)
        place[active] = np.arange(len(active))
        down = [front.renumbered(place) for front in self.fronts if below[front.inside].any()]
        up = [front.renumbered(place) for front in self.fronts if above[front.inside].any()]
        found = loads[:, active].T.toarray()
        _substitute(down, up, found)
        return np.asarray(readings[:, active] @ found)

    def _reached(self, rows: csr_array) -> Flags:
        """Unknowns (size,) that an elimination reaches from those in the rows of a sparse matrix."""
        reached = np.zeros(self.size, dtype=bool)
        reached[rows.indices] = True
        for front in self.fronts:
            if reached[front.inside].any():
                reached[front.inside] = reached[front.beside] = True
        return reached


def _substitute(down: Sequence[_Front], up: Sequence[_Front], found: Array) -> None:
    """Forward and backward substitution through fronts in the order of elimination, in place."""
    with one_blas_thread():  # the fronts are small: threads waiting for each other cost far more
        for front in down:
            part = solve_triangular(front.factor, found[front.inside], lower=True, check_finite=False)
            found[front.inside] = part
            found[front.beside] -= front.coupling @ part
        for front in reversed(up):
            part = found[front.inside] - front.coupling.T @ found[front.beside]
            found[front.inside] = solve_triangular(front.factor, part, lower=True, trans=1, check_finite=False)


def factorise(
    matrices: Array,
    dofs: Indices,
    places: Indices,
    free: Flags,
    *,
    kinds: Indices | None = None,
    blocks: Indices | None = None,
) -> Factorisation:
    """Factorise the sum of element matrices.

    Parameters
    ----------
    matrices : (q, k, k) array
        Symmetric, positive semidefinite.
    dofs : (n, k) int array
        Unknowns of each element.
    places : (n, d) int array
        Where each element lies, in coordinates along which to halve.
    free : (size,) bool array
        Unknowns that are not held at zero.
    kinds : (n,) int array, optional
        Which matrix each element has; default: its own, q = n.
    blocks : (n,) int array, optional
        Parts of the body, in a row, that are eliminated each by itself before they are put together; default: one.

    Raises
    ------
    GeometryError
        If the matrix is not positive definite: the body is not held.
    """
    n, size = len(dofs), len(free)
    kinds = np.arange(n) if kinds is None else kinds
    places = np.column_stack([np.zeros(n, dtype=int) if blocks is None else blocks, places])
    touching = np.bincount(dofs.ravel(), minlength=size)
    work = _Elimination(matrices, kinds, np.where(free[dofs], dofs, size), places, touching)
    with one_blas_thread():
        unknowns, whole = work.eliminate(np.arange(n))
    return Factorisation(tuple(front.renumbered(unknowns) for front in whole.fronts), size)


@dataclass(frozen=True, eq=False)
class _Part:
    """Some elements without what only they touch, in numbers of their own.

    ``matrix`` is what is left for the unknowns ``border``, with a last row and column of zeros.
    """

    fronts: list[_Front]
    border: Indices
    matrix: Array


@dataclass(frozen=True, eq=False)
class _Elimination:
    """The elimination while it goes on; held unknowns all have the number after the last one."""

    matrices: Array
    kinds: Indices
    dofs: Indices
    places: Indices
    touching: Indices
    known: dict[tuple[bytes, ...], _Part] = field(default_factory=dict)

    def eliminate(self, elements: Indices) -> tuple[Indices, _Part]:
        """Eliminate what lies inside some elements: their unknowns, and the part in numbers among these."""
        flat, held = self.dofs[elements].ravel(), len(self.touching)
        order, place = np.arange(len(flat)), np.empty(held + 1, dtype=int)
        place[flat[::-1]] = order[::-1]
        unknowns = flat[(place[flat] == order) & (flat != held)]  # in the order in which they first occur
        place[unknowns], place[held] = order[: len(unknowns)], len(unknowns)
        dofs = place[flat].reshape(len(elements), -1)
        count = np.bincount(dofs.ravel(), minlength=len(unknowns))[: len(unknowns)]
        inner = count == self.touching[unknowns]
        key = self.kinds[elements].tobytes(), dofs.tobytes(), inner.tobytes()
        if key not in self.known:
            self.known[key] = self._part(elements, unknowns, dofs, inner)
        return unknowns, self.known[key]

    def _part(self, elements: Indices, unknowns: Indices, dofs: Indices, inner: Flags) -> _Part:
        """Sum up the elements or both halves, and eliminate the unknowns that are told to be inside."""
        if len(elements) <= LEAF:
            order = np.concatenate([np.flatnonzero(inner), np.flatnonzero(~inner)])
            fronts, matrix = [], _assembled(dofs, self.matrices[self.kinds[elements]], order)
        else:
            place, halves = np.empty(len(self.touching), dtype=int), []
            place[unknowns] = np.arange(len(unknowns))
            for half in self._halves(elements):
                own, part = self.eliminate(half)
                fronts = [front.renumbered(place[own]) for front in part.fronts]
                halves.append(_Part(fronts, place[own][part.border], part.matrix))
            left = np.zeros(len(unknowns), dtype=bool)
            left[np.concatenate([half.border for half in halves])] = True
            order = np.concatenate([np.flatnonzero(inner & left), np.flatnonzero(~inner)])
            fronts, matrix = [front for half in halves for front in half.fronts], _sum(halves, order, len(unknowns))
        count = len(order) - int(np.count_nonzero(~inner))
        factor, coupling, rest = _eliminated(matrix, count)
        fronts.append(_Front(order[:count], order[count:], factor, coupling))
        return _Part(fronts, order[count:], rest)

    def _halves(self, elements: Indices) -> tuple[Indices, Indices]:
        """Both halves: of several blocks in a row, else cut across the direction with most elements."""
        places = self.places[elements]
        across = int(np.ptp(places[:, 1:], axis=0).argmax()) + 1 if np.ptp(places[:, 0]) == 0 else 0
        along = places[:, across]
        levels = np.unique(along)
        below = np.searchsorted(np.sort(along), levels[1:]) if across else np.arange(1, len(levels))
        cut = levels[int(np.abs(below - 0.5 * (len(along) if across else len(levels))).argmin()) + 1]
        return elements[along < cut], elements[along >= cut]


def _assembled(dofs: Indices, matrices: Array, order: Indices) -> Array:
    """Dense sum of element matrices in the order of the unknowns ``order``; numbers beyond them are held."""
    place = np.empty(len(order) + 1, dtype=int)
    place[np.append(order, len(order))] = np.arange(len(order) + 1)
    total = np.zeros((len(order) + 1, len(order) + 1))
    for rows, matrix in zip(place[dofs], matrices, strict=True):
        total[rows[:, None], rows] += matrix
    return total[:-1, :-1]


def _sum(parts: Sequence[_Part], order: Indices, size: int) -> Array:
    """Dense sum of what is left of parts, in the order of the unknowns ``order`` out of ``size``."""
    total = np.zeros((len(order), len(order)))
    for part in parts:
        where = np.full(size, len(part.border))
        where[part.border] = np.arange(len(part.border))
        total += part.matrix.take(where[order], axis=0).take(where[order], axis=1)
    return total


def _eliminated(matrix: Array, count: int) -> tuple[Array, Array, Array]:
    """Factor of the first ``count`` unknowns, their coupling with the others, and what is left for these."""
    if not count:
        return matrix[:0, :0], matrix[:, :0], np.pad(matrix, (0, 1))
    try:
        factor = cholesky(matrix[:count, :count], lower=True, check_finite=False)
    except np.linalg.LinAlgError:
        raise GeometryError("the gear body is not held, or its mesh is damaged: no positive stiffness") from None
    coupling = solve_triangular(factor, matrix[:count, count:], lower=True, check_finite=False).T
    rest = np.zeros((len(matrix) - count + 1,) * 2)
    np.subtract(matrix[count:, count:], coupling @ coupling.T, out=rest[:-1, :-1])
    return factor, coupling, rest
