"""Accuracy warnings of tribology: limits of the standards, extremes at edges or between positions."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.tribology.slices import cylindrical_mesh

if TYPE_CHECKING:
    from loaded_tca.tribology.tribology import Tribology

MOVES = 0.02
"""Relative change of an extreme that half as many positions may make, twice over: its error is about half of that."""
VELOCITIES = 1.0, 60.0
"""Pitch line velocities [m/s] for which coefficients of friction of the standards were fitted."""
LOOKED_AT = {
    "largest_contact_temperature": ("flash_temperature", "largest flash temperature"),
    "least_film_thickness": ("film_thickness", "least film thickness"),
}
"""Extremes that a warning may tell: the number of tooth pairs behind each, and its name."""


def accuracy_sentences(tribology: Tribology) -> Iterator[str]:
    """Yield why numbers are less exact than others: sentences of accuracy warnings."""
    result, given = tribology.result, tribology.conditions
    oil, bulk = given.lubricant, given.bulk_temperature
    if bulk is not None and oil is not None and bulk < oil.oil_temperature:
        yield kinds.COLD_BULK.sentence(bulk=bulk, oil=oil.oil_temperature)
    mesh = cylindrical_mesh(result)
    if mesh is not None and isinstance(given.friction, str) and np.isfinite(given.speeds).all():
        velocities = given.speeds * (2e-3 * math.pi / 60.0 * mesh.pinion_working_radius)
        low, high = VELOCITIES
        beyond = velocities[(velocities < low) | (velocities > high)]
        if beyond.size:
            yield kinds.PITCH_VELOCITY.sentence(velocity=float(beyond[0]), low=low, high=high)
    if tribology.sweep.capped:
        yield kinds.SLICES_AT_CAP.sentence()
    if not tribology.lacking("loss_factor"):
        yield from _of_loss(tribology)
    for name, (of_pairs, words) in LOOKED_AT.items():
        if not tribology.lacking(name):
            yield from _of_extreme(tribology, name, of_pairs, words)


def _of_loss(tribology: Tribology) -> Iterator[str]:
    """Where half of the positions find another loss factor."""
    whole, half = tribology.loss_factor, tribology.loss_factor_of_half
    change = float(np.abs(half / whole - 1.0)[whole > 0.0].max(initial=0.0))
    if change > 2.0 * MOVES:
        yield kinds.EXTREME_MOVES.sentence(extreme="loss factor", change=change)


def _of_extreme(tribology: Tribology, name: str, of_pairs: str, words: str) -> Iterator[str]:
    """Where an extreme lies at an edge, and where half of the positions find another one."""
    if tribology.extreme_on_edge(name):
        yield kinds.EXTREME_AT_EDGE.sentence(extreme=words)
    values = tribology.with_speeds(of_pairs)
    if values.shape[2] < 5 or values.shape[2] % 2 == 0:
        return
    worst = np.fmin if name.startswith("least") else np.fmax
    whole, half = (worst.reduce(some, axis=(2, 3)) for some in (values, values[:, :, ::2]))
    known = np.isfinite(whole) & np.isfinite(half) & (whole > 0.0) & (half > 0.0)
    change = float(np.abs(half[known] / whole[known] - 1.0).max(initial=0.0))
    if change > 2.0 * MOVES:
        yield kinds.EXTREME_MOVES.sentence(extreme=words, change=change)
