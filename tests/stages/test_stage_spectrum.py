"""Ratings of stages under load spectra: single meshes counted by hand, fillets of planets, K_gamma between torques."""

import functools
import json
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.errors import AccuracyWarning, InputError
from loaded_tca.output import write_rating
from loaded_tca.plots import plot_damage, plot_safeties, plot_sn_curves, rating_figures
from loaded_tca.reports.rating_page import stage_rating_content
from loaded_tca.stages import StageResult, parse_stage
from loaded_tca.stages.analyse import _shared, states_of
from tests.refusals import refused_calls
from tests.samples.rating import HARD, RATED
from tests.samples.stages import analysed, stage_of_few_cells
from tests.stages.test_stage_rating import SECTIONS

ROUNDING = 1e-9  # exponents of S-N curves, up to 33, multiply rounding of stresses
TORQUES = 45.0, 150.0, 300.0, 480.0  # of the sun: even shares that both mesh cycles of the sample were solved for
REQUIRED = {"rating.required_flank_safety": 1.3, "rating.required_root_safety": 2.4}
"""With these most stresses lie on slopes of their curves."""

pytestmark = pytest.mark.filterwarnings(
    "ignore:rating.*leave edges out:loaded_tca.AccuracyWarning",
    "ignore:rating.*static strength:loaded_tca.AccuracyWarning",
)


@functools.cache
def solved():
    """The stage of few cells under several torques."""
    whole, _ = analysed()
    stage, cycles = whole.stage.with_changes({"analysis.torques_Nm": TORQUES}), (whole.sun_mesh, whole.ring_mesh)
    forces = cycles[0].dataset["torque"].values / cycles[0].gear_pair.base_radii[0]
    arrays = _shared(stage, 1e3 * np.array(TORQUES), forces, cycles)
    return replace(whole, stage=stage, dataset=StageResult.dataset_of(arrays, **whole.dataset.attrs))


def bins(*rows, **more):
    """Bins of (torque, hours), and keys that all of them have."""
    return [{"sun_torque_Nm": torque, "hours": hours} | more for torque, hours in rows]


def under(cases, **changes):
    """Rating of that stage under bins."""
    return rated(**{"load.case": cases} | changes)


def rated(**changes):
    """The same under each torque for itself."""
    result = solved()
    return replace(result, stage=result.stage.with_changes(SECTIONS | REQUIRED).with_changes(changes)).rating()


def test_one_bin_is_the_rating_at_its_torque():
    single, one = rated(), under(bins((480.0, 7.0)))
    assert_allclose(one.damage[0], single.damage[3], rtol=ROUNDING)
    assert_allclose(one.life_hours, single.life_hours[3], rtol=ROUNDING)
    assert_allclose(one.flank_safety[0], single.flank_safety[3], rtol=ROUNDING)
    assert_allclose(one.K_gamma[0], single.K_gamma[3], rtol=ROUNDING)
    assert_array_equal(one.interpolation_error, 0.0)
    assert (one.miner_sum[:, :2] > 0.0).any(axis=1).all()


def test_damage_of_bins_adds_up_by_hours_and_halves_are_one_bin():
    single = rated()
    parts = under(bins((300.0, 5.0), (480.0, 2.0), (300.0, 1.0)))
    assert_allclose(parts.miner_sum, 0.75 * single.damage[2] + 0.25 * single.damage[3], rtol=ROUNDING)
    assert_allclose(parts.damage.sum(axis=0), parts.miner_sum, rtol=ROUNDING)
    assert_allclose(parts.damage[0], 5.0 * parts.damage[2], rtol=ROUNDING)
    shares = [{"sun_torque_Nm": 300.0, "share": 0.75}, {"sun_torque_Nm": 480.0, "share": 0.25}]
    assert_allclose(under(shares).life_hours, parts.life_hours, rtol=ROUNDING)


def test_hours_of_bins_are_the_life_that_is_required():
    rows = bins((300.0, 4.0), (480.0, 2.0))
    asked, hours = under(rows, **{"rating.life_hours": 6.0}), under(rows, **{"rating.life_hours": None})
    assert_array_equal(hours.miner_sum, asked.miner_sum)
    assert hours.life_required == hours.sun_mesh.life_required == 6.0


