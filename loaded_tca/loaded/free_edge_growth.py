r"""Growth of the deflection by free edges as slices move towards them, under forces as they are.

The derivative of :mod:`loaded_tca.loaded.free_edges` by the distances d of the slices to an edge, by the growth of d
along the slices, and by psi. What the keys of a scene have in common is found once: each moves the slices by distances
of its own. Where a slice lies on an edge, beyond which distances count no more, half of the derivative stands: the mean
of those to both sides.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from loaded_tca.arrays import Array, Indices
from loaded_tca.compliance.flexibility import depth_displacement_slope
from loaded_tca.loaded.free_edges import DEPTH, NODES, WEIGHTS, NearEdge, SliceRow, Slices, edge_lines, risen
from loaded_tca.pairs.gear_pair import GearPair

ON_EDGE = 1e-9
"""Distance over the module at which a slice lies on an edge."""


class MovedSlices(NamedTuple):
    """Pairs of gears and slices of all grids a step below and above a value of a key, and the step between."""

    low: tuple[GearPair, Sequence[Slices]]
    high: tuple[GearPair, Sequence[Slices]]
    difference: float


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
    sides = [[edge_lines(*side) for side in one[:2]] for one in moved]
    for number, line in enumerate(edge_lines(pair, grids)):
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
