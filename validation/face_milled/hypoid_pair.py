"""Hypoid pair 13/42 of ``examples/scenes``, beside its five contact equations and the numbers of ISO/TR 10300-30.

What :mod:`validation.face_milled.hypoid_axes` gets are the numbers of the scene file, and of the pitch cones what
closes the axes: the pitch angle of the pinion to all digits. Transmission errors are absolute, counted where both
flanks hold P, so that placement and phases of the gears are judged too; they agree within what B-splines miss flanks
by, some 1e-7 arcsec.

The sample of the report rates the pair by formulas of virtual cylindrical gears. Its forces are those of a pair that
touches in P with the spiral and pressure angles of the sheet, as this one does. Its radius of relative curvature rests
on a contact line that depends on angles alone, not on the cutter; surfaces of an offset pair have a smaller one. That
both are one as the offset goes to zero is a row of its own.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from math import asin, atan, atan2, cos, degrees, hypot, radians, sin, tan
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from loaded_tca.flanks.face_milled import GeneratedFlank, conjugate_flank
from loaded_tca.gears import (
    Blade,
    Cutter,
    FaceMilledBlank,
    FaceMilledGear,
    HypoidBlank,
    MachineSettings,
    pitch_cones_by_method_1,
)
from loaded_tca.pairs.bevel import BevelMounting, face_milled_pair
from loaded_tca.reference.iso10300_1 import VirtualPair
from loaded_tca.scene import read_scene
from loaded_tca.unloaded import relative_curvature, trace_contact
from validation.face_milled.hypoid_axes import Errors, Housing, Sheet, Surface
from validation.table import Row

SCENE = Path(__file__).parents[2] / "examples" / "scenes" / "hypoid_13x42.toml"
CASE, EQUATIONS, REPORT = "hypoid pair 13/42", "five equations", "ISO/TR 10300-30, sample 2"
ARCSEC = degrees(3600.0)
PARTS = np.array([-0.5, -0.25, 0.0, 0.25, 0.5])
LEFT, ASKED = 1e-6, 1e-6
"""Largest differences of transmission errors [arcsec] and places [mm]: three times what B-splines leave."""
ACROSS, ALONG = 5e-8, 2e-6
"""Relative, of curvatures by differences over a stencil of 0.1 mm with their leading error taken off."""
EDGE_PARTS = (-0.95, -1.2)
"""Of a pitch, where tips are in contact with the pinion's flank."""


@dataclass(frozen=True)
class State:
    """One side of the pair, with mounting errors.

    Attributes
    ----------
    name : str
    flank : str
        Of the pinion.
    errors : Errors
    """

    name: str
    flank: str = "concave"
    errors: Errors = Errors()


STATES = (
    State("drive"),
    State("coast", "convex"),
    State("E 0.03", errors=Errors(offset=0.03)),
    State("P -0.05", errors=Errors(pinion=-0.05)),
    State("G 0.04", errors=Errors(wheel=0.04)),
    State("Sigma 0.02 deg", errors=Errors(angle=radians(0.02))),
    State("coast, all errors", "convex", Errors(-0.02, 0.03, -0.04, radians(-0.02))),
)


def rows() -> list[Row]:
    """Path, transmission error, curvatures, a tip edge, then the report."""
    return [*(row for state in STATES for row in _of_state(state)), *_edge_rows(), *_report_rows()]


def short_rows() -> list[Row]:
    """The drive side, and the report."""
    return [*_of_state(STATES[0]), *_report_rows()]


@cache
def _file() -> dict[str, Any]:
    return tomllib.loads(SCENE.read_text(encoding="utf-8"))


@cache
def _sheet() -> Sheet:
    """Sheet of the file; the pitch angle of the pinion that closes the axes, by halving."""
    file = _file()
    pinion, wheel = (file[gear]["blank"] for gear in ("pinion", "wheel"))
    distances = pinion["calculation_cone_distance_mm"], wheel["calculation_cone_distance_mm"]
    second, offset = radians(wheel["pitch_angle_deg"]), file["pair"]["offset_mm"]

    def open_by(first: float) -> float:
        """How far the axes miss a right angle: sin(delta_1) sin(delta_2) = cos(delta_1) cos(delta_2) cos(zeta_mp)."""
        reach = distances[1] * sin(second) + distances[0] * sin(first) * cos(second) / cos(first)
        zeta = asin(offset / reach / cos(first))
        return tan(first) * tan(second) - cos(zeta)

    low, high = (radians(pinion["pitch_angle_deg"]) + step for step in (-1e-4, 1e-4))
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if open_by(middle) < 0.0 else (low, middle)
    return Sheet((13, 42), offset, (0.5 * (low + high), second), distances)


