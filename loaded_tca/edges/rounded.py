r"""Pressure at rounded edges of teeth: contacts that reach one, solved once more as finely as the rounding asks for.

The grid on which tooth pairs share the load resolves the contact, not the few micrometres of a rounding that are
pressed. So the gap of the rounded flanks is sampled anew on columns of graded width that follow the edge, and the same
force is spread over them, with teeth that bend, free edges and other tooth pairs as before. Where the contact crosses
free ends that lie along the edge, the images of the pressure in these ends are those of the cells, not of the slices:
beside an end a slice does not give way as a whole. Slices keep what images lack: that they fade out, and what is
taken off them in the middle of the tooth.

What a contact can come to is told beforehand, see :mod:`loaded_tca.edges.arcs`.

The same columns tell the load along contacts that end on a rounding: beside its beginning the line load doubles within
a tenth of a millimetre, of which even grids of usual cells see nothing. There free edges are laws of slices, as on the
grid: the load is that of the grid, resolved.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations
from typing import NamedTuple

import numpy as np
import scipy

from loaded_tca.arrays import Array, Mask
from loaded_tca.compliance.model import BendingModel
from loaded_tca.contact.columns import FineZone, column_borders, whole_cells
from loaded_tca.contact.edges import FreeEdge, RoundedEdge, extra_displacement, factors_across
from loaded_tca.contact.graded import solve_graded
from loaded_tca.contact.problem import GradedProblem
from loaded_tca.contact.rounded_edge import (
    SURELY_LESS,
    EdgePressure,
    edge_pressures,
    interpolated_pressure,
    of_material,
)
from loaded_tca.contact.solution import GradedSolution
from loaded_tca.edges.arcs import PARALLEL, ArcsInCycle, ReachedArc
from loaded_tca.edges.free import FreeEnd, edge_compliances, free_ends
from loaded_tca.edges.places import dilated
from loaded_tca.errors import ConvergenceError, InputError
from loaded_tca.loaded.cycle import CycleSolution, told_where
from loaded_tca.loaded.loaded_contact import LoadedContact
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.separation.normal_gap import NormalGap

CELLS_ACROSS, CELLS_ALONG = 8, 12
"""Of the columns, on the width and the length of the contact: the rest of it, away from the edge."""
MARGIN = 2.5
"""Cells of the contact's grid between its pressure and the borders of the columns."""
MOST_BOXES = 4
LEFT_BY_CELLS = 0.07
"""Relative error of a peak times the cells on the pressed part of its rounding, at the most: what all cells of the
columns leave together, those away from the edge, on which teeth bend, too. Of 55 random contacts none has more than its
estimate with this; with 0.05, which was enough for 38 of mesh cycles, three have, 1.13 times at the most
(``validation/loaded/error_estimates.py``)."""
LEFT_BESIDE_CROSSING = 0.12
"""The same where two edges cross: one of them lies across the columns of the other."""
LEAST_RADIUS = 0.4
"""Radius of flush ends over the half width of a contact, below which the law of free edges for slices does not resolve
what a rounding changes: it is smooth over a length across the contact, 0.4 of the half width that it stands for."""

FINEST, ROWS, COLUMNS = 0.05, 15, 48
"""For the load along a contact: columns at the beginning of an arc over its radius, cells across the box, and columns
over the length of the box away from the arcs. With 12 cells across a wider box K_Hbeta of one pair was 2.9 % off,
with these 1.1 % (seed 388 of ``validation/loaded/rounded_ends.py``)."""
COARSER = 1.5
"""Widths of the cells that the load along a contact is compared with, over those cells."""
COLUMN_GROWTH = 1.4
"""Width of a column over that of its neighbour nearer to the arc: with 1.1 K_Hbeta was the same to 0.1 %."""
SPREAD = 0.3
"""Width of the contact beyond its grid's pressure, on either side, over the width of that pressure: beside an arc the
contact is up to 1.4 times as wide. A contact that reaches the last row is solved once more in a larger box."""
LOADS_TOLERANCE = 1e-4
"""Of the contact conditions where the load along a contact is asked for."""


Box = tuple[tuple[float, float], tuple[float, float]]
"""Low and high end of a rectangle on the first and on the second axis [mm]."""


