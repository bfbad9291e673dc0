"""A contact problem in the terms of the iteration: on the grid of one level, or on a window of it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from loaded_tca.arrays import Array, Mask
from loaded_tca.contact.convolution import Convolution, Window
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
        Largest pressure, infinity if there is none.
    free_edges : tuple of FreeEdge
        Where the bodies end; K holds their images of the pressure too.
    slices : (ny, ny) array, optional
        Displacement of every slice under a unit sum of pressures on each, a part of K too.
    start : (int, int)
        First cell on the grid that the free edges are counted on.
    """

    gap: Array
    spacing: Spacing
    total: float | None
    approach: float
    cap: float
    free_edges: tuple[FreeEdge, ...] = ()
    slices: Array | None = None
    start: tuple[int, int] = (0, 0)

    @classmethod
    def of(cls, problem: ContactProblem) -> Grid:
        """Return the whole finest grid of a problem, its gap and approach counted from first contact."""
        (dx, dy), modulus, slices = problem.spacing, problem.contact_modulus, problem.slice_compliance
        total = None if problem.load is None else problem.load / (dy * modulus)
        approach = 0.0 if problem.approach is None else problem.approach - problem.first_contact
        cap = problem.cap * (dx / modulus)
        # One cell that takes all of the load, or of the approach, has the highest pressure there can be.
        highest = approach / float(influence_coefficients((1, 1), dy / dx)[0, 0]) if total is None else total
        return cls(
            gap=problem.gap - problem.first_contact,
            spacing=problem.spacing,
            total=total,
            approach=approach,
            cap=cap if cap < highest else math.inf,
            free_edges=tuple(problem.free_edges),
            slices=None if slices is None else slices * (dy * modulus),
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
    def reach(self) -> float:
        """Gap beyond which no cell can come into contact [mm].

        No displacement exceeds that of the whole load on one cell, and some cell below the cap has a gap of at
        most the (k + 1)-th smallest, k the number of cells that the load could fill to the cap: the approach is
        at most the sum of both.
        """
        if self.total is None:
            return self.approach
        own = amplification(self.free_edges) * float(influence_coefficients((1, 1), self.aspect)[0, 0])
        most = self.total * (own + (0.0 if self.slices is None else float(np.abs(self.slices).max())))
        if not (full := int(self.total / self.cap)):
            return most + float(self.gap.min())
        rank = min(full, int(np.isfinite(self.gap).sum()) - 1)
        return most + float(np.partition(self.gap.ravel(), rank)[rank])

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
        )

    def window(self, pressure: Array) -> Window:
        """Return a window around the contact; around all that is in reach where nothing is in contact yet."""
        loaded = pressure > 0.0
        return window_around(loaded if loaded.any() else self.reachable)

    def operator(self, window: Window | None = None, dtype: str = "float64", threads: int = 2) -> Operator:
        """K for pressures on a window of the grid, or on all of it; it fills its second argument and returns it."""
        convolve: Convolution | MirroredConvolution
        if self.free_edges:
            edges = mirrors(self.free_edges, self.spacing, self.start)
            convolve = MirroredConvolution(self.shape, self.aspect, edges, window, dtype, threads)
        else:
            convolve = Convolution(self.shape, self.aspect, window, dtype, threads)
        if self.slices is None:
            return convolve
        compliance = (self.slices if window is None else self.slices[:, window[1]]).astype(dtype)

        def over_slices(pressure: Array, out: Array) -> Array:
            convolve(pressure, out)
            out += compliance @ pressure.sum(axis=0, dtype=compliance.dtype)
            return out

        return over_slices

    def fitted(self, pressure: Array) -> Array:
        """Return a pressure within the bounds and with the right sum, zero where no contact is possible."""
        bounded = not math.isinf(self.cap)
        pressure = np.where(self.reachable, np.minimum(pressure, self.cap) if bounded else pressure, 0.0)
        if self.total is None:
            return pressure
        if not pressure.any():
            pressure = self.reachable.astype(np.float64)
        pressure *= self.total / float(pressure.sum())
        return self.project(pressure, self.reachable) if bounded and pressure.max() > self.cap else pressure

    def clip(self, pressure: Array, movable: Mask) -> Array:
        """Pressure within the bounds and with the right sum: scaled where there is no cap, projected otherwise."""
        if self.total is None or not math.isinf(self.cap):
            return self.project(pressure, movable)
        clipped = np.maximum(pressure, 0.0)
        clipped *= self.total / clipped.sum()
        return clipped

    def project(self, pressure: Array, movable: Mask) -> Array:
        """Nearest pressure within the bounds and with the right sum that moves only the movable cells."""
        projected = np.clip(pressure, 0.0, self.cap)
        if self.total is not None and movable.any():
            rest = self.total - float(projected[~movable].sum())
            projected[movable] = shifted_to_sum(pressure[movable], rest, min(self.cap, self.total))
        return projected


def shifted_to_sum(values: Array, total: float, cap: float) -> Array:
    """Project onto 0 <= p <= cap, sum p = total: p = clip(values - shift), the shift by safeguarded Newton steps."""
    low, high = float(values.min()) - cap, float(values.max())
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
