"""The reference of all keys, from the same table that checks them."""

from __future__ import annotations

from collections.abc import Iterator

from loaded_tca.scene.keys import Key
from loaded_tca.scene.model import Scene
from loaded_tca.scene.section import Section, Subsection, entries
from loaded_tca.scene.text import literal

SAME_AS = {"wheel": "pinion", "pinion.material": "material"}
"""Sections described once, under another name."""


def describe_keys() -> str:
    """Return the reference of a scene file in Markdown: one table per section, one row per key.

    Examples
    --------
    >>> print(describe_keys().splitlines()[4])
    | `title` | one line of text of up to 200 characters | `""` | stands over reports and plots |
    """
    return "\n".join(_section_lines(Scene, "", "Above all sections")).strip() + "\n"


def _section_lines(section: type[Section], path: str, about: str) -> Iterator[str]:
    table = entries(section)
    yield from ("", f"### `[{path}]`: {about}" if path else f"### {about}", "")
    yield from ("| key | allowed | default | meaning |", "|---|---|---|---|")
    for name, (_, entry) in table.items():
        if isinstance(entry, Key):
            yield f"| `{name}` | {entry.kind.allowed} | {_default(entry)} | {entry.about} |"
    for name, (_, entry) in table.items():
        inner = f"{path}.{name}" if path else name
        if isinstance(entry, Subsection) and inner in SAME_AS:
            yield from ("", f"### `[{inner}]`: {entry.about}", "", f"Keys as in `[{SAME_AS[inner]}]`.")
        elif isinstance(entry, Subsection):
            yield from _section_lines(entry.section, inner, entry.about)


def _default(entry: Key) -> str:
    if entry.required:
        return "**required**"
    return entry.absent if entry.default is None else f"`{literal(entry.default)}`"
