"""Bearings of a REXS shaft as keys of a scene: by an operating point, by stated stiffness, or by inner geometry.

Rolling bearings that give way by their inner geometry become one bearing for each of their rows.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.exchange.model import (
    ANGLE,
    COUPLING,
    FORCE,
    LENGTH,
    SMALL_LENGTH,
    STIFFNESS,
    TILTING,
    Component,
    Reading,
)
from loaded_tca.plain import plain

RIGID_N_per_mm, RIGID_Nmm_per_rad = 1e9, 1e13
"""Stiffnesses of bearings that files call rigid: 1e20 N/m and more would leave no digits for the shaft."""
NO_STIFFNESS = 1e-9
BEARINGS = "concept_bearing", "rolling_bearing_with_catalog_geometry", "rolling_bearing_with_detailed_geometry"
ROLLING = "rolling_bearing_with_catalog_geometry", "rolling_bearing_with_detailed_geometry"
DIGITS = 9
"""Of stiffnesses that were turned."""


def bearing_rows(
    reading: Reading, bearing: Component, thrust: float, sign: float, turn: Array
) -> list[tuple[float, dict[str, Any]]] | None:
    """Rows of a bearing by their places beside it along u and their keys; None where nothing says how it gives way.

    The inner geometry counts where the file has no stiffness, or a rigid one, which stands for none.
    """
    matrix = _operating_point(reading, bearing, turn)
    if matrix is not None:
        return [(0.0, {"stiffness": [[round(value, DIGITS) + 0.0 for value in row] for row in matrix.tolist()]})]
    radial = bearing.number("radial_stiffness", STIFFNESS, 0.0) or 0.0
    if bearing.type in ROLLING and not NO_STIFFNESS < radial < RIGID_N_per_mm:
        rows = rolling_rows(reading, bearing, sign)
        if rows is not None:
            reading.take(bearing, "radial_stiffness", "axial_stiffness", "bending_stiffness")
            reading.note(f"{bearing}: its stiffness follows from its inner geometry")
            return rows
    stiffness = _linear(reading, bearing, thrust)
    return None if stiffness is None else [(0.0, stiffness)]


def _linear(reading: Reading, bearing: Component, thrust: float) -> dict[str, Any] | None:
    """Keys of the linear stiffness of a bearing; None where it has none."""
    radial = reading.number(bearing, "radial_stiffness", STIFFNESS, 0.0) or 0.0
    axial = reading.number(bearing, "axial_stiffness", STIFFNESS, 0.0) or 0.0
    tilting = reading.number(bearing, "bending_stiffness", TILTING, 0.0) or 0.0
    radial = (
        0.0 if reading.take(bearing, "radial_force_absorption").flag("radial_force_absorption") is False else radial
    )
    if max(radial, axial, tilting) <= NO_STIFFNESS:
        return None
    axial = _axial(reading, bearing, radial, axial, thrust)
    if max(radial, axial) > RIGID_N_per_mm or tilting > RIGID_Nmm_per_rad:
        reading.note(
            f"{bearing}: rigid directions have {plain(1e-3 * RIGID_N_per_mm, 6)} N/um, "
            f"{plain(1e-6 * RIGID_Nmm_per_rad, 6)} N m/mrad"
        )
    keys = {"radial_stiffness_N_per_um": 1e-3 * min(radial, RIGID_N_per_mm)}
    if axial > 0.0:
        keys["axial_stiffness_N_per_um"] = 1e-3 * min(axial, RIGID_N_per_mm)
    if tilting > 0.0:
        keys["tilting_stiffness_Nm_per_mrad"] = 1e-6 * min(tilting, RIGID_Nmm_per_rad)
    return keys


def _axial(reading: Reading, bearing: Component, radial: float, axial: float, thrust: float) -> float:
    """Axial stiffness: none where the bearing takes no thrust of this direction [N/mm]."""
    absorption = reading.take(bearing, "axial_force_absorption").text("axial_force_absorption")
    if absorption == "no_direction":
        return 0.0
    if absorption in ("positive", "negative") and thrust:
        if (thrust > 0.0) != (absorption == "positive"):
            reading.note(f"{bearing}: no axial force in the scene: the force on its shaft points the other way")
            return 0.0
        reading.note(f"{bearing}: axial forces of both directions in the scene, only {absorption} ones in the file")
    if not axial and absorption and bearing.type in ROLLING and radial > RIGID_N_per_mm:
        return math.inf  # rigid, of a file that gives no stiffness where a direction is held
    return axial


def _operating_point(reading: Reading, bearing: Component, turn: Array) -> Array | None:
    """Stiffness (5, 5) at the operating point in the gear's own frame [N, mm, rad]; None where it is not whole."""
    forces = [("f_u", "dF_u"), ("f_v", "dF_v"), ("f_w", "dF_w"), ("m_v", "dM_v"), ("m_w", "dM_w")]
    motions = [("d_u", "d_u"), ("d_v", "d_v"), ("d_w", "d_w"), ("rot_v", "d_v_rot"), ("rot_w", "d_w_rot")]
    matrix = np.zeros((6, 6))  # along u, v, w, about u, v, w
    rows = 0, 1, 2, 4, 5
    for n, (force, old_force) in enumerate(forces):
        for m, (motion, old_motion) in enumerate(motions):
            moment, tilt = n >= 3, m >= 3
            units = (TILTING if moment else COUPLING) if tilt else (COUPLING if moment else STIFFNESS)
            names = (
                f"operating_point_stiffness_{force}_{motion}",
                f"operating_point_stiffness_{old_force}_{old_motion}",
            )
            name = next((each for each in names if each in bearing.attributes), None)
            value = None if name is None else reading.number(bearing, name, units)
            if value is None:
                return None
            matrix[rows[n], rows[m]] = value
    if not matrix.any():
        return None
    turn_both = np.zeros((6, 6))
    turn_both[:3, :3] = turn_both[3:, 3:] = turn
    turned = turn_both @ (0.5 * (matrix + matrix.T)) @ turn_both.T
    reading.note(f"{bearing}: its stiffness is that of the operating point in the file")
    return np.asarray(turned[:5, :5])


