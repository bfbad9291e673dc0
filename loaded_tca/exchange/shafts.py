"""Shafts of a REXS stage as sections of a scene: their parts, bearings, and the loads of everything else on them.

Places along a shaft count from the middle of the gear's face, axes are those of the gear's own frame. Bearings are
those of :mod:`loaded_tca.exchange.bearings`.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np

from loaded_tca.arrays import GEARS, Array
from loaded_tca.errors import InputError
from loaded_tca.exchange.bearings import BEARINGS, bearing_rows
from loaded_tca.exchange.gearbox import Gearbox, Stage
from loaded_tca.exchange.model import ANGLE, FORCE, LENGTH, TORQUE, Component, Reading
from loaded_tca.plain import plain

STEEPEST = math.radians(89.0)
"""Helix angle above which gears are none."""
STEPS = 8
"""Cylinders that a cone becomes."""
GAP = 1e-3
"""Between two parts of a shaft that follow each other [mm]."""
DIGITS = 9
"""Of lengths and forces that were computed."""


class NotTaken(Exception):  # noqa: N818
    """Why a shaft is left out of the scene."""


def shaft_section(gearbox: Gearbox, stage: Stage, gear: int, torque_factor: float = 1.0) -> dict[str, Any] | None:
    """Return the section [pinion.shaft] or [wheel.shaft]; None where the file has none that a scene can have.

    Parameters
    ----------
    gearbox : Gearbox
    stage : Stage
    gear : int
        0 the pinion, 1 the wheel.
    torque_factor : float
        Torques of the scene over those of the file.
    """
    reading, shaft = gearbox.reading, stage.shafts[gear]
    if shaft is None:
        reading.leave(stage.gears[gear], f"it is on no shaft; {GEARS[gear]} without a support")
        return None
    frame = ShaftFrame(gearbox, stage, gear, shaft, torque_factor)
    reading.take(shaft, "rotational_speed", "defines_speed")
    try:
        if stage.internal and gear == 1:
            raise NotTaken("the shaft of a ring gear; its outside is held rigid in the scene")
        sections, start = frame.sections()
        bearings = frame.bearings()
    except NotTaken as reason:
        reading.leave(shaft, f"{reason}; {GEARS[gear]} without a support")
        return None
    torque_at, loads = frame.loads()
    section: dict[str, Any] = {"start_mm": start, "torque_at_mm": torque_at, "sections": sections}
    section["bearings"] = bearings
    if loads:
        section["loads"] = loads
    return section


def diameter_at(gearbox: Gearbox, stage: Stage, gear: int) -> float | None:
    """Return the outer diameter of the shaft at the middle of a gear's face [mm]; None where it has none there."""
    shaft = stage.shafts[gear]
    if shaft is None:
        return None
    frame = ShaftFrame(gearbox, stage, gear, shaft)
    try:
        parts = frame.parts()
    except NotTaken:
        return None
    middle = gearbox.place_on_shaft(stage.gears[gear], shaft)
    for low, high, (first, last), _ in parts:
        if low <= middle <= high:
            return first + (last - first) * (middle - low) / (high - low)
    return None


Part = tuple[float, float, tuple[float, float], tuple[float, float]]
"""Lower and upper end along u, outer and inner diameters there [mm]."""


