"""Where the nodes of a gear body stand: the layout laid over the complete tooth, section by section.

Everything is drawn in the images of the sections, in polar coordinates, for all sections at once: arrays end with the
axis of the sections. Rows of the tooth join points of equal height on both flanks; towards the root they sag, so that
they meet the fillets under open angles. Columns of the rim are radial.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy

from loaded_tca.arrays import Array, Indices
from loaded_tca.compliance.layout import MeshDensity, RingLayout, SectorLayout
from loaded_tca.errors import InputError
from loaded_tca.roots import find_roots
from loaded_tca.tooth.fillet import Sections, in_space, lengths_along, polar
from loaded_tca.tooth.surface import ToothSurface

ROUNDING = 1e-15
"""Of lengths that are roots, over the size of a gear or a tooth."""

FILLET_SHARE = 0.5
"""Part of the fillet that belongs to the tooth; the rest to the columns of the space."""
TURNING = 0.75
"""Part of the measure along a fillet that is how far its tangent turns, below thin layers; the rest is its length."""
SAG = 0.2
"""Sag of the lowest row of the tooth over its width."""
SHALLOW = 0.3
"""The same at most over the depth of the rim."""
GROWTH, MOST_GROWTH = 1.8, 30.0
"""Each layer of the rim is so much thicker than the one above; at most, where the uppermost has its own thickness."""
LARGEST_RATIO = 1.6
"""Outer over inner radius of an element at the bore. Displacements in a twisted ring go with r and 1/r, of which one
quadratic element takes off 0.06 % of the twist at this ratio, 0.25 % at 2, 5 % at 5.5; default bores need no cut."""
HOLE = 0.1
"""Free hole in the core of a solid gear, over the diameter of its journals: the mesh is a ring."""
SHORTEST_LAND = 0.05
"""Half of the root land over the way from the end of the tooth's rows to the middle of the space: the end of the fillet
is followed by no edge of elements where it is shorter."""
SHARP = math.pi / 3.0
"""Bend of an edge between its halves from which it is made straight; 29 deg on usual teeth. With fewer elements
along a foot they bend more, to 66 where one folded; made straight, that made a face-milled pinion 4 % too stiff."""


@dataclass(frozen=True, eq=False)
class BodyNodes:
    """Nodes of a ring in the images of its sections, NaN where there are none.

    Attributes
    ----------
    layout : RingLayout
    sections : Sections
    coordinate : (k,) array [mm]
        Which sections.
    radius, angle : (columns, rows, k) array [mm], [rad]
        Polar coordinates of the images.
    outline : (n, k, 3) array [mm]
        Of the tooth between which the nodes were drawn, finer than they are.
    """

    layout: RingLayout
    sections: Sections
    coordinate: Array
    radius: Array
    angle: Array
    outline: Array

    @property
    def points(self) -> Array:
        """Nodes (columns, rows, k, 3) in the gear's frame [mm]."""
        return in_space(self.sections, self.radius, self.angle, self.coordinate)


