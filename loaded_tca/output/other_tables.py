"""Tables of shafts under load and of ease-off."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from loaded_tca.output.result_files import csv_table
from loaded_tca.plain import lasting, plain
from loaded_tca.results.tables import FORCES
from loaded_tca.supports import RollingBearing
from loaded_tca.units import MICROMETRES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from loaded_tca.flank_maps.ease_off_map import EaseOffMap
    from loaded_tca.loaded.shaft_lines import ShaftLine

MOTIONS = "x_um", "y_um", "z_um", "about_x_rad", "about_y_rad", "about_z_rad"
INSIDE = "element_force_N", "element_pressure_MPa", "life_Mrev"
"""Columns of rolling bearings."""


def shaft_csv(lines: Sequence[ShaftLine]) -> str:
    """Return one row per gear, torque and place along its shaft, units in the header."""
    rows = [(line, n) for line in lines for n in range(len(line.places))]
    columns: dict[str, list[Any]] = {
        "gear": [line.gear for line, _ in rows],
        "pinion_torque_Nm": [1e-3 * line.torque for line, _ in rows],
        "axial_mm": [float(line.places[n]) for line, n in rows],
    }
    for k, name in enumerate(MOTIONS):
        columns[name] = [float(line.motions[n, k]) * (1e3 if k < 3 else 1.0) for line, n in rows]
    return csv_table(columns)


def bearings_csv(lines: Sequence[ShaftLine]) -> str:
    """Return one row per gear, torque and bearing: forces and moments on it, axes of the gear's own frame.

    Where a bearing is a rolling one, its largest element force, contact pressure and life stand beside; empty cells of
    linear ones, and of a life without load.
    """
    rows = [(line, n) for line in lines for n in range(len(line.bearing_forces))]
    columns: dict[str, list[Any]] = {
        "gear": [line.gear for line, _ in rows],
        "pinion_torque_Nm": [1e-3 * line.torque for line, _ in rows],
        "bearing": [n for _, n in rows],
        "axial_mm": [line.shaft.bearings[n].at for line, n in rows],
    }
    for k, name in enumerate(FORCES):
        columns[name] = [float(line.bearing_forces[n, k]) * (1.0 if k < 3 else 1e-3) for line, n in rows]
    inside = [rolling_figures(line, n) for line, n in rows]
    if any(inside):
        for name in INSIDE:
            columns[name] = [one.get(name, math.nan) for one in inside]
    return csv_table(columns)


def rolling_figures(line: ShaftLine, place: int) -> dict[str, float]:
    """Largest element force, contact pressure and life of the bearing at a place in the list; nothing of a linear one.

    Parameters
    ----------
    line : ShaftLine
    place : int
    """
    bearing, motion = line.shaft.bearings[place], line.bearing_motions[place]
    if not isinstance(bearing, RollingBearing):
        return {}
    values = float(bearing.element_forces(motion).max()), bearing.largest_pressure(motion), bearing.life(motion)
    return dict(zip(INSIDE, values, strict=True))


AXES_OF_SHAFTS = (
    "forces on the bearings and motions of the shafts, in the axes of each gear's own frame, which does not turn:",
    "z is the axis of the gear, x points to the pitch point; turns are right-handed about these axes",
)


def bearings_text(lines: Sequence[ShaftLine]) -> str:
    """Return forces on the bearings and the motion of the middles of the faces as text.

    Examples
    --------
    >>> from loaded_tca import read_scene
    >>> from loaded_tca.loaded.shaft_lines import shaft_lines
    >>> lines = shaft_lines(read_scene("examples/scenes/helical_on_shafts.toml"))
    >>> bearings_text(lines[:1]).splitlines()[0]
    'pinion under 40 N m'
    """
    text = []
    for line in lines:
        text.append(f"{line.gear} under {plain(1e-3 * line.torque, 6)} N m")
        for n, force in enumerate(line.bearing_forces):
            parts = " | ".join(f"{one:z.1f}" for one in force[:3])
            text.append(f"  bearing {n} at {plain(line.shaft.bearings[n].at, 6)} mm: force x | y | z {parts} N")
            if inside := rolling_figures(line, n):
                largest, pressure, life = inside.values()
                words = "no load" if math.isinf(life) else f"life {lasting(life)} million revolutions"
                text.append(f"    largest element force {largest:z.1f} N, pressure {pressure:z.0f} MPa, {words}")
        at = abs(line.places - line.middle).argmin()
        x, y, z, about_x, about_y, about_z = line.motions[at].tolist()
        text.append(f"  middle of the face: x | y | z {1e3 * x:z.2f} | {1e3 * y:z.2f} | {1e3 * z:z.2f} um")
        turns = " | ".join(f"{1e6 * one:z.1f}" for one in (about_x, about_y, about_z))
        text.append(f"    about x | y | z {turns} urad")
    return "\n".join([*text, *AXES_OF_SHAFTS])


def ease_off_csv(ease_off: EaseOffMap) -> str:
    """Return the ease-off of a flank as CSV, a row for each point of its grid, lengthwise first."""
    columns = {f"{name}_mm": getattr(ease_off, name) for name in ("radius", "axial", "lengthwise", "profile")}
    columns["ease_off_um"] = MICROMETRES * ease_off.ease_off
    columns["mating_gear_reaches"] = ease_off.covered.astype(int)
    return csv_table({name: values.ravel().tolist() for name, values in columns.items()})
