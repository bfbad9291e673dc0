"""Scenes turned into others that are the same pair of gears: twice as large, in a mirror, with the gears exchanged.

Each function takes a scene and returns the other one, key by key. Axes are those of ``docs/reference/conventions.md``.
"""

from typing import Any

import numpy as np

from loaded_tca.arrays import GEARS
from loaded_tca.scene import Scene
from loaded_tca.scene.parse import scene_from_table
from loaded_tca.scene.section import as_table
from loaded_tca.scene.variants import OF_HALVES

Table = dict[str, Any]
POWERS = {
    "mm_per_rad": 1,
    "N_per_um": 1,
    "Nm_per_mrad": 3,
    "um": 1,
    "mm": 1,
    "Nm": 3,
    "N": 2,
}
"""Ending of a key -> power of the factor of all lengths: stresses and angles stay, forces are as areas."""
OF_MOTIONS = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
"""Power of lengths in x, y, z and in the rotations about them."""
POLYNOMIAL = (1, 0, 0, -1, -1, -1)
"""The same of the coefficients a1 to a6."""
IN_FACE, IN_PLANE = (1.0, 1.0, -1.0, -1.0, -1.0, 1.0), (1.0, -1.0, 1.0, -1.0, 1.0, -1.0)
"""Signs of motions, forces and moments in a mirror across the axis (z), and in one that has both axes (y)."""
OTHER = {"right": "left", "left": "right", "positive": "negative", "negative": "positive"} | {
    "concave": "convex",
    "convex": "concave",
    "pinion": "wheel",
    "wheel": "pinion",
}


# Twice as large


def scaled(scene: Scene, factor: float = 2.0) -> Scene:
    """Every length times a factor, forces by its square, torques by its cube: the same angles and pressures."""
    return scene_from_table(_scaled(as_table(scene), factor))


def _scaled(table: Table, factor: float) -> Table:
    return {name: _scaled_value(name, value, factor) for name, value in table.items()}


def _scaled_value(name: str, value: Any, factor: float) -> Any:
    if isinstance(value, dict):
        return _scaled(value, factor)
    if isinstance(value, tuple | list) and value and isinstance(value[0], dict):
        return [_scaled(one, factor) for one in value]
    if name == "polynomial_mm":
        return [one * factor**power for one, power in zip(value, POLYNOMIAL, strict=True)]
    if name in ("compliance", "stiffness") and not isinstance(value, str):
        # motions over forces (F as lengths squared, M as cubed); a stiffness is the inverse
        moments = 3.0 - OF_MOTIONS[: len(value)]
        powers = OF_MOTIONS[: len(value), None] - moments
        return (np.array(value) * factor ** (powers if name == "compliance" else -powers.T)).tolist()
    power = next((power for ending, power in POWERS.items() if name.endswith(f"_{ending}")), 0)
    if not power or value is None:
        return value
    return (np.asarray(value) * factor**power).tolist()


# Mirrors


def mirrored_along(scene: Scene) -> Scene:
    """A cylindrical pair in a mirror across its axes, z to -z: the hands, and what is upper and lower, change over."""
    table = as_table(scene)
    for gear in GEARS:
        own = table[gear]
        own["hand"] = OTHER[scene.hands[GEARS.index(gear)]]
        own["modifications"] = _turned_over(own["modifications"])
        for tooth in own.get("tooth") or ():
            if tooth.get("modifications"):
                tooth["modifications"] = _turned_over(tooth["modifications"])
        if measurement := own["flank"].get("measurement"):
            _turn_measurement(measurement)
        _mirror_support(own, IN_FACE)
        if "shaft" in own:
            own["shaft"] = _turned_shaft(own["shaft"])
    for name in ("in_plane_deg", "out_of_plane_deg", "misalignment_um", "axial_offset_mm"):
        table["mounting"][name] *= -1.0
    return scene_from_table(table)


