"""Balance of planets: closed forms of linear stages, slack planets, floating and supported suns."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.errors import InputError
from loaded_tca.stages.balance import Deflections, balance, directions_of, pin_errors

STIFFNESS, TOTAL, ALPHA = 4e5, 3000.0, math.radians(22.0)  # N/mm, N
FORCE = np.array([0.0, 300.0, 1000.0, 3000.0, 6000.0])
CLOSED_FORM = 1e-9

counts = st.integers(3, 7)
errors_um = st.lists(st.floats(-0.8, 0.8), min_size=7, max_size=7)


def linear(planets):
    return np.outer(np.ones(planets), FORCE / STIFFNESS)


def even(planets):
    return 2.0 * math.pi * np.arange(planets) / planets


@given(counts, errors_um)
def test_fixed_sun_shares_by_the_errors_less_their_mean(planets, amounts):
    errors = 1e-3 * np.array(amounts[:planets])
    shares = balance(FORCE, linear(planets), directions_of(even(planets), ALPHA, True), errors, TOTAL, math.inf)
    assert_allclose(shares.force, TOTAL / planets + STIFFNESS * (errors.mean() - errors), rtol=CLOSED_FORM)
    assert_allclose(shares.rotation, TOTAL / planets / STIFFNESS + errors.mean(), rtol=CLOSED_FORM)
    assert not shares.motion.any()


@given(counts, errors_um)
def test_floating_sun_takes_what_it_can_off_the_errors(planets, amounts):
    """What is left are the errors less their projection on (1, cos psi, sin psi)."""
    errors, psi = 1e-3 * np.array(amounts[:planets]), even(planets)
    base = np.column_stack([np.ones(planets), np.cos(psi), np.sin(psi)])
    rest = errors - base @ np.linalg.lstsq(base, errors, rcond=None)[0]
    shares = balance(FORCE, linear(planets), directions_of(psi, ALPHA, True), errors, TOTAL, 0.0)
    assert_allclose(shares.force, TOTAL / planets - STIFFNESS * rest, rtol=CLOSED_FORM)
    assert_allclose((shares.force[:, None] * directions_of(psi, ALPHA, True)).sum(axis=0), 0.0, atol=1e-6)


def test_three_planets_and_a_floating_sun_always_share_evenly():
    errors = np.array([0.02, -0.01, 0.0])
    shares = balance(FORCE, linear(3), directions_of(even(3), ALPHA, True), errors, TOTAL, 0.0)
    assert_allclose(shares.force, TOTAL / 3.0, rtol=CLOSED_FORM)


def test_support_of_any_stiffness_lies_between_floating_and_rigid():
    errors, directions = np.array([2e-3, 0.0, 0.0]), directions_of(even(3), ALPHA, True)
    factors = [
        balance(FORCE, linear(3), directions, errors, TOTAL, stiffness).force.max()
        for stiffness in (0.0, 1e5, 1e6, 1e8, math.inf)
    ]
    assert (np.diff(factors) > 0.0).all()
    supported = balance(FORCE, linear(3), directions, errors, TOTAL, 1e5)
    assert_allclose(directions.T @ supported.force, -1e5 * supported.motion, rtol=1e-8)


@pytest.mark.parametrize("stiffness", [0.0, 1e5, math.inf])
def test_planet_whose_pin_is_far_off_carries_nothing(stiffness):
    errors = np.array([1.0, 0.0, 0.0, 0.0])
    shares = balance(FORCE, linear(4), directions_of(even(4), ALPHA, True), errors, TOTAL, stiffness)
    assert shares.force[0] == 0.0
    assert_allclose(shares.force.sum(), TOTAL, rtol=CLOSED_FORM)


@given(st.floats(-0.05, 0.05), st.floats(-0.05, 0.05), st.floats(0.0, 0.01), st.sampled_from([0.0, 2e5, math.inf]))
def test_every_state_balances(first, second, third, stiffness):
    """Curved deflections, slack planets among them: forces are not negative and add up."""
    curved = np.outer([1.0, 1.1, 0.9, 1.0], (FORCE / STIFFNESS) ** 0.9)
    errors, directions = np.array([first, second, third, 0.0]), directions_of(even(4), ALPHA, False)
    shares = balance(FORCE, curved, directions, errors, TOTAL, stiffness)
    assert (shares.force >= 0.0).all()
    assert_allclose(shares.force.sum(), TOTAL, rtol=1e-6)
    if math.isfinite(stiffness):
        assert_allclose(directions.T @ shares.force, -stiffness * shares.motion, atol=1e-5 * TOTAL)


def test_force_beyond_the_largest_is_as_stiff_as_there():
    shares = balance(FORCE[:3], linear(1)[:, :3], np.zeros((1, 2)), np.zeros(1), 5000.0, math.inf)
    assert_allclose(shares.rotation, 5000.0 / STIFFNESS, rtol=1e-9)


@pytest.mark.parametrize("sun_drives", [True, False])
def test_sun_that_moves_towards_a_planet_closes_that_mesh_whichever_flank_is_loaded(sun_drives):
    """The planet at the angle 0 lies along x: teeth there lean by the pressure angle to either side."""
    ((across, along),) = directions_of([0.0], ALPHA, sun_drives)
    assert_allclose(across, np.sin(ALPHA))
    assert_allclose(along, (1.0 if sun_drives else -1.0) * np.cos(ALPHA))


def test_radial_pin_error_does_nothing_where_both_pressure_angles_are_equal():
    nothing = pin_errors(np.zeros(3), np.ones(3), (ALPHA, ALPHA), True)
    assert_array_equal(nothing, 0.0)  # a sine less itself
    along = pin_errors(np.ones(3), np.zeros(3), (ALPHA, ALPHA), True)
    assert_allclose(along, 2.0 * math.cos(ALPHA))
    assert_allclose(pin_errors(np.ones(3), np.zeros(3), (ALPHA, ALPHA), False), -along)


def test_deflections_are_those_of_the_positions_and_repeat():
    table = Deflections(np.array([0.0, 1.0]), np.array([[0.0, 0.1, 0.2, 0.1], [1.0, 1.1, 1.3, 1.1]]), start=-0.5)
    found = table.at(np.array([-0.5, 0.0, 1.0, 0.25]))
    # a spline at its own points: equations of which the diagonal dominates
    assert_allclose(found, [[0.0, 0.2, 0.2, 0.1], [1.0, 1.3, 1.3, 1.1]], rtol=0, atol=1e-13)
    with pytest.raises(InputError, match="does not rise from 0"):
        Deflections(np.array([1.0, 2.0]), np.zeros((2, 3)))


def test_deflection_that_does_not_grow_is_refused():
    with pytest.raises(InputError, match="does not grow"):
        balance(FORCE, np.zeros((1, 5)), np.zeros((1, 2)), np.zeros(1), 1.0, math.inf)
