"""Study files: TOML with the words of :class:`loaded_tca.studies.Study`.

The V-H check under load: a study of two mounting errors.
"""

from __future__ import annotations

import csv
import io
import os
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from numbers import Real
from pathlib import Path
from typing import Any

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.errors import InputError, named
from loaded_tca.input_files import read_table, read_text, table_in
from loaded_tca.scene import Scene, read_scene
from loaded_tca.scene.keys import did_you_mean, nearest, shown, shown_key
from loaded_tca.scene.parse import LARGEST_FILE, is_table_of_stage, toml_table
from loaded_tca.scene.section import writing_at
from loaded_tca.scene.written import Writing
from loaded_tca.stages import Stage, read_stage
from loaded_tca.studies.stage import nominal_of
from loaded_tca.studies.study import MOST_VARIANTS, Distribution, Study, is_finite, is_whole

WORDS = ("scene", "stage", "changes", "factors", "distributions", "samples", "seed", "table")
LARGEST_TABLE = 2**27
"""Bytes of a table of variants: a hundred for each of a million."""
SPAN = {"from", "to", "count"}
"""Words of evenly spaced values."""
DISTRIBUTION = "distribution"
"""Word for the name of a distribution; its parameters stand beside it."""
ABOUT, NOMINAL = "about", "nominal"
"""Word for what a distribution lies about, and the one answer: the value that the scene has."""


CLASS = "tolerance_class"
"""Word for a tolerance class of ISO 1328-1, alone: the distribution of a slope of gears that are of it."""


@checked
def read_study(path: str | os.PathLike[str]) -> Study:
    """Read a study file.

    Parameters
    ----------
    path : str or path
        TOML in UTF-8. The files that it names, ``scene`` or ``stage``, and ``table`` (CSV with keys as its header), are
        looked for from its folder.

    Raises
    ------
    InputError
        If a file cannot be read, or with every problem that it holds.
    """
    return parse_study(read_text(path, LARGEST_FILE), source=os.fspath(path), folder=Path(path).parent)


@checked
def parse_study(text: str, source: str = "study", folder: str | os.PathLike[str] = ".") -> Study:
    r"""Make a study of the text of a study file.

    Parameters
    ----------
    text : str
        TOML.
    source : str
        What messages call the text.
    folder : str or path
        Where the files that it names are looked for.

    Raises
    ------
    InputError
        If the text is no TOML, or with every problem that it holds.

    Examples
    --------
    >>> parse_study('[factors]\nmounting.misalignment_um = { from = 0, to = 10 }')
    Traceback (most recent call last):
    ...
    loaded_tca.errors.InputError: scene: missing; allowed the name of a scene file
    factors.mounting.misalignment_um: found a table; allowed a list of values or { from, to, count }
    """
    table = toml_table(text, source)
    if is_table_of_stage(table):
        raise InputError(f'{source}: not a study but a planetary stage; a study names it as stage = "..."')
    if "pair" in table:
        raise InputError(f'{source}: not a study but a scene; a study names it as scene = "..."')
    problems = [
        f"{shown_key(word)}: unknown word{did_you_mean(nearest(word, WORDS)) or '; allowed ' + ', '.join(WORDS)}"
        for word in table
        if word not in WORDS
    ]

    given: dict[str, Any] = {}
    parts: list[tuple[dict[str, Any], str, Callable[..., Any], tuple[Any, ...]]] = [
        (given, "scene", _scene, (table, Path(folder))),
        (given, "table", _table, (table.get("table"), Path(folder))),
    ]
    of_scene = partial(_distribution, given)
    for word, read, words in (("factors", _values, SPAN), ("distributions", of_scene, {DISTRIBUTION, CLASS})):
        section = table.get(word, {})
        if isinstance(section, dict):
            given[word] = {}
            parts += [(given[word], key, read, (f"{word}.{key}", value)) for key, value in _leaves(section, words)]
        else:
            problems.append(f"{word}: found {shown(section)}; allowed a section [{word}]")
    for place, name, read, arguments in parts:
        if name in place:
            problems.append(f"{arguments[0]}: given twice")
        try:
            place[name] = read(*arguments)
        except InputError as error:
            problems += error.problems
    given |= {word: table[word] for word in ("samples", "seed") if word in table}
    if problems:
        raise InputError(problems)
    for word in ("factors", "distributions", "table"):
        with named(word):
            given[word] = _by_keys(given["scene"], given.get(word, {}))
    return Study(**given)


