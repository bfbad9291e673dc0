"""Logical layout of a gear body: columns around the gear, rows from the bore to the tips, elements between them.

Nodes have whole coordinates (column, row), two to an element, so that even ones are corners. One tooth is resolved, its
neighbours coarsely, and the rest of the ring is a rim without teeth, one element to a pitch.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from loaded_tca.arrays import Array, Indices, count_problems
from loaded_tca.errors import InputError
from loaded_tca.plain import plain

LARGEST_GRADING, LARGEST_SKIN = 10.0, 0.1


@dataclass(frozen=True)
class MeshDensity:
    """Elements of a gear body.

    Parameters
    ----------
    through : int
        Through the thickness of the tooth, even: its middle line is a line of nodes.
    flank, fillet : int
        Up the flank and along the part of the fillet that belongs to the tooth.
    land : int
        From there to the middle of the space.
    rim : int
        From the root to the bore; the lowest is cut into more where the bore is small.
    lengthwise : int
        Across the face.
    neighbours : int
        Neighbouring teeth on either side that are modelled; of further ones the rim alone.
    grading : float
        Thickness of each layer through the tooth over that of the next one towards the flank.
    skin : float
        Thickness of the uppermost layer of the rim over the pitch along the root circle; 0: each layer of the rim is
        1.8 times as thick as the one above. Above 0 an edge of elements also follows the end of the fillet.
    thin_ends : bool
        Whether the two outermost layers at each end of the face are half as thick as the others; ``lengthwise`` is
        even then, and 6 at least.

    Raises
    ------
    InputError
        If a number is not a whole one, not positive, or ``through`` is odd; if ``grading`` is not between 1 and 10,
        ``skin`` not between 0 and 0.1, or ``lengthwise`` does not suit ``thin_ends``.
    """

    through: int = 4
    flank: int = 6
    fillet: int = 2
    land: int = 3
    rim: int = 4
    lengthwise: int = 10
    neighbours: int = 1
    grading: float = 1.0
    skin: float = 0.0
    thin_ends: bool = False

    def __post_init__(self) -> None:
        other = "neighbours", "grading", "skin", "thin_ends"
        elements = {name: count for name, count in vars(self).items() if name not in other}
        problems = count_problems(elements, 1) + count_problems({"neighbours": self.neighbours}, 0)
        if not 1.0 <= self.grading <= LARGEST_GRADING:
            problems.append(f"grading: {self.grading} is not between 1 and {plain(LARGEST_GRADING, 6)}")
        if not problems and self.thin_ends and (self.lengthwise % 2 or self.lengthwise < 6):
            problems.append(f"lengthwise: {self.lengthwise} is not an even number from 6 on, which thin_ends asks for")
        if not 0.0 <= self.skin <= LARGEST_SKIN:
            problems.append(f"skin: {self.skin} is not between 0 and {plain(LARGEST_SKIN, 6)}")
        if not problems and self.through % 2:
            problems.append(f"through: {self.through} is not even: the middle of the tooth must be a line of nodes")
        if problems:
            raise InputError(problems)

    @property
    def planes(self) -> Indices:
        """Where nodes stand across the face (2 lengthwise + 1,), in quarters of a layer that is not thin."""
        thin = 2 * self.thin_ends
        thickness = np.full(self.lengthwise, 4)
        thickness[:thin] = thickness[self.lengthwise - thin :] = 2
        return np.append(0, np.cumsum(np.repeat(thickness // 2, 2)))

    def coarse(self) -> MeshDensity:
        """Density of the neighbouring teeth, which move almost as rigid bodies."""
        return MeshDensity(2, min(3, self.flank), 1, 1, self.rim, self.lengthwise, 0)


@dataclass(frozen=True)
class SectorLayout:
    """Columns of one pitch: a tooth of some density, or the rim alone (None)."""

    number: int
    first: int
    density: MeshDensity | None

    @property
    def columns(self) -> int:
        """Elements around the gear."""
        return 1 if self.density is None else self.density.through + 2 * self.density.land


@dataclass(frozen=True)
class RingLayout:
    """A whole ring of teeth, or a piece of it.

    Parameters
    ----------
    teeth : int
    density : MeshDensity
    core : int
        Layers of a solid gear below those of the rim; 0: a bore.
    cuts : int
        Layers that the lowest layer of the rim is cut into.
    growth : float
        Thickness of each layer of the rim over that of the one above, before the lowest is cut.
    beyond : int, optional
        Pitches of the rim on either side of the modelled teeth, after which the body ends; None: it closes to a ring.
    """

    teeth: int
    density: MeshDensity
    core: int = 0
    cuts: int = 1
    growth: float = 1.8
    beyond: int | None = None

    @property
    def neighbours(self) -> int:
        """Teeth on either side of the resolved one: not so many that they meet behind the gear."""
        return min(self.density.neighbours, (self.teeth - 1) // 2)

    @cached_property
    def sectors(self) -> tuple[SectorLayout, ...]:
        """Pitches in the sense of +theta, the resolved tooth first."""
        near, last = self.neighbours, self._last
        numbers = range(self.teeth) if last is None else [*range(last + 2), *range(-last, 0)]
        layouts: list[SectorLayout] = []
        for number in numbers:
            away = min(abs(number), self.teeth - number)
            density = self.density if number == 0 else self.density.coarse() if away <= near else None
            first = layouts[-1].first + 2 * layouts[-1].columns if layouts else 0
            layouts.append(SectorLayout(number if number <= self.teeth // 2 else number - self.teeth, first, density))
        return tuple(layouts)

    @property
    def _last(self) -> int | None:
        """Number of the last pitch of a body that ends; the next one is the cut, without elements."""
        return None if self.beyond is None else self.neighbours + self.beyond

    def sector(self, number: int) -> SectorLayout:
        """Sector of the tooth ``number``, counted in the sense of +theta; InputError if it has no tooth."""
        for sector in self.sectors:
            if sector.density is not None and (sector.number - number) % self.teeth == 0:
                return sector
        raise InputError(f"tooth: {number} is not one of the {2 * self.neighbours + 1} teeth of the model")

    @property
    def shape(self) -> tuple[int, int]:
        """Nodes around the gear, and from the lowest row to the tip of the resolved tooth."""
        last = self.sectors[-1]
        tooth = self.density.flank + self.density.fillet
        return last.first + 2 * last.columns, self.base_row + 2 * tooth + 1

    @cached_property
    def turns(self) -> Array:
        """Angle (columns,) [rad] by which the pitch that a column belongs to is turned from the resolved tooth."""
        numbers = np.concatenate([np.full(2 * sector.columns, sector.number) for sector in self.sectors])
        return 2.0 * math.pi / self.teeth * numbers

    @cached_property
    def blocks(self) -> Indices:
        """Which element (n,) of a section belongs to which tooth, counted around the gear; the bare rim is one."""
        bare = np.array([sector.density is None for sector in self.sectors])
        number = np.cumsum(np.append(True, ~(bare[1:] & bare[:-1]))) - 1
        return np.repeat(number, [len(self._elements_of(sector)) for sector in self.sectors])

    @cached_property
    def bricks(self) -> tuple[Indices, Indices, Indices]:
        """Elements of the body: lowest nodes (n, 3), layers (n,) that each spans, and blocks (n,).

        Beside the resolved tooth two layers are one, but for an odd last one: displacements are smooth there.
        """
        section, layers = self.elements, np.arange(self.density.lengthwise)
        lowest = np.column_stack([np.tile(section, (len(layers), 1)), np.repeat(2 * layers, len(section))])
        blocks = np.tile(self.blocks, len(layers))
        first, thick = lowest[:, 2] % 4 == 0, (blocks > 0) & (lowest[:, 2] < 4 * (len(layers) // 2))
        stay = first | ~thick
        return lowest[stay], np.where(thick, 2, 1)[stay], blocks[stay]

    @property
    def base_row(self) -> int:
        """Row between rim and teeth."""
        return 2 * (self.core + self.density.rim - 1 + self.cuts)

    def held(self, number: Indices) -> Indices:
        """Nodes that are held, of those numbered (columns, rows, ...): the bore, or both faces of the core."""
        return (number[:, : 2 * self.core + 1, [0, -1]] if self.core else number[:, 0]).ravel()

    @cached_property
    def elements(self) -> Indices:
        """Lowest column and row (n, 2) of each element of a section."""
        return np.concatenate([self._elements_of(sector) for sector in self.sectors])

    def foot(self, side: int) -> tuple[Indices, Indices]:
        """Elements of a section along one foot of the resolved tooth, from its flank to the middle of the space.

        Parameters
        ----------
        side : int
            +1 or -1.

        Returns
        -------
        lowest : (n, 2) int array
            Lowest column and row of each element.
        ends : (n, 2, 2) int array
            Both ends of its edge on the surface on the way down: 0 or 1 from the lowest node, in columns and rows.
        """
        density, first = self.density, self.sector(0).first
        down = np.arange(density.fillet)[::-1]
        out = np.arange(density.land)
        right = int(side > 0)
        beside = density.land + (density.through - 1) * right  # the outermost column of the tooth
        beyond = density.land + density.through + out if right else density.land - 1 - out
        tooth = np.column_stack([np.full_like(down, first + 2 * beside), self.base_row + 2 * down])
        land = np.column_stack([first + 2 * beyond, np.full_like(out, self.base_row - 2)])
        on_tooth = np.array([[right, 1], [right, 0]])
        on_land = np.array([[1 - right, 1], [right, 1]])
        ends = np.concatenate([np.tile(on_tooth, (len(down), 1, 1)), np.tile(on_land, (len(out), 1, 1))])
        return np.concatenate([tooth, land]), ends

    def _elements_of(self, sector: SectorLayout) -> Indices:
        is_cut = self._last is not None and sector.number > self._last
        rim = _block(sector.first, 0 if is_cut else sector.columns, 0, self.base_row // 2)
        density = sector.density
        if density is None:
            return rim
        rows = density.flank + density.fillet
        return np.concatenate([rim, _block(sector.first + 2 * density.land, density.through, self.base_row, rows)])


def _block(column: int, columns: int, row: int, rows: int) -> Indices:
    """Lowest nodes (n, 2) of a block of elements."""
    grid = np.meshgrid(column + 2 * np.arange(columns), row + 2 * np.arange(rows), indexing="ij")
    return np.stack(grid, axis=-1).reshape(-1, 2)
