"""Scenes of straight and spiral bevel gears: their sections, and the gears and pairs that follow from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

from loaded_tca.gears.bevel import BevelGear, BevelMesh, pitch_angles
from loaded_tca.pairs.bevel import BevelMounting, bevel_pair
from loaded_tca.pairs.gear_pair import GearPair, Sense
from loaded_tca.scene import bevel_rows
from loaded_tca.scene.blank import BlankGearSection, BlankScene
from loaded_tca.scene.build import build_materials, build_modifications, in_base_units
from loaded_tca.scene.keys import Choice, Number, above_zero, key
from loaded_tca.scene.model import Row, family
from loaded_tca.scene.section import Rule, subsection
from loaded_tca.scene.sections import DRIVING, SENSE, Pair
from loaded_tca.scene.spiral import (
    AXES_THAT_MEET,
    FLANK_OR_SENSE,
    SIDE,
    MountingErrors,
    SHAFT_ANGLE_deg,
    Side,
    names_of,
    sense_for,
    sides_in_contact,
)

SPIRAL_deg = Number(0.0, 59.0)
CONE_deg = above_zero(179.0)


def _spiral_of_the_type(spiral: float | None, kind: str) -> str | None:
    if kind == "straight_bevel" and spiral:
        return f'found {spiral:g}; allowed 0 for a "straight_bevel" pair; another angle makes it a "spiral_bevel" one'
    if kind == "spiral_bevel" and spiral is None:
        return f'missing; a "spiral_bevel" pair needs it, {SPIRAL_deg.low:g} to {SPIRAL_deg.high:g}'
    return None


def _flank_of_a_spiral(flank: str | None, kind: str) -> str | None:
    if flank is None or kind == "spiral_bevel":
        return None
    return f'found "{flank}", but flanks of straight teeth are neither; give sense instead'


def _one_face_width(wheel: float, pinion: float) -> str | None:
    if wheel == pinion:
        return None
    return f"found {wheel:g}; allowed pinion.face_width_mm = {pinion:g}: both gears end on the same spheres"


@dataclass(frozen=True, kw_only=True)
class Geometry(Pair):
    """[pair] of straight and spiral bevel gears."""

    type: Literal["straight_bevel", "spiral_bevel"] = key(
        Choice(("straight_bevel", "spiral_bevel")), "kind of gear pair"
    )
    outer_module_mm: float = key(above_zero(1000.0), "outer transverse module m_et, at the heel")
    shaft_angle_deg: float = key(SHAFT_ANGLE_deg, "shaft angle Sigma", 90.0)
    spiral_angle_deg: float | None = key(
        SPIRAL_deg,
        "mean spiral angle beta_m on the pitch cone; its sign is in `pinion.hand`",
        None,
        "0; required for `spiral_bevel`",
    )
    pressure_angle_deg: float = key(Number(1.0, 44.0), "transverse pressure angle alpha on the pitch cone", 20.0)
    driving: Literal["pinion", "wheel"] = key(DRIVING, "the gear that drives", "pinion")
    sense: Sense | None = key(
        SENSE,
        "sense of rotation; negative: the pinion turns the other way and pushes with its other flank",
        None,
        '"positive", or what `pinion_flank` asks for',
    )
    pinion_flank: Side | None = key(
        SIDE,
        "flank of a spiral pinion that is in contact, instead of `sense`",
        None,
        "by `sense`",
    )

    rules: ClassVar[tuple[Rule, ...]] = (
        Rule(("spiral_angle_deg", "type"), _spiral_of_the_type),
        Rule(("pinion_flank", "type"), _flank_of_a_spiral),
        FLANK_OR_SENSE,
    )


@dataclass(frozen=True, kw_only=True)
class GearSection(BlankGearSection):
    """[pinion], [wheel] of bevel gears."""

    face_angle_deg: float | None = key(CONE_deg, "face angle delta_a", None, "pitch angle + atan((1 + x) m_et/R_e)")
    root_angle_deg: float | None = key(CONE_deg, "root angle delta_f", None, "pitch angle - atan((1.25 - x) m_et/R_e)")


@family
@dataclass(frozen=True, kw_only=True)
class BevelScene(BlankScene):
    """A scene of two straight or spiral bevel gears with spherical involute flanks.

    Attributes
    ----------
    geometry : bevel.Geometry
        Section [pair]: what both gears have in common.
    pinion, wheel : bevel.GearSection
    mounting : bevel.MountingErrors
    title, material, load, analysis
        As for every ``Scene``.

    Examples
    --------
    >>> from loaded_tca.scene import ElasticMaterial, Load
    >>> scene = BevelScene(
    ...     geometry=Geometry(type="spiral_bevel", outer_module_mm=4.0, spiral_angle_deg=35.0),
    ...     pinion=GearSection(teeth=20, face_width_mm=20.0, hand="left"),
    ...     wheel=GearSection(teeth=40, face_width_mm=20.0),
    ...     material=ElasticMaterial(youngs_modulus_MPa=206000.0, poisson_ratio=0.3),
    ...     load=Load(pinion_torque_Nm=100.0),
    ... )
    >>> scene.pair()
    GearPair(20/40, module 2.91027 mm, face 20 mm)
    >>> scene.sense, scene.with_changes({"pair.pinion_flank": "concave"}).sense
    ('positive', 'negative')
    """

    geometry: Geometry = subsection(Geometry, "what both gears have in common", name="pair")
    pinion: GearSection = subsection(GearSection, "the gear that turns about +z")
    wheel: GearSection = subsection(GearSection, "its mating gear")
    mounting: MountingErrors = subsection(MountingErrors, "mounting errors")

    rules: ClassVar[tuple[Rule, ...]] = (
        *BlankScene.rules,
        Rule(("wheel.face_width_mm", "pinion.face_width_mm"), _one_face_width),
        AXES_THAT_MEET,
    )

    @property
    def sense(self) -> Sense:
        """Sense of rotation, as given, or such that the pinion touches with the flank asked for."""
        wanted = self.geometry
        if wanted.pinion_flank is None:
            return wanted.sense or "positive"
        return sense_for(wanted.pinion_flank, self.hand_signs[0], wanted.driving)

    @property
    def contact_sides(self) -> tuple[str, str]:
        """Sides in contact of pinion and wheel: "concave" or "convex", "straight" without a spiral."""
        if not self.geometry.spiral_angle_deg:
            return "straight", "straight"
        return sides_in_contact(self.sense, self.hand_signs[0], self.geometry.driving)

    @property
    def flank_names(self) -> tuple[str, str]:
        """Gear and side in contact."""
        return names_of(self.contact_sides)

    def mesh(self) -> BevelMesh:
        """Return the macro geometry: cones, cone distances, contact ratios."""
        return BevelMesh(self._gear(0), self._gear(1))

    def _gear(self, member: int) -> BevelGear:
        common, own = in_base_units(self.geometry), in_base_units((self.pinion, self.wheel)[member])
        teeth = (self.pinion.teeth, self.wheel.teeth)
        return BevelGear(
            teeth=teeth[member],
            outer_module=common["outer_module"],
            face_width=own["face_width"],
            pitch_angle=pitch_angles(teeth, common["shaft_angle"])[member],
            pressure_angle=common["pressure_angle"],
            spiral_angle=self.hand_signs[member] * common.get("spiral_angle", 0.0),
            profile_shift=own["profile_shift"],
            face_angle=own.get("face_angle"),
            root_angle=own.get("root_angle"),
            bore_diameter=own.get("bore_diameter"),
            name=("pinion", "wheel")[member],
        )

    def analytic_pair(self, sense: Sense) -> GearPair:
        """Return the two spherical involute flanks in space."""
        return bevel_pair(
            self.mesh(),
            modifications=build_modifications(self.pinion, self.wheel),
            mounting=BevelMounting(**in_base_units(self.mounting)),
            materials=build_materials(self.materials),
            driving=self.geometry.driving,
            sense=sense,
        )

    def active_starts(self) -> tuple[float, float]:
        """Return the unwound arcs at which the active profiles of pinion and wheel start [rad]."""
        mesh = self.mesh()
        (pinion, _), (wheel, _) = mesh.active_cones
        return mesh.pinion.unwound_arc(pinion), mesh.wheel.unwound_arc(wheel)

    def geometry_rows(self) -> Sequence[Row]:
        """Return cones, cone distances, modules and contact ratios."""
        return bevel_rows.geometry_rows(self.mesh(), self.hands, self.contact_sides)

    def force_rows(self, torques: Sequence[float]) -> Sequence[Row]:
        """Return the forces under pinion torques [N mm]."""
        mesh = self.mesh()
        pair = self.analytic_pair(self.sense)
        points = [
            bevel_rows.pitch_point(gear.mean_cone_distance, gear.pitch_angle) for gear in (mesh.pinion, mesh.wheel)
        ]
        flanks = pair.pinion.nominal_flank, pair.wheel.nominal_flank
        return bevel_rows.force_rows(flanks, (points[0], points[1]), torques)
