"""Spur and helical gears: external, geometry of ISO 21771, and half a tooth as a closed outline.

Lengths are in mm, angles in rad. Tooth thickness and roll lengths are those of the transverse section, in which the
outline lies: what finite elements need.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from math import atan, cos, inf, pi, radians, sin, sqrt, tan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from loaded_tca.errors import GeometryError, InputError, require
from loaded_tca.gears.chamfer import chamfer_checks, check_chamfer
from loaded_tca.gears.checks import bore_check, face_check, input_checks, spiral_check, teeth_checks, topping_check
from loaded_tca.gears.involute import inverse_involute, involute
from loaded_tca.gears.protuberance import (
    flank_after_protuberance,
    protuberance_checks,
    tangent_without_step,
    without_step,
)
from loaded_tca.gears.tooth_measures import LARGEST_ALLOWANCE, MeasuredGear
from loaded_tca.plain import plain
from loaded_tca.roots import find_root


@dataclass(frozen=True)
class CylindricalGear(MeasuredGear):
    """External spur or helical gear, cut by the basic rack of ISO 53.

    The rounded tip of the rack shapes the fillet; where the asked radius does not fit on that tip, the tip is
    fully rounded (:attr:`rack_tip_radius`).

    Parameters
    ----------
    teeth : int
        Number of teeth z, at least 3.
    normal_module : float [mm]
        m_n.
    face_width : float [mm]
        b.
    pressure_angle : float [rad]
        Normal pressure angle alpha_n at the reference cylinder.
    helix_angle : float [rad]
        beta at the reference cylinder; right hand positive, left hand negative.
    profile_shift : float
        Coefficient x, in normal modules.
    tip_diameter : float [mm], optional
        d_a; None: d + 2 m_n (h_aP/m_n + x + k).
    dedendum_coefficient : float
        h_fP/m_n of the basic rack.
    root_radius_coefficient : float
        rho_fP/m_n of the basic rack; inf: its tip is fully rounded.
    bore_diameter : float [mm], optional
        For the compliance of the body.
    name : str
        What messages call this gear.
    thickness_allowance : float [mm]
        A_sn of the tooth thickness in the normal section at the reference cylinder, negative for thinner teeth, at most
        half a module: the rack cuts with x_E (:attr:`generating_profile_shift`), and flanks and root follow it.
    tip_alteration_coefficient : float
        k, negative where the tip is shortened; 0 beside a tip diameter.
    addendum_coefficient : float
        h_aP/m_n of the basic rack.
    topping : bool
        Whether the tool cuts the tips, too: they follow x_E instead of x.
    protuberance, grinding_stock : float [mm]
        pr and q of a tool before grinding, along the normal of the flank; the basic rack is that of the ground gear.
    protuberance_angle : float [rad], optional
        alpha_pr of the flank of the protuberance; None: half the pressure angle.
    tip_chamfer : float [mm]
        Height of the chamfers of the tip edges, along the radius: the flank ends at :attr:`tip_form_radius`.
    tip_chamfer_angle : float [rad], optional
        Between chamfer and middle of the tooth; None: 45 degrees.
    root_diameter : float [mm], optional
        d_f, which sets ``dedendum_coefficient``; None: d - 2 m_n (h_fP/m_n - x_E).

    Raises
    ------
    InputError
        If values are out of range; every one is told.
    GeometryError
        If the tooth is pointed, or the tip circle lies inside the base circle or the form circle.

    References
    ----------
    ISO 21771:2007, Gears - Cylindrical involute gears and gear pairs - Concepts and geometry; ISO 53:1998,
    profile A.

    Examples
    --------
    >>> gear = CylindricalGear(teeth=16, normal_module=4.5, face_width=14.0, profile_shift=0.1817)
    >>> round(gear.base_radius, 4), round(gear.tip_radius, 3)
    (33.8289, 41.318)
    """

    teeth: int
    normal_module: float
    face_width: float
    pressure_angle: float = radians(20)
    helix_angle: float = 0.0
    profile_shift: float = 0.0
    tip_diameter: float | None = None
    dedendum_coefficient: float = 1.25
    root_radius_coefficient: float = 0.38
    bore_diameter: float | None = None
    name: str = "gear"
    thickness_allowance: float = 0.0
    tip_alteration_coefficient: float = 0.0
    addendum_coefficient: float = 1.0
    topping: bool = False
    protuberance: float = 0.0
    grinding_stock: float = 0.0
    protuberance_angle: float | None = None
    tip_chamfer: float = 0.0
    tip_chamfer_angle: float | None = None
    root_diameter: float | None = None

    def __post_init__(self) -> None:
        lengths = "normal_module", "face_width", "tip_diameter", "root_diameter"
        finite = "profile_shift", "thickness_allowance", "tip_alteration_coefficient"
        rounding = self.root_radius_coefficient
        require(
            *teeth_checks(self.teeth),
            *input_checks(self, (*lengths, "dedendum_coefficient", "addendum_coefficient"), finite),
            bore_check(self.bore_diameter),
            spiral_check("helix_angle", self.helix_angle),
            face_check(self.face_width, self.normal_module, "normal_module"),
            (0.0 <= rounding <= inf, f"root_radius_coefficient: {rounding} is negative or no number"),
            owner=self.name,
        )
        allowance, alteration = self.thickness_allowance, self.tip_alteration_coefficient
        largest = LARGEST_ALLOWANCE * self.normal_module
        require(
            (
                abs(allowance) <= largest,
                f"thickness_allowance: {plain(allowance, 6)} mm is not within {plain(largest, 6)} mm",
            ),
            (
                alteration == 0.0 or self.tip_diameter is None,
                f"tip_alteration_coefficient: {plain(alteration, 6)} beside a tip_diameter of {self.tip_diameter} mm; "
                "give one of them",
            ),
            topping_check(self),
            *protuberance_checks(self),
            *chamfer_checks(self),
            owner=self.name,
        )
        self._place_root()
        self._check_tooth()

    def _place_root(self) -> None:
        """Let a root diameter set the dedendum; refuse a root that no rack leaves."""
        if self.root_diameter is not None:
            depth = (self.reference_radius - 0.5 * self.root_diameter) / self.normal_module
            object.__setattr__(self, "dedendum_coefficient", self.generating_profile_shift + depth)
        dedendum, deepest = self.dedendum_coefficient, pi / 4.0 / tan(self.pressure_angle)
        bore, root = self.bore_diameter or 0.0, 2.0 * self.root_radius
        asked = f"dedendum_coefficient: {plain(dedendum, 6)}"
        if self.root_diameter is not None:
            asked = f"root_diameter: {plain(root, 6)} mm asks for dedendum_coefficient = {plain(dedendum, 6)}, which"
        require(
            (dedendum > 0.0, f"{asked} is not positive: the root would lie above the reference line of the rack"),
            (
                dedendum < deepest,
                f"{asked} is beyond the point of the rack's tooth; at this pressure angle it must be below "
                f"{deepest:.4f}",
            ),
            (root > 0.0, f"profile_shift: {plain(self.profile_shift, 6)} makes the root diameter {plain(root, 6)} mm"),
            (
                not 0.0 < root <= bore,
                f"bore_diameter: {plain(bore, 6)} mm is not below the root diameter {plain(root, 6)} mm",
            ),
            owner=self.name,
        )

    def _check_tooth(self) -> None:
        """Refuse a tooth without flank or without tip."""
        tip = f"{self.name}: the tip circle, diameter {2.0 * self.tip_radius:.4f} mm,"
        base = f"the base circle, diameter {2.0 * self.base_radius:.4f} mm"
        if self.tip_radius <= self.base_radius:
            raise GeometryError(f"{tip} lies inside {base}")
        if self.half_thickness_angle_at_base <= 0.0:
            raise GeometryError(f"{self.name}: pointed tooth: no thickness is left at {base}; increase profile_shift")
        if self.tooth_thickness_at(self.tip_radius) <= 0.0:
            raise GeometryError(
                f"{tip} cannot be reached: pointed tooth, its flanks meet at diameter"
                f" {2.0 * self.pointed_radius:.4f} mm; reduce tip_diameter or profile_shift"
            )
        if self.tip_radius <= self.form_radius:
            raise GeometryError(
                f"{tip} lies inside the form circle, diameter {2.0 * self.form_radius:.4f} mm: no flank left"
            )
        check_chamfer(self)

    @property
    def tip_radius(self) -> float:
        """r_a = d_a/2 [mm]."""
        if self.tip_diameter is not None:
            return 0.5 * self.tip_diameter
        return self.reference_radius + self.normal_module * self.addendum

    @property
    def tip_alteration(self) -> float:
        """Tip alteration k m_n = r_a - r - m_n (h_aP/m_n + x), negative for a shortened tooth [mm]."""
        nominal = self.addendum_coefficient + self.profile_shift
        return self.tip_radius - self.reference_radius - self.normal_module * nominal

    @property
    def root_radius(self) -> float:
        """r_f = r - m_n (h_fP/m_n - x_E) [mm]."""
        return self.reference_radius - self.normal_module * (self.dedendum_coefficient - self.generating_profile_shift)

    @property
    def pointed_radius(self) -> float:
        """Radius at which the two flanks of a tooth meet [mm]."""
        return self.base_radius / cos(inverse_involute(self.half_thickness_angle_at_base))

    @property
    def half_thickness_angle_at_base(self) -> float:
        """Half tooth thickness angle at the base circle, psi_b = s_t/(2 r) + inv(alpha_t) [rad]."""
        return 0.5 * self.tooth_thickness / self.reference_radius + involute(self.transverse_pressure_angle)

    def tooth_thickness_at(self, radius: float) -> float:
        """Transverse tooth thickness at a radius, an arc: 2 r (psi_b - inv(alpha_r)) [mm]."""
        return 2.0 * radius * (self.half_thickness_angle_at_base - self.involute_at(radius))

    @property
    def rack_tip_radius(self) -> float:
        """Tip rounding rho_fP of the basic rack, at most the full rounding of its tip [mm]."""
        sine, cosine = sin(self.pressure_angle), cos(self.pressure_angle)
        tip_half_width = pi / 4.0 - self.dedendum_coefficient * sine / cosine
        tip_half_width += self.residual_undercut / (self.normal_module * cosine)
        full_rounding = tip_half_width * cosine / (1.0 - sine)
        return self.normal_module * min(self.root_radius_coefficient, full_rounding)

    @property
    def rack_form_depth(self) -> float:
        """Depth h_FfP = h_fP - rho_fP (1 - sin(alpha_n)) of the straight part of the basic rack [mm]."""
        dedendum = self.normal_module * self.dedendum_coefficient
        return dedendum - self.rack_tip_radius * (1.0 - sin(self.pressure_angle))

    @property
    def rack_form_roll_length(self) -> float:
        """Roll length where the straight part of the rack ends; negative if the rack undercuts [mm]."""
        depth = self.rack_form_depth - self.normal_module * self.generating_profile_shift
        sine = sin(self.transverse_pressure_angle)
        return self.reference_radius * sine - depth / sine

    @property
    def residual_undercut(self) -> float:
        """s_pr = pr - q of ground flanks; negative: the depth of the notch that grinding leaves [mm]."""
        return self.protuberance - self.grinding_stock

    @property
    def least_slope(self) -> float:
        """Angle of the normal of the tool's last flank before its rounding: alpha_pr of a protuberance [rad]."""
        if self.residual_undercut <= 0.0:
            return self.pressure_angle
        return 0.5 * self.pressure_angle if self.protuberance_angle is None else self.protuberance_angle

    @property
    def meets_in_corner(self) -> bool:
        """Whether flank and fillet meet in a corner, at an undercut."""
        return self.is_undercut or self.residual_undercut > 0.0

    @property
    def is_undercut(self) -> bool:
        """Whether the rounded tip of the rack cuts into the involute."""
        return self.rack_form_roll_length < 0.0

    @property
    def smallest_profile_shift(self) -> float:
        """Profile shift x below which the basic rack undercuts this gear, with its thickness allowance."""
        sine = sin(self.transverse_pressure_angle)
        generating = (self.rack_form_depth - self.reference_radius * sine**2) / self.normal_module
        return generating - 0.5 * self.thickness_allowance / (self.normal_module * tan(self.pressure_angle))

    @cached_property
    def form_radius(self) -> float:
        """r_Ff = d_Ff/2, where fillet and involute meet; never inside the base circle [mm]."""
        if not self.meets_in_corner:
            return self.radius_at_roll_length(self.rack_form_roll_length)
        return max(self.base_radius, float(self._fillet(self._fillet_start)[0]))

    def root_fillet(self, points: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Transverse root fillet that the rounded tip of the rack cuts, from form circle to root circle.

        Parameters
        ----------
        points : int
            Number of points.

        Returns
        -------
        radius, half_thickness_angle : (points,) [mm], (points,) [rad]
            Polar coordinates about the gear's axis, the angle counted from the middle of the tooth.
        """
        radius, angle = self._fillet(np.linspace(self._fillet_start, 0.5 * pi, points))
        if self.residual_undercut < 0.0:
            angle = without_step(radius, angle, self._step)
        return radius, angle

    def root_fillet_tangent(self, points: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Unit tangents of :meth:`root_fillet`, towards the root circle.

        The rack cuts where its normal meets the pitch point, so the normal of the fillet is the line to it.

        Parameters
        ----------
        points : int
            Number of points.

        Returns
        -------
        radial, circumferential : (points,)
            The second one positive away from the middle of the tooth.
        """
        slope = np.linspace(self._fillet_start, 0.5 * pi, points)
        offset, above = self._offset_and_height(slope)
        leaning = cos(self.helix_angle) / np.tan(np.maximum(slope, self.least_slope))
        normal = np.stack([leaning * offset - self.reference_radius - above, leaning * self.reference_radius])
        inward, sideways = normal / np.linalg.norm(normal, axis=0)
        if self.residual_undercut < 0.0:
            return tangent_without_step(*self._fillet(slope), (-sideways, -inward), self._step)
        return -sideways, -inward

    @property
    def _step(self) -> float:
        """Angle by which the fillet of the tool begins in front of the ground flank, at a notch [rad]."""
        return -self.cut_into_flank(self._fillet_start)

    def _offset_and_height(self, slope: Any) -> tuple[Any, Any]:
        """Where a point of the rack's rounding cuts: beside and above the pitch point [mm]."""
        normal = np.maximum(slope, self.least_slope)
        above = (
            self.normal_module * self.generating_profile_shift
            - self.rack_form_depth
            - self.rack_tip_radius * (np.sin(normal) - sin(self.pressure_angle))
            + self.normal_module * (normal - slope) * cos(self.least_slope)
        )
        return -above * cos(self.helix_angle) * np.cos(normal) / np.sin(normal), above

    def _fillet(self, slope: float | NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Radius and half thickness angle that a point of the rack's rounding cuts.

        ``slope`` is the angle of its normal to the rack's reference line in the normal section, from alpha_n
        (end of the straight flank) to pi/2 (tip). The circle of the normal section, stretched by 1/cos(beta),
        is an ellipse in the transverse one; its point cuts when the transverse normal meets the pitch point.
        Of a protuberance slopes below alpha_pr count the length of its straight flank, in modules.
        """
        rounding, twist = self.rack_tip_radius, cos(self.helix_angle)
        flank_end = pi / 4.0 * self.normal_module - self.rack_form_depth * tan(self.pressure_angle)
        flank_end += self.residual_undercut / cos(self.pressure_angle)
        normal = np.maximum(slope, self.least_slope)
        straight = self.normal_module * (normal - slope) * sin(self.least_slope)
        along = (flank_end + straight + rounding * (np.cos(normal) - cos(self.pressure_angle))) / twist
        offset, above = self._offset_and_height(slope)
        space = np.arctan2(offset, self.reference_radius + above) - (offset - along) / self.reference_radius
        return np.hypot(self.reference_radius + above, offset), pi / self.teeth - space

    @cached_property
    def _fillet_start(self) -> float:
        """Slope of the rack's normal where the fillet leaves the involute.

        That is at the end of the straight flank if there is no undercut; also, or at the base circle, if the
        undercut is so slight that rounding hides it.
        """
        flank_end = self.pressure_angle
        if self.residual_undercut > 0.0 and self.cut_into_flank(flank_end) > 0.0:
            return flank_after_protuberance(self)
        if not self.is_undercut or self._above_base(flank_end) <= 0.0 or self.cut_into_flank(flank_end) >= 0.0:
            return flank_end
        at_base = find_root(self._above_base, flank_end, 0.5 * pi)
        if self.cut_into_flank(at_base) <= 0.0:
            return at_base
        return find_root(self.cut_into_flank, flank_end, at_base)

    def _above_base(self, slope: float) -> float:
        """Height of a point of the fillet above the base circle [mm]."""
        return float(self._fillet(slope)[0]) - self.base_radius

    def cut_into_flank(self, slope: float) -> float:
        """Angle by which the fillet lies behind the involute; negative: in front of it, in the space."""
        radius, half_thickness_angle = self._fillet(slope)
        tangent = sqrt(max(0.0, (float(radius) / self.base_radius) ** 2 - 1.0))
        return self.half_thickness_angle_at_base - (tangent - atan(tangent)) - float(half_thickness_angle)


RIM_MODULES = 2.0
"""Depth below the root circle to which the outline goes by default, in normal modules; at most half the radius."""


def half_tooth(gear: CylindricalGear, points: int) -> dict[str, NDArray[np.float64]]:
    """Parts of the outline of half a tooth, from the middle of its tip to the middle of the space.

    Parameters
    ----------
    gear : CylindricalGear
    points : int
        Points along each part, at least 2.

    Returns
    -------
    dict of (points, 2) arrays [mm]
        ``tip_land``, ``flank`` (involute), ``fillet`` (trochoid cut by the rack's rounded tip) and ``root_land``; the
        last point of each is the first of the next. The middle of the tooth is the x axis.

    Raises
    ------
    InputError
        If there are fewer than 2 points.

    References
    ----------
    ISO 21771:2007 (involute); ISO 53:1998 (basic rack).

    Examples
    --------
    >>> parts = half_tooth(CylindricalGear(teeth=20, normal_module=3.0, face_width=25.0), 9)
    >>> [round(float(np.hypot(*part[-1])), 6) for part in parts.values()]
    [33.0, 28.2301, 26.25, 26.25]
    """
    if points < 2:
        raise InputError(f"points: {points} is below 2")
    fillet_radius, fillet_angle = gear.root_fillet(points)
    roll = np.linspace(gear.roll_length(gear.tip_radius), gear.roll_length(gear.form_radius), points)
    tangent = roll / gear.base_radius
    flank_radius = np.hypot(roll, gear.base_radius)
    flank_angle = gear.half_thickness_angle_at_base - (tangent - np.arctan(tangent))
    fillet_radius[0], fillet_angle[0] = flank_radius[-1], flank_angle[-1]
    even = np.linspace(0.0, 1.0, points)
    polar = {
        "tip_land": (np.full(points, flank_radius[0]), even * flank_angle[0]),
        "flank": (flank_radius, flank_angle),
        "fillet": (fillet_radius, fillet_angle),
        "root_land": (
            np.full(points, fillet_radius[-1]),
            fillet_angle[-1] + even * (math.pi / gear.teeth - fillet_angle[-1]),
        ),
    }
    return {name: np.stack([r * np.cos(angle), r * np.sin(angle)], axis=-1) for name, (r, angle) in polar.items()}


def transverse_profile(gear: CylindricalGear, points: int, inner_radius: float | None = None) -> NDArray[np.float64]:
    """Closed outline of half a tooth with its part of the rim, counter-clockwise.

    It begins in the middle of the tip, follows :func:`half_tooth` to the middle of the space, goes straight to the
    inner circle, along it, and back along the middle of the tooth.

    Parameters
    ----------
    gear : CylindricalGear
    points : int
        Points along each of the four parts of the tooth and along the inner circle.
    inner_radius : float [mm], optional
        Default: that of the bore; of a gear that is solid or has none given, two modules below the root circle, but at
        least half its radius.

    Returns
    -------
    (n, 2) array [mm]
        The middle of the tooth is the x axis; the last point is the first one.

    Raises
    ------
    InputError
        If the inner radius is not between 0 and the root radius, or there are fewer than 2 points.

    Examples
    --------
    >>> transverse_profile(CylindricalGear(teeth=20, normal_module=3.0, face_width=25.0), 9).shape
    (43, 2)
    """
    solid = max(gear.root_radius - RIM_MODULES * gear.normal_module, 0.5 * gear.root_radius)
    default = 0.5 * gear.bore_diameter if gear.bore_diameter else solid
    inner = default if inner_radius is None else inner_radius
    if not 0.0 < inner < gear.root_radius:
        raise InputError(
            f"inner_radius: {inner} mm is not between 0 and {plain(gear.root_radius, 6)} mm, the root radius"
        )
    parts = list(half_tooth(gear, points).values())
    angle = np.linspace(math.pi / gear.teeth, 0.0, points)
    rim = np.stack([inner * np.cos(angle), inner * np.sin(angle)], axis=-1)
    return np.concatenate([parts[0], *(part[1:] for part in parts[1:]), rim, parts[0][:1]])
