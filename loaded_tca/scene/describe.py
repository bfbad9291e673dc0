"""The reference of all keys, from the same table that checks them."""

from __future__ import annotations

from collections.abc import Iterator

from loaded_tca.scene.keys import Key
from loaded_tca.scene.model import FAMILIES
from loaded_tca.scene.section import Section, Subsection, entries
from loaded_tca.scene.text import literal

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
        path: found
        for path, found in tables[0].items()
        if all(path in table and (table[path] == found or path in SAME_AS or not path) for table in tables)
    }
    lines = list(_section_lines("", *shared.pop("")))
    for scene, table in zip(families, tables, strict=True):
        kinds = ", ".join(f"`{name}`" for name, known in FAMILIES.items() if known is scene)
        for path, (section, about) in table.items():
            if path and path not in shared:
                lines += _section_lines(path, section, f"{about} ({kinds})")
    for path, found in shared.items():
        lines += _section_lines(path, *found)
    return "\n".join(lines).strip() + "\n"


Found = tuple[type[Section], str]
"""A section and what it is about."""


def _sections(section: type[Section], path: str) -> Iterator[tuple[str, Found]]:
    """Path of every section -> what it is, the whole scene first."""
    if not path:
        yield "", (section, "Above all sections")
    for name, (_, entry) in entries(section).items():
        if isinstance(entry, Subsection):
            inner = f"{path}.{name}" if path else name
            yield inner, (entry.section, entry.about)
            if inner not in SAME_AS:
                yield from _sections(entry.section, inner)


def _section_lines(path: str, section: type[Section], about: str) -> Iterator[str]:
    yield from ("", f"### `[{path}]`: {about}" if path else f"### {about}", "")
    if path in SAME_AS:
        yield f"Keys as in `[{SAME_AS[path]}]`."
        return
    yield from ("| key | allowed | default | meaning |", "|---|---|---|---|")
    for name, (_, entry) in entries(section).items():
        if isinstance(entry, Key):
            yield f"| `{name}` | {entry.kind.allowed} | {_default(entry)} | {entry.about} |"


def _default(entry: Key) -> str:
    if entry.required:
        return "**required**"
    return entry.absent if entry.default is None else f"`{literal(entry.default)}`"
