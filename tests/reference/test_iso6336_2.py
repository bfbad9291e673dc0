"""Strength of flanks: printed examples of two sources, limits of the factors."""

from dataclasses import replace
from math import cos, radians

import numpy as np
from numpy.testing import assert_allclose

from loaded_tca.reference.iso6336_2 import (
    FlankStrength,
    contact_stress,
    flank_factors,
    lubricant_factor,
    relative_radius,
    roughness_factor,
    static_work_factor,
    through_hardened_work_factor,
    velocity_factor,
    work_hardening_factor,
)
from tests.refusals import refused_calls

ROUNDING = 1e-12  # of a power and a few products
PRINTED = 5.5e-4  # three digits behind the point, of inputs that are rounded, too
HARD = FlankStrength(1500.0, "Eh", 6.0)
QUENCHED = FlankStrength(700.0, "V alloy", 8.0, 240.0)
OF_TR = {"relative_radius": 21.857, "velocity": 2.664, "viscosity_40": 320.0, "gear_ratio": 103 / 17}


def test_iso_tr_6336_30_example_1_has_its_factors_stresses_and_safeties():
    """Printed Z_L, Z_v, Z_R, Z_NT, sigma_HP; S_H at the printed 1301.35343 MPa. N_L is 1.08e9 and 17/103 of it."""
    angle, base = radians(20.719712), 8.0 / cos(radians(15.8))
    radius = relative_radius((17 * base * cos(angle), 103 * base * cos(angle)), radians(21.066100))
    factors = flank_factors(HARD, HARD, **{**OF_TR, "relative_radius": radius}, cycles=[1.08e9, 1.08e9 * 17 / 103])
    assert_allclose([factors.Z_L, factors.Z_v, factors.Z_R], [1.04739, 0.96911, 0.96599], atol=5e-6)
    assert_allclose(factors.Z_NT, [0.91, 0.962], atol=5e-4)
    assert factors.Z_W.tolist() == [1.0, 1.0]
    assert_allclose(factors.permissible_stress(1.0), [1338.48050, 1414.52551], rtol=5e-6)  # of the digits of Z_v
    assert_allclose(factors.safety(1301.35343), [1.02853, 1.08696], atol=1e-5)
    assert factors.notes == ()


def test_kisssoft_report_of_a_case_hardened_pair_has_its_factors():
    """High-speed stage of the NREL gearbox: R_z 4.8 um, ISO VG 220; sigma_HG 1338.30 and 1387.31 MPa."""
    gear, radius = FlankStrength(1500.0, "Eh", 4.8), 67.447 * 266.979 / 334.426
    factors = flank_factors(
        gear, gear, relative_radius=radius, velocity=20.83, viscosity_40=220.0, cycles=[1.2255788e10, 3.096199e9],
        gear_ratio=3.958,
    )  # fmt: skip
    assert_allclose([factors.Z_L, factors.Z_v, factors.Z_R], [1.020, 1.022, 1.007], atol=PRINTED)
    assert_allclose(factors.Z_NT, [0.850, 0.881], atol=PRINTED)
    assert_allclose(factors.strength, [1338.30, 1387.31], rtol=PRINTED)
    assert_allclose(factors.safety(739.61), [1.81, 1.88], atol=5e-3)


def test_kisssoft_report_of_a_planet_in_a_through_hardened_ring_has_its_factors():
    """Second stage: 4.8 and 8.0 um, 240 HBW, 4.88 m/s; sigma_HG 1388.39 and 732.21 MPa, Z_W 1.135 of the ring."""
    planet, radius = FlankStrength(1500.0, "Eh", 4.8), relative_radius((710.408, -1835.220), radians(15.630))
    factors = flank_factors(
        planet, QUENCHED, relative_radius=radius, velocity=4.88, viscosity_40=220.0, cycles=[1.2971e9, 1.5063e9],
        gear_ratio=2.58,
    )  # fmt: skip
    assert_allclose([factors.Z_L, factors.Z_v, factors.Z_R], [1.038, 0.961, 1.026], atol=PRINTED)
    assert_allclose([*factors.Z_W, *factors.Z_NT], [1.0, 1.135, 0.905, 0.901], atol=PRINTED)
    assert_allclose(factors.strength, [1388.39, 732.21], rtol=PRINTED)


