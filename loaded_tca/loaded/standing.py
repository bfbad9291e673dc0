r"""Gears as they stand under each torque, and their mesh cycles there.

Rigid gears stand alike under all torques. Of gears on shafts and bearings that give way the geometry is moved by what
the mean load moves, the rest is coupled: under each torque the loads W of both gears, the means over a pitch, move them
by q(W) = C W + q0. The pair is moved by that motion as rigid bodies, its unloaded contact is traced anew, and the mesh
cycle is solved with the compliance C of the supports and a given displacement of every slice,

.. math:: d_i = a_i \cdot q_0 - r_i \cdot q(W),

with a_i and r_i the unit loads of the slice on the stations and on the rigid body: what the geometry has moved already
does not move again. Newton's step: the loads that follow are those of the next motion, until it stays; a few positions
of the pitch are enough for it. The last one holds for the ordinary cycle, whose loads alternate about the mean. Rolling
bearings are linear near the loads of each step, C and q0 are those of their tangent there.

References
----------
Deuflhard 2011, Newton Methods for Nonlinear Problems, chapter 2.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np

from loaded_tca.arrays import Array, Indices
from loaded_tca.compliance.model import BendingModel, SumOfParts
from loaded_tca.errors import ConvergenceError, GeometryError, named
from loaded_tca.loaded.cycle import (
    AllPairsCycle,
    Contacts,
    CycleSolution,
    OnePairsCycle,
    Progress,
    in_gear_angles,
    solve_cycles,
)
from loaded_tca.loaded.loaded_contact import LoadedContact
from loaded_tca.loaded.loaded_grid import LoadedGrid
from loaded_tca.loaded.moved_gears import (
    Loads,
    at_rest,
    loads_at,
    loads_at_first_contact,
    moved_bending,
    moved_by,
    moved_too_far,
    no_loads,
)
from loaded_tca.loaded.sensitivity import LoadedStates, loaded_states
from loaded_tca.loaded.together import Result, Steps
from loaded_tca.loaded.tooth_contact import Coupling, GridChoice
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.plain import plain
from loaded_tca.supports import SupportCompliance
from loaded_tca.unloaded import ContactPath, MeshPath, trace_contact, trace_teeth

POSITIONS = 2
"""Positions of a pitch whose mean load moves the geometry on the way: motions follow the load's place to a few 1e-3."""
ENOUGH, CLOSE, MOST_AGAIN = 4, 2e-5, 3
"""Positions of a cycle, from more than which on its mean load is that of a pitch: where that moves the gears by more
than so many modules further, the cycle is done again from there, so often at the most. A micrometre was worth 1e-3 of
the transmission error of the softest bevel pair, and 1e-4 of helical ones."""
SETTLED = 0.02
"""Change of the motions from one step to the next, over the motions, from which the geometry stays where it is: what
is left of them is coupled, and what that leaves out is of their product with the motions themselves."""
NEARER = 5e-3
"""The same of rolling bearings: what is left of the loads is that of their tangents, too."""
ROUGHLY, ROUGH_PEAK = 1e-3, 0.1
"""Agreement of the tooth pairs, and accuracy of the peak pressure where no cells are given, on the way to the motions:
what they leave is coupled."""
SWINGING = 7
"""Steps after which loads go half the way only: a tooth pair that comes into contact at one of the positions and not at
the next step makes them swing."""
CALM = 0.1
"""Change of the motions over that of the step before, up to which loads go the whole way all the same: swings keep half
of it and more, and a gear that half of a swing has brought into line needs no more halves."""
MOST_STEPS = 12
"""Steps before giving up; two to four are the rule."""


class LoadedStanding(Protocol):
    """Gears at n positions under torques under which they stand alike, as :class:`StandingCycle` has them."""

    @property
    def standing(self) -> Standing:
        """Where they stand."""

    @property
    def loads(self) -> tuple[Array, ...]:
        """Loads (n, 6 m) of the supports of pinion and wheel at the positions; none where the gears are rigid."""

    @property
    def drive_rate(self) -> Array:
        """Tangent (torques, n) of the torque over the rotation with the supports [N mm/rad]."""


