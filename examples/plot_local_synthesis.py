"""Machine settings by local synthesis
===================================

A face-milled pair from its blank, and settings of the pinion for what is asked of the contact at its mean point: four
directions of the path on the flank, three falls of the motion curve. Writes local_synthesis.png.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from loaded_tca import read_scene, trace_contact

SCENE = Path(__file__).parent / "scenes" / "face_milled_blank.toml"
PATHS = {60.0: "#0072b2", 90.0: "#d55e00", 120.0: "#009e73", 150.0: "#cc79a7"}  # deg
FALLS = {5.0: "#0072b2", 10.0: "#d55e00", 20.0: "#009e73"}  # arcsec
PITCHES = np.linspace(-0.5, 0.5, 41)


def main() -> float:
    """Return the second derivative of the motion curve by differences, over that of the fall asked for."""
    scene = read_scene(SCENE)
    figure = Figure(figsize=(10.0, 4.2), layout="constrained")
    flank, motion = figure.subplots(1, 2, width_ratios=(1.4, 1.0))
    for angle, colour in PATHS.items():
        pair = scene.with_changes({"pair.settings.path_angle_deg": angle}).pair()
        path = trace_contact(pair, PITCHES * pair.pitch, warn=False)
        frame, inside = pair.pinion.flank.frame, ~path.on_edge
        flank.plot(*frame.to_picture(path.pinion_radius[inside], path.pinion_axial[inside]), color=colour)
        flank.plot([], [], color=colour, label=f"{angle:g}°")
    for line in (pair.pinion.flank.grid(2, 41), [part.T for part in pair.pinion.flank.grid(21, 2)]):
        for rho, z in zip(*line, strict=True):
            flank.plot(*frame.to_picture(rho, z), color="0.4", linewidth=1.0)
    flank.set(xlabel=frame.labels[0], ylabel=frame.labels[1], title="Paths of contact asked for, from the tooth trace")
    flank.set(aspect="equal", ylim=(None, flank.get_ylim()[1] + 1.5))  # angles as they are
    flank.legend(loc="upper center", fontsize="small", ncols=len(PATHS))

    for fall, colour in FALLS.items():
        pair = scene.with_changes({"pair.settings.motion_fall_arcsec": fall}).pair()
        error = np.degrees(trace_contact(pair, PITCHES * pair.pitch, warn=False).transmission_error) * 3600.0
        motion.plot(PITCHES, error, color=colour, label=f"{fall:g} arcsec")
        motion.plot(PITCHES, -fall * (2.0 * PITCHES) ** 2, color=colour, linestyle="--", linewidth=3.0, alpha=0.4)
    motion.set(xlabel="turn of the pinion [pitch]", ylabel="transmission error without load [arcsec]")
    motion.set_title("Motion curves; dashed: asked for")
    motion.legend(loc="lower center", fontsize="small")
    figure.savefig("local_synthesis.png", dpi=120)

    step = 0.01 * pair.pitch
    error = trace_contact(pair, [-step, 0.0, step]).transmission_error
    fall = np.degrees(-np.diff(error, 2)[0] / step**2 * pair.pitch**2 / 8.0) * 3600.0
    print(f"fall asked for {max(FALLS):g} arcsec, measured {fall:.3f} arcsec")
    return float(fall / max(FALLS))


if __name__ == "__main__":
    main()
