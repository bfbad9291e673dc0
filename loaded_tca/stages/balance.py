r"""Balance of a stage: how planets share the torque of the sun.

The sun turns by theta and moves by x_s beyond where kinematics have it, so that the flanks of planet i approach by

.. math:: \delta_i = r_{bs}\,\theta + n_i \cdot x_s - e_i

along its two transverse lines of action together; e_i is what the displaced pin takes away. A planet in balance presses
sun and ring with one force F_i at the base circles, under which both meshes give way by

.. math:: D_i(F) = d_{sp}(F, \tau_{s,i}) + d_{pr}(F, \tau_{r,i}) .

With F = G(delta) its inverse, and no force where delta is below D(0), the balance

.. math:: \sum_i F_i\,r_{bs} = T, \qquad \sum_i F_i\,n_i = -K x_s

is the minimum of a convex potential; Newton's steps are halved until it falls.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from loaded_tca.arrays import Array
from loaded_tca.errors import ConvergenceError, InputError
from loaded_tca.plain import plain

MOST_STEPS = 200
TOLERANCE = 1e-11
"""Of the balance of forces, over the whole force."""


@dataclass(frozen=True, eq=False)
class Deflections:
    """How far the flanks of a mesh give way under forces, over a pitch.

    Attributes
    ----------
    force : (k,) array [N]
        At the base circle, rising from 0.
    deflection : (k, n) array [mm]
        Under each force at n even positions of a pitch; without load: how far the flanks are apart there.
    start : float
        Phase of the first position, in mesh cycles from the pitch point.
    """

    force: Array
    deflection: Array
    start: float = 0.0

    def __post_init__(self) -> None:
        if self.force[0] != 0.0 or (np.diff(self.force) <= 0.0).any():
            raise InputError(f"force: {self.force[:4]} N does not rise from 0")

    def at(self, phase: Array) -> Array:
        """Deflections (k, ...) at phases (...) in mesh cycles, by a periodic spline through the positions."""
        count = self.deflection.shape[1]
        closed = np.concatenate([self.deflection, self.deflection[:, :1]], axis=1)
        spline = scipy.interpolate.CubicSpline(np.arange(count + 1) / count, closed, axis=1, bc_type="periodic")
        return np.asarray(spline(np.mod(phase - self.start, 1.0)))


@dataclass(frozen=True)
class Shares:
    """Balance of one state.

    Attributes
    ----------
    force : (planets,) array [N]
        At the base circles.
    rotation : float [mm]
        Of the sun, r_bs theta.
    motion : (2,) array [mm]
        Of the sun's axis.
    """

    force: Array
    rotation: float
    motion: Array


class _Path:
    """One planet: its force over the approach, with slope and integral; zero below the first contact."""

    def __init__(self, deflection: Array, force: Array) -> None:
        rising = np.maximum.accumulate(deflection)
        keep = np.append(True, np.diff(rising) > 0.0)
        if keep.sum() < 2:
            raise InputError("deflection: it does not grow with the force")
        self.first, self.last = float(rising[0]), float(rising[keep][-1])
        self._force = scipy.interpolate.PchipInterpolator(rising[keep], force[keep])
        self._slope, self._work = self._force.derivative(), self._force.antiderivative()
        self._start = float(self._work(self.first))
        self.stiffest = float(self._slope(self.last))

    def at(self, approach: float) -> tuple[float, float, float]:
        """Force [N], stiffness [N/mm], work [N mm]; beyond the largest force as stiff as there."""
        if approach <= self.first:
            return 0.0, 0.0, 0.0
        inside, beyond = min(approach, self.last), max(approach - self.last, 0.0)
        force, slope = float(self._force(inside)), float(self._slope(inside))
        work = float(self._work(inside)) - self._start
        return (
            force + self.stiffest * beyond,
            self.stiffest if beyond > 0.0 else slope,
            work + force * beyond + 0.5 * self.stiffest * beyond**2,
        )


def balance(
    force: Array, deflections: Array, directions: Array, errors: Array, total: float, support_stiffness: float
) -> Shares:
    """Forces of the planets in one state.

    Parameters
    ----------
    force : (k,) array [N]
        Rising from 0.
    deflections : (planets, k) array [mm]
        Of both meshes of each planet under these forces.
    directions : (planets, 2) array
        n_i: how much a motion of the sun brings its flanks together with those of the planets.
    errors : (planets,) array [mm]
        e_i.
    total : float [N]
        Torque of the sun over its base radius.
    support_stiffness : float [N/mm]
        Of the sun's support; inf: rigid, 0: it floats.

    Returns
    -------
    Shares

    Raises
    ------
    ConvergenceError
        If the balance is not found.

    Examples
    --------
    >>> force = np.array([0.0, 1000.0, 3000.0])
    >>> planets = np.outer(np.ones(3), force / 1e5)
    >>> balance(force, planets, np.zeros((3, 2)), np.zeros(3), 3000.0, np.inf).force.round(6).tolist()
    [1000.0, 1000.0, 1000.0]
    """
    paths = [_Path(own, force) for own in deflections]
    moving = np.isfinite(support_stiffness)
    matrix = np.column_stack([np.ones(len(paths)), directions]) if moving else np.ones((len(paths), 1))
    held = np.diag([0.0, *2 * [support_stiffness]]) if moving else np.zeros((1, 1))
    load = np.zeros(len(held))
    load[0] = total

    def state(unknown: Array) -> tuple[float, Array, Array, Array]:
        parts = np.array([path.at(approach) for path, approach in zip(paths, matrix @ unknown - errors, strict=True)])
        potential = parts[:, 2].sum() + 0.5 * unknown @ held @ unknown - load @ unknown
        residual = matrix.T @ parts[:, 0] + held @ unknown - load
        return float(potential), residual, matrix.T @ (parts[:, 1, None] * matrix) + held, parts[:, 0]

    even = np.array([np.interp(total / len(paths), force, own) for own in deflections])
    unknown = np.linalg.lstsq(matrix, errors + even, rcond=None)[0]
    if not state(unknown)[3].any():
        unknown[0] = float((errors + even).max())
    potential, residual, tangent, forces = state(unknown)
    for _ in range(MOST_STEPS):
        if np.abs(residual).max() <= TOLERANCE * total:
            return Shares(forces, float(unknown[0]), unknown[1:] if moving else np.zeros(2))
        step = -np.linalg.lstsq(tangent, residual, rcond=1e-13)[0]
        size = 1.0
        while True:
            trial = state(unknown + size * step)
            fallen = trial[0] <= potential + 1e-4 * size * float(residual @ step)
            smaller = np.abs(trial[1]).max() < np.abs(residual).max()
            if fallen or smaller or size < 1e-9:
                break
            size *= 0.5
        unknown = unknown + size * step
        potential, residual, tangent, forces = trial
    if np.abs(residual).max() <= 1e-6 * total:
        return Shares(forces, float(unknown[0]), unknown[1:] if moving else np.zeros(2))
    raise ConvergenceError(
        f"the planets do not come into balance: {plain(np.abs(residual).max(), 3)} N of {plain(total, 3)} N are left "
        f"after {MOST_STEPS} steps"
    )


def directions_of(angles: Sequence[float], pressure_angle: float, sun_drives: bool) -> Array:
    """n_i of planets at angles [rad] on the carrier, (planets, 2): cos(alpha) tangentially, sin(alpha) outwards."""
    psi = np.asarray(angles)
    radial = np.stack([np.cos(psi), np.sin(psi)], axis=-1)
    tangential = np.stack([-np.sin(psi), np.cos(psi)], axis=-1)
    along = np.cos(pressure_angle) if sun_drives else -np.cos(pressure_angle)
    return np.asarray(along * tangential + np.sin(pressure_angle) * radial)


def pin_errors(tangential: Array, radial: Array, pressure_angles: tuple[float, float], sun_drives: bool) -> Array:
    """e_i [mm]: what displaced pins (planets,) [mm] take away from the approach at sun and ring together.

    Parameters
    ----------
    tangential, radial : (planets,) array [mm]
        In the sense of rotation of the sun, and outwards.
    pressure_angles : (float, float) [rad]
        Working ones of the sun's and the ring's mesh.
    sun_drives : bool
    """
    of_sun, of_ring = pressure_angles
    along = np.cos(of_sun) + np.cos(of_ring)
    return np.asarray((along if sun_drives else -along) * tangential + (np.sin(of_sun) - np.sin(of_ring)) * radial)