def test_stage_of_equal_planets_is_its_single_meshes_with_cycles_by_hand():
    """K_gamma 1: pairs under even shares; a tooth of sun and ring meets all planets in a turn against the carrier."""
    rows = ((300.0, 3.0), (480.0, 1.0))
    stage = under(bins(*rows), **{"rating.mesh_load_factor": 1.0})
    sun, planet, ring = stage.stage.teeth
    planets, relative = len(stage.stage.stage.angles), 6000.0 * ring / (sun + ring)
    widths = [mesh.common_face_width for mesh in stage.stage.meshes]
    bent = HARD | {"root_stress_ratio": -1.2 * min(widths) / max(widths)}
    whole, meshes = solved(), []
    for cycle, speed, strengths, share in (
        (whole.sun_mesh, relative, (HARD, bent), 1.0),
        (whole.ring_mesh, relative * sun / planet, (bent, HARD), planet / sun),
    ):
        changes = {"pinion.strength": strengths[0], "wheel.strength": strengths[1]} | REQUIRED
        cases = [{"pinion_torque_Nm": share * torque / planets, "hours": hours} for torque, hours in rows]
        more = {"operation.pinion_speed_rpm": speed, "load.case": cases}
        meshes.append(replace(cycle, scene=cycle.scene.with_changes(RATED | changes | more)).rating().miner_sum)
    expected = [planets * meshes[0][0], np.maximum(meshes[0][1], meshes[1][0]), planets * meshes[1][1]]
    assert np.isfinite(expected[:2]).any()
    assert_allclose(stage.miner_sum, expected, rtol=1e-7)  # torques of the mesh cycles went through N m


def test_fillets_of_planets_are_drawn_by_both_meshes_where_bins_are_reversed():
    rating = under(bins((480.0, 1.0), (300.0, 4.0)) + bins((480.0, 3.0), reversed=True))
    back = np.array([False, False, True])
    of_mode = rating.modes.index("root")
    at_sun, at_ring = rating.sun_mesh.damage[:, 1, of_mode], rating.ring_mesh.damage[:, 0, of_mode]
    fillets = at_sun[~back].sum() + at_ring[back].sum(), at_ring[~back].sum() + at_sun[back].sum()
    assert fillets[0] != pytest.approx(fillets[1])
    assert_allclose(rating.miner_sum[1, of_mode], max(fillets), rtol=ROUNDING)
    assert_array_equal(rating.damage[2][:, rating.modes.index("flank")], 0.0)
    assert_allclose(rating.miner_sum[0, of_mode], rating.sun_mesh.damage[:, 0, of_mode].sum(), rtol=ROUNDING)


def test_note_on_reversed_bins_of_a_stage_names_what_stages_have():
    rating = under(bins((480.0, 1.0)) + bins((300.0, 3.0), reversed=True))
    notes = [note for note in rating.notes() if "their damage is not counted" in note]
    assert len(notes) == 1  # of both meshes alike
    assert "analyse with stage.driving changed and reversed swapped in every bin" in notes[0]
    assert "--coast" not in rating.summary()
    # the same bins, turned round on the stage whose other flanks are in contact, load these flanks alone
    turned = rating.stage.with_changes(
        {
            "stage.driving": "carrier",
            "load.case": bins((480.0, 1.0), reversed=True) + bins((300.0, 3.0)),
        }
    )
    assert turned.sun_scene.driving != rating.stage.sun_scene.driving
    assert turned.sun_scene.sense == rating.stage.sun_scene.sense


def test_planets_have_the_larger_damage_and_the_smaller_safety_of_both_sides():
    rating = under(bins((300.0, 1.0), (480.0, 1.0)))
    for name, worse in (("miner_sum", np.maximum), ("spectrum_safety", np.minimum), ("life_hours", np.minimum)):
        at_sun, at_ring = rating.sun_mesh.values(name)[1], rating.ring_mesh.values(name)[0]
        assert_allclose(rating.values(name)[1], worse(at_sun, at_ring), rtol=ROUNDING)
        assert (at_sun != at_ring).all()


def test_speed_of_a_bin_counts_its_load_cycles_against_the_carrier():
    rating = under(bins((300.0, 1.0)) + bins((300.0, 1.0), sun_speed_rpm=1500.0))
    sun, planet, ring = rating.stage.teeth
    planets, relative = len(rating.stage.stage.angles), ring / (sun + ring)
    turns = 60.0 * 10000.0 * relative * np.array([[6000.0], [1500.0]])
    assert_allclose(rating.cycles, turns * [planets, sun / planet, planets * sun / ring], rtol=ROUNDING)
    assert_allclose(rating.sun_mesh.pinion_speed, relative * np.array([6000.0, 1500.0]), rtol=ROUNDING)
    assert under(bins((300.0, 1.0), sun_speed_rpm=100.0), operation=None).K_A == 1.0


