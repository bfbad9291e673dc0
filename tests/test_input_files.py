"""What is read: regular files of a bounded size. Anything else is refused before it is opened."""

import builtins
import io
import os
from pathlib import Path

import pytest

from loaded_tca import load_result, read_scene
from loaded_tca.errors import InputError
from loaded_tca.flanks.topography import read_topography
from loaded_tca.studies import Study, load_design, load_study, read_study, run_study
from tests.samples.studies import HELICAL, crowning, helical

pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="a system without named pipes")
NAME = "input"


def study_with_table(path):
    study = path.with_name("study.toml")
    study.write_text(f'scene = "{HELICAL}"\ntable = "{path.name}"\n')
    return lambda: read_study(study)


def study_with_rows(path):
    path.rename(path.with_name("study.rows.jsonl"))
    return lambda: run_study(
        Study(helical(), {"mounting.misalignment_um": [1.0]}), out=path.with_name("study.nc"), figures=crowning
    )


READERS = {
    "scene": lambda path: lambda: read_scene(path),
    "flank": lambda path: lambda: read_topography(path),
    "result": lambda path: lambda: load_result(path),
    "study": lambda path: lambda: read_study(path),
    "result of a study": lambda path: lambda: load_study(path),
    "design": lambda path: lambda: load_design(path),
    "table of a study": study_with_table,
    "rows of a study": study_with_rows,
}


def a_pipe(path):
    os.mkfifo(path)


def a_device(path):
    path.symlink_to("/dev/zero")


@pytest.fixture
def closed(monkeypatch):
    """Call it, and no file whose name is that of the input is opened any more: a pipe or device would never end."""

    def close():
        for module in (builtins, io):
            opened = module.open

            def refusing(name, *arguments, opened=opened, **more):
                assert Path(os.fsdecode(name)).name not in (NAME, "study.rows.jsonl", "scene.toml"), "opened"
                return opened(name, *arguments, **more)

            monkeypatch.setattr(module, "open", refusing)

    return close


@pytest.mark.parametrize("other", [a_pipe, a_device])
@pytest.mark.parametrize("reader", READERS)
def test_what_is_no_regular_file_is_refused_unopened(tmp_path, closed, reader, other):
    path = tmp_path / NAME
    other(path)
    read = READERS[reader](path)
    closed()
    with pytest.raises(InputError, match="cannot be read: not a regular file; give the name of a file"):
        read()


@pytest.mark.parametrize("reader", [reader for reader in READERS if reader != "rows of a study"])
def test_file_that_is_too_long_is_refused_unread(tmp_path, reader):
    """A terabyte that takes no room on the disk."""
    path = tmp_path / NAME
    with open(path, "wb") as file:
        try:
            os.truncate(file.fileno(), 2**40)
        except OSError:
            pytest.skip("a file system without holes in files")
    with pytest.raises(InputError, match=rf"{NAME}: more than \d+ bytes; no .* is so long"):
        READERS[reader](path)()


@pytest.mark.parametrize("command", ["run", "check", "study", "ease-off", "plot", "tooth", "dynamics", "report"])
def test_command_refuses_a_pipe_in_one_line(tmp_path, closed, refused, command):
    path = tmp_path / NAME
    a_pipe(path)
    more = ["--out", tmp_path / "out"] if command in ("run", "study", "ease-off") else []
    closed()
    assert refused(command, path, *more) == f"{path}: cannot be read: not a regular file; give the name of a file"
    assert os.listdir(tmp_path) == [NAME]


def test_demo_refuses_a_pipe_in_the_place_of_its_scene(tmp_path, closed, refused):
    path = tmp_path / "scene.toml"
    a_pipe(path)
    closed()
    assert refused("demo", "--out", tmp_path) == f"{path}: cannot be read: not a regular file; give the name of a file"
