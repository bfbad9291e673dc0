r"""The contact of two elastic half-spaces on columns of unlike widths: fine where a flank ends, wide elsewhere.

Cells are of one length dx along x and as wide along y as their columns are. Forces on cells, not pressures, are the
unknowns, so that the problem is that of ``contact.solver`` and the same iteration solves it. Displacements are a
convolution along x, done by transforms, and a sum over all pairs of columns for each wave number.

Displacements at the middles of cells of unlike widths have coefficients D that are not quite symmetric. The iteration
minimises the energy of their symmetric part S under the gap h + (D - S) p of the last pressures, and is repeated until
the contact conditions hold for D itself; each time takes the difference down to about a hundredth. (S alone leaves 1 %
in the pressure where the growth of the columns changes, however fine they are.)

A free edge along the columns adds an image of the forces, as on even grids: coefficients at mirrored places. With a
reference only the differences of what it adds are kept: there a force adds nothing to the displacement beneath it. So
the surface tilts and curves beside the edge, and how far it gives way on the whole is left to the slices. What is left
out would make K indefinite for forces far from the edge: like what is not symmetric it is put in by repeating. An edge
with factors ``across`` has the image of a body in space, in full, whose factor is another for each pair of cells.

The graded axis is y, always: for an edge along y, whose rounding is crossed along x, the caller hands in the transposed
gap, and slices by ``slice_axis`` 0.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache

import numpy as np
import scipy
from numpy.typing import ArrayLike

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, Indices, numbers
from loaded_tca.contact import checks
from loaded_tca.contact.convolution import ALL, Rows, Window, fast_length
from loaded_tca.contact.descent import Descent, judge
from loaded_tca.contact.edges import FreeEdge
from loaded_tca.contact.grid import CELLS, OUT_OF_REACH, Grids, Operator, each, with_cap
from loaded_tca.contact.levels import coarsen, coarsening, merged, prolong
from loaded_tca.contact.love import (
    FAR_FIELD,
    TINY,
    column_coefficients,
    column_coefficients_across,
    far_from,
    own_coefficient,
)
from loaded_tca.contact.problem import GradedProblem
from loaded_tca.contact.solution import (
    COARSE_FACTOR,
    COARSE_TOLERANCE,
    MOST_CHECKS,
    MOST_ITERATIONS,
    RESERVE,
    ContactStatus,
    GradedSolution,
    OnFailure,
)
from loaded_tca.threads import one_blas_thread

SHORT = 64
"""Rows up to which a product with the matrix of the transform takes less time than a fast one."""
OF_PRESSURE = 5e-3
"""What an error of a pressure, over the largest, counts of the residual: at a tolerance of 1e-5 none is above 2e-3."""
MOST_FROM_START = 80
"""Iterations from a given pressure, before coarser columns give another: one from unlike cells may lead nowhere in 500,
as with rows of 1 um. Of 480 contacts one needs more than 61."""
REACH_RESERVE = 1.1
"""Of the largest gap that may close, for the part of the coefficients that is not symmetric."""


@checked
def solve_graded(
    problem: GradedProblem,
    *,
    tolerance: float = 1e-6,
    on_failure: OnFailure = "raise",
    initial_pressure: ArrayLike | None = None,
) -> GradedSolution:
    """Solve a contact problem on columns of unlike widths.

    Parameters
    ----------
    problem : GradedProblem
    tolerance, on_failure
        As in :func:`solve_contact`; and no pressure is farther off, over the largest, than 200 tolerances.
    initial_pressure : (nx, ny) array_like, optional [MPa]
        Where to start from; coarser and coarser columns if absent.

    Returns
    -------
    GradedSolution

    Raises
    ------
    InputError
        Before work starts, with every problem of the arguments.
    ConvergenceError
        If the tolerance is not reached within a bounded number of iterations; ``last`` holds the last iterate.

    Examples
    --------
    A sphere of 10 mm radius on a plane; Hertz: 1420.7 MPa.

    >>> import numpy as np
    >>> x, borders = np.linspace(-0.3, 0.3, 64), np.linspace(-0.67, 0.67, 80)
    >>> borders = borders * np.abs(borders)
    >>> y = 0.5 * (borders[1:] + borders[:-1])
    >>> problem = GradedProblem((x[:, None] ** 2 + y**2) / 20.0, x[1] - x[0], borders, 115e3, load=112.0)
    >>> bool(abs(solve_graded(problem).pressure.max() / 1420.7 - 1.0) < 2e-3)
    True
    """
    start = None if initial_pressure is None else numbers("initial_pressure", initial_pressure)
    checks.raise_if(checks.check_run(tolerance, on_failure, start, problem.cells, 1))
    if problem.load == 0.0:
        return GradedSolution.without_load(problem, problem.first_contact)
    with one_blas_thread():
        return _solved(problem, tolerance, start).checked(tolerance, on_failure, "contact on graded columns")


def guess(problem: GradedProblem) -> Array:
    """Pressure (nx, ny) [MPa] of a sphere of this load whose contact has as large an area as the gap lets close."""
    line, total = problem.widths / problem.contact_modulus, problem.load / (problem.spacing * problem.contact_modulus)
    return _sphere(problem.gap - problem.first_contact, problem.spacing, problem.widths, total) / line


def _solved(problem: GradedProblem, tolerance: float, start: Array | None) -> GradedSolution:
    """Solve from a start or from coarser columns, and check in double precision."""
    grids, line = GradedGrids.of_problem(problem, far_from(tolerance)), problem.widths / problem.contact_modulus
    start = start if start is not None and start.any() else None
    pressure = _start_from_coarser(grids, tolerance) if start is None else grids.fitted((start * line)[None])
    precondition = grids.preconditioner()
    iterations = convolutions = repeats = 0
    while True:
        displacement, rest = grids.displaced(pressure)
        convolutions += 1
        state = judge(grids, pressure, displacement + grids.gap)
        approach, residual = float(state.approach[0, 0, 0]), float(state.residual[0, 0, 0])
        if residual <= tolerance or iterations >= MOST_ITERATIONS or repeats == MOST_CHECKS:
            break
        if start is not None and iterations >= MOST_FROM_START:
            pressure, start = _start_from_coarser(grids, tolerance), None
            continue
        bent = replace(grids, gap=grids.gap + rest)
        descent = Descent(bent, pressure, displacement - rest, 1, preconditioner=precondition)
        most = MOST_ITERATIONS if start is None else MOST_FROM_START
        descent.run(np.array([RESERVE * tolerance]), np.array([most - iterations]))
        pressure = bent.settled(descent.pressure)
        iterations += int(descent.iterations[0])
        convolutions += int(descent.convolutions[0])
        repeats += 1
    in_MPa = pressure[0] / line
    if problem.max_pressure is not None:
        in_MPa = with_cap(in_MPa, problem.max_pressure)
    return GradedSolution(
        pressure=in_MPa,
        gap=displacement[0] + (problem.gap - problem.first_contact) - approach,
        approach=problem.first_contact + approach,
        load=float(in_MPa.sum(axis=0) @ problem.cell_areas),
        iterations=iterations,
        convolutions=convolutions,
        residual=residual,
        status=ContactStatus.CONVERGED if residual <= tolerance else ContactStatus.NOT_CONVERGED,
        problem=problem,
    )


def _start_from_coarser(grids: GradedGrids, tolerance: float) -> Array:
    """Start from the solution on columns of twice the widths, solved in the same way."""
    merge = coarsening(grids.shape)
    if merge == (1, 1):
        return grids.guess()
    coarse = grids.coarser(merge)
    tolerance = max(tolerance, min(COARSE_TOLERANCE, COARSE_FACTOR * tolerance))
    descent = Descent(coarse, _start_from_coarser(coarse, tolerance), threads=1, exact=False)
    descent.run(np.array([tolerance]), np.array([MOST_ITERATIONS]))
    return grids.fitted(prolong(descent.pressure / coarse.widths, grids.shape, merge) * grids.widths)


@dataclass(frozen=True, eq=False)
class Kernel:
    """Displacements between columns, transformed along x.

    Parameters
    ----------
    rows : int
        Cells along the columns.
    spacing : float [mm]
        Their length.
    borders : (ny + 1,) array [mm]
        Of the columns.
    edges, reference
        As of the problem.
    far : float
        As of :func:`column_coefficients`.
    """

    rows: int
    spacing: float
    borders: Array
    edges: Sequence[FreeEdge] = ()
    reference: float | None = None
    far: float = FAR_FIELD

    @cached_property
    def whole(self) -> Array:
        """Transform of the coefficients D, (wave numbers, ny, ny), displaced columns before pressed ones."""
        reach = fast_length(2 * self.rows) // 2
        coefficients = column_coefficients(reach + 1, self.spacing, self.borders, far=self.far)
        for edge in self.edges:
            mirrored, nearest = self._mirrored(edge)
            image = edge.factor * column_coefficients(reach + 1, self.spacing, self.borders, mirrored, far=self.far)
            if edge.across is not None:
                across = column_coefficients_across(reach + 1, self.spacing, self.borders, mirrored)
                image -= (edge.factor - self._across(edge)) * across
            coefficients += image[:, nearest[:, None], nearest]
        return np.asarray(scipy.fft.dct(coefficients, type=1, axis=0, overwrite_x=True))

    @cached_property
    def levels(self) -> list[Array]:
        """Of each edge the transform (wave numbers, 1, 1) of what is left out of its images."""
        levels, reach, reference = [], fast_length(2 * self.rows) // 2, self.reference
        if reference is None:
            return []
        middles = 0.5 * (self.borders[1:] + self.borders[:-1])
        for edge in self.edges:
            if edge.across is not None:
                continue  # its image counts in full
            mirrored, nearest = self._mirrored(edge)
            k = int(nearest[np.abs(middles - reference).argmin()])
            own = column_coefficients(reach + 1, self.spacing, self.borders[k : k + 2], mirrored[k : k + 1])
            levels.append(edge.factor * scipy.fft.dct(own, type=1, axis=0))
        return levels

    def _across(self, edge: FreeEdge) -> Array:
        """Factors psi(S) (ny, ny) of columns right across an edge from each other."""
        assert edge.across is not None
        far, own = edge.across
        distance = np.abs(0.5 * (self.borders[1:] + self.borders[:-1]) - self.borders[0] - edge.position)
        both = np.maximum(distance[:, None] + distance, TINY)
        return np.asarray(far + (own - far) * (4.0 * distance[:, None] * distance / both**2))

    def _mirrored(self, edge: FreeEdge) -> tuple[Array, Indices]:
        """Middles of the columns mirrored in an edge, and of each column the nearest one where the bodies are.

        A contact may go on beyond the apex of a wedge on its rounding. There it gives way as much as at the apex, and
        its forces act as if there: less would be a step in the surface, on which the pressure has no limit.
        """
        place, middles = self.borders[0] + edge.position, 0.5 * (self.borders[1:] + self.borders[:-1])
        inside = np.flatnonzero((middles < place) == (edge.material == "below"))
        nearest = np.arange(middles.size)
        return 2.0 * place - middles, np.clip(nearest, inside[0], inside[-1]) if inside.size else nearest

    @cached_property
    def symmetric(self) -> Array:
        """That of their symmetric part."""
        return np.asarray(0.5 * (self.whole + self.whole.transpose(0, 2, 1)))

    @cached_property
    def single(self) -> Array:
        """The same in single precision."""
        return self.symmetric.astype(np.float32)


@dataclass(frozen=True, eq=False)
class GradedGrids(Grids):
    """One contact problem on columns, as the iteration sees it: the unknowns are p w/E* [mm], w the width of a column.

    Parameters
    ----------
    kernel : Kernel
    slice_axis : {1, 0}
        Axis along which slices follow each other.
    """

    kernel: Kernel = field(kw_only=True)
    slice_axis: int = field(kw_only=True)

    @classmethod
    def of_problem(cls, problem: GradedProblem, far: float = FAR_FIELD) -> GradedGrids:
        """Return the columns given, gaps counted from first contact and cut where they cannot close."""
        modulus, widths, slices = problem.contact_modulus, problem.widths, problem.slice_compliance
        cap = np.inf if problem.max_pressure is None else problem.max_pressure
        near = cap * problem.cell_areas.min() < problem.load
        grids = cls(
            gap=(problem.gap - problem.first_contact)[None],
            spacing=np.array([[problem.spacing, float(widths.min())]]),
            total=each([problem.load / (problem.spacing * modulus)]),
            approach=each([np.nan]),
            cap=(cap * widths / modulus if near else np.full(widths.size, np.inf))[None, None],
            slices=None if slices is None else slices[None] * (modulus * problem.spacing),
            kernel=Kernel(
                problem.cells[0], problem.spacing, problem.borders, problem.free_edges, problem.reference, far
            ),
            slice_axis=problem.slice_axis,
        )
        return replace(grids, gap=np.minimum(grids.gap, OUT_OF_REACH * grids.reach))

    @property
    def widths(self) -> Array:
        """Widths of the columns, (ny,) [mm]."""
        return np.diff(self.kernel.borders)

    @property
    def farthest(self) -> Array:
        """Displacement that no cell exceeds, with a cap: that of a circle on which it carries the load."""
        cap, load = float((self.cap / self.widths).max()), self.total * self.kernel.spacing  # both over E*
        bent = 0.0 if self.slices is None else self.total * np.abs(self.slices).max()
        return np.asarray(2.0 * np.sqrt(cap * load / np.pi) + bent)

    @cached_property
    def reach(self) -> Array:
        r"""Gap beyond which no cell can come into contact [mm], (1, 1, 1).

        Without a cap the approach times the load, p.Kp + h.p, is at most twice the energy p.Kp/2 + h.p, and that is
        the least of all pressures of this load.
        """
        if self.capped:
            return super().reach
        guess = self._as_under_a_sphere()
        displaced = self.operator()(guess, np.empty(guess.shape))
        energy = float((guess * (0.5 * displaced + np.where(guess > 0.0, self.gap, 0.0))).sum())
        return REACH_RESERVE * 2.0 * energy / self.total

    def residual_of_cells(self, pressure: Array, excess: Array) -> Array:
        """A part of the pressure that would close the worst cell by itself, over the largest one.

        Fine cells carry next to nothing: what is wrong with them is lost in a mean weighted with the load.
        """
        wrong = np.where(pressure > self.slack, np.abs(excess), np.maximum(-excess, 0.0))
        if self.capped:
            wrong = np.where(pressure >= self.limit - self.slack, np.maximum(excess, 0.0), wrong)
        lacking, largest = (part.max(axis=CELLS, keepdims=True) for part in (wrong / self._own, pressure / self.widths))
        return np.asarray(OF_PRESSURE * lacking / largest)

    @cached_property
    def _own(self) -> Array:
        """Displacement [mm] of cells of the columns under a pressure E* on themselves alone, (ny,)."""
        return np.asarray(self.kernel.spacing * own_coefficient(self.widths / self.kernel.spacing))

    def coarser(self, merge: tuple[int, int]) -> GradedGrids:
        """Return the same problem with so many cells merged along each axis."""
        starts = np.arange(0, self.shape[1], merge[1])
        borders = np.append(self.kernel.borders[starts], self.kernel.borders[-1])
        dx, both = self.kernel.spacing * merge[0], (merge[self.slice_axis],) * 2
        gap = np.minimum(coarsen(self.gap, merge, self.reach), self.gap.max())
        return replace(
            self,
            gap=gap,
            spacing=np.array([[dx, float(np.diff(borders).min())]]),
            total=self.total / merge[0],
            cap=np.add.reduceat(self.cap, starts, axis=2),
            slices=None if self.slices is None else merged(self.slices, both) * merge[0],
            kernel=replace(self.kernel, rows=gap.shape[1], spacing=dx, borders=borders),
        )

    def operator(self, _: Window | None = None, dtype: str = "float64", threads: int = 1) -> Operator:  # noqa: ARG002
        """K, of the symmetric coefficients, as a function (forces, out, rows) that returns ``out``."""
        symbol = self.kernel.symmetric if dtype == "float64" else self.kernel.single

        def displaced(forces: Array, out: Array, _: Rows = ALL) -> Array:
            forces = forces.astype(dtype, copy=False)
            out[0] = _filtered(forces[0], symbol)
            if self.slices is not None:
                moved = self.slices[0].astype(dtype, copy=False) @ forces[0].sum(axis=1 - self.slice_axis, dtype=dtype)
                out[0] += moved if self.slice_axis == 1 else moved[:, None]
            return out

        return displaced

    def displaced(self, forces: Array) -> tuple[Array, Array]:
        """Displacement by forces, and the part of it that the symmetric coefficients do not tell."""
        symmetric = self.operator()(forces, np.empty(forces.shape))
        rest = _filtered(forces[0], self.kernel.whole - self.kernel.symmetric)[None]
        for level in self.kernel.levels:
            rest -= _filtered(forces[0].sum(axis=1, keepdims=True), level)
        return symmetric + rest, rest

    def preconditioner(self, threads: int = 1) -> Operator:  # noqa: ARG002
        """Inverse of K with the cells periodic along x, bending of the columns included."""
        # Of the wave numbers of twice the length every second one is one of the length itself.
        periodic, length = self.kernel.symmetric[::2].copy(), len(self.kernel.symmetric) - 1
        if self.slices is not None and self.slice_axis == 1:
            periodic[0] += length * self.slices[0]
        inverse = np.linalg.inv(periodic.astype(np.float32))

        def apply(forces: Array, out: Array, _: Rows = ALL) -> Array:
            out[0] = _filtered(forces[0], inverse, length)
            return out

        return apply

    def guess(self) -> Array:
        """Forces to start from without others: those of a sphere, within the bounds."""
        return self.fitted(self._as_under_a_sphere())

    def _as_under_a_sphere(self) -> Array:
        """Forces of the right sum."""
        return _sphere(self.gap[0], self.kernel.spacing, self.widths, float(self.total[0, 0, 0]))[None]


def _sphere(gap: Array, spacing: float, widths: Array, total: float) -> Array:
    """Forces (nx, ny) of a sum on columns: where the gap is below a level, pressures as the root of what it lacks.

    The level is that of a sphere under this load whose contact has as large an area.
    """
    product, order = 0.375 * total * spacing, np.argsort(gap, axis=None)  # of level and radius
    areas = np.cumsum(np.broadcast_to(widths * spacing, gap.shape).ravel()[order])
    radii = np.sqrt(areas / np.pi)
    closed = max(1, int(np.count_nonzero(gap.ravel()[order] < product / radii)))
    level = max(product / float(radii[closed - 1]), float(gap.ravel()[order[0]]))
    root = np.sqrt(np.maximum(level - gap, 0.0)) * widths
    if not root.any():
        root.ravel()[order[0]] = 1.0
    return np.asarray(root * (total / root.sum()))


def _filtered(values: Array, symbol: Array, length: int | None = None) -> Array:
    """Product (nx, ny) of values with a symbol (wave numbers, ny, ny) of transforms of a length along x."""
    rows, length = len(values), 2 * (len(symbol) - 1) if length is None else length
    if rows <= SHORT:
        forward, backward = _waves(rows, length, symbol.dtype.str)
        spectrum = (forward @ values).reshape(len(symbol), 2, -1)
        return np.asarray(backward @ np.matmul(spectrum, symbol.swapaxes(1, 2)).reshape(2 * len(symbol), -1))
    spectrum = np.ascontiguousarray(scipy.fft.rfft(values, length, axis=0))
    product = np.matmul(symbol, spectrum.view(symbol.dtype).reshape(*spectrum.shape, 2))
    moved = scipy.fft.irfft(product.view(spectrum.dtype)[..., 0], length, axis=0, overwrite_x=True)
    return np.asarray(moved[:rows])


@lru_cache(maxsize=64)
def _waves(rows: int, length: int, dtype: str) -> tuple[Array, Array]:
    """Transforms of some rows of a length as matrices: to cosine and sine of each wave number, and back."""
    waves = np.arange(length // 2 + 1)
    angles = (2.0 * np.pi / length) * (waves[:, None] * np.arange(rows) % length)
    forward = np.stack([np.cos(angles), -np.sin(angles)], axis=1)
    counted = np.where((waves == 0) | (2 * waves == length), 1.0, 2.0) / length
    both = forward.reshape(2 * waves.size, rows), (counted[:, None, None] * forward).reshape(2 * waves.size, rows).T
    return both[0].astype(dtype), both[1].astype(dtype)
