"""[pinion.support] and [wheel.support]: what holds a gear, as a matrix of its motions under forces and moments."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.scene.keys import Grid, Number, key
from loaded_tca.scene.section import Rule, Section

DIRECTIONS = "along x", "along y", "along z, its axis", "about x", "about y", "about z, its axis"
"""Motions of a gear in the order of the rows of the matrices."""
SOFTEST_mm_per_N, STIFFEST_N_per_mm = 1e3, 1e15
"""Largest entries: a metre per newton; a thousand times the tilting stiffness of the largest bearings [N mm/rad]."""
SYMMETRIC = 1e-6
"""Difference of two entries that are the same, over the roots of their diagonal entries: numbers of six digits."""
FREE = 1e-12
"""Smallest eigenvalue of a matrix with ones on its diagonal that still holds a gear."""


def scaled(matrix: Array) -> tuple[Array, Array]:
    """A symmetric matrix with ones on its diagonal, where that is above zero; the roots of its diagonal."""
    roots = np.sqrt(np.maximum(matrix.diagonal(), 0.0))
    over = np.where(roots > 0.0, roots, 1.0)
    return matrix / np.outer(over, over), over


def fault_of_matrix(rows: tuple[tuple[float, ...], ...], *, definite: bool) -> str | None:
    """What is wrong with a compliance, or with a stiffness, which is to be ``definite``; None: nothing."""
    matrix = np.array(rows)
    if matrix.shape != (6, 6):
        return f"found {matrix.shape[0]} lists of {matrix.shape[1]} values; allowed 6 lists of 6"
    if (diagonal := matrix.diagonal()).min() < 0.0:
        place = int(diagonal.argmin())
        return f"found {diagonal[place]:g} for the motion {DIRECTIONS[place]}; allowed are diagonal entries from 0 on"
    relative, roots = scaled(matrix)
    off = np.abs(relative - relative.T)
    if off.max() > SYMMETRIC:
        row, column = sorted(np.unravel_index(int(off.argmax()), off.shape))
        one, other = matrix[row, column], matrix[column, row]
        return (
            f"not symmetric: found {one:g} in row {row + 1}, column {column + 1}, and {other:g} in the mirrored place"
        )
    values, vectors = np.linalg.eigh(0.5 * (relative + relative.T))
    if values[0] < -SYMMETRIC:
        return (
            f"not positive semidefinite: smallest eigenvalue {values[0]:.3g} with ones on the diagonal; a load would "
            "move the gear against itself"
        )
    if definite and values[0] < FREE:
        free = DIRECTIONS[int(np.abs(vectors[:, 0] / roots).argmax() if roots.all() else roots.argmin())]
        free = DIRECTIONS[int(np.flatnonzero(diagonal == 0.0)[0])] if (diagonal == 0.0).any() else free
        return f"holds the gear not {free}: this motion is free; allowed are matrices that hold all six, or compliance"
    return None


def _one_matrix(compliance: tuple[tuple[float, ...], ...] | None, stiffness: object) -> str | None:
    if (compliance is None) == (stiffness is None):
        fault = "missing" if compliance is None else "found beside stiffness"
        return f"{fault}; give one of compliance and stiffness"
    return None


@dataclass(frozen=True, kw_only=True)
class SupportSection(Section):
    """[pinion.support], [wheel.support]: how far a gear gives way as a whole."""

    compliance: tuple[tuple[float, ...], ...] | None = key(
        Grid(Number(-SOFTEST_mm_per_N, SOFTEST_mm_per_N), 6, 6),
        "motions [mm, rad] of the gear under unit forces [N] and moments [N mm] on it: x, y, z and about x, y, z of "
        "the gear's own frame, which does not turn, at the middle of the face on its axis (bevel gears: of the mean "
        "pitch circle); 6 lists of 6; zeros: rigid",
        None,
        "by `stiffness`",
    )
    stiffness: tuple[tuple[float, ...], ...] | None = key(
        Grid(Number(-STIFFEST_N_per_mm, STIFFEST_N_per_mm), 6, 6),
        "or its inverse, forces [N] and moments [N mm] by unit motions [mm, rad]; all six motions are held",
        None,
        "by `compliance`",
    )

    rules: ClassVar[tuple[Rule, ...]] = (
        Rule(("compliance", "stiffness"), _one_matrix),
        Rule(("compliance",), lambda rows: None if rows is None else fault_of_matrix(rows, definite=False)),
        Rule(("stiffness",), lambda rows: None if rows is None else fault_of_matrix(rows, definite=True)),
    )

    @property
    def matrix(self) -> Array:
        """The compliance (6, 6) [mm, rad, N, N mm], symmetric to the last digit."""
        if self.compliance is not None:
            matrix = np.array(self.compliance)
            return np.asarray(0.5 * (matrix + matrix.T))
        relative, roots = scaled(np.array(self.stiffness))
        inverse = np.linalg.inv(0.5 * (relative + relative.T)) / np.outer(roots, roots)
        return np.asarray(0.5 * (inverse + inverse.T))
