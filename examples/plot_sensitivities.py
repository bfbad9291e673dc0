"""Sensitivities as a tornado chart
================================

What a micrometre, a hundredth of a degree and a newton metre do to a helical pair: a tornado chart.

Writes sensitivities.png: how the key figures change by the tolerance of each key, the most important ones on top. The
command 'loaded-tca sensitivities DIR' draws it, and more, of any result.
"""

import math
from pathlib import Path

from loaded_tca import analyse, read_scene
from loaded_tca.plots import plot_tornado, save_figure
from loaded_tca.results import default_tolerances, key_figure_slopes

SCENE = Path(__file__).parent / "scenes" / "mesh_cycle_helical.toml"
QUICK = {"analysis.torques_Nm": None, "analysis.positions": 9, "analysis.cells": (32, 32), "analysis.accuracy": None}
DISTANCE = "mounting.centre_distance_error_mm"


def main() -> float:
    """Return the change of the mean transmission error by the centre distance, over that of involutes: 1."""
    scene = read_scene(SCENE).with_changes(QUICK)
    result = analyse(scene)
    tolerances = default_tolerances(scene) | {"pinion.modifications.lead_crowning_um": 2.0, DISTANCE: 0.02}
    found = result.sensitivities(list(tolerances))
    save_figure(plot_tornado(found, tolerances), "sensitivities.png")

    span = result.key_figures()[0]["transmission_error_span_um"]
    scatter = 1e3 * result.wheel_base_radius * found.spread(tolerances)["peak_to_peak"].values[0]
    print(f"peak-to-peak transmission error {span:.3f} um, standard deviation by all keys {scatter:.3f} um")
    along = -1e3 * math.sin(scene.mesh().working_pressure_angle)  # um per mm, at the base circle of the wheel
    return float(key_figure_slopes(found)["transmission_error_mean_um"][0, found.keys.index(DISTANCE)]) / along


if __name__ == "__main__":
    main()
