"""Gears of a REXS stage as sections of a scene: teeth, flanks, tools, materials; which flanks are loaded.

Flanks are left and right as seen on the datum face with the tooth upwards (ISO 1122-1); the datum face is that of the
lower u, where the file does not say otherwise. Right flanks mate with right flanks.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from loaded_tca.arrays import GEARS
from loaded_tca.errors import InputError, require
from loaded_tca.exchange.gearbox import Gearbox, Stage
from loaded_tca.exchange.model import (
    ANGLE,
    BOOKKEEPING,
    CONDUCTIVITY,
    DENSITY,
    HEAT,
    LENGTH,
    PRESSURE,
    SMALL_LENGTH,
    TORQUE,
    Component,
    Reading,
)
from loaded_tca.plain import plain

STEEL = {"youngs_modulus_MPa": 206000.0, "poisson_ratio": 0.3}
ALIKE = 1e-6
"""Relative difference of two numbers that are the same."""
ROUNDED_ROOT = 0.02
"""Difference over the module of root diameters that are one: 0.01 mm at module 0.5, to which drawings round."""
FLANKS = "left", "right"
MATERIAL_KEYS = {
    "density_kg_m3": ("density", DENSITY),
    "conductivity_W_mK": ("thermal_conductivity", CONDUCTIVITY),
    "heat_capacity_J_kgK": ("thermal_capacity", HEAT),
}
RACK = {
    "dedendum_coefficient": ("addendum_coefficient_reference_profile", "addendum_reference_profile"),
    "root_radius_coefficient": ("tip_radius_factor", "tip_radius"),
}
"""Numbers of a basic rack -> attributes of the tool that cuts it: over the module, and as a length."""
TORQUE_DIGITS = 9
"""Of torques that follow from a balance [N m]."""
ROUNDING = 1e-9
"""Relative difference of two torques that are the same."""
DIGITS = 6
"""Of amounts in um: digits of mm in files end in rounding."""


@dataclass(frozen=True)
class Operation:
    """How a stage runs: torque on the pinion [N m], speed of the pinion [1/min], who drives which way round.

    Attributes
    ----------
    torque : float [N m]
        Magnitude.
    side : int
        +1 where the teeth turn the pinion back about z: flanks whose outward normal has a positive azimuthal part.
    driving, sense : str
    speed : float [1/min] or None
    torque_factor : float
        The torque over that of the file.
    """

    torque: float
    side: int
    driving: str
    sense: str
    speed: float | None
    torque_factor: float


def gear_data(reading: Reading, stage: Stage) -> list[Component | None]:
    """Return what the file has of pinion and wheel in this stage."""
    data = []
    for gear in stage.gears:
        relations = [
            one
            for one in reading.model.relations
            if one.type == "stage_gear_data"
            and (one.roles.get("stage"), one.roles.get("gear")) == (stage.id, gear.id)
            and "stage_gear_data" in one.roles
        ]
        data.append(reading.model.components[relations[0].roles["stage_gear_data"]] if relations else None)
    return data


def datum_sign(reading: Reading, gear: Component) -> int:
    """Return -1 where the datum face of a gear is at its lower u, +1 where it is at the other end."""
    reading.take(gear, "datum_face_orientation")
    return 1 if gear.text("datum_face_orientation") == "positive" else -1


def axis_sign(gearbox: Gearbox, stage: Stage, gear: int) -> int:
    """Return the sense of the u axis of a gear along z of the pinion's frame."""
    component = stage.gears[gear]
    placed = component if gearbox.pose(component) is not None else stage.shafts[gear]
    return 1 if float(gearbox.along(placed) @ stage.axes[2]) >= 0.0 else -1


