"""Pressure distribution of a crowned helical pair at the pitch point.

Writes pressure_distribution.png and prints the key figures.
"""

from pathlib import Path

from loaded_tca import analyse, read_scene
from loaded_tca.plots import plot_pressure_map, save_figure

SCENE = Path(__file__).parent / "scenes" / "helical.toml"


def main() -> float:
    """Return the force that the pressure map carries, over the one that the torque asks for."""
    scene = read_scene(SCENE).with_changes(
        {
            "analysis.positions": 1,  # the pitch point alone
            "analysis.accuracy": None,
            "analysis.cells": (64, 64),
        }
    )
    result = analyse(scene)
    print(result.summary())
    save_figure(plot_pressure_map(result), "pressure_distribution.png")

    one = result.maps[0][0][0]  # torque, position, tooth pair
    carried = one.pressure.sum() * one.spacing[0] * one.spacing[1]  # N
    wanted = result.torque[0] / result.path.pinion_lever[0]  # N mm / mm
    return carried / wanted


if __name__ == "__main__":
    main()