@dataclass(frozen=True)
class PeakAtEdge:
    """Peak pressure of a contact at a rounded edge.

    Attributes
    ----------
    pressure : float [MPa]
        NaN where the contact ends before every rounding, where only the bound is known, and where the solver did not
        reach its tolerance.
    place : (float, float) [mm]
        Across and along the contact, from the contact point.
    error : float
        Estimated relative error of the discretisation; infinite where any rounded edge of the contact ends at a sharp
        one that is pressed, too, and where a relief start crosses the place.
    bound : float [MPa]
        What no rounded edge of the contact exceeds: the pressure, where that is known, zero where none is reached.
    ends_sharp : bool
        Whether the place is a corner with a sharp edge, where the pressure has no limit.
    unsolved : float
        Residual of the contact conditions where the solver did not reach its tolerance, else zero.
    narrow : bool
        Whether free ends of both gears lie there, of a radius below ``LEAST_RADIUS`` of the contact's half width.
    """

    pressure: float
    place: tuple[float, float]
    error: float
    bound: float
    ends_sharp: bool = False
    unsolved: float = 0.0
    narrow: bool = False


NOT_REACHED = PeakAtEdge(math.nan, (math.nan, math.nan), math.nan, 0.0)


@dataclass(frozen=True, eq=False)
class Columns:
    """Columns of graded width, or rows across them, as slices of a contact.

    Attributes
    ----------
    y, widths : (ny,) array [mm]
        Where they cross the line along the contact, and how wide they are there.
    origin : (3,) array [mm]
        The contact point in the fixed frame.
    axes : (3, 3) array
        Rows: across, along and normal to the contact.
    force_line : (ny,) array [mm]
        Where across the contact the forces act, from the contact point.
    """

    y: Array
    widths: Array
    origin: Array
    axes: Array
    force_line: Array

    @property
    def with_material(self) -> Mask:
        """All of them: of those beyond the end of a flank :func:`edge_pressures` takes nothing."""
        return np.ones(self.y.size, dtype=bool)


def pressures_at_rounded_edges(
    pair: GearPair,
    carried: CycleSolution,
    bending: BendingModel | None,
    *,
    arcs: ArcsInCycle,
    free_edges: bool,
    every: bool,
) -> dict[tuple[int, int, int], PeakAtEdge]:
    """Peak pressures at rounded edges of the contacts of a mesh cycle.

    Parameters
    ----------
    pair : GearPair
    carried : CycleSolution
    bending : BendingModel or None
        Of the teeth, as they carried.
    arcs : dict
        Of :func:`loaded_tca.edges.arcs.arcs_in_cycle`.
    free_edges : bool
        Whether the ends of the teeth are softer than a half-space.
    every : bool
        Whether all contacts that reach a rounding are solved once more; else those alone that can hold the largest
        pressure at a rounding under their torque, or one without a limit.

    Returns
    -------
    dict
        By the indices of torque, position and tooth pair: of all that reach a rounding. Of those that were not solved
        once more, and those whose pressure is below ``SURELY_LESS`` of the largest one, a bound. Where the solver does
        not reach its tolerance the pressure is NaN: the loads of the mesh cycle stand without it.
    """
    peaks_at: dict[tuple[int, int, int], PeakAtEdge] = {}
    for t, positions in enumerate(carried.contacts):
        reached = {place: edges for place, edges in arcs.items() if place[0] == t}
        limits = {place: max(edge.limit for edge in edges) for place, edges in reached.items()}
        peaks, largest = dict[tuple[int, int, int], PeakAtEdge](), 0.0
        for place in sorted(reached, key=lambda at: -limits[at]):
            if not every and limits[place] < largest:
                break
            loaded, number = positions[place[1]][place[2]], int(carried.pairs[place[2]])
            assert loaded is not None
            with told_where(float(carried.torque[t]), float(carried.path.pinion_angle[place[1]])):
                peaks[place] = pressure_at_rounded_edge(
                    pair,
                    loaded,
                    reached[place],
                    bending,
                    number,
                    free_edges=free_edges,
                    at_least=0.0 if every else largest,
                )
            largest = max(largest, _by_pressure(peaks[place]))
        for place, edges in reached.items():
            peak = peaks.get(place, NOT_REACHED)
            no_limit = peak.error == math.inf or peak.unsolved > 0.0
            can_be_largest = no_limit or _by_pressure(peak) >= SURELY_LESS * largest
            below = replace(NOT_REACHED, bound=min(edges[0].bound, largest))
            peaks_at[place] = peak if every or can_be_largest else below
    return peaks_at