def _by_keys(scene: Scene | Stage, columns: Mapping[str, Any]) -> dict[str, Any]:
    """What varies by the keys of a scene: drawings may write it otherwise; distributions are converted already."""
    by_key: dict[str, Any] = {}
    for path, values in columns.items():
        key, writing = writing_at(scene, path)
        if writing is not None and (key in by_key or key in columns):
            raise InputError(f"{path}: given twice, as {key} too")
        by_key[key] = [*map(writing.converted, values)] if writing and isinstance(values, list) else values
    return by_key


def _scene(table: Mapping[str, Any], folder: Path) -> Scene | Stage:
    word = "stage" if "stage" in table else "scene"
    name, changes = table.get(word), table.get("changes", {})
    if word == "stage" and "scene" in table:
        raise InputError("scene: found beside stage; a study is of one of them")
    if not isinstance(name, str):
        raise InputError(
            f"{word}: {'missing' if name is None else f'found {shown(name)}'}; allowed the name of a {word} file"
        )
    if not isinstance(changes, dict):
        raise InputError(f"changes: found {shown(changes)}; allowed a section [changes]")
    read = read_stage if word == "stage" else read_scene
    return read(folder / name).with_changes(dict(_leaves(changes, set())))


def _leaves(section: Mapping[str, Any], words: set[str], place: str = "") -> Iterator[tuple[str, Any]]:
    """Keys with dots and values of nested tables; one that has any of the words is a value itself."""
    for name, value in section.items():
        if isinstance(value, dict) and value and not words & set(value):
            yield from _leaves(value, words, f"{place}{name}.")
        else:
            yield f"{place}{name}", value


def _values(key: str, value: Any) -> list[Any]:
    if isinstance(value, list):
        return value
    if not isinstance(value, dict) or set(value) != SPAN:
        raise InputError(f"{key}: found {shown(value)}; allowed a list of values or {{ from, to, count }}")
    low, high, count = value["from"], value["to"], value["count"]
    if not (type(count) is int and 1 <= count <= MOST_VARIANTS):
        raise InputError(f"{key}.count: found {shown(count)}; allowed a whole number from 1 to {MOST_VARIANTS}")
    if not all(is_finite(end) for end in (low, high)):
        raise InputError(f"{key}: found from {shown(low)} to {shown(high)}; allowed two finite numbers")
    values: list[Any] = np.linspace(low, high, count).tolist()
    return values


def _distribution(study: Mapping[str, Any], place: str, value: Any) -> Distribution:
    """Distribution at a place of a study file, about the value of the scene in ``study`` where it says so."""
    from scipy import stats

    key = place.removeprefix("distributions.")
    if isinstance(value, dict) and CLASS in value:
        return _of_class(study.get("scene"), place, value)

    name = value.get(DISTRIBUTION) if isinstance(value, dict) else None
    known = getattr(stats, name, None) if isinstance(name, str) else None
    if not isinstance(known, stats.rv_continuous | stats.rv_discrete):
        names = [
            word for word in dir(stats) if isinstance(getattr(stats, word), stats.rv_continuous | stats.rv_discrete)
        ]
        hint = did_you_mean(nearest(name, names)) if isinstance(name, str) else ""
        value_given = (shown(value) if name is None else shown(name)) + hint
        raise InputError(
            f'{place}: found {value_given}; allowed {{ {DISTRIBUTION} = "norm", scale = 5.0 }}, names of scipy.stats'
        )
    parameters = {word: number for word, number in value.items() if word not in (DISTRIBUTION, ABOUT)}
    key, writing = writing_at(study["scene"], key) if "scene" in study else (key, None)
    if writing is not None:
        parameters = _converted(writing, place, parameters, discrete=isinstance(known, stats.rv_discrete))
    nominal = nominal_of(study["scene"], key) if "scene" in study else None
    is_number = isinstance(nominal, Real) and not isinstance(nominal, bool)
    if (about := value.get(ABOUT)) is not None:
        if about != NOMINAL:
            raise InputError(f'{place}.{ABOUT}: found {shown(about)}; allowed "{NOMINAL}"')
        if "scene" in study and not is_number:
            raise InputError(f"{place}.{ABOUT}: the scene has no number there, but {shown(nominal)}")
        parameters["loc"] = parameters.get("loc", 0.0) + (nominal if is_number else 0.0)
    elif "loc" not in parameters and is_number and nominal:
        there = nominal if writing is None else writing.from_key(nominal)
        raise InputError(
            f'{place}: the scene has {shown(there)} there; allowed {ABOUT} = "{NOMINAL}", which scatters about that, '
            "or loc, with which the distribution takes its place"
        )
    try:
        frozen: Distribution = known(**parameters)
    except (TypeError, ValueError):
        takes = [
            *(known.shapes or "").replace(",", "").split(),
            "loc",
            *["scale"] * isinstance(known, stats.rv_continuous),
        ]
        given = ", ".join(parameters) or "none"
        raise InputError(f"{place}: {name} has the parameters {', '.join(takes)}; found {given}") from None
    return frozen


