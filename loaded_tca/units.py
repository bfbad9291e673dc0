"""Units at the ends of names, of keys of scenes, columns of tables and figures: the one place that says what they are.

Results and numerics are in mm, N, MPa and rad; a name that ends with a unit, as ``face_width_mm``, tells another one.
Units that other packages write beside their numbers are converted to them.
"""

from __future__ import annotations

import functools
import math
import re
from collections import Counter
from fractions import Fraction
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
    "kg_per_mm": Unit("kg/mm", "kg/mm", 1.0),
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
    "MPa_m_per_s": Unit("MPa m/s", "MPa m/s", 1.0),
    "W": Unit("W", "W", 1.0),
    "K": Unit("K", "K", 1.0),
    "h": Unit("h", "h", 1.0),
}
"""Ending of a name -> unit; of several that fit, the first."""
MICROMETRES = 1.0 / UNITS["um"].factor
"""Per millimetre."""
INCHES = {
    "lbf_in_per_rad": ("lbf in/rad", ("Nm_per_mrad",)),
    "in_per_rad": ("in/rad", ("mm_per_rad",)),
    "lbf_per_in": ("lbf/in", ("N_per_um",)),
    "lbf_in": ("lbf in", ("Nm",)),
    "lbf_ft": ("lbf ft", ("Nm",)),
    "in": ("in", ("mm", "um")),
    "uin": ("uin", ("um",)),
    "lbf": ("lbf", ("N",)),
    "psi": ("psi", ("MPa",)),
    "ksi": ("ksi", ("MPa",)),
}
"""Endings of keys on drawings in inches -> unit, and the metric endings that it stands for; the usual ones first."""


@functools.lru_cache(maxsize=4096)
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


METRE, KILOGRAM, SECOND, RADIAN, KELVIN, CELSIUS = "m", "kg", "s", "rad", "K", "degree Celsius"
PREFIXES = (
    ("", "", "1"),
    ("n", "nano", "1e-9"),
    ("u", "micro", "1e-6"),
    ("m", "milli", "1e-3"),
    ("c", "centi", "1e-2"),
    ("d", "deci", "1e-1"),
    ("h", "hecto", "1e2"),
    ("k", "kilo", "1e3"),
    ("M", "mega", "1e6"),
    ("G", "giga", "1e9"),
)
"""Before symbols and before names of units, and the factor."""
PREFIXED: tuple[tuple[str, tuple[str, ...], str, dict[str, int]], ...] = (
    ("m", ("metre", "meter"), "1", {METRE: 1}),
    ("g", ("gram",), "1e-3", {KILOGRAM: 1}),
    ("s", ("second",), "1", {SECOND: 1}),
    ("N", ("newton",), "1", {KILOGRAM: 1, METRE: 1, SECOND: -2}),
    ("Nm", (), "1", {KILOGRAM: 1, METRE: 2, SECOND: -2}),
    ("Pa", ("pascal",), "1", {KILOGRAM: 1, METRE: -1, SECOND: -2}),
    ("J", ("joule",), "1", {KILOGRAM: 1, METRE: 2, SECOND: -2}),
    ("W", ("watt",), "1", {KILOGRAM: 1, METRE: 2, SECOND: -3}),
    ("rad", ("radian",), "1", {RADIAN: 1}),
    ("K", ("kelvin",), "1", {KELVIN: 1}),
)
"""Units that take prefixes: symbol, names, size in base units, and what each is made of."""
POUND = Fraction("0.45359237") * Fraction("9.80665")
"""Force of a pound [N]: the international pound under standard gravity."""
OTHERS: tuple[tuple[tuple[str, ...], Fraction, dict[str, int]], ...] = (
    (("in", "inch", "inches"), Fraction("0.0254"), {METRE: 1}),
    (("uin", "microinch", "microinches"), Fraction("0.0254e-6"), {METRE: 1}),
    (("ft", "foot", "feet"), Fraction("0.3048"), {METRE: 1}),
    (("lbf",), POUND, {KILOGRAM: 1, METRE: 1, SECOND: -2}),
    (("psi",), POUND / Fraction("0.0254") ** 2, {KILOGRAM: 1, METRE: -1, SECOND: -2}),
    (("ksi",), 1000 * POUND / Fraction("0.0254") ** 2, {KILOGRAM: 1, METRE: -1, SECOND: -2}),
    (("micron", "microns"), Fraction("1e-6"), {METRE: 1}),
    (("Nmm",), Fraction("1e-3"), {KILOGRAM: 1, METRE: 2, SECOND: -2}),
    (("bar",), Fraction("1e5"), {KILOGRAM: 1, METRE: -1, SECOND: -2}),
    (("min", "minute", "minutes"), Fraction(60), {SECOND: 1}),
    (("h", "hr", "hour", "hours"), Fraction(3600), {SECOND: 1}),
    (("rpm", "revolutions_per_minute"), Fraction(1, 60), {SECOND: -1}),
    (("deg", "degree", "degrees", "\N{DEGREE SIGN}"), Fraction(math.pi / 180.0), {RADIAN: 1}),
    (("arcmin", "arcminute", "arcminutes"), Fraction(math.pi / 10800.0), {RADIAN: 1}),
    (("arcsec", "arcsecond", "arcseconds"), Fraction(math.pi / 648000.0), {RADIAN: 1}),
    (("percent", "%"), Fraction("1e-2"), {}),
    (("dimensionless",), Fraction(1), {}),
    (("C", "degC", "deg_C", "\N{DEGREE SIGN}C", "celsius", "degree_Celsius"), Fraction(1), {CELSIUS: 1}),
)
"""Units without prefixes: names, size in base units, and what each is made of. Degrees Celsius are no kelvins."""
MOST_POWER, LONGEST = 9, 60
"""Largest exponent that is read, and the most characters."""
FACTOR = re.compile(
    r"\s*(?:(?P<sign>[/*()])|(?P<number>\d{1,9}(?:\.\d{0,9})?(?:[eE][+-]?\d{1,2})?(?![\d.]))|"
    r"(?P<unit>[^\W\d]+|%|\N{DEGREE SIGN}[^\W\d]*)(?:\s*\^\s*(?P<power>[+-]?\d+)|(?P<behind>[+-]?\d+))?)\s*",
    re.ASCII,
)
"""Of a unit in words: a sign, a number, or the symbol or name of a unit and its exponent."""
PLAIN = str.maketrans(
    {"\N{MICRO SIGN}": "u", "\N{GREEK SMALL LETTER MU}": "u", "\N{MIDDLE DOT}": "*", "\N{DOT OPERATOR}": "*"}
    | {"\N{SUPERSCRIPT TWO}": "2", "\N{SUPERSCRIPT THREE}": "3"}
)


