r"""Straight and spiral bevel gears with spherical involute profiles: cones, cone distances, active profiles.

Lengths are in mm, angles in rad. Base and pitch cones share the apex; face and root cones may have their own. Profiles
are described on the unit sphere about the apex, where a tooth is unwound from its base cone: the unwound arc w takes
the place of the roll length.

The lengthwise curve on the plane of the crown gear may be the circle of a face-milling cutter. With the circle of
radius :math:`r_{c0}` at the spiral angle :math:`\beta_m` of the cone distance R_m,

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
from math import acos, asin, atan, atan2, cos, degrees, inf, pi, radians, sin, sqrt, tan
from typing import Any

import numpy as np

from loaded_tca.errors import GeometryError, InputError, require
from loaded_tca.gears.blank_gear import height_over_pitch_cone
from loaded_tca.gears.checks import (
    bore_check,
    face_check,
    half_turn_checks,
    input_checks,
    spiral_check,
    teeth_checks,
)
from loaded_tca.plain import plain

_DEDENDUM = 1.25
# In outer modules: the straight blade of a generating tool reaches this deep (ISO 23509:2016, clause 8).
_TOOL_DEPTH = 1.1
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
                    f"{owner}: cutter_radius {plain(self.radius, 6)} mm: its circle does not cross the cone distance"
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


def pitch_angles(teeth: tuple[int, int], shaft_angle: float) -> tuple[float, float]:
    r"""Pitch angles of pinion and wheel, :math:`\tan\delta_1 = \sin\Sigma/(z_2/z_1 + \cos\Sigma)` [rad].

    Parameters
    ----------
    teeth : (int, int)
    shaft_angle : float [rad]
        Sigma, between 0 and pi.

    Examples
    --------
    >>> [round(degrees(delta), 4) for delta in pitch_angles((39, 32), radians(90))]
    [50.6307, 39.3693]
    """
    pinion = atan2(teeth[0] * sin(shaft_angle), teeth[1] + teeth[0] * cos(shaft_angle))
    return pinion, shaft_angle - pinion


@dataclass(frozen=True)
class BevelGear:
    """Bevel gear with spherical involute teeth, straight, along a logarithmic spiral or the circle of a cutter.

    Parameters
    ----------
    teeth : int
        Number of teeth z, at least 3.
    outer_module : float [mm]
        m_et, transverse, at the heel.
    face_width : float [mm]
        b, along the pitch cone.
    pitch_angle : float [rad]
        delta, between 0 and pi; see :func:`pitch_angles`.
    pressure_angle : float [rad]
        alpha, transverse, on the pitch cone.
    spiral_angle : float [rad]
        beta_m on the pitch cone, right hand positive, left hand negative; at every cone distance, or with a cutter
        radius at R_m.
    profile_shift : float
        Coefficient x, in outer transverse modules.
    face_angle, root_angle : float [rad], optional
        delta_a and delta_f; None: pitch angle + atan((1 + x) m_et/R_e) and pitch angle - atan((1.25 - x) m_et/R_e).
    name : str
        What messages call this gear.
    bore_diameter : float [mm], optional
        For the compliance of the body.
    face_apex, root_apex : float [mm]
        How far the apexes of face and root cone lie beyond that of the pitch cone, away from the teeth, as
        ``BlankGear`` has them.
    mean_normal_thickness : float [mm], optional
        s_mn on the pitch cone at R_m; None: as the profile shift makes it.
    calculation_distance : float [mm], optional
        R_m, of the calculation point; None: in the middle of the face.
    cutter_radius : float [mm], optional
        r_c0, whose circle the teeth follow lengthwise, with beta_m at R_m; None: a logarithmic spiral.

    Raises
    ------
    InputError
        If values are out of range; every one is told.
    GeometryError
        If the face width reaches the apex, the root cone reaches the axis, or the tooth ends below the face cone.

    References
    ----------
    ISO 23509:2016, Bevel and hypoid gear geometry (cones and cone distances).

    Examples
    --------
    >>> gear = BevelGear(teeth=39, outer_module=5.0, face_width=20.0, pitch_angle=pitch_angles((39, 32), pi / 2)[0])
    >>> [round(degrees(angle), 4) for angle in (gear.base_angle, gear.tip_angle)]
    [46.5897, 52.901]
    """

    teeth: int
    outer_module: float
    face_width: float
    pitch_angle: float
    pressure_angle: float = radians(20)
    spiral_angle: float = 0.0
    profile_shift: float = 0.0
    face_angle: float | None = None
    root_angle: float | None = None
    name: str = "gear"
    bore_diameter: float | None = None
    face_apex: float = 0.0
    root_apex: float = 0.0
    mean_normal_thickness: float | None = None
    calculation_distance: float | None = None
    cutter_radius: float | None = None

    def __post_init__(self) -> None:
        require(
            *teeth_checks(self.teeth),
            *input_checks(self, ("outer_module", "face_width"), ("profile_shift",)),
            bore_check(self.bore_diameter),
            *half_turn_checks(pitch_angle=self.pitch_angle, face_angle=self.face_angle, root_angle=self.root_angle),
            spiral_check("spiral_angle", self.spiral_angle),
            face_check(self.face_width, self.outer_module, "outer_module"),
            owner=self.name,
        )
        root, pitch, face = self.root_cone_angle, self.pitch_angle, self.tip_angle
        require(
            (root < pitch, f"root cone, {in_degrees(root)}, is not below the pitch cone, {in_degrees(pitch)}"),
            (face > pitch, f"face cone, {in_degrees(face)}, is not above the pitch cone, {in_degrees(pitch)}"),
            owner=self.name,
        )
        self._check_tooth()

    def _check_tooth(self) -> None:
        """Refuse a tooth without toe, flank or tip."""
        if self.face_width >= self.outer_cone_distance:
            raise GeometryError(
                f"{self.name}: face_width {plain(self.face_width, 6)} mm reaches the apex: no face width is left at "
                f"the toe; it must be below the outer cone distance {plain(self.outer_cone_distance, 6)} mm"
            )
        if self.cutter_circle is not None:
            self.cutter_circle.check(self.name, (self.inner_cone_distance, self.outer_cone_distance))
        if self.root_cone_angle <= 0.0:
            raise GeometryError(
                f"{self.name}: the root cone, {in_degrees(self.root_cone_angle)}, reaches the axis; raise profile_shift"
                " or teeth"
            )
        largest = 2.0 * self.inner_cone_distance * sin(self.root_cone_angle_at(self.inner_cone_distance))
        if self.bore_diameter is not None and self.bore_diameter >= largest:
            raise InputError(
                f"{self.name}: bore_diameter: {plain(self.bore_diameter, 6)} mm is not below the root diameter at the "
                f"toe, {plain(largest, 6)} mm"
            )
        ends = (self.inner_cone_distance, self.mean_cone_distance, self.outer_cone_distance)
        require(
            (
                ends[0] < ends[1] < ends[2],
                f"calculation_distance: {plain(ends[1], 6)} mm does not lie on the face, between {plain(ends[0], 6)} "
                f"and {plain(ends[2], 6)} mm",
            ),
            owner=self.name,
        )
        highest = max(self.tip_angle_at(distance) for distance in ends)
        face = f"{self.name}: the face cone, {in_degrees(highest)},"
        if highest >= pi - self.base_angle:
            raise GeometryError(
                f"{face} lies beyond the end of the spherical involute, {in_degrees(pi - self.base_angle)}; reduce "
                "face_angle or profile_shift"
            )
        if self.half_thickness_angle_at(highest) <= 0.0:
            raise GeometryError(f"{face} cannot be reached: pointed tooth; reduce face_angle or profile_shift")

    @property
    def outer_cone_distance(self) -> float:
        """R_e = z m_et/(2 sin delta) [mm]."""
        return 0.5 * self.teeth * self.outer_module / sin(self.pitch_angle)

    @property
    def inner_cone_distance(self) -> float:
        """R_i = R_e - b, at the toe [mm]."""
        return self.outer_cone_distance - self.face_width

    @property
    def mean_cone_distance(self) -> float:
        """R_m, of the calculation point: R_e - b/2 unless it is given [mm]."""
        if self.calculation_distance is not None:
            return self.calculation_distance
        return self.outer_cone_distance - 0.5 * self.face_width

    @property
    def cutter_circle(self) -> CutterCircle | None:
        """Circle that the teeth follow lengthwise; None: a logarithmic spiral."""
        if self.cutter_radius is None or self.spiral_angle == 0.0:
            return None
        return CutterCircle(self.mean_cone_distance, abs(self.spiral_angle), self.cutter_radius)

    @property
    def mean_normal_module(self) -> float:
        """m_mn = m_et cos(beta_m) R_m/R_e [mm]."""
        return self.outer_module * cos(self.spiral_angle) * self.mean_cone_distance / self.outer_cone_distance

    @property
    def normal_pressure_angle(self) -> float:
        """Mean normal pressure angle alpha_n on the pitch cone, tan(alpha_n) = tan(alpha) cos(beta_m) [rad]."""
        return atan(tan(self.pressure_angle) * cos(self.spiral_angle))

    @property
    def mean_addendum(self) -> float:
        """h_am, normal to the pitch cone at R_m [mm]."""
        angle = self.tip_angle if self.face_angle is None else self.face_angle
        return height_over_pitch_cone(self.pitch_angle, (angle, self.face_apex), self.mean_cone_distance)

    @property
    def mean_dedendum(self) -> float:
        """h_fm, normal to the pitch cone at R_m [mm]."""
        angle = self.root_cone_angle if self.root_angle is None else self.root_angle
        return -height_over_pitch_cone(self.pitch_angle, (angle, self.root_apex), self.mean_cone_distance)

    @property
    def base_angle(self) -> float:
        """delta_b, sin(delta_b) = sin(delta) cos(alpha) [rad]."""
        return asin(sin(self.pitch_angle) * cos(self.pressure_angle))

    @property
    def mean_base_radius(self) -> float:
        """R_m sin(delta_b), the radius of the base cone at the mean cone distance [mm]."""
        return self.mean_cone_distance * sin(self.base_angle)

    @property
    def tip_angle(self) -> float:
        """Face angle delta_a, as given or standard; of a cone with its own apex the angle seen at mid-face [rad]."""
        return self.tip_angle_at(self.mean_cone_distance)

    def tip_angle_at(self, cone_distance: float) -> float:
        """Angle under which the face cone is seen from the apex at a cone distance [rad]."""
        angle = self.face_angle
        if angle is None:
            angle = self.pitch_angle + atan((1.0 + self.profile_shift) * self.outer_module / self.outer_cone_distance)
        return _seen_from_apex(angle, self.face_apex, cone_distance)

    @property
    def root_cone_angle(self) -> float:
        """Root angle delta_f, as given or standard; of a cone with its own apex the angle seen at mid-face [rad]."""
        return self.root_cone_angle_at(self.mean_cone_distance)

    def root_cone_angle_at(self, cone_distance: float) -> float:
        """Angle under which the root cone is seen from the apex at a cone distance [rad]."""
        angle = self.root_angle
        if angle is None:
            depth = (_DEDENDUM - self.profile_shift) * self.outer_module
            angle = self.pitch_angle - atan(depth / self.outer_cone_distance)
        return _seen_from_apex(angle, self.root_apex, cone_distance)

    @property
    def cones(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Form and face cone of the flank: angle [rad] and how far the apex lies beyond that of the pitch cone [mm].

        The form cone is the root cone, or the base cone where that lies higher; where they cross along the face it is
        the cone through the higher one at toe and heel.
        """
        face = self.tip_angle if self.face_angle is None else self.face_angle
        root = self.root_cone_angle if self.root_angle is None else self.root_angle
        ends = self.inner_cone_distance, self.outer_cone_distance
        above = [self.root_cone_angle_at(distance) >= self.base_angle for distance in ends]
        if all(above):
            return (root, self.root_apex), (face, self.face_apex)
        if not any(above):
            return (self.base_angle, 0.0), (face, self.face_apex)
        toe, heel = (
            (distance * sin(angle), distance * cos(angle))
            for distance in ends
            for angle in [max(self.root_cone_angle_at(distance), self.base_angle)]
        )
        form = atan2(heel[0] - toe[0], heel[1] - toe[1])
        return (form, toe[0] / tan(form) - toe[1]), (face, self.face_apex)

    @property
    def form_angle(self) -> float:
        """Cone on which the flank ends at the root: the root cone, never below the base cone [rad]."""
        return max(self.root_cone_angle, self.base_angle)

    @property
    def smallest_profile_shift(self) -> float:
        r"""Profile shift below which a generating crown gear undercuts this gear.

        The tip of the tool, 1.1 m_et deep, meets the line of action beyond its end on the base cone where

        .. math:: \sin\theta > \sin\alpha \sin w, \quad \tan\theta = (1.1 - x) m_{et}/R_e

        with w the unwound arc at the pitch cone, at most a quarter turn (from a pitch angle of 90 deg on, a tool meets
        no end of the line of action).
        """
        arc = min(self.unwound_arc(self.pitch_angle), 0.5 * pi)
        deepest = tan(asin(sin(self.pressure_angle) * sin(arc)))
        return _TOOL_DEPTH - deepest * self.outer_cone_distance / self.outer_module

    @property
    def is_undercut(self) -> bool:
        """Whether a generating crown gear would cut into the flank; flanks here are never cut short by it."""
        return self.profile_shift < self.smallest_profile_shift

    @property
    def half_thickness_angle(self) -> float:
        """Half tooth thickness angle on the pitch cone, as given or (pi/2 + 2 x tan alpha)/z [rad]."""
        if self.mean_normal_thickness is not None:
            diameter = 2.0 * self.mean_cone_distance * sin(self.pitch_angle)
            return self.mean_normal_thickness / (cos(self.spiral_angle) * diameter)
        return (0.5 * pi + 2.0 * self.profile_shift * tan(self.pressure_angle)) / self.teeth

    def half_thickness_angle_at(self, cone_angle: float) -> float:
        """Half tooth thickness angle on a cone; the same at every cone distance [rad]."""
        return self.half_thickness_angle + self._involute(self.pitch_angle) - self._involute(cone_angle)

    def _involute(self, cone_angle: float) -> float:
        arc, base = self.unwound_arc(cone_angle), sin(self.base_angle)
        return arc / base - atan2(sin(arc), base * cos(arc))

    def unwound_arc(self, cone_angle: float) -> float:
        """Arc w that is unwound from the base cone, cos u = cos(delta_b) cos(w); zero at the base cone [rad]."""
        sine, base = sin(cone_angle), sin(self.base_angle)
        return atan2(sqrt(max(0.0, (sine - base) * (sine + base))), cos(cone_angle))

    def cone_angle_at_arc(self, arc: float) -> float:
        """Cone angle u at an unwound arc w [rad]."""
        return acos(cos(self.base_angle) * cos(arc))

    def diameter_at(self, cone_angle: float) -> float:
        """Diameter 2 R_m sin u of a cone at R_m [mm]; beyond 90 deg 2 R_m (2 - sin u), so that it grows."""
        sine = sin(cone_angle)
        return 2.0 * self.mean_cone_distance * (sine if cone_angle <= 0.5 * pi else 2.0 - sine)

    def cone_angle_at_diameter(self, diameter: float) -> float:
        """Cone angle of a diameter as :meth:`diameter_at` counts it [rad]."""
        sine = 0.5 * diameter / self.mean_cone_distance
        allowed = f"between 0 and {plain(4.0 * self.mean_cone_distance, 6)} mm"
        require((0.0 <= sine <= 2.0, f"a diameter of {plain(diameter, 6)} mm is not {allowed}"), owner=self.name)
        return asin(sine) if sine <= 1.0 else pi - asin(2.0 - sine)


def _seen_from_apex(angle: float, apex: float, cone_distance: float) -> float:
    """Angle from the apex of the pitch cone of a cone whose own apex lies beyond it [rad]."""
    return angle + asin(apex * sin(angle) / cone_distance) if apex else angle


def in_degrees(angle: float) -> str:
    """An angle [rad] as messages have it."""
    return f"{degrees(angle):.4f} deg"
