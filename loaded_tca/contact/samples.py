"""What samples at uneven places tell of the function between them: its top, and where its slope jumps."""

from __future__ import annotations

import math

import numpy as np

from loaded_tca.arrays import Array


def top(places: Array, values: Array, k: int) -> tuple[float, float]:
    """Top of the parabola through the squares of three pressures: its place, and its root over the middle one."""
    if not 0 < k < values.size - 1:
        return float(places[k]), 1.0
    s, square = places[k - 1 : k + 2] - places[k], (values[k - 1 : k + 2] / values[k]) ** 2
    before, after = (square[0] - 1.0) / s[0], (square[2] - 1.0) / s[2]
    bend = (after - before) / (s[2] - s[0])
    slope = before - bend * s[0]
    if bend >= 0.0:
        return float(places[k]), 1.0
    return float(places[k] - 0.5 * slope / bend), math.sqrt(1.0 - 0.25 * slope**2 / bend)


def slope_jump(places: Array, heights: Array, k: int) -> float:
    """Jump of a slope upwards within two samples of the k-th, zero without one.

    Where the curvature alone jumps, as where an arc begins, two samples together bend no more than the sharper bend
    beside them; where the slope jumps they do.
    """
    near = slice(max(0, k - 4), k + 5)
    finite = np.isfinite(heights[near])
    y, h = places[near][finite], heights[near][finite]
    if y.size < 6:
        return 0.0
    turns, widths = np.diff(np.diff(h) / np.diff(y)), 0.5 * (y[2:] - y[:-2])
    bends = turns / widths
    jumps = turns[1:-2] + turns[2:-1] - np.maximum(bends[:-3], bends[3:]) * (widths[1:-2] + widths[2:-1])
    return max(0.0, float(jumps.max()))
