"""Where the parts of a REXS model lie in space, and the torques and speeds of its shafts.

Every component may have a frame of its own, given in that of another one; where a file leaves them out, places along
the shafts and the angles of the stages are enough. Torques follow from the balance of all shafts without losses.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError, require
from loaded_tca.exchange.model import ANGLE, LENGTH, NUMBER, POWER, SPEED, TORQUE, Component, Reading

GEARS = "cylindrical_gear", "ring_gear"
PARALLEL = 1e-6
"""Sine of the angle of two axes that are parallel."""
ROUNDING = 1e-9
"""Singular value of the balances over the largest one that is none."""
DETERMINED = 1e-9
"""Part of a free change of all torques below which a torque does not take part in it."""
COUPLINGS = "coupling", "switchable_coupling", "side_plate", "planet_carrier"


@dataclass(frozen=True, eq=False)
class Pose:
    """Origin (3,) [mm] of a component, and its axes u, v, w (3, 3) as rows, in the frame of the gear unit."""

    origin: Array
    axes: Array


@dataclass(frozen=True, eq=False)
class Stage:
    """A cylindrical stage: its component, its gears and their shafts, and how they lie.

    Attributes
    ----------
    component : Component
    gears : (Component, Component)
        Pinion and wheel of the scene: the wheel has more teeth, and a ring gear is the wheel.
    shafts : (Component or None, Component or None)
    teeth : (int, int)
        Positive.
    internal : bool
    axes : (3, 3) array
        x, y, z of the pinion's frame as rows: z along the u axis of its shaft, x towards the wheel.
    middles : (2, 3) array [mm]
        Of both faces.
    placed : bool
        Whether the file places both gears in space.
    """

    component: Component
    gears: tuple[Component, Component]
    shafts: tuple[Component | None, Component | None]
    teeth: tuple[int, int]
    internal: bool
    axes: Array
    middles: Array
    placed: bool

    @property
    def id(self) -> str:
        """Id of its component."""
        return self.component.id

    @property
    def axial_offset(self) -> float:
        """Middle of the wheel's face beside that of the pinion, along z [mm]."""
        return float((self.middles[1] - self.middles[0]) @ self.axes[2])

    @property
    def distance(self) -> float:
        """Distance of the axes by the places in space [mm]."""
        between = self.middles[1] - self.middles[0]
        return float(np.linalg.norm(between - (between @ self.axes[2]) * self.axes[2]))


