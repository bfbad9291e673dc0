"""Keys as drawings write them: inches, diametral pitches, the transverse section."""

import math

import pytest

from loaded_tca import InputError, parse_scene, read_scene
from loaded_tca.scene import scene_from_table
from loaded_tca.scene.keys import Key, Number
from loaded_tca.scene.parse import FAMILIES, VARIANTS
from loaded_tca.scene.section import Section, Subsection, Tables, as_table, contents, entries, keys_of
from loaded_tca.scene.written import METRIC, as_written, in_inches, writing_of
from loaded_tca.stages import read_stage
from loaded_tca.stages.sections import Stage
from loaded_tca.units import ending_of
from tests.refusals import refusals
from tests.samples.results import SCENES

INCHES = """
title = "Spur pair of 8 pitch"
[pair]
type = "cylindrical"
diametral_pitch_per_inch = 8
[pinion]
teeth = 24
face_width_in = 1.25
roughness_Ra_uin = 32
[pinion.modifications]
lead_crowning_in = 0.0003
tip_relief_in = 0.0006
tip_relief_start_in = 3.15
[[pinion.tooth]]
number = 3
modifications.lead_crowning_in = 0.0005
[pinion.shaft]
start_in = -3
torque_at_in = -3
sections = [{ length_in = 6, outer_diameter_in = 1.5 }]
[[pinion.shaft.bearings]]
at_in = -2
radial_stiffness_lbf_per_in = 1e6
[[pinion.shaft.bearings]]
at_in = 2
radial_stiffness_lbf_per_in = 1e6
axial_stiffness_lbf_per_in = 1e6
[[pinion.shaft.loads]]
at_in = 0
force_lbf = [100, 0, 0]
moment_lbf_in = [0, 10, 0]
[wheel]
teeth = 48
face_width_in = 1
[material]
youngs_modulus_ksi = 30000
max_pressure_psi = 300000
poisson_ratio = 0.3
[load]
pinion_torque_lbf_ft = 100
[analysis]
torques_lbf_in = [600, 1200]
"""
METRIC_KEYS = {  # by the inch, 25.4 mm, and the factors of NIST SP 811, appendix B, which has seven digits
    "pair.normal_module_mm": 3.175,
    "pinion.face_width_mm": 31.75,
    "pinion.roughness_Ra_um": 0.8128,
    "pinion.modifications.lead_crowning_um": 7.62,
    "pinion.modifications.tip_relief_um": 15.24,
    "pinion.modifications.tip_relief_start_mm": 80.01,
    "pinion.shaft.start_mm": -76.2,
    "wheel.face_width_mm": 25.4,
    "material.youngs_modulus_MPa": 30e6 * 6.894757e-3,
    "material.max_pressure_MPa": 3e5 * 6.894757e-3,
    "load.pinion_torque_Nm": 100.0 * 1.355818,
    "analysis.torques_Nm": (600.0 * 0.1129848, 1200.0 * 0.1129848),
}
SEVEN_DIGITS = 1e-6
ROUNDING = 1e-12  # of a few functions and products, and of a module written with 16 digits
"""Of the factors of NIST SP 811; a unit of the last one of 1.355818 is 7e-7."""


def at(scene, path):
    for name in path.split("."):
        scene = scene.geometry if name == "pair" else getattr(scene, name)
    return scene


def test_drawing_in_inches_is_the_scene_in_metric_units():
    scene = parse_scene(INCHES)
    for path, value in METRIC_KEYS.items():
        assert at(scene, path) == pytest.approx(value, rel=SEVEN_DIGITS), path
    assert scene.pinion.modifications.lead_crowning_um == 7.62  # decimals as they are, without rounding on the way
    assert scene.pinion.tooth[0].modifications.lead_crowning_um == 12.7
    first, second = scene.pinion.shaft.bearings
    assert (first.at_mm, scene.pinion.shaft.sections[0].length_mm) == (-50.8, 152.4)
    assert second.axial_stiffness_N_per_um == pytest.approx(175.1268, rel=SEVEN_DIGITS)
    (load,) = scene.pinion.shaft.loads
    assert load.force_N == pytest.approx((444.8222, 0.0, 0.0), rel=SEVEN_DIGITS)
    assert load.moment_Nm == pytest.approx((0.0, 1.129848, 0.0), rel=SEVEN_DIGITS)
    again = parse_scene(scene.to_toml())
    assert again == scene
    assert "_in =" not in scene.to_toml()


