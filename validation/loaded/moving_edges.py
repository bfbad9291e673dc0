"""Derivatives by mounting errors where contacts end at edges, beside differences of whole analyses.

The analyses on either side place their boxes and grids anew; the difference is that of the narrower of two steps, and
what the wider one differs by stands in the note. Teeth bend and edges are free, with 64 cells and 9 positions.
"""

import warnings
from dataclasses import dataclass

import numpy as np

from loaded_tca import AccuracyWarning, analyse, read_scene
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.scene import Scene
from validation.page import SCENES
from validation.table import Row

CASE, SOURCE = "derivatives where contacts end at edges", "differences of whole analyses"
GRID = {"analysis.cells": (64, 64), "analysis.positions": 9}
DISTANCE = "mounting.centre_distance_error_mm"


@dataclass(frozen=True)
class Slopes:
    """A key of a scene, by how much analyses lie on either side, and what is allowed.

    Attributes
    ----------
    scene, key : str
    step : float
        In the unit of the key; the wider one is twice as large.
    allowed : tuple of (str, float)
        Figures and the relative errors allowed.
    torque : float or None [N m]
        Instead of those of the scene.
    """

    scene: str
    key: str
    step: float
    allowed: tuple[tuple[str, float], ...]
    torque: float | None = None


PEAK_TO_PEAK, FIRST, FACTOR = "peak to peak [um per unit]", "order 1 [um per unit]", "K_Hbeta [1 per unit]"
KEYS = (
    Slopes("helical", DISTANCE, 0.02, ((PEAK_TO_PEAK, 0.02), (FIRST, 0.02))),
    Slopes("mesh_cycle_spur", DISTANCE, 0.02, ((PEAK_TO_PEAK, 0.01), (FIRST, 0.01), (FACTOR, 0.02)), 130.0),
    Slopes("spiral_bevel", "mounting.offset_mm", 5e-4, ((PEAK_TO_PEAK, 0.02), (FACTOR, 0.05))),
    Slopes("straight_bevel", "mounting.pinion_axial_mm", 2e-3, ((PEAK_TO_PEAK, 0.1), (FIRST, 0.02))),
)
"""Allowed: 1 to 2 %; of the straight bevel pair 0.01 um/mm, of K_Hbeta of the spiral one, in which analyses with two
steps differ by 2.5 %, twice that."""


def rows() -> list[Row]:
    """Rows of all keys."""
    return [row for one in KEYS for row in _rows(one)]


def _rows(one: Slopes) -> list[Row]:
    changes = GRID | ({} if one.torque is None else {"analysis.torques_Nm": (one.torque,)})
    scene = read_scene(SCENES / f"{one.scene}.toml").with_changes(changes)
    result = _analysed(scene)
    length = 1e3 * result.gear_pair.base_radii[1]
    slopes = result.sensitivities([one.key])
    obtained = {
        PEAK_TO_PEAK: length * slopes.peak_to_peak[0, 0],
        FIRST: length * slopes.harmonics(1)[0, 0, 0],
        FACTOR: slopes.face_load_factor[0, 0],
    }
    narrow, wide = (_differences(scene, one.key, step) for step in (one.step, 2.0 * one.step))
    return [
        Row(
            CASE,
            SOURCE,
            f"{one.scene}, {one.key}: {figure}",
            narrow[figure],
            float(obtained[figure]),
            allowed,
            note=f"over twice the step {wide[figure]:.4g}",
        )
        for figure, allowed in one.allowed
    ]


def _differences(scene: Scene, key: str, step: float) -> dict[str, float]:
    """Slopes of the figures between analyses a step of a key, which is zero in the scene, to either side."""
    low, high = (_figures(_analysed(scene.with_changes({key: by}))) for by in (-step, step))
    return {name: (high[name] - low[name]) / (2.0 * step) for name in low}


def _figures(result: MeshCycle) -> dict[str, float]:
    length = 1e3 * result.gear_pair.base_radii[1]
    return {
        PEAK_TO_PEAK: length * float(np.ptp(result.transmission_error[0])),
        FIRST: length * float(result.harmonics(1)[0, 0]),
        FACTOR: float(result.face_load_factor[0]),
    }


def _analysed(scene: Scene) -> MeshCycle:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # contacts on edges are wanted
        return analyse(scene)
