"""One thread inside ``one_thread``, whoever started the process; results do not depend on it, to the last bit.

Work that threads share, and works that are done at once: as if one did them all, or nobody works on them any more.
"""

import _thread
import os
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import suppress
from multiprocessing import get_context
from pathlib import Path
from threading import Event, get_ident

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from threadpoolctl import ThreadpoolController

from loaded_tca import threads
from loaded_tca.analysis import analyse
from loaded_tca.compliance import root_stress
from loaded_tca.compliance.influence import forget
from loaded_tca.contact import solve_contact
from loaded_tca.errors import (
    AccuracyWarning,
    ConvergenceError,
    GeometryError,
    InputError,
    give_accuracy_warning,
    noted_accuracy_warnings,
)
from loaded_tca.scene import read_scene
from loaded_tca.threads import (
    JOBS,
    NotWantedError,
    allowed_threads,
    jobs,
    leave_if_not_wanted,
    one_blas_thread,
    one_thread,
    shared,
    side_by_side,
    with_jobs,
)
from tests.interrupts import Signal, interrupted, raise_signal

SCENE = Path(__file__).parents[1] / "examples" / "scenes" / "mesh_cycle_helical.toml"
CORES = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()


@pytest.fixture(autouse=True)
def _as_many_jobs_as_cores(monkeypatch):
    monkeypatch.delenv(JOBS, raising=False)


@pytest.fixture
def two_jobs(monkeypatch):
    """Two jobs, also where there is one core."""
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1}, raising=False)
    with with_jobs(2):
        yield


@pytest.fixture
def blas():
    """What tells and sets the threads of BLAS, with two of them."""
    controller = ThreadpoolController().select(user_api="blas")
    with controller.limit(limits=2):
        yield controller


def blas_threads(controller):
    return {library["num_threads"] for library in controller.info()}


def test_as_many_threads_as_cores_are_allowed():
    assert allowed_threads(1) == 1
    assert allowed_threads(1000) == CORES


def test_one_thread_is_allowed_inside_and_others_again_after_it():
    with one_thread(), one_thread():
        assert allowed_threads(1000) == 1
    with pytest.raises(KeyError), one_thread():
        raise KeyError
    assert allowed_threads(1000) == CORES


def test_one_thread_holds_for_the_thread_that_asks_alone():
    with ThreadPoolExecutor(1) as pool, one_thread():
        assert pool.submit(allowed_threads, 1000).result(timeout=60) == CORES


def test_a_process_may_not_use_cores_that_it_was_not_given(monkeypatch):
    """As launchers bind their processes to cores."""
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {3}, raising=False)
    assert allowed_threads(2) == 1


def test_blas_keeps_to_one_thread_inside(blas):
    with one_thread():
        with one_blas_thread():
            assert blas_threads(blas) == {1}
        assert blas_threads(blas) == {1}
    assert blas_threads(blas) == {2}


def helpers_after(work):
    """What some work gives, and how many threads have helped the one that did it."""
    with ThreadPoolExecutor(1) as pool:
        return pool.submit(lambda: (work(), threads._own.helpers.count)).result(timeout=120)


def test_large_contact_is_the_same_on_one_thread(monkeypatch, blas):  # noqa: ARG001 (two threads of BLAS)
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1}, raising=False)
    x = (np.arange(384) + 0.5) / 384 - 0.5
    gap = (x[:, None] ** 2 + 0.3 * x**2) / 20.0

    def solved():
        return solve_contact(gap, (1 / 384, 1 / 384), 115e3, load=300.0).pressure

    def alone():
        with one_thread():
            return solved()

    (free, helped), (bound, unhelped) = helpers_after(solved), helpers_after(alone)
    assert (helped, unhelped) == (1, 0)
    assert_array_equal(free, bound)  # exact: threads share lines of a transform, each line is of one thread


