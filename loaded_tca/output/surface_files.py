"""Surfaces in files for viewers: legacy VTK (ParaView, VisIt) and STL, each written whole or not at all.

Lengths are in mm; both formats have no place for a unit, so the header of each file says so.

References
----------
Schroeder, Martin & Lorensen, The VTK User's Guide, "VTK File Formats", legacy format 3.0; 3D Systems 1989,
StereoLithography Interface Specification.

The teeth of a result in contact, with the path of contact and the pressure, for pictures and files.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from loaded_tca.arrays import Array, index_checks
from loaded_tca.errors import GeometryError, InputError, require
from loaded_tca.pairs import MatingTeeth
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.files import Buffer, FilePath, replace_together, replacing
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.tooth import TriangleMesh


@dataclass(frozen=True, eq=False)
class TeethInSpace:
    """One position of a result in space, in the fixed frame.

    Attributes
    ----------
    pair : GearPair
    position, column, torque : int
        Indices in the result, the second one of the tooth pair.
    pinion, wheel : TriangleMesh
        The teeth in contact.
    path : (n, 3) array [mm]
        The unloaded contact points of all positions on the pinion's flank.
    pressure : TriangleMesh
        Cells under pressure on the pinion's flank, ``cell_data["pressure_MPa"]``; none without load.
    point, normal : (3,) array
        The contact point [mm] and the normal out of the pinion.
    """

    pair: GearPair
    position: int
    column: int
    torque: int
    pinion: TriangleMesh
    wheel: TriangleMesh
    path: Array
    pressure: TriangleMesh
    point: Array
    normal: Array

    @property
    def eye(self) -> Array:
        """Unit vector (3,) from which the pinion's flank is seen: along its normal, a little from tip and heel."""
        outward = np.array([self.point[0], self.point[1], 0.0])
        towards: Array = self.normal + 0.6 * outward / np.linalg.norm(outward) + np.array([0.0, 0.0, 0.5])
        return towards / np.linalg.norm(towards)

    @property
    def highest_pressure(self) -> float:
        """Largest pressure of a cell [MPa]; zero without load."""
        return float(self.pressure.cell_data["pressure_MPa"].max(initial=0.0))


def teeth_in_space(
    result: MeshCycle, teeth: MatingTeeth, position: int | None = None, torque: int | None = None
) -> TeethInSpace:
    """Place teeth, path and pressure of one position of a result.

    Parameters
    ----------
    result : MeshCycle
    teeth : MatingTeeth
        Of the scene of the result: ``mating_teeth(scene.pair())``.
    position : int, optional
        Index along the path; default: that of the peak pressure, ``result.peak_contact``.
    torque : int, optional
        Index of the torque; default: the largest one.

    Raises
    ------
    InputError
        If the result has no such torque or position.
    GeometryError
        If nothing is in contact at that position.
    """
    require(*index_checks(torque=(torque, len(result.torque)), position=(position, len(result.path))))
    torque = int(np.argmax(result.torque)) if torque is None else torque
    place = result.peak_contact(torque) if position is None else (position, int(result.peak_column[torque, position]))
    one = None if place is None else result.maps[torque][place[0]][place[1]]
    if place is None or one is None:
        raise GeometryError("no teeth in contact: the tooth pair is not in contact at this position")
    position, column = place
    contact, path = result.paths[column][position], result.path[result.path.in_contact]
    pitches = float(result.pair[column]) * teeth.pair.pitch  # teeth are placed as if they met at the pitch point
    pinion_angle = contact.pinion_angle - pitches
    pinion, wheel = teeth.in_mesh(pinion_angle, contact.wheel_angle - teeth.pair.ratio * pitches)
    return TeethInSpace(
        teeth.pair,
        position,
        column,
        torque,
        pinion,
        wheel,
        teeth.on_pinion(path.pinion_radius, path.pinion_axial, pinion_angle),
        teeth.pressure_on_pinion(one.corners, one.pressure, pinion_angle),
        contact.point,
        contact.normal,
    )


LONGEST_TITLE = 255
"""Bytes of the second line of a VTK file."""
STL_HEADER = 80
"""Bytes before the number of triangles in an STL file."""
_STL_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


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
    content = b"".join(_vtk_parts(mesh, title, binary=binary))
    with replacing(path) as temporary:
        temporary.write_bytes(content)


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
        If the file cannot be written.
    """
    content = _stl(mesh, title)
    with replacing(path) as temporary:
        temporary.write_bytes(content)


def _stl(mesh: TriangleMesh, title: str) -> bytes:
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
        Whether the solids have all teeth, on their rim, instead of one.
    more : mapping of str to bytes
        Contents of files to write with these, by their names: a picture of the same teeth.

    Returns
    -------
    tuple of Path
        ``pinion.vtk``, ``wheel.vtk``, ``pressure.vtk`` (fixed frame, teeth in contact; ``patch`` on each triangle of a
        tooth, ``pressure_MPa`` on each of the pressure), and ``pinion.stl``, ``wheel.stl`` (each in its gear's own
        frame, closed), and those of ``more``.

    Raises
    ------
    InputError
        If a file cannot be written.
    """
    solids = [tooth.triangles(tooth.teeth if whole_gears else 1, closed=True) for tooth in (teeth.pinion, teeth.wheel)]
    surfaces = {"pinion.vtk": shown.pinion, "wheel.vtk": shown.wheel, "pressure.vtk": shown.pressure}
    contents: dict[str, Buffer] = {name: b"".join(_vtk_parts(mesh, title)) for name, mesh in surfaces.items()}
    contents |= {"pinion.stl": _stl(solids[0], title), "wheel.stl": _stl(solids[1], title)}
    return replace_together(directory, {**contents, **more})
