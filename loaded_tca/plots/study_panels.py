"""What pictures of a study have in common: columns and groups of variants, panels, lines, titles.

The best variants of a study as a table.
"""

from __future__ import annotations

import math
import textwrap
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import Bbox

from loaded_tca.arrays import Array, Indices
from loaded_tca.errors import InputError
from loaded_tca.plain import plain, table_cell
from loaded_tca.plots import style
from loaded_tca.plots.style import ACCENT, COLOURS, MARKERS, MOST_LABELS, NOT_REACHED, label_of, wrapped_label_of
from loaded_tca.results.summary import shown_torque
from loaded_tca.scene.parse import parse_scene, toml_table
from loaded_tca.studies.ranking import (
    figure_values,
    is_largest_best,
    is_sampled,
    main_figures,
    quantile_of,
    rank_variants,
    ranking,
    varied_keys,
)
from loaded_tca.studies.stage import torque_name

if TYPE_CHECKING:
    import pandas
    import xarray

PERCENTILES = (0.05, 0.5, 0.95)
SAMPLE = "sample"
"""Number of a variant: stands for a key where no key orders the variants."""
MISSING = "refused, not converged or without this figure"
NOTHING = "no variant has this figure"
MOST_PANELS = 4
"""Torques with a panel each."""
SAME = 1e-6
"""Part of a value below which differences are rounding."""


def known_key(study: xarray.Dataset, key: str) -> str:
    """Return a key that the study varies, or ``SAMPLE``; InputError for any other."""
    known = varied_keys(study)
    if key == SAMPLE:
        return key
    if key not in known:
        raise InputError(f"{key}: not varied in the study; allowed {', '.join(known)}")
    return key


def column_of(study: xarray.Dataset, key: str) -> tuple[Array, list[str] | None]:
    """Values (samples,) of a key; of words their places in the order of the alphabet, and the words."""
    values = study[known_key(study, key)].values
    if values.dtype.kind in "if":
        return values.astype(float), None
    words, places = np.unique(values, return_inverse=True)
    return places.astype(float), [str(word) for word in words]


def steps_of(study: xarray.Dataset, key: str) -> tuple[Indices, list[str]]:
    """Which of its values, in ascending order, a key has in each sample, and the values as text."""
    column, words = column_of(study, key)
    steps, places = np.unique(column, return_inverse=True)
    return places, words or [plain(step, 5) for step in steps]


def groups_of(study: xarray.Dataset, keys: Sequence[str]) -> list[tuple[str, Array]]:
    """Values of some keys as text, and the samples (n,) that have them, for each combination; all without a key."""
    places, texts = zip(*(steps_of(study, key) for key in keys), strict=True) if keys else ((), ())
    if not keys:
        return [("", np.ones(study.sizes["sample"], dtype=bool))]
    combinations = np.unique(np.stack(places, axis=1), axis=0)
    return [
        (", ".join(text[k] for text, k in zip(texts, one, strict=True)), (np.stack(places, axis=1) == one).all(axis=1))
        for one in combinations.tolist()
    ]


def percentiles_of(values: Array) -> Array:
    """Percentiles (3,) of the finite values, NaN without one."""
    known = values[np.isfinite(values)]
    return np.quantile(known, PERCENTILES) if known.size else np.full(len(PERCENTILES), math.nan)


def shown_torques(study: xarray.Dataset) -> list[int]:
    """Indices of all torques, of many some spread evenly from the first to the last."""
    count = study.sizes["torque"]
    return np.unique(np.linspace(0, count - 1, min(count, MOST_PANELS)).round().astype(int)).tolist()


def torque_labels(study: xarray.Dataset) -> list[str]:
    """What is said of each torque; where it is not the same in all variants, which of several it is."""
    count = study.sizes["torque"]
    torques = figure_values(study, torque_name(study)) if torque_name(study) in study else np.full((1, count), np.nan)
    columns = (np.unique(column[np.isfinite(column)]) for column in torques.T)
    whose = torque_name(study).partition("_")[0]
    numbered = [f"torque {k + 1} of {count}" if count > 1 else "" for k in range(count)]
    return [
        f"{whose} torque {shown_torque(1e3 * one[0])}" if len(one) == 1 else number
        for one, number in zip(columns, numbered, strict=True)
    ]


