"""The coarsest grid that answers a contact problem as closely as asked."""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, Never, TypeVar

from numpy.typing import ArrayLike

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, count_problems, numbers, real
from loaded_tca.contact.checks import MOST_CELLS
from loaded_tca.contact.levels import prolong
from loaded_tca.contact.problem import ContactProblem
from loaded_tca.contact.solution import LARGE_ERROR, CoarserGrid, ContactSolution
from loaded_tca.contact.solver import solve_problem
from loaded_tca.errors import give_accuracy_warning, require
from loaded_tca.plain import plain

Cells = tuple[int, int]
Request = TypeVar("Request")

# The residual of the iteration is kept this far below the accuracy, so that the grid alone limits it.
TOLERANCE_SHARE = 1e-2
# Where a border bounds the contact, or a slope jumps in it, its pressure grows with the grid without end; where the
# curvature of the gap jumps each further bit of its peak costs four times the cells of the one before.
MOST_CELLS_FOR_FIRST_ORDER = 64


@checked
def solve_to_accuracy(
    problem: Callable[[Cells], ContactProblem],
    *,
    accuracy: float,
    tolerance: float = 1e-6,
    smooth: bool = True,
    first_cells: Cells = (16, 16),
    initial_pressure: ArrayLike | None = None,
    threads: int = 2,
    warn: bool = True,
) -> ContactSolution:
    """Refine the grid until the estimated error is below the accuracy.

    Each grid has twice the cells of the one before along both axes and starts from its pressure. The accuracy is
    that of the peak pressure; from 64 cells on, along the axis that has fewer, as if its error fell with the square of
    the cell, which it does not where the curvature of the gap jumps. Where the pressure has no limit on the two finest
    grids (the grid or the material ends the contact, or the slope of the gap jumps inside it) the accuracy is that of
    the approach, with at most 64 cells along the axis that has fewer.

    Parameters
    ----------
    problem : callable
        ``problem((nx, ny))`` gives the contact problem on a grid of so many cells; the same surfaces, box and load
        for every number of cells.
    accuracy : float
        Wanted relative error, between 0 and 1.
    tolerance, threads, warn
        As in :func:`solve_contact`; the tolerance is tightened to a hundredth of the accuracy. A first grid that
        cannot be the last is solved to that hundredth.
    smooth : bool
        False where the surfaces are known to have a relief start or an end inside the contact: treated as where a
        border bounds it, whatever the gap tells.
    first_cells : (int, int)
        Where to begin. The estimate needs two grids: the answer has at least twice as many.
    initial_pressure : array_like of first_cells, optional [MPa]
        A guess on the first grid, in any unit if the load is given.

    Returns
    -------
    ContactSolution
        On the first grid that is fine enough, its ``error_estimate`` being that of the last two grids: on at least 64
        cells ``second_order`` is within the accuracy, ``peak_pressure`` may be above. Where the accuracy is that of the
        approach, ``approach`` is within it.

    Raises
    ------
    InputError, ConvergenceError
        As :func:`solve_contact` does, and if the accuracy is not between 0 and 1 or the first grid is none.

    Warns
    -----
    AccuracyWarning
        If the finest grid allowed does not reach the accuracy; if the accuracy is that of the approach and the
        estimated error of the peak pressure is above it; if that error is above 3 % and above the accuracy; and for
        the other accuracy_warnings about the answer.

    Examples
    --------
    >>> import numpy as np
    >>> def sphere(cells):
    ...     x, y = ((np.arange(n) + 0.5) * 0.6 / n - 0.3 for n in cells)
    ...     gap, spacing = (x[:, None] ** 2 + y**2) / 20.0, (0.6 / cells[0], 0.6 / cells[1])
    ...     return ContactProblem(gap, spacing, 115e3, load=112.0)
    >>> solution = solve_to_accuracy(sphere, accuracy=1e-3)
    >>> solution.pressure.shape, bool(abs(solution.peak_pressure / 1420.7 - 1.0) < 1e-3)
    ((64, 64), True)
    """
    two = isinstance(first_cells, Sequence) and len(first_cells) == 2
    require(
        (callable(problem), f"problem: {problem!r:.60} is not a function of the numbers of cells"),
        (0.0 < real(accuracy) < 1.0, f"accuracy: {accuracy} is not between 0 and 1"),
        (0.0 < real(tolerance) < 1.0, f"tolerance: {tolerance} is not between 0 and 1"),
        (
            two and not count_problems(dict(enumerate(first_cells)), 1),
            f"first_cells: {first_cells!r:.60} are not two whole numbers from 1 on",
        ),
    )
    start = None if initial_pressure is None else numbers("initial_pressure", initial_pressure)
    solve = partial(_solved, problem, threads)

    def limited(solution: ContactSolution) -> bool:
        return smooth and solution.slope_jump == 0.0

    try:
        next(refinement(solve, accuracy, tolerance, limited, first_cells, start))
    except StopIteration as end:
        solution, error, of_approach = end.value
    if warn:
        missed = _missed(solution, error, of_approach, accuracy)
        of_peak = missed or solution.estimate_warnings(max(accuracy, LARGE_ERROR))
        for sentence in of_peak + solution.grid_warnings:
            give_accuracy_warning(sentence)
    return solution


