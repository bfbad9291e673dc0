"""Tooth root stress by the finite elements of the package beside a plane reference, and how far its mesh is converged.

The reference: plane finite elements of ``validation.calculix.plane_ring``, the whole ring of a spur pinion 25 of 25/37,
m 3, bore 0.55 of the root diameter, plane strain, refined until no stress moves by 0.2 %; in space the kept ring of
CalculiX, 20 mm wide, under an even line load at the highest point of single contact. Where there is no reference, finer
meshes of the same elements are: they have the largest stresses of the reference to 0.05 %.

Helical, bevel and face-milled gears are in :mod:`validation.loaded.root_stress_families`. The page
docs/studies/root_stress.md has all of it, and error, time and memory against the mesh, each model made in a process of
its own. Run from the root of the repository: ``python -m validation.loaded.root_stress``.
"""

import math
import multiprocessing
import re
import time
import warnings
from collections.abc import Callable, Container, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cache, cached_property, partial
from typing import Any
from unittest.mock import patch

import numpy as np
from scipy.interpolate import CubicSpline

from loaded_tca import analyse, read_scene
from loaded_tca.arrays import Array
from loaded_tca.compliance import FlankLine, MeshDensity, RootStress
from loaded_tca.compliance.body import factorised, gear_nodes
from loaded_tca.compliance.finite_elements import discretise
from loaded_tca.compliance.geometry import tangent_angles
from loaded_tca.compliance.root_stress import BEST, DENSITY, OUTLINE, first_told, stress_density
from loaded_tca.errors import AccuracyWarning, InputError
from loaded_tca.flanks.base import outward_normal
from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.pairs.gear import Gear
from loaded_tca.reference.iso6336_3 import RootSection, root_section
from loaded_tca.tooth.fillet import polar
from validation.calculix import plane_ring
from validation.calculix.tables import RINGS_FILE, read_table
from validation.loaded.root_stress_families import whole_rows as family_rows
from validation.loaded.root_stress_models import CASE, FINER, finer, line_on, model_of, spur_pair_gear
from validation.page import SCENES, Page, machine, medians, peak_memory, table, take_times, timed, write_page
from validation.table import Row

SOURCE = "plane finite elements, whole ring"
LINE_LOAD = 100.0
"""Of the reference [N/mm]."""
LOADED_AT = ("tip", "HPSTC", "pitch point", "LPSTC")


def reference(kind: str, tooth: int = 0, side: str = "loaded") -> tuple[float, ...]:
    """Kept numbers of the plane reference under the loads of ``LOADED_AT``: a column of its table."""
    kept = plane_ring.read()
    return tuple(float(kept[load, tooth, side][kind]) for load in LOADED_AT)


TENSION, TENSION_ANGLE = reference("tension_MPa"), reference("tension_angle_deg")
COMPRESSION, COMPRESSION_ANGLE = (reference(f"compression_{unit}", side="back") for unit in ("MPa", "angle_deg"))
NEIGHBOURS = reference("compression_MPa", -1)[1], reference("tension_MPa", 1, "back")[1]
"""Loaded fillet of tooth -1 and back of tooth +1 under a load on tooth 0 at its HPSTC [MPa]: in the middle of the space
beside that tooth, where the stress has a bend."""
SPATIAL = "finite elements in space (CalculiX)"


def in_space() -> tuple[float, float]:
    """Largest tension [MPa] of the kept ring under an even load at the HPSTC: in the middle of the face, at its end."""
    kept = [
        row for row in read_table(RINGS_FILE) if (row["ring"], row["load"], row["way"]) == ("spur", "even", "finer")
    ]
    by_height = {float(row["height_mm"]): float(row["tension_MPa"]) for row in kept}
    return by_height[0.0], by_height[max(by_height)]


UNIT, CURVE, IN_SPACE, AT_END, CONVERGED = 0.01, 0.03, 0.015, 0.03, 0.01
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
    radius = nodes.sections.in_true_size(nodes.radius[:, :, middle], nodes.coordinate[middle])
    mesh = discretise(polar(radius, nodes.angle[:, :, middle]), layout.elements)
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
    height = (nodes.sections.radius(radii, 0.0 * radii) - radius[0]) / (radius[-1] - radius[0])
    edge = np.minimum((density.flank * height).astype(int), density.flank - 1)
    part = density.flank * height - edge
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


