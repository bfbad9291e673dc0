"""What there is to tell of two face-milled gears before any contact is computed."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from math import cos, degrees, isnan, nan, pi, sin

import numpy as np

from loaded_tca.flanks.face_milled import FlankAngles, GeneratedFlank, tooth_angle
from loaded_tca.gears.cylindrical_mesh import Room
from loaded_tca.gears.face_milled import FaceMilledGear, FaceMilledMesh, FlankName
from loaded_tca.gears.hypoid import HypoidMesh
from loaded_tca.gears.pitch_cones import limit_pressure_angle
from loaded_tca.scene.model import Row
from loaded_tca.scene.spiral import Point, Side, pitch_point

Sides = tuple[Side, Side]
ONE_FLANK = "one flank"
"""In place of what both flanks of a tooth tell together, where the cutter has one blade."""
MEAN_DEPTHS = ("mean addendum h_am, to the face cone [mm]", "mean dedendum h_fm, to the root cone [mm]")
"""Labels of the depths at the mean point, normal to the pitch cone; a dimension sheet has them itself."""


def flanks_and_points(
    mesh: FaceMilledMesh, sides: Sides
) -> tuple[tuple[GeneratedFlank, GeneratedFlank], tuple[Point, Point]]:
    """Flanks in contact of pinion and wheel, without modifications, and their mean pitch points (rho, z) [mm]."""
    pinion, wheel = (GeneratedFlank(gear, side) for gear, side in zip(mesh.gears, sides, strict=True))
    first, second = (pitch_point(gear.blank.mean_cone_distance, gear.blank.pitch_angle) for gear in mesh.gears)
    return (pinion, wheel), (first, second)


def geometry_rows(mesh: FaceMilledMesh, sides: Sides) -> list[Row]:
    """Lines on the pair, then on blanks, flanks, machine settings and blades of both gears."""
    flanks, points = flanks_and_points(mesh, sides)
    return [
        *_pair_rows(mesh, flanks),
        ("", "pinion", "wheel"),
        ("teeth z", *(str(gear.teeth) for gear in mesh.gears)),
        ("hand of the spiral", *(gear.blank.hand for gear in mesh.gears)),
        ("flank in contact", *sides),
        *_blank_rows(mesh, points),
        *_flank_rows(flanks),
        *_machine_rows(mesh),
        *_blade_rows(mesh, sides),
    ]


def _pair_rows(mesh: FaceMilledMesh, flanks: tuple[GeneratedFlank, GeneratedFlank]) -> list[Row]:
    blank, (pinion, wheel) = mesh.pinion.blank, (flank.angles for flank in flanks)
    if isinstance(mesh, HypoidMesh):
        return _hypoid_rows(mesh, pinion, wheel)
    toe, heel = blank.cone_distances
    misses = (abs(pinion.spiral) - abs(wheel.spiral), pinion.pressure - wheel.pressure)
    return [
        ("shaft angle Sigma [deg]", _deg(mesh.shaft_angle)),
        ("cone distances R_e, R_m, R_i [mm]", *(f"{part:.4f}" for part in (heel, blank.mean_cone_distance, toe))),
        ("face width b [mm]", f"{blank.face_width:.4f}"),
        ("pinion less wheel: spiral, pressure [deg]", *(_deg(miss) for miss in misses)),
    ]


def _hypoid_rows(mesh: HypoidMesh, pinion: FlankAngles, wheel: FlankAngles) -> list[Row]:
    """Lines on the axes of a hypoid pair, on where its pitch cones stand on them, and how far its flanks fit these."""
    cones, blanks = mesh.cones, (mesh.pinion.blank, mesh.wheel.blank)
    spirals = cones.rolling_spiral_angles((mesh.pinion.teeth, mesh.wheel.teeth))
    limit = limit_pressure_angle(cones, spirals)
    misses = abs(pinion.spiral) - abs(wheel.spiral) - cones.offset_angle, pinion.pressure - wheel.pressure
    ends = [(blank.outer_cone_distance, blank.mean_cone_distance, blank.cone_distances[0]) for blank in blanks]
    return [
        ("shaft angle Sigma [deg]", _deg(mesh.shaft_angle)),
        ("hypoid offset a [mm]", f"{mesh.offset:.4f}"),
        ("offset angles zeta_m, zeta_mp [deg]", _deg(cones.axial_offset_angle), _deg(cones.offset_angle)),
        ("limit pressure angle alpha_lim [deg]", _deg(limit)),
        ("spiral angles that roll on each other [deg]", *(_deg(angle) for angle in spirals)),
        ("crossing point to P, t_zm [mm]", *(f"{part:.4f}" for part in cones.crossing_distances)),
        ("pitch apex beyond crossing point, t_z [mm]", *(f"{part:.4f}" for part in cones.apexes)),
        ("pinion: R_e, R_m, R_i [mm]", *(f"{part:.4f}" for part in ends[0])),
        ("wheel: R_e, R_m, R_i [mm]", *(f"{part:.4f}" for part in ends[1])),
        ("face widths b [mm]", *(f"{blank.face_width:.4f}" for blank in blanks)),
        ("smallest clearance at the roots [mm]", *(f"{part:.4f}" for part in mesh.tip_clearances)),
        ("pinion less wheel: spiral - zeta_mp, pressure", *(_deg(miss) for miss in misses)),
    ]


def _blank_rows(mesh: FaceMilledMesh, points: tuple[Point, Point]) -> list[Row]:
    def both(value: Callable[[FaceMilledGear], float]) -> tuple[str, ...]:
        return tuple(f"{value(gear):.4f}" for gear in mesh.gears)

    def shown(beyond: Iterable[float]) -> tuple[str, ...]:
        """Apexes from the crossing points of the axes."""
        return tuple(f"{part + apex:.4f}" for part, apex in zip(beyond, _pitch_apexes(mesh), strict=True))

    return [
        ("pitch angle delta [deg]", *both(lambda gear: degrees(gear.blank.pitch_angle))),
        ("face angle delta_a [deg]", *both(lambda gear: degrees(gear.blank.face_angle))),
        ("root angle delta_f [deg]", *both(lambda gear: degrees(gear.blank.root_angle))),
        ("apex of the face cone beyond [mm]", *shown(gear.blank.face_apex for gear in mesh.gears)),
        ("apex of the root cone beyond [mm]", *shown(gear.blank.root_apex for gear in mesh.gears)),
        ("outer pitch diameter d_e [mm]", *both(_outer_diameter)),
        ("outer transverse module m_et [mm]", *both(lambda gear: _outer_diameter(gear) / gear.teeth)),
        (MEAN_DEPTHS[0], *both(lambda gear: gear.blank.tip_height(gear.blank.mean_cone_distance))),
        (MEAN_DEPTHS[1], *both(lambda gear: -gear.blank.root_height(gear.blank.mean_cone_distance))),
        ("mean point, radius rho [mm]", *(f"{rho:.4f}" for rho, _ in points)),
        ("mean point, from the apex z [mm]", *(f"{z:.4f}" for _, z in points)),
    ]


def _pitch_apexes(mesh: FaceMilledMesh) -> tuple[float, float]:
    """How far the pitch apexes lie beyond the crossing points of the axes [mm]."""
    return mesh.cones.apexes if isinstance(mesh, HypoidMesh) else (0.0, 0.0)


def _outer_diameter(gear: FaceMilledGear) -> float:
    return 2.0 * gear.blank.outer_cone_distance * sin(gear.blank.pitch_angle)


def _flank_rows(flanks: tuple[GeneratedFlank, GeneratedFlank]) -> list[Row]:
    """What the settings make of the flanks in contact, at their mean points."""
    depths = [
        flank.gear.blank.middle_cone_distance * (flank.gear.blank.pitch_angle - flank.mean_cone_angles[1])
        for flank in flanks
    ]
    return [
        ("spiral angle beta_m of this flank [deg]", *(_deg(abs(flank.angles.spiral)) for flank in flanks)),
        ("pressure angle alpha_n of this flank [deg]", *(_deg(flank.angles.pressure) for flank in flanks)),
        ("flank below the pitch cone, mid-face [mm]", *(f"{depth:.4f}" for depth in depths)),
        ("normal tooth thickness s_mn as cut [mm]", *(_shown(_thickness(flank.gear)) for flank in flanks)),
        ("normal pitch at R_m less both s_mn [mm]", _shown(mean_backlash(flanks))),
    ]


def mean_backlash(flanks: tuple[GeneratedFlank, GeneratedFlank]) -> float:
    """Normal pitch less both tooth thicknesses, along the pitch cones at the mean points [mm]; NaN: a flank is not cut.

    The backlash j_mn of ISO 23509, normal to the flanks, is cos(alpha_n) of it.
    """
    return sum(_normal_arc(flank.gear, pi / flank.gear.teeth) - _thickness(flank.gear) for flank in flanks)


def room_and_module(mesh: FaceMilledMesh, sides: Sides) -> tuple[Room, float]:
    """Room that whole gears leave each other, and the mean normal module [mm]; a tooth of one flank jams not."""
    flanks, _ = flanks_and_points(mesh, sides)
    backlash = mean_backlash(flanks)
    module = _normal_arc(flanks[0].gear, 2.0 / mesh.pinion.teeth)
    return Room(0.0 if isnan(backlash) else backlash, (0.0, 0.0), mesh.tip_clearances), module


def _thickness(gear: FaceMilledGear) -> float:
    """Thickness across the teeth on the pitch cone at the mean point [mm]; NaN: only one flank is cut."""
    if None in (gear.cutter.concave, gear.cutter.convex):
        return nan
    rho, z = (np.array([part]) for part in pitch_point(gear.blank.mean_cone_distance, gear.blank.pitch_angle))
    return _normal_arc(gear, float(tooth_angle(gear, rho, z)[0]))


def _normal_arc(gear: FaceMilledGear, angle: float) -> float:
    """Length across the teeth, under the mean spiral angle of the flanks cut, of an angle at the mean point [mm]."""
    sides: tuple[FlankName, ...] = ("concave", "convex")
    cut = [GeneratedFlank(gear, side).angles.spiral for side in sides if getattr(gear.cutter, side) is not None]
    blank = gear.blank
    return blank.mean_cone_distance * sin(blank.pitch_angle) * angle * cos(sum(cut) / len(cut))


def _shown(length: float) -> str:
    return ONE_FLANK if isnan(length) else f"{length:.4f}"


def _machine_rows(mesh: FaceMilledMesh) -> list[Row]:
    first, second = (
        replace(gear.machine, machine_centre_to_back=gear.machine.machine_centre_to_back + apex)
        for gear, apex in zip(mesh.gears, _pitch_apexes(mesh), strict=True)
    )
    settings = (
        ("radial setting S_r [mm]", first.radial, second.radial),
        ("cradle angle q [deg]", degrees(first.cradle_angle), degrees(second.cradle_angle)),
        ("machine root angle gamma_m [deg]", degrees(first.root_angle), degrees(second.root_angle)),
        ("machine centre to back [mm]", first.machine_centre_to_back, second.machine_centre_to_back),
        ("sliding base [mm]", first.sliding_base, second.sliding_base),
        ("blank offset [mm]", first.blank_offset, second.blank_offset),
        ("cutter tilt i [deg]", degrees(first.tilt), degrees(second.tilt)),
        ("swivel j [deg]", degrees(first.swivel), degrees(second.swivel)),
        ("ratio of roll m", first.ratio_of_roll, second.ratio_of_roll),
        ("modified roll 2C", first.modified_roll_2c, second.modified_roll_2c),
        ("modified roll 6D", first.modified_roll_6d, second.modified_roll_6d),
        ("helical motion [mm/rad]", first.helical_motion, second.helical_motion),
    )
    shown = [(label, *(f"{value:.6f}" for value in values)) for label, *values in settings if any(values)]
    return [("generation", first.generation, second.generation), *shown]


def _blade_rows(mesh: FaceMilledMesh, sides: Sides) -> list[Row]:
    """Blades that cut the flanks in contact; their angle as the cutter number corrects it."""
    blades = [gear.cutter.blade(side) for gear, side in zip(mesh.gears, sides, strict=True)]
    return [
        ("cutter number", *(f"{gear.cutter.number:g}" for gear in mesh.gears)),
        ("point radius r_p [mm]", *(f"{blade.point_radius:.6f}" for blade in blades)),
        ("blade angle [deg]", *(_deg(blade.blade_angle) for blade in blades)),
        (
            "radius of a hollow blade [mm]",
            *("straight" if blade.blade_radius is None else f"{blade.blade_radius:g}" for blade in blades),
        ),
        ("edge radius [mm]", *(f"{blade.edge_radius:.4f}" for blade in blades)),
    ]


def _deg(angle: float) -> str:
    return f"{round(degrees(angle), 4) + 0.0:.4f}"  # no minus before a zero
