r"""Pairs of gears that differ in one key of their scene, and edges of the flanks that move through grids of contacts.

A key that moves the wheel moves its tips and face ends, and so does the turn that brings the flanks back into contact.
On a plane that moves by V in itself (mm per unit of the key) the normal at a place meets the flanks at points that
move along it by ds, and from there

.. math:: dX_1 = V + n\,ds_1, \qquad dp_2 = R V + R n\,ds_2 - R\,dt + dR\,R^T p_2,

with R the axes of the wheel, t its origin and p_2 the place in its frame. The distance D of such a place to an edge
changes by D_rho drho + D_z dz, and the part of a cell that has material by dD/(|a| + |b|), a and b the growth of D from
cell to cell (:func:`loaded_tca.separation.sample._covers`). A normal that tilts by dn moves by the height times dn
along the plane where it meets a flank.

Any grid that covers a contact is as good as another, but an edge that runs through the cells of a held grid takes the
derivative of the discretisation with it. So grids go with their contacts: V is that for which the edges in the contact,
sharp or rounded, stay where they are in the grid, weighted with the pressure beside them; of those that these leave
open, that for which the gap on the grid changes least.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from numbers import Real
from typing import Self

import numpy as np

from loaded_tca.arrays import GEARS, Array, Indices, Mask
from loaded_tca.errors import AccuracyWarning, GeometryError, InputError
from loaded_tca.flanks.base import EDGE_NAMES, Jet
from loaded_tca.flanks.removal import removal_change
from loaded_tca.flanks.spline import SplineFlank
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.scene import Scene
from loaded_tca.scene.section import Section, contents
from loaded_tca.separation.normal_gap import FlankPoints
from loaded_tca.separation.sample import SLIVER

STEPS = {"um": 1.0, "deg": 1e-4, "mm": 1e-4}
"""Step of a key by the unit at its end. Amounts enter linearly; with the others the difference is wrong by less than
1e-9, and rounding, 1e-16 of an angle, is less than that too."""
OF_MOUNTING = 1e-2
"""The same, so many times as large, of mounting errors: by 1 um of misalignment contacts go far."""
OF_SETTINGS = 100.0
"""The same, so many times as large, of machine settings and cutters: generated flanks are known to 1e-11 mm."""
KINK = 1e-6
"""Difference of the motions of the wheel to both sides of a key, over them, that is none."""
SECTIONS = ("modifications", "machine", "cutter")
"""Of a gear, whose keys shape its flanks and, to first order, nothing else."""


def is_of_modifications(key: str) -> bool:
    """Whether a key of a scene is one of the modifications of a gear."""
    return key.split(".")[1] == "modifications"


@dataclass(frozen=True, eq=False)
class PairChange:
    """Two pairs of gears that differ in one key of their scene.

    Attributes
    ----------
    key : str
        As of ``scene.with_changes``.
    below, above : GearPair
        With a smaller and a larger value of the key.
    difference : float
        Of the two values, in the unit of the key.
    side : int
        1: by growing values of the key alone, one of the pairs is that of the scene; -1: by falling ones; 0: by both.
    """

    key: str
    below: GearPair
    above: GearPair
    difference: float
    side: int = 0

    @property
    def of_modifications(self) -> bool:
        """Whether the pairs differ in modifications alone."""
        return is_of_modifications(self.key)

    @property
    def holds_edges(self) -> bool:
        """Whether the regions of the flanks and the starts of their reliefs stay as they are."""
        return self.of_mounting or (self.of_modifications and self.key.endswith("_um"))

    @property
    def holds_lines(self) -> bool:
        """Whether contacts keep their places at the edges of the flanks and at the starts of reliefs."""
        return self.of_modifications and self.holds_edges

    @property
    def of_mounting(self) -> bool:
        """Whether the wheel stands elsewhere."""
        return self.key.startswith("mounting.")

    @cached_property
    def moved_wheel(self) -> tuple[Array, Array]:
        """Derivatives of the wheel's origin (3,) [mm per unit] and axes (3, 3) [1 per unit]."""
        shift, turn = (getattr(self.above, name) - getattr(self.below, name) for name in ("wheel_origin", "wheel_axes"))
        return shift / self.difference, turn / self.difference

    def to_sides_of(self, pair: GearPair) -> tuple[Self, Self]:
        """The same by growing values of the key alone, and by falling ones, from a pair half way between the two."""
        half = 0.5 * self.difference
        return replace(self, below=pair, difference=half, side=1), replace(self, above=pair, difference=half, side=-1)

    def has_kink_at(self, pair: GearPair) -> bool:
        """Whether the wheel moves otherwise by growing values than by falling ones, from a pair half way between.

        A misalignment over the common face tilts it by more as that gets shorter, to either side.
        """
        (growing, turned), (falling, back) = (one.moved_wheel for one in self.to_sides_of(pair))
        apart = np.linalg.norm(growing - falling), np.linalg.norm(turned - back)
        largest = np.linalg.norm(growing), np.linalg.norm(turned)
        return self.of_mounting and any(one > KINK * whole for one, whole in zip(apart, largest, strict=True))


