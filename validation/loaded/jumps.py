"""Jumps of the loaded transmission error that come from grids, over random scenes of all families.

A mesh cycle of an elastic pair is continuous, and smooth but where a pair comes into contact or an edge is reached. What a
computed curve has beyond that are jumps of its grids. The jump of a step between two positions is the smaller of its
two second differences where both have one sign, over the peak to peak: a jump sticks out on both sides, a smooth curve
has less the finer its positions, so that steps which stick out are halved in position by position and judged again.
"""

import sys
import time
import warnings

import numpy as np

from loaded_tca import AccuracyWarning, analyse
from loaded_tca.scene import Scene
from validation.random_scenes import random_scene

CASE, SOURCE = "jumps of the loaded transmission error", "a mesh cycle is continuous"
SCENES, POSITIONS = 40, 65
LARGEST = 0.015
"""Of the peak to peak."""


def jumps(error: np.ndarray) -> np.ndarray:
    """Jump of every inner step of a curve over positions, over its peak to peak; zero where its ends do not stick out."""
    steps = np.diff(error)
    before, after = steps[1:-1] - steps[:-2], steps[1:-1] - steps[2:]
    return np.where(before * after > 0.0, np.minimum(abs(before), abs(after)), 0.0) / np.ptp(error)


def transmission_error(scene: Scene) -> np.ndarray:
    """Loaded transmission error over the positions [rad]."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        return np.asarray(analyse(scene).transmission_error[0])


def main() -> None:
    first, last = map(int, sys.argv[1:3])
    for seed in range(first, last):
        scene = random_scene(seed, positions=POSITIONS)
        start = time.process_time()
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", AccuracyWarning)
                result = analyse(scene)
        except Exception as error:
            print(seed, repr(error)[:150], flush=True)
            continue
        te = np.asarray(result.transmission_error[0])
        j = jumps(te)
        rms = np.sort(j)[::-1][:3]
        one = result.dataset
        print(
            seed,
            scene.geometry.__class__.__name__[:5],
            f"pp {1e3 * result.dataset.wheel_base_radius.item() * np.ptp(te):.3f} um jumps",
            np.round(rms, 4),
            "at",
            int(j.argmax()) + 1,
            f"cells {int(np.nanmax(one.cells_across))} {int(np.nanmax(one.cells_along))} {time.process_time() - start:.1f} s",
            flush=True,
        )


if __name__ == "__main__":
    main()
