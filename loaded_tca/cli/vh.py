"""The command vh: contact patterns over two mounting errors, with their numbers."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from loaded_tca.cli.inputs import check_place, executor_of, scene_of
from loaded_tca.cli.terminal import STUDY_BAR, bar_of, print_summary, say_cost
from loaded_tca.plots import png_of
from loaded_tca.results.files import replace_together

if TYPE_CHECKING:
    from loaded_tca.scene import Scene


def vh(options: argparse.Namespace) -> None:
    """Draw the contact pattern over two mounting errors, without load or under the scene's torque."""
    scene, directory = scene_of(options), options.out
    check_place(directory)
    v, h = (given or steps for given, steps in zip((options.v, options.h), scene.vh_steps(), strict=True))
    (_loaded if options.loaded else _unloaded)(options, scene, v, h)


def _unloaded(options: argparse.Namespace, scene: Scene, v: Sequence[float], h: Sequence[float]) -> None:
    """Patterns by a marking compound."""
    from loaded_tca.flank_maps import vh_check
    from loaded_tca.output.tables import vh_table
    from loaded_tca.output.vh_text import vh_text
    from loaded_tca.plots import plot_vh_check
    from loaded_tca.plots.style import label_of

    keys = scene.vh_keys
    patterns = vh_check(
        lambda at_v, at_h: scene.with_changes(dict(zip(keys, (at_v, at_h), strict=True))).pair(),
        v,
        h,
        gear=options.gear,
    )
    names = f"V: {label_of(keys[0])}", f"H: {label_of(keys[1])}"
    contents = {
        "vh_check.csv": vh_table(patterns, keys).encode(),
        "vh_check.png": png_of(plot_vh_check(patterns, names, scene.title)),
    }
    print_summary(vh_text(patterns, keys), replace_together(options.out, contents))


def _loaded(options: argparse.Namespace, scene: Scene, v: Sequence[float], h: Sequence[float]) -> None:
    """Patterns under the torques of the scene, by a study that the same command continues."""
    from loaded_tca.output.tables import study_csv
    from loaded_tca.output.vh_text import loaded_vh_text
    from loaded_tca.plots import plot_loaded_vh_check
    from loaded_tca.plots.style import highest_torque, load
    from loaded_tca.results import load_result
    from loaded_tca.results.loaded_pattern import loaded_pattern
    from loaded_tca.studies import run_study, study_summary, vh_study

    directory, gear = options.out, options.gear
    study = vh_study(scene, v, h)
    say_cost(study, options.workers or 1)
    with executor_of(options, len(study)) as executor, bar_of("variants", len(study), STUDY_BAR) as progress:
        rows = run_study(study, executor, directory / "vh_study.nc", progress, keep_maps=range(len(study)))
    statuses = rows["status"].values.tolist()
    maps = Path(directory, "vh_study_maps")
    results = {k: load_result(maps / f"{k}.nc") for k, status in enumerate(statuses) if status == "ok"}
    figure = plot_loaded_vh_check(rows, results, gear=gear)
    first = next(iter(results.values()))
    torque = highest_torque(first)
    table = loaded_vh_text(
        rows,
        {k: loaded_pattern(result, torque, gear) for k, result in results.items()},
        getattr(first.gear_pair, gear).flank.frame,
        scene.vh_keys,
        f"loaded contact pattern on the {gear}, {load(first, torque)}",
    )
    loaded = {"vh_study.csv": study_csv(rows).encode(), "vh_under_load.png": png_of(figure)}
    written = [directory / "vh_study.nc", *replace_together(directory, loaded)]
    print_summary(f"{study_summary(rows)}\n\n{table}", written)
