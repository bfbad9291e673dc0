"""Teeth of straight and spiral bevel gears beside their flanks."""

from __future__ import annotations

from loaded_tca.gears import BevelGear, BevelMesh
from loaded_tca.tooth.fillet import ArcFillet
from loaded_tca.tooth.form import RootCone, ToothForm, tooth_forms
from loaded_tca.tooth.sections import ApexSpheres

FILLET_RADIUS_COEFFICIENT = 0.38
"""Radius of the fillet of bevel gears in mean normal modules, as that of the basic rack of ISO 53, profile A."""


@tooth_forms.register
def _of_bevel_gears(mesh: BevelMesh, *, fillet_radius: float | None = None) -> tuple[ToothForm, ToothForm]:
    def form(gear: BevelGear) -> ToothForm:
        default = FILLET_RADIUS_COEFFICIENT * gear.mean_normal_module
        radius = default if fillet_radius is None else fillet_radius
        fillet, root = ArcFillet(radius, gear.mean_cone_distance), RootCone(gear.root_cone_angle)
        return ToothForm(gear.teeth, gear.half_thickness_angle, ApexSpheres(), root, fillet, fillet_radius is None)

    return form(mesh.pinion), form(mesh.wheel)
