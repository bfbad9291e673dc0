"""Rating of a double helical pair: each half under its share, the whole gear with b = 2 b_B, the smaller safeties."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from loaded_tca.arrays import GEARS, Array, Indices
from loaded_tca.double_helical.laws import balance_of
from loaded_tca.errors import InputError, give_accuracy_warning, named
from loaded_tca.plain import plain
from loaded_tca.rating import Rating, rating_of
from loaded_tca.rating.cases import cases_of, problems_of_cases
from loaded_tca.rating.inputs import Duty, by_itself, missing_sections
from loaded_tca.rating.quantities import CASE, NUMBERS, OF_GEARS, SPECTRUM_NUMBERS
from loaded_tca.rating.rating import NOT_COUNTED, OfCases, all_figures, rows_of
from loaded_tca.rating.spectrum import OfSpectrum
from loaded_tca.results import MeshCycle
from loaded_tca.results.declared import Number
from loaded_tca.results.figure import Figures
from loaded_tca.results.summary import shown_torque
from loaded_tca.scene.double_helical import HALVES

if TYPE_CHECKING:
    import xarray

    from loaded_tca.double_helical.result import DoubleHelicalResult
    from loaded_tca.scene.double_helical import DoubleHelicalScene
    from loaded_tca.scene.rating import RatingSection

_SAFETIES = "flank_safety", "root_safety", "local_flank_safety", "local_root_safety"
_OF_CASES = {
    "K_A": NUMBERS["K_A"],
    "K_gamma": Number(
        CASE,
        "1",
        "largest share of a half over an even share",
        label="K_gamma: largest share of a half over an even share",
    ),
    "K_Hbeta": Number(
        CASE,
        "1",
        "K_Hbeta: largest line load of both halves over the mean one under the larger share",
        label="K_Hbeta: largest line load of both halves over the mean one under the larger share",
    ),
    "whole_flank_safety": Number(OF_GEARS, "1", "whole gear, b = 2 b_B: safety against pitting S_H"),
    "whole_root_safety": Number(OF_GEARS, "1", "whole gear, b = 2 b_B: safety against tooth breakage S_F"),
    **{name: NUMBERS[name].changed(text=f"smaller of both halves: {NUMBERS[name].text}") for name in _SAFETIES},
}
PAIR_RATING_NUMBERS: dict[str, Number] = {
    "torque": NUMBERS["torque"],
    **_OF_CASES,
    **{name: NUMBERS[name] for name in ("damage", "life_hours")},
}
PAIR_SPECTRUM_NUMBERS: dict[str, Number] = {
    **{name: SPECTRUM_NUMBERS[name] for name in ("torque", "pinion_speed", "hours", "reversed")},
    **_OF_CASES,
    **{
        name: SPECTRUM_NUMBERS[name]
        for name in ("damage", "miner_sum", "life_hours", "spectrum_safety", "interpolation_error")
    },
}
"""Names in the datasets of both kinds: of both halves the worse one."""
LARGEST = "damage", "miner_sum", "interpolation_error"
"""Numbers of which the larger of both halves counts."""
Part = tuple[MeshCycle, Array]
"""A mesh cycle of a half with the torques of the half [N mm] that it stands for."""
SAME = 1e-9
"""Difference of torques that are one, through N m."""
UNEVEN = 0.01
"""Of the share of a half over a pitch, over its mean: from which on a note says that it is rated under the largest."""


@dataclass(frozen=True, eq=False, repr=False)
class DoubleHelicalRating(OfCases):
    """Safeties and lives of a double helical pair; every name of ``NUMBERS`` is an attribute.

    Attributes
    ----------
    result : DoubleHelicalResult
    half_a, half_b : Rating or None
        Each half under its own torque, the largest of its shares over the pitch, with every factor; None: it carries
        nothing under any torque.
    whole : Rating
        The whole gear as ISO 6336 has it: half the torque on the face of a half, which is the torque on b = 2 b_B, with
        K_gamma of the larger share, and K_Hbeta by which K_gamma K_Hbeta is the largest line load of both halves over
        the mean one of the gear. Its local stresses are those of the half that carries more.
    dataset : xarray.Dataset
        Numbers with their units, over ``case``, each of a ``torque`` of both halves, ``gear`` and ``mode``.
    """

    TITLE: ClassVar = "Rating of a double helical pair"
    NUMBERS: ClassVar = PAIR_RATING_NUMBERS
    FIGURES: ClassVar = all_figures(PAIR_RATING_NUMBERS)

    result: DoubleHelicalResult
    half_a: Rating | None
    half_b: Rating | None
    whole: Rating
    dataset: xarray.Dataset

    def __repr__(self) -> str:
        flank, root = float(self.flank_safety.min()), float(self.root_safety.min())
        return (
            f"{type(self).__name__}({len(self.torque)} torques, least S_H {plain(flank, 3)}, least S_F "
            f"{plain(root, 3)})"
        )

    @property
    def scene(self) -> DoubleHelicalScene:
        """Scene of the result."""
        return self.result.scene

    @property
    def of_halves(self) -> dict[str, Rating]:
        """Ratings of the halves that carry load, by the names of these."""
        ratings = zip(HALVES, (self.half_a, self.half_b), strict=True)
        return {name: rating for name, rating in ratings if rating is not None}

    @property
    def halves(self) -> tuple[Rating, ...]:
        """Ratings of half a and half b, or of that which carries load."""
        return tuple(self.of_halves.values())

    @property
    def modes(self) -> tuple[str, ...]:
        """Kinds of failure that are rated."""
        return self.whole.modes

    @property
    def required(self) -> RatingSection:
        """What the scene requires."""
        return self.whole.required

    @property
    def life_required(self) -> float:
        """The life that is required [h]."""
        return self.whole.life_required

    @property
    def scope(self) -> str:
        """Speed, hours and what is required, in words."""
        return f"two halves, {self.whole.scope}"

    def safety_alone(self, mode: str) -> Array:
        """Smaller safety of both halves of each case alone (c, gear); NaN where it loads the other flanks."""
        return np.asarray(np.fmin.reduce([rating.safety_alone(mode) for rating in self.halves]))

    def figure_arrays(self) -> dict[str, Array]:
        """Return the figures (case,) of the pair, and of its halves, which begin with their names."""
        columns = super().figure_arrays()
        for name, rating in self.of_halves.items():
            columns |= {_of_half(name, figure): values for figure, values in rating.figure_arrays().items()}
        return columns

    def rows(self, figures: Sequence[Figures]) -> list[tuple[str, ...]]:
        """Lines of the summary: of the pair, then of both halves with all factors."""
        rows = rows_of(self, GEARS, self.modes, figures)
        for name, rating in self.of_halves.items():
            start = _of_half(name, "")
            of_half = [
                {key.removeprefix(start): value for key, value in row.items() if key.startswith(start)}
                for row in figures
            ]
            rows.append((f"half {name}, under its share", *("" for _ in figures)))
            rows += [(f"  {label}", *cells) for label, *cells in rating.rows(of_half)]
        return rows

    def notes(self) -> tuple[str, ...]:
        """What decides in each half, what lies outside the ranges of the standard, which safeties are too small."""
        sentences = [
            f"half {name}: {note}"
            for name, rating in self.of_halves.items()
            for note in rating.notes()
            if note != NOT_COUNTED
        ]
        return (*_of_pair(self), *sentences, NOT_COUNTED)


@dataclass(frozen=True, eq=False, repr=False)
class DoubleHelicalSpectrumRating(OfSpectrum, DoubleHelicalRating):
    """Safeties and lives of a double helical pair under a load spectrum, whose torque the halves share bin by bin.

    ``miner_sum`` is the larger of both halves, ``life_hours`` and ``spectrum_safety`` the smaller.
    """

    NUMBERS: ClassVar = PAIR_SPECTRUM_NUMBERS
    FIGURES: ClassVar = all_figures(PAIR_SPECTRUM_NUMBERS)

    def spectrum_rows(self) -> list[tuple[str, ...]]:
        """Lines on all bins together: of the worse half, then of each."""
        rows = super().spectrum_rows()
        for name, rating in self.of_halves.items():
            assert isinstance(rating, OfSpectrum)
            rows += [(f"half {name}, under its share", *("" for _ in GEARS))]
            rows += [(f"  {label}", *cells) for label, *cells in rating.spectrum_rows()[1:]]
        return rows

    def spectrum_figures(self) -> dict[str, Any]:
        """What all bins do together: of the worse half, then of each."""
        figures = super().spectrum_figures()
        for name, rating in self.of_halves.items():
            assert isinstance(rating, OfSpectrum)
            figures[f"half_{name}"] = rating.spectrum_figures()
        return figures


def _of_half(name: str, figure: str) -> str:
    """Name of a figure of a half."""
    return f"half_{name}_{figure}"


def double_helical_rating_of(result: DoubleHelicalResult, *, warn: bool = True) -> DoubleHelicalRating:
    """Rating of a double helical pair; see :meth:`loaded_tca.double_helical.DoubleHelicalResult.rating`.

    Parameters
    ----------
    result : DoubleHelicalResult
    warn : bool
        Whether accuracy warnings are given.

    Returns
    -------
    DoubleHelicalRating
    """
    scene = result.scene
    sections = {f"{gear}.strength": getattr(scene, gear).strength for gear in GEARS}
    problems = missing_sections({**sections, "rating": scene.rating, "lubricant": scene.lubricant})
    if problems := [*problems, *problems_of_cases(scene.load, scene.operation, sections, float(result.torque.max()))]:
        raise InputError(problems)
    bins = scene.load.case
    torques = np.asarray(result.torque if bins is None else [1e3 * case.pinion_torque_Nm for case in bins])
    torques = _as_analysed(torques, result.torque)
    shares = _largest_shares(result, torques)
    of_halves = torques * shares.T
    analysed = result.torque * result.torque_share.max(axis=1).T
    ratings: list[Rating | None] = []
    for half, (name, of_half) in enumerate(zip(HALVES, of_halves, strict=True)):
        with named(f"half {name}"):
            parts = _parts_of(result, np.full(len(result.torque), half), analysed[half])
            ratings.append(_under(scene, result.halves[half], of_half, parts) if of_half.any() else None)
    face = _face_load_factor(shares, ratings)
    more = int(of_halves.max(axis=1).argmax())  # its mesh cycle goes up to the even share and more
    parts = _parts_of(result, analysed.argmax(axis=0), 0.5 * result.torque)
    whole = _under(scene, result.halves[more], 0.5 * torques, parts, 2.0 * shares.max(axis=1), face)
    kind = DoubleHelicalRating if bins is None else DoubleHelicalSpectrumRating
    loaded = {name: rating for name, rating in zip(HALVES, ratings, strict=True) if rating is not None}
    arrays = {name: _worse(name, loaded.values()) for name in kind.NUMBERS if whole.has(name)}
    arrays |= {"torque": torques, "K_gamma": whole.K_gamma, "K_Hbeta": face}
    arrays |= {"whole_flank_safety": whole.flank_safety, "whole_root_safety": whole.root_safety}
    sentences = [f"half {name}: {sentence}" for name, rating in loaded.items() for sentence in rating.warnings or ()]
    for sentence in sentences if warn else ():
        give_accuracy_warning(sentence)
    about: dict[str, Any] = {"version": whole.version, "warnings": "\n".join(sentences)}
    dataset = kind.dataset_of(arrays, {"gear": GEARS, "mode": whole.modes}, **about)
    half_a, half_b = ratings
    return kind(result, half_a, half_b, whole, dataset)


def _largest_shares(result: DoubleHelicalResult, torques: Array) -> Array:
    """Largest shares (c, half) over the pitch under torques (c,) of both halves [N mm]; even under none.

    Where each torque has mesh cycles of its own, shares lie between those of the torques analysed.
    """
    loaded = torques > 0.0
    shares = np.full((len(torques), len(HALVES)), 0.5)
    if result.scene.is_supported or result.elsewhere:
        order, largest = result.torque.argsort(), result.torque_share.max(axis=1)
        columns = [np.interp(torques, result.torque[order], of_half[order]) for of_half in largest.T]
        return np.where(loaded[:, None], np.stack(columns, axis=-1), shares)
    force = balance_of(result.scene, result.halves, torques[loaded]).force
    shares[loaded] = (force / force.sum(axis=-1, keepdims=True)).max(axis=1)
    return shares


def _as_analysed(torques: Array, analysed: Array) -> Array:
    """Torques (c,), with those that were analysed as these are to the last digit."""
    nearest = analysed[np.abs(torques[:, None] - analysed).argmin(axis=1)]
    return np.where(np.isclose(torques, nearest, rtol=SAME, atol=0.0), nearest, torques)


def _parts_of(result: DoubleHelicalResult, halves: Indices, torques: Array) -> list[Part]:
    """Mesh cycles of a half, each with the torques of the half that it stands for; none: one stands for all.

    Parameters
    ----------
    result : DoubleHelicalResult
    halves : (t,) array of int
        Half whose mesh cycle counts under each torque of the result.
    torques : (t,) array [N mm]
        What that half carries, 0 where it carries nothing.
    """
    if not result.elsewhere:
        return []
    _, rows = np.unique(result.torque, return_index=True)
    rows = rows[torques[rows] > 0.0]
    falls = np.flatnonzero(np.diff(torques[rows]) <= 0.0)
    if falls.size:
        less, more = (shown_torque(float(result.torque[row])) for row in rows[falls[0] : falls[0] + 2])
        raise InputError(
            f"analysis.torques_Nm: the half carries no more under {more} of both halves than under {less}; a rating "
            "needs torques under which its load rises; analyse and rate each of them by itself"
        )
    parts = []
    for place, half in sorted({*zip(result.place_of_torque[rows].tolist(), halves[rows].tolist(), strict=True)}):
        of_part = rows[(result.place_of_torque[rows] == place) & (halves[rows] == half)]
        parts.append((result.halves_by_place[place][half], torques[of_part]))
    return parts


def _face_load_factor(shares: Array, ratings: Sequence[Rating | None]) -> Array:
    """K_Hbeta (c,) of the whole gear: the largest line load of both halves over the mean one under the larger share.

    So a half counts as much as it carries, whatever its own K_Hbeta is; 1 of idle bins.
    """
    loads = [
        np.zeros(len(shares)) if rating is None else share * np.nan_to_num(rating.K_Hbeta)  # NaN without load
        for rating, share in zip(ratings, shares.T, strict=True)
    ]
    return np.fmax(np.max(loads, axis=0) / shares.max(axis=1), 1.0)


def _under(
    scene: DoubleHelicalScene,
    cycle: MeshCycle,
    torques: Array,
    parts: Sequence[Part] = (),
    load_factor: Array | float = 1.0,
    face_factor: Array | None = None,
) -> Rating:
    """Rating of the mesh of a half under torques (c,) [N mm], of bins where the pair has a load spectrum.

    What a share exceeds the largest torque that was solved by, a thousandth at most, multiplies loads as K_gamma.
    """
    solved = [(part, np.minimum(of_part, part.torque.max())) for part, of_part in parts]
    within = np.minimum(torques, max(float(most.max()) for _, most in solved or [(cycle, cycle.torque)]))
    for (_, of_part), (_, most) in zip(parts, solved, strict=True):
        for torque, largest in zip(of_part, most, strict=True):
            within = np.where(torques == torque, largest, within)
    more = load_factor * np.divide(torques, within, out=np.ones_like(torques), where=within > 0.0)
    rated = _rated(scene, cycle, within)
    cases = replace(cases_of(rated.scene, within), torque=within)  # to the last digit, as they were solved
    of_parts = [(rated if part is cycle else _rated(scene, part, within), most) for part, most in solved]
    duty = Duty(
        cases=cases,
        case_mesh_load_factor=more,
        case_face_load_factor=face_factor,
        other_flanks=by_itself(scene.load),
        parts=of_parts,
    )
    return rating_of(rated, duty=duty, warn=False)


def _rated(scene: DoubleHelicalScene, cycle: MeshCycle, torques: Array) -> MeshCycle:
    """Mesh cycle of a half whose scene is rated as that of the pair, under torques (c,) [N mm] of bins."""
    half, bins = cycle.scene, scene.load.case
    sections = {name: getattr(scene, name) for name in ("operation", "lubricant")}
    gears = {gear: replace(getattr(half, gear), strength=getattr(scene, gear).strength) for gear in GEARS}
    load = half.load
    if bins is not None:
        highest = max(half.analysis.torques_Nm or (1e-3 * float(cycle.torque.max()),))  # as its scene has it
        of_half = (min(1e-3 * torque, highest) for torque in torques.tolist())
        load = replace(
            load,
            pinion_torque_Nm=None,
            case=tuple(replace(case, pinion_torque_Nm=part) for case, part in zip(bins, of_half, strict=True)),
        )
    rated = replace(half, **gears, **sections, load=load, rating=scene.rating if bins else scene.rating_of_halves)
    return replace(cycle, scene=rated, states=None)


def _worse(name: str, ratings: Iterable[Rating]) -> Array:
    """A number of the half that is worse."""
    worse: np.ufunc = np.maximum if name in LARGEST else np.minimum
    return np.asarray(worse.reduce([rating.values(name) for rating in ratings]))


def _of_pair(rating: DoubleHelicalRating) -> Iterator[str]:
    """Sentences on how the halves share the torque in a rating."""
    scene, result = rating.scene, rating.result
    for name in HALVES:
        if name not in rating.of_halves:
            yield f"half {name} carries nothing under any torque: the rating is that of the other half"
        elif (idle := (rating.of_halves[name].torque == 0.0) & (rating.torque > 0.0)).any():
            largest = shown_torque(float(rating.torque[idle].max()))
            yield f"half {name} carries nothing under up to {largest} of both halves, and has no load factors there"
    if not scene.floats_freely:
        yield "each half is rated under its largest share over the pitch"
    shares = result.torque_share
    span, mean = np.ptp(shares, axis=1), shares.mean(axis=1)
    if (span > UNEVEN * mean).any():
        torque, half = (int(n) for n in np.unravel_index(span.argmax(), span.shape))
        yield (
            f"the share of half {HALVES[half]} is {plain(100.0 * mean[torque, half], 3)} % of the torque in the mean "
            f"and {plain(100.0 * shares[torque, :, half].max(), 3)} % at most under "
            f"{shown_torque(result.torque[torque])}: the life under the largest share is on the safe side"
        )
    if any(case.reversed for case in scene.load.case or ()):
        yield "in reversed bins the halves share the torque as under the same torque that is not reversed"
    if result.elsewhere:
        yield (
            "load factors and stresses under each analysed torque come from its own mesh cycles, interpolated between "
            "the torques of the half there; under other torques they are interpolated between analysed torques"
        )
