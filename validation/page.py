"""Pages of ``docs/studies``: tables in Markdown, times, the machine, and the command line of scripts that write them.

A script has a function that measures and returns a :class:`Page`, and ends with ``write_page(__doc__, page)``: the page
is printed and written with its pictures into ``docs/studies``, or where ``--out`` says. What is compared in time takes
turns (:func:`take_turns`), and the page has medians (:func:`medians`, :func:`median_ratio`).
"""

from __future__ import annotations

import json
import math
import os
import platform
import re
import statistics
import subprocess
import sys
import time
from argparse import ArgumentParser
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import date
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

import loaded_tca

if TYPE_CHECKING:  # processes whose memory is measured load no matplotlib
    from matplotlib.figure import Figure

ROOT = Path(__file__).resolve().parents[1]
STUDIES, SCENES = ROOT / "docs" / "studies", ROOT / "examples" / "scenes"
SPACED = " --- "
"""Rule of a table with room beside its bars."""

Cells = str | Iterable[object]
"""Cells of a line, or their text with bars between the columns."""
Result = TypeVar("Result")


@dataclass(frozen=True)
class Page:
    """A page of the studies.

    Attributes
    ----------
    name : str
        File without its ending.
    text : str or None
        Markdown; None if the page of the pictures is written by hand.
    pictures : dict of str to Figure
        By file, without the ending.
    dots_per_inch : int
        Of the pictures.
    """

    name: str
    text: str | None
    pictures: Mapping[str, Figure] = field(default_factory=dict)
    dots_per_inch: int = 90

    def write(self, directory: Path) -> None:
        """Write the text and the pictures into a directory, which is made if it is not there."""
        directory.mkdir(parents=True, exist_ok=True)
        if self.text is not None:
            (directory / f"{self.name}.md").write_text(self.text, encoding="utf-8")
        for name, figure in self.pictures.items():
            figure.savefig(directory / f"{name}.png", dpi=self.dots_per_inch)


def write_page(description: str | None, make: Callable[..., Page], **options: Any) -> None:
    """Run the command line of a script: make its page, print the text, write text and pictures.

    Parameters
    ----------
    description : str or None
        Docstring of the script; the help shows its first line.
    make : callable
        Takes the options by keyword and returns the page.
    **options
        Options beside ``--out``, by name: the default, or the type of one that has none.
    """
    parser = ArgumentParser(description=(description or "").partition("\n")[0])
    parser.add_argument("--out", type=Path, default=STUDIES, help="directory of the page and its pictures")
    for name, default in options.items():
        kind, value = (default, None) if isinstance(default, type) else (type(default), default)
        parser.add_argument(f"--{name.replace('_', '-')}", type=kind, default=value)
    arguments = vars(parser.parse_args())
    directory: Path = arguments.pop("out")
    page = make(**arguments)
    if page.text is not None:
        print(page.text)
    page.write(directory)


def line(cells: Cells) -> str:
    """One line of a table."""
    return f"| {cells if isinstance(cells, str) else ' | '.join(map(str, cells))} |"


def lines(rows: Iterable[Cells]) -> str:
    """Lines of a table whose head stands in the text of the page."""
    return "\n".join(map(line, rows))


def table(head: Cells, rows: Iterable[Cells], rule: str = "---") -> str:
    """A table in Markdown.

    Parameters
    ----------
    head : str or iterable
        Names of the columns.
    rows : iterable of str or of iterables
        Cells of each line.
    rule : str
        What stands in each column between the head and the lines.

    Examples
    --------
    >>> print(table("pair | error", [("spur", 0.1), "helical | 0.2"]))
    | pair | error |
    |---|---|
    | spur | 0.1 |
    | helical | 0.2 |
    """
    first = line(head)
    return "\n".join([first, "|" + f"{rule}|" * (first.count("|") - 1), *map(line, rows)])


def formatted(style: str, *values: float) -> list[str]:
    """Numbers in one format."""
    return [f"{value:{style}}" for value in values]


