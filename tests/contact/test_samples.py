"""Samples at uneven places: jumps of slopes."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.contact.slope_jumps import slope_jump

ROUNDING = 1e-12  # of parabolas through heights up to 1e-3 mm over cells of 1e-3 mm
RADIUS = 0.05
JUMP = 0.02


@pytest.fixture(params=["even", "uneven"])
def places(request):
    """Places about zero; the uneven ones twice as wide from one end to the other."""
    t = np.linspace(-1.0, 1.0, 21)
    return 0.1 * (t + 0.1) if request.param == "even" else 0.1 * (t + 0.15 * t**2)


@pytest.mark.parametrize("line", [-0.007, 0.0, 0.0041])
def test_slope_that_jumps_is_told_from_any_place_of_the_line_in_a_cell(places, line):
    """A parabola over which a ramp is laid: the jump, exactly."""
    heights = places**2 / 20.0 + JUMP * np.maximum(places - line, 0.0)
    nearest = int(np.abs(places - line).argmin())
    for k in range(nearest - 1, nearest + 2):
        assert_allclose(slope_jump(places, heights, k), JUMP, rtol=1e-9)
    assert slope_jump(places, heights, nearest + 6) < 1e-9 * JUMP


def test_curvature_that_jumps_is_no_jump_of_the_slope(places):
    """Where an arc begins, and beside the end of the material."""
    heights = places**2 / 20.0 + np.maximum(places - 0.0033, 0.0) ** 2 / (2.0 * RADIUS)
    for k in range(places.size):
        assert slope_jump(places, heights, k) < ROUNDING
        assert slope_jump(places, np.where(places > 0.05, np.inf, heights), k) < ROUNDING