@dataclass(frozen=True, eq=False)
class _Side:
    """One side of a tooth in the images, radius and angle (n, k): the flank from its root up, the foot on down.

    The foot is the fillet, then half the root land; ``length`` (n, k) [mm] runs along it. So does ``measure`` (n, k),
    to 1 at the end of the fillet: with the length or, where elements are to follow sharp fillets, mostly with how far
    the tangent turns.
    """

    flank: tuple[Array, Array]
    foot: tuple[Array, Array]
    length: Array
    measure: Array

    def on_flank(self, height: Array) -> tuple[Array, Array]:
        """Radius and angle (n, k) at parts (n,) of the flank's height."""
        radius, angle = self.flank
        wanted = radius[0] + height[:, None] * (radius[-1] - radius[0])
        return wanted, _interpolated(wanted, radius, angle)

    def on_foot(self, part: Array) -> tuple[Array, Array]:
        """Radius and angle (n, k): part 0 is the flank, 1 the end of the tooth's rows, 2 the middle of the space."""
        part, whole = part[:, None], self.measure[-1]
        lower = FILLET_SHARE + (part - 1.0) * (whole - FILLET_SHARE)
        return self._at_measure(np.where(part <= 1.0, part * FILLET_SHARE, lower))

    def beyond_tooth(self, density: MeshDensity) -> tuple[Array, Array]:
        """Radius and angle (n, k) of nodes from the end of the tooth's rows to the middle of the space.

        Below thin layers the fillet ends between two elements, where there is a root land: stress has a bend there.
        """
        whole = self.measure[-1]
        root_land = (whole - 1.0) / (whole - FILLET_SHARE)
        part = np.linspace(0.0, 1.0, 2 * density.land + 1)
        if density.skin == 0.0 or density.land == 1 or root_land.min() < SHORTEST_LAND:
            return self.on_foot(1.0 + part)
        count = min(max(1, round(density.land * float(root_land.mean()))), density.land // 2)
        on_fillet = np.linspace(FILLET_SHARE, 1.0, 2 * (density.land - count) + 1)[:, None]
        beyond = 1.0 + np.linspace(0.0, 1.0, 2 * count + 1)[1:, None] * (whole - 1.0)
        return self._at_measure(np.concatenate([on_fillet + 0.0 * whole, beyond]))

    def _at_measure(self, measure: Array) -> tuple[Array, Array]:
        """Radius and angle (n, k) of corners of elements at values of the measure, of others half way between these."""
        length = _interpolated(measure, self.measure, self.length)
        length[1::2] = 0.5 * (length[:-1:2] + length[2::2])
        radius, angle = (_interpolated(length, self.length, values) for values in self.foot)
        return radius, angle


def body_nodes(tooth: ToothSurface, sections: Sections, bore_radius: Array, layout: RingLayout) -> BodyNodes:
    """Nodes of a whole ring.

    Parameters
    ----------
    tooth : ToothSurface
        Finely resolved, with 2 lengthwise + 1 sections.
    sections : Sections
        Those that the tooth was built of.
    bore_radius : (k,) array [mm]
        Distance from the axis at which each section meets the bore, or the journals.
    layout : RingLayout

    Raises
    ------
    InputError
        If the sections are not those of the layout.
    """
    outline = tooth.outline
    wanted = 2 * layout.density.lengthwise + 1
    if outline.shape[1] != wanted:
        raise InputError(f"tooth: {outline.shape[1]} sections, {wanted} are needed")
    rho, z = np.hypot(outline[..., 0], outline[..., 1]), outline[..., 2]
    coordinate = sections.coordinate(rho[0], z[0])
    images = sections.radius(rho, z), np.unwrap(np.arctan2(outline[..., 1], outline[..., 0]), axis=0)
    lowest = images[0].min(axis=0)

    circles = np.broadcast_to(bore_radius, lowest.shape)

    def beyond_bore(image: Array, section: Indices) -> Array:
        return sections.point(image, coordinate[section])[0] - circles[section]

    ends, every = np.array([0.0 * lowest, lowest]), np.arange(len(lowest))
    values = np.array([beyond_bore(end, every) for end in ends])
    bore = find_roots(beyond_bore, ends, values, ROUNDING * float(lowest.max()))
    radius, angle = np.full((2, *layout.shape, len(coordinate)), np.nan)
    unlike = {sector.density: sector for sector in layout.sectors}
    blocks = {}
    for density, sector in unlike.items():
        by_turning = TURNING if density is not None and density.skin else 0.0
        sides = _side(tooth, images, 1, by_turning), _side(tooth, images, -1, by_turning)
        blocks[density] = _sector(sector, layout, sides, bore)
    for sector in layout.sectors:
        turn = 2.0 * math.pi / tooth.teeth * sector.number
        columns = slice(sector.first, sector.first + 2 * sector.columns)
        block = blocks[sector.density]
        radius[columns], angle[columns] = block[0][:-1], block[1][:-1] + turn
    return BodyNodes(layout, sections, coordinate, radius, angle, outline)


def _side(tooth: ToothSurface, outline: tuple[Array, Array], sign: int, by_turning: float) -> _Side:
    """One side of the outline, from the root of its flank up and down; its fillet measured in part by turning."""
    joints = tooth.joints if sign > 0 else tuple(len(tooth.outline) - 1 - joint for joint in tooth.joints[::-1])
    radius, angle = outline if sign > 0 else (outline[0][::-1], outline[1][::-1])
    flank, foot = slice(joints[4], joints[5] + 1), slice(joints[5], None)
    place, end = polar(radius[foot], angle[foot]), joints[6] - joints[5]
    length = lengths_along(place)
    measure = length / length[end]
    step = np.diff(place, axis=0)
    direction = np.unwrap(np.arctan2(step[..., 1], step[..., 0]), axis=0)
    turn = np.abs(np.diff(direction[:end], axis=0))
    turned = np.concatenate([np.zeros_like(turn[:1]), np.cumsum(turn, axis=0), turn.sum(axis=0)[None]])
    measure[: end + 1] += by_turning * (turned / turned[-1] - measure[: end + 1])
    ends = (radius[flank][::-1], angle[flank][::-1]), (radius[foot], angle[foot])
    return _Side(*ends, length, measure)


def _sector(sector: SectorLayout, layout: RingLayout, sides: tuple[_Side, _Side], bore: Array) -> tuple[Array, Array]:
    """Radius and angle (columns, rows, k) of one pitch, both ends included."""
    density, rows = sector.density, layout.shape[1]
    radius, angle = np.full((2, 2 * sector.columns + 1, rows, len(bore)), np.nan)
    if density is None:
        ends = [side.on_foot(np.array([2.0])) for side in sides]
        part = np.array([0.0, 0.5, 1.0])[:, None]
        top = tuple(ends[1][n] + part * (ends[0][n] - ends[1][n]) for n in range(2))
    else:
        block = _tooth(density, sides, bore)
        columns = slice(2 * density.land, 2 * (density.land + density.through) + 1)
        filled = slice(layout.base_row, layout.base_row + block[0].shape[1])
        radius[columns, filled], angle[columns, filled] = block
        right, left = (_without_folds(*side.beyond_tooth(density)) for side in sides)
        top = tuple(np.concatenate([left[n][::-1], block[n][:, 0], right[n]]) for n in range(2))
    filled = slice(0, layout.base_row + 1)
    part = np.linspace(HOLE, 1.0, 2 * layout.core + 1)[:-1, None]
    core = np.broadcast_to(part * bore, (len(radius), *part.shape[:1], len(bore)))
    radius[:, filled] = np.concatenate([core, _rim(top[0], bore, layout)], axis=1)
    angle[:, filled] = top[1][:, None]
    return radius, angle


def _without_folds(radius: Array, angle: Array) -> tuple[Array, Array]:
    """Radius and angle (2 m, k) of the nodes of m elements along a foot, the first one left off.

    An edge that bends too much, at a sharp fillet, is made straight: its element would fold over.
    """
    place = radius * np.exp(1j * angle)
    steps = np.diff(place, axis=0)
    bend = np.abs(np.angle(steps[1::2] * np.conj(steps[::2])))
    place[1::2] = np.where(bend > SHARP, 0.5 * (place[:-1:2] + place[2::2]), place[1::2])
    return np.abs(place[1:]), angle[1:] + np.angle(place[1:] * np.exp(-1j * angle[1:]))


def _tooth(density: MeshDensity, sides: tuple[_Side, _Side], bore: Array) -> tuple[Array, Array]:
    """Radius and angle (columns, rows, k) of a tooth, from its lowest row up."""
    below = np.linspace(1.0, 0.0, 2 * density.fillet + 1)
    up = np.linspace(0.0, 1.0, 2 * density.flank + 1)[1:]
    right, left = (
        tuple(np.concatenate(both) for both in zip(side.on_foot(below), side.on_flank(up), strict=True))
        for side in sides
    )
    across = _graded(density)[:, None, None]
    angle = left[1] + across * (right[1] - left[1])
    width = 0.5 * (left[0] + right[0]) * (right[1] - left[1])
    deepest = np.minimum(SAG * width[0], SHALLOW * (np.minimum(left[0][0], right[0][0]) - bore))
    sag = np.concatenate([below, 0.0 * up])[:, None] * deepest
    if density.skin:  # rows are far apart where the fillet is straight: as much of the sag lies between them
        drop = left[0] + right[0] - left[0][2 * density.fillet] - right[0][2 * density.fillet]
        sag = np.maximum(drop / drop[0], 0.0) * deepest
    radius = left[0] + across * (right[0] - left[0]) - 4.0 * across * (1.0 - across) * sag
    return radius, angle


def _graded(density: MeshDensity) -> Array:
    """Parts of the thickness of the tooth at which its columns of nodes stand, middles of elements among them."""
    layer = np.arange(density.through)
    thickness = density.grading ** np.minimum(layer, layer[::-1])
    corners = np.append(0.0, np.cumsum(thickness)) / thickness.sum()
    return np.interp(np.arange(2 * density.through + 1), 2 * np.arange(density.through + 1), corners)


def rim_growth(root: Array, bore: Array, density: MeshDensity, teeth: int) -> float:
    """Thickness of each layer of a rim over that of the one above; radii (k,) of root and bore in one section [mm]."""
    if density.skin == 0.0:
        return GROWTH
    part = density.skin * 2.0 * math.pi / teeth / float((1.0 - bore / root).mean())
    powers = np.arange(density.rim)
    if part * density.rim >= 1.0:
        return 1.0
    growth = scipy.optimize.brentq(lambda growth: part * (growth**powers).sum() - 1.0, 1.0, MOST_GROWTH)
    return round(growth, 6)  # equal gears have equal layouts


def cuts_at_bore(root: Array, bore: Array, layers: int, growth: float) -> int:
    """Layers of at most the largest ratio of radii that the lowest layer of a rim is cut into; radii (k,) [mm]."""
    lowest = growth ** (layers - 1) / (growth ** np.arange(layers)).sum()
    ratio = 1.0 + lowest * float((root / bore).max() - 1.0)
    return max(1, math.ceil(math.log(ratio) / math.log(LARGEST_RATIO)))


def _rim(top: Array, bore: Array, layout: RingLayout) -> Array:
    """Radii (columns, rows, k) from the bore to the tops (columns, k), in layers that grow inwards.

    The lowest is cut in equal ratios of the radius.
    """
    layers, cuts = layout.density.rim, layout.cuts
    above = layers - 0.5 * np.arange(2 * layers + 1)
    growth = layout.growth
    part = (growth**above - 1.0) / (growth**layers - 1.0) if growth != 1.0 else above / layers
    radius = top[:, None] - part[:, None] * (top - bore)[:, None]
    if cuts == 1:
        return radius
    up = np.linspace(0.0, 1.0, 2 * cuts + 1)[:, None]
    return np.concatenate([bore * (radius[:, 2:3] / bore) ** up, radius[:, 3:]], axis=1)


def _interpolated(wanted: Array, places: Array, values: Array) -> Array:
    """Values (n, k) at places (n, k), between those of increasing places (m, k)."""
    columns = [np.interp(wanted[:, k], places[:, k], values[:, k]) for k in range(places.shape[1])]
    return np.stack(columns, axis=-1)


def tangent_angles(nodes: BodyNodes, side: int, lowest: Indices, ends: Indices, part: Array, planes: Indices) -> Array:
    """Angles (n, m) between the middle of tooth 0 and its profile, at parts (n,) of edges of elements on one side."""
    density, first = nodes.layout.density, nodes.layout.sector(0).first
    row = nodes.layout.base_row + 2 * density.fillet + density.flank  # half way up the flank
    middle = nodes.angle[first + 2 * density.land + density.through, row, planes]
    node = lowest[:, None] + ends[:, :1] * 2 + np.arange(3)[:, None] * (ends[:, 1:] - ends[:, :1])  # (n, 3, 2)
    columns, rows = node[..., 0] % nodes.layout.shape[0], node[..., 1]
    place = polar(nodes.radius[columns, rows][..., planes], nodes.angle[columns, rows][..., planes] - middle)
    slopes = np.stack([4.0 * part - 3.0, 4.0 - 8.0 * part, 4.0 * part - 1.0])  # of the quadratic shape functions
    along = np.einsum("in,nimx->nmx", slopes, place)
    return np.arctan2(side * along[..., 1], -along[..., 0])