def sections_of(section, known):
    if section not in known:
        known[section] = keys_of(section)
        inner = [entry.section for _, entry in entries(section).values() if isinstance(entry, Subsection)]
        inner += [entry.kind.section for entry in keys_of(section).values() if isinstance(entry.kind, Tables)]
        for each in inner:
            sections_of(each, known)
    return known


def test_every_key_with_a_unit_of_its_own_has_one_in_inches():
    """Both ways lead to the same key, and what the range allows in inches the key allows: no rounding passes it."""
    known = {}
    for scene in (*dict.fromkeys(FAMILIES.values()), *(scene for scene, _ in VARIANTS.values()), Stage):
        sections_of(scene, known)
    count = 0
    for keys in known.values():
        for name, entry in keys.items():
            if ending_of(name) not in METRIC or name == "polynomial_mm":
                assert in_inches(name, entry) is None
                continue
            writing = in_inches(name, entry)
            assert writing_of(writing.name, keys, {}).key == name
            count += 1
            if isinstance(entry.kind, Number):
                number = writing.kind(entry.kind)
                for limit in (number.low, number.high)[number.above :]:
                    assert entry.read(writing.read(entry, limit)) == pytest.approx(writing.to_key(limit))
                with pytest.raises(ValueError, match="allowed"):
                    writing.read(entry, number.high * (1.0 + 1e-9) + 1e-9)
    assert count > 150


HELICAL = """
[pair]
type = "cylindrical"
{pair}
[pinion]
teeth = 18
face_width_mm = 25
profile_shift = 0.3
[wheel]
teeth = 40
face_width_mm = 25
[material]
youngs_modulus_MPa = 206000
poisson_ratio = 0.3
[load]
pinion_torque_Nm = 100
"""


def test_transverse_section_is_that_of_the_published_gear():
    """Shigley's Mechanical Engineering Design, example 13-2: P_t 6, 18 teeth, helix 25 deg, normal pressure angle 20.

    Pitch diameter 3 in, normal diametral pitch 6.620, transverse pressure angle 21.88 deg, as printed.
    """
    text = HELICAL.replace("_mm = 25", "_in = 1")
    of_pitch = parse_scene(text.format(pair="helix_angle_deg = 25\ntransverse_diametral_pitch_per_inch = 6"))
    gear = of_pitch.mesh().pinion
    assert 2.0 * gear.reference_radius / 25.4 == pytest.approx(3.0, rel=ROUNDING)
    assert 25.4 / of_pitch.geometry.normal_module_mm == pytest.approx(6.620, abs=5e-4)
    assert math.degrees(gear.transverse_pressure_angle) == pytest.approx(21.88, abs=5e-3)
    transverse = "helix_angle_deg = 25\ntransverse_module_mm = 4.233333333333333\ntransverse_pressure_angle_deg = 21.88"
    both = parse_scene(HELICAL.format(pair=transverse))
    assert both.geometry.pressure_angle_deg == pytest.approx(20.0, abs=5e-3)
    assert both.mesh().pinion.reference_radius == pytest.approx(gear.reference_radius, rel=ROUNDING)
    assert both.pinion.profile_shift == 0.3  # of the normal section, in normal modules: tips lie at d/2 + m_n (1 + x)
    assert both.mesh().pinion.tip_radius == pytest.approx(0.5 * 76.2 + 1.3 * 25.4 / 6.0 * math.cos(math.radians(25.0)))


