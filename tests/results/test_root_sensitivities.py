"""Derivatives of root stress to the keys of a scene: beside slopes through analyses, and in tables."""

import copy
import pickle
import re
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.analysis import roots_of
from loaded_tca.cli.terminal import fitted
from loaded_tca.errors import AccuracyWarning, InputError, NotAskedError
from loaded_tca.output.tables import sensitivities_csv, sensitivities_text
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


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("key", "step", "bends"),
    [
        pytest.param(CROWNING, 1.0, False, marks=pytest.mark.thorough),
        (SLOPE, 1.0, False),
        pytest.param(SLOPE, 1.0, True, marks=pytest.mark.thorough),
    ],
    ids=str,
)
def test_root_stress_follows_modifications_as_analyses_do(key, step, bends):
    changes = HELICAL | ({"analysis.compliance": "contact+tooth", "analysis.free_edges": True} if bends else {})
    middle = result("mesh_cycle_helical", **changes)
    crowned = middle.scene.pinion.modifications.lead_crowning_um if key == CROWNING else 0.0
    count = 9 if key == CROWNING else 5  # the extreme leaves its place for another within these steps
    steps = np.linspace(-step, step, count)
    around = [analysed(scene("mesh_cycle_helical", **changes, **{key: crowned + by})) for by in steps if by]
    cycles = [*around[: count // 2], middle, *around[count // 2 :]]
    for name, found in zip(("root_tension", "root_compression"), sensitivities(middle, [key])[1:], strict=True):
        values, places = (np.array([getattr(one, full)[0] for one in cycles]) for full in (name, f"{name}_place"))
        slopes = np.polyfit(steps, values.reshape(count, -1), 3)[-2].reshape(values.shape[1:])
        steady = (places[..., :2] == places[count // 2, ..., :2]).all(axis=(0, 3))  # one side of one tooth
        assert steady.sum() >= 6
        assert_allclose(found[0, ..., 0][steady], slopes[steady], rtol=0, atol=REAL_PAIRS * np.abs(slopes).max())


@pytest.mark.thorough
def test_root_stress_follows_the_torque_as_analyses_do():
    cycle = result(**{"analysis.torques_Nm": tuple(np.linspace(120.0, 160.0, 9))})
    _, tension, compression = sensitivities(cycle, [TORQUE])
    steps = np.linspace(-20.0, 20.0, 9)
    for found, values in ((tension, cycle.root_tension), (compression, cycle.root_compression)):
        slopes = np.polyfit(steps, values.reshape(9, -1), 3)[-2].reshape(values.shape[1:])
        assert_allclose(found[4, ..., 0], slopes, rtol=0, atol=REAL_PAIRS * np.abs(slopes).max())


@pytest.mark.quick_cases("mounting.axial_offset_mm-0.5")
@pytest.mark.parametrize(
    ("key", "step"), [("mounting.axial_offset_mm", 0.5), ("mounting.centre_distance_error_mm", 0.1)]
)
def test_root_stress_follows_a_wheel_that_moves_below_the_contact(key, step):
    """The wheel is wider, and loaded off its middle: its roots move against the contact, those of the pinion do not."""
    one = scene(
        **{
            "analysis.load_sharing": False,
            "analysis.positions": 1,
            "analysis.torques_Nm": (130.0,),
            "pinion.face_width_mm": 10.0,
            "mounting.axial_offset_mm": 2.0,
            "pinion.modifications.lead_crowning_um": 20.0,
        }
    )
    middle = one.mounting.axial_offset_mm if key.endswith("offset_mm") else 0.0
    cycles = [analysed(one.with_changes({key: middle + by})) for by in (-step, step)]
    for name, found in zip(("root_tension", "root_compression"), sensitivities(analysed(one), [key])[1:], strict=True):
        slopes = np.subtract(*(getattr(cycle, name)[0, 0] for cycle in reversed(cycles))) / (2.0 * step)
        assert_allclose(found[0, 0, :, 0], slopes, rtol=REAL_PAIRS, atol=0.01)
        assert abs(slopes[1]) > 1.0


def test_sensitivities_are_found_anew_by_pickle_and_copy():
    found = result(**{"analysis.torques_Nm": (150.0,)}).sensitivities([CROWNING])
    for again in (pickle.loads(pickle.dumps(found)), copy.deepcopy(found)):
        # the same numbers from the file, the same equations
        assert_allclose(again.transmission_error, found.transmission_error, rtol=1e-12)


def test_contacts_of_another_scene_are_not_taken_for_those_of_this_one():
    cycle = result(**{"analysis.torques_Nm": (150.0,)})
    crowned = replace(cycle, scene=cycle.scene.with_changes({CROWNING: 30.0, "mounting.out_of_plane_deg": 0.1}))
    with pytest.raises(InputError, match="the pressure maps of the result do not belong to its scene"):
        crowned.sensitivities([CROWNING])
    asks = replace(
        without_root_stress(), scene=without_root_stress().scene.with_changes({"analysis.root_stress": True})
    )
    with pytest.raises(NotAskedError, match="the result has no root stress"):
        _ = asks.root_tension


def test_numbers_of_gears_are_none_of_tooth_pairs():
    with pytest.raises(InputError, match=r"'root_tension' is no array \(torque, position, pair\).*as they are"):
        result().at_position("root_tension")


def test_exponent_of_the_norm_is_a_number():
    with pytest.raises(InputError, match=r"exponent: found .a.; allowed a finite number"):
        result().sensitivities([CROWNING]).pressure_norm("a")


def test_thick_layers_across_a_wide_face_are_told(monkeypatch):
    one = scene(**{"wheel.face_width_mm": 36.0})
    with coarsely():
        monkeypatch.setattr("loaded_tca.analysis.THICKEST_LAYER", 1.2)
        with pytest.warns(
            AccuracyWarning, match=r"root stress of the wheel: .* elements along its face are 2 modules wide"
        ):
            roots_of(one, one.pair())


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
        text = sensitivities_text(found, default_tolerances(cycle.scene, keys), 0)
        heads, units, numbers = (fitted(line, 90, sentences=False).split("\n") for line in text.split("\n")[1:4])
        assert len(heads) == 2
        for parts in zip(heads, units, numbers, strict=True):  # each number goes on below its name and unit
            ends = [[cell.end() for cell in re.finditer(r"\S+(?: \S+)*", part)] for part in parts]
            assert {one[-1] for one in ends} == {len(parts[0])}
            assert ends[0][1:] == ends[1][-len(ends[0]) + 1 :] == ends[2][1:]
        assert "wheel tension" in heads[1]
        assert found.dataset["root_tension"].dims == ("torque", "position", "gear", "key")
        assert found.spread({CROWNING: 1.0})["root_compression"].dims == ("torque", "position", "gear")


def test_root_stress_that_was_not_asked_for_has_no_derivative():
    found = without_root_stress().sensitivities([CROWNING])
    assert "root_tension" not in found.dataset
    with pytest.raises(NotAskedError, match=r"root_tension.*set analysis.root_stress = true"):
        _ = found.root_tension
