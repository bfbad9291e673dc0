"""How many threads a computation may use, and how several do one piece of work: the one place that says so.

A process has a number of jobs: what :func:`with_jobs` or the environment variable ``LOADED_TCA_JOBS`` asks for, and no
more than the cores that it may run on, which are the default. :func:`side_by_side` does as many works at once; large
transforms of the contact solver take the threads that no other work has, and BLAS its own, one where works are done at
once. Inside :func:`one_thread` all keep to one; so do processes that ``multiprocessing`` started, since a pool of them
fills the machine. Results do not depend on it, to the last bit.

Helping threads are those of ``_thread`` and talk by locks and queues that the interpreter has in C alone: what
``concurrent.futures`` and ``threading`` have in Python an exception out of a signal leaves locked, and executors take
no work once the main thread has ended.
"""

from __future__ import annotations

import os
import sys
import threading
from _thread import start_new_thread
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from contextvars import ContextVar, copy_context
from functools import cache, partial
from queue import SimpleQueue
from typing import Any, TypeVar

from loaded_tca.errors import InputError, LoadedTCAError, give_accuracy_warning, noted_accuracy_warnings

Part = TypeVar("Part")
Result = TypeVar("Result")
JOBS = "LOADED_TCA_JOBS"
"""Environment variable: how many works a process does at once."""

_alone = ContextVar("one_thread", default=False)
_helps = ContextVar("is_helper", default=False)
_asked: ContextVar[int | None] = ContextVar("jobs", default=None)


@contextmanager
def one_thread() -> Iterator[None]:
    """Keep what the calling thread computes inside to one thread, however its process was started.

    For workers of whatever launches them (a pool, a scheduler, MPI), of which each has one core.

    Examples
    --------
    >>> with one_thread():
    ...     allowed_threads(8)
    1
    """
    token = _alone.set(True)
    try:
        with one_blas_thread():
            yield
    finally:
        _alone.reset(token)


@contextmanager
def with_jobs(count: int | None) -> Iterator[None]:
    """Let the calling thread do so many works at once inside, and no more than there are cores; None: as outside.

    Raises
    ------
    InputError
        If the number is below one.

    Examples
    --------
    >>> with with_jobs(1):
    ...     allowed_threads(8)
    1
    """
    if count is not None and count < 1:
        raise InputError(f"jobs: {count}: {ALLOWED_JOBS}")
    mark = _asked.set(_asked.get() if count is None else count)
    try:
        yield
    finally:
        _asked.reset(mark)


ALLOWED_JOBS = "allowed a whole number from 1"


def jobs() -> int:
    """Return how many works the calling thread may do at once, by itself and by helping threads.

    Raises
    ------
    InputError
        If ``LOADED_TCA_JOBS`` is no whole number from one.
    """
    process = sys.modules.get("multiprocessing.process")  # which those that it started have loaded
    if _alone.get() or (process is not None and process.parent_process() is not None):
        return 1
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    asked = _asked.get() or _jobs_of_environment()
    return cores if asked is None else min(asked, cores)


def _jobs_of_environment() -> int | None:
    """What ``LOADED_TCA_JOBS`` asks for; None: nothing."""
    if not (text := os.environ.get(JOBS, "").strip()):
        return None
    from loaded_tca.input_files import whole_in  # the contact solver by itself reads no files

    try:
        count = whole_in(text)
    except ValueError:
        count = 0
    if count < 1:
        raise InputError(f"{JOBS}: {text!r:.60}: {ALLOWED_JOBS}")
    return count


def is_helper() -> bool:
    """Return whether the calling thread helps another one with what :func:`side_by_side` does at once."""
    return _helps.get()


def allowed_threads(wanted: int) -> int:
    """Return how many threads of those wanted the calling thread may use: as many as jobs without those under way."""
    return max(1, min(wanted, jobs() - _under_way.count))


def one_blas_thread() -> AbstractContextManager[Any]:
    """Return a context inside which BLAS keeps to one thread: on small matrices its threads wait for each other.

    The threads of a process share one BLAS; of several that are inside, the first limits it.
    """
    return _blas().limit(limits=1)


