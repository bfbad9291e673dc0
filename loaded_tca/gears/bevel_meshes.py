"""Two straight or spiral bevel gears whose pitch cones roll on each other."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import isclose, log, pi, radians, sin, tan

from loaded_tca.errors import require
from loaded_tca.gears.bevel import BevelGear, in_degrees, pitch_angles
from loaded_tca.gears.checks import (
    half_turn_checks,
    pair_checks,
)
from loaded_tca.gears.cylindrical_mesh import Room

EQUAL = 1e-9
"""Relative difference of cone distances and modules that are the same."""


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
        first, second, shaft_angle = self.pinion, self.wheel, in_degrees(self.shaft_angle)
        own_points = None not in (first.calculation_distance, second.calculation_distance)
        of_both = () if own_points else ("outer_module", "face_width")
        rolls = isclose(first.mean_cone_distance, second.mean_cone_distance, rel_tol=EQUAL)
        modules = [gear.mean_normal_module for gear in (first, second)]
        rolls = rolls and isclose(*modules, rel_tol=EQUAL)
        pitches = f"{in_degrees(first.pitch_angle)} and {in_degrees(second.pitch_angle)}"
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
