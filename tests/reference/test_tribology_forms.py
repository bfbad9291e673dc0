"""Closed forms of friction, film, temperatures and scuffing: powers, limits, an independent integral, refusals."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.integrate import quad
from scipy.special import k0e

from loaded_tca.reference import iso6336_20, iso6336_21, iso6336_22
from loaded_tca.reference.friction import schlenk, xu_kahraman
from tests.refusals import refused_calls
from tests.samples.tribology import OIL

ROUNDING = 1e-12  # of powers and a few products
MODULUS, STEEL = 226374.0, 13784.0
HOT = (0.05, 1000.0, 20.0, MODULUS)


def moving_source(peclet):
    """Largest temperature of a Hertzian source that moves over a half-space, Jaeger's integral, over its limit.

    Scaled: half width 1, flux sqrt(1 - s^2), 2 Pe = velocity times half width over diffusivity.
    """

    def temperature(x):
        value, _ = quad(
            lambda s: (
                math.sqrt(max(0.0, 1.0 - s * s)) * math.exp(peclet * (x - s - abs(x - s))) * k0e(peclet * abs(x - s))
            ),
            -1.0,
            1.0,
            points=[x],
            limit=400,
        )
        return value

    return max(temperature(x) for x in np.linspace(0.3, 0.8, 26))


def test_flash_temperature_is_that_of_a_fast_source_of_heat():
    """Both gears alike: each takes half the heat. The standard's constant is 1.6 to 1.8 % above the exact maximum."""
    mu, pressure, radius = 0.05, 1000.0, 20.0
    conductivity, density, capacity = 50.0, 7850.0, 484.0
    diffusivity = conductivity / (density * capacity)
    velocity, sliding = 10.0, 2.0
    half_width = 4e-3 * radius * pressure / MODULUS  # b = 4 rho p/E_r [m]
    peclet = velocity * half_width / (2.0 * diffusivity)
    flux = 0.5 * mu * pressure * 1e6 * sliding  # into each gear, at the middle
    exact = flux * half_width / (math.pi * conductivity) * moving_source(peclet)
    coefficient = math.sqrt(conductivity * density * capacity)
    found = iso6336_22.flash_temperature(
        mu, pressure, radius, MODULUS, velocity, velocity, sliding, coefficient, coefficient
    )
    assert 1.012 < float(found) / exact < 1.022


def test_flash_temperature_without_sliding_or_rolling_is_zero_or_refuses_no_number():
    assert iso6336_22.flash_temperature(*HOT, 5.0, 5.0, 0.0, STEEL, STEEL) == 0.0
    assert iso6336_22.flash_temperature(*HOT, 0.0, 0.0, 0.0, STEEL, STEEL) == 0.0


@given(st.floats(0.5, 2.0))
def test_film_has_the_powers_of_its_formula(factor):
    film = iso6336_22.film_thickness(20.0, MODULUS, 1000.0, 10.0, OIL, 90.0, 90.0)
    faster = iso6336_22.film_thickness(20.0, MODULUS, 1000.0, 10.0 * factor, OIL, 90.0, 90.0)
    heavier = iso6336_22.film_thickness(20.0, MODULUS, 1000.0 * factor, 10.0, OIL, 90.0, 90.0)
    assert_allclose(faster / film, factor**0.7, rtol=ROUNDING)
    assert_allclose(heavier / film, factor**-0.26, rtol=ROUNDING)
    assert iso6336_22.film_thickness(20.0, MODULUS, 1000.0, 10.0, OIL, 90.0, 120.0) < film


@pytest.mark.parametrize(("ratio", "bearing"), [(1.5, 1.0), (2.0, 1.0), (3.5, 1.3), (4.5, 1.3)])
def test_mean_friction_has_the_helical_load_factor_of_the_standard(ratio, bearing):
    plain = iso6336_22.mean_friction(1000.0, 16.0, 50.0, 30.0, 0.6, 1.0)
    assert_allclose(iso6336_22.mean_friction(1000.0, 16.0, 50.0, 30.0, 0.6, ratio), plain * bearing**0.2, rtol=ROUNDING)


