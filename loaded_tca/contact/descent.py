"""Projected, preconditioned conjugate gradients for a stack of contact problems on grids of one shape."""

from functools import reduce
from itertools import count
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.contact.convolution import ALL, Rows
from loaded_tca.contact.grid import CELLS, Grids, Operator, total_of
from loaded_tca.contact.levels import PART_CELLS, parts_of

Single = NDArray[np.float32]

# Steps in single precision let the displacement drift; it is computed anew after so many of them.
REFRESH = 25
# A search along a projected step shorter than this part of it is worth doing, a longer one is not: taking the
# whole step sets the cells that reach a bound exactly on it.
WHOLE_STEP = 0.5
# Pressures below this part of the largest one move nothing by more than single precision resolves.
DUST = 1e-8
# BLAS starts threads for products of vectors from this length.
THREADED_BLAS = 10_000
# In place of the last product of residual and preconditioned residual: nothing is left of the last direction.
RESTART = np.float32(np.inf)
# What residuals refer to where the approach is none, as it cannot be in a solution [mm].
LEAST_APPROACH = 1e-100


def dots(one: NDArray[Any], other: NDArray[Any]) -> Array:
    """Scalar products of every problem, (count, 1, 1); large ones without BLAS, whose threads wait for each other."""
    count, cells = len(one), one.shape[1] * one.shape[2]
    if cells < THREADED_BLAS:
        return np.matmul(one.reshape(count, 1, cells), other.reshape(count, cells, 1))
    return np.einsum("kij,kij->k", one, other)[:, None, None]


class Judgement(NamedTuple):
    """How far pressures are from solving their problems; the numbers of each are (count, 1, 1).

    Parameters
    ----------
    approach : array [mm]
        Mean of u + h over the cells strictly between the bounds, or as prescribed.
    residual : array
        Largest of: mean excess where the pressure is between the bounds, weighted with it; deepest penetration
        where the pressure is zero; widest gap where it is at the cap. All over the approach. And what the grids count
        of single cells.
    free : (count, nx, ny) array of bool
        Cells between the bounds, and cells that the excess pushes off a bound.
    """

    approach: Array
    residual: Array
    free: Mask


def judge(grids: Grids, pressure: Array, excess: Array, room: Array | None = None) -> Judgement:
    """Check the Kuhn-Tucker conditions; turns ``excess``, given as u + h, into u + h - approach in place.

    Twice through the cells, in parts that stay in the cache: for the approach, and for what the excess is beside it.
    ``room``: an array like these to work in, new arrays being dear.
    """
    free = loaded = capped = pressure > grids.slack
    if grids.capped:
        capped = pressure >= grids.limit - grids.slack
        free = loaded & ~capped
    parts = _in_parts(pressure, excess, free, capped)
    room = np.empty(parts[0][0].shape) if room is None else room
    counts, sums, worst, weighted = [], [], [], []
    for _, beside, between, _ in parts:
        ones = room[:, : between.shape[1]]
        np.copyto(ones, between)
        counts.append(total_of(ones))
        sums.append(dots(beside, ones))
    cells = reduce(np.add, counts)
    approach = reduce(np.add, sums) / np.maximum(cells, 1.0) if grids.loaded else grids.approach
    for k in np.flatnonzero(cells == 0.0) if grids.loaded and grids.capped else ():
        # With every cell at a bound any value between two limits is right.
        lower, outside = float(excess[k][capped[k]].max()), excess[k][~loaded[k]]
        approach[k] = 0.5 * (lower + float(outside.min(initial=2.0 * np.abs(excess[k]).max() - lower)))
    for now, beside, between, at_cap in parts:
        violation = room[:, : between.shape[1]]
        beside -= approach
        if len(parts) > 1:  # of a single one they are still there
            np.copyto(violation, between)
        violation *= beside
        violation -= beside  # but for its sign the excess where the pressure is zero, or at the cap
        if grids.capped:
            np.copyto(violation, beside, where=at_cap)
        worst.append(np.maximum.reduce(violation, axis=CELLS, keepdims=True, initial=0.0))
        np.abs(beside, out=violation)
        if grids.capped:
            violation *= between
        weighted.append(dots(now, violation))
        between |= beside < 0.0
        if grids.capped:
            np.copyto(between, beside > 0.0, where=at_cap)
    residual = np.maximum(reduce(np.maximum, worst), reduce(np.add, weighted) / grids.sums(pressure))
    residual /= np.maximum(approach, LEAST_APPROACH)
    return Judgement(approach, np.maximum(residual, grids.residual_of_cells(pressure, excess)), free)


