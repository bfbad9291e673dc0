"""The rating of a result: inputs, stresses, lives, and what its warnings say."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.arguments import checked
from loaded_tca.arrays import GEARS, Array
from loaded_tca.errors import give_accuracy_warning
from loaded_tca.rating.bevel import BevelInputs, bevel_evaluated, bevel_inputs_of
from loaded_tca.rating.both_sides import as_coast_side, evaluated_together
from loaded_tca.rating.evaluate import Evaluated, evaluated
from loaded_tca.rating.inputs import CommonInputs, Duty, RatingInputs, inputs_of
from loaded_tca.rating.interpolation import interpolation_error
from loaded_tca.rating.lives import Endurances, lives_of
from loaded_tca.rating.quantities import UNDER_LOAD
from loaded_tca.rating.rating import WORDS, Rating
from loaded_tca.rating.solved import SolvedLoads, solved_loads
from loaded_tca.rating.spectrum import SpectrumRating, of_spectrum
from loaded_tca.results.summary import shown_torque
from loaded_tca.results.warnings import accuracy_of_edge, highest_edges
from loaded_tca.scene.spiral import SpiralScene

if TYPE_CHECKING:
    from loaded_tca.results.numbers import CycleNumbers


@checked
def rating_of(
    result: CycleNumbers, *, duty: Duty = Duty(), coast: CycleNumbers | None = None, warn: bool = True
) -> Rating:
    """Rating of a result; see :meth:`loaded_tca.MeshCycle.rating`.

    Parameters
    ----------
    result : MeshCycle
    duty : Duty
        How gears are loaded by other mates, as those of a planetary stage.
    coast : MeshCycle, optional
        Result of ``scene.coast_side()``, whose flanks carry the reversed bins of a load spectrum.
    warn : bool
        Whether accuracy warnings are given.

    Returns
    -------
    Rating
    """
    inputs, error = _solved_inputs(result, duty), np.zeros(0)
    if coast is not None:
        beside = _solved_inputs(as_coast_side(coast, result), duty)
        (arrays, endurances, notes), error = evaluated_together(inputs, beside, _evaluated)
    else:
        arrays, endurances, notes = _evaluated(inputs)
        if inputs.cases.is_spectrum:
            error = interpolation_error(inputs, endurances, _evaluated)
    arrays |= lives_of(inputs.cases, endurances, inputs.cycles_per_hour)
    arrays |= {name: _loaded(inputs.torque, arrays[name]) for name in UNDER_LOAD if name in arrays}
    results = [part for part, _ in duty.parts] or [result]
    sentences = [*_edges_left_out([*results, *filter(None, [coast])]), *_above_static(inputs, endurances)]
    kind: type[Rating] = Rating
    if inputs.cases.is_spectrum:
        kind = SpectrumRating
        more, remarks, warned = of_spectrum(inputs, arrays, error, of_both_sides=coast is not None)
        arrays, notes, sentences = arrays | more, (*notes, *remarks), [*sentences, *warned]
    about: dict[str, Any] = {"version": result.version, "warnings": "\n".join(sentences)}
    dataset = kind.dataset_of(arrays, {"gear": GEARS, "mode": [*endurances]}, **about)
    for sentence in sentences if warn else ():
        give_accuracy_warning(sentence)
    return kind(result, dataset, inputs, endurances, notes)


def _loaded(torque: Array, values: Array) -> Array:
    """Values (c, ...) under torques (c,); NaN under none."""
    return np.where((torque > 0.0).reshape(-1, *[1] * (values.ndim - 1)), values, np.nan)


def _solved_inputs(result: CycleNumbers, duty: Duty) -> CommonInputs:
    """What a rating takes of a result, with its solved loads, or those of the parts of the duty."""
    with_factors = bevel_inputs_of(result) if isinstance(result.scene, SpiralScene) else inputs_of(result, duty)
    if not duty.parts:
        return replace(with_factors, solved=solved_loads(with_factors))
    parts = [(solved_loads(inputs_of(part, duty)), torques) for part, torques in duty.parts]
    return replace(
        with_factors,
        solved=SolvedLoads.joined([solved.at(torques) for solved, torques in parts]),
        nearest=SolvedLoads.joined([solved.by_nearest(torques) for solved, torques in parts]),
    )


def _edges_left_out(results: Sequence[CycleNumbers]) -> Iterator[str]:
    """Sentence of the largest pressure at an edge of results, where it is above the peak pressure of its torque."""
    every = [(result, (torque, *place)) for result in results for torque, place in highest_edges(result).items()]
    if every:
        result, at = max(every, key=lambda one: float(one[0].edge_pressure[one[1]]))
        yield kinds.EDGES_NOT_RATED.sentence(
            pressure=float(result.edge_pressure[at]),
            torque=f"{shown_torque(result.torque[at[0]])} at the pinion",
            accuracy=accuracy_of_edge(result, at),
            peak=float(np.nanmax(result.peak_pressure[at[0]])),
        )


def _above_static(inputs: CommonInputs, endurances: Endurances) -> Iterator[str]:
    """Sentence of the case of each kind of failure of each gear that is the farthest above the static strength."""
    for mode, both in endurances.items():
        for gear, each in zip(GEARS, both, strict=True):
            worst = int((over := each.over_static()).argmax())
            if over[worst] > 1.0:
                stress = float(each.stress[worst])
                yield kinds.ABOVE_STATIC_STRENGTH.sentence(
                    where=f"{WORDS[mode]}, {gear}",
                    stress=stress,
                    strength=stress / float(over[worst]),
                    torque=inputs.torque_in_words(float(inputs.torque[worst]), gear=True),
                )


def numbers_of(inputs: CommonInputs) -> Evaluated:
    """Numbers with damage and lives, endurances and notes, after the standard of the gears."""
    arrays, endurances, notes = _evaluated(inputs)
    return arrays | lives_of(inputs.cases, endurances, inputs.cycles_per_hour), endurances, notes


def _evaluated(inputs: CommonInputs) -> Evaluated:
    """Numbers, endurances and notes after the standard of the gears."""
    if isinstance(inputs, BevelInputs):
        return bevel_evaluated(inputs)
    assert isinstance(inputs, RatingInputs)
    return evaluated(inputs)
