"""What a short command does without: packages of clusters, and a look for garbage among what stays."""

import gc
import subprocess
import sys

import pytest

from loaded_tca.cli import DEMO_SCENE
from loaded_tca.cli.terminal import bar_of, collecting_garbage

IMPORTED = """
import sys
from loaded_tca.cli import main
code = main(sys.argv[1:])
print(code, *sorted({"dask", "distributed"} & {name.partition(".")[0] for name in sys.modules}), file=sys.stderr)
"""


@pytest.mark.thorough
def test_result_is_made_written_and_read_without_packages_of_clusters(tmp_path):
    pytest.importorskip("distributed")
    few = ["--set", "analysis.positions=2", "--set", "analysis.compliance='contact'"]
    few += ["--set", "analysis.free_edges=false", "--set", "analysis.accuracy=0.1"]
    scene = tmp_path / "scene.toml"
    scene.write_bytes(DEMO_SCENE.read_bytes())
    command = [sys.executable, "-c", IMPORTED, "run", scene, "--out", tmp_path, *few]
    ended = subprocess.run(command, capture_output=True, text=True)
    assert ended.stderr.splitlines()[-1] == "0", ended.stderr


def test_garbage_is_collected_where_a_command_computes():
    """And as before once it has ended."""
    assert gc.isenabled()
    with collecting_garbage(False):
        assert not gc.isenabled()
        with bar_of("variants", 3, ""):
            assert gc.isenabled()
        assert not gc.isenabled()
    assert gc.isenabled()


def test_failure_leaves_the_collector_as_it_was():
    with pytest.raises(RuntimeError), collecting_garbage(False):
        raise RuntimeError
    assert gc.isenabled()
