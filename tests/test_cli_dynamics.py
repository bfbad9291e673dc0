"""The command and the tables that hand a result to programs of gear dynamics."""

import csv
import os
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import load_result
from loaded_tca.errors import InputError
from loaded_tca.output import write_dynamics
from tests.samples.results import changed_scene, result
from tests.samples.revolutions import small_turn


def cycle():
    return result("mesh_cycle_helical", positions=5, torques=(40.0, 260.0))


@pytest.fixture
def out(tmp_path, monkeypatch):
    """The directory of a result."""
    monkeypatch.chdir(tmp_path)
    os.mkdir("out")
    cycle().save("out/result.nc")
    return "out"


def table(path):
    """Comments of a table, and its columns as numbers; NaN where a cell is empty, words as they are."""
    with open(path, encoding="utf-8", newline="") as file:
        lines = file.read().splitlines()
    comments = [line for line in lines if line.startswith("#")]
    assert lines[: len(comments)] == comments
    rows = list(csv.DictReader(lines[len(comments) :]))
    columns = {name: [row[name] if name == "kind" else float(row[name] or "nan") for row in rows] for name in rows[0]}
    return comments, {name: np.array(values) for name, values in columns.items()}


def test_tables_have_the_curves_and_their_orders(run, out):
    code, text, errors = run("dynamics", out)
    assert (code, errors) == (0, [])
    assert text.splitlines() == ["Written to out: dynamics.csv, dynamics_orders.csv"]
    dynamics = cycle().to_dynamics()
    for name, last in (("dynamics", "mesh_phase"), ("dynamics_orders", "order")):
        comments, columns = table(f"out/{name}.csv")
        assert list(columns)[:2] == ["pinion_torque_Nm", last]
        for column, values in columns.items():
            assert any(line.startswith(f"#   {column}: ") for line in comments)
            expected = dynamics[column].broadcast_like(dynamics[list(columns)[-1]]).values.ravel()
            assert_allclose(values, expected, rtol=1e-11)  # twelve digits
        for told in (
            " phase_k)",
            "pinion_teeth = 34",
            "pinion_base_helix_angle_rad = ",
            "loaded_contact_ratio = ",
            "under 260 N m",
        ):
            assert any(told in line for line in comments)
    in_both = {column for name in ("dynamics", "dynamics_orders") for column in table(f"out/{name}.csv")[1]}
    assert in_both >= {str(name) for name, one in dynamics.variables.items() if one.ndim == 2}


