"""Load factors: printed reports, a disc, seams between the ranges, refusals."""

from math import radians

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import brentq

from loaded_tca.reference.iso6336_1 import (
    RANGES,
    contact_face_load_factor,
    disc_inertia,
    dynamic_factor,
    reduced_mass,
    resonance_speed,
    running_in_allowance,
    running_in_misalignment,
    running_in_relief,
    scope_notes,
    transverse_load_factors,
)
from tests.refusals import refused_calls

ROUNDING = 1e-12  # of some dozen products and roots
STAGE = {
    "single_stiffness": 13.832, "total_contact_ratio": 2.884, "pitch_deviation": 14.7, "profile_deviation": 20.4,
    "tip_relief": 2.0,
}  # fmt: skip
TEETH = {"transverse_contact_ratio": 1.463, "overlap_ratio": 1.421, "virtual_contact_ratio": 1.503}


def test_kisssoft_report_has_its_dynamic_factor():
    """NREL, high-speed stage: m_red 0.36503 kg/mm, n_E1 2843, N 0.410, K_v 1.092, y_p 1.2, y_f 1.6, C_ay 2.0 um.

    The program has diameters of its own for the mass: those of the printed tips, roots and bores are 0.8 % above.
    """
    blanks = [
        disc_inertia(0.5 * (380.747 + 319.623), 179.10, 7830.0),
        disc_inertia(0.5 * (1395.376 + 1334.252), 1193.32, 7830.0),
    ]
    assert_allclose(reduced_mass(tuple(blanks), (160.013, 633.385)), 0.36503, rtol=0.01)
    speed = resonance_speed(24, 18.632, 0.36503)
    assert_allclose(speed, 2843.0, atol=0.5)
    assert_allclose([running_in_allowance("Eh", each, 1500.0, 20.83) for each in (15.9, 22.0)], [1.2, 1.65], atol=0.01)
    assert_allclose(running_in_relief(1500.0), 2.0, atol=0.05)
    factor = dynamic_factor(1165.9 / speed, 1.25 * 666.85, **STAGE)
    assert_allclose(factor.K_v, 1.092, atol=1e-3)
    assert RANGES[factor.range] == "subcritical"
    assert factor.notes == ()


def test_kisssoft_report_has_its_transverse_load_factors():
    """1.069, with the profile deviation of 22 um less 1.2, since it is larger than that of the pitch."""
    load = 1.25 * 666.85 * 1.092 * 1.150
    factors = transverse_load_factors(load, mesh_stiffness=18.632, deviation=22.0 - 1.2, **TEETH)
    assert_allclose(factors, 1.069, atol=1e-3)


def test_reduced_mass_of_like_discs_is_half_the_mass_on_the_base_circle():
    inertia = disc_inertia(100.0, density=7850.0)
    disc = 7.85e-6 * np.pi * 50.0**2  # kg/mm
    assert_allclose(inertia, 0.5 * disc * 50.0**2)
    assert_allclose(reduced_mass((inertia, inertia), (47.0, 47.0)), 0.5 * inertia / 47.0**2)
    assert_allclose(reduced_mass((inertia, float("inf")), (47.0, 60.0)), inertia / 47.0**2)
    assert_allclose(disc_inertia(100.0, 50.0), 15.0 / 16.0 * inertia)


def test_planetary_stage_has_the_dynamic_factors_of_the_kisssoft_report():
    """NREL, second stage: m_red 0.1534 and 1.4684 kg/mm, N 0.046 and 0.124, K_v 1.02 and 1.06."""
    sun, planet = disc_inertia(387.338, 194.32, 7830.0), disc_inertia(770.163, 576.96, 7830.0)
    masses = reduced_mass((sun, planet), (177.602, 355.204), meshes=(3, 1)), planet / 355.204**2
    assert_allclose(masses, [0.1534, 1.4684], rtol=4e-4)  # printed with four digits
    load, relief = 1.25 * 519.82, (running_in_relief(1500.0), running_in_relief(700.0))
    for ratio, stiffness, total, pitch, profile, tip, printed in (
        (0.046, 12.240, 1.370, 17.9 - 1.342, 23.0 - 1.725, relief[0], 1.02),
        (0.124, 14.053, 1.618, 20.7 - 3.142, 27.0 - 4.098, 0.5 * sum(relief), 1.06),
    ):
        factor = dynamic_factor(
            ratio, load, single_stiffness=stiffness, total_contact_ratio=total, pitch_deviation=pitch,
            profile_deviation=profile, tip_relief=tip,
        )  # fmt: skip
        assert_allclose(factor.K_v, printed, atol=5e-3)


