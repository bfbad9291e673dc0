"""The commands: each reads, has it computed, writes its files and says what it has written."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from loaded_tca.cli.directories import (
    INTERACTIVE_REPORT,
    REPORT,
    files_beside_joined,
    files_beside_revolution,
    files_of_ratings,
    outdated_files,
    remove_empty_parts,
    require_place_of,
)
from loaded_tca.cli.inputs import (
    STUDY_FILE,
    changes_of,
    check_files,
    check_place,
    comparison_of,
    directory_of,
    directory_of_part,
    executor_of,
    file_of_report,
    file_of_revolution,
    index_of_position,
    index_of_torque,
    names_of_results,
    result_file,
    result_for_dynamics,
    result_of,
    scene_of,
    stage_of,
    subject_of_report,
    tolerances_of,
)
from loaded_tca.cli.terminal import BAR, STUDY_BAR, bar_of, print_files, print_summary, progress_bar, say_cost, show
from loaded_tca.errors import InputError, require
from loaded_tca.plain import plain

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from loaded_tca.double_helical import DoubleHelicalRating, DoubleHelicalResult
    from loaded_tca.rating import Rating
    from loaded_tca.results.mesh_cycle import MeshCycle
    from loaded_tca.results.result import Result
    from loaded_tca.scene import Scene
    from loaded_tca.scene.double_helical import DoubleHelicalScene
    from loaded_tca.stages import StageResult
    from loaded_tca.stages.rating import StageRating

# The modules that compute and draw take most of a second to import: each command imports what it needs.

DEMO_DIRECTORY = Path("loaded-tca-demo")
DERIVATIVES = "transmission_error", "load_share", "line_load", "peak_pressure", "face_load_factor"
"""Of a result; each takes linear problems of its own."""
DEMO_SCENE = Path(__file__).parents[1] / "demo.toml"


def demo(options: argparse.Namespace) -> None:
    """Write the scene file of the demo and run it."""
    from loaded_tca.input_files import read_bytes
    from loaded_tca.output.result_files import RESULT
    from loaded_tca.results.files import replace_together
    from loaded_tca.scene.parse import LARGEST_FILE, read_scene

    directory = options.out
    check_place(directory)
    require_place_of(directory, RESULT)
    scene, content = directory / "scene.toml", DEMO_SCENE.read_bytes()
    if scene.exists() and read_bytes(scene, LARGEST_FILE, "scene") != content:
        again = f"'loaded-tca run {scene} --out {directory}'"
        raise InputError(f"{scene}: has been changed, and the demo would replace it; rename it, or use {again}")
    replace_together(directory, {scene.name: content})
    _run_scene(read_scene(scene), directory)
    show(f"Next: change {scene}, for instance its lead_crowning_um, then try\n")
    show(f"  loaded-tca run {scene} --out my-pair")


def run(options: argparse.Namespace) -> None:
    """Read, analyse, write everything, and show the summary; a comparison with another side or supports where asked."""
    from loaded_tca.output.result_files import RESULT
    from loaded_tca.output.tables import COMPARISON_DATA
    from loaded_tca.scene.variants import has_halves

    scene, directory = scene_of(options), options.out
    check_place(directory)
    compared = options.coast or options.rigid
    if has_halves({"pair": scene.geometry}):
        from loaded_tca.scene.double_helical import DoubleHelicalScene

        assert isinstance(scene, DoubleHelicalScene)
        require(
            (
                not compared,
                "--coast, --rigid: not allowed with double helical pairs; run a scene with the other pair.driving, or "
                "a scene without shafts",
            )
        )
        _run_double_helical(scene, directory)
        return
    require_place_of(directory, COMPARISON_DATA if compared else RESULT)
    if not compared:
        _run_scene(scene, directory)
        return
    if options.coast:
        scenes = {"drive": scene, "coast": scene.coast_side()}
    else:
        scenes = {"supports": scene, "rigid": scene.on_rigid_supports()}
    for name, side in scenes.items():
        _run_scene(side, directory / name)
    _compare(scenes, [directory / name for name in scenes], directory)
    if options.coast:
        _show_rating_of_both(scene, directory)


def _show_rating_of_both(scene: Scene, directory: Path) -> None:
    """Show the command that rates both sides of a scene together, where its bins load both."""
    from loaded_tca.scene.rating import is_rated

    if is_rated(scene) and any(case.reversed for case in scene.load.case or ()):
        both = f"{directory / 'drive'} --coast {directory / 'coast'}"
        show(f"\nNext: 'loaded-tca rating {both}' rates both sides, reversed bins by the coast side,")
        show(f"and 'loaded-tca report {both}' writes a report with this rating")


def _run_scene(scene: Scene, directory: Path) -> None:
    """Analyse a scene, write everything into a directory, and show the summary; what is of an old result goes."""
    from loaded_tca.analysis import analyse
    from loaded_tca.effort import expected_run_effort
    from loaded_tca.output.result_files import write_report
    from loaded_tca.plots import plot_all

    torques, positions = len(scene.torques), scene.analysis.positions
    count = "positions" if torques == 1 else f"{torques} torques x {positions} positions"
    with progress_bar(expected_run_effort(scene), count, torques * positions) as progress:
        result = analyse(scene, progress=progress)
    report = write_report(result, directory, outdated=outdated_files(directory))
    remove_empty_parts(directory)
    try:
        pictures = plot_all(result, directory)
    except BaseException as error:  # an interrupt, too
        again = f"'loaded-tca plot {directory}' draws them"
        error.add_note(f"{directory}: the numbers are new, all pictures are missing: {again}")
        raise
    _show_rated(result, directory, [*report, *pictures])


def _run_double_helical(scene: DoubleHelicalScene, directory: Path) -> None:
    """Analyse a double helical pair, write everything into a directory, and show the summary."""
    from loaded_tca.double_helical import analyse_double_helical
    from loaded_tca.double_helical.analyse import expected_double_helical_effort
    from loaded_tca.double_helical.result import PAIR_FILE
    from loaded_tca.plots import double_helical_figures

    require_place_of(directory, PAIR_FILE)
    effort = expected_double_helical_effort(scene)
    with progress_bar(effort, "states of both halves", effort.contacts // 2) as progress:
        result = analyse_double_helical(scene, progress=progress)
    _show_rated(result, directory, _new(result, directory, double_helical_figures(result), files_beside_joined()))


def revolution(options: argparse.Namespace) -> None:
    """Analyse a whole revolution, write everything into a directory, and show the summary."""
    from loaded_tca.double_helical import DoubleHelicalRevolution
    from loaded_tca.double_helical.result import PAIR_REVOLUTION_FILE
    from loaded_tca.double_helical.revolution import expected_halves_revolution_effort
    from loaded_tca.plots import halves_revolution_figures
    from loaded_tca.plots.revolution import revolution_figures
    from loaded_tca.results.revolution import REVOLUTION_FILE
    from loaded_tca.revolution import analyse_revolution, expected_revolution_effort
    from loaded_tca.scene.double_helical import DoubleHelicalScene

    scene, directory = scene_of(options), options.out
    check_place(directory)
    if isinstance(scene, DoubleHelicalScene):
        require_place_of(directory, PAIR_REVOLUTION_FILE)
        states, effort = "states of both halves", expected_halves_revolution_effort(scene)
    else:
        require_place_of(directory, REVOLUTION_FILE)
        states, effort = "states", expected_revolution_effort(scene)
    with progress_bar(effort, states, effort.contacts // 2) as progress:
        result = analyse_revolution(scene, progress)
    if isinstance(result, DoubleHelicalRevolution):
        figures = halves_revolution_figures(result)
    else:
        figures = revolution_figures(result)
    written = _new(result, directory, figures, files_beside_revolution())
    print_summary(result.summary(), written)


def _new(result: Result, directory: Path, figures: Mapping[str, Figure], names: set[str]) -> tuple[Path, ...]:
    """Write the files of a new result with its pictures; what is of an old one, also of its parts, goes."""
    written = _written(result, directory, figures, outdated_files(directory, names))
    remove_empty_parts(directory)
    return written


def _written(
    result: Result, directory: Path, figures: Mapping[str, Figure], outdated: Iterable[str] = ()
) -> tuple[Path, ...]:
    """Write the files of a result with its pictures."""
    from loaded_tca.output import write_result
    from loaded_tca.plots.style import pngs_of

    return write_result(result, directory, pngs_of(figures), outdated)


def tribology(options: argparse.Namespace) -> None:
    """Write loss, temperatures and films of a result at speeds, with tables and pictures, and show the summary."""
    from loaded_tca.plots import tribology_figures

    speed = {} if options.speed is None else {"operation.pinion_speed_rpm": options.speed[0]}
    result, directory = _changed_result(options, _is_of_tribology, OF_TRIBOLOGY, speed)
    evaluated = result.tribology(options.speed)
    written = _written(evaluated, directory, tribology_figures(evaluated))
    each = range(len(options.speed or [None]))
    print_summary("\n\n".join(evaluated.summary(speed=speed) for speed in each), written)


def rating(options: argparse.Namespace) -> None:
    """Write safeties and lives of a result with all factors and pictures, and show the table."""
    result: MeshCycle | StageResult | DoubleHelicalResult
    rated: Rating | StageRating | DoubleHelicalRating
    kind = _joined_kind(result_file(options.result))
    if kind is None:
        result, directory = _changed_result(options, _is_of_rating, OF_RATING)
        rated = result.rating(coast=None if options.coast is None else _coast_of(options.coast))
    else:
        require((options.coast is None, f"--coast: not allowed with {kind.FILE}; allowed with the result of one pair"))
        result, directory = _changed_joined(options, kind)
        rated = result.rating()
    print_summary(rated.summary(), _rating_files(rated, directory))


def _coast_of(place: Path) -> MeshCycle:
    """Result of a coast side, which a rating takes the flanks of reversed bins from."""
    from loaded_tca.results.mesh_cycle import MeshCycle

    return MeshCycle.load(result_file(place))


def _joined_kind(path: Path) -> type[StageResult | DoubleHelicalResult] | None:
    """Kind of the result of a file that joins mesh cycles; None: it is none of them."""
    from loaded_tca.double_helical import DoubleHelicalResult
    from loaded_tca.stages import StageResult

    kinds: tuple[type[StageResult | DoubleHelicalResult], ...] = (StageResult, DoubleHelicalResult)
    return next((kind for kind in kinds if path.name == kind.FILE), None)


def _changed_joined(
    options: argparse.Namespace, kind: type[StageResult | DoubleHelicalResult]
) -> tuple[StageResult | DoubleHelicalResult, Path]:
    """Result that joins mesh cycles with what its rating is to take otherwise, and where its files go."""
    from loaded_tca.scene import Scene
    from loaded_tca.scene.section import writing_at

    path = result_file(options.result)
    result = kind.load(path)
    directory = options.out or directory_of(path)
    check_place(directory)
    subject, changes = getattr(result, kind.SUBJECT), changes_of(options)
    of_scene = isinstance(subject, Scene)
    strengths, allowed = (STRENGTHS, OF_RATING) if of_scene else (STAGE_STRENGTHS, OF_STAGE_RATING)
    keys = ((key, writing_at(subject, key)[0] if of_scene else key) for key in changes)
    require(*((_is_of_rating(name, strengths), f"--set {key}: {allowed}") for key, name in keys))
    return replace(result, **{kind.SUBJECT: subject.with_changes(changes)}) if changes else result, directory


def _rating_files(rated: Rating | StageRating | DoubleHelicalRating, directory: Path) -> tuple[Path, ...]:
    """Write a rating with its pictures; those of an older one that it does not have go."""
    from loaded_tca.plots import rating_figures

    return _written(rated, directory, rating_figures(rated), files_of_ratings())


def _rated(result: MeshCycle | StageResult | DoubleHelicalResult, directory: Path) -> tuple[list[Path], str]:
    """Files of the rating of a result whose scene or stage has [rating], and its summary, or why it cannot be rated."""
    if getattr(result, result.SUBJECT).rating is None:
        return [], ""
    try:
        rated = result.rating()
    except InputError as error:
        return [], "\n".join(f"no rating: {problem}" for problem in error.problems)
    return [*_rating_files(rated, directory)], rated.summary()


def _show_rated(
    result: MeshCycle | StageResult | DoubleHelicalResult, directory: Path, written: Iterable[Path]
) -> None:
    """Rate a result whose scene or stage has [rating]; show its summary and that of the rating, and all files."""
    files, rating_text = _rated(result, directory)
    print_summary("\n\n".join(filter(None, (result.summary(), rating_text))), [*written, *files])


def _changed_result(
    options: argparse.Namespace,
    is_allowed: Callable[[str], bool],
    allowed: str,
    defaults: Mapping[str, Any] = {},
) -> tuple[MeshCycle, Path]:
    """Result that a command evaluates, with what its options and else ``defaults`` change, and where its files go."""
    from loaded_tca.results.mesh_cycle import MeshCycle
    from loaded_tca.scene.section import writing_at

    path = result_file(options.result)
    result = MeshCycle.load(path)
    directory = options.out or directory_of(path)
    check_place(directory)
    changes = changes_of(options)
    require(*((is_allowed(writing_at(result.scene, key)[0]), f"--set {key}: {allowed}") for key in changes))
    if changes := {**defaults, **changes}:
        result = replace(result, scene=result.scene.with_changes(changes))
    return result, directory


STRENGTHS = "pinion.strength", "wheel.strength"
STAGE_STRENGTHS = "sun.strength", "planet.strength", "ring.strength"
SPECTRUM = "load.spectrum", "load.case"
OF_RATING, OF_STAGE_RATING = (
    f"needs another analysis; allowed keys of {', '.join(f'[{name}]' for name in sections)}, [rating], [operation] "
    f"and [lubricant], and a load spectrum: {', '.join(SPECTRUM)}"
    for sections in (STRENGTHS, STAGE_STRENGTHS)
)


def _is_of_rating(key: str, strengths: Sequence[str] = STRENGTHS) -> bool:
    """Whether a key of a scene or stage concerns rating alone, so that a result stays valid."""
    return key.startswith(SPECTRUM) or key.rpartition(".")[0] in (*strengths, "rating", "operation", "lubricant")


ROUGHNESS, THERMAL = "roughness_Ra_um", ("conductivity_W_mK", "density_kg_m3", "heat_capacity_J_kgK")
"""Keys of gears and of materials that concern tribology alone."""
OF_TRIBOLOGY = (
    f"needs another analysis; allowed keys of [operation] and [lubricant], {ROUGHNESS} of the gears, and "
    f"{', '.join(THERMAL[:-1])} and {THERMAL[-1]} of materials"
)


def _is_of_tribology(key: str) -> bool:
    """Whether a key of a scene concerns tribology alone, so that a result stays valid."""
    section, _, name = key.rpartition(".")
    return section in ("operation", "lubricant") or name in (ROUGHNESS, *THERMAL)


def stage(options: argparse.Namespace) -> None:
    """Analyse a planetary stage, write everything into a directory, and show the summary."""
    from loaded_tca.plots import stage_figures
    from loaded_tca.stages import analyse_stage
    from loaded_tca.stages.analyse import expected_stage_effort, states_of
    from loaded_tca.stages.result import STAGE_FILE

    asked, directory = stage_of(options), options.out
    check_place(directory)
    require_place_of(directory, STAGE_FILE)
    asked.require_assembly()
    states = states_of(asked)
    with progress_bar(expected_stage_effort(asked), "states of both meshes", states) as progress:
        result = analyse_stage(asked, progress=progress)
    _show_rated(result, directory, _new(result, directory, stage_figures(result), files_beside_joined()))


def plot(options: argparse.Namespace) -> None:
    """Draw the pictures of a result again."""
    from loaded_tca.plots import plot_all, plot_at_a_glance
    from loaded_tca.plots.style import pdf_of
    from loaded_tca.results.files import replace_together

    result, directory, torque, position = result_of(options)
    sheet = {"at_a_glance.pdf": pdf_of(plot_at_a_glance(result, torque))} if options.pdf else {}
    drawn = plot_all(result, directory, torque=torque, position=position, more=options.all)
    print_files([*drawn, *replace_together(directory, sheet)])


def tooth(options: argparse.Namespace) -> None:
    """Write the complete teeth of a result, and a picture of them."""
    from loaded_tca.output.surface_files import write_teeth
    from loaded_tca.pairs import mating_teeth
    from loaded_tca.plots import draw_teeth, png_of
    from loaded_tca.results.teeth import teeth_in_space

    result, directory, torque, position = result_of(options)
    teeth = mating_teeth(result.gear_pair, fillet_radius=options.fillet_radius)
    shown = teeth_in_space(result, teeth, position, torque)
    picture = {"teeth.png": png_of(draw_teeth(result, shown))}
    title = result.scene.title
    print_files(write_teeth(shown, teeth, directory, title=title, whole_gears=options.whole_gears, more=picture))


def subsurface(options: argparse.Namespace) -> None:
    """Write the stresses below a pressure map, and pictures of them."""
    from loaded_tca.output.tables import write_subsurface
    from loaded_tca.plots import plot_stress_below, png_of
    from loaded_tca.results.subsurface import NAMES, stress_below

    result, directory, torque, position = result_of(options)
    below = stress_below(result, torque, position, options.pair, gear=options.gear)
    pictures = {f"subsurface_{quantity}.png": png_of(plot_stress_below(below, quantity)) for quantity in NAMES}
    written = write_subsurface(below, directory, pictures)
    print_summary(below.summary(), written)


def compare(options: argparse.Namespace) -> None:
    """Show what results differ in."""
    check_place(options.out)
    names = names_of_results(options.results, options.names)
    _compare(names, options.results, options.out, options.torque, options.position)


def _compare(
    names: Iterable[str],
    results: Sequence[Path],
    directory: Path,
    torque_Nm: float | None = None,
    number: int | None = None,
) -> None:
    """Write the comparison of results under names, with pictures at a torque and position, and show it."""
    from loaded_tca.output.tables import write_comparison
    from loaded_tca.plots import COMPARISON_PICTURES, comparison_figures
    from loaded_tca.plots.style import pngs_of

    comparison = comparison_of(names, results)
    torque = None if torque_Nm is None else 1e3 * torque_Nm
    position = index_of_position(number, next(iter(comparison.results.values())))
    summary = comparison.summary(torque)
    figures = comparison_figures(comparison, torque, position)
    outdated = [f"{name}.png" for name in COMPARISON_PICTURES]
    print_summary(summary, write_comparison(comparison, directory, pngs_of(figures), outdated))


def sensitivities(options: argparse.Namespace) -> None:
    """Find what keys and their tolerances change in a result, and write tables and pictures of it."""
    from loaded_tca.double_helical.result import PAIR_FILE
    from loaded_tca.output.tables import sensitivities_text, write_sensitivities
    from loaded_tca.plots.sensitivities import sensitivity_pictures
    from loaded_tca.plots.style import pngs_of
    from loaded_tca.results.extremes import warn_of_positions
    from loaded_tca.results.idle_pairs import warn_of_pairs
    from loaded_tca.results.numbers import index_or_largest

    if result_file(options.result).name == PAIR_FILE:
        _sensitivities_of_halves(options)
        return
    result, directory, torque, _ = result_of(options)
    torque = index_or_largest(result.torque, torque)
    tolerances = tolerances_of(options, result.scene)
    with bar_of(f"derivatives by {len(tolerances)} keys", len(DERIVATIVES), BAR) as show:
        slopes = result.sensitivities(list(tolerances))
        for done, name in enumerate(DERIVATIVES, 1):
            getattr(slopes, name)
            if show is not None:
                show(done, len(DERIVATIVES))
    warn_of_positions(slopes, tolerances)
    warn_of_pairs(slopes, tolerances)
    text = sensitivities_text(slopes, tolerances, torque)
    pictures = sensitivity_pictures(slopes, tolerances, torque)
    print_summary(text, write_sensitivities(slopes, tolerances, directory, pngs_of(pictures)))


def _sensitivities_of_halves(options: argparse.Namespace) -> None:
    """The same of a double helical pair, of both halves together."""
    from loaded_tca.double_helical import DoubleHelicalResult
    from loaded_tca.output.double_helical_sensitivities import (
        sensitivities_of_halves_text,
        write_sensitivities_of_halves,
    )
    from loaded_tca.results.numbers import index_or_largest

    path = result_file(options.result)
    result = DoubleHelicalResult.load(path)
    torque = index_or_largest(result.torque, index_of_torque(options.torque, result))
    directory = directory_of_part(options, path)
    tolerances = tolerances_of(options, result.scene)
    slopes = result.sensitivities([*tolerances])
    text = sensitivities_of_halves_text(slopes, tolerances, torque)
    print_summary(text, write_sensitivities_of_halves(slopes, tolerances, directory))


def dynamics(options: argparse.Namespace) -> None:
    """Write the tables of a result that programs of rotor and gear dynamics read."""
    from loaded_tca.output.tables import DYNAMICS, tables_at, write_dynamics

    file = file_of_revolution(options.result)
    out = options.out or directory_of(file) / DYNAMICS
    require((not out.is_dir(), f"--out {out}: a directory; give the name of a file, as {out / DYNAMICS}"))
    check_files(tables_at(out), file)
    print_files(write_dynamics(result_for_dynamics(file), out))


def ease_off(options: argparse.Namespace) -> None:
    """Draw the ease-off of a scene."""
    from loaded_tca.flank_maps.ease_off_map import ease_off_map
    from loaded_tca.output.other_tables import ease_off_csv
    from loaded_tca.plots import plot_ease_off, png_of
    from loaded_tca.results.files import replace_together

    scene = scene_of(options)
    check_place(options.out)
    ease_off = ease_off_map(scene.pair(), options.gear)
    picture = png_of(plot_ease_off(ease_off, scene.title))
    paths = replace_together(options.out, {"ease_off.csv": ease_off_csv(ease_off).encode(), "ease_off.png": picture})
    for name, value in ease_off.named.items():
        show(f"{name:<34}{plain(round(value, 3) + 0.0, 3):>9}")
    print_files(paths)


def settings(options: argparse.Namespace) -> None:
    """Write the face-milled scene of a bevel blank, or one with settings corrected from measured flanks."""
    if options.measured:
        from loaded_tca.cli.measured_settings import correct

        correct(options)
        return
    only = ((options.settings, "--settings"), (options.turned, "--turned"), (options.as_cut, "--as-cut"))
    require(*((not value, f"{name}: needs --measured") for value, name in only))
    _settings_of_blank(options)


def _settings_of_blank(options: argparse.Namespace) -> None:
    """Write the face-milled scene of a bevel blank, with all its machine settings."""
    from loaded_tca.results.files import replace_file
    from loaded_tca.scene.bevel import BevelScene
    from loaded_tca.scene.blank_face_milled import BlankFaceMilledScene

    scene = scene_of(options)
    kind = f"{options.scene}: pair.type: allowed straight_bevel, spiral_bevel or face_milled, with [pair.blank]"
    require((isinstance(scene, BevelScene), kind))
    assert isinstance(scene, BevelScene)
    check_files([options.out], Path(options.scene))
    if isinstance(scene, BlankFaceMilledScene):
        cut: Scene = scene.with_method(options.method).cut if options.method else scene.cut
    else:
        cut = scene.face_milled(options.method or "duplex_spread_blade")
    replace_file(options.out, cut.to_toml().encode())
    print_files([options.out])


def measured(options: argparse.Namespace) -> None:
    """Show what modifications a measured flank has, and write the scene that has them."""
    from loaded_tca.cli.measured_flank import measured

    measured(options)


def shaft(options: argparse.Namespace) -> None:
    """Show the forces on the bearings of a scene's shafts, and write how they bend, without contact."""
    from loaded_tca.loaded.shaft_lines import shaft_lines
    from loaded_tca.output.other_tables import bearings_csv, bearings_text, shaft_csv
    from loaded_tca.plots import plot_shafts, png_of
    from loaded_tca.results.files import replace_together

    scene = scene_of(options)
    if options.out is not None:
        check_place(options.out)
    lines = shaft_lines(scene)
    show(bearings_text(lines) + "\n")
    if options.out is not None:
        picture = plot_shafts(lines, scene.title)
        contents = {"shaft.csv": shaft_csv(lines).encode(), "bearings.csv": bearings_csv(lines).encode()}
        print_files(replace_together(options.out, {**contents, "shaft.png": png_of(picture)}))


