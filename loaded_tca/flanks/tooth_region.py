r"""Region of a bevel flank between its form line and the face cone, toe and heel, with coordinates that follow it.

The form line is where the flank begins above the fillet; it is a curve u_f(R), seen from the apex of the pitch cone,
and so is the face cone u_a(R), whose own apex may lie elsewhere:

.. math:: u_a(R) = \delta_a + \arcsin\frac{t_a \sin\delta_a}{R} .

The profile coordinate is the part of the height that a point has reached, times the height at mid-face,

.. math:: y = H_m \frac{u - u_f(R)}{u_a(R) - u_f(R)}, \qquad H_m = R_m [u_a(R_m) - u_f(R_m)],

so that lines of equal y run from toe to heel without leaving the flank. Curves over R are polynomials between toe and
heel and go on beyond as parabolas.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.polynomial import chebyshev

from loaded_tca.arrays import Array
from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.frame import ConeFrame
from loaded_tca.flanks.jet import Jet, cone_angle, cone_distance
from loaded_tca.flanks.tensor_spline import polynomial

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
