"""Tooth root stress by the finite elements of the package beside a plane reference, and how far its mesh is converged.

The reference: plane finite elements of quadratic triangles, the whole ring of a spur pinion 25 of 25/37, m 3, bore 0.55
of the root diameter, plane strain, refined until nothing moves by 0.02 %; in space 20 mm wide, under an even line load
at the highest point of single contact. Where there is no reference, finer meshes of the same elements are: they have
the largest stresses of the reference to 0.05 %.

As a script, a table of error, time and memory against the mesh; each model in a process of its own. Run from the root
of the repository: ``python -m validation.loaded.root_stress``.
"""

import math
import multiprocessing
import resource
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from loaded_tca.arrays import Array
from loaded_tca.compliance import FlankLine, MeshDensity, RootStress
from loaded_tca.compliance.body import ToothFrame, factorised, gear_nodes
from loaded_tca.compliance.finite_elements import discretise
from loaded_tca.compliance.root_stress import (
    BEST,
    DENSITY,
    OUTLINE,
    first_told,
    root_influence,
    stress_density,
    tangent_angles,
)
from loaded_tca.flanks.base import outward_normal
from loaded_tca.gears import CylindricalGear, CylindricalMesh, bevel_mesh
from loaded_tca.pairs.bevel import bevel_pair
from loaded_tca.pairs.cylindrical import cylindrical_pair
from loaded_tca.pairs.gear import Gear
from loaded_tca.scene import read_scene
from loaded_tca.tooth.profile import polar
from validation.table import Row

SCENES = Path(__file__).parents[2] / "examples" / "scenes"
MOST_LAYERS = 8
"""Across the faces of gears that are compared with finer meshes. These have half as many more; or as many, where the
face asks for more than that: there the sections alone are compared."""
CASE, SOURCE, FINER = "root stress", "plane finite elements, quadratic triangles", "finer mesh of the same elements"
LINE_LOAD = 100.0
"""Of the reference [N/mm]."""
LOADED_AT = ("tip", "HPSTC", "pitch point", "LPSTC")
TENSION, TENSION_ANGLE = (124.32, 85.35, 80.31, 75.82), (28.3, 38.1, 39.9, 42.0)
COMPRESSION, COMPRESSION_ANGLE = (-152.81, -100.64, -91.63, -81.63), (27.7, 37.3, 39.7, 42.8)
NEIGHBOURS = (-37.8, 34.9)
"""Loaded fillet of tooth -1 and back of tooth +1 under a load on tooth 0 at its HPSTC [MPa]: low down, beside the end
of the fillet, where the stress has a bend; a mesh four times as fine has -37.2 and 35.1."""
MIDDLE, END = 1.043, 0.729
"""In space over plane: in the middle of the face and at its ends."""
UNIT, CURVE, IN_SPACE, AT_END, CONVERGED, OTHER_FAMILIES = 0.01, 0.03, 0.015, 0.03, 0.01, 0.02
ANGLE = 1.5
"""Stress near its maximum is flat: 1.5 deg off the place it falls by 0.1 % [deg]."""
FINE = MeshDensity(through=12, flank=12, fillet=8, land=8, rim=9, lengthwise=1, grading=1.8, skin=0.015 / math.pi)
NINE = (
    (16, 0.4, 0.25),
    (16, 0.1, 0.38),
    (20, 0.0, 0.3),
    (25, 0.4, 0.38),
    (25, -0.1, 0.25),
    (40, 0.2, 0.3),
    (40, -0.1, 0.38),
    (80, 0.4, 0.25),
    (80, 0.0, 0.38),
)
"""Teeth, profile shift, radius of the rack's tip in modules."""
HEIGHTS = (0.4, 0.7, 1.0)
"""Parts of the flank's height at which they are loaded."""


