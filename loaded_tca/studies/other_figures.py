"""Figures for studies beside the key figures: of whole revolutions, and of tribology."""

from __future__ import annotations

import math

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.result import figures_of
from loaded_tca.revolution import analyse_revolution
from loaded_tca.scene import Scene
from loaded_tca.tribology import tribology_of
from loaded_tca.tribology.quantities import NUMBERS


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
    return analyse_revolution(scene).figure_arrays()


FIGURES = tuple(figures_of(NUMBERS))
"""Names in a study, which end in their unit: numbers of tribology that have a line in its summary."""


def tribology_figures(result: MeshCycle) -> dict[str, Array]:
    """Figures of tribology of a result; none for scenes without [operation] and [lubricant].

    ``loaded_tca.studies.figures`` has them beside the key figures, so that rankings and pictures of studies know them:
    ``rank_variants(study, by="loss_factor")``, ``rank_variants(study, by="scuffing_safety")``, the largest first.

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
    unknown = np.full(len(result.torque), math.nan)
    tribology = tribology_of(result, warn=False)
    return dict.fromkeys(FIGURES, unknown) | tribology.figure_arrays()
