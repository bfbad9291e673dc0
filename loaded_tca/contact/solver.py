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

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from loaded_tca.arrays import Array, numbers
from loaded_tca.contact import checks
from loaded_tca.contact.descent import Descent, judge
from loaded_tca.contact.edges import FreeEdge
from loaded_tca.contact.grid import AT_BOUND, OUT_OF_REACH, Grid
from loaded_tca.contact.levels import coarsening, prolong, window_around
from loaded_tca.contact.problem import ContactProblem, Spacing
from loaded_tca.contact.solution import CoarserGrid, ContactSolution, ContactStatus
from loaded_tca.errors import AccuracyWarning, ConvergenceError, InputError

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


OnFailure = Literal["raise", "return"]


def solve_contact(
    gap: ArrayLike,
    spacing: Spacing,
    contact_modulus: float,
    *,
    load: float | None = None,
    approach: float | None = None,
    max_pressure: float | None = None,
    tolerance: float = 1e-6,
    on_failure: OnFailure = "raise",
    initial_pressure: ArrayLike | None = None,
    threads: int = 2,
    warn: bool = True,
    free_edges: Sequence[FreeEdge] = (),
    slice_compliance: ArrayLike | None = None,
) -> ContactSolution:
    r"""Solve the contact of two elastic half-spaces over a gap.

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
        Largest violation of the contact conditions over the approach from first contact.
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
    slice_compliance : (ny, ny) array_like [mm/N], optional
        Bending beneath the half-spaces: displacement of every slice (cells of one place along the second axis)
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
    gap = numbers("gap", gap)
    start = None if initial_pressure is None else numbers("initial_pressure", initial_pressure)
    try:
        problem = ContactProblem(
            gap,
            spacing,
            contact_modulus,
            load=load,
            approach=approach,
            max_pressure=max_pressure,
            free_edges=free_edges,
            slice_compliance=slice_compliance,  # type: ignore[arg-type]
        )
    except InputError as error:
        run = checks.check_run(tolerance, on_failure, start, gap.shape, threads)
        raise InputError([*error.problems, *run]) from None
    solution = solve_problem(
        problem, tolerance=tolerance, on_failure=on_failure, initial_pressure=start, threads=threads
    )
    if warn:
        for sentence in solution.accuracy_warnings:
            warnings.warn(sentence, AccuracyWarning, stacklevel=2)
    return solution


def solve_problem(
    problem: ContactProblem,
    *,
    tolerance: float = 1e-6,
    on_failure: OnFailure = "raise",
    initial_pressure: ArrayLike | None = None,
    threads: int = 2,
) -> ContactSolution:
    """Solve a contact problem, without warnings about its accuracy.

    Parameters
    ----------
    problem : ContactProblem
    tolerance, on_failure, initial_pressure, threads
        As in :func:`solve_contact`.

    Returns
    -------
    ContactSolution

    Raises
    ------
    InputError, ConvergenceError
        As :func:`solve_contact` does.
    """
    given = None if initial_pressure is None else numbers("initial_pressure", initial_pressure)
    checks.raise_if(checks.check_run(tolerance, on_failure, given, problem.gap.shape, threads))
    grid = Grid.of(problem)
    if problem.load == 0.0 or (problem.load is None and grid.approach <= 0.0):
        return _without_load(problem, grid.approach)
    if given is not None and given.any():
        start, coarser = grid.fitted(given * _unit(problem)), None
    else:
        start, coarser = _start_from_coarser(grid, tolerance, threads)
    solution = _solve_on_finest(problem, grid, tolerance, start, threads)
    if coarser is not None:
        coarser = CoarserGrid(coarser.largest / _unit(problem), problem.first_contact + coarser.approach)
        solution = replace(solution, coarser=coarser)
    if solution.status is ContactStatus.NOT_CONVERGED and on_failure == "raise":
        raise ConvergenceError(
            f"contact not converged: residual {solution.residual:.1e} > tolerance {tolerance:.1e} after "
            f"{solution.iterations} iterations; try a larger tolerance (in scenes: analysis.tolerance), or "
            "on_failure='return' to look at it",
            last=solution,
        )
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
        Zero where nothing is in contact, or where every cell in contact is at the cap.

    Raises
    ------
    ConvergenceError
        If the tolerance is not reached.
    """
    problem = solution.problem
    active = solution.in_contact & (solution.pressure < problem.cap)
    if not active.any():
        return 0.0
    window = window_around(active)
    # A flat punch of the shape of the cells between the bounds, moved in by one: its load is the stiffness.
    gap = np.where(active[window], 0.0, OUT_OF_REACH)
    punch = replace(Grid.of(problem).part(window), gap=gap, total=None, approach=1.0, cap=math.inf)
    descent = Descent(punch, np.zeros(gap.shape))
    state = descent.run(tolerance, MOST_ITERATIONS)
    if state.residual > tolerance:
        raise ConvergenceError(f"contact_stiffness: residual {state.residual:.1e} > tolerance {tolerance:.1e}")
    return float(descent.pressure.sum()) * problem.spacing[1] * problem.contact_modulus


