"""Love's coefficients against quadrature, their own far field, and scaling."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad

from loaded_tca.contact import love

QUADRATURE = 1e-9  # quad is asked for 1e-12, but nears a singular end
# what the module promises where the series takes over
SERIES = 1e-9


def under_cell(x, y, aspect):
    """Displacement by unit pressure on a cell around the origin: the inner integral of 1/r in closed form."""

    def strip(s):
        a, b = aspect / 2 - y, aspect / 2 + y
        return math.asinh(a / abs(x - s)) + math.asinh(b / abs(x - s))

    breaks = [x] if abs(x) < 0.5 else None
    value, _ = quad(strip, -0.5, 0.5, points=breaks, epsabs=1e-13, epsrel=1e-12)
    return value / math.pi


@pytest.mark.parametrize("aspect", [1.0, 0.02, 50.0])
def test_coefficients_agree_with_quadrature(aspect):
    coefficients = love.influence_coefficients((4, 3), aspect)
    for i, j in ((0, 0), (1, 0), (0, 1), (3, 2)):
        assert_allclose(coefficients[i, j], under_cell(i + 1e-12, j * aspect, aspect), rtol=QUADRATURE)


def test_coefficient_of_a_square_on_itself_is_the_closed_form():
    own = love.influence_coefficients((1, 1), 1.0)[0, 0]
    # one square: some dozen operations without cancellation
    assert_allclose(own, 4.0 * math.log(1.0 + math.sqrt(2.0)) / math.pi, rtol=1e-12)


@pytest.mark.parametrize(("shape", "aspect"), [((90, 90), 1.0), ((200, 70), 2.0), ((70, 200), 0.5)])
def test_series_meets_the_formula(shape, aspect):
    both = love.influence_coefficients(shape, aspect)
    assert_allclose(both, love._near_field(shape, aspect), rtol=SERIES)


def test_far_coefficient_tends_to_a_point_force():
    far = love.influence_coefficients((5000, 2), 1.0)[4999, 0]
    assert_allclose(far, 1.0 / (math.pi * 4999.0), rtol=1e-8)  # the next term is (1/r)^2/12


def test_coefficients_swap_with_the_axes():
    one = love.influence_coefficients((6, 9), 3.0)
    other = love.influence_coefficients((9, 6), 1.0 / 3.0)
    assert_allclose(one, 3.0 * other.T, rtol=1e-12)  # terms of corners that cancel: 3e-14 seen


def test_four_cells_act_as_the_one_they_make():
    """Uniform pressure on 2 x 2 cells displaces as on one cell of twice the size."""
    fine = love.influence_coefficients((12, 12), 1.3)
    coarse = love.influence_coefficients((5, 5), 1.3)
    # centre of the coarse cell (2, 3) seen from the four fine ones is a corner of fine cells: use averages of K
    i = np.arange(4)
    corner = np.array([[under_cell(a + 0.5, (b + 0.5) * 1.3, 1.3) for b in i] for a in i])
    assert_allclose(4 * corner[0, 0], 2 * coarse[0, 0], rtol=QUADRATURE)
    assert (np.diff(fine[:, 0]) < 0.0).all()


def test_series_of_wide_columns_meets_the_formula():
    """Rows of 1 mm by a column of 3 mm: what is left out is of the order of (3/14)^4/100, 2e-5."""
    borders, places = np.array([0.0, 3.0]), np.array([1.5, 11.5])
    formula, series = (love.column_coefficients(40, 1.0, borders, places, far) for far in (love.FAR_FIELD, 4.0))
    assert_allclose(series, formula, rtol=1e-4)
    assert (series[14:] != formula[14:]).any()