@dataclass(frozen=True, eq=False)
class Standing:
    """Gears as they stand under some of the torques, and what gives way beneath their contacts there.

    Attributes
    ----------
    torques : (t,) array [N mm]
        Of the pinion: all of them of rigid gears, one of gears on supports.
    pair : GearPair
    bending : SumOfParts or None
        With the supports in that pair.
    loads : tuple of (6 m,) arrays, or None
        Of the supports of pinion and wheel, by whose motions the pair is moved; None: the gears are rigid.
    displacement : callable or None
        Of the slices beside what the forces displace: by other loads on the shafts, less what has moved the pair.
    supports_at_rest : SupportCompliance or None
        In the pair at rest, linear near the loads.
    """

    torques: Array
    pair: GearPair
    bending: SumOfParts | None
    loads: Loads | None = None
    displacement: Coupling | None = None
    supports_at_rest: SupportCompliance | None = None

    @property
    def supports(self) -> SupportCompliance | None:
        """Supports in the pair as it stands; None of rigid gears."""
        return None if self.bending is None else self.bending.supports

    @property
    def teeth(self) -> SumOfParts | None:
        """What bends on supports that are held."""
        return None if self.bending is None else self.bending.on_rigid_supports

    @property
    def giving_way(self) -> SumOfParts | None:
        """The bending without supports that are rigid; None where nothing is left."""
        return None if self.bending is None else self.bending.giving_way

    def moved(self, pair: GearPair) -> GearPair:
        """Another pair of the same gears at rest, with other flanks, as it stands."""
        if self.supports_at_rest is None or self.loads is None:
            return pair
        return moved_by(replace(self.supports_at_rest, pair=pair), self.loads)


@dataclass(frozen=True, eq=False)
class StandingCycle:
    """What the tooth pairs carry where the gears stand.

    Attributes
    ----------
    standing : Standing
    carried : CycleSolution
        Under its torques, from there on.
    loads : tuple of (n, 6 m) arrays
        Of the supports of pinion and wheel at the positions, NaN where nothing is in contact; none of rigid gears.
    mesh_rate : (t, n) array [N mm/rad]
        Tangent of the torque over the rotation with supports held.
    """

    standing: Standing
    carried: CycleSolution
    loads: tuple[Array, ...]
    mesh_rate: Array

    @property
    def pitches_apart(self) -> int:
        """How many pitches two tooth pairs that carry load at a position are apart at the most."""
        return pair_span(self.carried.pairs, self.carried.share)

    @property
    def drive_rate(self) -> Array:
        """Tangent (t, n) of the torque over the rotation with the supports [N mm/rad]."""
        return self.carried.torque_rate


@dataclass(frozen=True, eq=False)
class _Cycle:
    """States of the gears where they stand."""

    standing: Standing
    states: OnePairsCycle | AllPairsCycle

    @property
    def pair(self) -> GearPair:
        return self.standing.pair

    def steps(self) -> list[Steps[Any]]:
        return [_told(own, self.standing) for own in self.states.steps()]

    def carried(self, results: Sequence[Any]) -> CycleSolution:
        carried = self.states.carried(results)
        bending = self.standing.bending  # rigid supports included
        return replace(carried, states=replace(carried.states, bending=bending))


