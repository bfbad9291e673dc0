import csv
import io
import json
import math
import os
import signal
import subprocess
import sys
import time
import warnings
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest

import loaded_tca.analysis
import loaded_tca.plots
from loaded_tca import cli, load_result, read_scene
from loaded_tca.errors import AccuracyWarning, ConvergenceError, GeometryError, InputError
from loaded_tca.flank_maps.ease_off_map import ease_off_map
from loaded_tca.machine_speed import MachineSpeed
from loaded_tca.threads import jobs

SCENES = Path(__file__).parents[1] / "examples" / "scenes"
HELICAL = str(SCENES / "helical.toml")
REPORT = {"result.nc", "summary.json", "positions.csv"}
LONG = 300 * "a"
HANGS = 600
"""Seconds after which a process is taken to hang: beside others it is slow."""
ONE_PAIR = '\nload_sharing = false\ncompliance = "contact"\nfree_edges = false\n'
PICTURES = {"contact_path.png", "transmission_error.png", "peak_pressure.png", "pressure_map.png"}


@pytest.fixture(autouse=True)
def _in_an_empty_directory(tmp_path, monkeypatch):
    """On a machine of usual speed: a slow or busy one tells the time of small scenes, too."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("loaded_tca.effort.machine_speed", lambda: MachineSpeed(np.array(1.0), np.array(1.0)))


def scene(name="quick", **changes):
    """A scene file that takes a moment, with other values where asked."""
    text = (SCENES / "helical.toml").read_text(encoding="utf-8")
    quick = {"positions = 21": "positions = 3", "accuracy = 1e-3": f"cells = [16, 16]{ONE_PAIR}"}
    changes = {**quick, "pinion_torque_Nm = 130.0": "pinion_torque_Nm = 40.0", **changes}
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    path = Path(f"{name}.toml")
    path.write_text(text, encoding="utf-8")
    return path


def fail_with(monkeypatch, error):
    def analyse(*_, **__):
        raise error

    monkeypatch.setattr(loaded_tca.analysis, "analyse", analyse)


@pytest.mark.thorough
@pytest.mark.usefixtures("blank_pictures")
def test_demo_needs_no_file_and_tells_what_to_try_next(run):
    """And has nothing to warn of; with its pictures, too: tests/test_release.py."""
    code, out, err = run("demo")
    assert (code, err) == (0, [])
    assert "note:" not in out
    assert set(os.listdir("loaded-tca-demo")) >= REPORT | PICTURES | {"scene.toml"}
    assert "peak pressure [MPa]" in out
    assert out.rstrip().endswith("loaded-tca run loaded-tca-demo/scene.toml --out my-pair")
    assert run("demo")[0] == 0


@pytest.mark.parametrize("count", ["0", "-2", "many"])
def test_jobs_are_whole_numbers_from_one(refused, monkeypatch, count):
    assert refused("run", HELICAL, "--out", "out", "--jobs", count).startswith(f"argument --jobs: '{count}': allowed")
    monkeypatch.setenv("LOADED_TCA_JOBS", count)
    message = refused("run", HELICAL, "--out", "out")
    assert message == f"LOADED_TCA_JOBS: '{count}': allowed a whole number from 1"
    assert not os.listdir()


def test_command_does_as_many_jobs_as_its_option_says(monkeypatch):
    """Whatever the environment says, and no more once it has ended."""
    asked = []
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1, 2}, raising=False)
    monkeypatch.setattr(cli.commands, "run", lambda _: asked.append(jobs()))
    for options in ((), ("--jobs", "2")):
        assert cli.main(["run", HELICAL, "--out", "out", *options]) == 0
    assert (asked, jobs()) == ([1, 2], 1)


@pytest.mark.thorough
@pytest.mark.usefixtures("blank_pictures")
def test_demo_goes_where_it_is_told(run):
    code, out, _ = run("demo", "--out", "else/where")
    assert code == 0
    assert os.listdir() == ["else"]
    assert out.rstrip().endswith("loaded-tca run else/where/scene.toml --out my-pair")


def test_demo_does_not_replace_a_changed_scene(refused):
    changed = Path("loaded-tca-demo") / "scene.toml"
    changed.parent.mkdir()
    changed.write_text("title = 'mine'")
    assert "scene.toml: has been changed, and the demo would replace it" in refused("demo")
    assert changed.read_text() == "title = 'mine'"


def test_run_writes_report_and_pictures_and_shows_the_summary(run):
    code, out, _ = run("run", scene(), "--out", "new/place")
    assert code == 0
    assert set(os.listdir("new/place")) == REPORT | PICTURES
    assert out.startswith("Crowned helical pair 34/57\n3 positions")
    assert "Written to new/place: result.nc" in out


@pytest.mark.usefixtures("blank_pictures")
def test_run_takes_single_changes_of_the_scene(run):
    """The result keeps the changed scene, as it is checked and computed."""
    wanted = {"pinion.modifications.lead_crowning_um": "6", "pinion.hand": "left", "analysis.cells": "[8, 16]"}
    changes = [part for key, value in wanted.items() for part in ("--set", f"{key}={value}")]
    assert run("run", scene(), "--out", "out", *changes, "--set", "title = a = b")[0] == 0
    kept = load_result("out/result.nc").scene
    assert kept == read_scene("quick.toml").with_changes(
        {
            "pinion.modifications.lead_crowning_um": 6.0,
            "pinion.hand": "left",
            "analysis.cells": (8, 16),
            "title": "a = b",
        }
    )
    assert read_scene("quick.toml").pinion.modifications.lead_crowning_um != 6.0


@pytest.mark.quick_cases("command0")
@pytest.mark.parametrize("command", [["check"], ["ease-off", "--out", "maps"]])
def test_other_commands_take_changes_of_the_scene_too(run, command):
    code, out, err = run(*command, scene(), "--set", "pinion.teeth=33", "--set", "title=another pair")
    assert (code, err) == (0, [])
    assert ("another pair" in out) == (command == ["check"])


def test_every_change_that_cannot_be_made_is_told(run):
    code, _, err = run("check", scene(), *("--set=pinion.teth=35", "--set=load.pinion_torque_Nm=much", "--set=wheel=3"))
    assert code == 2
    assert err == [
        'loaded-tca: pinion.teth: unknown key; did you mean "pinion.teeth"?',
        "loaded-tca: wheel: found 3; allowed a section [wheel]",
        'loaded-tca: load.pinion_torque_Nm: found "much"; allowed a number from 0 to 1e9',
    ]


@pytest.mark.parametrize("change", ["pinion.teeth", "=3", ""])
def test_a_change_without_key_or_value_is_refused(refused, change):
    told = f"--set: {change!r} is not KEY=VALUE, for instance pinion.teeth=21"
    assert told in refused("check", scene(), "--set", change)


@pytest.mark.usefixtures("blank_pictures")
def test_plot_draws_a_result_again(run):
    run("run", scene(), "--out", "out")
    for picture in PICTURES:
        Path("out", picture).unlink()
    assert run("plot", "out")[0] == 0
    assert set(os.listdir("out")) == REPORT | PICTURES
    assert run("plot", "out/result.nc", "--out", "elsewhere")[0] == 0
    assert set(os.listdir("elsewhere")) == PICTURES


@pytest.mark.usefixtures("blank_pictures")
def test_run_leaves_no_file_of_an_earlier_result_and_each_of_the_user(run):
    """Of other commands, too, and those of parts; what has another name is the user's."""
    old = "pressure_map_hertz.png", "sensitivities.nc", "tornado.png", "tribology.csv", "dynamics_orders.csv"
    old += "report.html", "at_a_glance.pdf", "position_2/teeth.png", "torque_20_Nm_position_2/wheel.stl"
    users = "notes.txt", "position_2_notes/teeth.png", "torque_20_Nm/notes.txt", "loads/sensitivities.csv"
    for name in (*old, *users, "torque_20_Nm/sensitivities.csv"):
        Path("out", name).parent.mkdir(parents=True, exist_ok=True)
        Path("out", name).write_bytes(b"old")
    assert run("run", scene(), "--out", "out")[0] == 0
    directories = {"position_2_notes", "torque_20_Nm", "loads"}
    assert set(os.listdir("out")) == REPORT | PICTURES | {"notes.txt"} | directories
    assert all(Path("out", name).read_bytes() == b"old" for name in users)
    assert os.listdir("out/torque_20_Nm") == ["notes.txt"]


