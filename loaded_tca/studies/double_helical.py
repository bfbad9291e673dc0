"""Studies over double helical pairs: what is kept of each variant, and what it takes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from loaded_tca.double_helical import analyse_double_helical
from loaded_tca.double_helical.analyse import expected_double_helical_effort
from loaded_tca.double_helical.rating import double_helical_rating_of
from loaded_tca.scene.double_helical import DoubleHelicalScene
from loaded_tca.scene.rating import is_rated
from loaded_tca.studies.rating import figures_of_rating

if TYPE_CHECKING:
    from loaded_tca.arrays import Array
    from loaded_tca.scene import Scene


def halves_figures(scene: DoubleHelicalScene) -> dict[str, Array]:
    """Analyse a double helical pair and return its key figures: what studies over such pairs keep of each variant.

    Parameters
    ----------
    scene : DoubleHelicalScene

    Returns
    -------
    dict
        Name -> array (torques,): ``transmission_error_peak_to_peak_um``, ``share_factor``, ``axial_motion_mean_um``,
        pressures, line loads and load factors of both halves, and so on; of scenes with strengths and [rating] the
        safeties and lives of :func:`loaded_tca.studies.rating_figures`, those of the worse half.

    Raises
    ------
    InputError, GeometryError, ConvergenceError
        As :func:`loaded_tca.double_helical.analyse_double_helical`.

    Examples
    --------
    Axial motion and what is left in each half over scattered helix slopes, with distributions of ``scipy.stats``::

        slopes = {"pinion.half_b.modifications.helix_slope_um": norm(0.0, 5.0)}
        study = Study(scene, {"pair.floating": ["pinion", "none"]}, slopes, samples=64)
    """
    result = analyse_double_helical(scene)
    if not is_rated(scene):
        return result.figure_arrays()
    return result.figure_arrays() | figures_of_rating(double_helical_rating_of(result, warn=False), len(result.torque))


def expected_seconds_of_halves(scene: Scene) -> float | None:
    """Estimate of the time of one variant [s]; None of another scene than a double helical pair."""
    return expected_double_helical_effort(scene).seconds if isinstance(scene, DoubleHelicalScene) else None
