"""Whatever happens to an executor, the rows that are done stay, and the same study goes on from there."""

import errno
import json
import multiprocessing
import os
import resource
import signal
import subprocess
import sys
import time
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path

import psutil
import pytest
from distributed import Client
from numpy.testing import assert_array_equal

from loaded_tca.errors import DamageWarning, ExecutorError, InputError
from loaded_tca.studies import process_pool, run_study
from loaded_tca.studies.rows import Rows, line_of
from tests.samples.figures import asked, endless, killing, lines
from tests.samples.studies import in_folder

ROOT = Path(__file__).parents[2]
LONG = 60.0
"""Seconds after which a test gives up."""
# Since Python 3.12 a fork of a process with threads is told, whether or not they matter.
pytestmark = pytest.mark.filterwarnings(r"ignore:This process .* is multi-threaded:DeprecationWarning")


def rows_in(folder):
    return [json.loads(line) for line in lines(folder / "study.rows.jsonl")]


def calls_in(folder):
    return sorted(float(line) for line in lines(folder / "asked"))


def wait_until(holds):
    begin = time.monotonic()
    while not holds():
        assert time.monotonic() - begin < LONG
        time.sleep(0.02)


def is_over(process):
    """A process that nobody waits for stays as a zombie where there is no one to do so."""
    try:
        return process.status() == psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return True


def test_killed_worker_ends_the_study_and_costs_no_row(tmp_path):
    values = range(1, 51)
    study, out = in_folder(tmp_path, *values), tmp_path / "study.nc"
    before = set(multiprocessing.active_children())
    with (
        ProcessPoolExecutor(2, get_context("fork")) as pool,
        pytest.raises(ExecutorError, match=r"the executor gave up: BrokenProcessPool: .*terminated abruptly") as caught,
    ):
        run_study(study, pool, out, figures=killing)
    assert set(multiprocessing.active_children()) <= before
    kept = rows_in(tmp_path)
    assert len(kept) >= 2
    assert caught.value.__notes__ == [
        f"{len(kept)} variants are kept in {tmp_path / 'study.rows.jsonl'}: the same study goes on from there"
    ]
    (tmp_path / "asked").unlink()
    found = run_study(study, None, out, figures=killing)
    assert_array_equal(found["crowning_um"][:, 0], values)
    assert len(calls_in(tmp_path)) == len(values) - len(kept)


@pytest.mark.thorough
def test_scheduler_hands_the_variants_of_a_killed_worker_to_another(cluster, tmp_path):
    found = run_study(in_folder(tmp_path, 1, 2, 3, 4), cluster.get_executor(), tmp_path / "study.nc", figures=killing)
    assert (tmp_path / "killed").exists()
    assert_array_equal(found["crowning_um"][:, 0], [1.0, 2.0, 3.0, 4.0])


CLUSTER = """
import sys
from distributed import LocalCluster

with LocalCluster(n_workers=1, processes=False, protocol="tcp", dashboard_address=":0") as cluster:
    print(cluster.scheduler_address, flush=True)
    sys.stdin.read()
"""


