"""What a scene amounts to before any contact is computed: its geometry, its load, and what departs from nominal."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

from loaded_tca.errors import GeometryError
from loaded_tca.gears import CylindricalMesh
from loaded_tca.scene import Modifications, MountingErrors, Scene
from loaded_tca.scene.section import Section, contents

MOST_TORQUES = 4
"""Torques that have a column each; of more, the least and the largest are shown."""
LABEL = 44

Row = tuple[str, ...]
"""Label and cells of a line."""


def describe_scene(scene: Scene) -> str:
    """Return the geometry and the load of a scene, a line each, with notes on what the analysis leaves out.

    Raises
    ------
    InputError, GeometryError
        If the gears of the scene cannot exist or cannot mesh.
    """
    mesh, pair = scene.mesh(), scene.pair()
    cap = [] if pair.max_pressure is None else [("cap on the pressure [MPa]", f"{pair.max_pressure:g}")]
    rows = [*_mesh_rows(mesh), *_gear_rows(scene, mesh), *_load_rows(scene, mesh), *cap, *_departures(scene)]
    lines = [f"{label:<{LABEL}}" + "".join(f"{cell:>14}" for cell in cells) for label, *cells in rows]
    return "\n".join([scene.title or "Scene", *lines, *(f"note: {note}" for note in _notes(scene, mesh))])


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


def _backlash(mesh: CylindricalMesh) -> float:
    """Backlash [mm], zero where it is rounding."""
    return mesh.backlash if abs(mesh.backlash) > 1e-9 * mesh.pinion.normal_module else 0.0


def _gear_rows(scene: Scene, mesh: CylindricalMesh) -> list[Row]:
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
    hands = ("none", "none")
    if scene.geometry.helix_angle_deg:
        hands = ("right", "left") if scene.pinion_hand == "right" else ("left", "right")
    return [
        ("", "pinion", "wheel"),
        ("teeth z", *(str(gear.teeth) for gear in gears)),
        ("hand of the helix", *hands),
        *((label, *(f"{2.0 * radius:.4f}" for radius in radii)) for label, radii in diameters),
        ("mate's tip reaches below d_Ff", *("yes" if profile.fillet_interference else "no" for profile in active)),
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


def _load_rows(scene: Scene, mesh: CylindricalMesh) -> list[Row]:
    torques: Sequence[float] = scene.torques
    if len(torques) > MOST_TORQUES:
        torques = (min(torques), max(torques))
    label = "pinion torque" if len(torques) == len(scene.torques) else f"{len(scene.torques)} pinion torques from, to"
    return [
        (f"{label} [N m]", *(f"{1e-3 * torque:g}" for torque in torques)),
        ("base tangential force F_bt [N]", *(f"{mesh.base_tangential_force(torque):.1f}" for torque in torques)),
        ("normal force F_bn [N]", *(f"{mesh.normal_force(torque):.1f}" for torque in torques)),
    ]


def _departures(scene: Scene) -> Iterator[Row]:
    """Mounting errors and modifications that a scene asks for, by their keys."""
    errors = _changed(scene.mounting, MountingErrors(), "mounting.")
    yield from errors or [("mounting errors", "none")]
    plain = Modifications()
    for name, gear in (("pinion", scene.pinion), ("wheel", scene.wheel)):
        changed = _changed(gear.modifications, plain, f"{name}.modifications.")
        yield from changed or [(f"{name}.modifications", "none")]


def _changed(section: Section, default: Section, place: str) -> list[Row]:
    usual = contents(default)
    return [(place + key, f"{value}") for key, value in contents(section).items() if value != usual[key]]


def _notes(scene: Scene, mesh: CylindricalMesh) -> Iterator[str]:
    """Sentences on teeth that overlap, at the nominal and at the mounted centre distance."""
    yield from _overlap(mesh, "centre distance")
    error = scene.mounting.centre_distance_error_mm
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
