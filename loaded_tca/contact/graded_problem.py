"""Contact problem and solution on columns of unlike widths."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array, numbers, real
from loaded_tca.contact import checks
from loaded_tca.contact.edges import FreeEdge, check_edges
from loaded_tca.contact.solution import ContactStatus

BYTES_PER_PAIR = 48
"""Bytes at the peak of a solve for every pair of columns and cell along them: coefficients, their transform in both
precisions and its inverses, and the same of the coarser grids. Measured: 32 to 39."""


@dataclass(frozen=True, eq=False)
class GradedProblem:
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
        by its image; images count in full if absent.

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

    gap: Array
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
        if not problems and gap.ndim == 2 and (memory := memory_problem(*gap.shape)) is not None:
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
        own = {"gap": gap.copy(), "borders": borders.copy(), "slice_compliance": slices}
        for name, value in own.items():
            if value is not None:
                value.flags.writeable = False
            object.__setattr__(self, name, value)
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
    def cells(self) -> tuple[int, int]:
        """Cells along the two axes."""
        return self.gap.shape[0], self.gap.shape[1]

    @property
    def cell_areas(self) -> Array:
        """Areas of the cells of each column, (ny,) [mm^2]."""
        return self.spacing * self.widths

    @property
    def first_contact(self) -> float:
        """Smallest gap [mm]: the approach at which the load begins."""
        return float(self.gap.min())


@dataclass(frozen=True, eq=False)
class GradedSolution:
    """Pressure and gap of two elastic half-spaces in contact on columns of unlike widths.

    Parameters
    ----------
    pressure : (nx, ny) array [MPa]
        Zero where the surfaces part.
    gap : (nx, ny) array [mm]
        After loading: as given + displacement - approach; infinite where there is no material.
    approach : float [mm]
        Approach of the bodies, counted as the gap that was given.
    iterations, convolutions : int
        On the columns given; the coarser grids before them are not counted.
    residual : float
        Largest violation of the contact conditions, over the approach from first contact.
    status : ContactStatus
        How it ended.
    problem : GradedProblem
        What was solved.
    """

    pressure: Array
    gap: Array
    approach: float
    iterations: int
    convolutions: int
    residual: float
    status: ContactStatus
    problem: GradedProblem

    def __repr__(self) -> str:
        cells = "x".join(str(n) for n in self.pressure.shape)
        return (
            f"GradedSolution({cells} cells, load {self.load:.6g} N, approach {self.approach:.6g} mm, "
            f"peak {self.pressure.max():.6g} MPa, {self.status.name.lower()}, residual {self.residual:.1e})"
        )

    @property
    def load(self) -> float:
        """Sum of the pressures [N]."""
        return float(self.pressure.sum(axis=0) @ self.problem.cell_areas)

    @property
    def approach_under_load(self) -> float:
        """Approach [mm] from first contact on."""
        return self.approach - self.problem.first_contact


def memory_problem(rows: int, columns: int, available: float | None = None) -> str | None:
    """Return what to say if columns need more memory than the machine has."""
    needed = float(BYTES_PER_PAIR) * (rows + 1.0) * float(columns) ** 2
    limit = checks.machine_memory() if available is None else available
    if needed <= limit:
        return None
    return f"{columns} columns of {rows} cells need {needed / 2**30:.3g} GiB, the machine has {limit / 2**30:.3g} GiB"
