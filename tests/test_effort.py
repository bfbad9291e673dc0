import math
import os
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from loaded_tca import InputError, analyse, machine_speed, read_scene
from loaded_tca.compliance.body import ToothFrame, gear_nodes
from loaded_tca.compliance.influence import forget
from loaded_tca.compliance.root_stress import OUTLINE, root_influence, stress_density
from loaded_tca.effort import expected_effort, expected_run_effort
from loaded_tca.machine_speed import MachineSpeed
from loaded_tca.threads import with_jobs
from tests.samples.results import ONE_PAIR, result

SCENES = Path(__file__).parents[1] / "examples" / "scenes"


REFERENCE = MachineSpeed(np.array(1.0), np.array(1.0))


@pytest.fixture(autouse=True)
def machine(monkeypatch):
    """Lets estimates be those of a machine; the one that the constants were measured on, if no other is asked for."""

    def be(speed):
        monkeypatch.setattr("loaded_tca.effort.machine_speed", lambda: speed)

    be(REFERENCE)
    return be


def effort_of(name="helical", **changes):
    return expected_effort(scene(name, **changes))


def scene(name="helical", **changes):
    changed = {f"analysis.{key}": value for key, value in changes.items()}
    return read_scene(SCENES / f"{name}.toml").with_changes({**ONE_PAIR, **changed})


def test_contacts_are_those_of_the_result_where_one_pair_carries_all():
    cycle = result(positions=5, torques=(20.0, 80.0))
    found = expected_effort(cycle.scene)
    maps = [one for rows in cycle.maps for row in rows for one in row]
    assert found.contacts == len(maps)
    assert found.cells == maps[0].pressure.size


def test_contacts_are_about_those_of_a_result_whose_pairs_share_the_load():
    cycle = result("mesh_cycle_helical", positions=5, torques=(40.0, 260.0))
    loaded = int((cycle.normal_force > 0.0).sum())
    assert loaded / 2 <= expected_effort(cycle.scene).contacts <= 2 * loaded


def test_memory_holds_at_least_the_maps_of_the_result():
    found = effort_of(cells=(300, 200), accuracy=None, positions=50)
    assert found.memory > 50 * 2 * 8 * 300 * 200  # pressure and gap


@pytest.mark.parametrize(
    "more",
    [
        {"positions": 42},
        {"torques_Nm": (10.0, 20.0)},
        {"load_sharing": True},
        {"free_edges": True},
        {"compliance": "contact+tooth"},
        {"root_stress": True},
        {"accuracy": 1e-4},
        {"cells": (100, 100), "accuracy": None},
    ],
)
def test_more_work_is_a_larger_estimate(more):
    assert effort_of(**more).seconds > 1.03 * effort_of().seconds


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("name", "face_width"),
    [
        ("mesh_cycle_helical", 6.0),
        ("mesh_cycle_helical", 60.0),
        ("face_milled_19x62", None),
    ],
)
def test_memory_of_root_stress_is_about_what_its_models_tell(name, face_width, monkeypatch):
    """Without any memory a model says how much its factor needs, before it takes any of it."""
    changes = {} if face_width is None else dict.fromkeys(("pinion.face_width_mm", "wheel.face_width_mm"), face_width)
    asked = scene(name, root_stress=True).with_changes(changes)
    estimated = (
        expected_effort(asked).memory - expected_effort(asked.with_changes({"analysis.root_stress": False})).memory
    )
    monkeypatch.setattr("loaded_tca.compliance.dissection.machine_memory", lambda: 0.0)
    told, pair = [], asked.pair()
    for gear in (pair.pinion, pair.wheel):
        frame = ToothFrame(gear, gear_nodes(gear, stress_density(gear), OUTLINE))
        with pytest.raises(InputError) as error:
            root_influence(frame)
        told.append(2.0**30 * float(re.search(r"need ([\d.]+) GiB", str(error.value))[1]))
    assert estimated == pytest.approx(max(told), rel=0.25)


def test_root_stress_takes_longer_the_wider_the_face():
    def seconds(width, **more):
        faces = dict.fromkeys(("pinion.face_width_mm", "wheel.face_width_mm"), width)
        return expected_effort(scene("mesh_cycle_helical", **more).with_changes(faces)).seconds

    assert seconds(6.0) == seconds(60.0), "flanks alone, one pair"
    assert seconds(60.0, root_stress=True) - seconds(60.0) > 2.0 * (seconds(6.0, root_stress=True) - seconds(6.0))


def test_accuracy_asks_for_no_more_cells_than_the_finest_grid():
    assert effort_of(accuracy=1e-6).cells == 1024**2
    assert not effort_of(accuracy=1e-6, positions=10000).is_refused


def test_analysis_beyond_the_memory_is_refused_before_it_starts(monkeypatch):
    monkeypatch.setattr("loaded_tca.effort.machine_memory", lambda: 2.0**30)
    asked = scene(cells=(1000, 1000), accuracy=None, positions=21)
    with pytest.raises(InputError, match=r"cells: \(1000, 1000\): 21 contacts of 1000000 cells.*has 1 GiB"):
        analyse(asked, progress=lambda *_: pytest.fail("has started"))


def test_estimate_says_what_it_is_of():
    text = str(effort_of(positions=1, cells=(10, 10), accuracy=None))
    assert text.startswith("1 contact of 100 cells: roughly 0.41 s on idle cores, 0.14 GiB")


