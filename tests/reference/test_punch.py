"""Punches against the sphere, the cone, the flat end, and their own energy."""

import math

import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.reference import hertz, punch

EXACT = 1e-12


def test_square_profile_is_the_sphere():
    sphere = hertz.point_contact(50.0, (0.1, 0.1), 115e3)
    contact = punch.power_law(sphere.semi_major, 0.05, 2.0, 115e3)
    assert_allclose([contact.load, contact.approach], [50.0, sphere.approach], rtol=EXACT)


def test_eighth_power_is_the_closed_form():
    contact = punch.power_law(1.0, 1e-3, 8.0, 115e3)
    approach = 1e-3 * math.sqrt(math.pi) * math.gamma(5.0) / math.gamma(4.5)
    assert_allclose(contact.approach, approach, rtol=EXACT)
    assert_allclose(contact.load, 16.0 / 9.0 * 115e3 * approach, rtol=EXACT)


def test_large_exponent_tends_to_the_flat_end():
    contact = punch.power_law(0.7, 1e-3, 1e7, 115e3) if 0.7**1e7 > 0.0 else punch.power_law(1.0, 1e-3, 1e7, 115e3)
    flat = punch.flat_circular(contact.load, contact.radius, 115e3)
    assert_allclose(contact.approach, flat.approach, rtol=2e-7)  # n/(n + 1)


@pytest.mark.parametrize("exponent", [1.0, 2.0, 3.5])
def test_load_is_the_derivative_of_the_energy(exponent):
    """F d(delta) is the work: stiffness 2 a E* for every profile."""
    step = 1e-5
    low, high = (punch.power_law(0.5 * (1 + s), 0.01, exponent, 115e3) for s in (-step, step))
    stiffness = (high.load - low.load) / (high.approach - low.approach)
    assert_allclose(stiffness, 2.0 * 0.5 * 115e3, rtol=1e-8)  # central difference: step squared, and rounding


@pytest.mark.parametrize(
    "bad", [{"radius": 0.0}, {"coefficient": -1.0}, {"exponent": math.nan}, {"contact_modulus": 0.0}]
)
def test_power_law_refuses(bad):
    good = {"radius": 1.0, "coefficient": 1.0, "exponent": 2.0, "contact_modulus": 1.0}
    with pytest.raises(InputError, match=next(iter(bad))):
        punch.power_law(**(good | bad))


def test_flat_end_refuses():
    with pytest.raises(InputError, match="load"):
        punch.flat_circular(-1.0, 1.0, 1.0)
