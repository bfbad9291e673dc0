"""Tooth thickness and tips of scenes as engineers give them: by allowance, span, balls, pins or tip alteration."""

from math import asin, cos, pi, radians, sin, tan

import pytest
from numpy.testing import assert_allclose

from loaded_tca import GeometryError, InputError, parse_scene, read_scene
from tests.refusals import refused_calls
from tests.samples.results import SCENES

THIN = -0.06
INVERTED = 1e-10  # of lengths after involutes that are inverted: 2e-16 seen
"""Allowance [mm]."""


def scene(**changes):
    return read_scene(SCENES / "helical.toml").with_changes(
        {key.replace("__", "."): value for key, value in changes.items()}
    )


def thinned():
    return scene(pinion__thickness_allowance_um=1e3 * THIN)


def test_allowance_span_balls_and_pins_make_the_same_gear():
    by_allowance = thinned().mesh().pinion
    assert_allclose(by_allowance.thickness_allowance, THIN)
    span, balls = by_allowance.span_measurement(), by_allowance.ball_measurement(5.25)
    by_span = scene(pinion__span_measurement_mm=span)
    by_span_of_six = scene(pinion__span_measurement_mm=by_allowance.span_measurement(6), pinion__span_teeth=6)
    by_balls = scene(pinion__ball_measurement_mm=balls, pinion__ball_diameter_mm=5.25)
    pins = by_allowance.pin_measurement(5.25)
    by_pins = scene(pinion__pin_measurement_mm=pins, pinion__pin_diameter_mm=5.25)
    by_thickness = scene(pinion__normal_tooth_thickness_mm=3.0 * 0.5 * pi + THIN)  # m_n pi/2, without a shift
    for other in (by_span, by_span_of_six, by_balls, by_pins, by_thickness):
        assert_allclose(other.mesh().pinion.thickness_allowance, THIN, atol=1e-9)
        assert_allclose(other.mesh().pinion.root_radius, by_allowance.root_radius, rtol=INVERTED)
        assert parse_scene(other.to_toml()) == other


def test_flanks_of_the_pair_keep_their_involute_and_the_teeth_are_thinner():
    nominal, thin = scene().pair(), thinned().pair()
    form, thinner = nominal.pinion.form, thin.pinion.form
    gear = thinned().mesh().pinion
    angle = -THIN / (2.0 * gear.reference_radius * 0.96592582628)  # cos(15 deg): the allowance is normal
    assert_allclose(form.half_thickness_angle - thinner.half_thickness_angle, angle, rtol=1e-8)


def test_profile_shift_that_follows_from_the_centre_distance_is_that_of_nominal_teeth():
    given = {"pair__centre_distance_mm": 142.0, "pinion__profile_shift": 0.1}
    nominal, thin = scene(**given).mesh(), scene(**given, wheel__thickness_allowance_um=-80.0).mesh()
    assert thin.wheel.profile_shift == nominal.wheel.profile_shift
    assert abs(nominal.backlash) < 1e-9
    assert thin.backlash > 0.08


def test_check_tells_thickness_backlash_and_tips():
    thin = scene(pinion__thickness_allowance_um=-60.0, wheel__ball_measurement_mm=185.0, wheel__ball_diameter_mm=5.5)
    rows = {name: cells for name, *cells in thin.geometry_rows()}
    mesh = thin.mesh()
    assert rows["thickness allowance A_sn [um]"][0] == "-60.0"
    assert rows["generating profile shift x_E"][0] == f"{-0.03 / (3.0 * 0.36397023):.4f}"
    assert rows["normal backlash j_bn [mm]"] == [f"{mesh.normal_backlash:.4f}"]
    assert rows["measure over balls M_dK [mm]"] == ["-", "185.0000"]
    assert rows["span W_k over k teeth [mm]"][0] == f"{mesh.pinion.span_measurement():.4f} (5)"
    assert rows["measure over pins M_dR [mm]"][0] == "-"
    assert rows["measure over pins M_dR [mm]"][1] == f"{mesh.wheel.pin_measurement(5.5):.4f}"
    assert float(rows["measure over pins M_dR [mm]"][1]) > 185.05  # 57 helical teeth: d_K (1 - cos(90 deg/57)) more
    plain = {name for name, *_ in scene().geometry_rows()}
    assert "thickness allowance A_sn [um]" not in plain
    assert "span W_k over k teeth [mm]" in plain


