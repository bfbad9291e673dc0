"""Derivatives of root stress to the keys of a scene: beside slopes through analyses, and in tables."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import NotAskedError
from loaded_tca.output.sensitivity_files import sensitivities_csv, sensitivities_text
from loaded_tca.results import default_tolerances, key_figure_slopes
from tests.samples.results import result as without_root_stress
from tests.samples.root_stress import analysed, coarsely, result, scene

CROWNING, SLOPE = "pinion.modifications.lead_crowning_um", "pinion.modifications.helix_slope_um"
TORQUE = "load.pinion_torque_Nm"
REAL_PAIRS = 0.03
"""Of the largest slope: analyses make boxes and grids anew, and take the largest of discrete places."""
HELICAL = {"analysis.cells": (32, 48), "analysis.torques_Nm": (130.0,)}


def sensitivities(cycle, keys):
    with coarsely():
        found = cycle.sensitivities(keys)
        return found, found.root_tension, found.root_compression


@pytest.mark.parametrize(
    ("key", "step", "bends"), [(CROWNING, 1.0, False), (SLOPE, 1.0, False), (SLOPE, 1.0, True)], ids=str
)
def test_root_stress_follows_modifications_as_analyses_do(key, step, bends):
    changes = HELICAL | ({"analysis.compliance": "contact+tooth", "analysis.free_edges": True} if bends else {})
    middle = result("mesh_cycle_helical", **changes)
    crowned = middle.scene.pinion.modifications.lead_crowning_um if key == CROWNING else 0.0
    steps = np.linspace(-step, step, 9)
    cycles = [analysed(scene("mesh_cycle_helical", **changes, **{key: crowned + by})) for by in steps]
    for name, found in zip(("root_tension", "root_compression"), sensitivities(middle, [key])[1:], strict=True):
        values, places = (np.array([getattr(one, full)[0] for one in cycles]) for full in (name, f"{name}_place"))
        slopes = np.polyfit(steps, values.reshape(9, -1), 3)[-2].reshape(values.shape[1:])
        steady = (places[..., :2] == places[4, ..., :2]).all(axis=(0, 3))  # one side of one tooth
        assert steady.sum() >= 6
        assert_allclose(found[0, ..., 0][steady], slopes[steady], rtol=0, atol=REAL_PAIRS * np.abs(slopes).max())


def test_root_stress_follows_the_torque_as_analyses_do():
    cycle = result(**{"analysis.torques_Nm": tuple(np.linspace(120.0, 160.0, 9))})
    _, tension, compression = sensitivities(cycle, [TORQUE])
    steps = np.linspace(-20.0, 20.0, 9)
    for found, values in ((tension, cycle.root_tension), (compression, cycle.root_compression)):
        slopes = np.polyfit(steps, values.reshape(9, -1), 3)[-2].reshape(values.shape[1:])
        assert_allclose(found[4, ..., 0], slopes, rtol=0, atol=REAL_PAIRS * np.abs(slopes).max())


def test_tables_have_root_tension_where_the_scene_asks_for_it():
    cycle = result(**{"analysis.torques_Nm": (150.0,)})
    keys = [CROWNING, TORQUE]
    with coarsely():
        found = cycle.sensitivities(keys)
        slopes = key_figure_slopes(found)
        at = cycle.root_tension[0].argmax(axis=0)
        for gear, name in enumerate(("pinion_root_tension_MPa", "wheel_root_tension_MPa")):
            assert_allclose(slopes[name][0], found.root_tension[0, at[gear], gear])
            assert f"{name}_per_tolerance" in sensitivities_csv(found, default_tolerances(cycle.scene, keys))
        assert "wheel root" in sensitivities_text(found, default_tolerances(cycle.scene, keys), 0)
        assert found.dataset["root_tension"].dims == ("torque", "position", "gear", "key")
        assert found.spread({CROWNING: 1.0})["root_compression"].dims == ("torque", "position", "gear")


def test_root_stress_that_was_not_asked_for_has_no_derivative():
    found = without_root_stress().sensitivities([CROWNING])
    assert "root_tension" not in found.dataset
    with pytest.raises(NotAskedError, match=r"root_tension.*set analysis.root_stress = true"):
        _ = found.root_tension