@pytest.mark.parametrize("total", [1.4, 1.9, 2.4, 3.0])
def test_dynamic_factor_has_no_step_between_resonance_and_supercritical_range(total):
    ratios = np.array([1.15 - 1e-9, 1.15 + 1e-9, 1.5 - 1e-9, 1.5])
    factor = dynamic_factor(ratios, 300.0, **{**STAGE, "total_contact_ratio": total})
    assert_allclose(factor.K_v[[0, 2]], factor.K_v[[1, 3]], rtol=1e-7)
    assert factor.range.tolist() == [1, 2, 2, 3]
    assert (factor.K_v >= 1.0).all()


def test_dynamic_factor_of_bins_is_that_of_each_bin():
    ratios, loads = np.array([0.2, 0.9, 1.3, 2.0]), np.array([50.0, 80.0, 300.0, 900.0])
    both = dynamic_factor(ratios, loads, **STAGE)
    assert_allclose(both.K_v, [float(dynamic_factor(*pair, **STAGE).K_v) for pair in zip(ratios, loads, strict=True)])
    assert_allclose(both.N_S, [0.5 + 0.35 * 0.5**0.5, 0.5 + 0.35 * 0.8**0.5, 0.85, 0.85])


def test_exact_gears_with_the_relief_of_their_load_run_smoothly():
    """c' C_a = w and no deviations: nothing excites below resonance."""
    exact = {**STAGE, "pitch_deviation": 0.0, "profile_deviation": 0.0, "tip_relief": 30.0}
    assert dynamic_factor(0.7, 30.0 * 13.832, **exact).K_v == 1.0


def test_relief_beyond_the_deflection_excites_as_that_below_it():
    short, long = (dynamic_factor(0.7, 300.0, **{**STAGE, "tip_relief": part * 300.0 / 13.832}) for part in (0.5, 1.5))
    assert_allclose(short.K_v, long.K_v, rtol=ROUNDING)
    assert short.K_v > dynamic_factor(0.7, 300.0, **{**STAGE, "tip_relief": 300.0 / 13.832}).K_v


def test_what_method_b_does_not_cover_is_told():
    factor = dynamic_factor([0.9, 1.3], 90.0, **STAGE, speed_parameter=1.0)
    assert [note[:40] for note in factor.notes] == [
        "K_v: N lies in the main resonance, which",
        "K_v: N lies between main resonance and s",
        "K_v: (v z_1/100) sqrt(u^2/(1 + u^2)) is ",
        "K_v: the load is below 100 N/mm, where c",
    ]


def test_what_the_standard_was_not_checked_for_is_told():
    inside = {"pressure_angle": radians(25.0), "helix_angle": radians(-30.0), "transverse_contact_ratio": 1.2}
    assert scope_notes(**inside, profile_shifts=(0.3, 0.3)) == ()
    outside = {"pressure_angle": radians(14.0), "helix_angle": radians(31.0), "transverse_contact_ratio": 2.6}
    assert len(scope_notes(**outside, profile_shifts=(-0.5, 0.1))) == 4
    assert len(scope_notes(**{**inside, "transverse_contact_ratio": 1.1}, profile_shifts=(1.2, 1.0))) == 2


def test_running_in_allowances_keep_their_limits():
    """12800/sigma_H_lim above 5 m/s and half of it above 10 m/s of St and V; 22 and 11 um of GG; 3 um if hard."""
    speeds = [5.0, 7.0, 20.0]
    assert_allclose(running_in_allowance("V alloy", 200.0, 640.0, speeds), [50.0, 20.0, 10.0])
    assert_allclose(running_in_allowance("GG", 200.0, 300.0, speeds), [55.0, 22.0, 11.0])
    assert_allclose(running_in_allowance("NT", 200.0, 1250.0, speeds), 3.0)


