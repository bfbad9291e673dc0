"""Root stress over the mesh cycle
===============================

Root stress of a spur pair over the mesh cycle: tension and compression of pinion and wheel.

Writes root_stress.png and prints the summary, with the stress after ISO 6336-3 beside it.
"""

from pathlib import Path

from loaded_tca import analyse, read_scene
from loaded_tca.plots import plot_root_stress_cycle, save_figure

SCENE = Path(__file__).parent / "scenes" / "mesh_cycle_spur.toml"


def main() -> float:
    """Return the tension of the pinion at the end of the cycle over that at its begin, a pitch before: 1."""
    scene = read_scene(SCENE).with_changes(
        {
            "analysis.root_stress": True,
            "analysis.positions": 17,
            "analysis.torques_Nm": [130.0, 260.0],
        }
    )
    result = analyse(scene)
    print(result.summary())
    save_figure(plot_root_stress_cycle(result), "root_stress.png")

    return float(result.root_tension[0, -1, 0] / result.root_tension[0, 0, 0])  # first torque, gear 0: the pinion


if __name__ == "__main__":
    main()
