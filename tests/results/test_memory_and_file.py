"""What is derived of a result in memory and of the same result from its file: the same numbers."""

from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from loaded_tca import analyse, load_result, read_scene
from loaded_tca.results import derivatives
from loaded_tca.results.derivatives import states_of_maps
from tests.samples.results import FLANKS_ALONE, SCENES, changed, result

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")  # contacts at edges, at a cap: wanted
BEGUN_ANEW = 1e-6
"""Over the largest: linear systems are solved to that. With the same inputs they have been the same to the last bit;
cells taken for free at the cap, or a model of other teeth, changed shares by 0.2 and by 1e-3."""
SPIRAL = {
    "analysis.compliance": "contact",
    "analysis.positions": 3,
    "analysis.accuracy": 0.05,
    "analysis.torques_Nm": (0.0, 4.0),
    "pinion.modifications.lead_crowning_um": 4.5,
    "pinion.modifications.profile_crowning_um": 2.6,
}


@cache
def capped():
    """Spiral bevel pair, whose heel carries the cap on cells that edges cut; under a torque and none."""
    return analyse(read_scene(SCENES / "spiral_bevel.toml").with_changes(SPIRAL | {"material.max_pressure_MPa": 600.0}))


@pytest.fixture(scope="module")
def from_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("result") / "result.nc"
    capped().save(path)
    return load_result(path)


@pytest.mark.thorough
def test_derivatives_at_a_cap_are_those_of_the_file(from_file):
    kept, found = (one.sensitivities(["mounting.offset_mm", "load.pinion_torque_Nm"]) for one in (capped(), from_file))
    for name in ("transmission_error", "load_share", "line_load", "face_load_factor", "peak_to_peak"):
        expected = getattr(kept, name)
        scale = np.nanmax(np.abs(expected), axis=tuple(range(expected.ndim - 1)))
        assert np.nan_to_num(np.abs(getattr(found, name) - expected) / scale).max() <= BEGUN_ANEW, name
        assert_array_equal(np.isnan(getattr(found, name)), np.isnan(expected))


def test_cells_at_the_cap_stay_there_in_the_states_of_a_file(from_file):
    (kept,), made = capped().states[1], states_of_maps(from_file)
    bound = 0
    for state, again in zip(kept.grids, made.grids, strict=True):
        assert [grid.number for grid in state] == [grid.number for grid in again]  # sums round by their order
        for grid, other in zip(state, again, strict=True):
            assert_array_equal(grid.active, other.active)
            assert_array_equal(grid.separation.cover, other.separation.cover)
            bound += np.count_nonzero((grid.pressure > 0.0) & ~grid.active & (grid.separation.cover < 1.0))
    assert bound > 0


def test_pressure_on_the_material_of_a_map_keeps_the_cap(from_file):
    one = from_file.maps[1][1][from_file.peak_column[1, 1]]
    assert ((one.cover > 0.0) & (one.cover < 1.0)).any()
    assert (one.pressure[one.cover == 0.0] == 0.0).all()
    on_material = one.pressure / np.where(one.cover > 0.0, one.cover, 1.0)
    assert on_material.max() == pytest.approx(600.0, rel=1e-12)  # one division, of 1e-16


def test_teeth_that_states_of_a_file_couple_are_those_that_the_result_says(monkeypatch):
    one, asked = changed(result("mesh_cycle_helical"), coupled_pitches=3), []
    monkeypatch.setattr(derivatives, "model_of", lambda *given: asked.append(given[-1]))
    states_of_maps(one)
    assert asked == [3]


def test_contact_on_an_edge_has_no_error_without_load():
    scene = read_scene(SCENES / "misaligned.toml").with_changes(
        {**FLANKS_ALONE, "analysis.torques_Nm": [0.0], "analysis.positions": 2, "analysis.accuracy": 0.05}
    )
    idle = analyse(scene)
    assert idle.on_edge.any()
    assert np.isnan(idle.discretisation_error).all()
