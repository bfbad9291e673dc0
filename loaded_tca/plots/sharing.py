"""Pictures of the shared load: load shares, stiffness, line load, and the pressure that flanks see over the cycle."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from loaded_tca.arrays import Array
from loaded_tca.errors import require
from loaded_tca.plain import plain, signed
from loaded_tca.plots import style
from loaded_tca.plots.flanks import ToPicture, both_flanks, draw_segments, loaded_maps
from loaded_tca.plots.style import (
    COLOURS,
    DISTINCT_COLOURS,
    HERTZ,
    MARKERS,
    NO_LOAD,
    chosen_torque,
    load,
    loads,
    range_of_positions,
    torque_label,
    torque_styles,
    torques_with_panels,
)
from loaded_tca.results.load_factors import face_forces
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.numbers import CycleNumbers
from loaded_tca.results.pressure_map import PressureMap
from loaded_tca.separation import slice_middles
from loaded_tca.unloaded.path import contact_span, path_letters, roll_lengths_of_flanks

WHAT_LETTERS_ARE = {
    "A": "end at the pinion's root",
    "E": "end at the pinion's tip",
    "B": "a pitch from E",
    "D": "a pitch from A",
    "C": "pitch point",
}
AT_EDGE: dict[str, Any] = {"marker": "o", "markersize": 8.0, "fillstyle": "none", "linestyle": ""}
OVER_THE_PATH = "pinion angle from the pitch point of the tooth pair"
NEAR_LETTERS = 0.03
"""Part of the axis below which two letters stand to either side of their lines."""
MOST_ORDERS, LEAST_POSITIONS = 8, 4
"""Orders of the tooth mesh that are drawn; positions from which the first is known."""
SMALLEST_AMPLITUDE_UM = 1e-4
MOST_SLICES, ABOVE_THEM = 0.99, 1.1
"""Part of the slices that all colours of a line load are for, and how far above these they go."""
CENTRE_DECIMALS = 3
"""Of the centre of the load in mm, which the grid does not tell more closely."""
PART_WITH_PHASE = 0.01
"""Part of the largest amplitude under a torque from which a phase is drawn: that of less may be rounding."""


def plot_load_share(result: MeshCycle, torque: int | None = None) -> Figure:
    """Share of each tooth pair in the torque over the positions, a panel for each torque; number of loaded pairs.

    Parameters
    ----------
    result : MeshCycle
    torque : int, optional
        Index of the only torque to show; default: all, of many torques four from the least to the largest.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the result has no such torque.
    """
    shown = torques_with_panels(result) if torque is None else [chosen_torque(result, torque)]
    figure = Figure(figsize=(8.0, 2.8 + (3.0 if len(shown) == 1 else 1.8 * len(shown))), layout="constrained")
    *panels, below = figure.subplots(len(shown) + 1, 1, sharex=True, height_ratios=(*(3.0,) * len(shown), 1.5))
    angle = np.degrees(result.pinion_angle)
    colours = {index: colour for index, _, colour, _ in torque_styles(result)}
    for k, (axes, index) in enumerate(zip(panels, shown, strict=True)):
        for number, share in zip(result.pair.tolist(), result.load_share[index].T, strict=True):
            marker = MARKERS[number % len(MARKERS)]
            colour, label = DISTINCT_COLOURS[number % len(DISTINCT_COLOURS)], f"tooth pair {signed(number)}"
            axes.plot(angle, 100.0 * share, color=colour, marker=marker, markersize=4.0, label=label)
        axes.set_ylabel("share of\nthe torque [%]")
        axes.set_ylim(-4.0, 106.0)
        axes.grid(alpha=0.3)
        name = torque_label(result, index) if len(shown) > 1 else "_the only one"
        width = 1.5 * (len(shown) - k)  # curves on each other are seen, each beside the next
        below.step(angle, result.loaded_pairs[index], where="mid", color=colours[index], linewidth=width, label=name)
        if len(shown) > 1:
            axes.set_title(torque_label(result, index), fontsize="small")
    below.set_ylabel("pairs\nunder load")
    below.set_ylim(0.0, len(result.pair) + 0.5)
    below.set_yticks(range(len(result.pair) + 1))
    below.set_xlabel("pinion angle [deg]")
    below.grid(alpha=0.3)
    keys = [key for axes in (panels[0], below) for key in axes.get_legend_handles_labels()[0]]
    figure.legend(handles=keys, loc="outside lower center", ncols=4, fontsize="small")
    about = load(result, shown[0]) if len(shown) == 1 else loads(result, len(shown))
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


def plot_face_load(result: MeshCycle) -> Figure:
    """Load over the face width: normal force of all tooth pairs per width, the mean over a pitch, under each torque.

    In the strips of the face whose highest load over the mean is the face load factor K_Hbeta; see
    :mod:`loaded_tca.results.load_factors`.

    Parameters
    ----------
    result : MeshCycle

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the result has one position, which has no mean over a pitch.
    """
    require(a_pitch_of(result))
    figure, axes = style.one_panel()
    draw_face_load(axes, result, torque_styles(result))
    about = f"load over the face width, {loads(result)}", "mean over a pitch", range_of_positions(result)
    return style.finished(figure, axes, result, *about, columns=2)


def a_pitch_of(*results: MeshCycle) -> tuple[bool, str]:
    """The check that results have the positions that a mean over a pitch takes."""
    long_enough = min(len(result.path) for result in results) > 1
    return long_enough, "face load: a mean over a pitch; found 1 position, allowed 2 or more"


def draw_face_load(axes: Axes, result: MeshCycle, styles: Iterable[tuple[int, str, str, str]]) -> None:
    """Draw the load over the face width under torques, given by index, label, colour and marker.

    With K_Hbeta, and how far the centre of the load is from the middle of the common face.
    """
    pair, frame = result.gear_pair, result.gear_pair.pinion.flank.frame
    for torque, label, colour, _ in styles:
        borders, forces = face_forces(pair, result.path, result.maps[torque])
        factor, text = result.face_load_factor[torque], label
        if not (np.isnan(factor) or label.startswith("_")):
            middles = 0.5 * (borders[1:] + borders[:-1])
            centre = float(forces @ middles / forces.sum()) - 0.5 * float(borders[0] + borders[-1])
            off = plain(round(centre, CENTRE_DECIMALS), 2, "+")
            text = f"{label}, K_Hβ = {plain(factor, 3)},\ncentre {off} mm from the middle"
        axes.stairs(forces / (len(result.path) - 1) / np.diff(borders), borders, color=colour, label=text)
    axes.set(xlabel=frame.labels[0], ylabel="normal force per face width [N/mm]")
    axes.set_ylim(bottom=0.0)


def plot_harmonics(result: MeshCycle) -> Figure:
    """Amplitudes and phases of the orders of the tooth mesh in the loaded transmission error, under each torque.

    The error is its mean plus the sum of amplitude cos(order z1 phi1 + phase), phi1 the pinion angle. A phase is drawn
    where the amplitude is at least a hundredth of the largest.

    Parameters
    ----------
    result : MeshCycle

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(8.0, 6.5), layout="constrained")
    axes, below = figure.subplots(2, 1, sharex=True, height_ratios=(3.0, 2.0))
    amplitudes = 1e3 * result.wheel_base_radius * result.harmonics(MOST_ORDERS)
    phases = np.degrees(result.harmonic_phases(MOST_ORDERS))
    styles = list(torque_styles(result))
    places = draw_orders(axes, [(label, colour, amplitudes[torque]) for torque, label, colour, _ in styles])
    for torque, _, colour, marker in styles:
        with_phase = amplitudes[torque] >= PART_WITH_PHASE * np.fmax.reduce(amplitudes[torque])
        below.plot(places[torque][with_phase], phases[torque][with_phase], marker, color=colour)
    below.set(ylim=(-190.0, 190.0), yticks=range(-180, 181, 90), xlabel=axes.get_xlabel())
    below.set_ylabel(f"phase [deg], of amplitudes\nfrom {PART_WITH_PHASE:.0%} of the largest on")
    below.grid(alpha=0.3)
    axes.set_xlabel("")
    about = f"harmonics of the transmission error, {loads(result)}", range_of_positions(result)
    return style.finished(figure, axes, result, *about)


