"""Every error and warning of the package, in one place."""

import functools
import os
import sys
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from math import inf
from types import FrameType
from typing import Any


class LoadedTCAError(Exception):
    """Base class of all errors of this package."""


class InputError(LoadedTCAError, ValueError):
    """An input that cannot be used; lists every problem at once.

    Parameters
    ----------
    problems : str or iterable of str
        One sentence per problem: the key, the value found, and what is allowed.

    Examples
    --------
    >>> raise InputError(["load: -1 N is negative", "cells: 0 is not positive"])
    Traceback (most recent call last):
    ...
    loaded_tca.errors.InputError: load: -1 N is negative
    cells: 0 is not positive
    """

    def __init__(self, problems: str | Iterable[str]) -> None:
        self.problems = (problems,) if isinstance(problems, str) else tuple(problems)
        super().__init__("\n".join(self.problems))

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.problems,)


def require(*checks: tuple[bool, str], owner: str = "") -> None:
    """Raise one InputError that tells every check that fails.

    Parameters
    ----------
    *checks : (bool, str)
        What must hold, and the problem where it does not.
    owner : str
        Whose input it is, in front of each problem.

    Examples
    --------
    >>> require((2 > 1, "never told"), (1 > 2, "teeth: 1 is below 2"), owner="pinion")
    Traceback (most recent call last):
    ...
    loaded_tca.errors.InputError: pinion: teeth: 1 is below 2
    """
    problems = [f"{owner}: {problem}" if owner else problem for holds, problem in checks if not holds]
    if problems:
        raise InputError(problems)


def require_positive(**values: float) -> None:
    """Raise one InputError that names every value that is not positive and finite."""
    require(*((0.0 < value < inf, f"{name}: {value} is not positive and finite") for name, value in values.items()))


def reason_of(error: Exception) -> str:
    """What the system says of a file that cannot be read or written."""
    return getattr(error, "strerror", None) or str(error)


class NotAskedError(InputError, AttributeError):
    """A number that a result has only where its scene asks for it; says by which key."""


class GeometryError(LoadedTCAError, ValueError):
    """Gears or flanks that cannot exist or cannot touch; says which flank, and where."""


@contextmanager
def named(owner: str) -> Iterator[None]:
    """Say whose input it is, or which gear, before every problem that is found inside."""
    try:
        yield
    except InputError as error:
        raise InputError(f"{owner}: {problem}" for problem in error.problems) from None
    except GeometryError as error:
        raise GeometryError(f"{owner}: {error}") from None


class ConvergenceError(LoadedTCAError, RuntimeError):
    """An iteration that did not reach its tolerance.

    Parameters
    ----------
    message : str
        What did not converge, how far it came, and what to try.
    last : object, optional
        The last iterate, to look at or to go on from.
    """

    def __init__(self, message: str, last: Any = None) -> None:
        self.last = last
        super().__init__(message)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.last)


class ExecutorError(LoadedTCAError, RuntimeError):
    """An executor that gave up before all of its tasks were done, as when a worker is killed."""


class AccuracyWarning(UserWarning):
    """A converged result that is less exact than asked for, or beyond the limits of the model."""


class DamageWarning(UserWarning):
    """A file of which a part is damaged: that part counts as missing."""


_noted: ContextVar[tuple[tuple[list[str], bool], ...]] = ContextVar("_noted", default=())


def give_accuracy_warning(sentence: str) -> None:
    """Give an AccuracyWarning at the line that called the package, and tell it to whoever notes them."""
    for sentences, _ in _noted.get():
        sentences.append(sentence)
    if all(given for _, given in _noted.get()):
        warnings.warn(sentence, AccuracyWarning, stacklevel=_level_of_caller())


PACKAGE = os.path.dirname(__file__) + os.sep
"""Beginning of the names of all files of the package."""


def _level_of_caller() -> int:
    """Level of the stack, for who asks, of the line that called the package, whatever lies between.

    Properties that are kept are called by ``functools``, which the line that reads them has called.
    """
    frame: FrameType | None = sys._getframe(1)
    level = last = 1
    inside = True
    while frame is not None:
        name = frame.f_code.co_filename
        inside = name.startswith(PACKAGE) or (inside and name == functools.__file__)
        last = level if inside else last
        frame, level = frame.f_back, level + 1
    return last + 1


@contextmanager
def noted_accuracy_warnings(*, given: bool = True, alone: bool = False) -> Iterator[list[str]]:
    """Note the sentences of accuracy warnings of this thread, whatever the filters of ``warnings`` do with them.

    Parameters
    ----------
    given : bool
        Whether the warnings are given, too.
    alone : bool
        Whether nobody who notes them around this notes them, too: who passes them on in other words.

    Examples
    --------
    >>> with noted_accuracy_warnings(given=False) as sentences:
    ...     give_accuracy_warning("the fit is coarse")
    >>> sentences
    ['the fit is coarse']
    """
    sentences: list[str] = []
    mark = _noted.set((*(() if alone else _noted.get()), (sentences, given)))
    try:
        yield sentences
    finally:
        _noted.reset(mark)
