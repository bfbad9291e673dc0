"""Rolling bearings that scenes ask for: keys, refusals, analyses against rigid ones repeated, files, pictures."""

from __future__ import annotations

import csv
import math
import re
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import MeshCycle, analyse, load_result, parse_scene, read_scene
from loaded_tca.arrays import Array
from loaded_tca.cli import main
from loaded_tca.errors import InputError, NotAskedError
from loaded_tca.loaded.shaft_lines import shaft_lines
from loaded_tca.loaded.tooth_contact import GridChoice
from loaded_tca.plots import plot_bearing_loads, plot_face_load_on_supports, plot_misalignment, result_figures
from loaded_tca.results.supports import element_forces
from loaded_tca.scene import Scene
from loaded_tca.separation.pair_change import number_at
from loaded_tca.studies import DesignModel
from loaded_tca.supports import BallBearing, RollerBearing, Support, shafts_of, supports_of
from validation.loaded.moved_gears import settled

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")  # contacts at edges: not the matter here
ROUNDING = 1e-12  # of forces that follow from motions as the result has them: the same operations

SCENE = "examples/scenes/helical_on_rolling_bearings.toml"
CELLS = 24
AGREES, MOTIONS_AGREE = 1e-4, 1e-3
"""Asked of the transmission error and of motions; rotations are balanced to 1e-5."""


@pytest.fixture(scope="module")
def scene() -> Scene:
    fixed = {"analysis.positions": 3, "analysis.cells": (CELLS, CELLS), "analysis.compliance": "contact"}
    return read_scene(SCENE).with_changes(fixed | {"analysis.torques_Nm": [40.0, 130.0]})


@pytest.fixture(scope="module")
def result(scene: Scene) -> MeshCycle:
    return analyse(scene)


def exact(support: Support, load: Array) -> Array:
    """Motion (6,) of the middle of the face under a load there, of the shaft in balance."""
    return support.at_middle(support.linear_near(load).moved(load))


@pytest.mark.thorough
@pytest.mark.parametrize(("torque", "position"), [(1, 1)])
def test_coupled_analysis_equals_rigid_ones_with_gears_moved_by_their_shafts(
    scene: Scene, result: MeshCycle, torque: int, position: int
) -> None:
    """The law of the bearings is exact there, and linear near the mean load of the pitch here."""
    grid = GridChoice((CELLS, CELLS), tolerance=scene.analysis.tolerance, free_edges=scene.analysis.free_edges)
    alone = scene.with_changes({"analysis.torques_Nm": [1e-3 * result.torque[torque]]})
    pinion, wheel = (partial(exact, support) for support in supports_of(alone))
    angle = float(result.pinion_angle[position])
    expected = settled(alone, (pinion, wheel), grid, change=1e-7, angle=angle)
    assert_allclose(result.transmission_error[torque, position], expected.transmission_error, rtol=AGREES)
    motions = np.stack([result.pinion_motion[torque, position], result.wheel_motion[torque, position]])
    largest = np.abs(expected.motions).reshape(2, 2, 3).max(axis=-1).repeat(3, axis=-1)
    assert (np.abs(motions - expected.motions) < MOTIONS_AGREE * largest).all()


@pytest.mark.thorough
def test_teeth_along_a_shaft_on_rolling_bearings_move_about_as_a_rigid_gear(scene: Scene, result: MeshCycle) -> None:
    along = analyse(scene.with_changes({"pinion.shaft.gear": "along", "analysis.torques_Nm": [130.0]}))
    assert_allclose(along.pinion_motion[0, :, :3], result.pinion_motion[1, :, :3], rtol=0.05)


