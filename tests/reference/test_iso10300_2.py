"""Pitting of bevel pairs: printed samples, the limit of a cylindrical pair, monotony."""

import math
from dataclasses import replace

import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.errors import GeometryError
from loaded_tca.reference import iso6336, iso10300_2
from loaded_tca.reference.iso6336_2 import FlankStrength, flank_factors
from loaded_tca.reference.iso10300_1 import VirtualPair
from tests.refusals import refused_calls
from validation.rating.iso_tr_10300_30 import BEVEL, FOUR_DIGITS, HYPOID, SAMPLES, SHORT, obtained

ROUNDING = 1e-12  # of a few products and roots
PARTS = ("l_bm", "rho_rel", "F_n", "Z_M-B", "Z_LS", "Z_L", "Z_v", "Z_R", "Z_Hyp", "sigma_H0", "sigma_HG")


@pytest.mark.parametrize("name", SAMPLES)
def test_samples_have_their_printed_numbers(name):
    values, printed = obtained(SAMPLES[name]), SAMPLES[name].printed
    for part in PARTS:
        if part in printed:
            assert_allclose(values[part], printed[part], rtol=FOUR_DIGITS, err_msg=part)


def straight(teeth=(20, 45)):
    """A straight bevel pair of module 3, whole face effective, with the virtual pair of spur gears."""
    cone = math.atan2(*teeth)
    radius = 1.5 * teeth[0] / math.sin(cone)
    none, cones = (0.0, 0.0), (cone, 0.5 * math.pi - cone)
    return VirtualPair(cones, (radius, radius), none, none, math.radians(20.0), 0.0, 3.0, (3.0, 3.0), 25.0, 1.0)


def test_straight_pairs_have_the_pressure_of_their_virtual_spur_pair():
    pair, alpha, modulus, force = straight(), math.radians(20.0), 1.15e5, 5000.0
    elastic = iso6336.elasticity_factor(modulus)
    product = iso10300_2.mid_zone_factor(pair) * iso10300_2.load_sharing_factor(pair) * elastic
    stress = iso10300_2.nominal_contact_stress(force, pair, product)
    first, second = (0.5 * base for base in pair.base_diameters)
    whole = (first + second) * math.tan(alpha)
    # The inner point of single contact of the pinion, a base pitch below its tip, where one pair carries all.
    one = math.sqrt((0.5 * pair.tip_diameters[0]) ** 2 - first**2) - pair.base_pitch
    radius = one * (whole - one) / whole
    assert_allclose(stress, elastic * math.sqrt(force / (25.0 * radius)), rtol=1e-12)  # of a few products


def test_more_profile_crowning_leaves_more_to_the_middle_line():
    for sample in SAMPLES.values():
        low, high = (iso10300_2.load_sharing_factor(sample.pair, each) for each in ("low", "high"))
        assert low < high <= 1.0


def test_sliding_along_the_teeth_lowers_the_strength_within_bounds():
    assert iso10300_2.hypoid_factor((0.6, 0.6), 0.2, 0.3) == (1.0, False)
    factors = [iso10300_2.hypoid_factor((first, 0.3), 0.2, 0.3) for first in (0.35, 0.6, 0.9, 1.5)]
    assert factors[0] == (1.0, False)  # the first 0.15 of the sliding cost nothing
    assert factors[1][0] > factors[2][0] > 0.6
    assert factors[3] == (0.6, True)


def test_strength_is_that_of_cylindrical_flanks_times_both_factors():
    gear = FlankStrength(1500.0, "Eh", 4.8)
    conditions = {"relative_radius": 12.0, "velocity": 5.0, "viscosity_40": 220.0, "gear_ratio": 2.0}
    conditions["cycles"] = [1e4, 1e9]
    plain = flank_factors(gear, gear, **conditions)
    bevel = iso10300_2.bevel_flank_factors(gear, gear, hypoid_factor=0.9, **conditions)
    assert_allclose(bevel.strength, 1.2 * 0.9 * plain.strength, rtol=ROUNDING)
    assert_array_equal(bevel.curves[0].life(1.2 * 0.9 * 1600.0), bevel.curves[1].life(1.2 * 0.9 * 1600.0))
    assert_allclose(bevel.curves[0].life(1.2 * 0.9 * 1600.0), plain.curves[0].life(1600.0), rtol=1e-9)  # p of 33


test_pitting_refuses = refused_calls(
    (
        lambda: iso10300_2.load_sharing_factor(BEVEL.pair, "some"),
        "profile_crowning: 'some' is not one of low, high",
    ),
    (lambda: iso10300_2.hypoid_factor((0.6, 0.3), 0.2, 0.9), "pressure_angle: 0.9 rad is not between 0 and 45 deg"),
    (
        lambda: iso10300_2.nominal_contact_stress(-1.0, SHORT.pair, 0.0),
        ("normal_force: -1.0 is not positive and finite", "factors: 0.0 is not positive and finite"),
    ),
    (
        lambda: iso10300_2.mid_zone_factor(replace(HYPOID.pair, mean_addenda=(0.01, 40.0))),
        "Z_M-B: the decisive point of contact lies beyond the base circle",
        GeometryError,
    ),
)
