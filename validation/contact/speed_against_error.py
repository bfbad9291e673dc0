"""Time against error of this contact solver and of two others, in one run on one machine.

Circle, ellipse 10:1 and the gear ellipse of a crowned spur pair (about 80:1) under 100 N, box 1.5 times the contact.
Every code gets the same gap. Times are medians of warm solves, the first (cold) one apart. The residual is computed
here for every code from its pressure alone, with the contact conditions on the whole grid; the errors are against
Hertz. The other codes come with ``pip install 'loaded_tca[peers]'``; what is not installed is left out. Below them the
page has the table of ``validation.loaded.speed``.

Run from the root of the repository: ``python -m validation.contact.speed_against_error``.
"""

import statistics
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from loaded_tca.contact import ContactProblem, solve_contact, solve_to_accuracy
from loaded_tca.contact.convolution import Convolution
from loaded_tca.reference import hertz
from validation.loaded import speed as speed_of_mesh_cycle
from validation.page import Page, in_a_process, line, machine, peak_memory, table, timed, write_page

CYCLES = "What whole cycles of 33 positions and three torques take is in [Time of a mesh cycle](mesh_cycle_speed.md)."
Array = NDArray[np.float64]
E_STAR = 115e3
LOAD = 100.0
CASES = {"circle": (0.1, 0.1), "ellipse 10:1": (0.1, 0.1 / 37.4115), "gear 80:1": (1.0 / 10.9259, 1.0 / 15625.0)}


# Colours that stay apart for colour-blind readers (Okabe and Ito), markers, and where the grid is written beside a
# point [pt]; the points of the third code lie too close to those of the second.
STYLES = {
    "loaded_tca": ("#0072B2", "o", (-6, -10)),
    "Tamaas": ("#D55E00", "s", (7, 4)),
    "ContactMechanics": ("#009E73", "^", None),
}


@dataclass(frozen=True)
class Problem:
    """A Hertz contact on a grid of n x n cells."""

    case: str
    n: int
    contact: hertz.PointContact
    gap: Array
    spacing: tuple[float, float]
    tolerance: float

    @classmethod
    def make(cls, case: str, n: int, tolerance: float) -> "Problem":
        """Set the case up."""
        large, small = CASES[case]
        contact = hertz.point_contact(LOAD, (large, small), E_STAR)
        spacing = (3.0 * contact.semi_minor / n, 3.0 * contact.semi_major / n)
        x, y = ((np.arange(n) - (n - 1) / 2.0) * width for width in spacing)
        return cls(case, n, contact, 0.5 * large * x[:, None] ** 2 + 0.5 * small * y**2, spacing, tolerance)

    @property
    def hertz_pressure(self) -> Array:
        """Hertz at the centres of the cells."""
        x, y = ((np.arange(self.n) - (self.n - 1) / 2.0) * width for width in self.spacing)
        return self.contact.pressure(x[:, None], y)


@dataclass(frozen=True)
class Measurement:
    """One code on one problem; times in seconds, ``least`` and ``warm`` the least and the median of warm solves."""

    code: str
    problem: Problem
    cold: float
    least: float
    warm: float
    iterations: int
    convolutions: int
    residual: float
    peak: float
    field: float
    approach: float


Run = Callable[[], tuple[Array, float | None, int, int]]


def ours(problem: Problem) -> Run:
    """Set up this package: pressure, peak, iterations and convolutions on the grid given."""

    def run() -> tuple[Array, float | None, int, int]:
        found = solve_contact(
            problem.gap,
            problem.spacing,
            E_STAR,
            load=LOAD,
            tolerance=problem.tolerance,
            warn=False,
            on_failure="return",
        )
        return found.pressure, found.peak_pressure, found.iterations, found.convolutions

    return run


def tamaas(problem: Problem) -> Run:
    """Tamaas: the non-periodic operator has to be named to the solver too, and the traction reset before each run."""
    import tamaas as tm

    tm.set_log_level(tm.LogLevel.error)
    size = [problem.n * width for width in problem.spacing]
    model = tm.Model(tm.model_type.basic_2d, size, [problem.n, problem.n])
    model.E, model.nu = E_STAR, 0.0
    tm.ModelFactory.registerNonPeriodic(model, "dcfft")
    solver = tm.PolonskyKeerRey(model, -problem.gap, problem.tolerance)
    solver.setIntegralOperator("dcfft")

    def run() -> tuple[Array, float | None, int, int]:
        model.traction[:] = 0.0
        solver.solve(LOAD / (size[0] * size[1]))
        return np.array(model.traction), None, 0, 0

    return run


