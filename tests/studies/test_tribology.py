"""Figures of tribology stand in studies of scenes that say how the pair runs, and in no others."""

import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import AccuracyWarning, analyse
from loaded_tca.studies import DesignModel, Study, figures, rank_variants, run_study, tribology_figures
from loaded_tca.studies.other_figures import FIGURES
from tests.samples.tribology import OIL, known, shared

OPERATION = {
    "operation": {"pinion_speed_rpm": 1500.0},
    "lubricant": {"viscosity_40_mm2_s": 220.0, "viscosity_100_mm2_s": 19.0, "oil_temperature_C": 80.0},
    "pinion.roughness_Ra_um": 0.6,
    "wheel.roughness_Ra_um": 0.5,
}


def test_scenes_without_the_sections_have_none():
    assert tribology_figures(shared("mesh_cycle_spur")) == {}


@pytest.mark.thorough
def test_studies_rank_variants_by_loss_and_film():
    """Tip relief takes load off where flanks slide most: less loss, a thicker film."""
    scene = shared("mesh_cycle_spur").scene.with_changes(OPERATION)
    reliefs = {"pinion.modifications.profile_crowning_um": [0.0, 20.0]}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        study = run_study(Study(scene, reliefs))
        assert set(FIGURES) < set(figures(scene))
    loss = study["loss_factor"].values[:, 0]
    assert loss[1] < loss[0]
    assert rank_variants(study, by="loss_factor").iloc[0]["sample"] == 1
    assert rank_variants(study, by="least_film_ratio", largest_is_best=True).iloc[0]["sample"] == 1
    assert np.isnan(study["scuffing_safety"].values).all()  # without a load stage
    expected = known(shared("mesh_cycle_spur", pinion__modifications__profile_crowning_um=20.0), lubricant=OIL)
    assert_allclose(study["least_film_ratio"].values[1], expected.least_film_ratio, rtol=1e-9)


@pytest.mark.thorough
def test_design_has_the_loss_factor_of_the_analysis():
    """On cells of its own, and with the positions but the last, which is the first again."""
    scene = shared("mesh_cycle_helical").scene.with_changes({"analysis.accuracy": None, "analysis.cells": (24, 48)})
    key = "pinion.modifications.profile_crowning_um"
    model = DesignModel(scene, {key: (0.0, 10.0)})
    evaluation = model.evaluate([scene.pinion.modifications.profile_crowning_um])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        expected = analyse(scene).tribology().loss_factor
    assert_allclose(np.ravel(evaluation.figure("loss_factor"))[0], expected[0], rtol=0.01)
