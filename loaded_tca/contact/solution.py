"""What the contact solver returns, and when its iterations stop."""

from __future__ import annotations

import enum
import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Literal, Self

import numpy as np

from loaded_tca.arrays import Array, Mask
from loaded_tca.contact import patch
from loaded_tca.contact.levels import prolong
from loaded_tca.contact.problem import ContactProblem, GradedProblem, HalfSpaces, Spacing
from loaded_tca.contact.slope_jumps import growth, largest_slope_jump
from loaded_tca.errors import ConvergenceError
from loaded_tca.notebooks import InNotebooks
from loaded_tca.plain import plain

# Fewer cells than this across a contact leave errors above 1 % in its pressure.
FEWEST_CELLS = 8
LARGE_ERROR = 0.03
"""Estimated error of the peak above which a solution has a warning: ellipses reach it with 9 cells across, and 1 % with
10; a rough ball with 8 cells for the shortest wave of its roughness has 1 %, too."""
# Error of the peak times the square of the cells across the contact, at the most: 0.3 for ellipses
# (docs/how_it_works/contact_solver.md), 0.6 on a bevel pair whose curvature changes along the contact. Two grids may
# agree by chance: no estimate is below it.
LEAST_ERROR = 0.6
# Error of the peak over its change from the coarser grid, which has four times the error; and, at the most, over that
# change and the largest one beside the peak, where the curvature of the gap jumps and the error falls with the cell
# (validation/loaded/error_estimates.py). Where two grids agree by chance there, the change before theirs tells: an
# eighth of it is half of theirs if the error falls with the square of the cell.
SECOND_ORDER = 1.0 / 3.0
MOST_OF_CHANGE, MOST_OF_CHANGE_BESIDE, MOST_OF_CHANGE_BEFORE = 0.4, 0.5, 0.15
# Growth of the pressure with every halving of the cells, over the largest, that makes nothing of it: 17 halvings lead
# from a hundredth of a millimetre to the size of atoms.
LEAST_GROWTH = 1e-3
# What a halving may add beside a jump of the slope, over its mean: a cell amidst which the jump lies has more pressure
# than one at whose border it lies, by as much as a halving adds.
MOST_OF_GROWTH = 2.0
# Coarse cells either way of the largest one that tell the pressure expected in the fine cells about it: one beside it,
# one more between which is interpolated, two from which the square is continued beyond the contact.
NEAR_PEAK = 4


MOST_ITERATIONS = 500
"""On one grid. Rough surfaces need about a hundred, smooth ones less than ten."""
MOST_CHECKS = 20
"""On the whole grid; every one that fails widens the window or starts from an exact displacement."""
COARSE_FACTOR, COARSE_TOLERANCE = 2.0, 1e-3
"""A coarse grid is solved so much less closely than the next finer one, and no less closely than that: as closely costs
as much as it brings, four times less closely (as its own error is larger) brings an iteration more on the finest grid
of a smooth contact."""
RESERVE = 0.8
"""Of the tolerance, at which the iteration stops, so that the check in double precision finds it kept."""

OnFailure = Literal["raise", "return"]


class ContactStatus(enum.Enum):
    """How a solution ended; the value is the sentence for the user."""

    CONVERGED = "The contact conditions hold on the whole grid within the tolerance."
    NO_LOAD = "No load is carried: the surfaces are in contact in a point at most."
    NOT_CONVERGED = "The iteration ended before the contact conditions held within the tolerance."


@dataclass(frozen=True)
class ErrorEstimate:
    """Relative discretisation errors, from the two finest grids; NaN where there was one grid only.

    Parameters
    ----------
    peak_pressure : float
        Hardly ever exceeded: half of the largest change of pressure from the coarser grid in the cells about the peak,
        0.15 of that change between the two grids before, 0.4 of the change of the peak, or 0.6 over the square of the
        cells across, whichever is largest. Where the pressure has no limit, all of the change of the largest cell, and
        at least twice what a halving of the cells adds beside a jump of the slope.
    approach : float
        The change of the approach from the coarser grid.
    second_order : float
        That of the peak if it falls with the square of the cell, as where the curvature of the gap does not jump: a
        third of the change of the peak, at least 0.6 over the square of the cells across.
    """

    peak_pressure: float
    approach: float
    second_order: float


