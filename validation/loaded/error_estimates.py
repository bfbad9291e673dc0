"""Estimated errors of peak pressures beside the errors against fine grids, over random contacts of all families.

Each contact carries a random part of its torque by itself at a random position, on the grid that a random accuracy
chooses, and on one four times as fine, of 192 x 384 cells at the most. Edges are free; the teeth bend in one scene of
five. Cylindrical pairs have end reliefs besides what random scenes have in one of three: where a relief begins the
curvature of the gap jumps. Contacts at rounded edges have random roundings; the columns there are made twice as fine.

The table has three scenes of each family in turn, with roundings one: 260 contacts; ``python -m validation --whole
loaded.error_estimates`` has all 1400.

What is an estimate worth? A user takes it for a bound: it may be too small for one contact in a hundred, and never by
more than half.
"""

import math
import warnings
from collections.abc import Iterator
from itertools import islice
from typing import NamedTuple

import numpy as np

from loaded_tca import AccuracyWarning
from loaded_tca.compliance import tooth_compliance
from loaded_tca.compliance.model import BendingModel
from loaded_tca.edges.arcs import reached_arcs
from loaded_tca.edges.rounded import pressure_at_rounded_edge
from loaded_tca.errors import LoadedTCAError
from loaded_tca.loaded.loaded_contact import LoadedContact
from loaded_tca.loaded.tooth_contact import GridChoice, solve_under_load
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.slice_pressure import largest_slice_pressures
from loaded_tca.scene import Scene
from loaded_tca.scene.cylindrical import CylindricalScene
from loaded_tca.unloaded import ContactPoint, trace_contact
from validation.loaded.rounded_edges import finer_columns
from validation.random_scenes import random_scene
from validation.table import Row

CASE, SOURCE = "error estimates of peak pressures", "the same contacts on grids four times as fine"
SCENES, ROUNDED_SCENES, CONTACTS = 27, 9, 8
ALL_SCENES, ALL_ROUNDED_SCENES = 130, 80
ACCURACIES = (1e-2, 1e-3)
FINER, FINEST, FINER_COLUMNS = 4, (192, 384), 2.0
LEAST_LOAD, LEAST_AT_ROUNDING = 0.03, 0.05
"""Of the force of the whole torque."""
BENDING, END_RELIEF = 0.2, 1.0 / 3.0
"""Parts of the scenes."""
ROUNDINGS = (0.02, 0.29)
"""Over the module."""
KINDS = "smooth contacts", "at edges and relief starts", "at rounded edges"


class Estimate(NamedTuple):
    """Relative error of a peak pressure: estimated, and found; kind of the contact."""

    kind: str
    estimated: float
    error: float


def rows() -> list[Row]:
    """Rows of each kind of contacts: shares whose errors are above their estimates, and the median of the ratio."""
    return _rows_of(SCENES, ROUNDED_SCENES)


def whole_rows() -> list[Row]:
    """The same of all scenes."""
    return _rows_of(ALL_SCENES, ALL_ROUNDED_SCENES)


def _rows_of(scenes: int, rounded_scenes: int) -> list[Row]:
    estimates = [one for seed in range(scenes) for one in estimates_of(seed)]
    return _rows([*estimates, *(one for seed in range(rounded_scenes) for one in estimates_at_roundings(seed))])


def short_rows() -> list[Row]:
    """The same of the first contacts of three scenes."""
    return _rows([*islice(estimates_of(5), 1), *islice(estimates_of(0), 1), *islice(estimates_at_roundings(0), 1)])


def _rows(estimates: list[Estimate]) -> list[Row]:
    table = []
    for kind in KINDS:
        ratios = np.array([one.error / one.estimated for one in estimates if one.kind == kind])
        share, count, worst = float((ratios > 1.0).mean()), f"of {ratios.size}", f"at the most {ratios.max():.2f} of it"
        median = float(np.median(1.0 / np.maximum(ratios, 1e-6)))
        table += [
            Row(CASE, SOURCE, f"{kind}: share with an error above its estimate, {count}", 0.0, share, 0.01, note=worst),
            Row(CASE, SOURCE, f"{kind}: share with an error above twice its estimate", 0.0, (ratios > 2.0).mean(), 0.0),
            Row(CASE, SOURCE, f"{kind}: estimate over error, median", 1.0, median, None),
        ]
    return table


