r"""Measured topographies: where the points of a measured flank lie, how far off the nominal one, and their files.

The excess e is a distance along the normal, positive where the flank has **more** material than the nominal one, as
gear measuring centres count; a modification counts the material removed, delta = -e. Both are turned into an angle by
the same rule, :math:`\Theta = \Theta_n + s\, e\, |\nabla F|`.

Files hold comma-separated values with the unit of every column in its header::

    # gear = wheel
    # measured = left flank, tooth 7
    profile_index,lengthwise_index,radius_mm,axial_mm,deviation_um
    1,1,82.91,-11.2,-4.1
    2,1,84.45,-11.2,-1.6
    ...

The columns are one of

- ``radius`` (or ``diameter``), ``axial`` and ``deviation`` (positive: **more** material than nominal, as measuring
  centres count), or ``removed`` (positive: less material, as modifications count);
- ``x, y, z``: points of the measured flank;
- ``x, y, z, nx, ny, nz, deviation``: points of the nominal flank, unit normals there and deviations along these, as
  nominal data of bevel gears are exchanged: measured points are P + e n;
- ``x, y, z, deviation``: points of the nominal flank and deviations from it;
- ``line, radius, axial, deviation``: two lines of a cylindrical gear, ``profile`` and ``helix``. A point of the flank
  deviates by what the profile line does at its radius and by what the helix line does at its place along the face, both
  less what they do where they cross. Of lines of more than 50 points means of points that follow each other count.

Each has ``_um``, ``_mm``, ``_m``, ``_in`` or ``_uin`` behind it, but normals and ``line``. Rows of points come in any
order with the columns ``profile_index`` and ``lengthwise_index``, or ``i`` and ``j``, of which the one whose lines of
points are longer runs along the tooth; without them in the order of the grid, the profile running fastest, and a
comment says how many points there are: ``# points = 5 x 9`` (profile x lengthwise). A column ``weight``, without a
unit, has the weights of the points where settings follow from them. Semicolons and tabs separate values, too, and a
first line ``sep=;`` is read; blanks do where the line of names has nothing else. Names and values may be quoted, the
sign for micro in a name stands for u, and separators at the ends of lines, as spreadsheets write them, are left out.
Numbers have a decimal point.

References
----------
ISO/TR 10064-6 and ISO 17485 (measurement of bevel gears: flank form grids, deviations normal to the flank).
"""

from __future__ import annotations

import difflib
import os
import re
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, Indices, OtherKindError, numbers, shown
from loaded_tca.errors import InputError, named, require
from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.measured_columns import LINES, along_normals, flank_of_lines, runs_lengthwise_first
from loaded_tca.input_files import Table, number_in, read_table, require_decimal_points, table_in
from loaded_tca.plain import plain

LARGEST_FILE = 2**23
"""Bytes of a topography file; a point takes about 60."""
UNITS = {"um": 1e-3, "mm": 1.0, "m": 1e3, "in": 25.4, "uin": 25.4e-6}
"""Unit at the end of a column's name -> factor to mm."""
INDICES, MACHINE_INDICES = ("profile_index", "lengthwise_index"), ("i", "j")
LINE, WEIGHT = "line", "weight"
NORMAL = ("nx", "ny", "nz")
UNITLESS = (*INDICES, *MACHINE_INDICES, *NORMAL, LINE, WEIGHT)
LENGTHS = ("x", "y", "z", "radius", "diameter", "axial", "deviation", "removed")
EXCESS = ("deviation", "removed")
CHOICES = [
    {"x", "y", "z"},
    *({*places, excess} for places in (("x", "y", "z"), ("x", "y", "z", *NORMAL)) for excess in EXCESS),
    *({*places, excess} for places in (("radius", "axial"), (LINE, "radius", "axial")) for excess in EXCESS),
]
ALLOWED = (
    "x, y, z; x, y, z, deviation; x, y, z, nx, ny, nz, deviation; radius, axial, deviation; or line, radius, axial, "
    "deviation, with removed for deviation, and lengths with their units"
)
GDE = (
    "an XML file: GDE (VDI/VDE 2610) and other XML of measuring centres are not read, since no public description of "
    "their elements is known; have the points written as a table, whose columns docs/guide/measured_flank.md names"
)
LINES_NOTE, TWO_LINES = "lines", "profile and helix"
"""Among the notes of a flank that was measured in two lines, which have no twist."""
MOST_PROBLEMS = 10
"""Problems of single lines that are told; more of them are counted."""


