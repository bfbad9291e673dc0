"""Teeth of both gears of a cylindrical pair in mesh at the pitch point, in the transverse section, before any contact.

The pinion lies below and its axis points to the reader; the pitch point is the origin. Lengths are in mm.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from loaded_tca.arrays import Array
from loaded_tca.gears import undercuts
from loaded_tca.gears.chamfer import tip_half_angle
from loaded_tca.plots.style import ACCENT, write_title
from loaded_tca.scene.double_helical import DoubleHelicalScene

if TYPE_CHECKING:
    from loaded_tca.gears import CylindricalGear, CylindricalMesh, InternalMesh, RingGear
    from loaded_tca.scene.cylindrical import CylindricalScene

POINTS = 40
"""Along each part of half a tooth."""
PITCHES = 1.9
"""Of the working circle, to either side of the pitch point that are shown."""
CLOSE = 0.12
"""Base pitches between points of the line of action that have one label: about the width of two letters."""
BODY = 1.6
"""Modules below the roots that are shown."""
FILLS = "#cfe2f1", "#f8dfc4"
LINES = "#0072b2", "#b35900"
CIRCLES = {"tip circle": "--", "working circle": "-.", "root circle": ":"}


@dataclass(frozen=True)
class _Drawn:
    """A gear in the picture.

    Attributes
    ----------
    gear : CylindricalGear or RingGear
    axis : float [mm]
        Height of its axis.
    up : int
        +1 where its teeth in mesh point upwards from its axis, -1 downwards.
    working_radius : float [mm]
    middle : float [rad]
        Angle from the line of centres to the middle of the tooth that touches at the pitch point, to the right.
    """

    gear: CylindricalGear | RingGear
    axis: float
    up: int
    working_radius: float
    middle: float

    def places(self, radius: Array, angle: Array) -> tuple[Array, Array]:
        """Points at radii and at angles from the line of centres."""
        return radius * np.sin(angle), self.axis + self.up * radius * np.cos(angle)

    def outline(self, width: float, depth: float) -> tuple[Array, Array]:
        """Closed outline of the teeth within a width, and of a body of some depth."""
        gear, pitch = self.gear, 2.0 * math.pi / self.gear.tooth_count
        radius, half = half_section(gear, POINTS)
        count = min(math.ceil(width / (pitch * self.working_radius)) + 3, gear.tooth_count // 2)
        teeth = np.arange(-count, count + 1)[:, None] * pitch
        around = np.concatenate([-half[::-1], half])
        angles = (self.middle + teeth + around).ravel()
        radii = np.tile(np.concatenate([radius[::-1], radius]), len(teeth))
        side = -1.0 if gear.teeth > 0 else 1.0
        body = np.full(200, max(gear.root_radius + side * depth, 0.0))
        back = np.linspace(angles[-1], angles[0], 200)
        return self.places(np.concatenate([radii, body]), np.concatenate([angles, back]))


def half_section(gear: CylindricalGear | RingGear, points: int) -> tuple[Array, Array]:
    """Half a tooth in the transverse section from the middle of its tip to the middle of the space.

    Parameters
    ----------
    gear : CylindricalGear or RingGear
    points : int
        Along flank and fillet each.

    Returns
    -------
    radius, angle : (n,) arrays [mm], [rad]
        About the axis of the gear, the angle from the middle of the tooth; a chamfer is a straight line.
    """
    flank = np.hypot(
        np.linspace(gear.roll_length(gear.tip_form_radius), gear.roll_length(gear.form_radius), points),
        gear.base_radius,
    )
    thickness = np.array([0.5 * gear.tooth_thickness_at(radius) / radius for radius in flank.tolist()])
    fillet = gear.root_fillet(points)
    land = np.linspace(0.0, tip_half_angle(gear), 8)
    root = np.linspace(fillet[1][-1], math.pi / gear.tooth_count, 8)
    return (
        np.concatenate([np.full(8, gear.tip_radius), flank, fillet[0][1:], np.full(8, fillet[0][-1])]),
        np.concatenate([land, thickness, fillet[1][1:], root]),
    )


def plot_teeth_in_mesh(scene: CylindricalScene) -> Figure:
    """Teeth of both gears in the transverse section, while the unmodified flanks touch at the pitch point.

    Both outlines, of nominal gears at the centre distance with its error; tip, working and root circles; the line of
    action between the base circles with the path of contact A to E, and the points that touch; tip clearances and
    backlash. The pinion lies below, its axis points to the reader, and both directions have one scale.

    Parameters
    ----------
    scene : CylindricalScene, InternalScene or RackScene
        Of a double helical pair that of its half.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    GeometryError
        If the gears do not mesh at their centre distance.

    References
    ----------
    ISO 21771:2007, 5.2 to 5.5 (path of contact, backlash, tip clearance).
    """
    width, height = extent_of_teeth(scene)
    figure = Figure(figsize=(10.0, 9.3 * height / width + 1.0), layout="constrained")
    draw_teeth_in_mesh(figure.add_subplot(), scene)
    figure.legend(loc="outside lower center", ncols=4, fontsize="small")
    section = "transverse section of a half" if isinstance(scene, DoubleHelicalScene) else "transverse section"
    shown = f"teeth in mesh at the pitch point, {section}"
    write_title(figure, scene.title, shown, *numbers_of_teeth(scene))
    return figure


def extent_of_teeth(scene: CylindricalScene) -> tuple[float, float]:
    """Width and height [mm] that teeth in mesh take in a picture."""
    mesh = scene.mounted_mesh()
    low, high = _ends(mesh)
    return 2.0 * _half_width(mesh), high - low


def _half_width(mesh: CylindricalMesh | InternalMesh) -> float:
    return PITCHES * 2.0 * math.pi * mesh.pinion_working_radius / mesh.pinion.teeth


def _ends(mesh: CylindricalMesh | InternalMesh) -> tuple[float, float]:
    """Lowest and highest place that is shown, from the pitch point: some way into both bodies."""
    roots = [one.axis + one.up * one.gear.root_radius for one in _gears_of(mesh, 1.0)]
    body = BODY * mesh.pinion.normal_module
    return min(roots) - body, max(roots) + body


def draw_teeth_in_mesh(axes: Axes, scene: CylindricalScene) -> None:
    """Teeth of both gears, circles, line of action, path of contact, clearances and backlash, in one scale."""
    mesh = scene.mounted_mesh()
    mirrored = (scene.geometry.driving == "pinion") != (scene.sense == "positive")
    side = -1.0 if mirrored else 1.0
    gears, module, width = _gears_of(mesh, side), mesh.pinion.normal_module, _half_width(mesh)
    names, is_rack = scene.gear_names, scene.rack_radius is not None
    for name, one, fill, line, counted in zip(names, gears, FILLS, LINES, (True, not is_rack), strict=True):
        number = f", {abs(one.gear.teeth)} teeth" if counted else ""
        teeth = f"{name}{number}" + (" (ring)" if one.gear.teeth < 0 else "")
        axes.fill(*one.outline(width, 6.0 * module), facecolor=fill, edgecolor=line, linewidth=1.2, label=teeth)
        _draw_circles(axes, one, line, width)
    _draw_path(axes, mesh, side)
    _draw_clearances(axes, mesh, gears, side)
    axes.set(xlim=(-width, width), ylim=_ends(mesh), aspect="equal")
    axes.set_xlabel("from the line of centres [mm]")
    axes.set_ylabel(f"from the pitch point, towards the {names[1]} [mm]")


def numbers_of_teeth(scene: CylindricalScene) -> Iterator[str]:
    """What is read off teeth in mesh, in words with units."""
    mesh = scene.mounted_mesh()
    error = mesh.working_centre_distance - scene.mesh().working_centre_distance
    turns = "counter-clockwise" if scene.sense == "positive" else "clockwise"
    yield f"{scene.geometry.driving} drives, pinion turns {turns}"
    yield f"mounted with an error of the centre distance of {error:+.4f} mm" if error else ""
    for number in _numbers(mesh, scene.rack_radius, scene.gear_names):
        yield number.replace(" mm", "\N{NO-BREAK SPACE}mm")


def _gears_of(mesh: CylindricalMesh | InternalMesh, side: float) -> tuple[_Drawn, _Drawn]:
    """Both gears, the pinion's tooth to the right of the pitch point where ``side`` is +1."""
    first, second = mesh.pinion_working_radius, mesh.wheel_working_radius
    pinion, wheel = mesh.pinion, mesh.wheel
    angles = [0.5 * gear.tooth_thickness_at(radius) / radius for gear, radius in ((pinion, first), (wheel, second))]
    up = -1 if wheel.teeth > 0 else 1
    return (
        _Drawn(pinion, -first, 1, first, side * angles[0]),
        _Drawn(wheel, -up * second, up, second, -side * angles[1]),
    )