def operation_of(gearbox: Gearbox, stage: Stage, torque: float | None) -> Operation:
    """Return how a stage runs.

    Parameters
    ----------
    gearbox : Gearbox
    stage : Stage
    torque : float [N m] or None
        That on the pinion, instead of the file's.

    Raises
    ------
    InputError
        If the file has no torque from which that of the pinion follows, and none is given; if the given one is 0.
    """
    if torque is not None:
        require((0.0 < abs(torque) < math.inf, f"torque_Nm: found {torque}; allowed other than 0"))
    reading, data = gearbox.reading, gear_data(gearbox.reading, stage)
    reading.touch(one for one in data if one is not None)
    by_balance = gearbox.tooth_torques.get(stage.id)
    of_file = _stated_torque(reading, stage, data)
    in_file = next((abs(one) for one in (of_file, by_balance) if one), None)
    magnitude = in_file if torque is None else abs(torque)
    if magnitude is None:
        raise InputError(
            f"stage {stage.id}: torque: missing in the stage, and not to be had from the loads on the shafts; give "
            "--torque, the torque on the pinion in N m"
        )
    speed = None if stage.shafts[0] is None else gearbox.speeds.get(stage.shafts[0].id)
    side = _side(gearbox, stage, data, by_balance)
    turning = 0 if not speed else (1 if speed > 0.0 else -1)
    if turning:
        driving = "pinion" if turning == side else "wheel"
    else:
        driving = _said_to_drive(reading, data) or "pinion"
        turning = side if driving == "pinion" else -side
        reading.note(f"stage {stage.id}: no speed of its pinion; the {driving} is taken as the driving gear")
    return Operation(
        round(magnitude, TORQUE_DIGITS),
        side,
        driving,
        "positive" if turning > 0 else "negative",
        abs(speed) if speed else None,
        _torque_factor(reading, stage, magnitude, in_file),
    )


def _torque_factor(reading: Reading, stage: Stage, torque: float, in_file: float | None) -> float:
    """Torque on the pinion over that of the file [N m]; 1 where the file has none."""
    beside = "torques of other stages and loads"
    if in_file is None:
        reading.note(f"stage {stage.id}: {beside} are those of the file, which has no torque of the stage")
        return 1.0
    factor = torque / in_file
    if math.isclose(factor, 1.0, rel_tol=ROUNDING):
        return 1.0
    of_file = f"the torque asked for over that of the file, {plain(in_file, 6)} N m"
    reading.note(f"stage {stage.id}: {beside} are {plain(factor, 6)} times those of the file, {of_file}")
    return factor


def _stated_torque(reading: Reading, stage: Stage, data: list[Component | None]) -> float | None:
    """Torque on the pinion by what the file has of the gears in this stage [N m]."""
    torques = [None if one is None else reading.number(one, "torque", TORQUE) for one in data]
    if torques[0] or not torques[1]:
        return torques[0]
    return torques[1] * stage.teeth[0] / stage.teeth[1]


def _said_to_drive(reading: Reading, data: list[Component | None]) -> str | None:
    """Which gear drives by the file; None where it names none, or both."""
    flags = [bool(one and reading.take(one, "is_driving_gear").flag("is_driving_gear")) for one in data]
    return GEARS[flags.index(True)] if flags.count(True) == 1 else None


def _side(gearbox: Gearbox, stage: Stage, data: list[Component | None], torque: float | None) -> int:
    """Side of the loaded flanks: by the torque of the teeth, by the loaded flank of the file, or assumed."""
    reading = gearbox.reading
    for n, one in enumerate(data):
        loaded = "" if one is None else reading.take(one, "loaded_tooth_flank").text("loaded_tooth_flank")
        if not torque and loaded in FLANKS:
            right = -axis_sign(gearbox, stage, n) * datum_sign(reading, stage.gears[n])
            return right if loaded == "right" else -right
    if not torque:
        reading.note(
            f"stage {stage.id}: neither torque nor loaded flank has a sign; the pinion is taken to drive about +z"
        )
        return 1
    return -1 if torque > 0.0 else 1


def flank_of(gearbox: Gearbox, stage: Stage, gear: int, side: int) -> Component | None:
    """Return the loaded flank of a gear; what the other one has is left."""
    reading, component = gearbox.reading, stage.gears[gear]
    right = -axis_sign(gearbox, stage, gear) * datum_sign(reading, component)
    wanted = "right" if right == side else "left"
    data = gear_data(reading, stage)[gear]
    stated = "" if data is None else data.text("loaded_tooth_flank")
    if stated in FLANKS and stated != wanted:
        by_torque = f"the torque would load the {wanted} one"
        reading.note(f"{component}: the file says that the {stated} flank is loaded; {by_torque}")
        wanted = stated
    both = {one: reading.model.related("flank", "gear", component.id, one) for one in FLANKS}
    other = both["left" if wanted == "right" else "right"]
    chosen = next(iter(both[wanted] or other), None)
    if chosen is not None:
        reading.touch([chosen])
    for one in other:
        if chosen is not None and one.id != chosen.id:
            _compare_flanks(reading, chosen, one)
    return chosen


