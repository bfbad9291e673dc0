"""Ratings of double helical pairs: halves under their shares, the whole gear, load spectra, files, what is refused."""

import json
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca import InputError
from loaded_tca.cli import main
from loaded_tca.double_helical import DoubleHelicalResult, analyse_double_helical
from loaded_tca.double_helical import analyse as analyses
from loaded_tca.plots import HALVES_RATING_PICTURES, plot_safeties, rating_figures
from loaded_tca.plots.style import NOTE, note_of
from loaded_tca.rating.places import is_shown
from loaded_tca.reports import write_html_report
from loaded_tca.reports.rating_page import halves_rating_content
from loaded_tca.studies import double_helical as studies
from loaded_tca.studies import figures as all_figures
from tests.samples import double_helical as samples
from tests.samples.rating import RATED

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")  # few cells
APEX = 0.005
ROUNDING = 1e-9  # exponents of S-N curves, up to 33, multiply rounding of stresses
HELD = {"pair.floating": "none", "pair.apex_offset_mm": APEX}
BINS = [
    {"pinion_torque_Nm": torque, "hours": hours, "reversed": torque == 1000.0}
    for torque, hours in ((1600.0, 10.0), (1200.0, 40.0), (0.0, 3.0), (1000.0, 30.0))
]
SLOPES = {"operation.application_factor": 1.6, "rating.required_flank_safety": 1.5, "rating.required_root_safety": 3.5}
"""With these stresses lie on slopes of their curves."""


def result_of(**changes):
    """Result of halves that are alike, each of which the one mesh cycle is."""
    grid = {"analysis.positions": 5, "analysis.cells": [8, 8]}
    scene = samples.equal_halves().with_changes({**grid, **RATED, **SLOPES, **changes})
    cycle = samples.half_over_a_pitch()
    scenes = scene.half_scenes(0.0, 2 * [cycle.scene.analysis.torques_Nm])
    halves = [analyses._Half(replace(cycle, scene=half, states=None), []) for half in scenes]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(analyses, "_analysed", lambda *_: halves)
        return analyse_double_helical(scene)


@pytest.fixture(scope="module")
def held():
    return result_of(**HELD)


@pytest.fixture(scope="module")
def held_rating(held):
    return held.rating()


@pytest.fixture(scope="module")
def under_bins():
    return result_of(**HELD, load={"case": BINS}).rating()


def test_equal_halves_that_float_are_one_half_under_half_the_torque():
    result = result_of()
    rating = result.rating()
    half = samples.half_over_a_pitch()
    scene = half.scene.with_changes({**RATED, **SLOPES, "analysis.torques_Nm": [800.0]})
    alone = replace(half, scene=scene, dataset=half.dataset.isel(torque=[1]), maps=half.maps[1:2], states=None).rating()
    for name in ("flank_safety", "root_safety", "local_flank_safety", "damage", "life_hours"):
        assert_allclose(getattr(rating, name), getattr(alone, name), rtol=ROUNDING)
    assert_allclose(rating.whole_root_safety, alone.root_safety, rtol=ROUNDING)
    assert rating.K_gamma.tolist() == [1.0]


def test_whole_gear_has_the_torque_on_both_widths(held_rating):
    """F_t of the whole torque over d_1 b and b m_n with b = 2 b_B (ISO 6336-2, -3), K_gamma of the larger share."""
    rating, mesh = held_rating.whole, held_rating.scene.mesh()
    force = 1.6e6 / mesh.pinion.reference_radius
    width = 2.0 * 40.0
    ratio = mesh.wheel.teeth / mesh.pinion.teeth
    nominal = np.sqrt(force / (2.0 * mesh.pinion.reference_radius * width) * (ratio + 1.0) / ratio)
    assert_allclose(rating.sigma_H0, rating.Z_H * rating.Z_E * rating.Z_eps * rating.Z_beta * nominal, rtol=1e-9)
    factors = (rating.Y_F * rating.Y_S * rating.Y_beta * rating.Y_B * rating.Y_DT)[0]
    assert_allclose(rating.sigma_F0[0], force / (width * 4.0) * factors, rtol=1e-9)
    line_loads = [half.torque * half.K_gamma * half.K_Hbeta for half in held_rating.halves]
    assert line_loads[0] > line_loads[1]  # but half b has the larger K_Hbeta
    assert_allclose(0.5 * 1.6e6 * rating.K_gamma * rating.K_Hbeta, line_loads[0], rtol=ROUNDING)
    assert_allclose(held_rating.whole_flank_safety, held_rating.half_a.flank_safety, rtol=ROUNDING)


