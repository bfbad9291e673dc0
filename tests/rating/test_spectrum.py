"""Ratings under load spectra: closed forms of bins, reversed and idle ones, what is told and refused."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.text import Annotation, Text
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.arrays import GEARS
from loaded_tca.errors import AccuracyWarning, InputError
from loaded_tca.output import write_rating
from loaded_tca.plain import plain
from loaded_tca.plots import RATING_PICTURES, plot_flank_safety, plot_root_safety, plot_safeties
from loaded_tca.plots import rating_figures as rating_pictures
from loaded_tca.plots.style import note_of
from loaded_tca.rating import flank_safeties, root_safeties
from loaded_tca.rating.cases import cases_of
from loaded_tca.rating.findings import findings
from loaded_tca.rating.places import worst_case
from loaded_tca.rating.solved import SolvedLoads
from loaded_tca.rating.spectrum import told_error
from loaded_tca.rating.utilisation import utilisation_of
from loaded_tca.reports.rating_page import rating_content
from loaded_tca.studies import rating_figures
from loaded_tca.warning_kinds import SPECTRUM_UNKNOWN, kind_of
from tests.refusals import refusals
from tests.samples.rating import HARD, bevel_solved, solved

pytestmark = pytest.mark.filterwarnings("ignore:rating. the damage of the spectrum has no estimate")  # two torques
KINDS = "flank", "root"
ROUNDING = 1e-9  # exponents of S-N curves, up to 33, multiply rounding of stresses
GIVEN = {"rating.dynamic_factor": "given", "rating.transverse_load_factor": 1.0, "rating.face_load_factor": 1.0}
SLOPES = {"operation.application_factor": 1.6, "rating.required_flank_safety": 1.9, "rating.required_root_safety": 5.0}
"""With these all stresses lie on slopes of their curves."""


def bins(*rows, **more):
    """Bins of (torque, hours), and keys that all of them have."""
    return [{"pinion_torque_Nm": torque, "hours": hours} | more for torque, hours in rows]


def under(cases, **changes):
    """The spur pair solved under 100 and 200 N m, rated under bins."""
    spectrum = {"analysis.torques_Nm": (100.0, 200.0), "load.case": cases}
    return solved(**GIVEN | SLOPES | spectrum | changes).rating()


ON_OTHER_FLANKS = [*bins((0.0, 1.0)), *bins((150.0, 1.0), reversed=True)]


def alone(**changes):
    """The same under both torques, each for itself."""
    return solved(**GIVEN | SLOPES | changes).rating()


def test_one_bin_lasts_as_long_as_its_torque_alone():
    one, single = under(bins((200.0, 50.0))), alone()
    assert one.life_hours.shape == (2, 4)
    assert_allclose(one.life_hours, single.life_hours[1], rtol=ROUNDING)
    assert_allclose(one.damage[0], single.damage[1], rtol=ROUNDING)
    assert_allclose(one.flank_safety[0], single.flank_safety[1], rtol=ROUNDING)


def test_one_bin_above_the_solved_torque_by_rounding_is_rated_by_the_power_of_the_torque():
    """sigma_H ~ sqrt(T), sigma_F ~ T: safeties on slopes of S-N curves change by rounding, 5e-6, and no more."""
    rounded, exact = under(bins((200.001, 50.0))), under(bins((200.0, 50.0)))
    assert_allclose(rounded.flank_safety[0] / exact.flank_safety[0], 1.0 - 0.5 * 5e-6, rtol=1e-6)
    assert_allclose(rounded.root_safety[0] / exact.root_safety[0], 1.0 - 5e-6, rtol=1e-6)


def test_rating_takes_the_viscosity_at_40_degrees_alone():
    """Of the oil ISO 6336-2 has nothing else."""
    whole = solved(**GIVEN).rating()
    oil = {"viscosity_40_mm2_s": solved(**GIVEN).scene.lubricant.viscosity_40_mm2_s}
    part = solved(**GIVEN | {"lubricant": oil}).rating()
    assert_array_equal(part.flank_safety, whole.flank_safety)


def test_one_bin_at_the_knee_has_the_life_of_the_knee():
    curve, stress = alone().endurances["flank"][0].curve, float(alone().sigma_H[1, 0])
    # Z_NT = 1 at 5e7 load cycles of case-hardened flanks, ISO 6336-2; sigma_H times the safety is that strength
    safety = float(np.ravel(curve.stresses[1])[0]) / stress
    one = under(bins((200.0, 1.0)), **{"rating.required_flank_safety": safety})
    assert_allclose(one.dataset.life_hours.sel(gear="pinion", mode="flank"), 5e7 / (60.0 * 1500.0), rtol=1e-6)


def test_damage_of_two_bins_adds_up_by_hours():
    rows, single = ((100.0, 30.0), (200.0, 10.0)), alone()
    two = under(bins(*rows))
    expected = 20000.0 * (0.75 / single.life_hours[0] + 0.25 / single.life_hours[1])
    assert_allclose(two.miner_sum, expected, rtol=ROUNDING)
    assert_allclose(two.life_hours, 20000.0 / expected, rtol=ROUNDING)
    assert_allclose(two.damage.sum(axis=0), two.miner_sum, rtol=ROUNDING)
    assert (two.miner_sum[:, 0] > 0.0).all()
    assert any("40 h, follow each other 500 times" in note for note in two.notes())


def test_hours_and_shares_say_the_same():
    by_hours = under(bins((100.0, 15000.0), (200.0, 5000.0)), **{"rating.life_hours": None})
    shares = [{"pinion_torque_Nm": 100.0, "share": 0.75}, {"pinion_torque_Nm": 200.0, "share": 0.25}]
    assert_allclose(under(shares).damage, by_hours.damage, rtol=ROUNDING)
    assert_allclose(by_hours.hours, [15000.0, 5000.0], rtol=ROUNDING)


def test_safety_of_a_spectrum_is_that_at_which_its_life_is_the_required_one():
    rated = under(bins((100.0, 30.0), (200.0, 10.0)))
    for place in range(2):
        flank, root = rated.spectrum_safety[place, :2]
        changes = {"rating.required_flank_safety": float(flank), "rating.required_root_safety": float(root)}
        lives = under(bins((100.0, 30.0), (200.0, 10.0)), **changes).life_hours[place, :2]
        assert_allclose(lives, 20000.0, rtol=1e-6)  # safeties are iterated to 1e-12, exponents are up to 33


def test_equivalent_torque_of_equal_bins_is_theirs_and_lies_between_unequal_ones():
    equal = under(bins((200.0, 1.0), (200.0, 3.0)))
    assert_allclose(equal.equivalent_torque, 200e3, rtol=ROUNDING)
    unequal = under(bins((100.0, 1.0), (200.0, 1.0)))
    # from 1.6 sigma_H_lim at 1e5 load cycles to sigma_H_lim Z_L Z_v Z_R at 5e7, ISO 6336-2; stress is a root of torque
    reference = float(unequal.Z_L[0, 0] * unequal.Z_v[0, 0] * unequal.Z_R[0, 0])
    exponent = 0.5 * np.log(500.0) / np.log(1.6 / reference)
    expected = 1e3 * (0.5 * (100.0**exponent + 200.0**exponent)) ** (1.0 / exponent)
    assert_allclose(unequal.dataset.equivalent_torque.sel(gear="pinion", mode="flank"), expected, rtol=ROUNDING)


def test_speed_of_a_bin_counts_its_load_cycles_beside_quicker_ones():
    both = under(bins((200.0, 1.0)) + bins((200.0, 1.0), pinion_speed_rpm=750.0))
    assert_allclose(both.cycles[1], 0.5 * both.cycles[0], rtol=ROUNDING)
    assert_allclose(both.damage[1, :, 1], 0.5 * both.damage[0, :, 1], rtol=ROUNDING)
    assert (both.Z_v[1] < both.Z_v[0]).all()


def test_bins_with_speeds_need_no_operation():
    whole = solved(**GIVEN, **{"load.case": bins((200.0, 1.0), pinion_speed_rpm=1500.0), "operation": None})
    assert whole.rating().K_A == 1.0


def test_reversed_bins_load_the_other_flanks_and_bend_roots_both_ways():
    plain, back = under(bins((100.0, 1.0), (200.0, 1.0))), bins((100.0, 1.0), (200.0, 1.0))
    back[0]["reversed"] = True
    rated = under(back)
    assert_array_equal(rated.damage[0, :, [0, 2]], 0.0)
    assert_array_equal(rated.flank_safety[0], np.inf)
    first, second = rated.key_figures()
    for name in ("sigma_H_MPa", "flank_safety", "local_flank_safety"):
        assert np.isnan(first[f"pinion_{name}"])  # of flanks that are not analysed
        assert np.isfinite(second[f"pinion_{name}"])
    cells = {line.split("  ")[0]: line.split()[-6:] for line in rated.summary().splitlines()}
    assert cells["contact stress sigma_H [MPa]"][:3] == cells["safety against pitting S_H"][:3] == ["-", "|", "-"]
    assert cells["torque reversed (1: yes, 0: no)"][-2:] == ["1", "0"]
    assert_allclose(rated.damage[1][:, [0, 2]], plain.damage[1][:, [0, 2]], rtol=ROUNDING)
    sensitivity = 0.8 - 0.15 * rated.Y_S  # case-hardened, annex B of ISO 6336-3:2006
    # R = -1.2 times the load of the other flank over that of the bin, at most 1: no result of the other flank has it
    ratio = np.array([[-1.2], [-1.2 * 100.0 / 200.0]])
    assert_allclose(rated.Y_M, 1.0 / (1.0 - ratio * (1.0 - sensitivity) / (1.0 + sensitivity)), rtol=ROUNDING)
    assert_allclose(rated.root_safety, rated.Y_M * plain.root_safety, rtol=ROUNDING)
    assert (rated.damage[..., 1] > plain.damage[..., 1]).all()
    assert any(
        note.startswith("reversed bins (1 of 2) load the other flanks, which are not analysed")
        for note in rated.notes()
    )


def test_idle_bins_take_their_time_and_do_no_damage():
    idle, loaded = under(bins((0.0, 1.0), (200.0, 1.0))), under(bins((200.0, 1.0)))
    assert_array_equal(idle.damage[0], 0.0)
    assert_array_equal(idle.root_safety[0], np.inf)
    assert_allclose(idle.life_hours, 2.0 * loaded.life_hours, rtol=ROUNDING)
    factors = {label: cells for label, *cells in idle.rows(idle.key_figures())}
    assert factors["face load factor K_Hbeta"][0] == "-"
    assert factors["face load factor K_Hbeta"][1] != "-"
    assert_array_equal(idle.interpolation_error, 0.0)  # no torque lies between those that were solved
    assert not any("interpolated" in note or "lie below" in note for note in idle.notes())


def test_a_bin_above_the_static_strength_leaves_no_life():
    rated = under(bins((100.0, 1.0), (200.0, 1e-6)), **{"rating.required_root_safety": 20.0})
    assert_array_equal(rated.dataset.life_hours.sel(mode="root"), 0.0)
    assert any("pinion: root: life 0 at the required safety 20" in note for note in rated.notes())


def test_powers_of_the_torque_are_interpolated_without_error():
    torque, places = np.array([1e5, 2e5, 3e5, 5e5]), np.zeros((2, 4, 2))
    nodes = SolvedLoads(
        torque, 2.0 * torque**-0.1, np.ones(4), 1.5 * torque**-0.02, torque**0.4, places,
        np.stack([torque, 2.0 * torque**1.1], axis=-1), np.full((4, 2), -0.3), np.ones((4, 2)), places,
    )  # fmt: skip
    wanted = np.array([5e4, 1e5, 1.7e5, 4.9e5])
    found = nodes.at(wanted)
    assert_allclose(found.face_load_factor, 2.0 * wanted**-0.1, rtol=ROUNDING)
    assert_allclose(found.mesh_load_factor, 1.5 * wanted**-0.02, rtol=ROUNDING)
    assert_allclose(found.pressure, wanted**0.4, rtol=ROUNDING)
    assert_allclose(found.root_tension[:, 1], 2.0 * wanted**1.1, rtol=ROUNDING)
    assert_allclose(found.root_stress_ratio, -0.3, rtol=ROUNDING)
    assert_allclose(nodes.every_second().torque, [1e5, 3e5, 5e5])


def test_solved_torques_count_as_they_are_and_have_no_error():
    rated = under(bins((100.0, 1.0), (200.0, 1.0)))
    assert_array_equal(rated.interpolation_error, 0.0)
    between = under(bins((100.0, 1.0), (150.0, 1.0), (200.0, 1.0)))
    assert np.isnan(between.interpolation_error).all()
    assert any(
        "1 of 3 bins are interpolated between 2 analysed torques: there is no estimate" in note
        for note in between.notes()
    )
    assert ((between.sigma_H[0] < between.sigma_H[1]) & (between.sigma_H[1] < between.sigma_H[2])).all()


def test_kinks_between_torques_are_told(monkeypatch):
    torque = np.linspace(1e5, 2e5, 8)
    kinked = np.maximum(1.0, torque / 1.5e5)
    ones, places = np.ones(8), np.zeros((2, 8, 2))
    excitation = dict.fromkeys(("mesh_stiffness", "transmission_error_span", "transmission_error_order_1"), ones)
    loads = SolvedLoads(torque, 1.2 * kinked, ones, ones, 900.0 * kinked, places, excitation=excitation)
    monkeypatch.setattr("loaded_tca.rating.call.solved_loads", lambda _: loads)
    cases = bins(*((torque, 1.0) for torque in np.linspace(100.0, 200.0, 41)))
    changes = {
        "analysis.root_stress": False,
        "rating.face_load_factor": "analysis",
        "operation.application_factor": 4.0,
    }
    whole = solved(**GIVEN | changes | {"load.case": cases})
    with pytest.warns(AccuracyWarning, match="rating: the damage of the spectrum may be wrong by"):
        rated = whole.rating()
    assert (rated.interpolation_error[:, 0] > 0.01).all()


def test_damage_between_fewer_than_four_solved_torques_has_no_estimate_and_says_so():
    changes = {"analysis.torques_Nm": (100.0, 200.0), "load.case": bins((200.0, 1.0), (120.0, 2.0))}
    result = solved(**GIVEN | SLOPES | changes)
    with pytest.warns(AccuracyWarning, match="no estimate of its error: 2 analysed torques of at least 4"):
        rated = result.rating()
    assert np.isnan(rated.interpolation_error).all()
    (sentence,) = told_error(np.full((2, 2), np.nan), 3)
    assert kind_of(sentence) is SPECTRUM_UNKNOWN
    assert told_error(np.zeros((2, 2)), 3) == []  # no bin between them


@pytest.mark.filterwarnings("error")
def test_solved_torques_of_every_bin_leave_nothing_to_estimate():
    cases = bins((100.0, 1.0), (200.0, 2.0))
    assert not under(cases).interpolation_error.any()


def test_summary_shows_all_bins_together_and_those_of_the_largest_damage():
    rated = under(bins(*((100.0 + 10.0 * n, 1.0) for n in range(11))))
    text = rated.summary()
    assert "ISO 6336-6" not in text.splitlines()[0]
    assert "-6:2019 with 11 bins" in text
    assert "8 of 11 bins, of the largest damage" not in text.splitlines()[2]
    heads = [line.split() for line in text.splitlines() if line.startswith("bin ")]
    assert [number for _, *numbers in heads for number in numbers] == [*map(str, range(4, 12))]
    of_tables = [line for line in text.splitlines() if not line.startswith(("note: ", "ISO 6336"))]
    assert 100 < max(map(len, of_tables)) <= 120
    figures = rated.key_figures()
    assert len(figures) == 11
    assert figures[0]["pinion_flank_life_h"] == figures[10]["pinion_flank_life_h"] == rated.life_hours[0, 0]
    assert figures[3]["wheel_root_damage"] == rated.damage[3, 1, 1]
    assert figures[0]["pinion_root_equivalent_torque_Nm"] == pytest.approx(1e-3 * rated.equivalent_torque[0, 1])
    assert rated.figures["wheel_local_root_damage"].of(rated.under(2)) == rated.damage[2, 1, 3]


def test_list_of_torques_is_no_spectrum():
    cases = cases_of(solved().scene, np.array([1e5, 2e5]))
    assert not cases.is_spectrum
    assert_array_equal(cases.hours, 20000.0)
    single = alone()
    assert_allclose(single.damage, 20000.0 / single.life_hours, rtol=ROUNDING)


CAST = {"kind": "GG", "hardness_HBW": 200.0, "proof_stress_MPa": 250.0}
test_spectra_refuse = refusals(
    lambda cases, changes: under(cases, **changes),
    (bins((300.0, 1.0)), {"analysis.torques_Nm": None}, "load.case: a bin has 300 N m; allowed up to 200"),
    (bins((200.0, 1.0)), {"operation": None}, "operation: missing; .* K_v depend on pinion_speed_rpm, and bin 0 has"),
    (
        [*bins((100.0, 1.0)), *bins((200.0, 1.0), reversed=True)],
        {"wheel.strength": HARD | {"material": None} | CAST},
        r"load.case: reversed bins; the standard has no Y_M of kind 'GG' \(wheel.strength\)",
    ),
)  # fmt: skip


def test_torques_in_place_of_those_of_a_spectrum_reach_its_largest():
    scene = replace(solved()).scene
    with pytest.raises(
        InputError, match=r"load: a bin has 300 N m; allowed up to 200, the largest of analysis.torques_Nm"
    ):
        scene.with_changes({"load.case": bins((300.0, 1.0))})


@pytest.mark.filterwarnings("ignore:rating.*leave edges out:loaded_tca.AccuracyWarning")
def test_bins_of_bevel_pairs_add_up_by_hours():
    changes = {"operation.application_factor": 2.0, "rating.transverse_load_factor": "method B"}
    rows, single = bins((150.0, 30.0), (300.0, 10.0)), bevel_solved(**changes).rating()
    rated = bevel_solved(**changes, **{"load.case": rows}).rating()
    assert rated.modes == ("flank", "root", "local_flank")
    expected = 1000.0 * (0.75 / single.life_hours[0] + 0.25 / single.life_hours[1])
    assert_allclose(rated.miner_sum, expected, rtol=ROUNDING)
    assert (rated.miner_sum[:, 0] > 0.0).all()
    assert "ISO 10300-2 and -3:2023, method B1, ISO 6336-6:2019 with 2 bins" in rated.scope


def test_places_are_those_of_bins_that_load_the_analysed_flanks():
    rated = under([*bins((0.0, 1.0)), *bins((200.0, 1.0), reversed=True), *bins((200.0, 1.0))])
    places = flank_safeties(rated, 2)
    assert_allclose(places.safety.min(axis=1), rated.local_flank_safety[2], rtol=ROUNDING)
    assert "(bin 3 of 3)" in plot_flank_safety(rated).get_suptitle()
    case, why = worst_case(rated, "local_root_safety")
    assert case == 2  # the reversed bin has less, and no places
    assert "drive-side bins" in why
    for gear in range(2):
        least = np.nanmin(root_safeties(rated, 2, gear).safety)
        assert_allclose(least, rated.local_root_safety[2, gear], rtol=ROUNDING)
    for case, words in ((0, "case: 0, 0 N m, is idle"), (1, "case: 1, 200 N m, is reversed")):
        with pytest.raises(InputError, match=words):
            root_safeties(rated, case, 0)


def test_maps_are_those_of_the_bin_of_the_largest_damage():
    rows, forever = bins((200.0, 0.02), (100.0, 19999.98)), {"rating.long_life_factor": 1.0}
    least = under(rows, **forever)
    safe = {f"rating.required_{kind}_safety": 0.99 * getattr(least, f"local_{kind}_safety")[1].min() for kind in KINDS}
    rated = under(rows, **forever, **safe)
    for name in ("local_flank_safety", "local_root_safety"):
        # the small torque has the smaller safety, and is borne for ever; the large one, of 1800 load cycles, is not
        assert rated.values(name).min(axis=1).argmin() == 1
        assert worst_case(rated, name) == (0, "largest damage of bins")
    figure = plot_flank_safety(rated)
    assert "bin 1 of 2" in figure.get_suptitle()
    assert any("largest damage of bins" in text.get_text() for text in figure.findobj(Text))
    assert worst_case(under(rows, **forever, **dict.fromkeys(safe, 0.5)), name)[0] == 1, "no damage at all"


@pytest.mark.parametrize(("more", "highest"), [((), 0.0), (bins((100.0, 1.0), reversed=True), -1.2 * 100.0 / 180.0)])
def test_maps_between_analysed_torques_are_those_of_the_nearest_with_interpolated_stresses(more, highest):
    """By hand: between two torques stresses and R are straight over the logarithm of the torque, stresses in theirs."""
    rated, single = under([*bins((180.0, 1000.0), (200.0, 0.001)), *more]), alone()
    part = np.log(200.0 / 180.0) / np.log(200.0 / 100.0)
    near, there = flank_safeties(rated, 1), flank_safeties(rated, 0)
    assert_array_equal(there.point, near.point)
    assert_allclose(there.safety.min(axis=1), rated.local_flank_safety[0], rtol=ROUNDING)
    less = (single.local_flank_stress[1] / single.local_flank_stress[0]) ** part
    strength = rated.sigma_HG[0] / rated.sigma_HG[1]  # Z_NT of more load cycles
    ratios = np.broadcast_to(less * strength[:, None], near.safety.shape)
    assert_allclose(there.safety / near.safety, ratios, rtol=ROUNDING)
    for gear in range(2):
        places, stress = root_safeties(rated, 0, gear).safety, rated.result.root_stress[gear]
        assert_allclose(np.nanmin(places), rated.local_root_safety[0, gear], rtol=ROUNDING)
        tensions = np.nanmax(rated.result.root_tension[..., gear], axis=1)
        of_place = single.local_root_stress[:, gear] if highest == 0.0 else tensions
        tense = stress.largest[1] > 0.0
        largest, smallest = stress.largest[1][tense], stress.smallest[1][tense]
        change = part * (single.local_stress_ratio[0, gear] - single.local_stress_ratio[1, gear])
        reversal = np.clip(smallest / largest + change, -1.2, highest)
        # Goodman's line, annex B of ISO 6336-3:2006, case-hardened
        sensitivity = 0.8 - 0.15 * rated.Y_S[0, gear]
        mean = 1.0 / (1.0 - reversal * (1.0 - sensitivity) / (1.0 + sensitivity))
        top = tensions[1] / np.nanmax(stress.largest[1]) * (of_place[0] / of_place[1]) ** part
        expected = rated.local_sigma_FG[0, gear] / rated.local_Y_M[0, gear] * mean / (1.6 * top * largest)
        assert_allclose(places[tense], expected, rtol=ROUNDING)


def test_maps_are_those_of_the_worst_bin_though_its_torque_was_not_analysed():
    rated = under(bins((180.0, 1000.0), (200.0, 0.001)))
    assert rated.local_flank_safety[0].min() < 0.9 * rated.local_flank_safety[1].min(), "of far more load cycles"
    assert worst_case(rated, "local_flank_safety")[0] == 0
    for mode, figure in ((2, plot_flank_safety(rated)), (3, plot_root_safety(rated))):
        assert "180 N m (bin 1 of 2)" in figure.get_suptitle()
        together = " | ".join(f"{gear} {plain(rated.spectrum_safety[n, mode])}" for n, gear in enumerate(GEARS))
        assert f"all bins together: {together}" in note_of(figure)
        assert "places as under 200 N m, the nearest analysed torque; stresses interpolated" in note_of(figure)
        crosses = [float(text.get_text()) for text in figure.findobj(Annotation)]
        # numbers of a picture have four digits
        expected = rated.values(("local_flank_safety", "local_root_safety")[mode - 2])[0]
        assert_allclose(crosses, expected, rtol=1e-3)


def test_pictures_of_places_are_left_out_where_no_bin_loads_the_analysed_flanks(monkeypatch):
    drawn = {name: picture._replace(draw=lambda _: None) for name, picture in RATING_PICTURES.items()}
    monkeypatch.setattr("loaded_tca.plots.rating.RATING_PICTURES", drawn)
    solved_bin = {*rating_pictures(under(bins((200.0, 1.0))))}
    assert solved_bin - {*rating_pictures(under(ON_OTHER_FLANKS))} == {
        "flank_safety",
        "root_safety",
    }


def test_picture_of_an_earlier_rating_does_not_stay(tmp_path):
    (tmp_path / "flank_safety.png").write_bytes(b"of other bins")
    files = write_rating(
        under(ON_OTHER_FLANKS),
        tmp_path,
        outdated=["flank_safety.png", "rating.csv"],
    )
    assert {*tmp_path.iterdir()} == {*files} == {tmp_path / "rating.json", tmp_path / "rating.csv"}


def test_picture_of_safeties_has_that_of_all_bins_together():
    rated = under(bins((100.0, 30.0), (200.0, 10.0)))
    (axes,) = plot_safeties(rated).axes
    lengths = [bar.get_width() for bar in axes.patches]
    order = [0, 2, 1, 3]  # flanks, then roots, each of the standard first
    assert_allclose(lengths, rated.spectrum_safety[:, order].T.ravel(), rtol=ROUNDING)
    assert axes.get_xlabel() == "safety of all bins together; strokes: each bin alone"


def test_roots_under_reversed_bins_have_the_largest_tension():
    rated = under([*bins((200.0, 1.0)), *bins((200.0, 1.0), reversed=True)])
    assert_allclose(rated.local_root_stress[1], 1.6 * np.nanmax(rated.result.root_tension[1], axis=0), rtol=ROUNDING)
    assert_array_equal(rated.local_stress_ratio[1], -1.2)


@pytest.mark.parametrize(("beside", "failure"), [(0.99, "tooth breakage"), (1.01, "pitting")])
def test_what_decides_of_all_bins_is_compared_on_the_scale_of_the_torque(beside, failure):
    cases = bins((100.0, 30.0), (200.0, 10.0))
    of_flank, of_root, *_ = under(cases).spectrum_safety.min(axis=0)
    wanted = {"rating.required_flank_safety": 2.0 * of_flank, "rating.required_root_safety": 4.0 * of_root / beside}
    sentence = findings(under(cases, **wanted))[0]
    assert f"the critical failure is {failure} of" in sentence
    assert f"= {min(0.25, 0.2475 if beside < 1.0 else 0.25)}" in sentence


def test_sentences_and_report_say_which_bin_does_the_damage(monkeypatch):
    monkeypatch.setattr("loaded_tca.reports.rating_page.rating_figures", lambda _: {})  # seconds, and tested elsewhere
    cases = bins((100.0, 30.0), (200.0, 10.0))
    rated = under(cases)
    part = rated.damage[1, 0, 0] / rated.miner_sum[0, 0]
    content = rating_content(rated.result)
    assert content["findings"] == findings(rated)
    assert content["findings"][0].startswith("after ISO 6336 the critical failure is")
    assert f"; bin 2 (200 N m) does {100.0 * part:.0f} % of the damage" in content["findings"][0]
    safeties = content["safeties"]
    assert safeties.head[0] == "all bins together"
    assert safeties.rows[0][2] == f"{rated.spectrum_safety[0, 0]:.4g}"
    assert content["tables"][0].head[1] == "bin 1, 100 N m, pinion"


def test_studies_have_what_all_bins_do_together():
    rated = under(bins((100.0, 30.0), (200.0, 10.0)))
    figures = rating_figures(rated.result)
    assert_allclose(figures["S_H"], [rated.spectrum_safety[:, 0].min()] * 2, rtol=ROUNDING)
    assert_allclose(figures["life_h"], [rated.life_hours[:, :2].min()] * 2, rtol=ROUNDING)
    assert_allclose(figures["life_local_h"], [rated.life_hours[:, 2:].min()] * 2, rtol=ROUNDING)


def test_what_spectra_do_not_have_is_refused():
    rated = under(bins((200.0, 1.0)))
    with pytest.raises(InputError, match=r"load.case: a load spectrum; give load.pinion_torque_Nm"):
        utilisation_of(rated.scene, 200e3)
