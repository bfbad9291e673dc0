r"""Virtual cylindrical gears of bevel and hypoid pairs (ISO 10300-1, annex A): contact ratios, relative curvature.

The standard rates a pair by two helical gears that stand for it at the calculation point. What is here is for
comparison: surfaces of a hypoid pair touch along lines whose direction depends on the radius of the cutter too, and
their relative curvature is a few percent larger. Lengths are in mm, angles in rad.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, cos, pi, sin, sqrt, tan

from loaded_tca.arguments import checked
from loaded_tca.errors import require_positive

Both = tuple[float, float]


@checked
@dataclass(frozen=True)
class VirtualPair:
    r"""Virtual cylindrical gears of a pair.

    Parameters
    ----------
    pitch_angles, mean_cone_distances, spiral_angles : (float, float) [rad], [mm], [rad]
        delta, R_m, beta_m of pinion and wheel.
    offset_angles : (float, float) [rad]
        zeta_m and zeta_mp; both zero without an offset.
    pressure_angle, limit_pressure_angle : float [rad]
        alpha_n of the flank, and alpha_lim; the effective pressure angle is their difference.
    mean_normal_module : float [mm]
    mean_addenda : (float, float) [mm]
    effective_width : float [mm]
        b_2,eff of the wheel, usually 0.85 b_2.

    Raises
    ------
    InputError
        If a length is not positive.

    References
    ----------
    ISO 10300-1:2023, annex A, formulas A.8 to A.25 and A.37 to A.39.
    """

    pitch_angles: Both
    mean_cone_distances: Both
    spiral_angles: Both
    offset_angles: Both
    pressure_angle: float
    limit_pressure_angle: float
    mean_normal_module: float
    mean_addenda: Both
    effective_width: float

    def __post_init__(self) -> None:
        first, second = self.mean_cone_distances
        require_positive(
            pinion_cone_distance=first,
            wheel_cone_distance=second,
            mean_normal_module=self.mean_normal_module,
            effective_width=self.effective_width,
        )

    @property
    def effective_pressure_angle(self) -> float:
        """alpha_e [rad]."""
        return self.pressure_angle - self.limit_pressure_angle

    @property
    def spiral_angle(self) -> float:
        """beta_v [rad]."""
        return 0.5 * sum(self.spiral_angles)

    @property
    def transverse_pressure_angle(self) -> float:
        """alpha_vet [rad]."""
        return atan(tan(self.effective_pressure_angle) / cos(self.spiral_angle))

    @property
    def path_length(self) -> float:
        """g_v_alpha, of the path of contact in the transverse section [mm]."""
        length, pressure = 0.0, self.transverse_pressure_angle
        for pitch, distance, addendum in zip(
            self.pitch_angles, self.mean_cone_distances, self.mean_addenda, strict=True
        ):
            diameter = 2.0 * distance * tan(pitch)
            tip, base = diameter + 2.0 * addendum, diameter * cos(pressure)
            length += 0.5 * (sqrt(tip**2 - base**2) - diameter * sin(pressure))
        return length

    @property
    def contact_ratios(self) -> Both:
        r"""eps_v_alpha and eps_v_beta, profile and face contact ratio.

        With the offset the face width of the virtual gears is

        .. math:: b_{v,eff} = \frac{b_{2,eff}/\cos(\zeta_{mp}/2) - g_{v\alpha} \cos\alpha_{vet} \tan(\zeta_{mp}/2)}
                  {1 - \tan\gamma' \tan(\zeta_{mp}/2)}, \qquad
                  \gamma' = \arctan(\sin\delta_2 \tan\zeta_m) - \zeta_{mp}/2 .
        """
        spiral, pressure, module = self.spiral_angle, self.transverse_pressure_angle, self.mean_normal_module
        profile = self.path_length * cos(spiral) / (pi * module * cos(pressure))
        axial, half = self.offset_angles[0], 0.5 * self.offset_angles[1]
        turn = atan(sin(self.pitch_angles[1]) * tan(axial)) - half
        width = self.effective_width / cos(half) - self.path_length * cos(pressure) * tan(half)
        width /= 1.0 - tan(turn) * tan(half)
        return profile, width * sin(spiral) / (pi * module)

    @property
    def contact_line_angle(self) -> float:
        """beta_B, of the contact line against the tooth [rad]."""
        return atan(tan(self.spiral_angle) * sin(self.effective_pressure_angle))

    @property
    def normal_radius(self) -> float:
        r"""rho_t, of relative curvature in the section normal to the tooth [mm].

        .. math:: \frac{1}{\varrho_t} = \frac{1}{\cos\alpha_n (\tan\alpha_n - \tan\alpha_{lim})
                  + \tan\zeta_{mp} \tan\beta_B} \frac{\cos\beta_{m1} \cos\beta_{m2}}{\cos\zeta_{mp}}
                  \left(\frac{1}{R_{m1} \tan\delta_1} + \frac{1}{R_{m2} \tan\delta_2}\right)
        """
        pressure, limit, zeta = self.pressure_angle, self.limit_pressure_angle, self.offset_angles[1]
        bends = sum(
            1.0 / (distance * tan(pitch))
            for pitch, distance in zip(self.pitch_angles, self.mean_cone_distances, strict=True)
        )
        first, second = self.spiral_angles
        lean = cos(pressure) * (tan(pressure) - tan(limit)) + tan(zeta) * tan(self.contact_line_angle)
        return lean * cos(zeta) / (cos(first) * cos(second) * bends)

    @property
    def relative_radius(self) -> float:
        """rho_rel, of relative curvature across the contact line [mm]."""
        return self.normal_radius * cos(self.contact_line_angle) ** 2
