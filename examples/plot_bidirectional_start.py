"""A duplex pair from its blank
============================

Duplex spread blade pair from its blank: basic settings, bidirectional start, contact.

Writes bidirectional_start.png. The settings are closed forms; forward (from the wheel), reverse (from the pinion) and
their mean guess where the flanks touch. The five contact equations need such a guess, the ease-off does not.
"""

import numpy as np
from matplotlib.figure import Figure

from loaded_tca import trace_contact
from loaded_tca.baselines import BidirectionalStart, solve_conventional
from loaded_tca.gears import BevelBlank, duplex_spread_blade
from loaded_tca.pairs import face_milled_pair
from loaded_tca.plots import save_figure


def main() -> float:
    """Return the wheel angle of the five equations over that of the ease-off, at the mean start."""
    blank = BevelBlank((20, 30), 5.0, 20.0, spiral_angle=np.radians(35), cutter_radius=60.0, taper="duplex")
    gears = duplex_spread_blade(blank, edge_radius=0.5)
    for gear in gears:
        machine = gear.machine
        print(
            f"{gear.name}: radial {machine.radial:.4f} mm, cradle {np.degrees(machine.cradle_angle):.4f} deg, ", end=""
        )
        print(f"root {np.degrees(machine.root_angle):.4f} deg, roll {machine.ratio_of_roll:.6f}, ", end="")
        print(f"sliding base {machine.sliding_base:.4f} mm, blade group {gear.cutter.number:g}")
    pair = face_milled_pair(*gears)
    start = BidirectionalStart(gears, pair)
    values = {"forward": start.forward(), "reverse": start.reverse(), "mean": start.mean()}

    figure = Figure(figsize=(8.0, 4.5), layout="constrained")
    axes = figure.subplots()
    frame = pair.pinion.flank.frame
    outline = np.stack(frame.to_picture(*pair.pinion.flank.grid(2, 17)), axis=-1)
    axes.fill(*np.concatenate([outline[0], outline[1][::-1]]).T, color="0.93")
    path = trace_contact(pair, np.linspace(-1.0, 1.0, 41) * pair.pitch)
    axes.plot(*frame.to_picture(path.pinion_radius, path.pinion_axial), "k.", label="contact of one tooth pair")
    for (name, one), marker in zip(values.items(), "^vD", strict=True):
        guess = start.guess(one)
        axes.plot(*frame.to_picture(*guess.unknowns[:2]), marker, markersize=9, label=f"{name} start")
        found = solve_conventional(pair, guess.pinion_angle, guess.unknowns[None])
        print(f"{name}: {found.iterations[0]} steps of the five equations, a contact: {found.is_contact[0]}")
    axes.set(xlabel=frame.labels[0], ylabel=frame.labels[1], title="Duplex spread blade 20 x 30, pinion, drive side")
    axes.legend(loc="center left")
    save_figure(figure, "bidirectional_start.png")
    return float(found.wheel_angle[0] / trace_contact(pair, [guess.pinion_angle]).wheel_angle[0])


if __name__ == "__main__":
    main()