@pytest.mark.parametrize("apex", [0.02, -0.02])
def test_whole_gear_takes_of_a_half_what_it_carries(apex):
    """Next to no load on a half, K_Hbeta 14 there, is next to nothing in the whole gear, whose safety has no dip."""
    torques = np.linspace(500.0, 800.0, 7)
    cases = [{"pinion_torque_Nm": torque, "hours": 1.0} for torque in torques.tolist()]
    rating = result_of(**{**HELD, "pair.apex_offset_mm": apex}, load={"case": cases}).rating()
    more, less = rating.halves if apex > 0.0 else rating.halves[::-1]
    begins = int(np.flatnonzero(less.torque)[0])
    assert 1 < begins < 6
    assert less.K_Hbeta[begins] > 2.0 * more.K_Hbeta[begins]
    assert_allclose(rating.K_Hbeta, more.K_Hbeta, rtol=ROUNDING)
    assert_allclose(rating.K_gamma, 2.0 * more.torque * more.K_gamma / (1e3 * torques), rtol=ROUNDING)
    assert (np.diff(rating.whole_flank_safety, axis=0) < 0.0).all()


def test_half_without_load_under_a_torque_has_no_load_factors_there():
    """Between 550 and 750 N m half b begins to carry, as bins of these torques show above."""
    rating = result_of(**{**HELD, "pair.apex_offset_mm": 0.02, "analysis.torques_Nm": [500.0, 800.0]}).rating()
    assert rating.half_b.torque[0] == 0.0 < rating.half_b.torque[1]
    for name in ("K_Hbeta", "K_v", "local_flank_radius"):
        assert (np.isnan(rating.half_b.values(name).reshape(2, -1)) == [[True], [False]]).all(), name
    assert (rating.half_b.damage[0] == 0.0).all()
    assert_array_equal(rating.K_Hbeta[0], rating.half_a.K_Hbeta[0])
    note = "half b carries nothing under up to 500 N m of both halves, and has no load factors there"
    assert note in rating.notes()
    of_half_b = rating.summary().partition("half b, under")[2]
    (line,) = [line for line in of_half_b.splitlines() if "  face load factor K_Hbeta" in line]
    assert line.split()[-2] == "-"


@pytest.mark.parametrize(("apex", "name", "more"), [(1.0, "b", {}), (-1.0, "a", {"load": {"case": BINS}})])
def test_half_without_load_under_all_torques_is_not_rated(apex, name, more):
    result, half = result_of(**{**HELD, "pair.apex_offset_mm": apex}, **more), f"half_{name}"
    cycle = getattr(result, half)
    little = replace(cycle, dataset=cycle.dataset.isel(torque=[0]), maps=cycle.maps[:1], states=None)
    rating = replace(result, **{half: little}).rating()
    assert getattr(rating, half) is None
    assert_array_equal(rating.K_gamma[rating.torque > 0.0], 2.0)
    (other,) = rating.halves
    assert_array_equal(rating.damage, other.damage)
    assert_allclose(other.torque * np.nan_to_num(other.K_gamma), rating.torque, rtol=ROUNDING)
    assert rating.notes()[0] == (f"half {name} carries nothing under any torque: the rating is that of the other half")
    assert f"half {name}, under its share" not in rating.summary()
    captions = [table.caption for table in halves_rating_content(rating.result)["tables"]]
    assert {caption[:6] for caption in captions} == {f"Half {'ab'.replace(name, '')}"}


