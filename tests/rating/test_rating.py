"""Ratings of solved meshes: closed forms, limits, load factors, printed safeties, and what is refused."""

from dataclasses import replace
from math import cos, radians
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.errors import InputError, NotAskedError, noted_accuracy_warnings
from loaded_tca.rating.inputs import inputs_of
from loaded_tca.tribology.slices import slices_of
from tests.samples.rating import HARD, RATED, solved

METHOD_B = {"rating.dynamic_factor": "method B", "rating.transverse_load_factor": "method B"}
ROUNDING = 1e-12  # of a few products and roots, with room for any order of them


def test_stresses_are_nominal_ones_times_load_factors():
    changes = {"operation.application_factor": 1.5, "operation.dynamic_factor": 1.2}
    changes |= {"rating.face_load_factor": 1.3, "rating.transverse_load_factor": 1.1}
    rated, plain = solved(**changes).rating(), solved(**{"rating.face_load_factor": 1.0}).rating()
    flank, root = 1.5 * 1.2 * 1.3 * 1.1, 1.5 * 1.2 * rated.K_Fbeta * 1.1
    assert_allclose(rated.sigma_H, plain.sigma_H * flank**0.5, rtol=ROUNDING)
    assert_allclose(rated.sigma_F, plain.sigma_F * root[:, None], rtol=ROUNDING)
    assert_allclose(rated.local_flank_stress, plain.local_flank_stress * (1.5 * 1.2) ** 0.5, rtol=ROUNDING)
    assert_allclose(rated.local_root_stress, plain.local_root_stress * 1.5 * 1.2, rtol=ROUNDING)
    assert_allclose(rated.flank_safety, rated.sigma_HG / rated.sigma_H, rtol=ROUNDING)
    assert_allclose(plain.sigma_H, plain.Z_BD * plain.sigma_H0[:, None], rtol=ROUNDING)


def test_nominal_stresses_are_those_of_the_standard_by_hand():
    rated, scene = solved().rating(), solved().scene
    pinion, wheel = scene.mesh().pinion, scene.mesh().wheel
    alpha, module = radians(20.0), pinion.normal_module
    ratio, diameter = wheel.teeth / pinion.teeth, module * pinion.teeth
    working = scene.mesh().working_pressure_angle
    zone = (2.0 * cos(working) / (cos(alpha) ** 2 * np.sin(working))) ** 0.5
    assert_allclose(rated.Z_H, zone, rtol=ROUNDING)
    force, width = 2.0 * np.array([100e3, 200e3]) / diameter, 18.0
    share = ((4.0 - scene.mesh().transverse_contact_ratio) / 3.0) ** 0.5
    stress = zone * rated.Z_E * share * np.sqrt(force / (diameter * width) * (ratio + 1.0) / ratio)
    assert_allclose(rated.sigma_H0, stress, rtol=ROUNDING)
    bending = (force / (width * module))[:, None] * rated.Y_F * rated.Y_S  # spur: Y_beta is 1; thick rims: Y_B, too
    assert_allclose(rated.sigma_F0, bending, rtol=ROUNDING)


def test_life_at_a_required_safety_is_that_whose_safety_it_is():
    rated = solved().rating()
    for place in range(2):
        flank, root = float(rated.flank_safety[1, place]), float(rated.root_safety[1, place])
        changed = solved(**{"rating.required_flank_safety": flank, "rating.required_root_safety": root}).rating()
        # exponents of the lines between knees multiply rounding of a stress by up to 33
        lives = changed.dataset.life_hours[1, place]
        assert_allclose(lives.sel(mode="flank"), 20000.0, rtol=1e-9)
        assert_allclose(lives.sel(mode="root"), 20000.0, rtol=1e-9)


def test_strength_at_limited_life_is_that_between_the_printed_static_and_reference_ones():
    """ISO 6336-2 and -3, case-hardened: straight in logarithms, flanks from 1e5 to 5e7 cycles, roots 1e3 to 3e6."""
    rated = solved(**{"rating.life_hours": 10.0, "wheel.strength": HARD | {"root_stress_ratio": -1.0}}).rating()
    reference = rated.sigma_H_lim * rated.Z_L * rated.Z_v * rated.Z_R * rated.Z_W_reference * rated.Z_X
    of_root = rated.sigma_F_lim * rated.Y_ST * rated.Y_delta_relT * rated.Y_R_relT * rated.Y_X * rated.Y_M
    static_root = rated.sigma_F_lim * rated.Y_ST * 2.5 * rated.Y_delta_relT_static * rated.Y_M_static
    assert (rated.Y_M_static[:, 1] > rated.Y_M[:, 1]).all(), "M is less at rest"
    for name, low, high, knees in (
        ("sigma_HG", reference, 1.6 * rated.sigma_H_lim * rated.Z_W_static, (1e5, 5e7)),
        ("sigma_FG", of_root, static_root, (1e3, 3e6)),
    ):
        assert_allclose(getattr(rated, f"{name}_reference"), low, rtol=ROUNDING)
        assert_allclose(getattr(rated, f"{name}_static"), high, rtol=ROUNDING)
        start, end = np.log(knees)
        assert (np.log(rated.cycles) < end).all()
        assert (np.log(rated.cycles) > start).all()
        part = (end - np.log(rated.cycles)) / (end - start)
        assert_allclose(getattr(rated, name), low * (high / low) ** part, rtol=1e-9)  # exponents multiply rounding


