"""Safeties and lives as figures of studies, gears of tolerance classes, and how probable it is that a safety is missed.

Samples of a study scatter as gears and mountings do. The part of them whose safety is below that required estimates the
probability; its bounds are those of a binomial count (Clopper and Pearson 1934), since a few samples say little of
what is rare. K_v and K_Halpha by method B follow from the tolerances of the class, which no sample scatters.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, real
from loaded_tca.errors import require
from loaded_tca.plain import plain, table_cell
from loaded_tca.rating import rating_of
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.scene import Scene
from loaded_tca.scene.rating import is_rated
from loaded_tca.studies.stage import torque_name
from loaded_tca.studies.study import MOST_VARIANTS, Study, is_whole

if TYPE_CHECKING:
    import pandas
    import xarray

    from loaded_tca.rating.rating import OfCases

FIGURES = {
    "S_H": "safety against pitting S_H",
    "S_F": "safety against tooth breakage S_F",
    "S_H_local": "local safety against pitting",
    "S_F_local": "local safety against tooth breakage",
    "life_h": "life after ISO 6336",
    "life_local_h": "life by local stresses",
}
"""Names in a study, which end in their unit, and what they are: of both gears the less, lives of flanks and roots."""
MAIN_FIGURES = "S_H_local", "S_F_local"
"""Those that rankings, summaries and pictures show without being asked for."""
REQUIRED = {
    name: f"required_{kind}_safety"
    for kind, names in {"flank": ("S_H", "S_H_local"), "root": ("S_F", "S_F_local")}.items()
    for name in names
}
"""Safety -> key of [rating] that has what is required."""
SPECTRA = frozenset(("load.case", "load.spectrum"))
"""Keys of a load spectrum."""
UNDER_SPECTRUM = "under the load spectrum"
CONFIDENCE = 0.95
CLASS = "rating.tolerance_class"


def rating_figures(result: MeshCycle) -> dict[str, Array]:
    """Safeties and lives of a result, the smaller of both gears; none for scenes without strengths and [rating].

    ``loaded_tca.studies.figures`` has them beside the key figures, so that rankings and pictures of studies have them:
    ``rank_variants(study, by="S_H_local")``. The largest is best.

    Parameters
    ----------
    result : MeshCycle

    Returns
    -------
    dict of str to (torques,) array
        ``S_H``, ``S_F``, ``S_H_local``, ``S_F_local``, ``life_h`` and ``life_local_h`` (the shorter of flanks and
        roots, inf: without end). NaN: not known, as the local ones of roots without root stress. Of a load spectrum
        those of all bins together, under each torque the same.

    Raises
    ------
    InputError
        As :meth:`loaded_tca.MeshCycle.rating`: what is missing or not covered.
    """
    if not is_rated(result.scene):
        return {}
    return figures_of_rating(rating_of(result, warn=False), len(result.torque))


def figures_of_rating(rating: OfCases, count: int) -> dict[str, Array]:
    """Safeties and lives of a rating (torques,) as :func:`rating_figures` has them; ``count`` torques are analysed."""
    unknown = np.full(count, np.nan)
    safeties, lives = (
        {mode: np.broadcast_to(values[..., n].min(axis=1), count) for n, mode in enumerate(rating.modes)}
        for values in rating.safeties_and_lives()
    )
    shorter = [
        np.fmin(*(lives.get(f"{place}{kind}", unknown) for kind in ("flank", "root"))) for place in ("", "local_")
    ]
    of_modes = [safeties.get(f"{place}{kind}", unknown) for place in ("", "local_") for kind in ("flank", "root")]
    return dict(zip(FIGURES, (*of_modes, *shorter), strict=True))


@checked
def tolerance_class_study(scene: Scene, classes: Sequence[int], samples: int = 64, seed: int = 0) -> Study:
    """Return the study of a scene whose gears are of tolerance classes of ISO 1328-1, each with samples of its slopes.

    Helix and profile slopes of both gears scatter as ``scene.scatter_of_class`` says, at the same points of a Sobol
    sequence for each class; ``rating.tolerance_class``, from which factors by method B follow, is that class.

    Parameters
    ----------
    scene : Scene
        With strengths and [rating].
    classes : sequence of int
        From 1 to 11.
    samples : int
        Of each class.
    seed : int
        Of the samples.

    Returns
    -------
    Study
        ``shortfall`` of its rows has the probability of each class.

    Raises
    ------
    InputError
        If the scene has no [rating], no class is given, or the standard has no tolerances of the gears.

    Examples
    --------
    >>> from loaded_tca import read_scene
    >>> study = tolerance_class_study(read_scene("examples/scenes/rated_helical.toml"), [5, 8], samples=4)
    >>> len(study), study.changes(7)["rating.tolerance_class"]
    (8, 8)
    """
    rated, listed = is_rated(scene), isinstance(classes, Sequence) and not isinstance(classes, str) and len(classes) > 0
    require(
        (rated, "scene: no strength of both gears and [rating]; a study of safeties needs them"),
        (listed, f"classes: found {classes!r:.60}; allowed a list of whole numbers from 1 to 11"),
        (is_whole(samples, 1, MOST_VARIANTS), f"samples: found {samples!r:.60}; allowed a whole number from 1 on"),
    )
    table: dict[str, list[float]] = {CLASS: []}
    for number in classes:
        require((is_whole(number, 1, 11), f"classes: found {number!r:.60}; allowed whole numbers from 1 to 11"))
        drawn = Study(scene, distributions=scene.scatter_of_class(number), samples=samples, seed=seed)
        for sample in range(samples):
            for key, value in {CLASS: number, **drawn.changes(sample)}.items():
                table.setdefault(key, []).append(value)
    return Study(scene, table=table)


def safeties_of(study: xarray.Dataset) -> list[str]:
    """Safeties that a study has, by their names."""
    return [name for name in REQUIRED if name in study.data_vars and np.isfinite(study[name].values).any()]


def of_spectrum(study: xarray.Dataset) -> frozenset[str]:
    """Figures of a study that are of a load spectrum, under each torque the same; none without a spectrum."""
    from loaded_tca.studies.ranking import varied_keys
    from loaded_tca.studies.stage import subject_of

    names = frozenset(FIGURES).intersection(map(str, study.data_vars))
    if not names:
        return names
    load = subject_of(study).load
    given = load.case is not None or load.spectrum is not None or not SPECTRA.isdisjoint(varied_keys(study))
    return names if given else frozenset()


def required_safeties(study: xarray.Dataset, scene: Scene, name: str) -> Array:
    """What is required of a safety in each variant of a study (samples,)."""
    key = f"rating.{REQUIRED[name]}"
    if key in study.coords:
        return np.asarray(study[key].values, dtype=float)
    return np.full(study.sizes["sample"], getattr(scene.rating, REQUIRED[name]))


def _bounds(below: int, samples: int) -> tuple[float, float]:
    """Bounds of the probability of what happened so often in samples, after Clopper and Pearson."""
    from scipy.stats import beta

    tail = 0.5 * (1.0 - CONFIDENCE)
    low = 0.0 if below == 0 else float(beta.ppf(tail, below, samples - below + 1))
    high = 1.0 if below == samples else float(beta.ppf(1.0 - tail, below + 1, samples - below))
    return low, high


@checked
def shortfall(study: xarray.Dataset, by: Sequence[str] | None = None) -> pandas.DataFrame:
    """How probable it is that a safety is below the required one, by the samples of a study.

    Parameters
    ----------
    study : xarray.Dataset
        What :func:`loaded_tca.studies.run_study` returns.
    by : sequence of str, optional
        Varied keys whose values make groups of samples. Default: those of factors, of tables with distributions, and
        ``rating.tolerance_class``.

    Returns
    -------
    pandas.DataFrame
        A row for each safety, torque and group: keys of the groups, ``figure``, ``pinion_torque_Nm``, ``samples`` (with
        that figure), ``below``, ``probability``, ``low`` and ``high`` (its bounds, 95 % confidence), ``median`` and
        ``least`` of the safety, and ``required`` (of the first sample). The torque is NaN where that of the samples
        differs, and under a load spectrum, whose bins all count together in one row. No rows of a study without
        safeties.

    Raises
    ------
    InputError
        If the study does not vary a key.

    References
    ----------
    Clopper & Pearson 1934, Biometrika 26, 404-413.
    """
    import pandas

    from loaded_tca.studies.ranking import design_keys, figure_values, varied_keys
    from loaded_tca.studies.stage import subject_of

    varied, names = varied_keys(study), safeties_of(study)
    keys = [*by] if by is not None else [key for key in varied if key == CLASS or key in design_keys(study)]
    require(*((key in varied, f"by: {key!r:.60}; allowed {', '.join(varied)}") for key in keys))
    head = [*keys, "figure", torque_name(study)]
    columns = [*head, "samples", "below", "probability", "low", "high", "median", "least", "required"]
    rows = []
    scene = subject_of(study) if names else None
    torques = study[torque_name(study)].values if names else np.empty((0, 0))
    if of_spectrum(study):
        torques = np.full((len(torques), 1), np.nan)
    groups = dict.fromkeys(zip(*(study[key].values.tolist() for key in keys), strict=True)) if keys else {(): None}
    for name in names:
        assert isinstance(scene, Scene)
        values, required = figure_values(study, name), required_safeties(study, scene, name)
        for group in groups:
            of_group = np.ones(len(required), dtype=bool)
            for key, value in zip(keys, group, strict=True):
                of_group &= study[key].values == value
            for torque, moments in enumerate(torques.T):
                known = of_group & np.isfinite(values[:, torque])
                if known.any():
                    safeties, moment = values[known, torque], _alike(moments[known])
                    count, below = len(safeties), int((safeties < required[known]).sum())
                    numbers = below / count, *_bounds(below, count), np.median(safeties), safeties.min()
                    rows.append((*group, name, moment, count, below, *map(real, numbers), required[known][0]))
    return pandas.DataFrame(rows, columns=columns)


def _alike(torques: Array) -> float:
    """Torque of samples [N m]; NaN where it differs among them."""
    return float(torques[0]) if (torques == torques[0]).all() else math.nan


def shortfall_text(study: xarray.Dataset) -> Iterator[str]:
    """A line for each safety, torque and group with the probability of a shortfall, if samples of a study scatter."""
    from loaded_tca.studies.ranking import is_sampled, varied_keys

    if not (is_sampled(study) or CLASS in varied_keys(study)):
        return
    frame, of_all_bins = shortfall(study), of_spectrum(study)
    keys = [*frame.columns[: frame.columns.get_loc("figure")]]
    for _, row in frame.iterrows():
        group = "".join(f", {key} {table_cell(row[key])}" for key in keys)
        torque = row[torque_name(study)]
        under = "under the torque of each sample" if math.isnan(torque) else f"under {plain(torque)} N m"
        under = UNDER_SPECTRUM if row["figure"] in of_all_bins else under
        yield (
            f"{FIGURES[row['figure']]} below the required {plain(row['required'])} {under}{group}: "
            f"probability {plain(100.0 * row['probability'], 3)} % "
            f"({row['below']} of {row['samples']} samples; {100.0 * row['low']:.1f} to {100.0 * row['high']:.1f} % "
            f"with {plain(100.0 * CONFIDENCE, 6)} % confidence), median {plain(row['median'])}"
        )
