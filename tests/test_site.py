"""The documentation site builds without a warning: every cross reference, picture and docstring of it resolves."""

import importlib.util
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from loaded_tca import plots

ROOT = Path(__file__).parents[1]
BUILT = shutil.ignore_patterns("_build", "gallery", "generated", "api")


SPHINX = """
import gc, os, sys
from sphinx.cmd.build import main
gc.disable()  # it finds nothing, and takes a fifth of the time; so does taking down all objects at the end
code = main(sys.argv[1:])
sys.stderr.flush()
os._exit(code)
"""


@pytest.mark.thorough
def test_site_builds_without_a_warning(tmp_path):
    """Beside the repository, since generated pages stand among the others; the gallery's scripts are not run."""
    shutil.copytree(ROOT / "docs", tmp_path / "docs", ignore=BUILT)
    for name in ("examples", "loaded_tca", "validation", "CONTRIBUTING.md", "CHANGELOG.md"):
        (tmp_path / name).symlink_to(ROOT / name)
    shutil.copy(ROOT / "README.md", tmp_path)  # the first page includes it, and its links count from where it lies
    options = ["-b", "dummy", "-W", "--keep-going", "-q", "-D", "plot_gallery=0", "-D", "smartquotes=0"]
    built = subprocess.run(
        [sys.executable, "-c", SPHINX, *options, "docs", "built"], cwd=tmp_path, capture_output=True, text=True
    )
    assert built.returncode == 0, built.stderr
    with zipfile.ZipFile(tmp_path / "docs" / "_build" / "loaded_tca_examples.zip") as archive:
        packed = set(archive.namelist())
    listed = subprocess.run(
        ["git", "ls-files", "examples"], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout
    assert {*listed.splitlines()} - packed == {"examples/GALLERY_HEADER.rst"}  # scripts run where it is unpacked
    commands = (tmp_path / "docs" / "reference" / "generated" / "commands.md").read_text(encoding="utf-8")
    assert "docs/" not in commands  # readers of the site have no such folder: links with titles
    assert "[](../guide/comparing.md)" in commands


def test_every_kind_of_picture_has_a_sentence_on_what_one_reads_from_it():
    """Several kinds begin alike, and names of files go on behind them."""
    path = ROOT / "docs" / "_extensions" / "gallery.py"
    specification = importlib.util.spec_from_file_location("gallery", path)
    gallery = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(gallery)
    several = {"plot_all", "plot_study", "plot_subsurface"}  # the last one is plot_stress_below, of arrays
    for function in {name for name in plots.__all__ if name.startswith("plot_")} - several:
        for ending in ("", "_edge", "_peak_pressure_MPa"):
            caption = gallery.caption_of(function.removeprefix("plot_") + ending)
            assert caption.endswith(f". (:func:`~loaded_tca.plots.{function}`)\n")
    assert gallery.caption_of("monte_carlo") == ""
