"""What external gears and ring gears have in common: formulas of ISO 21771 without the signs of internal gears."""

from __future__ import annotations

from math import asin, atan, cos, hypot, pi, sin, sqrt, tan
from typing import TYPE_CHECKING

from loaded_tca.errors import InputError


class InvoluteGear:
    """Spur or helical gear with involute teeth; radii and roll lengths are positive, also those of ring gears.

    References
    ----------
    ISO 21771:2007, Gears - Cylindrical involute gears and gear pairs - Concepts and geometry.
    """

    name: str
    teeth: int
    normal_module: float
    face_width: float
    pressure_angle: float
    helix_angle: float

    if TYPE_CHECKING:  # a property of each gear

        @property
        def tip_radius(self) -> float:
            """abs(r_a) [mm]."""

        @property
        def form_radius(self) -> float:
            """abs(r_Ff), where fillet and involute meet [mm]."""

        def tooth_thickness_at(self, radius: float) -> float:
            """Transverse tooth thickness at a radius, an arc [mm]."""

    @property
    def tooth_count(self) -> int:
        """abs(z)."""
        return abs(self.teeth)

    @property
    def transverse_module(self) -> float:
        """m_t = m_n/cos(beta) [mm]."""
        return self.normal_module / cos(self.helix_angle)

    @property
    def transverse_pressure_angle(self) -> float:
        """alpha_t, tan(alpha_t) = tan(alpha_n)/cos(beta) [rad]."""
        return atan(tan(self.pressure_angle) / cos(self.helix_angle))

    @property
    def base_helix_angle(self) -> float:
        """beta_b, sin(beta_b) = sin(beta) cos(alpha_n), signed as the helix angle [rad]."""
        return asin(sin(self.helix_angle) * cos(self.pressure_angle))

    @property
    def base_pitch(self) -> float:
        """Transverse base pitch p_et = pi m_t cos(alpha_t) [mm]."""
        return pi * self.transverse_module * cos(self.transverse_pressure_angle)

    @property
    def reference_radius(self) -> float:
        """Reference radius abs(r) = abs(d)/2 = abs(z) m_t/2 [mm]."""
        return 0.5 * self.tooth_count * self.transverse_module

    @property
    def base_radius(self) -> float:
        """abs(r_b) = abs(r) cos(alpha_t) [mm]."""
        return self.reference_radius * cos(self.transverse_pressure_angle)

    def roll_length(self, radius: float) -> float:
        """Roll length of the involute at a radius, sqrt(r^2 - r_b^2) [mm]; zero at the base circle."""
        if radius < self.base_radius * (1.0 - 1e-12):
            raise InputError(
                f"{self.name}: radius {radius:.6g} mm lies inside the base circle, radius {self.base_radius:.6g} mm"
            )
        return sqrt(max(0.0, (radius - self.base_radius) * (radius + self.base_radius)))

    def radius_at_roll_length(self, roll_length: float) -> float:
        """Radius of the involute at a roll length, sqrt(a^2 + r_b^2) [mm]."""
        return hypot(roll_length, self.base_radius)

    def involute_at(self, radius: float) -> float:
        """Involute inv(alpha_r) of the transverse pressure angle at a radius [rad]."""
        tangent = self.roll_length(radius) / self.base_radius
        return tangent - atan(tangent)