def vh(options: argparse.Namespace) -> None:
    """Draw the contact pattern over two mounting errors, without load or under the scene's torque."""
    from loaded_tca.cli.vh import vh

    vh(options)


def study(options: argparse.Namespace) -> None:
    """Analyse what is missing of a study, write its tables and pictures, and show the summary."""
    from loaded_tca.output.tables import write_study
    from loaded_tca.plots import plot_study
    from loaded_tca.plots.study import are_steps, require_axes
    from loaded_tca.plots.style import pngs_of
    from loaded_tca.scene.keys import did_you_mean, nearest
    from loaded_tca.studies import read_study, run_study, study_summary

    study, directory = read_study(options.study), options.out
    check_place(directory)
    require_place_of(directory, STUDY_FILE)
    if options.axes is not None:
        in_steps = (key for key, values in study.table.items() if are_steps(values, len(study)))
        require_axes(options.axes, [*in_steps, *study.factors])
    say_cost(study, options.workers or 1)
    with executor_of(options, len(study)) as executor, bar_of("variants", len(study), STUDY_BAR) as show:
        rows = run_study(study, executor, directory / STUDY_FILE, show, keep_maps=options.keep_maps)
    rank_by = options.rank_by if options.rank_by in rows else None  # another one is told once all is written
    written = write_study(rows, directory, pngs_of(plot_study(rows, rank_by=rank_by, axes=options.axes)), rank_by)
    print_summary(study_summary(rows), [directory / STUDY_FILE, *written])
    failed = (rows["status"] != "ok").values
    hint = did_you_mean(nearest(options.rank_by or "", [str(name) for name in rows.data_vars]))
    require(
        (
            rank_by == options.rank_by,
            f"--rank-by {options.rank_by}: not in study.csv; ranked by the default figure{hint}",
        ),
        (not failed.all(), "no variant was analysed; the summary says why"),
        *(
            (not failed[n], f"--keep-maps {n}: no maps, the variant is {rows['status'].values[n]}")
            for n in options.keep_maps
        ),
    )


