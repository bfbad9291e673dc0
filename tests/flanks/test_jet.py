"""The algebra of values, gradients and Hessians, against polynomials differentiated by hand."""

import math
import pickle

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.flanks.base import Jet, weighted_sum

ROUNDING = 1e-12  # a handful of products of numbers of order 10

coordinates = st.floats(-3.0, 3.0)
PARTS = ("value", "rho", "z", "rho_rho", "rho_z", "z_z")


def cubic(r, z):
    """r^3 + 2 r z - z^2."""
    return Jet(r**3 + 2 * r * z - z**2, 3 * r**2 + 2 * z, 2 * r - 2 * z, (6 * r, 2.0, -2.0))


def saddle(r, z):
    """r z^2 - r."""
    return Jet(r * z**2 - r, z**2 - 1, 2 * r * z, (0.0, 2 * z, 2 * r))


def parts(jet):
    return [float(getattr(jet, name)) for name in PARTS]


@given(coordinates, coordinates)
def test_product_obeys_leibniz(r, z):
    """(r^3 + 2 r z - z^2)(r z^2 - r) = r^4 z^2 - r^4 + 2 r^2 z^3 - 2 r^2 z - r z^4 + r z^2."""
    expected = [
        r**4 * z**2 - r**4 + 2 * r**2 * z**3 - 2 * r**2 * z - r * z**4 + r * z**2,
        4 * r**3 * z**2 - 4 * r**3 + 4 * r * z**3 - 4 * r * z - z**4 + z**2,
        2 * r**4 * z + 6 * r**2 * z**2 - 2 * r**2 - 4 * r * z**3 + 2 * r * z,
        12 * r**2 * z**2 - 12 * r**2 + 4 * z**3 - 4 * z,
        8 * r**3 * z + 12 * r * z**2 - 4 * r - 4 * z**3 + 2 * z,
        2 * r**4 + 12 * r**2 * z - 12 * r * z**2 + 2 * r,
    ]
    assert_allclose(parts(cubic(r, z).times(saddle(r, z))), expected, atol=ROUNDING * 1e3)


@given(coordinates, coordinates)
def test_composition_with_the_square_is_the_product_with_itself(r, z):
    inner = cubic(r, z)
    squared = inner.compose(inner.value**2, 2.0 * inner.value, 2.0)
    assert_allclose(parts(squared), parts(inner.times(inner)), rtol=ROUNDING, atol=ROUNDING * 1e3)


@given(coordinates, coordinates)
def test_composition_with_the_exponential_turns_sums_into_products(r, z):
    def exponential(jet):
        return jet.compose(*[math.exp(0.1 * jet.value) * 0.1**k for k in range(3)])

    whole = exponential(cubic(r, z) + saddle(r, z))
    assert_allclose(
        parts(whole), parts(exponential(cubic(r, z)).times(exponential(saddle(r, z)))), rtol=1e-10, atol=1e-10
    )  # exponents and their second derivatives are added up: 1e-14 of parts up to 100 seen


def test_weighted_sum_weighs_each_row_by_its_own_numbers():
    r, z = np.array([1.0, 2.0]), np.array([0.5, -1.0])
    weights = np.array([[1.0, 2.0], [3.0, -1.0]])
    total = weighted_sum((cubic(r, z), saddle(r, z)), weights)
    for row in range(2):
        own = cubic(r[row], z[row]) * weights[row, 0] + saddle(r[row], z[row]) * weights[row, 1]
        found = [np.broadcast_to(getattr(total, name), 2)[row] for name in PARTS]
        assert_allclose(found, parts(own), rtol=ROUNDING)


def test_shift_and_scale_is_the_linear_map_of_the_value_and_scales_the_derivatives():
    jet = cubic(1.5, 0.5)
    assert_allclose(parts(jet.shifted_scaled(2.0, 4.0)), [(jet.value - 2.0) / 4.0, *[v / 4.0 for v in parts(jet)[1:]]])


@given(coordinates, coordinates)
def test_derivative_that_is_the_number_zero_counts_like_an_array_of_zeros_and_stays_one(r, z):
    along, across = (
        Jet(np.array(z**2), z=2.0 * z, bends=(0.0, 0.0, 2.0)),
        Jet(np.array(r**2), 2.0 * r, 0.0, (2.0, 0.0, 0.0)),
    )
    full = [
        Jet(jet.value, np.array(float(jet.rho)), np.array(float(jet.z)), tuple(np.array(part) for part in jet.bends))
        for jet in (along, across)
    ]

    def combined(first, second):
        whole = first.times(second) + first * 3.0 + second.shifted_scaled(1.0, 2.0)
        return whole + second.compose(np.exp(second.value), np.exp(second.value), np.exp(second.value))

    assert_allclose(parts(combined(along, across)), parts(combined(*full)), rtol=ROUNDING)
    untouched = along + along * 2.0 + along.compose(np.sin(along.value), np.cos(along.value), -np.sin(along.value))
    assert (untouched.rho, untouched.rho_rho, untouched.rho_z) == (0.0, 0.0, 0.0)
    assert all(type(part) is float for part in (untouched.rho, untouched.rho_rho, untouched.rho_z))


def test_second_derivatives_are_found_once_and_only_when_they_are_asked_for():
    asked = []

    def bends():
        asked.append("bends")
        return 6.0, 2.0, -2.0

    jet = Jet(1.0, 3.0, 1.0, bends)
    whole = (jet * 2.0 + jet).times(jet.compose(1.0, 2.0, lambda: asked.append("second") or 2.0))
    assert (whole.value, whole.rho, whole.z) == (3.0, 27.0, 9.0)
    assert not asked
    assert whole.rho_rho == 3.0 * (2.0 * 3.0**2 + 2.0 * 6.0) + 2.0 * 9.0 * 6.0 + 18.0  # f g'' + 2 f' g' + f'' g
    assert whole.z_z == 3.0 * (2.0 * 1.0**2 - 2.0 * 2.0) + 2.0 * 3.0 * 2.0 - 6.0
    assert sorted(asked) == ["bends", "second"]


def test_second_derivatives_are_pickled_whether_they_were_asked_for_or_not():
    asked = cubic(2.0, 3.0).times(saddle(2.0, 3.0)) * 2.0
    expected = parts(asked)
    for jet in (asked, cubic(2.0, 3.0).times(saddle(2.0, 3.0)) * 2.0):
        assert parts(pickle.loads(pickle.dumps(jet))) == expected