class GearsUnderTorques:
    """Gears of a pair under torques, each in its turn or together.

    Parameters
    ----------
    pair : GearPair
        At rest.
    bending : SumOfParts or None
        With its supports, if the gears stand on some.
    angles : (n,) array [rad]
        Of the pinion.
    grid : GridChoice
    load_sharing : bool
        Whether all tooth pairs in contact share the load.
    at_rest : MeshPath or ContactPath, optional
        Unloaded contact of the gears at rest at these angles, if it is traced already: there rigid gears stay.
    """

    def __init__(
        self,
        pair: GearPair,
        bending: SumOfParts | None,
        angles: Array,
        grid: GridChoice,
        *,
        load_sharing: bool = True,
        at_rest: MeshPath | ContactPath | None = None,
    ) -> None:
        self.pair, self.bending = pair, bending
        self.supports = None if bending is None else bending.supports
        self.angles, self.grid, self.load_sharing = angles, grid, load_sharing
        self.path_at_rest = at_rest

    def standing(self, torques: Sequence[float] | Array) -> list[Standing]:
        """Where the gears stand under pinion torques [N mm], in their order.

        Raises
        ------
        GeometryError
            If the flanks are not in contact any more where the supports let the gears move.
        ConvergenceError
            If the motions do not settle, or a contact is not solved.
        """
        if self.supports is None:
            return [Standing(np.asarray(torques, dtype=float), self.pair, self.bending)]
        torques = [float(torque) for torque in torques]
        mean_loads = self._mean_loads(self.supports, torques)
        return [self._moved(torque, loads) for torque, loads in zip(torques, mean_loads, strict=True)]

    def mesh_cycles(self, torques: Sequence[float] | Array, progress: Progress | None = None) -> list[StandingCycle]:
        """Mesh cycles under pinion torques [N mm], worked on together; errors are those of :meth:`standing`."""
        cycles = [self._cycle(standing, self.angles, self.grid) for standing in self.standing(torques)]
        carried = solve_cycles(cycles, progress)
        for _ in range(MOST_AGAIN if len(self.angles) > ENOUGH else 0):
            moved = [self._moved_further(cycle, solution) for cycle, solution in zip(cycles, carried, strict=True)]
            further = {t: standing for t, standing in enumerate(moved) if standing is not None}
            again = [self._cycle(standing, self.angles, self.grid) for standing in further.values()]
            for t, cycle, solution in zip(further, again, solve_cycles(again) if again else (), strict=True):
                cycles[t], carried[t] = cycle, solution
        return [_standing_cycle(cycle.standing, solution) for cycle, solution in zip(cycles, carried, strict=True)]

    def _moved_further(self, cycle: _Cycle, carried: CycleSolution) -> Standing | None:
        """Where the mean load of a whole pitch moves the gears; None if that is no further than where they stand."""
        standing, (torque, *_) = cycle.standing, cycle.standing.torques.tolist()
        if standing.supports is None or torque == 0.0:
            return None
        mean = _mean_load(standing.supports, carried, whole=True)
        return None if self._is_done(standing, mean) else self._moved(torque, mean)

    def _mean_loads(self, supports: SupportCompliance, torques: Sequence[float]) -> list[Loads]:
        """Mean loads under pinion torques [N mm] whose motions of the geometry are those that follow from them.

        Loads are nearly in proportion to the torque: those between the smallest and the largest one follow from these,
        where a cycle of enough positions checks them.
        """
        loaded = sorted({torque for torque in torques if torque > 0.0})
        if not loaded:
            return [no_loads(supports) for _ in torques]
        if len(self.angles) <= ENOUGH:
            each = dict(zip(loaded, self._settled(supports, loaded), strict=True))
            return [each.get(torque) or no_loads(supports) for torque in torques]
        low, high = loaded[0], loaded[-1]
        first, last = self._settled(supports, [low, high])

        def between(torque: float) -> Loads:
            part = (torque - low) / (high - low) if high > low else 1.0
            pinion, wheel = (
                torque * ((1.0 - part) / low * at_low + part / high * at_high)
                for at_low, at_high in zip(first, last, strict=True)
            )
            return pinion, wheel

        return [between(torque) if torque > 0.0 else no_loads(supports) for torque in torques]

    def _settled(self, supports: SupportCompliance, torques: Sequence[float]) -> list[Loads]:
        """The same, torques by themselves: from where the flanks touch first without load."""
        count = min(POSITIONS, len(self.angles))
        spread = (np.arange(count) - 0.5 * (count - 1)) / count * self.pair.pitch if count > 1 else self.angles
        roughly = replace(self.grid, agreement=ROUGHLY, accuracy=max(self.grid.accuracy, ROUGH_PEAK))
        pinion, wheel = loads_at_first_contact(supports, at_rest(self.pair, supports), 1.0)
        loads = {torque: (torque * pinion, torque * wheel) for torque in torques}
        left, changes = [*loads], dict.fromkeys(loads, 0.0)
        for step in range(MOST_STEPS):
            cycles = [self._cycle(self._moved(torque, loads[torque]), spread, roughly) for torque in left]
            for torque, cycle, carried in zip([*left], cycles, solve_cycles(cycles), strict=True):
                standing = cycle.standing
                assert standing.supports is not None
                assert standing.loads is not None
                mean = _mean_load(standing.supports, carried)
                change = self._distance(standing.supports, mean, standing.loads)
                if step >= SWINGING and change > CALM * changes[torque]:
                    mean = _halfway(standing.loads, mean)
                changes[torque] = change
                loads[torque] = mean
                if self._are_near(standing, mean):
                    left.remove(torque)
            if not left:
                return [loads[torque] for torque in torques]
        raise ConvergenceError(
            f"supports: motions under {plain(1e-3 * left[0], 6)} N m not settled in {MOST_STEPS} steps: the supports "
            "are too soft for these gears",
            last=loads[left[0]],
        )

    def _are_near(self, standing: Standing, loads: Loads) -> bool:
        """Whether the motions by loads are those of gears as they stand, but for a small part of them."""
        supports = standing.supports
        assert supports is not None
        assert standing.loads is not None
        part = SETTLED if supports.is_linear else NEARER
        whole = self._distance(supports, loads, no_loads(supports))
        return self._distance(supports, loads, standing.loads) <= part * whole

    def _is_done(self, standing: Standing, loads: Loads) -> bool:
        """Whether the mean load of a whole cycle moves the gears no further than where they stand in it."""
        supports = standing.supports
        assert supports is not None
        assert standing.loads is not None
        further = self._distance(supports, loads, standing.loads)
        return further <= CLOSE * self.pair.module and (supports.is_linear or self._are_near(standing, loads))

    def _distance(self, supports: SupportCompliance, loads: Loads, other_loads: Loads) -> float:
        """Largest way of the two gears between two loads, at a lever of half the face width [mm]."""
        lever = np.repeat([1.0, 0.5 * self.pair.face_width], 3)
        ways = [
            support.at_middle(support.compliance @ (a - b)) * lever
            for support, a, b in zip(supports.supports, loads, other_loads, strict=True)
        ]
        return float(np.abs(ways).max())

    def _moved(self, torque: float, loads: Loads) -> Standing:
        """The pair moved by loads under a torque, with supports that are linear there."""
        assert self.bending is not None
        assert self.supports is not None
        near = self.supports.linear_near(loads)
        bending, displacement = moved_bending(self.bending, near, loads)
        assert bending.supports is not None
        return Standing(np.array([torque]), bending.supports.pair, bending, loads, displacement, near)

    def _cycle(self, standing: Standing, angles: Array, grid: GridChoice) -> _Cycle:
        """States of the gears where they stand."""
        pair, torques = standing.pair, standing.torques
        what = grid, standing.giving_way, standing.displacement
        with _told_of(standing):
            path = self.path_at_rest if self.supports is None else None
            if path is None:
                path = (trace_teeth if self.load_sharing else trace_contact)(pair, angles)
        if isinstance(path, MeshPath):
            return _Cycle(standing, AllPairsCycle(pair, path, torques, *what))
        return _Cycle(standing, OnePairsCycle(pair, path, torques, *what))


