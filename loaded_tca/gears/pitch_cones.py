r"""Pitch cones of hypoid pairs after ISO 23509, method 1, and the limit pressure angle and curvature of their flanks.

Lengths are in mm, angles in rad.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import asin, atan, atan2, cos, inf, pi, sin, sqrt, tan

import numpy as np

from loaded_tca.arrays import real
from loaded_tca.errors import GeometryError, InputError, require
from loaded_tca.gears.checks import half_turn_checks, spiral_check, teeth_checks
from loaded_tca.gears.hypoid import Both, HypoidCones
from loaded_tca.plain import plain
from loaded_tca.roots import find_root

ETA_STEPS = 60
"""Parts of the range of the wheel offset angle in which method 1 is looked for."""


@dataclass(frozen=True)
class PitchConeParameters:
    """What every method of ISO 23509 finds: the pitch cones, the spiral angles at P, and where P lies on the face.

    Attributes
    ----------
    cones : HypoidCones
    spiral_angles : (float, float) [rad]
        beta_m1, beta_m2.
    face_width_factor : float
        c_be2: part of the wheel's face width from P to the heel.
    face_width, cutter_radius : float [mm], optional
        b_2 and r_c0 that the cones were found with, which blanks on them have, too; None: not known, as of a drawing.
    """

    cones: HypoidCones
    spiral_angles: Both
    face_width_factor: float
    face_width: float | None = None
    cutter_radius: float | None = None


def pitch_cones_by_method_1(
    teeth: tuple[int, int],
    offset: float,
    wheel_diameter: float,
    face_width: float,
    pinion_spiral_angle: float,
    cutter_radius: float,
    shaft_angle: float = 0.5 * pi,
) -> PitchConeParameters:
    r"""Pitch cones of a face-milled hypoid pair after method 1 of ISO 23509.

    Of all pitch cones of such a pair those are taken whose limit radius of curvature is the radius of the cutter, so
    that the flanks of both sides are curved alike lengthwise. The standard ends its iteration at 1 %; here it ends with
    the last digits.

    Parameters
    ----------
    teeth : (int, int)
        z1, z2.
    offset : float [mm]
        a; positive: the pinion follows the hand of the wheel.
    wheel_diameter : float [mm]
        d_e2, outer pitch diameter.
    face_width : float [mm]
        b_2.
    pinion_spiral_angle : float [rad]
        beta_m1, wanted; what is reached differs by hundredths of a degree.
    cutter_radius : float [mm]
        r_c0.
    shaft_angle : float [rad]
        Sigma.

    Returns
    -------
    PitchConeParameters

    Raises
    ------
    InputError
        If values are out of range, or the offset is 0: without one the cones follow from the teeth.
    GeometryError
        If there are no such cones.

    References
    ----------
    ISO 23509:2016, 6.2.2, formulas 8 to 41.

    Examples
    --------
    The second pair of annex F:

    >>> from math import degrees, radians
    >>> parameters = pitch_cones_by_method_1((13, 42), 15.0, 170.0, 30.0, radians(50), 63.5)
    >>> [round(degrees(angle), 2) for angle in parameters.cones.pitch_angles]
    [21.29, 68.32]
    """
    lengths = {"wheel_diameter": wheel_diameter, "face_width": face_width, "cutter_radius": cutter_radius}
    require(
        *teeth_checks(*teeth),
        *((0.0 < real(value) < inf, f"{name}: {value} is not positive and finite") for name, value in lengths.items()),
        *half_turn_checks(shaft_angle=shaft_angle),
        spiral_check("pinion_spiral_angle", pinion_spiral_angle),
        (
            0.0 < abs(real(offset)) < inf,
            f"offset: {offset} mm; without an offset cones follow from the teeth (method 0)",
        ),
    )
    method = _MethodOne(teeth, offset, wheel_diameter, face_width, pinion_spiral_angle, cutter_radius, shaft_angle)
    return method.solved()


@dataclass(frozen=True)
class _MethodOne:
    """Formulas 8 to 41, over the wheel offset angle eta in the axial plane."""

    teeth: tuple[int, int]
    offset: float
    wheel_diameter: float
    face_width: float
    spiral: float
    cutter_radius: float
    shaft_angle: float

    @cached_property
    def ratio(self) -> float:
        return self.teeth[1] / self.teeth[0]

    @property
    def departure(self) -> float:
        """Of the shaft angle from 90 deg."""
        return self.shaft_angle - 0.5 * pi

    @cached_property
    def start(self) -> tuple[float, float, float, float]:
        """Wheel radius, hypoid dimension factor, approximate pinion radius, approximate eta."""
        turn, u = self.departure, self.ratio
        angle = atan2(u * cos(turn), 1.2 * (1.0 - u * sin(turn)))
        radius = 0.5 * (self.wheel_diameter - self.face_width * sin(angle))
        sine = self.offset * sin(angle) / radius
        if not abs(sine) < 1.0:
            raise InputError(
                f"offset: {plain(self.offset, 6)} mm is too large for a wheel of {plain(self.wheel_diameter, 6)} mm; "
                f"allowed below {plain(radius / sin(angle), 6)} mm"
            )
        factor = tan(self.spiral) * sine + sqrt(1.0 - sine**2)
        pinion = radius * factor / u
        eta = atan(self.offset / (radius * (tan(angle) * cos(turn) - sin(turn)) + pinion))
        return radius, factor, pinion, eta

    def cones(self, eta: float) -> tuple[HypoidCones, Both]:
        """Cones and spiral angles at eta; ValueError where there are none."""
        turn, (radius, factor, approximate, _) = self.departure, self.start

        def angles(sine: float) -> tuple[float, float, float]:
            """Offset angle in the axial plane, pitch angle of the pinion, offset angle in the pitch plane."""
            axial = asin(sine)
            pitch = atan(sin(eta) / (tan(axial) * cos(turn)) + tan(turn) * cos(eta))
            return axial, pitch, asin(sin(axial) * cos(turn) / cos(pitch))

        sine = (self.offset - approximate * sin(eta)) / radius
        _, _, zeta = angles(sine)
        widening = sin(zeta) * tan(self.spiral) - (factor - cos(zeta))
        increment = radius * widening / self.ratio
        axial, first, zeta = angles(sine - increment / radius * sin(eta))
        pinion = atan((factor + widening - cos(zeta)) / sin(zeta))
        second = atan2(sin(axial) / cos(turn) + cos(axial) * tan(turn) * tan(eta), tan(eta))
        if second <= 0.0:
            second += pi
        distances = (approximate + increment) / sin(first), radius / sin(second)
        return HypoidCones((first, second), distances, zeta), (pinion, pinion - zeta)

    def bend(self, eta: float) -> float:
        """Limit curvature less that of the cutter [1/mm]; NaN where there are no cones."""
        try:
            cones, spirals = self.cones(eta)
        except (ValueError, ZeroDivisionError, InputError):
            return float("nan")
        return limit_curvature(cones, spirals) - 1.0 / self.cutter_radius

    def solved(self) -> PitchConeParameters:
        eta = _nearest_root(self.bend, self.start[3])
        if eta is None:
            raise GeometryError(
                f"no pitch cones of method 1: no limit radius of curvature is {plain(self.cutter_radius, 6)} mm with "
                f"an offset of {plain(self.offset, 6)} mm; change cutter_radius, pinion_spiral_angle or offset"
            )
        cones, spirals = self.cones(eta)
        outer = 0.5 * self.wheel_diameter / sin(cones.pitch_angles[1])
        factor = (outer - cones.mean_cone_distances[1]) / self.face_width
        return PitchConeParameters(cones, spirals, factor, self.face_width, self.cutter_radius)


def _nearest_root(function: Callable[[float], float], start: float) -> float | None:
    """Root nearest to a start, between a tenth of it and three times; None if there is none."""
    places = start * np.geomspace(0.1, 3.0, ETA_STEPS)
    values = np.array([function(place) for place in places])
    rows = np.flatnonzero(values[1:] * values[:-1] <= 0.0)
    roots = [find_root(function, places[row], places[row + 1]) for row in rows]
    return min(roots, key=lambda root: abs(root - start), default=None)


def limit_pressure_angle(cones: HypoidCones, spiral_angles: Both) -> float:
    r"""Limit pressure angle alpha_lim: flanks inclined so have no common relative curvature across P [rad].

    .. math:: \tan\alpha_{lim} = -\frac{\tan\delta_1 \tan\delta_2}{\cos\zeta_{mp}}
              \frac{R_{m1} \sin\beta_{m1} - R_{m2} \sin\beta_{m2}}{R_{m1} \tan\delta_1 + R_{m2} \tan\delta_2}

    References
    ----------
    ISO 23509:2016, formula 117.

    Examples
    --------
    >>> from math import degrees, radians
    >>> parameters = pitch_cones_by_method_1((13, 42), 15.0, 170.0, 30.0, radians(50), 63.5)
    >>> round(degrees(limit_pressure_angle(parameters.cones, parameters.spiral_angles)), 2)
    -2.25
    """
    (first, second), (pinion, wheel) = (tan(angle) for angle in cones.pitch_angles), cones.mean_cone_distances
    across = pinion * sin(spiral_angles[0]) - wheel * sin(spiral_angles[1])
    return -atan(first * second / cos(cones.offset_angle) * across / (pinion * first + wheel * second))


def limit_curvature(cones: HypoidCones, spiral_angles: Both) -> float:
    r"""Limit curvature 1/rho_lim of the teeth lengthwise, in the pitch plane [1/mm].

    .. math:: \frac{1}{\varrho_{lim}} = \cos\alpha_{lim}
              \frac{-\tan\alpha_{lim} \left(\frac{\tan\beta_{m1}}{R_{m1} \tan\delta_1}
              + \frac{\tan\beta_{m2}}{R_{m2} \tan\delta_2}\right)
              + \frac{1}{R_{m1} \cos\beta_{m1}} - \frac{1}{R_{m2} \cos\beta_{m2}}}{\tan\beta_{m1} - \tan\beta_{m2}}

    References
    ----------
    ISO 23509:2016, formula 33.
    """
    limit = limit_pressure_angle(cones, spiral_angles)
    leaning = lengthwise = 0.0
    for sign, angle, distance, spiral in zip(
        (1.0, -1.0), cones.pitch_angles, cones.mean_cone_distances, spiral_angles, strict=True
    ):
        leaning += tan(spiral) / (distance * tan(angle))
        lengthwise += sign / (distance * cos(spiral))
    return cos(limit) * (lengthwise - tan(limit) * leaning) / (tan(spiral_angles[0]) - tan(spiral_angles[1]))
