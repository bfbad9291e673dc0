r"""The separation matrix: the gap between the flanks on a small grid in the tangent plane of a contact point.

The grid lies along the principal relative curvatures, x across (largest curvature), y along, centred on the contact
point, which falls between the middle cells of even grids. Where the contact under load lies askew on these axes, the
grid lies along the contact; where a flank ends in the box, the box ends a cell beyond it. The gap is the distance of
the two flanks along the common normal; it is +inf where a flank ends. Edges of the flanks run where they run: of every
cell the part that has material is known, so that a contact that ends there does not jump by whole cells.

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
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.contact.checks import memory_problem
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.plain import plain
from loaded_tca.separation.box import MARGIN, Box, Estimate, estimate_boxes
from loaded_tca.separation.normal_gap import TOGETHER, NormalGap
from loaded_tca.separation.polynomials import GapPolynomials
from loaded_tca.unloaded.curvature import relative_curvatures
from loaded_tca.unloaded.path import ContactPoint, require_contact

PEAK_ERROR = 0.26
"""Relative error of the peak pressure times the square of the number of cells across a smooth contact (measured on
circles and ellipses: 1e-3 at 16 cells, 2.5e-4 at 32)."""
LOAD_OF_UNLOADED_BOX = 1e-6
"""Load [N] that sizes the box of an unloaded contact: small enough for its smallest gap to be rounding."""
LINE_SMOOTHED = 0.05
"""Standard deviation, over the module, of the stretch over which the line of the forces is smoothed: a tooth bends by
forces over a depth of about a module, not by how they scatter from cell to cell."""
SLIVER = 0.01
"""Part of a cell that does not count: below it a cell has no material, and one that lacks no more is whole."""


@checked
def slice_middles(x: Array, pressure: Array) -> tuple[Indices, Array]:
    """Slices of a grid that carry load, and where across the contact the middle of their pressure lies.

    Parameters
    ----------
    x : (nx,) array [mm]
        Cell centres across.
    pressure : (nx, ny) array [MPa]

    Returns
    -------
    (n,) array of int, (n,) array [mm]
    """
    force = pressure.sum(axis=0)
    carrying = force.nonzero()[0]
    return carrying, x @ pressure[:, carrying] / force[carrying]


def force_line_under(separation: Separation, pressure: Array, module: float) -> Array:
    """Line (ny,) [mm] of the forces of a grid at the centres of a pressure; see :meth:`Separation.loaded_by`."""
    carrying, middles = slice_middles(separation.x, pressure)
    if not carrying.size:
        return separation.force_line
    places, force = separation.y[carrying], pressure.sum(axis=0)[carrying]
    line = smoothed(places, middles, force, LINE_SMOOTHED * module)
    return np.interp(separation.y, places, line)


def smoothed(places: Array, values: Array, weights: Array, deviation: float) -> Array:
    """Values at places along a line, smoothed by straight lines through those nearby.

    Parameters
    ----------
    places, values, weights : (n,) array
        The weights positive.
    deviation : float
        Standard deviation, along the places, of the normal distribution that the weights fall with.

    Returns
    -------
    (n,) array
        Straight lines stay as they are, up to their ends.

    Examples
    --------
    >>> places = np.arange(5.0)
    >>> smoothed(places, 2.0 * places, np.ones(5), 1.0).round(12)
    array([0., 2., 4., 6., 8.])
    """
    away = places - places[:, None]
    shares = weights * np.exp(-0.5 * (away / deviation) ** 2)
    shares /= shares.sum(axis=1, keepdims=True)
    middle, mean = (shares * away).sum(axis=1), shares @ values
    away -= middle[:, None]
    shares *= away
    scatter, together = (shares * away).sum(axis=1), shares @ values - shares.sum(axis=1) * mean
    slope = np.divide(together, scatter, out=np.zeros(places.shape), where=scatter > 0.0)
    return np.asarray(mean - slope * middle)


@dataclass(frozen=True, eq=False)
class Separation:
    """Gap between the flanks around a contact point.

    Attributes
    ----------
    gap : (nx, ny) array [mm]
        At the middles of the cells: +inf where a flank ends; zero at the contact point.
    x, y : (nx,), (ny,) array [mm]
        Cell centres across and along.
    spacing : (float, float) [mm]
        Cell sizes (dx, dy).
    origin : (3,) array [mm]
        The contact point in the fixed frame.
    axes : (3, 3) array
        Rows: x, y, and the normal out of the pinion.
    curvatures : (float, float) [1/mm]
        Relative curvatures at the contact point, across and along: the principal ones where the grid lies along these.
    cover : (nx, ny) array
        Part of every cell that has material, from 0 to 1.
    cut_gap : (nx, ny) array [mm]
        The gap of all cells with some material, +inf in the others: that of the flanks continued to the middle of a
        cell where they end before it.
    force_line : (ny,) array [mm]
        Where across the contact the force of every slice acts, from the contact point: near the centre of its pressure,
        as far as one is known (:meth:`loaded_by`); else zero.
    polynomials : GapPolynomials or None
        Of the gap about the contact point, for other grids of it in boxes like this; None: there are none.
    """

    gap: Array
    x: Array
    y: Array
    spacing: tuple[float, float]
    origin: Array
    axes: Array
    curvatures: tuple[float, float]
    cover: Array
    cut_gap: Array
    force_line: Array
    polynomials: GapPolynomials | None = None

    @property
    def points(self) -> Array:
        """Cell centres in the tangent plane, in the fixed frame: (nx, ny, 3) [mm]."""
        return self.origin + self.x[:, None, None] * self.axes[0] + self.y[None, :, None] * self.axes[1]

    @property
    def widths(self) -> Array:
        """Widths of the slices along y (ny,) [mm]."""
        return np.full(self.y.size, self.spacing[1])

    @property
    def with_material(self) -> Mask:
        """Which slices have material (ny,)."""
        return np.asarray(self.cover.any(axis=0))

    @property
    def material_area(self) -> float:
        """Area of the material within the box [mm^2]."""
        return float(self.cover.sum()) * self.spacing[0] * self.spacing[1]

    @property
    def box(self) -> Box:
        """Where the grid lies in the tangent plane."""
        return Box.of(self)

    @checked
    def loaded_by(self, pressure: Array, module: float) -> Separation:
        """Return the same grid, its forces at the centres of a pressure (nx, ny); as it is where there is none.

        The line through the centres is smoothed over a part of the ``module`` [mm]: how they scatter from cell to cell
        would displace slices by as little as a nanometre, which on fine cells is a pressure of a hundred MPa, which
        scatters the centres in turn. Slices without pressure take the place of the nearest ones between or beside which
        they lie.
        """
        line = force_line_under(self, pressure, module)
        return self if line is self.force_line else replace(self, force_line=line)

    def __repr__(self) -> str:
        nx, ny = self.gap.shape
        return f"Separation({nx} x {ny} cells of {plain(self.spacing[0], 3)} x {plain(self.spacing[1], 3)} mm)"


def cells_for_accuracy(accuracy: float) -> int:
    """Even number of cells across the box that gives the peak pressure to a relative ``accuracy``."""
    return 2 * math.ceil(0.5 * MARGIN * max(8.0, math.sqrt(PEAK_ERROR / accuracy)))


@checked
def sample_separation(
    pair: GearPair,
    contact: ContactPoint,
    *,
    cells: tuple[int, int] | None = None,
    load: float | None = None,
    accuracy: float = 1e-3,
    box: Box | tuple[float, float] | None = None,
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
    box : (float, float) [mm] or Box, optional
        Half lengths across and along, instead of the estimated ones, about the contact point and along the principal
        directions of the relative curvature; or the box of another grid in this tangent plane.
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
        If the tooth pair is not in contact at this position, or the contact point lies off the flanks.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.flanks import FlankModifications
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> from loaded_tca.unloaded import trace_contact
    >>> mesh = CylindricalMesh(*(CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)))
    >>> pair = cylindrical_pair(mesh, modifications=(FlankModifications(lead_crowning=0.005), FlankModifications()))
    >>> separation = sample_separation(pair, trace_contact(pair, [0.0])[0], cells=(32, 32), load=2712.6)
    >>> [round(k, 6) for k in separation.curvatures]
    [0.091526, 6.4e-05]
    """
    (separation,) = sample_separations(
        pair, [contact], cells=[cells], loads=[load], boxes=[box], guesses=[guess], accuracy=accuracy
    )
    if isinstance(separation, Separation):
        return separation
    raise separation


