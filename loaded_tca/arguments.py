"""Arguments of public functions, checked and converted before the functions run, by their annotations.

Whatever annotation a public parameter has decides what it takes: arrays, pairs and rows of numbers, numbers, text and
paths. Units are those of the parameter's docstring. What a number may be, its range, is for the function to say.
"""

from __future__ import annotations

import functools
import inspect
import os
import re
import sys
import warnings
from collections.abc import Callable, Sequence
from numbers import Integral, Real
from types import FunctionType
from typing import Any, Never, TypeVar, cast

import numpy as np

from loaded_tca.arrays import FLOAT, OtherKindError, has_masked_cells, has_unit, numbers, shown
from loaded_tca.errors import InputError, LoadedTCAError
from loaded_tca.plain import plain

Checked = TypeVar("Checked", bound=Callable[..., Any])
Unit = Callable[[], str | None]
"""Unit of a parameter, looked up where a value has one or a message needs it."""


def checked(target: Checked) -> Checked:
    """A function, or the constructor and the methods of a class, whose arguments are checked before it runs.

    Parameters
    ----------
    target : function or class
        Its annotations are text (``from __future__ import annotations``). Parameters annotated by ``KINDS``, with or
        without None, are checked; arrays that a constructor or an ``ArrayLike`` takes are copied.

    Raises
    ------
    InputError
        When it is called, with every argument that is none of its kind.

    Examples
    --------
    >>> @checked
    ... def doubled(length: float) -> float:
    ...     return 2.0 * length
    >>> doubled("1 mm")
    Traceback (most recent call last):
    ...
    loaded_tca.errors.InputError: length: a number is asked for, not '1 mm'
    """
    if not inspect.isclass(target):
        return cast(Checked, _with_checks(cast(FunctionType, target), target))
    for name, member in list(vars(target).items()):
        function = getattr(member, "__func__", member)
        if not inspect.isfunction(function) or getattr(function, "__isabstractmethod__", False):
            continue
        if name == "__init__" or not name.startswith("_"):
            with_checks = _with_checks(function, target if name == "__init__" else function)
            if with_checks is not function:
                setattr(target, name, with_checks if function is member else type(member)(with_checks))
    return target


def kind_of(annotation: object) -> str | None:
    """The entry of ``KINDS`` of an annotation; None if it has none."""
    text = str(annotation).removesuffix(" | None")
    return text if text in KINDS else None


def units_of(documented: object) -> dict[str, str]:
    """Units that a numpydoc docstring gives its parameters in brackets, nothing for pure numbers.

    Examples
    --------
    >>> from loaded_tca.contact import solve_contact
    >>> units = units_of(solve_contact)
    >>> units["gap"], units["contact_modulus"], units["tolerance"]
    ('mm', 'MPa', '')
    """
    lines = inspect.cleandoc(getattr(documented, "__doc__", None) or "").partition("Parameters\n----------\n")[2]
    units = {}
    for names, unit in PARAMETER.findall(lines):
        units.update(dict.fromkeys(names.split(", "), unit))
    return units


PARAMETER = re.compile(r"^(\w+(?:, \w+)*) : .*?(?:\[([^\]\n]*)\])?$", re.MULTILINE)


def _with_checks(function: FunctionType, documented: object) -> FunctionType:
    """The function that checks what it has a kind for; the function itself if it has none."""
    annotations, code = function.__annotations__, function.__code__  # inspect takes ten times as long
    places = code.co_varnames[: code.co_argcount]
    of_names = {
        name: kind_of(annotations.get(name)) for name in code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
    }
    checks = {name: KINDS[kind] for name, kind in of_names.items() if kind}
    if not checks:
        return function
    optional = {name for name in checks if str(annotations[name]).endswith(" | None")}
    take = _taking(documented, places, checks, optional)
    quick = [
        (places.index(name) if name in places else sys.maxsize, name, FLOATS.get(kind, ()), AS_THEY_ARE.get(kind))
        for name, kind in checks.items()
    ]

    @functools.wraps(function)
    def call_checked(*arguments: Any, **options: Any) -> Any:
        count = len(arguments)
        for place, name, floats, stays in quick:  # nearly all calls pass, most without a call for each argument
            if place < count:
                value = arguments[place]
            elif name in options:
                value = options[name]
            else:
                continue
            kind = type(value)
            if kind in floats and (kind is not np.ndarray or value.dtype is FLOAT):
                continue
            if not (stays and stays(value)) and not (value is None and name in optional):
                break
        else:
            return function(*arguments, **options)
        values = list(arguments)
        if misfits := take(values, options):
            _refuse(function, values, options, misfits)
        return function(*values, **options)

    return cast(FunctionType, call_checked)


def _taking(
    documented: object, names: Sequence[str], checks: dict[str, Kind], optional: set[str]
) -> Callable[[list[Any], dict[str, Any]], Problems]:
    """Function that puts what arguments become in their places, and returns the problems of those of other kinds."""
    places = tuple((place, name) for place, name in enumerate(names) if name in checks)
    units = functools.cache(lambda: units_of(documented))

    def take(values: list[Any], options: dict[str, Any]) -> Problems:
        problems, misfits = Problems(), Problems()
        places_given: list[tuple[Any, Any, str]] = [
            (values, place, name) for place, name in places if place < len(values)
        ]
        for where, key, name in (*places_given, *((options, name, name) for name in checks if name in options)):
            if where[key] is not None or name not in optional:
                where[key] = _taken(checks[name], name, where[key], units, problems, misfits)
        if problems:
            raise InputError(problems)
        return misfits

    return take


