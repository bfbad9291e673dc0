"""Local coefficients of friction of lubricated line contacts, as regressions of experiments give them.

Numbers or arrays in, the same out; arguments broadcast.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array


@checked
def schlenk(
    line_load: ArrayLike,
    sum_velocity: ArrayLike,
    radius: ArrayLike,
    viscosity: ArrayLike,
    roughness: ArrayLike,
    lubricant_factor: float = 1.0,
) -> Array:
    r"""Coefficient of friction after Schlenk.

    .. math:: \mu = 0.048 \left(\frac{w}{v_\Sigma \rho}\right)^{0.2} \eta^{-0.05} Ra^{0.25} X_L

    Fitted for the mean over a path of contact with the numbers of the pitch point.

    Parameters
    ----------
    line_load : array [N/mm]
        w.
    sum_velocity : array [m/s]
        v_Sigma, the sum of both rolling velocities.
    radius : array [mm]
        rho, of relative curvature.
    viscosity : array [mPa s]
        eta, dynamic, at the temperature of the oil.
    roughness : array [um]
        Arithmetic mean roughness Ra, the mean of both flanks.
    lubricant_factor : float
        X_L.

    Returns
    -------
    array
        inf where nothing rolls.

    References
    ----------
    Schlenk 1995, Untersuchungen zur Fresstragfähigkeit von Großzahnrädern, as printed numbers of GEARpie confirm it
    (C14: 0.0449; C40: 0.0256; H501: 0.0420; H951: 0.0458), with the radius of the transverse section.

    Examples
    --------
    FZG C14 at 200 N m and 1500 rpm in an oil of 13.28 mPa s, radius and velocities at its pitch point:

    >>> round(float(schlenk(5912.1 / 14.0, 4.388, 8.384, 13.28, 0.355, 0.846)), 4)
    0.0449
    """
    with np.errstate(divide="ignore"):
        load = np.asarray(line_load) / (np.asarray(sum_velocity) * np.asarray(radius))
        thick = np.asarray(viscosity, dtype=float) ** -0.05
    return np.asarray(0.048 * load**0.2 * thick * np.asarray(roughness, dtype=float) ** 0.25 * lubricant_factor)


@checked
def xu_kahraman(
    pressure: ArrayLike,
    slide_to_roll: ArrayLike,
    entraining_velocity: ArrayLike,
    viscosity: ArrayLike,
    radius: ArrayLike,
    roughness: ArrayLike,
) -> Array:
    r"""Coefficient of friction after Xu and Kahraman, a regression of elastohydrodynamic computations.

    .. math:: \mu = e^f p^{1.03303} |SR|^{1.036077} v_e^{-0.100601} \eta^{0.752755} R^{-0.390958}, \\
        f = -8.916465 - 0.354068\, x + 2.812084\, e^{-x} + 0.620305\, e^{S},\qquad x = |SR|\, p \log_{10} \eta

    Parameters
    ----------
    pressure : array [MPa]
        Largest pressure of the line contact; p of the formula is in GPa.
    slide_to_roll : array
        SR, sliding over entraining velocity: 2 (v_1 - v_2)/(v_1 + v_2).
    entraining_velocity : array [m/s]
        v_e, half the sum of both rolling velocities.
    viscosity : array [mPa s]
        eta, dynamic, at the inlet.
    radius : array [mm]
        Of relative curvature; R of the formula is in m.
    roughness : array [um]
        S, root mean square of both flanks together.

    Returns
    -------
    array
        0 where nothing slides.

    References
    ----------
    Xu, Kahraman, Anderson & Maddock 2007, Prediction of mechanical efficiency of parallel-axis gear pairs,
    J. Mech. Des. 129; coefficients as two public programs have them. No printed result was found to compare with.

    Examples
    --------
    >>> float(xu_kahraman(1000.0, 0.0, 5.0, 30.0, 10.0, 0.5))
    0.0
    >>> round(float(xu_kahraman(1000.0, 0.2, 5.0, 10.0, 10.0, 0.3)), 4)
    0.0159
    """
    peak, sliding = 1e-3 * np.asarray(pressure), np.abs(np.asarray(slide_to_roll, dtype=float))
    thickness = np.asarray(viscosity, dtype=float)
    x = sliding * peak * np.log10(thickness)
    exponent = -8.916465 - 0.354068 * x + 2.812084 * np.exp(-x) + 0.620305 * np.exp(np.asarray(roughness))
    with np.errstate(divide="ignore"):
        speeds = np.asarray(entraining_velocity, dtype=float) ** -0.100601
        radii = (1e-3 * np.asarray(radius)) ** -0.390958
    return np.asarray(np.exp(exponent) * peak**1.03303 * sliding**1.036077 * speeds * thickness**0.752755 * radii)
