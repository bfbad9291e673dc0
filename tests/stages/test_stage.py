"""Stages: files and their refusals, shares and orders, saved and read again."""

import math
import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.gears.internal_mesh import internal_interferences
from loaded_tca.results.summary import shown
from loaded_tca.scene import InternalScene
from loaded_tca.stages import StageResult, analyse_stage, parse_stage, read_stage, rebalanced
from loaded_tca.stages.analyse import _largest_loads, deflections_of, states_of
from loaded_tca.threads import with_jobs
from tests.refusals import refused_calls
from tests.samples.declared import assert_comes_back, assert_declared, with_more_numbers
from tests.samples.root_stress import coarsely

EXAMPLES = Path(__file__).parents[2] / "examples" / "stages"
QUICK = {
    "analysis.compliance": "contact",
    "analysis.free_edges": False,
    "analysis.cells": [8, 10],
    "analysis.accuracy": None,
}
TEXT = (EXAMPLES / "helical_automotive.toml").read_text(encoding="utf-8")

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")


@pytest.fixture(scope="module")
def stage():
    changes = {**QUICK, "stage.pin_tangential_um": None, "analysis.positions": 7, "analysis.torques_Nm": [100.0, 300.0]}
    return parse_stage(TEXT).with_changes(changes)


@pytest.fixture(scope="module")
def result(stage):
    return analyse_stage(stage)


@pytest.mark.thorough
def test_result_is_the_same_by_two_jobs_of_which_one_has_a_process_of_its_own(monkeypatch, stage, result):
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1}, raising=False)
    shown = []
    with with_jobs(2):
        other = analyse_stage(stage, lambda *states: shown.append(states))
    for name in ("sun_mesh", "ring_mesh"):
        for number, values in getattr(result, name).dataset.items():
            assert_array_equal(getattr(other, name).dataset[number], values)  # exact: the same operations
    assert_array_equal(other.dataset["planet_share"], result.dataset["planet_share"])
    assert other.dataset.attrs["warnings"] == result.dataset.attrs["warnings"]
    states = states_of(stage)
    assert shown == sorted(shown)
    assert shown[-1] == (states, states)


def changed(**keys):
    return parse_stage(TEXT).with_changes({name.replace("__", "."): value for name, value in keys.items()})


def test_another_file_takes_the_place_of_the_points_of_a_planet():
    points = EXAMPLES.parent / "scenes" / "measured_flank.csv"
    measured = changed(planet__flank={"form": "measured", "file": str(points)})
    assert measured.planet.flank.measurement.source == "measured_flank.csv"
    assert measured.with_changes({"planet.flank.file": str(points)}) == measured


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem)
def test_example_is_sound_and_written_back(path):
    stage = read_stage(path)
    assert stage.title
    assert parse_stage(stage.to_toml()) == stage
    stage.require_assembly()
    assert list(stage.sun_scene.interferences()) == []
    assert list(stage.ring_scene.interferences()) == []


def test_scenes_of_both_meshes_have_the_flanks_of_the_stage(stage):
    assert isinstance(stage.ring_scene, InternalScene)
    assert stage.sun_scene.hands == ("right", "left")
    assert stage.ring_scene.hands == ("left", "left")
    assert_allclose(stage.sun_scene.mesh().working_centre_distance, stage.ring_scene.mesh().working_centre_distance)
    sides = stage.sun_scene.pair().wheel.flank.side, stage.ring_scene.pair().pinion.flank.side
    assert sides[0] == -sides[1]  # a planet presses sun and ring with opposite flanks
    forces = [scene.torques[0] / scene.pair().base_radii[0] for scene in (stage.sun_scene, stage.ring_scene)]
    assert_allclose(forces[0], forces[1])


def test_scope_says_at_which_positions_meshes_and_shares_are(result):
    """Four planets: of the six steps between seven positions, shares take the next multiple of four."""
    assert "meshes at 7 positions of a pitch, both ends among them; shares at 8 even positions" in result.scope
    assert result.planet_share.shape[1] == 8


