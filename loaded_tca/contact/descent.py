"""Projected, preconditioned conjugate gradients for a stack of contact problems on grids of one shape."""

from dataclasses import dataclass
from itertools import count
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.contact.convolution import Preconditioner
from loaded_tca.contact.grid import Grids, by_problem, highest, lowest, sums

Single = NDArray[np.float32]

# Steps in single precision let the displacement drift; it is computed anew after so many of them.
REFRESH = 25
# A search along a projected step shorter than this part of it is worth doing, a longer one is not: taking the
# whole step sets the cells that reach a bound exactly on it.
WHOLE_STEP = 0.5
# Pressures below this part of the largest one move nothing by more than single precision resolves.
DUST = 1e-8
TINY = float(np.finfo(np.float64).tiny)
# Problems that are solved leave the stack once no more than this part of it is left: copying costs less than they do.
PART_LEFT = 0.75


def dots(one: NDArray[Any], other: NDArray[Any]) -> Array:
    """Scalar products of every problem, (count,): without BLAS, whose threads wait for each other on a busy machine."""
    return np.einsum("ki,ki->k", one.reshape(len(one), -1), other.reshape(len(other), -1)).astype(np.float64, copy=False)


def ratio(above: Array, below: Array, where: Mask) -> Array:
    """Quotients of numbers for each problem, zero where there is none to be taken."""
    return np.divide(above, below, out=np.zeros(len(below)), where=where)


@dataclass
class Judgement:
    """How far pressures are from solving their problems.

    Parameters
    ----------
    approach : (count,) array [mm]
        Mean of u + h over the cells strictly between the bounds, or as prescribed.
    residual : (count,) array
        Largest of: mean excess where the pressure is between the bounds, weighted with it; deepest penetration
        where the pressure is zero; widest gap where it is at the cap. All over the approach.
    free : (count, nx, ny) array of bool
        Cells between the bounds, and cells that the excess pushes off a bound.
    """

    approach: Array
    residual: Array
    free: Mask

    def select(self, rows: Indices) -> Self:
        """That of some of the problems."""
        return type(self)(self.approach[rows], self.residual[rows], self.free[rows])


def judge(grids: Grids, pressure: Array, excess: Array) -> Judgement:
    """Check the Kuhn-Tucker conditions; turns ``excess``, given as u + h, into u + h - approach in place."""
    inner = loaded = pressure > by_problem(grids.slack)
    capped: Mask | None = None
    if grids.capped.any():
        capped = pressure >= grids.limit - by_problem(grids.slack)
        inner = loaded & ~capped
    approach = grids.approach
    if grids.loaded.any():
        approach = np.where(grids.loaded, _mean_level(excess, loaded, inner, capped), approach)
    excess -= by_problem(approach)
    free = inner | (excess < 0.0)
    misfit = np.abs(excess)
    worst = np.maximum(0.0, highest(np.where(loaded, 0.0, -excess)))
    if capped is not None:
        worst = np.maximum(worst, highest(np.where(capped, excess, 0.0)))
        free = free & ~capped | (capped & (excess > 0.0))
        misfit *= inner
    worst = np.maximum(worst, dots(pressure, misfit) / np.maximum(sums(pressure), TINY))
    residual = np.divide(worst, approach, out=np.full(len(worst), np.inf), where=approach > 0.0)
    return Judgement(approach, residual, free)


