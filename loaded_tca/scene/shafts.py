"""[pinion.shaft] and [wheel.shaft]: the shaft of a gear, its sections, bearings and other loads."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from loaded_tca.scene.keys import Choice, Grid, List, Number, above_zero, key
from loaded_tca.scene.section import Rule, Section, Tables
from loaded_tca.scene.supports import STIFFEST_N_per_mm, fault_of_matrix

# ruff: noqa: N815  -- names are the keys of the file, units included

PLACE_mm = Number(-100000.0, 100000.0)
LENGTH_mm = above_zero(100000.0)
STIFFNESS = Number(0.0, 1e9)
FORCE = Number(-1e9, 1e9)
MOST_PARTS = 200


def _inner_below_outer(inner: float, outer: float) -> str | None:
    return f"found {inner:g}; allowed below outer_diameter_mm = {outer:g}" if inner >= outer else None


@dataclass(frozen=True, kw_only=True)
class PartOfShaft(Section):
    """A cylindrical part of a shaft."""

    length_mm: float = key(LENGTH_mm, "its length")
    outer_diameter_mm: float = key(LENGTH_mm, "its outer diameter; under the teeth that of the body or of the root")
    inner_diameter_mm: float = key(Number(0.0, 100000.0), "its inner diameter; 0: solid", 0.0)

    rules: ClassVar[tuple[Rule, ...]] = (Rule(("inner_diameter_mm", "outer_diameter_mm"), _inner_below_outer),)


def _stiffness(
    matrix: tuple[tuple[float, ...], ...] | None, radial: float | None, axial: float, tilting: float
) -> str | None:
    if (matrix is None) == (radial is None):
        return f"{'missing' if matrix is None else 'found'}; give one of stiffness and radial_stiffness_N_per_um"
    if matrix is None:
        return None
    if axial or tilting:
        return "found beside axial_stiffness_N_per_um or tilting_stiffness_Nm_per_mrad; the matrix has them"
    if {len(matrix), len(matrix[0])} not in ({5}, {6}):
        return f"found {len(matrix)} lists of {len(matrix[0])} values; allowed 5 lists of 5, or 6 of 6"
    return fault_of_matrix(whole_matrix(matrix), definite=False)


def whole_matrix(rows: tuple[tuple[float, ...], ...]) -> tuple[tuple[float, ...], ...]:
    """A matrix of 6 rows: one of 5 has nothing about the axis."""
    if len(rows) == 6:
        return rows
    return (*((*row, 0.0) for row in rows), (0.0,) * 6)


@dataclass(frozen=True, kw_only=True)
class BearingSection(Section):
    """A bearing of a shaft, linear."""

    at_mm: float = key(PLACE_mm, "its place, in the axial coordinate of the gear")
    radial_stiffness_N_per_um: float | None = key(STIFFNESS, "radial stiffness", None, "by `stiffness`")
    axial_stiffness_N_per_um: float = key(STIFFNESS, "axial stiffness, in both directions", 0.0)
    tilting_stiffness_Nm_per_mrad: float = key(STIFFNESS, "stiffness against tilting about x and y", 0.0)
    stiffness: tuple[tuple[float, ...], ...] | None = key(
        Grid(Number(-STIFFEST_N_per_mm, STIFFEST_N_per_mm), 5, 6),
        "or all of it: forces [N] and moments [N mm] on the bearing by motions [mm, rad], x, y, z, about x, about y "
        "(and z) of the gear's own frame; 5 lists of 5, or 6 of 6",
        None,
        "by the three before",
    )

    rules: ClassVar[tuple[Rule, ...]] = (
        Rule(
            ("stiffness", "radial_stiffness_N_per_um", "axial_stiffness_N_per_um", "tilting_stiffness_Nm_per_mrad"),
            _stiffness,
        ),
    )


@dataclass(frozen=True, kw_only=True)
class ShaftLoadSection(Section):
    """A load of something else on a shaft: a further gear, a belt, weight."""

    at_mm: float = key(PLACE_mm, "its place, in the axial coordinate of the gear")
    force_N: tuple[float, ...] = key(List(FORCE, 3, 3), "force along x, y, z of the gear's own frame", (0.0, 0.0, 0.0))
    moment_Nm: tuple[float, ...] = key(List(FORCE, 3, 3), "moment about x, y, z", (0.0, 0.0, 0.0))


@dataclass(frozen=True, kw_only=True)
class ShaftSection(Section):
    """[pinion.shaft], [wheel.shaft]: what the gear sits on, instead of its support."""

    start_mm: float = key(PLACE_mm, "lower end, in the axial coordinate of the gear: 0 at mid-face; bevel gears: apex")
    torque_at_mm: float = key(PLACE_mm, "where the torque enters or leaves: the rotation about the axis is given there")
    gear: str = key(
        Choice(("rigid", "along")),
        "how the gear moves: as a whole, with the shaft at its middle, or its teeth with the shaft over the face "
        "(cylindrical gears)",
        "rigid",
    )
    sections: tuple[PartOfShaft, ...] = key(
        Tables(PartOfShaft, 1, MOST_PARTS),
        "its parts from the lower end on, of the material of the gear: `{length_mm, outer_diameter_mm, "
        "inner_diameter_mm = 0.0}` each",
    )
    bearings: tuple[BearingSection, ...] = key(
        Tables(BearingSection, 1, MOST_PARTS),
        "its bearings, each a table `[[pinion.shaft.bearings]]` of `at_mm`, `radial_stiffness_N_per_um`, "
        "`axial_stiffness_N_per_um = 0.0`, `tilting_stiffness_Nm_per_mrad = 0.0`, or with `stiffness`, 5 x 5 or 6 x 6 "
        "[N, mm, rad], instead of the three",
    )
    loads: tuple[ShaftLoadSection, ...] = key(
        Tables(ShaftLoadSection, 0, MOST_PARTS),
        "other loads on it, each a table `[[pinion.shaft.loads]]` of `at_mm`, `force_N` and `moment_Nm`, three numbers "
        "each, axes of the gear's own frame",
        (),
    )

    @staticmethod
    def matrix_of(bearing: BearingSection) -> np.ndarray:
        """Stiffness (6, 6) of a bearing [N, N mm over mm, rad]."""
        if bearing.stiffness is not None:
            matrix = np.array(whole_matrix(bearing.stiffness))
            return np.asarray(0.5 * (matrix + matrix.T))
        radial, axial = 1e3 * (bearing.radial_stiffness_N_per_um or 0.0), 1e3 * bearing.axial_stiffness_N_per_um
        tilting = 1e6 * bearing.tilting_stiffness_Nm_per_mrad
        return np.diag([radial, radial, axial, tilting, tilting, 0.0])
