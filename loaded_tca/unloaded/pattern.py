r"""Contact pattern by the searching method: where the flanks are nearer than the marking compound is thick.

Gears that stand at phi1 and phi2 are apart by an angle about one axis at every point of a flank: what the mate would
have to turn to touch it there. Times the lever of the mate's normal about its axis this is the gap, to first order,

.. math:: g = \Delta\varphi\,|n \cdot (w \times r)| = \Delta\varphi/|\nabla F|, \qquad F = \theta - \Theta(\rho, z),

since the normal is the direction of grad F, whose azimuthal part is 1/rho. No tangent plane, no curvature and no
fitted section is needed, and the borders of the flanks cut the pattern where it ends.

References
----------
Litvin & Fuentes 2004, Gear Geometry and Applied Theory, 9.3 (the ellipse of the curvatures).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks.jet import Array
from loaded_tca.pair import GearPair
from loaded_tca.unloaded.curvature import relative_curvature
from loaded_tca.unloaded.ease_off import EaseOff
from loaded_tca.unloaded.path import ContactPoint
from loaded_tca.unloaded.teeth import MeshPath, trace_teeth

Gear = Literal["pinion", "wheel"]

COMPOUND = 6.35e-3
"""Thickness of the usual marking compound [mm]."""
RAYS = 360
SCAN = 65
"""Points of a ray at which its first crossing of the contour is looked for."""
BISECTIONS = 40
LONGEST = 4.0
"""Length of a ray in semi-axes of the ellipse."""
POSITIONS = 61
"""Positions per pitch of the accumulated pattern: between two of them the gap of a spur pair rises by 0.2 um."""
GRID = (61, 81)


@dataclass(frozen=True, eq=False)
class ContactArea:
    """Instantaneous contact area of one tooth pair, as its contour of ``rays`` points around the contact point.

    Attributes
    ----------
    compound : float [mm]
        The gap on the contour.
    point : (rays, 3) array [mm]
        Contour on the pinion flank in the fixed frame.
    pinion_radius, pinion_axial, wheel_radius, wheel_axial : (rays,) array [mm]
        The contour on each flank.
    on_border : (rays,) bool array
        Where the contour is the end of a flank instead.
    area : float [mm^2]
        Of the projection into the common tangent plane.
    semi_axes : (float, float) [mm]
        Half the extent in the directions of the largest and of the smallest relative curvature.
    ellipse_semi_axes : (float, float) [mm]
        Of the curvature ellipse in these directions, sqrt(2 compound/k); inf where k <= 0. It means nothing on an edge.
    ellipse_points : (rays, 3) array [mm]
        The ellipse in the tangent plane, in the fixed frame; NaN if an axis is infinite.
    """

    compound: float
    point: Array
    pinion_radius: Array
    pinion_axial: Array
    wheel_radius: Array
    wheel_axial: Array
    on_border: NDArray[np.bool_]
    area: float
    semi_axes: tuple[float, float]
    ellipse_semi_axes: tuple[float, float]
    ellipse_points: Array

    @property
    def ellipse_area(self) -> float:
        """2 pi compound/sqrt(k1 k2) [mm^2]; inf for a line contact."""
        return math.pi * self.ellipse_semi_axes[0] * self.ellipse_semi_axes[1]

    @property
    def is_cut(self) -> bool:
        """Whether the area ends with a flank somewhere."""
        return bool(self.on_border.any())

    def __repr__(self) -> str:
        across, along = self.semi_axes
        return f"ContactArea({self.area:.4g} mm^2, semi-axes {across:.4g} x {along:.4g} mm)"


@dataclass(frozen=True, eq=False)
class ContactPattern:
    """Accumulated contact pattern on one flank.

    Attributes
    ----------
    gear : {"pinion", "wheel"}
    compound : float [mm]
    radius, axial, roll_length : (profile, lengthwise) array
        The grid on the flank [mm]; roll length in the unit of the flank's profile coordinate [mm or rad].
    gap : (profile, lengthwise) array [mm]
        Smallest gap over positions and teeth; +inf where the mate never comes.
    """

    gear: Gear
    compound: float
    radius: Array
    axial: Array
    roll_length: Array
    gap: Array

    @property
    def diameter(self) -> Array:
        """Twice the radius (profile, lengthwise) [mm]."""
        return 2.0 * self.radius

    @property
    def touched(self) -> NDArray[np.bool_]:
        """Where the compound is squeezed out."""
        return np.asarray(self.gap <= self.compound)

    def __repr__(self) -> str:
        return f"ContactPattern({self.gear}, {self.touched.mean():.0%} of {self.gap.size} points touched)"


def flank_gap(
    pair: GearPair, gear: Gear, angles: tuple[Array, Array], place: tuple[Array, Array]
) -> tuple[Array, Array, Array]:
    """Gap at points of one flank, to first order, and the same points on the mate.

    Parameters
    ----------
    pair : GearPair
    gear : {"pinion", "wheel"}
        The gear whose flank the points lie on.
    angles : two arrays [rad]
        phi1 and phi2 at which the gears stand; they broadcast against the points.
    place : two arrays [mm]
        rho and z of the points.

    Returns
    -------
    gap : array [mm]
        Negative where the flanks penetrate; +inf beyond the borders of the mate.
    radius, axial : array [mm]
        Of the points in the mate's frame.
    """
    (phi1, phi2), (rho, z) = angles, place
    if gear == "pinion":
        point, mate = _cartesian(rho, pair.pinion.theta(rho, z).value + pair.sense * phi1, z), pair.wheel
        radius, theta, axial = pair.to_wheel(point)
        jet = mate.theta(radius, axial)
        lag = pair.driving * (phi2 - pair.sense * (jet.value - theta))
    else:
        point, mate = _cartesian(rho, pair.wheel.theta(rho, z).value - pair.sense * phi2, z), pair.pinion
        x, y, axial = np.moveaxis(point @ pair.wheel_axes + pair.wheel_origin, -1, 0)
        radius, theta = np.hypot(x, y), np.arctan2(y, x)
        jet = mate.theta(radius, axial)
        lag = pair.driving * (pair.sense * (theta - jet.value) - phi1)
    lever = 1.0 / np.sqrt(jet.rho**2 + 1.0 / radius**2 + jet.z**2)
    return np.where(mate.inside(radius, axial), lag * lever, np.inf), radius, axial


def contact_area(pair: GearPair, contact: ContactPoint, compound: float = COMPOUND, rays: int = RAYS) -> ContactArea:
    """Instantaneous contact area around a contact point, on its own tooth pair.

    Rays leave the contact point in all directions of the tangent plane, drawn out like the curvature ellipse; each ends
    where the gap first reaches the compound, or with a flank. Beyond that nothing is seen: of an area in several pieces
    (two basins of a hollow flank) it is the piece of the contact.

    Parameters
    ----------
    pair : GearPair
    contact : ContactPoint
        One position of a contact path.
    compound : float [mm]
        Thickness of the marking compound.
    rays : int
        At least 8.

    Returns
    -------
    ContactArea

    Raises
    ------
    InputError
        If the compound is not positive and finite, or there are fewer than 8 rays.
    GeometryError
        If the tooth pair does not touch at this position.

    Examples
    --------
    >>> from loaded_tca.flanks import FlankModifications
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pair import cylindrical_pair
    >>> from loaded_tca.unloaded import trace_contact
    >>> mesh = CylindricalMesh(*(CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)))
    >>> pair = cylindrical_pair(mesh, modifications=(FlankModifications(lead_crowning=0.05), FlankModifications()))
    >>> area = contact_area(pair, trace_contact(pair, [0.0])[0])
    >>> [round(length, 3) for length in (*area.semi_axes, *area.ellipse_semi_axes)]
    [0.372, 4.455, 0.373, 4.455]
    """
    problems = _problems_of(compound)
    if not isinstance(rays, int | np.integer) or rays < 8:
        problems.append(f"rays: {rays} is not a whole number >= 8")
    if problems:
        raise InputError(problems)
    if not contact.touches:
        raise GeometryError(
            f"no common flank: the tooth pair does not touch at pinion angle {contact.pinion_angle} rad"
        )
    curvature = relative_curvature(pair, contact)
    bends = (curvature.across, 0.0 if contact.on_line else curvature.along)
    semi_axes = [math.sqrt(2.0 * compound / k) if k > 0.0 else math.inf for k in bends]
    longest = math.hypot(*pair.pinion.extent)
    turn = np.arange(rays) * (2.0 * math.pi / rays)
    drawn = [min(LONGEST * axis, longest) for axis in semi_axes]
    tangent = np.stack([drawn[0] * np.cos(turn), drawn[1] * np.sin(turn)], axis=-1)
    search = _RaySearch(pair, contact, _on_flank(pair, contact, curvature.axes[:2], tangent), compound)
    share, on_border = search.first_crossings()
    rho, z = search.place(share)
    point = EaseOff(pair).station(np.full(rays, contact.pinion_angle), rho, z).point
    _, wheel_radius, wheel_axial = flank_gap(pair, "pinion", search.angles, (rho, z))
    x, y = curvature.axes[:2] @ (point - contact.point).T
    return ContactArea(
        compound=float(compound),
        point=point,
        pinion_radius=rho,
        pinion_axial=z,
        wheel_radius=wheel_radius,
        wheel_axial=wheel_axial,
        on_border=on_border,
        area=_polygon_area(x, y),
        semi_axes=(0.5 * float(np.ptp(x)), 0.5 * float(np.ptp(y))),
        ellipse_semi_axes=(semi_axes[0], semi_axes[1]),
        ellipse_points=_ellipse(contact.point, curvature.axes[:2], semi_axes, turn),
    )


def contact_pattern(
    pair: GearPair,
    mesh: MeshPath | None = None,
    *,
    gear: Gear = "pinion",
    compound: float = COMPOUND,
    grid: tuple[int, int] = GRID,
) -> ContactPattern:
    """Accumulated contact pattern of a whole passage: the smallest gap over positions and teeth.

    Parameters
    ----------
    pair : GearPair
    mesh : MeshPath, optional
        Positions over one pitch, and the teeth; default: 61 positions and all teeth within reach.
    gear : {"pinion", "wheel"}
        Whose flank.
    compound : float [mm]
        Thickness of the marking compound.
    grid : (int, int)
        Points along the profile and along the face, borders included; at least 2 each.

    Returns
    -------
    ContactPattern

    Raises
    ------
    InputError
        If an argument is out of range.
    GeometryError
        If no tooth touches at some position.
    """
    problems = _problems_of(compound)
    if gear not in ("pinion", "wheel"):
        problems.append(f"gear: {gear!r} is not 'pinion' or 'wheel'")
    if np.shape(grid) != (2,) or not all(isinstance(n, int | np.integer) and n >= 2 for n in grid):
        problems.append(f"grid: {grid} are not two whole numbers >= 2")
    if problems:
        raise InputError(problems)
    if mesh is None:
        mesh = trace_teeth(pair, np.linspace(-0.5 * pair.pitch, 0.5 * pair.pitch, POSITIONS))
    flank = pair.pinion if gear == "pinion" else pair.wheel
    rho, z = flank.grid(*grid)
    smallest = np.full(rho.shape, np.inf)
    for tooth, path in zip(mesh.pairs, mesh.paths, strict=True):
        near = np.flatnonzero(path.touches)
        angles = (
            path.pinion_angle[near, None, None],
            (mesh.wheel_angle[near] - tooth * pair.ratio * pair.pitch)[:, None, None],
        )
        gap, _, _ = flank_gap(pair, gear, angles, (rho, z))
        smallest = np.minimum(smallest, gap.min(axis=0, initial=np.inf))
    roll_length = np.broadcast_to(flank.profile_coordinate(rho, z).value, rho.shape)
    return ContactPattern(gear, float(compound), rho, z, roll_length, smallest)


def _problems_of(compound: float) -> list[str]:
    sound = 0.0 < compound < math.inf
    return [] if sound else [f"compound: {compound} mm is not a positive, finite thickness"]


def _cartesian(rho: Array, theta: Array, z: Array) -> Array:
    return np.stack(np.broadcast_arrays(rho * np.cos(theta), rho * np.sin(theta), z), axis=-1)


def _on_flank(pair: GearPair, contact: ContactPoint, plane: Array, tangent: Array) -> Array:
    """Directions (m, 2) of the tangent plane as steps of (rho, z)."""
    place = (np.atleast_1d(v) for v in (contact.pinion_angle, contact.pinion_radius, contact.pinion_axial))
    tangents = EaseOff(pair).station(*place).tangents[0]
    return np.asarray(np.linalg.solve(plane @ tangents.T, tangent.T).T)


@dataclass(frozen=True, eq=False)
class _RaySearch:
    """Rays (m, 2) in (rho, z) from a contact point, and where the gap reaches the compound on each."""

    pair: GearPair
    contact: ContactPoint
    rays: Array
    compound: float

    @property
    def angles(self) -> tuple[Array, Array]:
        """phi1 and phi2 of the contact."""
        return np.asarray(self.contact.pinion_angle), np.asarray(self.contact.wheel_angle)

    def place(self, share: Array) -> tuple[Array, Array]:
        """(rho, z) at shares (m,) or (m, k) of the rays."""
        extra = (1,) * (share.ndim - 1)
        rho, z = (self.rays[:, k].reshape(-1, *extra) for k in (0, 1))
        return self.contact.pinion_radius + share * rho, self.contact.pinion_axial + share * z

    def first_crossings(self) -> tuple[Array, NDArray[np.bool_]]:
        """Share of each ray inside the area, and whether it is a border that ends it."""
        scan = np.broadcast_to(np.linspace(0.0, 1.0, SCAN), (len(self.rays), SCAN))
        inside, _ = self._look(scan)
        inside[:, 0] = True
        last = np.where(inside.all(axis=1), SCAN, inside.argmin(axis=1)) - 1
        rows = np.arange(len(scan))
        low, high = scan[rows, last], scan[rows, np.minimum(last + 1, SCAN - 1)]
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + high)
            within, _ = self._look(middle)
            low, high = np.where(within, middle, low), np.where(within, high, middle)
        _, there = self._look(high)
        return low, ~there

    def _look(self, share: Array) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """Whether the gap is below the compound, and whether both flanks are there."""
        rho, z = self.place(share)
        gap, _, _ = flank_gap(self.pair, "pinion", self.angles, (rho, z))
        there = np.isfinite(gap) & self.pair.pinion.inside(rho, z)
        return there & (gap <= self.compound), there


def _ellipse(centre: Array, plane: Array, semi_axes: list[float], turn: Array) -> Array:
    """Points (m, 3) of an ellipse in the tangent plane; NaN if an axis is infinite."""
    if not np.isfinite(semi_axes).all():
        return np.full((len(turn), 3), np.nan)
    return np.asarray(centre + np.stack([np.cos(turn), np.sin(turn)], axis=-1) * semi_axes @ plane)


def _polygon_area(x: Array, y: Array) -> float:
    """Area of a polygon, made exact for points at even angles of an ellipse."""
    count = len(x)
    shoelace = 0.5 * abs(float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum()))
    return shoelace * (2.0 * math.pi / count) / math.sin(2.0 * math.pi / count)
