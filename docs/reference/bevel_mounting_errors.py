"""Draw the frames of a bevel pair and its mounting errors E, P, G and shaft angle: bevel_mounting_errors.png.

Run from the root of the repository: ``python docs/reference/bevel_mounting_errors.py``.
"""

from math import cos, degrees, sin
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Polygon, Rectangle

from loaded_tca.gears import BevelGear, bevel_mesh

PINION, WHEEL, ERROR, FRAME = "#0072b2", "#009e73", "#d55e00", "0.3"
Point = tuple[float, float]


def draw() -> Figure:
    """Two views: the plane of the axes, and along the pinion's axis from its heel."""
    mesh = bevel_mesh((20, 30), outer_module=4.0, face_width=22.0)
    figure = Figure(figsize=(12.0, 6.2), layout="constrained")
    section, front = figure.subplots(1, 2, width_ratios=(1.3, 1.0))
    _draw_section(section, mesh.pinion, mesh.wheel)
    _draw_front(front, mesh.pinion, mesh.wheel)
    for axes in (section, front):
        axes.set_aspect("equal")
        axes.axis("off")
    figure.suptitle("Bevel pair in the fixed frame (axes x, y, z); orange: mounting errors, in their positive sense\n")
    return figure


def _draw_section(axes: Axes, pinion: BevelGear, wheel: BevelGear) -> None:
    """The plane of the axes: z to the right, x upwards, y towards the reader."""
    sigma, heel, delta = pinion.pitch_angle + wheel.pitch_angle, pinion.outer_cone_distance, pinion.pitch_angle
    for gear, axis, colour, name in ((wheel, sigma, WHEEL, "wheel"), (pinion, 0.0, PINION, "pinion")):
        for half in (1, -1):
            axes.add_patch(Polygon(_body(gear, axis, half), facecolor=colour, alpha=0.15))
            axes.add_patch(Polygon(_teeth(gear, axis, half), facecolor=colour, alpha=0.5))
        _arrow(axes, (0.0, 0.0), _polar(1.45 * heel, axis), FRAME)
        axes.text(
            *_polar(0.62 * heel, axis - 0.25 * (1 if gear is pinion else -1)),
            name,
            ha="center",
            va="center",
            color=colour,
        )
    axes.text(1.48 * heel, 0.0, "$z$\npinion axis", va="center", color=FRAME)
    axes.text(0.0, 1.5 * heel, "$x$\nwheel axis $z_2$", ha="center", color=FRAME)
    axes.plot(*zip((0.0, 0.0), _polar(1.2 * heel, delta), strict=True), "--", color="black", linewidth=0.8)
    for distance, name in ((pinion.inner_cone_distance - 5.0, "toe"), (heel + 7.0, "heel"), (1.3 * heel, "pitch line")):
        ground = {"facecolor": "white", "edgecolor": "none", "pad": 1.0}
        axes.text(*_polar(distance, delta), name, ha="center", va="center", fontsize="small", bbox=ground)
    axes.plot(*_polar(pinion.mean_cone_distance, delta), "k.")
    _arrow(axes, (1.05 * heel, -9.0), (1.05 * heel + 18.0, -9.0), ERROR, "$P$, pinion_axial_mm", (9.0, -6.0))
    _arrow(axes, (-9.0, 1.05 * heel), (-9.0, 1.05 * heel + 18.0), ERROR, "$G$, wheel_axial_mm", (-4.0, 9.0), "right")
    axes.add_patch(Arc((0.0, 0.0), 26.0, 26.0, theta1=0.0, theta2=degrees(sigma), color=ERROR))
    axes.text(-2.0, 12.0, "$\\Sigma$ + shaft_angle_error_deg", color=ERROR, ha="right", fontsize="small")
    axes.plot(0.0, 0.0, "o", color="black", markersize=4.0)
    axes.text(-3.0, -7.0, "apex of the cones,\norigin", ha="right", va="center", fontsize="small")
    axes.set_title("plane of the axes; $y$ towards the reader", fontsize="medium")
    axes.set_xlim(-1.05 * heel, 1.9 * heel)
    axes.set_ylim(-0.8 * heel, 1.7 * heel)


