"""The reference of all keys of scene files, from the table that checks them: as data, and in Markdown."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from loaded_tca.plain import plain
from loaded_tca.scene.keys import Key, literal
from loaded_tca.scene.parse import FAMILIES, VARIANTS
from loaded_tca.scene.section import Section, Subsection, entries, refused_keys
from loaded_tca.scene.variants import MODULES
from loaded_tca.scene.written import MODULE, PITCH, INCH_mm
from loaded_tca.units import INCHES, UNITS, conversion

SAME_AS = {"wheel": "pinion", "pinion.material": "material", "pinion.cutter.convex": "pinion.cutter.concave"}
"""Sections described once, under another name."""
REQUIRED_DEFAULT = "required"
"""Default of a key that every file gives."""
NOT_GIVEN = "not given"
"""Default of what stands in the place of a key."""


@dataclass(frozen=True)
class KeyRow:
    """A key of a section in words.

    Attributes
    ----------
    name : str
    allowed : str
        What it may hold, to be read after the word "allowed".
    default : str
        As a file would give it, or in words what holds where it is not given.
    is_value : bool
        Whether a file could give the default so.
    about : str
        What it is.
    """

    name: str
    allowed: str
    default: str
    is_value: bool
    about: str

    @property
    def in_markdown(self) -> str:
        """The row of a table."""
        words = "**required**" if self.default == REQUIRED_DEFAULT else self.default
        default = f"`{self.default}`" if self.is_value else words
        return f"| `{self.name}` | {self.allowed} | {default} | {self.about} |"


@dataclass(frozen=True)
class SectionReference:
    """A section of a scene or stage file in words.

    Attributes
    ----------
    path : str
        Names with dots; empty above all sections.
    about : str
        What it is of, with the types of gear pairs that have it where not all do.
    same_as : str
        Path of the section that has the same keys; empty where they are in ``rows``.
    adds : bool
        Whether the rows come beside those of the section of this path that stands before.
    rows : tuple of KeyRow
    sections : tuple of (str, str)
        Paths and subjects of the sections inside, of one without keys.
    """

    path: str
    about: str
    same_as: str = ""
    adds: bool = False
    rows: tuple[KeyRow, ...] = ()
    sections: tuple[tuple[str, str], ...] = ()

    def in_markdown(self) -> Iterator[str]:
        """Lines of its table."""
        yield from ("", f"### `[{self.path}]`: {self.about}" if self.path else f"### {self.about}", "")
        if self.same_as:
            yield f"Keys as in `[{self.same_as}]`."
            return
        if self.adds:
            yield from (f"Keys of `[{self.path}]` as above, and:", "")
        if self.rows:
            yield from ("| key | allowed | default | meaning |", "|---|---|---|---|")
            yield from (row.in_markdown for row in self.rows)
        else:
            yield from (f"- `[{path}]`: {about}" for path, about in self.sections)


def scene_reference() -> list[SectionReference]:
    """Return all sections of scene files: those of each family of gear pairs first, then those that all share."""
    families = list(dict.fromkeys(FAMILIES.values()))
    tables = [dict(_sections(scene, "")) for scene in families]
    shared = {  # sections described under another name, and the top, are the same in every family
        path: keys_of
        for path, keys_of in tables[0].items()
        if all(path in table and (table[path] == keys_of or path in SAME_AS or not path) for table in tables)
    }
    sections = [section_reference("", *shared.pop(""))]
    for scene, table in zip(families, tables, strict=True):
        types = [name for name, known in FAMILIES.items() if known is scene]
        kinds = ", ".join(f"`{name}`" for name in types)
        for path, (section, about) in table.items():
            if path and path not in shared:
                sections.append(section_reference(path, section, f"{about} ({kinds})"))
        for own, when in (VARIANTS[module] for module in MODULES[types[0]][1]):
            of_families = {section for each in tables for section, _ in each.values()}
            for path, (section, about) in _sections(own, "", {}):
                if path and section not in of_families:
                    of_family = table.get(path, (None, ""))[0]
                    sections.append(section_reference(path, section, f"{about} ({when})", {}, of_family))
    return [*sections, *(section_reference(path, *keys_of) for path, keys_of in shared.items())]


def describe_keys() -> str:
    """Return the reference of a scene file in Markdown: one table per section, one row per key.

    The sections of each family of gear pairs come first, then those that all families share.

    Examples
    --------
    >>> print(describe_keys().splitlines()[4])
    | `title` | one line of text of up to 200 characters | `""` | stands over reports and plots |
    """
    lines = [line for section in scene_reference() for line in section.in_markdown()]
    return "\n".join([*lines, *_inch_lines()]).strip() + "\n"


def _sections(
    section: type[Section], path: str, same_as: Mapping[str, str] = SAME_AS
) -> Iterator[tuple[str, tuple[type[Section], str]]]:
    """Path of every section -> what it is and what it is about, the whole scene first."""
    if not path:
        yield "", (section, "Above all sections")
    for name, (_, entry) in entries(section).items():
        if isinstance(entry, Subsection):
            inner = f"{path}.{name}" if path else name
            yield inner, (entry.section, entry.about)
            if inner not in same_as:
                yield from _sections(entry.section, inner, same_as)


def section_reference(
    path: str,
    section: type[Section],
    about: str,
    same_as: Mapping[str, str] = SAME_AS,
    of_family: type[Section] | None = None,
) -> SectionReference:
    """Return what a section has; of a variant whose section is that of its ``of_family`` with other keys: these."""
    if path in same_as:
        return SectionReference(path, about, same_as[path])
    adds = of_family is not None and issubclass(section, of_family)
    known: dict[str, Any] = {}
    if of_family is not None and adds:
        known = {name: entry for name, (_, entry) in entries(of_family).items()}
    refused = refused_keys(section)
    others = {
        name: entry for name, (_, entry) in entries(section).items() if entry != known.get(name) and name not in refused
    }
    rows = [_row(name, entry) for name, entry in others.items() if isinstance(entry, Key)]
    if of_family is None or section.equivalents != of_family.equivalents:
        rows += [
            KeyRow(name, f"what makes a `{each.key}`", NOT_GIVEN, False, f"{each.about}; instead of `{each.key}`")
            for name, each in section.equivalents.items()
        ]
    inside = ((f"{path}.{name}", entry.about) for name, entry in others.items())
    return SectionReference(path, about, "", adds, tuple(rows), () if rows else tuple(inside))


def _row(name: str, entry: Key) -> KeyRow:
    is_value = not entry.required and entry.default is not None
    default = literal(entry.default) if is_value else REQUIRED_DEFAULT if entry.required else entry.absent
    return KeyRow(name, entry.kind.allowed, default, is_value, entry.about)


def _inch_lines() -> Iterator[str]:
    """Lines of the table of endings that keys have on drawings in inches, in Markdown."""
    yield from ("", "### Keys on drawings in inches", "", "| ending | instead of | is |", "|---|---|---|")
    for ending, (unit, metric) in INCHES.items():
        of = [f"{conversion(unit, UNITS[each].text):.10g} {UNITS[each].text}" for each in metric]
        yield f"| `_{ending}` | {', '.join(f'`_{each}`' for each in metric)} | {' or '.join(of)} |"
    yield f"| `_{PITCH}` | `_{MODULE}` | {plain(float(INCH_mm), 6)} mm over it |"
