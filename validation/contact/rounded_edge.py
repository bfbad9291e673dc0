"""Rounded edges on graded columns: a closed form, uniform grids, orders; time against error; writes a page.

A flat punch with rounded ends (a 0.1, R 0.2, b 0.11 mm, E* 113187 MPa) under 174.53 N/mm has its peak of 2185.0 MPa at
0.10302 mm and 524.2 MPa in the middle. Contacts in space have no closed form: a paraboloid that ends in a rounding is
compared with a uniform grid of as fine cells, and the others with themselves on three times as many cells.

Source: Ciavarella, Hills & Monno 1998, Proc. Inst. Mech. Eng. C 212, 319-328.

Run from the root of the repository: ``python -m validation.contact.rounded_edge``.
"""

import math
import statistics
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from loaded_tca.contact import (
    EdgePressure,
    GradedProblem,
    GradedSolution,
    RoundedEdge,
    edge_pressures,
    solve_contact,
    solve_graded,
)
from loaded_tca.contact.columns import EVEN, FineZone, column_borders, pressed_width
from loaded_tca.reference.punch import RoundedPunch
from loaded_tca.threads import one_thread
from validation.page import Page, line, machine, table, timed, write_page
from validation.table import Row

Array = NDArray[np.float64]
Gap = Callable[[Array, Array], Array]

E_STAR = 113187.0
RADIUS = 0.2
PUNCH = RoundedPunch(0.1, RADIUS, 0.11, E_STAR)
SOURCE = "flat punch with rounded ends, Ciavarella et al. 1998"
# Numbers of the closed form, as they were found apart from the code.
LINE_LOAD, PEAK, PEAK_PLACE, MIDDLE = 174.53, 2185.0, 0.10302, 524.2
# One cell of this length along the punch makes the problem plane [mm].
LENGTH = 1000.0
CLOSE = 1e-9
OF_SOLVERS = 60.0 * CLOSE
"""Two solvers that both end there: three times what is seen."""
# Cells on the pressed part, and what they are to reach.
ALLOWED = {3: 1e-2, 5: 5e-3, 10: 2e-3, 20: 5e-4}
# Of the exponent between radii of 0.001 and 0.008 mm: what is left of larger radii.
LIMIT = 2.5e-3
RUNS = 7
CELLS_ON_ARC = (3.0, 4.0, 5.0, 7.0, 10.0)
EXACT_CELLS = 15.0


def plane_punch(
    punch: RoundedPunch, on_arc: float, widest: float = 0.01, growth: float = 1.3, shift: float = 0.0
) -> tuple[Array, GradedSolution]:
    """Middles and solution on columns of d/on_arc beside both ends of a punch, off them by a part of a cell."""
    a, b = punch.half_width, punch.contact_half_width
    width = pressed_width(punch.line_load, punch.radius, a, E_STAR)
    cell = width / on_arc
    zones = [FineZone(side * a + shift * cell, cell, EVEN * width) for side in (-1.0, 1.0)]
    borders = column_borders(-b - 0.4 * a, b + 0.4 * a, zones, widest, growth)
    y = 0.5 * (borders[1:] + borders[:-1])
    problem = GradedProblem(punch.gap(y)[None], LENGTH, borders, E_STAR, punch.line_load * LENGTH)
    return y, solve_graded(problem, tolerance=CLOSE)


def top(places: Array, pressures: Array) -> tuple[float, float]:
    """Place and value of the largest pressure, by a parabola through the squares of three."""
    k = int(pressures.argmax())
    bend, slope, level = np.polyfit(places[k - 1 : k + 2] - places[k], pressures[k - 1 : k + 2] ** 2, 2)
    return float(places[k] - 0.5 * slope / bend), math.sqrt(level - 0.25 * slope**2 / bend)


