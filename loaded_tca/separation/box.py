"""How large a box each of several contacts needs under its load."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.errors import GeometryError
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.reference.hertz import line_contact, point_contact
from loaded_tca.separation.normal_gap import NormalGap
from loaded_tca.unloaded import ContactPoint, RelativeCurvature
from loaded_tca.unloaded.curvature import relative_curvatures
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
SIDES = np.array([-1, 1])
"""Of a contact, along it."""


def estimate_boxes(
    pair: GearPair,
    contacts: Sequence[ContactPoint],
    loads: Sequence[float],
    guesses: Sequence[tuple[float, float] | None],
    cells: Sequence[int],
) -> list[tuple[float, float] | GeometryError]:
    """Half lengths across and along [mm] of boxes that hold n contacts, each under its load > 0 [N].

    Where the material ends inside a box, the box ends a cell beyond it (one of its ``cells`` along), so that whole
    cells end there. A contact off the flanks gets an error instead.
    """
    curvatures, modulus = relative_curvatures(pair, contacts), pair.contact_modulus
    gap = NormalGap(pair, contacts, np.array([curvature.axes for curvature in curvatures]))
    longest = math.hypot(pair.face_width, *(flank.extent[0] for flank in (pair.pinion.flank, pair.wheel.flank)))
    windows, forces = _first_windows(curvatures, np.asarray(loads), pair), np.asarray(loads)
    on_edge = np.array([contact.on_edge for contact in contacts])
    for row, guess in enumerate(guesses):
        if guess is not None and on_edge[row]:  # a window that a contact with this box fills to two thirds
            windows[row] = ROOM / EDGE_MARGIN * guess[0], ROOM / MARGIN * guess[1]
    windows[:, 1] = np.minimum(windows[:, 1], longest)
    count, rows = len(contacts), np.arange(len(contacts))
    x, y, room = np.empty((count, PROBE[0])), np.empty((count, PROBE[1])), np.empty((count, *PROBE))
    needed, end = np.empty((count, 2)), np.empty(count)
    for _ in range(MOST_PROBES):
        have = windows[rows]
        # Symmetric to the bit: which end of a contact is the farther one is no matter of rounding.
        x[rows], y[rows] = (half[:, None] * np.linspace(-1.0, 1.0, n) for half, n in zip(have.T, PROBE, strict=True))
        fall, room[rows] = gap.of(rows).at(x[rows][:, :, None], y[rows][:, None])
        bare = room[rows].max(axis=(1, 2)) < 0.0
        there = (room[rows] >= 0.0) | bare[:, None, None]  # what is found of the bare ones is not used
        needed[rows], end[rows], growth = _strip_extents(
            np.where(there, fall, np.inf), x[rows], y[rows], forces[rows], modulus
        )
        need = needed[rows]
        fits = (0.4 * have <= need) & (need <= have / MARGIN)
        fits[:, 1] |= (need[:, 1] > have[:, 1] / MARGIN) & (have[:, 1] == longest)
        on = bare | ~fits.all(axis=1)
        resized = np.where(bare[:, None], 2.0 * have, _resized(need, have, growth[:, None]))
        windows[rows] = np.minimum(resized, [np.inf, longest])
        rows = rows[on]
        if not rows.size:
            break
    held, along = np.flatnonzero(room.max(axis=(1, 2)) >= 0.0), MARGIN * needed[:, 1]
    material = along.copy()
    material[held] = _material_lengths(gap.of(held), room[held], x[held], y[held], along[held])
    margin = np.where(on_edge, EDGE_MARGIN, np.where(end > CERTAINLY_INSIDE * material, SPIKE_MARGIN, MARGIN))
    beyond = material * [n / (n - 2) if n > 2 else 1.0 for n in cells]
    boxes = np.full((count, 2), np.nan)
    boxes[held] = np.stack([margin * needed[:, 0], np.where(material < along, beyond, along)], axis=1)[held]
    missing = "no flank around the contact point at pinion angle {:.6g} rad"
    return [
        GeometryError(missing.format(contact.pinion_angle)) if math.isnan(across) else (across, along)
        for contact, (across, along) in zip(contacts, boxes.tolist(), strict=True)
    ]


def _first_windows(curvatures: Sequence[RelativeCurvature], loads: Array, pair: GearPair) -> Array:
    """Windows (n, 2) that Hertzian ellipses would fill to two thirds, or across lines that the face cuts off.

    The axes of an ellipse grow with the cube root of the load, the width of a line with its square root.
    """
    under_one = {}
    for curvature in dict.fromkeys(curvatures):
        across = max(curvature.across, 1e-6 / pair.face_width)
        ellipse = point_contact(1.0, (across, max(curvature.along, 1e-8 * across)), pair.contact_modulus)
        line = line_contact(1.0 / pair.face_width, across, pair.contact_modulus)
        under_one[curvature] = ellipse.semi_minor, ellipse.semi_major, line.half_width
    minor, major, half_width = np.array([under_one[curvature] for curvature in curvatures]).T
    return ROOM * np.stack([np.maximum(np.cbrt(loads) * minor, np.sqrt(loads) * half_width), np.cbrt(loads) * major], 1)


def _resized(needed: Array, window: Array, growth: Array) -> Array:
    """Windows that contacts of the needed half lengths fill to two thirds, or ``growth`` times as large."""
    fitting = np.minimum(np.maximum(ROOM * needed, 0.1 * window), 4.0 * window)
    return np.where(needed < 0.85 * window, fitting, growth * window)


def _strip_extents(gap: Array, x: Array, y: Array, loads: Array, modulus: float) -> tuple[Array, Array, Array]:
    """Half lengths across and along (n, 2) [mm] of contacts that the strip model gives on coarse gaps (n, nx, ny).

    They are rounded up to half a cell. The second (n,) is where the contact ends if its penetration falls as a
    parabola. The third (n,) is how much larger a window should be that the contact fills: the cube root of the
    penetration over the gap in it, as of point contacts, between two bounds.
    """
    floor = gap.min(axis=1)
    depth = gap - np.where(np.isfinite(floor), floor, 0.0)[:, None]
    ordered = np.sort(floor, axis=1)
    sums = np.cumsum(ordered, axis=1)
    across, reach, dx, dy = np.abs(x), np.abs(y), x[:, 1] - x[:, 0], y[:, 1] - y[:, 0]
    width, length = x[:, -1], y[:, -1]
    for _ in range(4):
        slenderness = np.log(4.0 * np.maximum(length / width, 1.0)) - 1.0
        stiffness = 0.5 * math.pi * modulus / np.maximum(slenderness, 0.25 * math.pi)
        penetration = _water_level(ordered, sums, loads / (stiffness * dy)) - floor
        closed = penetration > 0.0
        lifted = np.where(closed, (2.0 * stiffness / (math.pi * modulus))[:, None] * penetration, -1.0)
        loaded = (depth <= lifted[:, None]).max(axis=2)
        width = _farthest(across, loaded) + 0.5 * dx
        length = _farthest(reach, closed) + 0.5 * dy
    deepest = penetration.max(axis=1)
    rise = np.where(np.isfinite(gap), gap, -np.inf).max(axis=(1, 2)) - ordered[:, 0]
    growth = np.cbrt(np.divide(deepest, rise, out=np.zeros(rise.shape), where=rise > 0.0))
    ends = _ends_of_parabolas(reach, penetration, closed)
    return np.stack([width, length], axis=1), ends, np.clip(growth, LEAST_GROWTH, MOST_GROWTH)


def _farthest(distance: Array, there: Mask) -> Array:
    """Largest distance in every row, of those that are there."""
    return np.where(there, distance, 0.0).max(axis=1)


def _ends_of_parabolas(distance: Array, penetration: Array, closed: Mask) -> Array:
    """Distances (n,) at which penetrations end that fall as parabolas about y = 0; infinite if one does not fall."""
    places, rows = np.arange(distance.shape[1]), np.arange(len(distance))
    last = np.where(closed, distance, -1.0).argmax(axis=1)
    others = np.where(closed & (places != last[:, None]), np.abs(places - last[:, None]), places.size)
    beside = others.argmin(axis=1)
    fall = np.where(closed.sum(axis=1) > 1, penetration[rows, beside] - penetration[rows, last], 0.0)
    outer, inner = distance[rows, last] ** 2, distance[rows, beside] ** 2
    rest = np.divide(penetration[rows, last] * (outer - inner), fall, out=np.full(fall.shape, np.inf), where=fall > 0.0)
    return np.sqrt(outer + rest)


def _water_level(ordered: Array, sums: Array, total: Array) -> Array:
    """The deltas (n, 1) at which (delta - floor)_+ adds up to ``total``, of floors in order and their running sums."""
    levels = (total[:, None] + sums) / np.arange(1, ordered.shape[1] + 1)
    above = np.append(ordered[:, 1:], np.full((len(ordered), 1), np.inf), axis=1)
    return np.take_along_axis(levels, (levels <= above).argmax(axis=1)[:, None], axis=1)


def _material_lengths(gap: NormalGap, room: Array, x: Array, y: Array, reach: Array) -> Array:
    """Distances (n,) along y to the farthest ends of the material within ``reach``, to 1e-6 of it.

    Looked for over the whole width of the probes, whose distances to the edges are ``room`` (n, nx, ny): in a corner of
    a flank there is none straight ahead.
    """
    lengths, middle = reach.copy(), y.shape[1] // 2
    lowest = 4.0 * (y[:, 0] - y[:, 1])
    room = np.maximum(room.max(axis=1), lowest[:, None])
    last = _farthest(np.abs(np.arange(y.shape[1]) - middle), room >= 0.0).astype(int)
    rows = np.flatnonzero((last < middle) & (y[np.arange(len(y)), middle + last] < reach))
    if not rows.size:
        return lengths
    # ends of the material on either side, (rows, 2): between the rows of cells ``inner`` and ``outer``
    columns = [np.clip(middle + (last[rows, None] + step) * SIDES, 0, 2 * middle) for step in (-1, 0, 1, 2)]
    before, inner, outer, beyond = (room[rows[:, None], column] for column in columns)
    start, stop = (y[rows[:, None], column] for column in columns[1:3])
    there, fall = inner >= 0.0, inner - outer
    straight = ((np.abs(before - inner - fall) <= STRAIGHT_CHORD * fall) | ~there).all(axis=1)
    ends = start + np.divide(inner, fall, out=np.zeros(fall.shape), where=there) * (stop - start)
    tolerance = END_OF_MATERIAL * reach[rows, None]

    def room_at(of: Indices, places: Array) -> Array:
        found = gap.of(rows[of]).at(x[rows[of], :, None], places[:, None])[1].max(axis=1)
        return np.maximum(found, lowest[rows[of], None])

    known, corners = straight, np.flatnonzero(~straight & (last[rows] + 2 <= middle))
    if corners.size:  # where the other edge rules inside, but seldom outside
        steep = (outer - beyond)[corners]
        past = outer[corners] / np.where(steep > 0.0, steep, np.inf) * (stop - start)[corners]
        end = stop[corners] + past
        around = 0.5 * tolerance[corners] * SIDES
        inside, outside = (room_at(corners, end + sign * around) for sign in (-1.0, 1.0))
        met = (((inside >= 0.0) & (outside < 0.0)) | ~there[corners]).all(axis=1)
        ends[corners[met]], known[corners[met]] = end[met], True
    unknown, side = np.nonzero(there & ~known[:, None])
    if unknown.size:
        scale = reach[rows[unknown]]
        brackets, values = (np.stack([a[unknown, side], b[unknown, side]]) for a, b in ((start, stop), (inner, outer)))
        found = find_roots(
            lambda part, which: room_at(unknown[which], (part * scale[which])[:, None])[:, 0],
            brackets / scale,
            values,
            END_OF_MATERIAL,
        )
        ends[unknown, side] = found * scale
    lengths[rows] = np.minimum(_farthest(np.abs(ends), there), reach[rows])
    return lengths
