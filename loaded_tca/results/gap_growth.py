r"""Growth of the gaps of loaded contacts with keys of the scene, on grids that follow them.

Sensitivities rest on the growth dh of all that the forces f as they are leave open between the flanks: of the gaps
themselves, of (dK) f where the edges of flanks move in the grids, and of the bending of the teeth and of their free
edges where the wheel moves below the lines of the forces.

Growth of the largest slice pressures with keys of the scene, by the relative curvature at their places.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from loaded_tca.contact.cuts import crowding_growth
from loaded_tca.edges.free import edge_deflection_growth
from loaded_tca.edges.places import dilated
from loaded_tca.pairs.gear_pair import MovedSlices, cylindrical_basis
from loaded_tca.results.pressure_map import PressureMap
from loaded_tca.results.slice_pressure import JUMP
from loaded_tca.separation import Separation
from loaded_tca.separation.gap_change import OF_GRIDS, MovedContacts, contact_changes
from loaded_tca.separation.normal_gap import NormalGap
from loaded_tca.separation.pair_change import PairChange

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from loaded_tca.arrays import Array, Indices, Mask
    from loaded_tca.compliance.model import BendingPart
    from loaded_tca.loaded.loaded_grid import LoadedGrid
    from loaded_tca.loaded.sensitivity import Tangents
    from loaded_tca.pairs.gear_pair import GearPair
    from loaded_tca.results.numbers import CycleNumbers
    from loaded_tca.results.slice_pressure import SlicePeak

Grid = TypeVar("Grid", Separation, PressureMap)


@dataclass(frozen=True, eq=False)
class GapGrowth:
    """Growth of what the loaded states of a result balance.

    Attributes
    ----------
    gaps : (keys, n) array [mm per unit]
        At the active cells, with what the forces as they are displace more.
    lever_torques : (keys, grids) array [N mm per unit]
        Growth of the torque of each pair by that of its lever.
    motions : (keys, grids, 6) array
        Of the grids, as of :class:`loaded_tca.separation.gap_change.MovedContacts`.
    turns : (keys, grids) array [rad per unit]
        Of the wheel back into contact, against the normal force of each pair.
    tilts : (keys, grids, 2) array [rad per unit]
        Of the normals at the contact points along x and y of the grids, also where these stay.
    shifts : (keys, grids, 2) array [mm per unit]
        Of the contact points along x and y of the grids.
    kinks : GapGrowth or None
        Growth by growing values of the keys less that by falling ones, where edges of both gears end a contact at one
        place, or the wheel moves otherwise to either side. None where no key has any.
    """

    gaps: Array
    lever_torques: Array
    motions: Array
    turns: Array
    tilts: Array
    shifts: Array
    kinks: GapGrowth | None = None

    def of_grids(self, grids: Sequence[int]) -> GapGrowth:
        """The same of some of the grids, without gaps."""
        some = list(grids)
        none = np.zeros((len(self.turns), 0))
        return self._with(lambda values: none if values is self.gaps else values[:, some])

    def _with(self, changed: Callable[[Array], Array]) -> GapGrowth:
        """Arrays that are changed, without kinks."""
        values: dict[str, Any] = {name: changed(getattr(self, name)) for name in ARRAYS}
        return GapGrowth(**values)

    @property
    def no_kinks(self) -> GapGrowth:
        """Zeros like these."""
        return self._with(np.zeros_like)

    def _plus(self, parts: Array, others: GapGrowth) -> GapGrowth:
        """The same with parts (keys, m) of m others, without kinks."""
        values: dict[str, Any] = {
            name: getattr(self, name) + np.tensordot(parts, getattr(others, name), 1) for name in ARRAYS
        }
        return GapGrowth(**values)

    def with_parts(self, parts: Array, others: GapGrowth) -> GapGrowth:
        """The same with parts (keys, m) of m others, of the same grids, added."""
        kinks = self.kinks
        if others.kinks is not None:  # by a part below zero the other falls as the key grows
            kinks = (kinks or self.no_kinks)._plus(np.abs(parts), others.kinks)
        return replace(self._plus(parts, others), kinks=kinks)

    def at_keys(self, at: Sequence[int], count: int) -> GapGrowth:
        """The same as rows ``at`` of so many keys, of which the others change nothing."""

        def spread(values: Array) -> Array:
            rows = np.zeros((count, *values.shape[1:]))
            rows[list(at)] = values
            return rows

        return replace(self._with(spread), kinks=None if self.kinks is None else self.kinks._with(spread))

    def with_sides_joined(self, kinked: Sequence[int], count: int) -> GapGrowth:
        """The same of ``count`` keys, some of which have kinks.

        Rows of this growth are the keys without kinks, then those with kinks by growing values, and by falling ones.
        The derivative of a figure is the mean of both, and on the sides it is more or less than that by half the kink.
        """
        half, others = len(kinked), [key for key in range(count) if key not in kinked]

        def joined(values: Array) -> Array:
            rows, sides = np.empty((count, *values.shape[1:])), values[len(others) :]
            rows[others], rows[list(kinked)] = values[: len(others)], 0.5 * (sides[:half] + sides[half:])
            return rows

        apart = self._with(lambda values: values[len(others) :][:half] - values[len(others) :][half:])
        return replace(self._with(joined), kinks=apart.at_keys(kinked, count))


ARRAYS = tuple(one.name for one in fields(GapGrowth) if one.name != "kinks")


def gap_growth(
    result: CycleNumbers,
    tangents: Tangents,
    bending: BendingPart | None,
    places: tuple[Array, ...],
    changes: Sequence[PairChange],
) -> GapGrowth:
    """Growth with each change.

    Parameters
    ----------
    result : MeshCycle
    tangents : Tangents
        Of all states.
    bending : BendingPart or None
    places : three (grids,) arrays
        Torque, position and pair of each grid.
    changes : sequence of PairChange
    """
    if not changes:
        none = np.zeros((0, tangents.state.size))
        motions, tilts = (np.zeros((*none.shape, count)) for count in (OF_GRIDS, 2))
        return GapGrowth(np.zeros((0, tangents.grid.size)), none, motions, none, tilts, tilts)
    pair = result.gear_pair
    if not (kinked := _keys_with_kinks(pair, tangents.grids, changes)):
        return _growth(result, tangents, bending, places, changes)
    others = [change for key, change in enumerate(changes) if key not in kinked]
    growing, falling = zip(*(changes[key].to_sides_of(pair) for key in kinked), strict=True)
    growth = _growth(result, tangents, bending, places, [*others, *growing, *falling])
    return growth.with_sides_joined(kinked, len(changes))


def _keys_with_kinks(pair: GearPair, grids: Sequence[LoadedGrid], changes: Sequence[PairChange]) -> list[int]:
    """Keys by which edges of both gears at one place part, or the wheel moves otherwise to either side."""
    if not (moving := [key for key, change in enumerate(changes) if not change.of_modifications]):
        return []
    cells = [grid.pressed & dilated(grid.separation.cover < 1.0) for grid in grids]
    contacts, separations = [grid.contact for grid in grids], [grid.separation for grid in grids]
    held = contact_changes(pair, contacts, separations, cells, [changes[key] for key in moving])
    parts = zip(moving, held.border.has_kinks.tolist(), strict=True)
    return [key for key, at_one_place in parts if at_one_place or changes[key].has_kink_at(pair)]


def _growth(
    result: CycleNumbers,
    tangents: Tangents,
    bending: BendingPart | None,
    places: tuple[Array, ...],
    changes: Sequence[PairChange],
) -> GapGrowth:
    """Growth with each change, without kinks."""
    pair, grids, (_, positions, pairs) = result.gear_pair, tangents.grids, places
    separations, count = [grid.separation for grid in grids], len(changes)
    # contacts are traced at the middles of their ways, from where the pinion goes on
    first_angles = result.pinion_angle[positions] - result.pair[pairs] * pair.pitch
    ways = first_angles - [grid.contact.pinion_angle for grid in grids]
    followed = [*changes, _along_paths(pair)] if (np.abs(ways) > NO_WAY).any() else changes
    held = contact_changes(
        pair, [grid.contact for grid in grids], separations, [grid.pressed for grid in grids], followed
    )
    pressures = np.concatenate([grid.pressure[grid.pressed] for grid in grids])
    growth, points = held.followed(pressures, separations), held.at_points
    # the gears of a pair are turned back into contact first, then closed under load
    touching = np.array([grid.contact.transmission_error for grid in grids])
    turned = pair.driving * (touching - result.transmission_error[places[:2]])
    levers = np.array([(grid.contact.pinion_lever, grid.contact.wheel_lever) for grid in grids]).T
    rates = (points.levers[0] - levers[0] / levers[1] * points.levers[1]) / levers[1]
    turns = points.turns - pair.driving * ways * rates
    lever_torques = result.normal_force[places] * points.levers[0]
    turns[count:] = lever_torques[count:] = 0.0  # along its path a contact keeps what it has of the first one
    by_ways = ways * rates - 0.5 * pair.driving * (_first_rotations(tangents, turns * levers[1], lever_torques) - turns)
    along = np.where(np.abs(ways) > NO_WAY, by_ways * levers[1] / levers[0], 0.0)[:count]
    active = np.concatenate([grid.active[grid.pressed] for grid in grids])
    gaps = growth.gaps[:, active]
    for row, closed in zip(gaps, turns * levers[1] - turned * points.levers[1], strict=True):
        row += closed[tangents.grid]
    lever_torques += _add_displaced(result, tangents, bending, followed, growth, points.shifts, gaps)
    for path, torque in zip(gaps[count:], lever_torques[count:], strict=True):
        gaps[:count] += along[:, tangents.grid] * path
        lever_torques[:count] += along * torque
    motions, turned_back, tilts, shifts = (
        values[:count] for values in (growth.motions, points.turns, points.tilts, points.shifts)
    )
    return GapGrowth(gaps[:count], lever_torques[:count], motions, turned_back, tilts, shifts)


NO_WAY = 1e-12
"""Turn of the pinion [rad] that is none: the contact of a pair that the first balance did not close is the first."""
PATH_STEP = 1e-5
"""Turn of the pinion [rad] of which differences along the paths of contacts are taken."""


def _along_paths(pair: GearPair) -> PairChange:
    """Motion of contacts along their paths, per radian of the pinion's angle.

    Seen from the pinion the wheel goes about its axis, against that turn; then it is turned back into contact.
    """
    turn = cylindrical_basis(np.asarray(0.5 * pair.sense * PATH_STEP))
    below, above = (
        replace(pair, wheel_origin=by @ pair.wheel_origin, wheel_axes=pair.wheel_axes @ by.T) for by in (turn.T, turn)
    )
    return PairChange("mounting.path", below, above, PATH_STEP)


def _first_rotations(tangents: Tangents, opened: Array, lever_torques: Array) -> Array:
    """Growth (keys, grids) [rad per unit] of the rotations of first balances, whose contact laws no key changes.

    ``opened`` (keys, grids): growth of the distances between the flanks of pairs [mm per unit].
    """
    first = np.flatnonzero(np.diff(tangents.state, prepend=-1))
    torques = -np.add.reduceat(lever_torques, first, axis=1)
    return tangents.rotation_change(opened[:, tangents.grid], torques)[:, tangents.state]


def _add_displaced(
    result: CycleNumbers,
    tangents: Tangents,
    bending: BendingPart | None,
    changes: Sequence[PairChange],
    growth: MovedContacts,
    shifts: Array,
    gaps: Array,
) -> Array:
    """Add to the gaps (keys, n) what the forces as they are displace more; what cells at the cap carry more has levers.

    ``shifts`` (keys, grids, 2): of the contact points along x and y of the grids [mm per unit].

    Returns the growth of their torques (keys, grids) [N mm per unit].
    """
    pair, grids = result.gear_pair, tangents.grids
    ends = np.cumsum([np.count_nonzero(grid.pressed) for grid in grids])[:-1]
    covers, lever_torques = np.split(growth.covers, ends, axis=1), np.zeros((len(gaps), len(grids)))
    for i, (first, last) in enumerate(pairwise([0, *tangents.ends.tolist()])):
        if (own := covers[i]).any():
            gaps[:, first:last] += _released(grids[i], own)
    if pair.max_pressure is not None:
        _add_forces_at_cap(tangents, covers, gaps, lever_torques)
    free_edges = result.scene.analysis.free_edges
    _add_moved_lines(pair, tangents, bending, changes, growth, shifts, gaps, free_edges=free_edges)
    return lever_torques


PART_OF_CELL = 1e-2
"""Motion of grids of which differences are taken, over the smallest cell."""


@dataclass(frozen=True, eq=False)
class MotionGrowth:
    """Growth of what the loaded states balance as their grids move along x or y, forces held.

    Any grid is as good as another, so that in the limit of small cells no figure changes by it; what figures change
    tells how far derivatives depend on the motions of the grids.

    Attributes
    ----------
    gaps : (2, places, n) array [1]
        At the active cells, with what the forces as they are displace more, for a motion of one grid: that at a place
        among the grids of its state. Bodies and teeth displace the cells of the other grids, too.
    lever_torques : (2, grids) array [N]
        Growth of the torque of each pair by what its cells at the cap carry more as its own grid moves.
    grids : (places, states) int array
        The grid at each place of a state; after the last one where there is none.
    """

    gaps: Array
    lever_torques: Array
    grids: Indices

    def rates(self, tangents: Tangents, by_gaps: Array, by_torque: Array) -> Array:
        """Growth of a number of each state as one of its grids moves (2, grids) [per mm].

        ``by_gaps`` (n,), ``by_torque`` (states,): its derivatives by the gaps of the cells and by the torques.
        """
        by_place = tangents.summed(self.gaps * by_gaps)
        rates = np.zeros((2, tangents.state.size + 1))
        rates[:, self.grids] = by_place
        return np.asarray(rates[:, :-1] - by_torque[tangents.state] * self.lever_torques)

    def moved(self, tangents: Tangents, motions: Array) -> tuple[Array, Array]:
        """Growth of gaps (keys, n) and lever torques (keys, grids) with motions (keys, grids, 2) of the grids."""
        lever_torques = (np.moveaxis(motions, -1, 0) * self.lever_torques[:, None]).sum(axis=0)
        padded = np.pad(motions, ((0, 0), (0, 1), (0, 0)))
        gaps = np.zeros((len(motions), tangents.grid.size))
        for way, by_places in enumerate(self.gaps):
            for grids, by_place in zip(self.grids, by_places, strict=True):
                gaps += tangents.spread(padded[:, grids, way]) * by_place
        return gaps, lever_torques


def motion_growth(
    result: CycleNumbers,
    tangents: Tangents,
    bending: BendingPart | None,
    displaced: Callable[[Array, float], Array] | None = None,
) -> MotionGrowth:
    """Growth with the motions of the grids.

    Parameters
    ----------
    result : MeshCycle
    tangents : Tangents
    bending : BendingPart or None
    displaced : callable, optional
        Growth of the displacement of the active cells (n,) beside that of the teeth by motions (grids, 6) of the grids,
        with a step of these [mm]; default: there is none.
    """
    pair, grids, state = result.gear_pair, tangents.grids, tangents.state
    separations, pressed = [grid.separation for grid in grids], [grid.pressed for grid in grids]
    held = contact_changes(pair, [grid.contact for grid in grids], separations, pressed, [])
    place = np.arange(state.size) - np.searchsorted(state, state)
    at = np.full((place.max() + 1, state[-1] + 1), state.size)
    at[place, state] = np.arange(state.size)
    # first all places along x, then along y
    ways, places = np.repeat([0, 1], len(at)), np.tile(np.arange(len(at)), 2)
    motions = np.zeros((ways.size, len(grids), OF_GRIDS))
    motions[np.arange(ways.size)[:, None], np.arange(len(grids)), ways[:, None]] = place == places[:, None]
    covers = np.zeros((ways.size, held.contact.size))
    own = place[held.contact[held.border.cell]] == places[:, None]
    covers[:, held.border.cell] = own * held.border.slopes[:, :2].T[ways]
    active = np.concatenate([grid.active[grid.pressed] for grid in grids])
    gaps = held.slopes.T[:2, active][ways] * (place[tangents.grid] == places[:, None])
    steps = (PART_OF_CELL * np.min([one.spacing for one in separations], axis=0))[ways].tolist()
    changes = [PairChange("mounting.grids", pair, pair, step) for step in steps]
    growth = MovedContacts(gaps, covers, motions)
    lever_torques = _add_displaced(result, tangents, bending, changes, growth, motions[..., :2], gaps)
    if displaced is not None:
        gaps += [displaced(motion, step) for motion, step in zip(motions, steps, strict=True)]
    by_ways = (2, len(at))
    return MotionGrowth(gaps.reshape(*by_ways, -1), lever_torques.reshape(*by_ways, -1).sum(axis=1), at)


def _add_forces_at_cap(tangents: Tangents, covers: Sequence[Array], gaps: Array, lever_torques: Array) -> None:
    """Add to gaps (keys, n) and torques (keys, grids) what cells at the cap carry more as edges move in them."""
    forces = [growth_at_cap(grid, own) for grid, own in zip(tangents.grids, covers, strict=True)]
    for i, (grid, own) in enumerate(zip(tangents.grids, forces, strict=True)):
        lever_torques[:, i] += grid.contact.pinion_lever * own.sum(axis=(1, 2))
    for key in np.flatnonzero(np.any([own.any(axis=(1, 2)) for own in forces], axis=0)).tolist():
        gaps[key] += tangents.displaced_by([own[key] for own in forces])


def growth_at_cap(grid: LoadedGrid, covers: Array) -> Array:
    """Growth of the forces (keys, nx, ny) [N per unit] of cells at the cap, whose parts of material grow (keys, n)."""
    growth = np.zeros((len(covers), *grid.active.shape))
    assert grid.problem.max_pressure is not None
    growth[:, grid.pressed] = covers * (grid.problem.max_pressure * grid.problem.cell_area)
    growth[:, grid.active] = 0.0
    return growth


def _released(grid: LoadedGrid, covers: Array) -> Array:
    """What the forces of a grid displace its active cells (keys, n) [mm per unit] more as edges move in it.

    ``covers`` (keys, m): growth of the parts of its cells under pressure.
    """
    growth = np.zeros((len(covers), *grid.active.shape))
    growth[:, grid.pressed] = covers
    (dx, dy), problem = grid.problem.spacing, grid.problem
    cover = np.ones(grid.active.shape) if problem.cover is None else problem.cover
    displaced = crowding_growth(cover, growth, grid.pressure, dy / dx)
    return displaced[:, grid.active] * (dx / problem.contact_modulus)


def moved(grid: Grid, motion: Array) -> Grid:
    """A grid moved by small motions (6,) as of :class:`loaded_tca.separation.gap_change.MovedContacts`."""
    along_x, along_y, turn, tilt_x, tilt_y, lift = motion
    rates = np.array([[0.0, turn, -tilt_x], [-turn, 0.0, -tilt_y], [tilt_x, tilt_y, 0.0]])
    axes = grid.axes + rates @ grid.axes
    return replace(grid, origin=grid.origin + np.array([along_x, along_y, lift]) @ grid.axes, axes=axes)


def _add_moved_lines(
    pair: GearPair,
    tangents: Tangents,
    bending: BendingPart | None,
    changes: Sequence[PairChange],
    growth: MovedContacts,
    shifts: Array,
    gaps: Array,
    *,
    free_edges: bool,
) -> None:
    """Add to the gaps (keys, n) what teeth bend more under the forces, as the lines of these move on them.

    Free edges are those beside the lines through the contact points, which move by ``shifts`` (keys, grids, 2).
    """
    grids, motions = tangents.grids, growth.motions
    separations = [grid.separation for grid in grids]
    slices = np.concatenate([grid.active.nonzero()[1] for grid in grids])
    slices = (
        slices + (np.cumsum([one.y.size for one in separations]) - [one.y.size for one in separations])[tangents.grid]
    )
    forces = np.concatenate([grid.slice_force for grid in grids])
    if free_edges:
        lines = motions.copy()
        lines[..., 0] = shifts[..., 0]
        steps = {
            key: _moved_slices(pair, change, separations, lines[key])
            for key, change in enumerate(changes)
            if not change.of_modifications or lines[key].any()
        }
        if steps:
            gaps[[*steps]] += edge_deflection_growth(pair, separations, forces, [*steps.values()])[:, slices]
    moving = [key for key, change in enumerate(changes) if not change.of_modifications]
    if bending is not None and moving:
        contacts = [(grid.number, grid.separation) for grid in grids]
        moved_slices = [_moved_slices(pair, changes[key], separations, motions[key]) for key in moving]
        gaps[moving] += bending.deflection_growth(contacts, tangents.state, forces, moved_slices)[:, slices]
    others = [key for key, change in enumerate(changes) if change.of_modifications]
    if tangents.by_shift is not None and others:
        across = np.repeat(motions[others][..., 0], [one.y.size for one in separations], axis=1)
        gaps[others] += (tangents.by_shift @ across.T).T[:, slices]


def _moved_slices(pair: GearPair, change: PairChange, separations: Sequence[Separation], motions: Array) -> MovedSlices:
    """Slices of grids that a key moves (grids, 6), a step of it below and above.

    Modifications move no edge, and contacts by much: by a step of theirs, by a small part of a cell.
    """
    if change.of_modifications:
        width = min(min(one.spacing) for one in separations)
        change = replace(change, below=pair, above=pair, difference=PART_OF_CELL * width / np.abs(motions).max())
    low, high = (
        (gears, [moved(one, part * change.difference * by) for one, by in zip(separations, motions, strict=True)])
        for gears, part in ((change.below, -0.5), (change.above, 0.5))
    )
    return MovedSlices(low, high, change.difference)


STEP = 1e-3
"""Step of the motion of a grid, over the width of its cells."""
ROUNDS, BETWEEN = 6, 17
"""How often that length is divided on the way to the start, by so many places: to 6e-8 of it."""
FLAT = 1e-12
"""Curvature [1/mm] that is none."""


def curvature_growth(
    pair: GearPair,
    grids: Sequence[LoadedGrid],
    peaks: Sequence[SlicePeak],
    changes: Sequence[PairChange | None],
    growth: GapGrowth,
) -> Array:
    """Relative growth (keys, grids) [1 per unit] of line load times curvature at the peaks of some grids, forces held.

    A peak goes with its grid; one at the start of a relief, where the curvature jumps, goes with the start, to where
    the line load is another.

    Parameters
    ----------
    pair : GearPair
    grids : sequence of LoadedGrid
    peaks : sequence of SlicePeak
        Of the slices of each.
    changes : sequence of PairChange or None
        None of keys that change no gears.
    growth : GapGrowth
        Of these grids.
    """
    along = np.array([[peak.place[1]] for peak in peaks])
    reach = np.array([[peak.resolution] for peak in peaks])
    held = np.zeros((len(grids), growth.motions.shape[-1]))
    ends = along + reach * [-1.0, 1.0]
    at_ends = _log_curvature(pair, grids, held[:, 0], held)(_middles(peaks, ends), ends)
    starts = np.flatnonzero(np.abs(at_ends[:, 1] - at_ends[:, 0]) > JUMP)
    at = starts.tolist()
    rises, level = at_ends[starts, 1] > at_ends[starts, 0], at_ends[starts].mean(axis=1, keepdims=True)

    def grown(gears: GearPair, turns: Array, motions: Array) -> Array:
        """Logarithm (grids,) of line load times curvature at the peaks, the wheel turned and the grids moved."""
        relative = _log_curvature(gears, grids, turns, motions)(_middles(peaks, along), along)[:, 0]
        if starts.size:
            bends = _log_curvature(gears, [grids[i] for i in at], turns[starts], motions[starts])
            relative[starts] = _at_starts(bends, [peaks[i] for i in at], level, rises, ends[starts])
        return relative

    relative = np.zeros((len(changes), len(grids)))
    for key, change in enumerate(changes):
        if change is None:
            continue
        turns, motions = growth.turns[key], growth.motions[key]
        of_shape = [
            grown(side, part * change.difference * turns, held)
            for side, part in ((change.below, -0.5), (change.above, 0.5))
        ]
        lengths = np.abs(motions[:, :2]).max(axis=1)
        step = (
            STEP * np.array([grid.separation.spacing[0] for grid in grids]) / np.where(lengths > 0.0, lengths, np.inf)
        )
        of_motion = [grown(pair, 0.0 * turns, part * step[:, None] * motions) for part in (-1.0, 1.0)]
        for (low, high), width in ((of_shape, change.difference), (of_motion, 2.0 * step)):
            change_of_log = np.where(np.abs(high - low) < JUMP, high - low, 0.0)
            relative[key] += np.divide(change_of_log, width, out=np.zeros(len(grids)), where=np.asarray(width) > 0.0)
    return relative


def _middles(peaks: Sequence[SlicePeak], along: Array) -> Array:
    """Middles across of the slices at places (grids, n) along them [mm]."""
    return np.stack([peak.slices.at(row)[0] for peak, row in zip(peaks, along, strict=True)])


def _log_curvature(
    gears: GearPair, grids: Sequence[LoadedGrid], turns: Array, motions: Array
) -> Callable[[Array, Array], Array]:
    """Logarithm of the curvatures at places (grids, n) across and along, the wheel turned and the grids moved."""
    contacts, axes = [], []
    for grid, turn, motion in zip(grids, turns, motions, strict=True):
        there = moved(grid.separation, motion)
        angle = grid.contact.wheel_angle - gears.driving * turn
        contacts.append(replace(grid.contact, point=there.origin, wheel_angle=angle))
        axes.append(there.axes)
    gap = NormalGap(gears.sharp, contacts, np.array(axes))
    return lambda across, along: np.log(np.maximum(gap.curvature_across(across, along), FLAT))


def _at_starts(
    bends: Callable[[Array, Array], Array], peaks: Sequence[SlicePeak], level: Array, rises: Mask, ends: Array
) -> Array:
    """Logarithm of line load times curvature at the starts of reliefs on which peaks lie, the former over that there.

    A start lies where the curvature passes a ``level`` (grids, 1) between ``ends`` (grids, 2), upwards or not.
    """
    for _ in range(ROUNDS):
        places = ends[:, :1] + (ends[:, 1:] - ends[:, :1]) * np.linspace(0.0, 1.0, BETWEEN)
        beyond = (bends(_middles(peaks, places), places) > level) == rises[:, None]
        first = np.clip(beyond.argmax(axis=1), 1, None)[:, None]
        ends = np.take_along_axis(places, first + np.array([-1, 0]), axis=1)
    place = np.where(rises, ends[:, 1], ends[:, 0])[:, None]  # on the side with the larger curvature
    logarithms = bends(_middles(peaks, place), place)[:, 0]
    loads = [peak.slices.at(np.array([y, peak.place[1]]))[2] for peak, (y,) in zip(peaks, place, strict=True)]
    return np.asarray(logarithms + [math.log(there / before) for there, before in loads])
