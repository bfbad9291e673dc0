"""Rounded edges as a solution of the contact leaves them: how far they are pressed, and where cells have to be fine."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.contact.columns import EVEN, FineZone, pressed_width, slope_jump, top
from loaded_tca.contact.edges import FreeEdge, extra_displacement
from loaded_tca.contact.problem import GradedProblem
from loaded_tca.contact.solution import GradedSolution

CELLS_ON_ARC = 5.0
"""Cells across the pressed part of a rounding."""
ALIGNED_ERROR, ASKEW_ERROR = 0.13, 0.8
"""Relative error of the peak times the square of the cells across the pressed part, at the most: for columns of which
one begins where the rounding does, and for others (``docs/studies/rounded_edge.md``)."""
ASKEW_CELLS = 1.25
"""How many times as many cells the others have: 6 of them, for 2 %."""
ALIGNED = 1e-3
"""Sine of the angle between an edge and the columns up to which their borders follow it."""
ROWS_ON_ARC = 8.0
"""Rows on the pressed part of a rounding, along it, for 5 cells across: where a contact crosses the edge and leaves it
soon, not where it lies along the edge."""
MOST_OF_ROWS = 0.7
"""Part of the rows of a contact from which on it lies along an edge."""
FEWEST_ON_ARC = 0.7
"""Part of the cells asked for below which columns and rows are made anew."""
MOST_FACTOR = 0.6
"""Of the image at the edge of a wedge, up to which the iteration converges: 103 deg of like materials."""
LEAST_CHANGE = 0.25
"""Of the pressed width from one solution to the next: a single cell tells little."""
FIRST_WIDTH = 1.0 / 16.0
"""Of the pressed part across the columns, over the box, to begin with."""
MOST_ROWS = 384
"""Cells along the columns."""
MOST_FINE = 80
"""Finest columns beside an oblique edge, which lies across them."""
MOST_GROWTH = 0.01
"""Of a peak on cells of half the size, where the slope of the gap jumps: from there on it is said to have no limit."""
MARGIN_OF_GROWTH = 2.0
"""The error over a smaller one: what a cell has there depends on where in it the line lies, too."""


@dataclass(frozen=True)
class RoundedEdge:
    """A straight line in the plane of a grid, from which on a surface is rounded.

    Parameters
    ----------
    place : (float, float) [mm]
        A point of the line where the rounding begins.
    normal : (float, float)
        Across the line, towards the end of the surface; of any length.
    radius : float [mm]
        Of the rounding.
    angle : float, optional [rad]
        Of the material between the surface and the land beyond the rounding, from pi/6 to pi: the surface is softer
        towards the edge and tilts. Of a half-space if absent.
    share : float
        Of the body that ends in the compliance, E* (1 - nu1^2)/E1: a half of like materials.
    """

    place: tuple[float, float]
    normal: tuple[float, float]
    radius: float
    angle: float | None = None
    share: float = 0.5

    @property
    def direction(self) -> Array:
        """The normal as a unit vector (2,)."""
        return np.array(self.normal, dtype=float) / math.hypot(*self.normal)

    def free_edge(self, low: float) -> FreeEdge | None:
        """The apex of its wedge, from the first border of the columns on; None without one or across them."""
        if self.angle is None or abs(self.normal[0]) > ALIGNED * math.hypot(*self.normal):
            return None
        side = math.copysign(1.0, self.normal[1])
        apex = self.place[1] + side * self.radius * math.tan(0.5 * (math.pi - self.angle))
        factor = min(self.share * extra_displacement(self.angle), MOST_FACTOR)
        return FreeEdge(1, apex - low, "below" if side > 0.0 else "above", factor)


@dataclass(frozen=True, eq=False)
class EdgePressure:
    """Peak pressure at a rounded edge.

    Attributes
    ----------
    pressure : float [MPa]
        Largest pressure on the rounding and within its pressed width beside it; NaN where the contact does not reach
        the rounding.
    place : (float, float) [mm]
        Of the peak.
    error : float
        Estimated relative error of the discretisation: the change from coarser cells, and at least what the number of
        cells is known to leave; infinite where the end of the box is what bounds the contact, where the pressure
        along the edge rises to a sharp end of the material, and where the slope of the gap jumps at the peak, as at the
        start of a linear relief: there finer rows find more and more.
    ends_sharp : bool
        Whether it does the latter: the corner is as sharp as that end.
    pressed_width : float [mm]
        How far the contact reaches onto the rounding, across the edge.
    cells_on_arc : float
        Cells on that width, along the axis that has fewer.
    rows_on_arc : int
        Rows that are pressed on the rounding.
    solution : GradedSolution
        Of the contact.
    """

    pressure: float
    place: tuple[float, float]
    error: float
    ends_sharp: bool
    pressed_width: float
    cells_on_arc: float
    rows_on_arc: int
    solution: GradedSolution

    def compared_with(self, coarser: EdgePressure) -> EdgePressure:
        """Return this pressure with an error of at least its change from one on coarser cells.

        Two solutions may agree by chance: the error is no less than what finer cells leave of the coarser one.
        """
        if math.isnan(self.pressure) or math.isnan(coarser.pressure):
            return self
        change = abs(self.pressure - coarser.pressure) / self.pressure
        left = coarser.error * min(1.0, coarser.cells_on_arc / self.cells_on_arc) ** 2
        return replace(self, error=max(self.error, change, left if math.isfinite(left) else 0.0))


@dataclass(frozen=True, eq=False)
class PressedArc:
    """A rounded edge as solutions leave it: where it is, how far it is pressed, and where columns have to be fine.

    ``length`` is that of its pressed part; infinite where the contact lies along the edge, whatever the rows.
    """

    edge: Array
    normal: Array
    width: float
    middle: float
    half_length: float
    length: float

    @classmethod
    def first(cls, edge: RoundedEdge, low: Array, high: Array, load: float, modulus: float) -> PressedArc:
        """From a contact that fills the box; across the columns no narrower than a sixteenth of the box.

        What is pressed less is told in steps, which are cheaper than fine cells all along the columns.
        """
        normal, extent = edge.direction, high - low
        half, along = 0.5 * float(np.abs(normal) @ extent), float(np.abs(normal[::-1]) @ extent)
        arc = cls(np.array(edge.place, dtype=float), normal, 0.0, 0.0, 0.5 * float(extent[0]), math.inf)
        middle = arc.y_at(0.5 * float(low[0] + high[0])) if abs(normal[1]) > ALIGNED else edge.place[1]
        width = pressed_width(load / along, edge.radius, half, modulus)
        return replace(arc, width=max(width, FIRST_WIDTH * abs(normal[0]) * float(extent[0])), middle=middle)

    def y_at(self, x: float) -> float:
        """Where the edge crosses a row."""
        return float(self.edge[1] - (x - self.edge[0]) * self.normal[0] / self.normal[1])

    def cells(self, on_arc: float) -> float:
        """Cells on the pressed width: more where none of their borders can follow the edge."""
        return on_arc * (ASKEW_CELLS if abs(self.normal[0]) > ALIGNED else 1.0)

    def rows(self, on_arc: float, length: float) -> int:
        """Rows of a box of this length, for so many cells on the pressed width; no more than their limit."""
        along = ROWS_ON_ARC / CELLS_ON_ARC * on_arc / self.length
        per_length = max(self.cells(on_arc) * abs(float(self.normal[0])) / self.width, along)
        return min(math.ceil(per_length * length), MOST_ROWS)

    def fine_enough(self, peak: EdgePressure, on_arc: float) -> bool:
        """Whether a solution has the cells that are asked for, nearly, or rows at their limit."""
        if math.isnan(peak.pressure):
            return True
        rows = FEWEST_ON_ARC * ROWS_ON_ARC / CELLS_ON_ARC * on_arc
        enough = self.length == math.inf or peak.rows_on_arc >= rows or peak.solution.problem.cells[0] >= MOST_ROWS
        return enough and peak.cells_on_arc >= FEWEST_ON_ARC * on_arc

    def zone(self, on_arc: float) -> FineZone:
        """Where columns are fine, for so many cells on the pressed width."""
        along = abs(float(self.normal[1]))
        finest = self.width / (self.cells(on_arc) * along)
        oblique = self.half_length * abs(float(self.normal[0])) / along
        return FineZone(self.middle, finest, EVEN * self.width / along + min(oblique, 0.5 * MOST_FINE * finest))

    def peak(self, solution: GradedSolution, low: float) -> EdgePressure:
        """The peak at this edge."""
        problem, pressure = solution.problem, solution.pressure
        x, y = low + problem.spacing * (np.arange(len(pressure)) + 0.5), problem.middles
        beyond = (x - self.edge[0])[:, None] * self.normal[0] + (y - self.edge[1]) * self.normal[1]
        along = 0.5 * np.abs(self.normal[0]) * problem.spacing + 0.5 * np.abs(self.normal[1]) * problem.widths
        reached = (beyond + along)[pressure > 0.0]
        width = float(reached.max()) if reached.size else 0.0
        near = np.where(beyond > -width, pressure, 0.0) if width > 0.0 else np.zeros(pressure.shape)
        if not near.any():
            return EdgePressure(math.nan, (math.nan, math.nan), 0.0, False, 0.0, 0.0, 0, solution)
        row, column = (int(k) for k in np.unravel_index(int(near.argmax()), near.shape))
        sizes = np.array([problem.spacing, problem.widths[column]])
        across = np.abs(self.normal) > ALIGNED
        on_arc = float((width / (np.abs(self.normal) * sizes)[across]).min())
        largest = float(pressure[row, column])
        beside = pressure[max(0, row - 1) : row + 2, column]
        x_top, in_x = top(x, pressure[:, column], row) if beside.all() else (float(x[row]), 1.0)
        y_top, in_y = top(y, pressure[row], column)
        peak = largest * in_x * in_y if problem.max_pressure is None else largest
        error = (ASKEW_ERROR if across[0] else ALIGNED_ERROR) / on_arc**2
        ends_sharp = _rises_to_sharp_end(solution, row, column, error)
        growth = _growth_at_slope_jump(problem, row, column) / largest
        error = max(error, MARGIN_OF_GROWTH * growth) if growth <= MOST_GROWTH else math.inf
        if row in (0, x.size - 1) or column in (0, y.size - 1) or ends_sharp:
            error = math.inf
        rows = np.count_nonzero(((beyond + along > 0.0) & (pressure > 0.0)).any(axis=1))
        return EdgePressure(peak, (x_top, y_top), error, ends_sharp, width, on_arc, int(rows), solution)

    def after(self, peak: EdgePressure) -> PressedArc:
        """The edge as a solution leaves it."""
        if math.isnan(peak.pressure):
            return self
        problem = peak.solution.problem
        pressed = (peak.solution.pressure > 0.0).any(axis=1)
        half_length = 0.5 * problem.spacing * float(np.count_nonzero(pressed))
        width = max(peak.pressed_width, LEAST_CHANGE * self.width)
        middle = self.y_at(peak.place[0]) if abs(self.normal[1]) > ALIGNED else self.middle
        length = math.inf
        if peak.rows_on_arc < MOST_OF_ROWS * np.count_nonzero(pressed) and abs(self.normal[1]) > ALIGNED:
            length = max(problem.spacing * peak.rows_on_arc, LEAST_CHANGE * min(self.length, 2.0 * half_length))
        return replace(self, width=width, middle=middle, half_length=half_length, length=length)


def _rises_to_sharp_end(solution: GradedSolution, row: int, column: int, error: float) -> bool:
    """Whether the material ends within two rows of a peak, and pressures up to there differ by more than its error."""
    near = np.s_[max(0, row - 2) : row + 3, column]
    pressed = solution.pressure[near][solution.pressure[near] > 0.0]
    return bool(np.isinf(solution.problem.gap[near]).any()) and bool(np.ptp(pressed) > error * pressed.max())


def _growth_at_slope_jump(problem: GradedProblem, row: int, column: int) -> float:
    """Pressure [MPa] by which a peak grows whenever cells are halved, where the slope of the gap jumps beside it.

    Beside a line on which the slope jumps by J a half-space has the pressure E* J/(2 pi) ln(1/s), which has no limit.
    """
    x = problem.spacing * np.arange(problem.cells[0])
    jump = math.hypot(slope_jump(x, problem.gap[:, column], row), slope_jump(problem.middles, problem.gap[row], column))
    return problem.contact_modulus * jump * math.log(2.0) / (2.0 * math.pi)
