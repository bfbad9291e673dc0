"""K_Hbeta of half-spaces at sharp face ends that lie in one plane, against fine cells.

Without free edges the line load grows without end towards such an end. Random cylindrical pairs with faces of one
width, flanks alone: what K_Hbeta lacks on 64 and 128 cells along the contact is at most ``face_load_factor_error``,
which falls with the cells. The limit is that of first order from 128 and 512 cells.
"""

import warnings
from functools import cache

import numpy as np

from loaded_tca import AccuracyWarning, analyse, read_scene
from loaded_tca.scene import Scene
from validation.page import SCENES
from validation.random_scenes import random_scene
from validation.table import Row

SEEDS = (1, 2, 3, 4, 6)
"""The first whose load is largest at a face end."""
CELLS, FINE = (64, 128), 512
ACROSS = 16
ALONE = {"analysis.positions": 3, "analysis.compliance": "contact", "analysis.free_edges": False}


def _flush(seed: int) -> Scene:
    scene = random_scene(seed)
    return scene.with_changes({"pinion.face_width_mm": scene.wheel.face_width_mm})


@cache
def factor_and_error(scene: Scene, cells: int) -> tuple[float, float]:
    """K_Hbeta on so many cells along the contact, and its estimated error."""
    grid = {"analysis.accuracy": None, "analysis.cells": (ACROSS, cells)}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # contacts that end at the face, as they shall
        (figures,) = analyse(scene.with_changes(ALONE | grid)).key_figures()
    return figures["face_load_factor"], figures["face_load_factor_error"]


def _rows(name: str, scene: Scene) -> list[Row]:
    fine, before = (factor_and_error(scene, cells)[0] for cells in (FINE, CELLS[-1]))
    limit = fine + (fine - before) / (FINE / CELLS[-1] - 1.0)
    rows = []
    for cells in CELLS:
        factor, error = factor_and_error(scene, cells)
        what = f"{cells} cells: K_Hbeta lacks more than its estimate of {100.0 * error:.1f} %"
        beyond = float(np.maximum(limit / factor - 1.0 - error, 0.0))
        rows.append(Row(f"face ends, {name}", f"{FINE} cells", what, 0.0, beyond, 0.0))
    return rows


def rows() -> list[Row]:
    """FZG C14 and random pairs; a NaN, where a pair has no estimate, fails."""
    scenes = {"FZG C14": read_scene(SCENES / "fzg_c14.toml")} | {f"random pair {seed}": _flush(seed) for seed in SEEDS}
    return [row for name, scene in scenes.items() for row in _rows(name, scene)]
