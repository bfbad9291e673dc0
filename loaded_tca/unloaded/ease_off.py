r"""The rotary ease-off: the angle at which the mate must stand to pass through a point of the pinion flank.

Turn the pinion by phi1 and take the point P = (rho, z) of its flank. The wheel's flank passes through P at

.. math:: \varphi_2 = \sigma\,[\Theta_2(\rho_2, z_2) - \theta_2], \qquad (\rho_2, \theta_2, z_2) = P
          \text{ in the wheel frame},

sigma the sense of rotation. The flanks touch first where phi2 is largest (pinion driving) or smallest (wheel
driving), so the field used throughout is the **ease-off**

.. math:: e = \pm (\varphi_2 - \varphi_1 z_1/z_2)\, r_{b2} \quad [\mathrm{mm}],

whose maximum over the region that both flanks cover is the contact point, and whose drop below the maximum is, to
first order and along the line of action in the transverse section, the gap. It needs no common apex, no arccosine
and no parameter of the second flank. (Seed of the idea: the elimination of three of the five contact equations;
here the remaining two are the gradient of one scalar.)
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from loaded_tca.flanks.jet import Array, Jet, weighted_sum
from loaded_tca.pair import GearPair, cylindrical_basis

PARTS = ((0, 0), (0, 1), (1, 1))
"""Order in which the three second derivatives with respect to (rho, z) are kept."""


@dataclass(frozen=True, eq=False)
class Station:
    """Points of the pinion flank, seen from both gears; the carrier of every chain rule.

    Attributes
    ----------
    rho, z : (...) array [mm]
        On the pinion flank.
    point : (..., 3) array [mm]
        In the fixed frame.
    tangents : (..., 2, 3) array
        dP/d rho and dP/d z in the fixed frame.
    second : (..., 3, 3) array
        Second derivatives of P in the order rho rho, rho z, z z, in the fixed frame.
    wheel_rho, wheel_theta, wheel_z : (...) array
        The points in the wheel frame [mm, rad, mm].
    wheel_basis : (..., 3, 3) array
        e_rho, e_theta, e_z of the wheel at the points, in rows, in the fixed frame.
    """

    rho: Array
    z: Array
    point: Array
    tangents: Array
    second: Array
    wheel_rho: Array
    wheel_theta: Array
    wheel_z: Array
    wheel_basis: Array

    def gradient(self, jet: Jet, turn: float = 0.0) -> Array:
        """d/d(rho, z) of ``jet(rho2, z2) + turn * theta2``: (..., 2)."""
        tangents = self.tangents @ np.swapaxes(self.wheel_basis, -1, -2)
        return _combine(tangents, jet, turn, self.wheel_rho)

    def hessian(self, jet: Jet, turn: float = 0.0) -> Array:
        """Second derivatives of the same function: (..., 2, 2)."""
        to_wheel = np.swapaxes(self.wheel_basis, -1, -2)
        tangents, second = self.tangents @ to_wheel, self.second @ to_wheel
        bent = tangents @ _cylindrical_hessian(jet, turn, self.wheel_rho) @ np.swapaxes(tangents, -1, -2)
        drift = _combine(second, jet, turn, self.wheel_rho)
        for k, (i, j) in enumerate(PARTS):
            bent[..., i, j] += drift[..., k]
        bent[..., 1, 0] = bent[..., 0, 1]
        return bent


def _combine(vectors: Array, jet: Jet, turn: float, radius: Array) -> Array:
    """Vectors (..., k, 3) in the wheel's basis dotted with the gradient of jet + turn theta: (..., k)."""
    parts = [jet.rho, turn / radius, jet.z]
    return sum(vectors[..., k] * np.asarray(part)[..., None] for k, part in enumerate(parts))


def _cylindrical_hessian(jet: Jet, turn: float, radius: Array) -> Array:
    """Hessian of jet(rho, z) + turn theta in the orthonormal cylindrical basis: (..., 3, 3)."""
    hessian = np.zeros((*np.shape(radius), 3, 3))
    hessian[..., 0, 0] = jet.rho_rho
    hessian[..., 1, 1] = jet.rho / radius
    hessian[..., 2, 2] = jet.z_z
    hessian[..., 0, 1] = hessian[..., 1, 0] = -turn / radius**2
    hessian[..., 0, 2] = hessian[..., 2, 0] = jet.rho_z
    return hessian