def _in_parts(*arrays: NDArray[Any]) -> list[tuple[NDArray[Any], ...]]:
    """Views of arrays (count, nx, ny) of one shape, in parts of the grid that fit the cache."""
    if arrays[0][0].size <= PART_CELLS:
        return [arrays]
    return [tuple(array[:, part] for array in arrays) for part, _ in parts_of(arrays[0].shape)]


class Descent:
    """Projected conjugate gradients on a stack of problems, each until it is solved; run once.

    Directions and their convolutions are in single precision, relative to the approach: they correct a
    displacement that is computed in double precision, so their rounding errors shrink with the residual. Nothing of
    a problem depends on what stands beside it in the stack.

    Parameters
    ----------
    grids : Grids
        The problems.
    pressure : (count, nx, ny) array [mm]
        Start, within the bounds and with the right sum; worked on in place.
    displacement : (count, nx, ny) array [mm], optional
        K times the start, if known.
    threads : int
        Threads of a transform.
    exact : bool
        Whether the displacement of the start is computed in double precision; else its errors, some 1e-7 of the
        approach, stay in it until the next refreshment.
    preconditioner : Operator, optional
        That of the problems, if known.

    Attributes
    ----------
    pressure : (count, nx, ny) array [mm]
        The solutions, once it has run.
    approach, residual : (count,) array
        See :class:`Judgement`.
    iterations, convolutions : (count,) array of int

    References
    ----------
    Polonsky & Keer 1999, Wear 231, 206-219 (conjugate gradients under the load constraint); Vollebregt 2014,
    J. Comput. Phys. 257, 333-351 (Fourier preconditioner).
    """

    def __init__(
        self,
        grids: Grids,
        pressure: Array,
        displacement: Array | None = None,
        threads: int = 2,
        exact: bool = True,
        preconditioner: Operator | None = None,
    ) -> None:
        self.pressure = np.empty(pressure.shape)
        self.approach, self.residual = np.empty((2, len(grids)))
        self.iterations, self.convolutions = np.zeros((2, len(grids)), dtype=int)
        # From here on only the problems that have not ended, ``rows`` of the stack.
        self._grids, self._rows, self._threads = grids, np.arange(len(grids)), threads
        self._used = self.convolutions.copy()
        self._fast = grids.operator(dtype="float32", threads=threads)
        self._precondition = grids.preconditioner(threads) if preconditioner is None else preconditioner
        # Cut cells are about so much stiffer, the part being its square.
        self._root = None if grids.cover is None else np.sqrt(grids.cover).astype(np.float32)
        self._now, self._next, self._excess = pressure, np.empty(pressure.shape), np.empty(pressure.shape)
        self._displacement = self._displaced(exact) if displacement is None else displacement
        self._last_descent = np.full((len(grids), 1, 1), RESTART)
        self._direction, self._last = np.zeros((2, *pressure.shape), dtype=np.float32)
        self._residual, self._preconditioned, self._image, self._free = np.empty((4, *pressure.shape), dtype=np.float32)

    def run(self, tolerance: Array, limit: Array) -> None:
        """Iterate each problem until its residual is below its tolerance or its ``limit`` of iterations is reached."""
        for step in count():
            np.add(self._displacement, self._grids.gap, out=self._excess)
            state = judge(self._grids, self._now, self._excess, self._next)
            if step == 0:  # of the excess in single precision
                highest, lowest = (extreme(self._excess, axis=CELLS, keepdims=True) for extreme in (np.max, np.min))
                self._scale = np.maximum(np.maximum(highest, -lowest), LEAST_APPROACH)
            ends = (state.residual[:, 0, 0] <= tolerance) | (step >= limit)
            if ends.any():
                rows = self._rows[ends]
                if rows.size == len(self.pressure):
                    self.pressure = self._now
                else:
                    self.pressure[rows] = self._now[ends]
                self.iterations[rows], self.convolutions[rows] = step, self._used[ends]
                self.approach[rows], self.residual[rows] = state.approach[ends, 0, 0], state.residual[ends, 0, 0]
                left = np.flatnonzero(~ends)
                if not left.size:
                    return
                self._keep(left)
                state = Judgement(state.approach[left], state.residual[left], state.free[left])
                tolerance, limit = tolerance[left], limit[left]
            self._iterate(state)
            if (step + 1) % REFRESH == 0:
                self._displacement = self._displaced(exact=True)
                self._last_descent[:] = RESTART

    def _keep(self, left: Indices) -> None:
        """Go on with some of the problems."""
        self._grids, self._rows = self._grids.select(left), self._rows[left]
        kept = ("_root", "_now", "_displacement", "_excess", "_scale", "_used", "_last_descent", "_last", "_direction")
        for name in kept:
            array = getattr(self, name)
            setattr(self, name, None if array is None else array[left])
        for name in ("_next", "_residual", "_preconditioned", "_image", "_free"):  # filled anew before they are read
            setattr(self, name, getattr(self, name)[: left.size])

    def _displaced(self, exact: bool) -> Array:
        """Displacement of the pressures, in double precision or in single."""
        self._used += 1
        operator = self._grids.operator(threads=self._threads) if exact else self._fast
        return operator(self._now, np.empty(self._now.shape))

    def _convolved(self, values: Single, rows: Indices) -> Single:
        """Displacement of values of some of the problems in single precision; it stands until the next."""
        self._used[self._chosen(rows)] += 1
        image = self._image[: rows.size]
        self._fast(values, image, self._places(rows))
        return image

    def _places(self, rows: Rows = ALL) -> Rows:
        """Rows as they are counted at the start."""
        places = self._rows[rows]
        return ALL if places.size == len(self.pressure) else places

    def _iterate(self, state: Judgement) -> None:
        """One step along the conjugate directions, projected where it leaves the bounds."""
        np.copyto(self._free, state.free)
        np.multiply(self._excess, 1.0 / self._scale, out=self._residual, casting="same_kind")
        cells = np.maximum(total_of(self._free), 1.0)
        self._level(self._residual, cells)
        slope, descent = self._conjugate(cells)
        self._used += 1
        image = self._fast(self._direction, self._image, self._places())
        curvature = dots(self._direction, image)
        good = np.minimum(np.minimum(slope, descent), curvature) > 0.0
        self._last_descent = np.where(good, descent, RESTART)
        length = np.zeros(good.shape, dtype=np.float32)
        np.divide(self._scale * slope, curvature, out=length, where=good, casting="same_kind")
        # The array of the preconditioned residual is free to take the step.
        step, trial = np.multiply(self._direction, length, out=self._preconditioned), self._next
        np.subtract(self._now, step, out=trial)
        outside = np.minimum.reduce(trial, axis=CELLS, keepdims=True) < 0.0
        if self._grids.capped:
            outside |= (trial > self._grids.limit).any(axis=CELLS, keepdims=True)
        rows = (outside & good)[:, 0, 0].nonzero()[0]
        if rows.size:
            chosen = self._chosen(rows)
            target = self._grids.clip(trial[chosen], state.free[chosen], chosen)
        if rows.size < len(trial):
            if rows.size:
                trial[chosen], length[chosen] = self._now[chosen], 0.0
            image *= length
            self._displacement -= image
            self._now, self._next = trial, self._now
        if rows.size:
            stuck = self._move(rows, target)
            if stuck.size:
                self._last_descent[stuck] = RESTART
                stuck = stuck[~self._drop_dust(stuck)]
            if stuck.size:
                self._project_gradient(stuck, state.free)
        # The residual is the last one from here on, and the array of that takes the next.
        self._last, self._residual = self._residual, self._last

    def _conjugate(self, cells: Single) -> tuple[Array, Array]:
        """Directions of Polak and Ribiere from the preconditioned residual.

        Returns the products of the residual with them, and with the preconditioned residual.
        """
        residual, preconditioned, direction = self._residual, self._preconditioned, self._direction
        if self._root is None:
            self._precondition(residual, preconditioned, self._places())
        else:
            self._precondition(self._root * residual, preconditioned, self._places())
            preconditioned *= self._root
        preconditioned *= self._free  # a constant in it is orthogonal to the residual
        descent = dots(preconditioned, residual)
        direction *= np.maximum(0.0, descent - dots(preconditioned, self._last)) / self._last_descent
        direction += preconditioned
        self._level(direction, cells)
        slope = dots(direction, residual)
        return slope, descent

    def _level(self, values: Single, cells: Single) -> None:
        """Leave nothing outside the free cells; with a given sum, take the mean off them, so that the sum stays."""
        values *= self._free
        if self._grids.loaded:
            values -= total_of(values) / cells
            values *= self._free

    def _chosen(self, rows: Indices) -> Rows:
        """Rows as an index that does not copy if they are all."""
        return ALL if rows.size == len(self._rows) else rows

    def _move(self, rows: Indices, target: Array) -> Indices:
        """Go towards pressures within the bounds as far as the energy falls; returns where it does not fall at all."""
        chosen = self._chosen(rows)
        now, scale, single = self._now[chosen], self._scale[chosen], self._preconditioned[: rows.size]
        for part, _ in parts_of(now.shape):
            step = target[:, part] - now[:, part]
            np.multiply(step, 1.0 / scale, out=single[:, part], casting="same_kind")
        image = self._convolved(single, rows)
        # The residual is the excess over the scale where a step goes, but for a constant, which a sum of zero meets.
        slope, curvature = dots(single, self._residual[chosen]), dots(single, image)
        falls = (slope < 0.0) & (curvature > 0.0)
        length = np.divide(-slope, curvature, out=np.zeros(falls.shape), where=falls)
        length = np.where(length < WHOLE_STEP, length, 1.0)
        for part, _ in parts_of(now.shape):
            step = target[:, part] - now[:, part]
            step *= 1.0 - length
            np.subtract(target[:, part], step, out=now[:, part])  # a whole step to the last digit
        if not isinstance(chosen, slice):  # of which ``now`` is a copy
            self._now[chosen] = now
        image *= (length * scale).astype(np.float32)
        self._displacement[chosen] += image
        return rows[~falls[:, 0, 0]]

    def _drop_dust(self, rows: Indices) -> Mask:
        """Set pressures to zero that are next to none over an open gap; returns the problems that had some.

        What that gains is lost in the rounding of single precision, so that no step would find it.
        """
        pressure = self._now[rows]
        dust = (self._excess[rows] > 0.0) & (pressure > 0.0)
        dust &= pressure < DUST * pressure.max(axis=CELLS, keepdims=True)
        self._now[rows] = np.where(dust, 0.0, pressure)
        return np.asarray(dust.any(axis=CELLS))

    def _project_gradient(self, rows: Indices, free: Mask) -> None:
        """One projected step down the plain gradient, which always descends."""
        residual = self._residual[rows]
        curvature = dots(residual, self._convolved(residual, rows))
        bent = np.flatnonzero(curvature > 0.0)
        if bent.size:
            rows, residual = rows[bent], residual[bent]
            length = self._scale[rows] * dots(residual, residual) / curvature[bent]
            self._move(rows, self._grids.project(self._now[rows] - length * residual, free[rows], rows))
