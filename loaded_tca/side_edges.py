"""Where the sides of the teeth cut a contact: the free edges of its grid."""

from __future__ import annotations

import numpy as np

from loaded_tca.contact.edges import FreeEdge, edge_of_plane, quarter_space_factor
from loaded_tca.errors import InputError
from loaded_tca.flanks.jet import Array
from loaded_tca.pair import GearPair, cylindrical_basis
from loaded_tca.separation import Separation
from loaded_tca.unloaded import ContactPoint

SIDES = slice(2, 4)
"""The sides among the borders of a flank: its tip is blunter than the right angle of a quarter-space."""
REACH = 2.0
"""Distance of a side over the half length of the box beyond which it is out of reach."""
SAME = 1e-6
"""Distance between sides of both gears, over the module, that is none: both end there."""


def side_edges(pair: GearPair, contact: ContactPoint, separation: Separation) -> tuple[FreeEdge, ...]:
    """Free edges that the sides of both gears make in the grid of a contact.

    A side is the plane that touches its surface beside the contact; a toe or heel sphere is nearly one there.

    Parameters
    ----------
    pair : GearPair
    contact : ContactPoint
    separation : Separation
        Its box tells which sides are in reach.

    Returns
    -------
    tuple of FreeEdge

    Raises
    ------
    InputError
        If a side in reach crosses the grid at more than 30 degrees to both axes.
    """
    planes = [_sides(pair, contact, member) for member in (0, 1)]
    found = []
    for member in (0, 1):
        for normal, distance in planes[member]:
            both = any(
                abs(distance - other) <= SAME * pair.module and normal @ n > 0.0 for n, other in planes[1 - member]
            )
            if both and member == 1:
                continue
            edge = _edge(pair, separation, member, (normal, distance), both)
            found += [] if edge is None else [edge]
    return tuple(found)


def _edge(
    pair: GearPair, separation: Separation, member: int, plane: tuple[Array, float], both: bool
) -> FreeEdge | None:
    """The edge of one side, if it is in reach; ``both``: the mate ends there, too."""
    x, y, z = (float(part) for part in separation.axes @ plane[0])
    axis = 0 if abs(x) > abs(y) else 1
    if plane[1] > REACH * abs((x, y)[axis]) * separation.half_lengths[axis]:
        return None
    material = pair.materials[member]
    share = pair.contact_modulus * (1.0 - material.poisson_ratio**2) / material.youngs_modulus
    factor = quarter_space_factor(material.poisson_ratio, 1.0 if both else share)
    shape = (separation.gap.shape[0], separation.gap.shape[1])
    try:
        return edge_of_plane((x, y, z), plane[1], separation.spacing, shape, factor)
    except InputError as error:
        raise InputError(f"free_edges: {problem}" for problem in error.problems) from None


def _sides(pair: GearPair, contact: ContactPoint, member: int) -> list[tuple[Array, float]]:
    """Normal out of the material (3,) in the fixed frame and distance [mm] of the sides of one gear."""
    if member == 0:
        flank, rho, z = pair.pinion, contact.pinion_radius, contact.pinion_axial
        basis = cylindrical_basis(np.arctan2(contact.point[1], contact.point[0]))
    else:
        flank, rho, z = pair.wheel, contact.wheel_radius, contact.wheel_axial
        basis = pair.wheel_basis(pair.to_wheel(contact.point)[1])
    sides = []
    for jet in flank.borders(np.asarray(rho), np.asarray(z))[SIDES]:
        inwards = float(jet.rho) * basis[0] + float(jet.z) * basis[2]
        steep = float(np.linalg.norm(inwards))
        sides.append((-inwards / steep, float(jet.value) / steep))
    return sides
