"""Shear stress below the surface
==============================

Greatest shear stress below the contact of a crowned spur pair at the pitch point, where pitting may start.

Writes subsurface_stress.png and prints depth and place beside what Hertz says.
"""

from pathlib import Path

from loaded_tca import analyse, read_scene
from loaded_tca.plots import plot_stress_below, save_figure
from loaded_tca.results import stress_below

SCENE = Path(__file__).parent / "scenes" / "spur.toml"


def main() -> float:
    """Return the greatest shear stress over that of Hertz: below a slender ellipse 0.30 p0 at 0.78 half widths."""
    scene = read_scene(SCENE).with_changes(
        {
            "analysis.positions": 1,  # the pitch point alone
            "analysis.accuracy": None,
            "analysis.cells": (48, 48),
        }
    )
    below = stress_below(analyse(scene))
    print(below.summary())
    save_figure(plot_stress_below(below, "max_shear"), "subsurface_stress.png")

    return below.largest("max_shear").value / below.hertz_shear.value


if __name__ == "__main__":
    main()