@checked
def read_topography(path: str | os.PathLike[str]) -> Topography:
    r"""Read the measured points, or deviations, of one flank.

    Parameters
    ----------
    path : str or path
        A file as this module describes it, in UTF-8, UTF-16 with its mark, or the western code page of Windows.

    Returns
    -------
    Topography
        ``MeasuredPoints`` or ``MeasuredDeviations``; its ``notes`` hold the comments "key = value".

    Raises
    ------
    InputError
        If the file cannot be read, or with every problem that it holds, one per line.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> rows = [f"{20 + i},{5 * j},{i - j}" for j in range(4) for i in range(5)]
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = pathlib.Path(folder, "flank.csv")
    ...     _ = file.write_text("\n".join(["# points = 5 x 4", "radius_mm,axial_mm,deviation_um", *rows]))
    ...     topography = read_topography(file)
    >>> topography.radius.shape, float(topography.excess[4, 1])
    ((5, 4), 0.003)
    """
    text = read_table(path, LARGEST_FILE, "measured flank")
    with named(os.fspath(path)):
        return parse_topography(text)


def parse_topography(text: str) -> Topography:
    """Topography of the text of a file; see ``read_topography``."""
    require((not text.lstrip().startswith("<"), GDE))
    lines = table_in(text)
    comments = [comment.split("=", 1) for comment in lines.comments]
    notes = {part[0].strip(): part[1].strip() for part in comments if len(part) == 2}
    notes.pop(LINES_NOTE, None)  # which columns say, and no comment
    if not lines.rows:
        raise InputError("no points: a line with the names of the columns, and one line per point, are asked for")
    columns = _factors(lines.number, lines.names)
    values = _numbers(lines)
    table = {name: values[:, k] * factor for k, (name, factor) in enumerate(columns)}
    if "removed" in table:
        table["deviation"] = -table.pop("removed")
    if LINE in table:
        parts = (table[name] for name in (LINE, "radius", "axial", "deviation"))
        return MeasuredDeviations(*flank_of_lines(*parts), notes | {LINES_NOTE: TWO_LINES})
    by_machine = MACHINE_INDICES[0] in table
    if INDICES[0] in table or by_machine:
        names = MACHINE_INDICES if by_machine else INDICES
        shape, order = _order_by_indices(names, *(table[name] for name in names))
    else:
        shape, order = _given_order(len(values), notes.get("points", ""))
    grids = {name: column[order].reshape(shape) for name, column in table.items()}
    if "x" in grids and "deviation" in grids:
        grids |= {"radius": np.hypot(grids["x"], grids["y"]), "axial": grids["z"]}
    if by_machine and runs_lengthwise_first(*_places(grids)):
        grids = {name: grid.T for name, grid in grids.items()}
    return _topography(grids, notes)


def _places(grids: Mapping[str, Array]) -> tuple[Array, Array]:
    """Radius and axial coordinate of points by their columns."""
    if "radius" in grids:
        return grids["radius"], grids["axial"]
    return np.hypot(grids["x"], grids["y"]), grids["z"]


def _topography(grids: Mapping[str, Array], notes: Mapping[str, str]) -> Topography:
    """Topography of columns (n, m) of points, in mm."""
    weights = grids.get(WEIGHT)
    if "x" in grids and not ("deviation" in grids and NORMAL[0] not in grids):
        points = np.stack([grids[name] for name in ("x", "y", "z")], axis=-1)
        if NORMAL[0] in grids:
            normals = np.stack([grids[name] for name in NORMAL], axis=-1)
            return MeasuredPoints(along_normals(points, normals, grids["deviation"]), notes, weights, points)
        return MeasuredPoints(points, notes, weights)
    return MeasuredDeviations(*_places(grids), grids["deviation"], notes, weights)


