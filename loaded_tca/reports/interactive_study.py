"""What the interactive page of a study shows: keys and figures of all variants for its script, with every digit."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.plots.study_panels import torque_labels
from loaded_tca.plots.style import label_of
from loaded_tca.reports.arrays import Block
from loaded_tca.reports.report import study_tables
from loaded_tca.studies.ranking import figure_values, is_largest_best, main_figures, rank_variants, varied_keys

if TYPE_CHECKING:
    import xarray


def study_page(study: xarray.Dataset, rank_by: str | None = None) -> dict[str, Any]:
    """Return what the template of the interactive page of a study takes.

    Parameters
    ----------
    study : xarray.Dataset
        What :func:`loaded_tca.studies.run_study` returns.
    rank_by : str, optional
        As for :func:`loaded_tca.studies.rank_variants`.
    """
    main = main_figures(study)
    by = rank_by if main else None
    ranks = rank_variants(study, by).sort_values("sample")["rank"]
    figures = [name for name, values in study.data_vars.items() if values.dims == ("sample", "torque")]
    shown = dict.fromkeys([*([by] if by else []), *main, *map(str, figures)])
    block = Block()
    names = [name for name in shown if np.isfinite(figure_values(study, name)).any()]
    data = {
        "kind": "study",
        "torques": torque_labels(study),
        "keys": [_key(study, key) for key in varied_keys(study)],
        "figures": [
            {"label": label_of(name), "values": block.add(figure_values(study, name), "float64")} for name in names
        ],
        "main": len(dict.fromkeys([*([by] if by else []), *main])),
        "largest_is_best": is_largest_best(names[0]) if names else False,
        "ranks": [None if rank is None else int(rank) for rank in ranks.astype(object).where(ranks.notna(), None)],
        **{name: study[name].values.tolist() for name in ("status", "reason", "warnings")},
    }
    count = {"variants_shown": study.sizes["sample"], "torques": study.sizes["torque"]}
    return {**study_tables(study, rank_by), **count, "data": data, "block": block.text()}


def _key(study: xarray.Dataset, key: str) -> dict[str, Any]:
    """A varied key: its label and values, of words their numbers in the list of all."""
    values = study[key].values
    if values.dtype.kind in "fiu":
        return {"label": label_of(key), "values": values.tolist(), "words": None}
    words, numbers = np.unique(values.astype(str), return_inverse=True)
    return {"label": label_of(key), "values": numbers.tolist(), "words": words.tolist()}
