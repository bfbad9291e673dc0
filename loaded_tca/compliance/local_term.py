r"""What the flank of a tooth gives way locally, more than a half-plane does down to the same depth.

In the middle section of a whole ring, strain being plane, a line force on the flank makes the field of a half-plane,
which is infinite under the force, and a smooth rest:

.. math:: u = u_H + u_R,\qquad \sigma_R n = -\sigma_H n \text{ on the border},\qquad u_R = -u_H \text{ in the bore}.

Only the rest is left to finite elements, which is why a moderate mesh is enough; the local term is what it gives
between the flank and the middle of the tooth along the normal.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array, Indices
from loaded_tca.compliance.body import GearTooth, factorised
from loaded_tca.compliance.finite_elements import Discretisation, discretise
from loaded_tca.compliance.half_space import line_force
from loaded_tca.compliance.layout import MeshDensity

DENSITY = MeshDensity(through=8, flank=12, fillet=4, land=4, rim=6, lengthwise=1, neighbours=0)
"""Of the middle section: twice as fine gives the same to 1 %. Without neighbours the cut of the half-plane's field,
outwards from the force, meets nothing."""
SLOPE = np.array([1.0, -8.0, 0.0, 8.0, -1.0]) / 12.0
"""Derivative at the middle one of five even steps."""


@dataclass(frozen=True, eq=False)
class LocalFlexibility:
    """Local term against the height on the flank.

    Attributes
    ----------
    height : (n,) array
        Part of the flank's height, increasing.
    value : (n,) array [mm per N/mm]
    """

    height: Array
    value: Array

    def at(self, height: Array) -> Array:
        """Values (m,) at heights (m,); beyond the first and the last one theirs."""
        return np.interp(height, self.height, self.value)


def local_flexibility(gear: GearTooth, side: int, density: MeshDensity = DENSITY) -> LocalFlexibility:
    """Local term of the middle section.

    Parameters
    ----------
    gear : GearTooth
    side : int
        s of the flank in contact.
    density : MeshDensity
        Lengthwise elements are of no account.
    """
    nodes, material = gear.nodes(density), gear.material
    radius, angle = (values[:, :, density.lengthwise] for values in (nodes.radius, nodes.angle))
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)
    mesh = discretise(points, nodes.layout.elements)
    left = nodes.layout.sector(0).first + 2 * density.land
    flank = mesh.number[left + (2 * density.through if side > 0 else 0)]
    middle, held = mesh.number[left + density.through], mesh.number[:, 0]
    first = nodes.layout.base_row + 2 * density.fillet
    rows = first + np.arange(2, 2 * density.flank - 1, 2)
    border, normals, edges, shares = _border(mesh)
    loads, lift = np.zeros((2, *mesh.points.shape, len(rows)))
    forces = []
    for n, row in enumerate(rows):  # a unit force normal to the flank at each
        near = mesh.points[flank[row - 2 : row + 3]]
        tangent = SLOPE @ near
        normal = np.array([tangent[1], -tangent[0]]) / np.hypot(*tangent)
        normal *= np.sign(normal @ (mesh.points[middle[row]] - near[2]))
        axes = np.stack([normal, [-normal[1], normal[0]]])
        stress = axes.T @ line_force((border - near[2]) @ axes.T, material)[1] @ axes
        traction = -np.einsum("eqab,eqb->eqa", stress, normals)
        np.add.at(loads[..., n], edges, np.einsum("qk,eqa->eka", shares, traction))
        lift[held, :, n] = -line_force((mesh.points[held] - near[2]) @ axes.T, material)[0] @ axes
        forces.append((flank[row], near[2], normal))
    loads, lift = loads.reshape(-1, len(rows)), lift.reshape(-1, len(rows))
    factor, matrices = factorised(mesh, material)
    np.subtract.at(loads, mesh.dofs, matrices[mesh.kinds] @ lift[mesh.dofs])
    rest = (factor.solve(loads) + lift).reshape(-1, 2, len(rows))
    line = mesh.points[middle]
    radius = np.hypot(line[:, 0], line[:, 1])
    along, value = line[-1] / radius[-1], np.empty(len(rows))
    for n, (node, point, normal) in enumerate(forces):  # at the force, less below it in the middle of the tooth
        depth = -_cross(point, along) / _cross(normal, along)
        place = float(np.hypot(*(point + depth * normal)))
        value[n] = normal @ (rest[node, :, n] - [np.interp(place, radius, rest[middle, a, n]) for a in range(2)])
    return LocalFlexibility((rows - first) / (2.0 * density.flank), value)


def _cross(a: Array, b: Array) -> float:
    return float(a[0] * b[1] - a[1] * b[0])


def _border(mesh: Discretisation) -> tuple[Array, Array, Indices, Array]:
    """Free border: points (e, q, 2), normals times weights (e, q, 2), nodes (e, 3), shape functions (q, 3)."""
    offsets = np.array([[(0, k) for k in range(3)], [(2, k) for k in range(3)]])
    offsets = np.concatenate([offsets, offsets[..., ::-1]])[:, None]  # nodes along the four edges of an element
    place = mesh.lowest[:, None] + offsets
    edges = mesh.number[place[..., 0] % len(mesh.number), place[..., 1]].reshape(-1, 3)
    middles = np.tile(mesh.points[mesh.elements].mean(axis=1), (len(offsets), 1))
    once = np.flatnonzero(np.bincount(edges[:, 1], minlength=len(mesh.points))[edges[:, 1]] == 1)
    free = once[~np.isin(edges[once, 1], mesh.number[:, 0])]
    nodes, inner = mesh.points[edges[free]], middles[free]
    places, weights = np.polynomial.legendre.leggauss(4)
    shares = np.stack([0.5 * places * (places - 1.0), 1.0 - places**2, 0.5 * places * (places + 1.0)], axis=-1)
    slopes = np.stack([places - 0.5, -2.0 * places, places + 0.5], axis=-1)
    tangents = np.einsum("qk,eka->eqa", slopes * weights[:, None], nodes)
    normals = np.stack([tangents[..., 1], -tangents[..., 0]], axis=-1)
    outward = np.sign(np.einsum("ea,ea->e", normals.sum(axis=1), nodes[:, 1] - inner))
    return np.einsum("qk,eka->eqa", shares, nodes), normals * outward[:, None, None], edges[free], shares