def test_dynamic_factor_follows_from_the_numbers_beside_it():
    """Method B by hand, below the main resonance, with f_pb and f_falpha of ISO 1328-1:2013, class 6."""
    rated = solved(**METHOD_B | {"rating.tolerance_class": 6}).rating()
    scene = rated.scene
    module, teeth, width = scene.mesh().pinion.normal_module, scene.pinion.teeth, 18.0
    assert_allclose(rated.specific_load, 2.0 * np.array([100e3, 200e3]) / (module * teeth * width), rtol=ROUNDING)
    largest = max(scene.wheel.teeth, teeth) * module
    # single pitch 0.001 d + 0.4 m + 5, profile form 0.55 m + 5 [um], times 2^((A - 5)/2)
    pitch, profile = 2.0**0.5 * (0.001 * largest + 0.4 * module + 5.0), 2.0**0.5 * (0.55 * module + 5.0)
    assert_allclose(rated.f_pb, pitch * cos(radians(20.0)), rtol=0.06)  # the standard rounds to 0.5 um
    assert_allclose(rated.f_falpha, profile, rtol=0.06)
    for deviation, allowance in ((rated.f_pb, rated.y_p), (rated.f_falpha, rated.y_f)):
        assert_allclose(allowance, 0.075 * deviation, rtol=ROUNDING)  # case-hardened
    softness = rated.single_stiffness / rated.specific_load
    assert_allclose(rated.B_p, softness * (rated.f_pb - rated.y_p), rtol=ROUNDING)
    assert_allclose(rated.B_f, softness * (rated.f_falpha - rated.y_f), rtol=ROUNDING)
    assert_allclose(rated.B_k, np.abs(1.0 - softness * rated.C_a), rtol=ROUNDING)
    assert (rated.resonance_ratio < 0.5).all()
    parts = 0.32 * rated.B_p + 0.34 * rated.B_f + 0.23 * rated.B_k  # eps_gamma below 2
    assert_allclose(rated.K_v, 1.0 + rated.resonance_ratio * parts, rtol=ROUNDING)
    with pytest.raises(NotAskedError, match=r'rating\.dynamic_factor = "method B"'):
        _ = solved().rating().B_p


def test_notes_on_the_dynamic_factor_name_their_torques_and_bins():
    """w of the spur pair under 100 and 200 N m, of which 100 N/mm is one between both at a width of 18 mm."""
    of_torques = solved(**METHOD_B | {"rating.tolerance_class": 6, "operation.pinion_speed_rpm": 60.0}).rating()
    slow = [note for note in of_torques.notes() if "not needed there" in note]
    assert [note.partition("there ")[2] for note in slow] == ["(under 100, 200 N m)"]
    speeds = (60.0, 60.0, 9000.0, 60.0)
    cases = [{"pinion_torque_Nm": 200.0, "hours": 1.0, "pinion_speed_rpm": speed} for speed in speeds]
    cases.insert(3, {"pinion_torque_Nm": 0.0, "hours": 1.0, "pinion_speed_rpm": 60.0})
    of_bins = solved(**METHOD_B | {"rating.tolerance_class": 6, "load.case": cases}).rating()
    slow = [note for note in of_bins.notes() if "not needed there" in note]
    assert [note.partition("there ")[2] for note in slow] == ["(bins 1 to 2, 5 of 5)"]
    many = replace(of_bins.inputs, cases=replace(of_bins.inputs.cases, is_spectrum=True))
    assert many.cases_in_words(np.arange(40) % 2 == 0) == "20 of 40 bins"


def test_load_cycles_count_turns_of_each_gear():
    rated, scene = solved().rating(), solved().scene
    turns = 1500.0 * 60.0 * 20000.0
    expected = [turns, turns * scene.pinion.teeth / scene.wheel.teeth]
    assert_allclose(rated.cycles, [expected, expected], rtol=ROUNDING)


