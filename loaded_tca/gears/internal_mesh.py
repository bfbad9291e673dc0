"""The mesh of a pinion and a ring gear on parallel axes: working circles, active profiles, interferences (ISO 21771).

Radii, the centre distance and the gear ratio are positive here, where ISO 21771 counts those of internal pairs
negative. Both base circles are touched by the line of action on the same side: roll lengths of the ring are those of
the pinion and the length T1T2. Lengths are in mm, angles in rad; the path of contact is that of the transverse section.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import acos, asin, cos, degrees, inf, isclose, isfinite, pi, sin, sqrt, tan

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import GeometryError, require
from loaded_tca.gears.cylindrical import CylindricalGear
from loaded_tca.gears.cylindrical_mesh import ROUNDING, ActiveProfile, PathOfContact, Room, interferences
from loaded_tca.gears.involute import InvoluteMesh, involute
from loaded_tca.gears.ring import RingGear
from loaded_tca.gears.undercut import fillet_room
from loaded_tca.plain import plain

_EQUAL = 1e-12
PROFILE_POINTS = 41
"""Points along flank and tip land of a tooth between which radial assembly is looked at."""


@dataclass(frozen=True)
class InternalMesh(InvoluteMesh):
    """A pinion inside a ring gear.

    Parameters
    ----------
    pinion : CylindricalGear
    ring : RingGear
        Of the normal module, normal pressure angle and **same** hand of the pinion, with more teeth.
    centre_distance : float [mm], optional
        abs(a); None: the one without backlash. Never refused for its backlash.
    axial_offset : float [mm]
        Mid-face of the ring from that of the pinion, towards +z: it shortens the common face.

    Raises
    ------
    InputError
        If the gears do not fit each other.
    GeometryError
        If the centre distance leaves no common flank, or the tip of the ring reaches beyond the pinion's base circle.

    References
    ----------
    ISO 21771:2007, Gears - Cylindrical involute gears and gear pairs - Concepts and geometry. Overlap of the tips and
    radial assembly are derived here.

    Examples
    --------
    >>> from math import degrees
    >>> pinion = CylindricalGear(teeth=25, normal_module=3.0, face_width=25.0)
    >>> mesh = InternalMesh(pinion, RingGear(teeth=-60, normal_module=3.0, face_width=25.0))
    >>> round(mesh.working_centre_distance, 6), round(mesh.transverse_contact_ratio, 4)
    (52.5, 1.7962)
    >>> mesh.involute_interference, round(mesh.overlap_clearance, 3), mesh.radial_assembly_clearance
    (False, 1.209, 0.0)
    """

    pinion: CylindricalGear
    ring: RingGear
    centre_distance: float | None = None
    axial_offset: float = 0.0

    def __post_init__(self) -> None:
        pinion, ring, distance = self.pinion, self.ring, self.centre_distance
        module = pinion.normal_module, ring.normal_module
        angles = (
            (key, degrees(getattr(pinion, key)), degrees(getattr(ring, key)))
            for key in ("pressure_angle", "helix_angle")
        )
        require(
            (isclose(*module, rel_tol=_EQUAL), f"normal_module: {module[0]} and {module[1]} mm must be equal"),
            *(
                (
                    isclose(one, other, rel_tol=_EQUAL, abs_tol=_EQUAL),
                    f"{key}: {plain(one, 6)} and {plain(other, 6)} deg must be equal, the hand included",
                )
                for key, one, other in angles
            ),
            (
                pinion.teeth < ring.tooth_count,
                f"teeth: {pinion.teeth} of the pinion is not below {ring.tooth_count}, the teeth of the ring",
            ),
            (distance is None or 0.0 < distance < inf, f"centre_distance: {distance} mm is not positive and finite"),
            (isfinite(self.axial_offset), f"axial_offset: {self.axial_offset} mm is not finite"),
        )
        self._check_centre_distance()
        self._check_flanks()

    def _check_centre_distance(self) -> None:
        """Refuse base circles that overlap or only touch."""
        smallest = self.base_distance
        if self.centre_distance is None and self._involute_without_backlash <= 0.0:
            raise GeometryError(
                f"profile_shift: {plain(self.pinion.profile_shift, 6)} of the pinion and "
                f"{plain(self.ring.profile_shift, 6)} of the ring, together {plain(self._profile_shift_sum, 6)}, leave "
                f"no centre distance without backlash; the sum must be below {plain(self._largest_shift_sum, 6)}, or "
                f"give a centre_distance above {smallest:.4f} mm"
            )
        if self.working_centre_distance <= smallest:
            raise GeometryError(
                f"centre_distance: {plain(self.working_centre_distance, 6)} mm is not above {smallest:.4f} mm, the "
                "difference of both base radii"
            )

    def _check_flanks(self) -> None:
        """Refuse a ring whose tip leaves the line of action, and flanks that do not meet on it."""
        pinion, ring = self.pinion, self.ring
        if self.involute_interference:
            beyond = self.line_of_action - ring.roll_length(ring.tip_form_radius)
            least = ring.radius_at_roll_length(self.line_of_action)
            raise GeometryError(
                f"involute interference: the tip of the {ring.name}, diameter {2.0 * ring.tip_form_radius:.4f} mm, "
                f"lies {beyond:.4f} mm beyond the base circle of the "
                f"{pinion.name} on the line of action; a tip_diameter of the ring of {2.0 * least:.4f} mm or more "
                "avoids it"
            )
        self.check_common_flank()

    @property
    def wheel(self) -> RingGear:
        """The ring."""
        return self.ring

    @property
    def base_distance(self) -> float:
        """Centre distance r_b2 - r_b1 at which the base circles touch from inside [mm]."""
        return self.ring.base_radius - self.pinion.base_radius

    @property
    def _ring_tip_roll(self) -> float:
        """Roll length on the pinion where the tip of the ring touches; negative beyond the base circle [mm]."""
        return self.ring.roll_length(self.ring.tip_form_radius) - self.line_of_action

    @property
    def mating_tip_rolls(self) -> tuple[float, float]:
        """Roll lengths on pinion and ring where the tip of the mating gear touches [mm]."""
        return self._ring_tip_roll, self.pinion.roll_length(self.pinion.tip_form_radius) + self.line_of_action

    @property
    def _largest_shift_sum(self) -> float:
        """x1 + x2 at which alpha_wt without backlash is zero."""
        rest = involute(self.pinion.transverse_pressure_angle) * (self.ring.tooth_count - self.pinion.teeth)
        return 0.5 * rest / tan(self.pinion.pressure_angle)

    @property
    def gear_ratio(self) -> float:
        """Gear ratio abs(u) = abs(z2)/z1."""
        return self.ring.tooth_count / self.pinion.teeth

    @property
    def pinion_working_radius(self) -> float:
        """r_w1 = abs(a)/(abs(u) - 1) [mm]."""
        return self.working_centre_distance / (self.gear_ratio - 1.0)

    @property
    def wheel_working_radius(self) -> float:
        """abs(r_w2) = abs(a) abs(u)/(abs(u) - 1) [mm]."""
        return self.working_centre_distance * self.gear_ratio / (self.gear_ratio - 1.0)

    def backlash_at(self, centre_distance: float) -> float:
        """Backlash at another centre distance, above the difference of the base radii [mm]."""
        pinion_radius = centre_distance / (self.gear_ratio - 1.0)
        ring_radius = pinion_radius * self.gear_ratio
        space = 2.0 * ring_radius * self.ring.space_angle_at(ring_radius)
        return space - self.pinion.tooth_thickness_at(pinion_radius)

    @property
    def room(self) -> Room:
        """Room that the whole gears leave each other."""
        pinion, ring = self.pinion, self.ring
        below_form = (
            self._ring_tip_roll - pinion.roll_length(pinion.form_radius),
            ring.roll_length(ring.form_radius) - self.line_of_action - pinion.roll_length(pinion.tip_form_radius),
        )
        return Room(self.backlash, below_form, self.tip_clearances, (fillet_room(self, 0), None))

    @property
    def tip_clearances(self) -> tuple[float, float]:
        """Radial clearance between the roots of pinion and ring and the mating gear's tip c [mm]."""
        distance = self.working_centre_distance
        return (
            self.ring.tip_radius - distance - self.pinion.root_radius,
            self.ring.root_radius - distance - self.pinion.tip_radius,
        )

    @property
    def involute_interference(self) -> bool:
        """Whether the tip of the ring reaches beyond the end T1 of the line of action, off the pinion's flank."""
        return self._ring_tip_roll < 0.0

    @property
    def overlap_clearance(self) -> float:
        r"""Clearance of the tip corners where the tip circles cross, along the ring's tip circle [mm].

        Negative: the corners run into each other off the line of action (overlap interference). With the angles at
        which the tip circles cross, counted from the line of centres,

        .. math:: \cos\theta_1 = \frac{r_{a2}^2 - r_{a1}^2 - a^2}{2 a r_{a1}}, \qquad
                  \cos\theta_2 = \frac{r_{a2}^2 + a^2 - r_{a1}^2}{2 a r_{a2}},

        the corner of the pinion is there so much later than that of the ring:
        :math:`(z_1/z_2)(\theta_1 + \mathrm{inv}\,\alpha_{a1} - \mathrm{inv}\,\alpha_w) - (\theta_2 + \mathrm{inv}\,
        \alpha_{a2} - \mathrm{inv}\,\alpha_w)`. inf where the tip circles do not cross.
        """
        pinion, ring, distance = self.pinion, self.ring, self.working_centre_distance
        first, second = pinion.tip_radius, ring.tip_radius
        cosines = (
            (second**2 - first**2 - distance**2) / (2.0 * distance * first),
            (second**2 + distance**2 - first**2) / (2.0 * distance * second),
        )
        if max(map(abs, cosines)) > 1.0:
            return inf
        working = involute(self.working_pressure_angle)
        of_pinion = acos(cosines[0]) + pinion.involute_at(first) - working
        of_ring = acos(cosines[1]) + ring.involute_at(second) - working
        return second * (of_pinion / self.gear_ratio - of_ring)

    @property
    def radial_assembly_clearance(self) -> float:
        """Least clearance across the teeth while the pinion is pushed radially into its place [mm].

        Negative: the gears go together along the axis alone. The pinion does not turn on its way; of the two places in
        which it stands symmetrically, a tooth or a space towards the ring, the better one counts: no other is free
        where neither is. Along circles about the axis of the ring, for one flank of a tooth that stands in the middle
        of its space; zero, but for rounding, where the teeth touch in mesh alone. inf where no teeth reach between each
        other.
        """
        return max(self.radial_assembly_clearances)

    @cached_property
    def radial_assembly_clearances(self) -> tuple[float, float, float]:
        r"""Radial assembly clearances with a tooth and with a space towards the ring, and at the worst turn [mm].

        At the worst turn the tip corner of a tooth, on its way parallel to the line of centres, passes the tip corner
        of the ring as closely as at any, at the angles :math:`\theta_1`, :math:`\theta_2` from the axes with

        .. math:: \sin^2\theta_1 = \frac{1 - (z_1 r_{a2}/(z_2 r_{a1}))^2}{1 - (z_1/z_2)^2}, \qquad
                  r_{a1} \sin\theta_1 = r_{a2} \sin\theta_2

        (trimming interference, which the cutter of a ring must not have: it is fed in while it turns).

        References
        ----------
        Stock Drive Products, Elements of Metric Gear Technology, section 5.2, eqs. 5-9 and 5-10.
        """
        least = ROUNDING * self.pinion.normal_module
        tooth, space = (self._assembly_clearance(turn) for turn in (0.0, 0.5))
        worst = min(tooth, space, self._trimming_clearance())
        tooth, space, worst = (0.0 if abs(one) < least else one for one in (tooth, space, worst))
        return tooth, space, worst

    def _trimming_clearance(self) -> float:
        """Clearance of the tip corners at the worst turn; inf where none passes the other [mm]."""
        pinion, ring, ratio = self.pinion, self.ring, 1.0 / self.gear_ratio
        first, second, distance = pinion.tip_radius, ring.tip_radius, self.working_centre_distance
        square = (1.0 - (ratio * second / first) ** 2) / (1.0 - ratio**2)
        if not 0.0 < square < 1.0 or first >= second:
            return inf
        angle = asin(sqrt(square))
        if distance + first * cos(angle) <= second * cos(asin(first * sin(angle) / second)):
            return inf  # the corner of the pinion ends its way before that of the ring
        corners = (one.half_thickness_angle_at_base for one in (pinion, ring))
        thickness = next(corners) - pinion.involute_at(first), next(corners) + ring.involute_at(second)
        of_ring = ratio * (angle - thickness[0]) + pi / ring.tooth_count - thickness[1]
        return second * (of_ring - asin(first * sin(angle) / second))

    def _assembly_clearance(self, turn: float) -> float:
        """Clearance of a pinion that stands so many pitches off a tooth towards the ring [mm]."""
        pinion, ring = self.pinion, self.ring
        final = self.working_centre_distance
        start = max(0.0, ring.tip_radius - pinion.tip_radius)
        if start >= final:
            return inf
        radius = np.linspace(max(pinion.form_radius, pinion.base_radius), pinion.tip_radius, PROFILE_POINTS)
        half = pinion.half_thickness_angle_at_base - _involute(radius / pinion.base_radius)
        quarter = pinion.teeth // 4 + 1
        tooth = 2.0 * pi / pinion.teeth * (np.arange(-quarter, quarter + 1) + turn)
        across = tooth[:, None] + half  # flanks away from the middle of the gear, by symmetry both
        x, y = radius * np.cos(across), radius * np.sin(across)
        ends = (np.hypot(np.maximum(place + x, 0.0), y) for place in (start, final))
        first, last = (np.maximum(ring.tip_radius, one) for one in ends)  # of the way between the teeth of the ring
        inside = (last > first) & (y > 0.0)
        if not inside.any():
            return inf
        # A tooth of the ring stands half a pitch beside the tooth of the pinion that points to it.
        middle = 2.0 * pi / ring.tooth_count * (np.arange(-quarter, quarter + 1) + turn + 0.5)
        reach = np.linspace(first, last, PROFILE_POINTS)
        azimuth = np.arcsin(np.clip(y / reach, -1.0, 1.0))
        reach = np.clip(reach, ring.tip_radius, ring.form_radius)
        thickness = ring.half_thickness_angle_at_base + _involute(reach / ring.base_radius)
        clearance = reach * (middle[:, None] - thickness - azimuth)
        return float(clearance[:, inside].min())

    @property
    def pinion_active_profile(self) -> ActiveProfile:
        """Part of the pinion's flank that the ring uses."""
        pinion = self.pinion
        form, wanted = pinion.roll_length(pinion.form_radius), self._ring_tip_roll
        start = max(form, wanted)
        return ActiveProfile(
            start_radius=pinion.radius_at_roll_length(start),
            end_radius=pinion.tip_form_radius,
            start_roll_length=start,
            end_roll_length=pinion.roll_length(pinion.tip_form_radius),
            fillet_interference=wanted < form,
        )

    @property
    def wheel_active_profile(self) -> ActiveProfile:
        """Part of the ring's flank that the pinion uses; it starts at the larger diameter, towards the root."""
        ring = self.ring
        form = ring.roll_length(ring.form_radius)
        wanted = self.pinion.roll_length(self.pinion.tip_form_radius) + self.line_of_action
        start = min(form, wanted)
        return ActiveProfile(
            start_radius=ring.radius_at_roll_length(start),
            end_radius=ring.tip_form_radius,
            start_roll_length=start,
            end_roll_length=ring.roll_length(ring.tip_form_radius),
            fillet_interference=wanted > form,
        )

    @property
    def path_of_contact(self) -> PathOfContact:
        """Points T2, T1, A, B, C, D, E on the line of action, counted from T1; T2 lies before T1."""
        line = self.line_of_action
        start, end = self.pinion_active_profile.start_roll_length, self.wheel_active_profile.start_roll_length - line
        return PathOfContact(
            A=start,
            B=end - self.pinion.base_pitch,
            C=line / (self.gear_ratio - 1.0),
            D=start + self.pinion.base_pitch,
            E=end,
            T2=-line,
        )


def _involute(ratio: Array) -> Array:
    """inv(alpha) [rad] at radii over that of the base circle."""
    roll = np.sqrt(np.maximum(ratio**2 - 1.0, 0.0))
    return np.asarray(roll - np.arctan(roll))


def internal_interferences(mesh: InternalMesh, place: str, *, nominal: bool = False) -> Sequence[str]:
    """Sentences on what jams a pinion and a ring that turn all the same where their teeth give way.

    Parameters
    ----------
    mesh : InternalMesh
    place : str
        Where that is, for instance a centre distance.
    nominal : bool
        As for ``interferences`` of external gears.

    Raises
    ------
    GeometryError
        If nothing can turn: teeth overlap by more than 0.2 modules, tips reach into roots or run into each other.
    """
    clearance, module = mesh.overlap_clearance, mesh.pinion.normal_module
    if clearance < -ROUNDING * module:
        raise GeometryError(
            f"the gears cannot turn {place}: overlap interference: off the line of action the tips of pinion and ring "
            f"run into each other by {-clearance:.4f} mm along the ring's tip circle; shorten either tip: a smaller "
            "pinion.tip_diameter_mm, or a larger wheel.tip_diameter_mm"
        )
    return interferences(mesh.room, module, place, nominal=nominal)
