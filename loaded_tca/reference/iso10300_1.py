r"""Bevel and hypoid pairs after ISO 10300-1: virtual cylindrical gears of method B1 (annex A), and load factors.

The standard rates a pair by two helical gears that stand for it at the calculation point. Surfaces of a hypoid pair
touch along lines whose direction depends on the radius of the cutter too, and their relative curvature is a few percent
larger. Lengths are in mm, angles in rad.

Edition of 2023, whose text was not seen: formulas and their numbers are those of the open program ISO10300Calc
(afuentesaz/AGMAStandards); every one that counts here gives the numbers that samples 1 to 4 of ISO/TR 10300-30:2024
print. Where that program leaves a sample, the formula here follows the sample: contact lines end at the ends of the
zone of action, C_lb is the product that formula A.36 prints, C_v3 and C_v4 are those of ISO 6336-1, and pitch
deviations count over b_v.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import asin, atan, cos, degrees, inf, log10, pi, sin, sqrt, tan
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, interval_check
from loaded_tca.errors import require, require_positive
from loaded_tca.plain import plain
from loaded_tca.reference.iso6336_1 import dynamic_coefficients

Both = tuple[float, float]

EFFECTIVE_SHARE = 0.85
"""b_2,eff/b_2 of a design, whose contact pattern under load is not known yet."""
SINGLE_STIFFNESS, MESH_STIFFNESS = 14.0, 20.0
"""c' and c_gamma of the standard for steel under average conditions [N/(mm um)]."""
FULL_LOAD = 100.0
"""F_vmt K_A/b_v,eff below which both fall in proportion [N/mm]."""
_GRAZING = 1e-9  # rad, of the spiral angle at the base circle: contact lines of straight teeth lie along the face


