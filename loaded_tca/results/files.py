"""Files that hold results: NetCDF-3 with a unit on every variable, each written whole or not at all."""

from __future__ import annotations

import io
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError, reason_of

if TYPE_CHECKING:  # xarray takes a third of a second to import: only what makes or reads a result needs it
    import xarray

FORMAT = "loaded_tca"
FORMAT_VERSION = 4
"""Raised whenever the code of one version cannot read the files of another."""

FilePath = str | os.PathLike[str]
Part = tuple[tuple[str, ...], str, str]
"""Dimensions, unit and long name of an array."""


def variables_of(
    parts: Mapping[str, Part], arrays: Mapping[str, Any]
) -> dict[str, tuple[tuple[str, ...], Array, dict[str, str]]]:
    """Variables, as xarray takes them, of arrays and what is to be said of them.

    Examples
    --------
    >>> variables_of({"width": ((), "mm", "face width")}, {"width": 25.0})["width"]
    ((), array(25.), {'units': 'mm', 'long_name': 'face width'})
    """
    return {
        name: (dimensions, np.asarray(arrays[name]), {"units": unit, "long_name": text})
        for name, (dimensions, unit, text) in parts.items()
    }


def arrays_of(dataset: xarray.Dataset, parts: Mapping[str, Part]) -> dict[str, Array]:
    """Arrays of a dataset that was read from a file, integers as the platform's.

    Raises
    ------
    InputError
        If one is missing, has other dimensions, or holds no numbers; every problem at once.
    """
    problems, arrays = [], {}
    for name, (dimensions, _, _) in parts.items():
        found = dataset.variables.get(name)
        if found is None:
            problems.append(f"{name}: missing")
        elif found.dims != dimensions:
            problems.append(f"{name}: found dimensions {found.dims}, expected {dimensions}")
        elif found.dtype.kind not in "fib":
            problems.append(f"{name}: no numbers")
        else:
            arrays[name] = found.values.astype(int) if found.dtype.kind == "i" else found.values
    if problems:
        raise InputError(problems)
    return arrays


def write_dataset(path: FilePath, dataset: xarray.Dataset) -> None:
    """Write a dataset to a NetCDF-3 file, whole or not at all.

    Parameters
    ----------
    path : str or path
        Replaced if it exists.
    dataset : xarray.Dataset
        Its integers fit into 32 bits: NetCDF-3 has no larger ones.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    marked = dataset.assign_attrs(format=FORMAT, format_version=str(FORMAT_VERSION))
    with replacing(path) as temporary:
        marked.to_netcdf(temporary, engine="scipy", format="NETCDF3_64BIT")


def read_dataset(path: FilePath) -> xarray.Dataset:
    """Read a file that ``write_dataset`` wrote into memory, its marks left out.

    Raises
    ------
    InputError
        If the file cannot be read, is damaged, no NetCDF-3 file, not of this package, or of another format.
    """
    import xarray

    try:
        content = Path(path).read_bytes()
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read: {reason_of(error)}") from error
    try:
        with xarray.open_dataset(io.BytesIO(content), engine="scipy", decode_times=False) as file:
            dataset = file.load()
    except Exception as error:  # on a damaged file the reader stumbles in any way
        kind = "damaged" if content.startswith(b"CDF") else "not a NetCDF-3 file"
        raise InputError(f"{path}: {kind}; expected a result file written by loaded_tca") from error
    version = str(dataset.attrs.pop("format_version", ""))
    if dataset.attrs.pop("format", "") != FORMAT or not (version.isdecimal() and len(version) < 9):
        raise InputError(f"{path}: a NetCDF-3 file, but not a result of loaded_tca")
    if int(version) != FORMAT_VERSION:
        age = "a later" if int(version) > FORMAT_VERSION else "an earlier"
        raise InputError(
            f"{path}: written in format {version} by {age} loaded_tca; this one reads format {FORMAT_VERSION}: "
            "run the scene again, its text is the attribute scene_toml of the file"
        )
    return dataset


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
        raise InputError(f"{path}: cannot be written: {reason_of(error)}") from error
    finally:
        temporary.unlink(missing_ok=True)


def remove(path: FilePath) -> None:
    """Remove a file if it is there; InputError if that cannot be done."""
    try:
        Path(path).unlink(missing_ok=True)
    except OSError as error:
        raise InputError(f"{path}: cannot be removed: {reason_of(error)}") from error
