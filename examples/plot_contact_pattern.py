"""Contact pattern
===============

Contact pattern of a crowned helical pair: what a marking compound 6.35 um thick would show.

Writes contact_pattern.png: the contours of the contact area at some positions with the ellipse that the curvatures
give, and the pattern accumulated over a whole passage.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from loaded_tca import read_scene
from loaded_tca.flank_maps import contact_area, contact_pattern
from loaded_tca.plots import save_figure
from loaded_tca.unloaded import trace_teeth

SCENE = Path(__file__).parent / "scenes" / "helical.toml"
CHANGES = {
    "pinion.modifications.lead_crowning_um": 20.0,
    "pinion.modifications.profile_crowning_um": 10.0,
    "mounting.out_of_plane_deg": 0.05,
}


def main() -> float:
    """Return the contact area at the pitch point over that of its curvature ellipse."""
    pair = read_scene(SCENE).with_changes(CHANGES).pair()
    path = trace_teeth(pair, np.linspace(-0.42, 0.42, 7) * pair.pitch).leading_contact
    areas = [contact_area(pair, path[i]) for i in range(len(path))]
    pattern = contact_pattern(pair)

    figure = Figure(figsize=(11.0, 5.0), layout="constrained")
    axes = figure.subplots()
    levels = np.linspace(0.0, 1e3 * pattern.compound, 7)
    filled = axes.contourf(pattern.axial, pattern.diameter, 1e3 * pattern.gap, levels, cmap="viridis")
    figure.colorbar(filled, ax=axes, label="smallest gap over the passage [µm]", format="%.3g")
    for number, area in enumerate(areas):
        closed = np.append(np.arange(len(area.point)), 0)
        label = "contact area at one position" if number == 0 else None
        axes.plot(area.pinion_axial[closed], 2.0 * area.pinion_radius[closed], color="k", linewidth=1.0, label=label)
        ellipse = area.ellipse_points
        label = "its curvature ellipse" if number == 0 else None
        axes.plot(ellipse[:, 2], 2.0 * np.hypot(*ellipse[:, :2].T), "--", color="#d55e00", linewidth=1.0, label=label)
    axes.plot(path.pinion_axial, 2.0 * path.pinion_radius, "o", color="w", markeredgecolor="k", label="contact point")
    axes.set(xlim=(pattern.axial.min(), pattern.axial.max()), ylim=(pattern.diameter.min(), pattern.diameter.max()))
    axes.set(xlabel="axial position from mid-face [mm]", ylabel="diameter [mm]")
    axes.legend(loc="lower left")
    axes.set_title(
        "Pinion of a helical pair: crowning 20 µm (lead), 10 µm (profile), axes 0.05 deg out of plane, compound 6.35 µm"
    )
    save_figure(figure, "contact_pattern.png")
    return areas[3].area / areas[3].ellipse_area


if __name__ == "__main__":
    main()
