r"""Where the slices of all contacts of a result lie, the line loads that they carry, and how the flanks curve there.

A slice is one row of cells across a contact. Its line load w and the relative curvature :math:`\kappa` of both flanks
set the pressure of an elastic line contact, :math:`p = \sqrt{w E^* \kappa/\pi}`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby
from weakref import WeakKeyDictionary

import numpy as np

from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.loaded.line_load import AVERAGED_OVER
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.numbers import CycleNumbers
from loaded_tca.results.pressure_map import PressureMap, arc_cells
from loaded_tca.results.support_growth import gears_under_torque
from loaded_tca.separation.normal_gap import NormalGap
from loaded_tca.unloaded.path import angles_through

TOGETHER = 8_000
"""Slices whose curvature is found at once."""


@dataclass(frozen=True, eq=False)
class ContactSlices:
    """Slices of the contacts of a result that carry load: n slices of m contacts, one after another.

    Attributes
    ----------
    result : CycleNumbers
    maps : sequence of m PressureMap
    places : (m, 3) array of int
        Indices of torque, position and tooth pair of each.
    counts : (m,) array of int
        Slices of each.
    carrying : (n,) array of int
        Index of each slice along its map.
    x, y : (n,) array [mm]
        Middle of the pressure across the contact, and of the slice along it.
    line_load : (n,) array [N/mm]
        w; where the contact reaches an edge or a relief start the mean over a quarter module.
    """

    result: CycleNumbers
    maps: Sequence[PressureMap]
    places: Indices
    counts: Indices
    carrying: Indices
    x: Array
    y: Array
    line_load: Array

    @cached_property
    def starts(self) -> Indices:
        """Of each contact, its first slice (m,)."""
        return np.asarray(np.cumsum(self.counts) - self.counts)

    @cached_property
    def owner(self) -> Indices:
        """Contact of each slice (n,)."""
        return np.repeat(np.arange(len(self.maps)), self.counts)

    @cached_property
    def origins(self) -> Array:
        """Origins of the tangent planes (m, 3) [mm]."""
        return np.array([one.origin for one in self.maps]).reshape(-1, 3)

    @cached_property
    def axes(self) -> Array:
        """Axes of the tangent planes (m, 3, 3)."""
        return np.array([one.axes for one in self.maps]).reshape(-1, 3, 3)

    def of_contact(self, contact: int) -> tuple[Indices, Array]:
        """Cells along its map that the slices of a contact are, and their middles across it [mm]."""
        some = slice(self.starts[contact], self.starts[contact] + self.counts[contact])
        return self.carrying[some], self.x[some]

    def points(self, some: Indices | slice = slice(None)) -> Array:
        """Middles of slices (k, 3) in the fixed frame [mm]."""
        owner, x, y = self.owner[some], self.x[some, None], self.y[some, None]
        return np.asarray(self.origins[owner] + x * self.axes[owner, 0] + y * self.axes[owner, 1])

    def elastic_pressure(self, curvature: Array) -> Array:
        """Pressure of line contacts (n,) [MPa] of relative curvatures (n,) [1/mm]; NaN where these are not positive."""
        curved = np.where(curvature > 0.0, curvature, math.nan)
        return np.asarray(np.sqrt(self.line_load * self.result.gear_pair.contact_modulus * curved / math.pi))

    def on_edge(self, contact: int) -> Mask:
        """Which slices of a contact hold loaded cells beside the end of a flank, or on the arc of a rounded edge."""
        one, (cells, _) = self.maps[contact], self.of_contact(contact)
        if not self._reaches_edge[contact]:
            return np.zeros(cells.size, dtype=bool)
        pair = gears_under_torque(self.result, int(self.places[contact, 0]))[0].gear_pair
        edge = one.beside_end if pair.sharp is pair else one.beside_end | arc_cells(pair, one).any(axis=-1)
        return np.asarray((edge & (one.pressure > 0.0))[:, cells].any(axis=0))

    @cached_property
    def _reaches_edge(self) -> Mask:
        return np.asarray(self.result.on_edge.astype(bool)[tuple(self.places.T)])

    def curvatures(self, *, rounded: bool = True) -> Array:
        """Relative curvature across the middles of all slices (n,) [1/mm], on the flanks with their rounded edges.

        Without them, ``rounded`` is false, the flanks go on to where these would be sharp.
        """
        curvatures = np.zeros(self.y.size)
        along = np.arange(self.counts.max(initial=1))
        for pair, some, angles in self._gaps(max(1, TOGETHER // along.size)):
            gap = NormalGap.at_angles(pair if rounded else pair.sharp, self.origins[some], angles, self.axes[some])
            slices = self.starts[some, None] + np.minimum(along, self.counts[some, None] - 1)
            curvatures[slices] = gap.curvature_across(self.x[slices], self.y[slices])
        return curvatures

    def _gaps(self, most: int) -> Iterator[tuple[GearPair, Indices, Array]]:
        """Contacts of gears that stand alike, at most so many at once, and the angles (2, k) of both gears there.

        Teeth stand a whole number of pitches beside the angles of the gears.
        """
        torques = np.unique(self.places[:, 0]).tolist()
        for _, alike in groupby(torques, lambda torque: id(gears_under_torque(self.result, torque)[0])):
            numbers = np.flatnonzero(np.isin(self.places[:, 0], some := [*alike]))
            under, _ = gears_under_torque(self.result, some[0])
            pair, (_, position, column) = under.gear_pair, self.places[numbers].T
            near = [
                np.array([getattr(path, f"{gear}_angle") for path in under.paths])[column, position]
                for gear in ("pinion", "wheel")
            ]
            angles = angles_through(pair, np.array(near), self.origins[numbers])
            for begin in range(0, len(numbers), most):
                yield pair, numbers[begin : begin + most], angles[:, begin : begin + most]


def contact_slices(result: CycleNumbers) -> ContactSlices:
    """Slices of the contacts of a result under load, with their line loads."""
    present = [((t, n, k), one) for t, n, k in np.ndindex(result.load_share.shape) if (one := result.maps[t][n][k])]
    sums = [one.pressure.sum(axis=0) for _, one in present]
    loaded = [number for number, each in enumerate(sums) if each.any()]
    places = np.array([present[number][0] for number in loaded], dtype=int).reshape(-1, 3)
    maps = [present[number][1] for number in loaded]
    longest = max((one.y.size for one in maps), default=1)
    pressure, moment, y = np.zeros((3, len(maps), longest))
    for row, (number, one) in enumerate(zip(loaded, maps, strict=True)):
        cells = slice(one.y.size)
        pressure[row, cells], moment[row, cells], y[row, cells] = sums[number], one.x @ one.pressure, one.y
    spacing = np.array([one.spacing for one in maps]).reshape(-1, 2)
    force, step = pressure * spacing.prod(axis=1, keepdims=True), spacing[:, 1:]
    rough = (result.on_edge.astype(bool) | result.on_relief_start.astype(bool))[tuple(places.T)]
    averaged = _averaged(force, step, result.gear_pair.module)
    line_load = np.where(rough[:, None], averaged, force / step)
    some = force > 0.0
    return ContactSlices(
        result, maps, places, some.sum(axis=1), some.nonzero()[1], moment[some] / pressure[some], y[some],
        line_load[some],
    )  # fmt: skip


def _averaged(force: Array, step: Array, module: float) -> Array:
    """Line load (m, k) [N/mm] of slices of contacts, the mean over a length about each as far as its contact goes.

    Slices of a length ``step`` (m, 1) [mm] have forces (m, k) [N]; without force beyond the contact.
    """
    loaded = force > 0.0
    first = loaded.argmax(axis=1)[:, None]
    end = loaded.shape[1] - loaded[:, ::-1].argmax(axis=1)[:, None]
    half = 0.5 * np.minimum(AVERAGED_OVER * module / step, end - first)
    middles = np.arange(loaded.shape[1]) + 0.5
    summed = np.pad(np.cumsum(force, axis=1), ((0, 0), (1, 0)))
    low, high = np.clip(middles - half, first, end), np.clip(middles + half, first, end)

    def up_to(place: Array) -> Array:
        cell = np.minimum(place.astype(int), loaded.shape[1] - 1)
        rest = (place - cell) * np.take_along_axis(force, cell, axis=1)
        return np.asarray(np.take_along_axis(summed, cell, axis=1) + rest)

    covered = np.where(loaded, high - low, 1.0)
    return np.asarray((up_to(high) - up_to(low)) / (covered * step))


@dataclass(frozen=True, eq=False)
class LargestPressures:
    """Slices with the largest elastic pressure under each torque (t,) of a result, whose edges are left out.

    Attributes
    ----------
    pressure : (t,) array [MPa]
        Of an elastic line contact of flanks without rounded edges, whatever the cap.
    position, column : (2, t) array of int
        Indices of position and tooth pair of that contact, and of the other contact that comes next; the same one twice
        where no other is loaded.
    lacking : (t,) array
        Part of the pressure by which the next contact has less; 1 without one.
    radius, axial : (2, t) array [mm]
        Middles of these slices on pinion and wheel.
    """

    pressure: Array
    position: Indices
    column: Indices
    lacking: Array
    radius: Array
    axial: Array


_LARGEST: WeakKeyDictionary[CycleNumbers, LargestPressures] = WeakKeyDictionary()
"""Of the results in use: ratings and their derivatives ask for them again."""


def largest_pressures(result: CycleNumbers) -> LargestPressures:
    """Slices with the largest pressure under each torque; kept as long as the result is.

    Parameters
    ----------
    result : MeshCycle
        With load under each torque.

    Returns
    -------
    LargestPressures
    """
    if result not in _LARGEST:
        _LARGEST[result] = _largest(contact_slices(result))
    return _LARGEST[result]


def _largest(slices: ContactSlices) -> LargestPressures:
    pressure, torque = slices.elastic_pressure(slices.curvatures(rounded=False)), slices.places[slices.owner, 0]
    by_torque = [
        np.flatnonzero((torque == number) & np.isfinite(pressure)) for number in range(len(slices.result.torque))
    ]
    worst = np.array([some[pressure[some].argmax()] for some in by_torque])
    owner = slices.owner[worst]
    others = [some[slices.owner[some] != one] for some, one in zip(by_torque, owner, strict=True)]
    following = [some[pressure[some].argmax()] if some.size else one for some, one in zip(others, worst, strict=True)]
    both = np.stack([worst, following])
    points = slices.points(worst)
    wheel_radius, _, wheel_axial = slices.result.gear_pair.to_wheel(points)
    _, position, column = np.moveaxis(slices.places[slices.owner[both]], -1, 0)
    return LargestPressures(
        pressure=pressure[worst],
        position=position,
        column=column,
        lacking=np.where(both[1] == worst, 1.0, 1.0 - pressure[both[1]] / pressure[worst]),
        radius=np.stack([np.hypot(points[:, 0], points[:, 1]), wheel_radius]),
        axial=np.stack([points[:, 2], wheel_axial]),
    )
