r"""The contact of two elastic half-spaces over a gap that is known on a grid of rectangular cells.

The pressures p, constant on a cell, minimise

.. math:: \tfrac12 p^T K p + h^T p,\qquad 0 \le p \le p_Y,\qquad \sum p\,dA = F

(K: Love's influence coefficients, h: gap before loading). The multiplier of the last condition is the approach
of the bodies. The minimum is found on nested grids, the coarser ones giving the start of the finer ones, each by
projected conjugate gradients in the neighbourhood of the contact; the contact conditions are checked with one
convolution on the whole grid before a result is believed.

References
----------
Polonsky & Keer 1999, Wear 231, 206-219; Liu, Wang & Liu 2000, Wear 243, 101-111 (convolution by FFT); Almqvist,
Sahlin, Larsson & Glavatskih 2007, Tribol. Int. 40, 574-579 (cap on the pressure).
"""

import math
import warnings
from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from loaded_tca.arrays import Array
from loaded_tca.contact import checks
from loaded_tca.contact.columns import check_columns, in_grid_units
from loaded_tca.contact.convolution import Window
from loaded_tca.contact.descent import Descent, Grid, Judgement, judge
from loaded_tca.contact.edges import FreeEdge, check_edges, mirrors, without_material_beyond
from loaded_tca.contact.levels import coarsening, prolong, window_around
from loaded_tca.contact.problem import OUT_OF_REACH, Problem, Spacing
from loaded_tca.contact.solution import CoarserGrid, ContactSolution, ContactStatus
from loaded_tca.errors import AccuracyWarning, ConvergenceError

# Iterations on one grid. Rough surfaces need about a hundred, smooth ones less than ten.
MOST_ITERATIONS = 500
# Checks on the whole grid; every one that fails widens the window or starts from an exact displacement.
MOST_CHECKS = 20
# A coarse grid is solved so much less closely than the next finer one: as closely costs as much as it brings, four
# times less closely (as its own error is larger) brings an iteration more on the finest grid of a smooth contact.
COARSE_FACTOR = 2.0
COARSE_TOLERANCE = 1e-3
# The iteration stops a little below the tolerance, so that the check in double precision finds it kept.
RESERVE = 0.8
# Above this tolerance the first displacement on a grid may be in single precision; the check is in double always.
SINGLE_PRECISION = 1e-6


def solve_contact(
    gap: ArrayLike,
    spacing: Spacing,
    contact_modulus: float,
    *,
    load: float | None = None,
    approach: float | None = None,
    max_pressure: float | None = None,
    tolerance: float = 1e-6,
    on_failure: Literal["raise", "return"] = "raise",
    initial_pressure: ArrayLike | None = None,
    threads: int = 2,
    warn: bool = True,
    free_edges: Sequence[FreeEdge] = (),
    column_compliance: ArrayLike | None = None,
) -> ContactSolution:
    r"""Press two elastic half-spaces together over a gap.

    Parameters
    ----------
    gap : (nx, ny) array_like [mm]
        Gap between the surfaces before loading; +inf where there is no material. A constant in it moves the
        approach by as much and changes nothing else.
    spacing : (float, float) [mm]
        Width of a cell along the first and the second axis.
    contact_modulus : float [MPa]
        E*, 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2.
    load : float, optional [N]
        Normal load, not negative; zero gives zero pressure and the smallest gap as the approach.
    approach : float, optional [mm]
        Approach of the bodies, counted as ``gap`` is. Exactly one of load and approach has to be given.
    max_pressure : float, optional [MPa]
        Cap on the pressure: elastic, perfectly plastic surface.
    tolerance : float
        Largest violation of the contact conditions over the approach from first touch.
    on_failure : {"raise", "return"}
        What to do without convergence: raise, or return the last iterate with its status.
    initial_pressure : (nx, ny) array_like, optional [MPa]
        Where to start from, such as the solution of a neighbouring position; nested grids if absent.
    threads : int
        Threads of large transforms; the result does not depend on them. Workers of a pool keep to one.
    warn : bool
        Whether to give an AccuracyWarning for each of ``solution.accuracy_warnings``.
    free_edges : sequence of FreeEdge
        Where the bodies end beside the contact: nothing is carried beyond, and the images of the pressure in these
        edges make up for what a half-space would be too stiff. Half-spaces if there are none.
    column_compliance : (ny, ny) array_like [mm/N], optional
        What bends beneath the half-spaces: displacement of every column (cells of one place along the second axis)
        under a unit force on each of them; symmetric, and positive definite together with the half-spaces.

    Returns
    -------
    ContactSolution
        ``pressure`` [MPa], ``gap`` [mm] after loading, ``approach`` [mm], ``load`` [N] and how they were found.

    Raises
    ------
    InputError
        Before work starts, with every problem of the arguments.
    ConvergenceError
        If the tolerance is not reached within a bounded number of iterations; ``last`` holds the last iterate.

    Warns
    -----
    AccuracyWarning
        If the contact reaches the border of the grid, or is fewer than 8 cells across.

    Examples
    --------
    A sphere of 10 mm radius on a plane; Hertz: 1420.7 MPa.

    >>> import numpy as np
    >>> x = np.linspace(-0.3, 0.3, 64)
    >>> gap = (x[:, None] ** 2 + x**2) / (2 * 10.0)
    >>> solution = solve_contact(gap, (x[1] - x[0],) * 2, 115e3, load=112.0)
    >>> bool(abs(solution.peak_pressure - 1420.7) < 1.0)
    True
    """
    gap, start = np.asarray(gap, dtype=np.float64), _optional_array(initial_pressure)
    columns = _optional_array(column_compliance)
    spacing, edges = (float(spacing[0]), float(spacing[1])), tuple(free_edges)
    checks.raise_if(
        checks.check_grid(gap, spacing, contact_modulus)
        + checks.check_run(tolerance, on_failure, start, gap.shape)
        + check_edges(edges)
        + check_columns(columns, gap.shape)
    )
    gap = without_material_beyond(gap, spacing, edges)
    checks.raise_if([] if np.isfinite(gap).any() else ["free_edges: no cell within them holds material"])
    material = np.isfinite(gap)
    area = np.count_nonzero(material) * spacing[0] * spacing[1]
    checks.raise_if(checks.check_demand(load, approach, max_pressure, area))
    lowest = float(gap[material].min())
    problem = Problem(
        gap=gap - lowest,
        spacing=spacing,
        contact_modulus=contact_modulus,
        load=load,
        approach=0.0 if approach is None else approach - lowest,
        max_pressure=math.inf if max_pressure is None else max_pressure,
        threads=threads,
        free_edges=edges,
        columns=columns,
    )
    solution = _solve(problem, lowest, tolerance, start)
    if warn:
        for sentence in solution.accuracy_warnings:
            warnings.warn(sentence, AccuracyWarning, stacklevel=2)
    if solution.status is ContactStatus.NOT_CONVERGED and on_failure == "raise":
        raise ConvergenceError(_failure(solution, tolerance), last=solution)
    return solution


