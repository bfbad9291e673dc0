"""How far to trust the damage of a spectrum whose stresses are interpolated between torques that were solved."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import inf, nan
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arrays import GEARS, Array
from loaded_tca.rating.evaluate import Evaluated
from loaded_tca.rating.lives import LOCAL_FLANK, LOCAL_ROOT, Endurance, Endurances, damages_of
from loaded_tca.rating.solved import OF_FLANK, OF_ROOT
from loaded_tca.scene.rating import ANALYSIS

if TYPE_CHECKING:
    from loaded_tca.rating.inputs import CommonInputs

FEWEST_SOLVED = 4
"""Torques, of fewer of which leaving out every second one says nothing of the interpolation."""
NEIGHBOURS = 4
"""Torques whose polynomial says where the one between them would be without scatter."""
MEDIAN = 0.6745
"""Median of the magnitude of a normal deviate over its standard deviation."""
Evaluate = Callable[["CommonInputs"], Evaluated]
"""What gives the numbers of inputs after the standard of the gears."""


def interpolation_error(inputs: CommonInputs, endurances: Endurances, evaluate: Evaluate) -> Array:
    """By which part the damage of all bins (gear, mode) may be wrong; 0 where all torques were solved.

    The sum of two errors, over the damage, or over 1 where there is none:

    - the change of the damage of each bin where every second torque is left out, and where its stress differs as much
      the other way: a stress just below the end of its curve does no damage, a little more of it does. Where bins lie
      below the smallest torque, this is left out, too.
    - the change where solved loads scatter: each torque alone by the scatter of all, since one scatters independently
      of the other, and the root of the sum of their squares.

    Where several results have the torques, the change is added where each torque has the stresses of the nearest one
    that its result was solved for, rather than those between.
    """
    error = _between_torques(inputs, endurances, evaluate)
    if inputs.nearest is None:
        return error
    damage = damages_of(endurances)
    _, nearest, _ = evaluate(replace(inputs, solved=inputs.nearest))
    return error + _part_of(damage, _changes(damage, damages_of(nearest)).sum(axis=0))


def _between_torques(inputs: CommonInputs, endurances: Endurances, evaluate: Evaluate) -> Array:
    """The two errors (gear, mode) of bins between torques that were solved."""
    solved, torques = inputs.solved, inputs.cases.factor_torque
    between = inputs.cases.between(solved.torque)
    damage = damages_of(endurances)
    if not between.any():
        return np.zeros(damage.shape[1:])
    if len(solved.torque) < FEWEST_SOLVED:
        return np.full(damage.shape[1:], nan)
    first = int((torques[between] < solved.torque[0]).any())
    _, coarse, _ = evaluate(replace(inputs, solved=solved.every_second(first)))
    changes = np.maximum(*(_changes(damage, damages_of(one)) for one in (coarse, _mirrored(endurances, coarse))))
    raised = _changes(damage, damages_of(_raised(inputs, endurances)))
    by_scatter = _by_node(raised[between], solved.torque, torques[between])
    return _part_of(damage, changes.sum(axis=0) + np.sqrt(np.sum(by_scatter**2, axis=0)))


def _part_of(damage: Array, together: Array) -> Array:
    """Errors (gear, mode) over the damage (c, gear, mode) of all bins, or over 1 where there is none."""
    total = damage.sum(axis=0)
    with np.errstate(invalid="ignore"):  # both without end: a bin above the static strength, whatever the others do
        part = together / np.where(total == 0.0, 1.0, total)
    return np.where(np.isinf(total), 0.0, part)


def _changes(damage: Array, other: Array) -> Array:
    """By how much damages (c, gear, mode) differ; 0 where both are without end."""
    with np.errstate(invalid="ignore"):
        return np.where(other == damage, 0.0, np.abs(other - damage))


def _mirrored(endurances: Endurances, coarse: Endurances) -> Endurances:
    """Endurances whose stresses differ from the coarse ones the other way, by the same factor."""

    def of(fine: Endurance, other: Endurance) -> Endurance:
        ratio = np.divide(fine.stress, other.stress, out=np.ones(fine.stress.shape), where=other.stress > 0.0)
        return replace(fine, stress=fine.stress * ratio)

    pairs = {mode: zip(endurances[mode], coarse[mode], strict=True) for mode in endurances}
    return {mode: (of(*pinion), of(*wheel)) for mode, (pinion, wheel) in pairs.items()}


def _raised(inputs: CommonInputs, endurances: Endurances) -> Endurances:
    """Endurances whose stresses are larger by what solved loads scatter from torque to torque."""
    solved, wanted = inputs.solved, inputs.rating
    of_factors = sum(
        float(scatter(solved.torque, getattr(solved, name)))
        for name in ("face_load_factor", "transverse_load_factor")
        if getattr(wanted, name) == ANALYSIS
    )
    of_sharing = float(scatter(solved.torque, solved.mesh_load_factor))
    local = {LOCAL_FLANK: np.full(len(GEARS), scatter(solved.torque, solved.pressure, OF_FLANK))}
    if solved.root_tension is not None:
        local[LOCAL_ROOT] = scatter(solved.torque, solved.root_tension, OF_ROOT)

    def of(mode: str, gear: int) -> Endurance:
        endurance = endurances[mode][gear]
        part = local[mode][gear] if mode in local else endurance.power * of_factors
        return replace(endurance, stress=endurance.stress * np.exp(part + endurance.power * of_sharing))

    return {mode: (of(mode, 0), of(mode, 1)) for mode in endurances}


def scatter(torques: Array, values: Array, power: float = 0.0) -> Array:
    """Standard deviation of positive values (n, ...) about a smooth law over ascending torques (n,), relative to it.

    By the median of what each value differs from a polynomial through two neighbours on both sides, in logarithms: a
    kink at one torque, and the bend at the smallest, do not count as scatter. NaN where a value is.
    """
    nodes = np.log(torques)
    rest = np.log(values) - power * nodes.reshape(-1, *[1] * (values.ndim - 1))
    count, differences = len(nodes), []
    for place in range(1, count - 1):
        start = min(max(place - NEIGHBOURS // 2, 0), max(count - NEIGHBOURS - 1, 0))
        others = [other for other in range(start, min(start + NEIGHBOURS + 1, count)) if other != place]
        apart = nodes[others][:, None] - nodes[others]
        parts = np.divide(nodes[place] - nodes[others], apart, out=np.ones(apart.shape), where=apart != 0.0)
        weights = parts.prod(axis=1)
        smooth = np.tensordot(weights, rest[others], 1)
        differences.append(np.abs(rest[place] - smooth) / np.sqrt(1.0 + weights @ weights))
    return np.asarray(np.median(differences, axis=0) / MEDIAN)


def _by_node(changes: Array, nodes: Array, torques: Array) -> Array:
    """Changes (n, ...) that those of bins (c, ...) have of each node: stresses follow them linearly in logarithms."""
    wanted, places = np.log(torques), np.log(nodes)
    shares = np.stack([np.interp(wanted, places, unit) for unit in np.eye(len(nodes))])
    endless = np.isinf(changes)
    sums = np.tensordot(shares, np.where(endless, 0.0, changes), 1)
    return np.where(endless.any(axis=0), inf, sums)