@pytest.mark.parametrize(
    ("command", "file", "kind"),
    [
        ("run", "study.nc", "a study"),
        ("run", "comparison.json", "a comparison of results"),
        ("run --coast", "result.nc", "a result"),
        ("demo", "stage.nc", "a stage"),
    ],
)
def test_result_goes_into_no_directory_of_something_else(refused, command, file, kind):
    Path("out").mkdir()
    Path("out", file).write_bytes(b"old")
    name, *more = command.split()
    told = refused(name, *([] if name == "demo" else [scene()]), "--out", "out", *more)
    assert f"--out out: holds {kind} ({file}); give another directory" in told
    assert Path("out", file).read_bytes() == b"old"


@pytest.mark.thorough
def test_plot_draws_another_torque_and_position(run, refused, request):
    changes = {"positions = 21": "positions = 3\ntorques_Nm = [20.0, 40.0]"}
    run("run", scene(**changes), "--out", "out")
    before = Path("out", "pressure_map.png").read_bytes()
    Path("out", "pressure_map_edge.png").write_bytes(b"of the largest torque")
    own = {"torque_20_Nm_position_2", "torque_20_Nm", "position_2"}
    for options in (("--torque", 20, "--position", 2), ("--torque", 20), ("--position", 2)):
        assert run("plot", "out", *options)[0] == 0
        request.getfixturevalue("blank_pictures")  # of the others only the names are asked for
    assert set(os.listdir("out")) == REPORT | PICTURES | own | {"pressure_map_edge.png"}
    assert Path("out", "pressure_map.png").read_bytes() == before
    assert Path("out", "torque_20_Nm_position_2", "pressure_map.png").read_bytes() != before
    for wrong, told in ((("--torque", 30), "the result has 20, 40 N m"), (("--position", 4), "positions 1 to 3")):
        assert told in refused("plot", "out", *wrong)


