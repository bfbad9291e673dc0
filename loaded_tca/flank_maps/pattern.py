r"""Contact pattern by the searching method: where the flanks are nearer than the marking compound is thick.

Gears that stand at phi1 and phi2 are apart by an angle about one axis at every point of a flank: what the mating gear
would have to turn to touch it there. Times the lever of the mating gear's normal about its axis this is the gap, to
first order,

.. math:: g = \Delta\varphi\,|n \cdot (w \times r)| = \Delta\varphi/|\nabla F|, \qquad F = \theta - \Theta(\rho, z),

since the normal is the direction of grad F, whose azimuthal part is 1/rho. No tangent plane, no curvature and no
fitted section is needed, and the edges of the flanks cut the pattern where it ends.

References
----------
Litvin & Fuentes 2004, Gear Geometry and Applied Theory, 9.3 (the ellipse of the curvatures).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, GearName, Indices, Mask
from loaded_tca.errors import InputError
from loaded_tca.flank_maps.conjugate import exchanged, problems_of_map
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.plain import plain
from loaded_tca.roots import find_roots
from loaded_tca.unloaded.curvature import relative_curvature
from loaded_tca.unloaded.ease_off import EaseOff
from loaded_tca.unloaded.path import ContactPoint, require_contact
from loaded_tca.unloaded.teeth import MeshPath, trace_teeth

COMPOUND = 6.35e-3
"""Thickness of the usual marking compound [mm]."""
RAYS = 360
LONGEST = 4.0
"""Length of a ray in semi-axes of the ellipse."""
SCAN = 65
"""Points of a ray at which its first crossing of the contour is looked for."""
RESOLVED = 1e-14
"""Accuracy of the end of a ray, over its length in the drawn ellipse."""
SECTOR = 1e-6
"""Part of the area that may hide between two rays."""
MOST_HALVINGS = 40
JUMP, EDGE_POINTS = 0.01, 15
"""Lengths of neighbouring rays that differ by more than this part run along an edge, which then has so many points."""
POSITIONS = 61
"""Positions per pitch of the accumulated pattern: between two of them the gap of a spur pair rises by 0.2 um."""
GRID = (61, 81)


@dataclass(frozen=True, eq=False)
class ContactArea:
    """Instantaneous contact area of one tooth pair, as its contour of m points around the contact point.

    Attributes
    ----------
    compound : float [mm]
        The gap on the contour.
    point : (m, 3) array [mm]
        Contour on the pinion flank in the fixed frame.
    pinion_radius, pinion_axial, wheel_radius, wheel_axial : (m,) array [mm]
        The contour on each flank.
    on_edge : (m,) bool array
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
    on_edge: Mask
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
        return bool(self.on_edge.any())

    def __repr__(self) -> str:
        across, along = self.semi_axes
        return f"ContactArea({plain(self.area)} mm^2, semi-axes {plain(across)} x {plain(along)} mm)"


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
        Smallest gap over positions and teeth; +inf where the mating gear never comes.
    """

    gear: GearName
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
    def touched(self) -> Mask:
        """Whether the gap of a point is at most the thickness of the marking compound (profile, lengthwise)."""
        return np.asarray(self.gap <= self.compound)

    def __repr__(self) -> str:
        return f"ContactPattern({self.gear}, {self.touched.mean():.0%} of {self.gap.size} points touched)"


def flank_gap(
    pair: GearPair, gear: GearName, angles: tuple[Any, Any], place: tuple[Array, Array]
) -> tuple[Array, Array, Array]:
    """Gap at points of one flank, to first order, and the same points on the mating gear.

    Parameters
    ----------
    pair : GearPair
    gear : {"pinion", "wheel"}
        The gear whose flank the points lie on.
    angles : two floats or arrays [rad]
        phi1 and phi2 at which the gears stand; they broadcast against the points.
    place : two arrays [mm]
        rho and z of the points.

    Returns
    -------
    gap : array [mm]
        Negative where the flanks penetrate; +inf beyond the edges of the mating gear.
    radius, axial : array [mm]
        Of the points in the mating gear's frame.
    """
    if gear == "wheel":
        pair, angles = exchanged(pair), angles[::-1]
    point = _in_space(pair, angles[0], *place)
    radius, theta, axial = pair.to_wheel(point)
    jet = pair.wheel.flank.theta(radius, axial)
    apart = pair.driving * (angles[1] - pair.sense * (jet.value - theta))
    lever = 1.0 / np.sqrt(jet.rho**2 + 1.0 / radius**2 + jet.z**2)
    return np.where(pair.wheel.flank.inside(radius, axial), apart * lever, np.inf), radius, axial


def _in_space(pair: GearPair, phi1: Any, rho: Array, z: Array) -> Array:
    """Points (..., 3) of the pinion's flank in the fixed frame."""
    azimuth = pair.pinion.flank.theta(rho, z).value + pair.sense * phi1
    return np.stack(np.broadcast_arrays(rho * np.cos(azimuth), rho * np.sin(azimuth), z), axis=-1)


