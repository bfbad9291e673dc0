"""Arrays within a page: all of them in one block of bytes, packed, as text."""

from __future__ import annotations

import base64
import zlib
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arrays import Array

STEPS = 65534
"""Steps between 0 and the largest value of an array of scaled numbers."""
NOTHING = 65535
"""Scaled number of a place without material or without a value."""
LEVEL = 9
"""Of compression."""


class Block:
    """Arrays of a page end to end, each known by where it begins, its type and its shape.

    Numbers are little-endian, arrays begin at multiples of eight bytes.
    """

    def __init__(self) -> None:
        self._parts: list[bytes] = []
        self._size = 0

    def add(self, array: NDArray[Any], kind: str = "float32") -> dict[str, Any]:
        """Append an array as ``float32``, ``float64``, ``uint16`` or ``uint32``; returns what the page finds it by."""
        content = np.ascontiguousarray(array, dtype=np.dtype(kind).newbyteorder("<")).tobytes()
        place = {"at": self._size, "kind": kind, "shape": [*array.shape]}
        content += bytes(-len(content) % 8)
        self._parts.append(content)
        self._size += len(content)
        return place

    def text(self) -> str:
        """All arrays, compressed (zlib) and in base64."""
        return base64.b64encode(zlib.compress(b"".join(self._parts), LEVEL)).decode("ascii")


def scaled(values: Array) -> tuple[NDArray[np.uint16], float]:
    """Positive values in steps of a 65534th of the largest, rounded, at least one step; ``NOTHING`` where they are NaN.

    Returns
    -------
    array of uint16, float
        Of the shape of the values; the step, 0 where no value is positive.
    """
    step = float(np.nanmax(values, initial=0.0)) / STEPS
    if step == 0.0:
        return np.where(np.isnan(values), NOTHING, 0).astype(np.uint16), 0.0
    steps = np.where(values > 0.0, np.maximum(np.rint(values / step), 1.0), 0.0)
    return np.where(np.isnan(values), float(NOTHING), steps).astype(np.uint16), step


def finite(values: Array) -> list[Any]:
    """Values of an array as lists, None where they are not finite."""
    return [finite(part) for part in values] if values.ndim > 1 else [*_finite(values)]


def _finite(values: Array) -> Iterator[float | None]:
    return (value if known else None for value, known in zip(values.tolist(), np.isfinite(values), strict=True))
