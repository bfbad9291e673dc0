"""How many threads a computation may use: the one place that says so.

Large transforms of the contact solver take as many threads as they are given, up to the cores that this process may
run on, and BLAS its own. Inside :func:`one_thread` both keep to one; so do transforms in processes that
``multiprocessing`` started, since a pool of them fills the machine. Results do not depend on it, to the last bit.
"""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from contextvars import ContextVar
from functools import cache
from typing import Any

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
