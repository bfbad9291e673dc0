"""Closed forms of ISO 6336 for cylindrical gears: contact stress, mesh stiffness, bounds of load factors.

Plain numbers in, plain numbers out: lengths in mm, angles in rad, forces in N, moduli and stresses in MPa,
stiffnesses in N/(mm um), that is N/um per mm of face width. Formulas as in the editions from 2006 on;
the examples are the numbers of ISO/TR 6336-30:2017, example 1.
"""

from __future__ import annotations

from math import asin, cos, degrees, inf, pi, radians, sin, sqrt, tan

import numpy as np
from numpy.typing import ArrayLike

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, interval_check
from loaded_tca.errors import InputError, require, require_positive

_STEEL = 206000.0
FULL_LOAD = 100.0
"""Load for each mm of face width [N/mm] from which on the stiffness of teeth is constant."""
_THEORETICAL_TO_REAL = 0.8  # C_M: measured single stiffness over the theoretical one, for solid discs


def _angle_checks(**angles: float) -> list[tuple[bool, str]]:
    """Checks that pressure angles lie between 0 and 90 deg."""
    return [
        (0.0 < angle < 0.5 * pi, f"{name}: {angle} rad is not between 0 and 90 deg") for name, angle in angles.items()
    ]


def _require_angles(**angles: float) -> None:
    require(*_angle_checks(**angles))


def _require_slopes(**angles: float) -> None:
    """Refuse helix angles of 90 deg and more, of either hand."""
    require(*((abs(angle) < 0.5 * pi, f"{name}: {angle} rad is not within 90 deg") for name, angle in angles.items()))


@checked
def zone_factor(transverse_pressure_angle: float, working_pressure_angle: float, base_helix_angle: float) -> float:
    r"""Zone factor Z_H: curvature at the pitch point.

    .. math:: Z_H = \sqrt{\frac{2 \cos\beta_b \cos\alpha_{wt}}{\cos^2\alpha_t \sin\alpha_{wt}}}

    Parameters
    ----------
    transverse_pressure_angle, working_pressure_angle, base_helix_angle : float [rad]
        alpha_t, alpha_wt, beta_b.

    References
    ----------
    ISO 6336-2:2006, zone factor.

    Examples
    --------
    >>> angles = [radians(angle) for angle in (20.719712, 21.066100, 14.824535)]
    >>> round(zone_factor(*angles), 5)
    2.39533
    """
    _require_angles(transverse_pressure_angle=transverse_pressure_angle, working_pressure_angle=working_pressure_angle)
    _require_slopes(base_helix_angle=base_helix_angle)
    curvature = cos(base_helix_angle) * cos(working_pressure_angle) / sin(working_pressure_angle)
    return sqrt(2.0 * curvature) / cos(transverse_pressure_angle)


@checked
def elasticity_factor(contact_modulus: float) -> float:
    r"""Elasticity factor Z_E [MPa^0.5].

    .. math:: Z_E = \sqrt{E^*/\pi},\qquad 1/E^* = (1 - \nu_1^2)/E_1 + (1 - \nu_2^2)/E_2

    Parameters
    ----------
    contact_modulus : float [MPa]
        E*.

    References
    ----------
    ISO 6336-2:2006, elasticity factor.

    Examples
    --------
    >>> round(elasticity_factor(206000.0 / (2.0 * (1.0 - 0.3**2))), 4)
    189.8117
    """
    require_positive(contact_modulus=contact_modulus)
    return sqrt(contact_modulus / pi)


@checked
def contact_ratio_factor(transverse_contact_ratio: float, overlap_ratio: float) -> float:
    r"""Contact ratio factor Z_eps: length of the lines of contact.

    .. math::
        Z_\varepsilon = \sqrt{\frac{4 - \varepsilon_\alpha}{3} (1 - \varepsilon_\beta)
        + \frac{\varepsilon_\beta}{\varepsilon_\alpha}}

    with 1 in the place of an overlap ratio above 1.

    References
    ----------
    ISO 6336-2:2006, contact ratio factor.

    Examples
    --------
    >>> round(contact_ratio_factor(1.549090, 1.083369), 3)
    0.803
    """
    require_positive(transverse_contact_ratio=transverse_contact_ratio)
    if not 0.0 <= overlap_ratio < float("inf"):
        raise InputError(f"overlap_ratio: {overlap_ratio} is negative or not finite")
    overlap = min(1.0, overlap_ratio)
    require((transverse_contact_ratio < 4.0, f"transverse_contact_ratio: {transverse_contact_ratio} is not below 4"))
    return sqrt((4.0 - transverse_contact_ratio) / 3.0 * (1.0 - overlap) + overlap / transverse_contact_ratio)