def _unit(problem: ContactProblem) -> float:
    """Pressure of a grid (p dx/E*) for 1 MPa [mm/MPa]."""
    return problem.spacing[0] / problem.contact_modulus


def _without_load(problem: ContactProblem, approach: float) -> ContactSolution:
    """Zero pressure; the approach is the smallest gap, or as prescribed."""
    approach += problem.first_contact
    return ContactSolution(
        pressure=np.zeros(problem.gap.shape),
        gap=problem.gap - approach,
        approach=approach,
        load=0.0,
        iterations=0,
        convolutions=0,
        residual=0.0,
        status=ContactStatus.NO_LOAD,
        problem=problem,
    )


def _start_from_coarser(grid: Grid, tolerance: float, threads: int) -> tuple[Array, CoarserGrid | None]:
    """Start for a grid from the solution on the next coarser one, solved in the same way; what that one found."""
    merge = coarsening(grid.shape)
    if merge == (1, 1):
        return grid.fitted(np.zeros(grid.shape)), None
    coarse = grid.coarser(merge)
    tolerance = max(tolerance, min(COARSE_TOLERANCE, COARSE_FACTOR * tolerance))
    start, _ = _start_from_coarser(coarse, tolerance, threads)
    window = coarse.window(start)
    descent = Descent(coarse.part(window), start[window], threads=threads, exact=False)
    state = descent.run(tolerance, MOST_ITERATIONS)
    pressure = np.zeros(coarse.shape)
    pressure[window] = descent.pressure / merge[0]
    largest = float(pressure.max())
    found = CoarserGrid(largest, state.approach) if largest > 0.0 else None
    return grid.fitted(prolong(pressure, grid.shape, merge)), found


def _solve_on_finest(
    problem: ContactProblem, grid: Grid, tolerance: float, start: Array, threads: int
) -> ContactSolution:
    """Solve in a window around the contact, check on the whole grid, widen the window where the check says so."""
    window = grid.window(start)
    whole = grid.part((slice(0, grid.shape[0]), slice(0, grid.shape[1])))
    descent = Descent(grid.part(window), start[window], threads=threads, exact=tolerance < SINGLE_PRECISION)
    iterations = convolutions = 0
    excess = np.empty(grid.shape)
    for _ in range(MOST_CHECKS):
        descent.run(RESERVE * tolerance, MOST_ITERATIONS - iterations)
        displacement = whole.operator(window, threads=threads)(descent.settle(), np.empty(grid.shape))
        pressure = np.zeros(grid.shape)
        pressure[window] = descent.pressure
        state = judge(whole, pressure, np.add(displacement, whole.gap, out=excess))
        iterations += descent.iterations
        convolutions += descent.convolutions + 1
        if state.residual <= tolerance or iterations >= MOST_ITERATIONS:
            break
        window = window_around(state.free | (pressure > 0.0))
        part = np.ascontiguousarray(displacement[window])
        descent = Descent(grid.part(window), pressure[window], part, threads)
    displacement += grid.gap
    displacement -= state.approach
    pressure[window] /= _unit(problem)
    if problem.max_pressure is not None:  # what is at the cap but for rounding is exactly at it from here on
        pressure = np.where(pressure >= (1.0 - AT_BOUND) * problem.cap, problem.cap, pressure)
    return ContactSolution(
        pressure=pressure,
        gap=displacement,
        approach=problem.first_contact + state.approach,
        load=float(pressure.sum()) * problem.cell_area if problem.load is None else problem.load,
        iterations=iterations,
        convolutions=convolutions,
        residual=state.residual,
        status=ContactStatus.CONVERGED if state.residual <= tolerance else ContactStatus.NOT_CONVERGED,
        problem=problem,
    )
