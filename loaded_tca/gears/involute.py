"""The involute, and what external gears and ring gears, and their meshes, have in common.

The involute function and its inverse; formulas of ISO 21771 without the signs of internal gears; contact ratios, forces
and backlash of meshes.
"""

from __future__ import annotations

from functools import cached_property
from math import asin, atan, cos, hypot, inf, pi, sin, sqrt, tan
from typing import TYPE_CHECKING

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.plain import plain

if TYPE_CHECKING:
    from loaded_tca.gears.cylindrical import CylindricalGear
    from loaded_tca.gears.cylindrical_mesh import ActiveProfile, PathOfContact


def involute(angle: float) -> float:
    """Involute function inv(alpha) = tan(alpha) - alpha [rad]."""
    return tan(angle) - angle


def inverse_involute(value: float) -> float:
    r"""Angle whose involute function is the value given, to machine precision.

    Newton on :math:`t - \arctan t = \mathrm{inv}\,\alpha` with t = tan(alpha): convex, and started above the
    root, so that the iterates fall until rounding stops them.

    Parameters
    ----------
    value : float [rad]
        inv(alpha), not negative.

    Examples
    --------
    >>> round(inverse_involute(involute(0.35)), 12)
    0.35
    """
    if not 0.0 <= value < inf:
        raise InputError(f"value: an involute function of {value} rad has no angle between 0 and 90 deg")
    if value == 0.0:
        return 0.0
    tangent = inf
    smaller = (3.0 * value) ** (1.0 / 3.0) + value
    while smaller < tangent:
        tangent = smaller
        smaller = tangent - (tangent - atan(tangent) - value) * (1.0 + tangent**-2)
    return atan(tangent)


class InvoluteGear:
    """Spur or helical gear with involute teeth; radii and roll lengths are positive, also those of ring gears.

    References
    ----------
    ISO 21771:2007, Gears - Cylindrical involute gears and gear pairs - Concepts and geometry.
    """

    name: str
    teeth: int
    normal_module: float
    face_width: float
    pressure_angle: float
    helix_angle: float
    profile_shift: float
    dedendum_coefficient: float

    if TYPE_CHECKING:  # a property of each gear

        @property
        def tip_radius(self) -> float:
            """abs(r_a) [mm]."""

        @property
        def tip_form_radius(self) -> float:
            """abs(r_Fa), where the flank ends [mm]."""

        @property
        def form_radius(self) -> float:
            """abs(r_Ff), where fillet and involute meet [mm]."""

        def tooth_thickness_at(self, radius: float) -> float:
            """Transverse tooth thickness at a radius, an arc [mm]."""

    @property
    def tooth_count(self) -> int:
        """abs(z)."""
        return abs(self.teeth)

    @property
    def transverse_module(self) -> float:
        """m_t = m_n/cos(beta) [mm]."""
        return self.normal_module / cos(self.helix_angle)

    @property
    def transverse_pressure_angle(self) -> float:
        """alpha_t, tan(alpha_t) = tan(alpha_n)/cos(beta) [rad]."""
        return atan(tan(self.pressure_angle) / cos(self.helix_angle))

    @property
    def base_helix_angle(self) -> float:
        """beta_b, sin(beta_b) = sin(beta) cos(alpha_n), signed as the helix angle [rad]."""
        return asin(sin(self.helix_angle) * cos(self.pressure_angle))

    @property
    def base_pitch(self) -> float:
        """Transverse base pitch p_et = pi m_t cos(alpha_t) [mm]."""
        return pi * self.transverse_module * cos(self.transverse_pressure_angle)

    @cached_property
    def reference_radius(self) -> float:
        """Reference radius abs(r) = abs(d)/2 = abs(z) m_t/2 [mm]."""
        return 0.5 * self.tooth_count * self.transverse_module

    @cached_property
    def base_radius(self) -> float:
        """abs(r_b) = abs(r) cos(alpha_t) [mm]."""
        return self.reference_radius * cos(self.transverse_pressure_angle)

    def roll_length(self, radius: float) -> float:
        """Roll length of the involute at a radius, sqrt(r^2 - r_b^2) [mm]; zero at the base circle."""
        if radius < self.base_radius * (1.0 - 1e-12):
            raise InputError(
                f"{self.name}: radius {plain(radius, 6)} mm lies inside the base circle, radius "
                f"{plain(self.base_radius, 6)} mm"
            )
        return sqrt(max(0.0, (radius - self.base_radius) * (radius + self.base_radius)))

    def radius_at_roll_length(self, roll_length: float) -> float:
        """Radius of the involute at a roll length, sqrt(a^2 + r_b^2) [mm]."""
        return hypot(roll_length, self.base_radius)

    def involute_at(self, radius: float) -> float:
        """Involute inv(alpha_r) of the transverse pressure angle at a radius [rad]."""
        tangent = self.roll_length(radius) / self.base_radius
        return tangent - atan(tangent)


