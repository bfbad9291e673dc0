"""One row of the validation table, and how the table is printed."""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Row:
    """A quantity of one case beside the number it is compared with.

    ``tolerance`` is relative (absolute where ``expected`` is zero); None where a difference is expected and
    only shown, without a verdict. ``assumed`` names every input that the source does not print, ``note`` says what else
    a reader of the row must know.
    """

    case: str
    source: str
    quantity: str
    expected: float
    obtained: float
    tolerance: float | None
    assumed: str = ""
    note: str = ""

    @property
    def error(self) -> float:
        """Relative error; absolute where the expected value is zero."""
        difference = self.obtained - self.expected
        return difference / abs(self.expected) if self.expected else difference

    @property
    def holds(self) -> bool:
        """Whether the error is within the tolerance (NaN never is)."""
        return self.tolerance is None or abs(self.error) <= self.tolerance


def render(rows: Iterable[Row]) -> str:
    """The table as text, one line a row."""
    head = ("case", "quantity", "source", "expected", "obtained", "error", "allowed", "")
    lines = [head, *(_cells(row) for row in rows)]
    widths = [max(len(line[k]) for line in lines) for k in range(len(head))]
    text = ["  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip() for line in lines]
    return "\n".join([text[0], "-" * max(map(len, text)), *text[1:]])


ROUNDING = 1e-9
"""Relative difference below which a number has not moved; numbers near zero: ..."""
ABSOLUTE_ROUNDING = 1e-12


def moved(rows: Sequence[Row], before: Sequence[Row]) -> list[str]:
    """Lines that tell which numbers of rows differ from those of an earlier run, and which rows came or went.

    A row is known by case, source and quantity; among equal ones by its order.
    """
    now, then = _by_name(rows), _by_name(before)
    lines = []
    for number, (name, row) in enumerate(now.items()):
        for part in ("expected", "obtained") if name in then else ():
            new, old = getattr(row, part), getattr(then[name], part)
            if not np.isclose(new, old, rtol=ROUNDING, atol=ABSOLUTE_ROUNDING, equal_nan=True):
                lines.append(f"row {number}: {row.case}, {row.quantity}: {part} {old:.10g} -> {new:.10g}")
    count = len(lines)
    for sign, some, others in (("-", then, now), ("+", now, then)):
        lines += [
            f"{sign} {row.case}, {row.quantity} ({row.source})" for name, row in some.items() if name not in others
        ]
    return [
        *lines,
        f"{count} numbers moved by more than {ROUNDING:g}; rows: {len(before)} before, {len(rows)} now",
    ]


def _by_name(rows: Iterable[Row]) -> dict[tuple[str, str, str, int], Row]:
    """Rows by case, source, quantity and how many rows of that name stand above."""
    named: dict[tuple[str, str, str, int], Row] = {}
    above: Counter[tuple[str, str, str]] = Counter()
    for row in rows:
        name = (row.case, row.source, row.quantity)
        named[*name, above[name]] = row
        above[name] += 1
    return named


def _cells(row: Row) -> tuple[str, ...]:
    allowed, verdict = "-", "shown"
    if row.tolerance is not None:
        allowed, verdict = f"{row.tolerance:.1e}", "ok" if row.holds else "FAILS"
    remarks = (verdict, row.note, row.assumed and f"assumed: {row.assumed}")
    return (
        row.case,
        row.quantity,
        row.source,
        f"{row.expected:.8g}",
        f"{row.obtained:.8g}",
        f"{row.error:+.1e}",
        allowed,
        "; ".join(filter(None, remarks)),
    )
