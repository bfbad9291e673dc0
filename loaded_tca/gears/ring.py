"""Ring gears: internal spur and helical gears, geometry of ISO 21771, and the pinion-type cutters that cut them.

The number of teeth is negative, as ISO 21771 counts; diameters and radii are positive here. A positive profile shift
thickens the teeth of a ring and moves tip and root towards the axis. Lengths are in mm, angles in rad; tooth thickness
and roll lengths are those of the transverse section.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import atan, atan2, cos, inf, pi, radians, sin, sqrt, tan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arrays import real
from loaded_tca.errors import GeometryError, require
from loaded_tca.gears.chamfer import chamfer_checks, check_chamfer
from loaded_tca.gears.checks import face_check, input_checks, spiral_check, teeth_checks, topping_check
from loaded_tca.gears.involute import inverse_involute, involute
from loaded_tca.gears.tooth_measures import LARGEST_ALLOWANCE, MeasuredGear
from loaded_tca.plain import plain
from loaded_tca.roots import find_root

OUTSIDE_MODULES = 7.0
"""Depth of a ring between root and outside that has no outer diameter given, in normal modules."""
SHARPEST = 1e-3
"""Least radius of a fillet in normal modules, where so little room or none is asked for."""


@dataclass(frozen=True)
class PinionCutter:
    """Pinion-type cutter of a ring gear.

    Its tip diameter follows from the root diameter of the ring. The rounding of its tip is a circle of the transverse
    section; where the asked radius does not fit on the tip, the tip is fully rounded.

    Parameters
    ----------
    teeth : int
        z_0, at least 3 and fewer than the ring has.
    profile_shift : float
        x_0, in normal modules.
    tip_radius_coefficient : float
        rho_a0/m_n.

    Raises
    ------
    InputError
        If values are out of range; every one is told.
    """

    teeth: int
    profile_shift: float = 0.0
    tip_radius_coefficient: float = 0.3

    def __post_init__(self) -> None:
        rounding = real(self.tip_radius_coefficient)
        require(
            *teeth_checks(self.teeth),
            (abs(real(self.profile_shift)) < inf, f"profile_shift: {self.profile_shift} is not finite"),
            (0.0 <= rounding < inf, f"tip_radius_coefficient: {rounding} is negative or not finite"),
            owner="cutter",
        )


@dataclass(frozen=True)
class RingGear(MeasuredGear):
    """Internal spur or helical gear, with fillets that are arcs or cut by a pinion-type cutter.

    Parameters
    ----------
    teeth : int
        Number of teeth z, negative, at most -3.
    normal_module : float [mm]
        m_n.
    face_width : float [mm]
        b.
    pressure_angle : float [rad]
        Normal pressure angle alpha_n at the reference cylinder.
    helix_angle : float [rad]
        beta at the reference cylinder; right hand positive, left hand negative.
    profile_shift : float
        Coefficient x with the sign of ISO 21771, in normal modules.
    tip_diameter : float [mm], optional
        abs(d_a); None: abs(d) - 2 m_n (h_aP/m_n + x + k).
    root_diameter : float [mm], optional
        abs(d_f); None: abs(d) + 2 m_n (h_fP/m_n - x_E), or what a cutter that is made for the ring without allowance
        leaves of one with it.
    dedendum_coefficient : float
        h_fP/m_n of the basic rack.
    root_radius_coefficient : float
        Radius of arcs at the root in normal modules, where there is no cutter; at most the one that fits, inf: that.
    outer_diameter : float [mm], optional
        Held rigid where teeth bend; None: seven normal modules beyond the root on each side.
    cutter : PinionCutter, optional
        Shapes the fillets; None: arcs.
    name : str
        What messages call this gear.
    thickness_allowance : float [mm]
        A_sn of the tooth thickness in the normal section at the reference cylinder, negative for thinner teeth, at most
        half a module: the ring is cut with x_E (:attr:`generating_profile_shift`), and flanks and root follow it.
    tip_alteration_coefficient : float
        k, negative where the tip is shortened; 0 beside a tip diameter.
    addendum_coefficient : float
        h_aP/m_n of the basic rack.
    topping : bool
        Whether the tool cuts the tips, too: they follow x_E instead of x.
    tip_chamfer : float [mm]
        Height of the chamfers of the tip edges, along the radius: the flank ends at :attr:`tip_form_radius`.
    tip_chamfer_angle : float [rad], optional
        Between chamfer and middle of the tooth; None: 45 degrees.

    Raises
    ------
    InputError
        If values are out of range; every one is told.
    GeometryError
        If the tip lies inside the base circle, a tooth or a space is pointed, or no flank is left.

    References
    ----------
    ISO 21771:2007, Gears - Cylindrical involute gears and gear pairs - Concepts and geometry.

    Examples
    --------
    >>> ring = RingGear(teeth=-60, normal_module=3.0, face_width=25.0)
    >>> round(ring.tip_radius, 3), round(ring.root_radius, 3), round(ring.form_radius, 3)
    (87.0, 93.75, 93.08)
    """

    teeth: int
    normal_module: float
    face_width: float
    pressure_angle: float = radians(20)
    helix_angle: float = 0.0
    profile_shift: float = 0.0
    tip_diameter: float | None = None
    root_diameter: float | None = None
    dedendum_coefficient: float = 1.25
    root_radius_coefficient: float = 0.38
    outer_diameter: float | None = None
    cutter: PinionCutter | None = None
    name: str = "ring"
    thickness_allowance: float = 0.0
    tip_alteration_coefficient: float = 0.0
    addendum_coefficient: float = 1.0
    topping: bool = False
    tip_chamfer: float = 0.0
    tip_chamfer_angle: float | None = None

    def __post_init__(self) -> None:
        positive = "normal_module", "face_width", "tip_diameter", "root_diameter", "dedendum_coefficient"
        finite = "profile_shift", "thickness_allowance", "tip_alteration_coefficient"
        teeth, rounding = real(self.teeth), self.root_radius_coefficient
        whole = -inf < teeth <= -3 and teeth == int(teeth)
        require(
            (whole, f"teeth: {self.teeth} is not a whole number of -3 or below; ring gears have negative teeth"),
            *input_checks(self, (*positive, "addendum_coefficient", "outer_diameter"), finite),
            spiral_check("helix_angle", self.helix_angle),
            face_check(self.face_width, self.normal_module, "normal_module"),
            (0.0 <= rounding <= inf, f"root_radius_coefficient: {rounding} is negative or no number"),
            owner=self.name,
        )
        allowance, largest = self.thickness_allowance, LARGEST_ALLOWANCE * self.normal_module
        alteration = self.tip_alteration_coefficient
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
            *chamfer_checks(self),
            owner=self.name,
        )
        if self.cutter is not None:
            self._check_feed(self.cutter)
        tip, root = 2.0 * self.tip_radius, 2.0 * self.root_radius
        base, outside = 2.0 * self.base_radius, 2.0 * self.outer_radius
        require(
            (tip < root, f"tip_diameter: {plain(tip, 6)} mm is not below the root diameter {plain(root, 6)} mm"),
            (
                root < outside,
                f"outer_diameter: {plain(outside, 6)} mm is not above the root diameter {plain(root, 6)} mm",
            ),
            owner=self.name,
        )
        if tip <= base:
            highest = (self.reference_radius - self.base_radius) / self.normal_module
            raise GeometryError(
                f"{self.name}: the tip circle, diameter {tip:.4f} mm, lies inside the base circle, diameter "
                f"{base:.4f} mm, where a ring has no flank; a tip_diameter above it leaves an addendum of less than "
                f"{highest:.4f} normal modules"
            )
        self._check_tooth()

    def _check_tooth(self) -> None:
        """Refuse a tooth without tip, a space without bottom, a flank without height."""
        if self.tooth_thickness_at(self.tip_radius) <= 0.0:
            raise GeometryError(
                f"{self.name}: pointed tooth: nothing is left at the tip circle, diameter {2.0 * self.tip_radius:.4f} "
                "mm; increase tip_diameter or profile_shift"
            )
        if self.space_angle_at(self.root_radius) <= 0.0:
            raise GeometryError(
                f"{self.name}: the spaces close below the root circle, diameter {2.0 * self.root_radius:.4f} mm: the "
                f"flanks of neighbouring teeth meet at diameter {2.0 * self._closing_radius:.4f} mm; reduce "
                "root_diameter or profile_shift"
            )
        if self.cutter is not None:
            self._check_cutter()
        if not self.tip_radius < self.form_radius:
            raise GeometryError(
                f"{self.name}: no flank is left between the tip circle, diameter {2.0 * self.tip_radius:.4f} mm, and "
                f"the form circle, diameter {2.0 * self.form_radius:.4f} mm"
            )
        check_chamfer(self)

    def _check_feed(self, cutter: PinionCutter) -> None:
        """Refuse a cutter that has no place in this ring."""
        more = cutter.teeth < self.tooth_count
        require(
            (more, f"cutter.teeth: {cutter.teeth} is not below {self.tooth_count}, the teeth of the ring"),
            owner=self.name,
        )
        for shift in (self.profile_shift, self.generating_profile_shift):
            require(
                (
                    self._cutting_involute(shift) > 0.0,
                    f"profile_shift: {plain(shift, 6)} of the ring and {plain(cutter.profile_shift, 6)} of the cutter, "
                    f"together {plain(shift + cutter.profile_shift, 6)}, leave no working pressure angle of ring and "
                    "cutter",
                ),
                owner=self.name,
            )

    def _check_cutter(self) -> None:
        """Refuse a cutter that cannot cut this ring."""
        tip, base = self._cutter_tip_radius, self._cutter_base_radius
        if not self._cutter_rounding_centre(SHARPEST * self.normal_module)[0] > base:
            raise GeometryError(
                f"{self.name}: the tip of the cutter, diameter {2.0 * tip:.4f} mm, does not reach beyond its base "
                f"circle, diameter {2.0 * base:.4f} mm"
            )
        if self._cutter_rounding_centre(SHARPEST * self.normal_module)[1] <= 0.0:
            raise GeometryError(
                f"{self.name}: the teeth of the cutter are pointed below its tip diameter of {2.0 * tip:.4f} mm, which "
                "the root of the ring asks for; reduce root_diameter or cutter.profile_shift"
            )
        centre, pitch = self._cutter_rounding_centre(self.fillet_radius)[0], base / cos(self._cutting_angle)
        if not centre > pitch:
            raise GeometryError(
                f"{self.name}: the rounding of the cutter's tip begins inside its working pitch circle, diameter "
                f"{2.0 * pitch:.4f} mm; reduce cutter.tip_radius_coefficient or cutter.teeth, or increase root_diameter"
            )

    @property
    def tip_radius(self) -> float:
        """abs(r_a) = abs(d_a)/2 [mm]."""
        if self.tip_diameter is not None:
            return 0.5 * self.tip_diameter
        return self.reference_radius - self.normal_module * self.addendum

    @property
    def tip_alteration(self) -> float:
        """Tip alteration k m_n = abs(r) - abs(r_a) - m_n (h_aP/m_n + x), negative for a shortened tooth [mm]."""
        nominal = self.addendum_coefficient + self.profile_shift
        return self.reference_radius - self.tip_radius - self.normal_module * nominal

    @property
    def root_radius(self) -> float:
        """abs(r_f) = abs(r) + m_n (h_fP/m_n - x_E), or as given [mm].

        A cutter has the tip circle that the ring without allowance asks for, and goes deeper where there is one.
        """
        if self.root_diameter is not None:
            return 0.5 * self.root_diameter
        if self.cutter is None or self.thickness_allowance == 0.0:
            depth = self.dedendum_coefficient - self.generating_profile_shift
            return self.reference_radius + self.normal_module * depth
        nominal = self.reference_radius + self.normal_module * (self.dedendum_coefficient - self.profile_shift)
        return nominal + self._cutting_distance - self._distance_of_cutter(self.profile_shift)

    @property
    def outer_radius(self) -> float:
        """Radius at which the ring is held, given or by default [mm]."""
        if self.outer_diameter is not None:
            return 0.5 * self.outer_diameter
        return self.root_radius + OUTSIDE_MODULES * self.normal_module

    @property
    def half_thickness_angle_at_base(self) -> float:
        """Half tooth thickness angle that flanks would have at the base circle, s_t/(2 abs(r)) - inv(alpha_t) [rad].

        Negative where they would meet before it: a ring's teeth grow outwards.
        """
        return 0.5 * self.tooth_thickness / self.reference_radius - involute(self.transverse_pressure_angle)

    def tooth_thickness_at(self, radius: float) -> float:
        """Transverse tooth thickness at a radius, an arc: 2 r (psi_b + inv(alpha_r)) [mm]."""
        return 2.0 * radius * (self.half_thickness_angle_at_base + self.involute_at(radius))

    def space_angle_at(self, radius: float) -> float:
        """Half the angle of the space between two teeth at a radius [rad]; negative where the flanks have crossed."""
        return pi / self.tooth_count - 0.5 * self.tooth_thickness_at(radius) / radius

    @property
    def _space_angle_at_base(self) -> float:
        """Half the angle of the space at the base circle [rad]."""
        return pi / self.tooth_count - self.half_thickness_angle_at_base

    @property
    def _closing_radius(self) -> float:
        """Radius at which the flanks of neighbouring teeth meet [mm]."""
        return self.base_radius / cos(inverse_involute(max(self._space_angle_at_base, 0.0)))

    @cached_property
    def fillet_radius(self) -> float:
        """Radius of the arcs at the root, or of the rounding of the cutter's tip, at most what fits [mm]."""
        cutter = self.cutter
        coefficient = self.root_radius_coefficient if cutter is None else cutter.tip_radius_coefficient
        wanted, least = self.normal_module * min(max(coefficient, SHARPEST), pi), self.normal_module * SHARPEST
        angle_of = self._arc_centre if cutter is None else self._cutter_rounding_centre

        def room(radius: float) -> float:
            return angle_of(radius)[1]

        if room(wanted) >= 0.0:
            return wanted
        if room(least) <= 0.0:
            raise GeometryError(
                f"{self.name}: no fillet fits into the spaces at the root circle, diameter "
                f"{2.0 * self.root_radius:.4f} mm; reduce root_diameter or profile_shift"
            )
        return find_root(room, least, wanted)

    def _arc_centre(self, radius: float) -> tuple[float, float, float]:
        """Centre of an arc that touches flank and root: radius, angle from the middle of the space, flank's roll.

        It lies on the normal of the flank, which touches the base circle: r_b^2 + (a - rho)^2 = (r_f - rho)^2.
        """
        centre = self.root_radius - radius
        rest = sqrt(max(0.0, centre**2 - self.base_radius**2))
        roll = rest + radius
        return centre, self._space_angle_at_base - roll / self.base_radius + atan(rest / self.base_radius), roll

    @cached_property
    def form_radius(self) -> float:
        """abs(r_Ff), where fillet and involute meet [mm]."""
        if self.cutter is None:
            return self.radius_at_roll_length(self._arc_centre(self.fillet_radius)[2])
        cutting_roll = self._cutter_rounding_centre(self.fillet_radius)[2]
        return self.radius_at_roll_length(cutting_roll + self._cutting_distance * sin(self._cutting_angle))

    def root_fillet(self, points: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Transverse root fillet from the form circle to the root circle.

        Parameters
        ----------
        points : int
            Number of points.

        Returns
        -------
        radius, half_thickness_angle : (points,) [mm], (points,) [rad]
            Polar coordinates about the gear's axis, the angle counted from the middle of the tooth.
        """
        place = self._fillet(points)[0]
        return np.hypot(place[0], place[1]), pi / self.tooth_count - np.arctan2(place[1], place[0])

    def root_fillet_tangent(self, points: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Unit tangents of :meth:`root_fillet`, towards the root circle.

        Parameters
        ----------
        points : int
            Number of points.

        Returns
        -------
        radial, circumferential : (points,)
            The first positive outwards, the second one away from the middle of the tooth.
        """
        place, normal = self._fillet(points)
        radial = place / np.hypot(place[0], place[1])
        out, around = (radial * normal).sum(axis=0), radial[0] * normal[1] - radial[1] * normal[0]
        return around, out

    def _fillet(self, points: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Points (2, n) and their normals into the material, the middle of the space being the x axis [mm]."""
        part = np.linspace(1.0, 0.0, points)
        return self._arc(part) if self.cutter is None else self._cut(self.cutter, part)

    def _arc(self, part: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Arc about its centre, from the normal of the flank to the ray from the axis."""
        distance, angle, roll = self._arc_centre(self.fillet_radius)
        lean = atan((roll - self.fillet_radius) / self.base_radius)
        turn = angle + part * (0.5 * pi - lean)  # the flank's normal is at right angles to the ray to T
        normal = np.stack([np.cos(turn), np.sin(turn)])
        centre = distance * np.array([[cos(angle)], [sin(angle)]])
        return centre + self.fillet_radius * normal, normal

    def _cut(self, cutter: PinionCutter, part: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """What the rounding of the cutter's tip cuts: its point on the line from the pitch point to its centre."""
        distance, start, roll = self._cutter_rounding_centre(self.fillet_radius)
        first = atan((roll - self.fillet_radius) / self._cutter_base_radius) - self._cutting_angle
        place = part * first
        pitch_radius = self._cutter_base_radius / cos(self._cutting_angle)
        from_pitch = np.stack([distance * np.cos(place) - pitch_radius, distance * np.sin(place)])
        normal = from_pitch / np.linalg.norm(from_pitch, axis=0)
        centre = np.stack([distance * np.cos(place) + self._cutting_distance, distance * np.sin(place)])
        turn = (start - place) * cutter.teeth / self.tooth_count  # back by as much as the ring has turned
        cosine, sine = np.cos(turn), np.sin(turn)

        def back(x: Any, y: Any) -> NDArray[np.float64]:
            return np.stack([cosine * x - sine * y, sine * x + cosine * y])

        return back(*(centre + self.fillet_radius * normal)), back(*normal)

    def _cutting_involute(self, shift: float) -> float:
        """inv(alpha_w0) of a ring of a profile shift and the cutter, without backlash [rad]."""
        assert self.cutter is not None
        shifts = shift + self.cutter.profile_shift
        teeth = self.tooth_count - self.cutter.teeth
        return involute(self.transverse_pressure_angle) - 2.0 * shifts * tan(self.pressure_angle) / teeth

    @cached_property
    def _cutting_angle(self) -> float:
        """alpha_w0 [rad]."""
        return inverse_involute(self._cutting_involute(self.generating_profile_shift))

    @property
    def _cutter_base_radius(self) -> float:
        assert self.cutter is not None
        return self.base_radius * self.cutter.teeth / self.tooth_count

    @property
    def _cutting_distance(self) -> float:
        """abs(a_0) between the axes of ring and cutter [mm]."""
        return (self.base_radius - self._cutter_base_radius) / cos(self._cutting_angle)

    def _distance_of_cutter(self, shift: float) -> float:
        """abs(a_0) of a ring of another profile shift [mm]."""
        return (self.base_radius - self._cutter_base_radius) / cos(inverse_involute(self._cutting_involute(shift)))

    @property
    def _cutter_tip_radius(self) -> float:
        return self.root_radius - self._cutting_distance

    def _cutter_rounding_centre(self, radius: float) -> tuple[float, float, float]:
        """Centre of a rounding of the cutter's tip: radius, angle from the middle of its tooth, the flank's roll there.

        As :meth:`_arc_centre`, of the cutter's tooth.
        """
        assert self.cutter is not None
        base, centre = self._cutter_base_radius, self._cutter_tip_radius - radius
        rest = sqrt(max(0.0, centre**2 - base**2))
        roll = rest + radius
        shift = 2.0 * self.cutter.profile_shift * tan(self.pressure_angle)
        half = (0.5 * pi + shift) / self.cutter.teeth + involute(self.transverse_pressure_angle)
        return centre, half - roll / base + atan2(rest, base), roll
