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

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from loaded_tca.arrays import Array, Indices
from loaded_tca.contact.checks import machine_memory
from loaded_tca.errors import GeometryError, require
from loaded_tca.threads import one_blas_thread

Flags = NDArray[np.bool_]
LEAF = 8
"""Elements that are not halved any more."""
RESERVE = 1.25
"""Memory of an elimination over that of its matrices; measured: 1.1 to 1.2, of bodies of 0.05 to 0.7 GiB."""
BYTES_OF_LOADS = 2.0**27
"""Most memory of the displacements under loads that are passed through the fronts at a time."""
LEAST_PIVOT = 1e-10
"""Least pivot over the largest diagonal entry of its elimination at which a body counts as held.

The last pivot of a free body is zero but for rounding, which leaves either sign: at most 6e-14, measured on rings of up
to 3000 elements with four BLAS kernels. Bodies of gears that are held have 3e-5 and more.
"""


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

    @property
    def dtype(self) -> np.dtype[Any]:
        """Precision of the fronts."""
        return self.fronts[-1].factor.dtype

    def solve(self, loads: Array) -> Array:
        """Displacements (size, m) under loads (size, m); zero where they are prescribed."""
        displacements = np.zeros(loads.shape, self.dtype)
        free = np.zeros(self.size, dtype=bool)
        for front in self.fronts:
            free[front.inside] = True
        displacements[free] = loads[free]
        _substitute(self.fronts, self.fronts, displacements)
        return displacements

    def flexibility(self, loads: scipy.sparse.csr_array, readings: scipy.sparse.csr_array) -> Array:
        """Values (p, m) of readings (p, size) of the displacements under loads (m, size), neither on a held unknown.

        Only fronts between a load or a reading and the end of the elimination are passed.
        """
        above = self._reached(readings)
        active = np.flatnonzero(above | self._reached(loads))
        place = np.full(self.size, -1)
        place[active] = np.arange(len(active))
        up = [front.renumbered(place) for front in self.fronts if above[front.inside].any()]
        result = np.empty((readings.shape[0], loads.shape[0]))
        step = max(1, int(BYTES_OF_LOADS / (8.0 * max(1, len(active)))))
        for first in range(0, loads.shape[0], step):
            block = loads[first : first + step]
            below = self._reached(block)
            down = [front.renumbered(place) for front in self.fronts if below[front.inside].any()]
            values = block[:, active].T.toarray().astype(self.dtype, copy=False)
            _substitute(down, up, values)
            result[:, first : first + step] = readings[:, active] @ values
        return result

    def _reached(self, rows: scipy.sparse.csr_array) -> Flags:
        """Unknowns (size,) that an elimination reaches from those in the rows of a sparse matrix."""
        reached = np.zeros(self.size, dtype=bool)
        reached[rows.indices] = True
        for front in self.fronts:
            if reached[front.inside].any():
                reached[front.inside] = reached[front.beside] = True
        return reached


