"""The command that runs studies: files, words on the terminal, exit codes."""

import csv
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import xarray

from loaded_tca import cli, load_result
from loaded_tca.cli import DEMO_SCENE
from loaded_tca.errors import ConvergenceError, GeometryError
from loaded_tca.results.files import write_dataset
from loaded_tca.studies import load_study
from tests.samples.studies import helical

CROWNING = "pinion.modifications.lead_crowning_um"


@pytest.fixture
def study(tmp_path, monkeypatch):
    """A study file in an empty directory, with these values."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.toml").write_text(helical().to_toml(), encoding="utf-8")

    def study(values, more=""):
        (tmp_path / "study.toml").write_text(f'scene = "scene.toml"\n[factors]\n{CROWNING} = {values}\n{more}')
        return "study.toml"

    return study


def test_study_goes_into_no_directory_of_a_result(study, tmp_path, capsys):
    (tmp_path / "result.nc").write_bytes(b"old")
    assert cli.main(["study", study([2.0]), "--out", "."]) == 2
    assert "--out .: holds a result (result.nc); give another directory" in capsys.readouterr().err
    assert not os.path.exists("study.nc")


def test_axes_of_heat_maps_are_checked_before_any_variant_and_drawn(study, capsys, monkeypatch):
    tip = "pinion.modifications.tip_relief_um"
    file = study([2.0, 6.0], f"{tip} = [0.0, 10.0]\n")
    assert cli.main(["study", file, "--out", "out", "--axes", tip, "mounting.misalignment_um"]) == 2
    told = f"axes: mounting.misalignment_um: not a key with given values in the study; it has {CROWNING}, {tip}"
    assert told in capsys.readouterr().err
    assert not os.path.exists("out")
    asked = []
    monkeypatch.setattr("loaded_tca.plots.plot_study", lambda _, **ways: asked.append(ways["axes"]) or {})
    assert cli.main(["study", file, "--out", "out", "--axes", tip, CROWNING]) == 0
    assert asked == [[tip, CROWNING]]


def test_study_writes_figures_table_and_summary(study, capsys):
    assert cli.main(["study", study([2.0, -1.0, 6.0]), "--out", "out", "--keep-maps", "2"]) == 0
    text = capsys.readouterr().out
    assert text.startswith("3 variants: 2 ok, 1 refused\n")
    assert "found -1.0; allowed a number from 0 to 10000 (1 variant)" in text
    (files,) = re.findall("Written to out: (.*)", text)
    assert files.startswith("study.nc, study.csv, ranking.csv, study_")
    assert all(os.path.exists(f"out/{name}") for name in files.split(", "))
    found = load_study("out/study.nc")
    assert list(found[CROWNING].values) == [2.0, -1.0, 6.0]
    with open("out/study.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row[CROWNING]) for row in rows] == [2.0, -1.0, 6.0]
    assert float(rows[2]["peak_pressure_MPa"]) == found["peak_pressure_MPa"].values[2, 0]
    with open("out/ranking.csv", newline="") as file:
        ranked = [float(row[CROWNING]) for row in csv.DictReader(file)]
    spans = found["transmission_error_span_um"].values[:, 0]
    assert ranked == [2.0, 6.0, -1.0] if spans[0] < spans[2] else [6.0, 2.0, -1.0]
    assert load_result("out/study_maps/2.nc").scene.pinion.modifications.lead_crowning_um == 6.0


@pytest.mark.usefixtures("blank_pictures")
def test_long_study_says_beforehand_what_its_variants_take(study, capsys, monkeypatch):
    monkeypatch.setattr("loaded_tca.cli.terminal.WORTH_TELLING", 0.0)
    assert cli.main(["study", study([2.0, 4.0]), "--out", "out"]) == 0
    (line,) = [line for line in capsys.readouterr().err.splitlines() if "variants" in line]
    sentence = r"loaded-tca: 2 variants, roughly (\S+) s each on idle cores, (\S+) s together"
    each, whole = map(float, re.fullmatch(sentence, line).groups())
    assert whole == pytest.approx(2.0 * each, rel=0.1)  # two digits each: 1.0 is anything from 0.95 to 1.05


@pytest.mark.thorough
@pytest.mark.usefixtures("blank_pictures")
def test_workers_find_what_one_process_finds(study):
    name = study([2.0, 4.0, 6.0])
    assert cli.main(["study", name, "--out", "alone"]) == 0
    assert cli.main(["study", name, "--out", "workers", "--workers", "2"]) == 0
    alone, workers = (load_study(f"{place}/study.nc").drop_vars("seconds") for place in ("alone", "workers"))
    assert alone.identical(workers)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--workers", "0"], "workers: found 0; allowed a whole number from 1 on"),
        (["--keep-maps", "9"], "keep_maps: [9] are not variants 0 to 1"),
        (["--keep-maps", "a"], "allowed whole numbers with commas between them, as 0,12"),
        (["--keep-maps", "\N{SUPERSCRIPT TWO}"], "allowed whole numbers with commas between them, as 0,12"),
        (["--workers", "1_0"], "--workers: '1_0': allowed a whole number"),
        (["--workers", "2", "--scheduler", "tcp://localhost:1"], "not allowed with argument"),
    ],
)
def test_wrong_options_are_bad_input(study, capsys, arguments, told):
    assert cli.main(["study", study([2.0, 6.0]), "--out", "out", *arguments]) == 2
    assert told in capsys.readouterr().err
    assert not os.path.exists("out/study.csv")


@pytest.mark.usefixtures("blank_pictures")
def test_unknown_figure_is_told_once_all_is_written(study, capsys):
    assert cli.main(["study", study([2.0, 6.0]), "--out", "out", "--rank-by", "peak_pressure"]) == 2
    told = '--rank-by peak_pressure: not in study.csv; ranked by the default figure; did you mean "peak_pressure_MPa"?'
    assert told in capsys.readouterr().err
    assert os.path.exists("out/ranking.csv")


def test_study_without_an_analysis_fails(study, capsys):
    assert cli.main(["study", study([-1.0, -2.0]), "--out", "out", "--keep-maps", "1"]) == 2
    out, err = capsys.readouterr()
    assert out.startswith("2 variants: 2 refused\n")
    warning, *errors = err.splitlines()
    assert warning.startswith("warning: study: no variant of 2 is ok (2 refused); the first: pinion.modif")
    assert errors == [
        "loaded-tca: no variant was analysed; the summary says why",
        "loaded-tca: --keep-maps 1: no maps, the variant is refused",
    ]
    assert os.path.exists("out/study.csv")


@pytest.mark.usefixtures("blank_pictures")
@pytest.mark.parametrize(
    ("error", "status"),
    [
        (ZeroDivisionError("by zero"), "fault"),
        (ConvergenceError("swings"), "not converged"),
        (GeometryError("pointed"), "refused"),
    ],
)
def test_study_fails_whatever_its_variants_fail_of(study, capsys, monkeypatch, error, status):
    """Also where a single analysis would end with another exit code."""
    name = study([1.0, 2.0])

    def fail(_):
        raise error

    monkeypatch.setattr(sys.modules["loaded_tca.studies.ranking"], "analyse", fail)
    assert cli.main(["study", name, "--out", "out"]) == 2
    out, err = capsys.readouterr()
    assert out.startswith(f"2 variants: 2 {status}\n{status}: {error} (2 variants)\n")
    assert err.splitlines() == [
        f"warning: study: no variant of 2 is ok (2 {status}); the first: {error}",
        "loaded-tca: no variant was analysed; the summary says why",
    ]


@pytest.mark.thorough
@pytest.mark.usefixtures("blank_pictures")
def test_damaged_row_is_one_line_of_the_command(study, capsys):
    name, rows = study([2.0, 6.0]), Path("out/study.rows.jsonl")
    assert cli.main(["study", name, "--out", "out"]) == 0
    first, second = rows.read_bytes().splitlines(keepends=True)
    rows.write_bytes(first + second.replace(b'"ok"', b"null"))
    capsys.readouterr()
    assert cli.main(["study", name, "--out", "out"]) == 0
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"warning: {rows}: rows that cannot be used, their variants are analysed again: row 2: ")


def test_scene_and_study_are_told_apart(study, capsys):
    name = study([2.0])
    assert cli.main(["run", name, "--out", "out"]) == 2
    assert cli.main(["study", "scene.toml", "--out", "out"]) == 2
    assert capsys.readouterr().err.splitlines() == [
        "loaded-tca: study.toml: not a scene but a study of scene.toml; run it with 'loaded-tca study'",
        'loaded-tca: scene.toml: not a study but a scene; a study names it as scene = "..."',
    ]


@pytest.mark.usefixtures("blank_pictures")
def test_study_is_no_result(study, capsys):
    assert cli.main(["study", study([2.0]), "--out", "out"]) == 0
    capsys.readouterr()
    assert cli.main(["plot", "out/study.nc"]) == 2
    (told,) = capsys.readouterr().err.splitlines()
    assert told.endswith("a study, not the result of a mesh cycle; read it with loaded_tca.studies.load_study")


@pytest.mark.parametrize(
    ("attributes", "told"),
    [
        ({"kind": "study"}, "a study, not the result of a mesh cycle; read it with loaded_tca.studies.load_study"),
        ({"kind": "design"}, "a design, not the result of a mesh cycle; read it with loaded_tca.studies.load_design"),
        ({}, "not the result of a mesh cycle: it has neither paths of contact nor maps"),
    ],
)
def test_other_file_of_the_package_is_told_in_one_line(tmp_path, refused, monkeypatch, attributes, told):
    """The last one as the stresses below a map are, which have a scene too."""
    monkeypatch.chdir(tmp_path)
    write_dataset("other.nc", xarray.Dataset(attrs=attributes | {"scene_toml": DEMO_SCENE.read_text(encoding="utf-8")}))
    for command in ("plot", "tooth", "dynamics", "sensitivities"):
        assert refused(command, "other.nc") == f"other.nc: {told}"
    assert refused("compare", "other.nc", "other2.nc", "--out", "out") == f"other.nc: {told}"


def test_wrong_study_is_told_before_anything_is_written(study, capsys):
    assert cli.main(["study", study('["a"]', "pinion.teth = [1]"), "--out", "out"]) == 2
    assert [line.split(":")[1].strip() for line in capsys.readouterr().err.splitlines()] == ["pinion.teth", CROWNING]
    assert not os.path.exists("out")


@pytest.mark.thorough
@pytest.mark.usefixtures("blank_pictures")
@pytest.mark.parametrize("workers", [[], ["--workers", "2"]])
def test_interrupt_keeps_what_is_done_and_the_same_command_goes_on(study, workers):
    name = study("{ from = 0.0, to = 10.0, count = 1001 }")
    command = [sys.executable, "-m", "loaded_tca", "study", name, "--out", "out", *workers]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        rows = "out/study.rows.jsonl"
        while process.poll() is None and not (os.path.exists(rows) and os.path.getsize(rows) > 5000):
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        _, told = process.communicate(timeout=600)
    assert process.returncode in (130, -signal.SIGINT)
    assert "variants are kept in out/study.rows.jsonl: the same study goes on from there" in told
    kept = Path(rows).read_text().splitlines()
    assert 0 < len(kept) < 1001
    study([0.0, 0.01])
    assert cli.main(["study", name, "--out", "out"]) == 0
    now = Path(rows).read_text().splitlines()
    assert now[: len(kept)] == kept
    assert len(now) <= len(kept) + 2
