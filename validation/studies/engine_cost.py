"""What the engine of studies costs beside the analyses, and how far it carries.

Empty analyses, which return the key figures of one that was made before, show the cost of the engine itself: in this
process, on a cluster of two workers beside bare tasks, in memory and on disk. Variants of the micro-geometry (9
positions, one torque, the helical pair 34/57 of the mesh cycles) show what two workers gain, and how many cycles a core
makes. Every measurement is a process of its own; what is compared takes turns in it.

Run from the root of the repository, on a machine that does nothing else: ``python -m validation.studies.engine_cost``;
writes docs/studies/engine_cost.md. Needs the packages dask and distributed.
"""

from __future__ import annotations

import statistics
import time
import warnings
from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from contextlib import ExitStack
from functools import cache, partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from loaded_tca import read_scene
from loaded_tca.scene import Scene
from loaded_tca.studies import Study, figures, process_pool, run_study
from validation.page import (
    SCENES,
    SPACED,
    Page,
    in_a_process,
    machine,
    median_ratio,
    medians,
    peak_memory,
    table,
    take_times,
    timed,
    write_page,
)

SCENE = SCENES / "mesh_cycle_helical.toml"
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


def in_process() -> dict[str, float]:
    """Milliseconds of the engine for a variant."""
    run_study(study(10), figures=empty)
    variants = study(EMPTY)
    _, seconds = timed(lambda: run_study(variants, figures=empty), RUNS)
    return {"own": 1e3 * statistics.median(seconds) / EMPTY}


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
        seconds = take_times({"bare": tasks, "own": partial(run_study, study(EMPTY), executor, figures=empty)}, RUNS)
    return {name: 1e3 * median / EMPTY for name, median in medians(seconds).items()}


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
        seconds = take_times({name: partial(run_study, study(FULL), each) for name, each in engines.items()}, RUNS)
    return {name: median_ratio(seconds["one"], seconds[name]) for name in ("two", "cluster")}


def memory(samples: int) -> dict[str, float]:
    """Largest memory of the parent of two workers [MiB]: all, and beyond that of a study of 100 empty variants."""
    with TemporaryDirectory() as folder, process_pool(2) as pool:
        peaks = []
        for count in (100, samples):
            run_study(study(count), pool, Path(folder, f"{count}.nc"), figures=empty)
            peaks.append(1024.0 * peak_memory())
    return {"all": peaks[1], "more": peaks[1] - peaks[0]}


def files(samples: int) -> dict[str, float]:
    """Sizes of the files of a study [MB], and seconds to read its rows again."""
    with TemporaryDirectory() as folder:
        out = Path(folder, "study.nc")
        found = run_study(study(samples), out=out, figures=empty)
        found.to_dataframe().to_csv(Path(folder, "study.csv"))
        sizes = {path.suffix[1:]: path.stat().st_size / 1e6 for path in Path(folder).iterdir()}
        _, (again,) = timed(lambda: run_study(study(samples), out=out, figures=empty))
        return {**sizes, "again": again}


def cycles() -> dict[str, float]:
    """Cycles a minute and core: flanks alone, and with the defaults."""
    found = {}
    for name, changes in {"flanks": {**NINE, **FLANKS}, "defaults": NINE}.items():
        run_study(study(3, changes))
        _, (seconds,) = timed(lambda changes=changes: run_study(study(FULL, changes)), clock=time.process_time)
        found[name] = 60.0 * FULL / seconds
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
    """A measurement without warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return MEASUREMENTS[name]()


def page(one: str | None) -> Page:
    """All measurements, each in a process of its own; a single one makes no page."""
    found = {}
    for name in MEASUREMENTS if one is None else [one]:
        found[name] = in_a_process(measured, name)
        print(name, found[name], flush=True)
    return Page("engine_cost", text_of(found) if one is None else None)


def text_of(found: Mapping[str, Mapping[str, float]]) -> str:
    """Markdown of all measurements."""
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
    sizes = [f"{one[name]:.1f}" for name in ("jsonl", "nc", "csv", "again")]
    text = [
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
        table("what | found | aim", rows, SPACED),
        "",
        "Files of a study of 1000 variants of one torque without warnings, and the time of a run that finds all of",
        "them there. They grow in proportion to the variants.",
        "",
        table("rows.jsonl [MB] | study.nc [MB] | study.csv [MB] | read again [s]", [sizes], SPACED),
    ]
    return "\n".join(text) + "\n"


if __name__ == "__main__":
    write_page(__doc__, page, one=str)
