r"""How the contact of all tooth pairs answers to small changes of their gaps and of the torque.

The forces f [N] of the *active* cells of a state, under pressure and below the cap, and the rotation
Lambda = -driving TE [rad] fulfil

.. math:: K f + h - l_2 \Lambda = 0, \qquad l_1 \cdot f = T,

with K [mm/N] the displacement by the half-spaces, by the bending of the teeth and free edges under a pair's own load,
and by the bending under the loads of the other pairs; h the gaps with both gears held, l1 and l2 [mm] the levers about
the axes of pinion and wheel. As long as no cell becomes active or ceases to be, with

.. math:: u = K^{-1} l_2, \qquad v = K^{-1} l_1, \qquad c = l_1 \cdot u, \qquad w = K^{-1} J_f,

a change dh of the gaps and dT of the torque change the rotation and any number J(f) by

.. math:: d\Lambda = \frac{v \cdot dh + dT}{c}, \qquad
          dJ = \frac{J_f \cdot u}{c} (v \cdot dh + dT) - w \cdot dh, \qquad J_f \cdot u = l_2 \cdot w .

One solution for v serves all changes of the gaps, one more for w all of them again for another number. Nothing is
lost where cells do change sides: their forces start at zero.

References
----------
Bonnans & Shapiro 2000, Perturbation Analysis of Optimization Problems, chapter 5 (minima under inequalities);
Eisenstat, Elman & Schultz 1983, SIAM J. Numer. Anal. 20, 345-357 (generalised conjugate residuals).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from copy import copy
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, groupby

import numpy as np
import scipy

from loaded_tca.arrays import Array, Indices
from loaded_tca.compliance.model import BendingModel
from loaded_tca.errors import ConvergenceError
from loaded_tca.loaded.loaded_grid import Block, LoadedGrid, block_diagonal, grouped_by_shape

TOLERANCE = 1e-10
"""Of the linear systems, relative: the derivatives are exact to 1e-8."""
RATE_TOLERANCE = 1e-4
"""The same where c alone is wanted, whose error falls with its square: 1e-6 at the most."""
SINGLE_PRECISION = 1e-6
"""Tolerance above which K is in single precision, whose rounding leaves 1e-7 of it."""
MOST_ITERATIONS = 500
MOST_STEPS = 100
"""The same where force lines follow the forces: all steps are kept. A dozen or two are the rule."""
CELLS_TOGETHER = 2**15
"""Of the states whose answers :func:`loaded_states` finds together, about: more take more memory and save no time."""


class Tangents:
    """Linear answers of many states, each the tooth pairs of a position under a torque, found together.

    Vectors have the active cells of all grids, state by state, in one row (n,).

    Parameters
    ----------
    states : sequence of sequences of LoadedGrid
        Of each state the pairs that carry load; each grid has an active cell.
    bending : BendingModel, optional
        That the pairs of a state displace each other by; default: they do not.
    tolerance : float
        Of the linear systems, relative.
    by_rotation : (n,) array, optional [N/rad]
        u where no force line moves, if it is known.

    Attributes
    ----------
    bending : BendingModel or None
    grids : tuple of LoadedGrid
        Of all states.
    state : (grids,) int array
        That each belongs to.
    ends : (grids,) int array
        Cell after the last one of each grid.
    grid : (n,) int array
        That each cell belongs to.
    pinion_levers, wheel_levers : (n,) array [mm]
    by_rotation : (n,) array [N/rad]
        u, the force lines held.
    stiffness : (states,) array [N mm/rad]
        c, the tangent dT/d rotation.
    by_shift : (slices, slices) sparse array or None
        How shifts of the force lines displace the slices of all grids (:func:`loaded_tca.loaded.force_lines.
        bending_by_shift`), if these lines follow the forces; None: they are held.

    Raises
    ------
    ConvergenceError
        If a linear system is not solved to its tolerance.
    """

    def __init__(
        self,
        states: Sequence[Sequence[LoadedGrid]],
        bending: BendingModel | None = None,
        tolerance: float = TOLERANCE,
        by_rotation: Array | None = None,
    ) -> None:
        self._tolerance, self.bending = tolerance, bending
        self.grids = tuple(grid for state in states for grid in state)
        self.state = np.repeat(np.arange(len(states)), [len(state) for state in states])
        sizes = [np.count_nonzero(grid.active) for grid in self.grids]
        self.ends, self.grid = np.cumsum(sizes), np.repeat(np.arange(len(self.grids)), sizes)
        slices = [grid.active.shape[1] for grid in self.grids]
        columns = np.concatenate([grid.active.nonzero()[1] for grid in self.grids])
        self._slice, self._slices = columns + (np.cumsum(slices) - slices)[self.grid], sum(slices)
        dtype = "float32" if tolerance > SINGLE_PRECISION else "float64"
        self._blocks = [Block.of(group, dtype) for group in grouped_by_shape(self.grids, self.ends)]
        self._coupling = None if bending is None else _coupling(states, bending)
        levers = [(grid.contact.pinion_lever, grid.contact.wheel_lever) for grid in self.grids]
        self.pinion_levers, self.wheel_levers = np.array(levers).reshape(-1, 2).T[:, self.grid]
        self.by_shift: scipy.sparse.csr_array | None = None
        self._arms = np.zeros(0)
        self.by_rotation, left = self._solved(self.wheel_levers, by_rotation)
        # what is left of l2 adds v . left, v being nearly l1/l2 u; of second order is what that misses
        self.stiffness = self.summed(self.pinion_levers * self.by_rotation * (1.0 + left / self.wheel_levers))

    def with_lines(self, by_shift: scipy.sparse.csr_array) -> Tangents:
        """The same, the force lines following the forces: ``by_shift`` as of the class."""
        tangents = copy(self)
        tangents.__dict__.pop("weights", None)
        tangents.by_shift, columns = by_shift, np.concatenate([grid.active.nonzero()[1] for grid in self.grids])
        tangents._arms = tangents._lengths_over_forces(columns)
        tangents.stiffness = tangents.summed(self.wheel_levers * tangents.weights)
        return tangents

    @cached_property
    def weights(self) -> Array:
        """Of the cells (n,) [N/rad]: v; v/c is the rotation by a unit of material removed there."""
        # on parallel axes both levers have one ratio, but for the slopes of modifications: nothing is left to solve
        start = self.pinion_levers / self.wheel_levers * self.by_rotation
        return self.solved(self.pinion_levers, start, transposed=True)

    def gathered(self, values: Iterable[Array]) -> Array:
        """Values (..., nx, ny) of each grid at the active cells, in one row (..., n)."""
        return np.concatenate([one[..., grid.active] for one, grid in zip(values, self.grids, strict=True)], axis=-1)

    def summed(self, values: Array) -> Array:
        """Sums (..., states) over the cells (..., n) of each state."""
        return np.add.reduceat(values, self._first, axis=-1)

    @cached_property
    def _sizes(self) -> Indices:
        """Cells of each state."""
        return np.bincount(self.state[self.grid])

    @cached_property
    def _first(self) -> Indices:
        """First cell of each state."""
        return np.cumsum(self._sizes) - self._sizes

    def by_state(self, values: Array) -> list[Array]:
        """Values (n,) of each state."""
        return np.split(values, self._first[1:])

    def spread(self, values: Array) -> Array:
        """Numbers (..., states) at the cells (..., n) of each state."""
        return np.repeat(values, self._sizes, axis=-1)

    def rotation_change(self, gaps: Array, torques: Array | float = 0.0) -> Array:
        """DLambda (..., states) [rad] by changes (..., n) of the gaps [mm] and (..., states) of the torques [N mm]."""
        return np.asarray((self.summed(gaps * self.weights) + torques) / self.stiffness)

    def force_change(self, gaps: Array, torques: Array | float = 0.0) -> Array:
        """Changes of the forces (n,) [N] by changes (n,) of the gaps [mm] and (states,) of the torques [N mm]."""
        turned = self.spread(self.rotation_change(gaps, torques))
        return self.solved(self.wheel_levers * turned - gaps)

    def functional_change(self, slopes: Array, gaps: Array, torques: Array | float = 0.0) -> Array:
        """Changes (..., states) of a number J(f) of each state.

        Parameters
        ----------
        slopes : (n,) array
            dJ/df at the active cells, per N.
        gaps : (..., n) array [mm]
            Changes of the gaps.
        torques : (..., states) array [N mm]
            Changes of the torques beside them.
        """
        weights, by_torque = self.functional_weights(slopes)
        return np.asarray(self.summed(gaps * weights) + by_torque * torques)

    def functional_weights(self, slopes: Array) -> tuple[Array, Array]:
        """Derivatives of a number J(f) of each state by the gaps (n,) [per mm] and by the torques (states,) [per N mm].

        ``slopes`` (n,): dJ/df at the active cells, per N.
        """
        adjoint = self.solved(slopes, transposed=True)
        by_torque = self.summed(self.wheel_levers * adjoint) / self.stiffness
        return self.spread(by_torque) * self.weights - adjoint, by_torque

    def displaced(self, forces: Array) -> Array:
        """K f (n,) [mm] of forces (n,) [N]."""
        moved = np.empty(forces.size)
        for block in self._blocks:
            moved[block.cells] = block.displaced(forces[block.cells])
        if self._coupling is not None:
            moved += (self._coupling @ np.bincount(self._slice, forces, self._slices))[self._slice]
        return moved

    def displaced_by(self, forces: Sequence[Array]) -> Array:
        """Displacement of the active cells (n,) [mm] under forces [N] on any cells (nx, ny) of each grid."""
        moved, of_grid = np.empty(self.grid.size), dict(zip(self.grids, forces, strict=True))
        for block in self._blocks:
            moved[block.cells] = block.displaced_by([of_grid[grid] for grid in block.grids])
        if self._coupling is not None:
            moved += (self._coupling @ np.concatenate([one.sum(axis=0) for one in forces]))[self._slice]
        if self.by_shift is not None:
            shifts = [
                ((grid.separation.x[:, None] - grid.separation.force_line) * one).sum(axis=0)
                / np.where(grid.slice_force > 0.0, grid.slice_force, np.inf)
                for grid, one in of_grid.items()
            ]
            moved += (self.by_shift @ np.concatenate(shifts))[self._slice]
        return moved

    def solved(self, displacement: Array, start: Array | None = None, *, transposed: bool = False) -> Array:
        """Forces (n,) [N] that displace the active cells by as much [mm].

        Parameters
        ----------
        displacement : (n,) array [mm]
        start : (n,) array, optional [N]
            Forces to start from; default: none.
        transposed : bool
            Whether the transposed system is meant; they are the same where force lines are held.
        """
        return self._solved(displacement, start, transposed=transposed)[0]

    def _solved(self, displacement: Array, start: Array | None, *, transposed: bool = False) -> tuple[Array, Array]:
        """The same, and what is left of the displacements."""
        goal = self._tolerance**2 * self.summed(displacement**2)
        forces = np.zeros(displacement.size) if start is None else start
        left = displacement - self.displaced(forces) if start is not None else displacement.copy()
        if self.by_shift is None:
            further, left = self._symmetric(left, goal)
            return forces + further, left
        if start is not None:
            left -= self._by_lines(forces, transposed=transposed)
        further, left = self._unsymmetric(left, goal, transposed=transposed)
        return forces + further, left

    def _symmetric(self, residual: Array, goal: Array) -> tuple[Array, Array]:
        """K^-1 of displacements (n,), and what is left, to its squares ``goal`` (states,), by conjugate gradients."""
        forces, residual = np.zeros(residual.size), residual.copy()
        direction, before = np.zeros(residual.size), np.ones(goal.size)
        for _ in range(MOST_ITERATIONS):
            left = self.summed(residual**2) > goal
            if not left.any():
                return forces, residual
            better = self._preconditioned(residual)
            product = self.summed(residual * better)
            direction = better + self.spread(np.where(left, product / before, 0.0)) * direction
            moved = self.displaced(direction)
            step = np.divide(product, self.summed(direction * moved), out=np.zeros(goal.size), where=left)
            forces = forces + self.spread(step) * direction
            residual -= self.spread(step) * moved
            before = np.where(left, product, 1.0)
        raise self._unsolved(residual.size, MOST_ITERATIONS, forces)

    def _unsymmetric(self, residual: Array, goal: Array, *, transposed: bool) -> tuple[Array, Array]:
        """The same where force lines follow the forces, or of the transpose, by generalised conjugate residuals.

        What the lines do is small beside K: as many steps are needed as without, but each knows all earlier ones.
        """
        forces, residual = np.zeros(residual.size), residual.copy()
        earlier: list[tuple[Array, Array, Array]] = []  # steps, what they displace, and its squares
        while len(earlier) < MOST_STEPS:
            left = self.summed(residual**2) > goal
            if not left.any():
                return forces, residual
            step = self._preconditioned(residual)
            moved = self.displaced(step) + self._by_lines(step, transposed=transposed)
            for before, displaced, square in earlier:
                part = self.spread(self.summed(displaced * moved) / square)
                step -= part * before
                moved -= part * displaced
            square = self.summed(moved**2)
            earlier.append((step, moved, np.where(square > 0.0, square, 1.0)))
            length = self.spread(np.where(left, self.summed(moved * residual) / earlier[-1][2], 0.0))
            forces += length * step
            residual -= length * moved
        raise self._unsolved(residual.size, MOST_STEPS, forces)

    def _unsolved(self, cells: int, iterations: int, forces: Array) -> ConvergenceError:
        return ConvergenceError(
            f"tangents: a linear system of {cells} cells is not solved to {self._tolerance:.0e} in {iterations} "
            "iterations",
            last=forces,
        )

    def _lengths_over_forces(self, columns: Indices) -> Array:
        """Shift of the force line of its slice by the force of each cell (n,) [mm/N]."""
        offset = self.gathered(grid.separation.x[:, None] - grid.separation.force_line for grid in self.grids)
        force = [grid.slice_force[own] for grid, own in zip(self.grids, np.split(columns, self.ends[:-1]), strict=True)]
        return np.asarray(offset / np.concatenate(force))

    def _by_lines(self, forces: Array, *, transposed: bool) -> Array:
        """Displacement (n,) [mm] by the motion of the force lines under forces (n,), or its transpose."""
        assert self.by_shift is not None
        if transposed:
            moments = self.by_shift.T @ np.bincount(self._slice, forces, self._slices)
            return np.asarray(self._arms * moments[self._slice])
        shifts = np.bincount(self._slice, self._arms * forces, self._slices)
        return np.asarray((self.by_shift @ shifts)[self._slice])

    def _preconditioned(self, residual: Array) -> Array:
        """Approximate inverse of the half-spaces; of cut cells, which are more compliant, by the root of their part."""
        forces = np.empty(residual.size)
        largest = math.ldexp(1.0, math.frexp(float(np.abs(residual).max()))[1])  # which rounds nothing
        for block in self._blocks:
            forces[block.cells] = block.preconditioned(residual[block.cells] / largest)
        return largest * forces


@dataclass(frozen=True, eq=False)
class LoadedStates:
    """Tooth pairs under load of many states, and how their forces answer to the rotation.

    Attributes
    ----------
    grids : tuple of tuples of LoadedGrid
        Of each state those with a cell between the bounds: the others give way without more force.
    bending : BendingModel or None
        That the pairs of a state displace each other by.
    by_rotation : tuple of arrays [N/rad]
        u at the active cells of each state.
    stiffness : (states,) array [N mm/rad]
        c, the tangent dT/d rotation; zero where no grid has a cell between the bounds.
    """

    grids: tuple[tuple[LoadedGrid, ...], ...]
    bending: BendingModel | None
    by_rotation: tuple[Array, ...]
    stiffness: Array

    def tangents(self, tolerance: float) -> Tangents:
        """Linear answers of all states that have any, their systems to be solved to a tolerance."""
        states = [state for state in self.grids if state]
        return Tangents(states, self.bending, tolerance, np.concatenate(self.by_rotation))


def loaded_states(
    states: Sequence[Sequence[LoadedGrid]], bending: BendingModel | None = None, tolerance: float = RATE_TOLERANCE
) -> LoadedStates:
    """Answers of the forces of many states to the rotation, some states at a time.

    Parameters
    ----------
    states, bending, tolerance
        As of :class:`Tangents`; grids may be without active cells.
    """
    grids = tuple(tuple(grid for grid in state if grid.active.any()) for state in states)
    stiffness, by_rotation = np.zeros(len(grids)), [np.zeros(0)] * len(grids)
    sizes = np.cumsum([sum(grid.active.size for grid in state) for state in grids])
    for _, group in groupby(np.flatnonzero([len(state) > 0 for state in grids]), lambda n: sizes[n] // CELLS_TOGETHER):
        some = list(group)
        tangents = Tangents([grids[n] for n in some], bending, tolerance)
        stiffness[some] = tangents.stiffness
        for n, own in zip(some, tangents.by_state(tangents.by_rotation), strict=True):
            by_rotation[n] = own
    return LoadedStates(grids, bending, tuple(by_rotation), stiffness)


def _coupling(states: Sequence[Sequence[LoadedGrid]], bending: BendingModel) -> scipy.sparse.csr_array:
    """Deflection of all slices, in one row, per force on each slice of another pair of the same state [mm/N]."""
    matrices = []
    for state in states:
        ends = np.cumsum([grid.active.shape[1] for grid in state])
        matrix = np.zeros((ends[-1], ends[-1]))
        for (one, i), (two, j) in combinations(zip(state, ends.tolist(), strict=True), 2):
            between = bending.between((one.number, one.separation), (two.number, two.separation))
            at, under = slice(i - between.shape[0], i), slice(j - between.shape[1], j)
            matrix[at, under], matrix[under, at] = between, between.T
        matrices.append(matrix)
    return block_diagonal(matrices)
