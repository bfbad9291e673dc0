"""Surfaces in files for viewers: legacy VTK (ParaView, VisIt) and STL, each written whole or not at all.

Lengths are in mm; both formats have no place for a unit, so the header of each file says so.

References
----------
Schroeder, Martin & Lorensen, The VTK User's Guide, "VTK File Formats", legacy format 3.0; 3D Systems 1989,
StereoLithography Interface Specification.
"""

from __future__ import annotations

import math
import struct
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.errors import InputError, require
from loaded_tca.plain import plain
from loaded_tca.results.files import Buffer, FilePath, replace_file, replace_together

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from loaded_tca.arrays import Array
    from loaded_tca.pairs import MatingTeeth
    from loaded_tca.results.teeth import TeethInSpace
    from loaded_tca.tooth import TriangleMesh

TEETH_FILES = "pinion.vtk", "wheel.vtk", "pressure.vtk", "pinion.stl", "wheel.stl"
"""Of :func:`write_teeth`: teeth in contact and the pressure between them in space, solids of both gears."""
LONGEST_TITLE = 255
"""Bytes of the second line of a VTK file."""
STL_HEADER = 80
"""Bytes before the number of triangles in an STL file."""
FARTHEST = 1e4
"""Sizes of a surface from the origin up to which single precision resolves a thousandth of its size."""
_STL_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


@checked
def write_vtk(path: FilePath, mesh: TriangleMesh, title: str = "", *, binary: bool = True) -> None:
    """Write a surface with its point and cell data as legacy VTK PolyData.

    Parameters
    ----------
    path : str or path
        Replaced if it exists.
    mesh : TriangleMesh
        Data of integers are written as int, of floats as double.
    title : str
        Said in the header, beside the number of triangles and the unit.
    binary : bool
        False: as text, with every digit.

    Raises
    ------
    InputError
        If the file cannot be written, or the name of an array has a blank in it.
    """
    replace_file(path, b"".join(_vtk_parts(mesh, title, binary=binary)))


def _vtk_parts(mesh: TriangleMesh, title: str, *, binary: bool = True) -> Iterator[bytes]:
    names = [name for data in (mesh.point_data, mesh.cell_data) for name in data]
    problems = [f"data {name!r}: a name in a VTK file is one word" for name in names if len(name.split()) != 1]
    if problems:
        raise InputError(problems)
    count = len(mesh.triangles)
    yield f"# vtk DataFile Version 3.0\n{_header(mesh, title, LONGEST_TITLE)}\n".encode("ascii")
    yield (b"BINARY" if binary else b"ASCII") + f"\nDATASET POLYDATA\nPOINTS {mesh.size} double\n".encode("ascii")
    yield _numbers(np.asarray(mesh.vertices, dtype=float), binary=binary)
    yield f"POLYGONS {count} {4 * count}\n".encode("ascii")
    yield _numbers(np.insert(mesh.triangles, 0, 3, axis=1), binary=binary)
    yield from _vtk_data("POINT_DATA", mesh.size, mesh.point_data, binary=binary)
    yield from _vtk_data("CELL_DATA", count, mesh.cell_data, binary=binary)


def _vtk_data(kind: str, count: int, data: Mapping[str, Array], *, binary: bool) -> Iterator[bytes]:
    if data:
        yield f"{kind} {count}\n".encode("ascii")
    for name, values in data.items():
        word = "double" if values.dtype.kind == "f" else "int"
        yield f"SCALARS {name} {word} 1\nLOOKUP_TABLE default\n".encode("ascii")
        yield _numbers(values, binary=binary)


def _numbers(values: Array, *, binary: bool) -> bytes:
    """Numbers as VTK reads them: big-endian, or as text of full precision, one row per line."""
    real = values.dtype.kind == "f"
    if binary:
        return values.astype(">f8" if real else ">i4").tobytes() + b"\n"
    rows = values.reshape(len(values), -1).tolist()
    return "".join(" ".join(repr(number) for number in row) + "\n" for row in rows).encode("ascii")


