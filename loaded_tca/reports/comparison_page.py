"""What the report of a comparison tells: what differs in the scenes, key figures side by side, pictures."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.plots import COMPARISON_PICTURES, comparison_figures
from loaded_tca.plots.comparison import title_of
from loaded_tca.plots.picture import captions_of
from loaded_tca.plots.style import label_of
from loaded_tca.reports.page import Table, parts_of, pictures_of
from loaded_tca.reports.result_page import explained
from loaded_tca.results.comparison import SIZES, signed_change, written_value
from loaded_tca.results.figure import in_percent
from loaded_tca.results.figures import declared
from loaded_tca.results.summary import shown, shown_torque

if TYPE_CHECKING:
    from loaded_tca.results.comparison import Comparison

MOST_RESULTS = 3
"""Beside the first in one table of a page."""
MOST_TORQUES = 3
"""Whose key figures a page has; of more, the least, that of the pictures and the largest."""
MARKED = {"edge_pressure_MPa": ", of any pair, mesh-dependent where sharp"}
"""What is to be known of figures that no error is known of."""
BEYOND, WITHIN = "●", "○"
"""Beside a difference that exceeds the errors of both results, or does not."""


def comparison_content(comparison: Comparison, torque: float | None = None) -> dict[str, Any]:
    """Return what the template of a comparison takes.

    Parameters
    ----------
    comparison : Comparison
    torque : float [N mm], optional
        Of the pictures; default: the largest that all results have.
    """
    results, at = comparison.results, comparison.index_of(torque)
    title = title_of(results)
    warned = [f"{name}: {sentence}" for name, result in results.items() for sentence in result.warnings or ()]
    torques = _torques(comparison, at)
    return {
        "title": title,
        "results": _results(comparison),
        "first": next(iter(results)),
        "torques": ", ".join(map(shown_torque, comparison.torque.tolist())),
        "left_out": [f"{name}: {', '.join(some)} N m" for name, some in comparison.left_out.items()],
        "differing": differing_table(comparison),
        "key_figures": [table for k in torques for table in key_figure_tables(comparison, k)],
        "findings": [sentence for k in torques for sentence in comparison.findings(float(comparison.torque[k]))],
        "all_torques": len(torques) == len(comparison.torque),
        "sizes": SIZES,
        "beyond": BEYOND,
        "within": WITHIN,
        "errors": _errors(comparison, at),
        "under": shown_torque(float(comparison.torque[at])),
        "unknown": [name for name, result in results.items() if result.warnings is None],
        "warnings": explained(warned),
        "pictures": pictures_of(comparison_figures(comparison, torque), captions_of(COMPARISON_PICTURES), title),
        "scene_toml": next(iter(results.values())).scene.to_toml(),
    }


def _results(comparison: Comparison) -> Table:
    """Title, date and version of each result."""
    rows = [
        (name, result.title or result.TITLE, _day(result.date), result.version or "-", result.scope)
        for name, result in comparison.results.items()
    ]
    return Table(tuple(rows), ("result", "title", "analysed", "loaded_tca", "scope"), of_words=True)


def _day(date: str) -> str:
    """Day of a date after ISO 8601, in one line; a dash where a file does not have it."""
    return date[:10].replace("-", "\N{NON-BREAKING HYPHEN}") or "-"


def _torques(comparison: Comparison, at: int) -> list[int]:
    """Indices of the torques with key figures, that of the pictures first."""
    count = len(comparison.torque)
    some = range(count) if count <= MOST_TORQUES else (0, count - 1)
    return [at, *(k for k in reversed(some) if k != at)]


def differing_table(comparison: Comparison) -> Table | None:
    """Keys of the scenes that differ, in words and as files have them, with the values of each result."""
    rows = [(label_of(key), key, *map(written_value, values)) for key, values in comparison.differing_keys.items()]
    return Table(tuple(rows), ("what differs", "key", *comparison.results), of_words=True) if rows else None


def _names(comparison: Comparison) -> list[str]:
    """Figures that comparisons have, of which a result knows one."""
    known = comparison.figures["value"].notnull().any(("torque", "result"))
    names = known["figure"].values[known.values].tolist()
    return [name for name in declared(lambda figure: figure.is_compared) if name in names]


def key_figure_tables(comparison: Comparison, k: int) -> Iterator[Table]:
    """Key figures under a torque: of the first result, then of each other one with its difference."""
    first, *others = comparison.results
    under = comparison.figures.isel(torque=k).assign(beyond=comparison.beyond_errors.isel(torque=k))
    caption = f"Under {shown_torque(float(comparison.torque[k]))}"
    for part in parts_of(others, MOST_RESULTS):
        some = others[part]
        rows = []
        for name in _names(comparison):
            row = under.sel(figure=name)
            if row["value"].isnull().all():
                continue
            cells = [shown(float(row["value"].sel(result=first)), name)]
            for other in some:
                value, change, relative, beyond = (
                    float(row[what].sel(result=other))
                    for what in ("value", "difference", "relative_difference", "beyond")
                )
                cells += [shown(value, name), _difference(change, relative, beyond, name)]
            rows.append((label_of(name) + MARKED.get(name, ""), *cells))
        heads = [cell for other in some for cell in (other, "difference")]
        yield Table(tuple(rows), ("", first, *heads), caption)


def _difference(change: float, relative: float, beyond: float, name: str) -> str:
    """A difference with its sign, its part of the first value, and its mark."""
    if math.isnan(change):
        return "-"
    part = f" ({100.0 * relative:+.1f} %)" if math.isfinite(relative) and change else ""
    mark = "" if math.isnan(beyond) else f" {BEYOND if beyond else WITHIN}"
    return signed_change(change, name) + part + mark


def _errors(comparison: Comparison, k: int) -> Table | None:
    """Errors that the results state of the figures under a torque."""
    errors = comparison.relative_errors.isel(torque=k)
    rows = []
    for name in _names(comparison):
        of_results: Sequence[float] = errors.sel(figure=name).values.tolist()
        if not np.isnan(of_results).all():
            rows.append((label_of(name).rpartition(" [")[0] or label_of(name), *map(in_percent, of_results)))
    return Table(tuple(rows), ("errors that the results state", *comparison.results)) if rows else None
