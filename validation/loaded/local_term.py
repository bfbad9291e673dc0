"""Spread of the local term of a tooth along the face: sections of a spur tooth that carry waves of load.

The local term of the tooth compliance (``loaded_tca.compliance.influence``) is what a flank gives way beyond a half-
space, above the middle of the tooth. In the plane it is a number for each height. Along the face it belongs to the back
of the tooth, which does not follow short waves: how far a force reaches is found here. A line load cos(kappa z) leaves
a plane problem with three displacements, whose amplitudes by finite elements give the term at that wave number:

    R(kappa) = u(flank) - u(middle) - [u of a half-space at the surface - u of a half-space at the depth t]

t is the distance from the flank to the middle of the tooth along the normal. R falls like exp(-(kappa a)^2), which is
the transform of a normal distribution along the face of the standard deviation sqrt(2) a. As a script, a table of
these for two tooth forms.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.linalg import splu
from scipy.special import k0, k1
from skfem import Basis, ElementTriP2, ElementVector, FacetBasis, LinearForm, MeshTri

from loaded_tca.compliance import MeshDensity
from loaded_tca.compliance.body import ToothFrame, gear_nodes
from loaded_tca.compliance.flexibility import grid_of_places, local_flexibility
from loaded_tca.compliance.influence import SPREAD
from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.material import Material
from loaded_tca.pairs.cylindrical import cylindrical_pair
from loaded_tca.pairs.gear import Gear
from loaded_tca.tooth.fillet import polar
from validation.contact.wedge import elasticity_of_waves
from validation.page import table
from validation.table import Row

Array = NDArray[np.float64]

CASE, SOURCE = "spread of the local term", "waves of load by finite elements"
TEETH = (25, 60)
MODULE = 3.0
STEEL = Material(206000.0, 0.3)
# Teeth of two coarse elements each beside the loaded one; a facet of the flank holds the whole strip.
DENSITY = MeshDensity(through=8, flank=12, fillet=4, land=4, rim=6, lengthwise=1, neighbours=1)
FACETS = (3, 6, 9)  # of the flank, from its root, that are loaded
HALF_WIDTH = 0.15  # of the elliptical strip [mm], a twentieth of the depth or less
LEVELS, FIRST, RATIO, FINEST = 5, 0.8, 1.9, 0.3  # refinements about a strip; reaches over the module, in mm the last
WAVES = np.array([0.01, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5])  # wave numbers [1/mm]
FITTED = 0.1  # of the plane term, from which the logarithm of R is fitted
# One constant for all teeth and heights: fits differ by 20 % between them.
DEVIATION = 0.2
# R falls below zero, to -0.13 of the plane term, before it ends: a normal distribution does not. The local term is 3 %
# of the compliance of a tooth, so that a quarter of it is less than 1 %.
MISFIT = 0.25
PLANE = 0.02  # two meshes, and a wave of 630 mm instead of none


@dataclass(frozen=True)
class Spread:
    """Local term over the wave number at one height of a flank.

    Attributes
    ----------
    height : float
        Part of the flank's height.
    term : array [mm per N/mm]
        At the waves.
    waves : array [1/mm]
        Wave numbers, ``WAVES`` by default.
    """

    height: float
    term: Array
    waves: Array = field(default_factory=lambda: WAVES)

    @property
    def length(self) -> float:
        """a of R(kappa) = R(0) exp(-(kappa a)^2), by least squares of the logarithm [mm]."""
        used = self.term > FITTED * self.term[0]
        slope, _ = np.polyfit(self.waves[used] ** 2, np.log(self.term[used]), 1)
        return math.sqrt(-slope)

    def misfit(self, deviation: float) -> float:
        """Largest difference from the transform of a normal distribution, over the term in the plane."""
        plane = self.term[0] * math.exp(0.5 * (self.waves[0] * deviation) ** 2)
        return float(np.abs(self.term / plane - np.exp(-0.5 * (self.waves * deviation) ** 2)).max())


def spur_gear(teeth: int) -> Gear:
    """Spur gear of 20 degrees."""
    mesh = CylindricalMesh(*(CylindricalGear(z, MODULE, 20.0) for z in (teeth, 40)))
    return cylindrical_pair(mesh, materials=(STEEL, STEEL)).pinion


def mean_depth(gear: Gear) -> float:
    """Mean distance from the flank to the middle of the tooth [mm]."""
    return float(grid_of_places(ToothFrame(gear, gear_nodes(gear, MeshDensity())))[-1].depth.mean())


def spreads(gear: Gear, waves: Array = WAVES) -> list[Spread]:
    """Local term at the heights of ``FACETS``."""
    section = _Section.of(gear)
    amplitudes = np.array([section.amplitudes(wave) for wave in waves])  # (waves, facets, 2)
    found = []
    for n, (facet, depth) in enumerate(zip(FACETS, section.depths, strict=True)):
        surface, middle = amplitudes[:, n].T
        half_space = np.array([surface_under_wave(wave) - below_wave(depth, wave) for wave in waves])
        found.append(Spread((facet + 0.5) / DENSITY.flank, surface - middle - half_space, waves))
    return found


@dataclass(frozen=True, eq=False)
class _Section:
    """Section of a gear, refined about the middles of the loaded facets."""

    mesh: MeshTri
    points: Array
    normals: Array
    depths: Array

    @classmethod
    def of(cls, gear: Gear) -> "_Section":
        nodes = gear_nodes(gear, DENSITY)
        layout = nodes.layout
        number = np.arange(np.prod(layout.shape)).reshape(layout.shape)
        column, row = layout.elements.T
        around = (column + 2) % layout.shape[0]
        quads = np.stack([number[column, row], number[around, row], number[around, row + 2], number[column, row + 2]])
        place = polar(nodes.radius[:, :, 1], nodes.angle[:, :, 1])
        mesh = MeshTri(
            place.reshape(-1, 2).T.copy(), np.concatenate([quads[[0, 1, 2]], quads[[0, 2, 3]]], axis=1)
        ).remove_unused_nodes()
        sector = layout.sector(0)
        first = layout.base_row + 2 * DENSITY.fillet
        flank = place[sector.first + 2 * (DENSITY.land + DENSITY.through * (gear.flank.side > 0))]
        ends = np.array([[flank[first + 2 * (facet + end)] for end in (0, 1)] for facet in FACETS])
        points, along = ends.mean(axis=1), np.diff(ends, axis=1)[:, 0]
        normals = np.stack([along[:, 1], -along[:, 0]], axis=1) / np.linalg.norm(along, axis=1)[:, None]
        axis = place[sector.first + 2 * DENSITY.land + DENSITY.through, first]
        normals *= np.sign(normals @ axis - (normals * points).sum(axis=1))[:, None]  # into the tooth
        across = np.array([-axis[1], axis[0]])
        depths = -(points @ across) / (normals @ across)
        for level in range(LEVELS):
            middles = mesh.p[:, mesh.t].mean(axis=1).T
            distance = np.linalg.norm(middles[:, None] - points, axis=2).min(axis=1)
            mesh = mesh.refined(np.flatnonzero(distance < max(FIRST * MODULE / RATIO**level, FINEST)))
        return cls(mesh, points, normals, depths)

    def amplitudes(self, wave: float) -> Array:
        """Displacements (facets, 2) along the force, per line load, of the strip and below it in the middle."""
        element = ElementVector(ElementTriP2(), 3)
        basis, scalar = Basis(self.mesh, element), Basis(self.mesh, ElementTriP2())
        radius = np.hypot(*self.mesh.p)
        bore = radius.min() * 1.001
        held = basis.get_dofs(lambda x: np.hypot(*x) < bore).all()
        free = basis.complement_dofs(held)
        stiffness = elasticity_of_waves(STEEL, wave).assemble(basis)[free][:, free].tocsc()
        factor = splu(stiffness, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}, diag_pivot_thresh=0.0)
        found = []
        for point, normal, depth in zip(self.points, self.normals, self.depths, strict=True):
            load = self._strip(element, point, normal)
            displacement = np.zeros(basis.N)
            displacement[free] = factor.solve(load[free])
            below = 0.0
            for component, direction in ((1, normal[0]), (2, normal[1])):
                one = np.zeros(scalar.N)
                one[scalar.nodal_dofs[0]] = displacement[basis.nodal_dofs[component]]
                one[scalar.facet_dofs[0]] = displacement[basis.facet_dofs[component]]
                below += direction * float((scalar.probes((point + depth * normal)[:, None]) @ one)[0])
            found.append((load @ displacement, below))
        return np.array(found)

    def _strip(self, element: ElementVector, point: Array, normal: Array) -> Array:
        """Nodal forces of a unit line load with an elliptical pressure."""

        def away(x: Array) -> tuple[Array, Array]:
            offset = x[0] - point[0], x[1] - point[1]
            return offset[0] * normal[0] + offset[1] * normal[1], offset[1] * normal[0] - offset[0] * normal[1]

        near = self.mesh.facets_satisfying(
            lambda x: (np.abs(away(x)[0]) < 1e-7) & (np.abs(away(x)[1]) < 2.0 * HALF_WIDTH), boundaries_only=True
        )
        face = FacetBasis(self.mesh, element, facets=near, intorder=12)

        def pressure(x: Array) -> Array:
            return np.sqrt(np.maximum(0.0, 1.0 - (away(x)[1] / HALF_WIDTH) ** 2))

        forces = LinearForm(lambda v, w: pressure(w.x) * (normal[0] * v[1] + normal[1] * v[2])).assemble(face)
        plain = FacetBasis(self.mesh, ElementTriP2(), facets=near, intorder=12)
        return np.asarray(forces / LinearForm(lambda v, w: pressure(w.x) * v).assemble(plain).sum())


def surface_under_wave(wave: float, points: int = 400) -> float:
    """Mean displacement of a half-space under an elliptical strip of line load cos(kz), weighted with the pressure."""
    angle = (np.arange(points) + 0.5) / points * math.pi
    place, weight = HALF_WIDTH * np.cos(angle), np.sin(angle) ** 2
    weight /= weight.sum()
    distance = wave * np.abs(place[:, None] - place)
    np.fill_diagonal(distance, 1.0)
    regular = k0(distance) + np.log(distance)  # K0 less its logarithm, whose mean is known in closed form
    np.fill_diagonal(regular, math.log(2.0) - np.euler_gamma)
    logarithm = math.log(0.5 * wave * HALF_WIDTH) - 0.25
    return float(weight @ regular @ weight - logarithm) * 2.0 / (math.pi * STEEL.plane_strain_modulus)


def below_wave(depth: float, wave: float) -> float:
    """Displacement at a depth below a line load cos(kz) on a half-space: Boussinesq's, transformed."""
    nu, kt = STEEL.poisson_ratio, wave * depth
    return float((1.0 + nu) / (math.pi * STEEL.youngs_modulus) * (kt * k1(kt) + 2.0 * (1.0 - nu) * k0(kt)))


