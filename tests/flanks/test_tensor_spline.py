"""Tensor B-splines: exact on polynomials, of sixth order, smooth beyond their rectangle, least squares on any grid."""

import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.interpolate import BSpline, RectBivariateSpline

from loaded_tca.flanks.tensor_spline import POINTS_AT_ONCE, SplineDerivatives, fit

ROUNDING = 1e-12  # of values up to 10 from 36 products each, least squares before: 4e-15 seen
QUINTIC, CUBIC = (5, 5), (3, 3)


def lines(rows, columns, skew=0.0):
    """Grid over [0, 1] x [0, 2]; ``skew`` moves its points off the lines, in spacings."""
    u, v = np.meshgrid(np.linspace(0.0, 1.0, rows), np.linspace(0.0, 2.0, columns), indexing="ij")
    away_u, away_v = 4.0 * u * (1.0 - u) / rows, 2.0 * v * (2.0 - v) / columns
    return u + skew * away_u * np.sin(3.0 * v + 5.0 * u), v + skew * away_v * np.cos(2.0 * u + 3.0 * v)


def wave(u, v):
    """Value and derivatives of exp(u) sin(2 v + u)."""
    sine, cosine = np.exp(u) * np.sin(2.0 * v + u), np.exp(u) * np.cos(2.0 * v + u)
    return SplineDerivatives(sine, sine + cosine, 2.0 * cosine, 2.0 * cosine, 2.0 * (cosine - sine), -4.0 * sine)


@pytest.fixture
def places(rng):
    return rng.uniform(0.0, 1.0, 500), rng.uniform(0.0, 2.0, 500)


# Exactness


@given(st.lists(st.floats(-2.0, 2.0), min_size=36, max_size=36), st.floats(0.0, 0.5))
@settings(max_examples=30)
def test_spline_is_exact_on_polynomials_of_its_degree(coefficients, skew):
    table = np.array(coefficients).reshape(6, 6)
    u, v = lines(8, 10, skew)
    spline = fit(u, v, np.polynomial.polynomial.polyval2d(u, v, table), QUINTIC)
    at_u, at_v = lines(7, 7)
    found = spline(at_u, at_v)
    slope_u, slope_v = (np.polynomial.polynomial.polyder(table, axis=axis) for axis in (0, 1))
    expected = np.polynomial.polynomial.polyval2d(at_u, at_v, table)
    # sums of 36 terms of up to 2^5, second derivatives 1/spacing^2 larger
    assert_allclose(found.value, expected, rtol=0, atol=1e-10)
    expected = np.polynomial.polynomial.polyval2d(at_u, at_v, np.polynomial.polynomial.polyder(slope_u, axis=1))
    assert_allclose(found.u_v, expected, rtol=0, atol=1e-8)
    expected = np.polynomial.polynomial.polyval2d(at_u, at_v, np.polynomial.polynomial.polyder(slope_v, axis=1))
    assert_allclose(found.v_v, expected, rtol=0, atol=1e-8)


@pytest.mark.parametrize("degree", [3, 5])
def test_spline_and_derivatives_agree_with_fitpack(degree, places):
    u, v = lines(12, 15)
    values = wave(u, v).value
    other = RectBivariateSpline(u[:, 0], v[0], values, kx=degree, ky=degree)
    found = fit(u, v, values, (degree, degree))(*places)
    orders = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]
    for part, (dx, dy) in zip(found, orders, strict=True):
        assert_allclose(part, other.ev(*places, dx=dx, dy=dy), rtol=0, atol=1e-9)


@pytest.mark.parametrize("degree", [3, 5])
@pytest.mark.parametrize("skew", [0.0, 0.4])
def test_spline_error_falls_with_the_power_degree_plus_one_and_its_second_derivative_two_powers_slower(
    degree, skew, places
):
    errors = []
    for count in (9, 17, 33):
        u, v = lines(count, count, skew)
        found, exact = fit(u, v, wave(u, v).value, (degree, degree))(*places), wave(*places)
        errors.append([np.abs(a - b).max() for a, b in ((found.value, exact.value), (found.v_v, exact.v_v))])
    orders = np.log2(np.array(errors)[:-1] / np.array(errors)[1:])
    assert (orders > [degree + 0.5, degree - 1.6]).all()


@pytest.mark.parametrize("skew", [0.0, 0.3, 0.6])
def test_spline_passes_through_points_off_the_grid_lines(skew):
    u, v = lines(17, 15, skew)
    values = wave(u, v).value
    assert_allclose(fit(u, v, values, (5, 3))(u, v).value, values, rtol=0, atol=ROUNDING)


# Least squares


