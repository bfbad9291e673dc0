"""A made-up measured flank
========================

Make ``scenes/measured_flank.csv`` and measured_flank.png: a wheel flank as a gear measuring centre gives it, made up.
It is crowned by design, with small errors of profile and helix slope, some twist, the smooth waviness that grinding
leaves, and the noise of measurement. Every part is known, so that results can be judged.
"""

import math
import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from loaded_tca.scene import read_scene

SCENES = Path(__file__).parent / "scenes"
POINTS = (9, 15)  # along the profile, lengthwise
HEADER = """# gear = wheel of measured_flank.toml: 57 teeth, module 3 mm, helix angle 15 deg; the flank in contact
# provenance = synthetic, made by examples/make_measured_flank.py; no gear was measured
# parts = crowning 8 um lengthwise, 3 um profile; slopes 2 and -1.5 um; twist 2 um; waves 0.4 and 0.3 um; noise 0.15 um
# deviation = along the normal from the flank without modifications; positive: more material
profile_index,lengthwise_index,radius_mm,axial_mm,deviation_um"""


def deviation(profile, lengthwise):
    """Deviation [um] where both coordinates run from -1 to 1 over the flank."""
    crowning = -8.0 * lengthwise**2 - 3.0 * profile**2
    slopes = 1.0 * lengthwise - 0.75 * profile + 1.0 * lengthwise * profile
    waves = 0.4 * np.sin(2.2 * math.pi * lengthwise + 1.3 * profile) + 0.3 * np.cos(1.7 * math.pi * profile)
    noise = np.random.default_rng(57).normal(0.0, 0.15, np.broadcast(profile, lengthwise).shape)
    return crowning + slopes + waves + noise


def main() -> str:
    """Return the text of the file."""
    wheel = read_scene(SCENES / "helical.toml").pair().wheel.flank
    # every second line of a grid twice as fine: the outermost points keep off the edges, as a stylus does
    radius, axial = (part[1::2, 1::2] for part in wheel.grid(*(2 * count + 1 for count in POINTS)))
    profile, lengthwise = (np.linspace(-1.0, 1.0, 2 * count + 1)[1::2] for count in POINTS)
    excess = deviation(profile[:, None], lengthwise)
    rows = [
        f"{i + 1},{j + 1},{radius[i, j]:.4f},{axial[i, j]:.4f},{excess[i, j]:.2f}"
        for j in range(POINTS[1])
        for i in range(POINTS[0])
    ]
    return "\n".join([HEADER, *rows, ""])


if __name__ == "__main__":
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else SCENES / "measured_flank.csv"
    path.write_text(main(), encoding="utf-8")
    places = np.linspace(-1.0, 1.0, 61)
    figure = Figure(layout="constrained")
    drawn = (axes := figure.subplots()).contourf(places, places, deviation(places[:, None], places), levels=15)
    figure.colorbar(drawn, label="deviation along the normal, positive: more material [µm]")
    axes.set(xlabel="over half the face width, z > 0 right [-]", ylabel="over half the active profile, tip on top [-]")
    figure.savefig("measured_flank.png")