def pair_changes(scene: Scene, keys: Sequence[str]) -> list[PairChange]:
    """Pairs of gears a step either side of the value that each key has in a scene.

    Where one side is not allowed, as amounts below zero are not, the pair of the scene takes its place.

    Parameters
    ----------
    scene : Scene
    keys : sequence of str
        Keys of modifications, machine settings and cutters of either gear and of mounting errors, as of
        ``scene.with_changes``.

    Raises
    ------
    InputError
        With every key that is unknown, is none of these or no number, or that the scene cannot vary.

    """
    pair, changes, problems = scene.pair(), [], []
    for key in keys:
        try:
            changes.append(_pair_change(scene, pair, key))
        except (InputError, GeometryError) as error:
            problems += [f"{key}: {problem}" for problem in getattr(error, "problems", (str(error),))]
    if problems:
        raise InputError(problems)
    return changes


def _pair_change(scene: Scene, pair: GearPair, key: str) -> PairChange:
    value = value_at(scene, key)
    step, reason = STEPS[key.rpartition("_")[2]], None
    if key.split(".")[1] in SECTIONS[1:]:
        step *= OF_SETTINGS
    if key.startswith("mounting."):
        step *= OF_MOUNTING
    linear = ".modifications." in key and key.endswith("_um")  # one side is enough
    sides = [(value, pair), (value, pair)]
    for side, trial in ((1, value + step), (0, value - step)):
        if linear and sides[1][0] > value:
            break
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", AccuracyWarning)  # told of the scene itself
                sides[side] = trial, scene.with_changes({key: trial}).pair()
        except (InputError, GeometryError) as error:
            reason = reason or error
    (low, below), (high, above) = sides
    if reason is not None and low == high:
        raise reason
    return PairChange(key, below, above, high - low)


def _value_of(scene: Scene, key: str) -> object:
    """Whatever a scene has for a key."""
    value: object = scene
    for part in key.split("."):
        inner = contents(value) if isinstance(value, Section) else {}
        if isinstance(value, tuple) and value and isinstance(value[0], Section):
            inner = {str(n): one for n, one in enumerate(value)}
        if part not in inner:
            raise InputError("unknown key")
        value = inner[part]
    return value


def number_at(scene: Scene, key: str) -> float:
    """Value of a key; InputError if it is unknown or no number."""
    value = _value_of(scene, key)
    if isinstance(value, bool) or not isinstance(value, Real):
        raise InputError(f"found {value!r:.60}; allowed a key whose value is one number")
    return float(value)


def value_at(scene: Scene, key: str) -> float:
    """Value of a key that shapes or moves flanks; InputError if it does not."""
    *sections, name = key.split(".")
    _value_of(scene, key)
    moves = sections == ["mounting"]
    shapes = len(sections) > 1 and sections[0] in GEARS and sections[1] in SECTIONS
    if not (moves or shapes) or name.rpartition("_")[2] not in STEPS:
        places = ", ".join(f"[pinion.{section}]" for section in SECTIONS)
        raise InputError(
            f"does not change the gap alone; allowed are lengths and angles of [mounting], {places}, and of the wheel"
        )
    return number_at(scene, key)


Distance = Callable[[GearPair, FlankPoints], Jet]
"""To an edge or a relief start of one flank of a pair [mm], at points of it."""
MOTIONS = 3
"""Of a grid in its plane: along x, along y, its turn from x to y."""
PLACES_OF_BORDER = 5
"""Of a cell in which an edge runs: its middle, and those of the cells on both sides across and along."""
AT_ONE_PLACE = 0.02
"""Difference of the parts that two edges leave of a cell, up to which either may rule."""
OPEN = 1e-5
"""Weight of the motion with the gap, over that of edges beside the whole force."""


