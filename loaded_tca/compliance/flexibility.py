r"""Flexibility of one gear's teeth: a table of displacements under unit forces all over one flank, made once and kept.

A study of torques, positions or mounting errors asks again and again for the same gears. What is kept is found by a key
made of all numbers that enter: outline and nodes of the body, places of the table, material, side, and the programme
itself. Equal keys are equal models; any other outline, bore, material, density or version is another one.

Models from disk save 0.9 to 2.7 s of processor time of the first analysis of a process, 30 to 50 % of it (the mesh
cycles and the matched face-milled pair among the examples' scenes).

Local compliance of the flank of a tooth, beyond that of a half-plane down to the same depth.

In the middle section of a whole ring, strain being plane, a line force on the flank makes the field of a half-plane,
which is infinite under the force, and a smooth rest:

.. math:: u = u_H + u_R,\qquad \sigma_R n = -\sigma_H n \text{ on the border},\qquad u_R = -u_H \text{ in the bore}.

Only the rest is left to finite elements, which is why a moderate mesh is enough; the local term is what it gives
between the flank and the middle of the tooth along the normal.

Displacements inside a half-plane and a half-space under a normal force on the surface.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib.metadata import version
from pathlib import Path

import numpy as np
import scipy
from numpy.polynomial.chebyshev import chebpts2

from loaded_tca.arrays import Array, Indices
from loaded_tca.compliance.body import FlankPlaces, ToothFrame, factorised, gear_body, gear_nodes
from loaded_tca.compliance.finite_elements import FACES, Discretisation, discretise
from loaded_tca.compliance.kept import kept
from loaded_tca.compliance.layout import MeshDensity
from loaded_tca.material import Material
from loaded_tca.pairs.gear import Gear
from loaded_tca.tooth.fillet import polar


def depth_displacement(depth: Array, distance: Array, material: Material) -> Array:
    r"""Displacement along the force at a depth below the surface of a half-space, per force [mm/N].

    .. math:: u = \frac{1 + \nu}{2\pi E} \left(\frac{t^2}{R^3} + \frac{2(1 - \nu)}{R}\right),\qquad R^2 = t^2 + s^2

    Parameters
    ----------
    depth : (...) array [mm]
        t, positive.
    distance : (...) array [mm]
        s, from the force, along the surface.
    material : Material

    References
    ----------
    Johnson 1985, Contact Mechanics, eq. 3.18 (Boussinesq).

    Examples
    --------
    >>> steel = Material(206000.0, 0.3)
    >>> float(depth_displacement(np.array(1e-9), np.array(2.0), steel))  # at the surface: (1 - nu^2)/(pi E s)
    7.030...e-07
    """
    square = depth * depth + distance * distance
    nu = material.poisson_ratio
    scale = (1.0 + nu) / (2.0 * math.pi * material.youngs_modulus)
    return np.asarray(scale * (depth * depth / square + 2.0 * (1.0 - nu)) / np.sqrt(square))


def depth_displacement_by_depth(depth: Array, distance: Array, material: Material) -> Array:
    """Derivative of :func:`depth_displacement` by the depth [1/N], of the same arguments."""
    square, nu = depth * depth + distance * distance, material.poisson_ratio
    scale = (1.0 + nu) / (2.0 * math.pi * material.youngs_modulus)
    return np.asarray(scale * depth * (2.0 * nu - 3.0 * depth * depth / square) / (square * np.sqrt(square)))


def depth_displacement_slope(depth: float, square: Array, material: Material) -> Array:
    """Derivative of :func:`depth_displacement` by the square of the distance [1/(N mm)], at squares [mm^2]."""
    from_force, nu = depth * depth + square, material.poisson_ratio
    scale = (1.0 + nu) / (2.0 * math.pi * material.youngs_modulus)
    return np.asarray(-scale * (1.5 * depth * depth / from_force + (1.0 - nu)) / (from_force * np.sqrt(from_force)))


def line_force(points: Array, material: Material) -> tuple[Array, Array]:
    r"""Displacement and stress in a half-plane under a line force on its surface, strain being plane.

    .. math::
        \sigma_r = -\frac{2 \cos\theta}{\pi r},\qquad
        u_r = -\frac{2(1 - \nu^2)}{\pi E} \cos\theta \ln r - \frac{(1 - 2\nu)(1 + \nu)}{\pi E} \theta \sin\theta

    and :math:`u_\theta` accordingly. The solution goes on beyond the surface, with a cut along the ray outwards.

    Parameters
    ----------
    points : (..., 2) array [mm]
        From the force: along it (into the half-plane) and across it, turned to the left.
    material : Material

    Returns
    -------
    displacement : (..., 2) array [mm per N/mm]
        But for a rigid displacement.
    stress : (..., 2, 2) array [MPa per N/mm]

    References
    ----------
    Johnson 1985, Contact Mechanics, eqs. 2.15 and 2.19 (Flamant).
    """
    nu, modulus = material.poisson_ratio, math.pi * material.youngs_modulus
    radius, angle = np.hypot(points[..., 0], points[..., 1]), np.arctan2(points[..., 1], points[..., 0])
    cosine, sine, logarithm = np.cos(angle), np.sin(angle), np.log(radius)
    plane, twist = 2.0 * (1.0 - nu**2) / modulus, (1.0 - 2.0 * nu) * (1.0 + nu) / modulus
    radial = -plane * cosine * logarithm - twist * angle * sine
    hoop = plane * sine * logarithm + 2.0 * nu * (1.0 + nu) / modulus * sine + twist * (sine - angle * cosine)
    along, across = np.stack([cosine, sine], axis=-1), np.stack([-sine, cosine], axis=-1)
    tension = -2.0 * cosine / (math.pi * radius)
    stress = tension[..., None, None] * along[..., :, None] * along[..., None, :]
    return radial[..., None] * along + hoop[..., None] * across, stress


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
    radius, angle = (values[:, :, density.lengthwise] for values in (nodes.radius, nodes.angle))
    true_radius = nodes.sections.in_true_size(radius, nodes.coordinate[density.lengthwise])
    mesh = discretise(polar(true_radius, angle), nodes.layout.elements)
    column = nodes.layout.sector(0).first + 2 * density.land
    flank = mesh.number[column + (2 * density.through if gear.flank.side > 0 else 0)]
    middle = mesh.number[column + density.through]
    first = nodes.layout.base_row + 2 * density.fillet
    heights = local_heights(density)
    rows = first + np.rint(2 * density.flank * heights).astype(int)
    forces = [_Force.on_flank(mesh.points, flank[row - 2 : row + 3], middle[row], gear.material) for row in rows]
    bore, held = mesh.number[mesh.number[:, 0] >= 0, 0], np.zeros((*mesh.points.shape, len(forces)))
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
        rising = np.argsort(radius)  # of a ring they fall from the outside to the tip
        below = [np.interp(place, radius[rising], rest[middle, a][rising]) for a in range(2)]
        return float(self.direction @ (rest[self.node] - below))


def _rest_loads(mesh: Discretisation, forces: Sequence[_Force]) -> Array:
    """Loads (size, m) of the rest on the free border: what takes the stresses of the half-planes off it."""
    columns = []
    for fixed, value in FACES:
        offsets = np.empty((3, 2), dtype=int)
        offsets[:, fixed], offsets[:, 1 - fixed] = value, np.arange(3)
        place = mesh.lowest[:, None] + offsets
        columns.append(mesh.number[place[..., 0] % len(mesh.number), place[..., 1]])
    edges = np.concatenate(columns)
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


HEIGHTS = 6
"""Places along the profile between which the displacements are interpolated."""
LENGTHS_PER_LAYER = 2.0
"""Places across the face, over the layers of elements, and at least:"""
LEAST_LENGTHS = 11
SAME_OUTLINE = 1e-9
"""Numbers are the same if they agree to this part of the size of the tooth: far above rounding."""


@dataclass(frozen=True, eq=False)
class ToothFlexibility:
    """What finite elements say of one gear, loaded on one flank.

    Attributes
    ----------
    heights, lengths : (a,), (b,) array
        Parts of the flank's height and of the face width, where the finite elements were loaded and read.
    displacement : (teeth, a b, a b) array [mm/N]
        Of the teeth ``-neighbours`` to ``+neighbours``: at the second place under a force at the third on tooth 0.
    depth : (a, b) array [mm]
        From there along the normal to the middle of the tooth.
    local_height, local_value : (n,) array
        Parts of the flank's height, increasing, and the local term there [mm per N/mm].
    """

    heights: Array
    lengths: Array
    displacement: Array
    depth: Array
    local_height: Array
    local_value: Array


def grid_of_places(frame: ToothFrame) -> tuple[Array, Array, FlankPlaces]:
    """Heights (a,) and lengths (b,) of the table, and the places (a b) that they make on the flank."""
    layers = frame.nodes.layout.density.lengthwise
    heights = 0.5 + 0.5 * chebpts2(HEIGHTS)
    lengths = 0.5 + 0.5 * chebpts2(max(LEAST_LENGTHS, math.ceil(LENGTHS_PER_LAYER * layers)))
    grid = np.meshgrid(heights, lengths, indexing="ij")
    return heights, lengths, frame.places(*(parts.ravel() for parts in grid))


def tooth_flexibility(frame: ToothFrame) -> ToothFlexibility:
    """Load a gear body by unit forces all over one flank.

    Parameters
    ----------
    frame : ToothFrame

    Raises
    ------
    GeometryError
        If the mesh is turned inside out.
    """
    heights, lengths, places = grid_of_places(frame)
    mesh, factor = gear_body(frame.nodes, frame.gear.material)
    number, size, near = mesh.number, len(mesh.points), frame.nodes.layout.neighbours
    forces = frame.on_flank(places, number).along(-places.normal, size)
    teeth = [frame.on_middle(places, tooth, number) for tooth in range(-near, near + 1)]
    readings = scipy.sparse.vstack([middle.along(-places.normal, size) for middle in teeth], format="csr")
    displacement = factor.flexibility(forces, readings).reshape(len(teeth), len(places.height), -1)
    depth = places.depth.reshape(len(heights), len(lengths))
    return ToothFlexibility(heights, lengths, displacement, depth, *local_flexibility(frame.gear))


def kept_flexibility(frame: ToothFrame) -> ToothFlexibility:
    """Flexibility of a gear's teeth, made if it is not known yet; its arrays cannot be written to.

    For parameters and errors see :func:`loaded_tca.compliance.flexibility.tooth_flexibility`.
    """
    return kept(key_of(frame), ToothFlexibility, lambda: tooth_flexibility(frame))


def key_of(frame: ToothFrame, places: FlankPlaces | None = None, what: str = "") -> str:
    """Digest of all that the flexibility of a gear's teeth depends on, or ``what`` else of forces at ``places``."""
    nodes, material = frame.nodes, frame.gear.material
    places = places or grid_of_places(frame)[-1]
    size = float(np.ptp(nodes.outline, axis=(0, 1)).max())
    plain = frame.side, nodes.layout, float(material.youngs_modulus), float(material.poisson_ratio), f"{size:.9e}"
    digest = hashlib.sha256(f"{_programme()} {what}{plain}".encode())
    for lengths in (nodes.outline, nodes.points, places.point, places.depth):
        digest.update(_rounded(lengths / size))
    digest.update(_rounded(places.normal))
    return digest.hexdigest()


def _rounded(values: Array) -> bytes:
    """Values over the size of the tooth as whole numbers; 0 stands for a node that is none."""
    whole = np.rint(np.nan_to_num(values, nan=0.0) / SAME_OUTLINE).astype(np.int64)
    return f"{whole.shape}".encode() + whole.tobytes()


@cache
def _programme() -> str:
    """Version of the package, and a digest of the modules that make the models: they may change between versions."""
    digest = hashlib.sha256()
    for module in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(module.read_bytes())
    return f"{version('loaded_tca')} {digest.hexdigest()}"
