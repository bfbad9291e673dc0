"""The image of a pressure in an edge at an angle to the axes of the grid.

Rows of cells across the edge are moved until it is straight, by parts of cells too, mirrored there, and moved back: in
row m the image of cell i of row n, in an edge at e(n), lies at e(n) + e(m) - i. That keeps the influence matrix
symmetric and positive definite, as a straight image does. Lengths along the edge are taken too short, by the cosine of
its angle.
"""

from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.contact.convolution import Convolution, Window

# Cells from the edge beyond which a pressure has no image: on long and very thin contacts there would be millions.
DEEPEST = 2048


@dataclass(frozen=True)
class ObliqueMirror:
    """A free edge in cells: at ``first + slope (j + 1/2)`` along its axis in row j; ``below``: material before it."""

    axis: int
    first: float
    slope: float
    below: bool
    factor: float


class ObliqueImage:
    """Displacement of ``target`` cells under the image of the pressure on them.

    Parameters
    ----------
    target, aspect, dtype, threads
        As for :class:`Convolution`.
    mirror : ObliqueMirror
        Counted from the first cell of the target.
    """

    def __init__(
        self, target: tuple[int, int], aspect: float, mirror: ObliqueMirror, dtype: str = "float64", threads: int = 2
    ) -> None:
        self._axis, cells = mirror.axis, target[mirror.axis]
        places = mirror.first + mirror.slope * (np.arange(target[1 - mirror.axis]) + 0.5)
        # The border of cells at the edge or next beyond it, and how far the edge lies from the one before.
        first = np.floor(places).astype(int) if mirror.below else np.ceil(places).astype(int)
        share = np.abs(places - first)
        deepest = 1 + (int(first.max()) if mirror.below else cells - int(first.min()))
        self._deep = min(max(0, deepest), DEEPEST)
        depth = np.arange(self._deep)[:, None]
        near = first - depth if mirror.below else first - 1 + depth
        inner = near - 1 if mirror.below else near + 1
        # A cell cut by the edge holds material if its middle does, and stays whole.
        part = np.where(depth > 0, share, share >= 0.5)
        self._moves = [self._move(near, part, cells), self._move(inner, 1.0 - share + 0.0 * depth, cells)]
        self._padded = np.zeros(tuple(n + (axis == self._axis) for axis, n in enumerate(target)), dtype=dtype)
        self._inside: Window = (slice(target[0]), slice(target[1]))
        self._factor = mirror.factor
        if self._deep:
            extended, loaded = list(target), [slice(0, n) for n in target]
            extended[self._axis], loaded[self._axis] = 2 * self._deep, slice(0, self._deep)
            self._image = np.empty(extended, dtype=dtype)
            window = (loaded[0], loaded[1])
            self._convolve = Convolution((extended[0], extended[1]), aspect, window, dtype, threads)

    def add(self, pressure: Array, out: Array) -> None:
        """Add the displacement by the image of a pressure on the whole target to ``out``."""
        if not self._deep:
            return
        self._padded[self._inside] = pressure
        moved = (part * np.take_along_axis(self._padded, index, self._axis) for index, part in self._moves)
        straight = np.flip(sum(moved), self._axis)
        self._convolve(np.ascontiguousarray(straight, dtype=self._padded.dtype), self._image)
        mirrored = self._factor * np.take(self._image, np.arange(self._deep, 2 * self._deep), self._axis)
        for index, part in self._moves:
            self._padded[:] = 0.0
            np.put_along_axis(self._padded, index, part * mirrored, self._axis)
            out += self._padded[self._inside]
        self._padded[:] = 0.0

    def _move(self, index: Array, part: Array, cells: int) -> tuple[Array, Array]:
        """Cells (depth, row) that are read and written, and how much of each, in the order of the axes of the grid.

        What lies beyond the grid is read from, and written to, a row that no one looks at.
        """
        there = (index >= 0) & (index < cells)
        index, part = np.where(there, index, cells), there * part
        return (index, part) if self._axis == 0 else (np.ascontiguousarray(index.T), np.ascontiguousarray(part.T))