@cache
def _blas() -> Any:
    """What sets the threads of BLAS, found once: looking for its libraries takes a millisecond."""
    import scipy.linalg  # noqa: F401  (it may have a BLAS of its own, which is found once it is loaded)
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController().select(user_api="blas")


class _Helpers:
    """Threads that take tasks out of a queue, for as long as this is kept."""

    def __init__(self) -> None:
        self._tasks: SimpleQueue[Callable[[], None] | None] = SimpleQueue()
        self.count = 0

    def __del__(self) -> None:
        self._tasks.put(None)

    def at_least(self, count: int) -> int:
        """How many there are after starting those that are missing of a number: fewer where the system has no more.

        No thread can be started once the interpreter is shutting down.
        """
        try:
            while self.count < count:
                start_new_thread(_serve, (self._tasks,))
                self.count += 1
        except RuntimeError:
            pass
        return min(self.count, count)

    def give(self, task: Callable[[], None]) -> None:
        """Have a task done by whichever helper is free, some time."""
        self._tasks.put(task)


def _serve(tasks: SimpleQueue[Callable[[], None] | None]) -> None:
    """What a helping thread does."""
    while (task := tasks.get()) is not None:
        task()
        del task  # a thread that waits keeps no arrays
    tasks.put(None)  # for the next one


class _OfThread(threading.local):
    """What each thread has for itself."""

    def __init__(self) -> None:
        self.helpers = _Helpers()


_own = _OfThread()


class _UnderWay:
    """How many threads help with works at the moment, in the whole process."""

    def __init__(self) -> None:
        self.count, self._lock = 0, threading.Lock()

    def change(self, by: int) -> None:
        with self._lock:
            self.count += by


_under_way = _UnderWay()


def _mark_fork() -> None:
    """Threads do not survive a fork: the child makes its own."""
    global _own, _under_way
    _own, _under_way = _OfThread(), _UnderWay()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_mark_fork)


def shared(work: Callable[..., None], parts: Sequence[Part], tools: Sequence[tuple[Any, ...]]) -> None:
    """Do ``work(part, *own)`` on every part, in as many threads as there are tools, ``own`` being those of a thread.

    The calling thread takes parts too, and does not wait for a helper that has not begun. When this returns or raises,
    nobody works on a part any more; only a second exception out of a signal ends the waiting for it.

    Parameters
    ----------
    work : callable
    parts : sequence
    tools : sequence of tuple
        Arguments that no two threads may use at once.

    Raises
    ------
    BaseException
        Whatever the work raised in one of the threads; parts may be left undone.

    Examples
    --------
    >>> sums = [0, 0, 0]
    >>> def add(part, number):
    ...     sums[part] += part + number
    >>> shared(add, [0, 1, 2], [(10,), (10,)])
    >>> sums
    [10, 11, 12]
    """
    waiting, errors = deque(parts), list[BaseException]()

    def drain(own: tuple[Any, ...]) -> None:
        while waiting:
            try:
                part = waiting.popleft()
            except IndexError:
                return
            work(part, *own)

    def help_out(own: tuple[Any, ...], turn: threading.Lock) -> None:
        if not turn.acquire(blocking=False):
            return  # too late: nobody waits for it
        try:
            drain(own)
        except BaseException as error:  # raised by the thread that waits for this one
            errors.append(error)
        finally:
            turn.release()

    turns: list[threading.Lock] = []
    try:
        for own in tools[1 : 1 + _own.helpers.at_least(min(len(tools), len(parts)) - 1)]:
            turns.append(threading.Lock())
            _own.helpers.give(partial(help_out, own, turns[-1]))
        drain(tools[0])
    finally:
        waiting.clear()
        for turn in turns:
            turn.acquire()
    if errors:
        raise errors[0]


class NotWantedError(BaseException):
    """Ends work whose result nobody waits for any more."""


_work: ContextVar[tuple[_Works, int] | None] = ContextVar("work", default=None)
"""The work that the calling thread does, by its index."""


def leave_if_not_wanted() -> None:
    """End the work of the calling thread if what stood beside it has failed or was interrupted.

    Loops of long works call it once a step, so that an error or an interrupt waits for a step and not for the whole.

    Raises
    ------
    NotWantedError
        Which :func:`side_by_side` takes.
    """
    work = _work.get()
    while work is not None:
        works, index = work
        if index > works.last_wanted:
            raise NotWantedError
        work = works.outer


