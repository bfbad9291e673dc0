"""Transmission error of one tooth pair
====================================

Transmission error of a crowned spur pair under three torques.

Writes transmission_error.png. The transmission error is the contact deformation of the flanks, which grows with the
load to the power 2/3 as long as the contact reaches no edge.
"""

import math
from pathlib import Path

from loaded_tca import analyse, read_scene
from loaded_tca.plots import plot_transmission_error, save_figure

SCENE = Path(__file__).parent / "scenes" / "spur.toml"
TORQUES = (10.0, 25.0, 60.0)  # N m


def main() -> float:
    """Return the power with which the transmission error at the pitch point grows with the torque."""
    scene = read_scene(SCENE).with_changes({"analysis.torques_Nm": TORQUES, "analysis.positions": 11})
    result = analyse(scene)
    print(result.summary())
    save_figure(plot_transmission_error(result), "transmission_error.png")

    pitch_point = len(result.path) // 2
    error = result.transmission_error[:, pitch_point]  # rad
    return math.log(error[-1] / error[0]) / math.log(TORQUES[-1] / TORQUES[0])


if __name__ == "__main__":
    main()