@pytest.mark.parametrize("skew", [0.0, 0.5])
def test_fewer_coefficients_give_the_least_squares_of_a_dense_solver(skew, rng):
    u, v = lines(17, 20, skew)
    values = wave(u, v).value + rng.normal(size=u.shape)
    spline = fit(u, v, values, QUINTIC, (9, 8))
    bases = [
        BSpline.design_matrix(at.ravel(), knots, 5).toarray() for at, knots in zip((u, v), spline.knots, strict=True)
    ]
    matrix = np.einsum("ni,nj->nij", *bases).reshape(u.size, -1)
    expected = np.linalg.lstsq(matrix, values.ravel(), rcond=None)[0]
    # rounding of both by the square of the condition number (Higham 2002, theorem 20.1), a twentieth of which was seen
    rounding = np.finfo(float).eps * np.linalg.cond(matrix) ** 2
    assert_allclose(spline.coefficients.ravel(), expected, rtol=0, atol=rounding * np.abs(expected).max())


def test_fewer_coefficients_smooth_noise(rng, places):
    u, v = lines(33, 33)
    values = wave(u, v).value + 1e-3 * rng.normal(size=u.shape)
    through, smooth = (fit(u, v, values, QUINTIC, counts)(*places).value for counts in (None, (9, 9)))
    exact = wave(*places).value
    # 81 coefficients for 1089 points leave a quarter of the noise
    assert np.std(smooth - exact) < 0.5 * np.std(through - exact)


# Beyond the rectangle


@pytest.mark.parametrize(
    ("u", "v", "out"), [(0.0, 0.7, (-1, 0)), (1.0, 0.7, (1, 0)), (0.4, 0.0, (0, -1)), (0.4, 2.0, (0, 1))]
)
def test_spline_goes_on_as_a_parabola_with_equal_curvature_at_its_edge(u, v, out):
    grid = lines(9, 9)
    spline = fit(*grid, wave(*grid).value, QUINTIC)
    distances = np.array([-1e-9, 1e-9, 0.25, 0.5, 0.75, 1.0])
    found = spline(u + out[0] * distances, v + out[1] * distances)
    for part in found:
        # third derivatives of 20 over 2e-9
        assert_allclose(part[1], part[0], rtol=0, atol=1e-6)
    second = found.u_u if out[0] else found.v_v
    assert_allclose(second[2:], second[1], rtol=ROUNDING)
    assert_allclose(np.diff(found.value[2:], 3), 0.0, atol=ROUNDING)


def test_domain_is_the_rectangle_of_the_points():
    grid = lines(9, 12, 0.3)
    assert fit(*grid, grid[0], QUINTIC).domain == ((0.0, 1.0), (0.0, 2.0))


# Evaluation


def test_shapes_broadcast_and_blocks_do_not_show(rng):
    grid = lines(9, 9)
    spline = fit(*grid, wave(*grid).value, QUINTIC)
    u, v = rng.uniform(0.0, 1.0, (POINTS_AT_ONCE // 5, 1)), rng.uniform(0.0, 2.0, (1, 11))
    found = spline(u, v)
    for row, column in ((0, 0), (POINTS_AT_ONCE // 11, 3), (-1, -1)):
        single = spline(u[row, 0], v[0, column])
        assert_allclose([part[row, column] for part in found], single, rtol=ROUNDING)
        assert single.value.shape == ()
    assert found.value.shape == (len(u), 11)
    assert spline(np.zeros(0), np.zeros(0)).value.shape == (0,)


def test_shifted_spline_is_higher_everywhere_by_the_amount(places):
    grid = lines(9, 9)
    spline = fit(*grid, wave(*grid).value, QUINTIC)
    before, after = spline(*places), spline.shifted(0.25)(*places)
    # sums of coefficients up to 10 are subtracted: 6e-14 of the amount seen
    assert_allclose(after.value - before.value, 0.25, rtol=ROUNDING)
    assert_allclose(after[1:], before[1:], rtol=0, atol=1e-10)  # second derivatives up to 40: 2e-14 seen


def test_values_that_are_all_zero_give_the_zero_spline():
    grid = lines(6, 6)
    assert not fit(*grid, np.zeros((6, 6)), QUINTIC).coefficients.any()


def test_spline_survives_pickling(places):
    grid = lines(9, 9)
    spline = fit(*grid, wave(*grid).value, CUBIC)
    # exact: the same numbers written and read, the same operations
    assert_allclose(pickle.loads(pickle.dumps(spline))(*places), spline(*places), rtol=0)


def test_chebyshev_lobatto_nodes_fit_a_function_that_is_steep_at_its_edge_better_than_even_ones(places):
    def steep(u, v):
        return np.sqrt(u + 0.02) * np.cos(v)

    errors = {}
    nodes = {"even": np.linspace(0.0, 1.0, 25), "lobatto": 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, 25))}
    for name, at in nodes.items():
        u, v = np.meshgrid(at, 2.0 * at, indexing="ij")
        errors[name] = np.abs(fit(u, v, steep(u, v), QUINTIC)(*places).value - steep(*places)).max()
    assert errors["lobatto"] < 0.1 * errors["even"]
