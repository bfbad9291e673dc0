"""Each way in which a scene can be wrong, with the message it gets."""

import math

import pytest

from loaded_tca.errors import InputError
from loaded_tca.scene import scene_from_table
from tests.refusals import refusals
from tests.samples.scene_tables import changed


def problems_of(table, changes):
    with pytest.raises(InputError) as raised:
        scene_from_table(changed(table, changes))
    return raised.value.problems


TYPES = '"cylindrical" or "straight_bevel" or "spiral_bevel" or "face_milled"'

ONE_PROBLEM = [
    # missing
    ({"pair.normal_module_mm": None}, "pair.normal_module_mm: missing; allowed a number above 0, up to 1000"),
    ({"pair.type": None}, f"pair.type: missing; allowed {TYPES}"),
    ({"pinion.teeth": None}, "pinion.teeth: missing; allowed a whole number from 3 to 10000"),
    (
        {"load": None},
        "load.pinion_torque_Nm: missing; give a torque, or the bins of a spectrum: [[load.case]], or load.spectrum",
    ),
    (
        {"material": None},
        "material: missing; give [material] for both gears, or [pinion.material] and [wheel.material]",
    ),
    # unknown
    ({"pinion.teth": 3}, 'pinion.teth: unknown key; did you mean "pinion.teeth"?'),
    ({"pair.module": 3.0}, 'pair.module: unknown key; did you mean "pair.normal_module_mm"?'),
    ({"analysys": {}}, 'analysys: unknown key; did you mean "analysis"?'),
    (
        {"pinion.tip_relief_um": 3.0},
        'pinion.tip_relief_um: unknown key; did you mean "pinion.modifications.tip_relief_um"?',
    ),
    ({"Teeth": 3}, 'Teeth: unknown key; did you mean "pinion.teeth"?'),
    ({"load.colour": "red"}, "load.colour: unknown key; allowed pinion_torque_Nm, case, spectrum"),
    ({"load.two words\n": 1}, r'load."two words\n": unknown key; allowed pinion_torque_Nm, case, spectrum'),
    # wrong type
    ({"pinion.teeth": 34.0}, "pinion.teeth: found 34.0; allowed a whole number from 3 to 10000"),
    ({"pinion.teeth": True}, "pinion.teeth: found true; allowed a whole number from 3 to 10000"),
    ({"pinion.face_width_mm": True}, "pinion.face_width_mm: found true; allowed a number above 0, up to 10000"),
    ({"pinion.face_width_mm": "25"}, 'pinion.face_width_mm: found "25"; allowed a number above 0, up to 10000'),
    ({"pinion.face_width_mm": {}}, "pinion.face_width_mm: found a table; allowed a number above 0, up to 10000"),
    ({"title": 3}, "title: found 3; allowed one line of text of up to 200 characters"),
    ({"title": "two\nlines"}, r'title: found "two\nlines"; allowed one line of text of up to 200 characters'),
    ({"pinion": 3}, "pinion: found 3; allowed a section [pinion]"),
    ({"pair": 3}, "pair: found 3; allowed a section [pair]"),
    ({"wheel.modifications": [1]}, "wheel.modifications: found [1]; allowed a section [wheel.modifications]"),
    (
        {"analysis.cells": 32},
        "analysis.cells: found 32; allowed a list of 2 values, each a whole number from 4 to 1000000",
    ),
    # out of range
    (
        {"material.youngs_modulus_MPa": 1e-300},
        "material.youngs_modulus_MPa: found 1e-300; allowed a number from 0.001 to 10000000",
    ),
    (
        {"material.poisson_ratio": 0.5, "analysis.compliance": "contact+tooth"},
        'material.poisson_ratio: found 0.5; allowed up to 0.49 with analysis.compliance = "contact+tooth": finite '
        'elements of a material that keeps its volume lock; or set analysis.compliance = "contact"',
    ),
    ({"pinion.teeth": -34}, "pinion.teeth: found -34; allowed a whole number from 3 to 10000"),
    ({"pinion.teeth": 10001}, "pinion.teeth: found 10001; allowed a whole number from 3 to 10000"),
    (
        {"pinion.teeth": 16**5000},
        "pinion.teeth: found a whole number of 20001 bits; allowed a whole number from 3 to 10000",
    ),
    (
        {"pinion.face_width_mm": 10**400},
        "pinion.face_width_mm: found a whole number of 1329 bits; allowed a number above 0, up to 10000",
    ),
    ({"pinion.face_width_mm": 0}, "pinion.face_width_mm: found 0; allowed a number above 0, up to 10000"),
    (
        {"pinion.face_width_mm": math.nan},
        "pinion.face_width_mm: found nan; allowed a number above 0, up to 10000",
    ),
    (
        {"pinion.face_width_mm": math.inf},
        "pinion.face_width_mm: found inf; allowed a number above 0, up to 10000",
    ),
    (
        {"pair.helix_angle_deg": -15.0},
        "pair.helix_angle_deg: found -15.0; allowed a number from 0 to 59; its sign is in pinion.hand",
    ),
    ({"load.pinion_torque_Nm": -1.0}, "load.pinion_torque_Nm: found -1.0; allowed a number from 0 to 1e9"),
    ({"analysis.positions": 0}, "analysis.positions: found 0; allowed a whole number from 1 to 10000"),
    (
        {"pinion.modifications.lead_crowning_um": -5.0},
        "pinion.modifications.lead_crowning_um: found -5.0; allowed a number from 0 to 10000",
    ),
    (
        {"analysis.cells": [32, 2000000]},
        "analysis.cells: found [32, 2000000]; allowed a list of 2 values, each a whole number from 4 to 1000000"
        " (found 2000000; allowed a whole number from 4 to 1000000)",
    ),
    (
        {"analysis.torques_Nm": []},
        "analysis.torques_Nm: found []; allowed a list of 1 to 1000 values, each a number from 0 to 1e9",
    ),
    (
        {"analysis.torques_Nm": [1, 2, 3, 4, -5]},
        "analysis.torques_Nm: found [1, 2, 3, 4, ...]; allowed a list of 1 to 1000 values, each a number from 0 to"
        " 1e9 (found -5; allowed a number from 0 to 1e9)",
    ),
    # words
    (
        {"pair.driving": "weel"},
        'pair.driving: found "weel"; allowed "pinion" or "wheel"; did you mean "wheel"?',
    ),
    ({"pair.sense": 1}, 'pair.sense: found 1; allowed "positive" or "negative"'),
    ({"pair.type": "hypoid"}, f'pair.type: found "hypoid"; allowed {TYPES}'),
    ({"pair.type": 3}, f"pair.type: found 3; allowed {TYPES}"),
    ({"pair.type": ["cylindrical"]}, f'pair.type: found ["cylindrical"]; allowed {TYPES}'),
    ({"pair.type": "cylindical"}, f'pair.type: found "cylindical"; allowed {TYPES}; did you mean "cylindrical"?'),
    # how teeth share the load and bend
    ({"analysis.load_sharing": 0}, "analysis.load_sharing: found 0; allowed false or true"),
    (
        {"analysis.compliance": "contact+teeth"},
        'analysis.compliance: found "contact+teeth"; allowed "contact" or "contact+tooth"; did you mean '
        '"contact+tooth"?',
    ),
    # together
    (
        {"wheel.modifications.tip_relief_um": 20.0},
        "wheel.modifications.tip_relief_start_mm: missing or 0; tip_relief_um = 20 needs a value above 0, or "
        "tip_relief_start_roll_deg or tip_relief_start_length_mm",
    ),
    (
        {"wheel.modifications.root_relief_um": 20.0},
        "wheel.modifications.root_relief_start_mm: missing or 0; root_relief_um = 20 needs a value above 0, or "
        "root_relief_start_roll_deg or root_relief_start_length_mm",
    ),
    (
        {"wheel.modifications.end_relief_um": 20.0},
        "wheel.modifications.end_relief_length_mm: missing or 0; end_relief_um = 20 needs a value above 0, or "
        "end_relief_lower_length_mm",
    ),
    (
        {"wheel.modifications.end_relief_um": 20.0, "wheel.modifications.end_relief_lower_length_mm": 4.0},
        "wheel.modifications.end_relief_length_mm: missing or 0; end_relief_um = 20 needs a value above 0, or "
        "end_relief_upper_length_mm",
    ),
    (
        {"wheel.modifications.end_relief_upper_um": 12.0, "wheel.modifications.end_relief_lower_length_mm": 4.0},
        "wheel.modifications.end_relief_length_mm: missing or 0; end_relief_upper_um = 12 needs a value above 0, or "
        "end_relief_upper_length_mm",
    ),
    (
        {"wheel.modifications.end_relief_lower_length_mm": 10.5},
        "wheel.modifications.end_relief_lower_length_mm: found 10.5; allowed up to 0.5 face_width_mm = 10",
    ),
    (
        {"wheel.modifications.end_relief_upper_length_mm": 0.0},
        "wheel.modifications.end_relief_upper_length_mm: found 0.0; allowed a number above 0, up to 10000",
    ),
    (
        {"wheel.modifications.end_relief_lower_um": -1.0},
        "wheel.modifications.end_relief_lower_um: found -1.0; allowed a number from 0 to 10000",
    ),
    (
        {"pinion.modifications.tip_relief_start_mm": 109.0, "pinion.modifications.tip_relief_start_roll_deg": 25.0},
        "pinion.modifications.tip_relief_start_mm: found tip_relief_start_mm = 109 beside tip_relief_start_roll_deg "
        "= 25; give one of them",
    ),
    (
        {
            "pinion.modifications.root_relief_um": 5.0,
            "pinion.modifications.root_relief_start_roll_deg": 18.0,
            "pinion.modifications.root_relief_start_length_mm": 16.0,
        },
        "pinion.modifications.root_relief_start_mm: found root_relief_start_roll_deg = 18 beside "
        "root_relief_start_length_mm = 16; give one of them",
    ),
    (
        {"pinion.modifications.root_relief_start_roll_deg": -1.0},
        "pinion.modifications.root_relief_start_roll_deg: found -1.0; allowed a number from 0 to 3600",
    ),
    (
        {"mounting.misalignment_um": 1e5},
        "mounting.misalignment_um: found 100000.0; allowed a number from -10000 to 10000",
    ),
    (
        {"wheel.modifications.end_relief_length_mm": 11.0},
        "wheel.modifications.end_relief_length_mm: found 11; allowed up to 0.5 face_width_mm = 10",
    ),
    (
        {"pinion.tip_diameter_mm": 112.0, "pinion.modifications.tip_relief_start_mm": 113.0},
        "pinion.modifications.tip_relief_start_mm: found 113; allowed up to tip_diameter_mm = 112",
    ),
    (
        {"pinion.tip_diameter_mm": 112.0, "pinion.bore_diameter_mm": 120.0},
        "pinion.bore_diameter_mm: found 120; allowed up to tip_diameter_mm = 112",
    ),
    (
        {"pinion.hand": "left", "wheel.hand": "left"},
        'wheel.hand: found "left" on both gears; allowed "right", the hand that the pinion does not have',
    ),
    (
        {"material": None, "pinion.material": {"youngs_modulus_MPa": 2e5, "poisson_ratio": 0.3}},
        "material: missing; give [material] for both gears, or [pinion.material] and [wheel.material]",
    ),
]


