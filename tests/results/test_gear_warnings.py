"""Gears that jam or are no gears: one list of warnings, which every output shows; refused where nothing can turn."""

import json
import math

import pytest

from loaded_tca import GeometryError, analyse, read_scene
from loaded_tca.errors import noted_accuracy_warnings
from loaded_tca.output.overview import describe_scene
from loaded_tca.output.result_files import summary_json
from loaded_tca.reports.result_page import result_content
from loaded_tca.results.gear_warnings import hardest_pressure, warn_of_gears
from loaded_tca.studies import Study, run_study, study_summary
from loaded_tca.warning_kinds import kind_of
from tests.samples.results import SCENES

ROUNDING = 1e-12  # mm; lengths of 100 mm are subtracted
QUICK = {
    "analysis.positions": 1,
    "analysis.accuracy": None,
    "analysis.cells": (12, 16),
    "analysis.compliance": "contact",
    "analysis.free_edges": False,
    "analysis.torques_Nm": (20.0,),
}
NEAR, TOO_NEAR = {"pair.centre_distance_mm": 136.45}, {"pair.centre_distance_mm": 135.7}
"""Of a pair 34/57 of module 3: 0.036 mm of overlap; tips 0.05 mm below roots."""
PLAIN = {"pinion.modifications": {}, "wheel.modifications": {}}


def spur(**changes):
    return read_scene(SCENES / "mesh_cycle_spur.toml").with_changes(QUICK | changes)


def sentences(scene):
    with noted_accuracy_warnings(given=False) as found:
        warn_of_gears(scene, scene.pair())
    return found


def test_sound_gears_are_not_warned_of():
    for name in ("mesh_cycle_spur", "mesh_cycle_helical", "mesh_cycle_bevel", "face_milled_19x62_matched", "fzg_c14"):
        assert sentences(read_scene(SCENES / f"{name}.toml")) == []


SHAFT = {
    "start_mm": -50.0,
    "torque_at_mm": 50.0,
    "sections": [{"length_mm": 100.0, "outer_diameter_mm": 30.0}],
    "bearings": [
        {"at_mm": -40.0, "radial_stiffness_N_per_um": 400.0, "axial_stiffness_N_per_um": 100.0},
        {"at_mm": 40.0, "radial_stiffness_N_per_um": 400.0},
    ],
}
LOADS = {"wheel.shaft": {**SHAFT, "loads": [{"at_mm": 10.0, "force_N": [0.0, 900.0, 0.0]}]}}
BINS = {"load.pinion_torque_Nm": None, "load.case": [{"pinion_torque_Nm": 20.0, "hours": 1.0}] * 2}


@pytest.mark.parametrize(
    ("changes", "count"),
    [
        (LOADS, 0),
        ({"wheel.shaft": SHAFT, "analysis.torques_Nm": (10.0, 20.0)}, 0),
        (LOADS | {"analysis.torques_Nm": (10.0, 20.0)}, 2),
        (LOADS | BINS, 0),
        (LOADS | BINS | {"load.case": [{"pinion_torque_Nm": one, "hours": 1.0} for one in (0.0, 5.0, 10.0, 20.0)]}, 3),
    ],
    ids=["one torque", "no loads", "torques", "bins of one torque", "bins"],
)
def test_loads_on_shafts_are_warned_of_under_several_torques(changes, count):
    told = [one for one in sentences(spur(**changes)) if "loads on the shaft" in one]
    wanted = f"the loads on the shaft of the wheel are the same under all {count} torques"
    assert told == ([wanted] if count else [])


@pytest.mark.thorough
def test_gears_that_jam_are_warned_of_in_every_output(monkeypatch):
    scene = spur(**NEAR)
    (sentence,) = sentences(scene)
    with noted_accuracy_warnings(given=False):
        result = analyse(scene)
    assert sentence in result.warnings
    assert f"warning: {sentence}" in result.summary().splitlines()
    assert sentence in json.loads(summary_json(result))["accuracy_warnings"]
    assert f"warning: {sentence}" in describe_scene(scene).splitlines()
    monkeypatch.setattr("loaded_tca.reports.result_page.result_figures", lambda *_, **__: {})
    explained = {told: known for group, known in result_content(result)["warnings"] for told in group}
    assert explained[sentence] == kind_of(sentence)
    assert "both flanks of a tooth touch" in explained[sentence].meaning


def test_variants_that_jam_are_warned_of_and_those_that_cannot_turn_refused():
    distances = [136.5, 136.45, 135.7]
    found = run_study(Study(spur(), {"pair.centre_distance_mm": distances}))
    assert found["status"].values.tolist() == ["ok", "ok", "refused"]
    assert ["negative backlash" in told for told in found["warnings"].values.tolist()] == [False, True, False]
    assert "cannot turn at the centre distance of 135.7000 mm" in found["reason"].values[2]
    assert "warning: negative backlash: teeth are thicker" in study_summary(found)


