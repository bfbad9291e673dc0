"""Compliance of the teeth and bodies of a gear pair, over all tooth pairs that carry load at the same time."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.compliance.body import body_torsion
from loaded_tca.compliance.influence import FlankLine, GearCompliance, gear_compliance
from loaded_tca.compliance.layout import MeshDensity
from loaded_tca.compliance.teeth import layers_across
from loaded_tca.errors import named, require
from loaded_tca.flanks.base import Flank, outward_normal
from loaded_tca.material import LARGEST_RATIO_IN_BENDING, Material
from loaded_tca.threads import side_by_side

if TYPE_CHECKING:
    from collections.abc import Sequence

    from loaded_tca.arrays import Array, Indices
    from loaded_tca.pairs.gear import Gear
    from loaded_tca.pairs.gear_pair import ContactGrid, GearPair, MovedSlices

NEWTON_STEPS, NO_FURTHER = 2, 1e-3
"""From the tangent plane to the flank, a fiftieth of the distance along it: the second leaves 1e-6 of that. A step of
so much of the module is the last one, as of helical teeth, whose contact lines are straight."""
EVEN_PLACES = 9
"""Forces across the face that stand for an even one."""

TOGETHER = 2**15
"""Pairs of slices that are worked on together: the arrays of more leave the cache of a core."""

_LINES: WeakKeyDictionary[ContactGrid, dict[int, tuple[FlankLine, FlankLine]]] = WeakKeyDictionary()
"""Lines of the grids, by the numbers of the tooth pairs, on pinion and wheel."""


@checked
@dataclass(frozen=True, eq=False)
class ToothCompliance:
    """Bending, shear and foundation of both gears, beside the half-spaces of the contact solver.

    Attributes
    ----------
    pair : GearPair
    pinion, wheel : GearCompliance
    """

    pair: GearPair
    pinion: GearCompliance
    wheel: GearCompliance

    @cached_property
    def neighbours(self) -> int:
        """How many pitches two loaded tooth pairs may be apart."""
        return min(self.pinion.neighbours, self.wheel.neighbours)

    @property
    def body_torsion(self) -> tuple[float, float]:
        """Twist of the gear body between bore and root of pinion and wheel [mm/N].

        See :func:`loaded_tca.compliance.body.body_torsion`. It is a part of :meth:`within`, told to show what a bore
        diameter does; along the normal of helical teeth it is cos^2(beta_b) of that.
        """
        return body_torsion(self.pair)

    def mounted(self, pair: GearPair) -> ToothCompliance:
        """These teeth in a pair whose wheel stands elsewhere."""
        return replace(self, pair=pair)

    def within(self, number: int, grid: ContactGrid, under: ContactGrid | None = None) -> Array:
        """Deflection of every slice of a contact's grid per force on each, both gears together.

        It comes on top of the displacement of the two half-spaces that carry the same pressures.

        Parameters
        ----------
        number : int
            Of the tooth pair: 0 is in contact at the pitch point at phi1 = 0, +1 comes into mesh after it.
        grid : Separation or other ContactGrid
            Of its contact, in the angles of its own tooth: as if it were pair 0.
        under : the same, optional
            Slices of the same contact that carry the forces; default: those of the grid.

        Returns
        -------
        (m, n) array [mm/N]
            Symmetric where the slices are the same.
        """
        if under is None:
            return self.within_each([(number, grid)])[0]
        distance = np.hypot(grid.y[:, None] - under.y, grid.force_line[:, None] - under.force_line)
        lines, forces = self.lines(number, grid), self.lines(number, under)
        on_pinion, on_wheel = (
            gear.within(line, distance, force)
            for gear, line, force in zip((self.pinion, self.wheel), lines, forces, strict=True)
        )
        return on_pinion + on_wheel

    def within_each(self, contacts: Sequence[tuple[int, ContactGrid]]) -> list[Array]:
        """Results of :meth:`within` for the numbers and grids of several contacts; none depends on the others."""
        deflections: dict[int, Array] = {}
        for some in stacks_of([len(grid.y) for _, grid in contacts]):
            lines = self._lines([contacts[k] for k in some])
            y, across = (np.array([getattr(contacts[k][1], name) for k in some]) for name in ("y", "force_line"))
            distance = np.hypot(y[..., None] - y[:, None], across[..., None] - across[:, None])
            on_pinion, on_wheel = (
                gear.within_each([both[side] for both in lines], distance)
                for side, gear in enumerate((self.pinion, self.wheel))
            )
            deflections |= zip(some, on_pinion + on_wheel, strict=True)
        return [deflections[k] for k in range(len(contacts))]

    def between(self, at: tuple[int, ContactGrid], under: tuple[int, ContactGrid]) -> Array:
        """Deflection of every slice of one contact's grid per force on each slice of another's.

        Parameters
        ----------
        at, under : (int, Separation or other ContactGrid)
            Numbers of two different tooth pairs and grids of their contacts, as in :meth:`within`.

        Returns
        -------
        (m, n) array [mm/N]
            Its transpose is that of ``between(under, at)``.

        Raises
        ------
        InputError
            If the pairs are further apart than the modelled teeth.
        """
        there, here = self.lines(*at), self.lines(*under)
        return self.pinion.between(there[0], here[0]) + self.wheel.between(there[1], here[1])

    def deflection(self, at: tuple[int, ContactGrid], under: tuple[int, ContactGrid], forces: Array) -> Array:
        """Deflection (m,) [mm] of the slices of one contact's grid under forces (n,) [N] on those of another's.

        The product of :meth:`between` with the forces, without the matrix.
        """
        (there,), (here,) = self._lines([at]), self._lines([under])
        return self.pinion.deflection(there[0], here[0], forces) + self.wheel.deflection(there[1], here[1], forces)

    def deflection_growth(
        self,
        contacts: Sequence[tuple[int, ContactGrid]],
        state: Indices,
        forces: Array,
        moved: Sequence[MovedSlices],
    ) -> Array:
        """Growth (keys, n) [mm per unit] of the deflection of slices under forces as they are, as gears and grids move.

        The finite element models stay: the deflection follows the places of the forces on the flanks, which are found
        on both sides of each key. How it follows them is found once for all keys.

        Parameters are those of :class:`loaded_tca.compliance.model.BendingPart`.
        """
        grids = [grid for _, grid in contacts]
        numbers, sizes = np.array([number for number, _ in contacts]), [len(grid.y) for grid in grids]
        moves = np.empty((2, 2, len(moved), forces.size))
        for key, one in enumerate(moved):
            low, high = (self._parts(*side) for side in (one.low, one.high))
            moves[:, :, key] = (high - low) / one.difference
        in_row = np.split(np.arange(forces.size), np.cumsum(sizes)[:-1])
        loaded = [own[forces[own] != 0.0] for own in in_row]
        growth = np.zeros((len(moved), forces.size))
        for own in np.split(np.arange(len(grids)), np.flatnonzero(np.diff(state)) + 1):
            some = [loaded[k] - in_row[k][0] for k in own]
            distances = [
                np.hypot(*(np.subtract.outer(part[at], part[at]) for part in (grids[k].y, grids[k].force_line)))
                for k, at in zip(own, some, strict=True)
            ]
            coupled = np.abs(np.subtract.outer(numbers[own], numbers[own])) <= self.neighbours
            lines = [self.lines(*contacts[k]) for k in own]
            for side, gear in enumerate((self.pinion, self.wheel)):
                on_flank = [
                    FlankLine(line[side].tooth, line[side].rho[at], line[side].z[at])
                    for line, at in zip(lines, some, strict=True)
                ]
                parts = [moves[side][..., loaded[k]] for k in own]
                grown = gear.deflection_growth(on_flank, distances, [forces[loaded[k]] for k in own], parts, coupled)
                growth[:, np.concatenate([loaded[k] for k in own])] += np.concatenate(grown, axis=1)
        return growth

    def _parts(self, pair: GearPair, grids: Sequence[ContactGrid]) -> Array:
        """Parts (2, 2, n) of height and face width at which the slices of grids lie on both gears, these in a pair."""
        sizes = np.array([len(grid.y) for grid in grids])
        first, parts = np.cumsum(sizes) - sizes, np.empty((2, 2, sizes.sum()))
        for count in np.unique(sizes).tolist():
            alike = np.flatnonzero(sizes == count)
            in_row = first[alike, None] + np.arange(count)
            on_flanks = _on_flanks(pair, [grids[k] for k in alike.tolist()])
            for own, gear, places in zip(parts, (self.pinion, self.wheel), on_flanks, strict=True):
                own[:, in_row] = gear.frame.parts(*places)
        return parts

    def lines(self, number: int, grid: ContactGrid) -> tuple[FlankLine, FlankLine]:
        """Places of the forces of a grid's slices on the flanks of pinion and wheel; kept as long as the grid is.

        Parameters are those of :meth:`within`. Normal forces of the slices at these lines load the roots of the teeth.
        """
        return self._lines([(number, grid)])[0]

    def _lines(self, contacts: Sequence[tuple[int, ContactGrid]]) -> list[tuple[FlankLine, FlankLine]]:
        """The same of several contacts with equally many slices."""
        kept = [_LINES.setdefault(grid, {}) for _, grid in contacts]
        missing = [k for k, (number, _) in enumerate(contacts) if number not in kept[k]]
        if missing:
            for k, lines in zip(missing, lines_of_each(self.pair, [contacts[k] for k in missing]), strict=True):
                kept[k][contacts[k][0]] = lines
        return [lines[number] for lines, (number, _) in zip(kept, contacts, strict=True)]


def stacks_of(slices: Sequence[int]) -> list[list[int]]:
    """Places of contacts that are worked on together: those with equally many slices, as many as fit the cache."""
    stacks = []
    for count in dict.fromkeys(slices):
        alike, size = [k for k, own in enumerate(slices) if own == count], max(1, TOGETHER // count**2)
        stacks += [alike[first : first + size] for first in range(0, len(alike), size)]
    return stacks


def flank_lines(pair: GearPair, number: int, grid: ContactGrid) -> tuple[FlankLine, FlankLine]:
    """Places on the flanks of pinion and wheel where the forces of the slices of a contact's grid act.

    The normal of the contact meets them there: far along the contact flanks of spiral teeth leave its tangent plane.

    Parameters
    ----------
    pair : GearPair
    number : int
        Of the tooth pair: 0 is in contact at the pitch point at phi1 = 0, +1 comes into mesh after it.
    grid : Separation or PressureMap
        In the angles of its own tooth: as if it were pair 0.
    """
    return lines_of_each(pair, [(number, grid)])[0]


def lines_of_each(pair: GearPair, contacts: Sequence[tuple[int, ContactGrid]]) -> list[tuple[FlankLine, FlankLine]]:
    """Results of :func:`flank_lines` for the numbers and grids of contacts with equally many slices."""
    (rho, z), (radius, axial) = _on_flanks(pair, [grid for _, grid in contacts])
    return [
        (FlankLine(-pair.sense * number, rho[k], z[k]), FlankLine(pair.sense * number, radius[k], axial[k]))
        for k, (number, _) in enumerate(contacts)
    ]


def _on_flanks(pair: GearPair, grids: Sequence[ContactGrid]) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """Radii and axial places (k, n) on pinion and wheel of the slices of k grids with equally many [mm]."""
    names = "origin", "axes", "force_line", "y"
    origin, axes, across, along = (np.array([getattr(grid, name) for grid in grids]) for name in names)
    points = origin[:, None] + across[..., None] * axes[:, None, 0] + along[..., None] * axes[:, None, 1]
    points = _on_flank(pair.pinion.nominal_flank, points, axes[:, 2], origin, NO_FURTHER * pair.module)
    return (np.hypot(points[..., 0], points[..., 1]), points[..., 2]), pair.on_wheel(points)


def _on_flank(flank: Flank, points: Array, normal: Array, origin: Array, enough: float) -> Array:
    """Points (k, n, 3) moved along normals (k, 3) onto a flank through origins (k, 3); where none is they stay."""
    moved, left = points.copy(), np.arange(len(points))
    turned = (
        np.arctan2(origin[:, 1], origin[:, 0]) - flank.theta(np.hypot(origin[:, 0], origin[:, 1]), origin[:, 2]).value
    )
    for _ in range(NEWTON_STEPS):
        (x, y, z), (nx, ny, nz) = moved[left].transpose(2, 0, 1), normal[left].T[..., None]
        rho = np.hypot(x, y)
        theta = flank.theta(rho, z)
        off = np.arctan2(y, x) - theta.value - turned[left, None]
        off = np.remainder(off + math.pi, 2.0 * math.pi) - math.pi
        step = off / ((x * ny - y * nx) / rho**2 - theta.rho * ((x * nx + y * ny) / rho) - theta.z * nz)
        moved[left] -= step[..., None] * normal[left, None]
        left = left[(np.abs(step) > enough).any(axis=1)]
        if not left.size:
            break
    return np.where(np.isfinite(moved).all(axis=-1, keepdims=True), moved, points)


def tooth_compliance(pair: GearPair, *, neighbours: int = 1, density: MeshDensity | None = None) -> ToothCompliance:
    """Make the finite element models of both gears, from their flanks without modifications.

    Parameters
    ----------
    pair : GearPair
    neighbours : int
        How many pitches two loaded tooth pairs may be apart.
    density : MeshDensity, optional
        Default: 4 elements through the tooth, 6 up the flank, and as many across the face as its width asks for.

    Raises
    ------
    InputError
        If a bore reaches the teeth or Poisson's ratio is above 0.49; the gear is named.
    GeometryError
        If a tooth is pointed or cut off; the gear is named.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> from loaded_tca.separation import sample_separation
    >>> from loaded_tca.unloaded import trace_contact
    >>> mesh = CylindricalMesh(*(CylindricalGear(teeth=z, normal_module=3.0, face_width=10.0) for z in (25, 37)))
    >>> pair = cylindrical_pair(mesh)
    >>> compliance = tooth_compliance(pair)
    >>> separation = sample_separation(pair, trace_contact(pair, [0.0])[0], cells=(4, 10), box=(0.2, 5.0))
    >>> float(compliance.within(0, separation).mean().round(8))  # of an even force
    4.25e-06
    """

    def model(name: str, gear: Gear) -> GearCompliance:
        with named(name):
            require_bending(gear.material)
            return gear_compliance(gear, replace(density or default_density(gear), neighbours=neighbours))

    pinion, wheel = side_by_side(partial(model, "pinion", pair.pinion), partial(model, "wheel", pair.wheel))
    return ToothCompliance(pair, pinion, wheel)


def rim_compliance(pair: GearPair) -> tuple[float, float]:
    """Displacement of both gears along the transverse line of action per force spread over the face [mm/N].

    Half the force is on the tooth that moves, half on its neighbour, at the middle of the flanks: as bodies give way in
    a mesh. A coarse model, with one layer of elements across the face, within 2 % of the model of an analysis.

    Raises
    ------
    InputError, GeometryError
        As of :func:`tooth_compliance`.
    """
    pinion, wheel = (
        _even_force(gear, base_radius)
        for gear, base_radius in zip((pair.pinion, pair.wheel), pair.base_radii, strict=True)
    )
    return pinion, wheel


def _even_force(gear: Gear, base_radius: float) -> float:
    model = gear_compliance(gear, MeshDensity(lengthwise=1))
    rho, z = (places[1, 1:-1:2] for places in gear.nominal_flank.grid(3, 2 * EVEN_PLACES + 1))
    tooth, neighbour = FlankLine(0, rho, z), FlankLine(1, rho, z)
    distance = np.hypot(rho[:, None] - rho, z[:, None] - z)
    displacement = 0.5 * (model.within(tooth, distance).mean() + model.between(tooth, neighbour).mean())
    lever = float((rho * np.abs(outward_normal(gear.nominal_flank, rho, z)[:, 1])).mean())
    return float(displacement) * (base_radius / lever) ** 2


def require_bending(material: Material) -> None:
    """Refuse a material whose finite elements would lock."""
    ratio = material.poisson_ratio
    bends = ratio <= LARGEST_RATIO_IN_BENDING
    require((bends, f"poisson_ratio: {ratio} is above {LARGEST_RATIO_IN_BENDING}: finite elements would lock"))


def default_density(gear: Gear) -> MeshDensity:
    """Density whose layers follow the face width."""
    return MeshDensity(lengthwise=layers_across(gear))