def _missed(solution: ContactSolution, error: float, of_approach: bool, accuracy: float) -> tuple[str, ...]:
    """Sentences on the figures whose estimated error is above the accuracy; ``of_approach``: it is that of another."""
    figures = [("approach" if of_approach else "peak pressure", error, "")]
    if of_approach:
        limit = "; where the pressure has no limit, this accuracy holds for the approach"
        figures.append(("peak pressure", solution.error_estimate.peak_pressure, limit))
    return tuple(
        f"the estimated error of the {figure}, {'unknown' if math.isnan(size) else plain(size, 2)}, is above the "
        f"accuracy {plain(accuracy)}{limit}"
        for figure, size, limit in figures
        if not size <= accuracy
    )


def _solved(
    problem: Callable[[Cells], ContactProblem], threads: int, cells: Cells, tolerance: float, start: Array | None
) -> Generator[Never, None, ContactSolution]:
    """The solution on a grid, at once: a generator that asks for nothing."""
    yield from ()
    return solve_problem(problem(cells), tolerance=tolerance, initial_pressure=start, threads=threads)


def refinement(
    solved: Callable[[Cells, float, Array | None], Generator[Request, Any, ContactSolution]],
    accuracy: float,
    tolerance: float,
    smooth: Callable[[ContactSolution], bool],
    first_cells: Cells,
    initial_pressure: Array | None,
) -> Generator[Request, Any, tuple[ContactSolution, float, bool]]:
    """Solve on finer and finer grids; return the last solution, its estimated error, and whether of the approach.

    ``solved(cells, tolerance, start)`` is a generator that returns the solution on a grid, and may ask for what it
    needs; ``smooth(solution)`` tells whether its peak is one of the surfaces, not of the grid. For the other parameters
    see :func:`solve_to_accuracy`.
    """
    closely, refined = TOLERANCE_SHARE * accuracy, min(first_cells) < MOST_CELLS_FOR_FIRST_ORDER
    tolerance, first = min(closely, tolerance), closely if refined else min(closely, tolerance)
    cells, ended_before = first_cells, True
    solution = yield from solved(cells, first, initial_pressure)
    while True:
        # What ends a contact inside the box makes the peak grow with the grid without end. A coarse grid alone does not
        # show it: where only one of two does, the peak has to agree as well.
        ended, estimate = solution.bounded or not smooth(solution), solution.estimate(0.0)
        fine = min(cells) >= MOST_CELLS_FOR_FIRST_ORDER
        error = estimate.second_order if fine and not ended else estimate.peak_pressure
        of_approach = ended and ended_before
        if of_approach:
            error = estimate.approach
        if error <= accuracy or (fine if ended else max(cells) >= MOST_CELLS):
            return solution, error, of_approach
        ended_before, coarse, cells = ended, solution, (2 * cells[0], 2 * cells[1])
        solution = yield from solved(cells, tolerance, prolong(coarse.pressure, cells, (2, 2)))
        if coarse.pressure.any():
            change = abs(solution.approach - coarse.approach) / solution.approach_under_load
            before = 0.0 if coarse.coarser is None else coarse.coarser.change_beside_peak
            solution = replace(solution, coarser=CoarserGrid(coarse.pressure, solution.pressure, change, before))
