"""The command for planetary stages."""

import csv
import json

import pytest

from loaded_tca.cli import main
from loaded_tca.plots import STAGE_PICTURES
from loaded_tca.stages import StageResult
from tests.samples.stages import FEW, analysed, stage_of_few_cells

QUICK = [f"{key}={str(value).lower() if value is False else value}" for key, value in FEW.items()]
STAGE = "examples/stages/helical_automotive.toml"
FILES = ["ring_mesh.nc", "stage.csv", "stage.json", "stage.nc", "sun_mesh.nc"]


def options(*changes):
    return [part for change in changes for part in ("--set", change)]


@pytest.mark.usefixtures("blank_pictures")
@pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")
def test_stage_is_written_with_its_tables_and_pictures(tmp_path, capsys, monkeypatch):
    asked = []
    monkeypatch.setattr("loaded_tca.stages.analyse_stage", lambda stage, **_: asked.append(stage) or analysed()[0])
    assert main(["stage", STAGE, "--out", str(tmp_path), *options(*QUICK)]) == 0
    pictures = [f"{name}.png" for name in STAGE_PICTURES]
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(FILES + pictures)
    assert "orders that equal planets cancel" in capsys.readouterr().out
    result = StageResult.load(tmp_path)
    assert asked == [stage_of_few_cells()]
    figures = json.loads((tmp_path / "stage.json").read_text())
    assert figures["torques"][0]["mesh_load_factor"] == pytest.approx(float(result.mesh_load_factor[0]))
    assert figures["ring_mesh_phase"] == pytest.approx(result.ring_mesh_phase.tolist())
    with (tmp_path / "stage.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == result.dataset.sizes["position"]
    assert float(rows[1]["planet_2_share"]) == pytest.approx(float(result.planet_share[0, 1, 2]), rel=1e-8)


@pytest.mark.usefixtures("blank_pictures")
@pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")
def test_stage_leaves_no_file_of_an_earlier_one_and_of_its_meshes(tmp_path, monkeypatch):
    monkeypatch.setattr("loaded_tca.stages.analyse_stage", lambda *_, **__: analysed()[0])
    gone = "report.html", "rating.csv", "sun_mesh/report.html", "sun_mesh/dynamics.csv", "ring_mesh/interactive.html"
    for name in (*gone, "sun_mesh/notes.txt"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(b"old")
    assert main(["stage", STAGE, "--out", str(tmp_path), *options(*QUICK)]) == 0
    assert not [name for name in gone if (tmp_path / name).exists()]
    assert [path.name for path in (tmp_path / "sun_mesh").iterdir()] == ["notes.txt"]
    assert not (tmp_path / "ring_mesh").exists()


def test_bad_input_is_one_line(tmp_path, capsys):
    assert main(["stage", STAGE, "--out", str(tmp_path), *options("stage.pin_radial_um=[1.0]")]) == 2
    assert capsys.readouterr().err.splitlines() == [
        "loaded-tca: stage.pin_radial_um: found 1 values; allowed 4, one for each planet"
    ]


def test_planets_that_cannot_be_put_in_are_refused_before_anything_is_analysed(tmp_path, capsys):
    changes = options("stage.planets=3", "stage.pin_tangential_um=[0.0, 0.0, 0.0]")
    assert main(["stage", STAGE, "--out", str(tmp_path), *changes]) == 2
    assert "planets cannot be put in at 120.0000, 240.0000 deg" in capsys.readouterr().err
