import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.output.overview import describe_scene
from loaded_tca.output.result_files import positions_csv, summary_json
from loaded_tca.scene import read_scene
from loaded_tca.studies.ranking import MAIN_FIGURES
from tests.samples.results import SCENES, changed, changed_scene
from tests.samples.root_stress import result, scene

GEARS = "pinion", "wheel"


def figures(**changes):
    return result(**changes).key_figures()


@pytest.mark.thorough
def test_figures_are_the_extremes_over_the_positions_and_their_places():
    cycle = result()
    for t, found in enumerate(cycle.key_figures()):
        for gear, name in enumerate(GEARS):
            tension, compression = cycle.root_tension[t, :, gear], cycle.root_compression[t, :, gear]
            assert found[f"{name}_root_tension_MPa"] == tension.max()
            assert found[f"{name}_root_compression_MPa"] == compression.min()
            n = tension.argmax()
            assert found[f"pinion_angle_at_{name}_root_tension_deg"] == math.degrees(cycle.pinion_angle[n])
            assert found[f"{name}_root_tension_angle_deg"] == math.degrees(cycle.root_tension_angle[t, n, gear])
            assert found[f"{name}_root_tension_axial_mm"] == cycle.root_tension_axial[t, n, gear]
            assert found[f"{name}_root_tension_on_back"] is False
            assert found[f"{name}_root_compression_on_back"] is True
            assert found[f"{name}_root_stress_ratio"] == cycle.root_stress_ratio[t, gear]


def test_nominal_stress_of_fzg_c14_is_that_of_gearpie():
    """271.19 and 263.17 MPa at 200 N m, F_t on the operating pitch circle of 73.2 mm, fillets of 0.375 modules."""
    fzg = read_scene(SCENES / "fzg_c14.toml").with_changes(
        {"pair.root_radius_coefficient": 0.375, "pinion.tip_diameter_mm": None, "wheel.tip_diameter_mm": None}
    )
    at_reference = 73.2 / (16 * 4.5)
    found = 200e3 * np.array(fzg.nominal_root_stress)
    assert_allclose(found, at_reference * np.array([271.19, 263.17]), rtol=1e-4)
    assert_allclose(fzg.root_factors, [[1.689, 1.851, 1.0], [1.583, 1.917, 1.0]], atol=5e-4)


def test_face_load_factor_is_that_of_the_result_to_the_power_of_the_tooth_height_over_the_width():
    """Height 2.25 modules of 3 mm, face 18 mm: h/b = 0.375, the standard's 1/3 in its place."""
    cycle = result(**{"mounting.misalignment_um": 20.0})
    assert_allclose(cycle.scene.tooth_height_over_width, 2.25 * 3.0 / 18.0, rtol=1e-9)
    for contact, found in zip(cycle.face_load_factor, cycle.key_figures(), strict=True):
        assert contact > 1.2
        factor = contact ** (1.0 / (1.0 + 1.0 / 3.0 + 1.0 / 9.0))
        assert_allclose(found["root_face_load_factor_iso_6336"], factor, rtol=1e-9)
        nominal = found["wheel_nominal_root_stress_iso_6336_MPa"]
        assert_allclose(found["wheel_root_stress_iso_6336_MPa"], factor * nominal, rtol=1e-9)


@pytest.mark.parametrize(("gear", "tip"), [("pinion", 107.0), ("wheel", 175.0)])
def test_height_of_the_higher_teeth_counts(gear, tip):
    """One gear has its tips cut by 0.5 or 1 mm, the other teeth of 2.25 modules; faces 27 and 30 mm wide."""
    widths = {"pinion.face_width_mm": 30.0, "wheel.face_width_mm": 27.0}
    cycle = changed_scene(result(), {**widths, f"{gear}.tip_diameter_mm": tip})
    cycle = changed(cycle, face_load_factor=[1.3, 1.5])
    ratio = 2.25 * 3.0 / 27.0
    assert_allclose(cycle.scene.tooth_height_over_width, ratio, rtol=1e-9)
    found = [figures["root_face_load_factor_iso_6336"] for figures in cycle.key_figures()]
    assert_allclose(found, np.array([1.3, 1.5]) ** (1.0 / (1.0 + ratio + ratio**2)), rtol=1e-9)


def test_nominal_stress_of_a_spur_pair_is_near_the_tension():
    """Both are stress under the load of one pair at the outer point of single contact."""
    for found in figures():
        for name in GEARS:
            ratio = found[f"{name}_root_tension_MPa"] / found[f"{name}_root_stress_iso_6336_MPa"]
            assert 0.7 < ratio < 1.2


def test_nominal_stress_grows_with_the_helix_and_shrinks_with_the_face():
    narrow, wide = (scene(**{"pinion.face_width_mm": width, "wheel.face_width_mm": width}) for width in (10.0, 20.0))
    # also below: half the width enters once, as a factor
    assert_allclose(narrow.nominal_root_stress, 2.0 * np.array(wide.nominal_root_stress), rtol=1e-12)
    assert_allclose(narrow.tooth_height_over_width, 2.0 * wide.tooth_height_over_width, rtol=1e-12)