def nine_rows(gears: Iterable[tuple[int, float, float]] = NINE) -> Iterator[Row]:
    """Nine gears in the plane against finer meshes."""
    for teeth, shift, rounding in gears:
        gear = spur_pair_gear(teeth, shift=shift, rounding=rounding)
        low, high = gear.nominal_flank.grid(2, 2)[0][:, 0]
        radii = low + np.array(HEIGHTS) * (high - low)
        curves, fine = (plane_curves(gear, density, radii) for density in (replace(DENSITY, lengthwise=1), FINE))
        for name, n, sign in (("tension", 0, 1), ("compression", 1, -1)):
            ratio = curves[n].largest(sign)[0] / fine[n].largest(sign)[0] - 1.0
            quantity = f"plane: z {teeth}, x {shift}, rho {rounding}: {name}, largest error of {len(HEIGHTS)} loads"
            yield Row(CASE, FINER, quantity, 0.0, float(np.abs(ratio).max()), CONVERGED)


ROUNDINGS, FORMS = (0.0, 0.05, 0.1, 0.2, 0.25, 0.38, 0.6), (17, 25, 50, 80)
"""Radii of the rack's tip in modules, the last one more than fits: a full radius; and teeth that are cut with it."""
FITTED, TREND, ISO = (0.2, 0.6), 0.02, 0.05
"""Radii at which stress over that of 0.38 is expected to follow Y_F Y_S, and by how much; and at which the stress
itself is; the closed form does not follow sharper ones."""
REFINED = ((17, 0.1), (25, 0.38), (80, 0.6))
"""Forms whose convergence is among the short rows."""
SHARP = 0.1
"""Radius in modules below which no accuracy is asked for: cutters wear to more."""


def full_rounding() -> float:
    """Radius of a rack of 20 degrees and a dedendum of 1.25 whose tip is all round, in modules."""
    return (0.25 * math.pi - 1.25 * math.tan(math.radians(20.0))) / math.tan(math.radians(35.0))


@dataclass(frozen=True)
class RootForm:
    """Largest tension and compression [MPa] under 1 N/mm at the highest point of single contact, and ISO 6336-3."""

    teeth: int
    rounding: float
    tension: float
    compression: float
    section: RootSection

    @cached_property
    def error(self) -> float:
        """Largest part by which finer elements differ, in tension and compression."""
        fine = _largest_of_form(self.teeth, self.rounding, lambda density: finer(finer(density)))
        return float(np.abs(np.array([self.tension, self.compression]) / fine - 1.0).max())

    @property
    def by_iso(self) -> float:
        """Nominal root stress [MPa]."""
        factors = self.section.form_factor * self.section.stress_correction_factor
        return math.cos(self.section.pressure_angle) / 3.0 * factors


@cache
def root_forms() -> dict[tuple[int, float], RootForm]:
    """Gears without profile shift, cut by racks of various tips, module 3, beside a wheel of 37 teeth."""
    found = {}
    for teeth in FORMS:
        pinion, path = _mesh_of_form(teeth).pinion, _mesh_of_form(teeth).path_of_contact
        for rounding in ROUNDINGS:
            section = root_section(
                teeth,
                0.0,
                2.0 * pinion.tip_radius / 3.0,
                path.AE / pinion.base_pitch,
                root_radius_coefficient=max(min(rounding, full_rounding()), 1e-6),
            )
            tension, compression = _largest_of_form(teeth, rounding)
            found[teeth, rounding] = RootForm(teeth, rounding, float(tension), float(compression), section)
    return found


def _mesh_of_form(teeth: int) -> CylindricalMesh:
    return CylindricalMesh(*(CylindricalGear(z, 3.0, 20.0) for z in (teeth, 37)))


