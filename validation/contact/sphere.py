"""Two spheres of radius 20 mm under 100 N: the closed form and the pressure map against Hertz.

p0 = 1353.415 MPa and a = 0.187826 mm were computed independently from Johnson 1985, eqs. 4.22 to 4.24; so were
p0 = 1076.334 MPa and a = 0.210619 mm of steel on bronze (110 GPa, 0.34), whose E* is 80273.08 MPa by eq. 4.10.
"""

import numpy as np

from loaded_tca import solve_contact
from loaded_tca.material import Material, contact_modulus
from loaded_tca.reference.hertz import point_contact
from validation.table import Row

CASE, SOURCE = "spheres R 20/20, 100 N", "Hertz; Johnson 1985"
APPROACH = "Johnson 1985, eq. 4.23: a^2/R"
LOAD, CURVATURE = 100.0, 2.0 / 20.0
CELLS, MAP = 64, 2e-4


BRONZE = Material(110e3, 0.34)


def rows() -> list[Row]:
    """Steel on steel, then steel on bronze."""
    return [*_steel_on_steel(), *_steel_on_bronze()]


def _steel_on_bronze() -> list[Row]:
    """Closed form to the printed digits, by the modulus of two different bodies."""
    case = f"{CASE}, steel on bronze"
    modulus = contact_modulus(Material(), BRONZE)
    hertz = point_contact(LOAD, (CURVATURE, CURVATURE), modulus)
    return [
        Row(case, SOURCE, "E* [MPa]", 80273.08, modulus, 7e-8),
        Row(case, SOURCE, "closed form p0 [MPa]", 1076.334, hertz.max_pressure, 5e-7),
        Row(case, SOURCE, "closed form a [mm]", 0.210619, hertz.semi_major, 3e-6),
    ]


def _steel_on_steel() -> list[Row]:
    """Closed form to the printed digits; the map on 64 x 64 cells within three times its error (6e-5)."""
    modulus = contact_modulus(Material(), Material())
    hertz = point_contact(LOAD, (CURVATURE, CURVATURE), modulus)
    step = 2.5 * hertz.semi_major / CELLS
    x = (np.arange(CELLS) - 0.5 * (CELLS - 1)) * step
    gap = 0.5 * CURVATURE * (x[:, None] ** 2 + x[None, :] ** 2)
    solution = solve_contact(gap, (step, step), modulus, load=LOAD)
    return [
        Row(CASE, SOURCE, "closed form p0 [MPa]", 1353.415, hertz.max_pressure, 4e-7),
        Row(CASE, SOURCE, "closed form a [mm]", 0.187826, hertz.semi_major, 3e-6),
        Row(CASE, SOURCE, "map p0 [MPa]", 1353.415, solution.peak_pressure, MAP),
        Row(CASE, APPROACH, "map approach [mm]", 0.187826**2 * CURVATURE, solution.approach, MAP),
    ]