def test_no_tooth_lives_above_its_static_strength():
    rated = solved(**{"rating.required_flank_safety": 90.0, "rating.required_root_safety": 90.0}).rating()
    assert rated.modes == ("flank", "root", "local_flank", "local_root")
    assert_array_equal(rated.life_hours, np.zeros((2, 2, 4)))
    assert any("below the required 90 under 100, 200 N m" in note for note in rated.notes())


def test_lower_stress_than_the_end_of_the_curve_is_borne_for_ever():
    rated = solved(**{"rating.required_flank_safety": 1e-3, "rating.required_root_safety": 1e-3}).rating()
    assert_array_equal(rated.life_hours, np.full((2, 2, 4), np.inf))
    assert_array_equal(rated.damage, 0.0)


def test_local_stresses_are_those_of_the_contact_and_the_roots():
    whole, rated = solved(), solved().rating()
    tension = np.nanmax(whole.root_tension, axis=1)
    # the place that decides has more reversal, and less tension by what that takes of its strength at the most
    assert_allclose(rated.local_root_stress, tension, rtol=0.01)
    assert (rated.local_root_stress <= tension * (1.0 + ROUNDING)).all()
    # Formula of a line contact at each slice beside the pressures of the solver: 16 x 24 cells on crowned flanks, whose
    # ellipse is not as slender as a line, and peaks of edges, which the mean over a quarter module leaves out.
    peaks = np.nanmax(whole.peak_pressure, axis=(1, 2))
    assert_allclose(rated.local_flank_stress, peaks, rtol=0.1)


def test_surface_that_yields_is_rated_by_its_line_load():
    elastic, yielding = solved().rating(), solved(**{"material.max_pressure_MPa": 300.0}).rating()
    assert slices_of(yielding.result).capped
    assert_allclose(yielding.local_flank_stress, elastic.local_flank_stress, rtol=ROUNDING)  # the maps are the same


def test_mean_stress_lowers_the_strength_of_roots():
    once, reversed_ = solved().rating(), solved(**{"wheel.strength.root_stress_ratio": -1.0}).rating()
    sensitivity = 0.8 - 0.15 * once.Y_S[0, 1]  # case-hardened, annex B of ISO 6336-3:2006
    expected = 1.0 / (1.0 + (1.0 - sensitivity) / (1.0 + sensitivity))
    assert_allclose(reversed_.Y_M[:, 1], expected, rtol=ROUNDING)
    assert_array_equal(reversed_.Y_M[:, 0], 1.0)
    assert_allclose(reversed_.root_safety[:, 1], expected * once.root_safety[:, 1], rtol=ROUNDING)
    assert_array_equal(reversed_.local_stress_ratio[:, 1], -1.0)
    assert (once.local_stress_ratio <= 0.0).all()


def test_face_load_factors_of_the_analysis_count_from_one_on():
    rated, whole = solved().rating(), solved()
    assert_allclose(rated.K_Hbeta, np.maximum(1.0, whole.face_load_factor), rtol=ROUNDING)


def test_transverse_load_factor_of_the_analysis_stays_within_its_bounds():
    rated, scene = solved(**{"rating.transverse_load_factor": "analysis"}).rating(), solved().scene
    ratio = scene.mesh().transverse_contact_ratio
    assert_allclose(rated.K_Halpha, 3.0 / (4.0 - ratio), rtol=ROUNDING)  # spur: one pair carries all, 1/Z_eps^2
    assert_allclose(rated.K_Falpha, 1.0 / (0.25 + 0.75 / ratio), rtol=ROUNDING)


def test_dynamic_factor_by_method_b_rises_with_speed_below_resonance():
    excess = []
    for speed in (100.0, 200.0):
        changes = METHOD_B | {"rating.tolerance_class": 6, "operation.pinion_speed_rpm": speed}
        excess.append(solved(**changes).rating().K_v - 1.0)
    assert_allclose(excess[1], 2.0 * excess[0], rtol=1e-9)  # proportional to N; the difference of 1.00x costs digits
    assert (excess[0] > 0.0).all()
    assert excess[0][1] < excess[0][0]  # less under more load


def test_coarser_tolerance_classes_raise_load_factors():
    fine, coarse = (solved(**METHOD_B, **{"rating.tolerance_class": number}).rating() for number in (5, 9))
    assert (coarse.K_v > fine.K_v).all()
    assert (coarse.K_Halpha > fine.K_Halpha).all()
    assert (coarse.flank_safety < fine.flank_safety).all()


def test_softer_gear_hardens_at_work():
    soft = {"material": "42CrMo4", "hardness_HBW": 250.0, "proof_stress_MPa": 800.0}
    rated = solved(**{"wheel.strength": HARD | soft}).rating()
    assert rated.Z_W_reference[0, 1] > 1.0
    assert_array_equal(rated.Z_W_reference[:, 0], 1.0)
    assert rated.Y_ST.shape == (2, 2)


