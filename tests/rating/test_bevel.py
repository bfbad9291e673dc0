"""Ratings of bevel and hypoid pairs: printed samples from the scene on, load factors, local ratings, refusals."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError, NotAskedError, noted_accuracy_warnings
from loaded_tca.plots import plot_safeties
from loaded_tca.rating.bevel import _stiffness_notes, bevel_inputs_of
from loaded_tca.rating.bevel_sheet import bevel_sheet
from loaded_tca.reference import iso10300_1, iso10300_2, iso10300_3
from loaded_tca.reports.rating_page import rating_content
from loaded_tca.scene import read_scene
from tests.samples.rating import OF_SAMPLE_1, RATED, bevel_solved
from tests.samples.results import SCENES
from tests.samples.root_stress import result as with_roots
from validation.rating.iso_tr_10300_30 import BEVEL, FOUR_DIGITS, HYPOID

pytestmark = pytest.mark.filterwarnings("ignore:rating.*leave edges out:loaded_tca.AccuracyWarning")

ROUNDING = 1e-12  # of a few products and roots, with room for any order of them


@cache
def rated_sample():
    return bevel_solved().rating()


GIVEN = {"rating.dynamic_factor": "given", "rating.transverse_load_factor": 1.1}


def test_the_scene_of_sample_1_has_its_printed_factors():
    rated, printed = rated_sample(), BEVEL.printed
    names = {"Z_MB": "Z_M-B", "Z_LS": "Z_LS", "Z_L": "Z_L", "Z_v": "Z_v", "Z_R": "Z_R", "Z_Hyp": "Z_Hyp"}
    names |= {"Y_eps": "Y_eps", "Y_BS": "Y_BS", "Y_LS": "Y_LS", "Y_R_relT": "Y_R_relT"}
    for name, label in names.items():
        assert_allclose(rated.values(name), printed[label], rtol=FOUR_DIGITS, err_msg=name)
    assert_allclose(rated.Y_Fa[:, 1], printed["Y_Fa"][1], rtol=FOUR_DIGITS)  # 0.38 m_mn is 1.22 mm, the report has 1.2
    # K_v and K_Halpha of f_pt 25.7 um of grade 8, where the report has 26 um
    assert_allclose(rated.K_v[1], printed["K_v"], rtol=FOUR_DIGITS)
    assert_allclose(rated.K_Halpha[1], printed["K_Halpha"], rtol=4e-3)
    by_modulus = rated.Z_E[1] / printed["Z_E"]
    assert_allclose(rated.sigma_H0[1], printed["sigma_H0"] * by_modulus, rtol=FOUR_DIGITS)
    # the pinion, beyond the knee of the curve; in front of it other factors than Z_NT change, too
    assert_allclose(rated.sigma_HG[:, 0] / rated.Z_NT[:, 0], printed["sigma_HG"], rtol=FOUR_DIGITS)
    assert "ISO 10300-2 and -3:2023, method B1" in rated.summary()


def test_the_hypoid_scene_has_the_printed_virtual_gears_of_sample_2():
    sheet, printed = bevel_sheet(read_scene(SCENES / "hypoid_13x42.toml")), HYPOID.printed
    pair = sheet.pair
    values = {"z_vn": pair.normal_teeth, "widths": pair.widths, "l_bm": pair.contact_lines.lengths[1]}
    values |= {"ratios": pair.contact_ratios, "rho_rel": pair.relative_radius}
    values["Z_LS"] = iso10300_2.load_sharing_factor(pair)
    values["Z_Hyp"] = iso10300_2.hypoid_factor(pair.spiral_angles, pair.contact_line_angle, pair.pressure_angle)[0]
    values["Y_BS"] = iso10300_3.bevel_spiral_angle_factor(pair, sheet.whole_depths)
    for name, value in values.items():
        assert_allclose(value, printed[name], rtol=FOUR_DIGITS, err_msg=name)
    assert sheet.notes == ()
    # the report has 22.252 and 20 deg on the coast side; settings make them within 0.02 deg
    coast = sheet.coast_pair
    assert_allclose(np.degrees([coast.pressure_angle, coast.effective_pressure_angle]), [22.252, 20.0], atol=0.03)


def test_surface_factor_of_nitrided_bevel_gears_is_that_of_their_own_standard():
    """4.299 - 3.259 (R_z + 1)^(1/200) of ISO 10300-3, formula (42), at 16 um; 0.986 with the exponent of ISO 6336-3."""
    nitrided = {"kind": "NT", "material": None, "hardness_HV": None}
    strengths = {f"{gear}.strength": OF_SAMPLE_1[f"{gear}.strength"] | nitrided for gear in ("pinion", "wheel")}
    rated = bevel_solved(**GIVEN | strengths).rating()
    assert_allclose(rated.Y_R_relT, 0.9935, atol=5e-5)  # of the printed digits


def test_stresses_are_nominal_ones_times_load_factors():
    changes = GIVEN | {"operation.dynamic_factor": 1.2, "rating.face_load_factor": 1.3}
    rated = bevel_solved(**changes).rating()
    assert_allclose(rated.sigma_H, (rated.sigma_H0 * (1.1 * 1.2 * 1.3 * 1.1) ** 0.5)[:, None] * [1.0, 1.0])
    assert_allclose(rated.K_Fbeta, 1.3, rtol=ROUNDING)  # no cutter smaller than R_m2: K_F0 is 1
    assert_allclose(rated.sigma_F, rated.sigma_F0 * 1.1 * 1.2 * 1.3 * 1.1, rtol=ROUNDING)
    assert_allclose(rated.sigma_F0[1], 2.0 * rated.sigma_F0[0], rtol=ROUNDING)
    assert_allclose(rated.sigma_H0[1], 2.0**0.5 * rated.sigma_H0[0], rtol=ROUNDING)
    assert_allclose(rated.flank_safety, rated.sigma_HG / rated.sigma_H, rtol=ROUNDING)


def test_small_cutters_lower_the_face_load_factor_of_roots():
    changes = {"pair.blank.lengthwise_curve": "cutter_circle", "pair.blank.cutter_radius_mm": 70.0}
    rated = bevel_solved(**changes).rating()
    distance = bevel_sheet(bevel_solved().scene).members[1].mean_cone_distance
    curved = iso10300_1.lengthwise_curvature_factor(70.0, distance, np.radians(35.0))
    assert curved > 1.02
    assert_allclose(rated.K_Fbeta, 1.65 / curved, rtol=ROUNDING)


def test_transverse_load_factor_of_the_analysis_is_the_largest_share_over_that_of_the_standard():
    whole = bevel_solved(**GIVEN | {"rating.transverse_load_factor": "analysis"})
    rated = whole.rating()
    shares = np.nanmax(whole.load_share, axis=(1, 2))
    assert shares[0] > 0.873 > shares[1]  # Y_LS of sample 1 as printed: under 300 N m more is shared than by it
    assert_allclose(rated.K_Halpha, [shares[0] / 0.873, 1.0], rtol=FOUR_DIGITS)
    assert_allclose(rated.K_Falpha, rated.K_Halpha, rtol=ROUNDING)
    assert any("from the analysis of equal teeth, without the pitch deviations" in note for note in rated.notes())
    high = bevel_solved(**GIVEN | {"rating.transverse_load_factor": "analysis", "rating.profile_crowning": "high"})
    assert_allclose(high.rating().K_Halpha[0], shares[0] / high.rating().Y_LS[0], rtol=ROUNDING)


def test_local_flank_stress_stands_against_the_same_strength():
    whole, rated = bevel_solved(), rated_sample()
    assert_allclose(rated.local_flank_safety, rated.sigma_HG / rated.local_flank_stress[:, None], rtol=ROUNDING)
    peaks = np.nanmax(whole.peak_pressure, axis=(1, 2)) * (1.1 * rated.K_v) ** 0.5
    # Line contact at each slice beside the pressures of 8 x 12 cells, on flanks whose ellipse is not slender.
    assert_allclose(rated.local_flank_stress, peaks, rtol=0.15)
    assert (rated.K_Hbeta == 1.65).all()
    of_analysis = bevel_solved(**GIVEN, **{"rating.face_load_factor": "analysis"}).rating()
    assert_allclose(of_analysis.K_Hbeta, whole.face_load_factor, rtol=ROUNDING)


def test_local_root_stress_is_the_computed_tension():
    whole = with_roots("mesh_cycle_bevel")
    with noted_accuracy_warnings(given=False):  # contacts of the coarse grid reach edges
        rated = replace(whole, scene=whole.scene.with_changes(RATED)).rating()
    tension = np.nanmax(whole.root_tension, axis=1)
    assert_allclose(rated.local_root_stress, tension, rtol=0.01)  # the place of the smallest safety is next to its own
    assert (rated.local_root_stress <= tension * (1.0 + ROUNDING)).all()
    assert_allclose(rated.local_root_safety, rated.local_sigma_FG / rated.local_root_stress, rtol=ROUNDING)
    assert rated.life_hours.shape == (*rated.root_safety.shape, 4)


def test_factors_of_the_other_standard_are_not_there():
    rated = rated_sample()
    with pytest.raises(NotAskedError, match="Z_H: a factor of ISO 6336; bevel pairs have factors of ISO 10300"):
        rated.Z_H  # noqa: B018
    assert "zone factor Z_H" not in rated.summary()


def test_pictures_and_tables_name_the_standard_of_bevel_pairs(monkeypatch):
    monkeypatch.setattr("loaded_tca.reports.rating_page.rating_figures", lambda _: {})  # seconds, and tested elsewhere
    (axes,) = plot_safeties(rated_sample()).axes
    labels = [label.get_text() for label in axes.get_yticklabels()]
    assert labels == ["pitting, ISO 10300-2", "pitting, local", "tooth breakage, ISO 10300-3"]
    captions = {table.caption.split(";")[0] for table in rating_content(rated_sample().result)["tables"]}
    assert {"Flanks, ISO 10300-2", "Roots, ISO 10300-3"} < captions


def test_more_profile_crowning_and_a_coarser_grade_cost_safety():
    usual = rated_sample()
    for changes in ({"rating.profile_crowning": "high"}, {"rating.tolerance_class": 10}):
        other = bevel_solved(**changes).rating()
        assert (other.flank_safety < usual.flank_safety).all()
        assert (other.root_safety < usual.root_safety).all()


def test_what_the_standard_assumes_is_told():
    notes = rated_sample().notes()
    assert any(
        note.startswith("rho_a0: spherical involutes have no tool; it is taken as 0.38 m_mn, or as the")
        for note in notes
    )
    assert "K_F0: taken as 1, since no cutter makes the lengthwise curve" in notes
    straight = bevel_sheet(read_scene(SCENES / "straight_bevel.toml"))
    assert straight.wheel == 0  # the pinion of that scene has more teeth
    assert_allclose(straight.gear_ratio, 32 / 39)
    assert not any("K_F0" in note for note in straight.notes)
    shifted = read_scene(SCENES / "straight_bevel.toml").with_changes({"pinion.profile_shift": 0.1})
    assert bevel_sheet(shifted).notes[-1].startswith("scope: profile shifts have a sum of 0.1; ")


def test_stiffnesses_of_other_materials_are_told():
    whole = bevel_solved()
    soft = SimpleNamespace(contact_modulus=0.5 * whole.gear_pair.contact_modulus)
    inputs = bevel_inputs_of(whole)
    wanted = SimpleNamespace(
        gear_pair=soft, face_load_factor=whole.face_load_factor, torque=whole.torque, path=whole.path, scene=whole.scene
    )
    assert _stiffness_notes(inputs) == ()
    assert _stiffness_notes(replace(inputs, result=wanted)) == (
        "c', c_gamma: the values are those of steel, but the gears are not of steel",
    )


def test_wheels_that_do_not_roll_have_straight_teeth():
    sheet = bevel_sheet(read_scene(SCENES / "hypoid_13x42.toml"))
    pinion, wheel = sheet.members
    formate = replace(sheet, members=(pinion, replace(wheel, generated=False)))
    rolled, straight = sheet.root_section(1), formate.root_section(1)
    assert_allclose(straight.radius * sheet.pair.mean_normal_module, wheel.edge_radius, rtol=ROUNDING)
    assert_allclose(straight.form_factor, rolled.form_factor, rtol=0.05)  # 256 virtual teeth are nearly a rack's
    assert straight.form_factor != rolled.form_factor


def test_edges_that_do_not_fit_the_slot_are_told():
    sheet = bevel_sheet(read_scene(SCENES / "hypoid_13x42.toml"))
    pinion, wheel = sheet.members
    assert sheet.edge_notes(1) == ()
    large = replace(sheet, members=(pinion, replace(wheel, edge_radius=2.0, generated=False)))
    (note,) = large.edge_notes(1)
    assert note.startswith("rho_a0: 2 mm does not fit the slot; ")
    radius = float(note.split("; ")[1].partition(" mm")[0])
    assert_allclose(large.root_section(1).radius * sheet.pair.mean_normal_module, radius, rtol=1e-3)  # of four digits


REFUSED = [
    ({"lubricant": None}, "lubricant: missing"),
    ({"rating.tolerance_class": 1}, "rating.tolerance_class: wheel: grade: 1 is not one of 2 to 11"),
]


@pytest.mark.parametrize(("changes", "words"), REFUSED)
def test_what_is_missing_is_told(changes, words):
    with pytest.raises(InputError, match=words):
        bevel_solved(**changes).rating()


def test_small_modules_have_no_tolerances():
    whole = with_roots("mesh_cycle_bevel")
    by_method_b = RATED | {"rating": OF_SAMPLE_1["rating"]}
    with pytest.raises(InputError, match=r"mean_normal_module: 0\.65.* mm is not within 1 to 50 mm of ISO 17485"):
        replace(whole, scene=whole.scene.with_changes(by_method_b)).rating()


UNFIT = [
    ("hypoid_13x42", {"pair.pinion_flank": "convex"}, "pair.pinion_flank: the convex flank of a hypoid pinion"),
    ("hypoid_13x42", {"wheel.cutter.concave": None}, "wheel.cutter: has one blade; a rating needs whole teeth"),
    ("straight_bevel", {"pair.shaft_angle_deg": 150.0}, "pair: the pitch angle of the pinion, 95.2 deg, is not below"),
    ("straight_bevel", {"wheel.root_angle_deg": 30.0}, "pair: ISO 10300-3 gives no root stress for this pair"),
]


@pytest.mark.parametrize(("name", "changes", "words"), UNFIT)
def test_pairs_outside_the_standard_are_refused(name, changes, words):
    scene = read_scene(SCENES / f"{name}.toml").with_changes(changes | {"analysis.load_sharing": True})
    idle = SimpleNamespace(scene=scene.with_changes(RATED), torque=np.array([1e5]), path=range(5))
    with pytest.raises(InputError, match=words):
        bevel_inputs_of(idle)