def rises(points: FlankPoints, plane: Array) -> Array:
    """How a flank rises along the normal on the way along two directions, rows of ``plane`` (..., 2, 3): (..., 2)."""
    return np.asarray(-(points.gradient[..., None, :] * plane).sum(axis=-1) / points.steepness[..., None])


def moved_below(pair: GearPair, change: PairChange, points: FlankPoints) -> Array:
    """Motion (..., 3) [mm per unit] of the wheel at its points, in its frame."""
    shift, turn = change.moved_wheel
    return np.asarray(pair.wheel_axes @ shift - points.point @ pair.wheel_axes @ turn.T)


def grown(pair: GearPair, changes: Sequence[PairChange], pinion: FlankPoints, wheel: FlankPoints) -> Array:
    """Growth ds of the flanks of pinion and wheel along the normal (2, keys, ...) [mm per unit of the key]."""
    growth = np.zeros((2, len(changes), *pinion.rho.shape))
    for gear, (name, own, points) in enumerate((("pinion", pair.pinion, pinion), ("wheel", pair.wheel, wheel))):
        per_turn = 1.0 / points.steepness
        per_length = -own.flank.side * own.flank.gradient_norm(points.rho, points.z).value * per_turn
        for key, change in enumerate(changes):
            if not change.key.startswith(name):
                continue
            below, above = (getattr(side, name) for side in (change.below, change.above))
            edges = below.sharp.flank, above.sharp.flank  # the arcs of rounded edges are those of unmodified flanks
            if change.of_modifications and not isinstance(edges[1], SplineFlank):
                growth[gear, key] = removal_change(*edges, points.rho, points.z) * per_length
            else:
                low, high = (one.flank.theta(points.rho, points.z).value for one in (below, above))
                growth[gear, key] = (high - low) * per_turn
            growth[gear, key] /= change.difference
    for key, change in enumerate(changes):
        if change.of_mounting:
            growth[1, key] = (wheel.gradient * moved_below(pair, change, wheel)).sum(axis=-1) / wheel.steepness
    return growth


@dataclass(frozen=True, eq=False)
class Places:
    """Places (n,) on the planes of contacts, and how what the normals meet there moves.

    Attributes
    ----------
    points : (FlankPoints, FlankPoints)
        Of pinion and wheel, (n,) each.
    planes : (2, n, 3, 3) array
        Axes of the plane and its normal in the frames of pinion and wheel.
    grown : (2, keys, n) array [mm per unit]
        Growth of both flanks along the normals, the wheel turned back into contact.
    heights : (2, n) array [mm]
        Of the points of both flanks over the plane.
    tilts : (keys, n, 2) array [rad per unit]
        Growth of the normal along x and y.
    slopes : (2, n, 2) array
        The same by the motion of the place along x and y.
    motions : (n, k, 2) array
        Motions of the places along x and y by each motion of their grids.
    """

    points: tuple[FlankPoints, FlankPoints]
    planes: Array
    grown: Array
    heights: Array
    tilts: Array
    slopes: Array
    motions: Array

    @property
    def gap_slopes(self) -> Array:
        """Growth of the gaps (n, k) by each motion of the grids."""
        return np.asarray((self.motions @ (self.slopes[1] - self.slopes[0])[..., None])[..., 0])

    @property
    def gaps(self) -> Array:
        """Growth of the gaps (keys, n) on planes that are held, the wheel turned back into contact."""
        return np.asarray(self.grown[1] - self.grown[0])

    @property
    def tilt_slopes(self) -> Array:
        """Growth of the gaps (n, 2) by tilts of the normals along x and y."""
        first, second = self.heights[..., None] * self.slopes
        return np.asarray(second - first)

    def growth(self, pair: GearPair, gear: int, distance: Distance, changes: Sequence[PairChange]) -> Array:
        """Growth (keys, n) of a distance on one of the flanks, on planes that are held."""
        points, along = self.points[gear], self.heights[gear][:, None] * self.tilts
        rise = self.grown[gear] + (along * self.slopes[gear]).sum(axis=-1)
        moved = rise[..., None] * self.planes[gear, :, 2]
        moved += np.einsum("kna,nai->kni", along, self.planes[gear, :, :2])
        for key, change in enumerate(changes if gear == 1 else ()):
            if change.of_mounting:
                moved[key] -= moved_below(pair, change, points)
        growths = _along(points, distance(pair, points), moved)
        name = GEARS[gear]
        for key, change in enumerate(changes):
            if change.key.startswith(name) and not change.holds_edges:
                low, high = (distance(side, points).value for side in (change.below, change.above))
                growths[key] += (high - low) / change.difference
        return growths

    def slopes_of(self, pair: GearPair, gear: int, distance: Distance) -> Array:
        """Growth (n, k) of the same distance by each motion of the grids."""
        jet = distance(pair, self.points[gear])
        moved = self.motions @ (self.planes[gear, :, :2] + self.slopes[gear][..., None] * self.planes[gear, :, 2:])
        return _along(self.points[gear], jet, moved.swapaxes(0, 1)).T


