"""The line along which the forces of slices act: smoothed centres of pressure."""

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.separation.sample import smoothed

ROUNDING = 1e-9  # slopes of lines through places of which one has nearly all the weight
SEEDS = st.integers(0, 2**32 - 1)


def places_and_forces(seed, count=40):
    """Uneven places over a length of about 1, forces over ten decades."""
    rng = np.random.default_rng(seed)
    return np.cumsum(rng.uniform(0.005, 0.05, count)), 10.0 ** rng.uniform(-8.0, 2.0, count)


@given(SEEDS, st.floats(1e-3, 10.0))
def test_straight_line_stays_as_it_is_up_to_its_ends(seed, deviation):
    places, forces = places_and_forces(seed)
    assert_allclose(smoothed(places, 3.0 - 2.0 * places, forces, deviation), 3.0 - 2.0 * places, atol=ROUNDING)


@given(SEEDS)
def test_line_turned_round_is_the_line(seed):
    places, forces = places_and_forces(seed)
    values = np.random.default_rng(seed).normal(size=places.size)
    there, back = smoothed(places, values, forces, 0.05), smoothed(-places[::-1], -values[::-1], forces[::-1], 0.05)
    assert_allclose(back[::-1], -there, atol=1e-6)  # slopes through places of little weight cancel


def test_slices_wider_than_the_stretch_keep_their_centres():
    places, values = np.arange(8.0), np.random.default_rng(1).normal(size=8)
    assert_allclose(smoothed(places, values, np.ones(8), 0.05), values, atol=ROUNDING)


def test_one_slice_has_its_centre():
    assert_allclose(smoothed(np.array([0.3]), np.array([0.7]), np.array([5.0]), 0.1), 0.7)


def test_kink_is_rounded_by_what_a_normal_distribution_says():
    """The mean of |y| under it: sqrt(2/pi) times its deviation, to the square of the steps."""
    places = np.linspace(-2.0, 2.0, 801)
    line = smoothed(places, np.abs(places), np.ones(801), 0.1)
    assert_allclose(line[400], 0.1 * math.sqrt(2.0 / math.pi), rtol=1e-3)
    assert_allclose(line[[0, 200, 600, -1]], [2.0, 1.0, 1.0, 2.0], atol=ROUNDING)
