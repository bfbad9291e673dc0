r"""Arcs of rounded edges that loaded contacts reach, and the pressure that each can have at the most.

What a contact can come to is told beforehand by its cell beside the edge. Beside a sharp edge pressure rises as
:math:`K/\sqrt{s}`, so that a cell of the width h has the mean :math:`p = 2 K/\sqrt{h}`, and a rounding of the radius R
turns that into

.. math:: p_{max} = 1.80\, K/\sqrt{d}, \qquad d = \frac{1}{2} \left(\frac{3 \sqrt{2} \pi K R}{E^*}\right)^{2/3},

the limit of small d of a flat punch with rounded ends (Ciavarella, Hills & Monno 1998). That is :math:`0.90\, p
\sqrt{h/d}`; :math:`0.90\, p \sqrt{h/d + 1.5}` is a bound that holds on fine cells, too
(``validation/loaded/rounded_edges.py``). It tells which contacts can hold the largest pressure of a mesh cycle. There
is no bound where a sharp edge ends a rounded one within the contact, or a relief start crosses it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.contact.edges import RoundedEdge
from loaded_tca.edges.places import (
    arcs_of,
    dilated,
    edge_distances,
    lengths_past_tangents,
    relief_start_distances,
)
from loaded_tca.flanks.base import EDGE_NAMES
from loaded_tca.flanks.rounding import Arc, material_cosines
from loaded_tca.loaded.cycle import CycleSolution
from loaded_tca.loaded.loaded_contact import LoadedContact
from loaded_tca.pairs.gear import Gear
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.separation.flank_places import FlankPlaces

PEAK_OF_ROUNDING = 1.80
"""Of the pressure at a rounded edge, over K/sqrt(d)."""
ON_FINE_CELLS = 1.5
"""Added to h/d in the bound: cells narrower than the pressed part of a rounding have nearly its peak."""
STEP = 0.1
"""Of the lengths of a cell: that over which the direction of an edge is told."""
STEPS_TO_EDGE = 2
"""From a cell to where an arc begins: the second leaves what bends on a cell's length, to the fourth power."""
SIDES = {EDGE_NAMES.index("lower side"), EDGE_NAMES.index("upper side")}
"""Numbers of the ends of the face among the edges of a gear."""
PARALLEL = 0.1
"""Sine of the angle between two edges below which they are those of both gears at one end."""


class ReachedArc(NamedTuple):
    """The arc of an edge, or of those of both gears at one place, within a cell of a contact's pressure.

    Attributes
    ----------
    lines : tuple of RoundedEdge
        Where it begins, in the plane of the contact's grid: one, or those of both gears within a cell of each other.
    bound : float [MPa]
        Of the pressure there, away from sharp edges.
    ends_sharp, at_relief_start : bool
        Whether a sharp edge ends it, and whether a relief start crosses it, within a cell of the contact.
    """

    lines: tuple[RoundedEdge, ...]
    bound: float
    ends_sharp: bool = False
    at_relief_start: bool = False

    @property
    def limit(self) -> float:
        """Of the pressure there, all along the edge [MPa]."""
        return math.inf if self.ends_sharp or self.at_relief_start else self.bound

    @property
    def radius(self) -> float:
        """Of one arc from whose beginning the gap opens as fast as from those of all lines [mm]."""
        return 1.0 / sum(1.0 / line.radius for line in self.lines)

    @property
    def crosses_contact(self) -> bool:
        """Whether the edge lies across the contact rather than along it."""
        across, along = np.abs(self.lines[0].direction)
        return bool(along > across)


ArcsInCycle = dict[tuple[int, int, int], list[ReachedArc]]
"""Arcs that contacts reach, the one with the highest bound first, by the indices of torque, position, tooth pair."""


class _BesideCell(NamedTuple):
    """A rounded edge, the pressure of the cell beside it [MPa], its width [mm], and what takes the limit from it."""

    line: RoundedEdge
    pressure: float
    width: float
    ends_sharp: bool
    at_relief_start: bool


