"""V-H check under load
====================

V-H check of a spiral bevel pair under load: where the pressure goes under mounting errors.

Writes vh_under_load.png: on the pinion, the highest pressure that each place sees under offsets V of the wheel and
axial displacements H of the pinion, and prints the peak pressures.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

from loaded_tca import load_result, read_scene
from loaded_tca.plots import plot_loaded_vh_check, save_figure
from loaded_tca.studies import run_study, vh_study

FEW = {"analysis.positions": 5, "analysis.compliance": "contact", "analysis.free_edges": False}  # seconds, not minutes
SCENE = read_scene(Path(__file__).parent / "scenes" / "mesh_cycle_bevel.toml").with_changes(
    {**FEW, "analysis.torques_Nm": [0.8]}
)
OFFSETS = (-0.01, 0.0, 0.01)  # mm
DISPLACEMENTS = (-0.01, 0.0, 0.01)  # mm


def main() -> float:
    """Return the shift of the contact along the face for H over that for -H, which to first order is -1."""
    study = vh_study(SCENE, OFFSETS, DISPLACEMENTS)
    with TemporaryDirectory() as folder:
        found = run_study(study, out=Path(folder, "vh.nc"), keep_maps=range(len(study)))
        save_figure(plot_loaded_vh_check(found, Path(folder, "vh_maps")), "vh_under_load.png")
        middle = [load_result(Path(folder, "vh_maps", f"{variant}.nc")) for variant in (1, 4, 7)]  # V = 0
    pressures = found["peak_pressure_MPa"].values.reshape(len(DISPLACEMENTS), len(OFFSETS))
    print(f"peak pressures [MPa], H down, V to the right:\n{pressures.round(0)}")
    back, nominal, forth = (float(result.path.pinion_axial[2]) for result in middle)
    return (forth - nominal) / (back - nominal)


if __name__ == "__main__":
    main()
