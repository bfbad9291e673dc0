"""Two or more results in one picture: their curves over each other, their pressure maps on one scale."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import cycle
from typing import Any

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from loaded_tca.arrays import index_checks
from loaded_tca.errors import require
from loaded_tca.plots import style
from loaded_tca.plots.flanks import highest_of_maps
from loaded_tca.plots.pressure_map import PRESSURE, draw_map, scale_factor
from loaded_tca.plots.sharing import MOST_ORDERS, OVER_THE_PATH, draw_orders, over_the_path
from loaded_tca.plots.style import COLOURS, DISTINCT_COLOURS, MARKERS, NO_MATERIAL
from loaded_tca.results.comparison import Comparison, compare_results
from loaded_tca.results.key_figures import mean_over_a_pitch
from loaded_tca.results.mesh_cycle import MeshCycle

Results = Mapping[str, MeshCycle] | Sequence[MeshCycle] | Comparison
SMALLEST_SPAN_UM = 1e-3
"""Height of a transmission error axis below which a curve would be rounding."""
UNIT = np.array([-1.0, 1.0])
"""Borders [mm] of a map of nothing."""
MOST_IN_A_ROW = 2
"""Panels, whose letters can be read on a page of A4."""
BEYOND: dict[str, Any] = {
    "facecolor": "white",
    "edgecolor": NO_MATERIAL,
    "hatch": "///",
    "linewidth": 0.0,
    "zorder": -1.0,
    "label": "not in this map",
}
"""The ground of a panel that its map does not fill: what lies beyond the map was not computed."""
PANEL_INCHES = 5.5
"""Width of a pressure map beside others."""


def plot_comparison(results: Results, torque: float | None = None) -> Figure:
    """Curves of two or more results over each other, under one torque.

    Transmission error at the wheel's base circle, absolute and about its mean; its harmonics; mesh stiffness; peak
    pressure and load share of every tooth pair at the angle of its own teeth. Where means have different signs, as of
    drive and coast side, the absolute one is drawn in the direction of its mean. Angles are in degrees, of pinions with
    different numbers of teeth in pitches. A result without load sharing has no harmonics.

    Parameters
    ----------
    results : mapping of str to MeshCycle, sequence of MeshCycle, or Comparison
        As :func:`loaded_tca.results.compare_results` takes them; their names are in the legend.
    torque : float [N mm], optional
        One that all results have; default: the largest of these.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If there are fewer than two results, or they do not share the torque.
    """
    comparison = results if isinstance(results, Comparison) else compare_results(results)
    shared = comparison.index_of(torque)
    named = comparison.results
    unit, scales = abscissa_of(named)
    figure = Figure(figsize=(11.0, 12.5), layout="constrained")
    (absolute, about_mean), (harmonics, stiffness), (pressure, share) = figure.subplots(3, 2)
    bars = []
    directions = _directions(comparison, shared)
    for (name, result), k, (colour, marker, width), scale, direction in zip(
        named.items(), comparison.indices[shared], styles_of(len(named)), scales, directions, strict=True
    ):
        drawn = {"color": colour, "marker": marker, "linewidth": width, "markersize": 4.0}
        angle = scale * result.pinion_angle
        length = 1e3 * result.wheel_base_radius
        error = length * result.transmission_error[k]
        absolute.plot(angle, direction * error, label=label_of_result(name), **drawn)
        about_mean.plot(angle, error - mean_over_a_pitch(error), **drawn)
        stiffness.plot(angle, result.mesh_stiffness[k], **drawn)
        bars.append((name, colour, length * result.harmonics(MOST_ORDERS)[k]))
        places, *curves = over_the_path(result, result.peak_pressure[k], 100.0 * result.load_share[k])
        for axes, curve in zip((pressure, share), curves, strict=True):
            known = np.isfinite(curve)
            axes.plot(scale * places[known], curve[known], **drawn)
    draw_orders(harmonics, bars)
    harmonics.set_ylabel("amplitude [µm]")
    for axes, over, label in (
        (absolute, "pinion angle", f"{'size of the ' * (min(directions) < 0.0)}transmission error [µm]"),
        (about_mean, "pinion angle", "transmission error less its mean [µm]"),
        (stiffness, "pinion angle", "mesh stiffness [N/(mm µm)]"),
        (pressure, OVER_THE_PATH, "peak pressure [MPa]"),
        (share, OVER_THE_PATH, "share of the torque [%]"),
    ):
        axes.set(xlabel=f"{over} {unit}", ylabel=label)
        axes.grid(alpha=0.3)
    for axes in (absolute, about_mean):
        style.widen(axes, SMALLEST_SPAN_UM)
    style.from_zero(pressure)
    share.set_ylim(-4.0, 106.0)
    figure.legend(*absolute.get_legend_handles_labels(), loc="outside lower center", ncols=4, fontsize="small")
    style.write_title(
        figure, title_of(named), f"comparison, {under_torque(comparison, shared)}", "lengths at the wheel's base circle"
    )
    return figure


def _directions(comparison: Comparison, shared: int) -> list[float]:
    """Signs of the mean transmission errors of all results where they differ, else one for each."""
    at = zip(comparison.results.values(), comparison.indices[shared], strict=True)
    means = np.array([mean_over_a_pitch(result.transmission_error[k]) for result, k in at])
    differ = bool((means < 0.0).any() and (means > 0.0).any())
    return np.where((means < 0.0) & differ, -1.0, 1.0).tolist()


def plot_compared_maps(results: Results, torque: float | None = None, position: int | None = None) -> Figure:
    """Pressure maps of two or more results side by side, on one scale of colours and one of lengths.

    Where a panel is larger than its map, because another map is, it is hatched.

    Parameters
    ----------
    results : mapping of str to MeshCycle, sequence of MeshCycle, or Comparison
        As :func:`loaded_tca.results.compare_results` takes them.
    torque : float [N mm], optional
        One that all results have; default: the largest of these.
    position : int, optional
        Index of the position of the first result; of the others the one at the nearest part of a pitch is drawn.
        Default: the position of the peak pressure of each.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If there are fewer than two results, they do not share the torque, or the first has no such
        position.
    """
    comparison = results if isinstance(results, Comparison) else compare_results(results)
    shared = comparison.index_of(torque)
    named = comparison.results
    places = _places(comparison, shared, position)
    maps = [result.maps[k][n][column] for result, (k, n, column) in zip(named.values(), places, strict=True)]
    borders = [np.concatenate([one.borders[axis] for one in maps if one is not None] or [UNIT]) for axis in (1, 0)]
    limits = [(float(ends.min()), float(ends.max())) for ends in borders]
    scale, height = scale_factor(*(high - low for low, high in limits))
    columns = min(len(named), max(MOST_IN_A_ROW, math.ceil(math.sqrt(len(named)))))
    rows = math.ceil(len(named) / columns)
    size = PANEL_INCHES * columns, 1.0 + rows * (1.2 + 0.6 * height)  # labels and the bar take the rest of 7 inches
    figure = Figure(figsize=size, layout="constrained")
    panels = figure.subplots(rows, columns, squeeze=False).ravel().tolist()
    loaded = [one is not None and bool(one.pressure.any()) for one in maps]
    of_results = zip(named.values(), places, comparison.indices.T.tolist(), strict=True)
    highest = max(highest_of_maps(result, n, column, torques) for result, (_, n, column), torques in of_results)
    for axes, (name, result), (k, n, column), one in zip(panels, named.items(), places, maps, strict=False):
        if one is None:
            style.tell(axes, "no tooth pair is in contact here")
        else:
            draw_map(axes, result, k, (n, column), highest, scale)
        axes.set_xbound(*limits[0])  # keeps an axis that runs the other way
        axes.set_ybound(*limits[1])
        if one is not None and [(float(ends[0]), float(ends[-1])) for ends in one.borders[::-1]] != limits:
            axes.add_patch(Rectangle((0.0, 0.0), 1.0, 1.0, transform=axes.transAxes, **BEYOND))
        axes.set_title(f"{name}\n{style.position_label(result, n, column)}", fontsize="small", parse_math=False)
    for axes in panels[len(named) :]:
        axes.remove()
    panels = panels[: len(named)]
    if any(loaded):
        beyond = any(one is not None and one.pressure.max() > highest for one in maps)
        colours = ScalarMappable(Normalize(0.0, highest), COLOURS)
        figure.colorbar(colours, ax=panels, label=PRESSURE, extend="max" if beyond else "neither")
    drawn = (zip(*axes.get_legend_handles_labels(), strict=True) for axes in panels)
    keys = {label.partition(",")[0]: key for pairs in drawn for key, label in pairs}  # Hertz without its pressure
    figure.legend(keys.values(), keys.keys(), loc="outside lower center", ncols=3, fontsize="small")
    style.write_title(figure, title_of(named), f"contact pressure, {under_torque(comparison, shared)}")
    return figure


def _places(comparison: Comparison, shared: int, position: int | None) -> list[tuple[int, int, int]]:
    """Indices of torque, position and tooth pair of the map of each result."""
    named = zip(comparison.results.values(), comparison.indices[shared].tolist(), strict=True)
    if position is None:
        peaks = [(k, result.peak_contact(k)) for result, k in named]
        return [(k, *(peak or (0, 0))) for k, peak in peaks]
    require(*index_checks(position=(position, len(next(iter(comparison.results.values())).path))))
    parts = [result.pinion_angle / result.gear_pair.pitch for result in comparison.results.values()]
    nearest = [int(np.abs(part - parts[0][position]).argmin()) for part in parts]
    return [(k, n, int(result.peak_column[k, n])) for (result, k), n in zip(named, nearest, strict=True)]


def abscissa_of(named: Mapping[str, MeshCycle]) -> tuple[str, list[float]]:
    """Unit of an axis of pinion angles, and factors to it: degrees, of pinions with different teeth pitches."""
    alike = len({result.scene.pinion.teeth for result in named.values()}) == 1
    if alike:
        return "[deg]", [math.degrees(1.0)] * len(named)
    return "[pitches]", [1.0 / result.gear_pair.pitch for result in named.values()]


def label_of_result(name: str) -> str:
    """Name of a result for a legend: no TeX, and shown where it begins with an underscore."""
    return " " + name.replace("$", r"\$")


def styles_of(count: int) -> Iterator[tuple[str, str, float]]:
    """Colour, marker and line width of each result: curves on each other are seen, each beside the next."""
    return zip(cycle(DISTINCT_COLOURS), cycle(MARKERS), np.linspace(5.0, 1.5, count).tolist(), strict=False)


def title_of(named: Mapping[str, MeshCycle]) -> str:
    """The title of all scenes, or else the names."""
    titles = {result.scene.title for result in named.values()}
    return titles.pop() if len(titles) == 1 else " | ".join(named)


def under_torque(comparison: Comparison, shared: int) -> str:
    """What a title says of a shared torque, by its index."""
    first = next(iter(comparison.results.values()))
    return style.torque_label(first, int(comparison.indices[shared, 0]))