def test_normal_and_bare_pitches():
    normal = parse_scene(HELICAL.format(pair="helix_angle_deg = 25\nnormal_diametral_pitch_per_inch = 10"))
    assert normal.geometry.normal_module_mm == 2.54
    bevel = HELICAL.replace("cylindrical", "straight_bevel").replace("profile_shift = 0.3", "")
    assert parse_scene(bevel.format(pair="diametral_pitch_per_inch = 8")).geometry.outer_module_mm == 3.175
    mean = parse_scene(bevel.format(pair="mean_normal_diametral_pitch_per_inch = 10")).geometry
    assert mean.mean_normal_module_mm == 2.54


def refused(pair, rest=""):
    return parse_scene(HELICAL.format(pair=pair) + rest)


SYSTEM = "which system is meant? Write all of {} in inches, lbf and psi, or in mm, N and MPa"
test_what_is_asked_about_the_pair = refusals(
    refused,
    (
        "helix_angle_deg = 15.0\ndiametral_pitch_per_inch = 8",
        "pair.diametral_pitch_per_inch: found 8; normal or transverse? With helix_angle_deg = 15.0 they differ: write "
        "normal_diametral_pitch_per_inch or transverse_diametral_pitch_per_inch",
    ),
    (
        "normal_diametral_pitch_per_inch = 8\ncentre_distance_mm = 92",
        "pair.normal_diametral_pitch_per_inch: found beside centre_distance_mm; " + SYSTEM.format("[pair]"),
    ),
    (
        "normal_module_mm = 3\ntransverse_module_mm = 3",
        "pair.transverse_module_mm: found 3 beside normal_module_mm = 3; give one of them",
    ),
    (
        "transverse_module_mm = 3\ntransverse_diametral_pitch_per_inch = 8",
        "pair.transverse_diametral_pitch_per_inch: found 8 beside transverse_module_mm = 3; give one of them",
    ),
    (
        "diametral_pitch_per_inch = 0",
        "pair.diametral_pitch_per_inch: found 0; allowed a number from 0.0254 to 1000000",
    ),
    (
        "helix_angle_deg = 45\ntransverse_module_mm = 1500",
        "pair.transverse_module_mm: found 1500; allowed a number above 0, up to 1414.21",
    ),
    (
        "helix_angle_deg = 45\nnormal_module_mm = 3\ntransverse_pressure_angle_deg = 60",
        "pair.transverse_pressure_angle_deg: found 60; allowed a number from 1.41407 to 53.7873",
    ),
    (
        "helix_angle_deg = 95\ntransverse_module_mm = 3",
        "pair.helix_angle_deg: found 95; allowed a number from 0 to 59; its sign is in pinion.hand",
    ),
    (
        'diametral_pitch_per_inch = "8"',
        'pair.diametral_pitch_per_inch: found "8"; allowed a number from 0.0254 to 1000000',
    ),
    plain=True,
)


def changed_line(old, new):
    return parse_scene(INCHES.replace(old, new))