@pytest.mark.thorough
def test_bevel_gears_on_rolling_bearings_equal_rigid_ones_moved() -> None:
    fixed = {"analysis.positions": 1, "analysis.cells": (CELLS, CELLS), "analysis.compliance": "contact"}
    bevel = read_scene("examples/scenes/straight_bevel.toml").with_changes(fixed)
    middle = bevel.face_middles[0]
    ball = {"type": "ball", "balls": 11, "ball_diameter_mm": 10.0, "pitch_diameter_mm": 60.0}
    shaft = {
        "start_mm": middle - 20.0,
        "torque_at_mm": middle + 160.0,
        "sections": [{"length_mm": 200.0, "outer_diameter_mm": 40.0}],
        "bearings": [
            {**ball, "at_mm": middle + 50.0, "contact_angle_deg": 25.0, "side": 1, "preload_um": 5.0},
            {**ball, "at_mm": middle + 130.0, "contact_angle_deg": 25.0, "side": -1, "preload_um": 5.0},
        ],
    }
    on_shaft = bevel.with_changes({"pinion.shaft": shaft, "pinion.bore_diameter_mm": 1.0})
    result = analyse(on_shaft)
    grid = GridChoice((CELLS, CELLS), tolerance=bevel.analysis.tolerance, free_edges=bevel.analysis.free_edges)
    expected = settled(on_shaft, (partial(exact, supports_of(on_shaft)[0]), np.zeros((6, 6))), grid, 0.7, 1e-7)
    assert_allclose(result.transmission_error[0, 0], expected.transmission_error, rtol=AGREES)
    largest = np.abs(expected.motions[0]).reshape(2, 3).max(axis=-1).repeat(3)
    assert (np.abs(result.pinion_motion[0, 0] - expected.motions[0]) < MOTIONS_AGREE * largest).all()


def test_forces_on_bearings_are_those_of_the_teeth(result: MeshCycle) -> None:
    on_pinion, on_wheel = (
        getattr(result, f"{gear}_bearing_force")[..., :3].sum(axis=2) for gear in ("pinion", "wheel")
    )
    largest = np.abs(on_pinion).max()
    assert_allclose(on_pinion, -on_wheel @ result.gear_pair.wheel_axes, atol=1e-6 * largest)


def test_picture_of_the_misalignment_has_the_means_of_the_summary(result: MeshCycle) -> None:
    """Both ends of the pitch are one place of the mesh: with them as two the mean was another."""
    axes = plot_misalignment(result).axes[0]
    assert_allclose(axes.lines[0].get_ydata(), [one["misalignment_mean_um"] for one in result.key_figures()])
    assert axes.get_ylabel().endswith("[µm]")


def test_misalignment_grows_less_than_the_torque(result: MeshCycle) -> None:
    """Clearances are gone through under the first torque already, and elements grow stiffer."""
    mean = np.abs(result.misalignment.mean(axis=1))
    assert mean[0] < mean[1] < 130.0 / 40.0 * mean[0]


def test_numbers_of_elements_follow_from_the_motions_of_bearings(scene: Scene, result: MeshCycle) -> None:
    shaft = shafts_of(scene)[0]
    assert shaft is not None
    for k, bearing in enumerate(shaft.bearings):
        assert isinstance(bearing, BallBearing | RollerBearing)
        motions = result.pinion_bearing_motion[1, :, k]
        forces = np.stack([bearing.element_forces(motion) for motion in motions])
        assert_allclose(result.pinion_element_force[1, :, k], forces.max(axis=1), rtol=ROUNDING)
        assert_allclose(element_forces(result, "pinion", 1)[k][1], forces, rtol=ROUNDING)
        reactions = np.stack([bearing.reaction(motion).force for motion in motions])
        size = np.abs(reactions).max()
        assert_allclose(result.pinion_bearing_force[1, :, k], reactions, atol=1e-3 * size)  # linear near the mean
    assert (result.pinion_bearing_life[0] > result.pinion_bearing_life[1]).all()
    assert (result.pinion_element_pressure[1] > result.pinion_element_pressure[0]).all()


def test_key_figures_and_summary_have_bearings(result: MeshCycle) -> None:
    figures = result.key_figures()[1]
    assert figures["pinion_element_force_N"] == result.pinion_element_force[1].max()
    assert figures["wheel_bearing_life_Mrev"] == result.wheel_bearing_life[1].min()
    assert_allclose(figures["misalignment_mean_um"], result.misalignment[1].mean(), rtol=0.05)
    summary = result.summary()
    for words in ("largest element force in bearings of pinion | wheel [N]", "shortest life [million revolutions]"):
        assert words in summary


def test_saved_result_has_all_of_it(result: MeshCycle, tmp_path: Path) -> None:
    result.save(tmp_path / "result.nc")
    back = load_result(tmp_path / "result.nc")
    for name in ("bearing_motion", "element_force", "element_pressure", "bearing_life"):
        assert_allclose(getattr(back, f"pinion_{name}"), getattr(result, f"pinion_{name}"), rtol=0.0)
    assert back.scene == result.scene
    assert back.key_figures()[0]["pinion_bearing_life_Mrev"] == result.key_figures()[0]["pinion_bearing_life_Mrev"]


