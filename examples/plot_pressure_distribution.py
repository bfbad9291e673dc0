"""Pressure distribution
=====================

Pressure distribution of a crowned helical pair at the pitch point.

Writes pressure_distribution.png and prints the key figures.
"""

from pathlib import Path

from loaded_tca import analyse, read_scene
from loaded_tca.plots import plot_pressure_map, save_figure

SCENE = Path(__file__).parent / "scenes" / "helical.toml"


def main() -> float:
    """Return the torque that the pressure maps of all tooth pairs carry, over that of the scene."""
    scene = read_scene(SCENE).with_changes(
        {
            "analysis.positions": 1,  # the pitch point alone
            "analysis.accuracy": None,
            "analysis.cells": (64, 64),
        }
    )
    result = analyse(scene)
    print(result.summary())
    position, pair = result.most_loaded_contact(0)  # the peak pressure is that of a tip corner under little load
    highest = result.peak_pressure[0, position, pair]
    save_figure(plot_pressure_map(result, position, column=pair, highest=highest), "pressure_distribution.png")

    carried = 0.0  # N mm, by the tooth pairs under the first torque at the first position
    for one, path in zip(result.maps[0][0], result.paths, strict=True):
        if one is not None:
            carried += one.pressure.sum() * one.spacing[0] * one.spacing[1] * path.pinion_lever[0]
    return carried / result.torque[0]


if __name__ == "__main__":
    main()