@pytest.mark.thorough
def test_scheduler_that_goes_away_ends_the_study_and_costs_no_row(tmp_path):
    study, out = in_folder(tmp_path, *range(1, 10)), tmp_path / "study.nc"
    command = [sys.executable, "-c", CLUSTER]
    surroundings = os.environ | {"PYTHONPATH": str(ROOT)}
    with subprocess.Popen(
        command, env=surroundings, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as scheduler:
        address = scheduler.stdout.readline().strip()

        def stop(done, *_):
            if done == 2:
                scheduler.kill()

        with (
            Client(address) as client,
            pytest.raises(ExecutorError, match="CancelledError: as when a scheduler goes away") as caught,
        ):
            run_study(study, client.get_executor(), out, stop, endless)
    assert "2 variants are kept" in caught.value.__notes__[0]
    run_study(study, None, out, figures=asked)


@pytest.mark.quick_cases("kill")
@pytest.mark.parametrize(
    "how",
    [
        "interrupt",
        "kill",
        pytest.param("interrupt of the group", marks=pytest.mark.thorough),
        pytest.param("interrupt while workers start", marks=pytest.mark.thorough),
    ],
)
def test_ended_study_leaves_its_rows_and_no_process(tmp_path, how):
    command = [sys.executable, ROOT / "tests" / "studies" / "endless.py", tmp_path]
    surroundings = os.environ | {"PYTHONPATH": str(ROOT)}
    process = subprocess.Popen(command, env=surroundings, stderr=subprocess.PIPE, text=True, start_new_session=True)
    parent = psutil.Process(process.pid)
    if how.endswith("start"):
        wait_until(lambda: len(parent.children()) >= 3)  # two workers, and what looks after their semaphores
    else:
        wait_until(lambda: len(rows_in(tmp_path)) == 2)
    children = parent.children(recursive=True)
    if how == "kill":
        process.kill()
    elif how == "interrupt":
        process.send_signal(signal.SIGINT)
    else:
        os.killpg(process.pid, signal.SIGINT)
    told = process.communicate(timeout=LONG)[1]  # its end is that of all that write there
    wait_until(lambda: all(map(is_over, children)))
    if how.endswith("start"):
        assert told.splitlines().count("KeyboardInterrupt") == 1  # it may come while another exception is dealt with
        return
    assert calls_in(tmp_path) == [1.0, 2.0]
    if how != "kill":
        assert "2 variants are kept" in told
        assert told.count("Traceback") == 1
    with ThreadPoolExecutor(2) as threads:
        run_study(in_folder(tmp_path, 1, 2, 3), threads, tmp_path / "study.nc", figures=asked)
    # Another name of the figures is another study; its rows do not count, and stay.
    assert len(rows_in(tmp_path)) == 5


def with_room_for(size, study, out, told):
    """Run a study where no file becomes larger than so many bytes, as if the disk were full."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
    try:
        run_study(study, None, out, figures=asked)
    except InputError as error:
        told.put((str(error), *error.__notes__))


def test_full_disk_costs_only_what_does_not_fit(tmp_path):
    study, out = in_folder(tmp_path, *range(1, 10)), tmp_path / "study.nc"
    run_study(in_folder(tmp_path, 1), None, out, figures=asked)
    room = int(3.5 * (tmp_path / "study.rows.jsonl").stat().st_size)
    context = get_context("fork")
    told = context.SimpleQueue()
    process = context.Process(target=with_room_for, args=(room, study, out, told))
    process.start()
    process.join(LONG)
    rows = tmp_path / "study.rows.jsonl"
    assert told.get() == (
        f"{rows}: cannot be written: File too large",
        f"3 variants are kept in {rows}: the same study goes on from there",
    )
    assert [row["figures"]["crowning_um"] for row in rows_in(tmp_path)] == [[1.0], [2.0], [3.0]]
    found = run_study(study, None, out, figures=asked)
    assert calls_in(tmp_path) == [1.0, 2.0, 3.0, 4.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]
    assert_array_equal(found["crowning_um"][:, 0], range(1, 10))


def test_result_that_finds_no_room_costs_no_row(tmp_path, monkeypatch):
    def no_room(*_, **__):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    study, out = in_folder(tmp_path, 1, 2), tmp_path / "study.nc"
    with monkeypatch.context() as patched:
        patched.setattr("xarray.Dataset.to_netcdf", no_room)
        with pytest.raises(InputError, match="cannot be written: No space left on device") as caught:
            run_study(study, None, out, figures=asked)
    assert "2 variants are kept" in caught.value.__notes__[0]
    run_study(study, None, out, figures=asked)
    assert calls_in(tmp_path) == [1.0, 2.0]


def test_rows_of_a_batch_that_fit_stay(tmp_path, monkeypatch):
    """Several rows come at once where workers are quicker than the disk."""
    rows = [
        {"digest": str(n), "status": "ok", "reason": "", "warnings": [], "seconds": 0.0, "figures": {}} for n in "abc"
    ]
    written, size = os.write, len(line_of(rows[0]))

    def write(file, content, room=[2 * size + 10]):  # noqa: B006  (what is left of it)
        if room[0] == 0:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        content = content[: room[0]]
        room[0] -= len(content)
        return written(file, content)

    path = tmp_path / "study.rows.jsonl"
    with Rows(path) as kept:
        monkeypatch.setattr(os, "write", write)
        with pytest.raises(InputError, match="No space left on device"):
            kept.append(rows)
        assert list(kept.of(["a", "b"])) == rows[:2]
        assert "c" not in kept
    assert path.stat().st_size == 2 * size


def test_damaged_row_costs_its_own_variant(tmp_path):
    study, out = in_folder(tmp_path, 1, 2, 3), tmp_path / "study.nc"
    run_study(study, None, out, figures=asked)
    rows = tmp_path / "study.rows.jsonl"
    first, second, third = rows.read_bytes().splitlines(keepends=True)
    rows.write_bytes(first + b"\0" + second[1:] + b'{"digest": "half"}\n' + third)
    with pytest.warns(DamageWarning, match=r"study\.rows\.jsonl: rows that cannot be used, .*: row 2: .*; row 3: "):
        found = run_study(study, None, out, figures=asked)
    assert_array_equal(found["crowning_um"][:, 0], [1.0, 2.0, 3.0])
    assert calls_in(tmp_path) == [1.0, 2.0, 2.0, 3.0]


def test_two_runs_at_once_find_the_rows_of_both(tmp_path):
    study, out = in_folder(tmp_path, 1, 2, 3), tmp_path / "study.nc"

    def again(done, *_):
        if done == 1:
            run_study(in_folder(tmp_path, 3, 4), None, out, figures=asked)

    found = run_study(study, None, out, again, asked)
    assert_array_equal(found["crowning_um"][:, 0], [1.0, 2.0, 3.0])


def test_variants_that_change_the_same_are_analysed_once(tmp_path):
    told = []
    study, out = in_folder(tmp_path, 1, 2, 1, 1), tmp_path / "study.nc"
    found = run_study(study, None, out, lambda *now: told.append(now), asked, keep_maps=[0, 1, 3])
    assert_array_equal(found["crowning_um"][:, 0], [1.0, 2.0, 1.0, 1.0])
    assert calls_in(tmp_path) == [1.0, 2.0]
    assert told == [(3, 4, 0), (4, 4, 0)]
    assert sorted(path.name for path in (tmp_path / "study_maps").iterdir()) == ["0.nc", "1.nc", "3.nc"]
    run_study(study, None, out, figures=asked, keep_maps=[0, 2])
    assert calls_in(tmp_path) == [1.0, 1.0, 2.0]
    assert (tmp_path / "study_maps" / "2.nc").exists()


def test_figures_that_no_process_can_import(tmp_path):
    study = in_folder(tmp_path, 1, 2)

    def local(scene):
        return asked(scene)

    told = r"the executor gave up: (Attribute|Pickling)Error: Can't (get|pickle) .*local"
    with ProcessPoolExecutor(1, get_context("fork")) as pool, pytest.raises(ExecutorError, match=told):
        run_study(study, pool, figures=local)


def test_figures_without_a_name(tmp_path):
    with pytest.raises(InputError, match=r"figures: found functools.partial\(.*\); allowed a function"):
        run_study(in_folder(tmp_path, 1), figures=partial(asked))


def test_executor_that_takes_nothing_any_more(tmp_path):
    study, out = in_folder(tmp_path, 1, 2), tmp_path / "study.nc"
    with ThreadPoolExecutor(1) as pool:
        pass
    with pytest.raises(ExecutorError, match="gave up: RuntimeError: cannot schedule new futures after shutdown"):
        run_study(study, pool, out, figures=asked)
    run_study(study, None, out, figures=asked)


class GivingUp(Executor):
    """An executor whose first task fails and whose others wait."""

    def __init__(self, error):
        self.error, self.futures = error, []

    def submit(self, *_):
        future = Future()
        if not self.futures:
            future.set_exception(self.error)
        self.futures.append(future)
        return future


@pytest.mark.parametrize(("error", "cancelled"), [(BrokenExecutor("over"), False), (RuntimeError("over"), True)])
def test_what_waits_is_cancelled_unless_the_executor_is_broken(tmp_path, error, cancelled):
    """A broken pool fails all of its tasks itself; before Python 3.12 it hangs where one is cancelled meanwhile."""
    executor = GivingUp(error)
    with pytest.raises(ExecutorError, match=f"{type(error).__name__}: over"):
        run_study(in_folder(tmp_path, 1, 2, 3), executor, figures=asked)
    assert [future.cancelled() for future in executor.futures] == [False, cancelled, cancelled]


@pytest.mark.parametrize("workers", [0, -1, 1.5, True, "2"])
def test_workers_that_are_no_number(workers):
    with (
        pytest.raises(InputError, match=f"workers: found {workers!r}; allowed a whole number from 1 on"),
        process_pool(workers),
    ):
        pass
