"""Face-milled gears as tables of scene files: blanks, machine settings and cutters of a hypoid pair."""

from __future__ import annotations

from dataclasses import replace
from math import degrees
from typing import Any

from loaded_tca.arrays import GEARS
from loaded_tca.gears.face_milled import FaceMilledGear
from loaded_tca.gears.hypoid import HypoidCones
from loaded_tca.scene.face_milled import Blade, Blank, Machine
from loaded_tca.scene.section import Section, entries
from loaded_tca.units import factor_of, without_unit

DEFAULTS: tuple[Any, ...] = (None, 0.0)
"""Values of keys that a table can leave out."""


def hypoid_table(gears: tuple[FaceMilledGear, FaceMilledGear], cones: HypoidCones) -> dict[str, Any]:
    """Return the sections [pair], [pinion] and [wheel] of a scene of two gears, as :func:`scene_from_table` takes them.

    Parameters
    ----------
    gears : (FaceMilledGear, FaceMilledGear)
        As :func:`loaded_tca.flanks.synthesised_gears` makes them, apexes counted from those of the pitch cones.
    cones : HypoidCones
        On which they stand.

    Examples
    --------
    >>> from math import radians
    >>> from loaded_tca.flanks import synthesised_gears
    >>> from loaded_tca.gears import HypoidBlank, pitch_cones_by_method_1
    >>> pitch_cones = pitch_cones_by_method_1((13, 42), 15.0, 170.0, 30.0, radians(50), 63.5)
    >>> blank = HypoidBlank((13, 42), pitch_cones, 30.0, 63.5, profile_shift=0.3)
    >>> table = hypoid_table(synthesised_gears(blank), blank.cones)
    >>> round(table["pair"]["offset_mm"], 9), round(table["wheel"]["blank"]["face_apex_mm"], 4)
    (15.0, 1.8052)
    """
    pair = {"type": "face_milled", "shaft_angle_deg": degrees(cones.shaft_angle), "offset_mm": cones.offset}
    sections = (_gear_table(gear, beyond) for gear, beyond in zip(gears, cones.apexes, strict=True))
    return {"pair": pair} | dict(zip(GEARS, sections, strict=True))


def _gear_table(gear: FaceMilledGear, beyond: float) -> dict[str, Any]:
    """A gear as a section of a scene, apexes and machine centre to back counted from the crossing point."""
    blank = replace(gear.blank, face_apex=gear.blank.face_apex + beyond, root_apex=gear.blank.root_apex + beyond)
    back = gear.machine.machine_centre_to_back + beyond
    cutter: dict[str, Any] = {"number": gear.cutter.number}
    for flank in ("concave", "convex"):
        if (blade := getattr(gear.cutter, flank)) is not None:
            cutter[flank] = _keys(blade, Blade)
    return {
        "teeth": gear.teeth,
        "blank": _keys(blank, Blank),
        "machine": _keys(replace(gear.machine, machine_centre_to_back=back), Machine),
        "cutter": cutter,
    }


def _keys(values: Any, section: type[Section]) -> dict[str, Any]:
    """Values of a dataclass by the keys of a section, in its units."""
    table = {}
    for key, (_, entry) in entries(section).items():
        value = getattr(values, without_unit(key))
        if value not in DEFAULTS or getattr(entry, "required", False):
            table[key] = value if isinstance(value, str) else value * factor_of(key)
    return table
