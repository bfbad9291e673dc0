"""A whole revolution
==================

A helical pair over a turn of its wheel, whose teeth stand beside their places: its transmission error.

Writes revolution.png.
"""

from pathlib import Path

from loaded_tca import analyse_revolution, read_scene
from loaded_tca.plots import plot_revolution_error, save_figure

SCENE = Path(__file__).parent / "scenes" / "revolution_helical.toml"
CHANGES: dict[str, object] = {"analysis.compliance": "contact", "analysis.positions": 5}


def main() -> float:
    """Return the first order of an eccentric wheel over its eccentricity: the closed form of involute gears is one."""
    scene = read_scene(SCENE).with_changes(CHANGES)
    revolution = analyse_revolution(scene)
    print(revolution.summary())
    save_figure(plot_revolution_error(revolution), "revolution.png")

    eccentric = analyse_revolution(scene.with_changes({"wheel.pitch.index_um": None, "analysis.torques_Nm": [120.0]}))
    return float(eccentric.spectrum().amplitude[0]) / (0.5 * scene.wheel.pitch.runout_um)


if __name__ == "__main__":
    main()
