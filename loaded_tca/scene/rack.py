"""Scenes of a pinion and a rack: type "cylindrical" with ``teeth = "rack"`` of the wheel."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar, Literal

from loaded_tca.errors import InputError, require
from loaded_tca.flanks.modification import FlankModifications
from loaded_tca.gears.cylindrical import CylindricalGear
from loaded_tca.gears.cylindrical_mesh import ROUNDING, CylindricalMesh, interferences
from loaded_tca.gears.rack import Rack, rack_mesh
from loaded_tca.gears.undercut import undercut_sentences
from loaded_tca.pairs.gear_pair import GearPair, Sense
from loaded_tca.pairs.rack import rack_pair
from loaded_tca.plain import plain
from loaded_tca.scene.blank import BlankGearSection, opposite_hands
from loaded_tca.scene.build import build_materials, build_modifications, named_by_keys, parameters_of
from loaded_tca.scene.cylindrical import CylindricalScene, GearSection, Geometry, MountingErrors, backlash_rows
from loaded_tca.scene.keys import Choice, Number, above_zero, key
from loaded_tca.scene.model import Row, Scene
from loaded_tca.scene.parse import variant
from loaded_tca.scene.pitch import REVOLUTION_RULES
from loaded_tca.scene.rows import Label, fixed
from loaded_tca.scene.section import Rule, refusal, rule, subsection
from loaded_tca.scene.sections import SLOPE_um
from loaded_tca.scene.thickness import gear_of
from loaded_tca.scene.tools import odd_teeth

LENGTH_mm = above_zero(100000.0)


def _none(key_name: str, why: str) -> Rule:
    """Rule: a key that a rack has no use for is not given."""
    return refusal(key_name, f"found; a rack has none: {why}")


def _needs_length(length: float | None, rating: object) -> str | None:
    """What is wrong with the rating of a rack whose teeth are not counted."""
    if rating is None or length is not None:
        return None
    return "missing; [rating] needs this length: the load cycles of a rack tooth are strokes over it"


@dataclass(frozen=True, kw_only=True)
class RackGeometry(Geometry):
    """[pair] of a pinion and a rack."""

    distance_mm: float | None = key(
        Number(-100000.0, 100000.0),
        "distance of the pinion's axis from the reference line of the rack",
        None,
        "r_1 + x_1 m_n, without backlash",
    )

    rules: ClassVar[tuple[Rule, ...]] = (
        *Geometry.rules,
        refusal(
            "centre_distance_mm",
            "found {0:g}; a rack has no axis: give distance_mm, from the pinion axis to the reference line",
        ),
    )


@dataclass(frozen=True, kw_only=True)
class RackSection(BlankGearSection):
    """[wheel] of a pinion and a rack."""

    teeth: Literal["rack"] = key(Choice(("rack",)), "no wheel: a rack")  # type: ignore[assignment]
    height_mm: float = key(LENGTH_mm, "height of the reference line above the bed, which is held rigid")
    length_mm: float | None = key(LENGTH_mm, "length of the toothed part along the travel", None, "as long as needed")
    addendum_mm: float | None = key(LENGTH_mm, "height of the tip line above the reference line", None, "m_n")
    profile_shift: float | None = key(  # type: ignore[assignment]
        Number(-5.0, 5.0), "none; `pair.distance_mm` says where the reference line lies", None, "none"
    )
    thickness_allowance_um: float | None = key(
        SLOPE_um,
        "allowance A_sn of the tooth thickness in the normal section at the reference line, negative for thinner "
        "teeth, up to half a module; the root line follows from it",
        None,
        "0",
    )

    rules: ClassVar[tuple[Rule, ...]] = (
        *BlankGearSection.rules,
        _none("profile_shift", "give pair.distance_mm"),
        _none("bore_diameter_mm", "its bed is held: give height_mm"),
        _none("shaft", "its bed is held"),
        _none("support", "its bed is held"),
        _none("pitch", "whole revolutions are those of gears"),
        _none("tooth", "whole revolutions are those of gears"),
        rule(
            ("flank.form",),
            lambda form: form == "analytic",
            'found "{0}"; allowed "analytic": files of points have the coordinates of gears about an axis',
        ),
        *(
            rule(
                (f"modifications.{relief}_relief_start_{name}",),
                lambda value: value == 0.0,
                f"found {{0:g}}; a rack has no axis: give {relief}_relief_start_mm, which counts from its tip line",
            )
            for relief in ("tip", "root")
            for name in ("roll_deg", "length_mm")
        ),
    )


@variant('a pinion and a rack: `wheel.teeth` is `"rack"`')
@dataclass(frozen=True, kw_only=True)
class RackScene(CylindricalScene):
    """A scene of a pinion and a rack, which is the wheel.

    Attributes
    ----------
    geometry : rack.RackGeometry
    pinion : cylindrical.GearSection
    wheel : rack.RackSection
    mounting : cylindrical.MountingErrors
    title, material, load, analysis
        As for every ``Scene``.

    Examples
    --------
    >>> from loaded_tca.scene import ElasticMaterial, Load
    >>> scene = RackScene(
    ...     geometry=RackGeometry(type="cylindrical", normal_module_mm=3.0),
    ...     pinion=GearSection(teeth=20, face_width_mm=25.0),
    ...     wheel=RackSection(teeth="rack", face_width_mm=25.0, height_mm=20.0),
    ...     material=ElasticMaterial(youngs_modulus_MPa=206000.0, poisson_ratio=0.3),
    ...     load=Load(pinion_torque_Nm=130.0),
    ... )
    >>> round(scene.mesh().transverse_contact_ratio, 4)
    1.7688
    """

    geometry: RackGeometry = subsection(RackGeometry, "what pinion and rack have in common", name="pair")
    pinion: GearSection = subsection(GearSection, "the gear that turns about +z")
    wheel: RackSection = subsection(RackSection, "the rack")  # type: ignore[assignment]
    mounting: MountingErrors = subsection(MountingErrors, "mounting errors")

    rules: ClassVar[tuple[Rule, ...]] = (
        *(demand for demand in Scene.rules if demand not in REVOLUTION_RULES),
        opposite_hands(),
        Rule(("wheel.length_mm", "rating"), _needs_length),
        rule(
            ("rating.tolerance_class",),
            lambda given: given is None,
            "found {0}; not allowed with a rack, of which ISO 1328-1 has no classes: give rating.dynamic_factor = "
            '"given" and rating.transverse_load_factor = "analysis" or a number',
        ),
        *(
            rule(
                (name,),
                lambda value: value is None or value == (),
                "found; not allowed with a rack: whole revolutions need a wheel with teeth all around",
            )
            for name in ("revolution", "pinion.pitch", "pinion.tooth")
        ),
    )

    @cached_property
    @named_by_keys
    def rack(self) -> Rack:
        """The rack."""
        values = parameters_of(Rack, self.geometry, self.wheel)
        values["helix_angle"] *= self.hand_signs[1]
        return Rack(**values, name="wheel")

    @property
    def rack_radius(self) -> float:
        """What turns rotations of the gear that stands for the rack into travels [mm]."""
        return self.rack.radius

    @cached_property
    @named_by_keys
    def _gear(self) -> CylindricalGear:
        """The pinion; where the distance is given and its profile shift is not, with what leaves no backlash."""
        values = parameters_of(CylindricalGear, self.geometry, self.pinion)
        values["helix_angle"] *= self.hand_signs[0]
        values["profile_shift"] = self.pinion.profile_shift or 0.0
        distance = self.geometry.distance_mm
        if distance is not None and self.pinion.profile_shift is None:
            module = self.geometry.normal_module_mm
            reference_radius = 0.5 * self.pinion.teeth * module / math.cos(values["helix_angle"])
            values["profile_shift"] = (distance - reference_radius) / module
        return gear_of({**values, "name": "pinion"}, self.pinion)

    @cached_property
    @named_by_keys
    def _mesh(self) -> CylindricalMesh:
        """The mesh of the pinion and the gear that stands for the rack."""
        return rack_mesh(self._gear, self.rack, self.geometry.distance_mm, self.mounting.axial_offset_mm)

    @property
    def distance(self) -> float:
        """Distance of the pinion's axis from the reference line, without mounting errors [mm]."""
        return self.mesh().working_centre_distance - self.rack.radius

    def analytic_pair(self, sense: Sense) -> GearPair:
        """Return the two flanks in space."""
        mesh = self.mesh()
        first, second = build_modifications(self.pinion, self.wheel)
        return rack_pair(
            self._gear,
            self.rack,
            self.geometry.distance_mm,
            modifications=(first, self._from_axis(second)),
            mounting=replace(self._mounting(mesh), axial_offset=self.mounting.axial_offset_mm),
            materials=build_materials(self.materials),
            driving=self.geometry.driving,
            sense=sense,
        )

    def _from_axis(self, modifications: FlankModifications) -> FlankModifications:
        """Modifications whose reliefs start at diameters of the gear that stands for the rack, not below its tip."""
        active = self.mesh().wheel_active_profile
        most = active.end_radius - active.start_radius
        starts = {}
        for relief in ("tip_relief_start", "root_relief_start"):
            below = getattr(modifications, relief)
            if below:
                require(
                    (
                        below < most,
                        f"wheel.modifications.{relief}_mm: found {plain(below, 6)}; allowed below {most:.4f}, the "
                        "height of the active profile: it counts from the tip line",
                    )
                )
                starts[relief] = 2.0 * (active.end_radius - below)
        return replace(modifications, **starts)

    def pitch_tolerances(self, gear: int, tolerance_class: int) -> tuple[float, float]:  # noqa: ARG002 (none)
        """Refuse: ISO 1328-1 has no tolerances of racks."""
        raise InputError('wheel.teeth: found "rack"; ISO 1328-1 has tolerances of gears alone')

    def slope_tolerances(self, tolerance_class: int) -> Mapping[str, float]:  # noqa: ARG002 (there are none)
        """Refuse: ISO 1328-1 has no tolerances of racks."""
        raise InputError('wheel.teeth: found "rack"; ISO 1328-1 has tolerances of gears alone')

    def require_turns(self, where: str) -> None:
        """Refuse what needs whole turns of both gears, said in words."""
        raise InputError(f'wheel.teeth: found "rack"; allowed a number of teeth in {where}')

    @property
    def wheel_cycles(self) -> float:
        """Load cycles of a tooth of the rack per turn of the pinion: part of a stroke over the whole length."""
        assert self.wheel.length_mm is not None  # refused before
        return self.pinion.teeth * self.rack.pitch / self.wheel.length_mm

    @property
    def gear_names(self) -> tuple[str, str]:
        """Names of pinion and wheel in pictures."""
        return "pinion", "rack"

    def held_row(self, pair: GearPair) -> Row:
        """Return what is held rigid where teeth bend."""
        held = fixed(pair.rigid_bores[0], 4), fixed(self.rack.bed_depth, 4)
        return Label(
            "bore of the pinion, bed below the rack's root line [mm]",
            "held_rigid_mm",
            "bore_of_the_pinion",
            "bed_below_the_root_line_of_the_rack",
        ), *held

    def geometry_rows(self) -> Sequence[Row]:
        """Return distance, contact ratios, diameters of the pinion, heights of the rack."""
        mesh, rack = self.mesh(), self.rack
        pinion, path, active = mesh.pinion, mesh.path_of_contact, mesh.wheel_active_profile
        diameters = {
            "reference diameter d [mm]": pinion.reference_radius,
            "base diameter d_b [mm]": pinion.base_radius,
            "tip diameter d_a [mm]": pinion.tip_radius,
            "start of active profile d_Nf [mm]": mesh.pinion_active_profile.start_radius,
            "end of active profile d_Na [mm]": pinion.radius_at_roll_length(path.E),
            "root form diameter d_Ff [mm]": pinion.form_radius,
            "root diameter d_f [mm]": pinion.root_radius,
        }
        heights = {
            "tip line": rack.gear.tip_radius,
            "start of active profile": active.start_radius,
            "root form line": rack.gear.form_radius,
            "root line": rack.gear.root_radius,
        }
        length = () if rack.length is None else (("length of the rack [pitches]", fixed(rack.length / rack.pitch, 4)),)
        return [
            ("distance of pinion's axis and reference line [mm]", fixed(self.distance, 4)),
            ("transverse pressure angle alpha_t [deg]", fixed(math.degrees(pinion.transverse_pressure_angle), 4)),
            ("base helix angle beta_b [deg]", fixed(abs(math.degrees(pinion.base_helix_angle)), 4)),
            *backlash_rows(mesh),
            ("transverse contact ratio eps_alpha", fixed(mesh.transverse_contact_ratio, 4)),
            ("overlap ratio eps_beta", fixed(mesh.overlap_ratio, 4)),
            ("total contact ratio eps_gamma", fixed(mesh.total_contact_ratio, 4)),
            (
                Label("path of contact: length AE, approach AC [mm]", "path_of_contact_mm", "length_AE", "approach_AC"),
                fixed(path.AE, 4),
                fixed(path.AC, 4),
            ),
            ("common face width b [mm]", fixed(mesh.common_face_width, 4)),
            ("travel of the rack per turn of the pinion [mm]", fixed(pinion.teeth * rack.pitch, 4)),
            ("transverse pitch of the rack [mm]", fixed(rack.pitch, 4)),
            *length,
            ("", "pinion"),
            ("teeth z", f"{pinion.teeth}"),
            ("profile shift x", fixed(pinion.profile_shift, 4)),
            ("hand of the helix: pinion, rack", *(self.hands if pinion.helix_angle else ("none", "none"))),
            *((label, fixed(2.0 * radius, 4)) for label, radius in diameters.items()),
            ("", "above the rack's reference line [mm]"),
            *((label, fixed(radius - rack.radius, 4)) for label, radius in heights.items()),
            ("", "pinion", "rack"),
            ("tip clearance of the mating teeth c [mm]", *(fixed(clearance, 4) for clearance in mesh.tip_clearances)),
        ]

    def force_rows(self, torques: Sequence[float]) -> Sequence[Row]:
        """Return the forces under pinion torques [N mm]."""
        radius = self.mesh().pinion.reference_radius
        forces = (fixed(torque / radius, 1) for torque in torques)
        return [*super().force_rows(torques), ("force along the rack, without friction [N]", *forces)]

    def missing_shifts(self) -> Sequence[str]:
        """Return a sentence where the teeth of the pinion look as if their profile shift were not given."""
        return odd_teeth(self._gear, self.pinion, follows=self.geometry.distance_mm is not None)

    def interferences(self) -> Sequence[str]:
        """Return how pinion and rack interfere at their distance, its error included, and what an undercut takes."""
        mesh, error = self.mesh(), self.mounting.centre_distance_error_mm
        module = mesh.pinion.normal_module
        place = f"at the {'mounted ' if error else ''}distance of {self.distance + error:z.4f} mm"
        nominal = abs(mesh.backlash) <= ROUNDING * module
        mounted = rack_mesh(self._gear, self.rack, self.distance + error, mesh.axial_offset) if error else mesh
        jams = interferences(mounted.room, module, place, nominal=nominal)
        return [*jams, *undercut_sentences(mounted, place, self.gear_names)]
