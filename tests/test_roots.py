"""Roots in many brackets at once."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.roots import find_roots


def test_roots_are_found_each_in_its_bracket_with_few_calls():
    calls = []

    def cubic(x, rows):
        calls.append(len(rows))
        return x**3 - np.array([1.0, 2.0, 27.0])[rows]

    ends = np.array([[0.0, 1.0, 2.5], [2.0, 2.0, 4.0]])
    values = np.stack([cubic(side, np.arange(3)) for side in ends])
    assert_allclose(find_roots(cubic, ends, values, 1e-12), [1.0, 2.0 ** (1 / 3), 3.0], atol=1e-11)  # ends at 1e-12
    assert len(calls) < 15


@pytest.mark.parametrize("function", [np.sign, lambda x: np.where(x > 0.0, 1e9, x), lambda x: x**9])
def test_roots_of_steps_and_flat_functions_are_bracketed(function):
    ends = np.array([[-1.0], [0.3]])
    assert abs(find_roots(lambda x, _: function(x), ends, function(ends), 1e-10)[0]) < 0.02
    if function is np.sign:
        assert abs(find_roots(lambda x, _: function(x), ends, function(ends), 1e-10)[0]) < 1e-9


def test_bracket_without_a_change_of_sign_gives_the_end_nearer_to_zero():
    ends = np.array([[1.0, 0.0], [3.0, 1.0]])
    assert find_roots(lambda x, _: x, ends, ends, 1e-9).tolist() == [1.0, 0.0]


def test_no_bracket_gives_no_root():
    assert find_roots(lambda x, _: x, np.zeros((2, 0)), np.zeros((2, 0)), 1e-9).shape == (0,)