def short_rows() -> list[Row]:
    """Rows of one tooth form, of three waves."""
    return rows(TEETH[:1], WAVES[:5:2])


def rows(forms: Sequence[int] = TEETH, waves: Array = WAVES) -> list[Row]:
    """Transform of the normal distribution that the package takes, and its limit in the plane, for both tooth forms."""
    found = []
    for teeth in forms:
        gear = spur_gear(teeth)
        depth, (heights, plane), at_heights = mean_depth(gear), local_flexibility(gear), spreads(gear, waves)
        deviation = float(np.mean([math.sqrt(2.0) * one.length for one in at_heights]))
        quantity = f"z {teeth}: standard deviation over the mean depth"
        found.append(Row(CASE, SOURCE, quantity, deviation / depth, SPREAD, DEVIATION))
        for one in at_heights:
            where = f"z {teeth}, {one.height:.2f} of the flank"
            expected = float(np.interp(one.height, heights, plane))
            found += [
                Row(CASE, SOURCE, f"{where}: term in the plane [mm per N/mm]", one.term[0], expected, PLANE),
                Row(CASE, SOURCE, f"{where}: misfit of the spread", 0.0, one.misfit(SPREAD * depth), MISFIT),
            ]
    return found


def main() -> None:
    """Print the table of both tooth forms."""
    rows = []
    for teeth in TEETH:
        gear = spur_gear(teeth)
        depth = mean_depth(gear)
        for one in spreads(gear):
            sigma = math.sqrt(2.0) * one.length
            cells = f"{1e6 * one.term[0]:.3f} | {one.length:.2f} | {sigma:.2f} | {sigma / MODULE:.2f}"
            rows.append(f"{teeth} | {one.height:.2f} | {cells} | {sigma / depth:.2f} | {one.misfit(sigma):.3f}")
    head = "teeth | part of the height | R(0) [1e-6 mm per N/mm] | a [mm] | sigma [mm] | / m_n | / mean depth | misfit"
    print(table(head, rows))


if __name__ == "__main__":
    main()
