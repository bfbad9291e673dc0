"""Interactive pages of a result and a study
=========================================

Sliders over positions and torques that move the pressure map, the contact on the flanks, curves and both teeth in
space, and parallel coordinates of a study, each as one HTML file that fetches nothing.

Writes explore_result.html and explore_study.html, to be opened in a browser. In a notebook ``result.explore()`` as the
last line of a cell shows the page there. Needs the extra ``interactive`` (Plotly).
"""

from pathlib import Path

from loaded_tca import analyse, read_scene
from loaded_tca.reports import explore
from loaded_tca.studies import Study, run_study

SCENE = Path(__file__).parent / "scenes" / "mesh_cycle_helical.toml"
QUICK = {
    "analysis.positions": 9,
    "analysis.torques_Nm": (40.0, 80.0, 130.0),
    "analysis.compliance": "contact",
    "analysis.accuracy": None,
    "analysis.cells": (16, 32),
}


def main() -> float:
    """Return the size of the page of the result in MB."""
    scene = read_scene(SCENE).with_changes(QUICK)
    page = analyse(scene).explore()
    path = page.save("explore_result.html")

    coarse = scene.with_changes({"analysis.positions": 3, "analysis.torques_Nm": (130.0,)})
    values = {"pinion.modifications.lead_crowning_um": [4.0, 8.0, 12.0], "mounting.misalignment_um": [-10.0, 0.0, 10.0]}
    study = run_study(Study(coarse, factors=values))
    explore(study, rank_by="peak_pressure_MPa").save("explore_study.html")

    size = 1e-6 * path.stat().st_size
    print(f"{path}: {size:.1f} MB with Plotly's script")
    return size


if __name__ == "__main__":
    main()