class ShaftFrame:
    """A shaft seen from the middle of the face of a gear on it, in the gear's own frame.

    Parameters
    ----------
    gearbox : Gearbox
    stage : Stage
    gear : int
        0 the pinion, 1 the wheel.
    shaft : Component
    torque_factor : float
        Torques of the scene over those of the file; forces of external loads are those of the file.

    Attributes
    ----------
    middle : float [mm]
        Of the face, along the shaft's u axis.
    sign : float
        +1 where u points along the gear's own z, else -1.
    turn : (3, 3) array
        Turns vectors along u, v, w of the shaft into x, y, z of the gear's own frame.
    """

    def __init__(self, gearbox: Gearbox, stage: Stage, gear: int, shaft: Component, torque_factor: float = 1.0) -> None:
        self.gearbox, self.reading, self.stage, self.gear, self.shaft = gearbox, gearbox.reading, stage, gear, shaft
        self.torque_factor = torque_factor
        self.middle = gearbox.place_on_shaft(stage.gears[gear], shaft)
        x, y, z = stage.axes
        self.axes = np.stack([x, y, z] if gear == 0 else [-x, -y, z])
        self.sign = 1.0 if float(gearbox.along(shaft) @ z) >= 0.0 else -1.0
        pose = gearbox.pose(shaft)
        frame = np.eye(3) if pose is None else pose.axes
        self.turn = self.axes @ frame.T  # of vectors along u, v, w of the shaft

    def at(self, place: float) -> float:
        """Axial coordinate of the gear by a place along the shaft [mm]."""
        return round(self.sign * (place - self.middle), DIGITS) + 0.0

    # parts

    def parts(self) -> list[Part]:
        """Parts of the shaft along its u axis, without gaps."""
        parts: list[Part] = []
        end = 0.0
        for one in self.gearbox.parts_of(self.shaft, "shaft_section"):
            take = self.reading.take(
                one, "u_coordinate_on_shaft", "length", "outer_diameter_begin", "outer_diameter_end"
            )
            self.reading.take(one, "inner_diameter_begin", "inner_diameter_end")
            low = take.number("u_coordinate_on_shaft", LENGTH, end)
            assert low is not None
            end = low + take.required("length", LENGTH)
            outer = take.required("outer_diameter_begin", LENGTH)
            inner = take.number("inner_diameter_begin", LENGTH, 0.0) or 0.0
            last = take.number("outer_diameter_end", LENGTH, outer), take.number("inner_diameter_end", LENGTH, inner)
            if end > low:
                parts.append((low, end, (outer, last[0] or outer), (inner, last[1] or 0.0)))
        if not parts:
            raise NotTaken("it has no sections")
        parts.sort()
        for (_, before, *_), (after, *_) in pairwise(parts):
            if abs(after - before) > GAP:
                raise NotTaken(
                    f"its sections leave a gap or overlap: one ends at u = {plain(before, 6)} mm, the next "
                    f"begins at {plain(after, 6)}"
                )
        return parts

    def sections(self) -> tuple[list[dict[str, float]], float]:
        """Sections of the scene from the lower end on, and the place of that end [mm]."""
        parts = self.parts()
        sections = [one for part in parts for one in self._cylinders(*part)]
        low, high = self.at(parts[0][0]), self.at(parts[-1][1])
        return (sections, low) if self.sign > 0.0 else (sections[::-1], high)

    def _cylinders(
        self, low: float, high: float, outer: tuple[float, float], inner: tuple[float, float]
    ) -> list[dict[str, float]]:
        """A cylinder, or steps in the place of a cone."""
        steps = 1 if outer[0] == outer[1] and inner[0] == inner[1] else STEPS
        if steps > 1:
            self.reading.note(f"{self.shaft}: its cones are {STEPS} cylinders each, of the diameters at their middles")
        cylinders = []
        for n in range(steps):
            part = (n + 0.5) / steps
            diameters = [first + (last - first) * part for first, last in (outer, inner)]
            bore = {"inner_diameter_mm": round(diameters[1], DIGITS)} if diameters[1] else {}
            length, outside = round((high - low) / steps, DIGITS), round(diameters[0], DIGITS)
            cylinders.append({"length_mm": length, "outer_diameter_mm": outside, **bore})
        return cylinders

    # bearings

    def held_by(self) -> list[tuple[float, Component, str]]:
        """Bearings on the shaft in the order of the scene: axial coordinate, component, side of the shaft in it."""
        model = self.reading.model
        bearings = []
        for side in ("inner", "outer"):
            for bearing in model.related("side", f"{side}_part", self.shaft.id, "assembly"):
                self.reading.touch([bearing])
                if bearing.type in BEARINGS:
                    self.reading.take(bearing, "u_coordinate_on_shaft_inner_side", "u_coordinate_on_shaft_outer_side")
                    place = bearing.required(f"u_coordinate_on_shaft_{side}_side", LENGTH)
                    bearings.append((self.at(place), bearing, side))
                else:
                    self.reading.leave(bearing, "no bearing; what it holds is not in the scene")
        return sorted(bearings, key=lambda bearing: bearing[0])

    def bearings(self) -> list[dict[str, Any]]:
        """Bearings of the scene; all must have a stiffness."""
        bearings, without = [], []
        thrust = self._thrust()
        for place, one, side in self.held_by():
            self._touch_rows(one)
            rows = bearing_rows(self.reading, one, thrust, self.sign, self.turn)
            if rows is None:
                without.append(one)
                continue
            self._note_other_part(one, side)
            bearings += [{"at_mm": round(place + self.sign * beside, DIGITS) + 0.0, **row} for beside, row in rows]
        if without:
            raise NotTaken(
                "neither stiffness nor inner geometry of "
                + ", ".join(one.label for one in without)
                + ": give radial_stiffness in the file, or write the bearings into the scene"
            )
        if not bearings:
            raise NotTaken("it has no bearings")
        return sorted(bearings, key=lambda one: float(one["at_mm"]))

    def _touch_rows(self, bearing: Component) -> None:
        for row in self.reading.model.related("ordered_assembly", "assembly", bearing.id, "part"):
            self.reading.touch([row, *self.reading.model.related("ordered_assembly", "assembly", row.id, "part")])

    def _note_other_part(self, bearing: Component, side: str) -> None:
        """Note what a bearing sits in that is taken as rigid though it is no casing."""
        other = "outer_part" if side == "inner" else "inner_part"
        parts = self.reading.model.related("side", "assembly", bearing.id, other)
        if parts and parts[0].type != "gear_casing":
            self.reading.note(f"{bearing}: its other side, {parts[0]}, is rigid in the scene")

    # loads

    def loads(self) -> tuple[float, list[dict[str, Any]]]:
        """Where the torque enters or leaves [mm], and all other loads."""
        on_shaft: list[tuple[float, Array, Array, float]] = []
        for one in self.gearbox.parts_of(self.shaft, "external_load"):
            self.reading.touch([one])
            on_shaft.append(self._external(one))
        for stage in self.gearbox.stages.values():
            for n, (gear, shaft) in enumerate(zip(stage.gears, stage.shafts, strict=True)):
                if stage.id != self.stage.id and shaft is not None and shaft.id == self.shaft.id:
                    load = self._tooth_force(stage, n)
                    if load is not None:
                        on_shaft.append(load)
                        self.reading.note(f"{gear}: its tooth force in stage {stage.id} is a load on {self.shaft}")
        carrying = [load for load in on_shaft if load[3]]
        if carrying:
            place = max(carrying, key=lambda load: abs(load[3]))[0]
        elif len(on_shaft) == 1:
            place = on_shaft[0][0]
        else:
            place = 0.0
            self.reading.note(f"{self.shaft}: no place where its torque enters or leaves; taken at mid-face")
        loads = []
        for at, force, moment, torque in on_shaft:
            whole = moment if at == place else moment + self.turn @ np.array([torque, 0.0, 0.0])
            if np.any(np.abs(force) > 1e-9) or np.any(np.abs(whole) > 1e-9):
                loads.append({"at_mm": at, "force_N": _rounded(force), "moment_Nm": _rounded(whole)})
        return place, loads

    def _external(self, load: Component) -> tuple[float, Array, Array, float]:
        """Place, force [N], moment across the axis [N m] and torque about u [N m] of a load."""
        names = [f"force_{axis}_direction" for axis in "uvw"]
        force = np.array([self.reading.number(load, name, FORCE, 0.0) for name in names])
        about = [self.reading.number(load, f"torque_around_{axis}_axis", TORQUE, 0.0) or 0.0 for axis in "vw"]
        self.reading.take(
            load, "u_coordinate_on_shaft", "torque_around_u_axis", "power", "transmits_torque", "defines_torque"
        )
        at = self.at(load.required("u_coordinate_on_shaft", LENGTH))
        if self.torque_factor != 1.0 and (force.any() or any(about)):
            self.reading.note(f"{load}: its forces, and its moments across the axis, are those of the file")
        torque = self.torque_factor * self.gearbox.load_torques.get(load.id, 0.0)
        return at, self.turn @ force, self.turn @ np.array([0.0, *about]), torque

    def _thrust(self) -> float:
        """Axial force of all gears on the shaft, along u [N]; 0 where a torque is not known."""
        whole = 0.0
        for stage in self.gearbox.stages.values():
            for n, shaft in enumerate(stage.shafts):
                if shaft is not None and shaft.id == self.shaft.id:
                    load = self._tooth_force(stage, n, quiet=True)
                    whole += 0.0 if load is None else self.sign * float(load[1][2])
        for one in self.gearbox.parts_of(self.shaft, "external_load"):
            whole += one.number("force_u_direction", FORCE, 0.0) or 0.0
        return whole

    def _tooth_force(self, stage: Stage, gear: int, *, quiet: bool = False) -> tuple[float, Array, Array, float] | None:
        """Place, force [N], moment across the axis [N m] and torque about u [N m] by the teeth of a gear of a stage."""
        torque = self.gearbox.tooth_torques.get(stage.id)
        component = stage.gears[gear]
        try:
            angles = _working_angles(self.gearbox, stage)
            reason = "of unknown torque" if torque is None else "without a centre distance at which its gears mesh"
        except InputError as error:
            angles, reason = None, "; ".join(error.problems)
        if torque is None or angles is None:
            if not quiet:
                self.reading.leave(component, f"its load in stage {stage.id}, {reason}")
            return None
        torque *= self.torque_factor
        if gear == 1:
            torque *= self.gearbox.torque_ratio(stage)
        working_angle, base_helix, base_radii = angles
        along = self.gearbox.along(stage.shafts[gear])
        x = stage.axes[0]
        to_contact = x if gear == 0 or stage.internal else -x
        away = -1.0
        if stage.internal:  # the teeth of the ring press its pinion towards the middle of the ring
            away = -1.0 if gear == 0 else 1.0
        base = 1e3 * abs(torque) / base_radii[gear]
        radius = base_radii[gear] / math.cos(working_angle)
        tangential = math.copysign(base * math.cos(working_angle), torque) * np.cross(along, to_contact)
        radial = away * base * math.sin(working_angle) * to_contact
        helix = component.number("helix_angle_reference_diameter", ANGLE) or 0.0
        hand = 0.0 if helix == 0.0 else math.copysign(1.0, helix)
        axial = -math.copysign(1.0, torque) * hand * base * math.tan(base_helix) * along
        force = self.axes @ (tangential + radial + axial)
        moment = self.axes @ np.cross(radius * to_contact, axial)
        place = self.at(self._middle_of_contact(stage, gear))
        return place, force, 1e-3 * moment, torque * float(np.sign(along @ self.gearbox.along(self.shaft)))

    def _middle_of_contact(self, stage: Stage, gear: int) -> float:
        """Middle of the common face of a stage along the shaft [mm]."""
        place = self.gearbox.place_on_shaft(stage.gears[gear], self.shaft)
        if not stage.placed:
            return place
        halves = [0.5 * one.required("face_width", LENGTH) for one in stage.gears]
        low, high = max(-halves[0], stage.axial_offset - halves[1]), min(halves[0], stage.axial_offset + halves[1])
        beside = 0.5 * (low + high) - (0.0 if gear == 0 else stage.axial_offset)
        sign = float(np.sign(self.gearbox.along(self.shaft) @ stage.axes[2]))
        return place + sign * beside


