"""Contact pattern by the searching method: where the flanks are nearer than the marking compound is thick.

The gap is that of :mod:`loaded_tca.flank_maps.rotary_gap`, without tangent plane or curvature, and the edges of the
flanks cut the pattern where it ends.

References
----------
Litvin & Fuentes 2004, Gear Geometry and Applied Theory, 9.3 (the ellipse of the curvatures).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arrays import Array
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flank_maps.contour import RaySearch
from loaded_tca.flank_maps.rotary_gap import Gear, flank_gap
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.unloaded.curvature import relative_curvature
from loaded_tca.unloaded.ease_off import EaseOff
from loaded_tca.unloaded.path import ContactPoint
from loaded_tca.unloaded.teeth import MeshPath, trace_teeth

COMPOUND = 6.35e-3
"""Thickness of the usual marking compound [mm]."""
RAYS = 360
LONGEST = 4.0
"""Length of a ray in semi-axes of the ellipse."""
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
    on_edge: NDArray[np.bool_]
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
        Smallest gap over positions and teeth; +inf where the mating gear never comes.
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
        If the tooth pair does not touch at this position.

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
    problems = _problems_of(compound)
    if not isinstance(contact, ContactPoint):
        problems.append(f"contact: {type(contact).__name__} is not a ContactPoint; take one position, path[i]")
    if not isinstance(rays, int | np.integer) or rays < 8:
        problems.append(f"rays: {rays!r} is not a whole number >= 8")
    if problems:
        raise InputError(problems)
    if not contact.in_contact:
        raise GeometryError(
            f"no common flank: the tooth pair does not touch at pinion angle {contact.pinion_angle} rad"
        )
    curvature = relative_curvature(pair, contact)
    bends = (curvature.across, 0.0 if contact.on_line else curvature.along)
    semi_axes = [math.sqrt(2.0 * compound / k) if k > 0.0 else math.inf for k in bends]
    longest = math.hypot(*pair.pinion.flank.extent)
    drawn = [min(LONGEST * axis, longest) for axis in semi_axes]
    plane = curvature.axes[:2]
    search = RaySearch(
        pair, contact, plane, _on_flank(pair, contact, plane, np.diag(drawn)), math.prod(drawn), compound
    )
    contour = search.contour(rays)
    _, wheel_radius, wheel_axial = flank_gap(pair, "pinion", search.angles, (contour.rho, contour.z))
    return ContactArea(
        compound=float(compound),
        point=search.in_space(contour.rho, contour.z),
        pinion_radius=contour.rho,
        pinion_axial=contour.z,
        wheel_radius=wheel_radius,
        wheel_axial=wheel_axial,
        on_edge=contour.edge > 0,
        area=contour.area,
        semi_axes=(0.5 * float(np.ptp(contour.x)), 0.5 * float(np.ptp(contour.y))),
        ellipse_semi_axes=(semi_axes[0], semi_axes[1]),
        ellipse_points=_ellipse(contact.point, plane, semi_axes, np.arange(rays) * (2.0 * math.pi / rays)),
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
    problems = _problems_of(compound) + _problems_of_mesh(pair, mesh)
    if gear not in ("pinion", "wheel"):
        problems.append(f"gear: {gear!r} is not 'pinion' or 'wheel'")
    counts = list(grid) if isinstance(grid, Sequence | np.ndarray) else []
    if len(counts) != 2 or not all(isinstance(n, int | np.integer) and n >= 2 for n in counts):
        problems.append(f"grid: {grid!r} are not two whole numbers >= 2")
    if problems:
        raise InputError(problems)
    if mesh is None:
        mesh = trace_teeth(pair, np.linspace(-0.5 * pair.pitch, 0.5 * pair.pitch, POSITIONS))
    flank = pair.pinion.flank if gear == "pinion" else pair.wheel.flank
    rho, z = flank.grid(*grid)
    smallest = np.full(rho.shape, np.inf)
    for tooth, path in zip(mesh.pairs, mesh.paths, strict=True):
        near = np.flatnonzero(path.in_contact)
        angles = (
            path.pinion_angle[near, None, None],
            (mesh.wheel_angle[near] - tooth * pair.ratio * pair.pitch)[:, None, None],
        )
        gap, _, _ = flank_gap(pair, gear, angles, (rho, z))
        smallest = np.minimum(smallest, gap.min(axis=0, initial=np.inf))
    roll_length = np.broadcast_to(flank.profile_coordinate(rho, z).value, rho.shape)
    return ContactPattern(gear, float(compound), rho, z, roll_length, smallest)


def _problems_of(compound: Any) -> list[str]:
    sound = isinstance(compound, int | float | np.number) and 0.0 < compound < math.inf
    return [] if sound else [f"compound: {compound!r} mm is not a positive, finite thickness"]


def _problems_of_mesh(pair: GearPair, mesh: Any) -> list[str]:
    if mesh is None:
        return []
    if not isinstance(mesh, MeshPath):
        return [f"mesh: {type(mesh).__name__} is not a MeshPath, which trace_teeth gives"]
    if mesh.pair is not pair:
        return [f"mesh: it was traced for another object, {mesh.pair!r}, not for the pair given; hand over mesh.pair"]
    return []


def _on_flank(pair: GearPair, contact: ContactPoint, plane: Array, tangent: Array) -> Array:
    """Directions (m, 2) of the tangent plane as steps of (rho, z)."""
    place = (np.atleast_1d(v) for v in (contact.pinion_angle, contact.pinion_radius, contact.pinion_axial))
    tangents = EaseOff(pair).station(*place).tangents[0]
    return np.asarray(np.linalg.solve(plane @ tangents.T, tangent.T).T)


def _ellipse(centre: Array, plane: Array, semi_axes: list[float], turn: Array) -> Array:
    """Points (m, 3) of an ellipse in the tangent plane; NaN if an axis is infinite."""
    if not np.isfinite(semi_axes).all():
        return np.full((len(turn), 3), np.nan)
    return np.asarray(centre + np.stack([np.cos(turn), np.sin(turn)], axis=-1) * semi_axes @ plane)
