r"""The slices of all contacts of a result: line load, radius, and how both surfaces move, for one rad/s of the pinion.

A slice is one row of cells across a contact. Its line load w and its radius of relative curvature :math:`\rho` set the
pressure of a line contact, :math:`p = \sqrt{w E^*/(\pi \rho)}`, and its half width; unlike single cells they do not
depend on the grid where a contact ends at a sharp edge. Nothing here depends on speed, oil or roughness.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace
from itertools import groupby
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.flanks.base import Flank
from loaded_tca.loaded.line_load import AVERAGED_OVER, stretch_parts
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.pairs.kinematics import PlaneMotion, surface_motions
from loaded_tca.results.numbers import CycleNumbers
from loaded_tca.results.pressure_map import PressureMap, arc_cells
from loaded_tca.results.support_growth import gears_under_torque
from loaded_tca.separation import slice_middles
from loaded_tca.separation.normal_gap import NormalGap
from loaded_tca.unloaded import ContactPoint
from loaded_tca.unloaded.path import angles_through

TOGETHER = 8_000
"""Slices whose curvature is found at once."""


@dataclass(frozen=True, eq=False)
class Slices:
    """Slices of all contacts under load, one after another: n slices of m contacts.

    Attributes
    ----------
    torque, position, column : (n,) array of int
        Indices of the map in ``result.maps``.
    starts : (m,) array of int
        Of each contact, its first slice.
    radius, axial, wheel_radius, wheel_axial : (n,) array [mm]
        Middles of the slices on pinion and wheel.
    point, tangent : (n, 3) array [mm]
        The middles in the fixed frame, and half the slices' length along the contact.
    roll_length : (n,) array [mm]
        Distance of the middle from the foot T1 of the common normal on the pinion, in the transverse plane.
    line_load : (n,) array [N/mm]
        w; where the contact reaches an edge or a relief start the mean over a quarter module.
    relative_radius : (n,) array [mm]
        rho across the contact; NaN where the flanks are not curved towards each other.
    pressure, half_width : (n,) array [MPa], [mm]
        Of a line contact; the pressure up to the cap.
    elastic_pressure : (n,) array [MPa]
        The same without a cap: what an elastic surface has under that line load.
    rolling : (2, n) array [mm]
        Velocities of both surfaces across the contact, over the angular velocity of the pinion; positive as both roll.
    sliding : (n,) array [mm]
        Velocity between both surfaces, over that of the pinion.
    loss : (n,) array [N mm]
        Friction power of a coefficient of friction of 1, over the angular velocity of the pinion.
    torques : (2, n) array [N mm]
        Torque of that friction about the axis of each gear, in its sense of motion.
    on_edge : (n,) array of bool
        Whether the slice holds loaded cells beside the end of a flank.
    capped : bool
        Whether a pressure equals the cap.
    """

    torque: Indices
    position: Indices
    column: Indices
    starts: Indices
    radius: Array
    axial: Array
    wheel_radius: Array
    wheel_axial: Array
    point: Array
    tangent: Array
    roll_length: Array
    line_load: Array
    relative_radius: Array
    pressure: Array
    elastic_pressure: Array
    half_width: Array
    rolling: Array
    sliding: Array
    loss: Array
    torques: Array
    on_edge: Mask
    capped: bool

    def __len__(self) -> int:
        return len(self.torque)

    @property
    def specific_sliding(self) -> Array:
        """zeta of pinion and wheel (2, n): 1 - v_r2/v_r1 and 1 - v_r1/v_r2."""
        first, second = self.rolling
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.stack([1.0 - second / first, 1.0 - first / second])

    def of_torque(self, torque: int) -> Indices:
        """Indices of the slices under one torque."""
        return np.flatnonzero(self.torque == torque)

    def known_of_torque(self, torque: int) -> Indices:
        """Indices of those whose pressure is known."""
        return np.flatnonzero((self.torque == torque) & np.isfinite(self.elastic_pressure))

    def deciding(self, torque: int) -> int:
        """Index of the slice with the largest elastic pressure under one torque."""
        some = self.known_of_torque(torque)
        return int(some[self.elastic_pressure[some].argmax()])


_KEPT: WeakKeyDictionary[CycleNumbers, Slices] = WeakKeyDictionary()
"""Slices of the results in use: every speed and oil asks for them again."""


_MESHES: WeakKeyDictionary[CycleNumbers, Any] = WeakKeyDictionary()
"""Macro geometry of the results in use, likewise."""


def cylindrical_mesh(result: CycleNumbers) -> Any:
    """Macro geometry of cylindrical gears; None of others. Kept as long as the result is."""
    if result not in _MESHES:
        _MESHES[result] = result.scene.mesh() if result.scene.path_points else None
    return _MESHES[result]


def slices_of(result: CycleNumbers) -> Slices:
    """Slices of a result; kept as long as the result is.

    Parameters
    ----------
    result : MeshCycle

    Returns
    -------
    Slices
    """
    if result not in _KEPT:
        _KEPT[result] = _swept(result)
    return _KEPT[result]


def _swept(result: CycleNumbers) -> Slices:
    pair = result.gear_pair
    places = [
        (t, n, k)
        for t, n, k in np.ndindex(result.load_share.shape)
        if (one := result.maps[t][n][k]) is not None and one.pressure.any()
    ]
    maps = [one for t, n, k in places if (one := result.maps[t][n][k]) is not None]
    origins = np.array([one.origin for one in maps]).reshape(-1, 3)
    axes = np.array([one.axes for one in maps]).reshape(-1, 3, 3)
    motions = surface_motions(pair, origins, axes)
    sliding = motions[0].less(motions[1], pair.ratio)
    rough = result.on_edge.astype(bool) | result.on_relief_start.astype(bool)
    parts = []
    for number, (place, one) in enumerate(zip(places, maps, strict=True)):
        moved = gears_under_torque(result, place[0])[0].gear_pair
        at_edge = bool(result.on_edge[place])
        parts.append(_of_map(moved, one, (*motions, sliding), number, rough=bool(rough[place]), edge=at_edge))
    names = ("x", "y", "step", "line_load", "rolling_1", "rolling_2", "sliding", "loss", "torque_1", "torque_2", "edge")
    flat = {name: np.concatenate([np.zeros(0), *(part[name] for part in parts)]) for name in names}
    counts = np.array([part["y"].size for part in parts], dtype=int)
    owner = np.repeat(np.arange(len(maps)), counts)
    torque, position, column = np.array(places, dtype=int).reshape(-1, 3)[owner].T
    x, y = flat["x"][:, None], flat["y"][:, None]
    points = origins[owner] + x * axes[owner, 0] + y * axes[owner, 1]
    wheel_radius, _, wheel_axial = pair.to_wheel(points)
    curvature = _curvatures(result, places, maps, counts, flat)
    curved = np.where(curvature > 0.0, curvature, math.nan)
    pressure = np.sqrt(flat["line_load"] * pair.contact_modulus * curved / math.pi)
    cap = math.inf if pair.max_pressure is None else pair.max_pressure
    normal = axes[owner, 2]
    rolling = np.stack([flat["rolling_1"], flat["rolling_2"]])
    return Slices(
        torque=torque,
        position=position,
        column=column,
        starts=np.cumsum(counts) - counts,
        radius=np.hypot(points[:, 0], points[:, 1]),
        axial=points[:, 2],
        wheel_radius=wheel_radius,
        wheel_axial=wheel_axial,
        point=points,
        tangent=0.5 * flat["step"][:, None] * axes[owner, 1],
        roll_length=np.abs((points * normal)[:, :2].sum(axis=1)) / np.hypot(normal[:, 0], normal[:, 1]),
        line_load=flat["line_load"],
        relative_radius=1.0 / curved,
        pressure=np.minimum(pressure, cap),
        elastic_pressure=pressure,
        half_width=np.sqrt(4.0 * flat["line_load"] / (math.pi * pair.contact_modulus * curved)),
        rolling=rolling * np.where(rolling.sum(axis=0) < 0.0, -1.0, 1.0),
        sliding=flat["sliding"],
        loss=flat["loss"],
        torques=np.stack([flat["torque_1"], flat["torque_2"]]),
        on_edge=flat["edge"] > 0.0,
        capped=bool((pressure >= cap).any()),
    )


def _of_map(
    pair: GearPair,
    one: PressureMap,
    motions: tuple[PlaneMotion, PlaneMotion, PlaneMotion],
    number: int,
    *,
    rough: bool,
    edge: bool,
) -> dict[str, Array]:
    """Numbers of the slices of one map; ``motions`` are those of pinion, wheel, and between them."""
    dx, dy = one.spacing
    carrying, x = slice_middles(one.x, one.pressure)
    pressure, y = one.pressure[:, carrying], one.y[carrying]
    first, second, between = motions
    across, along = between.across(number, y), between.along(number, one.x)[:, None]
    speed = np.hypot(across, along)
    inverse = np.divide(pressure, speed, out=np.zeros_like(speed), where=speed > 0.0)
    arms = []
    for gear in (first, second):
        forwards = gear.across(number, y) * across + gear.along(number, one.x)[:, None] * along
        arms.append((inverse * forwards).sum(axis=0) * (dx * dy))
    force = one.slice_force
    return {
        "x": x,
        "y": y,
        "step": np.full(y.size, dy),
        "line_load": _averaged(force, one, carrying, pair.module) if rough else force[carrying] / dy,
        "rolling_1": first.across(number, y),
        "rolling_2": pair.ratio * second.across(number, y),
        "sliding": np.hypot(across, between.along(number, x)),
        "loss": (pressure * speed).sum(axis=0) * (dx * dy),
        "torque_1": -arms[0],
        "torque_2": arms[1],
        "edge": _reaches_edge(pair, one)[carrying] if edge else np.zeros(y.size),
    }


def _reaches_edge(pair: GearPair, one: PressureMap) -> Mask:
    """Slices (ny,) with pressure beside the end of the material, or on the arc of a rounded edge."""
    edge = one.beside_end if pair.sharp is pair else one.beside_end | arc_cells(pair, one).any(axis=-1)
    return np.asarray(np.any(edge & (one.pressure > 0.0), axis=0))


def _averaged(force: Array, one: PressureMap, carrying: Indices, module: float) -> Array:
    """Line load of the loaded slices [N/mm], the mean over a length about each as far as the contact goes."""
    _, borders = one.borders
    ends = borders[carrying[0]], borders[carrying[-1] + 1]
    length = min(AVERAGED_OVER * module, ends[1] - ends[0])
    places = one.y[carrying]
    covered = np.minimum(places + 0.5 * length, ends[1]) - np.maximum(places - 0.5 * length, ends[0])
    return np.asarray((stretch_parts(borders, places, length) @ force) / covered)


def _curvatures(
    result: CycleNumbers,
    places: list[tuple[int, int, int]],
    maps: list[PressureMap],
    counts: Indices,
    flat: dict[str, Array],
) -> Array:
    """Relative curvature across the middles of all slices [1/mm], on the flanks with their rounded edges."""
    ends = np.cumsum(counts)
    curvatures = np.zeros(flat["y"].size)
    longest = int(counts.max(initial=1))
    size = max(1, TOGETHER // longest)
    for some in _together(result, places, size):
        pair = gears_under_torque(result, places[some[0]][0])[0].gear_pair
        contacts = [_own_contact(result, places[number], maps[number]) for number in some]
        gap = NormalGap(pair, contacts, np.array([maps[number].axes for number in some]))
        rows = [slice(ends[number] - counts[number], ends[number]) for number in some]
        x, y = (
            np.stack(
                [
                    np.pad(flat[name][row], (0, longest - counts[number]), "edge")
                    for number, row in zip(some, rows, strict=True)
                ]
            )
            for name in ("x", "y")
        )
        bends = gap.curvature_across(x, y)
        for bend, number, row in zip(bends, some, rows, strict=True):
            curvatures[row] = bend[: counts[number]]
    return curvatures


def _together(result: CycleNumbers, places: Sequence[tuple[int, int, int]], most: int) -> Iterator[Sequence[int]]:
    """Numbers of the places that are asked together: of gears that stand alike, no more than ``most`` at once."""
    for _, alike in groupby(range(len(places)), lambda number: id(gears_under_torque(result, places[number][0])[0])):
        numbers = list(alike)
        yield from (numbers[begin : begin + most] for begin in range(0, len(numbers), most))


def _own_contact(result: CycleNumbers, place: tuple[int, int, int], one: PressureMap) -> ContactPoint:
    """Contact point of a map at the angles of its own teeth, which are a whole number of pitches beside the gears'."""
    torque, position, column = place
    under, _ = gears_under_torque(result, torque)
    path = under.paths[column]
    contact = ContactPoint(**{entry.name: getattr(path, entry.name)[position] for entry in fields(path)})
    pinion, wheel = angles_through(under.gear_pair, contact, one.origin)
    return replace(contact, point=one.origin, pinion_angle=pinion, wheel_angle=wheel)


def cells_of_flank(
    flank: Flank, rho: Array, z: Array, cells: tuple[int, int]
) -> tuple[tuple[Indices, ...], list[Array]]:
    """Cells, by height and lengthwise, of a grid over a flank that places (n,) lie in, and the edges of the cells."""
    along, height = flank.frame.to_picture(rho, z)
    outline = flank.frame.to_picture(*flank.grid(9, 9))
    edges = [np.linspace(one.min(), one.max(), n + 1) for one, n in zip(outline[::-1], cells, strict=True)]
    index = tuple(
        np.clip(np.searchsorted(edge, values, "right") - 1, 0, count - 1)
        for edge, values, count in zip(edges, (height, along), cells, strict=True)
    )
    return index, edges
