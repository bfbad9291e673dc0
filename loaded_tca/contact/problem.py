"""A contact problem in the units of the user, on the grid of one level."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arrays import Array
from loaded_tca.contact.columns import in_grid_units, merge_columns
from loaded_tca.contact.convolution import Window
from loaded_tca.contact.descent import AT_BOUND, Grid
from loaded_tca.contact.edges import FreeEdge, amplification, mirrors
from loaded_tca.contact.levels import coarsen
from loaded_tca.contact.love import influence_coefficients

Spacing = tuple[float, float]

# Gaps are cut at this multiple of the largest that could close, to stay far from the limits of single precision.
OUT_OF_REACH = 2.0


@dataclass(frozen=True)
class Problem:
    """What is asked for, on the grid of one level; immutable, as its cached properties need.

    Parameters
    ----------
    gap : (nx, ny) array [mm]
        Gap before loading, its smallest value zero on the finest level, infinite where there is no material.
    spacing : (float, float) [mm]
        Width of a cell.
    contact_modulus : float [MPa]
        E*.
    load : float or None [N]
        Normal load; None if the approach is prescribed.
    approach : float [mm]
        Prescribed approach, counted as ``gap`` is; of no meaning if the load is given.
    max_pressure : float [MPa]
        Cap on the pressure, infinity if there is none.
    threads : int
        Threads of a transform.
    free_edges : tuple of FreeEdge
        Where the bodies end beside the contact.
    columns : (ny, ny) array [mm/N], optional
        What yields beneath the half-spaces: displacement of every column of cells under a unit force on each.
    """

    gap: Array
    spacing: Spacing
    contact_modulus: float
    load: float | None
    approach: float
    max_pressure: float
    threads: int
    free_edges: tuple[FreeEdge, ...] = ()
    columns: Array | None = None

    @property
    def unit(self) -> float:
        """Pressure of the grid (p dx/E*) for 1 MPa [mm/MPa]."""
        return self.spacing[0] / self.contact_modulus

    def grid(self, window: Window | None = None) -> Grid:
        """The problem in the terms of :class:`Grid`, on the whole grid or on a window of it."""
        gap = self.gap if window is None else self.gap[window]
        total = None if self.load is None else self.load / (self.spacing[1] * self.contact_modulus)
        gap = np.minimum(gap, OUT_OF_REACH * self.reach)
        edges = mirrors(self.free_edges, self.spacing, window)
        columns = in_grid_units(self.columns, window, self.spacing, self.contact_modulus)
        cap = self.max_pressure * self.unit
        return Grid(gap, self.spacing[1] / self.spacing[0], total, self.approach, cap, edges, columns)

    @cached_property
    def reach(self) -> float:
        """Gap beyond which no cell can touch [mm].

        No displacement exceeds that of the whole load on one cell, and some cell below the cap has a gap of at
        most the (k + 1)-th smallest, k the number of cells that the load could fill to the cap: the approach is
        at most the sum of both.
        """
        if self.load is None:
            return self.approach
        own = float(influence_coefficients((1, 1), self.spacing[1] / self.spacing[0])[0, 0])
        farthest = amplification(self.free_edges) * own * self.load / (self.spacing[1] * self.contact_modulus)
        if self.columns is not None:
            farthest += float(np.abs(self.columns).max()) * self.load
        full = int(self.load / (self.max_pressure * self.spacing[0] * self.spacing[1]))
        if not full:
            return farthest + float(self.gap.min())
        rank = min(full, int(np.isfinite(self.gap).sum()) - 1)
        return farthest + float(np.partition(self.gap.ravel(), rank)[rank])

    @cached_property
    def reachable(self) -> NDArray[np.bool_]:
        """Cells that might touch."""
        return self.gap <= self.reach

    def coarser(self, merge: tuple[int, int]) -> "Problem":
        """The same problem on the next coarser grid."""
        spacing = (self.spacing[0] * merge[0], self.spacing[1] * merge[1])
        gap = np.where(self.reachable, self.gap, np.inf)
        columns = merge_columns(self.columns, merge[1])
        return replace(self, gap=coarsen(gap, merge), spacing=spacing, columns=columns)

    def fitted(self, pressure: Array) -> Array:
        """A pressure within the bounds and with the load of the problem, none where there is no material."""
        pressure = np.where(self.reachable, np.minimum(pressure, self.max_pressure), 0.0)
        if self.load is None:
            return pressure
        if not pressure.any():
            pressure = self.reachable.astype(np.float64)
        pressure *= self.load / (float(pressure.sum()) * self.spacing[0] * self.spacing[1])
        if pressure.max() > self.max_pressure:
            unit = self.unit
            pressure = self.grid().clip(pressure * unit, self.reachable) / unit
        return pressure

    def in_user_units(self, pressure: Array) -> Array:
        """Pressure of the grid in MPa; what is at the cap but for rounding there is exactly at the cap here."""
        if np.isinf(self.max_pressure):
            return np.asarray(pressure / self.unit)
        capped = pressure >= (1.0 - AT_BOUND) * self.max_pressure * self.unit
        return np.where(capped, self.max_pressure, np.minimum(pressure / self.unit, self.max_pressure))