def test_contact_stress_is_that_of_the_reports():
    """570.79 MPa with 1.25, 1.092, 1.150 and 1.069; of the sun 573.40 MPa with Z_B 1.08 and sqrt of K 994.13/573.40."""
    stress = contact_stress(570.79, 1.0, 1.25 * 1.092 * 1.150 * 1.069)
    assert_allclose(stress, 739.61, rtol=1e-3)  # half the error of four factors with four digits
    assert_allclose(contact_stress(573.40, [1.08, 1.0], (994.13 / 573.40) ** 2), [1071.17, 994.13], rtol=5e-3)  # of Z_B


def test_strength_goes_to_the_static_one_without_oil_and_roughness():
    """sigma_H_lim Z_NT Z_W from 1e5 load cycles down, and between both knees a line in logarithms."""
    factors = flank_factors(HARD, QUENCHED, **OF_TR, cycles=[[1e4, 5e7], [1e5, (1e5 * 5e7) ** 0.5]])
    assert_allclose(factors.strength[0, 0], 1500.0 * 1.6)
    static = 700.0 * 1.6 * static_work_factor(240.0)
    reference = 700.0 * factors.Z_L * factors.Z_v * factors.Z_R * factors.Z_W[1]
    assert_allclose(factors.strength[1], [static, (static * reference) ** 0.5])


def test_speeds_of_bins_are_those_of_each_bin():
    speeds, cycles = [1.0, 10.0], np.array([[1e8, 1e9], [2e7, 2e8]])
    both = flank_factors(HARD, QUENCHED, **{**OF_TR, "velocity": speeds}, cycles=cycles)
    for place, speed in enumerate(speeds):
        single = flank_factors(HARD, QUENCHED, **{**OF_TR, "velocity": speed}, cycles=cycles[:, place])
        assert_allclose(both.strength[:, place], single.strength)


def test_constants_of_soft_and_hard_flanks_meet_in_a_line():
    """C_ZL = sigma/4375 + 0.6357 and C_ZR = 0.32 - 0.0002 sigma, as other programs have the lines: four digits."""
    middle = 1000.0
    constant = middle / 4375.0 + 0.6357
    assert_allclose(lubricant_factor(100.0, middle), constant + 4.0 * (1.0 - constant) / 2.54**2, atol=1e-4)
    assert_allclose(roughness_factor((12.0, 12.0), 10.0, middle), 0.25 ** (0.32 - 0.0002 * middle), rtol=ROUNDING)
    assert lubricant_factor(100.0, 500.0) == lubricant_factor(100.0, 850.0)
    assert velocity_factor(5.0, 1200.0) == velocity_factor(5.0, 1650.0)


def test_work_hardening_keeps_its_limits():
    smooth, rough = ((each, 8.0) for each in (1.0, 40.0))
    assert_allclose(work_hardening_factor(100.0, smooth, 20.0, 5.0, 220.0), 1.2)
    assert_allclose(work_hardening_factor(500.0, smooth, 20.0, 5.0, 220.0), 1.0)
    assert_allclose(work_hardening_factor(240.0, rough, 20.0, [0.1, 1.0], 220.0), [1.0, 1.0])
    assert through_hardened_work_factor(1.19, 5.0) == through_hardened_work_factor(1.5, 1.0) == 1.0
    assert_allclose(
        through_hardened_work_factor(1.7, 4.0), through_hardened_work_factor(1.8, 4.0), atol=1.5e-5
    )  # 0.00698
    assert through_hardened_work_factor(1.5, 30.0) == through_hardened_work_factor(1.5, 20.0)


def test_harder_through_hardened_pinion_hardens_the_wheel_alone():
    factors = flank_factors(replace(QUENCHED, hardness=336.0), QUENCHED, **OF_TR, cycles=[1e8, 1e8])
    assert_allclose(factors.Z_W, [1.0, through_hardened_work_factor(1.4, 103 / 17)])
    assert factors.Z_W_static.tolist() == [1.0, 1.0]
    exchanged = {**OF_TR, "gear_ratio": 17 / 103}
    factors = flank_factors(QUENCHED, replace(QUENCHED, hardness=336.0), **exchanged, cycles=[1e8, 1e8])
    assert_allclose(factors.Z_W, [through_hardened_work_factor(1.4, 103 / 17), 1.0])


