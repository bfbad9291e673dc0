"""A contact problem in the terms of the iteration: on the grid of one level, or on a window of it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from loaded_tca.arrays import Array, Mask
from loaded_tca.contact.convolution import Convolution, Window
from loaded_tca.contact.cuts import CutCells, is_cut, limits, merged_cover
from loaded_tca.contact.edges import FreeEdge, MirroredConvolution, amplification, mirrors
from loaded_tca.contact.levels import coarsen, window_around
from loaded_tca.contact.love import influence_coefficients
from loaded_tca.contact.problem import ContactProblem, Spacing
from loaded_tca.contact.slices import merge_slices

Operator = Callable[[Array, Array], Array]

# Gaps are cut at this multiple of the largest that could close, to stay far from the limits of single precision.
OUT_OF_REACH = 2.0
MOST_PROJECTIONS = 100
# Relative error of the sum of some thousand pressures.
SUMMED = 1e-15
# Parts of cells without material, which divide here, are at least this.
LEAST_COVER = 1e-6
# Part of the cap by which a pressure at a bound may be off it by rounding.
AT_BOUND = 1e-12


@dataclass(frozen=True, eq=False)
class Grid:
    """A contact problem on one grid: minimise p.Kp/2 + h.p over 0 <= p <= cap.

    Pressures are p dx/E* here, a length, so that K depends on the shape of a cell only.

    Parameters
    ----------
    gap : (nx, ny) array [mm]
        Gap h before loading, its smallest value near 0; infinite, or too large to close, where there is no material.
    spacing : (float, float) [mm]
        Width of a cell.
    total : float or None [mm]
        Sum of the pressures; None if the approach is prescribed.
    approach : float [mm]
        Prescribed approach, counted as ``gap`` is; of no meaning if the total is given.
    cap : float [mm]
        Largest pressure, infinity if there is none; of the material of a cut cell, see ``limit``.
    free_edges : tuple of FreeEdge
        Where the bodies end; K holds their images of the pressure too.
    slices : (ny, ny) array, optional
        Displacement of every slice under a unit sum of pressures on each, a part of K too.
    start : (int, int)
        First cell on the grid that the free edges are counted on.
    cover : (nx, ny) array, optional
        Part of every cell that has material; None: all of it.
    """

    gap: Array
    spacing: Spacing
    total: float | None
    approach: float
    cap: float
    free_edges: tuple[FreeEdge, ...] = ()
    slices: Array | None = None
    start: tuple[int, int] = (0, 0)
    cover: Array | None = None

    @classmethod
    def of(cls, problem: ContactProblem) -> Grid:
        """Return the whole finest grid of a problem, its gap and approach counted from first contact."""
        (dx, dy), modulus, slices = problem.spacing, problem.contact_modulus, problem.slice_compliance
        total = None if problem.load is None else problem.load / (dy * modulus)
        approach = 0.0 if problem.approach is None else problem.approach - problem.first_contact
        cap = math.inf if problem.max_pressure is None else problem.max_pressure * (dx / modulus)
        # One cell that takes all of the load, or of the approach, has the highest pressure there can be.
        highest = approach / float(influence_coefficients((1, 1), dy / dx)[0, 0]) if total is None else total
        if problem.cover is not None:
            highest /= float(problem.cover[problem.cover > 0.0].min())
        return cls(
            gap=problem.gap - problem.first_contact,
            spacing=problem.spacing,
            total=total,
            approach=approach,
            cap=cap if cap < highest else math.inf,
            free_edges=tuple(problem.free_edges),
            slices=None if slices is None else slices * (dy * modulus),
            cover=problem.cover,
        )

    @property
    def shape(self) -> tuple[int, int]:
        """Cells along the two axes."""
        return self.gap.shape[0], self.gap.shape[1]

    @property
    def aspect(self) -> float:
        """dy/dx of a cell."""
        return self.spacing[1] / self.spacing[0]

    @property
    def slack(self) -> float:
        """Distance from a bound that is a rounding error: a cell that the last digits keep off the cap is at it."""
        return 0.0 if math.isinf(self.cap) else AT_BOUND * self.cap

    @cached_property
    def limit(self) -> float | Array:
        """Largest pressure of the cells."""
        return self.cap if self.cover is None or math.isinf(self.cap) else limits(self.cap, self.cover)

    @cached_property
    def reach(self) -> float:
        """Gap beyond which no cell can come into contact [mm].

        No displacement of a cell exceeds that of the whole load on it. The approach is at most the sum of its gap and
        that displacement for some cell below the cap: one of the lowest sums, as many as the load fills to the cap and
        one more.
        """
        if self.total is None:
            return self.approach
        own = amplification(self.free_edges) * float(influence_coefficients((1, 1), self.aspect)[0, 0])
        most = self.total * (own + (0.0 if self.slices is None else float(np.abs(self.slices).max())))
        sums = self.gap + (most if self.cover is None else most / np.maximum(self.cover, LEAST_COVER))
        if math.isinf(self.cap):
            return float(sums.min())
        order = np.argsort(sums, axis=None)
        held = np.cumsum(np.broadcast_to(self.limit, self.shape).ravel()[order])
        rank = min(int(np.searchsorted(held, self.total, side="right")), int(np.isfinite(sums).sum()) - 1)
        return float(sums.ravel()[order[rank]])

    @cached_property
    def reachable(self) -> Mask:
        """Cells that might come into contact."""
        return np.asarray(self.gap <= self.reach)

    def part(self, window: Window) -> Grid:
        """Return the problem on a window of the grid, its gap cut where it is out of reach."""
        rows, columns = window
        return replace(
            self,
            gap=np.minimum(self.gap[window], OUT_OF_REACH * self.reach),
            slices=None if self.slices is None else self.slices[columns, columns],
            start=(rows.start, columns.start),
            cover=None if self.cover is None or not is_cut(self.cover[window]).any() else self.cover[window],
        )

    def coarser(self, merge: tuple[int, int]) -> Grid:
        """Return the same problem with so many cells merged along each axis."""
        slices = self.slices
        if slices is not None and merge[1] == 2:
            slices = merge_slices(slices) * 2.0
        return replace(
            self,
            gap=coarsen(np.where(self.reachable, self.gap, np.inf), merge),
            spacing=(self.spacing[0] * merge[0], self.spacing[1] * merge[1]),
            total=None if self.total is None else self.total / merge[1],
            cap=self.cap * merge[0],
            slices=slices,
            cover=None if self.cover is None else merged_cover(self.cover, merge),
        )

    def window(self, pressure: Array) -> Window:
        """Return a window around the contact; around all that is in reach where nothing is in contact yet."""
        loaded = pressure > 0.0
        return window_around(loaded if loaded.any() else self.reachable)

    @cached_property
    def _cut_cells(self) -> CutCells:
        assert self.cover is not None
        return CutCells.of(self.cover, self.aspect)

    def operator(self, window: Window | None = None, dtype: str = "float64", threads: int = 2) -> Operator:
        """K for pressures on a window of the grid, or on all of it; it fills its second argument and returns it."""
        convolve: Convolution | MirroredConvolution
        if self.free_edges:
            edges = mirrors(self.free_edges, self.spacing, self.start)
            convolve = MirroredConvolution(self.shape, self.aspect, edges, window, dtype, threads)
        else:
            convolve = Convolution(self.shape, self.aspect, window, dtype, threads)
        cuts = None if self.cover is None else self._cut_cells.operator(window, dtype)
        if self.slices is None and cuts is None:
            return convolve
        slices = self.slices
        if slices is not None:
            slices = (slices if window is None else slices[:, window[1]]).astype(dtype)

        def displaced(pressure: Array, out: Array) -> Array:
            convolve(pressure, out)
            if slices is not None:
                out += slices @ pressure.sum(axis=0, dtype=slices.dtype)
            if cuts is not None:
                cuts(pressure, out)
            return out

        return displaced

    def fitted(self, pressure: Array) -> Array:
        """Return a pressure within the bounds and with the right sum, zero where no contact is possible."""
        bounded = not math.isinf(self.cap)
        pressure = np.where(self.reachable, np.minimum(pressure, self.limit) if bounded else pressure, 0.0)
        if self.total is None:
            return pressure
        if not pressure.any():
            pressure = self.reachable.astype(np.float64)
        pressure *= self.total / float(pressure.sum())
        return self.project(pressure, self.reachable) if bounded and (pressure > self.limit).any() else pressure

    def clip(self, pressure: Array, movable: Mask) -> Array:
        """Pressure within the bounds and with the right sum: scaled where there is no cap, projected otherwise."""
        if self.total is None or not math.isinf(self.cap):
            return self.project(pressure, movable)
        clipped = np.maximum(pressure, 0.0)
        clipped *= self.total / clipped.sum()
        return clipped

    def project(self, pressure: Array, movable: Mask) -> Array:
        """Nearest pressure within the bounds and with the right sum that moves only the movable cells."""
        projected = np.clip(pressure, 0.0, self.limit)
        if self.total is not None and movable.any():
            rest = self.total - float(projected[~movable].sum())
            limit = np.broadcast_to(np.minimum(self.limit, self.total), self.shape)[movable]
            projected[movable] = shifted_to_sum(pressure[movable], rest, limit)
        return projected


def shifted_to_sum(values: Array, total: float, cap: float | Array) -> Array:
    """Project onto 0 <= p <= cap, sum p = total: p = clip(values - shift), the shift by safeguarded Newton steps."""
    low, high = float((values - cap).min()), float(values.max())
    shift = 0.0
    for _ in range(MOST_PROJECTIONS):
        projected = np.clip(values - shift, 0.0, cap)
        surplus = float(projected.sum()) - total
        if abs(surplus) <= SUMMED * total:
            break
        low, high = (shift, high) if surplus > 0.0 else (low, shift)
        inner = np.count_nonzero((projected > 0.0) & (projected < cap))
        shift = shift + surplus / inner if inner else low
        if not low < shift < high:
            shift = 0.5 * (low + high)
    return projected
