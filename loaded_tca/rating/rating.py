"""A rating of a result: safeties, lives and all factors under each torque, as table, figures and dataset."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from loaded_tca.arrays import GEARS, Array
from loaded_tca.errors import InputError
from loaded_tca.plain import plain
from loaded_tca.rating.findings import findings
from loaded_tca.rating.inputs import CommonInputs
from loaded_tca.rating.lives import COAST, FLANK, LOCAL_FLANK, LOCAL_ROOT, MODES, ROOT, Endurances, OfGears
from loaded_tca.rating.quantities import CASE, NUMBERS, OF_GEARS, OF_LOADED_FLANKS, OF_MODES, OF_SPECTRUM
from loaded_tca.results.figure import Figure, Figures, labelled
from loaded_tca.results.files import RATING
from loaded_tca.results.numbers import CycleNumbers
from loaded_tca.results.result import Result, figures_of
from loaded_tca.results.summary import shown
from loaded_tca.results.tables import Columns
from loaded_tca.scene.spiral import SpiralScene

if TYPE_CHECKING:
    import xarray

    from loaded_tca.results.declared import Number, Row
    from loaded_tca.scene import Scene
    from loaded_tca.scene.rating import RatingSection

NOT_COUNTED = "local safeties count pitch deviations and load paths only through K_A K_gamma K_v; Z_X is 1"
WORDS = {
    FLANK: "flank",
    ROOT: "root",
    LOCAL_FLANK: "local: flank",
    LOCAL_ROOT: "local: root",
    COAST[FLANK]: "coast flank",
    COAST[LOCAL_FLANK]: "local: coast flank",
}
"""Kinds of failure in words."""


def _of_column(head: str, row: Row) -> float:
    return float(row.result.figure_arrays()[head][row.row])


def _figures(name: str, number: Number, gears: Sequence[str]) -> dict[str, Figure]:
    """Key figures of a number by their names: of a torque, of its gears, or of their kinds of failure."""
    if number.dims == CASE:
        return figures_of({name: number})
    if number.dims == OF_GEARS:
        labels = {_head(number.head(name), gear): (f"{number.text}, {gear}", name) for gear in gears}
    else:
        labels = {
            _head(number.head(name), gear, mode): (f"{WORDS[mode]}: {number.text}, {gear}", f"{mode}_safety")
            for mode in (*MODES, *COAST.values())
            for gear in gears
        }
    return {
        head: Figure(of=partial(_of_column, head), label=label, needs=needs) for head, (label, needs) in labels.items()
    }


def _head(head: str, gear: str, mode: str = "") -> str:
    """Name of a key figure of a gear, and of one of its kinds of failure."""
    return "_".join(filter(None, (gear, mode, head)))


def all_figures(numbers: Mapping[str, Number], gears: Sequence[str] = GEARS) -> dict[str, Figure]:
    """Key figures under each torque, in the order of the summary."""
    return {name: figure for each, number in numbers.items() for name, figure in _figures(each, number, gears).items()}


def rows_of(
    rated: Result, gears: Sequence[str], modes: Sequence[str], figures: Sequence[Figures]
) -> list[tuple[str, ...]]:
    """Lines of numbers of load cases: label with unit, and a cell for each case, of all gears where they differ."""
    rows: list[tuple[str, ...]] = []

    def add(names: Sequence[str], label: str) -> None:
        cells = (" | ".join(shown(row[name], name) for name in names) for row in figures)
        rows.append((labelled(names[0], label), *cells))

    for name, number in rated.NUMBERS.items():
        if not rated.has(name) or number.dims == OF_SPECTRUM:
            continue
        head = number.head(name)
        if number.dims == OF_MODES:
            for mode in modes:
                add([_head(head, gear, mode) for gear in gears], f"{WORDS[mode]}: {number.text}")
        else:
            names = [_head(head, gear) for gear in gears] if number.dims == OF_GEARS else [head]
            add(names, number.label or number.text)
    return rows


class OfCases(Result):
    """Numbers of load cases, of their gears and kinds of failure, whose key figures have the names of these.

    Attributes
    ----------
    MEMBERS : tuple of str
        The gears.
    """

    KIND: ClassVar = RATING
    WHAT: ClassVar = "a rating"
    JSON: ClassVar = "rating.json"
    TABLES: ClassVar = {"rating.csv": "figures"}
    COORDINATES: ClassVar = ("torque",)
    MEMBERS: ClassVar[tuple[str, ...]] = GEARS

    endurances: OfGears

    @property
    def modes(self) -> tuple[str, ...]:
        """Kinds of failure that are rated."""
        return tuple(self.endurances)

    @property
    @abstractmethod
    def required(self) -> RatingSection:
        """What is required."""

    @property
    @abstractmethod
    def life_required(self) -> float:
        """The life that is required [h]."""

    @property
    def standard(self) -> str:
        """The standard whose factors these are."""
        return "ISO 6336"

    def safeties_and_lives(self) -> tuple[Array, Array]:
        """Safety, and life at the required safety [h], of each load case (c, gear, mode)."""
        safeties = [self.values(f"{mode}_safety") for mode in self.modes]
        return np.stack(safeties, axis=-1), self.values("life_hours")

    def safety_alone(self, mode: str) -> Array:
        """Safety against a kind of failure of each case alone (c, gear)."""
        return self.values(f"{mode}_safety")

    def has(self, name: str) -> bool:
        """Whether the rating has a number, or a safety against a kind of failure of the coast side."""
        mode = name.removesuffix("_safety")
        return super().has(name) or (mode in COAST.values() and mode in self.modes)

    def figure_arrays(self) -> dict[str, Array]:
        """Return the key figures as arrays (case,) by their names; of what all bins do together the same for each.

        NaN: not known, as the stress of flanks that are not analysed, which reversed bins load.
        """
        columns, count = {}, len(self.torque)
        for name, number in self.NUMBERS.items():
            if not self.has(name):
                continue
            head = number.head(name)
            values = number.factor(head) * self._of_analysed_flanks(name)
            if number.dims == CASE:
                columns[head] = values
            elif number.dims == OF_GEARS:
                columns |= {_head(head, gear): values[:, place] for place, gear in enumerate(self.MEMBERS)}
            else:
                whole = np.broadcast_to(values, (count, len(self.MEMBERS), len(self.modes)))
                for n, mode in enumerate(self.modes):
                    columns |= {_head(head, gear, mode): whole[:, place, n] for place, gear in enumerate(self.MEMBERS)}
        return {head: np.asarray(values, dtype=float) for head, values in columns.items()}

    def _of_analysed_flanks(self, name: str) -> Array:
        """A number; NaN of flanks under the bins that load the others, where no result of the coast side has these."""
        values = self.values(name)
        if name not in OF_LOADED_FLANKS or not self.has("reversed") or COAST[FLANK] in self.modes:
            return values
        there = self.values("reversed") > 0
        return np.where(there.reshape(-1, *[1] * (values.ndim - 1)), np.nan, values)

    def key_figures(self) -> tuple[dict[str, float], ...]:
        """Return the figures of each load case, by names that end in their unit; NaN: not known."""
        columns = self.figure_arrays()
        rows = zip(*(values.tolist() for values in columns.values()), strict=True)
        return tuple(dict(zip(columns, row, strict=True)) for row in rows)

    def to_table(self) -> dict[str, Array]:
        """Return all numbers as columns, a row for each load case, by names that end in their unit."""
        return self.figure_arrays()

    def tables(self) -> dict[str, Callable[[], Columns]]:
        """The one table that there is, a row for each load case."""
        return {"figures": super().tables()["figures"]}

    def beside_figures(self) -> dict[str, Any]:
        """Notes and warnings."""
        return {"notes": self.notes(), **super().beside_figures()}

    def stored(self) -> xarray.Dataset:
        """The dataset as files have it: gears by their place in ``MEMBERS``, from 0; kinds of failure likewise."""
        return self.dataset.drop_vars(["gear", "mode"]).assign_attrs(modes=" ".join(self.modes))


def shown_speeds(speed: Array) -> str:
    """Speeds (c,) [rpm] in words."""
    least, most = plain(float(speed.min()), 6), plain(float(speed.max()), 6)
    return f"{least} rpm" if least == most else f"{least} to {most} rpm"


@dataclass(frozen=True, eq=False, repr=False)
class Rating(OfCases):
    """Safeties and lives of a result with all factors; every name of ``NUMBERS`` is an attribute.

    Without a load spectrum each torque of the result is a load case for itself, which lasts the whole life that is
    required: damage and lives are those of the gears under that torque alone.

    Attributes
    ----------
    result : MeshCycle
    dataset : xarray.Dataset
        All numbers with their units, over ``case``, each of a ``torque``, ``gear``, and ``mode``, the kind of failure.
        A life is inf where the stress is borne for ever, and 0 above the static strength.
    inputs : CommonInputs
        What it took of the result and its scene.
    endurances : mapping
        What damage and lives follow from, of pinion and wheel, by the kind of failure.
    remarks : tuple of str
        What lies outside the ranges of the standard.
    """

    TITLE: ClassVar = "Rating"
    NUMBERS: ClassVar = NUMBERS
    FIGURES: ClassVar = all_figures(NUMBERS)

    result: CycleNumbers
    dataset: xarray.Dataset
    inputs: CommonInputs
    endurances: Endurances
    remarks: tuple[str, ...] = ()

    def __repr__(self) -> str:
        flank, root = self.flank_safety.min(), self.root_safety.min()
        return (
            f"{type(self).__name__}({len(self.torque)} torques, least S_H {plain(flank, 3)}, least S_F "
            f"{plain(root, 3)})"
        )

    @property
    def scene(self) -> Scene:
        """Scene of the result."""
        return self.result.scene

    @property
    def required(self) -> RatingSection:
        """What the scene requires."""
        wanted = self.scene.rating
        assert wanted is not None  # refused before
        return wanted

    @property
    def life_required(self) -> float:
        """The life that is required [h]."""
        return self.inputs.cases.life_hours

    @property
    def scope(self) -> str:
        """Speed, hours and what is required, in words."""
        return f"{self._standards}, pinion at {self._speed} for {plain(self.life_required, 6)} h; {self._safeties}"

    @property
    def standard(self) -> str:
        """The standard whose factors these are."""
        return "ISO 10300" if isinstance(self.scene, SpiralScene) else super().standard

    @property
    def _standards(self) -> str:
        of_bevel = isinstance(self.scene, SpiralScene)
        return "ISO 10300-2 and -3:2023, method B1" if of_bevel else "ISO 6336-2:2019 and -3:2006"

    @property
    def _speed(self) -> str:
        return shown_speeds(self.inputs.cases.speed)

    @property
    def _safeties(self) -> str:
        wanted = self.required
        return (
            f"required S_H {plain(wanted.required_flank_safety, 6)}, S_F "
            f"{plain(wanted.required_root_safety, 6)}; pinion | wheel"
        )

    def safety_alone(self, mode: str) -> Array:
        """Safety against a kind of failure of each case alone (c, gear); NaN where it loads the other flanks."""
        reversed_bins = self.inputs.cases.reversed[:, None]
        if mode in COAST.values():
            return np.where(reversed_bins, self.values(f"{mode.replace('coast_', '')}_safety"), np.nan)
        values = super().safety_alone(mode)
        return values if mode in (ROOT, LOCAL_ROOT) else np.where(reversed_bins, np.nan, values)

    def rows(self, figures: Sequence[Figures]) -> list[tuple[str, ...]]:
        """Lines of the summary: label with unit, and a cell for each torque, of both gears where they differ."""
        return rows_of(self, GEARS, self.modes, figures)

    def notes(self) -> tuple[str, ...]:
        """What lies outside the ranges of the standard, what decides, which safeties are too small, what lacks."""
        return (*self.remarks, *findings(self), *self._short(), NOT_COUNTED)

    def _short(self) -> list[str]:
        """Sentences on safeties below those required."""
        sentences = []
        for mode in (FLANK, LOCAL_FLANK, ROOT, LOCAL_ROOT):
            name, least = f"{mode}_safety", self.required.required_safety(mode)
            for place, gear in enumerate(GEARS if self.has(name) else ()):
                short = self.values(name)[:, place] < least
                if short.any():
                    torques = self.inputs.torque_in_words(*self.torque[short].tolist())
                    words = self.NUMBERS[name].text.replace(":", "")
                    sentences.append(f"{gear}: {words} below the required {plain(least, 6)} under {torques}")
        return sentences

    def sensitivities(self, keys: Sequence[str]) -> xarray.Dataset:
        """Return the derivatives of safeties, damage and lives with respect to keys of the scene.

        They follow from those of pressure, root tension and K_Hbeta by the chain rule; see
        :mod:`loaded_tca.rating.slopes`, which says what is held.

        Parameters
        ----------
        keys : sequence of str
            As of :meth:`loaded_tca.MeshCycle.sensitivities`.

        Returns
        -------
        xarray.Dataset
            ``flank_safety``, ``root_safety``, ``local_flank_safety`` and, with root stress, ``local_root_safety`` over
            case, gear and key, ``damage`` and ``life_hours`` over kinds of failure, too; under a load spectrum also
            ``spectrum_safety`` and ``miner_sum`` [1, or h, per unit of the key]. NaN where the number is infinite, and
            of flanks where the slice that decides yields.

        Raises
        ------
        InputError
            As :meth:`loaded_tca.MeshCycle.sensitivities`, and of the torque of a load spectrum.

        Warns
        -----
        AccuracyWarning
            Likewise; where another contact decides as much, and where the pressure that decides has derivatives that
            are less exact.
        """
        from loaded_tca.rating.slopes import rating_slopes
        from loaded_tca.results.sensitivities import TORQUE

        if COAST[FLANK] in self.endurances:
            raise InputError("coast: a rating of both sides has no derivatives; rate the result of each side by itself")
        if self.inputs.duty.parts:
            raise InputError(
                "sensitivities: the torques of this rating have results of their own, and derivatives of all together "
                "are not available; analyse and rate each torque by itself"
            )
        if self.inputs.cases.is_spectrum and TORQUE in keys:
            raise InputError(f"{TORQUE}: a load spectrum has the torques of its bins; allowed are other keys")
        return rating_slopes(self, self.result.sensitivities(keys))
