"""Direct solution of stiffness equations by nested dissection.

The elements are halved again and again; inside each half all that no other element touches is eliminated, densely, so
that nearly all the work is products of matrices. It is the multifrontal method, with the halves found from the whole
coordinates of the logical mesh: of the planes of nodes along all coordinates the one that parts the fewest unknowns for
halves of about equal size. Cuts across the longest side alone take 1.6 times as many operations on the bodies of root
stress. A general sparse factorisation takes several times as long on gear bodies. Parts that are put together from the
same elements in the same way, as the pitches of a rim are, are eliminated once.

Products of matrices are those of NumPy, which let other threads of the interpreter run.

References
----------
George 1973, Nested dissection of a regular finite element mesh, SIAM J. Numer. Anal. 10, 345-363; Duff, Reid 1983, The
multifrontal solution of indefinite sparse symmetric linear equations, ACM Trans. Math. Softw. 9, 302-325.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np
import scipy
from numpy.typing import NDArray

from loaded_tca.arrays import Array, Indices
from loaded_tca.contact.checks import machine_memory
from loaded_tca.errors import GeometryError, require
from loaded_tca.plain import plain
from loaded_tca.threads import leave_if_not_wanted, one_blas_thread

Flags = NDArray[np.bool_]
LEAF = 27
"""Elements that are not halved any more: with 8 the small fronts cost a fifth more in all, with 48 and more elements
there is more to eliminate."""
RESERVE = 1.1
"""Memory of an elimination over that of its matrices; measured: 0.96 to 0.98, of bodies of 0.2 to 0.6 GiB."""
COLUMNS, ROWS = 128, 256
"""Columns that are eliminated at a time, and rows of the rest from which they are subtracted at a time."""
LEAST_PIVOT = 1e-10
"""Least pivot over the largest diagonal entry of its elimination at which a body counts as held.