def _compare_flanks(reading: Reading, chosen: Component, other: Component) -> None:
    """Leave the flank that is not loaded, with what it has otherwise."""
    differing = [
        name
        for name in ("normal_pressure_angle", "addendum_modification_coefficient")
        if chosen.attributes.get(name) != other.attributes.get(name)
    ]
    if differing:
        reading.leave(other, f"the flank without load has another {' and '.join(differing)}")
    of_chosen, of_other = (_modifications(reading, flank) for flank in (chosen, other))
    if of_other != of_chosen:
        listed = "; ".join(of_other) or "none"
        reading.leave(other, f"modifications of the flank without load, which differ from the loaded one: {listed}")


def _modifications(reading: Reading, flank: Component) -> list[str]:
    """Modifications of a flank with what the file says of each."""
    listed = []
    for one in reading.model.related("reference", "origin", flank.id, "referenced"):
        if one.type != "material":
            values = ", ".join(
                f"{name} {each.value}" + (f" {each.unit}" if each.unit != "none" else "")
                for name, each in one.attributes.items()
                if name not in BOOKKEEPING
            )
            listed.append(f"{one.type} ({values})")
    return sorted(listed)


def tools_of(reading: Reading, gear: Component, flank: Component | None) -> list[Component]:
    """Return the tools of a gear: of its loaded flank since version 1.3, of the gear itself before."""
    tools = [] if flank is None else reading.model.related("manufacturing_step", "workpiece", flank.id, "tool")
    tools += reading.model.related("manufacturing_step", "workpiece", gear.id, "tool")
    tools += reading.model.related("ordered_reference", "origin", gear.id, "referenced")
    tools += reading.model.related("reference", "origin", gear.id, "referenced")
    tools = [one for one in tools if one.type.endswith("_tool")]
    reading.touch(tools)
    for one in tools[1:]:
        reading.leave(one, "a further tool; a scene has the first one alone")
    return tools


def pair_section(gearbox: Gearbox, stage: Stage, flanks: list[Component | None], run: Operation) -> dict[str, Any]:
    """Return the section [pair] of a stage."""
    reading = gearbox.reading
    module = _common(reading, stage, "normal_module", LENGTH)
    angles = [reading.number(one, "helix_angle_reference_diameter", ANGLE, 0.0) or 0.0 for one in stage.gears]
    hands = [round(math.copysign(1.0, one)) for one in angles]
    opposite = stage.internal or angles[0] == 0.0 or hands[0] != hands[1]
    require(
        (
            abs(abs(angles[0]) - abs(angles[1])) < 1e-6,
            f"{stage.component}: helix_angle_reference_diameter: found {plain(angles[0], 6)} and {plain(angles[1], 6)} "
            f"deg of {stage.gears[0]} and {stage.gears[1]}; allowed equal ones with opposite signs",
        ),
        (
            opposite,
            f"{stage.component}: helix_angle_reference_diameter: found {plain(angles[0], 6)} deg on both gears; "
            "allowed opposite signs: the gears of an external stage have opposite hands",
        ),
    )
    section: dict[str, Any] = {
        "type": "cylindrical",
        "normal_module_mm": module,
        "pressure_angle_deg": _pressure_angle(reading, stage, flanks),
        "helix_angle_deg": abs(angles[0]),
    }
    distance = reading.number(stage.component, "center_distance", LENGTH)
    if distance is None and stage.placed:
        distance = stage.distance
        reading.note(
            f"{stage.component}: no center_distance; taken from the places of the gears, {plain(distance, 6)} mm"
        )
    if distance is not None:
        section["centre_distance_mm"] = abs(distance)
    if distance is not None and stage.placed and abs(abs(distance) - stage.distance) > 1e-3 * module:
        reading.note(
            f"{stage.component}: center_distance is taken; the gears are placed {plain(stage.distance, 6)} mm apart"
        )
    reading.take(stage.component, "rotating_angle_around_neg_u_axis")
    return section | {"driving": run.driving, "sense": run.sense} | _rack(reading, stage, flanks, module)


def _common(reading: Reading, stage: Stage, name: str, units: Any) -> float:
    """A number that both gears must have alike."""
    first, second = (reading.take(one, name).required(name, units) for one in stage.gears)
    alike = abs(first - second) <= ALIKE * abs(first)
    require(
        (
            alike,
            f"{stage.component}: {name}: found {plain(first, 6)} and {plain(second, 6)} of its gears; allowed "
            "equal ones",
        )
    )
    return first


