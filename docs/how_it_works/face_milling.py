"""Draw the machine of a face-milled gear and the blade of its cutter: face_milling.png.

Run from the root of the repository: ``python docs/how_it_works/face_milling.py``.
"""

from math import cos, degrees, pi, radians, sin
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Polygon

CUTTER, BLANK, SETTING, FRAME = "#0072b2", "#009e73", "#d55e00", "0.3"
RADIAL, CRADLE, RADIUS = 98.0, radians(52.8), 95.0
PITCH, ROOT, FACE, TOE, HEEL = radians(24.0), radians(20.0), radians(28.0), 95.0, 132.0
Point = tuple[float, float]


def draw() -> Figure:
    """Three views: along the axis of the cradle, the plane of both axes, and the blade."""
    figure = Figure(figsize=(15.0, 5.6), layout="constrained")
    front, top, blade = figure.subplots(1, 3, width_ratios=(1.15, 1.25, 0.9))
    _draw_front(front)
    _draw_top(top)
    _draw_blade(blade)
    for axes in (front, top, blade):
        axes.set_aspect("equal")
        axes.axis("off")
    figure.suptitle("Machine of a right-hand member; orange: settings, in their positive sense")
    return figure


def _draw_front(axes: Axes) -> None:
    """Along the axis of the cradle: x to the right, y upwards, z towards the reader."""
    centre = _polar(RADIAL, CRADLE)
    _arrow(axes, (-20.0, 0.0), (165.0, 0.0), FRAME, "$x$,\nroot line", (203.0, 0.0))
    _arrow(axes, (0.0, -45.0), (0.0, 120.0), FRAME, "$y$", (-7.0, 120.0 + 45.0))
    axes.add_patch(Arc(centre, 2.0 * RADIUS, 2.0 * RADIUS, color=CUTTER, linewidth=1.5))
    axes.plot(*centre, "+", color=CUTTER)
    axes.text(centre[0] + 4.0, centre[1] + 7.0, "cutter", color=CUTTER)
    reach = np.linspace(TOE, HEEL, 25)
    below = centre[1] - np.sqrt(RADIUS**2 - (reach - centre[0]) ** 2)
    axes.plot(reach, below, color=BLANK, linewidth=4.0, alpha=0.6)
    axes.text(182.0, 30.0, "tooth slot,\ntoe to heel", color=BLANK, ha="center", fontsize="small")
    _arrow(axes, (0.0, 0.0), centre, SETTING, "$S_r$, radial_mm", (72.0, 50.0))
    axes.add_patch(Arc((0.0, 0.0), 60.0, 60.0, theta1=0.0, theta2=degrees(CRADLE), color=SETTING))
    axes.text(32.0, 10.0, "$q$, cradle_angle_deg", color=SETTING, fontsize="small")
    _turn(axes, 30.0, (2.2, 2.9), "$\\varphi$, turn of\nthe cradle", (-62.0, 26.0))
    _arrow(axes, (150.0, -30.0), (150.0, -4.0), SETTING, "$E_m$, blank_offset_mm", (-5.0, -6.0))
    axes.set_title("front of the cradle; $z$ and the blank towards the reader", fontsize="medium")
    axes.set_xlim(-70.0, 205.0)
    axes.set_ylim(-50.0, 180.0)


def _draw_top(axes: Axes) -> None:
    """The plane of the axes of cradle and blank: x to the right, z upwards; the tips of the blades at z = 0."""
    _arrow(axes, (-25.0, 0.0), (165.0, 0.0), FRAME, "$x$", (4.0 + 190.0, 0.0))
    _arrow(axes, (0.0, -30.0), (0.0, 100.0), FRAME, "$z$, axis of the cradle", (0.0, 136.0))
    along = np.array([cos(ROOT), sin(ROOT)])
    for angles in ((ROOT, FACE), (-ROOT, -FACE)):
        corners = [(TOE, angles[0]), (TOE, angles[1]), (HEEL, angles[1]), (HEEL, angles[0])]
        section = [_polar(distance, ROOT - angle) for distance, angle in corners]
        axes.add_patch(Polygon(section, facecolor=BLANK, alpha=0.5))
    body = [_polar(distance, angle) for distance, angle in ((TOE, 0.0), (HEEL, 0.0), (HEEL, 2 * ROOT), (TOE, 2 * ROOT))]
    axes.add_patch(Polygon(body, facecolor=BLANK, alpha=0.15))
    axes.plot(*np.outer(along, (-15.0, 175.0)), "-.", color=BLANK, linewidth=1.0)
    axes.text(*(along * 150.0 + [0.0, 18.0]), "axis of the blank,\n$\\psi$ = $m\\varphi$", color=BLANK, ha="center")
    axes.plot(*zip((0.0, 0.0), _polar(HEEL + 12.0, ROOT - PITCH), strict=True), "--", color="black", linewidth=0.8)
    axes.text(*_polar(HEEL + 15.0, ROOT - PITCH), "pitch line", fontsize="small", va="center")
    for start in (66.0, 84.0, 102.0, 120.0):
        axes.add_patch(
            Polygon([(start, 0), (start + 5, 0), (start + 12, -24), (start - 7, -24)], color=CUTTER, alpha=0.3)
        )
    axes.text(60.0, -33.0, "blades, tips at $z = 0$", color=CUTTER)
    axes.add_patch(Arc((0.0, 0.0), 80.0, 80.0, theta1=0.0, theta2=degrees(ROOT), color=SETTING))
    axes.text(42.0, 6.0, "$\\gamma_m$, root_angle_deg", color=SETTING, fontsize="small")
    _arrow(axes, _polar(20.0, ROOT), _polar(50.0, ROOT), SETTING)
    axes.text(4.0, 53.0, "$\\Delta X_D$, machine_centre_to_back_mm", color=SETTING, fontsize="small")
    _arrow(axes, (-14.0, 0.0), (-14.0, 26.0), SETTING)
    axes.text(-18.0, 34.0, "$\\Delta X_B$,\nsliding_base_mm", color=SETTING, ha="right", va="center", fontsize="small")
    axes.plot(0.0, 0.0, "o", color="black", markersize=4.0)
    axes.text(-4.0, -8.0, "machine centre,\napex of the blank", ha="right", va="center", fontsize="small")
    axes.set_title("plane of both axes; $y$ away from the reader", fontsize="medium")
    axes.set_xlim(-75.0, 195.0)
    axes.set_ylim(-45.0, 120.0)


