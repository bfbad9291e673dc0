"""One tooth pair at one position solved under a normal force: its box, its grids, with teeth that bend.

What other tooth pairs do to a contact: they move its slices.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from loaded_tca.arrays import Array, Mask
from loaded_tca.compliance.model import BendingModel
from loaded_tca.contact import ContactProblem, ContactSolution
from loaded_tca.contact.adaptive import TOLERANCE_SHARE, refinement
from loaded_tca.contact.checks import memory_problem
from loaded_tca.contact.patch import ends_at_material, values_at_ends
from loaded_tca.edges.places import has_relief_starts
from loaded_tca.errors import InputError
from loaded_tca.loaded.line_load import SliceLoads
from loaded_tca.loaded.loaded_contact import LoadedContact
from loaded_tca.loaded.together import Bend, Ends, Gap, Steps, Task, run_alone
from loaded_tca.pairs.gear_pair import ContactGrid, GearPair
from loaded_tca.plain import plain
from loaded_tca.separation import Separation
from loaded_tca.separation.arcs import arcs_beside
from loaded_tca.separation.flank_places import border_of, past_relief_starts
from loaded_tca.separation.strips import strip_pressure
from loaded_tca.unloaded import ContactPoint

Coupling = Callable[[ContactGrid], Array | None]
"""Displacement of the slices of a tooth pair's grid (ny,) [mm] by what the other pairs carry; None if nothing bends."""


FIRST_CELLS, FIRST_CELLS_AT_ENDS = (16, 16), (16, 32)
"""Grids from which an accuracy is approached, doubled as often as needed. Where flanks end in the box, edges cut the
contact obliquely, and the load changes along it within a part of its length."""
MARGIN_LEFT = 0.8
"""Expected contact over its box."""
SMALLEST_LOAD = 1e-15
"""Loads below this times E* m_n^2 are none: the gap they close is rounding (1e-9 N at module 3)."""
CAP_USE = 0.6
"""Share of what the material in the box can carry at the cap that may be used: the contact needs room to spread."""
GROWTH = 1.5
MOST_BOXES = 8


@dataclass(frozen=True)
class GridChoice:
    """How finely a contact is resolved: on ``cells`` as given, or on as many as ``accuracy`` needs.

    ``free_edges``: whether the tips and faces of the teeth are softer than a half-space. ``agreement``: to which the
    rotations of the tooth pairs agree, relative; None: as the cells or the accuracy ask for. ``forces_on_grid_axis``:
    whether the forces of slices bend the teeth where their grid says, instead of at the centres of the pressure.
    """

    cells: tuple[int, int] | None = None
    accuracy: float = 1e-2
    tolerance: float = 1e-6
    free_edges: bool = False
    agreement: float | None = None
    forces_on_grid_axis: bool = False


def solve_under_load(
    pair: GearPair,
    contact: ContactPoint,
    load: float,
    grid: GridChoice,
    bending: BendingModel | None = None,
    number: int = 0,
) -> LoadedContact:
    """Contact of one tooth pair at one position under a normal force; see :func:`contact_under_load`."""
    return run_alone(pair, contact_under_load(pair, contact, load, grid, bending, number))


