"""One tooth pair at one position under a normal force: its box, its grid, its pressure map."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from loaded_tca.contact import ContactSolution, contact_stiffness, solve_contact
from loaded_tca.contact.checks import memory_problem
from loaded_tca.errors import InputError
from loaded_tca.pair import GearPair
from loaded_tca.reference.hertz import PointContact, point_contact
from loaded_tca.separation import Separation, cells_for_accuracy, sample_separation
from loaded_tca.unloaded import ContactPoint

BORDER_CELLS = 64
"""Most cells across where the contact reaches a border: the peak there grows with the grid without end."""
GROWTH = 1.5
MOST_BOXES = 8


@dataclass(frozen=True)
class GridChoice:
    """How finely a contact is resolved: ``cells`` as given, or as many as ``accuracy`` needs."""

    cells: tuple[int, int] | None = None
    accuracy: float = 1e-3
    tolerance: float = 1e-6

    @property
    def shape(self) -> tuple[int, int]:
        """Cells across and along."""
        return self.cells or (cells_for_accuracy(self.accuracy),) * 2


@dataclass(frozen=True, eq=False)
class LoadedContact:
    """Pressure of one tooth pair at one position.

    Attributes
    ----------
    contact : ContactPoint
        The unloaded contact it grows from.
    separation : Separation
    solution : ContactSolution
    """

    contact: ContactPoint
    separation: Separation
    solution: ContactSolution

    @property
    def at_border(self) -> bool:
        """Whether the contact reaches a border of a flank."""
        return bool(self.contact.on_edge) or _ends_at_material(self.solution)

    @property
    def peak_pressure(self) -> float:
        """Peak pressure [MPa]; the largest cell where the contact reaches a border."""
        return float(self.solution.pressure.max()) if self.at_border else self.solution.peak_pressure

    @property
    def hertz(self) -> PointContact | None:
        """Hertz's contact of the same curvatures and load; None where it does not hold (border, crease, no load)."""
        across, along = self.separation.curvatures
        smooth = along > 0.0 and not (self.at_border or self.contact.on_crease or self.contact.on_line)
        if not smooth or self.solution.load <= 0.0:
            return None
        return point_contact(self.solution.load, (across, along), self.solution.contact_modulus)

    @property
    def extent(self) -> tuple[float, float]:
        """Width across and length along of the cells under pressure [mm]."""
        (nx, ny), (dx, dy) = self.solution.cells_across, self.separation.spacing
        return nx * dx, ny * dy

    @property
    def stiffness(self) -> float:
        """Tangent stiffness dF/d approach [N/mm]; zero without load."""
        return contact_stiffness(self.solution) if self.solution.load > 0.0 else 0.0


def press(pair: GearPair, contact: ContactPoint, load: float, grid: GridChoice) -> LoadedContact:
    """Press one tooth pair together at one position.

    Parameters
    ----------
    pair : GearPair
    contact : ContactPoint
    load : float [N]
        Normal force, >= 0.
    grid : GridChoice

    Returns
    -------
    LoadedContact

    Raises
    ------
    InputError
        If the grid needs more memory than there is, before anything is allocated.
    ConvergenceError
        If the solver does not reach its tolerance.
    """
    if (problem := memory_problem(grid.shape)) is not None:
        raise InputError(problem)
    loaded = _in_growing_box(pair, contact, load, grid.shape, grid.tolerance)
    if loaded.at_border and grid.cells is None and grid.shape[0] > BORDER_CELLS:
        loaded = _in_growing_box(pair, contact, load, (BORDER_CELLS, BORDER_CELLS), grid.tolerance)
    return loaded


def _ends_at_material(solution: ContactSolution) -> bool:
    """Whether the material ends the contact, told within the last cell.

    At a smooth end of a contact p^2 falls linearly with the distance. Where the last cell beside a border has less
    than a third of the p^2 of the cell before it, that line reaches zero inside the last cell: the contact ends of
    itself.
    """
    square, void = solution.pressure**2, np.isinf(solution.gap)
    for axis in (0, 1):
        for direction in (1, -1):
            beyond, before = np.roll(void, -direction, axis), np.roll(square, direction, axis)
            edge = [slice(None), slice(None)]
            edge[axis] = slice(-1, None) if direction > 0 else slice(None, 1)
            beyond[tuple(edge)] = False
            if (beyond & (square > 0.0) & (3.0 * square >= before)).any():
                return True
    return False


def _in_growing_box(
    pair: GearPair, contact: ContactPoint, load: float, shape: tuple[int, int], tolerance: float
) -> LoadedContact:
    """Solve in the estimated box, and in a larger one as long as the contact reaches it."""
    separation = sample_separation(pair, contact, cells=shape, load=load)
    for attempt in range(MOST_BOXES):
        solution = solve_contact(
            separation.gap,
            separation.spacing,
            pair.contact_modulus,
            load=load,
            max_pressure=pair.max_pressure,
            tolerance=tolerance,
            warn=False,
        )
        grown = _grown_box(separation, solution)
        if grown is None or attempt == MOST_BOXES - 1:
            break
        separation = sample_separation(pair, contact, cells=shape, box=grown)
    return LoadedContact(contact, separation, solution)


def _grown_box(separation: Separation, solution: ContactSolution) -> tuple[float, float] | None:
    """Half lengths of a larger box [mm], if the contact reaches the outermost cells."""
    touched = [bool((np.take(solution.pressure, [0, -1], axis=axis) > 0.0).any()) for axis in (0, 1)]
    if not any(touched):
        return None
    sizes = zip(solution.pressure.shape, separation.spacing, touched, strict=True)
    across, along = (0.5 * n * step * (GROWTH if grow else 1.0) for n, step, grow in sizes)
    return across, along
