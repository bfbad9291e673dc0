r"""Pairs of straight and spiral bevel gears: frames, mounting errors E, P, G and shaft angle.

Fixed frame: pinion axis = +z towards the heel, origin at the pinion's apex, x towards the pitch line. Wheel frame
without errors: the same apex, e_x2 = (-cos Sigma, 0, sin Sigma), e_y2 = (0, -1, 0), e_z2 = (sin Sigma, 0, cos Sigma)::

            x ^      / pitch line
              |    /       e_z2 (wheel axis, Sigma from z)
              |  /     , '
         apex o - - - - - - - - > z (pinion axis)

Senses of rotation, sides and angles are those of :mod:`loaded_tca.pairs.gear_pair`; at phi1 = phi2 = 0 the
unmodified, aligned pair touches on the pitch line at the mean cone distance. The fixed frame stays with the pinion:
where the pinion is withdrawn by P, the wheel comes nearer along the pinion's axis by P in this frame.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.flanks.modification import FlankModifications
from loaded_tca.gears.bevel import BevelMesh
from loaded_tca.material import Material
from loaded_tca.pairs.gear import Gear
from loaded_tca.pairs.gear_pair import Driving, GearPair, Sense, require_finite, signs_of
from loaded_tca.tooth.families import BevelTooth


@dataclass(frozen=True)
class BevelMounting:
    """Mounting errors of bevel gears, zero where the two apexes are one.

    Parameters
    ----------
    offset : float [mm]
        E; positive: the wheel's apex moves along +y of the fixed frame.
    pinion_axial : float [mm]
        P; positive: the pinion moves along its own axis away from the apex, towards its heel.
    wheel_axial : float [mm]
        G; positive: the wheel moves along its own axis away from the apex, towards its heel.
    shaft_angle_error : float [rad]
        Adds to the shaft angle; the wheel turns about its apex.

    Raises
    ------
    InputError
        If a value is not finite.
    """

    offset: float = 0.0
    pinion_axial: float = 0.0
    wheel_axial: float = 0.0
    shaft_angle_error: float = 0.0

    def __post_init__(self) -> None:
        require_finite(self, ("mm", "mm", "mm", "rad"))

    def place(self, shaft_angle: float) -> tuple[Array, Array]:
        """Origin (3,) and axes (3, 3), in rows, of the wheel frame in the frame of the pinion."""
        sine, cosine = math.sin(shaft_angle + self.shaft_angle_error), math.cos(shaft_angle + self.shaft_angle_error)
        axes = np.array([[-cosine, 0.0, sine], [0.0, -1.0, 0.0], [sine, 0.0, cosine]])
        return np.array([0.0, self.offset, -self.pinion_axial]) + self.wheel_axial * axes[2], axes


def bevel_pair(
    mesh: BevelMesh,
    *,
    modifications: tuple[FlankModifications, FlankModifications] = (FlankModifications(), FlankModifications()),
    mounting: BevelMounting = BevelMounting(),
    materials: tuple[Material, Material] = (Material(), Material()),
    driving: Driving = "pinion",
    sense: Sense = "positive",
) -> GearPair:
    """Pair of straight or spiral bevel gears.

    Its module is the mean normal one, its base radii are those of the base cones at the mean cone distance.

    Parameters
    ----------
    mesh : BevelMesh
        Macro geometry.
    modifications : (FlankModifications, FlankModifications)
        Of pinion and wheel; reliefs start at diameters 2 R_m sin u, see :meth:`BevelGear.diameter_at`.
    mounting : BevelMounting
        Errors of position.
    materials : (Material, Material)
        Of pinion and wheel.
    driving : {"pinion", "wheel"}
    sense : {"positive", "negative"}
        "negative": the pinion turns about -z and touches with its other flank.

    Raises
    ------
    InputError
        If driving or sense is not one of the two, or a relief starts off the active profile.

    Examples
    --------
    >>> from loaded_tca.gears import bevel_mesh
    >>> bevel_pair(bevel_mesh((20, 40), outer_module=4.0, face_width=20.0))
    GearPair(20/40, module 3.55279 mm, face 20 mm)
    """
    turning, drive = signs_of(driving, sense)
    pinion, wheel = (
        Gear.of(BevelTooth(gear, active, changes), turning * drive, material, gear.bore_diameter)
        for gear, active, changes, material in zip(
            (mesh.pinion, mesh.wheel), mesh.active_cones, modifications, materials, strict=True
        )
    )
    origin, axes = mounting.place(mesh.shaft_angle)
    return GearPair(
        pinion=pinion,
        wheel=wheel,
        teeth=(mesh.pinion.teeth, mesh.wheel.teeth),
        wheel_origin=origin,
        wheel_axes=axes,
        sense=turning,
        driving=drive,
        module=mesh.pinion.mean_normal_module,
        base_radii=(mesh.pinion.mean_base_radius, mesh.wheel.mean_base_radius),
        face_width=mesh.pinion.face_width,
    )
