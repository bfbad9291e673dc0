"""Forces of pairs whose approaches are powers of their forces."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.errors import ConvergenceError
from loaded_tca.loaded.balance import EXPONENTS, PowerLaw, balance

ROUNDING = 1e-12
"""Of a torque: the forces are scaled to it; 4e-16 was seen. Of powers and logarithms: none."""
LAWS = st.builds(PowerLaw, st.floats(10.0, 1e4), st.floats(1e-4, 1e-2), st.floats(0.5, 1.0))


@given(LAWS, st.floats(1e-3, 1e5))
def test_force_at_an_approach_is_the_inverse_of_the_deformation_under_it(law, force):
    assert_allclose(law.force_at(law.deformation_under(force)), force, rtol=1e-9)


def test_law_through_a_second_press_has_its_exponent():
    law = PowerLaw(1000.0, 0.004).through(2000.0, 0.004 * 2.0**0.9)
    assert_allclose(law.exponent, 0.9, rtol=ROUNDING)
    assert_allclose(law.deformation_under(1000.0), 0.004, rtol=ROUNDING)


def test_law_keeps_its_exponent_where_the_loads_do_not_tell():
    assert PowerLaw(1000.0, 0.004, 0.8).through(1000.0, 0.0041) == PowerLaw(1000.0, 0.0041, 0.8)


@pytest.mark.parametrize(("approach", "expected"), [(0.0040001, EXPONENTS[0]), (1e6, EXPONENTS[1])])
def test_exponent_stays_in_its_range(approach, expected):
    assert PowerLaw(1000.0, 0.004).through(2000.0, approach).exponent == expected


def test_law_of_a_corner_hardly_deforms():
    """Cells with little material are in contact long before those that carry: the exponent is that of the two loads."""
    law = PowerLaw(1.30, 0.0012625).through(1.14, 0.0012495)
    assert_allclose(law.exponent, np.log(0.0012495 / 0.0012625) / np.log(1.14 / 1.30), rtol=ROUNDING)


def test_no_force_where_nothing_is_closed():
    assert PowerLaw(1000.0, 0.004).force_at(0.0) == PowerLaw(1000.0, 0.004).force_at(-1.0) == 0.0


@given(
    st.lists(st.tuples(LAWS, st.floats(0.0, 1e-4), st.floats(0.0, 1e-5)), min_size=1, max_size=4),
    st.floats(1.0, 1e6),
    st.floats(0.0, 1e-6),
)
def test_balance_fulfils_torque_and_compatibility(parts, torque, coupling):
    """Loaded pairs ask for one rotation, those apart for a larger one.

    The levers of both gears have one ratio, as on parallel axes: with any others there may be no balance.
    """
    laws, separations = [part[0] for part in parts], np.array([part[1] for part in parts])
    levers = np.outer([1.0, 1.7], np.linspace(40.0, 60.0, len(laws)))
    compliance = np.diag([part[2] for part in parts]) + coupling
    forces = balance(laws, separations, levers, torque, compliance)
    assert (forces >= 0.0).all()
    assert_allclose(levers[0] @ forces, torque, rtol=ROUNDING)
    approaches = np.array([law.deformation_under(force) for law, force in zip(laws, forces, strict=True)])
    asked = separations + (approaches + compliance @ forces) / levers[1]
    rotation = asked[forces > 0.0].mean()
    assert_allclose(asked[forces > 0.0], rotation, rtol=1e-6)
    assert (asked[forces == 0.0] >= rotation * (1.0 - 1e-6)).all()


def test_pair_that_stays_apart_carries_nothing():
    """Its force once fell to a tenth in every step and was never zero: the rotation of a step counts it as negative."""
    laws = [PowerLaw(11.13, 4.645e-4, 0.6995), PowerLaw(5102.9, 1.384e-4, 0.9556)]
    levers, compliance = np.outer([1.0, 1.7], [40.0, 60.0]), np.array([[0.0, 7.518e-7], [7.518e-7, 9.270e-7]])
    forces = balance(laws, np.array([7.31e-8, 4.35e-5]), levers, 31.92, compliance)
    assert forces[1] == 0.0
    assert_allclose(forces[0], 31.92 / 40.0, rtol=ROUNDING)


def test_stiff_neighbour_takes_the_load_of_a_soft_tooth():
    laws, levers = [PowerLaw(1000.0, 0.004)] * 2, np.full((2, 2), 50.0)
    forces = balance(laws, np.zeros(2), levers, 1e5, np.diag([0.0, 1.0]))
    assert_allclose(forces.sum(), 2000.0, rtol=ROUNDING)
    assert forces[1] < 0.01 * forces[0]


def test_pair_pushed_apart_by_its_neighbour_carries_nothing():
    laws, levers = [PowerLaw(1000.0, 0.004)] * 2, np.full((2, 2), 50.0)
    separation = 0.0035 / 50.0
    alone = balance(laws, np.array([0.0, separation]), levers, 5e4, np.zeros((2, 2)))
    coupled = balance(laws, np.array([0.0, separation]), levers, 5e4, np.full((2, 2), 2e-6) + 1e-12 * np.eye(2))
    assert alone[1] > 0.0
    assert_allclose(coupled.sum(), 1000.0, rtol=ROUNDING)
    assert_allclose(coupled, alone, rtol=1e-5)  # what both share moves both alike


def test_torque_that_no_rotation_gives_is_told():
    levers = np.array([[-50.0], [50.0]])
    with pytest.raises(ConvergenceError, match="no rotation gives a torque of 1000 N mm"):
        balance([PowerLaw(1000.0, 0.004)], np.zeros(1), levers, 1e3, np.zeros((1, 1)))
