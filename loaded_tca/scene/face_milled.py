"""Scenes of face-milled gears: their sections, the gears and pairs that follow, and gears as tables of scene files."""

from __future__ import annotations

import operator
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import cos, degrees, isclose, radians
from typing import Any, ClassVar, Literal

import loaded_tca.warning_kinds as kinds
from loaded_tca.arrays import GEARS
from loaded_tca.errors import InputError, require
from loaded_tca.gears import face_milled
from loaded_tca.gears.bevel import pitch_angles
from loaded_tca.gears.cylindrical_mesh import AT_MID_FACE, Room, interferences
from loaded_tca.gears.face_milled import FaceMilledBlank, FaceMilledGear, FaceMilledMesh, MachineSettings
from loaded_tca.gears.hypoid import HypoidCones
from loaded_tca.pairs.bevel import BevelMounting, face_milled_pair
from loaded_tca.pairs.gear_pair import Driving, GearPair, Sense
from loaded_tca.plain import plain
from loaded_tca.scene import bevel_rows, hypoid, sections, spiral
from loaded_tca.scene.blank import opposite_hands
from loaded_tca.scene.build import build_materials, build_modifications, in_base_units, named_by_keys
from loaded_tca.scene.keys import Choice, Number, above_zero, key
from loaded_tca.scene.model import Hand, Row, Scene
from loaded_tca.scene.parse import family
from loaded_tca.scene.section import Rule, Section, entries, rule, subsection
from loaded_tca.scene.sections import DRIVING, SENSE, Pair, end_reliefs_within
from loaded_tca.scene.spiral import MountingErrors, SpiralScene
from loaded_tca.scene.thickness import MOST_BACKLASH
from loaded_tca.units import factor_of, without_unit

LENGTH_mm = above_zero(10000.0)
SETTING_mm = Number(-10000.0, 10000.0)
CONE_deg = above_zero(179.0)
TURN_deg = Number(-360.0, 360.0)
STEEPEST_deg = 59.0
"""Largest blade angle, corrected by the number of the blade group."""
BLADE_deg = Number(-STEEPEST_deg, STEEPEST_deg)
NUMBER = Number(-200.0, 200.0)
ROUNDED_deg = 0.01
"""By how much a pitch angle may miss the one of teeth and shaft angle: half a minute of arc, as summaries round it."""
SAME_SPHERES = 1e-6
"""Relative difference of two lengths that are meant to be the same."""


@dataclass(frozen=True, kw_only=True)
class Geometry(Pair):
    """[pair] of face-milled gears."""

    type: Literal["face_milled"] = key(Choice(("face_milled",)), "kind of gear pair")
    shaft_angle_deg: float = key(spiral.SHAFT_ANGLE_deg, "shaft angle Sigma", 90.0)
    offset_mm: float = key(
        Number(-1000.0, 1000.0),
        "hypoid offset a; positive: the pinion follows the hand of the wheel, and has the larger spiral angle",
        0.0,
    )
    driving: Driving = key(DRIVING, "the gear that drives", "pinion")
    pinion_flank: spiral.Side | None = key(
        spiral.SIDE, "flank of the pinion that is in contact (drive side: concave)", None, '"concave", or by `sense`'
    )
    sense: Sense | None = key(SENSE, "sense of rotation, instead of `pinion_flank`", None, "by `pinion_flank`")

    rules: ClassVar[tuple[Rule, ...]] = (spiral.FLANK_OR_SENSE,)