def test_check_shows_the_geometry_and_writes_nothing(run):
    code, out, err = run("check", HELICAL)
    assert (code, err, os.listdir()) == (0, [], [])
    rows = {line[:44].strip(): line[44:].split() for line in out.splitlines()[1:]}
    assert rows["working pressure angle alpha_wt [deg]"] == ["20.6469"]
    assert rows["base helix angle beta_b [deg]"] == ["14.0761"]
    assert rows["hand of the helix"] == ["right", "left"]
    assert rows["transverse contact ratio eps_alpha"] == ["1.6445"]
    assert rows["start of active profile d_Nf [mm]"] == ["101.1985", "172.4189"]
    assert rows["root form diameter d_Ff [mm]"] == ["100.8631", "171.7720"]


def test_check_tells_teeth_that_overlap(run):
    changes = {"helix_angle_deg = 15.0": "helix_angle_deg = 15.0\ncentre_distance_mm = 141.3"}
    assert "(at the centre distance of 141.3000 mm by 0.01" in run("check", scene(**changes))[1]


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["straight_bevel", "spiral_bevel"])
def test_bevel_scene_is_run_and_drawn_as_any_other(run, name, request):
    text = (SCENES / f"{name}.toml").read_text(encoding="utf-8")
    text = text.replace("positions = 21", f"positions = 2\ncells = [16, 16]{ONE_PAIR}")
    Path("quick.toml").write_text(text, encoding="utf-8")
    code, _, err = run("run", "quick.toml", "--out", "out")
    assert (code, err) == (0, [])
    assert set(os.listdir("out")) == REPORT | PICTURES
    request.getfixturevalue("blank_pictures")
    assert run("plot", "out", "--position", 1, "--out", "again")[0] == 0
    assert set(os.listdir("again")) == PICTURES


@pytest.mark.thorough
def test_check_of_a_spur_pair_names_no_hand(run):
    assert "none          none" in run("check", SCENES / "spur.toml")[1]


@pytest.mark.thorough
@pytest.mark.usefixtures("blank_pictures")
def test_edge_contact_warns_once_and_exits_0(run):
    text = (SCENES / "misaligned.toml").read_text(encoding="utf-8").replace("positions = 21", "positions = 3")
    Path("edge.toml").write_text(text, encoding="utf-8")
    code, out, err = run("run", "edge.toml", "--out", "out")
    assert code == 0
    assert all(line.startswith("warning: ") for line in err)
    assert sum("edge of a flank" in line for line in err) == 1
    assert "note: at 3 of 3 positions the contact reaches an edge" in out
    assert not {*err} & {*out}  # each line once, on a terminal


