"""A spur or helical ring in space under line loads on one tooth: its mesh, its loads, and the deck."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from io import StringIO
from itertools import pairwise

import numpy as np

from validation.calculix.crowned import Spatial, element_lines
from validation.calculix.deck import LAST_ONLY, write_material, write_set
from validation.calculix.fillet import fillets
from validation.calculix.grading import graded
from validation.calculix.section import Fineness, gear_section
from validation.calculix.tooth_form import Array, ToothForm

AROUND = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0)], dtype=float)
"""Nodes of a quadratic face: along the profile, along the face."""
PLACES_IN_LAYER = 4
"""Gauss points of a line load in each layer."""


@dataclass(frozen=True)
class RingMeshing:
    """How fine the mesh is.

    Attributes
    ----------
    fillet : float [mm]
        On the fillets of the loaded tooth, below them, and the first layer of the rim.
    flank : float [mm]
        On its flank.
    beside, far : float [mm]
        On the neighbours and on all other teeth.
    end, layer : float [mm]
        Layers along the face, at its ends and at most.
    """

    fillet: float = 0.25
    flank: float = 0.7
    beside: float = 2.5
    far: float = 5.0
    end: float = 0.6
    layer: float = 2.5


@dataclass(frozen=True)
class Ring(Spatial):
    """A ring of twenty-node hexahedra, its section turned along the face.

    Attributes
    ----------
    levels : (layers + 1,) array [mm]
        Heights of the planes between the layers.
    twist : float [rad/mm]
        Turn of the section along the face.
    """

    levels: Array
    twist: float

    @property
    def heights(self) -> Array:
        """Of the planes between the layers (layers + 1,) [mm]."""
        return self.levels

    def _at(self, height: float) -> Array:
        """Nodes of the section at a height, (n, 3)."""
        turned = self.bottom.nodes @ turn(self.twist * height)
        return np.column_stack([turned, np.full(len(turned), height)])


def turn(angle: float) -> Array:
    """Matrix that turns row vectors."""
    return np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])


@dataclass(frozen=True)
class LoadedRing:
    """A ring whose tooth 0 carries line loads.

    Attributes
    ----------
    form : ToothForm
    ring : Ring
    """

    form: ToothForm
    ring: Ring

    def forces(
        self, rolls: tuple[float, float], line_loads: tuple[float, float] | Callable[[float], float]
    ) -> dict[int, Array]:
        """Nodal forces [N] of a line load on the flank at the larger angle of tooth 0.

        Parameters
        ----------
        rolls : (float, float)
            Roll length at mid-face [mm], and its change per length of face.
        line_loads : (float, float), or callable
            Normal force per length of face at mid-face [N/mm], and its relative change from there to its end; or the
            force per length over the height from mid-face [mm].
        """
        ring, levels = self.ring, self.ring.levels
        coordinates = ring.coordinates()[:, 1:]
        chosen = ring.bottom.flanks[0]
        chosen = chosen[np.argsort(np.hypot(*ring.bottom.nodes[ring.bottom.elements[chosen, 4]].T))]
        hexahedra = ring.hexahedra()[:, 1:] - ring.first_node
        places, weights = np.polynomial.legendre.leggauss(PLACES_IN_LAYER)
        total: dict[int, Array] = {}
        for layer, (low, high) in enumerate(pairwise(levels.tolist())):
            for part, weight in zip(places, weights, strict=True):
                height = 0.5 * (low + high) + 0.5 * part * (high - low)
                radius = math.hypot(self.form.base_radius, rolls[0] + rolls[1] * height)
                line_load = (
                    line_loads(height)
                    if callable(line_loads)
                    else line_loads[0] * (1.0 + line_loads[1] * height / levels[-1])
                )
                load = line_load * 0.5 * weight * (high - low)
                element, along = self._place(chosen, radius)
                nodes = hexahedra[layer * len(ring.bottom.elements) + element]
                nodes = nodes[[0, 1, 5, 4, 8, 17, 12, 16]]  # first side of the section, drawn out
                shares, slopes = serendipity(along, part)
                normal = np.cross(*(slopes.T @ coordinates[nodes]))
                normal /= np.linalg.norm(normal)
                middle = shares @ coordinates[nodes]
                inwards = math.copysign(1.0, normal[0] * middle[1] - normal[1] * middle[0]) * normal
                for node, share in zip(nodes.tolist(), shares, strict=True):
                    total[node] = total.get(node, np.zeros(3)) + share * load * inwards
        return {node + ring.first_node: force for node, force in total.items()}

    def _place(self, chosen: Array, radius: float) -> tuple[int, float]:
        """Element of the section on the flank at a radius, and where along its first side, from -1 to 1."""
        fine = np.linspace(-1.0, 1.0, 201)
        for element in chosen:
            first, last, middle = np.hypot(*self.ring.bottom.nodes[self.ring.bottom.elements[element, [0, 1, 4]]].T)
            if min(first, last) <= radius <= max(first, last):
                along = first * 0.5 * fine * (fine - 1.0) + last * 0.5 * fine * (fine + 1.0) + middle * (1.0 - fine**2)
                order = np.argsort(along)
                return int(element), float(np.interp(radius, along[order], fine[order]))
        raise ValueError(f"no element of the flank is at radius {radius} mm")

    def text(self, loads: Mapping[str, Mapping[int, Array]]) -> str:
        """The whole deck; one step for each load."""
        out, ring = StringIO(), self.ring
        out.write("*NODE,NSET=NALL\n")
        np.savetxt(out, ring.coordinates(), fmt="%d,%.12g,%.12g,%.12g")
        out.write("*ELEMENT,TYPE=C3D20R,ELSET=EALL\n")
        out.writelines(element_lines(ring.hexahedra()))
        write_material(out, "")
        write_set(out, "BORE", ring.bore())
        out.write("*BOUNDARY\nBORE,1,3\n")
        for forces in loads.values():
            out.write("*STEP\n*STATIC,SOLVER=SPOOLES\n*CLOAD,OP=NEW\n")
            for node, force in forces.items():
                out.writelines(f"{node},{k + 1},{force[k]:.12g}\n" for k in range(3))
            out.write(f"*EL FILE{LAST_ONLY}\nS\n*END STEP\n")
        return out.getvalue()

    def stress(self, nodal: Array) -> tuple[Array, tuple[Array, Array]]:
        """Stress across the lengthwise lines of both fillets of tooth 0 at all levels.

        Parameters
        ----------
        nodal : (n, 6) array [MPa]
            Of all nodes: xx, yy, zz, xy, yz, zx.

        Returns
        -------
        (m,) array [rad]
            Tangent angles of the sections.
        pair of (m, levels) arrays [MPa]
            On the loaded side and on the back.
        """
        ring, found = self.ring, []
        for fillet in fillets(self.form, ring.bottom.nodes, 0.0, 0.0):
            x, y = ring.bottom.nodes[fillet.nodes].T
            along = _units(np.stack([-ring.twist * y, ring.twist * x, np.ones(len(x))], axis=-1))
            across = np.column_stack([fillet.tangent, np.zeros(len(x))])
            across = _units(across - np.einsum("nk,nk->n", across, along)[:, None] * along)
            columns = []
            for level, height in enumerate(ring.levels):
                turned = np.column_stack([across[:, :2] @ turn(ring.twist * height), across[:, 2]])
                nodes = ring.plane(level)[fillet.nodes] - ring.first_node
                tensor = nodal[nodes][:, [0, 3, 5, 3, 1, 4, 5, 4, 2]].reshape(-1, 3, 3)
                columns.append(np.einsum("nj,njk,nk->n", turned, tensor, turned))
            angle, told = fillet.told(np.stack(columns, axis=-1))
            found.append(told)
        return angle, (found[0], found[1])


def _units(vectors: Array) -> Array:
    """Vectors (n, 3) of unit length."""
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))


def loaded_ring(form: ToothForm, width: float, radius: float, meshing: RingMeshing = RingMeshing()) -> LoadedRing:
    """Ring with a fine tooth 0.

    Parameters
    ----------
    form : ToothForm
        The section turns by tan(beta)/r in the sense of the polar angle along +z.
    width : float [mm]
        Of the face.
    radius : float [mm]
        Where the flank is loaded at mid-face.
    meshing : RingMeshing
    """
    fine = {tooth: _even(radius, meshing.far) for tooth in range(form.teeth)}
    fine[1] = fine[form.teeth - 1] = _even(radius, meshing.beside)
    fine[0] = Fineness(radius, meshing.flank, 0.0, 0.0, 0.0, meshing.flank, meshing.fillet)
    first = meshing.fillet / (form.root_radius - form.bore_radius)
    layers = graded(1.0, 0.0, 0.0, first, 0.45, 0.35)
    section = gear_section(form, fine, layers, 0.0, 0.0, 1)
    quarter = 0.25 * width
    inner = graded(quarter, 0.0, 0.0, meshing.layer, 0.0, meshing.layer)[::2]
    outer = graded(quarter, 0.0, 0.0, meshing.layer, 0.0, meshing.layer, (math.inf, meshing.end))[::2]
    half = np.append(inner, quarter + outer[1:])
    levels = np.append(-half[:0:-1], half)
    twist = math.tan(form.helix_angle) / form.pitch_radius
    return LoadedRing(form, Ring(section, section, len(levels) - 1, 0.5 * width, 1, 1, levels, twist))


def _even(radius: float, size: float) -> Fineness:
    return Fineness(radius, size, 0.0, 0.0, 0.0, size)


def serendipity(u: float, v: float) -> tuple[Array, Array]:
    """Shape functions (8,) of a quadratic face and their slopes (8, 2)."""
    a, b = AROUND.T
    one, other = 1.0 + a * u, 1.0 + b * v
    between_u, between_v = a == 0.0, b == 0.0
    value = 0.25 * one * other * (a * u + b * v - 1.0)
    along_u = 0.25 * a * other * (2.0 * a * u + b * v)
    along_v = 0.25 * b * one * (a * u + 2.0 * b * v)
    for chosen, new, slope_u, slope_v in (
        (between_u, 0.5 * (1.0 - u**2) * other, -u * other, 0.5 * b * (1.0 - u**2)),
        (between_v, 0.5 * (1.0 - v**2) * one, 0.5 * a * (1.0 - v**2), -v * one),
    ):
        value, along_u, along_v = (
            np.where(chosen, *both) for both in ((new, value), (slope_u, along_u), (slope_v, along_v))
        )
    return value, np.stack([along_u, along_v], axis=-1)