def test_shares_add_up_and_orders_of_equal_planets_cancel(result):
    assert_allclose(result.planet_share.sum(axis=-1), 1.0, rtol=1e-9)
    assert result.neutralised_orders == (1, 3, 5)
    orders = result.orders()
    largest = max(one.one_path for one in orders)
    for one in orders:
        if one.torsion_cancels:
            assert one.stage < 1e-6 * largest
    assert_allclose(result.mesh_load_factor, len(result.planet) * result.planet_share.max(axis=(1, 2)))


def test_stage_in_phase_has_the_ripple_of_one_path():
    stage = read_stage(EXAMPLES / "wind_spur.toml").with_changes(
        {**QUICK, "stage.pin_tangential_um": None, "analysis.positions": 7, "analysis.torques_Nm": [100e3]}
    )
    result = analyse_stage(stage)
    assert_allclose(np.ptp(result.error_um(0)), np.ptp(result.error_um(0, one_path=True)), rtol=1e-6)
    assert (result.transmission_error > 0.0).all()  # the carrier drives, and load makes it lead
    assert result.neutralised_orders == ()


def test_factor_falls_with_torque_and_rises_with_the_pin_error(result):
    small, large = (rebalanced(result, {"stage.pin_tangential_um": [amount, 0.0, 0.0, 0.0]}) for amount in (2.0, 5.0))
    assert small.mesh_load_factor[1] < small.mesh_load_factor[0]
    assert (small.mesh_load_factor < large.mesh_load_factor).all()
    assert_array_equal(rebalanced(result, {}).planet_share, result.planet_share)  # the same balance


def test_planet_whose_pin_is_far_off_is_slack(result):
    slack = rebalanced(result, {"stage.pin_tangential_um": [500.0, 0.0, 0.0, 0.0], "stage.floating_sun": False})
    assert (slack.planet_share[..., 0] == 0.0).all()
    assert not slack.sun_motion.any()
    assert slack.findings()[0].startswith("under 100 N m planet 0 carries no load at any position")
    assert "note: under 300 N m planet 0 carries no load" in slack.summary()
    assert result.findings() == ()


def test_warnings_are_of_loads_up_to_the_largest_share_of_a_planet(result):
    """An even share of four is 75 N m, and 120 N m the next force of the meshes; two slack planets leave 150."""
    slack = rebalanced(result, {"stage.pin_tangential_um": [500.0, 0.0, 500.0, 0.0], "stage.floating_sun": False})
    assert slack.planet_share.max() > 0.4 > 0.27 > result.planet_share.max()
    for one, largest in ((result, 120.5), (slack, 300.5)):
        cycle = one.sun_mesh
        torques = 1e-3 * cycle.torque
        solved = sum(
            contact is not None
            for torque, rows in zip(torques, cycle.maps, strict=True)
            if torque < largest
            for row in rows
            for contact in row
        )
        sentences = [
            sentence for sentence in one.warnings if sentence.startswith("sun (pinion)") and " (at " in sentence
        ]
        assert sentences
        whose = f"N m: the sun's torque on one planet, up to {300.0 * one.planet_share[1].max():.4g})"
        for sentence in sentences:
            assert f" of {solved} pressure maps" in sentence
            assert sentence.endswith(whose)


def test_edge_pressure_is_that_of_the_mesh_under_the_largest_share(result):
    """Even shares of 75 N m are a torque of the mesh cycles themselves."""
    for name, cycle in (("sun_mesh", result.sun_mesh), ("ring_mesh", result.ring_mesh)):
        own = result.key_figures()[1][f"{name}_edge_pressure_MPa"]
        torque = 75e3 if name == "sun_mesh" else 50e3
        at = int(np.argmin(np.abs(cycle.torque - torque)))
        below, above = (np.nanmax(cycle.edge_pressure[k], initial=0.0) for k in (at, at + 1))
        assert 0.0 < below <= own < above  # the largest share is up to 1.05 even ones
    line = next(line for line in result.summary().splitlines() if "at a sharp edge of any pair, mesh-dependent" in line)
    assert line.split()[-1] == shown(result.key_figures()[1]["sun_mesh_edge_pressure_MPa"], "")


