"""Other names for keys of [pair]: the transverse section of helical teeth, diametral pitches.

Profile shift and rack coefficients stay those of the normal section, in normal modules, whichever section is given.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import atan, cos, degrees, radians, tan
from typing import Any

from loaded_tca.scene.keys import shown
from loaded_tca.scene.written import PITCH, Convert, Equivalent, reciprocal

STEEPEST_deg = 89.0
"""Helix angle above which a transverse value is taken as a normal one: that angle is refused by its own key."""


def _helix_cosine(table: Mapping[str, Any]) -> float:
    """Cosine of the helix angle of a table; 1 where it has none, or one that is refused."""
    angle = table.get("helix_angle_deg")
    if isinstance(angle, int | float) and not isinstance(angle, bool) and 0.0 < angle <= STEEPEST_deg:
        return cos(radians(angle))
    return 1.0


def _module(table: Mapping[str, Any]) -> tuple[Convert, Convert]:
    cosine = _helix_cosine(table)
    return lambda transverse: transverse * cosine, lambda normal: normal / cosine


def _pitch(table: Mapping[str, Any]) -> tuple[Convert, Convert]:
    cosine, (convert, _) = _helix_cosine(table), reciprocal()
    return lambda transverse: convert(transverse) * cosine, lambda normal: convert(normal / cosine)


def _pressure_angle(table: Mapping[str, Any]) -> tuple[Convert, Convert]:
    cosine = _helix_cosine(table)
    return (
        lambda transverse: degrees(atan(tan(radians(transverse)) * cosine)),
        lambda normal: degrees(atan(tan(radians(normal)) / cosine)),
    )


def _which_pitch(table: Mapping[str, Any]) -> str | None:
    if _helix_cosine(table) == 1.0:
        return None
    return (
        f"normal or transverse? With helix_angle_deg = {shown(table['helix_angle_deg'])} they differ: write "
        f"normal_{PITCH} or transverse_{PITCH}"
    )


OF_HELICAL = {
    "transverse_module_mm": Equivalent(
        "normal_module_mm", "transverse module m_t = m_n/cos(beta)", _module, inches=False
    ),
    "transverse_pressure_angle_deg": Equivalent(
        "pressure_angle_deg",
        "transverse pressure angle alpha_t, tan(alpha_t) = tan(alpha_n)/cos(beta)",
        _pressure_angle,
    ),
    PITCH: Equivalent(
        "normal_module_mm", "diametral pitch P of straight teeth, 25.4/m", reciprocal, _which_pitch, inches=True
    ),
    f"normal_{PITCH}": Equivalent("normal_module_mm", "normal diametral pitch P_n, 25.4/m_n", reciprocal, inches=True),
    f"transverse_{PITCH}": Equivalent(
        "normal_module_mm", "transverse diametral pitch P_t = P_n cos(beta)", _pitch, inches=True
    ),
}
"""Of cylindrical gears."""
OF_BEVEL = {
    PITCH: Equivalent("outer_module_mm", "outer transverse diametral pitch, 25.4/m_et", reciprocal, inches=True)
}
"""Of bevel gears."""
