"""The crowned pair in space: the plane meshes drawn out along half the face, loaded at the pitch point."""

from __future__ import annotations

from dataclasses import dataclass, replace
from io import StringIO

import numpy as np

from validation.calculix.case import CENTRE_DISTANCE, FACE_WIDTH, VARIANTS, line_load
from validation.calculix.deck import (
    surface_name,
    write_contact_pairs,
    write_hub,
    write_material,
    write_set,
    write_steps,
    write_turning_together,
)
from validation.calculix.mesh_position import Position
from validation.calculix.model import Meshing, flank_within_reach, sections, surface_reach, touching_pairs
from validation.calculix.section import Ints, Section
from validation.calculix.steel import PENALTY
from validation.calculix.tooth_form import Array

CROWNING = 0.010
"""Lead crowning of the pinion, parabolic, at the ends of the face [mm]."""
TORQUE = 100.0
"""Pinion torque [N m]."""
LAYERS = 12
"""Layers of elements along half the face."""
SPATIAL_MESHING = Meshing(per_half_width=1.6, growth=0.5, coarsest=1.2, beside=2.5, far=5.0, rim=0.25)
"""Coarser than the plane mesh (two elements to the half width at mid-face); the mesh study tells what that changes."""


@dataclass(frozen=True)
class Spatial:
    """A gear of twenty-node hexahedra: plane meshes at the ends of the layers and at their corners' midpoints.

    Attributes
    ----------
    bottom, top : Section
        At the plane of symmetry and at the end of the face; the same numbers of nodes, only moved.
    layers : int
    half_face : float [mm]
    first_node, first_element : int
    """

    bottom: Section
    top: Section
    layers: int
    half_face: float
    first_node: int
    first_element: int

    @property
    def corners(self) -> Ints:
        """Nodes of the section that are corners of elements."""
        return np.unique(self.bottom.elements[:, :4])

    @property
    def last_node(self) -> int:
        """Number of the last node."""
        count = len(self.bottom.nodes) * (self.layers + 1) + self.corners.size * self.layers
        return self.first_node + count - 1

    @property
    def last_element(self) -> int:
        """Number of the last element."""
        return self.first_element + len(self.bottom.elements) * self.layers - 1

    @property
    def heights(self) -> Array:
        """Of the planes between the layers (layers + 1,) [mm]."""
        return np.linspace(0.0, self.half_face, self.layers + 1)

    def plane(self, level: int) -> Ints:
        """Numbers of all nodes between two layers."""
        return self.first_node + len(self.bottom.nodes) * level + np.arange(len(self.bottom.nodes))

    def bore(self) -> Ints:
        """Numbers of the nodes on the bore."""
        between = np.flatnonzero(np.isin(self.corners, self.bottom.bore))
        levels = [self.plane(level)[self.bottom.bore] for level in range(self.layers + 1)]
        return np.concatenate([*levels, *(self.between(layer)[between] for layer in range(self.layers))])

    def coordinates(self) -> Array:
        """Number, x, y, z of all nodes: the planes, then the corners halfway between them."""
        heights = self.heights
        planes = [self._at(height) for height in heights]
        between = [self._at(height)[self.corners] for height in 0.5 * (heights[1:] + heights[:-1])]
        places = np.concatenate([*planes, *between])
        return np.column_stack([np.arange(self.first_node, self.last_node + 1), places])

    def hexahedra(self) -> Ints:
        """Number and twenty nodes of all elements."""
        corners, middles = self.bottom.elements[:, :4], self.bottom.elements[:, 4:]
        upright = np.searchsorted(self.corners, corners)
        layers = [
            np.hstack([low[corners], high[corners], low[middles], high[middles], self.between(layer)[upright]])
            for layer in range(self.layers)
            for low, high in [(self.plane(layer), self.plane(layer + 1))]
        ]
        return np.column_stack([np.arange(self.first_element, self.last_element + 1), np.concatenate(layers)])

    def formatted(self, elements: Ints, layer: int) -> Ints:
        """Numbers of the hexahedra over section elements."""
        return self.first_element + layer * len(self.bottom.elements) + elements

    def between(self, layer: int) -> Ints:
        """Numbers of the corner nodes in the middle of a layer."""
        planes = len(self.bottom.nodes) * (self.layers + 1)
        return self.first_node + planes + self.corners.size * layer + np.arange(self.corners.size)

    def _at(self, height: float) -> Array:
        """Nodes of the section at a height, (n, 3)."""
        crowned = (height / self.half_face) ** 2
        plane = self.bottom.nodes + crowned * (self.top.nodes - self.bottom.nodes)
        return np.column_stack([plane, np.full(len(plane), height)])


