"""Aligned, unmodified involute pairs are conjugate: their transmission error is zero over the whole pitch."""

from collections.abc import Iterable
from itertools import product
from math import radians

import numpy as np

from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.pairs.cylindrical import cylindrical_pair
from loaded_tca.pairs.gear_pair import Driving
from loaded_tca.unloaded import trace_contact
from validation.table import Row

CASE, SOURCE = "conjugate involutes", "ISO 21771"
ROUNDING = 2e-15
"""Of sums of angles of order 1 [rad], ten units of their last place; 1e-16 is seen."""
HELIX_ANGLES = (0.0, 15.0, 30.0)
PROFILE_SHIFTS = ((0.0, 0.0), (0.3, -0.2), (0.4, 0.3))
DRIVERS: tuple[Driving, ...] = ("pinion", "wheel")

Pair = tuple[float, tuple[float, float], Driving]
"""Helix angle [deg], profile shifts, driving gear."""
ALL: tuple[Pair, ...] = tuple((*pair, DRIVERS[n % 2]) for n, pair in enumerate(product(HELIX_ANGLES, PROFILE_SHIFTS)))
FEW: tuple[Pair, ...] = ((0.0, (0.4, 0.3), "wheel"), (15.0, (0.3, -0.2), "pinion"), (30.0, (0.3, -0.2), "wheel"))


def rows(pairs: Iterable[Pair] = ALL) -> list[Row]:
    """Largest absolute transmission error of pairs [rad], of all by default; either gear drives in turn."""
    return [
        Row(CASE, SOURCE, f"max |TE|, beta {beta:g} deg, x {shifts}, {driving} drives [rad]", 0.0, error, ROUNDING)
        for beta, shifts, driving in pairs
        for error in [_largest_error(beta, shifts, driving)]
    ]


def short_rows() -> list[Row]:
    """Rows of a pair of each helix angle, with either gear driving."""
    return rows(FEW)


def _largest_error(beta: float, shifts: tuple[float, float], driving: Driving) -> float:
    gears = [
        CylindricalGear(teeth, 3.0, 25.0, helix_angle=hand * radians(beta), profile_shift=shift)
        for teeth, hand, shift in zip((23, 61), (1, -1), shifts, strict=True)
    ]
    path = trace_contact(cylindrical_pair(CylindricalMesh(*gears), driving=driving))
    return float(np.abs(path.transmission_error).max())