class Gearbox:
    """A model that is read for a stage, with what follows from all of it.

    Parameters
    ----------
    reading : Reading
    """

    def __init__(self, reading: Reading) -> None:
        self.reading, self.model = reading, reading.model
        self._faults: dict[str, InputError] = {}

    # places

    def pose(self, component: Component) -> Pose | None:
        """Return the frame of a component in that of the gear unit; None where the file does not have it.

        Raises
        ------
        InputError
            If its axes are not at right angles, or its frame is given in itself.
        """
        chain = [component]
        while (reference := chain[-1].number("reference_component_for_position")) is not None:
            following = self.model.components.get(str(round(reference)))
            if following is None or following.id == chain[-1].id or following.type == "gear_unit":
                break
            require((following not in chain, f"{component}: reference_component_for_position: given in itself"))
            chain.append(following)
        whole = Pose(np.zeros(3), np.eye(3))
        for frame in reversed(chain):
            pose = self._own_pose(frame)
            if pose is None:
                return None
            whole = Pose(whole.origin + pose.origin @ whole.axes, pose.axes @ whole.axes)
        return whole

    def _own_pose(self, component: Component) -> Pose | None:
        origin = component.numbers("support_vector", LENGTH, 3)
        u, w = (component.numbers(f"{one}_axis_vector", LENGTH | NUMBER, 3) for one in "uw")
        if origin is None or u is None or w is None:
            return None
        first, last = np.array(u), np.array(w)
        lengths = math.sqrt(first @ first), math.sqrt(last @ last)
        sound = min(lengths) > 0.0 and abs(first @ last) < 1e-6 * lengths[0] * lengths[1]
        require(
            (sound, f"{component}: u_axis_vector, w_axis_vector: found {u} and {w}; allowed vectors at right angles")
        )
        first, last = first / lengths[0], last / lengths[1]
        return Pose(np.array(origin), np.stack([first, np.cross(last, first), last]))

    def shaft_of(self, part: Component) -> Component | None:
        """Return the shaft that a gear or a load is on."""
        shafts = self.model.related("assembly", "part", part.id, "assembly")
        return next((one for one in shafts if one.type == "shaft"), None)

    def parts_of(self, shaft: Component, *types: str) -> list[Component]:
        """Return the parts of some types on a shaft."""
        parts = self.model.related("assembly", "assembly", shaft.id, "part")
        return [one for one in parts if one.type in types]

    def place_on_shaft(self, gear: Component, shaft: Component) -> float:
        """Return where the middle of a gear's face lies on its shaft, along the shaft's u axis [mm].

        By the frames of both where the file has them; else by u_coordinate_on_shaft, which is the lower end of the face
        in version 1.0, and its middle since.
        """
        of_gear, of_shaft = self.pose(gear), self.pose(shaft)
        if of_gear is not None and of_shaft is not None:
            return float((of_gear.origin - of_shaft.origin) @ of_shaft.axes[0])
        middle = 0.5 * gear.required("face_width", LENGTH) if self.model.version == "1.0" else 0.0
        return gear.required("u_coordinate_on_shaft", LENGTH) + middle

    def along(self, component: Component | None) -> Array:
        """Return the u axis (3,) of a component, x of the gear unit where the file does not have it."""
        pose = None if component is None else self.pose(component)
        return np.array([1.0, 0.0, 0.0]) if pose is None else pose.axes[0]

    # stages

    @cached_property
    def stages(self) -> dict[str, Stage]:
        """All stages of two cylindrical gears or of a gear and a ring, by id; those that cannot be read are left."""
        stages = {}
        for one, gears in self._gears_of_stages():
            try:
                stages[one.id] = self._stage(one, gears)
            except InputError as error:
                self._faults[one.id] = error
                self.reading.leave(one, f"its forces: {'; '.join(error.problems)}")
        return stages

    def _gears_of_stages(self) -> Iterator[tuple[Component, tuple[Component, Component]]]:
        for one in self.model.of_type("cylindrical_stage"):
            both = [self.model.related("stage", "stage", one.id, role) for role in ("gear_1", "gear_2")]
            if all(len(gears) == 1 and gears[0].type in GEARS for gears in both):
                yield one, (both[0][0], both[1][0])

    def stage(self, wanted: str) -> Stage:
        """Return a stage by its id.

        Raises
        ------
        InputError
            If there is none, with those that there are; if it is of another kind, or has no two gears.
        """
        ids = ", ".join(self.stages) or "none, the model has no cylindrical stage of two gears"
        component = self.model.components.get(wanted)
        if component is None or not component.type.endswith("stage"):
            raise InputError(f"stage {wanted}: not found; allowed {ids}")
        if wanted in self._faults:
            raise self._faults[wanted]
        if wanted not in self.stages:
            kind = component.type.removesuffix("_stage")
            reason = (
                "its relation has no gear_1 and gear_2" if kind == "cylindrical" else f"{kind} stages are not covered"
            )
            raise InputError(
                f"stage {wanted}: {reason}; import makes scenes of cylindrical stages (spur and helical gears, also a "
                f"planet in its sun or ring) of two gears: {ids}"
            )
        return self.stages[wanted]

    def _stage(self, component: Component, gears: tuple[Component, Component]) -> Stage:
        signed = [one.whole("number_of_teeth") for one in gears]
        for one, teeth in zip(gears, signed, strict=True):
            require(
                (teeth != 0, f"{one}: number_of_teeth: found 0; allowed whole numbers, negative ones of ring gears")
            )
        rings = [one.type == "ring_gear" or teeth < 0 for one, teeth in zip(gears, signed, strict=True)]
        require((not all(rings), f"{component}: both gears are ring gears; allowed one"))
        order = (0, 1) if (rings[0], abs(signed[0])) <= (rings[1], abs(signed[1])) else (1, 0)
        pinion, wheel = (gears[n] for n in order)
        shafts = self.shaft_of(pinion), self.shaft_of(wheel)
        axis = self.along(shafts[0] or pinion)
        middles, placed = self._middles(component, (pinion, wheel), shafts, turned=order == (1, 0))
        between = middles[1] - middles[0]
        towards = between - (between @ axis) * axis
        length = float(np.linalg.norm(towards))
        require((length > 0.0, f"{component}: found both gears on one axis; allowed a centre distance above 0"))
        tilt = float(np.linalg.norm(np.cross(axis, self.along(shafts[1] or wheel))))
        require((tilt < PARALLEL, f"{component}: found axes that are not parallel; allowed parallel ones"))
        x = towards / length
        return Stage(
            component,
            (pinion, wheel),
            shafts,
            (abs(signed[order[0]]), abs(signed[order[1]])),
            any(rings),
            np.stack([-x if any(rings) else x, np.cross(axis, -x if any(rings) else x), axis]),
            middles,
            placed,
        )

    def _middles(
        self,
        component: Component,
        gears: tuple[Component, Component],
        shafts: tuple[Component | None, Component | None],
        *,
        turned: bool,
    ) -> tuple[Array, bool]:
        """Middles (2, 3) of both faces, and whether the file has them."""
        pinion, wheel = (self._middle(gear, shaft) for gear, shaft in zip(gears, shafts, strict=True))
        if pinion is not None and wheel is not None:
            return np.stack([pinion, wheel]), True
        angle = math.radians(component.number("rotating_angle_around_neg_u_axis", ANGLE) or 0.0)
        pose = None if shafts[0] is None else self.pose(shafts[0])
        _, v, w = np.eye(3) if pose is None else pose.axes
        towards = math.cos(angle) * w + math.sin(angle) * v
        distance = abs(component.number("center_distance", LENGTH) or 1.0)
        return np.stack([np.zeros(3), (-distance if turned else distance) * towards]), False

    def _middle(self, gear: Component, shaft: Component | None) -> Array | None:
        pose = self.pose(gear)
        if pose is not None:
            return pose.origin
        of_shaft = None if shaft is None else self.pose(shaft)
        if of_shaft is None or shaft is None or "u_coordinate_on_shaft" not in gear.attributes:
            return None
        return np.asarray(of_shaft.origin + self.place_on_shaft(gear, shaft) * of_shaft.axes[0])

    # torques and speeds

    @cached_property
    def _planetary(self) -> list[list[Stage]]:
        """Stages of each planetary stage that share a central gear: they carry the same."""
        groups = []
        for meshes in self._of_planetary_stages():
            by_gear: dict[str, list[Stage]] = {}
            for mesh in meshes:
                for gear in mesh.gears:
                    by_gear.setdefault(gear.id, []).append(mesh)
            groups += [same for same in by_gear.values() if len(same) > 1 and len({one.internal for one in same}) == 1]
        return groups

    def _of_planetary_stages(self) -> Iterator[list[Stage]]:
        for whole in self.model.of_type("planetary_stage"):
            parts = self.model.related("assembly", "assembly", whole.id, "part")
            yield [self.stages[one.id] for one in parts if one.id in self.stages]

    def torque_ratio(self, stage: Stage) -> float:
        """Torque by the teeth on the wheel over that on the pinion, each about the u axis of its own shaft."""
        same = float(np.sign(self.along(stage.shafts[1]) @ self.along(stage.shafts[0])))
        return same * (-1.0 if stage.internal else 1.0) * stage.teeth[1] / stage.teeth[0]

    def applied(self, load: Component, speed: float | None) -> float | None:
        """Return the torque of a load on its shaft about the u axis [N m]; None where it follows from the others."""
        torque = load.number("torque_around_u_axis", TORQUE)
        if torque is not None:
            return torque
        power = load.number("power", POWER)
        if power and speed:
            return 3e4 / math.pi * power / speed
        return 0.0 if power == 0.0 or load.flag("transmits_torque") is False else None

    @property
    def tooth_torques(self) -> dict[str, float]:
        """Torque by the teeth on the pinion of each stage about the u axis of its shaft [N m], where it is known."""
        return {name: torque for name, torque in self._balance.items() if name in self.stages}

    @cached_property
    def load_torques(self) -> dict[str, float]:
        """Torque of each load on a shaft about the u axis [N m], by the file or by the balance where that has it."""
        torques = {}
        for shaft in self.model.of_type("shaft"):
            for load in self.parts_of(shaft, "external_load"):
                torque = self.applied(load, self.speeds.get(shaft.id))
                torque = self._balance.get(f"load {load.id}") if torque is None else torque
                if torque is not None:
                    torques[load.id] = torque
        return torques

    @cached_property
    def _balance(self) -> dict[str, float]:
        """Torques that are determined [N m]: of stages, and of loads and shafts of which the file has none.

        Every shaft is in balance; stages of a planetary stage share alike.
        """
        unknown: dict[str, int] = {name: n for n, name in enumerate(self.stages)}
        rows, right = [], []
        for shaft in self.model.of_type("shaft"):
            row, given = self._balance_of(shaft, unknown)
            rows.append(row)
            right.append(-given)
        for same in self._planetary:
            rows += [{unknown[same[0].id]: 1.0, unknown[one.id]: -1.0} for one in same[1:]]
            right += [0.0] * (len(same) - 1)
        if not rows or not unknown:
            return {}
        matrix = np.zeros((len(rows), len(unknown)))
        for n, row in enumerate(rows):
            matrix[n, list(row)] = list(row.values())
        torques = np.linalg.lstsq(matrix, np.array(right), rcond=None)[0]
        _, sizes, directions = np.linalg.svd(matrix)
        free = directions[int((sizes > ROUNDING * sizes.max(initial=1.0)).sum()) :]
        determined = np.abs(free).max(axis=0, initial=0.0) < DETERMINED
        return {name: float(torques[n]) for name, n in unknown.items() if determined[n]}

    def _balance_of(self, shaft: Component, unknown: dict[str, int]) -> tuple[dict[int, float], float]:
        """Factors of the unknown torques on a shaft, which new ones join, and the sum of the known ones [N m]."""
        row: dict[int, float] = {}
        given = 0.0
        for stage in self.stages.values():
            for gear, factor in zip(stage.shafts, (1.0, self.torque_ratio(stage)), strict=True):
                if gear is not None and gear.id == shaft.id:
                    row[unknown[stage.id]] = row.get(unknown[stage.id], 0.0) + factor
        for load in self.parts_of(shaft, "external_load"):
            torque = self.applied(load, self.speeds.get(shaft.id))
            given += torque or 0.0
            if torque is None:
                row[unknown.setdefault(f"load {load.id}", len(unknown))] = 1.0
        if self._is_coupled(shaft):
            row[unknown.setdefault(f"shaft {shaft.id}", len(unknown))] = 1.0
        return row, given

    def _is_coupled(self, shaft: Component) -> bool:
        """Whether something beside the balance turns a shaft: a coupling, a carrier, a bevel or worm gear."""
        sides = [
            part
            for role in ("inner_part", "outer_part")
            for part in self.model.related("side", role, shaft.id, "assembly")
        ]
        above = self.model.related("assembly", "part", shaft.id, "assembly")
        of_stages = {gear.id for stage in self.stages.values() for gear in stage.gears}
        parts = self.model.related("assembly", "assembly", shaft.id, "part")
        strange = [
            one for one in parts if one.type.endswith(("_gear", "worm", "worm_wheel")) and one.id not in of_stages
        ]
        return bool(strange) or any(one.type in COUPLINGS for one in [*sides, *above])

    @cached_property
    def speeds(self) -> dict[str, float]:
        """Speed of each shaft about its u axis [1/min], where the file has it or stages with fixed axes give it."""
        speeds = {
            one.id: speed
            for one in self.model.of_type("shaft")
            if (speed := one.number("rotational_speed", SPEED)) is not None
        }
        moving = {mesh.id for meshes in self._of_planetary_stages() for mesh in meshes}
        fixed = [one for one in self.stages.values() if one.id not in moving and None not in one.shafts]
        for _ in fixed:
            for stage in fixed:
                first, second = (one.id for one in stage.shafts if one is not None)
                ratio = -1.0 / self.torque_ratio(stage)
                if first in speeds and second not in speeds:
                    speeds[second] = speeds[first] * ratio
                elif second in speeds and first not in speeds:
                    speeds[first] = speeds[second] / ratio
        return speeds