test_what_is_wrong_in_inches_is_told_in_inches = refusals(
    changed_line,
    (
        "face_width_in = 1.25",
        "face_width_in = 1000",
        "pinion.face_width_in: found 1000; allowed a number above 0, up to 393.701",
    ),
    ("face_width_in = 1.25\n", "", "pinion.face_width_in: missing; allowed a number above 0, up to 393.701"),
    (
        "face_width_in = 1.25",
        "face_width_in = 1.25\nface_width_mm = 31.75",
        "pinion.face_width_in: found 1.25 beside face_width_mm = 31.75; give one of them",
    ),
    (
        "face_width_in = 1.25",
        "face_width_in = 1.25\nspan_measurement_in = 1.2345\nball_measurement_in = 4.31301\nball_diameter_in = 0.288",
        "pinion.span_measurement_in: found 1.2345 beside ball_measurement_in = 4.31301; give one of them",
    ),
    (
        "tip_relief_start_in = 3.15\n",
        "",
        "pinion.modifications.tip_relief_start_in: missing or 0; tip_relief_in = 0.0006 needs a value above 0, or "
        "tip_relief_start_roll_deg or tip_relief_start_length_in",
    ),
    (
        "tip_relief_start_in = 3.15\n",
        "tip_relief_start_in = 3.15\nend_relief_in = 0.0002\nend_relief_length_in = 0.75\n",
        "pinion.modifications.end_relief_length_in: found 0.75; allowed up to 0.5 face_width_in = 0.625",
    ),
    (
        "roughness_Ra_uin = 32",
        "tip_chamfer_in = 0.01\ntip_rounding_in = 0.02",
        "pinion.tip_chamfer_in: found 0.01 beside tip_rounding_in = 0.02; give one of them: each ends the flank",
    ),
    (
        "lead_crowning_in = 0.0003",
        "lead_crowning_um = 8",
        "pinion.modifications.tip_relief_in: found beside lead_crowning_um; " + SYSTEM.format("[pinion.modifications]"),
    ),
    (
        "lead_crowning_in = 0.0003",
        "polynomial_in = [0, 0, 0, 0, 0, 0]",
        'pinion.modifications.polynomial_in: unknown key; did you mean "pinion.modifications.polynomial_mm"?',
    ),
    (
        "lead_crowning_in = 0.0005",
        "lead_crowning_in = 0.5",
        "pinion.tooth: table 0: modifications.lead_crowning_in: found 0.5; allowed a number from 0 to 0.393701",
    ),
    (
        "outer_diameter_in = 1.5",
        "outer_diameter_in = 1.5, inner_diameter_in = 2",
        "pinion.shaft.sections: table 0: inner_diameter_in: found 2; allowed below outer_diameter_in = 1.5",
    ),
    (
        "max_pressure_psi = 300000",
        "max_pressure_MPa = 2000",
        "material.youngs_modulus_ksi: found beside max_pressure_MPa; " + SYSTEM.format("[material]"),
    ),
    (
        "torques_lbf_in = [600, 1200]",
        "torques_lbf_in = [600, -1]",
        "analysis.torques_lbf_in: found [600, -1]; allowed a list of 1 to 1000 values, each a number from 0 to "
        "8.85075e9 (found -1; allowed a number from 0 to 8.85075e9)",
    ),
    plain=True,
)


def test_numbers_in_units_of_their_own_stay_what_they_are():
    keys = {"bore_mm": Key(Number(0.0, 100.0), ""), "pin_um": Key(Number(0.0, 100.0), "")}
    writings = {name: in_inches(name, entry) for name, entry in keys.items()}
    sentence = (
        "found 25.4; 3 of them on 50.8 mm would touch: allowed below 12.7, up to 0.5 bore_mm = 12.7, pin_um = 254"
    )
    assert as_written(sentence, "bore_mm", writings) == (
        "found 1; 3 of them on 50.8 mm would touch: allowed below 0.5, up to 0.5 bore_in = 0.5, pin_in = 0.01"
    )
    assert as_written("found 25.4 values; allowed 25.4 mm", "bore_mm", writings) == "found 25.4 values; allowed 25.4 mm"


def in_inch_keys(section):
    """The table of a section as a drawing in inches has it: every key that has a unit there."""
    table = {}
    for name, value in contents(section).items():
        writing = in_inches(name, keys_of(type(section))[name]) if name in keys_of(type(section)) else None
        if isinstance(value, Section):
            table[name] = in_inch_keys(value)
        elif isinstance(value, tuple) and value and isinstance(value[0], Section):
            table[name] = [in_inch_keys(each) for each in value]
        elif writing is None or value is None:
            table[name] = value
        else:
            table[writing.name] = back(writing, value)
    return table


def back(writing, value):
    return tuple(back(writing, each) for each in value) if isinstance(value, tuple) else writing.from_key(value)


def leaves(value):
    if isinstance(value, dict):
        value = [each for item in sorted(value.items()) for each in item]
    return [leaf for each in value for leaf in leaves(each)] if isinstance(value, list | tuple) else [value]


@pytest.mark.parametrize(
    "name",
    [
        "helical_on_rolling_bearings",
        "helical_on_supports",
        "double_helical",
        "planet_ring",
        "spiral_bevel_blank",
        "face_milled_blank",
        "hypoid_13x42",
        "rated_spectrum",
        "revolution_helical",
        "measured_flank",
    ],
)
def test_scene_with_every_key_in_inches_is_the_same(name):
    scene = read_scene(SCENES / f"{name}.toml")
    table = in_inch_keys(scene)
    again = scene_from_table(table)
    assert type(again) is type(scene)
    for one, other in zip(leaves(as_table(again)), leaves(as_table(scene)), strict=True):
        # two roundings, of 1.1e-16 each
        assert one == (pytest.approx(other, rel=1e-15, abs=0.0) if isinstance(other, float) else other)


