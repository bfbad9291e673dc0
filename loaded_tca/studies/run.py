"""Run a study on any executor: every variant that is done is written down at once, and is not computed again.

Processes on this machine, for studies: none of them outlives the block that asked for them, or this process.
"""

from __future__ import annotations

import os
import signal
import sys
import time
import warnings
from collections.abc import Callable, Collection, Generator, Iterable, Iterator, Mapping
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future, ProcessPoolExecutor
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass
from importlib.metadata import version
from itertools import islice
from multiprocessing import active_children, get_context, parent_process
from pathlib import Path
from queue import SimpleQueue
from tempfile import TemporaryDirectory
from threading import Thread
from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.analysis import analyse
from loaded_tca.arguments import checked
from loaded_tca.errors import (
    ConvergenceError,
    DamageWarning,
    ExecutorError,
    LoadedTCAError,
    noted_accuracy_warnings,
    require,
)
from loaded_tca.results.files import FilePath, write_dataset
from loaded_tca.scene import Scene
from loaded_tca.scene.double_helical import DoubleHelicalScene
from loaded_tca.stages import Stage
from loaded_tca.studies.double_helical import halves_figures
from loaded_tca.studies.kept import keep, kept_file, renumber
from loaded_tca.studies.ranking import failure_of_all, figures_of
from loaded_tca.studies.ranking import figures as key_figures
from loaded_tca.studies.rows import Row, Rows, dataset_of, problem_of_figures
from loaded_tca.studies.stage import stage_figures
from loaded_tca.studies.study import Study
from loaded_tca.threads import one_thread

if TYPE_CHECKING:
    import xarray

AHEAD = 1000
"""Tasks under way: enough for hundreds of workers, and little memory."""
TASK_SECONDS, MOST_TOGETHER = 0.1, 50
"""Quick variants share a task until it takes so long, or has so many: a task takes a scheduler some milliseconds."""

GONE = "as when a scheduler goes away"

Figures = Callable[[Any], Mapping[str, Any]]
Progress = Callable[[int, int, int], None]
"""Called with how many variants are done, of how many, and how many of these are not ok."""


