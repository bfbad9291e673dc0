"""The coarsest grid that answers a contact problem as closely as asked."""

import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace

from numpy.typing import ArrayLike

from loaded_tca.contact.edges import FreeEdge
from loaded_tca.contact.levels import prolong
from loaded_tca.contact.problem import Spacing
from loaded_tca.contact.solution import CoarserGrid, ContactSolution
from loaded_tca.contact.solver import solve_contact
from loaded_tca.errors import AccuracyWarning, InputError

Cells = tuple[int, int]
Sampler = Callable[[Cells], tuple[ArrayLike, Spacing]]

# The residual of the iteration is kept this far below the accuracy, so that the grid alone limits it.
TOLERANCE_SHARE = 1e-2
MOST_CELLS = 1024
# Where a border bounds the contact its pressure grows with the grid without end.
MOST_CELLS_AT_A_BORDER = 64


def solve_to_accuracy(
    sampler: Sampler,
    contact_modulus: float,
    *,
    accuracy: float,
    load: float | None = None,
    approach: float | None = None,
    max_pressure: float | None = None,
    tolerance: float = 1e-6,
    smooth: bool = True,
    first_cells: Cells = (16, 16),
    initial_pressure: ArrayLike | None = None,
    threads: int = 2,
    warn: bool = True,
    free_edges: Sequence[FreeEdge] = (),
    column_compliance: Callable[[Cells], ArrayLike | None] | None = None,
) -> ContactSolution:
    """Refine the grid until the estimated error is below the accuracy.

    Each grid has twice the cells of the one before along both axes and starts from its pressure. The accuracy is
    that of the peak pressure; where the grid or the material ends the contact it is that of the approach, with at
    most 64 cells along an axis.

    Parameters
    ----------
    sampler : callable
        ``sampler((nx, ny))`` gives the gap [mm] on a grid of so many cells, and the spacing [mm] of it; the same
        surface and the same box for every number of cells.
    contact_modulus : float [MPa]
        E*.
    accuracy : float
        Wanted relative error, between 0 and 1.
    load, approach, max_pressure, tolerance, threads, warn, free_edges
        As in :func:`solve_contact`; the tolerance is tightened to a hundredth of the accuracy. A first grid that
        cannot be the last is solved to that hundredth.
    smooth : bool
        False where the surfaces have a relief start or an end inside the contact: treated as where a border bounds it.
    first_cells : (int, int)
        Where to begin. The estimate needs two grids: the answer has at least twice as many.
    initial_pressure : array_like of first_cells, optional [MPa]
        A guess on the first grid, in any unit if the load is given.
    column_compliance : callable, optional
        What :func:`solve_contact` takes by this name, for the grid that the sampler gave last.

    Returns
    -------
    ContactSolution
        On the first grid that is fine enough, its ``error_estimate`` being that of the last two grids.

    Raises
    ------
    InputError, ConvergenceError
        As :func:`solve_contact` does, and if the accuracy is not between 0 and 1.

    Warns
    -----
    AccuracyWarning
        If the finest grid allowed does not reach the accuracy, and for the accuracy_warnings about the answer.

    Examples
    --------
    >>> import numpy as np
    >>> def sphere(cells):
    ...     x, y = ((np.arange(n) + 0.5) * 0.6 / n - 0.3 for n in cells)
    ...     return (x[:, None] ** 2 + y**2) / 20.0, (0.6 / cells[0], 0.6 / cells[1])
    >>> solution = solve_to_accuracy(sphere, 115e3, load=112.0, accuracy=1e-3)
    >>> solution.pressure.shape, bool(abs(solution.peak_pressure / 1420.7 - 1.0) < 1e-3)
    ((64, 64), True)
    """
    if not 0.0 < accuracy < 1.0:
        raise InputError(f"accuracy: {accuracy} is not between 0 and 1")

    closely = TOLERANCE_SHARE * accuracy

    def solve(cells: Cells, start: ArrayLike | None, tolerance: float) -> ContactSolution:
        gap, spacing = sampler(cells)
        return solve_contact(
            gap,
            spacing,
            contact_modulus,
            load=load,
            approach=approach,
            max_pressure=max_pressure,
            tolerance=tolerance,
            initial_pressure=start,
            threads=threads,
            warn=False,
            free_edges=free_edges,
            column_compliance=None if column_compliance is None else column_compliance(cells),
        )

    tolerance, refined = min(closely, tolerance), max(first_cells) < MOST_CELLS_AT_A_BORDER
    cells, solution = first_cells, solve(first_cells, initial_pressure, closely if refined else tolerance)
    while not (good := _error(solution, smooth) <= accuracy) and max(cells) < _most_cells(solution, smooth):
        coarse, cells = solution, (2 * cells[0], 2 * cells[1])
        solution = _compared(solve(cells, prolong(coarse.pressure, cells, (2, 2)), tolerance), coarse)
    if warn:
        late = () if good else (f"estimated error {_error(solution, smooth):.1e} is above the accuracy {accuracy:.1e}",)
        for sentence in late + solution.accuracy_warnings:
            warnings.warn(sentence, AccuracyWarning, stacklevel=2)
    return solution


def _error(solution: ContactSolution, smooth: bool) -> float:
    """Estimated error of what the accuracy is asked for; infinite where there is no estimate yet."""
    estimate = solution.error_estimate
    error = estimate.peak_pressure if smooth and not solution.bounded else estimate.approach
    return math.inf if math.isnan(error) else error


def _most_cells(solution: ContactSolution, smooth: bool) -> int:
    return MOST_CELLS if smooth and not solution.bounded else MOST_CELLS_AT_A_BORDER


def _compared(fine: ContactSolution, coarse: ContactSolution) -> ContactSolution:
    """The finer solution with the error that the step from the coarser one shows."""
    if not coarse.pressure.any():
        return fine
    return replace(fine, coarser=CoarserGrid(float(coarse.pressure.max()), coarse.approach))