test_message_names_the_key_and_what_is_allowed = refusals(
    lambda changes, table: scene_from_table(changed(table, changes)), *ONE_PROBLEM, plain=True
)


def test_messages_tell_every_problem_at_once(table):
    found = problems_of(
        table,
        {
            "pair.normal_module_mm": -3,
            "pinion.teth": 34,
            "wheel.modifications.tip_relief_um": 5,
            "analysis.cells": [0, 1],
            "analysis.positions": 0,
            "load": None,
        },
    )
    assert [line.split(":")[0] for line in found] == [
        "pair.normal_module_mm",
        "pinion.teth",
        "wheel.modifications.tip_relief_start_mm",
        "load.pinion_torque_Nm",
        "analysis.positions",
        "analysis.cells",
    ]


def test_message_of_a_rule_waits_for_sound_values(table):
    changes = {"material": {"poisson_ratio": 0.3, "youngs_modulus_MPa": "steel"}, "analysis.accuracy": -1}
    found = problems_of(table, {**changes, "analysis.cells": [8, 8]})
    assert [line.split(":")[0] for line in found] == ["material.youngs_modulus_MPa", "analysis.accuracy"]


def test_key_of_another_section_is_shown_its_place(table):
    (line,) = problems_of(table, {"load.driving": "wheel"})
    assert line == 'load.driving: unknown key; did you mean "pair.driving"?'


def test_unknown_keys_beyond_twenty_are_counted(table):
    found = problems_of(table, {f"load.x{i}": 1 for i in range(30)})
    assert len(found) == 21
    assert found[-1] == "load: 10 more unknown keys"


def test_unknown_keys_of_the_top_beyond_twenty_are_counted(table):
    assert problems_of(table, {f"x{i}": 1 for i in range(30)})[-1] == "scene: 10 more unknown keys"


def test_message_shortens_the_list_of_many_keys(table):
    (line,) = problems_of(table, {"wheel.modifications.colour": "red"})
    assert line.startswith("wheel.modifications.colour: unknown key; allowed lead_crowning_um, ")
    assert line.endswith(", ...")
    assert len(line) < 400


def test_message_shortens_long_values(table):
    (line,) = problems_of(table, {"pair.driving": "w" * 10000})
    assert len(line) < 150
