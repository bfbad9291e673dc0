"""Scuffing by the flash temperature: what a load stage of the FZG test says of an oil, and the safety.

Formulas are those of ISO/TR 13989-1:2000 with its numbers in brackets, taken for ISO/TS 6336-20, whose text was not
seen; checked against the report of KISSsoft 03/2017A on stage 3 of the gearbox of the NREL 5 MW turbine.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array
from loaded_tca.errors import require, require_positive

LOAD_STAGES = 1, 14
"""First and last load stage of the FZG test A/8.3/90."""


@checked
def scuffing_temperature(
    load_stage: float, viscosity: float, lubricant_factor: float = 1.0, structure_factor: float = 1.0
) -> float:
    r"""Scuffing temperature of an oil by its load stage in the FZG test A/8.3/90 [C].

    .. math:: \theta_S = 80 + (0.85 + 1.4\, X_W)\, X_L S^2, \qquad X_L = k\, \eta_{oil}^{-0.05}

    Parameters
    ----------
    load_stage : float
        S, from 1 to 14, at which the oil fails.
    viscosity : float [mPa s]
        Dynamic, at the temperature of the oil.
    lubricant_factor : float
        k: 1 for mineral oils, 0.8 for polyalphaolefins, 0.7 for polyglycols not soluble in water.
    structure_factor : float
        X_W of the material: 1 for case-hardened steel.

    Returns
    -------
    float [C]

    References
    ----------
    ISO/TR 13989-1:2000, (99).

    Examples
    --------
    Printed 451.98:

    >>> round(scuffing_temperature(14, 30.09), 2)
    451.98
    """
    low, high = LOAD_STAGES
    require((low <= load_stage <= high, f"load_stage: {load_stage}; allowed a number from {low} to {high}"))
    require_positive(viscosity=viscosity, lubricant_factor=lubricant_factor, structure_factor=structure_factor)
    return 80.0 + (0.85 + 1.4 * structure_factor) * lubricant_factor * viscosity**-0.05 * load_stage**2


@checked
def scuffing_safety(
    scuffing_temperature: ArrayLike, oil_temperature: ArrayLike, contact_temperature: ArrayLike
) -> Array:
    r"""Safety against scuffing by the largest contact temperature.

    .. math:: S_B = \frac{\theta_S - \theta_{oil}}{\theta_{B,max} - \theta_{oil}}

    Parameters
    ----------
    scuffing_temperature, oil_temperature, contact_temperature : array [C]

    Returns
    -------
    array
        inf where the contact is no warmer than the oil; negative where the oil itself is hotter than the scuffing
        temperature, so that no contact is safe.

    References
    ----------
    ISO/TR 13989-1:2000, (100).

    Examples
    --------
    Printed 4.156:

    >>> round(float(scuffing_safety(451.98, 80.0, 169.50)), 3)
    4.156
    """
    margin, rise = (np.asarray(at, dtype=float) - oil_temperature for at in (scuffing_temperature, contact_temperature))
    with np.errstate(divide="ignore"):
        return np.asarray(margin / np.maximum(rise, 0.0))
