"""Lines of the summary that say where extremes lie, and what is missing for more of it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.results.summary import shown
from loaded_tca.tribology.quantities import QUANTITIES

if TYPE_CHECKING:
    from loaded_tca.tribology.tribology import Tribology


def unknown_in_words(tribology: Tribology) -> Iterator[str]:
    """Yield which lines a summary does not have, and what each of them lacks."""
    reasons: dict[str, list[str]] = {}
    for name, number in QUANTITIES.items():
        if number.label and (reason := tribology.lacking(name)):
            reasons.setdefault(reason, []).append(number.label)
    return (f"{', '.join(labels)}: {reason}" for reason, labels in reasons.items())


def places_in_words(tribology: Tribology, name: str, speed: int) -> list[tuple[str, ...]]:
    """Where an extreme lies, in the words of the summary of contacts."""
    positions, radii, axials = (tribology.by_speed(f"{name}_{end}")[speed] for end in ("position", "radius", "axial"))
    angles = np.append(np.degrees(tribology.result.pinion_angle), math.nan)
    angle = angles[np.where(np.isnan(positions), -1, positions).astype(int)]
    places = (f"{shown(2.0 * radius, '')} | {shown(axial, '')}" for radius, axial in zip(radii, axials, strict=True))
    return [
        ("  pinion angle [deg]", *(shown(one, "") for one in angle)),
        ("  pinion diameter | axial position [mm]", *places),
    ]
