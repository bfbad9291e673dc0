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

Pairs of face-milled spiral bevel gears, cut after machine settings.

Frames, senses of rotation and mounting errors are the same. phi1 = phi2 = 0 where both flanks hold the pitch point at
the mean cone distance.

Hypoid pairs: the pinion's pitch apex stays the origin, and x points towards the calculation point P, in which both
pitch cones touch (:mod:`loaded_tca.gears.hypoid`). The offset E is counted along the common normal of the axes, on the
side of +y, and the shaft angle grows about it. The base radii have the ratio of the teeth, as the levers of a common
normal do: that of the pinion is r1 cos(alpha_t) at P.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks.base import unmodified
from loaded_tca.flanks.face_milled import FlankAngles, GeneratedFlank
from loaded_tca.flanks.modification import FlankModifications
from loaded_tca.gears.bevel_meshes import BevelMesh
from loaded_tca.gears.face_milled import FaceMilledGear, FlankName
from loaded_tca.gears.hypoid import HypoidCones, OffsetFrame
from loaded_tca.material import Material
from loaded_tca.pairs.gear import Gear
from loaded_tca.pairs.gear_pair import Driving, GearPair, Sense, require_finite, signs_of
from loaded_tca.plain import plain
from loaded_tca.tooth.face_milled import FaceMilledTooth
from loaded_tca.tooth.families import BevelTooth