def rows_of_closed_form() -> list[Row]:
    """Load, peak and middle of the punch, and how the errors fall."""
    case = "rounded punch, a 0.1 R 0.2 b 0.11"
    table = [Row(case, SOURCE, "line load [N/mm]", LINE_LOAD, PUNCH.line_load, 3e-5)]
    errors = []
    for on_arc, tolerance in ALLOWED.items():
        y, solution = plane_punch(PUNCH, on_arc)
        place, peak = top(y, solution.pressure[0])
        table.append(Row(case, SOURCE, f"peak, {on_arc} cells on the arc [MPa]", PEAK, peak, tolerance))
        errors.append(abs(peak / PUNCH.peak()[1] - 1.0))
        if on_arc == 5:
            middle = float(np.interp(0.0, y, solution.pressure[0]))
            table += [
                # Place on the arc: within a cell of it, which is 2 % of the place.
                Row(case, SOURCE, "place of the peak, 5 cells [mm]", PEAK_PLACE, abs(place), 3e-3),
                Row(case, SOURCE, "middle, 5 cells [MPa]", MIDDLE, middle, 1.5e-3),
            ]
    # Errors of first order in a few cells, where the rounding and where the contact ends: 1.5 in the mean square.
    table += [
        Row("rounded punch, finer and finer columns", SOURCE, f"order of the error, {name}", expected, order, 0.15)
        for (name, order), expected in zip(orders().items(), (1.5, 2.0), strict=True)
    ]
    return table


def orders() -> dict[str, float]:
    """Order of convergence, from all columns made finer by 2, 4 and 8, of the field and of the peak."""
    exact_peak, refined = PUNCH.peak()[1], np.array([1.0, 2.0, 4.0, 8.0])
    fields, peaks = [], []
    for finer in refined:
        # The mean over the place of the columns: as the end of the contact moves through a cell, errors change sign.
        found = [
            plane_punch(PUNCH, 4.0 * finer, 0.02 / finer, 1.3 ** (1.0 / finer), shift)
            for shift in (0.0, 0.25, 0.5, 0.75)
        ]
        inside = [np.abs(y) < PUNCH.contact_half_width - 0.003 for y, _ in found]
        squares = [
            np.mean((one.pressure[0][there] / PUNCH.pressure(y[there]) - 1.0) ** 2)
            for (y, one), there in zip(found, inside, strict=True)
        ]
        fields.append(math.sqrt(np.mean(squares)))
        peaks.append(math.sqrt(np.mean([(top(y, one.pressure[0])[1] / exact_peak - 1.0) ** 2 for y, one in found])))
    return {
        name: -float(np.polyfit(np.log(refined), np.log(values), 1)[0])
        for name, values in (("pressures", fields), ("peak", peaks))
    }


def rows_of_scaling() -> list[Row]:
    """Exponent of the peak over the radius, under one load, of ever smaller radii: -1/3 in the limit."""
    peaks, radii = [], np.array([1e-3, 2e-3, 4e-3, 8e-3])
    for radius in radii:
        # The contact's half width that carries 100 N/mm, by secants on the closed form.
        low, high = 0.1 * (1.0 + 1e-9), 0.12
        for _ in range(100):
            middle = 0.5 * (low + high)
            below = RoundedPunch(0.1, radius, middle, E_STAR).line_load < 100.0
            low, high = (middle, high) if below else (low, middle)
        y, solution = plane_punch(RoundedPunch(0.1, radius, high, E_STAR), 8.0)
        peaks.append(top(y, solution.pressure[0])[1])
    exponent = float(np.polyfit(np.log(radii), np.log(peaks), 1)[0])
    return [
        Row("rounded punch, 100 N/mm, R 0.001 to 0.008", SOURCE, "exponent of the peak", -1.0 / 3.0, exponent, LIMIT)
    ]


