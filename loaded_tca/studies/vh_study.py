"""The V-H check under load: a study of two mounting errors."""

from __future__ import annotations

from collections.abc import Sequence

from loaded_tca.scene import Scene
from loaded_tca.studies.study import Study


def vh_study(scene: Scene, v: Sequence[float], h: Sequence[float]) -> Study:
    """Return the study of a scene over a grid of two mounting errors, as a V-H check varies them.

    With ``keep_maps=range(len(study))`` :func:`loaded_tca.studies.run_study` keeps what
    :func:`loaded_tca.plots.plot_loaded_vh_check` draws.

    Parameters
    ----------
    scene : Scene
    v : (m,) sequence of float
        Bevel and face-milled gears: offset E [mm]; cylindrical ones: axis error in the plane of the axes [deg].
    h : (n,) sequence of float
        Bevel and face-milled gears: axial displacement P of the pinion [mm]; cylindrical ones: axis error out of the
        plane of the axes [deg].

    Returns
    -------
    Study
        Of m n variants, v changing fastest.

    Raises
    ------
    InputError
        If a value is not a finite number, or there is none.

    Examples
    --------
    >>> from loaded_tca import parse_scene
    >>> from loaded_tca.cli import DEMO_SCENE
    >>> vh_study(parse_scene(DEMO_SCENE.read_text()), v=[0.0], h=[-0.01, 0.0, 0.01]).changes(2)
    {'mounting.out_of_plane_deg': 0.01, 'mounting.in_plane_deg': 0.0}
    """
    v_key, h_key = scene.vh_keys
    return Study(scene, {h_key: h, v_key: v})
