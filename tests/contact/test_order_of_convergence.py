"""The pressure map approaches Hertz with the order of its cells, for a circle and for the ellipse of a gear contact."""

import numpy as np
import pytest

from loaded_tca import solve_contact
from loaded_tca.reference.hertz import point_contact

MODULUS, LOAD = 113187.0, 2712.6
SMALLEST_ORDER = 1.5
"""Cells of constant pressure leave an error of second order in the peak and the approach; where the edge of the contact
falls in its cell scatters about it by half an order."""
CURVATURES = {"circle": (0.1, 0.1), "gear ellipse, ratio 80": (0.0915, 6.4e-5)}


def errors(curvatures, cells):
    """Relative errors of peak and approach on a box of 1.5 times the contact."""
    hertz = point_contact(LOAD, curvatures, MODULUS)
    spacing = tuple(3.0 * axis / cells for axis in (hertz.semi_minor, hertz.semi_major))
    x, y = ((np.arange(cells) - 0.5 * (cells - 1)) * step for step in spacing)
    gap = 0.5 * (curvatures[0] * x[:, None] ** 2 + curvatures[1] * y**2)
    solution = solve_contact(gap, spacing, MODULUS, load=LOAD, tolerance=1e-9)
    return np.abs([solution.pressure.max() / hertz.max_pressure - 1.0, solution.approach / hertz.approach - 1.0])


@pytest.mark.parametrize("name", CURVATURES)
def test_peak_and_approach_converge_to_hertz_on_three_grids(name):
    coarse, middle, fine = (errors(CURVATURES[name], cells) for cells in (24, 72, 216))
    for first, second in ((coarse, middle), (middle, fine)):
        order = np.log(first / second) / np.log(3.0)
        assert (order > SMALLEST_ORDER).all(), order
