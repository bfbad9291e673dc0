"""Scene files: read, which only this module does, made into scenes of their family, and written."""

from __future__ import annotations

import os
import re
import sys
import tomllib
from collections.abc import Callable, Iterator, Mapping
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from loaded_tca.arguments import checked
from loaded_tca.errors import InputError
from loaded_tca.input_files import read_text
from loaded_tca.scene.keys import Choice, literal, shown, shown_key
from loaded_tca.scene.section import Section, Subsection, as_given, check, contents, entries, made, refused_keys
from loaded_tca.scene.variants import MODULES

if TYPE_CHECKING:
    from loaded_tca.scene.model import Scene

LARGEST_FILE = 2**21
"""Bytes of a scene file; a full one has about 5000, one with two measured flanks of 100 x 100 points a million."""

LEVELS_WITH_FILES = 4
"""Parts of the longest key that names a file."""

SPECTRUM = "load", "spectrum"
"""Key that names a file, beside those called file."""

MOST_DOTS = 2000
"""Dots in one line: reading a key of tens of thousands of dotted parts takes minutes."""

MOST_SQUARED_DOTS = 2e7
"""Sum of squares of the dots of all lines, which is what reading them takes; two large measured flanks have 6e6."""


@checked
def read_scene(path: str | os.PathLike[str]) -> Scene:
    """Read a scene file.

    Parameters
    ----------
    path : str or path
        A TOML file in UTF-8. The files that it names lie in its folder, or below.

    Returns
    -------
    Scene

    Raises
    ------
    InputError
        If the file cannot be read, or with every problem that it holds, one per line.
    """
    return parse_scene(read_text(path, LARGEST_FILE), source=os.fspath(path), folder=Path(path).parent)


@checked
def parse_scene(text: str, source: str = "scene", folder: str | os.PathLike[str] | None = ".") -> Scene:
    r"""Make a scene of the text of a scene file.

    Parameters
    ----------
    text : str
        TOML.
    source : str
        What messages call the text, for instance the name of the file.
    folder : str or path, optional
        Where the files that it names lie, or below; None: it may name none.

    Raises
    ------
    InputError
        If the text is not TOML, names a file that lies elsewhere, or with every problem that it holds, one per line.

    Examples
    --------
    >>> parse_scene("[pair]\nmodul = 3")  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    loaded_tca.errors.InputError: pair.type: missing; allowed "cylindrical" or "straight_bevel" or ... or "face_milled"
    pair.modul: unknown key; did you mean "pair.normal_module_mm"?
    ...
    """
    table = toml_table(text, source)
    if is_table_of_stage(table):
        raise InputError(f"{source}: not the scene of a pair but a planetary stage; run it with 'loaded-tca stage'")
    if "pair" not in table and isinstance(table.get("scene"), str):
        raise InputError(f"{source}: not a scene but a study of {table['scene']}; run it with 'loaded-tca study'")
    return scene_from_table(with_files_from(None if folder is None else Path(folder), table))


def is_table_of_stage(table: Mapping[str, Any]) -> bool:
    """Whether the table of a file is that of a planetary stage."""
    return isinstance(table.get("stage"), dict) and "sun" in table


def literal_value(text: str) -> Any:
    """Return the value that a literal of TOML stands for; any other text is a string by itself.

    Examples
    --------
    >>> [literal_value(text) for text in ("6", "[20.0, 130.0]", "false", "left", '"left"')]
    [6, [20.0, 130.0], False, 'left', 'left']
    """
    try:
        table = tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):
        return text
    return table["value"] if len(table) == 1 else text


def with_files_from(folder: Path | None, table: dict[str, Any], section: tuple[str, ...] = ()) -> dict[str, Any]:
    """The table, in which the keys of the upper levels that name a file name it from the current folder.

    Who opens the scene of somebody else lets it read nothing but what lies beside it.
    """
    with_files: dict[str, Any] = {}
    problems: list[str] = []
    for name, value in table.items():
        key = (*section, name)
        with_files[name] = value
        tables = isinstance(value, list) and all(isinstance(one, dict) for one in value)
        if (isinstance(value, dict) or tables) and len(key) < LEVELS_WITH_FILES:
            try:
                inner = [with_files_from(folder, one, key) for one in (value if tables else [value])]
                with_files[name] = inner if tables else inner[0]
            except InputError as error:
                problems += error.problems
        elif (name == "file" or key == SPECTRUM) and isinstance(value, str):
            if folder is not None and _lies_in(folder, value):
                with_files[name] = str(folder / value)
            else:
                allowed = "no file here" if folder is None else "a file in the folder of the scene, or below it"
                problems.append(f"{'.'.join(map(shown_key, key))}: found {shown(value)}; allowed {allowed}")
    if problems:
        raise InputError(problems)
    return with_files


def _lies_in(folder: Path, file: str) -> bool:
    """Whether a file, links followed, lies in a folder or below it."""
    try:
        return Path(os.path.realpath(folder / file)).is_relative_to(os.path.realpath(folder))
    except ValueError:  # no name of a file, which is told where it is read
        return True


