r"""How the contact of all tooth pairs of a position answers to small changes of their gaps and of the torque.

The forces f [N] of the *active* cells, under pressure and below the cap, and the rotation Lambda = -driving TE [rad]
fulfil

.. math:: K f + h - l_2 \Lambda = 0, \qquad l_1 \cdot f = T,

with K [mm/N] the displacement by the half-spaces, by the bending of the teeth and free edges under a pair's own load,
and by the bending under the loads of the other pairs; h the gaps with both gears held, l1 and l2 [mm] the levers about
the axes of pinion and wheel. As long as no cell becomes active or ceases to be, with

.. math:: u = K^{-1} l_2, \qquad v = K^{-1} l_1, \qquad c = l_1 \cdot u, \qquad w = K^{-1} J_f,

a change dh of the gaps and dT of the torque change the rotation and any number J(f) by

.. math:: d\Lambda = \frac{v \cdot dh + dT}{c}, \qquad
          dJ = \frac{J_f \cdot u}{c} (v \cdot dh + dT) - w \cdot dh .

One solution for v serves all changes of the gaps, one more for w all of them again for another number. Nothing is
lost where cells do change sides: their forces start at zero.

References
----------
Bonnans & Shapiro 2000, Perturbation Analysis of Optimization Problems, chapter 5 (minima under inequalities).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.sparse.linalg import LinearOperator, cg

from loaded_tca.arrays import Array, Mask
from loaded_tca.contact import ContactProblem
from loaded_tca.contact.convolution import Preconditioner
from loaded_tca.contact.grid import Grids
from loaded_tca.contact.levels import window_around
from loaded_tca.errors import ConvergenceError, InputError
from loaded_tca.loaded.free_edges import edge_compliances
from loaded_tca.loaded.pair_coupling import BendingModel
from loaded_tca.loaded.tooth_contact import LoadedContact
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.separation import Separation
from loaded_tca.separation.gap_change import GapChange
from loaded_tca.unloaded import ContactPoint

TOLERANCE = 1e-10
"""Of the linear systems, relative: the derivatives are exact to 1e-8."""
MOST_ITERATIONS = 500
PART_OF_A_CELL = 0.5
"""By which a grid is moved either way to see how the compliance of its slices changes."""


@dataclass(frozen=True, eq=False)
class LoadedGrid:
    """What the tangent of a position needs of one tooth pair under load.

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
    """

    number: int
    contact: ContactPoint
    separation: Separation
    problem: ContactProblem
    pressure: Array

    @classmethod
    def of(cls, number: int, loaded: LoadedContact) -> LoadedGrid:
        """Of a solved contact."""
        return cls(number, loaded.contact, loaded.separation, loaded.solution.problem, loaded.solution.pressure)

    @cached_property
    def active(self) -> Mask:
        """Cells between the bounds, (nx, ny)."""
        return np.asarray((self.pressure > 0.0) & (self.pressure < self.problem.cap))


class Tangent:
    """Linear answer of the tooth pairs of one position to changes of their gaps and of the torque.

    Vectors have the active cells of all grids in one row, (n,); :meth:`gathered` makes them of grids.

    Parameters
    ----------
    grids : sequence of LoadedGrid
        Of the pairs that carry load.
    bending : BendingModel, optional
        That the pairs displace each other by; default: they do not.
    tolerance : float
        Of the linear systems, relative.

    Attributes
    ----------
    stiffness : float [N mm/rad]
        c, the tangent dT/d rotation; zero without an active cell.

    Raises
    ------
    ConvergenceError
        If a linear system is not solved to its tolerance.
    """

    def __init__(
        self, grids: Sequence[LoadedGrid], bending: BendingModel | None = None, tolerance: float = TOLERANCE
    ) -> None:
        self._tolerance = tolerance
        self.grids = [grid for grid in grids if grid.active.any()]
        self._blocks = [_Block(grid) for grid in self.grids]
        sizes = [block.size for block in self._blocks]
        self.parts = [slice(end - size, end) for size, end in zip(sizes, np.cumsum(sizes).tolist(), strict=True)]
        self._size = sum(sizes)
        self._coupling = {
            (i, j): bending.between((one.number, one.separation), (two.number, two.separation))
            for i, one in enumerate(self.grids)
            for j, two in enumerate(self.grids[:i])
            if bending is not None
        }
        levers = [(grid.contact.pinion_lever, grid.contact.wheel_lever) for grid in self.grids]
        self.pinion_levers, self.wheel_levers = np.repeat(np.array(levers).reshape(-1, 2).T, sizes, axis=1)
        ratio = self.pinion_levers / self.wheel_levers
        self.by_rotation = self.solved(self.wheel_levers)
        parallel = ratio.size > 0 and bool(np.ptp(ratio) <= TOLERANCE * ratio[0])
        self.weights = ratio[0] * self.by_rotation if parallel else self.solved(self.pinion_levers)
        self.stiffness = float(self.pinion_levers @ self.by_rotation)

    def gathered(self, values: Sequence[Array]) -> Array:
        """Values (..., nx, ny) of each grid at the active cells, in one row (..., n)."""
        return np.concatenate([one[..., grid.active] for one, grid in zip(values, self.grids, strict=True)], axis=-1)

    def rotation_change(self, gaps: Array, torque: Array | float = 0.0) -> Array:
        """DLambda [rad] by changes (..., n) of the gaps [mm] and (...) of the torque [N mm]."""
        return np.asarray((gaps @ self.weights + torque) / self.stiffness)

    @property
    def rotation_by_torque(self) -> float:
        """DLambda/dT [rad/(N mm)]."""
        return 1.0 / self.stiffness

    def force_change(self, gaps: Array) -> Array:
        """Changes (n,) of the forces [N] by a change (n,) of the gaps [mm], under the same torque."""
        return np.asarray(self.by_rotation * self.rotation_change(gaps) - self.solved(gaps))

    @property
    def force_by_torque(self) -> Array:
        """df/dT (n,) [1/mm]: where material that is removed counts, and how much."""
        return np.asarray(self.by_rotation / self.stiffness)

    def functional_change(self, slopes: Array, gaps: Array, torque: Array | float = 0.0) -> tuple[Array, float]:
        """Changes (...) of a number J(f), and its derivative by the torque.

        Parameters
        ----------
        slopes : (n,) array
            dJ/df at the active cells, per N.
        gaps : (..., n) array [mm]
            Changes of the gaps.
        torque : (...) array [N mm]
            Changes of the torque beside them.
        """
        by_torque = float(slopes @ self.force_by_torque)
        return by_torque * (gaps @ self.weights + torque) - gaps @ self.solved(slopes), by_torque

    def displaced(self, forces: Array) -> Array:
        """K f (n,) [mm] of forces (n,) [N]."""
        moved = np.empty(self._size)
        for block, part in zip(self._blocks, self.parts, strict=True):
            moved[part] = block.displaced(forces[part])
        for (i, j), matrix in self._coupling.items():
            one, two, at, under = self._blocks[i], self._blocks[j], self.parts[i], self.parts[j]
            moved[at] += (matrix @ two.slice_forces(forces[under]))[one.columns]
            moved[under] += (matrix.T @ one.slice_forces(forces[at]))[two.columns]
        return moved

    def solved(self, displacement: Array) -> Array:
        """Forces (n,) [N] that displace the active cells by as much [mm]: K^-1."""
        if not displacement.any():
            return np.zeros(self._size)
        shape = self._size, self._size
        found, failed = cg(
            LinearOperator(shape, matvec=self.displaced, dtype=float),
            displacement,
            rtol=self._tolerance,
            maxiter=MOST_ITERATIONS,
            M=LinearOperator(shape, matvec=self._preconditioned, dtype=float),
        )
        if failed:
            raise ConvergenceError(
                f"sensitivities: a linear system of {self._size} cells is not solved to {self._tolerance:.0e} in "
                f"{MOST_ITERATIONS} iterations",
                last=found,
            )
        return np.asarray(found)

    def _preconditioned(self, residual: Array) -> Array:
        found = np.empty(self._size)
        for block, part in zip(self._blocks, self.parts, strict=True):
            found[part] = block.preconditioned(residual[part])
        return found


def followed_changes(
    pair: GearPair, grids: Sequence[LoadedGrid], changes: Sequence[GapChange], bending: BendingModel | None, ends: bool
) -> list[Array]:
    r"""Changes of the gaps on grids that move with their contacts.

    On a grid at rest a contact that moves leaves by cells and enters by others, and the derivative has a ripple of the
    grid. The change is therefore split into one that a shift s of the contact makes up for, found by least squares
    under the weight of the pressure, and a rest; on a grid that follows by s

    .. math:: dh \to dh + s \cdot \left(\nabla h + \frac{\partial C}{\partial x} F\right),
              \qquad dh \approx c_0 - s \cdot \nabla h,

    with C F the deflection of the slices under their forces. The half-spaces are the same everywhere.

    Parameters
    ----------
    pair : GearPair
    grids : sequence of LoadedGrid
        Of the pairs that carry load at one position, each with an active cell.
    changes : sequence of GapChange
        Of each grid, for the same keys.
    bending : BendingModel or None
    ends : bool
        Whether free edges add to the deflection.

    Returns
    -------
    list of (keys, nx, ny) arrays [mm per unit of the key]
    """
    found = [change.by_key.copy() for change in changes]
    forces = [grid.pressure.sum(axis=0) * grid.problem.cell_area for grid in grids]
    for i, (grid, change) in enumerate(zip(grids, changes, strict=True)):
        shifts = _shifts(grid, change)
        found[i] += np.tensordot(shifts, change.by_place, 1)
        for axis, shift in enumerate(shifts.T):
            if not shift.any():
                continue
            step = PART_OF_A_CELL * grid.problem.spacing[axis]
            one, two = (
                replace(grid.separation, origin=grid.separation.origin + sign * step * grid.separation.axes[axis])
                for sign in (-1.0, 1.0)
            )
            moved = [np.zeros(force.shape) for force in forces]
            if ends:
                less, more = (0.0 if edge is None else edge @ forces[i] for edge in _edges(pair, (one, two)))
                moved[i] += (more - less) / (2.0 * step)
            if bending is not None:
                less, more = (bending.within(grid.number, place) for place in (one, two))
                moved[i] += (more - less) @ forces[i] / (2.0 * step)
                for j, other in enumerate(grids):
                    if j != i:
                        under = other.number, other.separation
                        less, more = (bending.between((grid.number, place), under) for place in (one, two))
                        matrix = (more - less) / (2.0 * step)
                        moved[i] += matrix @ forces[j]
                        moved[j] += matrix.T @ forces[i]
            for rest, deflection in zip(found, moved, strict=True):
                rest += shift[:, None, None] * deflection
    return found


def _edges(pair: GearPair, separations: Sequence[Separation]) -> list[Array | None]:
    found = edge_compliances(pair, separations)
    for one in found:
        if isinstance(one, InputError):
            raise one
    return found  # type: ignore[return-value]


def _shifts(grid: LoadedGrid, change: GapChange) -> Array:
    """How far the contact moves across and along (keys, 2) [mm per unit]; not towards an edge that it reaches."""
    active = grid.active
    cover, shifts = grid.separation.cover, np.zeros((len(change.by_key), 2))
    bare = np.pad(cover < 1.0, 1, constant_values=True)
    free = [
        axis
        for axis in (0, 1)
        if not (active & (np.roll(bare, 1, axis) | np.roll(bare, -1, axis) | bare)[1:-1, 1:-1]).any()
    ]
    if not free:
        return shifts
    weight = np.sqrt(grid.pressure[active])
    slopes = change.by_place[free][:, active]
    columns = np.stack([weight, *(weight * slopes)], axis=1)
    scale = np.linalg.norm(columns, axis=0)
    fit = np.linalg.lstsq(columns / scale, (weight * change.by_key[:, active]).T)[0]
    shifts[:, free] = -(fit[1:] / scale[1:, None]).T
    return shifts


class _Block:
    """K of one grid on its active cells, in a window around them: half-spaces, cut cells, own slices."""

    def __init__(self, grid: LoadedGrid) -> None:
        problem, window = grid.problem, window_around(grid.active)
        stack = Grids.of([problem]).part(window)
        self._at, self._shape = grid.active[window], (1, *stack.shape)
        self._unit = problem.spacing[1] * problem.contact_modulus  # N to the lengths of a stack
        self._operator, self._inverse = stack.operator(threads=1), Preconditioner(stack.shape, stack.aspects, 1)
        self._root = np.ones(self._at.sum()) if stack.cover is None else np.sqrt(stack.cover[0][self._at])
        self.columns = grid.active.nonzero()[1]
        self._slices = grid.active.shape[1]
        self.size = self.columns.size

    def displaced(self, forces: Array) -> Array:
        """Displacement of the cells [mm] under forces [N] on them."""
        pressure = np.zeros(self._shape)
        pressure[0, self._at] = forces / self._unit
        return np.asarray(self._operator(pressure, np.empty(self._shape))[0, self._at])

    def slice_forces(self, forces: Array) -> Array:
        """Sums (ny,) of forces over the slices."""
        return np.bincount(self.columns, forces, self._slices)

    def preconditioned(self, residual: Array) -> Array:
        """Approximate inverse of the half-spaces; of cut cells, which are more compliant, by the root of their part."""
        given, largest = np.zeros(self._shape, dtype=np.float32), float(np.abs(residual).max())
        if largest == 0.0:
            return np.zeros(self.size)
        given[0, self._at] = self._root * residual / largest
        found = self._inverse(given, np.empty(self._shape, dtype=np.float32))[0, self._at]
        return np.asarray(largest * self._root * found)