@pytest.mark.parametrize("misalignment", [10.0, 30.0, 100.0])
def test_face_load_factor_is_that_of_stiff_bodies_on_springs(misalignment):
    """300 N/mm on 15 N/(mm um): the approach of the bodies solved for, places without contact bear nothing."""
    gaps = misalignment * (np.arange(4000) + 0.5) / 4000
    approach = brentq(lambda depth: np.maximum(0.0, 15.0 * (depth - gaps)).mean() - 300.0, 0.0, 1e3)
    assert_allclose(
        contact_face_load_factor(misalignment, 15.0, 300.0), 15.0 * approach / 300.0, rtol=1e-3
    )  # of 4000 springs


def test_running_in_of_helices_keeps_its_limits():
    """25600/sigma_H_lim above 5 m/s and half of it above 10 m/s of St and V; 45 and 22 um of GG; 6 um if hard."""
    speeds = [5.0, 7.0, 20.0]
    assert_allclose(running_in_misalignment("V alloy", 200.0, 640.0, speeds), [100.0, 40.0, 20.0])
    assert_allclose(running_in_misalignment("GG", 200.0, 300.0, speeds), [110.0, 44.0, 22.0])
    assert_allclose(running_in_misalignment("Eh", 200.0, 1500.0, speeds), 6.0)
    assert running_in_misalignment("St", 30.0, 300.0) == 30.0


def test_transverse_load_factors_lie_between_even_sharing_and_one_pair():
    """The two formulas meet at a total contact ratio of 2."""
    load = {"specific_load": [50.0, 5e3], "mesh_stiffness": 18.0, "deviation": 20.0}
    flank, root = transverse_load_factors(**load, **TEETH)
    assert flank[1] == root[1] == 1.0
    assert_allclose(flank[0], 2.884)  # eps_gamma: with an overlap above 1 a pair has the mean line of contact
    assert_allclose(root[0], 2.884 / (1.463 * (0.25 + 0.75 / 1.503)))
    seam = [
        transverse_load_factors(
            200.0, mesh_stiffness=18.0, deviation=15.0, transverse_contact_ratio=1.5, overlap_ratio=overlap,
            virtual_contact_ratio=1.5,
        )[0]
        for overlap in (0.5 - 1e-9, 0.5 + 1e-9)
    ]  # fmt: skip
    assert_allclose(seam[0], seam[1], rtol=1e-7)


test_iso6336_1_refuses = refused_calls(
    (
        lambda: dynamic_factor(-1.0, 0.0, **{**STAGE, "total_contact_ratio": 1.0, "tip_relief": -1.0}),
        ("^resonance_ratio: -1 is", "^specific_load: 0 N/mm is", "^total_contact_ratio: 1.0", "^tip_relief: -1.0 um"),
    ),
    (lambda: disc_inertia(100.0, 100.0), "bore_diameter: 100.0 mm; allowed 0 to below the mean diameter, 100.0 mm"),
    (lambda: reduced_mass((float("inf"),) * 2, (1.0, 1.0)), "inertias: one of the gears has to swing"),
    (lambda: reduced_mass((0.0, 1.0), (1.0, -1.0)), ("^inertias: 0.0 kg mm", "^base_radii: -1.0 mm")),
    (lambda: reduced_mass((1.0, 1.0), (1.0, 1.0), meshes=(0, 1)), "meshes: 0 is below 1"),
    (lambda: resonance_speed(20, 0.0, 1.0), "mesh_stiffness: 0.0 is not positive"),
    (lambda: running_in_allowance("Eh", -1.0, 1500.0), "deviation: -1.0 um is negative"),
    (lambda: running_in_allowance("Eh", 1.0, 1500.0, -1.0), "velocity: -1 m/s is not in"),
    (
        lambda: contact_face_load_factor(-1.0, 15.0, 0.0),
        ("^misalignment: -1 um is not in", "^specific_load: 0 N/mm is not in"),
    ),
    (lambda: running_in_misalignment("Eh", -1.0, 1500.0), "misalignment: -1 um is not in"),
    (lambda: running_in_relief(0.0), "limit_stress: 0.0 is not positive"),
    (
        lambda: transverse_load_factors(0.0, mesh_stiffness=18.0, deviation=-1.0, **TEETH),
        ("^specific_load: 0 N/mm is not in", "^deviation: -1 um is not in"),
    ),
)