def contact_under_load(
    pair: GearPair,
    contact: ContactPoint,
    load: float,
    grid: GridChoice,
    bending: BendingModel | None = None,
    number: int = 0,
    coupling: Coupling | None = None,
    *,
    solved_again: bool = False,
) -> Steps[LoadedContact]:
    """Contact of one tooth pair at one position under a normal force, step by step.

    The box is the estimated one, made larger as long as the contact reaches it.

    Parameters
    ----------
    pair : GearPair
    contact : ContactPoint
    load : float [N]
        Normal force, >= 0.
    grid : GridChoice
    bending : BendingModel, optional
        Of the teeth beneath the half-spaces; default: none.
    number : int
        Of the tooth pair, as the bending model counts.
    coupling : callable, optional
        Displacement of the slices of a grid by what other tooth pairs carry at the same time; default: none.
    solved_again : bool
        Whether the contact is solved once more under another load, :meth:`LoadedContact.with_bending_lines`: teeth then
        bend at the centres of the pressure of the grid before where an accuracy is asked for.

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
    cells = grid.cells or FIRST_CELLS
    if (problem := memory_problem(cells)) is not None:
        raise InputError(f"cells: {problem}")
    load = 0.0 if 0.0 < load <= SMALLEST_LOAD * pair.contact_modulus * pair.module**2 else load
    cells_at_ends = FIRST_CELLS_AT_ENDS if grid.cells is None else None
    first = yield Gap(contact, cells, load=load, cells_at_ends=cells_at_ends)
    separation = yield from _box_for_cap(pair, contact, load, first)
    if grid.cells is None and separation.cover.min() < 1.0:
        cells = FIRST_CELLS_AT_ENDS
    if separation.gap.shape != cells:
        separation = yield Gap(contact, cells, box=separation.box, polynomials=separation.polynomials)
    for _ in range(MOST_BOXES):
        contact_in_box = _InBox(pair, contact, load, grid, separation, bending, number, coupling)
        loaded = yield from contact_in_box.steps(solved_again=solved_again)
        if not loaded.solution.reaches_border:
            break
        box = loaded.separation.box.grown(loaded.filled_ends, GROWTH)
        separation = yield Gap(contact, cells, box=box, polynomials=separation.polynomials)
    return loaded


def _box_for_cap(pair: GearPair, contact: ContactPoint, load: float, separation: Separation) -> Steps[Separation]:
    """A box whose material carries the load at the cap on the pressure, if the flank has so much."""
    cap = math.inf if pair.max_pressure is None else pair.max_pressure
    while load > CAP_USE * separation.material_area * cap:
        along = separation.box.half_lengths[1] < pair.face_width
        box = separation.box.grown(((True, True), (along, along)), GROWTH)
        cells = separation.gap.shape[0], separation.gap.shape[1]
        wider = yield Gap(contact, cells, box=box, polynomials=separation.polynomials)
        if wider.material_area <= separation.material_area:
            most = CAP_USE * separation.material_area * cap
            raise InputError(
                f"load: {plain(load, 6)} N is more than the flank carries at max_pressure, {plain(cap, 6)} MPa: about "
                f"{plain(most)} N"
            )
        separation = wider
    return separation


class _InBox:
    """A contact solved in one box: on the cells that were given, else on finer and finer ones.

    Parameters are those of :func:`contact_under_load`; ``first`` is the first grid.
    """

    def __init__(
        self,
        pair: GearPair,
        contact: ContactPoint,
        load: float,
        grid: GridChoice,
        first: Separation,
        bending: BendingModel | None,
        number: int,
        coupling: Coupling | None,
    ) -> None:
        self.pair, self.contact, self.load, self.grid, self.first = pair, contact, load, grid, first
        self.bending, self.number, self.coupling = bending, number, coupling
        self.tolerance = grid.tolerance if grid.cells else min(grid.tolerance, TOLERANCE_SHARE * grid.accuracy)
        # of the grid solved last, and the line loads on all of them
        self.separation = first
        self.displaced: Array | None = None
        self.bent: Array | None = None
        self.ends: Array | None = None
        self.line_loads: list[Callable[[], SliceLoads]] = []

    def steps(self, *, solved_again: bool) -> Steps[LoadedContact]:
        loaded = yield from self._refined()
        if self.grid.forces_on_grid_axis or self.load == 0.0:
            return loaded
        if self.bending is None:
            return replace(loaded, separation=loaded.separation.loaded_by(loaded.solution.pressure, self.pair.module))
        if loaded.solution.reaches_border:
            return loaded
        if solved_again and self.grid.cells is None:
            return replace(loaded, judged=(float(loaded.solution.pressure.max()), self.load))
        bent = yield from loaded.with_bending_lines(self.bending, self.number, self.pair.module)
        coupling = None if self.coupling is None else self.coupling(bent.separation)
        bent = yield from bent.at_load(self.load, coupling)
        judged = loaded if self.grid.cells is None else bent  # the first lines on given cells are the axis of the grid
        return replace(bent, judged=(float(judged.solution.pressure.max()), self.load))

    def _refined(self) -> Steps[LoadedContact]:
        """Solve with teeth that bend at the centres of the pressure on the grid before."""
        pair, contact, grid = self.pair, self.contact, self.grid
        if grid.cells is not None:
            solution = yield from self._solved(grid.cells, self.tolerance)
        else:
            first, cells = self.first, (self.first.x.size, self.first.y.size)
            across_start = _crosses_relief_start(pair, contact, first, expected_pressure(first))
            expected = strip_pressure(first.cut_gap, first.spacing, self.load, pair.contact_modulus) * first.cover

            def smooth(solution: ContactSolution) -> bool:
                pressure = solution.pressure_on_material
                return not (across_start or _reaches_arc(_cells_on_arcs(pair, self.separation, pressure), pressure))

            solution, *_ = yield from refinement(self._solved, grid.accuracy, grid.tolerance, smooth, cells, expected)
        on_material = solution.pressure_on_material
        on_arc = _cells_on_arcs(pair, self.separation, on_material)
        return LoadedContact(
            contact,
            self.separation,
            solution,
            at_relief_start=_crosses_relief_start(pair, contact, self.separation, on_material),
            at_arc=_reaches_arc(on_arc, on_material),
            ends_on_arc=_ends_on_arc(on_arc, on_material),
            tolerance=self.tolerance,
            coupling_deflection=self.displaced,
            bending=self.bent,
            ends=self.ends,
            line_loads=tuple(self.line_loads[-2:]),
        )

    def _solved(self, cells: tuple[int, int], tolerance: float, start: Array | None = None) -> Steps[ContactSolution]:
        """Solve on a grid of the box."""
        separation = self.first
        if separation.gap.shape != cells:
            separation = yield Gap(self.contact, cells, box=self.first.box, polynomials=self.first.polynomials)
        if start is not None and self.bending is not None and not self.grid.forces_on_grid_axis:
            separation = separation.loaded_by(start, self.pair.module)
        self.separation = separation
        self.displaced = None if self.coupling is None else self.coupling(separation)
        self.bent = None if self.bending is None else (yield Bend(self.bending, self.number, separation))
        self.ends = (yield Ends(separation)) if self.grid.free_edges else None
        problem = contact_problem(self.pair, separation, self.load, self.bent, self.ends, self.displaced)
        solution: ContactSolution = yield Task(problem, tolerance, start)
        if self.load > 0.0:
            self.line_loads.append(partial(SliceLoads, self.pair.module, separation, solution.pressure))
        return solution


def contact_problem(
    pair: GearPair,
    separation: Separation,
    load: float,
    bent: Array | None,
    ends: Array | None,
    displaced: Array | None = None,
) -> ContactProblem:
    """The contact problem of a pair on a grid.

    ``bent`` and ``ends``: slice compliance of its teeth and of its free edges, (ny, ny) [mm/N]; ``displaced``:
    displacement of its slices by other pairs, (ny,) [mm]; None where there are none.
    """
    return ContactProblem(
        separation.cut_gap if displaced is None else separation.cut_gap + displaced,
        separation.spacing,
        pair.contact_modulus,
        load=load,
        max_pressure=pair.max_pressure,
        slice_compliance=bent if ends is None else ends if bent is None else bent + ends,
        cover=separation.cover,
    )


def _crosses_relief_start(pair: GearPair, contact: ContactPoint, separation: Separation, pressure: Array) -> bool:
    """Whether the start of a linear relief, of either flank, runs through the contact, whose ends lie within cells."""
    if contact.on_relief_start:
        return True
    if not has_relief_starts(pair):
        return False
    pressed = pressure > 0.0
    border = border_of(pressed)  # a start that runs through a contact crosses its border
    for past in past_relief_starts(pair, separation, border):
        values = np.concatenate([past[pressed & border], values_at_ends(pressure, past, separation.cover)])
        if values.min() < 0.0 < values.max():
            return True
    return False


def _cells_on_arcs(pair: GearPair, separation: Separation, pressure: Array) -> Mask:
    """Cells at the border of a contact that lie on the arc of any rounded edge."""
    return np.asarray(arcs_beside(pair, separation, pressure > 0.0).any(axis=-1))


def _reaches_arc(on_arc: Mask, pressure: Array) -> bool:
    """Whether cells on the arc of a rounded edge are under pressure, or the contact goes on to where one begins."""
    return bool(pressure[on_arc].any()) or ends_at_material(np.where(on_arc, 0.0, pressure), on_arc)


def _ends_on_arc(on_arc: Mask, pressure: Array) -> bool:
    """Whether an end slice of a contact, at its largest pressure, or what comes next along it lies on an arc."""
    if not on_arc.any():
        return False
    carrying = np.flatnonzero(pressure.any(axis=0))
    ends = [(carrying[0], carrying[0] - 1), (carrying[-1], carrying[-1] + 1)] if carrying.size else []
    return any(
        bool(on_arc[pressure[:, end].argmax(), place])
        for end, beyond in ends
        for place in (end, beyond)
        if 0 <= place < pressure.shape[1]
    )


def expected_pressure(separation: Separation) -> Array:
    """Pressure over the ellipse that the contact is expected to fill, (nx, ny), the highest one 1."""
    box = separation.box
    (across, along), (x, y) = (MARGIN_LEFT * np.array(box.half_lengths), box.middle)
    square = 1.0 - ((separation.x[:, None] - x) / across) ** 2 - ((separation.y - y) / along) ** 2
    return np.sqrt(np.maximum(square, 0.0)) * separation.cover
