"""Closed forms of the standard on micropitting: film thickness, flash and bulk temperature, friction, loss factor.

Formulas are those of ISO/TR 15144-1:2014 with its numbers in brackets, which ISO/TS 6336-22 took over; the text of the
latter was not seen. They were checked against the report of KISSsoft 03/2017A on stage 3 of the gearbox of the NREL
5 MW turbine (public, gfsReboucas/Drivetrain), whose numbers are the examples.

Arrays broadcast. Lengths in mm, pressures and moduli in MPa, velocities in m/s, temperatures in degrees Celsius,
viscosities in mPa s, films and roughness in um.
"""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array
from loaded_tca.errors import require, require_positive


class LubricantLike(Protocol):
    """What the film thickness asks of a lubricant."""

    def viscosity(self, temperature: ArrayLike) -> Array:
        """Dynamic viscosity [mPa s]."""

    def pressure_viscosity(self, temperature: ArrayLike) -> Array:
        """Pressure-viscosity coefficient [mm2/N]."""


@checked
def film_thickness(
    radius: ArrayLike,
    reduced_modulus: float,
    pressure: ArrayLike,
    sum_velocity: ArrayLike,
    lubricant: LubricantLike,
    bulk_temperature: ArrayLike,
    contact_temperature: ArrayLike,
) -> Array:
    r"""Thickness of the lubricant film h [um].

    .. math::
        h = 1600\, \rho\, G^{0.6} U^{0.7} W^{-0.13} S^{0.22},\qquad
        G = 10^6 \alpha_M E_r,\; U = \frac{\eta_M v_\Sigma}{2000 E_r \rho},\;
        W = \frac{2 \pi p^2}{E_r^2},\; S = \frac{\alpha_B \eta_B}{\alpha_M \eta_M}

    with the pressure-viscosity coefficient in 1/Pa and the viscosity in Pa s, at the bulk temperature (M) and at that
    of the contact (B). S thins the film by the heat of sliding; a contact temperature equal to the bulk leaves it out.

    Parameters
    ----------
    radius : array [mm]
        rho, of relative curvature in the normal section.
    reduced_modulus : float [MPa]
        E_r, twice the contact modulus E*.
    pressure : array [MPa]
        Hertzian, with the factors for dynamic load.
    sum_velocity : array [m/s]
        v_Sigma.
    lubricant : Lubricant
        With ``viscosity`` and ``pressure_viscosity`` over temperature, as :class:`loaded_tca.tribology.Lubricant`.
    bulk_temperature, contact_temperature : array [C]

    Returns
    -------
    array [um]

    References
    ----------
    ISO/TR 15144-1:2014, (4) to (29).

    Examples
    --------
    At point A of the published stage, lambda = h/Ra with Ra = 0.6 um; the report has 0.632 um and 1.053:

    >>> from loaded_tca.tribology import Lubricant
    >>> oil = Lubricant(viscosity_40=220.0, viscosity_100=19.0, density_15=890.0, oil_temperature=80.0)
    >>> flash = flash_temperature(0.030, 1014.7, 37.1215, 226374.0, 5.1114, 9.0238, 3.9124, 13784.0, 13784.0)
    >>> film = film_thickness(37.1215, 226374.0, 1014.7, 14.1352, oil, 85.03, 85.03 + flash)
    >>> round(float(film), 3), round(float(film) / 0.6, 2)
    (0.632, 1.05)
    """
    bulk, hot = (
        (np.asarray(lubricant.pressure_viscosity(at)), np.asarray(lubricant.viscosity(at)))
        for at in (bulk_temperature, contact_temperature)
    )
    material = bulk[0] * reduced_modulus  # mm2/N times N/mm2
    velocity = 1e-3 * bulk[1] * np.asarray(sum_velocity) / (2000.0 * reduced_modulus * np.asarray(radius))
    load = 2.0 * math.pi * (np.asarray(pressure) / reduced_modulus) ** 2
    thinning = hot[0] * hot[1] / (bulk[0] * bulk[1])
    with np.errstate(divide="ignore"):
        return np.asarray(1600.0 * np.asarray(radius) * material**0.6 * velocity**0.7 * load**-0.13 * thinning**0.22)