def sample_separations(
    pair: GearPair,
    contacts: Sequence[ContactPoint],
    *,
    cells: Sequence[tuple[int, int] | None],
    loads: Sequence[float | None],
    boxes: Sequence[Box | tuple[float, float] | None],
    guesses: Sequence[tuple[float, float] | None] | None = None,
    polynomials: Sequence[GapPolynomials | None] | None = None,
    cells_at_ends: Sequence[tuple[int, int] | None] | None = None,
    accuracy: float = 1e-3,
) -> list[Separation | InputError | GeometryError]:
    """Gaps of n contacts: of each what :func:`sample_separation` returns or raises, whatever stands beside it.

    Parameters
    ----------
    pair : GearPair
    contacts : sequence of n ContactPoint
    cells, loads, boxes, guesses : sequences of n
        For each contact, as of :func:`sample_separation`; a :class:`Box` may lie anywhere in the tangent plane.
    polynomials : sequence of n, optional
        Those of another grid of each contact, of the same pair and axes, or None; used as far as they reach.
    cells_at_ends : sequence of n, optional
        Cells instead of ``cells`` in estimated boxes in which the material ends along an axis, or None.
    accuracy : float
        Of all contacts whose cells are None.
    """
    separations: dict[int, Separation | InputError | GeometryError] = {}
    shapes: dict[int, tuple[int, int]] = {}
    guesses = [None] * len(contacts) if guesses is None else guesses
    for index, (contact, shape, load, box, guess) in enumerate(
        zip(contacts, cells, loads, boxes, guesses, strict=True)
    ):
        try:
            require_contact(contact)
            lengths = box.half_lengths if isinstance(box, Box) else box
            _check(shape, load, accuracy, {"box": lengths, "guess": guess})
        except (InputError, GeometryError) as error:
            separations[index] = error
        else:
            across, along = shape if shape is not None else (cells_for_accuracy(accuracy),) * 2
            shapes[index] = int(across), int(along)
    kept = [None] * len(contacts) if polynomials is None else polynomials
    placed: dict[int, Estimate] = {}
    for index, place in zip(shapes, _placed(pair, contacts, shapes, loads, boxes, guesses, kept), strict=True):
        if not isinstance(place, Estimate):
            separations[index] = place
            continue
        placed[index] = place
        if place.cut and cells_at_ends is not None:
            shapes[index] = cells_at_ends[index] or shapes[index]
    for shape in dict.fromkeys(shapes.values()):
        sized = [(index, place) for index, place in placed.items() if shapes[index] == shape]
        size = max(1, TOGETHER // math.prod(shape))
        for part in (dict(sized[first : first + size]) for first in range(0, len(sized), size)):
            gaps = _sampled(pair, [contacts[index] for index in part], [*part.values()], shape)
            separations.update(zip(part, gaps, strict=True))
    return [separations[index] for index in range(len(contacts))]


def _placed(
    pair: GearPair,
    contacts: Sequence[ContactPoint],
    shapes: Mapping[int, tuple[int, int]],
    loads: Sequence[float | None],
    boxes: Sequence[Box | tuple[float, float] | None],
    guesses: Sequence[tuple[float, float] | None],
    polynomials: Sequence[GapPolynomials | None],
) -> list[Estimate | GeometryError]:
    """Box of each contact that has a shape of its grid: the given one, or one that holds it under its load."""
    principal = dict(zip(shapes, relative_curvatures(pair, [contacts[index] for index in shapes]), strict=True))
    to_size = [index for index in shapes if boxes[index] is None]
    forces = [loads[index] or LOAD_OF_UNLOADED_BOX for index in to_size]
    starts, cells = [guesses[index] for index in to_size], [shapes[index] for index in to_size]
    sized = estimate_boxes(pair, [contacts[index] for index in to_size], forces, starts, cells) if to_size else []
    placed = dict(zip(to_size, sized, strict=True))
    for index in shapes:
        if (box := boxes[index]) is not None:
            place = box if isinstance(box, Box) else Box(box, principal[index].axes)
            placed[index] = Estimate(place, polynomials[index])
    return [placed[index] for index in shapes]


def _sampled(
    pair: GearPair, contacts: Sequence[ContactPoint], places: Sequence[Estimate], shape: tuple[int, int]
) -> Iterator[Separation]:
    """Gaps of n contacts in their boxes, on grids of one shape."""
    boxes = [place.box for place in places]
    curvatures, axes = relative_curvatures(pair, contacts), np.array([box.axes for box in boxes])
    spacings = 2.0 * np.array([box.half_lengths for box in boxes]) / shape
    x, y = (
        middle[:, None] + (np.arange(n) - 0.5 * (n - 1)) * step[:, None]
        for n, step, middle in zip(shape, spacings.T, np.array([box.middle for box in boxes]).T, strict=True)
    )
    surfaces = _surfaces(pair, contacts, axes, [place.polynomials for place in places], x, y)
    heights, distances = surfaces[0], surfaces[1:]
    covers = _covers(distances, spacings)
    whole, cut = (np.where(there, heights, np.inf) for there in (distances.min(axis=0) >= 0.0, covers > 0.0))
    for k, (contact, curvature, (dx, dy)) in enumerate(zip(contacts, curvatures, spacings.tolist(), strict=True)):
        grid, origin = (whole[k].copy(), x[k], y[k], (dx, dy)), contact.point.copy()
        along_axes, line = curvature.along_axes(boxes[k].axes), np.zeros(y.shape[1])
        material = covers[k].copy(), cut[k].copy()
        yield Separation(*grid, origin, axes[k], along_axes, *material, line, places[k].polynomials)


def _surfaces(
    pair: GearPair,
    contacts: Sequence[ContactPoint],
    axes: Array,
    polynomials: Sequence[GapPolynomials | None],
    x: Array,
    y: Array,
) -> Array:
    """Gaps, and distances to each edge (surfaces, n, nx, ny) where x (n, nx) and y (n, ny) cross.

    By the polynomials of contacts that have some, in boxes that they hold in.
    """
    held = [own is not None and own.hold_in(x[k], y[k]) for k, own in enumerate(polynomials)]
    smooth, bent = np.flatnonzero(held), np.flatnonzero(np.logical_not(held))
    parts = []
    if smooth.size:
        together = GapPolynomials.together([own for own, holds in zip(polynomials, held, strict=True) if own and holds])
        parts.append(together.surfaces(x[smooth], y[smooth]))
    if bent.size:
        gap = NormalGap(pair, [contacts[k] for k in bent.tolist()], axes[bent])
        parts.append(gap.surfaces(x[bent, :, None], y[bent, None]))
    if len(parts) == 1:
        return parts[0]
    return np.concatenate(parts, axis=1)[:, np.argsort(np.concatenate([smooth, bent]))]


def _covers(distances: Array, spacings: Array) -> Array:
    """Part of every cell that has material (n, nx, ny), of the distances (edges, n, nx, ny) of their middles to edges.

    From one cell to the next the distance grows by a and b: with a straight edge along an axis of the grid the part is
    1/2 + distance/(|a| + |b|), from 0 to 1; with an oblique one nearly so. Of a bent edge |a| and |b| are the means of
    those to the cells on both sides, so that a mirror leaves the parts as they are.
    """
    covers, near = np.ones(distances.shape[1:]), distances.min(axis=(2, 3)) < spacings.sum(axis=1)
    if not near.any():
        return covers
    ends, growth = distances[near], np.zeros((np.count_nonzero(near), *covers.shape[1:]))
    met = np.where(np.isfinite(ends), ends, np.nan)
    for lines, sums in ((met, growth), (met.swapaxes(1, 2), growth.swapaxes(1, 2))):
        if lines.shape[1] > 1:
            steps = np.full((len(lines), lines.shape[1] + 1, lines.shape[2]), np.nan)
            np.abs(lines[:, 1:] - lines[:, :-1], out=steps[:, 1:-1])
            before, after = steps[:, :-1], steps[:, 1:]
            sums += np.where(np.isfinite(before + after), 0.5 * (before + after), np.fmax(before, after))
    parts = np.divide(ends, growth, out=np.copysign(1.0, ends), where=growth > 0.0)
    parts += 0.5
    for part, contact in zip(parts, np.nonzero(near)[1], strict=True):
        np.minimum(covers[contact], part, out=covers[contact])
    return np.where(covers < SLIVER, 0.0, np.where(covers > 1.0 - SLIVER, 1.0, covers))


def _check(
    cells: tuple[int, int] | None, load: float | None, accuracy: float, boxes: dict[str, tuple[float, float] | None]
) -> None:
    problems = []
    if cells is not None and not (_two_positive(cells) and all(n == n // 1 for n in cells)):
        problems.append(f"cells: {cells} are not two whole numbers >= 1")
    elif cells is not None and (memory := memory_problem(tuple(cells))) is not None:
        problems.append(memory)
    if load is None and boxes["box"] is None:
        problems.append("load: none given; a load [N] or a box [mm] is needed to size the grid")
    if load is not None and not 0.0 <= load < math.inf:
        problems.append(f"load: {load} N is not a finite number >= 0")
    for name, box in boxes.items():
        if box is not None and not _two_positive(box):
            problems.append(f"{name}: {box} are not two positive lengths [mm]")
    if not 1e-8 <= accuracy < 1.0:
        problems.append(f"accuracy: {accuracy} is not between 1e-8 and 1")
    if problems:
        raise InputError(problems)


def _two_positive(values: object) -> bool:
    array = np.asarray(values)
    return array.shape == (2,) and array.dtype.kind in "iuf" and bool(((array > 0) & (array < math.inf)).all())
