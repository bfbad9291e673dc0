"""Teeth of straight and spiral bevel gears."""

from __future__ import annotations

from dataclasses import dataclass, replace

from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.bevel import SphericalInvoluteFlank
from loaded_tca.flanks.modification import FlankModifications, modified
from loaded_tca.gears import BevelGear
from loaded_tca.tooth.fillet import ArcFillet
from loaded_tca.tooth.form import RootCone, ToothForm
from loaded_tca.tooth.geometry import ToothGeometry
from loaded_tca.tooth.sections import ApexSpheres

FILLET_RADIUS_COEFFICIENT = 0.38
"""Radius of the fillet of bevel gears in mean normal modules, as that of the basic rack of ISO 53, profile A."""


@dataclass(frozen=True)
class BevelTooth(ToothGeometry):
    """Spherical involute teeth of a bevel gear, with arcs as fillets.

    Parameters
    ----------
    gear : BevelGear
    active : (float, float) [rad]
        Cone angles between which profile modifications run.
    modifications : FlankModifications
    """

    gear: BevelGear
    active: tuple[float, float]
    modifications: FlankModifications = FlankModifications()

    @property
    def unmodified(self) -> ToothGeometry:
        """The same teeth without modifications."""
        return replace(self, modifications=FlankModifications())

    def nominal(self, side: int) -> Flank:
        """Spherical involute flank of a side."""
        gear = self.gear
        return SphericalInvoluteFlank(
            gear.pitch_angle,
            gear.pressure_angle,
            gear.spiral_angle,
            side,
            (gear.form_angle, gear.tip_angle),
            (gear.inner_cone_distance, gear.outer_cone_distance),
        )

    def modified(self, nominal: Flank) -> Flank:
        """The flank with its modifications; profile modifications run over the unwound arc."""
        gear = self.gear
        return modified(
            nominal,
            self.modifications,
            gear.face_width,
            (gear.diameter_at(self.active[0]), gear.diameter_at(self.active[1])),
            lambda diameter: gear.unwound_arc(gear.cone_angle_at_diameter(diameter)),
            owner=gear.name,
        )

    def form(self) -> ToothForm:
        """Spheres about the apex, root cone, and arcs of 0.38 mean normal modules or the largest that fit."""
        gear = self.gear
        fillet = ArcFillet(FILLET_RADIUS_COEFFICIENT * gear.mean_normal_module, gear.mean_cone_distance)
        root = RootCone(gear.root_cone_angle)
        return ToothForm(gear.teeth, gear.half_thickness_angle, ApexSpheres(), root, fillet, largest_that_fits=True)