def test_gears_that_cannot_turn_are_not_analysed():
    with pytest.raises(
        GeometryError, match=r"cannot turn .*135\.7.*: the tip of the wheel reaches 0\.05 mm into the root"
    ):
        analyse(spur(**TOO_NEAR))


@pytest.mark.parametrize(
    ("distance", "errors"), [(None, ()), (136.5, ()), (136.53, (-0.05,)), (136.49, (-0.05, 0.0, 0.005))]
)
def test_an_error_of_the_centre_distance_jams_gears_whose_backlash_is_given(distance, errors):
    """Without backlash at 136.5 mm, given or not, the teeth are nominal: nothing is known of their tolerances."""
    given = {} if distance is None else {"pair.centre_distance_mm": distance}
    for error in (-0.05, 0.0, 0.005, 0.05):
        found = sentences(spur(**given, **{"mounting.centre_distance_error_mm": error}))
        assert [sentence.startswith("negative backlash") for sentence in found] == [True] * (error in errors)


@pytest.mark.thorough
def test_study_of_mounting_errors_of_nominal_gears_is_without_warnings_and_counts_those_of_given_backlash():
    errors = {"mounting.centre_distance_error_mm": [-0.04, -0.02, 0.0, 0.02]}
    for distance, count in ((None, 0), (136.51, 2)):
        found = run_study(Study(spur(**{"pair.centre_distance_mm": distance}), errors))
        assert sum("negative backlash" in told for told in found["warnings"].values.tolist()) == count
        assert study_summary(found).count("negative backlash") == (count > 0)


def test_mounting_that_brings_a_tip_into_an_undercut_is_warned_of():
    """At 103.5 mm the tip of the wheel ends just above the undercut of a pinion of 12 teeth."""
    undercut = {**PLAIN, "pinion.teeth": 12, "wheel.tip_diameter_mm": 174.6}
    assert sentences(spur(**undercut)) == []
    (tip,) = sentences(spur(**undercut, **{"mounting.centre_distance_error_mm": -0.2}))
    assert tip.startswith("undercut: the trochoid of the fillet ends the flank of the pinion at diameter")
    assert "at the mounted centre distance of 103.3000 mm" in tip


@pytest.mark.parametrize(
    ("error", "words"), [(15.0, "no common flank"), (-9.0, "is not above .*, the sum of the base")]
)
def test_mounting_without_a_mesh_is_refused(error, words):
    with pytest.raises(GeometryError, match=f"^at the mounted centre distance of .* mm: .*{words}"):
        sentences(spur(**{"mounting.centre_distance_error_mm": error}))


def test_tip_below_the_form_circle_of_the_mate_is_warned_of():
    longer = {"wheel.tip_diameter_mm": 178.0, "wheel.profile_shift": 0.0}  # which is meant so
    sentence, clearance = sentences(spur(**PLAIN, **longer, **{"pinion.teeth": 20}))
    assert "within 0.25 mm of the root of the pinion" in clearance
    assert sentence.startswith("fillet interference: the tip of the wheel reaches below the form circle of the pinion")


def test_missing_tooth_is_warned_of_where_nothing_but_its_flank_is_computed():
    """3 mm off either flank of a tooth 4.7 mm thick; as long as the teeth bend, by what they bend like."""
    changes = {"pinion.modifications.polynomial_mm": [3.0, 0.0, 0.0, 0.0, 0.0, 0.0]}
    for compliance, words in (
        ("contact", "is analysed nevertheless"),
        ("contact+tooth", "the bending is that of the tooth without"),
    ):
        found = sentences(spur(**changes, **{"analysis.compliance": compliance}))
        assert ["pointed tooth" in sentence and words in sentence for sentence in found if "unit" not in sentence] == [
            True
        ]


def test_one_blade_alone_makes_no_missing_tooth():
    scene = read_scene(SCENES / "face_milled_19x62_matched.toml")
    assert sentences(scene.with_changes({"pinion.cutter.convex": None, "analysis.compliance": "contact"})) == []


@pytest.mark.parametrize(("bore", "warned"), [(78.3, False), (78.4, True), (0.0, False), (None, False)])
def test_thin_rims_are_warned_of_where_root_stress_is_asked_for(bore, warned):
    """Root radius 47.25, height 6.75 mm: a rim of 1.2 heights is left by a bore of 78.3 mm. A solid gear has no rim."""
    changes = {"pinion.bore_diameter_mm": bore}
    found = sentences(spur(**changes, **{"analysis.root_stress": True}))
    assert ["rim below its teeth is 1.2 tooth heights thick" in sentence for sentence in found] == [True] * warned
    assert sentences(spur(**changes)) == []