def contact_stiffness(solution: ContactSolution, tolerance: float = 1e-6) -> float:
    """Tangent stiffness dF/d(approach) of a solved contact [N/mm].

    The pressure q that moves every cell between the bounds by one, K q = 1 there and q = 0 elsewhere, carries the
    load that an approach of one would add if no cell changed sides; in the limit of a small approach none does.

    Parameters
    ----------
    solution : ContactSolution
        A solution of :func:`solve_contact`.
    tolerance : float
        Relative residual of K q = 1.

    Returns
    -------
    float [N/mm]
        Zero where nothing touches, or where every cell in contact is at the cap.

    Raises
    ------
    ConvergenceError
        If the tolerance is not reached.
    """
    cap = math.inf if solution.max_pressure is None else solution.max_pressure
    active = solution.in_contact & (solution.pressure < cap)
    if not active.any():
        return 0.0
    window = window_around(active)
    # A flat punch of the shape of the cells between the bounds, pressed in by one: its load is the stiffness.
    gap = np.where(active[window], 0.0, OUT_OF_REACH)
    edges = mirrors(solution.free_edges, solution.spacing, window)
    columns = in_grid_units(solution.column_compliance, window, solution.spacing, solution.contact_modulus)
    grid = Grid(gap, solution.spacing[1] / solution.spacing[0], None, 1.0, math.inf, edges, columns)
    descent = Descent(grid, np.zeros(gap.shape))
    state = descent.run(tolerance, MOST_ITERATIONS)
    if state.residual > tolerance:
        raise ConvergenceError(f"contact_stiffness: residual {state.residual:.1e} > tolerance {tolerance:.1e}")
    return float(descent.pressure.sum()) * solution.spacing[1] * solution.contact_modulus


def _optional_array(values: ArrayLike | None) -> Array | None:
    return None if values is None else np.asarray(values, dtype=np.float64)


def _failure(solution: ContactSolution, tolerance: float) -> str:
    return (
        f"contact not converged: residual {solution.residual:.1e} > tolerance {tolerance:.1e} after "
        f"{solution.iterations} iterations; try a larger tolerance (in scenes: analysis.tolerance), or "
        "on_failure='return' to look at it"
    )


def _solve(problem: Problem, lowest: float, tolerance: float, start: Array | None) -> ContactSolution:
    """Solve on nested grids, or from a start; no load is answered at once."""
    if problem.load == 0.0 or (problem.load is None and problem.approach <= 0.0):
        return _no_load(problem, lowest)
    if start is not None and start.any():
        window, pressure, coarse = *_cropped(problem, problem.fitted(start)), None
    else:
        window, pressure, coarse = _from_coarser(problem, tolerance)
    return _finest(problem, lowest, tolerance, window, pressure, coarse)


