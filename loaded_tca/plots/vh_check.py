"""The V-H check: contact patterns over a grid of two mounting errors.

The ease-off topography on the flank, with its corner values and second-order coefficients.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError
from loaded_tca.flank_maps.conjugate import GearName
from loaded_tca.flank_maps.ease_off_map import EaseOffMap, SecondOrder
from loaded_tca.flank_maps.pattern import ContactPattern
from loaded_tca.flank_maps.vh_check import BEYOND, VHCheck
from loaded_tca.flanks.base import FlankFrame
from loaded_tca.plain import plain
from loaded_tca.plots.flanks import FINENESS, ToPicture, loaded_maps
from loaded_tca.plots.pressure_map import pressure_seen
from loaded_tca.plots.study_panels import told_of_variants
from loaded_tca.plots.style import ACCENT, COLOURS, NOT_REACHED, chosen_torque, label_of, load, write_title
from loaded_tca.results import MeshCycle, load_result
from loaded_tca.results.files import FilePath
from loaded_tca.results.loaded_pattern import loaded_pattern
from loaded_tca.results.support_growth import gears_under_torque
from loaded_tca.studies.ranking import varied_keys

if TYPE_CHECKING:
    import xarray

CELL = (2.0, 1.35)
"""Size of a cell [inch]."""
MARGIN = 1.6
"""Beside all cells, and above and below them [inch]."""
LEAST_WIDTH = 5.6
"""Of the picture, which the title of the legend fills [inch]: one column of cells is wider for this."""
LEGEND, NAME = 0.8, 0.25
"""Heights kept for the legend and the name of the axis above it [inch]: the layout would draw one over the other."""
LEVELS = 7
DOT: dict[str, Any] = {"marker": "o", "linestyle": "", "color": ACCENT, "markeredgecolor": "white", "markersize": 5.0}
EDGE = "edge contact within the pitch"


def plot_vh_check(check: VHCheck, names: tuple[str, str] = ("V [mm]", "H [mm]"), title: str = "") -> Figure:
    """Contact pattern over V (upwards) and H (to the right); in each cell the tip is on top, the heel (z > 0) right.

    Parameters
    ----------
    check : VHCheck
    names : (str, str)
        What the two errors are called, with their units.
    title : str
        Stands over the picture.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, panels = _grid_of_flanks(check.v, check.h, names)
    upwards, onwards = np.argsort(-check.v), np.argsort(check.h)
    first = check.patterns[0][0]
    levels = np.linspace(0.0, 1e3 * first.compound, LEVELS)
    for i, row in enumerate(upwards):
        for j, column in enumerate(onwards):
            cell = (int(row), int(column))
            drawn = _draw_cell(panels[i, j], check.patterns[row][column], check.frame, levels)
            panels[i, j].plot(*check.centre[cell], **DOT)
            _frame(panels[i, j], bool(check.edge_share[cell] > 0.0))
    figure.colorbar(drawn, ax=panels, label="smallest gap over the passage [µm]", format="%.3g")
    what = f"contact pattern on the {first.gear}, marking compound {plain(1e3 * first.compound)} µm, no load"
    _set_legend(figure, "centre of the pattern", bool((check.edge_share > 0.0).any()), check.frame)
    write_title(figure, title, what)
    return figure


