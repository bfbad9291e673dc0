r"""The separation matrix: the gap between the flanks on a small grid in the tangent plane of a contact point.

The grid lies along the principal relative curvatures, x across (largest curvature), y along, centred on the contact
point, which falls between the middle cells of even grids. The gap is the distance of the two flanks along the
common normal; it is +inf where a flank ends.

How large a box does a contact need? The contact is cut into strips across; a strip of gap g_j carries the line load

.. math:: q_j = c\,(\delta - g_j)_+, \qquad c = \frac{\pi E^*}{2 D}, \quad D = \max(\ln(4 L/b) - 1, \pi/4),

which is exact for the slender and for the circular Hertz contact, and its half width is where the gap has risen by
2 q_j/(pi E*), as it does at the edge of a Hertzian line contact. The same rule serves points, lines and edges.

References
----------
Johnson 1985, Contact Mechanics, eqs. 4.24 to 4.28 (slender ellipse), 4.45 (line).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks.jet import Array
from loaded_tca.memory import memory_problem
from loaded_tca.normal_gap import NormalGap
from loaded_tca.pair import GearPair
from loaded_tca.reference.hertz import line_contact, point_contact
from loaded_tca.unloaded import ContactPoint, RelativeCurvature, relative_curvature
from loaded_tca.unloaded.roots import find_roots

PEAK_ERROR = 0.26
"""Relative error of the peak pressure times the square of the number of cells across a smooth contact (measured on
circles and ellipses: 1e-3 at 16 cells, 2.5e-4 at 32)."""
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
SMALLEST_LOAD = 1e-6
"""Load [N] that sizes the box of an unloaded contact: small enough for its smallest gap to be rounding."""
ROOM = 1.5
"""Wanted half lengths of a coarse grid over those of the contact."""
MOST_PROBES = 16
LEAST_GROWTH, MOST_GROWTH = 2.0, 100.0
"""Of a probe that a contact fills."""
END_OF_MATERIAL = 1e-6
"""Accuracy of the end of the material, over the half length of the box."""
STRAIGHT = 5e-5
"""Change of the fall of the room from row to row, relative, below which its chord ends where the material does: to
an eighth of that, of the distance of the rows."""


@dataclass(frozen=True, eq=False)
class Separation:
    """Gap between the flanks around a contact point.

    Attributes
    ----------
    gap : (nx, ny) array [mm]
        +inf where a flank ends; zero at the contact point.
    x, y : (nx,), (ny,) array [mm]
        Cell centres across and along.
    spacing : (float, float) [mm]
        Cell sizes (dx, dy).
    origin : (3,) array [mm]
        The contact point in the fixed frame.
    axes : (3, 3) array
        Rows: x, y, and the normal out of the pinion.
    curvatures : (float, float) [1/mm]
        Principal relative curvatures, across and along.
    """

    gap: Array
    x: Array
    y: Array
    spacing: tuple[float, float]
    origin: Array
    axes: Array
    curvatures: tuple[float, float]

    @property
    def points(self) -> Array:
        """Cell centres in the tangent plane, in the fixed frame: (nx, ny, 3) [mm]."""
        return self.origin + self.x[:, None, None] * self.axes[0] + self.y[None, :, None] * self.axes[1]

    @property
    def material_area(self) -> float:
        """Area of the cells that have material [mm^2]."""
        return float(np.isfinite(self.gap).sum()) * self.spacing[0] * self.spacing[1]

    @property
    def half_lengths(self) -> tuple[float, float]:
        """Half lengths of the box across and along [mm]."""
        return 0.5 * self.gap.shape[0] * self.spacing[0], 0.5 * self.gap.shape[1] * self.spacing[1]

    def __repr__(self) -> str:
        nx, ny = self.gap.shape
        return f"Separation({nx} x {ny} cells of {self.spacing[0]:.3g} x {self.spacing[1]:.3g} mm)"


def cells_for_accuracy(accuracy: float) -> int:
    """Even number of cells across the box that gives the peak pressure to a relative ``accuracy``."""
    return 2 * math.ceil(0.5 * MARGIN * max(8.0, math.sqrt(PEAK_ERROR / accuracy)))


def sample_separation(
    pair: GearPair,
    contact: ContactPoint,
    *,
    cells: tuple[int, int] | None = None,
    load: float | None = None,
    accuracy: float = 1e-3,
    box: tuple[float, float] | None = None,
    guess: tuple[float, float] | None = None,
) -> Separation:
    """Gap between the flanks on a grid that just holds the contact.

    Parameters
    ----------
    pair : GearPair
    contact : ContactPoint
        One position of a contact path.
    cells : (int, int), optional
        Cells across and along; default: what ``accuracy`` asks for.
    load : float [N], optional
        Normal force that the box must hold; not needed if ``box`` is given. A load of zero gets the box of 1e-6 N.
    accuracy : float
        Relative error of the peak pressure of a smooth contact that chooses the cells.
    box : (float, float) [mm], optional
        Half lengths across and along, instead of the estimated ones.
    guess : (float, float) [mm], optional
        Half lengths to start the estimate of the box from: those of the same contact under a load near this one. It
        saves time on edges, whose boxes the curvatures do not tell; elsewhere it is not needed, and not used.

    Returns
    -------
    Separation

    Raises
    ------
    InputError
        If an argument is out of range, or neither load nor box is given.
    GeometryError
        If the tooth pair does not touch at this position, or the contact point lies off the flanks.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.flanks import FlankModifications
    >>> from loaded_tca.pair import cylindrical_pair
    >>> from loaded_tca.unloaded import trace_contact
    >>> mesh = CylindricalMesh(*(CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)))
    >>> pair = cylindrical_pair(mesh, modifications=(FlankModifications(lead_crowning=0.005), FlankModifications()))
    >>> separation = sample_separation(pair, trace_contact(pair, [0.0])[0], cells=(32, 32), load=2712.6)
    >>> [round(k, 6) for k in separation.curvatures]
    [0.091526, 6.4e-05]
    """
    _check(contact, cells, load, accuracy, {"box": box, "guess": guess})
    curvature = relative_curvature(pair, contact)
    gap = NormalGap(pair, contact, curvature.axes)
    shape = (int(cells[0]), int(cells[1])) if cells is not None else (cells_for_accuracy(accuracy),) * 2
    half = (
        box
        if box is not None
        else _box_of_whole_cells(
            *_estimate_box(gap, curvature, contact, load if load else SMALLEST_LOAD, guess), shape[1]
        )
    )
    spacing = (2.0 * half[0] / shape[0], 2.0 * half[1] / shape[1])
    x, y = ((np.arange(n) - 0.5 * (n - 1)) * step for n, step in zip(shape, spacing, strict=True))
    curvatures = (curvature.across, curvature.along)
    return Separation(gap(x, y), x, y, spacing, contact.point.copy(), curvature.axes, curvatures)


def _check(
    contact: ContactPoint,
    cells: tuple[int, int] | None,
    load: float | None,
    accuracy: float,
    boxes: dict[str, tuple[float, float] | None],
) -> None:
    if not isinstance(contact, ContactPoint):
        raise InputError(f"contact: {contact!r} is not one position of a path; take path[i]")
    problems = []
    if cells is not None and not (_two_numbers(cells) and all(n == n // 1 and 1 <= n < math.inf for n in cells)):
        problems.append(f"cells: {cells} are not two whole numbers >= 1")
    elif cells is not None and (memory := memory_problem(tuple(cells))) is not None:
        problems.append(memory)
    if load is None and boxes["box"] is None:
        problems.append("load: none given; a load [N] or a box [mm] is needed to size the grid")
    if load is not None and not 0.0 <= load < math.inf:
        problems.append(f"load: {load} N is not a finite number >= 0")
    problems += [f"{name}: {box} are not two positive lengths [mm]" for name, box in boxes.items() if not _is_box(box)]
    if not 1e-8 <= accuracy < 1.0:
        problems.append(f"accuracy: {accuracy} is not between 1e-8 and 1")
    if problems:
        raise InputError(problems)
    if not contact.touches:
        raise GeometryError(
            f"no common flank: the tooth pair does not touch at pinion angle {contact.pinion_angle} rad"
        )


def _box_of_whole_cells(half: tuple[float, float], material: float, cells: int) -> tuple[float, float]:
    """Box that ends a cell beyond the end of the material where it lies inside, so that whole cells end there."""
    if material >= half[1]:
        return half
    return half[0], material * (cells / (cells - 2) if cells > 2 else 1.0)


def _is_box(box: tuple[float, float] | None) -> bool:
    return box is None or (_two_numbers(box) and all(0.0 < length < math.inf for length in box))


def _two_numbers(values: object) -> bool:
    array = np.asarray(values)
    return array.shape == (2,) and array.dtype.kind in "iuf" and not np.isnan(array.astype(float)).any()


def _estimate_box(
    gap: NormalGap, curvature: RelativeCurvature, contact: ContactPoint, load: float, guess: tuple[float, float] | None
) -> tuple[tuple[float, float], float]:
    """Half lengths across and along of a box that holds the contact under a load > 0 [N], and the end of the material.

    The end of the material is the distance along the second axis to the farthest point that both flanks still cover,
    within the box.
    """
    pair = gap.pair
    modulus = pair.contact_modulus
    longest = math.hypot(pair.face_width, *(flank.extent[0] for flank in (pair.pinion, pair.wheel)))
    window = _window_in(guess) if guess is not None and contact.on_edge else _first_window(curvature, load, pair)
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
    return (margin * needed[0], MARGIN * needed[1]), material


def _first_window(curvature: RelativeCurvature, load: float, pair: GearPair) -> tuple[float, float]:
    """A window that a Hertzian ellipse would fill to two thirds, or across a line that the face cuts off."""
    across = max(curvature.across, 1e-6 / pair.face_width)
    along = max(curvature.along, 1e-8 * across)
    ellipse = point_contact(load, (across, along), pair.contact_modulus)
    line = line_contact(load / pair.face_width, across, pair.contact_modulus)
    return ROOM * max(ellipse.semi_minor, line.half_width), ROOM * ellipse.semi_major


def _window_in(box: tuple[float, float]) -> tuple[float, float]:
    """A window that a contact on an edge with this box would fill to two thirds."""
    return ROOM / EDGE_MARGIN * box[0], ROOM / MARGIN * box[1]


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
        pressed = penetration > 0.0
        loaded = (depth <= 2.0 * stiffness / (math.pi * modulus) * penetration) & pressed
        width = float(across[loaded.any(axis=1)].max()) + 0.5 * dx
        length = float(reach[pressed].max()) + 0.5 * dy
    rise = float(np.ptp(gap[np.isfinite(gap)]))
    growth = (float(penetration.max()) / rise) ** (1.0 / 3.0) if rise > 0.0 else 0.0
    growth = min(max(growth, LEAST_GROWTH), MOST_GROWTH)
    return width, length, _end_of_parabola(reach[pressed], penetration[pressed]), growth


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

    Looked for over the whole width of a probe, whose distances to the borders are ``room`` (x, y): in a corner of a
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
    if (np.abs(room[before] - room[inner] - fall) <= STRAIGHT * fall).all():
        return min(float(np.abs(y[inner] + room[inner] / fall * (y[outer] - y[inner])).max()), reach)
    tolerance = END_OF_MATERIAL * reach

    def room_at(place: Array, _: NDArray[np.int_] | None = None) -> Array:
        return np.maximum(gap.at(x[:, None], place)[1].max(axis=0), lowest)

    if last + 2 <= middle:  # in a corner the other border rules inside, but seldom outside
        steep = room[outer] - room[beyond]
        end = y[outer] + room[outer] / np.where(steep > 0.0, steep, np.inf) * (y[outer] - y[inner])
        around = room_at((end + 0.5 * tolerance * np.array([[-1.0], [1.0]]) * sides).ravel()).reshape(2, -1)
        if (around[0] >= 0.0).all() and (around[1] < 0.0).all():
            return min(float(np.abs(end).max()), reach)
    ends = np.stack([inner, outer])
    return min(float(np.abs(find_roots(room_at, y[ends], room[ends], tolerance)).max()), reach)
