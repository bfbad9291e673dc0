"""Scatter of figures over the variants of a study: histograms, bands over the torque, figures against keys."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize, to_hex
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator, PercentFormatter

from loaded_tca.arrays import Array, index_checks
from loaded_tca.errors import InputError, require
from loaded_tca.plain import plain
from loaded_tca.plots.study_panels import (
    MISSING,
    PERCENTILES,
    SAME,
    column_of,
    finish_panel,
    groups_of,
    is_whole,
    legend_of,
    panels_of,
    percentiles_of,
    set_study_title,
    set_ticks,
    shown_torques,
    styles_of,
    told_of_legend,
    torque_labels,
    under_torques,
    without_unit,
)
from loaded_tca.plots.style import ACCENT, COLOURS, MOST_LABELS, label_of, wrapped_label_of
from loaded_tca.scene import Scene
from loaded_tca.scene.rating import is_rated
from loaded_tca.studies.ranking import design_keys, figure_values, main_figures, nominal_variant, varied_keys
from loaded_tca.studies.rating import REQUIRED, required_safeties
from loaded_tca.studies.stage import subject_of, torque_name

if TYPE_CHECKING:
    import xarray

TRANSMISSION_ERROR = "transmission_error_span_um"
BAND = "5 to 95 %"
MOST_PARAMETERS = 6
FEWEST_BARS, MOST_BARS = 10, 40
MOST_COLUMNS = 20
"""Bars of a histogram on the diagonal of a scatter matrix."""


def plot_study_histogram(study: xarray.Dataset, figure: str, by: Sequence[str] = ()) -> Figure:
    """Scatter of a figure over the variants: histogram, cumulative curve and percentiles, a panel for each torque.

    A safety has a line at that required: the curve there is the probability of a shortfall.

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
    values, groups = figure_values(study, figure), groups_of(study, by)
    torques, labels = shown_torques(study), torque_labels(study)
    drawing, axes = panels_of(len(torques), (6.5, 4.5))
    for one, torque in zip(axes, torques, strict=True):
        known = [column[np.isfinite(column)] for _, of in groups for column in [values[of, torque]]]
        cumulative = one if len(groups) > 1 else one.twinx()
        title = [labels[torque]] * (values.shape[1] > 1)
        if len(groups) == 1:
            _draw_bars(one, known[0])
            title.append(_draw_percentiles(one, known[0]))
        for column, (label, colour, _) in zip(known, styles_of([label for label, _ in groups]), strict=True):
            if column.size:
                cumulative.ecdf(column, color=colour if len(groups) > 1 else "black", label=label)
        cumulative.set_ylim(0.0, 1.02)
        cumulative.yaxis.set_major_formatter(PercentFormatter(1.0))
        cumulative.set_ylabel("variants up to here")
        one.set_xlabel(label_of(figure))
        title += _draw_required(one, study, figure, values[:, torque])
        finish_panel(one, values[:, [torque]], "\n".join(title), vertical=False)
    legend_of(drawing, axes, ", ".join(map(label_of, by)))
    what = f"scatter of the {without_unit(label_of(figure))}{under_torques(study, torques)}"
    set_study_title(drawing, study, values, what, *told_of_legend([label for label, _ in groups]))
    return drawing


def _draw_required(axes: Axes, study: xarray.Dataset, figure: str, values: Array) -> list[str]:
    """Line at the safety that is required, if it is not far from all; the words of it for the title."""
    scene = subject_of(study)
    if figure not in REQUIRED or not isinstance(scene, Scene) or not is_rated(scene):
        return []
    levels = np.unique(required_safeties(study, scene, figure))
    known = values[np.isfinite(values)]
    if levels.size > 1 or not known.size:
        return []
    level, low, high = float(levels[0]), float(known.min()), float(known.max())
    if 2.0 * low - high <= level <= 2.0 * high - low:
        axes.axvline(level, color=ACCENT, linestyle="--")
        return [f"required {plain(level)} (dashed)"]
    return [f"required {plain(level)}"]