def rows_of_uniform_grids() -> list[Row]:
    """Equal columns against the solver of uniform grids, and graded ones against a fine uniform grid."""
    x, y = ((np.arange(n) + 0.5) / n * 0.6 for n in (96, 2048))
    x, y = x - 0.3, y + 1.5
    spacing = (0.6 / 96, 0.6 / 2048)
    even = face(x, y[::32]) + (y[::32] - 2.0) ** 2 / 20.0
    borders = np.linspace(1.5, 2.1, 65)
    same = solve_graded(GradedProblem(even, spacing[0], borders, E_STAR, 60.0), tolerance=CLOSE)
    uniform = solve_contact(even, (spacing[0], 0.6 / 64), E_STAR, load=60.0, tolerance=CLOSE, warn=False)
    difference = float(np.abs(same.pressure - uniform.pressure).max()) / float(uniform.pressure.max())
    fine = solve_contact(rounded_paraboloid(x, y), spacing, E_STAR, load=60.0, warn=False)
    edge = RoundedEdge((0.0, 2.0), (0.0, 1.0), RADIUS)
    (found,) = edge_pressures(rounded_paraboloid, ((-0.3, 0.3), (1.5, 2.1)), [edge], 60.0, E_STAR)
    case, source = "paraboloid that ends in a rounding", "uniform grid, 96 x 2048"
    return [
        Row("even columns, 96 x 64", "uniform grid", "largest difference of pressures", 0.0, difference, OF_SOLVERS),
        Row(case, source, "peak at the rounding [MPa]", float(fine.pressure.max()), found.pressure, 5e-3),
        Row(case, source, "approach [mm]", fine.approach, found.solution.approach, 1e-3),
    ]


def rows() -> list[Row]:
    """Closed form, orders, exponent, uniform grids."""
    return [*rows_of_closed_form(), *rows_of_scaling(), *rows_of_uniform_grids()]


def face(x: Array, y: Array) -> Array:
    """A cylinder of radius 10 mm that ends at y = 2 with a rounding."""
    return np.asarray(x[:, None] ** 2 / 20.0 + np.maximum(y - 2.0, 0.0) ** 2 / (2.0 * RADIUS))


def rounded_paraboloid(x: Array, y: Array) -> Array:
    """The same, crowned along y too."""
    return np.asarray(face(x, y) + (y - 2.0) ** 2 / 20.0)


@dataclass(frozen=True)
class Case:
    """A contact that reaches a rounding of 0.2 mm."""

    name: str
    gap: Gap
    box: tuple[tuple[float, float], tuple[float, float]]
    edges: tuple[RoundedEdge, ...]
    load: float

    def solved(self, cells_on_arc: float) -> EdgePressure:
        """Peak pressure at its first edge."""
        return edge_pressures(
            self.gap, self.box, self.edges, self.load, E_STAR, cells_on_arc=cells_on_arc, accuracy=1.0
        )[0]


def oblique(sine: float) -> Case:
    """A slender contact cut off by an edge at an angle to it."""
    normal = (sine, math.sqrt(1.0 - sine**2))

    def gap(x: Array, y: Array) -> Array:
        beyond = np.maximum(x[:, None] * normal[0] + (y - 1.0) * normal[1], 0.0)
        return np.asarray(x[:, None] ** 2 / 20.0 + y**2 / 2000.0 + beyond**2 / (2.0 * RADIUS))

    edge = RoundedEdge((0.0, 1.0), normal, RADIUS)
    degrees = math.degrees(math.asin(sine))
    return Case(f"edge askew by {degrees:.0f} deg", gap, ((-0.3, 0.3), (-3.0, 1.8)), (edge,), 300.0)


@cache
def cases() -> tuple[Case, ...]:
    """Face end, both face ends of a spur tooth, its tip (edge along the contact), edges askew."""

    def tip(x: Array, y: Array) -> Array:
        return np.asarray(x[:, None] ** 2 / 5e3 + y**2 / 20.0 + np.maximum(y - 0.05, 0.0) ** 2 / (2.0 * RADIUS))

    def roller(x: Array, y: Array) -> Array:
        return np.asarray(x[:, None] ** 2 / 20.0 + np.maximum(np.abs(y) - 10.0, 0.0) ** 2 / (2.0 * RADIUS))

    ends = tuple(RoundedEdge((0.0, side * 10.0), (0.0, side), RADIUS) for side in (1.0, -1.0))
    return (
        Case(
            "face end, 4 mm, 500 N",
            face,
            ((-0.15, 0.15), (-2.0, 2.1)),
            (RoundedEdge((0.0, 2.0), (0.0, 1.0), RADIUS),),
            500.0,
        ),
        Case("both face ends, 20 mm, 5676 N", roller, ((-0.25, 0.25), (-10.2, 10.2)), ends, 5676.0),
        Case(
            "tip, 20 mm, 2000 N",
            tip,
            ((-10.0, 10.0), (-0.3, 0.1)),
            (RoundedEdge((0.0, 0.05), (0.0, 1.0), RADIUS),),
            2000.0,
        ),
        *(oblique(sine) for sine in (0.1, 0.5, 0.9)),
    )


