r"""Sections across a tooth, each mapped to a plane without changing angles, and one side of a tooth in these images.

A section is a surface of revolution about the gear's axis: a transverse plane of a cylindrical gear, a sphere about
the apex of a bevel gear. Its image keeps the azimuth and has the radius r. In the plane r = rho; the sphere of
radius R is projected stereographically,

.. math:: r = 2 R \tan(u/2), \qquad u = \operatorname{atan2}(\rho, z),

which maps circles to circles: an arc that touches a flank and a root circle is the same planar construction in both.

One side of a tooth is its profile, the half thickness angle against the radius, and the fillet between flank and root
surface. An arc touches the flank and the root circle; where it would touch the flank below its root edge, the tangent
there leads on to it, straight. The fillet of the basic rack is the curve that its rounded tip cuts.

References
----------
Snyder 1987, Map Projections, USGS Professional Paper 1395, chapter 21 (polar stereographic projection of the sphere).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, Indices
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.rounding import RoundedFlank
from loaded_tca.plain import plain
from loaded_tca.roots import find_roots


@checked
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


@checked
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


@checked
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


ROUNDING = 1e-15
"""Over the largest radius: how closely an arc touches."""
EDGE_MARGIN = 0.01
"""Part of the profile above its root edge where a straight continuation starts at the latest: at the base circle
itself a modification of the profile, which counts by roll length, has no finite slope."""
BLEND = 0.2
"""Part of the length of a rack's fillet over which the slope of a modification fades out."""


@dataclass(frozen=True, eq=False)
class FilletCurve:
    """Fillets of m sections in their images, from the flank to the root circle.

    Attributes
    ----------
    start : (m,) array [mm]
        Radius of the image where the flank ends.
    points : (k, m, 2) array [mm]
        Azimuth 0 is the middle of the tooth; the first points lie on the flank, the last on the root circle.
    tangents : (k, m, 2) array
        Unit tangents, towards the root.
    """

    start: Array
    points: Array
    tangents: Array


class Fillet(ABC):
    """Transition from a flank to the root."""

    @abstractmethod
    def curve(self, profile: Profile, root_radius: Array, count: int) -> FilletCurve:
        """Fillets of all sections of a profile.

        Parameters
        ----------
        profile : Profile
        root_radius : (m,) array [mm]
            Radius of the image of the root circle of each section.
        count : int
            Points k along each fillet.

        Raises
        ------
        GeometryError
            If there is no such fillet.
        """


@checked
@dataclass(frozen=True)
class ArcFillet(Fillet):
    """Circular arc on the section, tangent to the flank and to the root circle.

    Parameters
    ----------
    radius : float [mm]
        At the section of ``coordinate``.
    coordinate : float [mm], optional
        The radius grows in proportion to the coordinate of the section, as everything on a bevel gear does; None: it
        is the same everywhere.

    Raises
    ------
    InputError
        If a length is not positive and finite.

    References
    ----------
    The miter-gear paper (docs/reference/sources.md), "Fillet surface model": an arc on the sphere, tangent to the root
    circle and the spherical involute.
    """

    radius: float
    coordinate: float | None = None

    def __post_init__(self) -> None:
        lengths = {"fillet_radius": self.radius, "coordinate": 1.0 if self.coordinate is None else self.coordinate}
        problems = [
            f"{name}: {value} mm is not positive and finite"
            for name, value in lengths.items()
            if not 0.0 < value < float("inf")
        ]
        if problems:
            raise InputError(problems)

    def curve(self, profile: Profile, root_radius: Array, count: int) -> FilletCurve:
        """Line and arc, evenly divided."""
        scale = np.ones_like(root_radius) if self.coordinate is None else profile.coordinate / self.coordinate
        outer = profile.sections.radius_beyond(root_radius, profile.coordinate, 2.0 * self.radius * scale)
        size = 0.5 * (outer - root_radius)  # the arc touches the root circle: its meridian runs from there
        start = _touching_radius(profile, root_radius, size)
        point, tangent = profile.point_and_tangent(start)
        centre = point + size[:, None] * _into_space(tangent)
        along = -(centre * tangent).sum(axis=-1)
        square = along**2 - (centre**2).sum(axis=-1) + (root_radius + size) ** 2
        if square.min() < 0.0:
            raise GeometryError(
                f"fillet_radius: an arc of {plain(self.radius, 6)} mm cannot touch both the end of the flank "
                "and the root"
            )
        line = np.maximum(along - np.sqrt(square), 0.0)
        centre += line[:, None] * tangent
        inward = -centre / np.linalg.norm(centre, axis=-1, keepdims=True)
        first = -_into_space(tangent)
        sweep = np.arctan2(first[:, 0] * inward[:, 1] - first[:, 1] * inward[:, 0], (first * inward).sum(axis=-1))
        length = np.linspace(0.0, 1.0, count)[:, None] * (line + size * np.abs(sweep))
        swept = np.sign(sweep) * np.maximum(length - line, 0.0) / size
        on_arc = centre + size[:, None] * turned(first, swept)
        points = np.where((length < line)[..., None], point + length[..., None] * tangent, on_arc)
        points[0] = point
        return FilletCurve(start, points, turned(tangent, swept))


