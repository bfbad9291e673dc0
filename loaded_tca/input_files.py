"""Files that are read: regular files of a bounded size, so that reading ends; tables and numbers in their text."""

from __future__ import annotations

import codecs
import csv
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import BinaryIO, NamedTuple

from loaded_tca.errors import InputError, reason_of, require


def require_regular(path: str | os.PathLike[str], use: str = "read") -> None:
    """Refuse a device, a pipe or anything else that is neither a file nor a directory: it may have no end.

    Parameters
    ----------
    path : str or path
        Links are followed; it need not exist.
    use : str
        What it cannot be, in the message.

    Raises
    ------
    InputError
        If something else is there.
    """
    other = os.path.exists(path) and not (os.path.isfile(path) or os.path.isdir(path))
    require((not other, f"{os.fspath(path)}: cannot be {use}: not a regular file; give the name of a file"))


@contextmanager
def opened(path: str | os.PathLike[str], largest: float, kind: str) -> Iterator[BinaryIO]:
    """Open a regular file of no more than so many bytes for the time of a block; another one is not read.

    Parameters
    ----------
    path : str or path
    largest : float
        Bytes.
    kind : str
        What is never so long, in the message.

    Raises
    ------
    InputError
        If the file cannot be opened or read, is no regular one, or is longer.
    """
    name = os.fspath(path)
    require_regular(path)
    try:
        with open(path, "rb") as file:
            size = os.fstat(file.fileno()).st_size
            require((size <= largest, f"{name}: more than {largest:z.0f} bytes; no {kind} is so long"))
            yield file
    except InputError:
        raise
    except (OSError, ValueError) as error:
        raise InputError(f"{name}: cannot be read: {reason_of(error)}") from None


def read_bytes(path: str | os.PathLike[str], largest: float, kind: str) -> bytes:
    """Content of a regular file of no more than so many bytes, as ``opened`` opens it."""
    with opened(path, largest, kind) as file:
        return file.read(os.fstat(file.fileno()).st_size)


def read_text(path: str | os.PathLike[str], largest: int, kind: str = "scene and no flank") -> str:
    """Text of a file in UTF-8 of no more than so many bytes.

    Raises
    ------
    InputError
        If the file cannot be read, is no regular one, is longer, or is no such text.
    """
    return _decoded(read_bytes(path, largest, kind), os.fspath(path))


def read_table(path: str | os.PathLike[str], largest: int, kind: str) -> str:
    """Text of a file of a table: in UTF-8, or as spreadsheets save one: in UTF-16, or in Windows' western code page.

    Raises
    ------
    InputError
        As ``read_text`` does.
    """
    content = read_bytes(path, largest, kind)
    if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return _decoded(content, os.fspath(path), "UTF-16")
    try:
        return _decoded(content, os.fspath(path))
    except InputError:
        if NOT_IN_TEXT.search(content):
            raise
    return _decoded(content, os.fspath(path), "cp1252")


def _decoded(content: bytes, name: str, encoding: str = "UTF-8") -> str:
    try:
        return content.decode("utf-8-sig" if encoding == "UTF-8" else encoding)
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(f"{name}: not a text file in {encoding} (line {line})") from None


NOT_IN_TEXT = re.compile(rb"[\x00-\x08\x0e-\x1f]")
"""Bytes that no text in a code page has."""
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
WHOLE = re.compile(r"[+-]?\d+", re.ASCII)
MICRO = str.maketrans({"\N{MICRO SIGN}": "u", "\N{GREEK SMALL LETTER MU}": "u"})
DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+([eE][+-]?\d+)?", re.ASCII)
SEPARATOR_LINE = re.compile(r"\s*\"?sep=(.)\"?\s*", re.IGNORECASE)
"""First line of a file of a spreadsheet that says what stands between cells."""
BESIDE_CELLS = '";,\t \N{NO-BREAK SPACE}'
"""Characters that stand around the cells of a table."""
MOST_DIGITS = 1000
"""Of a number in text; Python refuses to read whole numbers of several times as many."""


