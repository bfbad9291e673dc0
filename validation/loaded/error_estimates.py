"""Estimated errors of peak pressures beside the errors against fine grids, over random contacts of all families.

Each contact carries a random part of its torque by itself at a random position, with teeth that bend and free edges: on
the grid that a random accuracy chooses, and on 96 x 384 cells, eight times as fine along as the coarsest of those. What
is an estimate worth? A user takes it for a bound: it may be too small for one contact in a hundred, and never by more
than half.
"""

import warnings
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from loaded_tca import AccuracyWarning
from loaded_tca.compliance import tooth_compliance
from loaded_tca.errors import LoadedTCAError
from loaded_tca.loaded.pair_coupling import BendingModel
from loaded_tca.loaded.tooth_contact import GridChoice, LoadedContact, solve_under_load
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.slice_pressure import largest_slice_pressures
from loaded_tca.unloaded import ContactPoint, trace_contact
from validation.random_scenes import random_scene
from validation.table import Row

CASE, SOURCE = "error estimates of peak pressures", "the same contacts on 96 x 384 cells"
SCENES, CONTACTS = 25, 8
"""200 contacts in six minutes; 1000 of 125 scenes were judged when the estimate was chosen."""
ACCURACIES = (1e-2, 1e-3)
FINE = GridChoice(cells=(96, 384), free_edges=True, tolerance=1e-5)
LEAST_LOAD = 0.03
"""Of the force of the whole torque."""


class Estimate(NamedTuple):
    """Relative error of a peak pressure: estimated, and found; whether the contact ends at an edge or relief start."""

    rough: bool
    estimated: float
    error: float


def rows(scenes: int = SCENES) -> list[Row]:
    """Rows of smooth contacts and of those that are rough."""
    estimates = [one for seed in range(scenes) for one in estimates_of(seed)]
    found = []
    for name, rough in (("smooth contacts", False), ("at edges and relief starts", True)):
        ratios = np.array([one.error / one.estimated for one in estimates if one.rough == rough])
        share, count = float((ratios > 1.0).mean()), f"of {ratios.size}"
        found += [
            Row(CASE, SOURCE, f"{name}: share with an error above its estimate, {count}", 0.0, share, 0.01),
            Row(CASE, SOURCE, f"{name}: share with an error above twice its estimate", 0.0, (ratios > 2.0).mean(), 0.0),
        ]
    return found


def estimates_of(seed: int) -> Iterable[Estimate]:
    """Estimates of the contacts of a random scene."""
    rng, scene = np.random.default_rng(1000 + seed), random_scene(seed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        pair = scene.pair()
        bending = tooth_compliance(pair)
        path = trace_contact(pair, np.sort(rng.uniform(-1.0, 1.0, CONTACTS)) * pair.pitch)
        for contact in (path[n] for n in range(CONTACTS)):
            load = 1e3 * scene.load.pinion_torque_Nm / contact.pinion_lever * LEAST_LOAD ** rng.uniform()
            accuracy = float(rng.choice(ACCURACIES))
            if contact.in_contact and (found := _estimate(pair, contact, load, accuracy, bending)) is not None:
                yield found


def _estimate(
    pair: GearPair, contact: ContactPoint, load: float, accuracy: float, bending: BendingModel
) -> Estimate | None:
    """Estimate and error of one contact; None where it cannot carry its load."""
    try:
        grids = GridChoice(accuracy=accuracy, free_edges=True), FINE
        coarse, fine = (solve_under_load(pair, contact, load, grid, bending) for grid in grids)
    except LoadedTCAError:
        return None
    rough = coarse.is_rough
    return Estimate(rough, coarse.peak_error, abs(_peak(pair, coarse, rough) / _peak(pair, fine, rough) - 1.0))


def _peak(pair: GearPair, loaded: LoadedContact, rough: bool) -> float:
    """Peak pressure as results have it [MPa]."""
    if not rough:
        return loaded.solution.peak_pressure
    return largest_slice_pressures(pair, [(loaded.contact, loaded.separation, loaded.solution.pressure)])[0].pressure