@checked
def helix_angle_factor(helix_angle: float) -> float:
    r"""Helix angle factor Z_beta of the editions from 2006 on.

    .. math:: Z_\beta = 1/\sqrt{\cos\beta}

    References
    ----------
    ISO 6336-2:2006, helix angle factor.

    Examples
    --------
    >>> round(helix_angle_factor(radians(15.8)), 5)
    1.01944
    """
    _require_slopes(helix_angle=helix_angle)
    return 1.0 / sqrt(cos(helix_angle))


@checked
def single_contact_factors(
    teeth: tuple[int, int],
    tip_over_base: tuple[float, float],
    working_pressure_angle: float,
    transverse_contact_ratio: float,
    overlap_ratio: float,
) -> tuple[float, float]:
    r"""Single pair contact factors Z_B of the pinion and Z_D of the wheel.

    .. math::
        M_1 = \frac{\tan\alpha_{wt}}{\sqrt{
        \left(\sqrt{d_{a1}^2/d_{b1}^2 - 1} - 2\pi/z_1\right)
        \left(\sqrt{d_{a2}^2/d_{b2}^2 - 1} - (\varepsilon_\alpha - 1)\,2\pi/z_2\right)}}

    and M_2 with the gears exchanged: the root of the relative curvature at the inner point of single contact, B of the
    pinion and D of the wheel, over that at the pitch point. :math:`Z_B = \max(1, M_1)` of spur gears, 1 from an overlap
    ratio of 1 on, and :math:`\max(1, M_1 - \varepsilon_\beta (M_1 - 1))` in between; Z_D likewise, and 1 of a ring.

    Parameters
    ----------
    teeth : (int, int)
        z of pinion and wheel, negative of a ring.
    tip_over_base : (float, float)
        d_a/d_b, to where the flanks are in contact.
    working_pressure_angle : float [rad]
        alpha_wt.
    transverse_contact_ratio, overlap_ratio : float
        eps_alpha, above 1; eps_beta.

    Raises
    ------
    InputError
        If a value is out of range, or the path of contact reaches beyond the base circles; every one is named.

    References
    ----------
    ISO 6336-2:2006, single pair tooth contact factors.

    Examples
    --------
    >>> ratios = 41.318 / 33.8289, 59.272 / 50.7434  # FZG C14
    >>> [round(factor, 3) for factor in single_contact_factors((16, 24), ratios, radians(22.43934), 1.4626, 0.0)]
    [1.07, 1.0]

    Planet and ring of the second stage of the NREL gearbox, printed 1.00 and 1.00:

    >>> ratios = 815.663 / 710.408, 1906.081 / 1835.220
    >>> single_contact_factors((36, -93), ratios, radians(15.630), 1.618, 0.0)
    (1.0, 1.0)
    """
    require(
        (teeth[0] >= 1, f"teeth: {teeth[0]} is below 1"),
        (teeth[1] >= 1 or teeth[1] < -teeth[0], f"teeth: {teeth[1]} is below 1, and no ring around {teeth[0]} teeth"),
        *((1.0 <= ratio < inf, f"tip_over_base: {ratio} is not in [1, inf)") for ratio in tip_over_base),
        *_angle_checks(working_pressure_angle=working_pressure_angle),
        (1.0 < transverse_contact_ratio < inf, f"transverse_contact_ratio: {transverse_contact_ratio} is not above 1"),
        (0.0 <= overlap_ratio < inf, f"overlap_ratio: {overlap_ratio} is negative or not finite"),
    )
    own, other = (
        [sqrt(ratio**2 - 1.0) - pitches * 2.0 * pi / count for count, ratio in zip(teeth, tip_over_base, strict=True)]
        for pitches in (1.0, transverse_contact_ratio - 1.0)
    )
    tangents = own[0] * other[1], own[1] * other[0]
    require(
        (
            min(*own, *other) > 0.0,
            f"transverse_contact_ratio: {transverse_contact_ratio} reaches beyond a base circle",
        )
    )
    smooth = 1.0 - min(1.0, overlap_ratio)
    first, second = (1.0 + smooth * (tan(working_pressure_angle) / sqrt(one) - 1.0) for one in tangents)
    return max(1.0, first), max(1.0, second) if teeth[1] > 0 else 1.0


