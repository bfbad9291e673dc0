"""One sheet on a result: pressure, load over the face, transmission error, its orders, stress, key figures."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

from loaded_tca.errors import require
from loaded_tca.plain import signed
from loaded_tca.plots import style
from loaded_tca.plots.flanks import colour_scale, draw_on_pinion, loaded_maps
from loaded_tca.plots.pressure_map import draw_envelope
from loaded_tca.plots.sharing import MOST_ORDERS, draw_face_load, draw_orders
from loaded_tca.plots.style import COLOURS, DISTINCT_COLOURS, MARKERS, chosen_torque, label_of, load, range_of_positions
from loaded_tca.results.figures import key_figures
from loaded_tca.results.key_figures import mean_over_a_pitch
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.quantities import GEARS
from loaded_tca.results.summary import shown

A4 = (11.7, 8.3)
"""Inches, lying."""
COLOUR = DISTINCT_COLOURS[0]
BELOW = -0.17
"""Of a panel and what is written at its axis, in heights of the panel: curves fill the load over the face."""
SHOWN = (
    "peak_pressure_MPa",
    "edge_pressure_MPa",
    "peak_pressure_where_hertz_holds_MPa",
    "hertz_pressure_there_MPa",
    "transmission_error_span_um",
    "transmission_error_mean_um",
    "unloaded_transmission_error_span_um",
    "mesh_stiffness_mean_N_per_mm_um",
    "face_load_factor",
    "transverse_load_factor",
    "loaded_contact_ratio",
    "line_load_at_largest_force_N_per_mm",
    "pinion_root_tension_MPa",
    "wheel_root_tension_MPa",
)
"""Key figures of the sheet, those of them that are known."""


def plot_at_a_glance(result: MeshCycle, torque: int | None = None) -> Figure:
    """Sheet of a result under one torque, of the size of A4.

    Highest pressure on the pinion's flank, load over the face with K_Hbeta, transmission error about its mean with the
    unloaded one, orders of the tooth mesh, root stress over the positions (without it the shares of the tooth pairs),
    and key figures.

    Parameters
    ----------
    result : MeshCycle
        Of two positions or more.
    torque : int, optional
        Index of the torque; default: the largest one.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the result has no such torque, or one position alone.
    """
    torque = chosen_torque(result, torque)
    require((len(result.path) > 1, "at a glance: curves over a pitch; found 1 position, allowed 2 or more"))
    figure = Figure(figsize=A4, layout="constrained")
    (flank, face, numbers), (error, orders, stress) = figure.subplots(2, 3, width_ratios=(1.0, 1.0, 1.1))
    scale, extend = colour_scale(result, loaded_maps(result, torque))
    draw_on_pinion(flank, result, partial(draw_envelope, result, torque, scale))
    label = "highest contact pressure [MPa]"
    figure.colorbar(ScalarMappable(scale, COLOURS), ax=flank, label=label, extend=extend, location="bottom")
    draw_face_load(face, result, [(torque, "mean over a pitch", COLOUR, "")])
    face.legend(fontsize="small", loc="upper center", bbox_to_anchor=(0.5, BELOW))
    for axes in (flank, face):
        axes.xaxis.label.set_fontsize("small")
    flank.title.set_fontsize("x-small")
    _draw_error(error, result, torque)
    amplitudes = 1e3 * result.wheel_base_radius * result.harmonics(MOST_ORDERS)[torque]
    draw_orders(orders, [("", COLOUR, amplitudes)])
    orders.set_ylabel("amplitude of the order [µm]")
    if result.has_root_stress:
        _draw_root_stress(stress, result, torque)
    else:
        _draw_shares(stress, result, torque)
    _write_numbers(numbers, result, torque)
    style.set_title(figure, result, f"at a glance, {load(result, torque)}", result.bending, range_of_positions(result))
    return figure


def _draw_error(axes: Axes, result: MeshCycle, torque: int) -> None:
    """Transmission error about its mean, under load and without [um]."""
    curves = ("loaded", COLOUR, result.transmission_error[torque]), ("unloaded", "0.5", result.path.transmission_error)
    for label, colour, curve in curves:
        about_mean = 1e3 * result.wheel_base_radius * (curve - mean_over_a_pitch(curve))
        axes.plot(np.degrees(result.pinion_angle), about_mean, ".-", color=colour, label=label)
    axes.set(xlabel="pinion angle [deg]", ylabel="transmission error less its mean [µm]")
    axes.legend(fontsize="small")
    axes.grid(alpha=0.3)
    style.widen(axes, 1e-3)


def _draw_root_stress(axes: Axes, result: MeshCycle, torque: int) -> None:
    """Largest tension and compression at the roots of both gears [MPa]."""
    angle = np.degrees(result.pinion_angle)
    for gear, name in enumerate(GEARS):
        colour = DISTINCT_COLOURS[gear]
        axes.plot(angle, result.root_tension[torque, :, gear], ".-", color=colour, label=f"{name}, tension")
        compression = result.root_compression[torque, :, gear]
        axes.plot(angle, compression, ".--", color=colour, label=f"{name}, compression")
    axes.axhline(0.0, color="black", linewidth=0.8)
    axes.set(xlabel="pinion angle [deg]", ylabel="largest root stress [MPa]")
    axes.legend(fontsize="small")
    axes.grid(alpha=0.3)


def _draw_shares(axes: Axes, result: MeshCycle, torque: int) -> None:
    """Share of each tooth pair in the torque [%]."""
    angle = np.degrees(result.pinion_angle)
    for number, share in zip(result.pair.tolist(), result.load_share[torque].T, strict=True):
        colour, marker = DISTINCT_COLOURS[number % len(DISTINCT_COLOURS)], MARKERS[number % len(MARKERS)]
        axes.plot(angle, 100.0 * share, color=colour, marker=marker, markersize=3.0, label=f"pair {signed(number)}")
    axes.set(xlabel="pinion angle [deg]", ylabel="share of the torque [%]", ylim=(-4.0, 106.0))
    axes.legend(fontsize="small")
    axes.grid(alpha=0.3)


def _write_numbers(axes: Axes, result: MeshCycle, torque: int) -> None:
    """Key figures as a table without lines."""
    figures = key_figures(result, torque)
    names = [name for name in SHOWN if math.isfinite(figures.get(name, math.nan))]
    axes.set_axis_off()
    marked = {"edge_pressure_MPa": ", of any pair, mesh-dependent where sharp"}
    rows = [[label_of(name) + marked.get(name, ""), shown(figures[name], name)] for name in names]
    table = axes.table(rows, loc="upper left", cellLoc="left", colWidths=[0.82, 0.18], edges="horizontal")
    for row in range(len(rows)):
        table[row, 1].set_text_props(ha="right")
    table.auto_set_font_size(False)
    table.set_fontsize(7.0)
    table.scale(1.0, 1.35)
