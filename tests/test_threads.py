"""One thread inside ``one_thread``, whoever started the process; results do not depend on it, to the last bit."""

import os
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from threadpoolctl import ThreadpoolController

from loaded_tca.analysis import analyse
from loaded_tca.compliance.influence import forget
from loaded_tca.contact import convolution, solve_contact
from loaded_tca.scene import read_scene
from loaded_tca.threads import allowed_threads, one_blas_thread, one_thread

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
    """Helping threads of the transforms of a thread that does some work, and what that gives."""
    with ThreadPoolExecutor(1) as pool:
        return pool.submit(lambda: (work(), sorted(convolution._cache.pools))).result(timeout=120)


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
    assert (helped, unhelped) == ([2], [])
    assert_array_equal(free, bound)  # exact: threads share lines of a transform, each line is of one thread


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
