"""Contact problems in the terms of the iteration: a stack of them on the grids of one level, or on windows of these."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arrays import Array, Mask
from loaded_tca.contact.convolution import ALL, Convolution, Preconditioner, Rows, Window
from loaded_tca.contact.cuts import CutCells, limits
from loaded_tca.contact.edges import FreeEdge, MirroredConvolution, amplification, mirrors
from loaded_tca.contact.levels import coarsen, merged, window_around
from loaded_tca.contact.love import own_coefficient
from loaded_tca.contact.problem import ContactProblem

# Gaps are cut at this multiple of the largest that could close, to stay far from the limits of single precision.
OUT_OF_REACH = 2.0
MOST_PROJECTIONS = 100
# Relative error of the sum of some thousand pressures.
SUMMED = 1e-15
# Parts of cells without material, which divide here, are at least this.
LEAST_COVER = 1e-6
# Part of the cap by which a pressure at a bound may be off it by rounding.
AT_BOUND = 1e-12
# A window around the contact saves more than it costs on grids of more cells than this; smaller ones stay whole, so
# that they can be stacked.
LARGEST_WHOLE = 2048

TINY = float(np.finfo(np.float64).tiny)

Operator = Callable[..., Array]
CELLS = (1, 2)
"""Axes of the cells of a stack."""


def each(values: Sequence[float] | Array) -> Array:
    """One number for each problem, (count, 1, 1), as it goes with arrays (count, nx, ny)."""
    return np.asarray(values, dtype=np.float64)[:, None, None]


def with_cap(pressure: Array, cap: float | Array) -> Array:
    """Pressure that is exactly at the cap where it is there but for rounding."""
    return np.where((pressure > 0.0) & (pressure >= (1.0 - AT_BOUND) * cap), cap, pressure)


def total_of(values: NDArray[Any]) -> NDArray[Any]:
    """Sum over the cells of every problem, (count, 1, 1)."""
    return np.add.reduce(values, axis=CELLS, keepdims=True)


@dataclass(frozen=True, eq=False)
class Grids:
    """A stack of contact problems on grids of one shape: minimise p.Kp/2 + h.p over 0 <= p <= cap, each for itself.

    Pressures are p dx/E* here, a length, so that K depends on the shape of a cell only. What is one number for each
    problem has the shape (count, 1, 1), as it goes with the cells. A load, a cap, slices and cover are given for all
    problems or for none.

    Parameters
    ----------
    gap : (count, nx, ny) array [mm]
        Gap h before loading, its smallest value near 0; infinite, or too large to close, where there is no material.
    spacing : (count, 2) array [mm]
        Width of a cell.
    total : (count, 1, 1) array [mm]
        Sum of the pressures; NaN if the approach is prescribed.
    approach : (count, 1, 1) array [mm]
        Prescribed approach, counted as ``gap`` is; of no meaning if the total is given.
    cap : (count, 1, 1) array [mm]
        Largest pressure, infinity if there is none; of the material of a cut cell, see ``limit``.
    free_edges : tuple of FreeEdge
        Where the bodies end; K holds their images of the pressure too. Of stacks of one only.
    slices : (count, ny, ny) array, optional
        Displacement of every slice under a unit sum of pressures on each, a part of K too.
    start : (int, int)
        First cell on the grid that the free edges are counted on.
    cover : (count, nx, ny) array, optional
        Part of every cell that has material; None: all of it.
    """

    gap: Array
    spacing: Array
    total: Array
    approach: Array
    cap: Array
    free_edges: tuple[FreeEdge, ...] = ()
    slices: Array | None = None
    start: tuple[int, int] = (0, 0)
    cover: Array | None = None

    @classmethod
    def of(cls, problems: Sequence[ContactProblem]) -> Grids:
        """Return the whole finest grids of problems alike, their gaps and approaches counted from first contact."""
        first = problems[0]
        spacing = np.array([problem.spacing for problem in problems])
        modulus, contact, load, approach, cap = (
            each([np.nan if (value := getattr(problem, name)) is None else value for problem in problems])
            for name in ("contact_modulus", "first_contact", "load", "approach", "max_pressure")
        )
        cover, slices = (
            None if getattr(first, name) is None else np.stack([getattr(problem, name) for problem in problems])
            for name in ("cover", "slice_compliance")
        )
        dx, forces = each(spacing[:, 0]), each(spacing[:, 1]) * modulus
        gap = np.empty((len(problems), *first.cells))
        for one, problem in zip(gap, problems, strict=True):
            np.subtract(problem.gap, problem.first_contact, out=one)
        return cls(
            gap=gap,
            spacing=spacing,
            total=load / forces,
            approach=approach - contact,
            cap=cap * (dx / modulus) if first.cap_is_near else np.full(cap.shape, np.inf),
            free_edges=tuple(first.free_edges),
            slices=None if slices is None else slices * forces,
            cover=cover,
        )

    def __len__(self) -> int:
        return len(self.gap)

    def select(self, rows: Rows) -> Grids:
        """Return some of the problems, in ascending order."""
        if rows == ALL if isinstance(rows, slice) else len(rows) == len(self):
            return self
        kept = {name: getattr(self, name) for name in ("gap", "spacing", "total", "approach", "cap", "slices", "cover")}
        return replace(self, **{name: array[rows] for name, array in kept.items() if array is not None})

    @property
    def shape(self) -> tuple[int, int]:
        """Cells along the two axes."""
        return self.gap.shape[1], self.gap.shape[2]

    @property
    def aspects(self) -> Array:
        """dy/dx of the cells, (count,)."""
        return np.asarray(self.spacing[:, 1] / self.spacing[:, 0])

    @cached_property
    def loaded(self) -> bool:
        """Whether loads are given; otherwise they follow from the approach."""
        return not np.isnan(self.total).any()

    @cached_property
    def capped(self) -> bool:
        """Whether the pressures have a cap."""
        return bool(np.isfinite(self.cap).all())

    def sums(self, pressure: Array) -> Array:
        """Sums of pressures that have them right, (count, 1, 1); not zero."""
        return self.total if self.loaded else np.maximum(total_of(pressure), TINY)

    @cached_property
    def slack(self) -> Array | float:
        """Distance from a bound that is a rounding error: a cell that the last digits keep off the cap is at it."""
        return AT_BOUND * self.cap if self.capped else 0.0

    @cached_property
    def limit(self) -> Array:
        """Largest pressure of the cells, (count, 1, 1) or (count, nx, ny)."""
        return self.cap if self.cover is None else limits(self.cap, self.cover)

    @property
    def farthest(self) -> Array:
        """Displacement that no cell exceeds, (count, 1, 1): that of the whole load on one."""
        own = amplification(self.free_edges) * own_coefficient(each(self.aspects))
        if self.slices is not None:
            own = own + np.abs(self.slices).max(axis=CELLS, keepdims=True)
        return np.asarray(self.total * own)

    @cached_property
    def reach(self) -> Array:
        """Gap beyond which no cell can come into contact [mm], (count, 1, 1).

        The approach is at most the sum of gap and displacement of some cell below the cap: one of the lowest sums, as
        many as the load fills to the cap and one more.
        """
        if not self.loaded:
            return self.approach
        most = self.farthest
        if not self.capped and self.cover is None:
            return np.asarray(self.gap.min(axis=CELLS, keepdims=True) + most)
        level = self.gap + (most if self.cover is None else most / np.maximum(self.cover, LEAST_COVER))
        reach = level.min(axis=CELLS, keepdims=True)
        for k in range(len(self)) if self.capped else ():
            order = np.argsort(level[k], axis=None)
            held = np.cumsum(np.broadcast_to(self.limit[k], self.shape).ravel()[order])
            rank = int(np.searchsorted(held, self.total[k, 0, 0], side="right"))
            reach[k] = level[k].ravel()[order[min(rank, np.isfinite(level[k]).sum() - 1)]]
        return np.asarray(reach)

    @cached_property
    def reachable(self) -> Mask:
        """Cells that might come into contact, (count, nx, ny)."""
        return np.asarray(self.gap <= self.reach)

    def part(self, window: Window) -> Grids:
        """Return the problems on a window of the grid, their gaps cut where they are out of reach."""
        rows, columns = window
        gap, most = self.gap[:, rows, columns], OUT_OF_REACH * self.reach
        return replace(
            self,
            gap=gap if (np.maximum.reduce(gap, axis=CELLS, keepdims=True) <= most).all() else np.minimum(gap, most),
            slices=None if self.slices is None else self.slices[:, columns, columns],
            start=(rows.start, columns.start),
            cover=None if self.cover is None else self.cover[:, rows, columns],
        )

    @property
    def whole(self) -> Window:
        """Window of all cells."""
        return slice(0, self.shape[0]), slice(0, self.shape[1])

    def window(self, pressure: Array) -> Window:
        """Return a window around the contact; around all that is in reach where nothing is in contact yet.

        All of a small grid: there only one problem of a stack differs from another.
        """
        if self.shape[0] * self.shape[1] <= LARGEST_WHOLE:
            return self.whole
        pressed = pressure[0] > 0.0
        return window_around(pressed if pressed.any() else self.reachable[0])

    def coarser(self, merge: tuple[int, int]) -> Grids:
        """Return the same problems with so many cells merged along each axis."""
        return replace(
            self,
            gap=coarsen(self.gap, merge, self.reach),
            spacing=self.spacing * merge,
            total=self.total / merge[1],
            cap=self.cap * merge[0],
            slices=None if self.slices is None else merged(self.slices, (merge[1], merge[1])) * merge[1],
            cover=None if self.cover is None else merged(self.cover, merge),
        )

    @cached_property
    def cut_cells(self) -> CutCells | None:
        """Cells that edges of the material cut, if there are some."""
        return None if self.cover is None else CutCells.of(self.cover, self.aspects)

    def operator(self, window: Window | None = None, dtype: str = "float64", threads: int = 2) -> Operator:
        """K for pressures that are zero outside a window, as a function (pressure, out, rows) that returns ``out``.

        The arrays hold the grids of some problems, ``rows``, or of all.
        """
        convolve: Convolution | MirroredConvolution
        if self.free_edges:
            edges = mirrors(self.free_edges, tuple(self.spacing[0].tolist()), self.start)
            convolve = MirroredConvolution(self.shape, self.aspects, edges, window, dtype, threads)
        else:
            convolve = Convolution(self.shape, self.aspects, window, dtype, threads)
        slices = None if self.slices is None else self.slices.astype(dtype, copy=False)
        cuts = None if self.cut_cells is None else self.cut_cells.in_precision(dtype)

        def displaced(pressure: Array, out: Array, rows: Rows = ALL) -> Array:
            convolve(pressure if window is None else pressure[:, *window], out, rows)
            if slices is not None:
                forces = pressure.sum(axis=1, dtype=dtype)
                out += np.matmul(slices[rows], forces[:, :, None])[:, None, :, 0]
            if cuts is not None:
                cuts.add(pressure, out, rows)
            return out

        return displaced

    def preconditioner(self, threads: int = 2) -> Operator:
        """Approximate inverse of K in single precision, as a function like that of ``operator``."""
        return Preconditioner(self.shape, self.aspects, threads)

    def guess(self) -> Array:
        """Return pressures to start from without others: where the gap is below a level, as the root of what it lacks.

        The level is that of a sphere under this load whose contact has as many cells: the approach is twice as much.
        Nothing where the approach is prescribed.
        """
        if not self.loaded:
            return np.zeros(self.gap.shape)
        aspects = each(self.aspects)
        product = 0.375 * self.total * aspects  # of level and radius
        gaps = np.sort(self.gap.reshape(len(self), 1, -1), axis=2)
        radii = np.sqrt(np.arange(1, gaps.shape[2] + 1) * (aspects / np.pi))
        closed = np.count_nonzero(gaps * radii < product, axis=2, keepdims=True)
        level = product / np.sqrt(np.maximum(closed, 1) * (aspects / np.pi))
        return self.fitted(np.sqrt(np.maximum(level - self.gap, 0.0)))

    def fitted(self, pressure: Array) -> Array:
        """Return pressures within the bounds and with the right sums, zero where no contact is possible; in place."""
        if self.capped:
            np.minimum(pressure, self.limit, out=pressure)
        pressure *= self.reachable
        if not self.loaded:
            return pressure
        total = total_of(pressure)
        empty = np.flatnonzero(total == 0.0)
        if empty.size:
            pressure[empty] = self.reachable[empty]
            total[empty] = total_of(pressure[empty])
        pressure *= self.total / total
        above = np.flatnonzero((pressure > self.limit).any(axis=CELLS)) if self.capped else empty[:0]
        if above.size:
            pressure[above] = self.project(pressure[above], self.reachable[above], above)
        return pressure

    def residual_of_cells(self, pressure: Array, excess: Array) -> Array | float:  # noqa: ARG002
        """What the worst cell counts of the residual, by its pressure and u + h - approach; cells alike need none."""
        return 0.0

    def settled(self, pressure: Array) -> Array:
        """Pressures without the rounding errors that steps leave in their sums."""
        return self.clip(pressure, (pressure > 0.0) & (pressure < self.limit))

    def clip(self, pressure: Array, movable: Mask, rows: Rows = ALL) -> Array:
        """Pressures of some of the problems within the bounds and with the right sums; in place without a cap."""
        if self.capped or not self.loaded:
            return self.project(pressure, movable, rows)
        clipped = np.maximum(pressure, 0.0, out=pressure)
        clipped *= self.total[rows] / total_of(clipped)
        return clipped

    def project(self, pressure: Array, movable: Mask, rows: Rows = ALL) -> Array:
        """Nearest pressures of some of the problems within the bounds and with the right sums.

        Only the movable cells move for the sums.
        """
        total, limit = self.total[rows], self.limit[rows]
        projected = np.minimum(np.maximum(pressure, 0.0), limit)
        summed = np.flatnonzero(movable.any(axis=CELLS)) if self.loaded else ()
        if len(summed):
            movable, total = movable[summed], total[summed]
            fixed = np.where(movable, 0.0, projected[summed])
            limit = np.where(movable, np.minimum(limit[summed], total), 0.0)
            projected[summed] = fixed + shifted_to_sum(pressure[summed], total - total_of(fixed), limit, movable)
        return projected


def shifted_to_sum(values: Array, total: Array, cap: Array, movable: Mask) -> Array:
    """Project onto 0 <= p <= cap, sum p = total: p = clip(values - shift), the shift by safeguarded Newton steps.

    Each problem (count, nx, ny) for itself; cells that are not movable have a cap of zero.
    """
    low = np.where(movable, values - cap, np.inf).min(axis=CELLS, keepdims=True)
    high = np.where(movable, values, -np.inf).max(axis=CELLS, keepdims=True)
    shift, searching = np.zeros(low.shape), np.ones(low.shape, dtype=bool)
    for _ in range(MOST_PROJECTIONS):
        projected = np.minimum(np.maximum(values - shift, 0.0), cap)
        surplus = total_of(projected) - total
        searching &= np.abs(surplus) > SUMMED * total
        if not searching.any():
            break
        over = surplus > 0.0
        low, high = np.where(over, shift, low), np.where(over, high, shift)
        inner = np.add.reduce((projected > 0.0) & (projected < cap), axis=CELLS, keepdims=True, dtype=np.float64)
        new = shift + surplus / np.maximum(inner, 1.0)
        new = np.where((low < new) & (new < high) & (inner > 0.0), new, 0.5 * (low + high))
        shift = np.where(searching, new, shift)
    return projected
