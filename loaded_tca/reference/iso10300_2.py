"""Pitting of bevel and hypoid pairs after ISO 10300-2, method B1: contact stress, and what flanks withstand.

Edition of 2023: the factor of bevel gears stands on the side of the strength, as Z_KP = 1.2 (the edition of 2014 has
Z_K = 0.85 on that of the stress). Its text was not seen; formulas and their numbers as in ``iso10300_1``, checked
against samples 1 to 4 of ISO/TR 10300-30:2024. Z_L, Z_v, Z_R and Z_W are those of ISO 6336-2 with rho_rel, the speed of
the wheel and both roughnesses: Z_L, Z_v and Z_R have the printed numbers of the samples; Z_W of softer wheels and the
S-N curves, which the standard takes of ISO 6336-5 and -6, are in no sample.
"""

from __future__ import annotations

from dataclasses import replace
from math import atan, cos, hypot, inf, pi, sin, sqrt, tan
from typing import Any

from loaded_tca.arguments import checked
from loaded_tca.errors import GeometryError, require, require_positive
from loaded_tca.reference.iso6336_2 import FlankFactors, FlankStrength, flank_factors
from loaded_tca.reference.iso6336_6 import SNCurve
from loaded_tca.reference.iso10300_1 import Both, VirtualPair

BEVEL_FACTOR = 1.2
"""Z_KP, formula (11): strength of flanks of bevel gears over that of cylindrical ones, from tests."""
CROWNING_EXPONENTS = {"low": 3.0, "high": 1.5}
"""Profile crowning -> e_LS, exponent of the parabola of peak loads over the zone of action (table 5)."""


@checked
def mid_zone_factor(pair: VirtualPair) -> float:
    r"""Mid-zone factor Z_M-B: contact stress at the decisive point over that of the pitch point, zone factor in it.

    .. math:: Z_{M-B} = \frac{\tan\alpha_{vet}}{\sqrt{\left(\sqrt{(d_{va1}/d_{vb1})^2 - 1} - F_1 \pi/z_{v1}\right)
              \left(\sqrt{(d_{va2}/d_{vb2})^2 - 1} - F_2 \pi/z_{v2}\right)}}

    with F_1 = 2 and F_2 = 2 (eps_v_alpha - 1) without overlap, both eps_v_alpha from an overlap ratio of 1 on, and
    straight lines in between. The gear with fewer teeth counts as the first.

    Parameters
    ----------
    pair : VirtualPair

    Raises
    ------
    GeometryError
        If that point lies beyond the base circle.

    References
    ----------
    ISO 10300-2:2023, formula (6), table 4.
    """
    profile, face = pair.contact_ratios
    share = min(max(face, 0.0), 1.0)
    places = [2.0 + (profile - 2.0) * share, 2.0 * profile - 2.0 + (2.0 - profile) * share]
    if pair.teeth[0] > pair.teeth[1]:
        places.reverse()
    rest = [
        sqrt((tip / base) ** 2 - 1.0) - place * pi / teeth
        for tip, base, place, teeth in zip(pair.tip_diameters, pair.base_diameters, places, pair.teeth, strict=True)
    ]
    if not min(rest) > 0.0:
        raise GeometryError("Z_M-B: the decisive point of contact lies beyond the base circle of a virtual gear")
    return tan(pair.transverse_pressure_angle) / sqrt(rest[0] * rest[1])


@checked
def load_sharing_factor(pair: VirtualPair, profile_crowning: str = "low") -> float:
    r"""Load sharing factor Z_LS: root of the part of the load that the middle contact line carries.

    .. math:: Z_{LS} = \sqrt{\frac{A_m^*}{A_t^*+ A_m^*+ A_r^*}}, \qquad A^*= \frac{\pi}{4}\, p^*l_b, \qquad
              p^*= 1 - \left(\frac{|f|}{f_{max}}\right)^{e_{LS}}

    Parameters
    ----------
    pair : VirtualPair
    profile_crowning : {"low", "high"}
        e_LS 3 or 1.5.

    References
    ----------
    ISO 10300-2:2023, formulas (7) to (10), table 5.
    """
    require(
        (
            profile_crowning in CROWNING_EXPONENTS,
            f"profile_crowning: {profile_crowning!r} is not one of {', '.join(CROWNING_EXPONENTS)}",
        )
    )
    places, lengths, farthest = pair.contact_lines
    exponent = CROWNING_EXPONENTS[profile_crowning]
    areas = [
        length * max(0.0, 1.0 - (abs(place) / farthest) ** exponent)
        for place, length in zip(places, lengths, strict=True)
    ]
    return sqrt(areas[1] / sum(areas))


