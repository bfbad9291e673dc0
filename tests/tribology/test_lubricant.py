import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.scene.sections import BASES as OF_SCENES
from loaded_tca.tribology import Lubricant
from loaded_tca.tribology.conditions import BASES
from tests.refusals import refused_calls
from tests.samples.tribology import OIL


def oil(**changes):
    usual = {"viscosity_40": 220.0, "viscosity_100": 19.0, "density_15": 890.0, "oil_temperature": 80.0}
    return Lubricant(**{**usual, **changes})


@given(st.floats(2.0, 2000.0), st.floats(0.1, 0.9))
def test_viscosity_passes_through_both_given_points_and_falls_with_heat(cold, part):
    one = oil(viscosity_40=cold, viscosity_100=1.0 + (cold - 1.0) * part)
    assert_allclose(one.kinematic_viscosity([40.0, 100.0]), [one.viscosity_40, one.viscosity_100], rtol=1e-9)
    assert (np.diff(one.viscosity(np.linspace(-20.0, 200.0, 23))) < 0.0).all()


def test_numbers_are_those_printed_for_the_oil_of_the_published_stage():
    assert_allclose(OIL.viscosity(80.0), 30.09, atol=0.005)
    assert_allclose(OIL.viscosity(85.03), 25.24, atol=0.005)
    assert_allclose(OIL.pressure_viscosity(38.0), 0.02162, atol=5e-6)


def test_given_coefficients_stand_in_the_place_of_those_of_the_base():
    given_ones = oil(pressure_viscosity_38=0.02, lubricant_factor=0.9)
    assert_allclose(given_ones.pressure_viscosity(38.0), 0.02)
    assert given_ones.friction_factor == 0.9
    assert oil(base="polyalphaolefin").friction_factor == 0.8


def test_pressure_viscosity_stays_positive_in_the_hottest_contacts():
    assert (oil().pressure_viscosity(np.linspace(38.0, 3000.0, 99)) > 0.0).all()


def test_scenes_know_the_same_bases():
    assert set(OF_SCENES) == set(BASES)


@pytest.mark.parametrize("base", sorted(BASES))
def test_every_base_has_a_coefficient_near_those_of_oils(base):
    assert 0.008 < oil(base=base).pressure_viscosity(38.0) < 0.03  # mm2/N


test_bad_oils_are_refused = refused_calls(
    (lambda: oil(viscosity_100=220.0), "viscosity_100: 220.0 mm2/s; allowed above 1, below viscosity_40"),
    (lambda: oil(viscosity_40=2e5), "viscosity_40: 200000.0 mm2/s"),
    (lambda: oil(viscosity_100=1.0), "viscosity_100: 1.0"),
    (lambda: oil(density_15=1500.0), "density_15: 1500.0 kg/m3; allowed a number from 600 to 1400"),
    (lambda: oil(oil_temperature=250.0), "oil_temperature: 250.0 C; allowed a number from -50 to 200"),
    (lambda: oil(oil_temperature=float("nan")), "oil_temperature: nan"),
    (lambda: oil(base="water"), "base: 'water'; allowed 'mineral' or "),
    (lambda: oil(pressure_viscosity_38=0.0), "pressure_viscosity_38: 0.0"),
    (lambda: oil(lubricant_factor=5.0), "lubricant_factor: 5.0"),
)