@dataclass(frozen=True, kw_only=True)
class Blank(Section):
    """[pinion.blank], [wheel.blank]: where the teeth end."""

    hand: Literal["right", "left"] = key(Choice(("right", "left")), "hand of the spiral")
    outer_cone_distance_mm: float = key(LENGTH_mm, "outer cone distance R_e")
    face_width_mm: float = key(LENGTH_mm, "face width b")
    pitch_angle_deg: float = key(
        CONE_deg,
        "pitch angle delta, which follows from teeth and shaft angle (for a pinion with an offset also from the other "
        "cones); its last digits are corrected",
    )
    face_angle_deg: float = key(CONE_deg, "face angle delta_a")
    root_angle_deg: float = key(CONE_deg, "root angle delta_f")
    face_apex_mm: float = key(
        SETTING_mm,
        "how far the apex of the face cone lies beyond the crossing point of the axes (without an offset the pitch "
        "apex), away from the teeth",
        0.0,
    )
    root_apex_mm: float = key(SETTING_mm, "apex of the root cone, counted like `face_apex_mm`", 0.0)
    calculation_cone_distance_mm: float | None = key(
        LENGTH_mm, "cone distance R_m of the calculation point, where the pitch cones touch", None, "in the middle of b"
    )

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
        hypoid.ON_FACE,
    )


@dataclass(frozen=True, kw_only=True)
class Machine(Section):
    """[pinion.machine], [wheel.machine]: machine settings; both flanks of a gear are cut with them."""

    radial_mm: float = key(LENGTH_mm, "radial setting S_r: cradle axis to cutter centre")
    cradle_angle_deg: float = key(TURN_deg, "cradle angle q at the centre of roll")
    root_angle_deg: float | None = key(CONE_deg, "machine root angle gamma_m", None, "that of the blank")
    machine_centre_to_back_mm: float = key(
        SETTING_mm,
        "machine centre to back, Delta X_D, of the crossing point of the axes; positive withdraws the blank along its "
        "axis",
        0.0,
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
        steep = angle - face_milled.BLADE_SIGNS[flank] * number * face_milled.MINUTES_PER_NUMBER / 60.0
        if abs(steep) <= STEEPEST_deg:
            return None
        return (
            f"found {plain(number, 6)}, which turns {flank}.blade_angle_deg to {plain(steep, 6)}; allowed "
            f"up to {plain(STEEPEST_deg, 6)}"
        )

    return Rule(("number", f"{flank}.blade_angle_deg"), complain)


def _tips_overlap(radius: float, number: float, *blades: Blade | None) -> str | None:
    """What is wrong with two blades of a slot that are rounded over more than its width."""
    outside, inside = (None if blade is None else face_milled.Blade(**in_base_units(blade)) for blade in blades)
    try:
        problem = face_milled.Cutter(outside, inside, number).overlap_of_tips
    except InputError:  # the number turns a blade beyond its range, which a rule of its own refuses
        return None
    if inside is None or problem is None:
        return None
    return f"found {plain(radius, 6)} beside convex.edge_radius_mm = {plain(inside.edge_radius, 6)}; {problem}"


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
        Rule(("concave.edge_radius_mm", "number", "concave", "convex"), _tips_overlap),
    )


@dataclass(frozen=True, kw_only=True)
class GearSection(sections.GearSection):
    """[pinion], [wheel] of face-milled gears."""

    blank: Blank = subsection(Blank, "outline of the blank")
    machine: Machine = subsection(Machine, "machine settings, with the signs of a right-hand gear")
    cutter: Cutter = subsection(Cutter, "the blades, and the number of their group")

    rules: ClassVar[tuple[Rule, ...]] = end_reliefs_within("blank.face_width_mm")


def _same_spheres(name: str) -> Rule:
    """Rule: both gears begin or end on the same spheres about the apex, unless both say that they touch at one R_m."""

    def complain(wheel: float, pinion: float, one: float | None, other: float | None) -> str | None:
        if isclose(wheel, pinion, rel_tol=SAME_SPHERES):
            return None
        if one is not None and other is not None and isclose(one, other, rel_tol=SAME_SPHERES):
            return None
        return (
            f"found {plain(wheel, 6)}; allowed pinion.blank.{name} = {plain(pinion, 6)}: both gears end on "
            "the same spheres"
        )

    point = "blank.calculation_cone_distance_mm"
    return Rule((f"wheel.blank.{name}", f"pinion.blank.{name}", f"wheel.{point}", f"pinion.{point}"), complain)