@dataclass(frozen=True, eq=False)
class BorderCells:
    """Cells in which an edge of a flank runs.

    Attributes
    ----------
    cell : (m,) int array
        Their places in the row of all cells.
    rates : (keys, m) array [1 per unit of the key]
        Growth of their parts with material on grids that are held, the wheel turned back into contact.
    has_kinks : (keys,) bool array
        Whether an edge of the other gear that leaves the same part of a cell has another rate: it rules to one side.
    slopes : (m, 3) array [1/mm, 1/mm, 1/rad]
        The same by the motion of the grid along x and y and by its turn from x to y.
    """

    cell: Indices
    rates: Array
    has_kinks: Mask
    slopes: Array

    @classmethod
    def of(cls, pair: GearPair, places: Places, cell: Indices, changes: Sequence[PairChange]) -> BorderCells:
        """Those of some cells in which an edge runs, as of :func:`loaded_tca.separation.sample._covers`.

        Where several do, that which leaves the smallest part rules.

        Parameters
        ----------
        pair : GearPair
        places : Places
            Of n cells the middles, then those of the ones on both sides across, then those of the ones on both along.
        cell : (n,) int array
        changes : sequence of PairChange
        """
        edges = _edges()
        values = [
            np.broadcast_to(distance(pair, places.points[gear]).value, PLACES_OF_BORDER * cell.size)
            for gear, distance in edges
        ]
        distances = np.array(values).reshape(len(edges), PLACES_OF_BORDER, cell.size)
        steps = distances[:, 1:] - distances[:, :1]
        widths = 0.5 * np.abs(steps).sum(axis=1)
        parts = 0.5 + distances[:, 0] / widths
        part, ruling, gears = parts.min(axis=0), parts.argmin(axis=0), np.array([gear for gear, _ in edges])
        kept = (part >= SLIVER) & (part <= 1.0 + SLIVER)
        rules = np.arange(len(edges))[:, None] == ruling
        near = kept & (rules | ((parts - part < AT_ONE_PLACE) & (gears[:, None] != gears[ruling])))
        rates, slopes = np.zeros((len(changes), cell.size)), np.zeros((cell.size, MOTIONS))
        least, most = np.full(rates.shape, np.inf), np.full(rates.shape, -np.inf)
        for number in np.flatnonzero(near.any(axis=1)).tolist():
            own, (gear, distance) = near[number], edges[number]
            mine, signs = rules[number, own], np.sign(steps[number][:, own])
            by_keys, by_motion = (
                (grown[:, 0] - (part[own] - 0.5) * 0.5 * ((grown[:, 1:] - grown[:, :1]) * signs).sum(axis=1))
                / widths[number, own]
                for grown in (
                    places.growth(pair, gear, distance, changes).reshape(-1, PLACES_OF_BORDER, cell.size)[..., own],
                    places.slopes_of(pair, gear, distance).T.reshape(MOTIONS, PLACES_OF_BORDER, cell.size)[..., own],
                )
            )
            rates[:, own & rules[number]], slopes[own & rules[number]] = by_keys[:, mine], by_motion[:, mine].T
            least[:, own], most[:, own] = np.minimum(least[:, own], by_keys), np.maximum(most[:, own], by_keys)
        sides = np.array([change.side for change in changes])[:, None]
        rates = np.where(sides > 0, least, np.where(sides < 0, most, rates))[:, kept]
        kinks = (most - least)[:, kept] > AT_ONE_PLACE * np.abs(most[:, kept]).clip(np.abs(least[:, kept]))
        return cls(cell[kept], rates, kinks.any(axis=1), slopes[kept])

    @classmethod
    def of_arcs(
        cls, pair: GearPair, places: Places, cell: Indices, arcs: Mask, changes: Sequence[PairChange]
    ) -> BorderCells:
        """Cells on the arcs of rounded edges or beside them, (n, 8), as if the edges ran there; one for each arc.

        Parameters
        ----------
        pair : GearPair
        places : Places
            As of ``of``.
        cell : (n,) int array
        arcs : (n, 8) bool array
        changes : sequence of PairChange
        """
        rows, edges = np.nonzero(arcs.T)[::-1]
        rates, slopes = np.zeros((len(changes), rows.size)), np.zeros((rows.size, MOTIONS))
        for number in np.unique(edges).tolist():
            own, (gear, distance) = edges == number, _edges()[number]
            values = np.reshape(distance(pair, places.points[gear]).value, (PLACES_OF_BORDER, -1))
            width = 0.5 * np.abs(values[1:] - values[0]).sum(axis=0)[rows[own]]
            rates[:, own] = places.growth(pair, gear, distance, changes)[:, rows[own]] / width
            slopes[own] = places.slopes_of(pair, gear, distance)[rows[own]] / width[:, None]
        return cls(cell[rows], rates, np.zeros(len(changes), dtype=bool), slopes)

    def of_keys(self, keys: Indices) -> BorderCells:
        """The same with some of the keys."""
        return replace(self, rates=self.rates[keys], has_kinks=self.has_kinks[keys])

    def with_others(self, others: BorderCells) -> BorderCells:
        """These and others."""
        return BorderCells(
            np.concatenate([self.cell, others.cell]),
            np.concatenate([self.rates, others.rates], axis=1),
            self.has_kinks | others.has_kinks,
            np.concatenate([self.slopes, others.slopes]),
        )


