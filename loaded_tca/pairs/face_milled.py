"""Pairs of face-milled spiral bevel gears, cut after machine settings.

Frames, senses of rotation and mounting errors are those of :mod:`loaded_tca.pairs.bevel`. phi1 = phi2 = 0 where both
flanks hold the pitch point at the mean cone distance.
"""

from __future__ import annotations

import math

import numpy as np

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.face_milled import FlankAngles, GeneratedFlank, tooth_angle
from loaded_tca.flanks.modification import FlankModifications, modified
from loaded_tca.flanks.tooth_region import chebyshev_nodes, face_cone_angles
from loaded_tca.gears.cutter import FlankName
from loaded_tca.gears.face_milled import FaceMilledGear
from loaded_tca.material import Material
from loaded_tca.pairs.bevel import BevelMounting
from loaded_tca.pairs.gear import Gear
from loaded_tca.pairs.gear_pair import Driving, GearPair, signs_of

_EQUAL = 1e-6
_TIP_POINTS = 9


def face_milled_pair(
    pinion: FaceMilledGear,
    wheel: FaceMilledGear,
    *,
    pinion_flank: FlankName = "concave",
    driving: Driving = "pinion",
    shaft_angle: float | None = None,
    modifications: tuple[FlankModifications, FlankModifications] = (
        FlankModifications(),
        FlankModifications(),
    ),
    mounting: BevelMounting = BevelMounting(),
    materials: tuple[Material, Material] = (Material(), Material()),
    exact: bool = False,
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
    _require_mating_gears(pinion, wheel, pinion_flank)
    drive = signs_of(driving, "positive")[1]
    side = pinion.side(pinion_flank)
    gears = (pinion, wheel)
    nominal = [GeneratedFlank(gear, gear.flank_name(side)) for gear in gears]
    for flank in nominal:
        _require_tip(flank)
    angles = _mean_angles(nominal)
    distance = 0.5 * (pinion.blank.mean_cone_distance + wheel.blank.mean_cone_distance)
    radii = [distance * math.sin(gear.blank.pitch_angle) for gear in gears]
    sigma = pinion.blank.pitch_angle + wheel.blank.pitch_angle if shaft_angle is None else shaft_angle
    origin, axes = mounting.place(sigma)
    flanks = [_modified(flank, changes, exact) for flank, changes in zip(nominal, modifications, strict=True)]
    return GearPair(
        pinion=Gear(flanks[0], materials[0]),
        wheel=Gear(flanks[1], materials[1]),
        teeth=(pinion.teeth, wheel.teeth),
        wheel_origin=origin,
        wheel_axes=axes,
        sense=side * drive,
        driving=drive,
        module=2.0 * radii[0] * math.cos(angles.spiral) / pinion.teeth,
        base_radii=(
            radii[0] * math.cos(angles.transverse_pressure),
            radii[1] * math.cos(angles.transverse_pressure),
        ),
        face_width=min(gear.blank.face_width for gear in gears),
    )


def _require_mating_gears(pinion: FaceMilledGear, wheel: FaceMilledGear, pinion_flank: str) -> None:
    """Refuse gears whose pitch cones do not roll on each other."""
    problems = []
    if pinion_flank not in ("concave", "convex"):
        problems.append(f"pinion_flank: {pinion_flank!r} is not 'concave' or 'convex'")
    if pinion.blank.hand == wheel.blank.hand:
        problems.append(f"hand: pinion and wheel are both {pinion.blank.hand}-hand; they must be opposite")
    sines = [math.sin(gear.blank.pitch_angle) * gear.blank.mean_cone_distance for gear in (pinion, wheel)]
    if not math.isclose(sines[0] * wheel.teeth, sines[1] * pinion.teeth, rel_tol=_EQUAL):
        problems.append(
            f"pitch_angle: mean pitch radii {sines[0]:.6g} and {sines[1]:.6g} mm do not roll on each other with "
            f"{pinion.teeth}/{wheel.teeth} teeth"
        )
    if problems:
        raise InputError(problems)


def _mean_angles(flanks: list[GeneratedFlank]) -> FlankAngles:
    """Means of both flanks, which differ where the settings do not match."""
    first, second = (flank.angles for flank in flanks)
    return FlankAngles(
        0.5 * (abs(first.spiral) + abs(second.spiral)),
        0.5 * (first.pressure + second.pressure),
        0.5 * (first.transverse_pressure + second.transverse_pressure),
    )


def _require_tip(flank: GeneratedFlank) -> None:
    """Refuse a tooth whose two flanks, cut with one set of machine settings, meet below the face cone."""
    gear = flank.gear
    if gear.cutter.concave is None or gear.cutter.convex is None:
        return
    distance = chebyshev_nodes(flank.cone_distances, _TIP_POINTS)
    angle = face_cone_angles(flank.face_cone, distance)
    rho, z = distance * np.sin(angle), distance * np.cos(angle)
    thickness = rho * tooth_angle(gear, rho, z)
    worst = int(np.argmin(thickness))
    if not thickness[worst] > 0.0:
        raise GeometryError(
            f"{gear.name}: pointed tooth: its flanks lie {-thickness[worst]:.3g} mm beyond each other at the tip, "
            f"{flank.frame.place(float(rho[worst]), float(z[worst]))}; lower face_angle, or bring the point radii of "
            "the cutter nearer to each other"
        )


def _modified(nominal: GeneratedFlank, modifications: FlankModifications, exact: bool) -> Flank:
    """The flank, exact or as a B-spline, with its modifications."""
    blank = nominal.gear.blank
    distance = blank.mean_cone_distance
    tip, foot = nominal.mean_cone_angles
    flank = nominal if exact else nominal.as_spline()

    def diameter(angle: float) -> float:
        sine = math.sin(angle)
        return 2.0 * distance * (sine if angle <= 0.5 * math.pi else 2.0 - sine)

    def height(of: float) -> float:
        sine = 0.5 * of / distance
        angle = math.asin(sine) if sine <= 1.0 else math.pi - math.asin(2.0 - sine)
        return nominal.mean_height * (angle - foot) / (tip - foot)

    return modified(
        flank, modifications, blank.face_width, (diameter(foot), diameter(tip)), height, owner=nominal.gear.name
    )
