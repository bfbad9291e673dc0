from dataclasses import replace
from math import cos, inf, nan, pi, radians, sin, tan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError
from loaded_tca.gears import CylindricalGear, CylindricalMesh, PinionCutter, RingGear
from loaded_tca.gears.involute import involute
from loaded_tca.reference.iso6336_3 import (
    cut_root_radius,
    face_load_factor,
    helix_angle_factor,
    nominal_root_stress,
    rim_thickness_factor,
    root_section,
)
from tests.refusals import refusals, refused_calls

ROUNDING = 1e-12  # a few dozen floating point operations
USUAL = {"teeth": 25, "profile_shift": 0.0, "tip_diameter": 27.0, "transverse_contact_ratio": 1.6}


@pytest.mark.parametrize(
    ("member", "form", "correction", "stress"), [(0, 1.689, 1.851, 271.19), (1, 1.583, 1.917, 263.17)]
)
def test_fzg_c14_has_the_digits_that_gearpie_prints(member, form, correction, stress):
    """200 N m; F_t on the operating pitch circle of 73.2 mm, tips not shortened, fillets of 0.375 modules."""
    gears = [CylindricalGear(z, 4.5, 14.0, profile_shift=x) for z, x in ((16, 0.1817), (24, 0.1715))]
    ratio, gear = CylindricalMesh(*gears).transverse_contact_ratio, gears[member]
    tip = 2.0 * gear.tip_radius / 4.5
    section = root_section(gear.teeth, gear.profile_shift, tip, ratio, root_radius_coefficient=0.375)
    assert_allclose(section.form_factor, form, atol=5e-4)
    assert_allclose(section.stress_correction_factor, correction, atol=5e-4)
    factors = section.form_factor * section.stress_correction_factor
    assert_allclose(nominal_root_stress(400e3 / 73.2, 14.0, 4.5, factors), stress, atol=5e-3)


@pytest.mark.parametrize("shift", [-0.1, 0.0, 0.4])
def test_critical_section_is_that_of_the_fillet_that_the_rack_cuts(shift):
    """Where the tangent of the trochoid, found by itself, has 30 degrees to the middle of the tooth."""
    gear = CylindricalGear(25, 1.0, 10.0, profile_shift=shift)
    radius, angle = gear.root_fillet(20001)
    half = gear.half_thickness_angle_at_base - involute(float(np.arccos(gear.base_radius / radius[0])))
    azimuth = half + np.abs(angle - angle[0])
    x, y = radius * np.cos(azimuth), radius * np.sin(azimuth)
    slope = np.arctan2(np.diff(y), -np.diff(x))
    place = int(np.abs(slope - radians(30.0)).argmin())
    section = root_section(25, shift, 2.0 * gear.tip_radius, 1.6)
    assert_allclose(section.thickness, y[place] + y[place + 1], rtol=1e-4)
    bend = np.diff(slope) / np.hypot(np.diff(x), np.diff(y))[1:]
    assert_allclose(section.radius, 1.0 / bend[place], rtol=1e-3)


RINGS = {
    "stage 1": ((-56, -0.5013, 2475.118 / 45.0, 1.278), 36, (2.875, 1.742, 0.494, 19.59, 1.27, 2.13)),
    "stage 2": ((-93, 0.1171, 1906.081 / 21.0, 1.618), 30, (2.703, 1.444, 0.418, 18.63, 1.20, 2.34)),
}
"""NREL 5 MW, as KISSsoft 03/2017A prints: gear, teeth of the cutter, s_Fn, h_Fe, rho_F, alpha_Fen, Y_F, Y_S."""


@pytest.mark.parametrize("stage", RINGS)
def test_rings_have_the_digits_that_kisssoft_prints(stage):
    gear, cutter, printed = RINGS[stage]
    section = root_section(*gear, root_radius_coefficient=cut_root_radius(0.3, 1.25, cutter))
    obtained = section.thickness, section.lever, section.radius, np.degrees(section.load_angle)
    digits = 5e-4, 1e-3, 5e-4, 5e-3  # half a last digit; a whole one where the contact ratio, of four digits, counts
    assert (np.abs(np.subtract(obtained, printed[:4])) <= digits).all()
    assert_allclose([section.form_factor, section.stress_correction_factor], printed[4:], atol=5e-3)


