"""Face-milled pairs: numbers of published and constructed settings, perturbed settings, what is refused."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca import GeometryError, sample_separation, trace_contact
from loaded_tca.flanks import FlankModifications
from loaded_tca.pairs.bevel import BevelMounting, face_milled_pair
from loaded_tca.reference import hertz
from tests.refusals import refused_calls
from tests.samples.face_milled import duplex_paper_gears, matched_pinion, on_machine, published_pinion, published_wheel
from tests.samples.gear_pairs import highest_on_grid

ARCSEC = math.degrees(1.0) * 3600.0
NONE = FlankModifications()


def matched(**options):
    return face_milled_pair(matched_pinion(), published_wheel(), **options)


def top_of(pair):
    """Angle and transmission error of the top of its curve [rad]: by narrower and narrower rows, then a polynomial."""
    middle, half = 0.0, 0.5 * pair.pitch
    for _ in range(4):
        angles = middle + np.linspace(-half, half, 9)
        errors = trace_contact(pair, angles).transmission_error
        middle, half = angles[np.argmax(errors)], 0.25 * half
    curve = np.polynomial.Polynomial.fit(angles, errors, 4)
    top = min(curve.deriv().roots(), key=lambda root: abs(root - middle)).real
    return top, curve(top)


def from_top(pair, parts):
    """Contact at parts of a pitch from the top, and the transmission error counted from there [arcsec]."""
    angle, highest = top_of(pair)
    path = trace_contact(pair, angle + np.asarray(parts) * pair.pitch)
    return path, ARCSEC * (path.transmission_error - highest)


# Numbers computed independently from the same settings; tolerances are their last printed digits


@pytest.mark.quick_cases("False")
@pytest.mark.parametrize("exact", [True, False])
def test_transmission_error_of_the_matched_pair_is_that_of_the_five_equations(exact):
    _, error = from_top(matched(exact=exact), np.arange(-4, 5) / 8.0)
    expected = [-6.018, -3.361, -1.484, -0.368, 0.0, -0.364, -1.445, -3.232, -5.711]
    assert_allclose(error, expected, atol=1e-3)


@pytest.mark.thorough
def test_mean_point_curvatures_and_pressure_of_the_matched_pair():
    pair = matched(exact=True)
    path, _ = from_top(pair, [0.0])
    contact = path[0]
    assert_allclose([contact.pinion_radius, contact.pinion_axial], [34.094573, 108.697640], rtol=0.0, atol=2e-6)
    assert_allclose([contact.wheel_radius, contact.wheel_axial], [111.255550, 24.491209], rtol=0.0, atol=2e-6)
    load = 300e3 / contact.pinion_lever
    curvatures = sample_separation(pair, contact, cells=(8, 8), load=load).curvatures
    assert_allclose(sorted(curvatures), [3.954798e-4, 6.658058e-2], rtol=2e-7)
    point = hertz.point_contact(load, curvatures, pair.contact_modulus)
    assert_allclose([point.semi_major, point.semi_minor], [9.5607, 0.38817], rtol=2e-5)
    assert_allclose(point.max_pressure, 1466.36, atol=0.01)


@pytest.mark.thorough
def test_published_pair_touches_on_the_tip_of_the_wheel():
    pair = face_milled_pair(published_pinion(), published_wheel())
    path, error = from_top(pair, [-0.5, -0.25, 0.0, 0.25, 0.5])
    assert_allclose(error[[0, -1]], [-44.2, -45.1], atol=0.05)
    assert path.on_edge[:-1].all()
    tip = pair.wheel.flank.edges(path.wheel_radius, path.wheel_axial)[0].value
    assert_allclose(tip[:-1], 0.0, atol=1e-8)


def test_published_pair_touches_on_the_tip_of_the_pinion_on_its_coast_side():
    pair = face_milled_pair(published_pinion(), published_wheel(), pinion_flank="convex")
    path, _ = from_top(pair, [-0.25, 0.0, 0.25])
    assert path.on_edge.all()
    assert_allclose(pair.pinion.flank.edges(path.pinion_radius, path.pinion_axial)[0].value, 0.0, atol=1e-8)


def test_pair_d_of_duplex_paper_has_a_centred_path():
    gears = duplex_paper_gears()
    pair = face_milled_pair(*gears)
    path, error = from_top(pair, [-0.5, 0.0, 0.5])
    assert_allclose(error, [-12.29, 0.0, -12.50], atol=0.006)
    assert not path.on_edge.any()
    assert_allclose(math.hypot(path.pinion_radius[1], path.pinion_axial[1]), 70.6, atol=2.0)  # of 60.6 to 80.6


def test_duplex_paper_as_printed_touches_at_the_toe():
    pair = face_milled_pair(*duplex_paper_gears(pinion_radial=58.38392))
    path = trace_contact(pair, np.linspace(-0.5, 0.5, 5) * pair.pitch)
    assert path.on_edge.all()


# The pair


def with_hand(gear, hand):
    return replace(gear, blank=replace(gear.blank, hand=hand))


def test_pair_knows_its_sizes():
    pair = matched()
    assert pair.teeth == (19, 62)
    assert_allclose(pair.base_radii[0] / pair.base_radii[1], pair.ratio)
    assert_allclose(pair.module, 2.94, atol=0.005)  # m_et R_m/R_e cos 35 deg
    assert (pair.sense, pair.driving) == (-1, 1)  # the concave flank of a left-hand pinion


@pytest.mark.parametrize("driving", ["pinion", "wheel"])
@pytest.mark.parametrize("flank", ["concave", "convex"])
def test_sense_of_rotation_follows_from_flank_hand_and_driving_gear(flank, driving):
    gears = published_pinion(), published_wheel()
    pair = face_milled_pair(*gears, pinion_flank=flank, driving=driving)
    assert pair.pinion.flank.side == pair.wheel.flank.side == pair.sense * pair.driving
    hands = [with_hand(gear, hand) for gear, hand in zip(gears, ("right", "left"), strict=True)]
    assert face_milled_pair(*hands, pinion_flank=flank, driving=driving).sense == -pair.sense


def test_mirrored_pair_has_the_same_transmission_error():
    gears = matched_pinion(), published_wheel()
    mirrored = [with_hand(gear, hand) for gear, hand in zip(gears, ("right", "left"), strict=True)]
    first, second = (trace_contact(face_milled_pair(*pair), [-0.1, 0.0, 0.1]) for pair in (gears, mirrored))
    # rad; angles of order 0.1, beside rtol
    assert_allclose(first.transmission_error, second.transmission_error, atol=1e-13)
    assert_allclose(first.point, second.point * [1.0, -1.0, 1.0], atol=1e-9)


@pytest.mark.thorough
def test_spline_pair_is_the_exact_pair():
    angles = np.linspace(-0.15, 0.15, 5)
    fast, exact = (trace_contact(matched(exact=exact), angles) for exact in (False, True))
    assert_allclose(fast.transmission_error, exact.transmission_error, atol=1e-8 / 34.0)  # 1e-8 mm
    assert_allclose(fast.point, exact.point, atol=1e-4)


def test_modifications_take_material_off_at_the_ends_of_the_flank():
    plain = matched()
    crowned = matched(
        modifications=(FlankModifications(lead_crowning=0.01, profile_crowning=0.02, tip_relief=0.0), NONE)
    )
    rho, z = plain.pinion.flank.grid(3, 3)
    removed = crowned.pinion.flank.removal(rho, z).value
    # mm, also below: parabolas whose origin is rounded
    assert_allclose(removed, [[0.03, 0.02, 0.03], [0.01, 0.0, 0.01], [0.03, 0.02, 0.03]], atol=1e-12)
    path = trace_contact(crowned, [0.0, 0.16])
    assert path.transmission_error[1] < trace_contact(plain, [0.16]).transmission_error[0]


def test_relief_starts_at_a_diameter_of_the_mean_section():
    pinion = matched_pinion()
    middle = pinion.blank.mean_cone_distance
    start = 2.0 * middle * math.sin(pinion.blank.pitch_angle)
    relieved = matched(modifications=(FlankModifications(tip_relief=0.02, tip_relief_start=start), NONE)).pinion.flank
    angle = pinion.blank.pitch_angle + np.array([-1e-3, 0.0, 1e-3])
    removed = relieved.removal(middle * np.sin(angle), middle * np.cos(angle)).value
    assert_allclose(removed[:2], 0.0, atol=1e-12)  # mm; the start of the relief is rounded
    assert removed[2] > 1e-6


@pytest.mark.parametrize("length", [2.0, 3.0])
def test_relief_starts_at_a_length_over_the_form_line(length):
    relieved = FlankModifications(tip_relief=0.02, tip_relief_start_length=length)
    flank = matched(modifications=(relieved, NONE)).pinion.flank
    rho, z = flank.grid(101, 3)
    height, removed = flank.profile_coordinate(rho, z).value, flank.removal(rho, z).value
    assert_array_equal(removed[height <= length], 0.0)
    assert (removed[height > length] > 0.0).all()


def test_wheel_moved_away_lets_the_wheel_lag():
    aligned = trace_contact(matched(), [0.0])[0]
    withdrawn = trace_contact(matched(mounting=BevelMounting(wheel_axial=0.05)), [0.0])[0]
    assert withdrawn.transmission_error < aligned.transmission_error


parts = st.floats(-1.0, 1.0)


def perturbed(gear, radial, root, roll):
    machine = gear.machine
    return on_machine(
        gear,
        radial=machine.radial * (1.0 + 0.01 * radial),
        root_angle=machine.root_angle + math.radians(0.2) * root,
        ratio_of_roll=machine.ratio_of_roll * (1.0 + 0.005 * roll),
    )


@pytest.mark.thorough
@pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")
@settings(max_examples=15)
@given(st.tuples(parts, parts, parts), st.tuples(parts, parts, parts), st.floats(-0.5, 0.5))
def test_perturbed_settings_touch_where_a_dense_grid_does(pinion, wheel, part):
    pair = face_milled_pair(perturbed(matched_pinion(), *pinion), perturbed(published_wheel(), *wheel))
    angle = part * pair.pitch
    found = trace_contact(pair, [angle]).transmission_error[0]
    expected = highest_on_grid(pair, angle)
    assert found >= expected - 1e-12  # rounding
    assert_allclose(found, expected, atol=3e-5)  # what the curved gap drops by between grid points, on an edge slopes


# Failures


def test_pointed_tooth_is_refused_with_its_place():
    pinion = published_pinion()
    tall = replace(pinion, blank=replace(pinion.blank, face_angle=pinion.blank.face_angle + 0.05))
    with pytest.raises(GeometryError, match=r"pinion: pointed tooth: .* mm beyond each other at the tip, .* heel"):
        face_milled_pair(tall, published_wheel())


test_face_milled_pair_refuses = refused_calls(
    (
        lambda: matched(modifications=(FlankModifications(root_relief=0.02, root_relief_start_roll=0.3), NONE)),
        r"^pinion\.modifications\.root_relief_start_roll: the flank is no involute and has no roll angle",
    ),
    (
        lambda: trace_contact(matched(mounting=BevelMounting(wheel_axial=30.0)), [0.0]),
        "no common flank: at none of",
        GeometryError,
    ),
    (
        lambda: face_milled_pair(published_pinion(), replace(published_pinion(), teeth=40), pinion_flank="hollow"),
        ("^pinion_flank:", "^hand:", "^pitch_angle:"),
    ),
    (lambda: matched(driving="motor"), r"driving: 'motor' is not 'pinion' or 'wheel'"),
    (
        lambda: matched(modifications=(FlankModifications(tip_relief=0.02, tip_relief_start=10.0), NONE)),
        r"pinion\.modifications\.tip_relief_start .* 10 mm is not between",
    ),
)