def _converted(writing: Writing, place: str, parameters: Mapping[str, Any], *, discrete: bool) -> dict[str, Any]:
    """Parameters of a distribution in the unit of the key: place and width are quantities, its shapes are not."""
    if writing.factor is None or discrete:
        what = "a distribution over whole numbers" if discrete else "another quantity"
        raise InputError(f"{place}: {what}, which is not converted; allowed a distribution of {writing.key}")
    quantities = {"loc": parameters.get("loc"), "scale": parameters.get("scale", 1.0)}
    return {**parameters, **{name: writing.converted(value) for name, value in quantities.items() if value is not None}}


def _of_class(scene: Scene | Stage | None, place: str, value: Mapping[str, Any]) -> Distribution:
    """Distribution of a slope, about that of the scene, of gears of a tolerance class."""
    if beside := [word for word in value if word != CLASS]:
        raise InputError(f"{place}: found {', '.join(map(shown_key, beside))} beside {CLASS}; allowed nothing else")
    given = value[CLASS]
    if not is_whole(given, 1, 11):
        raise InputError(f"{place}.{CLASS}: found {shown(given)}; allowed a whole number from 1 to 11")
    if scene is None:  # a problem of its own
        from scipy.stats import norm

        nothing: Distribution = norm()
        return nothing
    if isinstance(scene, Stage):
        raise InputError(f"{place}.{CLASS}: not in a study of stages; allowed a distribution of scipy.stats")
    with named(place):
        bounded = scene.scatter_of_class(given)
    key = place.removeprefix("distributions.")
    if key not in bounded:
        raise InputError(f"{place}: ISO 1328-1 has no tolerance of it by class; allowed {', '.join(bounded)}")
    of_class: Distribution = bounded[key]
    return of_class


def _table(name: Any, folder: Path) -> dict[str, list[Any]]:
    if name is None:
        return {}
    if not isinstance(name, str):
        raise InputError(f"table: found {shown(name)}; allowed the name of a CSV file")
    import pandas

    with named("table"):
        # pandas would unpack it, or open an address
        text = read_table(folder / name, LARGEST_TABLE, "table of variants")
    with named(f"table: {folder / name}"):
        table, lines = table_in(text), io.StringIO()
    csv.writer(lines).writerows([table.names, *(cells for _, cells in table.rows)])
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # rows longer than the header are cut with a warning
            frame = pandas.read_csv(io.StringIO(lines.getvalue()), index_col=False)
    except Exception as error:  # on what is no CSV the reader stumbles in any way
        raise InputError(f"table: {folder / name}: no CSV: {error}") from None
    return {str(key): column.tolist() for key, column in frame.items()}


def vh_study(scene: Scene, v: Sequence[float], h: Sequence[float]) -> Study:
    """Return the study of a scene over a grid of two mounting errors, as a V-H check varies them.

    With ``keep_maps=range(len(study))`` :func:`loaded_tca.studies.run_study` keeps what
    :func:`loaded_tca.plots.plot_loaded_vh_check` draws.

    Parameters
    ----------
    scene : Scene
    v : (m,) sequence of float
        Bevel and face-milled gears: offset E [mm]; cylindrical ones: axis error in the plane of the axes [deg].
    h : (n,) sequence of float
        Bevel and face-milled gears: axial displacement P of the pinion [mm]; cylindrical ones: axis error out of the
        plane of the axes [deg].

    Returns
    -------
    Study
        Of m n variants, v changing fastest.

    Raises
    ------
    InputError
        If a value is not a finite number, or there is none.

    Examples
    --------
    >>> from loaded_tca import parse_scene
    >>> from loaded_tca.cli import DEMO_SCENE
    >>> vh_study(parse_scene(DEMO_SCENE.read_text()), v=[0.0], h=[-0.01, 0.0, 0.01]).changes(2)
    {'mounting.out_of_plane_deg': 0.01, 'mounting.in_plane_deg': 0.0}
    """
    v_key, h_key = scene.vh_keys
    return Study(scene, {h_key: h, v_key: v})
