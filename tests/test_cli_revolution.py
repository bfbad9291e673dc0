"""The command for whole revolutions."""

import csv
import json

import pytest

from loaded_tca import Revolution
from loaded_tca.cli import main

QUICK = [
    "analysis.cells=[12, 16]",
    "analysis.compliance=contact",
    "analysis.free_edges=false",
    "revolution.pitches=3",
    "revolution.positions_per_pitch=4",
    "analysis.torques_Nm=[40.0]",
]
SCENE = "examples/scenes/revolution_helical.toml"
TABLES = ["orders.csv", "revolution.csv", "revolution.json", "revolution.nc", "teeth.csv"]
PICTURES = [f"revolution_{name}.png" for name in ("error", "shares", "spectrum")]  # of one torque


def options(*changes):
    return [part for change in changes for part in ("--set", change)]


def rows_of(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.usefixtures("blank_pictures")
def test_revolution_is_written_with_its_tables_and_pictures(tmp_path, capsys):
    for old in ("report.html", "dynamics.csv", "dynamics_orders.csv", "revolution_waterfall.png"):  # of another one
        (tmp_path / old).write_bytes(b"")
    assert main(["revolution", SCENE, "--out", str(tmp_path), *options(*QUICK)]) == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(TABLES + PICTURES)
    output = capsys.readouterr()
    assert "single flank deviation over 3 pitches [um]" in output.out  # of the 24 of the wheel, which deviates
    assert "3 pitches are no whole turn of the wheel" in output.err
    turn = Revolution.load(tmp_path / "revolution.nc")
    positions = rows_of(tmp_path / "revolution.csv")
    assert len(positions) == 12
    assert float(positions[5]["transmission_error_um"]) == pytest.approx(turn.error_um(0)[5], rel=1e-8)
    figures = json.loads((tmp_path / "revolution.json").read_text())["torques"][0]
    assert figures["total_single_flank_deviation_um"] == pytest.approx(turn.total_deviation(0))
    orders = rows_of(tmp_path / "orders.csv")
    assert [row["kind"] for row in orders][2] == "mesh 1"
    teeth = rows_of(tmp_path / "teeth.csv")
    assert len(teeth) == 17 + 24
    assert teeth[-1]["gear"] == "wheel"
    assert {float(row["index_deviation_um"]) for row in teeth if row["gear"] == "pinion"} == {0.0}


@pytest.mark.parametrize(
    ("command", "scene", "holds", "kind"),
    [
        ("revolution", SCENE, "result.nc", "a result"),
        ("revolution", "examples/scenes/double_helical.toml", "revolution.nc", "a whole revolution"),
        ("run", SCENE, "revolution.nc", "a whole revolution"),
        ("run", SCENE, "double_helical_revolution.nc", "a whole revolution of a double helical pair"),
    ],
)
def test_directory_with_another_main_file_is_refused_before_the_analysis(command, scene, holds, kind, tmp_path, capsys):
    (tmp_path / holds).write_bytes(b"")
    assert main([command, scene, "--out", str(tmp_path)]) == 2
    told = f"--out {tmp_path}: holds {kind} ({holds}); give another directory, or remove it"
    assert told in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == [holds]


def test_bad_input_is_one_line(tmp_path, capsys):
    code = main(["revolution", SCENE, "--out", str(tmp_path), *options("wheel.pitch.index_um=[1.0, 2.0, 3.0]")])
    assert code == 2
    assert capsys.readouterr().err.splitlines() == [
        "loaded-tca: wheel.pitch: index_um: found 3 values; allowed 24, one for each tooth"
    ]
