"""Files that hold results: NetCDF-3 with a unit on every variable, each written whole or not at all."""

from __future__ import annotations

import io
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.io import netcdf_file

from loaded_tca.errors import InputError

FORMAT = "loaded_tca"
FORMAT_VERSION = 2
"""Raised whenever the code of one version cannot read the files of another."""

FilePath = str | os.PathLike[str]

_STORED_AS: dict[str, np.dtype[Any]] = {"f": np.dtype(float), "i": np.dtype(np.int32), "b": np.dtype(np.int8)}
"""Kind of an array -> type in the file: NetCDF-3 knows neither bool nor int64."""
_IN_MEMORY: dict[str, np.dtype[Any]] = {"f": np.dtype(float), "i": np.dtype(int), "b": np.dtype(bool)}


@dataclass(frozen=True, eq=False)
class Variable:
    """An array of numbers or flags with what a reader of the file must know of it.

    Parameters
    ----------
    dimensions : tuple of str
        One name per axis.
    data : array
        Of floats, of integers of up to 32 bits, or of bool.
    unit : str
        As CF writes it, "1" for pure numbers.
    text : str
        What it is, in a few words.
    """

    dimensions: tuple[str, ...]
    data: NDArray[Any]
    unit: str
    text: str


Part = tuple[tuple[str, ...], str, str]
"""Dimensions, unit and text of an array that an object holds."""


def pack(source: object, parts: Mapping[str, Part], prefix: str = "") -> dict[str, Variable]:
    """Make variables of attributes of an object.

    Parameters
    ----------
    source : object
    parts : mapping
        Attribute -> what the file says of it.
    prefix : str
        Before the names in the file.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> wheel = SimpleNamespace(width=25.0)
    >>> variables = pack(wheel, {"width": ((), "mm", "face width")}, "wheel_")
    >>> variables["wheel_width"].unit
    'mm'
    >>> unpack(variables, {"width": ((), "mm", "face width")}, "wheel_")
    {'width': array(25.)}
    """
    return {
        prefix + name: Variable(dimensions, np.asarray(getattr(source, name)), unit, text)
        for name, (dimensions, unit, text) in parts.items()
    }


def unpack(variables: Mapping[str, Variable], parts: Mapping[str, Part], prefix: str = "") -> dict[str, NDArray[Any]]:
    """Return the arrays that ``pack`` stored; InputError if one is missing or has other dimensions."""
    problems = []
    for name, (dimensions, _, _) in parts.items():
        found = variables.get(prefix + name)
        if found is None:
            problems.append(f"{prefix}{name}: missing")
        elif found.dimensions != dimensions:
            problems.append(f"{prefix}{name}: found dimensions {found.dimensions}, expected {dimensions}")
    if problems:
        raise InputError(problems)
    return {name: variables[prefix + name].data for name in parts}


