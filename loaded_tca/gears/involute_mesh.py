"""What meshes of external pairs and of pinion and ring have in common: contact ratios, forces, backlash (ISO 21771)."""

from __future__ import annotations

from math import cos, pi, sin
from typing import TYPE_CHECKING

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

    if TYPE_CHECKING:  # a field or a property of each mesh

        @property
        def wheel(self) -> InvoluteGear:
            """The mating gear."""

        @property
        def path_of_contact(self) -> PathOfContact:
            """Points on the line of action."""

        @property
        def working_centre_distance(self) -> float:
            """abs(a) [mm]."""

        @property
        def working_pressure_angle(self) -> float:
            """alpha_wt [rad]."""

        @property
        def pinion_working_radius(self) -> float:
            """r_w1 [mm]."""

        @property
        def pinion_active_profile(self) -> ActiveProfile:
            """Part of the pinion's flank that the mating gear uses."""

        def backlash_at(self, centre_distance: float) -> float:
            """Backlash at another centre distance [mm]."""

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
