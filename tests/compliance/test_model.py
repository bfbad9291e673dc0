"""The bending model of a scene: one place makes it, as a sum, for analyses, designs and results from files alike."""

import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import analyse, load_result, parse_scene
from loaded_tca.cli import DEMO_SCENE
from loaded_tca.compliance import model, model_of, tooth_compliance
from loaded_tca.errors import AccuracyWarning
from loaded_tca.separation import sample_separation
from loaded_tca.studies import DesignModel
from loaded_tca.unloaded import trace_contact

CROWNING, TORQUE = "pinion.modifications.lead_crowning_um", "load.pinion_torque_Nm"
COARSE = {"analysis.positions": 4, "analysis.accuracy": None, "analysis.cells": (16, 16), "analysis.free_edges": False}
SCENE = parse_scene(DEMO_SCENE.read_text()).with_changes(COARSE)
FLANKS_ALONE = {"analysis.compliance": "contact"}
FROM_FILE = 1e-9
"""Contact points are found again, and slopes solved again to 1e-6."""


@pytest.fixture
def twice_as_soft(monkeypatch):
    """Every part of the model counts twice."""
    monkeypatch.setattr(model, "PARTS", 2 * model.PARTS)


def slopes(result):
    return result.sensitivities([CROWNING, TORQUE]).transmission_error


def coarse_result():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # few cells
        return analyse(SCENE)


def test_model_of_flanks_alone_is_none():
    scene = SCENE.with_changes(FLANKS_ALONE)
    assert model_of(scene, scene.pair(), 1) is None


@pytest.mark.thorough
@pytest.mark.usefixtures("twice_as_soft")
def test_parts_bend_together_by_the_sum_of_each():
    pair = SCENE.pair()
    grid = sample_separation(pair, trace_contact(pair, [0.0])[0], cells=(4, 6), box=(0.2, 3.0))
    both, teeth = model_of(SCENE, pair, 2), tooth_compliance(pair, neighbours=2)
    assert both.neighbours == 2
    for bending in (both, both.mounted(pair)):
        assert_allclose(bending.within(0, grid), 2.0 * teeth.within(0, grid))
        assert_allclose(bending.between((0, grid), (1, grid)), 2.0 * teeth.between((0, grid), (1, grid)))


@pytest.mark.usefixtures("twice_as_soft")
def test_model_twice_as_soft_has_one_answer_in_memory_and_from_a_file(tmp_path, monkeypatch):
    soft = coarse_result()
    soft.save(tmp_path / "result.nc")
    in_memory = slopes(soft)
    assert_allclose(
        slopes(load_result(tmp_path / "result.nc")), in_memory, rtol=0, atol=FROM_FILE * np.abs(in_memory).max()
    )
    monkeypatch.undo()
    stiff = slopes(coarse_result())
    assert (np.abs(in_memory[..., 1]) > 1.2 * np.abs(stiff[..., 1])).all()  # the torque turns soft teeth further


@pytest.mark.usefixtures("twice_as_soft")
def test_design_bends_by_the_model_of_the_analysis(monkeypatch):
    soft = DesignModel(SCENE, {CROWNING: (0.0, 10.0)}, cells=(12, 12)).evaluate([5.0])
    monkeypatch.undo()
    stiff = DesignModel(SCENE, {CROWNING: (0.0, 10.0)}, cells=(12, 12)).evaluate([5.0])
    mean = "mean_transmission_error_um"
    assert abs(soft.figures[mean].item()) > 1.2 * abs(stiff.figures[mean].item())
