"""Balance of two halves: springs by their closed form, equilibrium in all cases, limits, slopes and refusals."""

import itertools

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.double_helical.balance import HalfLaw, Halves, shared
from tests.refusals import refusals

RATE = 0.4
CLOSE = 1e-9  # of the balance, over the whole force: searched to 1e-14, times what one force is of the other


def power_law(scale, nodes=(300.0, 700.0, 1000.0, 1400.0)):
    """A half that gives way by scale F^0.9 at one position, with its slopes."""
    force = np.array(nodes)[:, None]
    return HalfLaw(np.array(nodes), scale * force**0.9, 0.9 * scale * force**-0.1, np.zeros(1))


def spring(stiffness):
    """A half of a stiffness [N/mm]."""
    return HalfLaw(np.array([1000.0]), np.array([[1000.0 / stiffness]]), np.array([[1.0 / stiffness]]), np.zeros(1))


@pytest.mark.parametrize("stiffness", [0.0, 3e3, 1e9, np.inf])
def test_halves_are_in_balance_on_any_support(stiffness):
    halves = Halves((power_law(2e-5), power_law(3e-5)), (0.002, -0.001), RATE, stiffness)
    state = shared(halves, np.array([2000.0]))
    first, second = state.force[0, 0]
    ways = [
        law.at(np.array([force]), np.array([0]))[0][0] + apart + sign * RATE * state.motion[0, 0]
        for law, force, apart, sign in zip(halves.laws, (first, second), halves.parted, (1.0, -1.0), strict=True)
    ]
    assert_allclose(first + second, 2000.0, rtol=CLOSE)
    assert_allclose(ways[0], ways[1], rtol=CLOSE)
    assert_allclose(state.approach[0, 0], ways[0], rtol=CLOSE)
    if np.isfinite(stiffness):
        assert_allclose(RATE * (first - second), stiffness * state.motion[0, 0], atol=CLOSE * 2000.0)
    else:
        assert state.motion[0, 0] == 0.0


def test_springs_share_by_their_stiffness_and_where_they_stand():
    state = shared(Halves((spring(4e5), spring(1e5)), (1e-3, 0.0), RATE, np.inf), np.array([1000.0]))
    # two springs in parallel: F_a = k_a (F + k_b (e_b - e_a))/(k_a + k_b)
    assert_allclose(state.force[0, 0, 0], 4e5 * (1000.0 - 1e5 * 1e-3) / 5e5, rtol=CLOSE)
    assert_allclose(state.compliance, 1.0 / 5e5, rtol=CLOSE)


@pytest.mark.parametrize("stiffness", [3e3, np.inf])
def test_springs_on_one_shaft_are_the_solution_of_their_matrix(stiffness):
    coupling = np.array([1e-6, 2e-6])
    springs = [
        HalfLaw(one.force, np.repeat(one.deflection, 2, 1), np.repeat(one.compliance, 2, 1), np.zeros(2))
        for one in (spring(4e5), spring(1e5))
    ]
    parted = np.array([1e-3, 2e-3]), np.array([0.0, 1e-3])
    state = shared(Halves((springs[0], springs[1]), parted, RATE, stiffness, coupling), np.array([1000.0]))
    for n, c in enumerate(coupling):
        # x = c_a F_a + c F_b + e_a + rate r, K r = rate (F_a - F_b), F_a + F_b = F: unknowns F_a, F_b, x
        soft = RATE**2 / stiffness
        matrix = [[1 / 4e5 + soft, c - soft, -1.0], [c - soft, 1 / 1e5 + soft, -1.0], [1.0, 1.0, 0.0]]
        first, second, way = np.linalg.solve(matrix, [-parted[0][n], -parted[1][n], 1000.0])
        assert_allclose(state.force[0, n], [first, second], rtol=CLOSE)
        assert_allclose(state.approach[0, n], way, rtol=CLOSE)


