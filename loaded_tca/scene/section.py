"""Sections of a scene: frozen dataclasses whose fields say what a file may hold.

One table (the fields) drives the parser, its messages, the canonical text and the reference of the keys. A
new gear type is a new set of sections; nothing here needs to know it.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from textwrap import shorten
from typing import Any, ClassVar, TypeVar

from loaded_tca.errors import InputError
from loaded_tca.input_files import is_place
from loaded_tca.plain import Sentence
from loaded_tca.scene.keys import Key, List, did_you_mean, nearest, shown, shown_key
from loaded_tca.scene.spellings import key_meant_by
from loaded_tca.scene.written import (
    Equivalents,
    Writing,
    WrittenTable,
    answered,
    as_written,
    by_keys,
    in_inches,
    writing_of,
)

SectionType = TypeVar("SectionType", bound="Section")

MOST_UNKNOWN_KEYS = 20
"""Unknown keys told one by one; of the rest of a section only the number is told."""

INCH_WORDS = "in", "inch", "inches", "lb", "lbs", "lbf", "ft", "psi", "ksi"
"""Ends of unknown keys that mean a unit of drawings in inches."""

LONGEST_LIST = 300
"""Characters of the names of keys that a message lists."""


@dataclass(frozen=True)
class Subsection:
    """A section inside a section; ``optional`` ones may be absent, others then take their defaults."""

    section: type[Section]
    about: str
    optional: bool = False
    name: str = ""


@dataclass(frozen=True)
class Tables:
    """A list of tables of one kind, which become sections; a kind of value of a key."""

    section: type[Section]
    shortest: int
    longest: int

    @property
    def allowed(self) -> str:
        """Length and keys in words."""
        return f"a list of {self.shortest} to {self.longest} tables of {', '.join(entries(self.section))}"

    def read(self, value: Any) -> tuple[Section, ...]:
        """Return sections; all problems of all tables are told at once, with their places from 0 on.

        Tables by their places, ``{"0": ..., "1": ...}``, are taken too.
        """
        if isinstance(value, Mapping) and set(value) == {str(place) for place in range(len(value))}:
            value = [value[str(place)] for place in range(len(value))]
        if not isinstance(value, list | tuple) or not self.shortest <= len(value) <= self.longest:
            raise ValueError(f"found {shown(value)}; allowed {self.allowed}")
        made_of: list[Section] = []
        problems: list[str] = []
        for place, table in enumerate(value):
            if isinstance(table, self.section):
                made_of.append(table)
            elif not isinstance(table, Mapping):
                problems.append(
                    f"table {place}: found {shown(table)}; allowed a table of {', '.join(entries(self.section))}"
                )
            else:
                values, wrong, _ = check(self.section, table)
                problems += [f"table {place}: {one}" for one in wrong]
                if not wrong:
                    made_of.append(made(self.section, values))
        if problems:
            raise ValueError("; ".join(problems))
        return tuple(made_of)


@dataclass(frozen=True)
class Rule:
    """What several keys must fulfil together; looked at only where each of them is sound by itself.

    ``complain`` takes the values of ``keys`` and returns None or the rest of a message about the first key.
    """

    keys: tuple[str, ...]
    complain: Callable[..., str | None]


@dataclass(frozen=True)
class Refusal(Rule):
    """That a key, which a section has from its base, is not given; written sections leave it out."""


def refusal(name: str, problem: str) -> Refusal:
    """Return the rule that a key is not given; ``problem`` is a format of its value."""
    return Refusal((name,), lambda value: None if value is None or value == () else Sentence().format(problem, value))


def refused_keys(section: type[Section]) -> set[str]:
    """Return the keys that a section has from its base and refuses."""
    return {name for demand in section.rules if isinstance(demand, Refusal) for name in demand.keys}


def rule(keys: tuple[str, ...], holds: Callable[..., bool], problem: str) -> Rule:
    """Return the rule that values fulfil where ``holds``; ``problem`` is a format of them, ``{0}`` the first."""
    return Rule(keys, lambda *values: None if holds(*values) else Sentence().format(problem, *values))


@dataclass(frozen=True, kw_only=True)
class Section:
    """What all sections share: every way to make one checks all its values, every problem is told.

    ``alternatives`` are keys that say the same in several ways: one that is changed takes the place of the others, and
    of their ``companions``, keys that mean nothing without them. ``equivalents`` are other names that tables may have
    in the place of keys.
    """

    rules: ClassVar[tuple[Rule, ...]] = ()
    equivalents: ClassVar[Equivalents] = {}
    alternatives: ClassVar[tuple[str, ...]] = ()
    companions: ClassVar[dict[str, tuple[str, ...]]] = {}

    def __post_init__(self) -> None:
        values, problems, _ = check(type(self), contents(self))
        if problems:
            raise InputError(problems)
        for name, (attribute, _) in entries(type(self)).items():
            object.__setattr__(self, attribute, values[name])


def subsection(section: type[Section], about: str, optional: bool = False, name: str = "") -> Any:
    """Dataclass field that is a section of a file, under ``name`` where that is not the field's own."""
    entry = {"entry": Subsection(section, about, optional, name)}
    return field(default=None, metadata=entry) if optional else field(default_factory=dict, metadata=entry)