def pressure_at_rounded_edge(
    pair: GearPair,
    loaded: LoadedContact,
    edges: list[ReachedArc],
    bending: BendingModel | None,
    number: int,
    *,
    free_edges: bool,
    at_least: float = 0.0,
) -> PeakAtEdge:
    """Peak pressure of a contact at its rounded edges.

    Columns are made for one edge after the other, and for those together that cross each other in the contact. Which
    ones cross does not depend on what the others can come to: beside a crossing both edges make the pressure.

    Parameters
    ----------
    pair : GearPair
    loaded : LoadedContact
    edges : list of ReachedArc
        The one with the highest bound first.
    bending : BendingModel or None
    number : int
        Of the tooth pair, as the bending model counts.
    free_edges : bool
    at_least : float [MPa]
        Pressures that are surely less need not be found closely, but for those without a limit.

    Returns
    -------
    PeakAtEdge
        Unsolved where the columns of one edge are: what another edge has may be less.
    """
    crossing = _crossing_within(loaded, [line for edge in edges for line in edge.lines])
    together = [(edge.limit, [*edge.lines]) for edge in edges if not crossing.issuperset(edge.lines)]
    if crossing:  # the first one is crossed by the fewest rows
        limit = max(edge.limit for edge in edges if not crossing.isdisjoint(edge.lines))
        together.append((limit, sorted(crossing, key=lambda line: -abs(line.normal[1]))))
    best, error = NOT_REACHED, 0.0
    for limit, lines in sorted(together, key=lambda each: -each[0]):
        if limit < max(SURELY_LESS * at_least, _by_pressure(best)):
            break
        contact = _ContactAlongEdge(pair, loaded, lines[0], bending, number, free_edges)
        left = LEFT_BESIDE_CROSSING if crossing.issuperset(lines) else LEFT_BY_CELLS
        enough = 0.0 if limit == math.inf else max(at_least, _by_pressure(best))
        try:
            solved = contact.solved(lines, enough)
        except ConvergenceError as failed:
            return replace(NOT_REACHED, bound=max(edge.limit for edge in edges), unsolved=failed.last.residual)
        peak = replace(
            _largest([contact.turned_back(one, left) for one in solved]), narrow=contact.has_narrow_ends(edges, lines)
        )
        best, error = max(best, peak, key=_by_pressure), math.inf if peak.ends_sharp else error
    return replace(best, error=max(best.error, error))


class CellForces(NamedTuple):
    """Forces of cells, and where they end along the contact.

    Attributes
    ----------
    forces : (n,) array [N]
    ends : (2, n, 3) array [mm]
        Middles of the two ends of every cell, in the fixed frame.
    """

    forces: Array
    ends: Array


def loads_along_contacts(
    pair: GearPair, carried: CycleSolution, bending: BendingModel | None, *, arcs: ArcsInCycle, free_edges: bool
) -> dict[tuple[int, int, int], tuple[CellForces, CellForces]]:
    """Loads along the contacts of a mesh cycle that end on the arc of an edge across them.

    Parameters
    ----------
    pair, carried, bending, arcs, free_edges
        As of :func:`pressures_at_rounded_edges`.

    Returns
    -------
    dict
        By the indices of torque, position and tooth pair: on columns graded towards the arcs, and on coarser ones. The
        last position, a pitch after the first one, has none, nor has a contact whose columns are not solved to their
        tolerance.
    """
    loads: dict[tuple[int, int, int], tuple[CellForces, CellForces]] = {}
    for (t, n, k), edges in arcs.items():
        loaded, across = carried.contacts[t][n][k], [edge for edge in edges if edge.crosses_contact]
        is_last = n == len(carried.contacts[t]) - 1
        if is_last or loaded is None or not loaded.ends_on_arc or loaded.solution.load == 0.0 or not across:
            continue
        number = int(carried.pairs[k])
        contact = _ContactAlongEdge(pair, loaded, across[0].lines[0], bending, number, free_edges)
        try:
            loads[t, n, k] = contact.cell_forces(across)
        except ConvergenceError:
            continue
    return loads


