"""Pressure beside Hertz
=====================

A crowned spur pair at the pitch point, step by step: its pressure beside that of Hertz.

Writes hertz_comparison.png: the pressure across and along the contact, which is 24 mm long and 0.29 mm wide.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from loaded_tca import read_scene, sample_separation, solve_contact, trace_contact
from loaded_tca.reference import hertz

SCENE = Path(__file__).parent / "scenes" / "spur.toml"


def main() -> float:
    """Return the peak pressure of the map over that of Hertz."""
    scene = read_scene(SCENE)
    pair = scene.pair()
    contact = trace_contact(pair, [0.0])[0]
    load = scene.torques[0] / contact.pinion_lever  # N mm / mm = N
    separation = sample_separation(pair, contact, cells=(49, 49), load=load)
    solution = solve_contact(separation.gap, separation.spacing, pair.contact_modulus, load=load)
    point = hertz.point_contact(load, separation.curvatures, pair.contact_modulus)
    peak = solution.pressure.max()
    print(f"map {peak:.1f} MPa, Hertz {point.max_pressure:.1f} MPa, axes of the ellipse 1 : {point.ratio:.0f}")

    figure = Figure(figsize=(9.0, 4.0), layout="constrained")
    across, along = figure.subplots(1, 2, sharey=True)
    middle = 24  # an odd number of cells: the contact point is the middle of the middle one
    x = np.linspace(separation.x[0], separation.x[-1], 500)
    across.plot(separation.x, solution.pressure[:, middle], "o", markersize=3, label="map")
    across.plot(x, point.pressure(x, 0.0), label="Hertz")
    y = np.linspace(separation.y[0], separation.y[-1], 500)
    along.plot(separation.y, solution.pressure[middle], "o", markersize=3, label="map")
    along.plot(y, point.pressure(0.0, y), label="Hertz")
    across.set_xlabel("across the contact [mm]")
    along.set_xlabel("along the contact [mm]")
    across.set_ylabel("contact pressure [MPa]")
    along.legend()
    figure.suptitle(f"{scene.title}, pitch point, normal force {load:.0f} N")
    figure.savefig("hertz_comparison.png", dpi=150)
    return peak / point.max_pressure


if __name__ == "__main__":
    main()
