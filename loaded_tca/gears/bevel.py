"""Straight and spiral bevel gears with spherical involute profiles: cones, cone distances, active profiles.

Lengths are in mm, angles in rad. Base and pitch cones share the apex; face and root cones may have their own. Profiles
are described on the unit sphere about the apex, where a tooth is unwound from its base cone: the unwound arc w takes
the place of the roll length.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import acos, asin, atan, atan2, cos, degrees, isclose, log, pi, radians, sin, sqrt, tan

from loaded_tca.errors import GeometryError, InputError, require
from loaded_tca.gears.checks import (
    bore_check,
    face_check,
    half_turn_checks,
    input_checks,
    pair_checks,
    spiral_check,
    teeth_checks,
)
from loaded_tca.gears.cutter_circle import CutterCircle
from loaded_tca.gears.cylindrical_mesh import Room

_EQUAL = 1e-9
_DEDENDUM = 1.25
# In outer modules: the straight blade of a generating tool reaches this deep (ISO 23509:2016, clause 8).
_TOOL_DEPTH = 1.1


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
            (root < pitch, f"root cone, {_degrees(root)}, is not below the pitch cone, {_degrees(pitch)}"),
            (face > pitch, f"face cone, {_degrees(face)}, is not above the pitch cone, {_degrees(pitch)}"),
            owner=self.name,
        )
        self._check_tooth()

    def _check_tooth(self) -> None:
        """Refuse a tooth without toe, flank or tip."""
        if self.face_width >= self.outer_cone_distance:
            raise GeometryError(
                f"{self.name}: face_width {self.face_width:.6g} mm reaches the apex: no face width is left at the toe; "
                f"it must be below the outer cone distance {self.outer_cone_distance:.6g} mm"
            )
        if self.cutter_circle is not None:
            self.cutter_circle.check(self.name, (self.inner_cone_distance, self.outer_cone_distance))
        if self.root_cone_angle <= 0.0:
            raise GeometryError(
                f"{self.name}: the root cone, {_degrees(self.root_cone_angle)}, reaches the axis; raise profile_shift"
                " or teeth"
            )
        largest = 2.0 * self.inner_cone_distance * sin(self.root_cone_angle_at(self.inner_cone_distance))
        if self.bore_diameter is not None and self.bore_diameter >= largest:
            raise InputError(
                f"{self.name}: bore_diameter: {self.bore_diameter:.6g} mm is not below the root diameter at the toe, "
                f"{largest:.6g} mm"
            )
        ends = (self.inner_cone_distance, self.mean_cone_distance, self.outer_cone_distance)
        require(
            (
                ends[0] < ends[1] < ends[2],
                f"calculation_distance: {ends[1]:.6g} mm does not lie on the face, between {ends[0]:.6g} and"
                f" {ends[2]:.6g} mm",
            ),
            owner=self.name,
        )
        highest = max(self.tip_angle_at(distance) for distance in ends)
        face = f"{self.name}: the face cone, {_degrees(highest)},"
        if highest >= pi - self.base_angle:
            raise GeometryError(
                f"{face} lies beyond the end of the spherical involute, {_degrees(pi - self.base_angle)}; reduce "
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
        allowed = f"between 0 and {4.0 * self.mean_cone_distance:.6g} mm"
        require((0.0 <= sine <= 2.0, f"a diameter of {diameter:.6g} mm is not {allowed}"), owner=self.name)
        return asin(sine) if sine <= 1.0 else pi - asin(2.0 - sine)


def _seen_from_apex(angle: float, apex: float, cone_distance: float) -> float:
    """Angle from the apex of the pitch cone of a cone whose own apex lies beyond it [rad]."""
    return angle + asin(apex * sin(angle) / cone_distance) if apex else angle


def _degrees(angle: float) -> str:
    return f"{degrees(angle):.4f} deg"


@dataclass(frozen=True)
class BevelMesh:
    """Two bevel gears whose pitch cones roll on each other; the shaft angle is the sum of their pitch angles.

    Parameters
    ----------
    pinion, wheel : BevelGear
        Of one outer module, face width and pressure angle, with opposite hands; of one mean cone distance and module
        there where both have their calculation points.

    Raises
    ------
    InputError
        If the gears do not fit each other.

    Examples
    --------
    >>> mesh = bevel_mesh((20, 40), outer_module=4.0, face_width=20.0)
    >>> round(mesh.pinion.outer_cone_distance, 4), round(mesh.transverse_contact_ratio, 3)
    (89.4427, 1.714)
    """

    pinion: BevelGear
    wheel: BevelGear

    def __post_init__(self) -> None:
        first, second, shaft_angle = self.pinion, self.wheel, _degrees(self.shaft_angle)
        own_points = None not in (first.calculation_distance, second.calculation_distance)
        of_both = () if own_points else ("outer_module", "face_width")
        rolls = isclose(first.mean_cone_distance, second.mean_cone_distance, rel_tol=_EQUAL)
        modules = [gear.mean_normal_module for gear in (first, second)]
        rolls = rolls and isclose(*modules, rel_tol=_EQUAL)
        pitches = f"{_degrees(first.pitch_angle)} and {_degrees(second.pitch_angle)}"
        require(
            *pair_checks(first, second, of_both, "spiral_angle"),
            (rolls, f"pitch_angle: {pitches} do not roll on each other with {first.teeth}/{second.teeth} teeth"),
            (
                first.cutter_radius == second.cutter_radius,
                f"cutter_radius: {first.cutter_radius} and {second.cutter_radius} mm must be equal",
            ),
            (self.shaft_angle < pi, f"pitch_angle: the shaft angle, {shaft_angle}, is not below 180 deg"),
        )

    @property
    def shaft_angle(self) -> float:
        """Sigma = delta_1 + delta_2 [rad]."""
        return self.pinion.pitch_angle + self.wheel.pitch_angle

    @cached_property
    def active_cones(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """(start, tip) cone angles of the active profile of pinion and wheel at nominal mounting [rad].

        It starts where the tip of the mating gear ends on the flank, or at the form cone if that lies higher.
        """
        pinion, wheel = self.pinion, self.wheel
        starts = [max(arcs) for arcs in self._tip_and_form_arcs]
        return (
            (pinion.cone_angle_at_arc(starts[0]), pinion.tip_angle),
            (wheel.cone_angle_at_arc(starts[1]), wheel.tip_angle),
        )

    @property
    def _line_of_action(self) -> float:
        """Arc of the great circle of contact between the two base cones that it touches [rad]."""
        return sum(gear.unwound_arc(gear.pitch_angle) for gear in (self.pinion, self.wheel))

    @property
    def _tip_and_form_arcs(self) -> list[tuple[float, float]]:
        """Unwound arcs on pinion and wheel where the mating gear's tip ends, and at their own form cones [rad].

        The first one is negative beyond the base cone.
        """
        both_ways = (self.pinion, self.wheel), (self.wheel, self.pinion)
        return [
            (self._line_of_action - mating.unwound_arc(mating.tip_angle), gear.unwound_arc(gear.form_angle))
            for gear, mating in both_ways
        ]

    @property
    def fillet_interference(self) -> tuple[bool, bool]:
        """Whether the mating gear's tip reaches below the form cone of pinion and wheel, into what is no involute."""
        pinion, wheel = (tip < form for tip, form in self._tip_and_form_arcs)
        return pinion, wheel

    @property
    def backlash(self) -> float:
        """Circumferential backlash at the mean pitch circles; negative where the teeth overlap [mm]."""
        gears = self.pinion, self.wheel
        spaces = (pi / gear.teeth - 2.0 * gear.half_thickness_angle for gear in gears)
        radii = (gear.mean_cone_distance * sin(gear.pitch_angle) for gear in gears)
        return sum(radius * space for radius, space in zip(radii, spaces, strict=True))

    @property
    def room(self) -> Room:
        """Room that the whole gears leave each other: at mid-face, above the roots at the toe."""
        pinion, wheel = (self.pinion.mean_cone_distance * (tip - form) for tip, form in self._tip_and_form_arcs)
        return Room(self.backlash, (pinion, wheel), self.tip_clearances)

    @property
    def tip_clearances(self) -> tuple[float, float]:
        """Clearance between the roots of both gears and the mating gear's tip at the toe, across the cones [mm]."""
        both_ways = (self.pinion, self.wheel), (self.wheel, self.pinion)
        pinion, wheel = (
            toe * (self.shaft_angle - gear.root_cone_angle_at(toe) - mating.tip_angle_at(toe))
            for gear, mating in both_ways
            for toe in [max(gear.inner_cone_distance, mating.inner_cone_distance)]
        )
        return pinion, wheel

    @property
    def transverse_contact_ratio(self) -> float:
        """eps_alpha: arc of contact over the base pitch 2 pi sin(delta_b1)/z1, on the sphere."""
        length = self._line_of_action - sum(max(arcs) for arcs in self._tip_and_form_arcs)
        return length * self.pinion.teeth / (2.0 * pi * sin(self.pinion.base_angle))

    @property
    def overlap_ratio(self) -> float:
        """eps_beta: turn of the pinion over which the spiral passes the face, in pitches."""
        gear, circle = self.pinion, self.pinion.cutter_circle
        heel = min(self.pinion.outer_cone_distance, self.wheel.outer_cone_distance)
        toe = max(self.pinion.inner_cone_distance, self.wheel.inner_cone_distance)
        if circle is None:
            turn = abs(tan(gear.spiral_angle)) / sin(gear.pitch_angle) * log(heel / toe)
        else:
            turn = float(circle.turn(heel) - circle.turn(toe)) / sin(gear.pitch_angle)
        return turn * gear.teeth / (2.0 * pi)


