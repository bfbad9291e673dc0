"""Pairs of spur and helical gears, of a pinion and a ring gear, and their mounting errors.

The frame of a ring without errors is that of the pinion turned by 180 degrees about the x axis and moved by the
centre distance towards -x: origin (-a, 0, 0), axes (1, 0, 0), (0, -1, 0), (0, 0, -1). The ring turns with the pinion,
about +z, which is -z of its own frame: so all that holds for the wheel of an external pair holds for it, word for word.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks.modification import FlankModifications
from loaded_tca.gears import CylindricalMesh, InternalMesh
from loaded_tca.gears.checks import LEAST_FACE
from loaded_tca.gears.involute import InvoluteGear, InvoluteMesh
from loaded_tca.material import Material
from loaded_tca.pairs.gear import Gear
from loaded_tca.pairs.gear_pair import Driving, GearPair, Sense, require_finite, signs_of
from loaded_tca.plain import plain
from loaded_tca.tooth.families import CylindricalTooth, InvoluteTooth
from loaded_tca.tooth.ring import RingTooth

Mesh = TypeVar("Mesh", CylindricalMesh, InternalMesh)

LARGEST_ANGLE = math.radians(45.0)
"""Angular errors stay below this [rad]: the axes are those of parallel gears, which still face each other."""

LARGEST_TURN = 2.0 * math.pi
"""Teeth wind by less than this around their gear [rad]: others would be in mesh at two places of one position."""


@dataclass(frozen=True)
class Mounting:
    """Mounting errors of parallel axes.

    Parameters
    ----------
    in_plane : float [rad]
        gamma, in the plane of the axes; positive when the wheel's axis leaves the pinion at z > 0.
    out_of_plane : float [rad]
        delta, across that plane; positive when the wheel moves towards -y at z > 0.
    centre_distance_error : float [mm]
        Positive: apart.
    axial_offset : float [mm]
        Positive: wheel towards +z.

    Raises
    ------
    InputError
        If a value is not finite, or an angle not between -45 and 45 deg.
    """

    in_plane: float = 0.0
    out_of_plane: float = 0.0
    centre_distance_error: float = 0.0
    axial_offset: float = 0.0

    def __post_init__(self) -> None:
        require_finite(self, ("rad", "rad", "mm", "mm"))
        problems = [
            f"{name}: {plain(angle, 6)} rad, {plain(math.degrees(angle), 6)} deg, is not between -45 and 45 deg: the "
            "axes are nearly parallel"
            for name, angle in (("in_plane", self.in_plane), ("out_of_plane", self.out_of_plane))
            if abs(angle) >= LARGEST_ANGLE
        ]
        if problems:
            raise InputError(problems)

    def place_parallel(self, centre_distance: float) -> tuple[Array, Array]:
        """Origin (3,) and axes (3, 3), in rows, of the wheel frame: R_y(gamma) R_x(delta) about its mid-face."""
        origin = np.array([centre_distance + self.centre_distance_error, 0.0, self.axial_offset])
        return origin, np.diag([-1.0, -1.0, 1.0]) @ self.turn.T

    @property
    def turn(self) -> Array:
        """R_y(gamma) R_x(delta), which turns the axes of the wheel (3, 3)."""
        sin_gamma, cos_gamma = math.sin(self.in_plane), math.cos(self.in_plane)
        sin_delta, cos_delta = math.sin(self.out_of_plane), math.cos(self.out_of_plane)
        about_x = np.array([[1.0, 0.0, 0.0], [0.0, cos_delta, -sin_delta], [0.0, sin_delta, cos_delta]])
        about_y = np.array([[cos_gamma, 0.0, sin_gamma], [0.0, 1.0, 0.0], [-sin_gamma, 0.0, cos_gamma]])
        return about_y @ about_x


def cylindrical_pair(
    mesh: CylindricalMesh,
    *,
    modifications: tuple[FlankModifications, FlankModifications] = (FlankModifications(), FlankModifications()),
    mounting: Mounting = Mounting(),
    materials: tuple[Material, Material] = (Material(), Material()),
    driving: Driving = "pinion",
    sense: Sense = "positive",
) -> GearPair:
    """Pair of external spur or helical gears.

    Parameters
    ----------
    mesh : CylindricalMesh
        Macro geometry.
    modifications : (FlankModifications, FlankModifications)
        Of pinion and wheel.
    mounting : Mounting
        Errors of the wheel's position, the axial offset beside that of the mesh.
    materials : (Material, Material)
        Of pinion and wheel.
    driving : {"pinion", "wheel"}
    sense : {"positive", "negative"}
        "negative": the pinion turns about -z and touches with its other flank.

    Raises
    ------
    InputError
        If driving or sense is not one of the two, or a relief starts off the active profile.
    GeometryError
        If the teeth wind a whole turn around a gear over its face width, or the faces have less than a thousandth of
        the module in common.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear
    >>> gears = [CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)]
    >>> cylindrical_pair(CylindricalMesh(*gears))
    GearPair(34/57, module 3 mm, face 25 mm)
    """
    mesh, mounting = _as_mounted(mesh, mounting)
    wheel = CylindricalTooth(mesh.wheel, mesh.wheel_working_radius, mesh.wheel_active_profile, modifications[1])
    return involute_pair(
        mesh,
        wheel,
        mesh.wheel.bore_diameter,
        mounting.place_parallel(mesh.working_centre_distance),
        modifications=modifications[0],
        materials=materials,
        driving=driving,
        sense=sense,
    )


def involute_pair(
    mesh: InvoluteMesh,
    wheel: InvoluteTooth,
    held: float | None,
    place: tuple[Array, Array],
    *,
    modifications: FlankModifications,
    materials: tuple[Material, Material],
    driving: Driving,
    sense: Sense,
) -> GearPair:
    """Pair of an external pinion and a mating gear, external or a ring.

    Parameters
    ----------
    mesh : InvoluteMesh
        With the whole axial offset of the mating gear.
    wheel : InvoluteTooth
        Teeth of the mating gear, with their modifications.
    held : float, optional [mm]
        Diameter at which the mating gear is held: its bore, or the outside of a ring.
    place : (3,) array [mm], (3, 3) array
        Origin and axes of the mating gear in the fixed frame.
    modifications : FlankModifications
        Of the pinion.
    materials : (Material, Material)
    driving : {"pinion", "wheel"}
    sense : {"positive", "negative"}

    Raises
    ------
    InputError, GeometryError
        As :func:`cylindrical_pair`.
    """
    turning, drive = signs_of(driving, sense)
    require_common_face(mesh)
    for gear in (mesh.pinion, mesh.wheel):
        require_short_turn(gear)
    pinion = CylindricalTooth(mesh.pinion, mesh.pinion_working_radius, mesh.pinion_active_profile, modifications)
    side = turning * drive
    origin, axes = place
    return GearPair(
        pinion=Gear.of(pinion, side, materials[0], mesh.pinion.bore_diameter),
        wheel=Gear.of(wheel, side, materials[1], held),
        teeth=(mesh.pinion.tooth_count, mesh.wheel.tooth_count),
        wheel_origin=origin,
        wheel_axes=axes,
        sense=turning,
        driving=drive,
        module=mesh.pinion.normal_module,
        base_radii=(mesh.pinion.base_radius, mesh.wheel.base_radius),
        face_width=mesh.common_face_width,
    )


def require_short_turn(gear: InvoluteGear) -> None:
    """Refuse teeth that wind a whole turn around their gear over its face width."""
    turn = gear.face_width * abs(math.tan(gear.base_helix_angle)) / gear.base_radius
    if turn >= LARGEST_TURN:
        raise GeometryError(
            f"{gear.name}: its teeth wind {plain(turn / (2.0 * math.pi), 3)} times around the gear over its "
            f"face width, {plain(gear.face_width, 6)} mm; less than one turn is allowed"
        )


def _as_mounted(mesh: Mesh, mounting: Mounting) -> tuple[Mesh, Mounting]:
    """Mesh and mounting, both with the sum of their axial offsets."""
    offset = mesh.axial_offset + mounting.axial_offset
    return replace(mesh, axial_offset=offset), replace(mounting, axial_offset=offset)


def require_common_face(mesh: InvoluteMesh) -> None:
    """Refuse faces that the offset of the wheel leaves next to nothing in common; apart, they never touch."""
    common = 0.5 * (mesh.pinion.face_width + mesh.wheel.face_width) - abs(mesh.axial_offset)
    least = LEAST_FACE * mesh.pinion.normal_module
    if abs(common) < least:
        raise GeometryError(
            f"axial_offset: {plain(mesh.axial_offset, 6)} mm leaves no common flank: the faces of pinion and wheel "
            f"have {plain(max(common, 0.0))} mm in common; at least {plain(least)} mm, {plain(LEAST_FACE, 6)} normal "
            "modules, are needed"
        )


def internal_pair(
    mesh: InternalMesh,
    *,
    modifications: tuple[FlankModifications, FlankModifications] = (FlankModifications(), FlankModifications()),
    mounting: Mounting = Mounting(),
    materials: tuple[Material, Material] = (Material(), Material()),
    driving: Driving = "pinion",
    sense: Sense = "positive",
) -> GearPair:
    """Pair of a pinion and a ring gear.

    Parameters
    ----------
    mesh : InternalMesh
        Macro geometry.
    modifications : (FlankModifications, FlankModifications)
        Of pinion and ring. Lower and upper ends of the face are those of the pinion, also of the ring.
    mounting : Mounting
        Errors of the ring's position in the fixed frame. A positive ``centre_distance_error`` moves the ring towards
        +x, teeth apart, and makes the centre distance smaller; where ``in_plane`` is positive the teeth part at z > 0.
    materials : (Material, Material)
        Of pinion and ring.
    driving : {"pinion", "wheel"}
    sense : {"positive", "negative"}
        "negative": the pinion turns about -z and touches with its other flank.

    Raises
    ------
    InputError
        If driving or sense is not one of the two, or a relief starts off the active profile.
    GeometryError
        If the teeth wind a whole turn around a gear over its face width, or the faces have less than a thousandth of
        the module in common.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, RingGear
    >>> pinion = CylindricalGear(teeth=25, normal_module=3.0, face_width=25.0)
    >>> internal_pair(InternalMesh(pinion, RingGear(teeth=-60, normal_module=3.0, face_width=25.0)))
    GearPair(25/60, module 3 mm, face 25 mm)
    """
    mesh, mounting = _as_mounted(mesh, mounting)
    wheel = RingTooth(mesh.ring, mesh.wheel_working_radius, mesh.wheel_active_profile, modifications[1])
    origin = np.array([mounting.centre_distance_error - mesh.working_centre_distance, 0.0, mounting.axial_offset])
    return involute_pair(
        mesh,
        wheel,
        mesh.ring.outer_diameter,
        (origin, np.diag([1.0, -1.0, -1.0]) @ mounting.turn.T),
        modifications=modifications[0],
        materials=materials,
        driving=driving,
        sense=sense,
    )
