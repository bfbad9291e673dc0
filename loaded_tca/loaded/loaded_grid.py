"""Grids under load, and what forces on their active cells do: half-spaces, cut cells, own slices."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby

import numpy as np
import scipy

from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.contact import ContactProblem
from loaded_tca.contact.convolution import Preconditioner
from loaded_tca.contact.grid import Grids
from loaded_tca.loaded.loaded_contact import LoadedContact
from loaded_tca.separation import Separation
from loaded_tca.unloaded import ContactPoint


@dataclass(frozen=True, eq=False)
class LoadedGrid:
    """What the tangent of a state needs of one tooth pair under load.

    Attributes
    ----------
    number : int
        Of the tooth pair.
    contact : ContactPoint
    separation : Separation
    problem : ContactProblem
        Half-spaces, slice compliance and cover on that grid; its gap is of no account.
    pressure : (nx, ny) array [MPa]
        Its solution.
    bending : (ny, ny) array or None [mm/N]
        Compliance of its slices by the teeth, without that of free edges.
    """

    number: int
    contact: ContactPoint
    separation: Separation
    problem: ContactProblem
    pressure: Array
    bending: Array | None = None

    @classmethod
    def of(cls, number: int, loaded: LoadedContact) -> LoadedGrid:
        """Of a solved contact."""
        solution = loaded.solution
        return cls(number, loaded.contact, loaded.separation, solution.problem, solution.pressure, loaded.bending)

    @property
    def slice_force(self) -> Array:
        """Force on every slice (ny,) [N]."""
        return np.asarray(self.pressure.sum(axis=0) * math.prod(self.problem.spacing))

    @cached_property
    def active(self) -> Mask:
        """Cells between the bounds, (nx, ny)."""
        return np.asarray((self.pressure > 0.0) & (self.pressure < self.problem.cap))

    @cached_property
    def pressed(self) -> Mask:
        """Cells under pressure, those at the cap among them, (nx, ny)."""
        return np.asarray(self.pressure > 0.0)


def block_diagonal(matrices: Sequence[Array]) -> scipy.sparse.csr_array:
    """Square matrices of single states as one of all their places."""
    sizes = np.array([len(matrix) for matrix in matrices])
    ends = np.cumsum(sizes)
    columns = [np.tile(np.arange(end - size, end), size) for end, size in zip(ends, sizes, strict=True)]
    rows = np.concatenate([[0], np.cumsum(np.repeat(sizes, sizes))])
    values = np.concatenate([matrix.ravel() for matrix in matrices])
    return scipy.sparse.csr_array((values, np.concatenate(columns), rows), shape=(ends[-1], ends[-1]))


def grouped_by_shape(grids: Sequence[LoadedGrid], ends: Indices) -> list[list[tuple[LoadedGrid, Indices]]]:
    """Grids of one shape, and with slices and cover or without, and the places of their cells in the row."""

    def kind(place: int) -> tuple[object, ...]:
        problem = grids[place].problem
        return problem.cells, problem.slice_compliance is None, problem.cover is None

    cells = np.split(np.arange(ends[-1]), ends[:-1])
    groups = groupby(sorted(range(len(grids)), key=kind), kind)
    return [[(grids[n], cells[n]) for n in group] for _, group in groups]


class Block:
    """K of grids of one shape on their active cells: half-spaces, cut cells, own slices.

    ``cells``: their places in the row; ``dtype``: precision of K.
    """

    def __init__(self, grids: Sequence[LoadedGrid], cells: Indices, dtype: str) -> None:
        problems = [grid.problem for grid in grids]
        stack, active = Grids.of(problems), np.stack([grid.active for grid in grids])
        self.cells, self.grids = cells, grids
        self._at, self._shape = np.flatnonzero(active), active.shape
        unit = np.array([one.spacing[1] * one.contact_modulus for one in problems])  # N to the lengths of a stack
        self._of_grids, self._unit = unit[:, None, None], np.repeat(unit, active.sum(axis=(1, 2)))
        self._operator, self._dtype = stack.operator(dtype=dtype, threads=1), dtype
        self._inverse = Preconditioner(stack.shape, stack.aspects, 1)
        self._root = 1.0 if stack.cover is None else np.sqrt(stack.cover[active])

    @classmethod
    def of(cls, group: Sequence[tuple[LoadedGrid, Indices]], dtype: str) -> Block:
        """That of a group of :func:`grouped_by_shape`."""
        grids, cells = zip(*group, strict=True)
        return cls(grids, np.concatenate(cells), dtype)

    def displaced(self, forces: Array) -> Array:
        """Displacement of the cells [mm] under forces [N] on them."""
        pressure = np.zeros(self._shape, self._dtype)
        pressure.ravel()[self._at] = forces / self._unit
        return np.asarray(self._operator(pressure, np.empty_like(pressure)).ravel()[self._at])

    def displaced_by(self, forces: Sequence[Array]) -> Array:
        """The same under forces [N] on any cells (nx, ny) of each grid."""
        pressure = (np.stack(forces) / self._of_grids).astype(self._dtype, copy=False)
        return np.asarray(self._operator(pressure, np.empty_like(pressure)).ravel()[self._at])

    def preconditioned(self, residual: Array) -> Array:
        """Forces [N] that move the cells by nearly these displacements [mm]."""
        given = np.zeros(self._shape, dtype=np.float32)
        given.ravel()[self._at] = self._root * residual
        pressure = self._inverse(given, np.empty_like(given)).ravel()[self._at]
        return np.asarray(self._unit * self._root * pressure)
