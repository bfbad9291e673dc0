"""Surfaces of triangles with numbers on them, as viewers and printers take them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """Vertices, triangles and data on either.

    Parameters
    ----------
    vertices : (v, 3) array [mm]
    triangles : (t, 3) int array
        Indices of corners, counter-clockwise seen from outside.
    point_data, cell_data : mapping
        Name (unit in it) -> (v,) or (t,) array.

    Raises
    ------
    InputError
        If shapes do not fit, a vertex is not finite, or an index points to none.

    Examples
    --------
    >>> corners = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    >>> TriangleMesh(corners, np.array([[0, 1, 2]])).area
    1.0
    """

    vertices: Array
    triangles: NDArray[np.int_]
    point_data: Mapping[str, Array] = field(default_factory=dict)
    cell_data: Mapping[str, Array] = field(default_factory=dict)

    def __post_init__(self) -> None:
        problems = [
            f"{name}: shape {found.shape} is not (n, 3)"
            for name, found in (("vertices", self.vertices), ("triangles", self.triangles))
            if found.ndim != 2 or found.shape[1] != 3
        ]
        if not problems and not np.isfinite(self.vertices).all():
            problems.append("vertices: not all are finite")
        if not problems and self.triangles.size and not 0 <= self.triangles.min() <= self.triangles.max() < self.size:
            problems.append(f"triangles: indices are not within 0 to {self.size - 1}")
        for kind, data, count in (("point", self.point_data, self.size), ("cell", self.cell_data, len(self.triangles))):
            for name, values in data.items():
                if values.shape != (count,):
                    problems.append(f"{kind} data {name}: shape {values.shape} is not ({count},)")
        if problems:
            raise InputError(problems)

    @property
    def size(self) -> int:
        """Number of vertices."""
        return len(self.vertices)

    @property
    def corners(self) -> Array:
        """Corners of every triangle, (t, 3, 3) [mm]."""
        return self.vertices[self.triangles]

    @property
    def normals(self) -> Array:
        """Normals (t, 3), as long as the triangle's area [mm^2]."""
        corners = self.corners
        return 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])

    @property
    def area(self) -> float:
        """Area [mm^2]."""
        return float(np.linalg.norm(self.normals, axis=1).sum())

    @property
    def volume(self) -> float:
        """Volume inside [mm^3], of a closed surface: the theorem of Gauss."""
        return float((self.corners.mean(axis=1) * self.normals).sum() / 3.0)

    @property
    def is_closed(self) -> bool:
        """Whether every edge belongs to two triangles, which run along it in opposite directions."""
        edges = np.concatenate([self.triangles[:, [k, (k + 1) % 3]] for k in range(3)])
        there, back = (_keys(pairs, self.size) for pairs in (edges, edges[:, ::-1]))
        return len(np.unique(there)) == len(there) and np.array_equal(np.sort(there), np.sort(back))

    def seams(self, name: str) -> Array:
        """Edges (k, 2, 3) at the border of the surface, or between cells that differ in ``cell_data[name]`` [mm]."""
        edges = np.concatenate([self.triangles[:, [k, (k + 1) % 3]] for k in range(3)])
        values = np.tile(self.cell_data[name], 3)
        keys = _keys(np.sort(edges, axis=1), self.size)
        order = np.argsort(keys, kind="stable")
        keys, values, edges = keys[order], values[order], edges[order]
        paired = np.append(keys[1:] == keys[:-1], False)
        second = np.insert(paired[:-1], 0, False)
        differs = paired & (values != np.roll(values, -1))
        return self.vertices[edges[differs | ~(paired | second)]]

    def moved(self, origin: Array, axes: Array) -> TriangleMesh:
        """Return the mesh in the frame in which its own has this ``origin`` (3,) and these ``axes`` (3, 3), in rows."""
        return replace(self, vertices=origin + self.vertices @ axes)

    def __repr__(self) -> str:
        return f"TriangleMesh({self.size} vertices, {len(self.triangles)} triangles)"


def _keys(edges: NDArray[np.int_], size: int) -> NDArray[Any]:
    """One number per directed edge."""
    return edges[:, 0].astype(np.int64) * size + edges[:, 1]


def grid_triangles(index: NDArray[np.int_]) -> NDArray[np.int_]:
    """Triangles of a structured surface: two per cell of indices (n, m), without those that have two equal corners.

    The outside is where the first axis crossed with the second one points to.
    """
    corners = index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]
    halves = [np.stack([corners[a], corners[b], corners[c]], axis=-1) for a, b, c in ((0, 1, 2), (0, 2, 3))]
    found: NDArray[np.int_] = np.stack(halves, axis=-2).reshape(-1, 3)
    same = (found == np.roll(found, 1, axis=1)).any(axis=1)
    return found[~same]
