"""One side of a tooth in the images of its sections: half thickness angle against radius."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import GeometryError
from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.rounding import RoundedFlank
from loaded_tca.tooth.sections import Sections

SAME_SECTION = 1e-9
"""Largest difference, relative to its size, of the coordinates of the points of one section."""


@dataclass(frozen=True, eq=False)
class Profile:
    """The flank of one side, cut by m sections; azimuths are counted from the middle of the tooth to its side.

    Attributes
    ----------
    flank : Flank
    sections : Sections
    half_thickness_angle : float [rad]
        From the middle of the tooth to the flank's own theta = 0.
    coordinate : (m,) array [mm]
        Which sections.
    radius : (n, m) array [mm]
        Radii of the images of the flank's grid, from root to tip.
    """

    flank: Flank
    sections: Sections
    half_thickness_angle: float
    coordinate: Array
    radius: Array

    def angle(self, radius: Array) -> tuple[Array, Array]:
        """Half thickness angle psi [rad] and d psi/dr [rad/mm] at radii (..., m)."""
        rho, z = self.sections.point(radius, self.coordinate)
        along_rho, along_z = self.sections.direction(radius, self.coordinate)
        jet = self.flank.theta(rho, z)
        side = float(self.flank.side)
        angle = self.half_thickness_angle + side * jet.value
        return angle + 0.0 * radius, side * (jet.rho * along_rho + jet.z * along_z)

    def point_and_tangent(self, radius: Array) -> tuple[Array, Array]:
        """Points (..., m, 2) of the image [mm], and unit tangents towards the root."""
        angle, slope = self.angle(radius)
        tangent = -np.stack([np.ones_like(slope), radius * slope], axis=-1)
        tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
        return polar(radius, angle), turned(tangent, angle)


def profile_of(flank: Flank, sections: Sections, half_thickness_angle: float, counts: tuple[int, int]) -> Profile:
    """Cut a flank into sections: the columns of its own grid.

    Parameters
    ----------
    flank : Flank
    sections : Sections
    half_thickness_angle : float [rad]
    counts : (int, int)
        Points along the profile, and sections.

    Raises
    ------
    GeometryError
        If a column of the flank's grid does not lie on one section.
    """
    rho, z = flank.drawn_grid(*counts) if isinstance(flank, RoundedFlank) else flank.grid(*counts)
    coordinate = sections.coordinate(rho, z)
    if np.ptp(coordinate, axis=0).max() > SAME_SECTION * float(np.hypot(rho, z).max()):
        raise GeometryError("the columns of the flank's grid do not lie on the sections of the tooth")
    return Profile(flank, sections, half_thickness_angle, coordinate[-1], sections.radius(rho, z))


def polar(radius: Array, angle: Array) -> Array:
    """Points (..., 2) from polar coordinates."""
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)


def lengths_along(points: Array) -> Array:
    """Lengths (n, m) along m polygons through points (n, m, 2), from their first points."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=-1)
    return np.concatenate([np.zeros_like(steps[:1]), np.cumsum(steps, axis=0)])


def turned(vector: Array, angle: Array) -> Array:
    """Vectors (..., 2) turned by angles (...) [rad]."""
    cosine, sine = np.cos(angle), np.sin(angle)
    x, y = vector[..., 0], vector[..., 1]
    return np.stack([cosine * x - sine * y, sine * x + cosine * y], axis=-1)
