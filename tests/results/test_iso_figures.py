"""Contact factors and stiffnesses of ISO 6336 beside computed numbers."""

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import read_scene
from loaded_tca.output.overview import describe_scene
from loaded_tca.plots.style import label_of
from loaded_tca.reports.result_page import result_content
from loaded_tca.results.key_figures import REASONS, WHERE_REASONS_ARE, iso_figures
from loaded_tca.results.root_stress import rim_factor
from tests.samples.results import SCENES, changed, changed_scene, result

KEY_FIGURES = Path(__file__).parents[2] / "docs" / "reference" / "key_figures.md"
NAMES = [*REASONS, "wheel_single_contact_factor_iso_6336"]


def iso_tr_6336_30(**changes):
    """Example 1: m_n 8, 17/103, beta 15.8 deg, b 100, a 500 mm; the rack is 1.4 modules deep."""
    changes = {
        "pair.normal_module_mm": 8.0,
        "pair.helix_angle_deg": 15.8,
        "pair.centre_distance_mm": 500.0,
        "pair.dedendum_coefficient": 1.4,
        "pinion.teeth": 17,
        "wheel.teeth": 103,
        "pinion.profile_shift": 0.145,
        "wheel.profile_shift": 0.0,
        "pinion.tip_diameter_mm": 159.66,
        "wheel.tip_diameter_mm": 872.35,
        "pinion.face_width_mm": 100.0,
        "wheel.face_width_mm": 100.0,
        "pinion.modifications": {},
        **changes,
    }
    return read_scene(SCENES / "mesh_cycle_helical.toml").with_changes(changes)


def test_numbers_of_a_scene_are_those_of_iso_tr_6336_30():
    found = iso_figures(iso_tr_6336_30(), 9000e3, 1.3)
    printed = {
        "nominal_contact_stress_iso_6336_MPa": 1206.58207,
        "pinion_single_contact_factor_iso_6336": 1.0,
        "wheel_single_contact_factor_iso_6336": 1.0,
        "contact_ratio_factor_iso_6336": 0.803,
        "contact_helix_angle_factor_iso_6336": 1.01944,
        "single_stiffness_iso_6336_N_per_mm_um": 12.37047,
        "mesh_stiffness_iso_6336_N_per_mm_um": 17.46485,
    }
    for name, value in printed.items():
        assert_allclose(found[name], value, rtol=1e-3 if value == 0.803 else 1e-5), name
    # eps_gamma/(eps_alpha Z_eps^2) is eps_gamma from an overlap of 1 on
    assert_allclose(found["largest_transverse_load_factor_iso_6336"], 1.549090 + 1.083369, rtol=1e-6)


def test_nominal_stress_of_fzg_c14_is_the_printed_one_of_hertz_at_the_pitch_point():
    """GEARpie, 200 N m: 1347.3 MPa of a line as long as the face, which Z_eps makes longer."""
    scene = read_scene(SCENES / "fzg_c14.toml")
    found = iso_figures(scene, 200e3)
    hertz = found["nominal_contact_stress_iso_6336_MPa"] / found["contact_ratio_factor_iso_6336"]
    assert_allclose(hertz, 1347.3, atol=0.1)
    assert_allclose(found["contact_ratio_factor_iso_6336"], math.sqrt((4.0 - 1.46) / 3.0), rtol=2e-3)  # eps_alpha 1.46


def test_stress_grows_with_the_root_of_the_torque_and_stiffness_with_the_modulus():
    scene = iso_tr_6336_30()
    softer = scene.with_changes({"material.youngs_modulus_MPa": 103000.0})
    once, more, soft = iso_figures(scene, 1e6), iso_figures(scene, 4e6), iso_figures(softer, 1e6)
    stress, stiffness = "nominal_contact_stress_iso_6336_MPa", "mesh_stiffness_iso_6336_N_per_mm_um"
    assert_allclose([more[stress], soft[stress]], once[stress] * np.array([2.0, math.sqrt(0.5)]), rtol=1e-9)
    assert_allclose(soft[stiffness], 0.5 * once[stiffness], rtol=1e-9)


def test_stiffness_is_unknown_beyond_the_fitted_profile_shifts():
    shifts = {"pinion.profile_shift": 0.145, "wheel.profile_shift": -0.7}
    far = iso_tr_6336_30(**shifts, **{"pair.centre_distance_mm": None, "wheel.tip_diameter_mm": None})
    found = iso_figures(far, 1e6)
    assert math.isnan(found["single_stiffness_iso_6336_N_per_mm_um"])
    assert math.isnan(found["mesh_stiffness_iso_6336_N_per_mm_um"])
    assert found["nominal_contact_stress_iso_6336_MPa"] > 0.0


def test_standard_has_nothing_for_bevel_gears():
    cycle = result("mesh_cycle_bevel")
    assert np.isnan([cycle.key_figures()[0][name] for name in NAMES]).all()
    assert "ISO 6336" not in cycle.summary()
    assert "ISO 6336" not in describe_scene(cycle.scene)


def test_bound_of_the_transverse_load_factor_stands_beside_it_alone():
    cycle = result("mesh_cycle_spur")
    (found,), (alone,) = cycle.key_figures(), changed(cycle, transverse_load_factor=[math.nan]).key_figures()
    assert found["transverse_load_factor"] > 1.0
    factor = found["contact_ratio_factor_iso_6336"]
    assert_allclose(found["largest_transverse_load_factor_iso_6336"], factor**-2, rtol=1e-9)
    assert math.isnan(alone["largest_transverse_load_factor_iso_6336"])


@pytest.mark.thorough
def test_reasons_stand_in_overview_report_and_reference_and_the_summary_says_where(monkeypatch):
    monkeypatch.setattr("loaded_tca.reports.result_page.result_figures", lambda *_, **__: {})
    cycle = result("mesh_cycle_spur")
    lines, overview = cycle.summary().splitlines(), describe_scene(cycle.scene).splitlines()
    reference = " ".join(KEY_FIGURES.read_text(encoding="utf-8").split())
    notes = {row[0].strip(): row[-1] for table in result_content(cycle)["key_figures"] for row in table.rows}
    for name, reason in REASONS.items():
        assert reason in reference
        assert notes[label_of(name)] == reason
        assert (f"ISO 6336: {reason}" in overview) == (name != "largest_transverse_load_factor_iso_6336")
    assert [line for line in lines if line.startswith("ISO 6336: ")] == [WHERE_REASONS_ARE]
    rows = [line.strip() for line in lines if "ISO 6336-" in line]
    begins = ["ISO 6336-2: sigma_H0 ", "ISO 6336-1 above 100 N/mm: c' ", "upper bound of K_Halpha in ISO 6336-1, "]
    assert [row[: len(begin)] for row, begin in zip(rows, begins, strict=True)] == begins


@pytest.mark.parametrize(("rim", "factor"), [(1.3, 1.0), (0.8, 1.64882), (0.45, math.nan)])
def test_rim_factor_is_that_of_the_bore(rim, factor):
    """Root radius 47.25, height 6.75 mm: rims of so many heights."""
    bore = 2.0 * (47.25 - 6.75 * rim)
    cycle = changed_scene(result("mesh_cycle_spur"), {"pinion.bore_diameter_mm": bore})
    assert_allclose(rim_factor(cycle.gear_pair.pinion, 3.0), factor, atol=5e-6)
    assert rim_factor(cycle.gear_pair.wheel, 3.0) == 1.0