def test_check_says_why_a_gear_has_no_span():
    """A span of helical teeth must end on their face: W_k sin(beta_b) below b."""
    narrow = scene(pinion__face_width_mm=5.0)
    rows = {name: cells for name, *cells in narrow.geometry_rows()}
    span, base_helix = scene().mesh().pinion.span_measurement(5), asin(sin(radians(15.0)) * cos(radians(20.0)))
    assert rows["span W_k over k teeth [mm]"][0] == "-"
    assert rows["  no span W_k of the pinion"] == [
        f"a span over 5 teeth needs a face width above {span * sin(base_helix):.4g} mm"
    ]
    assert "  no span W_k of the wheel" not in rows
    assert "  no span W_k of the pinion" not in {name for name, *_ in scene().geometry_rows()}
    # teeth cut down below the place where the span would touch
    low = {name: cells for name, *cells in scene(pinion__tip_diameter_mm=103.0).geometry_rows()}
    assert "touches no flank: it would be at diameter" in low["  no span W_k of the pinion"][0]


def test_check_has_no_measure_over_pins_of_a_face_too_narrow_for_them():
    """57 teeth of 15 degrees: pins stand opposite half an axial pitch apart, pi m_n/(2 sin(beta)) = 18.2 mm."""
    narrow = scene(wheel__face_width_mm=18.0, wheel__ball_measurement_mm=185.0, wheel__ball_diameter_mm=5.5)
    rows = {name: cells for name, *cells in narrow.geometry_rows()}
    assert rows["measure over balls M_dK [mm]"] == ["-", "185.0000"]
    assert rows["measure over pins M_dR [mm]"] == ["-", "-"]


def test_thickness_far_from_the_profile_shift_is_asked_about_with_the_shift_that_fits():
    """x = 0.2 and A_sn = -30 um, measured, on a drawing that has no x: s_n = m_n (pi/2 + 2 x_E tan(alpha_n))."""
    drawn = scene(pinion__profile_shift=0.2, pinion__thickness_allowance_um=-30.0)
    assert drawn.missing_shifts() == []
    span = drawn.mesh().pinion.span_measurement(5)
    measured = scene(pinion__profile_shift=None, pinion__span_measurement_mm=span, pinion__span_teeth=5)
    generating = 0.2 - 0.03 / (2.0 * 3.0 * tan(radians(20.0)))
    (sentence,) = measured.missing_shifts()
    assert f"of the pinion: the allowance A_sn is {2e3 * 3.0 * generating * tan(radians(20.0)):+.4g} um" in sentence
    assert "profile_shift = 0.0000, the default, since none is given" in sentence
    assert f"with profile_shift = {generating:.4f} the same teeth have no allowance" in sentence
    fitting = measured.with_changes({"pinion.profile_shift": generating})
    assert fitting.missing_shifts() == []
    assert abs(fitting.mesh().pinion.thickness_allowance) < 1e-9
    assert_allclose(fitting.mesh().pinion.root_radius, drawn.mesh().pinion.root_radius, rtol=INVERTED)


