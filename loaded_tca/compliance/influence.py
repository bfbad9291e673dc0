r"""Compliance of one gear: displacement along the line of action at one place of a flank under a force at another.

The contact solver takes each flank for a half-space, whose displacement it measures from infinity. What the gear adds:

.. math:: c(p, q) = u_{FE}(\text{middle below } p;\ q) - u_B(t_p, |p - q|) + c_{loc}\,k(p, q)

u_FE is the displacement of the gear body under a unit force at q, where the line of action through p cuts the middle of
the tooth; u_B that of the half-space at the same depth t (it is part of u_FE, and would count twice); c_loc the local
term of a line force in the plane, spread along the face by a normal distribution k of 3.7 mean depths of the middle,
with its mirror images beyond the ends of the face: along a whole face width the local term is that of the plane.
It belongs to the back of the tooth, which follows short waves of the load no more: so the sections of teeth say that
carry waves of load along the face (``validation/loaded/local_term.py``). Beside a free end a tooth gives way more: the
local term is half as large again there under an even load. The images have a second normal distribution for that, as
wide as the mean depth (``validation/loaded/face_ends_space.py``). Another tooth of the gear has the first term only.

References
----------
Weber, Banaschek 1953, Formänderung und Profilrücknahme bei gerad- und schrägverzahnten Rädern (the same split in plane
strain).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from weakref import WeakKeyDictionary, ref

import numpy as np
from numpy.polynomial.chebyshev import chebder, chebvander

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, Indices, Mask
from loaded_tca.compliance.body import ToothFrame, gear_nodes
from loaded_tca.compliance.flexibility import (
    ToothFlexibility,
    depth_displacement,
    depth_displacement_by_depth,
    kept_flexibility,
)
from loaded_tca.compliance.kept import MOST_IN_MEMORY, forget_kept
from loaded_tca.compliance.layout import MeshDensity
from loaded_tca.errors import InputError
from loaded_tca.material import Material
from loaded_tca.pairs.gear import Gear
from loaded_tca.tooth.families import ToothGeometry


@checked
@dataclass(frozen=True, eq=False)
class FlankLine:
    """Places along a line on one flank of a gear.

    Attributes
    ----------
    tooth : int
        Tooth of the gear, counted in the sense of +theta.
    rho, z : (m,) array [mm]
        In the gear's own frame; places beyond the flank count as its edge. Of several lines (k, m).
    """

    tooth: int
    rho: Array
    z: Array


SPREAD = 3.7
"""Standard deviation of the spread of the local term along the face, over the mean depth of the middle of the tooth."""
END_SPREAD = 1.0
"""The same of what free ends of the face add, from finite elements in space of a gear of 25 teeth with nu = 0.3: the
images in an end have 0.6, 0.8 and 0.9 of the local term in all when 0.15, 0.5 and 0.85 of the flank are loaded, and
fall to half within 1.7 mean depths. Both distributions together have 1."""


@checked
@dataclass(frozen=True, eq=False)
class GearCompliance:
    """Compliance of one gear, made once.

    Attributes
    ----------
    frame : ToothFrame
    table : ToothFlexibility
        What the finite elements say.
    """

    frame: ToothFrame
    table: ToothFlexibility

    @cached_property
    def neighbours(self) -> int:
        """Teeth on either side of a loaded one whose displacement is known."""
        return len(self.table.displacement) // 2

    def between(self, at: FlankLine, under: FlankLine) -> Array:
        """Displacements (m, n) of the middles of the teeth below m places per force at n others [mm/N].

        As the finite elements have them, the mean of both ways: forces act on the flank, displacements are taken in
        the middle, so that they are reciprocal but for a few per cent.

        Parameters
        ----------
        at, under : FlankLine

        Raises
        ------
        InputError
            If the two are further apart than the teeth of the model.
        """
        return self._displaced(self._away(at, under), self._places(at), self._places(under))

    def deflection(self, at: FlankLine, under: FlankLine, forces: Array) -> Array:
        """Displacements (m,) [mm] under forces (n,) [N] at the others: the product of :meth:`between` with them."""
        away, there, here = self._away(at, under), self._places(at), self._places(under)
        on_table = here.gathered(forces)
        return there.read((self._mutual[self.neighbours + away] @ on_table.ravel()).reshape(on_table.shape))

    def _away(self, at: FlankLine, under: FlankLine) -> int:
        """Pitches from the tooth of one line to that of another."""
        teeth = self.frame.gear.form.teeth
        away = (at.tooth - under.tooth + teeth // 2) % teeth - teeth // 2
        if abs(away) > self.neighbours:
            raise InputError(
                f"tooth: two loaded teeth are {abs(away)} pitches apart, the model has {self.neighbours} neighbours of "
                "a loaded tooth; ask for more neighbours"
            )
        return away

    def _places(self, line: FlankLine) -> _Places:
        """Places of a line among those of the table; kept as long as the line is."""
        kept = _KEPT.get(line)
        if kept is None or kept[0]() is not self:
            kept = _KEPT[line] = ref(self), _Places.of(self, line)
        return kept[1]

    def _displaced(self, away: int, at: _Places, under: _Places) -> Array:
        """Displacements at places of a tooth under forces at places of the one that stands so many pitches before."""
        return np.asarray(at.shares @ self._mutual[self.neighbours + away] @ under.shares.mT)

    def within(self, line: FlankLine, distance: Array, under: FlankLine | None = None) -> Array:
        """Displacements (m, n) of places of one tooth per force at others [mm/N], on top of those of a half-space.

        Of several lines (k, m, n).

        Parameters
        ----------
        line : FlankLine
            m places.
        distance : (m, n) or (k, m, n) array [mm]
            Between them and those of the forces, along the line.
        under : FlankLine, optional
            n places of the forces; default: the same ones.
        """
        at, there = self._places(line), self._places(line if under is None else under)
        spread = self._spread_along(distance, self._images(at, there))
        displacements = self._local(at, spread, distance)
        mutual = displacements.mT if under is None else self._local(there, spread.mT, distance.mT).mT
        return self._displaced(0, at, there) + 0.5 * (displacements + mutual)

    def _images(self, at: _Places, under: _Places) -> tuple[Array, Array]:
        """Distances (m, n) of places to the mirror images of others beyond both ends of the face [mm]."""
        width, *_ = self._spread
        from_start = width * (at.length[..., None] + under.length[..., None, :])
        return from_start, 2.0 * width - from_start

    def _spread_along(self, distance: Array, images: tuple[Array, Array]) -> Array:
        """Line density [1/mm], whose integral over the distances of a line is 1, and what free ends add."""
        _, deviation, at_end = self._spread
        return _normal(deviation, distance, *images) + _normal(at_end, *images)

    def _local(self, places: _Places, spread: Array, distance: Array) -> Array:
        """Local term (m, n) less what the half-space counts, by the depth below the m places."""
        depth = places.read(self.table.depth)[..., None]
        half_space = depth_displacement(depth, distance, self.frame.gear.material)
        local = np.interp(places.height, self.table.local_height, self.table.local_value)
        return np.asarray(local[..., None] * spread - half_space)

    def within_each(self, lines: Sequence[FlankLine], distance: Array) -> Array:
        """Results (k, m, m) of :meth:`within` for k lines of m places each; none depends on the others."""
        together = FlankLine(0, np.array([line.rho for line in lines]), np.array([line.z for line in lines]))
        displacements, places = self.within(together, distance), self._places(together)
        for k, line in enumerate(lines):
            _KEPT[line] = ref(self), places.some(k)
        return displacements

    def deflection_growth(
        self,
        lines: Sequence[FlankLine],
        distances: Sequence[Array],
        forces: Sequence[Array],
        moves: Sequence[Array],
        coupled: Mask,
    ) -> list[Array]:
        """Growth (keys, m) [mm per unit] of the displacements of places under forces as they are, as all places move.

        Displacements are reciprocal: that by the places of the forces follows from that by the places displaced.

        Parameters
        ----------
        lines : sequence of FlankLine
            m places on each of several teeth.
        distances : sequence of (m, m) arrays [mm]
            Between the places of each line, along it; they stay.
        forces : sequence of (m,) arrays [N]
            At the places of each line.
        moves : sequence of (2, keys, m) arrays [1 per unit]
            Growth of the parts of the flank's height and of the face width at which the places lie.
        coupled : (teeth, teeth) bool array
            Which teeth displace each other; each displaces itself.

        Raises
        ------
        InputError
            If two coupled teeth are further apart than those of the model.
        """
        moved = [_MovedPlaces.of(self, self._places(line), *move) for line, move in zip(lines, moves, strict=True)]
        on_tables = [
            np.stack([one.places.gathered(force), *one.gathered(force)])
            for one, force in zip(moved, forces, strict=True)
        ]
        growths = []
        for at, (line, one, distance, force) in enumerate(zip(lines, moved, distances, forces, strict=True)):
            displaced = np.zeros(on_tables[at].shape)
            for under in np.flatnonzero(coupled[at]).tolist():
                mutual, on_table = self._mutual[self.neighbours + self._away(line, lines[under])], on_tables[under]
                displaced += (on_table.reshape(len(on_table), -1) @ mutual.T).reshape(on_table.shape)
            growth = one.read(displaced[0]) + one.places.read(displaced[1:])
            growths.append(growth + self._local_growth(one, distance, force))
        return growths

    def _local_growth(self, moved: _MovedPlaces, distance: Array, forces: Array) -> Array:
        """Growth (keys, m) of the local term under forces on its places, less that of the half-space."""
        places, heights, values = moved.places, self.table.local_height, self.table.local_value
        (width, *deviations), images = self._spread, self._images(places, places)
        spread = self._spread_along(distance, images)
        from_start, from_end = (
            np.sum([_normal(one, image) * image / one**2 for one in deviations], axis=0) for image in images
        )
        flatter, local = width * (from_end - from_start), np.interp(places.height, heights, values)
        by_height = np.pad(np.diff(values) / np.diff(heights), 1)  # beyond its ends the local term is even
        softer = by_height[np.searchsorted(heights, places.height)] * moved.higher
        depth, deeper = places.read(self.table.depth)[:, None], moved.read(self.table.depth)
        half_space = depth_displacement_by_depth(depth, distance, self.frame.gear.material)
        growth = softer * (spread @ forces) + local * (moved.further * (flatter @ forces))
        growth += local * ((moved.further * forces) @ flatter) - deeper * (half_space @ forces)
        growth += (softer * forces) @ spread + (moved.further * (local * forces)) @ flatter
        growth += moved.further * (flatter @ (local * forces)) - (deeper * forces) @ half_space
        return np.asarray(0.5 * growth)

    @cached_property
    def _spread(self) -> tuple[float, float, float]:
        """Face width, and standard deviations of the spread of the local term along it and at its ends [mm]."""
        depth = float(self.table.depth.mean())
        return float(np.ptp(self.frame.nodes.coordinate)), SPREAD * depth, END_SPREAD * depth

    @cached_property
    def _mutual(self) -> Array:
        """Displacements as in ``displacement``, the mean of both ways."""
        return np.asarray(0.5 * (self.table.displacement + self.table.displacement[::-1].transpose(0, 2, 1)))

    @cached_property
    def interpolation(self) -> tuple[Array, Array]:
        """Chebyshev coefficients (a, a) and (b, b) of the Lagrange polynomials of the heights and the lengths."""
        nodes = self.table.heights, self.table.lengths
        across, along = (lagrange_coefficients(2.0 * part - 1.0) for part in nodes)
        return across, along


def _normal(deviation: float, *distances: Array) -> Array:
    """Sum of the densities [1/mm] of a normal distribution at distances (..., m, n) [mm]."""
    away = np.array(distances) / deviation
    return np.asarray(np.exp(-0.5 * away * away).sum(axis=0) / (math.sqrt(2.0 * math.pi) * deviation))


def lagrange_coefficients(nodes: Array) -> Array:
    """Chebyshev coefficients (n, n) of the Lagrange polynomials of nodes (n,) from -1 to 1."""
    return np.asarray(np.linalg.inv(chebvander(nodes, len(nodes) - 1)))


def shares_of_grid(across: Array, along: Array) -> Array:
    """Shares (..., m, a b) of a grid's places in m others, from those of heights (m, a) and lengths (m, b)."""
    shares = across[..., :, None] * along[..., None, :]
    return shares.reshape(*shares.shape[:-2], -1)