_SAME_POINT = rule(
    ("wheel.blank.calculation_cone_distance_mm", "pinion.blank.calculation_cone_distance_mm"),
    lambda wheel, pinion: (
        wheel == pinion or (None not in (wheel, pinion) and isclose(wheel, pinion, rel_tol=SAME_SPHERES))
    ),
    "found {0}; allowed pinion.blank.calculation_cone_distance_mm = {1}: without an offset both gears have one R_m",
)


def _pitch_cone(member: int, name: str) -> Rule:
    """Rule: a pitch angle is the one at which the pitch cones roll on each other."""

    def complain(angle: float, pinion_teeth: int, wheel_teeth: int, shaft_angle: float) -> str | None:
        rolls = degrees(pitch_angles((pinion_teeth, wheel_teeth), radians(shaft_angle))[member])
        if abs(angle - rolls) <= ROUNDED_deg:
            return None
        return (
            f"found {plain(angle, 6)}; with {pinion_teeth}/{wheel_teeth} teeth and pair.shaft_angle_deg = "
            f"{plain(shaft_angle, 6)} the pitch cones roll on each other at {rolls:z.6f}, allowed within "
            f"{plain(ROUNDED_deg, 6)} of it"
        )

    return Rule((f"{name}.blank.pitch_angle_deg", "pinion.teeth", "wheel.teeth", "pair.shaft_angle_deg"), complain)


