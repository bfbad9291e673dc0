"""Draw the pictures of pages that examples, the demo and the commands draw, too.

Run from the root of the repository: ``python -m docs.pictures``. Other pictures have a script beside their page, those
of docs/studies the one in ``validation/`` that writes the page.
"""

import contextlib
import importlib
import shutil
import warnings
from pathlib import Path
from tempfile import TemporaryDirectory

from loaded_tca import AccuracyWarning, analyse, parse_scene, read_scene
from loaded_tca.cli import DEMO_SCENE
from loaded_tca.plots import plot_pressure_envelope, plot_root_stress, plot_root_stress_cycle, save_figure

DOCS = Path(__file__).parent
EXAMPLES = {
    "guide/hypoid_pair.png": "plot_hypoid_pair",
    "guide/study_heat_map.png": "plot_micro_geometry",
    "guide/teeth_in_mesh.png": "plot_teeth_in_mesh",
    "guide/vh_check.png": "plot_vh_check",
    "guide/vh_under_load.png": "plot_vh_under_load",
    "how_it_works/contact_pattern.png": "plot_contact_pattern",
    "how_it_works/ease_off.png": "plot_ease_off",
    "how_it_works/local_synthesis.png": "plot_local_synthesis",
    "how_it_works/teeth_in_contact.png": "plot_tooth_3d",
    "how_it_works/tip_relief_and_rounding.png": "plot_tip_relief_and_rounding",
}
"""Pictures that are those of a script of ``examples/``."""
TORQUE = 1
"""Index of that of the root stress over the fillets: 130 N m."""


def main() -> None:
    """Draw all."""
    for picture, name in EXAMPLES.items():
        with TemporaryDirectory() as folder, contextlib.chdir(folder):
            importlib.import_module(f"examples.{name}").main()
            shutil.copy(f"{name.removeprefix('plot_')}.png", DOCS / picture)
    save_figure(plot_pressure_envelope(analyse(parse_scene(DEMO_SCENE.read_text()))), DOCS / "start" / "demo.png")
    scene = read_scene(DOCS.parent / "examples" / "scenes" / "mesh_cycle_helical.toml")
    stressed = analyse(scene.with_changes({"analysis.root_stress": True}))
    save_figure(plot_root_stress(stressed, TORQUE), DOCS / "how_it_works" / "root_stress.png")
    save_figure(plot_root_stress_cycle(stressed), DOCS / "how_it_works" / "root_stress_cycle.png")


if __name__ == "__main__":
    warnings.simplefilter("ignore", AccuracyWarning)  # some show contacts that reach an edge
    main()
