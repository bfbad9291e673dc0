"""What a scene or a stage amounts to before any contact is computed: its geometry, its load, what departs from nominal.

Of a stage: planets, torques, phases, the gears of both meshes.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import chain

import numpy as np

from loaded_tca.arrays import GEARS
from loaded_tca.effort import expected_run_effort
from loaded_tca.errors import give_accuracy_warning, noted_accuracy_warnings
from loaded_tca.flanks.spline import DEFAULT_POINTS, SplineFlank
from loaded_tca.loaded.shaft_lines import ShaftLine, shaft_lines
from loaded_tca.output.other_results import rolling_figures
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.plain import plain
from loaded_tca.results.figures import RIM_LABEL
from loaded_tca.results.key_figures import STIFFNESS_ROW, STRESS, STRESS_ROWS, iso_figures, reasons_beside
from loaded_tca.results.root_stress import rim_factor
from loaded_tca.results.summary import shown
from loaded_tca.results.warnings import questions, warn_of_gears
from loaded_tca.scene import Scene
from loaded_tca.scene.model import Row
from loaded_tca.scene.section import Section, contents
from loaded_tca.stages import Stage
from loaded_tca.stages.analyse import expected_stage_effort
from loaded_tca.stages.kinematics import mesh_phases, neighbours_apart, neutralised
from loaded_tca.stages.result import MOST_ORDERS
from loaded_tca.stages.sections import RING_MESH, SUN_MESH, in_words_of
from loaded_tca.unloaded.path import contact_span, roll_lengths_of_flanks

MOST_TORQUES = 4
"""Torques that have a column each; of more, the least and the largest are shown."""
LABEL = 44


def describe_scene(scene: Scene) -> str:
    """Return the geometry and the load of a scene, a line each, with the warnings that concern whole gears.

    Raises
    ------
    InputError, GeometryError
        If the gears of the scene cannot exist, mesh or turn, or their teeth cannot be built though they bend.
    """
    with noted_accuracy_warnings(given=False) as sentences:
        warn_of_gears(scene, scene.pair())
        sections = scene_sections(scene)
        for sentence in questions(scene):
            give_accuracy_warning(sentence)
    effort = expected_run_effort(scene)
    spent = ("analysis, roughly: time [s], memory [GiB]", plain(effort.seconds, 2), plain(effort.gibibytes, 2))
    rows = [*chain.from_iterable(sections.values()), spent]
    lines = [f"{label:<{LABEL}}" + "".join(f"{cell:>14}" for cell in cells) for label, *cells in rows]
    beside = [f"ISO 6336: {reason}" for reason in reasons_beside(iso_figures(scene, max(scene.torques)))]
    warned = [f"warning: {sentence}" for sentence in dict.fromkeys(sentences)]
    notes = [] if effort.fits else [f"note: {effort}"]
    return "\n".join([scene.title or "Scene", *lines, *beside, *warned, *notes])


def scene_sections(scene: Scene) -> dict[str, list[Row]]:
    """Return the lines of an overview by their subjects, each a label and its cells; errors as ``describe_scene``.

    A line without a label, and the first one of the path of contact, name the columns below them.
    """
    pair = scene.pair()
    return {
        "geometry": [*scene.geometry_rows()],
        "path of contact": [*_path_rows(scene, pair)],
        "load and analysis": [*_asked_rows(scene, pair)],
        "bearings": [*_bearing_rows(scene)],
        "ISO 6336": [*_standard_rows(scene, pair)],
        "mounting errors, edges and modifications": [*_departures(scene)],
        "flanks described by points": [*_spline_rows(scene, pair)],
    }


def _path_rows(scene: Scene, pair: GearPair) -> Iterator[Row]:
    """Points A to E of the path of contact on the pinion after ISO 21771, and those of the unloaded flanks."""
    if not scene.path_points:
        return
    yield "path of contact of the pinion", "from T1 [mm]", "roll [deg]", "diameter [mm]"
    own = roll_lengths_of_flanks(pair, *contact_span(pair))
    for letter, nominal in scene.path_points.items():
        for whose, points in (("ISO 21771", {letter: nominal}), ("unloaded contact point", own)):
            if letter in points:
                length = points[letter]
                roll, diameter = length / pair.base_radii[0], 2.0 * math.hypot(length, pair.base_radii[0])
                yield f"  {letter}, {whose}", f"{length:z.4f}", f"{math.degrees(roll):z.4f}", f"{diameter:z.4f}"


def _asked_rows(scene: Scene, pair: GearPair) -> Iterator[Row]:
    """The load, what the analysis is asked to do, and the bores or journals that it holds where teeth bend."""
    torques, wanted, count = torques_with_columns(scene.torques), scene.analysis, len(scene.torques)
    label = "pinion torque [N m]" if len(torques) == count else f"{count} pinion torques from, to [N m]"
    yield label, *(f"{1e-3 * torque:g}" for torque in torques)
    yield from scene.force_rows(torques)
    if pair.max_pressure is not None:
        yield "cap on the pressure [MPa]", f"{pair.max_pressure:g}"
    switches = ("on" if switch else "off" for switch in (wanted.load_sharing, wanted.free_edges))
    yield "load sharing, free edges, compliance", *switches, wanted.compliance
    if any(gear.tip_rounding_mm or gear.side_rounding_mm for gear in (scene.pinion, scene.wheel)):
        yield "pressures at rounded edges", wanted.edge_pressures
    yield "positions, torques", f"{wanted.positions}", f"{len(scene.torques)}"
    if wanted.root_stress:
        yield "root stress", "on"
    if wanted.without_bodies:
        held = (
            "bore and outside of the ring held rigid [mm]" if scene.wheel.teeth < 0 else "bores or journals held rigid"
        )
        yield held, *(f"{bore:z.4f}" for bore in pair.rigid_bores)


def _bearing_rows(scene: Scene) -> Iterator[Row]:
    """Forces on the bearings of shafts, and what rolling bearings make of them, without contact."""
    if not any(scene.have_shafts):
        return
    torques = torques_with_columns(scene.torques)
    by_gear: dict[str, list[ShaftLine]] = {gear: [] for gear in GEARS}
    for line in shaft_lines(scene):
        if line.torque in torques:
            by_gear[line.gear].append(line)
    for gear, lines in by_gear.items():
        for n, bearing in enumerate(lines[0].shaft.bearings if lines else ()):
            forces = (float(np.linalg.norm(line.bearing_forces[n, :3])) for line in lines)
            yield f"{gear}, bearing {n} at {bearing.at:g} mm: force [N]", *(f"{force:z.1f}" for force in forces)
            inside = [rolling_figures(line, n) for line in lines]
            if any(inside):
                yield "  largest element force [N]", *(f"{one['element_force_N']:z.1f}" for one in inside)
                yield "  life [million revolutions]", *(plain(one["life_Mrev"]) for one in inside)


def torques_with_columns(torques: tuple[float, ...]) -> tuple[float, ...]:
    """Torques that have a column each: all, or the least and the largest of many."""
    return torques if len(torques) <= MOST_TORQUES else (min(torques), max(torques))


def _standard_rows(scene: Scene, pair: GearPair) -> Iterator[Row]:
    """What ISO 6336 gives for a cylindrical pair from its geometry and load, to be read beside computed numbers."""
    torques = torques_with_columns(scene.torques)
    figures = [iso_figures(scene, torque) for torque in torques]
    for label, names in (*STRESS_ROWS, STIFFNESS_ROW):
        by_torque = figures if names == (STRESS,) else figures[:1]
        values = [(entry[name], name) for entry in by_torque for name in names]
        if any(math.isfinite(value) for value, _ in values):
            yield label.strip(), *(shown(value, name) for value, name in values)
    if not scene.analysis.root_stress:
        return
    for name, nominal in zip(GEARS, scene.nominal_root_stress, strict=True):
        if math.isfinite(nominal):
            yield f"nominal root stress, ISO, {name} [MPa]", *(plain(nominal * torque) for torque in torques)
    if math.isfinite(scene.tooth_height_over_width):
        yield RIM_LABEL.strip(), *(shown(rim_factor(gear), "") for gear in (pair.pinion, pair.wheel))


def _departures(scene: Scene) -> Iterator[Row]:
    """Mounting errors, rounded edges and modifications that a scene asks for, by their keys."""
    yield from _changed(scene.mounting, "mounting.") or [("mounting errors", "none")]
    for name, gear in (("pinion", scene.pinion), ("wheel", scene.wheel)):
        for edge, radius in (("tip", gear.tip_rounding_mm), ("side", gear.side_rounding_mm)):
            yield f"{name}.{edge}_rounding_mm", f"{radius:g}" if radius else "sharp"
        yield from _changed(gear.modifications, f"{name}.modifications.") or [(f"{name}.modifications", "none")]


def _spline_rows(scene: Scene, pair: GearPair) -> Iterator[Row]:
    """Forms of flanks that are not analytic, and how closely their B-splines follow their points."""
    gears = ("pinion", scene.pinion, pair.pinion.sharp), ("wheel", scene.wheel, pair.wheel.sharp)
    for name, gear, made in gears:
        flank = made.flank
        if not isinstance(flank, SplineFlank):
            continue
        yield f"{name}.flank.form", gear.flank.form
        if gear.flank.measurement is not None:
            rho, z = flank.grid(*DEFAULT_POINTS)
            excess = 1e3 * flank.distance_to(flank.nominal, rho, z)
            yield f"{name}: measured points", " x ".join(map(str, gear.flank.measurement.shape))
            at_points = 1e3 * flank.distance_to(flank.nominal, *gear.flank.measurement.places)
            yield f"{name}: deviations at points, from, to [um]", f"{at_points.min():z.2f}", f"{at_points.max():z.2f}"
            yield f"{name}: deviations of flank, from, to [um]", f"{excess.min():z.2f}", f"{excess.max():z.2f}"
        errors = {"at points": flank.fit_error, "between them": flank.check_error}
        for where, error in errors.items():
            if error is not None:
                label = f"{name}: fit {where}, largest, rms [um]"
                yield label, f"{1e3 * error.largest:.1e}", f"{1e3 * error.rms:.1e}"


def _changed(section: Section, place: str) -> list[Row]:
    """Values of a section that are not its defaults."""
    usual = contents(type(section)())
    return [(place + key, f"{value}") for key, value in contents(section).items() if value != usual[key]]


HELD = "Bores of sun and planets and the outside of the ring are held rigid; planet rims, carrier and pins do not bend."
"""What a stage does not model, for reports and the check of a file."""


def describe_stage(stage: Stage) -> str:
    """Return planets, torques, phases and geometry of a stage, a line each, with the warnings that concern its gears.

    Raises
    ------
    InputError, GeometryError
        If gears of the stage cannot exist, mesh or turn, or planets cannot be put in.
    """
    stage.require_assembly()
    lines = [stage.title or "Planetary stage"]
    sections = stage_sections(stage)
    lines += [_line(*row) for row in chain.from_iterable(sections.values())]
    warned: list[str] = []
    for name, rows, sentences in geometry_of_meshes(stage):
        lines += ["", name, *(_line(*row) for row in rows)]
        warned += [f"warning: {name}: {sentence}" for sentence in sentences]
    lines += ["", _line("analysis, roughly: time [s]", plain(expected_stage_effort(stage).seconds, 2)), HELD, *warned]
    return "\n".join(lines)


def stage_sections(stage: Stage) -> dict[str, list[Row]]:
    """Return the lines of an overview by their subjects, each a label and its cells.

    The first one of the phases names the columns below it.
    """
    return {"stage": _stage_rows(stage), "torques": _torque_rows(stage), "phases": phase_rows(stage)}


def geometry_of_meshes(stage: Stage) -> list[tuple[str, list[Row], list[str]]]:
    """Name of each mesh, the rows of its geometry, and its warnings that concern whole gears."""
    geometry = []
    for scene, gears in ((stage.sun_scene, SUN_MESH), (stage.ring_scene, RING_MESH)):
        with in_words_of(gears), noted_accuracy_warnings(given=False) as sentences:
            warn_of_gears(scene, scene.pair())
            rows = scene_sections(scene)["geometry"]
        name = " and ".join(f"{member} ({gear})" for gear, member in gears.items())
        geometry.append((name, rows, list(dict.fromkeys(sentences))))
    return geometry


def _stage_rows(stage: Stage) -> list[Row]:
    """What the stage is made of, and how its members are held."""
    asked, (z_s, z_p, z_r) = stage.stage, stage.teeth
    planet = stage.meshes[0].wheel
    pins = ("tangentially", asked.pin_tangential_um), ("outwards", asked.pin_radial_um)
    rows: list[Row] = [
        ("teeth of sun, planet and ring", f"{z_s}", f"{z_p}", f"{z_r}"),
        ("ratio of sun to carrier, the ring held", f"{1.0 + z_r / z_s:z.4f}"),
        ("driving", asked.driving),
        ("planets at [deg]", *(f"{math.degrees(angle):z.4f}" for angle in asked.angles)),
        ("they can be put in every [deg]", f"{360.0 / (z_s + z_r):z.4f}"),
        ("centre distance of both meshes [mm]", f"{stage.centre_distance:z.4f}"),
    ]
    if len(asked.angles) > 1:
        room = neighbours_apart(asked.angles, stage.centre_distance) - 2.0 * planet.tip_radius
        rows.append(("neighbouring planets apart [mm]", f"{room:z.4f}"))
    rows.append(("support of the sun", _support(stage)))
    rows += [(f"pins displaced {how} [um]", *(f"{pin:g}" for pin in given)) for how, given in pins if given]
    return rows


def _support(stage: Stage) -> str:
    """How the sun is held, in words."""
    stiffness = stage.stage.support_stiffness
    if math.isinf(stiffness):
        return "rigid"
    return "floating" if stiffness == 0.0 else f"{1e-3 * stiffness:g} N/um"


def _torque_rows(stage: Stage) -> list[Row]:
    """Torques of all members, and the force of a planet with an even share; of many torques the least and the largest.

    With the signs of the loads that the stage puts on its surroundings left out.
    """
    shown, (z_s, _, z_r) = torques_with_columns(stage.sun_torques), stage.teeth
    base = stage.meshes[0].pinion.base_radius
    return [
        ("sun torque [N m]", *(f"{1e-3 * torque:g}" for torque in shown)),
        ("carrier torque [N m]", *(f"{1e-3 * torque * (1.0 + z_r / z_s):g}" for torque in shown)),
        ("ring torque [N m]", *(f"{1e-3 * torque * z_r / z_s:g}" for torque in shown)),
        (
            "force of an even share at the base circles [N]",
            *(f"{_even(stage, torque) / base:z.1f}" for torque in shown),
        ),
    ]


def _even(stage: Stage, torque: float) -> float:
    return torque / len(stage.stage.angles)


def phase_rows(stage: Stage) -> list[Row]:
    """Phases of the meshes of each planet, and the orders that equal planets cancel."""
    angles = stage.stage.angles
    phases = mesh_phases(*stage.meshes, angles, stage.stage.driving == "sun")
    cancelled = [neutralised(order, angles, stage.sun.teeth) for order in range(1, MOST_ORDERS + 1)]
    orders = [", ".join(str(k + 1) for k, one in enumerate(cancelled) if one[which]) or "none" for which in range(2)]
    return [
        ("phases of the meshes, in mesh cycles", "sun's", "ring's"),
        *(
            (f"  planet {planet}", f"{sun:z.4f}", f"{ring:z.4f}")
            for planet, (sun, ring) in enumerate(zip(*(one.tolist() for one in phases), strict=True))
        ),
        ("orders of the mesh that equal planets cancel", f"rotation: {orders[0]}", f"forces on the sun: {orders[1]}"),
    ]


def _line(label: str, *cells: str) -> str:
    return f"{label:<{LABEL}}" + "".join(f"{cell:>14}" if len(cell) < 14 else f"  {cell}" for cell in cells)
