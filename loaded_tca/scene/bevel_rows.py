"""What there is to tell of bevel and face-milled gears before any contact: the lines of a dimension sheet."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from math import cos, degrees, isnan, nan, pi, sin, tan
from typing import Any

from loaded_tca.arrays import GEARS
from loaded_tca.flanks.face_milled import FlankAngles, GeneratedFlank, generated_flank, tooth_angle_at
from loaded_tca.gears.bevel import BevelGear
from loaded_tca.gears.bevel_blank import BevelBlank
from loaded_tca.gears.bevel_meshes import BevelMesh
from loaded_tca.gears.blank_gear import SECTIONS
from loaded_tca.gears.cylindrical_mesh import Room
from loaded_tca.gears.face_milled import FaceMilledGear, FaceMilledMesh, FlankName
from loaded_tca.gears.hypoid import HypoidMesh
from loaded_tca.gears.pitch_cones import limit_pressure_angle
from loaded_tca.plain import plain
from loaded_tca.scene.model import Row
from loaded_tca.scene.rows import Label, fixed
from loaded_tca.scene.spiral import Point, Side, pitch_point

ROUNDING = 1e-9
"""Cone angles closer than this [rad] are the same."""
Sides = tuple[Side, Side]
CONES = "R_e", "R_m", "R_i"
ONE_FLANK = "one flank"
"""In place of what both flanks of a tooth tell together, where the cutter has one blade."""
MEAN_DEPTHS = ("mean addendum h_am, to the face cone [mm]", "mean dedendum h_fm, to the root cone [mm]")
"""Labels of the depths at the mean point, normal to the pitch cone; a dimension sheet has them itself."""


def flanks_and_points(
    mesh: FaceMilledMesh, sides: Sides
) -> tuple[tuple[GeneratedFlank, GeneratedFlank], tuple[Point, Point]]:
    """Flanks in contact of pinion and wheel, without modifications, and their mean pitch points (rho, z) [mm]."""
    pinion, wheel = (generated_flank(gear, side) for gear, side in zip(mesh.gears, sides, strict=True))
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
        (
            Label("cone distances R_e, R_m, R_i [mm]", "cone_distance_mm", *CONES),
            *(fixed(part, 4) for part in (heel, blank.mean_cone_distance, toe)),
        ),
        ("face width b [mm]", fixed(blank.face_width, 4)),
        (
            Label("pinion less wheel: spiral, pressure [deg]", "pinion_less_wheel_deg", "spiral", "pressure"),
            *(_deg(miss) for miss in misses),
        ),
    ]


def _hypoid_rows(mesh: HypoidMesh, pinion: FlankAngles, wheel: FlankAngles) -> list[Row]:
    """Lines on the axes of a hypoid pair, on where its pitch cones stand on them, and how far its flanks fit these."""
    cones, blanks = mesh.cones, (mesh.pinion.blank, mesh.wheel.blank)
    teeth = mesh.pinion.teeth, mesh.wheel.teeth
    spirals = cones.rolling_spiral_angles(teeth)
    limit, module = limit_pressure_angle(cones, spirals), cones.mean_normal_modules(teeth, spirals)[1]
    misses = abs(pinion.spiral) - abs(wheel.spiral) - cones.offset_angle, pinion.pressure - wheel.pressure
    ends = [(blank.outer_cone_distance, blank.mean_cone_distance, blank.cone_distances[0]) for blank in blanks]
    return [
        ("shaft angle Sigma [deg]", _deg(mesh.shaft_angle)),
        ("hypoid offset a [mm]", fixed(mesh.offset, 4)),
        (
            Label("offset angles zeta_m, zeta_mp [deg]", "offset_angle_deg", "zeta_m", "zeta_mp"),
            _deg(cones.axial_offset_angle),
            _deg(cones.offset_angle),
        ),
        ("limit pressure angle alpha_lim [deg]", _deg(limit)),
        ("mean normal module m_mn, of the wheel [mm]", fixed(module, 4)),
        (
            Label("spiral angles that roll on each other [deg]", "spiral_angles_that_roll_on_each_other_deg", *GEARS),
            *(_deg(angle) for angle in spirals),
        ),
        (
            Label("crossing point to P, t_zm [mm]", "crossing_point_to_P_t_zm_mm", *GEARS),
            *(fixed(part, 4) for part in cones.crossing_distances),
        ),
        (
            Label("pitch apex beyond crossing point, t_z [mm]", "pitch_apex_beyond_crossing_point_t_z_mm", *GEARS),
            *(fixed(part, 4) for part in cones.apexes),
        ),
        (Label("pinion: R_e, R_m, R_i [mm]", "pinion_cone_distance_mm", *CONES), *(fixed(part, 4) for part in ends[0])),
        (Label("wheel: R_e, R_m, R_i [mm]", "wheel_cone_distance_mm", *CONES), *(fixed(part, 4) for part in ends[1])),
        (Label("face widths b [mm]", "face_width_b_mm", *GEARS), *(fixed(blank.face_width, 4) for blank in blanks)),
        (
            Label("smallest clearance at the roots [mm]", "smallest_clearance_at_the_roots_mm", *GEARS),
            *(fixed(part, 4) for part in mesh.tip_clearances),
        ),
        (
            Label(
                "pinion less wheel: spiral - zeta_mp, pressure",
                "pinion_less_wheel_deg",
                "spiral_less_zeta_mp",
                "pressure",
            ),
            *(_deg(miss) for miss in misses),
        ),
    ]


def _blank_rows(mesh: FaceMilledMesh, points: tuple[Point, Point]) -> list[Row]:
    def both(value: Callable[[FaceMilledGear], float]) -> tuple[str, ...]:
        return tuple(fixed(value(gear), 4) for gear in mesh.gears)

    def shown(beyond: Iterable[float]) -> tuple[str, ...]:
        """Apexes from the crossing points of the axes."""
        return tuple(fixed(part + apex, 4) for part, apex in zip(beyond, _pitch_apexes(mesh), strict=True))

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
        ("mean point, radius rho [mm]", *(fixed(rho, 4) for rho, _ in points)),
        ("mean point, from the apex z [mm]", *(fixed(z, 4) for _, z in points)),
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
        ("flank below the pitch cone, mid-face [mm]", *(fixed(depth, 4) for depth in depths)),
        ("normal tooth thickness s_mn as cut [mm]", *(_shown(mean_thickness(flank.gear)) for flank in flanks)),
        ("normal pitch at R_m less both s_mn [mm]", _shown(mean_backlash(flanks))),
    ]


def mean_backlash(flanks: tuple[GeneratedFlank, GeneratedFlank]) -> float:
    """Normal pitch less both tooth thicknesses, along the pitch cones at the mean points [mm]; NaN: a flank is not cut.

    The backlash j_mn of ISO 23509, normal to the flanks, is cos(alpha_n) of it.
    """
    return sum(_normal_arc(flank.gear, pi / flank.gear.teeth) - mean_thickness(flank.gear) for flank in flanks)


def room_and_module(mesh: FaceMilledMesh, sides: Sides) -> tuple[Room, float]:
    """Room that whole gears leave each other, and the mean normal module [mm]; a tooth of one flank jams not."""
    flanks, _ = flanks_and_points(mesh, sides)
    backlash = mean_backlash(flanks)
    module = _normal_arc(flanks[0].gear, 2.0 / mesh.pinion.teeth)
    return Room(0.0 if isnan(backlash) else backlash, (0.0, 0.0), mesh.tip_clearances), module


def mean_thickness(gear: FaceMilledGear) -> float:
    """Thickness across the teeth on the pitch cone at the mean point [mm]; NaN: only one flank is cut."""
    if None in (gear.cutter.concave, gear.cutter.convex):
        return nan
    place = pitch_point(gear.blank.mean_cone_distance, gear.blank.pitch_angle)
    return _normal_arc(gear, tooth_angle_at(gear, *place))


def _normal_arc(gear: FaceMilledGear, angle: float) -> float:
    """Length across the teeth, under the mean spiral angle of the flanks cut, of an angle at the mean point [mm]."""
    sides: tuple[FlankName, ...] = ("concave", "convex")
    cut = [generated_flank(gear, side).angles.spiral for side in sides if getattr(gear.cutter, side) is not None]
    blank = gear.blank
    return blank.mean_cone_distance * sin(blank.pitch_angle) * angle * cos(sum(cut) / len(cut))


def _shown(length: float) -> str:
    return ONE_FLANK if isnan(length) else fixed(length, 4)


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
    shown = [(label, *(fixed(value, 6) for value in values)) for label, *values in settings if any(values)]
    return [("generation", first.generation, second.generation), *shown]


def _blade_rows(mesh: FaceMilledMesh, sides: Sides) -> list[Row]:
    """Blades that cut the flanks in contact; their angle as the cutter number corrects it."""
    blades = [gear.cutter.blade(side) for gear, side in zip(mesh.gears, sides, strict=True)]
    return [
        ("cutter number", *(f"{plain(gear.cutter.number, 6)}" for gear in mesh.gears)),
        ("point radius r_p [mm]", *(fixed(blade.point_radius, 6) for blade in blades)),
        ("blade angle [deg]", *(_deg(blade.blade_angle) for blade in blades)),
        (
            "radius of a hollow blade [mm]",
            *("straight" if blade.blade_radius is None else f"{plain(blade.blade_radius, 6)}" for blade in blades),
        ),
        ("edge radius [mm]", *(fixed(blade.edge_radius, 4) for blade in blades)),
    ]


def _deg(angle: float) -> str:
    return fixed(degrees(angle), 4)


def common_blank_rows(blanks: BevelBlank, section: Any, data_type: str) -> list[Row]:
    """Return the lines of both gears together: data, depths, backlash, spiral angles, contact ratios."""
    spirals = blanks.wheel.spiral_angles if blanks.cutter_radius else (blanks.spiral_angle,) * 3
    outer, mean = (
        [blanks.backlashes[kind] for kind in kinds]
        for kinds in (("outer_normal", "outer_transverse"), ("mean_normal", "mean_transverse"))
    )
    taper = "given angles" if section.wheel_addendum_angle_deg is not None else blanks.taper
    return [
        (Label("blank after ISO 23509: data type, taper", "blank", "data_type", "taper"), data_type, taper),
        ("slots along the face", "constant" if blanks.has_constant_slots else "as the pitch"),
        (
            Label("mean working depth h_mw, whole depth h_m [mm]", "mean_depth_mm", "working_h_mw", "whole_h_m"),
            *_numbers(blanks.working_depth, blanks.whole_depth),
        ),
        ("clearance c, normal to the cones [mm]", *_numbers(blanks.clearance)),
        ("cutter radius r_c0 [mm]", fixed(blanks.cutter_radius, 4) if blanks.cutter_radius else "none"),
        ("flanks along the face", section.lengthwise_curve.replace("_", " ") if blanks.spiral_angle else "straight"),
        (
            Label(
                "cutter's spiral angle at heel, mean, toe [deg]",
                "spiral_angle_of_the_cutter_deg",
                "heel",
                "mean",
                "toe",
            ),
            *_numbers(*map(degrees, spirals[::-1])),
        ),
        (
            Label("backlash j_en, j_et2 at the heel [mm]", "outer_backlash_mm", "j_en", "j_et2"),
            *_numbers(*outer),
        ),
        (Label("backlash j_mn, j_mt2 at R_m [mm]", "mean_backlash_mm", "j_mn", "j_mt2"), *_numbers(*mean)),
        (
            Label("contact ratios eps_va, eps_vb by 0.85 b", "virtual_contact_ratio", "eps_va", "eps_vb"),
            *_numbers(*blanks.virtual_contact_ratios),
        ),
    ]


def blank_rows(blanks: BevelBlank) -> list[Row]:
    """Return the lines of each gear: diameters and depths at heel, mean and toe, cones with apexes, thicknesses."""
    gears = blanks.pinion, blanks.wheel

    def along(label: str, name: str) -> list[Row]:
        first, second = (getattr(gear, name) for gear in gears)
        places = reversed(list(zip(SECTIONS, first, second, strict=True)))
        return [(f"{label}, {place} [mm]", *_numbers(pinion, wheel)) for place, pinion, wheel in places]

    def both(label: str, *values: float) -> Row:
        return (label, *_numbers(*values))

    clearances = dict(zip(SECTIONS, zip(*blanks.clearances, strict=True), strict=True))
    return [
        *along("pitch diameter d", "pitch_diameters"),
        *along("addendum h_a", "addenda"),
        *along("dedendum h_f", "dedenda"),
        *(both(f"clearance above the root, {place} [mm]", *clearances[place]) for place in SECTIONS[::-1]),
        *along("tip diameter d_a", "tip_diameters"),
        *along("root diameter d_f", "root_diameters"),
        both("whole depth at the heel, normal to the root cone [mm]", *(gear.outer_whole_depth for gear in gears)),
        *along("crown to crossing point t_x", "crown_to_crossing"),
        both("mean point to crossing point t_zm [mm]", *(gear.mean_point_to_crossing for gear in gears)),
        both("addendum angle theta_a [deg]", *(degrees(gear.addendum_angle) for gear in gears)),
        both("dedendum angle theta_f [deg]", *(degrees(gear.dedendum_angle) for gear in gears)),
        both("face angle delta_a of the cone itself [deg]", *(degrees(gear.face_angle) for gear in gears)),
        both("  its apex t_zF beyond the crossing point [mm]", *(gear.face_apex for gear in gears)),
        both("root angle delta_f of the cone itself [deg]", *(degrees(gear.root_angle) for gear in gears)),
        both("  its apex t_zR beyond the crossing point [mm]", *(gear.root_apex for gear in gears)),
        both("mean normal thickness s_mn [mm]", *(gear.mean_normal_thickness for gear in gears)),
        both("  coefficient x_sm, backlash in it", *(gear.thickness_coefficient for gear in gears)),
        both("  its chord s_mnc [mm]", *(gear.chordal_thickness for gear in gears)),
        both("  addendum above it h_amc [mm]", *(gear.chordal_addendum for gear in gears)),
        *along("normal thickness s_n", "normal_thicknesses"),
        *along("top land s_an", "tip_thicknesses"),
        *along("slot width W", "slot_widths"),
        both("largest edge radius of blades, by the slot [mm]", *(gear.edge_radius_of_slot for gear in gears)),
        both(
            "  by the mating tip in the clearance [mm]",
            *(gear.edge_radius_of_clearance(min(c)) for gear, c in zip(gears, blanks.clearances, strict=True)),
        ),
        both("profile shift x_hm", *(gear.profile_shift for gear in gears)),
        both("  least without undercut", *(gear.smallest_profile_shift for gear in gears)),
    ]


LARGEST_SHOWN = 1e6
"""Numbers from here on are limits that go to infinity, as of undercut towards a crown wheel: there are none."""


def _numbers(*values: float) -> tuple[str, ...]:
    return tuple(fixed(value, 4) if abs(value) < LARGEST_SHOWN else "none" for value in values)


def cone_rows(mesh: BevelMesh, *, seen: bool) -> list[Row]:
    """Cone angles of both gears, diameters and depths at their pitch cones, and whether tips reach into fillets.

    Angles of cones with apexes of their own are those ``seen`` from the pitch apex at mid-face.
    """
    aside = ", seen at R_m" if seen else ""
    gears = mesh.pinion, mesh.wheel
    starts = [active[0] for active in mesh.active_cones]
    angles = (
        ("pitch angle delta [deg]", [gear.pitch_angle for gear in gears]),
        (f"face angle delta_a{aside} [deg]", [gear.tip_angle for gear in gears]),
        ("start of active profile, cone angle [deg]", starts),
        ("root form cone angle [deg]", [gear.form_angle for gear in gears]),
        (f"root angle delta_f{aside} [deg]", [gear.root_cone_angle for gear in gears]),
        ("base cone angle delta_b [deg]", [gear.base_angle for gear in gears]),
    )
    lengths = (
        ()
        if seen
        else (
            (
                "outer pitch diameter d_e [mm]",
                [2.0 * gear.outer_cone_distance * sin(gear.pitch_angle) for gear in gears],
            ),
            ("mean pitch diameter d_m [mm]", [2.0 * gear.mean_cone_distance * sin(gear.pitch_angle) for gear in gears]),
            ("mean addendum h_am [mm]", [_height(gear, gear.tip_angle) for gear in gears]),
            ("mean dedendum h_fm [mm]", [-_height(gear, gear.root_cone_angle) for gear in gears]),
        )
    )
    interference = [start - gear.form_angle < ROUNDING for start, gear in zip(starts, gears, strict=True)]
    return [
        *((label, *(fixed(degrees(value), 4) for value in values)) for label, values in angles),
        *((label, *(fixed(value, 4) for value in values)) for label, values in lengths),
        ("mating tip reaches below the form cone", *("yes" if below else "no" for below in interference)),
    ]


def depth_rows(mesh: BevelMesh) -> list[Row]:
    """Depth of teeth without a blank beside that of ISO 23509, 2 m_mn."""
    depth = _height(mesh.pinion, mesh.pinion.tip_angle) + _height(mesh.wheel, mesh.wheel.tip_angle)
    standard = 2.0 * mesh.pinion.mean_normal_module
    return [("working depth at mid-face h_mw; after ISO 23509 [mm]", fixed(depth, 4), fixed(standard, 4))]


def _height(gear: BevelGear, cone_angle: float) -> float:
    """Height of a cone over the pitch cone, across the pitch cone at mid-face [mm]."""
    return gear.mean_cone_distance * tan(cone_angle - gear.pitch_angle)