@pytest.mark.usefixtures("blank_pictures")
def test_no_load_exits_0(run):
    changes = {"pinion_torque_Nm = 130.0": "pinion_torque_Nm = 0.0"}
    assert run("run", scene(**changes), "--out", "out")[0] == 0
    (figures,) = json.loads(Path("out/summary.json").read_text())["torques"]
    assert figures["peak_pressure_MPa"] == 0.0


def test_equal_warnings_are_told_once_with_their_count(run, monkeypatch):
    def analyse(*_, **__):
        for _ in range(3):
            warnings.warn("a doubt\nin two lines", AccuracyWarning, stacklevel=1)
        raise GeometryError("no common flank")

    monkeypatch.setattr(loaded_tca.analysis, "analyse", analyse)
    code, _, err = run("run", scene(), "--out", "out")
    assert code == 2
    assert err == ["warning: a doubt in two lines", "loaded-tca: no common flank"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "the following arguments are required: COMMAND; see 'loaded-tca --help'"),
        (["paint"], "'paint'"),
        (["run", HELICAL], "the following arguments are required: --out; see 'loaded-tca run --help'"),
        (["check", HELICAL, "--fast"], "unrecognized arguments: --fast; see 'loaded-tca --help'"),
        (["check", "absent.toml"], "absent.toml: cannot be read: No such file or directory"),
        (["run", "absent.toml", "--out", "out"], "absent.toml: cannot be read: No such file or directory"),
        (["check", SCENES], "cannot be read: Is a directory"),
        (["check", __file__], "not a TOML file"),
        (["plot", "absent.nc"], "absent.nc: cannot be read: No such file or directory"),
        (["plot", "."], "result.nc: cannot be read: No such file or directory"),
        (["plot", HELICAL], "not a NetCDF-3 file; expected a result file written by loaded_tca"),
        (["run", HELICAL, "--out", __file__], "is a file; give a directory"),
        (["run", HELICAL, "--out", f"{__file__}/below"], "is a file; give a directory"),
        (["run", HELICAL, "--out", ""], "argument --out: the name is empty"),
        (["demo", "--out", ""], "argument --out: the name is empty"),
        (["plot", ""], "argument DIR|FILE: the name is empty"),
        (["run", HELICAL, "--out", LONG], "cannot be made a directory: File name too long"),
        (["run", HELICAL, "--out", f"absent/{LONG}"], "cannot be made a directory: File name too long"),
        (["ease-off", HELICAL, "--out", LONG], "cannot be made a directory: File name too long"),
        (["demo", "--out", LONG], "cannot be made a directory: File name too long"),
        (["check", LONG], "cannot be read: File name too long"),
        (["plot", LONG], "cannot be read: File name too long"),
    ],
)
def test_bad_input_is_told_in_one_line(refused, arguments, message):
    assert message in refused(*arguments)
    assert os.listdir() == []


@pytest.mark.parametrize("place", ["link", "link/below"])
def test_link_that_leads_nowhere_is_told_before_the_analysis(refused, monkeypatch, place):
    Path("link").symlink_to("nowhere")
    fail_with(monkeypatch, AssertionError("has started"))
    assert refused("run", scene(), "--out", place).endswith("link is a link that leads nowhere; give a directory")


def test_every_problem_of_a_scene_gets_its_line(run):
    changes = {"teeth = 34": "teeth = 2", "poisson_ratio = 0.3": "poison_ratio = 0.3"}
    code, _, err = run("check", scene(**changes))
    assert code == 2
    assert len(err) == 3
    assert any('did you mean "material.poisson_ratio"' in line for line in err)
    assert any("pinion.teeth" in line for line in err)


def test_pair_that_cannot_mesh_is_bad_input(refused):
    changes = {"helix_angle_deg = 15.0": "helix_angle_deg = 15.0\ncentre_distance_mm = 500.0"}
    assert "no common flank" in refused("check", scene(**changes))


