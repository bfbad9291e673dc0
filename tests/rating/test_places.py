"""Which place decides: local safeties over flanks and roots, pictures of them, and sentences on them."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.errors import InputError
from loaded_tca.plots import plot_flank_safety, plot_root_safety, plot_safeties, rating_figures
from loaded_tca.rating import flank_safeties, root_safeties
from loaded_tca.rating.findings import findings, worst_of
from loaded_tca.rating.places import worst_case
from loaded_tca.reports import write_html_report
from loaded_tca.reports.rating_page import rating_content
from tests.samples.rating import HARD, solved

ROUNDING = 1e-12  # of a few products and roots, with room for any order of them


def test_least_safety_of_the_slices_is_that_of_the_rating():
    rated = solved(**{"operation.application_factor": 1.5, "wheel.strength": HARD | {"quality": "ML"}}).rating()
    for case in range(2):
        places = flank_safeties(rated, case)
        assert_allclose(places.safety.min(axis=1), rated.local_flank_safety[case], rtol=ROUNDING)
        worst = places.deciding(1)
        assert_allclose(places.radius[1, worst], rated.local_flank_radius[case, 1], rtol=ROUNDING)
        # both gears have one pressure at a place: the ratio of their safeties is that of their strengths everywhere
        ratio = rated.sigma_HG[case, 0] / rated.sigma_HG[case, 1]
        assert_allclose(places.safety[0] / places.safety[1], ratio, rtol=ROUNDING)


def test_root_that_decides_has_the_least_safety_of_all_places():
    rated = solved().rating()
    for gear in range(2):
        places, stress = root_safeties(rated, 1, gear), rated.result.root_stress[gear]
        at = places.deciding()
        assert_allclose(rated.local_root_safety[1, gear], places.safety[at], rtol=ROUNDING)
        ratio = stress.smallest[1][at] / stress.largest[1][at]
        assert_allclose(rated.local_stress_ratio[1, gear], min(ratio, 0.0), rtol=ROUNDING)
        assert_allclose(rated.local_root_angle[1, gear], stress.tangent_angle[at], rtol=ROUNDING)
        assert_allclose(rated.local_root_axial[1, gear], stress.point[(*at, 2)], rtol=ROUNDING)
        # Goodman's line by hand at every place in tension: annex B of ISO 6336-3:2006, case-hardened
        sensitivity = 0.8 - 0.15 * rated.Y_S[1, gear]
        tense = stress.largest[1] > 0.0
        reversal = np.clip(stress.smallest[1][tense] / stress.largest[1][tense], -1.2, 0.0)
        mean = 1.0 / (1.0 - reversal * (1.0 - sensitivity) / (1.0 + sensitivity))
        # tops of parabolas exceed the nodes of 5 deg and a face by little
        above = np.nanmax(rated.result.root_tension[1, :, gear]) / np.nanmax(stress.largest[1])
        assert 1.0 <= above < 1.01
        expected = rated.local_sigma_FG[1, gear] / rated.local_Y_M[1, gear] * mean / (above * stress.largest[1][tense])
        assert_allclose(places.safety[tense], expected, rtol=ROUNDING)


CAST_IRON = HARD | {"material": None, "kind": "GG", "sigma_H_lim_MPa": 900.0, "sigma_F_lim_MPa": 300.0}
CAST_IRON |= {"proof_stress_MPa": 400.0}


@pytest.mark.parametrize("torques", [[0, 1], [1]])
def test_root_of_cast_iron_decides_where_the_tension_is_largest(torques):
    """The standard has no mean stress sensitivity of cast iron: Y_M is 1 everywhere, under one torque or several."""
    whole = solved(**{"wheel.strength": CAST_IRON})
    scene = whole.scene.with_changes({"analysis.torques_Nm": (1e-3 * whole.torque[torques]).tolist()})
    maps = [whole.maps[torque] for torque in torques]
    rated = replace(whole, scene=scene, dataset=whole.dataset.isel(torque=torques), maps=maps, states=None).rating()
    assert_array_equal(rated.local_Y_M[:, 1], 1.0)
    tension = np.nanmax(whole.root_tension[torques, :, 1], axis=1)
    assert_allclose(rated.local_root_stress[:, 1], tension * rated.K_A * rated.K_gamma * rated.K_v, rtol=ROUNDING)


def test_smallest_over_the_face_is_that_of_both_fillets():
    places = root_safeties(solved().rating(), 1, 0)
    axial, least = places.over_face()
    assert axial.shape == least.shape == places.safety.shape[2:]
    assert np.nanmin(least) == np.nanmin(places.safety)  # exact: one of the same numbers


def test_sentences_say_what_decides():
    rated = solved(**{"rating.required_flank_safety": 1.0, "rating.required_root_safety": 9.0}).rating()
    worst = worst_of(rated)
    assert (worst.kind, worst.case) == ("root", 1)  # more torque, less safety
    assert worst.safety == rated.root_safety[1].min()
    standard, local, pressures, tensions = findings(rated)
    assert "tooth breakage of the" in standard
    assert "below the required 9" in standard
    assert "tangent angle" in local
    assert f"{rated.local_flank_stress[1]:.0f} MPa" in pressures
    assert "stress ratio" in tensions
    assert {standard, local} < {*rated.notes()}


@pytest.mark.parametrize(("beside", "mode"), [(0.99, "root"), (1.01, "flank")])
def test_what_decides_is_compared_on_the_scale_of_the_torque(beside, mode):
    """S_H ~ 1/sqrt(T), S_F ~ 1/T: half the required S_H asks for a quarter of the torque, as a quarter of S_F does."""
    plain_one = solved().rating()
    of_flank, of_root = (float(getattr(plain_one, f"{kind}_safety").min()) for kind in ("flank", "root"))
    wanted = {"rating.required_flank_safety": 2.0 * of_flank, "rating.required_root_safety": 4.0 * of_root / beside}
    rated = solved(**wanted).rating()
    worst = worst_of(rated)
    assert worst.kind == mode
    assert worst.factor == pytest.approx(min(0.25, 0.25 * beside), rel=1e-12)  # rounding
    formula = {"root": "(S_F/S_Fmin) = 0.2475", "flank": "(S_H/S_Hmin)^2 = 0.25"}[mode]
    assert f"torque factor {formula}" in findings(rated)[0]


def test_findings_of_flanks_alone():
    rated = solved(**{"analysis.root_stress": False, "rating.required_flank_safety": 50.0}).rating()
    standard, local, _ = findings(rated)
    assert standard.startswith("after ISO 6336 the critical failure is pitting of the")
    assert "diameter" in local


def test_bad_cases_are_refused():
    rated = solved().rating()
    with pytest.raises(InputError, match="case: 2 is no index from 0 to 1"):
        flank_safeties(rated, 2)
    with pytest.raises(InputError, match="gear: 2 is no index from 0 to 1"):
        root_safeties(rated, 0, 2)


def test_map_of_the_flank_has_the_least_safety_at_its_cross():
    rated = solved().rating()
    figure = plot_flank_safety(rated, 1)
    for axes, least in zip(figure.axes[:2], rated.local_flank_safety[1], strict=True):
        (mesh,) = axes.collections
        shown = mesh.get_array()
        # fields of 1/240 of the picture, pressures between positions along straight lines
        assert_allclose(shown.min(), least, rtol=1e-3)
        (cross,) = [line for line in axes.lines if line.get_marker() == "x"]
        row, column = np.unravel_index(shown.argmin(), shown.shape)
        borders = mesh.get_coordinates()
        apart = np.abs(borders[row, column] - np.ravel(cross.get_data())) / np.ptp(borders, axis=(0, 1))
        assert (apart < 0.03).all()


@cache
def picture_of_roots():
    return plot_root_safety(solved().rating())


def test_smallest_root_safety_is_over_the_face_of_each_gear():
    rated = solved().rating()
    case = worst_case(rated, "local_root_safety")[0]
    _, _, _, *below = picture_of_roots().axes  # maps and scale before
    for gear, (axes, name) in enumerate(zip(below, ("pinion", "wheel"), strict=True)):
        assert axes.get_xlabel() == f"axial position on the {name} [mm]"
        assert_allclose(axes.lines[0].get_xdata(), root_safeties(rated, case, gear).over_face()[0])
        assert_allclose(np.nanmin(axes.lines[0].get_ydata()), rated.local_root_safety[case, gear])


def test_places_of_roots_without_tension_have_the_colour_of_safe_ones(monkeypatch):
    rated = solved().rating()
    places = root_safeties(rated, 1, 0)
    pressed = places.safety.copy()
    pressed[1] = np.inf
    monkeypatch.setattr("loaded_tca.plots.safety.root_safeties", lambda *_: replace(places, safety=pressed))
    meshes = plot_root_safety(rated).axes[0].collections[:2]
    assert [np.ma.count_masked(mesh.get_array()) for mesh in meshes] == [0, 0]
    colours = meshes[1].to_rgba(meshes[1].get_array())
    assert (colours == meshes[1].cmap(1.0)).all()


def test_maps_of_both_gears_have_one_scale():
    flanks, roots = plot_flank_safety(solved().rating()), picture_of_roots()
    for figure in (flanks, roots):
        scales = {(mesh.norm.vmin, mesh.norm.vmax) for axes in figure.axes[:2] for mesh in axes.collections[:1]}
        assert len(scales) == 1


def test_pictures_are_those_that_the_rating_has():
    assert [*rating_figures(solved(**{"analysis.root_stress": False}).rating())] == [
        "safeties", "flank_safety", "rating_sn_curves", "rating_damage",
    ]  # fmt: skip


def test_safeties_that_the_standard_has_not_are_left_out():
    rated = solved().rating()
    unknown = rated.dataset.assign(root_safety=rated.dataset["root_safety"].where(rated.dataset["gear"] != "wheel"))
    (axes,) = plot_safeties(replace(rated, dataset=unknown)).axes
    assert len(axes.patches) == 7  # bars of both gears, but for the root of the wheel


def test_report_has_factors_by_gear_and_case(monkeypatch):
    monkeypatch.setattr("loaded_tca.reports.rating_page.rating_figures", lambda _: {})  # seconds, and tested above
    content = rating_content(solved())
    assert [table.caption.split(";")[0] for table in content["tables"]] == [
        "Loads and load factors", "Flanks, ISO 6336-2", "Roots, ISO 6336-3", "Local",
        "Damage and lives",
    ]  # fmt: skip
    assert content["tables"][0].head == ("", "100 N m, pinion", "100 N m, wheel", "200 N m, pinion", "200 N m, wheel")
    assert {len(row) for table in content["tables"] for row in table.rows} == {5}
    assert [row[0] for row in content["safeties"].rows] == [
        "pitting", "tooth breakage", "pitting, local", "tooth breakage, local",
    ]  # fmt: skip


REFUSED = "<li>lubricant: missing; the strength of flanks depends on viscosity_40_mm2_s</li>"


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({}, "after ISO 6336 the critical failure is"),
        pytest.param({"lubricant": None}, REFUSED, marks=pytest.mark.thorough),
    ],
)
def test_report_has_a_rating_or_says_why_not(tmp_path, monkeypatch, changes, words):
    for name in ("result_page.result_figures", "result_page.tribology_figures", "rating_page.rating_figures"):
        monkeypatch.setattr(f"loaded_tca.reports.{name}", lambda *_, **__: {})  # seconds, and tested by themselves
    text = write_html_report(solved(**changes), tmp_path / "report.html").read_text(encoding="utf-8")
    assert "<h2>Rating</h2>" in text
    assert words in text


def test_results_without_rating_have_none_in_their_report():
    assert rating_content(solved(rating=None)) is None
