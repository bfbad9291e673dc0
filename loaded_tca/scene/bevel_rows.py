"""What there is to tell of two bevel gears before any contact is computed."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan, cos, degrees, sin, tan

import numpy as np

from loaded_tca.flanks.base import Flank, outward_normal
from loaded_tca.gears.bevel import BevelGear, BevelMesh
from loaded_tca.scene.model import Row

ROUNDING = 1e-9
"""Cone angles closer than this [rad] are the same."""


def geometry_rows(mesh: BevelMesh, hands: tuple[str, str], sides: tuple[str, str]) -> list[Row]:
    """Lines on the mesh, then on both gears; hands and sides in contact are words."""
    names = [
        ("", "pinion", "wheel"),
        ("teeth z", str(mesh.pinion.teeth), str(mesh.wheel.teeth)),
        ("hand of the spiral", *(hands if mesh.pinion.spiral_angle else ("none", "none"))),
        ("flank in contact", *sides),
    ]
    return [*_mesh_rows(mesh), *names, *_gear_rows(mesh)]


def _mesh_rows(mesh: BevelMesh) -> list[Row]:
    gear = mesh.pinion
    distances = (gear.outer_cone_distance, gear.mean_cone_distance, gear.inner_cone_distance)
    mean_module = gear.mean_normal_module / cos(gear.spiral_angle)
    normal_angle = atan(tan(gear.pressure_angle) * cos(gear.spiral_angle))
    total = mesh.transverse_contact_ratio + mesh.overlap_ratio
    return [
        ("shaft angle Sigma [deg]", f"{degrees(mesh.shaft_angle):.4f}"),
        ("cone distances R_e, R_m, R_i [mm]", *(f"{distance:.4f}" for distance in distances)),
        ("transverse modules m_et, m_mt [mm]", f"{gear.outer_module:.4f}", f"{mean_module:.4f}"),
        ("mean normal module m_mn [mm]", f"{gear.mean_normal_module:.4f}"),
        ("mean spiral angle beta_m [deg]", f"{degrees(abs(gear.spiral_angle)):.4f}"),
        (
            "pressure angles alpha_t, alpha_n [deg]",
            f"{degrees(gear.pressure_angle):.4f}",
            f"{degrees(normal_angle):.4f}",
        ),
        ("transverse contact ratio eps_alpha", f"{mesh.transverse_contact_ratio:.4f}"),
        ("overlap ratio eps_beta", f"{mesh.overlap_ratio:.4f}"),
        ("total contact ratio eps_gamma", f"{total:.4f}"),
        ("face width b [mm]", f"{gear.face_width:.4f}"),
    ]


def _gear_rows(mesh: BevelMesh) -> list[Row]:
    gears = (mesh.pinion, mesh.wheel)
    starts = [active[0] for active in mesh.active_cones]
    angles = (
        ("pitch angle delta [deg]", [gear.pitch_angle for gear in gears]),
        ("face angle delta_a [deg]", [gear.tip_angle for gear in gears]),
        ("start of active profile, cone angle [deg]", starts),
        ("root form cone angle [deg]", [gear.form_angle for gear in gears]),
        ("root angle delta_f [deg]", [gear.root_cone_angle for gear in gears]),
        ("base cone angle delta_b [deg]", [gear.base_angle for gear in gears]),
    )
    lengths = (
        ("outer pitch diameter d_e [mm]", [2.0 * gear.outer_cone_distance * sin(gear.pitch_angle) for gear in gears]),
        ("mean pitch diameter d_m [mm]", [_mean_diameter(gear) for gear in gears]),
        ("mean addendum h_am [mm]", [_height(gear, gear.tip_angle) for gear in gears]),
        ("mean dedendum h_fm [mm]", [-_height(gear, gear.root_cone_angle) for gear in gears]),
    )
    interference = [start - gear.form_angle < ROUNDING for start, gear in zip(starts, gears, strict=True)]
    return [
        *((label, *(f"{degrees(value):.4f}" for value in values)) for label, values in angles),
        *((label, *(f"{value:.4f}" for value in values)) for label, values in lengths),
        ("mating tip reaches below the form cone", *("yes" if below else "no" for below in interference)),
    ]


def _mean_diameter(gear: BevelGear) -> float:
    return 2.0 * gear.mean_cone_distance * sin(gear.pitch_angle)


def _height(gear: BevelGear, cone_angle: float) -> float:
    """Height of a cone over the pitch cone, across the pitch cone at mid-face [mm]."""
    return gear.mean_cone_distance * tan(cone_angle - gear.pitch_angle)


Point = tuple[float, float]
"""(rho, z) [mm]."""


def pitch_point(cone_distance: float, pitch_angle: float) -> Point:
    """Point of the pitch cone at a cone distance."""
    return cone_distance * sin(pitch_angle), cone_distance * cos(pitch_angle)


def force_rows(flanks: tuple[Flank, Flank], points: tuple[Point, Point], torques: Sequence[float]) -> list[Row]:
    """Forces at the mean pitch points of pinion and wheel under pinion torques [N mm], a cell for each.

    One tooth pair carries all.
    """
    pinion, wheel = (_unit_force(flank, point) for flank, point in zip(flanks, points, strict=True))
    rows = (
        ("mean tangential force F_mt [N]", pinion[1]),
        ("normal force F_n [N]", 1.0),
        ("axial force on the pinion, from its apex [N]", -pinion[2]),
        ("radial force on the pinion, to its axis [N]", pinion[0]),
        ("axial force on the wheel, from its apex [N]", -wheel[2]),
        ("radial force on the wheel, to its axis [N]", wheel[0]),
    )
    normal_forces = [torque / (points[0][0] * pinion[1]) for torque in torques]
    return [(label, *(f"{part * force:.1f}" for force in normal_forces)) for label, part in rows]


def _unit_force(flank: Flank, point: Point) -> tuple[float, float, float]:
    """Normal out of a flank at a point: radial, tangential (positive) and axial part."""
    normal = outward_normal(flank, np.array(point[0]), np.array(point[1]))
    return float(normal[0]), abs(float(normal[1])), float(normal[2])