class InvoluteMesh:
    """Two gears with involute teeth on parallel axes.

    References
    ----------
    ISO 21771:2007, Gears - Cylindrical involute gears and gear pairs - Concepts and geometry.
    """

    pinion: CylindricalGear
    centre_distance: float | None
    axial_offset: float

    if TYPE_CHECKING:  # a field or a property of each mesh

        @property
        def wheel(self) -> InvoluteGear:
            """The mating gear."""

        @property
        def path_of_contact(self) -> PathOfContact:
            """Points on the line of action."""

        @property
        def mating_tip_rolls(self) -> tuple[float, float]:
            """Roll lengths on pinion and wheel where the tip of the mating gear touches [mm]."""

        @property
        def base_distance(self) -> float:
            """Centre distance at which the base circles touch: abs(r_b2 + r_b1) with the signs of ISO 21771 [mm]."""

        @property
        def pinion_working_radius(self) -> float:
            """r_w1 [mm]."""

        @property
        def pinion_active_profile(self) -> ActiveProfile:
            """Part of the pinion's flank that the mating gear uses."""

        def backlash_at(self, centre_distance: float) -> float:
            """Backlash at another centre distance [mm]."""

    @property
    def _profile_shift_sum(self) -> float:
        return self.pinion.profile_shift + self.wheel.profile_shift

    @property
    def _involute_without_backlash(self) -> float:
        """inv(alpha_wt) at which the profile shifts leave no backlash [rad]."""
        teeth, angle = self.pinion.teeth + self.wheel.teeth, self.pinion.pressure_angle
        return involute_without_backlash(teeth, self._profile_shift_sum, angle, self.pinion.transverse_pressure_angle)

    @cached_property
    def working_centre_distance(self) -> float:
        """abs(a) as given, or the one at which teeth without thickness allowance have no backlash [mm]."""
        if self.centre_distance is not None:
            return self.centre_distance
        return self.base_distance / cos(inverse_involute(self._involute_without_backlash))

    @property
    def working_pressure_angle(self) -> float:
        """Transverse working pressure angle alpha_wt, cos(alpha_wt) = abs((r_b1 + r_b2)/a) [rad]."""
        return working_pressure_angle(self.working_centre_distance, self.base_distance)

    @property
    def line_of_action(self) -> float:
        """T1T2 = abs(a) sin(alpha_wt) [mm]."""
        return line_of_action(self.working_centre_distance, self.base_distance)

    @property
    def profile_shift_sum_without_backlash(self) -> float:
        """x1 + x2 that would leave no backlash at this centre distance, without thickness allowances."""
        return profile_shift_sum(
            (self.pinion.teeth, self.wheel.teeth),
            self.pinion.normal_module,
            pressure_angle=self.pinion.pressure_angle,
            helix_angle=self.pinion.helix_angle,
            centre_distance=self.working_centre_distance,
        )

    def check_common_flank(self) -> None:
        """Refuse flanks that do not meet on the line of action."""
        if self.path_of_contact.AE <= 0.0:
            raise GeometryError(
                f"{self.pinion.name} and {self.wheel.name}: no common flank at centre distance "
                f"{plain(self.working_centre_distance, 6)} mm: on the line of action the usable flanks end "
                f"{-self.path_of_contact.AE:.4f} mm apart"
            )

    @property
    def common_face_width(self) -> float:
        """Face width that both gears cover [mm]; that of the narrower one where their faces lie apart."""
        widths = self.pinion.face_width, self.wheel.face_width
        covered = 0.5 * sum(widths) - abs(self.axial_offset)
        return min(*widths, covered) if covered > 0.0 else min(widths)

    @property
    def transverse_contact_ratio(self) -> float:
        """eps_alpha = g_alpha/p_et."""
        return self.path_of_contact.AE / self.pinion.base_pitch

    @property
    def overlap_ratio(self) -> float:
        """eps_beta = b sin(abs(beta))/(pi m_n), b the common face width."""
        return self.common_face_width * sin(abs(self.pinion.helix_angle)) / (pi * self.pinion.normal_module)

    @property
    def total_contact_ratio(self) -> float:
        """eps_gamma = eps_alpha + eps_beta."""
        return self.transverse_contact_ratio + self.overlap_ratio

    @property
    def backlash(self) -> float:
        """Circumferential backlash j_wt at the working circles; negative where the teeth overlap [mm]."""
        return self.backlash_at(self.working_centre_distance)

    @property
    def normal_backlash(self) -> float:
        """Normal backlash j_bn = j_wt cos(alpha_wt) cos(beta_b): shortest way between the back flanks [mm]."""
        return self.backlash * cos(self.working_pressure_angle) * cos(self.pinion.base_helix_angle)

    def base_tangential_force(self, pinion_torque: float) -> float:
        """F_bt = T1/r_b1, along the line of action in the transverse section [N]; torque in N mm."""
        return pinion_torque / self.pinion.base_radius

    def normal_force(self, pinion_torque: float) -> float:
        """F_bn = F_bt/cos(beta_b), the force normal to the flanks [N]; torque in N mm."""
        return self.base_tangential_force(pinion_torque) / cos(self.pinion.base_helix_angle)