def _draw_circles(axes: Axes, one: _Drawn, colour: str, width: float) -> None:
    """Arcs of the tip, working and root circle."""
    radii = one.gear.tip_radius, one.working_radius, one.gear.root_radius
    for radius, (name, style) in zip(radii, CIRCLES.items(), strict=True):
        end = math.asin(min(1.0, 1.1 * width / radius))
        x, y = one.places(np.full(200, radius), np.linspace(-end, end, 200))
        label = f"{name}s" if one.axis < 0.0 and one.up > 0 and colour == LINES[0] else None
        axes.plot(x, y, style, color=colour, linewidth=0.9, label=label)


def _draw_path(axes: Axes, mesh: CylindricalMesh | InternalMesh, side: float) -> None:
    """Line of action between the base circles, path of contact with its letters, and the points that touch."""
    path, angle = mesh.path_of_contact, mesh.working_pressure_angle
    direction = np.array([-side * math.cos(angle), math.sin(angle)])

    def at(lengths: Any) -> Array:
        return np.multiply.outer(direction, np.asarray(lengths, dtype=float) - path.C)

    axes.plot(*at([path.T1, path.T2]), color="0.25", linewidth=0.9, zorder=3.0, label="line of action T1 T2")
    axes.plot(*at([path.A, path.E]), color=ACCENT, linewidth=2.4, zorder=4.0, label="path of contact A to E")
    places = sorted((getattr(path, name), name) for name in ("T1", "A", "B", "C", "D", "E", "T2"))
    across, last = np.array([side * math.sin(angle), math.cos(angle)]), 0
    for n, (length, name) in enumerate(places):
        axes.plot(*at(length), "|" if name[0] == "T" else ".", color="black", markersize=6.0, zorder=5.0)
        if n + 1 < len(places) and places[n + 1][0] - places[last][0] < CLOSE * path.AD:
            continue
        letters = " ".join(name for _, name in places[last : n + 1])  # of points that lie together
        where = at(0.5 * (places[last][0] + length))
        axes.annotate(
            letters,
            (where[0], where[1]),
            (11.0 * across[0], 11.0 * across[1]),
            textcoords="offset points",
            ha="center" if name[0] != "T" else "left" if where[0] < 0.0 else "right",  # T1 and T2 may be at the border
            va="center",
            zorder=6.0,
            annotation_clip=True,
        )
        last = n + 1
    touching = np.arange(math.ceil((path.A - path.C) / path.AD), math.floor((path.E - path.C) / path.AD) + 1)
    about: dict[str, Any] = {"marker": "o", "color": "black", "markersize": 8.0, "markerfacecolor": "none"}
    axes.plot(*at(path.C + touching * path.AD), linestyle="none", zorder=5.0, label="flanks touch", **about)


