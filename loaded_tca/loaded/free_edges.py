"""Where tip edges and face ends of the teeth cut a contact: the free edges of its grid."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.contact.edges import MOST_OBLIQUE, FreeEdge, edge_of_plane, wedge_factor
from loaded_tca.errors import named
from loaded_tca.flanks.base import outward_normal
from loaded_tca.pairs.gear_pair import GearPair, cylindrical_basis
from loaded_tca.separation import Separation
from loaded_tca.unloaded import ContactPoint

ENDS = (0, 2, 3)
"""The edges of a flank where the tooth ends, its tip edge and its face ends; at the root it goes on as the fillet."""
REACH_ALONG = 2.0
"""Distance of an edge across the contact over the half length of the box up to which it counts in full; at twice that
it is out of reach."""
REACH_BESIDE = 0.5
"""The same of an edge along the contact, over the module. What it adds to the approach falls with the logarithm of the
distance only, as long as that is short against the contact; a tooth is no longer a wedge at half a module from its
tip. From half of that on the factor fades out, so that the approach has no step where a tip comes into reach."""
FARTHEST = 20.0
"""Distance of such an edge, over the half width of the box, from which on it fades too: light contacts are narrow."""
STRAIGHT_WITHIN = 0.1
"""How far an edge along the contact leaves its direction over the half length of the box, over the half width, if it is
taken to be straight."""
STEPS = 3
"""Tangent planes taken until one stands where an oblique tip edge crosses the contact."""
SAME = 1e-6
"""Distance between ends of both gears, over the module, that is none: both end there."""


def tooth_edges(pair: GearPair, contact: ContactPoint, separation: Separation) -> tuple[FreeEdge, ...]:
    """Free edges that tip edges and face ends of both gears make in the grid of a contact.

    A tip edge or face end is the tangent plane of its surface beside the contact; tip cylinder, face cone and the
    spheres of toe and heel are nearly planes there. Its factor is that of the angle between flank and surface. Edges
    along the contact keep their angle to it, as the tip of a helical tooth has one; those across it are narrow there
    and taken to be straight. Edges more than 30 degrees off both axes are left out, see :func:`oblique_ends`.

    Parameters
    ----------
    pair : GearPair
    contact : ContactPoint
    separation : Separation
        Its box tells which edges are in reach.

    Returns
    -------
    tuple of FreeEdge

    Raises
    ------
    InputError
        If a tooth ends at an edge sharper than 30 degrees.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> from loaded_tca.separation import sample_separation
    >>> from loaded_tca.unloaded import trace_contact
    >>> mesh = CylindricalMesh(*(CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)))
    >>> pair = cylindrical_pair(mesh)
    >>> contact = trace_contact(pair, [0.0])[0]
    >>> separation = sample_separation(pair, contact, cells=(16, 16), load=2700.0)
    >>> [(edge.axis, edge.material, round(edge.factor, 3)) for edge in tooth_edges(pair, contact, separation)]
    [(1, 'above', 1.745), (1, 'below', 1.745)]
    """
    ends = _ends(pair, contact, separation)
    edges = []
    for end in ends:
        beside = [other for other in ends if abs(end.distance - other.distance) <= SAME * pair.module]
        mating = [other for other in beside if other.member != end.member and float(end.normal @ other.normal) > 0.0]
        if end.weight == 0.0 or end.oblique or any(mating.member < end.member for mating in mating):
            continue
        factor = end.weight * sum(_factor(pair, body) for body in (end, *mating))
        x, y, z = (float(part) for part in separation.axes @ end.normal)
        shape = (separation.gap.shape[0], separation.gap.shape[1])
        edges.append(edge_of_plane((x, y, z), end.distance, separation.spacing, shape, factor, end.straight))
    return tuple(edges)


def oblique_ends(pair: GearPair, contact: ContactPoint, separation: Separation) -> tuple[str, ...]:
    """Names of the tip edges and face ends in reach that are more than 30 degrees off both axes of the grid.

    Parameters
    ----------
    pair : GearPair
    contact : ContactPoint
    separation : Separation

    Returns
    -------
    tuple of str
        Such as "tip circle of the pinion".
    """
    ends = _ends(pair, contact, separation)
    return tuple(end.name for end in ends if end.oblique and end.weight > 0.0)


@dataclass(frozen=True, eq=False)
class _End:
    """Tip edge or face end of a gear: a plane beside the contact, and how it crosses the grid.

    ``normal`` (3,) in the fixed frame, out of the material; ``distance`` of the contact point from it [mm]; ``angle``
    of the material between flank and plane [rad]; ``weight``, 0 to 1, how much of its factor counts.
    """

    member: int
    name: str
    normal: Array
    distance: float
    angle: float
    weight: float = 0.0
    oblique: bool = False
    straight: bool = True


def _ends(pair: GearPair, contact: ContactPoint, separation: Separation) -> list[_End]:
    """Tip edges and face ends of both gears, each where its surface crosses the long axis of the contact."""
    found, (_, reach) = [], separation.half_lengths
    for place in product((0, 1), ENDS):
        point = contact.point
        for _ in range(STEPS):
            end = _crossing(pair, separation, _plane(pair, contact.point, point, place))
            if end.straight:
                break
            along = min(max(end.distance / float(separation.axes[1] @ end.normal), -reach), reach)
            point = contact.point + along * separation.axes[1]
        found.append(end)
    return found


def _plane(pair: GearPair, origin: Array, point: Array, place: tuple[int, int]) -> _End:
    """Tangent plane at an edge of a gear beside a point."""
    member, edge = place
    if member == 0:
        flank, rho, z = pair.pinion.flank, math.hypot(point[0], point[1]), float(point[2])
        basis = cylindrical_basis(np.arctan2(point[1], point[0]))
    else:
        radius, theta, axial = pair.to_wheel(point)
        flank, rho, z, basis = pair.wheel.flank, float(radius), float(axial), pair.wheel_basis(theta)
    jet = flank.edges(np.asarray(rho), np.asarray(z))[edge]
    value, inwards = float(jet.value), np.array([float(jet.rho), 0.0, float(jet.z)])
    steep = float(np.linalg.norm(inwards))
    at_edge = np.array([rho, 0.0, z]) - value / steep**2 * inwards
    flank_normal = outward_normal(flank, at_edge[0], at_edge[2])
    angle = math.acos(float(np.clip(flank_normal @ inwards / steep, -1.0, 1.0)))
    normal = -inwards @ basis / steep
    name = f"{flank.frame.edges[edge]} of the {('pinion', 'wheel')[member]}"
    return _End(member, name, normal, float(value / steep + normal @ (point - origin)), angle)


def _crossing(pair: GearPair, separation: Separation, end: _End) -> _End:
    """The end with how it crosses the grid."""
    x, y, _ = (float(part) for part in separation.axes @ end.normal)
    across, along = separation.half_lengths
    flattest, steepest = sorted((abs(x), abs(y)))
    oblique = not flattest <= math.tan(MOST_OBLIQUE) * steepest > 0.0
    nearest, straight, reach = end.distance, True, REACH_ALONG * abs(y) * along
    if abs(x) > abs(y):
        aside = abs(y) * along
        straight = aside <= STRAIGHT_WITHIN * abs(x) * across
        nearest -= 0.0 if straight else aside
        reach = abs(x) * min(0.5 * REACH_BESIDE * pair.module, FARTHEST * across)
    weight = min(max(2.0 - nearest / reach, 0.0), 1.0)  # 1 up to its reach, none from twice that on
    return replace(end, weight=weight, oblique=oblique, straight=straight)


def _factor(pair: GearPair, end: _End) -> float:
    """Factor of the mirrored pressure for the body that ends."""
    material = (pair.pinion, pair.wheel)[end.member].material
    share = pair.contact_modulus * (1.0 - material.poisson_ratio**2) / material.youngs_modulus
    with named(f"analysis.free_edges: {end.name}"):
        return wedge_factor(end.angle, material.poisson_ratio, min(share, 1.0))