def test_grid_too_large_for_the_memory_is_refused_with_its_size(run):
    changes = {"accuracy = 1e-3": "cells = [16384, 16384]", "positions = 21": "positions = 1"}
    code, _, err = run("run", scene(**changes), "--out", "out")
    if code == 0:
        pytest.skip("this machine has the memory")
    assert code == 2
    assert len(err) == 1
    assert "16384" in err[0]
    assert "GB" in err[0] or "GiB" in err[0]
    assert not Path("out").exists()


@pytest.mark.parametrize(
    ("error", "code", "line"),
    [
        (ConvergenceError("residual 1e-3 after 500 iterations"), 3, "residual 1e-3 after 500 iterations"),
        (GeometryError("pinion: undercut\nat 5 mm"), 2, "pinion: undercut at 5 mm"),
        (InputError("load: -1 N is negative"), 2, "load: -1 N is negative"),
        (MemoryError(), 2, "out of memory; ask for fewer analysis.cells"),
        (KeyboardInterrupt(), 130, "interrupted; no file is half written"),
        (ZeroDivisionError("division by zero"), 1, "a fault of the program"),
    ],
)
def test_each_failure_has_its_exit_code_and_one_line(run, monkeypatch, error, code, line):
    fail_with(monkeypatch, error)
    found, out, err = run("run", scene(), "--out", "out")
    assert (found, out) == (code, "")
    assert len(err) == 1
    assert line in err[0]
    assert not Path("out").exists()


@pytest.mark.parametrize("arguments", [["--traceback", "run"], ["run", "--traceback"]])
def test_traceback_is_shown_when_asked_for(run, monkeypatch, arguments):
    fail_with(monkeypatch, ConvergenceError("not converged"))
    code, _, err = run(*arguments, scene(), "--out", "out")
    assert code == 3
    assert err[0] == "Traceback (most recent call last):"
    assert err[-1] == "loaded-tca: not converged"


@pytest.mark.quick_cases("failure0-130")
@pytest.mark.usefixtures("blank_pictures")
@pytest.mark.parametrize(
    ("failure", "code"), [(KeyboardInterrupt(), 130), (MemoryError(), 2), (OSError(28, "No space left on device"), 2)]
)
def test_failure_while_drawing_leaves_the_numbers_without_old_pictures(run, monkeypatch, failure, code):
    changes = {"pinion_torque_Nm = 130.0": "pinion_torque_Nm = 20.0"}
    assert run("run", scene("earlier", **changes), "--out", "out")[0] == 0
    earlier = Path("out", "result.nc").read_bytes()

    def fail_at_the_third(picture, **_):
        drawn.append(picture)
        if len(drawn) == 3:
            raise failure
        return b"a picture"

    drawn = []
    with monkeypatch.context() as patch:
        patch.setattr("loaded_tca.plots.style._png_content", fail_at_the_third)
        found, _, err = run("run", scene(), "--out", "out")
    assert found == code
    assert err[-1] == "loaded-tca: out: the numbers are new, all pictures are missing: 'loaded-tca plot out' draws them"
    assert set(os.listdir("out")) == REPORT
    assert Path("out", "result.nc").read_bytes() != earlier
    assert run("plot", "out")[0] == 0
    assert set(os.listdir("out")) == REPORT | PICTURES


@pytest.mark.thorough
@pytest.mark.usefixtures("blank_pictures")
def test_failure_while_drawing_again_keeps_the_pictures(run, monkeypatch):
    run("run", scene(), "--out", "out")
    before = {name: Path("out", name).read_bytes() for name in os.listdir("out")}
    monkeypatch.setattr("loaded_tca.plots.style._png_content", lambda *_, **__: os.kill(os.getpid(), signal.SIGINT))
    for command in ("plot", "subsurface", "tooth"):
        assert run(command, "out")[0] == 130
        assert {name: Path("out", name).read_bytes() for name in os.listdir("out")} == before


