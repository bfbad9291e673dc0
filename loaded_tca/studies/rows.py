"""Rows of a study on disk: each is there once its variant is done, whatever happens to the others.

The result of a study has the rows of its variants as a dataset, in one file.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array
from loaded_tca.errors import InputError, reason_of
from loaded_tca.input_files import require_regular
from loaded_tca.results.files import STUDY, FilePath, make_directory, read_dataset
from loaded_tca.scene.keys import literal, shown
from loaded_tca.studies.stage import TORQUES
from loaded_tca.studies.study import Study, told_distribution

if TYPE_CHECKING:
    import xarray


STATUSES = ("ok", "refused", "not converged", "fault")
"""Of a variant: analysed; its scene or geometry refused; not converged; any other error, a fault of the program."""
OTHERS = ("sample", "torque", "status", "reason", "warnings", "seconds")
"""What else stands beside figures in the result."""
FIGURE = re.compile("[A-Za-z][A-Za-z0-9_]*")
"""The name of a figure, which is that of a variable in a file, too, and of a picture."""
CHECKSUM, END = b', "checksum": "', b'"}\n'
"""End of a line, with the SHA-256 of all bytes before it in between. Rows of 0.2.0 have none."""
MOST_TOLD = 5
"""Damaged rows of a file that a warning tells; more of them are counted."""

Row = dict[str, Any]


def problem_of_figures(figures: Any) -> str:
    """What is wrong with the figures of a variant; nothing if all are lists of numbers, of one length or a single one.

    Examples
    --------
    >>> problem_of_figures({"span_um": [0.5, 0.7], "seconds": [1.0]})
    "name 'seconds'; allowed letters, digits and _, but not sample, torque, status, reason, warnings, seconds"
    """
    if not isinstance(figures, dict):
        return f"found {shown(figures)}; allowed lists of numbers by their names"
    for name, values in figures.items():
        if not isinstance(name, str) or not FIGURE.fullmatch(name) or name in OTHERS:
            return f"name {name!r:.60}; allowed letters, digits and _, but not {', '.join(OTHERS)}"
        if not isinstance(values, list) or {*map(type, values)} != {float}:
            return f"{name}: found {shown(values)}; allowed a list of decimal numbers"
    lengths = {len(values): name for name, values in figures.items() if len(values) > 1}
    if len(lengths) > 1:
        lengths_of = " and ".join(f"{name} {length}" for length, name in lengths.items())
        return f"different numbers of torques: {lengths_of}; allowed a number, or one for each torque"
    return ""


def _is_text(value: Any) -> bool:
    """Whether a value is a text that a file can hold, which half of a surrogate pair is not."""
    return isinstance(value, str) and value == value.encode(errors="replace").decode()


def _refusal(holds: Callable[[Any], bool], allowed: str) -> Callable[[Any], str]:
    return lambda value: "" if holds(value) else f"found {shown(value)}; allowed {allowed}"


PARTS: dict[str, Callable[[Any], str]] = {
    "digest": _refusal(_is_text, "a text"),
    "status": _refusal(STATUSES.__contains__, ", ".join(STATUSES)),
    "reason": _refusal(_is_text, "a text"),
    "warnings": _refusal(lambda lines: isinstance(lines, list) and all(map(_is_text, lines)), "a list of texts"),
    "seconds": _refusal(lambda value: type(value) is float and 0.0 <= value < math.inf, "a number from 0 on"),
    "figures": problem_of_figures,
}
"""Parts of a row, each with what is wrong with a value of it."""


def line_of(row: Row) -> bytes:
    """The line of a file that holds a row: JSON, whose last part is a checksum of what stands before it."""
    content = json.dumps(row).encode()[:-1]
    return content + CHECKSUM + _checksum(content) + END


def row_of(line: bytes) -> Row:
    """The row of a line.

    Raises
    ------
    ValueError
        If the line is damaged, or is no row; says why.

    Examples
    --------
    >>> row = dict(digest="a", status="ok", reason="", warnings=[], seconds=0.5, figures={"span_um": [0.7]})
    >>> row_of(line_of(row)) == row
    True
    >>> row_of(line_of(row).replace(b"0.7", b"0.8"))
    Traceback (most recent call last):
    ...
    ValueError: its bytes are not those that were written
    """
    content, separator, end = line.rpartition(CHECKSUM)
    if separator and end != _checksum(content) + END:
        raise ValueError("its bytes are not those that were written")
    row = _json(content + b"}" if separator else line)
    if not isinstance(row, dict) or set(row) != set(PARTS):
        raise ValueError(f"no row of a study; its parts are {', '.join(PARTS)}")
    for name, problem in PARTS.items():
        if wrong := problem(row[name]):
            raise ValueError(f"{name}: {wrong}")
    return row


def _checksum(content: bytes) -> bytes:
    return hashlib.sha256(content).hexdigest().encode()


def _json(text: bytes) -> Any:
    try:
        return json.loads(text, object_pairs_hook=_each_once)
    except (RecursionError, ValueError) as error:
        raise ValueError(f"no JSON: {error}") from None


def _each_once(pairs: list[tuple[str, Any]]) -> Row:
    table = dict(pairs)
    if len(table) < len(pairs):
        raise ValueError("a name is given twice")
    return table


class Rows:
    """A file with one line for every variant that is done, in the order in which they were.

    Parameters
    ----------
    path : str or path
        Made if it does not exist. A line that was not written to its end is cut off, one that is damaged stays where it
        is and counts as missing.

    Attributes
    ----------
    damaged : dict of int to str
        Numbers of the damaged lines, from 1 on, and what is wrong with each.

    Raises
    ------
    InputError
        If the file cannot be read or written, or is no regular one.
    """

    def __init__(self, path: FilePath) -> None:
        self.path = Path(path)
        self.damaged: dict[int, str] = {}
        self._places: dict[str, int] = {}
        make_directory(self.path.parent)
        require_regular(self.path)
        try:
            self._file = os.open(self.path, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o666)
            os.ftruncate(self._file, self._read())
        except OSError as error:
            raise InputError(f"{self.path}: cannot be written: {reason_of(error)}") from error

    def __enter__(self) -> Rows:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        os.close(self._file)

    def __contains__(self, digest: str) -> bool:
        return digest in self._places

    def __len__(self) -> int:
        return len(self._places)

    @property
    def damage(self) -> str:
        """A sentence that says which rows are damaged and why."""
        sentences = [f"row {number}: {problem}" for number, problem in self.damaged.items()]
        if len(sentences) > MOST_TOLD:
            sentences[MOST_TOLD:] = [f"and {len(sentences) - MOST_TOLD} more"]
        return f"{self.path}: rows that cannot be used, their variants are analysed again: {'; '.join(sentences)}"

    def append(self, rows: Sequence[Row]) -> None:
        """Write rows down; where there is no room for all, those that fit, and an InputError."""
        lines = [*map(line_of, rows)]
        content, written = b"".join(lines), 0
        try:
            while written < len(content):
                written += os.write(self._file, content[written:])
        except OSError as error:
            raise InputError(f"{self.path}: cannot be written: {reason_of(error)}") from error
        finally:  # the file itself says where they are: another run of the study may have written in between
            end = os.lseek(self._file, 0, os.SEEK_CUR)
            place = end - written
            for row, line in zip(rows, lines, strict=True):
                if place + len(line) > end:
                    os.ftruncate(self._file, place)
                    break
                self._places[row["digest"]] = place
                place += len(line)

    def of(self, digests: Iterable[str]) -> Iterator[Row]:
        """Rows in the order asked for, read one by one."""
        with open(self.path, "rb") as file:
            for digest in digests:
                file.seek(self._places[digest])
                row: Row = json.loads(file.readline())
                row.pop("checksum", None)  # which fits: else the row had no place
                yield row

    def _read(self) -> int:
        """Find the rows of the file; bytes up to the end of its last whole line."""
        place = 0
        with open(self.path, "rb") as file:
            for number, line in enumerate(file, 1):
                if not line.endswith(b"\n"):
                    break
                try:
                    digest = row_of(line)["digest"]
                    if CHECKSUM in line or digest not in self._places:  # one without a checksum replaces no other
                        self._places[digest] = place
                except ValueError as error:
                    self.damaged[number] = str(error)
                place += len(line)
        return place


def dataset_of(study: Study, rows: Iterable[Row], attributes: dict[str, Any]) -> xarray.Dataset:
    """Gather the rows of all variants, in their order.

    Parameters
    ----------
    study : Study
    rows : iterable of Row
        Of all variants; read one by one.
    attributes : dict

    Returns
    -------
    xarray.Dataset
        Dimensions sample (the number of the variant) and torque [N mm], which has a coordinate where all variants have
        the same. Over both the key figures, NaN where there are none; over the samples the varied
        keys (coordinates, lists as texts, with the attribute ``sampling``: "table", "factor" or "distribution", and of
        the last one ``distribution``: its name and parameters), ``status``, ``reason``, ``warnings`` (lines) and
        ``seconds``.
    """
    import xarray

    count = len(study)
    texts: dict[str, list[str]] = {"status": [], "reason": [], "warnings": []}
    same: dict[str, str] = {}  # many variants say the same: one text in memory for all
    seconds = np.empty(count)
    arrays: dict[str, Array] = {}
    torques = 1
    for sample, row in enumerate(rows):
        columns = row["status"], row["reason"], "\n".join(row["warnings"])
        for column, text in zip(texts.values(), columns, strict=True):
            column.append(same.setdefault(text, text))
        seconds[sample] = row["seconds"]
        for name, values in row["figures"].items():
            if len(values) > torques:
                torques = len(values)
                arrays = {known: _widened(array, torques) for known, array in arrays.items()}
            if name not in arrays:  # once a figure: an array a row would make large studies grow by the square
                arrays[name] = np.full((count, torques), np.nan)
            arrays[name][sample, : len(values)] = values
    variables = {name: (("sample", "torque"), array) for name, array in arrays.items()}
    own = {name: ("sample", np.array(column, dtype=object)) for name, column in texts.items()}
    spent = ("sample", seconds, {"units": "s", "long_name": "time of the analysis"})
    places: dict[str, tuple[Any, ...]] = {"sample": ("sample", np.arange(count, dtype=np.int32))}
    torque = 1e3 * next((arrays[name] for name in TORQUES if name in arrays), np.full((1, torques), np.nan))
    known = torque[np.isfinite(torque).any(axis=1)]  # one of fewer torques has others
    if len(known) and (known == known[0]).all():  # the same in all variants
        places["torque"] = ("torque", known[0], {"units": "N mm"})
    return xarray.Dataset(
        {**variables, **own, "seconds": spent}, coords={**places, **_varied(study)}, attrs={"kind": STUDY, **attributes}
    )


def _widened(array: Array, torques: int) -> Array:
    """The array with room for more torques."""
    return np.pad(array, ((0, 0), (0, torques - array.shape[1])), constant_values=np.nan)


def _varied(study: Study) -> dict[str, tuple[str, Array, dict[str, str]]]:
    """Values of the varied keys over the samples; lists, and booleans beside other values, as scene files have them."""
    columns: dict[str, list[Any]] = {key: [] for key in study.keys}
    for variant in range(len(study)):
        for key, value in study.changes(variant).items():
            columns[key].append(value if isinstance(value, int | float | str) else literal(value))
    for column in columns.values():
        if len({isinstance(value, bool) for value in column}) > 1:
            column[:] = [literal(value) if isinstance(value, bool) else value for value in column]
    ways = [("table", study.table), ("factor", study.factors), ("distribution", study.distributions)]
    sampling = {key: {"sampling": way} for way, keys in ways for key in keys}
    for key, distribution in study.distributions.items():
        sampling[key]["distribution"] = told_distribution(distribution)
    return {key: ("sample", np.array(column), sampling[key]) for key, column in columns.items()}


@checked
def load_study(path: FilePath) -> xarray.Dataset:
    """Read the result of a study.

    Parameters
    ----------
    path : str or path
        File that ``run_study`` wrote.

    Raises
    ------
    InputError
        If the file cannot be read, is damaged, or is no study.
    """
    dataset = read_dataset(path)
    if dataset.attrs.get("kind") != STUDY:
        raise InputError(f"{path}: a result of loaded_tca, but no study; read it with load_result")
    return dataset