def plot_loaded_vh_check(
    study: xarray.Dataset,
    results: FilePath | Mapping[int, MeshCycle],
    *,
    gear: GearName = "pinion",
    torque: int | None = None,
) -> Figure:
    """Loaded contact pattern over V and H: the highest pressure that each place of the flank sees over the positions.

    Laid out as by :func:`plot_vh_check`, all cells in one scale of colours.

    Parameters
    ----------
    study : xarray.Dataset
        Of :func:`loaded_tca.studies.read`, or any other study of two keys with numbers: to the right goes the
        first one, upwards the second one.
    results : path or mapping of int to MeshCycle
        Whole results by the numbers of the variants, or the directory in which ``run_study`` kept them.
    gear : {"pinion", "wheel"}
        Whose flank.
    torque : int, optional
        Index of the torque; default: the largest one.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the study does not vary two keys with numbers, no variant is ok, the result of one that is ok is missing, or
        there is no such torque.
    """
    keys = varied_keys(study)
    if len(keys) != 2 or any(study[key].dtype.kind not in "if" for key in keys):
        raise InputError(f"V-H check: the study varies {', '.join(keys)}; allowed two keys with numbers")
    status = study["status"].values.tolist()
    if "ok" not in status:
        raise InputError(f"V-H check: none of the {len(status)} variants is ok; the first: {study['reason'].values[0]}")
    kept = {
        k: results[k] if isinstance(results, Mapping) else load_result(Path(results, f"{k}.nc"))
        for k in range(len(status))
        if status[k] == "ok"
    }
    first = next(iter(kept.values()))
    torque = chosen_torque(first, torque)
    scale = Normalize(
        0.0, max(float(np.nanmax(one.peak_pressure[torque], initial=0.0)) for one in kept.values()) or 1.0
    )
    h, v = (np.unique(study[key].values) for key in keys)
    figure, panels = _grid_of_flanks(v, h, (f"V: {label_of(keys[1])}", f"H: {label_of(keys[0])}"))
    for k, (at_h, at_v) in enumerate(zip(*(study[key].values for key in keys), strict=True)):
        axes = panels[len(v) - 1 - np.searchsorted(v, at_v), np.searchsorted(h, at_h)]
        _frame(axes, k in kept and bool(kept[k].on_edge[torque].any()))
        if k in kept:
            _draw_loaded_cell(axes, kept[k], torque, gear, scale)
        else:
            axes.text(0.5, 0.5, status[k], transform=axes.transAxes, ha="center", va="center", color=ACCENT)
    beyond = any(one.pressure.max() > scale.vmax for result in kept.values() for one in loaded_maps(result, torque))
    figure.colorbar(
        ScalarMappable(scale, COLOURS),
        ax=panels,
        label="highest contact pressure [MPa]",
        extend="max" if beyond else "neither",
    )
    frame = (first.gear_pair.pinion if gear == "pinion" else first.gear_pair.wheel).flank.frame
    what = f"loaded contact pattern on the {gear}, {load(first, torque)}"
    _set_legend(figure, "centre of the force", any(one.on_edge[torque].any() for one in kept.values()), frame)
    write_title(figure, first.scene.title, what, told_of_variants(study))
    return figure


def _grid_of_flanks(v: Array, h: Array, names: tuple[str, str]) -> tuple[Figure, NDArray[np.object_]]:
    """A panel for each pair of errors, v upwards and h to the right, with their values and names at the edges."""
    size = max(MARGIN + CELL[0] * len(h), LEAST_WIDTH), LEGEND + MARGIN + CELL[1] * len(v)
    legend, below = LEGEND / size[1], (LEGEND + NAME) / size[1]
    figure = Figure(figsize=size, layout=ConstrainedLayoutEngine(rect=(0.0, below, 1.0, 1.0 - below)))
    panels = figure.subplots(len(v), len(h), squeeze=False, sharex=True, sharey=True)
    for axes, value in zip(panels[:, 0], np.sort(v)[::-1], strict=True):
        axes.set_ylabel(plain(value), rotation=0, ha="right", va="center")
    for axes, value in zip(panels[-1], np.sort(h), strict=True):
        axes.set_xlabel(plain(value))
    figure.supylabel(names[0])
    figure.supxlabel(names[1], y=legend)
    return figure, panels


def _frame(axes: Axes, on_edge: bool) -> None:
    axes.tick_params(labelsize="xx-small", length=2.0)
    for side in (axes.xaxis, axes.yaxis):
        side.set_major_locator(MaxNLocator(3))
    for spine in axes.spines.values():
        spine.set(color=ACCENT if on_edge else "0.6", linewidth=2.0 if on_edge else 0.8)


def _set_legend(figure: Figure, dot: str, on_edge: bool, frame: FlankFrame) -> None:
    """Below the panels what dots and thick frames are, and how the flanks lie."""
    thick = [Patch(fill=False, edgecolor=ACCENT, linewidth=2.0, label=EDGE)] if on_edge else []
    figure.legend(
        handles=[Line2D([], [], label=dot, **DOT), *thick],
        title=f"in each cell the tip is on top, {frame.heelwards} on the right; places in mm",
        loc="lower center",
        fontsize="small",
        title_fontsize="small",
    )


def _draw_loaded_cell(axes: Axes, result: MeshCycle, torque: int, gear: GearName, scale: Normalize) -> None:
    """The flank with the highest pressure that each of its places sees, and the centre of all forces."""
    pair = gears_under_torque(result, torque)[0].gear_pair
    flank, to_picture = (pair.pinion if gear == "pinion" else pair.wheel).flank, ToPicture(pair, gear)
    x, y = flank.frame.to_picture(*flank.grid(*FINENESS))
    (outline,) = axes.fill(*_around(x, y), color=NOT_REACHED, zorder=0)
    maps = loaded_maps(result, torque)
    if not maps:
        return
    borders, seen = pressure_seen(result, torque, to_picture, *np.transpose([(x.min(), x.max()), (y.min(), y.max())]))
    axes.pcolormesh(*borders, seen, cmap=COLOURS, norm=scale, rasterized=True).set_clip_path(outline)
    axes.plot(*loaded_pattern(result, torque, gear).centre, **DOT)