def reached_arcs(pair: GearPair, loaded: LoadedContact) -> list[ReachedArc]:
    """Arcs of edges within a cell of the pressure of a contact, the one with the highest bound first.

    An edge is a straight line beside the cell there with the largest pressure.
    """
    grid, arcs = loaded.separation, arcs_of(pair)
    seen, (dx, dy) = _Beginnings(pair, loaded), grid.spacing
    places, pressed = seen.at(grid.x[:, None], grid.y), dilated(loaded.solution.pressure_on_material > 0.0)
    lengths, distances = lengths_past_tangents(pair, *places), edge_distances(pair, *places)
    beyond_start = relief_start_distances(pair, *places) > 0.0
    groups: list[list[_BesideCell]] = []
    for edge, (gear, arc) in arcs.items():
        pressure = np.where(lengths[..., edge] > -math.hypot(dx, dy), loaded.solution.pressure_on_material, 0.0)
        if not pressure.any():
            continue
        row, column = np.unravel_index(int(pressure.argmax()), pressure.shape)
        place, slope = seen.nearest(edge, np.array([grid.x[row], grid.y[column]]))
        line = RoundedEdge(
            (float(place[0]), float(place[1])),
            (float(slope[0]), float(slope[1])),
            arc.radius,
            _material_angle(gear, arc, [part[row, column] for part in places[gear is pair.wheel]]),
            pair.contact_modulus / gear.material.plane_strain_modulus,
        )
        width = float(np.abs(slope) @ (dx, dy)) / math.hypot(*slope)
        group = next((one for one in groups if _is_beside(one[0].line, line, width)), None)
        if group is None:
            groups.append(group := [])
        beyond_sharp = (distances[..., [other for other in _ends_of(edge) if other not in arcs]] < 0.0).any(axis=-1)
        beside = pressed & dilated(lengths[..., edge] > 0.0)
        ends_sharp = bool((beside & dilated(beyond_sharp)).any())
        crossed = bool((beyond_start[beside].any(axis=0) & ~beyond_start[beside].all(axis=0)).any())
        group.append(_BesideCell(line, float(pressure.max()), width, ends_sharp, crossed))
    return sorted((_joined(group, pair.contact_modulus) for group in groups), key=lambda one: -one.bound)


class _Beginnings(FlankPlaces):
    """Lines where the arcs of a loaded contact begin."""

    def __init__(self, pair: GearPair, loaded: LoadedContact) -> None:
        super().__init__(pair, loaded.separation)
        self.pair, self.spacing = pair, np.array(loaded.separation.spacing)

    def nearest(self, edge: int, place: Array) -> tuple[Array, Array]:
        """Place (2,) where an arc begins, the nearest to one within a cell or two, and how fast lengths grow there."""
        ways = np.diag(STEP * self.spacing)
        around = np.concatenate([np.zeros((1, 2)), ways, -ways])
        for _ in range(STEPS_TO_EDGE):
            length, *beside = lengths_past_tangents(self.pair, *self.at(*(place + around).T))[:, edge]
            slope = np.subtract(beside[:2], beside[2:]) / (2.0 * STEP * self.spacing)
            place = place - length / (slope @ slope) * slope
        return place, slope


def _ends_of(edge: int) -> list[int]:
    """Edges of both gears that can cross an edge: sides a tip or a root, tips and roots a side."""
    count = len(EDGE_NAMES)
    return [other for other in range(2 * count) if (other % count in SIDES) != (edge % count in SIDES)]


def _is_beside(line: RoundedEdge, other: RoundedEdge, distance: float) -> bool:
    """Whether two edges face the same way within a distance [mm]: those of both gears where the faces are flush."""
    normal, direction = line.direction, other.direction
    apart = abs(float(normal @ np.subtract(other.place, line.place)))
    return bool(abs(normal[0] * direction[1] - normal[1] * direction[0]) < PARALLEL and normal @ direction > 0.0) and (
        apart < distance
    )


def _joined(group: list[_BesideCell], contact_modulus: float) -> ReachedArc:
    """An edge of the lines that lie beside each other: the gap opens as fast as with one radius, 1/r = sum 1/r_k."""
    lines, pressures, widths, ends_sharp, at_relief_start = zip(*group, strict=True)
    reached = ReachedArc(lines, 0.0, any(ends_sharp), any(at_relief_start))
    return reached._replace(bound=largest_pressure(max(pressures), max(widths), reached.radius, contact_modulus))


def largest_pressure(mean: float, width: float, radius: float, contact_modulus: float) -> float:
    """Pressure [MPa] that a rounded edge can have if a cell beside it, so wide [mm], has this mean pressure [MPa]."""
    intensity = 0.5 * mean * math.sqrt(width)
    pressed = 0.5 * (3.0 * math.sqrt(2.0) * math.pi * intensity * radius / contact_modulus) ** (2.0 / 3.0)
    return 0.5 * PEAK_OF_ROUNDING * mean * math.sqrt(width / pressed + ON_FINE_CELLS)


def _material_angle(gear: Gear, arc: Arc, place: Sequence[Array]) -> float:
    """Angle [rad] of the material between the flank and the surface beyond an arc, beside a place of the contact."""
    return math.acos(float(material_cosines(gear.flank, arc.edge, *place)))


def arcs_in_cycle(pair: GearPair, carried: CycleSolution) -> ArcsInCycle:
    """Arcs that the contacts of a mesh cycle reach, by the indices of torque, position and tooth pair."""
    return {
        (t, n, k): arcs
        for t, positions in enumerate(carried.contacts)
        for n, row in enumerate(positions)
        for k, loaded in enumerate(row)
        if loaded is not None and loaded.at_arc and (arcs := reached_arcs(pair, loaded))
    }
