r"""A gear body held at its bore: whole ring, one resolved tooth, its neighbours, in space or in one section.

A solid gear (bore diameter 0) is that ring and its core, held where its journals adjoin both faces.

Body torsion: the twist of gear bodies between what is held and the root circle, a part of every mesh stiffness.

Stiffnesses of slices and of ISO 6336-1 do not contain it:

.. math:: 1/c_{without} = 1/c - b\,(t_1 + t_2)
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import scipy

from loaded_tca.compliance.dissection import Factorisation, factorise
from loaded_tca.compliance.finite_elements import Discretisation, discretise, node_offsets
from loaded_tca.compliance.geometry import ROUNDING, BodyNodes, body_nodes, cuts_at_bore, rim_growth
from loaded_tca.compliance.layout import MeshDensity, RingLayout
from loaded_tca.errors import GeometryError
from loaded_tca.flanks.base import Flank, outward_normal
from loaded_tca.material import Material
from loaded_tca.reference.weber_banaschek import ring_torsion
from loaded_tca.roots import find_roots
from loaded_tca.tooth.surface import Resolution, build_tooth

if TYPE_CHECKING:
    from loaded_tca.arrays import Array, Indices
    from loaded_tca.pairs.gear import Gear
    from loaded_tca.pairs.gear_pair import GearPair

FIRST_CHORD = 0.25
"""First guess of the distance from a flank to the middle of the tooth, over the height of the flank."""
TOGETHER = 512
"""Elements whose forces are found at a time."""
MOST_DOUBLINGS = 5
"""Of that guess."""
CORE = 2
"""Layers of a solid gear below the diameter of its journals."""


def gear_nodes(gear: Gear, density: MeshDensity, outline: int = 65) -> BodyNodes:
    """Nodes of the whole ring of a gear, between so many points along each flank and fillet.

    They follow the flanks without modifications, so that variants of the micro-geometry share one model. Bending grows
    with about the third power of the thickness: modifications of 0.2 % of the module change a transmission error by
    0.03 %, of 1 % by 1 to 3 %.

    Raises
    ------
    InputError
        If the bore reaches the teeth.
    GeometryError
        If the tooth is pointed or cut off.
    """
    step = 1 if density.thin_ends else 2
    planes = density.planes // step
    resolution = Resolution(flank=outline, fillet=outline, land=9, lengthwise=int(planes[-1]) + 1)
    tooth = build_tooth(gear.nominal_flanks, gear.form, resolution)
    tooth = replace(tooth, outline=tooth.outline[:, planes], foot=tooth.foot[:, planes])
    sections, root = gear.form.sections, tooth.outline[0]
    radius = np.hypot(root[:, 0], root[:, 1])
    bore = gear.bore_radius(sections.coordinate(radius, root[:, 2]))
    rim = np.maximum(radius, bore), np.minimum(radius, bore)  # of a ring the bore of its image is the outside
    growth = rim_growth(*rim, density, gear.form.teeth)
    core, cuts = CORE if gear.is_solid else 0, cuts_at_bore(*rim, density.rim, growth)
    beyond = gear.form.held.pitches_beyond(*rim, gear.form.teeth)
    return body_nodes(tooth, sections, bore, RingLayout(gear.form.teeth, density, core, cuts, growth, beyond))


@dataclass(frozen=True, eq=False)
class SurfacePlaces:
    """Points on surfaces between nodes: numbers of 8 nodes each, and their shares (m, 8)."""

    nodes: Indices
    shares: Array

    def along(self, directions: Array, nodes: int) -> scipy.sparse.csr_array:
        """Displacements along directions (m, 3) as a matrix (m, 3 nodes); its rows are unit forces along them."""
        values = self.shares[..., None] * directions[:, None]
        columns = 3 * self.nodes[..., None] + np.arange(3)
        starts = np.arange(len(directions) + 1) * values[0].size
        return scipy.sparse.csr_array((values.ravel(), columns.ravel(), starts), shape=(len(directions), 3 * nodes))


@dataclass(frozen=True, eq=False)
class FlankPlaces:
    """Points of a flank, and what is below them.

    Attributes
    ----------
    height, length : (m,) array
        Parts of the flank's height and of the face width, 0 to 1.
    point, normal : (m, 3) array [mm]
        In the frame of the tooth; normals out of the material.
    depth : (m,) array [mm]
        Along the normal to the middle of the tooth.
    """

    height: Array
    length: Array
    point: Array
    normal: Array
    depth: Array

    @property
    def middle(self) -> Array:
        """Where the normals cut the middle of the tooth (m, 3) [mm]."""
        return self.point - self.depth[:, None] * self.normal


@dataclass(frozen=True, eq=False)
class ToothFrame:
    """One gear's tooth on its mesh: places on the flank in contact and on the middle of the teeth.

    Attributes
    ----------
    gear : Gear
    nodes : BodyNodes
    """

    gear: Gear
    nodes: BodyNodes

    @property
    def side(self) -> int:
        """The side s = +1 or -1 of the flank in contact."""
        return self.gear.flank.side

    @cached_property
    def face_parts(self) -> Array:
        """Parts of the face width (k,) at which sections of nodes stand, 0 to 1."""
        coordinate = self.nodes.coordinate
        return (coordinate - coordinate[0]) / (coordinate[-1] - coordinate[0])

    @property
    def flank(self) -> Flank:
        """The flank in contact, without modifications."""
        return self.gear.nominal_flank

    def _column(self, part: float, tooth: int = 0) -> int:
        """Column of nodes at a part of the thickness, 0 at s = -1 and 1 at s = +1."""
        sector = self.nodes.layout.sector(tooth)
        assert sector.density is not None
        return sector.first + 2 * sector.density.land + round(2 * sector.density.through * part)

    def _flank_rows(self, tooth: int = 0) -> slice:
        """Rows of nodes on the flank of a tooth, from its root."""
        layout = self.nodes.layout
        density = layout.sector(tooth).density
        assert density is not None
        first = layout.base_row + 2 * density.fillet
        return slice(first, first + 2 * density.flank + 1)

    def _flank_ends(self, where: Array) -> list[Array]:
        """Radii (m,) of the images of root and tip of the flank, at coordinates (m,) of sections."""
        return [np.interp(where, self.nodes.coordinate, radii) for radii in self._end_radii]

    @cached_property
    def _end_radii(self) -> tuple[Array, Array]:
        """Radii (k,) of the images of root and tip of the flank, at the sections of nodes."""
        radii = self.nodes.radius[self._column(0.5 + 0.5 * self.side), self._flank_rows()]
        return radii[0], radii[-1]

    def parts(self, rho: Array, z: Array) -> tuple[Array, Array]:
        """Parts (m,) of the flank's height and of the face width, of points of the flank or just beyond it."""
        sections, coordinate = self.nodes.sections, self.nodes.coordinate
        where = sections.coordinate(rho, z)
        low, high = self._flank_ends(where)
        length = (where - coordinate[0]) / (coordinate[-1] - coordinate[0])
        height = (sections.radius(rho, z) - low) / (high - low)
        return np.minimum(np.maximum(height, 0.0), 1.0), np.minimum(np.maximum(length, 0.0), 1.0)

    def places(self, height: Array, length: Array) -> FlankPlaces:
        """Points at parts (m,) of the flank's height and of the face width."""
        coordinate = self.nodes.coordinate
        where = coordinate[0] + length * (coordinate[-1] - coordinate[0])
        low, high = self._flank_ends(where)
        rho, z = self.nodes.sections.point(low + height * (high - low), where)
        theta = self.flank.theta(rho, z).value + self.side * self.gear.form.half_thickness_angle
        radial, hoop, axial = outward_normal(self.flank, rho, z).T
        cosine, sine = np.cos(theta), np.sin(theta)
        normal = np.stack([radial * cosine - hoop * sine, radial * sine + hoop * cosine, axial], axis=-1)
        point = np.stack([rho * cosine, rho * sine, z], axis=-1)
        return FlankPlaces(height, length, point, normal, self._depth(point, normal, float((high - low).max())))

    def _depth(self, point: Array, normal: Array, scale: float) -> Array:
        """Distances (m,) along the normals to the middle of the tooth [mm]."""
        rows = self._flank_rows()
        middle = self.nodes.angle[self._column(0.5), (rows.start + rows.stop) // 2]  # half way up the flank

        def beyond(depth: Array, number: Indices) -> Array:
            x, y, z = (point[number] - depth[:, None] * normal[number]).T
            where = self.nodes.sections.coordinate(np.hypot(x, y), z)
            return self.side * (np.arctan2(y, x) - np.interp(where, self.nodes.coordinate, middle))

        ends, every = np.array([[0.0], [FIRST_CHORD * scale]]) * np.ones(len(point)), np.arange(len(point))
        values = np.array([beyond(end, every) for end in ends])
        for _ in range(MOST_DOUBLINGS):
            short = np.flatnonzero(values[0] * values[1] > 0.0)
            if not short.size:
                break
            ends[1, short] *= 2.0
            values[1, short] = beyond(ends[1, short], short)
        return find_roots(beyond, ends, values, ROUNDING * scale)

    def on_flank(self, places: FlankPlaces, number: Indices, tooth: int = 0) -> SurfacePlaces:
        """Places among the nodes (columns, rows, layers) numbered ``number``, on the flank in contact of a tooth."""
        rows, column = self._flank_rows(tooth), self._column(0.5 + 0.5 * self.side, tooth)
        row = rows.start + places.height * (rows.stop - 1 - rows.start)
        return _among_nodes(number[column], row, np.interp(places.length, self.face_parts, np.arange(number.shape[2])))

    def on_middle(self, places: FlankPlaces, tooth: int, number: Indices) -> SurfacePlaces:
        """Places below those of a flank, on the middle of a tooth of the model."""
        column, sections, coordinate = self._column(0.5, tooth), self.nodes.sections, self.nodes.coordinate
        rho, z = np.hypot(places.middle[:, 0], places.middle[:, 1]), places.middle[:, 2]
        where = np.clip(sections.coordinate(rho, z), coordinate[0], coordinate[-1])
        layer = np.interp(where, coordinate, np.arange(len(coordinate)))
        radii = self.nodes.radius[column]
        radii = radii[np.isfinite(radii[:, 0])]
        lower = np.minimum(layer.astype(int), len(coordinate) - 2)
        part, rows = layer - lower, np.arange(len(radii))
        growing = (radii[:, lower] * (1.0 - part) + radii[:, lower + 1] * part).T  # radii of the rows at each place
        images = zip(sections.radius(rho, z), growing, strict=True)
        row = np.array([np.interp(image, column_radii, rows) for image, column_radii in images])
        return _among_nodes(number[column], row, layer)


def _among_nodes(number: Indices, row: Array, layer: Array) -> SurfacePlaces:
    """Serendipity interpolation at rows and layers (m,) of a surface of nodes (rows, layers)."""
    from skfem import ElementQuadS2

    element = ElementQuadS2()
    last = int((number[:, 0] >= 0).sum()) - 1
    lowest = np.stack([np.minimum(0.5 * row, last // 2 - 1), np.minimum(0.5 * layer, number.shape[1] // 2 - 1)])
    lowest = lowest.astype(int)
    span = np.where(number[2 * lowest[0], 2 * lowest[1] + 1] < 0, 2, 1)  # a middle that is missing: a thick element
    lowest[1] -= lowest[1] % span
    local = np.stack([0.5 * row - lowest[0], (0.5 * layer - lowest[1]) / span])
    offsets = node_offsets(element).T[:, None]
    nodes = 2 * lowest[0, :, None] + offsets[0], 2 * lowest[1, :, None] + offsets[1] * span[:, None]
    shares = np.stack([element.lbasis(local, i)[0] for i in range(offsets.shape[-1])], axis=-1)
    return SurfacePlaces(number[nodes[0], nodes[1]], shares)


def gear_body(nodes: BodyNodes, material: Material, largest_error: float = 0.0) -> tuple[Discretisation, Factorisation]:
    """Mesh of a body held at its bore or journals, and the factor of its stiffness.

    Parameters
    ----------
    nodes : BodyNodes
    material : Material
    largest_error : float
        Relative error of the displacements under which the factor may be of single precision, which takes half of the
        time; zero: of double precision.
    """
    lowest, spans, blocks = nodes.layout.bricks
    mesh = discretise(nodes.points, lowest, nodes.layout.turns, spans)
    held = nodes.layout.held(mesh.number)
    if largest_error > 0.0:
        try:
            factor, matrices = factorised(mesh, material, held, blocks, single=True)
        except GeometryError:  # of a soft body by rounding alone; double precision tells
            pass
        else:
            if error_of_displacements(mesh, factor, matrices, nodes.sections.outwards) <= largest_error:
                return mesh, factor
            del factor, matrices  # memory is told for one of them
    return mesh, factorised(mesh, material, held, blocks)[0]


def error_of_displacements(mesh: Discretisation, factor: Factorisation, matrices: Array, outwards: int = 1) -> float:
    """Relative error of the displacements by a factor: the change by one step of refinement, in double precision.

    Under unit loads along all axes on the node at the farthest tip.

    Parameters
    ----------
    mesh : Discretisation
    factor : Factorisation
        Of its stiffness.
    matrices : (q, k d, k d) array
        Stiffness of the elements' kinds in double precision.
    outwards : int
        +1, or -1 where teeth point towards the axis.
    """
    d, node = mesh.dimension, int((outwards * np.hypot(mesh.points[:, 0], mesh.points[:, 1])).argmax())
    loads = np.zeros((mesh.points.size, d))
    loads[d * node + np.arange(d), np.arange(d)] = 1.0
    displacements = factor.solve(loads).astype(float)
    dofs, carried = mesh.dofs, np.zeros(loads.shape)
    for first in range(0, len(dofs), TOGETHER):
        some = slice(first, first + TOGETHER)
        np.add.at(carried, dofs[some], matrices[mesh.kinds[some]] @ displacements[dofs[some]])
    change = factor.solve(loads - carried)
    return float((np.abs(change).max(axis=0) / np.abs(displacements).max(axis=0)).max())


def factorised(
    mesh: Discretisation, material: Material, held: Indices, blocks: Indices | None = None, *, single: bool = False
) -> tuple[Factorisation, Array]:
    """Factor of the stiffness of a mesh with nodes ``held`` (-1: none), and the matrices of its elements' kinds.

    ``single``: the factor is of single precision.
    """
    free = np.ones((len(mesh.points), mesh.dimension), dtype=bool)
    free[held[held >= 0]] = False
    matrices, places = mesh.stiffness(material), mesh.lowest // 2
    places[:, 2:] -= places[:, 2:] % 2  # no cut through an element that is twice as thick
    used = np.asarray(matrices, dtype=np.float32 if single else float)
    return factorise(used, mesh.dofs, places, free.ravel(), kinds=mesh.kinds, blocks=blocks), matrices


CELLS = 12
"""Elements along each part of half the section of a solid body."""


def body_torsion(pair: GearPair) -> tuple[float, float]:
    """Displacement of both gears along the transverse line of action by the twist of their bodies per force [mm/N].

    That of a ring in closed form, of a solid gear by :func:`solid_torsion`; of bevel gears that of the mean section.

    Raises
    ------
    InputError
        If a bore leaves no rim below the teeth.
    """
    pinion, wheel = (
        base_radius**2 * _twist(gear)
        for gear, base_radius in zip((pair.pinion, pair.wheel), pair.base_radii, strict=True)
    )
    return pinion, wheel


def _twist(gear: Gear) -> float:
    """Rotation of the root circle per torque [rad/(N mm)]."""
    ends = np.unique(gear.form.sections.coordinate(*gear.nominal_flank.grid(2, 2)))
    middle, width = np.array([0.5 * (ends[0] + ends[-1])]), float(ends[-1] - ends[0])
    root = float(gear.form.sections.point(gear.form.root_radius(middle), middle)[0][0])
    held = float(gear.bore_radius(middle)[0])
    return (
        solid_torsion(held, root, width, gear.material)
        if gear.is_solid
        else (ring_torsion(min(held, root), max(held, root), gear.material) / width)
    )


def solid_torsion(journal_radius: float, outer_radius: float, width: float, material: Material = Material()) -> float:
    r"""Mean rotation of the outside of a cylinder, loaded evenly there and held by journals at both ends.

    Sections turn by :math:`\psi = u_\theta/r`, for which

    .. math:: \frac{\partial}{\partial r} r^3 \frac{\partial\psi}{\partial r} + r^3 \frac{\partial^2\psi}{\partial z^2}
              = 0, \qquad \psi = 0 \text{ on the journals}, \qquad
              2 \pi G\,r_o^3\,\frac{\partial\psi}{\partial r} = \frac{T}{b} \text{ outside}.

    By finite elements of half the section.

    Parameters
    ----------
    journal_radius, outer_radius, width : float [mm]
    material : Material

    Returns
    -------
    float [rad/(N mm)]

    References
    ----------
    Timoshenko, Goodier 1970, Theory of Elasticity, 3rd ed., art. 119 (torsion of shafts of variable diameter).

    Examples
    --------
    >>> round(1e9 * solid_torsion(20.0, 35.0, 20.0), 4)
    0.162
    """
    from skfem import Basis, BilinearForm, ElementQuad2, FacetBasis, LinearForm, MeshQuad, condense, solve

    # Lengths over the outer radius; elements grow finer towards the edge of the journals.
    edge, end = journal_radius / outer_radius, 0.5 * width / outer_radius
    part = np.linspace(0.0, 1.0, CELLS + 1)
    radii = np.concatenate([edge * (2.0 - part[:-1]) * part[:-1], edge + (1.0 - edge) * part**2])
    mesh = MeshQuad.init_tensor(radii, end * part**2)
    basis, element = Basis(mesh, ElementQuad2(), intorder=6), ElementQuad2()
    outside = FacetBasis(mesh, element, facets=mesh.facets_satisfying(lambda x: x[0] > 1.0 - 1e-9))
    stiffness = BilinearForm(lambda u, v, w: 4.0 * math.pi * w.x[0] ** 3 * (u.grad * v.grad).sum(axis=0))
    load = LinearForm(lambda v, _: v / end).assemble(outside)
    held = basis.get_dofs(lambda x: (x[1] < 1e-9) & (x[0] < edge + 1e-9))
    turned = float(load @ solve(*condense(stiffness.assemble(basis), load, D=held)))
    shear_modulus = 0.5 * material.youngs_modulus / (1.0 + material.poisson_ratio)
    return turned / (shear_modulus * outer_radius**3)