@pytest.mark.filterwarnings("ignore:rating. the damage of the spectrum may be wrong:loaded_tca.AccuracyWarning")
def test_mesh_load_factor_is_interpolated_and_no_planet_carries_more_than_all(monkeypatch):
    law = 1.3 * (np.array(TORQUES) / 300.0) ** -0.5  # powers of the torque are interpolated exactly
    result = solved()
    sharing = replace(result, dataset=result.dataset.assign(mesh_load_factor=("torque", law)))
    monkeypatch.setattr("tests.stages.test_stage_spectrum.solved", lambda: sharing)
    torques = np.array([480.0, 200.0, 40.0, 2.0, 0.0])
    rating = under(bins(*((torque, 1.0) for torque in torques)))
    expected = np.minimum(1.3 * (torques[:4] / 300.0) ** -0.5, len(rating.stage.stage.angles))
    assert_allclose(rating.K_gamma, [*expected, np.nan], rtol=ROUNDING)
    assert_allclose(rating.sun_mesh.K_gamma, rating.ring_mesh.K_gamma, rtol=ROUNDING)
    assert_array_equal(rating.damage[4], 0.0)


def test_error_of_interpolation_is_told_of_the_gears():
    cases = bins(*((torque, 1.0) for torque in np.linspace(60.0, 480.0, 15)))
    with pytest.warns(AccuracyWarning, match="damage of the spectrum may be wrong") as given:
        rating = under(cases)
    told = [str(one.message) for one in given if "spectrum may be wrong" in str(one.message)]
    assert len(told) == 1  # one of both meshes
    error = rating.interpolation_error
    assert_allclose(error[[0, 2]], [rating.sun_mesh.interpolation_error[0], rating.ring_mesh.interpolation_error[1]])
    assert_allclose(error[1, 1], rating.sun_mesh.interpolation_error[1, 1])
    assert f"wrong by {np.nanmax(error):.1%}" in told[0]
    with pytest.warns(AccuracyWarning):
        back = under(cases + bins((100.0, 1.0), (101.0, 1.0), reversed=True))
    # errors of the bins of both meshes add up, none counts less than in the mesh that does most of the damage
    assert error[1, 1] < back.interpolation_error[1, 1] < 4.0 * error[1, 1]


def test_many_bins_solve_no_more_torques_than_a_dozen():
    torques = np.linspace(50.0, 300.0, 500)
    stage = stage_of_few_cells().with_changes(
        {"analysis.torques_Nm": None, "load.case": bins(*((torque, 1.0) for torque in torques))}
    )
    dozen = stage.with_changes({"load.case": bins(*((1e-3 * torque, 1.0) for torque in stage.sun_torques))})
    assert len(stage.sun_torques) == len(dozen.sun_torques) == 12
    assert states_of(stage) == states_of(dozen)
    assert parse_stage(stage.to_toml()) == stage


@pytest.mark.filterwarnings("ignore:rating. the damage of the spectrum may be wrong:loaded_tca.AccuracyWarning")
def test_sentences_name_torques_of_the_sun_with_six_digits():
    notes = under(bins((299.913, 1.0), (20.0, 1.0)), **{"rating.life_hours": 12345.6}).notes()
    assert "bin 1 (299.913 N m) does 100 % of the damage" in notes[0]
    assert " in 12345.6 h, required 1.3, torque factor (S_H/S_Hmin)^2 = " in notes[0]
    assert sum("1 bin lies below 45 N m at the sun, the smallest analysed torque" in note for note in notes) == 1


def test_numbers_of_a_spectrum_stand_in_summary_and_files(tmp_path):
    rating = under(bins((300.0, 1.0), (480.0, 1.0)), title="Two bins")
    text = rating.summary()
    assert [line.split() for line in text.splitlines() if line.startswith("spectrum")] == [
        ["spectrum", "sun", "planet", "ring"]
    ]
    assert "ISO 6336-6:2019 with 2 bins, sun at 6000 rpm" in text
    assert sum("follow each other" in line for line in text.splitlines()) == 1  # not of each mesh
    assert not any(word in text for word in ("pinion", "wheel"))
    stored = json.loads(write_rating(rating, tmp_path)[0].read_text(encoding="utf-8"))
    assert stored["spectrum"]["bins"] == 2
    assert stored["spectrum"]["planet_root"]["miner_sum"] == rating.miner_sum[1, 1]
    assert stored["torques"][1]["ring_mesh_planet_Y_M"] == rating.ring_mesh.Y_M[1, 0]
    assert rating.key_figures()[0]["sun_root_equivalent_torque_Nm"] == 1e-3 * rating.equivalent_torque[0, 1]