@checked
def run_study(
    study: Study,
    executor: Executor | None = None,
    out: FilePath | None = None,
    progress: Progress | None = None,
    figures: Figures | None = None,
    keep_maps: Collection[int] = (),
) -> xarray.Dataset:
    """Analyse all variants of a study.

    Parameters
    ----------
    study : Study
    executor : concurrent.futures.Executor, optional
        Whose workers analyse; it stays the caller's. Default: this process.
    out : path, optional
        File for the result. Beside it, in ``<name>.rows.jsonl``, stand the variants that are done, while the study runs
        and afterwards: the same study with the same ``out`` computes only what is missing there.
    progress : callable, optional
        Called as ``progress(done, total, failed)`` with those known before, if any, and whenever variants are done.
    figures : callable, optional
        What is kept of a variant: a function of its scene that returns numbers, or numbers over the torques, by their
        names, and that workers can import. Default: :func:`loaded_tca.studies.figures`, of stages
        :func:`loaded_tca.studies.stage_figures`, of double helical pairs :func:`loaded_tca.studies.halves_figures`.
    keep_maps : collection of int
        Variants of which the whole result is kept, pressure maps included, if they are ok:
        ``<name>_maps/<variant>.nc`` beside ``out``, to be read by :func:`loaded_tca.load_result`. When a study with
        more samples or other values has the same ``out``, kept results move to the numbers that their variants have
        there; those of no variant of it to ``<name>_maps/others/``.

    Returns
    -------
    xarray.Dataset
        See :func:`loaded_tca.studies.rows.dataset_of`. What does not fit or does not converge is a row with its
        ``status`` and ``reason``. The numbers depend neither on the executor nor on the order; ``seconds`` do.

    Raises
    ------
    InputError
        If the file cannot be written, or maps are to be kept of no variant of the study.
    ExecutorError
        If the executor gives up, as when a worker is killed.

    Warns
    -----
    DamageWarning
        Which rows beside ``out`` cannot be used, and why, if anything is missing: their variants are analysed again.
    UserWarning
        If kept results are of no variant of the study: how many, and where they are.
        If no variant is ok: how many have which status, and the reason of the first.

    Examples
    --------
    >>> from loaded_tca import parse_scene
    >>> from loaded_tca.cli import DEMO_SCENE
    >>> few = {"analysis.positions": 3, "analysis.compliance": "contact", "analysis.free_edges": False}
    >>> scene = parse_scene(DEMO_SCENE.read_text()).with_changes(few)
    >>> study = run_study(Study(scene, {"pinion.modifications.lead_crowning_um": [2.0, 6.0]}))
    >>> study["face_load_factor"].squeeze().diff("sample").item() > 0.0  # more crowning, less of the face carries
    True
    """
    figures = figures or _figures_by(study.scene)
    with_maps = set(keep_maps)
    _require_storable(study, figures, with_maps, out)
    digests = [*map(study.digests(figures), range(len(study)))]
    with ExitStack() as stack:
        place = Path(stack.enter_context(TemporaryDirectory()), "study.nc") if out is None else Path(out)
        rows = stack.enter_context(Rows(place.with_suffix(".rows.jsonl")))
        stack.enter_context(_told_how_to_go_on(rows, out))
        maps = place.with_name(f"{place.stem}_maps")
        if left := renumber(maps, study):
            warnings.warn(f"study: {left}", UserWarning, stacklevel=2)
        kept = {
            variant
            for variant, digest in enumerate(digests)
            if digest in rows and (variant not in with_maps or kept_file(maps, variant).exists())
        }
        missing: dict[str, list[int]] = {}  # variants that change the same are analysed once
        for variant in sorted(set(range(len(study))) - kept):
            missing.setdefault(digests[variant], []).append(variant)
        if missing and rows.damaged:
            warnings.warn(rows.damage, DamageWarning, stacklevel=2)
        tally = _Tally(len(study), progress)
        if kept:
            tally.add(rows.of(digests[variant] for variant in sorted(kept)))
        tasks = (
            (study.scene, study.changes(variants[0]), digest, figures, not with_maps.isdisjoint(variants))
            for digest, variants in missing.items()
        )
        with closing(_in_this_process(tasks) if executor is None else _by(executor, tasks)) as batches:
            for batch in batches:
                rows.append([row for row, _ in batch])
                for row, whole in batch:
                    keep(maps, with_maps.intersection(missing[row["digest"]]), whole)
                tally.add(row for row, _ in batch for _ in missing[row["digest"]])
        text = "stage_toml" if isinstance(study.scene, Stage) else "scene_toml"
        attributes = {text: study.scene.to_toml(), "version": version("loaded_tca"), "seed": study.seed}
        dataset = dataset_of(study, rows.of(digests), attributes)
        if out is not None:
            write_dataset(place, dataset)
    if failure := failure_of_all(dataset):
        warnings.warn(f"study: {failure}", UserWarning, stacklevel=2)
    return dataset


def _figures_by(scene: Scene | Stage) -> Figures:
    """Figures of a variant where no others are asked for."""
    if isinstance(scene, Stage):
        return stage_figures
    return halves_figures if isinstance(scene, DoubleHelicalScene) else key_figures