@family("face_milled")
@dataclass(frozen=True, kw_only=True)
class FaceMilledScene(SpiralScene):
    """A scene of two spiral bevel gears whose flanks are cut after machine settings.

    Attributes
    ----------
    geometry : face_milled.Geometry
        Section [pair]: what both gears have in common.
    pinion, wheel : face_milled.GearSection
        Blank, machine settings and cutter of each gear.
    mounting : face_milled.MountingErrors
    title, material, load, analysis
        As for every ``Scene``.

    Examples
    --------
    >>> from pathlib import Path
    >>> from loaded_tca.scene import read_scene
    >>> scene = read_scene("examples/scenes/face_milled_19x62_matched.toml")
    >>> scene.pair()
    GearPair(19/62, module 2.93694 mm, face 36.83 mm)
    >>> scene.contact_sides, scene.sense
    (('concave', 'convex'), 'negative')
    """

    geometry: Geometry = subsection(Geometry, "what both gears have in common", name="pair")
    pinion: GearSection = subsection(GearSection, "the gear that turns about +z")
    wheel: GearSection = subsection(GearSection, "the mating gear of the pinion")
    mounting: MountingErrors = subsection(MountingErrors, "mounting errors")

    rules: ClassVar[tuple[Rule, ...]] = (
        *Scene.rules,
        opposite_hands("blank."),
        hypoid.where_axes_meet(_same_spheres("outer_cone_distance_mm")),
        hypoid.where_axes_meet(_same_spheres("face_width_mm")),
        hypoid.where_axes_meet(_SAME_POINT),
        hypoid.where_axes_meet(_pitch_cone(0, "pinion")),
        hypoid.where_axes_meet(_pitch_cone(1, "wheel")),
        hypoid.CLOSED_AXES,
        spiral.AXES_THAT_MEET,
    )

    usual_flank = "concave"

    @property
    def hands(self) -> tuple[Hand, Hand]:
        """Hands of pinion and wheel."""
        return self.pinion.blank.hand, self.wheel.blank.hand

    @property
    def face_middles(self) -> tuple[float, float]:
        """Axial coordinates of the mean pitch circles of both gears, from the apexes of their pitch cones [mm]."""
        first, second = (gear.blank.mean_cone_distance * cos(gear.blank.pitch_angle) for gear in self.mesh().gears)
        return first, second

    def mesh(self) -> FaceMilledMesh:
        """Return blanks, machine settings and cutters of both gears."""
        return self._mesh

    @cached_property
    @named_by_keys
    def _mesh(self) -> FaceMilledMesh:
        """Both gears, which an overview asks for a dozen times: pitch cones of a hypoid pair are found by iteration."""
        shaft_angle, offset = radians(self.geometry.shaft_angle_deg), self.geometry.offset_mm

        def gears(angles: tuple[float, float]) -> tuple[FaceMilledGear, FaceMilledGear]:
            return _gear(self.pinion, "pinion", angles[0]), _gear(self.wheel, "wheel", angles[1])

        if not offset:
            return FaceMilledMesh(*gears(pitch_angles((self.pinion.teeth, self.wheel.teeth), shaft_angle)), shaft_angle)
        blanks = self.pinion.blank, self.wheel.blank
        first, second = (
            hypoid.mean_distance(one.outer_cone_distance_mm, one.face_width_mm, one.calculation_cone_distance_mm)
            for one in blanks
        )
        angles = radians(blanks[0].pitch_angle_deg), radians(blanks[1].pitch_angle_deg)
        return hypoid.hypoid_mesh(gears, angles, (first, second), offset, shaft_angle)

    def analytic_pair(self, sense: Sense) -> GearPair:
        """Return the two generated flanks in space."""
        sides, mesh = self.sides(sense), self.mesh()
        _require_blades(mesh, sides)
        with hypoid.offset_by_its_key():
            return face_milled_pair(
                mesh.pinion,
                mesh.wheel,
                pinion_flank=sides[0],
                driving=self.geometry.driving,
                shaft_angle=mesh.shaft_angle,
                modifications=build_modifications(self.pinion, self.wheel),
                mounting=BevelMounting(**in_base_units(self.mounting)),
                materials=build_materials(self.materials),
                offset=self.geometry.offset_mm,
            )

    def active_starts(self) -> tuple[float, float]:
        """Return the form lines of pinion and wheel, from which their profiles are counted."""
        return 0.0, 0.0

    def geometry_rows(self) -> Sequence[Row]:
        """Return cones, angles of the flanks in contact, machine settings and cutters."""
        mesh, sides = self.mesh(), self.sides(self.sense)
        _require_blades(mesh, sides)
        return bevel_rows.geometry_rows(mesh, sides)

    def force_rows(self, torques: Sequence[float]) -> Sequence[Row]:
        """Return the forces under pinion torques [N mm]."""
        flanks, points = bevel_rows.flanks_and_points(self.mesh(), self.sides(self.sense))
        return spiral.force_rows(flanks, points, torques)

    def interferences(self) -> Sequence[str]:
        """Return how the whole gears interfere without mounting errors; tips below form lines are those of the path."""
        return interferences(*self._room_and_module, AT_MID_FACE)

    @property
    def _room_and_module(self) -> tuple[Room, float]:
        """Room of the whole gears at mid-face, and the mean normal module [mm]."""
        return bevel_rows.room_and_module(self.mesh(), self.sides(self.sense))

    def missing_shifts(self) -> Sequence[str]:
        """Return a sentence on teeth that are thin beside their spaces."""
        room, module = self._room_and_module
        if room.backlash <= MOST_BACKLASH * module:
            return ()
        return [kinds.WIDE_SPACES.sentence(backlash=room.backlash, modules=room.backlash / module)]


def _gear(own: GearSection, name: str, pitch_angle: float) -> FaceMilledGear:
    """A gear with its exact pitch angle, which rounded root and face angles of uniform teeth may not pass."""
    blank = in_base_units(own.blank)
    machine = {"root_angle": blank["root_angle"], **in_base_units(own.machine)}
    blank["pitch_angle"] = pitch_angle
    blank["root_angle"] = min(blank["root_angle"], pitch_angle)
    blank["face_angle"] = max(blank["face_angle"], pitch_angle)
    concave, convex = (
        None if blade is None else face_milled.Blade(**in_base_units(blade))
        for blade in (own.cutter.concave, own.cutter.convex)
    )
    return FaceMilledGear(
        teeth=own.teeth,
        blank=FaceMilledBlank(**blank),
        cutter=face_milled.Cutter(concave, convex, own.cutter.number),
        machine=MachineSettings(**machine),
        name=name,
        bore_diameter=own.bore_diameter_mm,
    )


