"""Pictures of a study: figures over the varied keys, their scatter, and the best variants.

Variants that were refused, did not converge or lack a figure are counted in the title and marked by crosses.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize, to_hex
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import MaxNLocator, PercentFormatter

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError
from loaded_tca.plots import style
from loaded_tca.plots.labels import label_of, wrapped_label_of
from loaded_tca.plots.style import ACCENT, COLOURS, MARKERS, MOST_LABELS, NOT_REACHED
from loaded_tca.scene.parse import toml_table
from loaded_tca.studies.ranking import figure_values, main_figures, nominal_variant, rank_variants, varied_keys

if TYPE_CHECKING:
    import xarray

TORQUE = "pinion_torque_Nm"
TRANSMISSION_ERROR = "transmission_error_span_um"
PERCENTILES = (0.05, 0.5, 0.95)
BAND = "5 to 95 %"
MISSING = "refused, not converged or without this figure"
NOTHING = "no variant has this figure"
MOST_PANELS = 4
"""Torques with a panel each."""
MOST_CELLS_WITH_NUMBERS = 150
MOST_PARAMETERS = 6
MOST_ROWS = 20
MOST_COLUMNS = 12
"""Bars of a histogram on the diagonal of a scatter matrix."""
SAME = 1e-6
"""Part of a value below which differences are rounding."""


def plot_study(
    study: xarray.Dataset,
    figures: Sequence[str] | None = None,
    rank_by: str | None = None,
    largest_is_best: bool = False,
) -> dict[str, Figure]:
    """Return the pictures that fit what a study varies, by the names of their files without the ending.

    Keys with given values: lines of each figure, with two or more keys heat maps. Distributions: histograms, the
    scatter over the torque if there are several, a scatter matrix. The ranking always.

    Parameters
    ----------
    study : xarray.Dataset
        What :func:`loaded_tca.studies.run_study` returns.
    figures : sequence of str, optional
        Key figures to show; default: peak-to-peak transmission error, peak pressure and face load factor.
    rank_by : str, optional
        Figure that ranks the variants; default: the first of the figures.
    largest_is_best : bool
        Whether its largest value is the best one.

    Returns
    -------
    dict of str to matplotlib.figure.Figure
        Empty if there are no figures, as where every variant was refused.

    Raises
    ------
    InputError
        If the study has no such figure.
    """
    figures = main_figures(study) if figures is None else list(figures)
    if not figures:
        return {}
    rank_by = rank_by or figures[0]
    stepped = [key for key in varied_keys(study) if _is_stepped(study, key)]
    scattered = [key for key in varied_keys(study) if key not in stepped]
    pictures = {}
    for name in figures:
        if stepped:
            pictures[f"study_lines_{name}"] = plot_study_lines(study, name, *stepped[:2])
        if len(stepped) > 1:
            best = largest_is_best and name == rank_by
            pictures[f"study_heat_map_{name}"] = plot_study_heat_map(study, name, *stepped[:2], largest_is_best=best)
        if scattered:
            pictures[f"study_histogram_{name}"] = plot_study_histogram(study, name, stepped)
    if scattered and TRANSMISSION_ERROR in figures and _has_common_torques(study):
        pictures["study_over_torque"] = plot_study_over_torque(study)
    if len(scattered) > 1 or len(stepped) > 2:
        pictures["study_scatter_matrix"] = plot_study_scatter_matrix(study, figures[:2])
    pictures["study_ranking"] = plot_study_ranking(study, rank_by, largest_is_best=largest_is_best)
    return pictures


def plot_study_lines(study: xarray.Dataset, figure: str, over: str | None = None, by: str | None = None) -> Figure:
    """Figure over a varied key, a line for each value of a second one.

    Each line is the median of the variants that differ in other keys only, with a band from their 5 to their 95 %.
    With a second key there is a panel for each torque, without it a line.

    Parameters
    ----------
    study : xarray.Dataset
    figure : str
        Name of a key figure.
    over : str, optional
        Key of the horizontal axis; default: the first one.
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
    over = _known_key(study, over or varied_keys(study)[0])
    places, words = _column(study, over)
    torques, labels = _shown_torques(study), _torque_labels(study)
    everywhere = np.ones(len(places), dtype=bool)
    if by is None:
        panels = [("", [(labels[t], values[:, t], everywhere) for t in range(values.shape[1])])]
    else:
        series = _groups(study, [by])
        panels = [(labels[t], [(label, values[:, t], of) for label, of in series]) for t in torques]
    drawing, axes = _panels(len(panels), (7.0, 4.5))
    banded = False
    for one, (title, lines) in zip(axes, panels, strict=True):
        styles = _styles([label for label, _, _ in lines])
        for (_, column, of), (label, colour, marker) in zip(lines, styles, strict=True):
            at = np.unique(places[of])
            spread = np.stack([_percentiles(column[of & (places == place)]) for place in at])
            one.plot(at, spread[:, 1], color=colour, marker=marker, markersize=4.0, label=label)
            if np.nanmax(np.append(spread[:, 2] - spread[:, 0], 0.0)) > 0.0:
                one.fill_between(at, spread[:, 0], spread[:, 2], color=colour, alpha=0.15, linewidth=0.0)
                banded = True
        columns = np.stack([column for _, column, _ in lines], axis=1)
        _mark_missing(one, np.unique(places[~np.isfinite(columns).all(axis=1)]))
        _finish_panel(one, columns, title if values.shape[1] > 1 else "")
        one.set(xlabel=label_of(over), ylabel=label_of(figure))
        if words is not None:
            one.set_xticks(range(len(words)), words)
    _legend(drawing, axes, label_of(by) if by else "")
    what = f"{_plain(label_of(figure))} over {_plain(label_of(over))}"
    band = [f"median and band ({BAND}) over the other keys"] if banded else []
    _set_title(drawing, study, values, f"{what}{_under(study, torques if by else range(values.shape[1]))}", *band)
    return drawing


