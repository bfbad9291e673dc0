"""Pictures of the shared load: load shares, stiffness, line load, and the pressure that flanks see over the cycle."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from loaded_tca.arrays import Array
from loaded_tca.errors import GeometryError
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.plots import style
from loaded_tca.plots.flanks import both_flanks, loaded_maps
from loaded_tca.plots.style import (
    COLOURS,
    HERTZ,
    MARKERS,
    NO_LOAD,
    highest_torque,
    load,
    loads,
    range_of_positions,
    torque_styles,
)
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.summary import signed
from loaded_tca.unloaded import trace_contact

EDGE = "at an edge or relief start: pressure mesh-dependent, not drawn"
WHAT_LETTERS_ARE = "A, E: the unloaded contact of these flanks begins, ends; B, D: a pitch from E, A; C: pitch point"
NEAR_LETTERS = 0.03
"""Part of the axis below which two letters stand to either side of their lines."""
PAIR_COLOURS = "#0072b2", "#d55e00", "#56b4e9", "#cc79a7", "#e69f00", "#009e73"
"""Of tooth pairs 0, +1, ...: told apart by colour-blind readers (Okabe and Ito)."""
MOST_PANELS = 4
"""Torques with a panel each."""
MOST_ORDERS, LEAST_POSITIONS = 8, 4
"""Orders of the tooth mesh that are drawn; positions from which the first is known."""
SMALLEST_AMPLITUDE_UM = 1e-4
ROUNDS, FINENESS = 3, 33
"""Rounds in which the ends of the path of contact are found, and angles of each: to 3e-5 of the span."""


def plot_load_share(result: MeshCycle, torque: int | None = None) -> Figure:
    """Share of each tooth pair in the torque over the positions, a panel for each torque, and how many carry load.

    Parameters
    ----------
    result : MeshCycle
    torque : int, optional
        Index of the only torque to show; default: all, of many torques four from the least to the largest.

    Returns
    -------
    matplotlib.figure.Figure
    """
    order = np.argsort(result.torque, kind="stable")
    spread = np.linspace(0.0, len(order) - 1.0, min(len(order), MOST_PANELS)).round().astype(int)
    shown = order[np.unique(spread)].tolist() if torque is None else [torque]
    figure = Figure(figsize=(8.0, 2.8 + (3.0 if len(shown) == 1 else 1.8 * len(shown))), layout="constrained")
    *panels, below = figure.subplots(len(shown) + 1, 1, sharex=True, height_ratios=(*(3.0,) * len(shown), 1.5))
    angle = np.degrees(result.pinion_angle)
    styles = {index: style for index, *style in torque_styles(result)}
    for k, (axes, index) in enumerate(zip(panels, shown, strict=True)):
        for number, share in zip(result.pair.tolist(), result.load_share[index].T, strict=True):
            marker = MARKERS[number % len(MARKERS)]
            colour, label = PAIR_COLOURS[number % len(PAIR_COLOURS)], f"tooth pair {signed(number)}"
            axes.plot(angle, 100.0 * share, color=colour, marker=marker, markersize=4.0, label=label)
        axes.set_ylabel("share of\nthe torque [%]")
        axes.set_ylim(-4.0, 106.0)
        axes.grid(alpha=0.3)
        torque_label, colour, _ = styles[index]
        told = torque_label if len(shown) > 1 else "_the only one"
        width = 1.5 * (len(shown) - k)  # curves on each other are seen, each beside the next
        below.step(angle, result.loaded_pairs[index], where="mid", color=colour, linewidth=width, label=told)
        if len(shown) > 1:
            axes.set_title(load(result, index).partition(" (")[0], fontsize="small")
    below.set_ylabel("pairs\nunder load")
    below.set_ylim(0.0, len(result.pair) + 0.5)
    below.set_yticks(range(len(result.pair) + 1))
    below.set_xlabel("pinion angle [deg]")
    below.grid(alpha=0.3)
    keys = [key for axes in (panels[0], below) for key in axes.get_legend_handles_labels()[0]]
    figure.legend(handles=keys, loc="outside lower center", ncols=4, fontsize="small")
    about = load(result, shown[0]) if len(shown) == 1 else loads(result)
    style.set_title(figure, result, f"load sharing, {about}", range_of_positions(result))
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
    figure, axes = style.one_panel()
    for torque, label, colour, marker in torque_styles(result):
        angle = np.degrees(result.pinion_angle)
        axes.plot(angle, result.mesh_stiffness[torque], color=colour, marker=marker, markersize=4.0, label=label)
        axes.plot(angle, result.secant_stiffness[torque], color=colour, marker=".", markersize=3.0, linestyle=":")
    axes.plot([], [], color="black", linestyle=":", label="secant, from no load")
    axes.set_ylabel("mesh stiffness [N/(mm µm)]")
    style.from_zero(axes)
    about = f"mesh stiffness, {result.bending}, {loads(result)}", range_of_positions(result)
    return style.finished(figure, axes, result, *about)


def plot_line_load(result: MeshCycle) -> Figure:
    """Largest line load of the tooth pair that carries most, over the positions, under each torque.

    Parameters
    ----------
    result : MeshCycle

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = style.one_panel()
    angle, line_load = np.degrees(result.pinion_angle), result.at_position("line_load")
    for torque, label, colour, marker in torque_styles(result):
        axes.plot(angle, line_load[torque], color=colour, marker=marker, markersize=4.0, label=label)
    axes.set_ylabel("line load of the most loaded pair [N/mm]")
    style.from_zero(axes)
    about = f"line load along the contact, {loads(result)}", range_of_positions(result)
    return style.finished(figure, axes, result, *about)


