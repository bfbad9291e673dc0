"""Errors of grids on random scenes: each figure by default settings beside the same on much finer grids, by family.

Scenes of ``featured_scene`` at 5 positions, with whatever features the seed has: on grids of the
default accuracy of 1e-2, and all on twice as many cells along both axes as the finest of these has. ``python -m
validation.loaded.random_errors --log FILE`` writes a line of JSON for each scene into FILE, where seeds that stand
there are not run again, and then ``docs/studies/random_errors.md``.
"""

import json
import math
import time
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from loaded_tca import AccuracyWarning, analyse
from loaded_tca.arrays import Array
from loaded_tca.errors import LoadedTCAError
from loaded_tca.results import MeshCycle
from validation.invariances import LITTLE_LOAD, of_pairs
from validation.page import Page, machine, table, write_page
from validation.random_scenes import featured_scene

ACCURACY, POSITIONS, FINER = 1e-2, 5, 2
FIGURES = {
    "transmission error": "to the deflection under load",
    "its peak to peak": "to itself, or to a fifth of the deflection if this is larger",
    "mean mesh stiffness": "to itself",
    "load share": "to the whole load",
    "peak pressure": "to the largest peak pressure of the mesh",
    "K_Hbeta": "to itself",
    "K_Halpha": "to itself",
    "largest line load": "to itself",
}
"""Figure -> to what its error is relative."""


def errors_of(seed: int) -> dict[str, Any]:
    """Errors of one scene's figures, its family and features, and processor seconds; the error, if there is one."""
    begin, featured = time.process_time(), featured_scene(seed, positions=POSITIONS, accuracy=ACCURACY)
    about: dict[str, Any] = {"seed": seed, "family": featured.family, "features": featured.features}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        try:
            coarse = analyse(featured.scene)
            fine = analyse(featured.scene.with_changes({"analysis.cells": finer_cells(coarse)}))
        except LoadedTCAError as error:
            return about | {"failed": f"{type(error).__name__}: {error}"[:300]}
    return about | {"errors": compared(coarse, fine), "seconds": round(time.process_time() - begin, 2)}


def finer_cells(result: MeshCycle) -> list[int]:
    """Cells across and along: ``FINER`` times the most that a contact of the result has."""
    figures = result.key_figures()
    return [FINER * max(int(one[f"most_cells_{axis}"]) for one in figures) for axis in ("across", "along")]


def compared(coarse: MeshCycle, fine: MeshCycle) -> dict[str, float]:
    """Largest error of each figure over torques, positions and tooth pairs."""
    deflection = np.abs(fine.transmission_error - fine.unloaded_transmission_error).max(axis=1)
    spans = [np.ptp(result.transmission_error, axis=1) for result in (coarse, fine)]
    pairs = np.union1d(coarse.pair, fine.pair)
    shares, peaks = (
        [of_pairs(result, name, pairs) for result in (coarse, fine)] for name in ("load_share", "peak_pressure")
    )
    counted = np.minimum(*shares) > LITTLE_LOAD
    moved = np.where(counted, np.abs(peaks[0] - peaks[1]), 0.0).max(axis=(1, 2))
    line_loads = [
        np.array([figures["line_load_max_N_per_mm"] for figures in result.key_figures()]) for result in (coarse, fine)
    ]
    error = np.abs(coarse.transmission_error - fine.transmission_error).max(axis=1)
    return {
        "transmission error": float((error / deflection).max()),
        "its peak to peak": float((np.abs(spans[0] - spans[1]) / np.maximum(spans[1], 0.2 * deflection)).max()),
        "mean mesh stiffness": of_itself(*(np.nanmean(result.mesh_stiffness, axis=1) for result in (coarse, fine))),
        "load share": float(np.abs(shares[0] - shares[1]).max()),
        "peak pressure": float((moved / peaks[1].max(axis=(1, 2))).max()),
        "K_Hbeta": of_itself(coarse.face_load_factor, fine.face_load_factor),
        "K_Halpha": of_itself(coarse.transverse_load_factor, fine.transverse_load_factor),
        "largest line load": of_itself(*line_loads),
    }


