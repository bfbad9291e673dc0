"""The gap of two flanks along the common normal of their contact, at points of the tangent plane.

Each flank is met on its own, in its gear's frame, by Newton's method along the normal: theta of the point less Theta
of the flank. Two steps are the rule: the third is known beforehand, since the steps shrink quadratically.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, fields, replace

import numpy as np

from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.flanks.base import Flank, Jet
from loaded_tca.pairs.gear_pair import GearPair, cylindrical_basis
from loaded_tca.unloaded import ContactPoint

STEP_ROUNDING = 1e-13
"""Newton steps shorter than this times the base radius of the gear are rounding."""
BEND = 100.0
"""Factor by which the bend of a flank along the normal may differ from place to place."""
NO_MORE = 1e3
"""Steps shorter than this times rounding are the last: the next one shrinks quadratically."""
STEPS_TOGETHER = 4
"""Newton steps of all points of a contact; those that need more, near or beyond the end of an involute, go on alone
from where they meet the other flank, for as many again, as long as the steps shrink to less than half."""
FLATTEST = 1e-6
"""Change of theta along the normal, times the base radius of the gear, below which a flank bends away from it."""
ON_EDGE = 1e-9
"""Distance from an edge, over the module, up to which a flank has not ended."""
TOGETHER = 16_000
"""Points that are sampled at once: arrays of more leave the cache, and their memory goes back to the system."""


@dataclass(frozen=True, eq=False)
class _Rays:
    """Rays along the normals of n contacts, in the frame of one gear turned back.

    Starts (3 of (n, points)), normals (3 of (n, 1)), turns (n, 1), base radius [mm].
    """

    flank: Flank
    start: tuple[Array, ...]
    normal: tuple[Array, ...]
    turn: Array
    base_radius: float

    def single(self, places: tuple[Indices, ...], height: Array) -> _Rays:
        """Some of the rays (k,), from these heights on, each as if it were all of a contact."""
        normal = tuple(part[places[0]] for part in self.normal)
        start = (part[places][:, None] + height[:, None] * n for part, n in zip(self.start, normal, strict=True))
        return replace(self, start=tuple(start), normal=normal, turn=self.turn[places[0]])


@dataclass(frozen=True, eq=False)
class _Meeting:
    """Where rays meet a flank: height above the start, (rho, z), length of the last step, whether it was the last."""

    height: Array
    rho: Array
    z: Array
    step: Array
    settled: Mask


@dataclass(frozen=True, eq=False)
class FlankPoints:
    """Points of one flank that the normals of n contacts meet, each array with the shape of the grid.

    Attributes
    ----------
    point : (..., 3) array [mm]
        Along the axes of the gear's frame as it stands in space, whatever its angle.
    rho, z : (...) array [mm]
        Cylindrical coordinates of the same.
    gradient : (..., 3) array
        Of theta - Theta(rho, z), Cartesian [1/mm].
    steepness : (...) array
        Its part along the normal [1/mm].
    """

    point: Array
    rho: Array
    z: Array
    gradient: Array
    steepness: Array

    def at(self, rows: int | Indices | tuple[slice | int, ...]) -> FlankPoints:
        """Some of the points, as of an index of the grid."""
        return FlankPoints(*(getattr(self, one.name)[rows] for one in fields(self)))


class NormalGap:
    """Distance of the two flanks of a contact along its normal, in coordinates of its tangent plane.

    Of several contacts at once points and results have the contacts as their first axis; none depends on the others.

    Parameters
    ----------
    pair : GearPair
    contact : ContactPoint or sequence of n
    axes : (3, 3) or (n, 3, 3) array
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

    def __init__(self, pair: GearPair, contact: ContactPoint | Sequence[ContactPoint], axes: Array) -> None:
        contacts = [contact] if isinstance(contact, ContactPoint) else contact
        angles = np.array([(one.pinion_angle, one.wheel_angle) for one in contacts]).T
        self._stand(pair, np.array([one.point for one in contacts]), angles, axes.reshape(-1, 3, 3))

    @classmethod
    def at_angles(cls, pair: GearPair, points: Array, angles: Array, axes: Array) -> NormalGap:
        """Gap about points (n, 3) [mm] at angles of both gears (2, n) [rad], along axes (n, 3, 3)."""
        gap = cls.__new__(cls)
        gap._stand(pair, points, angles, axes)
        return gap

    def _stand(self, pair: GearPair, points: Array, angles: Array, axes: Array) -> None:
        in_wheel, origins = pair.wheel_axes.T, points[:, None] - pair.wheel_origin  # a product for each contact
        self.pair = pair
        self._views: tuple[tuple[Flank, Array, Array, Array], ...] = (
            (pair.pinion.flank, points, axes, pair.sense * angles[0]),
            (pair.wheel.flank, (origins @ in_wheel)[:, 0], axes @ in_wheel, -pair.sense * angles[1]),
        )

    def of(self, rows: Indices | Mask | slice) -> NormalGap:
        """Some of the contacts, or the same ones more than once."""
        part = copy(self)
        part._views = tuple((flank, o[rows], axes[rows], turns[rows]) for flank, o, axes, turns in self._views)
        return part

    def at(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Gap [mm], and distance to the nearest edge of either flank [mm], at points that broadcast.

        The distance is negative where a flank has ended, and -inf where the normal does not meet it.
        """
        surfaces = self.surfaces(x, y)
        return surfaces[0], surfaces[1:].min(axis=0)

    def surfaces(self, x: Array, y: Array) -> Array:
        """Gap [mm], and distances to each edge of both flanks [mm], stacked, at points that broadcast."""
        count, shape = len(self._views[0][-1]), np.broadcast_shapes(x.shape, y.shape)
        size = max(1, count * TOGETHER // math.prod(shape))
        if size < count:
            parts = [slice(first, first + size) for first in range(0, count, size)]
            return np.concatenate([self.of(part).surfaces(x[part], y[part]) for part in parts], axis=1)
        gap, distances = self.with_edges(x, y)
        return np.stack([gap, *distances])

    def with_edges(self, x: Array, y: Array) -> tuple[Array, list[Array]]:
        """Gap [mm], and distances to each edge of both flanks [mm], at points that broadcast; signed as of ``at``."""
        shape, rays = np.broadcast_shapes(x.shape, y.shape), self._rays(x, y)
        met, missed = self._meetings(rays)
        jets = [jet for ray, one in zip(rays, met, strict=True) for jet in ray.flank.edges(one.rho, one.z)]
        distances = [jet.value + ON_EDGE * self.pair.module for jet in jets]
        if missed is not None:
            distances = [np.where(missed, -np.inf, distance) for distance in distances]
        return (met[1].height - met[0].height).reshape(shape), [distance.reshape(shape) for distance in distances]

    def flank_points(self, x: Array, y: Array) -> tuple[FlankPoints, FlankPoints]:
        """Points of the flanks of pinion and wheel on the normals at points that broadcast."""
        shape, rays = np.broadcast_shapes(x.shape, y.shape), self._rays(x, y)
        both = []
        for ray, met in zip(rays, self._meetings(rays)[0], strict=True):
            point = np.stack([o + met.height * n for o, n in zip(ray.start, ray.normal, strict=True)], axis=-1)
            basis = cylindrical_basis(np.arctan2(point[..., 1], point[..., 0]))
            gradient = (_gradient(ray.flank, met.rho, met.z)[..., None, :] @ basis)[..., 0, :]
            steep = sum(gradient[..., part] * n for part, n in enumerate(ray.normal))
            parts = point.reshape(*shape, 3), met.rho.reshape(shape), met.z.reshape(shape)
            both.append(FlankPoints(*parts, gradient.reshape(*shape, 3), np.asarray(steep).reshape(shape)))
        return both[0], both[1]

    def places(self, x: Array, y: Array) -> list[tuple[Array, Array]]:
        """(rho, z) [mm] of the same points."""
        shape, met = np.broadcast_shapes(x.shape, y.shape), self._meetings(self._rays(x, y))[0]
        return [(one.rho.reshape(shape), one.z.reshape(shape)) for one in met]

    def curvature_across(self, x: Array, y: Array) -> Array:
        """Second derivative of the gap by x [1/mm] at points that broadcast: the relative curvature across.

        On a relief start it is that of the side on which the point lies.
        """
        bends = []
        for rays, (_, _, axes, _) in zip(self._rays(x, y), self._views, strict=True):
            met = self._meet(rays)
            cosine, sine = (
                (part + met.height * n) / met.rho for part, n in zip(rays.start[:2], rays.normal[:2], strict=True)
            )
            across, out = (
                (a * cosine + b * sine, b * cosine - a * sine, c)
                for a, b, c in np.moveaxis(axes[:, (0, 2), :, None], 0, 2)
            )
            bends.append(_bend(rays.flank.theta(met.rho, met.z), met.rho, across, out))
        return np.asarray(bends[1] - bends[0]).reshape(np.broadcast_shapes(x.shape, y.shape))

    def _rays(self, x: Array, y: Array) -> list[_Rays]:
        """Rays of pinion and wheel at points of the tangent planes, those of a contact in a row."""
        rays, beside = [], (1,) * (max(x.ndim, y.ndim) - 1)
        for (flank, origins, axes, turns), base_radius in zip(self._views, self.pair.base_radii, strict=True):
            count = len(turns)
            start = (
                (o.reshape(count, *beside) + x * a.reshape(count, *beside)) + y * b.reshape(count, *beside)
                for o, a, b in zip(origins.T, axes[:, 0].T, axes[:, 1].T, strict=True)
            )
            normal = tuple(axes[:, 2, :, None].swapaxes(0, 1))
            starts = tuple(part.reshape(count, -1) for part in start)
            rays.append(_Rays(flank, starts, normal, turns[:, None], base_radius))
        return rays

    def _meetings(self, rays: list[_Rays]) -> tuple[list[_Meeting], Mask | None]:
        """Where the rays meet both flanks, and which meet neither; None if all do."""
        met = [self._meet(ray) for ray in rays]
        if (met[0].settled & met[1].settled).all():
            return met, None
        return met, np.logical_or(*(self._meet_rest(rays[own], met[own], met[1 - own]) for own in (0, 1)))

    def _meet_rest(self, rays: _Rays, met: _Meeting, mating: _Meeting) -> Mask:
        """Take further steps as long as they shrink, where the mating gear is met; return where that is in vain."""
        missed = ~met.settled
        rest = np.nonzero(missed)
        room = rays.flank.room(met.rho[rest], met.z[rest])
        on = mating.settled[rest] | (room > -2.0 * met.step[rest])
        rest = tuple(part[on] for part in rest)
        height, step = np.where(mating.settled, mating.height, met.height)[rest], np.full(rest[0].shape, np.inf)
        while step.size:
            reached = self._meet(rays.single(rest, height))
            height, before, step = height + reached.height[:, 0], step, reached.step[:, 0]
            met.height[rest], met.rho[rest], met.z[rest] = height, reached.rho[:, 0], reached.z[:, 0]
            missed[rest] = ~reached.settled[:, 0]
            room = rays.flank.room(met.rho[rest], met.z[rest])
            on = missed[rest] & (room > -2.0 * step) & (step < 0.5 * before)
            rest, height, step = tuple(part[on] for part in rest), height[on], step[on]
        return missed

    def _meet(self, rays: _Rays) -> _Meeting:
        """Newton steps, of each contact until the longest of its points is rounding or the next one would be."""
        (nx, ny, nz), (x, y, z), longest = rays.normal, rays.start, 0.25 * self.pair.module
        rounding = STEP_ROUNDING * rays.base_radius
        height, before = np.zeros((2, *rays.turn.shape))
        settled: Mask = np.zeros(rays.turn.shape, dtype=bool)
        for _ in range(STEPS_TOGETHER):
            square = x * x + y * y
            rho = np.sqrt(square)
            jet = rays.flank.theta(rho, z)
            slope = (x * ny - y * nx) / square - jet.rho * ((x * nx + y * ny) / rho) - jet.z * nz
            flat = np.abs(slope) <= FLATTEST / rays.base_radius
            if flat.any():
                slope[flat] = np.inf
            step = (jet.value + rays.turn - np.arctan2(y, x)) / slope
            length = np.abs(step)
            largest = length.max(axis=1, keepdims=True)
            if (largest > longest).any():
                step = np.clip(step, -longest, longest)
            if settled.any():  # in an earlier step: a contact stays where it stood
                step = np.where(settled, 0.0, step)
            height = height + step
            x, y, z = x + step * nx, y + step * ny, z + step * nz
            settled = settled | (largest <= rounding) | (BEND * largest**3 <= rounding * before**2)
            if settled.all():
                break
            before = np.minimum(largest, longest)
        return _Meeting(height, np.sqrt(x * x + y * y), z, length, settled | (length <= NO_MORE * rounding))


def _gradient(flank: Flank, rho: Array, z: Array) -> Array:
    """Gradient (..., 3) of theta - Theta(rho, z) along e_rho, e_theta, e_z."""
    jet, gradient = flank.theta(rho, z), np.zeros((*np.shape(rho), 3))
    gradient[..., 0], gradient[..., 1], gradient[..., 2] = -jet.rho, 1.0 / rho, -jet.z
    return gradient


def _bend(jet: Jet, rho: Array, across: tuple[Array, ...], out: tuple[Array, ...]) -> Array:
    """Second derivative of the height of a flank by x; directions of x and the normal along e_rho, e_theta, e_z.

    Those of theta - Theta(rho, z) = 0, whose second derivatives along e_theta are those of cylindrical coordinates.
    """
    steep, slope = (each[1] / rho - jet.rho * each[0] - jet.z * each[2] for each in (out, across))
    along_rho, along_theta, along_z = (a - (slope / steep) * b for a, b in zip(across, out, strict=True))
    of_flank = along_rho**2 * jet.rho_rho + 2.0 * along_rho * along_z * jet.rho_z + along_z**2 * jet.z_z
    of_circle = along_theta**2 * jet.rho / rho + 2.0 * along_rho * along_theta / rho**2
    return np.asarray((of_flank + of_circle) / steep)
