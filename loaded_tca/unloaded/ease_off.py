r"""The rotary ease-off: the angle at which the mating gear must stand to pass through a point of the pinion flank.

Turn the pinion by phi1 and take the point P = (rho, z) of its flank. The wheel's flank passes through P at

.. math:: \varphi_2 = \sigma\,[\Theta_2(\rho_2, z_2) - \theta_2], \qquad (\rho_2, \theta_2, z_2) = P
          \text{ in the wheel frame},

sigma the sense of rotation. The flanks touch first where phi2 is largest (pinion driving) or smallest (wheel
driving), so the field used throughout is the **ease-off**

.. math:: e = \pm (\varphi_2 - \varphi_1 z_1/z_2)\, r_{b2} \quad [\mathrm{mm}],

whose maximum over the region that both flanks cover is the contact point, and whose drop below the maximum is, to
first order and along the line of action in the transverse section, the gap. It needs no common apex, no arccosine
and no parameter of the second flank. (The idea comes from the elimination of three of the five contact equations;
here the remaining two are the gradient of one scalar.)
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, Mask
from loaded_tca.flanks.base import Jet, weighted_sum
from loaded_tca.pairs.gear_pair import GearPair, cylindrical_basis

FULL_TURN = 2.0 * math.pi
PARTS = ((0, 0), (0, 1), (1, 1))
"""Order in which the three second derivatives with respect to (rho, z) are kept."""


@dataclass(frozen=True, eq=False)
class Station:
    """Points of the pinion flank, seen from both gears; the carrier of every chain rule.

    Attributes
    ----------
    pair : GearPair
    rho, z : (...) array [mm]
        On the pinion flank.
    point : (..., 3) array [mm]
        In the fixed frame.
    wheel_rho, wheel_theta, wheel_z : (...) array
        The points in the wheel frame [mm, rad, mm].
    wheel : Jet
        Theta2 at (wheel_rho, wheel_z).
    slopes : (3, 2, ...) array
        dP/d rho and dP/d z, components along e_rho, e_theta, e_z of the wheel at the points first.
    bends : (3, 3, ...) array
        Second derivatives of P in the order rho rho, rho z, z z, in the same basis.
    """

    pair: GearPair
    rho: Array
    z: Array
    point: Array
    wheel_rho: Array
    wheel_theta: Array
    wheel_z: Array
    wheel: Jet
    slopes: Array
    bends: Array

    @property
    def wheel_basis(self) -> Array:
        """e_rho, e_theta, e_z of the wheel at the points, in rows, in the fixed frame: (..., 3, 3)."""
        return self.pair.wheel_basis(self.wheel_theta)

    @property
    def tangents(self) -> Array:
        """dP/d rho and dP/d z in the fixed frame: (..., 2, 3)."""
        return np.einsum("ik...,...ij->...kj", self.slopes, self.wheel_basis)

    def gradient(self, jet: Jet, turn: float = 0.0) -> Array:
        """d/d(rho, z) of ``jet(rho2, z2) + turn * theta2``: (..., 2)."""
        return np.moveaxis(_dot(self._slope(jet, turn), self.slopes), 0, -1)

    def hessian(self, jet: Jet, turn: float = 0.0) -> Array:
        """Second derivatives of the same function: (..., 2, 2)."""
        twist = -turn / self.wheel_rho**2 if turn else 0.0
        rows = (
            (jet.rho_rho, twist, jet.rho_z),
            (twist, jet.rho / self.wheel_rho, 0.0),
            (jet.rho_z, 0.0, jet.z_z),
        )
        bent = [_dot(row, self.slopes) for row in rows]
        drift = _dot(self._slope(jet, turn), self.bends)
        hessian = np.empty((2, 2, *np.shape(self.rho)))
        for k, (i, j) in enumerate(PARTS):
            hessian[i, j] = drift[k] + _dot([part[j] for part in bent], self.slopes[:, i])
        hessian[1, 0] = hessian[0, 1]
        return np.moveaxis(hessian, (0, 1), (-2, -1))

    def _slope(self, jet: Jet, turn: float) -> tuple[Any, Any, Any]:
        """Gradient of jet + turn theta in the wheel's cylindrical basis."""
        return jet.rho, turn / self.wheel_rho if turn else 0.0, jet.z


def _dot(parts: Sequence[Any], vectors: Array, out: Array | None = None) -> Array:
    """Sum of parts[i] * vectors[i]; a part that is the number zero costs nothing."""
    total = np.empty(vectors.shape[1:]) if out is None else out
    total[...] = 0.0
    for part, vector in zip(parts, vectors, strict=True):
        if np.ndim(part) or part:
            total += part * vector
    return total