IRON = {"kind": "GG", "sigma_H_lim_MPa": 300.0, "sigma_F_lim_MPa": 60.0, "proof_stress_MPa": 250.0}
IRON |= {"flank_Rz_um": 4.8, "root_Rz_um": 20.0}
BACK = [*bins((300.0, 1.0)), *bins((300.0, 1.0), reversed=True)]

test_bad_spectrum_is_refused = refused_calls(
    (lambda: under(bins((480.1, 1.0))), "load: a bin has 480.1 N m; allowed up to 480, the largest of analysis"),
    (
        lambda: under(bins((600.0, 1.0)), **{"analysis.torques_Nm": None}),
        "load.case: a bin has 600 N m; allowed up to 480, the largest analysed torque",
    ),
    (
        lambda: under(bins((300.0, 1.0)), operation=None),
        "operation: missing; strength, cycles and K_v depend on sun_speed_rpm, and bin 0 has no speed of its own",
    ),
    (
        lambda: under(BACK, **{"ring.strength": IRON}),
        r"load.case: reversed bins; the standard has no Y_M of kind 'GG' \(ring.strength\)",
    ),
    (lambda: under(bins((300.0, 0.0))), "load.case: the hours sum to 0; allowed above 0"),
    (lambda: under(bins((0.0, 1.0))), "load.case: no bin has a sun_torque_Nm above 0"),
    (lambda: under(bins((300.0, 1.0), reversed=True)), "load.case: all bins are reversed; change stage.driving"),
    (lambda: under(bins((300.0, -1.0))), "load.case: table 0: hours: found -1.0; allowed a number from 0"),
    (lambda: under([{"pinion_torque_Nm": 3.0, "hours": 1.0}]), 'pinion_torque_Nm: unknown key; did you mean "sun_tor'),
    (lambda: rated(**{"load.sun_torque_Nm": None}), "load.sun_torque_Nm: missing; give a torque, or the bins"),
    (
        lambda: under([{"sun_torque_Nm": 300.0, "share": 1.0}], **{"rating.life_hours": None}),
        "rating.life_hours: missing; needed unless load cases have hours",
    ),
)


def test_planets_of_cast_iron_are_rated_under_reversed_bins():
    rating = under(BACK, **{"planet.strength": IRON})
    assert_array_equal(rating.sun_mesh.Y_M[:, 1], 0.7)


def test_spectrum_of_a_file(tmp_path):
    file = tmp_path / "bins.csv"
    file.write_text("sun_torque_Nm,hours,reversed\n300,4\n480,1,true\n", encoding="utf-8")
    text = solved().stage.with_changes(SECTIONS | REQUIRED | {"load.sun_torque_Nm": 480.0}).to_toml()
    stage = parse_stage(text.replace("sun_torque_Nm = 480.0", 'spectrum = "bins.csv"'), folder=tmp_path)
    assert (
        stage.load.case
        == stage.with_changes({"load.case": bins((300.0, 4.0)) + bins((480.0, 1.0), reversed=True)}).load.case
    )
    file.write_text("pinion_torque_Nm,hours\n300,4\n", encoding="utf-8")
    with pytest.raises(InputError, match="no column sun_torque_Nm; found pinion_torque_Nm"):
        stage.with_changes({"load.spectrum": str(file)})


def test_report_tells_gears_and_both_meshes_in_their_words(monkeypatch):
    monkeypatch.setattr("loaded_tca.reports.rating_page.rating_figures", lambda _: {})  # seconds, and tested below
    rating = under(bins((150.0, 9.0), (300.0, 3.0), (480.0, 1.0)))
    content = stage_rating_content(rating.result)
    assert content["safeties"].head[0] == "all bins together"
    assert [float(cell) for cell in content["safeties"].rows[0][2::2]] == pytest.approx(
        rating.spectrum_safety[:, 0].tolist(), rel=1e-3
    )
    captions = [table.caption for table in content["tables"]]
    assert captions[:2] == ["Loads of sun, planets and ring", "Safeties; of planets the smaller one of both meshes"]
    of_roots = [caption for caption in captions if caption.startswith("Planet and ring: Roots, ISO 6336-3;")]
    assert len(of_roots) == 1  # in the two worst bins
    assert content["tables"][-1].head[1].endswith("N m, planet")
    assert "by local stresses the critical failure is pitting of the sun" in content["findings"][1]
    assert stage_rating_content(solved()) is None
    lacking = replace(rating.result, stage=rating.stage.with_changes({"lubricant": None}))
    (refused,) = stage_rating_content(lacking)["refused"]
    assert refused.startswith("lubricant: missing")