@pytest.mark.thorough
@pytest.mark.filterwarnings("ignore::loaded_tca.errors.AccuracyWarning")
def test_analysis_is_the_same_by_one_thread_and_by_two_jobs(monkeypatch, blas):  # noqa: ARG001 (two threads of BLAS)
    """Models of roots of both gears, those of their teeth and the states, as helpers come to them."""
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1}, raising=False)
    monkeypatch.setenv("LOADED_TCA_CACHE", "off")
    faces = dict.fromkeys(("pinion.face_width_mm", "wheel.face_width_mm"), 6.0)
    few = {"analysis.positions": 3, "analysis.torques_Nm": [130.0], "analysis.root_stress": True}
    scene = read_scene(SCENE).with_changes(faces | few)

    def analysed():
        forget()
        root_stress._model.cache_clear()
        return analyse(scene)

    monkeypatch.setattr(threads, "_own", threads._OfThread())
    free = analysed()
    assert threads._own.helpers.count == 1
    with one_thread():
        bound = analysed()
    assert free.warnings == bound.warnings
    for name, values in free.dataset.variables.items():
        # exact: matrices are multiplied on one thread of BLAS in both
        assert_array_equal(values, bound.dataset.variables[name], err_msg=name)


def test_nobody_works_on_once_the_caller_has_raised():
    """An exception out of a signal meets the caller as the helper is amidst a part, and others are left."""
    begun, caller, done = Event(), get_ident(), []

    def work(part):
        if get_ident() == caller:
            assert begun.wait(60.0)
            raise KeyboardInterrupt
        begun.set()
        time.sleep(0.05)
        done.append(part)

    with pytest.raises(KeyboardInterrupt):
        shared(work, range(100), [(), ()])
    at_once = list(done)
    time.sleep(0.1)
    assert done == at_once
    assert len(done) == 1  # the part that the helper was amidst is finished, no other one begun


def test_error_of_a_helper_is_raised_by_the_caller():
    raised, caller = Event(), get_ident()

    def work(_):
        if get_ident() == caller:
            assert raised.wait(60.0)
        else:
            raised.set()
            raise MemoryError

    with pytest.raises(MemoryError):
        shared(work, range(2), [(), ()])


def test_work_is_done_alone_where_no_thread_can_be_started(monkeypatch):
    """As while the interpreter shuts down, or where a process has as many threads as it may."""

    def refused(*_):
        raise RuntimeError("can't start new thread")

    monkeypatch.setattr(threads, "_own", threads._OfThread())
    monkeypatch.setattr(threads, "start_new_thread", refused)
    done = []
    shared(lambda part, own: done.append((part, own)), range(5), [("first",), ("second",)])
    assert done == [(part, "first") for part in range(5)]


def test_helpers_end_with_whom_they_help():
    before, helpers = _thread._count(), threads._Helpers()
    assert helpers.at_least(3) == 3
    del helpers
    deadline = time.monotonic() + 60.0
    while _thread._count() > before and time.monotonic() < deadline:
        time.sleep(0.01)
    assert _thread._count() <= before


@pytest.mark.parametrize("text", ["0", "-1", "two", "1.5"])
def test_jobs_of_the_environment_are_whole_numbers_from_one(monkeypatch, text):
    monkeypatch.setenv(JOBS, text)
    with pytest.raises(InputError, match=rf"^LOADED_TCA_JOBS: '{text}': allowed a whole number from 1$"):
        jobs()


def test_jobs_are_those_asked_for_and_no_more_than_cores(monkeypatch):
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {1, 2, 3, 5}, raising=False)
    assert jobs() == 4
    monkeypatch.setenv(JOBS, " 3 ")
    assert jobs() == 3
    with with_jobs(2), with_jobs(None):
        assert jobs() == 2
    with with_jobs(100):
        assert jobs() == 4
    with with_jobs(2), one_thread():
        assert jobs() == 1
    with pytest.raises(InputError, match="jobs: 0: allowed a whole number from 1"), with_jobs(0):
        pass


def test_workers_have_one_job():
    with ProcessPoolExecutor(1, get_context("fork")) as pool:
        assert pool.submit(jobs).result(timeout=60) == 1


def test_works_are_done_at_once_the_last_by_the_caller(two_jobs, blas):  # noqa: ARG001
    """The helper has one thread, and so has the caller as long as it is at work, for transforms and for BLAS."""
    caller, met, told = get_ident(), [Event(), Event()], Event()

    def work(index):
        met[index].set()
        assert met[1 - index].wait(60.0)
        allowed = allowed_threads(2), blas_threads(blas)
        if index == 1:
            told.set()
        assert told.wait(60.0)
        return index, get_ident() == caller, allowed

    results = side_by_side(lambda: work(0), lambda: work(1))
    assert results == [(0, False, (1, {1})), (1, True, (1, {1}))]
    assert (allowed_threads(2), blas_threads(blas)) == (2, {2})


