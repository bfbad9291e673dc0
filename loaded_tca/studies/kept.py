"""Whole results that a study keeps beside its rows, in files by the numbers of its variants.

Numbers change when a study gets more samples or values: a kept result stays with what its variant changes.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Collection, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

from loaded_tca.errors import InputError, reason_of
from loaded_tca.input_files import is_place
from loaded_tca.results.files import make_directory, read_dataset, replace_file
from loaded_tca.scene import parse_scene
from loaded_tca.studies.stage import nominal_of
from loaded_tca.studies.study import Study

OTHERS = "others"
"""Folder, within that of kept results, of those that are of no variant of the study."""


def kept_file(folder: Path, variant: int) -> Path:
    """File of the whole result of a variant."""
    return folder / f"{variant}.nc"


def keep(folder: Path, variants: Collection[int], content: bytes | None) -> None:
    """Write the whole result of variants that change the same, if it is kept."""
    if content is None:
        return
    make_directory(folder)
    for variant in variants:
        replace_file(kept_file(folder, variant), content)


def renumber(folder: Path, study: Study) -> str:
    """Move kept results to the numbers that their variants have in a study, those of no variant into ``OTHERS``.

    Results in ``OTHERS`` that are of a variant again come back.

    Returns
    -------
    str
        How many were moved into ``OTHERS`` and stay there, as a sentence; nothing if none.
    """
    numbered = [path for path in sorted(folder.glob("*.nc")) if is_place(path.stem)]
    moved = [_moved_aside(path, text) for path in numbered if (text := _scene_of(path)) != _text(study, int(path.stem))]
    aside = folder / OTHERS
    waiting: dict[str, list[tuple[str, Path]]] = {}
    for path in sorted(aside.glob("*.nc")):
        if text := _scene_of(path):
            waiting.setdefault(_values_of(study, text), []).append((text, path))
    for variant in range(len(study)) if waiting else ():
        for text, path in _of(waiting, study, variant):
            if not kept_file(folder, variant).exists() and text == _text(study, variant):
                _move(path, kept_file(folder, variant))
                waiting[_values_of(study, text)].remove((text, path))
    with suppress(OSError):  # of a folder that is not empty, or not there
        aside.rmdir()
    left = sum(path.exists() for path in moved)
    return (
        f"{left} kept result{'s are' if left > 1 else ' is'} of no variant of the study: moved to {aside}; "
        "a study with such variants gives them their numbers again"
        if left
        else ""
    )


def _of(waiting: dict[str, list[tuple[str, Path]]], study: Study, variant: int) -> Iterator[tuple[str, Path]]:
    """Results with the values that a variant changes: scene and file of each."""
    changes = study.changes(variant)
    yield from [*waiting.get(_as_text([changes[key] for key in study.keys]), ())]


def _values_of(study: Study, text: str) -> str:
    """Values of the keys that a study varies, in the scene of a kept result; nothing if that is no scene."""
    try:
        scene = parse_scene(text, source="scene_toml", folder=None)
    except InputError:  # of another version
        return ""
    return _as_text([nominal_of(scene, key) for key in study.keys])


def _as_text(values: Any) -> str:
    return json.dumps(values, default=str)


def _scene_of(path: Path) -> str:
    """Scene of a kept result; nothing if the file is damaged or has none."""
    try:
        return str(read_dataset(path).attrs.get("scene_toml", ""))
    except InputError:
        return ""


def _text(study: Study, variant: int) -> str | None:
    """Scene of a variant as a file has it; None if there is no such variant or scene."""
    try:
        return study.scene.with_changes(study.changes(variant)).to_toml()
    except InputError:
        return None


def _moved_aside(path: Path, text: str) -> Path:
    """Move a result to a name in ``OTHERS`` that its scene and its number make."""
    aside = path.parent / OTHERS
    make_directory(aside)
    return _move(path, aside / f"{hashlib.sha256(text.encode()).hexdigest()[:16]}_{path.name}")


def _move(path: Path, new: Path) -> Path:
    try:
        os.replace(path, new)
    except OSError as error:
        raise InputError(f"{path}: cannot be moved to {new}: {reason_of(error)}") from error
    return new