def test_values_beyond_the_standard_are_told():
    soft = flank_factors(HARD, replace(QUENCHED, hardness=120.0), **OF_TR, cycles=[1e8, 1e8])
    assert soft.notes == ("Z_W: 120 HBW is not within 130 to 470 HBW, and the nearer limit is used",)
    steep = flank_factors(replace(QUENCHED, hardness=336.0), QUENCHED, **{**OF_TR, "gear_ratio": 25.0}, cycles=[1, 1])
    assert steep.notes == ("Z_W: 20 is used for the gear ratio 25, which is larger",)
    gear = FlankStrength(650.0, "NV nitrocarburized", 1.0)
    thick = flank_factors(gear, gear, **{**OF_TR, "viscosity_40": 1000.0}, cycles=[1e3, 1e8])
    assert "Z_NT: the static strength of kind 'NV nitrocarburized'" in thick.notes[0]
    assert_allclose(thick.strength[0], 650.0 * thick.Z_L * thick.Z_v * thick.Z_R, rtol=1e-5)  # all but level: 1e-6


def test_safeties_of_bins_are_those_of_each_gear_for_any_number_of_bins():
    """Two bins of two gears are as many as gears."""
    apart = flank_factors(HARD, QUENCHED, **OF_TR, cycles=[1e8, 1e8])
    for bins in (2, 3):
        stress = np.full((2, bins), 1000.0)
        assert_allclose(apart.safety(stress), np.stack([apart.strength] * bins, axis=-1) / 1000.0)
        speeds = flank_factors(HARD, QUENCHED, **{**OF_TR, "velocity": np.full(bins, 2.664)}, cycles=[1e8, 1e8])
        assert_allclose(speeds.safety([1000.0, 500.0])[1], np.full(bins, apart.strength[1] / 500.0))
        assert_allclose(speeds.safety(1000.0), apart.safety(stress))


test_iso6336_2_refuses = refused_calls(
    (lambda: flank_factors(HARD, HARD, **OF_TR, cycles=1e8), r"cycles: shape \(\); asked for is \(2, ...\)"),
    (
        lambda: flank_factors(HARD, HARD, **{**OF_TR, "gear_ratio": 0.0}, cycles=[1, 1], size_factor=0.0),
        ("^size_factor: 0.0; allowed above 0, up to 1$", "^gear_ratio: 0.0 is not positive"),
    ),
    (
        lambda: flank_factors(HARD, replace(QUENCHED, hardness=None), **OF_TR, cycles=[1, 1]),
        "hardness: not given; Z_W of a gear of kind 'V alloy' beside 'Eh' needs it",
    ),
    (
        lambda: flank_factors(HARD, HARD, **OF_TR, cycles=[1, 1]).safety([1.0, 1.0, float("nan")]),
        (r"^contact_stress: nan MPa is not in \[0, inf\)$", r"^contact_stress: shape \(3,\); asked for is \(2, ...\)"),
    ),
    (lambda: FlankStrength(0.0, "Eh", -1.0), ("^limit_stress: 0.0 is not", "^roughness: -1.0 is not")),
    (lambda: FlankStrength(1500.0, "steel", 1.0), "kind: 'steel' is no kind of material"),
    (lambda: velocity_factor([1.0, 0.0], 1500.0), r"velocity: 0 m/s is not in \(0, inf\)"),
    (
        lambda: contact_stress(-1.0, 0.9, -1.0),
        ("^nominal_stress: -1 MPa is not in", "^single_contact_factor: 0.9 is not", "^load_factors: -1 is not"),
    ),
    (lambda: lubricant_factor(0.0, 1500.0), "viscosity_40: 0.0 is not positive"),
    (lambda: relative_radius((100.0, -90.0), 0.4), "base_diameters: a ring of -90.0 mm is too small"),
    (
        lambda: flank_factors(HARD, HARD, **OF_TR, cycles=[1, 1]).permissible_stress(0.0),
        "required_safety: 0.0 is not positive",
    ),
)