def report(options: argparse.Namespace) -> None:
    """Write the report of a result, a revolution, a stage, a study or a design, or of several results."""
    from loaded_tca.reports import write_html_report

    if options.others:
        _report_comparison(options)
        return
    of_several = options.names is None and options.torque is None
    require((of_several, "--names, --torque: only for a comparison; give two results or more"))
    path, out = file_of_report(options.result), options.out
    out = directory_of(path) / (INTERACTIVE_REPORT if options.interactive else REPORT) if out is None else out
    check_files([out], path)
    coast = None
    if options.coast is not None:
        coast = _coast_of(options.coast)
        check_files([out], result_file(options.coast))
    subject = subject_of_report(path)
    date = datetime.fromtimestamp(path.stat().st_mtime, UTC).isoformat(timespec="seconds")
    date = getattr(subject, "date", "") or date
    ways = {"date": date, "rank_by": options.rank_by, "axes": options.axes, "interactive": options.interactive}
    print_files([write_html_report(subject, out, coast=coast, **ways)])


def _report_comparison(options: argparse.Namespace) -> None:
    """Write the report of several results beside each other."""
    from loaded_tca.reports import write_html_report

    require(
        (options.out is not None, "--out: missing; several results have no directory in common, give a file"),
        (options.rank_by is None, "--rank-by: only for a study; a comparison has no ranking"),
        (options.axes is None, "--axes: only for a study; a comparison varies no keys"),
        (options.coast is None, "--coast: only for one result; a comparison has no rating"),
    )
    paths = [options.result, *options.others]
    for path in paths:
        check_files([options.out], result_file(path))
    comparison = comparison_of(names_of_results(paths, options.names), paths)
    torque = None if options.torque is None else 1e3 * options.torque
    print_files([write_html_report(comparison, options.out, torque=torque)])