def draw_orders(axes: Axes, curves: Sequence[tuple[str, str, Array]]) -> Array:
    """Bars of the amplitudes [um] of the first orders, side by side for each label and colour.

    Returns the places (curves, orders) of the bars.
    """
    orders, width = np.arange(1, MOST_ORDERS + 1), 0.8 / len(curves)
    places = orders + (np.arange(len(curves))[:, None] - 0.5 * (len(curves) - 1)) * width
    for place, (label, colour, amplitudes) in zip(places, curves, strict=True):
        axes.bar(place, amplitudes, width, color=colour, label=label)
    known = orders[np.isfinite([amplitudes for _, _, amplitudes in curves]).any(axis=0)]
    if known.size:
        axes.set_xticks(known)
        axes.set_xlim(known[0] - 0.6, known[-1] + 0.6)
    else:
        axes.set(xticks=[], yticks=[])
        style.tell(
            axes,
            f"no order is known: the first needs {LEAST_POSITIONS} positions, all of them in contact, and tooth pairs "
            "that share the load",
        )
    resolved = f", of which the positions resolve {known[-1]}" if known.size and known[-1] < MOST_ORDERS else ""
    axes.set_xlabel(f"order of the tooth mesh{resolved}")
    axes.set_ylabel("amplitude at the wheel's base circle [µm]")
    style.widen(axes, SMALLEST_AMPLITUDE_UM)
    axes.grid(alpha=0.3, axis="y")
    return places