def test_load_factor_of_held_halves_is_that_of_the_axial_force_that_is_left(held, held_rating):
    """DNV-CG-0036: K_gamma = 1 + F_ext/(F_t tan(beta)) of an external axial force."""
    mesh = held.scene.mesh()
    axial = 1.6e6 / mesh.pinion.reference_radius * np.tan(mesh.pinion.helix_angle)
    left = np.abs(held.axial_force_left).max()
    assert left > 0.1 * axial
    assert_allclose(held_rating.K_gamma, 1.0 + left / axial, rtol=ROUNDING)
    assert_allclose(held_rating.half_a.torque, 0.5 * held_rating.K_gamma * 1.6e6, rtol=ROUNDING)
    assert held_rating.half_b.torque < 0.8e6 < held_rating.half_a.torque


def test_worse_half_counts(held_rating):
    half_a, half_b = held_rating.halves
    assert (half_a.root_safety < half_b.root_safety).all()
    assert_array_equal(held_rating.root_safety, half_a.root_safety)
    assert_array_equal(held_rating.damage, np.maximum(half_a.damage, half_b.damage))
    assert_array_equal(held_rating.life_hours, np.minimum(half_a.life_hours, half_b.life_hours))
    figures = held_rating.key_figures()[0]
    assert figures["pinion_root_safety"] == figures["half_a_pinion_root_safety"] < figures["half_b_pinion_root_safety"]
    assert any(note.startswith("half b: after ISO 6336 the critical failure") for note in held_rating.notes())
    assert "half a, under its share" in held_rating.summary()


def test_bins_are_shared_as_their_torques_are(under_bins):
    alone = result_of(**HELD, **{"analysis.torques_Nm": [1200.0, 1600.0]}).rating()
    for half, other in zip(under_bins.halves, alone.halves, strict=True):
        # K_gamma takes what a share exceeds the torques by that were solved
        torques = half.torque[[1, 0]] * half.K_gamma[[1, 0]]
        assert_allclose(torques, other.torque * other.K_gamma, rtol=ROUNDING)
    assert under_bins.half_a.torque[2] == 0.0
    assert_array_equal(under_bins.miner_sum, np.maximum(under_bins.half_a.miner_sum, under_bins.half_b.miner_sum))
    # each bin alone lasts so long, of the 83 h that are asked for; reversed bins load no flank that is analysed
    flank = under_bins.modes.index("flank")
    for half, other in zip(under_bins.halves, alone.halves, strict=True):
        damage = 40.0 / other.life_hours[0, :, flank] + 10.0 / other.life_hours[1, :, flank]
        assert (damage > 0.0).all()
        assert_allclose(half.miner_sum[:, flank], 20000.0 / 83.0 * damage, rtol=1e-8)


def test_summary_of_a_spectrum_has_both_halves_and_what_is_assumed(under_bins):
    text = under_bins.summary()
    assert text.count("half b, under its share") >= 2  # all bins together, and bin by bin
    assert "in reversed bins the halves share the torque as" in text
    assert "analyse with pair.driving or pair.sense changed and reversed swapped in every bin" in text
    assert "--coast" not in text


def test_command_and_report_rate_both_halves(tmp_path, monkeypatch, capsys, held, under_bins):
    held.save(tmp_path)
    monkeypatch.chdir(tmp_path)
    assert main(["rating", ".", "--set", "rating.life_hours=5000"]) == 0
    assert "half a, under its share" in capsys.readouterr().out
    (row,) = json.loads((tmp_path / "rating.json").read_text())["torques"]
    assert row["half_b_pinion_torque_Nm"] < row["half_a_pinion_torque_Nm"]
    again = DoubleHelicalResult.load(tmp_path)
    again = replace(again, scene=again.scene.with_changes({"rating.life_hours": 5000.0})).rating()
    assert row["wheel_whole_root_safety"] == pytest.approx(again.whole_root_safety[0, 1], rel=1e-6)
    assert main(["rating", ".", "--set", "pinion.teeth=21"]) == 2
    assert "--set pinion.teeth: needs another analysis" in capsys.readouterr().err
    under_bins.result.save(tmp_path)
    assert main(["rating", str(tmp_path)]) == 0
    spectrum = json.loads((tmp_path / "rating.json").read_text())["spectrum"]
    assert spectrum["half_a"]["pinion_root"]["miner_sum"] >= spectrum["half_b"]["pinion_root"]["miner_sum"]
    captions = [table.caption for table in halves_rating_content(held)["tables"]]
    assert captions[:2] == ["Half a: safeties and lives", "Half a: Loads and load factors"]
    assert halves_rating_content(result_of(**{"pinion.strength": None})) is None


