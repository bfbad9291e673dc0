"""The base of all results: figures, summary, table and file of the numbers that each kind of result declares."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.errors import InputError, require
from loaded_tca.notebooks import InNotebooks
from loaded_tca.results.declared import ABOUT, CYCLE, Number, Numbers, Row
from loaded_tca.results.figure import Figure, Figures, labelled
from loaded_tca.results.files import (
    Buffer,
    FilePath,
    Part,
    arrays_of,
    netcdf_of,
    read_kind,
    replace_file,
    replace_together,
)
from loaded_tca.results.summary import shown, summary_of
from loaded_tca.results.tables import Columns, frame_of, require_openpyxl, sentences_table, workbook_of
from loaded_tca.scene import parse_scene
from loaded_tca.units import without_unit

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    import pandas
    import xarray

    from loaded_tca.arrays import Array


def figures_of(numbers: Mapping[str, Number]) -> dict[str, Figure]:
    """Key figures that numbers under a torque are by their label, by the heads of their columns."""
    return {
        head: Figure(
            of=partial(_number, name, number.factor(head)),
            label=number.label,
            largest_is_best=number.largest_is_best,
            needs=name,
        )
        for name, number in numbers.items()
        if number.label
        for head in (number.head(name),)
    }


def _number(name: str, factor: float, under: Row) -> float:
    return factor * float(getattr(under, name))


class Result(InNotebooks, Numbers, ABC):
    """Numbers of a result with their key figures under each torque, summary, table and file.

    A kind of result declares its ``NUMBERS`` and its ``FIGURES``; all of this follows.

    Attributes
    ----------
    KIND, WHAT : str
        Attribute ``kind`` of its files, and what messages call them.
    TITLE : str
        First line of the summary of what has no title.
    SUBJECT : str
        Attribute that was analysed: its title, and its text in files.
    FILE, JSON : str
        Names of its own file and of that of its key figures in a directory; none of what has no such file.
    TABLES : mapping of str to str
        Names of the files of its tables there -> names of ``tables``.
    FIGURES : mapping
        Key figures by their names; numbers under a torque that have a label follow them.
    """

    KIND: ClassVar[str] = ""
    WHAT: ClassVar[str]
    TITLE: ClassVar[str]
    SUBJECT: ClassVar[str] = "scene"
    FILE: ClassVar[str] = ""
    JSON: ClassVar[str] = ""
    TABLES: ClassVar[Mapping[str, str]] = {}
    FIGURES: ClassVar[Mapping[str, Figure]] = {}

    @property
    def title(self) -> str:
        """Title of what was analysed."""
        return str(getattr(self, self.SUBJECT).title)

    @classmethod
    def declared_figures(cls) -> dict[str, Figure]:
        """Key figures of this kind of result, by their names, which end in their unit."""
        declared = {**figures_of(cls.NUMBERS), **cls.FIGURES}
        return {name: declared[name] for name in dict.fromkeys((*cls.FIGURES, *declared))}

    @property
    def figures(self) -> dict[str, Figure]:
        """Key figures that the result has, by their names, which end in their unit."""
        declared = self.declared_figures()
        return {name: figure for name, figure in declared.items() if not figure.needs or self.has(figure.needs)}

    def key_figures(self) -> tuple[dict[str, float], ...]:
        """Return the figures for each torque, by names that end in their unit; NaN: not known."""
        return tuple({**row} for row in self._key_figures)

    @cached_property
    def _key_figures(self) -> tuple[dict[str, float], ...]:
        """Those of :meth:`key_figures`, which tables, summaries and reports all ask for."""
        rows = (self.under(torque) for torque in range(self.dataset["torque"].size))
        return tuple({name: figure.of(row) for name, figure in self.figures.items()} for row in rows)

    def under(self, torque: int) -> Row:
        """What figures are read off: the result under a torque, by its index."""
        return Row(self, torque)

    def figure_arrays(self) -> dict[str, Array]:
        """Return the key figures as arrays (torques,) by their names, as studies take them."""
        rows = self.key_figures()
        return {name: np.array([row[name] for row in rows], dtype=float) for name in rows[0]}

    @property
    @abstractmethod
    def scope(self) -> str:
        """What was analysed, in a line."""

    def labels(self) -> dict[str, str]:
        """Labels of the lines of the summary with their units, by the names of key figures."""
        return {
            name: labelled(name, figure.label or without_unit(name).replace("_", " "))
            for name, figure in self.figures.items()
        }

    def rows(self, figures: Sequence[Figures]) -> list[tuple[str, ...]]:
        """Lines of the summary: label with unit, and a cell for each torque."""
        return [(label, *(shown(row[name], name) for row in figures)) for name, label in self.labels().items()]

    def notes(self) -> tuple[str, ...]:
        """Sentences on what limits the figures."""
        return (self.left_out,) if self.left_out else ()

    def summary(self) -> str:
        """Return the figures in the engineer's units, a column for each torque, notes, and accuracy warnings."""
        return summary_of(self.title or self.TITLE, self.scope, self.rows(self.key_figures()), self.sentences())

    def sentences(self) -> dict[str, tuple[str, ...]]:
        """Sentences below the figures by the word that each begins with: what limits them, accuracy warnings."""
        return {"note": self.notes(), "warning": self.warnings or ()}

    def to_table(self) -> dict[str, Array]:
        """Return the numbers of every torque and position as columns, by names that end in their unit."""
        shape = tuple(self.dataset.sizes[axis] for axis in CYCLE)
        return {head: np.broadcast_to(values, shape).ravel() for head, values in self._columns()}

    def tables(self) -> dict[str, Callable[[], Columns]]:
        """Tables of the result by the names that ``to_pandas`` takes and sheets of ``to_excel`` have."""
        torque = self.NUMBERS["torque"].head("torque")
        of_cycle = [name for name in self.COORDINATES if self.NUMBERS[name].dims in (CYCLE[:1], CYCLE[1:])]
        index = tuple(self.NUMBERS[name].head(name) for name in of_cycle)
        return {
            "figures": lambda: Columns(self.figure_arrays(), (torque,)),
            "positions": lambda: Columns(self.to_table(), index),
        }

    def to_pandas(self, table: str | None = None) -> pandas.DataFrame:
        """Return a table of the result as a frame, whose columns have the heads of the CSV files, which tell the units.

        Parameters
        ----------
        table : str, optional
            ``"figures"``: key figures, a row for each torque; ``"positions"``: a row for each torque and position,
            the default where the result has them. Mesh cycles with load sharing have ``"contacts"``, a row for each
            tooth pair under load, too; double helical pairs on shafts ``"bearings"``; revolutions ``"teeth"`` and
            ``"orders"``, those of double helical pairs ``"orders"``, tribology ``"slices"``.

        Returns
        -------
        pandas.DataFrame
            Torques [N m], positions (from 1; elsewhere angles [deg]), tooth pairs are its index. NaN: not known.

        Raises
        ------
        InputError
            If the result has no such table.
        """
        tables = self.tables()
        name = ("positions" if "positions" in tables else "figures") if table is None else table
        require((name in tables, f"table: {name!r:.60}; the result has {', '.join(tables)}"))
        return frame_of(tables[name]())

    @checked
    def to_excel(self, path: FilePath) -> Path:
        """Write all tables into a workbook of Excel, whole or not at all, with the units in the heads.

        A sheet for each table of ``to_pandas``, and ``warnings`` with notes and accuracy warnings, what they mean and
        what to do about them. Numbers have all their digits; empty cells: not known.

        Parameters
        ----------
        path : str or path
            Of the workbook; ends in .xlsx.

        Returns
        -------
        pathlib.Path

        Raises
        ------
        InputError
            If the package openpyxl is not installed (extra ``excel``), the path has another ending, a table has more
            rows than a sheet takes, or the file cannot be written.
        """
        require_openpyxl(path)
        sheets = {name: frame_of(table()) for name, table in self.tables().items()}
        sheets["warnings"] = frame_of(sentences_table(self.sentences()))
        about = f"{self.WHAT}; {self.scope}; loaded_tca {self.version}, {self.date}".removesuffix(", ")
        replace_file(path, workbook_of(sheets, self.title or self.TITLE, about))
        return Path(path)

    def _columns(self) -> Iterator[tuple[str, Array]]:
        for name, number in self.NUMBERS.items():
            for head in number.heads(name) if self.has(name) else ():
                at_base = number.unit == "rad" and head.endswith("_um")
                factor = self.um_per_rad if at_base else number.factor(head)
                if "{" in head:
                    for k, label in enumerate(self.along(number.dims[-1])):
                        yield head.format(label), self._times(factor, self.values(name)[..., k])
                    continue
                values = self._times(factor, self.at_position(name) if "pair" in number.dims else self.values(name))
                yield head, values[:, None] if number.dims == CYCLE[:1] else values

    @staticmethod
    def _times(factor: float, values: Array) -> Array:
        """Values times a factor; counts stay whole numbers."""
        return values if factor == 1.0 else factor * values

    @checked
    def save(self, path: FilePath) -> tuple[Path, ...]:
        """Write everything to a NetCDF-3 file, whole or not at all; ``load`` reads it back unchanged.

        Returns
        -------
        tuple of Path
            The file.

        Raises
        ------
        InputError
            If the file cannot be written, NetCDF-3 has no type for what was added to the dataset, or the scene asks for
            numbers that the result does not have.
        """
        replace_file(path, self.to_netcdf())
        return (Path(path),)

    def to_netcdf(self) -> Buffer:
        """Return the bytes of the file that ``save`` writes, with the same errors."""
        about = {"title": self.title, f"{self.SUBJECT}_toml": getattr(self, self.SUBJECT).to_toml()}
        kind = {"kind": self.KIND} if self.KIND else {}
        return netcdf_of(self.stored().assign_attrs(kind | about))

    def stored(self) -> xarray.Dataset:
        """The dataset as files have it."""
        return self.dataset

    def contents(self) -> dict[str, Buffer]:
        """Names and contents of the files in a directory from which the result is read again."""
        return {self.FILE: self.to_netcdf()} if self.FILE else {}

    def outdated(self, directory: Path) -> set[str]:  # noqa: ARG002
        """Names of files in a directory that belong to another result of the kind, which writing this one removes."""
        return set()

    @classmethod
    def file_names(cls) -> tuple[str, ...]:
        """Names of its own file, of that of its key figures and of those of its tables."""
        return tuple(filter(None, (cls.FILE, cls.JSON, *cls.TABLES)))

    def beside_figures(self) -> dict[str, Any]:
        """What the file of the key figures has beside them; None: not known."""
        return {"warnings": self.warnings or ()}


