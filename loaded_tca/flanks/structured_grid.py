"""Points in rows and columns over a flank: what makes a grid of them fit for a B-spline, and what is refused."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import give_accuracy_warning
from loaded_tca.flanks.base import Flank

FEWEST_POINTS = {3: 4, 5: 6}
"""Degree of a B-spline -> points, or coefficients, that it needs in its direction."""
OFF_FLANK = 0.05
"""Part of the flank's height by which points may lie beyond its edges."""
UNCOVERED = 0.15
"""Part of the flank's height or width beyond the outermost points, at one end, from which on a warning is due."""
LEAST_COVERED = 0.5
"""Part of the flank's height and width that the points have to cover."""
DIRECTIONS = ("profile", "lengthwise")


@dataclass(frozen=True, eq=False)
class StructuredGrid:
    """Coordinates of points on a flank, both growing along their axis.

    Attributes
    ----------
    radius, axial : (n, m) array [mm]
        Cylindrical coordinates, as given.
    profile, lengthwise : (n, m) array
        Coordinates of the flank, in the order in which they grow.
    reversed_axes : tuple of int
        Axes along which the points were given the other way round.
    """

    radius: Array
    axial: Array
    profile: Array
    lengthwise: Array
    reversed_axes: tuple[int, ...]

    @classmethod
    def of(cls, flank: Flank, radius: Array, axial: Array) -> StructuredGrid:
        """Grid of the points (radius, axial) [mm], (n, m) each."""
        coordinates = flank_coordinates(flank, radius, axial)
        back = tuple(axis for axis, at in enumerate(coordinates) if _ends(at, axis)[1] < _ends(at, axis)[0])
        profile, lengthwise = (np.flip(at, back) for at in coordinates)
        return cls(radius, axial, profile, lengthwise, back)

    def ordered(self, values: Array) -> Array:
        """Values (n, m) at the points, in the order of ``profile`` and ``lengthwise``."""
        return np.flip(np.broadcast_to(values, self.radius.shape), self.reversed_axes)

    def degrees(self, wanted: int | None) -> tuple[int, int]:
        """Degrees along the profile and lengthwise; default: the highest that the points allow."""
        first, second = (5 if count >= FEWEST_POINTS[5] else 3 for count in self.radius.shape)
        return (first, second) if wanted is None else (wanted, wanted)

    def problems(self, flank: Flank, degrees: tuple[int, int], counts: tuple[int, int]) -> list[str]:
        """Everything that keeps the points from being fitted, a sentence each."""
        return self._too_coarse(degrees, counts) or [
            *self._off_the_flank(flank),
            *(self._disorder() or self._folds() or self._too_small(flank)),
        ]

    def warn_if_uncovered(self, flank: Flank) -> None:
        """Warn where the fit is continued far beyond the points."""
        for name, ends in zip(DIRECTIONS, self._uncovered(flank), strict=True):
            if max(ends) > UNCOVERED:
                names = flank.frame.edges[1::-1] if name == DIRECTIONS[0] else flank.frame.edges[2:]
                left = " and ".join(
                    f"{100.0 * max(end, 0.0):.0f} % at the {edge}" for end, edge in zip(ends, names, strict=True)
                )
                message = (
                    f"{name}: the points leave {left} of the flank uncovered; there the deviation is a continuation"
                )
                give_accuracy_warning(message, stacklevel=3)

    def _too_coarse(self, degrees: tuple[int, int], counts: tuple[int, int]) -> list[str]:
        problems = []
        for name, degree, count, points in zip(DIRECTIONS, degrees, counts, self.radius.shape, strict=True):
            least = FEWEST_POINTS.get(degree)
            if least is None:
                problems.append(f"degree: {degree!r}; allowed {' or '.join(map(str, FEWEST_POINTS))}")
            elif points < least:
                problems.append(f"{name}: {points} points are too coarse; a B-spline of degree {degree} needs {least}")
            elif not least <= count <= points:
                allowed = f"{least} (degree {degree}) to {points}, the number of points"
                problems.append(f"coefficients: {count} ({name}); allowed {allowed}")
        return problems

    def _off_the_flank(self, flank: Flank) -> list[str]:
        """Points beyond the edges: of another gear, in another frame or in other units."""
        problems = []
        for name, edge in zip(flank.frame.edges, flank.edges(self.radius, self.axial), strict=True):
            beyond = -np.broadcast_to(edge.value, self.radius.shape)
            count = int((beyond > OFF_FLANK * min(flank.extent)).sum())
            if count:
                points = f"{count} of {beyond.size} points lie off the flank, up to {beyond.max():.4g} mm"
                problems.append(f"{points} beyond the {name}: wrong gear, frame or unit?")
        return problems

    def _disorder(self) -> list[str]:
        """Lines out of order."""
        problems = []
        for axis, (name, at) in enumerate(zip(DIRECTIONS, (self.profile, self.lengthwise), strict=True)):
            steps = np.diff(at.mean(axis=1 - axis))
            if not (steps > 0.0).all():
                line = int(np.argmax(steps <= 0.0)) + 1
                problems.append(
                    f"points are out of order: the {name} coordinate does not grow, or fall, all along axis {axis} "
                    f"(lines {line} and {line + 1}); axes are (profile, lengthwise)"
                )
        return problems

    def _folds(self) -> list[str]:
        """Cells that are turned over."""
        u, v = (at / np.ptp(at) for at in (self.profile, self.lengthwise))
        along, across = (np.diff(u, axis=0), np.diff(v, axis=0)), (np.diff(u, axis=1), np.diff(v, axis=1))
        # the four corners of each cell
        areas = [
            along[0][:, j] * across[1][i, :] - along[1][:, j] * across[0][i, :]
            for i in (slice(None, -1), slice(1, None))
            for j in (slice(None, -1), slice(1, None))
        ]
        folded = np.min(areas, axis=0) <= 0.0
        if not folded.any():
            return []
        row, column = (int(part) for part in np.argwhere(folded)[0])
        points = self.ordered(self.radius)[row, column], self.ordered(self.axial)[row, column]
        where = f"{int(folded.sum())} of {folded.size} cells, first at radius {points[0]:.4g}, axial {points[1]:.4g} mm"
        return [f"points are folded, or lie on each other: {where}"]

    def _too_small(self, flank: Flank) -> list[str]:
        return [
            f"{name}: the points cover {100.0 * (1.0 - sum(ends)):.0f} % of the flank; at least "
            f"{100.0 * LEAST_COVERED:.0f} % is needed"
            for name, ends in zip(DIRECTIONS, self._uncovered(flank), strict=True)
            if 1.0 - sum(ends) < LEAST_COVERED
        ]

    def _uncovered(self, flank: Flank) -> list[tuple[float, float]]:
        """Parts of the flank before the first and after the last line, along the profile and lengthwise."""
        whole = flank_coordinates(flank, *flank.grid(9, 9))
        parts = []
        for axis, (at, region) in enumerate(zip((self.profile, self.lengthwise), whole, strict=True)):
            first, last = _ends(at, axis)
            low, high = region.min(), region.max()
            parts.append((float((first - low) / (high - low)), float((high - last) / (high - low))))
        return parts


def flank_coordinates(flank: Flank, rho: Array, z: Array) -> tuple[Array, Array]:
    """Profile and lengthwise coordinate at points (rho, z), arrays of their shape."""
    shape = np.broadcast(rho, z).shape
    jets = flank.profile_coordinate(rho, z), flank.lengthwise_coordinate(rho, z)
    first, second = (np.broadcast_to(jet.value, shape) for jet in jets)
    return first, second


def _ends(at: Array, axis: int) -> tuple[float, float]:
    """Means of the first and of the last line."""
    lines = at if axis == 0 else at.T
    return float(lines[0].mean()), float(lines[-1].mean())