def _numbers(table: Table) -> Array:
    """Rows of numbers (points, columns); InputError with every line that is none.

    Places are told, and not what stands there: the file may be any that can be read.
    """
    lines, header = table.rows, table.names
    require_decimal_points(table)
    rows, problems = [], []
    for number, cells in lines:
        if len(cells) != len(header):
            problems.append(f"line {number}: {len(cells)} values; the header names {len(header)} columns")
            continue
        row = [_number(cell, name) for cell, name in zip(cells, header, strict=True)]
        problems += [
            f"line {number}, column {k}: {name} is {'no line, profile or helix' if name == LINE else NOT_FINITE}"
            for k, (name, value) in enumerate(zip(header, row, strict=True), 1)
            if not np.isfinite(value)
        ]
        rows.append(row)
    if problems:
        more = len(problems) - MOST_PROBLEMS
        raise InputError(problems[:MOST_PROBLEMS] + ([f"and {more} more problems of this kind"] if more > 0 else []))
    return np.array(rows)


NOT_FINITE = "not a finite number"


def _number(cell: str, name: str) -> float:
    if name == LINE:
        return LINES.get(cell.lower(), float("nan"))
    try:
        return number_in(cell)
    except ValueError:
        return float("nan")


def _factors(line: int, header: Sequence[str]) -> list[tuple[str, float]]:
    """Name of each column without its unit, and the factor to mm; InputError with every problem of the header."""
    factors, problems = [], []
    known = [*UNITLESS, *(f"{name}_{unit}" for name in LENGTHS for unit in UNITS)]
    for k, column in enumerate(header, 1):
        name, _, unit = column.rpartition("_")
        if column in UNITLESS:
            factors.append((column, 1.0))
        elif name == "diameter" and unit in UNITS:
            factors.append(("radius", 0.5 * UNITS[unit]))
        elif name in LENGTHS and unit in UNITS:
            factors.append((name, UNITS[unit]))
        elif column in LENGTHS:
            problems.append(f"column {column!r} has no unit; allowed {', '.join(f'{column}_{unit}' for unit in UNITS)}")
        elif name in LENGTHS:
            allowed = ", ".join(f"{name}_{unit}" for unit in UNITS)
            problems.append(f"line {line}, column {k}: the unit of {name} is unknown; allowed {allowed}")
        else:
            near = difflib.get_close_matches(column, known, 1)
            meant = f"did you mean {near[0]!r}?" if near else f"allowed {', '.join(UNITLESS)}, and lengths as x_mm"
            problems.append(f"line {line}, column {k}: the name of the column is unknown; {meant}")
    names = [name for name, _ in factors]
    problems += [f"column {name} appears twice" for name in sorted(set(names)) if names.count(name) > 1]
    pairs = INDICES, MACHINE_INDICES
    lengths = set(names) - {*INDICES, *MACHINE_INDICES, WEIGHT}
    if not problems and lengths not in CHOICES:
        problems.append(f"columns {', '.join(sorted(lengths)) or 'none'}; allowed {ALLOWED}")
    if not problems:
        problems += [
            f"columns {' and '.join(pair)} belong together; only one is there"
            for pair in pairs
            if len(set(names) & set(pair)) == 1
        ]
        beside = sorted(set(names) & {*INDICES, *MACHINE_INDICES, WEIGHT}) if LINE in names else []
        twice = all(set(pair) <= set(names) for pair in pairs)
        problems += [f"columns {' and '.join(INDICES)}, i and j: allowed one pair of them"] if twice else []
        problems += [f"column {beside[0]}: not allowed beside line"] if beside else []
    if problems:
        raise InputError(problems)
    return factors


def _given_order(count: int, points: str) -> tuple[tuple[int, int], Indices]:
    """Shape (profile, lengthwise) of a grid that a comment tells, and the order in which ``count`` rows fill it."""
    match = re.fullmatch(r"(\d{1,9})\s*x\s*(\d{1,9})", points, re.ASCII)
    if match is None:
        columns = " and ".join(INDICES)
        raise InputError(f"the shape of the grid is missing: columns {columns}, or a comment '# points = 5 x 9'")
    shape = int(match[1]), int(match[2])
    if shape[0] * shape[1] != count:
        raise InputError(f"points = {shape[0]} x {shape[1]} are {shape[0] * shape[1]}, but there are {count} rows")
    return shape, np.arange(count).reshape(shape[::-1]).T.ravel()


