"""Where the grid of each of several contacts lies: how large a box it needs under its load, and along which axes."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple, Protocol, Self

import numpy as np

from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.errors import GeometryError
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.plain import plain
from loaded_tca.reference.hertz import line_contact, point_contact
from loaded_tca.roots import find_roots
from loaded_tca.separation.normal_gap import NormalGap
from loaded_tca.separation.polynomials import OUTSIDE, GapPolynomials
from loaded_tca.separation.strips import strip_extents
from loaded_tca.unloaded import ContactPoint, RelativeCurvature
from loaded_tca.unloaded.curvature import relative_curvatures

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
END_ALONG, END_ACROSS = 1e-6, 1e-3
"""Accuracy of the end of the material, over the half length of the box."""
STRAIGHT_CHORD = 50.0
"""Change of the fall of the room from row to row, relative and over that accuracy, below which its chord ends where
the material does: to an eighth of that, of the distance of the rows."""
STEEPEST = 2.0
"""Most that the distance to an edge falls along the tangent plane, over the way."""
ASKEW = 0.25
"""How far the centres of the strips may be from the axis along a contact at its ends, over the half width across."""
SLENDER = 2.0
"""Length over width from which strips across tell the axis of a contact."""
MOST_TURNS = 4


class Grid(Protocol):
    """Cells in the tangent plane of a contact point."""

    @property
    def x(self) -> Array:
        """Cell centres across (nx,) [mm]."""

    @property
    def y(self) -> Array:
        """Cell centres along (ny,) [mm]."""

    @property
    def spacing(self) -> tuple[float, float]:
        """Cell sizes [mm]."""

    @property
    def axes(self) -> Array:
        """Rows: the directions across and along, and the normal out of the pinion (3, 3)."""


@dataclass(frozen=True, eq=False)
class Box:
    """Rectangle in the tangent plane of a contact point.

    Attributes
    ----------
    half_lengths : (float, float) [mm]
        Across and along.
    axes : (3, 3) array
        Rows: the directions across and along, and the normal out of the pinion.
    middle : (float, float) [mm]
        Place of its middle, across and along, from the contact point.
    """

    half_lengths: tuple[float, float]
    axes: Array
    middle: tuple[float, float] = (0.0, 0.0)

    @classmethod
    def of(cls, grid: Grid) -> Self:
        """Box of a grid."""
        x, y, (dx, dy) = grid.x, grid.y, grid.spacing
        middle = 0.5 * float(x[0] + x[-1]), 0.5 * float(y[0] + y[-1])
        return cls((0.5 * x.size * dx, 0.5 * y.size * dy), grid.axes, middle)

    def holds(self, other: Box) -> bool:
        """Whether it covers another box with the same axes."""
        ends = zip(self.half_lengths, self.middle, other.half_lengths, other.middle, strict=True)
        return all(abs(middle - place) <= half - length for half, middle, length, place in ends)

    def grown(self, ends: Sequence[tuple[bool, bool]], growth: float) -> Self:
        """Return it ``growth`` times as long where it grows: ``ends`` are the lower and upper one, across and along."""
        half_lengths, middle = [], []
        for length, place, (low, high) in zip(self.half_lengths, self.middle, ends, strict=True):
            added = length * (growth - 1.0)
            half_lengths.append(length + 0.5 * added * (low + high))
            middle.append(place + 0.5 * added * (float(high) - float(low)))
        return replace(self, half_lengths=(half_lengths[0], half_lengths[1]), middle=(middle[0], middle[1]))


class Estimate(NamedTuple):
    """Box of a contact, the polynomials of its gap, None where none hold, and whether the material ends in the box."""

    box: Box
    polynomials: GapPolynomials | None
    cut: bool = False


def estimate_boxes(
    pair: GearPair,
    contacts: Sequence[ContactPoint],
    loads: Sequence[float],
    guesses: Sequence[tuple[float, float] | None],
    cells: Sequence[tuple[int, int]],
) -> list[Estimate | GeometryError]:
    """Boxes that hold n contacts, each under its load > 0 [N], and polynomials of the gaps around.

    Their axes are the principal directions of the relative curvature, turned where the contact under load lies
    askew on them, as where the contact point stands on the start of a relief: a contact is cut into strips across, and
    the axis runs along the centres of their pressure. Where the material ends inside a box, the box ends a cell (one of
    its ``cells``) beyond it, so that whole cells end there. A contact off the flanks gets an error instead.
    """
    curvatures = relative_curvatures(pair, contacts)
    axes, count, forces = np.array([curvature.axes for curvature in curvatures]), len(contacts), np.asarray(loads)
    windows = _first_windows(curvatures, forces, pair)
    on_edge = np.array([contact.on_edge for contact in contacts])
    for row, guess in enumerate(guesses):
        if guess is not None and on_edge[row]:  # a window that a contact with this box fills to two thirds
            windows[row] = ROOM / EDGE_MARGIN * guess[0], ROOM / MARGIN * guess[1]
    probes = _Probes(pair, contacts, axes, forces, windows)
    rows = np.arange(count)
    probes.fit(rows)
    for _ in range(MOST_TURNS):
        rows = rows[probes.turn(rows)]
        if not rows.size:
            break
        probes.fit(rows)
    probes.fit_polynomials()
    half_lengths, middles, cut = probes.boxes(on_edge, np.array(cells))
    missing = "no flank around the contact point at pinion angle {} rad"
    return [
        GeometryError(missing.format(plain(contact.pinion_angle, 6)))
        if math.isnan(across)
        else Estimate(Box((across, along), probes.axes[row], (x, y)), probes.polynomials_of(row), bool(cut[row]))
        for row, (contact, (across, along), (x, y)) in enumerate(
            zip(contacts, half_lengths.tolist(), middles.tolist(), strict=True)
        )
    ]


class _Probes:
    """Coarse grids about n contact points, fitted to the contacts that strips across give."""

    def __init__(
        self, pair: GearPair, contacts: Sequence[ContactPoint], axes: Array, forces: Array, windows: Array
    ) -> None:
        self.pair, self.contacts, self.axes, self.forces = pair, contacts, axes, forces
        self.longest = math.hypot(
            pair.face_width, *(flank.extent[0] for flank in (pair.pinion.flank, pair.wheel.flank))
        )
        self.windows = windows  # half lengths (n, 2) across and along
        self.windows[:, 1] = np.minimum(windows[:, 1], self.longest)
        count = len(contacts)
        self.gap = NormalGap(pair, contacts, axes)
        self.x, self.y, self.room = np.empty((count, PROBE[0])), np.empty((count, PROBE[1])), np.empty((count, *PROBE))
        self.surfaces: Array | None = None  # gap and distances to the edges (surfaces, n, *PROBE), once sampled
        self.needed, self.end, self.slope = np.empty((count, 2)), np.empty(count), np.empty(count)

    def fit(self, rows: Indices) -> None:
        """Fit the windows of some contacts."""
        for _ in range(MOST_PROBES):
            have, longest = self.windows[rows], self.longest
            # Symmetric to the bit: which end of a contact is the farther one is no matter of rounding.
            self.x[rows], self.y[rows] = (
                half[:, None] * np.linspace(-1.0, 1.0, n) for half, n in zip(have.T, PROBE, strict=True)
            )
            x, y = self.x[rows], self.y[rows]
            surfaces = self.gap.of(rows).surfaces(x[:, :, None], y[:, None])
            if self.surfaces is None:  # of all of them, at first
                self.surfaces = surfaces
            else:
                self.surfaces[:, rows] = surfaces
            fall, room = surfaces[0], surfaces[1:].min(axis=0)
            self.room[rows] = room
            bare = room.max(axis=(1, 2)) < 0.0
            there = (room >= 0.0) | bare[:, None, None]  # what is found of the bare ones is not used
            need, self.end[rows], growth, self.slope[rows] = strip_extents(
                np.where(there, fall, np.inf), x, y, self.forces[rows], self.pair.contact_modulus
            )
            self.needed[rows] = need
            fits = (0.4 * have <= need) & (need <= have / MARGIN)
            fits[:, 1] |= (need[:, 1] > have[:, 1] / MARGIN) & (have[:, 1] == longest)
            on = bare | ~fits.all(axis=1)
            resized = np.where(bare[:, None], 2.0 * have, _resized(need, have, growth[:, None]))
            self.windows[rows] = np.minimum(resized, [np.inf, longest])
            rows = rows[on]
            if not rows.size:
                break

    def turn(self, rows: Indices) -> Mask:
        """Turn the axes of some contacts along the centres of their strips; which of them lay askew."""
        slope = self.slope[rows]
        askew = np.abs(slope) * self.needed[rows, 1] > ASKEW * self.needed[rows, 0]
        askew &= (self.needed[rows, 1] > SLENDER * self.needed[rows, 0]) & (self.room[rows].max(axis=(1, 2)) >= 0.0)
        turned, slope = rows[askew], slope[askew, None]
        across, along = self.axes[turned, 0], self.axes[turned, 1]
        self.axes[turned, 0] = (across - slope * along) / np.hypot(1.0, slope)
        self.axes[turned, 1] = (along + slope * across) / np.hypot(1.0, slope)
        if turned.size:
            self.gap = NormalGap(self.pair, self.contacts, self.axes)
        return askew

    def fit_polynomials(self) -> None:
        """Fit polynomials to what was sampled."""
        assert self.surfaces is not None
        self.polynomials, self.smooth = GapPolynomials.fitted(
            self.surfaces, np.stack([self.x[:, -1], self.y[:, -1]], axis=1)
        )

    def polynomials_of(self, row: int) -> GapPolynomials | None:
        """Polynomials of one contact, if they hold."""
        return self.polynomials.of(np.array([row])) if self.smooth[row] else None

    def boxes(self, on_edge: Mask, cells: Array) -> tuple[Array, Array, Mask]:
        """Half lengths and middles of boxes, (n, 2) across and along [mm]; NaN where there is no material.

        The third (n,) tells in which of them the material ends.
        """
        count, held = len(self.needed), np.flatnonzero(self.room.max(axis=(1, 2)) >= 0.0)
        half_lengths, middles, cut = np.full((count, 2), np.nan), np.full((count, 2), np.nan), np.zeros(count, bool)
        if not held.size:
            return half_lengths, middles, cut
        needed, cells, edged = self.needed[held], cells[held], on_edge[held]
        along, widest = MARGIN * needed[:, 1], np.where(edged, EDGE_MARGIN, SPIKE_MARGIN) * needed[:, 0]
        ends = self._ends(held, along, widest, END_ALONG, 1)
        on_its_own = ~edged & (self.end[held] <= CERTAINLY_INSIDE * ends.max(axis=1))
        across = np.where(on_its_own, MARGIN * needed[:, 0], widest)
        reach = np.stack([across, along], axis=1)
        ends = np.stack([self._ends(held, across, along, END_ACROSS, 0), ends], axis=1)  # (held, axes, sides)
        # a contact that ends of itself has a box as long either way: its ends lie alike in their cells
        lengths = np.stack([needed[:, 0], np.minimum(self.end[held], needed[:, 1])], axis=1)
        reached = (lengths[..., None] > CERTAINLY_INSIDE * ends).any(axis=2, keepdims=True)
        ends = np.where(reached, ends, ends.max(axis=2, keepdims=True))
        within = ends < reach[..., None]
        cut[held] = within.any(axis=(1, 2))
        for row, ends_of, within_of, counts in zip(held.tolist(), ends, within, cells.tolist(), strict=True):
            for axis, number in enumerate(counts):
                spacing, below = _cells_to_ends(ends_of[axis], within_of[axis], number)
                half_lengths[row, axis], middles[row, axis] = 0.5 * number * spacing, (0.5 * number - below) * spacing
        return half_lengths, middles, cut

    def _ends(self, rows: Indices, reach: Array, beside: Array, accuracy: float, axis: int) -> Array:
        """Distances (rows, 2) to the ends of the material either way along an axis, at most ``reach`` (rows,).

        Looked for as far as ``beside`` (rows,) along the other axis: in a corner of a flank there is no material
        straight ahead.
        """
        ends = np.repeat(reach[:, None], 2, axis=1)
        farther = np.hypot(reach, beside) - np.hypot(self.x[rows, -1], self.y[rows, -1])
        near = self.room[rows].min(axis=(1, 2)) < STEEPEST * np.maximum(farther, 0.0)
        rows, reach, beside = rows[near], reach[near], beside[near]
        if not rows.size:
            return ends
        lines = np.linspace(-1.0, 1.0, PROBE[1 - axis])

        def room_at(of: Indices, places: Array) -> Array:
            """Largest distance to the edges (of, places) at places along the axis."""
            aside = beside[of, None] * lines
            room = self._room(rows[of], *((aside, places) if axis else (places, aside)))
            return np.asarray(room.max(axis=2 - axis))

        places = reach[:, None] * np.linspace(-1.0, 1.0, PROBE[axis])
        best = room_at(np.arange(rows.size), places)
        ends[near] = _ends_of_material(best, places, reach, accuracy, lambda of, at: room_at(of, at[:, None])[:, 0])
        return ends

    def _room(self, rows: Indices, x: Array, y: Array) -> Array:
        """Distance to the nearest edge (rows, nx, ny) where x (rows, nx) and y (rows, ny) cross."""
        farthest = np.abs(x).max(axis=1) / self.x[rows, -1], np.abs(y).max(axis=1) / self.y[rows, -1]
        smooth = self.smooth[rows] & (np.maximum(*farthest) <= OUTSIDE)
        room = np.empty((rows.size, x.shape[1], y.shape[1]))
        if smooth.any():
            room[smooth] = self.polynomials.of(rows[smooth]).surfaces(x[smooth], y[smooth])[1:].min(axis=0)
        if not smooth.all():
            bent = ~smooth
            # arcs of rounded edges, on which normals take more steps to the flank, end at the same edges
            gap = NormalGap(self.pair.sharp, self.contacts, self.axes).of(rows[bent])
            room[bent] = gap.at(x[bent, :, None], y[bent, None])[1]
        return room


def _cells_to_ends(ends: Array, cut: Mask, number: int) -> tuple[float, float]:
    """Width [mm] of a number of cells that reach two ends, and how many of them lie below the contact point.

    Where the material ends, a cell lies beyond. The contact point stays on a border of cells, or in the middle of one
    if their number is odd, since an error of the grid that is even about it has no part in derivatives.
    """
    if not cut.any():  # as far either way
        return 2.0 * float(ends[0]) / number, 0.5 * number
    below = 0.5 * number + np.arange(-(number // 2), number // 2 + 1)
    inside = np.array([below, number - below]).T - cut
    needed = np.divide(ends, inside, out=np.where(ends > 0.0, np.inf, np.zeros(inside.shape)), where=inside > 0.0)
    needed[inside < 0.0] = np.inf
    spacing = needed.max(axis=1)
    best = int(spacing.argmin())
    if not 0.0 < spacing[best] < math.inf:  # too few cells for one beyond
        return 2.0 * float(ends.max()) / number, 0.5 * number
    return float(spacing[best]), float(below[best])


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


def _ends_of_material(
    best: Array, places: Array, reach: Array, accuracy: float, room_at: Callable[[Indices, Array], Array]
) -> Array:
    """Distances (n, 2) to the ends of the material below and above the contact point, at most ``reach`` (n,).

    ``best`` (n, m) is the room at ``places`` (n, m), an odd number about zero; ``room_at(rows, places)`` that at one
    place of each of some rows. The ends are right to ``accuracy`` times the reach.
    """
    middle, lengths = places.shape[1] // 2, np.repeat(reach[:, None], 2, axis=1)
    lowest = 4.0 * (places[:, 0] - places[:, 1])
    best = np.maximum(best, lowest[:, None])
    outwards = np.stack([best[:, middle::-1], best[:, middle:]], axis=1)
    last = np.where(outwards >= 0.0, np.arange(middle + 1), 0).max(axis=2)  # with material, (n, 2)
    ends_within = np.take_along_axis(places, middle + last, axis=1) < reach[:, None]
    rows, side = np.nonzero((last < middle) & ends_within)
    if not rows.size:
        return lengths
    last, sign = last[rows, side], 2 * side - 1
    # the end lies between the places ``start`` and ``stop``, where there is room ``inner`` and ``outer``
    columns = [np.clip(middle + (last + step) * sign, 0, 2 * middle) for step in (-1, 0, 1, 2)]
    before, inner, outer, beyond = (best[rows, column] for column in columns)
    start, stop = places[rows, middle + last], places[rows, middle + last + 1]
    there, fall = inner >= 0.0, inner - outer
    straight = (np.abs(before - inner - fall) <= STRAIGHT_CHORD * accuracy * fall) | ~there
    ends = start + np.divide(inner, fall, out=np.zeros(fall.shape), where=there) * (stop - start)
    tolerance = accuracy * reach[rows]

    def room_of(of: Indices, distance: Array) -> Array:
        return np.maximum(room_at(rows[of], sign[of] * distance), lowest[rows[of]])

    known, corners = straight, np.flatnonzero(~straight & (last + 2 <= middle))
    if corners.size:  # where the other edge rules inside, but seldom outside
        steep = (outer - beyond)[corners]
        end = stop[corners] + outer[corners] / np.where(steep > 0.0, steep, np.inf) * (stop - start)[corners]
        around = 0.5 * tolerance[corners]
        met = (room_of(corners, end - around) >= 0.0) & (room_of(corners, end + around) < 0.0)
        ends[corners[met]], known[corners[met]] = end[met], True
    unknown = np.flatnonzero(~known)
    if unknown.size:
        scale = reach[rows[unknown]]
        roots = find_roots(
            lambda part, which: room_of(unknown[which], part * scale[which]),
            np.stack([start, stop])[:, unknown] / scale,
            np.stack([inner, outer])[:, unknown],
            accuracy,
        )
        ends[unknown] = roots * scale
    lengths[rows, side] = np.minimum(ends, reach[rows])
    return lengths