@pytest.mark.parametrize(
    ("shift", "allowance", "distance", "words"),
    [
        (0.0, 29.0, None, None),
        (0.0, 31.0, None, "which is given"),
        (None, 31.0, None, "the default"),
        (None, -299.0, None, None),
        (None, -301.0, None, "the default"),
        (0.0, -301.0, None, None),
        (None, 31.0, 142.0, "which follows from the centre distance"),
        (None, -301.0, 142.0, None),
    ],
)
def test_thickness_is_asked_about_from_a_hundredth_of_the_module_on_or_a_tenth_below(shift, allowance, distance, words):
    """Of module 3; teeth that are thinner by more than a tenth are no question where x is given, or follows."""
    other = None if distance is None else 0.1
    one = scene(
        pair__centre_distance_mm=distance,
        pinion__profile_shift=other,
        wheel__profile_shift=shift,
        wheel__thickness_allowance_um=allowance,
    )
    found = one.missing_shifts()
    assert len(found) == (words is not None)
    assert all(words in sentence for sentence in found)


def test_tip_diameter_of_a_long_addendum_asks_for_the_profile_shift():
    """d_a = d + 2 m_n (1 + x): a tip of x = 0.15 beside x = 0 is 0.15 modules too long."""
    tip = 2.0 * scene(pinion__profile_shift=0.15).mesh().pinion.tip_radius
    drawn = scene(pinion__tip_diameter_mm=tip)
    (sentence,) = drawn.missing_shifts()
    assert sentence.startswith("tip of the pinion: tip_diameter_mm is that of a tip alteration of +0.15 modules")
    assert "with profile_shift = 0.1500 the tip has no alteration" in sentence
    assert drawn.with_changes({"pinion.profile_shift": 0.15}).missing_shifts() == []
    assert drawn.with_changes({"pinion.profile_shift": 0.0}).missing_shifts() == []  # which is said, and meant
    assert scene(pinion__tip_diameter_mm=tip - 0.4).missing_shifts() == []  # 0.2/3 modules less: below a tenth
    assert scene(pinion__tip_diameter_mm=tip - 2.0).missing_shifts() == []  # a shortened tip


def test_backlash_that_looks_like_missing_profile_shifts_is_asked_about():
    """Far apart by little more, da: j_bn = 2 da sin(alpha_wt), within a hundredth while the angle hardly changes."""
    close = scene().mesh()
    limit = 0.2 * 3.0 / (2.0 * sin(close.working_pressure_angle))
    for part, asked in ((0.9, False), (1.1, True)):
        far = scene(pair__centre_distance_mm=close.working_centre_distance + part * limit)
        sentences = far.missing_shifts()
        assert len(sentences) == asked
        for sentence in sentences:
            assert f"wide backlash: {far.mesh().normal_backlash:.3g} mm along the normal" in sentence
            assert "the sum of the profile shifts is 0.0000" in sentence
            assert f"a sum of {far.mesh().profile_shift_sum_without_backlash:.4f} leaves no backlash" in sentence
        assert far.with_changes({"pinion.profile_shift": 0.0}).missing_shifts() == []  # the other follows


def test_tip_alteration_is_told_and_shortens():
    short = scene(pinion__tip_alteration_coefficient=-0.1)
    assert_allclose(scene().mesh().pinion.tip_radius - short.mesh().pinion.tip_radius, 0.3)
    rows = {name: cells for name, *cells in short.geometry_rows()}
    assert rows["tip alteration coefficient k"] == ["-0.1000", "0.0000"]


def test_backlash_of_allowances_is_used_up_by_an_error_of_the_centre_distance():
    nearer = {"mounting__centre_distance_error_mm": -0.05}
    assert scene(**nearer).interferences() == []  # nominal teeth say nothing of backlash
    thin = scene(**nearer, pinion__thickness_allowance_um=-60.0)
    assert thin.interferences() == []
    far = scene(mounting__centre_distance_error_mm=-0.3, pinion__thickness_allowance_um=-60.0)
    assert "negative backlash" in far.interferences()[0]


