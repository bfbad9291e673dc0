r"""Load factors of a mesh cycle with the meanings of ISO 6336-1: along the face, and among the tooth pairs.

The common face is cut into strips of equal width along the pinion's lengthwise coordinate: its axis, or the cone
distance. With W the normal force of all tooth pairs in each strip, the mean over the positions, and w the force of one
pair in a strip at one position over the length of the contact line across the strip,

.. math:: K_{H\beta} = \frac{\max W}{\operatorname{mean} W}, \qquad
          K_{H\alpha} = \frac{\max w}{K_{H\beta}} \frac{\varepsilon_\alpha b}{\cos\beta_b\, F_n} .

The last position is the first one a pitch later and does not count. The factors depend on the number of strips;
on the grid by some per cent where the load crowds at a sharp end. There half-spaces have a line load that grows without
end, and pressures that are constant on cells carry what an end 0.2 cells farther out would have: a strip of the width w
at the end lacks force in proportion to the length h of a cell, or less where the edge is free. Beside the arc of a
rounded end the line load doubles within a part of a cell: there the forces in the strips are those of columns that are
graded towards the arc. Where columns are not solved, cells tell to half of one where a contact ends, and the strips
beside it follow. Elsewhere strips miss what the load changes by within a cell. ``face_load_factor_error`` estimates all
four. Contact lines of few positions lie apart on the face, so that W has waves: ``face_load_factor_by_positions``.

References
----------
ISO 6336-1:2019, Calculation of load capacity of spur and helical gears - Part 1, clauses 7 and 8.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from loaded_tca.flanks.base import EDGE_NAMES
from loaded_tca.pairs.gear_pair import cylindrical_basis
from loaded_tca.results.pressure_map import arc_cells

if TYPE_CHECKING:
    from collections.abc import Sequence

    from loaded_tca.arrays import Array
    from loaded_tca.edges.rounded import CellForces
    from loaded_tca.pairs.gear_pair import GearPair
    from loaded_tca.results.pressure_map import Maps, PressureMap
    from loaded_tca.unloaded import ContactPath

STRIPS = 30
MISSING_AT_END = 0.15
"""Part of K_Hbeta that half-spaces lack at a sharp end on cells as long as a strip, at the most; on shorter ones less
in proportion: 0.07 to 0.15 in 15 pairs (``validation/loaded/face_ends.py``); with free edges up to 0.07
in five random pairs against 128 cells."""
MISSING_AT_ARC = 0.3
"""Relative error of K_Hbeta by cells as long as a strip, at the most, where contacts end on the arc of an end of the
face, besides what half a cell at their ends moves; on shorter ones less in proportion: up to 0.26 on grids of 48 to 256
cells along spur contacts, against 640 (``validation/loaded/face_ends.py``)."""
LEFT_BY_COLUMNS = 0.03
"""Relative error of K_Hbeta where contacts end on arcs and their load is that of columns, at the least. On
default grids it was 0.0056 at the most in 17 analyses of spur pairs, against 1536 cells along alone (the pairs of
``validation/loaded/face_ends.py`` and ``validation/loaded/rounded_ends.py``), and 0.021 at the most
in 28 of random scenes."""
END_EDGES = [k for k, edge in enumerate(2 * EDGE_NAMES) if "side" in edge]
"""Numbers of the ends of the face among the edges of both gears."""
IN_PAIRS = 3.0
"""Error of K_Hbeta away from the ends, at the most, over its change where each two cells along the contact share
their load: up to 2.5 in seven random pairs with free edges, against 128 cells."""
NARROWEST_FACE = 0.75
"""Width of the face over the module below which K_Hbeta has no bound of its error: each free end is softened as if the
other were far away. Even loads on spur teeth of module 3 have 1.02 to 1.06 on 0.9 modules, up to 1.06 on 0.6, 1.05 to
1.17 on 0.4 to 0.46, 1.6 on 0.17, under loads of 1.3 to 21 N m per mm of the face."""
ROUNDING = 1e-12
"""Extent of a cell, over the width of a strip, that is none: the cell lies beyond the face."""


def load_factors(pair: GearPair, path: ContactPath, maps: Maps, mean_length: float) -> tuple[Array, Array]:
    """Face load factor K_Hbeta and transverse load factor K_Halpha under each torque.

    Parameters
    ----------
    pair : GearPair
    path : ContactPath
        Unloaded contact, of n positions.
    maps : tuple
        Pressure maps by m torques, n positions and tooth pairs.
    mean_length : float [mm]
        Mean length of all contact lines, eps_alpha b/cos(beta_b); NaN where it is not defined.

    Returns
    -------
    face_load_factor, transverse_load_factor : (m,) array
        NaN with one position and without load; the latter without a mean length too.
    """
    borders = strip_borders(pair, path)
    factors = np.full((2, len(maps)), math.nan)
    for torque, positions in enumerate(maps):
        strips, largest = np.zeros(STRIPS), 0.0
        for one in loaded_maps(positions):
            force, length = strip_forces(pair, one, borders)
            strips += force
            largest = max(largest, float(force.max()) / length)
        if strips.any():
            face = strips.max() / strips.mean()
            factors[:, torque] = face, largest / face * mean_length * (len(positions) - 1) / strips.sum()
    return factors[0], factors[1]


def face_load_factor_error(
    pair: GearPair, path: ContactPath, positions: Sequence[Sequence[PressureMap | None]]
) -> float:
    """Estimated relative error of K_Hbeta under one torque by the cells, at the most.

    Where the strip with the largest force is the last one at an end of the face by which contacts end, K_Hbeta is too
    low: the law of half-spaces without free edges, which have less. Where contacts end on the arc of an end of the
    face and their load is that of columns, the change of K_Hbeta from coarser columns counts, at the least 3 %; where
    it is that of cells, in this strip or beside it, these tell the end to half a cell. Elsewhere the change of K_Hbeta
    counts where each two slices of cells share their load, in the worse way to take them in pairs.

    Parameters
    ----------
    pair : GearPair
    path : ContactPath
        Unloaded contact, of n positions.
    positions : sequence of sequences
        Pressure maps by n positions and tooth pairs.

    Returns
    -------
    float
        NaN without load, infinite on faces that are narrower than :data:`NARROWEST_FACE` modules.
    """
    load = _LoadInStrips.of(pair, path, positions)
    if not load.forces.any():
        return math.nan
    if is_narrow(pair):
        return math.inf
    by_cells = [one.strip_force is None for one in load.maps]
    by_arcs = 0.0 if pair.sharp is pair else _error_beside_arcs(pair, load)
    if not all(by_cells):
        by_arcs = max(by_arcs, LEFT_BY_COLUMNS, _change_on_coarser_columns(load))
    at_end = [
        on_cells and load.largest in (0, STRIPS - 1) and bool(one.pressure[one.beside_end].any())
        for on_cells, one in zip(by_cells, load.maps, strict=True)
    ]
    if not by_arcs and any(at_end):
        return MISSING_AT_END * load.cells(at_end)
    return max(by_arcs, IN_PAIRS * _change_in_pairs(pair, load))


def _on_cells(positions: Sequence[Sequence[PressureMap | None]]) -> list[list[PressureMap | None]]:
    """Maps by positions and tooth pairs whose forces in strips are those of their cells alone."""
    return [[None if one is None else replace(one, strip_force=None) for one in row] for row in positions]


def is_narrow(pair: GearPair) -> bool:
    """Whether the ends of the face in common are too close together for K_Hbeta."""
    return pair.face_width < NARROWEST_FACE * pair.module


def error_beside_arcs(pair: GearPair, path: ContactPath, positions: Sequence[Sequence[PressureMap | None]]) -> float:
    """Estimated relative error of K_Hbeta by cells where contacts end on the arc of an end of the face; 0 without.

    Those count that end in the strip with the largest force, or in one beside it.
    """
    return 0.0 if pair.sharp is pair else _error_beside_arcs(pair, _LoadInStrips.of(pair, path, _on_cells(positions)))


class _LoadInStrips(NamedTuple):
    """What strips of the face carry under one torque.

    Attributes
    ----------
    borders : (n + 1,) array [mm]
    maps : sequence of PressureMap
        Those with pressure.
    by_map : list of ((n,) array [N], float [mm])
        Forces of the strips by each map, and their width.
    forces : (n,) array [N]
        By all maps.
    """

    borders: Array
    maps: Sequence[PressureMap]
    by_map: list[tuple[Array, float]]
    forces: Array

    @classmethod
    def of(cls, pair: GearPair, path: ContactPath, positions: Sequence[Sequence[PressureMap | None]]) -> _LoadInStrips:
        """The load of pressure maps by positions and tooth pairs."""
        borders, maps = strip_borders(pair, path), loaded_maps(positions)
        by_map = [strip_forces(pair, one, borders) for one in maps]
        return cls(borders, maps, by_map, np.sum([np.zeros(STRIPS), *(force for force, _ in by_map)], axis=0))

    @property
    def largest(self) -> int:
        """Number of the strip with the largest force."""
        return int(self.forces.argmax())

    def cells(self, which: Sequence[bool]) -> float:
        """Length of the cells of some of all maps over the width of the largest strip, weighted by forces in it."""
        forces = np.array([force[self.largest] for force, _ in self.by_map])
        cells = [one.spacing[1] / width for one, (_, width) in zip(self.maps, self.by_map, strict=True)]
        return float((forces * cells) @ np.array(which, dtype=float)) / float(forces.sum())


def _error_beside_arcs(pair: GearPair, load: _LoadInStrips) -> float:
    """Result of :func:`error_beside_arcs` for a load on gears with rounded edges."""
    ends = [_ends_on_arcs(pair, one, load.borders) for one in load.maps]
    beside_arc = [any(load.largest in end.strips for end in of_map) for of_map in ends]
    if not any(beside_arc):
        return 0.0
    return MISSING_AT_ARC * load.cells(beside_arc) + _change_by_ends(ends, load)


class _EndOnArc(NamedTuple):
    """The first or the last slice under pressure of a map, on the arc of an end of the face or beside it.

    Attributes
    ----------
    strips : set of int
        Those that hold a part of the slice, and those beside them.
    moved : (2, n) array [N]
        Growth of the forces of all strips as the slice moves by half its width inwards, and outwards.
    """

    strips: set[int]
    moved: Array


def _ends_on_arcs(pair: GearPair, one: PressureMap, borders: Array) -> list[_EndOnArc]:
    """Ends of the pressure of a map along the contact that lie on the arc of an end of the face, as its cells tell."""
    if one.strip_force is not None:
        return []
    on_arc = arc_cells(pair, one)[..., END_EDGES].any(axis=-1) & (one.pressure > 0.0)
    pressed, ends = np.flatnonzero(one.pressure.any(axis=0)), []
    for outwards, place in zip((-1.0, 1.0), pressed[[0, -1]].tolist() if pressed.size else (), strict=False):
        if on_arc[:, place].any():
            alone = replace(one, pressure=np.where(np.arange(one.y.size) == place, one.pressure, 0.0))
            force, *moved = (
                strip_forces(pair, replace(alone, y=one.y + way * one.spacing[1]), borders)[0]
                for way in (0.0, -0.5 * outwards, 0.5 * outwards)
            )
            first, last = np.flatnonzero(force)[[0, -1]].tolist()
            ends.append(_EndOnArc({*range(first - 1, last + 2)}, np.array(moved) - force))
    return ends


def _change_by_ends(ends: Sequence[Sequence[_EndOnArc]], load: _LoadInStrips) -> float:
    """Largest relative change of K_Hbeta as all ends on arcs move by half a cell."""
    moved = load.forces + np.sum([end.moved for of_map in ends for end in of_map], axis=0)
    tops = moved[:, max(0, load.largest - 1) : load.largest + 2].max(axis=1)
    return float(np.abs(tops / load.forces[load.largest] - 1.0).max())


def _change_on_coarser_columns(load: _LoadInStrips) -> float:
    """Relative change of K_Hbeta where the load of contacts that end on arcs is that of coarser columns."""
    coarser = np.sum(
        [
            force if one.strip_force is None else one.strip_force[1]
            for one, (force, _) in zip(load.maps, load.by_map, strict=True)
        ],
        axis=0,
    )
    return abs(float(coarser.max() / coarser.mean() / (load.forces.max() / load.forces.mean())) - 1.0)


def _change_in_pairs(pair: GearPair, load: _LoadInStrips) -> float:
    """Largest relative change of K_Hbeta where two slices of each map whose load cells tell share it."""
    factor, changes = load.forces.max() / load.forces.mean(), []
    for first in (0, 1):
        shared = np.sum([strip_forces(pair, in_pairs(one, first), load.borders)[0] for one in load.maps], axis=0)
        changes.append(abs(shared.max() / shared.mean() / factor - 1.0))
    return float(max(changes))


def in_pairs(one: PressureMap, first: int) -> PressureMap:
    """A map of which each two loaded slices have their mean pressure, from so many cells along the contact on."""
    count = (one.pressure.shape[1] - first) // 2
    slices = one.pressure[:, first : first + 2 * count].reshape(-1, count, 2)
    share = np.asarray(slices.any(axis=0).all(axis=-1))
    pressure = one.pressure.copy()
    means = np.where(share[:, None], slices.mean(axis=-1, keepdims=True), slices)
    pressure[:, first : first + 2 * count] = means.reshape(len(pressure), -1)
    return replace(one, pressure=pressure)


def face_load_factor_by_positions(
    pair: GearPair, path: ContactPath, positions: Sequence[Sequence[PressureMap | None]]
) -> float:
    """How far loads of strips, over the largest, move where every second position counts alone, under one torque.

    The places of the mesh of a pitch are taken as two halves, each with its own mean over the face. From five positions
    on K_Hbeta of all of them is off by about half of it at the most; with three it may be off by more (a bevel pair of
    ten pairs: 12 % for 9 %).

    Parameters
    ----------
    pair : GearPair
    path : ContactPath
        Unloaded contact, of n positions.
    positions : sequence of sequences
        Pressure maps by n positions and tooth pairs.

    Returns
    -------
    float
        NaN of an even number of positions, of a single one, and where nothing is loaded in one of the halves.
    """
    borders, places = strip_borders(pair, path), len(positions) - 1
    if places % 2 or not places:
        return math.nan
    strips = np.zeros((2, STRIPS))
    for place, row in enumerate(positions[:-1]):
        strips[place % 2] += sum(strip_forces(pair, one, borders)[0] for one in row if one is not None)
    if not strips.any(axis=-1).all():
        return math.nan
    together = strips.sum(axis=0)
    whole = together / together.mean()
    halves = strips / strips.mean(axis=-1, keepdims=True)
    return float(np.abs(halves - whole).max() / whole.max())


def loaded_maps(positions: Sequence[Sequence[PressureMap | None]]) -> list[PressureMap]:
    """Maps by positions and tooth pairs that count in the load factors: all but those of the last position."""
    return [one for row in positions[:-1] for one in row if one is not None]


def face_forces(
    pair: GearPair,
    path: ContactPath,
    positions: Sequence[Sequence[PressureMap | None]],
    *,
    by_cells: bool = False,
) -> tuple[Array, Array]:
    """Borders of the strips of the face (STRIPS + 1,) [mm], and the force of all loaded maps in each (STRIPS,) [N].

    ``by_cells``: that of the cells also where maps have that of columns.
    """
    borders, maps = strip_borders(pair, path), loaded_maps(_on_cells(positions) if by_cells else positions)
    return borders, sum((strip_forces(pair, one, borders)[0] for one in maps), np.zeros(STRIPS))


def strip_forces(pair: GearPair, one: PressureMap, borders: Array) -> tuple[Array, float]:
    """Force of a pressure map in strips of the face, and the length of a contact line that crosses a strip.

    Parameters
    ----------
    pair : GearPair
    one : PressureMap
    borders : (n + 1,) array [mm]
        Of the strips, ascending, along the pinion's lengthwise coordinate.

    Returns
    -------
    force : (n,) array [N]
        That of a cell is shared out by the overlap of its extent along the contact; all of it is within the strips.
        That of columns, where the map has it.
    length : float [mm]
    """
    shares, length = strip_shares(pair, one, borders)
    if one.strip_force is not None:
        return one.strip_force[0], length
    return shares @ one.pressure[one.pressure > 0.0] * one.spacing[0] * one.spacing[1], length


def forces_of_columns(pair: GearPair, loads: Sequence[CellForces], borders: Array) -> Array:
    """Forces (m, n) [N] in strips of the face by the cells of m grids of columns; ``borders`` (n + 1,) [mm]."""
    return np.stack([_shares(_lengthwise(pair, cells.ends), borders) @ cells.forces for cells in loads])


def strip_shares(pair: GearPair, one: PressureMap, borders: Array) -> tuple[Array, float]:
    """Shares of strips of the face in the forces of the cells under pressure, and the length of ``strip_forces``.

    Parameters
    ----------
    pair : GearPair
    one : PressureMap
    borders : (n + 1,) array [mm]

    Returns
    -------
    shares : (n, m) array
        Of the m cells with pressure > 0, in the order of the map; each column adds up to one.
    length : float [mm]
    """
    across, along = np.nonzero(one.pressure)
    middles = one.origin + one.x[across, None] * one.axes[0] + one.y[along, None] * one.axes[1]
    dy = one.spacing[1]
    ends = [_lengthwise(pair, middles + side * dy * one.axes[1]) for side in (-0.5, 0.5)]
    slope = np.abs(ends[1] - ends[0]).mean() / dy if across.size else 1.0
    width = float(borders[1] - borders[0])
    return _shares(np.asarray(ends), borders), width / slope if slope else math.inf


def _shares(ends: Array, borders: Array) -> Array:
    """Shares (n, m) of strips of the face in cells, by the lengthwise coordinates (2, m) of both their ends [mm]."""
    low, high = np.sort(np.clip(ends, borders[0], borders[-1]), axis=0)
    least = ROUNDING * float(borders[1] - borders[0])
    below = np.clip((borders[1:-1, None] - low) / np.maximum(high - low, least), 0.0, 1.0)
    return np.asarray(np.diff(below, axis=0, prepend=0.0, append=1.0))


def strip_motions(pair: GearPair, one: PressureMap, borders: Array, strip: int) -> Array:
    """Growth of the force in one strip as the grid of a pressure map and the ends of the face move, forces held.

    What passes a border is the line load there, which changes linearly from the middle of a slice to that of the next.

    Parameters
    ----------
    pair : GearPair
    one : PressureMap
    borders : (n + 1,) array [mm]
    strip : int
        Which of the n.

    Returns
    -------
    (8,) array [N/mm, N/rad]
        By the motions of the grid as of :class:`loaded_tca.separation.gap_change.MovedContacts`, by those of the
        lower and the upper end of the face.
    """
    across, along = np.nonzero(one.pressure)
    force = one.pressure[across, along] * math.prod(one.spacing)
    ends, rates = [], []
    for side in (-0.5, 0.5):
        x, y = one.x[across], one.y[along] + side * one.spacing[1]
        point = one.origin + x[:, None] * one.axes[0] + y[:, None] * one.axes[1]
        radius = np.hypot(point[:, 0], point[:, 1])
        jet = pair.pinion.flank.lengthwise_coordinate(radius, point[:, 2])
        slope = np.stack(np.broadcast_arrays(jet.rho * point[:, 0] / radius, jet.rho * point[:, 1] / radius, jet.z), -1)
        by_x, by_y, by_z = (slope @ one.axes.T).T
        place = np.asarray(jet.value)
        inside = (place > borders[0]) & (place < borders[-1])
        of_face = [place <= borders[0], place >= borders[-1]]
        motions = [by_x, by_y, x * by_y - y * by_x, -x * by_z, -y * by_z, by_z]
        rates.append(np.stack([*(inside * part for part in motions), *of_face]))
        ends.append(np.clip(place, borders[0], borders[-1]))
    swap = ends[1] < ends[0]
    (low, high), (lower, higher) = (
        (np.where(swap, second, first), np.where(swap, first, second)) for first, second in (ends, rates)
    )
    width = np.maximum(high - low, ROUNDING * (borders[1] - borders[0]))
    growth = np.zeros(8)
    for border, sign in ((strip, -1.0), (strip + 1, 1.0)):
        if 0 < border < len(borders) - 1:
            part, share = (borders[border] - low) / width, border / (len(borders) - 1)
            own = np.zeros(8)
            own[6:] = 1.0 - share, share
            passed = (own[:, None] - 0.5 * (lower + higher)) / width
            growth += sign * (passed * (force * np.maximum(1.0 - np.abs(part - 0.5), 0.0))).sum(axis=1)
    return growth


def strip_borders(pair: GearPair, path: ContactPath) -> Array:
    """Borders of the strips along the pinion's lengthwise coordinate, (STRIPS + 1,) [mm]."""
    return np.linspace(*common_face(pair, path), STRIPS + 1)


