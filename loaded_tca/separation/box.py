"""How large a box a contact needs under a load."""

from __future__ import annotations

import math

import numpy as np

from loaded_tca.arrays import Array, Indices
from loaded_tca.errors import GeometryError
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.reference.hertz import line_contact, point_contact
from loaded_tca.separation.normal_gap import NormalGap
from loaded_tca.unloaded import ContactPoint, RelativeCurvature, relative_curvature
from loaded_tca.unloaded.roots import find_roots

MARGIN = 1.25
"""Box over estimated contact."""
SPIKE_MARGIN = 1.75
"""The same across a contact that ends with its flank, where the half-space gives a spike and a wider contact."""
EDGE_MARGIN = 2.5
"""The same across a contact on an edge: over a gap that rises linearly from the edge of a flank the half-space is
twice as wide as the strips."""
CERTAINLY_INSIDE = 0.97
"""Contacts shorter than this fraction of the material are taken to end of themselves."""
PROBE = (17, 33)
"""Cells of the coarse grids on which the contact is estimated."""
ROOM = 1.5
"""Wanted half lengths of a coarse grid over those of the contact."""
MOST_PROBES = 16
LEAST_GROWTH, MOST_GROWTH = 2.0, 100.0
"""Of a probe that a contact fills."""
END_OF_MATERIAL = 1e-6
"""Accuracy of the end of the material, over the half length of the box."""
STRAIGHT_CHORD = 5e-5
"""Change of the fall of the room from row to row, relative, below which its chord ends where the material does: to
an eighth of that, of the distance of the rows."""


def estimate_box(
    gap: NormalGap, contact: ContactPoint, load: float, guess: tuple[float, float] | None, cells: int
) -> tuple[float, float]:
    """Half lengths across and along [mm] of a box that holds the contact under a load > 0 [N].

    Where the material ends inside the box, the box ends a cell (of ``cells`` along) beyond it, so that whole cells end
    there.
    """
    pair = gap.pair
    modulus = pair.contact_modulus
    longest = math.hypot(pair.face_width, *(flank.extent[0] for flank in (pair.pinion.flank, pair.wheel.flank)))
    if guess is not None and contact.on_edge:  # a window that a contact with this box fills to two thirds
        window = ROOM / EDGE_MARGIN * guess[0], ROOM / MARGIN * guess[1]
    else:
        window = _first_window(relative_curvature(pair, contact), load, pair)
    window = (window[0], min(window[1], longest))
    for _ in range(MOST_PROBES):
        x, y = (np.linspace(-half, half, count) for half, count in zip(window, PROBE, strict=True))
        fall, room = gap.at(x[:, None], y)
        if room.max() < 0.0:
            window = (2.0 * window[0], min(2.0 * window[1], longest))
            continue
        *needed, end, growth = _strip_extent(np.where(room >= 0.0, fall, np.inf), x, y, load, modulus)
        fits = [0.4 * have <= need <= have / MARGIN for need, have in zip(needed, window, strict=True)]
        fits[1] |= needed[1] > window[1] / MARGIN and window[1] == longest
        if all(fits):
            break
        across, along = (_resized(need, have, growth) for need, have in zip(needed, window, strict=True))
        window = (across, min(along, longest))
    if room.max() < 0.0:
        raise GeometryError(f"no flank around the contact point at pinion angle {contact.pinion_angle:.6g} rad")
    material = _material_length(gap, room, x, y, MARGIN * needed[1])
    spiked = end > CERTAINLY_INSIDE * material
    margin = EDGE_MARGIN if contact.on_edge else SPIKE_MARGIN if spiked else MARGIN
    along = MARGIN * needed[1]
    if material < along:
        along = material * (cells / (cells - 2) if cells > 2 else 1.0)
    return margin * needed[0], along


def _first_window(curvature: RelativeCurvature, load: float, pair: GearPair) -> tuple[float, float]:
    """A window that a Hertzian ellipse would fill to two thirds, or across a line that the face cuts off."""
    across = max(curvature.across, 1e-6 / pair.face_width)
    along = max(curvature.along, 1e-8 * across)
    ellipse = point_contact(load, (across, along), pair.contact_modulus)
    line = line_contact(load / pair.face_width, across, pair.contact_modulus)
    return ROOM * max(ellipse.semi_minor, line.half_width), ROOM * ellipse.semi_major


def _resized(needed: float, window: float, growth: float) -> float:
    """A window that a contact of the needed half length fills to two thirds, or ``growth`` times as large."""
    return min(max(ROOM * needed, 0.1 * window), 4.0 * window) if needed < 0.85 * window else growth * window


