"""Time of a contact problem in stacks of several sizes: on 16, 32 and 64 cells, from nothing and from a neighbour.

Slender contacts (axes about 1 : 13) whose curvatures and loads differ by a fifth, boxes 1.5 times the contact,
tolerance 1e-4, one thread. Every column is a process of its own; the columns take turns, and the table has the medians
of processor time. With ``--before DIR`` there is a column for another checkout of the project, which solves the
problems one after the other if it knows no stacks.

Run from the root of the repository: ``python -m validation.contact.stacks``.
"""

import argparse
import statistics
import time
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

import loaded_tca.contact as package
from loaded_tca.contact import ContactProblem, solve_problem
from loaded_tca.reference.hertz import point_contact
from validation.page import in_a_process, table, take_turns, timed

E_STAR = 113e3
TOLERANCE = 1e-4
SIZES = (1, 8, 32, 128)
CASES = ("16", "32", "32 warm", "32 slices", "32 slices, warm", "32 cap", "32 cover", "64")
RUNS = 5


def problems(case: str, count: int, seed: int = 0) -> list[ContactProblem]:
    """Contacts that are near each other and none like another."""
    rng, cells = np.random.default_rng(seed), int(case[:2])
    made = []
    for _ in range(count):
        load, across, along = (
            1000.0 * rng.uniform(0.8, 1.2),
            0.06 * rng.uniform(1.0, 1.2),
            1.2e-3 * rng.uniform(1.0, 1.2),
        )
        hertz = point_contact(load, (across, along), E_STAR)
        dx, dy = 3.0 * hertz.semi_minor / cells, 3.0 * hertz.semi_major / cells
        x, y = ((np.arange(cells) - 0.5 * cells + rng.uniform(0.4, 0.6)) * step for step in (dx, dy))
        gap, more = 0.5 * (across * x[:, None] ** 2 + along * y**2), {}
        if "slices" in case:
            more["slice_compliance"] = 3e-6 * np.exp(-np.abs(y[:, None] - y) / 3.0)
        if "cap" in case:
            more["max_pressure"] = 0.8 * hertz.max_pressure
        if "cover" in case:
            cover = np.clip(0.8 * cells + 0.07 * np.arange(cells)[:, None] - np.arange(cells), 0.0, 1.0)
            gap, more["cover"] = np.where(cover > 0.0, gap, np.inf), cover
        made.append(ContactProblem(gap, (dx, dy), E_STAR, load=load, **more))
    return made


def solve(stack: list[ContactProblem], starts: list[Any]) -> list[Any]:
    """Solve problems together, or one after the other where no stacks are known."""
    if hasattr(package, "solve_problems"):
        return package.solve_problems(stack, [TOLERANCE] * len(stack), starts, threads=1)
    pairs = zip(stack, starts, strict=True)
    return [solve_problem(each, tolerance=TOLERANCE, initial_pressure=start, threads=1) for each, start in pairs]


def measure(size: int, case: str) -> tuple[float, float]:
    """Microseconds of processor time, and iterations on the grid, for a problem in a stack of a size."""
    stack, starts = problems(case, size), [None] * size
    if "warm" in case:
        starts = [found.pressure for found in solve(problems(case, size, seed=1), starts)]
    iterations = statistics.mean(found.iterations for found in solve(stack, starts))
    repeats = max(1, 64 // size)
    _, times = timed(lambda: solve(stack, starts), repeats, clock=time.thread_time)
    return sum(times) / (repeats * size) * 1e6, iterations


def every_case(size: int) -> list[tuple[float, float]]:
    """All cases in stacks of a size."""
    return [measure(size, case) for case in CASES]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--before", type=Path, help="root of another checkout")
    before = parser.parse_args().before
    columns = {f"stack of {size}": partial(in_a_process, every_case, size) for size in SIZES}
    if before:
        columns = {"before": partial(in_a_process, every_case, SIZES[-1], tree=before.resolve())} | columns
    runs: dict[str, list[list[tuple[float, float]]]] = take_turns(columns, RUNS)
    rows = []
    for k, case in enumerate(CASES):
        found = ((statistics.median(run[k][0] for run in several), several[0][k][1]) for several in runs.values())
        rows.append([case, *(f"{microseconds:.0f} ({iterations:.1f})" for microseconds, iterations in found)])
    print(f"Microseconds a problem (mean iterations); medians of {RUNS}\n")
    print(table(["cells", *columns], rows))


if __name__ == "__main__":
    main()
