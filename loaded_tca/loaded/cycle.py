"""Load of the tooth pairs over the positions of a pitch: one carries the torque, or all pairs in contact share it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from itertools import islice
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arrays import Array
from loaded_tca.compliance.model import BendingModel
from loaded_tca.errors import ConvergenceError, named
from loaded_tca.loaded.load_sharing import load_sharing_steps
from loaded_tca.loaded.loaded_contact import LoadedContact
from loaded_tca.loaded.loaded_grid import LoadedGrid
from loaded_tca.loaded.sensitivity import LoadedStates, loaded_states
from loaded_tca.loaded.together import Steps, run_stacked, with_gears
from loaded_tca.loaded.tooth_contact import Coupling, GridChoice, contact_under_load
from loaded_tca.loaded.tooth_pairs import SharedLoad, ToothPair, tooth_pairs_at
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.plain import plain
from loaded_tca.unloaded import ContactPath, MeshPath
from loaded_tca.unloaded.curvature import relative_curvatures

Progress = Callable[[int, int], None]
"""Called with what is done and what there is to do, in torques times positions."""
Contacts = list[list[list[LoadedContact | None]]]
"""By torque, position and tooth pair; None where a pair carries nothing."""


@dataclass(frozen=True, eq=False)
class CycleSolution:
    """What the tooth pairs carry.

    Attributes
    ----------
    path : ContactPath
        Unloaded contact of the mesh, n positions in the angles of the gears.
    torque : (m,) array [N mm]
    pairs : (pairs,) int array
        Those that carry load at some position, and 0.
    paths : tuple of ContactPath
        Unloaded contact of each pair, in the angles of the gears.
    contacts : nested list of LoadedContact or None
        By torque, position and pair.
    rotation : (m, n) array [rad]
        Of the wheel back by the load; NaN where nothing is in contact.
    states : LoadedStates
        Torque by torque all positions, with the cells in contact as they are.
    share : (m, n, pairs) array
        In the torque.
    tooth_deflection : (m, n, pairs) array [mm]
        Bending of the teeth, on top of the contact deformation.
    """

    path: ContactPath
    torque: Array
    pairs: NDArray[np.int_]
    paths: tuple[ContactPath, ...]
    contacts: Contacts
    rotation: Array
    states: LoadedStates
    share: Array
    tooth_deflection: Array

    @property
    def torque_rate(self) -> Array:
        """Tangent (m, n) of the torque over the rotation [N mm/rad]; zero without load, NaN where nothing touches."""
        return np.where(np.isnan(self.rotation), math.nan, self.states.stiffness.reshape(self.rotation.shape))


class MeshStates(Protocol):
    """Positions of a pitch of one pair of gears under torques, to be solved beside those of other ones."""

    @property
    def pair(self) -> GearPair:
        """The gears."""

    def steps(self) -> list[Steps[Any]]:
        """Steps of every state, torque by torque."""

    def carried(self, results: Sequence[Any]) -> CycleSolution:
        """What the tooth pairs carry by the results of the steps."""


def solve_cycles(cycles: Sequence[MeshStates], progress: Progress | None = None) -> list[CycleSolution]:
    """What the tooth pairs carry in several pairs of gears, whose states are worked on together."""
    alone = len(cycles) == 1
    steps = [cycle.steps() for cycle in cycles]
    every = [
        own if alone else with_gears(cycle.pair, own)
        for cycle, of_cycle in zip(cycles, steps, strict=True)
        for own in of_cycle
    ]
    report = None if progress is None else lambda done: progress(done, len(every))
    results = iter(run_stacked(cycles[0].pair, every, report))
    return [cycle.carried([*islice(results, len(own))]) for cycle, own in zip(cycles, steps, strict=True)]


@dataclass(frozen=True, eq=False)
class OnePairsCycle:
    """States of the tooth pair at the pitch point, which carries the whole load.

    Attributes
    ----------
    pair : GearPair
    path : ContactPath
        Its unloaded contact, :func:`loaded_tca.unloaded.trace_contact`.
    torques : (m,) array [N mm]
        Of the pinion.
    grid : GridChoice
    bending : BendingModel or None
        Of the teeth beneath the contact.
    displacement : callable or None
        Displacement of the slices of a grid that does not depend on the forces.
    """

    pair: GearPair
    path: ContactPath
    torques: Array
    grid: GridChoice
    bending: BendingModel | None = None
    displacement: Coupling | None = None

    def steps(self) -> list[Steps[LoadedContact | None]]:
        """Steps of every state, torque by torque."""
        return [self._steps(t, n) for t, n in np.ndindex(len(self.torques), len(self.path))]

    def _steps(self, t: int, n: int) -> Steps[LoadedContact | None]:
        contact = self.path[n]
        if not contact.in_contact:
            return None
        with told_where(self.torques[t], contact.pinion_angle):
            load = self.torques[t] / contact.pinion_lever
            return (
                yield from contact_under_load(
                    self.pair, contact, load, self.grid, self.bending, coupling=self.displacement
                )
            )

    def carried(self, results: Sequence[LoadedContact | None]) -> CycleSolution:
        """What the tooth pair carries by the results of the steps."""
        shape = len(self.torques), len(self.path)
        contacts: Contacts = [[[None] for _ in range(shape[1])] for _ in range(shape[0])]
        rotation, deflection = np.full((2, *shape), math.nan)
        for (t, n), loaded in zip(np.ndindex(shape), results, strict=True):
            contacts[t][n][0] = loaded
            if loaded is not None:
                deflection[t, n] = loaded.own_tooth_deflection
                if loaded.coupling_deflection is not None and loaded.solution.load > 0.0:
                    deflection[t, n] += loaded.slice_shares @ loaded.coupling_deflection
                rotation[t, n] = loaded.solution.approach / loaded.contact.wheel_lever
        share = np.broadcast_to(np.where(self.path.in_contact, 1.0, math.nan)[:, None], (*shape, 1)).copy()
        number = np.zeros(1, dtype=int)
        states = _loaded_states(number, contacts, self.bending)
        paths, deflections = (self.path,), deflection[..., None]
        return CycleSolution(self.path, self.torques, number, paths, contacts, rotation, states, share, deflections)


@dataclass(frozen=True, eq=False)
class AllPairsCycle:
    """States of all tooth pairs in contact, which share the load.

    Attributes
    ----------
    mesh : MeshPath
        Unloaded contact of all teeth, :func:`loaded_tca.unloaded.trace_teeth`.
    pair, torques, grid, bending, displacement
        As of :class:`OnePairsCycle`.
    """

    pair: GearPair
    mesh: MeshPath
    torques: Array
    grid: GridChoice
    bending: BendingModel | None = None
    displacement: Coupling | None = None

    def steps(self) -> list[Steps[SharedLoad]]:
        """Steps of every state, torque by torque."""
        angles, tooth_pairs = self.mesh.pinion_angle, [tooth_pairs_at(self.mesh, n) for n in range(len(self.mesh))]
        positions = list(zip(angles.tolist(), tooth_pairs, strict=True))
        return steps_of_shared(self.pair, positions, self.torques, self.grid, self.bending, self.displacement)

    def carried(self, results: Sequence[SharedLoad]) -> CycleSolution:
        """What the tooth pairs carry by the results of the steps."""
        mesh, torques, shape = self.mesh, self.torques, (len(self.torques), len(self.mesh))
        carrying = {0} | {share.tooth_pair.pair for shared in results for share in shared.shares}
        columns = [column for column, number in enumerate(mesh.pairs.tolist()) if number in carrying]
        pairs = mesh.pairs[columns].tolist()
        contacts: Contacts = [[[None] * len(pairs) for _ in range(shape[1])] for _ in torques]
        share, deflection = np.zeros((2, *shape, len(pairs)))
        for (t, n), shared in zip(np.ndindex(shape), results, strict=True):
            for part in shared.shares:
                place = t, n, pairs.index(part.tooth_pair.pair)
                contacts[t][n][place[2]], deflection[place] = part.loaded, part.tooth_deflection
                share[place] = part.torque / torques[t] if shared.torque > 0.0 else 1.0
        leading, paths = in_gear_angles(mesh)
        return CycleSolution(
            path=leading,
            torque=torques,
            pairs=mesh.pairs[columns],
            paths=tuple(paths[number] for number in pairs),
            contacts=contacts,
            rotation=np.array([shared.rotation for shared in results]).reshape(shape),
            states=_loaded_states(mesh.pairs[columns], contacts, self.bending),
            share=share,
            tooth_deflection=deflection,
        )


def share_loads(
    pair: GearPair,
    positions: Sequence[tuple[float, Sequence[ToothPair]]],
    torques: Array,
    grid: GridChoice,
    bending: BendingModel | None = None,
    progress: Progress | None = None,
    displacement: Coupling | None = None,
) -> dict[tuple[int, int], SharedLoad]:
    """Share every torque over the tooth pairs of every position.

    Parameters
    ----------
    positions : sequence of (float, sequence of ToothPair)
        Pinion angle [rad], and all pairs that may come into contact there.
    pair, torques, grid, bending, displacement
        As of :class:`OnePairsCycle`.
    progress : callable, optional

    Returns
    -------
    dict
        By the indices of torque and position, torque by torque.
    """
    shape = len(torques), len(positions)
    steps = steps_of_shared(pair, positions, torques, grid, bending, displacement)
    report = None if progress is None else lambda done: progress(done, len(steps))
    return dict(zip(np.ndindex(shape), run_stacked(pair, steps, report), strict=True))


def steps_of_shared(
    pair: GearPair,
    positions: Sequence[tuple[float, Sequence[ToothPair]]],
    torques: Array,
    grid: GridChoice,
    bending: BendingModel | None = None,
    displacement: Coupling | None = None,
) -> list[Steps[SharedLoad]]:
    """Steps of every torque at every position, torque by torque; arguments as of :func:`share_loads`."""
    contacts = [tooth_pair.contact for _, all_at in positions for tooth_pair in all_at if tooth_pair.gears is None]
    relative_curvatures(pair, contacts)  # kept for all torques

    def steps(t: int, n: int) -> Steps[SharedLoad]:
        angle, tooth_pairs = positions[n]
        with told_where(torques[t], angle):
            return (yield from load_sharing_steps(pair, tooth_pairs, float(torques[t]), grid, bending, displacement))

    return [steps(*state) for state in np.ndindex(len(torques), len(positions))]


def in_gear_angles(mesh: MeshPath) -> tuple[ContactPath, dict[int, ContactPath]]:
    """Unloaded contact of the leading tooth pairs, and of each pair by its number, in the angles of the gears."""
    angles, paths = mesh.pinion_angle, dict[int, ContactPath]()
    for number, path in zip(mesh.pairs.tolist(), mesh.paths, strict=True):
        turned = mesh.pair.ratio * (angles - path.pinion_angle)
        paths[number] = replace(path, pinion_angle=angles, wheel_angle=path.wheel_angle + turned)
    return replace(mesh.leading_contact, pinion_angle=angles, wheel_angle=mesh.wheel_angle), paths


def _loaded_states(pairs: NDArray[np.int_], contacts: Contacts, bending: BendingModel | None) -> LoadedStates:
    """Tooth pairs under load of all torques and positions, in the order that results have them in."""
    order = np.argsort(pairs).tolist()
    states = [
        [LoadedGrid.of(int(pairs[k]), loaded) for k in order if (loaded := at[k]) is not None]
        for positions in contacts
        for at in positions
    ]
    return loaded_states(states, bending)


@contextmanager
def told_where(torque: float, angle: float) -> Iterator[None]:
    """Say under which torque [N mm] and at which pinion angle [rad] something cannot be solved."""
    where = f"{plain(1e-3 * torque, 6)} N m at pinion angle {plain(math.degrees(angle), 6)} deg"
    try:
        with named(where):
            yield
    except ConvergenceError as error:
        raise ConvergenceError(f"{where}: {error}", error.last) from error