def entries(section: type[Section]) -> dict[str, tuple[str, Key | Subsection]]:
    """Name in a file -> (attribute, entry), in the order in which they are written."""
    table = {}
    for each in dataclasses.fields(section):
        entry = each.metadata["entry"]
        name = entry.name if isinstance(entry, Subsection) and entry.name else each.name
        table[name] = (each.name, entry)
    return table


def keys_of(section: type[Section]) -> dict[str, Key]:
    """Name in a file -> key, without the sections inside."""
    return {name: entry for name, (_, entry) in entries(section).items() if isinstance(entry, Key)}


def contents(section: Section) -> dict[str, Any]:
    """Name in a file -> value; values that are sections stay what they are."""
    return {name: getattr(section, attribute) for name, (attribute, _) in entries(type(section)).items()}


def as_table(section: Section) -> dict[str, Any]:
    """Return the section as nested dictionaries, as a file would give it, without the keys that hold None."""
    return {name: as_given(value) for name, value in contents(section).items() if value is not None}


def as_given(value: Any) -> Any:
    """A value as a file would give it: sections, and those of lists, as dictionaries."""
    if isinstance(value, Section):
        return as_table(value)
    if isinstance(value, tuple) and value and isinstance(value[0], Section):
        return tuple(as_table(one) for one in value)
    return value


def values_of(section: Section) -> dict[str, Any]:
    """Return the values of a section, as ``check`` does of a table: of its own keys, and with dots of those inside."""
    values = contents(section)
    for name, inner in list(values.items()):
        if isinstance(inner, Section):
            values |= {f"{name}.{key}": value for key, value in values_of(inner).items()}
    return values


def check(
    section: type[Section], table: Mapping[str, Any], place: str = "", whole: type[Section] | None = None
) -> tuple[dict[str, Any], list[str], dict[str, Writing]]:
    """Check a table against a section.

    Parameters
    ----------
    section : type of Section
    table : mapping
        Names -> values; sections inside are mappings or made already. None counts as not given. Keys may be written as
        drawings have them.
    place : str
        Prefix of the keys in messages, empty or ending in a dot.
    whole : type of Section, optional
        That this one stands in: a key that belongs elsewhere in it is shown its place. Default: the section.

    Returns
    -------
    values : dict
        The values that are sound, with defaults for the keys not given: the section's own names, and the
        names inside its sections with dots.
    problems : list of str
        One line per problem, by the names and in the units of the table.
    writings : dict
        The same names of keys -> how the table writes them, of those that it writes otherwise.
    """
    values: dict[str, Any] = {}
    whole = whole or section
    known = entries(section)
    written = WrittenTable(table)
    if any(name not in known for name in table):
        written = by_keys(table, keys_of(section), section.equivalents, f"[{place[:-1]}]" if place else "the table")
    table, writings = written.table, written.writings
    problems = [*_unknown(section, table, place, whole), *(f"{place}{problem}" for problem in written.problems)]
    for name, (_, entry) in known.items():
        given = table.get(name)
        if isinstance(entry, Subsection):
            inner, inner_problems, inner_writings = _check_subsection(name, entry, given, place, whole)
            values |= inner
            problems += inner_problems
            writings = writings | {f"{name}.{key}": writing for key, writing in inner_writings.items()}
            continue
        writing = writings.get(name)
        try:
            values[name] = entry.read(given) if writing is None else writing.read(entry, given)
        except ValueError as refused:
            problems.append(f"{place}{name if writing is None else writing.name}: {refused}")
    for demand in section.rules:
        if all(name in values for name in demand.keys):
            complaint = demand.complain(*(values[name] for name in demand.keys))
            if complaint is not None:
                problems.append(f"{place}{_answer(demand.keys, complaint, writings)}")
    return values, problems, writings