def of_itself(coarse: Array, fine: Array) -> float:
    """Largest change of a figure over torques, relative; NaN where the pair has no such figure."""
    changes = np.abs(np.asarray(coarse) / np.asarray(fine) - 1.0)
    return float(np.nanmax(changes)) if np.isfinite(changes).any() else math.nan


TEXT = """# Errors of grids on random scenes

Written by `python -m validation.loaded.random_errors --log FILE`. The scenes are seeds 0 to {last} of
`validation.random_scenes.featured_scene`: pairs of {families} families, each with up to {features} features drawn at
random (reliefs, roundings, caps on the pressure, shafts, bores, measured flanks, several torques), at {positions}
positions. Each scene is analysed with the default `accuracy` of {accuracy:g}, and again with {finer} times as many
cells along both axes as its finest contact has. The difference is the error of the default grids. The error of the
model is in [another table](../how_it_works/errors.md#how-far-off-each-number-is). For each scene the largest error of
all positions, torques and tooth pairs counts.

{table}

In each cell, 95 % of the scenes have at most the first error, and all scenes have at most the second error. The number
in brackets is the seed of the scene with the second error: `validation.random_scenes.featured_scene(SEED)`. Large
errors of peak pressures and line loads occur where contacts reach tips and face ends; the analyses warn of these
contacts. If a contact reaches a rounded tip, it depends on the grid whether some cells at the tip count in
`peak_pressure` or in `edge_pressure`. Each error is relative:

{parts}

{seconds:.0f} s of processor time in all. {failures}

{machine}
"""


def page(found: list[dict[str, Any]]) -> str:
    """Text of the page."""
    families = sorted({one["family"] for one in found})
    known = [one for one in found if "errors" in one]
    rows = []
    for figure in FIGURES:
        groups = [known, *([one for one in known if one["family"] == family] for family in families)]
        rows.append((figure, *(_cell(group, figure) for group in groups)))
    counts = [len([one for one in known if one["family"] == family]) for family in families]
    heads = [f"{family.replace('_', ' ')} ({count})" for family, count in zip(families, counts, strict=True)]
    failed = [f"seed {one['seed']}: {one['failed']}" for one in found if "failed" in one]
    return TEXT.format(
        families=len(families),
        features=max(len(one["features"]) for one in found),
        last=max(one["seed"] for one in found),
        positions=POSITIONS,
        accuracy=ACCURACY,
        finer=FINER,
        table=table(("figure", f"all ({len(known)})", *heads), rows),
        parts="\n".join(f"- {figure}: {part}" for figure, part in FIGURES.items()),
        seconds=sum(one["seconds"] for one in known),
        failures="Refused: " + "; ".join(failed) + "." if failed else "No scene was refused.",
        machine=machine(),
    )


def _cell(group: list[dict[str, Any]], figure: str) -> str:
    """95 % and largest error [%], and the seed that has the largest."""
    errors = [(one["errors"][figure], one["seed"]) for one in group if math.isfinite(one["errors"][figure])]
    if not errors:
        return "-"
    most = float(np.quantile([error for error, _ in errors], 0.95))
    largest, seed = max(errors)
    return f"{100.0 * most:.2g} / {100.0 * largest:.2g} % ({seed})"


def measured(seeds: int, log: str) -> Page:
    """The page of as many seeds."""
    path = Path(log)
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    found = {one["seed"]: one for one in map(json.loads, lines)}
    for seed in range(seeds):
        if seed not in found:
            found[seed] = errors_of(seed)
            with path.open("a", encoding="utf-8") as file:
                file.write(json.dumps(found[seed]) + "\n")
    return Page("random_errors", page([found[seed] for seed in sorted(found)]))


if __name__ == "__main__":
    write_page(__doc__, measured, seeds=120, log="random_errors.log")