def _order_by_indices(names: Sequence[str], profile: Array, lengthwise: Array) -> tuple[tuple[int, int], Indices]:
    """Shape (profile, lengthwise) of a grid with these indices, and the order of the rows in which they fill it."""
    fractions = [(name, at[at != np.round(at)]) for name, at in zip(names, (profile, lengthwise), strict=True)]
    problems = [
        f"{name}: {plain(at[0], 6)} is not a whole number ({at.size} such rows)" for name, at in fractions if at.size
    ]
    if problems:  # each would be a line of the grid of its own
        raise InputError(problems)
    (rows, row), (columns, column) = (np.unique(index, return_inverse=True) for index in (profile, lengthwise))
    shape, place = (len(rows), len(columns)), row * len(columns) + column
    taken, times = np.unique(place, return_counts=True)
    free = np.flatnonzero(taken != np.arange(len(taken)))
    first_free, missing = int(free[0]) if free.size else len(taken), shape[0] * shape[1] - len(taken)
    twice = taken[times > 1]
    cases = ((missing, first_free, "missing"), (len(twice), int(twice[0]) if len(twice) else 0, "given more than once"))
    problems = [
        f"{count} of the {shape[0]} x {shape[1]} points {'is' if count == 1 else 'are'} {what}, the first at "
        f"{names[0]} {plain(rows[first // shape[1]], 6)}, {names[1]} {plain(columns[first % shape[1]], 6)}"
        for count, first, what in cases
        if count
    ]
    if problems:
        raise InputError(problems)
    return shape, np.argsort(place)


LARGEST_EXCESS = 0.1
"""Part of the flank's height that no deviation reaches: beyond it the points belong to another flank."""


class Topography(ABC):
    """Points of a measured flank in rows and columns, axes (profile, lengthwise), in the gear's own frame.

    Attributes
    ----------
    radius, axial : (n, m) array [mm]
        Cylindrical coordinates of the points; axial from mid-face (cylindrical) or from the apex (bevel).
    notes : mapping
        What the file said about the measurement.
    weights : (n, m) array or None
        Of the points where settings follow from them; None: one each. A spline through points has none.
    """

    radius: Array
    axial: Array
    notes: Mapping[str, str]
    weights: ArrayLike | None

    def require_no_weights(self) -> None:
        """Refuse weights where a spline goes through the points."""
        problem = "weight: a spline through measured points has none, settings from measured flanks do; leave it out"
        require((self.weights is None, problem))

    @property
    @abstractmethod
    def has_zero(self) -> bool:
        """Whether the mean of the deviations is measured, from which the thickness of a tooth follows."""

    @abstractmethod
    def excess_over(self, nominal: Flank, turned: bool) -> Array:
        """Material (n, m) in excess of a nominal flank [mm]; ``turned``: the azimuth of the tooth has no meaning."""


@checked
@dataclass(frozen=True, eq=False)
class MeasuredPoints(Topography):
    """Points of one flank, measured in the gear's own frame (z along its axis).

    Parameters
    ----------
    points : (n, m, 3) array [mm]
        x, y, z; the azimuth of the tooth is free where the flank is turned to its pitch point.
    notes : mapping, optional
    weights : (n, m) array, optional
    nominal : (n, m, 3) array [mm], optional
        x, y, z of the nominal flank from which the points deviate: where it stands says by how much on the mean.

    Raises
    ------
    InputError
        If a shape is another one, a point or weight is not finite, or a weight is negative or none is positive.
    """

    points: ArrayLike
    notes: Mapping[str, str] = field(default_factory=dict)
    weights: ArrayLike | None = None
    nominal: ArrayLike | None = None

    def __post_init__(self) -> None:
        points = _grid("points", self.points, 3)
        if self.nominal is not None:
            nominal = _grid("nominal", self.nominal, 3)
            require((nominal.shape == points.shape, f"nominal: shape {nominal.shape}; allowed {points.shape}"))
            object.__setattr__(self, "nominal", nominal)
        object.__setattr__(self, "weights", _weights(self.weights, points.shape[:2]))
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "radius", np.hypot(points[..., 0], points[..., 1]))
        object.__setattr__(self, "axial", points[..., 2])

    @property
    def has_zero(self) -> bool:
        """Where nominal points say at which azimuth the nominal flank stands."""
        return self.nominal is not None

    def excess_over(self, nominal: Flank, turned: bool) -> Array:
        """Azimuth ahead of the nominal flank, as a distance along its normal [mm].

        Where the azimuth of the tooth has no meaning, the nominal flank stands at the mean azimuth of the nominal
        points, or without these at that of the points.
        """
        ahead = _ahead(np.asarray(self.points), nominal)
        zero = ahead if self.nominal is None else _ahead(np.asarray(self.nominal), nominal)
        middle = np.angle(np.exp(1j * zero).mean()) if turned else 0.0
        ahead = np.angle(np.exp(1j * (ahead - middle)))
        return nominal.side * ahead / nominal.gradient_norm(self.radius, self.axial).value


