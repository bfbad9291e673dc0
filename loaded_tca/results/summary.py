"""The text that tells an engineer what a mesh cycle came to: a table of key figures, and what limits them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from loaded_tca.plain import apart, lasting, plain
from loaded_tca.results.figures import FIGURES, SUMMARY
from loaded_tca.results.key_figures import WHERE_REASONS_ARE, reasons_beside
from loaded_tca.units import without_unit

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from loaded_tca.results.figure import Figures

ROUNDING = 1e-6
"""Figures below this, in the engineer's units, are rounding; residuals and errors of the grid are not."""
FOUR_DIGITS = 9999.5
"""From here on four digits would be written with an exponent."""
WIDEST = 120
"""Characters of a line of a table; more columns stand below it, in further tables."""
MOST_TORQUES = 6
"""Torques that a note names one by one."""

NOTES = (
    ("line_positions", "the unloaded contact is a line"),
    ("edge_positions", "the contact reaches an edge of a flank"),
    ("relief_start_positions", "the start of a linear relief lies in the contact, for which Hertz gives no pressure"),
)
"""Key figure that counts positions, and what holds at these."""
ON_BACK = ("pinion_root_tension_on_back", "wheel_root_tension_on_back")
"""Key figures that say on which side of the tooth the root tension lies."""
BESIDE_ISO = "root stress, computed or after ISO 6336-3:2006, has no safety, K_A, K_V, life or material factors in it"
"""What stands beside stress by the standard."""


def summary_of(
    title: str, scope: str, rows: Sequence[Sequence[str]], sentences: Mapping[str, Sequence[str]], beside: str = ""
) -> str:
    """Return the summary of any result: title, scope, a table, and below it sentences of several kinds.

    Parameters
    ----------
    title, scope : str
        First lines.
    rows : sequence of (str, ...)
        Of the table: a label, and a cell for each torque. Where they are wider than 120 characters, the table goes on
        below, with the same labels.
    sentences : mapping of str to sequence of str
        Word that each of some sentences begins with -> the sentences.
    beside : str
        A line below the table.
    """
    tables = "\n\n".join(_tables(rows))
    below = [f"{word}: {sentence}" for word, some in sentences.items() for sentence in some]
    return "\n".join([title, scope, tables, *([beside] if beside else []), *below])


