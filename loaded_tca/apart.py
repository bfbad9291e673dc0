"""Long works in a process of their own, beside a thread that would wait for the interpreter with them.

In a model of root stress large products, which let other threads run, take turns with small steps of the interpreter,
which do not. So where a thread merely helps (see :func:`loaded_tca.threads.side_by_side`), it has such a work done by a
process that is started for it, and waits. The process is no fork, which would copy locks that other threads hold, and
does not run the main module of the caller again, as those of ``multiprocessing`` do. Its result is the same to the last
bit: it keeps to one thread, as the helper would. It ends with whoever waits for it.
"""

from __future__ import annotations

import os
import pickle
import signal
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any, TypeVar

from loaded_tca.threads import AGAIN, is_helper, leave_if_not_wanted, one_thread

Argument = TypeVar("Argument")
Result = TypeVar("Result")

CHILD = "import pickle, sys; sys.path[:] = pickle.load(sys.stdin.buffer); from loaded_tca.apart import serve; serve()"
UNSENT = pickle.PicklingError, AttributeError, TypeError
"""What pickle raises of functions and objects that only this process has."""


def apart(work: Callable[[Argument], Result], argument: Argument) -> Result:
    """Do ``work(argument)``, in a process of its own if the calling thread helps another one, and else here.

    Here, too, where no interpreter can be started, work or argument cannot be sent, or the process ends without an
    answer.

    Parameters
    ----------
    work : callable
        A function of a module.
    argument
        Whatever pickle can write.

    Raises
    ------
    NotWantedError
        If nobody waits for the work any more; within a tenth of a second the process is ended.
    Exception
        What the work raises.

    Examples
    --------
    >>> apart(len, "four")
    4
    """
    answer = _answer(work, argument) if is_helper() else None
    if answer is None:
        return work(argument)
    done, result = answer
    if not done:
        raise result
    return result


def _answer(work: Callable[[Any], Any], argument: Any) -> tuple[bool, Any] | None:
    """Whether a process of its own has done the work, and its result or what it raised; None: there is no answer."""
    import subprocess  # few analyses need it
    import tempfile

    # interrupts of the terminal are for the thread that waits: it ends the process
    own_group: dict[str, Any] = {"process_group": 0} if os.name == "posix" else {"creationflags": 0x200}
    try:
        with tempfile.TemporaryFile() as task:  # no pipe: until all is read, whoever writes into one waits
            pickle.dump(sys.path, task)
            pickle.dump((work, argument), task, protocol=pickle.HIGHEST_PROTOCOL)
            task.seek(0)
            command, nothing = [sys.executable, "-P", "-W", "ignore", "-c", CHILD], subprocess.DEVNULL
            process = subprocess.Popen(command, stdin=task, stdout=subprocess.PIPE, stderr=nothing, **own_group)
    except (*UNSENT, OSError):
        return None
    with process:
        try:
            written = None
            while written is None:
                leave_if_not_wanted()
                with suppress(subprocess.TimeoutExpired):
                    written, _ = process.communicate(timeout=AGAIN)
        finally:
            process.kill()
    try:
        done, result = pickle.loads(written)
    except (EOFError, pickle.UnpicklingError):
        return None
    return bool(done), result


def serve() -> None:
    """What such a process does: one work, read from its standard input; it ends with the process that started it."""
    if os.name == "posix":
        threading.Thread(target=_end_with, args=(os.getppid(),), daemon=True).start()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with os.fdopen(os.dup(sys.stdout.fileno()), "wb") as out:
        os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # whatever is printed is no answer
        try:
            work, argument = pickle.load(sys.stdin.buffer)
            with one_thread():
                answer = True, work(argument)
        except Exception as error:
            answer = False, error
        pickle.dump(answer, out, protocol=pickle.HIGHEST_PROTOCOL)


def _end_with(parent: int) -> None:
    """End this process as soon as it has another parent."""
    while os.getppid() == parent:
        time.sleep(10.0 * AGAIN)
    os._exit(1)
