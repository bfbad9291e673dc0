r"""Change of the gap of two flanks with a key of the scene, where the common normal meets each flank.

A flank stands where F = theta - Theta vanishes. If Theta grows by dTheta and the gear moves by dr, the point on the
normal n moves along it by

.. math:: ds = \frac{d\Theta + \nabla F \cdot dr}{\nabla F \cdot n},
          \qquad dh = ds_\text{wheel} - ds_\text{pinion},

with no flank met anew. For a modification of the shape f, dTheta = -s f |grad F_nominal| da: only the terms that
the key changes are computed. Of fitted and measured flanks and of machine settings dTheta is the central difference
of Theta between the flanks a step either side, and dr that of the places of the wheel. Theta is an explicit function,
linear in nearly every amount, so that the difference is the derivative to about 1e-9.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.edges.places import dilated
from loaded_tca.flanks.base import EDGE_NAMES
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.separation.arcs import cells_on_arcs
from loaded_tca.separation.contact_points import PointChanges, point_changes
from loaded_tca.separation.normal_gap import TOGETHER, NormalGap
from loaded_tca.separation.pair_change import (
    MOTIONS,
    PLACES_OF_BORDER,
    BorderCells,
    PairChange,
    Places,
    following,
    grid_motions,
    grown,
    rises,
)
from loaded_tca.separation.sample import Separation
from loaded_tca.unloaded import ContactPoint

OF_GRIDS = MOTIONS + 3
"""Motions of a grid: in its plane, tilts of its normal along x and y, along the normal."""

LITTLE_BY_MOTION = 1e-3
"""Mean square of the growth of gaps by a motion of their grid along one way, over that by both: none."""


@dataclass(frozen=True, eq=False)
class ContactChanges:
    """Derivatives of many contacts on grids that are held.

    Attributes
    ----------
    gaps : (keys, n) array [mm per unit of the key]
        Growth of the gaps at chosen cells of all grids, in one row, the wheel turned back into contact.
    tilt_slopes : (n, 2) array [mm/rad]
        Growth of the gaps as the normals of the grids tilt along x and y.
    lever_parts : (n,) array
        Lever of the wheel's flank at each cell over that at the contact point of its grid: how much it moves if the
        wheel is turned.
    slopes : (n, 3) array [1, 1, mm/rad]
        Growth of the gaps by the motion of the grids along x and y, and by their turn from x to y.
    contact : (n,) int array
        That each cell belongs to.
    border : BorderCells
        Cells in which an edge runs.
    at_points : PointChanges
        At the contact points.
    moves_edges : (keys,) bool array
        Whether a key moves the edges of flanks by more than it removes.
    arcs : BorderCells
        Cells that lie on the arc of a rounded edge, or have one beside them that does.
    """

    gaps: Array
    tilt_slopes: Array
    lever_parts: Array
    slopes: Array
    contact: Indices
    border: BorderCells
    at_points: PointChanges
    moves_edges: Mask
    arcs: BorderCells

    @property
    def held_gaps(self) -> Array:
        """Growth of the gaps (keys, n) with both gears held at their angles [mm per unit of the key]."""
        return np.asarray(self.gaps + self.at_points.gaps[:, self.contact] * self.lever_parts)

    def followed(self, forces: Array, separations: Sequence[Separation]) -> MovedContacts:
        """On grids that follow their contacts, the wheel turned back into contact.

        Parameters
        ----------
        forces : (n,) array
            On the cells.
        separations : sequence of Separation
            The grid of each contact.
        """
        border, points = self.border, self.at_points
        parts = forces / np.bincount(self.contact, forces)[self.contact]
        scales = np.array([(*one.spacing, 4.0 * one.spacing[0] / (one.y.size * one.spacing[1])) for one in separations])
        motions = np.zeros((*points.gaps.shape, OF_GRIDS))
        # a modification moves contacts by little: their grids stay, but where they lie on the start of a relief
        motions[..., 0] = np.where(points.held, points.across, 0.0)
        edges = np.flatnonzero(self.moves_edges)
        motions[edges, :, MOTIONS:-1], motions[edges, :, -1] = points.tilts[edges], points.lifts[edges]
        gaps, covers = self.gaps.copy(), np.zeros(self.gaps.shape)
        for key in edges.tolist():
            gaps[key] += (points.tilts[key, self.contact] * self.tilt_slopes).sum(axis=-1)
        plane, lines = motions[..., :MOTIONS], border.of_keys(edges).with_others(self.arcs.of_keys(edges))
        plane[edges, :, :2], open_to = self._with_gaps(gaps[edges], points.shifts[edges], scales[:, :2])
        plane[edges] = following(lines, self.contact[lines.cell], parts[lines.cell], plane[edges], open_to, scales)
        moved = plane.any(axis=(1, 2))
        for key in np.flatnonzero(moved).tolist():
            gaps[key] += (plane[key, self.contact] * self.slopes).sum(axis=-1)
        by_motion = (plane[:, self.contact[border.cell]] * border.slopes).sum(axis=-1)
        of_edges = np.flatnonzero(self.moves_edges | moved)
        covers[np.ix_(of_edges, border.cell)] = (self.moves_edges[:, None] * border.rates + by_motion)[of_edges]
        return MovedContacts(gaps, covers, motions)

    def _with_gaps(self, gaps: Array, shifts: Array, scales: Array) -> tuple[Array, Array]:
        """Motions (keys, contacts, 2) of grids along x and y by which gaps change least, but for a part in common.

        ``gaps`` (keys, n) grow by the keys on grids that stay; ``shifts`` (keys, contacts, 2) of the contact points are
        the motions along which gaps do not change; ``scales`` (contacts, 2) are the widths of cells. Also the quadratic
        forms (contacts, 3, 3), in those and turns, of what other motions cost: where edges hold contact points, that by
        which gaps change more, so that grids go along the edges with the gap.
        """
        open_to = np.tile(np.eye(MOTIONS), (len(scales), 1, 1))
        if not self.contact.size:
            return shifts, open_to
        first = np.searchsorted(self.contact, np.arange(len(scales)))

        def means(values: Array) -> Array:
            """Of each contact (contacts, ...), of values (n, ...)."""
            sums, counts = np.add.reduceat(values, first), np.diff([*first, self.contact.size])
            return np.asarray(sums / counts.reshape(-1, *[1] * (values.ndim - 1)))

        slopes = self.slopes[:, :2] * scales[self.contact]
        slopes -= means(slopes)[self.contact]
        matrix = means(slopes[:, :, None] * slopes[:, None])
        size = np.trace(matrix, axis1=1, axis2=2)[:, None]
        little = np.where(size > 0.0, LITTLE_BY_MOTION * size, 1.0)  # a single cell has no gap to go with
        matrix = matrix + little[..., None] * np.eye(2)
        forms, on_edges = matrix / np.where(size > 0.0, size, 1.0)[..., None], self.at_points.held
        open_to[on_edges, :2, :2] = forms[on_edges]  # others give way to edges by as few cells as possible
        solved, motions = np.linalg.inv(matrix), np.zeros(shifts.shape)
        for key, growth in enumerate(gaps):
            wanted = little * shifts[key] / scales - means(slopes * growth[:, None])
            motions[key] = (solved @ wanted[..., None])[..., 0] * scales
        return motions, open_to


@dataclass(frozen=True, eq=False)
class MovedContacts:
    """Derivatives of many contacts on grids that follow them.

    Attributes
    ----------
    gaps : (keys, n) array [mm per unit of the key]
        Growth of the gaps, the wheel turned back into contact.
    covers : (keys, n) array [1 per unit of the key]
        Growth of the parts of the cells that have material.
    motions : (keys, contacts, 6) array [mm, mm, rad, rad, rad, mm per unit of the key]
        Of the grids along their x and y, their turn from x to y, the growth of their normal along x and y, their motion
        along the normal.
    """

    gaps: Array
    covers: Array
    motions: Array


def contact_changes(
    pair: GearPair,
    contacts: Sequence[ContactPoint],
    separations: Sequence[Separation],
    cells: Sequence[Mask],
    changes: Sequence[PairChange],
) -> ContactChanges:
    """Derivatives of contacts to keys of the scene.

    Parameters
    ----------
    pair : GearPair
    contacts : sequence of ContactPoint
        Whose gears are held at their angles.
    separations : sequence of Separation
        The grid of each.
    cells : sequence of (nx, ny) bool array
        Cells of each grid that are asked for, all with material.
    changes : sequence of PairChange

    Returns
    -------
    ContactChanges
    """
    met = _Met(pair, contacts, separations, changes)
    places = [np.nonzero(one) for one in cells]
    contact = np.repeat(np.arange(len(places)), [across.size for across, _ in places])
    x, y = (
        np.concatenate([getattr(grid, name)[place[axis]] for grid, place in zip(separations, places, strict=True)])
        for axis, name in enumerate("xy")
    )
    gaps, lever_parts = np.zeros((len(changes), contact.size)), np.zeros(contact.size)
    tilt_slopes, slopes = np.zeros((contact.size, 2)), np.zeros((contact.size, MOTIONS))
    for first in range(0, contact.size, TOGETHER):
        part = slice(first, first + TOGETHER)
        at, lever_parts[part] = met.at(contact[part], x[part], y[part])
        gaps[:, part], tilt_slopes[part], slopes[part] = at.gaps, at.tilt_slopes, at.gap_slopes
    spacings = np.array([one.spacing for one in separations])

    def beside(cell: Indices) -> Places:
        """Middles of cells, then those of the ones on both sides across, then those of the ones on both along."""
        (dx, dy), none = spacings[contact[cell]].T, np.zeros(cell.size)
        steps = np.concatenate([none, -dx, dx, none, none]), np.concatenate([none, none, none, -dy, dy])
        count = PLACES_OF_BORDER
        middles = np.tile(x[cell], count) + steps[0], np.tile(y[cell], count) + steps[1]
        return met.at(np.tile(contact[cell], count), *middles)[0]

    near = np.concatenate([dilated(grid.cover < 1.0)[own] for grid, own in zip(separations, cells, strict=True)])
    on_arcs = np.concatenate([_near_arcs(pair, *one) for one in zip(separations, cells, strict=True)])
    cell, of_arcs = np.flatnonzero(near), np.flatnonzero(on_arcs.any(axis=-1))
    border = BorderCells.of(pair, beside(cell), cell, changes)
    arcs = BorderCells.of_arcs(pair, beside(of_arcs), of_arcs, on_arcs[of_arcs], changes)
    moves_edges = np.array([not change.of_modifications for change in changes], dtype=bool)
    return ContactChanges(gaps, tilt_slopes, lever_parts, slopes, contact, border, met.at_points, moves_edges, arcs)


def _near_arcs(pair: GearPair, grid: Separation, cells: Mask) -> Mask:
    """Edges (n, 8) on whose arcs cells of a grid lie, or cells beside them."""
    near = np.zeros((np.count_nonzero(cells), 2 * len(EDGE_NAMES)), dtype=bool)
    if pair.sharp is not pair:
        on = cells_on_arcs(pair, grid, dilated(cells))
        for edge in np.flatnonzero(on.any(axis=(0, 1))).tolist():
            near[:, edge] = dilated(on[..., edge])[cells]
    return near


class _Met:
    """What the normals of contacts meet at places of their grids, the wheels turned back into contact."""

    def __init__(
        self,
        pair: GearPair,
        contacts: Sequence[ContactPoint],
        separations: Sequence[Separation],
        changes: Sequence[PairChange],
    ) -> None:
        axes = np.array([one.axes for one in separations])
        self.pair, self.changes, self.gap = pair, changes, NormalGap(pair, contacts, axes)
        self.planes = np.stack([axes, axes @ pair.wheel_axes.T])
        origins = np.array([one.origin for one in separations])
        self.origins = origins, (origins - pair.wheel_origin) @ pair.wheel_axes.T
        self.at_points = point_changes(pair, contacts, separations, changes)

    def at(self, contact: Indices, x: Array, y: Array) -> tuple[Places, Array]:
        """Places (n,) of the planes of contacts (n,), and the levers of the wheel there over those at the points."""
        rows = contact if contact.size else np.zeros(1, dtype=int)  # of no place at all that of one
        met = self.gap.of(rows).flank_points(*(np.resize(part, rows.size)[:, None] for part in (x, y)))
        pinion, wheel = (one.at((slice(contact.size), 0)) for one in met)
        points, planes = (pinion, wheel), self.planes[:, contact]
        rising = np.stack([rises(one, plane[:, :2]) for one, plane in zip(points, planes, strict=True)])
        growth, levers = grown(self.pair, self.changes, *points), self.at_points.steepness[contact] / wheel.steepness
        growth[1] -= self.at_points.gaps[:, contact] * levers
        heights = [
            ((one.point - origins[contact]) * plane[:, 2]).sum(axis=-1)
            for one, origins, plane in zip(points, self.origins, planes, strict=True)
        ]
        tilts = self.at_points.tilts[:, contact]
        return Places(points, planes, growth, np.array(heights), tilts, rising, grid_motions(x, y)), levers
