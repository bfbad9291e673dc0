"""Commands that read and write REXS models."""

from __future__ import annotations

from pathlib import Path

import pytest

from loaded_tca import analyse, read_scene
from loaded_tca.exchange import import_stage, read_rexs
from tests.samples.rexs import EXAMPLE

MODEL = str(EXAMPLE)


@pytest.fixture(autouse=True)
def _in_an_empty_directory(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def test_import_without_a_stage_shows_the_stages(run) -> None:
    code, out, _ = run("import", MODEL)
    assert code == 0
    assert '  10: cylindrical_stage "First stage": cylindrical_gear 21 with 21 teeth, ' in out
    assert "load cases: 1:1, 1:2" in out


def test_import_writes_a_scene_and_shows_what_was_not_taken(run) -> None:
    code, out, err = run("import", MODEL, "--stage", "10", "--out", "scene.toml")
    assert (code, err) == (0, [])
    assert out.endswith("Written to .: scene.toml\n")
    assert "  profile_twist 64: no modification that a scene has (profile_twist)\n" in out
    assert read_scene("scene.toml") == import_stage(read_rexs(MODEL), "10").scene
    assert run("check", "scene.toml")[0] == 0
    assert run("shaft", "scene.toml")[0] == 0


def test_import_without_a_file_shows_the_scene(run) -> None:
    code, out, _ = run("import", MODEL, "--stage", "11", "--load-case", "2", "--torque", "100")
    assert code == 0
    assert out.startswith("# From two_stage_gearbox.rexs, REXS 1.7, cylindrical_stage 11")
    assert "\npinion_torque_Nm = 100.0\n" in out


REFUSED = {
    "stage": (("--stage", "12", "--out", "a.toml"), "stage 12: not found; allowed 10, 11"),
    "load case": (("--stage", "10", "--load-case", "7"), "load case 7: not found; allowed 1:1, 1:2"),
    "no stage": (("--out", "a.toml"), "--out a.toml: needs --stage"),
    "torque": (("--stage", "10", "--torque", "-3"), "allowed a torque above 0 in N m"),
    "directory": (("--stage", "10", "--out", "."), "cannot be written: a directory"),
    "model": (("--stage", "10", "--out", MODEL), "would replace the input"),
}


@pytest.mark.parametrize(("options", "message"), REFUSED.values(), ids=REFUSED)
def test_import_refuses_in_one_line(run, options: tuple[str, ...], message: str) -> None:
    code, out, err = run("import", MODEL, *options)
    assert (code, out) == (2, "")
    assert message in " ".join(err)
    assert not Path("a.toml").exists()


def test_import_refuses_other_files(run) -> None:
    Path("scene.rexs").write_text("[pair]\n", encoding="utf-8")
    code, _, err = run("import", "scene.rexs")
    assert code == 2
    assert "scene.rexs: neither XML, JSON nor zip" in err[0]


@pytest.mark.filterwarnings("ignore::loaded_tca.errors.AccuracyWarning")
def test_export_writes_the_model_with_results(run) -> None:
    scene = import_stage(read_rexs(MODEL), "10").scene
    quick = {"analysis.positions": 2, "analysis.cells": [8, 12], "analysis.compliance": "contact"}
    analyse(scene.with_changes(quick | {"analysis.free_edges": False})).save("result.nc")
    asked = "export", "result.nc", "--model", MODEL, "--stage", "10", "--out"
    code, out, _ = run(*asked, "out.rexs", "--torque", "150")
    assert (code, out) == (0, "Written to .: out.rexs\n")
    assert read_rexs("out.rexs").components["10"].number("face_load_factor_flank") > 1.0
    code, _, err = run(*asked, "other.rexs", "--torque", "151")
    assert code == 2
    assert "--torque 151: the result has 150 N m" in err[0]
    assert run(*asked, MODEL)[0] == 2
    assert not Path("other.rexs").exists()