class AnalysisResult(Result):
    """Result of an analysis, which its file holds whole, with the text of what was analysed.

    Attributes
    ----------
    BESIDE : mapping
        Dimensions, unit and long name of arrays that files have beside the dataset.
    BESIDE_SOME : mapping
        The same of arrays that only some files have.
    ABOUT : tuple of str
        Attributes of the dataset that files keep.
    """

    BESIDE: ClassVar[Mapping[str, Part]] = {}
    BESIDE_SOME: ClassVar[Mapping[str, Part]] = {}
    ABOUT: ClassVar[tuple[str, ...]] = ABOUT

    @classmethod
    @checked
    def load(cls, path: FilePath) -> Self:
        """Read a file that ``save`` wrote.

        Raises
        ------
        InputError
            If it cannot be read, is damaged, or is no such file.
        """
        file = read_kind(path, cls.KIND, cls.WHAT)
        if problem := cls.problem_of(file):
            raise InputError(f"{path}: not {cls.WHAT}: {problem}")
        try:
            subject = cls.parse(str(file.attrs.get(f"{cls.SUBJECT}_toml", "")), source=f"{cls.SUBJECT}_toml")
            there = {
                name: number
                for name, number in cls.NUMBERS.items()
                if number.asked is None or number.asked.by(subject, name.partition("_")[0]) or name in file.variables
            }
            some = {name: part for name, part in cls.BESIDE_SOME.items() if name in file.variables}
            stored = {**there, **cls.BESIDE, **some}
            arrays = arrays_of(file, stored)
            parts = cls.parts_of(subject, file, arrays)
        except InputError as error:
            raise InputError([f"{path}: not {cls.WHAT}", *error.problems]) from None
        about = {name: str(file.attrs[name]) for name in cls.ABOUT if name in file.attrs}
        added = {name: file.variables[name] for name in file.data_vars if name not in stored}
        dataset = cls.dataset_of(arrays, **about).assign(added)
        whole = {cls.SUBJECT: subject, "dataset": dataset, **parts, **cls.parts_beside(Path(path), subject, dataset)}
        return cls(**whole)

    @staticmethod
    def parse(text: str, source: str) -> Any:
        """What was analysed, of its text."""
        return parse_scene(text, source=source, folder=None)

    @classmethod
    def problem_of(cls, file: xarray.Dataset) -> str:  # noqa: ARG003
        """Why a file is of something else, rather than a line for all that it lacks; nothing if it may be one."""
        return ""

    @classmethod
    def parts_of(cls, subject: Any, file: xarray.Dataset, arrays: Mapping[str, Array]) -> dict[str, Any]:  # noqa: ARG003
        """What else the result consists of, of the arrays of a file; with checks of their lengths."""
        return {}

    @classmethod
    def parts_beside(cls, path: Path, subject: Any, dataset: xarray.Dataset) -> dict[str, Any]:  # noqa: ARG003
        """What else the result consists of, of files beside its own."""
        return {}