@dataclass(frozen=True, eq=False)
class _Places:
    """Parts (m,) of height and face width of the places of a line, and their Lagrange polynomials (m, a), (m, b).

    Of several lines (k, m), (k, m, a), (k, m, b).
    """

    height: Array
    length: Array
    across: Array
    along: Array

    @classmethod
    def of(cls, gear: GearCompliance, line: FlankLine) -> _Places:
        """Where a line lies among the places of a gear's table."""
        height, length = gear.frame.parts(line.rho, line.z)
        across, along = gear.interpolation
        angle = np.arccos(2.0 * np.array([height, length]) - 1.0)
        polynomials = np.cos(angle[..., None] * np.arange(max(len(across), len(along))))  # of Chebyshev
        across, along = polynomials[0, ..., : len(across)] @ across, polynomials[1, ..., : len(along)] @ along
        return cls(height, length, across, along)

    def some(self, which: int | Indices) -> _Places:
        """Those of one of several lines, or some of one line."""
        return _Places(self.height[which], self.length[which], self.across[which], self.along[which])

    def read(self, table: Array) -> Array:
        """Values (..., m) at the places of numbers (..., a, b) at the places of the table."""
        return np.asarray(((self.across @ table) * self.along).sum(axis=-1))

    def gathered(self, forces: Array) -> Array:
        """Forces (a, b) on the places of the table that stand for forces (m,) on the places of one line."""
        return np.asarray(self.across.T @ (forces[:, None] * self.along))

    @cached_property
    def shares(self) -> Array:
        """Shares (m, a b) of the places of the table in every place."""
        return shares_of_grid(self.across, self.along)


