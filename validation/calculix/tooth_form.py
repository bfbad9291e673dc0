"""Transverse form of a spur or helical tooth cut by a rack: involute, tip relief and trochoid, in polar coordinates."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FILLET_SAMPLES = 4001
"""Points of the trochoid between which the half angle is interpolated; the error is below 1e-7 mm."""


@dataclass(frozen=True)
class ToothForm:
    """Spur or helical gear without profile shift, its fillet cut by the rounded tip of the rack.

    Attributes
    ----------
    teeth : int
    module : float [mm]
    pressure_angle : float [rad]
        As the module in the normal section.
    dedendum, rounding : float
        h_fP and rho_fP of the rack, in modules.
    bore_ratio : float
        Bore diameter over root diameter.
    relief : float [mm]
        Tip relief at the tip, parabolic over the roll length, on both sides of the tooth.
    relief_start : float [mm]
        Diameter at which the relief begins; not used without relief.
    thinning : float [mm]
        Material off both sides, all over the tooth, along the normal of the involute: one level of a lead crowning.
    helix_angle : float [rad]

    References
    ----------
    ISO 53:1998 (rack), ISO 21771:2007 (involute); Litvin and Fuentes 2004, Gear Geometry, section 6 (the rack cuts
    where its normal passes through the pitch point).
    """

    teeth: int
    module: float = 3.0
    pressure_angle: float = math.radians(20.0)
    dedendum: float = 1.25
    rounding: float = 0.38
    bore_ratio: float = 0.55
    relief: float = 0.0
    relief_start: float = 0.0
    thinning: float = 0.0
    helix_angle: float = 0.0

    @property
    def pitch_radius(self) -> float:
        """r = z m_n/(2 cos(beta)) [mm]."""
        return 0.5 * self.teeth * self.module / math.cos(self.helix_angle)

    @property
    def transverse_angle(self) -> float:
        """tan(alpha_t) = tan(alpha_n)/cos(beta) [rad]."""
        return math.atan(math.tan(self.pressure_angle) / math.cos(self.helix_angle))

    @property
    def base_radius(self) -> float:
        """r_b = r cos(alpha_t) [mm]."""
        return self.pitch_radius * math.cos(self.transverse_angle)

    @property
    def tip_radius(self) -> float:
        """r_a = r + m [mm]."""
        return self.pitch_radius + self.module

    @property
    def root_radius(self) -> float:
        """r_f = r - h_fP m [mm]."""
        return self.pitch_radius - self.dedendum * self.module

    @property
    def bore_radius(self) -> float:
        """Radius of the bore [mm]."""
        return self.bore_ratio * self.root_radius

    @property
    def pitch(self) -> float:
        """Angular pitch 2 pi/z [rad]."""
        return 2.0 * math.pi / self.teeth

    def half_angle(self, radius: Array | float) -> Array:
        """Half thickness angle of the tooth at radii between root and tip [rad]."""
        radius = np.asarray(radius, dtype=float)
        fillet_radius, fillet_angle = self.fillet
        on_fillet = np.interp(-radius, -fillet_radius, fillet_angle)
        return np.where(radius >= fillet_radius[0], self._flank_half_angle(radius), on_fillet)

    def _flank_half_angle(self, radius: Array) -> Array:
        """psi_b - inv(alpha_r) less the relief seen along the base circle."""
        roll = np.sqrt(np.maximum(radius**2 - self.base_radius**2, 0.0))
        tangent = roll / self.base_radius
        half = math.pi / (2.0 * self.teeth) + math.tan(self.transverse_angle) - self.transverse_angle
        half -= self.thinning / self.base_radius
        return half - (tangent - np.arctan(tangent)) - self._relief_at(roll) / self.base_radius

    def _relief_at(self, roll: Array) -> Array:
        """Relief C_a ((a - a_0)/(a_tip - a_0))^2 beyond its start [mm]."""
        if self.relief == 0.0:
            return np.zeros_like(roll)
        start, tip = (math.sqrt(r**2 - self.base_radius**2) for r in (0.5 * self.relief_start, self.tip_radius))
        return self.relief * np.clip((roll - start) / (tip - start), 0.0, None) ** 2

    @cached_property
    def fillet(self) -> tuple[Array, Array]:
        """Radii (falling) and half angles of the trochoid, from the end of the involute to the root circle.

        ``slope`` is the angle of the normal of the rounding against the rack's reference line, in the normal section:
        alpha where the straight flank ends, pi/2 at its lowest point. The transverse section stretches the rounding
        along the reference line.
        """
        slope = np.linspace(self.pressure_angle, 0.5 * math.pi, FILLET_SAMPLES)
        rho, tip = self.rounding * self.module, self.dedendum * self.module
        centre_depth = tip - rho
        straight_depth = centre_depth + rho * math.sin(self.pressure_angle)
        centre = math.pi / 4 * self.module - straight_depth * math.tan(self.pressure_angle)
        centre -= rho * math.cos(self.pressure_angle)
        depth = centre_depth + rho * np.sin(slope)
        beside = (centre + rho * np.cos(slope)) / math.cos(self.helix_angle)
        lead = depth * math.cos(self.helix_angle) / np.tan(slope)
        rolled = (lead - beside) / self.pitch_radius
        radius = np.hypot(self.pitch_radius - depth, lead)
        space = np.arctan2(lead, self.pitch_radius - depth) - rolled
        return radius, math.pi / self.teeth - space - self.thinning / self.base_radius