def _pressure_angle(reading: Reading, stage: Stage, flanks: list[Component | None]) -> float:
    name = "normal_pressure_angle"
    values = []
    for gear, flank in zip(stage.gears, flanks, strict=True):
        places = [one for one in (flank, *tools_of(reading, gear, flank)) if one is not None]
        values += [value for one in places if (value := reading.number(one, name, ANGLE)) is not None][:1]
    if not values:
        gears = " and ".join(str(one) for one in stage.gears)
        raise InputError(f"{stage.component}: {name}: missing; neither the flanks nor the tools of {gears} have it")
    alike = max(values) - min(values) < 1e-6
    require(
        (
            alike,
            f"{stage.component}: {name}: found {plain(values[0], 6)} and {plain(values[-1], 6)} deg; allowed "
            "equal ones",
        )
    )
    return values[0]


def _rack(reading: Reading, stage: Stage, flanks: list[Component | None], module: float) -> dict[str, float]:
    """Basic rack of the pair: each number that of the first gear whose tool has it."""
    rack = {}
    for name in RACK:
        by_tools = (_by_tool(reading, *pair, module, name) for pair in zip(stage.gears, flanks, strict=True))
        value = next((one for one in by_tools if one is not None), None)
        if value is not None:
            rack[name] = value
    return rack


def _by_tool(reading: Reading, gear: Component, flank: Component | None, module: float, name: str) -> float | None:
    """Dedendum or root radius of the rack of a gear: addendum or tip radius of its tool; None where it has none."""
    for tool in tools_of(reading, gear, flank)[:1]:
        value = _per_module(reading, tool, module, *RACK[name])
        return value if name != "root_radius_coefficient" or tool.type == "rack_shaped_tool" else None
    return None


def _own_rack(
    reading: Reading, gear: Component, flank: Component | None, pair: dict[str, Any], names: list[str]
) -> dict[str, float]:
    """What the rack of a gear has other than that of the pair; notes what this has by the tool of the other gear."""
    rack = {}
    for name in (one for one in names if one in pair):
        value = _by_tool(reading, gear, flank, pair["normal_module_mm"], name)
        if value is None:
            by_other = f"{name} {plain(pair[name], 6)} is taken from the tool of the other gear"
            reading.note(f"{gear}: no tool with {RACK[name][0]}; {by_other}")
        elif abs(value - pair[name]) > ALIKE:
            rack[name] = value
    return rack


def _per_module(reading: Reading, component: Component, module: float, factor: str, length: str) -> float | None:
    """A factor of the module, given as such or as a length."""
    value = reading.number(component, factor)
    in_mm = reading.number(component, length, LENGTH)
    return in_mm / module if value is None and in_mm is not None else value


def gear_section(
    gearbox: Gearbox, stage: Stage, gear: int, flank: Component | None, pair: dict[str, Any]
) -> dict[str, Any]:
    """Return the section of a gear, without its modifications and its shaft.

    Parameters
    ----------
    gearbox : Gearbox
    stage : Stage
    gear : int
        0 the pinion, 1 the wheel.
    flank : Component or None
        The loaded one.
    pair : dict
        Section [pair].
    """
    reading, component = gearbox.reading, stage.gears[gear]
    module, ring = pair["normal_module_mm"], stage.internal and gear == 1
    reading.take(component, "number_of_teeth", "face_width", "u_coordinate_on_shaft")
    section: dict[str, Any] = {
        "teeth": -stage.teeth[gear] if ring else stage.teeth[gear],
        "face_width_mm": component.required("face_width", LENGTH),
    }
    angle = stage.gears[0].number("helix_angle_reference_diameter", ANGLE) or 0.0
    if angle:
        positive = (angle > 0.0) == (gear == 0 or stage.internal)
        section["hand"] = "right" if positive else "left"
    section |= _profile_shift(reading, flank, module, pair["pressure_angle_deg"])
    if ring and section.get("profile_shift"):
        reading.note(f"{component}: a positive profile shift of the ring thickens its teeth, as in ISO 21771")
    section |= _tip(reading, component, None if ring else flank)
    if ring:
        section |= _cutter(reading, component, flank)
    by_tool = None if ring else _by_tool(reading, component, flank, module, "dedendum_coefficient")
    if (root := reading.number(component, "root_diameter", LENGTH)) is not None:
        if by_tool is None:
            section["root_diameter_mm"] = abs(root)
        else:
            _compare_roots(reading, component, root, by_tool, section, pair)
    elsewhere = {"dedendum_coefficient": "root_diameter_mm", "root_radius_coefficient": "cutter"}
    section |= _own_rack(reading, component, flank, pair, [name for name in RACK if elsewhere[name] not in section])
    if not ring and (bore := reading.number(component, "inner_diameter", LENGTH)):
        section["bore_diameter_mm"] = bore
    roughness = reading.number(component, "arithmetic_average_roughness_flank", SMALL_LENGTH)
    if roughness:
        section["roughness_Ra_um"] = round(roughness, DIGITS)
    return section


