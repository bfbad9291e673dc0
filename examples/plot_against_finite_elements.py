"""Beside finite elements
======================

The loaded transmission error of a spur pair beside kept runs of finite elements in plane strain.

Writes against_finite_elements.png. The free ends of a face 20 mm wide make the teeth 2 % softer than plane strain.
"""

import csv
import warnings
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from loaded_tca import AccuracyWarning, analyse, read_scene
from loaded_tca.plots import save_figure

SCENE = Path(__file__).parent / "scenes" / "mesh_cycle_finite_elements.toml"
KEPT = Path(__file__).parents[1] / "validation" / "calculix" / "data" / "calculix_spur_25_37_positions.csv"


def kept(torque):
    """Pinion angles [rad] and transmission errors [um] of the unmodified pair under a torque [N m]."""
    with KEPT.open(newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    chosen = [row for row in rows if row["variant"] == "unmodified" and float(row["torque_Nm"]) == torque]
    columns = [[float(row[name]) for row in chosen] for name in ("pinion_angle_rad", "transmission_error_um")]
    return np.array(columns)


def main() -> float:
    """Return the transmission error at the pitch point over that of the finite elements."""
    scene = read_scene(SCENE)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # a line of contact ends at the sides of the teeth
        result = analyse(scene)
    print(result.summary())
    angle, error = kept(scene.load.pinion_torque_Nm)
    ours = 1e3 * result.wheel_base_radius * result.transmission_error[0]

    figure = Figure(figsize=(7.0, 4.5), layout="constrained")
    axes = figure.subplots()
    axes.plot(np.degrees(result.pinion_angle), ours, ".-", label="loaded_tca, face 20 mm")
    axes.plot(np.degrees(angle), error, "o", label="finite elements, plane strain")
    axes.set_xlabel("pinion angle [deg]")
    axes.set_ylabel("loaded transmission error [µm]")
    figure.suptitle(f"{scene.title}, pinion torque {scene.load.pinion_torque_Nm:g} N m", fontsize="medium")
    figure.legend(loc="outside lower center", ncols=2, fontsize="small")
    save_figure(figure, "against_finite_elements.png")

    at_pitch_point = [values[np.argmin(np.abs(at))] for at, values in ((result.pinion_angle, ours), (angle, error))]
    return float(at_pitch_point[0] / at_pitch_point[1])


if __name__ == "__main__":
    main()
