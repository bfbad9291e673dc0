"""Bending where the pressure is: a helical pair whose loaded contact leaves the axis of its grid.

The pair of ``ev_stage.toml`` has its unloaded contact point on the start of a short tip relief at some positions, and
the grid of the contact takes the curvatures of one side of it. With forces in the middles of the cells its transmission
error had a step of 0.43 um between two positions, and a peak to peak of 1.18 um.

Expected are the numbers of an independent repetition of the whole analysis, in which the lines of the forces were taken
from the pressure of the run before until nothing moved (64 x 64 cells, 25 positions): it shares the contact solver and
the finite elements with the package, not the way in which the lines enter the balance. The
tolerances are twice what 32 cells instead of 64 change in it, 2.7 % of the largest step. On 48 x 160 and on 64 x 256
cells the peak to peak is 0.857 um and the largest step 0.137 um. The repetition has contacts where they lie without
load; in the middle of the ways of the pairs order 1 is larger by 0.0015 um, by which its tolerance is wider.
"""

import warnings
from pathlib import Path

import numpy as np

from loaded_tca import AccuracyWarning, analyse, read_scene
from validation.table import Row

CASE, SOURCE = "forces at the centres of pressure", "whole analyses repeated on the lines of their pressure"
SCENE = Path(__file__).with_name("ev_stage.toml")
PEAK_TO_PEAK, LARGEST_STEP, ORDERS = 0.855, 0.136, (0.431, 0.048, 0.004)
"""Of the transmission error at the base radius of the wheel [um]."""
FINE, COARSE = (64, 128), (32, 64)
"""As defaults have them where edges cut a contact, twice as many along: the lines of pressure end askew."""


def rows() -> list[Row]:
    """Rows on fine and on coarse cells."""
    return [*_rows(FINE, 0.02, 0.02, 0.0035), *_rows(COARSE, 0.03, 0.055, 0.01)]


def _rows(cells: tuple[int, int], tolerance: float, of_step: float, of_orders: float) -> list[Row]:
    scene = read_scene(SCENE).with_changes({"analysis.cells": list(cells)})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        result = analyse(scene)
    radius = 1e3 * scene.pair().base_radii[1]
    error, amplitudes = radius * result.transmission_error[0], radius * result.harmonics(3)[0]
    grid, step = f"{cells[0]} x {cells[1]} cells", float(abs(np.diff(error)).max())
    rows = [
        Row(CASE, SOURCE, f"peak to peak of TE, {grid} [um]", PEAK_TO_PEAK, float(np.ptp(error)), tolerance),
        Row(CASE, SOURCE, f"largest step of TE, {grid} [um]", LARGEST_STEP, step, of_step),
    ]
    for order, (expected, amplitude) in enumerate(zip(ORDERS, amplitudes.tolist(), strict=True), 1):
        name = f"order {order} of TE, {grid}: beyond the expected one [um]"
        rows.append(Row(CASE, SOURCE, name, 0.0, amplitude - expected, of_orders))
    return rows
