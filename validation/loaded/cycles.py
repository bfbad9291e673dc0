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

import argparse
import cProfile
import json
import os
import pstats
import resource
import statistics
import subprocess
import sys
import time
import warnings
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "studies" / "mesh_cycle_speed.md"
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
    "teeth and edges": ("loaded_tca/compliance/", "loaded/free_edges.py"),
    "balance": ("loaded/balance.py", "loaded/load_sharing.py"),
}
"""Where a function stands, the first that fits; those of libraries count where they are called from."""
REST, DEEPEST = "the rest", 4
Function = tuple[str, int, str]


def measure(name: str, setting: str, profiled: bool) -> dict[str, Any]:
    """Processor time of an analysis [s], peak memory of the process [MiB], shares of the profiled time."""
    from loaded_tca import analyse, read_scene

    changes = {f"analysis.{key}": value for key, value in SETTINGS[setting].items()}
    scene = read_scene(ROOT / "examples" / "scenes" / f"{name}.toml").with_changes(changes)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        analyse(scene)
        begin = time.process_time()
        analyse(scene)
        seconds = time.process_time() - begin
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
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


def _run(tree: Path, name: str, setting: str, profiled: bool = False) -> dict[str, Any]:
    command = [sys.executable, str(Path(__file__).resolve()), "--one", name, setting, *(["--profile"] * profiled)]
    surroundings = os.environ | {"PYTHONPATH": str(tree), "OMP_NUM_THREADS": "1"}
    done = subprocess.run(command, env=surroundings, capture_output=True, text=True, check=True)
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def page(trees: dict[str, Path]) -> str:
    """Markdown of all measurements."""
    from validation.page import machine

    rows = []
    for name in NAMES:
        for setting in SETTINGS:
            runs = [{word: _run(tree, name, setting) for word, tree in trees.items()} for _ in range(RUNS)]
            cells = [f"{statistics.median(run[word]['seconds'] for run in runs):.2f}" for word in trees]
            if len(trees) == 2:
                ratios = [run["now"]["seconds"] / run["before"]["seconds"] for run in runs]
                cells.append(f"{statistics.median(ratios):.2f}")
            last = _run(trees["now"], name, setting, profiled=True)
            peak = statistics.median(run["now"]["peak"] for run in runs)
            cells += [f"{peak:.0f}", *(f"{100.0 * share:.0f} %" for share in last["shares"].values())]
            rows.append(f"| {name} | {setting} | " + " | ".join(cells) + " |")
            print(rows[-1], flush=True)
    heads = [f"{word} [s]" for word in trees] + ["ratio"] * (len(trees) == 2)
    columns = ["scene", "setting", *heads, "peak memory [MiB]", *PARTS, REST]
    lines = [
        "# Time of a mesh cycle",
        "",
        "Written by `python -m validation.loaded.cycles`. 33 positions, three torques, accuracy 1e-2: processor",
        "time of an analysis in a process that has done it once, one thread, medians of",
        f"{RUNS} runs (of their ratios, too) that take turns; models of teeth are known. The peak memory is that of",
        "the process with all its libraries. Shares are those of a profile, which overrates Python's calls against",
        "array passes and transforms.",
        "",
        f"{machine()}.",
        "",
        "| " + " | ".join(columns) + " |",
        "|" + " --- |" * len(columns),
        *rows,
    ]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Measure and write the page."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--before", type=Path, help="root of another checkout")
    parser.add_argument("--one", nargs=2, help=argparse.SUPPRESS)
    parser.add_argument("--profile", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.one:
        print(json.dumps(measure(*arguments.one, arguments.profile)))
        return
    before = {} if arguments.before is None else {"before": arguments.before.resolve()}
    PAGE.write_text(page({**before, "now": ROOT}), encoding="utf-8")


if __name__ == "__main__":
    main()