AGAIN = 0.1
"""Seconds after which a thread that waits looks whether there is anything to wait for."""


class _Works:
    """Works that are done at once, and what becomes of each."""

    def __init__(self, works: Sequence[Callable[[], Any]]) -> None:
        self.outer = _work.get()
        self.works, self.waiting = works, deque(range(len(works)))
        self.last_wanted = len(works) - 1
        self.results: list[Any] = [None] * len(works)
        self.warnings: list[list[str]] = [[] for _ in works]
        self.errors: list[BaseException | None] = [None] * len(works)
        self.fault: BaseException | None = None
        self.helping, self.over = set[threading.Lock](), list[threading.Lock]()

    def do(self, index: int) -> None:
        """Do one: its result, or what it fails with, after which later ones are not wanted any more.

        In a context of its own, which ends with it wherever a signal comes.
        """
        copy_context().run(self._done, index)

    def _done(self, index: int) -> None:
        _work.set((self, index))
        try:
            with noted_accuracy_warnings(given=False, alone=True) as self.warnings[index]:
                self.results[index] = self.works[index]()
        except NotWantedError:
            if self.outer is not None and index <= self.last_wanted:
                raise  # of the works that these are a part of
        except LoadedTCAError as error:
            self.errors[index] = error
            self.last_wanted = min(self.last_wanted, index)

    def help_out(self, turn: threading.Lock) -> None:
        """What a helping thread does, on one thread: works from the first on."""
        self.helping.add(turn)
        if not turn.acquire(blocking=False):
            self.helping.discard(turn)
            return  # too late: nobody waits for it
        _under_way.change(1)
        _helps.set(True)
        try:
            with one_thread():
                self.drain()
        except BaseException as error:  # raised by the thread that waits for this one
            self.fault, self.last_wanted = error, -1
        finally:
            _under_way.change(-1)
            turn.release()
            self.helping.discard(turn)

    def wait(self, turns: Sequence[threading.Lock]) -> None:
        """Wait until no helping thread is at work or will be; again, where a signal came while waiting."""
        for turn in turns:
            if turn not in self.over:
                while not turn.acquire(timeout=AGAIN) and turn in self.helping:  # else it was acquired as a signal came
                    pass
                self.over.append(turn)

    def drain(self) -> None:
        """Do what waits and is wanted."""
        while self.waiting:
            try:
                index = self.waiting.popleft()
            except IndexError:
                return
            if index <= self.last_wanted:
                self.do(index)

    def told(self) -> list[Any]:
        """The results, after the warnings and the first error in the order of the works."""
        if self.fault is not None:
            raise self.fault
        for warned, error in zip(self.warnings, self.errors, strict=True):
            for sentence in warned:
                give_accuracy_warning(sentence)
            if error is not None:
                raise error
        return self.results


def side_by_side(*works: Callable[[], Result]) -> list[Result]:
    """Do works at once, as many as :func:`jobs` allows, as if one were done after the other.

    The calling thread does the last one, which may report progress, and then helps with others. Results, accuracy
    warnings and the error are those of works done one after the other, in their order. An exception out of a signal
    ends all of them at the next step of :func:`leave_if_not_wanted`; only a second one ends the waiting for it.

    In helping threads no work may change the filters of ``warnings``, which all threads share.

    Parameters
    ----------
    *works : callable

    Returns
    -------
    list
        What they return.

    Raises
    ------
    BaseException
        The first error of the package in the order of the works; any other one of any of them at once.

    Examples
    --------
    >>> side_by_side(lambda: 1, lambda: 2)
    [1, 2]
    """
    helpers = _own.helpers.at_least(allowed_threads(len(works)) - 1)
    if helpers < 1:
        return [work() for work in works]
    state, turns = _Works(works), list[threading.Lock]()
    with one_blas_thread():
        try:
            last = state.waiting.pop()
            for _ in range(helpers):
                turns.append(threading.Lock())
                _own.helpers.give(partial(copy_context().run, state.help_out, turns[-1]))
            state.do(last)
            state.drain()
            state.wait(turns)
        except BaseException:
            state.last_wanted = -1
            raise
        finally:
            state.waiting.clear()
            state.wait(turns)
    return state.told()
