"""The script that runs the suite as other machines would: command lines, table and exit code, without a run of it."""

import os
import subprocess
import sys
from pathlib import Path
from platform import machine

import pytest

from tests import machines
from tests.machines import CONFIGURATIONS, Configuration, command, main

RESULTS = """<testsuites><testsuite>
<testcase classname="tests.test_a" name="test_passes"/>
<testcase classname="tests.test_a" name="test_skipped"><skipped/></testcase>
<testcase classname="tests.test_a" name="test_fails"><failure/></testcase>
<testcase classname="tests.test_a" name="test_cannot_be_set_up"><error/></testcase>
</testsuite></testsuites>"""
PASSED = '<testsuites><testsuite><testcase classname="tests.test_a" name="test_passes"/></testsuite></testsuites>'


@pytest.fixture
def runs(monkeypatch):
    """What the script has started instead of a run: command line, environment; each ends as the list ``ends`` says."""
    started, ends = [], []

    def run(line, *, env=None, stdout=None, **_):
        started.append((line, env))
        results, text, code = ends.pop(0)
        for option in line:
            if results and option.startswith("--junit-xml="):
                Path(option.partition("=")[2]).write_text(results, encoding="utf-8")
        stdout.write(text)
        return subprocess.CompletedProcess(line, code)

    monkeypatch.setattr(machines.subprocess, "run", run)
    return started, ends


def test_table_and_names_of_what_failed(runs, tmp_path, capsys):
    started, ends = runs
    ends += [(PASSED, "", 0), (RESULTS, "", 1)]
    assert main(["haswell", "one-worker", "--folder", str(tmp_path), "--", "-k", "spline"]) == 1
    header, first, second, *names = capsys.readouterr().out.splitlines()
    assert header.split() == ["configuration", "passed", "failed", "skipped", "seconds"]
    assert first.split()[:4] == ["haswell", "1", "0", "0"]
    assert second.split()[:4] == ["one-worker", "1", "2", "1"]
    assert names == [f"one-worker: tests.test_a::{test}" for test in ("test_fails", "test_cannot_be_set_up")]
    assert all(line[-2:] == ["-k", "spline"] for line, _ in started)
    assert started[0][1]["OPENBLAS_CORETYPE"] == "Haswell"