KINDS = {
    "angular_contact_ball_bearing": "ball",
    "radial_grooved_ball_bearing": "ball",
    "radial_needle_roller_bearing": "roller",
    "radial_roller_bearing": "roller",
    "radial_tapered_roller_bearing": "roller",
}
"""Types of bearings in REXS -> those of scenes."""
CLEARANCES = (
    "operating_radial_bearing_clearance",
    "mounted_radial_bearing_clearance",
    "radial_bearing_clearance",
    "radial_backlash",
)
"""Names of the radial clearance, the one under running conditions first; the last one is that of version 1.0."""
RATINGS = "radial_dynamic_load_rating", "dynamic_capacity"
GROOVES = {
    "inner_groove_ratio": ("raceway_radius_of_inner_ring", "running_path_radius_of_inner_ring"),
    "outer_groove_ratio": ("raceway_radius_of_outer_ring", "running_path_radius_of_outer_ring"),
}
LENGTHS = (
    "significant_contact_length_inner_ring",
    "significant_contact_length_outer_ring",
    "significant_width_inner",
    "significant_width_outer",
)
CONFORMITY = 0.5, 0.6
"""Radii of grooves over the diameter of the balls that scenes have."""
MOST_ROWS = 2


def rolling_rows(reading: Reading, bearing: Component, sign: float) -> list[tuple[float, dict[str, Any]]] | None:
    """Return the rows of a rolling bearing, each with its place and its keys.

    Parameters
    ----------
    reading : Reading
    bearing : Component
    sign : float
        +1 where u of the shaft points along z of the gear's own frame, else -1.

    Returns
    -------
    list of (float, dict) or None
        Place beside the bearing's own along u [mm]; None where the model has not all of its geometry.
    """
    kind = KINDS.get(reading.take(bearing, "bearing_type").text("bearing_type"))
    rows = reading.model.related("ordered_assembly", "assembly", bearing.id, "part")
    if kind is None or not 1 <= len(rows) <= MOST_ROWS:
        return None
    keys = [_row_keys(reading, bearing, row, kind, sign) for row in rows]
    distance = reading.number(bearing, "distance_between_bearing_rows", LENGTH, 0.0) or 0.0
    if len(rows) > 1 and not distance:
        return None
    places = [distance * (n - 0.5 * (len(rows) - 1)) for n in range(len(rows))]
    placed = [(place, row) for place, row in zip(places, keys, strict=True) if row is not None]
    return placed if len(placed) == len(rows) else None


