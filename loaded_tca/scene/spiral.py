"""What scenes of gears on meeting axes share: mounting errors, and which flanks a sense of rotation brings in contact.

On a right-hand pinion the flank with side s = +1 is the concave one, on a left-hand pinion the convex one; the flank in
contact has s = +1 where the pinion drives and turns about +z, or the wheel drives the other way.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from loaded_tca.pairs.gear_pair import Driving, Sense, signs_of
from loaded_tca.scene.keys import Choice, Number, key
from loaded_tca.scene.section import Rule, Section
from loaded_tca.scene.sections import ERROR_deg, ERROR_mm

Side = Literal["concave", "convex"]
SIDE = Choice(("concave", "convex"))
SHAFT_ANGLE_deg = Number(1.0, 179.0)


def _flank_or_sense(flank: str | None, sense: str | None) -> str | None:
    if flank is None or sense is None:
        return None
    return f'found "{flank}" beside sense = "{sense}"; give one of the two'


def _axes_that_meet(error: float, shaft_angle: float) -> str | None:
    if 0.0 < shaft_angle + error < 180.0:
        return None
    return f"found {error:g}; with pair.shaft_angle_deg = {shaft_angle:g} it must stay between 0 and 180"


FLANK_OR_SENSE = Rule(("pinion_flank", "sense"), _flank_or_sense)
"""Of [pair]."""
AXES_THAT_MEET = Rule(("mounting.shaft_angle_error_deg", "pair.shaft_angle_deg"), _axes_that_meet)
"""Of a scene."""


@dataclass(frozen=True, kw_only=True)
class MountingErrors(Section):
    """[mounting] of bevel gears: zero where both apexes are one and the shafts stand at Sigma."""

    offset_mm: float = key(ERROR_mm, "offset E; positive: the wheel's apex moves along +y", 0.0)
    pinion_axial_mm: float = key(
        ERROR_mm, "axial displacement P of the pinion; positive: away from its apex, towards its heel", 0.0
    )
    wheel_axial_mm: float = key(
        ERROR_mm, "axial displacement G of the wheel; positive: away from its apex, towards its heel", 0.0
    )
    shaft_angle_error_deg: float = key(ERROR_deg, "error of the shaft angle; positive: it grows", 0.0)


def sense_for(flank: Side, hand: int, driving: Driving) -> Sense:
    """Sense of rotation in which a pinion touches with a flank.

    Parameters
    ----------
    flank : {"concave", "convex"}
    hand : int
        Of the pinion, +1 right and -1 left.
    driving : {"pinion", "wheel"}

    Examples
    --------
    >>> sense_for("concave", -1, "pinion")
    'negative'
    """
    side = hand * (1 if flank == "concave" else -1)
    return "positive" if side == signs_of(driving, "positive")[1] else "negative"


def sides_in_contact(sense: Sense, hand: int, driving: Driving) -> tuple[Side, Side]:
    """Flanks of pinion and wheel that touch in a sense of rotation.

    Examples
    --------
    >>> sides_in_contact("negative", -1, "pinion")
    ('concave', 'convex')
    """
    return ("concave", "convex") if sense_for("concave", hand, driving) == sense else ("convex", "concave")


def names_of(sides: tuple[str, str]) -> tuple[str, str]:
    """What pictures call the two flanks in contact."""
    return f"{sides[0]} flank of the pinion", f"{sides[1]} flank of the wheel"
