"""Quick random scenes, every feature and every invariance among them; ``validation.loaded.random_scenes`` runs more."""

from types import SimpleNamespace

import numpy as np
import pytest

from loaded_tca import read_scene
from validation import invariances
from validation.invariances import CHEAP, COARSE
from validation.laws import LAWS
from validation.loaded.random_scenes import beyond, examined
from validation.random_scenes import ALL_FAMILIES, FROM_HERE, LATER_FAMILIES, SCENES, coins
from validation.scene_features import FEATURES

QUICK = {
    1: ("pitch later", "torque balanced"),
    5: ("pitch later", "torque balanced"),
    10: ("energy kept",),
    13: ("stiffness and rotation",),
    14: ("mirror along",),
    15: ("pitch later", "torque balanced"),
    17: ("lengths doubled",),
    41: ("finer grids",),
    83: ("torque balanced",),
    109: ("continuous",),
    150: ("gears exchanged",),
    153: ("torque balanced",),
    202: ("pitch later", "torque balanced"),
    209: ("pitch later", "torque balanced"),
    214: ("positions among others",),
    228: ("moments on shafts",),
    265: ("derivatives and differences",),
    382: ("memory and file",),
    457: ("revolution doubled",),
    471: ("mirror across",),
    538: ("torque in a list",),
    541: ("moments on shafts",),
    565: ("torque balanced",),
    682: ("torque balanced",),
    2257: ("lengths doubled", "zeros as none"),
    10079: ("halves in each others place", "halves close together", "energy kept in both halves"),
    10178: ("rack as wheel",),
    10782: ("mirror along",),
    10925: ("equal halves",),
    10985: ("pitch later in both halves", "axial forces balanced"),
}
"""Seed -> names of what it is examined for."""
FURTHER = {
    8: ("zeros as none",),
    29: ("pitch later", "torque balanced"),
    77: ("torque balanced",),
    82: ("pitch later", "torque balanced"),
    507: ("pitch later", "torque balanced"),
}
"""The same of scenes whose features, families and invariances are among the quick ones; make test-all runs them."""


@pytest.mark.parametrize("seed", [*QUICK, *(pytest.param(seed, marks=pytest.mark.thorough) for seed in FURTHER)])
def test_what_holds_of_every_scene_holds_of_a_random_one(seed):
    found = examined(seed, (QUICK | FURTHER)[seed], CHEAP if seed < FROM_HERE else COARSE)
    assert found["features"] == tuple(feature.name for feature, _ in coins(seed)[1])  # none is left out
    assert beyond(found) == []


def test_every_feature_family_and_invariance_is_among_the_quick_scenes():
    families, tossed = zip(*map(coins, QUICK), strict=True)
    assert set(families) == {*ALL_FAMILIES, *LATER_FAMILIES}
    assert {feature.name for features in tossed for feature, _ in features} == {feature.name for feature in FEATURES}
    assert {name for names in QUICK.values() for name in names} == {one.name for one in LAWS}


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_differences_leave_out_the_side_on_which_a_tooth_pair_comes_under_load(sense, monkeypatch):
    key, steps = "mounting.wheel_axial_mm", []

    def after_the_law(scene):
        value = scene.mounting.wheel_axial_mm
        share = max(sense * value, 0.0) ** 1.5  # of the second pair, which touches where the key is zero
        steps.append(value)
        return SimpleNamespace(
            pair=np.array([0, 1]) if share else np.array([0]),
            transmission_error=np.array([[3.0 * value - share]]),
            load_share=np.array([[[1.0 - share, share]]])[..., : 2 if share else 1],
            peak_pressure=np.array([[[1e3 + 5.0 * value - share, share]]])[..., : 2 if share else 1],
        )

    scene = read_scene(SCENES / "straight_bevel.toml").with_changes({key: 0.0})
    subject = SimpleNamespace(scene=scene, result=after_the_law(scene))
    monkeypatch.setattr(invariances, "analysed", after_the_law)
    slopes = invariances._differences(subject, key, 0.01)
    assert steps == [0.0, -0.01, 0.01]
    assert slopes["transmission_error"] == pytest.approx(3.0, rel=1e-9)  # over both sides off by 0.05
    assert slopes["load_share"] == pytest.approx(0.0, abs=1e-9)
    assert slopes["peak_pressure"] == pytest.approx(5.0, rel=1e-9)