@dataclass(frozen=True)
class BevelMounting:
    """Mounting errors of bevel gears, zero where both apexes coincide.

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

    def place_with_offset(self, frame: OffsetFrame) -> tuple[Array, Array]:
        """Origin (3,) and axes (3, 3), in rows, of the wheel frame of a hypoid pair in the frame of the pinion.

        E runs along the common normal of the axes, about which the shaft angle grows, P and G along the axes.
        """
        wheel_point = frame.crossing_points[1]
        normal, sine, cosine = frame.common_normal, math.sin(self.shaft_angle_error), math.cos(self.shaft_angle_error)

        def turned(vectors: Array) -> Array:
            along = (vectors @ normal)[..., None] * normal
            return along + cosine * (vectors - along) + sine * np.cross(normal, vectors)

        axes = turned(frame.axes)
        origin = wheel_point + turned(frame.origin - wheel_point) + self.offset * normal
        return origin - np.array([0.0, 0.0, self.pinion_axial]) + self.wheel_axial * axes[2], axes


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
        face_width=min(mesh.pinion.face_width, mesh.wheel.face_width),
    )


_EQUAL = 1e-6
_ROLLING = 0.01
"""By how much mean normal modules of a hypoid pair may differ: cones of the standard do by 0.4 %."""


def face_milled_pair(
    pinion: FaceMilledGear,
    wheel: FaceMilledGear,
    *,
    pinion_flank: FlankName = "concave",
    driving: Driving = "pinion",
    shaft_angle: float | None = None,
    modifications: tuple[FlankModifications, FlankModifications] = (FlankModifications(), FlankModifications()),
    mounting: BevelMounting = BevelMounting(),
    materials: tuple[Material, Material] = (Material(), Material()),
    exact: bool = False,
    offset: float = 0.0,
) -> GearPair:
    """Pair of face-milled gears.

    Its module is the mean normal one and its base radii are r cos(alpha_t) at the mean cone distance, with the means of
    the angles that both generated flanks have there.

    Parameters
    ----------
    pinion, wheel : FaceMilledGear
        Of opposite hands; cutters need the blades of the flanks in contact only.
    pinion_flank : {"concave", "convex"}
        The flank of the pinion that touches; the sense of rotation follows. Drive side: concave.
    driving : {"pinion", "wheel"}
    shaft_angle : float [rad], optional
        Sigma; default: the sum of the pitch angles.
    modifications : (FlankModifications, FlankModifications)
        Of pinion and wheel; the profile runs from the form line to the tip, reliefs start at diameters 2 R_m sin u.
    mounting : BevelMounting
    materials : (Material, Material)
    exact : bool
        Solve the generating equations at every point; default: B-splines of the flanks.
    offset : float [mm]
        Hypoid offset a; positive: the pinion follows the hand of the wheel. The pitch cones have to close on it and on
        the shaft angle (then a right angle by default) within 1e-6; :meth:`HypoidCones.closing` makes them so.

    Returns
    -------
    GearPair

    Raises
    ------
    InputError
        If the gears do not fit each other or a value is unknown.
    GeometryError
        If a flank is undercut or not cut at all, or a tooth is pointed.

    Examples
    --------
    >>> from loaded_tca.gears import BevelBlank
    >>> from loaded_tca.gears.basic_settings import spread_blade
    >>> blank = BevelBlank((20, 30), 5.0, 22.0, spiral_angle=math.radians(35), cutter_radius=50.0, taper="duplex")
    >>> face_milled_pair(*spread_blade(blank))
    GearPair(20/30, module 3.59349 mm, face 22 mm)
    """
    if offset:
        cones = _closed_cones(pinion, wheel, offset, 0.5 * math.pi if shaft_angle is None else shaft_angle)
    _require_mating_gears(pinion, wheel, pinion_flank, rolling=not offset)
    drive = signs_of(driving, "positive")[1]
    side, blanks = pinion.side(pinion_flank), (pinion.blank, wheel.blank)
    first, second = (
        Gear.of(FaceMilledTooth(gear, changes, exact), side, material, gear.bore_diameter)
        for gear, changes, material in zip((pinion, wheel), modifications, materials, strict=True)
    )
    flanks = [unmodified(gear.nominal_flank) for gear in (first, second)]
    angles = [flank.angles for flank in flanks if isinstance(flank, GeneratedFlank)]
    if offset:
        _require_rolling(cones, (pinion.teeth, wheel.teeth), angles)
        spiral, pressure = abs(angles[0].spiral), angles[0].transverse_pressure
        radius = cones.radii[0]
        base_radii = radius * math.cos(pressure), radius * math.cos(pressure) * wheel.teeth / pinion.teeth
        origin, axes = mounting.place_with_offset(cones.frame(pinion.mirror))
    else:
        spiral = 0.5 * sum(abs(one.spiral) for one in angles)
        pressure = 0.5 * sum(one.transverse_pressure for one in angles)
        distance = 0.5 * sum(blank.mean_cone_distance for blank in blanks)
        radius, mating = (distance * math.sin(blank.pitch_angle) for blank in blanks)
        base_radii = radius * math.cos(pressure), mating * math.cos(pressure)
        origin, axes = mounting.place(
            sum(blank.pitch_angle for blank in blanks) if shaft_angle is None else shaft_angle
        )
    return GearPair(
        pinion=first,
        wheel=second,
        teeth=(pinion.teeth, wheel.teeth),
        wheel_origin=origin,
        wheel_axes=axes,
        sense=side * drive,
        driving=drive,
        module=2.0 * radius * math.cos(spiral) / pinion.teeth,
        base_radii=base_radii,
        face_width=min(blank.face_width for blank in blanks),
    )


def _require_mating_gears(pinion: FaceMilledGear, wheel: FaceMilledGear, pinion_flank: str, *, rolling: bool) -> None:
    """Refuse gears of one hand, or whose pitch cones do not roll on each other."""
    problems = []
    if pinion_flank not in ("concave", "convex"):
        problems.append(f"pinion_flank: {pinion_flank!r} is not 'concave' or 'convex'")
    if pinion.blank.hand == wheel.blank.hand:
        problems.append(f"hand: pinion and wheel are both {pinion.blank.hand}-hand; they must be opposite")
    sines = [math.sin(gear.blank.pitch_angle) * gear.blank.mean_cone_distance for gear in (pinion, wheel)]
    if rolling and not math.isclose(sines[0] * wheel.teeth, sines[1] * pinion.teeth, rel_tol=_EQUAL):
        problems.append(
            f"pitch_angle: mean pitch radii {plain(sines[0], 6)} and {plain(sines[1], 6)} mm do not roll on each other "
            f"with {pinion.teeth}/{wheel.teeth} teeth"
        )
    if problems:
        raise InputError(problems)


def _closed_cones(pinion: FaceMilledGear, wheel: FaceMilledGear, offset: float, shaft_angle: float) -> HypoidCones:
    """Pitch cones of a hypoid pair; refuses those that do not close on the offset and the shaft angle."""
    blanks = pinion.blank, wheel.blank
    angles = blanks[0].pitch_angle, blanks[1].pitch_angle
    distances = blanks[0].mean_cone_distance, blanks[1].mean_cone_distance
    cones = HypoidCones.closing(angles, distances, offset, shaft_angle)
    if not math.isclose(cones.pitch_angles[0], angles[0], rel_tol=_EQUAL):
        raise InputError(
            f"pitch_angle: the axes close on an offset of {plain(offset, 6)} mm and a shaft angle of "
            f"{plain(shaft_angle, 6)} rad with a pinion of {cones.pitch_angles[0]:.9g} rad, not {angles[0]:.9g}"
        )
    return cones


def _require_rolling(cones: HypoidCones, teeth: tuple[int, int], angles: list[FlankAngles]) -> None:
    """Refuse flanks whose spiral angles belong to the opposite offset, or do not roll on each other at P."""
    pinion, wheel = (abs(one.spiral) for one in angles)
    angles_at_p = (
        f"the flanks have spiral angles of {plain(math.degrees(pinion))} and {plain(math.degrees(wheel))} deg at P"
    )
    if abs(pinion - wheel + cones.offset_angle) < abs(pinion - wheel - cones.offset_angle):
        larger, sign = ("larger", "positive") if cones.offset > 0.0 else ("smaller", "negative")
        raise InputError(
            f"offset: {plain(cones.offset, 6)} mm; {angles_at_p}; with a {sign} offset the pinion has the "
            f"{larger} spiral angle: change the sign of the offset"
        )
    rolls = [
        radius * math.cos(spiral) / number
        for radius, spiral, number in zip(cones.radii, (pinion, wheel), teeth, strict=True)
    ]
    if not math.isclose(*rolls, rel_tol=_ROLLING):
        raise GeometryError(
            f"{angles_at_p}: half the normal modules there, {plain(rolls[0], 5)} and {plain(rolls[1], 5)} mm, "
            f"differ by more than {_ROLLING:.0%}: the flanks do not roll on each other"
        )
