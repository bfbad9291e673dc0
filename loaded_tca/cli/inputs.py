"""What the command line names: scenes with their changes, results, tolerances, places for files, engines of studies."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from loaded_tca.cli.directories import JOINED
from loaded_tca.errors import GeometryError, InputError, named, reason_of, require
from loaded_tca.input_files import read_text
from loaded_tca.plain import plain

if TYPE_CHECKING:
    from concurrent.futures import Executor

    import xarray

    from loaded_tca.double_helical import DoubleHelicalResult
    from loaded_tca.results import Revolution
    from loaded_tca.results.comparison import Comparison
    from loaded_tca.results.mesh_cycle import MeshCycle
    from loaded_tca.results.result import Result
    from loaded_tca.scene import Scene
    from loaded_tca.scene.load import AnyLoad
    from loaded_tca.scene.written import Writing
    from loaded_tca.stages import Stage
    from loaded_tca.studies import DesignResult

STUDY_FILE, DESIGN_FILE = "study.nc", "design.nc"
"""Files of a study and of a design in their directories."""
REACHED_WITHIN = 10.0
"""Seconds for a scheduler to answer."""


def scene_of(options: argparse.Namespace) -> Scene:
    """The scene that the command line names, with its changes."""
    from loaded_tca.scene import read_scene

    scene, changes = read_scene(options.scene), changes_of(options)
    return scene.with_changes(changes) if changes else scene


def stage_of(options: argparse.Namespace) -> Stage:
    """The stage that the command line names, with its changes."""
    from loaded_tca.stages import read_stage

    stage, changes = read_stage(options.scene), changes_of(options)
    return stage.with_changes(changes) if changes else stage


def written_otherwise(path: str | os.PathLike[str]) -> tuple[dict[str, Writing], dict[str, Any], dict[str, Any]]:
    """How a scene or stage file writes keys that it does not have by their names, values by paths of keys, its tables.

    Raises
    ------
    InputError
        If the file cannot be read, or describes neither.
    """
    from loaded_tca.scene.parse import LARGEST_FILE, is_table_of_stage, scenes_of, toml_table, with_files_from
    from loaded_tca.scene.section import check

    table = with_files_from(Path(path).parent, toml_table(read_text(path, LARGEST_FILE), os.fspath(path)))
    if is_table_of_stage(table):
        from loaded_tca.stages import Stage

        values, _, writings = check(Stage, table)
    else:
        values, _, writings = check(scenes_of(table), table)
    return {key: writing for key, writing in writings.items() if writing.given}, values, table


def _bins_otherwise(load: AnyLoad, table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Keys that the bins of a load spectrum, or columns of its file, write otherwise, and the values of all bins."""
    from loaded_tca.scene.keys import shown
    from loaded_tca.scene.load import spectrum_columns
    from loaded_tca.scene.section import keys_of
    from loaded_tca.scene.written import writing_of

    keys, file = keys_of(load.CASE), table.get("spectrum")
    names = spectrum_columns(file) if file else [name for each in table.get("case", ()) for name in each]
    for name in dict.fromkeys(names):
        if name not in keys and (writing := writing_of(name, keys, {})):
            numbers = tuple(float(plain(getattr(each, writing.key), 9)) for each in load.case or ())
            yield f"load.case.{name}", f"load.case.{writing.key} = {shown(numbers)}"


def read_otherwise(path: str | os.PathLike[str]) -> Iterator[str]:
    """Lines on the keys that a file writes otherwise, with the values that were read; none where there are none."""
    from loaded_tca.scene.keys import shown

    writings, values, table = written_otherwise(path)
    lines = []
    for key, writing in writings.items():
        value = values[key]
        lines.append((writing.path(key), f"{key} = {shown(value) if isinstance(value, tuple) else plain(value, 9)}"))
    lines += _bins_otherwise(values["load"], table["load"]) if "case" in values["load"].alternatives else ()
    if lines:
        yield "written otherwise in the file, and read as"
        width = max(len(name) for name, _ in lines)
        yield from (f"  {name:<{width}}  {read}" for name, read in lines)