def toml_table(text: str, source: str) -> dict[str, Any]:
    """Return the tables of a TOML text; InputError if it is none, or too long."""
    if len(text) > LARGEST_FILE:
        raise InputError(f"{source}: too long for a scene; allowed up to {LARGEST_FILE} characters")
    dots = [line.count(".") for line in text.split("\n")]
    if max(dots) > MOST_DOTS:
        line = next(number for number, count in enumerate(dots, 1) if count > MOST_DOTS)
        raise InputError(f"{source}: line {line} holds more than {MOST_DOTS} dots")
    if sum(count**2 for count in dots) > MOST_SQUARED_DOTS:
        raise InputError(f"{source}: too many lines with hundreds of dots; allowed up to 100 numbers in a line")
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise InputError(f"{source}: not a scene: nested too deeply") from None
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{source}: not a TOML file: {error}") from None
    except ValueError:  # of Python's integers, which are read from no more digits
        most = sys.get_int_max_str_digits()
        digits = re.compile(rf"[\d_]{{{most + 1},}}")
        lines = [str(number) for number, line in enumerate(text.split("\n"), 1) if digits.search(line)]
        raise InputError(f"{source}: line {lines[0]} holds a whole number of more than {most} digits") from None


class _Families(Mapping[str, "type[Scene]"]):
    """Scenes of each type of gear pair, whose module is imported when a scene of that type is."""

    def __init__(self) -> None:
        self.known: dict[str, type[Scene]] = {}

    def __getitem__(self, kind: str) -> type[Scene]:
        module, _ = MODULES[kind]
        import_module(f"loaded_tca.scene.{module}")
        return self.known[kind]

    def __iter__(self) -> Iterator[str]:
        return iter(MODULES)

    def __len__(self) -> int:
        return len(MODULES)


FAMILIES = _Families()
"""Type of a gear pair -> the scenes of its family; filled by ``family``."""


class _Variants(Mapping[str, "tuple[type[Scene], str]"]):
    """Scenes of each variant of a family, and of what they are, by their modules, which are imported when asked for."""

    def __init__(self) -> None:
        self.known: dict[str, tuple[type[Scene], str]] = {}

    def __getitem__(self, module: str) -> tuple[type[Scene], str]:
        import_module(f"loaded_tca.scene.{module}")
        return self.known[module]

    def __iter__(self) -> Iterator[str]:
        return (module for _, variants in MODULES.values() for module in variants)

    def __len__(self) -> int:
        return sum(len(variants) for _, variants in MODULES.values())


VARIANTS = _Variants()
"""Module of a variant -> its scenes, which have other keys than those of the family, and of what; filled by
``variant``."""

SceneType = TypeVar("SceneType", bound="type[Scene]")


def family(*types: str) -> Callable[[SceneType], SceneType]:
    """Make a class of scenes known to scene files, under the types of gear pairs of its section [pair]."""

    def known(scene: SceneType) -> SceneType:
        FAMILIES.known.update(dict.fromkeys(types, scene))
        return scene

    return known


def variant(about: str) -> Callable[[SceneType], SceneType]:
    """Make the class of a module of ``MODULES`` known as a variant of its family; ``about`` says of what."""

    def known(scene: SceneType) -> SceneType:
        VARIANTS.known[scene.__module__.rpartition(".")[2]] = scene, about
        return scene

    return known


def scene_from_table(table: Mapping[str, Any]) -> Scene:
    """Return the scene that nested dictionaries describe, as TOML would give them; ``pair.type`` picks the family.

    Raises
    ------
    InputError
        Every problem at once.
    """
    scenes = scenes_of(table)
    values, problems, _ = check(scenes, table)
    if problems:
        raise InputError(problems)
    return made(scenes, values)


def scenes_of(table: Mapping[str, Any], said: Mapping[str, Any] | None = None) -> type[Scene]:
    """Return the class of scenes that nested dictionaries describe; InputError with every problem if there is none.

    ``said``: the part of the table that tells the variant, without defaults of another one; None: all of the table.
    """
    pair = {} if table.get("pair") is None else table["pair"]
    pair = contents(pair) if isinstance(pair, Section) else pair
    kind = pair.get("type") if isinstance(pair, Mapping) else None
    try:
        name = str(Choice(tuple(FAMILIES)).read(kind))
    except ValueError as refused:
        raise InputError(_problems_without_type(table, pair, kind, str(refused))) from None
    _, variants = MODULES[name]
    module = next((each for each, describes in variants.items() if describes(table if said is None else said)), None)
    return FAMILIES[name] if module is None else VARIANTS[module][0]


def _problems_without_type(table: Mapping[str, Any], pair: Any, kind: Any, refusal: str) -> list[str]:
    """Every problem of a scene of no known type: the others are those as the type that knows the most keys."""
    if not isinstance(pair, Mapping):
        return check(next(iter(FAMILIES.values())), table)[1]
    complaint = f"missing; allowed {Choice(tuple(FAMILIES)).allowed}" if kind is None else refusal
    trials = [check(scenes, {**table, "pair": {**pair, "type": name}})[1] for name, scenes in FAMILIES.items()]
    fewest = min(trials, key=lambda problems: (sum("unknown key" in problem for problem in problems), len(problems)))
    return [f"pair.type: {complaint}", *fewest]


def toml_lines(section: Section, path: str) -> list[str]:
    """Keys first, then the sections inside, each under its header."""
    keys, sections = [], []
    values = contents(section)
    refused = refused_keys(type(section))
    for name, (_, entry) in entries(type(section)).items():
        value = values[name]
        if name in refused:
            continue
        if isinstance(value, Section):
            sections += ["", f"[{path}{name}]", *toml_lines(value, f"{path}{name}.")]
        elif isinstance(entry, Subsection):
            sections += ["", f"# [{path}{name}] is not given"]
        elif value is None:
            keys.append(f"# {name} is not given: {entry.absent}")
        else:
            keys.append(f"{name} = {literal(as_given(value))}")
    return keys + sections