@pytest.mark.thorough
@pytest.mark.usefixtures("blank_pictures")
def test_parts_of_a_result_do_not_replace_the_files_of_the_whole(run):
    run("run", scene(), "--out", "out")
    assert run("subsurface", "out")[0] == run("tooth", "out")[0] == 0
    before = {name: Path("out", name).read_bytes() for name in os.listdir("out")}
    for command, *options, place in (
        ("tooth", "--position", 2, "position_2"),
        ("tooth", "--torque", 40, "torque_40_Nm"),
        ("subsurface", "--position", 3, "position_3"),
        ("subsurface", "--gear", "wheel", "--pair", 0, "pair_0_below_wheel"),
    ):
        code, out, _ = run(command, "out", *options)
        assert code == 0
        assert f"Written to out/{place}: " in out
    places = {"position_2", "torque_40_Nm", "position_3", "pair_0_below_wheel"}
    assert set(os.listdir("out")) == {*before, *places}
    assert {name: Path("out", name).read_bytes() for name in before} == before
    assert set(os.listdir("out/position_3")) == {name for name in before if name.startswith("subsurface")}


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.mark.thorough
@pytest.mark.usefixtures("blank_pictures")
def test_progress_is_shown_on_a_terminal_only(run, monkeypatch):
    assert run("run", scene(), "--out", "out")[2] == []
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    assert cli.main(["run", str(scene()), "--out", "out"]) == 0
    assert "positions: 100%" in terminal.getvalue()
    assert "3/3" in terminal.getvalue()
    assert "gone, 00:00 left" in terminal.getvalue()


def test_progress_counts_torques_and_positions(monkeypatch):
    changes = {"positions = 21": "positions = 3\ntorques_Nm = [20.0, 40.0]"}
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setattr("loaded_tca.plots.plot_all", lambda *_: ())
    assert cli.main(["run", str(scene(**changes)), "--out", "out"]) == 0
    shown = terminal.getvalue()
    assert "2 torques x 3 positions: 100%" in shown
    assert "0/6" in shown
    assert "6/6" in shown


@pytest.mark.thorough
@pytest.mark.usefixtures("blank_pictures")
def test_estimate_is_told_on_a_terminal_and_where_an_analysis_is_long(run, monkeypatch):
    assert run("run", scene(), "--out", "out")[2] == []
    monkeypatch.setattr(cli.terminal, "WORTH_TELLING", 0.0)
    (told,) = run("run", scene(), "--out", "out")[2]
    assert told.startswith("loaded-tca: 3 contacts of 256 cells: roughly 0.4")
    monkeypatch.setattr(cli.terminal, "WORTH_TELLING", math.inf)
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    assert cli.main(["run", str(scene()), "--out", "out"]) == 0
    assert told in terminal.getvalue()


def test_bar_is_drawn_again_while_a_contact_takes_long(monkeypatch):
    terminal = Terminal()

    def analyse(*_, **__):
        shown = len(terminal.getvalue())
        while terminal.getvalue().count(" gone", shown) < 3:  # the bar of tqdm stands still between two positions
            time.sleep(0.01)
        raise GeometryError("enough")

    monkeypatch.setattr(cli.terminal, "TICK", 0.02)
    monkeypatch.setattr(loaded_tca.analysis, "analyse", analyse)
    monkeypatch.setattr(sys, "stderr", terminal)
    assert cli.main(["run", str(scene()), "--out", "out"]) == 2


def test_version_is_that_of_the_package(capsys):
    with pytest.raises(SystemExit) as caught:
        cli.main(["--version"])
    assert caught.value.code == 0
    assert capsys.readouterr().out == f"loaded-tca {version('loaded_tca')}\n"


def test_help_lists_every_file(capsys):
    with pytest.raises(SystemExit):
        cli.main(["run", "--help"])
    shown = capsys.readouterr().out
    names = [f"{name}.png" for name in loaded_tca.plots.PICTURES]
    assert all(name in shown for name in (*REPORT, "contacts.csv", *names))


@pytest.mark.parametrize("arguments", [["--help"], ["run", "--help"]])
def test_help_exits_0(arguments, capsys):
    with pytest.raises(SystemExit) as caught:
        cli.main(arguments)
    assert caught.value.code == 0
    assert "usage: loaded-tca" in capsys.readouterr().out


def command(*arguments, **environment):
    return subprocess.run(
        [sys.executable, "-m", "loaded_tca", *arguments],
        capture_output=True,
        env={**os.environ, **environment},
        check=False,
        timeout=HANGS,
    )


