"""Derivatives by mounting errors where contacts end at edges, beside differences of whole analyses.

The analyses on either side place their boxes and grids anew; the difference is that of the narrower of two steps.
``python -m validation --whole loaded.moving_edges`` has the straight bevel pair on 192 cells besides, and in the note
what the wider step gives. Teeth bend and edges are free, with 9 positions.
"""

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from loaded_tca import AccuracyWarning, analyse, read_scene
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.scene import Scene
from loaded_tca.separation.pair_change import value_at
from validation.page import SCENES
from validation.table import Row

CASE, SOURCE = "derivatives where contacts end at edges", "differences of whole analyses"
POSITIONS, MOST_CELLS = 9, 192
DISTANCE, OFFSET = "mounting.centre_distance_error_mm", "mounting.axial_offset_mm"
MISALIGNMENT, TORQUES = "mounting.misalignment_um", "analysis.torques_Nm"


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
    cells : int
        Along each axis of a grid.
    changes : mapping
        Of the scene.
    """

    scene: str
    key: str
    step: float
    allowed: tuple[tuple[str, float], ...]
    cells: int = 64
    changes: Mapping[str, object] = field(default_factory=dict)


PEAK_TO_PEAK, FIRST, FACTOR = "peak to peak [um per unit]", "order 1 [um per unit]", "K_Hbeta [1 per unit]"
MEAN = "mean of the transmission error [um per unit]"
KEYS = (
    Slopes("helical", DISTANCE, 0.02, ((PEAK_TO_PEAK, 0.02), (FIRST, 0.01))),
    Slopes(
        "mesh_cycle_spur",
        DISTANCE,
        0.02,
        ((PEAK_TO_PEAK, 4e-3), (FIRST, 0.01), (FACTOR, 0.02)),
        64,
        {TORQUES: (130.0,)},
    ),
    Slopes(
        "design_helical", DISTANCE, 0.04, ((PEAK_TO_PEAK, 0.11), (FIRST, 0.15), (MEAN, 3e-5)), 128, {TORQUES: (250.0,)}
    ),
    Slopes("helical", OFFSET, 0.05, ((PEAK_TO_PEAK, 0.01), (FACTOR, 0.08)), 128, {OFFSET: 1.0, MISALIGNMENT: 20.0}),
    Slopes(
        "spur",
        OFFSET,
        0.1,
        ((MEAN, 0.03),),
        128,
        {
            OFFSET: 4.0,
            "analysis.load_sharing": True,
            "analysis.compliance": "contact+tooth",
            "analysis.free_edges": True,
        },
    ),
    Slopes("spiral_bevel", "mounting.offset_mm", 5e-4, ((PEAK_TO_PEAK, 5e-3), (FACTOR, 0.05))),
    Slopes("straight_bevel", "mounting.pinion_axial_mm", 2e-3, ((PEAK_TO_PEAK, 0.1), (FIRST, 0.02)), MOST_CELLS),
)
"""Allowed: 0.4 to 2 %, more than analyses with two steps differ by; 0.01 um/mm of the straight bevel pair and
of the design, whose four tooth pairs leave little of a mean slope of some 300 um/mm (on 64 cells analyses with three
steps differ by that themselves); of the axial offset 0.002 per mm of K_Hbeta, and 3 % where both ends of every contact
move apart, which no motion of a grid follows; of K_Hbeta of the spiral pair 5 %, twice what analyses with two steps
differ by. The straight bevel pair has slopes of up to 15 um/mm at its positions, of which little is left in both
figures: what cells do to these slopes is up to 0.06 um/mm on 64 and 0.02 on 192, and moves the order by 1.8 to 3.6 % on
32 to 128."""


def rows() -> list[Row]:
    """Rows of the keys on up to 128 cells."""
    return [row for one in KEYS if one.cells < MOST_CELLS for row in _rows(one)]


def whole_rows() -> list[Row]:
    """Rows of all keys, each with the differences over twice the step."""
    noted = ((one, _differences(one, 2.0 * one.step)) for one in KEYS)
    return [
        replace(row, note=f"over twice the step {wide[figure]:.4g}")
        for one, wide in noted
        for row, (figure, _) in zip(_rows(one), one.allowed, strict=True)
    ]


def _scene(one: Slopes) -> Scene:
    grid = {"analysis.cells": (one.cells, one.cells), "analysis.positions": POSITIONS}
    return read_scene(SCENES / f"{one.scene}.toml").with_changes(grid | one.changes)


def _rows(one: Slopes) -> list[Row]:
    result = _analysed(_scene(one))
    length = 1e3 * result.gear_pair.base_radii[1]
    slopes = result.sensitivities([one.key])
    obtained = {
        PEAK_TO_PEAK: length * slopes.peak_to_peak[0, 0],
        FIRST: length * slopes.harmonics(1)[0, 0, 0],
        FACTOR: slopes.face_load_factor[0, 0],
        MEAN: length * slopes.transmission_error[0, :, 0].mean(),
    }
    narrow = _differences(one, one.step)
    return [
        Row(CASE, SOURCE, f"{one.scene}, {one.key}: {figure}", narrow[figure], float(obtained[figure]), allowed)
        for figure, allowed in one.allowed
    ]


def _differences(one: Slopes, step: float) -> dict[str, float]:
    """Slopes of the figures between analyses a step of a key to either side."""
    scene = _scene(one)
    value = value_at(scene, one.key)
    low, high = (_figures(_analysed(scene.with_changes({one.key: value + by}))) for by in (-step, step))
    return {name: (high[name] - low[name]) / (2.0 * step) for name in low}


def _figures(result: MeshCycle) -> dict[str, float]:
    length = 1e3 * result.gear_pair.base_radii[1]
    return {
        PEAK_TO_PEAK: length * float(np.ptp(result.transmission_error[0])),
        FIRST: length * float(result.harmonics(1)[0, 0]),
        FACTOR: float(result.face_load_factor[0]),
        MEAN: length * float(result.transmission_error[0].mean()),
    }


def _analysed(scene: Scene) -> MeshCycle:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # contacts on edges are wanted
        return analyse(scene)
