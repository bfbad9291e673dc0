"""The command 'settings --measured': settings corrected from measured flanks, with their tables and a picture."""

from __future__ import annotations

import argparse
from pathlib import Path

from loaded_tca.cli.inputs import check_files, scene_of
from loaded_tca.cli.terminal import print_summary
from loaded_tca.errors import require

PARTS = "corrections.csv", "deviations.csv", "deviations.png"
"""Ends of the names of the files beside the scene."""


def correct(options: argparse.Namespace) -> None:
    """Write the scene with corrected settings, their table, and maps of the deviations before and after."""
    from loaded_tca.flank_maps.settings_fit import fit_settings, read_measured_flank, usual_settings
    from loaded_tca.output.settings import corrections_csv, deviations_csv
    from loaded_tca.plots import plot_measured_settings, png_of
    from loaded_tca.results.files import replace_together

    require((options.method is None, f"--method {options.method}: only for bevel blanks; not allowed with --measured"))
    scene, out = scene_of(options), options.out
    files = [out.with_name(f"{out.stem}_{part}") for part in PARTS]
    for read in (Path(options.scene), *(file for _, _, file in options.measured)):
        check_files([out, *files], read)
    measured = [read_measured_flank(file, gear, flank) for gear, flank, file in options.measured]
    names = [key for key, _ in options.settings or []]
    require(*((names.count(key) < 2, f"--settings {key}: given twice") for key in dict.fromkeys(names)))
    limits = dict(options.settings or dict.fromkeys(usual_settings(scene, measured)))
    fit = fit_settings(scene, measured, limits, turned=options.turned or "flank")
    written = fit.as_cut if options.as_cut else fit.corrected
    texts = written.to_toml(), corrections_csv(fit), deviations_csv(fit)
    contents = [*(text.encode() for text in texts), png_of(plot_measured_settings(fit))]
    names = [out.name, *(file.name for file in files)]
    paths = replace_together(out.parent, dict(zip(names, contents, strict=True)))
    print_summary(fit.summary(), paths)