def plot_study_heat_map(
    study: xarray.Dataset,
    figure: str,
    across: str | None = None,
    upwards: str | None = None,
    *,
    largest_is_best: bool = False,
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
    largest_is_best : bool
        Whether the largest value is the best one.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the study has no such figure, does not vary such a key, or varies one alone.
    """
    values, keys = figure_values(study, figure), varied_keys(study)
    if len(keys) < 2:
        raise InputError(f"heat map: needs two keys; the study varies {', '.join(keys)} alone")
    across = _known_key(study, across or next(key for key in keys if key != upwards))
    upwards = _known_key(study, upwards or next(key for key in keys if key != across))
    (columns, x), (rows, y) = (_steps(study, key) for key in (across, upwards))
    torques, labels = _shown_torques(study), _torque_labels(study)
    drawing, axes = _panels(len(torques), (1.8 + min(7.0, 0.75 * len(x) + 1.5), 1.2 + min(6.0, 0.55 * len(y) + 1.0)))
    crossed = False
    of_cell = [[(columns == j) & (rows == i) for j in range(len(x))] for i in range(len(y))]
    for one, torque in zip(axes, torques, strict=True):
        cells = np.array([[_percentiles(values[of, torque])[1] for of in line] for line in of_cell])
        _draw_cells(drawing, one, cells, label_of(figure), largest_is_best)
        asked = np.array([[of.any() for of in line] for line in of_cell])
        missing = asked & ~np.isfinite(cells)
        one.plot(*np.nonzero(missing)[::-1], "x", color=ACCENT, markersize=9.0)
        crossed |= bool(missing.any())
        for axis, ticks in ((one.xaxis, x), (one.yaxis, y)):
            every = math.ceil(len(ticks) / 20)
            axis.set_ticks(range(0, len(ticks), every), ticks[::every])
        one.set(xlabel=label_of(across), ylabel=label_of(upwards))
        one.set_title(labels[torque] if values.shape[1] > 1 else "", fontsize="small")
    best = Patch(fill=False, edgecolor=ACCENT, linewidth=2.5, label="largest" if largest_is_best else "least")
    handles = [best, Line2D([], [], color=ACCENT, marker="x", linestyle="", label=MISSING)][: 1 + crossed]
    drawing.legend(handles=handles, loc="outside lower center", ncols=2, fontsize="small")
    median = [] if max(int(of.sum()) for line in of_cell for of in line) < 2 else ["medians over the other keys"]
    _set_title(drawing, study, values, f"{_plain(label_of(figure))}{_under(study, torques)}", *median)
    return drawing


def plot_study_histogram(study: xarray.Dataset, figure: str, by: Sequence[str] = ()) -> Figure:
    """Scatter of a figure over the variants: histogram, cumulative curve and percentiles, a panel for each torque.

    Parameters
    ----------
    study : xarray.Dataset
    figure : str
        Name of a key figure.
    by : sequence of str
        Keys; each combination of their values has a cumulative curve of its own, and there are no bars.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the study has no such figure, or does not vary such a key.
    """
    values, groups = figure_values(study, figure), _groups(study, by)
    torques, labels = _shown_torques(study), _torque_labels(study)
    drawing, axes = _panels(len(torques), (6.5, 4.5))
    for one, torque in zip(axes, torques, strict=True):
        known = [column[np.isfinite(column)] for _, of in groups for column in [values[of, torque]]]
        cumulative = one if len(groups) > 1 else one.twinx()
        title = [labels[torque]] * (values.shape[1] > 1)
        if len(groups) == 1:
            _draw_bars(one, known[0])
            title.append(_draw_percentiles(one, known[0]))
        for column, (label, colour, _) in zip(known, _styles([label for label, _ in groups]), strict=True):
            if column.size:
                cumulative.ecdf(column, color=colour if len(groups) > 1 else "black", label=label)
        cumulative.set_ylim(0.0, 1.02)
        cumulative.yaxis.set_major_formatter(PercentFormatter(1.0))
        cumulative.set_ylabel("variants up to here")
        one.set_xlabel(label_of(figure))
        _finish_panel(one, values[:, [torque]], "\n".join(title), vertical=False)
    _legend(drawing, axes, ", ".join(map(label_of, by)))
    what = f"scatter of the {_plain(label_of(figure))}{_under(study, torques)}"
    _set_title(drawing, study, values, what)
    return drawing


def plot_study_over_torque(study: xarray.Dataset, figure: str = TRANSMISSION_ERROR) -> Figure:
    """Figure over the pinion torque: median and band (5 to 95 %) of the variants, and the nominal variant if there.

    Parameters
    ----------
    study : xarray.Dataset
    figure : str
        Name of a key figure; default: peak-to-peak transmission error.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the study has no such figure, or its figures have no torque.
    """
    values, torques = figure_values(study, figure), figure_values(study, TORQUE)
    at = np.unique(torques[np.isfinite(torques)])
    drawing, (axes,) = _panels(1, (7.5, 5.0))
    if at.size:
        low, middle, high = np.stack([_percentiles(values[torques == torque]) for torque in at], axis=1)
        axes.fill_between(at, low, high, color=to_hex(colormaps[COLOURS](0.3)), alpha=0.25, label=BAND)
        axes.vlines(at, low, high, color="0.6", linewidth=1.0)
        axes.plot(at, middle, "o-", color=to_hex(colormaps[COLOURS](0.3)), label="median")
    nominal = nominal_variant(study)
    if nominal is not None:
        axes.plot(torques[nominal], values[nominal], "s--", color="black", label="nominal")
    axes.set(xlabel=label_of(TORQUE), ylabel=label_of(figure))
    _finish_panel(axes, values, "")
    _legend(drawing, [axes], "")
    _set_title(drawing, study, values, f"{_plain(label_of(figure))} over the torque")
    return drawing


def plot_study_scatter_matrix(
    study: xarray.Dataset, figures: Sequence[str] | None = None, colour: str | None = None, torque: int | None = None
) -> Figure:
    """Varied keys and figures against each other, a point for each variant, coloured by a figure.

    Of many keys those with the strongest rank correlation with the figure of the colour are shown.

    Parameters
    ----------
    study : xarray.Dataset
    figures : sequence of str, optional
        Figures beside the keys; default: the first two of the main ones.
    colour : str, optional
        Figure of the colours; default: the first of them.
    torque : int, optional
        Index of the torque; default: the last one.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the study has no such figure, or none at all.
    """
    figures = main_figures(study)[:2] if figures is None else list(figures)
    if not figures:
        raise InputError("figures: none to show")
    torque = study.sizes["torque"] - 1 if torque is None else torque
    shades = figure_values(study, colour or figures[0])[:, torque]
    keys = _strongest(study, shades)
    data = [_column(study, key)[0] for key in keys] + [figure_values(study, name)[:, torque] for name in figures]
    names = [*keys, *figures]
    count = len(names)
    drawing = Figure(figsize=(1.5 + 1.9 * count, 1.3 + 1.7 * count), layout="constrained")
    panels: list[list[Axes]] = drawing.subplots(count, count, squeeze=False, sharex="col").tolist()
    known = np.isfinite(shades)
    span = (float(shades[known].min()), float(shades[known].max())) if known.any() else (0.0, 1.0)
    scale = Normalize(*span)
    for i, j in np.ndindex(count, count):
        axes = panels[i][j]
        if j > i:
            axes.set_visible(False)
        elif i == j:
            _draw_bars(axes, data[i][np.isfinite(data[i])], MOST_COLUMNS)
            axes.set_ylabel("")
        else:
            axes.scatter(data[j][known], data[i][known], c=shades[known], cmap=COLOURS, norm=scale, s=12.0)
            axes.plot(data[j][~known], data[i][~known], "x", color=ACCENT, markersize=5.0)
        axes.tick_params(labelsize="x-small", left=j < i, labelbottom=i == count - 1, labelleft=0 == j < i)
        axes.locator_params(nbins=4)
        if i == count - 1:
            axes.set_xlabel(wrapped_label_of(names[j]), fontsize="small")
        if j == 0 and i > 0:
            axes.set_ylabel(wrapped_label_of(names[i]), fontsize="small")
    label = label_of(colour or figures[0])
    drawing.colorbar(ScalarMappable(scale, COLOURS), ax=drawing.axes, label=label, shrink=0.6)
    if not known.all():
        drawing.legend(
            handles=[Line2D([], [], color=ACCENT, marker="x", linestyle="", label=MISSING)],
            loc="outside lower center",
            fontsize="small",
        )
    every = len(varied_keys(study))
    of = f"{len(keys)} of {every} varied keys" if len(keys) < every else "varied keys"
    under = f", {_torque_labels(study)[torque]}" if study.sizes["torque"] > 1 else ""
    _set_title(drawing, study, shades[:, None], f"{of} and figures{under}")
    return drawing


def plot_study_ranking(
    study: xarray.Dataset, by: str | None = None, *, torque: int | None = None, largest_is_best: bool = False
) -> Figure:
    """Table of the best variants of :func:`loaded_tca.studies.rank_variants`.

    Parameters
    ----------
    study : xarray.Dataset
    by, torque, largest_is_best
        As there.

    Returns
    -------
    matplotlib.figure.Figure
    """
    ranking = rank_variants(study, by, torque, largest_is_best)
    ranked = ranking[ranking["rank"].notna()]
    columns = [name for name in ranking.columns if name not in ("status", "reason")]
    cells = [[_cell(value) for value in row] for row in ranked[columns].head(MOST_ROWS).to_numpy().tolist()]
    drawing = Figure(figsize=(1.0 + 1.25 * len(columns), 2.3 + 0.26 * max(1, len(cells))), layout="constrained")
    axes = drawing.add_subplot()
    axes.set_axis_off()
    if cells:
        heads = [wrapped_label_of(name) for name in columns]
        table = axes.table(cells, colLabels=heads, loc="upper center", cellLoc="right")
        table.auto_set_font_size(False)
        table.set_fontsize(8.5)
        highest = 1 + max(head.count("\n") for head in heads)
        for column in range(len(columns)):
            table[0, column].set_height(highest * table[1, column].get_height())
            table[0, column].set_facecolor(NOT_REACHED)
    else:
        style.tell(axes, NOTHING)
    values = figure_values(study, by or main_figures(study)[0])
    what = f"{len(cells)} best of {len(ranked)} variants" if len(cells) < len(ranked) else "variants"
    worst = "least" if largest_is_best else "largest"
    of = [f"of each figure the {worst} over the torques"] if torque is None and values.shape[1] > 1 else []
    order = "largest" if largest_is_best else "least"
    what = f"{what}, {order} {_plain(label_of(by or main_figures(study)[0]))} first"
    _set_title(drawing, study, values, what, *of)
    return drawing


def _draw_cells(drawing: Figure, axes: Axes, cells: Array, label: str, largest_is_best: bool) -> None:
    """Heat map of values (rows, columns), NaN: none, with its scale; numbers in the cells where they are few."""
    known = np.isfinite(cells)
    axes.set_facecolor(NOT_REACHED)
    axes.set(xlim=(-0.5, cells.shape[1] - 0.5), ylim=(-0.5, cells.shape[0] - 0.5))
    if not known.any():
        style.tell(axes, NOTHING)
        return
    low, high = float(cells[known].min()), float(cells[known].max())
    scale = Normalize(low, high) if high - low > SAME * max(abs(low), abs(high)) else Normalize(low - 0.5, high + 0.5)
    borders = (np.arange(count + 1) - 0.5 for count in cells.shape[::-1])
    mesh = axes.pcolormesh(*borders, cells, cmap=COLOURS, norm=scale)
    drawing.colorbar(mesh, ax=axes, label=label)
    if cells.size <= MOST_CELLS_WITH_NUMBERS:
        for i, j in zip(*np.nonzero(known), strict=True):
            ink = "black" if scale(cells[i, j]) > 0.6 else "white"
            axes.text(j, i, f"{cells[i, j]:.4g}", ha="center", va="center", color=ink, fontsize="small")
    i, j = np.unravel_index((np.nanargmax if largest_is_best else np.nanargmin)(cells), cells.shape)
    axes.add_patch(Rectangle((j - 0.5, i - 0.5), 1, 1, fill=False, edgecolor=ACCENT, linewidth=2.5, clip_on=False))


def _draw_bars(axes: Axes, values: Array, most: int = 40) -> None:
    """Histogram of finite values."""
    if not values.size:
        return
    low, high = float(values.min()), float(values.max())
    least = SAME * max(abs(low), abs(high)) or 1.0
    room = 0.5 * max(0.0, least - (high - low))
    bins = min(most, max(5, math.ceil(math.sqrt(len(values)))))
    axes.hist(
        values, bins=bins, range=(low - room, high + room), color=to_hex(colormaps[COLOURS](0.6)), edgecolor="white"
    )
    axes.set_ylabel("variants")
    axes.yaxis.set_major_locator(MaxNLocator(4, integer=True))


def _draw_percentiles(axes: Axes, values: Array) -> str:
    """Lines at the percentiles of finite values; returns what they are."""
    if not values.size:
        return ""
    places = dict(zip(PERCENTILES, _percentiles(values).tolist(), strict=True))
    for part, at in places.items():
        axes.axvline(at, color=ACCENT, linestyle="-" if part == 0.5 else "--")
    return "lines: " + ", ".join(f"{100.0 * part:.0f} % at {at:.4g}" for part, at in places.items())


def _is_stepped(study: xarray.Dataset, key: str) -> bool:
    """Whether a key takes given values; of a table, whether each of them stands for two variants or more."""
    sampling = study[key].attrs.get("sampling", "table")
    few = 2 * len(np.unique(study[key].values)) <= study.sizes["sample"] or len(varied_keys(study)) == 1
    return sampling == "factor" or (sampling == "table" and few)


def _has_common_torques(study: xarray.Dataset) -> bool:
    """Whether there are several torques, each with more than one variant."""
    if TORQUE not in study:
        return False
    _, counts = np.unique(study[TORQUE].values[np.isfinite(study[TORQUE].values)], return_counts=True)
    return len(counts) > 1 and bool(counts.min() > 1)


def _known_key(study: xarray.Dataset, key: str) -> str:
    known = varied_keys(study)
    if key not in known:
        raise InputError(f"{key}: not varied in the study; allowed {', '.join(known)}")
    return key


def _column(study: xarray.Dataset, key: str) -> tuple[Array, list[str] | None]:
    """Values (samples,) of a key; of words their places in the order of the alphabet, and the words."""
    values = study[_known_key(study, key)].values
    if values.dtype.kind in "if":
        return values.astype(float), None
    words, places = np.unique(values, return_inverse=True)
    return places.astype(float), [str(word) for word in words]


def _steps(study: xarray.Dataset, key: str) -> tuple[Array, list[str]]:
    """Which of its values, in ascending order, a key has in each sample, and the values as text."""
    column, words = _column(study, key)
    steps, places = np.unique(column, return_inverse=True)
    return places, words or [f"{step:.5g}" for step in steps]


def _groups(study: xarray.Dataset, keys: Sequence[str]) -> list[tuple[str, Array]]:
    """Values of some keys as text, and the samples (n,) that have them, for each combination; all without a key."""
    places, texts = zip(*(_steps(study, key) for key in keys), strict=True) if keys else ((), ())
    if not keys:
        return [("", np.ones(study.sizes["sample"], dtype=bool))]
    combinations = np.unique(np.stack(places, axis=1), axis=0)
    return [
        (", ".join(text[k] for text, k in zip(texts, one, strict=True)), (np.stack(places, axis=1) == one).all(axis=1))
        for one in combinations.tolist()
    ]


def _strongest(study: xarray.Dataset, values: Array) -> list[str]:
    """Varied keys, of many those with the strongest rank correlation with values (samples,), in their order."""
    from scipy.stats import spearmanr

    keys, known = varied_keys(study), np.isfinite(values)
    if len(keys) <= MOST_PARAMETERS:
        return keys
    strength: dict[str, float] = {}
    for key in keys:
        column = _column(study, key)[0][known]
        varies = column.size > 2 and np.ptp(column) > 0.0 and np.ptp(values[known]) > 0.0
        strength[key] = abs(float(spearmanr(column, values[known]).statistic)) if varies else 0.0
    strongest = sorted(keys, key=lambda key: -strength[key])[:MOST_PARAMETERS]
    return [key for key in keys if key in strongest]


def _percentiles(values: Array) -> Array:
    """Percentiles (3,) of the finite values, NaN without one."""
    known = values[np.isfinite(values)]
    return np.quantile(known, PERCENTILES) if known.size else np.full(len(PERCENTILES), math.nan)


def _shown_torques(study: xarray.Dataset) -> list[int]:
    """Indices of all torques, of many some spread evenly from the first to the last."""
    count = study.sizes["torque"]
    return np.unique(np.linspace(0, count - 1, min(count, MOST_PANELS)).round().astype(int)).tolist()


def _torque_labels(study: xarray.Dataset) -> list[str]:
    """What is said of each torque; where it is not the same in all variants, which of several it is."""
    count = study.sizes["torque"]
    torques = figure_values(study, TORQUE) if TORQUE in study else np.full((1, count), np.nan)
    columns = (np.unique(column[np.isfinite(column)]) for column in torques.T)
    numbered = [f"torque {k + 1} of {count}" if count > 1 else "" for k in range(count)]
    return [
        f"pinion torque {one[0]:.4g} N m" if len(one) == 1 else number
        for one, number in zip(columns, numbered, strict=True)
    ]


def _under(study: xarray.Dataset, shown: Sequence[int]) -> str:
    """What a title says of the torques: the only one, or that some have no panel."""
    count = study.sizes["torque"]
    if count == 1:
        return "".join(f", {label}" for label in _torque_labels(study) if label)
    return f", {len(shown)} of {count} torques" if len(shown) < count else ""


def _styles(labels: Sequence[str]) -> Iterator[tuple[str, str, str]]:
    """Label, colour and marker of each line; of many only some keep their label."""
    every = math.ceil(len(labels) / MOST_LABELS)
    for k, label in enumerate(labels):
        shade = 0.15 + 0.7 * k / max(1, len(labels) - 1)
        shown = label if label and k % every == 0 else "_unlabelled"
        yield shown, to_hex(colormaps[COLOURS](shade)), MARKERS[k % len(MARKERS)]


def _panels(count: int, size: tuple[float, float]) -> tuple[Figure, list[Axes]]:
    """A figure with panels of a size [inch], two in a row."""
    rows, columns = math.ceil(count / 2), min(count, 2)
    drawing = Figure(figsize=(columns * size[0], 0.8 + rows * size[1]), layout="constrained")
    axes = drawing.subplots(rows, columns, squeeze=False).ravel().tolist()
    for spare in axes[count:]:
        spare.set_visible(False)
    return drawing, axes[:count]


def _finish_panel(axes: Axes, values: Array, title: str, vertical: bool = True) -> None:
    """Grid, title, and a word where nothing is known; a vertical axis that does not blow up rounding."""
    known = np.abs(values[np.isfinite(values)])
    axes.grid(alpha=0.3)
    axes.set_title(title, fontsize="small")
    if not known.size:
        style.tell(axes, NOTHING)
    elif vertical:
        style.widen(axes, SAME * float(known.max()))


def _mark_missing(axes: Axes, places: Array) -> None:
    """Crosses at the lower end of a panel where variants have no figure."""
    if places.size:
        heights = np.full(len(places), 0.03)
        axes.plot(places, heights, "x", color=ACCENT, transform=axes.get_xaxis_transform(), label=MISSING)


def _legend(drawing: Figure, panels: Sequence[Axes], title: str) -> None:
    """Legend below all panels; none where there is but one line."""
    shown = {label: handle for axes in panels for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)}
    if len(shown) > 1 or title or MISSING in shown:
        drawing.legend(
            shown.values(),
            shown.keys(),
            title=title or None,
            loc="outside lower center",
            ncols=4,
            fontsize="small",
            title_fontsize="small",
        )


def told_of_variants(study: xarray.Dataset, values: Array | None = None) -> str:
    """What became of the variants; with values (samples, n) of a figure, how many are ok but do not have it."""
    status = study["status"].values
    counts = [f"{count} {word}" for word, count in Counter(status.tolist()).most_common()]
    without = 0 if values is None else int(((status == "ok") & ~np.isfinite(values).any(axis=1)).sum())
    doubtful = sum(bool(lines) for lines in study["warnings"].values.tolist())
    more = {"without this figure": without, "with accuracy warnings": doubtful}
    return f"{len(status)} variants: " + ", ".join(
        counts + [f"{count} {told}" for told, count in more.items() if count]
    )


def _set_title(drawing: Figure, study: xarray.Dataset, values: Array, *about: str) -> None:
    """Title of the scene, what is shown, and what became of the variants."""
    title = toml_table(study.attrs.get("scene_toml", ""), "scene").get("title", "")
    style.write_title(drawing, title, *about, told_of_variants(study, values))


def _plain(label: str) -> str:
    """A label without its unit."""
    return label.partition(" [")[0]


def _cell(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
