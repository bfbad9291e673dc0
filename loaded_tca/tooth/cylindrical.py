"""Teeth of spur and helical gears."""

from __future__ import annotations

from dataclasses import dataclass, replace

from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.cylindrical import InvoluteFlank
from loaded_tca.flanks.modification import FlankModifications, modified
from loaded_tca.gears import CylindricalGear
from loaded_tca.gears.cylindrical_mesh import ActiveProfile
from loaded_tca.tooth.fillet import RackFillet
from loaded_tca.tooth.form import RootCylinder, ToothForm
from loaded_tca.tooth.geometry import ToothGeometry
from loaded_tca.tooth.sections import TransversePlanes


@dataclass(frozen=True)
class CylindricalTooth(ToothGeometry):
    """Involute teeth of a cylindrical gear, with the fillet that its basic rack cuts.

    Parameters
    ----------
    gear : CylindricalGear
    working_radius : float [mm]
        Radius of the working circle, where Theta = 0 at mid-face.
    active : ActiveProfile
        Over which profile modifications run.
    modifications : FlankModifications

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalMesh
    >>> gears = [CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)]
    >>> mesh = CylindricalMesh(*gears)
    >>> form = CylindricalTooth(gears[0], mesh.pinion_working_radius, mesh.pinion_active_profile).form()
    >>> round(form.half_thickness_angle * 34, 6)  # without profile shift half a tooth is a quarter of a pitch
    1.570796
    """

    gear: CylindricalGear
    working_radius: float
    active: ActiveProfile
    modifications: FlankModifications = FlankModifications()

    @property
    def unmodified(self) -> ToothGeometry:
        """The same teeth without modifications."""
        return replace(self, modifications=FlankModifications())

    def nominal(self, side: int) -> Flank:
        """Involute flank of a side."""
        gear = self.gear
        radii = gear.form_radius, gear.tip_radius
        return InvoluteFlank(gear.base_radius, gear.base_helix_angle, side, self.working_radius, radii, gear.face_width)

    def modified(self, nominal: Flank) -> Flank:
        """The flank with its modifications; profile modifications run over the roll length."""
        return modified(
            nominal,
            self.modifications,
            self.gear.face_width,
            (2.0 * self.active.start_radius, 2.0 * self.active.end_radius),
            lambda diameter: self.gear.roll_length(0.5 * diameter),
            owner=self.gear.name,
        )

    def form(self) -> ToothForm:
        """Transverse sections, root cylinder and the fillet of the rack."""
        gear = self.gear
        half_angle = 0.5 * gear.tooth_thickness_at(self.working_radius) / self.working_radius
        root, fillet = RootCylinder(gear.root_radius), RackFillet(gear)
        return ToothForm(gear.teeth, half_angle, TransversePlanes(), root, fillet)