@contextmanager
def as_files_write(options: argparse.Namespace) -> Iterator[None]:
    """Tell problems of a scene by the names and in the units of its file, but those of keys that ``--set`` changes."""
    try:
        yield
    except (InputError, GeometryError) as error:
        try:
            writings, *_ = written_otherwise(options.scene)
        except (AttributeError, InputError):
            raise error from None
        from loaded_tca.scene.written import answered, as_written

        changed = dict(getattr(options, "set", ()))
        writings = {key: writing for key, writing in writings.items() if key not in changed}
        told = answered(error.problems if isinstance(error, InputError) else (str(error),), writings)
        again = InputError(told) if isinstance(error, InputError) else GeometryError(told[0])
        for note in getattr(error, "__notes__", ()):
            again.add_note(as_written(note, "", writings))
        raise again.with_traceback(error.__traceback__) from error.__cause__


def changes_of(options: argparse.Namespace) -> dict[str, Any]:
    """Keys that the command line changes, with their values."""
    from loaded_tca.scene.parse import literal_value

    return {key: literal_value(value) for key, value in options.set}


def result_of(options: argparse.Namespace) -> tuple[MeshCycle, Path, int | None, int | None]:
    """What the command line names: the result, the directory to write to, and indices of the torque and position."""
    from loaded_tca.results.mesh_cycle import MeshCycle

    path = result_file(options.result)
    result = MeshCycle.load(path)
    torque = index_of_torque(options.torque, result)
    position = index_of_position(getattr(options, "position", None), result)
    return result, directory_of_part(options, path), torque, position


def directory_of_part(options: argparse.Namespace, file: Path) -> Path:
    """Where the files go that a command makes of a part of a result: they do not replace those of the whole."""
    keys = {"torque_{:g}_Nm": "torque", "position_{}": "position", "pair_{}": "pair", "below_{}": "gear"}
    chosen = {name: getattr(options, key, None) for name, key in keys.items()}
    names = [name.format(value) for name, value in chosen.items() if value not in (None, "pinion")]
    directory: Path = options.out or directory_of(file) / "_".join(names)
    check_place(directory)
    return directory


def tolerances_of(options: argparse.Namespace, scene: Scene) -> dict[str, float]:
    """Keys of a scene that the command line names, or the usual ones, with their standard deviations."""
    from loaded_tca.results.tolerances import default_tolerances
    from loaded_tca.scene.section import key_at

    given: list[tuple[str, float | None]] = options.keys or []
    problems: list[str] = []
    for key in dict.fromkeys(key for key, _ in given):
        try:
            key_at(type(scene), key)
        except InputError as error:
            problems += error.problems
        if [one for one, _ in given].count(key) > 1:
            problems.append(f"{key}: given twice")
    if problems:
        raise InputError(f"--keys {problem}" for problem in problems)
    usual = default_tolerances(scene, [key for key, _ in given] or None)
    return usual | {key: tolerance for key, tolerance in given if tolerance is not None}


def _refuse_what_else_it_holds(directory: Path) -> None:
    """Refuse a directory without a result that holds something else, in words that say what to give instead."""
    from loaded_tca.double_helical import DoubleHelicalRevolution
    from loaded_tca.output.result_files import RESULT
    from loaded_tca.output.tables import COMPARISON, COMPARISON_DATA
    from loaded_tca.results import Revolution
    from loaded_tca.tribology import Tribology

    parts = [one.name for one in sorted(directory.iterdir()) if (one / RESULT).is_file()]
    takers: dict[type[Revolution | DoubleHelicalRevolution], str] = {
        Revolution: "'loaded-tca report DIR' and 'loaded-tca dynamics DIR'",
        DoubleHelicalRevolution: "'loaded-tca report DIR'",
    }
    for kind, commands in takers.items():
        if (directory / kind.FILE).is_file():
            raise InputError(
                f"{directory}: holds a whole revolution, which this command does not take; allowed in {commands}; the "
                f"numbers are in {kind.JSON} and the tables; give the directory of 'loaded-tca run'"
            )
    if parts:
        these = " or ".join(f"{directory / name}" for name in parts)
        raise InputError(f"{directory}: holds results in {', '.join(parts)}; give one of them: {these}")
    if (directory / COMPARISON_DATA).is_file():
        raise InputError(
            f"{directory}: holds a comparison of results, which this command does not take: the numbers are in "
            f"{COMPARISON} and {COMPARISON_DATA}; give the directory of one of the results, or of several to "
            "'loaded-tca report'"
        )
    if any((directory / name).is_file() for name in Tribology.file_names()):
        raise InputError(
            f"{directory}: holds only tribology, without the result that it belongs to; give the directory of "
            "'loaded-tca run', whose report has tribology if the scene has [operation] or [lubricant]"
        )


