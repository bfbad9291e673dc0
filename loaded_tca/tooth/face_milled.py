"""Teeth of face-milled gears beside their flanks."""

from __future__ import annotations

import math

import numpy as np

from loaded_tca.flanks.face_milled import GeneratedFlank, tooth_angle
from loaded_tca.gears import FaceMilledGear, FaceMilledMesh
from loaded_tca.gears.cutter import BLADE_SIGNS
from loaded_tca.tooth.bevel import FILLET_RADIUS_COEFFICIENT
from loaded_tca.tooth.fillet import ArcFillet
from loaded_tca.tooth.form import RootCone, ToothForm, tooth_forms
from loaded_tca.tooth.sections import ApexSpheres


@tooth_forms.register
def _of_face_milled_gears(mesh: FaceMilledMesh, *, fillet_radius: float | None = None) -> tuple[ToothForm, ToothForm]:
    def form(gear: FaceMilledGear) -> ToothForm:
        distance, delta = gear.blank.mean_cone_distance, gear.blank.pitch_angle
        rho, z = np.array([distance * math.sin(delta)]), np.array([distance * math.cos(delta)])
        half = 0.5 * float(tooth_angle(gear, rho, z)[0])
        fillet = ArcFillet(_edge_radius(gear, float(rho[0])) if fillet_radius is None else fillet_radius)
        root = RootCone(gear.blank.root_angle, -gear.blank.root_apex)
        return ToothForm(gear.teeth, half, ApexSpheres(), root, fillet, fillet_radius is None)

    return form(mesh.pinion), form(mesh.wheel)


def _edge_radius(gear: FaceMilledGear, pitch_radius: float) -> float:
    """Larger edge radius of the blades, or that of a basic rack of the mean normal module [mm]."""
    edge = max(gear.cutter.blade(flank).edge_radius for flank in BLADE_SIGNS)
    if edge > 0.0:
        return edge
    spiral = GeneratedFlank(gear, "concave").angles.spiral
    return FILLET_RADIUS_COEFFICIENT * 2.0 * pitch_radius * math.cos(spiral) / gear.teeth
