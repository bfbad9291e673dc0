"""The command 'keys': keys of scene and stage files with unit, default, what is allowed and what they mean."""

from __future__ import annotations

import argparse
import difflib
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass, replace

from loaded_tca.cli.terminal import INDENT, width_of_lines
from loaded_tca.errors import InputError
from loaded_tca.scene.key_reference import (
    NOT_GIVEN,
    REQUIRED_DEFAULT,
    SAME_AS,
    KeyRow,
    SectionReference,
    scene_reference,
)
from loaded_tca.scene.spellings import key_meant_by
from loaded_tca.stages.files import stage_reference
from loaded_tca.units import unit_of

NEAR = 3
"""Keys that are proposed for a word that none has."""


@dataclass(frozen=True)
class _Section:
    """A section with the keys of it that are shown.

    Attributes
    ----------
    reference : SectionReference
    file : {"scene", "stage"}
        Kind of file that has it.
    also : tuple of str
        Paths of sections with the same keys.
    """

    reference: SectionReference
    file: str
    also: tuple[str, ...]

    def paths(self, row: KeyRow) -> list[str]:
        """Names of a key with dots, of all sections that have it."""
        return [f"{path}.{row.name}" if path else row.name for path in (self.reference.path, *self.also)]

    def with_word(self, word: str) -> _Section:
        """The section with those keys alone that a word concerns: in its name, its meaning, or as others spell it."""
        rows = [row for row in self.reference.rows if self._has(row, word.lower())]
        return replace(self, reference=replace(self.reference, rows=tuple(rows)))

    def _has(self, row: KeyRow, word: str) -> bool:
        texts = (*self.paths(row), row.about)
        return any(word in text.lower() for text in texts) or key_meant_by(word, [row.name]) is not None


def keys(options: argparse.Namespace) -> None:
    """Show the keys of scene and stage files, of a word those that have it."""
    word = options.word
    sections = [section.with_word(word) for section in _sections()] if word else _sections()
    shown = [section for section in sections if section.reference.rows]
    if not shown:
        raise InputError(f"{word}: no key has this word in its name or meaning{_near(word)}")
    print("\n\n".join("\n".join(_lines(section, width_of_lines())) for section in shown))


def _sections() -> list[_Section]:
    """All sections of scene and of stage files that have keys of their own."""
    others: dict[str, list[str]] = {}
    for path, same in SAME_AS.items():
        others.setdefault(same, []).append(path)
    scenes = scene_reference()
    alike = {section.path for section in scenes if section.same_as}
    return [
        *(_Section(section, "scene", tuple(_also(section.path, others, alike))) for section in scenes),
        *(_Section(section, "stage", ()) for section in stage_reference()),
    ]


def _also(path: str, others: dict[str, list[str]], alike: set[str]) -> Iterator[str]:
    """Paths of sections whose keys are those of a path, or of the section that it stands in."""
    for same, paths in others.items():
        if path == same or path.startswith(f"{same}."):
            yield from (other + path.removeprefix(same) for other in paths if other in alike)


def _lines(section: _Section, width: int) -> Iterator[str]:
    """Lines of a section: its header, and each key with what is said of it."""
    reference = section.reference
    header = f"[{reference.path}]" if reference.path else ""
    header += "".join(f", [{path}]" for path in section.also)
    of_stage = " of stage files" if section.file == "stage" else ""
    header = f"{header}{of_stage}: {reference.about}" if header else reference.about
    yield from textwrap.wrap(header.replace("`", ""), width, subsequent_indent=INDENT)
    for row in reference.rows:
        path = section.paths(row)[0]
        unit = f" [{unit}]" if (unit := unit_of(row.name)) else ""
        words = row.default if row.default in (REQUIRED_DEFAULT, NOT_GIVEN) else f"default: {row.default}"
        default = f" = {row.default}" if row.is_value else f", {words}".replace("`", "")
        text = f"{row.allowed}; {row.about}".replace("`", "")
        yield from textwrap.wrap(f"  {path}{unit}{default}", width, subsequent_indent=INDENT, break_long_words=False)
        yield from textwrap.wrap(text, width, initial_indent=INDENT, subsequent_indent=INDENT, break_long_words=False)


def _near(word: str) -> str:
    """End of a message with the keys whose names are nearest to a word."""
    names = dict.fromkeys(row.name for section in _sections() for row in section.reference.rows)
    parts: dict[str, list[str]] = {}
    for name in names:
        for part in (name, *name.split("_")):
            parts.setdefault(part.lower(), []).append(name)
    near = difflib.get_close_matches(word.lower()[:60], parts, n=NEAR)
    keys_near = list(dict.fromkeys(name for part in near for name in parts[part]))[:NEAR]
    return f"; near are {', '.join(keys_near)}" if keys_near else ""
