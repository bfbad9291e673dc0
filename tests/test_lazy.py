"""Public names of a package that are imported when they are first used."""

import compileall
import os
import shutil
import subprocess
import sys
from pathlib import Path

import loaded_tca


def test_names_are_found_without_the_sources(tmp_path):
    shutil.copytree(Path(loaded_tca.__file__).parent, tmp_path / "loaded_tca", ignore=shutil.ignore_patterns("*.pyc"))
    assert compileall.compile_dir(tmp_path, quiet=1, legacy=True)
    for source in tmp_path.rglob("*.py"):
        source.unlink()
    code = "import loaded_tca as one; print(one.__file__, one.read_scene.__name__, one.flanks.SplineFlank.__name__)"
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
    found = subprocess.run(
        [sys.executable, "-c", code], env=environment, cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert found.stdout.split() == [str(tmp_path / "loaded_tca" / "__init__.pyc"), "read_scene", "SplineFlank"]
