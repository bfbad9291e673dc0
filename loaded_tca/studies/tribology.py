"""Figures of tribology for studies: loss, film and safeties beside the key figures of every variant."""

from __future__ import annotations

import math

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.tribology import tribology_of

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