@checked
def hypoid_factor(spiral_angles: Both, contact_line_angle: float, pressure_angle: float) -> tuple[float, bool]:
    r"""Hypoid factor Z_Hyp: less strength under sliding along the teeth; and whether a bound of it counts.

    .. math:: Z_{Hyp} = 1 - 0.3 \left(\frac{v_{g,par}}{v_{\Sigma,vert}} - 0.15\right), \qquad 0.6 \le Z_{Hyp} \le 1

    with, for a velocity of 1 of the pinion,

    .. math::
        v_{g,par} = \cos\beta_{m1} |\tan\beta_{m1} - \tan\beta_{m2}| \cos\beta_B, \quad
        v_{\Sigma,h} = 2 \cos\beta_{m1} \sin\alpha_n, \quad
        v_{\Sigma,l} = \sin\beta_{m1} + \sin\beta_{m2} \frac{\cos\beta_{m1}}{\cos\beta_{m2}}, \\
        v_{\Sigma,vert} = \sqrt{v_{\Sigma,h}^2 + v_{\Sigma,l}^2}\,
        \sin\left(\arctan\frac{v_{\Sigma,h}}{v_{\Sigma,l}} + |\beta_B|\right)

    1 of pairs without an offset, whose teeth do not slide along each other at the mean point.

    Parameters
    ----------
    spiral_angles : (float, float) [rad]
        beta_m of pinion and wheel.
    contact_line_angle, pressure_angle : float [rad]
        beta_B, alpha_n of the flank.

    References
    ----------
    ISO 10300-2:2023, formulas (12) to (19).

    Examples
    --------
    Sample 3, printed 0.829:

    >>> from math import radians
    >>> factor, _ = hypoid_factor((radians(44.991), radians(21.009)), radians(12.523), radians(15.868))
    >>> round(factor, 3)
    0.829
    """
    first, second = spiral_angles
    require((0.0 < pressure_angle < 0.25 * pi, f"pressure_angle: {pressure_angle} rad is not between 0 and 45 deg"))
    slide = cos(first) * abs(tan(first) - tan(second)) * cos(contact_line_angle)
    if slide == 0.0:
        return 1.0, False
    high, along = 2.0 * cos(first) * sin(pressure_angle), sin(first) + sin(second) * cos(first) / cos(second)
    turn = atan(high / along) if along else 0.5 * pi
    vertical = hypot(high, along) * sin(turn + abs(contact_line_angle))
    factor = 1.0 - 0.3 * (slide / vertical - 0.15)
    return min(max(factor, 0.6), 1.0), factor < 0.6


@checked
def nominal_contact_stress(normal_force: float, pair: VirtualPair, factors: float) -> float:
    r"""Nominal contact stress sigma_H0-B1 [MPa].

    .. math:: \sigma_{H0} = \sqrt{\frac{F_n}{l_{bm}\,\varrho_{rel}}}\; Z_{M-B} Z_{LS} Z_E

    Parameters
    ----------
    normal_force : float [N]
        F_n = F_mt1/(cos(alpha_n) cos(beta_m1)).
    pair : VirtualPair
    factors : float
        Product of Z_M-B, Z_LS and Z_E.

    References
    ----------
    ISO 10300-2:2023, formulas (2), (3).
    """
    require_positive(normal_force=normal_force, factors=factors)
    return factors * sqrt(normal_force / (pair.contact_lines.lengths[1] * pair.relative_radius))


@checked
def bevel_flank_factors(
    pinion: FlankStrength, wheel: FlankStrength, *, hypoid_factor: float = 1.0, **conditions: Any
) -> FlankFactors:
    r"""Factors of the strength of flanks, and the strength itself.

    .. math:: \sigma_{HG} = \sigma_{H\,lim} Z_{NT} Z_X Z_L Z_v Z_R Z_W Z_{KP} Z_{Hyp}

    Z_KP and Z_Hyp count at any number of load cycles.

    Parameters
    ----------
    pinion, wheel : FlankStrength
    hypoid_factor : float
        Z_Hyp.
    **conditions
        As for :func:`loaded_tca.reference.iso6336_2.flank_factors`, with rho_rel as ``relative_radius`` and the speed
        v_mt2 of the wheel at its mean point.

    Raises
    ------
    InputError
        If a value is out of range.

    References
    ----------
    ISO 10300-2:2023, formulas (4), (54) to (60).

    Examples
    --------
    Sample 1, whose Z_NT is 1; printed 1617.8 MPa:

    >>> hard = FlankStrength(1500.0, "Eh", 8.0)
    >>> conditions = {"relative_radius": 12.459, "velocity": 3.451, "viscosity_40": 150.0, "gear_ratio": 39 / 14}
    >>> factors = bevel_flank_factors(hard, hard, cycles=[5e7, 5e7], **conditions)
    >>> round(float(factors.strength[0]), 0)
    1618.0
    """
    require((0.0 < hypoid_factor < inf, f"hypoid_factor: {hypoid_factor} is not positive and finite"))
    factors, times = flank_factors(pinion, wheel, **conditions), BEVEL_FACTOR * hypoid_factor
    first, second = (SNCurve(curve.cycles, times * curve.stresses, curve.static_limit) for curve in factors.curves)
    return replace(
        factors,
        curves=(first, second),
        reference_strength=times * factors.reference_strength,
        strength=times * factors.strength,
    )