@checked
@dataclass(frozen=True, eq=False)
class MeasuredDeviations(Topography):
    """Deviations from the nominal flank along its normal.

    Parameters
    ----------
    radius, axial : (n, m) array [mm]
        Where they were measured.
    excess : (n, m) array [mm]
        Positive where there is more material than nominal.
    notes : mapping, optional
    weights : (n, m) array, optional

    Raises
    ------
    InputError
        If the shapes differ or are no grid, a value is not finite, a radius is not positive, or weights are negative
        or all zero.
    """

    radius: ArrayLike  # type: ignore[assignment]
    axial: ArrayLike  # type: ignore[assignment]
    excess: ArrayLike
    notes: Mapping[str, str] = field(default_factory=dict)
    weights: ArrayLike | None = None

    def __post_init__(self) -> None:
        arrays: dict[str, Array] = {}
        problems: list[str] = []
        for name in ("radius", "axial", "excess"):
            try:
                arrays[name] = _grid(name, getattr(self, name))
            except InputError as error:
                problems += error.problems
        if not problems and len({array.shape for array in arrays.values()}) > 1:
            problems.append(f"shapes {', '.join(f'{name} {array.shape}' for name, array in arrays.items())} differ")
        if "radius" in arrays and not (arrays["radius"] > 0.0).all():
            problems.append(f"radius: {plain(arrays['radius'].min(), 6)} mm is not positive")
        if problems:
            raise InputError(problems)
        for name, array in arrays.items():
            object.__setattr__(self, name, array)
        object.__setattr__(self, "weights", _weights(self.weights, arrays["radius"].shape))

    @property
    def has_zero(self) -> bool:
        """Deviations of points have one; lines are taken less what they have where they cross."""
        return LINES_NOTE not in self.notes

    def excess_over(self, nominal: Flank, turned: bool) -> Array:  # noqa: ARG002 (the nominal flank they belong to)
        """The deviations themselves [mm]."""
        return np.asarray(self.excess)


def _ahead(points: Array, nominal: Flank) -> Array:
    """Azimuth (n, m) of points (n, m, 3) less that of the nominal flank at their radius and axial coordinate [rad]."""
    x, y, z = np.moveaxis(points, -1, 0)
    return np.asarray(np.arctan2(y, x) - nominal.theta(np.hypot(x, y), z).value)


def excess_problems(nominal: Flank, excess: Array) -> list[str]:
    """What keeps distances from a flank from being deviations of it."""
    limit, largest = LARGEST_EXCESS * min(nominal.extent), float(np.abs(excess).max())
    if largest <= limit:
        return []
    return [
        f"the points lie up to {plain(largest)} mm off the nominal flank along its normal, more than the "
        f"{plain(limit)} mm of any deviation: wrong gear, hand, side of the tooth, frame or unit?"
    ]


def _weights(weights: ArrayLike | None, shape: tuple[int, ...]) -> Array | None:
    """Weights of points as an array, or none."""
    if weights is None:
        return None
    array = _grid("weights", weights)
    require(
        (array.shape == shape, f"weights: shape {array.shape}; allowed {shape}, as the points"),
        (bool((array >= 0.0).all() and array.any()), "weights: allowed from 0 on, and not all of them 0"),
    )
    return array


def _grid(name: str, values: ArrayLike, parts: int | None = None) -> Array:
    """A new array (n, m) or (n, m, parts) of finite numbers."""
    shape = "(n, m)" if parts is None else f"(n, m, {parts})"
    try:
        array = numbers(name, values, "mm").copy()
    except OtherKindError:
        raise InputError(f"{name}: an array {shape} of numbers is asked for, not {shown(values)}") from None
    if array.ndim != (2 if parts is None else 3) or (parts is not None and array.shape[-1] != parts) or not array.size:
        raise InputError(f"{name}: shape {array.shape}; allowed {shape}, axes (profile, lengthwise)")
    bad = np.argwhere(~np.isfinite(array))
    if bad.size:
        where = f"profile line {bad[0][0] + 1}, lengthwise line {bad[0][1] + 1}"
        raise InputError(f"{name}: {len(bad)} values are not finite, the first at {where}")
    return array
