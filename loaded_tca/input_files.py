"""Files that are read: regular files of a bounded size, so that reading ends."""

from __future__ import annotations

import os

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


def read_bytes(path: str | os.PathLike[str], largest: float, kind: str) -> bytes:
    """Content of a regular file of no more than so many bytes; of another one nothing is read.

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
        If the file cannot be read, is no regular one, or is longer.
    """
    name = os.fspath(path)
    require_regular(path)
    try:
        with open(path, "rb") as file:
            size = os.fstat(file.fileno()).st_size
            content = file.read(size) if size <= largest else b""
    except (OSError, ValueError) as error:
        raise InputError(f"{name}: cannot be read: {reason_of(error)}") from None
    require((size <= largest, f"{name}: more than {largest:z.0f} bytes; no {kind} is so long"))
    return content


def read_text(path: str | os.PathLike[str], largest: int, kind: str = "scene and no flank") -> str:
    """Text of a file in UTF-8 of no more than so many bytes.

    Raises
    ------
    InputError
        If the file cannot be read, is no regular one, is longer, or is no such text.
    """
    content = read_bytes(path, largest, kind)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(f"{os.fspath(path)}: not a text file in UTF-8 (line {line})") from None
