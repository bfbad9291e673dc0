"""Files that hold results: NetCDF-3 with a unit on every variable, each written whole or not at all."""

from __future__ import annotations

import hashlib
import io
import os
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.contact.checks import machine_memory
from loaded_tca.errors import InputError, reason_of, require
from loaded_tca.input_files import opened, require_regular

if TYPE_CHECKING:  # xarray takes a third of a second to import: only what makes or reads a result needs it
    from collections.abc import Iterable, Iterator, Mapping
    from typing import BinaryIO

    import xarray
    from numpy.typing import NDArray

    from loaded_tca.arrays import Array

FORMAT = "loaded_tca"
REVOLUTION, STAGE, TRIBOLOGY, RATING = "revolution", "stage", "tribology", "rating"
STUDY, DESIGN, DOUBLE_HELICAL = "study", "design", "double helical pair"
HALVES_OVER_TURNS = "double helical revolution"
"""Attribute ``kind`` of files that hold something else than the result of a mesh cycle."""
KINDS = {
    REVOLUTION: ("a whole revolution", "read it with loaded_tca.Revolution.load"),
    STAGE: (
        "a planetary stage",
        "sun_mesh.nc and ring_mesh.nc beside it are such results; loaded_tca.stages.StageResult.load reads the stage",
    ),
    DOUBLE_HELICAL: (
        "a double helical pair",
        "half_a.nc and half_b.nc beside it are such results; loaded_tca.double_helical.DoubleHelicalResult.load "
        "reads the pair",
    ),
    HALVES_OVER_TURNS: (
        "a whole revolution of a double helical pair",
        "half_a_revolution.nc and half_b_revolution.nc beside it are revolutions of the halves; "
        "loaded_tca.double_helical.DoubleHelicalRevolution.load reads the pair",
    ),
    TRIBOLOGY: ("tribology", "its numbers are read off a result again by result.tribology()"),
    RATING: ("a rating", "its numbers are read off a result again by result.rating()"),
    STUDY: ("a study", "read it with loaded_tca.studies.load_study"),
    DESIGN: ("a design", "read it with loaded_tca.studies.load_design"),
}
"""What messages call each kind, and how it is read."""
FORMAT_VERSION = 8
"""Raised whenever the code of one version cannot read the files of another."""
DIGITS = 64
DIGEST = b"\0\0\0\x06digest\0\0\0\0\0\x02" + DIGITS.to_bytes(4, "big")
"""Name, type and length of the attribute ``digest`` in NetCDF-3; the digits follow, SHA-256 of all other bytes."""

PORTION = 2**20
"""Bytes of a file that are in memory at a time while its digest is computed."""
UNSTORABLE = KeyError, NotImplementedError, OverflowError, TypeError, ValueError
"""What xarray raises over values that NetCDF-3 has no type for."""

