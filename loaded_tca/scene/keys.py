"""What a key of a scene file may hold: a kind of value with its range, told in the same words everywhere.

Values as TOML writes them: for messages (short) and for scene files (exact).
"""

from __future__ import annotations

import difflib
import json
import re
import unicodedata
from collections.abc import Iterable
from dataclasses import dataclass, field
from numbers import Integral, Real
from typing import Any, Protocol

import numpy as np

from loaded_tca.plain import plain

LONGEST_SHOWN = 60
"""Characters of a value that a message repeats."""


def literal(value: Any) -> str:
    r"""Return a value as TOML, exact to the last digit of a float.

    Examples
    --------
    >>> literal((20.0, 130.0)), literal(True), literal('5 "µm"')
    ('[20.0, 130.0]', 'true', '"5 \\"µm\\""')
    >>> print(literal(((1.0, 2.0), (3.0, 4.0))))
    [
        [1.0, 2.0],
        [3.0, 4.0],
    ]
    """
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, dict):
        return "{" + ", ".join(f"{name} = {_in_one_line(entry)}" for name, entry in value.items()) + "}"
    if isinstance(value, list | tuple) and value and isinstance(value[0], list | tuple | dict):
        return "[\n" + "".join(f"    {literal(line)},\n" for line in value) + "]"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(literal(entry) for entry in value) + "]"
    return repr(value)


def _in_one_line(value: Any) -> str:
    """A value as TOML without line breaks, as tables in lines have it."""
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_in_one_line(entry) for entry in value) + "]"
    return literal(value)


def shown(value: Any) -> str:
    """Return any value that a file may hold, short enough for one line of a message."""
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, list | tuple):
        first = ["a list" if isinstance(entry, list | tuple) else shown(entry) for entry in value[:4]]
        return "[" + ", ".join(first + ["..."] * (len(value) > 4)) + "]"
    if isinstance(value, int) and value.bit_length() > 100:
        return f"a whole number of {value.bit_length()} bits"
    if isinstance(value, bool | str):
        return _shortened(literal(value))
    return _shortened(str(value))


def shown_key(name: str) -> str:
    """Return a key of a file as it may be written, quoted where it must be."""
    return _shortened(name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else literal(name))


def _shortened(text: str) -> str:
    cut = text if len(text) <= LONGEST_SHOWN else text[: LONGEST_SHOWN - 3] + "..."
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in cut)


REQUIRED: Any = object()
"""Default of a key that has none."""


class Kind(Protocol):
    """Turns a value found in a file into the value of a scene, or refuses it with a ValueError."""

    @property
    def allowed(self) -> str:
        """What the key may hold, to be read after the word "allowed"."""

    def read(self, value: Any) -> Any:
        """Return the value in its canonical type; ValueError: "found ...; allowed ..."."""


def _is_a(value: Any, number: type) -> bool:
    return isinstance(value, number) and not isinstance(value, bool)


def _refusal(kind: Kind, value: Any, hint: str = "") -> ValueError:
    return ValueError(f"found {shown(value)}; allowed {kind.allowed}{hint}")


@dataclass(frozen=True)
class Number:
    """A finite number between two limits; ``above`` leaves the lower limit itself out; ``advice`` ends a refusal."""

    low: float
    high: float
    above: bool = False
    advice: str = ""

    @property
    def allowed(self) -> str:
        """The range in words."""
        if self.above:
            return f"a number above {plain(self.low, 6)}, up to {plain(self.high, 6)}"
        return f"a number from {plain(self.low, 6)} to {plain(self.high, 6)}"

    def read(self, value: Any) -> float:
        """Take whole numbers and floats, no booleans, NaN or infinities."""
        if not _is_a(value, Real) or not self.low <= value <= self.high or (self.above and value == self.low):
            raise _refusal(self, value, self.advice and f"; {self.advice}")
        return float(value)


@dataclass(frozen=True)
class ZeroOr:
    """Zero, or a number between two limits above it."""

    number: Number

    @property
    def allowed(self) -> str:
        """The choice in words."""
        return f"0, or {self.number.allowed}"

    def read(self, value: Any) -> float:
        """Take zero, and what the number takes."""
        if _is_a(value, Real) and value == 0.0:
            return 0.0
        try:
            return self.number.read(value)
        except ValueError:
            raise _refusal(self, value) from None


@dataclass(frozen=True)
class Whole:
    """A whole number between two limits, both allowed."""

    low: int
    high: int

    @property
    def allowed(self) -> str:
        """The range in words."""
        return f"a whole number from {self.low} to {self.high}"

    def read(self, value: Any) -> int:
        """Take whole numbers only; 3.0 is none."""
        if not _is_a(value, Integral) or not self.low <= value <= self.high:
            raise _refusal(self, value)
        return int(value)


@dataclass(frozen=True)
class Choice:
    """One of a few words or numbers (or of true and false)."""

    options: tuple[str | int, ...]

    @property
    def allowed(self) -> str:
        """The options in words."""
        return " or ".join(shown(option) for option in self.options)

    def read(self, value: Any) -> str | int:
        """Return the option that equals the value."""
        for option in self.options:
            if type(value) is type(option) and value == option:
                return option
        words = [option for option in self.options if isinstance(option, str)]
        raise _refusal(self, value, did_you_mean(nearest(value, words)) if isinstance(value, str) else "")