@dataclass(frozen=True, eq=False)
class _Rays:
    """Rays from a contact point in (rho, z), and where the gap reaches the compound, or a flank ends, on each.

    ``drawn`` (2, 2): the semi-axes of the ellipse that the rays fill, along the directions ``plane`` (2, 3), as steps
    of (rho, z); ``size``: their product [mm^2].
    """

    pair: GearPair
    contact: ContactPoint
    plane: Array
    drawn: Array
    size: float
    compound: float

    def contour(self, rays: int) -> tuple[Array, Array, Array, Indices]:
        """Angle, rho, z and edge (m,) of the ends of rays at even angles, and of those between that the area needs.

        Edges are counted from 1, the pinion's first; 0: the compound.
        """
        ends = self._ends(np.arange(rays + 1, dtype=float) * (2.0 * math.pi / rays))
        low = np.arange(rays)
        for _ in range(MOST_HALVINGS):
            (turn, _, x, y, edge), rows = ends, np.stack([low, low + 1])
            middle = self._ends(turn[rows].mean(axis=0))
            three = [np.insert(own[rows], 1, new, axis=0) for own, new in zip(ends, middle, strict=True)]
            whole = _sectors(*(part[::2] for part in (three[0], *three[2:])))
            hidden = np.abs(_sectors(three[0], *three[2:]).sum(axis=0) - whole[0])
            # what lies between two rays if both are as long as the longer one
            corner = 0.5 * self.size * three[1][::2].max(axis=0) ** 2 * np.diff(turn[rows], axis=0)[0]
            unlike = edge[low] != edge[low + 1]
            rows = np.flatnonzero(np.maximum(hidden, corner * unlike) > SECTOR * abs(_sectors(turn, x, y, edge).sum()))
            if not rows.size:
                break
            ends = [np.insert(own, low[rows] + 1, new[rows]) for own, new in zip(ends, middle, strict=True)]
            low = low[rows] + np.arange(len(rows))
            low = np.sort(np.concatenate([low, low + 1]))
        turn, share, _, _, edge = (part[:-1] for part in ends)
        rho, z = self._place(turn, share)
        # more points where a ray runs along the edge that ends its neighbour: the edge may be curved in space
        share_after, rho_after, z_after, edge_after = (np.roll(part, -1) for part in (share, rho, z, edge))
        jumps = (edge != edge_after) & (np.abs(share - share_after) > JUMP * np.maximum(share, share_after))
        rows = np.repeat(np.flatnonzero(jumps), EDGE_POINTS)
        part = np.tile(np.arange(1, EDGE_POINTS + 1) / (EDGE_POINTS + 1), int(jumps.sum()))
        return (
            np.insert(turn, rows + 1, turn[rows]),
            np.insert(rho, rows + 1, rho[rows] + part * (rho_after - rho)[rows]),
            np.insert(z, rows + 1, z[rows] + part * (z_after - z)[rows]),
            np.insert(edge, rows + 1, np.maximum(edge, edge_after)[rows]),
        )

    def _place(self, turn: Array, share: Array) -> tuple[Array, Array]:
        """(rho, z) at shares of the rays at angles that broadcast against them."""
        rho, z = (np.cos(turn) * along + np.sin(turn) * across for along, across in self.drawn.T)
        return self.contact.pinion_radius + share * rho, self.contact.pinion_axial + share * z

    def _room(self, share: Array, turn: Array) -> Array:
        """Part of the compound that the gap leaves (1 off the wheel), distances to all edges [mm]: (9, ...)."""
        rho, z = self._place(turn, share)
        angles = self.contact.pinion_angle, self.contact.wheel_angle
        gap, radius, axial = flank_gap(self.pair, "pinion", angles, (rho, z))
        left = np.where(np.isfinite(gap), 1.0 - gap / self.compound, 1.0)
        edges = (*self.pair.pinion.flank.edges(rho, z), *self.pair.wheel.flank.edges(radius, axial))
        return np.stack(np.broadcast_arrays(left, *(jet.value for jet in edges)))

    def _ends(self, turn: Array) -> list[Array]:
        """Angle, share of the ray, place in the tangent plane and edge (m,) where rays at angles (m,) end."""
        brackets, room, rows = np.zeros((2, len(turn))), np.zeros((2, len(turn))), np.arange(len(turn))
        start, stop = 0.0, 1.0
        while rows.size:  # rays too short are made longer
            scan = np.linspace(start, stop, SCAN)
            least = self._room(scan, turn[rows, None]).min(axis=0)
            least[:, 0] = np.maximum(least[:, 0], 0.0)
            first = np.where((least >= 0.0).all(axis=1), SCAN, (least < 0.0).argmax(axis=1))
            ends = np.stack([first - 1, np.minimum(first, SCAN - 1)])
            brackets[:, rows], room[:, rows] = scan[ends], least[np.arange(len(rows)), ends]
            rows, start, stop = rows[first == SCAN], stop, 2.0 * stop
        share = find_roots(lambda at, rows: self._room(at, turn[rows]).min(axis=0), brackets, room, RESOLVED)
        point = _in_space(self.pair, self.contact.pinion_angle, *self._place(turn, share))
        x, y = self.plane @ (point - self.contact.point).T
        return [turn, share, x, y, self._room(share, turn).argmin(axis=0)]