def conversion(written: str, wanted: str) -> float | None:
    """Factor from a unit, as a person or a package writes it, to another; None if there is none.

    Parameters
    ----------
    written, wanted : str
        Products and ratios of units; nothing for pure numbers.

    Examples
    --------
    >>> conversion("\N{MICRO SIGN}m", "mm"), conversion("newton / millimeter ** 2", "MPa"), conversion("mm", "N")
    (0.001, 1.0, None)
    """
    ratio = exact_conversion(written, wanted)
    return None if ratio is None else float(ratio)


def exact_conversion(written: str, wanted: str) -> Fraction | None:
    """Factor as :func:`conversion` has it, as a ratio of whole numbers.

    Examples
    --------
    >>> exact_conversion("in", "um"), exact_conversion("lbf/in", "N/um")
    (Fraction(25400, 1), Fraction(8896443230521, 50800000000000000))
    """
    size, of_wanted = (_size(unit[:LONGEST].translate(PLAIN).replace("**", "^").strip()) for unit in (written, wanted))
    if size is None or of_wanted is None or size[1] != of_wanted[1]:
        return None
    return size[0] / of_wanted[0]


@functools.cache
def _size(unit: str) -> tuple[Fraction, tuple[tuple[str, int], ...]] | None:
    """Size of a unit in base units, and its dimensions; None if it cannot be read."""
    size, dimensions = Fraction(1), Counter[str]()
    groups, sign, place = [1], 1, 0
    while place < len(unit):
        match = FACTOR.match(unit, place)
        if match is None or not groups:
            return None
        place = match.end()
        if match["sign"]:
            groups += [sign * groups[-1]] if match["sign"] == "(" else []
            del groups[len(groups) - (match["sign"] == ")") :]
            sign = -1 if match["sign"] == "/" else 1
            continue
        number = match["number"]
        factor, parts = (Fraction(number), {}) if number else _simple_units().get(match["unit"], (Fraction(0), {}))
        power = sign * groups[-1] * int(match["power"] or match["behind"] or 1)
        if not factor or abs(power) > MOST_POWER:
            return None
        size, sign = size * factor**power, 1
        dimensions.update({name: exponent * power for name, exponent in parts.items()})
    return (
        (size, tuple(sorted((name, power) for name, power in dimensions.items() if power))) if groups == [1] else None
    )


@functools.cache
def _simple_units() -> dict[str, tuple[Fraction, dict[str, int]]]:
    """Size in base units of every symbol and name, with its prefix, and what the unit is made of."""
    units = {}
    for symbol, names, size, parts in PREFIXED:
        for prefix, word, factor in PREFIXES:
            written = (f"{prefix}{symbol}", *(f"{word}{name}{plural}" for name in names for plural in ("", "s")))
            units.update(dict.fromkeys(written, (Fraction(size) * Fraction(factor), parts)))
    return units | {name: (size, parts) for names, size, parts in OTHERS for name in names}
