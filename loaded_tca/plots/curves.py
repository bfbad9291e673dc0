"""Curves over the positions: transmission error and peak pressure."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from loaded_tca.flanks.jet import Array
from loaded_tca.key_figures import ARCSEC
from loaded_tca.mesh_cycle import MeshCycle
from loaded_tca.plots.style import ACCENT, loads, range_of_positions, set_title, tell_no_load, torque_styles, widen

SMALLEST_SPAN_ARCSEC = 0.02
"""Height of a transmission error axis below which a curve would be rounding."""
HEADROOM = 1.25
"""How far above the curves a peak at a border may draw the axis: the grid alone says how high it is."""


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
    errors = result.by_torque("transmission_error")
    curves = [("unloaded", "black", ".", result.path.transmission_error)]
    curves += [(*style, errors[torque]) for torque, *style in torque_styles(result)]
    angle = np.degrees(result.pinion_angle)
    for label, colour, marker, error in curves:
        finite = error[np.isfinite(error)]
        mean = finite.mean() if finite.size else 0.0
        absolute.plot(angle, error * ARCSEC, color=colour, marker=marker, markersize=4.0, label=label)
        about_mean.plot(angle, (error - mean) * ARCSEC, color=colour, marker=marker, markersize=4.0)
    absolute.set_ylabel("transmission error [arcsec]")
    about_mean.set_ylabel("the same, less its mean [arcsec]")
    about_mean.set_xlabel("pinion angle [deg]")
    figure.legend(*absolute.get_legend_handles_labels(), loc="outside lower center", ncols=4, fontsize="small")
    for axes in (absolute, about_mean):
        widen(axes, SMALLEST_SPAN_ARCSEC)
        _add_length_axis(axes, result.wheel_base_radius)
        axes.grid(alpha=0.3)
    set_title(figure, result, f"transmission error, {loads(result)}", range_of_positions(result))
    return figure


def _add_length_axis(axes: Axes, base_radius: float) -> None:
    """A second axis with the transmission error as a length at the wheel's base circle."""
    factor = base_radius * 1e3 / ARCSEC
    functions = (lambda arcsec: arcsec * factor, lambda length: length / factor)
    axes.secondary_yaxis("right", functions=functions).set_ylabel("at the wheel's base circle [µm]")


def plot_peak_pressure(result: MeshCycle) -> Figure:
    """Peak pressure over the positions for each torque, with the pressure beside the contact point and after Hertz.

    Where tooth pairs share the load, each of these is the highest of all pairs, or of the pair of the highest pressure.

    Peaks at a border or a crease, which grow with the grid, are single crosses; the axis does not follow them far.

    Parameters
    ----------
    result : MeshCycle

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(8.0, 5.5), layout="constrained")
    axes = figure.add_subplot()
    angle = np.degrees(result.pinion_angle)
    peak, at_border = result.by_torque("peak_pressure"), result.by_torque("peak_at_border")
    contacts = result.contacts
    smooth = np.fmax.reduce(np.where(contacts.peak_at_border, np.nan, contacts.peak_pressure), axis=-1)
    central, hertz = (contacts.at_inner(values) for values in (contacts.central_pressure, contacts.hertz_pressure))
    for torque, label, colour, marker in torque_styles(result):
        axes.plot(angle, smooth[torque], color=colour, marker=marker, markersize=5.0, label=label)
        axes.plot(angle, central[torque], color=colour, marker=".", markersize=3.0, linestyle=":")
    axes.plot([], [], color="black", marker=".", markersize=3.0, linestyle=":", label="beside the contact point")
    if np.isfinite(hertz).any():
        lines = axes.plot(angle, hertz.T, color=ACCENT, linestyle="--", marker="_")
        lines[0].set_label("after Hertz")
    widen(axes, 0.02 * max(1.0, float(np.nanmax(peak, initial=0.0))))
    if at_border.any():
        _draw_border_peaks(axes, np.broadcast_to(angle, peak.shape)[at_border], peak[at_border])
    if not (peak > 0.0).any():
        tell_no_load(axes)
    axes.set_xlabel("pinion angle [deg]")
    axes.set_ylabel("contact pressure [MPa]")
    axes.grid(alpha=0.3)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=2, fontsize="small")
    set_title(figure, result, f"peak contact pressure, {loads(result)}", range_of_positions(result))
    return figure


def _draw_border_peaks(axes: Axes, angle: Array, peak: Array) -> None:
    """Crosses, unconnected; arrows at the upper end of the axis where they lie beyond it."""
    low, high = axes.get_ylim()
    limit = HEADROOM * high
    beyond = peak > limit
    label = "largest cell, at a border or crease (grows with the grid)"
    if not beyond.all():
        top = float(peak[~beyond].max())
        axes.plot(angle[~beyond], peak[~beyond], "x", color="black", label=label)
        axes.set_ylim(low, max(high, top + 0.05 * (top - low)))
    if beyond.any():
        span = " to ".join(dict.fromkeys(f"{value:.4g}" for value in (peak[beyond].min(), peak[beyond].max())))
        _, high = axes.get_ylim()
        edge = high + 0.06 * (high - low)
        axes.plot(angle[beyond], np.full(beyond.sum(), edge), "^", color="black", label=f"{label}: above, {span} MPa")
        axes.set_ylim(low, edge + 0.03 * (high - low))