@pytest.mark.thorough
def test_linear_bearings_have_no_elements(scene: Scene) -> None:
    linear = [
        {"at_mm": -60.0, "radial_stiffness_N_per_um": 400.0, "axial_stiffness_N_per_um": 150.0},
        {"at_mm": 60.0, "radial_stiffness_N_per_um": 400.0},
    ]
    changes = {"wheel.shaft.bearings": linear, "analysis.positions": 1, "analysis.torques_Nm": [40.0]}
    one = analyse(scene.with_changes(changes))
    with pytest.raises(NotAskedError, match="wheel_element_force: the gear has no rolling bearings"):
        _ = one.wheel_element_force
    assert "wheel_element_force_N" not in one.key_figures()[0]
    mixed = [linear[0], {**ball_table(), "at_mm": 60.0}]
    both = analyse(scene.with_changes(changes | {"wheel.shaft.bearings": mixed}))
    assert math.isnan(both.wheel_element_force[0, 0, 0])
    assert both.wheel_element_force[0, 0, 1] > 0.0


def test_gears_without_load_stay_in_the_middle(scene: Scene) -> None:
    idle = analyse(scene.with_changes({"analysis.torques_Nm": [0.0], "analysis.positions": 1, "wheel.shaft": None}))
    assert not idle.pinion_motion.any()
    assert_allclose(idle.transmission_error, idle.unloaded_transmission_error[None])
    assert (idle.pinion_bearing_life == math.inf).all()


@pytest.mark.thorough
def test_designs_have_the_stiffness_of_rolling_bearings_under_each_torque(scene: Scene) -> None:
    crowning = {"pinion.modifications.lead_crowning_um": (0.0, 10.0)}
    wanted = scene.with_changes({"analysis.positions": 5, "analysis.torques_Nm": [40.0, 130.0]})
    held = DesignModel(wanted, crowning, cells=(CELLS, CELLS)).evaluate([7.0])
    whole = analyse(wanted.with_changes({"pinion.modifications.lead_crowning_um": 7.0}))
    length = 1e3 * whole.wheel_base_radius
    # 1e-4 of the deflection: the bearings are those of the first design, whose load lies elsewhere
    assert_allclose(length * held.transmission_error[0], length * whole.transmission_error[:, :-1], atol=0.02, rtol=0.0)


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("key", "step"),
    [
        pytest.param("load.pinion_torque_Nm", 1.0, marks=pytest.mark.thorough),
        pytest.param("pinion.shaft.bearings.0.at_mm", 0.5, marks=pytest.mark.thorough),
        ("pinion.shaft.bearings.0.radial_clearance_um", 1.0),
        pytest.param("mounting.centre_distance_error_mm", 5e-3, marks=pytest.mark.thorough),
    ],
)
def test_derivatives_on_rolling_bearings_are_slopes_of_analyses(scene: Scene, key: str, step: float) -> None:
    torque = scene.torques[0] * 1e-3
    one = scene.with_changes({"analysis.positions": 3, "analysis.torques_Nm": [torque]})
    value = torque if key.startswith("load") else number_at(one, key)
    changes = [
        {key: value + by} if not key.startswith("load") else {"analysis.torques_Nm": [value + by]}
        for by in (-step, step)
    ]
    low, high = (analyse(one.with_changes(own)).transmission_error[0] for own in changes)
    expected = (high - low) / (2.0 * step)
    found = analyse(one).sensitivities([key]).transmission_error[0, :, 0]
    assert_allclose(found, expected, rtol=0.0, atol=0.02 * np.abs(expected).max())


def ball_table(**changes: Any) -> dict[str, Any]:
    return {"at_mm": -130.0, "type": "ball", "balls": 9, "ball_diameter_mm": 12.0, "pitch_diameter_mm": 60.0, **changes}


def roller_table(**changes: Any) -> dict[str, Any]:
    of_roller = {"rollers": 14, "roller_diameter_mm": 10.0, "roller_length_mm": 12.0, "pitch_diameter_mm": 60.0}
    return {"at_mm": -40.0, "type": "roller", **of_roller, **changes}


def test_scene_with_rolling_bearings_is_written_and_read(scene: Scene) -> None:
    assert parse_scene(scene.to_toml()) == scene
    varied = scene.with_changes({"pinion.shaft.bearings.1.radial_clearance_um": 30.0})
    assert varied.pinion.shaft is not None
    assert varied.pinion.shaft.bearings[1].radial_clearance_um == 30.0