def write_netcdf(path: FilePath, variables: Mapping[str, Variable], attributes: Mapping[str, str]) -> None:
    """Write variables to a NetCDF-3 file, whole or not at all.

    Parameters
    ----------
    path : str or path
        Replaced if it exists.
    variables : mapping
        Name -> variable; dimensions of one name have one length, not zero.
    attributes : mapping
        Name -> text about the whole file.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    with replacing(path) as temporary, _opened(temporary, "w") as file:
        for name, text in {"format": FORMAT, "format_version": str(FORMAT_VERSION), **attributes}.items():
            setattr(file, name, _encoded(text))
        for name, variable in variables.items():
            _write_variable(file, name, variable)


def read_netcdf(path: FilePath) -> tuple[dict[str, Variable], dict[str, str]]:
    """Read a file that ``write_netcdf`` wrote.

    Returns
    -------
    variables, attributes : dict, dict
        As they were written, flags as bool, integers as the platform's int.

    Raises
    ------
    InputError
        If the file cannot be read, is damaged, no NetCDF-3 file, not of this package, or of another format.
    """
    content = read_bytes(path)
    try:
        with _opened(io.BytesIO(content), "r") as file:
            attributes = {name: _decoded(value) for name, value in file._attributes.items()}
            variables = {name: _read_variable(variable) for name, variable in file.variables.items()}
    except Exception as error:  # on a damaged file the reader stumbles in any way
        kind = "damaged" if content.startswith(b"CDF") else "not a NetCDF-3 file"
        raise InputError(f"{path}: {kind}; expected a result file written by loaded_tca") from error
    _check_format(path, attributes)
    return variables, attributes


def read_bytes(path: FilePath) -> bytes:
    """Return the content of a file; InputError if it cannot be read."""
    try:
        return Path(path).read_bytes()
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read: {_reason(error)}") from error


@contextmanager
def replacing(path: FilePath) -> Iterator[Path]:
    """Give a temporary name beside ``path``, and put that file in its place if all went well.

    Whatever happens, an interrupt included, ``path`` is either the old file or the whole new one.

    Raises
    ------
    InputError
        If the file cannot be written.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as directory:
    ...     with replacing(Path(directory, "a.txt")) as temporary:
    ...         _ = temporary.write_text("all of it")
    ...     Path(directory, "a.txt").read_text()
    'all of it'
    """
    target = Path(path)
    temporary = target.with_name(f".{target.name}.{os.getpid()}.part")
    try:
        yield temporary
        temporary.replace(target)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {_reason(error)}") from error
    finally:
        temporary.unlink(missing_ok=True)


def remove(path: FilePath) -> None:
    """Remove a file if it is there; InputError if that cannot be done."""
    try:
        Path(path).unlink(missing_ok=True)
    except OSError as error:
        raise InputError(f"{path}: cannot be removed: {_reason(error)}") from error


def _opened(file: Path | io.BytesIO, mode: Literal["r", "w"]) -> Any:
    return netcdf_file(file, mode, mmap=False, version=2)


def _reason(error: Exception) -> str:
    return getattr(error, "strerror", None) or str(error)


def _encoded(text: str) -> bytes:
    """UTF-8; a blank for the empty text, since NetCDF-3 has no empty attribute."""
    return text.encode() or b" "


def _decoded(value: Any) -> str:
    text: str = value.decode() if isinstance(value, bytes) else str(value)
    return "" if text == " " else text


def _write_variable(file: Any, name: str, variable: Variable) -> None:
    data = np.asarray(variable.data)
    for dimension, length in zip(variable.dimensions, data.shape, strict=True):
        if dimension not in file.dimensions:
            file.createDimension(dimension, length)
    stored = _STORED_AS[data.dtype.kind]
    target = file.createVariable(name, stored, variable.dimensions)
    target.units, target.long_name = _encoded(variable.unit), _encoded(variable.text)
    if data.dtype.kind == "b":
        target.dtype = b"bool"  # as xarray marks them
    target[...] = data.astype(stored)


def _read_variable(variable: Any) -> Variable:
    data = np.array(variable.data)
    kind = "b" if "dtype" in variable._attributes else data.dtype.kind
    unit, text = _decoded(variable.units), _decoded(variable.long_name)
    return Variable(tuple(variable.dimensions), data.astype(_IN_MEMORY[kind]), unit, text)


def _check_format(path: FilePath, attributes: Mapping[str, str]) -> None:
    version = attributes.get("format_version", "")
    if attributes.get("format") != FORMAT or not version.isdecimal():
        raise InputError(f"{path}: a NetCDF-3 file, but not a result of loaded_tca")
    if int(version) != FORMAT_VERSION:
        age = "a later" if int(version) > FORMAT_VERSION else "an earlier"
        raise InputError(
            f"{path}: written in format {version} by {age} loaded_tca; this one reads format {FORMAT_VERSION}: "
            "run the scene again, its text is the attribute scene_toml of the file"
        )
