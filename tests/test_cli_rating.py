"""The command that rates a result: its files, its table, what it refuses."""

import csv
import json
import os
import re
from dataclasses import replace
from pathlib import Path

import pytest

from loaded_tca.cli.commands import _rated, _show_rating_of_both
from loaded_tca.errors import AccuracyWarning
from loaded_tca.plots import plot_safeties
from tests.rating.test_both_sides import FLANKS, coast_result, reversed_first
from tests.rating.test_spectrum import bins
from tests.samples.rating import solved
from tests.samples.stages import analysed
from tests.stages.test_stage_rating import SECTIONS


@pytest.fixture
def out(tmp_path, monkeypatch):
    """The directory of a result."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("loaded_tca.plots.rating_figures", lambda rated: {"safeties": plot_safeties(rated)})  # quick
    os.mkdir("out")
    solved().save("out/result.nc")
    return "out"


def test_command_writes_what_the_call_finds(run, out):
    code, text, _ = run(
        "rating", out, "--set", "rating.required_root_safety=90", "--set", "operation.application_factor=2"
    )
    assert code == 0
    changes = {"rating.required_root_safety": 90.0, "operation.application_factor": 2.0}
    expected = solved(**changes).rating()
    assert all(line in text for line in expected.summary().splitlines())
    assert {*os.listdir(out)} == {"result.nc", "rating.json", "rating.csv", "safeties.png"}
    with open(f"{out}/rating.json", encoding="utf-8") as file:
        written = json.load(file)
    assert [row["wheel_flank_safety"] for row in written["torques"]] == expected.flank_safety[:, 1].tolist()
    assert written["notes"] == [*expected.notes()]
    with open(f"{out}/rating.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["pinion_torque_Nm"] for row in rows] == ["100", "200"]
    assert [row["pinion_root_life_h"] for row in rows] == ["0", "0"]  # above the static strength
    assert list(rows[0]) == list(expected.figures)


def test_command_rates_a_result_again_under_a_spectrum(run, out):
    with open("bins.csv", "w", encoding="utf-8") as file:
        file.write("pinion_torque_Nm,hours\n120,3\n200,1\n")
    for name in ("root_safety.png", "pressure_map.png"):  # of an older rating, and of the run
        Path(out, name).touch()
    code, text, told = run("rating", out, "--set", "load.spectrum=bins.csv", "--set", "rating.required_root_safety=5")
    assert code == 0
    cases = [{"pinion_torque_Nm": 120.0, "hours": 3.0}, {"pinion_torque_Nm": 200.0, "hours": 1.0}]
    with pytest.warns(AccuracyWarning, match="no estimate of its error: 2 analysed torques"):
        expected = solved(**{"load.case": cases, "rating.required_root_safety": 5.0}).rating()
    shown = text + "".join(map(str, told))  # warnings are told beside the summary
    assert all(line.removeprefix("warning: ") in shown for line in expected.summary().splitlines())
    with open(f"{out}/rating.json", encoding="utf-8") as file:
        written = json.load(file)
    assert written["spectrum"]["pinion_root"]["life_h"] == expected.life_hours[0, 1]
    assert written["spectrum"]["bins"] == 2
    assert len(written["torques"]) == 2
    with open(f"{out}/rating.csv", encoding="utf-8", newline="") as file:
        damage = [float(row["wheel_root_damage"]) for row in csv.DictReader(file)]
    assert damage == pytest.approx(expected.damage[:, 1, 1].tolist(), rel=1e-8)  # nine digits
    assert {*os.listdir(out)} == {"result.nc", "rating.json", "rating.csv", "safeties.png", "pressure_map.png"}


def test_commands_rate_both_sides(run, out, monkeypatch):
    monkeypatch.setattr("loaded_tca.reports.result_page.result_figures", lambda *_, **__: {})
    monkeypatch.setattr("loaded_tca.reports.rating_page.rating_figures", lambda _: {})
    cases = reversed_first((200.0, 10.0), (100.0, 30.0))
    whole = solved(**FLANKS, **{"analysis.torques_Nm": (100.0, 200.0), "load.case": cases})
    whole.save(f"{out}/result.nc")
    coast_result(**FLANKS).save("coast.nc")
    code, text, _ = run("rating", out, "--coast", "coast.nc")
    assert code == 0
    rated = whole.rating(coast=coast_result(**FLANKS))
    assert all(line in text for line in rated.summary().splitlines())
    with open(f"{out}/rating.json", encoding="utf-8") as file:
        assert json.load(file)["spectrum"]["pinion_coast_flank"]["spectrum_safety"] > 0.0
    assert run("report", out, "--coast", "coast.nc")[0] == 0
    page = Path(out, "report.html").read_text(encoding="utf-8")
    cells = re.search(r">pitting of the coast flank</th>(.*)</tr>", page).group(1)
    _, pinion, _, wheel, _ = re.findall(r"<td>(.*?)</td>", cells)  # required, safeties and lives
    assert re.search(rf"coast flank: safety in the required life +{pinion} +{wheel}\n", text)
    assert all(note in page for note in rated.notes())
    code, _, errors = run("report", out, "--coast", out)  # the drive side itself: no page of one side alone
    assert code == 2
    assert any("coast: " in line for line in errors), errors


def test_run_says_why_a_scene_is_not_rated(tmp_path):
    assert _rated(solved(rating=None), tmp_path) == ([], "")
    files, text = _rated(solved(lubricant=None), tmp_path)
    assert files == []
    assert text.startswith("no rating: lubricant: missing")


REFUSED = [
    (("--set", "pinion.teeth=21"), "--set pinion.teeth: needs another analysis"),
    (("--set", "rating.life_hours=-1"), "rating.life_hours: found -1"),
    (("--set", "pinion.strength.hardness_HV=100"), "pinion.strength.hardness_HV: found 100 HV; allowed for kind 'Eh'"),
]


@pytest.mark.parametrize(("arguments", "words"), REFUSED)
def test_command_refuses_in_one_line(run, out, arguments, words):
    code, _, errors = run("rating", out, *arguments)
    assert code == 2
    assert any(words in line for line in errors), errors
    assert os.listdir(out) == ["result.nc"]


@pytest.fixture
def stage(tmp_path, monkeypatch):
    """The directory of a stage with a rating."""
    monkeypatch.chdir(tmp_path)
    result, _ = analysed()
    replace(result, stage=result.stage.with_changes(SECTIONS)).save("stage")
    return "stage"


def test_command_rates_the_stage_of_a_directory(run, stage):
    code, text, _ = run("rating", stage, "--set", "rating.mesh_load_factor=1.3", "--out", "rated")
    assert code == 0
    assert "sun | planet | ring" in text
    with open("rated/rating.json", encoding="utf-8") as file:
        (row,) = json.load(file)["torques"]
    assert row["K_gamma"] == row["ring_mesh_K_gamma"] == 1.3
    code, _, errors = run("rating", stage, "--set", "sun.teeth=21")
    assert code == 2
    assert any("--set sun.teeth: needs another analysis; allowed keys of [sun.strength]" in line for line in errors)


@pytest.mark.usefixtures("blank_pictures")
@pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")
def test_stage_is_rated_as_it_is_analysed(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("loaded_tca.stages.analyse_stage", lambda stage, **_: replace(analysed()[0], stage=stage))
    bare = analysed()[0].stage
    stages = {
        "rated": bare.with_changes(SECTIONS),
        "unfit": bare.with_changes(SECTIONS | {"lubricant": None}),
        "bare": bare,
    }
    said = {}
    for name, one in stages.items():
        Path(f"{name}.toml").write_text(one.to_toml(), encoding="utf-8")
        code, said[name], _ = run("stage", f"{name}.toml", "--out", "out")
        assert code == 0
        # files of the rating before do not stay beside a stage that has none
        assert Path("out/rating.json").exists() == Path("out/rating.csv").exists() == (name == "rated")
    assert "sun | planet | ring" in said["rated"]
    assert "no rating: lubricant: missing; the strength of flanks depends on" in said["unfit"]
    assert "rating" not in said["bare"]


@pytest.mark.parametrize(("of_bins", "is_shown"), [(reversed_first, True), (bins, False)])
def test_command_that_rates_both_sides_is_shown_where_bins_are_reversed(capsys, of_bins, is_shown):
    spectrum = {"analysis.torques_Nm": (100.0, 200.0), "load.case": of_bins((200.0, 10.0), (100.0, 30.0))}
    rated = solved(**FLANKS, **spectrum)
    _show_rating_of_both(rated.scene, Path("both"))
    command = f"'loaded-tca rating {Path('both/drive')} --coast {Path('both/coast')}'"
    text = capsys.readouterr().out
    assert (command in text) == is_shown
    assert (command.replace("rating", "report") in text) == is_shown
    assert (
        any("'loaded-tca rating DIR --coast OTHER' rates both" in note for note in rated.rating().notes()) == is_shown
    )
