"""Works in a process of their own: as if done here, and no process is left of those that nobody waits for."""

import os
import sys
import time
from contextlib import contextmanager

import pytest

from loaded_tca import apart as module
from loaded_tca.apart import apart
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.threads import JOBS, NotWantedError, _helps, jobs


@contextmanager
def helping():
    """What the calling thread does, it does as a helper."""
    mark = _helps.set(True)
    try:
        yield
    finally:
        _helps.reset(mark)


def place_of(number):
    return os.getpid(), jobs(), number


def refuse(problems):
    raise InputError(problems)


def unsendable(_):
    raise GeometryError(lambda: 0)


def end_at_once(before):
    if os.getpid() != before:
        os._exit(3)
    return "done here"


def sleep(path):
    path.write_text(str(os.getpid()))
    time.sleep(600.0)


def test_helper_has_a_work_done_by_another_process_on_one_thread(monkeypatch):
    monkeypatch.delenv(JOBS)
    assert apart(place_of, 7)[0] == os.getpid()
    with helping():
        process, threads, number = apart(place_of, 7)
    assert process != os.getpid()
    assert (threads, number) == (1, 7)


def test_error_of_another_process_is_that_of_the_work():
    with helping(), pytest.raises(InputError) as caught:
        apart(refuse, ["one", "two"])
    assert caught.value.problems == ("one", "two")


@pytest.mark.quick_cases("process ends")
@pytest.mark.parametrize(
    ("work", "argument", "answer"),
    [(end_at_once, os.getpid(), "done here"), (lambda n: n + 1, 1, 2), (type, lambda: 0, type(end_at_once))],
    ids=["process ends", "work cannot be sent", "argument cannot be sent"],
)
def test_work_without_an_answer_from_elsewhere_is_done_here(work, argument, answer):
    with helping():
        assert apart(work, argument) == answer


@pytest.mark.thorough
def test_error_that_cannot_be_sent_is_raised_here():
    with helping(), pytest.raises(GeometryError):
        apart(unsendable, None)


def test_work_is_done_here_where_no_interpreter_can_be_started(monkeypatch):
    monkeypatch.setattr(sys, "executable", "/nowhere/python")
    with helping():
        assert apart(place_of, 1)[0] == os.getpid()


def test_process_that_nobody_waits_for_is_ended(monkeypatch, tmp_path):
    told = tmp_path / "process"

    def not_wanted():
        if told.exists() and told.read_text():
            raise NotWantedError

    monkeypatch.setattr(module, "leave_if_not_wanted", not_wanted)
    with helping(), pytest.raises(NotWantedError):
        apart(sleep, told)
    if os.name == "posix":
        with pytest.raises(ProcessLookupError):  # ended, and waited for
            os.kill(int(told.read_text()), 0)