def _refuse(function: FunctionType, values: list[Any], options: dict[str, Any], misfits: Problems) -> Never:
    """Raise InputError: what the function says, which knows what is allowed and what else is wrong, or the misfits."""
    with warnings.catch_warnings(action="ignore"):
        try:
            function(*values, **options)
        except LoadedTCAError:
            raise
        except Exception:  # numbers were asked for: what text comes to is no matter
            raise InputError(misfits) from None
    raise InputError(misfits)


Problems = list[str]


def _taken(
    kind: Kind, name: str, value: Any, units: Callable[[], dict[str, str]], problems: Problems, misfits: Problems
) -> Any:
    """The value as a function takes it; as it is, if it is of another kind, and the problem among the others."""
    try:
        return kind(name, value, lambda: units().get(name))
    except OtherKindError as error:
        misfits += error.problems
    except InputError as error:
        problems += error.problems
    return value


def _array(name: str, value: Any, unit: Unit) -> Any:
    """An array, or a number that behaves as one."""
    return value if type(value) in FLOATS[_number] else numbers(name, value, unit())


LARGEST_INT = 2**63
"""Whole numbers up to here are told at once to be numbers."""


def _is_whole_number(value: Any) -> bool:
    return type(value) is int and abs(value) <= LARGEST_INT


def _is_pair_of_floats(value: Any) -> bool:
    return type(value) is tuple and len(value) == 2 and type(value[0]) is float and type(value[1]) is float


def _number(name: str, value: Any, unit: Unit) -> Any:
    """A number as it is; one with a unit, or in an array, as a float."""
    if isinstance(value, Real) and not isinstance(value, bool):
        if isinstance(value, int) and abs(value) > sys.float_info.max:
            raise InputError(f"{name}: a whole number beyond {plain(sys.float_info.max, 3)}")
        return value
    if has_unit(value) or has_masked_cells(value):
        value = numbers(name, value, unit())
    if getattr(value, "ndim", None) == 0:
        return _number(name, value.item(), unit)
    raise OtherKindError(f"{name}: a number{_in(unit)} is asked for, not {shown(value)}")


def _row(name: str, value: Any, unit: Unit, length: int | None = None) -> Any:
    """A row of numbers as it is, or those of an array as a tuple of floats."""
    floats = isinstance(value, list | tuple) and all(type(part) in (float, int) for part in value)
    try:
        row = np.asarray(value, dtype=float) if floats else numbers(name, value, unit())
    except InputError as error:
        raise OtherKindError(error.problems) from None
    if row.ndim != 1 or length not in (None, len(row)):
        wanted = "a row of" if length is None else f"a row of {length}"
        raise OtherKindError(f"{name}: {wanted} numbers{_in(unit)} is asked for, not {shown(value)}")
    return value if floats else tuple(row.tolist())


def _pair(name: str, value: Any, unit: Unit) -> Any:
    return _row(name, value, unit, 2)


def _whole_pair(name: str, value: Any, unit: Unit) -> Any:  # noqa: ARG001 (all kinds are called alike)
    """Two whole numbers as they are, or those of an array."""
    pair = value.tolist() if isinstance(value, np.ndarray) else value
    whole = isinstance(pair, list | tuple) and all(isinstance(k, Integral) and not isinstance(k, bool) for k in pair)
    if not whole or len(pair) != 2:
        raise OtherKindError(f"{name}: a row of 2 whole numbers is asked for, not {shown(value)}")
    return pair


def _text(name: str, value: Any, unit: Unit) -> str:  # noqa: ARG001 (all kinds are called alike)
    if not isinstance(value, str):
        raise OtherKindError(f"{name}: text is asked for, not {shown(value)}")
    return value


def _path(name: str, value: Any, unit: Unit) -> Any:  # noqa: ARG001
    if not isinstance(value, str | os.PathLike):
        raise InputError(f"{name}: the name of a file or directory is asked for, not {shown(value)}")
    return value


def _instance(title: str) -> Kind:
    """The kind of all objects of a class, whose module need not be loaded for that."""

    def instance(name: str, value: Any, unit: Unit) -> Any:  # noqa: ARG001
        if title not in (base.__name__ for base in type(value).__mro__):
            raise OtherKindError(f"{name}: a {title} is asked for, not {shown(value)}")
        return value

    return instance


CLASSES = ("ContactPoint", "ContactProblem", "ContactSolution", "GearPair", "Material", "Scene")


def _in(unit: Unit) -> str:
    return f" in {unit()}" if unit() else ""


Kind = Callable[[str, Any, Unit], Any]
KINDS: dict[str, Kind] = {
    "ArrayLike": _array,
    "Array": _array,
    "NDArray[np.float64]": _array,
    "float": _number,
    "int": _number,
    "tuple[float, float]": _pair,
    "tuple[int, int]": _whole_pair,
    "Cells": _whole_pair,
    "Spacing": _pair,
    "Both": _pair,
    "Sequence[float]": _row,
    "str": _text,
    "FilePath": _path,
    "str | os.PathLike[str]": _path,
    "str | PathLike[str]": _path,
    **{title: _instance(title) for title in CLASSES},
}
"""Annotation of a parameter, less None -> what its argument becomes, with InputError if it is of no such kind."""
FLOATS: dict[Kind, tuple[type, ...]] = {_array: (float, np.float64, np.ndarray), _number: (float, np.float64)}
"""Kind -> types of values that stay as they are, arrays if they hold floats."""
AS_THEY_ARE: dict[Kind, Callable[[Any], bool]] = {_number: _is_whole_number, _pair: _is_pair_of_floats}
"""Kind -> whether another value is told at once to stay as it is; without an entry only the kind itself tells."""
