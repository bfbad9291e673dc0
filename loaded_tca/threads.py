"""How many threads a computation may use, and how several do one piece of work: the one place that says so.

Large transforms of the contact solver take as many threads as they are given, up to the cores that this process may
run on, and BLAS its own. Inside :func:`one_thread` both keep to one; so do transforms in processes that
``multiprocessing`` started, since a pool of them fills the machine. Results do not depend on it, to the last bit.

Helping threads are those of ``_thread`` and talk by locks and queues that the interpreter has in C alone: what
``concurrent.futures`` and ``threading`` have in Python an exception out of a signal leaves locked, and executors take
no work once the main thread has ended.
"""

from __future__ import annotations

import multiprocessing
import os
import threading
from _thread import start_new_thread
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from contextvars import ContextVar
from functools import cache, partial
from queue import SimpleQueue
from typing import Any, TypeVar

Part = TypeVar("Part")

_alone = ContextVar("one_thread", default=False)


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


def allowed_threads(wanted: int) -> int:
    """Return how many threads of those wanted the calling thread may use."""
    if _alone.get() or multiprocessing.parent_process() is not None:
        return 1
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return min(wanted, cores)


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


def _mark_fork() -> None:
    """Threads do not survive a fork: the child makes its own."""
    global _own
    _own = _OfThread()


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