def under_torques(study: xarray.Dataset, shown: Sequence[int]) -> str:
    """What a title says of the torques: the only one, or that some have no panel."""
    count = study.sizes["torque"]
    if count == 1:
        return "".join(f", {label}" for label in torque_labels(study) if label)
    return f", {len(shown)} of {count} torques" if len(shown) < count else ""


def styles_of(labels: Sequence[str]) -> Iterator[tuple[str, str, str]]:
    """Label, colour and marker of each line; of many only some keep their label."""
    every = math.ceil(len(labels) / MOST_LABELS)
    for k, label in enumerate(labels):
        shade = 0.15 + 0.7 * k / max(1, len(labels) - 1)
        shown = label if label and k % every == 0 else "_unlabelled"
        yield shown, to_hex(colormaps[COLOURS](shade)), MARKERS[k % len(MARKERS)]


def told_of_legend(labels: Sequence[str]) -> list[str]:
    """What a title says where the legend names only some of the lines."""
    named = math.ceil(len(labels) / math.ceil(len(labels) / MOST_LABELS))
    return [f"{len(labels)} curves, from dark to light; the legend names {named} of them"] * (named < len(labels))


def panels_of(count: int, size: tuple[float, float]) -> tuple[Figure, list[Axes]]:
    """A figure with panels of a size [inch], two in a row."""
    rows, columns = math.ceil(count / 2), min(count, 2)
    drawing = Figure(figsize=(columns * size[0], 0.8 + rows * size[1]), layout="constrained")
    axes = drawing.subplots(rows, columns, squeeze=False).ravel().tolist()
    for spare in axes[count:]:
        spare.set_visible(False)
    return drawing, axes[:count]


def finish_panel(axes: Axes, values: Array, title: str, vertical: bool = True) -> None:
    """Grid, title, and a word where nothing is known; a vertical axis that does not blow up rounding."""
    known = np.abs(values[np.isfinite(values)])
    axes.grid(alpha=0.3)
    axes.set_title(title, fontsize="small")
    if not known.size:
        style.tell(axes, NOTHING)
    elif vertical:
        style.widen(axes, SAME * float(known.max()))


def mark_missing(axes: Axes, places: Array, height: float = 0.03, colour: str = ACCENT, label: str = MISSING) -> None:
    """Crosses at a part of the height of a panel where variants have no figure."""
    if places.size:
        heights = np.full(len(places), height)
        axes.plot(places, heights, "x", color=colour, transform=axes.get_xaxis_transform(), label=label)


def key_label(study: xarray.Dataset, key: str) -> str:
    """What an axis calls a key; V and H come before the two errors of a V-H check."""
    if "stage_toml" in study.attrs:
        return label_of(key)
    errors = parse_scene(study.attrs["scene_toml"], folder=None).vh_keys
    letter = f"{'VH'[errors.index(key)]}: " if {*varied_keys(study)} == {*errors} else ""
    return letter + label_of(key)


def set_ticks(axis: Axis, study: xarray.Dataset, key: str, most: int = 9) -> None:
    """Ticks at the words of a key, at whole numbers where it is one."""
    _, words = column_of(study, key)
    if words is None:
        axis.set_major_locator(MaxNLocator(most, integer=is_whole(study, key), steps=[1, 2, 2.5, 5, 10]))
    else:
        axis.set_ticks(range(len(words)), words)


def is_whole(study: xarray.Dataset, key: str) -> bool:
    """Whether the values of a key are whole numbers, as those of places of words are."""
    return bool(study[key].dtype.kind != "f")


def legend_of(drawing: Figure, panels: Sequence[Axes], title: str) -> None:
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
    return f"{len(status)} variant{'s' * (len(status) != 1)}: " + ", ".join(
        counts + [f"{count} {what}" for what, count in more.items() if count]
    )


def set_study_title(drawing: Figure, study: xarray.Dataset, values: Array | None, *about: str) -> None:
    """Title of the scene, what is shown, and what became of the variants."""
    text = study.attrs.get("stage_toml", study.attrs.get("scene_toml", ""))
    title = toml_table(text, "scene").get("title", "")
    style.write_title(drawing, title, *about, told_of_variants(study, values))