class ContactLines(NamedTuple):
    """Contact lines of a virtual pair: at the tip, in the middle, at the root (table A.2, A.26 to A.36).

    Attributes
    ----------
    places, lengths : (float, float, float) [mm]
        f, distance from the middle of the zone of action, and l_b; 0 where the line lies outside it.
    farthest : float [mm]
        f_max, where contact lines end.
    """

    places: tuple[float, float, float]
    lengths: tuple[float, float, float]
    farthest: float


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
    effective_share : float
        b_2,eff/b_2.

    Raises
    ------
    InputError
        If a length is not positive.

    References
    ----------
    ISO 10300-1:2023, annex A.
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
    effective_share: float = EFFECTIVE_SHARE

    def __post_init__(self) -> None:
        first, second = self.mean_cone_distances
        require(
            (0.0 < self.effective_share <= 1.0, f"effective_share: {self.effective_share}; allowed above 0, up to 1"),
        )
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
    def diameters(self) -> Both:
        """d_v = d_m/cos(delta) of pinion and wheel (A.1) [mm]."""
        first, second = (
            2.0 * distance * tan(pitch)
            for pitch, distance in zip(self.pitch_angles, self.mean_cone_distances, strict=True)
        )
        return first, second

    @property
    def tip_diameters(self) -> Both:
        """d_va (A.6) [mm]."""
        (first, second), (one, other) = self.diameters, self.mean_addenda
        return first + 2.0 * one, second + 2.0 * other

    @property
    def base_diameters(self) -> Both:
        """d_vb (A.9) [mm]."""
        first, second = self.diameters
        share = cos(self.transverse_pressure_angle)
        return share * first, share * second

    @property
    def teeth(self) -> Both:
        """z_v, no whole numbers (A.14, A.15)."""
        first, second = self.diameters
        module = self.mean_normal_module / cos(self.spiral_angle)
        return first / module, second / module

    @property
    def normal_teeth(self) -> Both:
        """z_vn, of the virtual gears in the normal section (A.41, A.42)."""
        first, second = self.teeth
        share = 1.0 / (cos(self.base_spiral_angle) ** 2 * cos(self.spiral_angle))
        return share * first, share * second

    @property
    def normal_tip_diameters(self) -> Both:
        """d_van (A.43, A.44) [mm]."""
        (first, second), (one, other), module = self.normal_teeth, self.mean_addenda, self.mean_normal_module
        return first * module + 2.0 * one, second * module + 2.0 * other

    @property
    def base_spiral_angle(self) -> float:
        """beta_vb, of the virtual gears at their base circles (A.16) [rad]."""
        return asin(sin(self.spiral_angle) * cos(self.effective_pressure_angle))

    @property
    def base_pitch(self) -> float:
        """p_vet, transverse (A.17) [mm]."""
        return pi * self.mean_normal_module * cos(self.transverse_pressure_angle) / cos(self.spiral_angle)

    @property
    def path_length(self) -> float:
        """g_v_alpha, of the path of contact in the transverse section (A.18) [mm]."""
        length, pressure = 0.0, self.transverse_pressure_angle
        for diameter, tip, base in zip(self.diameters, self.tip_diameters, self.base_diameters, strict=True):
            length += 0.5 * (sqrt(tip**2 - base**2) - diameter * sin(pressure))
        return length

    @property
    def _turn(self) -> float:
        """gamma', between the faces of the virtual gears and the zone of action, projected (A.20, A.21) [rad]."""
        axial, half = self.offset_angles[0], 0.5 * self.offset_angles[1]
        return atan(sin(self.pitch_angles[1]) * tan(axial)) - half

    @property
    def widths(self) -> Both:
        r"""b_v,eff and b_v, effective and whole face width of the virtual gears (A.19, A.22) [mm].

        .. math:: b_{v,eff} = \frac{b_{2,eff}/\cos(\zeta_{mp}/2) - g_{v\alpha} \cos\alpha_{vet} \tan(\zeta_{mp}/2)}
                  {1 - \tan\gamma' \tan(\zeta_{mp}/2)}, \qquad
                  \gamma' = \arctan(\sin\delta_2 \tan\zeta_m) - \zeta_{mp}/2 .
        """
        half = 0.5 * self.offset_angles[1]
        width = self.effective_width / cos(half) - self.path_length * cos(self.transverse_pressure_angle) * tan(half)
        width /= 1.0 - tan(self._turn) * tan(half)
        return width, width / self.effective_share

    @property
    def contact_ratios(self) -> Both:
        """eps_v_alpha and eps_v_beta, profile and face contact ratio (A.23, A.24)."""
        spiral, module = self.spiral_angle, self.mean_normal_module
        return self.path_length / self.base_pitch, self.widths[0] * sin(spiral) / (pi * module)

    @property
    def total_contact_ratio(self) -> float:
        """eps_v_gamma, the sum of both (A.25)."""
        return sum(self.contact_ratios)

    @property
    def contact_lines(self) -> ContactLines:
        """Contact lines through the middle of the zone of action and a base pitch beside it."""
        base, reach = self.base_spiral_angle, self.path_length
        slope = tan(self._line_turn) + tan(base)
        half = 0.5 * cos(base)
        farthest = max(half * (reach + self.widths[0] * slope), half * (reach - self.widths[0] * slope))
        profile, face = self.contact_ratios
        apart = self.base_pitch * cos(base)
        behind = apart * (1.0 - 0.5 * profile) * max(0.0, 1.0 - face)
        places = (apart - behind, -behind, -apart - behind)
        lengths = [self._line_length(place, farthest) for place in places]
        return ContactLines(places, (lengths[0], lengths[1], lengths[2]), farthest)

    @property
    def _line_turn(self) -> float:
        """gamma, of the zone of action of a pair with an offset (A.35) [rad]."""
        return atan(tan(self._turn) / cos(self.transverse_pressure_angle))

    def _line_length(self, place: float, farthest: float) -> float:
        r"""l_b of the contact line at a distance f from the middle of the zone of action [mm].

        .. math:: l_b = l_{b0} (1 - C_{lb}), \qquad
                  C_{lb} = \sqrt{1 - (f/f_{max})^2} \left(1 - \sqrt{b_{v,eff}/b_v}\right)
        """
        if not abs(place) < farthest:
            return 0.0
        (effective, whole), base = self.widths, self.base_spiral_angle
        low, high = 0.0, effective
        if base > _GRAZING:
            middle = place * cos(base) + tan(base) * (place * sin(base) + 0.5 * effective)
            lean, half = tan(self._line_turn), 0.5 * self.path_length
            ends = ((middle + half * sign + 0.5 * effective * lean) / (lean + tan(base)) for sign in (-1.0, 1.0))
            low, high = (min(max(end, 0.0), effective) for end in ends)
        shortened = sqrt(1.0 - (place / farthest) ** 2) * (1.0 - sqrt(effective / whole))
        return abs(high - low) / cos(base) * (1.0 - shortened)

    @property
    def contact_line_angle(self) -> float:
        """beta_B, of the contact line against the tooth (A.38) [rad]."""
        return atan(tan(self.spiral_angle) * sin(self.effective_pressure_angle))

    @property
    def normal_radius(self) -> float:
        r"""rho_t, of relative curvature in the section normal to the tooth (A.39) [mm].

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
        """rho_rel, of relative curvature across the contact line (A.37) [mm]."""
        return self.normal_radius * cos(self.contact_line_angle) ** 2


LARGEST_SPIRAL, LARGEST_PRESSURE, LARGEST_WIDTH = 45.0, 30.0, 13.0
"""(beta_m1 + beta_m2)/2 and alpha_e [deg], and b over m_mn, above which experience has to confirm a rating."""
_ROUNDING = 1e-9


@checked
def scope_notes(pair: VirtualPair, face_width: float) -> tuple[str, ...]:
    """What of a pair lies outside the scope of the standard, a sentence for each.

    Parameters
    ----------
    pair : VirtualPair
    face_width : float [mm]
        b_2.

    References
    ----------
    ISO 10300-1 and ISO/TR 10300-30:2024, scope and its warning.

    Examples
    --------
    >>> pair = VirtualPair((0.3, 1.27), (80.0, 80.0), (0.9, 0.9), (0.0, 0.0), 0.35, 0.0, 3.0, (3.0, 3.0), 20.0)
    >>> scope_notes(pair, 25.0)
    ('scope: a mean spiral angle of 51.6 deg is above 45 deg',)
    """
    require_positive(face_width=face_width)
    spiral, pressure = degrees(pair.spiral_angle), degrees(pair.effective_pressure_angle)
    ratio, wide = pair.contact_ratios[0], face_width / pair.mean_normal_module
    cases = (
        (ratio >= 2.0, f"a profile contact ratio eps_v_alpha of {plain(ratio)} is not below 2"),
        (
            spiral > LARGEST_SPIRAL + _ROUNDING,
            f"a mean spiral angle of {plain(spiral, 3)} deg is above {plain(LARGEST_SPIRAL, 6)} deg",
        ),
        (
            pressure > LARGEST_PRESSURE + _ROUNDING,
            f"an effective pressure angle of {plain(pressure, 3)} deg is above {plain(LARGEST_PRESSURE, 6)} deg",
        ),
        (
            wide > LARGEST_WIDTH + _ROUNDING,
            f"a face width of {plain(wide, 3)} m_mn is above {plain(LARGEST_WIDTH, 6)} m_mn",
        ),
    )
    return tuple(f"scope: {words}" for holds, words in cases if holds)


@checked
def load_share(specific_load: ArrayLike) -> Array:
    """C_F, by which both stiffnesses fall below 100 N/mm of F_vmt K_A/b_v,eff (12, 13)."""
    load = np.asarray(specific_load, dtype=float)
    require(interval_check("specific_load", load, "(0, inf)", "N/mm"))
    return np.minimum(load / FULL_LOAD, 1.0)


@checked
def reduced_mass(mean_diameters: Both, pressure_angle: float, densities: Both = (7860.0, 7860.0)) -> float:
    r"""Reduced mass m_red of both gears as solid discs, for each mm of face width [kg/mm].

    .. math:: m^*= \frac{\pi}{8}\,\varrho\,\frac{d_m^2}{\cos^2\alpha_n}, \qquad
        m_{red} = \frac{m_1^* m_2^*}{m_1^*+ m_2^*}

    Parameters
    ----------
    mean_diameters : (float, float) [mm]
        d_m.
    pressure_angle : float [rad]
        (alpha_nD + alpha_nC)/2, the mean of both flanks.
    densities : (float, float) [kg/m3]

    References
    ----------
    ISO 10300-1:2023, formulas (10), (14).

    Examples
    --------
    >>> from math import radians
    >>> round(reduced_mass((54.918, 152.987), radians(20.0)), 6)
    0.009339
    """
    (first, second), (light, heavy) = mean_diameters, densities
    require_positive(pinion_diameter=first, wheel_diameter=second, pinion_density=light, wheel_density=heavy)
    require((0.0 < pressure_angle < 0.25 * pi, f"pressure_angle: {pressure_angle} rad is not between 0 and 45 deg"))
    masses = [
        pi / 8.0 * 1e-9 * density * (each / cos(pressure_angle)) ** 2
        for each, density in zip(mean_diameters, densities, strict=True)
    ]
    return masses[0] * masses[1] / (masses[0] + masses[1])


class BevelDynamicFactor(NamedTuple):
    """K_v of each load, and what lies outside the method."""

    K_v: Array
    notes: tuple[str, ...]


@checked
def dynamic_factor(
    resonance_ratio: ArrayLike,
    specific_load: ArrayLike,
    *,
    pitch_deviation: ArrayLike,
    total_contact_ratio: float,
    single_stiffness: ArrayLike = SINGLE_STIFFNESS,
) -> BevelDynamicFactor:
    r"""Dynamic factor K_v by method B.

    .. math::
        B_p = \frac{c' f_{p,eff}}{F_{vmt} K_A/b_v}, \qquad
        K_v = \begin{cases}
        1 + N (C_{v1,2} B_p + C_{v3}) & N \le 0.75\\
        1 + C_{v1,2} B_p + C_{v4} & 0.75 < N \le 1.25\\
        C_{v5,6} B_p + C_{v7} & N \ge 1.5\end{cases}

    and a straight line over N between 1.25 and 1.5, with the C_v of ISO 6336-1.

    Parameters
    ----------
    resonance_ratio : array
        N = n_1/n_E1, with :func:`loaded_tca.reference.iso6336_1.resonance_speed`.
    specific_load : array [N/mm]
        F_vmt K_A/b_v.
    pitch_deviation : array [um]
        f_p,eff, of the wheel after running in.
    total_contact_ratio : float
        eps_v_gamma.
    single_stiffness : array [N/(mm um)]
        c', with its fall by :func:`load_share`.

    Returns
    -------
    BevelDynamicFactor

    References
    ----------
    ISO 10300-1:2023, formulas (8) to (21), table 3. Samples of ISO/TR 10300-30 lie below N = 0.1: coefficients of the
    other ranges are those of ISO 6336-1, and are checked by nothing else.

    Examples
    --------
    Sample 1, printed 1.020:

    >>> load = 1.1 * 10925.3 / 25.4
    >>> factor = dynamic_factor(0.038, load, pitch_deviation=26.0 - 1.95, total_contact_ratio=2.392)
    >>> round(float(factor.K_v), 3)
    1.02
    """
    ratio, load, deviation = (
        np.asarray(each, dtype=float) for each in (resonance_ratio, specific_load, pitch_deviation)
    )
    require(
        interval_check("resonance_ratio", ratio, "[0, inf)"),
        interval_check("specific_load", load, "(0, inf)", "N/mm"),
        interval_check("pitch_deviation", deviation, "[0, inf)", "um"),
        (1.0 < total_contact_ratio < inf, f"total_contact_ratio: {total_contact_ratio} is not above 1 and finite"),
    )
    first, second, third, fourth, fifth, sixth, seventh = dynamic_coefficients(total_contact_ratio)
    pitch = np.asarray(single_stiffness, dtype=float) * deviation / load
    below = 1.0 + ratio * ((first + second) * pitch + third)
    main = 1.0 + (first + second) * pitch + fourth
    above = (fifth + sixth) * pitch + seventh
    between = above + (main - above) * (1.5 - ratio) / 0.25
    value = np.select([ratio <= 0.75, ratio <= 1.25, ratio < 1.5], [below, main, between], above)
    cases = (
        ((ratio > 0.75) & (ratio <= 1.25), "K_v: N lies in the main resonance, which the standard says to avoid"),
        ((ratio > 1.25) & (ratio < 1.5), "K_v: N lies between main resonance and supercritical range"),
    )
    return BevelDynamicFactor(np.maximum(value, 1.0), tuple(words for holds, words in cases if bool(np.any(holds))))


EMPIRICAL_GRADES = range(5, 9)
"""Accuracy grades of ISO 17485 for which K_v by method C was found."""


@checked
def dynamic_factor_by_grade(outer_velocity: ArrayLike, grade: int) -> BevelDynamicFactor:
    r"""Dynamic factor K_v by method C, from the accuracy grade alone.

    .. math:: K_v = \left(\frac{A}{A + \sqrt{200\,v_{et2}}}\right)^{-X}, \qquad X = 0.25 (B - 4)^{0.667}, \qquad
              A = 50 + 56 (1 - X)

    Parameters
    ----------
    outer_velocity : array [m/s]
        v_et2, of the wheel at its outer pitch diameter.
    grade : int
        B of ISO 17485, 5 to 8; of finer ones K_v is 1 to 1.1.

    Returns
    -------
    BevelDynamicFactor

    References
    ----------
    ISO 10300-1:2023, formulas (22) to (27); the curve is that of AGMA 2001 and 2003 with Q_v = 16 - B.

    Examples
    --------
    >>> round(float(dynamic_factor_by_grade(10.0, 6).K_v), 3)
    1.185
    """
    speed = np.asarray(outer_velocity, dtype=float)
    require(
        interval_check("outer_velocity", speed, "[0, inf)", "m/s"),
        (
            grade in EMPIRICAL_GRADES,
            f"grade: {grade} is not one of {min(EMPIRICAL_GRADES)} to {max(EMPIRICAL_GRADES)}",
        ),
    )
    exponent = 0.25 * (grade - 4.0) ** 0.667
    constant = 50.0 + 56.0 * (1.0 - exponent)
    fastest = (constant + 13.0 - grade) ** 2 / 200.0
    notes = (f"K_v: the velocity is above {plain(fastest, 3)} m/s, the largest of method C for grade {grade}",)
    factor = (constant / (constant + np.sqrt(200.0 * speed))) ** -exponent
    return BevelDynamicFactor(factor, notes if bool(np.any(speed > fastest)) else ())


MOUNTINGS = {
    "pattern under full load": (1.00, 1.00, 1.00),
    "pattern under light test load": (1.05, 1.10, 1.25),
    "pattern estimated": (1.20, 1.32, 1.50),
}
"""How the contact pattern was seen -> K_Hbeta-be with no, one and both gears mounted on one side (table 4)."""


@checked
def contact_face_load_factor(pattern: str, overhung: int) -> float:
    r"""Face load factor K_Hbeta by method C, :math:`1.5 K_{H\beta-be}`, for b_2,eff from 0.85 b_2 on.

    Parameters
    ----------
    pattern : str
        How the contact pattern was seen, one of ``MOUNTINGS``.
    overhung : int
        How many of both gears are mounted on one side of their bearings.

    References
    ----------
    ISO 10300-1:2023, formula (28), table 4.

    Examples
    --------
    Samples 1 to 3, printed 1.65:

    >>> round(contact_face_load_factor("pattern under light test load", 1), 4)
    1.65
    """
    require(
        (pattern in MOUNTINGS, f"pattern: {pattern!r} is not one of {', '.join(MOUNTINGS)}"),
        (overhung in (0, 1, 2), f"overhung: {overhung}; allowed 0, 1, 2"),
    )
    return 1.5 * MOUNTINGS[pattern][overhung]


@checked
def lengthwise_curvature_factor(cutter_radius: float, mean_cone_distance: float, spiral_angle: float) -> float:
    r"""K_F0, by which curved teeth carry off-centre loads with less root stress: K_Fbeta = K_Hbeta/K_F0.

    .. math:: K_{F0} = 0.211 \left(\frac{r_{c0}}{R_{m2}}\right)^q + 0.789, \qquad q = \frac{0.279}{\lg \sin\beta_{m2}}

    within 1 and 1.15; 1 of straight teeth, and of cutters larger than R_m2.

    Parameters
    ----------
    cutter_radius, mean_cone_distance : float [mm]
        r_c0; inf: none. R_m2.
    spiral_angle : float [rad]
        beta_m2.

    References
    ----------
    ISO 10300-1:2023, formulas (32) to (35).

    Examples
    --------
    Sample 2, printed 1.060:

    >>> from math import radians
    >>> round(lengthwise_curvature_factor(63.5, 76.335, radians(38.610)), 3)
    1.06
    """
    require_positive(mean_cone_distance=mean_cone_distance)
    require(
        (cutter_radius > 0.0, f"cutter_radius: {cutter_radius} mm is not positive"),
        (0.0 <= spiral_angle < 0.5 * pi, f"spiral_angle: {spiral_angle} rad is not between 0 and 90 deg"),
    )
    if spiral_angle == 0.0 or cutter_radius > mean_cone_distance:
        return 1.0
    raised = (cutter_radius / mean_cone_distance) ** (0.279 / log10(sin(spiral_angle)))
    return min(max(0.211 * raised + 0.789, 1.0), 1.15)


@checked
def transverse_load_factor(
    specific_load: ArrayLike,
    *,
    mesh_stiffness: ArrayLike,
    pitch_deviation: ArrayLike,
    total_contact_ratio: float,
    relative_offset: float = 0.0,
) -> Array:
    r"""Transverse load factors K_Halpha = K_Falpha by method B.

    .. math::
        K^*= 0.9 + 0.4\,\frac{c_\gamma (f_{pt} - y_\alpha)}{F_{mtH}/b_v} \cdot
        \begin{cases} \varepsilon_{v\gamma}/2 & \varepsilon_{v\gamma} \le 2\\
        \sqrt{2 (\varepsilon_{v\gamma} - 1)/\varepsilon_{v\gamma}} & \varepsilon_{v\gamma} > 2 \end{cases}, \qquad
        K = K^*- (K^*- 1)\,\frac{a_{rel}}{0.1}

    with a_rel up to 0.1, no smaller than 1.

    Parameters
    ----------
    specific_load : array [N/mm]
        F_mtH/b_v = F_vmt K_A K_v K_Hbeta/b_v.
    mesh_stiffness : array [N/(mm um)]
        c_gamma.
    pitch_deviation : array [um]
        f_pt - y_alpha, of the wheel.
    total_contact_ratio : float
        eps_v_gamma.
    relative_offset : float
        a_rel = 2 |a|/d_m2.

    References
    ----------
    ISO 10300-1:2023, formulas (40), (41), (46) to (48). Upper bounds of the standard are not held: their formulas were
    not found.

    Examples
    --------
    Sample 1, printed 1.161, and sample 3 without its offset, printed 1.109:

    >>> def factor(force, deviation, ratio):
    ...     return transverse_load_factor(
    ...         force, mesh_stiffness=20.0, pitch_deviation=deviation, total_contact_ratio=ratio
    ...     )
    >>> round(float(factor(1.1 * 1.0204 * 1.65 * 10925.3 / 25.4, 24.05, 2.392)), 3)
    1.161
    >>> round(float(factor(20995.2 / 23.507, 23.125, 2.036)), 3)
    1.109
    """
    load, stiffness, deviation = (
        np.asarray(each, dtype=float) for each in (specific_load, mesh_stiffness, pitch_deviation)
    )
    require(
        interval_check("specific_load", load, "(0, inf)", "N/mm"),
        interval_check("mesh_stiffness", stiffness, "(0, inf)", "N/(mm um)"),
        interval_check("pitch_deviation", deviation, "[0, inf)", "um"),
        (1.0 < total_contact_ratio < inf, f"total_contact_ratio: {total_contact_ratio} is not above 1 and finite"),
        (0.0 <= relative_offset < inf, f"relative_offset: {relative_offset} is negative or not finite"),
    )
    ratio = total_contact_ratio
    weight = 0.5 * ratio if ratio <= 2.0 else sqrt(2.0 * (ratio - 1.0) / ratio)
    without = 0.9 + 0.4 * weight * stiffness * deviation / load
    return np.maximum(1.0, without - (without - 1.0) * min(relative_offset, 0.1) / 0.1)