def test_all_that_pass_end_with_0(runs, tmp_path, capsys):
    started, ends = runs
    ends += [(PASSED, "", 0)] * 2
    assert main(["nehalem", "prescott", "--folder", str(tmp_path)]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 3
    assert [env["OPENBLAS_CORETYPE"] for _, env in started] == ["Nehalem", "Prescott"]


def test_a_run_without_results_has_failed_whatever_an_earlier_one_left(runs, tmp_path, capsys):
    (tmp_path / "haswell.xml").write_text(PASSED, encoding="utf-8")
    runs[1].append(("", "", 4))
    assert main(["haswell", "--folder", str(tmp_path)]) == 1
    *_, row, reason = capsys.readouterr().out.splitlines()
    assert row.split()[:3] == ["haswell", "0", "1"]
    assert reason == f"haswell: ended with 4; see {tmp_path / 'haswell.log'}"


def test_errors_of_types_are_failures(runs, tmp_path, capsys):
    started, ends = runs
    error = "loaded_tca/errors.py:1: error: Module has no attribute"
    ends += [("", f"{error}\nFound 1 error\n", 1), ("", "Success: no issues found\n", 0)]
    assert main(["win32", "darwin", "--folder", str(tmp_path)]) == 1
    _, first, second, name = capsys.readouterr().out.splitlines()
    assert first.split()[:4] == ["win32", "0", "1", "0"]
    assert second.split()[:4] == ["darwin", "1", "0", "0"]
    assert name == f"win32: {error}"
    assert [line[1:3] for line, _ in started] == [["-m", "tests.annotations"]] * 2
    assert [line[3:5] for line, _ in started] == [["--platform", "win32"], ["--platform", "darwin"]]


def test_environments_are_made_once_and_again_for_other_requirements(runs, tmp_path, monkeypatch):
    started, ends = runs
    monkeypatch.setattr(machines, "_uv", lambda *_: "uv")
    monkeypatch.setattr(machines, "_python", lambda version: f"python{version}")
    root = tmp_path / "project"
    root.mkdir()
    (root / "pyproject.toml").write_text("first", encoding="utf-8")
    monkeypatch.setattr(machines, "ROOT", root)
    place = tmp_path / "lowest"
    place.mkdir()  # as uv would
    python = str(place / "bin" / "python")
    made = [
        ["uv", "venv", "--seed", "--clear", "--python", "python3.11", str(place)],
        ["uv", "pip", "install", "--python", python, "--resolution", "lowest-direct", "--editable", f"{root}[dev]"],
        ["uv", "pip", "list", "--python", python],
    ]
    for text, options, expected in (
        ("first", (), made),
        ("first", (), []),
        ("first", ("--renew",), made),
        ("second", (), made),
    ):
        (root / "pyproject.toml").write_text(text, encoding="utf-8")
        started.clear()
        ends += [("", "", 0)] * len(expected) + [(PASSED, "", 0)]
        assert main(["lowest", "--folder", str(tmp_path), *options]) == 0
        *before, test = [line for line, _ in started]
        assert before == expected
        assert test[:3] == [python, "-m", "pytest"]


def test_an_environment_that_cannot_be_made_is_a_failure(tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(CONFIGURATIONS, "python-2.9", Configuration(python="2.9"))
    monkeypatch.setattr(machines, "_uv", lambda *_: "uv")
    assert main(["python-2.9", "--folder", str(tmp_path)]) == 1
    assert "python-2.9: no environment: no Python 2.9 on this machine" in capsys.readouterr().out


def test_python_that_runs_serves_for_its_version():
    version = ".".join(map(str, sys.version_info[:2]))
    code = "import sys; print('%d.%d' % sys.version_info[:2])"
    done = subprocess.run([machines._python(version), "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == version


def test_in_the_background_interrupts_are_ignored(tmp_path):
    start = command("background", Path(sys.executable), tmp_path, [])
    start = start[: start.index(sys.executable)]
    code = "import signal; print(signal.getsignal(signal.SIGINT) == signal.SIG_IGN)"
    done = subprocess.run([*start, sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "True\n"


def test_other_processes_keep_every_core_busy_and_end(monkeypatch):
    processes = []
    start = subprocess.Popen
    monkeypatch.setattr(machines.os, "cpu_count", lambda: 2)
    monkeypatch.setattr(machines.subprocess, "Popen", lambda *given: processes.append(start(*given)) or processes[-1])
    with machines._busy_cores(True):
        assert [process.poll() for process in processes] == [None, None]
    assert all(process.poll() is not None for process in processes)
    with machines._busy_cores(False):
        assert len(processes) == 2


@pytest.mark.parametrize(
    ("kernels", "other"),
    [({"SkylakeX"}, "Haswell"), ({"Haswell"}, "Nehalem"), ({"Zen"}, "Nehalem"), ({"Haswell", "SkylakeX"}, "Nehalem")],
)
def test_other_kernel_is_none_that_the_machine_takes(kernels, other, monkeypatch, capsys):
    monkeypatch.setattr(machines, "_kernels", lambda: kernels)
    assert main(["--other-kernel"]) == 0
    assert capsys.readouterr().out == f"{other}\n"


def test_kernels_are_those_of_numpy_and_scipy():
    code = "import scipy.linalg, tests.machines as m; print(*m._kernels())"
    variables = os.environ | {"OPENBLAS_CORETYPE": "Nehalem", "PYTHONPATH": str(machines.ROOT)}
    done = subprocess.run([sys.executable, "-c", code], env=variables, capture_output=True, text=True, check=True)
    if machine() == "x86_64":
        assert done.stdout == "Nehalem\n"


def test_unknown_configurations_are_refused(capsys):
    with pytest.raises(SystemExit) as refused:
        main(["z80"])
    assert refused.value.code == 2
    assert "no configuration z80; there are two-workers, one-worker, haswell" in capsys.readouterr().err
