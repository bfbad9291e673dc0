"""ISO 6336-3, method B, for cylindrical gears: nominal tooth root stress; by name what roots withstand, too.

Load at the outer point of single contact, bending of the section where tangents of 30 degrees, of rings of 60 degrees,
touch both fillets, and a factor for the notch; a factor of its own for thin rims. Formulas of the edition of 2006, of
rings with its corrigendum of 2007; the examples are FZG C14 gears of GEARpie and the rings of the NREL 5 MW gearbox.
What the edition of 2019, whose text was not seen, changed: ``load_distribution_factor`` belongs to Y_F, and
``helix_angle_factor`` has an edition. The strength and its factors are in ``iso6336_3_strength``.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import acos, copysign, cos, degrees, hypot, inf, log, pi, radians, sin, sqrt, tan

import numpy as np
from numpy.typing import ArrayLike

import loaded_tca.roots as roots
from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, interval_check
from loaded_tca.errors import GeometryError, require, require_positive
from loaded_tca.plain import plain
from loaded_tca.reference.iso6336 import virtual_teeth
from loaded_tca.reference.iso6336_3_strength import RootFactors, RootStrength, root_factors

__all__ = [
    "THINNEST_RIM",
    "THINNEST_RING",
    "THIN_RIM",
    "THIN_RING",
    "RootFactors",
    "RootSection",
    "RootStrength",
    "cut_root_radius",
    "deep_tooth_factor",
    "face_load_factor",
    "helix_angle_factor",
    "load_distribution_factor",
    "nominal_root_stress",
    "rim_thickness_factor",
    "ring_rim_factor",
    "root_factors",
    "root_section",
]

_HELIX_ANGLE_LIMIT = radians(30.0)
_TANGENT, _RING_TANGENT = pi / 3.0, pi / 6.0  # of tangents of 30 and 60 degrees against the middle of the tooth
_LARGEST_HEIGHT_OVER_WIDTH = 1.0 / 3.0
THIN_RIM, THINNEST_RIM = 1.2, 0.5
"""Thickness of a rim over the height of its teeth, s_R/h_t, below which it raises root stress; down to which the
standard knows by how much."""
THIN_RING, THINNEST_RING = 3.5, 1.75
"""The same of a ring, in normal modules, s_R/m_n."""


@dataclass(frozen=True)
class RootSection:
    """Critical section of a tooth, in normal modules.

    Attributes
    ----------
    thickness : float
        s_Fn/m_n, between the points where tangents of 30 degrees, of rings of 60 degrees, touch the fillets.
    lever : float
        h_Fe/m_n, of a load at the outer point of single contact.
    radius : float
        rho_F/m_n, of the fillet there.
    load_angle, pressure_angle : float [rad]
        alpha_Fen, of the load against the normal of the tooth's middle; alpha_n of the basic rack.
    """

    thickness: float
    lever: float
    radius: float
    load_angle: float
    pressure_angle: float

    @property
    def notch_parameter(self) -> float:
        """q_s, thickness over twice the radius of the fillet."""
        return 0.5 * self.thickness / self.radius

    @property
    def form_factor(self) -> float:
        r"""Form factor Y_F: nominal bending stress.

        .. math:: Y_F = \frac{6\,(h_{Fe}/m_n) \cos\alpha_{Fen}}{(s_{Fn}/m_n)^2 \cos\alpha_n}
        """
        return 6.0 * self.lever * cos(self.load_angle) / (self.thickness**2 * cos(self.pressure_angle))

    @property
    def stress_correction_factor(self) -> float:
        r"""Stress correction factor Y_S: the notch.

        .. math::
            Y_S = (1.2 + 0.13 L)\,q_s^{1/(1.21 + 2.3/L)},\qquad L = \frac{s_{Fn}}{h_{Fe}},\quad
            q_s = \frac{s_{Fn}}{2 \rho_F}

        fitted for :math:`1 \le q_s < 8`.
        """
        slenderness, notch = self.thickness / self.lever, self.notch_parameter
        return (1.2 + 0.13 * slenderness) * notch ** (1.0 / (1.21 + 2.3 / slenderness))


@checked
def cut_root_radius(
    root_radius_coefficient: float,
    dedendum_coefficient: float,
    cutter_teeth: int,
    cutter_profile_shift: float = 0.0,
) -> float:
    r"""Root radius rho_fPv/m_n of the rack that stands for a ring's pinion-type cutter.

    .. math:: \varrho_{fPv} = \varrho_{fP} + \frac{(x_0 + h_{fP} - \varrho_{fP})^{1.95}}{3.156 \cdot 1.036^{z_0}}

    with all lengths in normal modules; a cutter of many teeth is a rack.

    Parameters
    ----------
    root_radius_coefficient : float
        rho_fP/m_n, the rounding of the cutter's tip.
    dedendum_coefficient : float
        h_fP/m_n.
    cutter_teeth : int
        z_0.
    cutter_profile_shift : float
        x_0.

    References
    ----------
    ISO 6336-3:2006 with its corrigendum of 2007, form factor of internal gears; its text was not seen. Checked by
    s_Fn, h_Fe and rho_F of the rings of two stages that KISSsoft 03/2017A prints.

    Examples
    --------
    >>> round(cut_root_radius(0.3, 1.25, 30), 4)
    0.3992
    """
    height = cutter_profile_shift + dedendum_coefficient - root_radius_coefficient
    require(
        (cutter_teeth >= 3, f"cutter_teeth: {cutter_teeth} is below 3"),
        (0.0 <= root_radius_coefficient < inf, f"root_radius_coefficient: {root_radius_coefficient} is negative"),
        (
            0.0 <= height < inf,
            f"cutter_profile_shift: {cutter_profile_shift} leaves the cutter no addendum beyond its rounding",
        ),
    )
    return root_radius_coefficient + height**1.95 / (3.156 * 1.036**cutter_teeth)


@checked
def root_section(
    teeth: int,
    profile_shift: float,
    tip_diameter: float,
    transverse_contact_ratio: float,
    *,
    helix_angle: float = 0.0,
    pressure_angle: float = radians(20.0),
    dedendum_coefficient: float = 1.25,
    root_radius_coefficient: float = 0.38,
    residual_undercut: float = 0.0,
) -> RootSection:
    r"""Critical section of a gear cut by a rack; of a ring by the rack of its cutter.

    .. math::
        E = \frac{\pi}{4} - h_{fP} \tan\alpha_n + \frac{s_{pr}}{\cos\alpha_n}
            - \varrho_{fP}\,\frac{1 - \sin\alpha_n}{\cos\alpha_n},\quad
        G = \varrho_{fP} - h_{fP} + x,\quad
        H = \frac{2}{z_n} \left(\frac{\pi}{2} - E\right) - T,\quad
        \vartheta = \frac{2 G}{z_n} \tan\vartheta - H

    .. math::
        s_{Fn} = z_n \sin(T - \vartheta) + 2 \sin T \left(\frac{G}{\cos\vartheta} - \varrho_{fP}\right),\qquad
        \varrho_F = \varrho_{fP} + \frac{2 G^2}{\cos\vartheta\,(|z_n| \cos^2\vartheta - 2 G)}

    with all lengths in normal modules, T = 60 degrees, and of rings, whose numbers of teeth are negative, 30 degrees.

    Parameters
    ----------
    teeth : int
        z; negative of a ring.
    profile_shift : float
        x; as generated, for the thickness of the tooth that is cut.
    tip_diameter : float
        d_a/m_n, positive of a ring, too.
    transverse_contact_ratio : float
        eps_alpha of the pair.
    helix_angle, pressure_angle : float [rad]
        beta, alpha_n.
    dedendum_coefficient, root_radius_coefficient : float
        h_fP/m_n, rho_fP/m_n of the rack; of a ring rho_fPv/m_n of ``cut_root_radius``.
    residual_undercut : float
        s_pr/m_n = (pr - q)/m_n that grinding leaves of a protuberance.

    Raises
    ------
    InputError
        If a value is out of range; every one is told.
    GeometryError
        If there is no such section, or the outer point of single contact lies below the base circle.

    References
    ----------
    ISO 6336-3:2006 with its corrigendum of 2007, form factor Y_F, method B.

    Examples
    --------
    >>> section = root_section(16, 0.1817, 82.635 / 4.5, 1.4626, root_radius_coefficient=0.375)
    >>> round(section.form_factor, 2), round(section.stress_correction_factor, 2)
    (1.69, 1.85)

    Ring of the second stage of the NREL gearbox, printed 1.20 and 2.34:

    >>> radius = cut_root_radius(0.3, 1.25, 30)
    >>> section = root_section(-93, 0.1171, 1906.081 / 21.0, 1.618, root_radius_coefficient=radius)
    >>> round(section.form_factor, 2), round(section.stress_correction_factor, 2)
    (1.2, 2.34)
    """
    require(
        (abs(teeth) >= 3, f"teeth: {teeth} is below 3"),
        (0.0 < pressure_angle < 0.25 * pi, f"pressure_angle: {pressure_angle} rad is not between 0 and 45 deg"),
        (abs(helix_angle) < 0.25 * pi, f"helix_angle: {helix_angle} rad is not within 45 deg"),
        (-2.0 < profile_shift < 2.0, f"profile_shift: {profile_shift} is not between -2 and 2"),
        (
            1.0 <= transverse_contact_ratio < 3.0,
            f"transverse_contact_ratio: {transverse_contact_ratio} is not in [1, 3)",
        ),
        (0.0 < tip_diameter < inf, f"tip_diameter: {tip_diameter} is not positive and finite"),
        (0.0 < dedendum_coefficient < inf, f"dedendum_coefficient: {dedendum_coefficient} is not positive and finite"),
        (0.0 < root_radius_coefficient < inf, f"root_radius_coefficient: {root_radius_coefficient} is not positive"),
        (abs(residual_undercut) < 0.25, f"residual_undercut: {residual_undercut} is not within a quarter of a module"),
    )
    rho, tangent = root_radius_coefficient, _TANGENT if teeth > 0 else _RING_TANGENT
    z = copysign(virtual_teeth(abs(teeth), helix_angle, pressure_angle), teeth)
    gap = 0.25 * pi - dedendum_coefficient * tan(pressure_angle)
    gap -= (rho * (1.0 - sin(pressure_angle)) - residual_undercut) / cos(pressure_angle)
    angle, thickness, radius, below = fillet_section(gap, rho - dedendum_coefficient + profile_shift, rho, z)
    diameter, load_angle, half = _single_contact(
        teeth, z, profile_shift, tip_diameter, transverse_contact_ratio, helix_angle, pressure_angle
    )
    height = z * cos(tangent - angle) + 2.0 * cos(tangent) * below
    lever = 0.5 * ((cos(half) - sin(half) * tan(load_angle)) * diameter - height)
    if not (thickness > 0.0 and lever > 0.0 and radius > 0.0):
        raise GeometryError(
            f"no critical section: thickness {plain(thickness)}, lever {plain(lever)}, radius {plain(radius)} m_n"
        )
    return RootSection(thickness, lever, radius, load_angle, pressure_angle)


@checked
def fillet_section(gap: float, depth: float, radius: float, teeth: float) -> tuple[float, float, float, float]:
    """Where tangents of 30 degrees, of rings 60, touch the fillets that a rack cuts, in normal modules.

    Parameters
    ----------
    gap, depth, radius : float
        E and G of the rack, rho_fP of its rounding.
    teeth : float
        z_n, negative of rings.

    Returns
    -------
    angle, thickness, radius, below : float
        theta [rad]; s_Fn; rho_F; G/cos(theta) - rho_fP, of the lever.

    Raises
    ------
    GeometryError
        If there is no such place.
    """
    tangent = _TANGENT if teeth > 0.0 else _RING_TANGENT
    angle = _touching_angle(depth, 2.0 / teeth * (0.5 * pi - gap) - tangent, teeth)
    below = depth / cos(angle) - radius
    thickness = teeth * sin(tangent - angle) + 2.0 * sin(tangent) * below
    bend = radius + 2.0 * depth**2 / (cos(angle) * (abs(teeth) * cos(angle) ** 2 - 2.0 * depth))
    return angle, thickness, bend, below


def _touching_angle(depth: float, offset: float, teeth: float) -> float:
    """Angle theta at which the tangent touches the fillet [rad]."""
    slope = 2.0 * depth / teeth

    def difference(angle: float) -> float:
        return angle - slope * tan(angle) + offset

    last = 0.49 * pi if slope <= 0.0 else min(0.49 * pi, acos(min(1.0, sqrt(slope))))  # where the difference is largest
    if difference(0.0) * difference(last) > 0.0:
        raise GeometryError("no critical section: no tangent of 30 degrees, or 60 of a ring, touches the fillet")
    return roots.find_root(difference, 0.0, last)


def _single_contact(
    teeth: int,
    virtual: float,
    profile_shift: float,
    tip_diameter: float,
    transverse_contact_ratio: float,
    helix_angle: float,
    pressure_angle: float,
) -> tuple[float, float, float]:
    """d_en/m_n of the outer point of single contact of the virtual gear, alpha_Fen and gamma_e [rad]."""
    sign, size = (1.0 if teeth > 0 else -1.0), abs(virtual)
    base = 0.5 * size * cos(pressure_angle)
    contact_ratio = transverse_contact_ratio / (1.0 - (sin(helix_angle) * cos(pressure_angle)) ** 2)
    tip = 0.5 * (size + tip_diameter - abs(teeth) / cos(helix_angle))
    if tip <= base:
        raise GeometryError(f"tip_diameter: {tip_diameter} m_n lies inside the base circle")
    roll = sqrt(tip**2 - base**2) - sign * pi * cos(pressure_angle) * (contact_ratio - 1.0)
    if roll < 0.0:
        raise GeometryError("the outer point of single contact lies below the base circle")
    diameter = 2.0 * hypot(roll, base)
    angle = acos(2.0 * base / diameter)
    half = (0.5 * pi + 2.0 * tan(pressure_angle) * profile_shift) / virtual
    half += tan(pressure_angle) - pressure_angle - tan(angle) + angle
    return sign * diameter, angle - half, half


@checked
def helix_angle_factor(helix_angle: float, overlap_ratio: float, *, edition: int = 2006) -> float:
    r"""Helix angle factor Y_beta.

    .. math:: Y_\beta = 1 - \varepsilon_\beta \frac{\beta}{120°}\quad (2006),\qquad
        Y_\beta = \frac{1}{\cos^3\beta} \left(1 - \varepsilon_\beta \frac{\beta}{120°}\right)\quad (2019)

    with 1 in the place of an overlap ratio above 1 and 30 degrees in that of a helix angle above.

    Parameters
    ----------
    helix_angle : float [rad]
        beta, of either hand.
    overlap_ratio : float
        eps_beta.
    edition : int
        2006 or 2019; that of 2019 belongs to a form factor with ``load_distribution_factor``.

    References
    ----------
    ISO 6336-3:2006, helix angle factor; ISO 6336-3:2019, formula (66).

    Examples
    --------
    >>> helix_angle_factor(radians(15.0), 0.8), round(helix_angle_factor(radians(15.0), 0.8, edition=2019), 4)
    (0.9, 0.9986)
    """
    require(
        (0.0 <= overlap_ratio < inf, f"overlap_ratio: {overlap_ratio} is negative or not finite"),
        (abs(helix_angle) < 0.5 * pi, f"helix_angle: {helix_angle} rad is not within 90 deg"),
        (edition in (2006, 2019), f"edition: {edition}; allowed 2006 and 2019"),
    )
    angle = min(abs(helix_angle), _HELIX_ANGLE_LIMIT)
    factor = 1.0 - min(1.0, overlap_ratio) * degrees(angle) / 120.0
    return factor if edition == 2006 else factor / cos(angle) ** 3


@checked
def load_distribution_factor(overlap_ratio: float, virtual_contact_ratio: float) -> float:
    r"""Load distribution factor f_eps of the edition of 2019, on the form factor Y_F.

    .. math::
        f_\varepsilon = \sqrt{1 - \varepsilon_\beta + \frac{\varepsilon_\beta}{\varepsilon_{\alpha n}}}
        \quad (\varepsilon_{\alpha n} < 2),\qquad
        f_\varepsilon = \sqrt{\frac{1 - \varepsilon_\beta}{2} + \frac{\varepsilon_\beta}{\varepsilon_{\alpha n}}}
        \quad (\varepsilon_{\alpha n} \ge 2)

    with 1 in the place of an overlap ratio above 1; 0.7 of spur gears with a contact ratio of 2 and more.

    Parameters
    ----------
    overlap_ratio, virtual_contact_ratio : float
        eps_beta, eps_alpha_n.

    References
    ----------
    ISO 6336-3:2019, formulas (10) to (14).

    Examples
    --------
    >>> load_distribution_factor(0.0, 1.5), round(load_distribution_factor(1.2, 1.5), 4)
    (1.0, 0.8165)
    """
    require(
        (0.0 <= overlap_ratio < inf, f"overlap_ratio: {overlap_ratio} is negative or not finite"),
        (
            1.0 <= virtual_contact_ratio < inf,
            f"virtual_contact_ratio: {virtual_contact_ratio} is below 1 or not finite",
        ),
    )
    several, overlap = virtual_contact_ratio >= 2.0, min(1.0, overlap_ratio)
    if overlap == 0.0:
        return 0.7 if several else 1.0
    return sqrt((1.0 - overlap) / (2.0 if several else 1.0) + overlap / virtual_contact_ratio)


@checked
def deep_tooth_factor(virtual_contact_ratio: float, accuracy_grade: int) -> float:
    r"""Deep tooth factor Y_DT.

    .. math:: Y_{DT} = 2.366 - 0.666\,\varepsilon_{\alpha n} \quad (2.05 < \varepsilon_{\alpha n} \le 2.5)

    of gears of accuracy grade 4 and better; 0.7 above, 1 below and for coarser grades.

    Parameters
    ----------
    virtual_contact_ratio : float
        eps_alpha_n.
    accuracy_grade : int
        Of ISO 1328-1.

    References
    ----------
    ISO 6336-3:2006, deep tooth factor.

    Examples
    --------
    >>> deep_tooth_factor(2.3, 6), round(deep_tooth_factor(2.3, 4), 4)
    (1.0, 0.8342)
    """
    require_positive(virtual_contact_ratio=virtual_contact_ratio, accuracy_grade=accuracy_grade)
    if accuracy_grade > 4 or virtual_contact_ratio <= 2.05:
        return 1.0
    return 2.366 - 0.666 * virtual_contact_ratio if virtual_contact_ratio <= 2.5 else 0.7


@checked
def rim_thickness_factor(rim_over_height: float) -> float:
    r"""Rim thickness factor Y_B of an external gear.

    .. math:: Y_B = 1 \quad (s_R/h_t \ge 1.2),\qquad
        Y_B = 1.6 \ln\left(2.242\,\frac{h_t}{s_R}\right) \quad (0.5 < s_R/h_t < 1.2)

    Parameters
    ----------
    rim_over_height : float
        Thickness of the rim below the roots over the height of the teeth, s_R/h_t; inf: a solid gear.

    Raises
    ------
    InputError
        If the rim is no thicker than half the teeth are high, which the standard tells to avoid.

    References
    ----------
    ISO 6336-3:2006, rim thickness factor.

    Examples
    --------
    >>> rim_thickness_factor(1.5), round(rim_thickness_factor(0.8), 3)
    (1.0, 1.649)
    """
    require((rim_over_height > THINNEST_RIM, f"rim_over_height: {rim_over_height} is not above {THINNEST_RIM}"))
    return 1.0 if rim_over_height >= THIN_RIM else 1.6 * log(2.242 / rim_over_height)


@checked
def ring_rim_factor(rim_over_module: float) -> float:
    r"""Rim thickness factor Y_B of a ring.

    .. math:: Y_B = 1 \quad (s_R/m_n \ge 3.5),\qquad
        Y_B = 1.15 \ln\left(8.324\,\frac{m_n}{s_R}\right) \quad (1.75 < s_R/m_n < 3.5)

    Parameters
    ----------
    rim_over_module : float
        s_R/m_n; inf: a ring that does not bend.

    Raises
    ------
    InputError
        If the rim is no thicker than 1.75 normal modules, which the standard says to avoid.

    References
    ----------
    ISO 6336-3:2019, 9.3.

    Examples
    --------
    >>> ring_rim_factor(4.0), round(ring_rim_factor(2.5), 3)
    (1.0, 1.383)
    """
    low, high = THINNEST_RING, THIN_RING
    require((rim_over_module > low, f"rim_over_module: {rim_over_module} is not above {low}"))
    return 1.0 if rim_over_module >= high else 1.15 * log(8.324 / rim_over_module)


@checked
def nominal_root_stress(tangential_force: float, face_width: float, normal_module: float, factors: float) -> float:
    r"""Nominal tooth root stress sigma_F0 [MPa].

    .. math:: \sigma_{F0} = \frac{F_t}{b\,m_n} Y_F Y_S Y_\beta

    Parameters
    ----------
    tangential_force : float [N]
        F_t; of the standard at the reference cylinder, 2 T_1/d_1.
    face_width, normal_module : float [mm]
        b, m_n.
    factors : float
        Product of Y_F, Y_S and Y_beta, and Y_B of a thin rim.

    References
    ----------
    ISO 6336-3:2006, nominal tooth root stress.

    Examples
    --------
    >>> round(nominal_root_stress(5464.48, 14.0, 4.5, 1.689 * 1.851), 0)
    271.0
    """
    require_positive(
        tangential_force=tangential_force, face_width=face_width, normal_module=normal_module, factors=factors
    )
    return tangential_force / (face_width * normal_module) * factors


@checked
def face_load_factor(contact_face_load_factor: ArrayLike, height_over_width: float) -> Array:
    r"""Face load factor of root stress K_Fbeta.

    .. math:: K_{F\beta} = K_{H\beta}^{N_F},\qquad N_F = \frac{1}{1 + h/b + (h/b)^2}

    with 1/3 in the place of a larger h/b.

    Parameters
    ----------
    contact_face_load_factor : array
        K_Hbeta, at least 1.
    height_over_width : float
        Height of the tooth over the face width h/b, of the narrower gear.

    References
    ----------
    ISO 6336-1:2006, face load factors.

    Examples
    --------
    >>> round(float(face_load_factor(1.5, 0.2)), 4)
    1.3868
    """
    require_positive(height_over_width=height_over_width)
    factor = np.asarray(contact_face_load_factor, dtype=float)
    require(interval_check("contact_face_load_factor", factor, "[1, inf)"))
    ratio = min(height_over_width, _LARGEST_HEIGHT_OVER_WIDTH)
    return np.asarray(factor ** (1.0 / (1.0 + ratio + ratio**2)))