def spur_pair_gear(
    teeth: int = 25, width: float = 20.0, shift: float = 0.0, rounding: float = 0.38, helix_deg: float = 0.0
) -> Gear:
    """Pinion of module 3 beside a wheel of 37 teeth."""
    pinion, wheel = (
        CylindricalGear(z, 3.0, width, helix_angle=math.radians(beta), profile_shift=x, root_radius_coefficient=rho)
        for z, beta, x, rho in ((teeth, helix_deg, shift, rounding), (37, -helix_deg, 0.0, 0.38))
    )
    return cylindrical_pair(CylindricalMesh(pinion, wheel)).pinion


def loaded_radii() -> Array:
    """Radii of the pinion of the reference at which it is loaded: those of ``LOADED_AT`` [mm]."""
    mesh = CylindricalMesh(*(CylindricalGear(z, 3.0, 20.0) for z in (25, 37)))
    gear, path = mesh.pinion, mesh.path_of_contact
    tip = gear.roll_length(gear.tip_radius)
    rolls = tip, tip - path.AE + gear.base_pitch, tip - path.AE + path.AC, tip - gear.base_pitch
    return np.array([gear.radius_at_roll_length(roll) for roll in rolls])


@dataclass(frozen=True, eq=False)
class Curve:
    """Stress along one side of a tooth, from where it is told: angle (n,) [rad], stress (n, loads) [MPa]."""

    angle: Array
    stress: Array

    def largest(self, sign: int) -> tuple[Array, Array]:
        """Largest tension (+1) or compression (-1) under every load, and where [deg]."""
        place = (sign * self.stress).argmax(axis=0)
        return self.stress[place, np.arange(self.stress.shape[1])], np.degrees(self.angle[place])


def plane_curves(gear: Gear, density: MeshDensity, radii: Array, tooth: int = 0) -> tuple[Curve, Curve]:
    """Stress on the side in contact and the back of tooth 0 of a section under 1 N/mm on a tooth, strain being plane.

    Its mesh is that of the model in space.
    """
    nodes = gear_nodes(gear, density, OUTLINE)
    layout, middle = nodes.layout, nodes.radius.shape[2] // 2
    mesh = discretise(polar(nodes.radius[:, :, middle], nodes.angle[:, :, middle]), layout.elements)
    factor, _ = factorised(mesh, gear.material, mesh.number[:, 0])
    found = factor.solve(_plane_loads(gear, nodes, mesh, radii, tooth))
    which = {tuple(place): n for n, place in enumerate(mesh.lowest.tolist())}
    curves = []
    for side in (gear.flank.side, -gear.flank.side):
        lowest, ends = (np.repeat(part, 2, axis=0) for part in layout.foot(side))
        part = np.tile(BEST, len(lowest) // 2)
        spots = ends[:, 0] + part[:, None] * (ends[:, 1] - ends[:, 0])
        elements = np.array([which[tuple(place)] for place in lowest.tolist()])
        along = np.abs(ends[:, 1] - ends[:, 0]).argmax(axis=1)
        points, rows = mesh.free_surface_stress(elements, spots, along, gear.material)
        angle = tangent_angles(nodes, side, lowest, ends, part, np.array([middle]))[:, 0]
        arc = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)))
        fine = np.linspace(0.0, arc[-1], 2001)
        angles, stress = np.interp(fine, arc, angle), CubicSpline(arc, rows @ found)(fine)
        first = int(np.searchsorted(fine, first_told(arc, angle, density.fillet)))
        curves.append(Curve(angles[first:], stress[first:]))
    return curves[0], curves[1]


