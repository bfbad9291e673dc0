"""Settings from measured flanks
=============================

Make measured_settings.png, and ``scenes/duplex_wheel_concave.csv`` and ``scenes/duplex_wheel_convex.csv``: both flanks
of a spread blade wheel as a gear measuring centre gives them, made up. The machine stood beside its settings by
amounts that are known, and the deviations have some noise; the fit finds the amounts from the deviations.
"""

import sys
from pathlib import Path

import numpy as np

from loaded_tca.flank_maps import fit_settings, read_measured_flank
from loaded_tca.flanks import GeneratedFlank
from loaded_tca.plots import plot_measured_settings, save_figure
from loaded_tca.scene import read_scene

SCENES = Path(__file__).parent / "scenes"
SCENE, FLANKS = read_scene(SCENES / "duplex_30x20_mended.toml"), ("concave", "convex")
ERRORS = {"radial_mm": 0.05, "root_angle_deg": -0.03, "ratio_of_roll": 0.002}
NOISE_um, POINTS = 0.3, (5, 9)  # along the profile, lengthwise
HEADER = """# gear = wheel
# flank = {flank}
# provenance = synthetic, made by examples/plot_measured_settings.py; no gear was measured
# parts = radial +0.05 mm, machine root angle -0.03 deg, ratio of roll +0.002, noise 0.3 um
profile_index,lengthwise_index,radius_mm,axial_mm,deviation_um"""


def measure(flank):
    """Text of a file of a flank of the wheel that was cut with wrong settings."""
    asked = GeneratedFlank(SCENE.mesh().wheel, flank)
    wrong = {f"wheel.machine.{key}": getattr(SCENE.wheel.machine, key) + error for key, error in ERRORS.items()}
    cut = GeneratedFlank(SCENE.with_changes(wrong).mesh().wheel, flank)
    radius, axial = (part[1::2, 1::2] for part in asked.grid(*(2 * count + 1 for count in POINTS)))
    ahead = cut.theta(radius, axial).value - asked.theta(radius, axial).value
    deviation = 1e3 * asked.side * ahead / asked.gradient_norm(radius, axial).value
    deviation += np.random.default_rng(len(flank)).normal(0.0, NOISE_um, radius.shape)
    places = ((i, j, radius[i, j], axial[i, j], deviation[i, j]) for i, j in np.ndindex(radius.shape))
    rows = [f"{i + 1},{j + 1},{rho:.4f},{z:.4f},{excess:.2f}" for i, j, rho, z, excess in places]
    return "\n".join([HEADER.format(flank=flank), *rows, ""])


def main() -> float:
    """Return the error of the radial setting that is found, over the one that was made."""
    measured = [read_measured_flank(SCENES / f"duplex_wheel_{flank}.csv") for flank in FLANKS]
    fit = fit_settings(SCENE, measured, [f"wheel.machine.{key}" for key in ERRORS])
    print(fit.summary())
    save_figure(plot_measured_settings(fit), "measured_settings.png")
    return -float(fit.corrections[0]) / ERRORS["radial_mm"]


if __name__ == "__main__":
    for side in FLANKS:
        (Path(sys.argv[1] if len(sys.argv) > 1 else SCENES) / f"duplex_wheel_{side}.csv").write_text(measure(side))
    main()