def _substitute(down: Sequence[_Front], up: Sequence[_Front], displacements: Array) -> None:
    """Forward and backward substitution through fronts in the order of elimination, in place."""
    with one_blas_thread():  # the fronts are small: threads waiting for each other cost far more
        for front in down:
            part = scipy.linalg.solve_triangular(
                front.factor, displacements[front.inside], lower=True, check_finite=False
            )
            displacements[front.inside] = part
            displacements[front.beside] -= front.coupling @ part
        for front in reversed(up):
            part = displacements[front.inside] - front.coupling.T @ displacements[front.beside]
            displacements[front.inside] = scipy.linalg.solve_triangular(
                front.factor, part, lower=True, trans=1, check_finite=False
            )


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
        Symmetric, positive semidefinite; the fronts are of their precision.
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
        If the matrix is not positive definite beyond rounding: the body is not held.
    InputError
        If the factor takes more memory than the machine has.
    """
    n, size = len(dofs), len(free)
    kinds = np.arange(n) if kinds is None else kinds
    places = np.column_stack([np.zeros(n, dtype=int) if blocks is None else blocks, places])
    plan = _Plan(kinds, np.where(free[dofs], dofs, size), places, np.bincount(dofs.ravel(), minlength=size))
    unknowns, last = plan.add(np.arange(n))
    needed, limit = plan.bytes + 8.0 * matrices.size, machine_memory()  # of single precision: it may be made again
    problem = f"{size} unknowns need {needed / 2**30:.3g} GiB, the machine has {limit / 2**30:.3g} GiB"
    require((needed <= limit, f"mesh of the gear body: {problem}; take fewer elements"))
    with one_blas_thread():
        factors = plan.factors(matrices)
    return Factorisation(tuple(plan.fronts(factors, last, unknowns)), size)


@dataclass(frozen=True, eq=False)
class _Step:
    """One elimination, in numbers of its own: of a few elements, or of what two earlier ones leave.

    Attributes
    ----------
    size : int
        Unknowns of its elements.
    order : (m,) int array
        Those that are left before it, first the ``count`` that it eliminates.
    elements : (n,) int array
    dofs : (n, k) int array
        Unknowns of each element; those that are held have the number ``size``.
    halves : tuple of (int, array)
        Numbers of earlier steps, and what their unknowns are called here; none: the elements are put together.
    """

    size: int
    order: Indices
    count: int
    elements: Indices
    dofs: Indices
    halves: tuple[tuple[int, Indices], ...]


@dataclass(frozen=True, eq=False)
class _Plan:
    """All eliminations in their order, before any number is known; held unknowns have the number after the last one.

    Parts that are alike are one step.
    """

    kinds: Indices
    dofs: Indices
    places: Indices
    touching: Indices
    steps: list[_Step] = field(default_factory=list)
    known: dict[tuple[bytes, ...], int] = field(default_factory=dict)

    def add(self, elements: Indices) -> tuple[Indices, int]:
        """Plan to eliminate what lies inside some elements: their unknowns, and the number of the last step."""
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
            step = self._step(elements, unknowns, dofs, inner)
            self.known[key] = len(self.steps)
            self.steps.append(step)
        return unknowns, self.known[key]

    def _step(self, elements: Indices, unknowns: Indices, dofs: Indices, inner: Flags) -> _Step:
        """Plan the elimination of the unknowns that are told to be inside, and those of both halves before it."""
        left, halves = np.ones(len(unknowns), dtype=bool), []
        if len(elements) > LEAF:
            left[:] = False
            for half in self._halves(elements):
                own, number = self.add(half)
                place = np.empty(len(self.touching), dtype=int)
                place[unknowns] = np.arange(len(unknowns))
                step = self.steps[number]
                halves.append((number, place[own]))
                left[place[own][step.order[step.count :]]] = True
            elements, dofs = elements[:0], dofs[:0]
        eliminated = np.flatnonzero(inner & left)
        order = np.concatenate([eliminated, np.flatnonzero(~inner)])
        return _Step(len(unknowns), order, len(eliminated), elements, dofs, tuple(halves))

    @property
    def bytes(self) -> float:
        """Most memory that the elimination takes at a time: factors so far, what is left of parts, and its work."""
        most = kept = 0.0
        live, uses = dict[int, float](), self._uses()
        for number, step in enumerate(self.steps):
            size, rest = len(step.order), len(step.order) - step.count
            work = size**2 + max(2 * size**2 if step.halves else 0, 2 * (step.count + rest) * step.count + rest**2)
            most = max(most, kept + sum(live.values()) + work)
            kept += size * step.count
            live[number] = rest**2
            _drop(live, uses, step)
        return RESERVE * 8.0 * most

    def _uses(self) -> list[int]:
        """How many halves each step is."""
        halves = [half for step in self.steps for half, _ in step.halves]
        return np.bincount(np.array(halves, dtype=int), minlength=len(self.steps)).tolist()

    def factors(self, matrices: Array) -> list[tuple[Array, Array]]:
        """L11 and L21 of the Cholesky factor of every step; what a step leaves is kept as long as another needs it."""
        pairs, uses = [], self._uses()
        left: dict[int, Array] = {}
        for number, step in enumerate(self.steps):
            factor, coupling, left[number] = _eliminated(self._matrix(step, matrices, left), step.count)
            pairs.append((factor, coupling))
            _drop(left, uses, step)
        return pairs

    def _matrix(self, step: _Step, matrices: Array, left: dict[int, Array]) -> Array:
        """Stiffness of the unknowns that are left before a step."""
        if not step.halves:
            return _assembled(step.dofs, matrices[self.kinds[step.elements]], step.order)
        earlier = [self.steps[half] for half, _ in step.halves]
        borders = [here[half.order[half.count :]] for (_, here), half in zip(step.halves, earlier, strict=True)]
        return _sum(borders, [left[half] for half, _ in step.halves], step.order, step.size)

    def fronts(self, factors: list[tuple[Array, Array]], number: int, unknowns: Indices) -> Iterator[_Front]:
        """Fronts in the order of elimination up to a step, in the numbers that its unknowns have in the whole."""
        step = self.steps[number]
        for half, here in step.halves:
            yield from self.fronts(factors, half, unknowns[here])
        order = unknowns[step.order]
        yield _Front(order[: step.count], order[step.count :], *factors[number])

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
    total = np.zeros((len(order) + 1, len(order) + 1), matrices.dtype)
    for rows, matrix in zip(place[dofs], matrices, strict=True):
        total[rows[:, None], rows] += matrix
    return total[:-1, :-1]


def _sum(borders: Sequence[Indices], matrices: Sequence[Array], order: Indices, size: int) -> Array:
    """Dense sum of what is left of two halves for their ``borders``, in the order of unknowns ``order`` of ``size``.

    The last row and column of each matrix are zeros.
    """
    parts = []
    for border, matrix in zip(borders, matrices, strict=True):
        where = np.full(size, len(border))
        where[border] = np.arange(len(border))
        parts.append(matrix.take(where[order], axis=1).take(where[order], axis=0))  # fewer rows in the slow copy
    total, other = parts
    total += other
    return total


def _drop(left: dict[int, Any], uses: list[int], step: _Step) -> None:
    """Forget what halves of a step have left, where no later step needs it."""
    for half, _ in step.halves:
        uses[half] -= 1
        if not uses[half]:
            del left[half]


def _eliminated(matrix: Array, count: int) -> tuple[Array, Array, Array]:
    """Factor of the first ``count`` unknowns, their coupling with the others, and what is left for these."""
    if not count:
        nothing = np.empty((len(matrix), 0), matrix.dtype)
        return nothing[:0], nothing, np.pad(matrix, (0, 1))
    try:
        factor = scipy.linalg.cholesky(matrix[:count, :count], lower=True, check_finite=False)
    except np.linalg.LinAlgError:
        factor = None
    if factor is None or factor.diagonal().min() ** 2 <= LEAST_PIVOT * matrix.diagonal()[:count].max():
        raise GeometryError("the gear body is not held, or its mesh is damaged: no positive stiffness")
    coupling = scipy.linalg.solve_triangular(factor, matrix[:count, count:], lower=True, check_finite=False).T
    rest = np.zeros((len(matrix) - count + 1,) * 2, matrix.dtype)
    np.subtract(matrix[count:, count:], coupling @ coupling.T, out=rest[:-1, :-1])
    return factor, coupling, rest
