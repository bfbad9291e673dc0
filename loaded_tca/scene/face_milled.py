"""Scenes of face-milled spiral bevel gears: their sections, and the gears and pairs that follow from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from math import degrees, isclose, radians
from typing import ClassVar

from loaded_tca.errors import require
from loaded_tca.gears import cutter
from loaded_tca.gears.bevel import pitch_angles
from loaded_tca.gears.face_milled import FaceMilledGear, FaceMilledMesh
from loaded_tca.gears.machine_settings import FaceMilledBlank, MachineSettings
from loaded_tca.pairs.bevel import BevelMounting
from loaded_tca.pairs.face_milled import face_milled_pair
from loaded_tca.pairs.gear_pair import GearPair, Sense
from loaded_tca.scene import face_milled_rows
from loaded_tca.scene.blank import opposite_hands
from loaded_tca.scene.build import build_materials, build_modifications, in_base_units
from loaded_tca.scene.face_milled_keys import Blade, Blank, Cutter, GearSection, Geometry, Machine
from loaded_tca.scene.model import Row, Scene, family
from loaded_tca.scene.section import Rule, rule, subsection
from loaded_tca.scene.spiral import (
    AXES_THAT_MEET,
    MountingErrors,
    Side,
    force_rows,
    names_of,
    sense_for,
    sides_in_contact,
)

__all__ = ["Blade", "Blank", "Cutter", "FaceMilledScene", "GearSection", "Geometry", "Machine", "MountingErrors"]

ROUNDED_deg = 0.01
"""By how much a pitch angle may miss the one of teeth and shaft angle: half a minute of arc, as summaries round it."""
SAME_SPHERES = 1e-6
"""Relative difference of two lengths that are meant to be the same."""


def _same_spheres(name: str) -> Rule:
    """Rule: both gears begin or end on the same spheres about the apex."""
    problem = f"found {{0:g}}; allowed pinion.blank.{name} = {{1:g}}: both gears end on the same spheres"
    return rule((f"wheel.blank.{name}", f"pinion.blank.{name}"), partial(isclose, rel_tol=SAME_SPHERES), problem)


def _pitch_cone(member: int, name: str) -> Rule:
    """Rule: a pitch angle is the one at which the pitch cones roll on each other."""

    def complain(angle: float, pinion_teeth: int, wheel_teeth: int, shaft_angle: float) -> str | None:
        rolls = degrees(pitch_angles((pinion_teeth, wheel_teeth), radians(shaft_angle))[member])
        if abs(angle - rolls) <= ROUNDED_deg:
            return None
        return (
            f"found {angle:g}; with {pinion_teeth}/{wheel_teeth} teeth and pair.shaft_angle_deg = {shaft_angle:g} the "
            f"pitch cones roll on each other at {rolls:.6f}, allowed within {ROUNDED_deg:g} of it"
        )

    return Rule((f"{name}.blank.pitch_angle_deg", "pinion.teeth", "wheel.teeth", "pair.shaft_angle_deg"), complain)


@family("face_milled")
@dataclass(frozen=True, kw_only=True)
class FaceMilledScene(Scene):
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
    wheel: GearSection = subsection(GearSection, "its mating gear")
    mounting: MountingErrors = subsection(MountingErrors, "mounting errors")

    rules: ClassVar[tuple[Rule, ...]] = (
        *Scene.rules,
        opposite_hands("blank."),
        _same_spheres("outer_cone_distance_mm"),
        _same_spheres("face_width_mm"),
        _pitch_cone(0, "pinion"),
        _pitch_cone(1, "wheel"),
        AXES_THAT_MEET,
    )

    @property
    def hands(self) -> tuple[str, str]:
        """Hands of pinion and wheel."""
        return self.pinion.blank.hand, self.wheel.blank.hand

    @property
    def _hand_sign(self) -> int:
        return 1 if self.pinion.blank.hand == "right" else -1

    @property
    def sense(self) -> Sense:
        """Sense of rotation, as given, or such that the pinion touches with the flank asked for."""
        wanted = self.geometry
        return wanted.sense or sense_for(wanted.pinion_flank or "concave", self._hand_sign, wanted.driving)

    @property
    def contact_sides(self) -> tuple[Side, Side]:
        """Sides in contact of pinion and wheel: "concave" or "convex"."""
        return self._sides(self.sense)

    def _sides(self, sense: Sense) -> tuple[Side, Side]:
        return sides_in_contact(sense, self._hand_sign, self.geometry.driving)

    @property
    def flank_names(self) -> tuple[str, str]:
        """Gear and side in contact."""
        return names_of(self.contact_sides)

    def mesh(self) -> FaceMilledMesh:
        """Return blanks, machine settings and cutters of both gears."""
        shaft_angle = radians(self.geometry.shaft_angle_deg)
        first, second = pitch_angles((self.pinion.teeth, self.wheel.teeth), shaft_angle)
        return FaceMilledMesh(_gear(self.pinion, "pinion", first), _gear(self.wheel, "wheel", second), shaft_angle)

    def analytic_pair(self, sense: Sense) -> GearPair:
        """Return the two generated flanks in space."""
        sides, mesh = self._sides(sense), self.mesh()
        _require_blades(mesh, sides)
        return face_milled_pair(
            mesh.pinion,
            mesh.wheel,
            pinion_flank=sides[0],
            driving=self.geometry.driving,
            shaft_angle=mesh.shaft_angle,
            modifications=build_modifications(self.pinion, self.wheel),
            mounting=BevelMounting(**in_base_units(self.mounting)),
            materials=build_materials(self.materials),
        )

    def active_starts(self) -> tuple[float, float]:
        """Return the form lines of pinion and wheel, from which their profiles are counted."""
        return 0.0, 0.0

    def geometry_rows(self) -> Sequence[Row]:
        """Return cones, angles of the flanks in contact, machine settings and cutters."""
        mesh = self.mesh()
        _require_blades(mesh, self.contact_sides)
        return face_milled_rows.geometry_rows(mesh, self.contact_sides)

    def force_rows(self, torques: Sequence[float]) -> Sequence[Row]:
        """Return the forces under pinion torques [N mm]."""
        mesh = self.mesh()
        flanks, points = face_milled_rows.flanks_and_points(mesh, self.contact_sides)
        return force_rows(flanks, points, torques)

    def notes(self) -> Sequence[str]:
        """Return what is wrong with the tooth thicknesses, which the analysis does not need."""
        flanks, _ = face_milled_rows.flanks_and_points(self.mesh(), self.contact_sides)
        backlash = face_milled_rows.mean_backlash(flanks)
        if backlash is None or backlash >= 0.0:
            return ()
        return (
            f"at mid-face the teeth are {-backlash:.3f} mm thicker than the spaces, so that whole gears would jam; "
            "backlash does not enter the analysis",
        )


def _gear(own: GearSection, name: str, pitch_angle: float) -> FaceMilledGear:
    """A gear with its exact pitch angle, which rounded root and face angles of uniform teeth may not pass."""
    blank = in_base_units(own.blank)
    machine = {"root_angle": blank["root_angle"], **in_base_units(own.machine)}
    machine["helical_motion"] = machine.pop("helical_motion_mm_per_rad")
    blank["pitch_angle"] = pitch_angle
    blank["root_angle"] = min(blank["root_angle"], pitch_angle)
    blank["face_angle"] = max(blank["face_angle"], pitch_angle)
    concave, convex = (
        None if blade is None else cutter.Blade(**in_base_units(blade))
        for blade in (own.cutter.concave, own.cutter.convex)
    )
    return FaceMilledGear(
        teeth=own.teeth,
        blank=FaceMilledBlank(**blank),
        cutter=cutter.Cutter(concave, convex, own.cutter.number),
        machine=MachineSettings(**machine),
        name=name,
        bore_diameter=own.bore_diameter_mm,
    )


def _require_blades(mesh: FaceMilledMesh, sides: tuple[Side, Side]) -> None:
    """Refuse a pair whose cutters do not cut the flanks that are asked for."""
    for_each = zip(mesh.gears, sides, strict=True)
    message = "{0}.cutter.{1}: missing; it cuts the {1} flank of the {0}, which is asked for"
    require(*((getattr(gear.cutter, side) is not None, message.format(gear.name, side)) for gear, side in for_each))
