"""Peak pressure at the rounded edges of a contact: the contact solved once more, as finely as its roundings ask for."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from loaded_tca.arrays import Array, Mask, count_problems, numbers, real
from loaded_tca.contact.columns import EVEN, FineZone, column_borders, pressed_width, whole_cells
from loaded_tca.contact.edges import ALIGNED, SHARPEST, FreeEdge, RoundedEdge, check_edges
from loaded_tca.contact.graded import guess, solve_graded
from loaded_tca.contact.patch import top_between
from loaded_tca.contact.problem import GradedProblem
from loaded_tca.contact.slope_jumps import growth, slope_jump
from loaded_tca.contact.solution import GradedSolution
from loaded_tca.errors import require

Gap = Callable[[Array, Array], Array]
SliceCompliance = Callable[[Array, Array], Array]
Box = tuple[tuple[float, float], tuple[float, float]]

CELLS_ON_ARC = 5.0
"""Cells across the pressed part of a rounding."""
ALIGNED_ERROR, ASKEW_ERROR = 0.13, 0.8
"""Relative error of the peak times the square of the cells across the pressed part, at the most: for columns of which
one begins where the rounding does, and for others (``docs/studies/rounded_edge.md``)."""
ASKEW_CELLS = 1.25
"""How many times as many cells the others have: 6 of them, for 2 %."""
ROWS_ON_ARC = 8.0
"""Rows on the pressed part of a rounding, along it, for 5 cells across: where a contact crosses the edge and leaves it
soon, not where it lies along the edge."""
MOST_OF_ROWS = 0.7
"""Part of the rows of a contact from which on it lies along an edge."""
FEWEST_ON_ARC = 0.7
"""Part of the cells asked for below which columns and rows are made anew."""
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
STEPS = (0.6, 1.0, 1.7, 2.9)
"""Of these in one solution after the other: the first tells the pressed width, and the peak of each is compared with
that of the one before. The last two are made where the difference asks for them."""
ACCURACY = 0.02
LARGE_ERROR = 0.03
"""Estimated relative error above which a pressure is told to depend on its cells."""
MOST_PAIRS, MOST_PAIRS_IF_LARGE = 2_500_000, 10_000_000
"""Rows times pairs of columns from which on cells are not made finer: the next ones take five times as long. The second
holds while the error is large."""
MOST_ROUNDS = 6
SURELY_LESS = 0.92
"""Part of a pressure below which coarser cells tell that finer ones will not reach it."""
TOLERANCE = 1e-5
"""Of the contact conditions: pressures are within 2e-3 of the largest one. With twice as much the top between three
cells was 1.4 % off."""


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
        along the edge rises to a sharp end of the material, where pressure across the edge goes on to one, and where
        the slope of the gap jumps at the peak, as at the start of a linear relief: there finer rows find more and more.
    ends_sharp : bool
        Whether the pressure meets a sharp end of the material: the place is as sharp as that end.
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
        return min(int(whole_cells(per_length * length)), MOST_ROWS)

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
        x, y = low + problem.spacing * (np.arange(len(pressure), dtype=float) + 0.5), problem.middles
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
        x_top, in_x = top_between(x, pressure[:, column], row) if beside.all() else (float(x[row]), 1.0)
        y_top, in_y = top_between(y, pressure[row], column)
        peak = largest * in_x * in_y if problem.max_pressure is None else largest
        error = (ASKEW_ERROR if across[0] else ALIGNED_ERROR) / on_arc**2
        ends_sharp = _rises_to_sharp_end(solution, row, column, error)
        ends_sharp = ends_sharp or self._reaches_end(solution, row, column)
        growth = _growth_at_slope_jump(problem, row, column) / largest
        error = max(error, MARGIN_OF_GROWTH * growth) if growth <= MOST_GROWTH else math.inf
        if row in (0, x.size - 1) or column in (0, y.size - 1) or ends_sharp:
            error = math.inf
        rows = np.count_nonzero(((beyond + along > 0.0) & (pressure > 0.0)).any(axis=1))
        return EdgePressure(peak, (x_top, y_top), error, ends_sharp, width, on_arc, int(rows), solution)

    def _reaches_end(self, solution: GradedSolution, row: int, column: int) -> bool:
        """Whether pressure goes on from a peak, across the edge, to a sharp end of the material that cuts the arc."""
        across = int(abs(self.normal[1]) >= abs(self.normal[0]))
        start, line = ((row, np.s_[:, column]), (column, np.s_[row]))[across]
        outwards = np.s_[start:] if self.normal[across] > 0.0 else np.s_[start::-1]
        gaps, pressures = (part[line][outwards] for part in (solution.problem.gap, solution.pressure))
        end = int(np.argmin(np.append(pressures, 0.0) > 0.0))
        return end < gaps.size and bool(np.isinf(gaps[end]))

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
    x = problem.spacing * np.arange(problem.cells[0], dtype=float)
    jump = math.hypot(slope_jump(x, problem.gap[:, column], row), slope_jump(problem.middles, problem.gap[row], column))
    return growth(jump, problem.contact_modulus)


def edge_pressures(
    gap: Gap,
    box: Box,
    edges: Sequence[RoundedEdge],
    load: float,
    contact_modulus: float,
    *,
    cells: tuple[int, int] = (32, 32),
    max_pressure: float | None = None,
    slice_compliance: SliceCompliance | None = None,
    slice_axis: int = 1,
    free_edges: Sequence[FreeEdge] = (),
    cells_on_arc: float = CELLS_ON_ARC,
    accuracy: float = ACCURACY,
    at_least: float = 0.0,
    tolerance: float = TOLERANCE,
) -> list[EdgePressure]:
    r"""Peak pressures at rounded edges that a contact reaches, under the force of this contact.

    Columns are graded along y: for an edge along y hand in everything with x and y exchanged and ``slice_axis`` 0. Of
    a rounding that is pressed on the width d, with the normal n, cells are d/m over n_x and n_y; d is told by a
    solution on coarser cells, repeated until these are as many as they should be. An oblique edge has fine columns
    along its loaded part as long as they are no more than 80, and no more than 384 cells along them: the estimated
    error tells where that is not enough.

    An edge with an angle is that of a wedge whose faces meet where they would without the rounding. The wedge is softer
    than a half-space by an image of the pressure, with the factor that gives a long contact beside its edge the tilt of
    plane strain (``docs/how_it_works/contact_solver.md``). What the image adds where the load is, is left out: how far
    the edge gives way on the whole is for ``slice_compliance`` to tell. Edges across the columns or oblique to them
    have no image, and none has one where columns are slices, which then hold the tilt. The factor is 0.6 at the most,
    that of 103 deg of like materials: of sharper edges the tilt counts so far.

    Parameters
    ----------
    gap : callable
        ``gap(x, y)``: gap [mm] before loading at all pairs of places x (nx,) and y (ny,), (nx, ny); +inf where there is
        no material.
    box : ((float, float), (float, float)) [mm]
        Ends of the grid along x and along y; it must hold the contact.
    edges : sequence of RoundedEdge
    load : float [N]
        Normal load, positive.
    contact_modulus : float [MPa]
        E*.
    cells : (int, int)
        Along x, at least; and of the widest column, so many of which would fill the box.
    max_pressure : float, optional [MPa]
        Cap on the pressure.
    slice_compliance : callable, optional
        ``slice_compliance(middles, widths)``: displacement [mm/N] of slices of these places and widths, both (n,),
        under a unit force on each, (n, n). Slices without material have none, whatever it says of them.
    slice_axis : {1, 0}
        Axis along which slices follow each other: columns if 1, rows if 0.
    free_edges : sequence of FreeEdge
        Ends of the bodies along the columns, with ``across``, their positions counted from the low end of the box along
        y. Their images count in full, and ``slice_compliance`` is to be without them.
    cells_on_arc : float
        m, for edges along x; a quarter more for others.
    accuracy : float
        Relative error of the largest peak, as it is estimated, above which cells are made finer, twice at most.
    at_least : float [MPa]
        Where no edge reaches 0.92 of this on the coarser cells, these are the answer.
    tolerance : float
        Of the contact conditions.

    Returns
    -------
    list of EdgePressure
        In the order of the edges.

    Raises
    ------
    InputError
        With every problem of the arguments, and of what the callables give.
    ConvergenceError
        If the solver does not reach its tolerance.

    Examples
    --------
    A cylinder of radius 10 mm whose face ends at y = 2 with a rounding of 0.2 mm.

    >>> def gap(x, y):
    ...     return x[:, None] ** 2 / 20.0 + np.maximum(y - 2.0, 0.0) ** 2 / 0.4
    >>> edge = RoundedEdge((0.0, 2.0), (0.0, 1.0), 0.2)
    >>> peak = edge_pressures(gap, ((-0.15, 0.15), (-2.2, 2.2)), [edge], 500.0, 113187.0)[0]
    >>> bool(abs(peak.place[1] - 2.0) < peak.pressed_width), peak.error < 0.01
    (True, True)
    """
    low, high = _checked(gap, box, edges, load, contact_modulus, cells, cells_on_arc)
    columns_are_slices = slice_compliance is not None and slice_axis == 1
    problems = check_edges(free_edges) or [
        f"free_edges[{k}].across: None are not two finite numbers from 0 on"
        for k, edge in enumerate(free_edges)
        if edge.across is None
    ]
    require(*((False, problem) for problem in problems))
    contact = _Contact(
        gap=gap,
        low=low,
        high=high,
        demand=(contact_modulus, load, max_pressure),
        cells=cells,
        cells_on_arc=cells_on_arc,
        slice_compliance=slice_compliance,
        slice_axis=slice_axis,
        wedges=_Wedges.of([] if columns_are_slices else edges, float(low[1])),
        free_edges=free_edges,
        tolerance=tolerance,
    )
    arcs = [PressedArc.first(edge, low, high, load, contact_modulus) for edge in edges]
    peaks = list[EdgePressure]()
    for step in STEPS:
        coarser = peaks
        peaks, arcs = _peaks_with(step * cells_on_arc, contact, arcs, coarser)
        if at_least > 0.0 and not any(peak.pressure >= SURELY_LESS * at_least for peak in peaks):
            break
        if coarser:
            peaks = [peak.compared_with(before) for peak, before in zip(peaks, coarser, strict=True)]
            if not _finer_cells_are_worth(accuracy, peaks):
                break
    return peaks


def _peaks_with(
    on_arc: float, contact: _Contact, arcs: list[PressedArc], peaks: list[EdgePressure]
) -> tuple[list[EdgePressure], list[PressedArc]]:
    """Peaks with so many cells on the pressed widths, and the edges as these leave them; begun from the peaks before.

    How wide an edge is pressed is what the solution before says: cells are made anew until they are fine enough.
    """
    for _ in range(MOST_ROUNDS):
        solution = contact.solved(arcs, on_arc, peaks[0].solution if peaks else None)
        peaks = [arc.peak(solution, float(contact.low[0])) for arc in arcs]
        arcs = [arc.after(peak) for arc, peak in zip(arcs, peaks, strict=True)]
        if all(arc.fine_enough(peak, on_arc) for arc, peak in zip(arcs, peaks, strict=True)):
            break
    return peaks, arcs


def _finer_cells_are_worth(accuracy: float, peaks: Sequence[EdgePressure]) -> bool:
    """Whether the error of the largest peak is above the accuracy, and the time of finer cells is no more than that."""
    rows, columns = peaks[0].solution.problem.cells
    error = max(peaks, key=lambda peak: np.nan_to_num(peak.pressure)).error
    most = MOST_PAIRS if error <= LARGE_ERROR else MOST_PAIRS_IF_LARGE
    return accuracy < error < math.inf and rows * columns**2 <= most


@dataclass(frozen=True, eq=False)
class _Contact:
    """What ``edge_pressures`` is to solve, on cells of any size; ``demand``: E*, load, cap on the pressure."""

    gap: Gap
    low: Array
    high: Array
    demand: tuple[float, float, float | None]
    cells: tuple[int, int]
    cells_on_arc: float
    slice_compliance: SliceCompliance | None
    slice_axis: int
    wedges: _Wedges
    free_edges: Sequence[FreeEdge]
    tolerance: float

    def solved(self, arcs: Sequence[PressedArc], on_arc: float, before: GradedSolution | None) -> GradedSolution:
        """Pressure with so many cells on the pressed width of each edge, begun from a solution on other cells."""
        rows, borders = self._cells_for(arcs, on_arc)
        dx, y = float(self.high[0] - self.low[0]) / rows, 0.5 * (borders[1:] + borders[:-1])
        x = self.low[0] + dx * (np.arange(rows) + 0.5)
        slices, place = None, (y, np.diff(borders)) if self.slice_axis == 1 else (x, np.full(rows, dx))
        heights, tilted = numbers("gap", self.gap(x, y)), self.wedges.free
        if self.slice_compliance is not None:
            slices = numbers("slice_compliance", self.slice_compliance(*place))
            slices = of_material(slices, np.asarray(np.isfinite(heights).any(axis=1 - self.slice_axis)))
        free = [*self.free_edges, *tilted]
        problem = GradedProblem(heights, dx, borders, *self.demand, slices, self.slice_axis, free)
        start = None if before is None else interpolated_pressure(before, self.low[0], x, y)
        if tilted:
            expected = guess(problem) if start is None else start
            problem = replace(problem, reference=self.wedges.reference(_load_centre(problem, expected)))
        return solve_graded(problem, tolerance=self.tolerance, initial_pressure=start)

    def _cells_for(self, arcs: Sequence[PressedArc], on_arc: float) -> tuple[int, Array]:
        """Number of rows, and borders of the columns."""
        fewest = [max(4, round(count * on_arc / self.cells_on_arc)) for count in self.cells]
        zones = [arc.zone(on_arc) for arc in arcs if abs(arc.normal[1]) > ALIGNED]
        widest = float(self.high[1] - self.low[1]) / fewest[1]
        rows = max(arc.rows(on_arc, float(self.high[0] - self.low[0])) for arc in arcs)
        return max(fewest[0], rows), column_borders(self.low[1], self.high[1], zones, widest)


def of_material(slices: Array, there: Mask) -> Array:
    """Compliance of slices (n, n), zero for those without material (n,).

    Those carry nothing. But a law for slices of a tooth, continued beyond its free end, can make K indefinite, and the
    preconditioner and the coarser columns have all slices in them.
    """
    if slices.shape != (there.size, there.size):
        return slices
    return np.where(there[:, None] & there, slices, 0.0)


@dataclass(frozen=True, eq=False)
class _Wedges:
    """Free edges at the apexes of wedges, and where their roundings begin: the first and the last place of a load."""

    free: list[FreeEdge]
    first: float
    last: float

    @classmethod
    def of(cls, edges: Sequence[RoundedEdge], low: float) -> _Wedges:
        """Those of edges along the columns, which begin at ``low``."""
        wedges = [(edge.place[1], end) for edge in edges if (end := edge.free_edge(low)) is not None]
        first = max((place for place, end in wedges if end.material == "above"), default=-math.inf)
        last = min((place for place, end in wedges if end.material == "below"), default=math.inf)
        return cls([end for _, end in wedges], first, last)

    def reference(self, load_centre: float) -> float:
        """The place nearest to the centre of the load that lies before the roundings."""
        return min(max(load_centre, self.first), self.last)


def _load_centre(problem: GradedProblem, pressure: Array) -> float:
    """Centre of the load along y [mm]."""
    forces = pressure.sum(axis=0) * problem.widths
    return float(forces @ problem.middles / forces.sum())


def interpolated_pressure(solution: GradedSolution, low: float, x: Array, y: Array) -> Array:
    """Pressure at other places (nx, ny): the root of its square, interpolated along both axes."""
    problem = solution.problem
    rows = low + problem.spacing * (np.arange(problem.cells[0]) + 0.5)
    square = solution.pressure**2
    square = np.stack([np.interp(y, problem.middles, row) for row in square])
    return np.sqrt(np.stack([np.interp(x, rows, column) for column in square.T], axis=1))


def _checked(
    gap: Any, box: Any, edges: Any, load: Any, modulus: Any, cells: Any, cells_on_arc: Any
) -> tuple[Array, Array]:
    """Ends of the box, low and high (2,), after every argument has been looked at."""
    ends = numbers("box", box)
    sound = ends.shape == (2, 2) and bool(np.isfinite(ends).all()) and bool((ends[:, 1] > ends[:, 0]).all())
    two = isinstance(cells, Sequence) and len(cells) == 2
    listed = isinstance(edges, Sequence) and len(edges) > 0 and all(isinstance(edge, RoundedEdge) for edge in edges)
    require(
        (callable(gap), f"gap: {gap!r:.60} is not a function of x and y"),
        (sound, f"box: {box!r:.60} is not ((low, high), (low, high)) in mm"),
        (listed, f"edges: {edges!r:.60} is not a sequence of RoundedEdge"),
        (0.0 < real(load) < math.inf, f"load: {load} N is not positive and finite"),
        (0.0 < real(modulus) < math.inf, f"contact_modulus: {modulus} MPa is not positive and finite"),
        (
            two and not count_problems(dict(enumerate(cells)), 4),
            f"cells: {cells!r:.60} are not two whole numbers from 4 on",
        ),
        (2.0 <= real(cells_on_arc) <= 100.0, f"cells_on_arc: {cells_on_arc} is not between 2 and 100"),
    )
    require(
        *(
            (
                all(math.isfinite(real(value)) for value in (*edge.place, *edge.normal))
                and math.hypot(*edge.normal) > 0.0
                and 0.0 < real(edge.radius) < math.inf,
                f"edges[{k}]: {edge} has no finite place, no normal or no positive radius",
            )
            for k, edge in enumerate(edges)
        ),
        *(
            (
                edge.angle is None or SHARPEST <= real(edge.angle) <= math.pi,
                f"edges[{k}].angle: {edge.angle} rad is not between pi/6 and pi",
            )
            for k, edge in enumerate(edges)
        ),
        *(
            (0.0 <= real(edge.share) <= 1.0, f"edges[{k}].share: {edge.share} is not between 0 and 1")
            for k, edge in enumerate(edges)
        ),
    )
    return ends[:, 0], ends[:, 1]