@checked
class EaseOff:
    """The ease-off field of a pair over its pinion flank, with the edges and relief starts of both flanks.

    Parameters
    ----------
    pair : GearPair
    beyond : (..., relief starts) bool array, optional
        The side of each relief start (the pinion's first, then the wheel's) whose smooth continuation is taken; None:
        the side on which a point lies. Its shape broadcasts against the points.
    """

    def __init__(self, pair: GearPair, beyond: Mask | None = None) -> None:
        self.pair = pair
        self.beyond = beyond if beyond is not None and beyond.shape[-1] else None

    @cached_property
    def _relief_starts(self) -> tuple[int, int]:
        """Relief starts of each flank whose sides were given."""
        if self.beyond is None:
            return 0, 0
        flank = self.pair.pinion.flank
        of_pinion = len(flank.relief_starts(*flank.grid(2, 2)))
        return of_pinion, self.beyond.shape[-1] - of_pinion

    def sides(self, phi1: Array, rho: Array, z: Array) -> Mask:
        """On which side of each relief start the points (n,) lie: (n, relief starts) bool, the pinion's first."""
        station = self.station(phi1, rho, z)
        of_pinion = self.pair.pinion.flank.relief_starts(station.rho, station.z)
        other = self.pair.wheel.flank.relief_starts(station.wheel_rho, station.wheel_z)
        sides = [np.broadcast_to(jet.value > 0.0, rho.shape) for jet in (*of_pinion, *other)]
        return np.stack(sides, axis=-1) if sides else np.zeros((*rho.shape, 0), dtype=bool)

    def restricted(self, rows: Any) -> EaseOff:
        """The same field with the relief start sides of some rows only."""
        return self if self.beyond is None else EaseOff(self.pair, self.beyond[rows])

    def station(self, phi1: Array, rho: Array, z: Array) -> Station:
        """Points (rho, z) of the pinion flank at the pinion angle phi1 [rad], arrays of one shape."""
        jet = self.pair.pinion.flank.theta(rho, z, self._sides(0))
        azimuth = jet.value + self.pair.sense * phi1
        point = _on_circle(rho, azimuth, z)
        wheel_rho, wheel_theta, wheel_z = self.pair.to_wheel(point)
        wheel = self.pair.wheel.flank.theta(wheel_rho, wheel_z, self._sides(1))
        radial, around, axial = _pinion_basis(self.pair.wheel_axes, azimuth, wheel_theta)
        along, across = rho * jet.rho, rho * jet.z
        slopes = np.stack([radial + along * around, axial + across * around], axis=1)
        bends = np.stack(
            [
                (2.0 * jet.rho + rho * jet.rho_rho) * around - (along * jet.rho) * radial,
                (jet.z + rho * jet.rho_z) * around - (along * jet.z) * radial,
                (rho * jet.z_z) * around - (across * jet.z) * radial,
            ],
            axis=1,
        )
        return Station(self.pair, rho, z, point, wheel_rho, wheel_theta, wheel_z, wheel, slopes, bends)

    def heights(self, phi1: Array, rho: Array, z: Array) -> tuple[Array, Array]:
        """Ease-off (...) [mm] and distances to the edges (..., k) [mm], without derivatives."""
        azimuth = self.pair.pinion.flank.theta(rho, z, self._sides(0)).value + self.pair.sense * phi1
        wheel_rho, wheel_theta, wheel_z = self.pair.to_wheel(_on_circle(rho, azimuth, z))
        mating = self.pair.wheel.flank.theta(wheel_rho, wheel_z, self._sides(1)).value
        value = self._lead(mating - wheel_theta, phi1)
        pinion, wheel = self._edge_jets(rho, z, wheel_rho, wheel_z)
        return value, _last_axis([jet.value for jet in (*pinion, *wheel)], value.shape)

    def value(self, station: Station, phi1: Array) -> Array:
        """Ease-off e [mm], largest where the flanks touch first."""
        return self._lead(station.wheel.value - station.wheel_theta, phi1)

    def gradient(self, station: Station) -> Array:
        """de/d(rho, z): (..., 2) [1]."""
        return self._scale * station.gradient(station.wheel, -1.0)

    def hessian(self, station: Station) -> Array:
        """Second derivatives of e: (..., 2, 2) [1/mm]."""
        return self._scale * station.hessian(station.wheel, -1.0)

    def edges(self, station: Station) -> tuple[Array, Array]:
        """Distances to the edges and relief starts [mm], positive inside, (..., k), and their gradients (..., k, 2).

        Order: the pinion's four edges and its relief starts, then the wheel's (relief starts only if the field was
        given the sides to stay on).
        """
        pinion, wheel = self._edge_jets(station.rho, station.z, station.wheel_rho, station.wheel_z)
        values = [jet.value for jet in (*pinion, *wheel)]
        slopes = np.empty((2, len(values), *np.shape(station.rho)))
        for k, jet in enumerate(pinion):
            slopes[0, k], slopes[1, k] = jet.rho, jet.z
        for k, jet in enumerate(wheel, len(pinion)):
            _dot((jet.rho, 0.0, jet.z), station.slopes, out=slopes[:, k])
        return _last_axis(values, np.shape(station.rho)), np.moveaxis(slopes, (0, 1), (-1, -2))

    def edge_normal(self, station: Station, edge: int) -> Array:
        """Gradient of one edge in space, (..., 3), in the fixed frame: normal to the surface it ends on."""
        jets = self._edge_jets(station.rho, station.z, station.wheel_rho, station.wheel_z)
        owner = int(self.edge_owner()[edge])
        jet = [*jets[0], *jets[1]][edge]
        parts = np.stack(np.broadcast_arrays(jet.rho, 0.0, jet.z, station.rho)[:3], axis=-1)
        azimuth = np.arctan2(station.point[..., 1], station.point[..., 0])
        basis = station.wheel_basis if owner else cylindrical_basis(azimuth)
        return np.einsum("...k,...kj->...j", parts, basis)

    def edge_hessian(self, station: Station, weights: Array) -> Array:
        """Sum of weights[..., k] times the Hessian of edge k: (..., 2, 2)."""
        pinion, wheel = self._edge_jets(station.rho, station.z, station.wheel_rho, station.wheel_z)
        of_pinion = weighted_sum(pinion, weights)
        total = station.hessian(weighted_sum(wheel, weights[..., len(pinion) :]))
        for part, (i, j) in zip((of_pinion.rho_rho, of_pinion.rho_z, of_pinion.z_z), PARTS, strict=True):
            total[..., i, j] += part
        total[..., 1, 0] = total[..., 0, 1]
        return total

    def edge_owner(self) -> Array:
        """0 for an edge of the pinion, 1 for one of the wheel, in the order of ``edges``."""
        return np.repeat([0, 1], [4 + count for count in self._relief_starts])

    def edge_is_relief_start(self) -> Mask:
        """Whether each entry of ``edges`` is a relief start."""
        return np.concatenate([np.arange(4 + count) >= 4 for count in self._relief_starts])

    def _lead(self, wheel_angle: Array, phi1: Array) -> Array:
        """Ease-off [mm] of a wheel angle, without the sense of rotation, that is known up to whole turns."""
        lead = wheel_angle - (self.pair.sense * self.pair.ratio) * phi1
        return self._scale * (lead - FULL_TURN * np.round(lead / FULL_TURN))

    @property
    def _scale(self) -> float:
        return float(self.pair.driving * self.pair.base_radii[1] * self.pair.sense)

    def _sides(self, member: int) -> Any:
        if self.beyond is None:
            return None
        of_pinion = self._relief_starts[0]
        return self.beyond[..., of_pinion:] if member else self.beyond[..., :of_pinion]

    def _edge_jets(self, rho: Array, z: Array, wheel_rho: Array, wheel_z: Array) -> tuple[list[Jet], list[Jet]]:
        pinion_flank, wheel_flank = self.pair.pinion.flank, self.pair.wheel.flank
        pinion, wheel = [*pinion_flank.edges(rho, z)], [*wheel_flank.edges(wheel_rho, wheel_z)]
        if self.beyond is not None:
            signs = np.where(self.beyond, 1.0, -1.0)
            of_pinion, other = pinion_flank.relief_starts(rho, z), wheel_flank.relief_starts(wheel_rho, wheel_z)
            pinion += [jet * signs[..., k] for k, jet in enumerate(of_pinion)]
            wheel += [jet * signs[..., len(of_pinion) + k] for k, jet in enumerate(other)]
        return pinion, wheel


