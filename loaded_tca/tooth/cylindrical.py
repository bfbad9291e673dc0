"""Teeth of cylindrical gears beside their flanks."""

from __future__ import annotations

from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.tooth.fillet import ArcFillet, RackFillet
from loaded_tca.tooth.form import RootCylinder, ToothForm, tooth_forms
from loaded_tca.tooth.sections import TransversePlanes


@tooth_forms.register
def _of_cylindrical_gears(mesh: CylindricalMesh, *, fillet_radius: float | None = None) -> tuple[ToothForm, ToothForm]:
    def form(gear: CylindricalGear, working_radius: float) -> ToothForm:
        fillet = RackFillet(gear) if fillet_radius is None else ArcFillet(fillet_radius)
        angle = 0.5 * gear.tooth_thickness_at(working_radius) / working_radius
        return ToothForm(gear.teeth, angle, TransversePlanes(), RootCylinder(gear.root_radius), fillet)

    return form(mesh.pinion, mesh.pinion_working_radius), form(mesh.wheel, mesh.wheel_working_radius)
