"""A bevel pair from its dimension sheet
=====================================

The spiral bevel pair of ISO 23509:2016, annex F.2, by the few values that a sheet begins with: its blank, and where its
crowned flanks carry. Writes bevel_blank.png and prints the sheet.
"""

from pathlib import Path

from loaded_tca import analyse, read_scene
from loaded_tca.output import describe_scene
from loaded_tca.plots import plot_pressure_envelope, save_figure

SCENE = Path(__file__).parent / "scenes" / "spiral_bevel_blank.toml"
CHANGES: dict[str, object] = {"analysis.positions": 9, "analysis.compliance": "contact", "analysis.accuracy": 0.03}


def main() -> float:
    """Return the transverse contact ratio: 1.165 by ISO/TR 10300-30."""
    scene = read_scene(SCENE)
    print(describe_scene(scene))
    save_figure(plot_pressure_envelope(analyse(scene.with_changes(CHANGES))), "bevel_blank.png")
    return scene.mesh().transverse_contact_ratio


if __name__ == "__main__":
    main()
