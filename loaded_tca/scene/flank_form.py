"""Sections of fitted and measured flanks: how a flank is described, and the points that it was measured at."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Literal

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError, named
from loaded_tca.flanks.spline import DEFAULT_POINTS, FEWEST_POINTS
from loaded_tca.flanks.topography import LINES_NOTE, MeasuredPoints, read_topography
from loaded_tca.scene.keys import Choice, Grid, Line, List, Number, Whole, above_zero, key, shown
from loaded_tca.scene.section import Rule, Section, rule, subsection

FARTHEST_mm = 100000.0
MOST_POINTS = 100
"""Points along the profile, and lengthwise, of a flank in a scene: results keep them as text."""
DIGITS = 12
"""Significant digits that are kept of a measurement: far more than it has, fewer than conversions of units blur."""
COLUMNS = (("radius_mm", "axial_mm", "deviation_um"), ("x_mm", "y_mm", "z_mm"))
"""What a measurement may be given by."""
ALL_COLUMNS = (*COLUMNS[0], *COLUMNS[1])
COUNT = Whole(min(FEWEST_POINTS.values()), MOST_POINTS)
FITTED_DEGREE = 5


def _grid(number: Number) -> Grid:
    return Grid(number, COUNT.low, MOST_POINTS)


COORDINATES_mm = _grid(Number(-FARTHEST_mm, FARTHEST_mm))
Points = tuple[tuple[float, ...], ...]
"""A value of each point: lines along the profile, entries lengthwise."""


def _one_set_of_columns(*columns: object) -> str | None:
    given = tuple(name for name, values in zip(ALL_COLUMNS, columns, strict=True) if values is not None)
    if given in COLUMNS:
        return None
    sets = " or ".join(", ".join(names) for names in COLUMNS)
    return f"given are {', '.join(given) or 'no points'}; allowed {sets}"


def _one_shape(*columns: Points | None) -> str | None:
    shapes = {(len(values), len(values[0])) for values in columns if values is not None}
    if len(shapes) < 2:
        return None
    return f"found {' and '.join(f'{n} x {m}' for n, m in sorted(shapes))} points in one measurement"


@dataclass(frozen=True, kw_only=True)
class Measurement(Section):
    """[pinion.flank.measurement]: points of a measured flank; lines along the profile, entries lengthwise."""

    radius_mm: Points | None = key(
        _grid(above_zero(FARTHEST_mm)), "distances of the points from the axis", None, "`x_mm`, `y_mm`, `z_mm` are"
    )
    axial_mm: Points | None = key(
        COORDINATES_mm,
        "axial coordinates of the points, from mid-face (bevel gears: from the apex)",
        None,
        "as `radius_mm`",
    )
    deviation_um: Points | None = key(
        _grid(Number(-1e5, 1e5)),
        "deviations along the normal from the flank with its modifications; positive: more material",
        None,
        "as `radius_mm`",
    )
    x_mm: Points | None = key(
        COORDINATES_mm,
        "x of the points in the gear's own frame, z along its axis; the tooth stands at any azimuth",
        None,
        "`radius_mm`, `axial_mm`, `deviation_um` are",
    )
    y_mm: Points | None = key(COORDINATES_mm, "y of the points", None, "as `x_mm`")
    z_mm: Points | None = key(COORDINATES_mm, "z of the points", None, "as `x_mm`")
    two_lines: bool = key(
        Choice((False, True)),
        "whether the points follow from a profile line and a helix line, which do not measure a twist",
        False,
    )
    source: str = key(Line(), "where the points come from", "")

    rules: ClassVar[tuple[Rule, ...]] = (
        Rule(ALL_COLUMNS, _one_set_of_columns),
        Rule(ALL_COLUMNS, _one_shape),
        rule(
            ("two_lines", "deviation_um"),
            lambda lines, deviations: not lines or deviations is not None,
            "found true; lines have deviations, and the points are not given by deviation_um",
        ),
    )

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of points along the profile and lengthwise."""
        lines = self.x_mm or self.radius_mm
        assert lines is not None  # by the rules of the section
        return len(lines), len(lines[0])

    @property
    def places(self) -> tuple[Array, Array]:
        """Radius and axial coordinate of the points [mm]."""
        if self.radius_mm is None:
            return np.hypot(self.x_mm, self.y_mm), np.asarray(self.z_mm)  # type: ignore[arg-type]
        return np.asarray(self.radius_mm), np.asarray(self.axial_mm)