def _plane_loads(gear: Gear, nodes, mesh, radii: Array, tooth: int) -> Array:
    """Nodal forces (size, m) of normal forces on the flank in contact of a tooth, in the frame of its pitch."""
    density, side = nodes.layout.sector(tooth).density, gear.flank.side
    column = nodes.layout.sector(tooth).first + 2 * density.land + (2 * density.through if side > 0 else 0)
    first, middle = nodes.layout.base_row + 2 * density.fillet, nodes.radius.shape[2] // 2
    rows = slice(first, first + 2 * density.flank + 1)
    number, radius = mesh.number[column, rows], nodes.radius[column, rows, middle]
    pitch = 2.0 * math.pi / nodes.layout.teeth * tooth
    theta = gear.nominal_flank.theta(radii, 0.0 * radii).value + side * gear.form.half_thickness_angle + pitch
    radial, hoop, _ = outward_normal(gear.nominal_flank, radii, 0.0 * radii).T
    normal = np.stack(
        [radial * np.cos(theta) - hoop * np.sin(theta), radial * np.sin(theta) + hoop * np.cos(theta)], axis=-1
    )
    edge = np.minimum((density.flank * (radii - radius[0]) / (radius[-1] - radius[0])).astype(int), density.flank - 1)
    part = density.flank * (radii - radius[0]) / (radius[-1] - radius[0]) - edge
    shares = np.stack([(1.0 - part) * (1.0 - 2.0 * part), 4.0 * part * (1.0 - part), part * (2.0 * part - 1.0)])
    loads = np.zeros((*mesh.points.shape, len(radii)))
    for n, share in enumerate(shares):
        np.add.at(loads, (number[2 * edge + n], slice(None), np.arange(len(radii))), -share[:, None] * normal)
    return loads.reshape(-1, len(radii))


def plane_rows() -> Iterator[Row]:
    """Unit loads, the whole curve and the neighbours' fillets against the plane reference."""
    gear, radii, section = spur_pair_gear(), loaded_radii(), replace(DENSITY, lengthwise=1)
    front, back = plane_curves(gear, section, radii)
    for name, curve, sign, values, angles in (
        ("tension", front, 1, TENSION, TENSION_ANGLE),
        ("compression", back, -1, COMPRESSION, COMPRESSION_ANGLE),
    ):
        found, where = curve.largest(sign)
        for n, load in enumerate(LOADED_AT):
            yield Row(CASE, SOURCE, f"plane: {name}, load at {load} [MPa]", values[n], LINE_LOAD * found[n], UNIT)
            yield Row(CASE, SOURCE, f"plane: tangent angle of it, {load} [deg]", angles[n], where[n], ANGLE / angles[n])
    for name, curve, fine in zip(("loaded side", "back"), (front, back), plane_curves(gear, FINE, radii), strict=True):
        for n, load in enumerate(LOADED_AT):
            yield Row(CASE, FINER, f"plane: whole curve of {name}, load at {load}", 0.0, _apart(curve, fine)[n], CURVE)
    for name, tooth, side, sign, value in zip(
        ("loaded fillet of tooth -1", "back of tooth +1"), (1, -1), (0, 1), (-1, 1), NEIGHBOURS, strict=True
    ):
        curve = plane_curves(gear, section, radii[1:2], tooth)[side]
        yield Row(CASE, SOURCE, f"plane: {name} [MPa]", value, LINE_LOAD * curve.largest(sign)[0][0], CURVE)


def _apart(curve: Curve, fine: Curve) -> Array:
    """Largest difference of two curves over the largest stress, for every load."""
    part = np.linspace(0.0, 1.0, 1001)
    one, other = (
        np.stack([np.interp(part, np.linspace(0.0, 1.0, len(c.angle)), stress) for stress in c.stress.T], axis=-1)
        for c in (curve, fine)
    )
    return np.abs(one - other).max(axis=0) / np.abs(other).max(axis=0)


