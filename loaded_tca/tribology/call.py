"""The call of tribology on a result, and what it warns of."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

import loaded_tca.warning_kinds as kinds
from loaded_tca.arguments import checked
from loaded_tca.errors import give_accuracy_warning
from loaded_tca.results.numbers import CycleNumbers
from loaded_tca.tribology.conditions import Lubricant, conditions_of
from loaded_tca.tribology.slices import cylindrical_mesh
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


@checked
def tribology_of(
    result: CycleNumbers,
    *,
    pinion_speed_rpm: ArrayLike | None = None,
    lubricant: Lubricant | None = None,
    roughness_um: Sequence[float | None] | None = None,
    application_factor: float | None = None,
    dynamic_factor: float | None = None,
    friction: str | float | None = None,
    bulk_temperature_C: float | None = None,
    scuffing_load_stage: float | None = None,
    permissible_film_ratio: float | None = None,
    supply: str | None = None,
    warn: bool = True,
) -> Tribology:
    """Tribology of a result; see :meth:`loaded_tca.MeshCycle.tribology`, whose arguments are these.

    Parameters
    ----------
    result : MeshCycle
    pinion_speed_rpm, lubricant, roughness_um, application_factor, dynamic_factor, friction, bulk_temperature_C,\
 scuffing_load_stage, permissible_film_ratio, supply
        As there.
    warn : bool
        Whether accuracy warnings are given.

    Returns
    -------
    Tribology
    """
    conditions = conditions_of(
        result.scene,
        cylindrical=cylindrical_mesh(result) is not None,
        pinion_speed_rpm=pinion_speed_rpm,
        lubricant=lubricant,
        roughness_um=roughness_um,
        application_factor=application_factor,
        dynamic_factor=dynamic_factor,
        friction=friction,
        bulk_temperature_C=bulk_temperature_C,
        scuffing_load_stage=scuffing_load_stage,
        permissible_film_ratio=permissible_film_ratio,
        supply=supply,
    )
    tribology = Tribology(result, conditions)
    if warn:
        _warn(tribology)
    return tribology


def _warn(tribology: Tribology) -> None:
    result, given = tribology.result, tribology.conditions
    oil, bulk = given.lubricant, given.bulk_temperature
    if bulk is not None and oil is not None and bulk < oil.oil_temperature:
        give_accuracy_warning(kinds.COLD_BULK.sentence(bulk=bulk, oil=oil.oil_temperature), stacklevel=4)
    mesh = cylindrical_mesh(result)
    if mesh is not None and isinstance(given.friction, str) and np.isfinite(given.speeds).all():
        velocities = given.speeds * (2e-3 * math.pi / 60.0 * mesh.pinion_working_radius)
        low, high = VELOCITIES
        beyond = velocities[(velocities < low) | (velocities > high)]
        if beyond.size:
            sentence = kinds.PITCH_VELOCITY.sentence(velocity=float(beyond[0]), low=low, high=high)
            give_accuracy_warning(sentence, stacklevel=4)
    if tribology.sweep.capped:
        give_accuracy_warning(kinds.SLICES_AT_CAP.sentence(), stacklevel=4)
    if not tribology.lacking("loss_factor"):
        _warn_of_loss(tribology)
    for name, (of_pairs, words) in LOOKED_AT.items():
        if not tribology.lacking(name):
            _warn_of_extreme(tribology, name, of_pairs, words)


def _warn_of_loss(tribology: Tribology) -> None:
    """Warn where half of the positions find another loss factor."""
    whole, half = tribology.loss_factor, tribology.loss_factor_of_half
    change = float(np.abs(half / whole - 1.0)[whole > 0.0].max(initial=0.0))
    if change > 2.0 * MOVES:
        give_accuracy_warning(kinds.EXTREME_MOVES.sentence(extreme="loss factor", change=change), stacklevel=5)


def _warn_of_extreme(tribology: Tribology, name: str, of_pairs: str, words: str) -> None:
    """Warn where an extreme lies at an edge, and where half of the positions find another one."""
    if tribology.extreme_on_edge(name):
        give_accuracy_warning(kinds.EXTREME_AT_EDGE.sentence(extreme=words), stacklevel=5)
    values = tribology.with_speeds(of_pairs)
    if values.shape[2] < 5 or values.shape[2] % 2 == 0:
        return
    worst = np.fmin if name.startswith("least") else np.fmax
    whole, half = (worst.reduce(some, axis=(2, 3)) for some in (values, values[:, :, ::2]))
    known = np.isfinite(whole) & np.isfinite(half) & (whole > 0.0) & (half > 0.0)
    change = float(np.abs(half[known] / whole[known] - 1.0).max(initial=0.0))
    if change > 2.0 * MOVES:
        give_accuracy_warning(kinds.EXTREME_MOVES.sentence(extreme=words, change=change), stacklevel=5)