@checked
def largest_transverse_load_factor(transverse_contact_ratio: float, overlap_ratio: float) -> float:
    r"""Upper bound of the transverse load factor K_Halpha; the lower one is 1.

    .. math:: K_{H\alpha} \le \frac{\varepsilon_\gamma}{\varepsilon_\alpha Z_\varepsilon^2},\qquad
        \varepsilon_\gamma = \varepsilon_\alpha + \varepsilon_\beta

    Where it holds, one tooth pair carries the whole load.

    Parameters
    ----------
    transverse_contact_ratio, overlap_ratio : float
        eps_alpha, eps_beta.

    References
    ----------
    ISO 6336-1:2006, limiting conditions for K_Halpha.

    Examples
    --------
    >>> round(largest_transverse_load_factor(1.549090, 1.083369), 3)
    2.632
    """
    total = transverse_contact_ratio + overlap_ratio
    factor = contact_ratio_factor(transverse_contact_ratio, overlap_ratio)
    return total / (transverse_contact_ratio * factor**2)


@checked
def nominal_contact_stress(
    tangential_force: float,
    pinion_reference_diameter: float,
    face_width: float,
    gear_ratio: float,
    factors: float,
) -> float:
    r"""Nominal contact stress at the pitch point sigma_H0 [MPa].

    .. math::
        \sigma_{H0} = Z_H Z_E Z_\varepsilon Z_\beta \sqrt{\frac{F_t}{d_1 b}\,\frac{u + 1}{u}}

    Parameters
    ----------
    tangential_force : float [N]
        F_t at the reference cylinder, 2 T_1/d_1.
    pinion_reference_diameter, face_width : float [mm]
        d_1, b.
    gear_ratio : float
        Teeth of the wheel over teeth of the pinion, u; below -1 of a ring.
    factors : float [MPa^0.5]
        Product of Z_H, Z_E, Z_eps and Z_beta.

    References
    ----------
    ISO 6336-2:2006, nominal contact stress.

    Examples
    --------
    >>> factors = 2.39533 * 189.81170 * 0.803456 * 1.01944
    >>> round(nominal_contact_stress(127352.0, 141.340, 100.0, 103 / 17, factors), 1)
    1206.6
    """
    require_positive(
        tangential_force=tangential_force,
        pinion_reference_diameter=pinion_reference_diameter,
        face_width=face_width,
        factors=factors,
    )
    outside = 0.0 < gear_ratio < inf or -inf < gear_ratio < -1.0
    require((outside, f"gear_ratio: {gear_ratio} is neither positive nor below -1, or not finite"))
    load = tangential_force / (pinion_reference_diameter * face_width)
    return factors * sqrt(load * (gear_ratio + 1.0) / gear_ratio)


@checked
def virtual_teeth(teeth: int, helix_angle: float, pressure_angle: float) -> float:
    r"""Teeth z_n of the spur gear with the tooth of a helical gear's normal section.

    .. math:: z_n = \frac{z}{\cos^2\beta_b \cos\beta},\qquad \sin\beta_b = \sin\beta \cos\alpha_n

    Parameters
    ----------
    teeth : int
        z.
    helix_angle, pressure_angle : float [rad]
        beta, alpha_n.

    References
    ----------
    ISO 6336-3:2006, virtual number of teeth.

    Examples
    --------
    >>> round(virtual_teeth(17, radians(15.8), radians(20)), 3)
    18.905
    """
    require_positive(teeth=teeth)
    _require_angles(pressure_angle=pressure_angle)
    _require_slopes(helix_angle=helix_angle)
    base_helix_angle = asin(sin(helix_angle) * cos(pressure_angle))
    return teeth / (cos(base_helix_angle) ** 2 * cos(helix_angle))


@checked
def theoretical_single_stiffness(virtual_teeth: tuple[float, float], profile_shifts: tuple[float, float]) -> float:
    r"""Theoretical single stiffness c'_th of a steel tooth pair of the basic rack of ISO 53 [N/(mm um)].

    .. math::
        1/c'_{th} = 0.04723 + \frac{0.15551}{z_{n1}} + \frac{0.25791}{z_{n2}} - 0.00635\,x_1
        - 0.11654\,\frac{x_1}{z_{n1}} - 0.00193\,x_2 - 0.24188\,\frac{x_2}{z_{n2}}
        + 0.00529\,x_1^2 + 0.00182\,x_2^2

    The series was fitted for :math:`x_1 \ge x_2` and :math:`-0.5 \le x_1 + x_2 \le 2`.

    Parameters
    ----------
    virtual_teeth, profile_shifts : (float, float)
        z_n and x of pinion and wheel; z_n is inf of a ring.

    References
    ----------
    ISO 6336-1:2006, tooth stiffness parameters, method B.

    Examples
    --------
    >>> round(theoretical_single_stiffness((18.905, 114.543), (0.145, 0.0)), 4)
    17.8558
    """
    (z1, z2), (x1, x2) = virtual_teeth, profile_shifts
    require_positive(pinion_virtual_teeth=z1)
    require((z2 > 0.0, f"wheel_virtual_teeth: {z2} is not positive"))
    teeth = 0.15551 / z1 + 0.25791 / z2 - 0.11654 * x1 / z1 - 0.24188 * x2 / z2
    return 1.0 / (0.04723 + teeth - 0.00635 * x1 - 0.00193 * x2 + 0.00529 * x1**2 + 0.00182 * x2**2)


