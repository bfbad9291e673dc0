"""Figures of whole revolutions for studies: random teeth of a tolerance class, runout, single teeth."""

from __future__ import annotations

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.revolution import analyse_revolution
from loaded_tca.scene import Scene


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
