"""The documentation site builds without a warning: every cross reference, picture and docstring of it resolves."""

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