def test_works_nobody_has_taken_are_done_by_the_caller(two_jobs):  # noqa: ARG001
    begun, going_on, caller = Event(), Event(), get_ident()

    def first():
        begun.set()
        return going_on.wait(60.0)

    def second():
        going_on.set()
        return get_ident() == caller

    assert side_by_side(first, second, lambda: begun.wait(60.0)) == [True, True, True]


def test_warnings_of_works_are_given_in_their_order(two_jobs):  # noqa: ARG001
    second = Event()

    def first():
        assert second.wait(60.0)
        give_accuracy_warning("one")

    def last():
        give_accuracy_warning("two")
        second.set()

    with noted_accuracy_warnings() as sentences, pytest.warns(AccuracyWarning) as given:
        side_by_side(first, last)
    assert sentences == [str(one.message) for one in given] == ["one", "two"]


@pytest.mark.parametrize("count", [1, 2])
def test_error_of_works_is_the_first_in_their_order(two_jobs, count):  # noqa: ARG001
    """Though a later one fails before it; what stands behind it is left, what stands before it is done."""
    failed, done = Event(), []

    def first():
        assert count == 1 or failed.wait(60.0)
        done.append("first")

    def second():
        raise GeometryError("the tooth is pointed")

    def last():
        failed.set()
        raise ConvergenceError("not solved", last="iterate")

    with with_jobs(count), pytest.raises(GeometryError, match="the tooth is pointed"):
        side_by_side(first, second, last)
    assert done == ["first"]


def to_its_end():
    """A work of some seconds, which nobody may wait for."""
    for _ in range(3000):
        leave_if_not_wanted()
        time.sleep(0.001)
    pytest.fail("has gone on though it was not wanted")


def test_error_of_a_work_ends_those_behind_it(two_jobs):  # noqa: ARG001
    """The caller does not go on with states where a model of a gear has failed."""

    def fails():
        raise InputError("the bore reaches the teeth")

    with pytest.raises(InputError, match="bore"):
        side_by_side(fails, to_its_end)


@pytest.mark.parametrize("stop", [KeyboardInterrupt, TimeoutError])
def test_interrupt_ends_works_at_their_next_step(two_jobs, stop):  # noqa: ARG001
    """An exception out of a signal, which meets the caller; the helper is amidst a long work, and another one waits."""
    begun, ended, done = Event(), Event(), []

    def long():
        begun.set()
        try:
            to_its_end()
        except NotWantedError:
            ended.set()
            raise

    def interrupted():
        assert begun.wait(60.0)
        raise stop

    with pytest.raises(stop):
        side_by_side(long, lambda: done.append("waiting"), interrupted)
    assert ended.is_set()
    assert not done
    assert allowed_threads(2) == 2


def test_signal_anywhere_in_works_done_at_once_leaves_nobody_at_work(two_jobs):  # noqa: ARG001
    """Before whichever line of the caller it comes: what was allowed before it is allowed after it."""
    line, at_work = 1, []

    def work():
        at_work.append(None)
        try:
            leave_if_not_wanted()
        finally:
            at_work.pop()

    def works():
        with suppress(Signal):
            side_by_side(work, work, work)
        assert not at_work
        assert threads._under_way.count == 0

    while interrupted([threads], line, raise_signal, works):
        line += 1
    assert line > 50
    assert threads._work.get() is None
    assert allowed_threads(2) == 2


def test_fault_of_a_helper_is_raised_by_the_caller_at_once(two_jobs):  # noqa: ARG001
    def fails():
        raise MemoryError

    with pytest.raises(MemoryError):
        side_by_side(fails, to_its_end)


LATE = """
import atexit, os, threading
import numpy as np
os.sched_getaffinity = lambda _: {0, 1}
from loaded_tca.contact.convolution import Convolution
def convolve():
    print(Convolution((192, 192), [1.0])(np.ones((1, 192, 192)), np.empty((1, 192, 192))).sum())
def late():
    threading.main_thread().join()
    convolve()
threading.Thread(target=late).start()
atexit.register(convolve)
"""


def test_transforms_run_as_the_interpreter_ends():
    """In a thread that outlives the main one, and then in ``atexit``: executors take no work there."""
    ended = subprocess.run([sys.executable, "-c", LATE], capture_output=True, text=True, timeout=60, check=False)
    assert not ended.stderr
    thread, at_exit = ended.stdout.split()
    assert thread == at_exit