@dataclass(frozen=True)
class SpatialDeck:
    """Half the crowned pair; the contact of each layer is a contact pair of its own, so that its force is printed.

    Attributes
    ----------
    pinion, wheel : Spatial
    flanks : pair of int arrays
        Section elements that may touch, of pinion and wheel.
    hub_force : float [N]
        On half the face.
    penalty : float [MPa/mm]
    load_steps : tuple of float
    """

    pinion: Spatial
    wheel: Spatial
    flanks: tuple[Ints, Ints]
    hub_force: float
    penalty: float = PENALTY
    load_steps: tuple[float, ...] = (1.0,)

    def text(self) -> str:
        """The whole deck."""
        out = StringIO()
        bodies = (self.pinion, self.wheel)
        out.write("*NODE,NSET=NALL\n")
        for body in bodies:
            np.savetxt(out, body.coordinates(), fmt="%d,%.12g,%.12g,%.12g")
        out.write("*ELEMENT,TYPE=C3D20R,ELSET=EALL\n")
        for body in bodies:
            out.writelines(element_lines(body.hexahedra()))
        write_material(out, "")
        self._write_contact(out)
        self._write_hubs(out)
        write_steps(out, int(self.pinion.bore()[0]), self.hub_force, self.load_steps, range(self.pinion.layers))
        return out.getvalue()

    def _write_contact(self, out: StringIO) -> None:
        """Layer against layer; no face may belong to two contact pairs, or the program loses part of the contact."""
        for layer in range(self.pinion.layers):
            for gear, body, flank in zip("PW", (self.pinion, self.wheel), self.flanks, strict=True):
                out.write(f"*SURFACE,NAME={surface_name(gear, layer)},TYPE=ELEMENT\n")
                out.writelines(f"{element},S3\n" for element in body.numbers(flank, layer))
        write_contact_pairs(out, range(self.pinion.layers), self.penalty)

    def _write_hubs(self, out: StringIO) -> None:
        """Rigid bores, and the plane of symmetry."""
        write_hub(out, "PBORE", self.pinion.bore(), 0.0)
        write_hub(out, "WBORE", self.wheel.bore(), CENTRE_DISTANCE)
        write_turning_together(out, self.pinion.bore())
        write_set(out, "SYMMETRY", np.concatenate([self.pinion.plane(0), self.wheel.plane(0)]))
        out.write("*BOUNDARY\nSYMMETRY,3,3\nPBORE,1,1\nPBORE,3,3\nWBORE,1,3\n")


def crowned_deck(
    setback: float, meshing: Meshing = SPATIAL_MESHING, layers: int = LAYERS, crowning: float = CROWNING
) -> tuple[Position, SpatialDeck]:
    """Deck of the crowned pair, or one without crowning, at the pitch point.

    Parameters
    ----------
    setback : float [mm]
        Expected at mid-face.
    meshing : Meshing
    layers : int
    crowning : float [mm]
        Of the pinion's lead, parabolic, at the ends of the face.
    """
    pinion, wheel = VARIANTS["unmodified"]
    position = Position(pinion, wheel, CENTRE_DISTANCE, 0.0, setback)
    crowned = replace(position, pinion=replace(pinion, thinning=crowning))
    touches = touching_pairs(position)
    load = line_load(TORQUE)
    bottom, mating = sections(position, touches, load, meshing)
    top, _ = sections(crowned, touches, load, meshing)
    first = Spatial(bottom, top, layers, 0.5 * FACE_WIDTH, 1, 1)
    second = Spatial(mating, mating, layers, 0.5 * FACE_WIDTH, first.last_node + 1, first.last_element + 1)
    reach = surface_reach(position, touches[0], load)
    flanks = (
        flank_within_reach(bottom, 0, 0.0, touches[0].pinion_radius, reach),
        flank_within_reach(mating, 0, CENTRE_DISTANCE, touches[0].wheel_radius, reach),
    )
    force = 0.5 * FACE_WIDTH * load * pinion.base_radius / pinion.bore_radius
    return position, SpatialDeck(first, second, flanks, force)


def element_lines(table: Ints) -> list[str]:
    """Lines of at most sixteen entries, as the program wants them."""
    return [f"{','.join(map(str, row[:16]))},\n{','.join(map(str, row[16:]))}\n" for row in table.tolist()]
