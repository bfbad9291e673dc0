"""Shafts of double helical gears as each half has them: one shaft, counted from the groove outwards, under both halves.

The axial coordinate of a double helical gear is 0 in the middle of its groove, that of a half at its mid-face: half b
is a mirror image in the middle of the groove, and so is its shaft. The loads of the other half are further loads of the
shaft. A gear that floats has no bearing that holds it along its axis; the shaft of each half is held there in the
middle of the groove, because how far the whole gear floats is no motion of the shaft.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.plain import plain
from loaded_tca.scene.shafts import STIFFNESS, BearingSection, ShaftLoadSection, ShaftSection, whole_matrix

MIRRORED = np.array([1.0, 1.0, -1.0, -1.0, -1.0, 1.0])
"""Signs of forces and moments, or of motions, in a mirror image across the axis."""
AXIAL = 2
"""Row of the motion along the axis."""


class HalfLoads(NamedTuple):
    """Loads of the teeth of a half on the shaft of a gear, as the half counts.

    Attributes
    ----------
    places : (m,) array [mm]
        Axial coordinates of the stations.
    loads : (m, 6) array [N, N mm]
        Forces and moments on them, axes of the gear's own frame.
    """

    places: Array
    loads: Array

    def of_other_half(self, lever: float) -> HalfLoads:
        """The same as the other half counts; ``lever``: from the middle of the groove to mid-face [mm]."""
        return HalfLoads(-self.places - 2.0 * lever, self.loads * MIRRORED)


def shaft_of_half(
    shaft: ShaftSection, sign: float, lever: float, *, floats: bool, others: HalfLoads | None = None
) -> ShaftSection:
    """Shaft of a gear as a half has it.

    Parameters
    ----------
    shaft : ShaftSection
        Of the whole gear.
    sign : {1, -1}
        Of z of the pair along that of the half.
    lever : float [mm]
        From the middle of the groove to mid-face.
    floats : bool
        Whether nothing holds the gear along its axis.
    others : HalfLoads, optional
        Loads of the other half, as it counts.
    """

    def at(place: float) -> float:
        return sign * place - lever

    outwards = sign > 0.0
    end = shaft.start_mm + sum(part.length_mm for part in shaft.sections)
    bearings = [bearing if outwards else _mirrored(bearing) for bearing in shaft.bearings]
    bearings = [replace(bearing, at_mm=at(bearing.at_mm)) for bearing in bearings]
    if floats:
        bearings.append(
            BearingSection(at_mm=-lever, radial_stiffness_N_per_um=0.0, axial_stiffness_N_per_um=STIFFNESS.high)
        )
    loads = [
        _load(at(load.at_mm), np.array([*load.force_N, *load.moment_Nm]) * (1.0 if outwards else MIRRORED))
        for load in shaft.loads
    ]
    if others is not None:
        places, forces = others.of_other_half(lever)
        in_units = forces * np.repeat([1.0, 1e-3], 3)
        loads += [_load(place, load) for place, load in zip(places.tolist(), in_units, strict=True) if load.any()]
    return replace(
        shaft,
        start_mm=at(shaft.start_mm if outwards else end),
        torque_at_mm=at(shaft.torque_at_mm),
        sections=shaft.sections if outwards else shaft.sections[::-1],
        bearings=tuple(bearings),
        loads=tuple(loads),
    )


def _load(place: float, load: Array) -> ShaftLoadSection:
    """Load of a shaft: forces [N] and moments [N m]."""
    values = (load + 0.0).tolist()
    return ShaftLoadSection(at_mm=place, force_N=tuple(values[:3]), moment_Nm=tuple(values[3:]))


def _mirrored(bearing: BearingSection) -> BearingSection:
    """A bearing in the mirror image across the axis, at its place."""
    changes: dict[str, Any] = {}
    if bearing.side is not None:
        changes["side"] = -bearing.side
    if bearing.stiffness is not None:
        count = len(bearing.stiffness)
        matrix = np.array(bearing.stiffness) * np.outer(MIRRORED[:count], MIRRORED[:count]) + 0.0
        changes["stiffness"] = tuple(tuple(row) for row in matrix.tolist())
    return replace(bearing, **changes)


def without_other_half(shaft: ShaftSection, of_half: ShaftSection) -> ShaftSection:
    """A shaft of a half without the loads of the other one, which follow its own; ``of_half`` has only these."""
    return replace(shaft, loads=shaft.loads[: len(of_half.loads)])


def holding_bearings(shaft: ShaftSection) -> Sequence[float]:
    """Places of the bearings that hold a shaft along its axis [mm]."""
    return [bearing.at_mm for bearing in shaft.bearings if _holds(bearing)]


def _holds(bearing: BearingSection) -> bool:
    if bearing.type is not None:
        return bearing.type == "ball" or bool(bearing.contact_angle_deg)
    if bearing.stiffness is not None:
        return bool(np.array(whole_matrix(bearing.stiffness))[AXIAL].any())
    return bearing.axial_stiffness_N_per_um > 0.0


def fault_of_floating(shaft: ShaftSection | None) -> str | None:
    """Why the shaft of a gear does not let it float; None: it does."""
    if shaft is None or not (places := holding_bearings(shaft)):
        return None
    at = ", ".join(plain(place, 6) for place in places)
    return (
        f"found bearings at {at} mm that hold the floating gear along its axis; allowed are bearings without axial "
        "stiffness or contact angle, with pair.axial_stiffness_N_per_um for what holds the gear, or pair.floating = "
        '"none"'
    )