def check(options: argparse.Namespace) -> None:
    """Show the geometry of a scene or of a stage."""
    from loaded_tca.cli import check as overview

    overview.check(options)


def keys(options: argparse.Namespace) -> None:
    """Show the keys of scene and stage files."""
    from loaded_tca.cli.keys import keys

    keys(options)


def import_model(options: argparse.Namespace) -> None:
    """Write a stage of a REXS model as a scene, or show the stages that it has."""
    from loaded_tca.exchange import describe_stages, import_stage, read_rexs
    from loaded_tca.results.files import replace_file

    model = read_rexs(options.model)
    if options.stage is None:
        require((options.out is None, f"--out {options.out}: needs --stage"))
        show(describe_stages(model))
        return
    imported = import_stage(model, options.stage, load_case=options.load_case, torque_Nm=options.torque)
    if options.out is None:
        print(imported.to_toml(), end="")
        return
    check_files([options.out], options.model)
    replace_file(options.out, imported.to_toml().encode())
    print_summary(imported.summary(), [options.out])


def export_model(options: argparse.Namespace) -> None:
    """Write a REXS model with the numbers of a result."""
    from loaded_tca.output.rexs import write_rexs
    from loaded_tca.results.mesh_cycle import MeshCycle

    check_files([options.out], options.model)
    result = MeshCycle.load(result_file(options.result))
    torque = index_of_torque(options.torque, result)
    print_files([write_rexs(result, options.model, options.stage, options.out, torque)])