OF_HELD_HALVES = ["safeties"] + [
    f"half_{half}_{name}" for half in "ab" for name in ("safeties", "flank_safety", "rating_sn_curves", "rating_damage")
]


def test_pictures_of_a_rating_are_those_of_both_halves():
    floating = result_of().rating()
    drawn = rating_figures(floating)
    assert [*drawn] == [name for name in HALVES_RATING_PICTURES if not name.endswith("root_safety")]  # no root stress
    for half in "ab":
        (label,) = {text.get_text() for text in drawn[f"half_{half}_safeties"].texts if text.get_gid() == NOTE}
        assert label.startswith(f"Double helical pair 29/87: half {half}; ")
        bars = [bar.get_width() for bar in drawn[f"half_{half}_safeties"].axes[0].patches]
        assert min(floating.of_halves[half].flank_safety[0]) in bars


def test_safeties_of_a_pair_are_those_of_the_worse_half(held_rating, under_bins):
    bars = {bar.get_width() for bar in plot_safeties(held_rating).axes[0].patches}
    assert min(half.root_safety.min() for half in held_rating.halves) in bars
    # strokes of single bins: reversed ones load no flank that is analysed, idle ones nothing
    with pytest.MonkeyPatch.context() as patch:  # seconds, and the same figure
        patch.setattr("loaded_tca.reports.notebook.png_of", lambda *_: b"drawn")
        assert "<img" in held_rating._repr_html_()
    strokes = [line for line in plot_safeties(under_bins).axes[0].lines if line.get_marker() == "|"]
    assert_allclose(strokes[0].get_xdata(), under_bins.half_a.flank_safety[[0, 1], 0], rtol=ROUNDING)


def test_maps_of_held_halves_are_interpolated_between_their_torques(held_rating, under_bins):
    """Torques of held halves lie between those that were analysed."""
    for rating in (held_rating, under_bins):
        figures = rating_figures(rating)
        assert [*figures] == OF_HELD_HALVES
        assert "the nearest analysed torque; stresses interpolated" in note_of(figures["half_a_flank_safety"])


def test_pictures_of_a_half_that_carries_nothing():
    """Of a half without load under one torque the other torques are shown; one that is not rated has none."""
    some = result_of(**{**HELD, "pair.apex_offset_mm": 0.02, "analysis.torques_Nm": [500.0, 800.0]}).rating()
    axes = rating_figures(some)["half_b_safeties"].axes[0]
    assert np.isfinite([bar.get_width() for bar in axes.patches]).all()
    one = replace(some, half_b=None)
    assert {name[:6] for name in rating_figures(one)} == {"safeti", "half_a"}


def test_pictures_of_a_rating_stand_in_directory_and_report(tmp_path, monkeypatch, held):
    held.save(tmp_path)
    monkeypatch.chdir(tmp_path)
    old = [tmp_path / f"{name}.png" for name in ("half_a_flank_safety", "flank_safety")]
    for path in old:  # of a rating that had them
        path.touch()
    assert main(["rating", "."]) == 0
    pictures = {path.stem for path in tmp_path.glob("*.png")}
    assert pictures == {*OF_HELD_HALVES}
    shown = halves_rating_content(held)["pictures"]
    assert [picture.caption[:7] for picture in shown[1:]] == 4 * ["Half a:"] + 4 * ["Half b:"]
    assert shown[0].note.startswith("two halves, ISO 6336-2:2019")
    assert shown[1].note.startswith("ISO 6336-2:2019")  # the caption says which half
    page = write_html_report(held, tmp_path / "report.html").read_text(encoding="utf-8")
    assert page.count("Half b: S-N curves after ISO 6336-6") == 1


def test_rating_without_a_lubricant_is_refused():
    with pytest.raises(InputError, match="lubricant: missing; the strength of flanks"):
        result_of(lubricant=None).rating()