def result_file(path: Path) -> Path:
    """The file of a result that is named by itself or by its directory; that of another kind its reader refuses."""
    return _file_in(path)


def _file_in(path: Path, *others: str) -> Path:
    """A file itself, or in a directory that of a result of any kind, or one of these names.

    Raises
    ------
    InputError
        If the directory holds something else; of one with nothing at all the reader says so.
    """
    from loaded_tca.double_helical.result import PAIR_FILE
    from loaded_tca.output.result_files import RESULT
    from loaded_tca.stages.result import STAGE_FILE

    if not os.path.isdir(path):
        return path
    for name in (RESULT, STAGE_FILE, PAIR_FILE, *others):
        if (path / name).is_file():
            return path / name
    _refuse_what_else_it_holds(path)
    return path / RESULT


def directory_of(file: Path) -> Path:
    """Where the files of a result go: its folder, or in it one of its own where it is a mesh of a stage or a half."""
    is_part = file.suffix == ".nc" and JOINED.fullmatch(file.stem)
    return file.parent / file.stem if is_part else file.parent


def file_of_revolution(path: Path, *others: str) -> Path:
    """The file of a result or a whole revolution, or one of other names, named by itself or by its directory."""
    from loaded_tca.double_helical.result import PAIR_REVOLUTION_FILE
    from loaded_tca.results.revolution import REVOLUTION_FILE

    return _file_in(path, REVOLUTION_FILE, PAIR_REVOLUTION_FILE, *others)


def result_for_dynamics(path: Path) -> MeshCycle | Revolution:
    """The mesh cycle or the whole revolution in a file; what has no tables for dynamics is refused."""
    from loaded_tca.results import Revolution, load_result
    from loaded_tca.results.files import REVOLUTION, read_dataset

    return Revolution.load(path) if read_dataset(path).attrs.get("kind") == REVOLUTION else load_result(path)


def file_of_report(path: Path) -> Path:
    """The file of what has a report, a result, revolution, stage, study or design, itself or in its directory."""
    return file_of_revolution(path, STUDY_FILE, DESIGN_FILE)


def subject_of_report(path: Path) -> Result | xarray.Dataset | DesignResult:
    """The result, revolution, stage, double helical pair, study or design in a file."""
    from loaded_tca.double_helical import DoubleHelicalResult, DoubleHelicalRevolution
    from loaded_tca.results import MeshCycle, Revolution
    from loaded_tca.results.files import DESIGN, STUDY, read_dataset
    from loaded_tca.results.result import JoinedResult
    from loaded_tca.stages import StageResult
    from loaded_tca.studies import load_design, load_study

    kind = read_dataset(path).attrs.get("kind", "")
    if kind in (STUDY, DESIGN):
        return load_study(path) if kind == STUDY else load_design(path)
    kinds = Revolution, StageResult, DoubleHelicalResult, DoubleHelicalRevolution
    result = next((one for one in kinds if kind == one.KIND), MeshCycle)
    return result.load(path.parent if issubclass(result, JoinedResult) else path)


def index_of_torque(given: float | None, result: MeshCycle | DoubleHelicalResult) -> int | None:
    """Index of a torque [N m] of a result, as the command line gives it; None: not given."""
    if given is None:
        return None
    known = [f"{plain(1e-3 * float(one), 6)}" for one in result.torque]
    require((f"{plain(given, 6)}" in known, f"--torque {plain(given, 6)}: the result has {', '.join(known)} N m"))
    return known.index(f"{plain(given, 6)}")


