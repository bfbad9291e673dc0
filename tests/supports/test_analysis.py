"""Mesh cycles of gears on supports that give way."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import MeshCycle, analyse, load_result, read_scene
from loaded_tca.arrays import Array
from loaded_tca.compliance import model_of
from loaded_tca.errors import AccuracyWarning, GeometryError, NotAskedError, noted_accuracy_warnings
from loaded_tca.loaded.tooth_contact import GridChoice
from loaded_tca.output.result_files import positions_csv
from loaded_tca.results import reached_edges
from loaded_tca.scene import Scene
from loaded_tca.separation import sample_separation
from loaded_tca.supports import support_compliance, supports_of
from loaded_tca.unloaded import trace_contact
from validation.loaded.moved_gears import settled

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")  # contacts at edges: not the matter here

AGREES, MOTIONS_AGREE = 1e-4, 1e-3
"""Of the transmission error and of the motions with rigid analyses repeated: what the coupling is asked for. What is
left is the product of the motions and their change over a step."""
CELLS = 24


def matrix(translation: float, tilt: float, twist: float, seed: int) -> Array:
    """A full compliance with such diagonal entries."""
    half = 0.3 * np.random.default_rng(seed).normal(size=(6, 6)) + np.eye(6)
    product = half @ half.T
    roots = np.sqrt(np.array([translation] * 3 + [tilt] * 2 + [twist]) / product.diagonal())
    return np.asarray(product * np.outer(roots, roots))


def scene_of(name: str, **changes: Any) -> Scene:
    fixed = {"analysis.positions": 1, "analysis.cells": (CELLS, CELLS), "analysis.compliance": "contact"}
    return read_scene(f"examples/scenes/{name}.toml").with_changes(fixed | changes)


def on(scene: Scene, pinion: Array | None, wheel: Array | None) -> Scene:
    changes: Mapping[str, Any] = {
        f"{gear}.support.compliance": one.tolist()
        for gear, one in (("pinion", pinion), ("wheel", wheel))
        if one is not None
    }
    return scene.with_changes(changes)


@pytest.mark.quick_cases("mesh_cycle_spur-size0")
@pytest.mark.parametrize(
    ("name", "size"),
    [
        ("mesh_cycle_spur", (4e-6, 4e-9, 4e-9)),
        pytest.param("helical", (4e-6, 3e-9, 1e-9), marks=pytest.mark.thorough),
        pytest.param("spiral_bevel", (3e-6, 1e-9, 1e-9), marks=pytest.mark.thorough),
        ("straight_bevel", (3e-6, 1e-9, 1e-9)),
        pytest.param("face_milled_19x62_matched", (1e-6, 1e-10, 1e-10), marks=pytest.mark.thorough),
    ],
)
def test_coupled_analysis_equals_rigid_ones_with_moved_gears(name: str, size: tuple[float, float, float]) -> None:
    scene = scene_of(name)
    pinion, wheel = matrix(*size, seed=1), matrix(*size, seed=2)
    result = analyse(on(scene, pinion, wheel))
    grid = GridChoice((CELLS, CELLS), tolerance=scene.analysis.tolerance, free_edges=scene.analysis.free_edges)
    expected = settled(scene, (pinion, wheel), grid, relaxation=0.7)
    assert_allclose(result.transmission_error[0, 0], expected.transmission_error, rtol=AGREES)
    motions = np.stack([result.pinion_motion[0, 0], result.wheel_motion[0, 0]])
    largest = np.abs(expected.motions).reshape(2, 2, 3).max(axis=-1).repeat(3, axis=-1)
    assert (np.abs(motions - expected.motions) < MOTIONS_AGREE * largest).all()


@pytest.mark.thorough
def test_supports_couple_tooth_pairs_that_no_model_of_teeth_has_together() -> None:
    """A helix slope against soft shafts brings four pairs within reach: two of them three pitches apart."""
    slope = {"pinion.modifications.helix_slope_um": -17.0}
    scene = scene_of("helical_on_shafts", **slope, **{"analysis.compliance": "contact+tooth"})
    pair = scene.pair()
    grid = sample_separation(pair, trace_contact(pair, [0.0])[0], cells=(4, 6), box=(0.2, 3.0))
    bending, supports = model_of(scene, pair, 1), support_compliance(scene, pair)
    assert bending is not None
    assert supports is not None
    assert_allclose(bending.between((0, grid), (3, grid)), supports.between((0, grid), (3, grid)))
    result = analyse(scene)
    assert_allclose(result.load_share.sum(axis=-1), 1.0, rtol=1e-9)


@pytest.mark.thorough
def test_torque_between_others_is_that_by_itself() -> None:
    """Cycles of few positions do not check the mean load that would follow from the smallest and largest torque."""
    scene = on(scene_of("helical", **{"analysis.positions": 2}), matrix(4e-6, 3e-9, 1e-9, seed=1), None)
    torques = ([50.0], [5.0, 50.0, 250.0])
    alone, among = (analyse(scene.with_changes({"analysis.torques_Nm": one})) for one in torques)
    assert np.array_equal(among.transmission_error[1], alone.transmission_error[0])
    assert np.array_equal(among.peak_pressure[1][:, among.pair == 0], alone.peak_pressure[0][:, alone.pair == 0])


@pytest.fixture(scope="module")
def soft() -> MeshCycle:
    scene = scene_of("mesh_cycle_helical", **{"analysis.positions": 3, "analysis.torques_Nm": [20.0, 60.0]})
    return analyse(on(scene, matrix(1e-6, 1e-9, 1e-9, 1), matrix(1e-6, 1e-9, 2e-9, 2)))


@pytest.fixture(scope="module")
def rigid(soft: MeshCycle) -> MeshCycle:
    return analyse(soft.scene.with_changes({"pinion.support": None, "wheel.support": None}))


def test_rotation_about_the_axis_alone_is_wind_up() -> None:
    scene = scene_of("mesh_cycle_spur")
    torsion = np.diag([0.0, 0.0, 0.0, 0.0, 0.0, 1e-9])
    result, held = analyse(on(scene, torsion, torsion)), analyse(scene)
    torque, ratio = np.array(scene.torques)[:, None], scene.pair().ratio
    wind_up = 1e-9 * torque * (ratio + 1.0 / ratio)
    assert_allclose(result.pinion_motion[..., 5], -1e-9 * torque, rtol=1e-5)
    assert_allclose(held.transmission_error - result.transmission_error, wind_up, rtol=1e-4)
    assert_allclose(result.transmission_error - result.wind_up, held.transmission_error, atol=1e-4 * wind_up.max())
    assert_allclose(result.peak_pressure, held.peak_pressure, rtol=5e-4)  # the wound-up pinion is a little on
    assert_allclose(result.secant_stiffness, held.secant_stiffness, rtol=1e-3)


@pytest.mark.thorough
def test_forces_on_both_gears_are_equal_and_opposite() -> None:
    scene = scene_of("helical")
    same = np.diag([1e-6, 1e-6, 1e-6, 0.0, 0.0, 0.0])
    result = analyse(on(scene, same, same))
    # the same force, that one balance has found
    assert_allclose(result.pinion_motion[..., :3], -result.wheel_motion[..., :3], rtol=1e-9)


@pytest.mark.thorough
def test_straight_teeth_that_do_not_tilt_take_no_axial_force_from_a_tilted_pinion() -> None:
    none = {"wheel.modifications.lead_crowning_um": 0.0, "pinion.modifications.lead_crowning_um": 8.0}
    result = analyse(
        on(scene_of("mesh_cycle_spur", **none), matrix(4e-6, 4e-9, 4e-9, 1), np.diag([0, 0, 1e-6, 0, 0, 0]))
    )
    force, tilt = np.nansum(result.normal_force[0, 0]), np.abs(result.pinion_motion[0, 0, 3:5]).max()
    assert tilt > 5e-5
    assert abs(result.wheel_motion[0, 0, 2]) < 1e-9 * 1e-6 * force * tilt


@pytest.mark.thorough
def test_supports_next_to_rigid_change_nothing() -> None:
    scene = scene_of("helical")
    result, held = analyse(on(scene, 1e-14 * np.eye(6), None)), analyse(scene)
    assert_allclose(result.transmission_error, held.transmission_error, rtol=5e-5)  # rotations agree to 1e-5
    assert_allclose(result.peak_pressure, held.peak_pressure, rtol=1e-5)


@pytest.mark.quick_cases("contact+tooth-helical")
@pytest.mark.parametrize(("compliance", "name"), [("contact+tooth", "helical"), ("contact", "mesh_cycle_helical")])
def test_supports_next_to_rigid_keep_boxes_and_grids(compliance: str, name: str) -> None:
    """They add 1e-8 of what teeth give way; boxes of other loads and contacts elsewhere moved stiffness by 2e-3."""
    chosen = {"analysis.cells": None, "analysis.accuracy": 0.2, "analysis.compliance": compliance}
    scene = scene_of(name, **chosen)
    result, held = analyse(on(scene, 1e-14 * np.eye(6), None)), analyse(scene)
    assert_allclose(result.mesh_stiffness, held.mesh_stiffness, rtol=1e-6)  # linear systems are solved to 1e-6


def test_rigid_supports_are_none() -> None:
    """To the last digit: nothing that the supports add is in the balance, which decides on boxes and grids."""
    scene = scene_of("helical", **{"analysis.cells": (12, 12)})
    result, held = analyse(on(scene, np.zeros((6, 6)), None)), analyse(scene)
    for name in ("transmission_error", "load_share", "peak_pressure", "discretisation_error"):
        assert np.array_equal(getattr(result, name), getattr(held, name), equal_nan=True)
    leads = [
        one.sensitivities(["pinion.modifications.lead_crowning_um"]).peak_pressure[0, 0, :, 0] for one in (result, held)
    ]
    assert_allclose(*leads, rtol=0.0, atol=1e-4 * np.nanmax(np.abs(leads)))  # linear systems are solved to 1e-6 each
    assert not result.pinion_motion.any()
    assert result.pinion_support_load[0, 5] != 0.0  # what holds the gear has its loads nevertheless


def test_mesh_stiffness_is_that_on_rigid_supports(soft: MeshCycle, rigid: MeshCycle) -> None:
    assert_allclose(soft.mesh_stiffness, rigid.mesh_stiffness, rtol=0.02)  # the contact moves a little along the face
    assert (soft.drive_stiffness < 0.5 * soft.mesh_stiffness).all()
    assert_allclose(soft.secant_stiffness, rigid.secant_stiffness, rtol=0.05)


@pytest.mark.thorough
def test_drive_stiffness_is_the_slope_of_the_torque(soft: MeshCycle) -> None:
    near = analyse(soft.scene.with_changes({"analysis.torques_Nm": [59.7, 60.3]}))
    pair = soft.gear_pair
    slope = 600.0 / -np.diff(near.transmission_error, axis=0)[0]
    lengths = 1e3 * pair.base_radii[0] * pair.base_radii[1] * pair.face_width
    assert_allclose(soft.drive_stiffness[1], slope / lengths, rtol=5e-3)  # geometry moves with the torque, too


@pytest.mark.thorough
def test_geometry_stands_where_the_mean_load_of_the_pitch_moves_it() -> None:
    """Two coarse positions are 1 % off here; the mean of the cycle checks them."""
    scene = scene_of("spiral_bevel", **{"analysis.positions": 6, "analysis.torques_Nm": [300.0]})
    result = analyse(on(scene, np.diag([3e-6] * 3 + [1e-9] * 3), None))
    support = supports_of(result.scene)[0]
    held = support.at_middle(support.moved(result.pinion_support_load[0]))
    mean = result.pinion_motion[0, :-1].mean(axis=0)  # axes of the pinion are those of the fixed frame
    assert_allclose(mean[:3], held[:3], rtol=0.0, atol=2e-5 * result.gear_pair.module)


def test_motions_grow_with_the_torque(soft: MeshCycle) -> None:
    assert soft.pinion_motion.shape == (2, 3, 6)
    assert_allclose(soft.pinion_motion[1], 3.0 * soft.pinion_motion[0], atol=0.1 * np.abs(soft.pinion_motion[1]).max())
    assert np.isfinite(soft.misalignment).all()


def test_results_on_supports_are_saved_and_read(soft: MeshCycle, tmp_path: Any) -> None:
    soft.save(tmp_path / "result.nc")
    back = load_result(tmp_path / "result.nc")
    for name in ("pinion_motion", "wheel_motion", "misalignment", "drive_stiffness", "mesh_stiffness"):
        assert_allclose(getattr(back, name), getattr(soft, name), rtol=0.0)
    assert back.scene == soft.scene


def test_table_of_positions_has_misalignment_and_drive_stiffness(soft: MeshCycle) -> None:
    rows = list(csv.DictReader(positions_csv(soft).splitlines()))
    misalignment = np.array([float(row["misalignment_um"]) for row in rows]).reshape(soft.misalignment.shape)
    stiffness = np.array([float(row["drive_stiffness_N_per_mm_um"]) for row in rows]).reshape(misalignment.shape)
    assert_allclose(misalignment, soft.misalignment, rtol=1e-7)  # nine digits
    assert_allclose(stiffness, soft.drive_stiffness, rtol=1e-7)


def test_rigid_gears_have_no_motions(rigid: MeshCycle) -> None:
    with pytest.raises(NotAskedError, match="pinion_motion: the scene has no supports"):
        _ = rigid.pinion_motion


def test_misalignment_counts_as_mounting_errors_do() -> None:
    scene = scene_of("mesh_cycle_spur", **{"analysis.load_sharing": False})
    offset = np.zeros((6, 6))
    offset[1, 1], offset[3, 3], offset[1, 3], offset[3, 1] = 1e-6, 1e-9, 1e-8, 1e-8  # tilts about x by a force along y
    result = analyse(on(scene, None, offset))
    moved = scene.with_changes({"mounting.misalignment_um": float(result.misalignment[0, 0])})
    assert abs(result.misalignment[0, 0]) > 0.1
    in_both = [one.peak_axial[0, 0, 0] for one in (result, analyse(moved))]
    assert_allclose(in_both[0], in_both[1], atol=0.5)  # the side of the face that carries more


@pytest.mark.filterwarnings("default::loaded_tca.AccuracyWarning")
def test_motions_of_doubtful_size_are_warned_of() -> None:
    scene = scene_of("mesh_cycle_spur", **{"analysis.torques_Nm": [20.0]})
    with pytest.warns(
        AccuracyWarning, match=r"gears on their supports move by up to 0\.\d+ mm and tilt by up to 0 mrad"
    ):
        analyse(on(scene, np.diag([0.0, 1e-3] + [0.0] * 4), None))


def test_shaft_that_is_wound_up_is_no_soft_support() -> None:
    """By 10 mrad about the axis: the gears mesh as before, and errors of units show in tilts and ways."""
    scene = scene_of("mesh_cycle_spur", **{"analysis.torques_Nm": [20.0]})
    with noted_accuracy_warnings(given=False) as sentences:
        (motion,) = analyse(on(scene, np.diag([0.0] * 5 + [5e-7]), None)).pinion_motion[0]
    assert not any("on their supports" in one for one in sentences)
    # atol: mm and rad, 1e-10 of the rotation
    assert_allclose(np.abs(motion), [0.0] * 5 + [0.01], rtol=1e-3, atol=1e-12)


@pytest.mark.thorough
@pytest.mark.filterwarnings("default::loaded_tca.AccuracyWarning")
def test_forces_on_supports_that_do_not_balance_the_torque_are_warned_of() -> None:
    """Normals turn within the contact of a hypoid pair; forces have that of the contact point."""
    soft = np.diag([3e-6] * 3 + [1e-9] * 3)
    with pytest.warns(AccuracyWarning, match=r"moment about its axis that differs by 1\.[0-9]% from its torque"):
        analyse(on(scene_of("hypoid_13x42", **{"analysis.free_edges": False}), soft, None))
    spiral = analyse(on(scene_of("spiral_bevel", **{"analysis.torques_Nm": [0.8]}), soft, None))
    assert not any("more or less than its torque" in one for one in spiral.warnings)


@pytest.mark.parametrize("tilt", [1e-9, pytest.param(1e-7, marks=pytest.mark.thorough)])
def test_wide_gear_on_a_soft_tilt_settles(tilt: float) -> None:
    """Rigid analyses repeated swing for ever here: misalignment of the mounting is undone by that of the support."""
    changes = {
        "pair.normal_module_mm": 4.0,
        "pinion.teeth": 20,
        "wheel.teeth": 50,
        "pinion.face_width_mm": 80.0,
        "wheel.face_width_mm": 80.0,
        "mounting.misalignment_um": 13.0,
        "analysis.torques_Nm": [600.0],
    }
    scene = scene_of("mesh_cycle_spur", **changes)
    scene = scene.with_changes({f"{gear}.modifications": None for gear in ("pinion", "wheel")})
    result = analyse(on(scene, None, np.diag([0.0, 0.0, 0.0, tilt, tilt, 0.0])))
    left = 13.0 + result.misalignment[0, 0]
    assert 0.0 < left < 13.0
    assert left < 8.0 * (1e-9 / tilt) ** 0.8  # what is left turns the gear against its stiffness


@pytest.mark.thorough
def test_wide_helical_gear_on_a_soft_tilt_swings_into_line() -> None:
    """Pairs out of contact touch elsewhere than under a line load: a gear that tilts has no one compliance of both."""
    changes = {f"{gear}.face_width_mm": 60.0 for gear in ("pinion", "wheel")}
    changes |= {"pair.helix_angle_deg": 20.0, "mounting.misalignment_um": 200.0, "analysis.torques_Nm": [130.0]}
    scene = scene_of("mesh_cycle_helical", **changes, **{"analysis.positions": 2, "analysis.free_edges": False})
    left = []
    for tilt in (1e-8, 1e-7):
        result = analyse(on(scene, None, np.diag([1e-7, 1e-7, 1e-7, tilt, tilt, 1e-9])))
        assert_allclose(result.load_share.sum(axis=-1), 1.0, rtol=1e-9)
        left.append(200.0 + result.misalignment[0])
    assert (left[1] > 0.0).all()
    assert (left[1] < 0.2 * left[0]).all()


@pytest.mark.thorough
def test_pair_mirrored_in_its_face_moves_mirrored() -> None:
    scene, mirror = scene_of("helical"), np.array([1.0, 1.0, -1.0, -1.0, -1.0, 1.0])
    hands = {"pinion.hand": "left" if scene.hands[0] == "right" else "right", "wheel.hand": None}
    both = [matrix(4e-6, 3e-9, 1e-9, seed) for seed in (1, 2)]
    one = analyse(on(scene, *both))
    other = analyse(on(scene.with_changes(hands), *(np.outer(mirror, mirror) * matrix for matrix in both)))
    assert_allclose(other.transmission_error, one.transmission_error, rtol=1e-5)
    for name in ("pinion_motion", "wheel_motion"):
        moved, expected = getattr(other, name)[0, 0], mirror * getattr(one, name)[0, 0]
        assert_allclose(moved[:3], expected[:3], atol=1e-4 * np.abs(expected[:3]).max())
        assert_allclose(moved[3:], expected[3:], atol=1e-4 * np.abs(expected[3:]).max())
    assert_allclose(other.misalignment, -one.misalignment, rtol=1e-3)


@pytest.mark.thorough
def test_one_pair_alone_on_supports_agrees_with_shared_load_where_one_carries() -> None:
    scene = on(scene_of("mesh_cycle_spur"), matrix(1e-6, 1e-9, 1e-9, 1), None)
    alone = analyse(scene.with_changes({"analysis.load_sharing": False}))
    assert_allclose(alone.transmission_error, analyse(scene).transmission_error, rtol=1e-5)


def test_supports_that_give_way_too_far_are_told() -> None:
    scene = scene_of("mesh_cycle_spur", **{"analysis.torques_Nm": [20.0]})
    scene = on(scene, np.diag([0.05, 0.05, 0.0, 0.0, 0.0, 0.0]), None)
    with pytest.raises(GeometryError, match="under 20 N m the supports let the gears move too far"):
        analyse(scene)


@pytest.mark.thorough
def test_teeth_bend_beside_supports() -> None:
    bends = scene_of("mesh_cycle_spur", **{"analysis.compliance": "contact+tooth"})
    torsion = np.diag([0.0, 0.0, 0.0, 0.0, 0.0, 1e-9])
    result, held = analyse(on(bends, torsion, None)), analyse(bends)
    wind_up = 1e-9 * np.array(bends.torques)[:, None] * bends.pair().ratio
    assert_allclose(held.transmission_error - result.transmission_error, wind_up, rtol=2e-4)


@pytest.mark.thorough
def test_edges_are_those_of_the_gears_where_they_stand() -> None:
    """The pinion is pressed along its axis by more than a row of cells: contacts at an edge still name one."""
    scene = read_scene("examples/scenes/mesh_cycle_helical.toml").with_changes(
        {"analysis.positions": 3, "analysis.torques_Nm": [130.0], "analysis.compliance": "contact"}
    )
    soft = np.diag([1e-6, 1e-6, 5e-4, 1e-9, 1e-9, 1e-9])
    result = analyse(on(scene, soft, None))
    assert np.abs(result.pinion_motion[..., 2]).min() > 0.1  # mm
    assert result.on_edge.any()
    assert (reached_edges(result).any(axis=-1) == result.on_edge).all()
    on_supports, rigid = (one.tribology().slices() for one in (result, analyse(scene)))
    place, radius = (rigid.sort_values("pinion_radius")[name] for name in ("pinion_radius", "relative_radius"))
    within = on_supports["pinion_radius"].between(place.min(), place.max())
    expected = np.interp(on_supports["pinion_radius"], place, radius)
    # the same flanks: over a tooth the radius follows the involute; slices of different positions miss each other a bit
    assert_allclose(on_supports["relative_radius"][within], expected[within], rtol=0.02)
    assert within.mean() > 0.8