def test_units_of_rolling_bearings_are_those_of_their_names(scene: Scene) -> None:
    ball = ball_table(
        contact_angle_deg=40.0, side=-1, preload_um=5.0, dynamic_load_rating_N=3e4, inner_groove_ratio=0.515
    )
    pinion, wheel = shafts_of(scene.with_changes({"pinion.shaft.bearings": [ball, roller_table()]}))
    assert pinion is not None and wheel is not None  # noqa: PT018
    first, second = pinion.bearings
    assert isinstance(first, BallBearing)
    assert isinstance(second, RollerBearing)
    assert (first.elements, first.diameter, first.pitch_diameter, first.side) == (9, 12.0, 60.0, -1)
    assert_allclose((first.contact_angle, first.preload, first.rating), (math.radians(40.0), 0.005, 3e4))
    assert (first.inner_groove, first.outer_groove) == (0.515, 0.53)
    assert (second.elements, second.length, second.clearance, second.contact_angle) == (14, 12.0, 0.0, 0.0)
    tapered = wheel.bearings[0]
    assert isinstance(tapered, RollerBearing)
    assert_allclose((tapered.contact_angle, tapered.preload, tapered.side), (math.radians(14.0), 0.005, -1))


@pytest.mark.parametrize(
    ("bearing", "message"),
    [
        ({"at_mm": 0.0, "type": "bal"}, 'table 0: type: found "bal"; allowed "ball" or "roller"; did you mean "ball"'),
        (
            {"at_mm": 0.0, "type": "ball", "balls": 9},
            'table 0: type: found "ball", without ball_diameter_mm, pitch_diameter_mm; it needs balls, ball',
        ),
        (
            ball_table(rollers=12, radial_stiffness_N_per_um=100.0),
            'type: found "ball", beside radial_stiffness_N_per_um, rollers; allowed with it balls, ball_diameter_mm',
        ),
        (
            {"at_mm": 0.0, "radial_stiffness_N_per_um": 100.0, "preload_um": 5.0},
            "type: not given, a linear bearing, beside preload_um; allowed with it stiffness, radial",
        ),
        (roller_table(roller_length_mm=0.0), "roller_length_mm: found 0.0; allowed a number above 0"),
        (ball_table(balls=2), "balls: found 2; allowed a whole number from 3 to 1000"),
        (ball_table(balls=20), "ball_diameter_mm: found 12; 20 elements on 60 mm would touch: allowed below 9.386"),
        (roller_table(rollers=30), "roller_diameter_mm: found 10; 30 elements on 60 mm would touch"),
        (ball_table(contact_angle_deg=15.0), "side: missing; a contact angle of 15 takes thrust one way"),
        (ball_table(preload_um=5.0), "side: missing; a preload presses the shaft along z with 1"),
        (ball_table(contact_angle_deg=50.0, side=1), "contact_angle_deg: found 50.0; allowed a number from 0 to 45"),
        (ball_table(contact_angle_deg=15.0, side=0), "side: found 0; allowed 1 or -1"),
        (roller_table(preload_um=5.0, side=1), "preload_um: found 5; cylindrical rollers have none along the axis"),
        (ball_table(inner_groove_ratio=0.5), "inner_groove_ratio: found 0.5; allowed a number above 0.5, up to 1"),
        (ball_table(dynamic_load_rating_N=0.0), "dynamic_load_rating_N: found 0.0; allowed a number above 0"),
    ],
)
def test_rolling_bearings_that_cannot_be_are_refused_as_they_are_read(
    scene: Scene, bearing: dict[str, Any], message: str
) -> None:
    with pytest.raises(InputError, match=message.replace("(", r"\(")):
        scene.with_changes({"pinion.shaft.bearings": [bearing, roller_table()]})


