"""How time and memory of a contact solve grow with its cells, beside two other solvers up to where they go.

The circle of :mod:`validation.contact.speed_against_error` at a tolerance of 1e-6. Each solve is timed in a process of
its own: one cold, then warm ones, of which the least time counts. Memory is the most that the process held above what
it held after the imports: the gap and the solution count, too.

Run from the root of the repository: ``python -m validation.contact.growth``.
"""

from typing import NamedTuple

from loaded_tca.contact import solve_contact
from validation.contact.speed_against_error import CODES, E_STAR, LOAD, Problem
from validation.page import Page, in_a_process, machine, peak_memory, table, timed, write_page

BASE = 512
"""Cells along an axis of the grid that others are compared with."""
HEAD = "code | threads | grid | least time [s] | time per cell [us] | over that at 512 x 512 | memory per cell [bytes]"

BEYOND = """Above 1024 x 1024 the fields exceed the cache of the processor, and the system hands out the memory of the
largest ones anew in every solve. The coefficients of all these grids fit what is kept for the next solve (256 MiB).
"""


class Growth(NamedTuple):
    """Of one code on a grid of ``n`` x ``n`` cells."""

    code: str
    threads: int
    n: int
    seconds: float
    memory: float

    @property
    def per_cell(self) -> float:
        """Time per cell [us]."""
        return 1e6 * self.seconds / self.n**2


def solve(code: str, threads: int, n: int, runs: int) -> tuple[float, float]:
    """Least time [s] of warm solves, peak memory [bytes] of the first above the imports; for a process of its own."""
    CODES[code](Problem.make("circle", 32, 1e-6))()  # what is imported late
    before = peak_memory()
    problem = Problem.make("circle", n, 1e-6)

    def ours() -> object:
        return solve_contact(
            problem.gap, problem.spacing, E_STAR, load=LOAD, tolerance=problem.tolerance, threads=threads, warn=False
        )

    run = ours if code == "loaded_tca" else CODES[code](problem)
    run()
    memory = peak_memory() - before
    _, times = timed(run, runs)
    return min(times), 2.0**30 * memory


def page(largest: int, largest_of_peers: int) -> Page:
    """Measure on grids up to the largest ones."""
    found: list[Growth] = []
    for code in CODES:
        if not in_a_process(installed, code):
            continue
        end = largest if code == "loaded_tca" else largest_of_peers
        for threads in (1, 2) if code == "loaded_tca" else (1,):
            for n in (n for n in (BASE, 1024, 2048, 4096) if n <= end):
                found.append(Growth(code, threads, n, *in_a_process(solve, code, threads, n, max(1, 4096 // n))))
    base = {(row.code, row.threads): row.per_cell for row in found if row.n == BASE}
    rows = (
        f"{row.code} | {row.threads} | {row.n} x {row.n} | {row.seconds:.3g} | {row.per_cell:.3g} "
        f"| {row.per_cell / base[row.code, row.threads]:.2f} | {row.memory / row.n**2:.0f}"
        for row in found
    )
    text = [
        "# Growth of time and memory with the grid\n",
        "Written by `python -m validation.contact.growth`: circle, tolerance 1e-6.\n",
        f"- {machine()}\n",
        table(HEAD, rows),
        "",
        BEYOND,
    ]
    return Page("contact_growth", "\n".join(text))


def installed(code: str) -> bool:
    """Whether a code can be imported."""
    try:
        CODES[code](Problem.make("circle", 32, 1e-6))
    except ImportError:
        return False
    return True


if __name__ == "__main__":
    write_page(__doc__, page, largest=4096, largest_of_peers=1024)
