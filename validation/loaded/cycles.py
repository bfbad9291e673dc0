"""Time of whole mesh cycles, before and after a change, and what it is spent on.

The mesh cycles in ``examples/scenes``: 33 positions, three torques, accuracy 1e-2, flanks alone and with the defaults
(teeth bend, free edges, models of teeth known). Every run is a process of its own with one thread, which analyses the
scene once to warm up and then takes the processor time of an analysis; with ``--before DIR`` checkouts take turns.
Shares of the time are those that a profile finds in the modules; it counts calls of Python at several times their
price.

Run from the root of the repository: ``python -m validation.loaded.cycles --before DIR``; writes
docs/studies/mesh_cycle_speed.md.
"""

from __future__ import annotations

import cProfile
import pstats
import statistics
import time
import warnings
from functools import partial
from pathlib import Path
from typing import Any

from loaded_tca import analyse, read_scene
from validation.page import (
    ROOT,
    SCENES,
    SPACED,
    Page,
    in_a_process,
    line,
    machine,
    median_ratio,
    medians,
    peak_memory,
    table,
    take_turns,
    timed,
    write_page,
)

NAMES = ("mesh_cycle_spur", "mesh_cycle_helical", "mesh_cycle_bevel")
SETTINGS: dict[str, dict[str, Any]] = {
    "flanks alone": {"load_sharing": True, "compliance": "contact", "free_edges": False},
    "defaults": {"load_sharing": True, "compliance": "contact+tooth", "free_edges": True},
}
RUNS = 5
PARTS = {
    "transforms": ("contact/convolution.py",),
    "rest of the solver": ("loaded_tca/contact/",),
    "gaps": ("loaded_tca/separation/", "loaded_tca/flanks/", "unloaded/curvature.py", "pairs/gear_pair.py"),
    "unloaded contact": ("loaded_tca/unloaded/",),
    "teeth and edges": ("loaded_tca/compliance/", "edges/free.py"),
    "balance": ("loaded/balance.py", "loaded/load_sharing.py"),
}
"""Where a function stands, the first that fits; those of libraries count where they are called from."""
REST, DEEPEST = "the rest", 4
Function = tuple[str, int, str]


def measure(name: str, setting: str, profiled: bool) -> dict[str, Any]:
    """Processor time of an analysis [s], peak memory of the process [MiB], shares of the profiled time."""
    changes = {f"analysis.{key}": value for key, value in SETTINGS[setting].items()}
    scene = read_scene(SCENES / f"{name}.toml").with_changes(changes)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        analyse(scene)
        _, (seconds,) = timed(lambda: analyse(scene), clock=time.process_time)
        peak = 1024.0 * peak_memory()
        profile = cProfile.Profile()
        if profiled:
            profile.runcall(analyse, scene)
    return {"seconds": seconds, "peak": peak, "shares": _shares(profile) if profiled else {}}


def _shares(profile: cProfile.Profile) -> dict[str, float]:
    """Parts of the time by where the functions stand."""
    stats: Any = pstats.Stats(profile)
    own = dict.fromkeys((*PARTS, REST), 0.0)
    for function, (_, _, seconds, _, _) in stats.stats.items():
        for part, share in _parts_of(function, stats.stats).items():
            own[part] += share * seconds
    total = sum(own.values())
    return {part: seconds / total for part, seconds in own.items()}


def _parts_of(function: Function, stats: dict[Function, Any], depth: int = 0) -> dict[str, float]:
    """Parts to which a function belongs, with their shares: those of its callers if it is none of the package."""
    for part, places in PARTS.items():
        if any(place in function[0] for place in places):
            return {part: 1.0}
    callers = stats[function][4] if function in stats else {}
    total = sum(entry[2] for entry in callers.values())
    if "loaded_tca" in function[0] or depth == DEEPEST or not total:
        return {REST: 1.0}
    found = dict.fromkeys((*PARTS, REST), 0.0)
    for caller, entry in callers.items():
        for part, share in _parts_of(caller, stats, depth + 1).items():
            found[part] += share * entry[2] / total
    return found


def page(before: Path | None) -> Page:
    """Measure every scene and setting, beside another checkout if there is one."""
    trees = {"now": ROOT} if before is None else {"before": before.resolve(), "now": ROOT}
    rows = []
    for name in NAMES:
        for setting in SETTINGS:
            calls = {
                word: partial(in_a_process, measure, name, setting, False, tree=tree) for word, tree in trees.items()
            }
            runs: dict[str, list[dict[str, Any]]] = take_turns(calls, RUNS)
            seconds = {word: [run["seconds"] for run in several] for word, several in runs.items()}
            cells = [f"{median:.2f}" for median in medians(seconds).values()]
            if "before" in trees:
                cells.append(f"{median_ratio(seconds['now'], seconds['before']):.2f}")
            last = in_a_process(measure, name, setting, True)
            peak = statistics.median(run["peak"] for run in runs["now"])
            cells += [f"{peak:.0f}", *(f"{100.0 * share:.0f} %" for share in last["shares"].values())]
            rows.append([name, setting, *cells])
            print(line(rows[-1]), flush=True)
    heads = [f"{word} [s]" for word in trees] + ["ratio"] * (len(trees) == 2)
    text = [
        "# Time of a mesh cycle",
        "",
        "Written by `python -m validation.loaded.cycles`. 33 positions, three torques, accuracy 1e-2: processor",
        "time of an analysis in a process that has done it once, one thread, medians of",
        f"{RUNS} runs (of their ratios, too) that take turns; models of teeth are known. The peak memory is that of",
        "the process with all its libraries. Shares are those of a profile, which overrates Python's calls against",
        "array passes and transforms.",
        "",
        f"{machine(before=before)}.",
        "",
        table(["scene", "setting", *heads, "peak memory [MiB]", *PARTS, REST], rows, SPACED),
    ]
    return Page("mesh_cycle_speed", "\n".join(text) + "\n")


if __name__ == "__main__":
    write_page(__doc__, page, before=Path)
