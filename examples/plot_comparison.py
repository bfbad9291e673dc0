"""Several results compared
========================

A spur pair out of line, to both sides and with more crowning, compared with the same pair in line.

Writes comparison.png, and prints the key figures with their differences.
"""

from pathlib import Path

from loaded_tca import analyse, read_scene
from loaded_tca.plots import plot_comparison, save_figure
from loaded_tca.results import compare_results

SCENE = Path(__file__).parent / "scenes" / "mesh_cycle_spur.toml"
QUICK = {"analysis.torques_Nm": None, "analysis.positions": 17, "analysis.cells": (24, 32), "analysis.accuracy": None}
CROWNING, ERROR = "pinion.modifications.lead_crowning_um", "mounting.out_of_plane_deg"
VARIANTS = {
    "in line": {},
    "+0.02 deg": {ERROR: 0.02},
    "-0.02 deg": {ERROR: -0.02},
    "+0.02 deg, 10 µm of crowning": {ERROR: 0.02, CROWNING: 10.0},
}


def main() -> float:
    """Return the rise of K_Hbeta under one error over that under its opposite: 1, as they mirror each other."""
    scene = read_scene(SCENE).with_changes(QUICK)
    comparison = compare_results({name: analyse(scene.with_changes(changes)) for name, changes in VARIANTS.items()})
    print(comparison.summary())
    save_figure(plot_comparison(comparison), "comparison.png")

    rise = comparison.figures.difference.sel(figure="face_load_factor").isel(torque=0)
    return float(rise.sel(result="+0.02 deg") / rise.sel(result="-0.02 deg"))


if __name__ == "__main__":
    main()