def plot_harmonics(result: MeshCycle) -> Figure:
    """Amplitudes of the orders of the tooth mesh in the loaded transmission error, under each torque.

    Parameters
    ----------
    result : MeshCycle

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = style.one_panel()
    amplitudes = 1e3 * result.wheel_base_radius * result.harmonics(MOST_ORDERS)
    orders, width = np.arange(1, MOST_ORDERS + 1), 0.8 / len(result.torque)
    for torque, label, colour, _ in torque_styles(result):
        place = orders + (torque - 0.5 * (len(result.torque) - 1)) * width
        axes.bar(place, amplitudes[torque], width, color=colour, label=label)
    known = orders[np.isfinite(amplitudes).any(axis=0)]
    if known.size:
        axes.set_xticks(known)
        axes.set_xlim(known[0] - 0.6, known[-1] + 0.6)
    else:
        axes.set(xticks=[], yticks=[])
        style.tell(axes, f"no order is known: the first needs {LEAST_POSITIONS} positions, all of them in contact")
    axes.set_xlabel("order of the tooth mesh")
    axes.set_ylabel("amplitude at the wheel's base circle [µm]")
    style.widen(axes, SMALLEST_AMPLITUDE_UM)
    axes.grid(visible=False, axis="x")
    about = f"harmonics of the transmission error, {loads(result)}", range_of_positions(result)
    return style.finished(figure, axes, result, *about)


def plot_line_load_distribution(result: MeshCycle, torque: int | None = None) -> Figure:
    """Line load along the contacts of all pairs and positions, each where it lies on both flanks.

    Every contact is drawn as the line through the middles of its pressure, coloured by the force per length along it.

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
    segments, values, highest = [np.zeros((0, 2, 3))], [np.zeros(0)], 0.0
    for one in loaded_maps(result, torque):
        sums = one.pressure.sum(axis=0)
        loaded = sums > 0.0
        across = one.x @ one.pressure[:, loaded] / sums[loaded]
        points = one.origin + across[:, None] * one.axes[0] + one.y[loaded, None] * one.axes[1]
        line_load = sums[loaded] * one.spacing[0]
        segments.append(np.stack([points[:-1], points[1:]], axis=1))
        values.append(0.5 * (line_load[:-1] + line_load[1:]))
        highest = max(highest, float(line_load.max()))
    scale = Normalize(0.0, highest or 1.0)

    def draw(axes: Axes, to_picture: Callable[[Array], Array]) -> list[Artist]:
        places = list(to_picture(np.concatenate(segments)))
        lines = LineCollection(places, cmap=COLOURS, norm=scale, linewidths=2.0, rasterized=True)
        lines.set_array(np.concatenate(values))
        axes.add_collection(lines, autolim=False)
        return [lines]

    figure, panels = both_flanks(result, draw)
    figure.colorbar(ScalarMappable(scale, COLOURS), ax=panels, label="line load [N/mm]")
    style.set_title(figure, result, f"line load along the contacts, {load(result, torque)}", range_of_positions(result))
    return figure


