"""The command check: what a scene or a stage amounts to before any contact, as a table, as JSON and as a picture."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from loaded_tca.cli.inputs import check_place, read_otherwise, scene_of, stage_of
from loaded_tca.cli.terminal import print_files, show
from loaded_tca.scene.variants import has_halves
from loaded_tca.stages.files import is_stage_file

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.figure import Figure

    from loaded_tca.output.overview_text import Overview
    from loaded_tca.scene import Scene

PICTURE = "first_look"


def check(options: argparse.Namespace) -> None:
    """Show the geometry of a scene or of a stage, and draw it where a directory is given."""
    if options.out is not None:
        check_place(options.out)
    if is_stage_file(options.scene):
        from loaded_tca.output.stage_overview import overview_of_stage
        from loaded_tca.stages.sections import RING_MESH, SUN_MESH

        stage = stage_of(options)
        overview = overview_of_stage(stage)
        scenes: dict[str, tuple[Scene, Mapping[str, str]]] = {
            f"{PICTURE}_sun": (stage.sun_scene, SUN_MESH),
            f"{PICTURE}_ring": (stage.ring_scene, RING_MESH),
        }
    else:
        scene = scene_of(options)
        overview, scenes = _overview_of(scene), {PICTURE: (scene, {})}
    written = [*read_otherwise(options.scene)]
    paths = []
    if options.out is not None:
        from loaded_tca.plots import plot_first_look, png_of
        from loaded_tca.results.files import replace_together

        pictures = {
            f"{name}.png": png_of(_in_words(plot_first_look(each), gears)) for name, (each, gears) in scenes.items()
        }
        paths = [*replace_together(options.out, pictures)]
    if options.json:
        files = [str(path) for path in paths]
        print(overview.to_json(written_otherwise=[line.strip() for line in written[1:]], files=files))
        return
    show("\n".join([overview.text, *written]) + "\n" * bool(paths))
    if paths:
        print_files(paths)


def _in_words(figure: Figure, gears: Mapping[str, str]) -> Figure:
    """A picture whose gears have the names of a stage, if they are of one."""
    from matplotlib.text import Text

    from loaded_tca.stages.sections import words_of

    for text in figure.findobj(Text) if gears else ():
        assert isinstance(text, Text)
        text.set_text(words_of(gears, text.get_text()))
    return figure


def _overview_of(scene: Scene) -> Overview:
    """The overview of a scene."""
    if has_halves({"pair": scene.geometry}):
        from loaded_tca.output.double_helical_overview import overview_of_double_helical
        from loaded_tca.scene.double_helical import DoubleHelicalScene

        assert isinstance(scene, DoubleHelicalScene)
        return overview_of_double_helical(scene)
    from loaded_tca.output.overview import overview_of_scene

    return overview_of_scene(scene)