def plot_study_over_torque(study: xarray.Dataset, figure: str = TRANSMISSION_ERROR) -> Figure:
    """Figure over the pinion torque: median and band (5 to 95 %) of each design, and the nominal variant if there.

    A design is a combination of the given values of a study with distributions. Without them there is one band, and of
    more than eight designs, too, over all of their samples, as the title says.

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
    values, torques = figure_values(study, figure), figure_values(study, torque_name(study))
    at = np.unique(torques[np.isfinite(torques)])
    drawing, (axes,) = panels_of(1, (7.5, 5.0))
    keys = design_keys(study)
    designs = len(groups_of(study, keys))
    if designs > MOST_LABELS:
        keys = []
    groups = groups_of(study, keys)
    for (_, of), (label, colour, marker) in zip(groups, styles_of([label for label, _ in groups]), strict=True):
        if at.size:
            bands = [percentiles_of(values[of][torques[of] == torque]) for torque in at]
            low, middle, high = np.stack(bands, axis=1)
            axes.fill_between(at, low, high, color=colour, alpha=0.2, label=BAND if not keys else "_unlabelled")
            axes.vlines(at, low, high, color=colour, alpha=0.5, linewidth=1.0)
            axes.plot(at, middle, f"{marker}-", color=colour, label=label if keys else "median")
    nominal = nominal_variant(study)
    if nominal is not None:
        axes.plot(torques[nominal], values[nominal], "s--", color="black", label="nominal")
    axes.set(xlabel=label_of(torque_name(study)), ylabel=label_of(figure))
    finish_panel(axes, values, "")
    legend_of(drawing, [axes], ", ".join(map(label_of, keys)))
    all_together = f"{designs} designs and their samples together" if designs > 1 else "all variants"
    told = f"of each design median and band ({BAND}) of its samples" if keys else f"median and band over {all_together}"
    set_study_title(drawing, study, values, f"{without_unit(label_of(figure))} over the torque", told)
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
        If the study has no such figure or torque, or no figure at all.
    """
    figures = main_figures(study)[:2] if figures is None else list(figures)
    if not figures:
        raise InputError("figures: none to show")
    require(*index_checks(torque=(torque, study.sizes["torque"])))
    torque = study.sizes["torque"] - 1 if torque is None else torque
    shades = figure_values(study, colour or figures[0])[:, torque]
    keys = _strongest(study, shades)
    data = [column_of(study, key)[0] for key in keys] + [figure_values(study, name)[:, torque] for name in figures]
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
            whole = i < len(keys) and is_whole(study, keys[i])
            _draw_bars(axes, data[i][np.isfinite(data[i])], MOST_COLUMNS, whole)
            axes.set_ylabel("")
        else:
            axes.scatter(data[j][known], data[i][known], c=shades[known], cmap=COLOURS, norm=scale, s=12.0)
            axes.plot(data[j][~known], data[i][~known], "x", color=ACCENT, markersize=5.0)
        for axis, of in [(axes.xaxis, j), (axes.yaxis, i)][: 1 + (j < i)]:
            if of < len(keys):
                set_ticks(axis, study, keys[of], 4)
            else:
                axis.set_major_locator(MaxNLocator(4))
        axes.tick_params(labelsize="x-small", left=j < i, labelbottom=i == count - 1, labelleft=0 == j < i)
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
    under = f", {torque_labels(study)[torque]}" if study.sizes["torque"] > 1 else ""
    set_study_title(drawing, study, shades[:, None], f"{of} and figures{under}")
    return drawing


def _draw_bars(axes: Axes, values: Array, most: int = MOST_BARS, whole: bool = False) -> None:
    """Histogram of finite values, its bars after Freedman and Diaconis; of few numbers in equal steps a bar each."""
    if not values.size:
        return
    low, high = float(values.min()), float(values.max())
    steps = np.diff(np.unique(values))
    is_even = 0 < steps.size < most and np.ptp(steps) <= SAME * (high - low)
    if is_even and steps.min() > SAME * max(abs(low), abs(high)):
        half = 0.5 * float(steps.mean())
        bins, low, high = steps.size + 1, low - half, high + half
    elif whole and high - low < most:
        bins, low, high = round(high - low) + 1, low - 0.5, high + 0.5
    else:
        least = SAME * max(abs(low), abs(high)) or 1.0
        room = 0.5 * max(0.0, least - (high - low))
        low, high = low - room, high + room
        width = max(2.0 * float(np.subtract(*np.quantile(values, (0.75, 0.25)))) / np.cbrt(len(values)), least)
        bins = min(most, max(FEWEST_BARS, math.ceil((high - low) / width)))
    axes.hist(values, bins=bins, range=(low, high), color=to_hex(colormaps[COLOURS](0.6)), edgecolor="white")
    axes.set_ylabel("variants")
    axes.yaxis.set_major_locator(MaxNLocator(4, integer=True))


def _draw_percentiles(axes: Axes, values: Array) -> str:
    """Lines at the percentiles of finite values; returns what they are."""
    if not values.size:
        return ""
    places = dict(zip(PERCENTILES, percentiles_of(values).tolist(), strict=True))
    for part, at in places.items():
        axes.axvline(at, color=ACCENT, linestyle="-" if part == 0.5 else "--")
    return "lines: " + ", ".join(f"{100.0 * part:z.0f} % at {plain(at)}" for part, at in places.items())


def _strongest(study: xarray.Dataset, values: Array) -> list[str]:
    """Varied keys, of many those with the strongest rank correlation with values (samples,), in their order."""
    from scipy.stats import spearmanr

    keys, known = varied_keys(study), np.isfinite(values)
    if len(keys) <= MOST_PARAMETERS:
        return keys
    strength: dict[str, float] = {}
    for key in keys:
        column = column_of(study, key)[0][known]
        varies = column.size > 2 and np.ptp(column) > 0.0 and np.ptp(values[known]) > 0.0
        strength[key] = abs(float(spearmanr(column, values[known]).statistic)) if varies else 0.0
    strongest = sorted(keys, key=lambda key: -strength[key])[:MOST_PARAMETERS]
    return [key for key in keys if key in strongest]