def plot_path_pressure(result: MeshCycle) -> Figure:
    """Pressure from the begin to the end of contact: every tooth pair at the angle of its own teeth, one curve.

    For a spur pair that is the pressure from A to E, single contact from B to D. Dotted lines mark where the unloaded
    contact point comes into the flanks and leaves them (A, E), a pitch before the end and after the begin (B, D: only
    one pair is in contact between them without load, if they lie in this order) and the pitch point (C). Where a
    contact lies at an edge, its peak is mesh-dependent: such positions have no pressure here, but a mark in a panel of
    their own, in the colour of their torque.

    Parameters
    ----------
    result : MeshCycle

    Returns
    -------
    matplotlib.figure.Figure
    """
    pair, pressure = result.gear_pair, result.mesh_independent_pressure
    angle = np.degrees(result.pinion_angle[:, None] - pair.pitch * result.pair)
    order = np.argsort(angle, axis=None, kind="stable")
    at_edge = np.isfinite(result.peak_pressure) & np.isnan(pressure)
    figure, axes = style.one_panel()
    below = _draw_edge_contacts(figure, axes, result, [angle[flags] for flags in at_edge]) if at_edge.any() else axes
    for torque, label, colour, marker in torque_styles(result):
        curve, ellipse = (values[torque].ravel()[order] for values in (pressure, result.hertz_pressure))
        known, places = np.isfinite(curve), angle.ravel()[order]
        axes.plot(places[known], curve[known], color=colour, marker=marker, markersize=4.0, label=label)
        axes.plot(places, ellipse, color=colour, **HERTZ)
    if np.isfinite(result.hertz_pressure).any():
        axes.plot([], [], color="black", label="after Hertz", **HERTZ)
    if at_edge.any():
        axes.plot([], [], "|", color="black", markeredgewidth=2.0, label=EDGE)
    below.set_xlabel(f"pinion angle from the pitch point of the tooth pair [deg]\n{WHAT_LETTERS_ARE}")
    axes.set_ylabel("contact pressure [MPa]")
    style.from_zero(axes)
    if not np.isfinite(pressure).any():
        axes.set_yticks([])
        style.tell(axes, "every contact lies at an edge or relief start: its pressure is mesh-dependent")
    elif not (pressure > 0.0).any():
        style.tell(axes, NO_LOAD)
    _mark_points(axes, pair, float(np.abs(np.radians(angle)).max()))
    about, columns = f"pressure over the path of contact, {loads(result)}", 2 if at_edge.any() else 3
    return style.finished(figure, axes, result, about, columns=columns)


def _draw_edge_contacts(figure: Figure, axes: Axes, result: MeshCycle, angles: list[Array]) -> Axes:
    """A low panel below the axes with the angles [deg] of contacts at an edge, a row for each torque; returns it."""
    grid = figure.add_gridspec(2, 1, height_ratios=(10.0, 1.0))
    axes.set_subplotspec(grid[0])
    below = figure.add_subplot(grid[1], sharex=axes)
    colours = [colour for _, _, colour, _ in torque_styles(result)]
    below.eventplot(angles, linelengths=0.8, linewidths=2.0, colors=colours)
    below.set_yticks([])
    below.set_ylabel("at an\nedge", rotation=0.0, ha="right", va="center", fontsize="small")
    axes.tick_params(labelbottom=False)
    axes.set_xlabel("")
    return below


def _mark_points(axes: Axes, pair: GearPair, reach: float) -> None:
    """Dotted lines at the points A to E of the path of contact that lie within the picture."""
    begin, end = (_leaves_flanks(pair, side * reach) for side in (-1.0, 1.0))
    marks = {"A": begin, "B": end - pair.pitch, "C": 0.0, "D": begin + pair.pitch, "E": end}
    if not marks["A"] < marks["B"] < marks["D"] < marks["E"]:  # a NaN, or never one pair alone
        marks = {name: marks[name] for name in "ACE"}
    places = {name: math.degrees(angle) for name, angle in marks.items() if math.isfinite(angle)}
    near = NEAR_LETTERS * float(np.ptp(axes.get_xlim()))
    for name, at in places.items():
        beside = [other for letter, other in places.items() if letter != name and abs(other - at) < near]
        side = "center" if not beside else "left" if at > max(beside) else "right"
        axes.axvline(at, color="0.5", linestyle=":", linewidth=1.0, zorder=0.0)
        axes.annotate(name, (at, 1.0), xycoords=("data", "axes fraction"), ha=side, va="bottom", color="0.4")


def _leaves_flanks(pair: GearPair, farthest: float) -> float:
    """Angle [rad] between zero and the farthest at which the unloaded contact point of a pair comes to an edge.

    NaN if it does not, or lies on one at zero already.
    """
    low, high = 0.0, farthest
    for _ in range(ROUNDS):
        angles = np.linspace(low, high, FINENESS)
        try:
            path = trace_contact(pair, angles, warn=False)
        except GeometryError:  # nothing is in contact on that side
            return math.nan
        outside = path.on_edge | ~path.in_contact
        if not outside.any() or outside[0]:
            return math.nan
        first = int(np.argmax(outside))
        low, high = angles[first - 1], angles[first]
    return high