def _touching_radius(profile: Profile, root: Array, size: Array) -> Array:
    """Radii (m,) of the image at which arcs of the radii ``size`` touch flank and root circle, on the flank."""

    def height_over_root(radius: Array, rows: Indices) -> Array:
        point, tangent = replace(profile, coordinate=profile.coordinate[rows]).point_and_tangent(radius)
        touching = point + size[rows, None] * _into_space(tangent)
        return np.asarray(np.linalg.norm(touching, axis=-1) - root[rows] - size[rows])

    low, high = profile.radius[0], profile.radius[-1]
    ends = np.stack([low + EDGE_MARGIN * (high - low), high])
    every = np.arange(len(low))
    values = np.stack([height_over_root(end, every) for end in ends])
    if (values < 0.0).all(axis=0).any():
        raise GeometryError("fillet_radius: the fillet reaches the tip of the tooth; reduce it")
    touching = find_roots(height_over_root, ends, values, ROUNDING * float(high.max()))
    return np.where(values[0] * values[1] < 0.0, touching, ends[0])  # no change of sign: above the root all along


def _into_space(tangent: Array) -> Array:
    """Unit normals out of the material beside tangents towards the root."""
    return np.stack([tangent[..., 1], -tangent[..., 0]], axis=-1)


class CutRoot(Protocol):
    """A gear whose fillets are the curves that its cutter leaves, as :class:`CylindricalGear` has them."""

    @property
    def meets_in_corner(self) -> bool:
        """Whether flank and fillet meet in a corner."""

    def root_fillet(self, points: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Radii [mm] and half thickness angles [rad] (points,), from the flank to the root circle."""

    def root_fillet_tangent(self, points: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Radial and circumferential parts (points,) of the unit tangents, towards the root circle."""


@checked
@dataclass(frozen=True)
class RackFillet(Fillet):
    """Trochoid that the rounded tip of the basic rack cuts into a cylindrical gear.

    On a modified flank it turns with the flank's root edge, and takes over the flank's slope there over the first
    fifth of its length; an undercut leaves a corner.

    Parameters
    ----------
    gear : CylindricalGear

    References
    ----------
    ISO 53:1998 (basic rack); :meth:`CylindricalGear.root_fillet`.
    """

    gear: CutRoot

    def curve(self, profile: Profile, root_radius: Array, count: int) -> FilletCurve:  # noqa: ARG002 (of the gear)
        """The trochoid of the gear, turned to each section."""
        start = profile.radius[0]
        radius, angle = self.gear.root_fillet(count)
        top, slope = profile.point_and_tangent(start)
        turn = angle[:, None] + (np.arctan2(top[:, 1], top[:, 0]) - angle[0])
        tangents = turned(np.stack(self.gear.root_fillet_tangent(count), axis=-1)[:, None], turn)
        points = polar(radius[:, None], turn)
        if not self.gear.meets_in_corner:
            points, tangents = _with_slope(points, tangents, slope)
        points[0] = top
        return FilletCurve(start, points, tangents)


def _with_slope(points: Array, tangents: Array, slope: Array) -> tuple[Array, Array]:
    """Curves that start with the tangents ``slope`` (m, 2), and are the old ones from a fifth of their length on."""
    length = lengths_along(points)[..., None]
    blend = BLEND * length[-1]
    rest = np.maximum(1.0 - length / blend, 0.0)
    change = slope - tangents[0]
    bent = tangents + change * rest * (3.0 * rest - 2.0)
    return points + change * length * rest**2, bent / np.linalg.norm(bent, axis=-1, keepdims=True)