@dataclass(frozen=True, eq=False)
class _MovedPlaces:
    """Places (m,) of a line that moves, and the growth of their Lagrange polynomials.

    Attributes
    ----------
    places : _Places
    across, along : (m, a), (m, b) array
        Growth of the polynomials by the parts of height and face width.
    higher, further : (keys, m) array [1 per unit]
        Growth of these parts.
    """

    places: _Places
    across: Array
    along: Array
    higher: Array
    further: Array

    @classmethod
    def of(cls, gear: GearCompliance, places: _Places, higher: Array, further: Array) -> _MovedPlaces:
        """Those of a gear's table."""
        across, along = (
            chebvander(2.0 * part - 1.0, len(own) - 2) @ (2.0 * chebder(own))
            for part, own in zip((places.height, places.length), gear.interpolation, strict=True)
        )
        return cls(places, across, along, higher, further)

    def read(self, table: Array) -> Array:
        """Growth (keys, m) of what :meth:`_Places.read` has of numbers (a, b)."""
        by_height = ((self.across @ table) * self.places.along).sum(axis=1)
        return np.asarray(
            by_height * self.higher + ((self.places.across @ table) * self.along).sum(axis=1) * self.further
        )

    def gathered(self, forces: Array) -> Array:
        """Growth (keys, a, b) of what :meth:`_Places.gathered` has of forces (m,)."""
        by_height = self.across.T @ ((forces * self.higher)[..., None] * self.places.along)
        return np.asarray(by_height + self.places.across.T @ ((forces * self.further)[..., None] * self.along))