The last pivot of a free body is zero but for rounding, which leaves either sign: at most 6e-14, measured on rings of up
to 3000 elements with four BLAS kernels. Bodies of gears that are held have 3e-5 and more.
"""


@dataclass(frozen=True, eq=False)
class _Front:
    """What one elimination leaves.

    Attributes
    ----------
    inside, beside : (n,), (m,) int array
        Unknowns that are eliminated, and those beside them.
    factor : (n + m, n) array
        Columns of the Cholesky factor; blocks on the diagonal are inverted, so that products of matrices do the rest.
    halves : int
        How many earlier fronts are put together in it, 0 or 2: the last ones that no front between has taken.
    """

    inside: Indices
    beside: Indices
    factor: Array
    halves: int

    def forward(self, values: Array) -> None:
        """Divide values (n + m, k) by the factor, in place; below are those that are left for the unknowns beside."""
        count = len(self.inside)
        for block in _blocks(count):
            values[block] = self.factor[block, block] @ (
                values[block] - self.factor[block, : block.start] @ values[: block.start]
            )
        values[count:] -= self.factor[count:] @ values[:count]

    def backward(self, values: Array) -> Array:
        """Displacements (n, k) of the unknowns inside, of values (n + m, k) that have those beside at their end."""
        for block in reversed(_blocks(len(self.inside))):
            rest = values[block] - self.factor[block.stop :, block].T @ values[block.stop :]
            values[block] = self.factor[block, block].T @ rest
        return values[: len(self.inside)]


def _blocks(count: int) -> list[slice]:
    """Columns of a factor that are eliminated at a time."""
    return [slice(first, min(first + COLUMNS, count)) for first in range(0, count, COLUMNS)]


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
        values, displacements = np.array(loads, self.dtype), np.zeros(loads.shape, self.dtype)
        with one_blas_thread():
            for front in self.fronts:
                order = np.concatenate([front.inside, front.beside])
                part = values[order]
                front.forward(part)
                values[order] = part
            for front in reversed(self.fronts):
                below = np.concatenate([values[front.inside], displacements[front.beside]])
                displacements[front.inside] = front.backward(below)
        return displacements

    def flexibility(self, loads: scipy.sparse.csr_array, readings: scipy.sparse.csr_array) -> Array:
        """Values (p, m) of readings (p, size) of the displacements under loads (m, size).

        Loads and readings alike are divided by the Cholesky factor, and what is left of them inside each front
        multiplied: a front has to do with those alone that are inside it and below. Held unknowns do not move.
        """
        columns = scipy.sparse.vstack([loads, readings]).T.tocsr()
        columns.sum_duplicates()
        result, split = np.zeros((readings.shape[0], loads.shape[0])), loads.shape[0]
        touched = np.diff(columns.indptr) > 0
        waiting: list[_Columns] = []
        with one_blas_thread():  # the fronts are small: threads waiting for each other cost far more
            for front in self.fronts:
                leave_if_not_wanted()
                parts = [waiting.pop() for _ in range(front.halves)]
                if touched[front.inside].any():
                    own = columns[front.inside].tocoo()
                    here, which = np.unique(own.col, return_inverse=True)
                    values = np.zeros((len(front.inside), len(here)), self.dtype)
                    values[own.row, which] = own.data
                    parts.append(_Columns(front.inside, here.astype(int), values))
                used, values = self._put_together(front, parts)
                count, middle = len(front.inside), int(np.searchsorted(used, split))
                if len(used):
                    front.forward(values)
                    products = values[:count, middle:].T @ values[:count, :middle]
                    result[used[middle:, None] - split, used[:middle]] += products
                waiting.append(_Columns(front.beside, used, values[count:]))
        return result

    def _put_together(self, front: _Front, parts: list[_Columns]) -> tuple[Indices, Array]:
        """Which columns (k,) any of some parts has, and their sum (n + m, k) for the unknowns of a front."""
        parts = [part for part in parts if len(part.numbers)]
        used = np.unique(np.concatenate([np.empty(0, dtype=int), *(part.numbers for part in parts)]))
        order = np.concatenate([front.inside, front.beside])
        values, place = np.zeros((len(order), len(used)), self.dtype), np.empty(self.size, dtype=int)
        place[order] = np.arange(len(order))
        for part in parts:
            values[place[part.unknowns][:, None], np.searchsorted(used, part.numbers)] += part.values
        return used, values


@dataclass(frozen=True, eq=False)
class _Columns:
    """Values (n, k) of some unknowns (n,) in those columns (k,) of all that are not zero there."""

    unknowns: Indices
    numbers: Indices
    values: Array


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
    plan.arrange()
    needed, limit = plan.bytes + 8.0 * matrices.size, machine_memory()  # of single precision: it may be made again
    problem = f"{size} unknowns need {plain(needed / 2**30, 3)} GiB, the machine has {plain(limit / 2**30, 3)} GiB"
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
            place = np.empty(len(self.touching), dtype=int)
            place[unknowns] = np.arange(len(unknowns))
            lower = self._lower_half(elements, dofs, len(unknowns))
            for half in (elements[lower], elements[~lower]):
                own, number = self.add(half)
                step = self.steps[number]
                halves.append((number, place[own]))
                left[place[own][step.order[step.count :]]] = True
            elements, dofs = elements[:0], dofs[:0]
        eliminated = np.flatnonzero(inner & left)
        order = np.concatenate([eliminated, np.flatnonzero(~inner)])
        return _Step(len(unknowns), order, len(eliminated), elements, dofs, tuple(halves))

    def arrange(self) -> None:
        """Put the unknowns that each step leaves into the order that they have in the step it is a half of.

        What halves leave then goes into the matrix of the whole in a few large pieces. Of parts that are alike, the
        last one says the order.
        """
        arranged = set[int]()
        for step in reversed(self.steps):
            place = np.empty(step.size, dtype=int)
            place[step.order] = np.arange(len(step.order))
            for number, here in step.halves:
                if number not in arranged:
                    arranged.add(number)
                    half = self.steps[number]
                    left = half.order[half.count :]
                    half.order[half.count :] = left[place[here[left]].argsort()]

    @property
    def bytes(self) -> float:
        """Most memory that the elimination takes at a time: factors so far, what is left of parts, and its work."""
        most = kept = 0.0
        live, uses = dict[int, float](), self._uses()
        for number, step in enumerate(self.steps):
            size, rest = len(step.order), len(step.order) - step.count
            work = COLUMNS * size if step.halves else size**2
            most = max(most, kept + sum(live.values()) + size * step.count + rest**2 + work)
            kept += size * step.count
            live[number] = rest**2
            _drop(live, uses, step)
        return RESERVE * 8.0 * most

    def _uses(self) -> list[int]:
        """How many halves each step is."""
        halves = [half for step in self.steps for half, _ in step.halves]
        return np.bincount(np.array(halves, dtype=int), minlength=len(self.steps)).tolist()

    def factors(self, matrices: Array) -> list[Array]:
        """Columns of the Cholesky factor of every step; what a step leaves is kept as long as another needs it."""
        factors, uses = list[Array](), self._uses()
        left: dict[int, Array] = {}
        for number, step in enumerate(self.steps):
            leave_if_not_wanted()
            columns, left[number] = self._matrix(step, matrices, left)
            _eliminate(columns, left[number])
            factors.append(columns)
            _drop(left, uses, step)
        return factors

    def _matrix(self, step: _Step, matrices: Array, left: dict[int, Array]) -> tuple[Array, Array]:
        """Stiffness of the unknowns that are left before a step: columns of those it eliminates, and of the others.

        Of what is symmetric the lower triangle counts.
        """
        size, count = len(step.order), step.count
        if not step.halves:
            whole = _assembled(step.dofs, matrices[self.kinds[step.elements]], step.order)
            return whole[:, :count].copy(), whole[count:, count:].copy()
        columns, rest = np.zeros((size, count), matrices.dtype), np.zeros((size - count,) * 2, matrices.dtype)
        place = np.empty(step.size, dtype=int)
        place[step.order] = np.arange(size)
        for number, here in step.halves:
            half = self.steps[number]
            _add(columns, rest, place[here[half.order[half.count :]]], left[number])
        return columns, rest

    def fronts(self, factors: list[Array], number: int, unknowns: Indices) -> Iterator[_Front]:
        """Fronts in the order of elimination up to a step, in the numbers that its unknowns have in the whole."""
        step = self.steps[number]
        for half, here in step.halves:
            yield from self.fronts(factors, half, unknowns[here])
        order = unknowns[step.order]
        yield _Front(order[: step.count], order[step.count :], factors[number], len(step.halves))

    def _lower_half(self, elements: Indices, dofs: Indices, size: int) -> Flags:
        """Which elements (n,) are in the lower half: of several blocks in a row, else by the cut of least unknowns.

        Such a cut parts as few unknowns as it can from both halves, over the product of their sizes.
        """
        places = self.places[elements]
        if np.ptp(places[:, 0]):
            levels = np.unique(places[:, 0])
            below = np.arange(1, len(levels))
            return np.asarray(places[:, 0] < levels[np.abs(below - 0.5 * len(levels)).argmin() + 1])
        least, lower = np.inf, np.empty(0, dtype=bool)
        for along in places.T[1:]:
            order = along.argsort(kind="stable")
            level = np.cumsum(np.append(0, np.diff(along[order]) > 0))
            cuts = int(level[-1])
            if not cuts:
                continue
            first, last = np.empty((2, size + 1), dtype=int)
            last[dofs[order]] = level[:, None]
            first[dofs[order[::-1]]] = level[::-1, None]
            parted = np.bincount(first[:size], minlength=cuts + 1) - np.bincount(last[:size], minlength=cuts + 1)
            below = np.cumsum(np.bincount(level))[:-1]
            cost = np.cumsum(parted)[:-1] / (below * (len(elements) - below))
            if cost.min() < least:
                least = cost.min()
                lower = along < along[order][below[cost.argmin()]]
        return lower


def _assembled(dofs: Indices, matrices: Array, order: Indices) -> Array:
    """Dense sum of element matrices in the order of the unknowns ``order``; numbers beyond them are held."""
    place = np.empty(len(order) + 1, dtype=int)
    place[np.append(order, len(order))] = np.arange(len(order) + 1)
    total = np.zeros((len(order) + 1, len(order) + 1), matrices.dtype)
    for rows, matrix in zip(place[dofs], matrices, strict=True):
        total[rows[:, None], rows] += matrix
    return total[:-1, :-1]


def _add(columns: Array, rest: Array, place: Indices, matrix: Array) -> None:
    """Add what is left of a half to the matrix of the whole, in pieces that lie together in both.

    Parameters
    ----------
    columns : (n + m, n) array
    rest : (m, m) array
    place : (k,) int array
        Where the unknowns of the half are among the n + m.
    matrix : (k, k) array
        Of it, as of the others, the lower triangle counts.
    """
    count = columns.shape[1]
    starts = np.flatnonzero(np.append(True, (np.diff(place) != 1) | (place[1:] == count)))
    pieces = list(zip(starts.tolist(), [*starts[1:].tolist(), len(place)], place[starts].tolist(), strict=True))
    for n, (first, last, row) in enumerate(pieces):
        end = row + last - first
        for left, right, column in pieces[: n + 1]:
            piece, stop = matrix[first:last, left:right], column + right - left
            if row >= column:
                down, up, across, beyond = row, end, column, stop
            else:
                piece, down, up, across, beyond = piece.T, column, stop, row, end
            if across < count:
                columns[down:up, across:beyond] += piece
            else:
                rest[down - count : up - count, across - count : beyond - count] += piece


def _drop(left: dict[int, Any], uses: list[int], step: _Step) -> None:
    """Forget what halves of a step have left, where no later step needs it."""
    for half, _ in step.halves:
        uses[half] -= 1
        if not uses[half]:
            del left[half]


def _eliminate(columns: Array, rest: Array) -> None:
    """Factorise the columns (n + m, n) of n unknowns, and subtract from the rest (m, m) what they take, in place."""
    count = columns.shape[1]
    least = LEAST_PIVOT * columns.diagonal().max(initial=0.0)
    inverse = cast(Callable[..., Any], scipy.linalg.get_lapack_funcs("trtri", (columns,)))
    for block in _blocks(count):
        below = columns[block.start :, block]
        below -= columns[block.start :, : block.start] @ columns[block, : block.start].T
        try:
            factor = np.linalg.cholesky(columns[block, block])
        except np.linalg.LinAlgError:
            factor = None
        if factor is None or factor.diagonal().min() ** 2 <= least:
            raise GeometryError("the gear body is not held, or its mesh is damaged: no positive stiffness")
        columns[block, block] = inverse(factor.T)[0].T
        columns[block.stop :, block] = columns[block.stop :, block] @ columns[block, block].T
    coupling = columns[count:]
    for first in range(0, len(rest), ROWS):
        rows = slice(first, first + ROWS)
        rest[rows, : rows.stop] -= coupling[rows] @ coupling[: rows.stop].T