def _mean_level(level: Array, loaded: Mask, inner: Mask, capped: Mask | None) -> Array:
    """Approaches that fit u + h best; with every cell at a bound any value between two limits is right."""
    cells = np.count_nonzero(inner, axis=(1, 2))
    mean = sums(np.where(inner, level, 0.0)) / np.maximum(cells, 1)
    for k in np.flatnonzero(cells == 0) if capped is not None else ():
        if capped[k].any():
            lower = float(level[k][capped[k]].max())
            mean[k] = 0.5 * (lower + float(level[k][~loaded[k]].min(initial=2.0 * np.abs(level[k]).max() - lower)))
    return np.asarray(mean)


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
        Start, within the bounds and with the right sum.
    displacement : (count, nx, ny) array [mm], optional
        K times the start, if known.
    threads : int
        Threads of a transform.
    exact : bool
        Whether the displacement of the start is computed in double precision; else its errors, some 1e-7 of the
        approach, stay in it until the next refreshment.

    Attributes
    ----------
    pressure : (count, nx, ny) array [mm]
        The solutions, once it has run.
    iterations, convolutions : (count,) arrays of int

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
    ) -> None:
        shape = pressure.shape
        self.pressure = pressure
        self.iterations, self.convolutions = np.zeros((2, len(grids)), dtype=int)
        self._grids, self._rows, self._threads = grids, np.arange(len(grids)), threads
        self._fast = grids.operator(dtype="float32", threads=threads)
        self._precondition = Preconditioner(grids.shape, grids.aspects, threads)
        # Cut cells are about so much stiffer, the part being its square.
        self._root = None if grids.cover is None else np.sqrt(grids.cover).astype(np.float32)
        self._now = pressure
        self._displacement = self._displaced(exact) if displacement is None else displacement
        self._excess = np.empty(shape)
        self._scale = np.ones(len(grids))
        self._last_descent = np.zeros(len(grids))  # zero: the next direction is a restart
        self._last, self._residual, self._direction, self._preconditioned, self._image = np.zeros(
            (5, *shape), dtype=np.float32
        )

    def run(self, tolerance: Array, limit: Array) -> Judgement:
        """Iterate each problem until its residual is below its tolerance or its ``limit`` of iterations is reached."""
        running, found = np.ones(len(self._rows), dtype=bool), self._judged()
        self.pressure, state = np.empty_like(self._now), found
        for step in count():
            if step:
                state = self._judged()
            ended = running & ((state.residual <= tolerance[self._rows]) | (step >= limit[self._rows]))
            if ended.any():
                rows = self._rows[ended]
                self.pressure[rows], self.iterations[rows] = self._now[ended], step
                found.approach[rows], found.residual[rows] = state.approach[ended], state.residual[ended]
                found.free[rows] = state.free[ended]
                running &= ~ended
                if not running.any():
                    return found
                if np.count_nonzero(running) <= PART_LEFT * len(running):
                    kept = np.flatnonzero(running)
                    self._keep(kept)
                    running, state = running[kept], state.select(kept)
            self._iterate(state, running)
            if (step + 1) % REFRESH == 0:
                self._displacement = self._displaced(exact=True)
                self._last_descent[:] = 0.0
        raise AssertionError

    def _judged(self) -> Judgement:
        np.add(self._displacement, self._grids.gap, out=self._excess)
        return judge(self._grids, self._now, self._excess)

    def _keep(self, rows: Indices) -> None:
        """Go on with some of the problems."""
        self._grids, self._fast = self._grids.select(rows), self._fast.select(rows)
        self._precondition, self._rows = self._precondition.select(rows), self._rows[rows]
        self._root = None if self._root is None else self._root[rows]
        self._now, self._displacement, self._excess = self._now[rows], self._displacement[rows], self._excess[rows]
        self._scale, self._last_descent = self._scale[rows], self._last_descent[rows]
        self._last, self._residual, self._direction = self._last[rows], self._residual[rows], self._direction[rows]
        self._preconditioned, self._image = self._preconditioned[: len(rows)], self._image[: len(rows)]

    def _displaced(self, exact: bool) -> Array:
        """Displacement of the pressures, in double precision or in single."""
        self.convolutions[self._rows] += 1
        operator = self._grids.operator(threads=self._threads) if exact else self._fast
        return operator(self._now, np.empty(self._now.shape))

    def _convolved(self, values: Single, rows: Indices) -> Single:
        """Displacement of values of some of the problems in single precision."""
        self.convolutions[self._rows[rows]] += 1
        return self._fast.select(rows)(values, np.empty_like(values))

    def _iterate(self, state: Judgement, running: Mask) -> None:
        """One step along the conjugate directions, projected where it leaves the bounds; none for those that ended."""
        self._scale = np.where(state.approach > 0.0, state.approach, 1.0)
        for k in np.flatnonzero(state.approach <= 0.0):
            self._scale[k] = np.abs(self._displacement[k]).max()
        free = state.free.astype(np.float32)
        residual = np.multiply(self._excess, by_problem(1.0 / self._scale), out=self._residual, casting="same_kind")
        self._level(residual, free)
        direction = self._conjugate(residual, free)
        self.convolutions[self._rows[running]] += 1
        image = self._fast(direction, self._image)
        curvature = dots(direction, image)
        bent = curvature > 0.0
        self._last_descent[~bent] = 0.0
        length = by_problem(ratio(self._scale * dots(direction, residual), curvature, bent & running))
        trial = self._now - length * direction
        outside = lowest(trial) < 0.0
        if self._grids.capped.any():
            outside |= (trial > self._grids.limit).any(axis=(1, 2))
        rows = np.flatnonzero(outside & bent & running)
        target = trial[rows]
        trial[rows], length[rows] = self._now[rows], 0.0
        self._displacement -= length * image
        self._now = trial
        if rows.size:
            rows = self._move(rows, self._grids.clip(target, state.free[rows], rows))
            self._last_descent[rows] = 0.0
        if rows.size:
            rows = rows[~self._drop_dust(rows)]
        if rows.size:
            self._project_gradient(rows, state.free)
        # What has just been used is the last from here on; its array takes the next.
        self._last, self._residual = self._residual, self._last

    def _conjugate(self, residual: Single, free: Single) -> Single:
        """Direction of Polak and Ribiere from the preconditioned residual; a restart where it does not descend."""
        root, preconditioned, direction = self._root, self._preconditioned, self._direction
        self._precondition(residual if root is None else root * residual, preconditioned)
        if root is not None:
            preconditioned *= root
        self._level(preconditioned, free)
        descent = dots(preconditioned, residual)
        again = self._last_descent > 0.0
        ahead = np.maximum(0.0, ratio(descent - dots(preconditioned, self._last), self._last_descent, again))
        direction *= by_problem(ahead.astype(np.float32))
        direction += preconditioned
        self._level(direction, free)
        uphill = ~(dots(direction, residual) > 0.0)
        direction[uphill] = preconditioned[uphill]
        self._last_descent = np.maximum(descent, 0.0)
        return direction

    def _level(self, values: Single, free: Single) -> None:
        """Leave nothing outside the free cells; with a given sum, take the mean off them, so that the sum stays."""
        values *= free
        loaded = self._grids.loaded
        if loaded.any():
            mean = np.where(loaded, sums(values), 0.0) / np.maximum(sums(free), 1.0)
            values -= by_problem(mean.astype(np.float32))
            values *= free

    def _move(self, rows: Indices, target: Array) -> Indices:
        """Go towards pressures within the bounds as far as the energy falls; returns where it does not fall at all."""
        start, scale = self._now[rows], self._scale[rows]
        step = target - start
        single = (step / by_problem(scale)).astype(np.float32)
        image = self._convolved(single, rows)
        slope, curvature = dots(step, self._excess[rows]) / scale**2, dots(single, image)
        falls = (slope < 0.0) & (curvature > 0.0)
        best = ratio(-slope, curvature, falls)
        searched = best < WHOLE_STEP
        part = by_problem(np.where(searched, best, 1.0))
        moved = np.where(by_problem(searched), start + part * step, target)
        self._now[rows[falls]] = moved[falls]
        self._displacement[rows[falls]] += (part * by_problem(scale) * image)[falls]
        return rows[~falls]

    def _drop_dust(self, rows: Indices) -> Mask:
        """Set pressures to zero that are next to none over an open gap; returns the problems that had some.

        What that gains is lost in the rounding of single precision, so that no step would find it.
        """
        pressure = self._now[rows]
        dust = (self._excess[rows] > 0.0) & (pressure > 0.0) & (pressure < by_problem(DUST * highest(pressure)))
        self._now[rows] = np.where(dust, 0.0, pressure)
        return np.asarray(dust.any(axis=(1, 2)))

    def _project_gradient(self, rows: Indices, free: Mask) -> None:
        """One projected step down the plain gradient, which always descends."""
        residual = self._residual[rows]
        curvature = dots(residual, self._convolved(residual, rows))
        bent = curvature > 0.0
        length = by_problem(ratio(self._scale[rows] * dots(residual, residual), curvature, bent))
        rows, target = rows[bent], (self._now[rows] - length * residual)[bent]
        if rows.size:
            self._move(rows, self._grids.project(target, free[rows], rows))
