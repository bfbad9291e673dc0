"""Results of gears on supports: misalignment over the torque, loads around the rings of rolling bearings."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from loaded_tca.errors import InputError, require
from loaded_tca.plain import plain
from loaded_tca.plots.sharing import a_pitch_of, draw_face_load
from loaded_tca.plots.style import (
    ACCENT,
    DISTINCT_COLOURS,
    chosen_torque,
    finished,
    load,
    loads,
    one_panel,
    range_of_positions,
    set_title,
    widen,
)
from loaded_tca.results.key_figures import mean_over_a_pitch
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.quantities import GEARS
from loaded_tca.results.summary import shown
from loaded_tca.results.supports import element_forces

SMALLEST_SPAN_UM = 0.1
MOST_COLUMNS = 3
"""Bearings beside each other."""
SMALLEST_SHOWN = 0.02
"""Of the largest force, from which the outline of an element is drawn."""


def plot_misalignment(result: MeshCycle) -> Figure:
    """Misalignment over the pinion torque: mean over the pitch, and the band of all positions.

    Parameters
    ----------
    result : MeshCycle
        Of cylindrical gears on supports.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the result has no misalignment.
    """
    if not np.isfinite(result.misalignment).any():
        raise InputError("misalignment: none in this result: bevel gears, or flanks that are nowhere in contact")
    order = np.argsort(result.torque, kind="stable")
    torque, values = 1e-3 * result.torque[order], result.misalignment[order]
    known = np.isfinite(values).any(axis=1)
    torque, values = torque[known], values[known]
    figure, axes = one_panel()
    colour = DISTINCT_COLOURS[0]
    axes.fill_between(
        torque, np.nanmin(values, axis=1), np.nanmax(values, axis=1), color=colour, alpha=0.25, label="all positions"
    )
    means = [mean_over_a_pitch(over_pitch) for over_pitch in values]
    axes.plot(torque, means, "o-", color=colour, label="mean over the pitch")
    axes.axhline(0.0, color="0.6", linewidth=0.8)
    axes.set(xlabel="pinion torque [N m]", ylabel="misalignment F$_β$ of the supports [µm]")
    axes.set_xlim(left=0.0, right=1.05 * float(torque.max()) if torque.max() > 0.0 else None)
    widen(axes, SMALLEST_SPAN_UM)
    return finished(figure, axes, result, f"misalignment over the torque, {loads(result)}", range_of_positions(result))


def plot_face_load_on_supports(result: MeshCycle, rigid: MeshCycle, torque: int | None = None) -> Figure:
    """Load over the face width with supports that give way, and beside it the load of the same gears on rigid supports.

    Parameters
    ----------
    result : MeshCycle
        On supports.
    rigid : MeshCycle
        Of the scene without them, under the same torques.
    torque : int, optional
        Index of the torque; default: the largest one.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the torques are not the same, a result has one position, or there is no such torque.
    """
    torque = chosen_torque(result, torque)
    same = np.array_equal(result.torque, rigid.torque)
    require(
        (same, "rigid: other torques than those of the result on supports; allowed the same ones"),
        a_pitch_of(result, rigid),
    )
    figure, axes = one_panel()
    for one, label, colour in ((result, "with supports", DISTINCT_COLOURS[0]), (rigid, "rigid", ACCENT)):
        draw_face_load(axes, one, [(torque, label, colour, "")])
    return finished(figure, axes, result, f"load over the face width, {load(result, torque)}", "mean over a pitch")


def plot_bearing_loads(result: MeshCycle, torque: int | None = None) -> Figure:
    """Forces of all elements around the rings of rolling bearings: mean over the pitch, and the largest of a position.

    Parameters
    ----------
    result : MeshCycle
    torque : int, optional
        Index of the torque; default: the largest one.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If no shaft has rolling bearings, or the result has no such torque.
    """
    torque = chosen_torque(result, torque)
    panels = [
        (gear, place, bearing, forces)
        for gear in GEARS
        if f"{gear}_bearing_motion" in result.dataset
        for place, (bearing, forces) in element_forces(result, gear, torque).items()
    ]
    if not panels:
        raise InputError(
            "bearing loads: no rolling bearings in this result; type of [[pinion.shaft.bearings]] gives them"
        )
    columns = 2 if len(panels) == 4 else min(MOST_COLUMNS, len(panels))
    rows = math.ceil(len(panels) / columns)
    figure = Figure(figsize=(4.8 * columns, 5.0 * rows + 0.5), layout="constrained")
    engine: Any = figure.get_layout_engine()
    engine.set(h_pad=0.2)
    for n, (gear, place, bearing, forces) in enumerate(panels):
        axes: Any = figure.add_subplot(rows, columns, n + 1, projection="polar")
        width, mean, largest = 0.7 * math.tau / bearing.elements, forces.mean(axis=0), forces.max(axis=0)
        axes.bar(bearing.angles, mean, width, color=DISTINCT_COLOURS[0], label="mean over the pitch")
        axes.bar(
            bearing.angles,
            np.where(largest > SMALLEST_SHOWN * largest.max(), largest, 0.0),
            width,
            fill=False,
            edgecolor=ACCENT,
            label="largest of all positions",
        )
        life = float(result.dataset[f"{gear}_bearing_life"].values[torque, place])
        lasting = (
            "no load" if math.isinf(life) else f"L10 {shown(life, f'{gear}_bearing_life_Mrev')} million revolutions"
        )
        where = f"{gear}, bearing {place} at {plain(bearing.at, 6)} mm: {bearing.elements} elements, force [N]"
        axes.set_title(f"{where}\n{lasting}", fontsize="small", pad=10.0)
        axes.set_xticks(np.radians([0.0, 90.0, 180.0, 270.0]), ["x", "y", "-x", "-y"])
        axes.set_ylim(0.0, 1.05 * max(float(largest.max()), 1.0))
        axes.set_rlabel_position(112.5)
        axes.yaxis.set_major_locator(MaxNLocator(4))
        axes.tick_params(labelsize="small")
        axes.grid(alpha=0.4)
    handles = figure.axes[0].get_legend_handles_labels()
    figure.legend(*handles, loc="outside lower center", ncols=2, fontsize="small")
    set_title(figure, result, f"loads around the rings, {load(result, torque)}", "axes of each gear's own frame")
    return figure