def _answer(keys: tuple[str, ...], complaint: str, writings: Mapping[str, Writing]) -> str:
    """What a rule says of its keys, as the table writes them; the first one's section has names without its path."""
    if not writings:
        return f"{keys[0]}: {complaint}"
    own = keys[0].rpartition(".")[0]
    named = {writing.key: writing for key, writing in writings.items() if key.rpartition(".")[0] == own}
    named |= writings
    return f"{as_written(keys[0], '', named)}: {as_written(complaint, keys[0], named)}"


def _check_subsection(
    name: str, entry: Subsection, given: Any, place: str, whole: type[Section]
) -> tuple[dict[str, Any], list[str], dict[str, Writing]]:
    if given is None and entry.optional:
        return {name: None}, [], {}
    if type(given) is entry.section:  # checked when it was made
        return {name: given} | {f"{name}.{key}": value for key, value in values_of(given).items()}, [], {}
    if isinstance(given, Section):
        given = contents(given) if isinstance(given, entry.section) else shown(given)
    if not isinstance(given, Mapping | None):
        return {}, [f"{place}{name}: found {shown(given)}; allowed a section [{place}{name}]"], {}
    values, problems, writings = check(entry.section, given or {}, f"{place}{name}.", whole)
    inner = {f"{name}.{key}": value for key, value in values.items()}
    if problems:
        return inner, problems, writings
    try:
        inner[name] = made(entry.section, values)
    except InputError as refused:  # what only shows when it is made: a file that cannot be read
        return inner, [f"{place}{name}.{problem}" for problem in refused.problems], writings
    return inner, [], writings


def made(section: type[SectionType], values: Mapping[str, Any]) -> SectionType:
    """Return the section that holds checked values."""
    return section(**{attribute: values[name] for name, (attribute, _) in entries(section).items()})


def _key_written(section: type[Section], name: str) -> str:
    """Key of a section that a name of drawings writes; nothing where it writes none."""
    if name in section.equivalents:
        return section.equivalents[name].key
    writing = writing_of(name, keys_of(section), {})
    return "" if writing is None else writing.key


def _unknown(
    section: type[Section], value: Mapping[str, Any], place: str, whole: type[Section] | None = None
) -> Iterator[str]:
    known = entries(section)
    unknown = [name for name in value if name not in known]
    homes = {name: place + home for name, home in _homes(section).items()} if unknown else {}
    usual: dict[str, str] = {}
    if any(name.lower().endswith(INCH_WORDS) for name in unknown):
        writings = {key: in_inches(key, entry) for key, entry in keys_of(section).items()}
        usual = {key: writing.name for key, writing in writings.items() if writing}
        homes |= {name: place + name for name in usual.values()}
    elsewhere = _homes(whole) if unknown and whole is not None else {}
    for name in unknown[:MOST_UNKNOWN_KEYS]:
        near = nearest(name, homes) or ""
        spelled = key_meant_by(name, homes) or key_meant_by(name, elsewhere)
        if name.lower().endswith(INCH_WORDS):
            spelled = usual.get(spelled or "", spelled)
        own = set(name.split("_")) <= set(near.split("_"))  # but for a word: "shaft_angle_error_deg"
        meant = (not own and elsewhere.get(name)) or homes.get(spelled or near) or elsewhere.get(spelled or "")
        allowed = shorten(", ".join(known), LONGEST_LIST, placeholder=" ...")
        hint = did_you_mean(meant) or f"; allowed {allowed}"
        yield f"{place}{shown_key(name)}: unknown key{hint}"
    if len(unknown) > MOST_UNKNOWN_KEYS:
        more = len(unknown) - MOST_UNKNOWN_KEYS
        yield f"{place.rstrip('.') or 'scene'}: {more} more unknown keys"


