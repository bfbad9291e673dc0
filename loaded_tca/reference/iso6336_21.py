"""Scuffing by the integral temperature: a mean over the path of contact, from the flash temperature at its end E.

Formulas are those of ISO/TR 13989-2:2000, taken for ISO/TS 6336-21, whose text was not seen; checked against the report
of KISSsoft 03/2017A on stage 3 of the gearbox of the NREL 5 MW turbine. A method for cylindrical gears without a
contact analysis, kept to compare with. The document takes 150 N/mm for smaller line loads.
"""

from __future__ import annotations

from loaded_tca.arguments import checked
from loaded_tca.errors import require, require_positive

STAGE_TORQUES = (3.3, 13.7, 35.3, 60.8, 94.1, 135.3, 183.4, 239.3, 302.0, 372.6, 450.1, 534.5, 626.9, 714.2)
"""Torque on the pinion of the FZG test A/8.3/90 at the load stages from 1 on [N m]."""


@checked
def contact_ratio_factor(recess: float, approach: float) -> float:
    r"""Contact ratio factor X_eps: mean flash temperature over that at E, where one pair would carry all.

    .. math::
        X_\varepsilon = \frac{0.70 (\varepsilon_1^2 + \varepsilon_2^2) - 0.22\, \varepsilon_\alpha + 0.52
        - 0.60\, \varepsilon_1 \varepsilon_2}{2\, \varepsilon_\alpha \varepsilon_1}

    and, with eps_1 of 1 and more,

    .. math::
        X_\varepsilon = \frac{0.18\, \varepsilon_1^2 + 0.70\, \varepsilon_2^2 + 0.82\, \varepsilon_1
        - 0.52\, \varepsilon_2 - 0.30\, \varepsilon_1 \varepsilon_2}{2\, \varepsilon_\alpha \varepsilon_1},

    with eps_2 of 1 and more the same numerator with eps_1 and eps_2 exchanged. The first formula was checked against a
    printed number; the others pass into it where eps_1 or eps_2 is 1.

    Parameters
    ----------
    recess, approach : float
        eps_1 and eps_2, at least one of them below 1, with a sum from 1 to below 2.

    Raises
    ------
    InputError
        For other contact ratios.

    References
    ----------
    ISO/TR 13989-2:2000.

    Examples
    --------
    Printed 0.263:

    >>> round(contact_ratio_factor(0.852, 0.611), 3)
    0.263
    """
    ratio, largest = recess + approach, max(recess, approach)
    require(
        *(
            (0.0 < value < 2.0, f"{name}: {value}; allowed a number above 0, below 2")
            for name, value in (("recess", recess), ("approach", approach))
        ),
        (1.0 <= ratio < 2.0, f"recess + approach: {ratio}; allowed 1 and more, below 2"),
    )
    if largest < 1.0:
        mean = 0.70 * (recess**2 + approach**2) - 0.22 * ratio + 0.52 - 0.60 * recess * approach
    else:
        other = ratio - largest
        mean = 0.18 * largest**2 + 0.70 * other**2 + 0.82 * largest - 0.52 * other - 0.30 * largest * other
    return mean / (2.0 * ratio * recess)


@checked
def integral_temperature(oil_temperature: float, mean_flash_temperature: float, supply_factor: float = 1.0) -> float:
    r"""Integral temperature [C].

    .. math::
        \theta_{int} = \theta_M + 1.5\, \theta_{flaint}, \qquad
        \theta_M = \theta_{oil} + 0.7\, X_S \theta_{flaint}

    Parameters
    ----------
    oil_temperature : float [C]
    mean_flash_temperature : float [K]
        theta_flaint, that at E times X_eps.
    supply_factor : float
        X_S.

    References
    ----------
    ISO/TR 13989-2:2000.

    Examples
    --------
    Printed 115.75:

    >>> round(integral_temperature(80.0, 16.25), 2)
    115.75
    """
    require_positive(supply_factor=supply_factor)
    return oil_temperature + (0.7 * supply_factor + 1.5) * mean_flash_temperature


@checked
def scuffing_integral_temperature(
    load_stage: int, viscosity_40: float, lubricant_factor: float = 1.0, structure_factor: float = 1.0
) -> float:
    r"""Scuffing integral temperature of an oil by its load stage in the FZG test A/8.3/90 [C].

    .. math::
        \theta_{intS} = 80 + 0.23\, T_{1T} X_L + 1.5 \cdot 0.2\, T_{1T} \left(\frac{100}{\nu_{40}}\right)^{0.02} X_L X_W

    Parameters
    ----------
    load_stage : int
        From 1 to 14; its torque T_1T is that of the table of the test, not of a formula.
    viscosity_40 : float [mm2/s]
        Kinematic, at 40 C.
    lubricant_factor, structure_factor : float
        X_L, X_W.

    References
    ----------
    ISO/TR 13989-2:2000.

    Examples
    --------
    Printed 455.17:

    >>> round(scuffing_integral_temperature(14, 220.0), 2)
    455.17
    """
    whole = isinstance(load_stage, int) and 1 <= load_stage <= len(STAGE_TORQUES)
    require((whole, f"load_stage: {load_stage}; allowed a whole number from 1 to {len(STAGE_TORQUES)}"))
    require_positive(viscosity_40=viscosity_40, lubricant_factor=lubricant_factor, structure_factor=structure_factor)
    torque = STAGE_TORQUES[load_stage - 1] * lubricant_factor
    return 80.0 + 0.23 * torque + 0.3 * torque * (100.0 / viscosity_40) ** 0.02 * structure_factor
