from math import cos, pi, radians, sin, sqrt

from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.reference import iso6336
from loaded_tca.reference.hertz import line_contact
from tests.refusals import refused_calls

ROUNDING = 1e-12  # a few dozen floating point operations
STEEL = 206000.0 / (2.0 * (1.0 - 0.3**2))
STRESS = {
    "tangential_force": 127352.0,
    "pinion_reference_diameter": 141.34,
    "face_width": 100.0,
    "gear_ratio": 103 / 17,
    "factors": 372.4,
}


def test_virtual_teeth_as_printed_in_iso_tr_6336_30():
    helix, pressure = radians(15.8), radians(20)
    assert_allclose(iso6336.virtual_teeth(17, helix, pressure), 18.905, atol=5e-4)
    assert_allclose(iso6336.virtual_teeth(103, helix, pressure), 114.543, atol=5e-4)


def test_virtual_teeth_of_a_spur_gear_are_its_teeth():
    assert iso6336.virtual_teeth(23, 0.0, radians(20)) == 23


def test_stiffness_chain_as_printed_in_iso_tr_6336_30():
    virtual = [iso6336.virtual_teeth(teeth, radians(15.8), radians(20)) for teeth in (17, 103)]
    theoretical = iso6336.theoretical_single_stiffness((virtual[0], virtual[1]), (0.145, 0.0))
    single = iso6336.single_stiffness(theoretical, radians(15.8), basic_rack_factor=iso6336.basic_rack_factor(1.4))
    mean = iso6336.mesh_stiffness(single, 1.549090)
    assert_allclose([theoretical, single, mean], [17.85584, 12.37047, 17.46485], atol=5e-6)


@given(st.floats(0.2, 0.6), st.floats(10.0, 500.0), st.floats(5.0, 100.0), st.floats(1.0, 8.0))
def test_contact_stress_of_a_spur_gear_is_line_contact_hertz(angle, force, radius, ratio):
    """At a contact ratio of 1 the standard's formula is Hertz at the pitch point of a pair without shift."""
    width = 10.0
    factors = (
        iso6336.zone_factor(angle, angle, 0.0)
        * iso6336.elasticity_factor(STEEL)
        * iso6336.contact_ratio_factor(1.0, 0.0)
        * iso6336.helix_angle_factor(0.0)
    )
    stress = iso6336.nominal_contact_stress(force, 2.0 * radius, width, ratio, factors)
    curvature = (1.0 + 1.0 / ratio) / (radius * sqrt(1.0 - cos(angle) ** 2))
    hertz = line_contact(force / cos(angle) / width, curvature, STEEL)
    assert_allclose(stress, hertz.max_pressure, rtol=ROUNDING)


@given(st.floats(1.0, 2.5))
def test_contact_ratio_factor_is_continuous_in_the_overlap_and_constant_above_1(ratio):
    assert_allclose(iso6336.contact_ratio_factor(ratio, 0.0), sqrt((4.0 - ratio) / 3.0), rtol=ROUNDING)
    at_one = iso6336.contact_ratio_factor(ratio, 1.0)
    assert_allclose(at_one, 1.0 / sqrt(ratio), rtol=ROUNDING)
    assert iso6336.contact_ratio_factor(ratio, 3.0) == at_one
    assert_allclose(iso6336.contact_ratio_factor(ratio, 1.0 - 1e-9), at_one, rtol=1e-8)


def test_helix_angle_factor_is_that_of_2006_and_not_its_inverse():
    assert iso6336.helix_angle_factor(0.0) == 1.0
    assert iso6336.helix_angle_factor(0.3) == iso6336.helix_angle_factor(-0.3) > 1.0


@given(st.floats(1e2, 1e6))
def test_contact_stress_grows_with_the_root_of_the_force(force):
    once, twice = (
        iso6336.nominal_contact_stress(**{**STRESS, "tangential_force": load}) for load in (force, 4.0 * force)
    )
    assert_allclose(twice, 2.0 * once, rtol=ROUNDING)


