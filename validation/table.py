"""One row of the validation table, and how the table is printed."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Row:
    """A quantity of one case beside the number it is compared with.

    ``tolerance`` is relative (absolute where ``expected`` is zero); None where a difference is expected and
    only shown. ``assumed`` names every input that the source does not print.
    """

    case: str
    source: str
    quantity: str
    expected: float
    obtained: float
    tolerance: float | None
    assumed: str = ""

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
    """Lines that tell which numbers of rows, taken in their order, differ from those of an earlier run."""
    lines = []
    for number, (row, old) in enumerate(zip(rows, before, strict=False)):
        for name in ("expected", "obtained"):
            now, then = getattr(row, name), getattr(old, name)
            if not np.isclose(now, then, rtol=ROUNDING, atol=ABSOLUTE_ROUNDING, equal_nan=True):
                lines.append(f"row {number}: {row.case}, {row.quantity}: {name} {then:.10g} -> {now:.10g}")
    return [
        *lines,
        f"{len(lines)} numbers moved by more than {ROUNDING:g}; rows: {len(before)} before, {len(rows)} now",
    ]


def _cells(row: Row) -> tuple[str, ...]:
    allowed = "shown" if row.tolerance is None else f"{row.tolerance:.0e}"
    verdict = "ok" if row.holds else "FAILS"
    remark = f"{verdict}; assumed: {row.assumed}" if row.assumed else verdict
    return (
        row.case,
        row.quantity,
        row.source,
        f"{row.expected:.8g}",
        f"{row.obtained:.8g}",
        f"{row.error:+.1e}",
        allowed,
        remark,
    )
