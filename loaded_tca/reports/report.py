"""Reports of results, stages, studies and designs as one HTML file that needs nothing else.

What those of studies and designs tell is here too; results and stages are in :mod:`loaded_tca.reports.result_page`.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.double_helical import DoubleHelicalResult
from loaded_tca.errors import InputError, require
from loaded_tca.plain import plain, table_cell
from loaded_tca.plots import plot_before_and_after, plot_peak_to_peak_over_torque, plot_study
from loaded_tca.plots.style import label_of
from loaded_tca.reports import page
from loaded_tca.reports.comparison_page import comparison_content
from loaded_tca.reports.double_helical_page import double_helical_content, halves_geometry
from loaded_tca.reports.page import Table, pictures_of
from loaded_tca.reports.result_page import explained, result_content, scene_content, stage_content, stage_geometry
from loaded_tca.reports.revolution_page import revolution_content
from loaded_tca.results.comparison import Comparison
from loaded_tca.results.files import STUDY, FilePath, make_directory, replace_file
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.result import AnalysisResult
from loaded_tca.results.revolution import OverTurns
from loaded_tca.results.summary import shown, shown_torque
from loaded_tca.results.warnings import without_place
from loaded_tca.scene import Scene, parse_scene
from loaded_tca.scene.double_helical import DoubleHelicalScene
from loaded_tca.stages import Stage, StageResult
from loaded_tca.studies.design import KEPT, DesignResult
from loaded_tca.studies.design_figures import FIGURES
from loaded_tca.studies.ranking import (
    MAIN,
    PERCENTILES,
    blocks_of,
    design_keys,
    figure_values,
    is_largest_best,
    is_sampled,
    main_figures,
    nominal_variant,
    quantile_of,
    rank_combinations,
    rank_variants,
    varied_keys,
)
from loaded_tca.studies.rating import CLASS, UNDER_SPECTRUM, shortfall
from loaded_tca.studies.rating import FIGURES as SAFETIES
from loaded_tca.studies.stage import subject_of, torque_name
from loaded_tca.threads import one_thread

if TYPE_CHECKING:
    import pandas
    import xarray


@checked
def write_html_report(
    subject: Any,
    path: FilePath,
    *,
    date: str | None = None,
    rank_by: str | None = None,
    axes: Sequence[str] | None = None,
    torque: float | None = None,
    interactive: bool = False,
    coast: MeshCycle | None = None,
) -> Path:
    """Write the report of a result, a revolution, a comparison, a stage, a study or a design: one HTML file.

    It tells what was asked, the geometry, the load cases, the key figures with their units and how accurate they are,
    every accuracy warning with its meaning, and the scene file. It needs no other file, and prints on A4. The same
    subject and date give the same file.

    Parameters
    ----------
    subject : MeshCycle, Revolution, Comparison, StageResult, DoubleHelicalResult, xarray.Dataset or DesignResult
        A result; a whole revolution, also a ``DoubleHelicalRevolution``; several results as
        :func:`loaded_tca.results.compare_results` returns them; a planetary stage; a double helical pair; a study as
        :func:`loaded_tca.studies.run_study` returns it; a design.
    path : str or path
        Of the file; its directory is made if it does not exist.
    date : str, optional
        Of the analysis; default: of results its own, of a study or design today's.
    rank_by : str, optional
        Figure that ranks the variants of a study; default: the peak-to-peak transmission error. The best is first, as
        :func:`loaded_tca.studies.rank_variants` has it. Where the study has distributions, combinations of its other
        values are ranked, by the 95 % quantile over their samples, or the 5 % quantile where the largest is best.
    axes : (str, str), optional
        Keys of a study that its heat maps have to the right and upwards, as :func:`loaded_tca.plots.plot_study` takes
        them; default: the first two with given values.
    torque : float [N mm], optional
        Of the pictures of a comparison; default: the largest that all results have.
    interactive : bool
        True: the page of :func:`explore`, of a result or a study, which needs the extra ``interactive``.
    coast : MeshCycle, optional
        Result of ``scene.coast_side()`` of the scene of a result: its rating is that of both sides, as
        :meth:`loaded_tca.MeshCycle.rating` has it. The rest of the report shows the result alone.

    Returns
    -------
    pathlib.Path
        The file.

    Raises
    ------
    InputError
        If the subject is none of these, no study with the figure that is to rank it and the axes that are to show it,
        or no comparison under the torque;
        if it cannot be rated with the coast side; if jinja2 is not installed, or
        the file cannot be written, which leaves what was there before.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from loaded_tca import analyse, read_scene
    >>> from loaded_tca.cli import DEMO_SCENE
    >>> alone = {"load_sharing": False, "compliance": "contact", "positions": 1, "torques_Nm": None}
    >>> scene = read_scene(DEMO_SCENE).with_changes({f"analysis.{key}": value for key, value in alone.items()})
    >>> with TemporaryDirectory() as directory:
    ...     write_html_report(analyse(scene), Path(directory, "report.html")).name
    'report.html'
    """
    rates = isinstance(subject, MeshCycle) and not interactive
    about = "the interactive page" if interactive else f"a {type(subject).__name__}"
    require((coast is None or rates, f"coast: not allowed; {about} has no rating of one pair"))
    if interactive:
        from loaded_tca.reports.interactive import explore  # which shows tables of this module, too

        require((axes is None, "axes: not allowed; the interactive page has its own choice of keys"))
        return explore(subject, date=date, rank_by=rank_by).save(path)
    page.require_jinja2()
    is_study = getattr(subject, "attrs", {}).get("kind") == STUDY
    require(
        (rank_by is None or is_study, f"rank_by: {rank_by!r:.60}; a {type(subject).__name__} has no ranking"),
        (axes is None or is_study, f"axes: {axes!r:.60}; a {type(subject).__name__} varies no keys"),
    )
    is_compared = isinstance(subject, Comparison)
    require((torque is None or is_compared, f"torque: {torque!r:.60}; a {type(subject).__name__} has all torques"))
    with one_thread():  # sums of several threads differ in their last digits each time
        if isinstance(subject, MeshCycle):
            template, content = "result.html.j2", result_content(subject, coast)
        elif isinstance(subject, Comparison):
            template, content = "comparison.html.j2", comparison_content(subject, torque)
        elif isinstance(subject, DesignResult):
            template, content = "design.html.j2", design_content(subject)
        elif isinstance(subject, DoubleHelicalResult):
            template, content = "double_helical.html.j2", double_helical_content(subject)
        elif isinstance(subject, StageResult):
            template, content = "stage.html.j2", stage_content(subject)
        elif isinstance(subject, OverTurns):
            template, content = "revolution.html.j2", revolution_content(subject)
        elif is_study:
            template, content = "study.html.j2", study_content(subject, rank_by, axes)
        else:
            raise InputError(
                f"report: found a {type(subject).__name__}; allowed a result, a whole revolution, a comparison, a "
                "stage, a double helical pair, a study or a design"
            )
    analysed = subject.date if isinstance(subject, AnalysisResult) else None
    content = {"version": version("loaded_tca"), **content, "date": page.shown_date(date or analysed)}
    text = page.render(template, **content)
    target = Path(path)
    make_directory(target.parent)
    replace_file(target, text.encode())
    return target


MOST_ROWS = 30
"""Variants of the ranking."""
WAYS = {"table": "given one by one", "factor": "every combination", "distribution": "distributed"}
STUDY_CAPTIONS = {
    "study_lines": "The figure over the values of the first key, a line for each value of the second.",
    "study_heat_map": "The figure over two keys, the best cell framed. Crosses: no variant has the figure.",
    "study_histogram": "How the figure scatters over the variants.",
    "study_over_torque": "Median and scatter over the torque.",
    "study_scatter_matrix": "Figures over the keys, a dot for each variant.",
}
"""How the pictures are read whose names begin so."""


def study_content(
    study: xarray.Dataset, rank_by: str | None = None, axes: Sequence[str] | None = None
) -> dict[str, Any]:
    """Return what the template of a study takes.

    Parameters
    ----------
    study : xarray.Dataset
        What :func:`loaded_tca.studies.run_study` returns.
    rank_by : str, optional
        As for :func:`loaded_tca.studies.rank_variants`.
    axes : (str, str), optional
        As for :func:`loaded_tca.plots.plot_study`.
    """
    tables = study_tables(study, rank_by)  # which reads the scene, and refuses one that names files
    figures = plot_study(study, rank_by=rank_by if main_figures(study) else None, axes=axes)
    figures.pop("study_ranking")  # a table of the page
    return {**tables, "pictures": pictures_of(figures, STUDY_CAPTIONS, tables["title"])}


def study_tables(study: xarray.Dataset, rank_by: str | None = None) -> dict[str, Any]:
    """Return what a page says of a study in words and tables; as :func:`study_content`, without pictures."""
    by = rank_by if main_figures(study) else None  # where all variants were refused there is nothing to rank by
    sampled = is_sampled(study)
    combinations = rank_combinations(study, by) if design_keys(study) else None
    grouped = combinations is not None and bool(combinations["rank"].notna().any())
    subject = subject_of(study)
    lines = Counter(line for warned in study["warnings"].values.tolist() for line in warned.splitlines())
    by_reason: dict[str, list[str]] = {}
    for line in lines:
        by_reason.setdefault(without_place(line), []).append(line)
    concerned = {
        reason: sum(any(line in warned.splitlines() for line in places) for warned in study["warnings"].values.tolist())
        for reason, places in by_reason.items()
    }
    variants = study.sizes["sample"]
    return {
        "title": subject.title or "Study",
        "analysed_by": str(study.attrs.get("version", "")),
        "statuses": Counter(study["status"].values.tolist()).most_common(),
        "variants": variants,
        "analysed": "ok" in study["status"].values,
        **_geometry_of(subject),
        "varied": _varied(study),
        "seed": f"{study.attrs.get('seed', '-')}" if sampled else "",
        "scatter": [*scatter_tables(study, by)],
        "sampled": sampled,
        "grouped": grouped,
        "quantile": _quantiles(study, by),
        "few": sorted({*combinations["note"]} - {""}) if combinations is not None else [],
        "ranked_by": label_of(ranks := by or next(iter(main_figures(study)), "")),
        "best": "largest" if is_largest_best(ranks) else "least",
        "shortfall": _shortfall(study) if sampled or CLASS in varied_keys(study) else None,
        "best_and_worst": _best_and_worst(study, by, combinations if grouped else None),
        "ranking": _ranking(study, by, combinations if grouped else None),
        "most_rows": MOST_ROWS,
        "ranked": len(combinations) if grouped and combinations is not None else variants,
        "failures": Counter(
            f"{status}: {' '.join(reason.split())}"
            for status, reason in zip(study["status"].values.tolist(), study["reason"].values.tolist(), strict=True)
            if status != "ok"
        ).most_common(),
        "warnings": explained([f"{reason} ({count} of {variants} variants)" for reason, count in concerned.items()]),
    }


def _geometry_of(subject: Scene | Stage) -> dict[str, Any]:
    """What was asked, the geometry, and the text of a scene or a stage."""
    if isinstance(subject, Stage):
        return stage_geometry(subject)
    return halves_geometry(subject) if isinstance(subject, DoubleHelicalScene) else scene_content(subject)


def _quantiles(study: xarray.Dataset, by: str | None) -> str:
    """Number over samples and torques that stands for a figure, in words: another one where the largest is best."""
    figures = dict.fromkeys([*([by] if by else []), *main_figures(study)])
    usual, *others = dict.fromkeys(f"{100.0 * quantile_of(name):.0f} %" for name in figures) or [""]
    least = any(is_largest_best(name) for name in figures)
    worst = "worst" if others else "least" if least else "largest"
    over = f" of its {worst} value over the torques" if study.sizes.get("torque", 1) > 1 else ""
    opposite = "least" if is_largest_best(next(iter(figures), "")) else "largest"
    apart = "".join(f" ({other} where the {opposite} value is best)" for other in others)
    return f"{usual} quantile{apart} over the samples{over}"


def _shortfall(study: xarray.Dataset) -> Table | None:
    """How probable it is that safeties are below those required, a row for each, torque and group of samples."""
    frame = shortfall(study)
    if frame.empty:
        return None
    keys, torque = [*frame.columns[: frame.columns.get_loc("figure")]], torque_name(study)
    heads = [label_of(key) for key in (*keys, torque)]
    rows = [
        (
            SAFETIES[row["figure"]],
            *(table_cell(row[key]) for key in (*keys, torque)),
            plain(row["required"]),
            plain(row["median"]),
            plain(row["least"]),
            f"{row['below']} of {row['samples']}",
            f"{plain(100.0 * row['probability'], 3)} ({100.0 * row['low']:.1f} to {100.0 * row['high']:.1f})",
        )
        for _, row in frame.iterrows()
    ]
    head = ("", *heads, "required", "median", "least", "samples below", "probability [%]")
    return Table(tuple(rows), head)


def _varied(study: xarray.Dataset) -> Table:
    """What varies, how, and over which values."""
    rows = []
    for key in varied_keys(study):
        values = study[key].values
        known = np.unique(values)
        ends = table_cell(known[0]), table_cell(known[-1])
        span = " to ".join(ends) if known.dtype.kind in "fiu" else ", ".join(map(str, known))
        way = WAYS.get(study[key].attrs.get("sampling", "table"), "")
        way += f", {study[key].attrs['distribution']}" if "distribution" in study[key].attrs else ""
        rows.append((label_of(key), key, way, f"{len(known)}", span))
    return Table(tuple(rows), ("what varies", "key", "how", "values", "from, to"), of_words=True)


def scatter_tables(study: xarray.Dataset, by: str | None) -> Iterator[Table]:
    """Percentiles of the main figures over the variants, a table for each torque and for a load spectrum."""
    if not main_figures(study):
        return
    names = dict.fromkeys([*([by] if by else []), *main_figures(study), *(name for name in MAIN if name in study)])
    for under, k, some in blocks_of(study, [*names]):
        rows = []
        for name in some:
            values = figure_values(study, name)[:, k]
            values = values[np.isfinite(values)]
            if values.size:
                at = np.percentile(values, [*PERCENTILES.values()]).tolist()
                rows.append((label_of(name), *(shown(value, name) for value in at)))
        if under != UNDER_SPECTRUM and "torque" in study.coords:
            under = f"under {shown_torque(study['torque'].values[k])}"
        if rows:
            yield Table(tuple(rows), (under, *PERCENTILES))


def _best_and_worst(study: xarray.Dataset, by: str | None, combinations: pandas.DataFrame | None) -> Table | None:
    """Keys and figures of the best and the worst variant, and of that with the values of the scene if there is one.

    Of combinations where these are given: a single sample is best by chance.
    """
    ranking = rank_variants(study, by) if combinations is None else combinations
    ranked = ranking[ranking["rank"].notna()]
    if ranked.empty:
        return None
    columns = {"best": ranked.iloc[0], "worst": ranked.iloc[-1]}
    nominal = nominal_variant(study) if combinations is None else None
    if nominal is not None:
        columns["as the scene"] = ranking[ranking["sample"] == nominal].iloc[0]
    names = _columns(study, by) if combinations is None else [*combinations.columns[1:].drop("note")]
    rows = [
        (head, *(table_cell(one[name]) for one in columns.values()))
        for name, head in zip(names, _heads(names), strict=True)
    ]
    return Table(tuple(rows), ("", *columns))


def _ranking(study: xarray.Dataset, by: str | None, combinations: pandas.DataFrame | None) -> Table | None:
    """The variants, or the combinations where these are given, the best first."""
    ranking = rank_variants(study, by) if combinations is None else combinations
    ranked = ranking[ranking["rank"].notna()].head(MOST_ROWS)
    columns = (
        ["rank", *_columns(study, by), "warnings"] if combinations is None else [*combinations.columns.drop("note")]
    )
    rows = [tuple(table_cell(value) for value in row) for row in ranked[columns].to_numpy().tolist()]
    return Table(tuple(rows), tuple(_heads(columns))) if rows else None


def _columns(study: xarray.Dataset, by: str | None) -> list[str]:
    """What is told of a variant."""
    return ["sample", *varied_keys(study), *dict.fromkeys([*([by] if by else []), *main_figures(study)])]


def _heads(columns: Sequence[str]) -> Iterator[str]:
    return (label_of(name) if name != "sample" else "variant" for name in columns)


DIFFERENCE = "largest difference of the transmission errors of both [um]"
PEAK = "MPa", "peak pressure, largest over the positions"
DESIGN_CAPTIONS = {
    "before_and_after": "Transmission error and peak pressure over a pitch, load factor and peak-to-peak over the "
    "torque. Lines: mean of the samples of the scatter, bands: all of them.",
    "peak_to_peak": "Peak-to-peak transmission error over the torque.",
}


def design_content(design: DesignResult) -> dict[str, Any]:
    """Return what the template of a design takes.

    Parameters
    ----------
    design : DesignResult
    """
    data = design.dataset
    scene = parse_scene(data.attrs["scene_toml"], source="scene_toml", folder=None)
    minimised = FIGURES[data.attrs["figure"]]
    figures = {
        "before_and_after": plot_before_and_after(design),
        "peak_to_peak": plot_peak_to_peak_over_torque(design),
    }
    return {
        "title": scene.title or "Design",
        **scene_content(scene),
        "objective": f"{data.attrs['objective']} of the {minimised.text}"
        + (f" [{minimised.unit}]" if minimised.unit != "1" else ""),
        "objectives": objectives_table(design),
        "values": values_table(design),
        "limits": [*map(_told_limit, data.attrs["limits"].splitlines())],
        "scattered": _scattered(design),
        "seeds": data.attrs.get("seeds", ""),
        "evaluations": design.evaluations,
        "samples": data.sizes["sample"],
        "figures": _figures(design),
        "unconfirmed": design.unconfirmed,
        "advice": design.advice,
        "warnings": explained(data.attrs["warnings"].splitlines()),
        "pictures": pictures_of(figures, DESIGN_CAPTIONS, scene.title),
        "optimum_toml": scene.with_changes(design.optimum).to_toml(),
    }


def _told_limit(limit: str) -> str:
    """A limit with what its figure measures."""
    name = limit.partition(" ")[0]
    if name not in FIGURES:
        return limit
    return f"{limit} ({FIGURES[name].text}{FIGURES[name].note})"


def objectives_table(design: DesignResult) -> Table:
    """Objective of start and optimum by the analysis and on held contacts, and how far these differ."""
    return Table(
        (
            ("by the full analysis", *(plain(one) for one in design.objective)),
            ("on held contacts", *(plain(one) for one in design.held_objective)),
            (DIFFERENCE, *("-" if math.isnan(one) else plain(one, 2) for one in design.held_difference)),
        ),
        ("", "start", "optimum"),
    )


def values_table(design: DesignResult) -> Table:
    """What was designed, within which range."""
    data = design.dataset
    bounds = data["range"].values.tolist() if "range" in data else [(math.nan, math.nan)] * len(design.start)
    rows = (
        (label_of(key), key, *(shown(one, key) for one in (*ends, before, design.optimum[key])))
        for (key, before), ends in zip(design.start.items(), bounds, strict=True)
    )
    return Table(tuple(rows), ("what was designed", "key", "from", "to", "start", "optimum"), of_words=True)


def _scattered(design: DesignResult) -> Table | None:
    """What scatters, how, and over which values."""
    data = design.dataset
    rows = []
    for line in data.attrs.get("distributions", "").splitlines():
        key, _, words = line.partition(": ")
        values = data["scatter"].sel(scatter_key=key).values
        rows.append((label_of(key), key, words, shown(values.min(), key), shown(values.max(), key)))
    return Table(tuple(rows), ("what scatters", "key", "how", "from", "to"), of_words=True) if rows else None


def _figures(design: DesignResult) -> Table:
    """The worst value over the samples of each figure under each torque, of start and optimum, beside its limit."""
    data, limits = design.dataset, design.limits
    rows = []
    texts = {name: (figure.unit, figure.text) for name, figure in FIGURES.items()}
    for name, (unit, words) in {"peak_pressure": PEAK, **texts}.items():
        if name not in data:
            continue
        values = data[name].max("position") if name == "peak_pressure" else data[name]
        worst = np.fmax.reduce(values.transpose("design", "sample", "torque").values, axis=1)
        for k, torque in enumerate(data["torque"].values.tolist()):
            label = words + (f" [{unit.replace('um', 'µm')}]" if unit != "1" else "")
            row = label, plain(1e-3 * torque), *(shown(value, name) for value in worst[:, k].tolist())
            highest = min((one.highest for one in limits if one.figure == name and k in one.torques), default=math.nan)
            rows.append((*row, _told_beside(float(worst[1, k]), highest)) if limits else row)
    head = "largest of the samples", "pinion torque [N m]", "start", "optimum"
    return Table(tuple(rows), (*head, "limit of the optimum") if limits else head)


def _told_beside(value: float, highest: float) -> str:
    """A limit, and by how much the value exceeds it; nothing where there is none."""
    if math.isnan(highest):
        return ""
    exceeded = f"{plain(highest)}, exceeded by {value / highest - 1.0:.1%}"
    return exceeded if value > (1.0 + KEPT) * highest else plain(highest)
