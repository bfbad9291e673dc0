"""Contacts cut into strips across, each of which carries its load as a line contact does.

See :mod:`loaded_tca.separation.sample` for what a strip carries over its gap, and the sources.
"""

from __future__ import annotations

import math

import numpy as np

from loaded_tca.arrays import Array, Mask

LEAST_GROWTH, MOST_GROWTH = 2.0, 100.0
"""Of a probe that a contact fills."""


def strip_extents(gap: Array, x: Array, y: Array, loads: Array, modulus: float) -> tuple[Array, Array, Array, Array]:
    """Half lengths across and along (n, 2) [mm] of contacts that the strip model gives on coarse gaps (n, nx, ny).

    They are rounded up to half a cell. The second (n,) is where the contact ends if its penetration falls as a
    parabola. The third (n,) is how much larger a window should be that the contact fills: the cube root of the
    penetration over the gap in it, as of point contacts, between two bounds. The fourth (n,) is the slope dx/dy of a
    line through the centres of the strips, weighted with their loads.
    """
    floor = gap.min(axis=1)
    depth = gap - np.where(np.isfinite(floor), floor, 0.0)[:, None]
    ordered = np.sort(floor, axis=1)
    sums = np.cumsum(ordered, axis=1)
    across, reach, dx, dy = np.abs(x), np.abs(y), x[:, 1] - x[:, 0], y[:, 1] - y[:, 0]
    width, length = x[:, -1], y[:, -1]
    for _ in range(4):
        stiffness = _stiffness(width, length, modulus)
        penetration = _water_level(sums, loads / (stiffness * dy)) - floor
        closed = penetration > 0.0
        lifted = np.where(closed, (2.0 * stiffness / (math.pi * modulus))[:, None] * penetration, -1.0)
        loaded = (depth <= lifted[:, None]).max(axis=2)
        width = _farthest(across, loaded) + 0.5 * dx
        length = _farthest(reach, closed) + 0.5 * dy
    deepest = penetration.max(axis=1)
    rise = np.where(np.isfinite(gap), gap, -np.inf).max(axis=(1, 2)) - ordered[:, 0]
    growth = np.cbrt(np.divide(deepest, rise, out=np.zeros(rise.shape), where=rise > 0.0))
    ends = _ends_of_parabolas(reach, penetration, closed)
    slope = _slope_of_centres(np.sqrt(np.maximum(lifted[:, None] - depth, 0.0)), x, y, np.maximum(penetration, 0.0))
    return np.stack([width, length], axis=1), ends, np.clip(growth, LEAST_GROWTH, MOST_GROWTH), slope


def strip_pressure(gap: Array, spacing: tuple[float, float], load: float, modulus: float) -> Array:
    """Pressure (nx, ny) of a contact over a gap (nx, ny) [mm], which strips share as they carry it; in any unit.

    Parameters
    ----------
    gap : (nx, ny) array [mm]
        Infinite where there is no material.
    spacing : (float, float) [mm]
        Of its cells.
    load : float [N]
        Positive.
    modulus : float [MPa]
        E*.

    Examples
    --------
    A cylinder of 10 mm radius, 2 N/mm on a half-space: after Hertz the root of 1 - (x/a)^2, a = 0.0149 mm.

    >>> x = 0.002 * (np.arange(16) - 7.5)
    >>> pressure = strip_pressure(np.tile(x[:, None] ** 2 / 20.0, 4), (0.002, 0.5), 4.0, 115e3)
    >>> (pressure[[7, 10, 12], 0] / pressure[7, 0]).round(2)
    array([1.  , 0.94, 0.8 ])
    """
    (dx, dy), floor = spacing, gap.min(axis=0)
    depth = gap - np.where(np.isfinite(floor), floor, 0.0)
    sums, (across, along) = np.sort(floor).cumsum()[None], gap.shape
    for _ in range(2):  # first as long and wide as the grid
        stiffness = _stiffness(across * dx, along * dy, modulus)
        penetration = np.maximum(_water_level(sums, np.array([load / (stiffness * dy)]))[0] - floor, 0.0)
        pressure = np.sqrt(np.maximum(2.0 * stiffness / (math.pi * modulus) * penetration - depth, 0.0))
        across, along = max(1, int((pressure > 0.0).sum(axis=0).max())), max(1, np.count_nonzero(penetration))
    sum_across = dx * pressure.sum(axis=0)
    return pressure * np.divide(penetration, sum_across, out=np.zeros(floor.shape), where=sum_across > 0.0)


def _stiffness(width: Array | float, length: Array | float, modulus: float) -> Array:
    """Line load of a strip over its penetration [MPa], in contacts of such widths and lengths."""
    slenderness = np.log(4.0 * np.maximum(length / width, 1.0)) - 1.0
    return np.asarray(0.5 * math.pi * modulus / np.maximum(slenderness, 0.25 * math.pi))


def _slope_of_centres(pressure: Array, x: Array, y: Array, load: Array) -> Array:
    """Slopes dx/dy (n,) of lines through the centres of the pressure (n, nx, ny) of strips under loads (n, ny)."""
    total = pressure.sum(axis=1)
    load = np.where(total > 0.0, load, 0.0)
    centre = np.divide((pressure * x[:, :, None]).sum(axis=1), total, out=np.zeros(total.shape), where=total > 0.0)
    share = load / load.sum(axis=1, keepdims=True)
    offset = y - (share * y).sum(axis=1, keepdims=True)
    scatter = (share * offset**2).sum(axis=1)
    return np.divide((share * offset * centre).sum(axis=1), scatter, out=np.zeros(len(x)), where=scatter > 0.0)


def _farthest(distance: Array, there: Mask) -> Array:
    """Largest distance in every row, of those that are there."""
    return np.where(there, distance, 0.0).max(axis=1)


def _ends_of_parabolas(distance: Array, penetration: Array, closed: Mask) -> Array:
    """Distances (n,) at which penetrations end that fall as parabolas about y = 0; infinite if one does not fall.

    Where the last strips on both sides are as far, it is the farther end: the same one in a mirror.
    """
    sides = (slice(None), slice(None, None, -1))
    first, last = (_ends_on_first_side(distance[:, side], penetration[:, side], closed[:, side]) for side in sides)
    return np.maximum(first, last)


def _ends_on_first_side(distance: Array, penetration: Array, closed: Mask) -> Array:
    """The same of the first one of the farthest strips."""
    places, rows = np.arange(distance.shape[1]), np.arange(len(distance))
    last = np.where(closed, distance, -1.0).argmax(axis=1)
    others = np.where(closed & (places != last[:, None]), np.abs(places - last[:, None]), places.size)
    beside = others.argmin(axis=1)
    fall = np.where(closed.sum(axis=1) > 1, penetration[rows, beside] - penetration[rows, last], 0.0)
    outer, inner = distance[rows, last] ** 2, distance[rows, beside] ** 2
    rest = np.divide(penetration[rows, last] * (outer - inner), fall, out=np.full(fall.shape, np.inf), where=fall > 0.0)
    return np.sqrt(outer + rest)


def _water_level(sums: Array, total: Array) -> Array:
    """The deltas (n, 1) at which (delta - floor)_+ adds up to ``total``, of running sums of floors in order.

    Each is the lowest of the levels to which the k lowest floors alone would be filled.
    """
    return np.asarray((total[:, None] + sums) / np.arange(1, sums.shape[1] + 1)).min(axis=1, keepdims=True)