def test_bins_above_the_torques_that_were_solved_are_refused(held):
    scene = held.scene.with_changes({"load": {"case": [{"pinion_torque_Nm": 1700.0, "hours": 1.0}]}})
    with pytest.raises(InputError, match=r"load\.case: a bin has 1700 N m; allowed up to 1600, the largest analysed"):
        replace(held, scene=scene).rating()


@pytest.fixture
def without_analysis(monkeypatch):
    def give(result):
        monkeypatch.setattr(studies, "analyse_double_helical", lambda _scene: result)

    return give


def test_studies_have_the_safeties_of_the_worse_half(held, held_rating, without_analysis):
    """Of both halves and both gears the least, as studies of other pairs have those of both gears."""
    without_analysis(held)
    figures = studies.halves_figures(held.scene)
    halves = held_rating.half_a, held_rating.half_b
    for name, number in {"S_H": "flank_safety", "S_F": "root_safety", "S_H_local": "local_flank_safety"}.items():
        assert_array_equal(figures[name], np.min([getattr(half, number).min(axis=1) for half in halves], axis=0))
    lives = [half.life_hours[..., [half.modes.index(mode) for mode in ("flank", "root")]] for half in halves]
    assert_array_equal(figures["life_h"], np.min([life.min(axis=(1, 2)) for life in lives], axis=0))
    assert all_figures(held.scene).keys() == figures.keys()
    unrated = studies.halves_figures(held.scene.with_changes({"rating": None}))
    assert unrated.keys() == figures.keys() - {"S_H", "S_F", "S_H_local", "S_F_local", "life_h", "life_local_h"}


def test_studies_have_the_safeties_of_all_bins(under_bins, without_analysis):
    without_analysis(under_bins.result)
    figures = studies.halves_figures(under_bins.scene)
    flank = under_bins.spectrum_safety[:, under_bins.modes.index("flank")].min()
    assert_array_equal(figures["S_H"], np.full(len(under_bins.result.torque), flank))


UNDER = {800.0: (1.3, 1.2), 1600.0: (1.0, 1.0)}  # N m: factors of K_Hbeta and of pressures, as if shafts bent
ALL_HOURS = {"rating.life_hours": None, "rating.required_flank_safety": 2.0}


def halves_under(scene, torque):
    """Mesh cycles of both halves that only count under one torque of the pair."""
    face, pressure = UNDER[torque]
    cycle = samples.half_over_a_pitch()
    maps = [
        [[one and replace(one, pressure=one.pressure * pressure) for one in row] for row in rows] for rows in cycle.maps
    ]
    dataset = cycle.dataset.assign(face_load_factor=face * cycle.dataset.face_load_factor)
    scenes = scene.half_scenes(0.0, 2 * [cycle.scene.analysis.torques_Nm])
    halves = [replace(cycle, scene=half, dataset=dataset, maps=maps, states=None) for half in scenes]
    return [analyses._Half(half, []) for half in halves]


def result_under(*torques, **load):
    """Result whose torques have mesh cycles of their own, as on shafts."""
    grid = {"analysis.positions": 5, "analysis.cells": [8, 8], "analysis.torques_Nm": [*torques]}
    scene = samples.equal_halves().with_changes({**grid, **RATED, **SLOPES, **HELD, **load})
    settled, places = analyses.settled, []
    with pytest.MonkeyPatch.context() as patch:
        for row, torque in enumerate(torques):
            patch.setattr(analyses, "_analysed", lambda *_, under=torque: halves_under(scene, under))
            places += settled(analyses._under(scene, np.array([row])), 0.0, None, None)
        patch.setattr(analyses, "settled", lambda *_: places)
        return analyse_double_helical(scene)


@pytest.fixture(scope="module")
def under_both():
    return result_under(*UNDER)


@pytest.fixture(scope="module")
def under_each():
    return [result_under(torque) for torque in UNDER]


@pytest.fixture(scope="module")
def rating_under_both(under_both):
    return under_both.rating()


def bins_of(result, *bins):
    cases = [{"pinion_torque_Nm": torque, "hours": hours} for torque, hours in bins]
    return replace(result, scene=result.scene.with_changes({**ALL_HOURS, "load": {"case": cases}})).rating()


