"""Arrays of numbers: the types that annotations use, and arguments checked to be arrays."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields
from numbers import Real
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from loaded_tca.errors import InputError
from loaded_tca.plain import plain
from loaded_tca.units import conversion

Array = NDArray[np.float64]
"""Of Any, every overload of NumPy's operators would match: mypy takes more than twice as long for a line of them."""
Indices = NDArray[np.int_]
Mask = NDArray[np.bool_]
FLOAT = np.dtype(float)
GearName = Literal["pinion", "wheel"]
GEARS: tuple[GearName, GearName] = ("pinion", "wheel")
"""The gears of a pair in the order in which arrays and pairs of values have them."""


def numbers(name: str, values: Any, unit: str | None = None) -> Array:
    """An argument as an array of floats, without a copy where it is one.

    Parameters
    ----------
    name : str
        Of the argument, in messages.
    values : array_like
        Numbers; a masked array in which nothing is masked; numbers with a unit, as astropy (``unit``), pint
        (``units``) and xarray (``attrs["units"]``) write it.
    unit : str, optional
        In which they are asked for, nothing for pure numbers; where it is not known, a unit is refused.

    Raises
    ------
    InputError
        If they are no numbers, if some are masked, or if their unit is none that can be converted.

    Examples
    --------
    >>> numbers("gap", [1, 2.5])
    array([1. , 2.5])
    """
    if type(values) is np.ndarray and values.dtype is FLOAT:
        return values
    try:
        return _plain(name, values, unit)
    except InputError:
        raise
    except (TypeError, ValueError, OverflowError, FloatingPointError):
        raise OtherKindError(f"{name}: an array of finite numbers is asked for, not {shown(values)}") from None


class OtherKindError(InputError):
    """A value of another kind than asked for, as text for a number."""


def _plain(name: str, values: Any, unit: str | None) -> Array:
    """Numbers as an array of floats, in the unit asked for; TypeError or ValueError if they are none."""
    if isinstance(values, bool):
        raise TypeError
    if isinstance(values, list | tuple):
        return _floats(np.asarray([part if isinstance(part, PLAIN) else _plain(name, part, unit) for part in values]))
    written, bare = _without_unit(values)
    if has_masked_cells(values):
        way_out = "fill what is masked (a gap: with inf, where there is no material)"
        raise InputError(f"{name}: a masked array; {way_out}")
    array = _floats(np.asarray(bare))
    return array if written is None else array * _factor(name, written, unit)


PLAIN = (bool, int, float, complex, str, bytes, type(None), np.generic)
"""Types of cells that have neither a unit nor a mask."""


def shown(value: object) -> str:
    """A value in a message: on one line, not too long."""
    return " ".join(f"{value!r:.60}".split())


def _floats(array: Any) -> Array:
    """An array of floats; TypeError of text and dates, which would be turned into numbers, and None, into NaN."""
    if array.dtype.kind not in "biuf":
        raise TypeError
    return np.asarray(array, dtype=float)


def has_unit(values: Any) -> bool:
    """Whether a unit is written beside numbers."""
    return _without_unit(values)[0] is not None


def has_masked_cells(values: Any) -> bool:
    """Whether cells of an array are masked."""
    mask = getattr(values, "mask", None)  # of pandas it is a method
    return isinstance(mask, np.ndarray | np.bool_ | bool) and bool(np.any(mask))


def _without_unit(values: Any) -> tuple[str | None, Any]:
    """Unit as it is written beside numbers, None if there is none, and the numbers alone."""
    attributes, inner = getattr(values, "attrs", None), getattr(values, "data", None)
    if isinstance(attributes, Mapping):  # xarray, whose numbers may have a unit of their own, and pandas
        written, bare = (None, values) if inner is None else _without_unit(inner)
        written = written or next((str(attributes[key]) for key in ("units", "unit") if attributes.get(key)), None)
        return written, bare
    written = getattr(values, "unit", None)
    written = getattr(values, "units", None) if written is None else written
    bare = getattr(values, "magnitude", getattr(values, "unmasked", values))
    return (None if written is None or callable(written) else str(written).strip() or None), bare


def _factor(name: str, written: str, unit: str | None) -> float:
    """Factor from a unit that is written beside numbers to that in which they are asked for."""
    if unit is None:
        raise InputError(f"{name}: in {shown(written)}, but its unit is not known here; give plain numbers")
    factor = conversion(written, unit)
    if factor is None:
        raise InputError(f"{name}: in {shown(written)}; allowed {f'numbers in {unit}' if unit else 'pure numbers'}")
    return factor


def keep_copies(instance: Any) -> None:
    """Give a frozen dataclass that was just made arrays of its own, which the caller cannot change."""
    for field in fields(instance):
        value = getattr(instance, field.name)
        if isinstance(value, np.ndarray):
            object.__setattr__(instance, field.name, value.copy())


def real(value: Any) -> Any:
    """One real number, or NaN in place of anything else, which lies in no range."""
    if type(value) is float:
        return value
    if getattr(value, "ndim", None) == 0:
        value = math.nan if has_masked_cells(value) or has_unit(value) else value.item()
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


def interval_check(name: str, values: Any, interval: str, unit: str = "") -> tuple[bool, str]:
    """Check for ``require`` that all numbers lie in an interval as [0, inf); its problem names the first that does not.

    Examples
    --------
    >>> interval_check("speed", [1.0, -2.0], "[0, inf)", "m/s")
    (False, 'speed: -2 m/s is not in [0, inf)')
    """
    low, high = map(float, interval[1:-1].split(","))
    array = np.asarray(values, dtype=float)
    inside = array > low if interval[0] == "(" else array >= low
    inside &= array < high if interval[-1] == ")" else array <= high
    if bool(inside.all()):
        return True, ""
    return False, f"{name}: {plain(array[~inside][0], 6)}{' ' * bool(unit)}{unit} is not in {interval}"


def finite_row(name: str, values: ArrayLike) -> Array:
    """An argument as a new row (n,) of finite numbers, at least one; InputError if it is none."""
    row = numbers(name, values)
    if row.ndim != 1 or not row.size or not np.isfinite(row).all():
        raise InputError(f"{name}: found shape {row.shape}; allowed finite numbers in one dimension")
    return row.copy()