def key_at(section: type[Section], path: str, place: str = "") -> Key:
    """Return what a section says of the key at a path with dots.

    Raises
    ------
    InputError
        If there is no such key, or the path leads to a section.

    Examples
    --------
    >>> from loaded_tca.scene.cylindrical import CylindricalScene
    >>> key_at(CylindricalScene, "pinion.modifications.lead_crowning_um").default
    0.0
    """
    name, _, rest = path.partition(".")
    if name not in entries(section):
        if not rest and (key := _key_written(section, name)):
            raise InputError(
                f"{place}{name}: a name of drawings, whose values are not converted here; allowed {place}{key}"
            )
        raise InputError(_unknown(section, {name: None}, place))
    entry = entries(section)[name][1]
    if isinstance(entry, Subsection):
        if not rest:
            raise InputError(f"{place}{name}: a section; allowed is one of its keys")
        return key_at(entry.section, rest, f"{place}{name}.")
    if rest and isinstance(entry.kind, Tables):
        index, _, rest = rest.partition(".")
        if not is_place(index):
            raise InputError(f"{place}{name}.{shown_key(index)}: not a place in a list; allowed 0, 1, ...")
        if rest:
            return key_at(entry.kind.section, rest, f"{place}{name}.{index}.")
        raise InputError(f"{place}{name}.{index}: a table; allowed is one of its keys")
    if rest:
        raise InputError(f"{place}{name}.{shown_key(rest)}: unknown key; {place}{name} is a key, not a section")
    return entry


def place_at(table: dict[str, Any], sections: Sequence[str]) -> dict[str, Any]:
    """The table inside a table at a path, made where there is none; all that lies on the way is copied.

    Sections become tables, lists of tables such by their places.
    """
    for name in sections:
        inner = table.get(name)
        inner = contents(inner) if isinstance(inner, Section) else inner
        if isinstance(inner, tuple) and inner and isinstance(inner[0], Section | dict):
            inner = {str(n): one for n, one in enumerate(inner)}
        table[name] = table = dict(inner) if isinstance(inner, dict) else {}
    return table


def without_keys_of(before: Section, table: dict[str, Any], section: type[Section], changed: Collection[str]) -> None:
    """Take keys out of a table that a section does not know and that say nothing: None, or defaults of another section.

    Parameters
    ----------
    before : Section
        Which the table was made of, of another kind.
    table : dict
    section : type of Section
    changed : collection of str
        Paths, with dots, of keys in the table that are given: of these None alone says nothing.
    """
    known = entries(section)
    for name, (_, entry) in entries(type(before)).items():
        inner = _inside(changed, name)
        if name not in known:
            is_default = isinstance(entry, Key) and not inner and table.get(name, entry.default) == entry.default
            if is_default or table.get(name) is None:
                table.pop(name, None)
            continue
        there = known[name][1]
        own = contents(before)[name]
        if isinstance(there, Subsection) and isinstance(own, Section) and isinstance(table.get(name), dict):
            without_keys_of(own, table[name], there.section, inner)


def beyond_defaults(before: Section, table: Mapping[str, Any], changed: Collection[str]) -> dict[str, Any]:
    """Return what a table says beyond the defaults of the section that it was made of: variants are told by this.

    Parameters
    ----------
    before : Section
        Which the table was made of.
    table : mapping
    changed : collection of str
        Paths, with dots, of keys and sections in the table that are given: these are kept whole.
    """
    kept = dict(table)
    for name, (_, entry) in entries(type(before)).items():
        inner = _inside(changed, name)
        value, own = table.get(name), contents(before)[name]
        if isinstance(entry, Key) and not inner and value == entry.default:
            kept.pop(name, None)
        elif isinstance(own, Section) and isinstance(value, dict) and "" not in inner:
            kept[name] = beyond_defaults(own, value, inner)
    return kept


def _inside(paths: Collection[str], name: str) -> list[str]:
    """Paths that begin with a name, from there on; the name itself is empty."""
    return [rest for first, _, rest in (path.partition(".") for path in paths) if first == name]


def replaced_by(section: type[Section], changes: Mapping[str, Any]) -> set[str]:
    """Paths of the keys whose places those that are changed take: none that is changed itself, or inside.

    Parameters
    ----------
    section : type
    changes : mapping
        Path of a key, with dots, -> value; None: not given.

    Examples
    --------
    >>> from loaded_tca.scene.cylindrical import CylindricalScene
    >>> replaced_by(CylindricalScene, {"wheel.flank.file": "points.csv"})
    {'wheel.flank.measurement'}
    >>> replaced_by(CylindricalScene, {"wheel.tooth.0.flank.file": "a.csv", "wheel.tooth.0.flank.measurement.x": 1})
    set()
    """
    parts = [path.split(".") for path, value in changes.items() if value is not None]
    paths = {".".join(names[: n + 1]) for names in parts for n in range(len(names))}
    return {other for path in paths for other in _alternatives_of(section, path)} - paths


