"""Tip relief and tip rounding
===========================

How much relief keeps the pressure at the tip edges of a helical pair below that of its flanks, for four radii of tip
rounding, both gears alike: half a minute. Writes tip_relief_and_rounding.png and prints a table.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from loaded_tca import analyse, read_scene
from loaded_tca.plots import save_figure

SCENE = read_scene(Path(__file__).parent / "scenes" / "mesh_cycle_helical.toml").with_changes(
    {
        "analysis.positions": 9,
        "analysis.torques_Nm": [260.0],
        "pinion.modifications.lead_crowning_um": 10.0,  # the contact stays off the face ends
    }
)
STARTS = {"pinion": 108.0, "wheel": 179.5}  # diameters at which the relief starts: 1.8 mm below the tip
RELIEFS = [0.0, 4.0, 6.0, 8.0, 9.0, 10.0, 12.0]
RADII = {0.05: "#0072b2", 0.1: "#d55e00", 0.2: "#009e73", 0.5: "#cc79a7"}  # colours for colour-blind readers, too


def pressures(relief: float, radius: float) -> tuple[float, float]:
    """Largest pressure at a tip edge, zero where none is reached, and on the flanks [MPa]."""
    changes = {f"{gear}.tip_rounding_mm": radius for gear in STARTS}
    if relief > 0.0:
        changes |= {f"{gear}.modifications.tip_relief_um": relief for gear in STARTS}
        changes |= {f"{gear}.modifications.tip_relief_start_mm": start for gear, start in STARTS.items()}
    (figures,) = analyse(SCENE.with_changes(changes)).key_figures()
    return float(np.nan_to_num(figures["edge_pressure_MPa"])), figures["peak_pressure_MPa"]


def main() -> float:
    """Return the exponent of the radius in the edge pressure without relief, from 0.05 to 0.2 mm."""
    found = np.array([[pressures(relief, radius) for radius in RADII] for relief in RELIEFS])
    ratio = found[..., 0] / found[..., 1]
    axes = (figure := Figure(figsize=(7.0, 4.5), layout="constrained")).subplots()
    axes.axhline(1.0, color="black", linewidth=1.0, linestyle="--")
    print("tip relief [um]" + "".join(f"{radius:>8g} mm" for radius in RADII))
    for relief, row in zip(RELIEFS, ratio, strict=True):
        print(f"{relief:15g}" + "".join(f"{one:11.2f}" for one in row))
    for radius, column, marker in zip(RADII, ratio.T, "osD^", strict=True):
        axes.plot(RELIEFS, column, marker=marker, color=RADII[radius], label=f"tip rounding {radius:g} mm")
        enough = [relief for relief, one in zip(RELIEFS, column, strict=True) if one <= 1.0]
        print(f"tip rounding {radius:g} mm: a relief of {min(enough):g} um is enough")
    axes.set(ylim=(0.0, None), title="Helical pair 34/57, pinion torque 260 N m")
    axes.set(xlabel="tip relief of both gears [µm]", ylabel="pressure at the tip edge over that of the flanks")
    axes.legend()
    save_figure(figure, "tip_relief_and_rounding.png")
    return float(np.log(found[0, 2, 0] / found[0, 0, 0]) / np.log(0.2 / 0.05))


if __name__ == "__main__":
    main()
