"""Virtual gears and load factors of bevel and hypoid pairs: printed samples of ISO/TR 10300-30, limits."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.reference import iso10300_1, iso17485
from loaded_tca.reference.iso10300_1 import VirtualPair
from tests.refusals import refused_calls
from tests.samples.hypoid import annex_f3_cones, hypoid_blank
from validation.rating.iso_tr_10300_30 import FOUR_DIGITS, SAMPLES, obtained

DIGIT = 1.5e-3  # 1.5 of the last digit that is printed


def deg(*angles):
    return tuple(math.radians(angle) for angle in angles)


def bevel():
    """Sample 1: spiral bevel pair 14/39, its sheet as printed."""
    return VirtualPair(
        pitch_angles=deg(19.747, 70.253),
        mean_cone_distances=(81.273, 81.273),
        spiral_angles=deg(35.0, 35.0),
        offset_angles=(0.0, 0.0),
        pressure_angle=math.radians(20.0),
        limit_pressure_angle=0.0,
        mean_normal_module=3.2133,
        mean_addenda=(4.837, 1.590),
        effective_width=0.85 * 25.4,
    )


def hypoid():
    """Sample 2: hypoid pair 13/42 with an offset of 15 mm, its sheet to all digits."""
    found, blank = annex_f3_cones(), hypoid_blank()
    cones = found.cones
    return VirtualPair(
        cones.pitch_angles,
        cones.mean_cone_distances,
        found.spiral_angles,
        (cones.axial_offset_angle, cones.offset_angle),
        blank.generated_pressure_angles[0],
        blank.limit_pressure_angle,
        blank.mean_normal_module,
        blank.mean_addenda,
        0.85 * 30.0,
    )


def test_bevel_sample_has_its_printed_numbers():
    pair = bevel()
    assert_allclose(math.degrees(pair.transverse_pressure_angle), 23.957, atol=DIGIT)
    assert_allclose(pair.path_length, 13.120, atol=3e-3)  # of diameters with five digits
    assert_allclose(pair.contact_ratios, [1.165, 1.227], atol=DIGIT)
    assert_allclose(pair.normal_radius, 13.173, atol=DIGIT)
    assert_allclose(math.degrees(pair.contact_line_angle), 13.468, atol=DIGIT)
    assert_allclose(pair.relative_radius, 12.459, atol=DIGIT)


def test_hypoid_sample_has_its_printed_numbers():
    pair = hypoid()
    assert_allclose(pair.contact_ratios, [1.010, 2.096], atol=DIGIT)
    assert_allclose(pair.normal_radius, 19.924, atol=DIGIT)
    assert_allclose(math.degrees(pair.contact_line_angle), 18.459, atol=DIGIT)
    assert_allclose(pair.relative_radius, 17.926, atol=DIGIT)


def test_larger_pairs_have_larger_radii_and_the_same_ratios():
    pair, factor = hypoid(), 2.0
    larger = replace(
        pair,
        mean_cone_distances=tuple(np.multiply(pair.mean_cone_distances, factor)),
        mean_addenda=tuple(np.multiply(pair.mean_addenda, factor)),
        mean_normal_module=pair.mean_normal_module * factor,
        effective_width=pair.effective_width * factor,
    )
    assert_allclose(larger.relative_radius, factor * pair.relative_radius)
    assert_allclose(larger.contact_ratios, pair.contact_ratios)


@pytest.mark.parametrize("name", SAMPLES)
def test_samples_have_their_printed_virtual_gears_and_load_factors(name):
    values, printed = obtained(SAMPLES[name]), SAMPLES[name].printed
    for part in ("z_v", "z_vn", "d_van", "widths", "ratios", "F_vmt", "K_v", "K", "K_Halpha", "K_F0"):
        if part in printed:
            known = printed[part] if isinstance(printed[part], tuple) else (printed[part],)
            assert_allclose(np.ravel(values[part])[: len(known)], known, rtol=FOUR_DIGITS, err_msg=part)


def test_contact_lines_of_a_pair_without_offset_are_symmetric_and_end():
    places, lengths, farthest = bevel().contact_lines
    assert_allclose(places[0], -places[2])
    assert_allclose(lengths[0], lengths[2])
    assert places[0] < farthest
    far = replace(bevel(), mean_addenda=(1.0, 0.5))  # a short path: lines a pitch apart lie outside the zone
    assert_array_equal(np.array(far.contact_lines.lengths)[[0, 2]], 0.0)


def test_straight_teeth_carry_with_their_whole_face():
    pair = replace(bevel(), spiral_angles=(0.0, 0.0), effective_share=1.0)
    assert_allclose(pair.contact_lines.lengths[1], pair.effective_width)
    short = replace(bevel(), spiral_angles=(0.0, 0.0))
    share = 1.0 - (1.0 - 0.85**0.5) * math.sqrt(1.0 - (short.contact_lines.places[1] / (0.5 * short.path_length)) ** 2)
    assert_allclose(short.contact_lines.lengths[1], share * short.effective_width)


def test_dynamic_factor_is_proportional_to_speed_and_continuous_between_ranges():
    def factor(ratio):
        return iso10300_1.dynamic_factor(ratio, 400.0, pitch_deviation=20.0, total_contact_ratio=2.4)

    slow, fast = (float(factor(ratio).K_v) - 1.0 for ratio in (0.1, 0.2))
    assert_allclose(fast, 2.0 * slow, rtol=1e-9)  # the difference of 1.00x costs digits
    # The line over N meets both ranges at their ends: steps of 1e-9 in N.
    for end in (1.25, 1.5):
        below, above = (float(factor(end + step).K_v) for step in (-1e-9, 1e-9))
        assert_allclose(below, above, rtol=1e-7)
    assert "main resonance" in factor([0.2, 1.0]).notes[0]
    assert "between main resonance" in factor(1.3).notes[0]


def test_dynamic_factor_by_grade_is_the_curve_of_agma():
    def of_agma(number, feet_per_minute):
        exponent = 0.25 * (12.0 - number) ** (2.0 / 3.0)
        constant = 50.0 + 56.0 * (1.0 - exponent)
        return ((constant + feet_per_minute**0.5) / constant) ** exponent

    assert round(of_agma(6, 801.1), 3) == 1.377  # Shigley, example 14-4
    for grade in (5, 8):
        factor, notes = iso10300_1.dynamic_factor_by_grade(801.1 * 0.3048 / 60.0, grade)
        assert_allclose(factor, of_agma(16 - grade, 801.1), rtol=4e-3)  # 200 for 60/0.3048
        assert notes == ()
    (note,) = iso10300_1.dynamic_factor_by_grade([1.0, 60.0], 8).notes
    assert note.startswith("K_v: the velocity is above ")


def test_both_stiffnesses_fall_below_full_load():
    assert_allclose(iso10300_1.load_share([50.0, 100.0, 300.0]), [0.5, 1.0, 1.0])


def test_an_offset_of_a_tenth_of_the_radius_ends_the_transverse_load_factor():
    conditions = {"mesh_stiffness": 20.0, "pitch_deviation": 25.0, "total_contact_ratio": 1.8}
    without, half, whole = (
        float(iso10300_1.transverse_load_factor(500.0, relative_offset=each, **conditions)) for each in (0.0, 0.05, 0.1)
    )
    assert_allclose(half - 1.0, 0.5 * (without - 1.0))
    assert whole == 1.0


def test_lengthwise_curvature_helps_small_cutters_within_bounds():
    def factor(radius):
        return iso10300_1.lengthwise_curvature_factor(radius, 80.0, math.radians(35.0))

    assert factor(math.inf) == factor(80.1) == iso10300_1.lengthwise_curvature_factor(10.0, 80.0, 0.0) == 1.0
    assert 1.0 < factor(70.0) < factor(60.0)
    assert factor(10.0) == 1.15


def test_tolerances_double_every_second_grade():
    four, six = (iso17485.single_pitch_tolerance(14, 3.0, 60.0, grade) for grade in (4, 6))
    assert_allclose([four, six], [0.18 + 0.9 + 5.0, 2.0 * (0.18 + 0.9 + 5.0)])


test_virtual_pair_refuses = refused_calls(
    (lambda: replace(bevel(), mean_cone_distances=(81.0, 0.0)), "wheel_cone_distance: 0.0 is not positive"),
    (
        lambda: replace(bevel(), mean_normal_module=-1.0, effective_width=math.inf),
        ("mean_normal_module: -1.0", "effective_width: inf"),
    ),
    (lambda: replace(bevel(), effective_share=1.1), "effective_share: 1.1; allowed above 0, up to 1"),
    (
        lambda: iso17485.single_pitch_tolerance(4, 0.5, 60.0, 12),
        (
            "grade: 12 is not one of 2 to 11",
            "teeth: 4 is not within 5 to 400 of ISO 17485",
            "mean_normal_module: 0.5 mm is not within 1 to 50 mm of ISO 17485",
        ),
    ),
    (
        lambda: iso10300_1.contact_face_load_factor("none", 3),
        ("pattern: 'none' is not one of", "overhung: 3; allowed 0, 1, 2"),
    ),
    (
        lambda: iso10300_1.lengthwise_curvature_factor(0.0, 80.0, 1.6),
        ("cutter_radius: 0.0 mm is not positive", "spiral_angle: 1.6 rad is not between 0 and 90 deg"),
    ),
    (lambda: iso10300_1.reduced_mass((50.0, 100.0), 1.0), "pressure_angle: 1.0 rad is not between 0 and 45 deg"),
    (lambda: iso10300_1.load_share(0.0), "specific_load"),
    (
        lambda: iso10300_1.dynamic_factor_by_grade(-1.0, 10),
        ("outer_velocity", "grade: 10 is not one of 5 to 8"),
    ),
    (
        lambda: iso10300_1.dynamic_factor(-1.0, 400.0, pitch_deviation=-1.0, total_contact_ratio=1.0),
        ("resonance_ratio", "pitch_deviation: -1 um", "total_contact_ratio: 1.0 is not above 1"),
    ),
    (
        lambda: iso10300_1.transverse_load_factor(
            400.0, mesh_stiffness=20.0, pitch_deviation=1.0, total_contact_ratio=2.0, relative_offset=-0.1
        ),
        "relative_offset: -0.1 is negative or not finite",
    ),
)