def _require_blades(mesh: FaceMilledMesh, sides: tuple[spiral.Side, spiral.Side]) -> None:
    """Refuse a pair whose cutters do not cut the flanks that are asked for."""
    for_each = zip(mesh.gears, sides, strict=True)
    message = "{0}.cutter.{1}: missing; it cuts the {1} flank of the {0}, which is asked for"
    require(*((getattr(gear.cutter, side) is not None, message.format(gear.name, side)) for gear, side in for_each))


DIGITS = 12
"""Decimals of shaft angle and offset, which follow from the cones with a rounding error of some 1e-15."""
DEFAULTS: tuple[Any, ...] = (None, 0.0)
"""Values of keys that a table can leave out."""


def hypoid_table(gears: tuple[FaceMilledGear, FaceMilledGear], cones: HypoidCones) -> dict[str, Any]:
    """Return the sections [pair], [pinion] and [wheel] of a scene of two gears, as :func:`scene_from_table` takes them.

    Parameters
    ----------
    gears : (FaceMilledGear, FaceMilledGear)
        As :func:`loaded_tca.flanks.synthesised_gears` makes them, apexes counted from those of the pitch cones.
    cones : HypoidCones
        On which they stand.

    Examples
    --------
    >>> from math import radians
    >>> from loaded_tca.flanks import synthesised_gears
    >>> from loaded_tca.gears import HypoidBlank, pitch_cones_by_method_1
    >>> pitch_cones = pitch_cones_by_method_1((13, 42), 15.0, 170.0, 30.0, radians(50), 63.5)
    >>> blank = HypoidBlank((13, 42), pitch_cones, 30.0, 63.5, profile_shift=0.3)
    >>> table = hypoid_table(synthesised_gears(blank), blank.cones)
    >>> round(table["pair"]["offset_mm"], 9), round(table["wheel"]["blank"]["face_apex_mm"], 4)
    (15.0, 1.8052)
    """
    axes = {"shaft_angle_deg": degrees(cones.shaft_angle), "offset_mm": cones.offset}
    pair = {"type": "face_milled"} | {key: round(value, DIGITS) for key, value in axes.items()}
    sections = (_gear_table(gear, beyond) for gear, beyond in zip(gears, cones.apexes, strict=True))
    return {"pair": pair} | dict(zip(GEARS, sections, strict=True))


def _gear_table(gear: FaceMilledGear, beyond: float) -> dict[str, Any]:
    """A gear as a section of a scene, apexes and machine centre to back counted from the crossing point."""
    blank = replace(gear.blank, face_apex=gear.blank.face_apex + beyond, root_apex=gear.blank.root_apex + beyond)
    back = gear.machine.machine_centre_to_back + beyond
    cutter: dict[str, Any] = {"number": gear.cutter.number}
    for flank in ("concave", "convex"):
        if (blade := getattr(gear.cutter, flank)) is not None:
            cutter[flank] = _keys(blade, Blade)
    return {
        "teeth": gear.teeth,
        "blank": _keys(blank, Blank),
        "machine": _keys(replace(gear.machine, machine_centre_to_back=back), Machine),
        "cutter": cutter,
    }


def _keys(values: Any, section: type[Section]) -> dict[str, Any]:
    """Values of a dataclass by the keys of a section, in its units."""
    table = {}
    for name, (_, entry) in entries(section).items():
        value = getattr(values, without_unit(name))
        if value not in DEFAULTS or getattr(entry, "required", False):
            table[name] = value if isinstance(value, str) else value * factor_of(name)
    return table