def _pinion_basis(axes: Array, azimuth: Array, wheel_theta: Array) -> Array:
    """e_rho, e_theta, e_z of the pinion at an azimuth, in the wheel's cylindrical basis: (3 of them, 3 parts, ...)."""
    cosine, sine = np.cos(azimuth), np.sin(azimuth)
    basis, fixed = np.empty((3, 3, *azimuth.shape)), np.moveaxis(axes, (-2, -1), (0, 1))
    for i in range(3):
        basis[0, i] = fixed[i, 0] * cosine + fixed[i, 1] * sine
        basis[1, i] = fixed[i, 1] * cosine - fixed[i, 0] * sine
        basis[2, i] = fixed[i, 2]
    cosine, sine = np.cos(wheel_theta), np.sin(wheel_theta)
    radial = cosine * basis[:, 0] + sine * basis[:, 1]
    basis[:, 1] = cosine * basis[:, 1] - sine * basis[:, 0]
    basis[:, 0] = radial
    return basis


def _on_circle(rho: Array, azimuth: Array, z: Array) -> Array:
    """Cartesian points (..., 3), kept one component after the other."""
    point = np.empty((3, *np.shape(azimuth)))
    point[0], point[1], point[2] = rho * np.cos(azimuth), rho * np.sin(azimuth), z
    return np.moveaxis(point, 0, -1)


def _last_axis(values: Sequence[Array], shape: tuple[int, ...]) -> Array:
    """Values stacked along a last axis that varies slowest in memory: sums and minima over it are quick."""
    stacked = np.empty((len(values), *shape))
    for k, value in enumerate(values):
        stacked[k] = value
    return np.moveaxis(stacked, 0, -1)
