"""Utilisation of the strength: the required safety over the local one, and which designs have it."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.rating.utilisation import utilisation_of
from loaded_tca.studies import DesignModel
from tests.samples.rating import solved

ROUNDING = 1e-12  # of a few products and roots, with room for any order of them
LOADS = {"operation.application_factor": 1.5, "operation.dynamic_factor": 1.2}


def test_utilisation_is_the_required_safety_over_the_local_one():
    rated = solved(**LOADS, **{"rating.required_flank_safety": 1.3}).rating()
    whole = rated.result
    pressure = rated.local_flank_stress / np.sqrt(1.5 * 1.2)
    tension = rated.local_root_stress / (1.5 * 1.2)
    for case, torque in enumerate(whole.torque.tolist()):
        factor = utilisation_of(whole.scene, torque)
        assert_allclose(factor.flank * pressure[case], 1.3 / rated.local_flank_safety[case].min(), rtol=ROUNDING)
        # Y_M of the computed reversal is in the local safety, that of one direction in the utilisation
        expected = 1.4 / rated.local_root_safety[case] * rated.local_Y_M[case]
        assert_allclose(np.array(factor.roots) * tension[case], expected, rtol=ROUNDING)


def test_designs_of_scenes_without_strengths_have_no_utilisation():
    scene = solved(**{"analysis.root_stress": False}).scene
    crowning = {"pinion.modifications.lead_crowning_um": (0.0, 10.0)}
    assert "flank_utilisation" in DesignModel(scene, crowning, cells=(4, 4)).figures
    model = DesignModel(scene.with_changes({"rating": None}), crowning, cells=(4, 4))
    assert "flank_utilisation" not in model.figures
    with pytest.raises(InputError, match="utilisation needs strengths of both gears and"):
        model.require_figure("figure", "flank_utilisation")


def test_pressure_under_a_cap_is_held_against_no_strength():
    scene = solved(**{"analysis.root_stress": False, "material.max_pressure_MPa": 300.0}).scene
    model = DesignModel(scene, {"pinion.modifications.lead_crowning_um": (0.0, 10.0)}, cells=(4, 4))
    assert "pressure_MPa" in model.figures
    with pytest.raises(InputError, match=r"max_pressure_MPa caps it; design the scene without the cap, and analyse"):
        model.require_figure("figure", "flank_utilisation")
    elastic = DesignModel(scene.with_changes({"material.max_pressure_MPa": None}), model.variables, cells=(4, 4))
    elastic.require_figure("figure", "flank_utilisation")