def _largest_of_form(
    teeth: int, rounding: float, change: Callable[[MeshDensity], MeshDensity] = lambda density: density
) -> Array:
    """Largest tension and compression (2,) [MPa] of a form, on the default mesh with a change."""
    pinion, path = _mesh_of_form(teeth).pinion, _mesh_of_form(teeth).path_of_contact
    roll = pinion.roll_length(pinion.tip_radius) - path.AE + pinion.base_pitch
    gear, radii = spur_pair_gear(teeth, rounding=rounding), np.array([pinion.radius_at_roll_length(roll)])
    curves = plane_curves(gear, in_plane(change(stress_density(gear))), radii)
    return np.array([curve.largest(sign)[0][0] for curve, sign in zip(curves, (1, -1), strict=True)])


def in_plane(density: MeshDensity) -> MeshDensity:
    """The same sections, one layer."""
    return replace(density, lengthwise=1, thin_ends=False)


def form_rows(refined: Container[tuple[int, float]] | None = None) -> Iterator[Row]:
    """Roots from nearly sharp to all round: converged, and following the form and notch factors of ISO 6336-3.

    Convergence is that of the forms that are refined, of all by default.
    """
    forms, usual = root_forms(), 0.38
    for (teeth, rounding), form in forms.items():
        words = f"plane: z {teeth}, x 0, rho {rounding}"
        if refined is None or (teeth, rounding) in refined:
            allowed = CONVERGED if rounding >= SHARP else None
            yield Row(CASE, FINER, f"{words}: tension and compression, largest error", 0.0, form.error, allowed)
        if FITTED[0] <= rounding <= FITTED[1]:
            other, iso = forms[teeth, usual], "ISO 6336-3, Y_F Y_S"
            yield Row(CASE, iso, f"{words}: tension [MPa]", form.by_iso, form.tension, ISO)
            if rounding != usual:
                ratios = form.by_iso / other.by_iso, form.tension / other.tension
                yield Row(CASE, iso, f"{words}: tension over that of rho {usual}", *ratios, TREND)


@cache
def spur_model() -> RootStress:
    """Of the pinion of the reference."""
    gear = spur_pair_gear()
    return model_of(gear, stress_density(gear))


