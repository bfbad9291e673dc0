"""Material and penalty of all decks."""

import math

YOUNGS_MODULUS = 206000.0
"""E [MPa]."""
POISSON_RATIO = 0.3
PENALTY = 1e8
"""Pressure per overlap of the contact [MPa/mm]: 1000 MPa overlap by 0.01 um."""
CONTACT_MODULUS = 0.5 * YOUNGS_MODULUS / (1.0 - POISSON_RATIO**2)
"""E* of steel on steel [MPa]."""


def half_width(line_load: float, radius: float) -> float:
    """Hertz half width of a line contact, a = sqrt(4 F' rho/(pi E*)) [mm].

    Parameters
    ----------
    line_load : float [N/mm]
    radius : float [mm]
        Of relative curvature.
    """
    return math.sqrt(4.0 * line_load * radius / (math.pi * CONTACT_MODULUS))
