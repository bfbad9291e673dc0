"""Pressure on a spiral bevel pair
===============================

Crowned spiral bevel pair at the pitch point, from the Python API: the pressure map on the pinion, and Hertz.

Writes bevel_pressure.png as an engineer sees a bevel tooth: toe left, heel right, root at the bottom, tip on top.
"""

import math

import numpy as np
from matplotlib.figure import Figure

from loaded_tca import sample_separation, solve_contact, trace_contact
from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import bevel_mesh
from loaded_tca.pairs import bevel_pair
from loaded_tca.reference import hertz

LOAD = 3000.0  # N, normal force of one tooth pair
CELLS = (65, 65)


def main() -> float:
    """Return the peak pressure of the map over that of Hertz."""
    mesh = bevel_mesh((17, 26), outer_module=5.0, face_width=20.0, spiral_angle=math.radians(35.0))
    crowned = FlankModifications(lead_crowning=0.020, profile_crowning=0.010)  # mm, on the pinion
    pair = bevel_pair(mesh, modifications=(crowned, FlankModifications()))

    contact = trace_contact(pair, [0.0])[0]
    separation = sample_separation(pair, contact, cells=CELLS, load=LOAD)
    solution = solve_contact(separation.gap, separation.spacing, pair.contact_modulus, load=LOAD)
    point = hertz.point_contact(LOAD, separation.curvatures, pair.contact_modulus)
    peak = solution.pressure.max()
    print(f"map {peak:.1f} MPa, Hertz {point.max_pressure:.1f} MPa, approach {1e3 * solution.approach:.2f} um")

    frame = pair.pinion.flank.frame  # how a point (rho, z) of the gear appears on the flank
    rho, z = pair.pinion.flank.grid(17, 17)
    cells = separation.points
    turn = np.linspace(0.0, 2.0 * math.pi, 181)
    ellipse = np.outer(point.semi_minor * np.cos(turn), separation.axes[0])
    ellipse = separation.origin + ellipse + np.outer(point.semi_major * np.sin(turn), separation.axes[1])
    figure = Figure(figsize=(9.0, 4.0), layout="constrained")
    axes = figure.subplots()
    axes.plot(*frame.to_picture(*(np.concatenate([p[0], p[:, -1], p[-1, ::-1], p[::-1, 0]]) for p in (rho, z))), "0.5")
    pressure = np.where(solution.pressure > 0.0, solution.pressure, np.nan)
    mesh_of_cells = axes.pcolormesh(*frame.to_picture(np.hypot(cells[..., 0], cells[..., 1]), cells[..., 2]), pressure)
    axes.plot(*frame.to_picture(np.hypot(ellipse[:, 0], ellipse[:, 1]), ellipse[:, 2]), "--", color="#d55e00")
    figure.colorbar(mesh_of_cells, ax=axes, label="contact pressure [MPa]")
    axes.set(xlabel=frame.labels[0], ylabel=frame.labels[1])
    axes.set_title(f"Spiral bevel pinion 17/26 under {LOAD:.0f} N; dashed: ellipse after Hertz", fontsize="medium")
    figure.savefig("bevel_pressure.png", dpi=150)
    return peak / point.max_pressure


if __name__ == "__main__":
    main()
