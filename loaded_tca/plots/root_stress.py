"""Root stress: over fillet and face of both gears, over the mesh cycle, and over the torque."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from loaded_tca.arrays import Array
from loaded_tca.compliance.root_stress import LEAST_ANGLE
from loaded_tca.plots import style
from loaded_tca.plots.style import (
    DISTINCT_COLOURS,
    HEADROOM,
    chosen_torque,
    highest_torque,
    load,
    loads,
    range_of_positions,
)
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.quantities import GEARS
from loaded_tca.results.root_stress import RootStressMap

DIVERGING = "RdBu_r"
"""White without stress, red in tension, blue in compression: told apart by colour-blind readers."""
TENSION, COMPRESSION = "-", "--"
GEAR_COLOURS = DISTINCT_COLOURS[0], DISTINCT_COLOURS[1]
NOMINAL = ":"


def plot_root_stress(result: MeshCycle, torque: int | None = None) -> Figure:
    """Root stress over fillet and face of both gears under one torque, on one scale of colours for all torques.

    Above at the position of the largest tension, below the largest and the smallest stress that a tooth sees in a whole
    turn. Each panel has both sides of a tooth, from its root in the middle of the space on its back (left) to that on
    the side in contact (right); dots are the places of the extremes.

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
    NotAskedError
        If the scene of the result does not ask for root stress.
    InputError
        If the result has no such torque.
    """
    torque = chosen_torque(result, torque)
    maps = result.root_stress
    figure = Figure(figsize=(10.0, 9.0), layout="constrained")
    panels = figure.subplots(3, 2, sharex=True, sharey="col")
    largest = max(float(np.nanmax(np.abs(part), initial=0.0)) for one in maps for part in _shown(one))
    scale = Normalize(-largest or -1.0, largest or 1.0)
    for column, (gear, one) in enumerate(zip(GEARS, maps, strict=True)):
        titles = "at its largest tension", "largest stress in a turn", "smallest stress in a turn"
        marked = (1.0, -1.0), (1.0,), (-1.0,)
        for axes, part, title, signs in zip(panels[:, column], _shown(one), titles, marked, strict=True):
            _draw_fillets(axes, one, part[torque], scale)
            _mark_extremes(axes, one, part[torque], signs)
            axes.set_title(f"{gear}, {title}", fontsize="medium")
            axes.set_ylabel(f"axial position on the {gear} [mm]")
        panels[-1, column].set_xticks(range(-60, 61, 30))  # 30 deg: the critical section of ISO 6336-3
        panels[-1, column].set_xlabel("tangent angle [deg]: back of the tooth | side in contact")
    figure.colorbar(ScalarMappable(scale, DIVERGING), ax=panels, label="root stress [MPa], tension positive")
    bands = f"white bands beside the tooth: not evaluated, the flank or less than {math.degrees(LEAST_ANGLE):z.0f} deg"
    style.set_title(figure, result, f"root stress, {load(result, torque)}", range_of_positions(result), bands)
    return figure


def _shown(one: RootStressMap) -> tuple[Array, Array, Array]:
    return one.at_tension, one.largest, one.smallest


def _draw_fillets(axes: Axes, one: RootStressMap, stress: Array, scale: Normalize) -> None:
    """Both sides of a tooth, the back mirrored to the left; a field between nodes has the mean of its four.

    Fields are two to four pixels large; colours that run between the nodes take longer and make files of 690 kB.
    """
    for side, sign in ((0, 1.0), (1, -1.0)):
        angle, axial = sign * np.degrees(one.tangent_angle[side]), one.point[side, ..., 2]
        nodes = stress[side]
        fields = 0.25 * (nodes[:-1, :-1] + nodes[1:, :-1] + nodes[:-1, 1:] + nodes[1:, 1:])
        axes.pcolormesh(angle, axial, fields, cmap=DIVERGING, norm=scale, rasterized=True)
    axes.axvspan(-10.0, 10.0, color=style.NO_MATERIAL)
    axes.text(0.0, 0.5, "tooth", transform=axes.get_xaxis_transform(), ha="center", va="center", rotation=90.0)


def _mark_extremes(axes: Axes, one: RootStressMap, stress: Array, signs: tuple[float, ...]) -> None:
    """A dot and a number where the stress times a sign is largest; nothing without stress."""
    for sign in signs:
        if np.nanmax(sign * stress, initial=0.0) > 0.0:
            side, station, along = np.unravel_index(np.nanargmax(sign * stress), stress.shape)
            x = (1.0, -1.0)[side] * math.degrees(one.tangent_angle[side, station, along])
            place = x, one.point[side, station, along, 2]
            axes.plot(*place, "o", color="black", markeredgecolor="white", markersize=5.0)
            number = f"{stress[side, station, along]:z.0f}"
            above = place[1] > np.nanmean(one.point[..., 2])
            offset, side_of_text = ((0.0, -6.0), "top") if above else ((0.0, 6.0), "bottom")
            text = axes.annotate(number, place, offset, textcoords="offset points", ha="center", va=side_of_text)
            text.set_path_effects([withStroke(linewidth=2.5, foreground="white")])


def plot_root_stress_cycle(result: MeshCycle) -> Figure:
    """Largest tension and compression at the roots of all teeth over the positions, of both gears on one scale.

    Thin vertical lines stand where the number of loaded tooth pairs changes under the largest torque.

    Parameters
    ----------
    result : MeshCycle

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    NotAskedError
        If the scene of the result does not ask for root stress.
    """
    tension, compression = result.root_tension, result.root_compression
    figure = Figure(figsize=(10.0, 5.5), layout="constrained")
    panels = figure.subplots(1, 2, sharex=True, sharey=True)
    angle = np.degrees(result.pinion_angle)
    pairs = result.loaded_pairs[highest_torque(result)]
    changes = 0.5 * (angle[1:] + angle[:-1])[np.diff(pairs) != 0]
    for gear, axes in enumerate(panels):
        for torque, label, colour, marker in style.torque_styles(result):
            look = {"color": colour, "marker": marker, "markersize": 4.0}
            axes.plot(angle, tension[torque, :, gear], TENSION, label=label, **look)
            axes.plot(angle, compression[torque, :, gear], COMPRESSION, **look)
        axes.axhline(0.0, color="black", linewidth=0.8)
        for change in changes:
            axes.axvline(change, color="0.5", linewidth=0.8, linestyle=":")
        axes.set_title(result.scene.gear_names[gear], fontsize="medium")
        axes.set_xlabel("pinion angle [deg]")
        axes.grid(alpha=0.3)
    panels[0].set_ylabel("root stress [MPa]")
    panels[0].plot([], [], TENSION, color="black", label="largest tension")
    panels[0].plot([], [], COMPRESSION, color="black", label="largest compression")
    if len(changes):
        panels[0].plot([], [], ":", color="0.5", label="loaded pairs change (largest torque)")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize="small")
    style.set_title(figure, result, f"root stress over the mesh, {loads(result)}", range_of_positions(result))
    return figure


def plot_root_stress_over_torque(result: MeshCycle) -> Figure:
    """Largest tension and compression of the whole mesh cycle over the torque, beside stress after ISO 6336-3.

    Parameters
    ----------
    result : MeshCycle

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    NotAskedError
        If the scene of the result does not ask for root stress.
    """
    _ = result.root_stress
    figures, order = result.key_figures(), np.argsort(result.torque)
    figure = Figure(figsize=(8.0, 5.5), layout="constrained")
    axes = figure.add_subplot()
    torque = 1e-3 * result.torque[order]
    curves: tuple[tuple[str, str, dict[str, Any]], ...] = (
        ("root_tension", "largest tension", {"linestyle": TENSION, "marker": "o"}),
        ("root_compression", "largest compression", {"linestyle": COMPRESSION, "marker": "s"}),
        ("root_stress_iso_6336", "ISO 6336-3, $σ_{F0} K_{Fβ}$", {"linestyle": NOMINAL, "marker": "^"}),
    )
    for gear, colour in zip(GEARS, GEAR_COLOURS, strict=True):
        for name, label, look in curves:
            values = np.array([figures[k][f"{gear}_{name}_MPa"] for k in order])
            if np.isfinite(values).any():
                filled = colour if gear == GEARS[0] else "none"  # where both lie on each other both are seen
                axes.plot(torque, values, color=colour, markerfacecolor=filled, label=f"{gear}: {label}", **look)
    axes.axhline(0.0, color="black", linewidth=0.8)
    axes.set_xlim(0.0, (1.0 + HEADROOM) * torque[-1] or None)
    axes.set_xlabel("pinion torque [N m]")
    axes.set_ylabel("root stress [MPa]")
    axes.grid(alpha=0.3)
    return style.finished(figure, axes, result, "root stress over the torque", range_of_positions(result), columns=2)