def contact_mechanics(problem: Problem) -> Run:
    """ContactMechanics: its tolerance is a length, here that of the other codes times the approach."""
    from ContactMechanics import FreeFFTElasticHalfSpace
    from ContactMechanics.Systems import NonSmoothContactSystem
    from SurfaceTopography import Topography

    size = tuple(problem.n * width for width in problem.spacing)
    substrate = FreeFFTElasticHalfSpace((problem.n, problem.n), young=E_STAR, physical_sizes=size)
    system = NonSmoothContactSystem(substrate=substrate, surface=Topography(-problem.gap, size))
    area = problem.spacing[0] * problem.spacing[1]

    def run() -> tuple[Array, float | None, int, int]:
        found = system.minimize_proxy(external_force=LOAD, pentol=problem.tolerance * problem.contact.approach)
        return np.abs(np.asarray(found.jac)) / area, None, int(found.nit), 0

    return run


CODES: dict[str, Callable[[Problem], Run]] = {
    "loaded_tca": ours,
    "Tamaas": tamaas,
    "ContactMechanics": contact_mechanics,
}


def judged(problem: Problem, pressure: Array) -> tuple[float, float]:
    """Residual of the contact conditions on the whole grid, and the approach, of any pressure."""
    aspect = problem.spacing[1] / problem.spacing[0]
    displacement = Convolution(problem.gap.shape, [aspect])(pressure[None], np.empty((1, *problem.gap.shape)))
    level = displacement[0] * problem.spacing[0] / E_STAR + problem.gap
    touching = pressure > 0.0
    approach = float(level[touching].mean())
    misfit = float((pressure * np.abs(level - approach)).sum() / pressure.sum())
    depth = max(0.0, float((approach - level[~touching]).max()))
    return max(misfit, depth) / approach, approach


def measure(code: str, problem: Problem, budget: float) -> Measurement:
    """Solve once cold, then warm until the budget [s] is spent, three times at least and nine at most."""

    def first() -> tuple[Run, tuple[Array, float | None, int, int]]:
        run = CODES[code](problem)
        return run, run()

    (run, (pressure, peak, iterations, convolutions)), (cold,) = timed(first)
    _, times = timed(run, 9, least=3, budget=budget)
    residual, approach = judged(problem, pressure)
    exact = problem.hertz_pressure
    return Measurement(
        code,
        problem,
        cold,
        min(times),
        statistics.median(times),
        iterations,
        convolutions,
        residual,
        abs((peak or float(pressure.max())) / problem.contact.max_pressure - 1.0),
        float(np.linalg.norm(pressure - exact) / np.linalg.norm(exact)),
        abs(approach / problem.contact.approach - 1.0),
    )


def plan(largest: int, largest_of_peers: int) -> Iterator[tuple[str, Problem]]:
    """Everything to measure: all tolerances for this solver, 1e-6 for the others on all grids."""
    for case in CASES:
        for n in (32, 64, 128, 256, 512, 1024, 2048):
            for tolerance in (1e-4, 1e-6, 1e-8):
                problem = Problem.make(case, n, tolerance)
                if n <= largest and (n <= 1024 or tolerance == 1e-6):
                    yield "loaded_tca", problem
                if tolerance == 1e-6 and n <= largest_of_peers:
                    yield from ((code, problem) for code in CODES if code != "loaded_tca")


def memory_above_imports(n: int) -> float:
    """Peak resident memory [MiB] of one solve in a process of its own, above that after the imports."""
    return in_a_process(memory_of_a_solve, n)


def memory_of_a_solve(n: int) -> float:
    """Solve the circle; by how much the peak memory [MiB] of this process grew; the gap counts too."""
    before = peak_memory()
    ours(Problem.make("circle", n, 1e-6))()
    return 1024.0 * (peak_memory() - before)