def _surface(gear: str, flank: str) -> Surface:
    """Surface of a gear after the numbers of the file."""
    file = _file()[gear]
    machine, blade = file["machine"], file["cutter"][flank]
    settings = {
        name: machine.get(f"{name}_mm", 0.0)
        for name in ("radial", "machine_centre_to_back", "sliding_base", "blank_offset")
    }
    settings |= {
        name: radians(machine.get(f"{name}_deg", 0.0)) for name in ("cradle_angle", "root_angle", "tilt", "swivel")
    }
    settings |= {
        "ratio_of_roll": machine["ratio_of_roll"],
        "helical_motion": machine.get("helical_motion_mm_per_rad", 0.0),
        "point_radius": blade["point_radius_mm"],
        "blade_angle": radians(blade["blade_angle_deg"]),
    }
    return Surface(flank == "concave", file["blank"]["hand"] == "left", settings)


def _housing(state: State) -> Housing:
    mating = "convex" if state.flank == "concave" else "concave"
    surfaces = _surface("pinion", state.flank), _surface("wheel", mating)
    return Housing(_sheet(), *surfaces, state.errors)


def _of_state(state: State) -> list[Row]:
    """Differences over a pitch, and the curvatures where P is held."""
    scene = read_scene(SCENE)
    errors, housing = state.errors, _housing(state)
    changes = {
        "pair.pinion_flank": state.flank,
        "mounting.offset_mm": errors.offset,
        "mounting.pinion_axial_mm": errors.pinion,
        "mounting.wheel_axial_mm": errors.wheel,
        "mounting.shaft_angle_error_deg": degrees(errors.angle),
    }
    bare = {f"{gear}.modifications": {} for gear in ("pinion", "wheel")}
    pair, mesh = scene.with_changes(changes | bare).pair(), scene.mesh()
    angles = PARTS * pair.pitch
    path = trace_contact(pair, angles, warn=False)
    contacts = _traced(housing, pair.sense * angles)
    error = pair.sense * np.array([one[6] for one in contacts]) - pair.ratio * angles
    miss = float(np.abs(path.transmission_error - error).max()) * ARCSEC
    apexes = mesh.cones.apexes
    found = np.array(
        [path.pinion_radius, path.pinion_axial - apexes[0], path.wheel_radius, path.wheel_axial - apexes[1]]
    ).T
    off = float(np.abs(found - [housing.places(one) for one in contacts]).max())
    case = f"{CASE}, {state.name}"
    middle = len(PARTS) // 2
    span = float(np.ptp(error)) * ARCSEC
    exact = face_milled_pair(
        *mesh.gears,
        pinion_flank=state.flank,  # type: ignore[arg-type]
        offset=scene.geometry.offset_mm,
        mounting=BevelMounting(errors.offset, errors.pinion, errors.wheel, errors.angle),
        exact=True,
    )
    relative = relative_curvature(exact, trace_contact(exact, [0.0], warn=False)[0])
    bends = _curvatures(housing, contacts[middle])
    return [
        Row(case, EQUATIONS, "TE over a pitch, largest difference [arcsec]", 0.0, miss, LEFT, note=f"of {span:.2f}"),
        Row(case, EQUATIONS, "places on both flanks, largest difference [mm]", 0.0, off, ASKED),
        Row(case, EQUATIONS, "relative curvature across [1/mm]", bends[0], relative.across, ACROSS),
        Row(case, EQUATIONS, "relative curvature along [1/mm]", bends[1], relative.along, ALONG),
    ]