@pytest.mark.parametrize(
    ("bearings", "message"),
    [
        ([ball_table()], "pinion.shaft: bearings: 1 bearing leaves the shaft free about"),
        ([roller_table(), roller_table(at_mm=-130.0)], "pinion.shaft: bearings: .* free along its axis"),
        (
            [ball_table(contact_angle_deg=40.0, side=-1), roller_table()],
            "pinion.shaft: bearings: none takes the axial force of 659.8 N; allowed .* has side = 1",
        ),
        (
            [
                roller_table(at_mm=-130.0, contact_angle_deg=45.0, side=1),
                {"at_mm": -40.0, "radial_stiffness_N_per_um": 100.0},
            ],
            "pinion.shaft: bearings: no balance of the shaft on its rolling bearings",
        ),
    ],
)
def test_rolling_bearings_that_do_not_hold_are_refused_before_anything_is_solved(
    scene: Scene, bearings: list[dict[str, Any]], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        analyse(scene.with_changes({"pinion.shaft.bearings": bearings, "wheel.shaft": None}))


@pytest.mark.thorough
def test_command_shows_elements_pressures_and_lives(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["shaft", SCENE, "--out", str(tmp_path / "out")]) == 0
    line = shaft_lines(read_scene(SCENE))[0]
    bearing = line.shaft.bearings[0]
    assert isinstance(bearing, BallBearing)
    force = bearing.element_forces(line.bearing_motions[0]).max()
    out = capsys.readouterr().out
    assert f"largest element force {force:.1f} N, pressure" in out
    assert not re.search(r"\de[+-]\d", out)  # lives, too, as a person writes them
    rows = list(csv.DictReader((tmp_path / "out" / "bearings.csv").read_text().splitlines()))
    assert_allclose(float(rows[0]["element_force_N"]), force)
    assert_allclose(float(rows[0]["life_Mrev"]), bearing.life(line.bearing_motions[0]))


def test_overview_has_forces_and_lives_of_bearings(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", SCENE]) == 0
    lines = {line[:44].strip(): line[44:].split() for line in capsys.readouterr().out.splitlines()}
    first = shaft_lines(read_scene(SCENE))[:3]
    forces = [f"{np.linalg.norm(line.bearing_forces[0, :3]):.1f}" for line in first]
    assert lines["pinion, bearing 0 at -130 mm: force [N]"] == forces
    assert "wheel, bearing 1 at 60 mm: force [N]" in lines
    assert len(lines["life [million revolutions]"]) == 3


def test_overview_refuses_bearings_that_do_not_hold(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = read_scene(SCENE).with_changes({"pinion.shaft.bearings": [ball_table()]})
    (tmp_path / "scene.toml").write_text(scene.to_toml())
    assert main(["check", str(tmp_path / "scene.toml")]) == 2
    assert "pinion.shaft: bearings: 1 bearing leaves the shaft free about" in capsys.readouterr().err


@pytest.mark.thorough
def test_pictures_of_supports_are_among_those_of_the_result(result: MeshCycle) -> None:
    figures = result_figures(result)
    assert {"misalignment", "bearing_loads", "shaft"} <= set(figures)
    rings = figures["bearing_loads"].axes
    assert len(rings) == 4
    bars = [patch.get_height() for patch in rings[0].patches[:9]]
    assert_allclose(bars, element_forces(result, "pinion", 1)[0][1].mean(axis=0))
    assert len(figures["shaft"].axes) == 6


def test_load_over_the_face_is_drawn_beside_that_of_rigid_supports(scene: Scene, result: MeshCycle) -> None:
    rigid = analyse(scene.with_changes({"pinion.shaft": None, "wheel.shaft": None}))
    axes = plot_face_load_on_supports(result, rigid).axes[0]
    labels = axes.get_legend_handles_labels()[1]
    for label, one in zip(labels, (result, rigid), strict=True):
        assert f"K_Hβ = {one.face_load_factor[1]:.3g}" in label
    other = analyse(rigid.scene.with_changes({"analysis.torques_Nm": [40.0], "analysis.positions": 1}))
    with pytest.raises(InputError) as refused:
        plot_face_load_on_supports(result, other)
    assert [problem[:20] for problem in refused.value.problems] == ["rigid: other torques", "face load: a mean ov"]


@pytest.mark.thorough
def test_pictures_of_what_a_result_lacks_are_refused(scene: Scene) -> None:
    support = {"pinion.support.compliance": np.diag([1e-6] * 3 + [0.0] * 3).tolist()}
    rigid = scene.with_changes({"pinion.shaft": None, "wheel.shaft": None, "analysis.positions": 1})
    one = analyse(rigid.with_changes(support | {"analysis.torques_Nm": [40.0]}))
    assert "misalignment" not in result_figures(one)
    with pytest.raises(InputError, match="bearing loads: no rolling bearings in this result"):
        plot_bearing_loads(one)
    bevel = read_scene("examples/scenes/straight_bevel.toml")
    changes = support | {"analysis.positions": 1, "analysis.cells": (24, 24), "analysis.compliance": "contact"}
    with pytest.raises(InputError, match="misalignment: none in this result: bevel gears"):
        plot_misalignment(analyse(bevel.with_changes(changes)))