def _compare_roots(
    reading: Reading, gear: Component, root: float, dedendum: float, section: dict[str, Any], pair: dict[str, Any]
) -> None:
    """Note a root diameter [mm] that is neither the nominal nor the generated one of the dedendum by the tool."""
    if "profile_shift" not in section:
        return  # it follows from the centre distance, and the root with it
    module, shift = pair["normal_module_mm"], section["profile_shift"]
    pressure, helix = (math.radians(pair.get(f"{name}_angle_deg", 0.0)) for name in ("pressure", "helix"))
    thinner = 1e-3 * section.get("thickness_allowance_um", 0.0) / (2.0 * math.tan(pressure))
    nominal = module * (section["teeth"] / math.cos(helix) - 2.0 * (dedendum - shift))
    cut = nominal + 2.0 * thinner
    if min(abs(root - nominal), abs(root - cut)) > ROUNDED_ROOT * module:
        reading.note(
            f"{gear}: the addendum of the tool is taken, which cuts a root diameter of {plain(cut, 6)} mm; "
            f"root_diameter, {plain(root, 6)} mm, contradicts it and is not taken"
        )


def _profile_shift(reading: Reading, flank: Component | None, module: float, angle: float) -> dict[str, float]:
    """Nominal profile shift, and what the finished teeth are thinner."""
    if flank is None:
        return {}
    shift = _per_module(reading, flank, module, "addendum_modification_coefficient", "addendum_modification")
    if shift is None:
        return {}
    finished = reading.number(flank, "addendum_modification_coefficient_after_finishing")
    if finished is None or abs(finished - shift) < ALIKE:
        return {"profile_shift": shift}
    allowance = 2e3 * module * math.tan(math.radians(angle)) * (finished - shift)
    return {"profile_shift": shift, "thickness_allowance_um": round(allowance, DIGITS)}


def _tip(reading: Reading, gear: Component, flank: Component | None) -> dict[str, float]:
    """Tip diameter, or the addendum of the basic profile where it is not 1."""
    diameter = reading.number(gear, "tip_diameter", LENGTH)
    if diameter is not None:
        return {"tip_diameter_mm": abs(diameter)}
    addendum = None if flank is None else reading.number(flank, "addendum_coefficient_basic_profile")
    if addendum is None or addendum == 1.0:
        return {}
    return {"addendum_coefficient": addendum}


def _cutter(reading: Reading, gear: Component, flank: Component | None) -> dict[str, Any]:
    """Pinion-type cutter of a ring."""
    for tool in tools_of(reading, gear, flank)[:1]:
        if tool.type == "cutter_wheel_tool" and "number_of_teeth" in tool.attributes:
            cutter: dict[str, Any] = {"teeth": reading.take(tool, "number_of_teeth").whole("number_of_teeth")}
            for key, name in (
                ("profile_shift", "addendum_modification_coefficient"),
                ("tip_radius_coefficient", "tip_radius_factor"),
            ):
                if (value := reading.number(tool, name)) is not None:
                    cutter[key] = value
            return {"cutter": cutter}
    return {}


def material_section(reading: Reading, component: Component) -> dict[str, float] | None:
    """Return the material of a component; None where the file has none with both elastic constants."""
    materials = [
        material
        for material in reading.model.related("reference", "origin", component.id, "referenced")
        if material.type == "material"
    ]
    if not materials:
        return None
    material = materials[0]
    modulus = reading.number(material, "elastic_modulus", PRESSURE)
    ratio = reading.number(material, "poisson_ratio")
    if modulus is None or ratio is None:
        reading.leave(material, "it has not both elastic_modulus and poisson_ratio")
        return None
    section = {"youngs_modulus_MPa": modulus, "poisson_ratio": ratio}
    for key, (name, units) in MATERIAL_KEYS.items():
        if value := reading.number(material, name, units):
            section[key] = value
    return section