@checked
def flash_temperature(
    friction: ArrayLike,
    pressure: ArrayLike,
    radius: ArrayLike,
    reduced_modulus: float,
    rolling_velocity_1: ArrayLike,
    rolling_velocity_2: ArrayLike,
    sliding_velocity: ArrayLike,
    thermal_contact_coefficient_1: float,
    thermal_contact_coefficient_2: float,
) -> Array:
    r"""Flash temperature of a line contact, above the bulk [K].

    .. math::
        \theta_{fl} = \frac{\sqrt\pi}{2}\, \frac{10^6 \mu\, p\, v_g}{B_1 \sqrt{v_{r1}} + B_2 \sqrt{v_{r2}}}
        \sqrt{\frac{8 \rho\, p}{1000\, E_r}}

    1.6 to 1.8 % above the exact one of fast moving half-spaces with a Hertzian source.

    Parameters
    ----------
    friction : array
        mu.
    pressure : array [MPa]
        Hertzian, with the factors for dynamic load.
    radius : array [mm]
        rho.
    reduced_modulus : float [MPa]
        E_r, twice the contact modulus E*.
    rolling_velocity_1, rolling_velocity_2 : array [m/s]
        Of both surfaces across the contact.
    sliding_velocity : array [m/s]
        v_g, not negative.
    thermal_contact_coefficient_1, thermal_contact_coefficient_2 : float [J/(m2 K s^0.5)]
        B_M, the root of conductivity, density and heat capacity.

    Returns
    -------
    array [K]
        0 where nothing slides.

    References
    ----------
    ISO/TR 15144-1:2014, (80).

    Examples
    --------
    >>> round(float(flash_temperature(0.03, 1014.7, 37.1215, 226374.0, 5.1114, 9.0238, 3.9124, 13784.0, 13784.0)), 1)
    53.1
    """
    first, second = (
        coefficient * np.sqrt(np.abs(velocity))
        for coefficient, velocity in (
            (thermal_contact_coefficient_1, rolling_velocity_1),
            (thermal_contact_coefficient_2, rolling_velocity_2),
        )
    )
    peak = np.asarray(pressure)
    heat = 0.5e6 * math.sqrt(math.pi) * np.asarray(friction) * peak * np.asarray(sliding_velocity)
    carried = np.asarray(first + second)
    rate = np.divide(heat, carried, out=np.zeros(np.broadcast_shapes(heat.shape, carried.shape)), where=heat > 0.0)
    return np.asarray(rate * np.sqrt(8e-3 * np.asarray(radius) * peak / reduced_modulus))


@checked
def mean_friction(
    line_load: ArrayLike,
    sum_velocity: ArrayLike,
    radius: float,
    viscosity: ArrayLike,
    roughness: float,
    total_contact_ratio: float,
    lubricant_factor: float = 1.0,
) -> Array:
    r"""Mean coefficient of friction of a mesh.

    .. math::
        \mu_m = 0.045 \left(\frac{K_{B\gamma}\, w_{bt}}{v_{\Sigma C}\, \rho_{nC}}\right)^{0.2} \eta^{-0.05} X_R X_L,
        \qquad X_R = 2.2 \left(\frac{Ra}{\rho_{nC}}\right)^{0.25}

    with the helical load factor for scuffing :math:`K_{B\gamma}` = 1 up to a total contact ratio of 2,
    :math:`1 + 0.2 \sqrt{(\varepsilon_\gamma - 2)(5 - \varepsilon_\gamma)}` up to 3.5 and 1.3 beyond.

    Parameters
    ----------
    line_load : array [N/mm]
        w_bt, tangential force at the base circle over the face width, with K_A, K_V, K_Halpha and K_Hbeta.
    sum_velocity : array [m/s]
        v_SigmaC, at the pitch point.
    radius : float [mm]
        rho_nC, of relative curvature in the normal section at the pitch point.
    viscosity : array [mPa s]
        Dynamic, at the temperature of the oil.
    roughness : float [um]
        Ra, the mean of both flanks.
    total_contact_ratio : float
        eps_gamma.
    lubricant_factor : float
        X_L: 1 for mineral oils, 0.8 for polyalphaolefins, 0.7 for polyglycols not soluble in water.

    Returns
    -------
    array

    References
    ----------
    ISO/TR 15144-1:2014, (86) to (90).

    Examples
    --------
    The published stage, 0.030:

    >>> round(float(mean_friction(1.6780 * 255936.0 / 360.0, 16.469, 54.577, 30.09, 0.6, 2.884)), 4)
    0.03
    """
    require_positive(radius=radius)
    excess = min(max(total_contact_ratio, 2.0), 3.5)
    bearing = 1.0 + 0.2 * math.sqrt((excess - 2.0) * (5.0 - excess))
    rough = 2.2 * (roughness / radius) ** 0.25
    load = bearing * np.asarray(line_load) / (np.asarray(sum_velocity) * radius)
    return np.asarray(0.045 * load**0.2 * np.asarray(viscosity, dtype=float) ** -0.05 * rough * lubricant_factor)


