"""A rating under a load spectrum: damage of its bins, lives and safeties of all together, and how far to trust them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import nan
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.arrays import Array
from loaded_tca.plain import apart, plain
from loaded_tca.rating.interpolation import FEWEST_SOLVED
from loaded_tca.rating.quantities import OF_SPECTRUM, SPECTRUM_NUMBERS
from loaded_tca.rating.rating import WORDS, OfCases, Rating, all_figures
from loaded_tca.rating.roots import REVERSED
from loaded_tca.results.figure import labelled
from loaded_tca.results.summary import known, shown, summary_of

if TYPE_CHECKING:
    from loaded_tca.rating.inputs import CommonInputs

ROUNDING = 1e-9
"""Of hours that are the same."""
MOST_SHOWN = 8
"""Bins that the summary has in full: those of the largest damage."""
OF_PART_6 = "ISO 6336-6:2019 with {} bins"
TOLD = 0.01
"""Told error of the damage from which on a warning is given."""


def of_spectrum(
    inputs: CommonInputs, arrays: dict[str, Array], error: Array, *, of_both_sides: bool
) -> tuple[dict[str, Array], list[str], list[str]]:
    """What a rating of a spectrum has beside: arrays, notes, and sentences of warnings."""
    cases, solved = inputs.cases, inputs.solved
    more = {
        "pinion_speed": cases.speed,
        "hours": cases.hours,
        "reversed": cases.reversed.astype(int),
        "interpolation_error": error,
    }
    return more, [*_notes(inputs, arrays, error, of_both_sides=of_both_sides)], told_error(error, len(solved.torque))


def told_error(error: Array, solved: int) -> list[str]:
    """Sentence of the warning where the error of damages (gear, mode) is large, or of too few torques unknown."""
    if solved < FEWEST_SOLVED and np.isnan(error).any():
        return [kinds.SPECTRUM_UNKNOWN.sentence(count=solved, fewest=FEWEST_SOLVED)]
    largest = float(np.nanmax(error)) if np.isfinite(error).any() else nan
    return [kinds.SPECTRUM_BETWEEN.sentence(change=largest, count=solved)] if largest > TOLD else []


def _notes(inputs: CommonInputs, arrays: dict[str, Array], error: Array, *, of_both_sides: bool) -> Iterator[str]:
    """What of a spectrum is assumed or left out."""
    cases, solved, sums = inputs.cases, inputs.solved, arrays["miner_sum"]
    between = cases.between(solved.torque)
    below = between & (cases.factor_torque < solved.torque[0])
    if between.any():
        finite = error[np.isfinite(error)]
        within = (
            f"damage is right within {float(finite.max()):.1%}" if finite.size else "there is no estimate of the error"
        )
        yield (
            f"stresses under {between.sum()} of {len(between)} bins are interpolated between {len(solved.torque)} "
            f"analysed torques: {within}"
        )
    if below.any():
        parts = arrays["damage"][below].sum(axis=0)[sums > 0.0] / sums[sums > 0.0]
        largest = float(parts[np.isfinite(parts)].max(initial=0.0))
        part = f"these do up to {plain(100.0 * largest, 1)} % of the damage"
        bins = "1 bin lies" if below.sum() == 1 else f"{below.sum()} bins lie"
        least = inputs.torque_in_words(float(solved.torque[0]))
        yield f"{bins} below {least}, the smallest analysed torque; {part}"
    if cases.reversed.any():
        bins = f"reversed bins ({cases.reversed.sum()} of {len(between)})"
        if of_both_sides:
            yield f"{bins} load the coast flanks and the roots, with the stresses of the analysis of the coast side"
        else:
            yield (
                f"{bins} load the other flanks, which are not analysed: their damage is not counted; "
                f"{inputs.duty.other_flanks}"
            )
            yield (
                f"{bins} stress the roots as much as bins of the same torque that are not reversed, with the load "
                "factors and local stresses of the analysed side"
            )
        yield (
            f"Y_M of roots with loads on both flanks follows from R = {plain(REVERSED, 6)} times the largest torque on "
            "the other flank over the torque of the bin (at most 1), or from a smaller root_stress_ratio or computed "
            "ratio"
        )
    if abs(cases.repeated - 1.0) > ROUNDING:
        together = f"{plain(cases.life_hours / cases.repeated, 6)} h"
        yield f"the bins, together {together}, follow each other {plain(cases.repeated)} times"


class OfSpectrum(OfCases):
    """Numbers of the bins of a load spectrum, and of all of them together."""

    def safeties_and_lives(self) -> tuple[Array, Array]:
        """Safety in the required life, and life at the required safety [h], of all bins together (1, gear, mode)."""
        return self.values("spectrum_safety")[None], self.values("life_hours")[None]

    def spectrum_rows(self) -> list[tuple[str, ...]]:
        """Lines on all bins together: label with unit, and a cell for each gear."""
        rows: list[tuple[str, ...]] = [("spectrum", *self.MEMBERS)]
        for n, mode in enumerate(self.modes):
            for name, number in self.NUMBERS.items():
                if number.dims == OF_SPECTRUM:
                    head = number.head(name)
                    cells = (shown(number.factor(head) * value, head) for value in self.values(name)[:, n])
                    rows.append((labelled(head, f"{WORDS[mode]}: {number.text}"), *cells))
        return rows

    def spectrum_figures(self) -> dict[str, Any]:
        """What all bins do together: hours, and for each kind of failure of each gear its numbers; None: not known."""
        rows = self.key_figures()[0]
        heads = [number.head(name) for name, number in self.NUMBERS.items() if number.dims == OF_SPECTRUM]
        together = {
            f"{gear}_{mode}": {head: known(rows[f"{gear}_{mode}_{head}"], head) for head in heads}
            for gear in self.MEMBERS
            for mode in self.modes
        }
        return {"required_life_h": self.life_required, "bins": len(self.torque), **together}

    def beside_figures(self) -> dict[str, Any]:
        """All bins together, notes and warnings."""
        return {"spectrum": self.spectrum_figures(), **super().beside_figures()}

    def most_damaging(self, count: int = MOST_SHOWN) -> list[int]:
        """Indices of the bins that have the largest parts of the damage of any kind, in their order."""
        with np.errstate(invalid="ignore", divide="ignore"):
            parts = np.nan_to_num(self.damage / self.miner_sum, nan=0.0).max(axis=(1, 2))
        heaviest = np.lexsort((-self.torque, -parts))[:count]
        return sorted(heaviest.tolist())

    def summary(self) -> str:
        """Return what all bins do together, those of the largest damage with all factors, notes and warnings."""
        some, figures = self.most_damaging(), self.key_figures()
        together = summary_of(self.title or self.TITLE, self.scope, self.spectrum_rows(), {})
        sentences = {"note": self.notes(), "warning": self.warnings or ()}
        which = "bins" if len(some) == len(figures) else f"{len(some)} of {len(figures)} bins, of the largest damage"
        numbered = [("bin", *(f"{place + 1}" for place in some)), *self.rows([figures[place] for place in some])]
        *_, table = summary_of("", which, numbered, sentences).split("\n", 1)
        return f"{together}\n\n{table}"

    def _short(self) -> list[str]:
        """Sentences on lives shorter than the one that is required."""
        sentences = []
        for place, gear in enumerate(self.MEMBERS):
            for n, mode in enumerate(self.modes):
                life, safety = float(self.life_hours[place, n]), float(self.spectrum_safety[place, n])
                least = self.required.required_safety(mode)
                if life == 0.0:
                    sentences.append(
                        f"{gear}: {WORDS[mode]}: life 0 at the required safety {plain(least, 6)}: a bin lies above the "
                        f"static strength; the safety in {plain(self.life_required, 6)} h is {plain(safety, 3)}"
                    )
                elif life < self.life_required:
                    lasts, _ = apart([life, self.life_required], 4)
                    sentences.append(
                        f"{gear}: {WORDS[mode]}: life {lasts} h of {plain(self.life_required, 6)} h at the "
                        f"required safety {plain(least, 6)}; the safety in this time is {plain(safety, 3)}"
                    )
        return sentences


@dataclass(frozen=True, eq=False, repr=False)
class SpectrumRating(OfSpectrum, Rating):
    """Safeties and lives under a load spectrum: cases are its bins.

    ``damage`` of each bin, in the required life at the required safeties, adds up to ``miner_sum``; ``life_hours`` is
    the required life over that sum, ``spectrum_safety`` the safety on stress at which it is 1, ``equivalent_torque``
    that of the same damage over the same load cycles by the first line of the S-N curve, ``interpolation_error`` by
    which part the sum may be wrong: all over gears and kinds of failure. Safeties over cases are those of a bin alone
    in its own load cycles.
    """

    NUMBERS: ClassVar = SPECTRUM_NUMBERS
    FIGURES: ClassVar = all_figures(SPECTRUM_NUMBERS)

    @property
    def _standards(self) -> str:
        return f"{super()._standards}, {OF_PART_6.format(len(self.torque))}"
