"""Time and error of one loaded contact of a gear pair, before and after a change.

The contact of one tooth pair at the pitch point under the middle torque of its scene, flanks alone, its peak pressure
to 1e-3: its box, its gaps and its pressures on as many grids as that takes. Every run is a process of its own with one
thread, which solves the contact over and over and tells the median of its processor times, and that of what gaps take
of it; with ``--before DIR`` checkouts take turns. The errors of the peak are those against 256 x 256 cells of the same
checkout.

Run from the root of the repository: ``python -m validation.loaded.one_contact --before DIR``; writes
docs/studies/one_contact_speed.md.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from loaded_tca import read_scene, trace_contact
from loaded_tca.loaded.tooth_contact import GridChoice, solve_under_load
from validation.page import (
    ROOT,
    SCENES,
    SPACED,
    Page,
    in_a_process,
    line,
    machine,
    median_ratio,
    table,
    take_turns,
    timed,
    write_page,
)

NAMES = ("mesh_cycle_spur", "mesh_cycle_helical", "straight_bevel", "mesh_cycle_bevel")
RUNS, SECONDS, WARM, FINEST = 5, 0.3, 10, (256, 256)
SAMPLES = "sample_separations"


def measure(name: str) -> dict[str, Any]:
    """Processor time of a contact and of its gaps [ms], its cells and the error of its peak."""
    scene = read_scene(SCENES / f"{name}.toml")
    pair = scene.pair()
    contact = trace_contact(pair, [0.0])[0]
    load = statistics.median(scene.torques) / contact.pinion_lever
    solve = partial(solve_under_load, pair, contact, load)
    finest = solve(GridChoice(cells=FINEST, tolerance=1e-8)).peak_pressure
    call = partial(solve, GridChoice(accuracy=1e-3))
    timed(call, WARM)
    solved, seconds = timed(call, sys.maxsize, budget=SECONDS, clock=time.process_time)
    gaps = _of_gaps(call)
    return {
        "contact": 1e3 * statistics.median(seconds),
        "gaps": 1e3 * statistics.median(gaps),
        "cells": "x".join(map(str, solved.separation.gap.shape)),
        "error": abs(float(solved.peak_pressure / finest) - 1.0),
    }


def _of_gaps(call: Callable[[], Any], runs: int = 40) -> list[float]:
    """Processor time [s] that gaps take of each of several calls."""
    modules = [
        module
        for name, module in sys.modules.items()
        if name.startswith("loaded_tca.loaded.") and hasattr(module, SAMPLES)
    ]
    sample, taken = getattr(modules[0], SAMPLES), []

    def clocked(*arguments: Any, **keys: Any) -> Any:
        gaps, (seconds,) = timed(lambda: sample(*arguments, **keys), clock=time.process_time)
        taken[-1] += seconds
        return gaps

    for module in modules:
        setattr(module, SAMPLES, clocked)
    for _ in range(runs):
        taken.append(0.0)
        call()
    return taken


def page(before: Path | None) -> Page:
    """Measure every scene, beside another checkout if there is one."""
    trees = {"now": ROOT} if before is None else {"before": before.resolve(), "now": ROOT}
    rows = []
    for name in NAMES:
        runs = take_turns({word: partial(in_a_process, measure, name, tree=tree) for word, tree in trees.items()}, RUNS)
        row = [name]
        for several in runs.values():
            row.append(several[-1]["cells"])
            row += [f"{statistics.median(run[what] for run in several):.1f}" for what in ("contact", "gaps")]
            row.append(f"{several[-1]['error']:.1e}")
        if "before" in trees:
            for what in ("contact", "gaps"):
                times = ([run[what] for run in runs[word]] for word in ("now", "before"))
                row.append(f"{median_ratio(*times):.2f}")
        rows.append(row)
        print(line(row), flush=True)
    heads = [f"{word}: {what}" for word in trees for what in ("cells", "ms", "of it gaps", "error")]
    text = [
        "# Time of one contact",
        "",
        "Written by `python -m validation.loaded.one_contact`. One tooth pair at the pitch point under the middle",
        "torque of its scene, flanks alone, the peak of its pressure to 1e-3, from its contact point on: processor",
        f"time in milliseconds, one thread, medians of {RUNS} runs (of their ratios, too) that take turns. Errors of",
        f"the peak: against {FINEST[0]} x {FINEST[1]} cells. Two grids are solved: the last has twice the cells of the",
        "first along both axes, and their difference estimates the error.",
        "",
        f"{machine(before=before)}.",
        "",
        table(["scene", *heads, *["ratio", "ratio of gaps"] * (len(trees) == 2)], rows, SPACED),
    ]
    return Page("one_contact_speed", "\n".join(text) + "\n")


if __name__ == "__main__":
    write_page(__doc__, page, before=Path)