@dataclass(frozen=True)
class Line:
    """One line of text."""

    longest: int = 200

    @property
    def allowed(self) -> str:
        """The limit in words."""
        return f"one line of text of up to {self.longest} characters"

    def read(self, value: Any) -> str:
        """Refuse line breaks, control characters and lone surrogates: plots and reports show this text."""
        if not isinstance(value, str) or len(value) > self.longest:
            raise _refusal(self, value)
        if any(unicodedata.category(character) in ("Cc", "Cs", "Zl", "Zp") for character in value):
            raise _refusal(self, value)
        return str(value)


@dataclass(frozen=True)
class List:
    """A list of values of one kind, as long as allowed."""

    kind: Kind
    shortest: int
    longest: int

    @property
    def allowed(self) -> str:
        """Length and entries in words."""
        lengths = f"{self.shortest}" if self.shortest == self.longest else f"{self.shortest} to {self.longest}"
        return f"a list of {lengths} values, each {self.kind.allowed}"

    def read(self, value: Any) -> tuple[Any, ...]:
        """Return a tuple."""
        if not isinstance(value, list | tuple) or not self.shortest <= len(value) <= self.longest:
            raise _refusal(self, value)
        try:
            return tuple(self.kind.read(entry) for entry in value)
        except ValueError as refused:
            raise _refusal(self, value, f" ({refused})") from None


@dataclass(frozen=True)
class Either:
    """A value of one of several kinds.

    Examples
    --------
    >>> Either((Choice(("wheel",)), Whole(1, 9))).read(3)
    3
    """

    kinds: tuple[Kind, ...]

    @property
    def allowed(self) -> str:
        """All of them in words."""
        return ", or ".join(kind.allowed for kind in self.kinds)

    def read(self, value: Any) -> Any:
        """Take what the first of them takes that does not refuse it."""
        for kind in self.kinds:
            try:
                return kind.read(value)
            except ValueError:
                continue
        raise _refusal(self, value)


@dataclass(frozen=True)
class Grid:
    """Numbers in lines of one length, as many lines and numbers as allowed."""

    number: Number
    shortest: int
    longest: int

    @property
    def allowed(self) -> str:
        """Size and entries in words."""
        size = f"{self.shortest} to {self.longest}"
        return f"a list of {size} lists of one length, {size} values, each {self.number.allowed}"

    def read(self, value: Any) -> tuple[tuple[float, ...], ...]:
        """Return tuples; all numbers are looked at together, since there may be thousands."""
        if not isinstance(value, list | tuple) or not all(isinstance(line, list | tuple) for line in value):
            raise _refusal(self, value)
        lengths = {len(value), *(len(line) for line in value)}
        if not value or not self.shortest <= min(lengths) <= max(lengths) <= self.longest:
            raise _refusal(self, value)
        if len({len(line) for line in value}) > 1:
            lengths_in_order = ", ".join(str(len(line)) for line in value[:6])
            raise _refusal(self, value, f" (the lists hold {lengths_in_order}{', ...' if len(value) > 6 else ''})")
        if self._is_sound(value):
            return tuple(tuple(map(float, line)) for line in value)
        try:
            return tuple(tuple(self.number.read(entry) for entry in line) for line in value)
        except ValueError as refused:
            raise _refusal(self, value, f" ({refused})") from None

    def _is_sound(self, value: Any) -> bool:
        """Whether all entries are floats within the limits: quick, and true of nearly all grids."""
        if any(set(map(type, line)) != {float} for line in value):
            return False
        numbers = np.array(value)
        low = numbers > self.number.low if self.number.above else numbers >= self.number.low
        return bool((low & (numbers <= self.number.high)).all())


@dataclass(frozen=True)
class Key:
    """A key of a section: the kind of its value, its default (None: not given) and its meaning.

    ``of_one_unit``: numbers of its value are all in the unit at the end of its name.
    """

    kind: Kind
    about: str
    default: Any = REQUIRED
    absent: str = ""
    of_one_unit: bool = True

    @property
    def required(self) -> bool:
        """Whether a scene must give it."""
        return self.default is REQUIRED

    def read(self, value: Any) -> Any:
        """Return the value of a scene, the default for None; ValueError: the rest of a message."""
        if value is not None:
            return self.kind.read(value)
        if self.required:
            raise ValueError(f"missing; allowed {self.kind.allowed}")
        return self.default


def key(kind: Kind, about: str, default: Any = REQUIRED, absent: str = "", *, of_one_unit: bool = True) -> Any:
    """Dataclass field that is a key of a scene file; ``absent`` says what holds where it is not given."""
    entry = {"entry": Key(kind, about, default, absent, of_one_unit)}
    return field(metadata=entry) if default is REQUIRED else field(default=default, metadata=entry)


def above_zero(high: float) -> Number:
    """Return the kind of lengths and other positive numbers."""
    return Number(0.0, high, above=True)


def nearest(word: str, words: Iterable[str]) -> str | None:
    """Return the word that the given one was probably meant to be, or None.

    Examples
    --------
    >>> nearest("Teth", ["teeth", "face_width_mm"]), nearest("width", ["teeth", "face_width_mm"])
    ('teeth', 'face_width_mm')
    """
    by_lower = {candidate.lower(): candidate for candidate in words}
    wanted = word[:60].lower()
    alike = difflib.get_close_matches(wanted, by_lower, n=1)
    if not alike and len(wanted) > 3:
        alike = [candidate for candidate in by_lower if wanted in candidate]
    return by_lower[alike[0]] if alike else None


def did_you_mean(word: str | None) -> str:
    """Return the end of a message, empty where there is nothing to propose."""
    return "" if word is None else f'; did you mean "{word}"?'
