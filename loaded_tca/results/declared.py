"""What is declared of a number of a result, once: file, attribute, table and summary follow from its ``Number``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np

from loaded_tca.arrays import GEARS, Array
from loaded_tca.errors import NotAskedError
from loaded_tca.results.files import Part, variables_of
from loaded_tca.units import MICROMETRES, as_ending, factor_of

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import xarray

CYCLE = ("torque", "position")
PAIRS = (*CYCLE, "pair")
OVER_CYCLE = (*CYCLE, "gear")

ENGINEERS_UNITS = {"rad": "arcsec", "N mm": "Nm"}
"""Unit of a result -> ending of its column, where tables have another unit; angles by their name are in degrees."""
ABOUT = ("version", "date", "warnings", "left_out")
"""Attributes of a dataset: version of the package, date and accuracy warnings of the analysis, a line each; of a half
of a double helical pair a sentence on what its numbers leave out."""


class Asked(NamedTuple):
    """When a result has numbers that not all have.

    Attributes
    ----------
    by : callable
        Of a scene or stage and the first word of the name, the gear of most: whether it asks for the number, so that a
        file must have it.
    lacks : str
        What the error says where a result does not have it; {gear} stands for that word.
    """

    by: Callable[[Any, str], bool]
    lacks: str


class _Part(NamedTuple):
    dims: tuple[str, ...]
    unit: str
    text: str


class Number(_Part):
    """A number of a result.

    Attributes
    ----------
    dims : tuple of str
    unit, text : str
        Unit and long name in the dataset and in files.
    column : str
        Its head in tables, and its name as a key figure; default: its name with its unit in the engineer's units.
    columns : tuple of str
        Heads in the table of positions, with {} for what counts along its last axis; default: one for the torque and
        for numbers over positions, also of tooth pairs, of which the table has one, and one for each gear.
    at_base_circle : bool
        Whether the table has an angle as a length at the base circle [um], too.
    times : float
        How many times the number the tables have: diameters, full widths.
    label : str
        Line of the summary, of a number under each torque alone, which is a key figure then.
    largest_is_best : bool
        As of a :class:`loaded_tca.results.figure.Figure`, which a number with a label is.
    asked : Asked, optional
        When a result has it; default: always.
    needs : frozenset of str
        What it takes, by the names of its kind of result.
    """

    column: str
    columns: tuple[str, ...] | None
    at_base_circle: bool
    times: float
    label: str
    largest_is_best: bool
    asked: Asked | None
    needs: frozenset[str]

    def __new__(
        cls,
        dims: tuple[str, ...],
        unit: str,
        text: str,
        needs: frozenset[str] = frozenset(),
        *,
        column: str = "",
        columns: tuple[str, ...] | None = None,
        at_base_circle: bool = False,
        times: float = 1.0,
        label: str = "",
        largest_is_best: bool = False,
        asked: Asked | None = None,
    ) -> Number:
        """Declare a number by its dimensions, unit and long name."""
        number = super().__new__(cls, dims, unit, text)
        number.column, number.columns, number.at_base_circle = column, columns, at_base_circle
        number.times, number.label, number.asked, number.needs = times, label, asked, needs
        number.largest_is_best = largest_is_best
        return number

    def changed(self, **changes: Any) -> Number:
        """Return a copy with other texts, columns or needs."""
        return Number(**{**self._asdict(), **vars(self), **changes})

    def head(self, name: str) -> str:
        """Head of its column under a name."""
        ending = ENGINEERS_UNITS.get(self.unit) or as_ending(self.unit)
        ending = "deg" if ending == "arcsec" and name.endswith("_angle") else ending
        return self.column or (f"{name}_{ending}" if ending else name)

    def heads(self, name: str) -> tuple[str, ...]:
        """Heads of its columns in the table of positions."""
        if self.columns is not None:
            return self.columns
        if self.dims == OVER_CYCLE:
            return (f"{{}}_{self.head(name)}",)
        if self.at_base_circle:
            return self.head(name), f"{name}_um"
        return (self.head(name),) if self.dims in (CYCLE, PAIRS, CYCLE[1:]) or name == "torque" else ()

    def factor(self, head: str) -> float:
        """Factor to the unit that a head tells."""
        return self.times * (1.0 if self.unit == "um" else factor_of(head))


def numbers(parts: Mapping[str, Part], asked: Asked | None = None) -> dict[str, Number]:
    """Numbers of parts, of which only those with a column, a label or needs of their own are declared as ``Number``.

    Parameters
    ----------
    parts : mapping
        Name -> dimensions, unit, long name.
    asked : Asked, optional
        When a result has them.
    """
    declared = {name: part if isinstance(part, Number) else Number(*part) for name, part in parts.items()}
    return {name: part.changed(asked=asked) if asked else part for name, part in declared.items()}


class Numbers:
    """Numbers of a result in a dataset, each of them an attribute by its declared name.

    Attributes
    ----------
    NUMBERS : mapping
        Name -> what is declared of it.
    COORDINATES : tuple of str
        Names that are coordinates of the dataset.
    BASE_RADIUS : str
        Number [mm] at which angles of the transmission error become lengths.
    dataset : xarray.Dataset
    """

    NUMBERS: ClassVar[Mapping[str, Number]] = {}
    COORDINATES: ClassVar[tuple[str, ...]] = ()
    BASE_RADIUS: ClassVar[str] = "wheel_base_radius"
    if TYPE_CHECKING:

        @property
        def dataset(self) -> xarray.Dataset:
            """All numbers, with their units."""

    def __getattr__(self, name: str) -> Any:
        if name in self.NUMBERS:
            if lacks := self.lacking(name):
                raise NotAskedError(f"{name}: {lacks}")
            if self.has(name):
                values = self.values(name)
                return values if values.ndim else values.item()
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *filter(self.has, self.NUMBERS)]

    def has(self, name: str) -> bool:
        """Whether the result has a number."""
        return name in self.dataset

    def lacking(self, name: str) -> str:
        """Why the result does not have a number that it may have, in words; nothing if it has it."""
        asked = self.NUMBERS[name].asked
        return "" if asked is None or self.has(name) else asked.lacks.format(gear=name.partition("_")[0])

    def values(self, name: str) -> Array:
        """Array of a number that the result has."""
        return np.asarray(self.dataset.variables[name].values)

    def along(self, axis: str) -> list[Any]:
        """What counts along an axis: gears by their names, directions, numbers of tooth pairs."""
        directions: dict[str, list[Any]] = {"gear": [*GEARS], "axis": ["x", "y"]}
        return directions[axis] if axis in directions else [*self.dataset[axis].values.tolist()]

    @classmethod
    def dataset_of(
        cls, arrays: Mapping[str, Any], labels: Mapping[str, Sequence[str]] | None = None, /, **about: str
    ) -> xarray.Dataset:
        """Make a dataset of the arrays of all numbers, those that not all results have where there are any.

        Parameters
        ----------
        arrays : mapping of str to array
        labels : mapping of str to sequence of str, optional
            What counts along dimensions, as coordinates of their names.
        **about : str
            Attributes of ``ABOUT``.
        """
        import xarray

        there = {name: part for name, part in cls.NUMBERS.items() if part.asked is None or name in arrays}
        variables = variables_of(there, arrays)
        coordinates = {name: variables.pop(name) for name in cls.COORDINATES}
        along = {name: [*texts] for name, texts in (labels or {}).items()}
        return xarray.Dataset(variables, coordinates | along, about)

    @property
    def um_per_rad(self) -> float:
        """What a transmission error of one rad is at the base circle [um]."""
        return MICROMETRES * float(self.dataset[self.BASE_RADIUS])

    @property
    def version(self) -> str:
        """Version of the package that made the result; empty if its file does not have it."""
        return str(self.dataset.attrs.get("version", ""))

    @property
    def date(self) -> str:
        """Date of the analysis after ISO 8601, in UTC; empty if the file of the result does not have it."""
        return str(self.dataset.attrs.get("date", ""))

    @property
    def warnings(self) -> tuple[str, ...] | None:
        """Sentences of the accuracy warnings of the analysis; None if the file of the result does not have them."""
        sentences = self.dataset.attrs.get("warnings")
        return None if sentences is None else tuple(str(sentences).splitlines())

    @property
    def left_out(self) -> str:
        """Sentence on what the numbers of a half of a double helical pair leave out; empty: of a whole pair."""
        return str(self.dataset.attrs.get("left_out", ""))


@dataclass(frozen=True, eq=False)
class Row:
    """A result under one torque: what its key figures are read off.

    Attributes
    ----------
    result : Result
    row : int
        Index of the torque.
    """

    result: Any
    row: int

    def __getattr__(self, name: str) -> Any:
        """Return the numbers of this torque of an array of the result whose first axis is the torque."""
        return getattr(self.result, name)[self.row]