def test_fillet_that_the_cutter_of_a_ring_cuts_is_sharper_than_that_of_its_rack():
    """Where its tangent, found by itself, has 60 degrees to the middle of the tooth: Y_F Y_S is 2.89, not 2.79."""
    values, cutter, printed = RINGS["stage 2"]
    sizes = {"tip_diameter": values[2], "root_diameter": 2000.581 / 21.0, "cutter": PinionCutter(cutter)}
    ring = RingGear(-93, 1.0, 10.0, profile_shift=values[1], **sizes)
    radius, angle = ring.root_fillet(20001)
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    slope = np.arctan2(np.diff(y), np.diff(x))
    place = int(np.abs(slope - radians(60.0)).argmin())
    length = np.hypot(np.diff(x), np.diff(y))
    bend = float(length[place] / (slope[place + 1] - slope[place]))
    rack = root_section(*values, root_radius_coefficient=cut_root_radius(0.3, 1.25, cutter))
    moved = 2.0 * float(y[place])
    lever = float(x[place]) - ring.base_radius / cos(rack.load_angle)
    section = replace(rack, thickness=moved, radius=bend, lever=lever)
    assert 1.0 < moved / printed[0] < 1.02
    assert 0.8 < bend / printed[2] < 0.95
    assert_allclose(section.form_factor * section.stress_correction_factor, 2.89, atol=5e-3)


@pytest.mark.parametrize("sign", [1, -1])
def test_gear_and_ring_of_many_teeth_are_racks(sign):
    """Formulas of DIN 3990-3:1987, which takes a ring as a rack with tangents of 30 degrees; here a ring has 60."""
    angle, height, rho, addendum = radians(20.0), 1.25, 0.38, 1.0
    tangent, teeth = radians(30.0 if sign > 0 else 60.0), 1_000_000
    section = root_section(sign * teeth, 0.0, teeth + sign * 2.0 * addendum, 1.0)
    thickness = 2.0 * (pi / 4.0 + tan(angle) * (height - rho) + rho / cos(angle) - rho * cos(tangent))
    whole = height + addendum
    lever = whole - (pi / 4.0 + (height - whole) * tan(angle)) * tan(angle) - rho * (1.0 - sin(tangent))
    # the largest difference is that of the radius, 2 G^2/(z cos^3 theta) = 1.2e-5 of 0.38 with theta 60 degrees
    assert_allclose([section.thickness, section.lever, section.radius], [thickness, lever, rho], rtol=1e-4)
    assert_allclose(section.load_angle, angle, rtol=1e-4)


def test_cutter_of_many_teeth_has_the_rounding_of_a_rack():
    assert cut_root_radius(0.3, 1.25, 10000) == 0.3
    assert cut_root_radius(0.3, 1.25, 20) > cut_root_radius(0.3, 1.25, 40) > 0.3


def test_lever_at_a_contact_ratio_of_1_is_that_of_a_load_at_the_tip():
    section = root_section(**{**USUAL, "transverse_contact_ratio": 1.0})
    base, tip = 12.5 * cos(radians(20.0)), 13.5
    angle = np.arccos(base / tip)
    half = 0.5 * pi / 25 + np.tan(radians(20.0)) - radians(20.0) - np.tan(angle) + angle
    assert_allclose(section.load_angle, angle - half, rtol=ROUNDING)
    longer = root_section(**{**USUAL, "transverse_contact_ratio": 1.3})
    assert longer.lever < section.lever
    assert longer.thickness == section.thickness


@given(st.floats(0.0, 0.5))
def test_virtual_gear_of_a_helical_one_is_thinner_at_no_angle(angle):
    """More virtual teeth stand on thicker roots."""
    straight = root_section(**USUAL)
    helical = root_section(**{**USUAL, "tip_diameter": 25.0 / cos(angle) + 2.0}, helix_angle=angle)
    assert helical.thickness >= straight.thickness - ROUNDING
    left = root_section(**{**USUAL, "tip_diameter": 25.0 / cos(angle) + 2.0}, helix_angle=-angle)
    assert left == helical


