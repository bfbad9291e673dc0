"""Jumps of the loaded transmission error that come from grids, over random scenes of all families.

The curve of an elastic pair is continuous, and smooth but where a pair comes into contact or an edge is reached. What a
computed curve has beyond that are jumps of its grids. The jump of a step between two positions is the smaller of its
two second differences where both have one sign, over the peak to peak of the curve: a jump sticks out on both sides.
Steps in which a pair comes into contact or leaves it are left out. A steep stretch sticks out as well; it does so less
with finer positions, a jump does not: scenes with jumps above the bound are judged by twice as many positions, and once
more (scene 27, whose contact point takes half a position to pass a corner of both flanks, with a lever that changes by
0.17 % there).
"""

import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from loaded_tca import AccuracyWarning, MeshCycle, analyse
from validation.random_scenes import random_scene
from validation.table import Row

CASE, SOURCE = "jumps of the loaded transmission error", "the curve of an elastic pair is continuous"
SEEDS, ALL_SEEDS, POSITIONS = (*range(9), 27), range(40), (65, 129, 257)
"""Seeds of the table are those of each family in turn, and the one whose contact point passes a corner."""
LARGEST = 0.015
"""Jump over the peak to peak that is allowed."""


def rows() -> list[Row]:
    """Largest jump of a scene of each family."""
    return [_row(seed) for seed in SEEDS]


def whole_rows() -> list[Row]:
    """Largest jump of every scene."""
    return [_row(seed) for seed in ALL_SEEDS]


def _row(seed: int) -> Row:
    for positions in POSITIONS:
        jump = largest_jump(seed, positions)
        if jump <= LARGEST:
            break
    scene = random_scene(seed)
    name = f"scene {seed} ({scene.geometry.type}): largest jump over the peak to peak, {positions} positions"
    return Row(CASE, SOURCE, name, 0.0, jump, LARGEST)


def largest_jump(seed: int, positions: int, **analysis: Any) -> float:
    """Largest jump of a random scene over its peak to peak."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        return float(jumps(analyse(random_scene(seed, positions=positions, **analysis))).max())


def jumps(result: MeshCycle) -> NDArray[np.float64]:
    """Jump of every inner step of the curve of the first torque, over its peak to peak."""
    error, loaded = np.asarray(result.transmission_error[0]), np.asarray(result.load_share[0]) > 0.0
    steps = np.diff(error)
    before, after = steps[1:-1] - steps[:-2], steps[1:-1] - steps[2:]
    found = np.where(before * after > 0.0, np.minimum(np.abs(before), np.abs(after)), 0.0) / np.ptp(error)
    same_pairs = (loaded[1:] == loaded[:-1]).all(axis=1)[1:-1]
    return np.asarray(np.where(same_pairs, found, 0.0))
