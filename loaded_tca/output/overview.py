"""What a scene amounts to before any contact is computed: its geometry, its load, what departs from nominal."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arrays import GEARS
from loaded_tca.effort import expected_run_effort
from loaded_tca.errors import InputError, give_accuracy_warning, noted_accuracy_warnings
from loaded_tca.flanks.spline import DEFAULT_POINTS, SplineFlank
from loaded_tca.output.overview_text import Overview
from loaded_tca.plain import lasting, plain
from loaded_tca.results.gear_warnings import questions, warn_of_gears
from loaded_tca.results.key_figures import STIFFNESS_ROW, STRESS, STRESS_ROWS, iso_figures, reasons_beside
from loaded_tca.results.root_stress import RIM_LABEL, rim_factor
from loaded_tca.results.summary import shown
from loaded_tca.scene.rows import Cell, Label, fixed
from loaded_tca.scene.section import Section, contents
from loaded_tca.unloaded.path import contact_span, roll_lengths_of_flanks

if TYPE_CHECKING:
    from collections.abc import Iterator

    from loaded_tca.loaded.shaft_lines import ShaftLine
    from loaded_tca.pairs.gear_pair import GearPair
    from loaded_tca.scene import Scene
    from loaded_tca.scene.load import AnyLoad
    from loaded_tca.scene.model import Row

MOST_TORQUES = 4
"""Torques that have a column each; of more, the least and the largest are shown."""


def describe_scene(scene: Scene) -> str:
    """Return the geometry and the load of a scene, a line each, with the warnings that concern whole gears.

    Raises
    ------
    InputError, GeometryError
        If the gears of the scene cannot exist, mesh or turn, or their teeth cannot be built though they bend.
    """
    return overview_of_scene(scene).text


def overview_of_scene(scene: Scene) -> Overview:
    """Return what ``describe_scene`` says, before it is text."""
    with noted_accuracy_warnings(given=False) as sentences:
        warn_of_gears(scene, scene.pair())
        sections = scene_sections(scene)
        for sentence in questions(scene):
            give_accuracy_warning(sentence)
    effort = expected_run_effort(scene)
    spent = plain(effort.seconds, 2), plain(effort.gibibytes, 2)
    reasons = reasons_beside(iso_figures(scene, max(scene.torques)))
    return Overview(
        scene.title or "Scene",
        sections,
        {},
        dict(zip(("seconds", "memory_GiB"), spent, strict=True)),
        ("analysis on idle cores, about: [s], [GiB]", *spent),
        [f"ISO 6336: {reason}" for reason in reasons],
        [*dict.fromkeys(sentences)],
        [] if effort.fits else [str(effort)],
    )


def scene_sections(scene: Scene, positions: int | None = None, *, mounted: bool = True) -> dict[str, list[Row]]:
    """Return the lines of an overview by their subjects, each a label and its cells; errors as ``describe_scene``.

    A line without a label, and the first one of the path of contact, name the columns below them. ``positions``: those
    of a whole revolution; default: of the pitch that the scene asks for. ``mounted``: whether mounting errors are
    among them; those of a half of a double helical pair follow from the errors of the whole gear.
    """
    pair = scene.pair()
    return {
        "geometry": [*scene.geometry_rows()],
        "path of contact": [*_path_rows(scene, pair)],
        "load and analysis": [*_asked_rows(scene, pair, positions)],
        "bearings": [*_bearing_rows(scene)],
        "ISO 6336": [*_standard_rows(scene, pair)],
        "strength and rating": [*_strength_rows(scene)],
        "mounting errors, edges and modifications": [*(mounting_rows(scene) if mounted else ()), *_departures(scene)],
        "pitch deviations": [*_pitch_rows(scene, pair)],
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
                yield f"  {letter}, {whose}", fixed(length, 4), fixed(math.degrees(roll), 4), fixed(diameter, 4)


def _asked_rows(scene: Scene, pair: GearPair, positions: int | None) -> Iterator[Row]:
    """The load, what the analysis is asked to do, and the bores or journals that it holds where teeth bend."""
    torques, wanted, count = torques_with_columns(scene.torques), scene.analysis, len(scene.torques)
    label = "pinion torque [N m]"
    if len(torques) != count:
        label = Label(f"{count} pinion torques from, to [N m]", "pinion_torques_N_m", "least", "largest")
    yield label, *(f"{plain(1e-3 * torque, 6)}" for torque in torques)
    yield from spectrum_rows(scene.load)
    yield from scene.force_rows(torques)
    if pair.max_pressure is not None:
        yield "cap on the pressure [MPa]", f"{plain(pair.max_pressure, 6)}"
    switches = ("on" if switch else "off" for switch in (wanted.load_sharing, wanted.free_edges))
    names = "load_sharing", "free_edges", "compliance"
    yield Label("load sharing, free edges, compliance", "model", *names), *switches, wanted.compliance
    if any(gear.tip_rounding_mm or gear.side_rounding_mm for gear in (scene.pinion, scene.wheel)):
        yield "pressures at rounded edges", wanted.edge_pressures
    counts = wanted.positions if positions is None else positions, len(scene.torques)
    yield Label("positions, torques", "count", "positions", "torques"), *map(str, counts)
    if wanted.root_stress:
        yield "root stress", "on"
    if wanted.without_bodies:
        yield scene.held_row(pair)


def spectrum_rows(load: AnyLoad) -> Iterator[Row]:
    """Bins of a load spectrum, which of them are reversed (from 1 on), and their time."""
    if load.case is None:
        return
    other_way = [str(number) for number, case in enumerate(load.case, start=1) if case.reversed]
    yield "bins of the load spectrum", f"{len(load.case)}"
    names = f"bin{'s' * (len(other_way) > 1)} {', '.join(other_way)} of {len(load.case)}"
    yield "bins that are reversed", names if other_way else "none"
    if load.hours is not None:
        yield "hours of all bins [h]", plain(load.hours, 9)


def _bearing_rows(scene: Scene) -> Iterator[Row]:
    """Forces on the bearings of shafts, and what rolling bearings make of them, without contact."""
    if not any(scene.have_shafts):
        return
    from loaded_tca.loaded.shaft_lines import shaft_lines  # loaded contacts: scenes without shafts do not need them
    from loaded_tca.output.other_tables import rolling_figures

    torques = torques_with_columns(scene.torques)
    by_gear: dict[str, list[ShaftLine]] = {gear: [] for gear in GEARS}
    for line in shaft_lines(scene):
        if line.torque in torques:
            by_gear[line.gear].append(line)
    for gear, lines in by_gear.items():
        for n, bearing in enumerate(lines[0].shaft.bearings if lines else ()):
            forces = (float(np.linalg.norm(line.bearing_forces[n, :3])) for line in lines)
            yield f"{gear}, bearing {n} at {plain(bearing.at, 6)} mm: force [N]", *(fixed(force, 1) for force in forces)
            inside = [rolling_figures(line, n) for line in lines]
            if any(inside):
                yield "  largest element force [N]", *(fixed(one["element_force_N"], 1) for one in inside)
                yield "  life [million revolutions]", *(lasting(one["life_Mrev"]) for one in inside)


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
            yield label.strip(), *(Cell(shown(value, name), value) for value, name in values)
    if not scene.analysis.root_stress:
        return
    for name, nominal in zip(GEARS, scene.nominal_root_stress, strict=True):
        if math.isfinite(nominal):
            yield f"nominal root stress, ISO, {name} [MPa]", *(plain(nominal * torque) for torque in torques)
    if math.isfinite(scene.tooth_height_over_width):
        yield RIM_LABEL.strip(), *(shown(rim_factor(gear, pair.module), "") for gear in (pair.pinion, pair.wheel))


def _strength_rows(scene: Scene) -> Iterator[Row]:
    """Allowable stresses of both gears and what a rating is to require, where the scene has them."""
    for name, gear in zip(GEARS, (scene.pinion, scene.wheel), strict=True):
        if gear.strength is not None:
            limits = gear.strength.limits
            label = f"{name}.strength: sigma_H_lim, sigma_F_lim [MPa]"
            yield (
                Label(label, f"{name}_strength_MPa", "sigma_H_lim", "sigma_F_lim"),
                *(plain(limit) for limit in limits),
            )
    wanted = scene.rating
    if wanted is not None:
        required = wanted.required_flank_safety, wanted.required_root_safety
        yield (
            Label("rating: required S_H, S_F, life [h]", "required", "S_H", "S_F", "life_h"),
            *(plain(one) for one in required),
            plain(wanted.life_hours or scene.load.hours or 0.0, 9),
        )


def mounting_rows(scene: Scene) -> list[Row]:
    """Mounting errors of a scene by their keys, of half b of a double helical wheel too."""
    return _changed(scene.mounting, "mounting.") or [("mounting errors", "none")]


def _departures(scene: Scene) -> Iterator[Row]:
    """Rounded edges and modifications that a scene asks for, by their keys."""
    for name, gear in (("pinion", scene.pinion), ("wheel", scene.wheel)):
        for edge, radius in (("tip", gear.tip_rounding_mm), ("side", gear.side_rounding_mm)):
            yield f"{name}.{edge}_rounding_mm", f"{plain(radius, 6)}" if radius else "sharp"
        yield from _changed(gear.modifications, f"{name}.modifications.") or [(f"{name}.modifications", "none")]


def _pitch_rows(scene: Scene, pair: GearPair) -> Iterator[Row]:
    """Single and cumulative pitch deviations of index deviations, along the line of action as these; and runout.

    Of a tolerance class of ISO 1328-1 as they are drawn at random: its tolerances times cos(alpha_t).
    """
    parts = "f_p_um", "F_p_um", "runout_um"
    for name, gear, teeth in zip(GEARS, (scene.pinion, scene.wheel), scene.tooth_deviations(pair), strict=True):
        if gear.pitch is not None and gear.pitch.is_given:
            single, total = np.abs(teeth.index - np.roll(teeth.index, 1)).max(), np.ptp(teeth.index)
            label = Label(f"{name}: f_p, F_p at base circle, runout [um]", f"{name}_pitch", *parts)
            yield label, *(fixed(1e3 * float(size), 2) for size in (single, total, 2.0 * teeth.eccentricity))


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
            yield f"{name}: deviations at points, from, to [um]", fixed(at_points.min(), 2), fixed(at_points.max(), 2)
            yield f"{name}: deviations of flank, from, to [um]", fixed(excess.min(), 2), fixed(excess.max(), 2)
            yield from _measured_rows(scene, name)
        errors = {"at points": flank.fit_error, "between them": flank.check_error}
        for where, error in errors.items():
            if error is not None:
                label = f"{name}: fit {where}, largest, rms [um]"
                yield label, plain(1e3 * error.largest, 2), plain(1e3 * error.rms, 2)


def _measured_rows(scene: Scene, name: str) -> Iterator[Row]:
    """Modifications of a measured flank, where its points tell them apart."""
    from loaded_tca.flank_maps.measured_modifications import measured_modifications

    try:
        made = measured_modifications(scene, name)
    except InputError:  # of few points
        return
    for key, design, value in zip(made.keys, made.design, made.measured, strict=True):
        yield f"{name}: {key.removesuffix('_um')}, of the scene, measured [um]", fixed(design, 2), fixed(value, 2)


def _changed(section: Section, place: str) -> list[Row]:
    """Values of a section, and of those inside, that are not its defaults."""
    usual, rows = contents(type(section)()), []
    for key, value in contents(section).items():
        if isinstance(value, Section):
            rows += _changed(value, f"{place}{key}.")
        elif value != usual[key]:
            rows.append((place + key, f"{value}"))
    return rows
