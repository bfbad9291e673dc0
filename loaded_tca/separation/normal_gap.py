"""The gap of two flanks along the common normal of their contact, at points of the tangent plane.

Each flank is met on its own, in its gear's frame, by Newton's method along the normal: theta of the point less Theta
of the flank. Two steps are the rule: the third is known beforehand, since the steps shrink quadratically.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import reduce

import numpy as np

from loaded_tca.arrays import Array, Mask
from loaded_tca.flanks.base import Flank
from loaded_tca.pairs.gear_pair import GearPair, cylindrical_basis
from loaded_tca.unloaded import ContactPoint

STEP_ROUNDING = 1e-13
"""Newton steps shorter than this times the sum of the base radii are rounding."""
BEND = 100.0
"""Factor by which the bend of a flank along the normal may differ from place to place."""
NO_MORE = 1e3
"""Steps shorter than this times rounding are the last: the next one shrinks quadratically."""
STEPS_TOGETHER = 4
"""Newton steps of all points; those that need more, near or beyond the end of an involute, go on alone from where
they meet the other flank, for as many again, as long as the steps shrink to less than half."""
FLATTEST = 1e-6
"""Change of theta along the normal, times the sum of the base radii, below which a flank bends away from it."""
ON_EDGE = 1e-9
"""Distance from an edge, over the module, up to which a flank has not ended."""


@dataclass(frozen=True, eq=False)
class _Rays:
    """Rays along the normal, in the frame of one gear turned back by ``turn``: start (3 of (...)), normal (3,)."""

    flank: Flank
    start: tuple[Array, ...]
    normal: tuple[float, ...]
    turn: float


@dataclass(frozen=True, eq=False)
class _Meeting:
    """Where rays meet a flank: heights (...), place (rho, z), length of the last step, whether it was the last."""

    height: Array
    rho: Array
    z: Array
    step: Array
    settled: Mask


class NormalGap:
    """Distance of the two flanks of a contact along its normal, in coordinates of its tangent plane.

    Parameters
    ----------
    pair : GearPair
    contact : ContactPoint
    axes : (3, 3) array
        Rows: the directions of x and y, and the normal out of the pinion.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> from loaded_tca.unloaded import relative_curvature, trace_contact
    >>> mesh = CylindricalMesh(*(CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)))
    >>> pair = cylindrical_pair(mesh)
    >>> contact = trace_contact(pair, [0.0])[0]
    >>> gap = NormalGap(pair, contact, relative_curvature(pair, contact).axes)
    >>> [round(float(part[0]), 4) for part in gap.at(np.array([0.2]), np.array([12.0]))]
    [0.0018, 0.5]
    """

    def __init__(self, pair: GearPair, contact: ContactPoint, axes: Array) -> None:
        self.pair = pair
        in_wheel, origin = pair.wheel_axes.T, (contact.point - pair.wheel_origin) @ pair.wheel_axes.T
        self._views = (
            (pair.pinion.flank, contact.point, axes, pair.sense * contact.pinion_angle),
            (pair.wheel.flank, origin, axes @ in_wheel, -pair.sense * contact.wheel_angle),
        )
        self._size = sum(pair.base_radii)
        self._rounding = STEP_ROUNDING * self._size

    def at(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Gap [mm], and distance to the nearest edge of either flank [mm], at points that broadcast.

        The distance is negative where a flank has ended, and -inf where the normal does not meet it.
        """
        gap, distances = self.with_edges(x, y)
        return gap, reduce(np.minimum, distances)

    def with_edges(self, x: Array, y: Array) -> tuple[Array, list[Array]]:
        """Gap [mm], and distances to each edge of both flanks [mm], at points that broadcast; signed as of ``at``."""
        rays = self._rays(x, y)
        met = [self._meet(ray, np.zeros(ray.start[0].shape)) for ray in rays]
        missed = None
        if not (met[0].settled & met[1].settled).all():
            missed = np.logical_or(*(self._meet_rest(rays[own], met[own], met[1 - own]) for own in (0, 1)))
        jets = [jet for ray, one in zip(rays, met, strict=True) for jet in ray.flank.edges(one.rho, one.z)]
        distances = [jet.value + ON_EDGE * self.pair.module for jet in jets]
        if missed is not None:
            distances = [np.where(missed, -np.inf, distance) for distance in distances]
        return met[1].height - met[0].height, distances

    def curvature_across(self, x: Array, y: Array) -> Array:
        """Second derivative of the gap by x [1/mm] at points that broadcast: the relative curvature across.

        On a relief start it is that of the side on which the point lies.
        """
        bends = []
        for rays, (_, _, axes, _) in zip(self._rays(x, y), self._views, strict=True):
            met = self._meet(rays, np.zeros(rays.start[0].shape))
            at_x, at_y = (part + met.height * n for part, n in zip(rays.start[:2], rays.normal[:2], strict=True))
            basis = cylindrical_basis(np.arctan2(at_y, at_x))
            gradient, hessian = _theta_less_flank(rays.flank, met.rho, met.z)
            out = basis @ axes[2]
            steep = (gradient * out).sum(axis=-1)
            across = basis @ axes[0]
            tangent = across - ((gradient * across).sum(axis=-1) / steep)[..., None] * out
            bends.append(-np.einsum("...i,...ij,...j", tangent, hessian, tangent) / steep)
        return np.asarray(bends[1] - bends[0])

    def _rays(self, x: Array, y: Array) -> list[_Rays]:
        """Rays of pinion and wheel at points of the tangent plane."""
        rays = []
        for flank, origin, axes, turn in self._views:
            across, along, normal = axes.tolist()
            start = tuple(o + (x * a + y * b) for o, a, b in zip(origin.tolist(), across, along, strict=True))
            rays.append(_Rays(flank, start, tuple(normal), turn))
        return rays

    def _meet_rest(self, rays: _Rays, met: _Meeting, mating: _Meeting) -> Mask:
        """Take further steps as long as they shrink, where the mating gear is met; return where that is in vain."""
        room = rays.flank.room(met.rho, met.z)
        rest = np.nonzero(~met.settled & (mating.settled | (room > -2.0 * met.step)))
        missed = ~met.settled
        height, step = np.where(mating.settled, mating.height, met.height)[rest], np.full(rest[0].shape, np.inf)
        while step.size:
            late = self._meet(replace(rays, start=tuple(part[rest] for part in rays.start)), height)
            place = rays.flank.room(late.rho, late.z)
            for part, later in ((met.height, late.height), (met.rho, late.rho), (met.z, late.z)):
                part[rest] = later
            missed[rest] = ~late.settled
            on = ~late.settled & (place > -2.0 * late.step) & (late.step < 0.5 * step)
            rest, height, step = tuple(part[on] for part in rest), late.height[on], late.step[on]
        return missed

    def _meet(self, rays: _Rays, height: Array) -> _Meeting:
        """Newton steps from ``height``, until the longest is rounding or the next one would be."""
        (nx, ny, nz), longest, before = rays.normal, 0.25 * self.pair.module, 0.0
        x, y, z = (part + height * n for part, n in zip(rays.start, rays.normal, strict=True))
        for _ in range(STEPS_TOGETHER):
            square = x * x + y * y
            rho = np.sqrt(square)
            jet = rays.flank.theta(rho, z)
            outwards = (x * nx + y * ny) / rho
            slope = (x * ny - y * nx) / square - jet.rho * outwards - jet.z * nz
            slope = np.where(np.abs(slope) > FLATTEST / self._size, slope, np.inf)
            step = (jet.value + rays.turn - np.arctan2(y, x)) / slope
            length = np.abs(step)
            largest = float(length.max())
            if largest > longest:
                step = np.clip(step, -longest, longest)
            height = height + step
            x, y, z, rho = x + step * nx, y + step * ny, z + step * nz, rho + step * outwards
            if largest <= self._rounding or BEND * largest**3 <= self._rounding * before**2:
                return _Meeting(height, rho, z, length, np.ones(length.shape, dtype=bool))
            before = min(largest, longest)
        return _Meeting(height, rho, z, length, length <= NO_MORE * self._rounding)


def _theta_less_flank(flank: Flank, rho: Array, z: Array) -> tuple[Array, Array]:
    """Gradient (..., 3) and Hessian (..., 3, 3) of theta - Theta(rho, z) along e_rho, e_theta, e_z."""
    jet, shape = flank.theta(rho, z), np.shape(rho)
    gradient, hessian = np.zeros((*shape, 3)), np.zeros((*shape, 3, 3))
    gradient[..., 0], gradient[..., 1], gradient[..., 2] = -jet.rho, 1.0 / rho, -jet.z
    hessian[..., 0, 0], hessian[..., 2, 2], hessian[..., 1, 1] = -jet.rho_rho, -jet.z_z, -jet.rho / rho
    hessian[..., 0, 1] = hessian[..., 1, 0] = -1.0 / rho**2
    hessian[..., 0, 2] = hessian[..., 2, 0] = -jet.rho_z
    return gradient, hessian
