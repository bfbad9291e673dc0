"""Pictures of the shared load: load shares, stiffness, line load, and the pressure that flanks see over the cycle."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.jet import Array
from loaded_tca.mesh_cycle import MeshCycle
from loaded_tca.pair import GearPair
from loaded_tca.pair_contacts import PressureMap
from loaded_tca.plots.flanks import draw_flank, on_gear
from loaded_tca.plots.style import (
    ACCENT,
    COLOURS,
    MARKERS,
    highest_torque,
    load,
    loads,
    range_of_positions,
    set_title,
    torque_styles,
    widen,
)
from loaded_tca.scene import parse_scene

EDGE = "contact on an edge"
MOST_ORDERS = 8
"""Orders of the tooth mesh that are drawn."""
SMALLEST_AMPLITUDE_UM = 1e-4


def plot_load_share(result: MeshCycle, torque: int | None = None) -> Figure:
    """Share of each tooth pair in the torque over the positions, and how many carry load.

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
    figure = Figure(figsize=(8.0, 6.0), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(3.0, 1.0))
    angle = np.degrees(result.pinion_angle)
    shares = result.load_share.reshape(len(result.torque), len(angle), len(result.pairs))[torque]
    order = np.argsort(result.pairs)
    for number, share in zip(result.pairs[order], shares.T[order], strict=True):
        marker = MARKERS[int(number) % len(MARKERS)]
        above.plot(angle, 100.0 * share, marker=marker, markersize=4.0, label=f"tooth pair {number:+d}")
    below.step(angle, result.by_torque("loaded_pairs")[torque], where="mid", color="black")
    above.set_ylabel("share of the torque [%]")
    above.set_ylim(-4.0, 104.0)
    below.set_ylabel("pairs under load")
    below.set_ylim(0.0, len(result.pairs) + 0.5)
    below.set_xlabel("pinion angle [deg]")
    for axes in (above, below):
        axes.grid(alpha=0.3)
    figure.legend(*above.get_legend_handles_labels(), loc="outside lower center", ncols=5, fontsize="small")
    set_title(figure, result, f"load sharing, {load(result, torque)}", range_of_positions(result))
    return figure


def plot_mesh_stiffness(result: MeshCycle) -> Figure:
    """Mesh stiffness over the positions under each torque: tangent, and dotted the secant from no load.

    Parameters
    ----------
    result : MeshCycle

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = _one_panel()
    tangent, secant = result.by_torque("mesh_stiffness"), result.by_torque("secant_stiffness")
    for torque, label, colour, marker in torque_styles(result):
        angle = np.degrees(result.pinion_angle)
        axes.plot(angle, tangent[torque], color=colour, marker=marker, markersize=4.0, label=label)
        axes.plot(angle, secant[torque], color=colour, marker=".", markersize=3.0, linestyle=":")
    axes.plot([], [], color="black", linestyle=":", label="secant, from no load")
    axes.set_ylabel("mesh stiffness [N/(mm µm)]")
    axes.set_ylim(bottom=0.0)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize="small")
    set_title(figure, result, f"mesh stiffness, {result.yielding}, {loads(result)}", range_of_positions(result))
    return figure


def plot_line_load(result: MeshCycle) -> Figure:
    """Largest line load of any tooth pair over the positions, under each torque.

    Parameters
    ----------
    result : MeshCycle

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = _one_panel()
    line_load = np.fmax.reduce(result.contacts.line_load, axis=-1)
    for torque, label, colour, marker in torque_styles(result):
        axes.plot(
            np.degrees(result.pinion_angle), line_load[torque], color=colour, marker=marker, markersize=4.0, label=label
        )
    axes.set_ylabel("largest line load [N/mm]")
    axes.set_ylim(bottom=0.0)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize="small")
    set_title(figure, result, f"line load along the contact, {loads(result)}", range_of_positions(result))
    return figure