def _draw_front(axes: Axes, pinion: BevelGear, wheel: BevelGear) -> None:
    """Along the pinion's axis from its heel: x to the right, y upwards; the wheel is seen from its side."""
    radius = pinion.outer_cone_distance * sin(pinion.pitch_angle)
    for name, gear_radius in (("tip", pinion.tip_angle), ("root", pinion.root_cone_angle)):
        size = pinion.outer_cone_distance * sin(gear_radius)
        style = "-" if name == "tip" else ":"
        axes.add_patch(Arc((0.0, 0.0), 2.0 * size, 2.0 * size, color=PINION, linestyle=style))
    half, offset = wheel.outer_cone_distance * sin(wheel.pitch_angle), 9.0
    near, far = (
        distance * cos(wheel.pitch_angle) for distance in (wheel.inner_cone_distance, wheel.outer_cone_distance)
    )
    for shift, alpha in ((0.0, 0.2), (offset, 0.45)):
        axes.add_patch(Rectangle((near, shift - half), far - near, 2.0 * half, facecolor=WHEEL, alpha=alpha))
    reach = 1.3 * radius
    _arrow(axes, (0.0, 0.0), (1.9 * radius, 0.0), FRAME)
    _arrow(axes, (0.0, 0.0), (0.0, reach), FRAME)
    axes.text(1.93 * radius, 0.0, "$x$", color=FRAME, va="center")
    axes.text(0.0, reach + 2.0, "$y$", color=FRAME, ha="center")
    axes.plot([0.0, 1.9 * radius], [offset, offset], "-.", color=WHEEL, linewidth=1.0)
    axes.text(1.93 * radius, offset, "wheel axis", color=WHEEL, va="center")
    _arrow(axes, (-8.0, 0.0), (-8.0, offset), ERROR, "$E$, offset_mm", (-2.0, -5.0))
    axes.plot([-10.0, 0.0], [offset, offset], color=ERROR, linewidth=0.8)
    axes.annotate(
        "",
        _polar(0.55 * radius, 2.5),
        _polar(0.55 * radius, 1.9),
        arrowprops={"arrowstyle": "->", "color": PINION, "connectionstyle": "arc3,rad=0.25"},
    )
    axes.text(*_polar(0.75 * radius, 2.2), "$\\varphi_1$", color=PINION, ha="center", va="center")
    axes.text(-0.2 * radius, -1.25 * radius, "pinion, seen from its heel", color=PINION, ha="center")
    axes.text(0.5 * (near + far), -half - 6.0, "wheel", color=WHEEL, ha="center")
    axes.set_title("along the pinion's axis; $z$ towards the reader", fontsize="medium")
    axes.set_xlim(-1.45 * radius, 2.6 * radius)
    axes.set_ylim(-half - 12.0, half + 10.0)


def _teeth(gear: BevelGear, axis: float, half: int) -> list[Point]:
    """Section of the teeth between toe and heel, root and face cone, on one side of the axis."""
    toe, heel = gear.inner_cone_distance, gear.outer_cone_distance
    corners = [(toe, gear.root_cone_angle), (toe, gear.tip_angle), (heel, gear.tip_angle), (heel, gear.root_cone_angle)]
    return [_polar(distance, axis + half * angle) for distance, angle in corners]


def _body(gear: BevelGear, axis: float, half: int) -> list[Point]:
    """Section of the body below the root cone, down to the axis."""
    toe, _, _, heel = _teeth(gear, axis, half)
    along = [distance * cos(gear.root_cone_angle) for distance in (gear.outer_cone_distance, gear.inner_cone_distance)]
    return [toe, heel, _polar(along[0], axis), _polar(along[1], axis)]


def _polar(distance: float, angle: float) -> Point:
    return distance * cos(angle), distance * sin(angle)


def _arrow(
    axes: Axes, start: Point, end: Point, colour: str, label: str = "", at: Point = (0.0, 0.0), align: str = "center"
) -> None:
    """An arrow, with a label at a place counted from its start."""
    axes.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": colour, "shrinkA": 0, "shrinkB": 0})
    axes.text(start[0] + at[0], start[1] + at[1], label, color=colour, ha=align, va="center", fontsize="small")


if __name__ == "__main__":
    draw().savefig(Path(__file__).with_suffix(".png"), dpi=90)
