"""Where the teeth of a spur pair stand and touch, by turning the pinion's flank onto the wheel's."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from validation.calculix.tooth_form import Array, ToothForm

SAMPLES = 20001
"""Points of the wheel's flank among which the one that is in contact first is sought."""


@dataclass(frozen=True)
class ToothPair:
    """Where one tooth pair comes into contact when the pinion alone is turned.

    Attributes
    ----------
    gap : float [mm]
        Way along the pinion's base circle until they touch; negative: the teeth overlap.
    pinion_radius, wheel_radius : float [mm]
    """

    gap: float
    pinion_radius: float
    wheel_radius: float


@dataclass(frozen=True)
class Position:
    """A pair of parallel axes at one pinion angle, its wheel behind by a setback.

    The pinion's axis is the z axis and turns towards +y beside the wheel, whose axis is at x = ``centre_distance``;
    both angles are positive in the sense of motion. Tooth pair 0 touches at the pitch point where both are zero, pair
    +1 comes into mesh after it.

    Attributes
    ----------
    pinion, wheel : ToothForm
    centre_distance : float [mm]
    pinion_angle : float [rad]
    setback : float [mm]
        Angle by which the wheel is behind z1/z2 of the pinion's, times its base radius.
    """

    pinion: ToothForm
    wheel: ToothForm
    centre_distance: float
    pinion_angle: float
    setback: float

    @property
    def wheel_angle(self) -> float:
        """phi2 [rad]."""
        return self.pinion.teeth / self.wheel.teeth * self.pinion_angle - self.setback / self.wheel.base_radius

    def pinion_tooth(self, pair: int = 0) -> float:
        """Polar angle of the middle of the pinion's tooth about its axis [rad]."""
        return self.pinion_angle - _half_at_pitch(self.pinion) - pair * self.pinion.pitch

    def wheel_tooth(self, pair: int = 0) -> float:
        """Polar angle of the middle of the wheel's tooth about its axis [rad]."""
        return math.pi - _half_at_pitch(self.wheel) - self.wheel_angle + pair * self.wheel.pitch

    def touch(self, pair: int) -> ToothPair | None:
        """First touch of a tooth pair; None where no circle of the pinion's flank meets the wheel's."""
        radius = np.linspace(self.wheel.tip_radius, self.wheel.root_radius, SAMPLES)
        angle = self.wheel_tooth(pair) + self.wheel.half_angle(radius)
        x, y = self.centre_distance + radius * np.cos(angle), radius * np.sin(angle)
        reach = np.hypot(x, y)
        meets = (reach <= self.pinion.tip_radius) & (reach >= self.pinion.root_radius)
        if not meets.any():
            return None
        flank = self.pinion_tooth(pair) + self.pinion.half_angle(reach[meets])
        gap = _wrapped(np.arctan2(y, x)[meets] - flank) * self.pinion.base_radius
        first = int(np.argmin(gap))
        return ToothPair(float(gap[first]), float(reach[meets][first]), float(radius[meets][first]))


def _half_at_pitch(form: ToothForm) -> float:
    """Half angle of the unmodified tooth at the pitch circle."""
    return 0.5 * math.pi / form.teeth


def _wrapped(angle: Array) -> Array:
    """Angles within half a turn of zero."""
    return (angle + math.pi) % (2.0 * math.pi) - math.pi
