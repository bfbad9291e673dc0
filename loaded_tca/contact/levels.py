"""From grid to grid: coarser gaps, pressures carried to a finer grid, windows around a contact."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from loaded_tca.arrays import Array, Mask
from loaded_tca.contact.convolution import Window, fast_length

COARSEST = 16
MARGIN_CELLS = 3
# Newton steps for the constant between the squares of two pressures; the solver takes care of what is left.
SHIFTS = 3
# Cells of a grid that are worked on at a time: a dozen arrays of them fit the cache.
PART_CELLS = 2**16


def coarsening(shape: tuple[int, int]) -> tuple[int, int]:
    """Cells to merge along each axis; (1, 1) if the grid is as coarse as it should be."""
    return (2 if shape[0] >= 2 * COARSEST else 1, 2 if shape[1] >= 2 * COARSEST else 1)


def coarsen(gap: Array, merge: tuple[int, int], reach: Array | float = np.inf) -> Array:
    """Gap (..., nx, ny) at the centres of the merged cells; infinite only where a whole block has no material.

    Cubic interpolation inside, so that a smooth gap is sampled rather than blurred; the mean at borders and beside
    cells without material. An odd last row or column makes a block of its own. Gaps beyond the reach (..., 1, 1) count
    as no material.
    """
    coarse = np.empty((*gap.shape[:-2], -(-gap.shape[-2] // merge[0]), -(-gap.shape[-1] // merge[1])))
    for rows, around in parts_of(coarse.shape, 1):
        part = gap[..., merge[0] * around.start : merge[0] * around.stop, :]
        part = np.where(part <= reach, part, np.inf)
        for axis in (-2, -1):
            if merge[axis] == 2:
                part = np.moveaxis(_merge_pairs(np.moveaxis(part, axis, 0)), 0, axis)
        coarse[..., rows, :] = part[..., rows.start - around.start : rows.stop - around.start, :]
    return coarse


def parts_of(shape: tuple[int, ...], margin: int = 0) -> Iterator[tuple[slice, slice]]:
    """Rows (..., rows, columns) in parts that fit the cache, each also with a margin where there are rows beyond it."""
    count, columns = shape[-2:]
    size = max(PART_CELLS // columns, 8 * margin, 1)
    for start in range(0, count, size):
        stop = min(start + size, count)
        yield slice(start, stop), slice(max(0, start - margin), min(stop + margin, count))


def _merge_pairs(gap: Array) -> Array:
    """Value between the rows 2i and 2i + 1: (9 (f_2i + f_2i+1) - f_2i-1 - f_2i+2)/16, or their mean, or one."""
    even, odd = gap[::2], gap[1::2]
    if odd.shape != even.shape:
        odd = np.concatenate((odd, gap[-1:]))
    merged = np.minimum(even, odd)
    finite = np.isfinite(even) & np.isfinite(odd)
    np.add(0.5 * even, 0.5 * odd, out=merged, where=finite)
    inner = finite[1:-1] & np.isfinite(odd[:-2]) & np.isfinite(even[2:])
    outer = np.add(0.5 * odd[:-2], 0.5 * even[2:], out=np.zeros_like(merged[1:-1]), where=inner)
    np.add(1.125 * merged[1:-1], -0.125 * outer, out=merged[1:-1], where=inner)
    return merged


def merged(values: Array, merge: tuple[int, int]) -> Array:
    """Means (..., nx, ny) over so many cells along the last two axes; an odd last one stays alone."""
    for axis in (-2, -1):
        if merge[axis] == 2:
            starts = np.arange(0, values.shape[axis], 2)
            sizes = np.diff(np.append(starts, values.shape[axis]))
            values = np.add.reduceat(values, starts, axis=axis) / (sizes[:, None] if axis == -2 else sizes)
    return values


def prolong(pressure: Array, shape: tuple[int, int], merge: tuple[int, int]) -> Array:
    """Pressure (..., nx, ny) on the next finer grid: its square interpolated, continued below zero across the edge.

    Near a smooth edge the pressure grows as the root of the distance to it, so that its square is smooth there.
    """
    fine = np.empty((*pressure.shape[:-2], *shape))
    for rows, around in parts_of(pressure.shape, MARGIN_CELLS):  # what a cell becomes depends on three to either side
        square = continue_outside(pressure[..., around, :] ** 2)
        for axis in (-2, -1):
            if merge[axis] == 2:
                square = split(square, axis)
        target = fine[..., merge[0] * rows.start : merge[0] * rows.stop, :]
        first = merge[0] * (rows.start - around.start)
        part = square[..., first : first + target.shape[-2], : shape[1]]
        np.sqrt(np.maximum(part, 0.0, out=part), out=target)
    return fine


def under_other_load(pressure: Array, ratio: float) -> Array:
    """Pressure near that under another load, ``ratio`` times the one it has; its sum is only nearly that.

    The squares of the pressures under two ellipses of the same shape, or two strips, differ by a constant.
    """
    square, total, shift = continue_outside(pressure * pressure), ratio * float(pressure.sum()), 0.0
    pressed = square != 0.0  # no neighbour tells how the others would go on
    squares, moved = square[pressed], np.zeros(square.shape)
    for _ in range(SHIFTS):
        shifted = np.sqrt(np.maximum(squares + shift, 0.0))
        slope = 0.5 * float((1.0 / shifted[shifted > 0.0]).sum())
        shift -= (float(shifted.sum()) - total) / slope if slope > 0.0 else 0.0
    moved[pressed] = np.sqrt(np.maximum(squares + shift, 0.0))
    return moved


def continue_outside(square: Array) -> Array:
    """Give cells beside the contact the lowest value of the lines through two neighbours in it, zero at most."""
    padded = np.zeros((*square.shape[:-2], square.shape[-2] + 4, square.shape[-1] + 4))
    padded[..., 2:-2, 2:-2] = square
    # All cells in one line, which is faster: what lies beyond the end of a row is margin.
    flat, line, width = padded.reshape(-1), np.zeros(padded.shape), padded.shape[-1]
    first, last = 2 * width, padded.size - 2 * width
    inner = line.reshape(-1)[first:last]
    for step in (width, -width, 1, -1):
        near, far = flat[first + step : last + step], flat[first + 2 * step : last + 2 * step]
        np.minimum(inner, 2.0 * near - far, out=inner, where=near > 0.0)
    return np.where(square > 0.0, square, line[..., 2:-2, 2:-2])


def split(values: Array, axis: int) -> Array:
    """Interpolation to the centres of half cells along the axis -2 or -1, constant beyond the last centres.

    Quadratic between three positive values, linear elsewhere: the cells at an edge carry the error of their grid,
    which a quadratic would magnify.
    """

    def at(start: int, stop: int | None, step: int = 1) -> tuple[Any, ...]:
        return (..., slice(start, stop, step)) if axis == -1 else (..., slice(start, stop, step), slice(None))

    padded = np.concatenate((values[at(0, 1)], values, values[at(-1, None)]), axis=axis)
    first, last = at(0, -2), at(2, None)
    before, after, positive = padded[first], padded[last], padded > 0.0
    # (5 before + 30 own - 3 after)/32 = (3 own + before)/4 - (before - 2 own + after) 3/32
    bend = before + after
    bend -= 2.0 * values
    bend *= 0.09375 * (positive[first] & positive[at(1, -1)] & positive[last])
    np.subtract(0.75 * values, bend, out=bend)
    fine = np.empty([2 * n if k == values.ndim + axis else n for k, n in enumerate(values.shape)])
    np.add(bend, 0.25 * before, out=fine[at(0, None, 2)])
    np.add(bend, 0.25 * after, out=fine[at(1, None, 2)])
    return fine


def window_around(cells: Mask) -> Window:
    """Window of a grid that holds the marked cells and a margin.

    Rounded up to the size that the transform of it would have anyway; the whole axis if it is nearly that.
    """
    spans = []
    for axis in (0, 1):
        marked, size = np.nonzero(cells.any(axis=1 - axis))[0], cells.shape[axis]
        start = max(0, int(marked[0]) - MARGIN_CELLS)
        stop = min(size, int(marked[-1]) + 1 + MARGIN_CELLS)
        stop = min(size, start + fast_length(2 * (stop - start)) // 2)
        spans.append(slice(start, stop))
    return spans[0], spans[1]
