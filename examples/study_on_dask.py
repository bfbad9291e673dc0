"""A study on a cluster
====================

A study on a cluster: peak pressure of a crowned helical pair over crowning and torque.

Starts a scheduler and two workers on this machine; on a cluster that is there already, ``Client("tcp://host:8786")``
takes their place. Writes study_on_dask.nc and .png; run again, it goes on where it stopped. Needs the package
distributed.
"""

from pathlib import Path

from distributed import Client, LocalCluster

from loaded_tca import read_scene
from loaded_tca.plots import plot_study_heat_map, save_figure
from loaded_tca.studies import Study, run_study

ONE_PAIR = {
    "analysis.positions": 3,
    "analysis.load_sharing": False,
    "analysis.compliance": "contact",
    "analysis.free_edges": False,
}
SCENE = read_scene(Path(__file__).parent / "scenes" / "helical.toml").with_changes(ONE_PAIR)
CROWNING, TORQUE = "pinion.modifications.lead_crowning_um", "load.pinion_torque_Nm"


def main() -> float:
    """Return the peak pressure under eight times the torque over that under one: 2 where Hertz holds."""
    study = Study(SCENE, factors={CROWNING: [8.0, 12.0, 16.0], TORQUE: [5.0, 40.0]})
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster, Client(cluster) as client:
        executor = client.get_executor(pure=False)  # pure: Dask would hash every task, for nothing
        found = run_study(study, executor, "study_on_dask.nc")
    save_figure(plot_study_heat_map(found, "peak_pressure_MPa"), "study_on_dask.png")
    print(found[["peak_pressure_MPa", "status"]].to_dataframe().to_string())
    peak = found["peak_pressure_MPa"].values.reshape(3, 2)  # the last factor changes fastest
    return float(peak[0, 1] / peak[0, 0])


if __name__ == "__main__":  # workers import this file
    main()
