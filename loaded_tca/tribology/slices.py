r"""The slices of all contacts of a result: line load, radius, and how both surfaces move, for one rad/s of the pinion.

A slice is one row of cells across a contact. Its line load w and its radius of relative curvature :math:`\rho` set the
pressure of a line contact, :math:`p = \sqrt{w E^*/(\pi \rho)}`, and its half width; unlike single cells they do not
depend on the grid where a contact ends at a sharp edge. Nothing here depends on speed, oil or roughness.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.flanks.base import Flank
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.pairs.kinematics import PlaneMotion, surface_motions
from loaded_tca.results.numbers import CycleNumbers
from loaded_tca.results.pressure_map import PressureMap
from loaded_tca.tribology.contact_slices import contact_slices


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
        What an elastic surface without rounded edges has under that line load, whatever the cap.
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
    pair, contacts = result.gear_pair, contact_slices(result)
    motions = surface_motions(pair, contacts.origins, contacts.axes)
    sliding = motions[0].less(motions[1], pair.ratio)
    parts = [
        _moving(pair, one, contacts.of_contact(number), (*motions, sliding), number)
        for number, one in enumerate(contacts.maps)
    ]
    names = ("step", "rolling_1", "rolling_2", "sliding", "loss", "torque_1", "torque_2")
    flat = {name: np.concatenate([np.zeros(0), *(part[name] for part in parts)]) for name in names}
    points, axes = contacts.points(), contacts.axes[contacts.owner]
    wheel_radius, _, wheel_axial = pair.to_wheel(points)
    curvature = contacts.curvatures()
    curved, pressure = np.where(curvature > 0.0, curvature, math.nan), contacts.elastic_pressure(curvature)
    elastic = pressure if pair.sharp is pair else contacts.elastic_pressure(contacts.curvatures(rounded=False))
    cap = math.inf if pair.max_pressure is None else pair.max_pressure
    normal = axes[:, 2]
    torque, position, column = contacts.places[contacts.owner].T
    rolling = np.stack([flat["rolling_1"], flat["rolling_2"]])
    return Slices(
        torque=torque,
        position=position,
        column=column,
        starts=contacts.starts,
        radius=np.hypot(points[:, 0], points[:, 1]),
        axial=points[:, 2],
        wheel_radius=wheel_radius,
        wheel_axial=wheel_axial,
        point=points,
        tangent=0.5 * flat["step"][:, None] * axes[:, 1],
        roll_length=np.abs((points * normal)[:, :2].sum(axis=1)) / np.hypot(normal[:, 0], normal[:, 1]),
        line_load=contacts.line_load,
        relative_radius=1.0 / curved,
        pressure=np.minimum(pressure, cap),
        elastic_pressure=elastic,
        half_width=np.sqrt(4.0 * contacts.line_load / (math.pi * pair.contact_modulus * curved)),
        rolling=rolling * np.where(rolling.sum(axis=0) < 0.0, -1.0, 1.0),
        sliding=flat["sliding"],
        loss=flat["loss"],
        torques=np.stack([flat["torque_1"], flat["torque_2"]]),
        on_edge=np.concatenate([np.zeros(0, dtype=bool), *map(contacts.on_edge, range(len(contacts.maps)))]),
        capped=bool((pressure >= cap).any()),
    )


def _moving(
    pair: GearPair,
    one: PressureMap,
    middles: tuple[Indices, Array],
    motions: tuple[PlaneMotion, PlaneMotion, PlaneMotion],
    number: int,
) -> dict[str, Array]:
    """How the slices of a map move, by their cells and middles; of pinion, wheel, and between them."""
    dx, dy = one.spacing
    carrying, x = middles
    pressure, y = one.pressure[:, carrying], one.y[carrying]
    first, second, between = motions
    across, along = between.across(number, y), between.along(number, one.x)[:, None]
    speed = np.hypot(across, along)
    inverse = np.divide(pressure, speed, out=np.zeros_like(speed), where=speed > 0.0)
    arms = []
    for gear in (first, second):
        forwards = gear.across(number, y) * across + gear.along(number, one.x)[:, None] * along
        arms.append((inverse * forwards).sum(axis=0) * (dx * dy))
    return {
        "step": np.full(y.size, dy),
        "rolling_1": first.across(number, y),
        "rolling_2": pair.ratio * second.across(number, y),
        "sliding": np.hypot(across, between.along(number, x)),
        "loss": (pressure * speed).sum(axis=0) * (dx * dy),
        "torque_1": -arms[0],
        "torque_2": arms[1],
    }


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
