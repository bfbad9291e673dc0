"""Whole revolutions of gears on supports: one pitch of teeth that are alike, shares, orders, forces on bearings."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import MeshCycle, Revolution, analyse, analyse_revolution
from loaded_tca.scene import Scene
from tests.supports.test_sensitivities import scene_of

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")

AS_ONE_PITCH_um = 5e-4
"""Of the transmission error without deviations, by the analysis of one pitch: tooth pairs agree to 1e-5 of a deflection
that has 50 um of the shaft in it."""
TWO_PITCHES = {"revolution.pitches": 2, "revolution.positions_per_pitch": 4}


def small(name: str, torques: tuple[float, ...], **changes: Any) -> Scene:
    cells = {"analysis.positions": 5, "analysis.cells": [16, 24], "analysis.torques_Nm": list(torques)}
    return scene_of(name).with_changes(cells | TWO_PITCHES | changes)


@cache
def both(name: str, torques: tuple[float, ...], compliance: str) -> tuple[MeshCycle, Revolution]:
    scene = small(name, torques, **{"analysis.compliance": compliance})
    return analyse(scene), analyse_revolution(scene)


@pytest.mark.parametrize(
    ("name", "torques", "compliance"),
    [
        pytest.param("spur", (60.0, 130.0), "contact+tooth", marks=pytest.mark.thorough),
        ("helical", (0.0, 130.0), "contact"),
        pytest.param("bevel", (0.8,), "contact", marks=pytest.mark.thorough),
    ],
)
def test_revolution_of_alike_teeth_on_supports_is_the_analysis_of_one_pitch(
    name: str, torques: tuple[float, ...], compliance: str
) -> None:
    one, turn = both(name, torques, compliance)
    places = np.round(4.0 * one.pinion_angle[:4] / one.gear_pair.pitch).astype(int) % 4
    data, length = turn.dataset, 1e3 * one.wheel_base_radius
    for begin in (0, 4):
        found = length * data["transmission_error"].values[:, begin + places]
        assert_allclose(found, length * one.transmission_error[:, :4], rtol=0.0, atol=AS_ONE_PITCH_um)
    for quantity in ("mesh_stiffness", "drive_stiffness", "misalignment"):
        assert_allclose(data[quantity].values[:, places], getattr(one, quantity)[:, :4], rtol=2e-3)  # single cells
    assert_allclose(data["wheel_motion"].values[:, places], one.wheel_motion[:, :4], rtol=1e-4, atol=1e-10)
    assert_allclose(data["wheel_support_load"].values, one.wheel_support_load, rtol=1e-6, atol=1e-6)


@pytest.mark.thorough
def test_forces_on_bearings_follow_teeth_that_stand_apart() -> None:
    index = [0.0] * 57
    index[1] = 6.0
    scene = small("spur", (60.0,), **{"wheel.pitch.index_um": index, "revolution.pitches": 3})
    apart, alike = analyse_revolution(scene), analyse_revolution(scene.with_changes({"wheel.pitch": None}))
    forces, usual = (one.dataset["pinion_bearing_force"].values[0] for one in (apart, alike))
    assert forces.shape == (12, 2, 6)
    assert_allclose(usual[:4], usual[4:8], rtol=1e-4, atol=1e-3 * np.abs(usual).max())
    lateral = np.linalg.norm(forces[..., :2].sum(axis=1), axis=-1), np.linalg.norm(usual[..., :2].sum(axis=1), axis=-1)
    assert_allclose(*lateral, rtol=5e-3)  # forces lie along the line of action, but where a tip edge carries
    share = (
        apart.dataset["load_share"].values[0] - alike.dataset["load_share"].sel(pair=apart.dataset["pair"]).values[0]
    )
    assert np.abs(share).max() > 0.05
    assert_allclose(apart.dataset["load_share"].values.sum(axis=-1), 1.0, atol=1e-9)


@pytest.mark.thorough
def test_revolution_on_supports_is_saved_and_read(tmp_path: Any) -> None:
    _, turn = both("spur", (60.0, 130.0), "contact+tooth")
    turn.save(tmp_path / "turn.nc")
    back = Revolution.load(tmp_path / "turn.nc")
    for name in ("pinion_motion", "misalignment", "drive_stiffness", "pinion_bearing_force", "transmission_error"):
        assert_allclose(back.dataset[name].values, turn.dataset[name].values, rtol=0.0)
    assert back.key_figures() == turn.key_figures()


@pytest.mark.thorough
def test_flanks_of_one_tooth_move_with_its_gear() -> None:
    """A tooth whose flanks are those of the others in all but name changes nothing."""
    scene = small("helical", (130.0,))
    tooth = {"number": 1, "modifications": {"lead_crowning_um": 0.0}}
    own = scene.with_changes({"wheel.tooth": [tooth]})
    one, other = analyse_revolution(scene), analyse_revolution(own)
    assert_allclose(other.error_um(0), one.error_um(0), rtol=0.0, atol=AS_ONE_PITCH_um)