@pytest.mark.thorough
def test_pictures_have_a_bar_and_a_curve_of_each_gear():
    rating = under(bins((300.0, 3.0), (480.0, 1.0)))
    (bars,) = plot_safeties(rating).axes
    order = [0, 2, 1]  # flanks first, each of the standard first
    assert_allclose([bar.get_width() for bar in bars.patches], rating.spectrum_safety[:, order].T.ravel())
    damage = plot_damage(rating).axes[1]
    assert damage.get_xlabel() == "sun torque [N m]"
    assert sum(bar.get_height() for bar in damage.patches) == pytest.approx(rating.miner_sum[:, 1].sum())
    curves = plot_sn_curves(rating).axes[1]
    assert [line.get_label() for line in curves.lines[::2]] == ["sun", "planet", "ring"]
    assert_allclose(curves.lines[3].get_xdata(), rating.cycles[:, 1])
    # one mesh alone has the stresses of the planet, times the required safety
    assert_allclose(curves.lines[3].get_ydata(), 2.4 * rating.sun_mesh.sigma_F[:, 1], rtol=ROUNDING)
    assert [*rating_figures(rating)] == ["safeties", "rating_sn_curves", "rating_damage"]


@pytest.mark.thorough
def test_command_rates_a_stage_again_under_a_spectrum(run, tmp_path, monkeypatch):
    monkeypatch.setattr("loaded_tca.plots.rating_figures", lambda _: {})
    result, _ = analysed()
    hours = {"load.case": bins((300.0, 1.0)), "rating.life_hours": None}
    replace(result, stage=result.stage.with_changes(SECTIONS | REQUIRED | hours)).save(tmp_path)
    (tmp_path / "bins.csv").write_text("sun_torque_Nm,hours,reversed\n300,3,\n300,1,true\n", encoding="utf-8")
    (tmp_path / "root_safety.png").touch()  # of another rating
    code, text, _ = run("rating", str(tmp_path), "--set", f"load.spectrum={tmp_path / 'bins.csv'}")
    assert code == 0
    expected = under(bins((300.0, 3.0)) + bins((300.0, 1.0), reversed=True), **{"rating.life_hours": None})
    assert all(line in text for line in expected.summary().splitlines() if line.startswith("root: "))
    assert not (tmp_path / "root_safety.png").exists()
    stored = json.loads((tmp_path / "rating.json").read_text(encoding="utf-8"))
    assert stored["spectrum"]["ring_root"]["life_h"] == pytest.approx(expected.life_hours[2, 1], rel=1e-6)  # six digits
    code, _, errors = run("rating", str(tmp_path), "--set", "load.sun_torque_Nm=20")
    assert code == 2
    assert "load.sun_torque_Nm: needs another analysis; allowed keys of [sun.strength]" in errors[0]


TENSIONS = {"sun_mesh": (5e-3, 4e-3), "ring_mesh": (5.5e-3, 3e-3)}
"""Of the roots of both gears of a mesh [MPa] over the torque of its pinion [N mm]."""
PRESSED, AT_PLACE = {"sun_mesh": 0.7, "ring_mesh": 0.5}, -0.1
"""Largest compression of a root by its mesh over its largest tension; smallest over largest stress of each place."""


def with_root_stress(cycle, name):
    """A mesh cycle with roots under stresses in proportion to the torque, on a fillet of four nodes."""
    torque = cycle.dataset["torque"].values
    tension = torque[:, None] * TENSIONS[name]
    over_pitch = np.array([0.5, 1.0, 0.8, 0.6, 0.5])[:, None] * tension[:, None]
    nodes = np.array([[[1.0, 0.9], [0.8, 0.7]], [[0.3, 0.3], [0.2, 0.2]]])
    dims = "torque", "position", "gear"
    arrays = {"root_tension": (dims, over_pitch), "root_compression": (dims, -PRESSED[name] * over_pitch)}
    for n, gear in enumerate(("pinion", "wheel")):
        of_nodes = "side", "station", f"{gear}_along"
        largest = tension[:, n, None, None, None] * nodes
        arrays |= {
            f"{gear}_root_angle": (of_nodes, np.ones(nodes.shape)),
            f"{gear}_root_point": ((*of_nodes, "vector"), np.zeros((*nodes.shape, 3))),
        }
        for which, values in (("at_tension", largest), ("largest", largest), ("smallest", AT_PLACE * largest)):
            arrays[f"{gear}_root_stress_{which}"] = (("torque", *of_nodes), values)
    scene = cycle.scene.with_changes({"analysis.root_stress": True})
    return replace(cycle, scene=scene, dataset=cycle.dataset.assign(arrays))


