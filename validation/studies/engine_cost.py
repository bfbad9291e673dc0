"""What the engine of studies costs beside the analyses, and how far it carries.

Empty analyses, which return the key figures of one that was made before, show the cost of the engine itself: in this
process, on a cluster of two workers beside bare tasks, in memory and on disk. Variants of the micro-geometry (9
positions, one torque, the helical pair 34/57 of the mesh cycles) show what two workers gain, and how many cycles a core
makes. Every measurement is a process of its own; what is compared takes turns in it.

Run from the root of the repository, on a machine that does nothing else: ``python -m validation.studies.engine_cost``;
writes docs/studies/engine_cost.md. Needs the packages dask and distributed.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import time
import warnings
from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from contextlib import ExitStack
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from loaded_tca import read_scene
from loaded_tca.scene import Scene
from loaded_tca.studies import Study, figures, process_pool, run_study

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "studies" / "engine_cost.md"
SCENE = ROOT / "examples" / "scenes" / "mesh_cycle_helical.toml"
CROWNING = "pinion.modifications.lead_crowning_um"
NINE: dict[str, Any] = {"analysis.positions": 9, "analysis.torques_Nm": None, "load.pinion_torque_Nm": 130.0}
FLANKS: dict[str, Any] = {"analysis.compliance": "contact", "analysis.free_edges": False}
RUNS, EMPTY, FULL = 3, 2000, 32
"""Runs that take turns, empty analyses and variants in each."""


def study(variants: int, changes: Mapping[str, Any] = NINE) -> Study:
    """Variants of the crowning."""
    return Study(read_scene(SCENE).with_changes(changes), {CROWNING: np.linspace(2.0, 10.0, variants)})


@cache
def known() -> dict[str, Any]:
    """Key figures of one analysis, made once in each process."""
    return figures(read_scene(SCENE).with_changes({**NINE, **FLANKS, "analysis.positions": 3}))


def empty(_: Scene) -> dict[str, Any]:
    """Return key figures without an analysis."""
    return known()


def bare(number: int) -> int:
    """Return what a task was given."""
    return number


def seconds(call: Callable[..., Any], *arguments: Any, **named: Any) -> float:
    """Time of a call."""
    begin = time.perf_counter()
    call(*arguments, **named)
    return time.perf_counter() - begin


def in_process() -> dict[str, float]:
    """Milliseconds of the engine for a variant."""
    run_study(study(10), figures=empty)
    runs = [seconds(run_study, study(EMPTY), figures=empty) for _ in range(RUNS)]
    return {"own": 1e3 * statistics.median(runs) / EMPTY}


def cluster(stack: ExitStack) -> Executor:
    """Two workers of one thread each behind a scheduler."""
    from distributed import Client, LocalCluster

    local = stack.enter_context(LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0"))
    executor: Executor = stack.enter_context(Client(local)).get_executor(pure=False)
    return executor


def on_cluster() -> dict[str, float]:
    """Milliseconds of a bare task and of an empty variant through a scheduler."""

    def tasks() -> None:
        for future in [executor.submit(bare, number) for number in range(EMPTY)]:
            future.result()

    with ExitStack() as stack:
        executor = cluster(stack)
        run_study(study(50), executor, figures=empty)
        runs = [(seconds(tasks), seconds(run_study, study(EMPTY), executor, figures=empty)) for _ in range(RUNS)]
    return {
        "bare": 1e3 * statistics.median(task for task, _ in runs) / EMPTY,
        "own": 1e3 * statistics.median(own for _, own in runs) / EMPTY,
    }


def two_workers() -> dict[str, float]:
    """How many times as quick as one process two are, and a cluster of two workers."""
    with ExitStack() as stack:
        engines = {
            "one": stack.enter_context(process_pool(1)),
            "two": stack.enter_context(process_pool(2)),
            "cluster": cluster(stack),
        }
        for engine in engines.values():
            run_study(study(12), engine)
        runs = [
            {name: seconds(run_study, study(FULL), engine) for name, engine in engines.items()} for _ in range(RUNS)
        ]
    return {name: statistics.median(run["one"] / run[name] for run in runs) for name in ("two", "cluster")}


def memory(samples: int) -> dict[str, float]:
    """Largest memory of the parent of two workers [MiB]: all, and beyond that of a study of 100 empty variants."""
    with TemporaryDirectory() as folder, process_pool(2) as pool:
        peaks = []
        for count in (100, samples):
            run_study(study(count), pool, Path(folder, f"{count}.nc"), figures=empty)
            peaks.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)
    return {"all": peaks[1], "more": peaks[1] - peaks[0]}


def files(samples: int) -> dict[str, float]:
    """Sizes of the files of a study [MB], and seconds to read its rows again."""
    with TemporaryDirectory() as folder:
        out = Path(folder, "study.nc")
        found = run_study(study(samples), out=out, figures=empty)
        found.to_dataframe().to_csv(Path(folder, "study.csv"))
        sizes = {path.suffix[1:]: path.stat().st_size / 1e6 for path in Path(folder).iterdir()}
        return {**sizes, "again": seconds(run_study, study(samples), out=out, figures=empty)}


def cycles() -> dict[str, float]:
    """Cycles a minute and core: flanks alone, and with the defaults."""
    found = {}
    for name, changes in {"flanks": {**NINE, **FLANKS}, "defaults": NINE}.items():
        run_study(study(3, changes))
        begin = time.process_time()
        run_study(study(FULL, changes))
        found[name] = 60.0 * FULL / (time.process_time() - begin)
    return found


MEASUREMENTS: dict[str, Callable[[], dict[str, float]]] = {
    "in_process": in_process,
    "on_cluster": on_cluster,
    "two_workers": two_workers,
    "memory_1e4": lambda: memory(10_000),
    "memory_1e5": lambda: memory(100_000),
    "files_1e3": lambda: files(1_000),
    "cycles": cycles,
}


def measured(name: str) -> dict[str, float]:
    """Return what a process of its own finds."""
    surroundings = os.environ | {"PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"}
    code = (
        f"from validation.studies.engine_cost import tell; tell({name!r})"  # no __main__, which workers would be sent
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, env=surroundings, stdout=subprocess.PIPE, text=True, check=True
    )
    found: dict[str, float] = json.loads(done.stdout.splitlines()[-1])
    print(name, found, flush=True)
    return found


def tell(name: str) -> None:
    """Print what a measurement finds."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        print(json.dumps(MEASUREMENTS[name]()))