def test_basic_rack_factor_is_1_for_the_reference_rack():
    assert iso6336.basic_rack_factor(1.2, radians(20)) == 1.0
    assert_allclose(iso6336.basic_rack_factor(1.2, radians(25)), 1.1, rtol=ROUNDING)


def test_stiffness_grows_with_the_modulus_and_the_blank_factor():
    steel = iso6336.single_stiffness(17.0, 0.0)
    assert_allclose(steel, 13.6, rtol=ROUNDING)
    assert_allclose(iso6336.single_stiffness(17.0, 0.0, youngs_modulus=103000.0), 0.5 * steel, rtol=ROUNDING)
    assert_allclose(iso6336.single_stiffness(17.0, 0.0, gear_blank_factor=0.9), 0.9 * steel, rtol=ROUNDING)


def test_stiffness_falls_below_100_newton_per_mm():
    full = iso6336.single_stiffness(17.0, 0.1)
    assert iso6336.single_stiffness(17.0, 0.1, specific_load=500.0) == full
    assert_allclose(iso6336.single_stiffness(17.0, 0.1, specific_load=6.25), 0.5 * full, rtol=ROUNDING)


def test_ring_has_the_contact_stress_that_kisssoft_prints():
    """Second stage of the NREL gearbox, planet 36 in ring 93: Z_H 2.85, Z_eps 0.891, sigma_H0 312.44 MPa."""
    pressure, working = radians(20.0), radians(15.630)
    factors = iso6336.zone_factor(pressure, working, 0.0) * iso6336.elasticity_factor(STEEL) * 0.891
    stress = iso6336.nominal_contact_stress(285900.438, 756.0, 550.0, -1835.220 / 710.408, factors)
    assert_allclose(stress, 312.44, rtol=1e-3)  # Z_eps has three digits


def test_ring_has_the_stiffness_that_kisssoft_prints():
    """The same pair, C_R 0.862 and C_B 0.975: 14.053 N/(mm um), with z_n inf for the ring of x 0.1171."""
    theoretical = iso6336.theoretical_single_stiffness((36.0, float("inf")), (0.5039, 0.1171))
    stiffness = iso6336.single_stiffness(theoretical, 0.0, basic_rack_factor=0.975, gear_blank_factor=0.862)
    assert_allclose(stiffness, 14.053, rtol=6e-4)  # C_R has three digits


def test_mesh_stiffness_of_one_pair_is_the_single_stiffness():
    assert iso6336.mesh_stiffness(14.0, 1.0) == 14.0


def single_contact(teeth=(16, 24), tips=(41.318 / 33.8289, 59.272 / 50.7434), ratio=1.4626, overlap=0.0):
    """Factors of the FZG C14 pair: r_b 33.8289 and 50.7434, r_a 41.318 and 59.272 mm as GEARpie prints them."""
    return iso6336.single_contact_factors(teeth, tips, radians(22.43934), ratio, overlap)


def test_single_contact_factor_of_fzg_c14_is_hertz_at_the_printed_point_b():
    """T1T2 34.93, AE 19.43, AB 6.14 mm, E at the pinion's tip: radii at B and C on the line of action."""
    to_e = sqrt(41.318**2 - 33.8289**2)
    b, c = to_e - 19.43 + 6.14, 33.8289 * sqrt(1.0 / cos(radians(22.43934)) ** 2 - 1.0)
    expected = [line_contact(100.0, 1.0 / radius + 1.0 / (34.93 - radius), STEEL).max_pressure for radius in (b, c)]
    factor, other = single_contact()
    assert_allclose(factor, expected[0] / expected[1], rtol=1e-3)  # lengths are printed to 0.005 mm
    assert factor > other == 1.0


def test_single_contact_factor_goes_to_1_with_the_overlap():
    spur, helical = single_contact(overlap=0.0)[0], single_contact(overlap=0.25)[0]
    assert_allclose(helical - 1.0, 0.75 * (spur - 1.0), rtol=1e-9)  # differences of numbers about 1
    assert single_contact(overlap=1.0) == single_contact(overlap=3.0) == (1.0, 1.0)


