r"""Sections across a tooth, each mapped to a plane without changing angles.

A section is a surface of revolution about the gear's axis: a transverse plane of a cylindrical gear, a sphere about
the apex of a bevel gear. Its image keeps the azimuth and has the radius r. In the plane r = rho; the sphere of
radius R is projected stereographically,

.. math:: r = 2 R \tan(u/2), \qquad u = \operatorname{atan2}(\rho, z),

which maps circles to circles: an arc that touches a flank and a root circle is the same planar construction in both.

References
----------
Snyder 1987, Map Projections, USGS Professional Paper 1395, chapter 21 (polar stereographic projection of the sphere).
"""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np

from loaded_tca.arrays import Array


class Sections(ABC):
    """A family of sections, told apart by a lengthwise ``coordinate``; all arrays broadcast against each other.

    Attributes
    ----------
    outwards : int
        +1 where teeth point away from the axis, -1 where they point towards it. In the images they point outwards.
    """

    outwards: int = 1

    @abstractmethod
    def coordinate(self, rho: Array, z: Array) -> Array:
        """Which section a point lies on [mm]."""

    @abstractmethod
    def radius(self, rho: Array, z: Array) -> Array:
        """Radius r of the image of a point [mm]."""

    @abstractmethod
    def point(self, radius: Array, coordinate: Array) -> tuple[Array, Array]:
        """(rho, z) of the circle whose image has a radius, on a section [mm]."""

    @abstractmethod
    def direction(self, radius: Array, coordinate: Array) -> tuple[Array, Array]:
        """d rho/dr and dz/dr along the meridian of a section."""

    @abstractmethod
    def radius_beyond(self, radius: Array, coordinate: Array, distance: Array) -> Array:
        """Radius of the image after a distance along the meridian, away from the root [mm]."""

    def in_true_size(self, radius: Array, coordinate: Array) -> Array:  # noqa: ARG002 (images have the true size)
        """Radius in a plane in which one section has its true size [mm], nearly so where it is no plane."""
        return radius


def in_space(sections: Sections, radius: Array, angle: Array, coordinate: Array) -> Array:
    """Points (..., 3) in the gear's frame [mm], from polar coordinates in the images of sections."""
    rho, z = sections.point(radius, coordinate)
    return np.stack([rho * np.cos(angle), rho * np.sin(angle), z], axis=-1)


class TransversePlanes(Sections):
    """Planes z = const, told apart by z.

    Examples
    --------
    >>> float(TransversePlanes().radius(np.array(50.0), np.array(3.0)))
    50.0
    """

    def coordinate(self, rho: Array, z: Array) -> Array:
        """Return z."""
        return z + 0.0 * rho

    def radius(self, rho: Array, z: Array) -> Array:
        """Return rho: a plane is its own image."""
        return rho + 0.0 * z

    def point(self, radius: Array, coordinate: Array) -> tuple[Array, Array]:
        """Return (r, z)."""
        rho, z = np.broadcast_arrays(radius, coordinate)
        return rho, z

    def direction(self, radius: Array, coordinate: Array) -> tuple[Array, Array]:
        """Return (1, 0)."""
        nought = 0.0 * (radius + coordinate)
        return nought + 1.0, nought

    def radius_beyond(self, radius: Array, coordinate: Array, distance: Array) -> Array:
        """Return r + distance."""
        return radius + distance + 0.0 * coordinate


class ApexSpheres(Sections):
    """Spheres about the apex, told apart by the cone distance R.

    Examples
    --------
    >>> spheres = ApexSpheres()
    >>> rho, z = spheres.point(spheres.radius(np.array(30.0), np.array(40.0)), np.array(50.0))
    >>> round(float(rho), 12), round(float(z), 12)
    (30.0, 40.0)
    """

    def coordinate(self, rho: Array, z: Array) -> Array:
        """R = hypot(rho, z)."""
        return np.hypot(rho, z)

    def radius(self, rho: Array, z: Array) -> Array:
        """2 R tan(u/2), with tan(u/2) = sin u/(1 + cos u)."""
        distance = np.hypot(rho, z)
        return 2.0 * distance * rho / (distance + z)

    def point(self, radius: Array, coordinate: Array) -> tuple[Array, Array]:
        """R sin u and R cos u, from tan(u/2)."""
        half = 0.5 * radius / coordinate
        scale = coordinate / (1.0 + half**2)
        return 2.0 * half * scale, (1.0 - half**2) * scale

    def direction(self, radius: Array, coordinate: Array) -> tuple[Array, Array]:
        """R cos u du/dr and -R sin u du/dr, R du/dr = 1/(1 + tan^2(u/2))."""
        half = 0.5 * radius / coordinate
        scale = 1.0 / (1.0 + half**2) ** 2
        return (1.0 - half**2) * scale, -2.0 * half * scale

    def radius_beyond(self, radius: Array, coordinate: Array, distance: Array) -> Array:
        """2 R tan((u + distance/R)/2)."""
        angle = np.arctan(0.5 * radius / coordinate) + 0.5 * distance / coordinate
        return 2.0 * coordinate * np.tan(angle)
