"""Thin elements beside thick ones: nodes that hang on a face are no unknowns, but follow it.

Along the last axis an element may be twice as thick as its neighbours. Where a thin one shares a face with a thick one,
its nodes on that face take the displacement that the shape functions of the thick one say, and stand where these are:
displacements go on without a gap. Thick elements start at every other layer of thin ones.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from loaded_tca.arrays import Array, Indices

FACES = ((0, 0), (0, 2), (1, 0), (1, 2))
"""Faces of an element that thick and thin ones may share: the coordinate that does not change, and its value."""


def nodes_of(lowest: Indices, spans: Indices, offsets: Indices, columns: int) -> tuple[Indices, Indices]:
    """Whole coordinates (n, k, 3) of the nodes that say where elements go, and on which faces (n, 4) they hang.

    Parameters
    ----------
    lowest : (n, 3) int array
        Lowest node of each element.
    spans : (n,) int array
        1 of a thin one, 2 of a thick one.
    offsets : (k, 3) int array
        Nodes of an element, 0 to 2 from the lowest.
    columns : int
        After which the first coordinate starts anew.

    Returns
    -------
    nodes : (n, k, 3) int array
    hanging : (n, 4) int array
        For each of ``FACES`` 0, or 1 and 2 for a thin element on the first and second half of a thick face.
    """
    nodes = lowest[:, None] + offsets * np.column_stack([np.ones((len(spans), 2), dtype=int), spans])[:, None]
    faces = np.stack([_face(lowest, axis, value, columns) for axis, value in FACES], axis=1)
    thick = spans == 2
    shared = np.isin(faces, faces[thick]) & ~thick[:, None]
    hanging = np.where(shared, 1 + lowest[:, 2:] // 2 % 2, 0)
    for n, (axis, value) in enumerate(FACES):
        on_face = offsets[:, axis] == value
        start = 4 * (lowest[shared[:, n], 2:] // 4)
        nodes[np.ix_(shared[:, n], on_face, [2])] = (start + 2 * offsets[on_face, 2])[..., None]
    nodes[..., 0] %= columns
    return nodes, hanging


def _face(lowest: Indices, axis: int, value: int, columns: int) -> Indices:
    """A number (n,) for the face of a thick element, or the one of which the face of a thin one is a half."""
    middle = lowest[:, :2] + 1
    middle[:, axis] += value - 1
    middle[:, 0] %= columns
    limits = lowest.max(axis=0) + 3
    return np.asarray((middle[:, 0] * limits[1] + middle[:, 1]) * limits[2] + lowest[:, 2] // 4)


def following(hanging: Indices, offsets: Indices, quad: Any) -> Array:
    """Shares (n, k, k) of the nodes that say where an element goes in each of its own nodes.

    Parameters
    ----------
    hanging : (n, 4) int array
        As :func:`nodes_of` tells.
    offsets : (k, 3) int array
    quad : element of scikit-fem
        Shape functions of a face.
    """
    codes, which = np.unique(hanging, axis=0, return_inverse=True)
    found = np.tile(np.eye(len(offsets)), (len(codes), 1, 1))
    order = np.rint(2.0 * np.asarray(quad.doflocs)).astype(int)
    for share, code in zip(found, codes, strict=True):
        for (axis, value), half in zip(FACES, code, strict=True):
            if half:
                face = np.flatnonzero(offsets[:, axis] == value)
                along, across = offsets[face, 1 - axis], offsets[face, 2]
                places = np.stack([0.5 * along, 0.5 * (half - 1) + 0.25 * across])
                shape = np.stack([quad.lbasis(places, i)[0] for i in range(len(order))], axis=-1)
                same = (order[:, None] == np.stack([along, across], axis=-1)).all(axis=-1).argmax(axis=0)
                share[np.ix_(face, face)] = shape[:, same]
    return found[which.ravel()]
