"""Sections of a scene: frozen dataclasses whose fields say what a file may hold.

One table (the fields) drives the parser, its messages, the canonical text and the reference of the keys. A
new gear type is a new set of sections; nothing here needs to know it.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from textwrap import shorten
from typing import Any, ClassVar, TypeVar

from loaded_tca.errors import InputError
from loaded_tca.input_files import is_place
from loaded_tca.scene.keys import Key, did_you_mean, nearest, shown, shown_key
from loaded_tca.scene.spellings import key_meant_by

SectionType = TypeVar("SectionType", bound="Section")

MOST_UNKNOWN_KEYS = 20
"""Unknown keys told one by one; of the rest of a section only the number is told."""

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
                values, wrong = check(self.section, table)
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


def rule(keys: tuple[str, ...], holds: Callable[..., bool], problem: str) -> Rule:
    """Return the rule that values fulfil where ``holds``; ``problem`` is a format of them, ``{0}`` the first."""
    return Rule(keys, lambda *values: None if holds(*values) else problem.format(*values))


@dataclass(frozen=True, kw_only=True)
class Section:
    """What all sections share: every way to make one checks all its values, every problem is told.

    ``alternatives`` are keys that say the same in several ways: one that is changed takes the place of the others, and
    of their ``companions``, keys that mean nothing without them.
    """

    rules: ClassVar[tuple[Rule, ...]] = ()
    alternatives: ClassVar[tuple[str, ...]] = ()
    companions: ClassVar[dict[str, tuple[str, ...]]] = {}

    def __post_init__(self) -> None:
        values, problems = check(type(self), contents(self))
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
) -> tuple[dict[str, Any], list[str]]:
    """Check a table against a section.

    Parameters
    ----------
    section : type of Section
    table : mapping
        Names -> values; sections inside are mappings or made already. None counts as not given.
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
        One line per problem.
    """
    values: dict[str, Any] = {}
    whole = whole or section
    problems = list(_unknown(section, table, place, whole))
    for name, (_, entry) in entries(section).items():
        given = table.get(name)
        if isinstance(entry, Subsection):
            inner, inner_problems = _check_subsection(name, entry, given, place, whole)
            values |= inner
            problems += inner_problems
            continue
        try:
            values[name] = entry.read(given)
        except ValueError as refused:
            problems.append(f"{place}{name}: {refused}")
    for demand in section.rules:
        if all(name in values for name in demand.keys):
            complaint = demand.complain(*(values[name] for name in demand.keys))
            if complaint is not None:
                problems.append(f"{place}{demand.keys[0]}: {complaint}")
    return values, problems


def _check_subsection(
    name: str, entry: Subsection, given: Any, place: str, whole: type[Section]
) -> tuple[dict[str, Any], list[str]]:
    if given is None and entry.optional:
        return {name: None}, []
    if type(given) is entry.section:  # checked when it was made
        return {name: given} | {f"{name}.{key}": value for key, value in values_of(given).items()}, []
    if isinstance(given, Section):
        given = contents(given) if isinstance(given, entry.section) else shown(given)
    if not isinstance(given, Mapping | None):
        return {}, [f"{place}{name}: found {shown(given)}; allowed a section [{place}{name}]"]
    values, problems = check(entry.section, given or {}, f"{place}{name}.", whole)
    inner = {f"{name}.{key}": value for key, value in values.items()}
    if problems:
        return inner, problems
    try:
        inner[name] = made(entry.section, values)
    except InputError as refused:  # what only shows when it is made: a file that cannot be read
        return inner, [f"{place}{name}.{problem}" for problem in refused.problems]
    return inner, []


def made(section: type[SectionType], values: Mapping[str, Any]) -> SectionType:
    """Return the section that holds checked values."""
    return section(**{attribute: values[name] for name, (attribute, _) in entries(section).items()})


def _unknown(
    section: type[Section], value: Mapping[str, Any], place: str, whole: type[Section] | None = None
) -> Iterator[str]:
    known = entries(section)
    unknown = [name for name in value if name not in known]
    homes = {name: place + home for name, home in _homes(section).items()} if unknown else {}
    elsewhere = _homes(whole) if unknown and whole is not None else {}
    for name in unknown[:MOST_UNKNOWN_KEYS]:
        near = nearest(name, homes) or ""
        spelled = key_meant_by(name, homes) or key_meant_by(name, elsewhere)
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
    names = iter(sections)
    for each in names:
        _, entry = entries(section).get(each, ("", None))
        if isinstance(entry, Subsection):
            section = entry.section
        elif isinstance(entry, Key) and isinstance(entry.kind, Tables) and is_place(next(names, "")):
            section = entry.kind.section
        else:
            return ()
    others = [other for other in section.alternatives if other != name] if name in section.alternatives else []
    others += [companion for other in others for companion in section.companions.get(other, ())]
    return tuple(".".join((*sections, other)) for other in others)


def _homes(section: type[Section]) -> dict[str, str]:
    """Name of every key and section inside -> where it belongs, seen from the section."""
    inner: dict[str, str] = {}
    for name, (_, entry) in reversed(entries(section).items()):
        if isinstance(entry, Subsection):
            inner |= {key: f"{name}.{home}" for key, home in _homes(entry.section).items()}
    return inner | {name: name for name in entries(section)}
