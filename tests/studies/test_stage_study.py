"""Studies over planetary stages: pins of planets vary, mesh cycles are made once, figures are those of stages."""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.stats import norm

from loaded_tca.errors import InputError
from loaded_tca.plots import plot_study
from loaded_tca.reports import write_html_report
from loaded_tca.results.warnings import without_place
from loaded_tca.scene.keys import Number
from loaded_tca.stages import Stage, analyse_stage
from loaded_tca.studies import (
    Study,
    load_study,
    parse_study,
    rank_variants,
    read_study,
    run_study,
    stage_figures,
    study_summary,
)
from loaded_tca.studies import stage as of_stage
from loaded_tca.studies.ranking import main_figures, nominal_variant
from tests.refusals import refused_calls
from tests.samples.stages import analysed, stage_of_few_cells

EXAMPLES = Path(__file__).parents[2] / "examples"
PIN = "stage.pin_tangential_um.{}"

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")


@pytest.fixture(scope="module")
def stage():
    return stage_of_few_cells()


@pytest.fixture(scope="module")
def study(stage):
    pins = {PIN.format(0): norm(10.0, 5.0), PIN.format(1): norm(0.0, 5.0)}
    return Study(stage, {"stage.floating_sun": [True, False]}, pins, samples=4)


@pytest.fixture(scope="module")
def found(study):
    return run_study(study)


def test_pin_of_one_planet_changes_alone(stage):
    changed = stage.with_changes({PIN.format(2): -3.0})
    assert changed.stage.pin_tangential_um == (10.0, 0.0, -3.0, 0.0)
    without = stage.with_changes({"stage.pin_tangential_um": None, PIN.format(1): 2.0})
    assert without.stage.pin_tangential_um == (0.0, 2.0, 0.0, 0.0)
    assert isinstance(Stage.key_at(PIN.format(2)).kind, Number)


@pytest.mark.thorough
def test_figures_are_those_of_whole_analyses(stage, study, found):
    assert (found["status"] == "ok").all()
    whole = analyse_stage(stage.with_changes(study.changes(5))).key_figures()[0]
    for name in ("mesh_load_factor", "largest_planet_share", "transmission_error_peak_to_peak_um"):
        assert_allclose(found[name].values[5, 0], whole[name], rtol=1e-9)
    assert main_figures(found)[0] == "mesh_load_factor"
    assert found["torque"].values.tolist() == [300e3]


def test_mesh_cycles_are_made_once(stage, monkeypatch):
    calls, (meshes, _) = [], analysed()  # here, since its sample has the warnings that are given when it is made
    monkeypatch.setattr(of_stage, "analyse_stage", lambda one: calls.append(one) or meshes)
    of_stage._meshes_of.cache_clear()
    first, second = (stage_figures(stage.with_changes({PIN.format(0): pin})) for pin in (2.0, 8.0))
    assert len(calls) == 1
    assert (first["mesh_load_factor"] < second["mesh_load_factor"]).all()


def test_every_variant_has_the_warnings_of_its_meshes_up_to_its_own_largest_share(found):
    lines = [text.splitlines() for text in found["warnings"].values.ravel().tolist()]
    assert all("(pinion) and" in line for variant in lines for line in variant)
    reasons = [{without_place(line) for line in variant} for variant in lines]
    shares = found["largest_planet_share"].values.reshape(len(lines), -1).max(axis=1)
    most = int(shares.argmax())
    assert reasons[most]
    assert all(some <= reasons[most] for some in reasons)  # what a smaller load is warned of, a larger one is, too
    largest = f"the sun's torque on one planet, up to {300.0 * shares[most]:.4g})"
    assert any(largest in line for line in lines[most])


@pytest.mark.thorough
def test_study_is_kept_drawn_and_told(study, found, tmp_path):
    kept = run_study(study, out=tmp_path / "study.nc")
    assert load_study(tmp_path / "study.nc")["mesh_load_factor"].equals(kept["mesh_load_factor"])
    assert_allclose(kept["mesh_load_factor"], found["mesh_load_factor"])
    pictures = plot_study(found)
    assert {"study_lines_mesh_load_factor", "study_ranking"} <= set(pictures)
    assert "mesh load factor" in study_summary(found)
    assert rank_variants(found)["mesh_load_factor"].is_monotonic_increasing
    text = write_html_report(kept, tmp_path / "report.html").read_text(encoding="utf-8")
    assert "ratio of sun to carrier" in text
    assert "pinion torque" not in text


def test_variant_as_the_stage_is_known(stage):
    pins = Study(stage, {PIN.format(0): [5.0, 10.0], PIN.format(3): [0.0]})
    assert nominal_variant(run_study(pins)) == 1


def test_variant_that_changes_a_pin_twice_over_is_known_by_its_changes(stage):
    """What the stage itself has at a place that varies is of no account."""
    others = [stage.with_changes({PIN.format(0): pin}) for pin in (1.0, 2.0)]
    first, second = (Study(one, {PIN.format(0): [3.0]}).digests(stage_figures)(0) for one in others)
    assert first == second
    assert Study(stage, {PIN.format(1): [3.0]}).digests(stage_figures)(0) != first


def test_number_of_planets_that_does_not_fit_is_a_refused_variant(stage):
    found = run_study(Study(stage, {"stage.planets": [3, 4]}))
    assert found["status"].values.tolist() == ["refused", "ok"]
    assert "found 4 values; allowed 3" in found["reason"].values[0]


def test_example_is_a_study_of_a_stage():
    study = read_study(EXAMPLES / "studies" / "stage_pins.toml")
    assert isinstance(study.scene, Stage)
    assert len(study) == 128
    changes = np.array([study.changes(variant)[PIN.format(0)] for variant in range(64)])
    assert abs(changes.mean() - 10.0) < 0.5  # about the pin of the stage


def wrong(text):
    return parse_study(text, folder=EXAMPLES / "studies")


STAGE = 'stage = "../stages/helical_automotive.toml"\n'

test_bad_studies_are_refused = refused_calls(
    (lambda stage: Study(stage, {PIN.format("x"): [1.0]}), "stage.pin_tangential_um"),
    (
        lambda stage: Study(stage, {PIN.format(4): [1.0]}),
        "stage.pin_tangential_um.4: 4 is past the end of a list of 4; allowed 0 to 3",
    ),
    (lambda stage: Study(stage, {"load.sun_torque_Nm": [1.0]}), "load.sun_torque_Nm: changes nothing beside"),
    (lambda stage: Study(stage, {"stage.pinions": [3]}), "stage.pinions: unknown key"),
    (
        lambda stage: stage.with_changes({PIN.format(4): 1.0}),
        "stage.pin_tangential_um.4: no such planet; allowed 0 to 3",
    ),
    (
        lambda study, tmp_path: run_study(study, out=tmp_path / "a.nc", keep_maps=[0]),
        "keep_maps: not of a study of stages",
    ),
    (lambda: wrong(STAGE + 'scene = "../scenes/helical.toml"'), "scene: found beside stage; a study is of one of them"),
    (lambda: wrong("stage = 3"), "stage: found 3; allowed the name of a stage file"),
    (
        lambda: wrong(
            STAGE + "samples = 4\n[distributions]\nsun.modifications.helix_slope_um = { tolerance_class = 6 }"
        ),
        "distributions.sun.modifications.helix_slope_um.tolerance_class: not in a study of stages",
    ),
    (
        lambda: wrong((EXAMPLES / "stages" / "wind_spur.toml").read_text(encoding="utf-8")),
        "not a study but a planetary stage",
    ),
    error=InputError,
)