@pytest.mark.parametrize("coupling", [0.0, 1e-6])
@pytest.mark.parametrize("stiffness", [0.0, 3e3, np.inf])
def test_compliance_is_the_slope_of_the_approach(stiffness, coupling):
    halves = Halves((power_law(2e-5), power_law(3e-5)), (0.002, -0.001), RATE, stiffness, coupling)
    total = np.array([1999.0, 2000.0, 2001.0])
    state = shared(halves, total)
    slope = (state.approach[2] - state.approach[0]) / 2.0
    assert_allclose(state.compliance[1], slope, rtol=1e-6)  # a difference over 1e-3 of the force: its square


def test_a_half_that_is_not_reached_carries_nothing():
    state = shared(Halves((spring(1e5), spring(1e5)), (0.02, 0.0), RATE, np.inf), np.array([1000.0]))
    assert state.force[0, 0].tolist() == [0.0, 1000.0]
    assert_allclose([state.approach[0, 0], state.compliance[0, 0]], [1000.0 / 1e5, 1e-5], rtol=CLOSE)


def test_deflections_between_forces_have_the_fourth_order_and_their_error_is_told():
    whole = np.array([850.0])
    off = [power_law(2e-5, (850.0 - h, 850.0 + h)).at(whole, np.array([0])) for h in (400.0, 200.0, 100.0)]
    errors = [abs(deflection[0] - 2e-5 * 850.0**0.9) for deflection, _, _ in off]
    assert all(first / second > 14.0 for first, second in itertools.pairwise(errors))  # 16 in the limit
    assert all(error <= estimate[0] for error, (_, _, estimate) in zip(errors, off, strict=True))


@pytest.mark.parametrize("stiffness", [0.0, 3e3, np.inf])
def test_error_of_the_approach_between_forces_is_told(stiffness):
    def balanced(nodes):
        halves = Halves((power_law(2e-5, nodes), power_law(3e-5, nodes)), (0.002, -0.001), RATE, stiffness)
        return shared(halves, np.array([2000.0]))

    exact, coarse = balanced(tuple(np.linspace(300.0, 1700.0, 57))), balanced((300.0, 1700.0))
    off = abs(coarse.approach - exact.approach) / (exact.compliance * 2000.0)
    assert 1e-6 < off < coarse.approach_error < 20.0 * off  # of laws that bend the same way, and less than both do


def test_approach_of_a_half_that_carries_all_is_as_uncertain_as_its_deflection():
    nodes, force = (300.0, 1700.0), np.array([1000.0])
    law = power_law(2e-5, nodes)
    state = shared(Halves((law, power_law(2e-5, nodes)), (0.0, 1.0), RATE, np.inf), force)
    _, slope, error = law.at(force, np.array([0]))
    assert state.force[0, 0].tolist() == [1000.0, 0.0]
    assert_allclose(state.approach_error[0], error / (slope * force), rtol=CLOSE)


test_refused = refusals(
    lambda force, deflection, compliance: HalfLaw(
        np.array(force), np.array(deflection)[:, None], np.array(compliance)[:, None], np.zeros(1)
    ),
    ([1.0, 1.0], [1.0, 2.0], [1.0, 1.0], "force: .* does not rise from above 0"),
    ([0.0, 1.0], [1.0, 2.0], [1.0, 1.0], "force: .* does not rise from above 0"),
    ([1.0, 2.0], [1.0, 2.0], [1.0, -1.0], "deflection: it does not grow with the force"),
    ([1.0, 2.0], [-1.0, 2.0], [1.0, 1.0], "deflection: it does not grow with the force"),
)
test_refused_halves = refusals(
    lambda rate, stiffness: Halves((spring(1.0), spring(1.0)), (0.0, 0.0), rate, stiffness),
    (0.0, 0.0, "axial_rate: found 0; allowed other values than 0 if nothing holds the floating"),
    (0.4, -1.0, "stiffness: found -1 N/mm; allowed from 0 on"),
)
