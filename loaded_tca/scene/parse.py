"""Scene files: the only place that reads TOML."""

from __future__ import annotations

import os
import tomllib
from pathlib import Path
from typing import Any

from loaded_tca.errors import InputError
from loaded_tca.scene.model import Scene, scene_from_table

LARGEST_FILE = 65536
"""Bytes of a scene file; a full one has about 4000."""

MOST_DOTS = 2000
"""Dots in one line: reading a key of tens of thousands of dotted parts takes minutes."""


def read_scene(path: str | os.PathLike[str]) -> Scene:
    """Read a scene file.

    Parameters
    ----------
    path : str or path
        A TOML file in UTF-8.

    Returns
    -------
    Scene

    Raises
    ------
    InputError
        If the file cannot be read, or with every problem that it holds, one per line.
    """
    name = os.fspath(path)
    try:
        with Path(path).open("rb") as file:
            content = file.read(LARGEST_FILE + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(f"{name}: cannot be read: {reason}") from None
    try:
        return parse_scene(content.decode("utf-8-sig"), source=name)
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(f"{name}: not a text file in UTF-8 (line {line})") from None


def parse_scene(text: str, source: str = "scene") -> Scene:
    r"""Make a scene of the text of a scene file.

    Parameters
    ----------
    text : str
        TOML.
    source : str
        What messages call the text, for instance the name of the file.

    Raises
    ------
    InputError
        If the text is not TOML, or with every problem that it holds, one per line.

    Examples
    --------
    >>> parse_scene("[pair]\nmodul = 3")  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    loaded_tca.errors.InputError: pair.type: missing; allowed "cylindrical" or "straight_bevel" or "spiral_bevel"
    pair.modul: unknown key; did you mean "pair.normal_module_mm"?
    ...
    """
    return scene_from_table(_table(text, source))


def _table(text: str, source: str) -> dict[str, Any]:
    if len(text) > LARGEST_FILE:
        raise InputError(f"{source}: too long for a scene; allowed up to {LARGEST_FILE} characters")
    for number, line in enumerate(text.split("\n"), 1):
        if line.count(".") > MOST_DOTS:
            raise InputError(f"{source}: line {number} holds more than {MOST_DOTS} dots")
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise InputError(f"{source}: not a scene: nested too deeply") from None
    except ValueError as error:  # TOMLDecodeError is one; so is a whole number of too many digits
        raise InputError(f"{source}: not a TOML file: {error}") from None