@checked
def basic_rack_factor(dedendum_coefficient: float = 1.25, pressure_angle: float = radians(20)) -> float:
    r"""Factor C_B of the basic rack: deeper teeth are softer, greater pressure angles stiffer.

    .. math:: C_B = [1 + 0.5\,(1.2 - h_{fP}/m_n)]\,[1 - 0.02\,(20° - \alpha_n)]

    Parameters
    ----------
    dedendum_coefficient : float
        h_fP/m_n.
    pressure_angle : float [rad]
        alpha_n.

    References
    ----------
    ISO 6336-1:2006, tooth stiffness parameters, method B.

    Examples
    --------
    >>> round(basic_rack_factor(1.4), 12)
    0.9
    """
    depth = 1.0 + 0.5 * (1.2 - dedendum_coefficient)
    return depth * (1.0 - 0.02 * (20.0 - degrees(pressure_angle)))


@checked
def single_stiffness(
    theoretical_single_stiffness: float,
    helix_angle: float,
    *,
    basic_rack_factor: float = 1.0,
    gear_blank_factor: float = 1.0,
    youngs_modulus: float = _STEEL,
    specific_load: float = FULL_LOAD,
) -> float:
    r"""Single stiffness c' of a tooth pair [N/(mm um)].

    .. math:: c' = 0.8\,c'_{th} C_R C_B \cos\beta\,\frac{E}{E_{St}} \sqrt[4]{\frac{F_t K_A/b}{100}}

    with 100 N/mm in the place of a larger load.

    Parameters
    ----------
    theoretical_single_stiffness : float [N/(mm um)]
        c'_th.
    helix_angle : float [rad]
        beta.
    basic_rack_factor, gear_blank_factor : float
        C_B; C_R, 1 for solid discs.
    youngs_modulus : float [MPa]
        E of both gears; of different materials, 2 E1 E2/(E1 + E2).
    specific_load : float [N/mm]
        F_t K_A/b.

    References
    ----------
    ISO 6336-1:2006, tooth stiffness parameters, method B.

    Examples
    --------
    >>> round(single_stiffness(17.85584, radians(15.8), basic_rack_factor=0.9), 5)
    12.37047
    """
    require_positive(
        theoretical_single_stiffness=theoretical_single_stiffness,
        youngs_modulus=youngs_modulus,
        specific_load=specific_load,
    )
    _require_slopes(helix_angle=helix_angle)
    solid = _THEORETICAL_TO_REAL * theoretical_single_stiffness * cos(helix_angle) * youngs_modulus / _STEEL
    return solid * gear_blank_factor * basic_rack_factor * float(share_of_stiffness(specific_load))


@checked
def share_of_stiffness(specific_load: ArrayLike) -> Array:
    """Stiffness of teeth over that of a full load.

    Parameters
    ----------
    specific_load : array [N/mm]
        F_t K_A/b.

    References
    ----------
    ISO 6336-1, single stiffness under less than 100 N/mm.

    Examples
    --------
    >>> share_of_stiffness([6.25, 100.0, 500.0]).tolist()
    [0.5, 1.0, 1.0]
    """
    load = np.asarray(specific_load, dtype=float)
    require(interval_check("specific_load", load, "[0, inf)", "N/mm"))
    return np.asarray((np.minimum(load, FULL_LOAD) / FULL_LOAD) ** 0.25)


@checked
def mesh_stiffness(single_stiffness: float, transverse_contact_ratio: float) -> float:
    r"""Mean mesh stiffness c_gamma_alpha [N/(mm um)].

    .. math:: c_{\gamma\alpha} = c'\,(0.75\,\varepsilon_\alpha + 0.25)

    for a transverse contact ratio of at least 1.2.

    References
    ----------
    ISO 6336-1:2006, tooth stiffness parameters, method B.

    Examples
    --------
    >>> round(mesh_stiffness(12.37047, 1.549090), 4)
    17.4648
    """
    require_positive(single_stiffness=single_stiffness, transverse_contact_ratio=transverse_contact_ratio)
    return single_stiffness * (0.75 * transverse_contact_ratio + 0.25)