def _require_storable(study: Study, figures: Figures, with_maps: set[int], out: FilePath | None) -> None:
    """Refuse figures whose rows nothing identifies, and maps that there will not be."""
    unknown = sorted(with_maps.difference(range(len(study))))
    named = "<lambda>" not in getattr(figures, "__qualname__", "<lambda>")
    of_stage, of_halves = isinstance(study.scene, Stage), isinstance(study.scene, DoubleHelicalScene)
    require(
        (not with_maps or out is not None, "keep_maps: needs out"),
        (not (with_maps and of_stage), "keep_maps: not of a study of stages; analyse_stage has their mesh cycles"),
        (
            not (with_maps and of_halves),
            "keep_maps: not of a study of double helical pairs; analyse_double_helical has both mesh cycles",
        ),
        (not unknown, f"keep_maps: {unknown[:3]} are not variants 0 to {len(study) - 1}"),
        (named, f"figures: found {figures!r}; allowed a function with a name, which identifies its rows"),
    )


@dataclass
class _Tally:
    """How many variants of how many are done, and how many of these are not ok; it tells the ``progress``."""

    total: int
    progress: Progress | None
    done: int = 0
    failed: int = 0

    def add(self, rows: Iterable[Row]) -> None:
        """Count variants that are done, by their rows."""
        status = [row["status"] for row in rows]
        self.done += len(status)
        self.failed += len(status) - status.count("ok")
        if self.progress is not None:
            self.progress(self.done, self.total, self.failed)


Task = tuple[Scene | Stage, dict[str, Any], str, Figures, bool]
"""Scene or stage of the study, changes, digest, figures, and whether maps are to be kept."""
Done = tuple[Row, bytes | None]
"""A row, and the whole result if maps are kept."""


def _in_this_process(tasks: Iterator[Task]) -> Generator[list[Done]]:
    for task in tasks:
        yield [_analysed(*task)]


def _by(executor: Executor, tasks: Iterator[Task]) -> Generator[list[Done]]:
    """What is done, as it comes; at the end, and if anything goes wrong, nothing is left for the executor to begin."""
    finished: SimpleQueue[Future[list[Done]]] = SimpleQueue()
    under_way: set[Future[list[Done]]] = set()
    together = 1
    try:
        while True:
            while len(under_way) < AHEAD and (next_tasks := [*islice(tasks, together)]):
                future = _submitted(executor, next_tasks)
                under_way.add(future)
                future.add_done_callback(finished.put)
            if not under_way:
                return
            batch = [finished.get()]
            while not finished.empty():
                batch.append(finished.get())
            under_way.difference_update(batch)
            lost = {future for future in batch if future.cancelled() or future.exception() is not None}
            done = [row_and_map for future in batch if future not in lost for row_and_map in future.result()]
            yield done
            if lost:
                first = next(future for future in batch if future in lost)
                error = CancelledError(GONE) if first.cancelled() else first.exception()
                if isinstance(error, BrokenExecutor):  # it fails all of them, and stumbles over cancelled ones
                    under_way.clear()
                reason = f"{type(error).__name__}: {error}".splitlines()[0]
                raise ExecutorError(f"the executor gave up: {reason}") from error
            together = _together([row["seconds"] for row, _ in done])
    finally:
        for future in under_way:
            future.cancel()


def _together(seconds: list[float]) -> int:
    """How many variants share a task, of the seconds that some took.

    Examples
    --------
    >>> _together([0.5]), _together([0.01, 0.03]), _together([0.0])
    (1, 5, 50)
    """
    return max(1, int(min(TASK_SECONDS * len(seconds) / max(sum(seconds), 1e-9), MOST_TOGETHER)))


def _submitted(executor: Executor, tasks: list[Task]) -> Future[list[Done]]:
    """Tasks that an executor was given as one; one that has failed if the executor takes none any more."""
    try:
        return executor.submit(_all_analysed, tasks)
    except Exception as error:  # as many kinds as there are executors
        future: Future[list[Done]] = Future()
        future.set_exception(error)
        return future


def _all_analysed(tasks: list[Task]) -> list[Done]:
    """Analyse variants one after the other, in whatever process and thread this is called."""
    return [_analysed(*task) for task in tasks]


