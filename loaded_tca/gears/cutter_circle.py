r"""Lengthwise curve of bevel teeth on the plane of the crown gear: the circle of a face-milling cutter.

With the circle of radius :math:`r_{c0}` at the spiral angle :math:`\beta_m` of the cone distance R_m,

.. math:: \sin\beta = \frac{K + R^2}{2 R r_{c0}}, \quad K = 2 R_m r_{c0} \sin\beta_m - R_m^2, \qquad
          \frac{d\varphi}{dR} = \frac{\tan\beta}{R}, \quad
          \varphi = -\arccos\frac{R^2 + S^2 - r_{c0}^2}{2 R S}, \quad S^2 = r_{c0}^2 - K

phi the angle of the curve about the apex; a gear turns by phi/sin(delta).

References
----------
ISO 23509:2016, formula 193 (spiral angle).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, sin, sqrt
from typing import Any

import numpy as np

from loaded_tca.errors import GeometryError, require

_LARGEST_SINE = 0.999
"""Of spiral angles beyond the face, where searches step over the reach of the cutter."""


@dataclass(frozen=True)
class CutterCircle:
    """Circle of a cutter on the plane of the crown gear.

    Parameters
    ----------
    mean_distance : float [mm]
        R_m.
    spiral_angle : float [rad]
        beta_m, positive.
    radius : float [mm]
        r_c0.

    Raises
    ------
    InputError
        If the radius is not positive and finite.

    Examples
    --------
    Annex F.2 of ISO 23509, at the heel:

    >>> from math import asin, degrees, radians
    >>> circle = CutterCircle(81.273, radians(35.0), 114.3)
    >>> round(degrees(asin(circle.sine(93.973)[0])), 3)
    36.846
    """

    mean_distance: float
    spiral_angle: float
    radius: float

    def __post_init__(self) -> None:
        require((0.0 < self.radius < inf, f"cutter_radius: {self.radius} mm is not positive and finite"))

    @property
    def _constant(self) -> float:
        return self.mean_distance * (2.0 * self.radius * sin(self.spiral_angle) - self.mean_distance)

    def check(self, owner: str, distances: tuple[float, float]) -> None:
        """Refuse a circle that does not cross the cone distances of toe and heel [mm]."""
        for distance in distances:
            if not abs(self._constant + distance**2) < _LARGEST_SINE * 2.0 * distance * self.radius:
                raise GeometryError(
                    f"{owner}: cutter_radius {self.radius:g} mm: its circle does not cross the cone distance"
                    f" {distance:.4f} mm; use a larger cutter or a smaller face width"
                )

    def sine(self, distance: Any) -> tuple[Any, Any, Any]:
        """sin(beta) at cone distances [mm], with its first and second derivatives."""
        constant, radius = self._constant, self.radius
        value = np.clip((constant + distance**2) / (2.0 * distance * radius), -_LARGEST_SINE, _LARGEST_SINE)
        slope = (1.0 - constant / distance**2) / (2.0 * radius)
        return value, slope, constant / (distance**3 * radius)

    def tangent(self, distance: Any) -> tuple[Any, Any, Any]:
        """tan(beta), with its first and second derivatives."""
        sine, slope, bend = self.sine(distance)
        cosine = np.sqrt(1.0 - sine**2)
        return sine / cosine, slope / cosine**3, bend / cosine**3 + 3.0 * sine * slope**2 / cosine**5

    def turn(self, distance: Any) -> Any:
        """phi of the curve, zero at R_m [rad]."""
        return self._angle(self.mean_distance) - self._angle(distance)

    def _angle(self, distance: Any) -> Any:
        machine = sqrt(self.radius**2 - self._constant)
        cosine = (distance**2 - self._constant) / (2.0 * distance * machine)
        # (R^2 + S^2 - r^2)/(2 R S) with S^2 = r^2 - K
        return np.arccos(np.clip(cosine, -1.0, 1.0))
