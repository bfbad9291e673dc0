"""A planetary stage
=================

A planet whose pin stands aside by 30 um takes more than its part of the torque, until the sun gives way: shares of the
planets with the sun fixed. Writes planetary_stage.png and prints the summary.
"""

from pathlib import Path

from loaded_tca.plots import plot_stage_shares, save_figure
from loaded_tca.stages import analyse_stage, read_stage, rebalanced

STAGE = Path(__file__).parent / "stages" / "wind_spur.toml"
CHANGES: dict[str, object] = {
    "stage.floating_sun": False,
    "analysis.positions": 5,
    "analysis.accuracy": 0.03,
    "analysis.compliance": "contact",
}


def main() -> float:
    """Return K_gamma with a floating sun: three planets hold it in balance only with equal forces."""
    result = analyse_stage(read_stage(STAGE).with_changes(CHANGES))
    print(result.summary())
    save_figure(plot_stage_shares(result), "planetary_stage.png")

    floating = rebalanced(result, {"stage.floating_sun": True})
    print("K_gamma: sun fixed", result.mesh_load_factor, "and floating", floating.mesh_load_factor)
    return float(floating.mesh_load_factor[-1])


if __name__ == "__main__":
    main()
