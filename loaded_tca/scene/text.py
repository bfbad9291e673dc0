"""Values as TOML writes them: for messages (short) and for scene files (exact)."""

from __future__ import annotations

import json
import re
from typing import Any

LONGEST_SHOWN = 60
"""Characters of a value that a message repeats."""


def literal(value: Any) -> str:
    r"""Return a value as TOML, exact to the last digit of a float.

    Examples
    --------
    >>> literal((20.0, 130.0)), literal(True), literal('5 "µm"')
    ('[20.0, 130.0]', 'true', '"5 \\"µm\\""')
    >>> print(literal(((1.0, 2.0), (3.0, 4.0))))
    [
        [1.0, 2.0],
        [3.0, 4.0],
    ]
    """
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, list | tuple) and value and isinstance(value[0], list | tuple):
        return "[\n" + "".join(f"    {literal(line)},\n" for line in value) + "]"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(literal(entry) for entry in value) + "]"
    return repr(value)


def shown(value: Any) -> str:
    """Return any value that a file may hold, short enough for one line of a message."""
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, list | tuple):
        first = ["a list" if isinstance(entry, list | tuple) else shown(entry) for entry in value[:4]]
        return "[" + ", ".join(first + ["..."] * (len(value) > 4)) + "]"
    if isinstance(value, int) and value.bit_length() > 100:
        return f"a whole number of {value.bit_length()} bits"
    if isinstance(value, bool | str):
        return _shortened(literal(value))
    return _shortened(str(value))


def shown_key(name: str) -> str:
    """Return a key of a file as it may be written, quoted where it must be."""
    return _shortened(name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else literal(name))


def _shortened(text: str) -> str:
    cut = text if len(text) <= LONGEST_SHOWN else text[: LONGEST_SHOWN - 3] + "..."
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in cut)