class JoinedResult(AnalysisResult):
    """Result that joins other ones, which have files of their own beside its own.

    Attributes
    ----------
    PARTS : mapping of str to str
        Attributes that are results -> names of their files.
    PART : type
        Kind of these.
    """

    PARTS: ClassVar[Mapping[str, str]]
    PART: ClassVar[type[AnalysisResult]]

    @classmethod
    def parts_beside(cls, path: Path, subject: Any, dataset: xarray.Dataset) -> dict[str, Any]:  # noqa: ARG003
        """The parts, of the files beside that of the result."""
        return dict(zip(cls.PARTS, cls.read_parts(path, subject, cls.PARTS.values()), strict=True))

    @classmethod
    def read_parts(cls, path: Path, subject: Any, names: Iterable[str]) -> tuple[Any, ...]:
        """Parts of the files of these names beside that of the result; those of something else are refused."""
        places = [path.parent / name for name in names]
        parts = tuple(cls.PART.load(place) for place in places)
        cls.require_parts(subject, places, parts)
        return parts

    @classmethod
    @abstractmethod
    def require_parts(cls, subject: Any, places: Sequence[Path], parts: Sequence[Any]) -> None:
        """Refuse parts that are not those of what was analysed; InputError with the place of the file."""

    @checked
    def save(self, directory: FilePath) -> tuple[Path, ...]:
        """Write the result and its parts into a directory, each into its file (``FILE``, ``PARTS``), all or none.

        Raises
        ------
        InputError
            If they cannot be written.
        """
        return replace_together(directory, self.contents(), self.outdated(Path(directory)))

    def parts(self) -> dict[str, AnalysisResult]:
        """The results that it joins, by the names of their files."""
        return {file: getattr(self, name) for name, file in self.PARTS.items()}

    def contents(self) -> dict[str, Buffer]:
        """Names and contents of the files that ``save`` writes."""
        return super().contents() | {file: part.to_netcdf() for file, part in self.parts().items()}

    @classmethod
    @checked
    def load(cls, directory: FilePath) -> Self:
        """Read the files that ``save`` wrote into a directory.

        Parameters
        ----------
        directory : str or path
            The directory, or the file ``FILE`` in it.

        Raises
        ------
        InputError
            If one cannot be read, is damaged, or is no such file.
        """
        place = Path(directory)
        return super().load(place / cls.FILE if place.is_dir() or place.name != cls.FILE else place)
