r"""Jumps of the slope of a gap inside a contact, where the pressure has no limit.

Beside a line across which the slope of the gap grows by :math:`\Delta` the pressure is

.. math:: p = \frac{E^* \Delta}{2 \pi} \ln\frac{1}{\lvert x \rvert} + \ldots

(Johnson 1985, Contact Mechanics, section 5.2: a wedge), so that the cells there gain
:math:`E^* \Delta \ln 2/(2 \pi)` with every halving, whatever the load is. The gap on one grid tells it: with
:math:`D_k` for its second difference over k cells, :math:`4 D_k - D_{2k}` is zero where the gap is a quadratic; beside
a jump its sum over two neighbours is :math:`\Delta` times a number, wherever between the cells the jump lies and
however fine they are. Where only the curvature jumps it falls with the cell, and is as large with the other sign beside
it. A slope that changes over two or three cells is a jump on their grid, and none on a finer one.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arrays import Array, Mask
from loaded_tca.contact.levels import window_around

WIDE = 4
"""Cells of the second differences that a jump is told by, beside single ones."""
SUMS = {1: 1.0, WIDE: 13.0}
"""Sum of 4 D_k - D_2k over two neighbours at a slope that grows by one per cell."""
ALIKE = 1.35
"""Jump as wide differences tell it, over that of single cells, at the most. Measured: up to 1.09 at ridges and apexes
at all places between the cells; from 1.5 on where the gap grows with r^1.5, from 1.8 on where its curvature jumps."""
ONE_SIGN = 1.4
"""Peak of 4 D_1 - D_2, averaged over three cells, over its lowest value beside it: 2 at a slope that jumps up, 1 where
the curvature jumps, a half beside a slope that jumps down."""
BESIDE = 3 * WIDE + 1
"""Cells around a jump that tell it."""
FAR = 1e3
"""Gaps beside the contact over those in it, from which on they are alike."""


def growth(jump: float, contact_modulus: float) -> float:
    """What the cells beside a ridge gain whenever their width is halved [MPa].

    At the apex of a cone pi/2 times as much: its pressure is E* jump arcosh(a/r)/4 (Johnson 1985, section 5.2).
    """
    return contact_modulus * jump * math.log(2.0) / (2.0 * math.pi)


def largest_slope_jump(gap: Array, pressed: Mask, spacing: tuple[float, float], least: float) -> float:
    """Largest growth of the slope of a gap (nx, ny) across a line or a point inside a contact.

    Parameters
    ----------
    gap : (nx, ny) array [mm]
        Infinite where there is no material.
    pressed : (nx, ny) array of bool
        Cells in contact; a jump is told from two cells off its ends.
    spacing : (float, float) [mm]
    least : float
        Smaller ones do not count.

    Returns
    -------
    float
        Zero where no slope jumps.
    """
    jumps = [
        _along_first(gap, pressed, spacing[0], least),
        _along_first(gap.T, pressed.T, spacing[1], least),
    ]
    return math.hypot(*jumps)


def _along_first(gap: Array, pressed: Mask, width: float, least: float) -> float:
    """Largest jump of the slope along the first axis."""
    rows, columns = window_around(pressed)
    first, last = max(0, rows.start - BESIDE), min(len(gap), rows.stop + BESIDE)
    inside = pressed[first:last, columns]
    if len(inside) < 4:
        return 0.0
    heights = _continued(_cut(gap[first:last, columns], inside))
    bends = _bends(heights)
    sums = bends[:-1] + bends[1:]
    # The two cells of a sum, and one beyond each, in the contact.
    own = slice(BESIDE + 1, BESIDE + len(inside) - 2)
    there = inside[:-3] & inside[1:-2] & inside[2:-1] & inside[3:]
    row, column = np.nonzero(there & (sums[own] > least * width * SUMS[1]))
    if not row.size:
        return 0.0
    row += own.start
    around = row + np.arange(-WIDE, WIDE + 1)[:, None]
    wide = _wide_bends(heights, around, column) + _wide_bends(heights, around + 1, column)
    averaged = bends[around - 1, column] + 2.0 * bends[around, column] + bends[around + 1, column]
    jumps = sums[row, column] / (SUMS[1] * width)
    jumps_told_wide = wide.max(axis=0) / (SUMS[WIDE] * width)
    alike = (jumps_told_wide <= ALIKE * jumps) & (averaged.max(axis=0) >= -ONE_SIGN * averaged.min(axis=0))
    return float(jumps[alike].max(initial=0.0))


def _cut(gap: Array, pressed: Mask) -> Array:
    """Gap that ends far above the cells in contact, where nothing can tell of them, and where there is no material."""
    low, high = float(gap[pressed].min()), float(gap[pressed].max())
    return np.minimum(gap, high + FAR * (high - low))


def _continued(gap: Array) -> Array:
    """Gap with :data:`BESIDE` more cells before its first row and after its last one, as parabolas go on."""
    steps = np.arange(1, BESIDE + 1)[:, None]
    before, after = (
        edge[0] + steps * (edge[0] - edge[1]) + 0.5 * steps * (steps + 1) * (edge[0] - 2.0 * edge[1] + edge[2])
        for edge in (gap[:3], gap[:-4:-1])
    )
    return np.concatenate((before[::-1], gap, after))


def _bends(heights: Array) -> Array:
    """4 D_1 - D_2 of every row; zero at the two before either end."""
    bends = np.zeros(heights.shape)
    near, far = heights[1:-3] + heights[3:-1], heights[:-4] + heights[4:]
    bends[2:-2] = 4.0 * near - far - 6.0 * heights[2:-2]
    return bends


def _wide_bends(heights: Array, row: NDArray[np.intp], column: NDArray[np.intp]) -> Array:
    """4 D_k - D_2k at places, k being :data:`WIDE`."""
    near, far = (heights[row - k, column] + heights[row + k, column] for k in (WIDE, 2 * WIDE))
    return np.asarray(4.0 * near - far - 6.0 * heights[row, column])


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
