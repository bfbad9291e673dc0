"""The documentation site builds without a warning: every cross reference, picture and docstring of it resolves."""

import importlib.util
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
BUILT = shutil.ignore_patterns("_build", "gallery", "generated", "api")


def test_site_builds_without_a_warning(tmp_path):
    """Beside the repository, since generated pages stand among the others; the gallery's scripts are not run."""
    shutil.copytree(ROOT / "docs", tmp_path / "docs", ignore=BUILT)
    for name in ("examples", "loaded_tca", "validation", "README.md", "CONTRIBUTING.md", "CHANGELOG.md"):
        (tmp_path / name).symlink_to(ROOT / name)
    options = ["-b", "dummy", "-W", "--keep-going", "-q", "-D", "plot_gallery=0"]
    built = subprocess.run(
        [sys.executable, "-m", "sphinx", *options, "docs", "built"], cwd=tmp_path, capture_output=True, text=True
    )
    assert built.returncode == 0, built.stderr


def test_pictures_of_a_page_have_the_sentence_of_the_function_that_draws_them():
    path = ROOT / "docs" / "_extensions" / "gallery.py"
    specification = importlib.util.spec_from_file_location("gallery", path)
    gallery = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(gallery)
    for name, function in {
        "root_stress": "plot_root_stress",
        "root_stress_over_torque": "plot_root_stress_over_torque",
        "pressure_map_edge": "plot_pressure_map",
        "study_lines_peak_pressure_MPa": "plot_study_lines",
    }.items():
        caption = gallery.caption_of(name)
        assert f"(:func:`~loaded_tca.plots.{function}`)" in caption
        assert (getattr(gallery.plots, function).__doc__ or "").splitlines()[0] in caption
    assert gallery.caption_of("monte_carlo") == ""
