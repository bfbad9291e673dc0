"""The design of the guide docs/guide/design_micro_geometry.md, and its pictures.

Run from the root of the repository: ``python -m docs.guide.design_micro_geometry``.
"""

from pathlib import Path

import numpy as np

from examples.design_helical import SCATTER, SCENE, VARIABLES
from loaded_tca.plots import plot_before_and_after, plot_peak_to_peak_over_torque, plot_robustness
from loaded_tca.studies import DesignModel, optimise, robustness

FOLDER = Path(__file__).parent
TORQUES = [50e3, 100e3, 250e3, 300e3]


def main() -> None:
    """Design, and draw."""
    scene = SCENE.with_changes({"analysis.positions": 9})
    model = DesignModel(scene, VARIABLES, SCATTER, torques=TORQUES, samples=8, seed=1)
    result = optimise(model, "mean + k sigma", limits={"pressure_MPa": {300e3: 1300.0}})
    kept = robustness(model, {"start": result.start, "optimum": result.optimum}, np.linspace(0.0, 2.0, 9))
    for name, figure in {
        "design_before_and_after": plot_before_and_after(result),
        "design_over_torque": plot_peak_to_peak_over_torque(result),
        "design_robustness": plot_robustness(kept),
    }.items():
        figure.savefig(FOLDER / f"{name}.png", dpi=100)


if __name__ == "__main__":
    main()