class EaseOff:
    """The ease-off field of a pair over its pinion flank, with the borders and creases of both flanks.

    Parameters
    ----------
    pair : GearPair
    beyond : (..., creases) bool array, optional
        The side of each crease (the pinion's first, then the wheel's) whose smooth continuation is taken; None: the
        side on which a point lies. Its shape broadcasts against the points.
    """

    def __init__(self, pair: GearPair, beyond: Array | None = None) -> None:
        self.pair, self.beyond = pair, beyond
        probe = [np.atleast_1d(part)[:1] for part in pair.pinion.grid(2, 2)]
        self._pinion_creases = len(pair.pinion.creases(probe[0].ravel(), probe[1].ravel()))
        wheel_probe = [part.ravel() for part in pair.wheel.grid(2, 2)]
        self._wheel_creases = len(pair.wheel.creases(*wheel_probe))

    @property
    def creases(self) -> int:
        """Number of creases of both flanks."""
        return self._pinion_creases + self._wheel_creases

    def sides(self, phi1: Array, rho: Array, z: Array) -> Array:
        """On which side of each crease the points (n,) lie: (n, creases) bool, the pinion's creases first."""
        station = self.station(phi1, rho, z)
        own = self.pair.pinion.creases(station.rho, station.z)
        other = self.pair.wheel.creases(station.wheel_rho, station.wheel_z)
        sides = [np.broadcast_to(jet.value > 0.0, rho.shape) for jet in (*own, *other)]
        return np.stack(sides, axis=-1) if sides else np.zeros((*rho.shape, 0), dtype=bool)

    def restricted(self, rows: Any) -> EaseOff:
        """The same field with the crease sides of some rows only."""
        return self if self.beyond is None else EaseOff(self.pair, self.beyond[rows])

    def station(self, phi1: Array, rho: Array, z: Array) -> Station:
        """Points (rho, z) of the pinion flank at the pinion angle phi1 [rad], arrays of one shape."""
        jet = self.pair.pinion.theta(rho, z, self._sides(0))
        basis = cylindrical_basis(jet.value + self.pair.sense * phi1)
        radial, around, axial = basis[..., 0, :], basis[..., 1, :], basis[..., 2, :]

        def along(across: Any, out: Any) -> Array:
            return np.asarray(across)[..., None] * around + np.asarray(out)[..., None] * radial

        point = rho[..., None] * radial + z[..., None] * axial
        tangents = np.stack([radial + along(rho * jet.rho, 0.0), axial + along(rho * jet.z, 0.0)], axis=-2)
        second = [
            along(2.0 * jet.rho + rho * jet.rho_rho, -rho * jet.rho**2),
            along(jet.z + rho * jet.rho_z, -rho * jet.rho * jet.z),
            along(rho * jet.z_z, -rho * jet.z**2),
        ]
        wheel_rho, wheel_theta, wheel_z = self.pair.to_wheel(point)
        wheel_basis = self.pair.wheel_basis(wheel_theta)
        return Station(rho, z, point, tangents, np.stack(second, axis=-2), wheel_rho, wheel_theta, wheel_z, wheel_basis)

    def heights(self, phi1: Array, rho: Array, z: Array) -> tuple[Array, Array]:
        """Ease-off (...) [mm] and distances to the borders (..., k) [mm], without derivatives."""
        theta = self.pair.pinion.theta(rho, z, self._sides(0)).value + self.pair.sense * phi1
        point = np.stack([rho * np.cos(theta), rho * np.sin(theta), np.broadcast_to(z, theta.shape)], axis=-1)
        wheel_rho, wheel_theta, wheel_z = self.pair.to_wheel(point)
        mate = self.pair.wheel.theta(wheel_rho, wheel_z, self._sides(1)).value
        value = self._scale * (mate - wheel_theta) - self._mean_motion * phi1
        pinion, wheel = self._border_jets(rho, z, wheel_rho, wheel_z)
        return value, np.stack(np.broadcast_arrays(*[jet.value for jet in (*pinion, *wheel)]), axis=-1)

    def wheel_angle(self, station: Station) -> Array:
        """phi2 at which the wheel's flank passes through the points [rad]."""
        return self.pair.sense * (self._wheel_theta(station).value - station.wheel_theta)

    def value(self, station: Station, phi1: Array) -> Array:
        """Ease-off e [mm], largest where the flanks touch first."""
        lag = self._wheel_theta(station).value - station.wheel_theta
        return self._scale * lag - self._mean_motion * phi1

    def gradient(self, station: Station) -> Array:
        """de/d(rho, z): (..., 2) [1]."""
        return self._scale * station.gradient(self._wheel_theta(station), -1.0)

    def hessian(self, station: Station) -> Array:
        """Second derivatives of e: (..., 2, 2) [1/mm]."""
        return self._scale * station.hessian(self._wheel_theta(station), -1.0)

    def borders(self, station: Station) -> tuple[Array, Array]:
        """Distances to the borders and creases [mm], positive inside, (..., k), and their gradients (..., k, 2).

        Order: the pinion's four borders and its creases, then the wheel's (creases only if the field was given
        the sides to stay on).
        """
        pinion, wheel = self._border_jets(station.rho, station.z, station.wheel_rho, station.wheel_z)
        values = [jet.value for jet in (*pinion, *wheel)]
        gradients = [_own_gradient(jet, station.rho) for jet in pinion] + [station.gradient(jet) for jet in wheel]
        return np.stack(values, axis=-1), np.stack(gradients, axis=-2)

    def border_normal(self, station: Station, border: int) -> Array:
        """Gradient of one border in space, (..., 3), in the fixed frame: normal to the surface it ends on."""
        jets = self._border_jets(station.rho, station.z, station.wheel_rho, station.wheel_z)
        own = int(self.border_owner()[border])
        jet = [*jets[0], *jets[1]][border]
        parts = np.stack(np.broadcast_arrays(jet.rho, 0.0, jet.z, station.rho)[:3], axis=-1)
        azimuth = np.arctan2(station.point[..., 1], station.point[..., 0])
        basis = station.wheel_basis if own else cylindrical_basis(azimuth)
        return np.einsum("...k,...kj->...j", parts, basis)

    def border_hessian(self, station: Station, weights: Array) -> Array:
        """Sum of weights[..., k] times the Hessian of border k: (..., 2, 2)."""
        pinion, wheel = self._border_jets(station.rho, station.z, station.wheel_rho, station.wheel_z)
        own = weighted_sum(pinion, weights)
        total = station.hessian(weighted_sum(wheel, weights[..., len(pinion) :]))
        for part, (i, j) in zip((own.rho_rho, own.rho_z, own.z_z), PARTS, strict=True):
            total[..., i, j] += part
        total[..., 1, 0] = total[..., 0, 1]
        return total

    def border_owner(self) -> Array:
        """0 for a border of the pinion, 1 for one of the wheel, in the order of ``borders``."""
        extra = (self._pinion_creases, self._wheel_creases) if self.beyond is not None else (0, 0)
        return np.repeat([0, 1], [4 + extra[0], 4 + extra[1]])

    def border_is_crease(self) -> Array:
        """Whether each entry of ``borders`` is a crease."""
        extra = (self._pinion_creases, self._wheel_creases) if self.beyond is not None else (0, 0)
        return np.concatenate([np.arange(4 + count) >= 4 for count in extra])

    @property
    def _scale(self) -> float:
        return float(self.pair.driving * self.pair.base_radii[1] * self.pair.sense)

    @property
    def _mean_motion(self) -> float:
        return self.pair.driving * self.pair.base_radii[1] * self.pair.ratio

    def _wheel_theta(self, station: Station) -> Jet:
        return self.pair.wheel.theta(station.wheel_rho, station.wheel_z, self._sides(1))

    def _sides(self, member: int) -> Any:
        if self.beyond is None:
            return None
        return self.beyond[..., : self._pinion_creases] if member == 0 else self.beyond[..., self._pinion_creases :]

    def _border_jets(self, rho: Array, z: Array, wheel_rho: Array, wheel_z: Array) -> tuple[list[Jet], list[Jet]]:
        pair = self.pair
        pinion = [*pair.pinion.borders(rho, z)]
        wheel = [*pair.wheel.borders(wheel_rho, wheel_z)]
        if self.beyond is not None:
            signs = np.where(self.beyond, 1.0, -1.0)
            own = pair.pinion.creases(rho, z)
            other = pair.wheel.creases(wheel_rho, wheel_z)
            pinion += [jet * signs[..., k] for k, jet in enumerate(own)]
            wheel += [jet * signs[..., len(own) + k] for k, jet in enumerate(other)]
        return pinion, wheel


def _own_gradient(jet: Jet, like: Array) -> Array:
    return np.stack(np.broadcast_arrays(jet.rho, jet.z, like)[:2], axis=-1)
