"""Contact problems as the user states them: on an even grid, and on columns of unlike widths."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, numbers, real
from loaded_tca.contact import checks
from loaded_tca.contact.cuts import limits
from loaded_tca.contact.edges import FreeEdge, check_edges, check_even, without_material_beyond
from loaded_tca.contact.love import own_coefficient

Spacing = tuple[float, float]


@dataclass(frozen=True, eq=False)
class HalfSpaces:
    """Two elastic half-spaces and the gap between them: what problems on all grids have.

    Parameters
    ----------
    gap : (nx, ny) array [mm]
    """

    gap: Array

    def _set(self, **values: Any) -> None:
        """Set attributes as checked; arrays cannot be written to from here on."""
        for name, value in values.items():
            if isinstance(value, np.ndarray):
                value.flags.writeable = False
            object.__setattr__(self, name, value)

    def __reduce__(self) -> tuple[Any, ...]:
        """Made anew by pickle and copy: arrays of theirs could be written to."""
        return type(self), tuple(getattr(self, entry.name) for entry in fields(self))

    @cached_property
    def first_contact(self) -> float:
        """Smallest gap [mm]: the approach at which the load begins."""
        return float(self.gap.min())

    @property
    def cells(self) -> tuple[int, int]:
        """Cells along the two axes."""
        return self.gap.shape[0], self.gap.shape[1]


@checked
@dataclass(frozen=True, eq=False)
class ContactProblem(HalfSpaces):
    """Two elastic half-spaces that a load, or a prescribed approach, brings together over a gap.

    Everything is checked when it is made. Its arrays are copies that cannot be written to.

    Parameters
    ----------
    gap : (nx, ny) array_like [mm]
        Gap between the surfaces before loading; +inf where there is no material, as it becomes beyond free edges.
    spacing : (float, float) [mm]
        Width of a cell along the first and the second axis; the limits of sizes are in ``contact.checks``.
    contact_modulus : float [MPa]
        E*, 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2.
    load : float, optional [N]
        Normal load, not negative.
    approach : float, optional [mm]
        Approach of the bodies, counted as ``gap`` is. Exactly one of load and approach has to be given.
    max_pressure : float, optional [MPa]
        Cap on the pressure: elastic, perfectly plastic surface.
    free_edges : sequence of FreeEdge
        Where the bodies end beside the contact. Without ``cover`` cells whose middle lies beyond carry nothing.
    slice_compliance : (ny, ny) array_like [mm/N], optional
        Displacement of every slice (cells of one place along the second axis) under a unit force on each of them, on
        top of that of the half-spaces: bending beneath them spreads the load along the contact.
    cover : (nx, ny) array_like, optional
        Part of every cell that has material, above 0 and at most 1 where the gap is finite; default: whole cells. The
        pressure of a cell is the mean over the whole of it.

    Raises
    ------
    InputError
        With every problem of the arguments.

    Examples
    --------
    >>> problem = ContactProblem([[0.0, 0.1], [0.2, 0.3]], (1.0, 1.0), 115e3, load=10.0)
    >>> problem.gap.flags.writeable
    False
    """

    spacing: Spacing
    contact_modulus: float
    load: float | None = None
    approach: float | None = None
    max_pressure: float | None = None
    free_edges: Sequence[FreeEdge] = ()
    slice_compliance: Array | None = None
    cover: Array | None = None

    def __post_init__(self) -> None:
        gap, slices, cover = numbers("gap", self.gap), self.slice_compliance, self.cover
        slices = None if slices is None else numbers("slice_compliance", slices).copy()
        cover = None if cover is None else numbers("cover", cover)
        checks.raise_if(
            checks.check_grid(gap, self.spacing, self.contact_modulus)
            + (check_edges(self.free_edges) or check_even(self.free_edges))
            + checks.check_slices(slices, gap.shape)
            + checks.check_cover(cover, gap)
        )
        spacing, edges = (float(self.spacing[0]), float(self.spacing[1])), tuple(self.free_edges)
        gap = without_material_beyond(gap.copy(), spacing, edges if cover is None else ())
        there = np.isfinite(gap)
        checks.raise_if([] if there.any() else ["free_edges: no cell within them holds material"])
        cover = None if cover is None or (cover == 1.0)[there].all() else np.where(there, cover, 0.0)
        self._set(gap=gap, spacing=spacing, free_edges=edges, slice_compliance=slices, cover=cover)
        demand, area = (self.load, self.approach, self.max_pressure), math.inf
        if self.max_pressure is not None:
            area = self.material_area
        checks.raise_if(checks.check_demand(*demand, gap, area, spacing, self.contact_modulus))

    @cached_property
    def cap(self) -> float | Array:
        """Largest pressure [MPa], infinity if there is none; of every cell, (nx, ny), where edges cut some."""
        if self.max_pressure is None:
            return math.inf
        return self.max_pressure if self.cover is None else limits(self.max_pressure, self.cover)

    @cached_property
    def cap_is_near(self) -> bool:
        """Whether one cell that took all of the load, or of the approach, would be pressed beyond the cap."""
        if self.max_pressure is None:
            return False
        if self.load is not None:
            most = self.load / self.cell_area
        else:
            assert self.approach is not None
            stiffness = self.contact_modulus / (self.spacing[0] * own_coefficient(self.spacing[1] / self.spacing[0]))
            most = (self.approach - self.first_contact) * stiffness
        least = 1.0 if self.cover is None else float(self.cover[self.cover > 0.0].min())
        return bool(self.max_pressure * least < most)

    @property
    def material_area(self) -> float:
        """Area of the cells that has material [mm^2]."""
        cells = np.count_nonzero(np.isfinite(self.gap)) if self.cover is None else float(self.cover.sum())
        return cells * self.cell_area

    @property
    def cell_area(self) -> float:
        """Area of a cell [mm^2]."""
        return self.spacing[0] * self.spacing[1]


@checked
@dataclass(frozen=True, eq=False)
class GradedProblem(HalfSpaces):
    """Two elastic half-spaces that a load brings together over a gap on columns of unlike widths.

    Everything is checked when it is made. Its arrays are copies that cannot be written to.

    Parameters
    ----------
    gap : (nx, ny) array_like [mm]
        Gap between the surfaces at the middles of the cells before loading; +inf where there is no material.
    spacing : float [mm]
        Length of a cell along the first axis.
    borders : (ny + 1,) array_like [mm]
        Of the columns along the second axis, increasing.
    contact_modulus : float [MPa]
        E*, 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2.
    load : float [N]
        Normal load, not negative.
    max_pressure : float, optional [MPa]
        Cap on the pressure: elastic, perfectly plastic surface.
    slice_compliance : (n, n) array_like [mm/N], optional
        Displacement of every slice under a unit force on each of them, on top of that of the half-spaces.
    slice_axis : {1, 0}
        Axis along which slices follow each other: 1 if each column is a slice, n = ny.
    free_edges : sequence of FreeEdge
        Across the second axis, ``axis`` 1. The gap beyond them is as it is given; columns there give way, and act,
        as the last one before the edge.
    reference : float, optional [mm]
        Place along the second axis, counted as the borders, where a force adds nothing to the displacement beneath it
        by its image; images count in full if absent, and those of edges with ``across``.

    Raises
    ------
    InputError
        With every problem of the arguments.

    Examples
    --------
    >>> problem = GradedProblem([[0.0, 0.1], [0.2, 0.3]], 1.0, [0.0, 1.0, 3.0], 115e3, load=10.0)
    >>> problem.widths.tolist(), problem.middles.tolist()
    ([1.0, 2.0], [0.5, 2.0])
    """

    spacing: float
    borders: Array
    contact_modulus: float
    load: float
    max_pressure: float | None = None
    slice_compliance: Array | None = None
    slice_axis: int = 1
    free_edges: Sequence[FreeEdge] = ()
    reference: float | None = None

    def __post_init__(self) -> None:
        gap, borders, slices = numbers("gap", self.gap), numbers("borders", self.borders), self.slice_compliance
        slices = None if slices is None else numbers("slice_compliance", slices).copy()
        rising = borders.ndim == 1 and borders.size > 1 and bool(np.isfinite(borders).all())
        rising = rising and bool((np.diff(borders) > 0.0).all())
        problems = [] if rising else ["borders: at least two finite numbers, each above the one before, are asked for"]
        if gap.ndim == 2 and borders.ndim == 1 and borders.size != gap.shape[1] + 1:
            problems.append(f"borders: {gap.shape[1]} columns have {gap.shape[1] + 1}, not {borders.size}")
        if self.slice_axis not in (0, 1):
            problems.append(f"slice_axis: {self.slice_axis} is neither 0 nor 1")
        if not problems and gap.ndim == 2 and (memory := checks.columns_memory_problem(*gap.shape)) is not None:
            problems.append(f"gap: {memory}")
        problems += check_edges(self.free_edges) or [
            f"free_edges[{k}].axis: 0 is not 1, across the columns"
            for k, edge in enumerate(self.free_edges)
            if edge.axis == 0
        ]
        if self.reference is not None and not np.isfinite(real(self.reference)):
            problems.append(f"reference: {self.reference} mm is not finite")
        checks.raise_if(problems)
        cell = self.spacing, float(np.diff(borders).min())
        checks.raise_if(
            checks.check_grid(gap, cell, self.contact_modulus)
            + checks.check_slices(slices, (gap.shape[self.slice_axis] if gap.ndim == 2 else 0,))
        )
        self._set(gap=gap.copy(), borders=borders.copy(), slice_compliance=slices)
        area = float(np.isfinite(gap).sum(axis=0) @ self.widths) * self.spacing
        demand = real(self.load), None, self.max_pressure
        checks.raise_if(checks.check_demand(*demand, gap, area, cell, self.contact_modulus))

    @property
    def widths(self) -> Array:
        """Widths of the columns, (ny,) [mm]."""
        return np.diff(self.borders)

    @property
    def middles(self) -> Array:
        """Places of the middles of the columns, (ny,) [mm]."""
        return np.asarray(0.5 * (self.borders[1:] + self.borders[:-1]))

    @property
    def cell_areas(self) -> Array:
        """Areas of the cells of each column, (ny,) [mm^2]."""
        return self.spacing * self.widths