def table_of_times(runs: int) -> str:
    """Seconds against error, one line a case and number of cells."""
    rows = []
    for case in cases():
        exact = case.solved(EXACT_CELLS if case.edges[0].normal[0] == 0.0 else CELLS_ON_ARC[-1])
        several = CELLS_ON_ARC if case.edges[0].normal[0] == 0.0 else CELLS_ON_ARC[:-1]
        for on_arc in several:
            found, seconds = timed(lambda case=case, on_arc=on_arc: case.solved(on_arc), runs)
            cells = " x ".join(str(n) for n in found.solution.problem.cells)
            error, estimate = 100.0 * (found.pressure / exact.pressure - 1.0), 100.0 * found.error
            rows.append(
                f"{case.name} | {on_arc:g} | {cells} | {found.solution.iterations} | {found.pressure:.0f} "
                f"| {error:+.2f} | {estimate:.1f} | {found.cells_on_arc:.1f} | {statistics.median(seconds):.3f}"
            )
            print(line(rows[-1]), flush=True)
    return table("contact | m | cells | iterations | peak MPa | error % | estimate % | cells on d | s", rows)


def table_of_closed_form() -> str:
    """Errors of the punch by cells on the arc, columns that begin where the rounding does and others."""
    rows, exact = [], PUNCH.peak()[1]
    for on_arc in (2, 3, 4, 5, 6, 7, 10, 14, 20, 28):
        found = [plane_punch(PUNCH, on_arc, shift=shift) for shift in (0.0, 0.5)]
        peaks = [100.0 * (top(y, one.pressure[0])[1] / exact - 1.0) for y, one in found]
        y, one = found[0]
        flat = np.abs(y) < 0.98 * PUNCH.half_width
        worst = 100.0 * float(np.abs(one.pressure[0][flat] / PUNCH.pressure(y[flat]) - 1.0).max())
        rows.append(f"{on_arc} | {y.size} | {peaks[0]:+.2f} | {peaks[1]:+.2f} | {worst:.2f}")
    return table("cells on d | columns | peak % | peak %, columns off by half a cell | flat part, largest %", rows)


PAGE = """# Peak pressure at rounded edges

Written by `python -m validation.contact.rounded_edge`; [the contact
solver](../how_it_works/contact_solver.md#rounded-edges) says how it is found.

{machine}; one thread.

## Flat punch with rounded ends

Closed form: a 0.1, R 0.2, b 0.11 mm, E* 113187 MPa, 174.53 N/mm: 2185.0 MPa at 0.10302 mm. d is 0.0102 mm. Errors
of the peak, and of the pressure on the flat part. The peak is the top of a parabola through the squares of three
pressures.

{closed_form}

The error of the peak times the square of the cells is 0.13 at the most where a column begins with the rounding: 4 cells
give 1 %, 5 give 0.5 %. Columns off by half a cell need 7.

## Time against error

A contact is solved several times: first with 0.6 m cells on the pressed width d, in the end with m cells. The time is
that of all solutions, the median of {runs} runs. Columns: cells and iterations of the last solution; error against
{exact:g} cells on d (askew: {askew:g}); the estimate that is returned; cells that are on the pressed part
in the end.

{times}

The machine was not idle: single times scatter by up to 1.5. An edge askew to the columns has fine cells along both
axes, a quarter more of them than m. Its error is larger at the same m, and so is its estimate.
"""


def page(runs: int) -> Page:
    """Measure, each contact so many times."""
    with one_thread():
        times = table_of_times(runs)
    text = PAGE.format(
        machine=machine(),
        closed_form=table_of_closed_form(),
        times=times,
        runs=runs,
        exact=EXACT_CELLS,
        askew=CELLS_ON_ARC[-1],
    )
    return Page("rounded_edge", text)


if __name__ == "__main__":
    write_page(__doc__, page, runs=RUNS)