def test_tables_of_a_revolution_are_those_of_its_curves_and_its_spectrum(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    turn = small_turn()
    os.mkdir("turn")
    turn.save("turn/revolution.nc")
    assert run("dynamics", "turn")[1].splitlines() == ["Written to turn: dynamics.csv, dynamics_orders.csv"]
    comments, curves = table("turn/dynamics.csv")
    assert {"# pitches = 24", "# periodic = 1"} <= {line.partition(":")[0] for line in comments}
    assert not any("Not periodic" in line for line in comments)
    error = 1e-6 * np.concatenate([turn.error_um(torque) for torque in (0, 1)])
    assert_allclose(curves["transmission_error_m"], error, rtol=1e-11)  # twelve digits
    assert_allclose(curves["mesh_phase"], np.tile(0.25 * np.arange(96), 2), rtol=1e-11)
    comments, orders = table("turn/dynamics_orders.csv")
    order, amplitude, kind = turn.spectrum(1)
    rows = (orders["pinion_torque_Nm"] == 60.0) & (orders["order"] > 0.0)
    # atol: m, of orders that are not there, as rounding leaves them of a curve of some um
    assert_allclose(orders["transmission_error_amplitude_m"][rows], 1e-6 * amplitude, rtol=1e-9, atol=1e-18)
    assert_allclose(orders["order_of_wheel"][rows], order, rtol=1e-11)
    assert orders["kind"][rows].tolist() == kind.tolist()
    assert [*orders][1:5] == ["order", "order_of_pinion", "order_of_wheel", "kind"]


def test_tables_of_a_revolution_that_does_not_repeat_say_so(tmp_path):
    turn = small_turn()
    scene = turn.scene.with_changes({"revolution.pitches": 12})
    write_dynamics(replace(turn, scene=scene, dataset=turn.dataset.isel(position=range(48))), tmp_path / "mesh.csv")
    for name in ("mesh.csv", "mesh_orders.csv"):
        comments, _ = table(tmp_path / name)
        assert "# Not periodic: 12 pitches are no whole turn of the wheel, whose teeth deviate." in comments
        assert any(line.startswith("# periodic = 0: ") for line in comments)


def test_half_of_a_double_helical_revolution_has_tables_in_its_directory(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    small_turn().save("half_a_revolution.nc")
    assert run("dynamics", "half_a_revolution.nc")[0] == 0
    assert sorted(os.listdir("half_a_revolution")) == ["dynamics.csv", "dynamics_orders.csv"]


def test_usual_readers_skip_the_words(run, out):
    run("dynamics", out)
    assert np.loadtxt("out/dynamics.csv", delimiter=",", skiprows=len(table("out/dynamics.csv")[0]) + 1).shape[0] == 8
    import pandas

    assert pandas.read_csv("out/dynamics.csv", comment="#").shape[0] == 8


def test_first_table_goes_where_it_is_wanted(run, out):
    assert run("dynamics", "out/result.nc", "--out", "there/mesh.txt")[0] == 0
    assert sorted(os.listdir("there")) == ["mesh.txt", "mesh_orders.txt"]
    assert os.listdir(out) == ["result.nc"]


def test_title_stands_in_the_words_of_any_script(tmp_path):
    write_dynamics(changed_scene(cycle(), {"title": "Räder, 1:2"}), tmp_path / "mesh.csv")
    assert table(tmp_path / "mesh.csv")[0][1].endswith(": Räder, 1:2")


def test_what_is_not_known_is_an_empty_cell(tmp_path):
    write_dynamics(result("mesh_cycle_helical", positions=4, torques=(0.0, 40.0)), tmp_path / "mesh.csv")
    force = table(tmp_path / "mesh.csv")[1]["normal_force_per_torque_N_per_Nm"]
    assert np.isnan(force[:3]).all()
    assert (force[3:] > 0.0).all()


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["nothing"], "nothing: cannot be read"),
        (["out", "--out", "out"], "--out out: a directory; give the name of a file, as out/dynamics.csv"),
        (["out", "--out", "out/result.nc/mesh.csv"], "result.nc is a file; give a directory"),
        (["out", "--out", ""], "the name is empty"),
        (["out", "--out", "out/result.nc"], "--out: out/result.nc: would replace the input; give another name"),
        (["out/result.nc", "--out", "out/../out/result.nc"], "would replace the input"),
    ],
)
def test_wrong_command_line_is_told(refused, out, arguments, told):
    assert told in refused("dynamics", *arguments)
    assert os.listdir(out) == ["result.nc"]


def test_second_table_does_not_replace_the_input(refused, out):
    os.rename("out/result.nc", "out/mesh_orders.nc")
    message = refused("dynamics", "out/mesh_orders.nc", "--out", "out/mesh.nc")
    assert message == "--out: out/mesh_orders.nc: would replace the input; give another name"
    assert load_result("out/mesh_orders.nc").pinion_angle.size == 5
    assert os.listdir(out) == ["mesh_orders.nc"]


def test_result_without_a_period_writes_nothing(refused, out):
    result().save("out/result.nc")
    assert refused("dynamics", out).startswith("analysis.load_sharing: found false")
    assert os.listdir(out) == ["result.nc"]


def test_tables_that_cannot_be_written_are_told(tmp_path):
    (tmp_path / "mesh_orders.csv").mkdir()
    with pytest.raises(InputError, match=r"mesh_orders\.csv: cannot be written"):
        write_dynamics(cycle(), tmp_path / "mesh.csv")


def test_help_says_what_the_files_hold(run, capsys):
    with pytest.raises(SystemExit) as ended:
        run("dynamics", "--help")
    assert ended.value.code == 0
    told = capsys.readouterr().out
    assert "_orders" in told
    assert "Fourier coefficients" in told
