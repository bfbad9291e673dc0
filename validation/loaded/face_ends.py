"""K_Hbeta of half-spaces at sharp face ends that lie in one plane, against fine cells.

Without free edges the line load grows without end towards such an end. Random cylindrical pairs with faces of one
width, flanks alone: what K_Hbeta lacks on 64 and 128 cells along the contact is at most ``face_load_factor_error``,
which falls with the cells. The limit is that of first order from 128 and 512 cells.

At rounded ends of a spur pair 25/37, with teeth that bend and free edges, K_Hbeta is off on 48 to 192 cells by at most
the same figure: against 640 cells, which are off by some thousandths themselves.
"""

import warnings
from collections.abc import Sequence
from functools import cache

import numpy as np

from loaded_tca import AccuracyWarning, analyse, read_scene
from loaded_tca.scene import Scene
from loaded_tca.scene.parse import scene_from_table
from validation.page import SCENES
from validation.random_scenes import random_scene
from validation.table import Row

SEEDS = (1, 2, 3, 4, 6)
"""The first whose load is largest at a face end."""
CELLS, FINE = (64, 128), 512
ACROSS = 16
RADII, LOADS = (0.1, 0.3, 0.6, 0.8), ((100.0, 0.0), (500.0, 5.0))
ON_ARCS, FINE_ROUNDED = (48, 64, 96, 128, 192), 640
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


@cache
def rounded_factor_and_error(radius: float, torque: float, misalignment: float, cells: int) -> tuple[float, float]:
    """K_Hbeta of a spur pair with such rounded ends [mm], load [N m] and misalignment [um], and its estimated error."""
    pair = {"type": "cylindrical", "normal_module_mm": 3.0, "pressure_angle_deg": 20.0, "helix_angle_deg": 0.0}
    gears = {
        name: {"teeth": teeth, "face_width_mm": 20.0, "side_rounding_mm": radius}
        for name, teeth in (("pinion", 25), ("wheel", 37))
    }
    scene = {
        "pair": pair,
        **gears,
        "mounting": {"misalignment_um": misalignment},
        "material": {"youngs_modulus_MPa": 206000.0, "poisson_ratio": 0.3},
        "load": {"pinion_torque_Nm": torque},
        "analysis": {"positions": 3, "cells": [ACROSS, cells]},
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        (figures,) = analyse(scene_from_table(scene)).key_figures()
    return figures["face_load_factor"], figures["face_load_factor_error"]


def rounded_rows(radii: Sequence[float] = RADII, loads: Sequence[tuple[float, float]] = LOADS) -> list[Row]:
    """Rounded ends: K_Hbeta on several grids against fine cells."""
    rows = []
    for radius in radii:
        for torque, misalignment in loads:
            fine, _ = rounded_factor_and_error(radius, torque, misalignment, FINE_ROUNDED)
            for cells in ON_ARCS:
                factor, error = rounded_factor_and_error(radius, torque, misalignment, cells)
                what = f"{cells} cells: K_Hbeta is off by more than its estimate of {100.0 * error:.1f} %"
                beyond = max(abs(factor / fine - 1.0) - error, 0.0)
                name = f"face ends rounded by {radius} mm, {torque:.0f} N m, {misalignment:.0f} um"
                rows.append(Row(name, f"{FINE_ROUNDED} cells", what, 0.0, beyond, 0.0))
    return rows


def rows() -> list[Row]:
    """FZG C14, random pairs and one with rounded ends; a NaN, where a pair has no estimate, fails."""
    return [*sharp_rows(), *rounded_rows(RADII[2:3], LOADS[:1])]


def whole_rows() -> list[Row]:
    """The same with all radii and loads."""
    return [*sharp_rows(), *rounded_rows()]


def sharp_rows() -> list[Row]:
    """FZG C14 and random pairs."""
    scenes = {"FZG C14": read_scene(SCENES / "fzg_c14.toml")} | {f"random pair {seed}": _flush(seed) for seed in SEEDS}
    return [row for name, scene in scenes.items() for row in _rows(name, scene)]
