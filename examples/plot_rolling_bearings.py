"""A helical pair on rolling bearings
==================================

Ball, cylindrical and tapered roller bearings by their inner geometry: misalignment over the torque, which is not in
proportion to it, what the supports do to the load over the face, and the loads around the rings. Writes
rolling_bearings.png and prints the numbers.
"""

from pathlib import Path

import numpy as np

from loaded_tca import analyse, read_scene
from loaded_tca.plots import plot_bearing_loads, save_figure
from loaded_tca.results import element_forces

SCENE = Path(__file__).parent / "scenes" / "helical_on_rolling_bearings.toml"
CHANGES: dict[str, object] = {"analysis.positions": 9, "analysis.torques_Nm": [20.0, 40.0, 80.0, 130.0, 260.0]}


def main() -> float:
    """Return the sum of the forces of all rollers over the force on their bearing: one."""
    scene = read_scene(SCENE).with_changes(CHANGES)
    result = analyse(scene)
    rigid = analyse(scene.with_changes({"pinion.shaft": None, "wheel.shaft": None}))
    for name, one in {"rigid supports": rigid, "rolling bearings": result}.items():
        print(f"K_Hbeta, {name}:", one.face_load_factor)
    print("misalignment [um]:", result.misalignment.mean(axis=1))
    print("life of the pinion's bearings [1e6 revolutions]:", result.pinion_bearing_life[-1])
    save_figure(plot_bearing_loads(result), "rolling_bearings.png")

    bearing, forces = element_forces(result, "pinion", -1)[1]
    around = np.stack([np.cos(bearing.angles), np.sin(bearing.angles)])
    on_bearing = result.pinion_bearing_force[-1, :, 1, :2]
    return float(np.linalg.norm(around @ forces.T) / np.linalg.norm(on_bearing))


if __name__ == "__main__":
    main()