SUPPLY_FACTORS = {"dip": 1.0, "spray": 1.2, "submerged": 0.2}
"""X_S: how the oil comes to the gears."""


@checked
def bulk_temperature(
    oil_temperature: ArrayLike,
    power_kW: ArrayLike,
    mean_friction: ArrayLike,
    load_loss_factor: ArrayLike,
    centre_distance: float,
    face_width: float,
    supply_factor: float = 1.0,
    tip_relief_factor: float = 1.0,
) -> Array:
    r"""Bulk temperature of the teeth [C].

    .. math::
        \theta_M = \theta_{oil} + 7400 \left(\frac{P \mu_m H_v}{a\, b}\right)^{0.72} \frac{X_S}{1.2\, X_{Ca}}

    Parameters
    ----------
    oil_temperature : array [C]
    power_kW : array [kW]
        Transmitted, nominal.
    mean_friction, load_loss_factor : array
        mu_m, H_v.
    centre_distance, face_width : float [mm]
    supply_factor : float
        X_S: 1 for dip lubrication, 1.2 for spray, 0.2 for gears that run submerged.
    tip_relief_factor : float
        X_Ca, at least 1; 1 without tip relief.

    Returns
    -------
    array [C]

    References
    ----------
    ISO/TR 15144-1:2014, (84).

    Examples
    --------
    The published stage, 85.0 C:

    >>> round(float(bulk_temperature(80.0, 5000.0, 0.0300, 0.106, 861.0, 360.0)), 1)
    85.0
    """
    require_positive(centre_distance=centre_distance, face_width=face_width, supply_factor=supply_factor)
    lost = np.asarray(power_kW) * np.asarray(mean_friction) * np.asarray(load_loss_factor)
    rise = 7400.0 * (lost / (centre_distance * face_width)) ** 0.72
    return np.asarray(oil_temperature + rise * supply_factor / (1.2 * tip_relief_factor))


@checked
def load_loss_factor(
    recess: float, approach: float, teeth_1: int, teeth_2: int, base_helix_angle: float = 0.0
) -> float:
    r"""Load loss factor H_v of a mesh, by the contact ratios of recess and approach.

    .. math::
        H_v = \left(1 - \varepsilon_\alpha + \varepsilon_1^2 + \varepsilon_2^2\right)
        \frac{\pi (1/z_1 + 1/z_2)}{\cos\beta_b}, \qquad \varepsilon_\alpha = \varepsilon_1 + \varepsilon_2

    below a transverse contact ratio of 2, which is Ohlendorf's for spur gears whose pairs share the load evenly; from 2
    on :math:`0.5\, \varepsilon_\alpha` stands in the place of the bracket. For an overlap ratio above 1 it is some
    15 % too low: their contact lines lie over the whole path at once.

    Parameters
    ----------
    recess, approach : float
        eps_1 and eps_2, parts of the transverse contact ratio beyond and before the pitch point.
    teeth_1, teeth_2 : int
        teeth_2 negative of a ring gear.
    base_helix_angle : float [rad]
        beta_b.

    Returns
    -------
    float

    References
    ----------
    ISO/TR 15144-1:2014, (91), (92); Ohlendorf 1958. The second case was not checked against a printed number.

    Examples
    --------
    The published stage, 0.106:

    >>> round(load_loss_factor(0.852, 0.611, 24, 95, math.radians(9.391)), 3)
    0.106
    """
    require(
        (
            teeth_1 > 0 and (teeth_2 > 0 or -teeth_2 > teeth_1),
            f"teeth_1, teeth_2: {teeth_1}, {teeth_2}; allowed numbers above 0, of a ring gear below -teeth_1",
        ),
        (recess + approach > 0.0, f"recess, approach: {recess}, {approach}; allowed a sum above 0"),
    )
    ratio = recess + approach
    bracket = 1.0 - ratio + recess**2 + approach**2 if ratio < 2.0 else 0.5 * ratio
    return bracket * math.pi * (1.0 / teeth_1 + 1.0 / teeth_2) / math.cos(base_helix_angle)
