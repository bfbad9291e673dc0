"""What a study of a million variants takes beside its analyses: time, memory and disk, from a thousand variants on.

Rows of 60 key figures that nobody analysed go through what a study does with them: digests of the variants, rows on
disk, rows read again as when a study goes on, the dataset, its file, and a fresh process that reads the file. What
grows in proportion to the variants has the same microseconds a variant in every column. ``--dask N`` runs N variants
of a trivial analysis on Dask with 8 local workers: 2000 in one to two minutes on two busy cores, of which the start of
the workers takes a third.

Run from the root of the repository: ``python -m validation.studies.large_studies 1000 10000 100000``; 100 000 variants
take half a minute, 0.3 GB of disk and 0.3 GiB, a million seven minutes, 3 GB and 1.6 GiB. Times and sizes of
docs/guide/clusters.md come from here.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from loaded_tca import read_scene
from loaded_tca.results.files import write_dataset
from loaded_tca.scene import Scene
from loaded_tca.studies import Study, load_study, run_study
from loaded_tca.studies.rows import Row, Rows, dataset_of
from validation.page import SCENES, forget_peak_memory, in_a_process, peak_memory, table

CROWNING = "pinion.modifications.lead_crowning_um"
FIGURES = {f"figure_{number}_um": [float(np.sqrt(number + 2.0))] for number in range(60)}
AT_ONCE = 10
"""Rows that come from workers together."""
WORKERS = 8


def study(variants: int) -> Study:
    """Variants of the crowning of a helical pair."""
    return Study(read_scene(SCENES / "helical.toml"), {CROWNING: np.linspace(2.0, 10.0, variants)})


def trivial(_: Scene) -> dict[str, Any]:
    """Return figures without an analysis."""
    return {name: values[0] for name, values in FIGURES.items()}


def row(digest: str) -> Row:
    """The row of a variant with a warning."""
    warned = ["the contact reaches an edge of a flank"]
    return {"digest": digest, "status": "ok", "reason": "", "warnings": warned, "seconds": 0.5, "figures": FIGURES}


def stages(variants: int) -> dict[str, float]:
    """Processor time [us a variant] and largest memory [MiB] of each stage of a study, bytes a variant on disk."""
    costs: dict[str, float] = {}

    def timed(name: str, stage: Callable[[], Any]) -> Any:
        forget_peak_memory()
        begin = time.process_time()
        value = stage()
        costs[f"{name} [us]"] = 1e6 * (time.process_time() - begin) / variants
        costs[f"{name} [MiB]"] = 1024.0 * peak_memory()
        return value

    with TemporaryDirectory() as folder:
        all_variants, lines, out = study(variants), Path(folder, "study.rows.jsonl"), Path(folder, "study.nc")
        digests = timed("digests", lambda: [*map(all_variants.digests(trivial), range(variants))])
        with Rows(lines) as rows:
            starts = range(0, variants, AT_ONCE)
            timed("rows written", lambda: [rows.append([*map(row, digests[at : at + AT_ONCE])]) for at in starts])
        with timed("rows read again", lambda: Rows(lines)) as rows:
            dataset = timed("dataset", lambda: dataset_of(all_variants, rows.of(digests), {}))
        timed("study.nc written", lambda: write_dataset(out, dataset))
        costs["rows [B]"], costs["study.nc [B]"] = (path.stat().st_size / variants for path in (lines, out))
        costs |= in_a_process(reader, str(out))
    return costs


def reader(path: str) -> dict[str, float]:
    """Seconds and memory [MiB] of a process that reads the result of a study, and what of it stays."""
    begin = time.process_time()
    dataset = load_study(path)
    costs = {"study.nc read [s]": time.process_time() - begin, "study.nc read [MiB]": 1024.0 * peak_memory()}
    forget_peak_memory()
    costs["read afterwards [MiB]"] = 1024.0 * peak_memory()
    costs["result [MiB]"] = dataset.nbytes / 2**20
    return costs


def on_dask(variants: int) -> dict[str, float]:
    """Variants a second on Dask with 8 local workers, and of a second run that has all rows."""
    from distributed import Client, LocalCluster

    with (
        TemporaryDirectory() as folder,
        LocalCluster(n_workers=WORKERS, threads_per_worker=1, dashboard_address=":0") as local,
        Client(local) as client,
    ):
        speeds = {}
        for name in ("first run [1/s]", "all rows there [1/s]"):
            begin = time.perf_counter()
            run_study(study(variants), client.get_executor(pure=False), Path(folder, "study.nc"), figures=trivial)
            speeds[name] = variants / (time.perf_counter() - begin)
        return speeds


def main() -> None:
    """Print what studies of the sizes asked for cost."""
    parser = argparse.ArgumentParser(description="Costs of large studies beside their analyses.")
    parser.add_argument("variants", nargs="*", type=int)
    parser.add_argument("--dask", type=int, metavar="N")
    options = parser.parse_args()
    costs = {variants: in_a_process(stages, variants) for variants in options.variants}
    if costs:
        names = next(iter(costs.values()))
        head = ("variants", *(f"{variants}" for variants in costs))
        print(table(head, [(name, *(f"{column[name]:.4g}" for column in costs.values())) for name in names]))
    if options.dask:
        print(in_a_process(on_dask, options.dask))


if __name__ == "__main__":
    main()
