"""Sensitivities of contacts that end at edges: against numbers of whole analyses on either side."""

import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca import analyse, read_scene
from loaded_tca.errors import AccuracyWarning, noted_accuracy_warnings
from tests.samples.results import FLANKS_ALONE, SCENES

DISTANCE, RELIEF = "mounting.centre_distance_error_mm", "pinion.modifications.tip_relief_um"
MICROMETRES = 1e3
START = 177.0
"""Of a relief at the tip of the wheel of 57 teeth [mm]."""


def solved(name, cells, positions, **changes):
    """An analysis, and what a radian is at the wheel's base circle [um]."""
    wanted = {"analysis.cells": (cells, cells), "analysis.positions": positions, "analysis.torques_Nm": (130.0,)}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # contacts on edges are wanted
        result = analyse(read_scene(SCENES / f"{name}.toml").with_changes(wanted | changes))
    return result, MICROMETRES * result.gear_pair.base_radii[1]


def test_spur_teeth_that_bend_and_centre_distance_as_by_whole_analyses():
    result, length = solved("mesh_cycle_spur", 32, 3, **{"analysis.free_edges": False})
    found = result.sensitivities([DISTANCE])
    # differences over 0.04 mm; over 0.08 mm they differ by up to 0.0003
    assert_allclose(found.transmission_error[0, :2, 0] * length, [-342.4787, -342.6964], rtol=0, atol=1e-3)
    assert_allclose(found.peak_to_peak[0, 0] * length, 0.2177, rtol=0.01)
    assert_allclose(found.face_load_factor[0, 0], -0.0467, rtol=0.02)


def test_helical_flanks_and_centre_distance_as_by_whole_analyses():
    result, length = solved("helical", 64, 5, **FLANKS_ALONE)
    found = result.sensitivities([DISTANCE])
    differences = [-352.5957, -352.9221, -353.7757, -353.1195]  # over 0.04 mm
    told = found.transmission_error[0, :-1, 0] * length
    # analyses place their boxes anew, by which they differ by 0.02 um/mm from position to position
    assert_allclose(told, differences, rtol=0, atol=0.03)
    assert_allclose(told.mean(), np.mean(differences), rtol=0, atol=0.01)
    assert_allclose(found.peak_to_peak[0, 0] * length, 1.180, rtol=0.02)
    assert_allclose(found.harmonics(1)[0, 0, 0] * length, 0.5758, rtol=0.02)
    assert_allclose(found.face_load_factor[0, 0], 0.323, rtol=0.02)  # 0.3255, over 0.08 mm 0.3207


def test_ends_of_the_common_face_move_with_the_wheel():
    """Faces of one width, the wheel's offset by 1 mm: one end is the wheel's, and the common face is shorter."""
    key, at = "mounting.axial_offset_mm", {"mounting.axial_offset_mm": 1.0, "mounting.misalignment_um": 20.0}
    result, length = solved("helical", 32, 5, **FLANKS_ALONE, **at)
    found = result.sensitivities([key])
    assert_allclose(found.face_load_factor[0, 0], 0.0462, rtol=0.02)  # differences over 0.2 mm; over 0.4 mm 0.0461
    assert_allclose(found.peak_to_peak[0, 0] * length, 0.0844, rtol=0.02)  # 0.0843, 0.0845


def test_line_loads_of_cut_slices_are_warned_of_with_keys_that_move_edges_alone():
    result, _ = solved("helical", 16, 3, **FLANKS_ALONE, **{"analysis.accuracy": None})
    found, quiet = result.sensitivities([DISTANCE]), result.sensitivities(["pinion.modifications.lead_crowning_um"])
    assert found.on_cut_slices.any()
    assert not found.on_cut_slices[~(result.on_edge > 0)].any(), "no edge cuts what reaches none"
    with pytest.warns(AccuracyWarning, match=rf"an edge cuts .* \(at {found.on_cut_slices.sum()} of"):
        assert np.isfinite(found.line_load).any()
    with noted_accuracy_warnings() as sentences:
        assert np.isfinite(quiet.line_load).any()
    assert sentences == []


def test_starts_of_linear_reliefs_beside_the_point_are_warned_of_with_keys_that_move_them():
    form = {"tip_relief_form": "linear", "tip_relief_um": 5.0, "tip_relief_start_mm": 106.0}
    linear = {f"pinion.modifications.{name}": value for name, value in form.items()}
    result, _ = solved("mesh_cycle_helical", 16, 3, **FLANKS_ALONE, **linear, **{"analysis.accuracy": None})
    with noted_accuracy_warnings() as sentences:
        held = result.sensitivities([RELIEF])
    assert sentences == []
    with pytest.warns(AccuracyWarning, match="a linear relief starts in the contact beside its point"):
        moved = result.sensitivities([DISTANCE])
    assert moved.across_relief_starts.any()
    assert_array_equal(moved.across_relief_starts, held.across_relief_starts)
    assert not moved.across_relief_starts[~(result.on_relief_start > 0)].any()


@pytest.mark.parametrize(("key", "step"), [("wheel.modifications.tip_relief_start_mm", 0.01), (DISTANCE, 0.02)])
def test_contact_points_on_the_start_of_a_linear_relief_move_as_by_whole_analyses(key, step):
    """Beyond the start the flank has another slope: both sides of it at once give 30 times the derivative."""
    form = {"tip_relief_form": "linear", "tip_relief_um": 16.0, "tip_relief_start_mm": START}
    relief = {f"wheel.modifications.{name}": value for name, value in form.items()}
    result, length = solved("mesh_cycle_helical", 64, 5, **FLANKS_ALONE, **relief)
    assert any(grid.contact.on_relief_start for state in result.states[1].grids for grid in state)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # starts beside contact points
        found = result.sensitivities([key]).transmission_error[0, :, 0]
    value = START if key.endswith("start_mm") else 0.0
    low, high = (
        solved("mesh_cycle_helical", 64, 5, **FLANKS_ALONE, **relief | {key: value + by})[0].transmission_error[0]
        for by in (-step, step)
    )
    slopes = (high - low) / (2.0 * step)
    # as starts run through the cells of other contacts; the slope at that point was off by 3 and by 13 um/mm
    assert_allclose(found * length, slopes * length, rtol=0, atol=0.05)
