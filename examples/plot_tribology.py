"""Contact temperature and loss
============================

A helical pair at three speeds: contact temperature over the path of contact, efficiency, and the loss factor.

Writes tribology.png and prints the summary.
"""

from pathlib import Path

from loaded_tca import analyse, read_scene
from loaded_tca.plots import plot_contact_temperature, save_figure
from loaded_tca.tribology import Lubricant

SCENE = Path(__file__).parent / "scenes" / "mesh_cycle_helical.toml"
CHANGES: dict[str, object] = {"analysis.compliance": "contact", "analysis.positions": 17, "analysis.accuracy": 0.03}


def main() -> float:
    """Return the work of the torques of friction over the friction power: one."""
    result = analyse(read_scene(SCENE).with_changes(CHANGES))
    oil = Lubricant(viscosity_40=220.0, viscosity_100=19.0, density_15=890.0, oil_temperature=80.0)
    tribology = result.tribology([500.0, 1500.0, 3000.0], oil, (0.6, 0.6), scuffing_load_stage=12)
    print(tribology.summary(speed=1))
    save_figure(plot_contact_temperature(tribology, speed=1), "tribology.png")

    torques = tribology.dataset["friction_torque"].sum("pair").sel(speed=1500.0)
    omega = 1500.0 * 2.0 * 3.141592653589793 / 60.0
    work = -1e-3 * omega * (torques.sel(gear="pinion") + result.gear_pair.ratio * torques.sel(gear="wheel"))
    return float(work.sum() / tribology.dataset["friction_power"].sel(speed=1500.0).sum())


if __name__ == "__main__":
    main()
