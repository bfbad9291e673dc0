"""The mesh cycle of every kind of gear with free edges and without: period, and stiffness beside its own rotations."""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import analyse, read_scene

SCENES = Path(__file__).parents[2] / "examples" / "scenes"
STEP = 0.05
"""Of the torque, to either side. The law of the rotation bends by 1e-4 of its slope within it; where lines end at tips
and faces, the rotations scatter by 2e-4 of themselves on these grids, and the slope by 1 % over a narrower step."""


def solved(name, torque, free_edges):
    changes = {
        "analysis.positions": 3,
        "analysis.load_sharing": True,
        "analysis.compliance": "contact",
        "analysis.cells": [24, 32],
        "analysis.free_edges": free_edges,
        "analysis.torques_Nm": [(1.0 - STEP) * torque, torque, (1.0 + STEP) * torque],
    }
    return analyse(read_scene(SCENES / f"{name}.toml").with_changes(changes))


@pytest.mark.quick_cases("mesh_cycle_spur-130.0-True", "straight_bevel-50.0-False")
@pytest.mark.filterwarnings("ignore::loaded_tca.errors.AccuracyWarning")  # contacts reach tips and face ends
@pytest.mark.parametrize("free_edges", [False, True])
@pytest.mark.parametrize(
    ("name", "torque"),
    [("helical", 130.0), ("mesh_cycle_spur", 130.0), ("straight_bevel", 50.0), ("face_milled_19x62_matched", 300.0)],
)
def test_state_repeats_after_a_pitch_and_stiffness_is_that_of_the_rotations(name, torque, free_edges):
    result = solved(name, torque, free_edges)
    error = result.transmission_error - result.unloaded_transmission_error
    assert_allclose(error[1, -1], error[1, 0], rtol=1e-3)
    shares = np.nan_to_num(result.load_share[1])
    assert_allclose(shares[-1, 1:], shares[0, :-1], atol=1e-3)
    turned = np.abs(error[2] - error[0]) * result.wheel_base_radius * 1e3  # um
    force = 2.0 * STEP * torque * 1e3 / result.gear_pair.base_radii[0] / result.face_width
    assert_allclose(result.mesh_stiffness[1], force / turned, rtol=2e-2)
