"""The best variants of a study as a table."""

from __future__ import annotations

import textwrap
from collections import Counter
from typing import TYPE_CHECKING

from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from loaded_tca.plots import style
from loaded_tca.plots.labels import label_of, wrapped_label_of
from loaded_tca.plots.study_panels import NOTHING, set_study_title, without_unit
from loaded_tca.plots.style import NOT_REACHED
from loaded_tca.studies.ranking import figure_values, main_figures, rank_variants

if TYPE_CHECKING:
    import pandas
    import xarray

MOST_ROWS = 20
MOST_REASONS, LONGEST_REASON = 3, 240
LINE = 0.26
"""Height of a line of a table [inch]."""


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
        set_study_title(drawing, study, None, "no figures", *_why_unranked(ranking))
        return drawing
    values = figure_values(study, by or main_figures(study)[0])
    what = f"{len(cells)} best of {len(ranked)} variants" if len(cells) < len(ranked) else "variants"
    worst = "least" if largest_is_best else "largest"
    of = [f"of each figure the {worst} over the torques"] if torque is None and values.shape[1] > 1 else []
    order = "largest" if largest_is_best else "least"
    what = f"{what}, {order} {without_unit(label_of(by or main_figures(study)[0]))} first"
    set_study_title(drawing, study, values, what, *of, *_why_unranked(ranking))
    return drawing


def _why_unranked(ranking: pandas.DataFrame) -> list[str]:
    """How many variants have no rank, and the most frequent reasons; nothing if all have one."""
    status, reasons = (ranking.loc[ranking["rank"].isna(), name].tolist() for name in ("status", "reason"))
    if not status:
        return []
    told = [
        f"{word}: {reason}" if reason else "without this figure" for word, reason in zip(status, reasons, strict=True)
    ]
    counted = Counter(told).most_common()
    lines = [f"{textwrap.shorten(line, LONGEST_REASON)} ({count} of them)" for line, count in counted[:MOST_REASONS]]
    more = [f"and {len(counted) - MOST_REASONS} more reason{'s' * (len(counted) > MOST_REASONS + 1)}"] * (
        len(counted) > MOST_REASONS
    )
    return [f"without a rank: {len(status)} of {len(ranking)} variants", *lines, *more]


def _cell(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