def space_rows() -> Iterator[Row]:
    """In space, under an even load at the highest point of single contact."""
    model, radius = spur_model(), loaded_radii()[1]
    width = model.frame.gear.nominal_flank.grid(2, 2)[1]
    places, weights = np.polynomial.legendre.leggauss(40)
    line = FlankLine(0, np.full(40, radius), 0.5 * float(np.ptp(width)) * places)
    stress = model.stress(0, [(line, 0.5 * LINE_LOAD * float(np.ptp(width)) * weights)])[0].max(axis=0)
    for place, kept, found, allowed in zip(
        ("in the middle", "at the end"),
        in_space(),
        (stress[len(stress) // 2], stress[0]),
        (IN_SPACE, AT_END),
        strict=True,
    ):
        yield Row(CASE, SPATIAL, f"in space: tension {place} of the face [MPa]", kept, float(found), allowed)


def rows() -> list[Row]:
    """Every comparison."""
    return [*plane_rows(), *nine_rows(), *form_rows(), *space_rows()]


def short_rows() -> list[Row]:
    """Rows in the plane, with the finer meshes of a few gears and forms."""
    return [*plane_rows(), *nine_rows(NINE[::4]), *form_rows(REFINED)]


SECTION = replace(DENSITY, lengthwise=12, thin_ends=True)
MESHES: dict[str, tuple[dict[str, Any], MeshDensity]] = {
    "tooth compliance": ({}, MeshDensity(lengthwise=10)),
    "6 layers through of 1 : 3 : 9": ({}, replace(SECTION, through=6, grading=3.0)),
    "even ends of the face": ({}, replace(SECTION, thin_ends=False)),
    "default": ({}, SECTION),
    "half as many elements more": ({}, replace(finer(SECTION), lengthwise=12)),
    "half as many layers more": ({}, replace(SECTION, lengthwise=18)),
    "default, 30 deg": ({"helix_deg": 30.0}, SECTION),
    "default, b 60": ({"width": 60.0}, replace(SECTION, lengthwise=26)),
    "default, b 60, 20 deg": ({"width": 60.0, "helix_deg": 20.0}, replace(SECTION, lengthwise=26)),
    "default, b 60, 30 deg": ({"width": 60.0, "helix_deg": 30.0}, replace(SECTION, lengthwise=26)),
}
"""Changes of the pinion of the reference, and meshes."""
RUNS, CYCLES = 5, ("mesh_cycle_spur", "mesh_cycle_helical", "mesh_cycle_bevel")
"""Of mesh cycles."""


def told_memory(gear: Gear, density: MeshDensity) -> float:
    """Memory [GiB] that a model says it needs, by asking a machine that has none."""
    with patch("loaded_tca.compliance.dissection.machine_memory", return_value=0.0):
        try:
            model_of(gear, density)
        except InputError as refused:
            return float(re.search(r"need ([0-9.]+) GiB", str(refused))[1])  # type: ignore[index]
    raise AssertionError


def measured(name: str) -> list[str]:
    """One line of the table of a mesh of ``MESHES``: errors, processor time and memory of making the model."""
    changes, density = MESHES[name]
    gear = spur_pair_gear(**changes)
    before = peak_memory()
    model, (seconds,) = timed(lambda: model_of(gear, density), clock=time.process_time)
    memory = peak_memory() - before
    told = told_memory(gear, density)
    plane = plane_curves(spur_pair_gear(), in_plane(density), loaded_radii())
    errors = [
        100.0 * float(np.abs(curve.largest(sign)[0] * LINE_LOAD / np.array(values) - 1.0).max())
        for curve, sign, values in zip(plane, (1, -1), (TENSION, COMPRESSION), strict=True)
    ]
    line, forces = line_on(model, 0.4985)  # the highest point of single contact
    stress = model.stress(0, [(line, changes.get("width", 20.0) * forces)])[0].max(axis=0) / (TENSION[1] / LINE_LOAD)
    kept = sum(values.nbytes for values in vars(model.table).values()) / 2**20
    in_space = [] if "helix_deg" in changes else [stress[len(stress) // 2], stress[0]]
    shown = [f"{value:.2f}" for value in (*errors, *in_space)] + ["" for _ in range(2 - len(in_space))]
    return [name, *shown, f"{seconds:.1f}", f"{told:.2f}", f"{memory:.2f}", f"{kept:.1f}"]


def time_of_cycle(name: str) -> list[str]:
    """Processor time of a mesh cycle with and without root stress, medians of runs that take turns; models are kept."""
    without_stress, scene = (
        read_scene(SCENES / f"{name}.toml").with_changes({"analysis.root_stress": asked}) for asked in (False, True)
    )
    calls = {"without": partial(analyse, without_stress), "with": partial(analyse, scene)}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        analyse(scene)  # models are made
        without, with_stress = medians(take_times(calls, RUNS, time.process_time)).values()
    states = scene.analysis.positions * len(scene.torques)
    return [name, f"{states}", f"{without:.2f}", f"{with_stress:.2f}", f"{with_stress - without:.2f}"]


def of_rows(found: Iterable[Row]) -> str:
    """Table of rows that are compared with numbers."""
    lines = ([row.quantity, f"{row.expected:.4g}", f"{row.obtained:.4g}", f"{100 * row.error:.2f}"] for row in found)
    return table("quantity | reference | model | difference, %", lines)


def of_convergence(found: Iterable[Row]) -> str:
    """Table of rows whose number is an error."""
    lines = ([row.quantity, f"{100 * row.obtained:.2f}"] for row in found)
    return table("quantity | error, %", lines)


def of_forms() -> str:
    """Table of the forms of roots."""
    return table(
        "z | rho_fP | tension, MPa | error of the mesh, % | ISO 6336-3, MPa | over rho 0.38 | the same by ISO",
        (
            [
                f"{teeth}",
                "full" if rounding > full_rounding() else f"{rounding:g}",
                f"{form.tension:.3f}",
                f"{100 * form.error:.2f}",
                f"{form.by_iso:.3f}",
                f"{form.tension / root_forms()[teeth, 0.38].tension:.3f}",
                f"{form.by_iso / root_forms()[teeth, 0.38].by_iso:.3f}",
            ]
            for (teeth, rounding), form in root_forms().items()
        ),
    )


def page() -> str:
    """Measure everything; the page."""
    plane = list(plane_rows())
    middle, end = (stress / TENSION[1] for stress in in_space())
    with multiprocessing.get_context("spawn").Pool(1, maxtasksperchild=1) as pool:
        meshes = table(
            "mesh | tension, % | compression, % | mid-face | end | s | GiB told | GiB taken | table, MiB",
            pool.map(measured, MESHES, chunksize=1),
        )
    return f"""# Tooth root stress: error, time and memory

Written by `python -m validation.loaded.root_stress`. The model is described in [tooth
compliance](../how_it_works/tooth_compliance.md#root-stress) and in `loaded_tca/compliance/root_stress.py`.

## Against a plane reference

Spur pinion 25 of 25/37, m 3, 100 N/mm, bore of 0.55 of the root diameter. The reference is the whole ring of
quadrilaterals of eight nodes in plane strain, on elements of 0.02 mm along the fillets
(`python -m validation.calculix.plane_ring`, which shares nothing with the package); from 0.04 to 0.02 mm no stress
moves by 0.2 %. Asked: unit loads 1 %, the neighbours 3 %, in space 1.5 % in the middle of the face and 3 % at its
ends. In space the reference is a [run of CalculiX](reference_fem.md); the gear is 20 mm wide and evenly loaded at its
highest point of single contact (HPSTC). The maximum along the fillet is flat: at 1.5 deg from its place the stress is
0.1 % lower. The largest stress of the neighbours is that in the very middle of the space, where the stress has a bend
that the last places of the model do not reach.

{of_rows([row for row in (*plane, *space_rows()) if row.expected])}

The whole curve from a tangent angle of 15 deg on, largest difference from a mesh of twice the density over the largest
stress, asked 3 %:

{of_convergence([row for row in plane if not row.expected])}

## Against the mesh

The same pinion. Errors are the largest of four loads against the plane reference; mid-face and end are tension over
the plane value (the ring in space has {middle:.3f} and {end:.3f} at b 20; wider faces have their own). Time is
processor time of one thread. "GiB taken" is the memory that the process takes beyond its libraries (0.09 GiB), "GiB
told" the memory that is reported before the elimination starts, and compared with the memory of the machine.
{machine()}.

{meshes}

The error depends on the layers through the tooth: those of the tooth compliance are too thick below the surface. A
face of 20 modules takes less than 1 GiB, since beside the resolved tooth two layers are joined into one.

## Nine gears

m 3, loads at three heights of the flank, against a mesh of the same elements that has the largest stresses of the
reference to 0.05 %; asked 1 %.

{of_convergence(nine_rows())}

## Helical, bevel and face-milled gears

In space, against finer meshes: half as many elements more in each direction of a section with the outermost layers
half as thick, or half as many layers more along the face. Largest error of eight loads: even ones over the face at
three heights, on 0.3 of it in its middle and near its end, and lines that rise or fall along the face; asked 2 %. The
helical and the first bevel gears are 12 mm wide; the face-milled ones are those of `examples/scenes`. Fillets of
19x62 are sharp: edge radii of 0.016 of the pitch. At the very ends of inclined teeth, where the stress is low, its
error is 3 to 10 %; the table compares the maxima beside them.

{of_convergence(family_rows())}

## Forms of the root

Cylindrical gears have the trochoid of the basic rack with its tip radius rho_fP, up to all round. m 3, without
profile shift, 1 N/mm at the HPSTC beside a wheel of 37 teeth. "ISO" is Y_F Y_S of ISO 6336-3, method B. From 0.2 on
both agree to 5 %, and to 2 % in how stress falls with the radius; for sharper racks the closed form is lower, the
more so the more teeth the gear has. Errors of the mesh are against sections of 2.25 times as many elements each way,
with outermost layers of a quarter.

{of_forms()}

## Mesh cycles

Scenes of `examples/scenes`, all their positions and torques, both gears, all teeth that are stressed; processor time of
one thread with the models at hand, medians of {RUNS} runs that take turns.

{table("scene | states | analysis, s | with root stress, s | difference, s", map(time_of_cycle, CYCLES))}
"""


if __name__ == "__main__":
    write_page(__doc__, lambda: Page("root_stress", page()))
