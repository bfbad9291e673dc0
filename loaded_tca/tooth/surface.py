"""The surface of a complete tooth, its patches and its triangles.

In every section the outline runs from the middle of one space over the tooth to the middle of the next, in the sense
of +theta. All patches are pieces of this outline: neighbours share the very points of their common edge.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from loaded_tca.arrays import Array, Indices
from loaded_tca.errors import InputError
from loaded_tca.tooth.triangles import TriangleMesh, grid_triangles

PATCHES = ("root land -", "fillet -", "flank -", "tip land", "flank +", "fillet +", "root land +")
"""Patches along the outline; "+" is the side s = +1, whose outward normal has a positive azimuthal part."""
CLOSING = {"lower side": -1, "upper side": -2, "foot": -3, "cut": -4}
"""Numbers of the patches that close a tooth: ends of the face, inside of the rim, cuts towards its neighbours."""


@dataclass(frozen=True, eq=False)
class ToothSurface:
    """One tooth in the frame of its gear.

    Attributes
    ----------
    outline : (n, m, 3) array [mm]
        Along the outline, from space to space, and across the face.
    foot : (2, m, 3) array [mm]
        Below both ends of the outline, where a closed tooth ends inside the rim.
    joints : (8,) tuple of int
        Where along the outline the patches of ``PATCHES`` begin and end.
    teeth : int
        Number of teeth of the gear.
    half_thickness_angle : float [rad]
        From the middle of the tooth to the point of either flank where Theta = 0.
    """

    outline: Array
    foot: Array
    joints: tuple[int, ...]
    teeth: int
    half_thickness_angle: float

    def patch(self, name: str) -> Array:
        """Points (k, m, 3) of one of ``PATCHES`` [mm]; InputError if there is none of this name."""
        if name not in PATCHES:
            raise InputError(f"name: {name!r} is not one of {', '.join(map(repr, PATCHES))}")
        number = PATCHES.index(name)
        return self.outline[self.joints[number] : self.joints[number + 1] + 1]

    def turned(self, angle: float) -> ToothSurface:
        """Return the tooth turned about the gear's axis by ``angle`` [rad]."""
        turn = _turn(angle)
        return replace(self, outline=self.outline @ turn, foot=self.foot @ turn)

    def triangles(self, copies: int = 1, *, closed: bool = False) -> TriangleMesh:
        """Triangles of one tooth or several.

        Parameters
        ----------
        copies : int
            Teeth, each a pitch further; all of the gear's: a ring.
        closed : bool
            Whether to close both ends of the face, the inside of the rim, and the cuts towards further teeth.

        Returns
        -------
        TriangleMesh
            ``cell_data["patch"]``: the index in ``PATCHES``, or a number of ``CLOSING``.

        Raises
        ------
        InputError
            If the gear has not so many teeth.
        """
        if not 1 <= copies <= self.teeth:
            raise InputError(f"copies: {copies} is not between 1 and {self.teeth}, the number of teeth")
        vertices, outline, foot = self._repeated(copies)
        last, parts = len(self.outline) - 1, []
        for copy in range(copies):
            tooth = outline[copy * last : (copy + 1) * last + 1]
            ends = zip(self.joints, self.joints[1:], strict=False)
            parts += [(grid_triangles(tooth[a : b + 1]), number) for number, (a, b) in enumerate(ends)]
            parts += _closing(tooth, foot[copy : copy + 2]) if closed else []
        if closed and copies < self.teeth:
            cuts = np.stack([foot[0], outline[0]]), np.stack([outline[-1], foot[-1]])
            parts += [(grid_triangles(index), CLOSING["cut"]) for index in cuts]
        used, triangles = np.unique(np.concatenate([found for found, _ in parts]), return_inverse=True)
        patch = np.concatenate([np.full(len(found), number) for found, number in parts])
        return TriangleMesh(vertices[used], triangles.reshape(-1, 3), cell_data={"patch": patch})

    def _repeated(self, copies: int) -> tuple[Array, Indices, Indices]:
        """Vertices of several teeth, and their indices along all outlines and along the feet of all borders."""
        last, ring = len(self.outline) - 1, copies == self.teeth
        turns = [_turn(2.0 * math.pi * copy / self.teeth) for copy in range(copies)]
        outline = [self.outline[:last] @ turn for turn in turns] + ([] if ring else [self.outline[last:] @ turns[-1]])
        foot = [self.foot[:1] @ turn for turn in turns] + ([] if ring else [self.foot[1:] @ turns[-1]])
        points = np.concatenate(outline + foot)
        index = np.arange(points[..., 0].size).reshape(points.shape[:2])
        along, below = np.split(index, [sum(map(len, outline))])
        if ring:
            along, below = (np.concatenate([rows, rows[:1]]) for rows in (along, below))
        return points.reshape(-1, 3), along, below

    def __repr__(self) -> str:
        n, m, _ = self.outline.shape
        return f"ToothSurface({n} x {m} points, one of {self.teeth} teeth)"


def _turn(angle: float) -> Array:
    """Turn about z for points in rows (3, 3)."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def _closing(tooth: Indices, foot: Indices) -> list[tuple[Indices, int]]:
    """Triangles of both ends of the face, in strips from side to side, and of the foot of one tooth."""
    half = (len(tooth) + 1) // 2
    across = np.concatenate([foot[None], np.stack([tooth[:half], tooth[::-1][:half]], axis=1)])
    found = {"lower side": across[:, ::-1, 0], "upper side": across[:, :, -1], "foot": foot[::-1]}
    return [(grid_triangles(index), CLOSING[name]) for name, index in found.items()]