def _no_load(problem: Problem, lowest: float) -> ContactSolution:
    """Zero pressure; the approach is the smallest gap, or as prescribed."""
    approach = 0.0 if problem.load == 0.0 else problem.approach
    return ContactSolution(
        pressure=np.zeros(problem.gap.shape),
        gap=problem.gap - approach,
        approach=lowest + approach,
        load=0.0,
        iterations=0,
        convolutions=0,
        residual=0.0,
        status=ContactStatus.NO_LOAD,
        spacing=problem.spacing,
        contact_modulus=problem.contact_modulus,
        max_pressure=None if math.isinf(problem.max_pressure) else problem.max_pressure,
        first_touch=lowest,
        coarser=None,
        free_edges=problem.free_edges,
        column_compliance=problem.columns,
    )


def _from_coarser(problem: Problem, tolerance: float) -> tuple[Window, Array, CoarserGrid | None]:
    """Window, and start in it [mm], for a grid, from the solution on the next coarser one, solved in the same way."""
    merge = coarsening((problem.gap.shape[0], problem.gap.shape[1]))
    if merge == (1, 1):
        uniform = problem.reachable.astype(np.float64) if problem.load is not None else np.zeros(problem.gap.shape)
        return *_cropped(problem, problem.fitted(uniform)), None
    coarse = problem.coarser(merge)
    tolerance = max(tolerance, min(COARSE_TOLERANCE, COARSE_FACTOR * tolerance))
    window, start, _ = _from_coarser(coarse, tolerance)
    descent = Descent(coarse.grid(window), start, threads=problem.threads, exact=False)
    state = descent.run(tolerance, MOST_ITERATIONS)
    pressure = np.zeros(coarse.gap.shape)
    pressure[window] = descent.pressure / coarse.unit
    largest = float(pressure.max())
    found = CoarserGrid(largest, state.approach) if largest > 0.0 else None
    return *_cropped(problem, problem.fitted(prolong(pressure, problem.gap.shape, merge))), found


def _cropped(problem: Problem, pressure: Array) -> tuple[Window, Array]:
    """Window around the contact, the whole grid where nothing is in contact yet; the pressure [mm] in it."""
    touching = pressure > 0.0
    window = window_around(touching if touching.any() else problem.reachable)
    return window, pressure[window] * problem.unit


def _finest(
    problem: Problem, lowest: float, tolerance: float, window: Window, start: Array, coarse: CoarserGrid | None
) -> ContactSolution:
    """Solve in a window around the contact, check on the whole grid, widen the window where the check says so."""
    shape = problem.gap.shape
    exact = tolerance < SINGLE_PRECISION
    descent = Descent(problem.grid(window), start, threads=problem.threads, exact=exact)
    iterations = convolutions = 0
    for _ in range(MOST_CHECKS):
        descent.run(RESERVE * tolerance, MOST_ITERATIONS - iterations)
        whole = problem.grid()
        check = whole.operator(window, threads=problem.threads)
        displacement = check(descent.settle(), np.empty(shape))
        pressure = np.zeros(shape)
        pressure[window] = descent.pressure
        state = judge(whole, pressure, np.add(displacement, whole.gap, out=whole.gap))
        iterations += descent.iterations
        convolutions += descent.convolutions + check.count
        if state.residual <= tolerance or iterations >= MOST_ITERATIONS:
            break
        window = window_around(state.free | (pressure > 0.0))
        part = np.ascontiguousarray(displacement[window])
        descent = Descent(problem.grid(window), pressure[window], part, problem.threads)
    displacement += problem.gap
    displacement -= state.approach
    return _solution(problem, lowest, tolerance, pressure, displacement, state, (iterations, convolutions), coarse)


def _solution(
    problem: Problem,
    lowest: float,
    tolerance: float,
    pressure: Array,
    gap: Array,
    state: Judgement,
    counts: tuple[int, int],
    coarse: CoarserGrid | None,
) -> ContactSolution:
    """Put a solution together in the units of the user."""
    pressure = problem.in_user_units(pressure)
    load = float(pressure.sum()) * problem.spacing[0] * problem.spacing[1]
    return ContactSolution(
        pressure=pressure,
        gap=gap,
        approach=lowest + state.approach,
        load=load if problem.load is None else problem.load,
        iterations=counts[0],
        convolutions=counts[1],
        residual=state.residual,
        status=ContactStatus.CONVERGED if state.residual <= tolerance else ContactStatus.NOT_CONVERGED,
        spacing=problem.spacing,
        contact_modulus=problem.contact_modulus,
        max_pressure=None if math.isinf(problem.max_pressure) else problem.max_pressure,
        first_touch=lowest,
        coarser=None if coarse is None else replace(coarse, approach=lowest + coarse.approach),
        free_edges=problem.free_edges,
        column_compliance=problem.columns,
    )