def index_of_position(position: int | None, result: MeshCycle) -> int | None:
    """Index from 0 of a position of a result that is in contact, given from 1."""
    if position is None:
        return None
    if not 1 <= position <= len(result.path):
        raise InputError(f"--position {position}: the result has the positions 1 to {len(result.path)}")
    if not result.path.in_contact[position - 1]:
        raise InputError(f"--position {position}: no tooth pair is in contact there")
    return position - 1


def names_of_results(paths: Sequence[Path], names: Sequence[str] | None) -> list[str]:
    """Names of results that are compared: those of --names, or the ends of their paths that differ."""
    names = [*names] if names else ends_that_differ([result_file(path) for path in paths])
    if len(names) != len(paths) or len(set(names)) != len(names):
        raise InputError(f"--names {' '.join(names)}: {len(paths)} results need {len(paths)} different names")
    return names


def comparison_of(names: Iterable[str], paths: Sequence[Path]) -> Comparison:
    """The comparison of results in files or directories, under names."""
    from loaded_tca.results import MeshCycle, compare_results

    loaded = [MeshCycle.load(result_file(path)) for path in paths]
    return compare_results(dict(zip(names, loaded, strict=True)))


def ends_that_differ(paths: Sequence[Path]) -> list[str]:
    """Shortest ends of the paths of results, without the usual name of their files, that tell them apart."""
    from loaded_tca.output.result_files import RESULT

    whole = [Path(os.path.abspath(path)) for path in paths]
    for one in whole:
        if whole.count(one) > 1:
            raise InputError(f"{one}: given twice; a comparison takes different results")
    parts = [(one.parent if one.name == RESULT else one.with_suffix("")).parts for one in whole]
    longest = max(map(len, parts))
    ends = (["/".join(part[-length:]) for part in parts] for length in range(1, longest + 1))
    return next((names for names in ends if len(set(names)) == len(names)), [str(one) for one in whole])


def check_place(directory: Path) -> None:
    """Refuse a directory that cannot be written before the analysis rather than after it; makes nothing."""
    whole = directory.absolute()
    existing = next(place for place in (whole, *whole.parents) if os.path.lexists(place))
    if not os.path.isdir(existing):
        what = "a link that leads nowhere" if existing.is_symlink() else "a file"
        raise InputError(f"--out {directory}: {existing} is {what}; give a directory")
    if not os.access(existing, os.W_OK):
        raise InputError(f"--out {directory}: {existing} cannot be written to; give another directory")
    for place in (whole, *(existing / name for name in whole.relative_to(existing).parts)):
        try:
            with suppress(FileNotFoundError):
                place.lstat()
        except OSError as error:  # a name that is too long
            raise InputError(f"--out {directory}: cannot be made a directory: {reason_of(error)}") from error


def check_files(outs: Sequence[Path], read: Path) -> None:
    """Refuse files that cannot be written, or that would replace the one that is read, before any work."""
    from loaded_tca.results.files import require_replaceable

    for out in outs:
        check_place(out.parent)
        with named("--out"):
            require_replaceable(out, [read])


@contextmanager
def executor_of(options: argparse.Namespace, variants: int) -> Iterator[Executor | None]:
    """Who analyses: processes of this machine, those of a cluster, or nobody else."""
    from loaded_tca.studies import process_pool

    if options.workers is not None:
        with process_pool(min(options.workers, variants)) as pool:
            yield pool
    elif options.scheduler is not None:
        try:
            from distributed import Client
        except ModuleNotFoundError:
            raise InputError("--scheduler: needs the package distributed; 'pip install distributed' gets it") from None
        try:
            client = Client(options.scheduler, timeout=REACHED_WITHIN)
        except (OSError, ValueError) as error:
            raise InputError(f"--scheduler {options.scheduler}: not reached: {reason_of(error)}") from None
        with client:
            yield client.get_executor(pure=False)
    else:
        yield None
