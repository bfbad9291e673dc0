"""What holds a gear: a matrix, [pinion.support] and [wheel.support]; a shaft, [pinion.shaft] and [wheel.shaft].

The matrix is of the gear's motions under forces and moments; a shaft has its sections, bearings and other loads.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.plain import plain
from loaded_tca.scene.keys import Choice, Grid, List, Number, Whole, above_zero, key
from loaded_tca.scene.section import Rule, Section, Tables

# ruff: noqa: N815  -- names are the keys of the file, units included

DIRECTIONS = "along x", "along y", "along z, its axis", "about x", "about y", "about z, its axis"
"""Motions of a gear in the order of the rows of the matrices."""
SOFTEST_mm_per_N, STIFFEST_N_per_mm = 1e3, 1e15
"""Largest entries: a metre per newton; a thousand times the tilting stiffness of the largest bearings [N mm/rad]."""
SYMMETRIC = 1e-6
"""Difference of two entries that are the same, over the roots of their diagonal entries: numbers of six digits."""
FREE = 1e-12
"""Smallest eigenvalue of a matrix with ones on its diagonal that still holds a gear."""


def scaled(matrix: Array) -> tuple[Array, Array]:
    """A symmetric matrix with ones on its diagonal, where that is above zero; the roots of its diagonal."""
    roots = np.sqrt(np.maximum(matrix.diagonal(), 0.0))
    over = np.where(roots > 0.0, roots, 1.0)
    return matrix / np.outer(over, over), over


def fault_of_matrix(rows: tuple[tuple[float, ...], ...], *, definite: bool) -> str | None:
    """What is wrong with a compliance, or with a stiffness, which is to be ``definite``; None: nothing."""
    matrix = np.array(rows)
    if matrix.shape != (6, 6):
        return f"found {matrix.shape[0]} lists of {matrix.shape[1]} values; allowed 6 lists of 6"
    if (diagonal := matrix.diagonal()).min() < 0.0:
        place = int(diagonal.argmin())
        return (
            f"found {plain(diagonal[place], 6)} for the motion {DIRECTIONS[place]}; allowed are diagonal "
            "entries from 0 on"
        )
    relative, roots = scaled(matrix)
    off = np.abs(relative - relative.T)
    if off.max() > SYMMETRIC:
        row, column = sorted(np.unravel_index(int(off.argmax()), off.shape))
        one, other = matrix[row, column], matrix[column, row]
        return (
            f"not symmetric: found {plain(one, 6)} in row {row + 1}, column {column + 1}, and "
            f"{plain(other, 6)} in the mirrored place"
        )
    values, vectors = np.linalg.eigh(0.5 * (relative + relative.T))
    if values[0] < -SYMMETRIC:
        return (
            f"not positive semidefinite: smallest eigenvalue {plain(values[0], 3)} with ones on the diagonal; a load "
            "would move the gear against itself"
        )
    if definite and values[0] < FREE:
        free = DIRECTIONS[int(np.abs(vectors[:, 0] / roots).argmax() if roots.all() else roots.argmin())]
        free = DIRECTIONS[int(np.flatnonzero(diagonal == 0.0)[0])] if (diagonal == 0.0).any() else free
        return f"leaves the gear free {free}; allowed are matrices that hold all six motions, or compliance"
    return None


def _one_matrix(compliance: tuple[tuple[float, ...], ...] | None, stiffness: object) -> str | None:
    if (compliance is None) == (stiffness is None):
        fault = "missing" if compliance is None else "found beside stiffness"
        return f"{fault}; give one of compliance and stiffness"
    return None


@dataclass(frozen=True, kw_only=True)
class SupportSection(Section):
    """[pinion.support], [wheel.support]: how far a gear gives way as a whole."""

    compliance: tuple[tuple[float, ...], ...] | None = key(
        Grid(Number(-SOFTEST_mm_per_N, SOFTEST_mm_per_N), 6, 6),
        "motions [mm, rad] of the gear under unit forces [N] and moments [N mm] on it: x, y, z and about x, y, z of "
        "the gear's own frame, which does not turn, at the middle of the face on its axis (bevel gears: of the mean "
        "pitch circle); 6 lists of 6; zeros: rigid",
        None,
        "by `stiffness`",
    )
    stiffness: tuple[tuple[float, ...], ...] | None = key(
        Grid(Number(-STIFFEST_N_per_mm, STIFFEST_N_per_mm), 6, 6),
        "or the inverse of `compliance`, forces [N] and moments [N mm] by unit motions [mm, rad]; all six are held",
        None,
        "by `compliance`",
    )

    rules: ClassVar[tuple[Rule, ...]] = (
        Rule(("compliance", "stiffness"), _one_matrix),
        Rule(("compliance",), lambda rows: None if rows is None else fault_of_matrix(rows, definite=False)),
        Rule(("stiffness",), lambda rows: None if rows is None else fault_of_matrix(rows, definite=True)),
    )

    @property
    def matrix(self) -> Array:
        """The compliance (6, 6) [mm, rad, N, N mm], symmetric to the last digit."""
        if self.compliance is not None:
            matrix = np.array(self.compliance)
            return np.asarray(0.5 * (matrix + matrix.T))
        relative, roots = scaled(np.array(self.stiffness))
        inverse = np.linalg.inv(0.5 * (relative + relative.T)) / np.outer(roots, roots)
        return np.asarray(0.5 * (inverse + inverse.T))


PLACE_mm = Number(-100000.0, 100000.0)
LENGTH_mm = above_zero(100000.0)
STIFFNESS = Number(0.0, 1e9)
FORCE = Number(-1e9, 1e9)
MOST_PARTS = 200
ELEMENTS = Whole(3, 1000)
GROOVE = Number(0.5, 1.0, above=True)


def _inner_below_outer(inner: float, outer: float) -> str | None:
    return f"found {plain(inner, 6)}; allowed below outer_diameter_mm = {plain(outer, 6)}" if inner >= outer else None


@dataclass(frozen=True, kw_only=True)
class PartOfShaft(Section):
    """A cylindrical part of a shaft."""

    length_mm: float = key(LENGTH_mm, "length of the part")
    outer_diameter_mm: float = key(LENGTH_mm, "outer diameter; under the teeth the diameter of the body or the root")
    inner_diameter_mm: float = key(Number(0.0, 100000.0), "inner diameter; 0: solid", 0.0)

    rules: ClassVar[tuple[Rule, ...]] = (Rule(("inner_diameter_mm", "outer_diameter_mm"), _inner_below_outer),)


OF_TYPES = {
    "ball": ("balls", "ball_diameter_mm", "pitch_diameter_mm"),
    "roller": ("rollers", "roller_diameter_mm", "roller_length_mm", "pitch_diameter_mm"),
}
"""Type of a rolling bearing -> the keys that it must have."""
OF_BALLS, OF_ROLLERS = ("balls", "ball_diameter_mm"), ("rollers", "roller_diameter_mm", "roller_length_mm")
GROOVES = ("inner_groove_ratio", "outer_groove_ratio")
OF_ROLLING = (
    "pitch_diameter_mm",
    "contact_angle_deg",
    "side",
    "radial_clearance_um",
    "preload_um",
    "dynamic_load_rating_N",
)
LINEAR = ("stiffness", "radial_stiffness_N_per_um", "axial_stiffness_N_per_um", "tilting_stiffness_Nm_per_mrad")
KEYS_OF_TYPE = {
    None: LINEAR,
    "ball": (*OF_BALLS, *GROOVES, *OF_ROLLING),
    "roller": (*OF_ROLLERS, *OF_ROLLING),
}


def _keys_of_type(kind: str | None, *values: object) -> str | None:
    """What is missing of a type of bearing, or belongs to another one."""
    given = [name for name, value in zip(OF_ANY, values, strict=True) if value not in (None, 0.0)]
    named = "not given, a linear bearing" if kind is None else f'found "{kind}"'
    if others := [name for name in given if name not in KEYS_OF_TYPE[kind]]:
        return f"{named}, beside {', '.join(others)}; allowed with it {', '.join(KEYS_OF_TYPE[kind])}"
    if missing := [name for name in OF_TYPES.get(kind or "", ()) if name not in given]:
        return f"{named}, without {', '.join(missing)}; it needs {', '.join(OF_TYPES[kind or ''])}"
    return None


OF_ANY = (*LINEAR, *OF_BALLS, *GROOVES, *OF_ROLLERS, *OF_ROLLING)


def _stiffness(
    kind: str | None, matrix: tuple[tuple[float, ...], ...] | None, radial: float | None, axial: float, tilting: float
) -> str | None:
    if kind is not None:
        return None
    if (matrix is None) == (radial is None):
        return f"{'missing' if matrix is None else 'found'}; give one of stiffness and radial_stiffness_N_per_um"
    if matrix is None:
        return None
    if axial or tilting:
        return "found beside axial_stiffness_N_per_um or tilting_stiffness_Nm_per_mrad; the matrix has them"
    if {len(matrix), len(matrix[0])} not in ({5}, {6}):
        return f"found {len(matrix)} lists of {len(matrix[0])} values; allowed 5 lists of 5, or 6 of 6"
    return fault_of_matrix(whole_matrix(matrix), definite=False)


def _fitting(count: int | None, diameter: float | None, pitch: float | None) -> str | None:
    """Elements that would touch each other."""
    if count is None or diameter is None or pitch is None:
        return None
    largest = pitch * math.sin(math.pi / count)
    if diameter < largest:
        return None
    return (
        f"found {plain(diameter, 6)}; {count} elements on {plain(pitch, 6)} mm would touch: allowed below "
        f"{plain(largest)}"
    )


def _side(side: int | None, angle: float | None, preload: float | None) -> str | None:
    if side is None and angle:
        return (
            f"missing; a contact angle of {plain(angle, 6)} takes thrust one way: give 1 if the shaft pushes "
            "along z, else -1"
        )
    if side is None and preload:
        return "missing; a preload presses the shaft along z with 1, against it with -1"
    return None


def _preload(preload: float | None, kind: str | None, angle: float | None) -> str | None:
    if preload and kind == "roller" and not angle:
        return (
            f"found {plain(preload, 6)}; cylindrical rollers have none along the axis: give radial_clearance_um below 0"
        )
    return None


def whole_matrix(rows: tuple[tuple[float, ...], ...]) -> tuple[tuple[float, ...], ...]:
    """A matrix of 6 rows: one of 5 has nothing about the axis."""
    if len(rows) == 6:
        return rows
    return (*((*row, 0.0) for row in rows), (0.0,) * 6)


@dataclass(frozen=True, kw_only=True)
class BearingSection(Section):
    """A bearing of a shaft: linear, or a rolling bearing by its inner geometry."""

    at_mm: float = key(PLACE_mm, "place of the bearing, in the axial coordinate of the gear")
    type: str | None = key(
        Choice(("ball", "roller")),
        "a row of balls (deep groove, or angular contact with a contact angle) or of rollers (cylindrical, or tapered "
        "with one)",
        None,
        "linear",
    )
    radial_stiffness_N_per_um: float | None = key(STIFFNESS, "linear: radial stiffness", None, "by `stiffness`")
    axial_stiffness_N_per_um: float = key(STIFFNESS, "linear: axial stiffness, in both directions", 0.0)
    tilting_stiffness_Nm_per_mrad: float = key(STIFFNESS, "linear: stiffness against tilting about x and y", 0.0)
    stiffness: tuple[tuple[float, ...], ...] | None = key(
        Grid(Number(-STIFFEST_N_per_mm, STIFFEST_N_per_mm), 5, 6),
        "linear, or the whole matrix: forces [N] and moments [N mm] on the bearing by motions [mm, rad], x, y, z, "
        "about x, about y (and z) of the gear's own frame; 5 lists of 5, or 6 of 6",
        None,
        "by the three keys before",
    )
    balls: int | None = key(ELEMENTS, "balls: how many; the first one is on the x axis of the gear's own frame", None)
    ball_diameter_mm: float | None = key(LENGTH_mm, "balls: diameter", None)
    inner_groove_ratio: float | None = key(
        GROOVE, "balls: radius of the groove of the inner ring over the diameter of a ball", None, "0.52"
    )
    outer_groove_ratio: float | None = key(
        GROOVE, "balls: radius of the groove of the outer ring over the diameter of a ball", None, "0.53"
    )
    rollers: int | None = key(ELEMENTS, "rollers: how many; the first one is on the x axis of the gear's frame", None)
    roller_diameter_mm: float | None = key(LENGTH_mm, "rollers: diameter, of tapered ones in the middle", None)
    roller_length_mm: float | None = key(LENGTH_mm, "rollers: effective length", None)
    pitch_diameter_mm: float | None = key(LENGTH_mm, "balls and rollers: diameter of the circle of their middles", None)
    contact_angle_deg: float | None = key(
        Number(0.0, 45.0), "balls and rollers: angle of the line of contact against the radial plane", None, "0"
    )
    side: int | None = key(
        Choice((1, -1)),
        "sense of the shaft thrust that a bearing with a contact angle takes: 1 along z of the gear's own frame, -1 "
        "against it; without a contact angle the sense of its preload",
        None,
    )
    radial_clearance_um: float | None = key(
        Number(-1000.0, 1000.0),
        "balls and rollers: radial clearance of the mounted bearing; below 0: pressed",
        None,
        "0",
    )
    preload_um: float | None = key(
        Number(-1000.0, 1000.0),
        "balls and tapered rollers: axial displacement that presses the rings together, in the sense of "
        "`side`; below 0: apart",
        None,
        "0",
    )
    dynamic_load_rating_N: float | None = key(
        above_zero(1e9),
        "balls and rollers: basic dynamic radial load rating, for the life",
        None,
        "that of the geometry after ISO 281",
    )

    rules: ClassVar[tuple[Rule, ...]] = (
        Rule(("type", *OF_ANY), _keys_of_type),
        Rule(
            (
                "stiffness",
                "type",
                "radial_stiffness_N_per_um",
                "axial_stiffness_N_per_um",
                "tilting_stiffness_Nm_per_mrad",
            ),
            lambda matrix, kind, *others: _stiffness(kind, matrix, *others),
        ),
        Rule(("ball_diameter_mm", "balls", "pitch_diameter_mm"), lambda own, count, pitch: _fitting(count, own, pitch)),
        Rule(
            ("roller_diameter_mm", "rollers", "pitch_diameter_mm"),
            lambda own, count, pitch: _fitting(count, own, pitch),
        ),
        Rule(("side", "contact_angle_deg", "preload_um"), _side),
        Rule(("preload_um", "type", "contact_angle_deg"), _preload),
    )


@dataclass(frozen=True, kw_only=True)
class ShaftLoadSection(Section):
    """A load of something else on a shaft: a further gear, a belt, weight."""

    at_mm: float = key(PLACE_mm, "place of the load, in the axial coordinate of the gear")
    force_N: tuple[float, ...] = key(List(FORCE, 3, 3), "force along x, y, z of the gear's own frame", (0.0, 0.0, 0.0))
    moment_Nm: tuple[float, ...] = key(List(FORCE, 3, 3), "moment about x, y, z", (0.0, 0.0, 0.0))


@dataclass(frozen=True, kw_only=True)
class ShaftSection(Section):
    """[pinion.shaft], [wheel.shaft]: what the gear sits on, instead of its support."""

    start_mm: float = key(
        PLACE_mm,
        "lower end, in the axial coordinate of the gear: 0 at mid-face; double helical gears: in mid-groove; bevel "
        "gears: apex",
    )
    torque_at_mm: float = key(PLACE_mm, "where the torque enters or leaves: the rotation about the axis is given there")
    gear: str = key(
        Choice(("rigid", "along")),
        "how the gear moves: as a whole, with the shaft at its middle, or its teeth with the shaft over the face "
        "(cylindrical gears)",
        "rigid",
    )
    sections: tuple[PartOfShaft, ...] = key(
        Tables(PartOfShaft, 1, MOST_PARTS),
        "parts from the lower end on, of the material of the gear: `{length_mm, outer_diameter_mm, "
        "inner_diameter_mm = 0.0}` each",
    )
    bearings: tuple[BearingSection, ...] = key(
        Tables(BearingSection, 1, MOST_PARTS),
        "bearings, each a table `[[pinion.shaft.bearings]]` of `at_mm`, `radial_stiffness_N_per_um`, "
        "`axial_stiffness_N_per_um = 0.0`, `tilting_stiffness_Nm_per_mrad = 0.0`, or with `stiffness`, 5 x 5 or 6 x 6 "
        '[N, mm, rad], instead of the three; or a rolling bearing: `type = "ball"` with `balls`, `ball_diameter_mm`, '
        '`pitch_diameter_mm`, `inner_groove_ratio = 0.52`, `outer_groove_ratio = 0.53`, or `type = "roller"` with '
        "`rollers`, `roller_diameter_mm`, `roller_length_mm`, `pitch_diameter_mm`, both with `contact_angle_deg = 0`, "
        "`side` (1 or -1, the thrust along z that it takes), `radial_clearance_um = 0.0`, `preload_um = 0.0` and "
        "`dynamic_load_rating_N`, by default that of the geometry",
    )
    loads: tuple[ShaftLoadSection, ...] = key(
        Tables(ShaftLoadSection, 0, MOST_PARTS),
        "other loads on the shaft, each a table `[[pinion.shaft.loads]]` of `at_mm`, `force_N` and `moment_Nm`, three "
        "numbers each, axes of the gear's own frame",
        (),
    )

    def diameter_at(self, place: float) -> float | None:
        """Return the outer diameter at an axial coordinate of the gear, of two parts that meet there the smaller [mm].

        None beyond the shaft.
        """
        return min(self.diameters_between(place, place), default=None)

    def diameters_between(self, low: float, high: float) -> list[float]:
        """Outer diameters of the parts between two axial coordinates of the gear [mm]."""
        ends = self.start_mm + np.cumsum([0.0, *(part.length_mm for part in self.sections)])
        here = (ends[:-1] <= high) & (low <= ends[1:])
        return [part.outer_diameter_mm for part, inside in zip(self.sections, here, strict=True) if inside]

    @staticmethod
    def matrix_of(bearing: BearingSection) -> np.ndarray:
        """Stiffness (6, 6) of a bearing [N, N mm over mm, rad]."""
        if bearing.stiffness is not None:
            matrix = np.array(whole_matrix(bearing.stiffness))
            return np.asarray(0.5 * (matrix + matrix.T))
        radial, axial = 1e3 * (bearing.radial_stiffness_N_per_um or 0.0), 1e3 * bearing.axial_stiffness_N_per_um
        tilting = 1e6 * bearing.tilting_stiffness_Nm_per_mrad
        return np.diag([radial, radial, axial, tilting, tilting, 0.0])
