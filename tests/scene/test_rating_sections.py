"""Sections on strength and rating: allowable stresses, and every problem of their keys."""

import pytest

from loaded_tca.errors import InputError
from loaded_tca.scene import read_scene
from tests.samples.results import SCENES

ROUGH = {"flank_Rz_um": 4.8, "root_Rz_um": 20.0}


def strength(**keys):
    return read_scene(SCENES / "helical.toml").with_changes({"pinion.strength": ROUGH | keys}).pinion.strength


def test_named_materials_have_the_stresses_of_their_lines():
    assert strength(material="18CrNiMo7-6").limits == (1500.0, 425.0)
    assert strength(material="18CrNiMo7-6", quality="ME").limits == (1650.0, 525.0)


def test_stresses_that_are_given_count():
    one = strength(kind="V alloy", sigma_H_lim_MPa=700.0, sigma_F_lim_MPa=290.0, proof_stress_MPa=800.0)
    assert one.limits == (700.0, 290.0)
    assert one.kind_of_material == "V alloy"
    assert one.brinell is None


def test_hardness_counts_in_the_scale_of_its_key():
    lines = {"material": "42CrMo4", "proof_stress_MPa": 800.0}
    of_vickers, of_brinell = strength(hardness_HV=300.0, **lines), strength(hardness_HBW=285.0, **lines)
    assert of_vickers.limits == pytest.approx(of_brinell.limits, rel=1e-12)  # 0.95 HV, ISO 18265
    assert of_vickers.limits[0] == pytest.approx(1.313 * 300.0 + 373.0, rel=1e-12)  # ISO 6336-5, table 1
    assert of_brinell.brinell == 285.0


REFUSED = [
    ({}, "pinion.strength.material: missing, or found beside kind"),
    ({"material": "18CrNiMo7-6", "kind": "Eh"}, "pinion.strength.material: missing, or found beside kind"),
    ({"material": "42CrMo4", "proof_stress_MPa": 800.0}, 'material: found "42CrMo4", whose stresses depend on'),
    ({"kind": "Eh"}, 'strength.kind: found "Eh", whose stresses depend on the hardness; give one of hardness_HV'),
    ({"material": "18CrNiMo7-6", "hardness_HRC": 40.0}, "hardness_HRC: found 392 HV; allowed for kind 'Eh'"),
    ({"material": "18CrNiMo7-6", "hardness_HV": 700.0, "hardness_HRC": 60.0}, "found beside another scale"),
    ({"material": "18CrNiMo7-6", "sigma_H_lim_MPa": 1500.0}, "found one of sigma_H_lim_MPa and sigma_F_lim_MPa"),
    ({"kind": "V alloy", "hardness_HV": 300.0}, "proof_stress_MPa: not given; the slip layer"),
    (
        {"material": "EN-GJL-250", "hardness_HBW": 200.0, "proof_stress_MPa": 250.0, "root_stress_ratio": -1.0},
        "root_stress_ratio: found -1, the standard has no mean stress sensitivity",
    ),
]


@pytest.mark.parametrize(("keys", "words"), REFUSED)
def test_problems_of_strength_are_told(keys, words):
    with pytest.raises(InputError, match=words):
        strength(**keys)


def test_method_b_asks_for_a_tolerance_class():
    wanted = {"required_flank_safety": 1.1, "required_root_safety": 1.4, "life_hours": 1e4}
    scene = read_scene(SCENES / "helical.toml")
    with pytest.raises(InputError, match=r"rating.tolerance_class: missing; needed for factors by .method B."):
        scene.with_changes({"rating": wanted})
    given = {"dynamic_factor": "given", "transverse_load_factor": 1.1}
    assert scene.with_changes({"rating": wanted | given}).rating.transverse_load_factor == 1.1
