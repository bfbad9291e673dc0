"""What the mesh comes to under each torque, in a few lines of text."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.plain import plain
from loaded_tca.results.summary import shown_torque
from loaded_tca.tribology.quantities import QUANTITIES, SUMMARY, WITH_PLACES

if TYPE_CHECKING:
    from loaded_tca.tribology.tribology import Tribology


def summary_text(tribology: Tribology, speed: int = 0) -> str:
    """Return the table of ``summary_rows`` below what it holds for, and what is missing for more."""
    rows = summary_rows(tribology, speed)
    width, longest = max(len(cell) for _, *cells in rows for cell in cells) + 2, max(len(row[0]) for row in rows)
    table = [f"{head:<{longest}}" + "".join(f"{cell:>{width}}" for cell in cells) for head, *cells in rows]
    reasons: dict[str, list[str]] = {}
    for name in SUMMARY:
        if reason := tribology.lacking(name):
            reasons.setdefault(reason, []).append(SUMMARY[name])
    notes = [f"not known: {', '.join(names)}: {reason}" for reason, names in reasons.items()]
    title = tribology.result.scene.title or "Tribology"
    return "\n".join([title, tribology.conditions.in_words(speed), *table, *notes])


def summary_rows(tribology: Tribology, speed: int = 0) -> list[tuple[str, ...]]:
    """Lines of the summary: the torques, each number that is known under them, and where some extremes lie."""
    tribology.check(0, speed)
    rows = [("pinion torque [N m]", *(shown_torque(one).split()[0] for one in tribology.result.torque))]
    for name in (name for name in SUMMARY if not tribology.lacking(name)):
        values, unit = tribology.by_speed(name)[speed], QUANTITIES[name].unit
        label = SUMMARY[name] + (f" [{unit}]" if unit != "1" else "")
        rows.append((label, *map(_shown, values)))
        rows += _places_in_words(tribology, name, speed) if name in WITH_PLACES else []
    return rows


def _places_in_words(tribology: Tribology, name: str, speed: int) -> list[tuple[str, ...]]:
    """Where an extreme lies, in the words of the summary of contacts."""
    positions, radii, axials = (tribology.by_speed(f"{name}_{end}")[speed] for end in ("position", "radius", "axial"))
    angles = np.append(np.degrees(tribology.result.pinion_angle), math.nan)
    angle = angles[np.where(np.isnan(positions), -1, positions).astype(int)]
    places = (f"{_shown(2.0 * radius)} | {_shown(axial)}" for radius, axial in zip(radii, axials, strict=True))
    return [("  pinion angle [deg]", *map(_shown, angle)), ("  pinion diameter | axial position [mm]", *places)]


def _shown(value: float) -> str:
    """Return a number as the summary shows it; a dash for what is not known."""
    return "-" if math.isnan(value) else plain(value)
