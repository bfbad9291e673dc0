"""Figures for studies beside the key figures: of whole revolutions, and of tribology."""

from __future__ import annotations

import math

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.revolution import analyse_revolution
from loaded_tca.scene import Scene
from loaded_tca.tribology import tribology_of


def revolution_figures(scene: Scene) -> dict[str, Array]:
    """Analyse a whole revolution of a scene and return its key figures.

    For ``run_study(study, figures=revolution_figures)``: seeds of random deviations and tolerance classes are factors
    like any other key.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    dict of str to (torques,) array
        ``pinion_torque_Nm``, and those of :meth:`loaded_tca.Revolution.key_figures`; NaN: not known.

    Raises
    ------
    InputError, GeometryError, ConvergenceError
        As :func:`loaded_tca.analyse_revolution`.

    Examples
    --------
    The scatter over three gears of a class::

        seeds = {"wheel.pitch.seed": [0, 1, 2], "wheel.pitch.tolerance_class": [5, 7]}
        rows = run_study(Study(scene, seeds), figures=revolution_figures)
        rows["total_single_flank_deviation_um"]
    """
    revolution = analyse_revolution(scene)
    rows = revolution.key_figures()
    figures = {name: np.array([row[name] for row in rows], dtype=float) for name in rows[0]}
    return {"pinion_torque_Nm": 1e-3 * revolution.torque} | figures


FIGURES = {
    "loss_factor": "loss_factor",
    "mean_friction": "mean_friction",
    "efficiency": "efficiency",
    "bulk_temperature_C": "bulk_temperature",
    "largest_contact_temperature_C": "largest_contact_temperature",
    "least_film_thickness_um": "least_film_thickness",
    "least_film_ratio": "least_film_ratio",
    "scuffing_safety": "scuffing_safety",
    "micropitting_safety": "micropitting_safety",
}
"""Name in a study, which ends in its unit -> name in ``Tribology``."""


def tribology_figures(result: MeshCycle) -> dict[str, Array]:
    """Figures of tribology of a result, of scenes with [operation] or [lubricant]; none of others.

    ``loaded_tca.studies.figures`` has them beside the key figures, so that rankings and pictures of studies know them:
    ``rank_variants(study, by="loss_factor")``, ``rank_variants(study, by="scuffing_safety", largest_is_best=True)``.

    Parameters
    ----------
    result : MeshCycle

    Returns
    -------
    dict of str to (torques,) array
        By the names of ``FIGURES``; NaN: not known, as where the scene lacks an input.
    """
    scene = result.scene
    if scene.operation is None and scene.lubricant is None:
        return {}
    found, unknown = tribology_of(result, warn=False), np.full(len(result.torque), math.nan)
    return {
        name: unknown if found.lacking(attribute) else np.asarray(getattr(found, attribute), dtype=float)
        for name, attribute in FIGURES.items()
    }
