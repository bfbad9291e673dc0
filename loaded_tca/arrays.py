"""Arrays of numbers: the types that annotations use, and arguments checked to be arrays."""

from __future__ import annotations

import math
from collections.abc import Mapping
from numbers import Real
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from loaded_tca.errors import InputError

Array = NDArray[Any]
Indices = NDArray[np.int_]
Mask = NDArray[np.bool_]
GearName = Literal["pinion", "wheel"]
GEARS: tuple[GearName, GearName] = ("pinion", "wheel")
"""The gears of a pair in the order in which arrays and pairs of values have them."""


def numbers(name: str, values: ArrayLike) -> Array:
    """An argument as an array of floats; InputError if it is none, or a masked one."""
    if isinstance(values, np.ma.MaskedArray):
        raise InputError(f"{name}: a masked array; fill what is masked (a gap: with inf, where there is no material)")
    try:
        array = np.asarray(values)
        if array.dtype.kind not in "biuf":  # text and dates would be turned into numbers, None into NaN
            raise TypeError
        return np.asarray(array, dtype=float)
    except (TypeError, ValueError):
        shown = " ".join(f"{values!r:.60}".split())
        raise InputError(f"{name}: an array of finite numbers is asked for, not {shown}") from None


def real(value: Any) -> Any:
    """One real number, or NaN in place of anything else, which lies in no range."""
    if getattr(value, "ndim", None) == 0 and not isinstance(value, np.ma.MaskedArray):
        value = value.item()
    return value if isinstance(value, Real) and not isinstance(value, bool) else math.nan


def count_problems(counts: Mapping[Any, object], least: int) -> list[str]:
    """A problem for each count, by name, that is not a whole number from ``least`` on."""
    return [
        f"{name}: {count!r} is not a whole number from {least} on"
        for name, count in counts.items()
        if not (isinstance(count, int | np.integer) and count >= least)
    ]


def index_checks(**indices: tuple[object, int]) -> list[tuple[bool, str]]:
    """Checks for ``require`` of indices, by name each with its count: None, or a whole number from 0 to count - 1."""
    return place_checks(**{name: (index, count) for name, (index, count) in indices.items() if index is not None})


def place_checks(**indices: tuple[object, int]) -> list[tuple[bool, str]]:
    """The same of indices that have to be given."""
    return [
        (
            isinstance(index, int | np.integer) and not isinstance(index, bool) and bool(0 <= index < count),
            f"{name}: {index!r:.60} is no index from 0 to {count - 1}",
        )
        for name, (index, count) in indices.items()
    ]


def finite_row(name: str, values: ArrayLike) -> Array:
    """An argument as a row (n,) of finite numbers, at least one; InputError if it is none."""
    row = numbers(name, values)
    if row.ndim != 1 or not row.size or not np.isfinite(row).all():
        raise InputError(f"{name}: found shape {row.shape}; allowed finite numbers in one dimension")
    return row
