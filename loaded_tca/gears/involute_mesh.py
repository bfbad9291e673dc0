"""What meshes of external pairs and of pinion and ring have in common: contact ratios, forces, backlash (ISO 21771)."""

from __future__ import annotations

from functools import cached_property
from math import atan, cos, pi, sin, sqrt
from typing import TYPE_CHECKING

from loaded_tca.errors import GeometryError
from loaded_tca.gears.involute import inverse_involute

if TYPE_CHECKING:
    from loaded_tca.gears.cylindrical import CylindricalGear
    from loaded_tca.gears.cylindrical_mesh import ActiveProfile, PathOfContact
    from loaded_tca.gears.involute_gear import InvoluteGear


class InvoluteMesh:
    """Two gears with involute teeth on parallel axes.

    References
    ----------
    ISO 21771:2007, Gears - Cylindrical involute gears and gear pairs - Concepts and geometry.
    """

    pinion: CylindricalGear
    centre_distance: float | None

    if TYPE_CHECKING:  # a field or a property of each mesh

        @property
        def wheel(self) -> InvoluteGear:
            """The mating gear."""

        @property
        def path_of_contact(self) -> PathOfContact:
            """Points on the line of action."""

        @property
        def base_distance(self) -> float:
            """Centre distance at which the base circles touch: abs(r_b2 + r_b1) with the signs of ISO 21771 [mm]."""

        @property
        def _involute_without_backlash(self) -> float:
            """inv(alpha_wt) at which the profile shifts leave no backlash [rad]."""

        @property
        def pinion_working_radius(self) -> float:
            """r_w1 [mm]."""

        @property
        def pinion_active_profile(self) -> ActiveProfile:
            """Part of the pinion's flank that the mating gear uses."""

        def backlash_at(self, centre_distance: float) -> float:
            """Backlash at another centre distance [mm]."""

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

    def check_common_flank(self) -> None:
        """Refuse flanks that do not meet on the line of action."""
        if self.path_of_contact.AE <= 0.0:
            raise GeometryError(
                f"{self.pinion.name} and {self.wheel.name}: no common flank at centre distance"
                f" {self.working_centre_distance:.6g} mm: on the line of action the usable flanks end"
                f" {-self.path_of_contact.AE:.4f} mm apart"
            )

    @property
    def common_face_width(self) -> float:
        """Face width that both gears cover, mid-faces together [mm]."""
        return min(self.pinion.face_width, self.wheel.face_width)

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