def gear_compliance(gear: Gear, density: MeshDensity = MeshDensity()) -> GearCompliance:
    """Compliance of a gear body under unit forces all over one flank, computed or from the kept models.

    Gears whose flanks differ in their modifications alone share one model: the last few are kept in memory.

    Parameters
    ----------
    gear : Gear
    density : MeshDensity

    Raises
    ------
    InputError
        If the bore reaches the teeth.
    GeometryError
        If the tooth is pointed or cut off, or the mesh is turned inside out.
    """
    return _model(gear.geometry.unmodified, gear.flank.side, gear.material, gear.bore_diameter, density)


@lru_cache(maxsize=MOST_IN_MEMORY)
def _model(
    teeth: ToothGeometry, side: int, material: Material, bore_diameter: float | None, density: MeshDensity
) -> GearCompliance:
    """Compliance of a gear without modifications, by all that it is made of: whose are equal share one model."""
    gear = Gear.of(teeth, side, material, bore_diameter)
    frame = ToothFrame(gear, gear_nodes(gear, density))
    return GearCompliance(frame, kept_flexibility(frame))


def forget() -> None:
    """Forget the models that are kept in memory; files stay."""
    _model.cache_clear()
    forget_kept()


_KEPT: WeakKeyDictionary[FlankLine, tuple[ref[GearCompliance], _Places]] = WeakKeyDictionary()
"""Places of lines that are asked for again and again, under every force of the other tooth pairs."""