def test_results_without_root_stress_have_no_local_safety_of_roots():
    whole = solved(**{"analysis.root_stress": False})
    rated = whole.rating()
    assert not rated.has("local_root_safety")
    with pytest.raises(NotAskedError, match=r"local_root_safety: needs root stress; set analysis.root_stress = true"):
        rated.local_root_safety  # noqa: B018
    assert "tooth breakage S_F" in rated.summary()


def test_summary_and_figures_have_both_gears():
    rated = solved().rating()
    figures = rated.key_figures()
    assert figures[1]["pinion_torque_Nm"] == 200.0
    assert figures[1]["wheel_flank_safety"] == rated.flank_safety[1, 1]
    assert figures[0]["pinion_flank_life_h"] == rated.life_hours[0, 0, 0]
    line = next(line for line in rated.summary().splitlines() if line.startswith("safety against pitting S_H"))
    assert line.count("|") == 2
    assert "required S_H 1, S_F 1.4" in rated.summary()


def with_edges(result, pressure, error):
    """A result whose edges have a pressure in all contacts, rounded with an error, or sharp."""
    edges = result.dataset.edge_pressure.copy(data=np.full_like(result.edge_pressure, pressure))
    rounded = result.dataset.edge_is_rounded.copy(data=np.full_like(result.edge_is_rounded, np.isfinite(error)))
    errors = edges.copy(data=np.full_like(result.edge_pressure, error))
    changes = {"edge_pressure": edges, "edge_is_rounded": rounded, "edge_pressure_error": errors}
    return replace(result, dataset=result.dataset.assign(changes))


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (np.nan, "mesh-dependent, since in theory"),
        (0.025, "solved on columns of cells, with an estimated error of 2.5%"),
    ],
)
def test_edge_pressure_that_local_safeties_leave_out_is_told(error, words):
    plain = solved().rating()
    with noted_accuracy_warnings(given=False) as told:
        rated = with_edges(solved(), 4312.0, error).rating()
    assert told == [*rated.warnings]
    (sentence,) = told
    assert "local safeties of flanks leave edges out, whose pressure is 4312 MPa under 100 N m" in sentence
    assert "on pairs that carry 0.1% of the torque or more" in sentence
    assert words in sentence
    assert_array_equal(rated.local_flank_safety, plain.local_flank_safety)
    lower = 0.9 * np.nan_to_num(solved().peak_pressure).max(axis=(1, 2)).min()
    assert with_edges(solved(), lower, error).rating().warnings == (), "below the peak pressures"


def test_stress_above_the_static_strength_is_told():
    with noted_accuracy_warnings(given=False) as told:
        rated = solved(**{"operation.application_factor": 12.0}).rating()
    above = [one for one in told if one.startswith("rating: root, pinion: the stress ")]
    assert above == [one for one in rated.warnings if one in above]
    (sentence,) = above
    strength = float(sentence.partition("static strength ")[2].partition(" MPa")[0])
    assert f"the stress {rated.sigma_F[1, 0]:.0f} MPa is above" in sentence
    assert "under 200 N m at the pinion" in sentence
    # 2.5 sigma_FE of case-hardened teeth at 1e3 load cycles, Y_delta_relT static near 1 (ISO 6336-3)
    assert_allclose(strength, 2.5 * 2.0 * rated.sigma_F_lim[1, 0], rtol=0.1)
    assert strength < rated.sigma_F[1, 0]
    assert rated.dataset.life_hours.sel(gear="pinion", mode="root")[1] == 0.0
    assert solved().rating().warnings == ()


REFUSED = [
    ({"pinion.strength": None}, "pinion.strength: missing; a rating needs allowable stresses"),
    ({"operation": None}, "operation: missing; strength, cycles and K_v depend on pinion_speed_rpm"),
    ({"lubricant": None}, "lubricant: missing"),
    ({"analysis.load_sharing": False}, "analysis.load_sharing: false"),
]


@pytest.mark.parametrize(("changes", "words"), REFUSED)
def test_what_is_missing_is_told(changes, words):
    with pytest.raises(InputError, match=words):
        solved(**changes).rating()


def test_everything_missing_is_told_at_once():
    bare = dict.fromkeys(RATED)
    with pytest.raises(InputError) as refused:
        solved(**bare).rating()
    assert len(refused.value.problems) == 5


def test_unloaded_results_and_few_positions_are_refused():
    idle = SimpleNamespace(scene=solved().scene, torque=np.array([0.0, 1e5]), path=range(3))
    with pytest.raises(InputError) as refused:
        inputs_of(idle)
    positions, torque = refused.value.problems
    assert positions.startswith("analysis.positions: 3; a rating takes 5 or more")
    assert torque.startswith("pinion torque: 0 N m")