def number_in(text: str) -> float:
    """Number that a text is: digits 0 to 9, one decimal point, an exponent.

    Raises
    ------
    ValueError
        If it is none; Python would take ``1_0``, digits of other scripts, and words for infinity.

    Examples
    --------
    >>> number_in(" -1.5e3 ")
    -1500.0
    """
    text = text.strip()
    if len(text) > MOST_DIGITS or NUMBER.fullmatch(text) is None:
        raise ValueError(text)
    return float(text)


def is_place(text: str) -> bool:
    """Whether a text is the place of an entry in a list: a whole number from 0 on in digits 0 to 9."""
    return text.isascii() and text.isdigit() and len(text) < 10


def whole_in(text: str) -> int:
    """Whole number that a text is; ValueError if it is none."""
    text = text.strip()
    if len(text) > MOST_DIGITS or WHOLE.fullmatch(text) is None:
        raise ValueError(text)
    return int(text)


class Table(NamedTuple):
    """A table in a text, whose first line names the columns.

    Attributes
    ----------
    comments : tuple of str
        Lines that begin with #, without it.
    number : int
        Of the line with the names, from 1.
    names : tuple of str
        Of the columns, with u for the micro of units.
    rows : tuple of (int, tuple of str)
        Number of each line, and its cells.
    separator : str
        What stands between cells.
    """

    comments: tuple[str, ...]
    number: int
    names: tuple[str, ...]
    rows: tuple[tuple[int, tuple[str, ...]], ...]
    separator: str


def table_in(text: str) -> Table:
    """The table that a text is, as people and spreadsheets write it; without names and rows if it has no line.

    Between cells is what a first line such as ``sep=;`` says; without it semicolons, tabs or commas, the first of them
    that the line of names has, or blanks where it has none of these. Cells may be quoted. Separators at the ends of
    lines, below nothing in the line of names, and lines of separators alone are left out.

    Raises
    ------
    InputError
        If a quotation does not end.
    """
    lines = text.splitlines()
    declared = SEPARATOR_LINE.fullmatch(lines[0]) if lines else None
    numbered = [(number, line) for number, line in enumerate(lines, 1) if line.strip(BESIDE_CELLS)][bool(declared) :]
    comments = [line for _, line in numbered if line.lstrip(BESIDE_CELLS).startswith("#")]
    body = [(number, line) for number, line in numbered if not line.lstrip(BESIDE_CELLS).startswith("#")]
    marks = ";\t" if declared is None else declared[1]
    blanks = bool(body) and not any(mark in body[0][1] for mark in (*marks, ",")) and len(body[0][1].split()) > 1
    separator = " " if blanks else next((mark for mark in marks if body and mark in body[0][1]), ",")
    rows = [(number, line.split() if blanks else _cells(number, line, separator)) for number, line in body]
    names = [name.translate(MICRO) for name in rows[0][1]] if rows else []
    while names and not names[-1]:
        del names[-1]
    for _, cells in rows:
        while len(cells) > len(names) and not cells[-1]:
            del cells[-1]
    return Table(
        tuple(line.strip(BESIDE_CELLS).removeprefix("#") for line in comments),
        rows[0][0] if rows else 0,
        tuple(names),
        tuple((number, tuple(cells)) for number, cells in rows[1:]),
        separator,
    )


def require_decimal_points(table: Table) -> None:
    """Refuse a table of numbers whose decimals stand behind a comma: between commas they would be cells of their own.

    Raises
    ------
    InputError
        With the first such line.
    """
    longer = [number for number, cells in table.rows if table.separator == "," and len(cells) > len(table.names)]
    with_comma = [number for number, cells in table.rows if any(map(DECIMAL_COMMA.fullmatch, cells))]
    lines = with_comma or (longer if 2 * len(longer) > len(table.rows) else [])
    if lines:
        raise InputError(
            f"line {lines[0]}: decimal commas, it seems ({len(lines)} such line{'s' if len(lines) > 1 else ''}); "
            "numbers are written with a decimal point"
        )


def _cells(number: int, line: str, separator: str) -> list[str]:
    """Cells of a line without their quotes and the blanks around them."""
    try:
        (cells,) = csv.reader([line], delimiter=separator, skipinitialspace=True, strict=True)
    except csv.Error:
        raise InputError(f"line {number}: a quotation that does not end, or goes on behind its end") from None
    return [cell.strip() for cell in cells]