@pytest.mark.parametrize("name", ["mesh_cycle_spur", "mesh_cycle_bevel", "face_milled_19x62_matched"])
def test_rim_is_what_a_bore_leaves_of_the_body_and_none_of_a_solid_gear(name):
    scene = read_scene(SCENES / f"{name}.toml")
    thin, thick = (
        scene.with_changes({"pinion.bore_diameter_mm": part * scene.pair().rigid_bores[0]}).pair().pinion
        for part in (1.0, 0.5)
    )
    assert 0.0 < thin.rim_over_height < thick.rim_over_height < math.inf
    assert scene.with_changes({"pinion.bore_diameter_mm": 0.0}).pair().pinion.rim_over_height == math.inf


@pytest.mark.parametrize(
    ("changes", "question"),
    [
        (
            {"material.youngs_modulus_MPa": 206.0},
            "material.youngs_modulus_MPa: 206 MPa is less than the modulus of any",
        ),
        ({"material.youngs_modulus_MPa": 206e4}, "material.youngs_modulus_MPa: 2060000 MPa is more than"),
        ({"analysis.torques_Nm": (2e6,)}, "load.pinion_torque_Nm: 2000000 N m is more than the torque of any"),
    ],
)
def test_numbers_of_another_unit_are_asked_about(changes, question):
    (sentence,) = sentences(spur(**changes))
    assert sentence.startswith(question)
    assert sentence.endswith("; is its unit right?")


@pytest.mark.parametrize("clearance", [0.15, 0.0, -1e-4])
def test_tip_that_comes_near_to_a_root_is_warned_of(clearance):
    """Higher tips of the wheel leave so much of 0.75 mm, the clearance of the basic rack."""
    scene = spur(**PLAIN)
    height = 2.0 * (scene.mesh().wheel.tip_radius + 0.75 - clearance)
    near = scene.with_changes({"wheel.tip_diameter_mm": height})
    assert near.tip_clearances[0] == pytest.approx(clearance, abs=ROUNDING)
    found = [sentence for sentence in sentences(near) if "of the root of the pinion" in sentence]
    least = f"{max(clearance, 0.0):g}"
    assert found == [
        f"the tip of the mating gear comes within {least} mm of the root of the pinion, less than 0.1 modules"
    ]
    assert any(f"{clearance:.4f}" in line for line in describe_scene(near).splitlines() if "tip clearance" in line)


def test_gears_of_plastic_are_no_slip_of_a_unit():
    assert sentences(spur(**{"wheel.material.youngs_modulus_MPa": 2800.0, "wheel.material.poisson_ratio": 0.38})) == []


@pytest.mark.parametrize(
    ("moduli", "pressure"),
    [((206000.0, 206000.0), 4000.0), ((206000.0, 103000.0), 2000.0), ((206000.0, 2800.0), 168.0)],
)
def test_pressure_that_a_material_carries_goes_with_the_softer_modulus(moduli, pressure):
    """Steel; half as stiff; polyoxymethylene, whose yield stress is 70 MPa: 1.67 of it are 117 MPa."""
    assert hardest_pressure(*moduli) == pytest.approx(pressure)


def test_pressure_that_no_steel_carries_is_warned_of_unless_it_is_capped():
    def found(**changes):
        with noted_accuracy_warnings(given=False) as warned:
            result = analyse(spur(**{"analysis.load_sharing": False}, **changes))
        maps = [one for rows in result.maps for row in rows for one in row if one is not None]
        over = sum(4.0 / math.pi * one.mean_pressure > 4000.0 for one in maps)
        return over, [sentence for sentence in warned if "carries without yielding" in sentence]

    assert found(**{"analysis.torques_Nm": (100.0,)}) == (0, [])
    over, (sentence,) = found(**{"analysis.torques_Nm": (100.0, 20e3)})
    assert "4/pi of the mean pressure of a contact is above 4000 MPa" in sentence
    assert f"(at {over} of " in sentence  # as the table of warnings says where to find them
    # what it says of the smaller torque alone: nothing
    assert sentence.up_to == (None, str(sentence))
    assert found(**{"analysis.torques_Nm": (20e3,), "material.max_pressure_MPa": 6000.0})[1] == []


def test_path_shorter_than_a_pitch_is_warned_of():
    """Gears drawn apart until the path between their tips is shorter than a base pitch."""
    scene = spur(**{"pair.centre_distance_mm": 140.0})
    ratio = scene.mesh().transverse_contact_ratio
    assert 0.0 < ratio < 1.0
    (sentence,) = [one for one in sentences(scene) if "contact ratio" in one]
    assert f"{ratio:.3g}, below 1" in sentence
    assert f"warning: {sentence}" in describe_scene(scene).splitlines()