def _only_for(name: str, *forms: str) -> Rule:
    """Rule: a key belongs to some forms of flanks only."""
    allowed = " or ".join(shown(form) for form in forms)
    problem = f'does not apply to form = "{{1}}"; allowed with {allowed}'
    return rule((name, "form"), lambda value, form: value is None or form in forms, problem)


def _enough_points(points: tuple[int, int] | None, degree: int | None) -> str | None:
    least = FEWEST_POINTS[degree or FITTED_DEGREE]
    if points is None or min(points) >= least:
        return None
    return f"found {shown(points)}; allowed from {least} on, for degree = {degree or FITTED_DEGREE}"


def _one_source(file: str | None, measurement: object, form: str) -> str | None:
    if file is not None and measurement is not None:
        return f"found {shown(file)} beside a section measurement; give one of the two"
    if form == "measured" and file is None and measurement is None:
        return 'missing; form = "measured" needs a file of points, or a section measurement'
    return None


@dataclass(frozen=True, kw_only=True)
class FlankForm(Section):
    """[pinion.flank], [wheel.flank]: how the flank is described.

    A file of measured points is read when the section is made, and its points take its place: a scene, and every
    result that keeps it, needs the file no more.
    """

    form: Literal["analytic", "bspline", "measured"] = key(
        Choice(("analytic", "bspline", "measured")),
        "the equations of the flank; a B-spline through points of it; or a measured flank",
        "analytic",
    )
    points: tuple[int, int] | None = key(
        List(COUNT, 2, 2),
        'points along the profile and lengthwise of a "bspline", modifications included',
        None,
        f"{list(DEFAULT_POINTS)}",
    )
    degree: int | None = key(
        Choice(tuple(FEWEST_POINTS)),
        "degree of the B-spline, which needs "
        + ", ".join(f"{least} points ({degree})" for degree, least in FEWEST_POINTS.items())
        + " in each direction",
        None,
        "5; measured with fewer than 6 points: 3",
    )
    coefficients: tuple[int, int] | None = key(
        List(COUNT, 2, 2),
        "B-spline coefficients along the profile and lengthwise of a measured flank; with as many as points, the flank "
        "goes through every point",
        None,
        "half as many as points and two, which smooths the noise of measurement",
    )
    file: str | None = key(
        Line(1000),
        "file of measured points, relative to the folder of the scene",
        None,
        "no points, or the points of a section measurement",
    )
    measurement: Measurement | None = subsection(Measurement, "measured points, instead of a file", optional=True)

    rules: ClassVar[tuple[Rule, ...]] = (
        _only_for("points", "bspline"),
        _only_for("degree", "bspline", "measured"),
        _only_for("coefficients", "measured"),
        _only_for("file", "measured"),
        _only_for("measurement", "measured"),
        Rule(("points", "degree"), _enough_points),
        Rule(("file", "measurement", "form"), _one_source),
    )
    alternatives: ClassVar[tuple[str, ...]] = ("file", "measurement")

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.file is not None:
            object.__setattr__(self, "measurement", read_measurement(self.file))
            object.__setattr__(self, "file", None)


def read_measurement(file: str) -> Measurement:
    """Return the points of a file of measured points.

    Raises
    ------
    InputError
        If the file cannot be read, or with every problem that it holds.
    """
    if os.path.exists(file) and not os.path.isfile(file):  # a pipe would be waited for
        raise InputError(f"file: {file}: is not a file")
    with named("file"):
        topography = read_topography(file)
        topography.require_no_weights()
    columns: tuple[Any, ...]
    if isinstance(topography, MeasuredPoints):
        names, columns = COLUMNS[1], tuple(topography.points[..., part] for part in range(3))  # type: ignore[index,call-overload]
    else:
        names, columns = COLUMNS[0], (topography.radius, topography.axial, 1e3 * topography.excess)  # type: ignore[attr-defined]
    lines = {
        name: tuple(tuple(float(f"{value:.{DIGITS}g}") for value in line) for line in values)
        for name, values in zip(names, columns, strict=True)
    }
    with named(f"file: {file}"):
        two_lines = LINES_NOTE in topography.notes
        return Measurement(**lines, two_lines=two_lines, source=Path(file).name[: Line().longest])
