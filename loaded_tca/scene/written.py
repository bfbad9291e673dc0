"""Keys as drawings write them: in inches, with a diametral pitch, or in the transverse section.

A section has each quantity under one key, in a metric unit. Tables may have it under other names: the same one that
ends with a unit of inches, or an equivalent that the section declares. Values are converted here, before they are
read; what is refused is told in the unit, and by the name, that the table has.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cache
from numbers import Real
from typing import Any

from loaded_tca.plain import plain
from loaded_tca.scene.keys import Either, Grid, Key, Kind, List, Number, ZeroOr, shown
from loaded_tca.units import INCHES, UNITS, ending_of, exact_conversion

Convert = Callable[[float], float]
METRIC = tuple(dict.fromkeys(ending for _, endings in INCHES.values() for ending in endings))
"""Endings of keys that drawings in inches write otherwise."""
PITCH, MODULE = "diametral_pitch_per_inch", "module_mm"
INCH_mm = Fraction("25.4")
FINEST = 1e6
"""Largest diametral pitch [1/in]."""
NUMBER = r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?"
OF_THE_KEY = re.compile(
    rf"(?:(?<=found )|(?<=allowed )|(?<=up to )|(?<=below )|(?<=from )|(?<=width, ))(?>{NUMBER})"
    r"(?!/| (?:\w+_[a-z]|mm\b|um\b|deg\b|modules\b|values\b|lists\b|points\b))"
)
"""Numbers of a refusal that are values of its key: no factor of another one, no count, and not in a unit of its own."""


@dataclass(frozen=True)
class Writing:
    """How a table writes a key of a section, and how values go from one to the other.

    Attributes
    ----------
    key : str
        Name in the section.
    name : str
        Name in the table.
    to_key, from_key : callable
        Values of the table to those of the section, and back; monotonic.
    factor : float or None
        By which values are multiplied, of units of one quantity; None where the one is a function of the other.
    given : bool
        Whether the table has the key; else it is how the table would write it.
    value : float or None
        The number that the table has.
    """

    key: str
    name: str
    to_key: Convert
    from_key: Convert
    factor: float | None = None
    given: bool = True
    value: float | None = None

    def text(self, number: str) -> str:
        """A number of a refusal as the table writes it: its own value digit by digit, another one with six digits."""
        own = self.value is not None and number == plain(self.to_key(self.value), 6)
        return plain(self.value if own and self.value is not None else self.from_key(float(number)), 6)

    def path(self, of_key: str) -> str:
        """Path of the name, where that of the key is known."""
        return of_key.removesuffix(self.key) + self.name

    def read(self, entry: Key, value: Any) -> Any:
        """Return the value of a scene, as the key does; ValueError: the rest of a message, in the unit of the table."""
        read = replace(entry, kind=self.kind(entry.kind)).read(value)
        return read if value is None else self.converted(read)

    def converted(self, value: Any) -> Any:
        """Value of the section; numbers in lists one by one, what is no number as it is."""
        if isinstance(value, list | tuple):
            return tuple(self.converted(each) for each in value)
        number = _number(value)
        return value if number is None else self.to_key(number)

    def kind(self, kind: Kind) -> Kind:
        """Kind of the value in the unit of the table."""
        if isinstance(kind, Number):
            low, high = self._limit(kind.low, kind), self._limit(kind.high, kind)
            if low > high:  # the limits of a reciprocal change places, and none of them is left out
                return replace(kind, low=high, high=low, above=False)
            return replace(kind, low=low, high=high)
        if isinstance(kind, ZeroOr | Grid):
            number = self.kind(kind.number)
            return replace(kind, number=number) if isinstance(number, Number) else kind
        if isinstance(kind, List):
            return replace(kind, kind=self.kind(kind.kind))
        return Either(tuple(map(self.kind, kind.kinds))) if isinstance(kind, Either) else kind

    def _limit(self, value: float, kind: Number) -> float:
        """Limit in the unit of the table, moved by digits that rounding takes, so that it is allowed by the key."""
        limit = self.from_key(value)
        inside = self.from_key(0.5 * (kind.low + kind.high))
        while not kind.low <= self.to_key(limit) <= kind.high:
            limit = math.nextafter(limit, inside)
        return limit


@dataclass(frozen=True)
class Equivalent:
    """Another name for a key of a section, whose value follows from it and from the rest of the table.

    Attributes
    ----------
    key : str
    about : str
        Its meaning, for the reference of the keys.
    writing : callable
        Factors, from the table: conversions to the key and back.
    question : callable, optional
        What is to be asked of a table where the name may mean several things; None where it does not.
    inches : bool or None
        Whether it belongs to drawings in inches; None: to either.
    """

    key: str
    about: str
    conversions: Callable[[Mapping[str, Any]], tuple[Convert, Convert]]
    question: Callable[[Mapping[str, Any]], str | None] = lambda _table: None
    inches: bool | None = None


Equivalents = Mapping[str, Equivalent]


def reciprocal(_table: Mapping[str, Any] = {}) -> tuple[Convert, Convert]:
    """Return the conversions of a diametral pitch [1/in] and a module [mm], which are one rule both ways."""

    def convert(value: float) -> float:
        return float(INCH_mm / Fraction(repr(value))) if value >= float(INCH_mm) / FINEST else FINEST

    return convert, convert


@cache
def _proportional(ending: str, metric: str) -> tuple[Convert, Convert, float]:
    """Conversions between units by their endings, decimal fractions without rounding on the way, and their factor."""
    ratio = exact_conversion(INCHES[ending][0], UNITS[metric].text)
    assert ratio is not None  # both are units of one quantity

    def to_key(value: float) -> float:
        return float(Fraction(repr(value)) * ratio)

    def from_key(value: float) -> float:
        return float(Fraction(repr(value)) / ratio)

    return to_key, from_key, float(ratio)


def writing_of(
    name: str, keys: Mapping[str, Key], equivalents: Equivalents, table: Mapping[str, Any] = {}
) -> Writing | None:
    """How a name that is no key of a section writes one of its ``keys``; None where it does not.

    Examples
    --------
    >>> from loaded_tca.scene.keys import Number
    >>> writing = writing_of("pinion_torque_lbf_in", {"pinion_torque_Nm": Key(Number(0.0, 1e9), "torque")}, {})
    >>> writing.key, writing.converted(1000.0)
    ('pinion_torque_Nm', 112.9848290276167)
    """
    if name in equivalents:
        return Writing(equivalents[name].key, name, *equivalents[name].conversions(table))
    if name.endswith(f"_{PITCH}") and (key := name.removesuffix(PITCH) + MODULE) in keys:
        return Writing(key, name, *reciprocal())
    for ending, (_, endings) in INCHES.items():
        stem = name.removesuffix(f"_{ending}")
        for metric in endings if stem != name else ():
            if (key := f"{stem}_{metric}") in keys and keys[key].of_one_unit:
                return Writing(key, name, *_proportional(ending, metric))
    return None


def in_inches(key: str, entry: Key) -> Writing | None:
    """How drawings in inches usually write a key; None where they have no other unit."""
    if key.endswith(f"_{MODULE}"):
        return Writing(key, key.removesuffix(MODULE) + PITCH, *reciprocal(), given=False)
    metric = ending_of(key)
    ending = next((ending for ending, (_, endings) in INCHES.items() if metric in endings), None)
    if ending is None or not entry.of_one_unit:
        return None
    return Writing(key, key.removesuffix(metric) + ending, *_proportional(ending, metric), given=False)


@dataclass(frozen=True)
class WrittenTable:
    """A table by the keys of its section.

    Attributes
    ----------
    table : mapping
        Key -> value as written; other names as they are.
    writings : dict
        Key -> how it is written; where the table is in inches, also how other keys would be.
    problems : tuple of str
        What is to be asked, with the name it is about in front.
    """

    table: Mapping[str, Any]
    writings: dict[str, Writing] = field(default_factory=dict)
    problems: tuple[str, ...] = ()


def by_keys(table: Mapping[str, Any], keys: Mapping[str, Key], equivalents: Equivalents, section: str) -> WrittenTable:
    """Return a table by the keys of a section; ``section`` is its name in questions."""
    names = [name for name, value in table.items() if name not in keys and value is not None and isinstance(name, str)]
    writings = {
        name: replace(writing, value=_number(table[name]))
        for name in names
        if (writing := writing_of(name, keys, equivalents, table))
    }
    if not writings:
        return WrittenTable(table)
    by_key: dict[str, Writing] = {}
    problems: list[str] = []
    for name, writing in writings.items():
        other = by_key[writing.key].name if writing.key in by_key else writing.key
        if table.get(other) is not None:
            problems.append(
                f"{name}: found {shown(table[name])} beside {other} = {shown(table[other])}; give one of them"
            )
        elif name in equivalents and (question := equivalents[name].question(table)):
            problems.append(f"{name}: found {shown(table[name])}; {question}")
        by_key.setdefault(writing.key, writing)
    systems = {name: _is_in_inches(name, keys, equivalents) for name, value in table.items() if value is not None}
    inches = [name for name, one in systems.items() if one]
    metric = [name for name, one in systems.items() if one is False]
    if inches and metric and not problems:
        problems.append(
            f"{inches[0]}: found beside {metric[0]}; which system is meant? Write all of {section} in inches, lbf and "
            "psi, or in mm, N and MPa"
        )
    values = {name: value for name, value in table.items() if name not in writings}
    absent = {key: entry for key, entry in keys.items() if inches and values.get(key) is None}
    others = {key: usual for key, entry in absent.items() if (usual := in_inches(key, entry))}
    values |= {key: table[writing.name] for key, writing in by_key.items()}
    return WrittenTable(values, others | by_key, tuple(problems))


def _number(value: Any) -> float | None:
    """A finite number as a float; None of anything else."""
    is_number = isinstance(value, Real) and not isinstance(value, bool) and math.isfinite(value)
    return float(value) if is_number else None


def _is_in_inches(name: str, keys: Mapping[str, Key], equivalents: Equivalents) -> bool | None:
    """Whether a name belongs to a drawing in inches; None: it belongs to either."""
    if name in equivalents:
        return equivalents[name].inches
    if name in keys:
        return False if ending_of(name) in METRIC and keys[name].of_one_unit else None
    return True if writing_of(name, keys, equivalents) else None


def answered(problems: Iterable[str], writings: Mapping[str, Writing]) -> list[str]:
    """Problems, each with the path of a key in front, as they are told where keys are written otherwise."""
    parts = [problem.partition(": ") for problem in problems]
    return [as_written(head, "", writings) + colon + as_written(rest, head, writings) for head, colon, rest in parts]


def as_written(sentence: str, head: str, writings: Mapping[str, Writing]) -> str:
    """A refusal of values by the names and in the units that tables have.

    Parameters
    ----------
    sentence : str
        Behind the key that it is about.
    head : str
        That key.
    writings : mapping
        Keys as the sentence may name them -> how they are written.

    Examples
    --------
    >>> writings = {name: in_inches(name, Key(Number(0.0, 1e9), "")) for name in ("bore_mm", "tip_mm")}
    >>> as_written("found 50.8; allowed up to tip_mm = 25.4", "bore_mm", writings)
    'found 2; allowed up to tip_in = 1'
    """

    def named(match: re.Match[str]) -> str:
        writing = writings[match["key"]]
        name = writing.path(match["key"])
        return name if match["value"] is None else f"{name} = {writing.text(match['value'])}"

    if head in writings:
        sentence = OF_THE_KEY.sub(lambda match: writings[head].text(match[0]), sentence)
    names = "|".join(re.escape(name) for name in sorted(writings, key=len, reverse=True))
    return re.sub(rf"(?<![\w.])(?P<key>{names})\b(?: = (?P<value>{NUMBER}))?", named, sentence) if names else sentence
