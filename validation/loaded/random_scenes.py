"""Random scenes with every feature against the invariances that hold of them all: a line for each that does not.

``python -m validation.loaded.random_scenes 0 300 --log FILE`` runs seeds 0 to 299 and writes a line of JSON for each,
with processor seconds and what is off by more than is allowed; seeds that stand in the file are not run again.
``data/random_scenes.csv`` has the last run of each seed, from 70 and from 10200 on: family, number of features, laws (a
for the first of ``LAWS``, b for the second), and what is off by how many times what is allowed.
"""

import argparse
import json
import math
import time
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from loaded_tca import AccuracyWarning
from validation.invariances import CHEAP, COARSE, Subject
from validation.laws import LAWS
from validation.random_scenes import ALL_FAMILIES
from validation.table import Row

CASE, SOURCE = "random scenes", "invariances of every scene"
SEEDS = range(len(ALL_FAMILIES))
"""Of the table: each family in turn; logs have more, and the tests quick ones with every feature and law."""


def rows() -> list[Row]:
    """Rows of all scenes: the largest of what is off, over what is allowed, and each check that raises an error."""
    return [row for seed in SEEDS for row in _rows(examined(seed))]


def _rows(found: dict[str, Any]) -> list[Row]:
    who, features = f"seed {found['seed']}, {found['family']}", ", ".join(found["features"])
    sizes = {f"{check}: {name}": size for check, off in found["off"].items() for name, size in off.items()}
    sizes |= {f"{check}: {error}": math.nan for check, error in found["failed"].items()}
    worst = sorted(sizes, key=lambda name: -sizes[name])[:1]
    shown = dict.fromkeys([*worst, *(name for name, size in sizes.items() if not size <= 1.0)])
    return [Row(CASE, SOURCE, f"{who}: {name}", 0.0, sizes[name], 1.0, note=features) for name in shown]


def examined(seed: int, checks: tuple[str, ...] = (), settings: Mapping[str, Any] = CHEAP) -> dict[str, Any]:
    """What is off of a scene, over what is allowed, by invariance and quantity; what failed with an error; seconds.

    Parameters
    ----------
    seed : int
    checks : tuple of str
        Names of invariances; none: those that a long run has for the scene.
    settings : mapping
        Of the section [analysis].
    """
    start, off, failed, seconds = time.process_time(), {}, {}, {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        subject = Subject.of(seed, settings)
        for invariance in LAWS:
            wanted = invariance.name in checks if checks else invariance.is_tried_on(subject)
            since = time.process_time()
            try:
                if not wanted or not invariance.holds_for(subject):
                    continue
                off[invariance.name] = invariance.check(subject)
            except Exception as error:  # whatever a check raises is a result of it
                failed[invariance.name] = f"{type(error).__name__}: {error}"[:300]
            seconds[invariance.name] = round(time.process_time() - since, 2)
    featured = subject.featured
    about = {"seed": seed, "family": featured.family, "features": featured.features, "off": off, "failed": failed}
    return about | {"seconds": round(time.process_time() - start, 2), "by_check": seconds}


def beyond(found: dict[str, Any]) -> list[str]:
    """Lines on what is off by more than is allowed, or failed."""
    who = f"seed {found['seed']} {found['family']}"
    lines = [
        f"{who}: {check}: {name}: {size:.3g} times what is allowed"
        for check, off in found["off"].items()
        for name, size in off.items()
        if not size <= 1.0
    ]
    lines += [f"{who}: {check}: {error}" for check, error in found["failed"].items()]
    return [f"{line} [{', '.join(found['features'])}]" for line in lines]


def main() -> None:
    """Run seeds and write the log."""
    parser = argparse.ArgumentParser(prog="python -m validation.loaded.random_scenes", description=__doc__)
    parser.add_argument("first", type=int)
    parser.add_argument("end", type=int)
    parser.add_argument("--log", type=Path, required=True, help="lines of JSON, one for each scene")
    parser.add_argument("--only", nargs="*", default=(), help="names of invariances, tried on every scene")
    parser.add_argument("--coarse", action="store_true", help="on few cells")
    options = parser.parse_args()
    lines = options.log.read_text().splitlines() if options.log.exists() else []
    known = {json.loads(line)["seed"] for line in lines}
    for seed in range(options.first, options.end):
        if seed in known:
            continue
        found = examined(seed, tuple(options.only), COARSE if options.coarse else CHEAP)
        with options.log.open("a") as log:
            log.write(json.dumps(found) + "\n")
        print(*beyond(found), sep="\n", end="\n" if beyond(found) else "", flush=True)


if __name__ == "__main__":
    main()
