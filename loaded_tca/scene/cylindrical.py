"""Scenes of two cylindrical gears: their sections, and the gears and pairs that follow from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.pairs.cylindrical import Mounting, cylindrical_pair
from loaded_tca.pairs.gear_pair import GearPair, Sense
from loaded_tca.scene import cylindrical_rows
from loaded_tca.scene.blank import BlankGearSection, BlankScene
from loaded_tca.scene.build import build_materials, build_modifications, in_base_units
from loaded_tca.scene.keys import Choice, Number, above_zero, key
from loaded_tca.scene.model import Row, family
from loaded_tca.scene.section import Rule, Section, subsection
from loaded_tca.scene.sections import DRIVING, SENSE, DIAMETER_mm, ERROR_deg, ERROR_mm, Pair, below


@dataclass(frozen=True, kw_only=True)
class Geometry(Pair):
    """[pair] of cylindrical gears."""

    type: Literal["cylindrical"] = key(Choice(("cylindrical",)), "kind of gear pair")
    normal_module_mm: float = key(above_zero(1000.0), "normal module m_n")
    pressure_angle_deg: float = key(Number(1.0, 44.0), "normal pressure angle alpha_n", 20.0)
    helix_angle_deg: float = key(
        Number(0.0, 59.0), "helix angle beta at the reference circle; its sign is in `pinion.hand`", 0.0
    )
    centre_distance_mm: float | None = key(
        DIAMETER_mm, "working centre distance a", None, "follows from the profile shifts, without backlash"
    )
    driving: Literal["pinion", "wheel"] = key(DRIVING, "the gear that drives", "pinion")
    sense: Literal["positive", "negative"] = key(
        SENSE, "sense of rotation; negative: the pinion turns the other way and pushes with its other flank", "positive"
    )
    dedendum_coefficient: float = key(
        above_zero(5.0), "dedendum of the basic rack (ISO 53 profile A) in modules, h_fP/m_n", 1.25
    )
    root_radius_coefficient: float = key(Number(0.0, 1.0), "root radius of the basic rack in modules, rho_fP/m_n", 0.38)


@dataclass(frozen=True, kw_only=True)
class GearSection(BlankGearSection):
    """[pinion], [wheel] of cylindrical gears."""

    tip_diameter_mm: float | None = key(DIAMETER_mm, "tip diameter d_a", None, "d + 2 m_n (1 + x)")

    rules: ClassVar[tuple[Rule, ...]] = (
        *BlankGearSection.rules,
        below("bore_diameter_mm", "tip_diameter_mm"),
        below("modifications.tip_relief_start_mm", "tip_diameter_mm"),
        below("modifications.root_relief_start_mm", "tip_diameter_mm"),
    )


@dataclass(frozen=True, kw_only=True)
class MountingErrors(Section):
    """[mounting] of parallel axes: how the wheel is displaced from its nominal place."""

    in_plane_deg: float = key(ERROR_deg, "axis error in the plane of the axes; positive: the axes part at z > 0", 0.0)
    out_of_plane_deg: float = key(
        ERROR_deg,
        "axis error across that plane; positive: at z > 0 the wheel moves against the driving flank",
        0.0,
    )
    centre_distance_error_mm: float = key(ERROR_mm, "centre distance error; positive: apart", 0.0)
    axial_offset_mm: float = key(ERROR_mm, "axial displacement of the wheel, positive towards +z", 0.0)


@family
@dataclass(frozen=True, kw_only=True)
class CylindricalScene(BlankScene):
    """A scene of two spur or helical gears.

    Attributes
    ----------
    geometry : cylindrical.Geometry
        Section [pair]: what both gears have in common.
    pinion, wheel : cylindrical.GearSection
    mounting : cylindrical.MountingErrors
    title, material, load, analysis
        As for every ``Scene``.

    Examples
    --------
    >>> from loaded_tca.scene import ElasticMaterial, Load
    >>> scene = CylindricalScene(
    ...     geometry=Geometry(type="cylindrical", normal_module_mm=3.0),
    ...     pinion=GearSection(teeth=34, face_width_mm=25.0),
    ...     wheel=GearSection(teeth=57, face_width_mm=25.0),
    ...     material=ElasticMaterial(youngs_modulus_MPa=206000.0, poisson_ratio=0.3),
    ...     load=Load(pinion_torque_Nm=130.0),
    ... )
    >>> scene.pair()
    GearPair(34/57, module 3 mm, face 25 mm)
    >>> scene.with_changes({"pinion.teeth": 21}).pair()
    GearPair(21/57, module 3 mm, face 25 mm)
    """

    geometry: Geometry = subsection(Geometry, "what both gears have in common", name="pair")
    pinion: GearSection = subsection(GearSection, "the gear that turns about +z")
    wheel: GearSection = subsection(GearSection, "its mating gear")
    mounting: MountingErrors = subsection(MountingErrors, "mounting errors")

    def mesh(self) -> CylindricalMesh:
        """Return the macro geometry: diameters, contact ratios, path of contact."""
        pinion, wheel = self._gear(0), self._gear(1)
        return CylindricalMesh(pinion, wheel, centre_distance=self.geometry.centre_distance_mm)

    def _gear(self, member: int) -> CylindricalGear:
        common, own = in_base_units(self.geometry), in_base_units((self.pinion, self.wheel)[member])
        rack = ("normal_module", "pressure_angle", "dedendum_coefficient", "root_radius_coefficient")
        sizes = ("teeth", "face_width", "profile_shift", "tip_diameter", "bore_diameter")
        return CylindricalGear(
            **{name: common[name] for name in rack},
            **{name: own[name] for name in sizes if name in own},
            helix_angle=self.hand_signs[member] * common["helix_angle"],
            name=("pinion", "wheel")[member],
        )

    @property
    def sense(self) -> Sense:
        """Sense of rotation."""
        return self.geometry.sense

    def analytic_pair(self, sense: Sense) -> GearPair:
        """Return the two involute flanks in space."""
        return cylindrical_pair(
            self.mesh(),
            modifications=build_modifications(self.pinion, self.wheel),
            mounting=Mounting(**in_base_units(self.mounting)),
            materials=build_materials(self.materials),
            driving=self.geometry.driving,
            sense=sense,
        )

    def active_starts(self) -> tuple[float, float]:
        """Return the roll lengths at which the active profiles of pinion and wheel start [mm]."""
        mesh = self.mesh()
        return mesh.pinion_active_profile.start_roll_length, mesh.wheel_active_profile.start_roll_length

    def geometry_rows(self) -> Sequence[Row]:
        """Return centre distance, contact ratios and diameters."""
        return cylindrical_rows.geometry_rows(self.mesh(), self.hands)

    def force_rows(self, torques: Sequence[float]) -> Sequence[Row]:
        """Return the forces under pinion torques [N mm]."""
        return cylindrical_rows.force_rows(self.mesh(), torques)

    def notes(self) -> Sequence[str]:
        """Return sentences on teeth that overlap."""
        return tuple(cylindrical_rows.overlaps(self.mesh(), self.mounting.centre_distance_error_mm))