def test_peak_pressure_is_that_of_the_mesh_under_the_largest_share_of_unequal_ones(result):
    """Two slack planets leave half of 300 N m to each of the others; 75 N m are an even share."""
    slack = rebalanced(result, {"stage.pin_tangential_um": [500.0, 0.0, 500.0, 0.0], "stage.floating_sun": False})
    cycle = slack.sun_mesh
    above = int(np.searchsorted(cycle.torque, 300e3 * slack.planet_share[1].max()))
    assert cycle.torque[above - 1] > 75e3
    low, high = (np.nanmax(cycle.peak_pressure[k]) for k in (above - 1, above))
    assert low < slack.key_figures()[1]["sun_mesh_peak_pressure_MPa"] <= high


def test_phases_of_mesh_cycles_count_from_the_pitch_point(result):
    """Which lies in the middle of the pitch that was analysed."""
    for cycle in (result.sun_mesh, result.ring_mesh):
        assert deflections_of(cycle, np.array(cycle.torque)).start == pytest.approx(-0.5)


def test_planet_has_the_torque_of_its_own_radius_under_the_force_of_the_sun(result):
    arrays = {name: result.dataset[name].values for name in ("planet_share", "torque")}
    force, (of_sun, of_planet) = _largest_loads(result.stage, arrays)
    assert of_sun == pytest.approx(force * float(result.dataset["sun_base_radius"]))
    assert of_planet / of_sun == pytest.approx(result.stage.planet.teeth / result.stage.sun.teeth)


def test_amplitude_of_an_order_is_that_of_its_wave(result):
    error, radius = result.dataset["one_path_transmission_error"], float(result.dataset["sun_base_radius"])
    wave = 1e-6 * np.cos(4.0 * np.pi * np.arange(error.shape[-1]) / error.shape[-1])
    waves = {"one_path_transmission_error": (error.dims, np.broadcast_to(wave, error.shape))}
    first, second, *_ = replace(result, dataset=result.dataset.assign(waves)).orders()
    assert second.one_path == pytest.approx(1e-3 * radius)
    assert first.one_path == pytest.approx(0.0, abs=1e-9 * radius)


def test_result_of_a_file_without_edge_pressures_is_read(result, tmp_path):
    result.save(tmp_path)
    older = replace(
        result, dataset=result.dataset.drop_vars([f"{mesh}_mesh_edge_pressure" for mesh in ("sun", "ring")])
    )
    older.save(tmp_path)
    again = StageResult.load(tmp_path)
    assert "edge" not in again.summary().split("warning:")[0]
    assert math.isnan(again.key_figures()[0]["sun_mesh_edge_pressure_MPa"])


def test_orders_that_pins_bring_back_are_not_said_to_be_cancelled(result):
    moved = rebalanced(result, {"stage.pin_tangential_um": [5.0, 0.0, 0.0, 0.0]})
    (first,) = (line for line in moved.summary().splitlines() if line.startswith("  1, "))
    assert "cancels between equal planets" in first
    assert moved.orders()[0].stage > 1e-3  # um


def test_pins_that_turn_the_carrier_together_change_no_share(result):
    turned = rebalanced(result, {"stage.pin_tangential_um": [20.0] * 4})
    assert_allclose(turned.planet_share, result.planet_share, atol=1e-7)
    lag = turned.transmission_error - result.transmission_error
    angles = [scene.mesh().working_pressure_angle for scene in (result.stage.sun_scene, result.stage.ring_scene)]
    expected = 0.02 * sum(map(math.cos, angles)) / float(result.dataset["sun_base_radius"])
    assert_allclose(lag, -expected, rtol=1e-6)


def test_result_is_saved_and_read_again(result, tmp_path):
    files = result.save(tmp_path)
    assert [path.name for path in files] == ["stage.nc", "sun_mesh.nc", "ring_mesh.nc"]
    again = StageResult.load(tmp_path)
    assert again.dataset.equals(result.dataset)
    assert again.stage == result.stage
    assert_allclose(again.ring_mesh.transmission_error, result.ring_mesh.transmission_error)
    (tmp_path / "stage.nc").write_bytes((tmp_path / "sun_mesh.nc").read_bytes())
    with pytest.raises(InputError, match="not the result of a stage"):
        StageResult.load(tmp_path)


def test_table_and_summary_have_every_torque(result):
    table = result.to_table()
    assert len(table["sun_angle_deg"]) == 2 * result.dataset.sizes["position"]
    assert_allclose(sum(np.array(table[f"planet_{i}_share"]) for i in range(4)), 1.0)
    assert "orders that equal planets cancel" in result.summary()
    assert "1, 3, 5" in result.summary()
    assert repr(result) == "StageResult(4 planets, 2 torques, 8 positions)"
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = result.nothing


