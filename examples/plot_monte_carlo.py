"""Monte Carlo of misalignment
===========================

Monte Carlo of misalignment: how far the load gathers on one part of the face of a crowned spur pair.

Writes monte_carlo.png: histogram, cumulative curve and percentiles of the face load factor over 32 misalignments, each
a whole analysis. The same study as a file is examples/studies/misalignment.toml.
"""

from pathlib import Path

from scipy.stats import norm, spearmanr

from loaded_tca import read_scene
from loaded_tca.plots import plot_study_histogram, save_figure
from loaded_tca.studies import Study, run_study

FEW = {"analysis.positions": 3, "analysis.compliance": "contact", "analysis.free_edges": False}  # seconds, not minutes
SCENE = read_scene(Path(__file__).parent / "scenes" / "mesh_cycle_spur.toml").with_changes(
    {**FEW, "analysis.torques_Nm": [130.0]}
)
STUDY = Study(SCENE, distributions={"mounting.misalignment_um": norm(0.0, 5.0)}, samples=32, seed=1)


def main() -> float:
    """Return the rank correlation of misalignment and face load factor: either sign makes it worse, so it is 1."""
    found = run_study(STUDY)
    save_figure(plot_study_histogram(found, "face_load_factor"), "monte_carlo.png")
    factor = found["face_load_factor"][:, 0]
    print(f"95 % of the pairs have a face load factor below {factor.quantile(0.95):.3f}")
    return float(spearmanr(abs(found["mounting.misalignment_um"]), factor).statistic)


if __name__ == "__main__":
    main()
