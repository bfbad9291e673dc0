"""What the command shows on a terminal: lines, bars, warnings, and whatever goes wrong."""

from __future__ import annotations

import gc
import os
import re
import shutil
import sys
import textwrap
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from pathlib import Path
from threading import Event, Thread
from typing import TYPE_CHECKING, TextIO

if TYPE_CHECKING:
    from loaded_tca.effort import Effort
    from loaded_tca.studies import Study

BAR = "{desc}: {percentage:3.0f}%|{bar}| {n_fmt}/{total_fmt}, {elapsed} gone, {remaining} left"
STUDY_BAR = "{desc}: {percentage:3.0f}%|{bar}| {n_fmt}/{total_fmt}, {rate_inv_fmt}, {elapsed} gone, {remaining} left"
NOT_BY_ITSELF = 1e-9
"""Delay [s] of a bar that does not draw itself while it is made."""
TICK = 1.0
"""Seconds after which a bar is drawn again, also where one contact takes longer."""
WORTH_TELLING = 10.0
"""Seconds from which an estimate is told where there is no terminal, too."""
WIDTH, LEAST_WIDTH = 120, 40
"""Characters of a line where there is no terminal, and at least."""
INDENT = "    "
"""Before the parts of a line that goes on."""


def flush() -> None:
    """Write what was printed, while a failure can still be told."""
    if sys.stdout is not None:  # closed from the start
        sys.stdout.flush()


def let_go(stream: TextIO | None) -> None:
    """Give up a stream that cannot be written: what it holds would fail again when the interpreter ends."""
    if stream is not None:
        with suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def say(line: str) -> None:
    """Print a line on standard error, if that can be written."""
    if sys.stderr is not None:
        try:
            print(line, file=sys.stderr)
        except OSError:
            let_go(sys.stderr)


_QUIET: ContextVar[bool] = ContextVar("quiet", default=False)
"""Whether nothing but errors, warnings and what was asked for by name is shown."""


@contextmanager
def quiet(wanted: bool) -> Iterator[None]:
    """Show no overview, no progress and no names of files inside it, if that is wanted."""
    before = _QUIET.set(wanted)
    try:
        yield
    finally:
        _QUIET.reset(before)


def width_of_lines() -> int:
    """Characters of a line of the terminal; those of a usual page where the output is none."""
    if sys.stdout is None or not sys.stdout.isatty():
        return WIDTH
    return max(shutil.get_terminal_size((WIDTH, 1)).columns, LEAST_WIDTH)


def fitted(text: str, width: int, *, sentences: bool) -> str:
    r"""Return text whose lines have at most so many characters.

    Lines of tables, whose cells two blanks or more part, go on below themselves, a whole number of cells in each line:
    cells that stand below each other still do. Of lines without cells, sentences break at blanks, where that is wanted.

    Examples
    --------
    >>> print(fitted("torque [N m]     80    100   120\npeak [MPa]     912.3  1004  1100", 28, sentences=True))
    torque [N m]     80    100
           120
    peak [MPa]     912.3  1004
          1100
    """
    return "\n".join(part for line in text.split("\n") for part in _parts(line, width, sentences))


def _parts(line: str, width: int, sentences: bool) -> Iterator[str]:
    """A line in parts that are short enough, those after the first indented."""
    cells = [match.end() for match in re.finditer(r"\S+(?: \S+)*", line)]
    if len(line) <= width or (len(cells) == 1 and not sentences):
        yield line
        return
    if len(cells) == 1:
        yield from textwrap.wrap(line, width, subsequent_indent=INDENT, break_long_words=False, break_on_hyphens=False)
        return
    begin, indent = 0, ""
    while begin < len(line):
        room = width - len(indent)
        ends = [end for end in cells if begin < end]
        end = max((one for one in ends if one - begin <= room), default=ends[0])
        part = line[begin:end]
        yield indent + (part if len(part) <= room else part.lstrip())
        begin, indent = end, INDENT


def show(text: str) -> None:
    """Show an overview: lines no longer than those of the terminal, none if the command is quiet but its warnings."""
    if _QUIET.get():
        for line in text.splitlines():
            if line.startswith("warning: "):
                say(line)
        return
    print(fitted(text, width_of_lines(), sentences=sys.stdout is not None and sys.stdout.isatty()))


def print_summary(text: str, paths: Sequence[Path]) -> None:
    """Show a summary, and say which files were written; warnings that are told at the end are left out of it."""
    warned = {f"warning: {message}" for message in _messages()}
    show("\n".join(line for line in text.splitlines() if line not in warned) + "\n")
    print_files(paths)


def print_files(paths: Sequence[Path]) -> None:
    """Say which files were written, all in one directory, unless the command is quiet."""
    if not _QUIET.get():
        print(f"Written to {paths[0].parent}: {', '.join(path.name for path in paths)}")


