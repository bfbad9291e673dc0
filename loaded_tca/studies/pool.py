"""Processes on this machine, for studies: none of them outlives the block that asked for them, or this process."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import active_children, get_context, parent_process
from threading import Thread

from loaded_tca.errors import require


@contextmanager
def process_pool(workers: int) -> Iterator[ProcessPoolExecutor]:
    """Keep processes ready for the time of a block; an exception in the block, an interrupt too, ends them at once.

    A ``ProcessPoolExecutor`` by itself first waits for the analyses that are running, and leaves its processes behind
    when this one is killed.

    Parameters
    ----------
    workers : int
        How many, from 1 on. They are started anew (*spawn*), so that a script needs the line
        ``if __name__ == "__main__":``; Ctrl-C does not reach them.

    Raises
    ------
    InputError
        If ``workers`` is no whole number from 1 on.

    Examples
    --------
    >>> with process_pool(1) as executor:
    ...     executor.submit(abs, -2.0).result()
    2.0
    """
    whole = isinstance(workers, int) and not isinstance(workers, bool) and workers >= 1
    require((whole, f"workers: found {workers!r}; allowed a whole number from 1 on"))
    others, own = set(active_children()), set()
    with ProcessPoolExecutor(workers, get_context("spawn"), _end_with_parent) as pool:
        try:
            with _interrupts_held_back():
                for _ in range(workers):  # each starts one
                    pool.submit(os.getpid)
                own = set(active_children()) - others
            yield pool
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)  # first: it stumbles over cancelled tasks of ended processes
            for process in own:
                process.terminate()
            for process in own:
                process.join()
            raise


def _end_with_parent() -> None:
    """Make a worker ignore interrupts, which are its parent's to deal with, and end once its parent is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = parent_process()

    def watch() -> None:
        if parent is not None:
            parent.join()
            os._exit(1)

    Thread(target=watch, daemon=True).start()


@contextmanager
def _interrupts_held_back() -> Iterator[None]:
    """Processes that are started inside inherit it, from their first instruction on; this one is interrupted after."""
    if sys.platform == "win32":  # no masks: interrupts while workers start show their tracebacks
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
