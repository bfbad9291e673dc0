"""Sensitivity to misalignment
===========================

Sensitivity of a crowned helical pair to an out-of-plane error of its axes.

Writes misalignment_sensitivity.png: the transmission error over a pitch, and where the contact goes. Profile crowning
keeps the transmission error a smooth arc as long as the contact ends inside the flank.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from loaded_tca import read_scene
from loaded_tca.plots import save_figure
from loaded_tca.unloaded import trace_teeth

SCENE = Path(__file__).parent / "scenes" / "helical.toml"
CROWNING = {"pinion.modifications.lead_crowning_um": 20.0, "pinion.modifications.profile_crowning_um": 5.0}
ERRORS = (-0.1, -0.05, 0.0, 0.05, 0.1)  # deg
COLOURS = ("#0072b2", "#56b4e9", "k", "#e69f00", "#d55e00")
ARCSEC = np.degrees(3600.0)


def main() -> float:
    """Return the shift of the contact over that of the mirrored error: -1 by symmetry, to first order."""
    scene = read_scene(SCENE).with_changes(CROWNING)
    figure = Figure(figsize=(11.0, 5.2), layout="constrained")
    motion, flank = figure.subplots(1, 2)
    shifts = []
    for error, colour in zip(ERRORS, COLOURS, strict=True):
        pair = scene.with_changes({"mounting.out_of_plane_deg": error}).pair()
        mesh = trace_teeth(pair, np.linspace(-0.5, 0.5, 41) * pair.pitch)
        contact = mesh.leading_contact
        shifts.append(float(contact.pinion_axial[20]))
        height = mesh.peak_to_peak * ARCSEC
        print(f"{error:+.2f} deg: {height:.2f} arcsec, contact at {shifts[-1]:+.2f} mm, smooth: {mesh.is_continuous}")
        label = f"{error:+.2f} deg, {height:.1f} arcsec peak to peak"
        motion.plot(np.degrees(mesh.pinion_angle), mesh.transmission_error * ARCSEC, color=colour, label=label)
        flank.plot(contact.pinion_axial, 2.0 * contact.pinion_radius, ".", color=colour)

    motion.set(xlabel="pinion angle [deg]", ylabel="unloaded transmission error [arcsec]")
    figure.legend(title="out-of-plane error", loc="outside lower center", ncols=3)
    half = 0.5 * pair.face_width
    flank.set(xlim=(-half, half), xlabel="axial position on the pinion [mm]", ylabel="diameter [mm]")
    figure.suptitle("Crowned helical pair (lead 20 µm, profile 5 µm): transmission error and contact path, unloaded")
    save_figure(figure, "misalignment_sensitivity.png")
    return shifts[0] / shifts[-1]


if __name__ == "__main__":
    main()
