"""A whole revolution
==================

A helical pair over a turn of its wheel, whose teeth stand beside their places: transmission error, orders, worst teeth.

Writes revolution_error.png, revolution_spectrum.png, revolution_shares.png and revolution_waterfall.png.
"""

from pathlib import Path

from loaded_tca import analyse_revolution, read_scene
from loaded_tca.plots import REVOLUTION_PICTURES, save_figure

SCENE = Path(__file__).parent / "scenes" / "revolution_helical.toml"
CHANGES: dict[str, object] = {"analysis.compliance": "contact", "analysis.positions": 5}


def main() -> float:
    """Return the first order of an eccentric wheel over its eccentricity: the closed form of involute gears is one."""
    scene = read_scene(SCENE).with_changes(CHANGES)
    revolution = analyse_revolution(scene)
    print(revolution.summary())
    for name, draw in REVOLUTION_PICTURES.items():
        save_figure(draw(revolution), f"{name}.png")

    eccentric = analyse_revolution(scene.with_changes({"wheel.pitch.index_um": None, "analysis.torques_Nm": [120.0]}))
    return float(eccentric.spectrum().amplitude[0]) / (0.5 * scene.wheel.pitch.runout_um)


if __name__ == "__main__":
    main()
