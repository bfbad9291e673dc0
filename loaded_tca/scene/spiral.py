"""What scenes of gears on meeting axes share: mounting errors, and which flanks a sense of rotation brings in contact.

On a right-hand pinion the flank with side s = +1 is the concave one, on a left-hand pinion the convex one; the flank in
contact has s = +1 where the pinion drives and turns about +z, or the wheel drives the other way.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, sin
from typing import Any, ClassVar, Literal

import numpy as np

from loaded_tca.flanks.base import Flank, outward_normal
from loaded_tca.pairs.gear_pair import Driving, Sense, signs_of
from loaded_tca.scene.keys import Choice, Number, key
from loaded_tca.scene.model import Row, Scene
from loaded_tca.scene.rows import fixed
from loaded_tca.scene.section import Section, rule
from loaded_tca.scene.sections import ERROR_deg, ERROR_mm

Side = Literal["concave", "convex"]
SIDE = Choice(("concave", "convex"))
SHAFT_ANGLE_deg = Number(1.0, 179.0)


FLANK_OR_SENSE = rule(
    ("pinion_flank", "sense"), lambda *both: None in both, 'found "{0}" beside sense = "{1}"; give one of the two'
)
"""Of [pair]."""
ONE_PRESSURE_ANGLE = rule(
    ("normal_pressure_angle_deg", "pressure_angle_deg"),
    lambda *both: None in both,
    "found {0:g} beside pressure_angle_deg = {1:g}; give one of the two",
)
"""Of [pair]."""
AXES_THAT_MEET = rule(
    ("mounting.shaft_angle_error_deg", "pair.shaft_angle_deg"),
    lambda error, shaft_angle: 0.0 < shaft_angle + error < 180.0,
    "found {0:g}; with pair.shaft_angle_deg = {1:g} it must stay between 0 and 180",
)
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


@dataclass(frozen=True, kw_only=True)
class SpiralScene(Scene):
    """A scene of gears on meeting axes, whose flanks in contact may be asked for by name."""

    vh_keys: ClassVar[tuple[str, str]] = ("mounting.offset_mm", "mounting.pinion_axial_mm")
    usual_flank: ClassVar[Side | None] = None
    """Flank of the pinion in contact where neither flank nor sense is given; None: the sense is positive."""

    @property
    def sense(self) -> Sense:
        """Sense of rotation, as given, or such that the pinion touches with the flank asked for."""
        wanted: Any = self.geometry
        flank = wanted.pinion_flank or self.usual_flank
        if wanted.sense is not None or flank is None:
            return wanted.sense or "positive"
        return sense_for(flank, self.hand_signs[0], wanted.driving)

    def sides(self, sense: Sense) -> tuple[Side, Side]:
        """Return which flanks of pinion and wheel touch in a sense of rotation."""
        wanted: Any = self.geometry
        return sides_in_contact(sense, self.hand_signs[0], wanted.driving)

    @property
    def contact_sides(self) -> tuple[str, str]:
        """Sides in contact of pinion and wheel: "concave" or "convex"."""
        return self.sides(self.sense)

    @property
    def flank_names(self) -> tuple[str, str]:
        """Gear and side in contact."""
        pinion, wheel = self.contact_sides
        return f"{pinion} flank of the pinion", f"{wheel} flank of the wheel"


Point = tuple[float, float]
"""(rho, z) [mm]."""


def pitch_point(cone_distance: float, pitch_angle: float) -> Point:
    """Point of the pitch cone at a cone distance."""
    return cone_distance * sin(pitch_angle), cone_distance * cos(pitch_angle)


def force_rows(flanks: tuple[Flank, Flank], points: tuple[Point, Point], torques: Sequence[float]) -> list[Row]:
    """Forces at the mean pitch points of pinion and wheel under pinion torques [N mm], a cell for each.

    One tooth pair carries all.
    """
    # Unit normals out of the flanks: radial, tangential and axial parts.
    pinion, wheel = (
        outward_normal(flank, np.array(rho), np.array(z)) for flank, (rho, z) in zip(flanks, points, strict=True)
    )
    tangential = abs(float(pinion[1]))
    rows = (
        ("mean tangential force F_mt [N]", tangential),
        ("normal force F_n [N]", 1.0),
        ("axial force on the pinion, from its apex [N]", -pinion[2]),
        ("radial force on the pinion, to its axis [N]", pinion[0]),
        ("axial force on the wheel, from its apex [N]", -wheel[2]),
        ("radial force on the wheel, to its axis [N]", wheel[0]),
    )
    normal_forces = [torque / (points[0][0] * tangential) for torque in torques]
    return [(label, *(fixed(part * force, 1) for force in normal_forces)) for label, part in rows]