def page(found: Mapping[str, Mapping[str, float]]) -> str:
    """Markdown of all measurements."""
    from validation.page import machine

    rate = 1e3 / found["on_cluster"]["bare"]
    rows = [
        ("engine in this process, a variant", f"{found['in_process']['own']:.2f} ms", "2 ms"),
        ("bare task through a scheduler", f"{found['on_cluster']['bare']:.2f} ms: {rate:.0f} tasks a second", ""),
        ("engine through a scheduler, a variant", f"{found['on_cluster']['own']:.2f} ms", "4 ms"),
        ("two processes, times as quick as one", f"{found['two_workers']['two']:.2f}", "1.85"),
        ("two workers behind a scheduler, times as quick as one", f"{found['two_workers']['cluster']:.2f}", "1.75"),
        ("memory of the parent, 10 000 variants more", f"{found['memory_1e4']['more']:.0f} MiB", "50 MiB"),
        ("memory of the parent, 100 000 variants more", f"{found['memory_1e5']['more']:.0f} MiB", ""),
        ("cycles a minute and core, flanks alone", f"{found['cycles']['flanks']:.0f}", "800"),
        ("cycles a minute and core, defaults", f"{found['cycles']['defaults']:.0f}", "300"),
    ]
    one = found["files_1e3"]
    sizes = f"| {one['jsonl']:.1f} | {one['nc']:.1f} | {one['csv']:.1f} | {one['again']:.1f} |"
    lines = [
        "# What a study costs beside its analyses",
        "",
        "Written by `python -m validation.studies.engine_cost`. The cost of the engine is that of empty analyses,",
        f"which return the key figures of one made before: medians of {RUNS} runs of {EMPTY} variants. Two workers are",
        f"compared with one on {FULL} variants of the crowning of a helical pair 34/57 with the defaults, 9 positions",
        "and one torque; the cycles a minute are those of the same variants. Workers are warm: they have analysed",
        "before, and keep the models of teeth. The last column is the aim, set before; not every row",
        "reaches it.",
        "",
        f"{machine()}.",
        "",
        "| what | found | aim |",
        "| --- | --- | --- |",
        *(f"| {what} | {number} | {aim} |" for what, number, aim in rows),
        "",
        "Files of a study of 1000 variants of one torque without warnings, and the time of a run that finds all of",
        "them there. They grow in proportion to the variants.",
        "",
        "| rows.jsonl [MB] | study.nc [MB] | study.csv [MB] | read again [s] |",
        "| --- | --- | --- | --- |",
        sizes,
    ]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Measure and write the page."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--one", choices=MEASUREMENTS, help="only this measurement; write no page")
    arguments = parser.parse_args()
    if arguments.one:
        measured(arguments.one)
        return
    PAGE.write_text(page({name: measured(name) for name in MEASUREMENTS}), encoding="utf-8")


if __name__ == "__main__":
    main()
