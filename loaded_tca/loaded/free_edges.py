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

References
----------
Hetenyi 1960, J. Appl. Mech. 27, 289-296; Guilbault 2011, J. Tribol. 133, 031402 (one image and a factor).
``validation/contact/free_edge.py`` and ``validation/contact/free_block.py`` compare.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple, Protocol, Self

import numpy as np

from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.compliance.compliance import ContactGrid
from loaded_tca.compliance.half_space import depth_displacement
from loaded_tca.contact.edges import quarter_space_factor, wedge_factor
from loaded_tca.errors import InputError
from loaded_tca.flanks.base import outward_normal
from loaded_tca.flanks.rounding import sharp
from loaded_tca.material import Material
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.separation import Separation

DEPTH = 0.25 * math.pi
"""Of the middle of a tooth below its flank, over the module: half the thickness on the pitch circle."""
REACHES = {0: 0.5, 2: 3.0 * DEPTH, 3: 3.0 * DEPTH}
"""Distance over the module from which on an edge of a flank counts no more: of the tip edge, where bending knows the
tip from there on, and of both face ends. At the root a tooth goes on as the fillet."""
VARIATION, MEAN_PLACE, PLACE_BELOW = 0.4, 0.9, 0.5
"""psi(S) = psi + VARIATION (S - MEAN_PLACE), and the S that stands for all places in the middle of the tooth."""
WIDTH = 0.02
"""Distance across the contact that stands for its width, over the module. It is that of a half width of a twentieth
module, and matters within such a length from the end."""
PAIRS = 8192
"""Pairs of slices worked on at once; more do not fit the cache."""
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
    found = edge_compliances(pair, [separation])[0]
    if isinstance(found, InputError):
        raise found
    return found


class Slices(ContactGrid, Protocol):
    """Slices of a contact, side by side along y; those of a separation are all of one width."""

    @property
    def widths(self) -> Array:
        """Their widths along y (ny,) [mm]."""

    @property
    def with_material(self) -> Mask:
        """Which of them have material (ny,)."""


def edge_compliances(pair: GearPair, grids: Sequence[Slices]) -> list[Array | InputError | None]:
    """Return :func:`edge_compliance` of many grids, found together; an error stands in the place of what raises it."""
    points = np.concatenate([one.origin + one.y[:, None] * one.axes[1] for one in grids])
    there = np.concatenate([one.with_material for one in grids])
    slices, problems = _Slices.of(grids), dict[int, InputError]()
    radius, _, axial = pair.to_wheel(points)
    places = (np.hypot(points[:, 0], points[:, 1]), points[:, 2]), (radius, axial)
    found = np.zeros(sum(one.y.size**2 for one in grids))
    for name, gear, (rho, z) in zip(("pinion", "wheel"), (pair.pinion, pair.wheel), places, strict=True):
        jets = gear.flank.edges(rho, z)
        for edge, part in REACHES.items():
            in_rho, in_z = (np.broadcast_to(by, rho.shape) for by in (jets[edge].rho, jets[edge].z))
            distance, reach = jets[edge].value / np.hypot(in_rho, in_z), part * pair.module
            near = (there & (np.abs(distance) < reach)).nonzero()[0]
            if not near.size:
                continue
            numbers, first, count = np.unique(slices.grid[near], return_index=True, return_counts=True)
            end = near[np.lexsort((np.abs(distance[near]), slices.grid[near]))][first]  # of each grid, the nearest one
            normal, slope = outward_normal(sharp(gear.flank), rho[end], z[end]), np.hypot(in_rho[end], in_z[end])
            cosine = (normal[:, 0] * in_rho[end] + normal[:, 2] * in_z[end]) / slope
            factor = np.zeros(count.size)
            for run, angle in enumerate(np.arccos(np.clip(cosine, -1.0, 1.0)).tolist()):
                try:
                    factor[run] = wedge_factor(angle, gear.material.poisson_ratio)
                except InputError as error:
                    end_name = f"analysis.free_edges: {gear.flank.frame.edges[edge]} of the {name}"
                    told = InputError(f"{end_name}: {problem}" for problem in error.problems)
                    problems.setdefault(int(numbers[run]), told)
            runs = _Runs(near, first, count, factor)
            _add(found, slices, runs, distance, reach, pair.module, gear.material)
    ends = np.cumsum([one.y.size**2 for one in grids])[:-1]
    matrices = [one.reshape(math.isqrt(one.size), -1) for one in np.split(found, ends)]
    return [problems.get(number, 0.5 * (one + one.T) if one.any() else None) for number, one in enumerate(matrices)]


