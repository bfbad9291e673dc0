r"""Gears on shafts and bearings that give way: the geometry moved by what the mean load moves, the rest coupled.

Under each torque the loads W of both gears, the means over a pitch, move them by q(W) = C W + q0. The pair is moved
by that motion as rigid bodies, its unloaded contact is traced anew, and the mesh cycle is solved with the compliance C
of the supports and a given displacement of every slice,

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
    Carried,
    Contacts,
    OnePairsCycle,
    Progress,
    carried_together,
    in_gear_angles,
)
from loaded_tca.loaded.loaded_contact import LoadedContact
from loaded_tca.loaded.loaded_grid import LoadedGrid
from loaded_tca.loaded.moved_gears import (
    Loads,
    at_rest,
    loads_at,
    loads_at_first_contact,
    moved_bending,
    moved_too_far,
    no_loads,
)
from loaded_tca.loaded.sensitivity import LoadedStates, loaded_states
from loaded_tca.loaded.together import Result, Steps
from loaded_tca.loaded.tooth_contact import GridChoice
from loaded_tca.pairs.gear_pair import GearPair
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
MOST_STEPS = 12
"""Steps before giving up; two to four are the rule."""


class OnSupports(Protocol):
    """Gears at positions under one torque on supports that give way, as :class:`CarriedOnSupports` has them."""

    @property
    def bending(self) -> SumOfParts:
        """Of the moved pair, supports included."""

    @property
    def held(self) -> Loads:
        """Loads of pinion and wheel whose motions the pair is moved by."""

    @property
    def loads(self) -> Loads:
        """Those at the positions, (n, 6 m) each."""

    @property
    def drive_rate(self) -> Array:
        """Tangent of the torque over the rotation (n,) with the supports [N mm/rad]."""


@dataclass(frozen=True, eq=False)
class CarriedOnSupports:
    """What the tooth pairs carry under one torque, on supports that give way.

    Attributes
    ----------
    pair : GearPair
        Moved by the mean load.
    bending : SumOfParts
        Of that pair, supports included.
    carried : Carried
        Under the one torque, from the moved pair on.
    held : tuple of (6 m,) arrays
        Loads of pinion and wheel whose motions the pair is moved by.
    loads : tuple of (n, 6 m) arrays
        Of pinion and wheel at the positions; NaN where nothing is in contact.
    mesh_rate : (n,) array [N mm/rad]
        Tangent of the torque over the rotation with supports held.
    """

    pair: GearPair
    bending: SumOfParts
    carried: Carried
    held: Loads
    loads: tuple[Array, Array]
    mesh_rate: Array

    @property
    def pitches_apart(self) -> int:
        """How many pitches two tooth pairs that carry load at a position are apart at the most."""
        return widest_apart(self.carried.pairs, self.carried.share[0])

    @property
    def drive_rate(self) -> Array:
        """Tangent of the torque over the rotation (n,) with the supports [N mm/rad]."""
        return np.asarray(self.carried.torque_rate[0])


@dataclass(frozen=True, eq=False)
class _MovedCycle:
    """States of the pair moved by loads of its supports under one torque [N mm], and its bending with them."""

    torque: float
    held: Loads
    bending: SumOfParts
    states: OnePairsCycle | AllPairsCycle

    @property
    def pair(self) -> GearPair:
        return self.states.pair

    @property
    def supports(self) -> SupportCompliance:
        assert self.bending.supports is not None
        return self.bending.supports

    def steps(self) -> list[Steps[Any]]:
        return [_told(own, self.torque) for own in self.states.steps()]

    def carried(self, results: Sequence[Any]) -> Carried:
        carried = self.states.carried(results)
        return replace(carried, states=replace(carried.states, bending=self.bending))  # rigid supports included


class SupportedCycle:
    """Mesh cycles of a pair on supports.

    Parameters
    ----------
    pair : GearPair
        At rest.
    bending : SumOfParts
        With its supports.
    angles : (n,) array [rad]
        Of the pinion.
    grid : GridChoice
    load_sharing : bool
        Whether all tooth pairs in contact share the load.
    """

    def __init__(
        self, pair: GearPair, bending: SumOfParts, angles: Array, grid: GridChoice, *, load_sharing: bool
    ) -> None:
        assert bending.supports is not None
        self.pair, self.bending, self.supports = pair, bending, bending.supports
        self.angles, self.grid, self.load_sharing = angles, grid, load_sharing

    def under(self, torques: Sequence[float], progress: Progress | None = None) -> list[CarriedOnSupports]:
        """Mesh cycles under pinion torques [N mm], worked on together.

        Raises
        ------
        GeometryError
            If the flanks are not in contact any more where the supports let the gears move.
        ConvergenceError
            If the motions do not settle, or a contact is not solved.
        """
        held = self.settled(torques)
        cycles = [self._moved(*one, self.angles, self.grid) for one in zip(torques, held, strict=True)]
        carried = carried_together(cycles, progress)
        for _ in range(MOST_AGAIN if len(self.angles) > ENOUGH else 0):
            means = [_mean_load(*one, whole=True) for one in zip(cycles, carried, strict=True)]
            far = [t for t, one in enumerate(cycles) if torques[t] > 0.0 and not self._is_done(one, means[t])]
            again = [self._moved(torques[t], means[t], self.angles, self.grid) for t in far]
            for t, cycle, own in zip(far, again, carried_together(again) if far else (), strict=True):
                cycles[t], carried[t] = cycle, own
        return [
            CarriedOnSupports(
                one.pair,
                one.bending,
                own,
                one.held,
                loads_of(one.supports, own),
                _rate_on_rigid_supports(own, one.bending),
            )
            for one, own in zip(cycles, carried, strict=True)
        ]

    def settled(self, torques: Sequence[float]) -> list[Loads]:
        """Mean loads under pinion torques [N mm] whose motions of the geometry are those that follow from them.

        Loads are nearly in proportion to the torque: those between the smallest and the largest one follow from these,
        where a cycle of enough positions checks them.
        """
        loaded = sorted({torque for torque in torques if torque > 0.0})
        if not loaded:
            return [no_loads(self.supports) for _ in torques]
        if len(self.angles) <= ENOUGH:
            each = dict(zip(loaded, self._settled(loaded), strict=True))
            return [each.get(torque) or no_loads(self.supports) for torque in torques]
        low, high = loaded[0], loaded[-1]
        first, last = self._settled([low, high])

        def between(torque: float) -> Loads:
            part = (torque - low) / (high - low) if high > low else 1.0
            pinion, wheel = (
                torque * ((1.0 - part) / low * one + part / high * other)
                for one, other in zip(first, last, strict=True)
            )
            return pinion, wheel

        return [between(torque) if torque > 0.0 else no_loads(self.supports) for torque in torques]

    def _settled(self, torques: Sequence[float]) -> list[Loads]:
        """The same, torques by themselves: from where the flanks touch first without load."""
        count = min(POSITIONS, len(self.angles))
        spread = (np.arange(count) - 0.5 * (count - 1)) / count * self.pair.pitch if count > 1 else self.angles
        roughly = replace(self.grid, agreement=ROUGHLY, accuracy=max(self.grid.accuracy, ROUGH_PEAK))
        pinion, wheel = loads_at_first_contact(self.supports, at_rest(self.supports), 1.0)
        loads = {torque: (torque * pinion, torque * wheel) for torque in torques}
        left = [*loads]
        for step in range(MOST_STEPS):
            cycles = [self._moved(torque, loads[torque], spread, roughly) for torque in left]
            for cycle, carried in zip(cycles, carried_together(cycles), strict=True):
                mean = _mean_load(cycle, carried)
                if step >= SWINGING:
                    mean = _halfway(cycle.held, mean)
                loads[cycle.torque] = mean
                if self._are_near(cycle, mean):
                    left.remove(cycle.torque)
            if not left:
                return [loads[torque] for torque in torques]
        raise ConvergenceError(
            f"supports: motions under {1e-3 * left[0]:g} N m not settled in {MOST_STEPS} steps: the supports are too "
            "soft for these gears",
            last=loads[left[0]],
        )

    def _are_near(self, cycle: _MovedCycle, loads: Loads) -> bool:
        """Whether the motions by loads are those of a cycle, but for a small part of them."""
        part = SETTLED if cycle.supports.is_linear else NEARER
        whole = self._distance(cycle.supports, loads, no_loads(self.supports))
        return self._distance(cycle.supports, loads, cycle.held) <= part * whole

    def _is_done(self, cycle: _MovedCycle, loads: Loads) -> bool:
        """Whether the mean load of a whole cycle moves the gears no further than where they stand in it."""
        further = self._distance(cycle.supports, loads, cycle.held)
        return further <= CLOSE * self.pair.module and (cycle.supports.is_linear or self._are_near(cycle, loads))

    def _distance(self, supports: SupportCompliance, one: Loads, other: Loads) -> float:
        """Largest way of the two gears between two loads, at a lever of half the face width [mm]."""
        lever = np.repeat([1.0, 0.5 * self.pair.face_width], 3)
        ways = [
            support.at_middle(support.compliance @ (a - b)) * lever
            for support, a, b in zip(supports.supports, one, other, strict=True)
        ]
        return float(np.abs(ways).max())

    def _moved(self, torque: float, loads: Loads, angles: Array, grid: GridChoice) -> _MovedCycle:
        """States of the pair moved by loads, with supports that are linear there."""
        bending, given = moved_bending(self.bending, self.supports.under(loads), loads)
        assert bending.supports is not None
        pair, torques = bending.supports.pair, np.array([torque])
        states: OnePairsCycle | AllPairsCycle
        with _told_of(torque):
            if self.load_sharing:
                states = AllPairsCycle(pair, trace_teeth(pair, angles), torques, grid, bending.giving_way, given)
            else:
                states = OnePairsCycle(pair, trace_contact(pair, angles), torques, grid, bending.giving_way, given)
        return _MovedCycle(torque, loads, bending, states)


def widest_apart(pairs: Indices, shares: Array) -> int:
    """How many pitches two tooth pairs (k,) with shares (n, k) above 0 at the same position are apart at the most."""
    return max((int(np.ptp(pairs[row > 0.0])) for row in shares if (row > 0.0).any()), default=0)


def _halfway(one: Loads, other: Loads) -> Loads:
    pinion, wheel = (0.5 * (a + b) for a, b in zip(one, other, strict=True))
    return pinion, wheel


def _mean_load(cycle: _MovedCycle, carried: Carried, *, whole: bool = False) -> Loads:
    """Mean over the positions; of a ``whole`` pitch its end is the beginning of the next one."""
    pinion, wheel = loads_of(cycle.supports, carried)
    own = slice(None, -1 if whole else None)
    return np.nanmean(pinion[own], axis=0), np.nanmean(wheel[own], axis=0)


@contextmanager
def _told_of(torque: float) -> Iterator[None]:
    """Say of errors that the supports move the gears under a torque [N mm]."""
    try:
        with named("supports"):
            yield
    except GeometryError as error:
        raise moved_too_far(error, torque) from None


def _told(steps: Steps[Result], torque: float) -> Steps[Result]:
    """Steps whose errors say so."""
    with _told_of(torque):
        return (yield from steps)


def loads_of(supports: SupportCompliance, carried: Carried) -> tuple[Array, Array]:
    """Loads (n, 6 m) of pinion and wheel at the positions under the one torque; NaN where nothing is in contact."""
    return loads_at(supports, carried.contacts[0])


def _rate_on_rigid_supports(carried: Carried, bending: SumOfParts) -> Array:
    """Tangent (n,) of the torque over the rotation, the supports held [N mm/rad]."""
    teeth = bending.on_rigid_supports
    numbers = carried.pairs.tolist()
    states = [
        [on_rigid_supports(number, one, teeth) for number, one in zip(numbers, at, strict=True) if one is not None]
        for at in carried.contacts[0]
    ]
    stiffness = loaded_states(states, teeth).stiffness
    return np.where(np.isnan(carried.rotation[0]), math.nan, stiffness)


def on_rigid_supports(number: int, loaded: LoadedContact, teeth: BendingModel | None) -> LoadedGrid:
    """What the tangent needs of a loaded contact whose supports do not give way."""
    one = LoadedGrid.of(number, loaded)
    bent = None if teeth is None else teeth.within(number, loaded.separation)
    slices = loaded.ends if bent is None else bent if loaded.ends is None else bent + loaded.ends
    return replace(one, problem=replace(one.problem, slice_compliance=slices), bending=bent)


def all_torques(unloaded: MeshPath | ContactPath, cycles: Sequence[CarriedOnSupports]) -> Carried:
    """What the tooth pairs carry under all torques, each in its own pair.

    Parameters
    ----------
    unloaded : MeshPath or ContactPath
        Contact of the pair as it stands without load, of all tooth pairs or of one.
    cycles : sequence of CarriedOnSupports
        By torque.

    Returns
    -------
    Carried
        Its paths are those of the unloaded pair, and of the moved one where a tooth pair comes into reach by load only;
        its rotation is that from the unloaded pair on, motions of the gears included.
    """
    paths = {int(k): path for one in cycles for k, path in zip(one.carried.pairs, one.carried.paths, strict=True)}
    numbers = np.array(sorted(paths))
    if isinstance(unloaded, MeshPath):
        path, at_rest = in_gear_angles(unloaded)
        paths |= at_rest
    else:
        path = paths[0] = unloaded
    driving = cycles[0].pair.driving
    shape = len(cycles), len(path), len(numbers)
    contacts: Contacts = [[[None] * shape[2] for _ in range(shape[1])] for _ in cycles]
    share, deflection = np.zeros((2, *shape))
    rotation = np.empty(shape[:2])
    for t, one in enumerate(cycles):
        carried = one.carried
        columns = np.searchsorted(numbers, carried.pairs)
        share[t][:, columns], deflection[t][:, columns] = carried.share[0], carried.tooth_deflection[0]
        moved = path.transmission_error - carried.path.transmission_error
        rotation[t] = carried.rotation[0] + driving * moved
        for n, at in enumerate(carried.contacts[0]):
            for column, loaded in zip(columns.tolist(), at, strict=True):
                contacts[t][n][column] = loaded
    states = [one.carried.states for one in cycles]
    return Carried(
        path=path,
        torque=np.concatenate([one.carried.torque for one in cycles]),
        pairs=numbers,
        paths=tuple(paths[number] for number in numbers.tolist()),
        contacts=contacts,
        rotation=rotation,
        states=LoadedStates(
            tuple(grids for one in states for grids in one.grids),
            None,
            tuple(by_rotation for one in states for by_rotation in one.by_rotation),
            np.concatenate([one.stiffness for one in states]),
        ),
        share=share,
        tooth_deflection=deflection,
    )