def _largest(peaks: list[PeakAtEdge]) -> PeakAtEdge:
    """The largest of some peaks; beside a crossing the columns of both edges have it, the larger error counts."""
    top = max(peaks, key=_by_pressure)
    same = [peak for peak in peaks if peak.place == top.place] or [top]
    return replace(top, error=max(peak.error for peak in same), ends_sharp=any(peak.ends_sharp for peak in same))


def _by_pressure(one: PeakAtEdge | EdgePressure) -> float:
    """Pressure, zero where no edge is reached."""
    return 0.0 if math.isnan(one.pressure) else one.pressure


def _crossing_within(loaded: LoadedContact, lines: list[RoundedEdge]) -> set[RoundedEdge]:
    """Those of some edges that cross another one within two cells of the pressure of a contact."""
    grid, crossing = loaded.separation, set[RoundedEdge]()
    pressed = dilated(loaded.solution.pressure > 0.0, 2)
    for pair in combinations(lines, 2):
        normals = np.array([line.direction for line in pair])
        if abs(np.linalg.det(normals)) < PARALLEL:
            continue
        place = np.linalg.solve(normals, [normal @ line.place for normal, line in zip(normals, pair, strict=True)])
        row, column = np.rint((place - (grid.x[0], grid.y[0])) / grid.spacing).astype(int)
        if 0 <= row < grid.x.size and 0 <= column < grid.y.size and pressed[row, column]:
            crossing.update(pair)
    return crossing


def _reaches_border(solution: GradedSolution) -> bool:
    """Whether a contact reaches the borders of its columns."""
    pressed = solution.pressure > 0.0
    return bool(pressed[[0, -1]].any() or pressed[:, [0, -1]].any())


def _rows(box: Box, count: int) -> Array:
    """Middles (count,) [mm] of rows of cells in a box."""
    (low, high), _ = box
    return low + (high - low) / count * (np.arange(count, dtype=float) + 0.5)


