"""One tooth pair at one position under a normal force: its box, its grid, its pressure map."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.contact import ContactProblem, ContactSolution, solve_problem
from loaded_tca.contact.adaptive import TOLERANCE_SHARE, refinement
from loaded_tca.contact.checks import memory_problem
from loaded_tca.contact.levels import under_other_load
from loaded_tca.contact.patch import ends_at_material, values_at_ends, widths
from loaded_tca.errors import InputError
from loaded_tca.loaded.line_load import SliceLoads
from loaded_tca.loaded.pair_coupling import BendingModel, Coupling
from loaded_tca.loaded.together import Ends, Gap, Steps, Task, found_alone
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.reference.hertz import PointContact, point_contact
from loaded_tca.separation import Separation
from loaded_tca.unloaded import ContactPoint
from loaded_tca.unloaded.arcs import arcs_at

FIRST_CELLS, FIRST_CELLS_AT_ENDS = (16, 16), (16, 32)
"""Grids from which an accuracy is approached, doubled as often as needed. Where flanks end in the box, edges cut the
contact obliquely, and the load changes along it within a part of its length."""
EXACT = 1e-9
"""Tolerance of the solver where the approach is given: forces then balance a torque to that."""
MARGIN_LEFT = 0.8
"""Expected contact over its box."""
SMALLEST_LOAD = 1e-15
"""Loads below this times E* m_n^2 are none: the gap they close is rounding (1e-9 N at module 3)."""
CAP_USE = 0.6
"""Share of what the material in the box can carry at the cap that may be used: the contact needs room to spread."""
EQUAL = 1e-3
"""Relative difference below which two cells have the same pressure, as the middle cells of an even grid do."""
LARGEST_MISFIT = 0.3
"""Of a gap from its paraboloid, where Hertz's pressure is still told: it differs by up to a tenth then; where a relief
begins in the ellipse the misfit is above 1."""
BESIDE = 0.5 + 1e-6
"""Distance over a cell along both axes within which cells lie beside the contact point."""
LEAST_ERROR_OF_SLICES = 3.0
"""Error of the largest pressure of slices times the square of the cells across the contact, at the most where two grids
agree by chance (``validation/loaded/error_estimates.py``)."""
GROWTH = 1.5
MOST_BOXES = 8


@dataclass(frozen=True)
class GridChoice:
    """How finely a contact is resolved: on ``cells`` as given, or on as many as ``accuracy`` needs.

    ``free_edges``: whether the tips and faces of the teeth are softer than a half-space. ``agreement``: to which the
    rotations of the tooth pairs agree, relative; None: as the cells or the accuracy ask for. ``lines_held``: whether
    the forces of slices bend the teeth where their grid says, instead of at the centres of the pressure.
    """

    cells: tuple[int, int] | None = None
    accuracy: float = 1e-3
    tolerance: float = 1e-6
    free_edges: bool = False
    agreement: float | None = None
    lines_held: bool = False


@dataclass(frozen=True, eq=False)
class LoadedContact:
    """Pressure of one tooth pair at one position.

    Attributes
    ----------
    contact : ContactPoint
        The unloaded contact it grows from.
    separation : Separation
    solution : ContactSolution
    at_relief_start : bool
        Whether the start of a linear relief lies in the contact.
    at_arc : bool
        Whether the contact reaches the arc of a rounded edge.
    tolerance : float
        To which the solver kept the contact conditions.
    coupling_deflection : (ny,) array or None [mm]
        Displacement of the slices under the load of other tooth pairs, if there are any.
    bending, ends : (ny, ny) array or None [mm/N]
        Slice compliance of the teeth, and of their free edges.
    line_load_error : float
        Estimated relative error of the pressure of slices by that of their line load, from the two finest grids; NaN
        where there was one.
    judged : (float, float) or None [MPa], [N]
        Largest pressure and load of the solution that the errors were estimated of: lines of forces and other pairs may
        have moved the pressure since. None: it is that.
    """

    contact: ContactPoint
    separation: Separation
    solution: ContactSolution
    at_relief_start: bool
    at_arc: bool = False
    tolerance: float = 1e-6
    coupling_deflection: Array | None = None
    bending: Array | None = None
    ends: Array | None = None
    line_load_error: float = math.nan
    judged: tuple[float, float] | None = None

    @property
    def is_rough(self) -> bool:
        """Whether its largest cell is no mesh-independent peak: at an edge or a relief start.

        Also where the contact is told to end of itself within the last cell, but has its peak there: which of both a
        grid tells is a matter of its cells.
        """
        return self.at_edge or self.at_relief_start or self._peaks_beside_end

    @cached_property
    def _peaks_beside_end(self) -> bool:
        """Whether the cell of the largest pressure lies beside the end of the material."""
        pressure = self.solution.pressure_on_material
        across, along = np.unravel_index(int(pressure.argmax()), pressure.shape)
        beside = tuple(slice(max(0, k - 1), k + 2) for k in (across, along))
        return bool(pressure[across, along] > 0.0 and np.isinf(self.separation.gap[beside]).any())

    @property
    def peak_error(self) -> float:
        """Estimated relative error of its peak, or where it is rough of the pressure of its slices, by the grid.

        No less than :attr:`peak_change`. NaN where there was one grid alone.
        """
        if not self.is_rough:
            return float(np.maximum(self.solution.error_estimate.peak_pressure, self.peak_change))
        least = LEAST_ERROR_OF_SLICES / min(self.solution.cells_across) ** 2
        return float(np.maximum(self.line_load_error, least))

    @property
    def peak_change(self) -> float:
        """Relative change of the largest pressure since its error was estimated, beyond that of the load.

        A peak grows less than its load. One that changes by more is another one than was judged: lines of forces that
        scatter move it. None is told where it is rough: what the other pairs carry moves the load to and from an edge.
        """
        if self.judged is None or self.solution.load == 0.0 or self.is_rough:
            return 0.0
        largest, load = self.judged
        changed = abs(math.log(float(self.solution.pressure.max()) / largest))
        return max(0.0, math.expm1(changed - abs(math.log(self.solution.load / load))))

    @property
    def at_edge(self) -> bool:
        """Whether the contact reaches an edge of a flank, or the arc of a rounded one."""
        return bool(self.contact.on_edge) or self.at_arc or self.solution.reaches_material_edge

    @property
    def peak_pressure(self) -> float:
        """Peak pressure [MPa]; that of the largest cell where the contact reaches an edge or a relief start."""
        return float(self.solution.pressure_on_material.max()) if self.is_rough else self.solution.peak_pressure

    @property
    def central_pressure(self) -> float:
        """Pressure beside the contact point [MPa]: what is left of the peak where that sits at an edge."""
        grid = self.separation
        beside = (np.abs(places) <= BESIDE * step for places, step in zip((grid.x, grid.y), grid.spacing, strict=True))
        middle = np.ix_(*beside)
        there = np.isfinite(grid.cut_gap[middle])
        return float(self.solution.pressure_on_material[middle][there].mean()) if there.any() else 0.0

    @property
    def line_load(self) -> float:
        """Largest force per length along the contact [N/mm]: pressure summed up across."""
        return float(self.solution.pressure.sum(axis=0).max()) * self.separation.spacing[0]

    @property
    def peak_place(self) -> tuple[float, float]:
        """Radius and axial coordinate on the pinion of the largest pressure [mm]: middle of the cells that share it."""
        pressure = self.solution.pressure
        top = np.unravel_index(int(pressure.argmax()), pressure.shape)
        beside = tuple(slice(max(0, k - 1), k + 2) for k in top)
        equal = pressure[beside] >= (1.0 - EQUAL) * pressure.max()
        x, y, z = self.separation.points[beside][equal].mean(axis=0)
        return math.hypot(x, y), float(z)

    @property
    def hertz(self) -> PointContact | None:
        """Hertz's contact of the same curvatures and load; None where it does not hold.

        That is at an edge, on a relief start or a line, without load, and where the curvature of the contact point is
        not that of the contact: on a flank with end relief alone the ellipse would be longer than the box, and where a
        relief begins in the ellipse the gap leaves the paraboloid.
        """
        across, along = self.separation.curvatures
        smooth = along > 0.0 and not (self.is_rough or self.contact.on_line)
        if not smooth or self.solution.load <= 0.0:
            return None
        ellipse = point_contact(self.solution.load, (across, along), self.solution.problem.contact_modulus)
        if ellipse.semi_major >= self.separation.box.half_lengths[1] or self._misfit(ellipse) > LARGEST_MISFIT:
            return None
        return ellipse

    def _misfit(self, ellipse: PointContact) -> float:
        """How far the gap leaves the paraboloid of the contact point, over its mean, both weighted with the pressure.

        The larger one of that after Hertz and the one found: a contact ends before its ellipse, or goes on far beyond.
        Infinite where no cell of the grid tells, the ellipse being smaller than one.
        """
        grid = self.separation
        x, y = grid.x[:, None], grid.y
        below = 1.0 - (x / ellipse.semi_minor) ** 2 - (y / ellipse.semi_major) ** 2
        paraboloid = 0.5 * (grid.curvatures[0] * x**2 + grid.curvatures[1] * y**2)
        gap, largest = np.abs(grid.gap - paraboloid), 0.0
        for weight in (np.sqrt(np.maximum(below, 0.0)), self.solution.pressure):
            inside = weight > 0.0
            mean = float(weight[inside] @ paraboloid[inside])
            largest = max(largest, float(weight[inside] @ gap[inside]) / mean if mean > 0.0 else math.inf)
        return largest

    @cached_property
    def extent(self) -> tuple[float, float]:
        """Width across and length along [mm]: of the contact ellipse; at an edge between its ends, within the cells.

        The width is that of the widest slice, so that a contact which leaves the axis of its grid is not the wider.
        """
        if not self.at_edge:
            minor, major = self.solution.semi_axes
            return 2.0 * minor, 2.0 * major
        pressure, cover = self.solution.pressure_on_material, self.separation.cover
        if not pressure.any():
            return 0.0, 0.0
        if self.solution.reaches_border:  # nothing lies beyond
            pressure, cover = np.pad(pressure, 1), np.pad(cover, 1)
        dx, dy = self.separation.spacing
        places = np.broadcast_to(np.arange(pressure.shape[1], dtype=np.float64), pressure.shape)
        length = float(np.ptp(values_at_ends(pressure, places, cover, (1,))))
        return float(widths(pressure, cover).max()) * dx, length * dy

    @property
    def filled_ends(self) -> tuple[tuple[bool, bool], tuple[bool, bool]]:
        """Whether pressure reaches the lower and the upper end of the box, across and along."""
        pressure = self.solution.pressure
        low, high = (bool(row.any()) for row in pressure[[0, -1]])
        return (low, high), (bool(pressure[:, 0].any()), bool(pressure[:, -1].any()))

    @cached_property
    def slice_force(self) -> Array:
        """Force on every slice of the grid, (ny,) [N]."""
        return np.asarray(self.solution.pressure.sum(axis=0) * self.solution.cell_area)

    @property
    def slice_shares(self) -> Array:
        """Shares of the slices in the force, which must not be zero, (ny,)."""
        return np.asarray(self.slice_force / self.slice_force.sum())

    @cached_property
    def own_tooth_deflection(self) -> float:
        """Deflection of the teeth under the pair's own load, the mean over the force [mm]."""
        force = self.slice_force
        if self.bending is None or not force.any():
            return 0.0
        return float(force @ self.bending @ force / force.sum())

    @property
    def contact_deformation(self) -> float:
        """Contact deformation [mm]: total deflection less bending, the mean over the force."""
        force, deflection = self.slice_force, self.solution.approach - self.own_tooth_deflection
        if self.coupling_deflection is None or not force.any():
            return deflection
        return float(deflection - self.coupling_deflection @ force / force.sum())

    def bent_by(self, bending: BendingModel, number: int, module: float) -> LoadedContact:
        """Return the contact as it is, to be solved next with teeth that bend at the centres of its pressure."""
        separation = self.separation.loaded_by(self.solution.pressure, module)
        bent = bending.within(number, separation)
        problem = replace(self.solution.problem, slice_compliance=bent if self.ends is None else bent + self.ends)
        return replace(self, separation=separation, bending=bent, solution=replace(self.solution, problem=problem))

    def line_error(self, module: float) -> float:
        """How far the forces that bend the teeth are from the centres of the pressure, the mean over the force [mm]."""
        force, centred = self.slice_force, self.separation.loaded_by(self.solution.pressure, module)
        moved = np.abs(centred.force_line - self.separation.force_line)
        return float(force @ moved / force.sum()) if force.any() else 0.0

    def under(self, load: float, coupling: Array | None = None) -> Steps[LoadedContact]:
        """Return the contact under another load > 0 [N] near this one, on the same grid and as closely solved.

        ``coupling``: displacement of the slices under the load of other pairs, if anything bends, (ny,) [mm].

        The estimated error is that of the grid: its share of the peak and of the approach is kept.
        """
        gap, before = self.separation.cut_gap, self.solution
        problem = replace(before.problem, load=load, gap=gap if coupling is None else gap + coupling)
        start = under_other_load(before.pressure, load / before.load)
        solution = replace((yield Task(problem, self.tolerance, start)), coarser=before.coarser)
        return replace(self, solution=solution, coupling_deflection=coupling)

    def at(self, approach: float, coupling: Array | None = None) -> LoadedContact:
        """Return the contact at another approach [mm], counted as the gap is, on the same grid; ``coupling`` as above.

        The estimated error is left as it is. The solution is closer than others: at a cap on the pressure the force
        depends on it.
        """
        before, gap = self.solution, self.separation.cut_gap
        gap = gap if coupling is None else gap + coupling
        problem = replace(before.problem, load=None, approach=approach, gap=gap)
        solution = solve_problem(problem, tolerance=EXACT, initial_pressure=before.pressure)
        if problem.max_pressure is not None:  # rounding, where all is at the cap
            solution = replace(solution, load=min(solution.load, problem.max_pressure * problem.material_area))
        problem = replace(problem, load=solution.load, approach=None)
        solution = replace(solution, problem=problem, coarser=before.coarser)
        return replace(self, solution=solution, coupling_deflection=coupling)


