"""Scene files: read, which only this module does, made into scenes of their family, and written.

The reference of all keys comes last, from the same table that checks them.
"""

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
from loaded_tca.plain import plain
from loaded_tca.scene.keys import Choice, Key, literal, shown, shown_key
from loaded_tca.scene.section import Section, Subsection, as_given, check, contents, entries, made
from loaded_tca.scene.written import MODULE, PITCH, INCH_mm
from loaded_tca.units import INCHES, UNITS, conversion

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


MODULES = {
    "cylindrical": ("cylindrical", "double_helical", "internal", "rack"),
    "straight_bevel": ("bevel",),
    "spiral_bevel": ("bevel",),
    "face_milled": ("face_milled", "blank_face_milled"),
}
"""Type of a gear pair, as files call it -> the modules of its scenes and their variants, in the order of messages."""


class _Families(Mapping[str, "type[Scene]"]):
    """Scenes of each type of gear pair, whose modules are imported when a scene of that type is."""

    def __init__(self) -> None:
        self.known: dict[str, type[Scene]] = {}

    def __getitem__(self, kind: str) -> type[Scene]:
        for module in MODULES[kind]:
            import_module(f"loaded_tca.scene.{module}")
        return self.known[kind]

    def __iter__(self) -> Iterator[str]:
        return iter(MODULES)

    def __len__(self) -> int:
        return len(MODULES)


FAMILIES = _Families()
"""Type of a gear pair -> the scenes of its family; filled by ``family``."""

VARIANTS: dict[type[Scene], dict[type[Scene], str]] = {}
"""Class of a family -> its variants, which scenes of other keys are, and of what; filled by ``variant``."""

SceneType = TypeVar("SceneType", bound="type[Scene]")


def family(*types: str) -> Callable[[SceneType], SceneType]:
    """Make a class of scenes known to scene files, under the types of gear pairs of its section [pair]."""

    def known(scene: SceneType) -> SceneType:
        FAMILIES.known.update(dict.fromkeys(types, scene))
        return scene

    return known


def variant(scenes: type[Scene], about: str) -> Callable[[SceneType], SceneType]:
    """Make a class known as a variant of a family, for the tables that it describes; ``about`` says when."""

    def known(scene: SceneType) -> SceneType:
        VARIANTS.setdefault(scenes, {})[scene] = about
        return scene

    return known


def _variants(scenes: type[Scene]) -> list[tuple[type[Scene], str]]:
    """Variants of a family and of what they are, in the order of their modules: the first that describes a table."""
    order = [f"loaded_tca.scene.{name}" for modules in MODULES.values() for name in modules]
    return sorted(VARIANTS.get(scenes, {}).items(), key=lambda one: order.index(one[0].__module__))


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


def scenes_of(table: Mapping[str, Any]) -> type[Scene]:
    """Return the class of scenes that nested dictionaries describe; InputError with every problem if there is none."""
    pair = {} if table.get("pair") is None else table["pair"]
    pair = contents(pair) if isinstance(pair, Section) else pair
    kind = pair.get("type") if isinstance(pair, Mapping) else None
    try:
        scenes = FAMILIES[Choice(tuple(FAMILIES)).read(kind)]  # type: ignore[index]
    except ValueError as refused:
        raise InputError(_problems_without_type(table, pair, kind, str(refused))) from None
    return next((one for one, _ in _variants(scenes) if one.describes(table)), scenes)


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
    for name, (_, entry) in entries(type(section)).items():
        value = values[name]
        if isinstance(value, Section):
            sections += ["", f"[{path}{name}]", *toml_lines(value, f"{path}{name}.")]
        elif isinstance(entry, Subsection):
            sections += ["", f"# [{path}{name}] is not given"]
        elif value is None:
            keys.append(f"# {name} is not given: {entry.absent}")
        else:
            keys.append(f"{name} = {literal(as_given(value))}")
    return keys + sections


SAME_AS = {"wheel": "pinion", "pinion.material": "material", "pinion.cutter.convex": "pinion.cutter.concave"}
"""Sections described once, under another name."""