@pytest.mark.thorough
def test_standard_is_silent_on_bevel_gears_and_single_positions():
    bevel = result("mesh_cycle_bevel")
    assert np.isnan(bevel.scene.nominal_root_stress).all()
    assert math.isnan(bevel.key_figures()[0]["pinion_root_stress_iso_6336_MPa"])
    assert "root tension" in bevel.summary()
    assert "ISO 6336-3" not in bevel.summary()
    single = result(**{"analysis.positions": 1})
    assert math.isnan(single.key_figures()[0]["root_face_load_factor_iso_6336"])
    assert single.key_figures()[0]["pinion_nominal_root_stress_iso_6336_MPa"] > 0.0
    assert "ISO 6336-3" not in single.summary()


def test_standard_without_a_critical_section_leaves_the_result_alone(monkeypatch):
    """Below a contact ratio of 1 there is no outer point of single contact."""
    assert np.isfinite(scene().nominal_root_stress).all()
    monkeypatch.setattr("loaded_tca.gears.CylindricalMesh.transverse_contact_ratio", 0.9)
    assert np.isnan(scene().nominal_root_stress).all()


def test_summary_tells_root_stress_only_where_it_is_asked_for():
    lines = result().summary().splitlines()
    for label in (
        "root tension of pinion | wheel [MPa]",
        "root compression of pinion | wheel [MPa]",
        "  stress ratio R there",
        "  ISO 6336-3:2006, sigma_F0 K_Fbeta [MPa]",
        "    its sigma_F0 of pinion | wheel [MPa], K_Fbeta",
        "    its Y_F | Y_S | Y_beta of the pinion",
        "    its Y_F | Y_S | Y_beta of the wheel",
        "note: root stress, computed or after ISO 6336-3:2006, has no safety, K_A, K_V, life or",
    ):
        assert sum(line.startswith(label) for line in lines) == 1
    (tension,) = (line for line in lines if line.startswith("root tension of"))
    for found in figures():
        assert f"{found['pinion_root_tension_MPa']:.4g} | {found['wheel_root_tension_MPa']:.4g}" in tension
    without = result(**{"analysis.root_stress": False})
    assert not [line for line in without.summary().splitlines() if "root stress" in line or "root tension" in line]
    assert not [name for name in without.key_figures()[0] if "root" in name]


def test_summary_says_where_tension_lies_on_the_back():
    cycle = result()
    place = cycle.root_tension_place.copy()
    place[1, :, 1, 1] = 1
    told = changed(cycle, root_tension_place=place).summary()
    assert "note: the root tension of the wheel lies on the back of a tooth (200 N m)" in told
    assert "on the back" not in cycle.summary()


def test_tables_have_the_stress_of_both_gears():
    cycle = result()
    header, *rows = (line.split(",") for line in positions_csv(cycle).splitlines())
    for name, part, factor in (
        ("root_tension_MPa", "root_tension", 1.0),
        ("root_compression_MPa", "root_compression", 1.0),
        ("root_tension_angle_deg", "root_tension_angle", math.degrees(1.0)),
        ("root_compression_axial_mm", "root_compression_axial", 1.0),
    ):
        for gear, prefix in enumerate(GEARS):
            column = [float(row[header.index(f"{prefix}_{name}")]) for row in rows]
            expected = factor * getattr(cycle, part)[..., gear].ravel()
            assert_allclose(column, expected, rtol=1e-8, atol=1e-6)
    assert '"wheel_root_tension_MPa"' in summary_json(cycle)
    assert "root_tension" not in positions_csv(result(**{"analysis.root_stress": False}))


def test_overview_tells_what_is_asked_for_and_the_nominal_stress():
    told = describe_scene(scene())
    assert "root stress                                             on" in told
    pinion, wheel = (100e3 * one for one in scene().nominal_root_stress)
    for gear, stress in (("pinion", pinion), ("wheel", wheel)):
        assert any(
            line.startswith(f"nominal root stress, ISO, {gear} [MPa]") and f"{stress:.4g}" in line
            for line in told.splitlines()
        )
    assert "bores or journals held rigid" in told  # flanks alone, but gear bodies below the roots
    assert "root stress" not in describe_scene(scene(**{"analysis.root_stress": False}))
    assert "nominal root stress" not in describe_scene(scene("mesh_cycle_bevel"))


def test_bores_that_are_held_are_told_where_only_root_stress_asks_for_them():
    assert scene().rigid_bores == scene().pair().rigid_bores
    assert scene(**{"analysis.root_stress": False}).rigid_bores is None


@pytest.mark.parametrize("name", GEARS)
def test_studies_compare_root_tension(name):
    assert f"{name}_root_tension_MPa" in MAIN_FIGURES
    assert f"{name}_root_tension_MPa" in figures()[0]