def plot_line_load_distribution(result: MeshCycle, torque: int | None = None) -> Figure:
    """Line load along the contacts of all pairs and positions, each where it lies on both flanks.

    Every contact is drawn as the line through the middles of its pressure, coloured by the force per length along it,
    on one scale for all torques. The scale ends a tenth above the line load of 99 of 100 slices under the torque that
    has the largest one; where slices lie above, the label of the bar has the largest line load.

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
        If the result has no such torque.
    """
    torque = chosen_torque(result, torque)
    parts, loads_of_parts = [np.zeros((0, 2, 3))], [np.zeros(0)]
    for one in loaded_maps(result, torque):
        loaded, across = slice_middles(one.x, one.pressure)
        points = one.origin + across[:, None] * one.axes[0] + one.y[loaded, None] * one.axes[1]
        line_load = _of_slices(one)
        parts.append(np.stack([points[:-1], points[1:]], axis=1))
        loads_of_parts.append(0.5 * (line_load[:-1] + line_load[1:]))
    values = np.concatenate(loads_of_parts)
    rising = np.argsort(values, kind="stable")  # the largest is seen where lines meet
    segments, values = np.concatenate(parts)[rising], values[rising]
    largest = float(np.nanmax(result.line_load, initial=0.0)) or 1.0
    highest = min(largest, _line_load_of_most(result))
    scale = Normalize(0.0, highest)

    def draw(axes: Axes, to_picture: ToPicture) -> list[Artist]:
        return [draw_segments(axes, to_picture(segments), values, scale)]

    figure, panels = both_flanks(result, draw)
    beyond = f"\nsingle slices up to {plain(largest)}; mesh-dependent at sharp ends"
    extend = "max" if highest < largest else "neither"
    bar = ScalarMappable(scale, COLOURS)
    figure.colorbar(bar, ax=panels, label=f"line load [N/mm]{beyond * (highest < largest)}", extend=extend)
    style.set_title(figure, result, f"line load along the contacts, {load(result, torque)}", range_of_positions(result))
    return figure


def _of_slices(one: PressureMap) -> Array:
    """Line load of the slices of a map that carry load [N/mm]."""
    return one.pressure[:, one.pressure.any(axis=0)].sum(axis=0) * one.spacing[0]


def _line_load_of_most(result: MeshCycle) -> float:
    """Where the colours of line loads end [N/mm]."""
    torque = int(np.argmax(np.nanmax(result.line_load, axis=(1, 2), initial=0.0)))
    slices = np.concatenate([np.zeros(1), *(_of_slices(one) for one in loaded_maps(result, torque))])
    return ABOVE_THEM * float(np.quantile(slices, MOST_SLICES)) or 1.0