def pair_span(pairs: Indices, shares: Array) -> int:
    """How many pitches two tooth pairs (k,) with shares (..., k) above 0 in the same state are apart at the most."""
    rows = shares.reshape(-1, len(pairs))
    return max((int(np.ptp(pairs[row > 0.0])) for row in rows if (row > 0.0).any()), default=0)


def _halfway(loads: Loads, other_loads: Loads) -> Loads:
    pinion, wheel = (0.5 * (a + b) for a, b in zip(loads, other_loads, strict=True))
    return pinion, wheel


def _mean_load(supports: SupportCompliance, carried: CycleSolution, *, whole: bool = False) -> Loads:
    """Mean over the positions; of a ``whole`` pitch its end is the beginning of the next one."""
    pinion, wheel = loads_at(supports, carried.contacts[0])
    own = slice(None, -1 if whole else None)
    return np.nanmean(pinion[own], axis=0), np.nanmean(wheel[own], axis=0)


@contextmanager
def _told_of(standing: Standing) -> Iterator[None]:
    """Say of errors of gears on supports that these move them under their torque."""
    if standing.loads is None:
        yield
        return
    try:
        with named("supports"):
            yield
    except GeometryError as error:
        raise moved_too_far(error, float(standing.torques[0])) from None


def _told(steps: Steps[Result], standing: Standing) -> Steps[Result]:
    """Steps whose errors say so."""
    with _told_of(standing):
        return (yield from steps)


