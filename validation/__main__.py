"""Run every comparison and print one table: ``python -m validation``; exit code 1 if a row fails.

The cases run in two processes, the longest first; how far they are goes to the error output. The table has a fixed
order, whichever case ends first; below it stand the seconds of each. A case that raises becomes one row that fails and
has the error; its traceback goes to the error output, and the other cases are run.

``--save rows.json`` keeps the numbers, ``--compare rows.json`` tells which have moved since: what a change of the code
did to them.
"""

import argparse
import json
import multiprocessing
import sys
import time
import traceback
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import asdict, dataclass
from importlib import import_module
from math import nan
from pathlib import Path
from textwrap import shorten

from loaded_tca.threads import one_thread
from validation.table import Row, moved, render

CASES = (
    "contact.sphere",
    "cylindrical.sam_paper",
    "unloaded.reduced_tca_misalignment",
    "unloaded.reduced_tca_tables",
    "unloaded.convergence_from_random_starts",
    "bevel.convergence",
    "unloaded.mounting_errors",
    "unloaded.mounting_error_map",
    "bevel.mounting_errors",
    "bevel.miter_gear_paper",
    "bevel.pressure",
    "unloaded.involute_pairs",
    "cylindrical.line_contact",
    "cylindrical.fzg_c14_geometry",
    "cylindrical.fzg_c14_root_stress",
    "bevel.iso_23509_sample",
    "face_milled.settings",
    "face_milled.swept_cutter",
    "face_milled.duplex_paper",
    "cylindrical.iso_tr_6336_30",
    "loaded.limits",
    "loaded.cut_contacts",
    "loaded.mesh_stiffness",
    "loaded.local_term",
    "loaded.root_stress",
    "loaded.root_stress_cycle",
    "loaded.root_stress_space",
    "loaded.root_face_load",
    "loaded.numbers_to_copy",
    "calculix.mesh_cycle",
    "contact.subsurface",
    "contact.free_edge",
    "contact.free_block",
    "contact.wedge",
    "contact.rounded_edge",
    "calculix.rounded_tip",
)

LONG = (
    "loaded.sensitivities",
    "studies.robust_design",
    "loaded.rounded_edges",
    "loaded.root_stress_families",
    "unloaded.rounded_edges",
)
"""Cases of minutes, which the tests leave out; the longest first.

Of other cases the tests have the ``short_rows``, where a module has them.
"""


@dataclass(frozen=True)
class Outcome:
    """What a case gives.

    Attributes
    ----------
    rows : list of Row
        One that fails where the case raised an error.
    seconds : float
        Time on the clock.
    traceback : str
        Of the error; empty without one.
    """

    rows: list[Row]
    seconds: float
    traceback: str = ""


def run_case(case: str, short: bool = False) -> Outcome:
    """Rows of one case, or its short rows where it has them."""
    start = time.perf_counter()
    try:
        module = import_module(f"validation.{case}")
        rows = list((getattr(module, "short_rows", module.rows) if short else module.rows)())
    except Exception as error:  # whatever a case raises is a result of that case
        return _failed(case, error, time.perf_counter() - start)
    return Outcome(rows, time.perf_counter() - start)


def _failed(case: str, error: BaseException, seconds: float = 0.0) -> Outcome:
    text = shorten(f"raised {type(error).__name__}: {error}", 120)
    row = Row(case, f"validation.{case}", text, 0.0, nan, 0.0)
    return Outcome([row], seconds, "".join(traceback.format_exception(error)))


def run_cases(cases: Sequence[str], processes: int = 1) -> dict[str, Outcome]:
    """Outcomes of cases in their order; each is reported on the error output when it ends.

    Parameters
    ----------
    cases : sequence of str
        They begin in this order.
    processes : int
        Of more than one each keeps to one core.
    """
    outcomes: dict[str, Outcome] = {}
    for case, outcome in _one_by_one(cases) if processes == 1 else _at_a_time(cases, processes):
        outcomes[case] = outcome
        failed = sum(not row.holds for row in outcome.rows)
        words = f"{len(outcome.rows)} rows, {failed} beyond the tolerance, {outcome.seconds:.1f} s"
        print(f"{outcome.traceback}[{len(outcomes)}/{len(cases)}] {case}: {words}", file=sys.stderr, flush=True)
    return {case: outcomes[case] for case in cases}


def _one_by_one(cases: Sequence[str]) -> Iterator[tuple[str, Outcome]]:
    return ((case, run_case(case)) for case in cases)


def _at_a_time(cases: Sequence[str], processes: int) -> Iterator[tuple[str, Outcome]]:
    """Cases and their outcomes as they end; a case whose process dies has failed."""
    with ProcessPoolExecutor(processes, multiprocessing.get_context("spawn")) as pool:
        futures = {pool.submit(_on_one_core, case): case for case in cases}
        try:
            for future in as_completed(futures):
                error = future.exception()
                yield futures[future], _failed(futures[future], error) if error else future.result()
        finally:  # an interrupt leaves out the cases that have not begun
            pool.shutdown(wait=False, cancel_futures=True)


def _on_one_core(case: str) -> Outcome:
    with one_thread():
        return run_case(case)


def times(outcomes: Mapping[str, Outcome]) -> str:
    """Rows and seconds of each case, the longest first."""
    order = sorted(outcomes, key=lambda case: -outcomes[case].seconds)
    lines = [f"{outcomes[case].seconds:9.1f}  {len(outcomes[case].rows):5d}  {case}" for case in order]
    return "\n".join(["  seconds   rows  case", *lines])


def main() -> int:
    """Print the table; 0 if every row holds."""
    parser = argparse.ArgumentParser(prog="python -m validation", description=__doc__.partition("\n\n")[0])
    parser.add_argument("--save", metavar="FILE", type=Path, help="keep the rows as JSON")
    parser.add_argument("--compare", metavar="FILE", type=Path, help="list the rows that differ from kept ones")
    parser.add_argument("--processes", metavar="N", type=int, default=2, help="cases that run at a time (default: 2)")
    options = parser.parse_args()
    if options.processes < 1:
        parser.error(f"--processes: {options.processes} is not positive")
    start = time.perf_counter()
    outcomes = run_cases((*LONG, *CASES), options.processes)
    rows = [row for case in (*CASES, *LONG) for row in outcomes[case].rows]
    print(render(rows))
    print(f"\n{times(outcomes)}")
    failed = sum(not row.holds for row in rows)
    shown = sum(row.tolerance is None for row in rows)
    seconds = f"{time.perf_counter() - start:.0f} s"
    print(f"\n{len(rows)} rows, {failed} beyond the tolerance; {shown} shown without a verdict; {seconds}")
    if options.save:
        options.save.write_text(json.dumps([asdict(row) for row in rows], indent=1, ensure_ascii=False) + "\n")
    if options.compare:
        print("\n".join(moved(rows, [Row(**row) for row in json.loads(options.compare.read_text())])))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
