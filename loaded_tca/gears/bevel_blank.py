r"""Blanks of straight, spiral and face-milled bevel gears: cones, depths, thicknesses and limits (ISO 23509).

Lengths are in mm, angles in rad; axes that meet (no hypoid offset), any shaft angle. Unlike the cones of
:mod:`loaded_tca.gears.bevel`, face and root cones need not share the apex of the pitch cones. A blank is what a
face-milled pair is cut from: one :class:`BevelBlank` holds both, each gear's numbers are in :mod:`.blank_gear`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import asin, atan, cos, degrees, inf, isclose, pi, radians, sin, tan
from typing import Any, Literal, get_args

from loaded_tca.arrays import GEARS
from loaded_tca.errors import GeometryError, require
from loaded_tca.gears.bevel import pitch_angles
from loaded_tca.gears.blank_gear import (
    SECTIONS,
    BlankGear,
    BlankPair,
    Triple,
    cutter_sine,
    depth_angles_check,
    taper_check,
    virtual_contact_ratios,
    virtual_curvature,
)
from loaded_tca.gears.checks import LARGEST_SPIRAL_ANGLE, half_turn_checks, input_checks, teeth_checks
from loaded_tca.plain import plain

Taper = Literal["standard", "uniform", "duplex", "modified"]

# The straight blade of a tool reaches this much deeper than the mating gear's tip (ISO 23509, clause 8).
_TOOL_DEPTH = 1.1
# "modified" taper: the most by which the dedendum angles may exceed the standard ones (ISO 23509, annex C.5).
_LARGEST_TAPER = 1.3
# Part by which rounded angles of a drawing may miss the sum of a duplex taper: half a minute of 8 deg.
_ROUNDED = 1e-3
# Part of the face width that the overlap of ISO 10300-1 counts.
_EFFECTIVE_WIDTH = 0.85

BacklashKind = Literal["outer_normal", "outer_transverse", "mean_normal", "mean_transverse"]

Cones = tuple[tuple[float, float] | None, tuple[float, float] | None]
"""Face and root cone of a gear: angle [rad] and how far the apex lies beyond the crossing point [mm]."""
NO_CONES: Cones = (None, None)


@dataclass(frozen=True)
class BevelBlank(BlankPair):
    r"""Blanks of two bevel gears on axes that meet.

    The profile shifts are opposite, the wheel's is :math:`-x_{hm}`. Face cones run parallel to the mating gear's root
    cones (:math:`\theta_{a1} = \theta_{f2}`, :math:`\theta_{a2} = \theta_{f1}`), so that the clearance is the same
    along the face. How the depth falls from heel to toe:

    - "standard": :math:`\tan\theta_f = h_{fm}/R_m`, root cones to the pitch apex;
    - "uniform": no taper, all cones parallel;
    - "duplex": constant slot width for a circular cutter,
      :math:`\theta_{f1} + \theta_{f2} = \frac{\pi m_{et}}{2 R_e \tan\alpha_n \cos\beta_m}
      (1 - R_m \sin\beta_m/r_{c0})`, shared out by the mating gear's mean addendum in the working depth;
    - "modified": like duplex, but the sum at most 1.3 times the standard one.

    Parameters
    ----------
    teeth : (int, int)
        z1, z2, at least 3.
    outer_module : float [mm]
        m_et, transverse, at the heel; see :meth:`from_wheel_diameter` for d_e2 instead.
    face_width : float [mm]
        b, along the pitch cone; of the wheel where the pinion has another.
    shaft_angle : float [rad]
        Sigma, between 0 and pi.
    pressure_angle : float [rad]
        alpha_n, normal.
    spiral_angle : float [rad]
        beta_m at mid-face, not negative: the hand does not enter.
    cutter_radius : float [mm], optional
        r_c0 of a face-milling cutter; None: the spiral angle is the same along the face.
    profile_shift : float
        x_hm of the pinion, in mean normal modules.
    thickness_modification : float
        x_smn of the pinion, in mean normal modules; thickens its tooth by 2 x_smn m_mn and thins the wheel's.
    addendum_factor, dedendum_factor : float
        k_hap and k_hfp of the basic crown gear.
    outer_normal_backlash : float [mm]
        j_en, taken from both teeth in equal parts.
    taper : {"standard", "uniform", "duplex", "modified"}
    wheel_angles : (float, float) [rad], optional
        theta_a2 and theta_f2 instead of those of the taper.
    allow_undercut : bool
        Accept undercut teeth, for members that are not generated.
    pinion_face_width : float [mm], optional
        b1, where it is not b.
    outer_share : float
        c_be2, part of either face width that lies beyond the calculation point R_m, towards the heel.
    cones : ((float, float) or None, (float, float) or None) of pinion and wheel [rad], [mm]
        Face and root cone of a drawing, angle and t_z, instead of those that follow.

    Raises
    ------
    InputError
        If values are out of range; every one is told.
    GeometryError
        If no face is left at the toe, the cutter does not reach over the face, a tooth or a slot is pointed, depth is
        missing, or teeth are undercut.

    References
    ----------
    ISO 23509:2016, Bevel and hypoid gear geometry: clauses 6.2.1 (method 0), 7 and 8, annex C.5.

    Examples
    --------
    The spiral bevel pair of annex F.2:

    >>> blank = BevelBlank.from_wheel_diameter(
    ...     (14, 39), 176.893, 25.4, spiral_angle=radians(35), cutter_radius=114.3, profile_shift=0.505, taper="duplex"
    ... )
    >>> round(blank.mean_cone_distance, 3), round(blank.mean_normal_module, 4)
    (81.273, 3.2133)
    >>> [round(degrees(angle), 2) for angle in (blank.pinion.face_angle, blank.pinion.root_angle)]
    [26.24, 17.61]
    """

    teeth: tuple[int, int]
    outer_module: float
    face_width: float
    shaft_angle: float = 0.5 * pi
    pressure_angle: float = radians(20)
    spiral_angle: float = 0.0
    cutter_radius: float | None = None
    profile_shift: float = 0.0
    thickness_modification: float = 0.0
    addendum_factor: float = 1.0
    dedendum_factor: float = 1.25
    outer_normal_backlash: float = 0.0
    taper: Taper = "standard"
    wheel_angles: tuple[float, float] | None = None
    allow_undercut: bool = False
    pinion_face_width: float | None = None
    outer_share: float = 0.5
    cones: tuple[Cones, Cones] = (NO_CONES, NO_CONES)

    @classmethod
    def from_wheel_diameter(
        cls, teeth: tuple[int, int], wheel_diameter: float, face_width: float, **options: Any
    ) -> BevelBlank:
        """Blanks from the wheel's outer pitch diameter d_e2 = z2 m_et [mm]; options: every other parameter."""
        return cls(teeth, wheel_diameter / max(teeth[1], 1), face_width, **options)

    def with_backlash(self, backlash: float, kind: BacklashKind) -> BevelBlank:
        """These blanks with a backlash j_en, j_et2, j_mn or j_mt2 [mm] (ISO 23509:2016, formulas 201 to 204)."""
        return replace(self, outer_normal_backlash=backlash / self._backlash_ratios[kind])

    @property
    def backlashes(self) -> dict[BacklashKind, float]:
        """j_en, j_et2, j_mn and j_mt2 [mm]."""
        return {kind: ratio * self.outer_normal_backlash for kind, ratio in self._backlash_ratios.items()}

    @property
    def _backlash_ratios(self) -> dict[BacklashKind, float]:
        """Backlashes over j_en."""
        outer = cos(self.spiral_angle_at(self.outer_cone_distance))
        to_mean = self.mean_cone_distance / (self.outer_cone_distance * outer)
        return {
            "outer_normal": 1.0,
            "outer_transverse": 1.0 / (cos(self.pressure_angle) * outer),
            "mean_normal": cos(self.spiral_angle) * to_mean,
            "mean_transverse": to_mean / cos(self.pressure_angle),
        }

    def __post_init__(self) -> None:
        self._check_inputs()
        self._check_face()
        self._check_cones()
        for gear in (self.pinion, self.wheel):
            gear.check(self.allow_undercut)
        for gear, clearances in zip((self.pinion, self.wheel), self.clearances, strict=True):
            if not min(clearances) > 0.0:
                place = SECTIONS[clearances.index(min(clearances))]
                raise GeometryError(
                    f"{gear.name}: the clearance above its root is {min(clearances):.4f} mm at the {place}: tips of the"
                    " mating gear would cut into it; its root cone or the mating face cone is not that of this pair"
                )

    def _check_inputs(self) -> None:
        """Refuse values out of their own ranges, then depths and tapers that do not go together."""
        lengths = "outer_module", "face_width", "cutter_radius", "pinion_face_width"
        positive = *lengths, "addendum_factor", "dedendum_factor"
        backlash, spiral = self.outer_normal_backlash, self.spiral_angle
        cone_angles = [cone[0] for both in self.cones for cone in both if cone is not None]

        require(
            *teeth_checks(*self.teeth),
            *input_checks(self, positive, ("profile_shift", "thickness_modification")),
            (0.0 <= backlash < inf, f"outer_normal_backlash: {backlash} mm is negative or not finite"),
            *half_turn_checks(shaft_angle=self.shaft_angle),
            (
                0.0 <= spiral < LARGEST_SPIRAL_ANGLE,
                f"spiral_angle: {plain(spiral, 6)} rad is not from 0 to below 1.047 rad (60 deg)",
            ),
            (0.0 < self.outer_share < 1.0, f"outer_share: {self.outer_share} is not between 0 and 1"),
            *(check for angle in cone_angles for check in half_turn_checks(cones=angle)),
            depth_angles_check(self.wheel_angles),
        )
        smallest = self.mean_cone_distance * sin(spiral)
        any_cutter = self.taper not in ("duplex", "modified") or self.wheel_angles is not None
        require(
            (
                self.dedendum_factor > self.addendum_factor,
                f"dedendum_factor: {self.dedendum_factor} is not above addendum_factor {self.addendum_factor}: no"
                " clearance is left, tips of the mating gear would cut into the root",
            ),
            taper_check(self.taper, get_args(Taper)),
            (
                any_cutter or (self.cutter_radius is not None and self.cutter_radius >= smallest),
                f"cutter_radius: {self.cutter_radius} mm; a {self.taper} taper needs at least R_m sin(beta_m) ="
                f" {smallest:.4f} mm",
            ),
        )

    def _check_face(self) -> None:
        """Refuse faces without toe, or beyond the reach of the cutter."""
        for width, distances in zip(self.face_widths[::-1], self._both_distances[::-1], strict=True):
            if not distances[0] > 0.0:
                raise GeometryError(
                    f"face_width {plain(width, 6)} mm reaches the apex: no face is left at the toe; it must be below"
                    f" the outer cone distance {plain(distances[2], 6)} mm"
                )
        both = [pair for distances in self._both_distances[::-1] for pair in zip(SECTIONS, distances, strict=True)]
        for place, distance in both:
            if not abs(self._sine_of_spiral(distance)) < 1.0:
                raise GeometryError(
                    f"cutter_radius {self.cutter_radius} mm: its circle does not cross the cone distance"
                    f" {distance:.4f} mm at the {place}; use a larger cutter or a smaller face width"
                )

    def _check_cones(self) -> None:
        """Refuse root and face cones that reach or cross the axis."""
        for member, name in enumerate(GEARS):
            root = self.pitch_angles[member] - self.dedendum_angles[member]
            face = self.pitch_angles[member] + self.dedendum_angles[1 - member]
            if not (root > 0.0 and face < pi):
                raise GeometryError(
                    f"{name}: root angle {degrees(root):.4f} deg and face angle {degrees(face):.4f} deg must lie"
                    " between 0 and 180 deg; reduce depth or taper"
                )

    @cached_property
    def pitch_angles(self) -> tuple[float, float]:
        """delta_1, delta_2 [rad]."""
        return pitch_angles(self.teeth, self.shaft_angle)

    @property
    def outer_cone_distance(self) -> float:
        """R_e = z1 m_et/(2 sin(delta_1)) [mm]."""
        return 0.5 * self.teeth[0] * self.outer_module / sin(self.pitch_angles[0])

    @property
    def mean_cone_distance(self) -> float:
        """R_m = R_e - c_be2 b, of the calculation point [mm]."""
        return self.outer_cone_distance - self.outer_share * self.face_width

    @property
    def face_widths(self) -> tuple[float, float]:
        """b1, b2 [mm]."""
        return self.pinion_face_width or self.face_width, self.face_width

    @property
    def has_own_faces(self) -> bool:
        """Whether the faces are unlike, or their calculation point lies off their middles."""
        return self.face_widths[0] != self.face_widths[1] or self.outer_share != 0.5

    @property
    def cone_distances(self) -> Triple:
        """R_i, R_m, R_e of the wheel, and of the pinion where its face is as wide [mm]."""
        return self._both_distances[1]

    @property
    def _both_distances(self) -> tuple[Triple, Triple]:
        """R_i, R_m, R_e of pinion and wheel [mm]."""
        mean = self.mean_cone_distance
        pinion, wheel = (
            (mean - (1.0 - self.outer_share) * width, mean, mean + self.outer_share * width)
            for width in self.face_widths
        )
        return pinion, wheel

    @property
    def clearances(self) -> tuple[Triple, Triple]:
        """Clearances above the roots of pinion and wheel at toe, calculation point and heel [mm]."""
        both_ways = (self.pinion, self.wheel), (self.wheel, self.pinion)
        pinion, wheel = (tuple((own.dedenda - mating.addenda).tolist()) for own, mating in both_ways)
        return pinion, wheel

    @property
    def mean_transverse_module(self) -> float:
        """m_mt = m_et R_m/R_e [mm]."""
        return self.outer_module * self.mean_cone_distance / self.outer_cone_distance

    @property
    def mean_normal_module(self) -> float:
        """m_mn = m_mt cos(beta_m) [mm]."""
        return self.mean_transverse_module * cos(self.spiral_angle)

    def spiral_angle_at(self, cone_distance: float) -> float:
        """Spiral angle on the pitch cone [rad]."""
        return asin(self._sine_of_spiral(cone_distance))

    def _sine_of_spiral(self, cone_distance: float) -> float:
        if self.cutter_radius is None:
            return sin(self.spiral_angle)
        return cutter_sine(cone_distance, self.mean_cone_distance, self.spiral_angle, self.cutter_radius)

    @property
    def dedendum_angles(self) -> tuple[float, float]:
        """theta_f1, theta_f2; each is the mating gear's addendum angle too [rad]."""
        if self.wheel_angles is not None:
            return self.wheel_angles
        if self.taper == "uniform":
            return 0.0, 0.0
        pinion, wheel = (atan(depth / self.mean_cone_distance) for depth in self.mean_dedenda)
        if self.taper == "standard":
            return pinion, wheel
        whole = self.constant_slot_taper
        if self.taper == "modified":
            whole = min(whole, _LARGEST_TAPER * (pinion + wheel))
        share = self.mean_addenda[1] / self.working_depth
        return share * whole, (1.0 - share) * whole

    @property
    def constant_slot_taper(self) -> float:
        """Sum of the dedendum angles at which a circular cutter leaves slots of constant width [rad].

        The normal pitch grows by pi m_et (1 - R_m sin(beta_m)/r_c0)/(R_e cos(beta_m)) per cone distance, the two slots
        together by 2 tan(alpha_n) times the sum of the dedendum angles.
        """
        closing = self.mean_cone_distance * sin(self.spiral_angle) / (self.cutter_radius or inf)
        growth = pi * self.outer_module * (1.0 - closing) / (self.outer_cone_distance * cos(self.spiral_angle))
        return 0.5 * growth / tan(self.pressure_angle)

    @property
    def virtual_contact_ratios(self) -> tuple[float, float]:
        """Profile and overlap contact ratio of the virtual cylindrical gears at mid-face (ISO 10300-1:2014, annex A).

        The overlap is that of 0.85 of the face width.
        """
        d1, d2 = (count * self.mean_transverse_module / cos(self.pitch_angles[k]) for k, count in enumerate(self.teeth))
        module, width = self.mean_normal_module, _EFFECTIVE_WIDTH * self.face_width
        angles = self.pressure_angle, self.spiral_angle
        return virtual_contact_ratios((d1, d2), self.mean_addenda, angles, module, width)

    @property
    def has_constant_slots(self) -> bool:
        """Whether the root cones leave slots of constant width for a circular cutter, as far as angles are rounded."""
        angles = [
            theta if root is None else pitch - root[0]
            for theta, pitch, (_, root) in zip(self.dedendum_angles, self.pitch_angles, self.cones, strict=True)
        ]
        return self.cutter_radius is not None and isclose(sum(angles), self.constant_slot_taper, rel_tol=_ROUNDED)

    @property
    def _apexes(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """(t_zF, t_zR) of pinion and wheel [mm].

        The wheel's cones hold its depths at R_m; the pinion's stand off from them by the clearance, measured normal to
        the cones, so that its depths at R_m differ by c (1 - cos theta) from the nominal ones.
        """
        mean, (pitch1, pitch2) = self.mean_cone_distance, self.pitch_angles
        theta_a2, theta_f2 = self.dedendum_angles
        face2 = (self.mean_addenda[1] * cos(theta_a2) - mean * sin(theta_a2)) / sin(pitch2 + theta_a2)
        root2 = (mean * sin(theta_f2) - self.mean_dedenda[1] * cos(theta_f2)) / sin(pitch2 - theta_f2)
        face1 = -(root2 * sin(pitch2 - theta_f2) + self.clearance) / sin(pitch1 + theta_f2)
        root1 = -(face2 * sin(pitch2 + theta_a2) + self.clearance) / sin(pitch1 - theta_a2)
        return (face1, root1), (face2, root2)

    def _smallest_profile_shift(self, member: int) -> float:
        """x_hm that keeps the straight blade of the tool, at toe and heel, outside the flank of a gear."""
        module, pressure = self.mean_normal_module, self.pressure_angle
        needed = []
        for distance in self._both_distances[member][::2]:
            depth = self.addendum_factor * module
            depth += (distance - self.mean_cone_distance) * tan(self.dedendum_angles[member])
            spiral = self.spiral_angle_at(distance)
            bend = virtual_curvature(distance, self.pitch_angles[member], spiral, pressure)
            room = sin(pressure) ** 2 / bend if bend > 0.0 else inf
            needed.append((_TOOL_DEPTH * depth - room) / module)
        return max(needed)

    def _gear(self, member: int) -> BlankGear:
        toe, middle, heel = self._both_distances[member]
        outer = self.outer_cone_distance  # from where j_en is brought to R_m
        narrower = middle * cos(self.spiral_angle) / (outer * cos(self.spiral_angle_at(outer)))
        backlash = self.outer_normal_backlash * narrower
        gear = BlankGear(
            name=GEARS[member],
            teeth=self.teeth[member],
            pitch_angle=self.pitch_angles[member],
            pressure_angle=self.pressure_angle,
            cone_distances=(toe, middle, heel),
            spiral_angles=(self.spiral_angle_at(toe), self.spiral_angle_at(middle), self.spiral_angle_at(heel)),
            mean_addendum=self.mean_addenda[member],
            mean_dedendum=self.mean_dedenda[member],
            addendum_angle=self.dedendum_angles[1 - member],
            dedendum_angle=self.dedendum_angles[member],
            mean_normal_thickness=self.mean_normal_thickness(member, self.pressure_angle, backlash),
            profile_shift=(1.0, -1.0)[member] * self.profile_shift,
            smallest_profile_shift=self._smallest_profile_shift(member),
            face_apex=self._apexes[member][0],
            root_apex=self._apexes[member][1],
            constant_slots=self.has_constant_slots,
        )
        face, root = self.cones[member]
        return gear.with_cones(face, root)

    @cached_property
    def pinion(self) -> BlankGear:
        """Blank of the pinion."""
        return self._gear(0)

    @cached_property
    def wheel(self) -> BlankGear:
        """Blank of the wheel."""
        return self._gear(1)
