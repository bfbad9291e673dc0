"""Shafts that scenes ask for: keys, files, refusals, analyses."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import MeshCycle, analyse, load_result, parse_scene, read_scene
from loaded_tca.errors import InputError, NotAskedError
from loaded_tca.loaded.moved_gears import given_motions
from loaded_tca.results.supports import _of_rolling_bearings, _wind_up
from loaded_tca.scene import Scene
from loaded_tca.scene.section import key_at
from loaded_tca.supports import BallBearing, Support, moved_pair, shafts_of, supports_of
from loaded_tca.unloaded import trace_teeth
from loaded_tca.warning_kinds import BODY_TWIST, THIN_RIM, Kind

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")  # contacts at edges: not the matter here
ROUNDING = 1e-12  # mm, rad or parts of a unit vector; lengths of 100 mm, a few rotations


@pytest.fixture(scope="module")
def scene() -> Scene:
    fixed = {"analysis.positions": 3, "analysis.cells": (24, 24), "analysis.compliance": "contact"}
    return read_scene("examples/scenes/helical_on_shafts.toml").with_changes(fixed | {"analysis.torques_Nm": None})


@pytest.fixture(scope="module")
def result(scene: Scene) -> MeshCycle:
    return analyse(scene)


def test_scene_with_shafts_is_written_and_read(scene: Scene) -> None:
    assert parse_scene(scene.to_toml()) == scene


def test_keys_of_bearings_are_varied_by_their_places(scene: Scene) -> None:
    key = "pinion.shaft.bearings.1.radial_stiffness_N_per_um"
    changed = scene.with_changes({key: 100.0})
    assert changed.pinion.shaft is not None
    assert [one.radial_stiffness_N_per_um for one in changed.pinion.shaft.bearings] == [250.0, 100.0]
    assert key_at(type(scene), key).default is None
    softer, before = (supports_of(one)[0].compliance[0, 0] for one in (changed, scene))
    assert softer > before
    with pytest.raises(InputError, match=r"pinion.shaft.bearings.first: not a place in a list"):
        key_at(type(scene), "pinion.shaft.bearings.first.at_mm")
    with pytest.raises(InputError, match=r"pinion.shaft.bearings.0: a table"):
        key_at(type(scene), "pinion.shaft.bearings.0")


def test_units_of_bearings_are_those_of_their_names(scene: Scene) -> None:
    pinion, wheel = shafts_of(scene)
    assert pinion is not None and wheel is not None  # noqa: PT018
    assert_allclose(pinion.bearings[0].stiffness.diagonal(), [2.5e5, 2.5e5, 1.5e5, 0.0, 0.0, 0.0])
    assert_allclose(pinion.bearings[1].stiffness.diagonal(), [4e5, 4e5, 0.0, 2e6, 2e6, 0.0])
    assert (pinion.start, pinion.end, wheel.sections[0].inner_diameter) == (-180.0, 20.0, 20.0)
    other = {"at_mm": -90.0, "force_N": [10.0, 20.0, 30.0], "moment_Nm": [1.0, 2.0, 3.0]}
    loaded, _ = shafts_of(scene.with_changes({"pinion.shaft.loads": [other]}))
    assert loaded is not None
    assert_allclose(loaded.loads[0].load, [10.0, 20.0, 30.0, 1e3, 2e3, 3e3])


@pytest.mark.thorough
def test_forces_on_bearings_are_those_of_the_teeth(result: MeshCycle) -> None:
    on_pinion, on_wheel = (
        getattr(result, f"{gear}_bearing_force")[..., :3].sum(axis=2) for gear in ("pinion", "wheel")
    )
    assert result.pinion_bearing_force.shape == (1, 3, 2, 6)
    fixed = on_wheel @ result.gear_pair.wheel_axes
    assert_allclose(on_pinion, -fixed, rtol=1e-6)
    mesh = result.scene.mesh()
    tangential = result.torque[:, None] / mesh.pinion_working_radius
    assert_allclose(on_pinion[..., 1], -np.broadcast_to(tangential, on_pinion.shape[:2]), rtol=2e-3)


@pytest.mark.thorough
def test_soft_bearing_beside_the_gear_makes_misalignment(scene: Scene, result: MeshCycle) -> None:
    soft = analyse(scene.with_changes({"pinion.shaft.bearings.1.radial_stiffness_N_per_um": 40.0}))
    assert (np.abs(soft.misalignment) > 1.5 * np.abs(result.misalignment)).all()


@pytest.mark.thorough
def test_teeth_along_a_shaft_twist_with_it(scene: Scene, result: MeshCycle) -> None:
    along = analyse(scene.with_changes({"pinion.shaft.gear": "along"}))
    assert_allclose(along.pinion_motion[..., :3], result.pinion_motion[..., :3], rtol=0.05)
    assert not np.array_equal(along.transmission_error, result.transmission_error)
    stiff = scene.with_changes(
        {"pinion.shaft.sections": [{"length_mm": 200.0, "outer_diameter_mm": 400.0}], "wheel.shaft": None}
    )
    thick = [analyse(stiff.with_changes({"pinion.shaft.gear": one})) for one in ("rigid", "along")]
    assert_allclose(thick[0].transmission_error, thick[1].transmission_error, rtol=1e-3)


def test_saved_result_has_bearing_forces(result: MeshCycle, tmp_path: Any) -> None:
    result.save(tmp_path / "result.nc")
    assert_allclose(load_result(tmp_path / "result.nc").wheel_bearing_force, result.wheel_bearing_force, rtol=0.0)


@pytest.mark.thorough
def test_other_loads_move_the_unloaded_gears(scene: Scene) -> None:
    load = {"at_mm": -90.0, "force_N": [0.0, 2000.0, 0.0]}
    loaded = scene.with_changes({"pinion.shaft.loads": [load], "wheel.shaft": None})
    support, wheel = supports_of(loaded)
    pair = moved_pair(loaded.pair(), (support, wheel), [support.at_middle(support.moved(np.zeros(6))), np.zeros(6)])
    expected = trace_teeth(pair, np.linspace(-0.5, 0.5, 3) * pair.pitch)
    result = analyse(loaded)
    assert_allclose(result.unloaded_transmission_error, expected.transmission_error, rtol=1e-9, atol=ROUNDING)


def test_motion_of_the_wheel_is_a_mounting_error(scene: Scene) -> None:
    rigid = Support(0.0, np.zeros((6, 6)))
    pair, angle = scene.pair(), 1e-4
    axes = pair.wheel_axes
    errors = {
        "mounting.centre_distance_error_mm": ([0.05, 0.0, 0.0], [0.0, 0.0, 0.0], 0.05),
        "mounting.axial_offset_mm": ([0.0, 0.0, 0.02], [0.0, 0.0, 0.0], 0.02),
        "mounting.out_of_plane_deg": ([0.0, 0.0, 0.0], [angle, 0.0, 0.0], np.degrees(angle)),
        "mounting.in_plane_deg": ([0.0, 0.0, 0.0], [0.0, angle, 0.0], np.degrees(angle)),
    }
    for key, (shift, turn, value) in errors.items():
        moved = moved_pair(pair, (rigid, rigid), [np.zeros(6), np.concatenate([axes @ shift, axes @ turn])])
        mounted = scene.with_changes({key: float(value)}).pair()
        assert_allclose(moved.wheel_origin, mounted.wheel_origin, atol=ROUNDING)
        assert_allclose(moved.wheel_axes, mounted.wheel_axes, atol=ROUNDING)


def test_gear_without_a_shaft_has_no_bearings(scene: Scene) -> None:
    one = analyse(scene.with_changes({"wheel.shaft": None, "analysis.positions": 1}))
    with pytest.raises(NotAskedError, match="wheel_bearing_force: the gear has no shaft"):
        _ = one.wheel_bearing_force


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"pinion.shaft.bearings": []}, "pinion.shaft.bearings: found .*; allowed a list of 1 to 200 tables of at_mm"),
        (
            {"pinion.shaft.bearings": [{"at_mm": 0.0}]},
            "pinion.shaft.bearings: table 0: stiffness: missing; give one of stiffness and radial_stiffness_N_per_um",
        ),
        (
            {"pinion.shaft.bearings.0.radial_stiffness_N_per_um": -1.0},
            "pinion.shaft.bearings: table 0: radial_stiffness_N_per_um: found -1",
        ),
        (
            {"pinion.shaft.bearings.0.radial_stiffness_N_per_um": 1e17},
            r"table 0: radial_stiffness_N_per_um: found 1e\+17; allowed a number from 0 to 1e9",
        ),
        (
            {"wheel.shaft.sections.0.inner_diameter_mm": 60.0},
            "wheel.shaft.sections: table 0: inner_diameter_mm: found 60; allowed below outer_diameter_mm = 60",
        ),
        ({"pinion.shaft.sections": [3]}, "pinion.shaft.sections: table 0: found 3; allowed a table of length_mm"),
        ({"pinion.support.compliance": [[0.0] * 6] * 6}, r"pinion.support: found beside \[pinion.shaft\]"),
        (
            {"pinion.bore_diameter_mm": 0.0, "analysis.compliance": "contact+tooth"},
            r"pinion.bore_diameter_mm: found 0, a solid gear, whose torsion \[pinion.shaft\] has, too; allowed the "
            "diameter of its seat, or none$",
        ),
    ],
)
def test_shafts_that_cannot_be_are_refused_as_they_are_read(
    scene: Scene, changes: dict[str, Any], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        scene.with_changes(changes)


@pytest.mark.parametrize("known", [BODY_TWIST, THIN_RIM], ids=["body twist", "thin rim"])
def test_bores_that_a_warning_advises_are_those_that_a_scene_takes(scene: Scene, known: Kind) -> None:
    assert "`bore_diameter_mm = 0`; beside a `[pinion.shaft]`" in known.advice
    bending = scene.with_changes({"analysis.compliance": "contact+tooth", "pinion.bore_diameter_mm": None})
    assert bending.with_changes({"pinion.shaft": None, "pinion.bore_diameter_mm": 0.0}).pinion.bore_diameter_mm == 0.0


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"pinion.shaft.start_mm": 10.0, "pinion.bore_diameter_mm": None},
            "pinion.shaft: torque_at: at -180 mm, beside the shaft",
        ),
        (
            {"pinion.bore_diameter_mm": 46.0},
            r"pinion.bore_diameter_mm: found 46; allowed up to 45, outer_diameter_mm of \[\[pinion.shaft.sections\]\] "
            "under the face",
        ),
        ({"pinion.shaft.bearings.0.axial_stiffness_N_per_um": 0.0}, "pinion.shaft: .* free along its axis"),
        ({"wheel.shaft.bearings.1.at_mm": -60.0}, "wheel.shaft: .* free about"),
        ({"wheel.shaft.sections.0.length_mm": 75.0, "wheel.shaft.torque_at_mm": -60.0}, "wheel.shaft: bearings: at 60"),
    ],
)
def test_shafts_that_are_not_held_are_refused_before_anything_is_solved(
    scene: Scene, changes: dict[str, Any], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        analyse(scene.with_changes(changes))


def test_teeth_along_a_shaft_are_refused_for_bevel_gears() -> None:
    bevel = read_scene("examples/scenes/straight_bevel.toml")
    shaft = {
        "start_mm": 0.0,
        "torque_at_mm": 0.0,
        "gear": "along",
        "sections": [{"length_mm": 200.0, "outer_diameter_mm": 30.0}],
        "bearings": [
            {"at_mm": 5.0, "radial_stiffness_N_per_um": 100.0, "axial_stiffness_N_per_um": 100.0},
            {"at_mm": 190.0, "radial_stiffness_N_per_um": 100.0},
        ],
    }
    with pytest.raises(InputError, match=r'pinion.shaft.gear: found "along"; allowed "rigid" for bevel gears'):
        supports_of(bevel.with_changes({"pinion.shaft": shaft}))


def test_wind_up_is_that_of_the_torque_alone() -> None:
    """Gears that stand turned without it, by other loads on their shafts, are not wound up by that."""
    rest, parts = np.array([0.1, 0.0, 0.0, 0.0, 0.0, 3e-3]), (2e-9, 1e-9)
    supports = [SimpleNamespace(moved=lambda load, part=part: rest + part * load, at_rest=rest) for part in parts]
    loads = tuple(np.array([[0.0, 0.0, 0.0, 0.0, 0.0, torque]]) for torque in (-40e3, 100e3))
    one = SimpleNamespace(loads=loads, standing=SimpleNamespace(supports=SimpleNamespace(supports=supports)))
    assert_allclose(_wind_up(one), 2e-9 * 40e3**2 / 100e3 + 1e-9 * 100e3)  # type: ignore[arg-type]


def test_life_of_a_bearing_is_that_under_its_mean_motion_of_the_loaded_positions() -> None:
    ball = BallBearing(at=0.0, elements=7, diameter=11.5, pitch_diameter=43.5)
    motions = np.array([[0.01, 0.0, 0.0, 0.0, 0.0, 0.0], [0.03, 0.0, 0.01, 0.0, 0.0, 0.0], [np.nan] * 6])
    own = SimpleNamespace(bearings=[ball], bearing_motions=lambda load: motions[[int(load[0])]])
    none = SimpleNamespace(bearings=[])
    one = SimpleNamespace(
        loads=(np.arange(3.0)[:, None], np.zeros((3, 1))),
        standing=SimpleNamespace(supports=SimpleNamespace(supports=[own, none])),
    )
    arrays = _of_rolling_bearings([one])  # type: ignore[list-item]
    assert_allclose(arrays["pinion_bearing_life"], ball.life(np.array([0.02, 0.0, 0.005, 0.0, 0.0, 0.0])))


def test_teeth_that_move_with_the_body_of_their_gear_are_displaced_by_nothing_else() -> None:
    """What is given is the motion of the support beyond that of the body; of linear ones the body stands too far."""
    body = np.array([1e-3, -2e-3, 0.0, 1e-5, 0.0, 0.0])
    supports = SimpleNamespace(
        supports=[SimpleNamespace(with_middle=lambda motion: motion, motion=motion) for motion in (body, None)],
        bodies=lambda _: (body, body),
    )
    followed, linear = given_motions(supports, (body, body))  # type: ignore[arg-type]
    assert not followed.any()
    assert_allclose(linear, -body)