def _row_keys(reading: Reading, bearing: Component, row: Component, kind: str, sign: float) -> dict[str, Any] | None:
    elements = reading.model.related("ordered_assembly", "assembly", row.id, "part")
    count = reading.number(row, "number_of_rolling_elements") or len(elements) or None
    diameter = _of_elements(reading, elements, "diameter_of_rolling_element")
    pitch = reading.number(row, "reference_diameter", LENGTH)
    length = _roller_length(reading, row, elements)
    if not count or not diameter or not pitch or (kind == "roller" and not length):
        return None
    keys: dict[str, Any] = {
        "type": kind,
        f"{kind}s": round(count),
        f"{kind}_diameter_mm": diameter,
        "pitch_diameter_mm": pitch,
    }
    if kind == "roller":
        keys["roller_length_mm"] = length
    else:
        keys |= _grooves(reading, row, diameter)
    angle = abs(reading.number(row, "pressure_angle", ANGLE, 0.0) or 0.0)
    if angle:
        thrust = _thrust(reading, bearing, row)
        if thrust is None:
            return None
        keys |= {"contact_angle_deg": angle, "side": round(thrust * sign)}
    clearance = _first(reading, bearing, CLEARANCES, SMALL_LENGTH)
    if clearance:
        keys["radial_clearance_um"] = clearance
    rating = _first(reading, bearing, RATINGS, FORCE)
    if rating and len(reading.model.related("ordered_assembly", "assembly", bearing.id, "part")) == 1:
        keys["dynamic_load_rating_N"] = rating
    return keys


def _first(reading: Reading, component: Component, names: tuple[str, ...], units: dict[str, float]) -> float | None:
    """The first of several numbers that the component has; all are taken."""
    values = [reading.number(component, name, units) for name in names]
    return next((one for one in values if one is not None), None)


def _of_elements(reading: Reading, elements: list[Component], name: str) -> float | None:
    """Length of the rolling elements of a row, which are alike."""
    values = [reading.number(one, name, LENGTH) for one in elements]
    return values[0] if values else None


def _roller_length(reading: Reading, row: Component, elements: list[Component]) -> float | None:
    """The shortest length over which rollers touch, else that of the rollers."""
    touching = [value for name in LENGTHS if (value := reading.number(row, name, LENGTH))]
    whole = _of_elements(reading, elements, "length_of_rolling_element")
    return min(touching) if touching else whole


def _grooves(reading: Reading, row: Component, diameter: float) -> dict[str, float]:
    """Radii of the grooves over the diameter of the balls, where scenes may have them."""
    ratios = {}
    for key, names in GROOVES.items():
        radius = _first(reading, row, names, LENGTH)
        if radius and CONFORMITY[0] < radius / diameter < CONFORMITY[1]:
            ratios[key] = round(radius / diameter, 9)
    return ratios


def _thrust(reading: Reading, bearing: Component, row: Component) -> int | None:
    """Direction along u of the thrust that a row takes; None where the model does not say one."""
    for component, name in ((row, "axial_force_absorption_of_row"), (bearing, "axial_force_absorption")):
        direction = reading.take(component, name).text(name)
        if direction in ("positive", "negative"):
            return 1 if direction == "positive" else -1
    return None