def _standing_cycle(standing: Standing, carried: CycleSolution) -> StandingCycle:
    """What the tooth pairs carry, with the loads of the supports, and the tangents without what these give way."""
    if standing.supports is None:
        return StandingCycle(standing, carried, (), carried.torque_rate)
    numbers, teeth = carried.pairs.tolist(), standing.teeth
    states = [
        [
            on_rigid_supports(number, loaded, teeth)
            for number, loaded in zip(numbers, at, strict=True)
            if loaded is not None
        ]
        for at in carried.contacts[0]
    ]
    rate = np.where(np.isnan(carried.rotation), math.nan, loaded_states(states, teeth).stiffness)
    return StandingCycle(standing, carried, loads_at(standing.supports, carried.contacts[0]), rate)


def on_rigid_supports(number: int, loaded: LoadedContact, teeth: BendingModel | None) -> LoadedGrid:
    """What the tangent needs of a loaded contact whose supports do not give way."""
    grid = LoadedGrid.of(number, loaded)
    bent = None if teeth is None else teeth.within(number, loaded.separation)
    slices = loaded.ends if bent is None else bent if loaded.ends is None else bent + loaded.ends
    return replace(grid, problem=replace(grid.problem, slice_compliance=slices), bending=bent)


def all_torques(unloaded: MeshPath | ContactPath, cycles: Sequence[StandingCycle]) -> CycleSolution:
    """What the tooth pairs carry under all torques, under each in the pair as it stands.

    Parameters
    ----------
    unloaded : MeshPath or ContactPath
        Contact of the pair as it stands without load, of all tooth pairs or of one.
    cycles : sequence of StandingCycle
        In the order of the torques.

    Returns
    -------
    CycleSolution
        Its paths are those of the unloaded pair, and of the moved one where a tooth pair comes into reach by load only;
        its rotation is that from the unloaded pair on, motions of the gears included.
    """
    paths = {int(k): path for cycle in cycles for k, path in zip(cycle.carried.pairs, cycle.carried.paths, strict=True)}
    numbers = np.array(sorted(paths))
    if isinstance(unloaded, MeshPath):
        path, at_rest = in_gear_angles(unloaded)
        paths |= at_rest
    else:
        path = paths[0] = unloaded
    torque = np.concatenate([cycle.carried.torque for cycle in cycles])
    shape = len(torque), len(path), len(numbers)
    contacts: Contacts = [[[None] * shape[2] for _ in range(shape[1])] for _ in torque]
    share, deflection = np.zeros((2, *shape))
    rotation, first = np.empty(shape[:2]), 0
    for cycle in cycles:
        carried = cycle.carried
        columns, rows = np.searchsorted(numbers, carried.pairs), slice(first, first + len(carried.torque))
        share[rows][..., columns], deflection[rows][..., columns] = carried.share, carried.tooth_deflection
        moved = path.transmission_error - carried.path.transmission_error
        rotation[rows] = carried.rotation + cycle.standing.pair.driving * moved
        for t, positions in enumerate(carried.contacts):
            for n, at in enumerate(positions):
                for column, loaded in zip(columns.tolist(), at, strict=True):
                    contacts[first + t][n][column] = loaded
        first = rows.stop
    states = [cycle.carried.states for cycle in cycles]
    return CycleSolution(
        path=path,
        torque=torque,
        pairs=numbers,
        paths=tuple(paths[number] for number in numbers.tolist()),
        contacts=contacts,
        rotation=rotation,
        states=LoadedStates(
            tuple(grids for of_cycle in states for grids in of_cycle.grids),
            None,
            tuple(by_rotation for of_cycle in states for by_rotation in of_cycle.by_rotation),
            np.concatenate([of_cycle.stiffness for of_cycle in states]),
        ),
        share=share,
        tooth_deflection=deflection,
    )
