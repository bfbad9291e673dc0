r"""The contact of two elastic half-spaces over a gap that is known on a grid of rectangular cells.

The pressures p, constant on a cell, minimise

.. math:: \tfrac12 p^T K p + h^T p,\qquad 0 \le p \le p_Y,\qquad \sum p\,dA = F

(K: Love's influence coefficients, h: gap before loading). The multiplier of the last condition is the approach
of the bodies. The minimum is found on nested grids, the coarser ones giving the start of the finer ones, each by
projected conjugate gradients in the neighbourhood of the contact; the contact conditions are checked with one
convolution on the whole grid before a result is believed. Problems on small grids of one shape are stacked: each is
solved for itself, but all in the same arrays.

References
----------
Polonsky & Keer 1999, Wear 231, 206-219; Liu, Wang & Liu 2000, Wear 243, 101-111 (convolution by FFT); Almqvist,
Sahlin, Larsson & Glavatskih 2007, Tribol. Int. 40, 574-579 (cap on the pressure).
"""

from __future__ import annotations

import math
from collections.abc import Hashable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, numbers
from loaded_tca.contact import checks
from loaded_tca.contact.descent import Descent, judge
from loaded_tca.contact.edges import FreeEdge
from loaded_tca.contact.grid import LARGEST_WHOLE, OUT_OF_REACH, Grids, each, with_cap
from loaded_tca.contact.levels import coarsening, prolong, window_around
from loaded_tca.contact.problem import ContactProblem, Spacing
from loaded_tca.contact.solution import (
    COARSE_FACTOR,
    COARSE_TOLERANCE,
    MOST_CHECKS,
    MOST_ITERATIONS,
    RESERVE,
    CoarserGrid,
    ContactSolution,
    ContactStatus,
    OnFailure,
)
from loaded_tca.errors import ConvergenceError, InputError, give_accuracy_warning

# Cells of the problems in one stack at most: more arrays of it than that do not fit the cache of a core.
STACK_CELLS = 2**15
# Above this tolerance the first displacement on a grid may be in single precision; the check is in double always.
SINGLE_PRECISION = 1e-6


@checked
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
        Threads of large transforms; the result does not depend on them. See :mod:`loaded_tca.threads`.
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
        If the contact reaches the border of the grid or an end of the material, if the slope of the gap jumps inside
        it, if it is fewer than 8 cells across, or if the estimated error of its peak pressure is above 3 %.

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
            give_accuracy_warning(sentence)
    return solution


@checked
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
    return solve_problems([problem], [tolerance], [initial_pressure], on_failure=on_failure, threads=threads)[0]


def solve_problems(
    problems: Sequence[ContactProblem],
    tolerances: Sequence[float],
    initial_pressures: Sequence[ArrayLike | None],
    *,
    on_failure: OnFailure = "raise",
    threads: int = 2,
) -> list[ContactSolution]:
    """Solve contact problems together, each to its own tolerance, without warnings about their accuracy.

    Small grids of one shape are worked on in one array: from some ten problems on that takes a third of the time of one
    after the other, or less. What is found for a problem is the same to the last bit whatever the others are.

    Parameters
    ----------
    problems : sequence of ContactProblem
    tolerances : sequence of float
    initial_pressures : sequence of array_like or None
        Where to start from; nested grids where there is none.
    on_failure, threads
        As in :func:`solve_contact`.

    Returns
    -------
    list of ContactSolution
        In the order of the problems.

    Raises
    ------
    InputError
        Before work starts, with every problem of the arguments.
    ConvergenceError
        When all have ended, for the first one that is not solved; ``last`` holds its last iterate. With
        ``on_failure="return"`` the status of each tells.
    """
    starts = [None if start is None else numbers("initial_pressure", start) for start in initial_pressures]
    wrong = []
    for k, (problem, tolerance, start) in enumerate(zip(problems, tolerances, starts, strict=True)):
        name = f"problem {k}: " if len(problems) > 1 else ""
        wrong += [
            name + problem_of_run
            for problem_of_run in checks.check_run(tolerance, on_failure, start, problem.cells, threads)
        ]
    checks.raise_if(wrong)
    starts = [None if start is None or not start.any() else start for start in starts]
    solutions: dict[int, ContactSolution] = {}
    for stack in _stacks(problems, tolerances, starts):
        chosen = [problems[k] for k in stack], np.array([tolerances[k] for k in stack]), [starts[k] for k in stack]
        solutions |= zip(stack, _solve_stack(*chosen, threads), strict=True)
    for k, problem in enumerate(problems):
        if k not in solutions:
            approach = problem.first_contact if problem.approach is None else float(problem.approach)
            solutions[k] = ContactSolution.without_load(problem, approach)
        solutions[k].checked(tolerances[k], on_failure, f"contact {k}" if len(problems) > 1 else "contact")
    return [solutions[k] for k in range(len(problems))]


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
    gap = np.where(active[window], 0.0, OUT_OF_REACH)[None]
    part, prescribed = Grids.of([problem]).part(window), each([np.nan])
    punch = replace(part, gap=gap, total=prescribed, approach=each([1.0]), cap=each([np.inf]))
    descent = Descent(punch, np.zeros(gap.shape))
    descent.run(np.array([tolerance]), np.array([MOST_ITERATIONS]))
    residual = float(descent.residual[0])
    if residual > tolerance:
        raise ConvergenceError(f"contact_stiffness: residual {residual:.1e} > tolerance {tolerance:.1e}")
    return float(descent.pressure.sum()) * problem.spacing[1] * problem.contact_modulus