def plot_path_pressure(result: MeshCycle) -> Figure:
    """Peak pressure from beginning to end of contact: every tooth pair at the angle of its own teeth, one curve.

    For a spur pair that is the pressure from A to E, single contact from B to D. Dotted lines mark where the unloaded
    contact point comes to an edge of the flanks towards the pinion's root and tip (A, E), a pitch from the other end
    (B, D: only one pair is in contact between them without load) and the pitch point (C). Of cylindrical
    gears a table has these points as lengths on the path of contact, roll angles and diameters of the pinion, beside
    those of ISO 21771.

    Parameters
    ----------
    result : MeshCycle

    Returns
    -------
    matplotlib.figure.Figure
    """
    pair, pressure = result.gear_pair, result.peak_pressure
    figure, axes = style.one_panel(6.0 if result.scene.path_points else 5.0)
    drawn, at_edges = False, False
    for torque, label, colour, marker in torque_styles(result):
        of_torque = pressure[torque], result.hertz_pressure[torque], result.on_edge[torque].astype(float)
        places, curve, hertz, on_edge = over_the_path(result, *of_torque)
        places, known = np.degrees(places), np.isfinite(curve)
        axes.plot(places[known], curve[known], color=colour, marker=marker, markersize=4.0, label=label)
        cut = known & (on_edge > 0.0)
        axes.plot(places[cut], curve[cut], color=colour, **AT_EDGE)
        at_edges |= bool(cut.any())
        stretches = style.over_a_stretch(hertz)
        axes.plot(places, stretches, color=colour, **HERTZ)
        drawn |= bool(np.isfinite(stretches).any())
    if drawn:
        axes.plot([], [], color="black", label="after Hertz, where it holds", **HERTZ)
    if at_edges:
        axes.plot([], [], color="black", label="contact reaches an edge; the pressure there is left out", **AT_EDGE)
    axes.set_ylabel("peak pressure [MPa]")
    style.from_zero(axes)
    if not (pressure > 0.0).any():
        style.tell(axes, NO_LOAD)
    ends = contact_span(pair)
    at_root, at_tip = (math.nan if one is None else float(one.pinion_angle) for one in ends)
    marked = {"C": 0.0, **path_letters(at_root, at_tip, pair.driving * pair.pitch)}
    _mark_points(axes, marked)
    letters = ", ".join(f"{letter}: {what}" for letter, what in WHAT_LETTERS_ARE.items() if letter in marked)
    axes.set_xlabel(f"{OVER_THE_PATH} [deg]")
    if result.scene.path_points:
        points = {"C": result.scene.path_points["C"], **roll_lengths_of_flanks(pair, *ends)}
        _draw_table(figure, axes, points, result.scene.path_points, pair.base_radii[0])
    what = f"pressure over the path of contact, {loads(result)}"
    return style.finished(figure, axes, result, what, f"unloaded contact point at {letters}")


def over_the_path(result: CycleNumbers, *numbers: Array) -> Iterator[Array]:
    """Ascending pinion angles from the pitch point of the own tooth pair (n,) [rad]; numbers (position, pair) there."""
    angle = result.pinion_angle[:, None] - result.gear_pair.pitch * result.pair
    order = np.argsort(angle, axis=None, kind="stable")
    return (values.ravel()[order] for values in (angle, *numbers))


def _mark_points(axes: Axes, points: Mapping[str, float]) -> None:
    """Dotted lines at points of the path of contact, each a pinion angle [rad]."""
    places = {name: math.degrees(angle) for name, angle in points.items()}
    near = NEAR_LETTERS * float(np.ptp(axes.get_xlim()))
    for name, at in places.items():
        beside = [other for letter, other in places.items() if letter != name and abs(other - at) < near]
        side = "center" if not beside else "left" if at > max(beside) else "right"
        axes.axvline(at, color="0.5", linestyle=":", linewidth=1.0, zorder=0.0)
        axes.annotate(name, (at, 1.0), xycoords=("data", "axes fraction"), ha=side, va="bottom", color="0.4")


def _draw_table(
    figure: Figure, axes: Axes, points: Mapping[str, float], nominal: Mapping[str, float], base_radius: float
) -> None:
    """A table below the axes: points of the path of contact, and in brackets those of ISO 21771, by roll lengths."""
    quantities: dict[str, Callable[[float], float]] = {
        "from T1 [mm]": lambda length: length,
        "roll angle [deg]": lambda length: math.degrees(length / base_radius),
        "diameter [mm]": lambda length: 2.0 * math.hypot(length, base_radius),
    }
    cells = [
        [
            f"{f'{of(points[name]):z.3f}' if name in points else '-'} ({of(length):z.3f})"
            for name, length in nominal.items()
        ]
        for of in quantities.values()
    ]
    grid = figure.add_gridspec(2, 1, height_ratios=(5.0, 1.0))
    axes.set_subplotspec(grid[0])
    below = figure.add_subplot(grid[1])
    below.set_axis_off()
    below.set_title("on the pinion: unloaded contact point of the flanks (ISO 21771)", fontsize="small")
    table = below.table(cells, rowLabels=list(quantities), colLabels=list(nominal), loc="center", cellLoc="center")
    table.auto_set_font_size(False)
    table.set_fontsize(8.0)
