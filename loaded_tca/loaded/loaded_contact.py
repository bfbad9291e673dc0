"""One tooth pair under a normal force: its pressure on its grid, and what is read off it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.compliance.model import BendingModel
from loaded_tca.contact import solve_problem
from loaded_tca.contact.levels import under_other_load
from loaded_tca.contact.patch import values_at_ends, widths
from loaded_tca.contact.solution import ContactSolution
from loaded_tca.loaded.line_load import SliceLoads
from loaded_tca.loaded.together import Bend, Steps, Task
from loaded_tca.reference.hertz import PointContact, point_contact
from loaded_tca.separation import Separation
from loaded_tca.separation.sample import force_line_under
from loaded_tca.unloaded import ContactPoint

EXACT = 1e-9
"""Tolerance of the solver where the approach is given: forces then balance a torque to that."""
EQUAL = 1e-3
"""Relative difference below which two cells have the same pressure, as the middle cells of an even grid do."""
LARGEST_MISFIT = 0.3
"""Of a gap from its paraboloid, where Hertz's pressure is still told: it differs by up to a tenth then; where a relief
begins in the ellipse the misfit is above 1."""
LINE_KEPT = 1e-4
"""Distance over the module by which forces of slices move, in the mean, before teeth bend at other places: a tenth of
``load_sharing.LINE_ERROR``, less than 0.1 nm of transmission error."""
BESIDE = 0.5 + 1e-6
"""Distance over a cell along both axes within which cells lie beside the contact point."""
LEAST_ERROR_OF_SLICES = 3.0
"""Error of the largest pressure of slices times the square of the cells across the contact, at the most where two grids
agree by chance (``validation/loaded/error_estimates.py``)."""


@dataclass(frozen=True, eq=False)
class LoadedContact:
    """Pressure of one tooth pair at one position.

    Attributes
    ----------
    contact : ContactPoint
        The unloaded contact it grows from: where pairs share the load, in the middle of the way of the gears under it.
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
    line_loads : tuple of callables
        Return the line loads on the two finest grids, which few contacts are asked for; fewer where there was one grid.
    judged : (float, float) or None [MPa], [N]
        Largest pressure and load of the solution that the errors were estimated of: lines of forces and other pairs may
        have moved the pressure since. None: it is that.
    ends_on_arc : bool
        Whether the first or the last slice that carries load reaches the arc of a rounded edge.
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
    line_loads: tuple[Callable[[], SliceLoads], ...] = ()
    judged: tuple[float, float] | None = None
    ends_on_arc: bool = False

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

        No less than :attr:`peak_change`. NaN where there was one grid alone, zero without load.
        """
        if self.solution.load == 0.0:
            return 0.0
        if not self.is_rough:
            return float(np.maximum(self.solution.error_estimate.peak_pressure, self.peak_change))
        least = LEAST_ERROR_OF_SLICES / min(self.solution.cells_across) ** 2
        return float(np.maximum(self.line_load_error, least))

    @property
    def approach_error(self) -> float:
        """Estimated error of its approach by the grid [mm], all of the change from the one before.

        NaN where there was one grid alone, zero without load.
        """
        if self.solution.load == 0.0:
            return 0.0
        coarser = self.solution.coarser
        return math.nan if coarser is None else coarser.approach_change * self.solution.approach_under_load

    @cached_property
    def line_load_error(self) -> float:
        """Estimated relative error of the pressure of slices by their line load; NaN where there was one grid."""
        if len(self.line_loads) < 2:
            return math.nan
        coarse, fine = (line_load() for line_load in self.line_loads)
        return fine.error_of_largest(coarse, ends_on_arc=self.ends_on_arc)

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
        across, along = (np.abs(x) <= BESIDE * step for x, step in zip((grid.x, grid.y), grid.spacing, strict=True))
        gap, pressure = (cells[across][:, along] for cells in (grid.cut_gap, self.solution.pressure_on_material))
        there = np.isfinite(gap)
        return float(pressure[there].mean()) if there.any() else 0.0

    @property
    def line_load(self) -> float:
        """Largest force per length along the contact [N/mm]: pressure summed up across."""
        return float(self.solution.pressure.sum(axis=0).max()) * self.separation.spacing[0]

    @property
    def peak_place(self) -> tuple[float, float]:
        """Radius and axial coordinate on the pinion of the largest pressure [mm]: middle of the cells that share it.

        Without load those of the contact point, where a vanishing load presses.
        """
        pressure = self.solution.pressure
        if not pressure.any():
            x, y, z = self.separation.origin
            return math.hypot(x, y), float(z)
        top = np.unravel_index(int(pressure.argmax()), pressure.shape)
        beside = tuple(slice(max(0, k - 1), k + 2) for k in top)
        equal = pressure[beside] >= (1.0 - EQUAL) * pressure.max()
        x, y, z = self.separation.points[beside][equal].mean(axis=0)
        return math.hypot(x, y), float(z)

    @property
    def hertz(self) -> PointContact | None:
        """Contact of these curvatures and this load after Hertz; None where Hertz does not hold.

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

    @cached_property
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

    @cached_property
    def contact_deformation(self) -> float:
        """Contact deformation [mm]: total deflection less bending, the mean over the force."""
        force, deflection = self.slice_force, self.solution.approach - self.own_tooth_deflection
        if self.coupling_deflection is None or not force.any():
            return deflection
        return float(deflection - self.coupling_deflection @ force / force.sum())

    def with_bending_lines(self, bending: BendingModel, number: int, module: float) -> Steps[LoadedContact]:
        """Return the contact as it is, to be solved next with teeth that bend at the centres of its pressure.

        Where they moved by less than ``LINE_KEPT``, it is returned as it is.
        """
        line = self._bending_line(module)
        if self.bending is not None and self._moved(line) <= LINE_KEPT * module:
            return self
        separation = replace(self.separation, force_line=line)
        return replace(self, separation=separation, bending=(yield Bend(bending, number, separation)))

    def line_error(self, module: float) -> float:
        """How far the forces that bend the teeth are from the centres of the pressure, the mean over the force [mm]."""
        return self._moved(self._bending_line(module))

    def _bending_line(self, module: float) -> Array:
        """Line (ny,) [mm] of the forces at the centres of the pressure; kept, as balance and solution ask for it."""
        if module not in self._lines_by_module:
            self._lines_by_module[module] = force_line_under(self.separation, self.solution.pressure, module)
        return self._lines_by_module[module]

    @cached_property
    def _lines_by_module(self) -> dict[float, Array]:
        return {}

    def _moved(self, line: Array) -> float:
        """Distance of another line of the forces (ny,) [mm], the mean over the force [mm]."""
        force, moved = self.slice_force, np.abs(line - self.separation.force_line)
        return float(force @ moved / force.sum()) if force.any() else 0.0

    def at_load(self, load: float, coupling: Array | None = None) -> Steps[LoadedContact]:
        """Return the contact under another load > 0 [N] near this one, on the same grid and as closely solved.

        ``coupling``: displacement of the slices under the load of other pairs, if anything bends, (ny,) [mm].

        The estimated error is that of the grid: its share of the peak and of the approach is kept.
        """
        gap, before = self.separation.cut_gap, self.solution
        bent, gap = self.bending, gap if coupling is None else gap + coupling
        slices = self.ends if bent is None else bent if self.ends is None else bent + self.ends
        problem = replace(before.problem, load=load, gap=gap, slice_compliance=slices)
        start = under_other_load(before.pressure, load / before.load)
        solution = replace((yield Task(problem, self.tolerance, start)), coarser=before.coarser)
        return replace(self, solution=solution, coupling_deflection=coupling)

    def at_approach(self, approach: float, coupling: Array | None = None) -> LoadedContact:
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