def _analysed(scene: Scene | Stage, changes: dict[str, Any], digest: str, figures: Figures, keep: bool) -> Done:
    """Analyse one variant."""
    begin = time.perf_counter()
    status, reason, values_of, whole = "ok", "", {}, None
    with one_thread(), noted_accuracy_warnings(given=False) as warned:
        try:
            variant = scene.with_changes(changes)
            if keep and isinstance(variant, Scene):
                result = analyse(variant)
                whole = bytes(result.to_netcdf())
            values = figures_of(result) if keep and figures is key_figures else figures(variant)
            values_of = _checked({name: _over_torques(name, value) for name, value in values.items()})
        except Exception as error:  # a variant that fails is a row; what it is of the program's fault, too
            status, reason = _status_of(error), _storable(str(error)) or type(error).__name__
    row = {
        "digest": digest,
        "status": status,
        "reason": reason,
        "warnings": [*dict.fromkeys(map(_storable, warned))],
        "seconds": time.perf_counter() - begin,
        "figures": values_of,
    }
    return row, whole


def _storable(text: str) -> str:
    """A text without halves of surrogate pairs, which no file can hold."""
    return text.encode(errors="replace").decode()


def _checked(figures: dict[str, list[float]]) -> dict[str, list[float]]:
    """The figures, if they fit into a row."""
    if problem := problem_of_figures(figures):
        raise ValueError(f"figures: {problem}")
    return figures


def _over_torques(name: str, value: Any) -> list[float]:
    array = np.atleast_1d(np.asarray(value, dtype=float))
    if array.ndim > 1:
        raise ValueError(f"figures: {name} has {array.ndim} dimensions; allowed a number, or one for each torque")
    return array.tolist()


def _status_of(error: Exception) -> str:
    if isinstance(error, ConvergenceError):
        return "not converged"
    return "refused" if isinstance(error, LoadedTCAError) else "fault"


@contextmanager
def _told_how_to_go_on(rows: Rows, out: FilePath | None) -> Iterator[None]:
    try:
        yield
    except BaseException as error:  # an interrupt, too
        if out is not None:
            error.add_note(f"{len(rows)} variants are kept in {rows.path}: the same study goes on from there")
        raise


@contextmanager
def process_pool(workers: int) -> Iterator[ProcessPoolExecutor]:
    """Keep processes ready for the time of a block; an exception in the block, an interrupt too, ends them at once.

    A ``ProcessPoolExecutor`` by itself first waits for the analyses that are running, and leaves its processes behind
    when this one is killed.

    Parameters
    ----------
    workers : int
        How many, from 1 on. They are started anew (*spawn*), so that a script needs the line
        ``if __name__ == "__main__":``; Ctrl-C does not reach them.

    Raises
    ------
    InputError
        If ``workers`` is no whole number from 1 on.

    Examples
    --------
    >>> with process_pool(1) as executor:
    ...     executor.submit(abs, -2.0).result()
    2.0
    """
    whole = isinstance(workers, int) and not isinstance(workers, bool) and workers >= 1
    require((whole, f"workers: found {workers!r}; allowed a whole number from 1 on"))
    others, own = set(active_children()), set()
    with ProcessPoolExecutor(workers, get_context("spawn"), _end_with_parent) as pool:
        try:
            with _interrupts_held_back():
                for _ in range(workers):  # each starts one
                    pool.submit(os.getpid)
                own = set(active_children()) - others
            yield pool
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)  # first: it stumbles over cancelled tasks of ended processes
            for process in own:
                process.terminate()
            for process in own:
                process.join()
            raise


def _end_with_parent() -> None:
    """Make a worker ignore interrupts, which are its parent's to deal with, and end once its parent is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = parent_process()

    def watch() -> None:
        if parent is not None:
            parent.join()
            os._exit(1)

    Thread(target=watch, daemon=True).start()


@contextmanager
def _interrupts_held_back() -> Iterator[None]:
    """Processes that are started inside inherit it, from their first instruction on; this one is interrupted after."""
    if sys.platform == "win32":  # no masks: interrupts while workers start show their tracebacks
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