def _alternatives_of(section: type[Section], path: str) -> tuple[str, ...]:
    """Paths of the alternatives of the key at a path, and of their companions; none of a path that leads nowhere."""
    *sections, name = path.split(".")
    inner = _section_at(section, sections)
    if inner is None:
        return ()
    others = [other for other in inner.alternatives if other != name] if name in inner.alternatives else []
    others += [companion for other in others for companion in inner.companions.get(other, ())]
    return tuple(".".join((*sections, other)) for other in others)


def _section_at(section: type[Section], names: Sequence[str]) -> type[Section] | None:
    """The section inside another one that names and places in lists lead to; None where they lead nowhere."""
    rest = iter(names)
    for each in rest:
        _, entry = entries(section).get(each, ("", None))
        if isinstance(entry, Subsection):
            section = entry.section
        elif isinstance(entry, Key) and isinstance(entry.kind, Tables) and is_place(next(rest, "")):
            section = entry.kind.section
        else:
            return None
    return section


def writing_at(scene: Section, path: str, changes: Mapping[str, Any] = {}) -> tuple[str, Writing | None]:
    """Return the path of the key that a path of a drawing writes, and how; the path itself where it writes none.

    Parameters
    ----------
    scene : Section
        Made already: what ``transverse_module_mm`` means follows from its helix angle.
    path : str
        With dots.
    changes : mapping, optional
        Path -> value, of those that change with it.

    Raises
    ------
    InputError
        If the name may mean several things.

    Examples
    --------
    >>> from loaded_tca import parse_scene
    >>> from loaded_tca.cli import DEMO_SCENE
    >>> path, writing = writing_at(parse_scene(DEMO_SCENE.read_text()), "pinion.face_width_in")
    >>> path, writing.converted(1.5)
    ('pinion.face_width_mm', 38.1)
    """
    *sections, name = path.split(".")
    section = _section_at(type(scene), sections)
    if section is None and is_place(name):  # in a list of numbers, each as the list has them
        path, writing = writing_at(scene, ".".join(sections), changes)
        return f"{path}.{name}", writing
    if section is None or name in entries(section):
        return path, None
    around: Any = scene
    for each in sections:
        around = contents(around).get(each) if isinstance(around, Section) else None
    own = ".".join((*sections, ""))
    table = contents(around) if isinstance(around, Section) else {}
    table |= {key.removeprefix(own): value for key, value in changes.items() if key.startswith(own)}
    writing = writing_of(name, keys_of(section), section.equivalents, table)
    question = section.equivalents[name].question(table) if name in section.equivalents else None
    if question is not None:
        raise InputError(f"{path}: {question}")
    return path if writing is None else own + writing.key, writing


def in_keys(scene: Section, changes: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Writing]]:
    """Return changes of a scene by the keys of its sections, and how they are written, where otherwise.

    Raises
    ------
    InputError
        With every value that is refused in the unit in which it is given, and every key that is given twice.
    """
    by_key: dict[str, Any] = {}
    writings: dict[str, Writing] = {}
    problems: list[str] = []
    for path, value in changes.items():
        try:
            key, writing = writing_at(scene, path, changes)
            if writing is not None:
                writings[key] = writing
                value = value if value is None else writing.read(_entry_at(type(scene), key), value)
        except InputError as error:
            problems += error.problems
            continue
        except ValueError as refused:
            problems.append(f"{path}: {refused}")
            continue
        if writing is not None and (key in by_key or key in changes):
            problems.append(f"{path}: given twice, as {key} too")
        by_key[key] = value
    if problems:
        raise InputError(problems)
    return by_key, writings


def _entry_at(section: type[Section], path: str) -> Key:
    """The key at a path, or that of the numbers of a list whose place the path ends with."""
    *names, name = path.split(".")
    if not is_place(name):
        return key_at(section, path)
    entry = key_at(section, ".".join(names))
    return dataclasses.replace(entry, kind=entry.kind.kind) if isinstance(entry.kind, List) else entry


@contextmanager
def told_as_written(writings: Mapping[str, Writing]) -> Iterator[None]:
    """Tell the problems of keys by the names and in the units in which they are changed."""
    try:
        yield
    except InputError as error:
        raise InputError(answered(error.problems, writings)) if writings else error from None


def _homes(section: type[Section]) -> dict[str, str]:
    """Name of every key and section inside -> where it belongs, seen from the section."""
    inner: dict[str, str] = {}
    for name, (_, entry) in reversed(entries(section).items()):
        if isinstance(entry, Subsection):
            inner |= {key: f"{name}.{home}" for key, home in _homes(entry.section).items()}
    return inner | {name: name for name in (*entries(section), *section.equivalents)}