@pytest.mark.thorough
def test_root_stress_under_the_largest_share_is_known_where_it_is_asked_for(stage, result):
    assert "sun_root_tension" not in result.dataset
    with coarsely():
        changes = {"analysis.positions": 5, "analysis.torques_Nm": [100.0], "analysis.root_stress": True}
        asked = analyse_stage(stage.with_changes(changes))
    for name in ("sun_root_tension", "planet_root_tension_at_sun", "planet_root_tension_at_ring", "ring_root_tension"):
        assert 10.0 < getattr(asked, name)[0] < 2000.0  # MPa
        assert f"{name}_MPa" in asked.key_figures()[0]


test_bad_stages_are_refused = refused_calls(
    (lambda: changed(stage__planets=None), "stage.planets: missing; give it or planet_angles_deg"),
    (lambda: changed(stage__planet_angles_deg=[0.0, 90.0]), "planets: found 4 beside planet_angles_deg"),
    (lambda: changed(stage__pin_radial_um=[1.0, 2.0]), "pin_radial_um: found 2 values; allowed 4, one for each planet"),
    (lambda: changed(stage__sun_support_stiffness_N_per_um=-1.0), "sun_support_stiffness_N_per_um: found -1"),
    (lambda: changed(stage__sun_support_stiffness_N_per_um=5.0), "found 5 beside floating_sun = true"),
    (lambda: changed(stage__planets=1, stage__pin_tangential_um=None), "found a floating sun with one planet"),
    (lambda: changed(stage__type="wolfrom"), "stage.type: found"),
    (lambda: changed(stage__driving="ring"), "stage.driving: found"),
    (lambda: changed(planet__hand="left"), "planet.hand: found"),
    (lambda: changed(ring__teeth=70), "ring.teeth: found 70"),
    (lambda: changed(analysis__positions=3), "analysis.positions: found 3; allowed from 5 on"),
    (lambda: changed(analysis__load_sharing=False), "analysis.load_sharing: found false"),
    (lambda: changed(load__sun_torque_Nm=-1.0), "load.sun_torque_Nm: found -1"),
    (lambda: parse_stage('[pair]\ntype = "cylindrical"\n[pinion]\nteeth = 3'), "not a stage but the scene of a pair"),
    (lambda: analyse_stage(changed(analysis__torques_Nm=[0.0])), "found 0; allowed above 0: a stage shares a torque"),
)

test_stages_that_cannot_be_are_refused = refused_calls(
    (lambda: changed(ring__teeth=-71).sun_scene, "have the centre distance 40.1997 mm, planet and ring"),
    (lambda: changed(stage__planets=3, stage__pin_tangential_um=None).require_assembly(), "cannot be put in at 120"),
    (
        lambda: changed(stage__planets=10, stage__pin_tangential_um=None).require_assembly(),
        "neighbouring planets touch",
    ),
    error=GeometryError,
)


def test_other_meshes_are_not_rebalanced(result):
    with pytest.raises(InputError, match=r"sun.teeth: needs other meshes"):
        rebalanced(result, {"sun.teeth": 31})


def test_shortest_stage_of_the_guide_can_be_built():
    guide = Path(__file__).parents[2] / "docs" / "guide" / "planetary_stages.md"
    (shortest,) = (block for block in guide.read_text(encoding="utf-8").split("```toml\n") if "[ring]\nteeth" in block)
    stage = parse_stage(shortest.partition("```")[0])
    sun, ring = stage.meshes
    assert sun.transverse_contact_ratio > 1.2
    assert ring.transverse_contact_ratio > 1.2
    assert not internal_interferences(ring, "")


def test_numbers_are_where_they_are_declared_to_be_and_one_more_is_declared_once(result, tmp_path):
    more = with_more_numbers(result)
    again = assert_comes_back(more, assert_declared(more, tmp_path))
    assert again.to_table()["added_curve_um"][-1] == pytest.approx(again.added_curve.size)
    assert [row["added_MPa"] for row in again.key_figures()] == [100.0, 101.0]