def plot_harmonics(result: MeshCycle) -> Figure:
    """Amplitudes of the orders of the tooth mesh in the loaded transmission error, under each torque.

    Parameters
    ----------
    result : MeshCycle

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(8.0, 5.0), layout="constrained")
    axes = figure.add_subplot()
    amplitudes = 1e3 * result.wheel_base_radius * result.harmonics(MOST_ORDERS)
    orders, width = np.arange(1, MOST_ORDERS + 1), 0.8 / len(result.torque)
    for torque, label, colour, _ in torque_styles(result):
        place = orders + (torque - 0.5 * (len(result.torque) - 1)) * width
        axes.bar(place, amplitudes[torque], width, color=colour, label=label)
    axes.set_xlabel("order of the tooth mesh")
    axes.set_ylabel("amplitude at the wheel's base circle [µm]")
    widen(axes, SMALLEST_AMPLITUDE_UM)
    axes.grid(alpha=0.3, axis="y")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize="small")
    what = f"harmonics of the transmission error, {loads(result)}"
    set_title(figure, result, what, range_of_positions(result))
    return figure


def plot_pressure_envelope(result: MeshCycle, torque: int | None = None) -> Figure:
    """Highest pressure that each place of both flanks sees over the cycle, from the maps of all pairs.

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
    scene = parse_scene(result.scene_toml)
    pair, starts = scene.pair(), scene.active_starts()
    maps = [one for row in result.contacts.maps[torque] for one in row if one is not None and one.pressure.any()]
    scale = Normalize(0.0, _scale_end(result, torque, maps))
    sides = zip(figure.subplots(1, 2), scene.flank_names, (pair.pinion, pair.wheel), starts, strict=True)
    panels = []
    for axes, name, flank, start in sides:
        outline = draw_flank(axes, name, flank, start)
        cells, pressure = _cells(maps, pair, flank)
        drawn = PolyCollection(list(cells), array=pressure, cmap=COLOURS, norm=scale, edgecolors="face", linewidths=0.3)
        drawn.set_rasterized(True)
        axes.add_collection(drawn, autolim=False)
        drawn.set_clip_path(outline)
        panels.append(axes)
    figure.colorbar(ScalarMappable(scale, COLOURS), ax=panels, label="highest contact pressure [MPa]", extend="max")
    set_title(figure, result, f"pressure envelope, {load(result, torque)}", range_of_positions(result))
    return figure


def plot_path_pressure(result: MeshCycle) -> Figure:
    """Pressure from the begin to the end of contact: every tooth pair at the angle of its own teeth, one curve.

    For a spur pair that is the pressure from A to E: begin of contact, single contact from B to D, end of contact.

    Parameters
    ----------
    result : MeshCycle

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = _one_panel()
    contacts = result.contacts
    inner, peak = contacts.inner_pressure, contacts.peak_pressure
    pitch = 2.0 * np.pi / parse_scene(result.scene_toml).pair().teeth[0]
    angle = np.degrees(result.pinion_angle[:, None] - pitch * result.pairs).ravel()
    order = np.argsort(angle, kind="stable")
    for torque, label, colour, marker in torque_styles(result):
        curve, largest = inner[torque].ravel()[order], peak[torque].ravel()[order]
        known = np.isfinite(curve)
        axes.plot(angle[order][known], curve[known], color=colour, marker=marker, markersize=4.0, label=label)
        _draw_ends(axes, angle[order], np.where(np.isfinite(largest) & ~known, largest, np.nan), inner)
    axes.set_xlabel("pinion angle from the pitch point of the tooth pair [deg]")
    axes.set_ylabel("contact pressure [MPa]")
    axes.set_ylim(bottom=0.0)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize="small")
    set_title(figure, result, f"pressure over the path of contact, {loads(result)}")
    return figure


def _draw_ends(axes: Axes, angle: Array, edge: Array, inner: Array) -> None:
    """Crosses at the lower end of the axis where a contact lies on an edge, of which the grid alone says the peak."""
    there = np.isfinite(edge)
    if there.any() and np.isfinite(inner).any():
        known = "_nolegend_" if axes.get_legend_handles_labels()[1].count(EDGE) else EDGE
        axes.plot(angle[there], np.zeros(there.sum()), "x", color=ACCENT, label=known, clip_on=False)


def _one_panel() -> tuple[Figure, Axes]:
    figure = Figure(figsize=(8.0, 5.0), layout="constrained")
    axes = figure.add_subplot()
    axes.set_xlabel("pinion angle [deg]")
    axes.grid(alpha=0.3)
    return figure, axes


def _cells(maps: list[PressureMap], pair: GearPair, flank: Flank) -> tuple[Array, Array]:
    """Corners (cells, 4, 2) in the picture of a flank, and pressure (cells,), of all cells under it, highest last."""
    corners, pressures = [np.zeros((0, 4, 2))], [np.zeros(0)]
    for one in maps:
        at = np.stack(flank.frame.to_picture(*on_gear(pair, flank, one.corners)), axis=-1)
        around = np.stack([at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]], axis=2)
        corners.append(around[one.pressure > 0.0])
        pressures.append(one.pressure[one.pressure > 0.0])
    pressure = np.concatenate(pressures)
    order = np.argsort(pressure, kind="stable")
    return np.concatenate(corners)[order], pressure[order]


def _scale_end(result: MeshCycle, torque: int, maps: list[PressureMap]) -> float:
    """Highest pressure that is no matter of the grid; the highest at all if there is none."""
    inner = result.contacts.inner_pressure[torque]
    if np.isfinite(inner).any():
        return float(np.nanmax(inner)) or 1.0
    return max((float(one.pressure.max()) for one in maps), default=1.0)
