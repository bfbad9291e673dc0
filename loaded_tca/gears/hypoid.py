r"""Pitch cones of hypoid pairs on axes with an offset, and both face-milled members on them.

The pitch cones touch at the calculation point P and have the pitch plane in common there. With its normal n (out of the
pinion) and the generatrices g1, g2 through P, which enclose the offset angle :math:`\zeta_{mp} = \beta_{m1} -
\beta_{m2}`,

.. math:: e_{z1} = \cos\delta_1\,g_1 - \sin\delta_1\,n, \quad e_{\varrho 1} = \sin\delta_1\,g_1 + \cos\delta_1\,n,
          \quad O_1 = P - R_{m1} g_1, \\
          e_{z2} = \cos\delta_2\,g_2 + \sin\delta_2\,n, \quad e_{\varrho 2} = \sin\delta_2\,g_2 - \cos\delta_2\,n,
          \quad O_2 = P - R_{m2} g_2 .

Offset and shaft angle follow from the cones. Without an offset g1 = g2, and both apexes are the crossing point of the
axes. Otherwise the pitch apex of a gear lies at t_z beyond the crossing point, away from its teeth.

The offset a is positive where the pinion follows the hand of the wheel: its spiral angle is the larger one. Lengths are
in mm, angles in rad.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import acos, asin, atan, atan2, cos, hypot, inf, nan, pi, sin

import numpy as np

from loaded_tca.arrays import Array, real
from loaded_tca.errors import InputError, require
from loaded_tca.gears.checks import half_turn_checks
from loaded_tca.gears.face_milled import FaceMilledBlank, FaceMilledMesh
from loaded_tca.plain import plain

Both = tuple[float, float]
"""Of pinion and wheel."""

MOST_ROUNDS = 100
CLOSED, MISSED = 1e-15, 1e-10
"""Changes of the offset angle [rad] that end the search, and the part of the cone distances by which the offset may be
missed then."""


@dataclass(frozen=True, eq=False)
class OffsetFrame:
    """Frame of the wheel in the frame of the pinion, without mounting errors; P lies at phi1 = phi2 = 0.

    Attributes
    ----------
    origin : (3,) array [mm]
        Apex of the wheel's pitch cone.
    axes : (3, 3) array
        Axes of the wheel's frame, in rows.
    common_normal : (3,) array
        Direction of the shortest line between the axes, to the side of +y.
    crossing_points : (2, 3) array [mm]
        Where that line meets the axes of pinion and wheel.
    """

    origin: Array
    axes: Array
    common_normal: Array
    crossing_points: Array


@dataclass(frozen=True)
class HypoidCones:
    r"""Pitch cones of a hypoid pair.

    Parameters
    ----------
    pitch_angles : (float, float) [rad]
        delta_1, delta_2.
    mean_cone_distances : (float, float) [mm]
        R_m1, R_m2: of the calculation point P from the apexes.
    offset_angle : float [rad]
        zeta_mp = beta_m1 - beta_m2, in the pitch plane.

    Raises
    ------
    InputError
        If values are out of range; every one is told.

    References
    ----------
    ISO 23509:2016, formulas 113 to 115 and 129 to 131, which follow from the vectors above.

    Examples
    --------
    The hypoid pair of AGMA 929-B22, annex D:

    >>> from math import degrees, radians
    >>> cones = HypoidCones((radians(16.8693), radians(72.3185)), (127.826, 123.105), radians(17.96767))
    >>> round(cones.offset, 3), round(degrees(cones.shaft_angle), 3)
    (38.1, 90.0)
    """

    pitch_angles: Both
    mean_cone_distances: Both
    offset_angle: float

    def __post_init__(self) -> None:
        require(
            *half_turn_checks(pinion_pitch_angle=self.pitch_angles[0], wheel_pitch_angle=self.pitch_angles[1]),
            *(
                (0.0 < real(distance) < inf, f"mean_cone_distances: {distance} mm is not positive and finite")
                for distance in self.mean_cone_distances
            ),
            (
                abs(real(self.offset_angle)) < 0.5 * pi,
                f"offset_angle: {plain(real(self.offset_angle), 6)} rad is not within 1.571 rad (90 deg)",
            ),
        )

    @classmethod
    def closing(cls, pitch_angles: Both, mean_cone_distances: Both, offset: float, shaft_angle: float) -> HypoidCones:
        r"""Cones that close on an offset and a shaft angle; the last digits of delta_1 are taken from them.

        .. math:: \sin\zeta_m = \frac{2 a}{d_{m2} + d_{m1} \cos\delta_2/\cos\delta_1}, \qquad
                  \sin\zeta_{mp} = \frac{\sin\zeta_m \sin\Sigma}{\cos\delta_1}, \qquad
                  \cos\Sigma = \cos\delta_1 \cos\delta_2 \cos\zeta_{mp} - \sin\delta_1 \sin\delta_2

        Parameters
        ----------
        pitch_angles : (float, float) [rad]
            delta_1, where to start from, and delta_2, which stays.
        mean_cone_distances : (float, float) [mm]
        offset : float [mm]
            a.
        shaft_angle : float [rad]
            Sigma.

        Raises
        ------
        InputError
            If the offset is too large for these cones, or nothing closes.

        References
        ----------
        ISO 23509:2016, formulas 113 and 114.
        """
        second = pitch_angles[1]
        start = _offset_angle(pitch_angles, mean_cone_distances, offset, shaft_angle)

        def first_at(zeta: float) -> float:
            size = hypot(cos(second) * cos(zeta), sin(second))
            turned = cos(shaft_angle) / size
            return acos(turned) - atan2(sin(second), cos(second) * cos(zeta)) if abs(turned) <= 1.0 else nan

        def open_by(zeta: float) -> float:
            first = first_at(zeta)
            reach = _reach((first, second), mean_cone_distances)
            return reach * sin(zeta) * cos(first) / sin(shaft_angle) - offset

        zeta = _secant(open_by, start, start * (1.0 + 1e-6))
        first = first_at(zeta)
        if not (0.0 < first < 0.5 * pi and abs(open_by(zeta)) < MISSED * sum(mean_cone_distances)):
            raise InputError(
                f"pitch_angles: with a wheel of {plain(second, 6)} rad no pinion closes on an offset of "
                f"{plain(offset, 6)} mm and a shaft angle of {plain(shaft_angle, 6)} rad"
            )
        return cls((first, second), mean_cone_distances, zeta)

    @property
    def radii(self) -> Both:
        """d_m/2 of both gears [mm]."""
        first, second = (
            distance * sin(angle) for distance, angle in zip(self.mean_cone_distances, self.pitch_angles, strict=True)
        )
        return first, second

    def mean_normal_modules(self, teeth: tuple[int, int], spiral_angles: Both) -> Both:
        """m_mn = 2 r cos(beta)/z of both gears [mm]; one number where they roll on each other."""
        first, second = (
            2.0 * radius * cos(spiral) / count
            for radius, spiral, count in zip(self.radii, spiral_angles, teeth, strict=True)
        )
        return first, second

    @property
    def shaft_angle(self) -> float:
        """Sigma [rad]."""
        first, second = self.pitch_angles
        return acos(cos(first) * cos(second) * cos(self.offset_angle) - sin(first) * sin(second))

    @property
    def offset(self) -> float:
        """A, positive where the spiral angle of the pinion is the larger one [mm]."""
        return -float(self.frame(1).origin @ self.frame(1).common_normal)

    @property
    def axial_offset_angle(self) -> float:
        """zeta_m, in the pinion's axial plane [rad]."""
        return asin(sin(self.offset_angle) * cos(self.pitch_angles[0]) / sin(self.shaft_angle))

    @property
    def offset_in_pitch_plane(self) -> float:
        """a_p = R_m2 sin(zeta_mp) [mm]."""
        return self.mean_cone_distances[1] * sin(self.offset_angle)

    @cached_property
    def apexes(self) -> Both:
        """t_z of both gears: how far the pitch apexes lie beyond the crossing points, away from the teeth [mm]."""
        frame = self.frame(1)
        first, second = frame.crossing_points
        return float(first[2]), float((second - frame.origin) @ frame.axes[2])

    @property
    def crossing_distances(self) -> Both:
        """t_zm of pinion and wheel: from the crossing points to the calculation point, along the axes [mm]."""
        first, second = (
            distance * cos(angle) - apex
            for distance, angle, apex in zip(self.mean_cone_distances, self.pitch_angles, self.apexes, strict=True)
        )
        return first, second

    def rolling_spiral_angles(self, teeth: tuple[int, int]) -> Both:
        r"""Spiral angles at which the gears roll on each other at P: r1 cos(beta1)/z1 = r2 cos(beta2)/z2 [rad].

        .. math:: \tan\beta_{m2} = \frac{\cos\zeta_{mp} - r_2 z_1/(r_1 z_2)}{\sin\zeta_{mp}}
        """
        first, second = self.radii
        needed = second * teeth[0] / (first * teeth[1])
        wheel = atan((cos(self.offset_angle) - needed) / sin(self.offset_angle))
        return wheel + self.offset_angle, wheel

    def frame(self, hand: int) -> OffsetFrame:
        """Frame of the wheel for a pinion of the hand +1 (right) or -1 (left)."""
        (first, second), zeta = self.pitch_angles, hand * self.offset_angle
        g1, n = np.array([sin(first), 0.0, cos(first)]), np.array([cos(first), 0.0, -sin(first)])
        g2 = np.array([cos(zeta) * sin(first), sin(zeta), cos(zeta) * cos(first)])
        axis, radial = cos(second) * g2 + sin(second) * n, sin(second) * g2 - cos(second) * n
        origin = self.mean_cone_distances[0] * g1 - self.mean_cone_distances[1] * g2
        normal = np.cross([0.0, 0.0, 1.0], axis)
        normal /= np.linalg.norm(normal)
        turn = float(axis[2])
        on_wheel = (turn * origin[2] - origin @ axis) / (1.0 - turn**2)
        on_pinion = origin[2] + turn * on_wheel
        points = np.array([[0.0, 0.0, on_pinion], origin + on_wheel * axis])
        return OffsetFrame(origin, np.array([radial, np.cross(axis, radial), axis]), normal, points)


