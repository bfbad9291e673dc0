"""The command check: what a scene or a stage amounts to before any contact, as text and as a picture."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from typing import TYPE_CHECKING

from loaded_tca.cli.inputs import check_place, read_otherwise, scene_of, stage_of
from loaded_tca.cli.terminal import print_files, show
from loaded_tca.errors import InputError
from loaded_tca.scene.cylindrical import CylindricalScene
from loaded_tca.scene.double_helical import DoubleHelicalScene
from loaded_tca.stages.files import is_stage_file

if TYPE_CHECKING:
    from loaded_tca.scene import Scene

PICTURE = "teeth_in_mesh"


def check(options: argparse.Namespace) -> None:
    """Show the geometry of a scene or of a stage, and draw the teeth in mesh where a directory is given."""
    if options.out is not None:
        check_place(options.out)
    if is_stage_file(options.scene):
        from loaded_tca.output.stage_overview import describe_stage

        stage = stage_of(options)
        text = describe_stage(stage)
        scenes: dict[str, Scene] = {f"{PICTURE}_sun": stage.sun_scene, f"{PICTURE}_ring": stage.ring_scene}
    else:
        scene = scene_of(options)
        text, scenes = _described(scene), {PICTURE: scene}
    text = "\n".join([text, *read_otherwise(options.scene)])
    if options.out is None:
        show(text)
        return
    pictures = _drawn(options, scenes)
    show(text + "\n")
    from loaded_tca.results.files import replace_together

    print_files(replace_together(options.out, pictures))


def _described(scene: Scene) -> str:
    """The text of a scene."""
    if isinstance(scene, DoubleHelicalScene):
        from loaded_tca.output.double_helical_overview import describe_double_helical

        return describe_double_helical(scene)
    from loaded_tca.output.overview import describe_scene

    return describe_scene(scene)


def _drawn(options: argparse.Namespace, scenes: Mapping[str, Scene]) -> dict[str, bytes]:
    """Pictures of scenes by the names of their files."""
    from loaded_tca.plots import plot_teeth_in_mesh, png_of

    pictures = {}
    for name, scene in scenes.items():
        if not isinstance(scene, CylindricalScene):
            raise InputError(
                f"--out {options.out}: check draws the teeth of gears on parallel axes, of type cylindrical; "
                f"'loaded-tca teeth' has those of a result of type {scene.geometry.type}"
            )
        pictures[f"{name}.png"] = png_of(plot_teeth_in_mesh(scene))
    return pictures
