"""The command ``loaded-tca``: reads a scene file, writes results and pictures, or one line that says what is wrong.

Its exit codes are ``EXIT_CODES`` of ``cli/arguments.py``.
"""

from __future__ import annotations

import argparse
import io
import sys
import traceback
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext

from loaded_tca.cli.arguments import EXIT_CODES, command_line
from loaded_tca.cli.commands import DEMO_SCENE
from loaded_tca.cli.inputs import as_files_write
from loaded_tca.cli.terminal import collecting_garbage, flush, let_go, quiet, say, warnings_in_one_line_each
from loaded_tca.errors import ConvergenceError, ExecutorError, InputError, LoadedTCAError, reason_of
from loaded_tca.lazy import hidden

__all__ = ["DEMO_SCENE", "EXIT_CODES", "command_line", "main"]

OK, FAULT, BAD_INPUT, NO_CONVERGENCE, INTERRUPTED = EXIT_CODES


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command.

    Parameters
    ----------
    arguments : sequence of str, optional
        Default: those of the process.

    Returns
    -------
    int
        The exit code.
    """
    arguments = list(sys.argv[1:] if arguments is None else arguments)
    if isinstance(sys.stdout, io.TextIOWrapper):  # titles may hold characters that the terminal does not know
        sys.stdout.reconfigure(errors="backslashreplace")
    try:
        with collecting_garbage(False), warnings_in_one_line_each():
            options = command_line().parse_args(arguments)
            # xarray that is there already has looked for dask, and imports it where it saw it.
            needed = getattr(options, "scheduler", None) or "xarray" in sys.modules
            silent = quiet(getattr(options, "quiet", False))
            with nullcontext() if needed else hidden("dask"), _jobs_of(options), as_files_write(options), silent:
                options.command(options)
            flush()
    except (Exception, KeyboardInterrupt) as error:  # whatever happens ends in one line
        if "--traceback" in arguments and not isinstance(error, KeyboardInterrupt | BrokenPipeError):
            traceback.print_exc()
        if isinstance(error, OSError) and error.filename is None:
            let_go(sys.stdout)
        code, lines = _told(error)
        for line in (*lines, *getattr(error, "__notes__", ())):
            say(f"loaded-tca: {line}")
        return code
    return OK


def _jobs_of(options: argparse.Namespace) -> AbstractContextManager[None]:
    """Inside it a command does as many works at once as its options ask for."""
    if (count := getattr(options, "jobs", None)) is None:
        return nullcontext()
    from loaded_tca.threads import with_jobs

    return with_jobs(count)


def _told(error: BaseException) -> tuple[int, list[str]]:
    """Exit code and lines of an error."""
    if isinstance(error, KeyboardInterrupt):
        return INTERRUPTED, ["interrupted; no file is half written"]
    if isinstance(error, BrokenPipeError):  # whoever read the output has closed it
        return OK, []
    if isinstance(error, OSError):  # what the package writes tells by itself what cannot be written
        return BAD_INPUT, [f"{error.filename or 'standard output: cannot be written'}: {reason_of(error)}"]
    if isinstance(error, ExecutorError):
        return FAULT, [str(error)]
    if isinstance(error, ConvergenceError):
        return NO_CONVERGENCE, str(error).splitlines()
    if isinstance(error, LoadedTCAError):
        problems = error.problems if isinstance(error, InputError) else (str(error),)
        return BAD_INPUT, [" ".join(problem.split()) for problem in problems]
    if isinstance(error, MemoryError):
        return BAD_INPUT, [
            "out of memory; ask for fewer analysis.cells, a larger analysis.accuracy, or fewer positions"
        ]
    what = f"{type(error).__name__}: {error}".splitlines()[0]
    return FAULT, [f"a fault of the program, please report it with the output of --traceback: {what}"]
