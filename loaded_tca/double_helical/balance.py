r"""Balance of both halves of a double helical pair: one more unknown than a pair has, the axial position of a gear.

The force F_h of half h acts along the line of action in the transverse section, and +-F_h tan(beta_b) along the axis.
Under it the flanks of the half give way by D_h(F_h). Both halves turn together, and a motion r of the wheel along the
axis parts the flanks of one half by as much as it brings those of the other together:

.. math:: x = D_a(F_a) + e_a + \kappa r = D_b(F_b) + e_b - \kappa r, \qquad F_a + F_b = F, \quad
          \kappa (F_a - F_b) = K r

with e_h by which the flanks stand apart, kappa = +-tan(beta_b), and K of the axial support of the gear that floats:
r = 0 where none does, F_a = F_b where nothing holds it. A half that is not reached carries nothing. With r left out F_a
is the root of one rising function.

Shafts that both halves load couple them: the flanks of each give way by c more under a unit force on the other,

.. math:: x = D_a(F_a) + c F_b + e_a + \kappa r = D_b(F_b) + c F_a + e_b - \kappa r
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from loaded_tca.arrays import Array, Indices
from loaded_tca.errors import InputError, require
from loaded_tca.plain import plain
from loaded_tca.roots import find_roots

CLOSE = 1e-14
"""Of forces, over the whole force: how far from the root the search ends."""


@dataclass(frozen=True, eq=False)
class HalfLaw:
    """How far the flanks of a half give way under forces, at each position.

    Attributes
    ----------
    force : (k,) array [N]
        Along the line of action in the transverse section, rising, above 0.
    deflection : (k, n) array [mm]
        Under each force at n positions, from where unmodified flanks touch.
    compliance : (k, n) array [mm/N]
        Its slope.
    unloaded : (n,) array [mm]
        Without load.
    """

    force: Array
    deflection: Array
    compliance: Array
    unloaded: Array

    def __post_init__(self) -> None:
        rising = bool((np.diff(self.force) > 0.0).all()) and self.force[0] > 0.0
        require((rising, f"force: {self.force[:4]} N does not rise from above 0"))
        grows = bool((self.compliance > 0.0).all()) and bool((self.deflection[0] > self.unloaded).all())
        require((grows, "deflection: it does not grow with the force"))

    def at(self, force: Array, position: Indices) -> tuple[Array, Array, Array]:
        """Deflection [mm], compliance [mm/N] and estimated error of the deflection [mm] under forces (m,) [N].

        Cubics between the forces, of both deflections and compliances; below the first one a power of the force with
        its compliance, beyond the last one its compliance. The error is how much both compliances disagree with the
        deflections between.

        Parameters
        ----------
        force : (m,) array [N]
        position : (m,) array of int
            Index of the position of each force.
        """
        place = np.searchsorted(self.force, force)
        low, high = np.clip(place - 1, 0, None), np.clip(place, None, len(self.force) - 1)
        start, end = self.deflection[low, position], self.deflection[high, position]
        rise, fall = self.compliance[low, position], self.compliance[high, position]
        width = self.force[high] - self.force[low]
        part = np.divide(force - self.force[low], width, out=np.zeros_like(force), where=width > 0.0)
        first, last, whole = width * rise, width * fall, end - start
        bend, twist = first - whole, first + last - 2.0 * whole
        deflection = start + part * (whole + (1.0 - part) * (bend - part * twist))
        slope = np.divide(
            whole + (1.0 - 2.0 * part) * bend - part * (2.0 - 3.0 * part) * twist,
            width,
            out=rise.copy(),
            where=width > 0.0,
        )
        error = np.abs(twist) * (part * (1.0 - part)) ** 2
        return self._outside(force, position, place, (deflection, slope, error))

    def _outside(
        self, force: Array, position: Indices, place: Indices, inside: tuple[Array, Array, Array]
    ) -> tuple[Array, Array, Array]:
        """The same below the first force and beyond the last one."""
        deflection, slope, error = inside
        below, beyond = (place == 0) & (force < self.force[0]), place == len(self.force)
        first, at = self.force[0], position[below]
        part, whole = force[below] / first, self.deflection[0, at] - self.unloaded[at]
        power = np.clip(first * self.compliance[0, at] / whole, 0.1, 1.0)
        deflection[below] = self.unloaded[at] + whole * part**power
        slope[below] = whole * power / first * np.maximum(part, CLOSE) ** (power - 1.0)
        error[below] = whole * np.abs(part**power - part ** (0.5 * (1.0 + power)))
        farther, end = force[beyond] - self.force[-1], position[beyond]
        deflection[beyond] = self.deflection[-1, end] + self.compliance[-1, end] * farther
        slope[beyond] = self.compliance[-1, end]
        error[beyond] = 0.5 * self.compliance[-1, end] * farther**2 / self.force[-1]
        return deflection, slope, error


@dataclass(frozen=True, eq=False)
class Halves:
    """Both halves, and how the gears stand along the axes.

    Attributes
    ----------
    laws : (HalfLaw, HalfLaw)
    parted : (float, float), or two arrays (n,) [mm]
        e_a, e_b: how far their flanks stand apart along the line of action beside what the laws have.
    axial_rate : float
        kappa: by how much flanks of half a part where the wheel moves towards it.
    stiffness : float [N/mm]
        K of the axial support of the gear that floats; 0: nothing holds it, inf: none floats.
    coupling : float, or (n,) array [mm/N]
        c: how far the flanks of each half give way under a unit force on the other, by shafts.
    """

    laws: tuple[HalfLaw, HalfLaw]
    parted: tuple[float | Array, float | Array]
    axial_rate: float
    stiffness: float
    coupling: float | Array = 0.0

    def __post_init__(self) -> None:
        require((self.stiffness >= 0.0, f"stiffness: found {plain(self.stiffness, 6)} N/mm; allowed from 0 on"))
        if self.stiffness == 0.0 and self.axial_rate == 0.0:
            raise InputError("axial_rate: found 0; allowed other values than 0 if nothing holds the floating gear")


class Shares(NamedTuple):
    """Balance of both halves under torques at positions.

    Attributes
    ----------
    force : (torques, positions, 2) array [N]
        Of each half, along the line of action.
    approach : (torques, positions) array [mm]
        x: by how much the driven gear stands behind at the base circle.
    compliance : (torques, positions) array [mm/N]
        Its slope over the whole force.
    motion : (torques, positions) array [mm]
        r: of the wheel towards half a, against the pinion.
    error : (torques, positions) array
        Estimated error of a share of the force, by the deflections between forces that were analysed.
    approach_error : (torques, positions) array
        The same of the approach, over the force times the compliance.
    """

    force: Array
    approach: Array
    compliance: Array
    motion: Array
    error: Array
    approach_error: Array


def shared(halves: Halves, total: Array) -> Shares:
    """Forces of both halves in balance.

    Parameters
    ----------
    halves : Halves
    total : (t,) array [N]
        Whole forces, above 0.

    Returns
    -------
    Shares

    Examples
    --------
    Two halves of 1 N/um each, of which one stands 0.1 mm behind: it carries 50 N less than the even share.

    >>> half = HalfLaw(np.array([1000.0]), np.array([[1.0]]), np.array([[1e-3]]), np.zeros(1))
    >>> held = Halves((half, half), (0.1, 0.0), 0.5, np.inf)
    >>> shared(held, np.array([1000.0])).force.round(9).tolist()
    [[[450.0, 550.0]]]
    >>> floating = Halves((half, half), (0.1, 0.0), 0.5, 0.0)
    >>> balanced = shared(floating, np.array([1000.0]))
    >>> balanced.force.tolist(), balanced.motion.round(9).tolist()
    ([[[500.0, 500.0]]], [[-0.1]])
    """
    count = halves.laws[0].deflection.shape[1]
    whole = np.repeat(np.asarray(total, dtype=float), count)
    position = np.tile(np.arange(count), len(total))
    rate, stiffness = halves.axial_rate, halves.stiffness
    parted = [np.broadcast_to(part, count)[position] for part in halves.parted]
    coupling = np.broadcast_to(halves.coupling, count)[position]
    apart = parted[0] - parted[1]
    yields = (2.0 * rate**2 / stiffness if stiffness > 0.0 else 0.0) - coupling  # the first part 0 where none floats

    def difference(force: Array, rows: Indices) -> Array:
        first = halves.laws[0].at(force, position[rows])[0]
        second = halves.laws[1].at(whole[rows] - force, position[rows])[0]
        return first - second + apart[rows] + yields[rows] * (2.0 * force - whole[rows])

    first = 0.5 * whole if stiffness == 0.0 else _root(difference, whole)
    forces = np.stack([first, whole - first])
    at = [law.at(force, position) for law, force in zip(halves.laws, forces, strict=True)]
    if stiffness == 0.0:
        motion = -0.5 * difference(first, np.arange(len(whole))) / rate
    else:
        motion = rate * (forces[0] - forces[1]) / stiffness
    ways = [
        deflection + part + coupling * other
        for (deflection, _, _), part, other in zip(at, parted, forces[::-1], strict=True)
    ]
    approach = np.where(forces[0] > 0.0, ways[0] + rate * motion, ways[1] - rate * motion)
    compliance = _compliance([slope for _, slope, _ in at], forces, coupling, rate, stiffness)
    errors = _errors(at, forces, yields, stiffness)
    of_share, of_approach = errors[0] / whole, errors[1] / (compliance * whole)
    shape = len(total), count
    by_position = (each.reshape(shape) for each in (approach, compliance, motion, of_share, of_approach))
    return Shares(np.moveaxis(forces, 0, -1).reshape(*shape, 2), *by_position)


def _root(difference: Callable[[Array, Indices], Array], whole: Array) -> Array:
    """Force of half a (m,), by bisection of both ends and the even share, which is the root of equal halves."""
    rows, even = np.arange(len(whole)), 0.5 * whole
    at_even = difference(even, rows)
    ends = np.where(at_even > 0.0, 0.0, whole)
    at_ends = difference(ends, rows)
    parts = find_roots(
        lambda part, some: difference(part * whole[some], rows[some]),
        np.stack([np.full_like(whole, 0.5), ends / whole]),
        np.stack([at_even, at_ends]),
        CLOSE,
    )
    return np.where(at_even == 0.0, even, parts * whole)


def _compliance(slopes: list[Array], forces: Array, coupling: Array, rate: float, stiffness: float) -> Array:
    """Slope of the approach over the whole force."""
    if stiffness == 0.0:
        return np.asarray(0.25 * (slopes[0] + slopes[1]) + 0.5 * coupling)
    given = rate**2 / stiffness
    a, b = (slope + given for slope in slopes)
    between = given - coupling
    both = (a * b - between**2) / (a + b + 2.0 * between)
    alone = np.where(forces[0] > 0.0, a, b)
    return np.where((forces > 0.0).all(axis=0), both, alone)


def _errors(
    at: list[tuple[Array, Array, Array]], forces: Array, yields: Array, stiffness: float
) -> tuple[Array, Array]:
    """Errors of the force of a half [N] and of the approach [mm] by those of both deflections.

    Forces of a gear that floats freely have none; the approach follows the deflection of a half that carries all.
    """
    (_, slope_a, error_a), (_, slope_b, error_b) = at
    if stiffness == 0.0:
        return np.zeros_like(error_a), 0.5 * (error_a + error_b)
    a, b = slope_a + yields, slope_b + yields
    both = (error_a * b + error_b * a) / (a + b)
    alone = np.where(forces[0] > 0.0, error_a, error_b)
    return (error_a + error_b) / (a + b), np.where((forces > 0.0).all(axis=0), both, alone)
