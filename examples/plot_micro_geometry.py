"""Sweep of the micro-geometry
===========================

Sweep of lead crowning and tip relief of a helical pair: which one is quiet, and what it costs in pressure.

Writes micro_geometry.png: the peak-to-peak transmission error over the grid of both, the best one framed. The same
study as a file is examples/studies/micro_geometry.toml.
"""

from pathlib import Path

import numpy as np

from loaded_tca import read_scene
from loaded_tca.plots import plot_study_heat_map, save_figure
from loaded_tca.studies import Study, rank_variants, run_study

FEW = {"analysis.positions": 5, "analysis.compliance": "contact", "analysis.free_edges": False}  # seconds, not minutes
SCENE = read_scene(Path(__file__).parent / "scenes" / "mesh_cycle_helical.toml").with_changes(
    {**FEW, "analysis.torques_Nm": [130.0], "pinion.modifications.tip_relief_start_roll_deg": 26.0}
)
FACTORS = {
    "pinion.modifications.lead_crowning_um": [0.0, 4.0, 8.0, 12.0],
    "pinion.modifications.tip_relief_um": [0.0, 10.0, 20.0],
}
STUDY = Study(SCENE, FACTORS)


def main() -> float:
    """Return the part of the steps of crowning that raise the face load factor: less of the face carries each time."""
    found = run_study(STUDY)
    save_figure(plot_study_heat_map(found, "transmission_error_span_um"), "micro_geometry.png")
    print(rank_variants(found).head(5).to_string(index=False))
    factor = found["face_load_factor"].values.reshape([len(values) for values in FACTORS.values()])
    return float((np.diff(factor, axis=0) > 0.0).mean())


if __name__ == "__main__":
    main()