def nine_rows() -> Iterator[Row]:
    """Nine gears in the plane against finer meshes."""
    for teeth, shift, rounding in NINE:
        gear = spur_pair_gear(teeth, shift=shift, rounding=rounding)
        low, high = gear.nominal_flank.grid(2, 2)[0][:, 0]
        radii = low + np.array(HEIGHTS) * (high - low)
        curves, fine = (plane_curves(gear, density, radii) for density in (replace(DENSITY, lengthwise=1), FINE))
        for name, n, sign in (("tension", 0, 1), ("compression", 1, -1)):
            ratio = curves[n].largest(sign)[0] / fine[n].largest(sign)[0] - 1.0
            quantity = f"plane: z {teeth}, x {shift}, rho {rounding}: {name}, largest error of {len(HEIGHTS)} loads"
            yield Row(CASE, FINER, quantity, 0.0, float(np.abs(ratio).max()), CONVERGED)


def line_on(model: RootStress, height: float, part: float = 1.0, middle: float = 0.5) -> tuple[FlankLine, Array]:
    """Force of 1 N spread evenly over a part of the face at a height of the flank of tooth 0."""
    places, weights = np.polynomial.legendre.leggauss(40)
    flank = model.frame.places(np.full(40, height), middle + 0.5 * part * places)
    x, y, z = flank.point.T
    return FlankLine(0, np.hypot(x, y), z), 0.5 * weights


def model_of(gear: Gear, density: MeshDensity) -> RootStress:
    """Model that is made, not taken from what is kept."""
    frame = ToothFrame(gear, gear_nodes(gear, density, OUTLINE))
    return RootStress(frame, root_influence(frame))


@cache
def spur_model() -> RootStress:
    """Of the pinion of the reference."""
    gear = spur_pair_gear()
    return model_of(gear, stress_density(gear))


