"""Loaded transmission error
=========================

Transmission error of a helical pair whose tooth pairs share the load, under two torques.

Writes loaded_transmission_error.png. Without load the pair has the error of its profile crowning; under load the
deflection adds to it, and levels it out or deepens it as more pairs come to carry.
"""

from pathlib import Path

from loaded_tca import analyse, read_scene
from loaded_tca.plots import plot_transmission_error, save_figure

SCENE = Path(__file__).parent / "scenes" / "mesh_cycle_helical.toml"
POSITIONS = 9
TORQUES = (10.0, 40.0)  # N m


def main() -> float:
    """Return the transmission error at the end of the pitch over that at its begin: one, the cycle repeats."""
    result = analyse(read_scene(SCENE).with_changes({"analysis.positions": POSITIONS, "analysis.torques_Nm": TORQUES}))
    print(result.summary())
    save_figure(plot_transmission_error(result), "loaded_transmission_error.png")

    error = result.transmission_error[-1]  # under the larger torque
    return float(error[-1] / error[0])


if __name__ == "__main__":
    main()