def _draw_clearances(
    axes: Axes, mesh: CylindricalMesh | InternalMesh, gears: tuple[_Drawn, _Drawn], side: float
) -> None:
    """Both tip clearances on the line of centres, and the backlash behind the tooth of the pinion that touches.

    Clearances are written beside the line of centres where the path of contact is not: above the pitch point the path
    is on the left where ``side`` is +1.
    """
    about: dict[str, Any] = {
        "textcoords": "offset points",
        "va": "center",
        "fontsize": "small",
        "bbox": {"boxstyle": "round,pad=0.15", "facecolor": "white", "edgecolor": "none", "alpha": 0.85},
        "zorder": 7.0,
    }
    for one, other, clearance in zip(gears, gears[::-1], mesh.tip_clearances, strict=True):
        ends = one.axis + one.up * one.gear.root_radius, other.axis + other.up * other.gear.tip_radius
        axes.plot([0.0, 0.0], ends, color="black", linewidth=2.0, solid_capstyle="butt", zorder=5.0)
        middle = sum(ends) / 2.0
        right = side * middle > 0.0
        text = (6.0 if right else -6.0, 0.0)
        axes.annotate(f"c = {clearance:.3f} mm", (0.0, middle), text, ha="left" if right else "right", **about)
    pinion = gears[0]
    back = np.array([2.0 * pinion.middle + math.copysign(0.5 * mesh.backlash / pinion.working_radius, pinion.middle)])
    x, y = pinion.places(np.array([pinion.working_radius]), back)
    text = (math.copysign(30.0, pinion.middle), 30.0)
    arrow = {"arrowstyle": "-", "color": "black", "linewidth": 0.8}
    label = f"backlash j_wt = {_rounded(mesh.backlash):.4f} mm"
    axes.annotate(label, (x[0], y[0]), text, ha="center", arrowprops=arrow, **about)


def _numbers(mesh: CylindricalMesh | InternalMesh, rack_radius: float | None, names: tuple[str, str]) -> Iterator[str]:
    """What is read off the picture, with its units; a rack's reference line is so far from the wheel's axis."""
    pinion, wheel = mesh.tip_clearances
    place = "reference line of the rack from the axis of the pinion" if rack_radius else "centre distance"
    yield f"{place} {mesh.working_centre_distance - (rack_radius or 0.0):.4f} mm"
    yield f"working pressure angle {math.degrees(mesh.working_pressure_angle):.4f} deg"
    path = mesh.path_of_contact
    yield f"path of contact A to E {path.AE:.4f} mm, contact ratio {mesh.transverse_contact_ratio:.4f}"
    yield f"backlash j_wt {_rounded(mesh.backlash):.4f} mm, normal j_bn {_rounded(mesh.normal_backlash):.4f} mm"
    yield f"tip clearance at the root of the {names[0]} {pinion:.4f} mm, of the {names[1]} {wheel:.4f} mm"
    for name, cut in zip(names, undercuts(mesh), strict=True):
        if cut is not None:
            yield f"undercut of the {name}: {cut.lost_length:.4f} mm of the path are lost, {cut.lost_share:.1%}"


def _rounded(length: float) -> float:
    """A length without the minus of a zero [mm]."""
    return round(length, 4) + 0.0
