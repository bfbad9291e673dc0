"""Labels and cells of the lines of overviews: text as tables show it, with names and numbers as data has them."""

from __future__ import annotations

from typing import Any


class Cell(str):
    """A cell of a line, with its value as data has it: a number with all its digits, or several by their names."""

    __slots__ = ("value",)
    value: Any

    def __new__(cls, text: str, value: Any) -> Cell:
        """Make a cell of its text and its value."""
        made = super().__new__(cls, text)
        made.value = value
        return made


class Label(str):
    """A label of a line, with its name in data, and those of its cells where there are several."""

    __slots__ = ("name", "parts")
    name: str
    parts: tuple[str, ...]

    def __new__(cls, text: str, name: str, *parts: str) -> Label:
        """Make a label of its text, its name and those of its cells."""
        made = super().__new__(cls, text)
        made.name, made.parts = name, parts
        return made

    def strip(self, chars: str | None = None, /) -> Label:
        """Return the label with its text stripped."""
        return Label(super().strip(chars), self.name, *self.parts)


def fixed(value: float, places: int) -> Cell:
    """A number with so many decimal places, no minus before a zero."""
    return Cell(f"{value:z.{places}f}", float(value) + 0.0)