def without_unit(label: str) -> str:
    """A label without its unit."""
    return label.partition(" [")[0]


MOST_ROWS = 20
MOST_REASONS, LONGEST_REASON = 3, 240
LINE = 0.26
"""Height of a line of a table [inch]."""


def plot_study_ranking(
    study: xarray.Dataset, by: str | None = None, *, torque: int | None = None, largest_is_best: bool | None = None
) -> Figure:
    """Table of the best variants of :func:`loaded_tca.studies.rank_variants`, with distributions of the best designs.

    Parameters
    ----------
    study : xarray.Dataset
    by, torque, largest_is_best
        As there.

    Returns
    -------
    matplotlib.figure.Figure
    """
    order_of = ranking(study, by, torque, largest_is_best)
    ranked = order_of[order_of["rank"].notna()]
    columns = [name for name in order_of.columns if name not in ("status", "reason", "note")]
    cells = [[table_cell(value) for value in row] for row in ranked[columns].head(MOST_ROWS).to_numpy().tolist()]
    heads = [wrapped_label_of(name) for name in columns]
    highest = max(head.count("\n") for head in heads) + 1
    width, height = 1.0 + 1.25 * len(columns), LINE * (highest + max(2, len(cells)))
    drawing = Figure(figsize=(width, height + 0.6), layout="constrained")
    axes = drawing.add_subplot()
    axes.set_axis_off()
    if cells:
        table = axes.table(cells, colLabels=heads, bbox=Bbox.unit(), cellLoc="right")
        table.auto_set_font_size(False)
        table.set_fontsize(8.5)
        for column in range(len(columns)):
            table[0, column].set_height(highest * table[1, column].get_height())
            table[0, column].set_facecolor(NOT_REACHED)
    else:
        style.tell(axes, NOTHING if main_figures(study) else "no variant has any figure")
    if not main_figures(study):
        set_study_title(drawing, study, None, "no figures", *_why_unranked(rank_variants(study)))
        return drawing
    values = figure_values(study, by or main_figures(study)[0])
    sampled = is_sampled(study)
    kind = "designs" if sampled else "variants"
    what = f"{len(cells)} best of {len(ranked)} {kind}" if len(cells) < len(ranked) else kind
    largest_first = is_largest_best(by or main_figures(study)[0], largest_is_best)
    lucky = 100.0 * quantile_of(by or main_figures(study)[0], largest_is_best)
    apart = largest_is_best is None and any(is_largest_best(name) != largest_first for name in columns if name in study)
    worst = "worst" if apart else "least" if largest_first else "largest"
    other = "least" if largest_first else "largest"
    but = f" ({100.0 - lucky:z.0f} % where the {other} value is best)" if apart else ""
    quantile = [f"of each figure the {lucky:z.0f} % quantile over the samples{but}"] if sampled else []
    quantile += sorted({*ranked["note"]} - {""}) if sampled else []
    of = [f"of each figure the {worst} over the torques"] if torque is None and values.shape[1] > 1 else []
    order = "largest" if largest_first else "least"
    what = f"{what}, {order} {without_unit(label_of(by or main_figures(study)[0]))} first"
    set_study_title(drawing, study, values, what, *of, *quantile, *_why_unranked(rank_variants(study, by, torque)))
    return drawing


def _why_unranked(variants: pandas.DataFrame) -> list[str]:
    """How many variants have no rank, and the most frequent reasons; nothing if all have one."""
    status, reasons = (variants.loc[variants["rank"].isna(), name].tolist() for name in ("status", "reason"))
    if not status:
        return []
    shown = [
        f"{word}: {reason}" if reason else "without this figure" for word, reason in zip(status, reasons, strict=True)
    ]
    counted = Counter(shown).most_common()
    lines = [f"{textwrap.shorten(line, LONGEST_REASON)} ({count} of them)" for line, count in counted[:MOST_REASONS]]
    more = [f"and {len(counted) - MOST_REASONS} more reason{'s' * (len(counted) > MOST_REASONS + 1)}"] * (
        len(counted) > MOST_REASONS
    )
    return [f"without a rank: {len(status)} of {len(variants)} variants", *lines, *more]
