"""Root stress of bevel pairs: printed samples, the limits of cylindrical and of straight-sided teeth."""

import math
from dataclasses import replace

import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError
from loaded_tca.reference import iso6336_3, iso10300_3
from tests.refusals import refused_calls
from validation.rating.iso_tr_10300_30 import BEVEL, FOUR_DIGITS, SAMPLES, obtained

ROUNDING = 1e-12  # of some dozen products and roots
PARTS = ("Y_Fa", "Y_Sa", "q_s", "s_Fn", "rho_F", "h_Fa", "Y_eps", "Y_BS", "Y_LS", "sigma_F0", "sigma_FG")
TOOL = {"tool_depth": 1.25, "edge_radius": 0.25, "profile_shift": 0.1, "thickness_shift": 0.02}
ANGLE = math.radians(20.0)


@pytest.mark.parametrize("name", SAMPLES)
def test_samples_have_their_printed_numbers(name):
    values, printed = obtained(SAMPLES[name]), SAMPLES[name].printed
    for part in PARTS:
        if part in printed:
            assert_allclose(values[part], printed[part], rtol=FOUR_DIGITS, err_msg=part)


def section(**changes):
    values = {"teeth": 24.0, "tip_diameter": 26.2, "pressure_angle": ANGLE, **TOOL}
    return iso10300_3.tip_section(**(values | changes))


def test_section_is_that_of_iso_6336_3_under_a_load_at_the_tip():
    here = section(thickness_shift=0.0)
    there = iso6336_3.root_section(24, 0.1, 26.2, 1.0, dedendum_coefficient=1.25, root_radius_coefficient=0.25)
    for name in ("thickness", "lever", "radius", "load_angle"):
        assert_allclose(getattr(here, name), getattr(there, name), rtol=ROUNDING)


def test_teeth_become_straight_as_their_number_grows():
    number = 1e7
    rolled = section(teeth=number, tip_diameter=number + 2.2)
    straight = section(teeth=number, tip_diameter=number + 2.2, generated=False)
    assert_allclose(rolled.thickness, straight.thickness, rtol=1e-5)  # first order in 1/z
    assert_allclose(rolled.lever, straight.lever, rtol=1e-5)
    assert_allclose(rolled.form_factor, straight.form_factor, rtol=1e-5)
    assert_allclose(rolled.stress_correction_factor, straight.stress_correction_factor, rtol=1e-5)


def test_both_sides_of_a_tooth_share_its_chord():
    steep = math.radians(22.0)
    alone = [section(pressure_angle=each).thickness for each in (ANGLE, steep)]
    both = section(coast=(24.0, steep))
    assert_allclose(both.thickness, sum(alone) / 2.0, rtol=ROUNDING)
    assert (both.lever, both.radius) == (section().lever, section().radius)  # those of the loaded side


def test_thicker_teeth_have_less_stress():
    assert section(thickness_shift=0.1).form_factor < section(thickness_shift=0.0).form_factor


def test_straight_teeth_have_no_spiral_factor():
    pair = replace(BEVEL.pair, spiral_angles=(0.0, 0.0))
    assert iso10300_3.bevel_spiral_angle_factor(pair, BEVEL.depths) == 1.0
    profile, _ = pair.contact_ratios
    assert_allclose(iso10300_3.contact_ratio_factor(pair), 0.25 + 0.75 / profile, rtol=ROUNDING)


test_root_refuses = refused_calls(
    (
        lambda: section(tool_depth=0.0, pressure_angle=1.0),
        ("tool_depth: 0.0 is not positive and finite",),
    ),
    (
        lambda: section(coast=(0.0, 1.0)),
        ("coast: 0.0 is not positive and finite",),
    ),
    (
        lambda: section(coast=(24.0, 1.0)),
        ("coast: 1.0 rad is not between 0 and 45 deg",),
    ),
    (
        lambda: section(profile_shift=1.3, protuberance=1.0),
        ("profile_shift: 1.3 leaves no dedendum below 1.25", "protuberance: 1.0 m_mn; allowed 0 to below 1"),
    ),
    (lambda: section(edge_radius=0.6), "edge_radius: 0.6 m_mn does not fit on the bottom of the slot", GeometryError),
    (lambda: section(tip_diameter=22.0), "tip_diameter: 22 m_mn lies inside the base circle", GeometryError),
    (
        lambda: section(teeth=1e6, tip_diameter=1e6 - 2.8, generated=False),
        "no critical section",
        GeometryError,
    ),
)