def test_local_roots_of_planets_add_up_the_bins_that_draw_each_fillet_by_hand():
    """Palmgren and Miner on lines of ISO 6336-6 from 1e3 to 3e6 cycles, Y_M by annex B of ISO 6336-3:2006."""
    stage = solved().stage.with_changes(
        SECTIONS | REQUIRED | {"analysis.root_stress": True, "rating.mesh_load_factor": 1.0}
    )
    rows = bins((480.0, 2.0), (300.0, 5.0)) + bins((300.0, 3.0), reversed=True)
    meshes = {name: with_root_stress(getattr(solved(), name), name) for name in TENSIONS}
    result = replace(solved(), stage=stage.with_changes({"load.case": rows}), **meshes)
    rating = result.rating()
    back, hours = np.array([False, False, True]), 20000.0 * np.array([0.2, 0.5, 0.3])
    sun, planet, ring = stage.teeth
    shares = np.array([480.0, 300.0, 300.0]) * 1e3 / len(stage.stage.angles)
    by_others = -1.2 * np.array([300.0 / 480.0, 1.0, 1.0])  # the same mesh on the other flank, at most its own load
    tension = {"sun_mesh": 4e-3 * shares, "ring_mesh": 5.5e-3 * shares * planet / sun}
    presses = {name: -PRESSED[name] * tension[name] for name in TENSIONS}
    turns = 60.0 * 6000.0 * ring / (sun + ring) * sun / planet
    damages, mode = {}, rating.modes.index("local_root")
    for name, other, place in (("sun_mesh", "ring_mesh", 1), ("ring_mesh", "sun_mesh", 0)):
        mesh = getattr(rating, name)
        ratio = np.maximum(np.minimum(presses[other] / tension[name], by_others), -1.2)
        sensitivities = 0.8 - 0.15 * mesh.Y_S[:, place], 0.7  # of the endurance and of the static strength
        mean, at_rest = (1.0 / (1.0 - ratio * (1.0 - each) / (1.0 + each)) for each in sensitivities)
        assert_allclose(mesh.local_root_stress[:, place], tension[name], rtol=1e-6)  # torques went through N m
        assert_allclose(mesh.local_stress_ratio[:, place], ratio, rtol=1e-6)
        assert_allclose(mesh.local_Y_M[:, place], mean, rtol=1e-6)
        allowable = mesh.sigma_F_lim[:, place] * mesh.Y_ST[:, place]
        static = 2.5 * allowable * mesh.Y_delta_relT_static[:, place] * at_rest
        endured = allowable * mean
        for factor in ("Y_delta_relT", "Y_R_relT", "Y_X"):
            endured = endured * mesh.values(factor)[:, place]
        exponent = np.log(3e6 / 1e3) / np.log(static / endured)
        lasts = 3e6 * (endured / (2.4 * tension[name])) ** exponent
        assert ((lasts > 1e3) & (lasts < 3e6)).all()  # all bins lie on that line
        damages[name] = turns * hours / lasts
        assert_allclose(mesh.damage[:, place, mode], damages[name], rtol=1e-4)  # powers of 8 of torques to 1e-6
    fillets = [
        np.where(back, damages[drawn_back], damages[drawn]).sum()
        for drawn, drawn_back in (("sun_mesh", "ring_mesh"), ("ring_mesh", "sun_mesh"))
    ]
    assert fillets[0] != pytest.approx(fillets[1], rel=0.01)
    assert_allclose(rating.miner_sum[1, mode], max(fillets), rtol=1e-4)
    least = [rating.sun_mesh.local_root_safety[:, 1], rating.ring_mesh.local_root_safety[:, 0]]
    assert_allclose(rating.local_root_safety[:, 1], np.minimum(*least), rtol=ROUNDING)
