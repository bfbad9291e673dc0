"""All kinds of pictures of studies
================================

Every kind of picture of sensitivities, studies of parameters and tolerances, and a design, with what one reads from it.
"""

from pathlib import Path

from scipy.stats import norm

from loaded_tca import analyse, plots, read_scene
from loaded_tca.studies import DesignModel, Study, optimise, robustness, run_study

LEAD, TIP = "pinion.modifications.lead_crowning_um", "wheel.modifications.tip_relief_um"
RELIEF = {TIP: 10.0, "wheel.modifications.tip_relief_start_mm": 179.0, "analysis.torques_Nm": [60.0, 130.0]}
COARSE = {"analysis.positions": 5, "analysis.cells": (16, 24), "analysis.accuracy": None}  # seconds, not minutes
FEW = COARSE | {"analysis.compliance": "contact", "analysis.free_edges": False}
HELICAL = read_scene(Path(__file__).parent / "scenes" / "mesh_cycle_helical.toml").with_changes(FEW | RELIEF)
SCATTER = {"mounting.misalignment_um": norm(0.0, 5.0), LEAD: norm(5.0, 1.0)}
OF_SENSITIVITIES = "tornado", "sensitivity_curves", "transmission_error_band", "removal_weights"


def main() -> None:
    """Draw those of sensitivities, of a sampled and a swept study, and of a design."""
    found, sampled = analyse(HELICAL).sensitivities(list(SCATTER)), run_study(Study(HELICAL, {}, SCATTER, 8))
    drawn = {kind: getattr(plots, f"plot_{kind}")(found) for kind in OF_SENSITIVITIES}
    drawn["first_order_scatter"] = plots.plot_first_order_scatter(found, sampled)
    swept = run_study(Study(HELICAL, {LEAD: [2.0, 5.0, 8.0], TIP: [5.0, 10.0]}))
    drawn |= plots.plot_study(swept, ["peak_pressure_MPa"]) | plots.plot_study(sampled, ["transmission_error_span_um"])
    model = DesignModel(HELICAL, {LEAD: (0.0, 15.0), TIP: (0.0, 30.0)}, SCATTER, torques=[60e3, 130e3], samples=2)
    design = optimise(model, "mean + k sigma")
    kept = robustness(model, {"start": design.start, "optimum": design.optimum}, [0.0, 1.0, 2.0])
    drawn |= {"before_and_after": plots.plot_before_and_after(design), "robustness": plots.plot_robustness(kept)}
    drawn["peak_to_peak_over_torque"] = plots.plot_peak_to_peak_over_torque(design)
    for name, figure in drawn.items():
        plots.save_figure(figure, f"{name}.png")


if __name__ == "__main__":
    main()
