"""Pictures of a study: which ones fit it, and figures over the varied keys.

Variants that were refused, did not converge or lack a figure are counted in the title and marked by crosses.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from loaded_tca.arrays import Array, Indices
from loaded_tca.errors import InputError, require
from loaded_tca.plain import plain
from loaded_tca.plots import style
from loaded_tca.plots.study_panels import (
    MISSING,
    NOTHING,
    SAME,
    SAMPLE,
    column_of,
    finish_panel,
    groups_of,
    key_label,
    known_key,
    legend_of,
    mark_missing,
    panels_of,
    percentiles_of,
    plot_study_ranking,
    set_study_title,
    set_ticks,
    shown_torques,
    steps_of,
    styles_of,
    told_of_legend,
    torque_labels,
    under_torques,
    without_unit,
)
from loaded_tca.plots.study_scatter import (
    BAND,
    TRANSMISSION_ERROR,
    plot_study_histogram,
    plot_study_over_torque,
    plot_study_scatter_matrix,
)
from loaded_tca.plots.style import ACCENT, COLOURS, MOST_LABELS, NOT_REACHED, label_of
from loaded_tca.studies.ranking import figure_values, is_largest_best, main_figures, varied_keys
from loaded_tca.studies.stage import torque_name

if TYPE_CHECKING:
    import xarray

MOST_CELLS_WITH_NUMBERS = 150
FEWEST_OF_A_DISTRIBUTION = 20
"""Rows of a table from which its figures have a histogram."""


def plot_study(
    study: xarray.Dataset,
    figures: Sequence[str] | None = None,
    rank_by: str | None = None,
    largest_is_best: bool | None = None,
    axes: Sequence[str] | None = None,
) -> dict[str, Figure]:
    """Return the pictures that fit what a study varies, by the names of their files without the ending.

    Keys with given values: lines of each figure, with two or more keys heat maps. Distributions and long tables:
    histograms, the scatter over the torque if there are several, a scatter matrix. Tables of few rows: each figure over
    the number of the variant. The ranking always.

    Parameters
    ----------
    study : xarray.Dataset
        What :func:`loaded_tca.studies.run_study` returns.
    figures : sequence of str, optional
        Key figures to show; default: peak-to-peak transmission error, peak pressure and face load factor.
    rank_by : str, optional
        Figure that ranks the variants; default: the first of the figures.
    largest_is_best : bool, optional
        Whether its largest value is the best one; default: as in :func:`loaded_tca.studies.rank_variants`.
    axes : (str, str), optional
        Keys with given values: heat maps have the first to the right and the second upwards, lines run over the first,
        one for each value of the second; default: the first two of the study.

    Returns
    -------
    dict of str to matplotlib.figure.Figure
        The ranking alone if there are no figures, as where every variant was refused.

    Raises
    ------
    InputError
        If the study has no such figure, or no two such axes.
    """
    stepped = [key for key in varied_keys(study) if _is_stepped(study, key)]
    if axes is not None:
        require_axes(axes, stepped)
    if not main_figures(study):
        return {"study_ranking": plot_study_ranking(study)}
    figures = main_figures(study) if figures is None else list(figures)
    rank_by = rank_by or next(iter(figures), None)
    scattered = [key for key in varied_keys(study) if key not in stepped]
    if _is_short_table(study, scattered):
        stepped, scattered = stepped or [SAMPLE], []
    pictures, shown = {}, axes or stepped[:2]
    for name in figures:
        if stepped:
            pictures[f"study_lines_{name}"] = plot_study_lines(study, name, *shown)
        if len(stepped) > 1:
            best = largest_is_best if name == rank_by else None
            pictures[f"study_heat_map_{name}"] = plot_study_heat_map(study, name, *shown, largest_is_best=best)
        if scattered:
            pictures[f"study_histogram_{name}"] = plot_study_histogram(study, name, stepped)
    over_torque = TRANSMISSION_ERROR if "stage_toml" not in study.attrs else rank_by
    if scattered and over_torque in figures and _has_common_torques(study):
        pictures["study_over_torque"] = plot_study_over_torque(study, over_torque)
    if len(scattered) > 1 or len(stepped) > 2:
        pictures["study_scatter_matrix"] = plot_study_scatter_matrix(study, figures[:2])
    pictures["study_ranking"] = plot_study_ranking(study, rank_by, largest_is_best=largest_is_best)
    return pictures


def require_axes(axes: Sequence[str], allowed: Sequence[str]) -> None:
    """Refuse axes of pictures of a study that are not two of the keys with given values."""
    require(
        (len({*axes}) == len(axes) == 2, f"axes: found {', '.join(axes) or 'none'}; allowed two different keys"),
        *(
            (key in allowed, f"axes: {key}: not a key with given values in the study; it has {', '.join(allowed)}")
            for key in axes
        ),
    )


def plot_study_lines(study: xarray.Dataset, figure: str, over: str | None = None, by: str | None = None) -> Figure:
    """Figure over a varied key, a line for each value of a second one.

    Each line is the median of the variants that differ in other keys only, with a band from their 5 to their 95 %.
    With a second key there is a panel for each torque, without it a line; one for all torques where they have the same
    values, as safeties and lives under a load spectrum.

    Parameters
    ----------
    study : xarray.Dataset
    figure : str
        Name of a key figure.
    over : str, optional
        Key of the horizontal axis, or "sample": the number of the variant; default: the first key.
    by : str, optional
        Key whose values have a line each; default: none.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the study has no such figure, or does not vary such a key.
    """
    values = figure_values(study, figure)
    over = known_key(study, over or varied_keys(study)[0])
    places, _ = column_of(study, over)
    count = values.shape[1]
    alike = count > 1 and np.array_equal(values, np.repeat(values[:, :1], count, axis=1), equal_nan=True)
    torques, labels = ([0], ["all torques"]) if alike else (shown_torques(study), torque_labels(study))
    everywhere = np.ones(len(places), dtype=bool)
    if by is None:
        panels = [("", [(label, values[:, t], everywhere) for t, label in enumerate(labels)])]
    else:
        series = groups_of(study, [by])
        panels = [(labels[t], [(label, values[:, t], of) for label, of in series]) for t in torques]
    drawing, axes = panels_of(len(panels), (7.0, 4.5))
    banded, crossed = False, False
    for one, (title, lines) in zip(axes, panels, strict=True):
        styles = styles_of([label for label, _, _ in lines])
        for k, ((_, column, of), (label, colour, marker)) in enumerate(zip(lines, styles, strict=True)):
            at = np.unique(places[of])
            spread = np.stack([percentiles_of(column[of & (places == place)]) for place in at])
            drawn = bool(np.isfinite(spread).any())
            if drawn:
                line = "" if over == SAMPLE else "-"
                one.plot(at, spread[:, 1], color=colour, marker=marker, markersize=4.0, linestyle=line, label=label)
            missing = np.unique(places[of & ~np.isfinite(column)])
            height = 0.03 * (1 + k % MOST_LABELS)  # those of different lines do not hide each other
            mark_missing(one, missing, height, colour, "_unlabelled" if drawn else label)
            crossed |= bool(missing.size)
            if np.nanmax(np.append(spread[:, 2] - spread[:, 0], 0.0)) > 0.0:
                one.fill_between(at, spread[:, 0], spread[:, 2], color=colour, alpha=0.15, linewidth=0.0)
                banded = True
        columns = np.stack([column for _, column, _ in lines], axis=1)
        finish_panel(one, columns, title if count > 1 else "")
        one.set(xlabel=key_label(study, over), ylabel=label_of(figure))
        set_ticks(one.xaxis, study, over)
    if crossed:
        axes[0].plot([], [], "x", color="black", label=MISSING)
    legend_of(drawing, axes, key_label(study, by) if by else "")
    what = f"{without_unit(label_of(figure))} over {without_unit(label_of(over))}"
    named = told_of_legend([label for label, _, _ in panels[0][1]])
    band = [f"median and band ({BAND}) over the other keys"] if banded else []
    under = "" if alike else under_torques(study, torques if by else range(count))
    set_study_title(drawing, study, values, f"{what}{under}", *band, *named)
    return drawing


def plot_study_heat_map(
    study: xarray.Dataset,
    figure: str,
    across: str | None = None,
    upwards: str | None = None,
    *,
    largest_is_best: bool | None = None,
) -> Figure:
    """Figure over the grid of two varied keys, a panel for each torque, the best cell framed.

    A cell is the median of the variants that differ in other keys only. Crosses stand where no variant has the figure;
    cells without a variant are grey.

    Parameters
    ----------
    study : xarray.Dataset
    figure : str
        Name of a key figure.
    across, upwards : str, optional
        Keys of the axes; default: the first two.
    largest_is_best : bool, optional
        Whether the largest value is the best one; default: as in :func:`loaded_tca.studies.rank_variants`.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the study has no such figure, does not vary such a key, varies one alone, or both axes have the same.
    """
    values, keys = figure_values(study, figure), varied_keys(study)
    largest_first = is_largest_best(figure, largest_is_best)
    if len(keys) < 2:
        raise InputError(f"heat map: needs two keys; the study varies {', '.join(keys)} alone")
    across = known_key(study, across or next(key for key in keys if key != upwards))
    upwards = known_key(study, upwards or next(key for key in keys if key != across))
    require((across != upwards, f"across, upwards: found {across} twice; allowed two different keys"))
    (columns, x), (rows, y) = (steps_of(study, key) for key in (across, upwards))
    torques, labels = shown_torques(study), torque_labels(study)
    drawing, axes = panels_of(len(torques), (1.8 + min(7.0, 0.75 * len(x) + 1.5), 1.2 + min(6.0, 0.55 * len(y) + 1.0)))
    crossed = False
    of_cell = _samples_of_cells(rows, columns, (len(y), len(x)))
    for one, torque in zip(axes, torques, strict=True):
        cells = np.array([[percentiles_of(values[of, torque])[1] for of in line] for line in of_cell])
        _draw_cells(drawing, one, cells, label_of(figure), largest_first)
        asked = np.array([[of.size > 0 for of in line] for line in of_cell])
        missing = asked & ~np.isfinite(cells)
        one.plot(*np.nonzero(missing)[::-1], "x", color=ACCENT, markersize=9.0)
        crossed |= bool(missing.any())
        for axis, ticks in ((one.xaxis, x), (one.yaxis, y)):
            every = math.ceil(len(ticks) / 20)
            axis.set_ticks(range(0, len(ticks), every), ticks[::every])
        one.set(xlabel=key_label(study, across), ylabel=key_label(study, upwards))
        one.set_title(labels[torque] if values.shape[1] > 1 else "", fontsize="small")
    over_others = max(of.size for line in of_cell for of in line) > 1
    framed = ("largest" if largest_first else "least") + " median" * over_others
    best = Patch(fill=False, edgecolor=ACCENT, linewidth=2.5, label=framed)
    handles = [best, Line2D([], [], color=ACCENT, marker="x", linestyle="", label=MISSING)][: 1 + crossed]
    drawing.legend(handles=handles, loc="outside lower center", ncols=2, fontsize="small")
    median = ["medians over the other keys; the best variant may lie in another cell"] if over_others else []
    set_study_title(drawing, study, values, f"{without_unit(label_of(figure))}{under_torques(study, torques)}", *median)
    return drawing


def _samples_of_cells(rows: Indices, columns: Indices, shape: tuple[int, int]) -> list[list[Indices]]:
    """Numbers of the samples in each cell (rows, columns): each sample once, whatever the number of cells."""
    cells = rows * shape[1] + columns
    order = np.argsort(cells, kind="stable")
    ends = np.searchsorted(cells[order], np.arange(math.prod(shape) + 1))
    return [[order[ends[k] : ends[k + 1]] for k in range(i * shape[1], (i + 1) * shape[1])] for i in range(shape[0])]


def _draw_cells(drawing: Figure, axes: Axes, cells: Array, label: str, largest_is_best: bool) -> None:
    """Heat map of values (rows, columns), NaN: none, with its scale; numbers in the cells where they are few."""
    known = np.isfinite(cells)
    axes.set_facecolor(NOT_REACHED)
    axes.set(xlim=(-0.5, cells.shape[1] - 0.5), ylim=(-0.5, cells.shape[0] - 0.5))
    if not known.any():
        style.tell(axes, NOTHING)
        return
    low, high = float(cells[known].min()), float(cells[known].max())
    same = high - low <= SAME * max(abs(low), abs(high))
    scale = Normalize(low - 0.5, high + 0.5) if same else Normalize(low, high)
    borders = (np.arange(count + 1) - 0.5 for count in cells.shape[::-1])
    mesh = axes.pcolormesh(*borders, cells, cmap=COLOURS, norm=scale)
    bar = drawing.colorbar(mesh, ax=axes, label=label)
    if same:
        bar.set_ticks([low], labels=[plain(low)])
    if cells.size <= MOST_CELLS_WITH_NUMBERS:
        for i, j in zip(*np.nonzero(known), strict=True):
            ink = "black" if scale(cells[i, j]) > 0.6 else "white"
            axes.text(j, i, plain(cells[i, j]), ha="center", va="center", color=ink, fontsize="small")
    i, j = np.unravel_index((np.nanargmax if largest_is_best else np.nanargmin)(cells), cells.shape)
    axes.add_patch(Rectangle((j - 0.5, i - 0.5), 1, 1, fill=False, edgecolor=ACCENT, linewidth=2.5, clip_on=False))


def are_steps(values: Sequence[Any], variants: int) -> bool:
    """Whether the values of a column of a table are so few that each of them stands for two variants or more."""
    return 2 * len({*values}) <= variants


def _is_stepped(study: xarray.Dataset, key: str) -> bool:
    """Whether a key takes given values; of a table, whether each of them stands for two variants or more."""
    sampling = study[key].attrs.get("sampling", "table")
    few = are_steps(study[key].values.tolist(), study.sizes["sample"]) or len(varied_keys(study)) == 1
    return sampling == "factor" or (sampling == "table" and few)


def _is_short_table(study: xarray.Dataset, keys: Sequence[str]) -> bool:
    """Whether keys that are not stepped are those of a table of so few rows that it is no distribution."""
    ways = {study[key].attrs.get("sampling", "table") for key in keys}
    return ways == {"table"} and study.sizes["sample"] < FEWEST_OF_A_DISTRIBUTION


def _has_common_torques(study: xarray.Dataset) -> bool:
    """Whether there are several torques, each with more than one variant."""
    name = torque_name(study)
    if name not in study:
        return False
    torques = study[name].values
    _, counts = np.unique(torques[np.isfinite(torques)], return_counts=True)
    return len(counts) > 1 and bool(counts.min() > 1)
