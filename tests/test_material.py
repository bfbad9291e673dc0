"""Elastic materials: the contact modulus in its limits, and what is refused."""

import math

from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.material import Material, contact_modulus
from tests.refusals import refusals

ROUNDING = 1e-14  # a few operations

materials = st.builds(Material, st.floats(1.0, 1e6), st.floats(0.0, 0.5))


def test_steel_on_steel_has_the_modulus_of_the_definition():
    assert_allclose(contact_modulus(Material(), Material()), 206000.0 / (2.0 * 0.91), rtol=ROUNDING)


@given(materials, materials)
def test_contact_modulus_does_not_know_which_body_is_first(first, second):
    assert_allclose(contact_modulus(first, second), contact_modulus(second, first), rtol=ROUNDING)


@given(materials)
def test_contact_modulus_of_equal_bodies_is_half_the_plane_strain_modulus(material):
    assert_allclose(contact_modulus(material, material), 0.5 * material.plane_strain_modulus, rtol=ROUNDING)


@given(materials)
def test_contact_modulus_against_a_rigid_body_is_the_plane_strain_modulus(material):
    assert_allclose(contact_modulus(material, Material(1e300, 0.0)), material.plane_strain_modulus, rtol=ROUNDING)


@given(materials, materials, st.floats(1e-3, 1e3))
def test_contact_modulus_scales_with_both_moduli(first, second, factor):
    scaled = [Material(factor * one.youngs_modulus, one.poisson_ratio) for one in (first, second)]
    # a few operations on scaled numbers
    assert_allclose(contact_modulus(*scaled), factor * contact_modulus(first, second), rtol=1e-12)


test_value_out_of_its_range_is_refused = refusals(
    lambda values: Material(**values),
    ({"youngs_modulus": 0.0}, "youngs_modulus: 0.0 MPa is not finite and at least 0.001 MPa"),
    ({"youngs_modulus": math.inf}, "youngs_modulus: inf MPa is not finite and at least 0.001 MPa"),
    ({"youngs_modulus": math.nan}, "youngs_modulus: nan MPa is not finite and at least 0.001 MPa"),
    ({"youngs_modulus": 1e-300}, "youngs_modulus: 1e-300 MPa is not finite and at least 0.001 MPa"),
    ({"youngs_modulus": "steel"}, "youngs_modulus: steel MPa is not finite and at least 0.001 MPa"),
    ({"poisson_ratio": None}, "poisson_ratio: None is not between 0 and 0.5"),
    ({"poisson_ratio": -0.1}, "poisson_ratio: -0.1 is not between 0 and 0.5"),
    ({"poisson_ratio": 0.51}, "poisson_ratio: 0.51 is not between 0 and 0.5"),
    ({"poisson_ratio": math.nan}, "poisson_ratio: nan is not between 0 and 0.5"),
    ({"max_pressure": 0.0}, "max_pressure: 0.0 MPa is not positive"),
    ({"max_pressure": "high"}, "max_pressure: high MPa is not positive"),
    ({"max_pressure": math.nan}, "max_pressure: nan MPa is not positive"),
    (
        {"youngs_modulus": -1.0, "poisson_ratio": 0.7, "max_pressure": -3.0},
        (
            "youngs_modulus: -1.0 MPa is not finite and at least 0.001 MPa",
            "poisson_ratio: 0.7 is not between 0 and 0.5",
            "max_pressure: -3.0 MPa is not positive",
        ),
    ),
    plain=True,
)
