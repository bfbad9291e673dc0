"""The command 'measured': modifications of a measured flank beside those of its scene."""

from __future__ import annotations

import argparse
from pathlib import Path

from loaded_tca.cli.inputs import check_files, scene_of
from loaded_tca.cli.terminal import print_files, show
from loaded_tca.errors import require


def measured(options: argparse.Namespace) -> None:
    """Show what modifications a measured flank has, and write the scene that has them."""
    from loaded_tca.flank_maps.measured_modifications import measured_modifications
    from loaded_tca.flanks import read_topography
    from loaded_tca.results.files import replace_file
    from loaded_tca.scene.build import in_own_frame

    scene, gear = scene_of(options), options.gear
    pair = scene.analytic_pair(scene.sense)  # refuses scenes of more pairs than one
    topography = None if options.file is None else read_topography(options.file)
    if gear is None:
        stated = None if topography is None else topography.notes.get("gear")
        own = [name for name in ("pinion", "wheel") if getattr(scene, name).flank.measurement is not None]
        gear = stated if topography is not None else own[0] if len(own) == 1 else None
        require((gear in ("pinion", "wheel"), "--gear: missing; allowed pinion or wheel, whose flank is measured"))
    if options.out is not None:
        for read in filter(None, (Path(options.scene), options.file)):
            check_files([options.out], read)
    if topography is not None:
        topography = in_own_frame(topography, getattr(pair, gear).flank.frame.upwards)
    made = measured_modifications(scene, gear, topography, measured_from=options.measured_from)
    show(made.summary())
    if options.out is not None:
        replace_file(options.out, made.written.to_toml().encode())
        print_files([options.out])