def test_bulk_temperature_without_loss_is_that_of_the_oil():
    assert iso6336_22.bulk_temperature(80.0, 0.0, 0.03, 0.1, 200.0, 30.0) == 80.0
    dip, spray = (
        iso6336_22.bulk_temperature(80.0, 100.0, 0.03, 0.1, 200.0, 30.0, factor) - 80.0 for factor in (1.0, 1.2)
    )
    assert_allclose(spray, 1.2 * dip, rtol=ROUNDING)


@given(st.floats(0.3, 0.99), st.floats(0.3, 0.99))
def test_loss_factor_is_that_of_gears_exchanged(recess, approach):
    both = [iso6336_22.load_loss_factor(*parts, 20, 40, 0.2) for parts in ((recess, approach), (approach, recess))]
    assert_allclose(*both, rtol=ROUNDING)


def test_loss_factor_of_pairs_of_two_is_the_other_case():
    assert_allclose(iso6336_22.load_loss_factor(1.1, 1.1, 20, 20), 0.5 * 2.2 * math.pi * 0.1, rtol=ROUNDING)


def test_friction_of_slices_falls_with_speed_and_vanishes_at_the_pitch_point():
    slow, fast = schlenk(300.0, np.array([1.0, 32.0]), 10.0, 30.0, 0.6)
    assert_allclose(slow / fast, 2.0, rtol=ROUNDING)
    assert xu_kahraman(1000.0, 0.0, 5.0, 30.0, 10.0, 0.5) == 0.0
    assert_allclose(xu_kahraman(1000.0, -0.2, 5.0, 30.0, 10.0, 0.5), xu_kahraman(1000.0, 0.2, 5.0, 30.0, 10.0, 0.5))


def test_scuffing_safety_of_a_cool_contact_has_no_limit():
    assert iso6336_20.scuffing_safety(400.0, 80.0, 80.0) == math.inf


@pytest.mark.parametrize("other", [0.1, 0.5, 0.9])
def test_contact_ratio_factor_passes_into_that_of_a_long_recess_or_approach(other):
    for just in ((1.0, other), (other, 1.0)):
        before = tuple(value - 1e-9 if value == 1.0 else value for value in just)
        # slopes of order one over 1e-9
        assert_allclose(iso6336_21.contact_ratio_factor(*just), iso6336_21.contact_ratio_factor(*before), rtol=1e-8)


test_refusals = refused_calls(
    (lambda: iso6336_20.scuffing_temperature(15, 30.0), "load_stage: 15; allowed a number from 1 to 14"),
    (lambda: iso6336_20.scuffing_temperature(12, 0.0), "viscosity: 0.0 is not positive"),
    (lambda: iso6336_21.scuffing_integral_temperature(0, 220.0), "load_stage: 0; allowed a whole number"),
    (lambda: iso6336_21.contact_ratio_factor(2.2, 0.5), "recess: 2.2; allowed a number above 0, below 2"),
    (lambda: iso6336_21.contact_ratio_factor(0.3, 0.5), r"recess \+ approach: 0.8; allowed 1 and more, below 2"),
    (lambda: iso6336_21.contact_ratio_factor(1.2, 1.1), r"recess \+ approach: 2.* allowed 1 and more, below 2"),
    (lambda: iso6336_21.integral_temperature(80.0, 10.0, 0.0), "supply_factor: 0.0 is not positive"),
    (lambda: iso6336_22.bulk_temperature(80.0, 1.0, 0.03, 0.1, 0.0, 30.0), "centre_distance: 0.0 is not positive"),
    (lambda: iso6336_22.load_loss_factor(0.8, 0.6, 0, 40), "teeth_1, teeth_2: 0, 40"),
    (lambda: iso6336_22.load_loss_factor(-0.8, 0.6, 20, 40), "allowed a sum above 0"),
)
