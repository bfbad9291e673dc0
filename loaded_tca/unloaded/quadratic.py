"""The quadratic subproblem of the reduced solver, solved exactly: in two dimensions its candidates can be listed.

Maximise g.s - s.N.s/2 (N positive definite) subject to c + J s >= 0. The maximum is the free one, or lies on one edge
with a multiplier >= 0, or in a corner of two; no active set has to be carried along or guessed.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from loaded_tca.arrays import Array

PARALLEL = 1e-9
"""Sine of the angle between two edges below which they have no corner."""
TINY = 1e-300
FLAT = 1e-12
"""Smallest curvature along an edge taken for real, relative to the largest there is: below it is rounding."""
REACHED = 1e-3
"""Distance, as a fraction of the flank, within which an edge's own curvature counts: a step to one farther away must
rise by the model as a whole."""


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

    def only(self, rows: Array) -> Quadratic:
        """Some of the problems."""
        parts = (self.gradient, self.curvature, self.edges, self.slopes, self.bend)
        return Quadratic(*(part[rows] for part in parts))

    def room(self, steps: Array) -> Array:
        """Distance to the nearest edge after the steps (n, m, 2): (n, m), negative outside."""
        return (steps @ np.swapaxes(self.slopes, -1, -2) + self.edges[:, None, :]).min(axis=-1)

    def rest(self, steps: Array) -> Array:
        """Gradient of the model after the steps (n, m, 2)."""
        return self.gradient[:, None, :] - steps @ self.curvature


def best_step(problem: Quadratic, tolerance: float) -> tuple[Array, Array]:
    """Constrained maximum of every problem whose free maximum lies outside.

    Returns
    -------
    (n, 2) array
        Step; where no point keeps all edges, the candidate that violates them least.
    (n, k) array
        Multipliers >= 0.
    """
    step, force = _on_one_edge(problem)
    optimal = (problem.room(step) >= -tolerance) & (force >= 0.0)
    rows, best = np.arange(len(step)), optimal.argmax(axis=1)
    chosen, multipliers = step[rows, best], np.zeros_like(force)
    multipliers[rows, best] = np.maximum(force[rows, best], 0.0)
    left = np.flatnonzero(~optimal.any(axis=1))
    if left.size:
        chosen[left], multipliers[left] = _in_a_corner(problem.only(left), step[left], tolerance)
    return chosen, multipliers


def _on_one_edge(problem: Quadratic) -> tuple[Array, Array]:
    """Best step onto each edge (n, k, 2), and its multiplier (n, k).

    From the foot of the edge along its tangent: the free step is not used, since on a flat ridge it is so long that
    nothing would be left of its difference to the edge.
    """
    slopes = problem.slopes
    square = np.maximum((slopes**2).sum(axis=-1), TINY)
    foot = -slopes * (problem.edges / square)[..., None]
    tangent = np.stack([-slopes[..., 1], slopes[..., 0]], axis=-1)
    rise = (problem.rest(foot) * tangent).sum(axis=-1)
    modelled, own = (((tangent @ matrix) * tangent).sum(axis=-1) for matrix in (problem.curvature, problem.bend))
    flat = FLAT * square * np.linalg.norm(problem.bend, axis=(-2, -1))[:, None]
    reached = np.abs(problem.edges) <= REACHED * np.sqrt(square)
    bend = np.maximum(np.where(reached, np.maximum(np.abs(own), flat), modelled), TINY)
    step = foot + tangent * (rise / bend)[..., None]
    return step, -(problem.rest(step) * slopes).sum(axis=-1) / square


def _in_a_corner(problem: Quadratic, singles: Array, tolerance: float) -> tuple[Array, Array]:
    """Best feasible corner; if there is none, the corner or single-edge step that violates the edges least."""
    pairs = np.array(list(combinations(range(problem.edges.shape[-1]), 2)))
    corners, parallel = _corners(problem, pairs)
    room = np.where(parallel, -np.inf, problem.room(corners))
    rise = (corners * (problem.gradient[:, None, :] + problem.rest(corners))).sum(axis=-1)
    rows, best = np.arange(len(room)), np.where(room >= -tolerance, rise, -np.inf).argmax(axis=1)
    step, feasible = corners[rows, best], np.asarray((room >= -tolerance).any(axis=1))
    lost = np.flatnonzero(~feasible)
    everything = np.concatenate([singles[lost], corners[lost]], axis=1)
    least = np.concatenate([problem.only(lost).room(singles[lost]), room[lost]], axis=1).argmax(axis=1)
    step[lost] = everything[np.arange(len(lost)), least]
    return step, _corner_forces(problem, step, pairs[best], feasible)


def _corners(problem: Quadratic, pairs: Array) -> tuple[Array, Array]:
    """Steps to the crossings of two edges: (n, pairs, 2), and which pairs are parallel."""
    first, second = problem.slopes[:, pairs[:, 0]], problem.slopes[:, pairs[:, 1]]
    c1, c2 = -problem.edges[:, pairs[:, 0]], -problem.edges[:, pairs[:, 1]]
    cross = first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]
    parallel = np.abs(cross) <= PARALLEL * np.linalg.norm(first, axis=-1) * np.linalg.norm(second, axis=-1)
    cross = np.where(parallel, 1.0, cross)
    x = (c1 * second[..., 1] - c2 * first[..., 1]) / cross
    y = (first[..., 0] * c2 - second[..., 0] * c1) / cross
    return np.stack([x, y], axis=-1), parallel


def _corner_forces(problem: Quadratic, step: Array, chosen: Array, feasible: Array) -> Array:
    """Multipliers >= 0 of the two edges of each corner, from rest + J^T lambda = 0; zero where there is no corner."""
    multipliers = np.zeros_like(problem.edges)
    rows = np.flatnonzero(feasible)
    matrix = problem.slopes[rows[:, None], chosen[rows]]
    rest = problem.only(rows).rest(step[rows, None, :])[:, 0]
    forces = np.linalg.solve(np.swapaxes(matrix, -1, -2), -rest[..., None])[..., 0]
    multipliers[rows[:, None], chosen[rows]] = np.maximum(forces, 0.0)
    return multipliers
