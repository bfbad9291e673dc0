"""One study on every kind of executor: the same numbers, to the last bit."""

import os
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from functools import cache
from multiprocessing import get_context
from pathlib import Path

import pytest

from loaded_tca.studies import Study, load_study, process_pool, run_study
from tests.samples.studies import unlike_variants

ROOT = Path(__file__).parents[2]


def bits(found, order=slice(None)):
    """Everything that a study found but the time it took; numbers byte by byte."""
    values = {name: found[name].values[order] for name in found.variables if name != "seconds"}
    return {
        name: value.astype(float).tobytes() if value.dtype.kind in "if" else value.tolist()
        for name, value in values.items()
    }


@cache
def expected():
    return bits(run_study(unlike_variants()))


def processes(method, workers=2):
    return ProcessPoolExecutor(workers, get_context(method))


ENGINES = {
    "threads": lambda: ThreadPoolExecutor(3),
    "fork": lambda: processes("fork"),
    "forkserver": lambda: processes("forkserver"),
    "one process": lambda: processes("fork", 1),
    "processes that end with the block": lambda: process_pool(2),  # by spawn
}


# Since Python 3.12 a fork of a process with threads is told, whether or not they matter; another test has used them.
@pytest.mark.thorough
@pytest.mark.filterwarnings(r"ignore:This process .* is multi-threaded:DeprecationWarning")
@pytest.mark.parametrize(
    "engine", ["threads", "fork", *(pytest.param(name, marks=pytest.mark.thorough) for name in [*ENGINES][2:])]
)
def test_numbers_do_not_depend_on_the_engine(engine):
    with ENGINES[engine]() as executor:
        assert bits(run_study(unlike_variants(), executor)) == expected()


@pytest.mark.thorough
def test_numbers_do_not_depend_on_the_engine_on_a_cluster(cluster):
    assert bits(run_study(unlike_variants(), cluster.get_executor(pure=False))) == expected()


@pytest.mark.thorough
def test_numbers_do_not_depend_on_the_engine_under_mpi(tmp_path):
    out = tmp_path / "study.nc"
    launcher = Path(sys.executable).with_name("mpiexec")
    command = [launcher, "-n", "2", "--oversubscribe", sys.executable, "-m", "mpi4py.futures"]
    # A container has one user, root, to whom Open MPI speaks only when told to.
    allowed = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "PYTHONPATH": str(ROOT)}
    subprocess.run([*command, ROOT / "tests" / "studies" / "on_mpi.py", out], env=os.environ | allowed, check=True)
    assert bits(load_study(out)) == expected()


@pytest.mark.thorough
def test_numbers_do_not_depend_on_the_order():
    study = unlike_variants()
    backwards = Study(study.scene, table={key: column[::-1] for key, column in study.table.items()})
    found = run_study(backwards)
    assert found["status"].values[2] == "refused"
    for name, content in bits(found.drop_vars("sample"), slice(None, None, -1)).items():
        assert content == expected()[name], name
