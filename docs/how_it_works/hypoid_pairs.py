"""Draw the axes and the pitch plane of a hypoid pair: hypoid_pairs.png.

Run from the root of the repository: ``python docs/how_it_works/hypoid_pairs.py``.
"""

from math import atan2, cos, degrees, radians, sin
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc

from loaded_tca.gears import PitchConeParameters, pitch_cones_by_method_1

PINION, WHEEL, FRAME = "#d55e00", "#0072b2", "0.3"


def draw() -> Figure:
    """Two views: along the wheel's axis, and onto the pitch plane; a right-hand pinion."""
    found = pitch_cones_by_method_1((13, 42), 15.0, 170.0, 30.0, radians(50), 63.5)
    figure = Figure(figsize=(12.0, 5.4), layout="constrained")
    housing, plane = figure.subplots(1, 2, width_ratios=(1.0, 1.1))
    _draw_housing(housing, found)
    _draw_plane(plane, found)
    for axes in (housing, plane):
        axes.set_aspect("equal")
        axes.axis("off")
    figure.suptitle("Hypoid pair 13/42 with an offset of 15 mm, right-hand pinion; orange: pinion, blue: wheel")
    return figure


def _draw_housing(axes: Axes, found: PitchConeParameters) -> None:
    """Along the axis of the wheel: the pinion's axis to the right, the common normal upwards."""
    cones = found.cones
    (_, radius), (along, _) = cones.radii, cones.crossing_distances
    axes.add_patch(Arc((0.0, 0.0), 2.0 * radius, 2.0 * radius, theta1=-70.0, theta2=20.0, color=WHEEL, linewidth=1.5))
    axes.plot(0.0, 0.0, "o", color=WHEEL)
    axes.text(-3.0, 4.0, "wheel's axis", color=WHEEL, ha="right")
    axes.plot([-18.0, 98.0], [-15.0, -15.0], color=PINION, linestyle="-.")
    axes.text(100.0, -22.0, "pinion's axis $z_1$", color=PINION, ha="right")
    height = -np.sqrt(radius**2 - along**2)
    axes.plot(along, height, "o", color="black")
    axes.text(along + 3.0, height - 1.0, "P", va="center")
    _arrow(axes, (0.0, 0.0), (0.0, -15.0), "$a$", (-6.0, -7.5))
    _arrow(axes, (0.0, -15.0), (along, -15.0), "$t_{zm1}$", (0.5 * along, -9.5))
    apex = -cones.apexes[0]
    axes.plot(apex, -15.0, "s", color=PINION)
    axes.text(
        apex - 2.0,
        -31.0,
        "pitch apex of the pinion, $-t_{z1}$\nfrom the crossing point",
        color=PINION,
        fontsize="small",
    )
    axes.plot([0.0, along], [0.0, height], color=WHEEL, linewidth=0.8)
    axes.set_title("along the wheel's axis", fontsize="medium")
    axes.set_xlim(-32.0, 105.0)
    axes.set_ylim(-75.0, 30.0)


def _draw_plane(axes: Axes, found: PitchConeParameters) -> None:
    """The pitch plane: P in the origin, the pinion's generatrix to the left."""
    cones, (first, second) = found.cones, found.spiral_angles
    own, other = cones.mean_cone_distances
    zeta = cones.offset_angle
    to_first = np.array([-1.0, 0.0])
    to_second = -np.array([cos(zeta), sin(zeta)])
    axes.plot(0.0, 0.0, "o", color="black")
    axes.text(3.0, -6.0, "P")
    for way, length, colour, name in ((to_first, own, PINION, "$O_1$"), (to_second, other, WHEEL, "$O_2$")):
        end = length * way
        axes.plot([0.0, end[0]], [0.0, end[1]], color=colour)
        axes.plot([0.0, -20.0 * way[0]], [0.0, -20.0 * way[1]], color=colour, linestyle=":")
        axes.plot(*end, "s", color=colour)
        axes.text(end[0] - 3.0, end[1], name, color=colour, ha="right", va="center")
    axes.text(-0.62 * own, 3.0, "$g_1$, $R_{m1}$", color=PINION)
    axes.text(-0.62 * other, -17.0, "$g_2$, $R_{m2}$", color=WHEEL)
    tooth = first
    reach = np.linspace(-22.0, 26.0, 2)
    axes.plot(reach * cos(tooth), reach * sin(tooth), color=FRAME, linewidth=2.5)
    axes.text(17.0, 22.0, "tooth", color=FRAME)
    turned = degrees(atan2(to_second[1], to_second[0])) % 360.0
    axes.add_patch(Arc((0.0, 0.0), 80.0, 80.0, theta1=180.0, theta2=turned, color=FRAME))
    axes.text(-49.0, -6.5, "$\\zeta_{mp}$", color=FRAME)
    axes.add_patch(Arc((0.0, 0.0), 26.0, 26.0, theta1=180.0, theta2=180.0 + degrees(first), color=PINION))
    axes.text(-24.0, -13.0, "$\\beta_{m1}$", color=PINION)
    axes.add_patch(Arc((0.0, 0.0), 50.0, 50.0, theta1=degrees(zeta), theta2=degrees(zeta + second), color=WHEEL))
    axes.text(25.0, 12.0, "$\\beta_{m2}$", color=WHEEL)
    axes.set_title("pitch plane, seen from the pinion", fontsize="medium")
    axes.set_xlim(-92.0, 45.0)
    axes.set_ylim(-40.0, 45.0)


def _arrow(
    axes: Axes, start: tuple[float, float], end: tuple[float, float], name: str, at: tuple[float, float]
) -> None:
    axes.annotate("", end, start, arrowprops={"arrowstyle": "<->", "color": FRAME})
    axes.text(*at, name, color=FRAME, ha="center", va="center")


if __name__ == "__main__":
    draw().savefig(Path(__file__).with_suffix(".png"), dpi=90)
