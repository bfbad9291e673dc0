"""What there is to tell of two cylindrical gears before any contact is computed."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

from loaded_tca.errors import GeometryError
from loaded_tca.gears import CylindricalMesh
from loaded_tca.scene.model import Row


def geometry_rows(mesh: CylindricalMesh, hands: tuple[str, str]) -> list[Row]:
    """Lines on the mesh, then on both gears."""
    return [*_mesh_rows(mesh), *_gear_rows(mesh, hands)]


def force_rows(mesh: CylindricalMesh, torques: Sequence[float]) -> list[Row]:
    """Forces under pinion torques [N mm], a cell for each."""
    return [
        ("base tangential force F_bt [N]", *(f"{mesh.base_tangential_force(torque):.1f}" for torque in torques)),
        ("normal force F_bn [N]", *(f"{mesh.normal_force(torque):.1f}" for torque in torques)),
    ]


def overlaps(mesh: CylindricalMesh, error: float) -> Iterator[str]:
    """Sentences on teeth that overlap, at the nominal centre distance and with an error of it [mm]."""
    yield from _overlap(mesh, "centre distance")
    if error:
        distance = mesh.working_centre_distance + error
        try:
            yield from _overlap(replace(mesh, centre_distance=distance), "mounted centre distance")
        except GeometryError as problem:
            yield f"at the mounted centre distance of {distance:.4f} mm: {problem}"


def _overlap(mesh: CylindricalMesh, which: str) -> Iterator[str]:
    backlash = _backlash(mesh)
    if backlash < 0.0:
        overlap = f"teeth overlap by {-backlash:.4f} mm at the {which} of {mesh.working_centre_distance:.4f} mm"
        yield f"{overlap}: backlash is not part of the analysis"


def _backlash(mesh: CylindricalMesh) -> float:
    """Backlash [mm], zero where it is rounding."""
    return mesh.backlash if abs(mesh.backlash) > 1e-9 * mesh.pinion.normal_module else 0.0


def _mesh_rows(mesh: CylindricalMesh) -> list[Row]:
    path = mesh.path_of_contact
    return [
        ("working centre distance a_w [mm]", f"{mesh.working_centre_distance:.4f}"),
        ("working pressure angle alpha_wt [deg]", f"{math.degrees(mesh.working_pressure_angle):.4f}"),
        ("backlash j_wt at the working circles [mm]", f"{_backlash(mesh):.4f}"),
        ("transverse contact ratio eps_alpha", f"{mesh.transverse_contact_ratio:.4f}"),
        ("overlap ratio eps_beta", f"{mesh.overlap_ratio:.4f}"),
        ("total contact ratio eps_gamma", f"{mesh.total_contact_ratio:.4f}"),
        ("path of contact: length AE, approach AC [mm]", f"{path.AE:.4f}", f"{path.AC:.4f}"),
        ("common face width b [mm]", f"{mesh.common_face_width:.4f}"),
    ]


def _gear_rows(mesh: CylindricalMesh, hands: tuple[str, str]) -> list[Row]:
    gears = (mesh.pinion, mesh.wheel)
    active = (mesh.pinion_active_profile, mesh.wheel_active_profile)
    diameters = (
        ("reference diameter d [mm]", [gear.reference_radius for gear in gears]),
        ("base diameter d_b [mm]", [gear.base_radius for gear in gears]),
        ("working diameter d_w [mm]", [mesh.pinion_working_radius, mesh.wheel_working_radius]),
        ("tip diameter d_a [mm]", [gear.tip_radius for gear in gears]),
        *_single_contact(mesh),
        ("start of active profile d_Nf [mm]", [profile.start_radius for profile in active]),
        ("root form diameter d_Ff [mm]", [gear.form_radius for gear in gears]),
        ("root diameter d_f [mm]", [gear.root_radius for gear in gears]),
    )
    return [
        ("", "pinion", "wheel"),
        ("teeth z", *(str(gear.teeth) for gear in gears)),
        ("hand of the helix", *(hands if mesh.pinion.helix_angle else ("none", "none"))),
        *((label, *(f"{2.0 * radius:.4f}" for radius in radii)) for label, radii in diameters),
        (
            "mating tip reaches below d_Ff",
            *("yes" if profile.fillet_interference else "no" for profile in active),
        ),
    ]


def _single_contact(mesh: CylindricalMesh) -> list[tuple[str, list[float]]]:
    """Radii between which one tooth pair of the transverse section touches; nothing where always two or none do."""
    if not 1.0 <= mesh.transverse_contact_ratio < 2.0:
        return []
    path = mesh.path_of_contact
    at_b, at_d = (
        [mesh.pinion.radius_at_roll_length(point), mesh.wheel.radius_at_roll_length(path.T2 - point)]
        for point in (path.B, path.D)
    )
    return [
        ("highest single tooth contact (D | B) [mm]", [at_d[0], at_b[1]]),
        ("lowest single tooth contact (B | D) [mm]", [at_b[0], at_d[1]]),
    ]