class _ContactAlongEdge:
    """A loaded contact in axes turned about its normal, so that columns along the first of them follow an edge."""

    def __init__(
        self,
        pair: GearPair,
        loaded: LoadedContact,
        edge: RoundedEdge,
        bending: BendingModel | None,
        number: int,
        free_edges: bool,
    ) -> None:
        self.pair, self.loaded, self.bending, self.number, self.free_edges = pair, loaded, bending, number, free_edges
        across, along = edge.direction
        self.turn = np.array([[along, -across], [across, along]])
        grid = loaded.separation
        self.normal_gap = NormalGap(pair, loaded.contact, np.concatenate([self.turn @ grid.axes[:2], grid.axes[2:]]))
        self.slice_axis = int(abs(along) > abs(across))
        self.along = float(self.turn[self.slice_axis, 1])
        """Way along the slices' axis per way along the contact."""
        coupling = loaded.coupling_deflection
        self.coupling = (
            None
            if coupling is None
            else scipy.interpolate.make_interp_spline(grid.y, coupling, k=min(3, grid.y.size - 1))
        )

    @property
    def _lies_along(self) -> bool:
        """Whether the contact lies along the edge: over its length it leaves that by less than its width.

        One that crosses the edge has its load's centre far from it: what a tip gives way there, free edges tell.
        """
        pressed, (dx, dy) = self.loaded.solution.pressure > 0.0, self.loaded.separation.spacing
        width, length = dx * np.count_nonzero(pressed.any(axis=1)), dy * np.count_nonzero(pressed.any(axis=0))
        return bool(abs(self.turn[1, 1]) * length < width)

    def has_narrow_ends(self, edges: list[ReachedArc], lines: list[RoundedEdge]) -> bool:
        """Whether free ends of both gears are among some lines, rounded less than the law of slices resolves.

        Where slices lie along the ends the cells have the images, which resolve any radius.
        """
        pressed, dx = self.loaded.solution.pressure > 0.0, self.loaded.separation.spacing[0]
        width = 0.5 * dx * int(pressed.sum(axis=0).max())
        flush = [line for edge in edges if len(edge.lines) > 1 for line in edge.lines if line in lines]
        by_slices = self.free_edges and self.slice_axis == 0 and not self._lies_along
        return by_slices and any(line.radius < LEAST_RADIUS * width for line in flush)

    def _turned(self, place: tuple[float, float]) -> tuple[float, float]:
        """A place or a direction, of the contact's axes, in those along the edge."""
        along, across = (self.turn @ place).tolist()
        return along, across

    def turned_back(self, peak: EdgePressure, left: float) -> PeakAtEdge:
        """A peak, its place across and along the contact, and its error: at least ``left`` over its cells."""
        if math.isnan(peak.pressure):
            return NOT_REACHED
        across, along = (np.array(peak.place) @ self.turn).tolist()
        error = max(peak.error, left / peak.cells_on_arc)
        return PeakAtEdge(peak.pressure, (across, along), error, peak.pressure, peak.ends_sharp)

    def solved(self, edges: list[RoundedEdge], at_least: float) -> list[EdgePressure]:
        """Pressures at edges, in a box that holds the contact."""
        turned = [replace(edge, place=self._turned(edge.place), normal=self._turned(edge.normal)) for edge in edges]
        ends: list[FreeEnd] = []
        if not self._lies_along:
            turned, ends = [replace(edge, angle=None) for edge in turned], self._ends_beside(edges[0])
        of_edges = partial(self.slice_compliance, on_cells=[end.number for end in ends])
        for margin in MARGIN * 2.0 ** np.arange(MOST_BOXES):
            box, cells = self._box(margin)
            peaks = edge_pressures(
                self.gap,
                box,
                turned,
                self.loaded.solution.load,
                self.pair.contact_modulus,
                cells=cells,
                max_pressure=self.pair.max_pressure,
                slice_compliance=of_edges,
                slice_axis=self.slice_axis,
                free_edges=[self._image(end, turned[0], box[1][0]) for end in ends],
                at_least=at_least,
            )
            is_less = all(_by_pressure(one) < SURELY_LESS * at_least for one in peaks)
            if is_less or not _reaches_border(peaks[0].solution):
                return peaks  # in a box that cuts the contact the pressure is too high
        return [replace(one, error=math.inf) for one in peaks]

    def cell_forces(self, arcs: Sequence[ReachedArc]) -> tuple[CellForces, CellForces]:
        """Forces of cells on columns graded towards arcs, and on cells ``COARSER`` times as long and as wide.

        In a box that holds the contact on both: ConvergenceError where none does.
        """
        across = int(np.count_nonzero((self.loaded.solution.pressure > 0.0).any(axis=1)))
        least = np.array([max(MARGIN, SPREAD * across), MARGIN])
        for margin in least * 2.0 ** np.arange(MOST_BOXES)[:, None]:
            box, _ = self._box(margin)
            coarser = fine = self._on_columns(arcs, COARSER, box)
            if not _reaches_border(coarser):
                fine = self._on_columns(arcs, 1.0, box, coarser)
            if not _reaches_border(fine):
                return self._forces_of(fine, box), self._forces_of(coarser, box)
        raise ConvergenceError("the contact reaches the ends of its columns", fine)

    def _forces_of(self, solution: GradedSolution, box: Box) -> CellForces:
        """Forces of the cells under pressure of a solution in a box."""
        across, along = np.nonzero(solution.pressure)
        problem, grid = solution.problem, self.loaded.separation
        ways, x = self.turn @ grid.axes[:2], _rows(box, problem.cells[0])
        ends = [
            grid.origin + x[across, None] * ways[0] + places[along, None] * ways[1]
            for places in (problem.borders[:-1], problem.borders[1:])
        ]
        forces = solution.pressure[across, along] * problem.cell_areas[along]
        return CellForces(forces, np.stack(ends))

    def _on_columns(
        self, arcs: Sequence[ReachedArc], wider: float, box: Box, before: GradedSolution | None = None
    ) -> GradedSolution:
        """The contact solved in a box on columns so many times as wide as the finest ones, from a coarser solution."""
        (low, high), (first, last) = box
        zones = [
            FineZone(self._turned(line.place)[1], wider * FINEST * arc.radius, 2.0 * FINEST * arc.radius)
            for arc in arcs
            for line in arc.lines
        ]
        borders = column_borders(first, last, zones, wider * (last - first) / COLUMNS, COLUMN_GROWTH)
        x, y = _rows(box, int(whole_cells(ROWS / wider))), 0.5 * (borders[1:] + borders[:-1])
        heights, slices = self.gap(x, y), self.slice_compliance(y, np.diff(borders))
        slices = of_material(slices, np.asarray(np.isfinite(heights).any(axis=0)))
        load, modulus = self.loaded.solution.load, self.pair.contact_modulus
        spacing = (high - low) / x.size
        problem = GradedProblem(heights, spacing, borders, modulus, load, self.pair.max_pressure, slices)
        start = None if before is None else interpolated_pressure(before, low, x, y)
        return solve_graded(problem, tolerance=LOADS_TOLERANCE, initial_pressure=start)

    def _box(self, margin: float | Array) -> tuple[Box, tuple[int, int]]:
        """A box about the pressure of the grid, so many of its cells larger, and the cells on both its axes.

        ``margin`` is one number, or one across and one along the contact.
        """
        grid, pressed = self.loaded.separation, self.loaded.solution.pressure > 0.0
        rows, columns = np.nonzero(pressed)
        places = np.stack([grid.x[rows], grid.y[columns]], axis=-1) @ self.turn.T
        room = np.abs(self.turn) @ (margin * np.array(grid.spacing))
        low, high = places.min(axis=0) - room, places.max(axis=0) + room
        width, length = np.ptp(rows) * grid.spacing[0], np.ptp(columns) * grid.spacing[1]
        ways = np.abs(self.turn) / ((width + grid.spacing[0]) / CELLS_ACROSS, (length + grid.spacing[1]) / CELLS_ALONG)
        x, y = zip(low.tolist(), high.tolist(), strict=True)
        cells = np.maximum(whole_cells((high - low) * ways.max(axis=1)), 4).tolist()
        return (x, y), (cells[0], cells[1])

    def gap(self, x: Array, y: Array) -> Array:
        """Gap [mm] at all pairs of places, with what other tooth pairs displace; +inf beyond the flanks."""
        heights, room = (part[0] for part in self.normal_gap.at(x[None, :, None], y[None, None, :]))
        heights = np.where(room >= 0.0, heights, math.inf)
        if self.coupling is None:
            return heights
        displaced = self.coupling((y if self.slice_axis else x) / self.along)
        return np.asarray(heights + (displaced if self.slice_axis else displaced[:, None]))

    def _ends_beside(self, edge: RoundedEdge) -> list[FreeEnd]:
        """Free ends of both gears that lie along an edge, nearly, where the slices of the contact do, too."""
        if not self.free_edges or self.slice_axis == 0:
            return []
        grid = self.loaded.separation
        ends = free_ends(self.pair, grid.origin + np.array(edge.place) @ grid.axes[:2], grid.axes[:2])
        return [end for end in ends if end.direction @ edge.direction > math.sqrt(1.0 - PARALLEL**2)]

    def _image(self, end: FreeEnd, edge: RoundedEdge, low: float) -> FreeEdge:
        """Image in a free end that lies along an edge, in turned axes, on columns from the low end of a box on."""
        side, share = math.copysign(1.0, edge.normal[1]), self.pair.contact_modulus / end.material.plane_strain_modulus
        return FreeEdge(
            1,
            edge.place[1] + side * end.distance - low,
            "below" if side > 0.0 else "above",
            share * extra_displacement(end.angle),
            factors_across(end.angle, end.material.poisson_ratio, share),
        )

    def slice_compliance(self, middles: Array, widths: Array, on_cells: Collection[int] = ()) -> Array:
        """Deflection of slices under a unit force on each [mm/N], teeth and free edges together.

        Of edges whose images the cells have, only what images lack.
        """
        grid = self.loaded.separation
        along = middles / self.along
        forces = np.interp(along, grid.y, grid.force_line)
        slices = Columns(along, widths / abs(self.along), grid.origin, grid.axes, forces)
        compliance = np.zeros((middles.size, middles.size))
        if self.bending is not None:
            compliance += self.bending.within(self.number, slices)
        ends = edge_compliances(self.pair, [slices], on_cells)[0] if self.free_edges else None
        if isinstance(ends, InputError):
            raise ends
        return compliance if ends is None else compliance + ends
