r"""Spherical involute, the flank of straight and spiral bevel gears.

With the cone angle u = atan2(rho, z) and the cone distance R = hypot(rho, z), both from the apex,

.. math:: \Theta = s\,[\mathrm{inv}_s u_w - \mathrm{inv}_s u]
          + h \frac{\tan\beta_m}{\sin\delta} \ln\frac{R}{R_m},
          \qquad \mathrm{inv}_s u = \frac{1}{\sin\delta_b}\arccos\frac{\cos u}{\cos\delta_b}
          - \arccos\frac{\tan\delta_b}{\tan u},
          \qquad \sin\delta_b = \sin\delta \cos\alpha

turned so that the point of the pitch cone, u_w = delta, at the mean cone distance R_m has theta = 0. The profile is
unwound from the base cone delta_b, alpha is the transverse pressure angle; lengthwise the tooth is a logarithmic
spiral, which meets every generator of a cone under one angle (beta_m on the pitch cone). With
Q = sqrt(sin(u - delta_b) sin(u + delta_b)):

.. math:: \mathrm{inv}_s' = \frac{Q}{\sin\delta_b \sin u}, \quad
          \mathrm{inv}_s'' = \frac{\sin\delta_b \cos u}{Q \sin^2 u}, \quad
          |\nabla F| = \frac{1}{R}\sqrt{\frac{1}{\sin^2\delta_b} + \frac{\tan^2\beta_m}{\sin^2\delta}} .

The region of a bevel flank lies between its form line and the face cone, toe and heel. The form line is where the flank
begins above the fillet; it is a curve u_f(R), seen from the apex of the pitch cone, and so is the face cone u_a(R),
whose own apex may lie elsewhere:

.. math:: u_a(R) = \delta_a + \arcsin\frac{t_a \sin\delta_a}{R} .

The profile coordinate is the part of the height that a point has reached, times the height at mid-face,

.. math:: y = H_m \frac{u - u_f(R)}{u_a(R) - u_f(R)}, \qquad H_m = R_m [u_a(R_m) - u_f(R_m)],

so that lines of equal y run from toe to heel without leaving the flank. Curves over R are polynomials between toe and
heel and go on beyond as parabolas.

References
----------
Al-Daccak, Angeles & Gonzalez-Palacios 1994, The modeling of bevel gears using the exact spherical involute, J. Mech.
Des. 116; Litvin & Fuentes 2004, Gear Geometry and Applied Theory, chapter 21.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array
from loaded_tca.errors import InputError
from loaded_tca.flanks.base import ConeFrame, Flank, Jet, cone_angle, cone_distance, of_cone_angle
from loaded_tca.flanks.tensor_spline import polynomial
from loaded_tca.gears.bevel import CutterCircle
from loaded_tca.plain import plain

NODES = 11
"""Cone distances at which a curve over R is known; they resolve it to the last digits."""


def chebyshev_nodes(interval: tuple[float, float], count: int) -> Array:
    """Chebyshev-Lobatto points (count,) of an interval, ends included, rising."""
    low, high = interval
    points: Array = 0.5 * (low + high) - 0.5 * (high - low) * np.cos(np.linspace(0.0, math.pi, count))
    points[0], points[-1] = low, high
    return points


class DistanceCurve:
    """A smooth function of the cone distance, through its values at the Chebyshev-Lobatto points.

    Parameters
    ----------
    interval : (float, float) [mm]
        Toe and heel.
    values : (n,) array
    """

    def __init__(self, interval: tuple[float, float], values: Array) -> None:
        self.middle, self.half = 0.5 * (interval[0] + interval[1]), 0.5 * (interval[1] - interval[0])
        nodes = chebyshev_nodes((-1.0, 1.0), len(values))
        self._powers = chebyshev.cheb2poly(chebyshev.chebfit(nodes, values, len(values) - 1)).tolist()

    def __call__(self, distance: Jet) -> Jet:
        """Value and derivatives at a cone distance R(rho, z)."""
        at = (distance.value - self.middle) / self.half
        inner = np.clip(at, -1.0, 1.0)
        beyond = at - inner
        value, slope, bend = polynomial([*self._powers[:-1], np.full_like(inner, self._powers[-1])], inner, 2)
        value, slope = value + beyond * (slope + 0.5 * beyond * bend), slope + beyond * bend
        return distance.compose(value, slope / self.half, bend / self.half**2)

    def at(self, distance: Array) -> Array:
        """Value alone."""
        return self(Jet(distance)).value


class ToothRegion(Flank):
    """A bevel flank's region and coordinates.

    Parameters
    ----------
    side : int
        s, +1 or -1.
    pitch_angle : float [rad]
        delta.
    cone_distances : (float, float) [mm]
        Toe and heel.
    face_cone : (float, float) [rad], [mm]
        delta_a, and t_a: how far its apex lies beyond that of the pitch cone, away from the teeth.
    form_angles : (NODES,) array [rad]
        Cone angles of the form line at the Chebyshev-Lobatto points from toe to heel.
    """

    def __init__(
        self,
        side: int,
        pitch_angle: float,
        cone_distances: tuple[float, float],
        face_cone: tuple[float, float],
        form_angles: Array,
    ) -> None:
        self.side, self.cone_distances, self.face_cone = side, cone_distances, face_cone
        self.mean_cone_distance = 0.5 * (cone_distances[0] + cone_distances[1])
        face_angles = face_cone_angles(face_cone, chebyshev_nodes(cone_distances, len(form_angles)))
        self._form_line = DistanceCurve(cone_distances, form_angles)
        heights = face_angles - form_angles
        middle = np.array(self.mean_cone_distance)
        tip, foot = float(face_cone_angles(face_cone, middle)), float(self._form_line.at(middle))
        self.mean_cone_angles = (tip, foot)
        self.mean_height = self.mean_cone_distance * (tip - foot)
        self._rise = DistanceCurve(cone_distances, self.mean_height / heights)
        self._foot = DistanceCurve(cone_distances, self.mean_height * form_angles / heights)
        rho, z = self.grid(9, 3)
        self.extent = (float(np.ptp(rho)), float(np.ptp(z)))
        self.frame = ConeFrame(pitch_angle, self.mean_cone_distance)

    def edges(self, rho: Array, z: Array) -> tuple[Jet, ...]:
        """Face cone, form line (R times the angle to it), toe and heel sphere."""
        tip, apex = self.face_cone
        sine, cosine = math.sin(tip), math.cos(tip)
        distance = self._distance(rho, z)
        above = cone_angle(rho, z) + self._form_line(distance) * -1.0
        return (
            Jet((z + apex) * sine - rho * cosine, rho=-cosine, z=sine),
            distance.times(above),
            distance + Jet(-self.cone_distances[0]),
            distance * -1.0 + Jet(self.cone_distances[1]),
        )

    def grid(self, profile: int, lengthwise: int) -> tuple[Array, Array]:
        """Even grid in the profile coordinate and the cone distance."""
        return self.places(np.linspace(0.0, self.mean_height, profile), np.linspace(*self.cone_distances, lengthwise))

    def places(self, profile: Array, distance: Array) -> tuple[Array, Array]:
        """(rho, z) of the grid lines (n,) of the profile coordinate and (m,) of the cone distance, each (n, m) [mm]."""
        angle = (profile[:, None] + self._foot.at(distance)) / self._rise.at(distance)
        return distance * np.sin(angle), distance * np.cos(angle)

    def profile_coordinate(self, rho: Array, z: Array) -> Jet:
        """Height above the form line, scaled to that at mid-face [mm]."""
        distance = self._distance(rho, z)
        return cone_angle(rho, z).times(self._rise(distance)) + self._foot(distance) * -1.0

    def lengthwise_coordinate(self, rho: Array, z: Array) -> Jet:
        """R - R_m."""
        return self._distance(rho, z) + Jet(-self.mean_cone_distance)

    def _distance(self, rho: Array, z: Array) -> Jet:
        return cone_distance(rho, z, self.mean_cone_distance)


def face_cone_angles(face_cone: tuple[float, float], distance: Array) -> Array:
    """u_a(R) of a cone with its apex off the origin [rad]."""
    tip, apex = face_cone
    return tip + np.arcsin(np.clip(apex * math.sin(tip) / distance, -1.0, 1.0))


ROUNDING = 1e-12
"""Of cone angles [rad]."""
SMALLEST_Q = 3e-5
"""Q is kept above this: at the base cone itself the curvature is infinite, below it there is no involute. That
concerns 1e-9 rad beside the base cone, where Theta is then off by less than 1e-13 rad."""


def unwound_arc(cone_angle: Array, base_angle: float) -> Array:
    """Arc w from the base cone along the great circle that unwinds: cos u = cos(delta_b) cos(w) [rad]."""
    return np.arctan2(_q(np.sin(cone_angle), base_angle), np.cos(cone_angle))


def spherical_involute(cone_angle: Array, base_angle: float) -> Array:
    """inv_s(u) [rad]: by arctangents, which keep their digits near the base cone."""
    q, cosine, sine = _q(np.sin(cone_angle), base_angle), np.cos(cone_angle), math.sin(base_angle)
    return np.arctan2(q, cosine) / sine - np.arctan2(q, sine * cosine)


def _q(sine: Array, base_angle: float) -> Array:
    """Q = sqrt(sin^2 u - sin^2 delta_b), from sin u."""
    base = math.sin(base_angle)
    return np.sqrt(np.maximum((sine - base) * (sine + base), SMALLEST_Q**2))


@checked
class SphericalInvoluteFlank(Flank):
    """Unmodified flank of a bevel gear between root and face cone, toe and heel.

    Parameters
    ----------
    pitch_angle : float [rad]
        delta, where theta = 0 at the mean cone distance.
    pressure_angle : float [rad]
        alpha, transverse.
    spiral_angle : float [rad]
        beta_m on the pitch cone, positive for a right-hand gear; the same at every cone distance, or with a
        circle at R_m.
    side : int
        s, +1 or -1.
    cone_angles : (float, float) [rad]
        Root (form) cone, not below the base cone, and face cone.
    cone_distances : (float, float) [mm]
        Toe and heel.
    apexes : (float, float) [mm]
        How far the apexes of both cones lie beyond that of the pitch cone, away from the teeth.
    zero_distance : float [mm], optional
        R_m, where theta = 0 on the pitch cone; None: in the middle of the face.
    circle : CutterCircle, optional
        That the teeth follow lengthwise, through R_m; None: a logarithmic spiral.

    Raises
    ------
    InputError
        If the cones or the cone distances are not in order.
    """

    def __init__(
        self,
        pitch_angle: float,
        pressure_angle: float,
        spiral_angle: float,
        side: int,
        cone_angles: tuple[float, float],
        cone_distances: tuple[float, float],
        apexes: tuple[float, float] = (0.0, 0.0),
        zero_distance: float | None = None,
        circle: CutterCircle | None = None,
    ) -> None:
        base = math.asin(math.sin(pitch_angle) * math.cos(pressure_angle))
        seen = [
            [float(face_cone_angles(cone, np.array(distance))) if cone[1] else cone[0] for distance in cone_distances]
            for cone in zip(cone_angles, apexes, strict=True)
        ]
        for root, face in zip(*seen, strict=True):
            if not base - ROUNDING <= root < face <= math.pi - base:
                raise InputError(
                    f"cone_angles: base {plain(base, 6)} <= root {plain(root, 6)} < face {plain(face, 6)} <= "
                    f"{plain(math.pi - base, 6)} rad does not hold"
                )
        if not 0.0 < cone_distances[0] < cone_distances[1]:
            raise InputError(f"cone_distances: 0 < toe {cone_distances[0]} < heel {cone_distances[1]} mm does not hold")
        self.base_angle, self.side = base, side
        self.cone_angles, self.cone_distances, self.apexes = cone_angles, cone_distances, apexes
        self.mean_cone_distance = self.profile_unit = 0.5 * (cone_distances[0] + cone_distances[1])
        self.zero_distance = self.mean_cone_distance if zero_distance is None else zero_distance
        self.roll_unit = math.sin(base)
        self._spiral = math.tan(spiral_angle) / math.sin(pitch_angle)
        self._circle, self._turning = circle, math.copysign(1.0 / math.sin(pitch_angle), spiral_angle)
        self._pitch_involute = float(spherical_involute(np.array(pitch_angle), base))
        rho, z = self.grid(9, 2)
        self.extent = (float(np.ptp(rho)), float(np.ptp(z)))
        self.frame = ConeFrame(pitch_angle, self.mean_cone_distance)

    def theta(self, rho: Array, z: Array, beyond: Any = None) -> Jet:  # noqa: ARG002 (it has no relief start)
        """Theta of the spherical involute, log spiral included."""
        distance, sine_base, side = self._cone_distance(rho, z), math.sin(self.base_angle), float(self.side)
        sine, cosine = distance.rho, distance.z
        q = _q(sine, self.base_angle)
        involute = np.arctan2(q, cosine) / sine_base - np.arctan2(q, sine_base * cosine)
        profile = of_cone_angle(
            rho,
            z,
            side * (self._pitch_involute - involute),
            -side / sine_base * q / sine,
            lambda: -side * sine_base * cosine / (q * (sine * sine)),
        )
        if self._spiral == 0.0:
            return profile
        if self._circle is not None:
            return profile + self._along_circle(self._circle, distance)
        inverse = 1.0 / distance.value
        logarithm = distance.compose(np.log(distance.value / self.zero_distance), inverse, lambda: -inverse * inverse)
        return profile + logarithm * self._spiral

    def _along_circle(self, circle: CutterCircle, distance: Jet) -> Jet:
        """Turn of the tooth along the circle of a cutter."""
        along, (tangent, slope, _) = distance.value, circle.tangent(distance.value)
        turn = distance.compose(circle.turn(along), tangent / along, lambda: slope / along - tangent / along**2)
        return turn * self._turning

    def edges(self, rho: Array, z: Array) -> tuple[Jet, ...]:
        """Face cone and root cone, along the normals of the cones, toe and heel sphere."""
        (root, tip), (below, above) = self.cone_angles, self.apexes
        distance = self._cone_distance(rho, z)
        return (
            Jet((z + above) * math.sin(tip) - rho * math.cos(tip), rho=-math.cos(tip), z=math.sin(tip)),
            Jet(rho * math.cos(root) - (z + below) * math.sin(root), rho=math.cos(root), z=-math.sin(root)),
            distance + Jet(-self.cone_distances[0]),
            distance * -1.0 + Jet(self.cone_distances[1]),
        )

    def grid(self, profile: int, lengthwise: int) -> tuple[Array, Array]:
        """Even grid in the unwound arc and the cone distance: near the base cone the profile bends most."""
        distance = np.linspace(*self.cone_distances, lengthwise)
        cones = [
            face_cone_angles(cone, distance) if cone[1] else np.full(lengthwise, cone[0])
            for cone in zip(self.cone_angles, self.apexes, strict=True)
        ]
        start, end = unwound_arc(np.stack(cones), self.base_angle)
        angle = np.arccos(math.cos(self.base_angle) * np.cos(np.linspace(start, end, profile)))
        angle[[0, -1]] = cones
        return np.sin(angle) * distance, np.cos(angle) * distance

    def profile_coordinate(self, rho: Array, z: Array) -> Jet:
        """Unwound arc w, cos u = cos(delta_b) cos(w)."""
        distance, fall = self._cone_distance(rho, z), -(math.sin(self.base_angle) ** 2)
        sine, cosine = distance.rho, distance.z
        q = _q(sine, self.base_angle)
        return of_cone_angle(rho, z, np.arctan2(q, cosine), sine / q, lambda: fall * cosine / (q * q * q))

    def lengthwise_coordinate(self, rho: Array, z: Array) -> Jet:
        """R - R_m."""
        return self._cone_distance(rho, z) + Jet(-self.mean_cone_distance)

    def gradient_norm(self, rho: Array, z: Array) -> Jet:
        """|grad F|, which is the same all along the profile, and falls with 1/R but for the bend of a circle."""
        if self._circle is not None:
            return self._gradient_along_circle(self._circle, self._cone_distance(rho, z))
        size = math.hypot(1.0 / math.sin(self.base_angle), self._spiral)
        distance = self._cone_distance(rho, z)
        value = size / distance.value
        slope = -value / distance.value
        return distance.compose(value, slope, lambda: -2.0 * slope / distance.value)

    def _gradient_along_circle(self, circle: CutterCircle, distance: Jet) -> Jet:
        """sqrt(1/sin^2 delta_b + tan^2 beta/sin^2 delta)/R, with its derivatives."""
        along = distance.value
        tangent, slope, bend = (part * abs(self._turning) for part in circle.tangent(along))
        size = np.hypot(1.0 / math.sin(self.base_angle), tangent)
        growth = tangent * slope / size
        value = size / along
        change = (growth - value) / along
        curved = (slope**2 + tangent * bend - growth**2) / size
        return distance.compose(value, change, lambda: (curved - 2.0 * change) / along)

    def _cone_distance(self, rho: Array, z: Array) -> Jet:
        return cone_distance(rho, z, self.mean_cone_distance)
