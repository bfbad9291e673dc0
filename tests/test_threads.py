"""One thread inside ``one_thread``, whoever started the process; results do not depend on it, to the last bit.

And work that threads share: done as a whole, or nobody works on it any more.
"""

import _thread
import os
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Event, get_ident

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from threadpoolctl import ThreadpoolController

from loaded_tca import threads
from loaded_tca.analysis import analyse
from loaded_tca.compliance.influence import forget
from loaded_tca.contact import solve_contact
from loaded_tca.scene import read_scene
from loaded_tca.threads import allowed_threads, one_blas_thread, one_thread, shared

SCENE = Path(__file__).parents[1] / "examples" / "scenes" / "mesh_cycle_helical.toml"
CORES = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()


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
def test_analysis_is_the_same_on_one_thread(monkeypatch, blas):  # noqa: ARG001 (two threads of BLAS)
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1}, raising=False)
    monkeypatch.setenv("LOADED_TCA_CACHE", "off")
    scene = read_scene(SCENE).with_changes({"analysis.positions": 3, "analysis.torques_Nm": [130.0]})
    forget()
    free = analyse(scene)
    forget()
    with one_thread():
        bound = analyse(scene)
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