def test_single_contact_factor_of_a_pinion_in_a_ring_is_hertz_at_point_b():
    """Pinion 20 and ring -60 of module 1, alpha 20 deg, no shifts; at a contact ratio of 1.5."""
    base, angle, pitch = (10.0 * cos(radians(20)), 30.0 * cos(radians(20))), radians(20), pi * cos(radians(20))
    apart, end = 20.0 * sin(angle), 6.0  # roll length of the pinion at E; B lies one pitch before it
    ring_at_a = end - 1.5 * pitch + apart
    tips = sqrt(1.0 + (end / base[0]) ** 2), sqrt(1.0 + (ring_at_a / base[1]) ** 2)
    relative = [1.0 / roll - 1.0 / (roll + apart) for roll in (end - pitch, 10.0 * sin(angle))]
    first, second = iso6336.single_contact_factors((20, -60), tips, angle, 1.5, 0.0)
    assert_allclose(first, (relative[0] / relative[1]) ** 0.5, rtol=ROUNDING)
    assert first > second == 1.0


def test_gears_exchanged_exchange_their_factors():
    tips = (1.22, 1.17)
    assert single_contact(tips=tips) == single_contact((24, 16), tips[::-1])[::-1]


@given(st.floats(1.0, 2.5))
def test_transverse_load_factor_is_bounded_by_one_pair_that_carries_all(ratio):
    """Over the length b/Z_eps^2 that sigma_H0 has: of spur gears b carries, of an overlap of 1 a mean line."""
    assert_allclose(iso6336.largest_transverse_load_factor(ratio, 0.0), 3.0 / (4.0 - ratio), rtol=ROUNDING)
    assert_allclose(iso6336.largest_transverse_load_factor(ratio, 1.2), ratio + 1.2, rtol=ROUNDING)


test_iso6336_refuses = refused_calls(
    (
        lambda: single_contact(teeth=(0, 24), tips=(0.9, 1.2), ratio=1.0, overlap=-1.0),
        ("^teeth: 0 is below 1", "^tip_over_base: 0.9 is not", "^transverse_contact_ratio: 1.0 is", "^overlap_ratio:"),
    ),
    (lambda: single_contact(teeth=(24, -20)), "teeth: -20 is below 1, and no ring around 24 teeth"),
    (lambda: single_contact(ratio=3.5), "transverse_contact_ratio: 3.5 reaches beyond a base circle"),
    (lambda: iso6336.contact_ratio_factor(4.0, 0.0), "transverse_contact_ratio: 4.0 is not below 4"),
    (lambda: iso6336.largest_transverse_load_factor(4.5, 0.0), "transverse_contact_ratio: 4.5 is not below 4"),
    (
        lambda angle: iso6336.zone_factor(radians(20), angle, 0.0),
        r"working_pressure_angle: .* rad is not between 0 and 90 deg",
        [0.0, -0.1, pi / 2.0],
    ),
    (lambda: iso6336.elasticity_factor(0.0), r"contact_modulus: 0.0 is not positive and finite"),
    (lambda: iso6336.contact_ratio_factor(-1.0, 0.0), r"transverse_contact_ratio: -1.0 is not positive"),
    (lambda: iso6336.contact_ratio_factor(1.5, -0.1), r"overlap_ratio: -0.1 is negative or not finite"),
    (
        lambda: iso6336.theoretical_single_stiffness((17.0, 0.0), (0.0, 0.0)),
        r"wheel_virtual_teeth: 0.0 is not positive",
    ),
    (lambda: iso6336.single_stiffness(17.0, 0.0, youngs_modulus=float("nan")), r"youngs_modulus: nan is not positive"),
    (
        lambda ratio: iso6336.nominal_contact_stress(**{**STRESS, "gear_ratio": ratio}),
        "gear_ratio: .* is neither positive nor below -1, or not finite",
        [0.0, -1.0, float("inf")],
    ),
    (lambda: iso6336.mesh_stiffness(0.0, 1.5), r"single_stiffness: 0.0 is not positive"),
    (
        lambda: iso6336.nominal_contact_stress(**{**STRESS, "tangential_force": -1.0, "face_width": 0.0}),
        ("^tangential_force: -1.0 is not positive and finite$", "^face_width: 0.0 is not positive and finite$"),
    ),
)
