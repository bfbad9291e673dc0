r"""Contact of two face-milled flanks at their mean points: motion, path and ellipse, from slopes and bends alone.

Turn the pinion by phi1. The mating flank passes through the point (rho, z) of the pinion at the azimuth
:math:`\alpha = \Theta_1(\rho, z) + \sigma\varphi_1` when the wheel stands at

.. math:: \varphi_2 = F(\alpha, \rho, z) = \sigma\,[\Theta_2(\rho_2, z_2) - \theta_2],

a function of the wheel alone. With :math:`g = F - \varphi_1 z_1/z_2`, H its second derivatives along the flank of the
pinion and v their mixed ones with phi1, in the tangent plane,

.. math:: \frac{d^2\varphi_2}{d\varphi_1^2} = F_{\alpha\alpha} - v^T H^{-1} v, \qquad
          t = -H^{-1} v, \qquad B = -l_2 H

are the second derivative of the motion curve, the direction of the path of contact and the tensor of relative
curvature (l_2: lever of the normal about the axis of the wheel). Read the other way round, with a direction d of the
path and a second derivative m asked for, :math:`H d = -v (v \cdot d)/(m - F_{\alpha\alpha})`, and the third number of H
follows from the smaller of both relative curvatures: that is what local synthesis asks of the flank of the pinion.

References
----------
Litvin & Fuentes 2004, Gear Geometry and Applied Theory, section 21.5 (local synthesis); here the second derivatives of
Theta take the place of principal curvatures and directions.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import GeometryError, require
from loaded_tca.flanks.cradle import CradleGeneration, GeneratedPoints
from loaded_tca.gears.face_milled import FaceMilledGear, FlankName
from loaded_tca.plain import plain

MARKING = 0.00635
"""Approach at which a contact ellipse is as long as a marking compound of this thickness shows it [mm]."""
OTHER_FLANK: dict[FlankName, FlankName] = {"concave": "convex", "convex": "concave"}
"""Flank of a gear -> the one of its mating gear that it touches."""


@dataclass(frozen=True)
class MeanContact:
    """How two flanks touch at their mean points, or are to touch there.

    Attributes
    ----------
    motion_fall : float [rad]
        By how much the wheel stays behind a half pitch of the pinion before and after the mean point, were the motion
        curve the parabola that it is there.
    path_angle : float [rad]
        Direction of the path of contact on the pinion, from the tooth trace at the heel (0) over the tip (pi/2) to the
        toe (pi).
    contact_length : float [mm]
        Length of the contact ellipse under an approach of 0.00635 mm.

    Raises
    ------
    InputError
        If a value is out of range; every one is told.
    """

    motion_fall: float
    path_angle: float
    contact_length: float

    def __post_init__(self) -> None:
        require(
            (0.0 <= self.motion_fall < 0.1, f"motion_fall: {plain(self.motion_fall, 6)} rad is not from 0 to 0.1 rad"),
            (
                0.0 < self.path_angle < math.pi,
                f"path_angle: {plain(self.path_angle, 6)} rad is not between 0 and 3.142 rad (180 deg)",
            ),
            (
                0.0 < self.contact_length < math.inf,
                f"contact_length: {self.contact_length} mm is not positive and finite",
            ),
        )

    def second_derivative(self, teeth: int) -> float:
        r"""Of the motion curve, :math:`-8 f/\tau^2` with the fall f and the pitch tau of the pinion."""
        return -8.0 * self.motion_fall / (2.0 * math.pi / teeth) ** 2

    @property
    def least_curvature(self) -> float:
        """Relative curvature along the contact ellipse, 8 delta/(2a)^2 [1/mm]."""
        return 8.0 * MARKING / self.contact_length**2


@dataclass(frozen=True, eq=False)
class LocalFlank:
    """A flank at one of its points, on its own gear.

    Attributes
    ----------
    slopes, bends : (2,) and (3,) array
        First derivatives of Theta by rho and z, second by rho rho, rho z and z z.
    """

    slopes: Array
    bends: Array

    @property
    def hessian(self) -> Array:
        """Second derivatives (2, 2)."""
        return self.bends[[[0, 1], [1, 2]]]


def mean_point(gear: FaceMilledGear) -> tuple[float, float]:
    """Point (rho, z) of the pitch cone at the mean cone distance [mm]."""
    distance, pitch = gear.blank.mean_cone_distance, gear.blank.pitch_angle
    return distance * math.sin(pitch), distance * math.cos(pitch)


def generated_at(gear: FaceMilledGear, flank: FlankName, rho: Array, z: Array) -> GeneratedPoints:
    """Points of a flank of the right-hand member."""
    return CradleGeneration(gear.cutter.blade(flank), flank, gear.machine).solve(rho, z)


def local_flank(gear: FaceMilledGear, points: GeneratedPoints) -> LocalFlank:
    """First of the points of the right-hand member, on the gear with its hand."""
    jet = points.theta
    slopes, bends = np.array([jet.rho[0], jet.z[0]]), np.array([bend[0] for bend in jet.bends])
    return LocalFlank(gear.mirror * slopes, gear.mirror * bends)


@dataclass(frozen=True, eq=False)
class MeanField:
    """What the mating flank asks of a flank of the pinion at its mean point.

    Attributes
    ----------
    gradient, hessian : (3,) and (3, 3) array
        Derivatives of F by alpha, rho and z.
    side : int
        s of the flank, the sense in which the pinion drives with it.
    rho, pitch_angle : float [mm], [rad]
        Of the mean point of the pinion.
    wheel_arm, wheel_axis : (3,) array [mm], (3,) array
        Mean point from the origin of the wheel, and direction of the wheel's axis, in the frame of the pinion.
    """

    gradient: Array
    hessian: Array
    side: int
    rho: float
    pitch_angle: float
    wheel_arm: Array
    wheel_axis: Array

    @classmethod
    def of(
        cls, pinion: FaceMilledGear, wheel: FaceMilledGear, flank: FlankName, place: tuple[Array, Array]
    ) -> MeanField:
        """The field of the flank of the wheel that touches ``flank`` of the pinion.

        ``place`` is origin (3,) and axes (3, 3), in rows, of the wheel frame in the frame of the pinion; both flanks
        hold their mean points at theta = 0.
        """
        (rho, z), side, (origin, axes) = mean_point(pinion), pinion.side(flank), place
        arm = np.array([rho, 0.0, z]) - origin
        x, y, _ = axes @ arm
        radius, theta = math.hypot(x, y), math.atan2(y, x)
        there = generated_at(wheel, OTHER_FLANK[flank], *(np.array([part]) for part in (radius, axes[2] @ arm)))
        mating = local_flank(wheel, there)
        # dP and ddP by (alpha, rho, z) in the cylindrical basis of the wheel at P
        basis = np.array([[math.cos(theta), math.sin(theta), 0.0], [-math.sin(theta), math.cos(theta), 0.0], [0, 0, 1]])
        turned = (basis @ axes).T
        slopes = np.array([[0.0, rho, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]) @ turned
        bends = np.zeros((3, 3, 3))
        bends[0, 0, 0], bends[0, 1, 1], bends[1, 0, 1] = -rho, 1.0, 1.0
        bends = bends @ turned
        out, around, up = slopes.T
        out2 = bends[..., 0] + np.outer(around, around) / radius
        around2 = (bends[..., 1] - (np.outer(out, around) + np.outer(around, out)) / radius) / radius
        (by_rho, by_z), second = mating.slopes, np.stack([out, up])
        gradient = by_rho * out + by_z * up - around / radius
        hessian = by_rho * out2 + by_z * bends[..., 2] - around2 + second.T @ mating.hessian @ second
        return cls(side * gradient, side * hessian, side, rho, pinion.blank.pitch_angle, arm, axes[2])

    @property
    def slopes(self) -> Array:
        """Slopes (2,) of the flank that touches there."""
        return np.asarray(-self.gradient[1:] / self.gradient[0])

    @property
    def _tangents(self) -> tuple[Array, Array, float]:
        """Rows (2, 2) that take d(rho, z) to the tangent plane, mixed derivatives (2,) there, lever of the normal."""
        slopes = self.slopes
        by_rho, by_z = np.array([1.0, self.rho * slopes[0], 0.0]), np.array([0.0, self.rho * slopes[1], 1.0])
        along = math.sin(self.pitch_angle) * by_rho + math.cos(self.pitch_angle) * by_z
        along /= np.linalg.norm(along)
        normal = np.cross(by_rho, by_z)
        normal /= np.linalg.norm(normal)
        up = np.cross(normal, along)
        up *= math.copysign(1.0, up[0] * math.cos(self.pitch_angle) - up[2] * math.sin(self.pitch_angle))
        rows = np.array([[along @ by_rho, along @ by_z], [up @ by_rho, up @ by_z]])
        mixed = self.side * np.linalg.solve(rows.T, self.hessian[0, 0] * slopes + self.hessian[0, 1:])
        return rows, mixed, abs(float(np.cross(self.wheel_arm, normal) @ self.wheel_axis))

    @property
    def _rest(self) -> Array:
        """Second derivatives (2, 2) of g along a pinion flank whose own ones are zero."""
        slopes, by_angle = self.slopes, self.hessian[0]
        turned = np.outer(slopes, by_angle[1:])
        return by_angle[0] * np.outer(slopes, slopes) + turned + turned.T + self.hessian[1:, 1:]

    def tilt(self, flank: LocalFlank) -> float:
        """Angle between the normals of a flank of the pinion and of the wheel at the mean point [rad]."""
        own, mating = (np.array([-slopes[0], 1.0 / self.rho, -slopes[1]]) for slopes in (flank.slopes, self.slopes))
        return float(np.arctan2(np.linalg.norm(np.cross(own, mating)), own @ mating))

    def contact(self, flank: LocalFlank, teeth: int) -> MeanContact:
        """How a flank of the pinion touches that has the slopes asked for.

        Raises
        ------
        GeometryError
            If the flanks cut into each other beside the mean point, or the wheel runs ahead there.
        """
        rows, mixed, lever = self._tangents
        inverse = np.linalg.inv(rows)
        bend = inverse.T @ (self._rest + self.gradient[0] * flank.hessian) @ inverse
        least = float(np.linalg.eigvalsh(-lever * bend)[0])
        path = -np.linalg.solve(bend, mixed)
        second = float(self.hessian[0, 0] + mixed @ path)
        if not (least > 0.0 >= second):
            raise GeometryError(
                f"the flanks do not carry at the mean point: least relative curvature {plain(least)} 1/mm, second"
                f" derivative of the motion {plain(second)}"
            )
        angle = math.atan2(path[1], path[0]) % math.pi
        fall = -second * (2.0 * math.pi / teeth) ** 2 / 8.0
        return MeanContact(fall, angle, math.sqrt(8.0 * MARKING / least))

    def flank_for(self, aim: MeanContact, teeth: int) -> LocalFlank:
        """Return the flank of the pinion that touches as it is asked to.

        Raises
        ------
        GeometryError
            If there is none: the ellipse asked for is shorter than path and motion allow.
        """
        rows, mixed, lever = self._tangents
        along = np.array([math.cos(aim.path_angle), math.sin(aim.path_angle)])
        axes = np.array([along, [-along[1], along[0]]])
        behind = aim.second_derivative(teeth) - self.hessian[0, 0]
        pull = lever * float(mixed @ along) / behind
        of_path, skew = pull * (axes @ mixed)
        least = aim.least_curvature
        if not behind > 0.0:
            most = -self.hessian[0, 0] * (2.0 * math.pi / teeth) ** 2 / 8.0
            raise GeometryError(
                f"motion_fall: {plain(aim.motion_fall)} rad; allowed below {plain(most)} rad, the fall of an "
                "edge at the mean point"
            )
        if not of_path > least:
            longest = math.sqrt(8.0 * MARKING / of_path) if of_path > 0.0 else math.inf
            raise GeometryError(
                f"path_angle: a path at {plain(math.degrees(aim.path_angle))} deg with motion_fall = "
                f"{plain(aim.motion_fall)} rad needs a contact ellipse that is longer than {plain(longest)} mm; asked "
                f"for are {plain(aim.contact_length)} mm: take a path more across the tooth"
            )
        across = least + skew**2 / (of_path - least)
        bend = axes.T @ np.array([[of_path, skew], [skew, across]]) @ axes / -lever
        own = (rows.T @ bend @ rows - self._rest) / self.gradient[0]
        return LocalFlank(self.slopes, np.array([own[0, 0], own[0, 1], own[1, 1]]))
