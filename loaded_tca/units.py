"""Units at the ends of names, of keys of scenes, columns of tables and figures: the one place that says what they are.

Results and numerics are in mm, N, MPa and rad; a name that ends with a unit, as ``face_width_mm``, tells another one.
"""

from __future__ import annotations

import math
import re
from typing import NamedTuple


class Unit(NamedTuple):
    """A unit as names end with it.

    Attributes
    ----------
    text : str
        As it is printed.
    base : str
        Unit of results that it stands for.
    factor : float
        One of it in that.
    """

    text: str
    base: str
    factor: float


UNITS = {
    "mm2_N": Unit("mm²/N", "mm²/N", 1.0),
    "N_per_mm_um": Unit("N/(mm um)", "N/(mm um)", 1.0),
    "mm_per_rad": Unit("mm/rad", "mm/rad", 1.0),
    "N_per_um": Unit("N/um", "N/mm", 1e3),
    "Nm_per_mrad": Unit("N m/mrad", "N mm/rad", 1e6),
    "N_per_mm": Unit("N/mm", "N/mm", 1.0),
    "arcsec": Unit("arcsec", "rad", math.radians(1.0 / 3600.0)),
    "um": Unit("um", "mm", 1e-3),
    "mm": Unit("mm", "mm", 1.0),
    "deg": Unit("deg", "rad", math.pi / 180.0),
    "rad": Unit("rad", "rad", 1.0),
    "Nm": Unit("N m", "N mm", 1e3),
    "MPa": Unit("MPa", "MPa", 1.0),
    "N": Unit("N", "N", 1.0),
    "Mrev": Unit("million revolutions", "million revolutions", 1.0),
    "rpm": Unit("1/min", "1/min", 1.0),
    "C": Unit("°C", "°C", 1.0),
    "mm2_s": Unit("mm²/s", "mm²/s", 1.0),
    "kg_m3": Unit("kg/m³", "kg/m³", 1.0),
    "W_mK": Unit("W/(m K)", "W/(m K)", 1.0),
    "J_kgK": Unit("J/(kg K)", "J/(kg K)", 1.0),
}
"""Ending of a name -> unit; of several that fit, the first."""
MICROMETRES = 1.0 / UNITS["um"].factor
"""Per millimetre."""


def ending_of(name: str) -> str:
    """Unit at the end of a name, as it is written there; nothing where it has none."""
    return next((ending for ending in UNITS if name.endswith(f"_{ending}")), "")


def without_unit(name: str) -> str:
    """A name less the unit at its end."""
    return name.removesuffix(f"_{ending}") if (ending := ending_of(name)) else name


def unit_of(name: str) -> str:
    """Unit at the end of a name as it is printed; nothing where it has none.

    Examples
    --------
    >>> unit_of("mesh_stiffness_mean_N_per_mm_um"), unit_of("face_load_factor")
    ('N/(mm um)', '')
    """
    return UNITS[ending].text if (ending := ending_of(name)) else ""


def as_ending(unit: str) -> str:
    """How a unit is written at the end of a name; nothing for pure numbers.

    Examples
    --------
    >>> as_ending("N/(mm um)"), as_ending("MPa m/s"), as_ending("°C"), as_ending("1")
    ('N_per_mm_um', 'MPa_m_per_s', 'C', '')
    """
    return "" if unit == "1" else re.sub("[°()]", "", unit.replace("/", "_per_").replace(" ", "_"))


def factor_of(name: str) -> float:
    """Factor from the unit of results to that at the end of a name.

    Examples
    --------
    >>> factor_of("contact_deformation_um"), factor_of("pinion_torque_Nm"), factor_of("load_share")
    (1000.0, 0.001, 1.0)
    """
    return 1.0 / UNITS[ending].factor if (ending := ending_of(name)) else 1.0