def mirrored_across(scene: Scene) -> Scene:
    """A pair in a mirror that has both axes, y to -y: hands, sense of rotation and what lies along y change over."""
    table = as_table(scene)
    for gear, hand in zip(GEARS, scene.hands, strict=True):
        own = table[gear]
        own.get("blank", own)["hand"] = OTHER[hand]
        _mirror_support(own, IN_PLANE)
        if "runout_phase_deg" in own.get("pitch", {}):
            own["pitch"]["runout_phase_deg"] *= -1.0
    if not table["pair"].get("pinion_flank"):
        table["pair"]["sense"] = OTHER[scene.sense]
    for errors in (table["mounting"], table["mounting"].get("half_b", {})):
        for name in ("out_of_plane_deg", "misalignment_um", "offset_mm"):
            if name in errors:
                errors[name] *= -1.0
    return scene_from_table(table)


def halves_exchanged(scene: Scene) -> Scene:
    """A double helical pair in a mirror across its axes: each half in the place of the other one, with its hand.

    Half b may have no mounting errors of its own.
    """
    table = as_table(scene)
    for gear in GEARS:
        own = table[gear]
        if half_b := own.get("half_b"):
            own["half_b"] = {name: own[name] for name in half_b}
            own |= half_b
    for name in ("in_plane_deg", "out_of_plane_deg", "misalignment_um", "axial_offset_mm"):
        table["mounting"][name] *= -1.0
    table["pair"]["apex_offset_mm"] *= -1.0
    return scene_from_table(table)


def half_alone(scene: Scene) -> Scene:
    """Half a of a double helical pair as the helical pair that it is, under half the torque.

    Faces begin at the groove: the middle of a wider one lies farther outwards.
    """
    table = as_table(scene)
    table["mounting"]["axial_offset_mm"] += 0.25 * (table["wheel"]["face_width_mm"] - table["pinion"]["face_width_mm"])
    gap = {name: table["pair"].pop(name, None) for name in OF_HALVES}["gap_mm"]
    for gear in GEARS:
        own = table[gear]
        own["face_width_mm"] = 0.5 * (own["face_width_mm"] - gap)
        for name in ("half_b", "apex_runout_um", "apex_runout_phase_deg"):
            own.pop(name, None)
    table["mounting"].pop("half_b", None)
    table["load"]["pinion_torque_Nm"] *= 0.5
    if torques := table["analysis"].get("torques_Nm"):
        table["analysis"]["torques_Nm"] = [0.5 * torque for torque in torques]
    return scene_from_table(table)


def as_wheel(scene: Scene, teeth: int) -> Scene:
    """A pinion and a rack as that pinion and a wheel of many teeth, which the rack is the limit of.

    An axis error in the plane may not be: a rack tilts about its reference line, a wheel about its axis.
    """
    table = as_table(scene)
    pair, wheel, pinion = table["pair"], table["wheel"], table["pinion"]
    module = pair["normal_module_mm"]
    radius = 0.5 * teeth * module / np.cos(np.radians(pair["helix_angle_deg"]))
    addendum = wheel.pop("addendum_mm", module)
    for name in ("height_mm", "length_mm"):
        wheel.pop(name, None)
    wheel |= {"teeth": teeth, "profile_shift": 0.0}
    wheel["tip_alteration_coefficient"] = addendum / module - pair["addendum_coefficient"]
    if (distance := pair.pop("distance_mm", None)) is None:
        pinion["profile_shift"] = pinion.get("profile_shift") or 0.0
    else:
        pair["centre_distance_mm"] = float(radius + distance)
    for relief in ("tip_relief", "root_relief"):
        if below := wheel["modifications"][f"{relief}_start_mm"]:
            wheel["modifications"][f"{relief}_start_mm"] = float(2.0 * (radius + addendum - below))
    return scene_from_table(table)


