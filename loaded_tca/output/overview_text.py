"""An overview of what a scene or a stage amounts to before any contact: as lines of text, and as JSON."""

from __future__ import annotations

import json
import math
import re
from dataclasses import dataclass
from itertools import chain
from typing import TYPE_CHECKING, Any

from loaded_tca.scene.rows import Cell, Label
from loaded_tca.units import as_ending

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from loaded_tca.scene.model import Row

LABEL, CELL = 44, 14
"""Characters of the label of a line, and of each of its cells."""
HEADED = "path of contact", "phases"
"""Subjects whose first line names the columns below it, as lines without a label do."""
UNIT = re.compile(r"^(.*?)[,:]? *\[([^\]]+)\]$")
"""A label with the unit of its cells at its end."""


@dataclass(frozen=True)
class Overview:
    """What a scene or a stage amounts to, in lines.

    Attributes
    ----------
    title : str
    sections : dict of str to list of rows
        Lines by their subjects, each a label and its cells.
    parts : dict of str to dict of str to list of rows
        The same of meshes or halves, by their names.
    effort : dict of str to str
        Time and memory of an analysis, by their names in JSON.
    effort_row : row
        The same as a line.
    sentences, warnings, notes : sequences of str
        On what stands beside, on whole gears, and on the analysis.
    """

    title: str
    sections: Mapping[str, list[Row]]
    parts: Mapping[str, Mapping[str, list[Row]]]
    effort: Mapping[str, str]
    effort_row: Row
    sentences: Sequence[str] = ()
    warnings: Sequence[str] = ()
    notes: Sequence[str] = ()

    @property
    def text(self) -> str:
        """All lines, numbers below each other."""
        lines = [self.title, *_lines(self.sections)]
        for name, sections in self.parts.items():
            lines += ["", name, *_lines(sections)]
        lines += ["", *_line(self.effort_row)] if self.parts else _line(self.effort_row)
        warned = (f"warning: {sentence}" for sentence in self.warnings)
        return "\n".join([*lines, *self.sentences, *warned, *(f"note: {note}" for note in self.notes)])

    def to_json(self, **more: Any) -> str:
        """The same as JSON, with what else there is to say: names end in units, numbers are numbers.

        Lines of several cells are lists, or objects by the names of their columns.
        """
        data: dict[str, Any] = {"title": self.title} | _objects(self.sections)
        data |= {as_name(name): _objects(sections) for name, sections in self.parts.items()}
        data["analysis"] = {name: _value(cell) for name, cell in self.effort.items()}
        data |= {"sentences": [*self.sentences], "warnings": [*self.warnings], "notes": [*self.notes]}
        return json.dumps(data | more, indent=2, ensure_ascii=False, allow_nan=False)


def as_name(label: str) -> str:
    """Name in JSON of a label, with its unit at the end.

    Examples
    --------
    >>> as_name("tip clearance c: at the pinion's tip [mm]"), as_name("mesh stiffness [N/(mm um)]"), as_name("teeth")
    ('tip_clearance_c_at_the_pinion_s_tip_mm', 'mesh_stiffness_N_per_mm_um', 'teeth')
    """
    match = UNIT.match(label.strip())
    words, unit = match.groups() if match else (label.strip(), "1")
    parts = re.sub(r"[^\w.]+", "_", words).strip("_"), as_ending(unit)
    return "_".join(filter(None, parts))


def _lines(sections: Mapping[str, list[Row]]) -> Iterator[str]:
    return chain.from_iterable(_line(row) for row in chain.from_iterable(sections.values()))


def _line(row: Row) -> list[str]:
    """A line; cells that fill their column keep two blanks before them."""
    label, *cells = row
    return [f"{label:<{LABEL}}" + "".join(f"{cell:>{CELL}}" if len(cell) < CELL - 1 else f"  {cell}" for cell in cells)]


def _objects(sections: Mapping[str, list[Row]]) -> dict[str, dict[str, Any]]:
    return {as_name(subject): _object(rows, subject in HEADED) for subject, rows in sections.items() if rows}


def _object(rows: Iterable[Row], is_headed: bool) -> dict[str, Any]:
    """Values of lines by the names of their labels, those of indented lines after that of the line above them."""
    columns: list[str] = []
    above, values = "", {}
    for row in rows:
        label, *cells = row
        if not label or (is_headed and not columns):
            columns, above = cells, ""
            continue
        if not label.startswith(" "):
            above = ""
        name = label.name if isinstance(label, Label) else as_name(f"{above} {label}" if above else label)
        parts = label.parts if isinstance(label, Label) else ()
        values[name] = _of_cells([_value(cell) for cell in cells], parts or columns)
        if not label.startswith(" ") and not is_headed:
            above = UNIT.sub(r"\1", label)
    return values


def _of_cells(values: list[Any], columns: Sequence[str]) -> Any:
    """The one value of a line, an object by the names of as many columns, or a list."""
    if len(values) == 1 and not columns:
        return values[0]
    if columns and len(columns) == len(values):
        return {as_name(column): value for column, value in zip(columns, values, strict=True)}
    return values[0] if len(values) == 1 else values


def _value(cell: str) -> Any:
    """The value of a cell; text that is no number stays text, a dash is nothing."""
    if isinstance(cell, Cell):
        return cell.value
    if cell == "-":
        return None
    try:
        number = float(cell)
    except ValueError:
        return cell
    if not math.isfinite(number):
        return cell
    return int(cell) if re.fullmatch(r"[+-]?\d+", cell) else number