def _sectors(turn: Array, x: Array, y: Array, edge: Array) -> Array:
    """Areas between neighbouring rays: triangles, and sectors of an ellipse where the compound ends both rays."""
    opened = np.remainder(np.diff(turn, axis=0), 2.0 * math.pi)
    bow = np.where((edge[:-1] == 0) & (edge[1:] == 0), 1.0 / np.sinc(opened / math.pi), 1.0)
    return 0.5 * bow * (x[:-1] * y[1:] - x[1:] * y[:-1])


@checked
def contact_area(pair: GearPair, contact: ContactPoint, compound: float = COMPOUND, rays: int = RAYS) -> ContactArea:
    """Instantaneous contact area around a contact point, on its own tooth pair.

    Rays leave the contact point in all directions of the tangent plane, drawn out like the curvature ellipse; each ends
    where the gap first reaches the compound, or with a flank. Beyond that nothing is seen: of an area in several pieces
    (two basins of a hollow flank) it is the piece of the contact. Between two rays that end unlike, on the compound and
    on an edge or on two edges, others follow until the corner is met: it changes the area by less than 1e-6.

    Parameters
    ----------
    pair : GearPair
    contact : ContactPoint
        One position of a contact path.
    compound : float [mm]
        Thickness of the marking compound.
    rays : int
        Rays at even angles, at least 8; the contour gains points at its corners.

    Returns
    -------
    ContactArea

    Raises
    ------
    InputError
        If the contact is not one position of a path, the compound is not positive and finite, or there are fewer than 8
        rays.
    GeometryError
        If the tooth pair is not in contact at this position.

    Examples
    --------
    >>> from loaded_tca.flanks import FlankModifications
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> from loaded_tca.unloaded import trace_contact
    >>> mesh = CylindricalMesh(*(CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)))
    >>> pair = cylindrical_pair(mesh, modifications=(FlankModifications(lead_crowning=0.05), FlankModifications()))
    >>> area = contact_area(pair, trace_contact(pair, [0.0])[0])
    >>> [round(length, 3) for length in (*area.semi_axes, *area.ellipse_semi_axes)]
    [0.372, 4.455, 0.373, 4.455]
    """
    require_contact(contact)
    problems = _problems_of(compound)
    if not isinstance(rays, int | np.integer) or rays < 8:
        problems.append(f"rays: {rays!r} is not a whole number >= 8")
    if problems:
        raise InputError(problems)
    curvature = relative_curvature(pair, contact)
    bends = (curvature.across, 0.0 if contact.on_line else curvature.along)
    semi_axes = [math.sqrt(2.0 * compound / k) if k > 0.0 else math.inf for k in bends]
    even = np.arange(rays) * (2.0 * math.pi / rays)
    around = np.stack([np.cos(even), np.sin(even)], axis=-1) * (1.0 if np.isfinite(semi_axes).all() else math.nan)
    longest = math.hypot(*pair.pinion.flank.extent)
    drawn = [min(LONGEST * axis, longest) for axis in semi_axes]
    plane = curvature.axes[:2]
    place = (np.atleast_1d(v) for v in (contact.pinion_angle, contact.pinion_radius, contact.pinion_axial))
    tangents = EaseOff(pair).station(*place).tangents[0]
    on_flank = np.linalg.solve(plane @ tangents.T, np.diag(drawn).T).T
    search = _Rays(pair, contact, plane, on_flank, math.prod(drawn), compound)
    turn, rho, z, edge = search.contour(rays)
    point = _in_space(pair, contact.pinion_angle, rho, z)
    wheel_radius, _, wheel_axial = pair.to_wheel(point)
    x, y = plane @ (point - contact.point).T
    sectors = _sectors(np.append(turn, turn[0]), *(np.append(part, part[0]) for part in (x, y, edge)))
    return ContactArea(
        compound=float(compound),
        point=point,
        pinion_radius=rho,
        pinion_axial=z,
        wheel_radius=wheel_radius,
        wheel_axial=wheel_axial,
        on_edge=edge > 0,
        area=abs(float(sectors.sum())),
        semi_axes=(0.5 * float(np.ptp(x)), 0.5 * float(np.ptp(y))),
        ellipse_semi_axes=(semi_axes[0], semi_axes[1]),
        ellipse_points=contact.point + (around * semi_axes) @ plane,
    )