def _around(x: Array, y: Array) -> list[Array]:
    """Points around the edge of a grid."""
    return [np.concatenate([part[0], part[:, -1], part[-1, ::-1], part[::-1, 0]]) for part in (x, y)]


def _draw_cell(axes: Axes, pattern: ContactPattern, frame: FlankFrame, levels: Array) -> ContourSet:
    """The flank, with the gap as far as the compound marks it."""
    x, y = frame.to_picture(pattern.radius, pattern.axial)
    axes.fill(*_around(x, y), color=NOT_REACHED, zorder=0)
    gap = 1e3 * np.clip(pattern.gap, 0.0, BEYOND * pattern.compound)
    return axes.contourf(x, y, gap, levels, cmap=COLOURS)


EASE_OFF_LEVELS = 10
BESIDE_CORNERS = 0.1, 0.085
"""Parts of the axes that the value of a corner and half a label beside it take, across and upwards."""
SMALLEST_SPAN_um = 0.01
"""Height of the colour scale below which a map would be rounding."""


def plot_ease_off(ease_off: EaseOffMap, title: str = "") -> Figure:
    """Ease-off in um over the flank in its frame, the tip on top; hatched where the mating gear does not reach.

    Parameters
    ----------
    ease_off : EaseOffMap
    title : str
        Stands over the picture.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(11.0, 5.5), layout="constrained")
    axes, numbers = figure.subplots(1, 2, width_ratios=(2.6, 1.0))
    x, y = ease_off.frame.to_picture(ease_off.radius, ease_off.axial)
    height = 1e3 * ease_off.ease_off
    levels = MaxNLocator(EASE_OFF_LEVELS).tick_values(0.0, max(float(height.max()), SMALLEST_SPAN_um))
    filled = axes.contourf(x, y, height, levels, cmap=COLOURS)
    if height.max() > SMALLEST_SPAN_um:
        lines = axes.contour(x, y, height, levels[1:-1], colors="black", linewidths=0.5)
        for label in axes.clabel(lines, fmt="%.3g", fontsize="x-small"):
            label.set_path_effects([withStroke(linewidth=2.0, foreground="white")])
            label.set_visible(not _at_a_corner(axes, label.get_position(), (x, y)))
    if not ease_off.covered.all():
        axes.contourf(x, y, ease_off.covered, [-0.5, 0.5], colors="none", hatches=["///"])
    figure.colorbar(filled, ax=axes, label="ease-off, material removed along the normal [µm]", format="%.3g")
    _write_corners(axes, (x, y), 1e3 * ease_off.corners)
    axes.set_xlabel(ease_off.frame.labels[0])
    axes.set_ylabel(ease_off.frame.labels[1])
    _write_numbers(numbers, ease_off.second_order)
    write_title(figure, title, f"ease-off of the {ease_off.gear} against the conjugate of its mating flank")
    return figure


def _at_a_corner(axes: Axes, at: tuple[float, float], place: tuple[Array, Array]) -> bool:
    """Whether the value of a corner would hide what stands at a place."""
    shown = axes.transData - axes.transAxes
    corners = shown.transform(np.stack([part[np.ix_([0, -1], [0, -1])] for part in place], axis=-1).reshape(-1, 2))
    return bool((np.abs(corners - shown.transform(at)) < BESIDE_CORNERS).all(axis=1).any())


def _write_corners(axes: Axes, place: tuple[Array, Array], corners: Array) -> None:
    """The values in um beside the corners, inside."""
    x, y = place
    for i, j in np.ndindex(2, 2):
        at = float(x[-i, -j]), float(y[-i, -j])
        axes.annotate(
            f"{corners[i, j]:z.1f}",
            at,
            xytext=(-6.0 if j else 6.0, -6.0 if i else 6.0),
            textcoords="offset points",
            ha="right" if j else "left",
            va="top" if i else "bottom",
            color="black",
            fontweight="bold",
            bbox={"facecolor": "white", "edgecolor": ACCENT, "boxstyle": "round,pad=0.2"},
            zorder=10.0,
        )


def _write_numbers(axes: Axes, numbers: SecondOrder) -> None:
    """The second-order coefficients as a table."""
    axes.axis("off")
    cells = [[name.replace("um]", "µm]"), plain(round(value, 3), 3)] for name, value in numbers.named.items()]
    table = axes.table(cells, cellLoc="left", colWidths=[0.75, 0.25], edges="horizontal", loc="upper center")
    table.auto_set_font_size(False)
    table.set_fontsize(9.0)
    table.scale(1.0, 1.5)
    size = f"over {plain(numbers.size[0], 3)} mm of length\nand {plain(numbers.size[1], 3)} mm of profile"
    axes.set_title(f"second order, {size}", fontsize="small")
