"""Teeth of a ring against plane-strain finite elements of their own: deflection under narrow strips, root stress.

The package draws the tooth of a ring in an inversion and computes on it with its elements, half-spaces and a local
term. Here the same section is triangulated in its true form by Delaunay's rule, eleven teeth with their rim, fine at
the loaded flank and the fillets, with quadratic elements; the outside is held. What is compared is the displacement of
a strip of elliptical pressure along the force, and the largest tension at the root. They agree to 0.4 % and 0.1 %, as
two kinds of meshes do.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from skfem import ElementTriP2, FacetBasis, LinearForm

from loaded_tca.compliance.body import factorised, gear_nodes
from loaded_tca.compliance.finite_elements import discretise
from loaded_tca.compliance.flexibility import DENSITY, local_flexibility
from loaded_tca.flanks.base import outward_normal
from loaded_tca.gears import CylindricalGear, InternalMesh, PinionCutter, RingGear
from loaded_tca.pairs import internal_pair
from loaded_tca.pairs.gear import Gear
from loaded_tca.reference.weber_banaschek import flank_flattening
from loaded_tca.tooth.fillet import polar
from validation.loaded.plane_teeth import STEEL, PlaneTeeth, flank_angle
from validation.loaded.root_stress import FINE, plane_curves
from validation.table import Row

Array = NDArray[np.float64]

CASE, SOURCE = "teeth of a ring", "plane-strain finite elements in their true form"
HALF_WIDTH = 0.15  # of the strips [mm]
HEIGHTS = 0.3, 0.55, 0.8  # of the flank, over its height
STIFFNESS, TENSION = 0.012, 0.003


def ring_pair(teeth: int, cutter: PinionCutter | None) -> tuple[RingGear, Gear]:
    """Ring of module 3 with a pinion of 25 teeth, and its gear of the side s = +1."""
    pinion = CylindricalGear(25, 3.0, 10.0, profile_shift=0.3)
    ring = RingGear(-teeth, 3.0, 10.0, tip_diameter=3.0 * teeth - 4.8, cutter=cutter)
    return ring, internal_pair(InternalMesh(pinion, ring), materials=(STEEL, STEEL)).wheel


@dataclass(frozen=True, eq=False)
class Section:
    """Triangulated teeth of a ring, the loaded one about the x axis."""

    ring: RingGear
    teeth: PlaneTeeth

    @classmethod
    def of(cls, ring: RingGear) -> "Section":
        """Eleven teeth; their outside is held."""
        return cls(ring, PlaneTeeth.of(ring, ring.outer_radius))

    def under_strip(self, radius: float) -> tuple[float, float]:
        """Displacement along the force [mm per N/mm] of a strip on the flank, and the largest tension at its fillet."""
        ring, angle = self.ring, float(flank_angle(self.ring, np.array([radius]))[0])
        point = polar(np.array(radius), np.array(angle))
        roll = ring.roll_length(radius) / ring.base_radius
        along = np.array([math.cos(angle), math.sin(angle)]) + roll * np.array([-math.sin(angle), math.cos(angle)])
        along /= np.linalg.norm(along)
        normal = np.array([along[1], -along[0]])  # into the tooth, whose middle has smaller azimuths

        def away(x: Array) -> tuple[Array, Array]:
            offset = x[0] - point[0], x[1] - point[1]
            return offset[0] * normal[0] + offset[1] * normal[1], offset[0] * along[0] + offset[1] * along[1]

        near = self.teeth.mesh.facets_satisfying(
            lambda x: (np.abs(away(x)[0]) < 0.02) & (np.abs(away(x)[1]) < 2.0 * HALF_WIDTH), boundaries_only=True
        )
        face = FacetBasis(self.teeth.mesh, self.teeth.basis.elem, facets=near, intorder=12)
        plain = FacetBasis(self.teeth.mesh, ElementTriP2(), facets=near, intorder=12)

        def pressure(x: Array) -> Array:
            return np.sqrt(np.maximum(0.0, 1.0 - (away(x)[1] / HALF_WIDTH) ** 2))

        load = LinearForm(lambda v, w: pressure(w.x) * (normal[0] * v[0] + normal[1] * v[1])).assemble(face)
        load /= LinearForm(lambda v, w: pressure(w.x) * v).assemble(plain).sum()
        displacement = self.teeth.displacement(load)
        return float(load @ displacement), self._tension(displacement)

    def _tension(self, displacement: Array) -> float:
        """Largest stress along the loaded fillet, from the strain at its surface."""
        ring = self.ring
        land = math.pi / ring.tooth_count
        facets = self.teeth.mesh.facets_satisfying(
            lambda x: (
                (np.hypot(*x) > ring.form_radius - 0.05)
                & (np.hypot(*x) < ring.root_radius + 1e-3)
                & (np.arctan2(x[1], x[0]) > 0.0)
                & (np.arctan2(x[1], x[0]) < land)
            ),
            boundaries_only=True,
        )
        face = FacetBasis(self.teeth.mesh, self.teeth.basis.elem, facets=facets, intorder=2)
        gradient = face.interpolate(displacement).grad
        n = face.normals
        t = np.stack([-n[1], n[0]])
        strain = sum(gradient[i, j] * t[i] * t[j] for i in range(2) for j in range(2))
        return float(strain.mean(axis=1).max()) * STEEL.plane_strain_modulus


def package_deflection(gear: Gear, radii: Array) -> Array:
    """The same displacements by the package's parts: coarse elements below, the local term, half-planes above."""
    nodes = gear_nodes(gear, DENSITY)
    middle_section = DENSITY.lengthwise
    true = nodes.sections.in_true_size(nodes.radius[:, :, middle_section], nodes.coordinate[middle_section])
    mesh = discretise(polar(true, nodes.angle[:, :, middle_section]), nodes.layout.elements)
    factor, _ = factorised(mesh, gear.material, mesh.number[:, 0])
    column = nodes.layout.sector(0).first + 2 * DENSITY.land
    side = column + (2 * DENSITY.through if gear.flank.side > 0 else 0)
    first = nodes.layout.base_row + 2 * DENSITY.fillet
    rows = slice(first, first + 2 * DENSITY.flank + 1)
    flank, middle = mesh.number[side, rows], mesh.number[column + DENSITY.through]
    heights, local = local_flexibility(gear)
    image = nodes.sections.radius(radii, 0.0 * radii)
    ends = nodes.radius[side, rows, middle_section][[0, -1]]
    height = (image - ends[0]) / (ends[1] - ends[0])
    axis = mesh.points[middle[-1]] / np.hypot(*mesh.points[middle[-1]])
    across = np.array([-axis[1], axis[0]])
    found = []
    for part, radius in zip(height, radii, strict=True):
        number = flank[round(2 * DENSITY.flank * part)]
        point = mesh.points[number]
        theta = math.atan2(point[1], point[0])
        radial, hoop, _ = outward_normal(gear.nominal_flank, np.array([radius]), np.array([0.0]))[0]
        inwards = -np.array(
            [radial * math.cos(theta) - hoop * math.sin(theta), radial * math.sin(theta) + hoop * math.cos(theta)]
        )
        depth = float(-(point @ across) / (inwards @ across))
        loads = np.zeros(mesh.points.size)
        loads[2 * number : 2 * number + 2] = inwards
        moved = factor.solve(loads[:, None])[:, 0].reshape(-1, 2)
        along = np.hypot(*mesh.points[middle].T)
        rising = np.argsort(along)
        place = float((point + depth * inwards) @ axis)
        below = float(inwards @ [np.interp(place, along[rising], moved[middle, a][rising]) for a in range(2)])
        strip = flank_flattening(HALF_WIDTH, depth, STEEL) - 0.5 / (math.pi * STEEL.plane_strain_modulus)
        found.append(below + float(np.interp(part, heights, local)) + strip)
    return np.array(found)