def test_torque_in_a_list_is_rated_by_the_mesh_cycles_under_it(rating_under_both, under_each):
    """Halves on shafts have other load distributions under each torque."""
    both, alone = rating_under_both, [result.rating() for result in under_each]
    for of in ("half_a", "half_b", "whole"):
        for name, values in getattr(both, of).dataset.items():
            ones = np.concatenate([getattr(rating, of).values(name) for rating in alone])
            assert_allclose(values, ones, rtol=ROUNDING, err_msg=f"{of}, {name}")  # nothing else is in them
    assert both.half_a.K_Hbeta[0] > 1.2 * both.half_a.K_Hbeta[1]
    assert any("come from its own mesh cycles" in note for note in both.notes())


def test_bins_add_up_over_mesh_cycles_of_other_torques(under_both, under_each):
    low, high = (800.0, 50.0), (1600.0, 1e-3)
    one, other = (bins_of(result, each) for result, each in zip(under_each, (low, high), strict=True))
    both = bins_of(under_both, high, low)
    flank = both.modes.index("flank")
    for half in range(2):
        sums = [rating.halves[half].miner_sum[:, flank] for rating in (one, other, both)]
        assert (sums[0] > 0.0).all()
        assert_allclose(sums[2], sums[0] + sums[1], rtol=1e-7)  # exponents multiply rounding
    # each half carries what lies between two torques of its mesh cycles
    assert (both.interpolation_error[:, flank] > 0.0).all()
    between = bins_of(under_both, (1200.0, 1.0), low, high)
    assert (np.diff(between.half_a.K_Hbeta[[2, 0, 1]]) > 0.0).all()


def test_mesh_cycles_of_all_torques_come_back_and_old_ones_go(under_both, rating_under_both, under_each, tmp_path):
    paths = under_both.save(tmp_path)
    assert [path.name for path in paths[3:]] == ["half_a_under_800_Nm.nc", "half_b_under_800_Nm.nc"]
    again = DoubleHelicalResult.load(tmp_path)
    assert again.dataset.identical(under_both.dataset)
    assert again.rating().dataset.identical(rating_under_both.dataset)
    paths[-1].rename(tmp_path / "kept.nc")
    with pytest.raises(InputError, match=r"half_b_under_800_Nm\.nc"):
        DoubleHelicalResult.load(tmp_path)
    under_each[1].save(tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "double_helical.nc",
        "half_a.nc",
        "half_b.nc",
        "kept.nc",
    ]


def test_file_that_does_not_say_which_mesh_cycles_a_torque_has_is_refused(under_both, tmp_path):
    replace(under_both, dataset=under_both.dataset.drop_vars("place"), elsewhere=()).save(tmp_path)
    with pytest.raises(InputError, match="place"):
        DoubleHelicalResult.load(tmp_path)


def test_what_ratings_of_several_mesh_cycles_do_not_have_is_refused(under_both, rating_under_both):
    with pytest.raises(InputError, match="sensitivities: the torques of this rating have results of their own"):
        rating_under_both.half_a.sensitivities(["mounting.misalignment_um"])
    share = under_both.dataset.torque_share.copy(data=[[[0.6, 0.4]] * 5, [[0.2, 0.8]] * 5])
    falling = replace(under_both, dataset=under_both.dataset.assign(torque_share=share))
    with pytest.raises(
        InputError, match=r"half a: analysis\.torques_Nm: the half carries no more under 1600 N m of both"
    ):
        falling.rating()


def test_places_are_those_of_the_torque_whose_mesh_cycle_is_shown(rating_under_both):
    half = rating_under_both.half_a
    solved = half.result.dataset.assign_coords(torque=("torque", [1.0, *half.torque]))  # as if each had been solved
    shown = replace(half, result=replace(half.result, dataset=solved, states=None))
    parts = [(shown.result if part is half.result else part, of) for part, of in half.inputs.duty.parts]
    shown = replace(shown, inputs=replace(half.inputs, duty=replace(half.inputs.duty, parts=parts)))
    assert is_shown(shown).tolist() == [False, True]
