"""What a verdict on a statement of the reduced-TCA dissertation is; ``spur_trends`` and others give them."""

from collections.abc import Iterable
from dataclasses import dataclass
from math import log

from loaded_tca.flanks.removal import LOGARITHMIC_STEEPNESS
from validation.page import line

ALIKE = 0.1
"""Relative difference of two heights up to which "similar" and "not significantly different" are said to hold."""
STEEPER = -log(1.0 - LOGARITHMIC_STEEPNESS) / LOGARITHMIC_STEEPNESS
"""Amount at which a logarithmic crowning is as curved in the middle of the face as a parabola of amount 1."""


@dataclass(frozen=True)
class Trend:
    """A statement of the source, whether it holds here, and the numbers that say so."""

    figure: str
    statement: str
    holds: bool
    because: str


def verdicts(trends: Iterable[Trend]) -> list[str]:
    """One line of a Markdown table a statement."""
    return [
        line((one.figure, one.statement, "holds" if one.holds else "**does not hold**", one.because)) for one in trends
    ]
