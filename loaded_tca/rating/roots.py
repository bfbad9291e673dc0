"""What roots withstand at the computed stress ratio of each place, and which place decides."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from loaded_tca.arrays import Array, Indices
from loaded_tca.errors import InputError
from loaded_tca.reference import iso6336_3

if TYPE_CHECKING:
    from loaded_tca.rating.inputs import CommonInputs


REVERSED = -1.2
"""Smallest over largest root stress where both flanks of a tooth carry the same load (ISO 6336-3, annex B)."""


def root_of(inputs: CommonInputs, place: int) -> tuple[iso6336_3.RootStrength, dict[str, Any]]:
    """Material of the root of a gear, and what else the factors of its strength take in any load case."""
    strength, section = inputs.strengths[place], inputs.root_section(place)
    made_of = iso6336_3.RootStrength(
        strength.limits[1], strength.kind_of_material, strength.root_Rz_um, strength.proof_stress_MPa
    )
    return made_of, {
        "notch_parameter": section.notch_parameter,
        "stress_correction_factor": section.stress_correction_factor,
        "normal_module": inputs.normal_module,
        "long_life_factor": inputs.rating.long_life_factor,
        "mean_stress_factor": inputs.duty.mean_stress_factors[place],
        "of_bevels": inputs.of_bevels,
    }


def local_root_factors(
    inputs: CommonInputs, place: int, ratio: Array, case: Indices | int
) -> tuple[Array, iso6336_3.RootFactors, tuple[str, ...]]:
    """Stress ratio R that counts of computed ones, factors of root strength with it, and notes.

    ``case`` is the index of the load case of each ratio, or of all: other mates press a root more than the mesh does.
    """
    made_of, common = root_of(inputs, place)
    cycles, of_mates = inputs.cycles[case, place], inputs.loads.mate_stress_ratios
    highest = np.full(len(inputs.torque), inputs.strengths[place].root_stress_ratio)
    if of_mates is not None:
        highest = np.where(np.isnan(of_mates[:, place]), highest, of_mates[:, place])
    highest = under_loads_of_both_flanks(inputs, highest)
    ratio = np.clip(np.minimum(ratio, highest[case]), REVERSED, 0.0)
    try:
        return ratio, iso6336_3.root_factors(made_of, cycles=cycles, stress_ratio=ratio, **common), ()
    except InputError:  # cast irons, of which the standard has no sensitivity
        note = "local Y_M: the standard has no mean stress sensitivity for this material; Y_M is taken as 1"
        return ratio, iso6336_3.root_factors(made_of, cycles=cycles, **common), (note,)


def under_loads_of_both_flanks(inputs: CommonInputs, ratio: Array | float) -> Array:
    """Stress ratio R of roots (c,), and that of loads on both flanks of their teeth where it is less."""
    part = inputs.cases.press_on_back
    return np.where(part > 0.0, np.minimum(REVERSED * part, ratio), ratio)


def largest_places(inputs: CommonInputs, gear: int) -> tuple[Array, Array]:
    """Tangent angle [rad] and axial coordinate [mm] of the largest root tension of a gear under each torque (t,)."""
    stress = inputs.result.root_stress[gear]
    tension = np.nan_to_num(stress.largest, nan=-np.inf)  # NaN: not evaluated
    place = np.unravel_index(tension.reshape(len(tension), -1).argmax(axis=1), tension.shape[1:])
    return stress.tangent_angle[place], stress.point[(*place, 2)]


LEAST_MEAN_STRESS_FACTOR = 0.45
"""Y_M is above it for any material and R down to -1.2: less tension than this part of the largest never decides."""


ROUNDING = 1e-9
"""Of strengths, by which places that decide alike are not left out."""


def stress_ratio(largest: Array, smallest: Array) -> Array:
    """R of the extremes of a turn; 0 where no tension is."""
    return np.divide(smallest, largest, out=np.zeros(largest.shape), where=largest > 0.0)


class Deciding(NamedTuple):
    """Where the smallest local safety of a root lies, under each torque (t,).

    Attributes
    ----------
    tension : array [MPa]
        Largest stress of a turn there, by what the largest of all exceeds the nodes.
    ratio : array
        Smallest over largest stress there.
    tangent_angle : array [rad]
        Of the fillet to the middle of the tooth.
    axial : array [mm]
        On the gear itself.
    node : (t, 3) array of int
        Side, station and place along the face.
    """

    tension: Array
    ratio: Array
    tangent_angle: Array
    axial: Array
    node: Indices


def deciding_places(inputs: CommonInputs, gear: int) -> Deciding:
    """Places of the smallest strength over tension of the root of one gear.

    That is not the largest tension where stress is reversed more beside it: strength falls with the stress ratio, so
    that a place decides only where its tension, over the strength at the lowest ratio, comes up to the largest one's.
    """
    result, stress = inputs.result, inputs.result.root_stress[gear]
    largest = np.where(stress.largest > 0.0, stress.largest, 0.0)  # NaN: not evaluated
    tops = largest.reshape(len(largest), -1).max(axis=1)
    ratio, every = stress_ratio(largest, stress.smallest), np.arange(len(tops))
    tense = largest > LEAST_MEAN_STRESS_FACTOR * tops[:, None, None, None]
    lowest = np.where(tense, ratio, 0.0).reshape(len(tops), -1).min(axis=1)
    at_top = ratio.reshape(len(tops), -1)[every, largest.reshape(len(tops), -1).argmax(axis=1)]
    bounds = local_root_factors(inputs, gear, np.array([lowest, at_top]), every)[1].strength
    reached = tops * (bounds[0] / bounds[1]) * (1.0 - ROUNDING)
    some = np.nonzero(tense & (largest >= reached[:, None, None, None]))
    use = np.zeros(largest.shape)
    use[some] = largest[some] / local_root_factors(inputs, gear, ratio[some], some[0])[1].strength
    flat = use.reshape(len(use), -1).argmax(axis=1)
    place = every, *np.unravel_index(flat, use.shape[1:])
    above = np.nanmax(result.root_tension[..., gear], axis=1) / tops
    return Deciding(
        largest[place] * above,
        ratio[place],
        stress.tangent_angle[place[1:]],
        stress.point[(*place[1:], 2)],
        np.stack(place[1:], axis=-1),
    )