def _draw_blade(axes: Axes) -> None:
    """Section of an outside blade in a plane through the axis of the cutter, tip upwards."""
    angle, edge, height = radians(22.0), 1.6, 10.0
    centre_height, tangent = edge, edge * (1.0 - sin(angle))
    centre = tangent * np.tan(angle) - edge * cos(angle)
    arc = np.linspace(angle, 0.5 * pi, 20)
    rounding = [(centre + edge * cos(at) * 1.0, -(centre_height - edge * sin(at))) for at in arc]
    flank = [(height * np.tan(angle), -height), (tangent * np.tan(angle), -tangent)]
    outline = [*flank, *rounding, (-5.0, 0.0), (-5.0 - 0.35 * height, -height)]
    axes.add_patch(Polygon(outline, facecolor=CUTTER, alpha=0.35))
    radius, heights = 32.0, np.linspace(0.0, height, 30)
    hollow = radius * cos(angle) - np.sqrt(radius**2 - (heights + radius * sin(angle)) ** 2)
    axes.plot(hollow, -heights, "--", color=CUTTER)
    axes.text(7.2, -8.2, "hollow blade,\nblade_radius_mm", color=CUTTER, fontsize="small")
    axes.plot([0.0, 0.0], [2.2, -height], color=FRAME, linewidth=0.8)
    axes.plot([-6.0, 6.0], [0.0, 0.0], color=FRAME, linewidth=0.8)
    axes.add_patch(Arc((0.0, 0.0), 13.0, 13.0, theta1=-90.0, theta2=-90.0 + degrees(angle), color=SETTING))
    axes.text(-0.2, -7.4, "$\\alpha$, blade_angle_deg", color=SETTING, ha="right", fontsize="small")
    _arrow(axes, (-12.0, 1.6), (0.0, 1.6), SETTING)
    axes.text(-12.0, 2.4, "$r_p$, point_radius_mm, from the axis of the cutter", color=SETTING, fontsize="small")
    axes.plot(centre, -centre_height, ".", color=SETTING)
    axes.text(centre - 0.4, -centre_height - 0.2, "$r_e$", color=SETTING, ha="right", fontsize="small")
    _arrow(axes, (5.0, 0.0), (5.0, -tangent), SETTING)
    axes.text(5.5, -0.6, "fillet; above it the flank", fontsize="small", va="center")
    _arrow(axes, (-8.5, 0.0), (-8.5, -8.0), FRAME, "$h$", (-0.9, -4.0))
    axes.text(8.0, -4.3, "blank", color=BLANK)
    axes.set_title("outside blade, which cuts the concave flank", fontsize="medium")
    axes.set_xlim(-13.0, 14.0)
    axes.set_ylim(-11.5, 5.0)


def _polar(distance: float, angle: float) -> Point:
    return distance * cos(angle), distance * sin(angle)


def _turn(axes: Axes, radius: float, angles: tuple[float, float], label: str, at: Point) -> None:
    """A bent arrow about the origin."""
    style = {"arrowstyle": "->", "color": FRAME, "connectionstyle": "arc3,rad=0.25"}
    axes.annotate("", _polar(radius, angles[1]), _polar(radius, angles[0]), arrowprops=style)
    axes.text(*at, label, color=FRAME, fontsize="small")


def _arrow(axes: Axes, start: Point, end: Point, colour: str, label: str = "", at: Point = (0.0, 0.0)) -> None:
    """An arrow, with a label at a place counted from its start."""
    axes.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": colour, "shrinkA": 0, "shrinkB": 0})
    axes.text(start[0] + at[0], start[1] + at[1], label, color=colour, ha="center", va="center", fontsize="small")


if __name__ == "__main__":
    draw().savefig(Path(__file__).with_suffix(".png"), dpi=80)
