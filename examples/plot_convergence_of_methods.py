"""Random starts: two methods
==========================

Share of random starts that find the contact: two equations beside five, over the first guess of the wheel angle.

Writes convergence_of_methods.png. The reduced solver climbs the ease-off on the pinion flank and needs no guess of the
wheel angle; the five equations converge from a band about the answer only.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from loaded_tca import read_scene, trace_contact
from loaded_tca.baselines import solve_conventional
from loaded_tca.plots import save_figure
from loaded_tca.unloaded import EaseOff, climb

SCENE = Path(__file__).parent / "scenes" / "spur_52_72.toml"
STARTS = 4000


def main() -> float:
    """Return the percentage of starts from which the reduced solver finds the contact."""
    pair = read_scene(SCENE).pair()
    contact = trace_contact(pair, [0.0])[0]
    rng = np.random.default_rng(0)
    corners = [part for flank in (pair.pinion.flank, pair.wheel.flank) for part in flank.grid(2, 2)]
    points = np.stack([rng.uniform(part.min(), part.max(), STARTS) for part in corners], axis=-1)  # mm
    offset = rng.uniform(-0.5 * np.pi, 0.5 * np.pi, STARTS)  # rad

    peaks = climb(EaseOff(pair), np.zeros(STARTS), points[:, 0], points[:, 1])
    error = np.abs(peaks.value / pair.base_radii[1] - contact.transmission_error)
    reduced = peaks.converged & (error < 1e-9)

    starts = np.column_stack([points, contact.wheel_angle + offset])
    found = solve_conventional(pair, 0.0, starts)
    five = found.is_contact & (np.abs(found.wheel_angle - contact.wheel_angle) < 1e-9)
    print(f"two equations {100 * reduced.mean():.2f} %, five {100 * five.mean():.2f} % of {STARTS} starts")

    edges = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 41)
    total = np.histogram(offset, edges)[0]
    figure, axes = plt.subplots(layout="constrained")
    for good, label, style in ((reduced, "two equations (reduced)", "-"), (five, "five equations", "--")):
        axes.stairs(100.0 * np.histogram(offset[good], edges)[0] / total, edges, label=label, ls=style, lw=2)
    axes.set(xlabel="first guess of the wheel angle - answer [rad]", ylabel="starts that find the contact [%]")
    figure.legend(loc="outside upper center", ncols=2)
    save_figure(figure, "convergence_of_methods.png")
    return float(100.0 * reduced.mean())


if __name__ == "__main__":
    main()
