"""The figures of one analysis, as studies and optimisers take them."""

from __future__ import annotations

import numpy as np

from loaded_tca.analysis import analyse
from loaded_tca.arrays import Array
from loaded_tca.results import MeshCycle
from loaded_tca.scene import Scene


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
