"""A rating of a result: safeties, lives and all factors under each torque, as table, figures and dataset."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

import loaded_tca.warning_kinds as kinds
from loaded_tca.arguments import checked
from loaded_tca.arrays import GEARS, Array
from loaded_tca.errors import give_accuracy_warning
from loaded_tca.rating.bevel import BevelInputs, bevel_evaluated, bevel_inputs_of
from loaded_tca.rating.evaluate import evaluated
from loaded_tca.rating.findings import findings
from loaded_tca.rating.inputs import CommonInputs, Duty, inputs_of
from loaded_tca.rating.quantities import NUMBERS, OF_GEARS
from loaded_tca.results.figure import Figure, Figures, labelled
from loaded_tca.results.files import RATING
from loaded_tca.results.numbers import CycleNumbers
from loaded_tca.results.result import Result, figures_of
from loaded_tca.results.summary import shown
from loaded_tca.scene.spiral import SpiralScene

if TYPE_CHECKING:
    import xarray

    from loaded_tca.results.declared import Number, Row
    from loaded_tca.scene import Scene

NOT_COUNTED = "pitch deviations and load paths beside K_A K_gamma K_v are not in local safeties; Z_X is 1"


def _of_gear(name: str, factor: float, place: int, row: Row) -> float:
    return factor * float(getattr(row, name)[place])


def _figures(name: str, number: Number) -> dict[str, Figure]:
    """Key figures of a number by their names: of a torque, or of both gears."""
    if number.dims != OF_GEARS:
        return figures_of({name: number})
    head = number.head(name)
    return {
        f"{gear}_{head}": Figure(
            of=partial(_of_gear, name, number.factor(head), place), label=f"{number.text}, {gear}", needs=name
        )
        for place, gear in enumerate(GEARS)
    }


FIGURES = {name: figure for each, number in NUMBERS.items() for name, figure in _figures(each, number).items()}
"""Key figures under each torque, in the order of the summary."""


@dataclass(frozen=True, eq=False, repr=False)
class Rating(Result):
    """Safeties and lives of a result with all factors; every name of ``NUMBERS`` is an attribute.

    Attributes
    ----------
    result : MeshCycle
    dataset : xarray.Dataset
        All numbers with their units, over ``case``, each of a ``torque``, and ``gear``. A life is inf where the stress
        is borne for ever.
    inputs : CommonInputs
        What it took of the result and its scene.
    remarks : tuple of str
        What lies outside the ranges of the standard.
    """

    KIND: ClassVar = RATING
    WHAT: ClassVar = "a rating"
    TITLE: ClassVar = "Rating"
    NUMBERS: ClassVar = NUMBERS
    FIGURES: ClassVar = FIGURES
    COORDINATES: ClassVar = ("torque",)

    result: CycleNumbers
    dataset: xarray.Dataset
    inputs: CommonInputs
    remarks: tuple[str, ...] = ()

    def __repr__(self) -> str:
        flank, root = self.flank_safety.min(), self.root_safety.min()
        return f"Rating({len(self.torque)} torques, least S_H {flank:.3g}, least S_F {root:.3g})"

    @property
    def scene(self) -> Scene:
        """Scene of the result."""
        return self.result.scene

    @property
    def standard(self) -> str:
        """The standard whose factors these are."""
        return "ISO 10300" if isinstance(self.scene, SpiralScene) else "ISO 6336"

    @property
    def scope(self) -> str:
        """Speed, hours and what is required, in words."""
        wanted, operation = self.scene.rating, self.scene.operation
        assert wanted is not None  # refused before
        assert operation is not None
        of_bevel = isinstance(self.scene, SpiralScene)
        standard = "ISO 10300-2 and -3:2023, method B1" if of_bevel else "ISO 6336-2:2019 and -3:2006"
        return (
            f"{standard}, pinion at {operation.pinion_speed_rpm:g} rpm for {wanted.life_hours:g} h; "
            f"required S_H {wanted.required_flank_safety:g}, S_F {wanted.required_root_safety:g}; pinion | wheel"
        )

    def rows(self, figures: Sequence[Figures]) -> list[tuple[str, ...]]:
        """Lines of the summary: label with unit, and a cell for each torque, of both gears where they differ."""
        rows = []
        for name, number in self.NUMBERS.items():
            if not self.has(name):
                continue
            head = number.head(name)
            names = [f"{gear}_{head}" for gear in GEARS] if number.dims == OF_GEARS else [head]
            cells = (" | ".join(shown(row[one], one) for one in names) for row in figures)
            rows.append((labelled(names[0], number.label or number.text), *cells))
        return rows

    def notes(self) -> tuple[str, ...]:
        """What lies outside the ranges of the standard, what decides, which safeties are too small, what lacks."""
        return (*self.remarks, *findings(self), *self._short(), NOT_COUNTED)

    def _short(self) -> list[str]:
        """Sentences on safeties below those required."""
        wanted = self.scene.rating
        assert wanted is not None  # refused before
        required = {"flank": wanted.required_flank_safety, "root": wanted.required_root_safety}
        sentences = []
        for kind, least in required.items():
            for name in (f"{kind}_safety", f"local_{kind}_safety"):
                for place, gear in enumerate(GEARS if self.has(name) else ()):
                    short = self.values(name)[:, place] < least
                    torques = ", ".join(f"{1e-3 * torque:g}" for torque in self.torque[short])
                    if torques:
                        words = self.NUMBERS[name].text.replace(":", "")
                        sentences.append(f"{gear}: {words} below the required {least:g} under {torques} N m")
        return sentences

    def sensitivities(self, keys: Sequence[str]) -> xarray.Dataset:
        """Return the derivatives of the safeties with respect to keys of the scene.

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
            case, gear and key [1 per unit of the key].

        Raises
        ------
        InputError
            As :meth:`loaded_tca.MeshCycle.sensitivities`, and of bevel and hypoid pairs.

        Warns
        -----
        AccuracyWarning
            Likewise.
        """
        from loaded_tca.rating.slopes import rating_slopes

        return rating_slopes(self, keys)

    def to_table(self) -> dict[str, Array]:
        """Return all numbers as columns, a row for each torque, by names that end in their unit."""
        return self.figure_arrays()

    def stored(self) -> xarray.Dataset:
        """The dataset as files have it: gears are 0, the pinion, and 1, the wheel."""
        return self.dataset.drop_vars("gear")


@checked
def rating_of(result: CycleNumbers, *, duty: Duty = Duty(), warn: bool = True) -> Rating:
    """Rating of a result; see :meth:`loaded_tca.MeshCycle.rating`.

    Parameters
    ----------
    result : MeshCycle
    duty : Duty
        How gears are loaded by other mates, as those of a planetary stage.
    warn : bool
        Whether accuracy warnings are given.

    Returns
    -------
    Rating
    """
    of_bevel = isinstance(result.scene, SpiralScene)
    inputs = bevel_inputs_of(result) if of_bevel else inputs_of(result, duty)
    arrays, notes, at_edge = bevel_evaluated(inputs) if isinstance(inputs, BevelInputs) else evaluated(inputs)
    sentences = [kinds.RATED_AT_EDGE.sentence()] if at_edge else []
    about: dict[str, Any] = {"version": result.version, "warnings": "\n".join(sentences)}
    dataset = Rating.dataset_of(arrays, **about).assign_coords(gear=[*GEARS])
    for sentence in sentences if warn else ():
        give_accuracy_warning(sentence, stacklevel=3)
    return Rating(result, dataset, inputs, notes)
