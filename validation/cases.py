"""Cases of the validation: run one by one or in several processes; the rows of each, and how long it took.

They stand apart from the command: processes that are started anew do not import the module of a command.
"""

import multiprocessing
import sys
import time
import traceback
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from importlib import import_module
from math import nan
from textwrap import shorten

from loaded_tca.threads import one_thread
from validation.table import Row, render


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


def run_case(case: str, which: str = "rows") -> Outcome:
    """Rows of one case, or its ``short_rows`` or ``whole_rows`` where it has them."""
    start = time.perf_counter()
    try:
        module = import_module(f"validation.{case}")
        rows = list(getattr(module, which, module.rows)())
    except Exception as error:  # whatever a case raises is a result of that case
        return _failed(case, error, time.perf_counter() - start)
    return Outcome(rows, time.perf_counter() - start)


def _failed(case: str, error: BaseException, seconds: float = 0.0) -> Outcome:
    text = shorten(f"raised {type(error).__name__}: {error}", 120)
    row = Row(case, f"validation.{case}", text, 0.0, nan, 0.0)
    return Outcome([row], seconds, "".join(traceback.format_exception(error)))


def run_cases(cases: Sequence[str], processes: int = 1, which: str = "rows") -> dict[str, Outcome]:
    """Outcomes of cases in their order; each is reported on the error output when it ends, with rows that fail.

    Parameters
    ----------
    cases : sequence of str
        They begin in this order.
    processes : int
        Of more than one each keeps to one core.
    which : str
        ``rows``, or ``whole_rows``.
    """
    outcomes: dict[str, Outcome] = {}
    for case, outcome in _one_by_one(cases, which) if processes == 1 else _at_a_time(cases, processes, which):
        outcomes[case] = outcome
        beyond = [row for row in outcome.rows if not row.holds]
        words = f"{len(outcome.rows)} rows, {len(beyond)} beyond the tolerance, {outcome.seconds:.1f} s"
        table = f"\n{render(beyond)}" if beyond else ""
        print(f"{outcome.traceback}[{len(outcomes)}/{len(cases)}] {case}: {words}{table}", file=sys.stderr, flush=True)
    return {case: outcomes[case] for case in cases}


def _one_by_one(cases: Sequence[str], which: str) -> Iterator[tuple[str, Outcome]]:
    return ((case, run_case(case, which)) for case in cases)


def _at_a_time(cases: Sequence[str], processes: int, which: str) -> Iterator[tuple[str, Outcome]]:
    """Cases and their outcomes as they end; a case whose process dies has failed."""
    with ProcessPoolExecutor(processes, multiprocessing.get_context("spawn")) as pool:
        futures = {pool.submit(_on_one_core, case, which): case for case in cases}
        try:
            for future in as_completed(futures):
                error = future.exception()
                yield futures[future], _failed(futures[future], error) if error else future.result()
        finally:  # an interrupt leaves out the cases that have not begun
            pool.shutdown(wait=False, cancel_futures=True)


def _on_one_core(case: str, which: str) -> Outcome:
    with one_thread():
        return run_case(case, which)


def times(outcomes: Mapping[str, Outcome]) -> str:
    """Rows and seconds of each case, the longest first."""
    order = sorted(outcomes, key=lambda case: -outcomes[case].seconds)
    lines = [f"{outcomes[case].seconds:9.1f}  {len(outcomes[case].rows):5d}  {case}" for case in order]
    return "\n".join(["  seconds   rows  case", *lines])
