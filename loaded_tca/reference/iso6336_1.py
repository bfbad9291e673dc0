"""Load factors of ISO 6336-1: dynamic factor K_v by method B, transverse load factors, running in.

Numbers of formulas are those of the edition of 2019 where an open program prints them; its text was not seen. The
formulas are checked against the reports of KISSsoft 03/2017A on the gearbox of the NREL 5 MW turbine and the numbers
of ISO/TR 6336-30. Arrays broadcast: loads and speeds may be the bins of a spectrum. Deviations are in um, stiffnesses
in N/(mm um), loads for each mm of face width in N/mm, reduced masses in kg/mm.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees, inf, pi, sin

import numpy as np
from numpy.typing import ArrayLike

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, Mask, interval_check
from loaded_tca.errors import require, require_positive
from loaded_tca.plain import plain
from loaded_tca.reference.iso6336 import FULL_LOAD, largest_transverse_load_factor
from loaded_tca.reference.iso6336_5 import material_kind

RANGES = ("subcritical", "main resonance", "intermediate", "supercritical")
"""Ranges of the resonance ratio: up to N_S, up to 1.15, up to 1.5, above."""
MAIN_RESONANCE_END, SUPERCRITICAL = 1.15, 1.5
PRESSURE_ANGLES, LARGEST_HELIX = (15.0, 25.0), 30.0
"""Normal pressure angles and helix angle for which the standard was checked [deg]."""
_ROUNDING = 1e-9  # deg
USEFUL_SPEED = 3.0
"""Speed (v z_1/100) sqrt(u^2/(1 + u^2)) below which the standard does not need method B [m/s]."""


@checked
def scope_notes(
    *,
    pressure_angle: float,
    helix_angle: float,
    transverse_contact_ratio: float,
    profile_shifts: tuple[float, float] = (0.0, 0.0),
) -> tuple[str, ...]:
    """What of a pair lies outside the scope of the standard, a sentence for each.

    Parameters
    ----------
    pressure_angle, helix_angle : float [rad]
        alpha_n, within 15 to 25 degrees; beta, up to 30 degrees of either hand.
    transverse_contact_ratio : float
        eps_alpha, within 1 to 2.5; of the mesh stiffness at least 1.2.
    profile_shifts : (float, float)
        x_1 and x_2 of an external pair: the series of the stiffness holds for x_1 from x_2 on, sums of -0.5 to 2.

    References
    ----------
    ISO 6336-1 and -2, scope and tooth stiffness; limits of the angles in IACS UR M56, too.

    Examples
    --------
    >>> scope_notes(pressure_angle=0.35, helix_angle=0.6, transverse_contact_ratio=1.5)
    ('scope: a helix angle of 34.4 deg is above 30 deg',)
    """
    pressure, helix, ratio = degrees(pressure_angle), abs(degrees(helix_angle)), transverse_contact_ratio
    (first, second), (low, high) = profile_shifts, PRESSURE_ANGLES
    total = first + second
    cases = (
        (
            not low - _ROUNDING <= pressure <= high + _ROUNDING,
            f"a pressure angle of {plain(pressure, 3)} deg is not within {plain(low, 6)} to {plain(high, 6)} deg",
        ),
        (
            helix > LARGEST_HELIX + _ROUNDING,
            f"a helix angle of {plain(helix, 3)} deg is above {plain(LARGEST_HELIX, 6)} deg",
        ),
        (not 1.0 <= ratio <= 2.5, f"a transverse contact ratio of {plain(ratio)} is not within 1 to 2.5"),
        (
            1.0 <= ratio < 1.2,
            f"c_gamma_alpha is up to 10 % high at a transverse contact ratio of {plain(ratio)}, below 1.2",
        ),
        (first < second, f"c' was not fitted for x_1 = {plain(first, 6)} below x_2 = {plain(second, 6)}"),
        (not -0.5 <= total <= 2.0, f"c' was not fitted for x_1 + x_2 = {plain(total, 3)}, not within -0.5 to 2"),
    )
    return tuple(f"scope: {words}" for holds, words in cases if holds)


@checked
def disc_inertia(mean_diameter: float, bore_diameter: float = 0.0, density: float = 7850.0) -> float:
    r"""Moment of inertia of a gear as a disc, for each mm of its face width [kg mm].

    .. math:: J^*= \frac{\pi}{32}\,\varrho\,(d_m^4 - d_i^4),\qquad d_m = \tfrac12 (d_a + d_f)

    Parameters
    ----------
    mean_diameter, bore_diameter : float [mm]
    density : float [kg/m3]

    References
    ----------
    ISO 6336-1:2019, formulas (30) to (32).

    Examples
    --------
    >>> round(disc_inertia(100.0), 3)
    77.067
    """
    require_positive(mean_diameter=mean_diameter, density=density)
    inside = 0.0 <= bore_diameter < mean_diameter
    require((inside, f"bore_diameter: {bore_diameter} mm; allowed 0 to below the mean diameter, {mean_diameter} mm"))
    return pi / 32.0 * 1e-9 * density * (mean_diameter**4 - bore_diameter**4)


@checked
def reduced_mass(
    inertias: tuple[float, float], base_radii: tuple[float, float], *, meshes: tuple[int, int] = (1, 1)
) -> float:
    r"""Reduced mass m_red of a pair on its line of action, for each mm of face width [kg/mm].

    .. math:: \frac{1}{m_{red}} = \frac{p_1}{m_1} + \frac{p_2}{m_2},\qquad m = \frac{J^*}{r_b^2}

    Parameters
    ----------
    inertias : (float, float) [kg mm]
        Moments of inertia for each mm of face width; inf: a gear that does not swing.
    base_radii : (float, float) [mm]
    meshes : (int, int)
        p, of each gear at once: planets for the sun and a ring that swings, 1 for a planet against the sun.

    References
    ----------
    ISO 6336-1:2019, formulas (6) to (8), and 6.5.9.

    Examples
    --------
    >>> inertia = disc_inertia(100.0)
    >>> round(reduced_mass((inertia, inertia), (46.98, 46.98)), 6)
    0.017459

    Sun and one of three planets, printed 0.1534:

    >>> inertias = disc_inertia(387.338, 194.32, 7830.0), disc_inertia(770.163, 576.96, 7830.0)
    >>> round(reduced_mass(inertias, (177.602, 355.204), meshes=(3, 1)), 4)
    0.1534
    """
    require(
        *((each > 0.0, f"inertias: {each} kg mm is not positive") for each in inertias),
        *((0.0 < each < inf, f"base_radii: {each} mm is not positive and finite") for each in base_radii),
        *((each >= 1, f"meshes: {each} is below 1") for each in meshes),
        (min(inertias) < inf, "inertias: one of the gears has to swing"),
    )
    masses = [inertia / radius**2 for inertia, radius in zip(inertias, base_radii, strict=True)]
    return 1.0 / sum(count / mass for count, mass in zip(meshes, masses, strict=True))


@checked
def resonance_speed(teeth: int, mesh_stiffness: float, reduced_mass: float) -> float:
    r"""Speed of the pinion at which the meshing frequency is the natural frequency of the pair, n_E1 [rpm].

    .. math:: n_{E1} = \frac{30000}{\pi z_1} \sqrt{\frac{c_{\gamma\alpha}}{m_{red}}}

    Parameters
    ----------
    teeth : int
        z_1.
    mesh_stiffness : float [N/(mm um)]
    reduced_mass : float [kg/mm]

    References
    ----------
    ISO 6336-1:2019, formula (6).

    Examples
    --------
    Printed 2843:

    >>> round(resonance_speed(24, 18.632, 0.36503))
    2843
    """
    require_positive(teeth=teeth, mesh_stiffness=mesh_stiffness, reduced_mass=reduced_mass)
    return 30000.0 / (pi * teeth) * (mesh_stiffness / reduced_mass) ** 0.5


@checked
def running_in_relief(limit_stress: float) -> float:
    r"""Tip relief C_ay that running in leaves on a gear without one [um].

    .. math:: C_{ay} = \frac{1}{18} \left(\frac{\sigma_{H\,lim}}{97} - 18.45\right)^2 + 1.5

    Parameters
    ----------
    limit_stress : float [MPa]
        sigma_H_lim; of unlike gears the mean of both C_ay counts.

    References
    ----------
    ISO 6336-1:2019, table 8.

    Examples
    --------
    >>> round(running_in_relief(1500.0), 3)
    1.995
    """
    require_positive(limit_stress=limit_stress)
    return (limit_stress / 97.0 - 18.45) ** 2 / 18.0 + 1.5


_GREY, _HARDENED = ("GG", "GGG ferritic"), ("Eh", "IF", "NT", "NV", "NV nitrocarburized")


def _run_in(kind: str, amount: Array, speed: Array, soft: float, grey: float, hard: float, largest: float) -> Array:
    """Shares of deviations [um] of soft, grey and hardened flanks; the last no larger than a number at any speed."""
    family = material_kind(kind).family
    if family in _HARDENED:
        return np.minimum(hard * amount, np.full(speed.shape, largest))
    bound = np.where(speed <= 5.0, inf, np.where(speed <= 10.0, 80.0, 40.0))
    return np.asarray((grey if family in _GREY else soft) * np.minimum(amount, bound))


@checked
def running_in_allowance(kind: str, deviation: float, limit_stress: float, velocity: ArrayLike = 0.0) -> Array:
    r"""Running-in allowance y_alpha of a gear for a pitch deviation, and y_p, y_f of the dynamic factor [um].

    .. math:: y_\alpha = \frac{160}{\sigma_{H\,lim}} f_{pb},\qquad 0.275 f_{pb},\qquad 0.075 f_{pb} \le 3

    of St, V, GGG and GTS; of GG and ferritic GGG; of hardened flanks. Above 5 m/s the first two are bounded by those of
    a deviation of 80 um, above 10 m/s by those of 40 um.

    Parameters
    ----------
    kind : str
        One of ``iso6336_5.KINDS``; of unlike gears the mean of both allowances counts.
    deviation : float [um]
        f_pb, of the dynamic factor also f_f_alpha.
    limit_stress : float [MPa]
        sigma_H_lim.
    velocity : array [m/s]
        v, at the reference circle.

    References
    ----------
    ISO 6336-1:2019, formulas (77) to (79).

    Examples
    --------
    The mean of case-hardened and through-hardened gears, printed 3.142:

    >>> both = running_in_allowance("Eh", 20.7, 1500.0), running_in_allowance("V alloy", 20.7, 700.0)
    >>> round(float(sum(both)) / 2, 3)
    3.142
    """
    require_positive(limit_stress=limit_stress)
    require((0.0 <= deviation < inf, f"deviation: {deviation} um is negative or not finite"))
    speed = np.asarray(velocity, dtype=float)
    require(interval_check("velocity", speed, "[0, inf)", "m/s"))
    return _run_in(kind, np.asarray(deviation), speed, 160.0 / limit_stress, 0.275, 0.075, largest=3.0)


@checked
def running_in_misalignment(
    kind: str, misalignment: ArrayLike, limit_stress: float, velocity: ArrayLike = 0.0
) -> Array:
    r"""Running-in allowance y_beta of a gear for the equivalent misalignment [um].

    .. math:: y_\beta = \frac{320}{\sigma_{H\,lim}} F_{\beta x},\qquad 0.55 F_{\beta x},\qquad 0.15 F_{\beta x} \le 6

    of St, V, GGG and GTS, no larger than F_betax; of GG and ferritic GGG; of hardened flanks. Above 5 m/s the first two
    are bounded by those of 80 um, above 10 m/s by those of 40 um.

    Parameters
    ----------
    kind : str
        One of ``iso6336_5.KINDS``; of unlike gears the mean of both allowances counts.
    misalignment : array [um]
        F_betax, before running in.
    limit_stress : float [MPa]
        sigma_H_lim.
    velocity : array [m/s]
        v, at the reference circle.

    References
    ----------
    ISO 6336-1:2019, 7.5.

    Examples
    --------
    >>> float(running_in_misalignment("Eh", 20.0, 1500.0)), float(running_in_misalignment("V alloy", 20.0, 640.0))
    (3.0, 10.0)
    """
    require_positive(limit_stress=limit_stress)
    amount, speed = np.asarray(misalignment, dtype=float), np.asarray(velocity, dtype=float)
    require(
        interval_check("misalignment", amount, "[0, inf)", "um"), interval_check("velocity", speed, "[0, inf)", "m/s")
    )
    return _run_in(kind, amount, speed, min(1.0, 320.0 / limit_stress), 0.55, 0.15, largest=6.0)


@checked
def contact_face_load_factor(misalignment: ArrayLike, mesh_stiffness: float, specific_load: ArrayLike) -> Array:
    r"""Face load factor K_Hbeta by method C.

    .. math::
        K_{H\beta} = 1 + \frac{F_{\beta y} c_{\gamma\beta}}{2 F_m/b}\quad (K_{H\beta} \le 2),\qquad
        K_{H\beta} = \sqrt{\frac{2 F_{\beta y} c_{\gamma\beta}}{F_m/b}}

    the load of stiff bodies on even springs, over the whole face and over a part of it.

    Parameters
    ----------
    misalignment : array [um]
        F_betay, after running in: F_betax less y_beta.
    mesh_stiffness : float [N/(mm um)]
        c_gamma_beta, 0.85 c_gamma_alpha.
    specific_load : array [N/mm]
        F_m/b = F_t K_A K_gamma K_v/b.

    References
    ----------
    ISO 6336-1:2019, formulas (41), (42).

    Examples
    --------
    >>> [round(float(each), 4) for each in contact_face_load_factor([0.0, 20.0, 80.0], 15.0, 300.0)]
    [1.0, 1.5, 2.8284]
    """
    amount, load = np.asarray(misalignment, dtype=float), np.asarray(specific_load, dtype=float)
    require_positive(mesh_stiffness=mesh_stiffness)
    require(
        interval_check("misalignment", amount, "[0, inf)", "um"),
        interval_check("specific_load", load, "(0, inf)", "N/mm"),
    )
    slope = amount * mesh_stiffness / load
    return np.where(slope <= 2.0, 1.0 + 0.5 * slope, np.sqrt(2.0 * slope))


@dataclass(frozen=True, eq=False)
class DynamicFactor:
    """Dynamic factor of a pair, and what it follows from.

    Attributes
    ----------
    K_v : array
    N, N_S : array
        Resonance ratio n_1/n_E1; the largest of the subcritical range.
    range : array of int
        Index in ``RANGES``.
    B_p, B_f, B_k : array
        Pitch deviation, profile deviation and tip relief over the deflection under load.
    C_v : (float, ...)
        C_v1 to C_v7.
    notes : (str, ...)
        What lies outside the range of the method.
    noted : (array of bool, ...)
        Of which loads and speeds each note is true.
    """

    K_v: Array
    N: Array
    N_S: Array
    range: Array
    B_p: Array
    B_f: Array
    B_k: Array
    C_v: tuple[float, ...]
    notes: tuple[str, ...]
    noted: tuple[Mask, ...]


@checked
def dynamic_coefficients(total_contact_ratio: float) -> tuple[float, ...]:
    """C_v1 to C_v7 of eps_gamma (table 8), of bevel gears too (ISO 10300-1, table 3)."""
    ratio = total_contact_ratio
    if ratio <= 2.0:
        second, third, fourth, sixth = 0.34, 0.23, 0.90, 0.47
    else:
        second, third = 0.57 / (ratio - 0.3), 0.096 / (ratio - 1.56)
        fourth, sixth = (0.57 - 0.05 * ratio) / (ratio - 1.44), 0.12 / (ratio - 1.74)
    if ratio <= 1.5:
        seventh = 0.75
    elif ratio <= 2.5:
        seventh = 0.125 * sin(pi * (ratio - 2.0)) + 0.875
    else:
        seventh = 1.0
    return 0.32, second, third, fourth, 0.47, sixth, seventh


@checked
def dynamic_factor(
    resonance_ratio: ArrayLike,
    specific_load: ArrayLike,
    *,
    single_stiffness: ArrayLike,
    total_contact_ratio: float,
    pitch_deviation: ArrayLike,
    profile_deviation: ArrayLike,
    tip_relief: float,
    speed_parameter: ArrayLike = inf,
) -> DynamicFactor:
    r"""Dynamic factor K_v by method B.

    .. math::
        B_p = \frac{c' f_{pb,eff}}{w},\qquad B_f = \frac{c' f_{f\alpha,eff}}{w},\qquad
        B_k = \left|1 - \frac{c' C_a}{w}\right|,\qquad w = \frac{F_t K_A K_\gamma}{b}

    .. math::
        K_v = \begin{cases}
        1 + N (C_{v1} B_p + C_{v2} B_f + C_{v3} B_k) & N \le N_S\\
        1 + C_{v1} B_p + C_{v2} B_f + C_{v4} B_k & N_S < N \le 1.15\\
        C_{v5} B_p + C_{v6} B_f + C_{v7} & N \ge 1.5\end{cases}

    and a straight line over N between 1.15 and 1.5; N_S is 0.85, below 100 N/mm :math:`0.5 + 0.35 \sqrt{w/100}`. The
    factor is no smaller than 1.

    Parameters
    ----------
    resonance_ratio : array
        N, speed of the pinion over the resonance speed.
    specific_load : array [N/mm]
        w.
    single_stiffness : array [N/(mm um)]
        c'; ``iso6336.single_stiffness`` has its fall below 100 N/mm.
    total_contact_ratio : float
        eps_gamma, above 1.
    pitch_deviation, profile_deviation : array [um]
        f_pb and f_f_alpha after running in, the larger of both gears.
    tip_relief : float [um]
        C_a; of gears without one ``running_in_relief``.
    speed_parameter : array [m/s]
        (v z_1/100) sqrt(u^2/(1 + u^2)), for a note where the method is not needed.

    Returns
    -------
    DynamicFactor

    Raises
    ------
    InputError
        If a value is out of range; every one is named.

    References
    ----------
    ISO 6336-1:2019, formulas (9) to (22), table 8.

    Examples
    --------
    Printed 1.092, with accuracy grade 6 and the relief of running in:

    >>> factor = dynamic_factor(0.410, 833.56, single_stiffness=13.832, total_contact_ratio=2.884,
    ...                         pitch_deviation=15.9 - 1.2, profile_deviation=22.0 - 1.6, tip_relief=2.0)
    >>> round(float(factor.K_v), 3), RANGES[factor.range]
    (1.091, 'subcritical')
    """
    ratio, load, stiffness, pitch, profile, speed = (
        np.asarray(each, dtype=float)
        for each in (
            resonance_ratio, specific_load, single_stiffness, pitch_deviation, profile_deviation, speed_parameter,
        )
    )  # fmt: skip
    require(
        interval_check("resonance_ratio", ratio, "[0, inf)"),
        interval_check("specific_load", load, "(0, inf)", "N/mm"),
        interval_check("single_stiffness", stiffness, "(0, inf)", "N/(mm um)"),
        (1.0 < total_contact_ratio < inf, f"total_contact_ratio: {total_contact_ratio} is not above 1"),
        interval_check("pitch_deviation", pitch, "[0, inf)", "um"),
        interval_check("profile_deviation", profile, "[0, inf)", "um"),
        (0.0 <= tip_relief < inf, f"tip_relief: {tip_relief} um is negative or not finite"),
    )
    softness = stiffness / load
    b_p, b_f, b_k = softness * pitch, softness * profile, np.abs(1.0 - softness * tip_relief)
    constants = dynamic_coefficients(total_contact_ratio)
    first, second, third, fourth, fifth, sixth, seventh = constants
    below = 1.0 + ratio * (first * b_p + second * b_f + third * b_k)
    resonance = 1.0 + first * b_p + second * b_f + fourth * b_k
    above = fifth * b_p + sixth * b_f + seventh
    between = above + (resonance - above) * (SUPERCRITICAL - ratio) / (SUPERCRITICAL - MAIN_RESONANCE_END)
    edge = 0.5 + 0.35 * np.sqrt(np.minimum(load, FULL_LOAD) / FULL_LOAD)
    place = (ratio > edge).astype(int) + (ratio > MAIN_RESONANCE_END) + (ratio >= SUPERCRITICAL)
    factor = np.maximum(1.0, np.choose(place, np.broadcast_arrays(place, below, resonance, between, above)[1:]))
    notes = _dynamic_notes(place, speed, load)
    return DynamicFactor(
        np.asarray(factor), ratio, np.asarray(edge), np.asarray(place), b_p, b_f, b_k, constants, (*notes,),
        (*notes.values(),),
    )  # fmt: skip


def _dynamic_notes(place: Array, speed: Array, load: Array) -> dict[str, Mask]:
    """What method B does not cover, and for which loads and speeds."""
    cases = (
        (place == 1, "K_v: N lies in the main resonance, which the standard says to avoid or to analyse by method A"),
        (place == 2, "K_v: N lies between main resonance and supercritical range; a line between both is rough"),
        (
            speed < USEFUL_SPEED,
            f"K_v: (v z_1/100) sqrt(u^2/(1 + u^2)) is below {plain(USEFUL_SPEED, 6)} m/s: not needed there",
        ),
        (
            load < FULL_LOAD,
            f"K_v: the load is below {plain(FULL_LOAD, 6)} N/mm, where c' falls with (w/{plain(FULL_LOAD, 6)})^0.25",
        ),
    )
    return {words: np.broadcast_to(holds, place.shape) for holds, words in cases if bool(np.any(holds))}


@checked
def largest_root_load_factor(
    transverse_contact_ratio: float, overlap_ratio: float, virtual_contact_ratio: float
) -> float:
    r"""Upper bound of K_Falpha.

    .. math:: \frac{\varepsilon_\gamma}{\varepsilon_\alpha Y_\varepsilon},\qquad
        Y_\varepsilon = 0.25 + \frac{0.75}{\varepsilon_{\alpha n}}

    Parameters
    ----------
    transverse_contact_ratio, overlap_ratio, virtual_contact_ratio : float
        eps_alpha, eps_beta, eps_alpha_n.

    References
    ----------
    ISO 6336-1:2019, formula (76).

    Examples
    --------
    >>> largest_root_load_factor(1.5, 0.0, 1.5)
    1.3333333333333333
    """
    require_positive(transverse_contact_ratio=transverse_contact_ratio, virtual_contact_ratio=virtual_contact_ratio)
    require((0.0 <= overlap_ratio < inf, f"overlap_ratio: {overlap_ratio} is negative or not finite"))
    share = 0.25 + 0.75 / virtual_contact_ratio
    return (transverse_contact_ratio + overlap_ratio) / (transverse_contact_ratio * share)


@checked
def transverse_load_factors(
    specific_load: ArrayLike,
    *,
    mesh_stiffness: ArrayLike,
    deviation: ArrayLike,
    transverse_contact_ratio: float,
    overlap_ratio: float,
    virtual_contact_ratio: float,
) -> tuple[Array, Array]:
    r"""Transverse load factors K_Halpha and K_Falpha by method B.

    .. math::
        K = \frac{\varepsilon_\gamma}{2} \left(0.9 + 0.4\,\frac{c_{\gamma\alpha} (f_{pb} - y_\alpha)}{F_{tH}/b}\right)
        \quad (\varepsilon_\gamma \le 2),\qquad
        K = 0.9 + 0.4 \sqrt{\frac{2 (\varepsilon_\gamma - 1)}{\varepsilon_\gamma}}\,
        \frac{c_{\gamma\alpha} (f_{pb} - y_\alpha)}{F_{tH}/b}

    at least 1 and at most :math:`\varepsilon_\gamma/(\varepsilon_\alpha Z_\varepsilon^2)`, of roots
    :math:`\varepsilon_\gamma/(\varepsilon_\alpha Y_\varepsilon)` with
    :math:`Y_\varepsilon = 0.25 + 0.75/\varepsilon_{\alpha n}`.

    Parameters
    ----------
    specific_load : array [N/mm]
        F_tH/b = F_t K_A K_gamma K_v K_Hbeta/b.
    mesh_stiffness : array [N/(mm um)]
        c_gamma_alpha.
    deviation : array [um]
        f_pb - y_alpha, of the larger base pitch deviation, or that of the profile f_f_alpha if it is larger.
    transverse_contact_ratio, overlap_ratio, virtual_contact_ratio : float
        eps_alpha, eps_beta, eps_alpha_n.

    Returns
    -------
    (array, array)

    References
    ----------
    ISO 6336-1:2019, formulas (73) to (76).

    Examples
    --------
    Printed 1.069:

    >>> factors = transverse_load_factors(833.56 * 1.092 * 1.15, mesh_stiffness=18.632, deviation=22.0 - 1.2,
    ...     transverse_contact_ratio=1.463, overlap_ratio=1.421, virtual_contact_ratio=1.503)
    >>> [round(float(factor), 3) for factor in factors]
    [1.069, 1.069]
    """
    load, stiffness, error = (np.asarray(each, dtype=float) for each in (specific_load, mesh_stiffness, deviation))
    largest = largest_transverse_load_factor(transverse_contact_ratio, overlap_ratio)
    require_positive(virtual_contact_ratio=virtual_contact_ratio)
    require(
        interval_check("specific_load", load, "(0, inf)", "N/mm"),
        interval_check("mesh_stiffness", stiffness, "(0, inf)", "N/(mm um)"),
        interval_check("deviation", error, "[0, inf)", "um"),
    )
    total = transverse_contact_ratio + overlap_ratio
    part = 0.4 * stiffness * error / load
    factor = 0.5 * total * (0.9 + part) if total <= 2.0 else 0.9 + (2.0 * (total - 1.0) / total) ** 0.5 * part
    of_roots = largest_root_load_factor(transverse_contact_ratio, overlap_ratio, virtual_contact_ratio)
    flank, root = (np.maximum(1.0, np.minimum(factor, bound)) for bound in (largest, of_roots))
    return np.asarray(flank), np.asarray(root)