def space_rows() -> Iterator[Row]:
    """In space over plane, under an even load at the highest point of single contact."""
    model, radius = spur_model(), loaded_radii()[1]
    width = model.frame.gear.nominal_flank.grid(2, 2)[1]
    places, weights = np.polynomial.legendre.leggauss(40)
    line = FlankLine(0, np.full(40, radius), 0.5 * float(np.ptp(width)) * places)
    stress = model.stress(0, [(line, 0.5 * LINE_LOAD * float(np.ptp(width)) * weights)])[0].max(axis=0)
    yield Row(
        CASE, SOURCE, "in space over plane: middle of the face", MIDDLE, stress[len(stress) // 2] / 85.35, IN_SPACE
    )
    yield Row(CASE, SOURCE, "in space over plane: end of the face", END, stress[0] / 85.35, AT_END)


LINES = ((0.4, 1.0, 0.5), (0.7, 1.0, 0.5), (1.0, 1.0, 0.5), (0.7, 0.3, 0.5), (0.7, 0.3, 0.85))
"""Height, part of the face and its middle of the loads on the other families."""


def largest(model: RootStress) -> Array:
    """Largest tension of the loaded side and compression of the back (lines, 2) under ``LINES`` [MPa/N]."""
    found = (model.stress(0, [line_on(model, *line)]) for line in LINES)
    return np.array([(stress[0].max(), stress[1].min()) for stress in found])


def families() -> dict[str, Gear]:
    """Gears of the families; 12 mm wide but for the face-milled ones."""
    straight, spiral = (
        bevel_pair(bevel_mesh((20, 40), outer_module=4.0, face_width=12.0, spiral_angle=math.radians(angle)))
        for angle in (0.0, 30.0)
    )
    milled = read_scene(SCENES / "face_milled_19x62_matched.toml").pair()
    return {
        "helical, 30 deg": spur_pair_gear(width=12.0, helix_deg=30.0),
        "straight bevel wheel": straight.wheel,
        "spiral bevel pinion": spiral.pinion,
        "face-milled pinion": milled.pinion,
        "face-milled wheel": milled.wheel,
    }


def finer(density: MeshDensity) -> MeshDensity:
    """Half as many elements more in every direction, the outermost layers half as thick."""
    section = {name: 3 * getattr(density, name) // 2 for name in ("through", "flank", "fillet", "land", "rim")}
    layers, coarse = np.arange(section["through"] // 2), np.arange(density.through // 2)
    half = 2.0 * (density.grading**coarse).sum()  # of the tooth, over the thickness of its outermost layer
    grading = float(brentq(lambda grading: (grading**layers).sum() - half, 1.0, 10.0))
    lengthwise = 2 * math.ceil(0.75 * density.lengthwise)
    return replace(density, grading=grading, skin=0.5 * density.skin, lengthwise=lengthwise, **section)


def family_rows() -> Iterator[Row]:
    """Largest stresses of every family against a finer mesh."""
    for name, gear in families().items():
        density = stress_density(gear)
        fine = finer(density)
        if density.lengthwise > MOST_LAYERS:
            density, fine = (replace(one, lengthwise=MOST_LAYERS) for one in (density, fine))
        error = np.abs(largest(model_of(gear, density)) / largest(model_of(gear, fine)) - 1.0)
        for quantity, value in zip(("tension", "compression"), error.max(axis=0), strict=True):
            words = f"{name}: {quantity}, largest error of {len(LINES)} loads"
            yield Row(CASE, FINER, words, 0.0, float(value), OTHER_FAMILIES)


def rows() -> list[Row]:
    """Every comparison."""
    return [*plane_rows(), *nine_rows(), *space_rows(), *family_rows()]


SECTION = replace(DENSITY, lengthwise=12, thin_ends=True)
MESHES: dict[str, tuple[dict[str, Any], MeshDensity]] = {
    "tooth compliance": ({}, MeshDensity(lengthwise=10)),
    "6 layers through of 1 : 3 : 9": ({}, replace(SECTION, through=6, grading=3.0)),
    "even ends of the face": ({}, replace(SECTION, thin_ends=False)),
    "default": ({}, SECTION),
    "half as many elements more": ({}, replace(finer(SECTION), lengthwise=12)),
    "half as many layers more": ({}, replace(SECTION, lengthwise=18)),
    "default, b 60": ({"width": 60.0}, replace(SECTION, lengthwise=26)),
    "default, b 60, 20 deg": ({"width": 60.0, "helix_deg": 20.0}, replace(SECTION, lengthwise=26)),
}
"""Changes of the pinion of the reference, and meshes."""


def measured(name: str) -> str:
    """One line of the table of a mesh of ``MESHES``: errors, processor time and memory of making the model."""
    changes, density = MESHES[name]
    gear, before = spur_pair_gear(**changes), time.process_time()
    model = model_of(gear, density)
    seconds = time.process_time() - before
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    plane = plane_curves(spur_pair_gear(), replace(density, lengthwise=1, thin_ends=False), loaded_radii())
    errors = [
        100.0 * float(np.abs(curve.largest(sign)[0] * LINE_LOAD / np.array(values) - 1.0).max())
        for curve, sign, values in zip(plane, (1, -1), (TENSION, COMPRESSION), strict=True)
    ]
    line, forces = line_on(model, 0.4985)  # the highest point of single contact
    stress = model.stress(0, [(line, changes.get("width", 20.0) * forces)])[0].max(axis=0) / (TENSION[1] / LINE_LOAD)
    kept = sum(values.nbytes for values in vars(model.table).values()) / 2**20
    shown = [f"{value:.2f}" for value in (*errors, stress[len(stress) // 2], stress[0])]
    return " | ".join([f"| {name}", *shown, f"{seconds:.1f}", f"{memory:.2f}", f"{kept:.1f} |"])


def main() -> None:
    """Print the table; every line in a process of its own, so that its memory is its own."""
    print("| mesh | tension, % | compression, % | mid-face | end | s | GiB | table, MiB |")
    print("|---|---|---|---|---|---|---|---|")
    for name in MESHES:
        with multiprocessing.get_context("spawn").Pool(1) as pool:
            print(pool.apply(measured, (name,)), flush=True)


if __name__ == "__main__":
    main()
