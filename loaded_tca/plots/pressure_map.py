"""The pressure of one position in the tangent plane."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse, Patch, Rectangle
from matplotlib.ticker import MaxNLocator

from loaded_tca.arrays import real
from loaded_tca.errors import require
from loaded_tca.flanks.base import FlankFrame
from loaded_tca.plots.flanks import highest_of_maps
from loaded_tca.plots.style import ACCENT, COLOURS, NO_LOAD, NO_MATERIAL, chosen_torque, load, place, set_title, tell
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.pressure_map import PressureMap

PRESSURE = "contact pressure [MPa]"
TICKS = 5
"""Steps across a map, at most."""


def plot_pressure_map(
    result: MeshCycle,
    position: int | None = None,
    torque: int | None = None,
    column: int | None = None,
    *,
    highest: float | None = None,
) -> Figure:
    """Contact pressure of one tooth pair at one position in the tangent plane, with the area after Hertz.

    Cells without material are grey, cells without pressure white. The pinion's tip is on top, the heel (or z > 0) on
    the right. The direction across is drawn larger than the one along by a factor that the axis tells.

    Parameters
    ----------
    result : MeshCycle
    position : int, optional
        Index along the path; default: that of the peak pressure, ``result.peak_contact``.
    torque : int, optional
        Index of the torque; default: the largest torque.
    column : int, optional
        Index of the tooth pair in ``result.pair``; default: that with the highest peak pressure at the position.
    highest : float [MPa], optional
        Pressure at the upper end of the colours; default: the highest peak pressure of the result under all its
        torques, so that maps of several torques compare, or as much more as the map, or one at the peak under a torque,
        needs: of a contact at an edge or a relief start at most 5 % of the cells under pressure lie beyond, of others
        none.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the result has no such torque, position or tooth pair, or the pressure is not positive.
    IndexError
        If nothing is in contact at that position.
    """
    torque = chosen_torque(result, torque, position, column)
    if highest is not None:
        require((0.0 < real(highest) < math.inf, f"highest: {highest!r:.60} is not positive and finite"))
    at = result.peak_contact(torque) if position is None else (position, int(result.peak_column[torque, position]))
    if at is not None and column is not None:
        at = at[0], column
    one = None if at is None else result.maps[torque][at[0]][at[1]]
    if at is None or one is None:
        raise IndexError("no pressure map: the tooth pair is not in contact at this position")
    scale, height = scale_factor(len(one.y) * one.spacing[1], len(one.x) * one.spacing[0])
    figure = Figure(figsize=(9.0, 1.8 + height), layout="constrained")
    axes = figure.add_subplot()
    highest = highest_of_maps(result, *at) if highest is None else highest
    draw_map(axes, result, torque, at, highest, scale)
    if one.pressure.any():
        peak = float(one.pressure.max())
        label = PRESSURE + (f"\n(single cells: up to {peak:.0f})" if highest < peak else "")
        colours = ScalarMappable(Normalize(0.0, highest), COLOURS)
        figure.colorbar(colours, ax=axes, label=label, extend="max" if highest < peak else "neither")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize="small")
    frame = result.gear_pair.pinion.flank.frame
    what = "contact pressure" if one.pressure.any() else "no contact pressure"
    told = [*place(result, at[0], frame, at[1]), *_edge(result, torque, at)]
    set_title(figure, result, f"{what}, {load(result, torque)}", *told)
    return figure


def _edge(result: MeshCycle, torque: int, at: tuple[int, int]) -> list[str]:
    """The pressure at an edge that a contact reaches, and why a sharp one may exceed all cells of the map."""
    pressure = float(result.edge_pressure[torque][at])
    if not math.isfinite(pressure):
        return []
    rounded = bool(result.edge_is_rounded[torque][at])
    return [
        f"pressure at {'a rounded' if rounded else 'a sharp'} edge {pressure:.4g} MPa"
        + ("" if rounded else ", mesh-dependent: the force of a cell that an edge cuts, on its part with material")
    ]


def draw_map(
    axes: Axes, result: MeshCycle, torque: int, at: tuple[int, int], highest: float, scale: float
) -> PressureMap:
    """Draw the pressure of a contact, with its area after Hertz and its unloaded contact point, and name the axes.

    The contact is at indices of position and pair; its colours go up to the highest pressure, and across it is drawn
    larger by the scale.
    """
    one = result.maps[torque][at[0]][at[1]]
    assert one is not None
    _draw_pressure(axes, one, highest)
    names = ("hertz_semi_minor", "hertz_semi_major", "hertz_pressure")
    minor, major, pressure = (float(getattr(result, name)[torque][at]) for name in names)
    if math.isfinite(pressure):
        label = f"after Hertz, peak pressure {pressure:.4g} MPa"
        drawn: dict[str, Any] = {"fill": False, "color": ACCENT, "linestyle": "--", "label": label}
        line, size = bool(result.paths[at[1]].on_line[at[0]]), (2.0 * major, 2.0 * minor)
        area: Patch = Rectangle((-major, -minor), *size, **drawn) if line else Ellipse((0.0, 0.0), *size, **drawn)
        axes.add_patch(area)
    axes.plot(0.0, 0.0, "+", color=ACCENT, label="unloaded contact point")
    axes.set_aspect(scale)
    axes.yaxis.set_major_locator(MaxNLocator(TICKS))  # as many before the layout shrinks the panel as after it
    _label_axes(axes, one, scale, result.gear_pair.pinion.flank.frame)
    return one


def _label_axes(axes: Axes, one: PressureMap, scale: float, frame: FlankFrame) -> None:
    """Names of the axes, which are turned so that the pinion's tip is on top and the heel (or z > 0) on the right."""
    dx, dy = one.spacing
    points = one.origin + np.stack([np.zeros(3), dy * one.axes[1], dx * one.axes[0]])
    (here, right, _), (level, _, above) = frame.to_picture(np.hypot(points[:, 0], points[:, 1]), points[:, 2])
    axes.xaxis.set_inverted(bool(right < here))
    axes.yaxis.set_inverted(bool(above < level))
    axes.set_xlabel(f"along the contact [mm], {frame.heelwards} on the right")
    axes.set_ylabel(
        "across the contact [mm]\n(pinion's tip on top)" + (f"\n(drawn {scale:g} times larger)" if scale != 1.0 else "")
    )


def _draw_pressure(axes: Axes, one: PressureMap, highest: float) -> None:
    """Pressure of each cell, in colours up to the highest; white without pressure, grey without material."""
    x, y = one.borders
    void = np.isinf(one.gap)
    ground = colormaps["Greys"].with_extremes(bad=NO_MATERIAL)
    axes.pcolormesh(y, x, np.where(void, np.nan, 0.0), cmap=ground, vmin=0.0, vmax=1.0, rasterized=True)
    if void.any():
        axes.plot([], [], "s", color=NO_MATERIAL, label="no material")
    if not one.pressure.any():
        tell(axes, NO_LOAD)
        return
    loaded = np.where(one.pressure > 0.0, one.pressure, np.nan)
    axes.pcolormesh(y, x, loaded, cmap=COLOURS, norm=Normalize(0.0, highest), rasterized=True)


def scale_factor(length: float, width: float) -> tuple[float, float]:
    """How much larger to draw the direction across of a map, and its height [inch] where it is 7 inches long."""
    wanted = 0.5 * length / width
    power = 10.0 ** math.floor(math.log10(wanted))
    scale = max(factor * power for factor in (1.0, 2.0, 5.0) if factor * power <= wanted)
    return scale, 7.0 * scale * width / length
