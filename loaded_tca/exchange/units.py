"""Units of REXS files, and what one of each is in the units of scenes."""

from __future__ import annotations

import math
import re

LENGTH = {"mm": 1.0, "m": 1e3, "cm": 10.0, "mum": 1e-3}
ANGLE = {"deg": 1.0, "°": 1.0, "rad": math.degrees(1.0)}
FORCE = {"N": 1.0, "kN": 1e3, "MN": 1e6}
TORQUE = {"Nm": 1.0, "Nmm": 1e-3, "kNm": 1e3}
TILTING = {"Nmm/rad": 1.0, "Nm/rad": 1e3, "kNm/rad": 1e6}
STIFFNESS = {"N/mm": 1.0, "N/m": 1e-3, "N/mum": 1e3, "kN/mm": 1e3}
COUPLING = {"N/rad": 1.0, "N": 1.0, "kN/rad": 1e3, "Nmm/mm": 1.0, "Nm/m": 1.0}
PRESSURE = {"N/mm^2": 1.0, "MPa": 1.0, "GPa": 1e3, "Pa": 1e-6}
SMALL_LENGTH = {"mum": 1.0, "mm": 1e3, "m": 1e6}
SPEED = {"1/min": 1.0, "rpm": 1.0, "1/s": 60.0, "rad/s": 30.0 / math.pi}
POWER = {"kW": 1.0, "W": 1e-3, "MW": 1e3}
DENSITY = {"kg/dm^3": 1e3, "g/cm^3": 1e3, "kg/m^3": 1.0}
CONDUCTIVITY = {"W/(mK)": 1.0}
HEAT = {"J/(kgK)": 1.0}
NUMBER = {"none": 1.0, "": 1.0, "-": 1.0}
"""Names of units without blanks -> one of each in mm, deg, N, N m, N mm/rad, N/mm, N/rad, MPa, um, 1/min, kW, kg/m^3,
W/(m K), J/(kg K)."""

_AS_WRITTEN = {"µ": "mu", "μ": "mu", "um": "mum", "²": "^2", "³": "^3", "·": "", "*": "", "degree": "deg"}


def plain(unit: str) -> str:
    """Name of a unit without blanks and signs that files write in several ways.

    Examples
    --------
    >>> plain("N mm / rad"), plain("µm"), plain("N/mm²")
    ('Nmm/rad', 'mum', 'N/mm^2')
    """
    name = re.sub(r"\s", "", unit)
    if name in _AS_WRITTEN:
        return _AS_WRITTEN[name]
    for sign in ("µ", "μ", "²", "³", "·", "*"):
        name = name.replace(sign, _AS_WRITTEN[sign])
    return name