def _traced(housing: Housing, turns: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """Contacts at turns of the pinion, each from its neighbour nearer to P, in small steps."""
    contacts: dict[int, NDArray[np.float64]] = {}
    middle = len(turns) // 2
    for way in (1, -1):
        start, at = housing.contact(float(turns[middle])), float(turns[middle])
        contacts[middle] = start
        for place in range(middle + way, len(turns) if way > 0 else -1, way):
            for turn in np.linspace(at, turns[place], 4)[1:]:
                start = housing.contact(float(turn), start)
            at = float(turns[place])
            contacts[place] = start
    return [contacts[place] for place in range(len(turns))]


def _curvatures(housing: Housing, contact: NDArray[np.float64]) -> NDArray[np.float64]:
    """Principal relative curvatures where P is held, the error of differences of second order taken off."""
    wide, narrow = (housing.curvatures(0.0, contact, step) for step in (0.1, 0.05))
    return np.asarray((4.0 * narrow - wide) / 3.0)


def _edge_rows() -> list[Row]:
    """Contact of the wheel's tip on the pinion's flank, before the path begins."""
    scene = read_scene(SCENE).with_changes({f"{gear}.modifications": {} for gear in ("pinion", "wheel")})
    pair, housing, blank = scene.pair(), _housing(STATES[0]), _file()["wheel"]["blank"]
    cone = radians(blank["face_angle_deg"]), blank["face_apex_mm"]
    angles = np.array(EDGE_PARTS) * pair.pitch
    path = trace_contact(pair, angles, warn=False)
    start = housing.contact(0.0)
    for part in np.linspace(0.0, EDGE_PARTS[0], 9):
        start = housing.contact(float(pair.sense * part * pair.pitch), start)
    lines = []
    for part, angle, error, edge in zip(EDGE_PARTS, angles, path.transmission_error, path.on_edge, strict=True):
        start = housing.edge_contact(pair.sense * float(angle), cone, start)
        expected = (pair.sense * start[6] - pair.ratio * angle) * ARCSEC
        quantity = f"TE on the wheel's tip, {part:g} pitches from P [arcsec]"
        off = float(error) * ARCSEC - expected
        note = f"of {expected:.2f}{'' if edge else ', not on an edge'}"
        lines.append(Row(f"{CASE}, drive", EQUATIONS, quantity, 0.0, off, LEFT, note=note))
    return lines


def _report_rows() -> list[Row]:
    """Forces and contact ratios of the report, its radius of curvature by its formula and of surfaces."""
    scene = read_scene(SCENE)
    forces = {label: float(value) for label, value in scene.force_rows([250e3])}
    blank, virtual = _annex_f3(15.0, radians(50.0))
    profile, lengthwise = virtual.contact_ratios
    radius, line = _surfaces(blank)
    small = _annex_f3(0.01, radians(38.0))
    rounded = "sheet to all digits"
    return [
        Row(CASE, REPORT, "F_mt1 [N]", 9366.1, forces["mean tangential force F_mt [N]"], 1e-5),
        Row(CASE, REPORT, "F_n [N]", 15298.7, forces["normal force F_n [N]"], 2e-5),
        Row(CASE, REPORT, "eps_v_alpha", 1.010, profile, 5e-4, rounded),
        Row(CASE, REPORT, "eps_v_beta", 2.096, lengthwise, 3e-4, rounded),
        Row(CASE, REPORT, "rho_t [mm], by formula", 19.924, virtual.normal_radius, 5e-5, rounded),
        Row(CASE, REPORT, "beta_B [deg], by formula", 18.459, degrees(virtual.contact_line_angle), 5e-5, rounded),
        Row(CASE, REPORT, "rho_rel [mm], by formula", 17.926, virtual.relative_radius, 5e-5, rounded),
        Row(CASE, REPORT, "rho_rel [mm], of surfaces", 17.926, radius, None, note="the formula knows no cutter"),
        Row(CASE, REPORT, "beta_B [deg], of surfaces", 18.459, line, None, note="likewise"),
        Row(
            f"{CASE}, a 0.01",
            "ISO 10300-1, A.37",
            "rho_rel [mm], of surfaces",
            small[1].relative_radius,
            _surfaces(small[0])[0],
            1e-4,
            note="the formula is exact as the offset goes",
        ),
    ]


def _annex_f3(offset: float, pinion_spiral: float) -> tuple[HypoidBlank, VirtualPair]:
    """Second pair of annex F of ISO 23509, teeth of uniform depth, and its virtual cylindrical gears."""
    parameters = pitch_cones_by_method_1((13, 42), offset, 170.0, 30.0, pinion_spiral, 63.5)
    blank = HypoidBlank((13, 42), parameters, 30.0, 63.5, profile_shift=0.3, taper="uniform")
    cones = parameters.cones
    virtual = VirtualPair(
        cones.pitch_angles,
        cones.mean_cone_distances,
        parameters.spiral_angles,
        (cones.axial_offset_angle, cones.offset_angle),
        blank.generated_pressure_angles[0],
        blank.limit_pressure_angle,
        blank.mean_normal_module,
        blank.mean_addenda,
        0.85 * blank.face_width,
    )
    return blank, virtual


def _surfaces(blank: HypoidBlank) -> tuple[float, float]:
    """Radius [mm] of relative curvature across the line of contact at P, and the line's angle to the tooth [deg].

    The wheel is generated by the straight blade of a cutter upright on the pitch plane; the pinion is its conjugate.
    """
    gear, cones, radius = blank.wheel, blank.cones, blank.cutter_radius
    toe, mean, heel = gear.cone_distances
    beyond, spiral = cones.apexes[1], gear.spiral_angles[1]
    outline = FaceMilledBlank(
        heel,
        heel - toe,
        gear.pitch_angle,
        gear.face_angle,
        gear.root_angle,
        "left",
        gear.face_apex - beyond,
        gear.root_apex - beyond,
        mean,
    )
    across, ahead = radius * cos(spiral), mean - radius * sin(spiral)
    machine = MachineSettings(
        radial=hypot(across, ahead),
        cradle_angle=atan2(across, ahead),
        root_angle=gear.root_angle,
        ratio_of_roll=1.0 / sin(gear.pitch_angle),
        sliding_base=outline.root_apex * sin(gear.root_angle),
    )
    pressure = blank.generated_pressure_angles[0]
    blade = Blade(radius + gear.mean_dedendum * tan(pressure), pressure)
    flank = GeneratedFlank(FaceMilledGear(blank.teeth[1], outline, Cutter(convex=blade), machine, "wheel"), "convex")
    return _across_the_line(blank, flank)


def _across_the_line(blank: HypoidBlank, wheel: GeneratedFlank) -> tuple[float, float]:
    """Curvature of the conjugate pinion less that of the wheel at P, from second derivatives of both."""
    cones, frame = blank.cones, blank.cones.frame(1)
    delta, mean = cones.pitch_angles[0], cones.mean_cone_distances[0]
    rho, z = mean * sin(delta), mean * cos(delta)
    slopes, bends = conjugate_flank(wheel, frame, blank.teeth[0] / blank.teeth[1], rho, z)
    pinion = _tensor(rho, *slopes, *bends)
    second, far = cones.pitch_angles[1], cones.mean_cone_distances[1]
    at = np.array([far * sin(second)]), np.array([far * cos(second)])
    theta = wheel.theta(*at)
    on_wheel = _tensor(float(at[0][0]), theta.rho[0], theta.z[0], *(part[0] for part in theta.bends))
    normal, one = pinion
    other = frame.axes.T @ on_wheel[1] @ frame.axes
    # both tensors in the frame of the pinion, P at azimuth 0 on either gear; flanks face each other
    values, directions = np.linalg.eigh(one - other * np.sign((frame.axes.T @ on_wheel[0]) @ normal))
    across = int(np.argmax(np.abs(values)))
    plane = np.array([cos(delta), 0.0, -sin(delta)])
    tooth = np.cross(normal, plane)
    tooth /= np.linalg.norm(tooth)
    line = np.cross(normal, directions[:, across])
    return 1.0 / abs(float(values[across])), degrees(
        atan(abs(float(line @ np.cross(normal, tooth)) / float(line @ tooth)))
    )


def _tensor(
    rho: float, by_rho: float, by_z: float, rho_rho: float, rho_z: float, z_z: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Unit normal (3,) and curvature tensor (3, 3) of theta = Theta(rho, z) at azimuth 0, along x, y, z [1/mm]."""
    gradient = np.array([-by_rho, 1.0 / rho, -by_z])
    bends = np.array(
        [
            [-rho_rho, -1.0 / rho**2, -rho_z],
            [-1.0 / rho**2, -by_rho / rho, 0.0],
            [-rho_z, 0.0, -z_z],
        ]
    )
    size = float(np.linalg.norm(gradient))
    normal = gradient / size
    flat = np.eye(3) - np.outer(normal, normal)
    return normal, flat @ bends @ flat / size
