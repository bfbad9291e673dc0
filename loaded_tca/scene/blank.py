"""Scenes of gears whose blanks are given by teeth, face width and hand: what cylindrical and bevel gears share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from loaded_tca.scene.keys import Choice, Number, above_zero, key
from loaded_tca.scene.model import Hand, Scene
from loaded_tca.scene.section import Rule, subsection
from loaded_tca.scene.sections import GearSection, end_reliefs_within


@dataclass(frozen=True, kw_only=True)
class BlankGearSection(GearSection):
    """[pinion], [wheel] of a gear with a face width, a hand and a profile shift."""

    face_width_mm: float = key(above_zero(10000.0), "face width b")
    hand: Hand | None = key(
        Choice(("right", "left")),
        "hand of the helix or spiral (without meaning for straight teeth)",
        None,
        "right for the pinion, and the other for the wheel",
    )
    profile_shift: float = key(Number(-5.0, 5.0), "profile shift coefficient x", 0.0)

    rules: ClassVar[tuple[Rule, ...]] = end_reliefs_within("face_width_mm")


OTHER: dict[Hand, Hand] = {"right": "left", "left": "right"}
"""Hand -> the opposite one."""


def opposite_hands(place: str = "") -> Rule:
    """Rule: the two gears have opposite hands, where both are given."""

    def complain(wheel: Hand | None, pinion: Hand | None) -> str | None:
        if wheel is None or wheel != pinion:
            return None
        return f'found "{wheel}" on both gears; allowed "{OTHER[wheel]}", the hand that the pinion does not have'

    return Rule((f"wheel.{place}hand", f"pinion.{place}hand"), complain)


@dataclass(frozen=True, kw_only=True)
class BlankScene(Scene):
    """A scene whose gears have opposite hands."""

    pinion: BlankGearSection = subsection(BlankGearSection, "the gear that turns about +z")
    wheel: BlankGearSection = subsection(BlankGearSection, "the mating gear of the pinion")

    rules: ClassVar[tuple[Rule, ...]] = (*Scene.rules, opposite_hands())

    @property
    def hands(self) -> tuple[Hand, Hand]:
        """Hands of pinion and wheel: as one of them is given; where none is, the pinion is right-hand."""
        pinion = self.pinion.hand or OTHER[self.wheel.hand or "left"]
        return pinion, OTHER[pinion]
