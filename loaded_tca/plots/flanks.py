"""The path of contact on both flanks, with what they carry."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from loaded_tca.flanks.jet import Array
from loaded_tca.gears import CylindricalGear
from loaded_tca.mesh_cycle import MeshCycle, PressureMap
from loaded_tca.pair import GearPair
from loaded_tca.plots.pressure_map import borders
from loaded_tca.plots.style import ACCENT, COLOURS, NO_MATE, highest_torque, load, range_of_positions, set_title
from loaded_tca.scene import parse_scene

MOST_AREAS = 7


def plot_contact_path(result: MeshCycle, torque: int | None = None) -> Figure:
    """Path of contact on both flanks, diameter against face width, with the pressure of some positions.

    White is the part of a flank that the mate reaches at nominal mounting.

    Parameters
    ----------
    result : MeshCycle
    torque : int, optional
        Index of the torque; default: the largest one.

    Returns
    -------
    matplotlib.figure.Figure
    """
    torque = highest_torque(result) if torque is None else torque
    figure = Figure(figsize=(11.0, 5.5), layout="constrained")
    panels = figure.subplots(1, 2)
    scene = parse_scene(result.scene_toml)
    mesh, pair, path = scene.mesh(), scene.pair(), result.path
    sides = (
        ("pinion", mesh.pinion, mesh.pinion_active_profile.start_radius, path.pinion_radius, path.pinion_axial),
        ("wheel", mesh.wheel, mesh.wheel_active_profile.start_radius, path.wheel_radius, path.wheel_axial),
    )
    maps = _drawn_maps(result, torque)
    scale = Normalize(0.0, max((float(one.pressure.max()) for one in maps), default=1.0))
    for axes, (name, gear, start, radius, axial) in zip(panels, sides, strict=True):
        outline = _draw_flank(axes, name, gear, start)
        for one in maps:
            _draw_area(axes, outline, one, _on_gear(pair, name, _corners(one)), scale)
        axes.plot(axial, 2.0 * radius, ".", color=ACCENT, markersize=4.0)
    if maps:
        figure.colorbar(ScalarMappable(scale, COLOURS), ax=panels, label="contact pressure [MPa]")
    _explain(figure, len(maps), len(path))
    what = "contact on the flanks" if maps else "no load, no pressure on the flanks"
    set_title(figure, result, f"{what}, {load(result, torque)}", range_of_positions(result))
    return figure


def _drawn_maps(result: MeshCycle, torque: int) -> list[PressureMap]:
    """Maps under pressure of few enough positions to be told apart."""
    last = len(result.path) - 1
    positions = sorted({round(last * part / (MOST_AREAS - 1)) for part in range(MOST_AREAS)})
    maps = (result.maps[torque][position] for position in positions)
    return [one for one in maps if one is not None and one.pressure.any()]


def _explain(figure: Figure, drawn: int, positions: int) -> None:
    """The legend of the picture of the flanks."""
    handles = [
        Line2D([], [], color=ACCENT, marker=".", linestyle="", label="unloaded contact points of all positions"),
        Patch(facecolor=NO_MATE, edgecolor="black", label="flank that the mate does not reach"),
    ]
    pressure = f"pressure drawn at {drawn} of {positions} positions"
    figure.legend(
        handles=handles, title=pressure, loc="outside lower center", ncols=2, fontsize="small", title_fontsize="small"
    )


def _draw_flank(axes: Axes, name: str, gear: CylindricalGear, start_radius: float) -> Patch:
    """The flank from form circle to tip, with the part that the mate reaches in white; returns its outline."""
    half = 0.5 * gear.face_width
    form, start, tip = (2.0 * radius for radius in (gear.form_radius, start_radius, gear.tip_radius))
    whole = Rectangle((-half, form), 2.0 * half, tip - form, facecolor=NO_MATE, edgecolor="black")
    axes.add_patch(whole)
    axes.add_patch(Rectangle((-half, start), 2.0 * half, tip - start, facecolor="white", edgecolor="black"))
    axes.set_xlim(-1.08 * half, 1.08 * half)
    axes.set_ylim(form - 0.08 * (tip - form), tip + 0.08 * (tip - form))
    axes.set_title(f"{name}, active flank from diameter {start:.2f} to {tip:.2f} mm", fontsize="small")
    axes.set_xlabel("axial place, from mid-face [mm]")
    axes.set_ylabel("diameter [mm]")
    return whole


def _draw_area(axes: Axes, outline: Patch, one: PressureMap, corners: tuple[Array, Array], scale: Normalize) -> None:
    """The cells under pressure of one position, within the outline of the flank."""
    radius, axial = corners
    loaded = np.where(one.pressure > 0.0, one.pressure, np.nan)
    cells = axes.pcolormesh(axial, 2.0 * radius, loaded, cmap=COLOURS, norm=scale, rasterized=True)
    cells.set_clip_path(outline)


def _corners(one: PressureMap) -> Array:
    """Corners (nx + 1, ny + 1, 3) of the cells in the fixed frame [mm]."""
    x, y = (borders(centres, step) for centres, step in zip((one.x, one.y), one.spacing, strict=True))
    return one.origin + x[:, None, None] * one.axes[0] + y[:, None] * one.axes[1]


def _on_gear(pair: GearPair, gear: str, point: Array) -> tuple[Array, Array]:
    """Radius and axial coordinate (...) of points (..., 3) on a gear."""
    if gear == "pinion":
        return np.hypot(point[..., 0], point[..., 1]), point[..., 2]
    radius, _, axial = pair.to_wheel(point)
    return radius, axial