@dataclass(frozen=True, eq=False)
class CoarserGrid:
    """A solution on the next coarser grid and that on the grid itself, for the error estimate.

    Parameters
    ----------
    pressure : (mx, my) array [MPa]
        On the coarser grid, of twice the spacing along both axes or one of them; not zero everywhere.
    finer : (nx, ny) array [MPa]
        On the grid.
    approach_change : float
        Relative change of the approach between them.
    change_before : float
        ``change_beside_peak`` of the coarser grid against the one before it; zero if there was none.
    """

    pressure: Array
    finer: Array
    approach_change: float
    change_before: float = 0.0

    @cached_property
    def change_of_largest(self) -> float:
        """Relative change of the largest cell."""
        return abs(float(self.finer.max() / self.pressure.max()) - 1.0)

    @cached_property
    def change_of_peak(self) -> float:
        """Relative change of the peak, found between the cells."""
        fine, coarse = patch.peak_pressure(self.finer), patch.peak_pressure(self.pressure)
        return abs(fine - coarse) / fine

    @cached_property
    def change_beside_peak(self) -> float:
        """Largest change of pressure in the cells about the largest one, over it."""
        merge = tuple(2 if 2 * m <= n + 1 else 1 for m, n in zip(self.pressure.shape, self.finer.shape, strict=True))
        top = [int(k) for k in np.unravel_index(int(self.finer.argmax()), self.finer.shape)]
        first = [max(0, k // m - NEAR_PEAK) for k, m in zip(top, merge, strict=True)]
        last = [k // m + NEAR_PEAK + 1 for k, m in zip(top, merge, strict=True)]
        coarse = self.pressure[first[0] : last[0], first[1] : last[1]]
        fine = self.finer[merge[0] * first[0] : merge[0] * last[0], merge[1] * first[1] : merge[1] * last[1]]
        expected = prolong(coarse, (fine.shape[0], fine.shape[1]), (merge[0], merge[1]))
        places = [k - m * start for k, m, start in zip(top, merge, first, strict=True)]
        beside = tuple(slice(max(0, k - 1), k + 2) for k in places)
        return float(np.abs(expected[beside] - fine[beside]).max() / self.finer[top[0], top[1]])


@dataclass(frozen=True, eq=False)
class Solution:
    """Pressure and gap of two elastic half-spaces in contact, on whatever grid.

    Parameters
    ----------
    pressure : (nx, ny) array [MPa]
        Contact pressure, zero where the surfaces part; the mean over the whole cell where an edge cuts it.
    gap : (nx, ny) array [mm]
        Gap after loading: as given + displacement - approach; infinite where there is no material.
    approach : float [mm]
        Approach of the bodies, counted as the gap that was given.
    load : float [N]
        Sum of the pressures.
    iterations, convolutions : int
        On the grid given; the coarser ones before it are not counted.
    residual : float
        Largest violation of the contact conditions on the whole grid, over the approach from first contact.
    status : ContactStatus
        How it ended.
    problem : ContactProblem or GradedProblem
        What was solved.
    """

    WAY_OUT: ClassVar = "try a larger tolerance (in scenes: analysis.tolerance), or on_failure='return'"

    pressure: Array
    gap: Array
    approach: float
    load: float
    iterations: int
    convolutions: int
    residual: float
    status: ContactStatus
    problem: HalfSpaces

    @classmethod
    def without_load(cls, problem: HalfSpaces, approach: float) -> Self:
        """Zero pressure at an approach."""
        return cls(
            pressure=np.zeros(problem.cells),
            gap=problem.gap - approach,
            approach=approach,
            load=0.0,
            iterations=0,
            convolutions=0,
            residual=0.0,
            status=ContactStatus.NO_LOAD,
            problem=problem,
        )

    def __repr__(self) -> str:
        cells = "x".join(str(n) for n in self.pressure.shape)
        return (
            f"{type(self).__name__}({cells} cells, load {plain(self.load, 6)} N, approach {plain(self.approach, 6)} "
            f"mm, peak {plain(self.pressure.max(), 6)} MPa, {self.status.name.lower()}, residual {self.residual:.1e})"
        )

    @property
    def approach_under_load(self) -> float:
        """Approach [mm] from first contact on."""
        return self.approach - self.problem.first_contact

    def checked(self, tolerance: float, on_failure: OnFailure, name: str = "contact") -> Self:
        """The solution; ConvergenceError, which names the contact, if it is not converged and failure is to raise."""
        if self.status is ContactStatus.NOT_CONVERGED and on_failure == "raise":
            raise self.not_converged(tolerance, name)
        return self

    def not_converged(self, tolerance: float, name: str = "contact") -> ConvergenceError:
        """Error that tells of a contact that is not solved to its tolerance."""
        return ConvergenceError(
            f"{name} not converged: residual {self.residual:.1e} > tolerance {tolerance:.1e} after "
            f"{self.iterations} iterations; {self.WAY_OUT}",
            last=self,
        )


@dataclass(frozen=True, eq=False, repr=False)
class GradedSolution(Solution):
    """Pressure and gap on columns of unlike widths; iterations are those on the columns given."""

    WAY_OUT: ClassVar = "try a larger tolerance or other cells; `last` of this error is the last iterate"
    problem: GradedProblem


@dataclass(frozen=True, eq=False, repr=False)
class ContactSolution(Solution, InNotebooks):
    """Pressure and gap of two elastic half-spaces in contact on an even grid.

    Parameters
    ----------
    coarser : CoarserGrid or None
        The grid that ``error_estimate`` compares with, if there was one.
    """

    problem: ContactProblem
    coarser: CoarserGrid | None = None

    @cached_property
    def peak_pressure(self) -> float:
        """Largest pressure [MPa], between the cells where it is a smooth top (see ``patch``)."""
        if self.problem.max_pressure is not None or self.bounded:
            return float(self.pressure.max())
        return patch.peak_pressure(self.pressure)

    @property
    def pressure_on_material(self) -> Array:
        """Mean pressure over the material of every cell (nx, ny) [MPa]."""
        cover = self.problem.cover
        return self.pressure if cover is None else self.pressure / np.where(cover > 0.0, cover, 1.0)

    @property
    def in_contact(self) -> Mask:
        """Cells under pressure, (nx, ny) array of bool."""
        return self.pressure > 0.0

    @property
    def spacing(self) -> Spacing:
        """Width of a cell along the two axes [mm]."""
        return self.problem.spacing

    @property
    def cell_area(self) -> float:
        """Area of a cell [mm^2]."""
        return self.problem.cell_area

    @property
    def contact_area(self) -> float:
        """Area under pressure [mm^2], its edge found between the centres of the cells, or where the material ends.

        Less exact than pressures: on an ellipse off by up to 15 % where the smaller of ``cells_across`` is 5, by 6 %
        where it is 8, 2 % where it is 16, 0.5 % where it is 32. ``error_estimate`` does not contain this.
        """
        return self._area_and_semi_axes[0]

    @property
    def semi_axes(self) -> tuple[float, float]:
        """Semi-minor and semi-major axis [mm] of the ellipse with the second moments of the contact area.

        Each is off by up to as much as ``contact_area``.
        """
        return self._area_and_semi_axes[1:]

    @cached_property
    def _area_and_semi_axes(self) -> tuple[float, float, float]:
        if not self.in_contact.any():
            return 0.0, 0.0, 0.0
        cover = np.isfinite(self.problem.gap) if self.problem.cover is None else self.problem.cover
        return patch.area_and_semi_axes(self.pressure_on_material, self.spacing, cover.astype(np.float64))

    @cached_property
    def reaches_border(self) -> bool:
        """Whether the outermost cells of the grid carry pressure: the grid, not the bodies, bounds the contact."""
        return patch.reaches_border(self.pressure)

    @cached_property
    def reaches_material_edge(self) -> bool:
        """Whether the end of the material ends the contact, told within the last cell (see ``patch``)."""
        return patch.ends_at_material(self.pressure_on_material, np.isinf(self.gap))

    @cached_property
    def bounded(self) -> bool:
        """Whether the grid or the material ends the contact, where theory has an infinite pressure."""
        return self.reaches_border or self.reaches_material_edge

    @cached_property
    def reaches_cap(self) -> bool:
        """Whether the largest pressure is the cap on it."""
        cap = self.problem.max_pressure
        return cap is not None and float(self.pressure.max()) >= cap

    @cached_property
    def slope_jump(self) -> float:
        """Largest jump of the slope of the gap inside the contact, in rad; zero if none matters to the pressure.

        Where theory has an infinite pressure; told by the gap on this grid, which cannot tell it from an edge that is
        rounded within two cells, nor from roughness with less than some five cells for its shortest waves.
        """
        if not self.in_contact.any():
            return 0.0
        least = LEAST_GROWTH * float(self.pressure.max()) / growth(1.0, self.problem.contact_modulus)
        return largest_slope_jump(self.problem.gap, self.in_contact, self.spacing, least)

    @cached_property
    def cells_across(self) -> tuple[int, int]:
        """Most cells in contact on one line along each of the two axes: few where a contact crosses its grid askew."""
        first, second = (int(self.in_contact.sum(axis=axis).max()) for axis in (0, 1))
        return first, second

    @property
    def narrow(self) -> bool:
        """Whether the contact has few cells across, of which an error above 1 % is left in its pressure."""
        return 0 < min(self.cells_across) < FEWEST_CELLS

    @property
    def accuracy_warnings(self) -> tuple[str, ...]:
        """Reasons why the result may be less exact, as sentences; empty if there are none."""
        return self.grid_warnings + self.estimate_warnings(LARGE_ERROR)

    @property
    def grid_warnings(self) -> tuple[str, ...]:
        """Those of the accuracy warnings whose reason is where the contact ends, a ridge, or too few cells across."""
        sentences = []
        if self.reaches_border:
            sentences.append(
                "the contact reaches the border of the grid: the pressure at this border is that of a body which "
                "ends there, and grows with the number of cells"
            )
        if self.reaches_material_edge and self.problem.max_pressure is None:
            sentences.append(
                "the contact reaches an end of the material, where the pressure has no limit: the pressure of the "
                "cells beside this end grows with the number of cells"
            )
        if self.slope_jump > 0.0 and not self.reaches_cap:
            grown = growth(self.slope_jump, self.problem.contact_modulus)
            sentences.append(
                f"the slope of the gap jumps by {plain(1e3 * self.slope_jump, 3)} mrad inside the contact: at a ridge "
                "the pressure has no limit, and the pressure of the cells beside the ridge grows by about "
                f"{plain(grown, 3)} MPa each time the size of the cells is halved, at an apex by half as much again; "
                "if the gap is rough, the waves of its roughness have too few cells"
            )
        if self.narrow:
            across, error = min(self.cells_across), self.error_estimate.peak_pressure
            cells = "cell" if across == 1 else "cells"
            estimate = "" if self._peak_by_grid or math.isnan(error) else f" (estimated: {plain(100.0 * error, 2)} %)"
            sentences.append(
                f"the contact is {across} {cells} across: fewer than {FEWEST_CELLS} cells leave errors above 1 % in "
                f"its peak pressure{estimate} and of several per cent in its area and semi-axes"
            )
        return tuple(sentences)

    def estimate_warnings(self, limit: float) -> tuple[str, ...]:
        """The sentence on an estimated error of the peak above a limit; none where ``grid_warnings`` have the reason.

        Nor where the peak is a cap, or the iteration ended early: grids then differ by more than the sizes of cells.
        """
        error = self.error_estimate.peak_pressure
        if self._peak_by_grid or self.narrow or self.status is ContactStatus.NOT_CONVERGED or not error > limit:
            return ()
        return (
            f"the estimated error of the peak pressure is {plain(100.0 * error, 2)} %, above {plain(100.0 * limit)} %: "
            "the gap or its curvature changes within few cells near the peak; take smaller cells, of a rough gap 8 "
            "for its shortest wave",
        )

    @property
    def _peak_by_grid(self) -> bool:
        """Whether the peak is a cap, or has no limit on finer and finer grids."""
        return self.bounded or self.slope_jump > 0.0 or self.reaches_cap

    @cached_property
    def error_estimate(self) -> ErrorEstimate:
        """Discretisation error of the peak and of the approach."""
        return self.estimate(self.slope_jump)

    def estimate(self, slope_jump: float) -> ErrorEstimate:
        """Discretisation error where the slope of the gap jumps by so much; zero: nowhere, as the surfaces may tell."""
        if self.status is ContactStatus.NO_LOAD:
            return ErrorEstimate(0.0, 0.0, 0.0)
        coarser = self.coarser
        if coarser is None:
            return ErrorEstimate(math.nan, math.nan, math.nan)
        least = LEAST_ERROR / min(self.cells_across) ** 2
        if self.bounded or slope_jump > 0.0 or self.reaches_cap:
            grown = MOST_OF_GROWTH * growth(slope_jump, self.problem.contact_modulus) / float(self.pressure.max())
            change = max(coarser.change_of_largest, grown, least)
            return ErrorEstimate(change, coarser.approach_change, change)
        change, beside = coarser.change_of_peak, coarser.change_beside_peak
        return ErrorEstimate(
            peak_pressure=max(
                MOST_OF_CHANGE * change,
                MOST_OF_CHANGE_BESIDE * beside,
                MOST_OF_CHANGE_BEFORE * coarser.change_before,
                least,
            ),
            approach=coarser.approach_change,
            second_order=max(SECOND_ORDER * change, least),
        )
