"""Ratings of stages: load cycles, K_gamma, planets that bend to and fro, both meshes, what is refused."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.errors import InputError, noted_accuracy_warnings
from loaded_tca.output import write_rating
from loaded_tca.rating.inputs import Duty, inputs_of
from loaded_tca.rating.vibration import reduced_mass
from loaded_tca.stages import analyse_stage
from loaded_tca.stages.rating import _computed_ratios, speed_ratio
from tests.rating.test_rings import solved
from tests.samples.rating import HARD, RATED
from tests.samples.root_stress import coarsely
from tests.samples.stages import analysed, stage_of_few_cells

SECTIONS = {
    **{f"{gear}.strength": HARD for gear in ("sun", "planet", "ring")},
    "operation": {"sun_speed_rpm": 6000.0},
    "lubricant": RATED["lubricant"],
    "rating": RATED["rating"],
}
ROUNDING = 1e-12  # of a few products and roots

pytestmark = pytest.mark.filterwarnings("ignore:rating.*leave edges out:loaded_tca.AccuracyWarning")


def rated(**changes):
    """Rating of the stage of few cells, of whose keys some are changed."""
    result, _ = analysed()
    return replace(result, stage=result.stage.with_changes(SECTIONS).with_changes(changes)).rating()


def test_load_cycles_count_turns_against_the_carrier_times_mates():
    rating = rated()
    sun, planet, ring = rating.stage.teeth
    planets = len(rating.stage.stage.angles)
    carrier = 6000.0 * sun / (sun + ring)  # Willis: the ring stands still
    turns = 60.0 * 20000.0 * np.array([6000.0 - carrier, (6000.0 - carrier) * sun / planet, carrier])
    assert_allclose(rating.cycles, [turns * [planets, 1, planets]], rtol=ROUNDING)
    assert_allclose(6000.0 * speed_ratio(rating.stage), 6000.0 - carrier, rtol=ROUNDING)


def test_mesh_load_factor_of_the_analysis_or_a_number_multiplies_loads():
    plain, loaded = (rated(**{"rating.mesh_load_factor": factor}) for factor in (1.0, 1.3))
    for mesh in ("sun_mesh", "ring_mesh"):
        first, second = getattr(plain, mesh), getattr(loaded, mesh)
        assert_allclose(second.sigma_H, first.sigma_H * 1.3**0.5, rtol=ROUNDING)
        assert_allclose(second.sigma_F, first.sigma_F * 1.3, rtol=ROUNDING)
        assert_allclose(second.local_flank_stress, first.local_flank_stress * 1.3**0.5, rtol=ROUNDING)
    assert_array_equal(rated().K_gamma, analysed()[0].mesh_load_factor)
    assert_array_equal(rated().sun_mesh.K_gamma, rated().ring_mesh.K_gamma)


def test_meshes_are_rated_under_even_shares():
    rating = rated()
    sun, planet, _ = rating.stage.teeth
    share = rating.torque / len(rating.stage.stage.angles)
    # torques go through N m of a file
    assert_allclose(rating.sun_mesh.torque, share, rtol=1e-9)
    assert_allclose(rating.ring_mesh.torque, share * planet / sun, rtol=1e-9)


@pytest.mark.filterwarnings("ignore:rating.*static strength:loaded_tca.AccuracyWarning")
def test_sentences_name_the_torque_of_the_sun():
    rating = rated(**{"operation.application_factor": 9.0})
    under = f"under {rating.torque[0] / 1e3:g} N m at the sun"
    static = [sentence for sentence in rating.warnings if "static strength" in sentence]
    assert {gear for gear in ("sun", "planet", "ring") for sentence in static if f", {gear}:" in sentence} >= {
        "sun",
        "ring",
    }
    assert all(under in sentence for sentence in static)
    notes = [note for note in rating.notes() if "below the required" in note or "what decides" in note]
    assert {note.partition(":")[0] for note in notes} == {"sun and planet", "planet and ring"}
    assert all(under in note for note in notes)


def test_planets_bend_to_and_fro():
    """Annex B of ISO 6336-3:2006: R = -1.2, the loads for each mm of both flanks being in the ratio of the widths."""
    rating = rated()
    widths = [mesh.common_face_width for mesh in rating.stage.meshes]
    ratio = -1.2 * min(widths) / max(widths)
    for mesh, place in ((rating.sun_mesh, 1), (rating.ring_mesh, 0)):
        sensitivity = 0.8 - 0.15 * mesh.Y_S[0, place]
        expected = 1.0 / (1.0 - ratio * (1.0 - sensitivity) / (1.0 + sensitivity))
        assert_allclose(mesh.Y_M[:, place], expected, rtol=ROUNDING)
        assert_array_equal(mesh.Y_M[:, 1 - place], 1.0)


def test_planets_of_cast_iron_have_seven_tenths():
    iron = {"kind": "GG", "sigma_H_lim_MPa": 300.0, "sigma_F_lim_MPa": 60.0, "proof_stress_MPa": 250.0}
    with noted_accuracy_warnings(given=False) as told:
        rating = rated(**{"planet.strength": {"flank_Rz_um": 4.8, "root_Rz_um": 20.0} | iron})
    above = {one.partition(": the stress")[0] for one in told if "above the static strength" in one}
    assert {"rating: flank, planet", "rating: root, planet"} <= above
    assert not any("wheel" in one for one in above)
    assert_array_equal(rating.sun_mesh.Y_M, [[1.0, 0.7]])
    assert_array_equal(rating.ring_mesh.Y_M, [[0.7, 1.0]])


def test_fillet_of_a_planet_is_drawn_by_one_mesh_and_pressed_by_the_other():
    first, second = np.array([[[5.0, 100.0], [6.0, 80.0]]]), np.array([[[50.0, 1.0], [90.0, 2.0]]])
    of_sun = SimpleNamespace(root_tension=first, root_compression=-1.1 * first)
    of_ring = SimpleNamespace(root_tension=second, root_compression=-1.3 * second)
    at_sun, at_ring = _computed_ratios(of_sun, of_ring)
    assert_allclose([at_sun, at_ring], [[-1.3 * 90.0 / 100.0], [-1.1 * 100.0 / 90.0]], rtol=ROUNDING)


def test_smaller_safety_of_both_meshes_counts_for_planets():
    rating = rated()
    for name in ("flank_safety", "root_safety", "local_flank_safety", "life_hours"):
        sun, ring = rating.sun_mesh.values(name), rating.ring_mesh.values(name)
        expected = [[sun[0, 0], np.minimum(sun[0, 1], ring[0, 0]), ring[0, 1]]]
        assert_array_equal(rating.values(name), expected)
    assert_array_equal(rating.damage[0, 1], np.maximum(rating.sun_mesh.damage[0, 1], rating.ring_mesh.damage[0, 0]))
    assert rating.dataset["flank_safety"].dims == ("case", "gear")
    assert rating.dataset["life_hours"].dims == ("case", "gear", "mode")
    assert rating.dataset["gear"].values.tolist() == ["sun", "planet", "ring"]


def test_reduced_mass_counts_mates_and_a_ring_that_stands_still():
    result, mass = solved(), {}
    duties = {
        "planet": Duty(wheel_is_held=True),
        "pair": Duty(),
        "three": Duty(meshes=(3, 1)),
        "held": Duty(1.1, (1, 3), True),
    }
    for name, duty in duties.items():
        mass[name] = 1.0 / reduced_mass(inputs_of(result, duty))
    assert_allclose(mass["three"] - mass["pair"], 2.0 * mass["planet"], rtol=1e-9)
    assert mass["held"] == mass["planet"]


def test_numbers_are_columns_of_gears_and_of_meshes(tmp_path):
    rating = rated()
    figures = rating.key_figures()[0]
    assert figures["sun_torque_Nm"] == 300.0
    assert figures["planet_flank_safety"] == rating.flank_safety[0, 1]
    assert figures["ring_mesh_ring_Y_F"] == rating.ring_mesh.Y_F[0, 1]
    assert figures["sun_mesh_K_v"] == 1.0
    lines = rating.summary().splitlines()
    assert next(line for line in lines if line.startswith("safety against pitting S_H")).count("|") == 2
    assert "planet and ring, under the torque of a planet at the ring" in {line.strip() for line in lines}
    files = write_rating(rating, tmp_path)
    stored = json.loads(files[0].read_text(encoding="utf-8"))["torques"][0]
    assert set(stored) == set(figures)


def test_notes_are_in_words_of_the_stage():
    notes = rated(**{"rating.required_root_safety": 90.0}).notes()
    assert any(note.startswith("sun and planet: planet: safety against tooth breakage") for note in notes)
    assert not any("pinion" in note or "wheel" in note for note in notes)


def test_everything_missing_is_told_at_once():
    with pytest.raises(InputError) as refused:
        analysed()[0].rating()
    names = [problem.partition(":")[0] for problem in refused.value.problems]
    assert names == ["sun.strength", "planet.strength", "ring.strength", "rating", "lubricant", "operation"]


def test_problems_of_a_mesh_have_the_names_of_the_stage():
    changes = {"rating.dynamic_factor": "method B", "rating.tolerance_class": 6, "rating.transverse_load_factor": 1.0}
    assert (rated(**changes).sun_mesh.K_v > 1.0).all()
    with pytest.raises(InputError, match=r"rating.mesh_load_factor: found 0.5"):
        rated(**{"rating.mesh_load_factor": 0.5})


@pytest.mark.thorough
@pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")
def test_roots_of_a_stage_are_rated_by_their_computed_stresses():
    with coarsely():
        result = analyse_stage(stage_of_few_cells().with_changes({"analysis.root_stress": True}))
    rating = replace(result, stage=result.stage.with_changes(SECTIONS)).rating()
    safeties = rating.local_root_safety[0]
    assert_array_equal(
        safeties[1], min(rating.sun_mesh.local_root_safety[0, 1], rating.ring_mesh.local_root_safety[0, 0])
    )
    for mesh, place in ((rating.sun_mesh, 1), (rating.ring_mesh, 0)):
        assert -1.2 <= mesh.local_stress_ratio[0, place] < -0.5  # bent to and fro
        assert mesh.local_stress_ratio[0, 1 - place] > -0.5
        assert mesh.local_Y_M[0, place] < mesh.local_Y_M[0, 1 - place] <= 1.0
    assert (safeties > 0.0).all()