FORMS: tuple[tuple[int, PinionCutter | None], ...] = (60, None), (60, PinionCutter(25)), (90, None)
"""Teeth of rings, and what cut them."""


def rows(forms: tuple[tuple[int, PinionCutter | None], ...] = FORMS) -> list[Row]:
    """Deflection at three heights and root tension under the highest load."""
    table = []
    for teeth, cutter in forms:
        ring, gear = ring_pair(teeth, cutter)
        section, name = Section.of(ring), f"-{teeth}{', cutter' if cutter else ', arcs'}"
        parts = np.round(2 * DENSITY.flank * np.array(HEIGHTS)) / (2 * DENSITY.flank)
        form, tip = (ring.root_radius**2 / radius for radius in (ring.form_radius, ring.tip_radius))
        radii = ring.root_radius**2 / (form + parts * (tip - form))
        reference = [section.under_strip(float(radius)) for radius in radii]
        obtained = package_deflection(gear, radii)
        for part, (deflection, _), package in zip(parts, reference, obtained, strict=True):
            what = f"{name}: deflection at {part:.2f} of the height [1e-6 mm per N/mm]"
            table.append(Row(CASE, SOURCE, what, 1e6 * deflection, 1e6 * float(package), STIFFNESS))
        stress = plane_curves(gear, FINE, radii[-1:])[0].largest(1)[0][0]
        what = f"{name}: largest root tension under 1 N/mm near the tip [MPa]"
        table.append(Row(CASE, SOURCE, what, reference[-1][1], float(stress), TENSION))
    return table


def short_rows() -> list[Row]:
    """Rows of one ring."""
    return rows(((60, None),))