@checked
def write_stl(path: FilePath, mesh: TriangleMesh, title: str = "") -> None:
    """Write a surface as binary STL: triangles in single precision, without data.

    Parameters
    ----------
    path : str or path
        Replaced if it exists.
    mesh : TriangleMesh
    title : str
        Said in the header, beside the number of triangles and the unit.

    Raises
    ------
    InputError
        If the file cannot be written, or the surface lies so far from the origin that single precision has no room for
        its triangles.
    """
    replace_file(path, _stl(mesh, title))


def _stl(mesh: TriangleMesh, title: str) -> bytes:
    if mesh.size:
        away, size = float(np.abs(mesh.vertices).max()), float(np.ptp(mesh.vertices, axis=0).max())
        far = (
            f"the surface of {plain(size)} mm lies {plain(away)} mm from the origin; allowed up to {plain(FARTHEST)} "
            "sizes: "
        )
        require(
            (away <= FARTHEST * size, f"vertices: {far}coordinates of STL files have seven digits; move the surface")
        )
    records = np.zeros(len(mesh.triangles), dtype=_STL_RECORD)
    normals = mesh.normals
    records["normal"] = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.finfo(float).tiny)
    records["corners"] = mesh.corners
    header = _header(mesh, title, STL_HEADER).encode("ascii").ljust(STL_HEADER)
    return header + struct.pack("<I", len(records)) + records.tobytes()


def _header(mesh: TriangleMesh, title: str, longest: int) -> str:
    """One line of ASCII; the unit stands before the title, which may be cut off."""
    about = f"loaded_tca surface in mm, {len(mesh.triangles)} triangles"
    text = " ".join(f"{about}: {title}".split()) if title.split() else about
    return text.encode("ascii", "replace").decode("ascii")[:longest]


@checked
def write_teeth(
    shown: TeethInSpace,
    teeth: MatingTeeth,
    directory: FilePath,
    *,
    title: str = "",
    whole_gears: bool = False,
    more: Mapping[str, Buffer] = {},
) -> tuple[Path, ...]:
    """Write the teeth in contact and the solids of both gears into a directory, all files or none.

    Parameters
    ----------
    shown : TeethInSpace
    teeth : MatingTeeth
    directory : str or path
    title : str
        Said in the header of each file.
    whole_gears : bool
        Whether the solids have all teeth, on their rim, instead of one; of a rack those of its length.
    more : mapping of str to bytes
        Contents of files to write with these, by their names: a picture of the same teeth.

    Returns
    -------
    tuple of Path
        ``pinion.vtk``, ``wheel.vtk``, ``pressure.vtk`` (fixed frame, teeth in contact; ``patch`` on each triangle of a
        tooth, ``pressure_MPa`` on each of the pressure), and ``pinion.stl``, ``wheel.stl`` (each in its gear's own
        frame, closed), and those of ``more``. The own frame of a rack begins on its reference line. Halves of a double
        helical pair have their true hands in all files, and stand where they lie on the whole gears: z = 0 is the
        middle of the groove, in the fixed frame that of the pinion.

    Raises
    ------
    InputError
        If a file cannot be written, or a whole rack is asked for whose length is not given.
    """
    faces = (None, None) if shown.mid_faces is None else shown.mid_faces.tolist()
    solids = [
        _on_whole_gear(tooth.solid(whole_gear=whole_gears), face)
        for tooth, face in zip((teeth.pinion, teeth.wheel), faces, strict=True)
    ]
    surfaces = [_on_whole_gear(mesh, faces[0]) for mesh in (shown.pinion, shown.wheel, shown.pressure)]
    files: list[Buffer] = [b"".join(_vtk_parts(mesh, title)) for mesh in surfaces]
    files += [_stl(solid, title) for solid in solids]
    return replace_together(directory, {**dict(zip(TEETH_FILES, files, strict=True)), **more})


def _on_whole_gear(mesh: TriangleMesh, mid_face: float | None) -> TriangleMesh:
    """A surface of a half in the frame of the double helical gear: half b is mirrored back; others as they are."""
    if mid_face is None:
        return mesh
    return mesh.moved(np.array([0.0, 0.0, mid_face]), np.diag([1.0, 1.0, math.copysign(1.0, mid_face)]))
