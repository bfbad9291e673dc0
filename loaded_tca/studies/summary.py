"""The figures of one analysis as studies take them, and a study in a few lines.

These say how many variants there are, what became of them, and how far the main figures scatter.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.analysis import analyse
from loaded_tca.arrays import Array
from loaded_tca.results import MeshCycle
from loaded_tca.results.figure import labelled
from loaded_tca.results.figures import FIGURES, declared
from loaded_tca.results.warnings import without_place
from loaded_tca.scene import Scene

if TYPE_CHECKING:
    import xarray


def figures(scene: Scene) -> dict[str, Array]:
    """Analyse a scene and return its key figures.

    A function of the scene alone, that other processes can import: whatever drives a function can drive it.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    dict of str to (torques,) array
        By the names of :meth:`MeshCycle.key_figures`, which end in their unit; NaN: not known.

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
    return figures_of(analyse(scene))


def figures_of(result: MeshCycle) -> dict[str, Array]:
    """Key figures of a result, (torques,) each."""
    rows = result.key_figures()
    return {name: np.array([row[name] for row in rows], dtype=float) for name in rows[0]}


MAIN = declared(lambda figure: figure.is_scattered)
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
    >>> found = {"face_load_factor": (("sample", "torque"), [[1.2], [1.6], [np.nan]])}
    >>> words = {"status": ["ok", "ok", "refused"], "reason": ["", "", "pinion: pointed"], "warnings": ["", "", ""]}
    >>> print(study_summary(xarray.Dataset({**found, **{name: ("sample", column) for name, column in words.items()}})))
    3 variants: 2 ok, 1 refused
                               min        5 %     median       95 %        max
    load factor K_Hbeta        1.2       1.22        1.4       1.58        1.6
    refused: pinion: pointed (1 variant)
    """
    status = Counter(study["status"].values.tolist())
    told = ", ".join(f"{count} {word}" for word, count in sorted(status.items(), key=lambda one: (one[0] != "ok", one)))
    return "\n".join([f"{study.sizes['sample']} variants: {told}", *_table(study), *_reasons(study)])


def _table(study: xarray.Dataset) -> Iterator[str]:
    """Percentiles of the main figures over the variants, one line for each torque."""
    shown = {
        name: labelled(name, FIGURES[name].label) for name in MAIN if name in study and np.isfinite(study[name]).any()
    }
    if not shown:
        return
    torques = study["pinion_torque_Nm"].values if "pinion_torque_Nm" in study else np.zeros((1, 1))
    for torque in range(study.sizes["torque"]):
        known = torques[np.isfinite(torques[:, torque]), torque]
        same = known.size and np.ptp(known) == 0.0 and study.sizes["torque"] > 1
        head = f"under {known[0]:g} N m" if same else f"torque {torque + 1}" if study.sizes["torque"] > 1 else ""
        width = max(len(label) for label in (*shown.values(), head))
        yield f"{head:<{width}}" + "".join(f"{word:>11}" for word in PERCENTILES)
        for name, label in shown.items():
            values = study[name].values[:, torque]
            values = values[np.isfinite(values)]
            if values.size:
                at = np.percentile(values, [*PERCENTILES.values()])
                yield f"{label:<{width}}" + "".join(f"{value:>11.4g}" for value in at)


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
