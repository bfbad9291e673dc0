"""Exceptions out of signals, which come anywhere: before a line of some modules, counted as they run."""

import sys
from collections.abc import Callable, Sequence
from types import FrameType, ModuleType
from typing import Any


class Signal(BaseException):
    """An exception out of a signal: a time limit, an alarm, an interrupt."""


def raise_signal() -> None:
    """What a handler of a signal may do."""
    raise Signal


def interrupted(
    modules: Sequence[ModuleType], line: int, handler: Callable[[], object], work: Callable[[], object]
) -> bool:
    """Do some work, and what handles a signal before a line of the modules, counted from 1 on as they run.

    Returns whether the work had as many lines.
    """
    files, left = {module.__file__ for module in modules}, [line]

    def trace(frame: FrameType, event: str, _: Any) -> Any:
        if frame.f_code.co_filename not in files:
            return None
        if event == "line":
            left[0] -= 1
            if left[0] == 0:
                handler()
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        work()
    finally:
        sys.settrace(before)
    return left[0] <= 0