@checked
def contact_pattern(
    pair: GearPair,
    mesh: MeshPath | None = None,
    *,
    gear: GearName = "pinion",
    compound: float = COMPOUND,
    grid: tuple[int, int] = GRID,
) -> ContactPattern:
    """Accumulated contact pattern of a whole passage: the smallest gap over positions and teeth.

    Parameters
    ----------
    pair : GearPair
    mesh : MeshPath, optional
        Positions over one pitch, and the teeth, of this very pair; default: 61 positions and all teeth within reach.
    gear : {"pinion", "wheel"}
        Whose flank.
    compound : float [mm]
        Thickness of the marking compound.
    grid : (int, int)
        Points along the profile and along the face, edges included; at least 2 each.

    Returns
    -------
    ContactPattern

    Raises
    ------
    InputError
        If an argument is out of range, or the mesh is that of another pair.
    GeometryError
        If no tooth touches at some position.
    """
    problems = _problems_of(compound) + problems_of_map(gear, grid, 2)
    if mesh is not None and not isinstance(mesh, MeshPath):
        problems.append(f"mesh: {type(mesh).__name__} is not a MeshPath, which trace_teeth gives")
    elif mesh is not None and mesh.pair is not pair:
        problems.append(f"mesh: it was traced for another object, {mesh.pair!r}, not this pair; hand over mesh.pair")
    if problems:
        raise InputError(problems)
    if mesh is None:
        mesh = trace_teeth(pair, np.linspace(-0.5 * pair.pitch, 0.5 * pair.pitch, POSITIONS))
    flank = pair.pinion.flank if gear == "pinion" else pair.wheel.flank
    rho, z = flank.grid(*grid)
    smallest = np.full(rho.shape, np.inf)
    for tooth, path in zip(mesh.pairs, mesh.paths, strict=True):
        own = np.stack([path.pinion_angle, mesh.wheel_angle - tooth * pair.ratio * pair.pitch])[:, path.in_contact]
        gap, _, _ = flank_gap(pair, gear, (own[0, :, None, None], own[1, :, None, None]), (rho, z))
        smallest = np.minimum(smallest, gap.min(axis=0, initial=np.inf))
    roll_length = np.broadcast_to(flank.profile_coordinate(rho, z).value, rho.shape)
    return ContactPattern(gear, float(compound), rho, z, roll_length, smallest)


def _problems_of(compound: Any) -> list[str]:
    sound = isinstance(compound, int | float | np.number) and 0.0 < compound < math.inf
    return [] if sound else [f"compound: {compound!r} mm is not a positive, finite thickness"]