def _secant(function: Callable[[float], float], before: float, at: float) -> float:
    """Root by the secant method; where the function is not a number that ends it."""
    last, value = function(before), function(at)
    for _ in range(MOST_ROUNDS):
        if not abs(at - before) > CLOSED or value == last:
            break
        before, at, last = at, at - value * (at - before) / (value - last), value
        value = function(at)
    return at


def _offset_angle(pitch_angles: Both, distances: Both, offset: float, shaft_angle: float) -> float:
    """zeta_mp [rad] of an offset [mm]; InputError where it is too large for the cones, or these stand nowhere."""
    first = pitch_angles[0]
    reach = _reach(pitch_angles, distances)
    if not (first < 0.5 * pi and reach > 0.0):
        raise InputError(
            f"pitch_angles: no pinion of {plain(first, 6)} rad stands beside a wheel of {plain(pitch_angles[1], 6)} rad"
        )
    sine = offset / reach * sin(shaft_angle) / cos(first)
    if not (abs(offset) < reach and abs(sine) < 1.0):
        largest = reach * min(1.0, cos(first) / sin(shaft_angle))
        raise InputError(
            f"offset: {plain(offset, 6)} mm is too large for these pitch cones; allowed below {plain(largest, 6)} mm"
        )
    return asin(sine)