@pytest.mark.parametrize(
    "changes",
    [
        {"pinion.tip_rounding_mm": 0.2},
        {"pinion.tip_rounding_mm": 0.2, "analysis.edge_pressures": "all"},
        {"material.max_pressure_MPa": 1500.0},
        dict.fromkeys(("pinion.face_width_mm", "wheel.face_width_mm"), 60.0),
    ],
)
def test_what_makes_a_state_longer_is_in_the_estimate(changes):
    asked = scene("mesh_cycle_helical", load_sharing=True, compliance="contact+tooth")
    assert expected_effort(asked.with_changes(changes)).seconds > 1.3 * expected_effort(asked).seconds


def test_way_to_where_supports_let_gears_stand_is_in_the_estimate():
    rigid = scene("mesh_cycle_helical", load_sharing=True, positions=9)
    asked = rigid.with_changes({"pinion.support.compliance": (1e-6 * np.eye(6)).tolist()})
    assert expected_effort(asked).seconds > 1.3 * expected_effort(rigid).seconds  # measured: 1.6 to 1.7 times


@pytest.mark.parametrize("estimate", [expected_effort, expected_run_effort])
def test_machine_twice_as_slow_takes_twice_as_long(machine, estimate):
    asked = scene(load_sharing=True, compliance="contact+tooth", root_stress=True)
    seconds = estimate(asked).seconds
    machine(MachineSpeed(np.array(2.0), np.array(2.0)))
    assert estimate(asked).seconds == pytest.approx(2.0 * seconds)  # rounding


def test_models_take_longer_where_eliminations_do(machine):
    asked = scene(compliance="contact+tooth", root_stress=True)
    effort = expected_effort(asked)
    machine(MachineSpeed(np.array(1.0), np.array(3.0)))
    models = sum(effort.teeth) + sum(effort.roots)
    assert expected_effort(asked).seconds == pytest.approx(effort.states + 3.0 * models)  # rounding


@pytest.mark.parametrize(
    ("jobs", "teeth", "roots", "seconds"),
    [
        (1, (2.0, 1.0), (9.0, 7.0), 29.0),
        (2, (2.0, 1.0), (9.0, 7.0), 17.0),  # a helper starts a process for each model of roots; all else takes 13 s
        (2, (2.0, 1.0), (15.0, 12.0), 25.0),  # the second one is made by whom the states leave free first
        (3, (2.0, 1.0), (9.0, 7.0), 13.0),
        (2, (2.0, 1.0), (), 12.0),  # models of teeth of both gears at once
    ],
)
def test_time_is_that_of_what_ends_last(jobs, teeth, roots, seconds, monkeypatch):
    monkeypatch.setattr("loaded_tca.effort.APART_SECONDS", 0.5)
    effort = replace(effort_of(), states=10.0, teeth=teeth, roots=roots, jobs=jobs)
    assert effort.seconds == pytest.approx(seconds)  # rounding


def test_models_are_made_one_by_one_where_memory_is_short(monkeypatch):
    asked = scene(root_stress=True)
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1}, raising=False)
    with with_jobs(2):
        together = expected_effort(asked)
        monkeypatch.setattr("loaded_tca.effort.machine_memory", lambda: 1.5 * together.memory)
        alone = expected_effort(asked)
    assert (together.jobs, alone.jobs) == (2, 1)
    assert alone.memory < together.memory
    assert alone.seconds > together.seconds


@pytest.fixture
def measured(monkeypatch, tmp_path):
    """Speeds in the order in which they are measured, each other than the one before, in a folder of models."""
    monkeypatch.setenv("LOADED_TCA_CACHE", str(tmp_path))
    speeds = []

    def measure():
        speeds.append(1.0 + len(speeds))
        return MachineSpeed(np.array(speeds[-1]), np.array(10.0 * speeds[-1]))

    monkeypatch.setattr(machine_speed, "measured_speed", measure)
    monkeypatch.setattr(machine_speed, "machine_speed", machine_speed.machine_speed.__wrapped__)  # not kept in memory
    return speeds


def speed_of_a_new_process():
    forget()
    speed = machine_speed.machine_speed()
    return float(speed.states), float(speed.models)


def test_speed_is_measured_once_on_a_machine(measured, monkeypatch):
    assert [speed_of_a_new_process() for _ in range(2)] == [(1.0, 10.0), (1.0, 10.0)]
    monkeypatch.setattr("platform.node", lambda: "another")
    assert speed_of_a_new_process() == (2.0, 20.0)
    assert len(measured) == 2


@pytest.mark.parametrize("damage", [b"", b"PK\x03\x04 no archive", None])
def test_damaged_speed_is_measured_anew(measured, tmp_path, damage):
    speed_of_a_new_process()
    (file,) = tmp_path.glob("*.npz")
    whole = file.read_bytes()
    value = np.float64(1.0).tobytes()
    assert value in whole
    file.write_bytes(whole.replace(value, np.float64(7.0).tobytes(), 1) if damage is None else damage)
    assert [speed_of_a_new_process() for _ in range(2)] == [(2.0, 20.0), (2.0, 20.0)]
    assert len(measured) == 2


def test_speed_is_measured_each_time_where_nothing_can_be_kept(measured, monkeypatch, tmp_path):
    (tmp_path / "file").write_bytes(b"")
    for folder in ("off", str(tmp_path / "file")):
        monkeypatch.setenv("LOADED_TCA_CACHE", folder)
        speed_of_a_new_process()
    assert measured == [1.0, 2.0]


def test_speed_of_this_machine_is_that_of_a_machine():
    speed = machine_speed.measured_speed()
    assert 0.0 < speed.states < math.inf
    assert 0.0 < speed.models < math.inf