def machine(numpy: bool = False, before: Path | None = None) -> str:
    """Processor, cores and Python of this machine, of NumPy if asked for, the version of the package, and the day.

    ``before``: a checkout that is measured beside this one; hash and day of its revision follow.
    """
    model = platform.processor()
    if Path("/proc/cpuinfo").exists():
        entries = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        model = next((entry.split(":")[1].strip() for entry in entries if entry.startswith("model name")), model)
    words = f"{model}, {os.cpu_count()} cores, Python {platform.python_version()}"
    words += f", NumPy {np.__version__}" if numpy else ""
    words += f", loaded_tca {loaded_tca.__version__}, {date.today():%-d %B %Y}"
    if before is None:
        return words
    asked = ["git", "-C", str(before), "log", "-1", "--format=%h of %as"]
    revision = subprocess.run(asked, check=True, capture_output=True, text=True).stdout.strip()
    return f"{words}; before: revision {revision}"


def timed(
    call: Callable[[], Result],
    runs: int = 1,
    *,
    least: int = 1,
    budget: float = math.inf,
    clock: Callable[[], float] = time.perf_counter,
) -> tuple[Result, list[float]]:
    """Result of a call, and the time of each run [s].

    Parameters
    ----------
    call : callable
        Without arguments.
    runs : int
        Most runs.
    least : int
        Runs that are made whatever they take.
    budget : float [s]
        Time after which no other run begins.
    clock : callable
        ``time.perf_counter``, or ``time.process_time`` for processor time.
    """
    taken: list[float] = []
    while len(taken) < least or (len(taken) < runs and sum(taken) < budget):
        begin = clock()
        result = call()
        taken.append(clock() - begin)
    return result, taken


def take_turns(calls: Mapping[str, Callable[[], Result]], runs: int) -> dict[str, list[Result]]:
    """Results of calls by name, one of each run: in every run all calls are made one after the other."""
    results: dict[str, list[Result]] = {name: [] for name in calls}
    for _ in range(runs):
        for name, call in calls.items():
            results[name].append(call())
    return results


def take_times(
    calls: Mapping[str, Callable[[], object]], runs: int, clock: Callable[[], float] = time.perf_counter
) -> dict[str, list[float]]:
    """Times [s] of calls that take turns."""

    def taken(call: Callable[[], object]) -> float:
        return timed(call, clock=clock)[1][0]

    return take_turns({name: partial(taken, call) for name, call in calls.items()}, runs)


def medians(values: Mapping[str, Iterable[float]]) -> dict[str, float]:
    """Median of each name's values."""
    return {name: statistics.median(several) for name, several in values.items()}


def median_ratio(values: Sequence[float], others: Sequence[float]) -> float:
    """Median of the ratios of values to those of the same run."""
    return statistics.median(value / other for value, other in zip(values, others, strict=True))


def peak_memory() -> float:
    """Most memory that this process has held so far, or since ``forget_peak_memory`` [GiB], by the kernel of Linux.

    `resource` counts that of its parent.
    """
    status = Path("/proc/self/status").read_text(encoding="utf-8")
    return int(re.search(r"VmHWM:\s+([0-9]+) kB", status)[1]) / 2**20  # type: ignore[index]


def forget_peak_memory() -> None:
    """Let ``peak_memory`` begin anew, from what this process holds now."""
    Path("/proc/self/clear_refs").write_text("5", encoding="utf-8")


def in_a_process(call: Callable[..., Result], *arguments: object, tree: Path = ROOT) -> Result:
    """Result of a script's function in a process of its own with one thread.

    Parameters
    ----------
    call : callable
        Function of a module of ``validation``, whose result can be written as JSON.
    *arguments
        Texts, numbers and truth values.
    tree : Path
        Root of the checkout whose ``loaded_tca`` the function takes; ``validation`` is that of this one.
    """
    module = call.__module__
    if module == "__main__":
        module = sys.modules[module].__spec__.name  # type: ignore[union-attr]
    code = [
        "import json, sys",
        f"sys.path.insert(0, {str(tree)!r})",
        "import loaded_tca",
        f"sys.path.insert(0, {str(ROOT)!r})",
        f"from {module} import {call.__name__} as call",  # no __main__, which pools would send to their workers
        f"print(json.dumps(call(*{arguments!r})))",
    ]
    surroundings = os.environ | {"PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"}
    done = subprocess.run(
        [sys.executable, "-c", "\n".join(code)], env=surroundings, stdout=subprocess.PIPE, text=True, check=True
    )
    result: Result = json.loads(done.stdout.splitlines()[-1])
    return result