def estimates_of(seed: int) -> Iterator[Estimate]:
    """Estimates of the contacts of a random scene."""
    rng = np.random.default_rng(1000 + seed)
    scene = random_scene(seed)
    if isinstance(scene, CylindricalScene) and rng.random() < END_RELIEF:
        scene = _with_end_reliefs(scene, rng)
    for pair, contact, load, accuracy, bending in _contacts(scene, rng, LEAST_LOAD):
        try:
            coarse = solve_under_load(pair, contact, load, GridChoice(accuracy=accuracy, free_edges=True), bending)
            across, along = (min(FINER * n, most) for n, most in zip(_cells(coarse), FINEST, strict=True))
            fine = solve_under_load(
                pair, contact, load, GridChoice((across, along), free_edges=True, tolerance=1e-5), bending
            )
        except LoadedTCAError:
            continue  # it cannot carry its load
        rough = coarse.is_rough
        error = abs(_peak(pair, coarse, rough) / _peak(pair, fine, rough) - 1.0)
        yield Estimate(KINDS[rough], coarse.peak_error, error)


def estimates_at_roundings(seed: int) -> Iterator[Estimate]:
    """Estimates of the contacts of a random scene at edges that are rounded."""
    rng = np.random.default_rng(9000 + seed)
    scene = random_scene(seed)
    low, high = np.log(ROUNDINGS)
    tip, side = scene.pair().module * np.exp(rng.uniform(low, high, 2))
    radii = {f"{gear}.tip_rounding_mm": float(tip) for gear in ("pinion", "wheel")}
    radii |= {f"{gear}.side_rounding_mm": float(side) for gear in ("pinion", "wheel")}
    try:
        scene = scene.with_changes(radii)
        scene.pair()
    except LoadedTCAError:
        return  # no room for such roundings
    for pair, contact, load, accuracy, bending in _contacts(scene, rng, LEAST_AT_ROUNDING):
        try:
            loaded = solve_under_load(pair, contact, load, GridChoice(accuracy=accuracy, free_edges=True), bending)
            if not loaded.at_arc or not (edges := reached_arcs(pair, loaded)):
                continue
            peak = pressure_at_rounded_edge(pair, loaded, edges, bending, 0, free_edges=True)
            if math.isnan(peak.pressure) or math.isinf(peak.error):
                continue
            with finer_columns(FINER_COLUMNS):
                fine = pressure_at_rounded_edge(pair, loaded, edges, bending, 0, free_edges=True)
        except LoadedTCAError:
            continue
        yield Estimate(KINDS[2], peak.error, abs(peak.pressure / fine.pressure - 1.0))


def _contacts(
    scene: Scene, rng: np.random.Generator, least_load: float
) -> Iterator[tuple[GearPair, ContactPoint, float, float, BendingModel | None]]:
    """Contacts of a scene at random positions, each with its pair, a load [N], an accuracy and the bending."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        pair = scene.pair()
        bending = tooth_compliance(pair) if rng.random() < BENDING else None
        path = trace_contact(pair, np.sort(rng.uniform(-1.0, 1.0, CONTACTS)) * pair.pitch)
        for contact in (path[n] for n in range(CONTACTS)):
            load = 1e3 * scene.load.pinion_torque_Nm / contact.pinion_lever * least_load ** rng.uniform()
            accuracy = float(rng.choice(ACCURACIES))
            if contact.in_contact:
                yield pair, contact, load, accuracy, bending


def _with_end_reliefs(scene: CylindricalScene, rng: np.random.Generator) -> Scene:
    """The scene with reliefs at both ends of the wheel, and no helix slope."""
    width = scene.wheel.face_width_mm
    return scene.with_changes(
        {
            "wheel.modifications.end_relief_um": float(rng.uniform(5.0, 30.0)),
            "wheel.modifications.end_relief_length_mm": float(width * rng.uniform(0.1, 0.45)),
            "pinion.modifications.helix_slope_um": 0.0,
        }
    )


def _cells(loaded: LoadedContact) -> tuple[int, int]:
    across, along = loaded.solution.pressure.shape
    return across, along


def _peak(pair: GearPair, loaded: LoadedContact, rough: bool) -> float:
    """Peak pressure as results have it [MPa]."""
    if not rough:
        return loaded.solution.peak_pressure
    return largest_slice_pressures(pair, [(loaded.contact, loaded.separation, loaded.solution.pressure)])[0].pressure