def _strip_extent(gap: Array, x: Array, y: Array, load: float, modulus: float) -> tuple[float, float, float, float]:
    """Half lengths across and along [mm] of the contact that the strip model gives on a coarse gap, and where it ends.

    The half lengths are rounded up to half a cell; the end is that of a penetration which falls as a parabola. The last
    number is how much larger the window should be if the contact fills it: the cube root of the penetration over the
    gap in it, as of point contacts, between two bounds.
    """
    floor = gap.min(axis=0)
    there = np.isfinite(floor)
    floor, depth, reach = floor[there], gap[:, there] - floor[there], np.abs(y[there])
    ordered = np.sort(floor)
    sums = np.cumsum(ordered)
    across, dx, dy = np.abs(x), x[1] - x[0], y[1] - y[0]
    width, length = x[-1], y[-1]
    for _ in range(4):
        stiffness = 0.5 * math.pi * modulus / max(math.log(4.0 * max(length / width, 1.0)) - 1.0, 0.25 * math.pi)
        penetration = _water_level(ordered, sums, load / (stiffness * dy)) - floor
        closed = penetration > 0.0
        loaded = (depth <= 2.0 * stiffness / (math.pi * modulus) * penetration) & closed
        width = float(across[loaded.any(axis=1)].max()) + 0.5 * dx
        length = float(reach[closed].max()) + 0.5 * dy
    rise = float(np.ptp(gap[np.isfinite(gap)]))
    growth = math.cbrt(float(penetration.max()) / rise) if rise > 0.0 else 0.0
    growth = min(max(growth, LEAST_GROWTH), MOST_GROWTH)
    return width, length, _end_of_parabola(reach[closed], penetration[closed]), growth


def _end_of_parabola(distance: Array, penetration: Array) -> float:
    """Distance at which the penetration ends that falls as a parabola about y = 0; infinite if it does not fall."""
    last = int(distance.argmax())
    beside = min(max(last + (1 if last == 0 else -1), 0), len(distance) - 1)
    fall = penetration[beside] - penetration[last]
    if fall <= 0.0:
        return math.inf
    squares = distance[last] ** 2, distance[beside] ** 2
    return math.sqrt(squares[0] + penetration[last] * (squares[0] - squares[1]) / fall)


def _water_level(ordered: Array, sums: Array, total: float) -> float:
    """The delta at which (delta - floor)_+ adds up to ``total``; the floor in its order, and its running sums."""
    levels = (total + sums) / np.arange(1, len(ordered) + 1)
    above = np.append(ordered[1:], np.inf)
    return float(levels[np.argmax(levels <= above)])


def _material_length(gap: NormalGap, room: Array, x: Array, y: Array, reach: float) -> float:
    """Distance along y to the farthest end of the material within ``reach``, to 1e-6 of it.

    Looked for over the whole width of a probe, whose distances to the edges are ``room`` (x, y): in a corner of a
    flank there is none straight ahead.
    """
    lowest = 4.0 * (y[0] - y[1])
    room = np.maximum(room.max(axis=0), lowest)
    middle = len(y) // 2
    last = np.abs(np.flatnonzero(room >= 0.0) - middle).max()
    if last == middle or y[middle + last] >= reach:
        return reach
    sides = np.array([side for side in (-1, 1) if room[middle + side * last] >= 0.0])
    before, inner, outer, beyond = middle + np.arange(last - 1, last + 3)[:, None] * sides
    fall = room[inner] - room[outer]
    if (np.abs(room[before] - room[inner] - fall) <= STRAIGHT_CHORD * fall).all():
        return min(float(np.abs(y[inner] + room[inner] / fall * (y[outer] - y[inner])).max()), reach)
    tolerance = END_OF_MATERIAL * reach

    def room_at(place: Array, _: Indices | None = None) -> Array:
        return np.maximum(gap.at(x[:, None], place)[1].max(axis=0), lowest)

    if last + 2 <= middle:  # in a corner the other edge rules inside, but seldom outside
        steep = room[outer] - room[beyond]
        end = y[outer] + room[outer] / np.where(steep > 0.0, steep, np.inf) * (y[outer] - y[inner])
        around = room_at((end + 0.5 * tolerance * np.array([[-1.0], [1.0]]) * sides).ravel()).reshape(2, -1)
        if (around[0] >= 0.0).all() and (around[1] < 0.0).all():
            return min(float(np.abs(end).max()), reach)
    ends = np.stack([inner, outer])
    return min(float(np.abs(find_roots(room_at, y[ends], room[ends], tolerance)).max()), reach)