def accuracies() -> list[str]:
    """What :func:`solve_to_accuracy` takes for the gear ellipse, one line an accuracy."""
    case, found = "gear 80:1", []

    def sample(cells: tuple[int, int]) -> ContactProblem:
        problem = Problem.make(case, cells[0], 1e-6)
        return ContactProblem(problem.gap, problem.spacing, E_STAR, load=LOAD)

    exact = Problem.make(case, 16, 1e-6).contact.max_pressure
    for accuracy in (1e-3, 1e-4):
        solution, times = timed(lambda accuracy=accuracy: solve_to_accuracy(sample, accuracy=accuracy), 101)
        error = abs(solution.peak_pressure / exact - 1.0)
        found.append(
            f"{case}, accuracy {accuracy:.0e}: {solution.pressure.shape[0]} cells along an axis, error of the peak "
            f"{error:.0e}, {1e3 * min(times):.2g} ms at least, {1e3 * statistics.median(times):.2g} ms in the median"
        )
    return found


HEAD = "case | grid | tolerance | code | warm ms | least ms | cold ms | iterations | convolutions"
ERRORS = "residual | peak | field | approach"


def cells(m: Measurement) -> str:
    """Line of the table of a measurement."""
    p = m.problem
    return (
        f"{p.case} | {p.n} | {p.tolerance:.0e} | {m.code} | {1e3 * m.warm:.3g} | {1e3 * m.least:.3g} "
        f"| {1e3 * m.cold:.3g} | {m.iterations or '-'} | {m.convolutions or '-'} "
        f"| {m.residual:.1e} | {m.peak:.1e} | {m.field:.1e} | {m.approach:.1e}"
    )


def picture(found: list[Measurement]) -> Figure:
    """Time of a warm solve over the error of the pressure field, one panel a case."""
    figure = Figure(figsize=(12, 4), layout="constrained")
    panels = figure.subplots(1, len(CASES), sharey=True)
    for panel, case in zip(panels, CASES, strict=True):
        for code in CODES:
            chosen = [m for m in found if m.code == code and m.problem.case == case and m.problem.tolerance == 1e-6]
            if chosen:
                colour, marker, beside = STYLES[code]
                times = [1e3 * m.warm for m in chosen]
                panel.loglog([m.field for m in chosen], times, marker=marker, color=colour, label=code)
                for m, ms in zip(chosen, times, strict=True) if beside else ():
                    place = {
                        "xytext": beside,
                        "textcoords": "offset points",
                        "ha": "right" if beside[0] < 0 else "left",
                    }
                    panel.annotate(f"{m.problem.n}", (m.field, ms), color=colour, fontsize=8, **place)
        panel.margins(0.2, 0.12)
        panel.set(title=case, xlabel="relative error of the pressure field (L2, Hertz)")
        panel.grid(visible=True, which="both", alpha=0.3)
    panels[0].set_ylabel("time of a warm solve [ms]")
    panels[0].legend()
    return figure


def page(largest: int, largest_of_peers: int, budget: float) -> Page:
    """Measure on grids up to the largest ones; seconds of warm solves for each measurement."""
    found: list[Measurement] = []
    missing: set[str] = set()
    for code, problem in plan(largest, largest_of_peers):
        if code in missing:
            continue
        try:
            found.append(measure(code, problem, budget))
        except ImportError:
            missing.add(code)
            continue
        print(line(cells(found[-1])), flush=True)
    memory = {n: memory_above_imports(n) for n in (512, 1024) if n <= largest and Path("/proc").exists()}
    notes = [machine(), *(f"memory above the imports at {n} x {n}: {mib:.0f} MiB" for n, mib in memory.items())]
    notes += accuracies()
    notes += [f"not installed: {code}" for code in sorted(missing)]
    text = [
        "# Time against error\n",
        "Written by `python -m validation.contact.speed_against_error`;",
        "[the page on the contact solver](contact_solver.md#speed-against-error) says what is compared and how.\n",
        *(f"- {note}" for note in notes),
        "",
        table(f"{HEAD} | {ERRORS}", map(cells, found)),
        "",
        speed_of_mesh_cycle.heading(),
        "",
        speed_of_mesh_cycle.table_of(speed_of_mesh_cycle.measure()),
        "",
        CYCLES,
        "",
    ]
    pictures = {"speed_against_error": picture(found)}
    return Page("speed_against_error", "\n".join(text), pictures, dots_per_inch=110)


if __name__ == "__main__":
    write_page(__doc__, page, largest=2048, largest_of_peers=512, budget=2.0)