@pytest.mark.thorough
def test_title_that_the_terminal_cannot_show_is_no_failure():
    title = {'title = "Crowned helical pair 34/57"': 'title = "歯車"'}
    done = command("check", str(scene(**title)), PYTHONIOENCODING="ascii")
    assert done.returncode == 0
    assert b"\\u6b6f" in done.stdout


def test_process_ends_with_the_exit_code():
    done = command("check", "absent.toml")
    assert done.returncode == 2
    assert done.stderr.count(b"\n") == 1


WITHOUT_PICTURES = """
import sys
from types import SimpleNamespace
from loaded_tca.__main__ import main
nothing = SimpleNamespace(PICTURES=(), MORE_PICTURES=(), plot_all=lambda *_, **__: ())
sys.modules["loaded_tca.plots"] = nothing
sys.exit(main())
"""
"""A process that imports nothing to draw with."""


def command_of(*arguments):
    """The command; where it would draw, without the pictures, which take the most time."""
    start = ["-c", WITHOUT_PICTURES] if "run" in arguments else ["-m", "loaded_tca"]
    return [sys.executable, *start, *map(str, arguments)]


def in_a_shell(redirected, *arguments):
    """Exit code and lines of standard error of the command with its streams redirected by a shell."""
    command = ["sh", "-c", f'"$@" {redirected}', "sh", *command_of(*arguments)]
    done = subprocess.run(command, stderr=subprocess.PIPE, text=True, check=False, timeout=HANGS)
    return done.returncode, done.stderr.splitlines()


@pytest.mark.quick_cases("arguments1")
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="the system has no full device")
@pytest.mark.parametrize("arguments", [["check", HELICAL], ["--version"]])
def test_full_standard_output_is_told(arguments):
    told = ["loaded-tca: standard output: cannot be written: No space left on device"]
    assert in_a_shell("> /dev/full", *arguments) == (2, told)


@pytest.mark.thorough
@pytest.mark.parametrize("redirected", [">&-", "2>&- > /dev/null"])
def test_closed_standard_output_or_error_is_no_failure(redirected):
    assert in_a_shell(redirected, "check", HELICAL) == (0, [])


@pytest.mark.thorough
@pytest.mark.parametrize("redirected", ["2>&-", "2> /dev/full"])
def test_standard_error_that_cannot_be_written_leaves_the_exit_code(redirected):
    assert in_a_shell(redirected, "check", "absent.toml") == (2, [])


@pytest.mark.thorough
def test_closed_pipe_is_no_fault_of_a_command_that_draws_a_progress_bar():
    with subprocess.Popen(
        command_of("run", scene(), "--out", "out"), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        process.stdout.close()
        assert process.stderr.read() == ""
        assert process.wait() == 0


def test_file_that_the_system_does_not_give_is_no_fault(run, monkeypatch):
    fail_with(monkeypatch, PermissionError(13, "Permission denied", "scene.toml"))
    assert run("run", scene(), "--out", "out")[::2] == (2, ["loaded-tca: scene.toml: Permission denied"])


# Ease-off


@pytest.mark.thorough
@pytest.mark.parametrize("gear", ["pinion", "wheel"])
def test_ease_off_of_a_scene_is_drawn(run, gear):
    code, out, err = run("ease-off", scene(), "--out", "maps", "--gear", gear)
    assert (code, err) == (0, [])
    *numbers, files = out.splitlines()
    assert files == "Written to maps: ease_off.csv, ease_off.png"
    ease_off = ease_off_map(read_scene(scene()).pair(), gear)
    printed = {line[:34].strip(): float(line[34:]) for line in numbers}
    assert printed == pytest.approx(ease_off.named, rel=5e-3, abs=1e-3)  # three digits
    table = list(csv.DictReader(Path("maps/ease_off.csv").read_text().splitlines()))
    assert float(table[-1]["ease_off_um"]) == pytest.approx(1e3 * ease_off.corners[1, 1], rel=1e-6)
    assert Path("maps/ease_off.png").read_bytes().startswith(b"\x89PNG")


def test_ease_off_of_an_unknown_gear_is_refused(refused):
    assert "rack" in refused("ease-off", scene(), "--out", "maps", "--gear", "rack")
    assert not Path("maps").exists()
