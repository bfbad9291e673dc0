r"""Local compliance of the flank of a tooth, beyond that of a half-plane down to the same depth.

In the middle section of a whole ring, strain being plane, a line force on the flank makes the field of a half-plane,
which is infinite under the force, and a smooth rest:

.. math:: u = u_H + u_R,\qquad \sigma_R n = -\sigma_H n \text{ on the border},\qquad u_R = -u_H \text{ in the bore}.

Only the rest is left to finite elements, which is why a moderate mesh is enough; the local term is what it gives
between the flank and the middle of the tooth along the normal.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from loaded_tca.arrays import Array, Indices
from loaded_tca.compliance.body import factorised, gear_nodes
from loaded_tca.compliance.finite_elements import FACES, Discretisation, discretise
from loaded_tca.compliance.half_space import line_force
from loaded_tca.compliance.layout import MeshDensity
from loaded_tca.material import Material
from loaded_tca.pairs.gear import Gear
from loaded_tca.tooth.fillet import polar

DENSITY = MeshDensity(through=8, flank=12, fillet=4, land=4, rim=6, lengthwise=1, neighbours=0)
"""Of the middle section: twice as fine gives the same to 1 %. Without neighbours the cut of the half-plane's field,
outwards from the force, meets nothing."""
SLOPE = np.array([1.0, -8.0, 0.0, 8.0, -1.0]) / 12.0
"""Derivative at the middle one of five even steps."""


def local_heights(density: MeshDensity = DENSITY) -> Array:
    """Return the parts (n,) of the flank's height at which the local term is found, increasing."""
    return np.arange(2, 2 * density.flank - 1, 2) / (2.0 * density.flank)


def local_flexibility(gear: Gear, density: MeshDensity = DENSITY) -> tuple[Array, Array]:
    """Local term of the middle section.

    Parameters
    ----------
    gear : Gear
    density : MeshDensity
        Lengthwise elements are of no account.

    Returns
    -------
    (n,) array, (n,) array [mm per N/mm]
        Parts of the flank's height, increasing, and the local term there.
    """
    # The term ends in the middle of the tooth, so that it is the same for a solid gear, whose section is not held.
    nodes = gear_nodes(replace(gear, bore_diameter=None) if gear.is_solid else gear, density)
    section = (values[:, :, density.lengthwise] for values in (nodes.radius, nodes.angle))
    mesh = discretise(polar(*section), nodes.layout.elements)
    column = nodes.layout.sector(0).first + 2 * density.land
    flank = mesh.number[column + (2 * density.through if gear.flank.side > 0 else 0)]
    middle = mesh.number[column + density.through]
    first = nodes.layout.base_row + 2 * density.fillet
    heights = local_heights(density)
    rows = first + np.rint(2 * density.flank * heights).astype(int)
    forces = [_Force.on_flank(mesh.points, flank[row - 2 : row + 3], middle[row], gear.material) for row in rows]
    bore, held = mesh.number[:, 0], np.zeros((*mesh.points.shape, len(forces)))
    held[bore] = np.stack([-force.field(mesh.points[bore])[0] for force in forces], axis=-1)
    held = held.reshape(-1, len(forces))
    factor, matrices = factorised(mesh, gear.material, bore)
    loads = _rest_loads(mesh, forces)
    np.subtract.at(loads, mesh.dofs, matrices[mesh.kinds] @ held[mesh.dofs])
    rest = (factor.solve(loads) + held).reshape(-1, 2, len(forces))
    value = [force.approach(rest[..., n], middle, mesh.points) for n, force in enumerate(forces)]
    return heights, np.array(value)


@dataclass(frozen=True, eq=False)
class _Force:
    """A line force on a node of the flank."""

    node: int
    point: Array
    direction: Array
    material: Material

    @classmethod
    def on_flank(cls, points: Array, nodes: Indices, inside: int, material: Material) -> _Force:
        """Force on the middle one of five nodes, normal to the flank there, towards a node inside."""
        tangent = SLOPE @ points[nodes]
        normal = np.array([tangent[1], -tangent[0]]) / np.hypot(*tangent)
        towards = points[inside] - points[nodes[2]]
        return cls(int(nodes[2]), points[nodes[2]], normal * np.sign(normal @ towards), material)

    def field(self, points: Array) -> tuple[Array, Array]:
        """Displacement (..., 2) and stress (..., 2, 2) of the half-plane at points (..., 2)."""
        axes = np.array([self.direction, [-self.direction[1], self.direction[0]]])
        displacement, stress = line_force((points - self.point) @ axes.T, self.material)
        return displacement @ axes, axes.T @ stress @ axes

    def approach(self, rest: Array, middle: Indices, points: Array) -> float:
        """Displacement of the rest (nodes, 2) along the force, at it less below it on the middle line of the tooth."""
        radius = np.hypot(*points[middle].T)
        upwards = points[middle[-1]] / radius[-1]
        place = np.linalg.solve(np.stack([upwards, -self.direction], axis=-1), self.point)[0]
        below = [np.interp(place, radius, rest[middle, a]) for a in range(2)]
        return float(self.direction @ (rest[self.node] - below))


def _rest_loads(mesh: Discretisation, forces: Sequence[_Force]) -> Array:
    """Loads (size, m) of the rest on the free border: what takes the stresses of the half-planes off it."""
    found = []
    for fixed, value in FACES:
        offsets = np.empty((3, 2), dtype=int)
        offsets[:, fixed], offsets[:, 1 - fixed] = value, np.arange(3)
        place = mesh.lowest[:, None] + offsets
        found.append(mesh.number[place[..., 0] % len(mesh.number), place[..., 1]])
    edges = np.concatenate(found)
    once = np.bincount(edges[:, 1], minlength=len(mesh.points))[edges[:, 1]] == 1
    free = once & ~np.isin(edges[:, 1], mesh.number[:, 0])
    inner = np.tile(mesh.points[mesh.elements].mean(axis=1), (len(FACES), 1))[free]
    edges, nodes = edges[free], mesh.points[edges[free]]
    places, weights = np.polynomial.legendre.leggauss(4)
    shares = np.stack([0.5 * places * (places - 1.0), 1.0 - places**2, 0.5 * places * (places + 1.0)], axis=-1)
    slopes = np.stack([places - 0.5, -2.0 * places, places + 0.5], axis=-1)
    tangents = np.einsum("qk,eka->eqa", slopes * weights[:, None], nodes)
    normals = np.stack([tangents[..., 1], -tangents[..., 0]], axis=-1)
    normals *= np.sign(np.einsum("ea,ea->e", normals.sum(axis=1), nodes[:, 1] - inner))[:, None, None]
    points = np.einsum("qk,eka->eqa", shares, nodes)
    loads = np.zeros((*mesh.points.shape, len(forces)))
    for n, force in enumerate(forces):
        traction = -np.einsum("eqab,eqb->eqa", force.field(points)[1], normals)
        np.add.at(loads[..., n], edges, np.einsum("qk,eqa->eka", shares, traction))
    return loads.reshape(-1, len(forces))
