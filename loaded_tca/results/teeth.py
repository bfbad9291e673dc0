"""The teeth of a result in contact, with the path of contact and the pressure, for pictures and files."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arrays import Array, index_checks
from loaded_tca.errors import GeometryError, require
from loaded_tca.results.numbers import index_or_largest

if TYPE_CHECKING:
    from loaded_tca.pairs import MatingTeeth
    from loaded_tca.pairs.gear_pair import GearPair
    from loaded_tca.results.mesh_cycle import MeshCycle
    from loaded_tca.tooth import TriangleMesh


@dataclass(frozen=True, eq=False)
class TeethInSpace:
    """One position of a result in space, in the fixed frame.

    Attributes
    ----------
    pair : GearPair
    position, column, torque : int
        Indices in the result, the second one of the tooth pair.
    pinion, wheel : TriangleMesh
        The teeth in contact.
    path : (n, 3) array [mm]
        The unloaded contact points of all positions on the pinion's flank.
    pressure : TriangleMesh
        Cells under pressure on the pinion's flank, ``cell_data["pressure_MPa"]``; none without load.
    point, normal : (3,) array
        The contact point [mm] and the normal out of the pinion.
    mid_faces : (2,) array [mm], optional
        Of a half of a double helical pair: ``mid_face`` of the result; None of other pairs.
    """

    pair: GearPair
    position: int
    column: int
    torque: int
    pinion: TriangleMesh
    wheel: TriangleMesh
    path: Array
    pressure: TriangleMesh
    point: Array
    normal: Array
    mid_faces: Array | None = None

    @property
    def eye(self) -> Array:
        """Unit vector (3,) from which the pinion's flank is seen: along its normal, a little from tip and heel."""
        outward = np.array([self.point[0], self.point[1], 0.0])
        towards: Array = self.normal + 0.6 * outward / np.linalg.norm(outward) + np.array([0.0, 0.0, 0.5])
        return towards / np.linalg.norm(towards)

    @property
    def highest_pressure(self) -> float:
        """Largest pressure of a cell [MPa]; zero without load."""
        return float(self.pressure.cell_data["pressure_MPa"].max(initial=0.0))


def teeth_in_space(
    result: MeshCycle, teeth: MatingTeeth, position: int | None = None, torque: int | None = None
) -> TeethInSpace:
    """Place teeth, path and pressure of one position of a result.

    Parameters
    ----------
    result : MeshCycle
    teeth : MatingTeeth
        Of the scene of the result: ``mating_teeth(scene.pair())``.
    position : int, optional
        Index along the path; default: that of the peak pressure, ``result.peak_contact``.
    torque : int, optional
        Index of the torque; default: the largest one.

    Raises
    ------
    InputError
        If the result has no such torque or position.
    GeometryError
        If nothing is in contact at that position.
    """
    require(*index_checks(torque=(torque, len(result.torque)), position=(position, len(result.path))))
    torque = index_or_largest(result.torque, torque)
    place = result.peak_contact(torque) if position is None else (position, int(result.peak_column[torque, position]))
    one = None if place is None else result.maps[torque][place[0]][place[1]]
    if place is None or one is None:
        raise GeometryError("no teeth in contact: the tooth pair is not in contact at this position")
    position, column = place
    contact, path = result.paths[column][position], result.path[result.path.in_contact]
    pitches = float(result.pair[column]) * teeth.pair.pitch  # teeth are placed as if they met at the pitch point
    pinion_angle = contact.pinion_angle - pitches
    pinion, wheel = teeth.in_mesh(pinion_angle, contact.wheel_angle - teeth.pair.ratio * pitches)
    return TeethInSpace(
        teeth.pair,
        position,
        column,
        torque,
        pinion,
        wheel,
        teeth.on_pinion(path.pinion_radius, path.pinion_axial, pinion_angle),
        teeth.pressure_on_pinion(one.corners, one.pressure, pinion_angle),
        contact.point,
        contact.normal,
        result.values("mid_face") if result.has("mid_face") else None,
    )
