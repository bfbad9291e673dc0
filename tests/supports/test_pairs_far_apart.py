"""Tooth pairs that come to bear further apart than the motions of the gears were estimated to bring them.

A wide helical pair, far out of line, whose wheel swings into line under load: without load, and under one that acts
where the flanks touch first, tooth pairs within reach are two pitches apart, under load they are four.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose

import loaded_tca.analysis
from loaded_tca import MeshCycle, analyse, analyse_revolution, read_scene
from loaded_tca.arrays import Array
from loaded_tca.compliance import model_of
from loaded_tca.scene import Scene
from loaded_tca.separation import sample_separation
from loaded_tca.studies import DesignModel
from loaded_tca.unloaded import trace_contact

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")  # motions are meant to be large

SAME_um = 0.03
"""Models of four teeth and of five beside a loaded one: coarser teeth further away are worth 16 nm of all positions,
what the teeth between pairs four pitches apart do beside supports alone 350 to 520 nm."""
ONE_PITCH_um, HELD_um = 0.05, 0.1
"""A revolution moves its gears by the mean of two positions, which leaves 34 nm beside a wheel that swings by 1.4 mm;
contacts of a design have other boxes, whose edges cut tip corners on 16 x 24 cells elsewhere."""


@cache
def far_out_of_line() -> Scene:
    wide = {f"{gear}.face_width_mm": 100.0 for gear in ("pinion", "wheel")}
    tilts = np.diag([1e-7, 1e-7, 1e-7, 1e-8, 0.0, 1e-9]).tolist()
    changes = {"pair.helix_angle_deg": 28.0, "mounting.misalignment_um": 1430.0, "wheel.support.compliance": tilts}
    fixed = {"analysis.positions": 5, "analysis.cells": (16, 24), "analysis.free_edges": False}
    plain = {"pinion.modifications": None, "wheel.modifications": None, "analysis.torques_Nm": [2600.0]}
    return read_scene("examples/scenes/mesh_cycle_helical.toml").with_changes(wide | changes | fixed | plain)


@cache
def analysed() -> MeshCycle:
    return analyse(far_out_of_line())


def errors_um(result: MeshCycle) -> Array:
    return np.asarray(1e3 * result.wheel_base_radius * result.transmission_error[0])


@pytest.mark.thorough
def test_an_analysis_has_the_teeth_between_all_pairs_that_carry_load(monkeypatch: pytest.MonkeyPatch) -> None:
    loaded = [analysed().pair[shares > 0.0] for shares in analysed().load_share[0]]
    assert max(np.ptp(numbers) for numbers in loaded) == 4
    made = loaded_tca.analysis.model_of
    monkeypatch.setattr(loaded_tca.analysis, "model_of", lambda scene, pair, _: made(scene, pair, 5))
    assert_allclose(errors_um(analysed()), errors_um(analyse(far_out_of_line())), rtol=0.0, atol=SAME_um)


@pytest.mark.thorough
def test_a_revolution_has_them_too() -> None:
    turn = analyse_revolution(
        far_out_of_line().with_changes({"revolution.pitches": 1, "revolution.positions_per_pitch": 2})
    )
    places = [np.argmin(np.abs(analysed().pinion_angle - angle)) for angle in turn.dataset["pinion_angle"].values]
    found = 1e3 * analysed().wheel_base_radius * turn.dataset["transmission_error"].values[0]
    assert_allclose(found, errors_um(analysed())[places], rtol=0.0, atol=ONE_PITCH_um)


@pytest.mark.thorough
def test_a_design_has_them_too() -> None:
    scene = far_out_of_line()
    model = DesignModel(scene, {"pinion.modifications.lead_crowning_um": (0.0, 1.0)})
    found = 1e3 * analysed().wheel_base_radius * model.evaluate(model.start).transmission_error[0, 0]
    assert_allclose(found, errors_um(analysed())[:-1], rtol=0.0, atol=HELD_um)


@pytest.mark.thorough
def test_teeth_alone_that_have_no_model_of_two_pairs_leave_no_deflection_between_them() -> None:
    scene = far_out_of_line()
    pair = scene.pair()
    grid = sample_separation(pair, trace_contact(pair, [0.0])[0], cells=(4, 6), box=(0.2, 3.0))
    bending = model_of(scene, pair, 1)
    assert bending is not None
    teeth = bending.on_rigid_supports
    assert teeth is not None
    assert np.array_equal(teeth.between((0, grid), (3, grid)), np.zeros((6, 6)))
    assert np.array_equal(teeth.deflection((0, grid), (3, grid), np.ones(6)), np.zeros(6))
