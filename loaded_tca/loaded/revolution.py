"""What the tooth pairs carry over a whole revolution, some pitches at a time: no contact is kept beyond its turn."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

from loaded_tca.arrays import Array
from loaded_tca.loaded.cycle import Progress, share_loads
from loaded_tca.loaded.loaded_grid import LoadedGrid
from loaded_tca.loaded.sensitivity import loaded_states
from loaded_tca.loaded.standing import Standing, on_rigid_supports
from loaded_tca.loaded.tooth_contact import GridChoice
from loaded_tca.loaded.tooth_pairs import SharedLoad, ToothPair
from loaded_tca.unloaded.revolution import RevolutionPath

STATES_AT_A_TIME = 128
"""Positions times torques that are solved together: stacks are full, and memory does not grow with the revolution."""


@dataclass(frozen=True, eq=False)
class RevolutionPart:
    """What the tooth pairs carry at some positions.

    Attributes
    ----------
    positions : range
        Of the revolution.
    shared : dict of SharedLoad
        By the indices of torque and position, that counted from the first one of the part.
    stiffness : (torques, positions) array [N mm/rad]
        Tangent of the pinion torque over the rotation of the wheel, supports held.
    drive_stiffness : (torques, positions) array [N mm/rad]
        The same with what the supports give way.
    """

    positions: range
    shared: dict[tuple[int, int], SharedLoad]
    stiffness: Array
    drive_stiffness: Array


def solve_revolution(
    path: RevolutionPath, standing: Standing, grid: GridChoice, progress: Progress | None = None
) -> Iterator[RevolutionPart]:
    """Let all tooth pairs in contact share the load, position by position of a revolution.

    Parameters
    ----------
    path : RevolutionPath
        Of the gears as they stand.
    standing : Standing
    grid : GridChoice
    progress : callable, optional
        Called with the states that are done, and how many there are.

    Yields
    ------
    RevolutionPart
    """
    torques, bending = standing.torques, standing.giving_way
    count, whole = max(1, STATES_AT_A_TIME // len(torques)), len(path) * len(torques)
    for first in range(0, len(path), count):
        positions = range(first, min(first + count, len(path)))
        report = None if progress is None else partial(_report, progress, first * len(torques), whole)
        at = [(float(path.pinion_angle[n]), tooth_pairs_of(path, n)) for n in positions]
        shared = share_loads(path.pair, at, torques, grid, bending, report, standing.displacement)
        loaded = [[(share.tooth_pair.pair, share.loaded) for share in of_state.shares] for of_state in shared.values()]
        on_rigid = states = [[LoadedGrid.of(number, contact) for number, contact in at] for at in loaded]
        if standing.supports is not None:
            teeth = standing.teeth
            on_rigid = [[on_rigid_supports(number, contact, teeth) for number, contact in at] for at in loaded]
        shape = len(torques), len(positions)
        drive = loaded_states(states, bending).stiffness.reshape(shape)
        stiffness = drive if on_rigid is states else loaded_states(on_rigid, standing.teeth).stiffness.reshape(shape)
        yield RevolutionPart(positions, shared, stiffness, drive)


def _report(progress: Progress, before: int, whole: int, done: int, _: int) -> None:
    progress(before + done, whole)


def tooth_pairs_of(path: RevolutionPath, position: int) -> tuple[ToothPair, ...]:
    """Tooth pairs that can be in contact at a position of a revolution."""
    return tuple(ToothPair(*parts) for parts in path.pairs_at(position))
