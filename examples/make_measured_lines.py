"""Profile and helix lines
=======================

Make ``scenes/measured_lines.csv`` and measured_lines.png: a profile and a helix line of a wheel flank, made up, as gear
measuring centres print them, and the modifications that they have. Every part is known: crowning 8 um along the face,
slope 3 um, profile crowning 2 um, and noise.
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from loaded_tca.flank_maps import measured_modifications
from loaded_tca.flanks import read_topography
from loaded_tca.scene import read_scene

SCENES = Path(__file__).parent / "scenes"
MADE = {"lead_crowning_um": 8.0, "helix_slope_um": 3.0, "profile_crowning_um": 2.0}
NOISE_um = 0.1
HEADER = """# gear = wheel
# provenance = synthetic, made by examples/make_measured_lines.py; no gear was measured
# deviation = along the normal from the involute; positive: more material
line,radius_mm,axial_mm,deviation_um"""


def main() -> str:
    """Return the text of the file."""
    scene = read_scene(SCENES / "helical.toml")
    changes = {f"wheel.modifications.{key}": value for key, value in MADE.items()}
    flank, noise = scene.with_changes(changes).pair().wheel.flank, np.random.default_rng(12)
    radius, axial = (part[1:-1, 1:-1] for part in flank.grid(23, 33))
    deviation = noise.normal(0.0, NOISE_um, radius.shape) - 1e3 * flank.removal(radius, axial).value
    middle = [count // 2 for count in radius.shape]
    lines = {"profile": np.s_[:, middle[1]], "helix": np.s_[middle[0], :]}
    rows = [
        f"{name},{rho:.4f},{z:.4f},{excess:.2f}"
        for name, line in lines.items()
        for rho, z, excess in zip(radius[line], axial[line], deviation[line], strict=True)
    ]
    return "\n".join([HEADER, *rows, ""])


if __name__ == "__main__":
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else SCENES / "measured_lines.csv"
    path.write_text(main(), encoding="utf-8")
    made = measured_modifications(read_scene(SCENES / "helical.toml"), "wheel", read_topography(path))
    print(made.summary())
    panels = (figure := Figure(layout="constrained")).subplots(2)
    for axes, values, what in zip(panels, (made.excess[:, 0], made.excess[0]), ("profile", "helix"), strict=True):
        axes.plot(1e3 * (values - values.max()))
        axes.set(title=what, ylabel="deviation [µm]", xlabel="point of the line [-]")
    figure.savefig("measured_lines.png")