def _tables(rows: Sequence[Sequence[str]]) -> Iterator[str]:
    """Tables with as many columns each as have room; a label may reach over the empty part of its first cell."""
    width = 2 + max(len(cell) for _, *cells in rows for cell in cells)
    labels = max(len(label) + 2 + max(map(len, cells), default=0) for label, *cells in rows) - width
    count, columns = max(1, (WIDEST - labels) // width), max(len(cells) for _, *cells in rows)
    for first in range(0, columns, count):
        lines = []
        for label, *cells in rows:
            text = "".join(f"{cell:>{width}}" for cell in cells[first : first + count])
            if text or first == 0:
                lines.append(f"{label:<{labels}}{text[max(0, len(label) - labels) :]}")
        yield "\n".join(lines)


def summary_text(
    title: str,
    scope: str,
    figures: Sequence[Figures],
    warnings: Sequence[str] = (),
    findings: Sequence[str] = (),
    more: Sequence[Sequence[str]] = (),
    notes: Sequence[str] = (),
) -> str:
    """Return the summary of a mesh cycle: one line per figure with a column per torque, notes, findings, warnings.

    Parameters
    ----------
    title, scope : str
        First two lines.
    figures : sequence of mapping
        Of each torque, as ``MeshCycle.key_figures`` gives them.
    warnings, findings : sequence of str
        Accuracy warnings of the analysis, and what ``MeshCycle.findings`` says.
    more : sequence of (str, ...)
        Further rows.
    notes : sequence of str
        Notes before those on the figures.
    """
    edge = kind_of_edge([entry for entry in figures if not math.isnan(entry.get("edge_pressure_MPa", math.nan))])
    rows = [
        (
            label.format(edge=edge),
            *(" | ".join(shown(entry.get(name, math.nan), name) for name in names) for entry in figures),
        )
        for label, names in known_rows(figures)
    ]
    beside = WHERE_REASONS_ARE if any(reasons_beside(*figures)) else ""
    sentences = {"note": [*notes, *limits_of(figures)], "finding": findings, "warning": warnings}
    return summary_of(title, scope, [*rows, *more], sentences, beside)


def known_rows(figures: Sequence[Figures]) -> list[tuple[str, tuple[str, ...]]]:
    """Return label and key figures of the lines that a summary has: those that are always there or any torque knows."""
    return [
        (line.label, line.names)
        for line in SUMMARY
        if line.is_always_there
        or any(not math.isnan(entry.get(name, math.nan)) for entry in figures for name in line.names)
    ]


def kind_of_edge(figures: Sequence[Figures]) -> str:
    """At which kind of edge some figures have their edge pressure, and whether it depends on the mesh."""
    rounded = {bool(entry.get("edge_is_rounded", False)) for entry in figures}
    if rounded == {True}:
        return "at a rounded edge"
    return (
        "at an edge of any pair, mesh-dependent if sharp"
        if True in rounded
        else "at a sharp edge of any pair, mesh-dependent"
    )


def without_rounding(value: float, name: str) -> float:
    """Zero for what is rounding in the engineer's units; residuals and errors of the grid stay what they are."""
    exact = "residual" in name or "discretisation" in name
    return value if exact or not abs(value) < ROUNDING else 0.0


def known(value: float, name: str) -> float | None:
    """Return a number as JSON has it: without what is rounding; None if it is not known."""
    if isinstance(value, bool | int):
        return value
    return without_rounding(value, name) if math.isfinite(value) else None


def shown(value: float, name: str) -> str:
    """Return a figure as summaries show it: four digits, all those before the point; a dash for what is not known.

    Errors of the edge pressure and of K_Hbeta are shown in %.
    """
    value = without_rounding(value, name)
    if math.isnan(value):
        return "-"
    if "residual" in name:
        return f"{value:.1e}"
    if without_unit(name).endswith("_life"):
        return lasting(value)
    if name in FIGURES and FIGURES[name].is_part:
        return plain(100.0 * value, 2)
    return f"{value:z.0f}" if abs(value) >= FOUR_DIGITS else plain(value)


def shown_torque(torque: float) -> str:
    """Return a torque [N mm] as summaries show it, with its unit, N m."""
    return f"{shown(1e-3 * torque, 'pinion_torque_Nm')} N m"


def limits_of(figures: Sequence[Figures]) -> Iterator[str]:
    """Yield sentences on what limits the figures; none for an ordinary point contact."""
    without = [entry["positions"] - entry["positions_in_contact"] for entry in figures]
    yield from _counted(figures, without, "no tooth pair is in contact")
    higher = [
        bool(entry.get("edge_is_rounded", False)) and entry["edge_pressure_MPa"] > entry["peak_pressure_MPa"]
        for entry in figures
    ]
    if any(higher):
        torques = _for_torques(figures, higher)
        yield f"the pressure at a rounded edge is above the peak pressure, which leaves edges out{torques}"
    for name, sentence in NOTES:
        yield from _counted(figures, [entry[name] for entry in figures], sentence)
    for name in ON_BACK:
        back = [bool(entry.get(name, False)) for entry in figures]
        if any(back):
            gear = name.partition("_")[0]
            yield f"the root tension of the {gear} lies on the back of a tooth{_for_torques(figures, back)}"
    if any(math.isfinite(entry.get("root_face_load_factor_iso_6336", math.nan)) for entry in figures):
        yield BESIDE_ISO
    cap = figures[0]["max_pressure_MPa"]
    if math.isfinite(cap):
        counts = [entry["capped_positions"] for entry in figures]
        yield from _counted(figures, counts, f"the pressure equals the cap on the pressure, {plain(cap, 6)} MPa")
        if not any(counts):
            yield f"the cap on the pressure, {plain(cap, 6)} MPa, is not reached"


def _counted(figures: Sequence[Figures], counts: Sequence[float], sentence: str) -> Iterator[str]:
    """One sentence for each number of positions, with the torques that it holds for."""
    for count in sorted(set(counts) - {0}):
        holds = [one == count for one in counts]
        yield f"at {count} of {figures[0]['positions']} positions{_for_torques(figures, holds)} {sentence}"


def _for_torques(figures: Sequence[Figures], holds: Sequence[bool]) -> str:
    """Which of several torques something holds for; nothing where there is one torque."""
    if len(figures) == 1:
        return ""
    if all(holds):
        return " (all torques)"
    torques = apart([entry["pinion_torque_Nm"] for entry, one in zip(figures, holds, strict=True) if one])
    if len(torques) > MOST_TORQUES:
        return f" ({len(torques)} torques, {torques[0]} to {torques[-1]} N m)"
    return f" ({', '.join(torques)} N m)"
