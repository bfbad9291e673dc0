"""Projected, preconditioned conjugate gradients for a contact problem on one grid."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arrays import Array, Mask
from loaded_tca.contact.convolution import Preconditioner
from loaded_tca.contact.grid import Grid

Single = NDArray[np.float32]

# Steps in single precision let the displacement drift; it is computed anew after so many of them.
REFRESH = 25
# A search along a projected step shorter than this part of it is worth doing, a longer one is not: taking the
# whole step sets the cells that reach a bound exactly on it.
WHOLE_STEP = 0.5
# Pressures below this part of the largest one move nothing by more than single precision resolves.
DUST = 1e-8
TINY = float(np.finfo(np.float64).tiny)
# BLAS starts threads for products of vectors from this length.
THREADED_BLAS = 10_000


def dot(one: NDArray[Any], other: NDArray[Any]) -> float:
    """Scalar product; large ones without BLAS, whose threads wait for each other on a busy machine."""
    if one.size < THREADED_BLAS:
        return float(np.vdot(one, other))
    return float(np.einsum("ij,ij->", one, other))


@dataclass(frozen=True)
class Judgement:
    """How far a pressure is from solving its problem.

    Parameters
    ----------
    approach : float [mm]
        Mean of u + h over the cells strictly between the bounds, or as prescribed.
    residual : float
        Largest of: mean excess where the pressure is between the bounds, weighted with it; deepest penetration
        where the pressure is zero; widest gap where it is at the cap. All over the approach.
    free : (nx, ny) array of bool
        Cells between the bounds, and cells that the excess pushes off a bound.
    """

    approach: float
    residual: float
    free: Mask


def judge(grid: Grid, pressure: Array, excess: Array) -> Judgement:
    """Check the Kuhn-Tucker conditions; turns ``excess``, given as u + h, into u + h - approach in place."""
    inner = loaded = pressure > grid.slack
    capped: Mask | None = None
    if not math.isinf(grid.cap):
        capped = pressure >= grid.limit - grid.slack
        inner = loaded & ~capped
    approach = grid.approach if grid.total is None else _mean_level(excess, loaded, inner, capped)
    excess -= approach
    free = inner | (excess < 0.0)
    widest = 0.0
    misfit = np.abs(excess)
    if capped is not None:
        widest = float(excess[capped].max(initial=0.0))
        free = free & ~capped | (capped & (excess > 0.0))
        misfit *= inner
    deepest = -float(excess[free & ~loaded].min(initial=0.0))
    weighted = dot(pressure, misfit) / max(float(pressure.sum()), TINY)
    residual = max(weighted, deepest, widest) / approach if approach > 0.0 else np.inf
    return Judgement(approach, residual, free)


def _mean_level(level: Array, loaded: Mask, inner: Mask, capped: Mask | None) -> float:
    """Approach that fits u + h best; with every cell at a bound any value between two limits is right."""
    count = np.count_nonzero(inner)
    if count or capped is None:
        return float((level * inner).sum() / count)
    lower = float(level[capped].max())
    return 0.5 * (lower + float(level[~loaded].min(initial=2.0 * np.abs(level).max() - lower)))


class Descent:
    """Projected conjugate gradients on one grid; :meth:`run` goes on from where it stands.

    Directions and their convolutions are in single precision, relative to the approach: they correct a
    displacement that is computed in double precision, so their rounding errors shrink with the residual.

    Parameters
    ----------
    grid : Grid
        The problem.
    pressure : (nx, ny) array [mm]
        Start, within the bounds and with the right sum.
    displacement : (nx, ny) array [mm], optional
        K times the start, if known.
    threads : int
        Threads of a transform.
    exact : bool
        Whether the displacement of the start is computed in double precision; else its errors, some 1e-7 of the
        approach, stay in it until the next refreshment.

    References
    ----------
    Polonsky & Keer 1999, Wear 231, 206-219 (conjugate gradients under the load constraint); Vollebregt 2014,
    J. Comput. Phys. 257, 333-351 (Fourier preconditioner).
    """

    def __init__(
        self,
        grid: Grid,
        pressure: Array,
        displacement: Array | None = None,
        threads: int = 2,
        exact: bool = True,
    ) -> None:
        shape = pressure.shape
        self.grid = grid
        self.pressure = pressure
        self.iterations = self.convolutions = 0
        self._threads = threads
        self._fast = grid.operator(dtype="float32", threads=threads)
        self._precondition = Preconditioner(shape, grid.aspect, threads)
        self._cover_root = None if grid.cover is None else np.sqrt(grid.cover).astype(np.float32)
        self._displacement = displacement if displacement is not None else self._displaced(exact)
        self._excess = np.empty(shape)
        self._scale = 0.0
        self._direction = np.zeros(shape, dtype=np.float32)
        self._image = np.empty(shape, dtype=np.float32)
        self._last: tuple[Single, float] | None = None

    def run(self, tolerance: float, limit: int) -> Judgement:
        """Iterate until the residual is below the tolerance or ``limit`` iterations are done."""
        for step in range(limit + 1):
            np.add(self._displacement, self.grid.gap, out=self._excess)
            state = judge(self.grid, self.pressure, self._excess)
            if state.residual <= tolerance or step == limit:
                break
            self._scale = state.approach if state.approach > 0.0 else float(np.abs(self._displacement).max())
            self._iterate(state.free)
            self.iterations += 1
            if (step + 1) % REFRESH == 0:
                self._displacement = self._displaced(exact=True)
                self._last = None
        return state

    def _displaced(self, exact: bool) -> Array:
        """Displacement of the pressure, in double precision or in single."""
        self.convolutions += 1
        operator = self.grid.operator(threads=self._threads) if exact else self._fast
        return operator(self.pressure, np.empty(self.pressure.shape))

    def _convolved(self, values: Single) -> Array:
        """Displacement of values in single precision; it stands until the next is asked for."""
        self.convolutions += 1
        return self._fast(values, self._image)

    def settle(self) -> Array:
        """Take the rounding errors of the steps off the sum of the pressures; return these."""
        self.pressure = self.grid.clip(self.pressure, (self.pressure > 0.0) & (self.pressure < self.grid.limit))
        return self.pressure

    def _iterate(self, free: Mask) -> None:
        """One step along the conjugate direction, projected where it leaves the bounds."""
        residual = (self._excess * (1.0 / self._scale)).astype(np.float32)
        direction = self._conjugate(self._level(residual, free), free)
        image = self._convolved(direction)
        curvature = dot(direction, image)
        if not curvature > 0.0:
            self._last = None
            return
        length = self._scale * dot(direction, residual) / curvature
        trial = self.pressure - length * direction
        if float(trial.min()) >= 0.0 and (math.isinf(self.grid.cap) or bool((trial <= self.grid.limit).all())):
            self.pressure = trial
            self._displacement -= length * image
        elif not self._move(self.grid.clip(trial, free)):
            self._last = None
            if not self._drop_dust():
                self._project_gradient(residual, free)

    def _conjugate(self, residual: Single, free: Mask) -> Single:
        """Direction of Polak and Ribiere from the preconditioned residual; a restart where it does not descend."""
        root = self._cover_root  # cut cells are about so much stiffer, the part being its square
        preconditioned = self._precondition(residual if root is None else root * residual, np.empty_like(residual))
        if root is not None:
            preconditioned *= root
        self._level(preconditioned, free)
        descent = dot(preconditioned, residual)
        direction = self._direction
        if self._last is None:
            direction[:] = preconditioned
        else:
            ahead = descent - dot(preconditioned, self._last[0])
            direction *= np.float32(max(0.0, ahead / self._last[1]))
            direction += preconditioned
            self._level(direction, free)
            if not dot(direction, residual) > 0.0:
                direction[:] = preconditioned
        self._last = (residual, descent) if descent > 0.0 else None
        return direction

    def _level(self, values: Single, free: Mask) -> Single:
        """Leave nothing outside the free cells; with a given sum, take the mean off them, so that the sum stays."""
        values *= free
        if self.grid.total is not None:
            values -= np.float32(values.sum(dtype=np.float64) / np.count_nonzero(free))
            values *= free
        return values

    def _move(self, target: Array) -> bool:
        """Go towards a pressure within the bounds as far as the energy falls; False if it does not fall at all."""
        step = ((target - self.pressure) / self._scale).astype(np.float32)
        image = self._convolved(step)
        slope = dot(step, self._excess) / self._scale
        curvature = dot(step, image)
        if not (slope < 0.0 < curvature):
            return False
        best = -slope / curvature
        if best < WHOLE_STEP:
            self.pressure = self.pressure + best * (target - self.pressure)
            self._displacement += (best * self._scale) * image
        else:
            self.pressure = target
            self._displacement += self._scale * image
        return True

    def _drop_dust(self) -> bool:
        """Set pressures to zero that are next to none over an open gap; False if there are none.

        What that gains is lost in the rounding of single precision, so that no step would find it.
        """
        dust = (self._excess > 0.0) & (self.pressure > 0.0) & (self.pressure < DUST * self.pressure.max())
        self.pressure = np.where(dust, 0.0, self.pressure)
        return bool(dust.any())

    def _project_gradient(self, residual: Single, free: Mask) -> None:
        """One projected step down the plain gradient, which always descends."""
        image = self._convolved(residual)
        curvature = dot(residual, image)
        if curvature > 0.0:
            length = self._scale * dot(residual, residual) / curvature
            self._move(self.grid.project(self.pressure - length * residual, free))
