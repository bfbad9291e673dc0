r"""Free edges of teeth: what tip edges and face ends add to the deflection of the half-spaces, slice by slice.

A body that ends beside its contact is softer than a half-space. Hetenyi's solution of the quarter-space is met by
an image of the pressure in the end, at the distance R from the place that it displaces, with a factor that
depends on where both lie:

.. math:: \psi(S) = \psi + 0.4 \left(S - 0.9\right),\qquad S = 4 d d'/R^2

d and d' are the distances of the two from the end, S = 1 for a place and its own image. At other angles than 90 deg
psi(S) is scaled as psi is (:func:`loaded_tca.contact.wedge_factor`). What the image displaces in the middle of the
tooth is taken off, since bending counts it, or nothing does: far below a short contact a tooth is no quarter-space.
There S = 1/2 stands for all. The rest falls with the distance from the end over the thickness of the tooth, and
is faded out to nothing. No length in this depends on the load or on the grid.

Slices of held grids move towards the edges as keys of a scene change: the derivative is that by the distances d of the
slices to an edge, by the growth of d along the slices, and by psi, under forces as they are. What the keys have in
common is found once: each moves the slices by distances of its own. Where a slice lies on an edge, beyond which
distances count no more, half of the derivative stands: the mean of those to both sides.

References
----------
Hetenyi 1960, J. Appl. Mech. 27, 289-296; Guilbault 2011, J. Tribol. 133, 031402 (one image and a factor).
``validation/contact/free_edge.py`` and ``validation/contact/free_block.py`` compare.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple, Protocol, Self

import numpy as np

from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.compliance.flexibility import depth_displacement, depth_displacement_slope
from loaded_tca.contact.edges import MEAN_PLACE, VARIATION, quarter_space_factor, wedge_factor
from loaded_tca.errors import InputError
from loaded_tca.flanks.base import EDGE_NAMES, outward_normal
from loaded_tca.flanks.rounding import sharp
from loaded_tca.material import Material
from loaded_tca.pairs.gear_pair import ContactGrid, GearPair, MovedSlices
from loaded_tca.separation import Separation

DEPTH = 0.25 * math.pi
"""Of the middle of a tooth below its flank, over the module: half the thickness on the pitch circle."""
REACHES = {0: 0.5, 2: 3.0 * DEPTH, 3: 3.0 * DEPTH}
"""Distance over the module from which on an edge of a flank counts no more: of the tip edge, where bending knows the
tip from there on, and of both face ends. At the root a tooth goes on as the fillet."""
PLACE_BELOW = 0.5
"""The S that stands for all places in the middle of the tooth."""
WIDTH = 0.02
"""Distance across the contact that stands for its width, over the module. It is that of a half width of a twentieth
module, and matters within such a length from the end."""
PAIRS = 8192
"""Pairs of slices worked on at once; more do not fit the cache."""
STEP = 1e-3
"""Over the module: that by which distances of points tell the direction of an end."""
ON_EDGE = 1e-9
"""Distance over the module at which a slice lies on an edge."""
NODES, WEIGHTS = np.polynomial.legendre.leggauss(3)


def edge_compliance(pair: GearPair, separation: Separation) -> Array | None:
    """What tip edges and face ends of both gears add to the deflection of the slices of a contact's grid.

    Parameters
    ----------
    pair : GearPair
    separation : Separation
        Grid of the contact.

    Returns
    -------
    (ny, ny) array or None [mm/N]
        Deflection of every slice under a unit force on each, symmetric; None where no end is in reach.

    Raises
    ------
    InputError
        If a tooth ends at an edge sharper than 30 degrees.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> from loaded_tca.separation import sample_separation
    >>> from loaded_tca.unloaded import trace_contact
    >>> mesh = CylindricalMesh(*(CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)))
    >>> pair = cylindrical_pair(mesh)
    >>> separation = sample_separation(pair, trace_contact(pair, [0.0])[0], cells=(16, 17), load=2700.0)
    >>> added = edge_compliance(pair, separation)
    >>> float(added[1, 1].round(8)), float(added[8, 8])  # the first slice of the face, and that in its middle
    (1.4e-06, 0.0)
    """
    compliance = edge_compliances(pair, [separation])[0]
    if isinstance(compliance, InputError):
        raise compliance
    return compliance


class Slices(ContactGrid, Protocol):
    """Slices of a contact, side by side along y; those of a separation are all of one width."""

    @property
    def widths(self) -> Array:
        """Their widths along y (ny,) [mm]."""

    @property
    def with_material(self) -> Mask:
        """Which of them have material (ny,)."""


def edge_compliances(
    pair: GearPair, grids: Sequence[Slices], on_cells: Collection[int] = ()
) -> list[Array | InputError | None]:
    """Return :func:`edge_compliance` of many grids, found together; an error stands in the place of what raises it.

    Of edges whose images the cells have, by the numbers of ``edges/places.py``, the slices have what is left to the
    law: that images fade out, and what is taken off them in the middle of the tooth.
    """
    if not grids:
        return []
    slices, problems = SliceRow.of(grids), dict[int, InputError]()
    compliances = np.zeros(sum(one.y.size**2 for one in grids))
    for line in edges_from_slices(pair, grids):
        images_on_cells = line.number in on_cells
        if (near := NearEdge.of(pair, line, slices, everywhere=images_on_cells)) is None:
            continue
        for run, error in near.problems.items():
            problems.setdefault(int(slices.grid[near.near[near.first[run]]]), error)
        for at, under in near.pairs():
            image, place = near.image(at, under), slices.row[near.near[at]] + slices.column[near.near[under]]
            mean = image.mean * near.faded[at] * near.faded[under]
            if images_on_cells:
                mean -= near.at_surface(image)
            compliances[place] += mean * near.factor[near.run[at]]  # no pair stands there twice
    ends = np.cumsum([one.y.size**2 for one in grids])[:-1]
    matrices = [one.reshape(math.isqrt(one.size), -1) for one in np.split(compliances, ends)]
    return [problems.get(number, 0.5 * (one + one.T) if one.any() else None) for number, one in enumerate(matrices)]


class EdgeFromSlices(NamedTuple):
    """An edge of one gear, seen from the middles (n,) of the slices of all grids.

    Attributes
    ----------
    gear, edge : int
        Numbers: 0 pinion, 1 wheel, and that in ``REACHES``.
    rho, z, in_rho, in_z, distance : (n,) array
        Places on the flank, growth of the distance there, and distance [mm].
    """

    gear: int
    edge: int
    rho: Array
    z: Array
    in_rho: Array
    in_z: Array
    distance: Array

    @property
    def number(self) -> int:
        """Of the edge, among those of both gears."""
        return len(EDGE_NAMES) * self.gear + self.edge

    def angles(self, pair: GearPair, places: Indices) -> Array:
        """Angles (k,) [rad] of the material at the edge, beside some of the places."""
        flank, in_rho, in_z = (pair.pinion, pair.wheel)[self.gear].flank, self.in_rho[places], self.in_z[places]
        normal = outward_normal(sharp(flank), self.rho[places], self.z[places])
        cosine = (normal[:, 0] * in_rho + normal[:, 2] * in_z) / np.hypot(in_rho, in_z)
        return np.asarray(np.arccos(np.clip(cosine, -1.0, 1.0)))

    def factors(self, pair: GearPair, places: Indices) -> tuple[Array, dict[int, InputError]]:
        """Psi (k,) of the edge beside some of the places, zero where there is none and the reason."""
        gear, name = (pair.pinion, pair.wheel)[self.gear], ("pinion", "wheel")[self.gear]
        factor, problems = np.zeros(places.size), dict[int, InputError]()
        for number, angle in enumerate(self.angles(pair, places).tolist()):
            try:
                factor[number] = wedge_factor(angle, gear.material.poisson_ratio)
            except InputError as error:
                end_name = f"analysis.free_edges: {gear.flank.frame.edges[self.edge]} of the {name}"
                problems[number] = InputError(f"{end_name}: {problem}" for problem in error.problems)
        return factor, problems


def edges_from_slices(pair: GearPair, grids: Sequence[ContactGrid]) -> list[EdgeFromSlices]:
    """Edges of both gears that add to the deflection of slices."""
    return _edges_from(pair, np.concatenate([one.origin + one.y[:, None] * one.axes[1] for one in grids]))


def _edges_from(pair: GearPair, points: Array) -> list[EdgeFromSlices]:
    """The same from points (n, 3) of the fixed frame [mm]."""
    flanks, lines = (pair.pinion.flank, pair.wheel.flank), []
    for gear, (flank, (rho, z)) in enumerate(zip(flanks, pair.on_flanks(points), strict=True)):
        jets = flank.edges(rho, z)
        for edge in REACHES:
            in_rho, in_z = (np.broadcast_to(by, rho.shape) for by in (jets[edge].rho, jets[edge].z))
            lines.append(EdgeFromSlices(gear, edge, rho, z, in_rho, in_z, jets[edge].value / np.hypot(in_rho, in_z)))
    return lines


class FreeEnd(NamedTuple):
    """A free end of a gear, a straight line in the plane of a contact.

    Attributes
    ----------
    number : int
        Of the edge, among those of both gears.
    distance : float [mm]
        From a point to the end.
    direction : (2,) array
        Unit vector towards the end, along both axes of the plane.
    angle : float [rad]
        Of the material there.
    material : Material
    """

    number: int
    distance: float
    direction: Array
    angle: float
    material: Material


def free_ends(pair: GearPair, point: Array, axes: Array) -> list[FreeEnd]:
    """Free ends of both gears within reach of a point (3,) of the fixed frame [mm], in the plane of two axes (2, 3)."""
    step, ends = STEP * pair.module, []
    for line in _edges_from(pair, point + step * np.concatenate([np.zeros((1, 3)), axes, -axes])):
        distance, slope = float(line.distance[0]), (line.distance[3:] - line.distance[1:3]) / (2.0 * step)
        if abs(distance) < REACHES[line.edge] * pair.module:
            (angle,) = line.angles(pair, np.array([0])).tolist()
            steepness, material = math.hypot(*slope), (pair.pinion, pair.wheel)[line.gear].material
            ends.append(FreeEnd(line.number, distance / steepness, slope / steepness, angle, material))
    return ends


class SliceRow(NamedTuple):
    """Slices (n,) of all grids in one row.

    Attributes
    ----------
    grid, column : (n,) int array
        Number of the grid, and of the slice in it.
    row : (n,) int array
        Where its row begins if the matrices of all grids stand in one row.
    y, width : (n,) array [mm]
        Place along the contact, and width of the slice there.
    there : (n,) bool array
        Whether it has material.
    """

    grid: Indices
    column: Indices
    row: Indices
    y: Array
    width: Array
    there: Mask

    @classmethod
    def of(cls, grids: Sequence[Slices]) -> Self:
        """Of some grids."""
        size = np.array([one.y.size for one in grids])
        grid = np.repeat(np.arange(size.size), size)
        row = np.cumsum(size[grid]) - size[grid]
        y, width, there = (
            np.concatenate([getattr(one, name) for one in grids]) for name in ("y", "widths", "with_material")
        )
        return cls(grid, np.arange(grid.size) - (np.cumsum(size) - size)[grid], row, y, width, there)


@dataclass(frozen=True, eq=False)
class NearEdge:
    """Slices (n,) near an edge, grid after grid: runs (k,).

    Attributes
    ----------
    near : (n,) int array
        Which of all slices.
    run, before, after : (n,) int array
        The run of each, and the slices beside it in that run, of all slices.
    first, size, end : (k,) int array
        Of each run the first slice and their number, and the one of all slices that is nearest to the edge.
    factor : (k,) array
        Psi.
    problems : dict of int to InputError
        Of runs without it.
    y, width, distance, steepness : (n,) array
        Place along the contact and width of a slice, distance of its middle to the edge, its growth along y [mm, 1].
    reach, module : float [mm]
    material : Material
    """

    near: Indices
    run: Indices
    before: Indices
    after: Indices
    first: Indices
    size: Indices
    end: Indices
    factor: Array
    problems: dict[int, InputError]
    y: Array
    width: Array
    distance: Array
    steepness: Array
    reach: float
    module: float
    material: Material

    @classmethod
    def of(cls, pair: GearPair, line: EdgeFromSlices, slices: SliceRow, *, everywhere: bool = False) -> NearEdge | None:
        """Those near an edge, or all of them if asked; None if there are none."""
        distance, reach = line.distance, REACHES[line.edge] * pair.module
        near = (slices.there & (everywhere | (np.abs(distance) < reach))).nonzero()[0]
        if not near.size:
            return None
        _, first, size = np.unique(slices.grid[near], return_index=True, return_counts=True)
        end = near[np.lexsort((np.abs(distance[near]), slices.grid[near]))][first]
        run = np.repeat(np.arange(size.size), size)
        before = np.maximum(near - 1, near[first][run])
        after = np.minimum(near + 1, near[first + size - 1][run])
        y = slices.y[near]
        rise = risen(distance, slices.y, before, after)
        material = (pair.pinion, pair.wheel)[line.gear].material
        places = y, slices.width[near], distance[near], np.minimum(np.maximum(rise, -1.0), 1.0)
        psi = line.factors(pair, end)
        return cls(near, run, before, after, first, size, end, *psi, *places, reach, pair.module, material)

    def some(self, kept: Mask) -> NearEdge:
        """Some of the slices (n,), which lie and rise as they do among all."""
        runs, first, size = np.unique(self.run[kept], return_index=True, return_counts=True)
        problems = {number: self.problems[run] for number, run in enumerate(runs.tolist()) if run in self.problems}
        of_slices = ("near", "before", "after", "y", "width", "distance", "steepness")
        return replace(
            self,
            **{name: getattr(self, name)[kept] for name in of_slices},
            run=np.repeat(np.arange(runs.size), size),
            first=first,
            size=size,
            end=self.end[runs],
            factor=self.factor[runs],
            problems=problems,
        )

    def pairs(self) -> Iterator[tuple[Indices, Indices]]:
        """Every slice with each of its run, in parts."""
        yield from _pairs(self.first[self.run], self.size[self.run])

    @cached_property
    def inside(self) -> Array:
        """Distances (n,), of contacts on an edge, which are beside it by rounding or curve beyond it, none."""
        return np.maximum(self.distance, 0.0)

    @cached_property
    def faded(self) -> Array:
        """What counts (n,): from 1 at an edge to 0 at the end of its reach, without a kink."""
        part = np.minimum(self.inside / self.reach, 1.0)
        return np.asarray(1.0 - part**2 * (3.0 - 2.0 * part))

    @cached_property
    def nodes(self) -> Array:
        """Distances (3, n) of places in the slices, less than zero beyond the edge [mm]."""
        return np.asarray(self.distance + 0.5 * self.width * self.steepness * NODES[:, None])

    @cached_property
    def scales(self) -> tuple[float, float]:
        """Variation of psi over it, and displacement of the surface by the distance [mm^2/N]."""
        scale = VARIATION / quarter_space_factor(self.material.poisson_ratio)
        return scale, float(depth_displacement(np.asarray(0.0), np.asarray(1.0), self.material))

    def image(self, at: Indices, under: Indices) -> Image:
        """What slices (p,) are displaced by the images of others, for psi = 1 and without fading.

        The image of a slice is a straight line, so that 1/R has its mean over it in closed form; the mean over the
        slice that it displaces is taken at three places.
        """
        half, image, slope = 0.5 * self.width[under], self.inside[under], self.steepness[under]
        apart = (self.y[at] - self.y[under]) + 0.5 * self.width[at] * NODES[:, None]
        own, least = np.maximum(self.nodes[:, at], 0.0), (WIDTH * self.module) ** 2
        both, flat = own + image, 1.0 - slope**2
        along = apart * flat - both * slope  # of the place, from the middle of the image along it
        square = both**2 + apart**2 * flat + least
        off = np.sqrt(np.maximum(square - along**2, least))
        inverse = (np.arcsinh((half - along) / off) + np.arcsinh((half + along) / off)) / (2.0 * half)
        scale, surface = self.scales
        varied = 1.0 + scale * (4.0 * own * image / square - MEAN_PLACE)
        below = 1.0 + scale * (PLACE_BELOW - MEAN_PLACE)
        middle = depth_displacement(np.asarray(DEPTH * self.module), np.sqrt(square), self.material)
        mean = (0.5 * WEIGHTS) @ (varied * surface * inverse - below * middle)
        return Image(mean, own, image, slope, half, apart, along, square, off, inverse, varied, below)

    def at_surface(self, image: Image) -> Array:
        """What images displace the surface by (p,), nothing taken off in the middle of the tooth."""
        return np.asarray((0.5 * WEIGHTS) @ (image.varied * self.scales[1] * image.inverse))


class Image(NamedTuple):
    """What places (3, p) in slices see of the images of others (p,).

    Attributes
    ----------
    mean : (p,) array [mm/N]
        Displacement of the slices.
    own, square, along, off, inverse, varied : (3, p) array
        Distance of the places to the edge, that to the image squared and along and off its line, the mean of 1/R, the
        variation of psi.
    image, slope, half : (p,) array
        Distance to the edge, its growth along y, and half width of the slices with the force.
    apart : (3, p) array [mm]
        Of the places from them along y.
    below : float
        Variation of psi in the middle of the tooth.
    """

    mean: Array
    own: Array
    image: Array
    slope: Array
    half: Array
    apart: Array
    along: Array
    square: Array
    off: Array
    inverse: Array
    varied: Array
    below: float


def risen(values: Array, y: Array, before: Indices, after: Indices) -> Array:
    """Growth along y (..., n) of values (..., all slices) from the slices before to those after."""
    apart, rise = y[after] - y[before], values[..., after] - values[..., before]
    return np.divide(rise, apart, out=np.zeros(rise.shape), where=apart != 0.0)


def _pairs(first: Indices, count: Indices) -> Iterator[tuple[Indices, Indices]]:
    """Every place (n,) of a row with each of the ``count`` ones from the ``first`` of its run on, in parts."""
    ends = count.cumsum()
    borders = [0, *ends.searchsorted(np.arange(PAIRS, ends[-1], PAIRS)).tolist(), count.size]
    for start, stop in pairwise(borders):
        if start < stop:
            part, number = np.arange(start, stop), count[start:stop]
            begin = number.cumsum() - number
            yield part.repeat(number), np.arange(number.sum()) + (first[start:stop] - begin).repeat(number)


def edge_deflection_growth(
    pair: GearPair, grids: Sequence[Slices], forces: Array, moved: Sequence[MovedSlices]
) -> Array:
    """Growth (keys, n) [mm per unit] of the deflection of slices with forces by the free edges of both gears.

    Parameters
    ----------
    pair : GearPair
    grids : sequence of Slices
    forces : (n,) array [N]
        On the slices of all grids, in one row, as they are; where there are none, the growth is left out.
    moved : sequence of MovedSlices
        With each key.

    Raises
    ------
    InputError
        If a tooth ends at an edge sharper than 30 degrees.
    """
    slices, growth = SliceRow.of(grids), np.zeros((len(moved), forces.size))
    sides = [[edges_from_slices(*side) for side in one[:2]] for one in moved]
    for number, line in enumerate(edges_from_slices(pair, grids)):
        if (near := NearEdge.of(pair, line, slices)) is None:
            continue
        for error in near.problems.values():
            raise error
        near = near.some(forces[near.near] != 0.0)
        if not near.near.size:
            continue
        distances, factors = np.zeros((len(moved), forces.size)), np.zeros((len(moved), near.size.size))
        for key, ((low, high), one) in enumerate(zip(sides, moved, strict=True)):
            distances[key] = (high[number].distance - low[number].distance) / one.difference
            psi = [
                lines[number].factors(gears, near.end)[0]
                for lines, (gears, _) in zip((low, high), one[:2], strict=True)
            ]
            factors[key] = (psi[1] - psi[0]) / one.difference
        growth[:, near.near] += _deflection_growth(near, forces[near.near], distances, slices, factors)
    return growth


def _deflection_growth(near: NearEdge, forces: Array, distances: Array, slices: SliceRow, factors: Array) -> Array:
    """That of slices (keys, n) near one edge.

    By the growth of the distances of all slices (keys, all) [mm per unit] and of psi (keys, runs) [1 per unit].
    """
    means, growths = (
        np.concatenate(parts, axis=-1)
        for parts in zip(*(_image_growth(near, at, under) for at, under in near.pairs()), strict=True)
    )
    part = near.inside / near.reach
    fading = -6.0 * part * (1.0 - part) / near.reach * _counted(near.distance, near)
    closer = distances[:, near.near]
    steeper = risen(distances, slices.y, near.before, near.after) * (np.abs(near.steepness) < 1.0)
    deflections, ends = np.zeros((len(distances), near.near.size)), np.cumsum(near.size**2)
    for run, (first, size, end) in enumerate(zip(near.first, near.size, ends, strict=True)):
        own, block = slice(first, first + size), slice(end - size**2, end)
        mean, growth = means[block].reshape(size, size), growths[:, block].reshape(4, size, size)
        faded, force, psi = near.faded[own], forces[own], near.factor[run]
        growth = psi * growth * faded[:, None] * faded
        growth[0] += psi * mean * fading[own][:, None] * faded
        growth[2] += psi * mean * faded[:, None] * fading[own]
        for moved, at, under in ((closer[:, own], *growth[::2]), (steeper[:, own], *growth[1::2])):
            by_place = at + under.T
            deflections[:, own] += 0.5 * (moved * (by_place @ force) + (moved * force) @ by_place)
        whole = mean * faded[:, None] * faded
        deflections[:, own] += 0.5 * factors[:, run, None] * ((whole + whole.T) @ force)
    return deflections


def _image_growth(near: NearEdge, at: Indices, under: Indices) -> tuple[Array, Array]:
    """Displacements (p,) of slices by the images of others, for psi = 1 and without fading, and their growth (4, p).

    That by the distance of the slice displaced, by its growth along y, and by both of the slice with the force.
    """
    (scale, surface), of, weights = near.scales, near.image(at, under), 0.5 * WEIGHTS
    both = of.own + of.image
    low, high = (np.sqrt(of.off**2 + (of.half + sign * of.along) ** 2) for sign in (-1.0, 1.0))
    by_square = -4.0 * scale * of.own * of.image / of.square**2 * surface * of.inverse
    by_square = by_square - of.below * depth_displacement_slope(DEPTH * near.module, of.square, near.material)

    def grown(square: Array, along: Array) -> Array:
        """As the square of the distance, and the place along the image, grow."""
        off = (0.5 * square - of.along * along) / of.off
        first = (-along - (of.half - of.along) / of.off * off) / low
        second = (along - (of.half + of.along) / of.off * off) / high
        return np.asarray(by_square * square + of.varied * surface * (first + second) / (2.0 * of.half))

    even = grown(2.0 * both, np.broadcast_to(-of.slope, both.shape))
    steeper = grown(-2.0 * of.apart**2 * of.slope, -2.0 * of.apart * of.slope - both)
    by_place = 4.0 * scale / of.square * surface * of.inverse
    by_own = weights[:, None] * (even + by_place * of.image) * _counted(near.nodes[:, at], near)
    by_image = weights @ (even + by_place * of.own) * _counted(near.distance[under], near)
    along_own = (0.5 * near.width[at] * NODES[:, None] * by_own).sum(axis=0)
    return of.mean, np.stack([by_own.sum(axis=0), along_own, by_image, weights @ steeper])


def _counted(distance: Array, near: NearEdge) -> Array:
    """How much of the growth of a distance counts: all inside the edge, none beyond, half on it."""
    return 0.5 + 0.5 * np.sign(np.where(np.abs(distance) > ON_EDGE * near.module, distance, 0.0))
