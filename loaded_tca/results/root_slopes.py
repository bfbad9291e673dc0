"""Derivatives of the largest root stresses by the forces of the cells, and by the motion of their lines."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.compliance import FlankLine, flank_lines, root_stress_model
from loaded_tca.loaded.sensitivity import LoadedGrid, Tangents
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.gap_growth import moved
from loaded_tca.results.root_stress import stress_at_extreme
from loaded_tca.separation.pair_change import PairChange

STEP = 1e-2
"""By which a line of forces is shifted to see how the root stress changes, over the width of its grid."""


def root_slopes(
    pair: GearPair,
    gear: int,
    tangents: Tangents,
    places: Sequence[Sequence[int]],
    changes: Sequence[PairChange | None],
    motions: Array,
) -> tuple[list[Array], Array]:
    """Derivatives of the stress about the extremes of a gear, which lie at a place in each state.

    It follows the forces, and the lines along which they load the teeth.

    Parameters
    ----------
    pair : GearPair
    gear : int
        0: pinion, 1: wheel.
    tangents : Tangents
        Of all states.
    places : sequence of sequences of int
        Of the extreme in each state.
    changes : sequence of PairChange or None
        None of keys that change no gears.
    motions : (keys, grids, 6) array
        Of the grids.

    Returns
    -------
    by_force : list of (nx, ny) arrays [MPa/N]
        On each grid.
    moved_lines : (keys, states) array [MPa per unit]
        Growth by the motion of the lines, the forces held.
    """
    grids, model = tangents.grids, root_stress_model((pair.pinion, pair.wheel)[gear])
    by_force, moved_lines = [], np.zeros((len(changes), len(places)))
    in_states = np.split(np.arange(len(grids)), np.flatnonzero(np.diff(tangents.state)) + 1)
    for state, (numbers, place) in enumerate(zip(in_states, places, strict=True)):
        loads, per_force = stress_at_extreme(pair, gear, model, [grids[i] for i in numbers], place)
        for i, (line, forces) in zip(numbers, loads, strict=True):
            grid, stress = grids[i].separation, per_force(line)
            step = STEP * grid.spacing[0] * len(grid.x)
            shifted = replace(grid, force_line=grid.force_line + step)
            across = (per_force(flank_lines(pair, grids[i].number, shifted)[gear]) - stress) / step
            by_force.append(stress + across * (grid.x[:, None] - grid.force_line))
            for key, change in enumerate(changes):
                if change is not None:
                    growth = _by_moved_line(gear, change, grids[i], motions[key, i], per_force, across)
                    moved_lines[key, state] += growth @ forces
    return by_force, moved_lines


def _by_moved_line(
    gear: int,
    change: PairChange,
    grid: LoadedGrid,
    motion: Array,
    per_force: Callable[[FlankLine], Array],
    across: Array,
) -> Array:
    """Growth of the stress per force of the slices (ny,) [MPa/N per unit], as the line of a grid moves.

    ``across``: that by its shift along x.
    """
    if change.of_modifications:
        return across * motion[0]
    low, high = (
        per_force(flank_lines(side, grid.number, moved(grid.separation, part * change.difference * motion))[gear])
        for side, part in ((change.below, -0.5), (change.above, 0.5))
    )
    return np.asarray((high - low) / change.difference)
