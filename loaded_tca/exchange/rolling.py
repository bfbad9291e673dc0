"""Rolling bearings of a REXS model by their inner geometry, as keys of a scene: one bearing for each of their rows."""

from __future__ import annotations

from typing import Any

from loaded_tca.exchange.model import Component, Reading
from loaded_tca.exchange.units import ANGLE, FORCE, LENGTH, SMALL_LENGTH

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