def _reach(pitch_angles: Both, distances: Both) -> float:
    """a/sin(zeta_m) [mm], half of d_m2 + d_m1 cos(delta_2)/cos(delta_1)."""
    first, second = pitch_angles
    return distances[1] * sin(second) + distances[0] * sin(first) * cos(second) / cos(first)


ALONG, AROUND = 33, 161
"""Points along a face cone, and azimuths over which it is near the mating gear."""
REACH = 0.6
"""These azimuths to either side of the calculation point [rad]."""


@dataclass(frozen=True)
class HypoidMesh(FaceMilledMesh):
    """Both members of a face-milled hypoid pair.

    Parameters
    ----------
    pinion, wheel : FaceMilledGear
        With apexes counted from those of their pitch cones.
    shaft_angle : float [rad]
    cones : HypoidCones
        The pitch cones, which close on offset and shaft angle.
    """

    cones: HypoidCones

    @property
    def offset(self) -> float:
        """Hypoid offset a [mm]."""
        return self.cones.offset

    @property
    def tip_clearances(self) -> tuple[float, float]:
        """Smallest clearance between the roots of pinion and wheel and the mating gear's tip [mm].

        Across the root cone, over all the face: face cones touch planes at the clearance of the blank in one line, and
        stand off more elsewhere.
        """
        pinion, wheel, frame = self.pinion.blank, self.wheel.blank, self.cones.frame(self.pinion.mirror)
        on_pinion = (_face_cone(wheel) @ frame.axes) + frame.origin
        on_wheel = (_face_cone(pinion) - frame.origin) @ frame.axes.T
        return _above_root(on_pinion, pinion), _above_root(on_wheel, wheel)


def _face_cone(blank: FaceMilledBlank) -> Array:
    """Points (ALONG, AROUND, 3) of the face cone about P, in the frame of its gear."""
    distance = np.linspace(*blank.cone_distances, ALONG)
    height = np.array([blank.tip_height(one) for one in distance])
    rho = distance * sin(blank.pitch_angle) + height * cos(blank.pitch_angle)
    z = distance * cos(blank.pitch_angle) - height * sin(blank.pitch_angle)
    azimuth = np.linspace(-REACH, REACH, AROUND)
    around = np.stack([np.cos(azimuth), np.sin(azimuth)], axis=-1)
    points = np.empty((ALONG, AROUND, 3))
    points[..., :2] = rho[:, None, None] * around
    points[..., 2] = z[:, None]
    return points


def _above_root(points: Array, blank: FaceMilledBlank) -> float:
    """Smallest distance [mm] from the root cone, of points (n, m, 3) that lie on the face of a gear.

    Along each row a parabola through the lowest point and its neighbours.
    """
    rho, z = np.hypot(points[..., 0], points[..., 1]), points[..., 2]
    height = rho * cos(blank.root_angle) - (z + blank.root_apex) * sin(blank.root_angle)
    distance = np.hypot(rho, z)
    toe, heel = blank.cone_distances
    rows, lowest = np.arange(len(height)), np.clip(height.argmin(axis=1), 1, height.shape[1] - 2)
    before, at, after = (height[rows, lowest + step] for step in (-1, 0, 1))
    bend = before - 2.0 * at + after
    vertex = at - np.divide((after - before) ** 2, 8.0 * bend, out=np.zeros_like(bend), where=bend > 0.0)
    faces = (distance[rows, lowest] >= toe) & (distance[rows, lowest] <= heel)
    return float(vertex[faces].min()) if faces.any() else float("inf")