Buffer = bytes | bytearray
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
        variable = dataset.variables.get(name)
        if variable is None:
            problems.append(f"{name}: missing")
        elif variable.dims != dimensions:
            problems.append(f"{name}: found dimensions {variable.dims}, expected {dimensions}")
        elif variable.dtype.kind not in "fib":
            problems.append(f"{name}: no numbers")
        else:
            arrays[name] = variable.values.astype(int) if variable.dtype.kind == "i" else variable.values
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

    Raises
    ------
    InputError
        If the file cannot be written, or NetCDF-3 has no type for a part of the dataset.
    """
    with replacing(path) as temporary:
        with _storable(dataset):
            _netcdf(_marked(dataset), temporary)  # not by way of memory: files of large studies are as large as it
        with open(temporary, "r+b") as file:
            _sign(file)


def netcdf_of(dataset: xarray.Dataset) -> Buffer:
    """Return what ``write_dataset`` writes: the dataset, the marks of this package, and a digest of all bytes.

    Parameters
    ----------
    dataset : xarray.Dataset
        Its integers fit into 32 bits: NetCDF-3 has no larger ones, and no complex numbers.

    Raises
    ------
    InputError
        If NetCDF-3 has no type for a variable or an attribute; each is named.
    """
    with _storable(dataset):
        file = io.BytesIO(_netcdf(_marked(dataset)))
    _sign(file)
    return file.getvalue()


def _netcdf(dataset: xarray.Dataset, path: Path | None = None) -> Any:
    """Bytes of a dataset, or nothing but the file if there is a path."""
    return dataset.to_netcdf(path, engine="scipy", format="NETCDF3_64BIT")


def _marked(dataset: xarray.Dataset) -> xarray.Dataset:
    """The dataset with the marks of this package, and room for the digits of the digest."""
    marks = {"format": FORMAT, "format_version": str(FORMAT_VERSION), "digest": DIGITS * "0"}
    return dataset.assign_attrs(marks)


@contextmanager
def _storable(dataset: xarray.Dataset) -> Iterator[None]:
    """Name what NetCDF-3 has no type for, if the dataset cannot be stored in the block."""
    try:
        yield
    except UNSTORABLE as error:
        raise InputError(list(_unfit_parts(dataset)) or str(error)) from error


def _unfit_parts(dataset: xarray.Dataset) -> Iterator[str]:
    """Problems of the variables and attributes of a dataset that NetCDF-3 cannot hold, each tried by itself."""
    import xarray

    parts = {name: xarray.Dataset({name: variable}) for name, variable in dataset.variables.items()}
    parts |= {f"attribute {name}": xarray.Dataset(attrs={name: value}) for name, value in dataset.attrs.items()}
    for name, part in parts.items():
        try:
            _netcdf(part)
        except UNSTORABLE as error:
            yield f"{name}: cannot be stored in a NetCDF-3 file: {error}"


def _sign(file: BinaryIO) -> None:
    """Write the digits of its digest to their place in a file."""
    place = _place_of_digest(file)
    _, digits = _digests(file, place)
    file.seek(place)
    file.write(digits)


def _place_of_digest(file: BinaryIO) -> int:
    """Where the digits of the digest begin in a file; -1 if it has no such attribute."""
    place, rest = 0, b""
    file.seek(0)
    while portion := file.read(PORTION):
        portion = rest + portion
        if (start := portion.find(DIGEST)) >= 0:
            return place + start + len(DIGEST)
        rest = portion[1 - len(DIGEST) :]  # where an attribute may begin that ends in the next portion
        place += len(portion) - len(rest)
    return -1


def _digests(file: BinaryIO, place: int) -> tuple[bytes, bytes]:
    """The digits at a place of a file, and those that it should have there: of all other bytes."""
    digest = hashlib.sha256()
    file.seek(0)
    digest.update(file.read(place))
    digits = file.read(DIGITS)
    while portion := file.read(PORTION):
        digest.update(portion)
    return digits, digest.hexdigest().encode()


def read_dataset(path: FilePath) -> xarray.Dataset:
    """Read a file that ``write_dataset`` wrote into memory, its marks left out.

    Raises
    ------
    InputError
        If the file cannot be read, is no regular one or larger than the memory, has changed since it was written, is no
        NetCDF-3 file, not of this package, or of another format.
    """
    if os.path.isdir(path):
        raise InputError(f"{path}: a directory; name the result file in it, as {Path(path, 'result.nc')}")
    with opened(path, machine_memory(), "result that this machine can hold") as file:
        place = _place_of_digest(file)
        if place >= 0 and len({*_digests(file, place)}) > 1:
            raise InputError(f"{path}: damaged: its bytes are not those that loaded_tca wrote; run the scene again")
        file.seek(0)
        start = file.read(3)
        file.seek(0)
        try:
            dataset = _loaded(file)
        except Exception as error:  # on a damaged file the reader stumbles in any way
            kind = "damaged" if start == b"CDF" else "not a NetCDF-3 file"
            raise InputError(f"{path}: {kind}; expected a result file written by loaded_tca") from error
    dataset.attrs.pop("digest", None)
    version = str(dataset.attrs.pop("format_version", ""))
    if dataset.attrs.pop("format", "") != FORMAT or not (version.isdecimal() and len(version) < 9):
        raise InputError(f"{path}: a NetCDF-3 file, but not a result of loaded_tca")
    if int(version) != FORMAT_VERSION:
        age = "a later" if int(version) > FORMAT_VERSION else "an earlier"
        raise InputError(
            f"{path}: written in format {version} by {age} loaded_tca; this one reads format {FORMAT_VERSION}: "
            "run the scene again, its text is the attribute scene_toml of the file"
        )
    if place < 0:
        raise InputError(f"{path}: damaged: it has no digest of its bytes; run the scene again")
    return dataset


def _loaded(file: BinaryIO) -> xarray.Dataset:
    """A dataset in memory, where nothing of its file stays: each variable is decoded, and then its bytes are let go."""
    import xarray

    with xarray.backends.ScipyDataStore(file) as store:
        dataset = xarray.open_dataset(store, decode_times=False)
        for name in sorted(store.ds.variables, key=lambda name: dataset.variables[name].dtype.kind != "O"):
            variable = dataset.variables[name].load()
            if variable.dtype.kind == "O" and name not in dataset.dims:  # an index stays as it is
                variable.values = _shared(variable.values)
            del store.ds.variables[name]
    return dataset


def _shared(texts: NDArray[Any]) -> NDArray[Any]:
    """The same texts, those that are alike one object in memory."""
    same: dict[str, str] = {}
    shared = [same.setdefault(text, text) for text in texts.ravel()]
    return np.array(shared, dtype=object).reshape(texts.shape)


def read_kind(path: FilePath, kind: str, what: str) -> xarray.Dataset:
    """Read a file of one kind as ``read_dataset``.

    Parameters
    ----------
    path : str or path
    kind : str
        Attribute ``kind``; nothing: of a mesh cycle.
    what : str
        What messages call it.

    Raises
    ------
    InputError
        As there, and if it is of another kind, with how to read it.
    """
    file = read_dataset(path)
    of_file = str(file.attrs.get("kind", ""))
    if of_file != kind:
        found, reader = KINDS.get(of_file, ("", "read it with loaded_tca.load_result"))
        raise InputError(f"{path}: {found + ', ' if found else ''}not {what}; {reader}")
    return file


@contextmanager
def replacing(path: FilePath) -> Iterator[Path]:
    """Give a temporary name beside ``path``, and put that file in its place if all went well.

    Whatever happens, an interrupt included, ``path`` is either the old file or the whole new one.

    Raises
    ------
    InputError
        If the file cannot be written, or ``path`` is no regular file, as a directory or a device.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as directory:
    ...     with replacing(Path(directory, "a.txt")) as temporary:
    ...         _ = temporary.write_text("all of it")
    ...     Path(directory, "a.txt").read_text()
    'all of it'
    """
    require_replaceable(path)
    target = Path(path)
    temporary = target.with_name(f".{target.name}.{os.getpid()}.part")
    try:
        yield temporary
        temporary.replace(target)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {reason_of(error)}") from error
    finally:
        temporary.unlink(missing_ok=True)


def require_replaceable(path: FilePath, inputs: Iterable[FilePath] = ()) -> None:
    """Refuse to replace a directory, a device or anything else that is no regular file, and files that are read."""
    if not os.path.exists(path):
        return
    require_regular(path, "written")
    require((not os.path.isdir(path), f"{path}: cannot be written: a directory; give the name of a file"))
    read = [one for one in inputs if os.path.exists(one) and os.path.samefile(path, one)]
    require((not read, f"{path}: would replace the input; give another name"))


def replace_file(path: FilePath, content: Buffer) -> None:
    """Write a file, whole or not at all; InputError if it cannot be written."""
    with replacing(path) as temporary:
        temporary.write_bytes(content)


def replace_together(directory: FilePath, contents: Mapping[str, Buffer], old: Iterable[str] = ()) -> tuple[Path, ...]:
    """Write files into a directory: none takes its place before all are written.

    Parameters
    ----------
    directory : str or path
        Made if it does not exist.
    contents : mapping of str to bytes
        By the name of the file.
    old : iterable of str
        Names of files that do not belong to the new ones: removed before these take their places, if they are there.

    Returns
    -------
    tuple of Path
        The files, in the order given.

    Raises
    ------
    InputError
        If the directory cannot be made, or a file cannot be written or removed.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as directory:
    ...     [path.name for path in replace_together(directory, {"a.txt": b"a", "b.txt": b"b"})]
    ['a.txt', 'b.txt']
    """
    make_directory(Path(directory))
    paths = tuple(Path(directory, name) for name in contents)
    with ExitStack() as unfinished:
        for path, content in zip(paths, contents.values(), strict=True):
            unfinished.enter_context(replacing(path)).write_bytes(content)
        for name in old:
            remove(Path(directory, name))
    return paths


def make_directory(directory: Path) -> None:
    """Make a directory and those above it; InputError if that cannot be done."""
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{directory}: cannot be made a directory: {reason_of(error)}") from error


def remove(path: FilePath) -> None:
    """Remove a file if it is there; InputError if that cannot be done."""
    try:
        Path(path).unlink(missing_ok=True)
    except OSError as error:
        raise InputError(f"{path}: cannot be removed: {reason_of(error)}") from error