def line_of_action(centre_distance: float, base_distance: float) -> float:
    """T1T2 = a sin(alpha_wt) [mm], without the loss of digits of the sine near alpha_wt = 0.

    Parameters
    ----------
    centre_distance, base_distance : float [mm]
        abs(a), and that at which the base circles touch, not above it.
    """
    return sqrt((centre_distance - base_distance) * (centre_distance + base_distance))


def working_pressure_angle(centre_distance: float, base_distance: float) -> float:
    """Transverse working pressure angle alpha_wt [rad]; arguments as of :func:`line_of_action`."""
    return atan(line_of_action(centre_distance, base_distance) / base_distance)


def involute_without_backlash(
    teeth: int, shift_sum: float, pressure_angle: float, transverse_pressure_angle: float
) -> float:
    """inv(alpha_wt) at which profile shifts leave no backlash, of the sums z1 + z2 and x1 + x2 [rad]; angles in rad."""
    return involute(transverse_pressure_angle) + 2.0 * shift_sum * tan(pressure_angle) / teeth


def profile_shift_sum(
    teeth: tuple[int, int],
    normal_module: float,
    *,
    pressure_angle: float,
    helix_angle: float,
    centre_distance: float,
) -> float:
    r"""Sum of the profile shift coefficients that leaves no backlash at a centre distance.

    .. math:: x_1 + x_2 = \frac{(z_1 + z_2)(\mathrm{inv}\,\alpha_{wt} - \mathrm{inv}\,\alpha_t)}{2 \tan\alpha_n},
              \qquad \cos\alpha_{wt} = |(z_1 + z_2) m_t \cos\alpha_t/(2 a)|

    Parameters
    ----------
    teeth : (int, int)
        z1, z2; that of a ring negative.
    normal_module : float [mm]
    pressure_angle, helix_angle : float [rad]
        Normal pressure angle; helix angle of either sign.
    centre_distance : float [mm]
        abs(a).

    Raises
    ------
    GeometryError
        If the base circles reach each other.

    References
    ----------
    ISO 21771:2007, 5.4.4 and 5.5.

    Examples
    --------
    >>> from math import radians
    >>> round(profile_shift_sum((34, 57), 3.0, pressure_angle=radians(20), helix_angle=0.0, centre_distance=138.0), 4)
    0.52
    >>> round(profile_shift_sum((25, -60), 3.0, pressure_angle=radians(20), helix_angle=0.0, centre_distance=52.0), 4)
    0.1605
    """
    angle = atan(tan(pressure_angle) / cos(helix_angle))
    base = 0.5 * abs(sum(teeth)) * normal_module / cos(helix_angle) * cos(angle)
    if not centre_distance > base:
        radii = "both base radii" if teeth[1] > 0 else "the difference of both base radii"
        raise GeometryError(f"centre_distance: {plain(centre_distance, 6)} mm is not above {base:.4f} mm, {radii}")
    difference = involute(working_pressure_angle(centre_distance, base)) - involute(angle)
    return 0.5 * sum(teeth) * difference / tan(pressure_angle)
