r"""Growth of the gaps of gears on supports with keys of the scene, under one torque.

The gears stand where the motions q of the mean load have set them, and the forces displace them further by their
supports: to first order the two together do not depend on q. So a key acts on the pair as it stands as it does on a
rigid one, with the displacement of the slices by stations and bodies,

.. math:: d_i = a_i \cdot (C W + q_0) - r_i \cdot q,

that of its own supports on lines that move with the grids. What is left is of second order in the motions and is as
large as what a mounting error does beside the gap that it opens: the mean load changes by the key, the gears stand
elsewhere by dq, and edges, lines of force and levers move with them. It enters as a mounting error of the pair, from
which the displacement -r_i dq, which the coupling has already, is taken off, and changes the mean load in its turn.

The forces turn with the normals at the contact points, which run over curved flanks, by modifications as well, whose
grids stay: on soft supports the gears go where the forces push them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np

from loaded_tca.arrays import GEARS, Array, Indices
from loaded_tca.errors import InputError
from loaded_tca.loaded.cycle import in_gear_angles
from loaded_tca.loaded.force_lines import LoadedSlices
from loaded_tca.loaded.moved_gears import Loads, given_motions, standing_under
from loaded_tca.results.gap_growth import GapGrowth, gap_growth, moved
from loaded_tca.results.numbers import CycleNumbers
from loaded_tca.separation.gap_change import OF_GRIDS
from loaded_tca.separation.pair_change import MOTIONS, PairChange, number_at, pair_changes
from loaded_tca.supports import Support, SupportCompliance, support_compliance, supports_of
from loaded_tca.unloaded import trace_contact, trace_teeth

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from loaded_tca.compliance.model import SumOfParts
    from loaded_tca.loaded.sensitivity import Tangents
    from loaded_tca.pairs.gear_pair import ContactGrid, GearPair
    from loaded_tca.scene import Scene

STEP, SMALLEST = 1e-4, 1e-3
"""Step of a key of a support over its value, and the least one: of stiffnesses in N/um, lengths in mm."""
STEP_OF_GEARS = 1e-5
"""Motion [mm] about where a gear stands, of which differences are taken: contact points are found to 1e-12 mm, which a
tenth of it leaves in them as 1e-8 of line loads."""
AS_NONE = 1e-3
"""Part of the motion of the gears by a key that is none: it is of second order."""
ROUNDS = 4
"""How often the motion by a key is asked for the motion that it makes itself, as long as that is one: once is the
rule, twice where the gears move by a tenth of a millimetre."""
SECTIONS = "support", "shaft"


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class UnderOneTorque(CycleNumbers):
    """Numbers of a result under one of its torques, in the gears as they stand under it.

    Attributes
    ----------
    at_rest, supports : SupportCompliance
        In the pair of the scene, and in the moved one.
    held : tuple of (6 m,) arrays
        Loads of pinion and wheel whose motions the pair is moved by.
    """

    at_rest: SupportCompliance
    supports: SupportCompliance
    held: Loads

    @property
    def gear_pair(self) -> GearPair:
        """The gears where they stand under the torque."""
        return self.supports.pair

    def displacement(self, grid: ContactGrid) -> Array:
        """Of the slices of a grid (ny,) [mm] by other loads on the shafts, less what has moved the pair."""
        return self.supports.gap_by_motion(grid, given_motions(self.supports, self.held))

    @property
    def bodies(self) -> tuple[Array, Array]:
        """Motions (6,) of pinion and wheel that the pair is moved by."""
        return self.supports.bodies(self.held)


_KEPT: WeakKeyDictionary[CycleNumbers, dict[int, UnderOneTorque]] = WeakKeyDictionary()
"""Results under one torque by its index, by the results on supports that they are of."""


def _stand_alike(result: CycleNumbers) -> bool:
    """Whether the gears of a result stand alike under all its torques."""
    return isinstance(result, UnderOneTorque) or not result.scene.is_supported


def as_gears_stand(result: CycleNumbers) -> list[CycleNumbers]:
    """A result by where its gears stand: itself where none is on supports, else what it is under each torque."""
    if _stand_alike(result):
        return [result]
    return [under_one_torque(result, torque) for torque in range(len(result.torque))]


def gears_under_torque(result: CycleNumbers, torque: int) -> tuple[CycleNumbers, int]:
    """A result whose gears stand as they do under a torque, by its index, and the index that it has there."""
    if _stand_alike(result):
        return result, torque
    return under_one_torque(result, torque), 0


def under_one_torque(result: CycleNumbers, torque: int) -> UnderOneTorque:
    """The numbers of a result on supports under one torque, by its index; its contacts are traced once, and kept."""
    kept = _KEPT.setdefault(result, {})
    if torque not in kept:
        kept[torque] = _under_one_torque(result, torque)
    return kept[torque]


def _under_one_torque(result: CycleNumbers, torque: int) -> UnderOneTorque:
    supports = support_compliance(result.scene, result.gear_pair)
    assert supports is not None
    pinion, wheel = (result.dataset[f"{gear}_support_load"].values[torque] for gear in GEARS)
    at_rest = supports.linear_near((pinion, wheel))
    supports = standing_under(at_rest, (pinion, wheel))
    pair = supports.pair
    if result.scene.analysis.load_sharing:
        path, paths = in_gear_angles(trace_teeth(pair, result.pinion_angle))
    else:
        path = trace_contact(pair, result.pinion_angle, warn=False)
        paths = {0: path}
    return UnderOneTorque(
        scene=result.scene,
        dataset=result.dataset.isel(torque=[torque]),
        path=path,
        paths=tuple(paths.get(number, own) for number, own in zip(result.pair.tolist(), result.paths, strict=True)),
        maps=(result.maps[torque],),
        at_rest=at_rest,
        supports=supports,
        held=(pinion, wheel),
    )


@dataclass(frozen=True, eq=False)
class MovedChange(PairChange):
    """Two pairs that differ in one key, and in where the gears stand by it."""

    @property
    def of_modifications(self) -> bool:
        """No: the wheel stands elsewhere, too."""
        return False

    @property
    def of_mounting(self) -> bool:
        """Yes."""
        return True


@dataclass(frozen=True, eq=False)
class SupportChange:
    """What differs in one key on supports, the motions of the gears held.

    Attributes
    ----------
    pairs : PairChange
        Both moved alike; of a key of a support twice the same.
    low, high : SupportCompliance
        In these pairs.
    """

    pairs: PairChange
    low: SupportCompliance
    high: SupportCompliance


def is_of_support(key: str) -> bool:
    """Whether a key is one of a support or of a shaft."""
    sections = key.split(".")[:-1]
    return len(sections) > 1 and sections[0] in GEARS and sections[1] in SECTIONS


def changes_at_rest(scene: Scene, keys: Sequence[str]) -> dict[str, PairChange]:
    """Pairs at rest that differ in each key that is none of a support, by the keys.

    Raises
    ------
    InputError
        With every key that is none of those of sensitivities, or no number, those of supports included.
    """
    problems, changes = [], list[PairChange]()
    for key in keys:
        if is_of_support(key):
            try:
                number_at(scene, key)
            except InputError as error:
                problems += [f"{key}: {problem}" for problem in error.problems]
    try:
        changes = pair_changes(scene, [key for key in keys if not is_of_support(key)])
    except InputError as error:
        problems += error.problems
    if problems:
        raise InputError(problems)
    return {change.key: change for change in changes}


def _support_changes(
    result: UnderOneTorque, keys: Sequence[str], at_rest: Mapping[str, PairChange]
) -> dict[str, SupportChange]:
    """What differs in each key, the motions of the gears held; nothing of the torque."""
    of_supports = {key: _of_support(result, key) for key in keys if is_of_support(key)}
    return of_supports | {key: _of_pair(result, one) for key, one in at_rest.items()}


def _of_pair(result: UnderOneTorque, change: PairChange) -> SupportChange:
    """The same motions in two pairs at rest, in the frames of which the supports stand."""
    sides = []
    for pair in (change.below, change.above):
        axes = np.stack([np.eye(3), pair.wheel_axes])
        sides.append(standing_under(replace(result.supports, pair=pair, axes=axes), result.held))
    low, high = sides
    return SupportChange(replace(change, below=low.pair, above=high.pair), low, high)


def _of_support(result: UnderOneTorque, key: str) -> SupportChange:
    """The supports a step either side of the value of a key; where one is not allowed the value itself."""
    scene, value = result.scene, number_at(result.scene, key)
    step = max(STEP * abs(value), SMALLEST)
    sides, refused = [(value, result.supports.supports)] * 2, None
    for side, trial in ((1, value + step), (0, value - step)):
        try:
            sides[side] = trial, _supports_with(scene, key, trial, result.held)
        except InputError as error:
            refused = refused or error
    (low, below), (high, above) = sides
    if refused is not None and low == high:
        raise refused
    both = (replace(result.supports, supports=supports) for supports in (below, above))
    return SupportChange(PairChange(key, result.gear_pair, result.gear_pair, high - low), *both)


def _supports_with(scene: Scene, key: str, value: float, held: Loads) -> tuple[Support, Support]:
    pinion, wheel = (
        support.linear_near(load)
        for support, load in zip(supports_of(scene.with_changes({key: value})), held, strict=True)
    )
    return pinion, wheel


def growth_on_supports(
    result: UnderOneTorque,
    tangents: Tangents,
    bending: SumOfParts,
    on_slices: OnSlices,
    places: tuple[Array, ...],
    keys: Sequence[str],
    at_rest: Mapping[str, PairChange],
    torques: Array,
) -> tuple[GapGrowth, tuple[PairChange, ...]]:
    """Growth of what the states balance by each key, the gears as far moved by it as the mean load moves them.

    Parameters
    ----------
    result : UnderOneTorque
    tangents : Tangents
    bending : SumOfParts
        With the supports.
    on_slices : OnSlices
        Of the tangents.
    places : three (grids,) arrays
        Torque, position and pair of each grid.
    keys : sequence of str
    at_rest : mapping of str to PairChange
        As of :func:`changes_at_rest`, by their keys.
    torques : (keys, 1) array [N mm per unit]
        Growth of the torque of the pinion.

    Returns
    -------
    growth : GapGrowth
    changes : tuple of PairChange
        The whole change of the gears by each key.
    """
    changes = _support_changes(result, keys, at_rest)
    teeth = bending.on_rigid_supports
    of_gears = [key for key in keys if key in changes and not is_of_support(key)]
    at = [keys.index(key) for key in of_gears]
    growth = gap_growth(result, tangents, teeth, places, [changes[key].pairs for key in of_gears])
    growth = growth.at_keys(at, len(keys))
    torques = torques - np.add.reduceat(growth.lever_torques, on_slices.first_grids, axis=1)
    motions = np.zeros((len(keys), 12))
    for n, key in enumerate(keys):
        in_states = np.zeros((on_slices.states, 12))
        if key in changes:
            displaced, in_states = on_slices.growth(changes[key], growth.motions[n])
            if changes[key].pairs.of_modifications:  # what lines move by them is in the tangents, grids do not tilt
                displaced, turned = on_slices.growth(changes[key], _tilting(growth.tilts[n]))
                in_states = in_states + turned
            growth.gaps[n] += displaced
            on_slices.add_kinks(changes[key], growth.kinks, n)
        motions[n] = on_slices.answer(tangents, growth.gaps[n], torques[n], in_states, places[1])
    lever, further = 0.5 * result.face_width, motions
    for _ in range(ROUNDS):
        directions, parts = _directions(further, motions, lever)
        if not len(directions):
            break
        moving = [_moved_further(result, way) for way in directions]
        by_motion = gap_growth(result, tangents, teeth, places, [change.pairs for change in moving])
        lever_torques = np.add.reduceat(by_motion.lever_torques, on_slices.first_grids, axis=1)
        answers = np.zeros((len(directions), 12))
        for n, (change, way) in enumerate(zip(moving, directions, strict=True)):
            displaced, in_states = on_slices.growth(change, by_motion.motions[n])
            by_motion.gaps[n] += displaced - on_slices.gap_by_motion(way)
            on_slices.add_kinks(change, by_motion.kinks, n)
            answers[n] = on_slices.answer(tangents, by_motion.gaps[n], -lever_torques[n], in_states, places[1])
        growth, further = growth.with_parts(parts, by_motion), parts @ answers
        motions = motions + further
    whole = tuple(_whole_change(result, key, at_rest.get(key), way) for key, way in zip(keys, motions, strict=True))
    return growth, whole


class OnSlices:
    """What the supports do on the slices of the grids of all states."""

    def __init__(self, result: UnderOneTorque, tangents: Tangents) -> None:
        self.bodies, self.supports = result.bodies, result.supports
        self.grids, self.state = tangents.grids, tangents.state
        self.states = int(self.state[-1]) + 1
        self.first_grids: Indices = np.searchsorted(self.state, np.arange(self.states))
        self.by_force = np.concatenate([self._by_cells(n) for n in range(len(self.grids))], axis=1)

    def growth(self, change: SupportChange, motions: Array) -> tuple[Array, Array]:
        """Of the displacement of the active cells (n,), and of the motions of both gears (states, 12), per unit.

        The forces are held; ``motions`` (grids, 6) are those of the grids.
        """
        width = change.pairs.difference
        (below, low), (above, high) = (
            self._displaced(side, part * width * motions) for side, part in ((change.low, -0.5), (change.high, 0.5))
        )
        return (above - below) / width, (high - low) / width

    def add_kinks(self, change: SupportChange, kinks: GapGrowth | None, key: int) -> None:
        """Add to the kinks of a key what supports displace otherwise as its grids move otherwise by growing values."""
        if kinks is not None and kinks.motions[key].any():
            kinks.gaps[key] += self.by_motions(kinks.motions[key], change.pairs.difference)

    def by_motions(self, motions: Array, step: float) -> Array:
        """Growth of the displacement of the active cells (n,) by motions (grids, 6) of the grids alone, with a step."""
        pair = self.supports.pair
        held = SupportChange(PairChange("mounting.grids", pair, pair, step), self.supports, self.supports)
        return self.growth(held, motions)[0]

    def gap_by_motion(self, way: Array) -> Array:
        """How far the gaps at the active cells (n,) grow as both gears move by (12,) as rigid bodies."""
        motions = way[:6], way[6:]
        return self._at_cells([self.supports.gap_by_rigid_motion(one.separation, motions) for one in self.grids])

    def answer(self, tangents: Tangents, gaps: Array, torques: Array, in_states: Array, positions: Array) -> Array:
        """Mean motions of both gears (12,) by the forces that gaps and torques change, beside those in states."""
        forces = tangents.force_change(gaps, torques)
        return self._mean(in_states + tangents.summed(self.by_force * forces).T, positions)

    def _mean(self, motions: Array, positions: Array) -> Array:
        """Of motions (states, 12) over a pitch, whose last position is the first of the next one."""
        own = positions[self.first_grids]
        within = own < own.max() if self.states > 1 else np.ones(1, dtype=bool)
        return np.asarray(motions[within].mean(axis=0))

    def _displaced(self, side: SupportCompliance, motions: Array) -> tuple[Array, Array]:
        """Displacement of the active cells (n,) under the forces as they are, motions of both gears (states, 12)."""
        places = [moved(grid.separation, motion) for grid, motion in zip(self.grids, motions, strict=True)]
        units = [side.loads(place) for place in places]
        displaced: list[Array] = []
        of_bodies = np.zeros((self.states, 12))
        for state, first in enumerate(self.first_grids.tolist()):
            own = [n for n in range(first, len(self.grids)) if self.state[n] == state]
            stations = [
                support.moved(np.sum([self.grids[n].slice_force @ units[n][gear] for n in own], axis=0))
                for gear, support in enumerate(side.supports)
            ]
            of_bodies[state] = np.concatenate(
                [support.at_middle(motion) for support, motion in zip(side.supports, stations, strict=True)]
            )
            for n in own:
                by_stations = sum(unit @ motion for unit, motion in zip(units[n], stations, strict=True))
                displaced.append(np.asarray(by_stations - side.gap_by_rigid_motion(places[n], self.bodies)))
        return self._at_cells(displaced), of_bodies

    def _at_cells(self, by_slice: Sequence[Array]) -> Array:
        return np.concatenate(
            [values[grid.active.nonzero()[1]] for values, grid in zip(by_slice, self.grids, strict=True)]
        )

    def _by_cells(self, number: int) -> Array:
        """Motions of both gears (12, n) by a unit force on each active cell of a grid, at its own place."""
        grid = self.grids[number]
        across, along = grid.active.nonzero()
        one = grid.separation
        units = self.supports.loads(LoadedSlices(one.y[along], one.origin, one.axes, one.x[across]))
        both = [
            _to_middle(support) @ support.compliance @ unit.T
            for support, unit in zip(self.supports.supports, units, strict=True)
        ]
        return np.concatenate(both)


def _tilting(tilts: Array) -> Array:
    """Motions (grids, 6) of grids that tilt alone, with the normals at their contact points (grids, 2)."""
    motions = np.zeros((len(tilts), OF_GRIDS))
    motions[:, MOTIONS:-1] = tilts
    return motions


def _to_middle(support: Support) -> Array:
    """Matrix (6, 6 m) of ``Support.at_middle``."""
    return np.asarray(np.kron(support.shares(np.array([support.middle])), np.eye(6)), dtype=float)


def _directions(motions: Array, whole: Array, lever: float) -> tuple[Array, Array]:
    """Directions (r, 12) in which gears stand elsewhere by any key, and parts (keys, r) of their motions (keys, 12).

    Each moves the gears by about 1 mm, turns counted at a lever [mm]; motions that are none beside the whole ones by a
    key are left out.
    """
    scale = np.tile(np.repeat([1.0, lever], 3), 2)
    sizes = np.linalg.norm(whole * scale, axis=1, keepdims=True)
    alike = np.divide(motions * scale, sizes, out=np.zeros(motions.shape), where=sizes > 0.0)
    left, spread, right = np.linalg.svd(alike, full_matrices=False)
    some = np.flatnonzero(spread > AS_NONE)
    return right[some] / scale, sizes * left[:, some] * spread[some]


def _moved_further(result: UnderOneTorque, way: Array) -> SupportChange:
    """The pair whose gears stand a step to either side along a direction (12,)."""
    below, above = (_moved_with(result, result.at_rest.pair, part * STEP_OF_GEARS * way) for part in (-0.5, 0.5))
    return SupportChange(MovedChange("mounting.supports", below.pair, above.pair, STEP_OF_GEARS), below, above)


def _moved_with(result: UnderOneTorque, at_rest: GearPair, way: Array) -> SupportCompliance:
    """Supports in a pair at rest moved by the mean load, and its gears by a small motion (12,) more."""
    pinion, wheel = result.bodies
    return result.at_rest.mounted(at_rest).moved([pinion + way[:6], wheel + way[6:]])


def _whole_change(result: UnderOneTorque, key: str, at_rest: PairChange | None, way: Array) -> PairChange:
    """Pairs that differ in a key and in the motions (12,) of the gears per unit of it."""
    if at_rest is None:
        pair, scale = result.at_rest.pair, np.tile(np.repeat([1.0, 0.5 * result.face_width], 3), 2)
        size = float(np.abs(way * scale).max())
        at_rest = PairChange(key, pair, pair, STEP_OF_GEARS / size if size > 0.0 else 1.0)
    width = at_rest.difference
    low, high = (
        _moved_with(result, side, part * width * way) for side, part in ((at_rest.below, -0.5), (at_rest.above, 0.5))
    )
    return MovedChange(key, low.pair, high.pair, width)
