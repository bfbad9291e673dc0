"""What the dataset of a study holds, and its variants in the order of a figure.

The figures of one analysis as studies take them, and a study in a few lines.

These say how many variants there are, what became of them, and how far the main figures scatter.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.analysis import analyse
from loaded_tca.arrays import Array, index_checks
from loaded_tca.double_helical import DoubleHelicalResult
from loaded_tca.errors import InputError, require
from loaded_tca.plain import plain
from loaded_tca.results import MeshCycle, Revolution
from loaded_tca.results.figure import labelled
from loaded_tca.results.figures import FIGURES, declared
from loaded_tca.results.result import Result
from loaded_tca.results.warnings import without_place
from loaded_tca.scene import Scene
from loaded_tca.scene.double_helical import DoubleHelicalScene
from loaded_tca.scene.keys import did_you_mean, nearest
from loaded_tca.stages import StageResult
from loaded_tca.studies.double_helical import halves_figures
from loaded_tca.studies.other_figures import tribology_figures
from loaded_tca.studies.rating import FIGURES as SAFETIES
from loaded_tca.studies.rating import MAIN_FIGURES as MAIN_SAFETIES
from loaded_tca.studies.rating import REQUIRED, UNDER_SPECTRUM, of_spectrum, rating_figures, shortfall_text
from loaded_tca.studies.stage import TORQUES, nominal_of, subject_of, torque_name
from loaded_tca.tribology import Tribology
from loaded_tca.units import ending_of, without_unit

if TYPE_CHECKING:
    import pandas
    import xarray

MAIN_FIGURES = (
    *sorted(declared(lambda figure: figure.rank), key=lambda name: FIGURES[name].rank or 0),
    *MAIN_SAFETIES,
)
"""Figures by which variants are compared unless others are asked for; the first one ranks them."""
KINDS: tuple[type[Result], ...] = MeshCycle, Revolution, StageResult, DoubleHelicalResult, Tribology
"""Of results whose figures studies take."""
LARGEST_IS_BEST = frozenset(
    (
        *SAFETIES,
        *(name for kind in KINDS for name, figure in kind.declared_figures().items() if figure.largest_is_best),
    )
)
"""Figures of which the largest is best; of all others the least."""
QUANTILE = 0.95
"""Of a figure over the samples of a combination."""
FEWEST_SAMPLES = 20
"""From which on the sample at the quantile is not the outermost one: ceil(0.95 n) < n. The weights of Maritz and
Jarrett lie on the samples about it; beyond the outermost one there are none, and the error comes out too small."""
TOO_FEW = f"no standard error: of fewer than {FEWEST_SAMPLES} samples the quantile rests on the outermost one"


def varied_keys(study: xarray.Dataset) -> list[str]:
    """Keys that a study varies, in the order of the study."""
    return [str(name) for name, values in study.coords.items() if values.dims == ("sample",) and name != "sample"]


def main_figures(study: xarray.Dataset) -> list[str]:
    """Figures of ``MAIN_FIGURES`` that a study has; if it has none, as with figures of its own, its first ones."""
    names = [str(name) for name, values in study.data_vars.items() if values.dims == ("sample", "torque")]
    figures_of = [name for name in MAIN_FIGURES if name in names and np.isfinite(figure_values(study, name)).any()]
    return figures_of or [name for name in names if name not in TORQUES][: len(MAIN_FIGURES)]


def figure_values(study: xarray.Dataset, name: str) -> Array:
    """Values (samples, torques) of a figure, NaN for variants that are not ok.

    Raises
    ------
    InputError
        If the study has no such figure.
    """
    names = [str(figure) for figure, values in study.data_vars.items() if values.dims == ("sample", "torque")]
    if name not in names:
        raise InputError(f"{name}: no figure of the study{_figures_instead(study, name, names)}")
    ok = (study["status"].values == "ok")[:, None]
    return np.where(ok, np.asarray(study[name].values, dtype=float), np.nan)


def _figures_instead(study: xarray.Dataset, name: str, names: list[str]) -> str:
    """What the study has where it has not the figure of that name; without any figure, why."""
    if names:
        return did_you_mean(nearest(name, names)) or f"; allowed {', '.join(names)}"
    return f"; {failure_of_all(study)}" if failure_of_all(study) else "; allowed nothing: there are none"


def failure_of_all(study: xarray.Dataset) -> str:
    """Sentence on a study of which no variant is ok: how many have which status, and the first reason; else empty."""
    status = Counter(study["status"].values.tolist())
    if "ok" in status:
        return ""
    counts = ", ".join(f"{count} {word}" for word, count in sorted(status.items()))
    reason = " ".join(study["reason"].values.tolist()[0].split())
    return f"no variant of {study.sizes['sample']} is ok ({counts}); the first: {reason}"


def nominal_variant(study: xarray.Dataset) -> int | None:
    """Number of the first variant in which every varied key has the value of the scene; None without one."""
    subject = subject_of(study)
    agrees = np.ones(study.sizes["sample"], dtype=bool)
    for key in varied_keys(study):
        nominal = nominal_of(subject, key)
        agrees &= np.array([value == nominal for value in study[key].values.tolist()], dtype=bool)
    return int(agrees.argmax()) if agrees.any() else None


def is_sampled(study: xarray.Dataset) -> bool:
    """Whether variants are samples of distributions."""
    return any(study[key].attrs.get("sampling") == "distribution" for key in varied_keys(study))


def design_keys(study: xarray.Dataset) -> list[str]:
    """Varied keys whose values make the designs of a study with distributions: those of factors and tables.

    None without a distribution, where each variant is a design, or where every key has one.
    """
    keys = varied_keys(study) if is_sampled(study) else []
    return [key for key in keys if study[key].attrs.get("sampling") != "distribution"]


def is_largest_best(figure: str, asked: bool | None = None) -> bool:
    """Whether the largest value of a figure is the best one: as ``asked``, or as the figure declares."""
    return figure in LARGEST_IS_BEST if asked is None else asked


def ranking(
    study: xarray.Dataset, by: str | None = None, torque: int | None = None, largest_is_best: bool | None = None
) -> pandas.DataFrame:
    """Designs of a study, the best first: :func:`rank_combinations` of one with distributions, else its variants."""
    rank = rank_combinations if is_sampled(study) else rank_variants
    return rank(study, by, torque, largest_is_best)


def rank_combinations(
    study: xarray.Dataset, by: str | None = None, torque: int | None = None, largest_is_best: bool | None = None
) -> pandas.DataFrame:
    """Combinations of the given values of a study with distributions, the best first.

    Single samples say little of a design: the best one of many is lucky. So is, by less, a design whose quantile lies
    within a few standard errors of the next one: more samples tell them apart.

    Parameters
    ----------
    study : xarray.Dataset
    by, torque, largest_is_best
        As for :func:`rank_variants`.

    Returns
    -------
    pandas.DataFrame
        One row per combination: ``rank`` from 1, ``samples`` (how many are ok), the keys of factors and table, and of
        each figure, its worst value over the torques, the 95 % quantile over the samples (the 5 % quantile where the
        largest is best), and ``warnings`` (of all samples). ``standard_error``, with the unit of the figure that ranks
        at its end (``standard_error_um``): how far other samples of that number would scatter the quantile of this
        figure (Maritz and Jarrett 1978); NaN for fewer than 20 samples, as ``note`` says then. A combination without
        the figure has no rank. Where every key has a distribution there is one row; without distributions none.

    Raises
    ------
    InputError
        If the study has no such figure.

    Examples
    --------
    >>> import xarray
    >>> words = {name: ("sample", [word] * 4) for name, word in {"status": "ok", "reason": "", "warnings": ""}.items()}
    >>> keys = {"pinion.teeth": ("sample", [20, 20, 25, 25], {"sampling": "factor"}),
    ...     "mounting.misalignment_um": ("sample", [0.0, 9.0, 0.0, 9.0], {"sampling": "distribution"})}
    >>> factor = {"face_load_factor": (("sample", "torque"), [[1.0], [2.0], [1.2], [1.4]])}
    >>> rank_combinations(xarray.Dataset({**factor, **words}, keys))["pinion.teeth"].tolist()
    [25, 20]
    """
    import pandas

    variants = rank_variants(study, by, torque, largest_is_best)
    keys = design_keys(study)
    figures = list(dict.fromkeys([*([by] if by else []), *main_figures(study)]))
    error = "_".join(filter(None, ("standard_error", ending_of(figures[0]) if figures else "")))
    columns_of = ["rank", "samples", *keys, *figures, error, "warnings", "note"]
    if not (is_sampled(study) and figures):
        return pandas.DataFrame(columns=columns_of)
    groups = variants.groupby(keys or np.zeros(len(variants)), sort=False)
    columns = [groups[name].quantile(quantile_of(name, largest_is_best)) for name in figures]
    ranked, largest_first = pandas.concat(columns, axis=1), is_largest_best(figures[0], largest_is_best)
    ranked.insert(0, "samples", groups["status"].agg(lambda status: int((status == "ok").sum())))
    ranked.insert(1, error, groups[figures[0]].agg(lambda values: _standard_error(values, largest_first)))
    ranked["warnings"] = groups["warnings"].sum()
    ranked["note"] = np.where(groups[figures[0]].count() < FEWEST_SAMPLES, TOO_FEW, "")
    ranked = ranked.reset_index(drop=not keys).sort_values(
        figures[0], kind="stable", ignore_index=True, ascending=not largest_first
    )
    ranked.insert(0, "rank", pandas.array(ranked.index + 1, dtype="Int64"))
    ranked.loc[ranked[figures[0]].isna(), "rank"] = pandas.NA
    return ranked[columns_of]


def quantile_of(figure: str, asked: bool | None = None) -> float:
    """Quantile over samples that stands for a figure: 5 % where the largest is best, as ``asked`` or of itself."""
    return 1.0 - QUANTILE if is_largest_best(figure, asked) else QUANTILE


def _standard_error(values: pandas.Series, largest_is_best: bool) -> float:
    """Standard error of the quantile of a figure over the samples that are ok (Maritz and Jarrett 1978)."""
    from scipy.stats import beta

    sorted_values = np.sort(values.dropna().to_numpy())
    if sorted_values.size < FEWEST_SAMPLES:
        return float("nan")
    if largest_is_best:
        sorted_values = -sorted_values[::-1]
    rank = np.ceil(QUANTILE * sorted_values.size)
    weights = np.diff(beta.cdf(np.linspace(0.0, 1.0, sorted_values.size + 1), rank, sorted_values.size - rank + 1.0))
    return float(np.sqrt(weights @ (sorted_values - weights @ sorted_values) ** 2))


def rank_variants(
    study: xarray.Dataset, by: str | None = None, torque: int | None = None, largest_is_best: bool | None = None
) -> pandas.DataFrame:
    """Variants of a study, the best first.

    Parameters
    ----------
    study : xarray.Dataset
        What :func:`loaded_tca.studies.run_study` returns.
    by : str, optional
        Figure that ranks them; default: the peak-to-peak transmission error, or the first one that the study has.
    torque : int, optional
        Index of the torque whose figures are compared. Default: of each figure the worst value over the torques, which
        is its largest, or its least where the largest is best.
    largest_is_best : bool, optional
        Whether the largest value is the best one, of all figures. Default: of safeties, lives, films, the efficiency,
        the least share of a planet, and of stress ratios and compressions, which are negative, at roots.

    Returns
    -------
    pandas.DataFrame
        One row per variant: ``rank`` from 1, ``sample`` (its number), ``status``, the varied keys, the figures,
        ``warnings`` (how many) and ``reason``. Variants without the figure have no rank and stand at the end.

    Raises
    ------
    InputError
        If the study has no such figure or torque.

    Examples
    --------
    >>> import xarray
    >>> status = {name: ("sample", values) for name, values in {
    ...     "status": ["ok", "refused", "ok"], "reason": ["", "too small", ""], "warnings": ["", "", ""]}.items()}
    >>> factor = {"face_load_factor": (("sample", "torque"), [[1.5], [np.nan], [1.25]])}
    >>> teeth = {"pinion.teeth": ("sample", [20, 3, 25])}
    >>> rank_variants(xarray.Dataset({**factor, **status}, teeth), "face_load_factor")["pinion.teeth"].tolist()
    [25, 20, 3]
    """
    import pandas

    ranked_by = [by] if by else main_figures(study)[:1]
    require(*index_checks(torque=(torque, study.sizes.get("torque", 0))))
    columns = {}
    for name in dict.fromkeys([*ranked_by, *main_figures(study)]):
        values = figure_values(study, name)
        worst = np.fmin.reduce if is_largest_best(name, largest_is_best) else np.fmax.reduce
        columns[name] = worst(values, axis=1) if torque is None else values[:, torque]
    ranks = columns[ranked_by[0]] if ranked_by else np.full(study.sizes["sample"], np.nan)
    largest_first = is_largest_best(ranked_by[0], largest_is_best) if ranked_by else False
    order = np.argsort(-ranks if largest_first else ranks, kind="stable")  # NaN at the end
    count = int((~np.isnan(ranks)).sum())
    frame = pandas.DataFrame(
        {
            "sample": np.arange(len(order)),
            "status": study["status"].values,
            **{key: study[key].values for key in varied_keys(study)},
            **columns,
            "warnings": [len(lines.splitlines()) for lines in study["warnings"].values.tolist()],
            "reason": study["reason"].values,
        }
    ).iloc[order]
    frame.insert(0, "rank", pandas.array([*range(1, count + 1), *[None] * (len(order) - count)], dtype="Int64"))
    return frame.reset_index(drop=True)


def figures(scene: Scene) -> dict[str, Array]:
    """Analyse a scene and return its key figures.

    A function of the scene alone, that other processes can import: whatever drives a function can drive it.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    dict of str to (torques,) array
        By the names of :meth:`MeshCycle.key_figures`, which end in their unit; NaN: not known. Scenes with [operation]
        or [lubricant] have those of :func:`tribology_figures`, too, those with strengths and [rating] those of
        :func:`rating_figures`. Of a double helical pair those of :func:`halves_figures`.

    Raises
    ------
    InputError, GeometryError, ConvergenceError
        As :func:`loaded_tca.analyse`.

    Examples
    --------
    >>> from loaded_tca import parse_scene
    >>> from loaded_tca.cli import DEMO_SCENE
    >>> few = {"analysis.positions": 3, "analysis.compliance": "contact", "analysis.free_edges": False}
    >>> scene = parse_scene(DEMO_SCENE.read_text()).with_changes(few)
    >>> figures(scene)["pinion_torque_Nm"]
    array([80.])
    """
    return halves_figures(scene) if isinstance(scene, DoubleHelicalScene) else figures_of(analyse(scene))


def figures_of(result: MeshCycle) -> dict[str, Array]:
    """Key figures of a result, (torques,) each, with those of tribology and of rating that its scene asks for."""
    return result.figure_arrays() | tribology_figures(result) | rating_figures(result)


MAIN = [*declared(lambda figure: figure.is_scattered), *REQUIRED]
"""Figures that are told, those of them that the study has."""
PERCENTILES = {"min": 0, "5 %": 5, "median": 50, "95 %": 95, "max": 100}
MOST_REASONS = 5


def study_summary(study: xarray.Dataset) -> str:
    """Return the status of the variants of a study, and the scatter of the main figures, as text.

    Parameters
    ----------
    study : xarray.Dataset
        What :func:`loaded_tca.studies.run_study` returns.

    Returns
    -------
    str
        Percentiles are over the variants whose figure is known; failures and warnings stand below, most frequent first.

    Examples
    --------
    >>> import xarray
    >>> figures = {"face_load_factor": (("sample", "torque"), [[1.2], [1.6], [np.nan]])}
    >>> words = {"status": ["ok", "ok", "refused"], "reason": ["", "", "pinion: pointed"], "warnings": ["", "", ""]}
    >>> figures |= {name: ("sample", column) for name, column in words.items()}
    >>> print(study_summary(xarray.Dataset(figures)))
    3 variants: 2 ok, 1 refused
                               min        5 %     median       95 %        max
    load factor K_Hbeta        1.2       1.22        1.4       1.58        1.6
    refused: pinion: pointed (1 variant)
    """
    status = Counter(study["status"].values.tolist())
    counts = ", ".join(
        f"{count} {word}" for word, count in sorted(status.items(), key=lambda one: (one[0] != "ok", one))
    )
    head = f"{study.sizes['sample']} variants: {counts}"
    return "\n".join([head, *_told_mixed(study), *_table(study), *shortfall_text(study), *_reasons(study)])


def _told_mixed(study: xarray.Dataset) -> Iterator[str]:
    """That the table has all combinations of given values together, where distributions scatter about each."""
    keys = design_keys(study)
    combinations = len(set(zip(*(study[key].values.tolist() for key in keys), strict=True)))
    if keys and combinations > 1:
        yield f"all {combinations} combinations of {', '.join(keys)} together; ranking.csv has each by itself"


def _label_of(name: str) -> str:
    """What the summary calls a figure."""
    return FIGURES[name].label if name in FIGURES else SAFETIES.get(name) or without_unit(name).replace("_", " ")


def _table(study: xarray.Dataset) -> Iterator[str]:
    """Percentiles of the main figures over the variants under each torque, and of those of a load spectrum."""
    names = [name for name in MAIN if name in study] or main_figures(study)
    labels = {name: _label_of(name) for name in names}
    shown = {name: labelled(name, label) for name, label in labels.items() if np.isfinite(study[name]).any()}
    if not shown:
        return
    blocks = blocks_of(study, [*shown])
    width = max(len(word) for word in (*shown.values(), *(head for head, _, _ in blocks)))
    for head, torque, lines in blocks:
        yield f"{head:<{width}}" + "".join(f"{word:>11}" for word in PERCENTILES)
        for name in lines:
            values = study[name].values[:, torque]
            values = values[np.isfinite(values)]
            if values.size:
                at = np.percentile(values, [*PERCENTILES.values()])
                yield f"{shown[name]:<{width}}" + "".join(f"{plain(value):>11}" for value in at)


def blocks_of(study: xarray.Dataset, names: Sequence[str]) -> list[tuple[str, int, list[str]]]:
    """Head, index of a torque and figures of each part of a table: for each torque, last for a load spectrum."""
    of_all_bins = of_spectrum(study)
    under_each = [name for name in names if name not in of_all_bins]
    blocks = [(_under(study, torque), torque, under_each) for torque in range(study.sizes["torque"])]
    blocks.append((UNDER_SPECTRUM, 0, [name for name in names if name in of_all_bins]))
    return [(head, torque, some) for head, torque, some in blocks if some]


def _under(study: xarray.Dataset, torque: int) -> str:
    """Of several torques the one that all variants have, or its number."""
    name, count = torque_name(study), study.sizes["torque"]
    torques = study[name].values[:, torque] if name in study else np.zeros(1)
    known = torques[np.isfinite(torques)]
    if count == 1:
        return ""
    return f"under {plain(known[0], 6)} N m" if known.size and np.ptp(known) == 0.0 else f"torque {torque + 1}"


def _reasons(study: xarray.Dataset) -> Iterator[str]:
    """Why variants failed, and what is doubtful, each once, with how many variants it concerns."""
    failed = [
        f"{status}: {' '.join(reason.split())}"
        for status, reason in zip(study["status"].values.tolist(), study["reason"].values.tolist(), strict=True)
        if status != "ok"
    ]
    doubtful = [
        f"warning: {without_place(line)}" for lines in study["warnings"].values.tolist() for line in lines.splitlines()
    ]
    for sentences in (failed, doubtful):
        counted = Counter(sentences).most_common()
        for sentence, count in counted[:MOST_REASONS]:
            yield f"{sentence} ({count} variant{'s' if count > 1 else ''})"
        if len(counted) > MOST_REASONS:
            yield f"... and {len(counted) - MOST_REASONS} more"
