"""Curves over the positions: transmission error and peak pressure."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from loaded_tca.arrays import Array
from loaded_tca.plots import style
from loaded_tca.plots.style import HEADROOM, HERTZ, NO_LOAD, loads, range_of_positions, torque_styles
from loaded_tca.results.key_figures import ARCSEC, mean_over_a_pitch
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.units import MICROMETRES

SMALLEST_SPAN = 0.02
"""Height [arcsec, or um along a rack] of a transmission error axis below which a curve would be rounding."""
EDGE_HEADROOM = 1.15
"""How far above the curves the pressure at a sharp edge, which depends on the mesh, may draw the axis."""
ROUNDED_EDGE = "p"
"""Marker of the pressure at a rounded edge."""


def plot_transmission_error(result: MeshCycle) -> Figure:
    """Transmission error over the positions, unloaded and under each torque: absolute, and about its mean.

    Parameters
    ----------
    result : MeshCycle

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(8.0, 6.5), layout="constrained")
    absolute, about_mean = figure.subplots(2, 1, sharex=True)
    along = result.scene.rack_radius
    shown, unit = (ARCSEC, "arcsec") if along is None else (MICROMETRES * along, "µm along the rack")
    curves = [("unloaded", "black", ".", result.path.transmission_error)]
    curves += [(*style, result.transmission_error[torque]) for torque, *style in torque_styles(result)]
    angle = np.degrees(result.pinion_angle)
    for label, colour, marker, error in curves:
        mean = mean_over_a_pitch(error)
        absolute.plot(angle, error * shown, color=colour, marker=marker, markersize=4.0, label=label)
        about_mean.plot(angle, (error - mean) * shown, color=colour, marker=marker, markersize=4.0)
    absolute.set_ylabel(f"transmission error [{unit}]")
    about_mean.set_ylabel(f"transmission error\nless its mean [{unit}]")
    about_mean.set_xlabel("pinion angle [deg]")
    figure.legend(*absolute.get_legend_handles_labels(), loc="outside lower center", ncols=4, fontsize="small")
    factor = result.um_per_rad / shown  # um per unit
    for axes in (absolute, about_mean):
        style.widen(axes, SMALLEST_SPAN)
        right = axes.secondary_yaxis("right", functions=(lambda value: value * factor, lambda um: um / factor))
        right.set_ylabel("at the wheel's base circle [µm]" if along is None else "along the path of contact [µm]")
        axes.grid(alpha=0.3)
    style.set_title(figure, result, f"transmission error, {loads(result)}", range_of_positions(result))
    return figure


def plot_peak_pressure(result: MeshCycle) -> Figure:
    """Peak pressure over the positions for each torque, with the pressure after Hertz and the pressure at edges.

    Where tooth pairs share the load, the peak and that after Hertz are those of the pair with the highest peak, the
    Where tooth pairs share the load, peak and pressure after Hertz are those of the pair with the highest peak. The
    pressure at an edge is the highest of all pairs: filled pentagons at rounded edges, crosses at sharp edges. It is
    mesh-dependent at sharp edges; triangles at the upper end of the axis stand for pressures far above the peak. Hertz
    is drawn where it holds over a stretch of positions.

    Parameters
    ----------
    result : MeshCycle

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = style.one_panel(5.5)
    angle = np.degrees(result.pinion_angle)
    peak, edge = result.at_position("peak_pressure"), result.at_position("edge_pressure")
    rounded, sharp = (result.at_position("edge_is_rounded") == one for one in (True, False))
    hertz = np.take_along_axis(result.hertz_pressure, result.peak_column[..., None], axis=-1)[..., 0]
    stretches = np.stack([style.over_a_stretch(row) for row in hertz])
    for torque, label, colour, marker in torque_styles(result):
        axes.plot(angle, peak[torque], color=colour, marker=marker, markersize=5.0, label=label)
        if np.isfinite(stretches[torque]).any():
            axes.plot(angle, stretches[torque], color=colour, **HERTZ)
    if np.isfinite(stretches).any():
        axes.plot([], [], color="black", label="after Hertz", **HERTZ)
    if (rounded := rounded & (edge > 0.0)).any():
        for torque, _, colour, _ in torque_styles(result):
            axes.plot(angle[rounded[torque]], edge[torque][rounded[torque]], ROUNDED_EDGE, color=colour, markersize=8.0)
        axes.plot([], [], ROUNDED_EDGE, color="black", markersize=8.0, label="at a rounded edge")
    style.from_zero(axes)
    if (sharp := sharp & (edge > 0.0)).any():
        _draw_sharp_edges(axes, result, angle, np.where(sharp, edge, np.nan))
    if not (peak > 0.0).any():
        style.tell(axes, NO_LOAD)
    axes.set_ylabel("contact pressure [MPa]")
    about = f"peak contact pressure, {loads(result)}", range_of_positions(result)
    return style.finished(figure, axes, result, *about, columns=2)


def _draw_sharp_edges(axes: Axes, result: MeshCycle, angle: Array, peak: Array) -> None:
    """Crosses, unconnected, for a peak (m, n) that is none elsewhere; triangles at the upper end for those above."""
    _, high = axes.get_ylim()
    within, beyond = peak <= EDGE_HEADROOM * high, peak > EDGE_HEADROOM * high
    high = max(high, (1.0 + HEADROOM) * float(peak[within].max(initial=0.0)))
    edge = 1.06 * high if beyond.any() else high
    for torque, _, colour, _ in torque_styles(result):
        axes.plot(angle[within[torque]], peak[torque][within[torque]], "x", color=colour)
        axes.plot(angle[beyond[torque]], np.full(beyond[torque].sum(), edge), "^", color=colour)
    label = "at a sharp edge (mesh-dependent)"
    if within.any():
        axes.plot([], [], "x", color="black", label=label)
    if beyond.any():
        span = " to ".join(dict.fromkeys(f"{value:z.0f}" for value in (peak[beyond].min(), peak[beyond].max())))
        name = "at a sharp edge," if within.any() else label
        axes.plot([], [], "^", color="black", label=f"{name} above the axis: {span} MPa")
        high = 1.03 * edge
    axes.set_ylim(0.0, high)