test_key_that_nobody_knows_is_answered_with_one_of_its_unit = refusals(
    lambda text: parse_scene(text),
    (
        "[pair]\ntype = 'cylindrical'\ndiametral_pitch = 8",
        'pitch: unknown key; did you mean "pair.diametral_pitch_per_inch"',
    ),
    ("[pair]\ntype = 'cylindrical'\nmt = 8", 'pair.mt: unknown key; did you mean "pair.transverse_module_mm"'),
    ("[pair]\ntype = 'cylindrical'\n[pinion]\nface_width_inch = 1", 'did you mean "pinion.face_width_in"'),
)


def test_changes_may_be_in_inches():
    scene = parse_scene(INCHES)
    wider = scene.with_changes({"pinion.face_width_in": 2, "pinion.tooth.0.modifications.lead_crowning_in": 0.0002})
    assert wider.pinion.face_width_mm == 50.8
    assert wider.pinion.tooth[0].modifications.lead_crowning_um == 5.08
    assert scene.with_changes({"material.max_pressure_psi": None}).material.max_pressure_MPa is None
    steeper = scene.with_changes({"pair.transverse_module_mm": 4.0, "pair.helix_angle_deg": 30.0})
    assert steeper.geometry.normal_module_mm == pytest.approx(4.0 * math.sqrt(0.75), rel=ROUNDING)
    again = steeper.with_changes({"pair.transverse_diametral_pitch_per_inch": 5.08})  # by the helix that it has
    assert again.geometry.normal_module_mm == pytest.approx(5.0 * math.sqrt(0.75), rel=ROUNDING)


test_changes_that_are_refused = refusals(
    lambda changes: parse_scene(INCHES).with_changes(changes),
    (
        {"pinion.face_width_in": -1, "wheel.face_width_in": 1e6},
        (
            "^pinion.face_width_in: found -1; allowed a number above 0, up to 393.701$",
            r"^wheel.face_width_in: found 1000000.0; allowed a number above 0, up to 393.701$",
        ),
    ),
    (
        {"pinion.face_width_in": 1, "pinion.face_width_mm": 25.4},
        ("^pinion.face_width_in: given twice, as pinion.face_width_mm too$",),
    ),
    (
        {"pair.helix_angle_deg": 15.0, "pair.diametral_pitch_per_inch": 8},
        ("^pair.diametral_pitch_per_inch: normal or transverse?",),
    ),
    ({"pinion.widht_in": 1}, ("^pinion.widht_in: unknown key",)),
    (  # by a rule, with what the scene has already
        {"pinion.tip_chamfer_in": 0.01, "pinion.tip_rounding_mm": 0.5},
        ("^pinion.tip_chamfer_in: found 0.01 beside tip_rounding_mm = 0.5; give one of them: each ends the flank$",),
    ),
)


def test_stage_in_inches():
    stage = read_stage("examples/stages/wind_spur.toml")
    changes = {"sun.face_width_in": 10, "load.sun_torque_lbf_ft": 1e5, "pair.diametral_pitch_per_inch": 1.27}
    changed = stage.with_changes({**changes, "pair.centre_distance_mm": None})
    assert (changed.sun.face_width_mm, changed.geometry.normal_module_mm) == (254.0, 20.0)
    assert changed.load.sun_torque_Nm == pytest.approx(135581.8, rel=SEVEN_DIGITS)
    assert stage.with_changes({"stage.pin_tangential_in.0": 0.001}).stage.pin_tangential_um == (25.4, 0.0, 0.0)
    with pytest.raises(InputError, match=r"^stage.pin_tangential_in.0: found 1; allowed a number from -0.3937"):
        stage.with_changes({"stage.pin_tangential_in.0": 1})