@contextmanager
def progress_bar(effort: Effort, count: str, whole: int) -> Iterator[Callable[[int, int], None] | None]:
    """An estimate of the analysis and, on a terminal, a bar with what is done, of how much, and the time left.

    In a file or a pipe there is no bar, and an estimate only of an analysis that is long or exceeds the memory. The bar
    is there from the start, before the first position teeth that bend are modelled, and shows the time all along.

    Parameters
    ----------
    effort : Effort
    count : str
        What the bar counts.
    whole : int
        How many of them there are.
    """
    terminal = _draws()
    worth = terminal or effort.seconds > WORTH_TELLING or not effort.fits
    if worth and not effort.is_refused and not _QUIET.get():
        say(f"loaded-tca: {effort}")
    with bar_of(count, whole, BAR) as show:
        yield show


def say_cost(study: Study, workers: int = 1) -> None:
    """Print what the variants of a study take on a terminal, or where that is long.

    Each as the scene they have in common, roughly: variants with other grids differ, models of teeth are made once.
    """
    if _QUIET.get():
        return
    from loaded_tca.effort import expected_effort
    from loaded_tca.plain import plain
    from loaded_tca.scene import Scene
    from loaded_tca.studies.double_helical import expected_seconds_of_halves
    from loaded_tca.studies.stage import expected_seconds as of_stage
    from loaded_tca.threads import with_jobs

    with with_jobs(1):  # of each variant
        if isinstance(study.scene, Scene):
            each = expected_seconds_of_halves(study.scene) or expected_effort(study.scene).seconds
        else:
            each = of_stage(study) / len(study)
    whole = len(study) * each / max(1, min(workers, len(study)))
    if sys.stderr is not None and (sys.stderr.isatty() or whole > WORTH_TELLING):
        minutes = f"{plain(whole / 60.0, 2)} min" if whole > 100.0 else f"{plain(whole, 2)} s"
        by = f" by {workers} processes" if workers > 1 else ""
        say(f"loaded-tca: {len(study)} variants, roughly {plain(each, 2)} s each on idle cores, {minutes} together{by}")


def _draws() -> bool:
    """Whether there is a terminal for progress, and it is wanted."""
    return sys.stderr is not None and sys.stderr.isatty() and not _QUIET.get()


@contextmanager
def bar_of(what: str, whole: int, layout: str) -> Iterator[Callable[..., None] | None]:
    """On a terminal, a bar with what is done, of how much, and the time left: called with both, and failures."""
    with collecting_garbage(True), _bar(what, whole, layout) as show:
        yield show


@contextmanager
def _bar(what: str, whole: int, layout: str) -> Iterator[Callable[..., None] | None]:
    if not _draws():
        yield None
        return
    from tqdm import tqdm

    with tqdm(desc=what, total=whole, bar_format=layout, delay=NOT_BY_ITSELF) as bar:
        bar.refresh()  # drawn only where an interrupt ends its line
        finished = Event()

        def tick() -> None:
            while not finished.wait(TICK):
                bar.refresh()

        def show(done: int, total: int, failed: int = 0) -> None:
            if failed:
                bar.set_description_str(f"{what} ({failed} failed)", refresh=False)
            bar.total = total
            bar.update(done - bar.n)

        ticking = Thread(target=tick, daemon=True)
        ticking.start()
        try:
            yield show
        finally:
            finished.set()
            ticking.join()


@contextmanager
def collecting_garbage(wanted: bool) -> Iterator[None]:
    """Look for objects that refer to each other alone, or leave them.

    Imports and pictures make hundreds of thousands of objects that stay: a tenth of the time of a short command would
    go into looking them through. Analyses and studies may be long, and their memory is not to grow.
    """
    before = gc.isenabled()
    (gc.enable if wanted else gc.disable)()
    try:
        yield
    finally:
        (gc.enable if before else gc.disable)()


_CAUGHT: ContextVar[Sequence[warnings.WarningMessage]] = ContextVar("caught", default=())
"""Warnings that the command has raised so far."""


def _messages() -> dict[str, None]:
    """Warnings that the command has raised so far, in one line each, those that are alike once."""
    return dict.fromkeys(" ".join(str(entry.message).split()) for entry in _CAUGHT.get())


@contextmanager
def warnings_in_one_line_each() -> Iterator[None]:
    """Collect warnings and tell each once, also if an error follows: how often code comes by says nothing of gears."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        warnings.simplefilter("ignore", ResourceWarning)  # files that an interrupt leaves open
        before = _CAUGHT.set(caught)
        try:
            yield
        finally:
            for message in _messages():
                say(f"warning: {message}")
            _CAUGHT.reset(before)
