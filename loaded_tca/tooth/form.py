"""What shapes a tooth beside its flanks: how far apart they stand, the root surface, the fillet.

``tooth_forms`` is open: a module of a new gear type registers what its mesh asks for.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import singledispatch

import numpy as np

from loaded_tca.errors import InputError
from loaded_tca.flanks.generated import GeneratedFlank, tooth_angle
from loaded_tca.flanks.jet import Array
from loaded_tca.gears import (
    BevelGear,
    BevelMesh,
    CylindricalGear,
    CylindricalMesh,
    FaceMilledGear,
    FaceMilledMesh,
)
from loaded_tca.gears.cutter import BLADE_SIGNS
from loaded_tca.tooth.fillet import ArcFillet, Fillet, RackFillet
from loaded_tca.tooth.sections import ApexSpheres, Sections, TransversePlanes

FILLET_RADIUS_COEFFICIENT = 0.38
"""Radius of the fillet of bevel gears in mean normal modules, as that of the basic rack of ISO 53, profile A."""


@dataclass(frozen=True)
class ToothForm:
    """All of a tooth but its flanks.

    Attributes
    ----------
    teeth : int
        Number of teeth z.
    half_thickness_angle : float [rad]
        From the middle of the tooth to either flank where Theta = 0.
    sections : Sections
    root_radius : callable
        Coordinates (m,) of sections [mm] -> radii (m,) of the images of their root circles [mm].
    fillet : Fillet
    largest_that_fits : bool
        Whether an arc that does not fit into the space is made smaller, instead of an error.
    """

    teeth: int
    half_thickness_angle: float
    sections: Sections
    root_radius: Callable[[Array], Array]
    fillet: Fillet
    largest_that_fits: bool = False


@dataclass(frozen=True)
class RootCylinder:
    """Root circles of a cylindrical gear.

    Parameters
    ----------
    radius : float [mm]
    """

    radius: float

    def __call__(self, coordinate: Array) -> Array:
        """Radius in every section (m,)."""
        return np.full(np.shape(coordinate), self.radius)


@dataclass(frozen=True)
class RootCone:
    r"""Root circles on spheres about the gear's apex, :math:`u = \delta_f - \arcsin(z_0 \sin\delta_f/R)`.

    Parameters
    ----------
    angle : float [rad]
        delta_f, between axis and cone.
    apex : float [mm]
        z_0, where the cone meets the axis, in the gear's own frame.
    """

    angle: float
    apex: float = 0.0

    def __call__(self, coordinate: Array) -> Array:
        """Radius 2 R tan(u/2) of the images (m,)."""
        cone_angle = self.angle - np.arcsin(self.apex * math.sin(self.angle) / coordinate)
        return 2.0 * coordinate * np.tan(0.5 * cone_angle)


@singledispatch
def tooth_forms(
    mesh: object,
    *,
    fillet_radius: float | None = None,  # noqa: ARG001 (of the registered ones)
) -> tuple[ToothForm, ToothForm]:
    """What shapes the teeth of pinion and wheel, beside their flanks.

    Parameters
    ----------
    mesh : CylindricalMesh, BevelMesh or FaceMilledMesh
        Macro geometry; cylindrical gears get the fillet that their basic rack cuts, bevel gears an arc. The root of
        face-milled gears is the root cone of their blanks.
    fillet_radius : float [mm], optional
        Radius of arcs, at the mean section; default: for cylindrical gears the fillet of the rack; for face-milled
        gears the larger edge radius of their blades, the same from toe to heel; for other bevel gears, and blades
        without an edge radius, 0.38 mean normal modules. An arc that does not fit is made as large as does.

    Raises
    ------
    InputError
        If the radius is not positive and finite, or nobody has said how such gears are shaped.

    Examples
    --------
    >>> gears = [CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)]
    >>> pinion, wheel = tooth_forms(CylindricalMesh(*gears))
    >>> round(pinion.half_thickness_angle * 34, 6)  # without profile shift half a tooth is a quarter of a pitch
    1.570796
    """
    raise InputError(f"mesh: no complete tooth is known for a {type(mesh).__name__}")


@tooth_forms.register
def _of_cylindrical_gears(mesh: CylindricalMesh, *, fillet_radius: float | None = None) -> tuple[ToothForm, ToothForm]:
    def form(gear: CylindricalGear, working_radius: float) -> ToothForm:
        fillet = RackFillet(gear) if fillet_radius is None else ArcFillet(fillet_radius)
        angle = 0.5 * gear.tooth_thickness_at(working_radius) / working_radius
        return ToothForm(gear.teeth, angle, TransversePlanes(), RootCylinder(gear.root_radius), fillet)

    return form(mesh.pinion, mesh.pinion_working_radius), form(mesh.wheel, mesh.wheel_working_radius)


@tooth_forms.register
def _of_bevel_gears(mesh: BevelMesh, *, fillet_radius: float | None = None) -> tuple[ToothForm, ToothForm]:
    def form(gear: BevelGear) -> ToothForm:
        default = FILLET_RADIUS_COEFFICIENT * gear.mean_normal_module
        radius = default if fillet_radius is None else fillet_radius
        fillet, root = ArcFillet(radius, gear.mean_cone_distance), RootCone(gear.root_cone_angle)
        return ToothForm(gear.teeth, gear.half_thickness_angle, ApexSpheres(), root, fillet, fillet_radius is None)

    return form(mesh.pinion), form(mesh.wheel)


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
