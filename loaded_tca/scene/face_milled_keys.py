"""Sections of face-milled gears: [pair], and blank, machine settings and cutter of each gear."""

from __future__ import annotations

import operator
from dataclasses import dataclass
from typing import ClassVar, Literal

from loaded_tca.gears.cutter import BLADE_SIGNS, MINUTES_PER_NUMBER
from loaded_tca.pairs.gear_pair import Driving, Sense
from loaded_tca.scene import sections
from loaded_tca.scene.keys import Choice, Number, above_zero, key
from loaded_tca.scene.section import Rule, Section, rule, subsection
from loaded_tca.scene.sections import DRIVING, SENSE, Pair, below
from loaded_tca.scene.spiral import FLANK_OR_SENSE, SIDE, SHAFT_ANGLE_deg, Side

LENGTH_mm = above_zero(10000.0)
SETTING_mm = Number(-10000.0, 10000.0)
CONE_deg = above_zero(179.0)
TURN_deg = Number(-360.0, 360.0)
STEEPEST_deg = 59.0
"""Largest blade angle, corrected by the number of the blade group."""
BLADE_deg = Number(-STEEPEST_deg, STEEPEST_deg)
NUMBER = Number(-200.0, 200.0)


@dataclass(frozen=True, kw_only=True)
class Geometry(Pair):
    """[pair] of face-milled gears."""

    type: Literal["face_milled"] = key(Choice(("face_milled",)), "kind of gear pair")
    shaft_angle_deg: float = key(SHAFT_ANGLE_deg, "shaft angle Sigma", 90.0)
    driving: Driving = key(DRIVING, "the gear that drives", "pinion")
    pinion_flank: Side | None = key(
        SIDE, "flank of the pinion that is in contact (drive side: concave)", None, '"concave", or by `sense`'
    )
    sense: Sense | None = key(SENSE, "sense of rotation, instead of `pinion_flank`", None, "by `pinion_flank`")

    rules: ClassVar[tuple[Rule, ...]] = (FLANK_OR_SENSE,)


@dataclass(frozen=True, kw_only=True)
class Blank(Section):
    """[pinion.blank], [wheel.blank]: where the teeth end."""

    hand: Literal["right", "left"] = key(Choice(("right", "left")), "hand of the spiral")
    outer_cone_distance_mm: float = key(LENGTH_mm, "outer cone distance R_e")
    face_width_mm: float = key(LENGTH_mm, "face width b")
    pitch_angle_deg: float = key(
        CONE_deg, "pitch angle delta, as teeth and shaft angle ask for; its last digits are taken from them"
    )
    face_angle_deg: float = key(CONE_deg, "face angle delta_a")
    root_angle_deg: float = key(CONE_deg, "root angle delta_f")
    face_apex_mm: float = key(
        SETTING_mm, "how far the apex of the face cone lies beyond the pitch apex, away from the teeth", 0.0
    )
    root_apex_mm: float = key(SETTING_mm, "likewise the apex of the root cone", 0.0)

    rules: ClassVar[tuple[Rule, ...]] = (
        rule(("root_angle_deg", "pitch_angle_deg"), operator.le, "found {0:g}; allowed up to pitch_angle_deg = {1:g}"),
        rule(
            ("face_angle_deg", "pitch_angle_deg"), operator.ge, "found {0:g}; allowed from pitch_angle_deg = {1:g} on"
        ),
        rule(
            ("face_width_mm", "outer_cone_distance_mm"),
            operator.lt,
            "found {0:g}; allowed below outer_cone_distance_mm = {1:g}",
        ),
    )