def bevel_mesh(
    teeth: tuple[int, int],
    outer_module: float,
    face_width: float,
    *,
    shaft_angle: float = 0.5 * pi,
    pressure_angle: float = radians(20),
    spiral_angle: float = 0.0,
    profile_shifts: tuple[float, float] = (0.0, 0.0),
    face_angles: tuple[float | None, float | None] = (None, None),
    root_angles: tuple[float | None, float | None] = (None, None),
) -> BevelMesh:
    """Pair of bevel gears from numbers of teeth and shaft angle.

    Parameters
    ----------
    teeth : (int, int)
    outer_module, face_width : float [mm]
    shaft_angle : float [rad]
        Sigma, between 0 and pi.
    pressure_angle, spiral_angle : float [rad]
        See :class:`BevelGear`; the spiral angle is that of the pinion, positive for right hand.
    profile_shifts : (float, float)
    face_angles, root_angles : (float or None, float or None) [rad]

    Raises
    ------
    InputError
        If a value is out of range.
    GeometryError
        If a tooth cannot exist.
    """
    require(*half_turn_checks(shaft_angle=shaft_angle))
    pitches, spirals, names = pitch_angles(teeth, shaft_angle), (spiral_angle, -spiral_angle), ("pinion", "wheel")
    members = zip(teeth, pitches, spirals, profile_shifts, face_angles, root_angles, names, strict=True)
    pinion, wheel = (
        BevelGear(count, outer_module, face_width, pitch, pressure_angle, *own) for count, pitch, *own in members
    )
    return BevelMesh(pinion, wheel)
