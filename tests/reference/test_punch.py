"""Punches against the sphere, the cone, the flat end, and their own energy."""

import math
from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad

from loaded_tca.errors import InputError
from loaded_tca.reference import hertz, punch
from tests.refusals import refusals

EXACT = 1e-12  # closed forms on both sides: 2e-15 seen


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


ROUNDED = punch.RoundedPunch(0.1, 0.2, 0.11, 113187.0)


def test_pressure_under_rounded_ends_adds_up_to_the_load():
    flat, rounded = (quad(ROUNDED.pressure, *ends, epsrel=1e-10)[0] for ends in ((0.0, 0.1), (0.1, 0.11)))
    assert_allclose(2.0 * (flat + rounded), ROUNDED.line_load, rtol=1e-7)


def test_pressure_under_rounded_ends_closes_the_gap():
    """Displacement of the half-plane and gap are one constant in the contact, and open beyond it."""

    def level(x):
        def kernel(s):
            return -np.log(abs(x * x - s * s)) * ROUNDED.pressure(s)

        parts = sorted({0.0, 0.1, 0.11, min(x, 0.11)})
        displaced = sum(quad(kernel, *ends, epsabs=1e-6, limit=200)[0] for ends in pairwise(parts))
        return 2.0 / (math.pi * ROUNDED.contact_modulus) * displaced + float(ROUNDED.gap(x))

    inside = [level(x) for x in (0.0, 0.03, 0.08, 0.097, 0.103, 0.107)]
    assert np.ptp(inside) < 1e-6 * inside[0]
    assert level(0.12) > inside[0] + 1e-4


def test_rounded_punch_is_that_of_the_literature():
    assert_allclose(ROUNDED.line_load, 174.53, rtol=3e-5)
    assert_allclose(ROUNDED.peak(), (0.10302, 2185.0), rtol=5e-5)


def test_rounded_punch_without_a_flat_part_is_a_cylinder():
    line = punch.RoundedPunch(0.0, 10.0, 0.1, 115e3)
    same = hertz.line_contact(line.line_load, 0.1, 115e3)
    assert_allclose([same.half_width, same.max_pressure], [0.1, line.peak()[1]], rtol=1e-9)
    x = np.array([-0.12, -0.05, 0.02, 0.09])
    shape = np.sqrt(np.maximum(1.0 - (x / 0.1) ** 2, 0.0))
    assert_allclose(line.pressure(x), same.max_pressure * shape, atol=1e-9 * same.max_pressure)


test_rounded_punch_that_cannot_be_is_refused = refusals(
    lambda arguments: punch.RoundedPunch(*arguments),
    ((-0.1, 0.2, 0.11, 1e5), "^half_width: -0.1 mm is negative or not finite$"),
    ((0.1, 0.2, 0.1, 1e5), "^contact_half_width: 0.1 mm is not finite and above half_width$"),
    ((0.1, 0.2, math.inf, 1e5), "^contact_half_width: inf"),
    ((0.1, 0.0, 0.11, 1e5), "^radius: 0.0 is not positive and finite$"),
    ((0.1, 0.2, 0.11, math.nan), "^contact_modulus: nan is not positive and finite$"),
)
