"""What is released: a source archive, a wheel made of it, and the command that the wheel installs elsewhere."""

import os
import re
import subprocess
import sys
import tarfile
import tomllib
import venv
import zipfile
from email import message_from_bytes
from pathlib import Path

import hatchling.build
import pytest
from hatchling.builders.sdist import SdistBuilder

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
VERSION = PROJECT["version"]
SOURCES = {
    path.relative_to(ROOT).as_posix()
    for path in (ROOT / "loaded_tca").rglob("*")
    if path.is_file() and path.suffix != ".pyc"
}

ADDED = {"LICENSE", "pyproject.toml", ".gitignore"}
"""Files of the working copy that every source archive has, listed or not."""


def call(*command, cwd, silent=False):
    """Standard output of a command that knows nothing of the working copy; of a silent one the only output."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run([*map(str, command)], cwd=cwd, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert not (silent and done.stderr), done.stderr
    return done.stdout


def build(command, *arguments, cwd):
    """Archives built by the tools that are installed, without the network; ``dev`` of pyproject.toml has them."""
    environment = os.environ | {"SOURCE_DATE_EPOCH": "1700000000"}
    command = [sys.executable, "-c", command, *map(str, arguments)]
    done = subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.fixture(scope="module")
def archives(tmp_path_factory):
    """Source archive and wheel of the working copy, by the hooks that tools for building call, in one process."""
    folder = tmp_path_factory.mktemp("dist")
    hooks = "import sys; from hatchling.build import *; build_sdist(sys.argv[1]); build_wheel(sys.argv[1])"
    build(hooks, folder, cwd=ROOT)
    names = sorted(path.name for path in folder.iterdir())
    assert names == [f"loaded_tca-{VERSION}-py3-none-any.whl", f"loaded_tca-{VERSION}.tar.gz"]
    return folder / names[1], folder / names[0]


def contents(wheel):
    with zipfile.ZipFile(wheel) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


@pytest.mark.thorough
def test_wheel_has_every_file_of_the_package_and_nothing_else(archives):
    found = contents(archives[1])
    of_package = {name for name in found if not name.startswith(f"loaded_tca-{VERSION}.dist-info/")}
    assert of_package == SOURCES
    assert {"loaded_tca/demo.toml", "loaded_tca/py.typed"} <= of_package
    assert f"loaded_tca-{VERSION}.dist-info/licenses/LICENSE" in found


@pytest.mark.thorough
def test_wheel_of_the_source_archive_is_that_of_the_working_copy(archives, tmp_path):
    """By the tool that makes a source archive and of it the wheel."""
    command = "import sys; from build.__main__ import main; sys.exit(main(sys.argv[1:]))"
    build(command, "--no-isolation", "--outdir", tmp_path, ROOT, cwd=tmp_path)
    (wheel,) = tmp_path.glob("*.whl")
    assert contents(wheel) == contents(archives[1])


@pytest.fixture
def listed():
    """Files that the tool for building puts into the source archive, without those that it always adds."""
    return {file.distribution_path for file in SdistBuilder(str(ROOT)).recurse_included_files()}


def test_source_archive_has_what_the_tests_need_and_no_leftovers(listed):
    assert listed >= SOURCES | {"README.md", "CITATION.cff", "SECURITY.md", "conftest.py"}
    folders = {name.partition("/")[0] for name in listed if "/" in name}
    assert folders == {"loaded_tca", "tests", "validation", "examples", "docs"}
    assert [name for name in listed if name.endswith((".nc", ".pyc", ".inp", ".frd"))] == []
    tracked = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False).stdout.split()
    assert {name for name in tracked if (ROOT / name).exists()} - listed <= ADDED | {".ci/run"}


@pytest.mark.thorough
def test_source_archive_has_what_is_listed_and_what_its_tool_adds(listed, archives):
    with tarfile.open(archives[0]) as archive:
        assert {name.partition("/")[2] for name in archive.getnames()} == listed | ADDED | {"PKG-INFO"}


def test_metadata_are_complete(tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    folder = tmp_path / hatchling.build.prepare_metadata_for_build_wheel(str(tmp_path))
    told = message_from_bytes((folder / "METADATA").read_bytes())
    assert (told["Name"], told["Version"], told["License-Expression"]) == ("loaded_tca", VERSION, "BSD-3-Clause")
    licence = (ROOT / "LICENSE").read_text(encoding="utf-8")
    assert re.search(r"^Copyright \(c\) \d+, (.*)$", licence, re.MULTILINE)[1] == told["Author"]
    assert told["Description"] or told.get_payload().startswith("# loaded_tca")
    assert told["Requires-Python"] == ">=3.11"
    assert "Typing :: Typed" in told.get_all("Classifier")
    cited = dict(re.findall(r"^([\w-]+): (.+)$", (ROOT / "CITATION.cff").read_text(encoding="utf-8"), re.MULTILINE))
    assert (cited["cff-version"], cited["version"], cited["license"]) == ("1.2.0", VERSION, told["License-Expression"])


@pytest.mark.thorough
def test_installed_wheel_runs_the_demo_outside_of_the_repository(archives, tmp_path):
    """Installed by itself; what it depends on is lent by the running environment, read only after its own packages."""
    place = tmp_path / "installed"
    venv.create(place, symlinks=True)
    python = place / "bin" / "python"
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--python", python]
    call(*pip, "install", "--quiet", "--no-index", "--no-deps", archives[1], cwd=tmp_path)
    own = Path(call(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))", cwd=tmp_path).strip())
    lent = [path for path in sys.path if Path(path).name in ("site-packages", "dist-packages")]
    (own / "lent.pth").write_text("\n".join(lent) + "\n")
    where = call(python, "-c", "import loaded_tca.errors; print(loaded_tca.errors.__file__)", cwd=tmp_path).strip()
    assert Path(where) == own / "loaded_tca" / "errors.py"
    command = place / "bin" / "loaded-tca"
    assert call(command, "--version", cwd=tmp_path) == f"loaded-tca {VERSION}\n"
    assert "peak pressure [MPa]" in call(command, "demo", cwd=tmp_path, silent=True)
    script = "from loaded_tca import load_result; print(load_result('loaded-tca-demo/result.nc').version)"
    assert call(python, "-c", script, cwd=tmp_path).strip() == VERSION


def test_hooks_before_a_commit_are_the_lint_command():
    hooks = (ROOT / ".pre-commit-config.yaml").read_text(encoding="utf-8")
    rule = re.search(r"^lint:.*\n((?:\t.*\n)+)", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE)[1]
    wanted = [line.strip().replace("$(BIN)", ".venv/bin") for line in rule.splitlines()]
    assert re.findall(r"^ +entry: (.*)$", hooks, re.MULTILINE) == wanted
