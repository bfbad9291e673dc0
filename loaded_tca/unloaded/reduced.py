r"""The reduced solver: the maximum of the ease-off over the region that both flanks cover, from any start.

Two unknowns (rho, z) on the pinion flank, a smooth objective e and a handful of smooth edges c_k >= 0: a
sequential quadratic programme, all starts advanced together. In two dimensions the quadratic subproblem is solved
exactly by listing its candidates (free, on one edge, in one corner), so that no active set is carried along.

Safeguards: Newton on the absolute values of the curvatures (always uphill), steps below half the flank, an edge
or a bent ridge is kept to second order, and a step is accepted only if the merit e - mu * violation does not fall. An
ascent that creeps outside the region (below a base cone the field has no meaning) first goes back to its edges.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from itertools import combinations

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.unloaded.ease_off import EaseOff, Station

PARALLEL = 1e-9
"""Sine of the angle between two edges below which they have no corner."""
TINY = 1e-300
FLAT = 1e-12
"""Smallest curvature along an edge taken for real, relative to the largest there is: below it is rounding."""
REACHED = 1e-3
"""Distance, as a fraction of the flank, within which an edge's own curvature counts: a step to one farther away must
rise by the model as a whole."""
LARGEST_STEP = 0.5
"""Longest step, as a fraction of the flank."""
MOST_STEPS = 300
MOST_HALVINGS = 30
SHORT_STEP = 1e-9
"""Fraction of the flank below which a Newton step is the last: the next would be its square."""
FORGOTTEN = 0.1
"""What is left, after a step, of the weight of a violation: beside a base cone slopes of 1e8 are met, which would bar
the way along any bent edge ever after."""
CREEPING = 2.0**-6
"""Share of a step; if no more of it is accepted outside the region, the field there is no guide, the edges are."""
HARDLY = 2.0**-20
"""Share of a step below which an ascent counts as stuck: from beside a base cone it would creep on in hundreds."""
INWARDS = 1e6
"""Weight of the violation against the ease-off on the way back into the region."""
RIDGE_CORRECTIONS = 3
"""Newton steps back across a bent ridge: half a face width along it leaves it by 0.1 mm, then 1e-3, 1e-7."""
MERIT_SLACK = 1e-15
"""Rounding of the ease-off relative to the sum of the base radii, not to be mistaken for a fall."""
CURVATURE_FLOOR = 1e-12
"""Smallest curvature taken for real, relative to the largest: below it the ridge is flat to rounding."""
SMALLEST_GAIN = 1e-18
"""Predicted rise of the ease-off, relative to r_b2, at which an ascent ends: far below rounding of e itself, so that
the quadratic convergence of the last step has placed the point, too."""
ROOM = 1e-12
"""Distance [mm, relative to the flank's height] by which a step may cross an edge: rounding."""
FEASIBLE = 1e-9
"""Distance [mm, relative to the flank's height] within which an edge counts as met."""


@dataclass(frozen=True, eq=False)
class Quadratic:
    """Quadratic problems (n,) with their linear edges.

    Attributes
    ----------
    gradient : (n, 2) array
        g.
    curvature : (n, 2, 2) array
        N.
    edges : (n, k) array
        c.
    slopes : (n, k, 2) array
        J.
    bend : (n, 2, 2) array
        The matrix that was made positive to give N; along an edge its own curvature counts, which N overrates where
        the edge does not follow an axis of N.
    """

    gradient: Array
    curvature: Array
    edges: Array
    slopes: Array
    bend: Array

    def only(self, rows: Indices | Mask) -> Quadratic:
        """Some of the problems."""
        parts = (self.gradient, self.curvature, self.edges, self.slopes, self.bend)
        return Quadratic(*(part[rows] for part in parts))

    # Sums over axes of length two cost ten times what the components do: steps come as (x, y), (n, m) each.

    def room(self, x: Array, y: Array) -> Array:
        """Distance to the nearest edge after the steps: (n, m), negative outside."""
        nearest = np.full(x.shape, np.inf)
        for edge in range(self.edges.shape[-1]):
            across = x * self.slopes[:, edge, :1] + y * self.slopes[:, edge, 1:]
            across += self.edges[:, edge, None]
            np.minimum(nearest, across, out=nearest)
        return nearest

    def rest(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Gradient of the model after the steps: two arrays (n, m)."""
        along, aside = _times(self.curvature, x, y)
        return self.gradient[:, :1] - along, self.gradient[:, 1:] - aside


def _times(matrix: Array, x: Array, y: Array) -> tuple[Array, Array]:
    """Symmetric matrices (n, 2, 2) times vectors (x, y), (n, m) each."""
    first, mixed, second = (matrix[:, i, j, None] for i, j in ((0, 0), (0, 1), (1, 1)))
    return x * first + y * mixed, x * mixed + y * second


def best_step(problem: Quadratic, tolerance: float) -> tuple[Array, Array]:
    """Constrained maximum of every problem whose free maximum lies outside.

    Returns
    -------
    (n, 2) array
        Step; where no point keeps all edges, the candidate that violates them least.
    (n, k) array
        Multipliers >= 0.
    """
    *parts, force = _on_one_edge(problem)
    optimal = (problem.room(*parts) >= -tolerance) & (force >= 0.0)
    step = np.stack(parts, axis=-1)
    rows, best = np.arange(len(step)), optimal.argmax(axis=1)
    chosen, multipliers = step[rows, best], np.zeros_like(force)
    multipliers[rows, best] = np.maximum(force[rows, best], 0.0)
    left = np.flatnonzero(~optimal.any(axis=1))
    if left.size:
        chosen[left], multipliers[left] = _in_a_corner(problem.only(left), step[left], tolerance)
    return chosen, multipliers


def _on_one_edge(problem: Quadratic) -> tuple[Array, Array, Array]:
    """Best step onto each edge, x and y, and its multiplier, (n, k) each.

    From the foot of the edge along its tangent: the free step is not used, since on a flat ridge it is so long that
    nothing would be left of its difference to the edge.
    """
    x, y = (np.ascontiguousarray(problem.slopes[..., part]) for part in (0, 1))
    square = np.maximum(x * x + y * y, TINY)
    foot = -problem.edges / square
    rest = problem.rest(x * foot, y * foot)
    rise = x * rest[1] - y * rest[0]  # along the tangent (-y, x)
    modelled, own = (
        x * aside - y * along for along, aside in (_times(m, -y, x) for m in (problem.curvature, problem.bend))
    )
    flat = FLAT * square * np.linalg.norm(problem.bend, axis=(-2, -1))[:, None]
    reached = np.abs(problem.edges) <= REACHED * np.sqrt(square)
    bend = np.maximum(np.where(reached, np.maximum(np.abs(own), flat), modelled), TINY)
    part = rise / bend
    step = x * foot - y * part, y * foot + x * part
    rest = problem.rest(*step)
    return *step, -(rest[0] * x + rest[1] * y) / square


def _in_a_corner(problem: Quadratic, singles: Array, tolerance: float) -> tuple[Array, Array]:
    """Best feasible corner; if there is none, the corner or single-edge step that violates the edges least."""
    pairs = np.array(list(combinations(range(problem.edges.shape[-1]), 2)))
    slopes, edges = problem.slopes[:, pairs], -problem.edges[:, pairs]
    corners, parallel = solve_pairs(slopes[:, :, 0], slopes[:, :, 1], edges[..., 0], edges[..., 1])
    x, y = np.moveaxis(corners, -1, 0)
    room = np.where(parallel, -np.inf, problem.room(x, y))
    along, aside = problem.rest(x, y)
    rise = x * (problem.gradient[:, :1] + along) + y * (problem.gradient[:, 1:] + aside)
    rows, best = np.arange(len(room)), np.where(room >= -tolerance, rise, -np.inf).argmax(axis=1)
    step, feasible = corners[rows, best], np.asarray((room >= -tolerance).any(axis=1))
    lost = np.flatnonzero(~feasible)
    everything = np.concatenate([singles[lost], corners[lost]], axis=1)
    least = np.concatenate([problem.only(lost).room(*np.moveaxis(singles[lost], -1, 0)), room[lost]], axis=1)
    step[lost] = everything[np.arange(len(lost)), least.argmax(axis=1)]
    # multipliers of the two edges of a corner, from rest + J^T lambda = 0; zero where there is none
    multipliers, held = np.zeros_like(problem.edges), np.flatnonzero(feasible)
    two = held[:, None], pairs[best[held]]
    rest = np.concatenate(problem.only(held).rest(step[held, :1], step[held, 1:]), axis=1)
    forces = np.linalg.solve(np.swapaxes(problem.slopes[two], -1, -2), -rest[..., None])[..., 0]
    multipliers[two] = np.maximum(forces, 0.0)
    return step, multipliers


def solve_pairs(first: Array, second: Array, one: Array, two: Array) -> tuple[Array, Array]:
    """Solutions (..., 2) of [first; second] x = [one, two], a far point for parallel rows, and which are parallel."""
    determinant = first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]
    least = PARALLEL * np.linalg.norm(first, axis=-1) * np.linalg.norm(second, axis=-1) + TINY
    parallel = np.abs(determinant) <= least
    determinant = np.where(parallel, least, determinant)
    x = (one * second[..., 1] - two * first[..., 1]) / determinant
    y = (first[..., 0] * two - second[..., 0] * one) / determinant
    return np.stack([x, y], axis=-1), parallel


@dataclass(frozen=True, eq=False)
class Maxima:
    """Where each ascent ended.

    Attributes
    ----------
    rho, z : (n,) array [mm]
        On the pinion flank.
    value : (n,) array [mm]
        Ease-off there.
    multipliers : (n, edges) array
        Slope of the ease-off against each edge that holds the point back, >= 0.
    iterations : (n,) int array
    converged : (n,) bool array
        Whether a feasible stationary point was reached.
    """

    rho: Array
    z: Array
    value: Array
    multipliers: Array
    iterations: Array
    converged: Array

    def only(self, rows: Indices | Mask) -> Maxima:
        """Some of the ascents."""
        return Maxima(*(getattr(self, one.name)[rows] for one in fields(Maxima)))


@dataclass(frozen=True, eq=False)
class _Local:
    """The field at the current points, lengths scaled by the flank's extent."""

    station: Station
    gradient: Array
    edges: Array
    slopes: Array


@checked
def climb(field: EaseOff, phi1: Array, rho: Array, z: Array) -> Maxima:
    """Climb the ease-off field from every start at once.

    Parameters
    ----------
    field : EaseOff
    phi1, rho, z : (n,) array [rad, mm, mm]
        Pinion angle and start on the pinion flank of each ascent.

    Returns
    -------
    Maxima
    """
    scale = np.asarray(field.pair.pinion.flank.extent)
    points = np.stack([rho, z], axis=-1) / scale
    count, edges = len(phi1), len(field.edge_owner())
    multipliers, penalty = np.zeros((count, edges)), np.ones(count)
    iterations, converged = np.zeros(count, dtype=int), np.zeros(count, dtype=bool)
    rows, (lost, stuck) = np.arange(count), np.zeros((2, count), dtype=bool)
    for number in range(1, MOST_STEPS + 1):
        part, angle = field.restricted(rows), phi1[rows]
        here = _look(part, angle, points[rows], scale)
        outside = here.edges.min(axis=-1) < -FEASIBLE * scale[0]
        lost[rows] &= outside
        before = multipliers[rows]
        step, multipliers[rows] = _propose(part, here, before, scale, (lost[rows], stuck[rows]))
        penalty[rows] = np.maximum(np.maximum(1.0, FORGOTTEN * penalty[rows]), 2.0 * multipliers[rows].max(axis=-1))
        gain, longest = np.abs((here.gradient * step).sum(axis=-1)), np.abs(step).max(axis=-1)
        settled = ((gain <= SMALLEST_GAIN * field.pair.base_radii[1]) | (longest <= SHORT_STEP)) & ~outside
        iterations[rows] = number
        weight = np.where(lost[rows], INWARDS, penalty[rows])
        ahead, share = _advance(part, angle, points[rows], step, here, multipliers[rows], weight)
        stays = (ahead == points[rows]).all(axis=-1)
        points[rows] = ahead
        converged[rows] = settled
        creeps = outside & ((share < CREEPING) | (longest <= SHORT_STEP))
        repeats = (longest == 0.0) & (multipliers[rows] == before).all(axis=-1) & ~stuck[rows]  # no step, ever after
        ended = settled | repeats | (stays & stuck[rows]) | (creeps & lost[rows])
        lost[rows] |= creeps & ~stays
        stuck[rows] = share < HARDLY
        rows = rows[~ended]
        if not rows.size:
            break
    value, distances = field.heights(phi1, *(points * scale).T)
    converged &= distances.min(axis=-1) >= -FEASIBLE * scale[0]
    rho, z = (points * scale).T
    return Maxima(rho, z, value, multipliers, iterations, converged)


def _look(field: EaseOff, phi1: Array, points: Array, scale: Array) -> _Local:
    station = field.station(phi1, *(points * scale).T)
    edges, slopes = field.edges(station)
    return _Local(station, field.gradient(station) * scale, edges, slopes * scale)


def _advance(
    field: EaseOff, phi1: Array, points: Array, step: Array, here: _Local, multipliers: Array, penalty: Array
) -> tuple[Array, Array]:
    """Points after the longest step, halved as often as needed, that does not lower the merit; the share accepted."""
    scale = np.asarray(field.pair.pinion.flank.extent)

    def merit(rows: Indices, trial: Array) -> tuple[Array, Array]:
        value, edges = field.restricted(rows).heights(phi1[rows], *(trial * scale).T)
        return value - penalty[rows] * np.maximum(0.0, -edges).sum(axis=-1), edges

    rows, tried = np.arange(len(points)), 0
    before = field.value(here.station, phi1) - penalty * np.maximum(0.0, -here.edges).sum(axis=-1)
    before -= MERIT_SLACK * sum(field.pair.base_radii)
    share, result = np.zeros(len(points)), points.copy()
    while rows.size and tried < MOST_HALVINGS:
        # more and more shares at once: the few ascents that accept none cost calls, not points
        shares = 0.5 ** np.arange(tried, min(2 * tried + 1, MOST_HALVINGS))
        tried += len(shares)
        owner = np.repeat(rows, len(shares))
        trial = points[owner] + step[owner] * np.tile(shares, len(rows))[:, None]
        after, edges = merit(owner, trial)
        held = (multipliers[owner] > 0.0).sum(axis=-1)
        bent = np.flatnonzero((after < before[owner]) & (held == 1))
        if bent.size:
            trial[bent] += _back_to_edge(here.slopes[owner[bent]], edges[bent], multipliers[owner[bent]])
            after[bent], _ = merit(owner[bent], trial[bent])
        astray = np.flatnonzero((after < before[owner]) & (held <= 1))
        if astray.size:
            part = owner[astray]
            trial[astray] = _back_to_ridge(field.restricted(part), phi1[part], trial[astray], multipliers[part], scale)
            after[astray], _ = merit(part, trial[astray])
        # where the curvature jumps, as at the start of an arc, corrections may lead back to the point itself
        way, asked = np.abs(trial - points[owner]).max(axis=-1), np.abs(step[owner]).max(axis=-1)
        moved = way >= HARDLY * np.tile(shares, len(rows)) * asked
        good = ((after >= before[owner]) & moved).reshape(len(rows), -1)
        first, accepted = good.argmax(axis=1), good.any(axis=1)
        result[rows[accepted]] = trial.reshape(len(rows), -1, 2)[accepted, first[accepted]]
        share[rows[accepted]] = shares[first[accepted]]
        rows = rows[~accepted]
    return result, share


def _back_to_edge(slopes: Array, edges: Array, multipliers: Array) -> Array:
    """Second-order correction: from a trial point back to the one edge it is held by."""
    held = multipliers.argmax(axis=-1)
    rows = np.arange(len(held))
    slope = slopes[rows, held]
    return -slope * (edges[rows, held] / np.maximum((slope**2).sum(axis=-1), 1e-300))[:, None]


def _back_to_ridge(field: EaseOff, phi1: Array, points: Array, multipliers: Array, scale: Array) -> Array:
    """Trial points moved across the ridge, or along the one edge that holds them, to its top.

    A flat ridge (a nearly unmodified helical pair) is bent: a straight step along it falls by more than its end rises.
    """
    held, rows = np.asarray((multipliers > 0.0).any(axis=-1)), np.arange(len(points))
    for _ in range(RIDGE_CORRECTIONS):
        here = _look(field, phi1, points, scale)
        bend = field.hessian(here.station) * np.outer(scale, scale)
        values, vectors = np.linalg.eigh(bend)
        slope = here.slopes[rows, multipliers.argmax(axis=-1)]
        edge = np.stack([-slope[:, 1], slope[:, 0]], axis=-1)
        across = np.where(held[:, None], edge, vectors[rows, :, np.abs(values).argmax(axis=-1)])
        curvature = np.abs(np.einsum("ni,nij,nj->n", across, bend, across))
        shift = (across * here.gradient).sum(axis=-1) / np.maximum(curvature, 1e-300)
        length = np.linalg.norm(across, axis=-1)
        points = points + across * np.clip(shift, -LARGEST_STEP / length, LARGEST_STEP / length)[:, None]
        points[held] += _back_to_edge(here.slopes[held], here.edges[held], multipliers[held])
    return points


def _propose(
    field: EaseOff, here: _Local, multipliers: Array, scale: Array, plain: tuple[Mask, Mask]
) -> tuple[Array, Array]:
    """Step (n, 2) of the quadratic model within the linearised edges, and its multipliers (n, edges).

    Where an ascent is lost (the first of ``plain``, (n,) bool) the model is level, and the step the shortest one into
    the edges; where it is stuck (the second) the model is equally bent in all directions, so that the step rises.
    """
    lost, stuck = plain
    bend = field.hessian(here.station)
    held = np.asarray((multipliers > 0.0).any(axis=-1))
    if held.any():
        bend = bend + field.edge_hessian(here.station, multipliers)
    bend = -bend * np.outer(scale, scale)
    if (lost | stuck).any():
        size = np.where(lost, 1.0, np.linalg.norm(bend, axis=(-2, -1)))
        bend = np.where((lost | stuck)[:, None, None], size[:, None, None] * np.eye(2), bend)
    gradient = np.where(lost[:, None], 0.0, here.gradient)
    inverse, curvature = _positive(bend)
    step = inverse[..., 0] * gradient[..., :1] + inverse[..., 1] * gradient[..., 1:]
    multipliers_found = np.zeros_like(multipliers)
    tolerance = ROOM * scale[0]
    room = here.edges + here.slopes[..., 0] * step[:, :1] + here.slopes[..., 1] * step[:, 1:]
    out = np.flatnonzero(room.min(axis=-1) < -tolerance)
    if out.size:
        problem = Quadratic(gradient[out], curvature[out], here.edges[out], here.slopes[out], bend[out])
        step[out], multipliers_found[out] = best_step(problem, tolerance)
    length = np.linalg.norm(step, axis=-1, keepdims=True)
    return step * np.minimum(1.0, LARGEST_STEP / np.maximum(length, 1e-300)), multipliers_found


def _positive(matrix: Array) -> tuple[Array, Array]:
    """Inverse of, and itself, a symmetric 2 x 2 matrix whose eigenvalues are made positive: (n, 2, 2) each."""
    mean = 0.5 * (matrix[..., 0, 0] + matrix[..., 1, 1])
    half, off = 0.5 * (matrix[..., 0, 0] - matrix[..., 1, 1]), matrix[..., 0, 1]
    radius = np.maximum(np.hypot(half, off), 1e-300)
    high, low = np.abs(mean + radius), np.abs(mean - radius)
    floor = CURVATURE_FLOOR * np.maximum(np.maximum(high, low), 1e-200)
    high, low = np.maximum(high, floor), np.maximum(low, floor)
    half, off = half / radius, off / radius

    def function(first: Array, second: Array) -> Array:
        even, odd = 0.5 * (first + second), 0.5 * (first - second)
        result = np.empty((2, 2, *even.shape))
        result[0, 0], result[1, 1] = even + odd * half, even - odd * half
        result[0, 1] = result[1, 0] = odd * off
        return np.moveaxis(result, (0, 1), (-2, -1))

    return function(1.0 / high, 1.0 / low), function(high, low)