def _edges() -> list[tuple[int, Distance]]:
    """Gear of each edge, and the distance to it: those of the pinion, then of the wheel."""
    return [(gear, edge_distance(gear, number)) for gear in (0, 1) for number in range(len(EDGE_NAMES))]


def edge_distance(gear: int, number: int) -> Distance:
    """Distance to one of the edges of a flank, in the order of ``EDGE_NAMES``."""
    return lambda pair, points: (pair.pinion, pair.wheel)[gear].flank.edges(points.rho, points.z)[number]


def start_distance(gear: int, number: int) -> Distance:
    """Distance to one of the relief starts of a flank."""
    return lambda pair, points: (pair.pinion, pair.wheel)[gear].flank.relief_starts(points.rho, points.z)[number]


def _along(points: FlankPoints, jet: Jet, moved: Array) -> Array:
    """Growth of a function of (rho, z) at points (n,) that move by (..., n, 3) in the frame of the gear."""
    outwards = (points.point[:, :2] * moved[..., :2]).sum(axis=-1) / points.rho
    return np.asarray(jet.rho * outwards + jet.z * moved[..., 2])


def grid_motions(x: Array, y: Array) -> Array:
    """Motions (n, 3, 2) of places (n,) of a grid along x and y, by its motion along either and its turn from x to y."""
    by_motion = np.zeros((x.size, MOTIONS, 2))
    by_motion[:, 0, 0] = by_motion[:, 1, 1] = 1.0
    by_motion[:, 2, 0], by_motion[:, 2, 1] = -y, x
    return by_motion


def following(
    border: BorderCells, contact: Indices, weights: Array, free: Array, open_to: Array, scales: Array
) -> Array:
    """Motions (keys, contacts, 3) of grids for which the parts of their border cells stay the same.

    Parameters
    ----------
    border : BorderCells
    contact : (m,) int array
        That each border cell belongs to.
    weights : (m,) array
        Force on each cell over that on the whole contact.
    free : (keys, contacts, 3) array [mm, mm, rad per unit]
        Where no edge says another.
    open_to : (contacts, 3, 3) array
        Quadratic forms of what others cost, in motions that are alike: of those that edges leave open, the least.
    scales : (contacts, 3) array [mm, mm, rad]
        Motions that are alike: by one cell.
    """
    motions = free.copy()
    slopes = border.slopes * scales[contact]
    for own in np.unique(contact).tolist():
        rows = np.flatnonzero(contact == own)
        weighted = weights[rows, None] * slopes[rows]
        matrix = weighted.T @ slopes[rows] + OPEN * open_to[own]
        wanted = OPEN * (free[:, own] / scales[own]) @ open_to[own] - border.rates[:, rows] @ weighted
        motions[:, own] = np.linalg.solve(matrix, wanted.T).T * scales[own]
    return motions
