"""The rating of a result: inputs, stresses, lives, and what its warnings say."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import loaded_tca.warning_kinds as kinds
from loaded_tca.arguments import checked
from loaded_tca.arrays import GEARS
from loaded_tca.errors import give_accuracy_warning
from loaded_tca.rating.evaluate import evaluated
from loaded_tca.rating.inputs import inputs_of
from loaded_tca.rating.lives import lives_of
from loaded_tca.rating.rating import Rating
from loaded_tca.rating.spectrum import SpectrumRating, of_spectrum

if TYPE_CHECKING:
    from loaded_tca.results.numbers import CycleNumbers


@checked
def rating_of(result: CycleNumbers, *, warn: bool = True) -> Rating:
    """Rating of a result; see :meth:`loaded_tca.MeshCycle.rating`.

    Parameters
    ----------
    result : MeshCycle
    warn : bool
        Whether accuracy warnings are given.

    Returns
    -------
    Rating
    """
    inputs = inputs_of(result)
    cases = inputs.cases
    arrays, endurances, notes = evaluated(inputs)
    arrays |= lives_of(cases, endurances, inputs.cycles_per_hour)
    sentences = [kinds.RATED_AT_EDGE.sentence()] if inputs.loads.at_edge.any() else []
    kind: type[Rating] = Rating
    if cases.is_spectrum:
        kind = SpectrumRating
        more, remarks, told = of_spectrum(inputs, arrays)
        arrays, notes, sentences = arrays | more, (*notes, *remarks), [*sentences, *told]
    about: dict[str, Any] = {"version": result.version, "warnings": "\n".join(sentences)}
    dataset = kind.dataset_of(arrays, **about).assign_coords(gear=[*GEARS], mode=[*endurances])
    for sentence in sentences if warn else ():
        give_accuracy_warning(sentence, stacklevel=3)
    return kind(result, dataset, endurances, notes)