def _turned_over(modifications: Table) -> Table:
    """Modifications with both ends of the face in each other's place.

    A helix slope removes nothing at the lower end: turned over it is the opposite slope and its amount everywhere.
    """
    turned, slope = dict(modifications), modifications["helix_slope_um"]
    for length in ("um", "length_mm"):
        lower, upper = (f"end_relief_{end}_{length}" for end in ("lower", "upper"))
        turned[lower], turned[upper] = modifications.get(upper), modifications.get(lower)
    a1, a2, a3, a4, a5, a6 = modifications["polynomial_mm"]
    turned["polynomial_mm"] = [a1 + 1e-3 * slope, -a2, a3, -a4, a5, a6]
    turned["helix_slope_um"], turned["twist_um"] = -slope, -modifications["twist_um"]
    return turned


def _turn_measurement(measurement: Table) -> None:
    for name in ("radius_mm", "axial_mm", "deviation_um"):
        sign = -1.0 if name == "axial_mm" else 1.0
        measurement[name] = (sign * np.array(measurement[name])[:, ::-1]).tolist()


def _mirror_support(own: Table, signs: tuple[float, ...]) -> None:
    for name in ("compliance", "stiffness"):
        if (matrix := own.get("support", {}).get(name)) is not None:
            own["support"][name] = (np.array(matrix) * np.outer(signs, signs)).tolist()


def _turned_shaft(shaft: Table) -> Table:
    """A shaft with its ends in each other's place."""
    turned = dict(shaft)
    length = sum(part["length_mm"] for part in shaft["sections"])
    turned["start_mm"], turned["torque_at_mm"] = -(shaft["start_mm"] + length), -shaft["torque_at_mm"]
    turned["sections"] = list(reversed(shaft["sections"]))
    turned["bearings"] = [_turned_bearing(one) for one in shaft["bearings"]]
    return turned


def _turned_bearing(bearing: Table) -> Table:
    side = bearing.get("side")
    return bearing | {"at_mm": -bearing["at_mm"], "side": None if side is None else -side}


# Gears exchanged


def exchanged(scene: Scene) -> Scene:
    """Pinion and wheel in each other's place: an external cylindrical or bevel pair seen from its wheel.

    The frame is turned half round about z and moved to the other axis, so that the other gear drives, in the other
    sense of rotation. A tilt of the wheel about its own middle is one of the pinion about its own, and a way along the
    axis.

    The pinion angle of the other scene is the angle of the wheel here: states are the same where it is ratio phi1 + the
    unloaded transmission error, not at equal angles. Each gear counts its angle from its own mid-face, so that an axial
    offset dz of a helical pair parts both zeros by dz tan(beta) along the pitch.
    """
    table = as_table(scene)
    pinion, wheel = table["pinion"], table["wheel"]
    for own, hand in zip((pinion, wheel), scene.hands, strict=True):
        own["hand"] = hand
    table["pinion"], table["wheel"] = wheel, pinion
    pair, mounting = table["pair"], table["mounting"]
    pair["driving"] = OTHER[pair["driving"]]
    if pair.get("pinion_flank"):
        pair["pinion_flank"] = scene.contact_sides[1]  # type: ignore[attr-defined]
    else:
        pair["sense"] = OTHER[scene.sense]
    if "axial_offset_mm" in mounting:
        tilt = np.sin(np.radians(mounting["in_plane_deg"]))
        way = tilt * (scene.mesh().working_centre_distance + mounting["centre_distance_error_mm"])
        mounting["axial_offset_mm"] = -float(mounting["axial_offset_mm"] + way)
    else:
        axial = "pinion_axial_mm", "wheel_axial_mm"
        mounting[axial[0]], mounting[axial[1]] = mounting[axial[1]], mounting[axial[0]]
    torque = table["load"]["pinion_torque_Nm"] * abs(scene.wheel.teeth) / scene.pinion.teeth
    table["load"]["pinion_torque_Nm"] = torque
    return scene_from_table(table)
