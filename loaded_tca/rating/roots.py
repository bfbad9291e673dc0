"""What roots withstand at the computed stress ratio of each place, and which place decides."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from loaded_tca.arrays import Array, Indices, Mask
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


def pressed_by_others(inputs: CommonInputs, place: int) -> Mask:
    """In which cases (c,) loads of the other flanks press all places of a root more than the mesh does.

    The place of the largest tension then decides, and not that of the smallest safety under the mesh alone.
    """
    loads, every = inputs.loads, np.arange(len(inputs.torque))
    assert loads.root_tension is not None  # asked before
    assert loads.largest_root_tension is not None
    assert loads.root_stress_ratio is not None
    by_others = inputs.cases.press_on_back > 0.0
    if by_others.any():
        tensions = loads.root_tension[:, place], loads.largest_root_tension[:, place]
        ratios = loads.root_stress_ratio[:, place], np.zeros(len(every))
        by_mesh, by_largest = (
            tension / local_root_factors(inputs, place, ratio, every)[1].strength
            for tension, ratio in zip(tensions, ratios, strict=True)
        )
        by_others &= by_largest >= by_mesh
    return by_others


def under_loads_of_both_flanks(inputs: CommonInputs, ratio: Array | float) -> Array:
    """Stress ratio R of roots (c,), and that of loads on both flanks of their teeth where it is less."""
    part = inputs.cases.press_on_back
    return np.where(part > 0.0, np.minimum(REVERSED * part, ratio), ratio)


def largest_places(inputs: CommonInputs, gear: int) -> tuple[Array, Array]:
    """Tangent angle [rad] and axial coordinate [mm] of the largest root tension of a gear under each torque (t,)."""
    stress = inputs.result.root_stress[gear]
    tension = stress.largest.reshape(len(stress.largest), -1)
    top = (tension == np.fmax.reduce(tension, axis=1)[:, None]).argmax(axis=1)  # NaN: not evaluated
    place = np.unravel_index(top, stress.largest.shape[1:])
    return stress.tangent_angle[place], stress.point[(*place, 2)]


LEVELS = 13
"""Of the stress ratio, from fully reversed to pulsating: between two of them strength is at least that of the lower."""


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

    That is not the largest tension where stress is reversed more beside it: strength falls with the stress ratio. A
    place decides only where its tension, over the strength at the level of the stress ratio below its own, comes up to
    that of the largest tension: so the strength of few places is computed.
    """
    result, stress = inputs.result, inputs.result.root_stress[gear]
    largest, smallest = (values.reshape(len(values), -1) for values in (stress.largest, stress.smallest))
    tops = np.fmax.reduce(largest, axis=1, initial=0.0)  # NaN: not evaluated
    every, top = np.arange(len(tops)), (largest == tops[:, None]).argmax(axis=1)
    levels = np.linspace(REVERSED, 0.0, LEVELS)[:, None] + np.zeros(len(tops))
    ratios = np.vstack([levels, stress_ratio(tops, smallest[every, top])])
    factors = local_root_factors(inputs, gear, ratios, every)[1]
    *_, of_top = strength = np.broadcast_to(factors.strength, ratios.shape)  # cast irons have one for all ratios
    reached = tops / of_top * (1.0 - ROUNDING)
    case, node = np.nonzero(largest > (reached * strength[0])[:, None])
    tension = largest[case, node]
    ratio = smallest[case, node] / tension
    level = np.clip((LEVELS - 1) * (1.0 - ratio / REVERSED), 0, LEVELS - 2).astype(int)
    some = tension > reached[case] * strength[level, case]
    case, node = case[some], node[some]
    use = np.zeros(largest.shape)
    use[case, node] = tension[some] / local_root_factors(inputs, gear, ratio[some], case)[1].strength
    decides = use.argmax(axis=1)
    there = np.fmax(largest[every, decides], 0.0)
    place = np.unravel_index(decides, stress.largest.shape[1:])
    above = np.nanmax(result.root_tension[..., gear], axis=1) / tops
    return Deciding(
        there * above,
        stress_ratio(there, smallest[every, decides]),
        stress.tangent_angle[place],
        stress.point[(*place, 2)],
        np.stack(place, axis=-1),
    )
