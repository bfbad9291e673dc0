"""Designs and studies of gears on supports: against whole analyses, and what else a scene asks for beside supports."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca import analyse, read_scene
from loaded_tca.studies import DesignModel, Study, optimise, run_study
from loaded_tca.studies import design as search
from tests.supports.test_sensitivities import TORQUE, scene_of

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")  # contacts at edges: not the matter here

HELD_um = 6e-3
"""Transmission error of held contacts against analyses, which scatter by 2 to 4 nm as they make boxes anew."""
NARROW = {"pinion.face_width_mm": 10.0, "wheel.face_width_mm": 8.0}
"""Models of root stress of a third of the layers."""
BASED_um = 0.02
"""The same on soft shafts, which turn what cells cut off at face ends into rotation."""
KEYS = "pinion.modifications.lead_crowning_um", "pinion.modifications.helix_slope_um"


@pytest.fixture(scope="module")
def model() -> DesignModel:
    changes = {"analysis.positions": 5, "analysis.torques_Nm": [60.0, 130.0]}
    return DesignModel(
        scene_of("spur").with_changes(changes), dict(zip(KEYS, [(0.0, 12.0), (-10.0, 10.0)], strict=True))
    )


@pytest.mark.thorough
@pytest.mark.parametrize("far", [False, True])
def test_held_contacts_of_gears_on_supports_are_those_of_analyses(model: DesignModel, far: bool) -> None:
    """The gears stand where the first design moves them under each torque: what a design changes is coupled."""
    values = np.array([9.0, 4.0]) if far else model.start
    held, whole = model.evaluate(values), analyse(model.scenes(values)[0])
    expected = whole.transmission_error[:, :-1]
    assert_allclose(held.transmission_error[0], expected, rtol=0.0, atol=HELD_um / (1e3 * whole.wheel_base_radius))
    assert_allclose(held.figure("face_load_factor")[0], whole.face_load_factor, rtol=3e-3)


@pytest.mark.thorough
def test_gradients_of_designs_on_supports_are_slopes(model: DesignModel) -> None:
    step, evaluation = 0.05, model.evaluate(model.start)
    for name, agreement in (("mean_transmission_error_um", 2e-3), ("face_load_factor", 1e-2), ("pressure_MPa", 0.02)):
        slopes = []
        for own in step * np.eye(2):
            low, high = (model.evaluate(model.start + by).figure(name) for by in (-own, own))
            slopes.append((high - low) / (2.0 * step))
        expected = np.stack(slopes, axis=-1)
        assert_allclose(evaluation.gradient(name), expected, rtol=0.0, atol=agreement * np.abs(expected).max())


@pytest.mark.thorough
def test_optimum_on_supports_evens_the_load_out() -> None:
    """The helix slope turns the flank as the shaft turns the gear; the whole analysis of the optimum confirms it."""
    soft = {"pinion.shaft.bearings.0.radial_stiffness_N_per_um": 40.0, "analysis.positions": 5}
    scene = scene_of("spur").with_changes(soft)
    model = DesignModel(scene, {KEYS[1]: (-20.0, 20.0)}, cells=(16, 24))
    result = optimise(model, "mean", figure="face_load_factor")
    misalignment = np.abs(analyse(scene).misalignment).mean()
    assert 0.5 * misalignment < abs(result.optimum[KEYS[1]]) < 1.5 * misalignment
    before, after = result.objective
    assert after < before
    assert max(result.held_difference) < BASED_um


@pytest.mark.thorough
def test_a_model_based_at_a_design_has_its_contact_points() -> None:
    """Levers of the contact points of the start turn the deflection of the shafts into another rotation."""
    scene = read_scene("examples/scenes/helical_on_shafts.toml").with_changes(
        {
            "analysis.positions": 5,
            "analysis.torques_Nm": [130.0],
            "analysis.compliance": "contact",
            "analysis.cells": (24, 40),
        }
    )
    model = DesignModel(scene, dict(zip(KEYS, [(0.0, 20.0), (-20.0, 20.0)], strict=True)))
    far = np.array([5.0, 15.0])
    whole = analyse(model.scenes(far)[0])
    based = model.based_at(far)
    assert np.array_equal(based.start, far)
    off = [
        1e3
        * whole.wheel_base_radius
        * np.abs(one.evaluate(far).transmission_error[0] - whole.transmission_error[:, :-1])
        for one in (model, based)
    ]
    assert off[0].max() > 2.0 * BASED_um  # so that there is something to mend
    assert off[1].max() < BASED_um


@pytest.mark.thorough
def test_a_search_goes_on_where_its_optimum_has_other_contact_points(monkeypatch: pytest.MonkeyPatch) -> None:
    """The optimum is that of a model which is made at it, as far as such models still differ."""
    made = []
    based_at = DesignModel.based_at
    monkeypatch.setattr(DesignModel, "based_at", lambda self, x: made.append(np.asarray(x)) or based_at(self, x))
    monkeypatch.setattr(search, "SCATTER", 0.0)
    soft = {"pinion.shaft.bearings.0.radial_stiffness_N_per_um": 40.0, "analysis.positions": 5}
    model = DesignModel(scene_of("spur").with_changes(soft), {KEYS[1]: (-20.0, 20.0)}, cells=(16, 24))
    result = optimise(model, "mean", figure="face_load_factor")
    assert len(made) == search.MOST_BASES
    assert_allclose(result.optimum[KEYS[1]], made[-1].item(), atol=0.5)  # it hardly moves any more


@pytest.mark.thorough
def test_stiffness_of_a_bearing_is_varied_in_a_study() -> None:
    key, values = "pinion.shaft.bearings.0.radial_stiffness_N_per_um", [100.0, 400.0]
    rows = run_study(Study(scene_of("spur"), table={key: values}))
    by_study = np.ravel(rows["face_load_factor"].values)
    alone = [analyse(scene_of("spur").with_changes({key: value})).face_load_factor[0] for value in values]
    assert_array_equal(by_study, alone)  # the same analyses
    assert by_study[0] != by_study[1]


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("changes", "names"),
    [
        ({"analysis.free_edges": False}, ("transmission_error",)),
        pytest.param(
            # at the edge of a tip 32 cells leave 4 % of the line load's slope in differences of analyses
            {"pinion.tip_rounding_mm": 0.2, "wheel.tip_rounding_mm": 0.2, "analysis.cells": (48, 48)},
            ("transmission_error", "line_load"),
            marks=pytest.mark.thorough,
        ),
        pytest.param(
            {"analysis.compliance": "contact+tooth", "analysis.root_stress": True} | NARROW,
            ("root_tension", "root_compression"),
            marks=pytest.mark.thorough,
        ),
    ],
)
def test_other_parts_of_the_model_stand_beside_supports(changes: dict[str, Any], names: tuple[str, ...]) -> None:
    scene, step = scene_of("helical").with_changes(changes | {"analysis.positions": 3}), 2.0
    one, low, high = (analyse(scene.with_changes({"analysis.torques_Nm": [130.0 + by]})) for by in (0.0, -step, step))
    found = one.sensitivities([TORQUE])
    for name in names:
        slope, change = (getattr(high, name) - getattr(low, name))[0] / (2.0 * step), getattr(found, name)[0, ..., 0]
        known = np.isfinite(slope) & np.isfinite(change)
        assert_allclose(change[known], slope[known], rtol=0.0, atol=0.03 * np.abs(slope[known]).max())
