r"""Local compliance of the flank of a tooth, beyond that of a half-plane down to the same depth.

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
from loaded_tca.compliance.body import factorised, gear_nodes
from loaded_tca.compliance.finite_elements import Discretisation, discretise
from loaded_tca.compliance.half_space import line_force
from loaded_tca.compliance.layout import MeshDensity
from loaded_tca.material import Material
from loaded_tca.pairs.gear import Gear

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


def local_flexibility(gear: Gear, density: MeshDensity = DENSITY) -> LocalFlexibility:
    """Local term of the middle section.

    Parameters
    ----------
    gear : Gear
    density : MeshDensity
        Lengthwise elements are of no account.
    """
    section = _section(gear, density)
    forces = [section.force_at(row) for row in section.rows]
    loads = np.stack([section.rest_loads(force) for force in forces], axis=-1)
    held = np.stack([section.held_displacement(force) for force in forces], axis=-1)
    factor, matrices = factorised(section.mesh, gear.material)
    loads -= _product(matrices[section.mesh.kinds], section.mesh.dofs, held)
    rest = (factor.solve(loads) + held).reshape(-1, 2, len(forces))
    value = [section.between(force, rest[..., n]) for n, force in enumerate(forces)]
    return LocalFlexibility((section.rows - section.first) / (2.0 * density.flank), np.array(value))


@dataclass(frozen=True, eq=False)
class _Force:
    """A line force on a node of the flank."""

    node: int
    point: Array
    direction: Array

    def field(self, points: Array, material: Material) -> tuple[Array, Array]:
        """Displacement (..., 2) and stress (..., 2, 2) of the half-plane at points (..., 2)."""
        across = np.array([-self.direction[1], self.direction[0]])
        axes = np.stack([self.direction, across])
        displacement, stress = line_force((points - self.point) @ axes.T, material)
        return displacement @ axes, axes.T @ stress @ axes


@dataclass(frozen=True, eq=False)
class _Section:
    """The middle section of a gear, its mesh, the nodes of the flank and of the middle of the tooth."""

    mesh: Discretisation
    material: Material
    flank: Indices
    middle: Indices
    first: int
    rows: Indices
    border: tuple[Array, Array, Indices, Array]

    def force_at(self, row: int) -> _Force:
        """Force normal to the flank at a row of nodes."""
        points = self.mesh.points[self.flank[row - 2 : row + 3]]
        tangent = SLOPE @ points
        normal = np.array([tangent[1], -tangent[0]]) / np.hypot(*tangent)
        towards = self.mesh.points[self.middle[row]] - points[2]
        return _Force(int(self.flank[row]), points[2], normal * np.sign(normal @ towards))

    def rest_loads(self, force: _Force) -> Array:
        """Load vector of the rest on the free border: what takes the stress of the half-plane off it."""
        points, normals, nodes, shares = self.border
        traction = -np.einsum("eqab,eqb->eqa", force.field(points, self.material)[1], normals)
        loads = np.zeros_like(self.mesh.points)
        np.add.at(loads, nodes, np.einsum("qk,eqa->eka", shares, traction))
        return loads.ravel()

    def held_displacement(self, force: _Force) -> Array:
        """Displacements of the rest in the bore, zero elsewhere."""
        held = self.mesh.number[:, 0]
        found = np.zeros_like(self.mesh.points)
        found[held] = -force.field(self.mesh.points[held], self.material)[0]
        return found.ravel()

    def between(self, force: _Force, rest: Array) -> float:
        """Displacement of the rest (nodes, 2) along the force, at it less in the middle of the tooth."""
        line = self.mesh.points[self.middle]
        radius = np.hypot(line[:, 0], line[:, 1])
        along = line[-1] / radius[-1]
        depth = -_cross(force.point, along) / _cross(force.direction, along)
        place = float(np.hypot(*(force.point + depth * force.direction)))
        deep = [np.interp(place, radius, rest[self.middle, a]) for a in range(2)]
        return float(force.direction @ (rest[force.node] - deep))


def _cross(a: Array, b: Array) -> float:
    return float(a[0] * b[1] - a[1] * b[0])


def _section(gear: Gear, density: MeshDensity) -> _Section:
    """Mesh of the middle section."""
    nodes = gear_nodes(gear, density)
    radius, angle = (values[:, :, density.lengthwise] for values in (nodes.radius, nodes.angle))
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)
    mesh = discretise(points, nodes.layout.elements)
    left = nodes.layout.sector(0).first + 2 * density.land
    first = nodes.layout.base_row + 2 * density.fillet
    rows = first + np.arange(2, 2 * density.flank - 1, 2)
    flank = mesh.number[left + (2 * density.through if gear.flank.side > 0 else 0)]
    border = _border(mesh)
    return _Section(mesh, gear.material, flank, mesh.number[left + density.through], first, rows, border)


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


def _product(matrices: Array, dofs: Indices, vectors: Array) -> Array:
    """Product of the sum of element matrices and vectors (size, m)."""
    found = np.zeros_like(vectors)
    np.add.at(found, dofs, matrices @ vectors[dofs])
    return found
