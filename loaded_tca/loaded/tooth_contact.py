"""One tooth pair at one position under a normal force: its box, its grid, its pressure map."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.contact import ContactSolution, solve_contact, solve_to_accuracy
from loaded_tca.contact.adaptive import TOLERANCE_SHARE
from loaded_tca.contact.checks import memory_problem
from loaded_tca.contact.edges import FreeEdge
from loaded_tca.contact.levels import under_other_load
from loaded_tca.contact.solution import CoarserGrid
from loaded_tca.errors import InputError
from loaded_tca.loaded.free_edges import tooth_edges
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.reference.hertz import PointContact, point_contact
from loaded_tca.separation import Separation, sample_separation
from loaded_tca.unloaded import ContactPoint

FIRST_CELLS = (16, 16)
"""Grid from which an accuracy is approached, doubled as often as needed."""
CHORD = 0.8
"""Part of the load down to which the stiffness is taken."""
CHORD_TOLERANCE = 1e-5
"""Of the solution at that end: 1e-4 of the stiffness."""
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
GROWTH = 1.5
MOST_BOXES = 8


@dataclass(frozen=True)
class GridChoice:
    """How finely a contact is resolved: on ``cells`` as given, or on as many as ``accuracy`` needs.

    ``free_edges``: whether the tips and sides of the teeth yield more than a half-space.
    """

    cells: tuple[int, int] | None = None
    accuracy: float = 1e-3
    tolerance: float = 1e-6
    free_edges: bool = False


@dataclass(frozen=True)
class Beneath:
    """What yields beneath a contact: its tooth pair under its own load, and under that of other pairs.

    Attributes
    ----------
    own : callable
        ``own(separation, free_edges)``: displacement of every column of the grid per force on each, (ny, ny) [mm/N].
    lift : callable
        ``lift(separation)``: displacement of every column under the load of other pairs, (ny,) [mm].
    """

    own: Callable[[Separation, Sequence[FreeEdge]], Array]
    lift: Callable[[Separation], Array]


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
    tolerance : float
        To which the solver kept the contact conditions.
    lift : (ny,) array or None [mm]
        Displacement of the columns under the load of other tooth pairs; None if nothing bends.
    """

    contact: ContactPoint
    separation: Separation
    solution: ContactSolution
    at_relief_start: bool
    tolerance: float = 1e-6
    lift: Array | None = None

    @property
    def at_edge(self) -> bool:
        """Whether the contact reaches an edge of a flank."""
        return bool(self.contact.on_edge) or self.solution.reaches_material_edge

    @property
    def peak_pressure(self) -> float:
        """Peak pressure [MPa]; the largest cell where the contact reaches an edge or a relief start."""
        rough = self.at_edge or self.at_relief_start
        return float(self.solution.pressure.max()) if rough else self.solution.peak_pressure

    @property
    def central_pressure(self) -> float:
        """Pressure beside the contact point [MPa]: what is left of the peak where that sits at an edge."""
        middle = tuple(slice((n - 1) // 2, n // 2 + 1) for n in self.solution.pressure.shape)
        there = np.isfinite(self.separation.gap[middle])
        return float(self.solution.pressure[middle][there].mean()) if there.any() else 0.0

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
        smooth = along > 0.0 and not (self.at_edge or self.at_relief_start or self.contact.on_line)
        if not smooth or self.solution.load <= 0.0:
            return None
        ellipse = point_contact(self.solution.load, (across, along), self.solution.contact_modulus)
        if ellipse.semi_major >= self.separation.half_lengths[1] or self._misfit(ellipse) > LARGEST_MISFIT:
            return None
        return ellipse

    def _misfit(self, ellipse: PointContact) -> float:
        """How far the gap leaves the paraboloid of the contact point, weighted with Hertz's pressure, over its mean."""
        grid = self.separation
        x, y = grid.x[:, None], grid.y
        below = 1.0 - (x / ellipse.semi_minor) ** 2 - (y / ellipse.semi_major) ** 2
        weight = np.sqrt(np.maximum(below, 0.0))
        paraboloid = 0.5 * (grid.curvatures[0] * x**2 + grid.curvatures[1] * y**2)
        inside = weight > 0.0
        gap = np.abs(grid.gap - paraboloid)
        return float(weight[inside] @ gap[inside] / (weight[inside] @ paraboloid[inside]))

    @property
    def extent(self) -> tuple[float, float]:
        """Width across and length along [mm]: of the contact ellipse, at an edge of the cells under pressure."""
        if not self.at_edge:
            minor, major = self.solution.semi_axes
            return 2.0 * minor, 2.0 * major
        (nx, ny), (dx, dy) = self.solution.cells_across, self.separation.spacing
        return nx * dx, ny * dy

    @cached_property
    def column_force(self) -> Array:
        """Force on every column of the grid, (ny,) [N]."""
        return np.asarray(self.solution.pressure.sum(axis=0) * self.solution.cell_area)

    @cached_property
    def own_deflection(self) -> float:
        """What the tooth pair bends under its own load, the mean over the force [mm]."""
        compliance, force = self.solution.column_compliance, self.column_force
        if compliance is None or not force.any():
            return 0.0
        return float(force @ compliance @ force / force.sum())

    @property
    def approach(self) -> float:
        """Approach of the flanks [mm]: of the closing what is left beside the bending, the mean over the force."""
        force, closing = self.column_force, self.solution.approach
        if self.lift is None or not force.any():
            return closing
        return float(closing - self.own_deflection - self.lift @ force / force.sum())

    @cached_property
    def stiffness(self) -> float:
        """Stiffness dF/d closing [N/mm], of the power law through the load and 0.8 of it; zero without load.

        The closing is that of the flanks and of what bends beneath them, under other loads as they are. A contact
        grows by whole cells, so that the exact tangent of the discrete problem (``contact_stiffness``) scatters by a
        percent or two about that of the continuum; a chord scatters less, and the power makes up for its width.
        """
        solution = self.solution
        if solution.load <= 0.0:
            return 0.0
        less = self._solved(CHORD * solution.load, max(self.tolerance, CHORD_TOLERANCE), self.lift)
        closings = solution.approach - solution.first_touch, less.approach - solution.first_touch
        exponent = math.log(closings[1] / closings[0]) / math.log(CHORD)
        return solution.load / (exponent * closings[0])

    def under(self, load: float, lift: Array | None = None) -> LoadedContact:
        """Return the contact under another load > 0 [N] near this one, on the same grid and as closely solved.

        ``lift``: displacement of the columns under the load of other pairs, if anything bends, (ny,) [mm].

        The estimated error is that of the grid: its share of the peak and of the approach is kept.
        """
        solution, before = self._solved(load, self.tolerance, lift), self.solution
        coarser = before.coarser
        if coarser is not None:
            higher = float(solution.pressure.max()) / float(before.pressure.max())
            deeper = (solution.approach - solution.first_touch) / (before.approach - before.first_touch)
            approach = solution.first_touch + deeper * (coarser.approach - before.first_touch)
            solution = replace(solution, coarser=CoarserGrid(higher * coarser.largest, approach))
        return replace(self, solution=solution, lift=lift)

    def _solved(self, load: float, tolerance: float = 1e-6, lift: Array | None = None) -> ContactSolution:
        solution = self.solution
        return solve_contact(
            self.separation.gap if lift is None else self.separation.gap + lift,
            self.separation.spacing,
            solution.contact_modulus,
            load=load,
            max_pressure=solution.max_pressure,
            tolerance=tolerance,
            initial_pressure=under_other_load(solution.pressure, load / solution.load),
            free_edges=solution.free_edges,
            column_compliance=solution.column_compliance,
            warn=False,
        )


def press(
    pair: GearPair, contact: ContactPoint, load: float, grid: GridChoice, beneath: Beneath | None = None
) -> LoadedContact:
    """Press one tooth pair together at one position.

    The box is the estimated one, made larger as long as the contact reaches it.

    Parameters
    ----------
    pair : GearPair
    contact : ContactPoint
    load : float [N]
        Normal force, >= 0.
    grid : GridChoice
    beneath : Beneath, optional
        What yields beside the half-spaces; default: nothing.

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
    separation = _box_for_cap(pair, contact, load, sample_separation(pair, contact, cells=cells, load=load))
    for _ in range(MOST_BOXES):
        loaded = _press_in_box(pair, contact, load, grid, separation, beneath)
        grown = _grown_box(loaded.solution)
        if grown is None:
            break
        separation = sample_separation(pair, contact, cells=cells, box=grown)
    return loaded


def _box_for_cap(pair: GearPair, contact: ContactPoint, load: float, separation: Separation) -> Separation:
    """A box whose material carries the load at the cap on the pressure, if the flank has so much."""
    cap = math.inf if pair.max_pressure is None else pair.max_pressure
    while load > CAP_USE * separation.material_area * cap:
        across, along = separation.half_lengths
        box = (GROWTH * across, min(GROWTH * along, pair.face_width))
        wider = sample_separation(pair, contact, cells=separation.gap.shape, box=box)
        if wider.material_area <= separation.material_area:
            most = CAP_USE * separation.material_area * cap
            raise InputError(
                f"load: {load:.6g} N is more than the flank carries at max_pressure, {cap:g} MPa: about {most:.4g} N"
            )
        separation = wider
    return separation


def _press_in_box(
    pair: GearPair,
    contact: ContactPoint,
    load: float,
    grid: GridChoice,
    first: Separation,
    beneath: Beneath | None,
) -> LoadedContact:
    """Solve in the box of ``first``, on its grid if cells were given, else on finer and finer ones."""
    finest, modulus = [(first, _lift(first, beneath))], pair.contact_modulus
    edges = tooth_edges(pair, contact, first) if grid.free_edges else ()

    def sampler(cells: tuple[int, int]) -> tuple[Array, tuple[float, float]]:
        if cells != first.gap.shape:
            finer = sample_separation(pair, contact, cells=cells, box=first.half_lengths)
            finest[0] = finer, _lift(finer, beneath)
        separation, lift = finest[0]
        return separation.gap if lift is None else separation.gap + lift, separation.spacing

    def columns(_: tuple[int, int]) -> Array | None:
        return None if beneath is None else beneath.own(finest[0][0], edges)

    common: dict[str, Any] = {
        "load": load,
        "max_pressure": pair.max_pressure,
        "tolerance": grid.tolerance,
        "free_edges": edges,
        "warn": False,
    }
    if grid.cells is not None:
        tolerance = grid.tolerance
        gap, spacing = sampler(grid.cells)
        solution = solve_contact(gap, spacing, modulus, column_compliance=columns(grid.cells), **common)
    else:
        tolerance, expected = min(grid.tolerance, TOLERANCE_SHARE * grid.accuracy), _expected(first)
        solution = solve_to_accuracy(
            sampler,
            modulus,
            accuracy=grid.accuracy,
            smooth=not _crosses_relief_start(pair, contact, first, expected > 0.0),
            first_cells=FIRST_CELLS,
            initial_pressure=expected,
            column_compliance=columns,
            **common,
        )
    pressed = solution.pressure > 0.0
    separation, lift = finest[0]
    at_relief_start = _crosses_relief_start(pair, contact, separation, pressed)
    return LoadedContact(contact, separation, solution, at_relief_start, tolerance, lift)


def _lift(separation: Separation, beneath: Beneath | None) -> Array | None:
    """Displacement of the columns (ny,) [mm] under the load of other tooth pairs; None if nothing bends."""
    return None if beneath is None else beneath.lift(separation)


def _crosses_relief_start(pair: GearPair, contact: ContactPoint, separation: Separation, where: Array) -> bool:
    """Whether the start of a linear relief, of either flank, runs between the cells ``where``."""
    if contact.on_relief_start:
        return True
    points = separation.points[where]
    own = pair.pinion.flank.relief_starts(np.hypot(points[:, 0], points[:, 1]), points[:, 2])
    radius, _, axial = pair.to_wheel(points)
    values = [jet.value for jet in (*own, *pair.wheel.flank.relief_starts(radius, axial))]
    return any(value.size and value.min() < 0.0 < value.max() for value in values)


def _expected(separation: Separation) -> Array:
    """Pressure over the ellipse that the contact is expected to fill, (nx, ny), the highest one 1."""
    across, along = (MARGIN_LEFT * length for length in separation.half_lengths)
    square = 1.0 - (separation.x[:, None] / across) ** 2 - (separation.y / along) ** 2
    return np.where(np.isfinite(separation.gap), np.sqrt(np.maximum(square, 0.0)), 0.0)


def _grown_box(solution: ContactSolution) -> tuple[float, float] | None:
    """Half lengths of a larger box [mm], if the contact reaches the outermost cells."""
    touched = [bool((np.take(solution.pressure, [0, -1], axis=axis) > 0.0).any()) for axis in (0, 1)]
    if not any(touched):
        return None
    sizes = zip(solution.pressure.shape, solution.spacing, touched, strict=True)
    across, along = (0.5 * n * step * (GROWTH if grow else 1.0) for n, step, grow in sizes)
    return across, along
