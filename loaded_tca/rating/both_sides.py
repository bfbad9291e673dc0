"""Both flanks of each gear under a load spectrum with reversed bins: results of both sides, rated together.

Each side is rated under the bins that load its flanks, by its own analysis. Pitting of a flank sums up the bins that it
carries itself; a root carries all of them, reversed ones with the loads of the coast side.
"""

from __future__ import annotations

from dataclasses import fields, replace
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arrays import GEARS, Array, Mask
from loaded_tca.errors import InputError
from loaded_tca.rating.interpolation import Evaluate, interpolation_error
from loaded_tca.rating.lives import COAST, ROOTS, Endurance, damages_of

if TYPE_CHECKING:
    from loaded_tca.rating.evaluate import Evaluated
    from loaded_tca.rating.inputs import CommonInputs
    from loaded_tca.results.numbers import CycleNumbers

BESIDE = "title", "load", "rating", "operation", "lubricant", "analysis"
"""Sections of a scene in which the results of both sides may differ: those of the drive side count."""


def as_coast_side(coast: CycleNumbers, drive: CycleNumbers) -> CycleNumbers:
    """The result of a coast side with what is required in the scene of the drive side.

    Raises
    ------
    InputError
        If it is not the coast side of that scene, no bin is reversed, or one of both alone has root stress.
    """
    if not any(case.reversed for case in drive.scene.load.case or ()):
        raise InputError("coast: the scene has no load spectrum with reversed bins, which load the coast side")
    asked = drive.scene.analysis.root_stress
    if coast.scene.analysis.root_stress != asked:
        raise InputError(
            f"coast: analysis.root_stress is not {str(asked).lower()}, as on the drive side; give both the same value"
        )
    expected = drive.scene.coast_side()
    for part in fields(expected):
        if part.name in BESIDE:
            continue
        wanted, present = getattr(expected, part.name), getattr(coast.scene, part.name)
        if part.name in GEARS:
            wanted, present = replace(wanted, strength=None), replace(present, strength=None)
        if wanted != present:
            section = part.name.replace("geometry", "pair")
            raise InputError(f"coast: the section [{section}] of its scene differs from that of scene.coast_side()")
    return replace(coast, scene=replace(expected, analysis=coast.scene.analysis))


def of_its_bins(inputs: CommonInputs, elsewhere: Mask) -> CommonInputs:
    """Inputs of one side, on which some bins (c,) do no damage, since they load the others."""
    cases = inputs.cases
    return replace(inputs, cases=replace(cases, hours=np.where(elsewhere, 0.0, cases.hours), elsewhere=elsewhere))


def evaluated_together(drive: CommonInputs, coast: CommonInputs, evaluate: Evaluate) -> tuple[Evaluated, Array]:
    """Numbers of both sides, of each bin those of the flanks that it loads, and the error of damages (gear, mode).

    Parameters
    ----------
    drive, coast : CommonInputs
        With solved loads.
    evaluate : callable
    """
    there = drive.cases.reversed
    coast = replace(coast, cases=drive.cases)
    sides = of_its_bins(drive, there), of_its_bins(coast, ~there)
    (arrays, here, notes), (others, beyond, more) = (evaluate(side) for side in sides)
    together = {name: np.where(_like(there, values), others[name], values) for name, values in arrays.items()}
    endurances = {mode: _joined(here[mode], beyond[mode], there) if mode in ROOTS else here[mode] for mode in here}
    endurances |= {COAST[mode]: beyond[mode] for mode in beyond if mode in COAST}
    errors = [
        dict(zip(each, interpolation_error(side, each, evaluate).T, strict=True))
        for side, each in zip(sides, (here, beyond), strict=True)
    ]
    sums = [dict(zip(each, damages_of(each).sum(axis=0).T, strict=True)) for each in (here, beyond)]
    names = {coast: mode for mode, coast in COAST.items()}
    columns = [
        _error_of_sum([each[mode] for each in errors], [each[mode] for each in sums])
        if mode in ROOTS
        else errors[mode in names][names.get(mode, mode)]
        for mode in endurances
    ]
    remarks = tuple(dict.fromkeys((*notes, *more)))
    return (together | {"cycles": drive.cycles}, endurances, remarks), np.stack(columns, axis=-1)


def _like(mask: Mask, values: Array) -> Mask:
    """A mask (c,) over the first axis of values (c, ...)."""
    return mask.reshape(-1, *[1] * (np.ndim(values) - 1))


def _joined(
    drive: tuple[Endurance, Endurance], coast: tuple[Endurance, Endurance], there: Mask
) -> tuple[Endurance, Endurance]:
    """Roots of both gears under the bins of both sides."""
    pinion, wheel = (_of_both(*pair, there) for pair in zip(drive, coast, strict=True))
    return pinion, wheel


def _of_both(drive: Endurance, coast: Endurance, there: Mask) -> Endurance:
    levels = [np.broadcast_to(each.curve.stresses.T, (len(there), len(each.curve.cycles))) for each in (drive, coast)]
    curve = replace(drive.curve, stresses=np.where(there[:, None], levels[1], levels[0]).T)
    stress, cycles = (np.where(there, getattr(coast, name), getattr(drive, name)) for name in ("stress", "cycles"))
    return replace(drive, curve=curve, stress=stress, cycles=cycles)


def _error_of_sum(errors: list[Array], sums: list[Array]) -> Array:
    """Error of damages of both sides together (gear,), over their sum, of each over its own sum or 1."""
    finite = [np.where(np.isinf(each), 0.0, each) for each in sums]
    parts = sum(error * np.where(each == 0.0, 1.0, each) for error, each in zip(errors, finite, strict=True))
    total = np.sum(finite, axis=0)
    endless = np.isinf(sums).any(axis=0)  # a bin above the static strength, whatever the others do
    return np.where(endless, 0.0, parts / np.where(total == 0.0, 1.0, total))