def solve_under_load(
    pair: GearPair,
    contact: ContactPoint,
    load: float,
    grid: GridChoice,
    bending: BendingModel | None = None,
    number: int = 0,
) -> LoadedContact:
    """Contact of one tooth pair at one position under a normal force; see :func:`contact_under_load`."""
    return found_alone(pair, contact_under_load(pair, contact, load, grid, bending, number))


def contact_under_load(
    pair: GearPair,
    contact: ContactPoint,
    load: float,
    grid: GridChoice,
    bending: BendingModel | None = None,
    number: int = 0,
    coupling: Coupling | None = None,
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
    separation = yield from _box_for_cap(pair, contact, load, (yield Gap(contact, cells, load=load)))
    if grid.cells is None and separation.cover.min() < 1.0:
        cells = FIRST_CELLS_AT_ENDS
        separation = yield Gap(contact, cells, box=separation.box)
    for _ in range(MOST_BOXES):
        loaded = yield from _InBox(pair, contact, load, grid, separation, bending, number, coupling).steps()
        if not loaded.solution.reaches_border:
            break
        separation = yield Gap(contact, cells, box=loaded.separation.box.grown(loaded.filled_ends, GROWTH))
    return loaded


def _box_for_cap(pair: GearPair, contact: ContactPoint, load: float, separation: Separation) -> Steps[Separation]:
    """A box whose material carries the load at the cap on the pressure, if the flank has so much."""
    cap = math.inf if pair.max_pressure is None else pair.max_pressure
    while load > CAP_USE * separation.material_area * cap:
        along = separation.box.half_lengths[1] < pair.face_width
        box = separation.box.grown(((True, True), (along, along)), GROWTH)
        wider = yield Gap(contact, (separation.gap.shape[0], separation.gap.shape[1]), box=box)
        if wider.material_area <= separation.material_area:
            most = CAP_USE * separation.material_area * cap
            raise InputError(
                f"load: {load:.6g} N is more than the flank carries at max_pressure, {cap:g} MPa: about {most:.4g} N"
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
        self.line_loads: list[SliceLoads] = []

    def steps(self) -> Steps[LoadedContact]:
        loaded = yield from self._refined()
        if self.grid.lines_held or self.load == 0.0 or loaded.solution.reaches_border:
            return loaded
        if self.bending is None:
            return replace(loaded, separation=loaded.separation.loaded_by(loaded.solution.pressure, self.pair.module))
        bent = loaded.bent_by(self.bending, self.number, self.pair.module)
        coupling = None if self.coupling is None else self.coupling(bent.separation)
        bent = yield from bent.under(self.load, coupling)
        judged = loaded if self.grid.cells is None else bent  # the first lines on given cells are the axis of the grid
        return replace(bent, judged=(float(judged.solution.pressure.max()), self.load))

    def _refined(self) -> Steps[LoadedContact]:
        """Solve with teeth that bend at the centres of the pressure on the grid before."""
        pair, contact, grid = self.pair, self.contact, self.grid
        if grid.cells is not None:
            solution = yield from self._solved(grid.cells, self.tolerance)
        else:
            expected, cells = expected_pressure(self.first), (self.first.x.size, self.first.y.size)
            across_start = _crosses_relief_start(pair, contact, self.first, expected)

            def smooth(solution: ContactSolution) -> bool:
                return not (across_start or _reaches_arc(pair, self.separation, solution.pressure_on_material))

            solution, _ = yield from refinement(self._solved, grid.accuracy, grid.tolerance, smooth, cells, expected)
        on_material = solution.pressure_on_material
        return LoadedContact(
            contact,
            self.separation,
            solution,
            at_relief_start=_crosses_relief_start(pair, contact, self.separation, on_material),
            at_arc=_reaches_arc(pair, self.separation, on_material),
            tolerance=self.tolerance,
            coupling_deflection=self.displaced,
            bending=self.bent,
            ends=self.ends,
            line_load_error=self._line_load_error(),
        )

    def _solved(self, cells: tuple[int, int], tolerance: float, start: Array | None = None) -> Steps[ContactSolution]:
        """Solve on a grid of the box."""
        separation = self.first
        if separation.gap.shape != cells:
            separation = yield Gap(self.contact, cells, box=self.first.box)
        if start is not None and not self.grid.lines_held:
            separation = separation.loaded_by(start, self.pair.module)
        self.separation = separation
        self.displaced = None if self.coupling is None else self.coupling(separation)
        self.bent = None if self.bending is None else self.bending.within(self.number, separation)
        self.ends = (yield Ends(separation)) if self.grid.free_edges else None
        problem = contact_problem(self.pair, separation, self.load, self.bent, self.ends, self.displaced)
        solution: ContactSolution = yield Task(problem, tolerance, start)
        if self.load > 0.0:
            self.line_loads.append(SliceLoads(self.pair.module, separation, solution.pressure))
        return solution

    def _line_load_error(self) -> float:
        """Change of the largest line load from the coarser grid, or what competing maxima leave of theirs.

        Pressures grow with the root of the line load: their error is half as large.
        """
        if len(self.line_loads) < 2:
            return math.nan
        coarse, fine = self.line_loads[-2:]
        change = abs(float(coarse.line_load.max() / fine.line_load.max()) - 1.0)
        return max(change, fine.error_of_largest(coarse))


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
    places = (contact.pinion_radius, contact.pinion_axial), (contact.wheel_radius, contact.wheel_axial)
    flanks = pair.pinion.flank, pair.wheel.flank
    if not any(flank.relief_starts(*map(np.array, place)) for flank, place in zip(flanks, places, strict=True)):
        return False  # neither flank has one
    x, y, z = np.moveaxis(separation.points, -1, 0)
    radius, _, axial = pair.to_wheel(separation.points)
    jets = (*pair.pinion.flank.relief_starts(np.hypot(x, y), z), *pair.wheel.flank.relief_starts(radius, axial))
    for jet in jets if pressure.any() else ():
        beyond = np.broadcast_to(jet.value, pressure.shape)
        values = np.concatenate([beyond[pressure > 0.0], values_at_ends(pressure, beyond, separation.cover)])
        if values.min() < 0.0 < values.max():
            return True
    return False


def _reaches_arc(pair: GearPair, separation: Separation, pressure: Array) -> bool:
    """Whether cells on the arc of a rounded edge are under pressure, or the contact goes on to where one begins."""
    if pair.sharp is pair:
        return False
    on_arc = np.asarray(arcs_at(pair, separation.points).any(axis=-1))
    return bool(pressure[on_arc].any()) or ends_at_material(np.where(on_arc, 0.0, pressure), on_arc)


def expected_pressure(separation: Separation) -> Array:
    """Pressure over the ellipse that the contact is expected to fill, (nx, ny), the highest one 1."""
    box = separation.box
    (across, along), (x, y) = (MARGIN_LEFT * np.array(box.half_lengths), box.middle)
    square = 1.0 - ((separation.x[:, None] - x) / across) ** 2 - ((separation.y - y) / along) ** 2
    return np.sqrt(np.maximum(square, 0.0)) * separation.cover