test_thickness_keys_refuse = refused_calls(
    (
        lambda: scene(pinion__thickness_allowance_um=-40.0, pinion__span_measurement_mm=41.4),
        "^pinion.thickness_allowance_um: found -40 beside span_measurement_mm = 41.4; give one of them",
    ),
    (
        lambda: scene(wheel__span_measurement_mm=60.2, wheel__ball_measurement_mm=185.0, wheel__ball_diameter_mm=5.5),
        "^wheel.span_measurement_mm: found 60.2 beside ball_measurement_mm = 185; give one",
    ),
    (
        lambda: scene(
            wheel__pin_measurement_mm=185.1,
            wheel__pin_diameter_mm=5.5,
            wheel__ball_measurement_mm=185.0,
            wheel__ball_diameter_mm=5.5,
        ),
        "^wheel.ball_measurement_mm: found 185 beside pin_measurement_mm = 185.1; give one",
    ),
    (lambda: scene(pinion__pin_diameter_mm=5.0), "^pinion.pin_diameter_mm: found 5; it needs pin_measurement_mm"),
    (
        lambda: scene(pinion__pin_measurement_mm=113.0, pinion__pin_diameter_mm=9.0).mesh(),
        "^pinion: pin_measurement_mm: 113 mm over pins of 9 mm",
    ),
    (
        lambda: scene(pinion__normal_tooth_thickness_mm=0.5).mesh(),
        "^pinion: normal_tooth_thickness_mm: 0.5 mm makes the teeth 4.212 mm thinner than nominal, where it is 4.71239",
    ),
    (lambda: scene(pinion__span_teeth=5), "^pinion.span_teeth: found 5; it needs span_measurement_mm"),
    (lambda: scene(pinion__ball_diameter_mm=5.0), "^pinion.ball_diameter_mm: found 5; it needs ball_measurement_mm"),
    (
        lambda: scene(pinion__ball_measurement_mm=113.0),
        "^pinion.ball_diameter_mm: missing; ball_measurement_mm = 113 needs it",
    ),
    (
        lambda: scene(pinion__tip_diameter_mm=111.0, pinion__tip_alteration_coefficient=-0.1),
        "^pinion.tip_diameter_mm: found 111 beside tip_alteration_coefficient = -0.1; give one of them",
    ),
    (
        lambda: scene(pinion__span_measurement_mm=41.4, pinion__span_teeth=4).mesh(),
        "^pinion: span_measurement_mm: 41.4 mm over 4 teeth makes the teeth 9.392 mm thicker .* is 32.5744 mm",
    ),
    (
        lambda: scene(pinion__span_measurement_mm=6.0, pinion__span_teeth=1).mesh(),
        "^pinion: span_teeth: a span over 1 teeth touches no flank",
    ),
    (
        lambda: scene(pinion__ball_measurement_mm=113.0, pinion__ball_diameter_mm=9.0).mesh(),
        "^pinion: ball_measurement_mm: 113 mm over balls of 9 mm",
    ),
    (
        lambda: scene(pinion__thickness_allowance_um=-1600.0).mesh(),
        "^pinion: thickness_allowance_um: -1.6 mm is",
    ),
)


def test_pointed_teeth_stay_a_matter_of_geometry():
    with pytest.raises(GeometryError, match="pointed tooth"):
        scene(pinion__profile_shift=1.6, pinion__thickness_allowance_um=10.0, pinion__teeth=12).mesh()


def test_scene_without_thickness_is_the_scene_of_before():
    """To the last bit: the nominal gear is not made anew."""
    gear = scene().mesh().pinion
    assert gear.thickness_allowance == 0.0
    assert gear.generating_profile_shift == gear.profile_shift


def test_measures_of_a_gear_may_be_given_to_both():
    pair = scene(pinion__span_measurement_mm=41.38, wheel__span_measurement_mm=60.15).mesh()
    assert pair.pinion.thickness_allowance < 0.0
    assert pair.wheel.thickness_allowance < 0.0
    assert_allclose(pair.wheel.span_measurement(7), 60.15, rtol=INVERTED)
    with pytest.raises(InputError):
        scene(pinion__span_measurement_mm=-1.0)