class _Slices(NamedTuple):
    """Slices (n,) of all grids in one row.

    Attributes
    ----------
    grid, column : (n,) int array
        Number of the grid, and of the slice in it.
    row : (n,) int array
        Where its row begins if the matrices of all grids stand in one row.
    y, width : (n,) array [mm]
        Place along the contact, and width of the slice there.
    """

    grid: Indices
    column: Indices
    row: Indices
    y: Array
    width: Array

    @classmethod
    def of(cls, grids: Sequence[Slices]) -> Self:
        size = np.array([one.y.size for one in grids])
        grid = np.repeat(np.arange(size.size), size)
        row = np.cumsum(size[grid]) - size[grid]
        y, width = (np.concatenate([getattr(one, name) for one in grids]) for name in ("y", "widths"))
        return cls(grid, np.arange(grid.size) - (np.cumsum(size) - size)[grid], row, y, width)


class _Runs(NamedTuple):
    """Slices ``near`` (n,) an edge, grid after grid: where each grid (k,) begins, how many it has, and its psi."""

    near: Indices
    first: Indices
    size: Indices
    factor: Array


def _add(
    found: Array, slices: _Slices, runs: _Runs, distance: Array, reach: float, module: float, material: Material
) -> None:
    """Add to ``found``, matrices in one row [mm/N], what an edge at distances (n,) adds to the slices near it.

    The image of a slice is a straight line, so that 1/R has its mean over it in closed form; the mean over the slice
    that it displaces is taken at three places.
    """
    near, run = runs.near, np.repeat(np.arange(runs.size.size), runs.size)
    begin, end = near[runs.first][run], near[runs.first + runs.size - 1][run]
    before, after = np.maximum(near - 1, begin), np.minimum(near + 1, end)
    y, width, distance_there = slices.y[near], slices.width[near], distance[near]
    apart = slices.y[after] - slices.y[before]
    rise = np.divide(distance[after] - distance[before], apart, out=np.zeros(apart.shape), where=apart != 0.0)
    rise = np.minimum(np.maximum(rise, -1.0), 1.0)
    inside = np.maximum(distance_there, 0.0)  # a contact on an edge is beside it by rounding, or curves beyond it
    part = inside / reach
    faded = 1.0 - part**2 * (3.0 - 2.0 * part)  # from 1 at an edge to 0 at the end of its reach, without a kink
    own = np.maximum(distance_there + 0.5 * width * rise * NODES[:, None], 0.0)  # (3, n), in the slice displaced
    scale = VARIATION / quarter_space_factor(material.poisson_ratio)
    surface = depth_displacement(np.asarray(0.0), np.asarray(1.0), material)
    for at, under in _pairs(runs.first[run], runs.size[run]):
        half, image, slope = 0.5 * width[under], inside[under], rise[under]
        apart = (y[at] - y[under]) + 0.5 * width[at] * NODES[:, None]
        both, flat = own[:, at] + image, 1.0 - slope**2
        along = apart * flat - both * slope  # of the place, from the middle of the image along it
        square = both**2 + apart**2 * flat + (WIDTH * module) ** 2
        off = np.sqrt(np.maximum(square - along**2, (WIDTH * module) ** 2))
        inverse = (np.arcsinh((half - along) / off) + np.arcsinh((half + along) / off)) / (2.0 * half)
        varied = 1.0 + scale * (4.0 * own[:, at] * image / square - MEAN_PLACE)
        below = 1.0 + scale * (PLACE_BELOW - MEAN_PLACE)
        middle = depth_displacement(np.asarray(DEPTH * module), np.sqrt(square), material)
        mean = (0.5 * WEIGHTS) @ (varied * surface * inverse - below * middle)
        place = slices.row[near[at]] + slices.column[near[under]]
        found[place] += mean * runs.factor[run[at]] * faded[at] * faded[under]  # no pair stands there twice


def _pairs(first: Indices, count: Indices) -> Iterator[tuple[Indices, Indices]]:
    """Every place (n,) of a row with each of the ``count`` ones from the ``first`` of its run on, in parts."""
    ends = np.cumsum(count)
    for part in np.split(np.arange(count.size), np.searchsorted(ends, np.arange(PAIRS, ends[-1], PAIRS))):
        if part.size:
            number = count[part]
            begin = np.cumsum(number) - number
            yield np.repeat(part, number), np.arange(number.sum()) + np.repeat(first[part] - begin, number)