def common_face(pair: GearPair, path: ContactPath) -> tuple[float, float]:
    """Ends of the part of the face that both gears cover, along the pinion's lengthwise coordinate [mm]."""
    (first, last), (low, high) = face_ends(pair, path).tolist()
    return max(first, low), min(last, high)


def face_ends(pair: GearPair, path: ContactPath) -> Array:
    """Lower and upper end of the faces of pinion and wheel (2, 2), along the pinion's lengthwise coordinate [mm].

    Of crossed axes both coordinates part along the path of contact: what they differ by where the middle of the
    pinion's flank is in mesh counts, which does not depend on positions.
    """
    middle = _mesh_point(pair, path)
    radius, _, axial = pair.to_wheel(middle)
    ends = []
    for flank in (pair.pinion.flank, pair.wheel.flank):
        place = flank.lengthwise_coordinate(*flank.grid(2, 2)).value
        ends.append((float(place.min()), float(place.max())))
    apart = _lengthwise(pair, middle) - pair.wheel.flank.lengthwise_coordinate(radius, axial).value
    return np.array(ends) + np.array([[0.0], [float(apart)]])


def _mesh_point(pair: GearPair, path: ContactPath) -> Array:
    r"""Where the middle of the pinion's flank is in mesh (3,), in the fixed frame [mm].

    That is where its normal has levers about both axes in the ratio of the teeth: with the gradient of the flank, whose
    moment about the pinion's axis is 1, that about the wheel's axis is :math:`A + B \cos\psi + C \sin\psi` at the
    azimuth psi. Of the two solutions that next to the path of contact is meant.
    """
    flank = pair.pinion.flank
    rho, z = (float(grid[1, 1]) for grid in flank.grid(3, 3))
    theta = flank.theta(np.array(rho), np.array(z))
    gradient = np.array([-float(theta.rho), 1.0 / rho, -float(theta.z)])

    def moment(azimuth: Array) -> tuple[Array, Array]:
        basis = cylindrical_basis(azimuth)
        point = rho * basis[..., 0, :] + [0.0, 0.0, z]
        return np.cross(point - pair.wheel_origin, gradient @ basis) @ pair.wheel_axes[2], point

    of_three, _ = moment(np.array([0.0, 0.5, 1.0]) * math.pi)
    mean, cosine = 0.5 * (of_three[0] + of_three[2]), 0.5 * (of_three[0] - of_three[2])
    sine = of_three[1] - mean
    points = path.point[path.in_contact]
    near = points[np.abs(_lengthwise(pair, points)).argmin()]
    about, before = math.atan2(sine, cosine), math.atan2(near[1], near[0])
    largest = math.hypot(cosine, sine)
    wanted = math.copysign(1.0 / pair.ratio, moment(np.array(before))[0]) - mean
    turn = math.acos(min(max(wanted / largest, -1.0), 1.0))
    azimuths = np.array([about - turn, about + turn])
    nearest = np.abs(np.angle(np.exp(1j * (azimuths - before)))).argmin()
    return moment(azimuths[nearest])[1]


def _lengthwise(pair: GearPair, points: Array) -> Array:
    """Lengthwise coordinate of points (..., 3) on the pinion [mm]."""
    radius = np.hypot(points[..., 0], points[..., 1])
    return np.asarray(pair.pinion.flank.lengthwise_coordinate(radius, points[..., 2]).value)
