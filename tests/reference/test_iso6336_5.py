"""Allowable stresses by kind, quality and hardness; conversions of hardness."""

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.reference.iso6336_5 import (
    KINDS,
    MATERIALS,
    QUALITIES,
    VICKERS_OF_ROCKWELL,
    allowable_stresses,
    converted_hardness,
    material_kind,
    named_material,
)
from tests.refusals import refused_calls

ROUNDING = 1e-12  # of one interpolation there and back
PRINTED = 5.0  # MPa: the rating program has tens of MPa, read off the figures of the standard


def test_named_steels_have_the_stresses_that_kisssoft_prints():
    """18CrNiMo7-6 at 61 HRC and 34CrNiMo6 at 240 HBW, MQ: 1500 and 430 MPa, 700 and 290 MPa."""
    case = named_material("18CrNiMo7-6", "MQ", hardness=61.0, scale="HRC")
    quenched = named_material("34CrNiMo6", "MQ", hardness=240.0, scale="HBW")
    stresses = [case.contact, case.nominal_root, quenched.contact, quenched.nominal_root]
    assert_allclose(stresses, [1500.0, 430.0, 700.0, 290.0], atol=PRINTED, rtol=0.0)


@pytest.mark.parametrize("kind", KINDS)
def test_parts_of_a_line_meet_and_better_material_bears_more(kind):
    material = KINDS[kind]
    for lines in (material.flank, material.root):
        for parts in lines:
            for below, above in pairwise(parts):
                assert below.highest == above.lowest
                assert_allclose(below.stress(below.highest), above.stress(above.lowest), atol=1.0)
        low = max(parts[0].lowest for parts in lines)
        stresses = [parts[0].stress(low) for parts in lines]
        assert stresses == sorted(stresses)


def test_core_of_case_hardened_teeth_counts_for_the_root():
    roots = [allowable_stresses("Eh", "MQ", 700.0, core=core) for core in ("25 HRC", "25 HRC, J12 28 HRC", "30 HRC")]
    assert [each.nominal_root for each in roots] == [425.0, 461.0, 500.0]
    assert {each.contact for each in roots} == {1500.0}
    assert roots[2].root == 1000.0


def test_second_part_of_a_line_counts_above_its_knee():
    assert_allclose(allowable_stresses("IF", "MQ", 600.0).nominal_root, 369.0)
    assert_allclose(allowable_stresses("NV nitrocarburized", "MQ", 400.0).contact, 1.167 * 400.0 + 425.0)
    assert allowable_stresses("NV nitrocarburized", "MQ", 500.0).contact == 950.0


def test_steels_named_without_hardness_lie_on_level_lines():
    for name, (kind, hardness) in MATERIALS.items():
        for quality in QUALITIES if hardness else ():
            stresses = {
                (
                    named_material(name, quality, hardness=each, scale="HV").contact,
                    named_material(name, quality).contact,
                )
                for each in (hardness - 30.0, hardness + 30.0)
            }
            assert len(stresses) == 1
        assert kind in KINDS


@given(st.floats(21.0, 68.0))
def test_hardness_returns_from_another_scale(rockwell):
    vickers = converted_hardness(rockwell, "HRC", "HV")
    assert_allclose(converted_hardness(vickers, "HV", "HRC"), rockwell, rtol=ROUNDING)


def test_ends_of_a_line_are_on_it_in_any_scale():
    for kind, ends, scale in (("St", (110.0, 210.0), "HV"), ("GGG", (175.0, 300.0), "HV"), ("NV", (450.0,), "HRC")):
        for end in ends:
            converted = converted_hardness(end, KINDS[kind].scale, scale)
            assert allowable_stresses(kind, "MQ", converted, scale=scale).hardness == end


def test_table_of_hardness_ascends():
    assert all(low[0] < high[0] and low[1] < high[1] for low, high in pairwise(VICKERS_OF_ROCKWELL))


test_iso6336_5_refuses = refused_calls(
    (lambda: material_kind("steel"), "kind: 'steel' is no kind of material; allowed: 'St', 'St cast'"),
    (
        lambda: allowable_stresses("Eh", "MQ", 640.0),
        "hardness: 640 HV; allowed for kind 'Eh', quality MQ: 660 to 800 HV",
    ),
    (
        lambda: allowable_stresses("St", "ME", 230.0),
        "hardness: 230 HBW; allowed for kind 'St', quality ME: 110 to 210 HBW",
    ),
    (lambda: allowable_stresses("V carbon", "ML", 120.0), "hardness: 120 HV; .*: 135 to 210 HV"),
    (lambda: allowable_stresses("Eh", "MX", 700.0), "quality: 'MX'; allowed: ML, MQ, ME"),
    (
        lambda: allowable_stresses("Eh", "ME", 700.0, core="30 HRC"),
        "core: '30 HRC' counts for kind 'Eh', quality MQ alone",
    ),
    (lambda: allowable_stresses("Eh", "MQ", 700.0, core="hard"), "core: 'hard'; allowed: '25 HRC'"),
    (lambda: named_material("42CrMo4", "MQ"), "hardness: not given; the stresses of 42CrMo4 depend on it"),
    (lambda: named_material("butter", "MQ"), "material: 'butter' is not known; allowed: 18CrNiMo7-6"),
    (
        lambda: converted_hardness(70.0, "HRC", "HV"),
        r"hardness: 70.0 HRC; allowed for conversion to HV: 20.3 to 68 HRC",
    ),
    (lambda: converted_hardness(500.0, "HV", "HBW"), r"hardness: 500.0 HV; allowed for conversion to HBW: 0 to 450 HV"),
    (lambda: converted_hardness(-1.0, "HX", "HBW"), ("scale: 'HX'; allowed: HV, HBW, HRC", "hardness: -1.0 HX is not")),
)