def test_sharper_fillet_has_a_larger_notch_factor():
    factors = [root_section(**USUAL, root_radius_coefficient=rho).stress_correction_factor for rho in (0.25, 0.38)]
    assert factors[0] > factors[1] > 1.0


def test_helix_angle_factor_keeps_its_limits():
    assert helix_angle_factor(0.4, 0.0) == helix_angle_factor(0.0, 2.0) == 1.0
    assert_allclose(helix_angle_factor(radians(45.0), 3.0), 0.75, rtol=ROUNDING)
    assert helix_angle_factor(-0.2, 0.5) == helix_angle_factor(0.2, 0.5)


@given(st.floats(1.0, 3.0), st.floats(0.01, 2.0))
def test_face_load_factor_lies_between_1_and_that_of_contact(contact, ratio):
    found = face_load_factor(contact, ratio)
    assert 1.0 <= found <= contact
    assert_allclose(face_load_factor(contact, 5.0), contact ** (9.0 / 13.0), rtol=ROUNDING)


def test_thin_rims_raise_root_stress_and_thick_ones_do_not():
    """1.6 ln(2.242/0.8) and 1.6 ln(2.242/0.6) by hand; from 1.2 on 1, where the curve arrives at 1.0001."""
    assert_allclose([rim_thickness_factor(rim) for rim in (0.8, 0.6)], [1.64882, 2.10911], atol=5e-6)
    assert rim_thickness_factor(1.2) == rim_thickness_factor(inf) == 1.0
    assert_allclose(rim_thickness_factor(1.2 - 1e-9), 1.0, atol=1e-4)


test_section_tells_what_is_out_of_range = refusals(
    lambda change: root_section(**{**USUAL, **change}),
    ({"teeth": 2}, "teeth: 2 is below 3"),
    ({"profile_shift": nan}, "profile_shift: nan is not between -2 and 2"),
    ({"tip_diameter": inf}, "tip_diameter: inf is not positive and finite"),
    ({"transverse_contact_ratio": 0.9}, r"transverse_contact_ratio: 0.9 is not in \[1, 3\)"),
    ({"helix_angle": 1.0}, "helix_angle: 1.0 rad is not within 45 deg"),
    ({"pressure_angle": 0.0}, "pressure_angle: 0.0 rad is not between 0 and 45 deg"),
    ({"dedendum_coefficient": 0.0}, "dedendum_coefficient: 0.0 is not positive"),
    ({"root_radius_coefficient": -0.1}, "root_radius_coefficient: -0.1 is not positive"),
)


test_gears_without_a_section_are_refused = refusals(
    lambda change: root_section(**{**USUAL, **change}),
    ({"tip_diameter": 20.0}, "inside the base circle"),
    ({"teeth": -20, "tip_diameter": 18.0, "profile_shift": -1.9}, "no tangent of 30 degrees, or 60 of a ring"),
    ({"teeth": 8, "tip_diameter": 10.0, "transverse_contact_ratio": 2.9}, "below the base circle"),
    ({"root_radius_coefficient": 30.0}, "no critical section"),
    error=GeometryError,
)


test_iso6336_3_refuses = refused_calls(
    (lambda: cut_root_radius(-0.1, 1.25, 2), ("^cutter_teeth: 2 is below 3", "^root_radius_coefficient: -0.1")),
    (lambda: cut_root_radius(0.3, 1.25, 30, -1.0), "cutter_profile_shift: -1.0 leaves the cutter no addendum"),
    (rim_thickness_factor, "rim_over_height: .* is not above 0.5", [0.5, 0.0, nan]),
    (lambda: root_section(2, 3.0, -1.0, 1.6), ("^teeth:", "^profile_shift:", "^tip_diameter:")),
    (lambda: face_load_factor(0.9, 0.2), r"contact_face_load_factor: 0.9 is not in \[1, inf\)"),
    (lambda: face_load_factor(1.2, 0.0), r"height_over_width: 0.0 is not positive"),
    (lambda: helix_angle_factor(0.2, -1.0), r"overlap_ratio: -1.0 is negative"),
    (lambda: helix_angle_factor(2.0, 1.0), r"helix_angle: 2.0 rad is not within 90 deg"),
    (lambda: nominal_root_stress(1.0, 0.0, 1.0, 1.0), r"face_width: 0.0 is not positive"),
)
