"""What the command shows where: lines as wide as the terminal, nothing if it is quiet, exit codes, completion."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from loaded_tca import cli
from loaded_tca.cli import terminal
from loaded_tca.cli.arguments import EXIT_CODES
from tests.samples.results import SCENES

ROOT = Path(__file__).parents[1]
SPUR = SCENES / "spur.toml"


def numbers(text):
    return re.findall(r"[-+]?\d+\.\d+", text)


@pytest.mark.parametrize("width", [40, 59, 80])
def test_table_fits_the_terminal_and_no_number_is_cut(monkeypatch, capsys, width):
    monkeypatch.setattr(terminal, "width_of_lines", lambda: width)
    table = "\n".join(f"label of row {k:<12}" + "".join(f"{k + 0.1234 * n:>14.4f}" for n in range(6)) for k in range(3))
    terminal.show(table)
    shown = capsys.readouterr().out
    assert max(map(len, shown.splitlines())) <= width
    assert numbers(shown) == numbers(table)
    places = [[match.end() for match in re.finditer(r"\d+\.\d+", line)] for line in shown.splitlines()]
    rows = len(places) // 3
    assert places[:rows] == places[rows : 2 * rows] == places[2 * rows :]  # what stands in a column stays in one


def test_sentences_break_at_blanks_on_a_terminal_and_stay_whole_in_a_file():
    sentence = "the 1.25 MPa of a long sentence " * 4
    assert terminal.fitted(sentence, 40, sentences=False) == sentence
    lines = terminal.fitted(sentence, 40, sentences=True).splitlines()
    assert max(map(len, lines)) <= 40
    assert " ".join(" ".join(lines).split()) == sentence.strip()


def test_lines_are_as_wide_as_the_terminal_and_those_of_a_page_without_one(monkeypatch):
    assert terminal.width_of_lines() == 120
    monkeypatch.setattr("sys.stdout.isatty", lambda: True, raising=False)
    for columns, width in (("93", 93), ("7", terminal.LEAST_WIDTH)):
        monkeypatch.setenv("COLUMNS", columns)
        assert terminal.width_of_lines() == width


def test_quiet_command_shows_warnings_alone(run):
    """Before or behind the name of the command; what is no overview is written all the same."""
    noisy = "check", SPUR, "--set", "pinion.face_width_mm=0.5", "--set", "wheel.face_width_mm=0.5"
    code, out, errors = run(*noisy)
    warned = [line for line in out.splitlines() if line.startswith("warning: ")]
    assert (code, errors) == (0, [])
    assert run(*noisy, "--quiet") == run("--quiet", *noisy) == (0, "", warned)
    assert warned


def test_quiet_command_tells_what_is_wrong(run):
    code, out, errors = run("check", SPUR, "--set", "pinion.teth=3", "--quiet")
    assert (code, out, len(errors)) == (2, "", 1)


def test_quiet_command_draws_no_bar(monkeypatch, capsys):
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    with terminal.quiet(True), terminal.bar_of("variants", 3, terminal.BAR) as bar:
        assert bar is None
    with terminal.bar_of("variants", 3, terminal.BAR) as bar:
        assert bar is not None
    assert "variants" in capsys.readouterr().err


def test_help_has_all_exit_codes(capsys):
    with pytest.raises(SystemExit, match="0"):
        cli.main(["--help"])
    text = capsys.readouterr().out
    for code, meaning in EXIT_CODES.items():
        assert f"  {code:<4} {meaning}\n" in text
    assert (cli.OK, cli.FAULT, cli.BAD_INPUT, cli.NO_CONVERGENCE, cli.INTERRUPTED) == (0, 1, 2, 3, 130)


def completion(shell, capsys):
    pytest.importorskip("shtab")
    with pytest.raises(SystemExit, match="0"):
        cli.main(["--print-completion", shell])
    return capsys.readouterr().out


@pytest.mark.skipif(shutil.which("bash") is None, reason="no bash")
@pytest.mark.parametrize(
    ("words", "proposed"),
    [
        (["ch"], {"check"}),
        (["check", "--o"], {"--out"}),
        (["vh", "--gear", "p"], {"pinion"}),
        (["check", "REA"], {"README.md"}),
    ],
)
def test_bash_completes_commands_options_choices_and_files(capsys, tmp_path, words, proposed):
    script = tmp_path / "completion"
    script.write_text(completion("bash", capsys), encoding="utf-8")
    line = " ".join(["loaded-tca", *words])
    asks = f"""source {script}
        COMP_WORDS=({line}); COMP_CWORD={len(words)}; COMP_LINE='{line}'; COMP_POINT=${{#COMP_LINE}}
        complete -p loaded-tca | sed -E 's/.*-F ([^ ]+) .*/\\1/' > {tmp_path}/name
        $(cat {tmp_path}/name) loaded-tca {words[-1]} {line.split()[-2]}
        printf '%s\\n' "${{COMPREPLY[@]}}"
    """
    ended = subprocess.run(["bash", "-c", asks], capture_output=True, text=True, cwd=ROOT, env={**os.environ})
    assert ended.returncode == 0, ended.stderr
    assert set(ended.stdout.split()) == proposed


def test_zsh_has_a_completion(capsys):
    text = completion("zsh", capsys)
    assert text.startswith("#compdef loaded-tca")
    assert "check:" in text


def test_completion_without_its_package_is_refused(refused, monkeypatch):
    monkeypatch.setitem(sys.modules, "shtab", None)
    message = refused("--print-completion", "bash")
    assert message == "--print-completion: needs the package shtab; 'pip install shtab' gets it"