@dataclass(frozen=True, kw_only=True)
class Machine(Section):
    """[pinion.machine], [wheel.machine]: machine settings; both flanks of a gear are cut with them."""

    radial_mm: float = key(LENGTH_mm, "radial setting S_r: cradle axis to cutter centre")
    cradle_angle_deg: float = key(TURN_deg, "cradle angle q at the centre of roll")
    root_angle_deg: float | None = key(CONE_deg, "machine root angle gamma_m", None, "that of the blank")
    machine_centre_to_back_mm: float = key(
        SETTING_mm, "machine centre to back, Delta X_D; positive withdraws the blank along its axis", 0.0
    )
    sliding_base_mm: float = key(
        SETTING_mm, "sliding base Delta X_B; positive moves the blank away from the blade tips", 0.0
    )
    blank_offset_mm: float = key(SETTING_mm, "blank offset Delta E_m; positive upwards", 0.0)
    tilt_deg: float = key(Number(-89.0, 89.0), "cutter tilt i", 0.0)
    swivel_deg: float = key(TURN_deg, "swivel j of the tilt", 0.0)
    ratio_of_roll: float | None = key(
        above_zero(1000.0), "ratio of roll m: turn of the blank over turn of the cradle", None, "required if generated"
    )
    modified_roll_2c: float = key(Number(-100.0, 100.0), "modified roll 2C, per rad", 0.0)
    modified_roll_6d: float = key(Number(-100.0, 100.0), "modified roll 6D, per square rad", 0.0)
    helical_motion_mm_per_rad: float = key(
        SETTING_mm, "helical motion: growth of the sliding base with the turn of the cradle", 0.0
    )
    generation: Literal["generated", "formate"] = key(
        Choice(("generated", "formate")), "whether the blank rolls with the cradle, or stands still", "generated"
    )

    rules: ClassVar[tuple[Rule, ...]] = (
        rule(
            ("ratio_of_roll", "generation"),
            lambda ratio, generation: ratio is not None or generation == "formate",
            'missing; generation = "generated" needs it: turn of the blank over turn of the cradle',
        ),
    )


@dataclass(frozen=True, kw_only=True)
class Blade(Section):
    """[pinion.cutter.concave], [pinion.cutter.convex], and of the wheel."""

    point_radius_mm: float = key(LENGTH_mm, "point radius r_p of the sharp blade tip")
    blade_angle_deg: float = key(BLADE_deg, "blade angle alpha at the tip, before the cutter number corrects it")
    blade_radius_mm: float | None = key(
        above_zero(1e6), "radius of a hollow blade, which crowns the profile of the flank", None, "a straight blade"
    )
    edge_radius_mm: float = key(Number(0.0, 1000.0), "radius of the rounded tip; above it the flank begins", 0.0)


def _in_range_with_number(flank: Literal["concave", "convex"]) -> Rule:
    def complain(number: float, angle: float) -> str | None:
        steep = angle - BLADE_SIGNS[flank] * number * MINUTES_PER_NUMBER / 60.0
        if abs(steep) <= STEEPEST_deg:
            return None
        return f"found {number:g}, which turns {flank}.blade_angle_deg to {steep:g}; allowed up to {STEEPEST_deg:g}"

    return Rule(("number", f"{flank}.blade_angle_deg"), complain)


@dataclass(frozen=True, kw_only=True)
class Cutter(Section):
    """[pinion.cutter], [wheel.cutter]."""

    number: float = key(
        NUMBER,
        "number of the blade group: 10 minutes of blade angle each, less on the outside and more on the inside blade",
        0.0,
    )
    concave: Blade | None = subsection(Blade, "outside blade, which cuts the concave flank", optional=True)
    convex: Blade | None = subsection(Blade, "inside blade, which cuts the convex flank", optional=True)

    rules: ClassVar[tuple[Rule, ...]] = (
        rule(
            ("concave", "convex"),
            lambda *blades: any(blade is not None for blade in blades),
            "missing; a cutter needs a section concave or convex, for the flank in contact (both for whole teeth)",
        ),
        _in_range_with_number("concave"),
        _in_range_with_number("convex"),
    )


@dataclass(frozen=True, kw_only=True)
class GearSection(sections.GearSection):
    """[pinion], [wheel] of face-milled gears."""

    blank: Blank = subsection(Blank, "outline of the blank")
    machine: Machine = subsection(Machine, "machine settings, with the signs of a right-hand gear")
    cutter: Cutter = subsection(Cutter, "the blades, and the number of their group")

    rules: ClassVar[tuple[Rule, ...]] = (below("modifications.end_relief_length_mm", "blank.face_width_mm", 0.5),)