def _stacks(
    problems: Sequence[ContactProblem], tolerances: Sequence[float], starts: Sequence[Array | None]
) -> list[list[int]]:
    """Numbers of the problems that are solved together; those without load are in none."""
    alike: dict[Hashable, list[int]] = {}
    for k, (problem, tolerance, start) in enumerate(zip(problems, tolerances, starts, strict=True)):
        approach = problem.approach
        if problem.load == 0.0 or (approach is not None and approach <= problem.first_contact):
            continue
        given = start is None, approach is None, problem.slice_compliance is None, problem.cover is None
        edges = k if problem.free_edges else None
        key = problem.cells, tolerance < SINGLE_PRECISION, problem.cap_is_near, edges, *given
        alike.setdefault(key, []).append(k)
    stacks = []
    for numbers_of in alike.values():
        size = max(1, STACK_CELLS // math.prod(problems[numbers_of[0]].cells))
        stacks += [numbers_of[start : start + size] for start in range(0, len(numbers_of), size)]
    return stacks


def _unit(problem: ContactProblem) -> float:
    """Pressure of a grid (p dx/E*) for 1 MPa [mm/MPa]."""
    return problem.spacing[0] / problem.contact_modulus


def _solve_stack(
    problems: Sequence[ContactProblem], tolerance: Array, starts: Sequence[Array | None], threads: int
) -> list[ContactSolution]:
    """Solve problems on grids of one shape: from the pressures given, or from the solutions on coarser grids."""
    grids = Grids.of(problems)
    coarser: list[tuple[Array, float] | None] = [None] * len(problems)
    given = [start * _unit(problem) for start, problem in zip(starts, problems, strict=True) if start is not None]
    if given:
        pressure = grids.fitted(np.stack(given))
    else:
        pressure, solved = _start_from_coarser(grids, tolerance, threads)
        for k, (own, approach) in enumerate(solved):
            if own.any():
                coarser[k] = own / _unit(problems[k]), approach
    solutions = []
    for rows in _together(grids):
        some = problems[rows], grids.select(rows), tolerance[rows], pressure[rows], coarser[rows]
        solutions += _solve_on_finest(*some, threads)
    return solutions


def _together(grids: Grids) -> list[slice]:
    """Problems of a stack that are iterated together: all if they are small, else one after the other."""
    if len(grids) == 1 or math.prod(grids.shape) <= LARGEST_WHOLE:
        return [slice(None)]
    return [slice(k, k + 1) for k in range(len(grids))]


def _start_from_coarser(grids: Grids, tolerance: Array, threads: int) -> tuple[Array, list[tuple[Array, float]]]:
    """Start for grids from the solutions on the next coarser ones, solved in the same way.

    Also returns their pressures and approaches from first contact on; none without coarser ones.
    """
    merge = coarsening(grids.shape)
    if merge == (1, 1):
        return grids.guess(), []
    coarse = grids.coarser(merge)
    tolerance = np.maximum(tolerance, np.minimum(COARSE_TOLERANCE, COARSE_FACTOR * tolerance))
    start, _ = _start_from_coarser(coarse, tolerance, threads)
    pressure, approach = np.zeros(start.shape), np.empty(len(grids))
    for rows in _together(coarse):
        some, own = coarse.select(rows), start[rows]
        window = some.window(own)
        descent = Descent(some.part(window), own[:, *window], threads=threads, exact=False)
        descent.run(tolerance[rows], np.full(len(own), MOST_ITERATIONS))
        approach[rows], pressure[rows, *window] = descent.approach, descent.pressure / merge[0]
    start = grids.fitted(prolong(pressure, grids.shape, merge))
    return start, list(zip(pressure, approach.tolist(), strict=True))


def _solve_on_finest(
    problems: Sequence[ContactProblem],
    grids: Grids,
    tolerance: Array,
    start: Array,
    coarser: Sequence[tuple[Array, float] | None],
    threads: int,
) -> list[ContactSolution]:
    """Solve in a window around the contact, check on the whole grid, widen the window where the check says so."""
    window, exact = grids.window(start), bool(tolerance[0] < SINGLE_PRECISION)
    iterations, convolutions = np.zeros((2, len(grids)), dtype=int)
    solutions: dict[int, ContactSolution] = {}
    # Those still to be solved, and where they go on from.
    rows, start, displaced = np.arange(len(grids)), np.ascontiguousarray(start[:, *window]), None
    for check in range(MOST_CHECKS):
        whole = grids.part(grids.whole)
        part = whole if window == grids.whole else grids.part(window)
        descent = Descent(part, start, displaced, threads, exact)
        descent.run(RESERVE * tolerance[rows], MOST_ITERATIONS - iterations[rows])
        iterations[rows] += descent.iterations
        convolutions[rows] += descent.convolutions + 1
        pressure = np.zeros(whole.gap.shape)
        pressure[:, *window] = part.settled(descent.pressure)
        del descent  # its work arrays are a sixth of what a large grid takes at most
        displacement = whole.operator(window, threads=threads)(pressure, np.empty(pressure.shape))
        state = judge(whole, pressure, displacement + whole.gap)
        approach, residual = state.approach[:, 0, 0], state.residual[:, 0, 0]
        ended = (residual <= tolerance[rows]) | (iterations[rows] >= MOST_ITERATIONS) | (check == MOST_CHECKS - 1)
        for k in np.flatnonzero(ended).tolist():
            problem, own = problems[rows[k]], pressure[k]
            own /= _unit(problem)
            if problem.max_pressure is not None:
                own = with_cap(own, problem.cap)
            before = coarser[rows[k]]
            gap = displacement[k]
            gap += grids.gap[k]
            gap -= approach[k]
            change = math.nan if before is None else abs(1.0 - before[1] / float(approach[k]))
            solutions[rows[k]] = ContactSolution(
                pressure=own,
                gap=gap,
                approach=problem.first_contact + float(approach[k]),
                load=float(own.sum()) * problem.cell_area if problem.load is None else problem.load,
                iterations=int(iterations[rows[k]]),
                convolutions=int(convolutions[rows[k]]),
                residual=float(residual[k]),
                status=ContactStatus.CONVERGED if residual[k] <= tolerance[rows[k]] else ContactStatus.NOT_CONVERGED,
                problem=problem,
                coarser=None if before is None else CoarserGrid(before[0], own, change),
            )
        left = np.flatnonzero(~ended)
        if not left.size:
            break
        rows, grids, pressure, displacement = rows[left], grids.select(left), pressure[left], displacement[left]
        if window != grids.whole:
            window = window_around(state.free[0] | (pressure[0] > 0.0))
        start, displaced = (np.ascontiguousarray(array[:, *window]) for array in (pressure, displacement))
    return [solutions[k] for k in range(len(problems))]