def describe_keys() -> str:
    """Return the reference of a scene file in Markdown: one table per section, one row per key.

    The sections of each family of gear pairs come first, then those that all families share.

    Examples
    --------
    >>> print(describe_keys().splitlines()[4])
    | `title` | one line of text of up to 200 characters | `""` | stands over reports and plots |
    """
    families = list(dict.fromkeys(FAMILIES.values()))
    tables = [dict(_sections(scene, "")) for scene in families]
    shared = {  # sections described under another name, and the top, are the same in every family
        path: keys_of
        for path, keys_of in tables[0].items()
        if all(path in table and (table[path] == keys_of or path in SAME_AS or not path) for table in tables)
    }
    lines = list(section_lines("", *shared.pop("")))
    for scene, table in zip(families, tables, strict=True):
        kinds = ", ".join(f"`{name}`" for name, known in FAMILIES.items() if known is scene)
        for path, (section, about) in table.items():
            if path and path not in shared:
                lines += section_lines(path, section, f"{about} ({kinds})")
        for own, when in _variants(scene):
            of_families = {section for each in tables for section, _ in each.values()}
            for path, (section, about) in _sections(own, "", {}):
                if path and section not in of_families:
                    of_family = table.get(path, (None, ""))[0]
                    lines += section_lines(path, section, f"{about} ({when})", {}, of_family)
    for path, keys_of in shared.items():
        lines += section_lines(path, *keys_of)
    lines += inch_lines()
    return "\n".join(lines).strip() + "\n"


Found = tuple[type[Section], str]
"""A section and what it is about."""


def _sections(section: type[Section], path: str, same_as: Mapping[str, str] = SAME_AS) -> Iterator[tuple[str, Found]]:
    """Path of every section -> what it is, the whole scene first."""
    if not path:
        yield "", (section, "Above all sections")
    for name, (_, entry) in entries(section).items():
        if isinstance(entry, Subsection):
            inner = f"{path}.{name}" if path else name
            yield inner, (entry.section, entry.about)
            if inner not in same_as:
                yield from _sections(entry.section, inner, same_as)


def section_lines(
    path: str,
    section: type[Section],
    about: str,
    same_as: Mapping[str, str] = SAME_AS,
    of_family: type[Section] | None = None,
) -> Iterator[str]:
    """Lines of the table of a section in Markdown; of one that is the same as another its name.

    Of a variant whose section is that of its ``of_family`` with other keys: these.
    """
    yield from ("", f"### `[{path}]`: {about}" if path else f"### {about}", "")
    if path in same_as:
        yield f"Keys as in `[{same_as[path]}]`."
        return
    known: dict[str, Any] = {}
    if of_family is not None and issubclass(section, of_family):
        known = {name: entry for name, (_, entry) in entries(of_family).items()}
        yield from (f"Keys of `[{path}]` as above, and:", "")
    others = {name: entry for name, (_, entry) in entries(section).items() if entry != known.get(name)}
    rows = [
        f"| `{name}` | {entry.kind.allowed} | {_default(entry)} | {entry.about} |"
        for name, entry in others.items()
        if isinstance(entry, Key)
    ]
    if of_family is None or section.equivalents != of_family.equivalents:
        rows += [
            f"| `{name}` | what makes a `{each.key}` | not given | {each.about}; instead of `{each.key}` |"
            for name, each in section.equivalents.items()
        ]
    if rows:
        yield from ("| key | allowed | default | meaning |", "|---|---|---|---|", *rows)
    else:
        yield from (f"- `[{path}.{name}]`: {entry.about}" for name, entry in others.items())


def _default(entry: Key) -> str:
    if entry.required:
        return "**required**"
    return entry.absent if entry.default is None else f"`{literal(entry.default)}`"


def inch_lines() -> Iterator[str]:
    """Lines of the table of endings that keys have on drawings in inches, in Markdown."""
    yield from ("", "### Keys on drawings in inches", "", "| ending | instead of | is |", "|---|---|---|")
    for ending, (unit, metric) in INCHES.items():
        of = [f"{conversion(unit, UNITS[each].text):.10g} {UNITS[each].text}" for each in metric]
        yield f"| `_{ending}` | {', '.join(f'`_{each}`' for each in metric)} | {' or '.join(of)} |"
    yield f"| `_{PITCH}` | `_{MODULE}` | {plain(float(INCH_mm), 6)} mm over it |"