def _working_angles(gearbox: Gearbox, stage: Stage) -> tuple[float, float, tuple[float, float]] | None:
    """Working transverse pressure angle, base helix angle [rad], base radii [mm] of a stage."""
    model = gearbox.model
    distance = stage.component.number("center_distance", LENGTH)
    distance = stage.distance if distance is None and stage.placed else distance
    flanks = [one for side in ("left", "right") for one in model.related("flank", "gear", stage.gears[0].id, side)]
    normal = next((a for one in flanks if (a := one.number("normal_pressure_angle", ANGLE)) is not None), 20.0)
    module = stage.gears[0].required("normal_module", LENGTH)
    helix = math.radians(abs(stage.gears[0].number("helix_angle_reference_diameter", ANGLE) or 0.0))
    if not (module > 0.0 and helix < STEEPEST and 0.0 < normal < 90.0):
        return None
    transverse = math.atan(math.tan(math.radians(normal)) / math.cos(helix))
    radii = [0.5 * module * teeth / math.cos(helix) * math.cos(transverse) for teeth in stage.teeth]
    base = radii[1] - radii[0] if stage.internal else radii[0] + radii[1]
    if distance is None or abs(distance) < base:
        return None
    working = math.acos(base / abs(distance))
    return working, math.asin(math.sin(helix) * math.cos(math.radians(normal))), (radii[0], radii[1])


def _rounded(vector: Array) -> list[float]:
    return [round(float(one), 6) + 0.0 for one in vector]


def rest_of(reading: Reading) -> list[str]:
    """Return sentences on all that was not taken, with the ids of the components."""
    sentences = list(reading.not_taken)
    sentences += [f"{one.label}: {', '.join(names)}" for one, names in reading.left_over()]
    if reading.others:
        others = ", ".join(f"{count} {kind}" for kind, count in reading.others.items())
        sentences.append(f"parts of the model beside this stage: {others}")
    return sentences
