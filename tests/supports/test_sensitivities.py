"""Derivatives of gears on supports: against slopes through whole analyses, which move and settle anew."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import MeshCycle, analyse, load_result, read_scene
from loaded_tca.arrays import Array
from loaded_tca.compliance.model import SumOfParts
from loaded_tca.errors import InputError
from loaded_tca.scene import Scene
from loaded_tca.separation.pair_change import number_at
from tests.refusals import refusals
from tests.samples.shared import made_once

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")  # contacts at edges: not the matter here

AGREES, ROUGH = 0.03, 0.05
"""Of the largest slope, with whole analyses on 32 cells, as is asked of rigid gears on 64: they make boxes and grids
anew; of line loads and pressures, which are those of a few cells."""
SMOOTH = 2e-3
"""The same of keys that move no line of the flanks through the contact by more than the supports do."""
FROM_FILE = 1e-8
"""Of the largest of a key, as of rigid gears: contact points found again to 1e-12 mm, a linear solution begun anew."""
TORQUE = "load.pinion_torque_Nm"
CELLS = 32

SHAFT = {
    "start_mm": -100.0,
    "torque_at_mm": -90.0,
    "sections": [{"length_mm": 220.0, "outer_diameter_mm": 35.0}],
    "bearings": [
        {"at_mm": -60.0, "radial_stiffness_N_per_um": 200.0, "axial_stiffness_N_per_um": 100.0},
        {"at_mm": 100.0, "radial_stiffness_N_per_um": 150.0},
    ],
    "loads": [{"at_mm": 110.0, "force_N": [500.0, 0.0, 0.0]}],
}
SOFT = np.diag([3e-5, 3e-5, 3e-5, 1e-8, 1e-8, 1e-8])
SOFT[0, 4] = SOFT[4, 0] = 2e-7
SOFT[1, 3] = SOFT[3, 1] = -2e-7
CHANGES: dict[str, tuple[str, dict[str, Any]]] = {
    "spur": ("mesh_cycle_spur", {"pinion.shaft": SHAFT, "pinion.bore_diameter_mm": 34.0}),
    "helical": ("helical_on_supports", {}),
    "bevel": (
        "mesh_cycle_bevel",
        {"pinion.support.compliance": SOFT.tolist(), "wheel.support.compliance": SOFT.tolist()},
    ),
}
SOFT_HYPOID = np.diag([1.2e-5] * 3 + [4e-9] * 3).tolist()
CHANGES["hypoid"] = (
    "hypoid_13x42",
    {
        "pinion.support.compliance": SOFT_HYPOID,
        "wheel.support.compliance": SOFT_HYPOID,
        "pinion.modifications": {"lead_crowning_um": 5.0},
        "wheel.modifications": None,
        "analysis.free_edges": False,
    },
)
POSITIONS = {"spur": 3, "helical": 4, "bevel": 4, "hypoid": 1}
TORQUES = {"spur": 130.0, "helical": 130.0, "bevel": 0.8, "hypoid": 250.0}


@cache
def scene_of(name: str, compliance: str = "contact") -> Scene:
    file, changes = CHANGES[name]
    fixed = {
        "analysis.positions": POSITIONS[name],
        "analysis.accuracy": None,
        "analysis.cells": (CELLS, CELLS),
        "analysis.compliance": compliance,
        "analysis.torques_Nm": [TORQUES[name]],
    }
    return read_scene(f"examples/scenes/{file}.toml").with_changes(fixed | changes)


@made_once
def analysed(name: str, compliance: str = "contact", changes: tuple[tuple[str, float], ...] = ()) -> MeshCycle:
    scene, wanted = scene_of(name, compliance), dict[str, Any](changes)
    if TORQUE in wanted:
        wanted = {"analysis.torques_Nm": [wanted[TORQUE]]}
    return analyse(scene.with_changes(wanted))


def on_few_cells(*torques: float) -> MeshCycle:
    """The helical pair where derivatives are compared on one grid."""
    return analyse(scene_of("helical").with_changes({"analysis.torques_Nm": torques, "analysis.cells": (16, 16)}))


@pytest.fixture(scope="module")
def torques() -> MeshCycle:
    return on_few_cells(0.0, 40.0, 130.0)


def slopes(name: str, key: str, step: float, compliance: str = "contact") -> Mapping[str, Array]:
    """Quotients of differences of two analyses."""
    value = TORQUES[name] if key == TORQUE else number_at(scene_of(name), key)
    one, other = (analysed(name, compliance, ((key, value + by),)) for by in (-step, step))
    names = "transmission_error", "load_share", "line_load", "peak_pressure", "face_load_factor"
    return {name: (getattr(other, name) - getattr(one, name))[0] / (2.0 * step) for name in names}


BENDING = {
    ("spur", TORQUE),
    ("helical", "mounting.misalignment_um"),
    ("bevel", "pinion.modifications.helix_slope_um"),
}
"""Where teeth bend, too: a load, a position and a shape, each of another pair."""


@pytest.mark.quick_cases("spur-pinion.shaft.torque_at_mm-1.0-0.002")
@pytest.mark.parametrize(
    ("name", "key", "step", "agreement"),
    [
        pytest.param("spur", "wheel.modifications.profile_slope_um", 0.5, AGREES, marks=pytest.mark.thorough),
        pytest.param("spur", TORQUE, 2.0, SMOOTH, marks=pytest.mark.thorough),
        pytest.param("spur", "pinion.shaft.bearings.0.at_mm", 1.0, SMOOTH, marks=pytest.mark.thorough),
        pytest.param("spur", "pinion.shaft.torque_at_mm", 1.0, SMOOTH, marks=pytest.mark.thorough),
        pytest.param("spur", "pinion.shaft.sections.0.outer_diameter_mm", 0.25, SMOOTH, marks=pytest.mark.thorough),
        ("spur", "pinion.shaft.bearings.0.radial_stiffness_N_per_um", 10.0, AGREES),  # 0.03 um in all: grids count
        ("spur", "pinion.shaft.loads.0.at_mm", 2.0, AGREES),
        pytest.param("helical", "pinion.modifications.lead_crowning_um", 1.0, AGREES, marks=pytest.mark.thorough),
        pytest.param("helical", "mounting.misalignment_um", 1.0, AGREES, marks=pytest.mark.thorough),
        ("helical", "mounting.centre_distance_error_mm", 0.01, SMOOTH),
        pytest.param("bevel", "pinion.modifications.helix_slope_um", 0.5, AGREES, marks=pytest.mark.thorough),
        ("bevel", "mounting.offset_mm", 1e-3, SMOOTH),
        pytest.param("bevel", TORQUE, 0.02, SMOOTH, marks=pytest.mark.thorough),
    ],
)
def test_transmission_error_changes_as_whole_analyses_do(name: str, key: str, step: float, agreement: float) -> None:
    for compliance in ("contact", "contact+tooth") if (name, key) in BENDING else ("contact",):
        changes_alike(name, key, step, agreement, compliance)


def changes_alike(name: str, key: str, step: float, agreement: float, compliance: str) -> None:
    expected = slopes(name, key, step, compliance)["transmission_error"]
    found = analysed(name, compliance).sensitivities([key]).transmission_error[0, :, 0]
    assert_allclose(found, expected, rtol=0.0, atol=agreement * np.abs(expected).max())


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("key", "step", "agreement"),
    [
        pytest.param("pinion.modifications.helix_slope_um", 0.5, 0.01, marks=pytest.mark.thorough),
        ("pinion.modifications.profile_slope_um", 0.5, 0.01),
        pytest.param(TORQUE, 4.0, SMOOTH, marks=pytest.mark.thorough),
    ],
)
def test_directions_of_forces_turn_with_the_contacts(key: str, step: float, agreement: float) -> None:
    """The contact runs over flanks that curve, and the forces on soft supports turn with their normals there.

    With the normals held the slopes of modifications are 8 to 10 % off here, with motions of the gears that do not
    answer themselves that of the torque 0.4 %.
    """
    changes_alike("hypoid", key, step, agreement, "contact")


@pytest.mark.thorough
def test_gears_stand_elsewhere_by_a_key() -> None:
    """With the motions held the curve under another torque is 4 % off, its peak pressure 5 %."""
    expected, found = slopes("bevel", TORQUE, 0.02), analysed("bevel").sensitivities([TORQUE])
    error = expected["transmission_error"]
    curve, own = (one - one.mean() for one in (error, found.transmission_error[0, :, 0]))
    assert_allclose(own, curve, rtol=0.0, atol=0.01 * np.abs(curve).max())
    for name in ("load_share", "line_load", "peak_pressure"):
        slope, changes = expected[name], getattr(found, name)[0, ..., 0]
        known = np.isfinite(slope) & np.isfinite(changes)
        assert_allclose(changes[known], slope[known], rtol=0.0, atol=AGREES * np.abs(slope[known]).max())
    assert_allclose(found.face_load_factor[0], expected["face_load_factor"], rtol=AGREES)


@pytest.mark.thorough
def test_load_along_the_face_changes_as_in_whole_analyses() -> None:
    key = "pinion.modifications.lead_crowning_um"
    expected, found = slopes("helical", key, 1.0), analysed("helical").sensitivities([key])
    assert_allclose(found.face_load_factor[0, 0], expected["face_load_factor"], rtol=AGREES)
    loaded = analysed("helical").load_share[0] > 0.1
    for name in ("line_load", "peak_pressure"):
        assert_allclose(
            getattr(found, name)[0, ..., 0][loaded],
            expected[name][loaded],
            rtol=0.0,
            atol=ROUGH * np.abs(expected[name][loaded]).max(),
        )


def test_load_shares_follow_contacts_that_a_modification_moves_by_unlike_ways(torques: MeshCycle) -> None:
    """Where a grid moves on with its contact, its forces tilt the gears for the other pair, too.

    Were each pair tilted as if both grids moved by its way, the derivative would be 2.4 times as large.
    """
    key, scene = "pinion.modifications.lead_crowning_um", torques.scene.with_changes({"analysis.torques_Nm": [130.0]})
    value = number_at(scene, key)
    below, above = (analyse(scene.with_changes({key: value + by})).load_share[0, 0] for by in (-1.0, 1.0))
    both = torques.load_share[-1, 0] > 0.0  # away from edges, as they are not at the other positions
    found = torques.sensitivities([key]).load_share[-1, 0, :, 0]
    # 16 cells leave 5 % of it
    assert_allclose(found[both], 0.5 * (above - below)[both], rtol=0.1)


@pytest.mark.quick_cases("helical")
@pytest.mark.parametrize("name", ["spur", "helical"])
def test_derivatives_from_a_file_are_those_of_the_analysis(tmp_path: Any, torques: MeshCycle, name: str) -> None:
    """Of teeth that bend, and of three torques with zero among them."""
    one = analysed("spur", "contact+tooth") if name == "spur" else torques
    keys = ["mounting.misalignment_um", "pinion.modifications.lead_crowning_um", TORQUE]
    keys += ["pinion.shaft.bearings.1.radial_stiffness_N_per_um"] if name == "spur" else []
    one.save(tmp_path / "result.nc")
    kept, found = one.sensitivities(keys), load_result(tmp_path / "result.nc").sensitivities(keys)
    for name in ("transmission_error", "line_load", "face_load_factor"):
        expected = getattr(kept, name)
        largest = np.nanmax(np.abs(expected), axis=tuple(range(expected.ndim - 1)))
        assert (np.nan_to_num(np.abs(getattr(found, name) - expected)) <= FROM_FILE * largest).all(), name


def test_result_says_how_many_pitches_its_teeth_couple(torques: MeshCycle) -> None:
    few = {"analysis.positions": 2, "analysis.cells": (8, 8)}
    one = analyse(scene_of("spur", "contact+tooth").with_changes(few))
    assert one.states is not None
    bending = one.states[1][0].bending
    assert isinstance(bending, SumOfParts)
    assert bending.on_rigid_supports is not None
    assert one.coupled_pitches == bending.on_rigid_supports.neighbours
    assert torques.coupled_pitches == 0  # flanks alone


def test_each_torque_has_the_derivatives_of_its_own_gears(torques: MeshCycle) -> None:
    keys = ["mounting.misalignment_um", TORQUE]
    found, alone = torques.sensitivities(keys), on_few_cells(130.0).sensitivities(keys)
    assert_allclose(found.transmission_error[2], alone.transmission_error[0], rtol=1e-6)
    assert np.isnan(found.transmission_error[0]).all()
    weighed = [any(one is not None for row in by_torque for one in row) for by_torque in found.weight_maps]
    assert weighed == [False, True, True]
    assert found.dataset["line_load"].shape == (3, 4, len(torques.pair), 2)
    assert found.pressure_norm(12.0).shape == (3, 4, 2)
    assert "2 keys" in repr(found)
    stiffness = 1.0 / np.abs(found.transmission_error[2, :, 1])
    lengths = np.prod(torques.gear_pair.base_radii) * torques.face_width  # per N m, and per um
    assert_allclose(stiffness / lengths, torques.drive_stiffness[2], rtol=0.03)  # which holds the geometry


def test_unloaded_result_has_no_derivatives(torques: MeshCycle) -> None:
    idle = analyse(torques.scene.with_changes({"analysis.torques_Nm": [0.0]}))
    with pytest.raises(InputError, match="no tooth pair of the result carries load"):
        idle.sensitivities([TORQUE])


def derivative_of(name: str, key: str) -> None:
    analysed(name).sensitivities([key])


test_keys_without_derivatives_are_refused = refusals(
    derivative_of,
    ("helical", "pinion.support.compliance", r"pinion.support.compliance: found .* allowed a key whose value is one"),
    ("spur", "pinion.shaft.bearings.7.at_mm", r"pinion.shaft.bearings.7.at_mm: unknown key"),
    ("spur", "pinion.shaft.gear", r"pinion.shaft.gear: found 'rigid'; allowed a key whose value is one number"),
    ("spur", "pinion.teeth", r"pinion.teeth: does not change the gap alone"),
)
