"""Slope of the transmission error of a crowned helical pair under axis errors, that of Tables 3 and 4.

z 40/37, m_n 1 mm, alpha_n 20 deg, beta 14 deg, b 20 mm, pinion right-hand with the lead parabola c1 (z - z0)^2, as in
the reduced-TCA dissertation. Lead crowning alone leaves a straight line: its slope, independent of c1, was computed
twice independently. The printed tables themselves are in ``reduced_tca_tables``.
"""

from math import radians

import numpy as np

from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.pairs.cylindrical import Mounting, cylindrical_pair
from loaded_tca.unloaded import trace_contact
from validation.table import Row

CASE = "reduced-TCA dissertation, helical 40/37"
ARCSEC = np.degrees(1.0) * 3600.0
FACE_WIDTH = 20.0
C1 = 0.0227
"""Lead parabola [1/mm], of the pinion; 2270 um at the ends of the face."""
SLOPES = {
    ("in_plane", 0.05): -15.965,
    ("in_plane", -0.05): 15.944,
    ("in_plane", 0.1): -31.951,
    ("in_plane", -0.1): 31.866,
    ("out_of_plane", 0.05): 42.459,
    ("out_of_plane", -0.05): -42.608,
    ("out_of_plane", 0.1): 84.768,
    ("out_of_plane", -0.1): -85.364,
}
"""Error [deg] -> slope [arcsec per rad of pinion]."""
DIGITS = 1e-4
"""Half a last digit is 3e-5; a tenth of the crowning moves the slope by as much."""


def rows() -> list[Row]:
    """Slopes to the digits computed, and at a tenth of the crowning, which does not matter."""
    found = []
    for (name, angle), expected in SLOPES.items():
        for c1 in (C1, 0.1 * C1):
            label = f"{name} {angle:+.2f} deg, c1 {c1:g}: TE slope [arcsec/rad]"
            found.append(Row(CASE, "computed twice", label, expected, slope(name, angle, c1), DIGITS))
    return found


def slope(name: str, angle_deg: float, c1: float) -> float:
    """Slope of the transmission error over 0.01 rad [arcsec/rad]."""
    crowning = FlankModifications(lead_crowning=c1 * (0.5 * FACE_WIDTH) ** 2)
    gears = [CylindricalGear(z, 1.0, FACE_WIDTH, helix_angle=s * radians(14.0)) for z, s in ((40, 1), (37, -1))]
    pair = cylindrical_pair(
        CylindricalMesh(*gears),
        modifications=(crowning, FlankModifications()),
        mounting=Mounting(**{name: radians(angle_deg)}),
    )
    error = trace_contact(pair, [0.0, 0.01]).transmission_error
    return float(error[1] - error[0]) * ARCSEC / 0.01
